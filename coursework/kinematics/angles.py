"""Crank angles as sines and cosines: exact for degrees, and independent of whole turns.

A linkage is turned by the cosine and sine of its crank angle and of half of it. A number of radians
cannot say half a turn exactly; a number of degrees can. So every function of the core that takes a
crank angle takes radians or :class:`Degrees`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from coursework import degrees
from coursework.kinematics.elementary import tangent


class Degrees(NamedTuple):
    """Heading given by its angle in degrees, reduced exactly: at 180 the sine and the half cosine are 0.

    Its four numbers are computed when they are asked for. ``rest`` is what rounding took from the angle.
    """

    angle: Any
    rest: Any = 0.0

    @staticmethod
    def between(start: Any, end: Any) -> Degrees:
        """Return the angle from one direction to another, ``end - start``, without rounding.

        Parameters
        ----------
        start, end
            Angles of the directions, degrees; scalars or arrays that broadcast.

        Returns
        -------
        The angle, with what rounding took from it, of the broadcast shape.

        Source
        ------
        The rounding error of a sum of two numbers is a number: Knuth's TwoSum.
        """
        angle = end - start
        part = angle + start
        return Degrees(angle, (end - part) - (start - (part - angle)))

    @property
    def cos(self) -> Any:
        return self._turned(degrees.cos, degrees.sin, self.angle, -self.rest * _DEGREE)

    @property
    def sin(self) -> Any:
        return self._turned(degrees.sin, degrees.cos, self.angle, self.rest * _DEGREE)

    @property
    def half_cos(self) -> Any:
        return self._turned(degrees.cos, degrees.sin, self._half, -self.rest * (0.5 * _DEGREE))

    @property
    def half_sin(self) -> Any:
        return self._turned(degrees.sin, degrees.cos, self._half, self.rest * (0.5 * _DEGREE))

    @staticmethod
    def _turned(function: Callable, slope: Callable, angle: Any, rest: Any) -> Any:
        return function(angle) + slope(angle) * rest if np.ndim(rest) or rest else function(angle)

    def half_squares(self, scale: Any) -> tuple[Any, Any, Any]:
        """Return cosine squared, sine squared and cosine times sine of half the angle, each times a scale.

        Parameters
        ----------
        scale
            Factor w, in any unit; a scalar or an array that broadcasts with the angle.

        Returns
        -------
        ``w cos^2``, ``w sin^2`` and ``w cos sin`` of half the angle, in the unit of the scale, of the
        broadcast shape.

        Source
        ------
        One tangent t gives all three, ``1 / (1 + t^2)``, ``t^2 / (1 + t^2)`` and ``t / (1 + t^2)``: it is
        that of what half the angle has beyond whole quarters of a turn.
        """
        quarters = np.rint(np.multiply(self.angle, 1 / 180))
        beyond = np.multiply(self.angle, 0.5)
        beyond -= 90.0 * quarters
        if np.ndim(self.rest) or self.rest:
            beyond = beyond + np.multiply(self.rest, 0.5)
        beyond *= _DEGREE
        slope = tangent(beyond)
        squared = slope * slope
        cos_squared = scale / (1 + squared)
        return _quarters_on(quarters, cos_squared, squared * cos_squared, slope * cos_squared)

    @property
    def _half(self) -> Any:
        return self.angle / 2 if isinstance(self.angle, (int, float)) else np.asarray(self.angle, float) / 2


_DEGREE = math.pi / 180


def _quarters_on(quarters: Any, cos_squared: Any, sin_squared: Any, both: Any) -> tuple[Any, Any, Any]:
    """Return the three products after whole quarters of a turn: each quarter exchanges cosine and sine and
    changes the sign of their product."""
    least = np.min(quarters, initial=np.inf)
    if least == np.max(quarters, initial=-np.inf):
        odd = least % 2 == 1
        return (sin_squared, cos_squared, -both) if odd else (cos_squared, sin_squared, both)
    odd = quarters - 2 * np.floor(0.5 * quarters)
    even = 1 - odd
    return (
        even * cos_squared + odd * sin_squared,
        even * sin_squared + odd * cos_squared,
        (even - odd) * both,
    )


def taken_apart(angle: Any) -> tuple[Callable[..., Any], tuple[Any, ...]]:
    """Return a constructor and the arrays from which it builds these radians or this heading again.

    Parameters
    ----------
    angle
        Radians or a heading; scalars or arrays of one shape.

    Returns
    -------
    The constructor, and as many arrays of floats as it takes, of that shape.
    """
    make, parts = (type(angle), angle) if isinstance(angle, Degrees) else (_radians, (angle,))
    return make, tuple(np.asarray(part, dtype=float)[()] for part in parts)


def _radians(angle: Any) -> Any:
    return angle


def full_angle(angle: Any) -> tuple[Any, Any]:
    """Return the cosine and sine of radians or of a heading.

    Parameters
    ----------
    angle
        Radians or a heading; scalars or arrays of one shape.

    Returns
    -------
    Cosine and sine, of that shape.
    """
    if isinstance(angle, Degrees):
        return angle.cos, angle.sin
    return np.cos(angle), np.sin(angle)


def half_angle(angle: Any) -> tuple[Any, Any]:
    """Return the signed cosine and sine of half the angle, each accurate to the last digits near its zero.

    Parameters
    ----------
    angle
        Radians or a heading; scalars or arrays of one shape.

    Returns
    -------
    Cosine and sine of half the angle, of that shape.
    """
    if isinstance(angle, Degrees):
        return angle.half_cos, angle.half_sin
    half = np.multiply(angle, 0.5)
    return np.cos(half), np.sin(half)


def halves(abs_cos: Any, sin: Any) -> tuple[Any, Any]:
    """Return (1 + cos)/2 and (1 - cos)/2, the larger first, neither as a difference. Exchange the arguments
    for the sine.

    Parameters
    ----------
    abs_cos
        Absolute value of the cosine, from 0 to 1; a scalar or an array.
    sin
        Sine of the same angle, of the same shape.

    Returns
    -------
    Both halves for this absolute value, of that shape.

    Source
    ------
    ``1 - cos = sin^2 / (1 + cos)``.
    """
    larger = (1 + abs_cos) / 2
    return larger, np.multiply(sin, sin) / (4 * larger)
