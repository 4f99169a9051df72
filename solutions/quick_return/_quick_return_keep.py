"""Quick return with crank and rocker: the conditions on answers that a variant must satisfy."""

from coursework.degrees import polar

from ...exercises.quick_return.quick_return import _cross

__all__ = ["HELPERS", "KEEP"]


def coupler(A, B):
    return B - A


def rocker(B, r1, theta1):
    return B - polar(r1, theta1)


def rod(B, C):
    return C - B


def _dot(u, v):
    return u.real * v.real + u.imag * v.imag


def omega3(A, rocker, coupler):
    """Over omega2, as every rate below."""
    return _cross(A, rocker) / _cross(rocker, coupler)


def omega4(A, rocker, coupler):
    return _cross(A, coupler) / _cross(rocker, coupler)


def omega5(omega4, rocker, rod):
    return -omega4 * rocker.real / rod.real


def v_C(omega4, rocker, omega5, rod):
    return -omega4 * rocker.imag - omega5 * rod.imag


def a_C(A, coupler, rocker, rod, omega3, omega4, omega5):
    """Over omega2 squared."""
    alpha4 = (_dot(A, coupler) + omega3**2 * abs(coupler) ** 2 - omega4**2 * _dot(rocker, coupler)) / _cross(
        coupler, rocker
    )
    rise = alpha4 * rocker.real - omega4**2 * rocker.imag - omega5**2 * rod.imag
    return -alpha4 * rocker.imag - omega4**2 * rocker.real - omega5**2 * rod.real + rise * rod.imag / rod.real


def bars_turn_visibly(omega3, omega4, omega5):
    return (abs(omega3) > 0.05) & (abs(omega4) > 0.05) & (abs(omega5) > 0.02)


def rod_turning_counts_in_the_speed(v_C, omega5, rod):
    return abs(omega5 * rod.imag) > 0.025 * abs(v_C)


def rod_turning_counts_in_the_acceleration(a_C, omega5, rod):
    return omega5**2 * rod.real > 0.025 * abs(a_C)


def piston_moves_visibly(v_C, r2):
    return abs(v_C) > 0.15 * r2


def piston_accelerates_visibly(a_C, r2):
    return abs(a_C) > 0.15 * r2


HELPERS = (
    coupler,
    rocker,
    rod,
    omega3,
    omega4,
    omega5,
    v_C,
    a_C,
)
KEEP = (
    bars_turn_visibly,
    rod_turning_counts_in_the_speed,
    rod_turning_counts_in_the_acceleration,
    piston_moves_visibly,
    piston_accelerates_visibly,
)
