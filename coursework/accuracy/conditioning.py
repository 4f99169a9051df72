"""Conditioning of a quantity: the unavoidable error from the last digit of the data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from coursework.accuracy.reference import Reference

EPS = float(np.finfo(float).eps)
ALLOWED = 8.0  #: conditionings that an error may be
_FLOOR = 4.0  #: last digits of the value itself
_STEP = 1e-30


def unavoidable(
    reference: Reference, given: Mapping[str, Any], values: Mapping[str, Any]
) -> dict[str, float]:
    """Return the change of each quantity when every datum moves by one last digit, in its unit.

    It is at least a last digit of the quantity itself, and for an angle one of a radian. An angle is first
    reduced to within half a turn: whole turns cost no digit.
    """
    moves = dict.fromkeys(values, 0.0)
    for datum, value in given.items():
        if isinstance(value, str) or not value:
            continue
        for name, moved in _moved(reference, given, datum, values).items():
            moves[name] += moved
    return {n: EPS * max(moves[n], _FLOOR / ALLOWED * _size(reference, n, v)) for n, v in values.items()}


def _moved(
    reference: Reference, given: Mapping[str, Any], datum: str, values: Mapping[str, Any]
) -> dict[str, float]:
    """Return the change of each quantity per relative change of one datum; no entry where it does not exist
    nearby."""
    mp = reference.mp
    exact = mp.mpf(float(given[datum]))
    in_degrees = reference.exercise.units.get(datum) == "deg"
    size = abs(math.remainder(float(given[datum]), 360.0)) if in_degrees else abs(float(given[datum]))
    for sign in (1, -1):
        shifted = reference.at({**given, datum: exact + sign * _STEP * mp.mpf(size)})
        results = {n: (shifted[n], v) for n, v in values.items() if v is not None and shifted[n] is not None}
        if results:
            return {n: float(abs(difference(reference, n, a, b))) / _STEP for n, (a, b) in results.items()}
    return {}


def difference(reference: Reference, name: str, value: Any, right: Any) -> Any:
    """Return one value minus another; for angles modulo a turn."""
    apart = value - right
    if reference.exercise.units.get(name) == "deg":
        apart -= 360 * reference.mp.nint(apart / 360)
    return apart


def _size(reference: Reference, name: str, value: Any) -> float:
    if value is None:
        return math.nan
    if reference.exercise.units.get(name) == "deg":
        return max(math.degrees(1.0), float(abs(value)))
    return float(abs(value))
