"""Whitworth's quick return: a guide that turns fully drives a ram (Figure 26 b, equations 22, 23)."""

import numpy as np

from coursework.degrees import angle
from coursework.figures import (
    Figure,
    angle_mark,
    centre_line,
    circle,
    ground_pivot,
    line,
    link,
    note,
    pin,
    rail,
    rotation_arrow,
    slider,
    slot_link,
)
from coursework.model import Driver, Exercise, Part, detectable, drawn, loop_equations

from ._slotted_ram import (
    C,
    P,
    _clearest,
    arm,
    crank_off_the_axes,
    ram_accelerates_visibly,
)
from .quick_return import OF_BOTH_STROKES

#: What of the two strokes is told by shares: of an angle, the tolerance is the same in every variant.
STROKES = ("Q", "t_advance", "t_return")


def largest_crank(r1):
    return np.minimum(2.4 * r1, 170)


def pivots_can_be_told_apart_on_paper(r1, r4, r5):
    return r1 > 0.1 * (r4 + r5)


def pins_can_be_told_apart_on_paper(arm, r4, r5):
    return abs(abs(arm) - r4) > 0.06 * (r4 + r5)


def rod_reaches_with_room(r4, r5, h):
    return r5 > 1.8 * r4 + abs(h)


def rod_reaches_from_A(arm, r5, h):
    """Who takes A for P finds a linkage that closes, and no help there."""
    return abs(h - arm.imag) <= r5


def ram_moves_visibly(v_C, r4, omega2):
    return abs(v_C) > 0.15 * r4 * abs(omega2)


def figure(arm, P, C, r1, r2, r4, theta2, omega2):
    O4, O2 = 0j, 1j * r1
    along = arm / abs(arm)
    end = along * max(1.12 * (r1 + r2), 1.1 * r4)
    turning = _clearest(0, 270, theta2, 0.5 * theta2, angle(C - O2), angle(arm))
    half_turn = 20 if omega2 > 0 else -20
    return Figure(
        circle(O2, r2, dashed=True),
        rotation_arrow(O2, 1.15 * r2, turning - half_turn, turning + half_turn, label=r"\omega_2"),
        rail(C - 0.5 * r4, C + 0.5 * r4),
        slot_link(O4, end),
        line(O4, O2, dashed=True, label="r_1"),
        link(O2, arm, label="r_2"),
        link(P, C, label="r_5"),
        centre_line(O4, C.real + 0.6 * r4, label="x"),
        line(O2, O2 + 0.6 * r2, dashed=True),
        angle_mark(O2, 0, theta2, r"\theta_2"),
        slider(arm, angle(arm), label="A"),
        note(end + 0.06 * (r4 + r2) * along, "4"),
        note(C + 0.5 * r4, r"y\,=\,h"),
        slider(C, 0, label="C"),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        pin(arm),
        pin(P, "P"),
        pin(C),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(45, 90, step=5, unit="mm"),
        "r2": drawn(lambda r1: 1.48 * r1, largest_crank, step=5, unit="mm", positive=True),
        "r4": drawn(50, 150, step=5, unit="mm"),
        "r5": drawn(250, 500, step=5, unit="mm"),
        "h": drawn(-100, 100, step=50, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(2, 20, unit="rad/s", positive=False, nonzero=True),
    },
    helpers=(arm, P, C),
    constraints=(
        pivots_can_be_told_apart_on_paper,
        pins_can_be_told_apart_on_paper,
        rod_reaches_with_room,
        crank_off_the_axes,
        ram_moves_visibly,
        ram_accelerates_visibly,
        rod_reaches_from_A,
        detectable("P_at_A", "xC", "v_C"),
        detectable("guide_turns_with_crank", "xC", "v_C"),
        detectable("arctan_no_quadrant", "xC", "v_C"),
        detectable("v_C_rod_left_out", "v_C"),
        detectable("stroke_2r2", "stroke"),
        detectable("Q_atan", *STROKES),
        detectable("line_through_O4", *STROKES),
    ),
    parts=(
        Part("xC", unit="mm", points=2),
        Part("v_C", unit="mm/s", points=2),
        Part("a_C", unit="mm/s^2", points=2),
        Part("stroke", unit="mm", points=1),
        Part("alpha", unit="deg", points=2),
        Part("beta", unit="deg", points=1),
        Part("Q", points=1),
        Part("t_advance", unit="s", points=1),
        Part("t_return", unit="s", points=1),
        *loop_equations("loop_1", ("r1", "r2", "theta2", "rA", "theta4")),
        *loop_equations(
            "loop_2",
            ("r4", "theta4", "r5", "theta5", "xC", "h"),
            rates=("omega4", "omega5", "v_C"),
            second_rates=("alpha4", "alpha5", "a_C"),
        ),
    ),
    symbols=OF_BOTH_STROKES,
    figure=figure,
    version=2,
    driver=Driver("theta2", "omega2", output="v_C"),
)
