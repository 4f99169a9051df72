"""Quick return with crank and rocker: solution.

The angle OAB fixes the distance OB; two triangles then give B and A, each on its stated side. The
rates follow from the two loops O-A-B-D and D-B-C. Over the turn, C turns back where its velocity
vanishes: where crank and coupler are in line, and wherever the rod would line up with the rocker.
"""

import math

import numpy as np

from coursework.degrees import acos, atan2, cos, from_radians, polar, sin, sqrt, wrap
from coursework.errors import CannotAssemble, Undefined
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
from coursework.kinematics.dyads import rrp, side_of
from coursework.kinematics.rocker_slider import RockerSlider
from coursework.kinematics.triangles import corner, corner_beside, third_side
from coursework.kinematics.vectors import cross
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import formula, given, mistake, stable

from ._strokes import *

UNITS = {
    "xC_max": "mm",
    "xC_min": "mm",
    "OB": "mm",
    "DOB": "deg",
    "AOB": "deg",
    "phi": "deg",
    "B_turn": "1",
    "A_turn": "1",
    "theta2_turns": "deg",
    "theta4_far": "deg",
    "theta4_near": "deg",
    "xC_far": "mm",
    "xC_near": "mm",
    "DOB_far": "deg",
    "DOB_near": "deg",
    "yB": "mm",
    "alpha4": "rad/s^2",
    "alpha5": "rad/s^2",
}
SYMBOLS = {
    "OB": "OB",
    "DOB": r"\angle DOB",
    "AOB": r"\angle AOB",
    "phi": r"\varphi",
    "B_turn": r"\varepsilon_B",
    "A_turn": r"\varepsilon_A",
    "theta4_far": r"\theta_{4+}",
    "theta4_near": r"\theta_{4-}",
    "xC_far": r"x_{C+}",
    "xC_near": r"x_{C-}",
    "DOB_far": r"\angle DOB_{+}",
    "DOB_near": r"\angle DOB_{-}",
    "yB": "y_B",
    "theta2_turns": r"\theta_{2,\mathrm{ext}}",
    "xC_max": r"x_{C,\mathrm{max}}",
    "xC_min": r"x_{C,\mathrm{min}}",
}
LOOPS = {
    "loop_1": (
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("r1", "theta1", -1),
        Vector("r4", "theta4", -1),
    ),
    "loop_2": (
        Vector("r1", "theta1"),
        Vector("r4", "theta4"),
        Vector("r5", "theta5"),
        Vector("xC", 0.0, -1),
        Vector("h", math.pi / 2, -1),
    ),
}
RATES = {"xC": ("v_C", "a_C")}
EFFECTS = {"advantage": ("mechanical_advantage",)}
MECHANISM = Mechanism(
    ground={"O": 0, "D": lambda r1, theta1: polar(r1, theta1)},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3"}),
        Body("4", "theta4", "D", {"B": "r4"}),
        Body("5", "theta5", "B", {"C": "r5"}),
        Body("6", 0, "C"),
    ),
    slides=(Slide("C", "6"),),
)


@formula(r"\sqrt{<r2>^2 + <r3>^2 - 2 \times <r2> \times <r3> \times \cos <angle_OAB>}")
def OB(r2, r3, angle_OAB):
    """The law of cosines in triangle OAB, as a sum of two squares; its angle at A is from 0 to 180."""
    inside = (angle_OAB >= 0) & (angle_OAB <= 180)
    if isinstance(inside, bool):
        if not inside:
            raise Undefined(f"the angle OAB of a triangle lies from 0 to 180 deg; found {angle_OAB:g}")
    else:
        angle_OAB = np.where(inside, angle_OAB, np.nan)
    return third_side(r2, r3, Degrees(angle_OAB))


@formula(r"\arccos \left(\frac{<r1>^2 + <OB>^2 - <r4>^2}{2 \times <r1> \times <OB>}\right)")
def DOB(r1, r4, OB):
    """Angle at O of triangle ODB."""
    return from_radians(corner(r1, OB, r4))


