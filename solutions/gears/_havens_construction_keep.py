"""Havens planetary gear, constructed: the conditions on answers that a variant must satisfy."""

from ...exercises._drawn import all_long
from ._havens_planetary_keep import speeds, velocity_of_B2

__all__ = ["HELPERS", "KEEP"]


def velocity_of_I(speeds, r2, r3):
    """Over omega1, 90 degrees ahead of the crank: a point of the wheel, which turns as the guide does."""
    return r2 + r3 - r2 * speeds[0]


def vectors_are_long_enough_to_draw(speeds, arm, r2, r3, velocity_of_B2, velocity_of_I):
    """The shortest is a sixth of the longest at least."""
    of_guide = speeds[0] * abs(arm)
    return all_long(1 / 6, r2 + r3 + 0 * of_guide, of_guide, speeds[1], velocity_of_B2, velocity_of_I)


HELPERS = (speeds, velocity_of_B2, velocity_of_I)
KEEP = (vectors_are_long_enough_to_draw,)
