"""Conditions that exercises share about the rates of a slider-crank."""

from coursework.degrees import cos, sin


def rates(rod, r2, theta2):
    """omega3 and r1_dot, over omega2."""
    omega3 = -r2 * cos(theta2) / rod.real
    return omega3, -r2 * sin(theta2) - omega3 * rod.imag


def rod_turns_visibly(rates, r2, r3):
    return abs(rates[0]) * r3 > 0.1 * r2
