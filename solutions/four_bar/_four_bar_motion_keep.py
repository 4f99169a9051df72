"""Four-bar linkage: the conditions on answers that a variant must satisfy."""

import numpy as np

__all__ = ["HELPERS", "KEEP"]


def motion(bars, omega2, alpha2):
    crank, coupler, rocker = bars
    area = _cross(rocker, coupler)
    omega3, omega4 = omega2 * _cross(crank, rocker) / area, omega2 * _cross(crank, coupler) / area
    return omega3, omega4, *_accelerations(bars, omega2, alpha2, omega3, omega4)


def _accelerations(bars, omega2, alpha2, omega3, omega4):
    """alpha3 and alpha4 that go with these rates."""
    crank, coupler, rocker = bars
    along = (omega2**2 - 1j * alpha2) * crank + omega3**2 * coupler - omega4**2 * rocker
    area = _cross(coupler, rocker)
    return _dot(along, rocker) / area, _dot(along, coupler) / area


def _cross(u, v):
    return u.real * v.imag - u.imag * v.real


def _dot(u, v):
    return u.real * v.real + u.imag * v.imag


def links_turn_visibly(motion, omega2):
    return (abs(motion[0]) > 0.05 * abs(omega2)) & (abs(motion[1]) > 0.05 * abs(omega2))


def links_accelerate_visibly(motion, omega2):
    return (abs(motion[2]) > 0.03 * omega2**2) & (abs(motion[3]) > 0.03 * omega2**2)


def _tells(wrong, right):
    """Return whether a mistake changes the values by at least two tolerances, or not at all."""
    apart = [
        abs(mistaken - value) / abs(0.01 * value)
        for mistaken, value in zip(_answers(wrong), _answers(right), strict=True)
    ]
    return np.all([(gap > 2) | (gap < 0.25) for gap in apart], axis=0)


def _answers(motion):
    """What is asked, but for constant factors."""
    omega3, omega4, alpha3, alpha4 = motion
    return omega3, omega4, abs(omega3), abs(omega4), omega3**2, alpha3, alpha4, abs(alpha4 + 1j * omega4**2)


def crank_acceleration_tells(motion, bars, omega2):
    return _tells((*motion[:2], *_accelerations(bars, omega2, 0.0, *motion[:2])), motion)


def normal_terms_tell(motion, omega2, alpha2):
    omega3, omega4, *_ = motion
    return _tells((omega3, omega4, omega3 / omega2 * alpha2, omega4 / omega2 * alpha2), motion)


def exchange_of_the_rates_tells(motion, bars, omega2, alpha2):
    exchanged = motion[1], motion[0]
    return _tells((*exchanged, *_accelerations(bars, omega2, alpha2, *exchanged)), motion)


def difference_of_the_angles_tells(motion, bars, omega2, alpha2):
    """From their sum, in the sine that divides the rates."""
    _, coupler, rocker = bars
    factor = _cross(coupler, rocker) / _cross(coupler.conjugate(), rocker)
    summed = motion[0] * factor, motion[1] * factor
    return _tells((*summed, *_accelerations(bars, omega2, alpha2, *summed)), motion)


def motion_of_other_mode(bars, r1, omega2, alpha2):
    """B mirrored in the line AC."""
    crank, coupler, _ = bars
    line = r1 - crank
    mirrored = line * (coupler / line).conjugate()
    return motion((crank, mirrored, mirrored - line), omega2, alpha2)


def mode_tells(motion, motion_of_other_mode):
    return _tells(motion_of_other_mode, motion)


HELPERS = (
    motion,
    motion_of_other_mode,
)
KEEP = (
    links_turn_visibly,
    links_accelerate_visibly,
    crank_acceleration_tells,
    normal_terms_tell,
    exchange_of_the_rates_tells,
    difference_of_the_angles_tells,
    mode_tells,
)
