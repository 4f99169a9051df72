"""Velocity polygon of six links: two bars that meet, then a rod and its slider (the supplementary exercise)."""

from coursework.model import Exercise

from .._drawn import PAPER_MM, crank_turns_visibly, dot, known, of_drawing
from ._six_bar import GIVEN, HELPERS, bars, crank_off_the_axes, figure, told_directions


def crank_not_square_to_the_coupler(pin_A, pin_B, r1):
    """Else who draws the velocity of A along the crank finds nothing that moves, and the drawing ends there."""
    crank, coupler = pin_A - 1j * r1, pin_B - pin_A
    return abs(dot(crank, coupler)) > 0.1 * abs(crank) * abs(coupler)


def tells(r1, r2, r3, r4, r5, theta2, mode):
    return told_directions(bars(r1, r2, r3, r4, r5, theta2, mode))


EXERCISE = Exercise(
    given=GIVEN,
    helpers=HELPERS,
    constraints=(crank_turns_visibly, crank_off_the_axes, crank_not_square_to_the_coupler),
    parts=(
        *known("known_A", "known_BA", "known_B", "known_CB", "known_C", count=3),
        of_drawing("kv", "mm/s/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point", points=2),
        of_drawing("b", kind="point", points=3),
        of_drawing("c", kind="point", points=3),
        of_drawing("ab"),
        of_drawing("pv_b"),
        of_drawing("bc"),
        of_drawing("pv_c"),
        of_drawing("omega3", "rad/s"),
        of_drawing("omega4", "rad/s"),
        of_drawing("omega5", "rad/s"),
        of_drawing("r6_dot", "mm/s"),
    ),
    figure=figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    version=2,
    symbols={
        "kv": "k_v",
        "p": "p_v",
        "ab": "a b",
        "pv_b": "p_v b",
        "bc": "b c",
        "pv_c": "p_v c",
        "r6_dot": "V_C",
    },
    kept_by_solution=True,
)
