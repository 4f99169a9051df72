"""Crank and guide of a Havens planetary gear where they turn nearly alike."""

from coursework.kinematics.angles import Degrees
from coursework.kinematics.slotted_guide import SlottedGuidePose

__all__ = ["_lag"]


def _lag(d, r2, r3, theta1):
    """(omega1 - omega4) / omega1: the ratio of the rates with crank and frame exchanged."""
    return SlottedGuidePose(r2 + r3, d, Degrees(theta1)).guide_ratio
