"""Trigonometry in degrees, exact where degrees are: ``sin(180)`` is 0 and ``cos(60 + 360 k)`` is ``cos(60)``.

Solutions write the formulas of the course with these functions. Each takes a scalar or an array and
gives the same shape. Arrays of single or extended precision keep it, and numbers of mpmath keep their digits.
Angles that come out lie in (-180, 180] unless said otherwise.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

Angle = Any  #: degrees, a scalar or an array


def _is_scalar(*values: Any) -> bool:
    return all(isinstance(v, (float, int, complex)) for v in values)


def _digits_of(*values: Any) -> Any:
    """Return the mpmath context, with its precision, of the first value that has one; None otherwise."""
    for value in values:
        context = getattr(value, "context", None)
        if context is not None:
            return context
    return None


def _floating(values: Any) -> np.ndarray:
    values = np.asarray(values)
    return values if values.dtype.kind == "f" else values.astype(float)


def _sine_of_quarters(theta: Angle, quarters: int) -> Angle:
    """Return the sine of ``theta + 90 quarters``, reduced exactly by quarter turns first."""
    if isinstance(theta, (float, int)):
        if not math.isfinite(theta):
            return math.nan
        theta = math.fmod(theta, 360.0)
        turns = round(theta / 90.0)
        rest = math.radians(theta - 90.0 * turns)
        turns = (turns + quarters) % 4
        value = math.cos(rest) if turns % 2 else math.sin(rest)
        return -value if turns >= 2 else value + 0.0
    mp = _digits_of(theta)
    if mp is not None:
        return mp.sinpi(theta / 180 + mp.mpf(quarters) / 2)
    theta = _floating(theta)
    turns = np.rint(theta / 90.0)
    rest = np.deg2rad(theta - 90.0 * turns)
    turns = turns + quarters
    quarter = np.arctan2(theta.dtype.type(1), theta.dtype.type(0))
    value = np.sin(rest + quarter * (turns - 2.0 * np.floor(turns / 2.0)))
    return np.where(turns - 4.0 * np.floor(turns / 4.0) >= 2.0, -value, value) + theta.dtype.type(0)


def sin(theta: Angle) -> Angle:
    """Return the sine of an angle in degrees."""
    return _sine_of_quarters(theta, 0)


def cos(theta: Angle) -> Angle:
    """Return the cosine of an angle in degrees."""
    return _sine_of_quarters(theta, 1)


def tan(theta: Angle) -> Angle:
    """Return the tangent of an angle in degrees; infinite at odd multiples of 90 in arrays, an error on a
    scalar."""
    return sin(theta) / cos(theta)


def polar(length: Any, theta: Angle) -> Any:
    """Return the vector ``length e^{i theta}`` as a complex number."""
    return length * (cos(theta) + 1j * sin(theta))


def angle(vector: Any) -> Angle:
    """Return the direction of a complex vector, in (-180, 180], by its quadrant rather than by a quotient."""
    if _is_scalar(vector):
        result = math.degrees(cmath.phase(vector))
        return 180.0 if result == -180.0 else result
    mp = _digits_of(vector)
    if mp is not None:
        return mp.degrees(mp.arg(vector))
    result = np.degrees(np.angle(vector))
    return np.where(result == -180.0, -result, result)


def atan2(y: Any, x: Any) -> Angle:
    """Return the direction of the vector (x, y), in (-180, 180]."""
    if _is_scalar(y, x):
        result = math.degrees(math.atan2(y, x))
        return 180.0 if result == -180.0 else result
    mp = _digits_of(y, x)
    if mp is not None:
        return mp.degrees(mp.atan2(y, x))
    result = np.degrees(np.arctan2(y, x))
    return np.where(result == -180.0, -result, result)


def atan(x: Any) -> Angle:
    """Return the arctangent, in (-90, 90); of a quotient y/x it loses the quadrant."""
    return _inverse("atan", x)


def asin(x: Any) -> Angle:
    """Return the arcsine, in [-90, 90]."""
    return _inverse("asin", x)


def acos(x: Any) -> Angle:
    """Return the arccosine, in [0, 180]."""
    return _inverse("acos", x)


def _inverse(name: str, x: Any) -> Angle:
    if _is_scalar(x):
        return math.degrees(getattr(math, name)(x))
    mp = _digits_of(x)
    if mp is not None:
        return mp.degrees(getattr(mp, name)(x))
    return np.degrees(getattr(np, name.replace("a", "arc", 1))(x))


def from_radians(theta: Any) -> Angle:
    """Return the degrees of an angle in radians; (-pi, pi] becomes (-180, 180]."""
    mp = _digits_of(theta)
    return theta * (180.0 / math.pi) if mp is None else mp.degrees(theta)


def sqrt(x: Any) -> Any:
    """Return the square root; NaN below zero in arrays, an error on a scalar."""
    if _is_scalar(x):
        return math.sqrt(x)
    mp = _digits_of(x)
    return np.sqrt(x) if mp is None else mp.sqrt(x)


def wrap(theta: Angle) -> Angle:
    """Return the angle reduced to (-180, 180]."""
    if _is_scalar(theta):
        rest = math.remainder(theta, 360.0)
        return 180.0 if rest == -180.0 else rest
    mp = _digits_of(theta)
    if mp is not None:
        return theta - 360 * mp.ceil(theta / 360 - mp.mpf(1) / 2)
    rest = theta - 360.0 * np.rint(np.asarray(theta) / 360.0)
    return np.where(rest <= -180.0, rest + 360.0, rest)
