"""A slotted mechanism at an instant: the crank pin A2 and the point A4 of the guide that is under it."""

import numpy as np

from coursework.degrees import polar, sin, sqrt
from coursework.kinematics.angles import Degrees
from coursework.kinematics.slotted_guide import SlottedGuidePose
from coursework.solution import stable


def _guide(r1, r2, theta2):
    """The guide at its crank angle, by the numeric core; it counts angles from the frame's direction."""
    return SlottedGuidePose(r1, r2, Degrees.between(90.0, theta2))


def _vectors(_guide, r2, theta2):
    """O2A, and the unit vector of the guide away from O4."""
    return polar(r2, theta2), 1j * np.exp(1j * _guide.guide_angle)


@stable(lambda _guide: _guide.arm)
def rA(r1, r2, theta2):
    """Distance O4A, by the law of cosines."""
    return sqrt(r1**2 + r2**2 + 2 * r1 * r2 * sin(theta2))
