"""Whitworth's quick return: solution.

The slotted mechanism gives the guide's direction and rate; the guide is then the crank of a slider-crank. The
ram turns back where guide and rod are in line: at C2, the far end, stretched, and at C1, the near end,
folded. Between these two directions of the guide the crank turns by more than half a turn on the side where A
is far from O4, and by less on the other.
"""

import math

import numpy as np

from coursework.degrees import acos, asin, atan, atan2, cos, polar, sin, sqrt
from coursework.errors import CannotAssemble, Undefined
from coursework.figures import Figure, circle, ground_pivot, line, link, pin, point, rotation_arrow
from coursework.kinematics.slider_crank import SliderCrank
from coursework.solution import given, mistake, stable

from ._slotted_ram import *
from ._slotted_ram_acceleration import *
from ._strokes import *

UNITS = {
    "theta5": "deg",
    "rA": "mm",
    "theta4": "deg",
    "omega4": "rad/s",
    "xP": "mm",
    "yP": "mm",
    "p": "mm",
    "q": "mm",
    "omega5": "rad/s",
    "rA_dot": "mm/s",
    "alpha4": "rad/s^2",
    "alpha5": "rad/s^2",
    "x1": "mm",
    "x2": "mm",
    "phi1": "deg",
    "phi2": "deg",
    "psi1": "deg",
    "psi2": "deg",
    "T": "s",
}
SYMBOLS = {
    "xP": "x_P",
    "yP": "y_P",
    "phi1": r"\varphi_1",
    "phi2": r"\varphi_2",
}


def _turning(r1, r2, r4, r5, h):
    """Guide, rod and ram as a slider-crank whose crank turns fully, by the numeric core."""
    if isinstance(r1 + r2 + r4 + r5 + h, float):
        if not r2 > r1:
            raise Undefined(
                f"the guide does not turn fully: r2 must exceed r1, found r2 = {r2:.6g} and r1 = {r1:.6g}"
            )
        linkage = SliderCrank(r4, r5, h)
        if not linkage.turns_fully():
            raise CannotAssemble(
                f"the guide cannot turn fully: the rod must be longer than r4 + |h| = {r4 + abs(h):.6g}; "
                f"it is {r5:.6g} (gap {r4 + abs(h) - r5:.3g})"
            )
        return linkage
    return SliderCrank(np.where(r2 > r1, r4, np.nan), r5, h)


@stable(lambda r4, r5, h, _turning: _root(r5 + r4 - h, r5 + r4 + h, _turning))
def x2(r4, r5, h):
    """Guide and rod stretched in line."""
    return sqrt((r5 + r4) ** 2 - h**2)


@stable(lambda r4, r5, h, _turning: _root(r5 - r4 - h, r5 - r4 + h, _turning))
def x1(r4, r5, h):
    """Rod folded back over the guide."""
    return sqrt((r5 - r4) ** 2 - h**2)


def _root(one, other, linkage):
    """Of the product of two margins; NaN in arrays where the guide does not turn fully."""
    return sqrt(np.where(linkage.turns_fully(), one * other, np.nan)[()])


@stable(lambda _turning: _turning.stroke())
def stroke(x2, x1):
    return x2 - x1


@stable(lambda h, x1: atan2(h, x1))
def phi1(r4, r5, h):
    """Inclination of the line O4C1."""
    return asin(h / (r5 - r4))


@stable(lambda h, x2: atan2(h, x2))
def phi2(r4, r5, h):
    """Inclination of the line O4C2."""
    return asin(h / (r5 + r4))


def _at_A(r1, r2, phi):
    """arcsin(r1 cos(phi) / r2), also where the crank hardly exceeds the frame."""
    longer, shorter = r2 + r1 * cos(phi), r2 - r1 + 2 * r1 * sin(phi / 2) ** 2
    return atan2(r1 * cos(phi), sqrt(longer * shorter))


@stable(lambda r1, r2, phi1: _at_A(r1, r2, phi1))
def psi1(r1, r2, phi1):
    """Angle at A between guide and crank, at the near end: the law of sines in O4-O2-A."""
    return asin(r1 * cos(phi1) / r2)


@stable(lambda r1, r2, phi2: _at_A(r1, r2, phi2))
def psi2(r1, r2, phi2):
    """The same at the far end."""
    return asin(r1 * cos(phi2) / r2)


def alpha(phi1, phi2, psi1, psi2):
    """The longer of the two arcs of crank between the positions in line."""
    return 180 + abs(psi1 + psi2 + phi1 - phi2)


@mistake("theta4", kind="quadrant")
def arctan_no_quadrant(r1, r2, theta2):
    return atan((r1 + r2 * sin(theta2)) / (r2 * cos(theta2)))


@mistake("theta4", "omega4")
def guide_turns_with_crank(theta2, omega2):
    return theta2, omega2


@mistake("xP", "yP")
def P_at_A(rA, theta4):
    return rA * cos(theta4), rA * sin(theta4)


@mistake("v_C")
def v_C_rod_left_out(omega4, yP):
    return -omega4 * yP


@mistake("a_C")
def a_C_no_rod_normal(a_C, omega5, q):
    return a_C + omega5**2 * q


@mistake("stroke")
def stroke_2r2(r2):
    return 2 * r2


@mistake("stroke")
def stroke_r4r2_r1(r1, r2, r4):
    return 2 * r4 * r2 / r1


@mistake("psi2", kind="constant")
def Q_half(psi2):
    return 0 * psi2


@mistake("psi1", "psi2")
def Q_atan(r1, r2, phi1, phi2):
    return atan(r1 * cos(phi1) / r2), atan(r1 * cos(phi2) / r2)


