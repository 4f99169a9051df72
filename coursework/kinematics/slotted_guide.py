"""Crank pin that slides in the slot of a guide, which turns fully or swings.

The guide turns about O4 = (0, 0), the crank r about O2 = (d, 0); angles are measured from the direction
O4 -> O2, so that 0 is the position in line with the pin farthest away. The arm is the vector from O4 to
the crank pin A; its length is positive.

    |arm|^2 = (r - d)^2 + 4 r d cos^2(crank / 2)

is a sum: neither it nor the ratio of the rates loses digits where A passes near O4.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import Undefined, WrongValue
from coursework.kinematics.angles import taken_apart
from coursework.kinematics.closing import in_time, sweep
from coursework.kinematics.scaling import exponent_of, scaled
from coursework.kinematics.vectors import direction
from coursework.system.blocks import in_blocks


class SlottedGuideMotion(NamedTuple):
    """Angle of the guide (radians) and length of the arm, then their time derivatives up to the order
    requested."""

    guide_angle: Any
    arm: Any
    guide_rate: Any = None
    sliding_velocity: Any = None
    guide_acceleration: Any = None
    sliding_acceleration: Any = None
    guide_jerk: Any = None
    sliding_jerk: Any = None


def motion(
    ground: Any,
    crank: Any,
    crank_angle: Any,
    crank_rate: Any = 1.0,
    crank_acceleration: Any = 0.0,
    crank_jerk: Any = 0.0,
    *,
    order: int = 2,
) -> SlottedGuideMotion:
    """Return the guide's angle and the arm's length, with time derivatives up to ``order``.

    Parameters
    ----------
    ground, crank
        Lengths d = O4 O2 and r, positive, one unit. The guide turns fully when r > d, and swings when r < d.
    crank_angle
        Radians or a heading (:mod:`angles`), from the direction O4 -> O2.
    crank_rate, crank_acceleration, crank_jerk
        Time derivatives of the crank angle, rad/s, rad/s^2, rad/s^3; scalars or arrays that broadcast.
    order
        Highest order of the derivatives, 0 to 3.

    Returns
    -------
    The guide's angle in (-pi, pi] from the same direction, the arm's length, and their derivatives, of the
    broadcast shape. For r = d the guide turns at exactly half the crank's rate.

    Raises
    ------
    Undefined
        Scalars only: A lies on O4 (r = d at half a turn), where the guide has no angle. NaN in arrays.
    WrongValue
        Scalars only: a length that is not positive and finite.

    Source
    ------
    The arm is ``d + r e^(i crank)``, its rate over the crank's ``(r^2 + r d cos) / |arm|^2``; then the chain
    rule.
    """
    d, r, exponent = _scaled_lengths(ground, crank)
    heading, parts = taken_apart(crank_angle)
    rates = tuple(
        np.asarray(x, dtype=float)[()] for x in (crank_rate, crank_acceleration, crank_jerk)[:order]
    )

    def kernel(d: Any, r: Any, *inputs: Any) -> tuple:
        return _motion(_ScaledGuide(d, r, heading(*inputs[: len(parts)])), *inputs[len(parts) :])

    results: list[Any] = list(in_blocks(kernel, d, r, *parts, *rates))
    results[1::2] = [scaled(value, exponent) for value in results[1::2]]
    if not np.ndim(results[0]):
        results = _defined([value.item() for value in results])
    return SlottedGuideMotion(*results)


def swing(ground: Any, crank: Any) -> Any:
    """Return the angle between the extreme positions of a guide that swings (crank <= ground).

    It is also the crank angle by which the slow stroke exceeds half a turn.

    Parameters
    ----------
    ground, crank
        Lengths d and r, positive, in one unit; scalars or arrays that broadcast.

    Returns
    -------
    Radians, of the broadcast shape; NaN for a guide that turns fully.

    Source
    ------
    ``2 arcsin(r / d)``: at the extreme positions the arm touches the circle of the crank pin.
    """
    with np.errstate(invalid="ignore"):
        return 2 * np.arcsin(np.divide(crank, ground))


class SlottedGuidePose:
    """Slotted guide at a crank angle. Each property is computed once, on first use.

    Angles in radians; derivatives by the crank angle. Parameters, frame and errors are those of
    :func:`motion`; arrays are computed whole.
    """

    def __init__(self, ground: Any, crank: Any, crank_angle: Any):
        d, r, self._exponent = _scaled_lengths(ground, crank)
        heading, parts = taken_apart(crank_angle)
        with np.errstate(all="ignore"):
            self._pose = _ScaledGuide(d, r, heading(*parts))

    @property
    def guide_angle(self) -> Any:
        return self._value_of(0, 0)

    @property
    def arm(self) -> Any:
        return self._value_of(0, 1)

    @property
    def guide_ratio(self) -> Any:
        """First derivative: the guide's rate over the crank's."""
        return self._value_of(1, 0)

    @property
    def sliding_ratio(self) -> Any:
        """First derivative of the arm's length."""
        return self._value_of(1, 1)

    @property
    def guide_gain(self) -> Any:
        """Second derivative of the guide's angle."""
        return self._value_of(2, 0)

    @property
    def sliding_gain(self) -> Any:
        return self._value_of(2, 1)

    def _value_of(self, order: int, which: int) -> Any:
        with np.errstate(all="ignore"):
            value = getattr(self._pose, _ScaledGuide.ORDERS[order])[which]
        if which:
            value = scaled(value, self._exponent)[()]
        return value if np.ndim(value) else _defined([float(value)])[0]


