"""Closure of a loop by two margins, and its derivatives by the crank angle.

The four-bar and the slider-crank close by the same two margins of an angle t,

    P = E+ + w cos^2(t / 2),    Q = E- + w sin^2(t / 2),    S = side * sqrt(P Q),

where E+, E- and w are numbers of the linkage and S is, up to a constant factor, the determinant of its
velocities. S and sin(t) vanish together at a change point (E+ or E- exactly 0); rho = w sin(t) / (2 S)
does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from coursework.kinematics.angles import Degrees, half_angle


class Sweep(NamedTuple):
    """Products of cosine and sine of half the angle, times w: cos squared, sin squared, cos times sin.

    ``cos`` and ``sin`` are signed and times sqrt(w), for a linkage continued smoothly through a change point;
    None for one that keeps its mode.
    """

    cos_squared: Any
    sin_squared: Any
    both: Any
    cos: Any = None
    sin: Any = None


def sweep(angle: Any, w: Any) -> Sweep:
    """Return the sweep of an angle in radians or of a heading; radians and degrees cost one tangent.

    Parameters
    ----------
    angle
        Radians or a heading (:mod:`angles`); a scalar or an array.
    w
        Number w of the linkage, in the unit of its margins; a scalar or an array that broadcasts.

    Returns
    -------
    The products in the unit of w, of the broadcast shape, without signed cosine and sine.

    Source
    ------
    With t the tangent of half the angle: ``w / (1 + t^2)``, ``w t^2 / (1 + t^2)`` and ``w t / (1 + t^2)``.
    """
    if isinstance(angle, Degrees):
        return Sweep(*angle.half_squares(w))
    tangent = np.tan(angle * 0.5)
    squared = tangent * tangent
    cos_squared = w / (1 + squared)
    squared = squared * cos_squared
    return Sweep(cos_squared, squared, tangent * cos_squared)


def signed_sweep(angle: Any, w: Any) -> Sweep:
    """Return the sweep of an angle with its signed cosine and sine.

    Parameters
    ----------
    angle
        Radians or a heading (:mod:`angles`); a scalar or an array.
    w
        Number w of the linkage, positive, in the unit of its margins; a scalar or an array that broadcasts.

    Returns
    -------
    The products in the unit of w, cosine and sine in that of its root, of the broadcast shape.
    """
    cos, sin = half_angle(angle)
    cos, sin = np.sqrt(w) * cos, np.sqrt(w) * sin
    return Sweep(cos * cos, sin * sin, cos * sin, cos, sin)


def in_time(by_angle: Sequence[tuple[Any, ...]], rates: Sequence[Any]) -> tuple[Any, ...]:
    """Return the time derivatives of quantities that depend on a crank angle, order after order.

    Parameters
    ----------
    by_angle
        For each order from the first on, the derivatives of all quantities by the angle in radians; scalars
        or arrays that broadcast.
    rates
        Time derivatives of the angle, rad/s, rad/s^2 and rad/s^3: one to three, as many as there are orders.

    Returns
    -------
    The derivatives of all quantities in one tuple, those of the first order first.

    Source
    ------
    The chain rule: ``q1 w``, ``q2 w^2 + q1 w'`` and ``q3 w^3 + 3 q2 w w' + q1 w''`` for the derivatives q1,
    q2, q3 by the angle and the rate w.
    """
    first, rate = by_angle[0], rates[0]
    results = tuple(g * rate for g in first)
    if len(rates) >= 2:
        squared, acceleration = rate * rate, rates[1]
        second = tuple(g * squared for g in by_angle[1])
        # At constant speed, by far the most common case, the other term is zero.
        constant = np.ndim(acceleration) == 0 and acceleration == 0
        results += (
            second if constant else tuple(s + g * acceleration for s, g in zip(second, first, strict=True))
        )
    if len(rates) >= 3:
        cubed, both = squared * rate, 3 * rate * acceleration
        results += tuple(
            g3 * cubed + g2 * both + g1 * rates[2] for g1, g2, g3 in zip(*by_angle[:3], strict=True)
        )
    return results


class Closing(NamedTuple):
    """Margins of a configuration: E+, E-, the side, and P, Q, PQ, S."""

    stretched: Any
    folded: Any
    side: Any
    stretch: Any
    fold: Any
    product: Any
    determinant: Any


def closing(stretched: Any, folded: Any, side: Any, swept: Sweep, direct: Any = None) -> Closing:
    """Return the margins P, Q and S. Continued smoothly, sqrt(P) at E+ = 0 is the signed sqrt(w) cos(t / 2);
    likewise for Q.

    ``direct`` is P where it is known better than by its sum, NaN elsewhere.

    Parameters
    ----------
    stretched, folded
        Grashof margins E+ and E-, in one unit; scalars or arrays that broadcast with those of the sweep.
    side
        +1 or -1, the sign of S.
    swept
        Sweep of the angle, in the unit of the margins.
    direct
        P where it is known better than by its sum, NaN elsewhere; by default none.

    Returns
    -------
    All margins, P and Q in the unit given, S too but for the factor ``side``; S is NaN where the loop does
    not close.

    Source
    ------
    ``P = E+ + w cos^2(t / 2)``, ``Q = E- + w sin^2(t / 2)`` and ``S = side sqrt(P Q)``.
    """
    stretch, fold = stretched + swept.cos_squared, folded + swept.sin_squared
    if direct is not None:
        stretch = np.where(np.isnan(direct), stretch, direct)[()]
    product = stretch * fold
    if swept.cos is None:
        determinant = np.sqrt(product)
        determinant *= side
    else:
        root_p = np.where(stretched == 0, swept.cos, np.sqrt(stretch))
        root_q = np.where(folded == 0, swept.sin, np.sqrt(fold))
        determinant = side * root_p * root_q
    return Closing(stretched, folded, side, stretch, fold, product, determinant)


class Opening:
    """Ratio rho = w sin(t) / (2 S) and its first two derivatives by t, each computed on first use.

    NaN where S is 0, except for the smooth policy at a change point, where the factor that vanishes is
    divided out.
    """

    def __init__(self, close: Closing, swept: Sweep):
        self._close, self._swept = close, swept
        self._smooth = swept.cos is not None
        self._flat_p: Any = self._smooth and close.stretched == 0
        self._flat_q: Any = self._smooth and close.folded == 0

    @cached_property
    def rho(self) -> Any:
        if self._smooth:
            return self._cos_p * self._sin_q
        return self._inverse * self._swept.both

    @cached_property
    def first(self) -> Any:
        swept = self._swept
        if self._smooth:
            cos_part = self._close.side * self._cos_p * np.where(self._flat_q, 0.0, swept.cos / self._root_q)
            sin_part = self._sin_q * np.where(self._flat_p, 0.0, swept.sin / self._root_p)
            return 0.5 * (self._of_fold * cos_part - self._of_stretch * sin_part)
        close = self._close
        change = swept.cos_squared / close.fold
        change *= close.folded
        folding = swept.sin_squared / close.stretch
        folding *= close.stretched
        change -= folding
        change *= self._inverse
        change *= 0.5
        return change

    @cached_property
    def second(self) -> Any:
        close, swept = self._close, self._swept
        stretching = self._of_stretch * (1 + 3 * _share(swept.sin_squared, close.stretch, self._flat_p))
        folding = self._of_fold * (1 + 3 * _share(swept.cos_squared, close.fold, self._flat_q))
        return -0.25 * self.rho * (stretching + folding + 2 * self._of_stretch * self._of_fold)

    @cached_property
    def _inverse(self) -> Any:
        return self._close.determinant / self._close.product

    @cached_property
    def _root_p(self) -> Any:
        return np.sqrt(self._close.stretch)

    @cached_property
    def _root_q(self) -> Any:
        return np.sqrt(self._close.fold)

    @cached_property
    def _cos_p(self) -> Any:
        # Where a root is the cosine or the sine itself, their quotient is 1.
        return np.where(self._flat_p, 1.0, self._swept.cos / self._root_p)

    @cached_property
    def _sin_q(self) -> Any:
        return self._close.side * np.where(self._flat_q, 1.0, self._swept.sin / self._root_q)

    @cached_property
    def _of_stretch(self) -> Any:
        return _share(self._close.stretched, self._close.stretch, self._flat_p)

    @cached_property
    def _of_fold(self) -> Any:
        return _share(self._close.folded, self._close.fold, self._flat_q)


def _share(part: Any, total: Any, flat: Any) -> Any:
    """Return part / whole, and 0 where the factor of a smooth change point is divided out."""
    return part / total if flat is False else np.where(flat, 0.0, part / total)
