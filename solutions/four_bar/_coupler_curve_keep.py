"""Coupler curve: the conditions on answers that a variant must satisfy."""

__all__ = ["HELPERS", "KEEP"]


def coupler_rate(bars):
    """omega3 / omega2."""
    crank, coupler, rocker = bars
    return _cross(crank, rocker) / _cross(rocker, coupler)


def v_P(bars, P, coupler_rate):
    """Velocity of P over omega2."""
    return 1j * (bars[0] + coupler_rate * (P - bars[0]))


def _cross(u, v):
    return u.real * v.imag - u.imag * v.real


def coupler_turns_visibly(coupler_rate):
    return abs(coupler_rate) > 0.08


def P_moves_visibly_both_ways(v_P, r2):
    return (abs(v_P.real) > 0.12 * r2) & (abs(v_P.imag) > 0.12 * r2)


HELPERS = (
    coupler_rate,
    v_P,
)
KEEP = (
    coupler_turns_visibly,
    P_moves_visibly_both_ways,
)
