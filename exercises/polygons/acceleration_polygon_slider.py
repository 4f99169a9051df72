"""Acceleration polygon of a slider-crank whose velocities are known (equations 14 and 15, Figure 22)."""

from coursework.kinematics.angles import Degrees
from coursework.kinematics.slider_crank import SliderCrank
from coursework.model import Exercise

from .._drawn import (
    PAPER_MM,
    SLIDER_CRANK,
    all_long,
    crank_turns_visibly,
    known,
    of_drawing,
    offset_is_none_or_visible,
    on_paper,
    rod,
    rod_reaches_all_turn,
    slider_crank_figure,
    told_angle,
    told_number,
)


def vectors_are_long_enough_to_draw(p, a, n, bb_t, pa_b):
    """The normal one an eighth of the longest at least, the others a quarter."""
    of_A = on_paper(a - p)
    return all_long(1 / 8, of_A, on_paper(n - a), bb_t, pa_b) & all_long(1 / 4, of_A, bb_t, pa_b)


def tells(r2, r3, e, theta2, omega2):
    omega3 = SliderCrank(r2, r3, e).motion(Degrees(theta2), omega2, order=1).rod_rate
    return {
        "theta3": told_angle(rod(r2, r3, e, theta2)),
        "V_BA": told_number(abs(omega3 * r3)),
    }


EXERCISE = Exercise(
    version=3,
    given=SLIDER_CRANK,
    helpers=(rod,),
    constraints=(
        crank_turns_visibly,
        offset_is_none_or_visible,
        rod_reaches_all_turn,
        vectors_are_long_enough_to_draw,
    ),
    parts=(
        *known("known_A", "known_BA_n", "known_BA_t", "known_B"),
        of_drawing("ka", "mm/s^2/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point", points=2),
        of_drawing("n", kind="point", points=2),
        of_drawing("b", kind="point", points=3),
        of_drawing("bb_t"),
        of_drawing("pa_b"),
        of_drawing("r1_ddot", "mm/s^2"),
        of_drawing("alpha3", "rad/s^2"),
    ),
    figure=slider_crank_figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    symbols={"ka": "k_a", "p": "p_a", "n": "b'", "bb_t": "b' b", "pa_b": "p_a b", "r1_ddot": "a_B"},
)
