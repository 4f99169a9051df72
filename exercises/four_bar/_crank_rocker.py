"""Common base of exercises about a crank-rocker."""

import numpy as np

from coursework.degrees import cos, polar
from coursework.kinematics.dyads import rrr, side_of


def bars(r1, r2, r3, r4, theta2, mode):
    """Vectors OA, AB and CB."""
    A, C = polar(r2, theta2), r1 + 0j
    B = rrr(A, C, r3, r4, side_of(mode))
    return A, B - A, B - C


def crank_turns(r1, r2, r3, r4):
    """The crank is the shortest bar, and clears both of its aligned positions."""
    return (r2 < np.minimum(np.minimum(r1, r3), r4)) & (abs(r3 - r4) < r1 - r2) & (r1 + r2 < r3 + r4)


def transmission_angle_from_30_to_150(r1, r2, r3, r4):
    """Its extremes are those of AC, by the law of cosines."""
    around, slack = r3**2 + r4**2, 2 * r3 * r4 * cos(30)
    return ((r1 - r2) ** 2 >= around - slack) & ((r1 + r2) ** 2 <= around + slack)


def crank_off_the_frame(theta2):
    """In line with it, coupler and rocker turn alike, and in both modes."""
    return theta2 % 180 != 0


def crank_turns_visibly(omega2):
    return abs(omega2) >= 2
