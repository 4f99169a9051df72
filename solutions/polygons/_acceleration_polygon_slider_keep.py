"""Acceleration polygon of a slider-crank whose velocities are known (equations 14 and 15, Figure 22): the conditions on answers that a variant must satisfy."""

from coursework.degrees import polar

from ...exercises._drawn import all_long
from ...exercises._told_speeds import rod_rate

__all__ = ["HELPERS", "KEEP"]


def of_slider_crank(rod, r2, theta2):
    """The sides of the acceleration polygon over omega2 squared, at a constant rate of the crank: of A, of B about A
    normal then tangential, of B."""
    crank = polar(r2, theta2)
    omega3 = rod_rate(rod, crank)
    alpha3 = (crank.imag + omega3**2 * rod.imag) / rod.real
    tangential = 1j * alpha3 * rod
    return -crank, -(omega3**2) * rod, tangential, -crank - omega3**2 * rod + tangential


def vectors_are_long_enough_to_draw(of_slider_crank):
    """The normal one an eighth of the longest at least, the others a quarter."""
    of_A, normal, tangential, of_B = of_slider_crank
    return all_long(1 / 8, of_A, normal, tangential, of_B) & all_long(1 / 4, of_A, tangential, of_B)


HELPERS = (of_slider_crank,)
KEEP = (vectors_are_long_enough_to_draw,)