@formula(r"\arccos \left(\frac{<r2>^2 + <OB>^2 - <r3>^2}{2 \times <r2> \times <OB>}\right)")
def AOB(r2, r3, angle_OAB, OB):
    """Angle at O of triangle OAB; a distance OB that is not that of the data (given, or a student's)
    counts."""
    return from_radians(corner_beside(r2, r3, Degrees(angle_OAB), OB))


def B_turn(B_side):
    """+1 when B lies left of the line O -> D, -1 when right."""
    return side_of(B_side)


def phi(theta1, B_turn, DOB):
    """Direction of OB."""
    return wrap(theta1 + B_turn * DOB)


def A_turn(A_side):
    """+1 when A lies left of the line O -> B, -1 when right."""
    return side_of(A_side)


def theta2(phi, A_turn, AOB):
    """Direction of OA."""
    return wrap(phi + A_turn * AOB)


def theta3(theta2, A_turn, angle_OAB):
    """At A the path O-A-B turns by the supplement of its angle, back towards OB."""
    return wrap(theta2 + A_turn * (angle_OAB - 180))


def theta4(r1, theta1, OB, phi):
    """Direction of DB, by its quadrant."""
    return atan2(OB * sin(phi) - r1 * sin(theta1), OB * cos(phi) - r1 * cos(theta1))


def yB(r1, theta1, r4, theta4):
    return r1 * sin(theta1) + r4 * sin(theta4)


def xC(r1, theta1, r4, theta4, r5, h, yB):
    """C to the right of B."""
    return r1 * cos(theta1) + r4 * cos(theta4) + _run(r5, h - yB)


@formula(r"\arcsin \left(\frac{<h> - <yB>}{<r5>}\right)")
def theta5(r5, h, yB):
    """Direction of BC, between -90 and 90 degrees."""
    return atan2(h - yB, _run(r5, h - yB))


def _run(rod, rise):
    """Distance of C to the right of B, for its height above B."""
    if np.ndim(rod - rise) == 0 and abs(rise) > rod:
        raise CannotAssemble(
            f"the rod does not reach the line: it is {abs(rise):.6g} from B, the rod is {rod:.6g} long "
            f"(gap {abs(rise) - rod:.3g})"
        )
    return sqrt((rod - rise) * (rod + rise))


def omega3(r2, omega2, r3, theta2, theta3, theta4):
    """Across the rocker, crank and coupler move B by opposite amounts."""
    return r2 * omega2 * sin(theta2 - theta4) / (r3 * sin(theta4 - theta3))


@stable(
    lambda r2, omega2, r4, A_turn, angle_OAB, theta3, theta4: (
        A_turn * r2 * omega2 * sin(angle_OAB) / (r4 * sin(theta4 - theta3))
    )
)
def omega4(r2, omega2, r4, theta2, theta3, theta4):
    """Along the coupler, A and B have the same velocity."""
    return r2 * omega2 * sin(theta2 - theta3) / (r4 * sin(theta4 - theta3))


def omega5(r4, omega4, theta4, r5, theta5):
    """C keeps to its line."""
    return -r4 * omega4 * cos(theta4) / (r5 * cos(theta5))


def v_C(r4, omega4, theta4, r5, omega5, theta5):
    return -r4 * omega4 * sin(theta4) - r5 * omega5 * sin(theta5)


def alpha4(r2, omega2, r3, omega3, r4, omega4, theta2, theta3, theta4):
    """The accelerations of loop O-A-B-D, along the coupler."""
    return (
        r2 * omega2**2 * cos(theta2 - theta3) + r3 * omega3**2 - r4 * omega4**2 * cos(theta4 - theta3)
    ) / (r4 * sin(theta4 - theta3))


def alpha5(r4, omega4, alpha4, theta4, r5, omega5, theta5):
    """C keeps to its line: no acceleration across it."""
    return (r4 * omega4**2 * sin(theta4) - r4 * alpha4 * cos(theta4) + r5 * omega5**2 * sin(theta5)) / (
        r5 * cos(theta5)
    )


def a_C(r4, omega4, alpha4, theta4, r5, omega5, alpha5, theta5):
    return (
        -r4 * alpha4 * sin(theta4)
        - r4 * omega4**2 * cos(theta4)
        - r5 * alpha5 * sin(theta5)
        - r5 * omega5**2 * cos(theta5)
    )


