"""Shaper of three loops: solution. Four bars O-A-B-C, then the bar that the block E swings, then the ram.

Each loop is solved with what the one before gives. The first is a four-bar linkage, whose values come from
the numeric core; in the second, the block's motion is projected along the bar and across it; the third
is a slider-crank of crank DF.
"""

import math
from math import pi

import numpy as np

from coursework.degrees import acos, angle, atan, atan2, cos, from_radians, polar, sin, sqrt, tan, wrap
from coursework.figures import Figure, ground_pivot, link, pin, rail, slider, vector
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    guide_a,
    guide_v,
    normal,
    polygon_of_accelerations,
    polygon_of_velocities,
    slider_a,
    slider_v,
    tangential,
    turning,
    two_bars_a,
    two_bars_v,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.dyads import rrp, side_of
from coursework.kinematics.four_bar import FourBar
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import formula, given, mistake, stable

from ._first_four_bar import *

UNITS = {
    "AC": "mm",
    "phi": "deg",
    "psi": "deg",
    "side": "1",
    "theta6": "deg",
    "p5": "mm",
    "q5": "mm",
    "p7": "mm",
    "q7": "mm",
}
SYMBOLS = {
    "AC": "AC",
    "phi": r"\varphi",
    "psi": r"\psi",
    "side": r"\varepsilon",
    "p5": "p_5",
    "q5": "q_5",
    "p7": "p_7",
    "q7": "q_7",
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
        Vector("r2", "theta2"),
        Vector("r6", "theta3", turn="beta"),
        Vector("xD", 0.0, -1),
        Vector("yD", pi / 2, -1),
        Vector("d5", "theta5", -1),
    ),
    "loop_3": (
        Vector("xD", 0.0),
        Vector("yD", pi / 2),
        Vector("r5", "theta5"),
        Vector("r7", "theta7"),
        Vector("x8", 0.0, -1),
        Vector("d3", pi / 2, -1),
    ),
    "loop_4": (
        Vector("r2", "theta2"),
        Vector("r6", "theta3", turn="beta"),
        Vector("r5", "theta5"),
        Vector("d5", "theta5", -1),
        Vector("r7", "theta7"),
        Vector("x8", 0.0, -1),
        Vector("d3", pi / 2, -1),
    ),
}
MECHANISM = Mechanism(
    ground={"O": 0, "C": lambda xC, yC: xC + 1j * yC, "D": lambda xD, yD: xD + 1j * yD},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3", "E": lambda r6, beta: polar(r6, beta)}),
        Body("4", "theta4", "C", {"B": "r4"}),
        Body("5", "theta5", "D", {"F": "r5"}),
        Body("6", "theta5", "E"),
        Body("7", "theta7", "F", {"G": "r7"}),
        Body("8", 0, "G"),
    ),
    slides=(Slide("E", "6", on="5"), Slide("G", "8")),
)


def w():
    """Seven moving bodies; eight revolute joints, at O, A, B, C, D, E, F, G, and two slides, at E and G."""
    return 3 * 7 - 2 * 10


def gamma():
    """Ten pairs, eight bodies with the frame."""
    return 10 - 8 + 1


def _frame(xC, yC):
    """Direction of OC."""
    return atan2(yC, xC)


def _loop_1(xC, yC, r2, r3, r4, side, theta2, _frame):
    """The linkage O, A, B, C, its angles counted from OC."""
    return FourBar(abs(xC + 1j * yC), r2, r3, r4, side).at(Degrees.between(_frame, theta2))


def phi(xC, yC, r2, theta2):
    """Direction of AC."""
    return atan2(yC - r2 * sin(theta2), xC - r2 * cos(theta2))


@stable(lambda _loop_1: from_radians(_loop_1.corner))
def psi(r3, r4, AC):
    """Angle CAB, by the law of cosines."""
    return acos((AC**2 + r3**2 - r4**2) / (2 * AC * r3))


