"""Crank and slotted lever on paper: solution. P slides along the lever OD, whose end D drives the ram E by
the rod DE; each polygon finds the lever first, then, by the image of D, the ram.

The accelerations are judged against the velocities that the student has drawn, where these are not the right
ones.
"""

from typing import Any, NamedTuple

import numpy as np

from coursework.degrees import acos, asin, from_radians, polar, wrap
from coursework.figures import Figure, circle, ground_pivot, line, link, pin, point, rotation_arrow
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    guide_a,
    guide_v,
    image,
    polygon_of_accelerations,
    polygon_of_velocities,
    slider_a,
    slider_v,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.slider_crank import SliderCrank
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
from coursework.solution import Judged, given, judge, mistake, stable

from ..quick_return._swinging import *
from ._slotted import _guide

UNITS = {"rA": "mm", "sigma": "deg", "stroke": "mm"}
SYMBOLS = {
    "rA": "OP",
    "way": r"\varepsilon_E",
    "turn_4": r"\varepsilon_4",
    "side": "s_E",
    "sigma": r"\sigma",
}


class _Bars(NamedTuple):
    """Vectors CP, OP and DE, the unit vector of the lever, OD over OP."""

    crank: Any
    arm: Any
    rod: Any
    along: Any
    ratio: Any


class _Rates(NamedTuple):
    """Of the crank, of the lever, of P along it away from O, of the rod."""

    omega2: Any
    omega4: Any
    sliding: Any
    omega5: Any


class _Terms(NamedTuple):
    """Accelerations: of P2; Coriolis; of P4, normal then tangential; along the lever; of D; of E about D,
    normal then tangential; of E. Complex."""

    of_P2: Any
    coriolis: Any
    normal: Any
    tangential: Any
    sliding: Any
    of_D: Any
    rod_normal: Any
    rod_tangential: Any
    of_E: Any


def _bars(_guide, r2, r4, r5, h, theta2):
    along = 1j * np.exp(1j * _guide.guide_angle)
    theta4 = wrap(90 + from_radians(_guide.guide_angle))
    run = SliderCrank(r4, r5, h).run(Degrees(theta4))
    return _Bars(
        polar(r2, theta2), _guide.arm * along, run + 1j * (h - r4 * along.imag), along, r4 / _guide.arm
    )


def _rates(_guide, _bars, omega2):
    omega4 = _guide.guide_ratio * omega2
    lever = _bars.ratio * _bars.arm
    return _Rates(omega2, omega4, _guide.sliding_ratio * omega2, -omega4 * lever.real / _bars.rod.real)


def _images(_bars, _rates):
    """Velocities of P2, P4, D and E, complex; that of E has no part across its guide."""
    of_P4 = 1j * _rates.omega4 * _bars.arm
    of_D = _bars.ratio * of_P4
    of_E = (of_D + 1j * _rates.omega5 * _bars.rod).real + 0j
    return 1j * _rates.omega2 * _bars.crank, of_P4, of_D, of_E


def _terms(_bars, _rates):
    """As they follow from the rates: the lever's two unknown terms, then the rod's and the ram's."""
    crank, arm, rod, along, ratio = _bars
    omega2, omega4, sliding, omega5 = _rates
    of_P2, normal, coriolis = -(omega2**2) * crank, -(omega4**2) * arm, 2j * omega4 * sliding * along
    left = (of_P2 - coriolis - normal) / along
    tangential = 1j * left.imag * along
    of_D, rod_normal = ratio * (normal + tangential), -(omega5**2) * rod
    rod_tangential = -1j * (of_D + rod_normal).imag / rod.real * rod
    of_E = (of_D + rod_normal + rod_tangential).real + 0j
    return _Terms(
        of_P2, coriolis, normal, tangential, left.real * along, of_D, rod_normal, rod_tangential, of_E
    )


# -------------------------------------------------------------------------- velocities


def kv(_images):
    """A round scale at which the drawing fills half the box."""
    return scale_for(*_images)


def p(_images):
    """Anywhere: here it is the origin."""
    return to_paper(0 * _images[0], 1.0)


def a(_images, kv):
    return to_paper(_images[0], kv)


def b(p, a, _bars):
    return met(a, _bars.along, p, 1j * _bars.along)


def _times(ratio, vectors):
    """Vectors on paper, one or an array of them, multiplied each by its number."""
    return np.asarray(ratio)[..., None] * vectors


def d(p, b, _bars):
    return p + _times(_bars.ratio, b - p)


def e(p, d, _bars):
    return met(d, 1j * _bars.rod, p, 1 + 0j)


