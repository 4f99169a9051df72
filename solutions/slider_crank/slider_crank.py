"""Slider-crank: solution. The rod's vector is what is left from the crank pin to the piston's line.

Its two projections p and q carry everything: sin theta3 = p / r3, cos theta3 = q / r3. The root q and the
accelerations are taken from the numeric core, which keeps their digits where the rod is hardly longer than
the crank.
"""

from math import pi

import numpy as np

from coursework.degrees import atan2, cos, polar, sin, sqrt
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

UNITS = {"p": "mm", "q": "mm"}
LOOPS = {
    "loop_1": (
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("r1", 0.0, -1),
        Vector("e", pi / 2, -1),
    ),
}
MECHANISM = Mechanism(
    ground={"O": 0},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3"}),
        Body("4", 0, "B"),
    ),
    slides=(Slide("B", "4"),),
)


def p(e, r2, theta2):
    """Height of B above A: r3 sin theta3."""
    return e - r2 * sin(theta2)


@stable(lambda r2, r3, e, theta2: SliderCrank(r2, r3, e).run(Degrees(theta2)))
def q(r3, p):
    """Distance of B to the right of A: r3 cos theta3, positive."""
    return sqrt(r3**2 - p**2)


@formula(r"\arcsin \frac{<e> - <r2> \sin <theta2>}{<r3>}")
def theta3(p, q):
    """Direction of AB, to the right of A: between -90 and 90 degrees."""
    return atan2(p, q)


@formula(r"<r2> \cos <theta2> + <r3> \cos <theta3>")
def r1(r2, theta2, q):
    return r2 * cos(theta2) + q


@formula(r"-\frac{<r2> \times <omega2> \times \cos <theta2>}{<r3> \times \cos <theta3>}")
def omega3(r2, omega2, theta2, q):
    """The piston keeps to its line: no velocity across it."""
    return -r2 * omega2 * cos(theta2) / q


@formula(
    r"-<r2> \times <omega2> \times \sin <theta2> + <r2> \times <omega2> \times \cos <theta2> \times "
    r"\tan <theta3>"
)
def r1_dot(r2, omega2, theta2, p, omega3):
    """Velocity of the piston, positive to the right."""
    return -r2 * omega2 * sin(theta2) - p * omega3


def _motion(r2, r3, e, theta2, omega2, alpha2):
    return SliderCrank(r2, r3, e).motion(Degrees(theta2), omega2, alpha2)


@formula(
    r"\frac{<r2> \times <omega2>^2 \times \sin <theta2> - <r2> \times <alpha2> \times \cos <theta2>"
    r" + <r3> \times <omega3>^2 \times \sin <theta3>}{<r3> \times \cos <theta3>}"
)
@stable(lambda _motion: _motion.rod_acceleration)
def alpha3(r2, omega2, alpha2, theta2, p, q, omega3):
    """No acceleration across the line either."""
    return (r2 * omega2**2 * sin(theta2) - r2 * alpha2 * cos(theta2) + p * omega3**2) / q


@formula(
    r"-<r2> \times <alpha2> \times \sin <theta2> - <r2> \times <omega2>^2 \times \cos <theta2>"
    r" - <r3> \times <alpha3> \times \sin <theta3> - <r3> \times <omega3>^2 \times \cos <theta3>"
)
@stable(lambda _motion: _motion.acceleration)
def r1_ddot(r2, omega2, alpha2, theta2, p, q, omega3, alpha3):
    """Acceleration of the piston, positive to the right."""
    return -r2 * alpha2 * sin(theta2) - r2 * omega2**2 * cos(theta2) - p * alpha3 - q * omega3**2


def pv_a(r2, omega2, kv):
    return r2 * abs(omega2) / kv


def pv_b(r1_dot, kv):
    return abs(r1_dot) / kv


def ab(r3, omega3, kv):
    return r3 * abs(omega3) / kv


def pa_a(r2, omega2, ka):
    return r2 * omega2**2 / ka


def ab_n(r3, omega3, ka):
    return r3 * omega3**2 / ka


def bb_t(r3, alpha3, ka):
    return r3 * abs(alpha3) / ka


def pa_b(r1_ddot, ka):
    return abs(r1_ddot) / ka


@mistake("r1_dot", kind="sign")
def notes_piston_sign(r2, omega2, theta2, p, q):
    return r2 * omega2 * sin(theta2) - r2 * omega2 * cos(theta2) * p / q


@mistake("r1_dot")
def one_sign_wrong(r2, omega2, theta2, p, q):
    return -r2 * omega2 * sin(theta2) - r2 * omega2 * cos(theta2) * p / q


@mistake("r1_dot")
def rod_forgotten_in_v(r2, omega2, theta2):
    return -r2 * omega2 * sin(theta2)