def side(mode):
    """+1 when B lies left of the line A -> C, -1 when right."""
    return side_of(mode)


@stable(lambda _loop_1, _frame: wrap(from_radians(_loop_1.coupler_angle) + _frame))
def theta3(phi, psi, side):
    return wrap(phi + side * psi)


@stable(lambda _loop_1, _frame: wrap(from_radians(_loop_1.rocker_angle) + _frame))
def theta4(xC, yC, r2, theta2, r3, theta3):
    """Direction of CB, by its quadrant."""
    return angle(polar(r2, theta2) + polar(r3, theta3) - (xC + 1j * yC))


def theta6(theta3, beta):
    """Direction of AE: the coupler turns as one body."""
    return wrap(theta3 + beta)


def p5(xD, r2, theta2, r6, theta6):
    """Component of DE along x."""
    return r2 * cos(theta2) + r6 * cos(theta6) - xD


def q5(yD, r2, theta2, r6, theta6):
    """Component of DE along y."""
    return r2 * sin(theta2) + r6 * sin(theta6) - yD


def theta5(p5, q5):
    """Direction of DE, by its quadrant."""
    return atan2(q5, p5)


def d5(p5, q5):
    """Distance DE; whether the bar is as long is for the designer to see."""
    return sqrt(p5**2 + q5**2)


def p7(yD, r5, theta5, d3):
    """Height of G above F."""
    return d3 - yD - r5 * sin(theta5)


@stable(lambda r7, p7: np.real(rrp(0j, r7, p7)))
def q7(r7, p7):
    """Distance of G to the right of F: r7 cos theta7, positive."""
    return sqrt(r7**2 - p7**2)


@formula(r"\arcsin \frac{<p7>}{<r7>}")
@stable(lambda p7, q7: atan2(p7, q7))
def theta7(r7, p7):
    """Direction of FG, to the right: between -90 and 90 degrees."""
    return atan2(p7, sqrt(r7**2 - p7**2))


@stable(lambda xD, r5, theta5, q7: xD + r5 * cos(theta5) + q7)
def x8(xD, r5, theta5, r7, theta7):
    return xD + r5 * cos(theta5) + r7 * cos(theta7)


def omega5(r2, omega2, theta2, r6, omega3, theta6, d5, theta5):
    """Component of the velocity of E across the bar, over its distance from D."""
    return (r2 * omega2 * cos(theta2 - theta5) + r6 * omega3 * cos(theta6 - theta5)) / d5


def _from_D(xD, yD, r2, theta2, theta5):
    """DA turned back by theta5: its parts along the bar and across it."""
    x, y = r2 * cos(theta2) - xD, r2 * sin(theta2) - yD
    return x * cos(theta5) + y * sin(theta5), y * cos(theta5) - x * sin(theta5)


def _across(_from_D, r6, theta5, theta6):
    """r6 sin(theta6 - theta5), by the other side of the triangle where AE is far longer and nearly on the
    bar."""
    return np.where(r6 > 10 * np.hypot(*_from_D), -_from_D[1], r6 * sin(theta6 - theta5))[()]


@stable(
    lambda r2, omega2, theta2, omega3, theta5, _across: -r2 * omega2 * sin(theta2 - theta5) - omega3 * _across
)
def d5_dot(r2, omega2, theta2, r6, omega3, theta6, theta5):
    """Component of the velocity of E along the bar."""
    return -r2 * omega2 * sin(theta2 - theta5) - r6 * omega3 * sin(theta6 - theta5)


def omega7(r5, omega5, theta5, r7, theta7):
    """The ram keeps to its line: no velocity across it."""
    return -r5 * omega5 * cos(theta5) / (r7 * cos(theta7))


def x8_dot(r5, omega5, theta5, r7, omega7, theta7):
    return -r5 * omega5 * sin(theta5) - r7 * omega7 * sin(theta7)