def pv_b(_images, kv):
    """Measured on the drawing."""
    return abs(_images[1]) / kv


def pv_e(_images, kv):
    """Measured on the drawing."""
    return abs(_images[3]) / kv


@stable(lambda _guide: _guide.arm)
def rA(_bars):
    """Distance OP, measured or given."""
    return abs(_bars.arm)


def turn_4(_rates):
    """Of the lever: +1 anticlockwise."""
    return np.sign(_rates.omega4)


def omega4(turn_4, kv, pv_b, rA):
    return turn_4 * kv * pv_b / rA


def way(_images):
    """Of the ram: +1 to the right."""
    return np.sign(_images[3].real)


def v_C(way, kv, pv_e):
    return way * kv * pv_e


# ----------------------------------------------------------------------- accelerations


def _acceleration_images(_terms):
    """Of P2, k, P4's normal one, P4, D, e' and E."""
    of_P4 = _terms.normal + _terms.tangential
    return (
        _terms.of_P2,
        _terms.of_P2 - _terms.coriolis,
        _terms.normal,
        of_P4,
        _terms.of_D,
        _terms.of_D + _terms.rod_normal,
        _terms.of_E,
    )


def ka(_acceleration_images):
    """A round scale at which the drawing fills half the box."""
    return scale_for(*_acceleration_images)


def q(_terms):
    """Anywhere: here it is the origin."""
    return to_paper(0 * _terms.of_P2, 1.0)


def a2(_terms, ka):
    return to_paper(_terms.of_P2, ka)


def k(a2, _terms, ka):
    return a2 - to_paper(_terms.coriolis, ka)


def n(q, _terms, ka):
    return q + to_paper(_terms.normal, ka)


def b2(k, n, _bars):
    return met(k, _bars.along, n, 1j * _bars.along)


def d2(q, b2, _bars):
    return q + _times(_bars.ratio, b2 - q)


def m(d2, _terms, ka):
    return d2 + to_paper(_terms.rod_normal, ka)


def e2(q, m, _bars):
    return met(m, 1j * _bars.rod, q, 1 + 0j)


def pa_e(_terms, ka):
    """Measured on the drawing."""
    return abs(_terms.of_E) / ka


def side(_terms):
    """Of the acceleration of the ram: +1 to the right."""
    return np.sign(_terms.of_E.real)


def a_C(side, ka, pa_e):
    return side * ka * pa_e


# ------------------------------------------------------------------ time ratio, advantage


def alpha(sigma):
    """The longer of the two arcs of crank between the ends of the swing."""
    return 180 + 2 * sigma


def beta(alpha):
    return 360 - alpha


def Q(alpha, beta):
    return alpha / beta


def mechanical_advantage(r2, omega2, v_C):
    return r2 * abs(omega2) / abs(v_C)


# --------------------------------------------------------------------------- the judge


@judge
def drawing(answers, r1, r2, r4, r5, h, theta2, omega2):
    """Two drawings, each at any pole and any scale; the second from the velocities of the first as well."""
    guide = _guide(r1, r2, theta2)
    bars = _bars(guide, r2, r4, r5, h, theta2)
    rates = _rates(guide, bars, omega2)
    said = verdicts(answers, _velocities(bars, rates), _asked_v(bars))
    found = verdicts(answers, _accelerations(bars, rates), _asked_a())
    own = _own_rates(answers, bars, omega2)
    if own and not _all_right(found):
        from_own = verdicts(answers, _accelerations(bars, own), _asked_a())
        if _worth(from_own) > _worth(found):
            found = from_own if _all_right(said) else {i: _followed(v) for i, v in from_own.items()}
    return said | found


def _all_right(said):
    return all(verdict.share == 1.0 for verdict in said.values())


def _worth(said):
    return sum(verdict.share for verdict in said.values())


def _followed(verdict):
    return Judged(follows=True) if verdict.share == 1.0 else verdict


def _own_rates(answers, bars, omega2):
    """As read off the student's own velocity polygon; None where it is not drawn whole at a scale."""
    if not {"kv", "p", "a", "b", "d", "e"} <= answers.keys() or not 0 < float(answers["kv"]) < 1e12:
        return None
    scale = float(answers["kv"])
    p, a, b, d, e = (complex(*np.clip(answers[i], -1e9, 1e9)) * scale for i in "pabde")
    rates = ((b - p) / (1j * bars.arm)).real, ((a - b) / bars.along).real, ((e - d) / (1j * bars.rod)).real
    return _Rates(omega2, *rates)


