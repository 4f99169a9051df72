"""Crank-rocker to be designed: solution.

The rocker turns back at B1 and B2, where crank and coupler are in line: O sees them at the distances r3 - r2
and r3 + r2, and under the angle phi by which the slow stroke exceeds half a turn of the crank. So O lies on
the arc that sees the chord B1 B2 under phi, and may be any point of it; the angle ``beta`` at B1 tells which.
"""

import numpy as np

from coursework.degrees import acos, cos, polar, sin, sqrt
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin
from coursework.solution import Judged, formula, given, judge, mistake

from .._slow_arc import *

UNITS = {
    "phi": "deg",
    "chord": "mm",
    "beta": "deg",
    "near": "mm",
    "far": "mm",
    "swing": "deg",
    "transmission": "deg",
    "mu_1": "deg",
    "mu_2": "deg",
}
SYMBOLS = {
    "phi": r"\varphi",
    "chord": "B_1B_2",
    "near": "OB_1",
    "far": "OB_2",
    "swing": r"\psi",
    "transmission": r"\mu_{\min}",
    "mu_1": r"\mu_1",
    "mu_2": r"\mu_2",
}


def chord(r4, psi):
    return 2 * r4 * sin(psi / 2)


def beta(psi, phi):
    """Angle O B1 B2: of the whole degrees, the one whose linkage keeps the transmission angle farthest from 0
    and 180."""
    psi, phi = np.asarray(psi, dtype=float)[..., None], np.asarray(phi, dtype=float)[..., None]
    with np.errstate(invalid="ignore"):
        found = _least_transmission(*_lengths(1.0, psi, phi, TRIED), 1.0)
    return TRIED[np.argmax(np.where(_swings(psi, phi), found, -1.0), axis=-1)]


TRIED = np.arange(95.0, 180.0)  #: degrees


def _swings(psi, phi):
    """For which of the tried angles the rocker goes from B1 to B2 on one side of the frame OC."""
    _, r2, r3 = _lengths(1.0, psi, phi, TRIED)
    B1, B2 = polar(1.0, 90 + psi / 2), polar(1.0, 90 - psi / 2)
    O = B1 + polar(r3 - r2, -TRIED)
    return (TRIED + phi < 180) & ((np.conj(O) * B1).imag * (np.conj(O) * B2).imag > 1e-9)


def _lengths(r4, psi, phi, beta):
    """r1, r2, r3 of the linkage whose angle O B1 B2 is beta."""
    chord = 2 * r4 * sin(psi / 2)
    near, far = chord * sin(beta + phi) / sin(phi), chord * sin(beta) / sin(phi)
    r1 = sqrt(near**2 + r4**2 - 2 * near * r4 * sin(beta + psi / 2))
    return r1, (far - near) / 2, (far + near) / 2


def _least_transmission(r1, r2, r3, r4):
    """The smaller of the transmission angle's smallest value and its supplement's, degrees."""
    smallest, largest = _transmission(r1, r2, r3, r4)
    return np.minimum(smallest, 180 - largest)


def _transmission(r1, r2, r3, r4):
    """The transmission angle with the crank along the frame, towards C and away from it, degrees."""
    return tuple(acos((r3**2 + r4**2 - (r1 + side * r2) ** 2) / (2 * r3 * r4)) for side in (-1, 1))


def near(chord, beta, phi):
    return chord * sin(beta + phi) / sin(phi)


def far(chord, beta, phi):
    return chord * sin(beta) / sin(phi)


def r2(far, near):
    return (far - near) / 2


def r3(far, near, _checked):
    return (far + near) / 2


def _checked(mu_1, mu_2):
    """The demands on the linkage, shown beside the last of its lengths."""


@formula(
    r"\arccos \left(\frac{<r3>^2 + <r4>^2 - \left(<r1> - <r2>\right)^2}{2 \times <r3> \times <r4>}\right)"
)
def mu_1(_extremes):
    """The least transmission angle: the crank lies along the frame, towards C."""
    return _extremes[0]


@formula(
    r"\arccos \left(\frac{<r3>^2 + <r4>^2 - \left(<r1> + <r2>\right)^2}{2 \times <r3> \times <r4>}\right)"
)
def mu_2(_extremes):
    """The greatest: the crank points away from C."""
    return _extremes[1]


def _extremes(r4, psi, phi, beta):
    """Both of them, from what the lengths follow from: a wrong length leaves the right ones as they are."""
    return _transmission(*_lengths(r4, psi, phi, beta), r4)


def r1(near, r4, beta, psi):
    """C lies on the same side of B1 B2 as O; its base angles there are 90 degrees less half of psi."""
    return sqrt(near**2 + r4**2 - 2 * near * r4 * cos(beta - 90 + psi / 2))


SWING_MARGIN, ALPHA_MARGIN, TRANSMISSION_MARGIN = 1.0, 1.0, 0.5


@judge
def meets_the_demands(answers, r4, psi, alpha, mu_min):
    """Any crank-rocker of this swing, time ratio and transmission angle, by the motion of the student's
    own."""
    if len(answers) < 3:
        return {}
    r1, r2, r3 = (float(answers[name]) for name in ("r1", "r2", "r3"))
    return dict.fromkeys(answers, _judged(r1, r2, r3, r4, psi, alpha, mu_min))


