"""Velocity polygon of a four-bar linkage: what is known, the drawing, and what is read off it (equation
12)."""

from coursework.model import Exercise

from .._drawn import (
    FOUR_BAR,
    PAPER_MM,
    bars,
    crank_turns_visibly,
    four_bar_figure,
    known,
    lines_cross_clearly,
    of_drawing,
    told_angle,
    velocities_are_long_enough_to_draw,
)


def tells(r1, r2, r3, r4, theta2, mode):
    _, coupler, rocker = bars(r1, r2, r3, r4, theta2, mode)
    return {"theta3": told_angle(coupler), "theta4": told_angle(rocker)}


EXERCISE = Exercise(
    given=FOUR_BAR,
    helpers=(bars,),
    constraints=(
        crank_turns_visibly,
        lines_cross_clearly,
        velocities_are_long_enough_to_draw,
    ),
    parts=(
        *known("known_A", "known_BA", "known_B"),
        of_drawing("kv", "mm/s/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point", points=2),
        of_drawing("b", kind="point", points=3),
        of_drawing("ab"),
        of_drawing("pv_b"),
        of_drawing("v_B", "mm/s"),
        of_drawing("omega3", "rad/s"),
        of_drawing("omega4", "rad/s"),
    ),
    figure=four_bar_figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    version=2,
    symbols={"kv": "k_v", "p": "p_v", "ab": "a b", "pv_b": "p_v b", "v_B": "V_B"},
)