def _asked_v(bars):
    return DrawingParts(
        scale="kv",
        points={"p": "p_v", "a": "p_2", "b": "p_4", "d": "d", "e": "e"},
        lengths={"pv_b": ("p_v", "p_4"), "pv_e": ("p_v", "e")},
        reads={
            "omega4": Read(
                "p_v", "p_4", lambda v: (v / (1j * bars.arm)).real, 1 / abs(bars.arm), sense="value_sense"
            ),
            "v_C": Read("p_v", "e", lambda v: v.real, 1.0, sense="ram_sense"),
        },
        sides={
            ("p_v", "p_2"): "vector",
            ("p_4", "p_2"): "line",
            ("p_v", "p_4"): "line",
            ("p_v", "d"): "image",
            ("d", "e"): "line",
            ("p_v", "e"): "line",
        },
    )


def _asked_a():
    return DrawingParts(
        scale="ka",
        points={"q": "p_a", "a2": "p_2", "k": "k", "n": "p_4'", "b2": "p_4", "d2": "d", "m": "e'", "e2": "e"},
        lengths={"pa_e": ("p_a", "e")},
        reads={"a_C": Read("p_a", "e", lambda v: v.real, 1.0, sense="ram_sense")},
        sides={
            ("p_a", "p_2"): "vector",
            ("k", "p_2"): "coriolis",
            ("p_a", "p_4'"): "vector",
            ("p_4'", "p_4"): "line",
            ("p_4", "k"): "line",
            ("p_a", "d"): "image",
            ("d", "e'"): "vector",
            ("e'", "e"): "line",
            ("p_a", "e"): "line",
        },
        hung=frozenset({"line_on_a2", "line_on_q", "line_on_d2"}),
    )


def _velocities(bars, rates, scale=None):
    *_, of_D, of_E = _images(bars, rates)
    turning_, sliding = guide_v("P_2", "P_4", "OP", bars.arm, rates.omega4, rates.sliding)
    return polygon_of_velocities(
        crank_v("P_2", "CP", bars.crank, rates.omega2, length="CP"),
        (sliding, turning_),
        (image("p_v", "d", r"\vec{V}_D", of_D, ("p_v", "p_4"), r"\frac{OD}{OP}\,V_{P_4}"),),
        slider_v("E", "D", bars.rod, rates.omega5, of_E.real),
        scale=scale,
    )


def _accelerations(bars, rates, scale=None):
    terms = _terms(bars, rates)
    alpha4, gain = (terms.tangential / (1j * bars.arm)).real, (terms.sliding / bars.along).real
    alpha5 = (terms.rod_tangential / (1j * bars.rod)).real
    return polygon_of_accelerations(
        crank_a("P_2", "CP", bars.crank, rates.omega2, length="CP"),
        guide_a("P_2", "P_4", "OP", bars.arm, rates.omega4, alpha4, rates.sliding, gain, "OP", r"\omega_4"),
        (image("p_a", "d", r"\vec{a}_D", terms.of_D, ("p_a", "p_4"), r"\frac{OD}{OP}\,a_{P_4}"),),
        slider_a("E", "D", bars.rod, rates.omega5, alpha5, "DE", terms.of_E.real),
        scale=scale,
    )


def polygons(_bars, _rates, kv, ka):
    """At the scales of the answers."""
    return _velocities(_bars, _rates, kv), _accelerations(_bars, _rates, ka)


# ---------------------------------------------------------------------- known mistakes


@mistake("a", "n")
def vector_length(a, n, p, q):
    return p + 1.35 * (a - p), q + 1.7 * (n - q)


@mistake("a", "n")
def vector_direction(a, n, p, q):
    return turned(p, a, 90), turned(q, n, 90)


@mistake("a", "a2", kind="sign")
def vector_sense(a, a2, p, q):
    return 2 * p - a, 2 * q - a2


@mistake("a", "a2")
def vector_vector(a, a2, p, q):
    return p + 0.6 * (turned(p, a, 75) - p), q + 0.6 * (turned(q, a2, 75) - q)


@mistake("k")
def coriolis_length(a2, k):
    """Without the factor 2."""
    return a2 + 0.5 * (k - a2)


@mistake("k")
def coriolis_direction(a2, k):
    return turned(a2, k, 90)


@mistake("k", kind="sign")
def coriolis_sense(a2, k):
    """On the other side of p2."""
    return 2 * a2 - k


@mistake("k")
def coriolis_vector(a2, k):
    return a2 + 1.6 * (turned(a2, k, 75) - a2)


@mistake("d", "d2")
def image_length(b, b2):
    """D taken for P."""
    return b, b2


