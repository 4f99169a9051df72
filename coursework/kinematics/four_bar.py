"""Four-bar linkage moved by its crank, exact to the last digits near change points and dead points too.

The crank a turns about O = (0, 0), the rocker c about D = (d, 0); the coupler b joins the crank pin A to the
rocker's pin B. Angles are those of O -> A, A -> B and D -> B.

With the squared distance m = AD^2, everything follows from the two margins by which the coupler and
the rocker reach from A to D,

    P = (b + c)^2 - m = E+ + 4 a d cos^2(crank / 2),    Q = m - (b - c)^2 = E- + 4 a d sin^2(crank / 2),

where E+ and E- are the Grashof margins (:func:`margins.grashof_margins`), free of rounding. A crank that
turns fully has E+, E- >= 0: then nothing is a difference of nearly equal lengths, at a change point
neither. S = side * sqrt(P Q) = 2 b c sin(transmission angle) is twice the determinant of the velocities.
"""

from __future__ import annotations

import itertools
import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import Undefined, WrongValue
from coursework.kinematics.angles import full_angle, taken_apart
from coursework.kinematics.closing import Closing, Opening, Sweep, closing, in_time, signed_sweep, sweep
from coursework.kinematics.dyads import out_of_reach, side_of
from coursework.kinematics.margins import grashof_margins
from coursework.kinematics.scaling import exponent_of, scaled
from coursework.kinematics.vectors import direction_of
from coursework.messages import Message
from coursework.system.blocks import in_blocks


class FourBarMotion(NamedTuple):
    """Angles (radians) of coupler and rocker, then their time derivatives up to the order requested."""

    coupler_angle: Any
    rocker_angle: Any
    coupler_rate: Any = None
    rocker_rate: Any = None
    coupler_acceleration: Any = None
    rocker_acceleration: Any = None
    coupler_jerk: Any = None
    rocker_jerk: Any = None


class _FourBarLengths(NamedTuple):
    """Combinations of the scaled lengths (at most 1) that the formulas use, computed once a linkage."""

    stretched: Any  # E+
    folded: Any  # E-
    reach: Any  # 4 a d
    gap: Any  # d - a
    crank: Any  # a
    twice_ground: Any  # 2 d
    twice_crank_gap: Any  # 2 a (d - a)
    coupler: Any  # 2 b (b - c)
    rocker: Any  # 2 c (b - c)
    twice_frame: Any  # 2 (d^2 - a^2)
    twice_sides: Any  # 2 (b^2 - c^2)
    twice_bc: Any  # 2 b c
    coupler_ground: Any  # 4 b d
    rocker_ground: Any  # 4 c d
    squared_reach: Any  # (b + c)^2
    side: Any  # +1 open, -1 crossed