@stable(lambda omega2, _loop_1: _loop_1.coupler_gain * omega2**2)
def alpha3(r2, omega2, theta2, r3, omega3, theta3, r4, omega4, theta4):
    """The accelerations of B by the coupler and by the rocker have the same projection along the rocker."""
    return (
        r2 * omega2**2 * cos(theta2 - theta4) + r3 * omega3**2 * cos(theta4 - theta3) - r4 * omega4**2
    ) / (r3 * sin(theta4 - theta3))


@formula(
    r"\frac{<r6> \times <alpha3> \times \cos\left(<theta6> - <theta5>\right)"
    r" - <r2> \times <omega2>^2 \times \sin\left(<theta2> - <theta5>\right)}{<d5>}"
    r" - \frac{<r6> \times <omega3>^2 \times \sin\left(<theta6> - <theta5>\right)"
    r" + 2 \times <d5_dot> \times <omega5>}{<d5>}"
)
def alpha5(r2, omega2, theta2, r6, omega3, alpha3, theta6, d5, d5_dot, omega5, theta5):
    """Component of the acceleration of E across the bar, less the Coriolis term."""
    return (
        r6 * alpha3 * cos(theta6 - theta5)
        - r2 * omega2**2 * sin(theta2 - theta5)
        - r6 * omega3**2 * sin(theta6 - theta5)
        - 2 * d5_dot * omega5
    ) / d5


def _inward(_from_D, r2, omega2, theta2, r6, omega3, theta6, d5, omega5, theta5):
    """d5 omega5^2 - r6 omega3^2 cos(theta6 - theta5), without the difference of two long lengths."""
    along, _ = _from_D
    faster = r2 * omega2 * cos(theta2 - theta5) - omega3 * along  # d5 (omega5 - omega3)
    together = (omega5 + omega3) * faster + omega3**2 * along
    apart = d5 * omega5**2 - r6 * omega3**2 * cos(theta6 - theta5)
    return np.where(r6 > 10 * np.hypot(*_from_D), together, apart)[()]


@stable(
    lambda r2, omega2, theta2, alpha3, theta5, _across, _inward: (
        _inward - r2 * omega2**2 * cos(theta2 - theta5) - alpha3 * _across
    )
)
def d5_ddot(r2, omega2, theta2, r6, omega3, alpha3, theta6, d5, omega5, theta5):
    """Component of the acceleration of E along the bar, less the centripetal term."""
    return (
        d5 * omega5**2
        - r2 * omega2**2 * cos(theta2 - theta5)
        - r6 * alpha3 * sin(theta6 - theta5)
        - r6 * omega3**2 * cos(theta6 - theta5)
    )


def alpha7(r5, omega5, alpha5, theta5, r7, omega7, theta7):
    """No acceleration across the line either."""
    return (r5 * omega5**2 * sin(theta5) - r5 * alpha5 * cos(theta5) + r7 * omega7**2 * sin(theta7)) / (
        r7 * cos(theta7)
    )


def x8_ddot(r5, omega5, alpha5, theta5, r7, omega7, alpha7, theta7):
    return (
        -r5 * alpha5 * sin(theta5)
        - r5 * omega5**2 * cos(theta5)
        - r7 * alpha7 * sin(theta7)
        - r7 * omega7**2 * cos(theta7)
    )


@mistake("w", "gamma")
def slides_left_out():
    return 3 * 7 - 2 * 8, 8 - 8 + 1


@mistake("w")
def block_left_out():
    """As if the coupler slid on the bar by its pin alone: one body and one joint less."""
    return 3 * 6 - 2 * 9


@mistake("w")
def frame_counted():
    return 3 * 8 - 2 * 10


@mistake("w", "gamma")
def one_joint_of_the_block():
    """Of pivot and slide at E only one."""
    return 3 * 7 - 2 * 9, 9 - 8 + 1


@mistake("gamma", kind="count")
def N_without_frame():
    return 10 - 7 + 1


@mistake("gamma", kind="count")
def joint_count_minus():
    return 10 - 8


