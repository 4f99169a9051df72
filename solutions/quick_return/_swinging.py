"""A slotted guide that swings, and the ram that it drives: how far each goes in a turn of the crank.

The ram turns back at the ends of the guide's swing, where the guide touches the circle of A and stands square
to the crank. Only where the rod lines up with the guide inside the swing would it turn back there too.
"""

from typing import Any, NamedTuple

import numpy as np

from coursework.degrees import asin, atan2, sqrt
from coursework.errors import CannotAssemble, Undefined
from coursework.solution import stable


class _Turn(NamedTuple):
    """Effect of a full turn of the crank on the ram."""

    stroke: Any
    lines_up: Any  #: whether rod and guide line up inside the swing, where the ram turns back too


def _to_the_contact(r1, r2):
    """From O4 along a tangent to the circle of A; none, and no swing, unless O4 lies outside."""
    if isinstance(r1 + r2, float) and not r2 < r1:
        raise Undefined(
            f"the guide does not oscillate: r2 must be less than r1, found r2 = {r2:.6g} and r1 = {r1:.6g}"
        )
    return sqrt((r1 - r2) * (r1 + r2))


def _turn(r1, r2, r4, r5, h):
    """The stroke between the extreme positions, at the ends of the swing or where rod and guide are in
    line."""
    alone = isinstance(r1 + r2 + r4 + r5 + h, float)
    cosine = _to_the_contact(r1, r2) / r1
    rise = h - r4 * cosine
    room = r5 - np.maximum(abs(rise), abs(h - r4))
    if alone and not room > 0:
        raise CannotAssemble(f"the rod does not reach its line all turn: it is {-room:.3g} mm too short")
    half = r4 * r2 / r1
    stretched, folded = h > cosine * (r5 + r4), -h > cosine * (r5 - r4)
    run = np.sqrt((r5 - rise) * (r5 + rise))
    at_most = np.where(stretched, np.sqrt((r5 + r4 - h) * (r5 + r4 + h)) - run, half)
    at_least = np.where(folded, np.sqrt((r5 - r4 - h) * (r5 - r4 + h)) - run, -half)
    stroke = np.where((room > 0) & (r2 < r1), at_most - at_least, np.nan)
    return _Turn(stroke[()], np.logical_or(stretched, folded))


@stable(lambda r1, r2: atan2(r2, _to_the_contact(r1, r2)))
def sigma(r1, r2):
    """Between the guide at the end of its swing and the y axis: the crank is square to it."""
    return asin(r2 / r1)


@stable(lambda _turn: _turn.stroke)
def stroke(r1, r2, r4):
    """Between the two positions of P, as the rod is equally inclined in both."""
    return 2 * r4 * r2 / r1
