"""Velocity polygon of six links: solution. B is on two bars, as in a four-bar linkage; C is on the rod and on
its guide."""

import numpy as np

from coursework.figures.polygons import crank_v, polygon_of_velocities, slider_v, two_bars_v
from coursework.marking.drawn_polygons import DrawingParts, Read, met, off_both, scale_for, verdicts
from coursework.solution import given, judge, mistake

from ._drawn_velocity import *
from ._six_bar import _linkage, _links, _rates

SYMBOLS = {
    "turn_3": r"\varepsilon_3",
    "turn_4": r"\varepsilon_4",
    "turn_5": r"\varepsilon_5",
    "way_C": r"\varepsilon_C",
}


def _images(_links, _rates):
    """Velocities of A and B, complex."""
    crank, _, rocker, _ = _links
    return 1j * _rates[0] * crank, 1j * _rates[2] * rocker


def _slider(_images, _links, _rates):
    """Velocity of C, which has no component across its guide."""
    return (_images[1] + 1j * _rates[3] * _links[3]).real + 0j


def _lines(_links):
    _, coupler, rocker, _ = _links
    return 1j * coupler, 1j * rocker


def known_CB():
    return "direction"


def known_C():
    return "direction"


def kv(_images, _slider):
    """A round scale at which the drawing fills its box."""
    return scale_for(*_images, _slider)


def c(p, b, _links):
    return met(b, 1j * _links[3], p, 1 + 0j)


def bc(_links, _rates, kv):
    """Measured on the drawing."""
    return abs(_rates[3] * _links[3]) / kv


def pv_c(_slider, kv):
    """Measured on the drawing."""
    return abs(_slider) / kv


def turn_3(_rates):
    """Of the coupler: +1 anticlockwise."""
    return np.sign(_rates[1])


def omega3(turn_3, kv, ab, r3):
    return turn_3 * kv * ab / r3


def turn_4(_rates):
    """Of the rocker: +1 anticlockwise."""
    return np.sign(_rates[2])


def omega4(turn_4, kv, pv_b, r4):
    return turn_4 * kv * pv_b / r4


def turn_5(_rates):
    """Of the rod: +1 anticlockwise."""
    return np.sign(_rates[3])


def omega5(turn_5, kv, bc, r5):
    return turn_5 * kv * bc / r5


def way_C(_slider):
    """Of the slider: +1 to the right."""
    return np.sign(_slider.real)


def r6_dot(way_C, kv, pv_c):
    return way_C * kv * pv_c


@mistake("known_BA", "known_CB")
def nothing_known_of_a_bar():
    return "neither", "neither"


@mistake("known_B", "known_C")
def nothing_known_of_a_path():
    return "neither", "neither"


@mistake("c")
def cb_direction(p, b, _links):
    return met(b, 1j * _links[3] * np.exp(-0.35j), p, 1 + 0j)


@mistake("c")
def vc_direction(p, b, _links):
    return met(b, 1j * _links[3], p, np.exp(-0.35j))


@mistake("c", kind="sign")
def cb_sense(b, c):
    return 2 * b - c


@mistake("c", kind="sign")
def vc_sense(p, c):
    return 2 * p - c


@mistake("c")
def cb_on_a(p, a, _links):
    """The rod's line drawn through the image of A."""
    return met(a, 1j * _links[3], p, 1 + 0j)


@mistake("c")
def c_vector(b, c, _links):
    return off_both(c, (1j * _links[3], 1 + 0 * _links[3]), b)


@mistake("ab", "pv_b", "bc", "pv_c")
def lengths_exchanged(ab, pv_b, bc, pv_c):
    return pv_b, ab, pv_c, bc


@mistake("kv", "p", "a", "b", "c")
def too_small(kv, p, a, b, c):
    return 10 * kv, p / 10, a / 10, b / 10, c / 10


@mistake("kv", "p", "a", "b", "c", "ab", "pv_b", "bc", "pv_c", kind="inverse")
def scale_upside_down(kv, p, a, b, c, ab, pv_b, bc, pv_c):
    """The drawing is right."""
    return 1 / kv, p, a, b, c, ab, pv_b, bc, pv_c


@mistake("r6_dot")
def scale_forgotten(pv_c, r6_dot):
    return np.sign(r6_dot) * pv_c


@mistake("r6_dot", kind="sign")
def V_C_sense(r6_dot):
    return -r6_dot


@mistake("omega3", "omega4", "omega5", kind="sign")
def value_sense(omega3, omega4, omega5):
    return -omega3, -omega4, -omega5


