"""Acceleration polygon of six links: solution. The normal parts are known from the velocities; the tangential
lines of B meet in b, then that of C about B and the guide meet in c."""

import numpy as np

from coursework.figures.polygons import crank_a, polygon_of_accelerations, slider_a, two_bars_a
from coursework.marking.drawn_polygons import (
    DrawingParts,
    Read,
    met,
    off_both,
    scale_for,
    to_paper,
    turned,
    verdicts,
)
from coursework.solution import given, judge, mistake

from ._drawn_acceleration import *
from ._drawn_rocker import *
from ._six_bar import _linkage, _links, _rates

SYMBOLS = {"sense3": "s_3", "way_C": "s_C"}


def _gains(_linkage, _links, _rates, omega2):
    """alpha3, alpha4 and alpha5; C keeps to its line."""
    *_, rocker, rod = _links
    _, _, omega4, omega5 = _rates
    alpha3, alpha4 = _linkage.coupler_gain * omega2**2, _linkage.rocker_gain * omega2**2
    across = ((1j * alpha4 - omega4**2) * rocker).imag - omega5**2 * rod.imag
    return alpha3, alpha4, -across / rod.real


def _images(_links, _rates, _gains):
    """Of A, of b', of b'' and of B, complex."""
    crank, coupler, rocker, _ = _links
    omega2, omega3, omega4, _ = _rates
    of_A = -(omega2**2) * crank
    return (
        of_A,
        of_A - omega3**2 * coupler,
        -(omega4**2) * rocker,
        (1j * _gains[1] - omega4**2) * rocker,
    )


def _slider(_images, _links, _rates, _gains):
    """Acceleration of C, which has no component across its guide."""
    return (_images[3] + (1j * _gains[2] - _rates[3] ** 2) * _links[3]).real + 0j


def _lines(_links):
    _, coupler, rocker, _ = _links
    return 1j * coupler, 1j * rocker


def _start(m):
    """Start of the line of the tangential acceleration of B."""
    return m


def known_C():
    return "direction"


def ka(_images, _rod_normal, _slider):
    """A round scale at which the drawing fills its box."""
    return scale_for(*_images, _images[3] + _rod_normal, _slider)


def _rod_normal(_links, _rates):
    return -(_rates[3] ** 2) * _links[3]


def f(b, _rod_normal, ka):
    return b + to_paper(_rod_normal, ka)


def c(p, f, _links):
    return met(f, 1j * _links[3], p, 1 + 0j)


def bb_t(_links, _gains, ka):
    """Measured on the drawing."""
    return abs(_gains[0] * _links[1]) / ka


def pa_c(_slider, ka):
    """Measured on the drawing."""
    return abs(_slider) / ka


def sense3(_gains):
    """In which the vector b'b, put at B, turns AB: 1 anticlockwise."""
    return np.sign(_gains[0])


def alpha3(sense3, ka, bb_t, r3):
    return sense3 * ka * bb_t / r3


def way_C(_slider):
    """Of c, seen from the pole: 1 on the right, -1 on the left."""
    return np.sign(_slider.real)


def r6_ddot(way_C, ka, pa_c):
    return way_C * ka * pa_c


@mistake("known_BA_n", "known_B_n")
def normal_part_unknown():
    return "direction", "direction"


@mistake("known_BA_t", "known_C")
def direction_not_used():
    return "neither", "neither"


@mistake("f")
def f_length(b, f):
    return b + 1.7 * (f - b)


@mistake("f")
def f_direction(b, f):
    """Square to the rod."""
    return turned(b, f, 90)


@mistake("f", kind="sign")
def f_sense(b, f):
    """From B to C."""
    return 2 * b - f


@mistake("f")
def f_vector(b, f):
    return b + 1.6 * (turned(b, f, 75) - b)


@mistake("f")
def f_on_p(p, b, f):
    return p + f - b


@mistake("c")
def cb_direction(p, f, _links):
    return met(f, 1j * _links[3] * np.exp(-0.35j), p, 1 + 0j)


@mistake("c")
def pc_direction(p, f, _links):
    return met(f, 1j * _links[3], p, np.exp(-0.35j))


@mistake("c", kind="sign")
def cb_sense(f, c):
    return 2 * f - c


@mistake("c", kind="sign")
def pc_sense(p, c):
    return 2 * p - c


@mistake("c")
def cb_on_b(p, b, _links):
    """The normal part of C about B left out."""
    return met(b, 1j * _links[3], p, 1 + 0j)


@mistake("c")
def c_vector(f, c, _links):
    return off_both(c, (1j * _links[3], 1 + 0 * _links[3]), f)


@mistake("bb_t", "pa_c")
def lengths_exchanged(bb_t, pa_c):
    return pa_c, bb_t


@mistake("ka", "p", "a", "n", "m", "b", "f", "c")
def too_small(ka, p, a, n, m, b, f, c):
    return 10 * ka, p / 10, a / 10, n / 10, m / 10, b / 10, f / 10, c / 10


_ALL = ("ka", "p", "a", "n", "m", "b", "f", "c", "bb_t", "pa_c", "alpha3", "r6_ddot")


@mistake(*_ALL, kind="inverse")
def scale_upside_down(ka, p, a, n, m, b, f, c, bb_t, pa_c, alpha3, r6_ddot):
    """The drawing is right."""
    return 1 / ka, p, a, n, m, b, f, c, bb_t, pa_c, alpha3, r6_ddot


