"""Velocity polygon of a slotted mechanism: coincident points of crank and guide, and the sliding between them
(Figure 24)."""

from coursework.model import Exercise

from .._drawn import (
    PAPER_MM,
    SLOTTED,
    crank_turns_visibly,
    guided,
    known,
    of_drawing,
    slotted_figure,
    told_angle,
    told_number,
    velocities_are_long_enough_to_draw,
)


def guide_is_unlike_the_crank(guided):
    """What divides by the wrong length is told."""
    return abs(abs(guided.arm) / abs(guided.crank) - 1) > 0.25


def tells(r1, r2, theta2):
    arm = guided(r1, r2, theta2).arm
    return {"theta4": told_angle(arm), "rA": told_number(abs(arm))}


EXERCISE = Exercise(
    given=SLOTTED,
    helpers=(guided,),
    constraints=(
        crank_turns_visibly,
        guide_is_unlike_the_crank,
        velocities_are_long_enough_to_draw,
    ),
    parts=(
        *known("known_A", "known_B", "known_BA"),
        of_drawing("kv", "mm/s/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point", points=2),
        of_drawing("b", kind="point", points=3),
        of_drawing("ab"),
        of_drawing("pv_b"),
        of_drawing("rA_dot", "mm/s"),
        of_drawing("omega4", "rad/s"),
    ),
    figure=slotted_figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    version=2,
    symbols={
        "kv": "k_v",
        "p": "p_v",
        "a": "a_2",
        "b": "a_4",
        "ab": "a_4 a_2",
        "pv_b": "p_v a_4",
        "rA_dot": r"\dot r_A",
    },
)
