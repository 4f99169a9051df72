"""Shaper that cuts: the conditions on answers that a variant must satisfy."""

import math

import numpy as np

from ...exercises.quick_return._slotted_ram import C, P, arm
from ...exercises.quick_return.shaper_torque import STEP
from ._quick_return_shaper_keep import (
    place_of_the_rod_on_the_guide_tells,
    projection_on_the_guide_tells,
    ram,
    ram_away_from_the_y_axis,
    ram_moves_visibly,
    turning_of_the_guide_tells,
)
from ._rates_keep import guide_rate

__all__ = ["HELPERS", "KEEP"]


def table(r1, r2, r4, r5, h):
    """How far the ram goes to the left per radian of the crank, at crank angles along a first axis: every 5 degrees
    from -90 to 270, over the stroke that a radian has on average."""
    shape = (-1,) + (1,) * np.ndim(r1)
    theta = np.arange(-90.0, 271.0, STEP).reshape(shape)
    guide = arm(r1, r2, theta)
    pin = P(guide, r4)
    rod = C(pin, r5, h + 0 * theta) - pin
    rate = guide_rate(guide, r1, r2, theta)
    return rate * (pin.imag - pin.real * rod.imag / rod.real) * math.pi * r1 / (r4 * r2)


def crossings(table):
    """How many steps of the table the mean lies in."""
    above = table > 1
    return (above[1:] != above[:-1]).sum(axis=0)


def torque_crosses_its_mean_twice(crossings):
    return crossings == 2


def crossings_lie_within_their_steps(table):
    """By a twentieth at least, so that nobody doubts which step it is."""
    before, after = table[:-1] - 1, table[1:] - 1
    share = before / (before - after)
    return ~((before * after < 0) & ((share < 0.05) | (share > 0.95))).any(axis=0)


def torque_is_not_near_its_mean(ram, r1, r2, r4):
    return abs(abs(ram[1]) * math.pi * r1 / (r4 * r2) - 1) > 0.08


HELPERS = (guide_rate, ram, table, crossings)
KEEP = (
    ram_away_from_the_y_axis,
    ram_moves_visibly,
    place_of_the_rod_on_the_guide_tells,
    turning_of_the_guide_tells,
    projection_on_the_guide_tells,
    torque_is_not_near_its_mean,
    torque_crosses_its_mean_twice,
    crossings_lie_within_their_steps,
)
