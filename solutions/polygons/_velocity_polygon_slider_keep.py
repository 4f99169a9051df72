"""Velocity polygon of a slider-crank: the conditions on answers that a variant must satisfy."""

from coursework.degrees import cos, polar, sin

from ...exercises._drawn import all_long

__all__ = ["HELPERS", "KEEP"]


def vectors_are_long_enough_to_draw(rod, r2, theta2):
    """The shortest is a third of the longest at least; over omega2."""
    omega3 = -r2 * cos(theta2) / rod.real
    return all_long(1 / 3, polar(r2, theta2), omega3 * rod, -r2 * sin(theta2) - omega3 * rod.imag)


HELPERS = ()
KEEP = (vectors_are_long_enough_to_draw,)