def mode(r1, r2, r3, r4, angle_OAB, B_side, A_side):
    """Of the dyad A-B-D, kept over the turn: open when B lies to the left of the line from A to D."""
    length = OB(r2, r3, angle_OAB)
    to_B = side_of(B_side) * DOB(r1, r4, length)
    crank = polar(r2, to_B + side_of(A_side) * AOB(r2, r3, angle_OAB, length))
    return np.where(cross(r1 - crank, polar(length, to_B) - crank) >= 0, "open", "crossed")


def _corner(near, other, opposite):
    """The angle of a triangle between two sides, by the law of cosines."""
    return acos((near**2 + other**2 - opposite**2) / (2 * near * other))


def DOB_far(r1, r2, r3, r4):
    """Angle at O of triangle ODB where crank and coupler are stretched in line."""
    return _corner(r1, r3 + r2, r4)


def DOB_near(r1, r2, r3, r4):
    """The same where the coupler is folded back over the crank."""
    return _corner(r1, r3 - r2, r4)


def _linkage(r1, theta1, r2, r3, r4, r5, h, mode):
    """The mechanism over a turn, by the numeric core."""
    return RockerSlider(r1, np.radians(theta1), r2, r3, r4, side_of(mode), r5, h)


@stable(lambda _linkage: wrap(np.degrees(_linkage.turning_points())))
def theta2_turns(theta1, B_turn, DOB_far, DOB_near):
    """Crank angles at which C turns back, along the last axis, then NaN.

    Where the rod never lines up with the rocker: along OB stretched, away from it folded.
    """
    turns = [theta1 + B_turn * DOB_far, theta1 + B_turn * DOB_near + 180]
    return wrap(np.stack(np.broadcast_arrays(*turns), axis=-1))


def _positions(_linkage, r1, theta1, r5, h, theta2_turns):
    """xC where C turns back, along the last axis."""
    pivot, rod, line = (np.asarray(value)[..., None] for value in (polar(r1, theta1), r5, h))
    return rrp(pivot + _linkage.rocker_vectors(np.radians(theta2_turns)), rod, line).real


def theta4_far(r1, theta1, r2, r3, r4, B_turn):
    """Direction of DB where crank and coupler are stretched in line."""
    return wrap(theta1 + 180 - B_turn * _corner(r1, r4, r3 + r2))


def theta4_near(r1, theta1, r2, r3, r4, B_turn):
    """The same where the coupler is folded back over the crank."""
    return wrap(theta1 + 180 - B_turn * _corner(r1, r4, r3 - r2))


def _piston_at(r1, theta1, r4, r5, h, direction):
    """xC for a direction of the rocker."""
    return r1 * cos(theta1) + r4 * cos(direction) + _run(r5, h - r1 * sin(theta1) - r4 * sin(direction))


def xC_far(r1, theta1, r4, r5, h, theta4_far):
    return _piston_at(r1, theta1, r4, r5, h, theta4_far)


def xC_near(r1, theta1, r4, r5, h, theta4_near):
    return _piston_at(r1, theta1, r4, r5, h, theta4_near)


@stable(lambda _positions: np.fmax.reduce(_positions, axis=-1))
def xC_max(xC_far, xC_near):
    """The farthest of the positions where C turns back."""
    return np.maximum(xC_far, xC_near)


@stable(lambda _positions: np.fmin.reduce(_positions, axis=-1))
def xC_min(xC_far, xC_near):
    """The nearest of them."""
    return np.minimum(xC_far, xC_near)


@stable(lambda _linkage: _linkage.stroke())
def stroke(xC_max, xC_min):
    return xC_max - xC_min


def _longer_arc(theta2_turns, _linkage):
    """The longer of the two arcs of crank between the two positions where C turns back."""
    times = _linkage.times_turned()
    if isinstance(times, int) and times != 2:
        raise Undefined(
            f"C turns back {times} times a turn, not twice: the rod lines up with the rocker within "
            "its swing, "
            "and one stroke out and one back are not two arcs of crank; only the stroke exists"
        )
    arc = abs(wrap(theta2_turns[..., 0] - theta2_turns[..., 1]))
    return np.where(times == 2, 360 - arc, np.nan)


