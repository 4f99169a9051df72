"""Slotted mechanism: the conditions on answers that a variant must satisfy."""

from coursework.degrees import cos

__all__ = ["HELPERS", "KEEP"]


def turning_speed(arm, r1, theta1, r2, theta2):
    """omega4 / omega2."""
    return r2 * (r2 + r1 * cos(theta2 - theta1)) / abs(arm) ** 2


def guide_turns_visibly(turning_speed):
    return abs(turning_speed) > 0.08


HELPERS = (turning_speed,)
KEEP = (guide_turns_visibly,)
