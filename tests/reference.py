"""Fifty-digit references: the textbook constructions, with the inputs taken as the exact numbers they are."""

from __future__ import annotations

import mpmath

mp = mpmath.MPContext()
mp.dps = 50


def exact(*values):
    return [mp.mpf(float(value)) for value in values]


def four_bar(d, a, b, c, theta, side=1, *, radians=True):
    """Angles of coupler and rocker, and B, by the intersection of two circles."""
    d, a, b, c = exact(d, a, b, c)
    turn = theta if isinstance(theta, mp.mpf) else mp.mpf(float(theta))
    pin = a * mp.expj(turn if radians else turn * mp.pi / 180)
    line = d - pin
    length = abs(line)
    along = (length**2 + b**2 - c**2) / (2 * length)
    joint = pin + line / length * (along + 1j * side * mp.sqrt(b**2 - along**2))
    return mp.arg(joint - pin), mp.arg(joint - d), joint


def slider_crank(r, l, e, theta, side=1):
    """Angle of the rod and abscissa of the slider."""
    r, l, e = exact(r, l, e)
    turn = theta if isinstance(theta, mp.mpf) else mp.mpf(float(theta))
    rise = e - r * mp.sin(turn)
    run = side * mp.sqrt(l**2 - rise**2)
    return mp.atan2(rise, run), r * mp.cos(turn) + run


def turned(crank_angle, rate, acceleration, jerk):
    """The crank angle as a function of time near 0."""
    start, rate, acceleration, jerk = exact(crank_angle, rate, acceleration, jerk)
    return lambda t: start + rate * t + acceleration * t**2 / 2 + jerk * t**3 / 6


def away(found, expected):
    """The smallest absolute difference of two directions."""
    turn = 2 * mp.pi
    apart = mp.mpf(float(found)) - expected
    return float(abs(apart - turn * mp.nint(apart / turn)))


def relative(found, expected):
    return float(abs((mp.mpf(float(found)) - expected) / expected))
