"""Grashof's rule: which bars of a four-bar linkage turn fully? (chapter 3, section 3.4, figures 9 and 10)."""

from coursework.figures import Figure, ground_pivot, link, pin
from coursework.model import Exercise, Part, drawn
from coursework.structure.grashof import TYPES, grashof_excess


def triple_rockers_are_rare(r1, r2, r3, r4):
    """Left alone, nearly every other draw would be one; the rest of the types would seldom be met."""
    return (grashof_excess(r1, r2, r3, r4) >= 0) | ((r1 + 2 * r2 + 3 * r3 + 4 * r4) % 20 == 0)


def figure(r1, r2, r3, r4):
    """The bars laid out one below the other: putting them together is the question."""
    gap = 34
    return Figure(
        link(0, r1, label="r_1"),
        ground_pivot(0, toward=90),
        ground_pivot(r1, toward=90),
        *[
            element
            for row, (length, name) in enumerate(((r2, "r_2"), (r3, "r_3"), (r4, "r_4")), start=1)
            for start, end in ((-1j * gap * (row + 0.4), length - 1j * gap * (row + 0.4)),)
            for element in (link(start, end, label=name), pin(start), pin(end))
        ],
    )


EXERCISE = Exercise(
    given={name: drawn(40, 250, step=5, unit="mm") for name in ("r1", "r2", "r3", "r4")},
    constraints=(triple_rockers_are_rare,),
    parts=(
        Part("s_plus_l", unit="mm", points=1, rtol=0, atol=0.5),
        Part("p_plus_q", unit="mm", points=1, rtol=0, atol=0.5),
        Part("linkage_type", kind="choice", choices=TYPES, points=2),
    ),
    symbols={"s_plus_l": "s + l", "p_plus_q": "p + q"},
    figure=figure,
)
