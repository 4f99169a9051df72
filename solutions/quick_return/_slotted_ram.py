"""A ram moved by a slotted guide: what is the same whether the guide turns or swings.

The crank pin A slides in the guide O4; P on the guide drives the ram C by a rod.
"""

from math import pi

from coursework.degrees import atan2, cos, from_radians, polar, sin, sqrt, wrap
from coursework.figures.polygons import crank_v, guide_v, polygon_of_velocities, slider_v, turning
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.slider_crank import SliderCrank
from coursework.kinematics.slotted_guide import SlottedGuidePose
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import stable

LOOPS = {
    "loop_1": (Vector("r1", pi / 2), Vector("r2", "theta2"), Vector("rA", "theta4", -1)),
    "loop_2": (
        Vector("r4", "theta4"),
        Vector("r5", "theta5"),
        Vector("xC", 0.0, -1),
        Vector("h", pi / 2, -1),
    ),
}
RATES = {"xC": ("v_C", "")}
MECHANISM = Mechanism(
    ground={"O4": 0, "O2": lambda r1: 1j * r1},
    bodies=(
        Body("2", "theta2", "O2", {"A": "r2"}),
        Body("3", "theta4", "A"),
        Body("4", "theta4", "O4", {"P": "r4"}),
        Body("5", "theta5", "P", {"C": "r5"}),
        Body("6", 0, "C"),
    ),
    slides=(Slide("A", "3", on="4"), Slide("C", "6")),
)


def _arm(r1, r2, theta2):
    """The guide at its crank angle, by the numeric core; it counts angles from the frame's direction."""
    return SlottedGuidePose(r1, r2, Degrees.between(90.0, theta2))


@stable(lambda _arm: _arm.arm)
def rA(r1, r2, theta2):
    """Distance O4A, by the law of cosines."""
    return sqrt(r1**2 + r2**2 + 2 * r1 * r2 * sin(theta2))


@stable(lambda _arm: wrap(90 + from_radians(_arm.guide_angle)))
def theta4(r1, r2, theta2):
    """Direction of the guide, by its quadrant."""
    return atan2(r1 + r2 * sin(theta2), r2 * cos(theta2))


@stable(lambda omega2, _arm: _arm.guide_ratio * omega2)
def omega4(r2, omega2, theta2, theta4, rA):
    """Component of the velocity of A across the guide, over its distance."""
    return r2 * omega2 * cos(theta2 - theta4) / rA


def xP(r4, theta4):
    return r4 * cos(theta4)


def yP(r4, theta4):
    return r4 * sin(theta4)


def p(h, yP):
    """Height of C above P."""
    return h - yP


@stable(lambda r4, r5, h, theta4: SliderCrank(r4, r5, h).run(Degrees(theta4)))
def q(r5, p):
    """Distance of C to the right of P."""
    return sqrt(r5**2 - p**2)


def xC(xP, q):
    return xP + q


def theta5(p, q):
    """Direction of the rod, from P to C."""
    return atan2(p, q)


def omega5(omega4, xP, q):
    """C keeps to its line: no velocity across it."""
    return -omega4 * xP / q


def v_C(omega4, yP, omega5, p):
    """Velocity of the ram, positive to the right."""
    return -omega4 * yP - omega5 * p


def polygons(r2, theta2, omega2, rA, theta4, omega4, r4, p, q, omega5, v_C):
    """The crank pin is A_2, A_4 the point of the guide under it; P is farther along the guide."""
    crank, along = polar(r2, theta2), polar(1, theta4)
    return (
        polygon_of_velocities(
            crank_v("A_2", "O_2A", crank, omega2),
            guide_v("A_2", "A_4", "O_4A", rA * along, omega4, (1j * omega2 * crank / along).real),
            (turning("p_v", "p", "P", "O_4P", r4 * along, omega4, "r_4 V_{A_4} / r_A"),),
            slider_v("C", "P", q + 1j * p, omega5, v_C),
        ),
    )
