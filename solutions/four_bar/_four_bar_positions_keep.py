"""Four-bar linkage: the conditions on answers that a variant must satisfy."""

from coursework.degrees import polar

__all__ = ["HELPERS", "KEEP"]


def diagonal(r1, r2, theta2):
    """Distance AC."""
    return abs(r1 - polar(r2, theta2))


def cos_mu(diagonal, r3, r4):
    return (r3**2 + r4**2 - diagonal**2) / (2 * r3 * r4)


def cos_psi(diagonal, r3, r4):
    """Minus the cosine of the angle CAB: c over the root of a^2 + b^2."""
    return (r4**2 - r3**2 - diagonal**2) / (2 * r3 * diagonal)


def closes_well(cos_mu):
    return abs(cos_mu) < 0.9


def angle_at_B_not_square(cos_mu):
    return abs(cos_mu) > 0.03


def angle_at_A_not_square(cos_psi):
    return abs(cos_psi) > 0.1


HELPERS = (diagonal, cos_mu, cos_psi)
KEEP = (closes_well, angle_at_B_not_square, angle_at_A_not_square)
