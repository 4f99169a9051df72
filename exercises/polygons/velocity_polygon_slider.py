"""Velocity polygon of a slider-crank: what is known, the drawing, and what is read off it (Figures 20 and
21)."""

from coursework.model import Exercise

from .._drawn import (
    PAPER_MM,
    SLIDER_CRANK,
    crank_turns_visibly,
    known,
    of_drawing,
    offset_is_none_or_visible,
    rod,
    rod_reaches_all_turn,
    slider_crank_figure,
    told_angle,
    velocities_are_long_enough_to_draw,
)


def tells(r2, r3, e, theta2):
    return {"theta3": told_angle(rod(r2, r3, e, theta2))}


EXERCISE = Exercise(
    version=3,
    given=SLIDER_CRANK,
    helpers=(rod,),
    constraints=(
        crank_turns_visibly,
        offset_is_none_or_visible,
        rod_reaches_all_turn,
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
        of_drawing("r1_dot", "mm/s"),
        of_drawing("omega3", "rad/s"),
    ),
    figure=slider_crank_figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    symbols={"kv": "k_v", "p": "p_v", "ab": "a b", "pv_b": "p_v b", "r1_dot": "V_B"},
)
