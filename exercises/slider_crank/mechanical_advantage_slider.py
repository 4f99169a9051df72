"""Mechanical advantage of a slider-crank: what force does the piston pass on? (equations 20 and 21)."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import (
    Figure,
    angle_mark,
    dimension,
    ground_pivot,
    line,
    link,
    pin,
    rail,
    slider,
    vector,
)
from coursework.model import Driver, Exercise, Part, clearly_apart, detectable, drawn

from ._slider_crank import largest_offset, offset_is_none_or_visible, rod, rod_turns_visibly


def crank_turns_visibly(omega2):
    return abs(omega2) >= 5


def crank_off_the_axes(theta2):
    return theta2 % 90 != 0


def piston_moves_visibly(r1_dot, r2, omega2):
    return abs(r1_dot) > 0.15 * r2 * abs(omega2)


def speeds_of_rod_and_output_can_be_told_apart(V_BA, V_s):
    return clearly_apart(V_BA, V_s, 0.01 * V_s)


def figure(rod, r2, e, theta2, omega2):
    O, A = 0j, polar(r2, theta2)
    B, half_rail = A + rod, 0.5 * r2
    offset = (dimension(B.real + 1.4 * half_rail, B + 1.4 * half_rail, "e", offset=0),) if e else ()
    return Figure(
        rail(B - half_rail, B + half_rail),
        line(O, B.real + 1.6 * half_rail, dashed=True),
        *offset,
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        slider(B),
        vector(A, 1j * np.sign(omega2) * A, "F_e"),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


EXERCISE = Exercise(
    given={
        "r2": drawn(20, 100, step=5, unit="mm"),
        "r3": drawn(lambda r2: 2.2 * r2, lambda r2: 4 * r2, step=5, unit="mm", positive=True),
        "e": drawn(lambda r2: -largest_offset(r2), largest_offset, step=5, unit="mm", default=0),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-150, 150, step=5, unit="rad/s"),
        "Gamma_e": drawn(2, 40, step=0.5, unit="N*m"),
    },
    helpers=(rod,),
    constraints=(
        crank_turns_visibly,
        offset_is_none_or_visible,
        crank_off_the_axes,
        rod_turns_visibly,
        piston_moves_visibly,
        detectable("advantage_inverse", "mechanical_advantage"),
        speeds_of_rod_and_output_can_be_told_apart,
        detectable("rod_forgotten_in_v", "r1_dot", "V_s"),
        detectable("one_sign_wrong", "r1_dot", "V_s"),
    ),
    parts=(
        Part("r1_dot", unit="mm/s", points=2),
        Part("mechanical_advantage", points=2),
        Part("F_e", unit="N", points=1),
        Part("F_s", unit="N", points=1),
    ),
    figure=figure,
    symbols={"mechanical_advantage": r"\lambda", "Gamma_e": r"\Gamma_e"},
    driver=Driver("theta2", "omega2", output="r1_dot"),
)
