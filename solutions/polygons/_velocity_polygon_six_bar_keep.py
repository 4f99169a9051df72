"""Velocity polygon of six links: the conditions on answers that a variant must satisfy."""

import numpy as np

from ...exercises._drawn import all_long, cross
from ...exercises._told_speeds import six_link_rates

__all__ = ["HELPERS", "KEEP"]


def vectors_are_long_enough_to_draw(six_link_rates, pin_A, pin_B, pin_P, r1):
    """A quarter of the longest at least, that of the slider about B an eighth."""
    w3, w4, w5, slide = six_link_rates
    others = pin_A - 1j * r1, w3 * (pin_B - pin_A), w4 * pin_B, slide
    return all_long(1 / 4, *others) & all_long(1 / 8, w5 * (pin_P - pin_B), *others)


def slider_moves_after_a_tilted_line(pin_A, pin_B, pin_P, r1):
    """Who tilts the line of B about A finds a velocity of the slider that can be seen all the same."""
    a, along, path, rod = (
        1j * (pin_A - 1j * r1),
        (pin_B - pin_A) * np.exp(-0.35j),
        1j * pin_B,
        1j * (pin_P - pin_B),
    )
    b = path * cross(1j * along, a) / cross(1j * along, path)
    return abs(b.real - b.imag * rod.real / rod.imag) > abs(a) / 8


HELPERS = (six_link_rates,)
KEEP = (vectors_are_long_enough_to_draw, slider_moves_after_a_tilted_line)
