"""Plane vectors as complex numbers, and their derivatives when their length and their angle vary."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from coursework.kinematics.elementary import arctangent
from coursework.kinematics.scaling import exponent_of, scaled


def cross(u: Any, v: Any) -> Any:
    """Return the z component of u x v.

    Parameters
    ----------
    u, v
        Vectors, complex; scalars or arrays that broadcast.

    Returns
    -------
    A real number, in the product of their units, of the broadcast shape.

    Source
    ------
    ``u_x v_y - u_y v_x``.
    """
    return np.real(u) * np.imag(v) - np.imag(u) * np.real(v)


def dot(u: Any, v: Any) -> Any:
    """Return the scalar product.

    Parameters
    ----------
    u, v
        Vectors, complex; scalars or arrays that broadcast.

    Returns
    -------
    A real number, in the product of their units, of the broadcast shape.

    Source
    ------
    ``u_x v_x + u_y v_y``.
    """
    return np.real(u) * np.real(v) + np.imag(u) * np.imag(v)


def size(u: Any) -> Any:
    """Return the length of a vector whose square neither overflows nor vanishes.

    Parameters
    ----------
    u
        Vector, complex; a scalar or an array.

    Returns
    -------
    The length, in its unit, of the same shape.

    Source
    ------
    ``sqrt(u_x^2 + u_y^2)``.
    """
    return np.sqrt(np.real(u) ** 2 + np.imag(u) ** 2)


def direction(y: Any, x: Any) -> Any:
    """Return the angle of the vector (x, y), for arrays faster than ``arctan2``.

    Parameters
    ----------
    y, x
        Components in one unit; scalars or arrays that broadcast.

    Returns
    -------
    Radians in (-pi, pi], of the broadcast shape; NaN for the zero vector.

    Source
    ------
    The arctangent of ``y / x``, and half a turn where x < 0.
    """
    quotient = np.divide(y, x)
    result = np.arctan(quotient)
    # Half a turn where x < 0, towards the side of y.
    result += np.copysign(np.multiply(np.signbit(x), math.pi), y)
    if np.min(result, initial=math.inf) > -math.pi:
        return result
    return np.where(result == -math.pi, math.pi, result)


def direction_of(y: Any, x: Any, length: Any) -> Any:
    """Return the angle of the vector (x, y) of known length, by the tangent of half the angle; faster than
    :func:`direction`.

    Overwrites the arrays that it is given.

    Parameters
    ----------
    y, x
        Components in one unit; scalars or arrays of one shape.
    length
        Length of the vector, in the same unit and shape.

    Returns
    -------
    Radians in (-pi, pi], of that shape; NaN for the zero vector.

    Source
    ------
    The tangent of half the angle is ``y / (length + x)``.
    """
    if np.min(x, initial=0.0) >= 0:
        length += x
        return _twice_arctangent(y, length)
    # Behind the y axis it is half a turn, on the side of y, less the angle from the other end of the x axis.
    beyond = np.copysign(math.pi, y + 0.0)
    if np.max(x, initial=0.0) <= 0:
        length -= x
        beyond -= _twice_arctangent(y, length)
    else:
        ways = np.copysign(1.0, x)
        length += np.abs(x)
        beyond *= 0.5 - 0.5 * ways
        ways *= _twice_arctangent(y, length)
        beyond += ways
    if np.min(beyond, initial=0.0) > -math.pi:
        return beyond
    return np.where(beyond == -math.pi, math.pi, beyond)


def _twice_arctangent(y: Any, x: Any) -> Any:
    """Return twice the arctangent of y / x, a quotient between -1 and 1; overwrites ``y``."""
    y /= x
    result = arctangent(y)
    result *= 2
    return result


def components(r: Any, u: Any, v: Any) -> tuple[Any, Any]:
    """Return the real numbers with ``first * u + second * v = r`` (Cramer's rule); inf or NaN for parallel u
    and v.

    Parameters
    ----------
    r
        Vector to be resolved, complex; a scalar or an array.
    u, v
        Vectors along which it is resolved, complex, not parallel; scalars or arrays that broadcast.

    Returns
    -------
    Both numbers, of the broadcast shape.

    Source
    ------
    ``first = (r x v) / (u x v)`` and ``second = (u x r) / (u x v)``.
    """
    # Vectors of lengths far from 1 are scaled: their product would overflow or vanish.
    of_u, of_v = exponent_of(np.real(u), np.imag(u)), exponent_of(np.real(v), np.imag(v))
    u, v = scaled(u, -of_u), scaled(v, -of_v)
    inverse = np.divide(1.0, cross(u, v))
    return scaled(cross(r, v) * inverse, -of_u)[()], scaled(cross(u, r) * inverse, -of_v)[()]


def derivative(
    arm: Any, unit: Any, length_rates: Sequence[Any], angle_rates: Sequence[Any], order: int
) -> Any:
    """Return the time derivative of a vector ``arm`` whose length and angle vary.

    Parameters
    ----------
    arm
        The vector now, complex.
    unit
        The direction in which its length grows, a complex unit vector that turns with it.
    length_rates, angle_rates
        Time derivatives of the length and of the angle from the first on, as far as known: those that are
        missing count as zero, so that the terms of lower order alone are had by leaving out the last.
    order
        Order of the derivative: 1, 2 or 3.

    Returns
    -------
    A complex number in the unit of ``arm`` per second to the power ``order``, of the broadcast shape.

    Raises
    ------
    ValueError
        Another order.

    Source
    ------
    The second derivative is equation 11 of the course: radial, tangential, centripetal and Coriolis terms.
    """
    r1, r2, r3 = (*length_rates, 0.0, 0.0, 0.0)[:3]
    w1, w2, w3 = (*angle_rates, 0.0, 0.0, 0.0)[:3]
    if order == 1:
        return r1 * unit + 1j * w1 * arm
    if order == 2:
        return (r2 + 2j * w1 * r1) * unit + (1j * w2 - w1 * w1) * arm
    if order == 3:
        turning = 1j * w3 - 3 * w1 * w2 - 1j * w1 * w1 * w1
        return (r3 + 3j * w1 * r2 + 3 * (1j * w2 - w1 * w1) * r1) * unit + turning * arm
    raise ValueError(f"derivatives of order 1 to 3 are known, not {order}")


def turned(arm: Any, angle_rates: Sequence[Any]) -> tuple[Any, ...]:
    """Return the time derivatives of a vector of constant length, as many as there are rates of its angle.

    Parameters
    ----------
    arm
        The vector now, complex.
    angle_rates
        Time derivatives of its angle from the first on, rad/s, rad/s^2, rad/s^3: at most three.

    Returns
    -------
    The derivatives of the vector from the first on, complex, of the broadcast shape.

    Raises
    ------
    ValueError
        More than three rates.

    Source
    ------
    :func:`derivative` with the angle alone varying.
    """
    return tuple(derivative(arm, 0.0, (), angle_rates[:n], n) for n in range(1, len(angle_rates) + 1))
