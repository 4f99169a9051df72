"""Mechanical advantage of a slider-crank: solution. What goes in as power comes out as power.

The force F_e acts on the crank pin A along its velocity, F_s is what the piston pushes with along its
line. The linkage is that of slider_crank: p and q are the projections of its rod.
"""

import numpy as np

from coursework.degrees import atan2, cos, polar, sin, sqrt
from coursework.errors import Undefined
from coursework.figures.polygons import crank_v, polygon_of_velocities, slider_v
from coursework.kinematics.angles import Degrees
from coursework.kinematics.slider_crank import SliderCrank
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import Moving, given, mistake, stable

UNITS = {
    "p": "mm",
    "q": "mm",
    "theta3": "deg",
    "omega3": "rad/s",
    "V_e": "mm/s",
    "V_s": "mm/s",
    "V_BA": "mm/s",
}
SYMBOLS = {"V_BA": "V_{BA}"}
EFFECTS = {
    "position": ("theta3",),
    "velocity": ("omega3", "r1_dot"),
    "advantage": ("mechanical_advantage",),
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


def theta3(p, q):
    """Direction of AB, to the right of A: between -90 and 90 degrees."""
    return atan2(p, q)


def omega3(r2, omega2, theta2, q):
    """The piston keeps to its line: no velocity across it."""
    return -r2 * omega2 * cos(theta2) / q


def r1_dot(r2, omega2, theta2, p, omega3):
    """Velocity of the piston, positive to the right."""
    return -r2 * omega2 * sin(theta2) - p * omega3


def V_e(r2, omega2):
    """Speed of the crank pin A."""
    return r2 * abs(omega2)


def V_s(r1_dot):
    """Speed of the piston."""
    return abs(r1_dot)


def V_BA(r3, omega3):
    """Speed of B as seen from A."""
    return r3 * abs(omega3)


def mechanical_advantage(V_e, V_s):
    """Equation 21: F_e V_e = F_s V_s; undefined when the piston is at rest."""
    if np.ndim(V_s) == 0 and V_s == 0:
        raise Undefined("the piston is at rest: the mechanical advantage grows without bound there")
    return V_e / np.where(V_s == 0, np.nan, V_s)[()]


def F_e(r2, Gamma_e):
    """The force square to the crank that has this torque about O, in N*m."""
    return 1000 * Gamma_e / r2


def F_s(F_e, mechanical_advantage):
    """Equation 20."""
    return mechanical_advantage * F_e


@mistake("r1_dot", kind="term_sign")
def notes_piston_sign(r2, omega2, theta2, p, q):
    return r2 * omega2 * sin(theta2) - r2 * omega2 * cos(theta2) * p / q


@mistake("r1_dot", kind="term_sign")
def one_sign_wrong(r2, omega2, theta2, p, q):
    return -r2 * omega2 * sin(theta2) - r2 * omega2 * cos(theta2) * p / q


@mistake("r1_dot")
def rod_forgotten_in_v(r2, omega2, theta2):
    return -r2 * omega2 * sin(theta2)


@mistake("mechanical_advantage", kind="inverse")
def advantage_inverse(V_e, V_s):
    return V_s / V_e


@mistake("mechanical_advantage")
def v_of_rod(V_e, V_BA):
    return V_e / V_BA


@mistake("F_e")
def torque_by_the_rod(r3, Gamma_e):
    return 1000 * Gamma_e / r3


@mistake("F_s")
def force_divided(F_e, mechanical_advantage):
    return F_e / mechanical_advantage


def polygons(r2, theta2, omega2, p, q, omega3, r1_dot):
    return (
        polygon_of_velocities(
            crank_v("A", "OA", polar(r2, theta2), omega2), slider_v("B", "A", q + 1j * p, omega3, r1_dot)
        ),
    )


def motion(r2, theta2, omega2, p, q, r1_dot):
    """The crank pin and the piston."""
    crank = polar(r2, theta2)
    return {"A": Moving(crank, 1j * omega2 * crank), "B": Moving(crank + q + 1j * p, r1_dot)}


def residual(r2, r3, e, theta2, omega2, Gamma_e, theta3, omega3, r1_dot, mechanical_advantage, F_e, F_s):
    """The rod's end stays on its line, also in its velocity; power in, power out."""
    crank, bar = r2 * np.exp(1j * np.radians(theta2)), r3 * np.exp(1j * np.radians(theta3))
    velocity = 1j * (omega2 * crank + omega3 * bar)
    power = 1000 * Gamma_e * abs(omega2)
    return (
        abs((crank + bar).imag - e) / r3,
        abs(velocity - r1_dot) / (r2 * abs(omega2)),
        np.maximum(-bar.real, 0) / r3,
        abs(F_e * r2 * abs(omega2) - power) / power,
        abs(F_s * abs(velocity) - power) / power,
        abs(mechanical_advantage * F_e - F_s) / F_s,
    )


KNOWN = (
    # Crank upright: the rod translates at this instant, piston and crank pin go alike.
    given(r2=30, r3=50, theta2=90, omega2=8, Gamma_e=6).gives(
        r1_dot=-240, mechanical_advantage=1, F_e=200, F_s=200
    ),
    # Rod and crank equal: r1 = 2 r2 cos theta2, so that at 30 degrees piston and crank pin go alike.
    given(r2=100, r3=100, theta2=30, omega2=5, Gamma_e=10).gives(
        r1_dot=-500, mechanical_advantage=1, F_e=100, F_s=100
    ),
    # And where sin theta2 = 1/4, half as fast.
    given(r2=100, r3=100, theta2=float(np.degrees(np.arcsin(0.25))), omega2=-2, Gamma_e=10).gives(
        r1_dot=100, mechanical_advantage=2, F_s=200
    ),
    # A is 10 above O and the line 20 below, a 3-4-5 triangle.
    given(r2=20, r3=50, e=-20, theta2=30, omega2=4, Gamma_e=1).gives(
        omega3=-(3**0.5), r1_dot=-40 - 30 * 3**0.5, F_e=50, mechanical_advantage=80 / (40 + 30 * 3**0.5)
    ),
)
