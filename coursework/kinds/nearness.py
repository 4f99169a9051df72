"""Gaps counted in the half-width that is accepted."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

SLACK = 1e-12  #: relative, so that an answer on the tolerance's edge is inside it
TRUSTED = 1e-3  #: share of a half-width that an answer's last digit may be, for its distance to mean anything
_FAR = 1e100  #: a point so far off is not computed with


def in_half_widths(gap: float, half_width: float, scale: float) -> float:
    """``gap`` in half-widths, the boundary inclusive up to rounding of what is as large as ``scale``."""
    if not math.isfinite(gap):
        return math.inf
    if gap <= half_width + SLACK * max(half_width, abs(scale)):
        return min(1.0, gap / half_width) if half_width else 0.0
    return gap / half_width if half_width else math.inf


def gaps(values: np.ndarray, others: Any, turn: float) -> np.ndarray:
    """Return the distances of values from others, element by element; modulo a ``turn`` where that is not
    0."""
    gap = np.abs(values - others)
    with np.errstate(invalid="ignore"):  # an infinite gap has no place in a turn
        return np.abs(gap - turn * np.rint(gap / turn)) if turn else gap


def is_fine(value: float, half_width: float) -> bool:
    """Return whether the spacing of floats about a value is far below a half-width; true where that is 0."""
    return math.ulp(value) <= TRUSTED * half_width or half_width == 0


def offset(point: Any, reference: Any) -> np.ndarray | None:
    """From a reference to a point, shape ``(n,)``; none where it is too far to compute with."""
    difference = np.asarray(point, dtype=float) - reference
    return None if float(np.max(np.abs(difference))) > _FAR else difference
