"""Six links, two loops of pivots: solution. The first loop O-A-B-C, then the second one C-D-E-F.

Each loop is a four-bar linkage, driven by the crank and by the side CD of the plate: its triangle gives the
angles, and each of its derivatives, projected along one rod, gives the rate of the other. Values come from
the numeric core, which keeps their digits near dead points.
"""

import math
from math import pi

import numpy as np

from coursework.degrees import acos, angle, atan2, cos, from_radians, polar, sin, sqrt, wrap
from coursework.figures import Figure, ground_pivot, link, pin, vector
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    normal,
    polygon_of_accelerations,
    polygon_of_velocities,
    tangential,
    turning,
    two_bars_a,
    two_bars_v,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.dyads import side_of
from coursework.kinematics.four_bar import FourBar
from coursework.mechanics import Body, Mechanism
from coursework.solution import formula, given, mistake, stable

from ._first_four_bar import *

UNITS = {
    "AC": "mm",
    "phi_1": "deg",
    "psi_1": "deg",
    "side_1": "1",
    "theta5": "deg",
    "xD": "mm",
    "yD": "mm",
    "DF": "mm",
    "phi_2": "deg",
    "psi_2": "deg",
    "side_2": "1",
}
SYMBOLS = {
    "AC": "AC",
    "phi_1": r"\varphi_1",
    "psi_1": r"\psi_1",
    "side_1": r"\varepsilon_1",
    "DF": "DF",
    "phi_2": r"\varphi_2",
    "psi_2": r"\psi_2",
    "side_2": r"\varepsilon_2",
}
LOOPS = {
    "loop_1": (
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("xC", 0.0, -1),
        Vector("yC", pi / 2, -1),
        Vector("r4", "theta4", -1),
    ),
    "loop_2": (
        Vector("xC", 0.0),
        Vector("yC", pi / 2),
        Vector("r5", "theta4", turn="beta"),
        Vector("r6", "theta6"),
        Vector("xF", 0.0, -1),
        Vector("yF", pi / 2, -1),
        Vector("r7", "theta7", -1),
    ),
    "loop_3": (
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("r4", "theta4", -1),
        Vector("r5", "theta4", turn="beta"),
        Vector("r6", "theta6"),
        Vector("xF", 0.0, -1),
        Vector("yF", pi / 2, -1),
        Vector("r7", "theta7", -1),
    ),
}
MECHANISM = Mechanism(
    ground={"O": 0, "C": lambda xC, yC: xC + 1j * yC, "F": lambda xF, yF: xF + 1j * yF},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3"}),
        Body("4", "theta4", "C", {"B": "r4", "D": lambda r5, beta: polar(r5, beta)}),
        Body("6", "theta6", "D", {"E": "r6"}),
        Body("7", "theta7", "F", {"E": "r7"}),
    ),
)


def mobility():
    return 3 * 5 - 2 * 7


def cycles():
    return 7 - 6 + 1


def third_loop():
    """Loop 1 ends with C to O along the frame, loop 2 begins at C and ends with F to C: their sum passes C no
    more."""
    return "sum"


def _frame_1(xC, yC):
    """Direction of OC."""
    return atan2(yC, xC)


def _loop_1(xC, yC, r2, r3, r4, side_1, theta2, _frame_1):
    """The linkage O, A, B, C, its angles counted from OC."""
    return FourBar(abs(xC + 1j * yC), r2, r3, r4, side_1).at(Degrees.between(_frame_1, theta2))


def _frame_2(xC, yC, xF, yF):
    """Direction of CF."""
    return atan2(yF - yC, xF - xC)


def _loop_2(xC, yC, xF, yF, r5, r6, r7, side_2, theta5, _frame_2):
    """The linkage C, D, E, F, its angles counted from CF."""
    CF = abs(xF - xC + 1j * (yF - yC))
    return FourBar(CF, r5, r6, r7, side_2).at(Degrees.between(_frame_2, theta5))


def phi_1(xC, yC, r2, theta2):
    """Direction of AC."""
    return atan2(yC - r2 * sin(theta2), xC - r2 * cos(theta2))


