"""Six links, two loops: solution. Eliminate theta4 from the first loop, then theta5 from the second.

The rocker turns about D, the origin; the crank about O = i r1. Both loops are solved by their own
second-degree equation, and each is then derived twice. The first loop is a four-bar linkage whose frame OD
points down: what its formulas give near a dead point is taken from the numeric core.
"""

import math
from math import pi

import numpy as np

from coursework.degrees import acos, angle, atan, atan2, cos, from_radians, polar, sin, sqrt, tan, wrap
from coursework.errors import CannotAssemble
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    polygon_of_accelerations,
    polygon_of_velocities,
    slider_a,
    slider_v,
    two_bars_a,
    two_bars_v,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.dyads import side_of
from coursework.kinematics.four_bar import FourBar
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import formula, given, mistake, stable

UNITS = {"A": "1", "side": "1"}
SYMBOLS = {"side": r"\varepsilon"}
LOOPS = {
    "loop_1": (
        Vector("r1", pi / 2),
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("r4", "theta4", -1),
    ),
    "loop_2": (Vector("r4", "theta4"), Vector("r6", 0.0, -1), Vector("r5", "theta5", -1)),
}
MECHANISM = Mechanism(
    ground={"D": 0, "O": lambda r1: 1j * r1},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3"}),
        Body("4", "theta4", "D", {"B": "r4"}),
        Body("5", "theta5", "B", {"P": lambda r5: -r5}),
        Body("6", 0, "P"),
    ),
    slides=(Slide("P", "6"),),
)


def mobility():
    return 3 * (6 - 1) - 2 * 7


def cycles():
    return 7 - 6 + 1


def a(r2, r3, theta2):
    return 2 * r2 * r3 * cos(theta2)


@stable(lambda r1, r2, r3, theta2: 2 * r3 * ((r1 - r2) + 2 * r2 * sin(45 + theta2 / 2) ** 2))
def b(r1, r2, r3, theta2):
    return 2 * r2 * r3 * sin(theta2) + 2 * r1 * r3


def c(r1, r2, r3, r4, theta2):
    return r4**2 - r1**2 - r2**2 - r3**2 - 2 * r1 * r2 * sin(theta2)


def side(mode):
    """+1 when B lies left of the line A -> D, -1 when right."""
    return side_of(mode)


def _bars(r1, r2, r3, r4, side):
    return FourBar(r1, r2, r3, r4, side)


def _linkage(_bars, theta2):
    """The linkage O, A, B, D at its crank angle, counted from the direction O -> D."""
    return _bars.at(Degrees.between(-90.0, theta2))


@stable(lambda _linkage: wrap(from_radians(_linkage.coupler_angle) - 90))
def theta3(a, b, c, side):
    """The root of a cos + b sin = c that puts B on its side: (a, b) points from D to A."""
    return wrap(atan2(b, a) - side * acos(c / sqrt(a**2 + b**2)))


@stable(lambda _linkage: wrap(from_radians(_linkage.rocker_angle) - 90))
def theta4(r1, r2, theta2, r3, theta3):
    """Direction of B seen from D, by its quadrant."""
    return angle(1j * r1 + polar(r2, theta2) + polar(r3, theta3))


@formula("")
def A():
    return 1.0


def B(r4, theta4):
    return -2 * r4 * cos(theta4)


def C(r4, r5):
    return (r4 - r5) * (r4 + r5)


def _larger_root(A, B, C):
    """Without a difference of nearly equal lengths."""
    square = B**2 - 4 * A * C
    if isinstance(square, float) and square < 0:
        raise CannotAssemble(
            f"the linkage does not close: the rod does not reach the axis (gap {sqrt(-square) / 2:.3g})"
        )
    total = abs(B) + sqrt(square)
    return np.where(B > 0, -2 * C / total, total / (2 * A))[()]


@stable(_larger_root)
def r6(A, B, C):
    return (-B + sqrt(B**2 - 4 * A * C)) / (2 * A)


def theta5(r4, theta4, r6):
    """Direction from the slider to B, by its quadrant."""
    return atan2(r4 * sin(theta4), r4 * cos(theta4) - r6)


@stable(lambda omega2, _linkage: _linkage.coupler_ratio * omega2)
def omega3(r2, omega2, r3, theta2, theta3, theta4):
    return r2 * omega2 * sin(theta2 - theta4) / (r3 * sin(theta4 - theta3))


