"""Trigonometry in degrees, exact where degrees are: ``sin(180)`` is 0 and ``cos(60 + 360 k)`` is ``cos(60)``.

Solutions write the formulas of the course with these functions. Each takes a scalar or an array and
gives the same shape. Angles that come out lie in (-180, 180] unless said otherwise.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

Angle = Any  #: degrees, a scalar or an array


def _is_scalar(*values: Any) -> bool:
    return all(isinstance(v, (float, int, complex)) for v in values)


def _sine_of_quarters(theta: Angle, quarters: int) -> Angle:
    """Sine of ``theta + 90 quarters``, the quarters of a turn taken out exactly first."""
    if isinstance(theta, (float, int)):
        if not math.isfinite(theta):
            return math.nan
        theta = math.fmod(theta, 360.0)
        turns = round(theta / 90.0)
        rest = math.radians(theta - 90.0 * turns)
        turns = (turns + quarters) % 4
        value = math.cos(rest) if turns % 2 else math.sin(rest)
        return -value if turns >= 2 else value + 0.0
    theta = np.asarray(theta, dtype=float)
    turns = np.rint(theta / 90.0)
    rest = np.deg2rad(theta - 90.0 * turns)
    turns = np.mod(turns + quarters, 4.0)
    value = np.sin(rest + np.where(turns % 2.0 == 1.0, math.pi / 2, 0.0))
    return np.where(turns >= 2.0, -value, value) + 0.0


def sin(theta: Angle) -> Angle:
    """Sine of an angle in degrees."""
    return _sine_of_quarters(theta, 0)


def cos(theta: Angle) -> Angle:
    """Cosine of an angle in degrees."""
    return _sine_of_quarters(theta, 1)


def tan(theta: Angle) -> Angle:
    """Tangent of an angle in degrees; infinite at odd multiples of 90 in arrays, an error on a scalar."""
    return sin(theta) / cos(theta)


def polar(length: Any, theta: Angle) -> Any:
    """The vector ``length e^{i theta}`` as a complex number."""
    return length * (cos(theta) + 1j * sin(theta))


def angle(vector: Any) -> Angle:
    """Direction of a complex vector, in (-180, 180]: by its quadrant, never by a quotient."""
    if _is_scalar(vector):
        found = math.degrees(cmath.phase(vector))
        return 180.0 if found == -180.0 else found
    found = np.degrees(np.angle(vector))
    return np.where(found == -180.0, 180.0, found)


def atan2(y: Any, x: Any) -> Angle:
    """Direction of the vector (x, y), in (-180, 180]."""
    if _is_scalar(y, x):
        found = math.degrees(math.atan2(y, x))
        return 180.0 if found == -180.0 else found
    found = np.degrees(np.arctan2(y, x))
    return np.where(found == -180.0, 180.0, found)


def atan(x: Any) -> Angle:
    """Arctangent, in (-90, 90): loses the quadrant of a quotient."""
    return math.degrees(math.atan(x)) if _is_scalar(x) else np.degrees(np.arctan(x))


def asin(x: Any) -> Angle:
    """Arcsine, in [-90, 90]."""
    return math.degrees(math.asin(x)) if _is_scalar(x) else np.degrees(np.arcsin(x))


def acos(x: Any) -> Angle:
    """Arccosine, in [0, 180]."""
    return math.degrees(math.acos(x)) if _is_scalar(x) else np.degrees(np.arccos(x))


def from_radians(theta: Any) -> Angle:
    """Degrees of an angle in radians; (-pi, pi] becomes (-180, 180]."""
    return theta * (180.0 / math.pi)


def sqrt(x: Any) -> Any:
    """Square root; NaN below zero in arrays, an error on a scalar."""
    return math.sqrt(x) if _is_scalar(x) else np.sqrt(x)


def wrap(theta: Angle) -> Angle:
    """The same direction in (-180, 180]."""
    if _is_scalar(theta):
        rest = math.remainder(theta, 360.0)
        return 180.0 if rest == -180.0 else rest
    rest = theta - 360.0 * np.rint(np.asarray(theta) / 360.0)
    return np.where(rest <= -180.0, rest + 360.0, rest)
