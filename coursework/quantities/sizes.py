"""Size of a unit: a scale and powers of base units; and the possible meanings of a number in a formula.

A value is known by the *sizes* that it may have: several, where a number of the formula may be a conversion
or a plain factor. What it is added to, and what the quantity declares, tell which one was meant.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from coursework.parsing.units import DIMENSIONS, find_unit

#: Dimensions that may go unsaid: an angle is a ratio, a turn is a count, and ``180`` may be a number like any
#: other.
_SOFT = ("angle", "cycle")
_HARD = tuple(place for place, name in enumerate(DIMENSIONS) if name not in _SOFT)
_ANGLE, _CYCLE, _BARE = DIMENSIONS.index("angle"), DIMENSIONS.index("cycle"), len(DIMENSIONS)
BASES = len(_HARD)  #: base units that a value is measured in
_MOST = 128  #: sizes that are followed of one value
_SAME = 1e-9  #: relative


class UnitFault(Exception):
    """Violation of units by a formula, in words."""


class Unprovable(Exception):
    """Reason why units cannot be followed, in words."""


class Size(NamedTuple):
    """Size of a unit in base units (m, kg, s, A, …): a scale, powers by :data:`DIMENSIONS`, then of plain
    degrees."""

    scale: float = 1.0
    powers: tuple[float, ...] = (0.0,) * (_BARE + 1)

    @property
    def hard(self) -> tuple[float, ...]:
        """Powers that must agree wherever values meet."""
        return tuple(self.powers[position] for position in _HARD)

    @property
    def angle(self) -> float:
        return self.powers[_ANGLE]

    def times(self, other: Size, power: float = 1) -> Size:
        powers = tuple(a + power * b for a, b in zip(self.powers, other.powers, strict=True))
        return Size(self.scale * other.scale**power, powers)

    def is_like(self, other: Size) -> bool:
        """Return whether values of the two sizes may be added."""
        return _near(self.scale, other.scale) and all(map(_near_power, self.hard, other.hard))


Sizes = tuple[Size, ...]


def size(scale: float = 1.0, **powers: float) -> Size:
    """Return a size by the names of its dimensions; ``bare`` counts the degrees taken as plain numbers."""
    return Size(scale, tuple(float(powers.get(name, 0)) for name in (*DIMENSIONS, "bare")))


def of_hard(scale: float, powers: Sequence[float]) -> Size:
    """Return a size by its scale and its powers of base units alone."""
    return size(scale, **{DIMENSIONS[position]: power for position, power in zip(_HARD, powers, strict=True)})


ONE = size()
RADIAN = size(angle=1)
DEGREE = size(math.pi / 180, angle=1)


def sizes_of(unit: str) -> Sizes:
    """Return the possible sizes of a unit: a turn a minute is an angular rate, or a frequency."""
    unit_found = find_unit(unit)
    if unit_found is None:
        raise Unprovable(f"no unit {unit!r}")
    first = Size(unit_found.factor, (*map(float, unit_found.dimension), 0.0))
    return (first, *_counted(first), *_turning(first))


def _counted(item: Size) -> Sizes:
    """Return the turns of a unit as a count: for ``tr/min`` and ``tr``, not for degrees."""
    if not item.angle:
        return ()
    scale = item.scale / (2 * math.pi) ** item.angle
    if not any(_near(scale, 60.0**k) for k in (-2, -1, 0, 1, 2)):
        return ()
    return (Size(scale, _with(item.powers, **{"angle": 0, "cycle": item.powers[_CYCLE] + item.angle})),)


def _turning(item: Size) -> Sizes:
    """Return the cycles of a unit as turns: for ``Hz``."""
    cycles = item.powers[_CYCLE]
    if not cycles:
        return ()
    return (Size(item.scale * (2 * math.pi) ** cycles, _with(item.powers, angle=cycles, cycle=0)),)


def _with(powers: Sequence[float], **changed: float) -> tuple[float, ...]:
    names = (*DIMENSIONS, "bare")
    return tuple(float(changed.get(name, power)) for name, power in zip(names, powers, strict=True))


def fits(result: Size, declared: Size) -> bool:
    """Return whether a value of one size may be declared in the other.

    Radians, turns and plain numbers need no mention; a plain 180 or a count of turns is not an angle, and
    radians a second are not hertz.
    """
    if not result.is_like(declared):
        return False
    if declared.angle:
        is_angle = not any(declared.hard)
        return not result.powers[_CYCLE] and not (is_angle and result.powers[_BARE])
    return not (declared.powers[_CYCLE] and result.angle)


def _near(a: float, b: float) -> bool:
    return abs(a - b) <= _SAME * max(abs(a), abs(b))


def _near_power(a: float, b: float) -> bool:
    return abs(a - b) <= 1e-6


def distinct(sizes: Iterable[Size]) -> Sizes:
    """Return the sizes without repetition, the plainest first."""
    retained: list[Size] = []
    for first in sizes:
        if not any(first.powers == other.powers and _near(first.scale, other.scale) for other in retained):
            retained.append(first)
        if len(retained) > _MOST:
            raise Unprovable("more numbers that may be conversions than can be followed")
    return tuple(retained)


# ------------------------------------------------------------- numbers of formulas

_DEGREES = (30, 45, 60, 90, 120, 135, 180, 270, 360, 720)
_WEIGHT = (9.8, 9.80665, 9.806, 9.807, 9.81)  #: m/s^2
_ANGULAR = (1.0, math.pi, 2 * math.pi, 180 / math.pi, 180.0)


def meanings(number: float) -> tuple[Sizes, bool]:
    """Return the possible meanings of a factor of a formula, as sizes, and whether it is surely a conversion.

    1000 may turn metres into millimetres, 60 minutes into seconds, 180 may be degrees, 9.81 metres a second
    squared. ``180/pi`` is always a conversion.
    """
    value = abs(number)
    if not math.isfinite(value) or value in (0.0, 1.0):
        return (ONE,), False
    if _near(value, 180 / math.pi) or _near(value, math.pi / 180):
        return (size(1 / value),), True
    results = [size(bare=1) if value in _DEGREES else ONE]
    if _is_conversion(value):
        results.append(size(1 / value))
    if value in _DEGREES:
        results.append(DEGREE)
    for scale in (1.0, 1e-3):
        if any(_near(value * scale, weight) for weight in _WEIGHT):
            results.append(size(scale, length=1, time=-2))
    return tuple(results), len(results) > 1


def _is_conversion(value: float) -> bool:
    """Return whether a value is a power of ten, or a product of powers of 60, pi and 180 with thousands."""
    if _is_whole(math.log10(value)):
        return True
    for sixties, angular, sense in itertools.product((-2, -1, 0, 1, 2), _ANGULAR, (1, -1)):
        rest = math.log10(value / (60.0**sixties * angular**sense))
        if _is_whole(rest) and round(rest) in (-3, 0, 3) and (sixties or angular != 1):
            return True
    return False


def _is_whole(power: float) -> bool:
    return abs(power - round(power)) < 1e-9 and abs(power) <= 15


# ---------------------------------------------------------------------------- words

_NAMES = (
    "1 rad deg tr % mm cm m km µm mm^2 cm^2 m^2 mm^3 m^3 s ms min h 1/s rad/s deg/s tr/min mm/s cm/s "
    "m/s km/s km/h "
    "rad/s^2 deg/s^2 mm/s^2 m/s^2 N kN N*m N*mm kN*m kN*mm kg g t kg*m^2 kg*mm^2 kg*mm kg*m J W kW Pa "
    "kPa MPa N/mm N/m Hz"
).split()


def size_text(item: Size) -> str:
    """Return a size by a unit's name, else by powers of base units."""
    for name in _NAMES:
        unit_size = sizes_of(name)[0]
        if (
            item.is_like(unit_size)
            and unit_size.angle == item.angle
            and unit_size.powers[_CYCLE] == item.powers[_CYCLE]
        ):
            return "a plain number" if name == "1" else name
    for name in _NAMES:
        if item.is_like(sizes_of(name)[0]):
            return "a plain number" if name in ("1", "rad") else name
    bases = {"length": "m", "mass": "kg", "time": "s", "current": "A"}
    powers = zip(DIMENSIONS, item.powers, strict=False)
    factors = [f"{bases.get(n, n)}^{p:g}".removesuffix("^1") for n, p in powers if p and n not in _SOFT]
    return " ".join([f"{item.scale:.6g}", *(["*".join(factors)] if factors else [])])
