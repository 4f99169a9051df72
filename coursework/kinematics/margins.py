"""Grashof margins of a four-bar linkage, free of cancellation.

A four-bar with sides b and c to the inner joint closes while their pins are between ``|b - c|`` and
``b + c`` apart. Near a dead point both margins are differences of nearly equal lengths; here each is
a sum computed without rounding, times a sum, so that it is exactly zero when the lengths say so.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np


def exact_sum(*terms: Any) -> Any:
    """Return the sum of a few terms without cancellation.

    Parameters
    ----------
    terms
        Scalars, or arrays that broadcast, in one unit.

    Returns
    -------
    The sum in that unit, of the broadcast shape.

    Source
    ------
    ``math.fsum`` for scalars; for arrays passes of Knuth's TwoSum, which keeps the rounding errors.
    """
    if all(isinstance(term, (float, int)) for term in terms):
        return math.fsum(terms)
    parts = list(np.broadcast_arrays(*[np.asarray(term, dtype=float) for term in terms]))
    # Each pass leaves the running sum in the last place and the rounding errors in the others.
    for _ in range(len(parts) - 1):
        for i in range(1, len(parts)):
            parts[i - 1], parts[i] = _sum_and_error(parts[i - 1], parts[i])
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


def _sum_and_error(x: Any, y: Any) -> tuple[Any, Any]:
    """Return the rounding error of x + y, then x + y."""
    total = x + y
    of_y = total - x
    return (x - (total - of_y)) + (y - of_y), total


def grashof_margins(ground: Any, crank: Any, coupler: Any, rocker: Any) -> tuple[Any, Any]:
    """Return the Grashof margins E+ and E-: of the stretched and of the folded aligned position.

    Parameters
    ----------
    ground, crank, coupler, rocker
        Lengths, positive, in one common unit; scalars or arrays that broadcast.

    Returns
    -------
    Both margins in that unit squared, of the broadcast shape. Both positive: the crank turns fully. Zero: a
    change point.

    Source
    ------
    ``(coupler + rocker)^2 - (ground + crank)^2`` and ``(ground - crank)^2 - (coupler - rocker)^2``, in
    factors.
    """
    stretched = exact_sum(coupler, rocker, -ground, -crank) * (ground + crank + coupler + rocker)
    folded = exact_sum(ground, coupler, -crank, -rocker) * exact_sum(ground, rocker, -crank, -coupler)
    return stretched, folded
