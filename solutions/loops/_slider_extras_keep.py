"""Six links, two loops: the conditions on answers that a variant must satisfy."""

from ...exercises._drawn import cross
from ...exercises._told_speeds import six_link_rates

__all__ = ["HELPERS", "KEEP"]


def accelerations(six_link_rates, pin_A, pin_B, pin_P, r1):
    """alpha3, alpha4, alpha5 over omega2 squared, and r6_ddot over it."""
    crank, coupler, rocker, rod = pin_A - 1j * r1, pin_B - pin_A, pin_B, pin_B - pin_P
    w3, w4, w5, _ = six_link_rates
    normal = crank + w3**2 * coupler - w4**2 * rocker
    a3 = (normal * rocker.conjugate()).real / cross(coupler, rocker)
    a4 = -(normal * coupler.conjugate()).real / cross(rocker, coupler)
    pin_B_acceleration = (1j * a4 - w4**2) * rocker
    a5 = (pin_B_acceleration.imag + w5**2 * rod.imag) / rod.real
    return a3, a4, a5, (pin_B_acceleration - (1j * a5 - w5**2) * rod).real


def coupler_turns_visibly(six_link_rates):
    return abs(six_link_rates[0]) > 0.06


def rocker_turns_visibly(six_link_rates):
    return abs(six_link_rates[1]) > 0.06


def rod_turns_visibly(six_link_rates):
    return abs(six_link_rates[2]) > 0.03


def slider_moves_visibly(six_link_rates, r2):
    return abs(six_link_rates[3]) > 0.15 * r2


def links_accelerate_visibly(accelerations):
    a3, a4, a5, _ = accelerations
    return (abs(a3) > 0.08) & (abs(a4) > 0.08) & (abs(a5) > 0.03)


def slider_accelerates_visibly(accelerations, r2):
    return abs(accelerations[3]) > 0.2 * r2


def rod_normal_acceleration_counts(six_link_rates, accelerations, pin_B, pin_P):
    return abs(six_link_rates[2] ** 2 * (pin_B - pin_P).real) > 0.022 * abs(accelerations[3])


HELPERS = (six_link_rates, accelerations)
KEEP = (
    coupler_turns_visibly,
    rocker_turns_visibly,
    rod_turns_visibly,
    slider_moves_visibly,
    links_accelerate_visibly,
    slider_accelerates_visibly,
    rod_normal_acceleration_counts,
)
