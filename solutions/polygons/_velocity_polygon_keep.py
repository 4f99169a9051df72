"""Velocity polygon of a four-bar linkage: the conditions on answers that a variant must satisfy."""

from ...exercises._drawn import all_long
from ...exercises._told_speeds import rates

__all__ = ["HELPERS", "KEEP"]


def vectors_are_long_enough_to_draw(bars, rates):
    """The shortest is a third of the longest at least."""
    crank, coupler, rocker = bars
    return all_long(1 / 3, crank, rates[0] * coupler, rates[1] * rocker)


HELPERS = (rates,)
KEEP = (vectors_are_long_enough_to_draw,)
