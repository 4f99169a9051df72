"""Assour groups of two bodies in closed form, in any orientation, and the drivers that move them.

Points are complex numbers, angles radians, lengths one common unit; every argument is a scalar or
an array and all broadcast. A line is a point and a complex unit vector along it.

What does not close raises :class:`CannotAssemble` when every argument is a scalar, and is NaN there and
only there in arrays. Positions come first; each group has its ``..._rates``, for velocities,
accelerations and jerks: give it the known time derivatives from the first to the order wanted, and
nothing beyond is computed. All orders share one 2x2 matrix, singular at a dead point: :class:`Undefined`
for scalars, NaN in arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from coursework.errors import CannotAssemble, CourseworkError, Undefined
from coursework.kinematics.angles import full_angle
from coursework.kinematics.scaling import exponent_of, scaled
from coursework.kinematics.vectors import components, cross, derivative, dot, size
from coursework.messages import Message
from coursework.system.blocks import in_blocks

OPEN, CROSSED = 1, -1  #: sides of the inner joint: left of the directed line P -> Q, or right

Rates = Sequence[Any]  #: time derivatives of a point (complex) or of an angle, from the first on


def side_of(mode: Any) -> Any:
    """Return +1 for ``open`` (or ``left``), -1 for ``crossed`` (or ``right``); arrays of texts as well.

    Parameters
    ----------
    mode
        One of the four words, or an array of them.

    Returns
    -------
    +1 or -1, of the same shape.

    Raises
    ------
    KeyError
        A single word that is none of the four.
    """
    if isinstance(mode, str):
        return {"open": OPEN, "left": OPEN, "crossed": CROSSED, "right": CROSSED}[mode]
    return np.where(np.isin(mode, ("open", "left")), OPEN, CROSSED)


def rotating(pivot: Any, length: Any, angle: Any) -> Any:
    """Return the end of a crank about ``pivot``.

    Its derivatives are :func:`vectors.turned` of the vector from the pivot.

    Parameters
    ----------
    pivot
        Fixed end, complex.
    length
        Length of the crank, in the unit of the pivot.
    angle
        Radians or a heading (:mod:`angles`).

    Returns
    -------
    The point, complex, of the broadcast shape.

    Source
    ------
    ``pivot + length e^(i angle)``.
    """
    cos, sin = full_angle(angle)
    return pivot + length * (cos + 1j * sin)


def sliding(point: Any, along: Any, distance: Any) -> Any:
    """Return the pin of a driven slider, ``distance`` from ``point`` in the direction ``along``.

    Parameters
    ----------
    point
        Point from which the distance is measured, complex.
    along
        Direction, a complex unit vector.
    distance
        Length of either sign, in the unit of the point.

    Returns
    -------
    The pin, complex, of the broadcast shape.

    Source
    ------
    ``point + distance along``.
    """
    return point + along * distance


def rrr(p: Any, q: Any, p_length: Any, q_length: Any, side: Any = OPEN) -> Any:
    """Return the inner joint B of the dyad of three revolutes: |B - p| = p_length, |B - q| = q_length.

    Parameters
    ----------
    p, q
        End points, complex.
    p_length, q_length
        Lengths of the bodies pinned at p and at q, positive.
    side
        +1 when B lies left of the directed line p -> q (``open``), -1 when right (``crossed``).

    Returns
    -------
    B, complex, of the broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: the circles do not meet, with the gap in figures.
    Undefined
        Scalars only: p and q coincide and the lengths are equal, so that B may be anywhere on a circle.

    Source
    ------
    Intersection of two circles. The triangle's area is the product of its four margins (Heron), so
    that it is exactly zero where the bodies line up. A four-bar from its own lengths:
    :class:`four_bar.FourBar`.
    """
    return _solved(_rrr, _rrr_failure, p, q, p_length, q_length, side)


def rrp(p: Any, length: Any, line: Any, side: Any = 1, along: Any = 1.0) -> Any:
    """Return the slider pinned to a rod: the point of a line at ``length`` from the rod's other pin ``p``.

    Parameters
    ----------
    p
        Pin of the rod, complex.
    length
        Length of the rod, positive.
    line
        A point of the line if complex; a real number is the ordinate of a horizontal line.
    side
        +1 when the slider lies ahead of ``p`` along the line, -1 when behind.
    along
        Direction of the line, a complex unit vector.

    Returns
    -------
    The slider, complex, of the broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: the rod is shorter than the distance of ``p`` from the line.

    Source
    ------
    Pythagoras: the square of the run along the line is ``(length - rise)(length + rise)``, with the rise from
    ``p`` to the line.
    """
    point = line if np.iscomplexobj(line) else 1j * np.asarray(line)[()]
    return _solved(_rrp, _rrp_failure, p, length, point, side, along)


def rpr(p: Any, q: Any, offset: Any = 0.0, side: Any = 1) -> tuple[Any, Any]:
    """Return the direction and the slide of a block pinned at ``p`` on a guide pinned at ``q``.

    Parameters
    ----------
    p, q
        Pins of the block and of the guide, complex.
    offset
        Distance of the slot from ``q``, parallel to the guide's own direction u; positive to its left.
    side
        Sign of the slide, +1 or -1.

    Returns
    -------
    The direction u, a complex unit vector, and the slide, in the unit of the points, of the broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: p is nearer to q than the offset.
    Undefined
        Scalars only: p lies on q and there is no offset.

    Source
    ------
    ``p = q + (slide + i offset) u`` with ``slide^2 = (|p - q| - offset)(|p - q| + offset)``.
    """
    return _solved(_rpr, _rpr_failure, p, q, offset, side)


def prp(first_point: Any, first_along: Any, second_point: Any, second_along: Any) -> Any:
    """Return the pin of two blocks, each on its own line: the intersection of the lines. One assembly only.

    Parameters
    ----------
    first_point, second_point
        A point of each line, complex.
    first_along, second_along
        Their directions, complex unit vectors.

    Returns
    -------
    The pin, complex, of the broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: the lines are parallel.

    Source
    ------
    Cramer's rule (:func:`vectors.components`).
    """
    return _solved(_prp, _prp_failure, first_point, first_along, second_point, second_along)


def rpp(p: Any, point: Any, along: Any, across: Any) -> tuple[Any, Any]:
    """Return both slides of a body pinned at ``p`` that slides ``across`` a block, which slides ``along`` a
    line. One assembly only.

    Parameters
    ----------
    p
        Pin of the body, complex.
    point
        Point of the line from which the first slide is measured, complex.
    along, across
        Directions of both slides, complex unit vectors.

    Returns
    -------
    The slides along and across, of either sign, in the unit of the points, of the broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: the two directions are parallel.

    Source
    ------
    ``p = point + first along + second across``, by Cramer's rule (:func:`vectors.components`).
    """
    return _solved(_rpp, _rpp_failure, p, point, along, across)


def rrr_rates(p_arm: Any, q_arm: Any, p_rates: Rates, q_rates: Rates) -> tuple[tuple, tuple]:
    """Return the derivatives of the angles of both bodies of an RRR dyad.

    The point B itself moves by ``p_rates`` plus :func:`vectors.turned` of ``p_arm``.

    Parameters
    ----------
    p_arm, q_arm
        Vectors B - p and B - q now, complex.
    p_rates, q_rates
        Time derivatives of p and q from the first on, complex, of equal number.

    Returns
    -------
    The derivatives of the angle of the body at p, and of that at q: rad/s, rad/s^2, rad/s^3, as many as are
    given.

    Raises
    ------
    Undefined
        Scalars only: both bodies are in line.

    Source
    ------
    B has one velocity as a point of either body; so for the higher derivatives.
    """

    def known(n: int, p_turn: list, q_turn: list) -> Any:
        apart = q_rates[n - 1] - p_rates[n - 1]
        return apart + derivative(q_arm, 0.0, (), q_turn, n) - derivative(p_arm, 0.0, (), p_turn, n)

    return _rates(known, 1j * np.asarray(p_arm), -1j * np.asarray(q_arm), len(p_rates))


def out_of_reach(
    distance: float,
    p_length: float,
    q_length: float,
    gap: float | None = None,
    subject: str = "the two bodies",
) -> CannotAssemble:
    """Return the error for two bodies that do not span the distance between their pins, with the gap.

    Parameters
    ----------
    distance
        Distance between the pins; a scalar.
    p_length, q_length
        Lengths of the two bodies, scalars in the same unit.
    gap
        Length that is lacking, where it is known better than as a difference of the others.
    subject
        Names of the two bodies in the message.

    Returns
    -------
    The error, to be raised.
    """
    least, most = abs(p_length - q_length), p_length + q_length
    gap = max(distance - most, least - distance) if gap is None else gap
    return CannotAssemble(
        "the linkage does not close: the pins are {distance:.6g} apart, but {subject}, {p_length:.6g} "
        "and {q_length:.6g} long, reach only {least:.6g} to {most:.6g} (gap {gap:.3g})",
        distance=distance,
        subject=Message(subject),
        p_length=p_length,
        q_length=q_length,
        least=least,
        most=most,
        gap=gap,
    )


def _solved(kernel: Callable, failure: Callable[..., CourseworkError], *given: Any) -> Any:
    """Evaluate a kernel in blocks; scalars come back as plain numbers, or raise the error of ``failure``."""
    given = tuple(np.asarray(x)[()] for x in given)
    results = in_blocks(kernel, *given)
    if not np.ndim(results[0]):
        results = tuple(value.item() for value in results)
        if any(value != value for value in results):
            with np.errstate(all="ignore"):
                raise failure(*given)
    return results if len(results) > 1 else results[0]


def _rates(right_side: Callable, first: Any, second: Any, count: int) -> tuple[tuple, tuple]:
    """Solve ``first * x + second * y = known(order)`` for the rates x and y, order after order."""
    xs: list[Any] = []
    ys: list[Any] = []
    with np.errstate(all="ignore"):
        for n in range(1, count + 1):
            x, y = components(right_side(n, xs, ys), first, second)
            xs.append(x)
            ys.append(y)
    if xs and not np.ndim(xs[0]) and not (np.isfinite(xs[0]) and np.isfinite(ys[0])):
        raise Undefined("the two bodies are in line: at a dead point the rates do not exist")
    return tuple(xs), tuple(ys)


def _rrr(p: Any, q: Any, p_length: Any, q_length: Any, side: Any) -> tuple[Any]:
    exponent = exponent_of(p_length, q_length)
    line, b, c = (scaled(x, -exponent) for x in (q - p, p_length, q_length))
    squared = line.real**2 + line.imag**2
    distance = np.sqrt(squared)
    fold = (distance - b + c) * (distance + b - c)
    area = np.sqrt((b + c + distance) * (b + c - distance) * fold)
    # distance^2 + b^2 - c^2, without its cancellation when the bodies fold onto the line.
    along = fold + 2 * b * (b - c)
    squared = np.where(squared == 0, np.nan, squared)
    return (p + scaled(line * (along + 1j * (side * area)) / (2 * squared), exponent),)


def _rrr_failure(p: Any, q: Any, p_length: Any, q_length: Any, _: Any) -> CourseworkError:
    distance = float(np.hypot(np.real(q - p), np.imag(q - p)))
    if distance == 0 and p_length == q_length:
        return Undefined(
            "the two bodies are both {p_length:.6g} long and their far pins coincide: they may point "
            "anywhere",
            p_length=p_length,
        )
    return out_of_reach(distance, float(p_length), float(q_length))


def _rrp(p: Any, length: Any, point: Any, side: Any, along: Any) -> tuple[Any]:
    exponent = exponent_of(length)
    to_point = point - p
    rise, reach = scaled(cross(along, to_point), -exponent), scaled(length, -exponent)
    run = scaled(side * np.sqrt((reach - rise) * (reach + rise)), exponent)
    return (point + along * (run - dot(along, to_point)),)


def _rrp_failure(p: Any, length: Any, point: Any, _: Any, along: Any) -> CannotAssemble:
    away = abs(float(cross(along, point - p)))
    return CannotAssemble(
        "the linkage does not close: the line is {away:.6g} away from the pin, but the rod reaches "
        "only {rod:.6g} (gap {gap:.3g})",
        away=away,
        rod=length,
        gap=away - length,
    )


def _rpr(p: Any, q: Any, offset: Any, side: Any) -> tuple[Any, Any]:
    arm = p - q
    exponent = exponent_of(np.real(arm), np.imag(arm), offset)
    arm, aside = scaled(arm, -exponent), scaled(offset, -exponent)
    distance = size(arm)
    slide = side * np.sqrt((distance - aside) * (distance + aside))
    unit = arm / (slide + 1j * aside)
    return unit / size(unit), scaled(slide, exponent)


def _rpr_failure(p: Any, q: Any, offset: Any, _: Any) -> CourseworkError:
    distance = float(np.hypot(np.real(p - q), np.imag(p - q)))
    if distance >= abs(offset):
        return Undefined("the block lies on the guide's pivot: the guide has no direction there")
    return CannotAssemble(
        "the linkage does not close: the block is {distance:.6g} from the guide's pivot, but the slot "
        "passes {offset:.6g} away (gap {gap:.3g})",
        distance=distance,
        offset=abs(offset),
        gap=abs(offset) - distance,
    )


def _prp(first_point: Any, first_along: Any, second_point: Any, second_along: Any) -> tuple[Any]:
    first, _ = components(second_point - first_point, first_along, -second_along)
    return (first_point + first_along * np.where(np.isfinite(first), first, np.nan),)


def _prp_failure(first_point: Any, first_along: Any, second_point: Any, _: Any) -> CannotAssemble:
    apart = abs(float(cross(first_along, second_point - first_point)))
    return CannotAssemble("the linkage does not close: the lines are parallel (gap {apart:.3g})", apart=apart)


def _rpp(p: Any, point: Any, along: Any, across: Any) -> tuple[Any, Any]:
    first, second = components(p - point, along, across)
    exists = np.isfinite(first) & np.isfinite(second)
    return np.where(exists, first, np.nan), np.where(exists, second, np.nan)


def _rpp_failure(p: Any, point: Any, along: Any, _: Any) -> CannotAssemble:
    apart = abs(float(cross(along, p - point)))
    return CannotAssemble(
        "the linkage does not close: the two slides are parallel (gap {apart:.3g})", apart=apart
    )
