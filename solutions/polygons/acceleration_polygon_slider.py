"""Acceleration polygon of a slider-crank: solution. The normal part is known from the velocities; the line of
the tangential part and that of the acceleration of B meet in b."""

import numpy as np

from coursework.degrees import polar
from coursework.figures.polygons import crank_a, polygon_of_accelerations, slider_a
from coursework.kinematics.angles import Degrees
from coursework.kinematics.slider_crank import SliderCrank
from coursework.marking.drawn_polygons import DrawingParts, Read, met, verdicts
from coursework.solution import given, judge, mistake

from ._drawn_acceleration import *

SYMBOLS = {"side_B": "s_B", "sense3": "s_3"}


def _bars(r2, r3, e, theta2):
    """Vectors OA and AB; rate of AB over that of OA; its acceleration over the square."""
    pin = polar(r2, theta2)
    reach = SliderCrank(r2, r3, e).run(Degrees(theta2))
    ratio = -pin.real / reach
    return pin, reach + 1j * (e - pin.imag), ratio, ((1 - ratio**2) * pin.imag + ratio**2 * e) / reach


def _images(_bars, omega2):
    """Of A, of b' and of B, complex; that of B has no part across the guide."""
    crank, rod, ratio, gain = _bars
    square = omega2**2
    of_A = -square * crank
    of_n = of_A - ratio**2 * square * rod
    return of_A, of_n, (of_n + 1j * gain * square * rod).real + 0j


def _lines(_bars):
    _, rod, *_ = _bars
    return 1j * rod, 1 + 0j


def known_A():
    return "both"


def known_B():
    return "direction"


def _start(p):
    """Start of the line of the acceleration of B."""
    return p


def bb_t(_images, ka):
    """Measured on the drawing."""
    _, of_n, of_B = _images
    return abs(of_B - of_n) / ka


def side_B(_images):
    """Of b, seen from the pole: 1 on the right, -1 on the left."""
    return np.sign(_images[-1].real)


def r1_ddot(side_B, ka, pa_b):
    return side_B * ka * pa_b


def sense3(_bars):
    """In which the vector b'b, put at B, turns AB: 1 anticlockwise."""
    *_, gain = _bars
    return np.sign(gain)


def alpha3(sense3, ka, bb_t, r3):
    return sense3 * ka * bb_t / r3


@mistake("known_BA_n")
def normal_part_unknown():
    return "direction"


@mistake("known_BA_t", "known_B")
def tangential_part_unknown():
    return "neither", "neither"


@mistake("b")
def pb_direction(n, _start, _lines):
    along, other = _lines
    return met(n, along, _start, other * np.exp(-0.35j))


@mistake("b", kind="sign")
def pb_sense(_start, b):
    return 2 * _start - b


@mistake("ka", "p", "a", "n", "b")
def too_small(ka, p, a, n, b):
    return 10 * ka, p / 10, a / 10, n / 10, b / 10


@mistake("ka", "p", "a", "n", "b", "bb_t", "pa_b", "r1_ddot", "alpha3", kind="inverse")
def scale_upside_down(ka, p, a, n, b, bb_t, pa_b, r1_ddot, alpha3):
    """The drawing is right."""
    return 1 / ka, p, a, n, b, bb_t, pa_b, r1_ddot, alpha3


@mistake("ka", "p", "a", "n", "b", "bb_t", "pa_b", "r1_ddot", "alpha3")
def scale_not_drawn(ka, p, a, n, b, bb_t, pa_b, r1_ddot, alpha3):
    """Stated at one value, drawn at another."""
    return 2 * ka, p, a, n, b, bb_t, pa_b, r1_ddot, alpha3


@mistake("r1_ddot")
def scale_forgotten(pa_b, r1_ddot):
    return np.sign(r1_ddot) * pa_b


@mistake("r1_ddot", kind="sign")
def a_B_sense(r1_ddot):
    return -r1_ddot


@mistake("alpha3", kind="sign")
def value_sense(alpha3):
    return -alpha3


