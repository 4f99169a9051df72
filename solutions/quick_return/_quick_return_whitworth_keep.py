"""Whitworth's quick return: the conditions on answers that a variant must satisfy."""

from coursework.degrees import asin, atan, cos, polar, sqrt
from coursework.kinematics.dyads import rrp

from ._rates_keep import guide_gain, guide_rate, ram_accelerates_visibly, ram_gain

__all__ = ["HELPERS", "KEEP"]


def _rod_share(P, C):
    """Contribution of the rod's rotation to the velocity of C, over omega4."""
    rod = C - P
    return P.real * rod.imag / rod.real


def _ram(P, r5, h, guide_rate):
    """xC, and v_C over omega2."""
    C = rrp(P, r5, h)
    return C.real, guide_rate * (_rod_share(P, C) - P.imag)


def ram(P, r5, h, guide_rate):
    return _ram(P, r5, h, guide_rate)


def stroke(r4, r5, h):
    return sqrt((r5 + r4) ** 2 - h**2) - sqrt((r5 - r4) ** 2 - h**2)


def lines_to_the_ends(r4, r5, h):
    """Inclinations of O4-C at the near and the far end."""
    return asin(h / (r5 - r4)), asin(h / (r5 + r4))


def _unequal_halves(lines, at_A):
    """(alpha - beta) / 2, from the angles at A between guide and crank."""
    return abs(lines[0] - lines[1] + at_A[0] + at_A[1])


def unequal_halves(lines_to_the_ends, r1, r2):
    return _unequal_halves(lines_to_the_ends, [asin(r1 * cos(line) / r2) for line in lines_to_the_ends])


def ram_moves_visibly(ram, r4):
    return abs(ram[1]) > 0.15 * r4


def _told_apart(wrong, right):
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    gap = abs(wrong - right) / abs(0.01 * right)
    return (gap > 2) | (gap < 0.25)


def _tells(wrong, ram):
    return _told_apart(wrong[0], ram[0]) & _told_apart(wrong[1], ram[1])


def _arcs_tell(wrong, right):
    """In the angles themselves, in the shares of the turn that they are, and in their ratio."""
    advance, back = 180 + right, 180 - right
    ratio = _told_apart((180 + wrong) / (180 - wrong), advance / back)
    gap = abs(wrong - right)
    return ratio & ((gap > 0.02 * advance) | (gap < 0.0025 * back))


def place_of_the_rod_on_the_guide_tells(arm, r5, h, guide_rate, ram):
    return _tells(_ram(arm, r5, h, guide_rate), ram)


def turning_of_the_guide_tells(r4, theta2, r5, h, ram):
    return _tells(_ram(polar(r4, theta2), r5, h, 1.0), ram)


def quadrant_of_the_guide_tells(P, arm, r5, h, guide_rate, ram):
    return _tells(_ram(-P, r5, h, -guide_rate), ram) | (arm.real > 0)


def rotation_of_the_rod_tells(P, guide_rate, ram):
    return _told_apart(-guide_rate * P.imag, ram[1])


def stroke_is_not_twice_the_crank(stroke, r2):
    return _told_apart(2 * r2, stroke)


def sine_and_tangent_tell(lines_to_the_ends, unequal_halves, r1, r2):
    wrong = [atan(r1 * cos(line) / r2) for line in lines_to_the_ends]
    return _arcs_tell(_unequal_halves(lines_to_the_ends, wrong), unequal_halves)


def height_of_the_line_tells(unequal_halves, r1, r2):
    return _arcs_tell(2 * asin(r1 / r2), unequal_halves)


HELPERS = (guide_rate, guide_gain, ram, ram_gain, stroke, lines_to_the_ends, unequal_halves)
KEEP = (
    ram_moves_visibly,
    ram_accelerates_visibly,
    place_of_the_rod_on_the_guide_tells,
    turning_of_the_guide_tells,
    quadrant_of_the_guide_tells,
    rotation_of_the_rod_tells,
    stroke_is_not_twice_the_crank,
    sine_and_tangent_tell,
    height_of_the_line_tells,
)
