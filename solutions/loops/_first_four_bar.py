"""Quantities of mechanisms whose first loop is a four-bar linkage O, A, B, C, with the pivot C anywhere.

Each solves it as its own ``_loop_1``, by the numeric core, which keeps digits near a dead point.
"""

from coursework.degrees import cos, sin, sqrt
from coursework.solution import stable


def AC(xC, yC, r2, theta2):
    return sqrt((xC - r2 * cos(theta2)) ** 2 + (yC - r2 * sin(theta2)) ** 2)


@stable(lambda omega2, _loop_1: _loop_1.coupler_ratio * omega2)
def omega3(r2, omega2, r3, theta2, theta3, theta4):
    return r2 * omega2 * sin(theta2 - theta4) / (r3 * sin(theta4 - theta3))


@stable(lambda omega2, _loop_1: _loop_1.rocker_ratio * omega2)
def omega4(r2, omega2, r4, theta2, theta3, theta4):
    return r2 * omega2 * sin(theta2 - theta3) / (r4 * sin(theta4 - theta3))


@stable(lambda omega2, _loop_1: _loop_1.rocker_gain * omega2**2)
def alpha4(r2, omega2, theta2, r3, omega3, theta3, r4, omega4, theta4):
    """The accelerations of B by coupler and rocker have the same projection along the coupler."""
    return (
        r2 * omega2**2 * cos(theta2 - theta3) + r3 * omega3**2 - r4 * omega4**2 * cos(theta4 - theta3)
    ) / (r4 * sin(theta4 - theta3))