@mistake("d", "d2")
def image_direction(d, d2, p, q):
    return turned(p, d, 60), turned(q, d2, 60)


@mistake("d", "d2", kind="sign")
def image_sense(d, d2, p, q):
    return 2 * p - d, 2 * q - d2


@mistake("d", "d2")
def image_vector(d, d2, p, q):
    return p + 0.5 * (turned(p, d, 75) - p), q + 0.5 * (turned(q, d2, 75) - q)


_TILT = np.exp(-0.35j)


@mistake("b", "b2")
def line_direction(p, a, k, n, _bars):
    """Not along the lever; not across it."""
    along = _bars.along
    return met(a, along * _TILT, p, 1j * along), met(k, along, n, 1j * along * _TILT)


@mistake("e", "e2", kind="sign")
def line_sense(e, e2, p, q):
    """Laid off the other way from the pole."""
    return 2 * p - e, 2 * q - e2


@mistake("b2")
def line_on_a2(a2, n, _bars):
    """The Coriolis acceleration left out."""
    return met(a2, _bars.along, n, 1j * _bars.along)


@mistake("b2")
def line_on_q(k, q, _bars):
    """The normal acceleration of the lever left out."""
    return met(k, _bars.along, q, 1j * _bars.along)


@mistake("e2")
def line_on_d2(d2, q, _bars):
    """The normal acceleration of E about D left out."""
    return met(d2, 1j * _bars.rod, q, 1 + 0j)


@mistake("b")
def b_vector(a, b, _bars):
    return off_both(b, (_bars.along, 1j * _bars.along), a)


@mistake("e")
def e_vector(d, e, _bars):
    return off_both(e, (1j * _bars.rod, 1 + 0 * _bars.rod), d)


@mistake("b2")
def b2_vector(k, b2, _bars):
    return off_both(b2, (_bars.along, 1j * _bars.along), k)


@mistake("e2")
def e2_vector(m, e2, _bars):
    return off_both(e2, (1j * _bars.rod, 1 + 0 * _bars.rod), m)


@mistake("pv_b", "pv_e")
def lengths_exchanged(pv_b, pv_e):
    return pv_e, pv_b


@mistake("kv", "p", "a", "b", "d", "e")
def too_small(kv, p, a, b, d, e):
    return 10 * kv, p / 10, a / 10, b / 10, d / 10, e / 10


_FIRST = ("kv", "p", "a", "b", "d", "e", "pv_b", "pv_e", "omega4", "v_C")


@mistake(*_FIRST, kind="inverse")
def scale_upside_down(kv, p, a, b, d, e, pv_b, pv_e, omega4, v_C):
    """The drawing is right."""
    return 1 / kv, p, a, b, d, e, pv_b, pv_e, omega4, v_C


@mistake(*_FIRST)
def scale_not_drawn(kv, p, a, b, d, e, pv_b, pv_e, omega4, v_C):
    """Stated at one value, drawn at another."""
    return 2 * kv, p, a, b, d, e, pv_b, pv_e, omega4, v_C


@mistake("v_C", "a_C")
def scale_forgotten(v_C, a_C, kv, ka):
    return v_C / kv, a_C / ka


@mistake("v_C", "a_C", kind="sign")
def ram_sense(v_C, a_C):
    return -v_C, -a_C


@mistake("omega4", kind="sign")
def value_sense(omega4):
    return -omega4


@mistake("alpha", kind="constant")
def swing_once(sigma):
    """Half of what the swing adds to half a turn."""
    return 180 + sigma


@mistake("sigma")
def angle_at_C(r1, r2):
    return acos(r2 / r1)


@mistake("alpha", "beta", kind="exchanged")
def advance_and_return_exchanged(alpha, beta):
    return beta, alpha


@mistake("Q", kind="inverse")
def Q_inverse(alpha, beta):
    return beta / alpha


@mistake("mechanical_advantage", kind="inverse")
def advantage_inverse(mechanical_advantage):
    return 1 / mechanical_advantage