@stable(_longer_arc)
def alpha(DOB_far, DOB_near):
    """From one direction of OB to the other, and half a turn."""
    return 180 + abs(DOB_far - DOB_near)


def mechanical_advantage(r2, omega2, v_C):
    """Of the crank pin over the piston, by their speeds."""
    if np.ndim(v_C) == 0 and v_C == 0:
        raise Undefined("the piston is at rest: the mechanical advantage grows without bound there")
    return np.where(v_C == 0, np.nan, abs(r2 * omega2 / v_C))


@mistake("theta3")
def angle_from_OAB_as_theta3(angle_OAB):
    return 180 - angle_OAB


@mistake("A_side")
def A_other_side(A_side):
    return np.where(side_of(A_side) > 0, "right", "left")


@mistake("B_side")
def B_other_side(B_side):
    return np.where(side_of(B_side) > 0, "right", "left")


@mistake("OB", kind="term_sign")
def cosine_rule_sign(r2, r3, angle_OAB):
    return sqrt(r2**2 + r3**2 + 2 * r2 * r3 * cos(angle_OAB))


@mistake("v_C")
def v_C_is_v_B(r4, omega4):
    return r4 * abs(omega4)


@mistake("v_C")
def v_C_x_of_B(r4, omega4, theta4):
    return -r4 * omega4 * sin(theta4)


@mistake("a_C")
def a_C_no_rod_normal(a_C, r5, omega5, theta5):
    return a_C + r5 * omega5**2 * cos(theta5)


@mistake("a_C")
def a_C_no_rocker_normal(a_C, r4, omega4, theta4):
    return a_C + r4 * omega4**2 * cos(theta4)


@mistake("stroke")
def stroke_2r2(r2):
    return 2 * r2


@mistake("alpha")
def strokes_of_equal_arcs(alpha):
    return 180 + 0 * alpha


@mistake("Q", kind="inverse")
def Q_inverse(alpha, beta):
    return beta / alpha


@mistake("T", kind="inverse")
def T_is_frequency(omega2):
    return abs(omega2) / (2 * math.pi)


@mistake("alpha", "beta", kind="exchanged")
def advance_and_return_exchanged(alpha, beta):
    return beta, alpha


@mistake("mechanical_advantage", kind="inverse")
def advantage_inverse(r2, omega2, v_C):
    return abs(v_C / (r2 * omega2))


@mistake("mechanical_advantage")
def advantage_angular(omega2, omega4):
    return abs(omega2 / omega4)


def polygons(
    r2, r3, r4, r5, theta2, theta3, theta4, theta5, omega2, omega3, omega4, omega5, v_C, a_C, alpha4, alpha5
):
    """Two bars meet at B, then the rod from B to the piston; the coupler's own acceleration is what is
    left."""
    OA, AB, DB, BC = polar(r2, theta2), polar(r3, theta3), polar(r4, theta4), polar(r5, theta5)
    alpha3 = (((1j * alpha4 - omega4**2) * DB + omega2**2 * OA) / AB).imag
    return (
        polygon_of_velocities(
            crank_v("A", "OA", OA, omega2),
            two_bars_v("B", "A", "D", AB, omega3, DB, omega4),
            slider_v("C", "B", BC, omega5, v_C),
        ),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2),
            two_bars_a("B", "A", "D", AB, omega3, alpha3, "r_3", DB, omega4, alpha4, "r_4"),
            slider_a("C", "B", BC, omega5, alpha5, "r_5", a_C),
        ),
    )


