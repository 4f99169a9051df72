"""Sides and angles of a triangle that keep their digits when it is flat or its angle is small.

Lengths in one common unit, positive; scalars or arrays that broadcast. An angle that is given is in radians
or a heading (:mod:`angles`), one that is found is in radians in [0, pi]. What is not a triangle raises
:class:`CannotAssemble` when every argument is a scalar, and is NaN there and only there in arrays.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from coursework.errors import CannotAssemble
from coursework.kinematics.angles import half_angle


def third_side(first: Any, other: Any, angle: Any) -> Any:
    """Return the side opposite to the angle between two sides.

    Parameters
    ----------
    first, other
        Sides, positive, in one unit.
    angle
        Angle between them, radians or a heading (:mod:`angles`).

    Returns
    -------
    The side in that unit, of the broadcast shape.

    Source
    ------
    The law of cosines as a sum of two squares, ``(other - first)^2 + 4 first other sin^2(angle/2)``.
    """
    return np.sqrt(_square_of_third(first, other, half_angle(angle)[1]))


def corner(near: Any, other: Any, opposite: Any) -> Any:
    """Return the angle between the sides ``near`` and ``other``.

    Parameters
    ----------
    near, other
        Sides that form the angle, positive, in one unit.
    opposite
        Side opposite to it, in the same unit.

    Returns
    -------
    Radians in [0, pi], of the broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: one side exceeds the two others together.

    Source
    ------
    The half-angle formula: its tangent squared is ``(s - near)(s - other) / (s (s - opposite))``.
    """
    across = (opposite - near + other) * (opposite + near - other)
    along = (near + other - opposite) * (near + other + opposite)
    _refuse_if_negative(across, along, near, other, opposite)
    with np.errstate(invalid="ignore"):
        return 2 * _direction(np.sqrt(across), np.sqrt(along))


def corner_beside(first: Any, other: Any, angle: Any, third: Any) -> Any:
    """Return the angle between ``first`` and the third side, given the angle between ``first`` and ``other``
    as well.

    ``third`` decides: if it differs from what the two sides and their angle give, being rounded or measured,
    the angle is that of the triangle of the three sides. If it agrees, a flat triangle costs no digit.

    Parameters
    ----------
    first, other
        Sides, positive, in one unit.
    angle
        Angle between them, radians or a heading (:mod:`angles`).
    third
        The third side, in the same unit.

    Returns
    -------
    Radians in [0, pi], of the broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: the three sides make no triangle.

    Source
    ------
    Sine and cosine together: Heron's formula and the law of cosines, each as the value that the angle gives
    and what the third side changes of it.
    """
    half_cos, half_sin = half_angle(angle)
    square = _square_of_third(first, other, half_sin)
    change = (third - np.sqrt(square)) * (third + np.sqrt(square))
    longer = 4 * first * other * half_cos**2 - change
    shorter = 4 * first * other * half_sin**2 + change
    _refuse_if_negative(longer, shorter, first, other, third)
    along = 2 * first * ((first - other) + 2 * other * half_sin**2) + change
    with np.errstate(invalid="ignore"):
        return _direction(np.sqrt(longer * shorter), along)


def _direction(y: Any, x: Any) -> Any:
    if np.ndim(y):
        return np.arctan2(y, x)
    mp = getattr(y, "context", None)  # a number of mpmath keeps its digits
    return math.atan2(y, x) if mp is None else mp.atan2(y, x)


def _square_of_third(first: Any, other: Any, half_sin: Any) -> Any:
    return (other - first) ** 2 + 4 * first * other * half_sin**2


def _refuse_if_negative(margin: Any, other_margin: Any, *sides: Any) -> None:
    if np.ndim(margin) == 0 and min(margin, other_margin) < 0:
        text = ", ".join(f"{side:.6g}" for side in sides[:2])
        raise CannotAssemble(
            "the sides {shorter} and {longest:.6g} make no triangle: the longest exceeds the two "
            "others together",
            shorter=text,
            longest=sides[2],
        )
