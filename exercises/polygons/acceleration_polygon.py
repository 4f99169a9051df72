"""Acceleration polygon of a four-bar linkage whose velocities are known (equations 14 and 15, Figure 23)."""

from coursework.kinematics.angles import Degrees
from coursework.kinematics.four_bar import FourBar
from coursework.model import Exercise

from .._drawn import (
    FOUR_BAR,
    PAPER_MM,
    all_long,
    bars,
    crank_turns_visibly,
    four_bar_figure,
    known,
    lines_cross_clearly,
    of_drawing,
    on_paper,
    told_angle,
    told_number,
)


def vectors_are_long_enough_to_draw(p, a, n, m, bb_t, mb_t, pa_b):
    """The normal ones a ninth of the longest at least, the tangential ones and that of B two ninths."""
    of_A, normal_BA, normal_B = map(on_paper, (a - p, n - a, m - p))
    normal = all_long(1 / 9, of_A, normal_BA, normal_B, bb_t, mb_t, pa_b)
    longest = (2 * normal_BA, 2 * normal_B)  # two ninths of the others are asked, one of these
    return normal & all_long(2 / 9, of_A, *longest, bb_t, mb_t, pa_b)


def tells(r1, r2, r3, r4, theta2, omega2, mode):
    _, coupler, rocker = bars(r1, r2, r3, r4, theta2, mode)
    pose = FourBar(r1, r2, r3, r4, mode).at(Degrees(theta2))
    return {
        "theta3": told_angle(coupler),
        "theta4": told_angle(rocker),
        "V_BA": told_number(abs(pose.coupler_ratio * omega2 * r3)),
        "V_B": told_number(abs(pose.rocker_ratio * omega2 * r4)),
    }


EXERCISE = Exercise(
    given=FOUR_BAR,
    helpers=(bars,),
    constraints=(
        crank_turns_visibly,
        lines_cross_clearly,
        vectors_are_long_enough_to_draw,
    ),
    parts=(
        *known("known_BA_n", "known_BA_t", "known_B_n", "known_B_t"),
        of_drawing("ka", "mm/s^2/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point", points=2),
        of_drawing("n", kind="point", points=2),
        of_drawing("m", kind="point", points=2),
        of_drawing("b", kind="point", points=3),
        of_drawing("bb_t"),
        of_drawing("pa_b"),
        of_drawing("a_B", "mm/s^2"),
        of_drawing("alpha3", "rad/s^2"),
        of_drawing("alpha4", "rad/s^2"),
    ),
    figure=four_bar_figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    version=2,
    symbols={"ka": "k_a", "p": "p_a", "n": "b'", "m": "b''", "bb_t": "b' b", "pa_b": "p_a b", "a_B": "a_B"},
)
