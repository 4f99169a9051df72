"""Havens planetary gear: solution. The guide follows A1; wheel S2 turns as the guide does, and rolls on S3.

Crank and guide are a slotted mechanism whose frame is O4O1 = d along x; its values come from the numeric
core.
"""

import math

import numpy as np

from coursework.degrees import atan, atan2, cos, from_radians, polar, sin, sqrt, tan
from coursework.figures import Figure, circle, contact, ground_pivot, link, pin, slot_link, vector
from coursework.figures.polygons import Side, crank_v, guide_v, polygon_of_velocities, turning
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.slotted_guide import SlottedGuidePose
from coursework.mechanics import Body, Gear, Mechanism, Slide
from coursework.solution import Moving, given, mistake, stable

from ._havens import *

UNITS = {"e": "mm"}
LOOPS = {
    "loop_1": (
        Vector("d", 0.0),
        Vector("r2", "theta1"),
        Vector("r3", "theta1"),
        Vector("rA", "theta4", -1),
    ),
}
EFFECTS = {
    "velocity": ("omega4", "omega2", "v_A1_4", "v_slide", "v_B2_x", "v_B2_y", "omega3", "v_I"),
}
MECHANISM = Mechanism(
    ground={"O1": 0, "O4": lambda d: -d},
    bodies=(
        Body("1", "theta1", "O1", {"A1": lambda r2, r3: r2 + r3}),
        Body("2", "theta4", "A1", {"B2": "b"}),
        Body("3", None, "O1"),
        Body("4", "theta4", "O4"),
    ),
    slides=(Slide("A1", "2", on="4"),),
    gears=(Gear("3", "2", carrier="1", radii=("r3", "r2")),),
)


def _arm(d, e, theta1):
    """The guide at its crank angle, by the numeric core."""
    return SlottedGuidePose(d, e, Degrees(theta1))


def nature_42():
    return "translation"


def why_v_40_A1():
    return "fixed_pivot"


def why_v_14_A1():
    return "slot"


def why_v_24_B2():
    return "translation"


def why_v_20_B2():
    return "composition"


def why_v_30_I():
    return "no_slip"


def e(r2, r3):
    """Length of the crank O1A1: wheel and pinion touch between its ends."""
    return r2 + r3


@stable(lambda _arm: from_radians(_arm.guide_angle))
def theta4(d, e, theta1):
    """Direction of O4A1, by its quadrant."""
    return atan2(e * sin(theta1), d + e * cos(theta1))


@stable(lambda _arm: _arm.arm)
def rA(d, e, theta1):
    """Distance O4A1, by the law of cosines."""
    return sqrt(d**2 + e**2 + 2 * d * e * cos(theta1))


@stable(lambda omega1, _arm: _arm.guide_ratio * omega1)
def omega4(e, omega1, theta1, theta4, rA):
    """Component of the velocity of A1 across the guide, over its distance."""
    return e * omega1 * cos(theta1 - theta4) / rA


def omega2(omega4):
    """The slot holds two points of S2: S2 and the guide turn alike."""
    return omega4


def v_A1_4(rA, omega4):
    """Velocity of the guide's own point at A1, counted 90 degrees ahead of the guide."""
    return rA * omega4


@stable(lambda omega1, _arm: _arm.sliding_ratio * omega1)
def v_slide(e, omega1, theta1, theta4):
    """Component of the velocity of A1 along the guide: d(rA)/dt."""
    return -e * omega1 * sin(theta1 - theta4)


def v_B2_x(v_slide, rA, b, omega4, theta4):
    return v_slide * cos(theta4) - (rA + b) * omega4 * sin(theta4)


def v_B2_y(v_slide, rA, b, omega4, theta4):
    return v_slide * sin(theta4) + (rA + b) * omega4 * cos(theta4)


@stable(lambda omega1, r2, r3, _lag: omega1 * (r3 + r2 * _lag) / r3)
def omega3(e, omega1, r2, omega2, r3):
    """At I wheel and pinion have the same velocity: e omega1 - r2 omega2 = r3 omega3."""
    return (e * omega1 - r2 * omega2) / r3


