"""Acceleration polygon of a slotted mechanism whose velocities are known: the conditions on answers that a variant must satisfy."""

from ...exercises._drawn import all_long
from ._guided_keep import guide_rates, sliding_motion

__all__ = ["HELPERS", "KEEP"]


def vectors_are_long_enough_to_draw(sliding_motion):
    """The normal one a ninth of the longest at least, the others two ninths."""
    of_A2, coriolis, normal, tangential, sliding = sliding_motion.accelerations
    others = (of_A2, coriolis, tangential, sliding)
    return all_long(1 / 9, normal, *others) & all_long(2 / 9, *others)


HELPERS = (guide_rates, sliding_motion)
KEEP = (vectors_are_long_enough_to_draw,)
