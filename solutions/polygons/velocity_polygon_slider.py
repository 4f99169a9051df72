"""Velocity polygon of a slider-crank: solution. A, whose velocity is known, and B, which the guide keeps on
its line."""

import numpy as np

from coursework.degrees import polar
from coursework.figures.polygons import crank_v, polygon_of_velocities, slider_v
from coursework.kinematics.angles import Degrees
from coursework.kinematics.slider_crank import SliderCrank
from coursework.marking.drawn_polygons import DrawingParts, Read, verdicts
from coursework.solution import given, judge, mistake

from ._drawn_velocity import *

SYMBOLS = {"way_B": r"\varepsilon_B", "turn_3": r"\varepsilon_3"}


def _bars(r2, r3, e, theta2):
    """Vectors OA and AB; the rate of AB over that of OA."""
    pin = polar(r2, theta2)
    reach = SliderCrank(r2, r3, e).run(Degrees(theta2))
    return pin, reach + 1j * (e - pin.imag), -pin.real / reach


def _images(_bars, omega2):
    """Velocities of A and B, complex; that of B has no part across the guide."""
    crank, rod, ratio = _bars
    v_A = 1j * omega2 * crank
    return v_A, (v_A + 1j * ratio * omega2 * rod).real + 0j


def _lines(_bars):
    _, rod, _ = _bars
    return 1j * rod, 1 + 0j


def way_B(_images):
    """Of the piston: +1 to the right."""
    _, v_B = _images
    return np.sign(v_B.real)


def r1_dot(way_B, kv, pv_b):
    return way_B * kv * pv_b


def turn_3(_bars, omega2):
    """Of the rod: +1 anticlockwise."""
    *_, ratio = _bars
    return np.sign(ratio * omega2)


def omega3(turn_3, kv, ab, r3):
    return turn_3 * kv * ab / r3


@mistake("known_BA")
def nothing_known_of_BA():
    return "neither"


@mistake("known_B")
def nothing_known_of_B():
    return "neither"


@mistake("r1_dot")
def scale_forgotten(pv_b, r1_dot):
    return np.sign(r1_dot) * pv_b


@mistake("r1_dot", kind="sign")
def V_B_sense(r1_dot):
    return -r1_dot


@mistake("omega3", kind="sign")
def value_sense(omega3):
    return -omega3


@mistake("omega3")
def crank_for_rod(omega3, r2, r3):
    return omega3 * r3 / r2


@mistake("omega3")
def omega3_of_V_B(kv, pv_b, r3, omega3):
    """The absolute velocity of B, where that about A is meant."""
    return np.sign(omega3) * kv * pv_b / r3


@judge
def drawing(answers, r2, r3, e, theta2, omega2):
    """Any pole and any scale; see :mod:`coursework.drawn`."""
    bars = _bars(r2, r3, e, theta2)
    _, rod, _ = bars
    of_rod = {"crank_for_rod": ("a", "b", 1 / r2), "omega3_of_V_B": ("p_v", "b", 1 / r3)}
    asked = DrawingParts(
        scale="kv",
        points={"p": "p_v", "a": "a", "b": "b"},
        lengths={"ab": ("a", "b"), "pv_b": ("p_v", "b")},
        reads={
            "r1_dot": Read("p_v", "b", lambda v: v.real, 1.0, sense="V_B_sense"),
            "omega3": Read("a", "b", lambda v: (v / (1j * rod)).real, 1 / r3, of_rod),
        },
        sides={("p_v", "a"): "a", ("a", "b"): "ba", ("p_v", "b"): "vb"},
        hung=frozenset({"ba_on_p"}),
    )
    return verdicts(answers, _polygon(bars, omega2), asked)


def _polygon(bars, omega2, scale=None):
    crank, rod, ratio = bars
    v_B = _images(bars, omega2)[1].real
    return polygon_of_velocities(
        crank_v("A", "OA", crank, omega2), slider_v("B", "A", rod, ratio * omega2, v_B), scale=scale
    )


def polygons(r2, r3, e, theta2, omega2, kv):
    """At the scale of the answers."""
    return (_polygon(_bars(r2, r3, e, theta2), omega2, kv),)


def residual(r2, r3, e, theta2, omega2, kv, a, b, ab, pv_b, r1_dot, omega3):
    """The rod turned as a complex exponential; b on the guide, at its rate from a."""
    A = r2 * np.exp(1j * np.radians(theta2))
    rod = r3 * np.exp(-1j * np.arcsin((A.imag - e) / r3))
    z_a, z_b = (q[..., 0] + 1j * q[..., 1] for q in (a, b))
    size = r2 * abs(omega2)
    return (
        abs(z_a * kv - 1j * omega2 * A) / size,
        abs(z_b * kv - r1_dot) / size,
        abs(z_b * kv - 1j * (omega2 * A + omega3 * rod)) / size,
        abs(abs(z_b - z_a) - ab) * kv / size,
        abs(abs(z_b) - pv_b) * kv / size,
    )


KNOWN = (
    # Crank upright: the rod translates, and the piston goes left at the speed of the pin.
    given(r2=30, r3=50, theta2=90, omega2=8).gives(
        kv=2, a=(-120, 0), b=(-120, 0), ab=0, pv_b=120, r1_dot=-240, omega3=0
    ),
    # With an offset, crank upright and the rod (40, 30): it translates all the same.
    given(r2=30, r3=50, e=60, theta2=90, omega2=8).gives(b=(-120, 0), ab=0, r1_dot=-240, omega3=0),
    # With an offset, crank level and the rod (40, 30): it turns as fast as the crank, the other way.
    given(r2=40, r3=50, e=30, theta2=0, omega2=4).gives(
        kv=2, a=(0, 80), b=(60, 0), ab=100, pv_b=60, r1_dot=120, omega3=-4
    ),
    # Rod and crank equal: an isosceles triangle, r1 = 2 r2 cos theta2.
    given(r2=100, r3=100, theta2=60, omega2=5).gives(
        kv=10, r1_dot=-500 * 3**0.5, omega3=-5, ab=50, pv_b=50 * 3**0.5
    ),
)
