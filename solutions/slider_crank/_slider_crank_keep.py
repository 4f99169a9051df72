"""Slider-crank: the conditions on answers that a variant must satisfy."""

import numpy as np

from coursework.degrees import cos, sin

from ._rates_keep import rates, rod_turns_visibly

__all__ = ["HELPERS", "KEEP"]


def accelerations(rates, rod, r2, theta2):
    """alpha3 and r1_ddot, over omega2 squared, at a constant rate of the crank."""
    omega3, _ = rates
    alpha3 = (r2 * sin(theta2) + omega3**2 * rod.imag) / rod.real
    return alpha3, -r2 * cos(theta2) - alpha3 * rod.imag - omega3**2 * rod.real


def piston_moves_visibly(rates, r2):
    return abs(rates[1]) > 0.1 * r2


def rod_accelerates_visibly(accelerations, r2, r3):
    return abs(accelerations[0]) * r3 > 0.1 * r2


def piston_accelerates_visibly(accelerations, r2):
    return abs(accelerations[1]) > 0.15 * r2


def _told_apart(wrong, right, paper):
    """Whether a mistake moves a value by two tolerances and more, or not at all: computed, and drawn."""
    computed = abs(wrong - right) / abs(0.01 * right)
    drawn = paper * abs(abs(wrong) - abs(right)) / np.maximum(1.0, 0.02 * paper * abs(right))
    return ((computed > 2) | (computed < 0.25)) & ((drawn > 2) | (drawn < 0.25))


def inclination_of_the_rod_tells(rates, accelerations, rod, r2, r3, theta2, omega2, ka):
    """A rod that falls where it should rise has another acceleration, and so has the piston."""
    omega3, (alpha3, r1_ddot) = rates[0], accelerations
    wrong = (r2 * sin(theta2) - omega3**2 * rod.imag) / rod.real
    of_piston = -r2 * cos(theta2) + wrong * rod.imag - omega3**2 * rod.real
    paper = omega2**2 / ka
    return _told_apart(wrong * r3, alpha3 * r3, paper) & _told_apart(of_piston, r1_ddot, paper)


def rotation_of_the_rod_tells(rates, accelerations, rod, r2, theta2, omega2, kv, ka):
    """In the velocity of the piston and, by the normal term, in its acceleration."""
    omega3, r1_dot = rates
    without = accelerations[1] + omega3**2 * rod.real
    in_velocity = _told_apart(-r2 * sin(theta2), r1_dot, abs(omega2) / kv)
    return in_velocity & _told_apart(without, accelerations[1], omega2**2 / ka)


HELPERS = (
    rates,
    accelerations,
)
KEEP = (
    rod_turns_visibly,
    piston_moves_visibly,
    rod_accelerates_visibly,
    piston_accelerates_visibly,
    inclination_of_the_rod_tells,
    rotation_of_the_rod_tells,
)
