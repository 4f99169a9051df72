"""Toggle press: the conditions on answers that a variant must satisfy."""

from coursework.kinematics.vectors import cross

__all__ = ["HELPERS", "KEEP"]


def knee_rate(crank_pivot, A, B):
    """omega4 over omega2."""
    return cross(A - crank_pivot, B - A) / cross(B, B - A)


def ram_rate(knee_rate, B, C):
    """v_C over omega2, positive upwards."""
    lower = C - B
    return knee_rate * (B.real - B.imag * lower.real / lower.imag)


def forces(crank_pivot, A, B, C):
    """In the upper bar, the lower bar and the coupler, over the force on the ram, compression positive."""
    upper, coupler, lower = B / abs(B), (B - A) / abs(B - A), (C - B) / abs(C - B)
    in_lower = -1 / lower.imag
    across = cross(upper, coupler)
    return cross(lower, coupler) / across * in_lower, in_lower, cross(upper, lower) / across * in_lower


def ram_goes_down(ram_rate, omega2):
    return ram_rate * omega2 < 0


def bars_bear_different_forces(forces):
    return abs(forces[0] / forces[1] - 1) > 0.022


HELPERS = (
    knee_rate,
    ram_rate,
    forces,
)
KEEP = (
    ram_goes_down,
    bars_bear_different_forces,
)
