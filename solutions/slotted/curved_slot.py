"""A crank pin in the curved slot of a lever: solution.

Seen from the lever the pin goes round the centre C of the slot, so positions are those of the four-bar
linkage O, A, C, D; there is no bar AC. The formulas compose the motions of the pin and of the lever's point
under it, along the slot's tangent and normal; their values come from the numeric core of the four-bar
linkage, which keeps its digits near a dead point.
"""

import numpy as np

from coursework.degrees import acos, angle, atan2, cos, from_radians, polar, sin, sqrt, wrap
from coursework.figures import Figure, arc, ground_pivot, line, link, pin, point, vector
from coursework.figures.polygons import (
    Side,
    crank_a,
    crank_v,
    normal,
    polygon_of_accelerations,
    polygon_of_velocities,
    tangential,
    turning,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.dyads import side_of
from coursework.kinematics.four_bar import FourBar
from coursework.mechanics import Body, Mechanism
from coursework.solution import formula, given, mistake, stable

UNITS = {"AD": "mm", "phi": "deg", "psi": "deg", "side": "1"}
SYMBOLS = {"AD": "AD", "phi": r"\varphi", "psi": r"\psi", "side": r"\varepsilon"}
LOOPS = {
    "loop_1": (
        Vector("r2", "theta2"),
        Vector("rho", "theta3"),
        Vector("r1", 0.0, -1),
        Vector("d", "theta4", -1),
    ),
}
EFFECTS = {
    "velocity": ("omega4", "v_rel", "v_A4"),
    "acceleration": ("alpha4", "a_rel_t", "a_rel_n"),
    "coriolis": ("a_coriolis",),
}
#: Body 3 is a block as curved as the slot: it turns on the lever about C.
MECHANISM = Mechanism(
    ground={"O": 0, "D": "r1"},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"C": "rho"}),
        Body("4", "theta4", "D", {"C": "d"}),
    ),
)


def _lever(r1, r2, rho, d, side, theta2):
    """The linkage O, A, C, D at its crank angle, by the numeric core."""
    return FourBar(r1, r2, rho, d, side).at(Degrees(theta2))


@formula(r"\sqrt{<r1>^2 + <r2>^2 - 2 \times <r1> \times <r2> \times \cos <theta2>}")
def AD(r1, r2, theta2):
    """Law of cosines, as a sum of two squares."""
    return sqrt((r1 - r2) ** 2 + 4 * r1 * r2 * sin(theta2 / 2) ** 2)


@formula(r"\operatorname{atan2}\left(-<r2> \sin <theta2>;\ <r1> - <r2> \cos <theta2>\right)")
def phi(r1, r2, theta2):
    """Direction of AD."""
    return atan2(-r2 * sin(theta2), (r1 - r2) + 2 * r2 * sin(theta2 / 2) ** 2)


@stable(lambda _lever: from_radians(_lever.corner))
def psi(rho, d, AD):
    """Angle DAC, by the law of cosines."""
    return acos((AD**2 + rho**2 - d**2) / (2 * AD * rho))


def side(mode):
    """+1 when C lies left of the line A -> D, -1 when right."""
    return side_of(mode)


@stable(lambda _lever: from_radians(_lever.coupler_angle))
def theta3(phi, psi, side):
    """Direction of AC: the normal of the slot, towards its centre."""
    return wrap(phi + side * psi)


@stable(lambda _lever: from_radians(_lever.rocker_angle))
def theta4(r1, r2, theta2, rho, theta3):
    """Direction of DC, by its quadrant."""
    return angle(polar(r2, theta2) + polar(rho, theta3) - r1)


def _across(side, _lever):
    """The sine of theta4 - theta3: the angle ACD, with the sign of the mode."""
    return side * np.sin(_lever.transmission_angle)


def _rate_of_sliding(r1, r2, omega2, theta2, d, v_rel, rho, _across, _lever):
    """The derivative of v_rel = -r1 r2 omega2 sin(theta2) / (d sin(theta4 - theta3)), in which no large terms
    cancel."""
    turning = v_rel**2 * np.cos(_lever.transmission_angle) / rho
    return (turning - r1 * r2 * omega2**2 * cos(theta2) / d) / _across


def tau(theta3):
    """The tangent, from which the normal is 90 degrees ahead."""
    return wrap(theta3 - 90)


@stable(lambda omega2, _lever: _lever.rocker_ratio * omega2)
def omega4(r2, omega2, theta2, theta3, d, theta4):
    """Across the slot, pin and lever have the same velocity."""
    return r2 * omega2 * sin(theta2 - theta3) / (d * sin(theta4 - theta3))


def v_A4(AD, omega4):
    return AD * abs(omega4)


@stable(lambda r1, r2, omega2, theta2, d, _across: -r1 * r2 * omega2 * sin(theta2) / (d * _across))
def v_rel(r2, omega2, theta2, theta3, omega4, d, theta4, rho):
    """The difference of their velocities along the tangent."""
    return omega4 * (d * cos(theta4 - theta3) - rho) - r2 * omega2 * cos(theta2 - theta3)


