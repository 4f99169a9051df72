"""Four-bar linkage: the crank's torque and the forces in the joints, from the effects that are called for.

Each effect is a bundle of forces and couples on the bodies, inertia among them by d'Alembert's principle. The
torque follows from their virtual power alone, without any force of a joint; these come from the balance of
the moments of coupler and rocker about their far pins, then body by body. Without effects nothing pulls.
"""

from typing import Any, NamedTuple

import numpy as np

from coursework.degrees import cos, polar, sin
from coursework.figures.polygons import (
    Side,
    crank_a,
    crank_v,
    polygon_of_accelerations,
    polygon_of_velocities,
    two_bars_a,
    two_bars_v,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.dyads import side_of
from coursework.mechanics import Body, Load, Mechanism
from coursework.solution import Moving, formula, given, mistake, stable

from ._four_bar import *

GRAVITY = 9.81  #: m/s^2, along -y

UNITS = {
    "AC": "mm",
    "phi": "deg",
    "psi": "deg",
    "side": "1",
    "theta3": "deg",
    "theta4": "deg",
    "D": "1",
    "k3": "1",
    "k4": "1",
    "omega3": "rad/s",
    "omega4": "rad/s",
    "alpha3": "rad/s^2",
    "alpha4": "rad/s^2",
    "a_G3_x": "mm/s^2",
    "a_G3_y": "mm/s^2",
    "a_G4_x": "mm/s^2",
    "a_G4_y": "mm/s^2",
    "X3": "N",
    "Y3": "N",
    "X4": "N",
    "Y4": "N",
    "M2": "N*m",
    "Y2": "N",
    "M_A": "N*m",
    "M_C": "N*m",
    "R_B_x": "N",
    "R_B_y": "N",
    "R_A_x": "N",
    "R_A_y": "N",
    "R_C_x": "N",
    "R_C_y": "N",
    "R_O_y": "N",
}
SYMBOLS = {
    "AC": "AC",
    "phi": r"\varphi",
    "psi": r"\psi",
    "side": r"\varepsilon",
    "a_G3_x": "a_{G_3x}",
    "a_G3_y": "a_{G_3y}",
    "a_G4_x": "a_{G_4x}",
    "a_G4_y": "a_{G_4y}",
}
LOOPS = {
    "loop_1": (
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("r1", 0.0, -1),
        Vector("r4", "theta4", -1),
    ),
}


EFFECTS = {
    "acceleration": ("alpha3", "alpha4", "a_G3_x", "a_G3_y", "a_G4_x", "a_G4_y"),
    "forces": ("torque", "R_B", "R_A", "R_C", "R_O"),
}
MECHANISM = Mechanism(
    ground={"O": 0, "C": "r1"},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}, mass="m2", inertia="J2"),
        Body(
            "3",
            "theta3",
            "A",
            {"B": "r3", "G3": lambda s3, r3: s3 * r3},
            mass="m3",
            inertia="J3",
            centre="G3",
        ),
        Body(
            "4",
            "theta4",
            "C",
            {"B": "r4", "G4": lambda s4, r4: s4 * r4},
            mass="m4",
            inertia="J4",
            centre="G4",
        ),
    ),
    loads=(Load("4", moment="M", against=True),),
)


class _Loads(NamedTuple):
    """Loads on the bodies besides the joints: on the coupler the force X3, Y3 at G3, in N, and its moment M_A
    about A, in N*m; on the rocker X4, Y4 at G4 and M_C about C; on the crank Y2 at O and M2."""

    X3: Any = 0.0
    Y3: Any = 0.0
    M_A: Any = 0.0
    X4: Any = 0.0
    Y4: Any = 0.0
    M_C: Any = 0.0
    Y2: Any = 0.0
    M2: Any = 0.0


_NONE = _Loads()


@stable(lambda _bars, theta2, side: side / _bars.conditioning(Degrees(theta2)))
def D(theta3, theta4):
    """Sine of the angle from coupler to rocker: 0 at a dead point of the rocker."""
    return sin(theta4 - theta3)


@stable(lambda _linkage: _linkage.coupler_ratio)
def k3(r2, r3, theta2, theta4, D):
    """Turns of the coupler per turn of the crank: along the rocker, B has no velocity."""
    return r2 * sin(theta2 - theta4) / (r3 * D)