def v_I(r3, omega3):
    """Counted 90 degrees ahead of the crank."""
    return r3 * omega3


@mistake("nature_42")
def guide_as_pivot():
    return "rotation"


@mistake("why_v_24_B2")
def A1_and_B2_of_one_velocity():
    return "fixed_pivot"


@mistake("theta4")
def guide_angle_from_O1(theta1):
    return theta1


@mistake("theta4", kind="quadrant")
def arctan_no_quadrant(theta4):
    return atan(tan(theta4))


@mistake("rA", kind="term_sign")
def cosine_rule_sign(d, e, theta1):
    return sqrt(d**2 + e**2 - 2 * d * e * cos(theta1))


@mistake("omega2")
def omega2_is_omega1(omega1):
    return omega1


@mistake("v_slide", kind="sign")
def slide_sign(v_slide):
    return -v_slide


@mistake("v_B2_x", "v_B2_y")
def B2_guide_only(rA, b, omega4, theta4):
    return -(rA + b) * omega4 * sin(theta4), (rA + b) * omega4 * cos(theta4)


@mistake("v_B2_x", "v_B2_y")
def B2_with_crank(e, omega1, theta1):
    return -e * omega1 * sin(theta1), e * omega1 * cos(theta1)


@mistake("omega3", kind="term_sign")
def omega3_plus(e, omega1, r2, omega2, r3):
    return (e * omega1 + r2 * omega2) / r3


@mistake("omega3")
def willis_no_arm(r2, omega2, r3):
    return -r2 * omega2 / r3


@mistake("v_I")
def v_I_of_crank(r3, omega1):
    return r3 * omega1


def polygons(e, r2, b, theta1, omega1, theta4, rA, omega4, v_slide, v_B2_x, v_B2_y, v_I):
    """The crank's point A_1, the guide's point A_4 under it; B_2 and I are points of the wheel, about A_1."""
    crank, along = polar(1.0, theta1), polar(1.0, theta4)
    return (
        polygon_of_velocities(
            crank_v("A_1", "O_1A_1", e * crank, omega1, "1", "e"),
            guide_v("A_1", "A_4", "O_4A_1", rA * along, omega4, v_slide),
            (
                turning("a_1", "b_2", "B_2/A_1", "A_1B_2", b * along, omega4, "b V_{A_4} / r_A"),
                turning("a_1", "i", "I/A_1", "O_1A_1", -r2 * crank, omega4, "r_2 V_{A_4} / r_A"),
                Side("p_v", "b_2", r"\vec{V}_{B_2}", v_B2_x + 1j * v_B2_y),
                Side("p_v", "i", r"\vec{V}_I", 1j * v_I * crank),
            ),
        ),
    )


def motion(r3, b, e, theta1, omega1, theta4, v_B2_x, v_B2_y):
    """The crank pin, the other pin of the slot, and where the wheels touch."""
    crank, along = polar(1.0, theta1), polar(1.0, theta4)
    return {
        "A_1": Moving(e * crank, 1j * omega1 * e * crank),
        "B_2": Moving(e * crank + b * along, v_B2_x + 1j * v_B2_y),
        "I": Moving(r3 * crank),
    }


