"""Common base of exercises in which a slotted guide drives a ram."""

from coursework.degrees import polar, wrap
from coursework.kinematics.dyads import rrp


def arm(r1, r2, theta2):
    """Vector O4A."""
    return 1j * r1 + polar(r2, theta2)


def P(arm, r4):
    return r4 * arm / abs(arm)


def C(P, r5, h):
    return rrp(P, r5, h)


def crank_off_the_axes(theta2):
    return theta2 % 90 >= 5


def ram_accelerates_visibly(a_C, r2, omega2):
    return abs(a_C) > 0.2 * r2 * omega2**2


def _clearest(*directions):
    """The direction, by steps of 15 degrees, that is farthest from all of these."""
    return max(range(0, 360, 15), key=lambda way: min(abs(wrap(way - taken)) for taken in directions))