@stable(lambda _linkage: _linkage.rocker_ratio)
def k4(r2, r4, theta2, theta3, D):
    """Turns of the rocker per turn of the crank: along the coupler, A and B have the same velocity."""
    return r2 * sin(theta2 - theta3) / (r4 * D)


def omega3(k3, omega2):
    return k3 * omega2


def omega4(k4, omega2):
    return k4 * omega2


@stable(lambda omega2, alpha2, _linkage: _linkage.coupler_gain * omega2**2 + _linkage.coupler_ratio * alpha2)
def alpha3(r2, omega2, k3, alpha2, r3, omega3, r4, omega4, theta2, theta3, theta4, D):
    """The accelerations of B by the coupler and by the rocker have the same projection along the rocker."""
    return k3 * alpha2 + (
        r2 * omega2**2 * cos(theta2 - theta4) + r3 * omega3**2 * cos(theta4 - theta3) - r4 * omega4**2
    ) / (r3 * D)


@stable(lambda omega2, alpha2, _linkage: _linkage.rocker_gain * omega2**2 + _linkage.rocker_ratio * alpha2)
def alpha4(r2, omega2, k4, alpha2, r3, omega3, r4, omega4, theta2, theta3, theta4, D):
    """They have the same projection along the coupler."""
    return k4 * alpha2 + (
        r2 * omega2**2 * cos(theta2 - theta3) + r3 * omega3**2 - r4 * omega4**2 * cos(theta4 - theta3)
    ) / (r4 * D)


def a_G3_x(r2, omega2, alpha2, theta2, s3, r3, omega3, alpha3, theta3):
    """Acceleration of A, and the share s3 of that of B about A."""
    return -r2 * (alpha2 * sin(theta2) + omega2**2 * cos(theta2)) - s3 * r3 * (
        alpha3 * sin(theta3) + omega3**2 * cos(theta3)
    )


def a_G3_y(r2, omega2, alpha2, theta2, s3, r3, omega3, alpha3, theta3):
    return r2 * (alpha2 * cos(theta2) - omega2**2 * sin(theta2)) + s3 * r3 * (
        alpha3 * cos(theta3) - omega3**2 * sin(theta3)
    )


def a_G4_x(s4, r4, omega4, alpha4, theta4):
    """G4 moves on a circle about C."""
    return -s4 * r4 * (alpha4 * sin(theta4) + omega4**2 * cos(theta4))


def a_G4_y(s4, r4, omega4, alpha4, theta4):
    return s4 * r4 * (alpha4 * cos(theta4) - omega4**2 * sin(theta4))


def load(M, omega4):
    """The moment against the motion of the rocker; a rocker at rest is given none."""
    return _Loads(M_C=-M * np.sign(omega4))


def gravity(m2, m3, m4, s3, r3, theta3, s4, r4, theta4):
    """The weights; that of the balanced crank passes through O."""
    Y3, Y4 = -m3 * GRAVITY, -m4 * GRAVITY
    return _Loads(
        Y3=Y3,
        M_A=_moment(s3 * r3, theta3, 0.0, Y3),
        Y4=Y4,
        M_C=_moment(s4 * r4, theta4, 0.0, Y4),
        Y2=-m2 * GRAVITY,
    )


def inertia(
    m3, J3, s3, r3, theta3, m4, J4, s4, r4, theta4, J2, a_G3_x, a_G3_y, alpha3, a_G4_x, a_G4_y, alpha4, alpha2
):
    """The forces and couples of inertia, opposed to the accelerations."""
    X3, Y3 = -m3 * a_G3_x / 1000, -m3 * a_G3_y / 1000
    X4, Y4 = -m4 * a_G4_x / 1000, -m4 * a_G4_y / 1000
    return _Loads(
        X3=X3,
        Y3=Y3,
        M_A=_moment(s3 * r3, theta3, X3, Y3) - J3 * alpha3,
        X4=X4,
        Y4=Y4,
        M_C=_moment(s4 * r4, theta4, X4, Y4) - J4 * alpha4,
        M2=-J2 * alpha2,
    )


