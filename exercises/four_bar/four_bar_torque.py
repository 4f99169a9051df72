"""Four-bar linkage: what torque turns the crank, and what do its joints bear?"""

import numpy as np

from coursework.figures import (
    Figure,
    angle_mark,
    ground_pivot,
    line,
    link,
    pin,
    point,
    rotation_arrow,
    vector,
)
from coursework.model import Driver, Exercise, Part, chosen, detectable, drawn

from ._crank_rocker import bars, crank_off_the_frame, crank_turns, transmission_angle_from_30_to_150


def bars_point_their_own_ways(bars):
    """Their letters and centres of mass have room, and no projection nearly vanishes."""
    _, coupler, rocker = bars
    return (abs(coupler.imag) > 0.05 * abs(coupler)) & (abs(rocker.real) > 0.05 * abs(rocker))


def crank_accelerates_visibly(alpha2):
    return abs(alpha2) >= 5


def crank_turns_quickly(omega2):
    return abs(omega2) >= 5


def bars_turn_visibly(k3, k4):
    return (abs(k3) > 0.05) & (abs(k4) > 0.1)


def answers_are_no_small_differences(
    torque, R_A, R_B, R_C, R_O, X3, Y3, X4, Y4, r2, k3, k4, omega4, J3, alpha3, J4, alpha4, M, M2
):
    forces = np.hypot(X3, Y3) + np.hypot(X4, Y4)
    couples = abs(M2) + abs(J3 * alpha3 * k3) + abs((J4 * alpha4 + M * np.sign(omega4)) * k4)
    smallest = np.minimum.reduce([R_A, R_B, R_C, R_O])
    return (abs(torque) > 0.12 * (r2 * forces / 1000 + couples)) & (smallest > 0.12 * forces)


ANSWERS = ("torque", "R_B", "R_A", "R_C", "R_O")


def figure(bars, r1, r2, theta2, omega2, s3, s4):
    O, A, C = 0j, bars[0], complex(r1)
    B = A + bars[1]
    behind = theta2 + 180
    turn = 35 if omega2 > 0 else -35
    aside = complex(max(r1, B.real) + 0.22 * r1, max(A.imag, B.imag, 0.3 * r1))
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        vector(aside, -0.25j * r1, "g"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        point(A + s3 * bars[1], "G_3"),
        point(C + s4 * bars[2], "G_4"),
        angle_mark(O, 0, theta2, r"\theta_2"),
        rotation_arrow(O, 0.6 * r2, behind - turn, behind + turn, label=r"\omega_2"),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(250, 500, step=10, unit="mm"),
        "r2": drawn(lambda r1: 0.25 * r1, lambda r1: 0.45 * r1, step=5, unit="mm", positive=True),
        "r3": drawn(lambda r1: 0.75 * r1, lambda r1: 1.15 * r1, step=5, unit="mm", positive=True),
        "r4": drawn(lambda r1: 0.6 * r1, lambda r1: 1.05 * r1, step=5, unit="mm", positive=True),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-15, 15, unit="rad/s"),
        "alpha2": drawn(-60, 60, step=5, unit="rad/s^2", default=0),
        "mode": chosen("open", "crossed"),
        "m2": drawn(5, 15, step=0.5, unit="kg"),
        "J2": drawn(0.1, 0.6, step=0.05, unit="kg*m^2"),
        "s3": drawn(0.35, 0.65, step=0.05),
        "m3": drawn(5, 15, step=0.5, unit="kg"),
        "J3": drawn(
            lambda m3, r3: 0.1 * m3 * (r3 / 1000) ** 2,
            lambda m3, r3: 0.18 * m3 * (r3 / 1000) ** 2,
            step=0.01,
            unit="kg*m^2",
            positive=True,
        ),
        "s4": drawn(0.35, 0.65, step=0.05),
        "m4": drawn(5, 15, step=0.5, unit="kg"),
        "J4": drawn(
            lambda m4, r4: 0.1 * m4 * (r4 / 1000) ** 2,
            lambda m4, r4: 0.18 * m4 * (r4 / 1000) ** 2,
            step=0.01,
            unit="kg*m^2",
            positive=True,
        ),
        "M": drawn(10, 60, step=5, unit="N*m"),
    },
    helpers=(bars,),
    constraints=(
        crank_turns,
        transmission_angle_from_30_to_150,
        crank_off_the_frame,
        crank_accelerates_visibly,
        crank_turns_quickly,
        bars_point_their_own_ways,
        bars_turn_visibly,
        answers_are_no_small_differences,
        detectable("inertia_forgotten", *ANSWERS, least=2.2, most=0.2),
        detectable("inertia_torques_forgotten", *ANSWERS, least=2.2, most=0.2),
    ),
    parts=(
        Part("torque", unit="N*m", points=3),
        Part("R_B", unit="N", points=2),
        Part("R_A", unit="N", points=1),
        Part("R_C", unit="N", points=1),
        Part("R_O", unit="N", points=1),
    ),
    effects=("load", "gravity", "inertia"),
    figure=figure,
    symbols={"torque": r"\Gamma"},
    driver=Driver("theta2", "omega2", "alpha2", effort="torque", output="omega4"),
)
