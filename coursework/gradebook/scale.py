"""Marks from points: by the assignment's scale, rounded to its step, never down at a half step."""

from __future__ import annotations

import math
from fractions import Fraction

from coursework.issuing.issued import Issued


def mark_of(issued: Issued, points: float, out_of: float) -> str:
    """Return the mark as text, ``14.5``: the share of the points, rounded half up to a step; empty if the
    assignment has no marks."""
    scale = (issued.assignment or {}).get("mark")
    if not scale or not out_of:
        return ""
    of, step = exact(scale["of"]), exact(scale["step"])
    steps = math.floor(of * exact(points) / exact(out_of) / step + Fraction(1, 2))
    return f"{float(min(steps * step, of)):.10g}"


def exact(number: float) -> Fraction:
    """Return the intended decimal: 2.1 for 2.0999999999999996."""
    return Fraction(f"{number:.9g}")
