"""Velocity polygon of a slider-crank: what is known, the drawing, and what is read off it (Figures 20 and 21)."""

from coursework.degrees import cos, polar, sin
from coursework.model import Exercise

from .._drawn import (
    PAPER_MM,
    SLIDER_CRANK,
    all_long,
    crank_turns_visibly,
    known,
    of_drawing,
    offset_is_none_or_visible,
    rod,
    rod_reaches_all_turn,
    slider_crank_figure,
    told_angle,
)


def vectors_are_long_enough_to_draw(rod, r2, theta2):
    """The shortest is a third of the longest at least; over omega2."""
    omega3 = -r2 * cos(theta2) / rod.real
    return all_long(1 / 3, polar(r2, theta2), omega3 * rod, -r2 * sin(theta2) - omega3 * rod.imag)


def tells(r2, r3, e, theta2):
    return {"theta3": told_angle(rod(r2, r3, e, theta2))}


EXERCISE = Exercise(
    version=2,
    given=SLIDER_CRANK,
    helpers=(rod,),
    keep=(
        crank_turns_visibly,
        offset_is_none_or_visible,
        rod_reaches_all_turn,
        vectors_are_long_enough_to_draw,
    ),
    parts=(
        known("known_A"),
        known("known_BA"),
        known("known_B"),
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