@mistake("alpha3")
def crank_for_rod(alpha3, r2, r3):
    return alpha3 * r3 / r2


@judge
def drawing(answers, r2, r3, e, theta2, omega2):
    """Any pole and any scale; see :mod:`coursework.drawn`."""
    bars = _bars(r2, r3, e, theta2)
    _, rod, *_ = bars
    of_rod = {"crank_for_rod": ("b'", "b", 1 / r2)}
    asked = DrawingParts(
        scale="ka",
        points={"p": "p_a", "a": "a", "n": "b'", "b": "b"},
        lengths={"bb_t": ("b'", "b"), "pa_b": ("p_a", "b")},
        reads={
            "r1_ddot": Read("p_a", "b", lambda v: v.real, 1.0, sense="a_B_sense"),
            "alpha3": Read("b'", "b", lambda v: (v / (1j * rod)).real, 1 / r3, of_rod),
        },
        sides={("p_a", "a"): "a", ("a", "b'"): "n", ("b'", "b"): "bt", ("p_a", "b"): "pb"},
        hung=frozenset({"n_on_p", "bt_on_a"}),
    )
    return verdicts(answers, _polygon(bars, omega2), asked)


def _polygon(bars, omega2, scale=None):
    crank, rod, ratio, gain = bars
    of_B = _images(bars, omega2)[-1].real
    return polygon_of_accelerations(
        crank_a("A", "OA", crank, omega2),
        slider_a("B", "A", rod, ratio * omega2, gain * omega2**2, "r_3", of_B),
        scale=scale,
    )


def polygons(r2, r3, e, theta2, omega2, ka):
    """At the scale of the answers."""
    return (_polygon(_bars(r2, r3, e, theta2), omega2, ka),)


def residual(r2, r3, e, theta2, omega2, ka, a, n, b, bb_t, pa_b, r1_ddot, alpha3):
    """The piston's abscissa differentiated twice, and B from A."""
    A = r2 * np.exp(1j * np.radians(theta2))
    rise = e - A.imag
    rod = np.sqrt(r3**2 - rise**2) + 1j * rise
    omega3 = -omega2 * A.real / rod.real
    z_a, z_n, z_b = ((q[..., 0] + 1j * q[..., 1]) * ka for q in (a, n, b))
    size = r2 * omega2**2
    reach = rod.real
    # Of the abscissa A.real + reach, reach^2 = r3^2 - rise^2.
    second = -(omega2**2) * (A.real + (A.real**2 + rise * A.imag) / reach + rise**2 * A.real**2 / reach**3)
    return (
        abs(z_a + omega2**2 * A) / size,
        abs(z_n - z_a + omega3**2 * rod) / size,
        abs(z_b - z_n - 1j * alpha3 * rod) / size,
        abs(z_b - r1_ddot) / size,
        abs(r1_ddot - second) / size,
        abs(abs(z_b - z_n) - bb_t * ka) / size,
        abs(abs(z_b) - pa_b * ka) / size,
    )


KNOWN = (
    # Crank upright: a 3-4-5 triangle, the rod in translation at this instant.
    given(r2=30, r3=50, theta2=90, omega2=8).gives(
        ka=50, a=(0, -38.4), n=(0, -38.4), b=(28.8, 0), bb_t=48, pa_b=28.8, r1_ddot=1440, alpha3=48
    ),
    # With an offset, the rod (40, 30): it turns at -4 rad/s, as fast as the crank and the other way.
    given(r2=40, r3=50, e=30, theta2=0, omega2=4).gives(
        ka=20, a=(-32, 0), n=(-64, -24), r1_ddot=-640 - 640 - 12 * 30, alpha3=12
    ),
    # Outer dead centre: the rod turns at 2 rad/s, the other way, and does not accelerate.
    given(r2=40, r3=120, theta2=0, omega2=-6).gives(
        ka=20, a=(-72, 0), n=(-96, 0), bb_t=0, r1_ddot=-1920, alpha3=0
    ),
)
