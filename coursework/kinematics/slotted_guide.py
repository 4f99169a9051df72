"""A crank pin that slides in the slot of a guide: the guide turns, or swings.

The guide turns about O4 = (0, 0), the crank r about O2 = (d, 0); angles are measured from the direction
O4 -> O2, so that 0 is the position in line with the pin farthest away. The arm is the vector from O4 to
the crank pin A; its length is positive.

    |arm|^2 = (r - d)^2 + 4 r d cos^2(crank / 2)

is a sum: neither it nor the ratio of the rates loses digits where A passes near O4.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import Undefined, WrongValue
from coursework.kinematics.angles import Heading
from coursework.kinematics.blocks import in_blocks
from coursework.kinematics.closing import in_time, sweep
from coursework.kinematics.scaling import exponent_of, scaled
from coursework.kinematics.vectors import direction


class SlottedGuideMotion(NamedTuple):
    """Angle of the guide (radians) and length of the arm, then as many time derivatives as were asked for."""

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
    """Guide and sliding pin, with time derivatives up to ``order`` (0 to 3), nothing beyond.

    Parameters
    ----------
    ground, crank
        Lengths d = O4 O2 and r, positive, one unit. The guide turns fully when r > d, and swings when r < d.
    crank_angle
        Radians or a :class:`Heading`, from the direction O4 -> O2.

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
    """
    d, r = (np.asarray(x, dtype=float)[()] for x in (ground, crank))
    if np.ndim(d) == np.ndim(r) == 0 and not (0 < d < math.inf and 0 < r < math.inf):
        raise WrongValue(
            f"the lengths of ground and crank are {d} and {r}, where positive numbers are needed"
        )
    exponent = exponent_of(d, r)
    d, r = scaled(d, -exponent)[()], scaled(r, -exponent)[()]
    heading = crank_angle if isinstance(crank_angle, Heading) else (crank_angle,)
    heading = tuple(np.asarray(part, dtype=float)[()] for part in heading)
    rates = tuple(
        np.asarray(x, dtype=float)[()] for x in (crank_rate, crank_acceleration, crank_jerk)[:order]
    )

    def kernel(d: Any, r: Any, *inputs: Any) -> tuple:
        angle = inputs[: len(heading)]
        return _motion(d, r, Heading(*angle) if len(angle) > 1 else angle[0], *inputs[len(heading) :])

    found = list(in_blocks(kernel, d, r, *heading, *rates))
    found[1::2] = [scaled(value, exponent) for value in found[1::2]]
    if not np.ndim(found[0]):
        found = [value.item() for value in found]
        if any(value != value for value in found):
            raise Undefined("the crank pin lies on the guide's pivot: the guide has no direction there")
    return SlottedGuideMotion(*found)


def swing(ground: Any, crank: Any) -> Any:
    """The angle between the extreme positions of a guide that swings (crank <= ground), radians; NaN if
    it turns.

    It is also the crank angle by which the slow stroke exceeds half a turn.
    """
    with np.errstate(invalid="ignore"):
        return 2 * np.arcsin(np.divide(crank, ground))


def _motion(d: Any, r: Any, angle: Any, *rates: Any) -> tuple:
    gap, swept = r - d, sweep(angle, 4 * r * d)
    squared = gap * gap + swept.cos_squared
    arm = np.sqrt(squared)
    found = (direction(swept.both, swept.cos_squared - 2 * d * gap), arm)
    order = len(rates)
    if order == 0:
        return found
    # With r = d the pin's approach to the pivot divides out.
    ratio = np.where(gap == 0, 0.5, (r * gap + 0.5 * swept.cos_squared) / squared)
    pull = 0.5 * swept.both / arm
    by_angle = [(ratio, -pull)]
    if order >= 2:
        turning = np.where(gap == 0, 0.0, gap * (r + d) / (squared * squared))
        along = 0.25 * (swept.cos_squared - swept.sin_squared)
        by_angle.append((turning * (0.5 * swept.both), -(along + pull * pull) / arm))
    if order >= 3:
        by_angle.append(
            (turning * (along + 4 * pull * pull), pull * (1 - 3 * (along + pull * pull) / squared))
        )
    return found + in_time(by_angle, rates)
