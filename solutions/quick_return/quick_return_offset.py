"""Quick return of an offset slider-crank: solution.

The piston turns back where crank and rod are in line: at C2, the far end, they are stretched, and at C1, the
near end, folded. The two directions from O to these points are not the same, as the line of the piston does
not pass through O: the crank turns more than half a turn during one stroke and less during the other.
"""

import math
from math import pi

import numpy as np

from coursework.degrees import asin, atan2, cos, from_radians, polar, sin, sqrt
from coursework.errors import CannotAssemble
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    polygon_of_accelerations,
    polygon_of_velocities,
    slider_a,
    slider_v,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.slider_crank import SliderCrank
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import formula, given, mistake, stable

from ._in_line import _in_line
from ._strokes import *

UNITS = {
    "theta3": "deg",
    "p": "mm",
    "q": "mm",
    "omega3": "rad/s",
    "alpha3": "rad/s^2",
    "x1": "mm",
    "x2": "mm",
    "phi1": "deg",
    "phi2": "deg",
    "T": "s",
}
SYMBOLS = {"phi1": r"\varphi_1", "phi2": r"\varphi_2"}
LOOPS = {
    "loop_1": (
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("xC", 0.0, -1),
        Vector("e", pi / 2, -1),
    ),
}
RATES = {"xC": ("v_C", "a_C")}
MECHANISM = Mechanism(
    ground={"O": 0},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"C": "r3"}),
        Body("4", 0, "C"),
    ),
    slides=(Slide("C", "4"),),
)


def _turning(r2, r3, e):
    """The linkage, whose crank makes a whole turn: by the numeric core."""
    linkage = SliderCrank(r2, r3, e)
    if isinstance(r2 + r3 + e, float) and not linkage.turns_fully():
        raise CannotAssemble(
            f"the crank does not turn fully: the rod must be longer than r2 + |e| = {r2 + abs(e):.6g}; "
            f"it is {r3:.6g} (gap {r2 + abs(e) - r3:.3g})"
        )
    return linkage


def p(e, r2, theta2):
    """Height of C above A."""
    return e - r2 * sin(theta2)


@stable(lambda r2, r3, e, theta2: SliderCrank(r2, r3, e).run(Degrees(theta2)))
def q(r3, p):
    """Distance of C to the right of A."""
    return sqrt(r3**2 - p**2)


def xC(r2, theta2, q):
    return r2 * cos(theta2) + q


@formula(r"\operatorname{atan2}\left(<p>;\ <q>\right)")
def theta3(p, q):
    """Direction of the rod, from A to C."""
    return atan2(p, q)


def omega3(r2, omega2, theta2, q):
    """The piston keeps to its line: no velocity across it."""
    return -r2 * omega2 * cos(theta2) / q


def v_C(r2, omega2, theta2, p, omega3):
    """Velocity of the piston, positive to the right."""
    return -r2 * omega2 * sin(theta2) - p * omega3


def alpha3(r2, omega2, theta2, p, q, omega3):
    """The piston keeps to its line: no acceleration across it."""
    return (r2 * omega2**2 * sin(theta2) + omega3**2 * p) / q


def a_C(r2, omega2, theta2, p, q, omega3, alpha3):
    """Acceleration of the piston, positive to the right."""
    return -r2 * omega2**2 * cos(theta2) - omega3**2 * q - alpha3 * p


@stable(lambda r2, r3, e, _turning: sqrt((r3 + r2 - e) * (r3 + r2 + e)))
def x2(r2, r3, e):
    """Crank and rod stretched in line."""
    return sqrt((r3 + r2) ** 2 - e**2)


@stable(lambda r2, r3, e, _turning: sqrt(np.where(r3 >= r2, (r3 - r2 - e) * (r3 - r2 + e), np.nan)[()]))
def x1(r2, r3, e):
    """Rod folded back over the crank."""
    return sqrt((r3 - r2) ** 2 - e**2)


@stable(lambda _turning: _turning.stroke())
def stroke(x2, x1):
    return x2 - x1


@stable(lambda e, x1: atan2(abs(e), x1))
def phi1(r2, r3, e):
    """Between the x axis and the line OC1."""
    return asin(abs(e) / (r3 - r2))


@stable(lambda e, x2: atan2(abs(e), x2))
def phi2(r2, r3, e):
    """Between the x axis and the line OC2."""
    return asin(abs(e) / (r3 + r2))


@stable(lambda _turning: 180 + from_radians(abs(_turning.quick_return())))
def alpha(phi1, phi2):
    """The longer of the two arcs of crank between the positions in line."""
    return 180 + phi1 - phi2


@mistake("e", kind="sign")
def e_sign(e):
    return -e


@mistake("e")
def e_forgotten(e):
    return 0 * e


@mistake("v_C", kind="sign")
def velocity_sign(r2, omega2, theta2, p, q):
    return r2 * omega2 * sin(theta2) - r2 * omega2 * cos(theta2) * p / q


@mistake("v_C")
def rod_forgotten_in_v(r2, omega2, theta2):
    return -r2 * omega2 * sin(theta2)


