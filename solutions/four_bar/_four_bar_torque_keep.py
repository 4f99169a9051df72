"""Four-bar linkage: the conditions on answers that a variant must satisfy."""

from typing import Any, NamedTuple

import numpy as np

from coursework.kinematics.vectors import cross, dot

from ...exercises.four_bar.four_bar_torque import WEIGHT

__all__ = ["HELPERS", "KEEP"]


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
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    moved = abs(wrong / right - 1)
    return ((moved > 0.022) | (moved < 0.002)).all(axis=0)


def bars_turn_visibly(ratios):
    return (abs(ratios[0]) > 0.05) & (abs(ratios[1]) > 0.1)


def answers_are_no_small_differences(answers, scene):
    crank = abs(scene.bars[0]) / 1000
    forces = abs(scene.at_G3) + abs(scene.at_G4)
    couples = (
        abs(scene.couple_2) + abs(scene.couple_3 * scene.ratios[0]) + abs(scene.couple_4 * scene.ratios[1])
    )
    return (abs(answers[0]) > 0.12 * (crank * forces + couples)) & (abs(answers[1:]) > 0.12 * forces).all(
        axis=0
    )


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


HELPERS = (
    ratios,
    accelerations,
    scene,
    answers,
)
KEEP = (
    bars_turn_visibly,
    answers_are_no_small_differences,
    inertia_tells,
    turning_of_coupler_and_rocker_tells,
)
