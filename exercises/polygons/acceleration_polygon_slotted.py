"""Acceleration polygon of a slotted mechanism whose velocities are known: the Coriolis term and its side
(Figure 25)."""

from coursework.kinematics.angles import Degrees
from coursework.kinematics.slotted_guide import SlottedGuidePose
from coursework.model import Exercise

from .._drawn import (
    PAPER_MM,
    SLOTTED,
    all_long,
    crank_turns_visibly,
    guided,
    known,
    of_drawing,
    on_paper,
    slotted_figure,
    told_angle,
    told_number,
)


def vectors_are_long_enough_to_draw(p, a, k, n, nb_t, bk):
    """The normal one a ninth of the longest at least, the others two ninths."""
    others = on_paper(a - p), on_paper(a - k), nb_t, bk
    return all_long(1 / 9, on_paper(n - p), *others) & all_long(2 / 9, *others)


def tells(r1, r2, theta2, omega2):
    guide = SlottedGuidePose(r1, r2, Degrees.between(90.0, theta2))
    return {
        "theta4": told_angle(guided(r1, r2, theta2).arm),
        "rA": told_number(guide.arm),
        "omega4": told_number(omega2 * guide.guide_ratio),
        "rA_dot": told_number(omega2 * guide.sliding_ratio),
    }


EXERCISE = Exercise(
    given=SLOTTED,
    helpers=(guided,),
    constraints=(
        crank_turns_visibly,
        vectors_are_long_enough_to_draw,
    ),
    parts=(
        *known("known_c", "known_s", "known_n", "known_t"),
        of_drawing("ka", "mm/s^2/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point", points=2),
        of_drawing("k", kind="point", points=3),
        of_drawing("n", kind="point", points=2),
        of_drawing("b", kind="point", points=3),
        of_drawing("bk"),
        of_drawing("nb_t"),
        of_drawing("rA_ddot", "mm/s^2"),
        of_drawing("alpha4", "rad/s^2"),
    ),
    figure=slotted_figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    version=2,
    symbols={
        "ka": "k_a",
        "p": "p_a",
        "a": "a_2",
        "n": "a_4'",
        "b": "a_4",
        "bk": "a_4 k",
        "nb_t": "a_4' a_4",
        "rA_ddot": r"\ddot r_A",
    },
)
