"""The acceleration of a ram that a slotted guide drives, the crank at a constant rate: whether the guide
turns or swings."""

from coursework.degrees import polar, sin
from coursework.figures.polygons import (
    crank_a,
    guide_a,
    normal,
    polygon_of_accelerations,
    slider_a,
    tangential,
)
from coursework.solution import mistake, stable

from ._slotted_ram import polygons as _of_velocities

RATES = {"xC": ("v_C", "a_C")}


@stable(lambda omega2, _arm: _arm.sliding_ratio * omega2)
def rA_dot(r2, omega2, theta2, theta4):
    """Component of the velocity of A along the guide."""
    return r2 * omega2 * sin(theta4 - theta2)


@stable(lambda omega2, _arm: _arm.guide_gain * omega2**2)
def alpha4(r2, omega2, theta2, theta4, rA, rA_dot, omega4):
    """Component of the acceleration of A across the guide, less the Coriolis term, over its distance."""
    return (-r2 * omega2**2 * sin(theta2 - theta4) - 2 * rA_dot * omega4) / rA


def alpha5(omega4, alpha4, xP, yP, omega5, p, q):
    """C keeps to its line: no acceleration across it."""
    return (omega4**2 * yP - alpha4 * xP + omega5**2 * p) / q


def a_C(omega4, alpha4, xP, yP, omega5, alpha5, p, q):
    """Acceleration of the ram, positive to the right."""
    return -alpha4 * yP - omega4**2 * xP - alpha5 * p - omega5**2 * q


@mistake("alpha4")
def no_coriolis(r2, omega2, theta2, theta4, rA):
    return -r2 * omega2**2 * sin(theta2 - theta4) / rA


@mistake("a_C")
def a_C_no_guide_normal(a_C, omega4, xP):
    return a_C + omega4**2 * xP


@mistake("a_C", kind="sign")
def a_C_sign(a_C):
    return -a_C


def polygons(r2, theta2, omega2, rA, theta4, rA_dot, omega4, alpha4, r4, p, q, omega5, alpha5, v_C, a_C):
    """The crank pin is A_2, A_4 the point of the guide under it; P is farther along the guide."""
    crank, along = polar(r2, theta2), polar(1, theta4)
    sliding_gain = (-(omega2**2) * crank / along).real + rA * omega4**2
    return (
        *_of_velocities(r2, theta2, omega2, rA, theta4, omega4, r4, p, q, omega5, v_C),
        polygon_of_accelerations(
            crank_a("A_2", "O_2A", crank, omega2),
            guide_a(
                "A_2", "A_4", "O_4A", rA * along, omega4, alpha4, rA_dot, sliding_gain, "r_A", r"\omega_4"
            ),
            (
                normal("p_a", "p'", "P", "O_4P", r4 * along, omega4, "V_P^2 / r_4"),
                tangential("p'", "p", "P", "O_4P", r4 * along, alpha4, "r_4 a_{A_4}^t / r_A"),
            ),
            slider_a("C", "P", q + 1j * p, omega5, alpha5, "r_5", a_C),
        ),
    )