def _defined(values: list[float]) -> list[float]:
    if any(value != value for value in values):
        raise Undefined("the crank pin lies on the guide's pivot: the guide may point anywhere")
    return values


def _scaled_lengths(ground: Any, crank: Any) -> tuple[Any, Any, Any]:
    d, r = (np.asarray(x, dtype=float)[()] for x in (ground, crank))
    if np.ndim(d) == np.ndim(r) == 0 and not (0 < d < math.inf and 0 < r < math.inf):
        raise WrongValue(
            "the lengths of ground and crank are {d} and {r}, where positive numbers are needed", d=d, r=r
        )
    exponent = exponent_of(d, r)
    return scaled(d, -exponent)[()], scaled(r, -exponent)[()], exponent


class _ScaledGuide:
    """Guide angle and arm with their derivatives by the crank angle, lengths scaled."""

    ORDERS = ("position", "first", "second", "third")

    def __init__(self, d: Any, r: Any, angle: Any):
        self.d, self.r, self.gap, self.swept = d, r, r - d, sweep(angle, 4 * r * d)
        self.squared = self.gap * self.gap + self.swept.cos_squared

    @cached_property
    def arm(self) -> Any:
        return np.sqrt(self.squared)

    @cached_property
    def position(self) -> tuple[Any, Any]:
        return direction(self.swept.both, self.swept.cos_squared - 2 * self.d * self.gap), self.arm

    @cached_property
    def first(self) -> tuple[Any, Any]:
        # With r = d the pin's approach to the pivot divides out.
        ratio = (self.r * self.gap + 0.5 * self.swept.cos_squared) / self.squared
        return np.where(self.gap == 0, 0.5, ratio), -self._pull

    # Of the arm's square m = g^2 + c, with g = r - d, c and s the swept squares: the derivatives of arm and
    # angle are quotients of sums over m. Where A passes near O4 both g^2 and c are small, and no difference
    # of them is left.

    @cached_property
    def second(self) -> tuple[Any, Any]:
        return self._turning * (0.5 * self.swept.both), -self._bend / self.arm

    @cached_property
    def third(self) -> tuple[Any, Any]:
        swung = 0.75 * self.swept.sin_squared
        turned = self._turning * (self._bend + swung * self._passing)
        return turned, self._pull * (0.25 * self._passing + self._missing * (1 + swung / self.squared))

    @cached_property
    def _pull(self) -> Any:
        return 0.5 * self.swept.both / self.arm

    @cached_property
    def _turning(self) -> Any:
        return np.where(self.gap == 0, 0.0, self.gap * (self.r + self.d) / (self.squared * self.squared))

    @cached_property
    def _passing(self) -> Any:
        """Share c / m: 1 where the circle of A passes through O4."""
        return self.swept.cos_squared / self.squared

    @cached_property
    def _missing(self) -> Any:
        """Share g^2 / m, the complement of ``_passing``."""
        return self.gap * (self.gap / self.squared)

    @cached_property
    def _bend(self) -> Any:
        """Minus the arm times its second derivative: (g^2 (c - s) + c^2) / 4 m."""
        swept = self.swept
        return 0.25 * (
            self._missing * (swept.cos_squared - swept.sin_squared) + swept.cos_squared * self._passing
        )


def _motion(pose: _ScaledGuide, *rates: Any) -> tuple:
    if not rates:
        return pose.position
    by_angle = [getattr(pose, name) for name in _ScaledGuide.ORDERS[1 : 1 + len(rates)]]
    return pose.position + in_time(by_angle, rates)