class FourBar:
    """Four-bar linkage, or an array of them.

    Parameters
    ----------
    ground, crank, coupler, rocker
        Lengths d, a, b, c, positive, in one common unit; scalars or arrays that broadcast, also with the
        crank angles given later (``n`` linkages of shape ``(n, 1)`` at ``m`` angles give ``(n, m)``).
    mode
        ``open`` (or +1): B to the left of the directed line A -> D; ``crossed`` (or -1): to the right.
    smooth
        What a linkage does at a change point, where E+ or E- is exactly 0 and its two modes meet. By
        default it keeps its mode, and its rates jump. If true it passes through as a moving body would,
        with continuous rates: ``mode`` then is its mode at crank angles from 0 to half a turn, and it
        takes two turns to come back. A parallelogram that starts ``open`` stays a parallelogram. Other
        linkages have no change point and move alike under both.

    Raises
    ------
    WrongValue
        Scalars only: a length that is not positive and finite. In arrays such a linkage is NaN.
    """

    def __init__(
        self, ground: Any, crank: Any, coupler: Any, rocker: Any, mode: Any = "open", *, smooth: bool = False
    ) -> None:
        self.lengths = tuple(_lengths(ground, crank, coupler, rocker))
        self.side = _side(mode)
        self.smooth = smooth
        self._exponent = exponent_of(*self.lengths)
        # Of one shape, which everything computed from them has too.
        given = (*self._scaled_lengths(), self.side)
        self._linkage = _linkage(*(np.broadcast_arrays(*given) if any(map(np.ndim, given)) else given))

    @property
    def margins(self) -> tuple[Any, Any]:
        """Grashof margins E+ and E-, in squared units of length: both positive when the crank turns fully, 0
        at a change point."""
        return grashof_margins(*self.lengths)

    def turns_fully(self) -> Any:
        """Return whether the crank can make a whole turn, change points included."""
        return (self._linkage.stretched >= 0) & (self._linkage.folded >= 0)

    def limits(self) -> tuple[Any, Any]:
        """Return the least and the greatest absolute crank angle at which the linkage closes, in [0, pi].

        0 and pi for a crank that turns fully; NaN for a linkage that never closes.
        """
        t = self._linkage
        with np.errstate(all="ignore"):
            # cos^2 of half the greatest angle is -E+/(4 a d); 4 a d + E+ = (b + c)^2 - (d - a)^2 is a
            # product.
            d, a, b, c = self._scaled_lengths()
            beyond = (b + c - d + a) * (b + c + d - a)
            before = (d + a - b + c) * (d + a + b - c)
            greatest = 2 * np.arctan2(np.sqrt(np.where(t.stretched < 0, beyond, 0)), np.sqrt(-t.stretched))
            least = 2 * np.arctan2(np.sqrt(-t.folded), np.sqrt(np.where(t.folded < 0, before, 1)))
            greatest = np.where(t.stretched >= 0, math.pi, greatest)
            least = np.where(t.folded >= 0, 0.0, least)
        never = np.isnan(greatest) | np.isnan(least)
        return np.where(never, math.nan, least)[()], np.where(never, math.nan, greatest)[()]

    def angles(self, crank_angle: Any) -> tuple[Any, Any]:
        """Return the angles of coupler and rocker.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        The angles of coupler and rocker, radians in (-pi, pi], of the broadcast shape.

        Raises
        ------
        CannotAssemble
            Scalars only: coupler and rocker do not reach each other; says by how much. NaN in arrays.
        Undefined
            Scalars only: A lies on D and coupler and rocker are equal, so that they may point anywhere.

        Source
        ------
        From the direction of A -> D the coupler turns by the angle of ``m + b^2 - c^2 + i S``, the rocker by
        that of ``b^2 - c^2 - m + i S``.
        """
        return self._evaluate(_angles, crank_angle)

    def motion(
        self,
        crank_angle: Any,
        crank_rate: Any = 1.0,
        crank_acceleration: Any = 0.0,
        crank_jerk: Any = 0.0,
        *,
        order: int = 2,
    ) -> FourBarMotion:
        """Return the angles and their time derivatives up to ``order``.

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
        Angles in radians and rates in rad/s, rad/s^2 and rad/s^3, of the broadcast shape; None beyond
        ``order``.

        Raises
        ------
        CannotAssemble
            Scalars only: coupler and rocker do not reach each other; says by how much. NaN in arrays.
        Undefined
            Scalars only: A lies on D and coupler and rocker are equal; from order 1 on also a dead point, or
            a change point at which the mode is kept. There the angles exist and their rates do not. NaN in
            arrays.

        Source
        ------
        The derivatives by the crank angle (:meth:`coefficients`) and the chain rule.
        """
        given = (crank_rate, crank_acceleration, crank_jerk)[:order]
        return FourBarMotion(*self._evaluate(_motion, crank_angle, *given))

    def coefficients(self, crank_angle: Any, *, order: int = 1) -> tuple[tuple[Any, Any], ...]:
        """Return the derivatives of the coupler's and the rocker's angle by the crank angle.

        They need no inverse trigonometry. Errors as in :meth:`motion`.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.
        order
            Highest order of the derivatives, 1 to 3.

        Returns
        -------
        A pair (coupler, rocker) for each order, without unit: the first holds the ratios omega3/omega2 and
        omega4/omega2.

        Source
        ------
        A -> D turns by ``(a^2 - a d cos) / m`` of the crank's rate, relative to it the coupler by ``rho (b^2
        - c^2 - m) / (2 m)`` and the rocker by ``rho (m + b^2 - c^2) / (2 m)``, with rho of :mod:`closing`.
        """
        result = self._evaluate(_coefficients, crank_angle, order=order)
        return tuple(zip(result[::2], result[1::2], strict=True))

    def at(self, crank_angle: Any) -> FourBarPose:
        """Return the linkage at a crank angle; its properties compute angles and derivatives on first use.

        Arrays are computed whole: for long ones asked for at once, :meth:`motion` is faster.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        The pose, whose values have the broadcast shape.
        """
        return FourBarPose(self, crank_angle)

    def pins(self, crank_angle: Any) -> tuple[Any, Any]:
        """Return the points A and B. Errors as in :meth:`angles`.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        A and B, complex, in the linkage's unit of length, of the broadcast shape.
        """
        a, b = self._evaluate(_pins, crank_angle)
        return scaled(a, self._exponent)[()], scaled(b, self._exponent)[()]

    def transmission_angle(self, crank_angle: Any) -> Any:
        """Return the angle CBA at B between coupler and rocker.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        Radians in [0, pi], of the broadcast shape; 0 and pi are dead points.

        Raises
        ------
        CannotAssemble
            Scalars only: coupler and rocker do not reach each other. NaN in arrays.

        Source
        ------
        The tangent of its half, squared, is ``Q / P``.
        """
        return self._evaluate(_transmission_angle, crank_angle)[0]

    def conditioning(self, crank_angle: Any) -> Any:
        """Return the factor from an error of the lengths to one of B.

        Parameters
        ----------
        crank_angle
            Radians or a heading (:mod:`angles`), of any shape that broadcasts with the lengths.

        Returns
        -------
        The factor, without unit, of the broadcast shape; inf at a dead point.

        Raises
        ------
        CannotAssemble
            Scalars only: coupler and rocker do not reach each other. NaN in arrays.

        Source
        ------
        ``1 / |sin(transmission angle)| = 2 b c / sqrt(P Q)``.
        """
        return self._evaluate(_conditioning, crank_angle)[0]

    def _scaled_lengths(self) -> tuple[Any, Any, Any, Any]:
        result = (scaled(x, -self._exponent) for x in self.lengths)
        d, a, b, c = (x if x.ndim else float(x) for x in result)
        return d, a, b, c

    def _evaluate(self, formula: Any, crank_angle: Any, *rates: Any, order: int | None = None) -> tuple:
        # A numpy number where the angle is one: its quotient by zero is NaN, not an error.
        heading, parts = taken_apart(crank_angle)
        rates = tuple(np.asarray(rate, dtype=float)[()] for rate in rates)
        sweeping = signed_sweep if self.smooth else sweep
        last = len(_FourBarLengths._fields)
        extra = {} if order is None else {"order": order}

        def kernel(*inputs: Any) -> tuple:
            linkage, angle = _FourBarLengths(*inputs[:last]), heading(*inputs[last : last + len(parts)])
            pose = _ScaledFourBar(linkage, sweeping(angle, linkage.reach))
            return formula(pose, angle, *inputs[last + len(parts) :], **extra)

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
        t = self._linkage
        heading, parts = taken_apart(crank_angle)
        pose = _ScaledFourBar(t, sweep(heading(*parts), t.reach))
        if not math.isfinite(pose.swept.both):
            return WrongValue(
                "the crank angle is {crank_angle}, where a finite number is needed", crank_angle=crank_angle
            )
        m, stretch, fold = float(pose.squared_line), float(pose.close.stretch), float(pose.close.fold)
        distance = math.ldexp(math.sqrt(m), int(self._exponent))
        _, _, coupler, rocker = (float(x) for x in self.lengths)
        if min(stretch, fold) < 0:
            # The gap from the margin itself: the difference of the lengths would lose its digits.
            reach = math.sqrt(m) + abs(
                scaled(coupler + rocker if stretch < 0 else coupler - rocker, -self._exponent)
            )
            gap = math.ldexp(-min(stretch, fold) / float(reach), int(self._exponent))
            return out_of_reach(distance, coupler, rocker, gap, "coupler and rocker")
        if m == 0.0:
            return Undefined(
                "coupler and rocker are both {coupler:.6g} long and their far pins coincide: they may "
                "point anywhere",
                coupler=coupler,
            )
        return Undefined(
            "coupler and rocker are in line (pins {distance:.6g} apart, lengths {coupler:.6g} and "
            "{rocker:.6g}): at a dead point the rates do not exist",
            distance=distance,
            coupler=coupler,
            rocker=rocker,
        )


