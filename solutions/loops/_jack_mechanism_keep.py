"""A body that a jack tips: the conditions on answers that a variant must satisfy."""

from coursework.degrees import angle, cos, polar, sin

__all__ = ["HELPERS", "KEEP"]


def jack(foot, a, theta4):
    """From B to A."""
    return polar(a, theta4) - foot


def mu(jack, theta4):
    """The angle at which the jack pushes on OA."""
    return angle(jack * polar(1, -theta4))


def turning(a, L_dot, mu, L):
    """omega4 and omega2."""
    omega4 = L_dot / (a * sin(mu))
    return omega4, a * omega4 * cos(mu) / L


def bending(turning, a, L, L_dot, L_ddot, mu):
    """alpha4 and alpha2."""
    omega4, omega2 = turning
    alpha4 = (L_ddot - L * omega2**2 + a * omega4**2 * cos(mu)) / (a * sin(mu))
    return alpha4, (a * (alpha4 * cos(mu) + omega4**2 * sin(mu)) - 2 * L_dot * omega2) / L


def jack_pushes_at_a_good_angle(mu):
    return (mu > 25) & (mu < 155) & (abs(mu - 90) > 10)


def jack_turns_visibly(turning):
    return abs(turning[1]) > 0.1 * abs(turning[0])


def body_and_jack_accelerate_visibly(turning, bending):
    return (abs(bending[0]) > 0.15 * turning[0] ** 2) & (abs(bending[1]) > 0.1 * turning[0] ** 2)


HELPERS = (
    jack,
    mu,
    turning,
    bending,
)
KEEP = (
    jack_pushes_at_a_good_angle,
    jack_turns_visibly,
    body_and_jack_accelerate_visibly,
)
