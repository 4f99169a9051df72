"""Conditions that exercises share about the rates of a slotted guide and of the ram that it drives."""

from coursework.degrees import cos, sin


def guide_rate(arm, r1, r2, theta2):
    """omega4 / omega2."""
    return r2 * (r2 + r1 * sin(theta2)) / abs(arm) ** 2


def guide_gain(arm, guide_rate, r1, r2, theta2):
    """alpha4 / omega2**2, the crank at a constant rate."""
    return r1 * r2 * cos(theta2) * (1 - 2 * guide_rate) / abs(arm) ** 2


def ram_gain(P, C, guide_rate, guide_gain):
    """a_C / omega2**2."""
    rod = C - P
    turning = -guide_rate * P.real / rod.real
    gain = (guide_rate**2 * P.imag - guide_gain * P.real + turning**2 * rod.imag) / rod.real
    return -guide_gain * P.imag - guide_rate**2 * P.real - gain * rod.imag - turning**2 * rod.real


def ram_accelerates_visibly(ram_gain, r2):
    return abs(ram_gain) > 0.2 * r2