def _moment(arm, theta, X, Y):
    """Of a force at the end of an arm, N*m."""
    return arm * (Y * cos(theta) - X * sin(theta)) / 1000


def applied(inertia=_NONE, gravity=_NONE, load=_NONE):
    """The effects called for, added up."""
    return _Loads(*(a + b + c for a, b, c in zip(inertia, gravity, load, strict=True)))


@formula(r"-<m3> \times \frac{<a_G3_x>}{\num{1000}}")
def X3(applied):
    return applied.X3


@formula(r"-<m3> \times \left(\num{9.81} + \frac{<a_G3_y>}{\num{1000}}\right)")
def Y3(applied):
    return applied.Y3


@formula(
    r"\frac{<s3> \times <r3>}{\num{1000}} \times \left(<Y3> \times \cos <theta3> - <X3> \times \sin "
    r"<theta3>\right)"
    r" - <J3> \times <alpha3>"
)
def M_A(applied):
    """Moment about A of what acts on the coupler, without its joints."""
    return applied.M_A


@formula(r"-<m4> \times \frac{<a_G4_x>}{\num{1000}}")
def X4(applied):
    return applied.X4


@formula(r"-<m4> \times \left(\num{9.81} + \frac{<a_G4_y>}{\num{1000}}\right)")
def Y4(applied):
    return applied.Y4


@formula(
    r"\frac{<s4> \times <r4>}{\num{1000}} \times \left(<Y4> \times \cos <theta4> - <X4> \times \sin "
    r"<theta4>\right)"
    r" - <J4> \times <alpha4> - <M> \times \operatorname{sgn} <omega4>"
)
def M_C(applied):
    """Moment about C of what acts on the rocker, without its joints."""
    return applied.M_C


@formula(r"-<J2> \times <alpha2>")
def M2(applied):
    return applied.M2


@formula(r"-<m2> \times \num{9.81}")
def Y2(applied):
    return applied.Y2


def torque(r2, theta2, X3, Y3, M_A, k3, M_C, k4, M2):
    """No power in all, whatever the rate of the crank: the drive's is what the others take."""
    return -r2 * (Y3 * cos(theta2) - X3 * sin(theta2)) / 1000 - M_A * k3 - M_C * k4 - M2


def R_B_x(M_A, r3, theta3, M_C, r4, theta4, D):
    """Force of the coupler on the rocker: the coupler balances about A, the rocker about C."""
    return 1000 / D * (M_A / r3 * cos(theta4) + M_C / r4 * cos(theta3))


def R_B_y(M_A, r3, theta3, M_C, r4, theta4, D):
    return 1000 / D * (M_A / r3 * sin(theta4) + M_C / r4 * sin(theta3))


def R_B(R_B_x, R_B_y):
    return np.hypot(R_B_x, R_B_y)


def R_A_x(R_B_x, X3):
    """Force of the crank on the coupler."""
    return R_B_x - X3


def R_A_y(R_B_y, Y3):
    return R_B_y - Y3


def R_A(R_A_x, R_A_y):
    return np.hypot(R_A_x, R_A_y)


def R_C_x(R_B_x, X4):
    """Force of the frame on the rocker."""
    return -(R_B_x + X4)


def R_C_y(R_B_y, Y4):
    return -(R_B_y + Y4)


def R_C(R_C_x, R_C_y):
    return np.hypot(R_C_x, R_C_y)


def R_O_y(R_A_y, Y2):
    """Force of the frame on the balanced crank; along x it hands on what it bears at A."""
    return R_A_y - Y2


def R_O(R_A_x, R_O_y):
    return np.hypot(R_A_x, R_O_y)


@mistake("mode")
def other_mode(mode):
    return np.where(side_of(mode) > 0, "crossed", "open")


@mistake("load", kind="term_sign")
def moment_along_the_motion(load):
    return _Loads(M_C=-load.M_C)


@mistake("gravity")
def weights_forgotten():
    return _NONE


@mistake("inertia")
def inertia_forgotten():
    return _NONE


@mistake("inertia")
def inertia_sign(inertia):
    return _Loads(*(-part for part in inertia))


@mistake("J3", "J4")
def inertia_torques_forgotten():
    return 0.0, 0.0