@mistake(*_ALL)
def scale_not_drawn(ka, p, a, n, m, b, f, c, bb_t, pa_c, alpha3, r6_ddot):
    """Stated at one value, drawn at another."""
    return 2 * ka, p, a, n, m, b, f, c, bb_t, pa_c, alpha3, r6_ddot


@mistake("r6_ddot")
def scale_forgotten(pa_c, r6_ddot):
    return np.sign(r6_ddot) * pa_c


@mistake("r6_ddot", kind="sign")
def a_C_sense(r6_ddot):
    return -r6_ddot


@mistake("alpha3", kind="sign")
def value_sense(alpha3):
    return -alpha3


@mistake("alpha3")
def alpha3_of_a_B(alpha3, _images, r3):
    """The whole acceleration of B, where the tangential part about A is meant."""
    return np.sign(alpha3) * abs(_images[3]) / r3


@judge
def drawing(answers, r1, r2, r3, r4, r5, theta2, omega2, mode):
    """Any pole and any scale; see :mod:`coursework.figures.polygons.hand_drawn`."""
    linkage = _linkage(r1, r2, r3, r4, mode, theta2)
    links = _links(linkage, r2, r3, r4, r5, theta2)
    rates = _rates(linkage, links, omega2)
    coupler, whole = links[1], {"alpha3_of_a_B": ("p_a", "b", 1 / r3)}
    asked = DrawingParts(
        scale="ka",
        points={"p": "p_a", "a": "a", "n": "b'", "m": "b''", "b": "b", "f": "c'", "c": "c"},
        lengths={"bb_t": ("b'", "b"), "pa_c": ("p_a", "c")},
        reads={
            "alpha3": Read("b'", "b", lambda v: (v / (1j * coupler)).real, 1 / r3, whole),
            "r6_ddot": Read("p_a", "c", lambda v: v.real, 1.0, sense="a_C_sense"),
        },
        sides={
            ("p_a", "a"): "a",
            ("a", "b'"): "n",
            ("p_a", "b''"): "m",
            ("b'", "b"): "bt",
            ("b''", "b"): "ct",
            ("b", "c'"): "f",
            ("c'", "c"): "cb",
            ("p_a", "c"): "pc",
        },
        hung=frozenset({"n_on_p", "m_on_a", "bt_on_a", "ct_on_p", "f_on_p", "cb_on_b"}),
    )
    return verdicts(answers, _polygon(links, rates, _gains(linkage, links, rates, omega2)), asked)


def _polygon(links, rates, gains, scale=None):
    crank, coupler, rocker, rod = links
    omega2, omega3, omega4, omega5 = rates
    alpha3, alpha4, alpha5 = gains
    a_C = _slider(_images(links, rates, gains), links, rates, gains).real
    return polygon_of_accelerations(
        crank_a("A", "OA", crank, omega2),
        two_bars_a("B", "A", "D", coupler, omega3, alpha3, "r_3", rocker, omega4, alpha4, "r_4"),
        slider_a("C", "B", rod, omega5, alpha5, "r_5", a_C),
        scale=scale,
    )


def polygons(_links, _rates, _gains, ka):
    """At the scale of the answers."""
    return (_polygon(_links, _rates, _gains, ka),)


def residual(r1, r2, r3, r4, r5, theta2, omega2, mode, ka, a, n, m, b, f, c, bb_t, pa_c, alpha3, r6_ddot):
    """The loop O, A, B, D closed by the law of cosines; rates and accelerations of both loops as linear
    equations."""
    A = 1j * r1 + r2 * np.exp(1j * np.radians(theta2))
    OA = A - 1j * r1
    corner = np.arccos((abs(A) ** 2 + r3**2 - r4**2) / (2 * abs(A) * r3))
    AB = -r3 * A / abs(A) * np.exp(1j * np.where(mode == "open", 1, -1) * corner)
    DB = A + AB
    BC = np.sqrt(r5**2 - DB.imag**2) - 1j * DB.imag
    area = (np.conj(AB) * DB).imag
    omega3 = -omega2 * (np.conj(OA) * DB).imag / area
    omega4 = -omega2 * (np.conj(AB) * OA).imag / -area
    omega5 = -omega4 * DB.real / BC.real
    z_a, z_n, z_m, z_b, z_f, z_c = ((z[..., 0] + 1j * z[..., 1]) * ka for z in (a, n, m, b, f, c))
    size = abs(z_b) + abs(z_n) + abs(z_c)
    return (
        abs(z_a + omega2**2 * OA) / size,
        abs(z_n - z_a + omega3**2 * AB) / size,
        abs(z_m + omega4**2 * DB) / size,
        abs(z_b - z_n - 1j * alpha3 * AB) / size,
        abs(((z_b - z_m) / DB).real) * r4 / size,
        abs(z_f - z_b + omega5**2 * BC) / size,
        abs(((z_c - z_f) / BC).real) * r5 / size,
        abs(z_c - r6_ddot) / size,
        abs(abs(z_b - z_n) - bb_t * ka) / size,
        abs(abs(z_c) - pa_c * ka) / size,
    )


KNOWN = (
    # Coupler parallel to the crank: only AB turns, at -3 rad/s.
    given(r1=120, r2=40, r3=120, r4=200, r5=312, theta2=0, omega2=9, mode="open").gives(
        alpha3=48, r6_ddot=-6720, m=(0, 0)
    ),
)