@stable(lambda _loop_1: from_radians(_loop_1.corner))
def psi_1(r3, r4, AC):
    """Angle CAB, by the law of cosines."""
    return acos((AC**2 + r3**2 - r4**2) / (2 * AC * r3))


def side_1(mode_1):
    """+1 when B lies left of the line A -> C, -1 when right."""
    return side_of(mode_1)


@stable(lambda _loop_1, _frame_1: wrap(from_radians(_loop_1.coupler_angle) + _frame_1))
def theta3(phi_1, psi_1, side_1):
    return wrap(phi_1 + side_1 * psi_1)


@stable(lambda _loop_1, _frame_1: wrap(from_radians(_loop_1.rocker_angle) + _frame_1))
def theta4(xC, yC, r2, theta2, r3, theta3):
    """Direction of CB, by its quadrant."""
    return angle(polar(r2, theta2) + polar(r3, theta3) - (xC + 1j * yC))


def theta5(theta4, beta):
    """Direction of CD: the plate turns as one body."""
    return wrap(theta4 + beta)


def xD(xC, r5, theta5):
    return xC + r5 * cos(theta5)


def yD(yC, r5, theta5):
    return yC + r5 * sin(theta5)


def DF(xD, yD, xF, yF):
    return sqrt((xF - xD) ** 2 + (yF - yD) ** 2)


def phi_2(xD, yD, xF, yF):
    """Direction of DF."""
    return atan2(yF - yD, xF - xD)


@stable(lambda _loop_2: from_radians(_loop_2.corner))
def psi_2(r6, r7, DF):
    """Angle FDE, by the law of cosines."""
    return acos((DF**2 + r6**2 - r7**2) / (2 * DF * r6))


def side_2(mode_2):
    """+1 when E lies left of the line D -> F, -1 when right."""
    return side_of(mode_2)


@stable(lambda _loop_2, _frame_2: wrap(from_radians(_loop_2.coupler_angle) + _frame_2))
def theta6(phi_2, psi_2, side_2):
    return wrap(phi_2 + side_2 * psi_2)


@stable(lambda _loop_2, _frame_2: wrap(from_radians(_loop_2.rocker_angle) + _frame_2))
def theta7(xD, yD, r6, theta6, xF, yF):
    """Direction of FE, by its quadrant."""
    return atan2(yD + r6 * sin(theta6) - yF, xD + r6 * cos(theta6) - xF)


@stable(lambda omega4, _loop_2: _loop_2.coupler_ratio * omega4)
def omega6(r5, omega4, r6, theta5, theta6, theta7):
    """The plate turns at omega4, and drives the second loop as the crank drives the first."""
    return r5 * omega4 * sin(theta5 - theta7) / (r6 * sin(theta7 - theta6))


@stable(lambda omega4, _loop_2: _loop_2.rocker_ratio * omega4)
def omega7(r5, omega4, r7, theta5, theta6, theta7):
    return r5 * omega4 * sin(theta5 - theta6) / (r7 * sin(theta7 - theta6))


@stable(lambda omega2, _loop_1: _loop_1.coupler_gain * omega2**2)
def alpha3(r2, omega2, theta2, r3, omega3, theta3, r4, omega4, theta4):
    """The accelerations of B by the coupler and by the plate have the same projection along CB."""
    return (
        r2 * omega2**2 * cos(theta2 - theta4) + r3 * omega3**2 * cos(theta4 - theta3) - r4 * omega4**2
    ) / (r3 * sin(theta4 - theta3))


