"""Shaper: the conditions on answers that a variant must satisfy."""

from coursework.degrees import polar
from coursework.kinematics.dyads import rrp

from ._rates_keep import guide_gain, guide_rate, ram_accelerates_visibly, ram_gain

__all__ = ["HELPERS", "KEEP"]


def _ram(P, r5, h, guide_rate):
    """xC, and v_C over omega2."""
    C = rrp(P, r5, h)
    rod = C - P
    return C.real, guide_rate * (P.real * rod.imag / rod.real - P.imag)


def ram(P, r5, h, guide_rate):
    return _ram(P, r5, h, guide_rate)


def ram_away_from_the_y_axis(ram, r5):
    return abs(ram[0]) > 0.5 * r5


def ram_moves_visibly(ram, r2):
    return abs(ram[1]) > 0.25 * r2


def _told_apart(wrong, right):
    """Whether a mistake moves a value by two tolerances and more, not at all, or to where nothing closes."""
    gap = abs(wrong - right) / abs(0.01 * right)
    return ~((gap <= 2) & (gap >= 0.25))


def _tells(wrong, ram):
    return _told_apart(wrong[0], ram[0]) & _told_apart(wrong[1], ram[1])


def place_of_the_rod_on_the_guide_tells(arm, r5, h, guide_rate, ram):
    return _tells(_ram(arm, r5, h, guide_rate), ram)


def turning_of_the_guide_tells(r4, theta2, r5, h, ram):
    return _tells(_ram(polar(r4, theta2), r5, h, 1.0), ram)


def projection_on_the_guide_tells(arm, P, r2, r5, h, ram):
    return _tells(_ram(P, r5, h, r2 / abs(arm)), ram)


HELPERS = (guide_rate, guide_gain, ram, ram_gain)
KEEP = (
    ram_away_from_the_y_axis,
    ram_moves_visibly,
    ram_accelerates_visibly,
    place_of_the_rod_on_the_guide_tells,
    turning_of_the_guide_tells,
    projection_on_the_guide_tells,
)
