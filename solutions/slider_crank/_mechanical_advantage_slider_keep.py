"""Mechanical advantage of a slider-crank: the conditions on answers that a variant must satisfy."""

import numpy as np

from coursework.degrees import sin

from ._rates_keep import rates, rod_turns_visibly

__all__ = ["HELPERS", "KEEP"]


def piston_moves_visibly(rates, r2):
    return abs(rates[1]) > 0.15 * r2


def _tells(wrong, right):
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    gap = abs(wrong - right) / abs(0.01 * right)
    return (gap > 2) | (gap < 0.25)


def inverse_tells(rates, r2):
    advantage = r2 / abs(rates[1])
    return _tells(1 / advantage, advantage)


def velocity_of_the_rod_tells(rates, r3):
    return _tells(abs(rates[0]) * r3, abs(rates[1]))


def rotation_of_the_rod_tells(rates, rod, r2, theta2):
    """Left out of the piston's velocity, or of the wrong sign in it."""
    crank_alone, of_rod = -r2 * sin(theta2), rates[0] * rod.imag
    mistaken = (crank_alone, crank_alone + of_rod)
    pairs = [(wrong, rates[1]) for wrong in mistaken] + [(abs(wrong), abs(rates[1])) for wrong in mistaken]
    return np.all([_tells(wrong, right) for wrong, right in pairs], axis=0)


HELPERS = (rates,)
KEEP = (
    rod_turns_visibly,
    piston_moves_visibly,
    inverse_tells,
    velocity_of_the_rod_tells,
    rotation_of_the_rod_tells,
)
