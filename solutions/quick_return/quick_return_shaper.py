"""Shaper: solution.

The slotted mechanism gives the guide's direction and rate; the point P of the guide carries the rod to the
ram. The ram turns back at the ends of the guide's swing, where the guide touches the circle of A and stands
square to the crank. Only where the rod lines up with the guide inside the swing would it turn back there too.
"""

import math

import numpy as np

from coursework.degrees import acos, cos, polar, sin, sqrt
from coursework.errors import Undefined
from coursework.figures import Figure, circle, ground_pivot, line, link, pin, point, rotation_arrow
from coursework.solution import given, mistake, stable

from ._slotted_ram import *
from ._slotted_ram_acceleration import *
from ._strokes import *
from ._swinging import *

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
    "sigma": "deg",
    "T": "s",
}
SYMBOLS = {"xP": "x_P", "yP": "y_P"}


def _two_strokes(sigma, _turn):
    if np.ndim(_turn.stroke) == 0 and _turn.lines_up:
        raise Undefined(
            "C turns back more than twice a turn: the rod lines up with the guide within its swing, "
            "and one stroke out and one back are not two arcs of crank; only the stroke exists"
        )
    return np.where(np.isnan(_turn.stroke) | _turn.lines_up, np.nan, 180 + 2 * sigma)[()]


@stable(_two_strokes)
def alpha(sigma):
    """The longer of the two arcs of crank between the ends of the swing."""
    return 180 + 2 * sigma


@mistake("theta4", "omega4")
def guide_turns_with_crank(theta2, omega2):
    return theta2, omega2


@mistake("omega4")
def guide_speed_no_projection(r2, omega2, rA):
    return r2 * omega2 / rA


@mistake("xP", "yP")
def P_at_A(rA, theta4):
    return rA * cos(theta4), rA * sin(theta4)


@mistake("stroke")
def stroke_2r2(r2):
    return 2 * r2


@mistake("stroke")
def stroke_formula(r4):
    return 2 * r4


@mistake("alpha", kind="constant")
def Q_half(sigma):
    return 180 + sigma


@mistake("sigma")
def Q_acos(r1, r2):
    return acos(r2 / r1)


@mistake("Q", kind="inverse")
def Q_inverse(alpha, beta):
    return beta / alpha


@mistake("T", kind="inverse")
def T_is_frequency(omega2):
    return abs(omega2) / (2 * math.pi)


@mistake("alpha", "beta", kind="exchanged")
def advance_and_return_exchanged(alpha, beta):
    return beta, alpha


def figure(r1, r2, r4, r5, h, omega2, sigma):
    """Both ends of the swing, and the arc that the crank covers during the advance."""
    O4, O2 = 0j, 1j * r1
    right, left = polar(1, 90 - sigma), polar(1, 90 + sigma)
    A2, A1 = O2 + polar(r2, -sigma), O2 + polar(r2, 180 + sigma)
    P2, P1 = r4 * right, r4 * left
    C2, C1 = (complex(P.real + sqrt(r5**2 - (h - P.imag) ** 2), h) for P in (P2, P1))
    start, end = (-sigma, 180 + sigma) if omega2 > 0 else (180 + sigma, -sigma)
    return Figure(
        circle(O2, r2, dashed=True),
        line(C1, C2, dashed=True),
        link(O4, P1),
        link(O4, P2),
        link(P1, C1),
        link(P2, C2),
        link(O2, A1),
        link(O2, A2),
        rotation_arrow(O2, 1.3 * r2, start, end, label=r"\alpha"),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        pin(A1, "A'"),
        pin(A2, "A''"),
        pin(P1, "P'"),
        pin(P2, "P''"),
        point(C1, "C'"),
        point(C2, "C''"),
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
    """Both loops and their derivatives, crank square to guide at the ends of the arc alpha, and the times."""
    crank = r2 * np.exp(1j * np.radians(theta2))
    along = np.exp(1j * np.radians(theta4))
    rod = xC + 1j * h - r4 * along
    velocity_of_A = 1j * omega2 * crank / along
    speed = r4 * abs(omega4) + r5 * abs(omega5)

    # The arc of the advance lies on the far side of O2: it is halved by the y axis.
    ends = [1j * r2 * np.exp(side * 0.5j * np.radians(alpha)) for side in (-1, 1)]
    arms = [1j * r1 + end for end in ends]
    pins = [r4 * arm / abs(arm) for arm in arms]
    rams = [pin.real + np.sqrt(r5**2 - (h - pin.imag) ** 2) for pin in pins]
    turn = 2 * np.pi / abs(omega2)
    return (
        abs(1j * r1 + crank - rA * along) / (r1 + r2),
        abs(velocity_of_A.imag - rA * omega4) / (r2 * abs(omega2)),
        abs(abs(rod) - r5) / r5,
        abs(np.minimum(rod.real, 0)) / r5,
        abs(1j * (omega4 * r4 * along + omega5 * rod) - v_C) / speed,
        abs((np.conj(arms[0]) * ends[0]).real) / (r1 * r2),
        abs(rams[0] - rams[1] - stroke) / r5,
        np.maximum(beta - alpha, 0) / 360,
        abs(alpha + beta - 360) / 360,
        abs(Q * beta - alpha) / alpha,
        abs(t_advance + t_return - turn) / turn,
        abs(t_advance * beta - t_return * alpha) / (turn * alpha),
    )


KNOWN = (
    # The course's slotted mechanism, where A and the guide are; the crank is half the frame: 30 degrees
    # either side.
    given(r1=228.6, r2=114.3, r4=400, r5=200, h=380, theta2=135, omega2=1).gives(
        rA="319.80", theta4="104.64", sigma=30, alpha=240, beta=120, Q=2, stroke=400
    ),
    # The guide upright, A above O2; P-C a 3-4-5 triangle.
    given(r1=200, r2=100, r4=450, r5=100, h=390, theta2=90, omega2=3).gives(
        theta4=90, omega4=1, xC=80, v_C=-450, alpha4=0, alpha5=5.625, a_C=337.5, stroke=450
    ),
    # The guide upright, A below O2: the guide turns back, and faster.
    given(r1=200, r2=100, r4=450, r5=100, h=390, theta2=-90, omega2=math.pi).gives(
        theta4=90, omega4=-math.pi, xC=80, v_C=450 * math.pi, t_advance=4 / 3, t_return=2 / 3
    ),
    # The end of the swing, a 3-4-5 triangle at O4 too: P at (300, 400), the rod level.
    given(r1=250, r2=150, r4=500, r5=130, h=400, theta2=-36.86989764584402, omega2=-7).gives(
        rA=200, xC=430, v_C=0, stroke=600, alpha="253.7398", beta="106.2602"
    ),
    # The rod lines up with the guide before the right end of the swing: the ram goes farther than at that
    # end.
    given(r1=100, r2=60, r4=200, r5=100, h=256, theta2=90, omega2=1).gives(stroke=92 + 24464**0.5),
)