@formula(
    r"\frac{<r5> \times <alpha4> \times \sin\left(<theta5> - <theta7>\right)"
    r" + <r5> \times <omega4>^2 \times \cos\left(<theta5> - <theta7>\right)}"
    r"{<r6> \times \sin\left(<theta7> - <theta6>\right)}"
    r" + \frac{<r6> \times <omega6>^2 \times \cos\left(<theta7> - <theta6>\right) - <r7> \times <omega7>^2}"
    r"{<r6> \times \sin\left(<theta7> - <theta6>\right)}"
)
@stable(lambda omega4, alpha4, _loop_2: _loop_2.coupler_gain * omega4**2 + _loop_2.coupler_ratio * alpha4)
def alpha6(r5, omega4, alpha4, theta5, r6, omega6, theta6, r7, omega7, theta7):
    """The plate does not turn at a constant rate: alpha4 enters."""
    return (
        r5 * alpha4 * sin(theta5 - theta7)
        + r5 * omega4**2 * cos(theta5 - theta7)
        + r6 * omega6**2 * cos(theta7 - theta6)
        - r7 * omega7**2
    ) / (r6 * sin(theta7 - theta6))


@formula(
    r"\frac{<r5> \times <alpha4> \times \sin\left(<theta5> - <theta6>\right)"
    r" + <r5> \times <omega4>^2 \times \cos\left(<theta5> - <theta6>\right)}"
    r"{<r7> \times \sin\left(<theta7> - <theta6>\right)}"
    r" + \frac{<r6> \times <omega6>^2 - <r7> \times <omega7>^2 \times \cos\left(<theta7> - <theta6>\right)}"
    r"{<r7> \times \sin\left(<theta7> - <theta6>\right)}"
)
@stable(lambda omega4, alpha4, _loop_2: _loop_2.rocker_gain * omega4**2 + _loop_2.rocker_ratio * alpha4)
def alpha7(r5, omega4, alpha4, theta5, r6, omega6, theta6, r7, omega7, theta7):
    return (
        r5 * alpha4 * sin(theta5 - theta6)
        + r5 * omega4**2 * cos(theta5 - theta6)
        + r6 * omega6**2
        - r7 * omega7**2 * cos(theta7 - theta6)
    ) / (r7 * sin(theta7 - theta6))


@mistake("mobility")
def frame_counted():
    return 3 * 6 - 2 * 7


@mistake("mobility")
def plate_as_two_bars():
    return 3 * 6 - 2 * 8


@mistake("cycles")
def notes_N_without_frame():
    return 7 - 5 + 1


@mistake("cycles", kind="count")
def joint_count_minus():
    return 7 - 6


@mistake("third_loop")
def third_loop_counted_as_new():
    """As the notes do."""
    return "new"


@mistake("third_loop")
def third_loop_as_difference():
    return "difference"


@mistake("loop_3_x")
def plate_side_CB_forgotten():
    """From B to D as from C to D."""
    return "r2*cos(theta2) + r3*cos(theta3) + r5*cos(theta4 + beta) + r6*cos(theta6) = xF + r7*cos(theta7)"


@mistake("loop_1_x", "loop_1_y", kind="link_sign")
def coupler_reversed():
    return (
        "r2*cos(theta2) - r3*cos(theta3) = xC + r4*cos(theta4)",
        "r2*sin(theta2) - r3*sin(theta3) = yC + r4*sin(theta4)",
    )


@mistake("loop_1_x", "loop_1_y", "loop_2_x", "loop_2_y")
def frame_left_out():
    return (
        "r2*cos(theta2) + r3*cos(theta3) = r4*cos(theta4)",
        "r2*sin(theta2) + r3*sin(theta3) = r4*sin(theta4)",
        "r5*cos(theta4 + beta) + r6*cos(theta6) = r7*cos(theta7)",
        "r5*sin(theta4 + beta) + r6*sin(theta6) = r7*sin(theta7)",
    )


@mistake("loop_2_x", "loop_2_y")
def frame_from_O_to_F():
    return (
        "r5*cos(theta4 + beta) + r6*cos(theta6) = xF + r7*cos(theta7)",
        "r5*sin(theta4 + beta) + r6*sin(theta6) = yF + r7*sin(theta7)",
    )


@mistake("beta", "loop_2_x", "loop_2_y")
def beta_forgotten():
    return (
        0.0,
        "xC + r5*cos(theta4) + r6*cos(theta6) = xF + r7*cos(theta7)",
        "yC + r5*sin(theta4) + r6*sin(theta6) = yF + r7*sin(theta7)",
    )


