"""Velocity polygon of a four-bar linkage: solution. A, whose velocity is known, and B, which is on two
bars."""

import numpy as np

from coursework.degrees import polar
from coursework.figures.polygons import crank_v, polygon_of_velocities, two_bars_v
from coursework.kinematics.angles import Degrees
from coursework.kinematics.four_bar import FourBar
from coursework.marking.drawn_polygons import DrawingParts, Read, verdicts
from coursework.solution import given, judge, mistake

from ._drawn_velocity import *

SYMBOLS = {"turn_3": r"\varepsilon_3", "turn_4": r"\varepsilon_4"}


def _bars(r1, r2, r3, r4, theta2, mode):
    """Vectors OA, AB and CB, and the rates of AB and CB over that of OA, by the numeric core."""
    pose = FourBar(r1, r2, r3, r4, mode).at(Degrees(theta2))
    coupler, rocker = (np.exp(1j * angle) for angle in (pose.coupler_angle, pose.rocker_angle))
    return polar(r2, theta2), r3 * coupler, r4 * rocker, pose.coupler_ratio, pose.rocker_ratio


def _images(_bars, omega2):
    """Velocities of A and B, complex."""
    crank, _, rocker, _, ratio = _bars
    return 1j * omega2 * crank, 1j * omega2 * ratio * rocker


def _lines(_bars):
    _, coupler, rocker, *_ = _bars
    return 1j * coupler, 1j * rocker


def v_B(kv, pv_b):
    return kv * pv_b


def turn_3(_bars, omega2):
    """Of the coupler: +1 anticlockwise."""
    *_, ratio, _ = _bars
    return np.sign(ratio * omega2)


def omega3(turn_3, kv, ab, r3):
    return turn_3 * kv * ab / r3


def turn_4(_bars, omega2):
    """Of the rocker: +1 anticlockwise."""
    *_, ratio = _bars
    return np.sign(ratio * omega2)


def omega4(turn_4, kv, pv_b, r4):
    return turn_4 * kv * pv_b / r4


@mistake("known_BA")
def nothing_known_of_BA():
    return "neither"


@mistake("known_B")
def nothing_known_of_B():
    return "neither"


@mistake("v_B")
def scale_forgotten(pv_b):
    return pv_b


@mistake("omega3", "omega4", kind="sign")
def value_sense(omega3, omega4):
    return -omega3, -omega4


@mistake("omega3", "omega4")
def radii_exchanged(omega3, omega4, r3, r4):
    return omega3 * r3 / r4, omega4 * r4 / r3


@mistake("omega3")
def omega3_of_V_B(kv, pv_b, r3, omega3):
    """The absolute velocity of B, where that about A is meant."""
    return np.sign(omega3) * kv * pv_b / r3


@judge
def drawing(answers, r1, r2, r3, r4, theta2, omega2, mode):
    """Any pole and any scale; see :mod:`coursework.drawn`."""
    bars = _bars(r1, r2, r3, r4, theta2, mode)
    _, coupler, rocker, *_ = bars
    of_coupler = {"radii_exchanged": ("a", "b", 1 / r4), "omega3_of_V_B": ("p_v", "b", 1 / r3)}
    of_rocker = {"radii_exchanged": ("p_v", "b", 1 / r3)}
    asked = DrawingParts(
        scale="kv",
        points={"p": "p_v", "a": "a", "b": "b"},
        lengths={"ab": ("a", "b"), "pv_b": ("p_v", "b")},
        reads={
            "v_B": Read("p_v", "b", abs, 1.0),
            "omega3": Read("a", "b", lambda v: (v / (1j * coupler)).real, 1 / r3, of_coupler),
            "omega4": Read("p_v", "b", lambda v: (v / (1j * rocker)).real, 1 / r4, of_rocker),
        },
        sides={("p_v", "a"): "a", ("a", "b"): "ba", ("p_v", "b"): "vb"},
        hung=frozenset({"ba_on_p"}),
    )
    return verdicts(answers, _polygon(bars, omega2), asked)


def _polygon(bars, omega2, scale=None):
    crank, coupler, rocker, *ratios = bars
    omega3, omega4 = (ratio * omega2 for ratio in ratios)
    return polygon_of_velocities(
        crank_v("A", "OA", crank, omega2),
        two_bars_v("B", "A", "C", coupler, omega3, rocker, omega4),
        scale=scale,
    )


def polygons(r1, r2, r3, r4, theta2, omega2, mode, kv):
    """At the scale of the answers."""
    return (_polygon(_bars(r1, r2, r3, r4, theta2, mode), omega2, kv),)


def residual(r1, r2, r3, r4, theta2, omega2, mode, kv, a, b, ab, pv_b, v_B, omega3, omega4):
    """The loop, closed by the law of cosines; b from a and from the pole by the rates; lengths by
    Pythagoras."""
    A = r2 * np.exp(1j * np.radians(theta2))
    AC = r1 - A
    corner = np.arccos((abs(AC) ** 2 + r3**2 - r4**2) / (2 * abs(AC) * r3))
    side = np.where(mode == "open", 1, -1)
    AB = r3 * AC / abs(AC) * np.exp(1j * side * corner)
    CB = A + AB - r1
    z_a, z_b = (q[..., 0] + 1j * q[..., 1] for q in (a, b))
    size = r2 * abs(omega2)
    return (
        abs(z_a * kv - 1j * omega2 * A) / size,
        abs(z_b * kv - 1j * (omega2 * A + omega3 * AB)) / size,
        abs(z_b * kv - 1j * omega4 * CB) / size,
        abs(abs(z_b - z_a) - ab) * kv / size,
        abs(abs(z_b) - pv_b) * kv / size,
        abs(v_B - kv * abs(z_b)) / size,
    )


KNOWN = (
    # Crank along the frame, ABC a 3-4-5 triangle, right-angled at B: coupler and rocker turn at -3 rad/s.
    given(r1=80, r2=30, r3=40, r4=30, theta2=0, omega2=5, mode="open").gives(
        kv=2, a=(0, 75), b=(36, 27), ab=60, pv_b=45, v_B=90, omega3=-3, omega4=-3
    ),
    # A parallelogram: the coupler only translates, a and b are one.
    given(r1=100, r2=50, r3=100, r4=50, theta2=90, omega2=2, mode="open").gives(
        kv=1, a=(-100, 0), b=(-100, 0), ab=0, v_B=100, omega4=2
    ),
)
