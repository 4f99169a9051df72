"""Functions of plain numbers, such as those of the numeric core: their units by dimensional analysis.

Whatever they give is computed again with lengths, masses and times in other base units. What is multiplied by
a power of each of those factors has those powers, and its unit follows from the units of what was handed in,
which must be of one system: lengths all in mm, say.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import CellType, FunctionType
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import CourseworkError
from coursework.quantities.other_names import PLAIN
from coursework.quantities.sizes import BASES, DEGREE, ONE, Sizes, UnitFault, Unprovable, of_hard, size_text
from coursework.quantities.unit_numbers import UnitValue, needs

_Factors = tuple[float, ...]
_SAME: _Factors = (1.0,) * BASES
_OTHERS = (1.375, 7.3)  #: factors that no rounded scale follows


class Origin(NamedTuple):
    """Origin of plain numbers: the function's name, whether it belongs to the numeric core, and the units
    passed to it."""

    name: str
    is_core: bool
    handed: Sizes = ()


class Opaque:
    """Result of a function of plain numbers, or the function itself, ready to be computed in other base
    units."""

    def __init__(self, make: Callable[[_Factors], Any], origin: Origin):
        self._make = make
        self._cached: dict[_Factors, Any] = {}
        self._origin = origin

    def _in_bases(self, factors: _Factors) -> Any:
        if factors not in self._cached:
            self._cached[factors] = self._make(factors)
        return self._cached[factors]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        origin = self._origin._replace(name=f"{self._origin.name}.{name}")
        return numbers_with_units(lambda f: getattr(self._in_bases(f), name), origin)

    def __getitem__(self, position: Any) -> Any:
        return numbers_with_units(lambda f: self._in_bases(f)[position], self._origin)

    def __len__(self) -> int:
        return len(self._in_bases(_SAME))

    def __iter__(self) -> Any:
        return (self[position] for position in range(len(self)))

    def __call__(self, *args: Any, **options: Any) -> Any:
        origin = self._origin
        if origin.name.startswith("Degrees"):
            for value in args:
                needs(value, DEGREE, "Degrees takes")
        else:
            origin = origin._replace(handed=(*origin.handed, *_handed((args, options))))
        return numbers_with_units(lambda f: self._in_bases(f)(*_plain(args, f), **_plain(options, f)), origin)


def opaque(item: Any) -> Opaque:
    """Return a function, a class or a module as a black box."""
    name = getattr(item, "__name__", str(item))
    home = getattr(item, "__module__", None) or name
    is_core = home.startswith("coursework.kinematics")
    return Opaque(lambda _: item, Origin(name.rpartition(".")[2], is_core))


def _handed(value: Any) -> list[Any]:
    if isinstance(value, UnitValue):
        return [value.sizes[0]]
    if isinstance(value, Opaque):
        return list(value._origin.handed)
    if isinstance(value, Mapping):
        return [s for v in value.values() for s in _handed(v)]
    if isinstance(value, (tuple, list)):
        return [s for v in value for s in _handed(v)]
    return []


def _plain(value: Any, factors: _Factors) -> Any:
    """Return the value in other base units."""
    if isinstance(value, UnitValue):
        powers = value.sizes[0].hard
        factor = math.prod(f**p for f, p in zip(factors, powers, strict=True))
        return value.value if factor == 1.0 else value.value * factor
    if isinstance(value, Opaque):
        return value._in_bases(factors)
    if isinstance(value, Mapping):
        return {k: _plain(v, factors) for k, v in value.items()}
    if type(value) in (tuple, list):
        return type(value)(_plain(v, factors) for v in value)
    if isinstance(value, FunctionType) and PLAIN in value.__globals__:
        return _of_plain_numbers(value, factors)
    return value


def _of_plain_numbers(function: FunctionType, factors: _Factors) -> FunctionType:
    """Return a course function as originally written, for a caller that takes plain numbers."""
    cells = tuple(CellType(_plain(cell.cell_contents, factors)) for cell in function.__closure__ or ())
    space = function.__globals__[PLAIN]
    return FunctionType(function.__code__, space, function.__name__, function.__defaults__, cells)


def unmeasured(value: Any) -> Any:
    """Return a value without units, in records and opaque results too."""
    return _plain(value, _SAME)


def numbers_with_units(make: Callable[[_Factors], Any], origin: Origin) -> Any:
    """Return a result of plain numbers: numbers with their units, texts unchanged, records entry by entry."""
    created = Opaque(make, origin)
    value = created._in_bases(_SAME)
    if value is None or isinstance(value, (str, bool, np.bool_)):
        return value
    if isinstance(value, np.ndarray) and value.dtype.kind in "USb":
        return value
    if isinstance(value, (int, float, complex, np.number)) or (
        isinstance(value, np.ndarray) and value.dtype.kind in "iufc"
    ):
        return _measured(created, origin)
    if type(value) in (tuple, list):
        return type(value)(created)
    return created


def _measured(created: Opaque, origin: Origin) -> Any:
    value = np.asarray(created._in_bases(_SAME))
    counted = value[np.isfinite(value) & (value != 0)]
    if not counted.size:
        return created._in_bases(_SAME)
    scales = _system(origin)
    powers = [_power(created, position, origin) for position in range(BASES)]
    scale = math.prod(s**p for s, p in zip(scales, powers, strict=True))
    return UnitValue(created._in_bases(_SAME), (of_hard(scale, powers),))


def _power(created: Opaque, position: int, origin: Origin) -> float:
    """Return the power of one base unit in a result."""
    if not any(size.hard[position] for size in origin.handed):
        return 0.0
    powers = {_power_of(created, position, other, origin) for other in _OTHERS}
    if len(powers) == 1 and None not in powers:
        return powers.pop() or 0.0
    if origin.is_core and len(units := sorted({size_text(s) for s in origin.handed if any(s.hard)})) > 1:
        raise UnitFault(f"hands {' and '.join(units)} to {origin.name}, which is to take lengths of one unit")
    raise Unprovable(f"what {origin.name} gives does not follow the units of what it takes")


def _power_of(created: Opaque, position: int, factor: float, origin: Origin) -> float | None:
    """Return the power of a base unit, measured by one factor; None where the result is not multiplied by a
    power of it."""
    factors = tuple(factor if k == position else 1.0 for k in range(BASES))
    value = np.asarray(created._in_bases(_SAME))
    try:
        other = np.asarray(created._in_bases(factors))
    except (CourseworkError, ArithmeticError, ValueError):
        return None
    is_there = np.isfinite(value) & (abs(value) > 1e-9 * np.max(abs(value[np.isfinite(value)])))
    ratios = other[is_there] / value[is_there] if value.shape == other.shape else np.array([np.nan])
    size = float(abs(ratios.flat[0]))
    power = round(2 * math.log(size) / math.log(factor)) / 2 if math.isfinite(size) and size else 0.0
    return power if np.allclose(ratios, factor**power, rtol=1e-6) else None


def _system(origin: Origin) -> list[float]:
    """Return the base units, in SI, of the one system that all units belong to. Raises UnitFault: two units
    of one dimension differ; Unprovable: units such as mm, kg and N together, which only a conversion
    inside could bring together."""
    sizes = [s for s in origin.handed if not s.is_like(ONE)]
    for first in sizes:
        for other in sizes:
            if first.hard == other.hard and not first.is_like(other):
                raise UnitFault(f"hands {size_text(first)} and {size_text(other)} to {origin.name}")
        if not any(first.hard) and not origin.is_core:
            raise Unprovable(f"{origin.name} takes {size_text(first)}, of which it may make what it likes")
        if not any(first.hard):
            raise UnitFault(
                f"hands {size_text(first)} to {origin.name}, which takes radians or plain numbers"
            )
    if not sizes:
        return [1.0] * BASES
    powers = np.array([s.hard for s in sizes])
    logs = np.log([s.scale for s in sizes])
    result = np.linalg.lstsq(powers, logs, rcond=None)[0]
    if not np.allclose(powers @ result, logs, atol=1e-9):
        raise Unprovable(
            f"{origin.name} takes units of several systems: "
            f"{', '.join(sorted({size_text(s) for s in sizes}))}"
        )
    return [float(v) for v in np.exp(result)]
