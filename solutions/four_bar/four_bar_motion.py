"""Four-bar linkage, velocities and accelerations: solution. The loop O, A, B, C and its two derivatives.

The formulas are the course's. What they give near a dead point or a change point is taken from the numeric
core instead, which keeps its digits there.
"""

import numpy as np

from coursework.degrees import cos, polar, sin
from coursework.figures import Figure, ground_pivot, line, link, pin, vector
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    polygon_of_accelerations,
    polygon_of_velocities,
    two_bars_a,
    two_bars_v,
)
from coursework.kinematics.chains import Vector
from coursework.kinematics.dyads import side_of
from coursework.solution import formula, given, mistake, stable

from ._four_bar import *

UNITS = {"AC": "mm", "phi": "deg", "psi": "deg", "side": "1"}
SYMBOLS = {"AC": "AC", "phi": r"\varphi", "psi": r"\psi", "side": r"\varepsilon"}
LOOPS = {
    "loop_1": (
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("r1", 0.0, -1),
        Vector("r4", "theta4", -1),
    ),
}
EFFECTS = {
    "velocity": ("omega3", "omega4", "v_B", "v_BA"),
    "acceleration": ("alpha3", "alpha4", "a_B", "a_BA_n", "a_BA_t"),
}


@formula(
    r"\frac{<r2> \times <alpha2> \times \sin\left(<theta2> - <theta4>\right)"
    r" + <r2> \times <omega2>^2 \times \cos\left(<theta2> - <theta4>\right)}"
    r"{<r3> \times \sin\left(<theta4> - <theta3>\right)}"
    r" + \frac{<r3> \times <omega3>^2 \times \cos\left(<theta4> - <theta3>\right) - <r4> \times <omega4>^2}"
    r"{<r3> \times \sin\left(<theta4> - <theta3>\right)}"
)
@stable(lambda omega2, alpha2, _linkage: _linkage.coupler_gain * omega2**2 + _linkage.coupler_ratio * alpha2)
def alpha3(r2, omega2, alpha2, theta2, r3, omega3, theta3, r4, omega4, theta4):
    """The accelerations of B by the coupler and by the rocker have the same projection along the rocker."""
    return (
        r2 * alpha2 * sin(theta2 - theta4)
        + r2 * omega2**2 * cos(theta2 - theta4)
        + r3 * omega3**2 * cos(theta4 - theta3)
        - r4 * omega4**2
    ) / (r3 * sin(theta4 - theta3))


@formula(
    r"\frac{<r2> \times <alpha2> \times \sin\left(<theta2> - <theta3>\right)"
    r" + <r2> \times <omega2>^2 \times \cos\left(<theta2> - <theta3>\right)}"
    r"{<r4> \times \sin\left(<theta4> - <theta3>\right)}"
    r" + \frac{<r3> \times <omega3>^2 - <r4> \times <omega4>^2 \times \cos\left(<theta4> - <theta3>\right)}"
    r"{<r4> \times \sin\left(<theta4> - <theta3>\right)}"
)
@stable(lambda omega2, alpha2, _linkage: _linkage.rocker_gain * omega2**2 + _linkage.rocker_ratio * alpha2)
def alpha4(r2, omega2, alpha2, theta2, r3, omega3, theta3, r4, omega4, theta4):
    """They have the same projection along the coupler."""
    return (
        r2 * alpha2 * sin(theta2 - theta3)
        + r2 * omega2**2 * cos(theta2 - theta3)
        + r3 * omega3**2
        - r4 * omega4**2 * cos(theta4 - theta3)
    ) / (r4 * sin(theta4 - theta3))


def v_B(r4, omega4):
    return r4 * abs(omega4)


@formula(r"<r4> \times \sqrt{<alpha4>^2 + <omega4>^4}")
def a_B(r4, omega4, alpha4):
    """B moves on a circle about C: a tangential and a normal part."""
    return r4 * abs(alpha4 + 1j * omega4**2)


def v_BA(r3, omega3):
    return r3 * abs(omega3)


def a_BA_n(r3, omega3):
    return r3 * omega3**2


def a_BA_t(r3, alpha3):
    return r3 * alpha3


@mistake("omega3", "omega4", kind="angle_sign")
def sum_in_denominator(r2, omega2, r3, r4, theta2, theta3, theta4):
    return (
        r2 * omega2 * sin(theta2 - theta4) / (r3 * sin(theta3 + theta4)),
        r2 * omega2 * sin(theta2 - theta3) / (r4 * sin(theta3 + theta4)),
    )


@mistake("omega3", "omega4", kind="sign")
def signs_of_omegas(omega3, omega4):
    return -omega3, -omega4


@mistake("omega3", "omega4")
def omega_exchanged(omega3, omega4):
    return omega4, omega3


@mistake("alpha3", "alpha4")
def no_normal_terms(omega2, alpha2, omega3, omega4):
    return omega3 / omega2 * alpha2, omega4 / omega2 * alpha2


@mistake("alpha2")
def alpha2_left_out():
    return 0.0


@mistake("v_BA")
def v_BA_scalar(r2, omega2, v_B):
    return abs(v_B - r2 * abs(omega2))