@mistake("loop_1_x", "loop_1_y", kind="link_sign")
def coupler_reversed():
    return (
        "r2*cos(theta2) - r3*cos(theta3) = xC + r4*cos(theta4)",
        "r2*sin(theta2) - r3*sin(theta3) = yC + r4*sin(theta4)",
    )


@mistake("loop_1_x", "loop_1_y", "loop_2_x", "loop_2_y", "loop_3_x", "loop_3_y")
def frame_left_out():
    return (
        "r2*cos(theta2) + r3*cos(theta3) = r4*cos(theta4)",
        "r2*sin(theta2) + r3*sin(theta3) = r4*sin(theta4)",
        "r2*cos(theta2) + r6*cos(theta3 + beta) = d5*cos(theta5)",
        "r2*sin(theta2) + r6*sin(theta3 + beta) = d5*sin(theta5)",
        "r5*cos(theta5) + r7*cos(theta7) = x8",
        "r5*sin(theta5) + r7*sin(theta7) = d3",
    )


@mistake("loop_2_x", "loop_2_y", "loop_3_x", "loop_3_y")
def whole_bar_for_DE():
    return (
        "r2*cos(theta2) + r6*cos(theta3 + beta) = xD + r5*cos(theta5)",
        "r2*sin(theta2) + r6*sin(theta3 + beta) = yD + r5*sin(theta5)",
        "xD + d5*cos(theta5) + r7*cos(theta7) = x8",
        "yD + d5*sin(theta5) + r7*sin(theta7) = d3",
    )


@mistake("beta", "loop_2_x", "loop_2_y")
def beta_forgotten():
    return (
        0.0,
        "r2*cos(theta2) + r6*cos(theta3) = xD + d5*cos(theta5)",
        "r2*sin(theta2) + r6*sin(theta3) = yD + d5*sin(theta5)",
    )


@mistake("beta", "loop_2_x", "loop_2_y", kind="sign")
def beta_sign(beta):
    return (
        -beta,
        "r2*cos(theta2) + r6*cos(theta3 - beta) = xD + d5*cos(theta5)",
        "r2*sin(theta2) + r6*sin(theta3 - beta) = yD + d5*sin(theta5)",
    )


@mistake("r6", "loop_2_x", "loop_2_y")
def r6_is_r5(r5):
    return (
        r5,
        "r2*cos(theta2) + r5*cos(theta3 + beta) = xD + d5*cos(theta5)",
        "r2*sin(theta2) + r5*sin(theta3 + beta) = yD + d5*sin(theta5)",
    )


@mistake("yC", "loop_1_y", kind="sign")
def alpha_sign(yC):
    return -yC, "r2*sin(theta2) + r3*sin(theta3) = r4*sin(theta4) - yC"


@mistake("yD", "loop_2_y", "loop_3_y", kind="sign")
def D_sign(yD):
    return (
        -yD,
        "r2*sin(theta2) + r6*sin(theta3 + beta) = d5*sin(theta5) - yD",
        "r5*sin(theta5) + r7*sin(theta7) - yD = d3",
    )


@mistake("side")
def other_mode(side):
    return -side


@mistake("theta5", kind="quadrant")
def arctan_no_quadrant(theta5):
    return atan(tan(theta5))


@mistake("theta7", kind="sign")
def theta7_sign(theta7):
    return -theta7


@mistake("omega3", "omega4", kind="sign")
def signs_of_omegas(omega3, omega4):
    return -omega3, -omega4


@mistake("d5_dot", kind="sign")
def d5_dot_sign(d5_dot):
    return -d5_dot


@mistake("omega7", kind="sign")
def omega7_sign(omega7):
    return -omega7


@mistake("x8_dot")
def x8_rod_left_out(r5, omega5, theta5):
    return -r5 * omega5 * sin(theta5)


@mistake("alpha3", "alpha4")
def no_normal_terms():
    return 0.0, 0.0


@mistake("alpha5")
def no_coriolis(alpha5, d5, d5_dot, omega5):
    return alpha5 + 2 * d5_dot * omega5 / d5


