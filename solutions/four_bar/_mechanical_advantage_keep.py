"""Mechanical advantage of a four-bar linkage: the conditions on answers that a variant must satisfy."""

from coursework.kinematics.vectors import cross

__all__ = ["HELPERS", "KEEP"]


def rates(bars):
    """omega3 and omega4, over omega2."""
    crank, coupler, rocker = bars
    area = cross(rocker, coupler)
    return cross(crank, rocker) / area, cross(crank, coupler) / area


def rates_of_other_mode(bars, r1):
    """B mirrored in the line AC."""
    crank, coupler, _ = bars
    line = r1 - crank
    mirrored = line * (coupler / line).conjugate()
    return rates((crank, mirrored, mirrored - line))


def advantage(rates, r2, r4):
    return r2 / (r4 * abs(rates[1]))


def links_turn_visibly(rates):
    return (abs(rates[0]) > 0.08) & (abs(rates[1]) > 0.08)


def _tells(wrong, right):
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    gap = abs(wrong - right) / abs(0.01 * right)
    return (gap > 2) | (gap < 0.25)


def inverse_tells(advantage, rates):
    return _tells(1 / advantage, advantage) & _tells(abs(rates[1]), 1 / abs(rates[1]))


def velocity_of_the_rod_tells(rates, r3, r4):
    return _tells(r3 * abs(rates[0]), r4 * abs(rates[1]))


def difference_of_the_angles_tells(bars, rates):
    """From their sum, in the sine that divides omega4."""
    _, coupler, rocker = bars
    wrong = rates[1] * cross(coupler, rocker) / cross(coupler.conjugate(), rocker)
    return _tells(wrong, rates[1]) & _tells(abs(wrong), abs(rates[1]))


def mode_tells(rates_of_other_mode, rates):
    wrong, right = rates_of_other_mode[1], rates[1]
    return _tells(wrong, right) & _tells(abs(wrong), abs(right))


HELPERS = (
    rates,
    rates_of_other_mode,
    advantage,
)
KEEP = (
    links_turn_visibly,
    inverse_tells,
    velocity_of_the_rod_tells,
    difference_of_the_angles_tells,
    mode_tells,
)
