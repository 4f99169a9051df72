"""Slotted mechanism: solution. The vector of the guide is the frame's plus the crank's.

The formulas are the course's; their values come from the numeric core, which measures everything from the
frame's direction theta1. There no difference of nearly equal lengths appears: the block may pass as near
to O4 as it likes.
"""

import numpy as np

from coursework.degrees import atan, atan2, cos, from_radians, polar, sin, sqrt, wrap
from coursework.errors import Undefined
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    guide_a,
    guide_v,
    polygon_of_accelerations,
    polygon_of_velocities,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.slotted_guide import SlottedGuidePose
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import formula, given, mistake, stable

UNITS = {"delta": "deg", "a_radial": "mm/s^2", "a_tangential": "mm/s^2"}
SYMBOLS = {"delta": r"\delta"}
LOOPS = {"loop_1": (Vector("r1", "theta1"), Vector("r2", "theta2"), Vector("rA", "theta4", -1))}
EFFECTS = {
    "acceleration": ("rA_ddot", "alpha4", "a_centripetal", "a_coriolis"),
    "coriolis": ("a_coriolis",),
}
MECHANISM = Mechanism(
    ground={"O4": 0, "O2": lambda r1, theta1: polar(r1, theta1)},
    bodies=(
        Body("2", "theta2", "O2", {"A": "r2"}),
        Body("3", "theta4", "A"),
        Body("4", "theta4", "O4"),
    ),
    slides=(Slide("A", "3", on="4"),),
)


def _arm(r1, r2, theta1, theta2):
    """The guide at its crank angle, by the numeric core."""
    return SlottedGuidePose(r1, r2, Degrees.between(theta1, theta2))


def delta(theta1, theta2):
    """Crank angle from the direction of the frame."""
    return wrap(theta2 - theta1)


@stable(lambda _arm: _arm.arm)
def rA(r1, r2, delta):
    """Distance O4A, by the law of cosines."""
    return sqrt(r1**2 + r2**2 + 2 * r1 * r2 * cos(delta))


@stable(lambda theta1, _arm: wrap(theta1 + from_radians(_arm.guide_angle)))
def theta4(r1, r2, theta1, theta2):
    """Direction of the guide, by its quadrant; none when A lies on O4."""
    return atan2(r1 * sin(theta1) + r2 * sin(theta2), r1 * cos(theta1) + r2 * cos(theta2))


def guide(r1, r2):
    """The guide turns fully when O4 lies inside the circle of A; on it, A passes through O4."""
    if isinstance(r1, float) and isinstance(r2, float) and r1 == r2:
        raise Undefined("A passes through O4 when r2 = r1: the guide neither oscillates nor turns fully")
    return np.select([r2 > r1, r2 < r1], ["rotates", "oscillates"], "")


@formula(r"2 \times \arcsin \frac{<r2>}{<r1>}")
def swing(r1, r2):
    """Between the two directions tangent to the circle of A, when O4 lies outside it."""
    return 2 * atan2(r2, sqrt((r1 - r2) * (r1 + r2)))


@stable(lambda omega2, _arm: _arm.sliding_ratio * omega2)
def rA_dot(r2, omega2, theta2, theta4):
    """Component of the velocity of A along the guide."""
    return r2 * omega2 * sin(theta4 - theta2)


@stable(lambda omega2, _arm: _arm.guide_ratio * omega2)
def omega4(r2, omega2, theta2, theta4, rA):
    """Component of the velocity of A across the guide, over its distance."""
    return r2 * omega2 * cos(theta2 - theta4) / rA


def a_centripetal(rA, omega4):
    return -rA * omega4**2


def a_coriolis(rA_dot, omega4):
    return 2 * omega4 * rA_dot


@stable(lambda omega2, alpha2, _arm: _arm.sliding_gain * omega2**2 + _arm.sliding_ratio * alpha2)
def rA_ddot(r2, alpha2, omega2, theta2, theta4, a_centripetal):
    """Component of the acceleration of A along the guide, less the centripetal term."""
    return -r2 * alpha2 * sin(theta2 - theta4) - r2 * omega2**2 * cos(theta2 - theta4) - a_centripetal


@stable(lambda omega2, alpha2, _arm: _arm.guide_gain * omega2**2 + _arm.guide_ratio * alpha2)
def alpha4(r2, alpha2, omega2, theta2, theta4, a_coriolis, rA):
    """Component of the acceleration of A across the guide, less the Coriolis term."""
    return (r2 * alpha2 * cos(theta2 - theta4) - r2 * omega2**2 * sin(theta2 - theta4) - a_coriolis) / rA


def a_radial(rA_ddot):
    return rA_ddot