@mistake("omega3", "omega5")
def rate_of_absolute_velocity(kv, pv_b, pv_c, r3, r5, omega3, omega5):
    """The absolute velocity of B or C, where that about the other end of the bar is meant."""
    return np.sign(omega3) * kv * pv_b / r3, np.sign(omega5) * kv * pv_c / r5


@judge
def drawing(answers, r1, r2, r3, r4, r5, theta2, omega2, mode):
    """Any pole and any scale; see :mod:`coursework.figures.polygons.hand_drawn`."""
    linkage = _linkage(r1, r2, r3, r4, mode, theta2)
    _, coupler, rocker, rod = links = _links(linkage, r2, r3, r4, r5, theta2)
    absolute = "rate_of_absolute_velocity"
    asked = DrawingParts(
        scale="kv",
        points={"p": "p_v", "a": "a", "b": "b", "c": "c"},
        lengths={"ab": ("a", "b"), "pv_b": ("p_v", "b"), "bc": ("b", "c"), "pv_c": ("p_v", "c")},
        reads={
            "omega3": Read(
                "a", "b", lambda v: (v / (1j * coupler)).real, 1 / r3, {absolute: ("p_v", "b", 1 / r3)}
            ),
            "omega4": Read("p_v", "b", lambda v: (v / (1j * rocker)).real, 1 / r4),
            "omega5": Read(
                "b", "c", lambda v: (v / (1j * rod)).real, 1 / r5, {absolute: ("p_v", "c", 1 / r5)}
            ),
            "r6_dot": Read("p_v", "c", lambda v: v.real, 1.0, sense="V_C_sense"),
        },
        sides={
            ("p_v", "a"): "a",
            ("a", "b"): "ba",
            ("p_v", "b"): "vb",
            ("b", "c"): "cb",
            ("p_v", "c"): "vc",
        },
        hung=frozenset({"ba_on_p", "cb_on_a"}),
    )
    return verdicts(answers, _polygon(links, _rates(linkage, links, omega2)), asked)


def _polygon(links, rates, scale=None):
    crank, coupler, rocker, rod = links
    omega2, omega3, omega4, omega5 = rates
    v_C = _slider(_images(links, rates), links, rates).real
    return polygon_of_velocities(
        crank_v("A", "OA", crank, omega2),
        two_bars_v("B", "A", "D", coupler, omega3, rocker, omega4),
        slider_v("C", "B", rod, omega5, v_C),
        scale=scale,
    )


def polygons(_links, _rates, kv):
    """At the scale of the answers."""
    return (_polygon(_links, _rates, kv),)


def residual(
    r1, r2, r3, r4, r5, theta2, omega2, mode, kv, a, b, c, ab, pv_b, bc, pv_c, omega3, omega4, omega5, r6_dot
):
    """The loop O, A, B, D closed by the law of cosines; b from a and from the pole, c from b by the rates."""
    A = 1j * r1 + r2 * np.exp(1j * np.radians(theta2))
    corner = np.arccos((abs(A) ** 2 + r3**2 - r4**2) / (2 * abs(A) * r3))
    AB = -r3 * A / abs(A) * np.exp(1j * np.where(mode == "open", 1, -1) * corner)
    DB = A + AB
    BC = np.sqrt(r5**2 - DB.imag**2) - 1j * DB.imag
    z_a, z_b, z_c = ((z[..., 0] + 1j * z[..., 1]) * kv for z in (a, b, c))
    size = r2 * abs(omega2)
    return (
        abs(z_a - 1j * omega2 * (A - 1j * r1)) / size,
        abs(z_b - z_a - 1j * omega3 * AB) / size,
        abs(z_b - 1j * omega4 * DB) / size,
        abs(z_c - z_b - 1j * omega5 * BC) / size,
        abs(z_c - r6_dot) / size,
        abs(abs(z_b - z_a) - ab * kv) / size,
        abs(abs(z_b) - pv_b * kv) / size,
        abs(abs(z_c - z_b) - bc * kv) / size,
        abs(abs(z_c) - pv_c * kv) / size,
    )


KNOWN = (
    # Coupler parallel to the crank: the rocker stands still, and so does all that follows it.
    given(r1=120, r2=40, r3=120, r4=200, r5=312, theta2=0, omega2=9, mode="open").gives(
        kv=5, a=(0, 72), b=(0, 0), c=(0, 0), ab=72, pv_b=0, bc=0, pv_c=0, omega3=-3, omega4=0, r6_dot=0
    ),
    # The same crank, B mirrored in the line AD: B = (-56, 192), the rod parallel to the coupler.
    given(r1=120, r2=40, r3=120, r4=200, r5=320, theta2=0, omega2=15, mode="crossed").gives(
        omega3=8, omega4=3, omega5=21 / 32, r6_dot=-450, b=(-57.6, -16.8), c=(-45, 0)
    ),
)
