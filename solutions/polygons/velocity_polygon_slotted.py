"""Velocity polygon of a slotted mechanism: solution. A2 of the crank, whose velocity is known, and A4 of the
guide, over which it slides along the slot."""

import numpy as np

from coursework.figures.polygons import crank_v, guide_v, polygon_of_velocities
from coursework.marking.drawn_polygons import DrawingParts, Read, verdicts
from coursework.solution import given, judge, mistake, stable

from ._drawn_velocity import *
from ._slotted import *
from ._slotted import _guide, _vectors

UNITS = {"rA": "mm"}
SYMBOLS = {"rA": "r_A", "way": r"\varepsilon", "turn_4": r"\varepsilon_4"}


def _rates(_guide, omega2):
    """omega4, and the rate at which A2 slides away from O4."""
    return _guide.guide_ratio * omega2, _guide.sliding_ratio * omega2


def _images(_vectors, _rates, rA, omega2):
    """Velocities of A2 and A4, complex."""
    crank, along = _vectors
    return 1j * omega2 * crank, 1j * _rates[0] * rA * along


def _lines(_vectors):
    _, along = _vectors
    return along, 1j * along


@stable(lambda _rates, kv: abs(_rates[1]) / kv)
def ab(_images, kv):
    """Measured on the drawing."""
    v_A, v_B = _images
    return abs(v_B - v_A) / kv


def way(_rates):
    """Of the sliding: +1 away from O4."""
    return np.sign(_rates[1])


@stable(lambda _rates: _rates[1])
def rA_dot(way, kv, ab):
    return way * kv * ab


def turn_4(_rates):
    """Of the guide: +1 anticlockwise."""
    return np.sign(_rates[0])


def omega4(turn_4, kv, pv_b, rA):
    return turn_4 * kv * pv_b / rA


@mistake("known_BA")
def nothing_known_of_sliding():
    return "neither"


@mistake("known_B")
def A4_moves_with_the_crank():
    """As if A2 and A4 had one velocity."""
    return "both"


@mistake("rA_dot")
def scale_forgotten(ab, rA_dot):
    return np.sign(rA_dot) * ab


@mistake("rA_dot", kind="sign")
def sliding_sense(rA_dot):
    return -rA_dot


@mistake("omega4", kind="sign")
def value_sense(omega4):
    return -omega4


@mistake("omega4")
def crank_for_guide(omega4, r2, rA):
    return omega4 * rA / r2


@mistake("omega4")
def omega4_of_A2(omega4, omega2, r2, rA):
    """The velocity of the crank's point, where that of the guide's is meant."""
    return np.sign(omega4) * abs(omega2) * r2 / rA


@judge
def drawing(answers, r1, r2, theta2, omega2):
    """Any pole and any scale; see :mod:`coursework.figures.polygons.hand_drawn`."""
    guide = _guide(r1, r2, theta2)
    _, along = vectors = _vectors(guide, r2, theta2)
    arm = guide.arm
    of_guide = {"crank_for_guide": ("p_v", "a_4", 1 / r2), "omega4_of_A2": ("p_v", "a_2", 1 / arm)}
    asked = DrawingParts(
        scale="kv",
        points={"p": "p_v", "a": "a_2", "b": "a_4"},
        lengths={"ab": ("a_4", "a_2"), "pv_b": ("p_v", "a_4")},
        reads={
            "rA_dot": Read("a_4", "a_2", lambda v: (v / along).real, 1.0, sense="sliding_sense"),
            "omega4": Read("p_v", "a_4", lambda v: (v / (1j * arm * along)).real, 1 / arm, of_guide),
        },
        sides={("p_v", "a_2"): "a", ("a_4", "a_2"): "ba", ("p_v", "a_4"): "vb"},
        hung=frozenset({"ba_on_p"}),
    )
    return verdicts(answers, _polygon(vectors, _rates(guide, omega2), arm, omega2), asked)


def _polygon(vectors, rates, arm, omega2, scale=None):
    crank, along = vectors
    omega4, sliding = rates
    turning_, sliding_ = guide_v("A_2", "A_4", "O_4A", arm * along, omega4, sliding)
    return polygon_of_velocities(crank_v("A_2", "O_2A", crank, omega2), (sliding_, turning_), scale=scale)


def polygons(_vectors, _rates, rA, omega2, kv):
    """At the scale of the answers."""
    return (_polygon(_vectors, _rates, rA, omega2, kv),)


def residual(r1, r2, theta2, omega2, kv, a, b, ab, pv_b, rA_dot, omega4):
    """The arm differentiated as a vector, projected on itself and across."""
    crank = r2 * np.exp(1j * np.radians(theta2))
    arm = 1j * r1 + crank
    velocity = 1j * omega2 * crank
    z_a, z_b = ((q[..., 0] + 1j * q[..., 1]) * kv for q in (a, b))
    size = r2 * abs(omega2)
    return (
        abs(z_a - velocity) / size,
        abs(z_b - 1j * omega4 * arm) / size,
        abs(z_a - z_b - rA_dot * arm / abs(arm)) / size,
        abs(abs(z_a - z_b) - ab * kv) / size,
        abs(abs(z_b) - pv_b * kv) / size,
    )


KNOWN = (
    # Crank square to the frame: O4A is the hypotenuse of a 3-4-5 triangle.
    given(r1=120, r2=160, theta2=0, omega2=5).gives(
        kv=10, a=(0, 80), b=(-38.4, 51.2), ab=48, pv_b=64, rA_dot=480, omega4=3.2
    ),
    # The guide at the end of its swing: the crank is square to it, and A4 stands still.
    given(r1=200, r2=120, theta2=-36.86989764584402, omega2=-4).gives(
        b=(0, 0), pv_b=0, omega4=0, rA_dot=-480
    ),
)