def residual(
    r1,
    theta1,
    r2,
    r3,
    r4,
    r5,
    h,
    angle_OAB,
    omega2,
    B_side,
    A_side,
    theta2,
    theta3,
    theta4,
    xC,
    theta5,
    omega3,
    omega4,
    omega5,
    v_C,
    a_C,
    alpha4,
    alpha5,
    alpha,
    beta,
    Q,
    T,
    t_advance,
    t_return,
    mechanical_advantage,
):
    """Both loops with their derivatives, the angle OAB and the two sides, and the times of the strokes."""

    def vector(length, theta):
        return length * np.exp(1j * np.radians(theta))

    def across(u, v):
        return (np.conj(u) * v).imag

    # The angular acceleration of the coupler is not asked: the loop's acceleration is read across it.
    crank, coupler, rocker = vector(r2, theta2), vector(r3, theta3), vector(r4, theta4)
    frame, rod, inner = vector(r1, theta1), vector(r5, theta5), vector(r2, theta2) + vector(r3, theta3)
    speed = r2 * abs(omega2) + r3 * abs(omega3) + r4 * abs(omega4) + r5 * abs(omega5)
    size = r1 + r2 + r3 + r4 + r5
    force = r2 * omega2**2 + r3 * omega3**2 + r4 * omega4**2 + r5 * omega5**2 + r4 * abs(alpha4)
    of_B = (1j * alpha4 - omega4**2) * rocker
    left_B, left_A = np.where(B_side == "left", 1, -1), np.where(A_side == "left", 1, -1)
    corner = np.conj(-crank) * coupler / (r2 * r3)
    return (
        abs(inner - frame - rocker) / size,
        abs(frame + rocker + rod - xC - 1j * h) / size,
        abs(corner.real - np.cos(np.radians(angle_OAB))),
        np.maximum(-left_B * across(frame, inner), 0) / size**2,
        np.maximum(-left_A * across(inner, crank), 0) / size**2,
        abs(1j * (omega2 * crank + omega3 * coupler - omega4 * rocker)) / speed,
        abs(1j * (omega4 * rocker + omega5 * rod) - v_C) / speed,
        abs((np.conj(coupler) * (of_B + omega2**2 * crank + omega3**2 * coupler)).real) / (r3 * force),
        abs(of_B + (1j * alpha5 - omega5**2) * rod - a_C) / (force + r5 * abs(alpha5)),
        abs(alpha + beta - 360) / 360,
        abs(Q * beta - alpha) / alpha,
        abs(T * abs(omega2) - 2 * np.pi),
        abs(t_advance + t_return - T) / T,
        abs(t_advance * beta - t_return * alpha) / (T * alpha),
        abs(mechanical_advantage * abs(v_C) - r2 * abs(omega2)) / (r2 * abs(omega2)),
    )


KNOWN = (
    # O-A-B is a 3-4-5 triangle with A on the x axis and B above it, B-C another: all by hand.
    given(
        r1=72,
        theta1=0,
        r2=30,
        r3=40,
        r4=58,
        r5=50,
        h=10,
        omega2=1,
        angle_OAB=90,
        B_side="left",
        A_side="right",
    ).gives(
        theta2=0,
        theta3=90,
        theta4="136.3972",
        xC=70,
        theta5="-36.8699",
        omega3=-5 / 7,
        omega4=-5 / 7,
        omega5=-0.75,
        v_C=85 / 14,
        alpha4=0,
        a_C=150 / 7 - 45 / 2 + 0.75 * (1000 / 49 - 135 / 8),
        T=2 * math.pi,
        mechanical_advantage=84 / 17,
    ),
    # r1^2 + r2^2 = r3^2 + r4^2: both extreme positions of B are in line with O, and the strokes last alike.
    given(
        r1=80,
        theta1=0,
        r2=10,
        r3=70,
        r4=40,
        r5=100,
        h=0,
        omega2=3,
        angle_OAB=90,
        B_side="left",
        A_side="left",
    ).gives(alpha=180, beta=180, Q=1, stroke=17.5 + 8500**0.5 - 9156.25**0.5, t_advance=math.pi / 3),
    # Crank and coupler in line make the triangles 50-70-80, with 60 degrees at O, and 90-70-80, with cosine
    # 2/3.
    given(
        r1=80,
        theta1=30,
        r2=20,
        r3=70,
        r4=70,
        r5=300,
        h=100,
        omega2=-2,
        angle_OAB=100,
        B_side="left",
        A_side="left",
    ).gives(alpha="191.8103", beta="168.1897", T=math.pi, Q=191.810314895778592 / 168.189685104221401),
)
