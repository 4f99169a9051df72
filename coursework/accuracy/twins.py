"""Textbook versions of the numeric core, for references in many digits.

A solution may call the core in a formula, for a triangle's side or a linkage's pose. The core computes with
floats alone, by the methods that this package judges; a reference therefore replaces its functions by these
*twins*: the law of cosines, the intersection of two circles, nothing refined. They take floats, arrays and
followed numbers.
"""

from __future__ import annotations

from types import FunctionType
from typing import Any

import numpy as np

from coursework import degrees
from coursework.kinematics.angles import Degrees
from coursework.kinematics.dyads import side_of
from coursework.quantities.other_names import OtherNames, package_of


def _degrees_of(angle: Any) -> Any:
    """Return a heading in degrees."""
    if not isinstance(angle, Degrees):
        raise TypeError("a twin takes angles in degrees")
    return angle.angle


def third_side(first: Any, other: Any, angle: Any) -> Any:
    return degrees.sqrt(first**2 + other**2 - 2 * first * other * degrees.cos(_degrees_of(angle)))


def corner(near: Any, other: Any, opposite: Any) -> Any:
    return np.radians(degrees.acos((near**2 + other**2 - opposite**2) / (2 * near * other)))


def corner_beside(first: Any, other: Any, angle: Any, third: Any) -> Any:
    return corner(first, third, other)


class TextbookFourBar:
    """Angles and rates of a four-bar by the intersection of two circles."""

    def __init__(self, ground: Any, crank: Any, coupler: Any, rocker: Any, mode: Any = "open") -> None:
        self.lengths = ground, crank, coupler, rocker
        self.side = side_of(mode) if isinstance(mode, str) or np.asarray(mode).dtype.kind == "U" else mode

    def at(self, crank_angle: Any) -> _TextbookPose:
        d, a, b, c = self.lengths
        crank = degrees.polar(a, _degrees_of(crank_angle))
        line = d - crank
        squared = abs(line) ** 2
        along = (squared + b**2 - c**2) / (2 * squared)
        across = degrees.sqrt(b**2 / squared - along**2)
        coupler = line * (along + 1j * self.side * across)
        return _TextbookPose(crank, coupler, crank + coupler - d)


class _TextbookPose:
    """Vectors of a four-bar at one crank angle; rates by their projections."""

    def __init__(self, crank: Any, coupler: Any, rocker: Any) -> None:
        self._crank, self._coupler, self._rocker = crank, coupler, rocker
        area = _cross(rocker, coupler)
        self.coupler_angle, self.rocker_angle = (np.radians(degrees.angle(v)) for v in (coupler, rocker))
        self.coupler_ratio = _cross(crank, rocker) / area
        self.rocker_ratio = _cross(crank, coupler) / area
        pull = crank + self.coupler_ratio**2 * coupler - self.rocker_ratio**2 * rocker
        self.coupler_gain = -_dot(pull, rocker) / area
        self.rocker_gain = -_dot(pull, coupler) / area


class TextbookSliderCrank:
    def __init__(self, crank: Any, rod: Any, offset: Any) -> None:
        self.lengths = crank, rod, offset

    def run(self, crank_angle: Any) -> Any:
        crank, rod, offset = self.lengths
        return degrees.sqrt(rod**2 - (offset - crank * degrees.sin(_degrees_of(crank_angle))) ** 2)


class TextbookSlottedGuide:
    """Arm from the guide's pivot to the crank pin, as a vector, with its derivatives by the crank angle."""

    def __init__(self, ground: Any, crank: Any, crank_angle: Any) -> None:
        pin = degrees.polar(crank, _degrees_of(crank_angle))
        arm = ground + pin
        self.arm = abs(arm)
        self.guide_angle = np.radians(degrees.angle(arm))
        self.guide_ratio = _dot(arm, pin) / self.arm**2
        self.sliding_ratio = -_cross(arm, pin) / self.arm
        self.guide_gain = (
            -(_cross(arm, pin) / self.arm + 2 * self.sliding_ratio * self.guide_ratio) / self.arm
        )
        self.sliding_gain = self.arm * self.guide_ratio**2 - _dot(arm, pin) / self.arm


def _cross(u: Any, v: Any) -> Any:
    return u.real * v.imag - u.imag * v.real


def _dot(u: Any, v: Any) -> Any:
    return u.real * v.real + u.imag * v.imag


_CORE = "coursework.kinematics."
#: Twins by the names of what they replace.
_TWINS: dict[str, Any] = {
    "third_side": third_side,
    "corner": corner,
    "corner_beside": corner_beside,
    "FourBar": TextbookFourBar,
    "SliderCrank": TextbookSliderCrank,
    "SlottedGuidePose": TextbookSlottedGuide,
}


class Twinned(OtherNames):
    """Functions of a course with the core's functions replaced by their twins."""

    def value(self, name: str, value: Any, package: str) -> Any:
        if (getattr(value, "__module__", None) or "").startswith(_CORE):
            return _TWINS.get(getattr(value, "__name__", ""), value)
        is_own = isinstance(value, FunctionType) and package_of(value) == package != "coursework"
        return self(value) if is_own else value
