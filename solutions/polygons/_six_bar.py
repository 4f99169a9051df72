"""Six links at an instant: OA, AB and DB as a four-bar linkage whose frame OD points down, then the rod BC to
its slider."""

import numpy as np

from coursework.degrees import from_radians, polar, wrap
from coursework.kinematics.angles import Degrees
from coursework.kinematics.four_bar import FourBar
from coursework.kinematics.slider_crank import SliderCrank


def _linkage(r1, r2, r3, r4, mode, theta2):
    """By the numeric core, which counts angles from the direction O -> D."""
    return FourBar(r1, r2, r3, r4, mode).at(Degrees.between(-90.0, theta2))


def _links(_linkage, r2, r3, r4, r5, theta2):
    """Vectors OA, AB, DB and BC."""
    coupler, rocker = (-1j * np.exp(1j * angle) for angle in (_linkage.coupler_angle, _linkage.rocker_angle))
    theta4 = wrap(from_radians(_linkage.rocker_angle) - 90)
    run = SliderCrank(r4, r5, 0.0 * r4).run(Degrees(theta4))
    return polar(r2, theta2), r3 * coupler, r4 * rocker, run - 1j * r4 * rocker.imag


def _rates(_linkage, _links, omega2):
    """Of OA, AB, DB and BC; C keeps to its line."""
    *_, rocker, rod = _links
    omega4 = _linkage.rocker_ratio * omega2
    return omega2, _linkage.coupler_ratio * omega2, omega4, -omega4 * rocker.real / rod.real