@stable(lambda omega2, _linkage: _linkage.rocker_ratio * omega2)
def omega4(r2, omega2, r4, theta2, theta3, theta4):
    return r2 * omega2 * sin(theta2 - theta3) / (r4 * sin(theta4 - theta3))


@stable(lambda r4, omega4, r5, theta5, _linkage: r4 * omega4 * _rise(_linkage) / (r5 * cos(theta5)))
def omega5(r4, omega4, theta4, r5, theta5):
    return r4 * omega4 * cos(theta4) / (r5 * cos(theta5))


def _rise(linkage):
    """cos(theta4), which vanishes where the rocker points along the frame OD: exact there."""
    return np.sin(linkage.rocker_angle)


def _slope(r4, theta4, r5, theta5):
    """tan(theta5), whose sine vanishes beside a long rod: exact there."""
    return r4 * sin(theta4) / (r5 * cos(theta5))


@stable(lambda r6, omega4, _slope: r6 * omega4 * _slope)
def r6_dot(r4, omega4, theta4, r5, omega5, theta5):
    return r5 * omega5 * sin(theta5) - r4 * omega4 * sin(theta4)


@stable(lambda omega2, _linkage: _linkage.coupler_gain * omega2**2)
def alpha3(r2, omega2, theta2, r3, omega3, theta3, r4, omega4, theta4):
    """The accelerations of B by the coupler and by the rocker have the same projection along the rocker."""
    return (
        r2 * omega2**2 * cos(theta2 - theta4) + r3 * omega3**2 * cos(theta3 - theta4) - r4 * omega4**2
    ) / (r3 * sin(theta4 - theta3))


@stable(lambda omega2, _linkage: _linkage.rocker_gain * omega2**2)
def alpha4(r2, omega2, theta2, r3, omega3, theta3, r4, omega4, theta4):
    """They have the same projection along the coupler."""
    return (
        r2 * omega2**2 * cos(theta2 - theta3) + r3 * omega3**2 - r4 * omega4**2 * cos(theta4 - theta3)
    ) / (r4 * sin(theta4 - theta3))


def alpha5(r4, omega4, alpha4, theta4, r5, omega5, theta5):
    return (r4 * alpha4 * cos(theta4) - r4 * omega4**2 * sin(theta4) + r5 * omega5**2 * sin(theta5)) / (
        r5 * cos(theta5)
    )


@stable(
    lambda r6, r6_dot, omega4, alpha4, omega5, theta5, _slope: (
        (r6_dot * omega4 + r6 * alpha4) * _slope + r6 * omega4 * omega5 / cos(theta5) ** 2
    )
)
def r6_ddot(r4, omega4, alpha4, theta4, r5, omega5, alpha5, theta5):
    return (
        r5 * alpha5 * sin(theta5)
        + r5 * omega5**2 * cos(theta5)
        - r4 * alpha4 * sin(theta4)
        - r4 * omega4**2 * cos(theta4)
    )


# Where two mistakes give one answer, the first is told: what is wrong there before what is wrong earlier.


@mistake("omega5", kind="sign")
def omega5_sign(omega5):
    return -omega5


@mistake("r6_dot", kind="sign")
def r6_dot_sign(r6_dot):
    return -r6_dot


@mistake("mobility")
def frame_counted():
    return 3 * 6 - 2 * 7


@mistake("mobility", "cycles")
def multiple_pivot_once():
    return 3 * (6 - 1) - 2 * 6, 6 - 6 + 1


@mistake("cycles")
def notes_N_without_frame():
    return 7 - 5 + 1


@mistake("loop_1_y", kind="exchanged")
def notes_r1_called_r6():
    return "r6 + r2*sin(theta2) + r3*sin(theta3) = r4*sin(theta4)"


@mistake("loop_1_y")
def frame_left_out():
    return "r2*sin(theta2) + r3*sin(theta3) = r4*sin(theta4)"


@mistake("loop_1_y")
def frame_sign():
    return "r2*sin(theta2) + r3*sin(theta3) - r1 = r4*sin(theta4)"


