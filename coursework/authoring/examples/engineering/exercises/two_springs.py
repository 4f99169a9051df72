"""Two springs on one line: their stiffness together, the matrix of the chain, its displacements.

The answers are vectors and a matrix.
"""

from coursework.figures import Figure, line, link, note, pin, trace, vector
from coursework.model import Exercise, Part, drawn


def stiffnesses_differ(k1, k2):
    return abs(k1 - k2) >= 0.1 * k1


def _spring(start, end, coils=6, width=6.0):
    """Return a zigzag between two straight ends."""
    lead = (end - start) / 6
    run = (end - start - 2 * lead) / (4 * coils)
    turns = [start + lead + run * (2 * k + 1) + 1j * width * (-1) ** k for k in range(2 * coils)]
    return trace((start, start + lead, *turns, end - lead, end), dotted=False)


def figure():
    """The same for every variant: it names what is given."""
    wall, first, second = 0, 60, 120
    return Figure(
        link(-12j, 12j),
        _spring(wall, first),
        _spring(first, second),
        note(first / 2 + 11j, "k_1"),
        note((first + second) / 2 + 11j, "k_2"),
        vector(first - 14j, 22, "F_1"),
        line(first, first - 14j),
        vector(second - 14j, 22, "F_2"),
        line(second, second - 14j),
        pin(first, "1", toward=90),
        pin(second, "2", toward=90),
    )


EXERCISE = Exercise(
    given={
        "k1": drawn(2, 20, step=0.5, unit="N/mm"),
        "k2": drawn(2, 20, step=0.5, unit="N/mm"),
        "F1": drawn(20, 100, step=5, unit="N"),
        "F2": drawn(20, 100, step=5, unit="N"),
    },
    constraints=(stiffnesses_differ,),
    parts=(
        Part("k", unit="N/mm", kind="vector", points=2),
        Part("K", unit="N/mm", kind="matrix", points=3),
        Part("u", unit="mm", kind="vector", points=2),
        Part("E", unit="J", points=2),
    ),
    symbols={"k": r"\vec{k}", "u": r"\vec{u}"},
    figure=figure,
)