@mistake("mode")
def other_mode(mode):
    return np.where(side_of(mode) > 0, "crossed", "open")


def polygons(r2, r3, r4, theta2, theta3, theta4, omega2, omega3, omega4, alpha2, alpha3, alpha4):
    OA, AB, CB = polar(r2, theta2), polar(r3, theta3), polar(r4, theta4)
    return (
        polygon_of_velocities(
            crank_v("A", "OA", OA, omega2), two_bars_v("B", "A", "C", AB, omega3, CB, omega4)
        ),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2, alpha2),
            two_bars_a("B", "A", "C", AB, omega3, alpha3, "r_3", CB, omega4, alpha4, "r_4"),
        ),
    )


def figure(r1, r2, theta2, r3, theta3, omega2, omega4):
    """The velocities of A and B on the linkage, at one scale."""
    O, A, C = 0j, polar(r2, theta2), complex(r1)
    B = A + polar(r3, theta3)
    v_A, v_B = 1j * omega2 * A, 1j * omega4 * (B - C)
    scale = 0.25 * (r1 + r2) / max(abs(v_A), abs(v_B), 1e-9 * r1)
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        vector(A, scale * v_A, "v_A"),
        vector(B, scale * v_B, "v_B"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        paper_mm=(108, 54),
    )


def residual(
    r1,
    r2,
    r3,
    r4,
    theta2,
    omega2,
    alpha2,
    mode,
    theta3,
    theta4,
    omega3,
    omega4,
    alpha3,
    alpha4,
    v_B,
    a_B,
    v_BA,
    a_BA_n,
    a_BA_t,
):
    """Loop closure, its two derivatives, the side of B, and B's motion as seen from C and from A."""
    crank, coupler, rocker = (
        length * np.exp(1j * np.radians(theta))
        for length, theta in ((r2, theta2), (r3, theta3), (r4, theta4))
    )
    turned = (np.conj(r1 - crank) * coupler).imag / (r1 * r3)
    v_A, a_A = 1j * omega2 * crank, (1j * alpha2 - omega2**2) * crank
    by_rocker, a_by_rocker = 1j * omega4 * rocker, (1j * alpha4 - omega4**2) * rocker
    by_coupler, a_by_coupler = by_rocker - v_A, a_by_rocker - a_A
    speeds = abs(v_A) + abs(by_rocker) + r3 * abs(omega3)
    sizes = abs(a_A) + abs(a_by_rocker) + r3 * (omega3**2 + abs(alpha3))
    unit = coupler / r3
    return (
        abs(crank + coupler - r1 - rocker) / (r1 + r2 + r3 + r4),
        np.maximum(np.where(mode == "open", -turned, turned), 0),
        abs(by_coupler - 1j * omega3 * coupler) / speeds,
        abs(a_by_coupler - (1j * alpha3 - omega3**2) * coupler) / sizes,
        abs(abs(by_rocker) - v_B) / speeds,
        abs(abs(a_by_rocker) - a_B) / sizes,
        abs(abs(by_coupler) - v_BA) / speeds,
        abs(a_by_coupler - (1j * a_BA_t - a_BA_n) * unit) / sizes,
    )


_RIGHT_ANGLE = {"r1": 80, "r2": 30, "r3": 40, "r4": 30, "theta2": 0, "omega2": 5, "alpha2": 10}

KNOWN = (
    # A rectangle that is a parallelogram: the coupler only translates, B moves as A does.
    given(r1=100, r2=50, r3=100, r4=50, theta2=90, omega2=2, alpha2=3, mode="open").gives(
        theta3=0,
        theta4=90,
        omega3=0,
        omega4=2,
        alpha3=0,
        alpha4=3,
        v_B=100,
        a_B=250,
        v_BA=0,
        a_BA_n=0,
        a_BA_t=0,
    ),
    # Crank along the frame, ABC a 3-4-5 triangle, right-angled at B: coupler and rocker turn alike.
    given(**_RIGHT_ANGLE, mode="open").gives(
        theta3="36.8699",
        theta4="126.8699",
        omega3=-3,
        omega4=-3,
        alpha3=-24,
        alpha4=26,
        v_B=90,
        a_B=30 * 757**0.5,
        v_BA=120,
        a_BA_n=360,
        a_BA_t=-960,
    ),
    # Its mirror image: what omega2 squared brings changes sign, what alpha2 brings does not.
    given(**_RIGHT_ANGLE, mode="crossed").gives(
        theta3="-36.8699",
        theta4="-126.8699",
        omega3=-3,
        omega4=-3,
        alpha3=12,
        alpha4=-38,
        a_BA_t=480,
    ),
    # Crank and coupler stretched out: the rocker turns back. OCB has a right angle at C, 60 degrees at O.
    given(r1=60, r2=30, r3=90, r4=60 * 3**0.5, theta2=60, omega2=3, alpha2=6, mode="open").gives(
        theta3=60,
        theta4=90,
        omega3=-1,
        omega4=0,
        alpha3=4 * 3**0.5 - 2,
        alpha4=4 * 3**0.5,
        v_B=0,
        a_B=720,
        v_BA=90,
        a_BA_n=90,
    ),
)