class FourBarPose:
    """Four-bar linkage at a crank angle. Each property is computed once, on first use.

    Angles are in radians; derivatives are by the crank angle. Errors are those of
    :meth:`FourBar.motion`, raised by the property whose value does not exist.
    """

    def __init__(self, linkage: FourBar, crank_angle: Any):
        heading, parts = taken_apart(crank_angle)
        sweeping = signed_sweep if linkage.smooth else sweep
        self._linkage, self._crank_angle = linkage, crank_angle
        with np.errstate(all="ignore"):
            swept = sweeping(heading(*parts), linkage._linkage.reach)
            self._pose = _ScaledFourBar(linkage._linkage, swept)

    @property
    def coupler_angle(self) -> Any:
        return self._value_of("coupler_angle")

    @property
    def rocker_angle(self) -> Any:
        return self._value_of("rocker_angle")

    @property
    def coupler_ratio(self) -> Any:
        """First derivative: the coupler's rate over the crank's."""
        return self._value_of("first", 0)

    @property
    def rocker_ratio(self) -> Any:
        return self._value_of("first", 1)

    @property
    def coupler_gain(self) -> Any:
        """Second derivative of the coupler's angle."""
        return self._value_of("second", 0)

    @property
    def rocker_gain(self) -> Any:
        return self._value_of("second", 1)

    @property
    def corner(self) -> Any:
        """Angle from A -> D to the coupler, in [0, pi]: the angle of triangle ABD at A."""
        pose = self._pose
        with np.errstate(all="ignore"):
            return self._checked(np.arctan2(np.abs(pose.close.determinant), pose.of_coupler))

    @property
    def transmission_angle(self) -> Any:
        """Angle CBA at B between coupler and rocker, in [0, pi]."""
        with np.errstate(all="ignore"):
            return self._checked(_transmission_angle(self._pose, None)[0])

    def _value_of(self, name: str, link: int | None = None) -> Any:
        with np.errstate(all="ignore"):
            result = getattr(self._pose, name)
            return self._checked(result if link is None else result[link])

    def _checked(self, value: Any) -> Any:
        if np.ndim(value):
            return value
        value = float(value)
        if value != value:
            with np.errstate(all="ignore"):
                raise self._linkage._failure(self._crank_angle)
        return value


