"""A beam on two supports under a load at a point and a load spread evenly: reactions, largest moment,
section.

Lengths are in m, forces in kN: units are what this file says they are. The figure takes the same numbers.
"""

from coursework.figures import Figure, dimension, ground_pivot, line, link, pin, point, rail, slider, vector
from coursework.model import Exercise, Part, drawn


def nearly_the_span(L):
    return L - 0.5


def load_off_the_middle(L, a):
    """Else both reactions are the same, and who exchanges them is right."""
    return abs(a - L / 2) >= L / 10


def both_loads_count(L, F, q):
    share = F / (q * L)
    return (share >= 0.2) & (share <= 5)


def figure(L, a):
    A, B, load = 0, L, a
    spread, force, arrows = 0.1j * L, 0.17j * L, 12
    return Figure(
        link(A, B),
        line(spread, B + spread, label="q"),
        *(vector(L * k / arrows + spread, -spread) for k in range(arrows + 1)),
        vector(load + spread + force, -force, "F"),
        point(load),
        rail(0.93 * L, 1.07 * L),
        slider(B),
        ground_pivot(A, "A"),
        pin(B, "B"),
        dimension(load, A, "a", offset=0.17 * L),
        dimension(B, A, "L", offset=0.28 * L),
    )


EXERCISE = Exercise(
    given={
        "L": drawn(4, 12, step=0.5, unit="m"),
        "a": drawn(0.5, nearly_the_span, step=0.25, unit="m"),
        "F": drawn(5, 60, step=1, unit="kN"),
        "q": drawn(2, 15, step=0.5, unit="kN/m"),
        "sigma": drawn(100, 235, step=5, unit="MPa"),
    },
    constraints=(load_off_the_middle, both_loads_count),
    parts=(
        Part("R_A", unit="kN", points=2),
        Part("R_B", unit="kN"),
        Part("x_M", unit="m", points=2),
        Part("M", unit="kN*m", points=2),
        Part("W", unit="cm^3", points=2),
    ),
    symbols={"sigma": r"\sigma_{\max}", "M": r"M_{\max}"},
    figure=figure,
)