@mistake("J2")
def crank_inertia_forgotten():
    return 0.0


@mistake("torque")
def resisting_moment_alone(M, k4, omega2):
    return M * abs(k4) * np.sign(omega2)


@mistake("torque", kind="sign")
def torque_of_the_other_bodies(torque):
    return -torque


@mistake("R_A")
def coupler_as_a_bar_of_two_forces(R_B):
    return R_B


@mistake("R_O")
def crank_weight_forgotten(R_A):
    return R_A


def polygons(r2, r3, r4, theta2, theta3, theta4, omega2, omega3, omega4, alpha2, alpha3, alpha4, s3):
    """With the centre of mass of the coupler, whose image divides ab as G3 divides AB."""
    OA, AB, CB = polar(r2, theta2), polar(r3, theta3), polar(r4, theta4)
    a_GA = s3 * (1j * alpha3 - omega3**2) * AB
    return (
        polygon_of_velocities(
            crank_v("A", "OA", OA, omega2), two_bars_v("B", "A", "C", AB, omega3, CB, omega4)
        ),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2, alpha2),
            two_bars_a("B", "A", "C", AB, omega3, alpha3, "r_3", CB, omega4, alpha4, "r_4"),
            (
                Side("a", "g_3", r"\vec{a}_{G_3/A}", a_GA, r"\parallel ab", r"s_3\,ab"),
                Side("p_a", "g_3", r"\vec{a}_{G_3}", (1j * alpha2 - omega2**2) * OA + a_GA),
            ),
        ),
    )


def motion(
    r1,
    r2,
    r3,
    r4,
    theta2,
    theta3,
    theta4,
    omega2,
    omega3,
    omega4,
    alpha2,
    alpha3,
    alpha4,
    s3,
    s4,
    a_G3_x,
    a_G3_y,
    a_G4_x,
    a_G4_y,
):
    """The two moving joints and the two centres of mass that move."""
    crank, coupler, rocker = polar(r2, theta2), polar(r3, theta3), polar(r4, theta4)
    v_A, v_B = 1j * omega2 * crank, 1j * omega4 * rocker
    return {
        "A": Moving(crank, v_A, (1j * alpha2 - omega2**2) * crank),
        "B": Moving(r1 + rocker, v_B, (1j * alpha4 - omega4**2) * rocker),
        "G_3": Moving(crank + s3 * coupler, v_A + 1j * omega3 * s3 * coupler, a_G3_x + 1j * a_G3_y),
        "G_4": Moving(r1 + s4 * rocker, s4 * v_B, a_G4_x + 1j * a_G4_y),
    }