@mistake("d5_ddot")
def no_centripetal(d5_ddot, d5, omega5):
    return d5_ddot - d5 * omega5**2


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
    d5,
    omega2,
    omega3,
    omega4,
    omega5,
    d5_dot,
    omega7,
    x8_dot,
    alpha3,
    alpha4,
    alpha5,
    d5_ddot,
    alpha7,
    x8_ddot,
):
    """Two bars meet at B; E turns with B about A, and slides on the bar, whose point under it is E_5; the
    bar's end F carries the rod of the ram."""
    OA, AB, CB, AE = polar(r2, theta2), polar(r3, theta3), polar(r4, theta4), polar(r6, theta6)
    DE, DF, FG = polar(d5, theta5), polar(r5, theta5), polar(r7, theta7)
    return (
        polygon_of_velocities(
            crank_v("A", "OA", OA, omega2),
            two_bars_v("B", "A", "C", AB, omega3, CB, omega4),
            (turning("a", "e", "E/A", "AE", AE, omega3, "r_6 V_{B/A} / r_3"),),
            guide_v("E", "E_5", "DE", DE, omega5, d5_dot),
            (turning("p_v", "f", "F", "DF", DF, omega5, "r_5 V_{E_5} / d_5"),),
            slider_v("G", "F", FG, omega7, x8_dot),
        ),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2),
            two_bars_a("B", "A", "C", AB, omega3, alpha3, "r_3", CB, omega4, alpha4, "r_4"),
            (
                normal("a", "e'", "E/A", "AE", AE, omega3, "V_{E/A}^2 / r_6"),
                tangential("e'", "e", "E/A", "AE", AE, alpha3, "r_6 a_{B/A}^t / r_3"),
            ),
            guide_a("E", "E_5", "DE", DE, omega5, alpha5, d5_dot, d5_ddot, "d_5", r"\omega_5"),
            (
                normal("p_a", "f'", "F", "DF", DF, omega5, "V_F^2 / r_5"),
                tangential("f'", "f", "F", "DF", DF, alpha5, "r_5 a_{E_5}^t / d_5"),
            ),
            slider_a("G", "F", FG, omega7, alpha7, "r_7", x8_ddot),
        ),
    )


def figure(xC, yC, xD, yD, r2, theta2, omega2, r3, theta3, r5, theta5, omega5, r6, theta6, x8, x8_dot, d3):
    """The velocities of A, F and G, at one scale."""
    O, C, D, G = 0j, complex(xC, yC), complex(xD, yD), complex(x8, d3)
    A, F = polar(r2, theta2), D + polar(r5, theta5)
    B, E = A + polar(r3, theta3), A + polar(r6, theta6)
    moving = (("A", A, 1j * omega2 * A), ("F", F, 1j * omega5 * (F - D)), ("G", G, complex(x8_dot)))
    scale = 0.35 * abs(C) / max(*(abs(velocity) for _, _, velocity in moving), 1e-9 * abs(C))
    half_rail = 0.25 * abs(C)
    return Figure(
        rail(G - half_rail, G + half_rail),
        link(D, F),
        link(O, A),
        link(A, B, E),
        link(C, B),
        slider(E, theta5),
        link(F, G),
        slider(G),
        *(vector(at, scale * velocity, f"v_{name}") for name, at, velocity in moving),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        ground_pivot(D, "D"),
        *(pin(at, name) for name, at in (("A", A), ("B", B), ("E", E), ("F", F), ("G", G))),
        paper_mm=(108, 70),
    )


