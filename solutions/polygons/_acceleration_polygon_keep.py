"""Acceleration polygon of a four-bar linkage whose velocities are known (equations 14 and 15, Figure 23): the conditions on answers that a variant must satisfy."""

from ...exercises._drawn import all_long, cross, dot
from ...exercises._told_speeds import rates

__all__ = ["HELPERS", "KEEP"]


def of_four_bar(bars, rates):
    """The sides of the acceleration polygon over omega2 squared, at a constant rate of the crank: of A, of B about A
    and of B, each of the two normal then tangential."""
    crank, coupler, rocker = bars
    omega3, omega4 = rates
    along = crank + omega3**2 * coupler - omega4**2 * rocker
    area = cross(coupler, rocker)
    alpha3, alpha4 = dot(along, rocker) / area, dot(along, coupler) / area
    return -crank, -(omega3**2) * coupler, 1j * alpha3 * coupler, -(omega4**2) * rocker, 1j * alpha4 * rocker


def vectors_are_long_enough_to_draw(of_four_bar):
    """The normal ones a ninth of the longest at least, the tangential ones and that of B two ninths."""
    of_A, normal_BA, tangential_BA, normal_B, tangential_B = of_four_bar
    of_B = normal_B + tangential_B
    normal = all_long(1 / 9, of_A, normal_BA, normal_B, tangential_BA, tangential_B, of_B)
    longest = (2 * normal_BA, 2 * normal_B)  # two ninths of the others are asked, one of these
    return normal & all_long(2 / 9, of_A, *longest, tangential_BA, tangential_B, of_B)


HELPERS = (rates, of_four_bar)
KEEP = (vectors_are_long_enough_to_draw,)