def residual(
    r1,
    r2,
    r3,
    r4,
    theta2,
    omega2,
    alpha2,
    mode,
    m2,
    J2,
    s3,
    m3,
    J3,
    s4,
    m4,
    J4,
    M,
    theta3,
    theta4,
    omega3,
    omega4,
    alpha3,
    alpha4,
    torque,
    R_A,
    R_B,
    R_C,
    R_O,
    R_A_x,
    R_A_y,
    R_B_x,
    R_B_y,
    R_C_x,
    R_C_y,
    R_O_y,
):
    """The closed loop and its derivatives; each body by itself, its forces and its moments about its centre
    of mass."""

    def vector(length, theta):
        return length / 1000 * np.exp(1j * np.radians(theta))

    def moment(arm, force):
        return (np.conj(arm) * force).imag

    crank, coupler, rocker = vector(r2, theta2), vector(r3, theta3), vector(r4, theta4)
    v_A, v_B = 1j * omega2 * crank, 1j * omega4 * rocker
    a_A, a_B = (1j * alpha2 - omega2**2) * crank, (1j * alpha4 - omega4**2) * rocker
    turned = moment(r1 / 1000 - crank, coupler) / (r1 / 1000 * r3 / 1000)
    at_A, at_B, at_C = R_A_x + 1j * R_A_y, R_B_x + 1j * R_B_y, R_C_x + 1j * R_C_y
    at_O = R_A_x + 1j * R_O_y
    momentum_3, momentum_4 = m3 * ((1 - s3) * a_A + s3 * a_B), m4 * s4 * a_B
    forces = R_A + R_B + R_C + 9.81 * (m2 + m3 + m4) + abs(momentum_3) + abs(momentum_4)
    moments = forces * (r2 + r3 + r4) / 1000 + M + J2 * abs(alpha2) + J3 * abs(alpha3) + J4 * abs(alpha4)
    return (
        abs(crank + coupler - r1 / 1000 - rocker) / (r1 + r2 + r3 + r4) * 1000,
        np.maximum(np.where(mode == "open", -turned, turned), 0),
        abs(v_A + 1j * omega3 * coupler - v_B) / (abs(v_A) + abs(v_B)),
        abs(a_A + (1j * alpha3 - omega3**2) * coupler - a_B) / (abs(a_A) + abs(a_B)),
        abs(at_A - at_B - 9.81j * m3 - momentum_3) / forces,
        abs(at_B + at_C - 9.81j * m4 - momentum_4) / forces,
        abs(at_O - at_A - 9.81j * m2) / forces,
        abs(moment(-s3 * coupler, at_A) - moment((1 - s3) * coupler, at_B) - J3 * alpha3) / moments,
        abs(moment((1 - s4) * rocker, at_B) - moment(s4 * rocker, at_C) - M * np.sign(omega4) - J4 * alpha4)
        / moments,
        abs(torque - moment(crank, at_A) - J2 * alpha2) / moments,
        abs(R_A - abs(at_A)) / forces,
        abs(R_B - abs(at_B)) / forces,
        abs(R_C - abs(at_C)) / forces,
        abs(R_O - abs(at_O)) / forces,
    )


_UPRIGHT = {"r1": 300, "r2": 100, "r3": 300, "r4": 100, "theta2": 90, "mode": "open"}

KNOWN = (
    # An upright parallelogram: the coupler pulls the rocker along, by 2 kN over 0.1 m for 200 N*m.
    given(**_UPRIGHT, omega2=2, M=200)
    .under("load")
    .gives(torque=200, R_B_x=-2000, R_B_y=0, R_A=2000, R_C=2000, R_O=2000),
    # The other way round it pushes: the moment resists whichever way the rocker turns.
    given(**_UPRIGHT, omega2=-2, M=200).under("load").gives(torque=-200, R_B_x=2000, R_C=2000),
    # The crank on the frame, ABC a 3-4-5 triangle: the rocker turns back at 4/5 of the crank's rate.
    given(r1=90, r2=40, r3=40, r4=30, theta2=0, omega2=5, mode="open", M=15)
    .under("load")
    .gives(torque=12, R_B=500, R_A=500, R_C=500),
    # Upright: each pin of the coupler bears half of its weight, and the pivots their own bars besides.
    given(**_UPRIGHT, s3=0.5, m3=4, s4=0.5, m4=3, m2=5)
    .under("gravity")
    .gives(torque=0, R_A=19.62, R_B=19.62, R_C=49.05, R_O=68.67),
    # Crank and rocker at 60 degrees: the coupler's weight moves along x by 0.05 m per radian, the rocker's by
    # half.
    given(**_UPRIGHT | {"theta2": 60}, s3=0.5, m3=4, s4=0.5, m4=2, m2=5)
    .under("gravity")
    .gives(torque=2.4525, R_A_y=19.62, R_B_y=-19.62),
    # The coupler moves along with A, and needs no torque at a constant rate.
    given(**_UPRIGHT, omega2=10, s3=0.5, m3=4, J3=1, s4=0.5, m4=3, J4=1, J2=1)
    .under("inertia")
    .gives(torque=0, R_A=20, R_B=20, R_B_y=20, R_C=35, R_O=20),
    # Starting from rest: J2 + J4 + m4 (0.05 m)^2 + m3 (0.1 m)^2 = 0.0875 kg*m^2.
    given(**_UPRIGHT, omega2=0, alpha2=20, s3=0.5, m3=4, J3=1, s4=0.5, m4=3, J4=0.02, J2=0.02)
    .under("inertia")
    .gives(torque=1.75),
    # Nothing called for, nothing borne.
    given(**_UPRIGHT).under().gives(torque=0, R_A=0, R_B=0, R_C=0, R_O=0),
)
