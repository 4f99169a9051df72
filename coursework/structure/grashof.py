"""Grashof's rule, decided exactly on the printed decimals of the lengths.

A printed length such as 0.3 is not a double: the lengths are the decimals, the shortest that their doubles
stand for, and their sums are compared without rounding. So 0.1 + 0.6 equals 0.3 + 0.4, and a length that
differs from another in its last digit differs.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
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
    """Return the length of the shortest bar.

    Parameters
    ----------
    r1, r2, r3, r4
        Lengths in one unit; scalars or arrays that broadcast.

    Returns
    -------
    The length, in that unit, of the broadcast shape.
    """
    return np.minimum(np.minimum(r1, r2), np.minimum(r3, r4))


def longest(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """Return the length of the longest bar.

    Parameters
    ----------
    r1, r2, r3, r4
        Lengths in one unit; scalars or arrays that broadcast.

    Returns
    -------
    The length, in that unit, of the broadcast shape.
    """
    return np.maximum(np.maximum(r1, r2), np.maximum(r3, r4))


def closing_excess(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """Return the excess that is positive if the bars close a loop.

    Parameters
    ----------
    r1, r2, r3, r4
        Lengths in one unit; scalars or arrays that broadcast.

    Returns
    -------
    The excess, in that unit, of the broadcast shape; its sign is exact for the decimals.

    Source
    ------
    ``s + p + q - l`` for the shortest bar s, the longest l and the others p, q.
    """
    return _exact(_closing, r1, r2, r3, r4)


def grashof_excess(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """Return the excess that is positive if some bar turns fully.

    Parameters
    ----------
    r1, r2, r3, r4
        Lengths in one unit; scalars or arrays that broadcast.

    Returns
    -------
    The excess, in that unit, of the broadcast shape; its sign is exact for the decimals.

    Source
    ------
    ``p + q - s - l`` for the shortest bar s, the longest l and the others p, q.
    """
    return _exact(_grashof, r1, r2, r3, r4)


def _closing(s: Any, p: Any, q: Any, l: Any) -> tuple[Any, ...]:
    return s, p, q, -l


def _grashof(s: Any, p: Any, q: Any, l: Any) -> tuple[Any, ...]:
    return p, q, -s, -l


def _exact(terms: Callable[..., tuple[Any, ...]], *lengths: Any) -> Any:
    """Return the sum of the terms of the sorted lengths, from the decimals wherever doubles leave its sign
    open."""
    ordered = np.sort(np.stack(np.broadcast_arrays(*[np.asarray(r, dtype=float) for r in lengths])), axis=0)
    excess = np.asarray(exact_sum(*terms(*ordered)))
    # Of up to six decimals, the usual case, the millionths are whole numbers, and so are their sums.
    millionths = np.rint(ordered * 1e6)
    full = ((millionths / 1e6 == ordered) & (millionths < 2.0**50)).all(axis=0)
    excess = np.where(full, sum(terms(*millionths)) / 1e6, excess)
    open_ = ~full & np.isfinite(excess) & (abs(excess) <= 2.0**-53 * ordered.sum(axis=0))
    for position in map(tuple, np.argwhere(open_)):
        excess[position] = sum(terms(*(Fraction(repr(r)) for r in ordered[:, *position].tolist())))
    return excess[()]


def type_by_shortest(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """Return the type of a linkage that satisfies Grashof's rule, by its shortest bar.

    Parameters
    ----------
    r1, r2, r3, r4
        Lengths of frame, input, coupler and output in one unit; scalars or arrays that broadcast.

    Returns
    -------
    An array of the first four of :data:`TYPES`, of the broadcast shape. Of bars that are equally short the
    input counts, then the output, then the frame.
    """
    short = shortest(r1, r2, r3, r4)
    return np.select(
        [r2 == short, r4 == short, r1 == short],
        ["crank-rocker", "rocker-crank", "double-crank"],
        "double-rocker",
    )


def linkage_type(r1: Any, r2: Any, r3: Any, r4: Any) -> Any:
    """Return the type of a four-bar linkage.

    Parameters
    ----------
    r1, r2, r3, r4
        Lengths of frame, input, coupler and output, positive, in one unit; scalars or arrays that broadcast.

    Returns
    -------
    An array of :data:`TYPES`, of the broadcast shape.

    Source
    ------
    ``impossible`` where :func:`closing_excess` is not positive; else by :func:`grashof_excess`: 0
    ``change-point``, negative ``triple-rocker``, positive the type by the shortest bar.
    """
    excess = grashof_excess(r1, r2, r3, r4)
    return np.select(
        [closing_excess(r1, r2, r3, r4) <= 0, excess == 0, excess < 0],
        ["impossible", "change-point", "triple-rocker"],
        type_by_shortest(r1, r2, r3, r4),
    )