@mistake("psi1", "psi2")
def Q_acos(r1, r2, phi1, phi2):
    return acos(r1 * cos(phi1) / r2), acos(r1 * cos(phi2) / r2)


@mistake("alpha", kind="inverse")
def line_through_O4(r1, r2):
    return 180 + 2 * asin(r1 / r2)


@mistake("Q", kind="inverse")
def Q_inverse(alpha, beta):
    return beta / alpha


@mistake("T", kind="inverse")
def T_is_frequency(omega2):
    return abs(omega2) / (2 * math.pi)


@mistake("alpha", "beta", kind="exchanged")
def advance_and_return_exchanged(alpha, beta):
    return beta, alpha


def figure(r1, r2, r4, h, omega2, x1, x2, phi1, phi2, psi1, psi2):
    """The two positions in line, and the arc that the crank covers during the advance."""
    O4, O2, C1, C2 = 0j, 1j * r1, complex(x1, h), complex(x2, h)
    far, near = phi2 - psi2, 180 + phi1 + psi1
    A1, A2 = O2 + polar(r2, near), O2 + polar(r2, far)
    P1, P2 = polar(-r4, phi1), polar(r4, phi2)
    longer = (far, near) if near - far >= 180 else (near, far + 360)
    start, end = longer if omega2 > 0 else longer[::-1]
    return Figure(
        circle(O2, r2, dashed=True),
        line(O4, A1, dashed=True),
        line(O4, A2, dashed=True),
        link(P1, C1),
        link(P2, C2),
        link(O2, A1),
        link(O2, A2),
        rotation_arrow(O2, 0.5 * r2, start, end, label=r"\alpha"),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        pin(A1, "A_1"),
        pin(A2, "A_2"),
        pin(P1, "P_1"),
        pin(P2, "P_2"),
        point(C1, "C_1"),
        point(C2, "C_2"),
    )


def residual(
    r1,
    r2,
    r4,
    r5,
    h,
    theta2,
    omega2,
    rA,
    theta4,
    omega4,
    omega5,
    xC,
    v_C,
    stroke,
    alpha,
    beta,
    Q,
    t_advance,
    t_return,
):
    """Both loops, their derivatives, the two dead positions and the arc of crank between them; times."""
    crank = r2 * np.exp(1j * np.radians(theta2))
    along = np.exp(1j * np.radians(theta4))
    rod = xC + 1j * h - r4 * along
    velocity_of_A = 1j * omega2 * crank / along
    speed = r4 * abs(omega4) + r5 * abs(omega5)

    def crank_when_the_guide_points(direction):
        """The point of the circle of A on a half-line from O4, seen from O2."""
        away = r1 * direction.imag
        return (away + np.sqrt(away**2 + r2**2 - r1**2)) * direction - 1j * r1

    rise_far, rise_near = h / (r5 + r4), h / (r5 - r4)
    far = np.sqrt(1 - rise_far**2) + 1j * rise_far
    near = np.sqrt(1 - rise_near**2) + 1j * rise_near
    turned = crank_when_the_guide_points(-near) / crank_when_the_guide_points(far)
    arc = np.exp(1j * np.radians(alpha))
    turn = 2 * np.pi / abs(omega2)
    return (
        abs(1j * r1 + crank - rA * along) / (r1 + r2),
        abs(velocity_of_A.imag - rA * omega4) / (r2 * abs(omega2)),
        abs(abs(rod) - r5) / r5,
        abs(np.minimum(rod.real, 0)) / r5,
        abs(1j * (omega4 * r4 * along + omega5 * rod) - v_C) / speed,
        abs((r5 + r4) * far - (r5 - r4) * near - stroke) / r5,
        np.minimum(abs(turned - arc), abs(turned - np.conj(arc))),
        np.maximum(beta - alpha, 0) / 360,
        abs(alpha + beta - 360) / 360,
        abs(Q * beta - alpha) / alpha,
        abs(t_advance + t_return - turn) / turn,
        abs(t_advance * beta - t_return * alpha) / (turn * alpha),
    )


_LINE = {"r1": 50, "r2": 100, "r4": 60, "r5": 100, "h": 0}

KNOWN = (
    # A straight above O2: the guide upright, P-C a 3-4-5 triangle; on the strokes the angles at A are 30
    # degrees.
    given(**_LINE, theta2=90, omega2=3).gives(
        rA=150,
        theta4=90,
        omega4=2,
        xC=80,
        v_C=-120,
        alpha4=0,
        alpha5=3,
        a_C=180,
        stroke=120,
        alpha=240,
        beta=120,
        Q=2,
    ),
    # Straight below, where A is three times nearer to O4.
    given(**_LINE, theta2=-90, omega2=2 * math.pi).gives(
        rA=50, theta4=-90, omega4=4 * math.pi, xC=80, v_C=240 * math.pi, t_advance=2 / 3, t_return=1 / 3
    ),
    # The guide along x: a 60-80-100 triangle holds the crank, a 30-40-50 one the rod.
    given(r1=60, r2=100, r4=50, r5=50, h=40, theta2=-36.86989764584402, omega2=3).gives(
        rA=80, theta4=0, omega4=3, xC=80, v_C=200
    ),
    # Stretched a 60-144-156 triangle, folded a 60-80-100 one, where the law of sines gives 30 degrees at A.
    given(r1=50, r2=80, r4=28, r5=128, h=60, theta2=0, omega2=1).gives(
        x1=80, x2=144, stroke=64, psi1=30, alpha="259.48", beta="100.52"
    ),
    # The line as far below: guide and line now lean against each other.
    given(r1=50, r2=80, r4=28, r5=128, h=-60, theta2=0, omega2=1).gives(stroke=64, alpha="230.98"),
)
