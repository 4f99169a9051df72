"""Acceleration polygon of a four-bar linkage: solution. The normal parts are known from the velocities; the
tangential ones, of which the directions are known, meet in b."""

import numpy as np

from coursework.degrees import polar
from coursework.figures.polygons import crank_a, polygon_of_accelerations, two_bars_a
from coursework.kinematics.angles import Degrees
from coursework.kinematics.four_bar import FourBar
from coursework.marking.drawn_polygons import DrawingParts, Read, verdicts
from coursework.solution import given, judge, mistake, stable

from ._drawn_acceleration import *
from ._drawn_rocker import *

UNITS = {"mb_t": "mm"}
SYMBOLS = {"sense3": "s_3", "sense4": "s_4", "mb_t": "b'' b"}


def _bars(r1, r2, r3, r4, theta2, mode):
    """Vectors OA, AB and CB; rates of AB and CB over that of OA; their accelerations over its square."""
    pose = FourBar(r1, r2, r3, r4, mode).at(Degrees(theta2))
    coupler, rocker = (np.exp(1j * angle) for angle in (pose.coupler_angle, pose.rocker_angle))
    ratios = pose.coupler_ratio, pose.rocker_ratio
    return polar(r2, theta2), r3 * coupler, r4 * rocker, *ratios, pose.coupler_gain, pose.rocker_gain


def _images(_bars, omega2):
    """Of A, of b', of b'' and of B, complex."""
    crank, coupler, rocker, ratio3, ratio4, _, gain4 = _bars
    square = omega2**2
    of_A = -square * crank
    return (
        of_A,
        of_A - ratio3**2 * square * coupler,
        -(ratio4**2) * square * rocker,
        (1j * gain4 - ratio4**2) * square * rocker,
    )


def _lines(_bars):
    _, coupler, rocker, *_ = _bars
    return 1j * coupler, 1j * rocker


def _start(m):
    """Start of the line of the tangential acceleration of B."""
    return m


@stable(lambda _bars, omega2, r3, ka: abs(_bars[5]) * r3 * omega2**2 / ka)
def bb_t(_images, ka):
    """Measured on the drawing."""
    _, of_n, _, of_B = _images
    return abs(of_B - of_n) / ka


@stable(lambda _bars, omega2, r4, ka: abs(_bars[6]) * r4 * omega2**2 / ka)
def mb_t(_images, ka):
    """From b'' to b, measured on the drawing."""
    *_, of_m, of_B = _images
    return abs(of_B - of_m) / ka


def a_B(ka, pa_b):
    return ka * pa_b


def sense3(_bars):
    """In which the vector b'b, put at B, turns AB: 1 anticlockwise."""
    *_, gain, _ = _bars
    return np.sign(gain)


def alpha3(sense3, ka, bb_t, r3):
    return sense3 * ka * bb_t / r3


def sense4(_bars):
    """The same of the vector b''b and CB."""
    *_, gain = _bars
    return np.sign(gain)


def alpha4(sense4, ka, mb_t, r4):
    return sense4 * ka * mb_t / r4


@mistake("known_BA_n", "known_B_n")
def normal_part_unknown():
    return "direction", "direction"


@mistake("known_BA_t", "known_B_t")
def tangential_part_unknown():
    return "neither", "neither"


@mistake("ka", "p", "a", "n", "m", "b")
def too_small(ka, p, a, n, m, b):
    return 10 * ka, p / 10, a / 10, n / 10, m / 10, b / 10


@mistake("ka", "p", "a", "n", "m", "b", "bb_t", "pa_b", "a_B", "alpha3", "alpha4", kind="inverse")
def scale_upside_down(ka, p, a, n, m, b, bb_t, pa_b, a_B, alpha3, alpha4):
    """The drawing is right."""
    return 1 / ka, p, a, n, m, b, bb_t, pa_b, a_B, alpha3, alpha4


@mistake("ka", "p", "a", "n", "m", "b", "bb_t", "pa_b", "a_B", "alpha3", "alpha4")
def scale_not_drawn(ka, p, a, n, m, b, bb_t, pa_b, a_B, alpha3, alpha4):
    """Stated at one value, drawn at another."""
    return 2 * ka, p, a, n, m, b, bb_t, pa_b, a_B, alpha3, alpha4


@mistake("a_B")
def scale_forgotten(pa_b):
    return pa_b


@mistake("alpha3", "alpha4", kind="sign")
def value_sense(alpha3, alpha4):
    return -alpha3, -alpha4


@mistake("alpha3", "alpha4")
def radii_exchanged(alpha3, alpha4, r3, r4):
    return alpha3 * r3 / r4, alpha4 * r4 / r3


