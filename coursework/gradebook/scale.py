"""A mark from points: by the assignment's scale, to its step, never to the student's loss."""

from __future__ import annotations

import math
from fractions import Fraction

from coursework.making.issued import Issued


def mark_of(issued: Issued, points: float, out_of: float) -> str:
    """The mark as it is written, ``14.5``: the share of the points, to the nearest step, a half step up; empty where
    only points count."""
    scale = (issued.assignment or {}).get("mark")
    if not scale or not out_of:
        return ""
    of, step = exact(scale["of"]), exact(scale["step"])
    steps = math.floor(of * exact(points) / exact(out_of) / step + Fraction(1, 2))
    return f"{float(min(steps * step, of)):.10g}"


def exact(number: float) -> Fraction:
    """The decimal that is meant: 2.1 for 2.0999999999999996."""
    return Fraction(f"{number:.9g}")