def a_rel_n(v_rel, rho):
    return v_rel**2 / rho


def a_coriolis(omega4, v_rel):
    return 2 * omega4 * v_rel


@formula(
    r"\frac{<r2> \times <omega2>^2 \times \cos\left(<theta2> - <theta3>\right)"
    r" - <omega4>^2 \times \left(<d> \times \cos\left(<theta4> - <theta3>\right) - <rho>\right)}"
    r"{<d> \times \sin\left(<theta4> - <theta3>\right)}"
    r" + \frac{<a_rel_n> + <a_coriolis>}{<d> \times \sin\left(<theta4> - <theta3>\right)}"
)
@stable(lambda omega2, _lever: _lever.rocker_gain * omega2**2)
def alpha4(r2, omega2, theta2, theta3, omega4, d, theta4, rho, a_rel_n, a_coriolis):
    """The accelerations along the normal: of the pin, of the lever's point, relative and of Coriolis."""
    return (
        r2 * omega2**2 * cos(theta2 - theta3)
        - omega4**2 * (d * cos(theta4 - theta3) - rho)
        + a_rel_n
        + a_coriolis
    ) / (d * sin(theta4 - theta3))


@stable(_rate_of_sliding)
def a_rel_t(r2, omega2, theta2, theta3, alpha4, d, theta4, rho, omega4):
    """The accelerations along the tangent: what is left to the pin's own motion in the slot."""
    return (
        r2 * omega2**2 * sin(theta2 - theta3)
        + alpha4 * (d * cos(theta4 - theta3) - rho)
        - omega4**2 * d * sin(theta4 - theta3)
    )


@mistake("mode")
def other_mode(mode):
    return np.where(side_of(mode) > 0, "crossed", "open")


@mistake("tau")
def tangent_along_the_radius(theta3):
    return theta3


@mistake("tau")
def slot_taken_as_straight_from_D(phi):
    return wrap(phi + 180)


@mistake("tau")
def tangent_square_to_DC(theta4):
    return wrap(theta4 - 90)


@mistake("omega4")
def whole_speed_of_A_on_the_lever(r2, omega2, AD):
    return r2 * omega2 / AD


@mistake("v_A4")
def speed_of_C_for_that_of_A4(d, omega4):
    return d * abs(omega4)


@mistake("v_A4")
def lever_point_as_fast_as_the_pin(r2, omega2):
    return r2 * abs(omega2)


@mistake("v_rel", kind="sign")
def sliding_the_other_way(v_rel):
    return -v_rel


@mistake("v_rel")
def lever_at_rest(r2, omega2, theta2, theta3):
    return -r2 * omega2 * cos(theta2 - theta3)


@mistake("v_rel")
def difference_of_the_speeds(r2, omega2, v_A4):
    return r2 * abs(omega2) - v_A4


@mistake("a_rel_n")
def radius_of_the_lever(v_rel, d):
    return v_rel**2 / d


@mistake("a_coriolis", kind="constant")
def coriolis_no_2(omega4, v_rel):
    return omega4 * v_rel


@mistake("a_coriolis")
def coriolis_of_the_crank(omega2, v_rel):
    return 2 * omega2 * v_rel


def _along_the_normal(r2, omega2, theta2, theta3, omega4, d, theta4, rho):
    """What pin and lever bring without sliding."""
    return r2 * omega2**2 * cos(theta2 - theta3) - omega4**2 * (d * cos(theta4 - theta3) - rho)


@mistake("alpha4")
def no_normal_relative_acceleration(_along_the_normal, a_coriolis, d, theta4, theta3):
    return (_along_the_normal + a_coriolis) / (d * sin(theta4 - theta3))


@mistake("alpha4")
def no_coriolis(_along_the_normal, a_rel_n, d, theta4, theta3):
    return (_along_the_normal + a_rel_n) / (d * sin(theta4 - theta3))


@mistake("a_rel_t")
def lever_without_acceleration(r2, omega2, theta2, theta3):
    return r2 * omega2**2 * sin(theta2 - theta3)


@mistake("a_rel_t")
def lever_without_normal_acceleration(r2, omega2, theta2, theta3, alpha4, d, theta4, rho):
    return r2 * omega2**2 * sin(theta2 - theta3) + alpha4 * (d * cos(theta4 - theta3) - rho)