@mistake("p", kind="sign")
def theta3_sign(p):
    return -p


@mistake("omega3", kind="sign")
def omega3_sign(omega3):
    return -omega3


@mistake("r1_ddot")
def rod_normal_missing(r1_ddot, q, omega3):
    return r1_ddot + q * omega3**2


@mistake("pa_a")
def square_forgotten(r2, omega2, ka):
    return r2 * abs(omega2) / ka


@mistake("kv", "ka")
def scales_exchanged(kv, ka):
    return ka, kv


@mistake("kv", "ka", kind="inverse")
def multiplied_by_the_scale(kv, ka):
    return 1 / kv, 1 / ka


@mistake("kv", "ka")
def scale_left_out(kv, ka):
    return 1, 1


def polygons(r2, theta2, omega2, alpha2, p, q, omega3, r1_dot, alpha3, r1_ddot, kv, ka):
    """At the scales of the statement."""
    OA, AB = polar(r2, theta2), q + 1j * p
    return (
        polygon_of_velocities(
            crank_v("A", "OA", OA, omega2), slider_v("B", "A", AB, omega3, r1_dot), scale=kv
        ),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2, alpha2),
            slider_a("B", "A", AB, omega3, alpha3, "r_3", r1_ddot),
            scale=ka,
        ),
    )


def residual(r2, r3, e, theta2, omega2, alpha2, theta3, r1, omega3, r1_dot, alpha3, r1_ddot):
    """Loop closure and its two derivatives, as complex equations."""
    crank = r2 * np.exp(1j * np.radians(theta2))
    rod = r3 * np.exp(1j * np.radians(theta3))
    position = crank + rod - (r1 + 1j * e)
    velocity = 1j * (omega2 * crank + omega3 * rod) - r1_dot
    acceleration = (1j * alpha2 - omega2**2) * crank + (1j * alpha3 - omega3**2) * rod - r1_ddot
    size = r2 * (omega2**2 + abs(alpha2)) + r3 * (omega3**2 + abs(alpha3))
    return (
        abs(position) / (r2 + r3),
        abs(velocity) / (r2 * abs(omega2) + r3 * abs(omega3)),
        abs(acceleration) / size,
    )


_ROOT3 = 3**0.5

KNOWN = (
    # Crank upright: a 3-4-5 triangle, the rod in translation at this instant.
    given(r2=30, r3=50, theta2=90, omega2=8, kv=4, ka=40).gives(
        theta3="-36.8699",
        r1=40,
        omega3=0,
        r1_dot=-240,
        alpha3=48,
        r1_ddot=1440,
        pv_a=60,
        pv_b=60,
        ab=0,
        pa_a=48,
        ab_n=0,
        bb_t=60,
        pa_b=36,
    ),
    # Outer dead centre: crank and rod in line turn opposite ways.
    given(r2=40, r3=120, theta2=0, omega2=-6).gives(
        theta3=0,
        r1=160,
        omega3=2,
        r1_dot=0,
        alpha3=0,
        r1_ddot=-1920,
    ),
    # Inner dead centre.
    given(r2=40, r3=120, theta2=180, omega2=6).gives(
        theta3=0,
        r1=80,
        omega3=2,
        r1_dot=0,
        alpha3=0,
        r1_ddot=960,
    ),
    # Rod and crank equal: an isosceles triangle, r1 = 2 r2 cos theta2.
    given(r2=100, r3=100, theta2=60, omega2=5).gives(
        theta3=-60,
        r1=100,
        omega3=-5,
        r1_dot=-500 * _ROOT3,
        alpha3=0,
        r1_ddot=-2500,
    ),
    # A is 10 above O and the line 20 below: the rod falls by 30, a 3-4-5 triangle again.
    given(r2=20, r3=50, e=-20, theta2=30, omega2=4, kv=2, ka=10).gives(
        theta3="-36.8699",
        r1=40 + 10 * _ROOT3,
        omega3=-_ROOT3,
        r1_dot=-40 - 30 * _ROOT3,
        alpha3=1.75,
        r1_ddot=-160 * _ROOT3 - 67.5,
        pv_a=40,
        pv_b=20 + 15 * _ROOT3,
        ab=25 * _ROOT3,
        pa_a=32,
        ab_n=15,
        bb_t=8.75,
        pa_b=16 * _ROOT3 + 6.75,
    ),
    # The same place, the crank starting from rest.
    given(r2=20, r3=50, e=-20, theta2=30, omega2=0, alpha2=8).gives(
        omega3=0,
        r1_dot=0,
        alpha3=-2 * _ROOT3,
        r1_ddot=-80 - 60 * _ROOT3,
    ),
)