def residual(
    xC,
    yC,
    xD,
    yD,
    r2,
    r3,
    r4,
    r5,
    r6,
    beta,
    r7,
    d3,
    theta2,
    omega2,
    mode,
    theta3,
    theta4,
    theta5,
    d5,
    theta7,
    x8,
    omega3,
    omega4,
    omega5,
    d5_dot,
    omega7,
    x8_dot,
    alpha3,
    alpha4,
    alpha5,
    d5_ddot,
    alpha7,
    x8_ddot,
):
    """The three loop closures and their two derivatives, as complex equations, and the sides of B, E and
    G."""
    C, D, zero = xC + 1j * yC, xD + 1j * yD, 0 * omega2
    unit = {
        n: np.exp(1j * np.radians(v))
        for n, v in ((2, theta2), (3, theta3), (4, theta4), (5, theta5), (6, theta3 + beta), (7, theta7))
    }

    def bar(length, n, rate, acceleration):
        vector = length * unit[n]
        return vector, 1j * rate * vector, (1j * acceleration - rate**2) * vector

    crank, fixed = bar(r2, 2, omega2, zero), (zero, zero)
    guided = (
        d5 * unit[5],
        (d5_dot + 1j * d5 * omega5) * unit[5],
        (d5_ddot - d5 * omega5**2 + 1j * (d5 * alpha5 + 2 * d5_dot * omega5)) * unit[5],
    )
    loops = (
        (crank, bar(r3, 3, omega3, alpha3), bar(-r4, 4, omega4, alpha4), (-C, *fixed)),
        (crank, bar(r6, 6, omega3, alpha3), tuple(-x for x in guided), (-D, *fixed)),
        (
            (D, *fixed),
            bar(r5, 5, omega5, alpha5),
            bar(r7, 7, omega7, alpha7),
            (-(x8 + 1j * d3), -x8_dot, -x8_ddot),
        ),
    )
    gaps = [
        abs(sum(terms)) / sum(abs(term) for term in terms)
        for loop in loops
        for terms in zip(*loop, strict=True)
    ]
    turned = (np.conj(C - crank[0]) * unit[3]).imag / abs(C - crank[0])
    wrong_side = np.maximum(np.where(mode == "open", -turned, turned), 0)
    return (*gaps, wrong_side, np.maximum(-unit[7].real, 0), np.maximum(-d5 / r5, 0))


def _degrees_of(y, x):
    return math.degrees(math.atan2(y, x))


KNOWN = (
    # O-A-B-C a parallelogram: the coupler translates with A. E = (0, 100), DE = (75, 100), DF its double.
    given(
        xC=100,
        yC=0,
        xD=-75,
        yD=0,
        r2=40,
        r3=100,
        r4=40,
        r5=250,
        r6=60,
        beta=90,
        r7=130,
        d3=150,
        theta2=90,
        omega2=5,
        mode="open",
    ).gives(
        theta3=0,
        theta4=90,
        theta5=_degrees_of(4, 3),
        d5=125,
        theta7=_degrees_of(-5, 12),
        x8=195,
        omega3=0,
        omega4=5,
        omega5=1.28,
        d5_dot=-120,
        omega7=-1.6,
        x8_dot=-336,
        alpha3=0,
        alpha4=0,
        alpha5=-2.3424,
        d5_ddot=-595.2,
        alpha7=4.592,
        x8_ddot=145.12,
    ),
    # Crank along OC, ABC a 3-4-5 triangle; AE and the bar upright, E = (30, 50), F = (30, 130).
    given(
        xC=80,
        yC=0,
        xD=30,
        yD=-50,
        r2=30,
        r3=40,
        r4=30,
        r5=180,
        r6=50,
        beta=_degrees_of(4, 3),
        r7=100,
        d3=190,
        theta2=0,
        omega2=5,
        mode="open",
    ).gives(
        theta3=_degrees_of(3, 4),
        theta4=_degrees_of(4, -3),
        theta5=90,
        d5=100,
        theta7=_degrees_of(3, 4),
        x8=110,
        omega3=-3,
        omega4=-3,
        omega5=-1.5,
        d5_dot=150,
        omega7=0,
        x8_dot=270,
        alpha3=-18,
        alpha4=32,
        alpha5=3,
        d5_ddot=-225,
        alpha7=5.0625,
        x8_ddot=-843.75,
    ),
)