def figure(d, r2, r3, b, e, theta1, omega1, theta4, rA, omega4, v_slide, v_B2_x, v_B2_y, v_I):
    """The five velocities and that of A1, at one scale."""
    O4, O1, along, crank = complex(-d), 0j, polar(1.0, theta4), polar(1.0, theta1)
    A1 = e * crank
    B2, I = A1 + b * along, r3 * crank
    v_A1, v_B2 = 1j * omega1 * A1, v_B2_x + 1j * v_B2_y
    scale = 0.9 * e / max(abs(v_A1), abs(v_B2), abs(v_I), 1e-9 * e)
    return Figure(
        slot_link(O4, B2 + 0.25 * e * along),
        circle(O1, r3),
        circle(A1, r2),
        link(O1, A1),
        vector(A1, scale * v_A1, "V_{1/0}"),
        vector(A1, scale * 1j * rA * omega4 * along, "V_{4/0}"),
        vector(A1, scale * v_slide * along, "V_{1/4}"),
        vector(B2, scale * v_slide * along, "V_{2/4}"),
        vector(B2, scale * v_B2, "V_{2/0}"),
        vector(I, scale * 1j * v_I * crank, "V_{3/0}"),
        contact(I, "I"),
        ground_pivot(O4, "O_4"),
        ground_pivot(O1, "O_1"),
        pin(A1, "A_1"),
        pin(B2, "B_2"),
        paper_mm=(108, 70),
    )


def residual(
    d,
    r2,
    r3,
    b,
    theta1,
    omega1,
    theta4,
    rA,
    omega4,
    omega2,
    v_A1_4,
    v_slide,
    v_B2_x,
    v_B2_y,
    omega3,
    v_I,
):
    """The triangle O4O1A1 and its derivative; B2, I and A1 as points of the one body S2; no slip at I;
    equiprojectivity along B2I."""
    along, crank = np.exp(1j * np.radians(theta4)), np.exp(1j * np.radians(theta1))
    A1 = (r2 + r3) * crank
    v_A1 = 1j * omega1 * A1
    v_B2 = v_B2_x + 1j * v_B2_y
    size, speed = d + r2 + r3, (r2 + r3) * abs(omega1)
    B2_I = A1 + b * along - r3 * crank
    by_S2 = v_A1 - 1j * omega2 * r2 * crank
    return (
        abs(d + A1 - rA * along) / size,
        abs(v_A1 - (v_slide + 1j * v_A1_4) * along) / speed,
        abs(v_A1_4 - rA * omega4) / speed,
        abs(v_A1 + 1j * omega2 * b * along - v_B2) / (speed + abs(v_B2)),
        abs(by_S2 - 1j * omega3 * r3 * crank) / (speed + abs(r3 * omega3)),
        abs(by_S2 - 1j * v_I * crank) / (speed + abs(v_I)),
        abs(((v_B2 - by_S2) * np.conj(B2_I)).real) / (speed * abs(B2_I)),
    )


_OF_3_4_5 = math.degrees(math.atan2(4, 3))

KNOWN = (
    # Crank upright: O4O1A1 is a 3-4-5 triangle.
    given(d=30, r2=25, r3=15, b=25, theta1=90, omega1=5).gives(
        nature_42="translation",
        theta4=_OF_3_4_5,
        rA=50,
        omega4=3.2,
        omega2=3.2,
        v_A1_4=160,
        v_slide=-120,
        v_B2_x=-264,
        v_B2_y=48,
        omega3=8,
        v_I=120,
    ),
    # Crank along the frame, away from O4: nothing slides.
    given(d=20, r2=40, r3=20, b=30, theta1=0, omega1=4).gives(
        theta4=0,
        rA=80,
        omega4=3,
        v_slide=0,
        v_B2_x=0,
        v_B2_y=330,
        omega3=6,
        v_I=120,
    ),
    # And towards O4: the pinion happens to stand still.
    given(d=20, r2=40, r3=20, b=30, theta1=180, omega1=4).gives(
        theta4=180,
        rA=40,
        omega4=6,
        v_slide=0,
        v_B2_x=0,
        v_B2_y=-420,
        omega3=0,
        v_I=0,
    ),
    # A guide that swings, at the end of its swing: A1 moves along the slot, S2 only translates.
    given(d=50, r2=20, r3=10, b=10, theta1=180 - _OF_3_4_5, omega1=2).gives(
        theta4=90 - _OF_3_4_5,
        rA=40,
        omega4=0,
        v_slide=-60,
        v_A1_4=0,
        v_B2_x=-48,
        v_B2_y=-36,
        omega3=6,
        v_I=60,
    ),
)
