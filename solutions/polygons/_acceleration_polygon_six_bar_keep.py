"""Acceleration polygon of six links whose velocities are known: the conditions on answers that a variant must satisfy."""

import numpy as np

from coursework.marking.drawn_polygons import scale_for

from ...exercises._drawn import all_long
from ..loops._slider_extras_keep import accelerations, six_link_rates

__all__ = ["HELPERS", "KEEP"]


def sides(six_link_rates, accelerations, pin_A, pin_B, pin_P, r1):
    """Of A; of B about A, of B and of C about B, each normal then tangential; of C. Over omega2 squared."""
    crank, coupler, rod = pin_A - 1j * r1, pin_B - pin_A, pin_P - pin_B
    w3, w4, w5, _ = six_link_rates
    a3, a4, a5, of_C = accelerations
    return (
        -crank,
        -(w3**2) * coupler,
        1j * a3 * coupler,
        -(w4**2) * pin_B,
        1j * a4 * pin_B,
        -(w5**2) * rod,
        1j * a5 * rod,
        of_C,
    )


def vectors_are_long_enough_to_draw(sides):
    """An eighth of the longest at least, but for the normal ones and those of C about B."""
    of_A, _, tangential_BA, _, tangential_B, _, _, of_C = sides
    return all_long(1 / 8, of_A, tangential_BA, tangential_B, of_C)


def drawing_fills_its_paper(sides, omega2):
    """At its round scale the longest vector has 42 mm at least, and the shortest known ones 4.2."""
    of_A, normal_BA, _, normal_B, tangential_B, normal_C, _, of_C = (omega2**2 * side for side in sides)
    of_B = normal_B + tangential_B
    points = of_A, of_A + normal_BA, normal_B, of_B, of_B + normal_C, of_C + 0 * of_A
    lengths = [omega2**2 * abs(side) / scale_for(*points) for side in sides]
    shortest = np.minimum.reduce([lengths[k] for k in (1, 3, 5)])
    return (np.maximum.reduce(lengths) > 42) & (shortest > 4.2)


HELPERS = (six_link_rates, accelerations, sides)
KEEP = (vectors_are_long_enough_to_draw, drawing_fills_its_paper)
