"""The speeds that statements tell: those of a drawing of accelerations, where velocities are known. Over the rate of the crank."""

from coursework.kinematics.vectors import cross, dot


def rates(bars):
    """omega3 and omega4 of a four-bar linkage, from its :func:`~._drawn.bars`."""
    crank, coupler, rocker = bars
    area = cross(rocker, coupler)
    return cross(crank, rocker) / area, cross(crank, coupler) / area


def rod_rate(rod, crank):
    """omega3 of a slider-crank, from the vectors of rod and crank."""
    return -crank.real / rod.real


def guide_rates(guided):
    """Of a slotted guide, and of the block along it."""
    crank, arm = guided
    return dot(crank, arm) / abs(arm) ** 2, dot(1j * crank, guided.along)


def six_link_rates(pin_A, pin_B, pin_P, r1):
    """omega3, omega4, omega5, and r6_dot."""
    crank, coupler, rocker, rod = pin_A - 1j * r1, pin_B - pin_A, pin_B, pin_B - pin_P
    coupler_rate = -cross(crank, rocker) / cross(coupler, rocker)
    rocker_rate = cross(crank, coupler) / cross(rocker, coupler)
    rod_rate = rocker_rate * rocker.real / rod.real
    return coupler_rate, rocker_rate, rod_rate, (rod_rate - rocker_rate) * rocker.imag
