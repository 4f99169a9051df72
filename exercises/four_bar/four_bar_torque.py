"""Four-bar linkage: what torque turns the crank, and what do its joints bear?"""

from typing import Any, NamedTuple

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
from coursework.kinematics.vectors import cross, dot
from coursework.model import Driver, Exercise, Part, chosen, drawn

from ._crank_rocker import bars, crank_off_the_frame, crank_turns, transmission_angle_from_30_to_150

WEIGHT = 9.81j  #: N/kg, upwards: what a body at rest is held by


class _Scene(NamedTuple):
    """The three bars in mm, what the two driven ones turn per turn of the crank, and what acts besides the joints:
    forces at the centres of mass, N, and couples, N*m."""

    bars: Any
    ratios: Any
    s3: Any
    s4: Any
    on_crank: Any
    at_G3: Any
    at_G4: Any
    couple_2: Any
    couple_3: Any
    couple_4: Any


def ratios(bars):
    """omega3 and omega4, over omega2."""
    crank, coupler, rocker = bars
    area = cross(rocker, coupler)
    return cross(crank, rocker) / area, cross(crank, coupler) / area


def accelerations(bars, ratios, omega2, alpha2):
    """alpha3 and alpha4."""
    crank, coupler, rocker = bars
    omega3, omega4 = omega2 * ratios[0], omega2 * ratios[1]
    along = (omega2**2 - 1j * alpha2) * crank + omega3**2 * coupler - omega4**2 * rocker
    area = cross(coupler, rocker)
    return dot(along, rocker) / area, dot(along, coupler) / area


def scene(bars, ratios, accelerations, omega2, alpha2, m2, J2, s3, m3, J3, s4, m4, J4, M):
    crank, coupler, rocker = bars
    (k3, k4), (alpha3, alpha4) = ratios, accelerations
    of_A = (1j * alpha2 - omega2**2) * crank
    of_G3 = of_A + s3 * (1j * alpha3 - (k3 * omega2) ** 2) * coupler
    of_G4 = s4 * (1j * alpha4 - (k4 * omega2) ** 2) * rocker
    return _Scene(
        bars,
        ratios,
        s3,
        s4,
        on_crank=-m2 * WEIGHT,
        at_G3=-m3 * (of_G3 / 1000 + WEIGHT),
        at_G4=-m4 * (of_G4 / 1000 + WEIGHT),
        couple_2=-J2 * alpha2,
        couple_3=-J3 * alpha3,
        couple_4=-J4 * alpha4 - M * np.sign(k4 * omega2),
    )


def _answers(scene):
    """Torque, R_B, R_A, R_C and R_O, along a first axis."""
    (crank, coupler, rocker), (k3, k4) = scene.bars, scene.ratios
    about_A = scene.s3 * cross(coupler, scene.at_G3) / 1000 + scene.couple_3
    about_C = scene.s4 * cross(rocker, scene.at_G4) / 1000 + scene.couple_4
    torque = -scene.couple_2 - cross(crank, scene.at_G3) / 1000 - about_A * k3 - about_C * k4
    at_B = 1000 * (about_A * rocker + about_C * coupler) / cross(coupler, rocker)
    at_A = at_B - scene.at_G3
    return np.stack([torque, abs(at_B), abs(at_A), abs(at_B + scene.at_G4), abs(at_A - scene.on_crank)])


def answers(scene):
    """With every effect, as they are asked."""
    return _answers(scene)


def _told_apart(right, wrong):
    """Whether a mistake moves every answer by two tolerances and more, or not at all."""
    moved = abs(wrong / right - 1)
    return ((moved > 0.022) | (moved < 0.002)).all(axis=0)


def bars_turn_visibly(ratios):
    return (abs(ratios[0]) > 0.05) & (abs(ratios[1]) > 0.1)


def bars_point_their_own_ways(bars):
    """Their letters and centres of mass have room, and no projection nearly vanishes."""
    _, coupler, rocker = bars
    return (abs(coupler.imag) > 0.05 * abs(coupler)) & (abs(rocker.real) > 0.05 * abs(rocker))


def answers_are_no_small_differences(answers, scene):
    crank = abs(scene.bars[0]) / 1000
    forces = abs(scene.at_G3) + abs(scene.at_G4)
    couples = (
        abs(scene.couple_2) + abs(scene.couple_3 * scene.ratios[0]) + abs(scene.couple_4 * scene.ratios[1])
    )
    return (abs(answers[0]) > 0.12 * (crank * forces + couples)) & (abs(answers[1:]) > 0.12 * forces).all(
        axis=0
    )


def crank_accelerates_visibly(alpha2):
    return abs(alpha2) >= 5


def crank_turns_quickly(omega2):
    return abs(omega2) >= 5


def inertia_tells(answers, scene, m3, m4, M, omega2):
    """A mechanism at rest bears visibly other forces."""
    at_rest = scene._replace(
        at_G3=-m3 * WEIGHT,
        at_G4=-m4 * WEIGHT,
        couple_2=0 * M,
        couple_3=0 * M,
        couple_4=-M * np.sign(scene.ratios[1] * omega2),
    )
    return _told_apart(answers, _answers(at_rest))


def turning_of_coupler_and_rocker_tells(answers, scene, J4, accelerations):
    """Their inertia beyond that of their centres of mass."""
    without = scene._replace(couple_3=0 * scene.couple_3, couple_4=scene.couple_4 + J4 * accelerations[1])
    return _told_apart(answers, _answers(without))


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
    helpers=(bars, ratios, accelerations, scene, answers),
    keep=(
        crank_turns,
        transmission_angle_from_30_to_150,
        crank_off_the_frame,
        crank_accelerates_visibly,
        crank_turns_quickly,
        bars_turn_visibly,
        bars_point_their_own_ways,
        answers_are_no_small_differences,
        inertia_tells,
        turning_of_coupler_and_rocker_tells,
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