@mistake("alpha4")
def alpha4_of_a_B(alpha4, ka, pa_b, r4):
    """The whole acceleration of B, where its tangential part is meant."""
    return np.sign(alpha4) * ka * pa_b / r4


@judge
def drawing(answers, r1, r2, r3, r4, theta2, omega2, mode):
    """Any pole and any scale; see :mod:`coursework.drawn`."""
    bars = _bars(r1, r2, r3, r4, theta2, mode)
    _, coupler, rocker, *_ = bars
    of_coupler = {"radii_exchanged": ("b'", "b", 1 / r4)}
    of_rocker = {"radii_exchanged": ("b''", "b", 1 / r3), "alpha4_of_a_B": ("p_a", "b", 1 / r4)}
    asked = DrawingParts(
        scale="ka",
        points={"p": "p_a", "a": "a", "n": "b'", "m": "b''", "b": "b"},
        lengths={"bb_t": ("b'", "b"), "pa_b": ("p_a", "b")},
        reads={
            "a_B": Read("p_a", "b", abs, 1.0),
            "alpha3": Read("b'", "b", lambda v: (v / (1j * coupler)).real, 1 / r3, of_coupler),
            "alpha4": Read("b''", "b", lambda v: (v / (1j * rocker)).real, 1 / r4, of_rocker),
        },
        sides={
            ("p_a", "a"): "a",
            ("a", "b'"): "n",
            ("p_a", "b''"): "m",
            ("b'", "b"): "bt",
            ("b''", "b"): "ct",
        },
        hung=frozenset({"n_on_p", "m_on_a", "bt_on_a", "ct_on_p"}),
    )
    return verdicts(answers, _polygon(bars, omega2), asked)


def _polygon(bars, omega2, scale=None):
    crank, coupler, rocker, *ratios, gain3, gain4 = bars
    omega3, omega4 = (ratio * omega2 for ratio in ratios)
    alpha3, alpha4 = (gain * omega2**2 for gain in (gain3, gain4))
    return polygon_of_accelerations(
        crank_a("A", "OA", crank, omega2),
        two_bars_a("B", "A", "C", coupler, omega3, alpha3, "r_3", rocker, omega4, alpha4, "r_4"),
        scale=scale,
    )


def polygons(r1, r2, r3, r4, theta2, omega2, mode, ka):
    """At the scale of the answers."""
    return (_polygon(_bars(r1, r2, r3, r4, theta2, mode), omega2, ka),)


def residual(r1, r2, r3, r4, theta2, omega2, mode, ka, a, n, m, b, bb_t, pa_b, a_B, alpha3, alpha4):
    """The loop, closed by the law of cosines, and the accelerations of B from A and from C."""
    A = r2 * np.exp(1j * np.radians(theta2))
    AC = r1 - A
    corner = np.arccos((abs(AC) ** 2 + r3**2 - r4**2) / (2 * abs(AC) * r3))
    side = np.where(mode == "open", 1, -1)
    AB = r3 * AC / abs(AC) * np.exp(1j * side * corner)
    CB = A + AB - r1
    area = (np.conj(AB) * CB).imag
    omega3 = omega2 * (np.conj(CB) * A).imag / area
    omega4 = omega2 * (np.conj(AB) * A).imag / area
    z_a, z_n, z_m, z_b = ((q[..., 0] + 1j * q[..., 1]) * ka for q in (a, n, m, b))
    size = abs(z_b) + abs(z_n)
    return (
        abs(z_a + omega2**2 * A) / size,
        abs(z_n - z_a + omega3**2 * AB) / size,
        abs(z_m + omega4**2 * CB) / size,
        abs(z_b - z_n - 1j * alpha3 * AB) / size,
        abs(z_b - z_m - 1j * alpha4 * CB) / size,
        abs(abs(z_b - z_n) - bb_t * ka) / size,
        abs(abs(z_b) - pa_b * ka) / size,
        abs(abs(z_b) - a_B) / size,
    )


KNOWN = (
    # Crank along the frame, ABC a 3-4-5 triangle, right-angled at B; both turn at -3 rad/s.
    given(r1=80, r2=30, r3=40, r4=30, theta2=0, omega2=5, mode="open").gives(
        ka=10,
        a=(-75, 0),
        n=(-75 - 28.8, -21.6),
        m=(16.2, -21.6),
        alpha3=-18,
        alpha4=32,
        b=(-60.6, -79.2),
        bb_t=72,
        a_B=30 * (32**2 + 9**2) ** 0.5,
    ),
)