def figure(r1, r2, r4, r5, h, omega2):
    """Both ends of the swing, and the arc that the crank covers during the advance."""
    O, C, half = 0j, 1j * r1, asin(r2 / r1)
    P2, P1 = C + polar(r2, -half), C + polar(r2, 180 + half)
    D2, D1 = polar(r4, 90 - half), polar(r4, 90 + half)
    E2, E1 = (complex(D.real + np.sqrt(r5**2 - (h - D.imag) ** 2), h) for D in (D2, D1))
    start, end = (-half, 180 + half) if omega2 > 0 else (180 + half, -half)
    return Figure(
        circle(C, r2, dashed=True),
        line(E1, E2, dashed=True),
        link(O, D1),
        link(O, D2),
        link(D1, E1),
        link(D2, E2),
        link(C, P1),
        link(C, P2),
        rotation_arrow(C, 1.3 * r2, start, end, label=r"\theta_a"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(P1, "P'"),
        pin(P2, "P''"),
        pin(D1, "D'"),
        pin(D2, "D''"),
        point(E1, "E'"),
        point(E2, "E''"),
    )


def residual(
    r1,
    r2,
    r4,
    r5,
    h,
    theta2,
    omega2,
    kv,
    a,
    b,
    d,
    e,
    pv_b,
    pv_e,
    omega4,
    v_C,
    ka,
    a2,
    k,
    n,
    b2,
    d2,
    m,
    e2,
    pa_e,
    a_C,
    alpha,
    beta,
    Q,
    mechanical_advantage,
):
    """The arm and the rod as vectors, differentiated; crank square to lever at the ends of the arc alpha."""
    crank = r2 * np.exp(1j * np.radians(theta2))
    arm = 1j * r1 + crank
    along = arm / abs(arm)
    D = r4 * along
    rod = np.sqrt(r5**2 - (h - D.imag) ** 2) + 1j * (h - D.imag)
    velocity, speed = 1j * omega2 * crank, r4 * abs(omega2)
    v = {i: (z[..., 0] + 1j * z[..., 1]) * kv for i, z in zip("abde", (a, b, d, e), strict=True)}
    turn4, sliding = (velocity / along).imag / abs(arm), (velocity / along).real
    turn5 = -turn4 * D.real / rod.real
    g = {
        i: (z[..., 0] + 1j * z[..., 1]) * ka
        for i, z in zip("aknbdme", (a2, k, n, b2, d2, m, e2), strict=True)
    }
    left = (-(omega2**2) * crank - 2j * turn4 * sliding * along) / along
    gain4 = left.imag / abs(arm)
    size = r4 * omega2**2
    end = 1j * r2 * np.exp(0.5j * np.radians(alpha))
    return (
        abs(v["a"] - velocity) / speed,
        abs(v["b"] - 1j * turn4 * arm) / speed,
        abs(v["d"] - 1j * turn4 * D) / speed,
        abs(v["e"] - v["d"] - 1j * turn5 * rod) / speed,
        abs(v["e"] - v_C) / speed,
        abs(omega4 - turn4) / abs(omega2),
        abs(pv_b * kv - abs(v["b"])) / speed,
        abs(pv_e * kv - abs(v_C)) / speed,
        abs(g["a"] + omega2**2 * crank) / size,
        abs(g["a"] - g["k"] - 2j * turn4 * sliding * along) / size,
        abs(g["n"] + turn4**2 * arm) / size,
        abs(g["b"] - (1j * gain4 - turn4**2) * arm) / size,
        abs(g["d"] - (1j * gain4 - turn4**2) * D) / size,
        abs(g["m"] - g["d"] + turn5**2 * rod) / size,
        abs(((g["e"] - g["m"]) / rod).real) * r5 / size,
        abs(g["e"] - a_C) / size,
        abs(pa_e * ka - abs(a_C)) / size,
        abs((np.conj(1j * r1 + end) * end).real) / (r1 * r2),
        abs(alpha + beta - 360) / 360,
        abs(Q * beta - alpha) / alpha,
        abs(mechanical_advantage * abs(v_C) - r2 * abs(omega2)) / speed,
    )


KNOWN = (
    # The notes' lengths and rate; the crank half the frame, so that the lever swings by 30 degrees either
    # side. Crank and lever upright: the lever turns at a third of the crank's rate, and D goes left as E
    # does.
    given(r1=210, r2=105, r4=420, r5=165, h=420, theta2=90, omega2=9.42).gives(
        kv=20,
        a=(-49.455, 0),
        b=(-49.455, 0),
        d=(-65.94, 0),
        e=(-65.94, 0),
        omega4=3.14,
        v_C=-1318.8,
        alpha=240,
        beta=120,
        Q=2,
        mechanical_advantage=0.75,
    ),
    # Crank level: O, C, P a 3-4-5 triangle, the rod level too. omega4 = 9/25 omega2.
    given(r1=160, r2=120, r4=400, r5=200, h=320, theta2=0, omega2=5).gives(
        omega4=1.8,
        v_C=-576,
        alpha="277.1808",
        beta="82.8192",
        mechanical_advantage=600 / 576,
    ),
)
