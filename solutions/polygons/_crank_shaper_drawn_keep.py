"""Crank and slotted lever, solved on paper: the conditions on answers that a variant must satisfy."""

from typing import Any, NamedTuple

from ...exercises._drawn import all_long
from ._guided_keep import guide_rates, sliding_motion

__all__ = ["HELPERS", "KEEP"]


class RamMotion(NamedTuple):
    """At unit rate of the crank: the velocities of D, of E about D and of E; the accelerations of D, of E about D,
    normal then tangential, and of E."""

    velocities: tuple[Any, Any, Any]
    accelerations: tuple[Any, Any, Any, Any]


def ram_motion(ram, sliding_motion):
    lever, rod = ram
    v_D = 1j * sliding_motion.guide_rate * lever
    rate = -v_D.imag / rod.real
    a_D = (1j * sliding_motion.guide_gain - sliding_motion.guide_rate**2) * lever
    normal = -(rate**2) * rod
    tangential = -1j * (a_D + normal).imag / rod.real * rod
    velocities = v_D, 1j * rate * rod, (v_D + 1j * rate * rod).real
    return RamMotion(velocities, (a_D, normal, tangential, (a_D + normal + tangential).real))


def velocities_are_long_enough_to_draw(sliding_motion, ram_motion):
    v_D, of_rod, v_E = ram_motion.velocities
    *of_pins, sliding = sliding_motion.velocities
    return all_long(1 / 6, *of_pins, sliding, v_D, v_E) & all_long(1 / 12, of_rod, *of_pins, v_D)


def accelerations_are_long_enough_to_draw(sliding_motion, ram_motion):
    of_P2, coriolis, normal, tangential, sliding = sliding_motion.accelerations
    a_D, _, of_rod, a_E = ram_motion.accelerations
    others = of_P2, coriolis, tangential, sliding, a_D, a_E
    return all_long(1 / 6, *others) & all_long(1 / 15, normal, of_rod, *others)


HELPERS = (guide_rates, sliding_motion, ram_motion)
KEEP = (velocities_are_long_enough_to_draw, accelerations_are_long_enough_to_draw)