@mistake("a_C")
def a_C_no_rod_normal(a_C, omega3, q):
    return a_C + omega3**2 * q


@mistake("a_C")
def rod_forgotten_in_a(r2, omega2, theta2):
    return -r2 * omega2**2 * cos(theta2)


@mistake("alpha3")
def rod_turns_at_a_constant_rate():
    return 0.0


@mistake("a_C", kind="sign")
def a_C_sign(a_C):
    return -a_C


@mistake("stroke")
def stroke_2r2(r2):
    return 2 * r2


@mistake("stroke")
def stroke_no_root(r2, r3, e):
    return sqrt((r3 + r2) ** 2 + e**2) - sqrt((r3 - r2) ** 2 + e**2)


@mistake("alpha")
def Q_one(alpha):
    return 180 + 0 * alpha


@mistake("alpha", kind="constant")
def half_asymmetry(alpha):
    return 90 + alpha / 2


@mistake("alpha", kind="term_sign")
def sum_of_angles(phi1, phi2):
    return 180 + phi1 + phi2


@mistake("alpha")
def one_dead_point(phi1):
    return 180 + phi1


@mistake("Q", kind="inverse")
def Q_inverse(alpha, beta):
    return beta / alpha


@mistake("T", kind="inverse")
def T_is_frequency(omega2):
    return abs(omega2) / (2 * math.pi)


@mistake("alpha", "beta", kind="exchanged")
def advance_and_return_exchanged(alpha, beta):
    return beta, alpha


def polygons(r2, theta2, omega2, p, q, omega3, v_C, alpha3, a_C):
    crank, rod = polar(r2, theta2), q + 1j * p
    return (
        polygon_of_velocities(crank_v("A", "OA", crank, omega2), slider_v("C", "A", rod, omega3, v_C)),
        polygon_of_accelerations(
            crank_a("A", "OA", crank, omega2), slider_a("C", "A", rod, omega3, alpha3, "r_3", a_C)
        ),
    )


def figure(r2, e, omega2, x1, x2):
    return _in_line(r2, e, x1, x2, anticlockwise=omega2 > 0)


def residual(r2, r3, e, theta2, omega2, xC, v_C, omega3, stroke, alpha, beta, Q, t_advance, t_return):
    """Loop closure and its derivative; both dead positions, reached from each other by the arc alpha;
    times."""
    crank = r2 * np.exp(1j * np.radians(theta2))
    rod = xC + 1j * e - crank
    far = (r3 + r2) * np.exp(1j * np.arcsin(e / (r3 + r2)))
    near = far - stroke
    # From A2 to A1 the crank turns by alpha, anticlockwise when the line is above O.
    turned = far / (r3 + r2) * np.exp(1j * np.where(e < 0, -1, 1) * np.radians(alpha))
    turn = 2 * np.pi / abs(omega2)
    return (
        abs(abs(rod) - r3) / r3,
        abs(np.minimum(rod.real, 0)) / r3,
        abs(1j * (omega2 * crank + omega3 * rod) - v_C) / (r2 * abs(omega2) + r3 * abs(omega3)),
        abs(near + (r3 - r2) * turned) / r3,
        abs(alpha + beta - 360) / 360,
        np.maximum(beta - alpha, 0) / 360,
        abs(Q * beta - alpha) / alpha,
        abs(t_advance + t_return - turn) / turn,
        abs(t_advance * beta - t_return * alpha) / (turn * alpha),
    )


_ROOT3 = 3**0.5

KNOWN = (
    # Stretched a 60-144-156 triangle, folded a 60-80-100 one; upright, C is 32 above A and the rod in
    # translation.
    given(r2=28, r3=128, e=60, theta2=90, omega2=5).gives(
        xC=(96 * 160) ** 0.5,
        v_C=-140,
        a_C=-22400 / (96 * 160) ** 0.5,
        x1=80,
        x2=144,
        stroke=64,
        alpha="194.250",
        beta="165.750",
        Q="1.17195",
    ),
    # Dead: the piston stands still at the far end.
    given(r2=28, r3=128, e=-60, theta2="-22.619864948040426 deg", omega2=-5).gives(
        xC=144, v_C=0, alpha="194.250"
    ),
    # A is 10 above O and the line 20 below: the rod falls by 30, a 3-4-5 triangle.
    given(r2=20, r3=50, e=-20, theta2=30, omega2=4).gives(xC=40 + 10 * _ROOT3, v_C=-40 - 30 * _ROOT3),
    # A rod only just long enough: folded, it stands square to the line; stretched, it leans by 30 degrees.
    given(r2=40, r3=120, e=80, theta2=90, omega2=-math.pi).gives(
        x1=0, stroke=80 * _ROOT3, alpha=240, beta=120, Q=2, t_advance=4 / 3, t_return=2 / 3
    ),
    # In line with the crank the strokes last alike.
    given(r2=30, r3=100, e=0, theta2=180, omega2=2 * math.pi).gives(
        xC=70, v_C=0, stroke=60, alpha=180, beta=180, Q=1, t_advance=0.5
    ),
)