@mistake("beta", "loop_2_x", "loop_2_y", kind="sign")
def beta_sign(beta):
    return (
        -beta,
        "xC + r5*cos(theta4 - beta) + r6*cos(theta6) = xF + r7*cos(theta7)",
        "yC + r5*sin(theta4 - beta) + r6*sin(theta6) = yF + r7*sin(theta7)",
    )


@mistake("r5", "loop_2_x", "loop_2_y")
def r4_for_r5(r4):
    return (
        r4,
        "xC + r4*cos(theta4 + beta) + r6*cos(theta6) = xF + r7*cos(theta7)",
        "yC + r4*sin(theta4 + beta) + r6*sin(theta6) = yF + r7*sin(theta7)",
    )


@mistake("side_1")
def mode_1_other(side_1):
    return -side_1


@mistake("side_2")
def mode_2_other(side_2):
    return -side_2


@mistake("omega6", "omega7", kind="sign")
def omega6_sign(omega6, omega7):
    return -omega6, -omega7


@mistake("omega3", "omega4", kind="sign")
def omega3_sign(omega3, omega4):
    return -omega3, -omega4


@mistake("omega6", "omega7")
def input_w2_in_loop_2(omega2, omega4, omega6, omega7):
    return omega6 * omega2 / omega4, omega7 * omega2 / omega4


@mistake("alpha3", "alpha4")
def no_normal_terms():
    return 0.0, 0.0


@mistake("alpha6", "alpha7")
def alpha4_left_out_loop2(omega4, alpha4, omega6, omega7, alpha6, alpha7):
    return alpha6 - omega6 / omega4 * alpha4, alpha7 - omega7 / omega4 * alpha4


def polygons(
    r2,
    r3,
    r4,
    r5,
    r6,
    r7,
    theta2,
    theta3,
    theta4,
    theta5,
    theta6,
    theta7,
    omega2,
    omega3,
    omega4,
    omega6,
    omega7,
    alpha3,
    alpha4,
    alpha6,
    alpha7,
):
    """Two bars meet at B; D turns with B about C; two bars meet at E."""
    OA, AB, CB, CD = polar(r2, theta2), polar(r3, theta3), polar(r4, theta4), polar(r5, theta5)
    DE, FE = polar(r6, theta6), polar(r7, theta7)
    return (
        polygon_of_velocities(
            crank_v("A", "OA", OA, omega2),
            two_bars_v("B", "A", "C", AB, omega3, CB, omega4),
            (turning("p_v", "d", "D", "CD", CD, omega4, "r_5 V_B / r_4"),),
            two_bars_v("E", "D", "F", DE, omega6, FE, omega7),
        ),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2),
            two_bars_a("B", "A", "C", AB, omega3, alpha3, "r_3", CB, omega4, alpha4, "r_4"),
            (
                normal("p_a", "d'", "D", "CD", CD, omega4, "V_D^2 / r_5"),
                tangential("d'", "d", "D", "CD", CD, alpha4, "r_5 a_B^t / r_4"),
            ),
            two_bars_a("E", "D", "F", DE, omega6, alpha6, "r_6", FE, omega7, alpha7, "r_7"),
        ),
    )


def figure(xC, yC, xF, yF, r2, theta2, omega2, r4, theta4, omega4, r5, theta5, r7, theta7, omega7):
    """The velocities of the pins that move on circles about the frame's, at one scale."""
    O, C, F = 0j, complex(xC, yC), complex(xF, yF)
    A, B, D, E = polar(r2, theta2), C + polar(r4, theta4), C + polar(r5, theta5), F + polar(r7, theta7)
    moving = (
        ("A", A, 1j * omega2 * A),
        ("B", B, 1j * omega4 * (B - C)),
        ("D", D, 1j * omega4 * (D - C)),
        ("E", E, 1j * omega7 * (E - F)),
    )
    scale = 0.3 * xC / max(*(abs(velocity) for _, _, velocity in moving), 1e-9 * abs(xC))
    return Figure(
        link(O, A),
        link(A, B),
        link(C, B, D),
        link(D, E),
        link(F, E),
        *(vector(at, scale * velocity, f"v_{name}") for name, at, velocity in moving),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        ground_pivot(F, "F"),
        *(pin(at, name) for name, at, _ in moving),
        paper_mm=(108, 54),
    )


