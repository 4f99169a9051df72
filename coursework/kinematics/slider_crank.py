"""Slider-crank moved by its crank, exact to the last digits near dead centres too.

The crank r turns about O = (0, 0), the rod l joins the crank pin A to the slider B = (x, e) on a line
parallel to x. The rod's angle is that of A -> B. A mechanism along another axis is this one, turned.

With p = r sin(crank) - e, the rod reaches while l - p and l + p are positive. Written as E + r (1 -+
sin), with E = l - r +- e free of rounding, neither is a difference of nearly equal lengths when the crank
turns fully, and the loop closes as a four-bar does at the complement of the crank angle (:mod:`closing`).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import CannotAssemble, Undefined, WrongValue
from coursework.kinematics.angles import full_angle, half_angle, halves, taken_apart
from coursework.kinematics.closing import Closing, Opening, Sweep, closing, in_time
from coursework.kinematics.margins import exact_sum
from coursework.kinematics.scaling import exponent_of, scaled
from coursework.kinematics.vectors import direction
from coursework.messages import Message
from coursework.system.blocks import in_blocks


class SliderCrankMotion(NamedTuple):
    """The rod's angle (radians) and the slider's abscissa, then their time derivatives up to the order
    requested."""

    rod_angle: Any
    position: Any
    rod_rate: Any = None
    velocity: Any = None
    rod_acceleration: Any = None
    acceleration: Any = None
    rod_jerk: Any = None
    jerk: Any = None


class _SliderCrankLengths(NamedTuple):
    """Lengths scaled to at most 1; the first four as in :mod:`closing`."""

    stretched: Any  # l - r - e
    folded: Any  # l - r + e
    reach: Any  # 2 r
    side: Any
    crank: Any
    rod: Any
    offset: Any


class SliderCrank:
    """Slider-crank, or an array of them.

    Parameters
    ----------
    crank, rod, offset
        Lengths r and l, positive, and the ordinate e of the slider's line; scalars or arrays that broadcast.
    side
        +1: the slider lies to the right of the crank pin (the rod's cosine is positive); -1: to the left.
    smooth
        What happens when the two sides meet, at rod = crank + |offset| exactly: by default the slider
        keeps its side and its velocity jumps; if true it passes to the other side as a moving body would,
        and ``side`` is that of the crank angle 0. A rod that is longer has no such place and moves alike
        under both.

    Raises
    ------
    WrongValue
        Scalars only: a length that is not positive and finite. In arrays such a linkage is NaN.
    """

    def __init__(
        self, crank: Any, rod: Any, offset: Any = 0.0, side: Any = 1, *, smooth: bool = False
    ) -> None:
        self.lengths = _lengths(crank, rod, offset)
        self.smooth = smooth
        self._exponent = exponent_of(*self.lengths)
        r, l, e = (_plain(scaled(x, -self._exponent)) for x in self.lengths)
        self._linkage = _SliderCrankLengths(
            exact_sum(l, -r, -e), exact_sum(l, -r, e), 2 * r, _plain(np.asarray(side, dtype=float)), r, l, e
        )

    def turns_fully(self) -> Any:
        """Return whether the crank can make a whole turn: rod >= crank + |offset|, decided exactly."""
        return (self._linkage.stretched >= 0) & (self._linkage.folded >= 0)

    def motion(
        self,
        crank_angle: Any,
        crank_rate: Any = 1.0,
        crank_acceleration: Any = 0.0,
        crank_jerk: Any = 0.0,
        *,
        order: int = 2,
    ) -> SliderCrankMotion:
        """Return the rod angle and the slider position, with their time derivatives up to ``order``.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.
        crank_rate, crank_acceleration, crank_jerk
            Time derivatives of the crank angle, rad/s, rad/s^2, rad/s^3; scalars or arrays that broadcast.
        order
            Highest order of the derivatives, 0 to 3.

        Returns
        -------
        The rod's angle in radians in (-pi, pi] and the abscissa in the unit of the lengths, with their rates,
        of the broadcast shape; None beyond ``order``.

        Raises
        ------
        CannotAssemble
            Scalars only: the rod does not reach the line; says by how much. NaN in arrays.
        Undefined
            Scalars only, order 1 or more: the rod stands square to the line, where the rates do not exist
            (but see ``smooth``). NaN in arrays.

        Source
        ------
        ``x = r cos + S`` with ``S = side sqrt(l^2 - (r sin - e)^2)``, the rod's angle that of the vector
        ``(S, e - r sin)``; then the chain rule.
        """
        given = (crank_rate, crank_acceleration, crank_jerk)[:order]
        results = list(self._evaluate(_motion, crank_angle, *given))
        results[1::2] = [self._restored(value) for value in results[1::2]]
        return SliderCrankMotion(*results)

    def position(self, crank_angle: Any) -> Any:
        """Return the slider's abscissa alone. Errors as in :meth:`motion`.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        The abscissa in the unit of the lengths, of the broadcast shape.

        Source
        ------
        ``r cos + side sqrt(l^2 - (r sin - e)^2)``.
        """
        return self._restored(self._evaluate(_position, crank_angle)[0])

    def run(self, crank_angle: Any) -> Any:
        """Return the distance from the crank pin to the slider along the line. Errors as in :meth:`motion`.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        The distance in the unit of the lengths, positive to the right, of the broadcast shape.

        Source
        ------
        ``side sqrt(l^2 - (r sin - e)^2)``.
        """
        return self._restored(self._evaluate(_run, crank_angle)[0])

    def displacement(self, crank_angle: Any) -> Any:
        """Return the distance of the slider from its outer dead centre, accurate to the last digits there.
        Errors as in :meth:`motion`.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        The distance in the unit of the lengths, of the broadcast shape; at least 0 while the slider is on the
        side +1.

        Source
        ------
        ``sqrt((l + r)^2 - e^2) - x``, its differences of cosines and of roots written as products.
        """
        return self._restored(self._evaluate(_displacement, crank_angle)[0])

    def conditioning(self, crank_angle: Any) -> Any:
        """Return the factor from an error of the rod to one of the slider.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        The factor, without unit, of the broadcast shape; inf where the rod is perpendicular to the line.

        Raises
        ------
        CannotAssemble
            Scalars only: the rod does not reach the line. NaN in arrays.

        Source
        ------
        ``1 / |cos(rod angle)| = l / |run|``.
        """
        return self._evaluate(_conditioning, crank_angle)[0]

    def stroke(self) -> Any:
        """Return the distance between the two dead centres of a crank that turns fully, without
        cancellation."""
        outer, inner = self._dead_centres()
        t = self._linkage
        with np.errstate(all="ignore"):
            return self._restored(4 * t.rod * t.crank / (outer + inner))

    def quick_return(self) -> Any:
        """Return the crank angle by which the longer of the two strokes exceeds half a turn, radians, signed
        as the offset.

        The strokes take pi + this and pi - this: see :func:`time_ratio_excess`.
        """
        outer, inner = self._dead_centres()
        t = self._linkage
        with np.errstate(all="ignore"):
            stroke = 4 * t.rod * t.crank / (outer + inner)
            return np.arctan2(t.offset * stroke, t.offset * t.offset + outer * inner)[()]

    def _dead_centres(self) -> tuple[Any, Any]:
        """Return the distances from O to the slider where rod and crank are in line, outer and inner,
        scaled."""
        t = self._linkage
        with np.errstate(all="ignore"):
            inner = np.sqrt((t.rod - t.crank - t.offset) * (t.rod - t.crank + t.offset))
            return _outer(t), np.where(t.rod >= t.crank, inner, np.nan)[()]

    def _restored(self, length: Any) -> Any:
        result = scaled(length, self._exponent)
        return result if result.ndim else float(result)

    def _evaluate(self, formula: Any, crank_angle: Any, *rates: Any) -> tuple:
        heading, parts = taken_apart(crank_angle)
        rates = tuple(np.asarray(rate, dtype=float)[()] for rate in rates)
        sweeping = _signed_sweep if self.smooth else _sweep
        last = len(_SliderCrankLengths._fields)

        def kernel(*inputs: Any) -> tuple:
            angle = heading(*inputs[last : last + len(parts)])
            cos, sin = full_angle(angle)
            linkage = _SliderCrankLengths(*inputs[:last])
            return formula(
                linkage,
                sweeping(angle, cos, sin, linkage.reach),
                cos,
                sin,
                angle,
                *inputs[last + len(parts) :],
            )

        results = in_blocks(kernel, *self._linkage, *parts, *rates)
        if np.ndim(results[0]):
            return results
        results = tuple(value.item() for value in results)
        if any(value != value for value in results):
            with np.errstate(all="ignore"):
                raise self._failure(crank_angle)
        return results

    def _failure(self, crank_angle: Any) -> Exception:
        """Return the error that explains a NaN of scalar arguments."""
        cos, sin = full_angle(crank_angle)
        if not math.isfinite(sin):
            return WrongValue(
                "the crank angle is {crank_angle}, where a finite number is needed", crank_angle=crank_angle
            )
        close = _closing(self._linkage, _sweep(crank_angle, cos, sin, self._linkage.reach))
        least = float(min(close.stretch, close.fold))
        crank, rod, offset = self.lengths
        away = abs(crank * sin - offset)
        if least < 0:
            gap = math.ldexp(-least, int(self._exponent))
            return CannotAssemble(
                "the linkage does not close: the line is {away:.6g} away from the crank pin, but the "
                "rod reaches only {rod:.6g} (gap {gap:.3g})",
                away=away,
                rod=rod,
                gap=gap,
            )
        return Undefined(
            "the rod, {rod:.6g}, is perpendicular to the slider's line: the rates do not exist", rod=rod
        )


def time_ratio_excess(excess: Any) -> Any:
    """Return the time ratio of the longer to the shorter stroke minus 1, without loss of digits when the
    strokes are nearly equal.

    Parameters
    ----------
    excess
        Crank angle by which the longer stroke exceeds half a turn, radians, of either sign; a scalar or an
        array. The strokes take pi + excess and pi - excess of crank angle.

    Returns
    -------
    The ratio less 1, of the same shape.

    Source
    ------
    ``2 |excess| / (pi - |excess|)``.
    """
    return 2 * np.abs(excess) / (math.pi - np.abs(excess))


def _lengths(crank: Any, rod: Any, offset: Any) -> tuple[Any, Any, Any]:
    if all(np.ndim(x) == 0 for x in (crank, rod, offset)):
        for name, length in (("crank", crank), ("rod", rod)):
            if not 0 < length < math.inf:
                raise WrongValue(
                    "the length of the {name} is {length}, where a positive number is needed",
                    name=Message(name),
                    length=length,
                )
        return float(crank), float(rod), float(offset)
    r, l, e = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (crank, rod, offset)))
    r, l = (np.where((x > 0) & (x < math.inf), x, math.nan) for x in (r, l))
    return r, l, e


def _plain(value: Any) -> Any:
    return value if value.ndim else float(value)


def _sweep(_: Any, cos: Any, sin: Any, w: Any) -> Sweep:
    """Return the half angle of the complement: (1 + sin)/2, (1 - sin)/2 and half the cosine."""
    larger, smaller = halves(np.abs(sin), cos)
    up = sin >= 0
    return Sweep(w * np.where(up, larger, smaller), w * np.where(up, smaller, larger), (0.5 * w) * cos)


def _signed_sweep(angle: Any, cos: Any, sin: Any, w: Any) -> Sweep:
    swept = _sweep(angle, cos, sin, w)
    half_cos, half_sin = half_angle(angle)
    return swept._replace(
        cos=np.copysign(np.sqrt(swept.cos_squared), half_cos + half_sin),
        sin=np.copysign(np.sqrt(swept.sin_squared), half_cos - half_sin),
    )


def _closing(t: _SliderCrankLengths, swept: Sweep) -> Closing:
    """Return the margins P = l + p and Q = l - p; S is the distance from the crank pin to the slider."""
    return closing(t.stretched, t.folded, t.side, swept)


def _position(t: _SliderCrankLengths, swept: Sweep, cos: Any, *_: Any) -> tuple[Any]:
    return (t.crank * cos + _closing(t, swept).determinant,)


def _run(t: _SliderCrankLengths, swept: Sweep, *_: Any) -> tuple[Any]:
    return (_closing(t, swept).determinant,)


def _motion(t: _SliderCrankLengths, swept: Sweep, cos: Any, sin: Any, _: Any, *rates: Any) -> tuple:
    close = _closing(t, swept)
    run, r_cos, r_sin = close.determinant, t.crank * cos, t.crank * sin
    rise = t.offset - r_sin
    result = (direction(rise, run), r_cos + run)
    order = len(rates)
    if order == 0:
        return result
    # Derivatives by the crank angle: the rod's is -rho = -r cos / run, the run's is rho rise.
    opening = Opening(close, swept)
    rho = opening.rho
    # It is a function of the complement, so that its odd derivatives change sign.
    by_angle = [(-rho, rho * rise - r_sin)]
    if order >= 2:
        first = opening.first if swept.cos is not None else _opening_rate(t, close, swept, r_sin)
        by_angle.append((first, -(first * rise + (1 + rho) * r_cos)))
    if order >= 3:
        second = opening.second
        by_angle.append((-second, second * rise + 2 * first * r_cos + (1 + rho) * r_sin))
    return result + in_time(by_angle, rates)


def _opening_rate(t: _SliderCrankLengths, close: Closing, swept: Sweep, r_sin: Any) -> Any:
    """Return the first derivative of rho for a linkage that keeps its side: as in :class:`Opening`, and exact
    near its zeros.

    Two ways divide out the sine, for a line above and for one below O; each is a sum where the other cancels.
    """
    least, most = np.minimum(t.stretched, t.folded), np.maximum(t.stretched, t.folded)
    squared = np.where(np.greater(t.offset, 0), swept.cos_squared, swept.sin_squared)
    total = 2 * r_sin * (least * (most + t.reach)) + 2 * t.offset * (squared * squared)
    return 0.5 * total / (close.product * close.determinant)


def _displacement(t: _SliderCrankLengths, swept: Sweep, cos: Any, sin: Any, angle: Any) -> tuple[Any]:
    """Return the displacement from dead centre: differences of cosines and of square roots as products, each
    zero with the angle."""
    half_cos, half_sin = half_angle(angle)
    outer = _outer(t)
    at_centre = 0.5 * np.arctan2(t.offset, outer)
    c, s = np.cos(at_centre), np.sin(at_centre)
    past, mean_sin, mean_cos = (
        half_sin * c - half_cos * s,
        half_sin * c + half_cos * s,
        half_cos * c - half_sin * s,
    )
    total = t.crank + t.rod
    rises = (t.offset - t.crank * sin) + t.rod * t.offset / total
    runs = _closing(t, swept).determinant + t.rod * outer / total
    return (2 * t.crank * past * (mean_sin - mean_cos * rises / runs),)


def _outer(t: _SliderCrankLengths) -> Any:
    total = t.rod + t.crank
    return np.sqrt((total - t.offset) * (total + t.offset))


def _conditioning(t: _SliderCrankLengths, swept: Sweep, *_: Any) -> tuple[Any]:
    return (t.rod / np.abs(_closing(t, swept).determinant),)