def _lengths(*given: Any) -> list[Any]:
    if all(np.ndim(length) == 0 for length in given):
        for name, length in zip(("ground", "crank", "coupler", "rocker"), given, strict=True):
            if not 0 < length < math.inf:
                raise WrongValue(
                    "the length of the {name} is {length}, where a positive number is needed",
                    name=Message(name),
                    length=length,
                )
        return [float(length) for length in given]
    arrays = [np.asarray(length, dtype=float) for length in given]
    return [np.where((x > 0) & (x < math.inf), x, math.nan) for x in arrays]


def _side(mode: Any) -> Any:
    """Return +1.0 or -1.0 for a mode or a side."""
    words = np.asarray(mode)
    side = np.asarray(side_of(mode) if words.dtype.kind in "UO" else words, dtype=float)
    return side if side.ndim else float(side)


def _linkage(d: Any, a: Any, b: Any, c: Any, side: Any) -> _FourBarLengths:
    stretched, folded = grashof_margins(d, a, b, c)
    return _FourBarLengths(
        stretched=stretched,
        folded=folded,
        reach=4 * a * d,
        gap=d - a,
        crank=a,
        twice_ground=2 * d,
        twice_crank_gap=2 * a * (d - a),
        coupler=2 * b * (b - c),
        rocker=2 * c * (b - c),
        twice_frame=2 * (d - a) * (d + a),
        twice_sides=2 * (b - c) * (b + c),
        twice_bc=2 * b * c,
        coupler_ground=4 * b * d,
        rocker_ground=4 * c * d,
        squared_reach=(b + c) ** 2,
        side=side,
    )