def residual(
    xC,
    yC,
    xF,
    yF,
    r2,
    r3,
    r4,
    r5,
    beta,
    r6,
    r7,
    theta2,
    omega2,
    mode_1,
    mode_2,
    theta3,
    theta4,
    theta6,
    theta7,
    omega3,
    omega4,
    omega6,
    omega7,
    alpha3,
    alpha4,
    alpha6,
    alpha7,
):
    """Both loop closures and their two derivatives, as complex equations, and the sides of B and E."""
    C, F = xC + 1j * yC, xF + 1j * yF
    crank, AB, CB, CD, DE, FE = (
        length * np.exp(1j * np.radians(theta))
        for length, theta in (
            (r2, theta2),
            (r3, theta3),
            (r4, theta4),
            (r5, theta4 + beta),
            (r6, theta6),
            (r7, theta7),
        )
    )

    def gaps(chain):
        """A closed chain of (vector, rate, acceleration): its derivatives over the sizes of their terms."""
        velocities = [1j * rate * v for v, rate, _ in chain]
        accelerations = [(1j * alpha - rate**2) * v for v, rate, alpha in chain]
        return [
            abs(sum(terms)) / sum(abs(t) for t in terms)
            for terms in ([v for v, _, _ in chain], velocities, accelerations)
        ]

    def wrong_side(mode, line, rod):
        turned = (np.conj(line) * rod).imag / abs(line * rod)
        return np.maximum(np.where(mode == "open", -turned, turned), 0)

    zero = 0 * omega2
    first = [(crank, omega2, zero), (AB, omega3, alpha3), (-CB, omega4, alpha4), (-C, zero, zero)]
    second = [(CD, omega4, alpha4), (DE, omega6, alpha6), (-FE, omega7, alpha7), (C - F, zero, zero)]
    return (
        *gaps(first),
        *gaps(second),
        wrong_side(mode_1, C - crank, AB),
        wrong_side(mode_2, F - C - CD, DE),
    )


KNOWN = (
    # Both loops are 3-4-5 triangles over a driver in line with its frame: there the two rods turn alike.
    # A = (30, 0) and B = (62, 24), C = (80, 0); D = (60, 0) and E = (42, 24), F = (10, 0).
    given(
        xC=80,
        yC=0,
        xF=10,
        yF=0,
        r2=30,
        r3=40,
        r4=30,
        r5=20,
        beta=180 - math.degrees(math.atan2(4, -3)),
        r6=30,
        r7=40,
        theta2=0,
        omega2=5,
        mode_1="open",
        mode_2="crossed",
    ).gives(
        mobility=1,
        cycles=2,
        theta3="36.8699",
        theta4="126.8699",
        theta6="126.8699",
        theta7="36.8699",
        omega3=-3,
        omega4=-3,
        omega6=1.2,
        omega7=1.2,
        alpha3=-18,
        alpha4=32,
        alpha6=-6.08,
        alpha7=-16.58,
    ),
    # Two parallelograms: the plate and the second rocker turn as the crank does, the rods do not turn.
    given(
        xC=60,
        yC=80,
        xF=180,
        yF=30,
        r2=40,
        r3=100,
        r4=40,
        r5=30,
        beta=40,
        r6=130,
        r7=30,
        theta2=20,
        omega2=-6,
        mode_1="crossed",
        mode_2="open",
    ).gives(
        theta3="53.1301",
        theta4=20,
        theta6="-22.6199",
        theta7=60,
        omega3=0,
        omega4=-6,
        omega6=0,
        omega7=-6,
        alpha3=0,
        alpha4=0,
        alpha6=0,
        alpha7=0,
    ),
)
