"""Shaper: a guide that oscillates drives a ram (Figure 26 c, equations 22, 23)."""

import numpy as np

from coursework.degrees import angle, asin, polar, sqrt
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


def lowest_P(r1, r2, r4):
    """Ordinate of P at the ends of the swing."""
    return r4 * sqrt(r1**2 - r2**2) / r1


def rod_reaches_with_room(lowest_P, r4, r5, h):
    return r5 > 1.4 * np.maximum(abs(h - r4), abs(h - lowest_P))


def rod_never_in_line_with_the_guide(r1, r2, r4, r5, h):
    """The line O4-C of a rod stretched out is flatter than the guide ever is."""
    return asin(h / (r4 + r5)) < 87 - asin(r2 / r1)


def pins_can_be_told_apart_on_paper(arm, r4):
    return abs(abs(arm) - r4) > 0.1 * r4


def ram_away_from_the_y_axis(xC, r5):
    return abs(xC) > 0.5 * r5


def ram_moves_visibly(v_C, r2, omega2):
    return abs(v_C) > 0.25 * r2 * abs(omega2)


MISTAKES = (
    detectable("P_at_A", "xC", "v_C"),
    detectable("guide_turns_with_crank", "xC", "v_C"),
    detectable("guide_speed_no_projection", "v_C"),
)


def figure(arm, P, C, r1, r2, r4, theta2, omega2):
    O4, O2 = 0j, 1j * r1
    along = arm / abs(arm)
    turning = _clearest(0, 90, 270, theta2, 0.5 * theta2, angle(arm - O2))
    half_turn = 20 if omega2 > 0 else -20
    half_rail = 0.3 * r2 + 0.05 * r4
    length = 1.06 * max(r1 + r2, r4)
    return Figure(
        circle(O2, r2, dashed=True),
        rotation_arrow(O2, 1.25 * r2, turning - half_turn, turning + half_turn, label=r"\omega_2"),
        rail(C - half_rail, C + half_rail),
        slot_link(O4, along * length),
        line(O4, O2, dashed=True, label="r_1"),
        link(O2, arm, label="r_2"),
        link(P, C, label="r_5"),
        centre_line(O4, max(C.real, 0.0) + 0.3 * r4, label="x"),
        line(O2, O2 + 1.9 * r2, dashed=True),
        line(arm, O2 + polar(1.9 * r2, theta2), dashed=True),
        angle_mark(O2, 0, theta2, r"\theta_2", radius=1.6 * r2),
        slider(arm, angle(arm), label="A"),
        note(C + half_rail, "y=h"),
        slider(C, 0, label="C"),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        pin(P, "P"),
        pin(C),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(200, 400, step=5, unit="mm"),
        "r2": drawn(lambda r1: 0.2 * r1, lambda r1: 0.6 * r1, step=5, unit="mm", positive=True),
        "r4": drawn(lambda r1: 1.5 * r1, lambda r1: 2.2 * r1, step=5, unit="mm", positive=True),
        "r5": drawn(120, 300, step=5, unit="mm"),
        "h": drawn(lambda r4: r4 - 40, lambda r4: r4, step=5, unit="mm", positive=False),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(2, 20, unit="rad/s", positive=False, nonzero=True),
    },
    helpers=(arm, P, C, lowest_P),
    constraints=(
        rod_reaches_with_room,
        rod_never_in_line_with_the_guide,
        pins_can_be_told_apart_on_paper,
        crank_off_the_axes,
        ram_away_from_the_y_axis,
        ram_moves_visibly,
        ram_accelerates_visibly,
        *MISTAKES,
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