class _ScaledFourBar:
    """Linkage at a crank angle, with scaled lengths. Each property is computed once, on first use."""

    def __init__(self, linkage: _FourBarLengths, swept: Sweep):
        self.linkage, self.swept = linkage, swept
        t = linkage
        # Sides much shorter than ground and crank: the margin is then the difference that loses nothing.
        short = -t.stretched > t.squared_reach
        direct = np.where(short, t.squared_reach - self.squared_line, np.nan) if np.any(short) else None
        self.close: Closing = closing(t.stretched, t.folded, t.side, swept, direct)
        # X3 = m + b^2 - c^2 and X4 = -m + b^2 - c^2 without cancellation.
        self.of_coupler, self.of_rocker = linkage.coupler + self.close.fold, linkage.rocker - self.close.fold

    @cached_property
    def squared_line(self) -> Any:
        """Squared distance m = AD^2."""
        return self.linkage.gap * self.linkage.gap + self.swept.sin_squared

    # Coupler and rocker turn from A -> D by the angles of X3 + i S and X4 + i S, of lengths
    # 2 b AD and 2 c AD; where A lies on D the zero vector makes both directions NaN.

    @cached_property
    def coupler_angle(self) -> Any:
        return self._turned(self.of_coupler, self.linkage.coupler_ground)

    @cached_property
    def rocker_angle(self) -> Any:
        return self._turned(self.of_rocker, self.linkage.rocker_ground)

    def _turned(self, along: Any, length: Any) -> Any:
        # Little is kept of what is soon used up: long arrays are to stay in the cache.
        x, s = self.linkage.twice_ground * self.linkage.gap + self.swept.sin_squared, self.close.determinant
        ahead = self.swept.both * s
        across = self.swept.both * along
        ahead += x * along
        x *= s
        x -= across
        return direction_of(x, ahead, length * self.squared_line)

    @property
    def angles(self) -> tuple[Any, Any]:
        return self.coupler_angle, self.rocker_angle

    # Derivatives of both angles by the crank angle. The direction of A -> D has the derivative
    # (a^2 - a d cos)/m, and coupler and rocker turn against it at rho X4/(2 m) and rho X3/(2 m), where rho
    # stays finite at a change point. Written so, the higher derivatives share all but one term, and no term
    # grows where the sum does not.

    @cached_property
    def first(self) -> tuple[Any, Any]:
        common = self.swept.sin_squared - self.linkage.twice_crank_gap
        common *= self._half
        return self._apart(common, self._opening.rho * self._half)

    @cached_property
    def second(self) -> tuple[Any, Any]:
        return self._apart(self._excess() * self._swing(), self._opening.first * self._half)

    def _apart(self, common: Any, along: Any) -> tuple[Any, Any]:
        """Return the sums for coupler and rocker of a common term and a term along A -> D, which has each its
        own factor."""
        coupler, rocker = along * self.of_rocker, along * self.of_coupler
        coupler += common
        rocker += common
        return coupler, rocker

    @cached_property
    def third(self) -> tuple[Any, Any]:
        swing, excess, first = self._swing(), self._excess(), self._opening.first
        turning = 0.5 * (self.swept.cos_squared - self.swept.sin_squared)
        apart = swing * first
        common = self._half * (turning * excess - apart * self.linkage.twice_sides) - 4 * swing**2 * excess
        both = self._opening.second * self._half - 2 * apart * self._half
        return common + both * self.of_rocker - apart, common + both * self.of_coupler + apart

    def derivatives(self, order: int) -> tuple:
        """Return the derivatives of the first ``order`` orders, in pairs."""
        return tuple(getattr(self, name) for name in ("first", "second", "third")[:order])

    @cached_property
    def _opening(self) -> Opening:
        return Opening(self.close, self.swept)

    @cached_property
    def _half(self) -> Any:
        return 0.5 / self.squared_line

    def _swing(self) -> Any:
        return self.swept.both * self._half

    def _excess(self) -> Any:
        excess = -self.linkage.twice_sides * self._opening.rho
        excess += self.linkage.twice_frame
        excess *= self._half
        return excess


def _angles(pose: _ScaledFourBar, _: Any) -> tuple[Any, Any]:
    return pose.angles


def _pins(pose: _ScaledFourBar, angle: Any) -> tuple[Any, Any]:
    t, swept = pose.linkage, pose.swept
    cos, sin = full_angle(angle)
    crank_pin = t.crank * (cos + 1j * sin)
    line = t.gap + (swept.sin_squared - 1j * swept.both) / t.twice_ground
    turned = (pose.of_coupler + 1j * pose.close.determinant) / (2 * pose.squared_line)
    return crank_pin, crank_pin + line * turned


def _transmission_angle(pose: _ScaledFourBar, _: Any) -> tuple[Any]:
    return (2 * np.arctan2(np.sqrt(pose.close.fold), np.sqrt(pose.close.stretch)),)


def _conditioning(pose: _ScaledFourBar, _: Any) -> tuple[Any]:
    return (pose.linkage.twice_bc / np.sqrt(pose.close.product),)


def _motion(pose: _ScaledFourBar, _: Any, *rates: Any) -> tuple:
    return pose.angles + (in_time(pose.derivatives(len(rates)), rates) if rates else ())


def _coefficients(pose: _ScaledFourBar, _: Any, *, order: int) -> tuple:
    return tuple(itertools.chain.from_iterable(pose.derivatives(order)))
