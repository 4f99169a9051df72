"""Grashof's rule, decided on the lengths as they are printed.

A printed length such as 0.3 is no double; the sums here count as equal when the doubles differ by no more than
their rounding, which is when the decimals are equal.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from coursework.kinematics.margins import exact_sum

TYPES = (
    "crank-rocker",
    "rocker-crank",
    "double-crank",
    "double-rocker",
    "triple-rocker",
    "change-point",
    "impossible",
)


def shortest(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    return np.minimum(np.minimum(r1, r2), np.minimum(r3, r4))


def longest(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    return np.maximum(np.maximum(r1, r2), np.maximum(r3, r4))


def closing_excess(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """Of s + p + q over l: the bars close a loop when it is positive. Exactly 0 when the decimals say so."""
    return _snapped(exact_sum(r1, r2, r3, r4, -2 * longest(r1, r2, r3, r4)), r1, r2, r3, r4)


def grashof_excess(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """Of p + q over s + l: some bar turns fully when it is positive. Exactly 0 when the decimals say so."""
    ends = (-2 * shortest(r1, r2, r3, r4), -2 * longest(r1, r2, r3, r4))
    return _snapped(exact_sum(r1, r2, r3, r4, *ends), r1, r2, r3, r4)


def _snapped(excess: Any, *lengths: Any) -> Any:
    return np.where(abs(excess) <= 2.0**-53 * sum(lengths), 0.0, excess)


def type_by_shortest(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """Of a linkage that keeps Grashof's rule: who is the shortest bar?"""
    short = shortest(r1, r2, r3, r4)
    return np.select(
        [r2 == short, r4 == short, r1 == short],
        ["crank-rocker", "rocker-crank", "double-crank"],
        "double-rocker",
    )


def linkage_type(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """One of :data:`TYPES`, for a frame r1, input r2, coupler r3, output r4: positive scalars or arrays."""
    excess = grashof_excess(r1, r2, r3, r4)
    return np.select(
        [closing_excess(r1, r2, r3, r4) <= 0, excess == 0, excess < 0],
        ["impossible", "change-point", "triple-rocker"],
        type_by_shortest(r1, r2, r3, r4),
    )
