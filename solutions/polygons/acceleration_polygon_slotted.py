"""Acceleration polygon of a slotted mechanism: solution. A4 of the guide goes round O4; A2, which slides over
it, has the Coriolis acceleration besides, known from the velocities. The two accelerations of which only the
direction is known meet in a4."""

import numpy as np

from coursework.figures.polygons import crank_a, guide_a, polygon_of_accelerations
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

from ._drawn_start import *
from ._slotted import *
from ._slotted import _guide, _vectors

UNITS = {"rA": "mm"}
SYMBOLS = {"rA": "r_A", "way": "s", "sense4": "s_4"}


def _terms(_guide, _vectors, rA, omega2):
    """Accelerations of A2; Coriolis; of A4, normal then tangential; along the guide. Complex."""
    crank, along = _vectors
    square = omega2**2
    return (
        -square * crank,
        2j * _guide.guide_ratio * _guide.sliding_ratio * square * along,
        -(_guide.guide_ratio**2) * square * rA * along,
        1j * _guide.guide_gain * square * rA * along,
        _guide.sliding_gain * square * along,
    )


def _images(_terms):
    """Of A2, of k, of A4's normal acceleration and of A4, complex."""
    of_A2, coriolis, normal, tangential, _ = _terms
    return of_A2, of_A2 - coriolis, normal, normal + tangential


def known_c():
    return "both"


def known_s():
    return "direction"


def known_n():
    return "both"


def known_t():
    return "direction"


def ka(_images):
    """A round scale at which the drawing fills its box."""
    return scale_for(*_images)


def a(_images, ka):
    return to_paper(_images[0], ka)


def k(_images, ka):
    return to_paper(_images[1], ka)


def n(_images, ka):
    return to_paper(_images[2], ka)


def b(_vectors, k, n):
    _, along = _vectors
    return met(k, along, n, 1j * along)


def bk(_terms, ka):
    """Measured on the drawing."""
    return abs(_terms[4]) / ka


def nb_t(_terms, ka):
    """Measured on the drawing."""
    return abs(_terms[3]) / ka


def way(_guide):
    """Of the vector a4 k: +1 away from O4."""
    return np.sign(_guide.sliding_gain)


def rA_ddot(way, ka, bk):
    return way * ka * bk


def sense4(_guide):
    """In which the tangential vector, put at A, turns O4A: 1 anticlockwise."""
    return np.sign(_guide.guide_gain)


def alpha4(sense4, ka, nb_t, rA):
    return sense4 * ka * nb_t / rA


@mistake("known_c", "known_n")
def velocities_not_used():
    return "direction", "direction"


@mistake("known_s", "known_t")
def direction_not_used():
    return "neither", "neither"


@mistake("k")
def k_length(a, k):
    """Without the factor 2."""
    return a + 0.5 * (k - a)


@mistake("k")
def k_direction(a, k):
    """Along the guide."""
    return turned(a, k, 90)


@mistake("k", kind="sign")
def k_sense(a, k):
    """On the other side of a2: the sense of the Coriolis acceleration."""
    return 2 * a - k


@mistake("k")
def k_vector(a, k):
    return a + 1.6 * (turned(a, k, 75) - a)


@mistake("k")
def k_on_p(p, a, k):
    return p + k - a


@mistake("n")
def n_length(p, n):
    return p + 1.7 * (n - p)


@mistake("n")
def n_direction(p, n):
    """Square to the guide."""
    return turned(p, n, 90)


@mistake("n", kind="sign")
def n_sense(p, n):
    return 2 * p - n


@mistake("n")
def n_vector(p, n):
    return p + 1.6 * (turned(p, n, 75) - p)


@mistake("n")
def n_on_a(p, a, n):
    return a + n - p


@mistake("b")
def s_direction(_vectors, k, n):
    """On the other line, but not along the guide from k."""
    _, along = _vectors
    return met(k, along * np.exp(-0.35j), n, 1j * along)


@mistake("b")
def t_direction(_vectors, k, n):
    _, along = _vectors
    return met(k, along, n, 1j * along * np.exp(-0.35j))


@mistake("b", kind="sign")
def s_sense(b, k):
    return 2 * k - b


@mistake("b", kind="sign")
def t_sense(b, n):
    return 2 * n - b


@mistake("b")
def s_on_a(_vectors, a, n):
    """The Coriolis acceleration left out."""
    _, along = _vectors
    return met(a, along, n, 1j * along)


@mistake("b")
def t_on_p(_vectors, k, p):
    """The normal acceleration of A4 left out."""
    _, along = _vectors
    return met(k, along, p, 1j * along)


@mistake("b")
def b_vector(_vectors, b, k):
    _, along = _vectors
    return off_both(b, (along, 1j * along), k)


@mistake("bk", "nb_t")
def lengths_exchanged(bk, nb_t):
    return nb_t, bk


@mistake("ka", "p", "a", "k", "n", "b")
def too_small(ka, p, a, k, n, b):
    return 10 * ka, p / 10, a / 10, k / 10, n / 10, b / 10


@mistake("ka", "p", "a", "k", "n", "b", "bk", "nb_t", "rA_ddot", "alpha4", kind="inverse")
def scale_upside_down(ka, p, a, k, n, b, bk, nb_t, rA_ddot, alpha4):
    """The drawing is right."""
    return 1 / ka, p, a, k, n, b, bk, nb_t, rA_ddot, alpha4


