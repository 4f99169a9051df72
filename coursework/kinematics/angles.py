"""Crank angles as sines and cosines: exact for degrees, and independent of whole turns.

A linkage is turned by the cosine and sine of its crank angle and of half of it. A number of radians
cannot say half a turn exactly; a number of degrees can. So every function of the core that takes a
crank angle takes radians or a :class:`Heading` made here.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from coursework import degrees


class Heading(NamedTuple):
    """A direction by four numbers (scalars or arrays of one shape).

    ``half_cos`` and ``half_sin`` are those of half the angle, signed: they tell an angle from the same angle
    a turn later, which a linkage that passes a change point needs.
    """

    cos: Any
    sin: Any
    half_cos: Any
    half_sin: Any


def heading_in_degrees(angle: Any) -> Heading:
    """Heading of an angle in degrees, reduced exactly: at 180 the sine and the half cosine are 0."""
    return Heading(
        degrees.cos(angle), degrees.sin(angle), degrees.cos(_half(angle)), degrees.sin(_half(angle))
    )


def heading_after_turns(turns: Any, angle: Any) -> Heading:
    """Heading after whole turns and an angle in radians beyond: the turns lose no digit of the angle."""
    sign = np.where(np.mod(turns, 2) == 0, 1.0, -1.0)[()]
    half = np.multiply(angle, 0.5)
    return Heading(np.cos(angle), np.sin(angle), sign * np.cos(half), sign * np.sin(half))


def heading_of(cos: Any, sin: Any) -> Heading:
    """Heading of direction cosines (of a unit vector), the angle taken in (-pi, pi]."""
    larger, smaller = halves(np.abs(cos), sin)
    ahead = np.greater_equal(cos, 0)
    half_cos, half_sin = np.sqrt(np.where(ahead, larger, smaller)), np.sqrt(np.where(ahead, smaller, larger))
    return Heading(cos, sin, half_cos[()], np.copysign(half_sin, sin)[()])


def full_angle(angle: Any) -> tuple[Any, Any]:
    """Cosine and sine of radians or of a heading."""
    if isinstance(angle, Heading):
        return angle.cos, angle.sin
    return np.cos(angle), np.sin(angle)


def half_angle(angle: Any) -> tuple[Any, Any]:
    """Cosine and sine of half the angle, signed; each is accurate to the last digits where it is small."""
    if isinstance(angle, Heading):
        return angle.half_cos, angle.half_sin
    half = np.multiply(angle, 0.5)
    return np.cos(half), np.sin(half)


def halves(abs_cos: Any, sin: Any) -> tuple[Any, Any]:
    """The larger and the smaller of (1 + cos)/2 and (1 - cos)/2, neither a difference; also with the
    roles exchanged."""
    larger = (1 + abs_cos) / 2
    return larger, np.multiply(sin, sin) / (4 * larger)


def _half(angle: Any) -> Any:
    return angle / 2 if isinstance(angle, (int, float)) else np.asarray(angle, dtype=float) / 2
