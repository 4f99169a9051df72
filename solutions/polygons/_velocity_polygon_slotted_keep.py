"""Velocity polygon of a slotted mechanism: the conditions on answers that a variant must satisfy."""

from ...exercises._drawn import all_long
from ._guided_keep import guide_rates, sliding_motion

__all__ = ["HELPERS", "KEEP"]


def vectors_are_long_enough_to_draw(sliding_motion):
    """The shortest is a third of the longest at least."""
    return all_long(1 / 3, *sliding_motion.velocities)


HELPERS = (guide_rates, sliding_motion)
KEEP = (vectors_are_long_enough_to_draw,)