def polygons(r1, r2, rho, theta2, theta3, omega2, omega4, v_rel, alpha4, a_rel_t, a_coriolis):
    """The pin is A, the lever's point under it A_4; seen from the lever the pin turns about C."""
    OA, CA = polar(r2, theta2), -polar(rho, theta3)
    DA = OA - r1
    return (
        polygon_of_velocities(
            crank_v("A", "OA", OA, omega2),
            (
                turning("p_v", "a_4", "A_4", "AD", DA, omega4),
                turning("a_4", "a", "A/A_4", "AC", CA, v_rel / rho),
            ),
        ),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2),
            (
                Side(
                    "k",
                    "a",
                    r"\vec{a}^c_{A/A_4}",
                    polar(a_coriolis, theta3),
                    r"\parallel AC",
                    r"2 \left|\omega_4\right| V_{A/A_4}",
                ),
                normal("k'", "k", "A/A_4", "AC", CA, v_rel / rho, r"V_{A/A_4}^2 / \rho"),
                normal("p_a", "a_4'", "A_4", "AD", DA, omega4, "V_{A_4}^2 / AD"),
                tangential("a_4'", "a_4", "A_4", "AD", DA, alpha4),
                tangential("a_4", "k'", "A/A_4", "AC", CA, a_rel_t / rho),
            ),
        ),
    )


def figure(r1, r2, theta2, omega2, rho, theta3, tau, omega4, v_rel):
    """The velocities at A: of the pin, of the lever's point under it, and along the slot's tangent."""
    O, A, D = 0j, polar(r2, theta2), complex(r1)
    C = A + polar(rho, theta3)
    v_2, v_4 = 1j * omega2 * A, 1j * omega4 * (A - D)
    scale = 0.4 * (r1 + r2) / max(abs(v_2), abs(v_4), abs(v_rel))
    return Figure(
        line(O, D, dashed=True),
        line(A - polar(0.5 * rho, tau), A + polar(0.5 * rho, tau), dashed=True),
        arc(C, rho, theta3 + 150, theta3 + 210),
        line(A, C, dashed=True, label=r"\rho"),
        line(D, C, dashed=True, label="d"),
        link(O, A, label="r_2"),
        vector(A, scale * v_2, r"\vec{v}_A"),
        vector(A, scale * v_4, r"\vec{v}_{A4}"),
        vector(A + scale * v_4, scale * polar(v_rel, tau), r"\vec{v}_r"),
        ground_pivot(O, "O"),
        ground_pivot(D, "D"),
        pin(A, "A"),
        point(C, "C"),
        paper_mm=(108, 75),
    )


def residual(
    r1,
    r2,
    d,
    rho,
    theta2,
    omega2,
    mode,
    theta3,
    theta4,
    tau,
    omega4,
    v_A4,
    v_rel,
    a_rel_n,
    a_coriolis,
    alpha4,
    a_rel_t,
):
    """The pin in the lever's own frame stays on the circle of the slot; both compositions of motions, as
    complex equations."""
    A = r2 * np.exp(1j * np.radians(theta2))
    lever, normal, along = (np.exp(1j * np.radians(x)) for x in (theta4, theta3, tau))
    from_D = A - r1
    turned = (np.conj(-from_D) * (rho * normal)).imag / (r1 * rho)
    v = 1j * omega4 * from_D + v_rel * along
    a = (1j * alpha4 - omega4**2) * from_D + (a_rel_t + 1j * (a_rel_n + a_coriolis)) * along
    speed, size = r2 * abs(omega2) + abs(v_rel), r2 * omega2**2 + abs(a_rel_t) + a_rel_n
    return (
        abs(from_D - d * lever + rho * normal) / (r1 + r2),
        np.maximum(np.where(mode == "open", -turned, turned), 0),
        abs(1j * along - normal),
        abs(v - 1j * omega2 * A) / speed,
        abs(a + omega2**2 * A) / size,
        (v_A4 - abs(omega4 * from_D)) / speed,
        (a_rel_n - v_rel**2 / rho) / size,
        (a_coriolis - 2 * omega4 * v_rel) / size,
    )


KNOWN = (
    # A parallelogram: crank and lever turn alike, the radius AC keeps its direction, the pin slides steadily.
    given(r1=100, r2=50, rho=100, d=50, theta2=90, omega2=2, mode="open").gives(
        theta3=0,
        theta4=90,
        tau=-90,
        omega4=2,
        v_rel=-200,
        a_rel_n=400,
        a_coriolis=-800,
        alpha4=0,
        a_rel_t=0,
        v_A4=100 * 5**0.5,
    ),
    # Crank along the frame, ACD a 3-4-5 triangle: the pin is at the end of its way in the slot.
    given(r1=80, r2=30, rho=40, d=30, theta2=0, omega2=5, mode="open").gives(
        theta3="36.8699",
        theta4="126.8699",
        tau="-53.1301",
        omega4=-3,
        v_rel=0,
        v_A4=150,
        a_rel_n=0,
        a_coriolis=0,
        alpha4=32,
        a_rel_t=-2000,
    ),
    # Its mirror image.
    given(r1=80, r2=30, rho=40, d=30, theta2=0, omega2=5, mode="crossed").gives(
        theta3="-36.8699", theta4="-126.8699", tau="-126.8699", omega4=-3, alpha4=-32, a_rel_t=2000
    ),
)
