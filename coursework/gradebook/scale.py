"""Marks from points: by the assignment's scale, rounded to its step, never down at a half step."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

from coursework.issuing.issued import Issued

#: Where an assignment states none and one is needed.
USUAL_SCALE: Mapping[str, Any] = {"of": 20.0, "step": 0.5}


def mark_of(issued: Issued, points: float, out_of: float) -> str:
    """Return the mark as text, ``14.5``: the share of the points, rounded half up to a step; empty if the
    assignment has no marks.

    A scale may state the points that are worth the best mark, ``full``, or a ``curve`` of points and marks,
    both out of a ``total``.
    """
    scale = (issued.assignment or {}).get("mark")
    return mark_on(scale, points, out_of) if scale else ""


def mark_on(scale: Mapping[str, Any], points: float, out_of: float) -> str:
    """Return the mark on a scale as text; empty out of no points."""
    if not out_of:
        return ""
    of, step = exact(scale["of"]), exact(scale["step"])
    share = exact(points) / exact(out_of)
    if "full" in scale:
        mark = of * share * exact(scale["total"]) / exact(scale["full"])
    elif "curve" in scale:
        mark = _on_curve(scale["curve"], share * exact(scale["total"]))
    else:
        mark = of * share
    steps = math.floor(mark / step + Fraction(1, 2))
    return f"{float(min(steps * step, of)):.10g}"


def is_rescaled(scale: Mapping[str, Any] | None) -> bool:
    """Return whether somebody scaled the total, so that marks are not in proportion to points."""
    return scale is not None and ("full" in scale or "curve" in scale)


def _on_curve(curve: Sequence[Sequence[float]], points: Fraction) -> Fraction:
    """Return the mark of some points between two points of a curve; beyond the last, that of the last."""
    corners = [(exact(x), exact(y)) for x, y in curve]
    for (x, y), (next_x, next_y) in pairwise(corners):
        if points <= next_x:
            return y + (next_y - y) * max(points - x, Fraction(0)) / (next_x - x)
    return corners[-1][1]


def exact(number: float) -> Fraction:
    """Return the intended decimal: 2.1 for 2.0999999999999996."""
    return Fraction(f"{number:.9g}")