def a_tangential(rA, alpha4):
    return rA * alpha4


@mistake("theta4", kind="quadrant")
def arctan_no_quadrant(r1, r2, theta1, theta2):
    arm = polar(r1, theta1) + polar(r2, theta2)
    return atan(arm.imag / arm.real)


@mistake("rA", "theta4")
def sin_cos_swapped(r1, r2, theta2):
    x, y = r2 * sin(theta2), r1 + r2 * cos(theta2)
    return sqrt(x**2 + y**2), atan2(y, x)


@mistake("theta2")
def degrees_as_radians(theta2):
    return theta2 * 180 / np.pi


@mistake("rA", kind="term_sign")
def cosine_rule_sign(r1, r2, delta):
    return sqrt(r1**2 + r2**2 - 2 * r1 * r2 * cos(delta))


@mistake("swing", kind="constant")
def half_swing(swing):
    return swing / 2


@mistake("omega4")
def guide_speed_no_projection(r2, omega2, rA):
    return r2 * omega2 / rA


@mistake("rA_dot", kind="sign")
def rA_dot_sign(rA_dot):
    return -rA_dot


@mistake("alpha4")
def no_coriolis(r2, alpha2, omega2, theta2, theta4, rA):
    return (r2 * alpha2 * cos(theta2 - theta4) - r2 * omega2**2 * sin(theta2 - theta4)) / rA


@mistake("a_tangential")
def coriolis_in_the_tangential_term(rA, alpha4, a_coriolis):
    return rA * alpha4 + a_coriolis


@mistake("a_coriolis", kind="constant")
def coriolis_no_2(omega4, rA_dot):
    return omega4 * rA_dot


@mistake("rA_ddot")
def no_centripetal(r2, alpha2, omega2, theta2, theta4):
    return -r2 * alpha2 * sin(theta2 - theta4) - r2 * omega2**2 * cos(theta2 - theta4)


def polygons(r2, theta2, omega2, alpha2, rA, theta4, rA_dot, omega4, rA_ddot, alpha4):
    """The crank pin is A_2; A_4 is the point of the guide under it."""
    crank, arm = polar(r2, theta2), polar(rA, theta4)
    return (
        polygon_of_velocities(
            crank_v("A_2", "O_2A", crank, omega2), guide_v("A_2", "A_4", "O_4A", arm, omega4, rA_dot)
        ),
        polygon_of_accelerations(
            crank_a("A_2", "O_2A", crank, omega2, alpha2),
            guide_a("A_2", "A_4", "O_4A", arm, omega4, alpha4, rA_dot, rA_ddot, "r_A", r"\omega_4"),
        ),
    )


def residual(r1, r2, theta1, theta2, omega2, alpha2, rA, theta4, rA_dot, omega4, rA_ddot, alpha4):
    """Loop closure and its two derivatives, as complex equations."""
    frame = r1 * np.exp(1j * np.radians(theta1))
    crank = r2 * np.exp(1j * np.radians(theta2))
    along = np.exp(1j * np.radians(theta4))
    position = frame + crank - rA * along
    velocity = 1j * omega2 * crank - (rA_dot + 1j * rA * omega4) * along
    acceleration = (1j * alpha2 - omega2**2) * crank - (
        rA_ddot - rA * omega4**2 + 1j * (rA * alpha4 + 2 * rA_dot * omega4)
    ) * along
    speed = r2 * abs(omega2) + rA * abs(omega4)
    return (
        abs(position) / (r1 + r2),
        abs(velocity) / speed,
        abs(acceleration) / (r2 * (abs(alpha2) + omega2**2) + rA * (omega4**2 + abs(alpha4))),
    )


KNOWN = (
    # The course's own numbers.
    given(r1=228.6, r2=114.3, theta1=90, theta2=135, omega2=1).gives(
        rA="319.80", theta4="104.64", guide="oscillates", swing="60.000"
    ),
    # Crank along the frame: the guide is at its greatest length and turns with the least slide.
    given(r1=200, r2=100, theta1=90, theta2=90, omega2=3).gives(
        rA=300, theta4=90, rA_dot=0, omega4=1, a_coriolis=0, a_centripetal=-300, a_tangential=0
    ),
    # Crank square to the guide at the end of the swing: the guide stands still.
    given(r1=200, r2=100, theta1=90, theta2=-150, omega2=4).gives(
        rA=100 * 3**0.5, theta4=120, omega4=0, rA_dot=-400
    ),
    # Frame and crank equal: the guide turns at half the crank's speed, wherever it is.
    given(r1=150, r2=150, theta1=90, theta2=-80, omega2=10).gives(omega4=5, alpha4=0, theta4=5),
)