@mistake("ka", "p", "a", "k", "n", "b", "bk", "nb_t", "rA_ddot", "alpha4")
def scale_not_drawn(ka, p, a, k, n, b, bk, nb_t, rA_ddot, alpha4):
    """Stated at one value, drawn at another."""
    return 2 * ka, p, a, k, n, b, bk, nb_t, rA_ddot, alpha4


@mistake("rA_ddot")
def scale_forgotten(bk, rA_ddot):
    return np.sign(rA_ddot) * bk


@mistake("rA_ddot", kind="sign")
def sliding_sense(rA_ddot):
    return -rA_ddot


@mistake("alpha4", kind="sign")
def value_sense(alpha4):
    return -alpha4


@mistake("alpha4")
def alpha4_of_A4(alpha4, _images, rA):
    """The whole acceleration of A4, where its tangential part is meant."""
    return np.sign(alpha4) * abs(_images[-1]) / rA


@judge
def drawing(answers, r1, r2, theta2, omega2):
    """Any pole and any scale; see :mod:`coursework.figures.polygons.hand_drawn`."""
    guide = _guide(r1, r2, theta2)
    _, along = vectors = _vectors(guide, r2, theta2)
    whole = {"alpha4_of_A4": ("p_a", "a_4", 1 / guide.arm)}
    asked = DrawingParts(
        scale="ka",
        points={"p": "p_a", "a": "a_2", "k": "k", "n": "a_4'", "b": "a_4"},
        lengths={"bk": ("a_4", "k"), "nb_t": ("a_4'", "a_4")},
        reads={
            "rA_ddot": Read("a_4", "k", lambda v: (v / along).real, 1.0, sense="sliding_sense"),
            "alpha4": Read(
                "a_4'", "a_4", lambda v: (v / (1j * guide.arm * along)).real, 1 / guide.arm, whole
            ),
        },
        sides={
            ("p_a", "a_2"): "a",
            ("k", "a_2"): "k",
            ("p_a", "a_4'"): "n",
            ("a_4", "k"): "s",
            ("a_4'", "a_4"): "t",
        },
        hung=frozenset({"k_on_p", "n_on_a", "s_on_a", "t_on_p"}),
    )
    return verdicts(answers, _polygon(guide, vectors, guide.arm, omega2), asked)


def _polygon(guide, vectors, arm, omega2, scale=None):
    crank, along = vectors
    omega4, sliding = guide.guide_ratio * omega2, guide.sliding_ratio * omega2
    alpha4, gain = guide.guide_gain * omega2**2, guide.sliding_gain * omega2**2
    return polygon_of_accelerations(
        crank_a("A_2", "O_2A", crank, omega2),
        guide_a("A_2", "A_4", "O_4A", arm * along, omega4, alpha4, sliding, gain, "r_A", r"\omega_4"),
        scale=scale,
    )


def polygons(_guide, _vectors, rA, omega2, ka):
    """At the scale of the answers."""
    return (_polygon(_guide, _vectors, rA, omega2, ka),)


def residual(r1, r2, theta2, omega2, ka, a, k, n, b, bk, nb_t, rA_ddot, alpha4):
    """The arm r e^(i theta), differentiated twice in polar coordinates, is the acceleration of the pin."""
    crank = r2 * np.exp(1j * np.radians(theta2))
    arm = 1j * r1 + crank
    along = arm / abs(arm)
    velocity = 1j * omega2 * crank / along
    sliding, omega4 = velocity.real, velocity.imag / abs(arm)
    z_a, z_k, z_n, z_b = ((q[..., 0] + 1j * q[..., 1]) * ka for q in (a, k, n, b))
    size = r2 * omega2**2 + abs(arm) * omega4**2 + abs(2 * omega4 * sliding)
    polar_ = (rA_ddot - abs(arm) * omega4**2 + 1j * (abs(arm) * alpha4 + 2 * sliding * omega4)) * along
    return (
        abs(z_a + omega2**2 * crank) / size,
        abs(polar_ - z_a) / size,
        abs(z_a - z_k - 2j * omega4 * sliding * along) / size,
        abs(z_n + omega4**2 * arm) / size,
        abs(z_b - (1j * alpha4 - omega4**2) * arm) / size,
        abs(z_k - z_b - rA_ddot * along) / size,
        abs(abs(z_k - z_b) - bk * ka) / size,
        abs(abs(z_b - z_n) - nb_t * ka) / size,
    )


KNOWN = (
    # Crank square to the frame: O4A is the hypotenuse of a 3-4-5 triangle, of slope 3/4; omega4 = 3.2,
    # sliding at 480.
    given(r1=120, r2=160, theta2=0, omega2=5).gives(
        ka=50,
        a=(-80, 0),
        k=(-80 + 61.44 * 0.6, -61.44 * 0.8),
        n=(-40.96 * 0.8, -40.96 * 0.6),
        rA_ddot=-3200 + 2048,
        alpha4=(2400 - 3072) / 200,
    ),
    # The guide at the end of its swing stands still: no Coriolis term, no normal one.
    given(r1=200, r2=120, theta2=-36.86989764584402, omega2=-4).gives(
        n=(0, 0),
        bk=0,
        rA_ddot=0,
        alpha4=12,
    ),
)
