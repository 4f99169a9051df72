"""Velocity polygon of six links: the conditions on answers that a variant must satisfy."""

from ...exercises._drawn import all_long
from ...exercises._told_speeds import six_link_rates

__all__ = ["HELPERS", "KEEP"]


def vectors_are_long_enough_to_draw(six_link_rates, pin_A, pin_B, pin_P, r1):
    """A quarter of the longest at least, that of the slider about B an eighth."""
    w3, w4, w5, slide = six_link_rates
    others = pin_A - 1j * r1, w3 * (pin_B - pin_A), w4 * pin_B, slide
    return all_long(1 / 4, *others) & all_long(1 / 8, w5 * (pin_P - pin_B), *others)


HELPERS = (six_link_rates,)
KEEP = (vectors_are_long_enough_to_draw,)