@mistake("loop_1_x", "loop_1_y")
def coupler_reversed():
    return (
        "r2*cos(theta2) - r3*cos(theta3) = r4*cos(theta4)",
        "r1 + r2*sin(theta2) - r3*sin(theta3) = r4*sin(theta4)",
    )


@mistake("loop_2_x", "loop_2_y", kind="link_sign")
def rod_reversed():
    return "r4*cos(theta4) + r5*cos(theta5) = r6", "r4*sin(theta4) + r5*sin(theta5) = 0"


@mistake("loop_1_x", "loop_1_y", "a", "b", "c", "theta4")
def theta1_zero(r1, r2, r3, r4, theta2, side):
    a = 2 * r2 * r3 * cos(theta2) + 2 * r1 * r3
    b = 2 * r2 * r3 * sin(theta2)
    c = r4**2 - r1**2 - r2**2 - r3**2 - 2 * r1 * r2 * cos(theta2)
    return (
        "r1 + r2*cos(theta2) + r3*cos(theta3) = r4*cos(theta4)",
        "r2*sin(theta2) + r3*sin(theta3) = r4*sin(theta4)",
        a,
        b,
        c,
        angle(r1 + polar(r2, theta2) + polar(r3, theta3(a, b, c, side))),
    )


@mistake("c")
def notes_c(r1, r2, r3, r4, theta2):
    return r4**2 - r2**2 - r3**2 + 2 * r1 * r2 * sin(theta2)


@mistake("c")
def notes_c_without_r1(r1, r2, r3, r4, theta2):
    return r4**2 - r2**2 - r3**2 - 2 * r1 * r2 * sin(theta2)


@mistake("side")
def other_mode(side):
    return -side


@mistake("theta3", kind="quadrant")
def theta3_arctan_no_quadrant(a, b, c, side):
    return wrap(atan(b / a) - side * acos(c / abs(a + 1j * b)))


@mistake("theta3", kind="quadrant")
def notes_two_arctans(a, b, c, side):
    return wrap(atan(b / a) - side * atan(sqrt(a**2 + b**2 - c**2) / c))


@mistake("theta4", kind="quadrant")
def theta4_arctan_no_quadrant(theta4):
    return atan(tan(theta4))


@mistake("r6", kind="term_sign")
def smaller_root(A, B, C):
    return (-B - sqrt(B**2 - 4 * A * C)) / (2 * A)


@mistake("B", kind="sign")
def B_sign(B):
    return -B


@mistake("C", kind="sign")
def C_sign(C):
    return -C


@mistake("theta5", kind="quadrant")
def arctan_no_quadrant(r4, theta4, r6):
    return atan(r4 * sin(theta4) / (r4 * cos(theta4) - r6))


@mistake("omega3", "omega4", kind="angle_sign")
def sum_in_denominator(r2, omega2, r3, r4, theta2, theta3, theta4):
    return (
        r2 * omega2 * sin(theta2 - theta4) / (r3 * sin(theta3 + theta4)),
        r2 * omega2 * sin(theta2 - theta3) / (r4 * sin(theta3 + theta4)),
    )


@mistake("omega3", "omega4", kind="sign")
def signs_of_omegas(omega3, omega4):
    return -omega3, -omega4


@mistake("r6_dot", kind="term_sign")
def notes_eq7(r4, omega4, theta4, r5, omega5, theta5):
    return r4 * omega4 * sin(theta4) + r5 * omega5 * sin(theta5)


@mistake("alpha3", "alpha4")
def no_normal_terms():
    return 0.0, 0.0


@mistake("r6_ddot")
def r6dd_rod_only(r4, omega4, alpha4, theta4, r5, alpha5, theta5):
    return r5 * alpha5 * sin(theta5) - r4 * alpha4 * sin(theta4) - r4 * omega4**2 * cos(theta4)


def polygons(
    r2,
    r3,
    r4,
    r5,
    theta2,
    theta3,
    theta4,
    theta5,
    omega2,
    omega3,
    omega4,
    omega5,
    r6_dot,
    alpha3,
    alpha4,
    alpha5,
    r6_ddot,
):
    """Two bars meet at B, then the rod from B to the slider."""
    OA, AB, DB, BP = polar(r2, theta2), polar(r3, theta3), polar(r4, theta4), -polar(r5, theta5)
    return (
        polygon_of_velocities(
            crank_v("A", "OA", OA, omega2),
            two_bars_v("B", "A", "D", AB, omega3, DB, omega4),
            slider_v("P", "B", BP, omega5, r6_dot),
        ),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2),
            two_bars_a("B", "A", "D", AB, omega3, alpha3, "r_3", DB, omega4, alpha4, "r_4"),
            slider_a("P", "B", BP, omega5, alpha5, "r_5", r6_ddot),
        ),
    )