def _judged(r1, r2, r3, r4, psi, alpha, mu_min):
    longest = max(r1, r3, r4)
    turns = 0 < r2 < min(r1, r3, r4) and r2 + 2 * longest < r1 + r3 + r4
    if not turns:
        return Judged(0.0, "no_full_turn")
    # Angles at C and at O of the triangle O C B with crank and coupler in line.
    in_line = [r3 + side * r2 for side in (-1, 1)]
    at_C = [_corner(r1, r4, length) for length in in_line]
    at_O = [_corner(r1, length, r4) for length in in_line]
    found = {
        "swing": float(at_C[1] - at_C[0]),
        "alpha": float(180 + abs(at_O[1] - at_O[0])),
        "transmission": float(_least_transmission(r1, r2, r3, r4)),
    }
    failed = {
        "swing_missed": abs(found["swing"] - psi) > SWING_MARGIN,
        "ratio_missed": abs(found["alpha"] - alpha) > ALPHA_MARGIN,
        "transmission_missed": found["transmission"] < mu_min - TRANSMISSION_MARGIN,
    }
    first = next((name for name, is_so in failed.items() if is_so), "")
    # A half for the swing, a half for the ratio; what jams is worth half of that.
    share = 1 - 0.5 * failed["swing_missed"] - 0.5 * failed["ratio_missed"]
    return Judged(share / 2 if failed["transmission_missed"] else share, first, found)


def _corner(a, b, opposite):
    """Between two sides of a triangle; one that is flat but for rounding is flat."""
    return acos(min(1.0, max(-1.0, (a**2 + b**2 - opposite**2) / (2 * a * b))))


@mistake("r1", "r2", "r3")
def swing_missed(r1, r2, r3):
    """The crank is too long by an eighth."""
    return r1, 1.125 * r2, r3


@mistake("r1", "r2", "r3")
def ratio_missed(r4, psi):
    """A linkage whose two strokes last alike."""
    crank = r4 * sin(psi / 2)
    return 1.3 * r4, crank, sqrt((1.3 * r4) ** 2 + crank**2 - r4**2)


@mistake("r1", "r2", "r3")
def transmission_missed(r4, psi, phi):
    """Swing and ratio are right, O nearly as far round the arc as it may be."""
    first = TRIED[np.argmax(_swings(np.asarray(psi)[..., None], np.asarray(phi)[..., None]), axis=-1)]
    return _lengths(r4, psi, phi, first + 2)


@mistake("r3")
def no_full_turn(r1, r2, r4):
    return r1 + r4


def figure(r4, psi, phi, chord, beta, near, r1, r2, r3):
    """The linkage found, at both ends of the swing, on the arc that sees the chord under phi."""
    # C at the origin, its rocker symmetric about the vertical; B1 is the end nearer to O, on the left.
    B1, B2 = polar(r4, 90 + psi / 2), polar(r4, 90 - psi / 2)
    O = B1 + polar(near, -beta)
    A1, A2 = O - polar(r2, 180 - beta), O + (B2 - O) * r2 / (r2 + r3)
    return Figure(
        link(O, A2),
        link(A2, B2),
        link(0j, B2),
        link(A1, B1),
        link(0j, B1),
        line(O, 0j, dashed=True, label="r_1"),
        line(B1, B2, dashed=True),
        angle_mark(0j, 90 - psi / 2, 90 + psi / 2, r"\psi", radius=0.35 * r4),
        ground_pivot(O, "O"),
        ground_pivot(0j, "C"),
        pin(A1, "A_1"),
        pin(A2, "A_2"),
        pin(B1, "B_1"),
        pin(B2, "B_2"),
    )


def residual(r4, psi, Q, alpha, r1, r2, r3):
    """The motion of the linkage: swing, arcs between its positions in line; Grashof."""
    frame = r1 + 0j
    reach = [r3 - r2, r3 + r2]
    ends = []
    for d in reach:
        # B on both circles, above the frame.
        x = (d**2 + r1**2 - r4**2) / (2 * r1)
        ends.append(x + 1j * np.sqrt(d**2 - x**2))
    swing = abs(np.angle((ends[0] - frame) / (ends[1] - frame)))
    between = abs(np.angle(ends[0] / ends[1]))
    slow, fast = np.pi + between, np.pi - between
    return (
        abs(np.degrees(swing) - psi) / 180,
        abs(slow / fast - Q) / Q,
        abs(np.degrees(slow) - alpha) / 360,
        np.maximum(2 * r2 + 2 * np.maximum(np.maximum(r1, r3), r4) - (r1 + r2 + r3 + r4), 0) / r4,
    )


KNOWN = (
    given(Q=1.5).gives(alpha=216),
    given(r4=100, psi=60).gives(chord=100),
    # O as the meeting point of two rays from B1 and B2, the transmission angle over 3600 crank angles.
    given(r4=100, psi=60, Q=1.2).gives(beta=153, r1="122.384", r2="47.814", r3="113.328"),
    given(r4=150, psi=40, Q=1.1).gives(beta=162, r1="190.787", r2="49.980", r3="162.758"),
)
