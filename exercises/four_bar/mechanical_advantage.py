"""Mechanical advantage of a four-bar linkage: what force and what torque come out? (equations 19 to 21)."""

import numpy as np

from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin, vector
from coursework.model import Driver, Exercise, Part, chosen, detectable, drawn

from ..slider_crank.mechanical_advantage_slider import speeds_of_rod_and_output_can_be_told_apart
from ._crank_rocker import (
    bars,
    crank_off_the_frame,
    crank_turns,
    crank_turns_visibly,
    transmission_angle_from_30_to_150,
)


def links_turn_visibly(omega3, omega4, omega2):
    return (abs(omega3) > 0.08 * abs(omega2)) & (abs(omega4) > 0.08 * abs(omega2))


def figure(bars, r1, r2, theta2, omega2):
    O, A, C = 0j, bars[0], complex(r1)
    B = A + bars[1]
    push = 1j * np.sign(omega2) * A / r2
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        vector(A, 0.3 * r1 * push, "F_e"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(120, 260, step=5, unit="mm"),
        "r2": drawn(30, 90, step=5, unit="mm"),
        "r3": drawn(120, 260, step=5, unit="mm"),
        "r4": drawn(80, 200, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-20, 20, unit="rad/s"),
        "mode": chosen("open", "crossed"),
        "F_e": drawn(50, 500, step=10, unit="N"),
    },
    helpers=(bars,),
    constraints=(
        crank_turns,
        transmission_angle_from_30_to_150,
        crank_off_the_frame,
        crank_turns_visibly,
        links_turn_visibly,
        speeds_of_rod_and_output_can_be_told_apart,
        detectable("advantage_inverse", "mechanical_advantage"),
        detectable("torque_ratio_inverse", "torque_ratio"),
        detectable("sum_in_denominator", "omega4", "V_s"),
        detectable("other_mode", "omega4", "V_s"),
    ),
    parts=(
        Part("omega4", unit="rad/s", points=2),
        Part("mechanical_advantage", points=2),
        Part("F_s", unit="N", points=1),
        Part("torque_ratio", points=1),
        Part("Gamma_s", unit="N*m", points=2),
    ),
    figure=figure,
    symbols={
        "mechanical_advantage": r"\lambda",
        "torque_ratio": r"\Gamma_s / \Gamma_e",
        "Gamma_e": r"\Gamma_e",
        "Gamma_s": r"\Gamma_s",
    },
    driver=Driver("theta2", "omega2", output="omega4"),
)
