"""Slider-crank to be designed: solution.

O sees the two points C1 and C2 where the piston turns back at distances r3 - r2 and r3 + r2, and under the
angle phi by which the slow stroke exceeds half a turn of the crank. In the triangle O C1 C2 the side C1 C2 is
the stroke and the height on it is |e|: two relations for three lengths, so that one of them is free.
"""

import numpy as np

from coursework.degrees import asin, sqrt, tan
from coursework.kinematics.slider_crank import SliderCrank
from coursework.solution import Judged, formula, given, judge, mistake, stable

from .._slow_arc import *
from ._in_line import _in_line

UNITS = {"phi": "deg", "side": "1", "lean": "deg"}
SYMBOLS = {"phi": r"\varphi", "side": r"\varepsilon", "lean": r"\left|\theta_3\right|_{\max}"}


def t(phi):
    return tan(phi / 2)


def r2(stroke, t):
    """Of all cranks shorter than half the stroke, the one whose rod leans least."""
    return stroke / 4 * (sqrt(4 + 5 * t**2) - t)


def side(mode):
    """Sign of e: positive when the piston goes slowly towards O, the crank turning anticlockwise."""
    return np.where(mode == "inward", 1.0, -1.0)[()]


@stable(lambda side, stroke, t: side * stroke * (1 - t) * (1 + t) / (sqrt(4 + 5 * t**2) + 3 * t))
def e(side, stroke, r2, t):
    return side * (stroke**2 - 4 * r2**2) / (2 * stroke * t)


def r3(stroke, e, t):
    return sqrt(stroke**2 + 2 * stroke * abs(e) / t) / 2


@formula(r"\arcsin \frac{<r2> + \left|<e>\right|}{<r3>}")
def lean(r2, r3, e):
    """The rod leans most where A is farthest from the line of the piston."""
    return asin((r2 + abs(e)) / r3)


STROKE_SHARE, ALPHA_MARGIN, LEAN_MARGIN = 0.01, 1.0, 0.5


@judge
def meets_the_demands(answers, stroke, alpha, delta, mode):
    """Any slider-crank of this stroke, time ratio and inclination, by the motion of the student's own."""
    if len(answers) < 3:
        return {}
    own = {name: float(answers[name]) for name in ("r2", "r3", "e")}
    verdict = _judged(**own, stroke=stroke, alpha=alpha, delta=delta, mode=mode)
    return dict.fromkeys(answers, verdict)


def _judged(r2, r3, e, stroke, alpha, delta, mode):
    if not (r2 > 0 and r3 - r2 > abs(e)):
        return Judged(0.0, "does_not_turn")
    linkage = SliderCrank(r2, r3, e)
    slow_arc = 180 + np.degrees(linkage.quick_return()) * (1 if mode == "inward" else -1)
    leaning = float(asin((r2 + abs(e)) / r3))
    found = {"stroke": float(linkage.stroke()), "alpha": float(slow_arc), "lean": leaning}
    failed = {
        "stroke_missed": abs(found["stroke"] - stroke) > STROKE_SHARE * stroke,
        "slow_stroke_reversed": slow_arc < 180 and abs(360 - slow_arc - alpha) <= ALPHA_MARGIN,
        "ratio_missed": abs(slow_arc - alpha) > ALPHA_MARGIN,
        "rod_leans_too_much": leaning > delta + LEAN_MARGIN,
    }
    first = next((name for name, is_so in failed.items() if is_so), "")
    # A half for the stroke, a half for the ratio; what jams is worth half of that.
    share = 1 - 0.5 * failed["stroke_missed"] - 0.5 * failed["ratio_missed"]
    return Judged(share / 2 if failed["rod_leans_too_much"] else share, first, found)


@mistake("r2", "r3", "e")
def stroke_missed(r2, r3, e):
    """The crank is as long as the stroke, or nearly."""
    return 2 * r2, 2 * r3, 2 * e


@mistake("r2", "r3", "e")
def ratio_missed(stroke, r2, r3, e):
    """In line, with half the stroke for a crank."""
    return stroke / 2, r3, 0 * e


@mistake("e", kind="sign")
def slow_stroke_reversed(e):
    return -e


@mistake("r2", "r3", "e")
def rod_leans_too_much(stroke, t, e):
    """Right stroke and ratio, but a crank near to half the stroke: the rod is short."""
    offset = np.sign(e) * 0.01 * stroke
    return (
        sqrt(stroke**2 - 2 * stroke * abs(offset) * t) / 2,
        sqrt(stroke**2 + 2 * stroke * abs(offset) / t) / 2,
        offset,
    )


@mistake("r3")
def does_not_turn(r2, e):
    return r2 + 0.9 * abs(e)


def figure(r2, r3, e):
    """The linkage found, at both ends of its stroke."""
    return _in_line(r2, e, sqrt((r3 - r2) ** 2 - e**2), sqrt((r3 + r2) ** 2 - e**2), anticlockwise=True)


def residual(stroke, Q, alpha, r2, r3, e, mode):
    """Residual of the design: dead points computed as points, the ratio of the arcs between them, and the
    least inclination of the rod."""
    far = (r3 + r2) * np.exp(1j * np.arcsin(e / (r3 + r2)))
    near = (r3 - r2) * np.exp(1j * np.arcsin(e / (r3 - r2)))
    # Anticlockwise from the far end to the near one the crank turns half a turn and what lies between.
    inward = np.pi + np.angle(near / far)
    arc = np.where(mode == "inward", inward, 2 * np.pi - inward)
    return (
        abs(far - near - stroke) / stroke,
        abs(arc / (2 * np.pi - arc) - Q) / Q,
        abs(np.degrees(arc) - alpha) / 360,
        np.maximum((r2 + abs(e)) / r3 - _leans(0.999 * r2, stroke, Q), 0),
        np.maximum((r2 + abs(e)) / r3 - _leans(1.001 * r2, stroke, Q), 0),
    )


def _leans(r2, stroke, Q):
    """Sine of the rod's inclination for another crank of the same stroke and ratio, by the triangle O C1
    C2."""
    angle = np.pi * (Q - 1) / (Q + 1)
    # Product of the sides at O from the area, their squares from the law of cosines.
    product = (stroke**2 - 4 * r2**2) / (2 * (1 - np.cos(angle)))
    r3 = np.sqrt(product + r2**2)
    e = product * np.sin(angle) / stroke
    return (r2 + e) / r3


KNOWN = (
    # The slow stroke takes three fifths, two thirds of a turn.
    given(Q=1.5).gives(alpha=216),
    given(Q=2).gives(alpha=240),
    # The best of 400 000 points of the arc that sees the stroke under 16.36 and 23.48 degrees.
    given(stroke=100, Q=1.2, mode="inward").gives(r2="47.047", r3="127.911", e="39.859", lean="42.799"),
    given(stroke=150, Q=1.3, mode="outward").gives(r2="69.205", r3="158.043", e="-53.620", lean="51.002"),
)