def residual(
    r1,
    r2,
    r3,
    r4,
    r5,
    theta2,
    omega2,
    theta3,
    theta4,
    r6,
    theta5,
    omega3,
    omega4,
    omega5,
    r6_dot,
    alpha3,
    alpha4,
    alpha5,
    r6_ddot,
):
    """Both loop closures and their two derivatives, as complex equations."""
    crank, coupler, rocker, rod = (
        length * np.exp(1j * np.radians(theta))
        for length, theta in ((r2, theta2), (r3, theta3), (r4, theta4), (r5, theta5))
    )
    position_1 = 1j * r1 + crank + coupler - rocker
    position_2 = rocker - r6 - rod
    velocity_1 = 1j * (omega2 * crank + omega3 * coupler - omega4 * rocker)
    velocity_2 = 1j * (omega4 * rocker - omega5 * rod) - r6_dot
    rocker_end = (1j * alpha4 - omega4**2) * rocker
    acceleration_1 = -(omega2**2) * crank + (1j * alpha3 - omega3**2) * coupler - rocker_end
    acceleration_2 = rocker_end - r6_ddot - (1j * alpha5 - omega5**2) * rod
    lengths = r1 + r2 + r3 + r4 + r5
    speeds = r2 * abs(omega2) + r3 * abs(omega3) + r4 * abs(omega4) + r5 * abs(omega5)
    sizes = r2 * omega2**2 + r3 * (omega3**2 + abs(alpha3)) + r4 * (omega4**2 + abs(alpha4))
    sizes = sizes + r5 * (omega5**2 + abs(alpha5))
    return (
        abs(position_1) / lengths,
        abs(position_2) / lengths,
        abs(velocity_1) / speeds,
        abs(velocity_2) / speeds,
        abs(acceleration_1) / sizes,
        abs(acceleration_2) / sizes,
    )


def _degrees_of(y, x):
    return math.degrees(math.atan2(y, x))


KNOWN = (
    # Coupler parallel to the crank: A moves square to it, as B would have to, so the rocker stands still.
    # A = (40, 120), B = (160, 120), slider at (448, 0): triangles 3-4-5 and 5-12-13.
    given(r1=120, r2=40, r3=120, r4=200, r5=312, theta2=0, omega2=9, mode="open").gives(
        mobility=1,
        cycles=2,
        a=9600,
        b=28800,
        c=9600,
        B=-320,
        C=-57344,
        theta3=0,
        theta4=_degrees_of(3, 4),
        r6=448,
        theta5=_degrees_of(5, -12),
        omega3=-3,
        omega4=0,
        omega5=0,
        r6_dot=0,
        alpha3=48,
        alpha4=36,
        alpha5=-20,
        r6_ddot=-6720,
    ),
    # The same crank, B mirrored in the line AD: B = (-56, 192); the rod is parallel to the coupler.
    given(r1=120, r2=40, r3=120, r4=200, r5=320, theta2=0, omega2=15, mode="crossed").gives(
        theta3=_degrees_of(3, -4),
        theta4=_degrees_of(24, -7),
        r6=200,
        theta5=_degrees_of(3, -4),
        omega3=8,
        omega4=3,
        omega5=21 / 32,
        r6_dot=-450,
    ),
    # Crank in line with the frame, coupler and rocker equal: an isosceles triangle, B = (80, 60),
    # whose two sides turn alike.
    given(r1=100, r2=20, r3=100, r4=100, r5=156, theta2=90, omega2=6, mode="open").gives(
        a=0,
        b=24000,
        c=-14400,
        B=-160,
        C=-14336,
        theta3=_degrees_of(-3, 4),
        theta4=_degrees_of(3, 4),
        r6=224,
        theta5=_degrees_of(5, -12),
        omega3=1,
        omega4=1,
        omega5=-5 / 9,
        r6_dot=-280 / 3,
    ),
)
