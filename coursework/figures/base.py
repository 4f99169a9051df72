"""Base class of the elements of a figure, and shapes that several share."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import MISSING, Field, FrozenInstanceError, dataclass, fields, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, dataclass_transform

from coursework.errors import CourseworkError, WrongValue
from coursework.figures.ink import EDGE, PINS, SHADES, WHITE, Disc, turn
from coursework.messages import Message

if TYPE_CHECKING:
    from coursework.figures.paper import FigurePaper

PIN = 1.1  #: radius of a pin, mm on paper
BLOCK = complex(3.2, 1.7)  #: half-length and half-height of a slider's block
SLOT = 2.2  #: half-width of a slotted guide
NEAR = 1.4  #: where a label starts, from the centre of a pin
AWAY = 1.15  #: where a label starts, from a line

Bars = tuple[tuple[complex, complex], ...]


@dataclass_transform(frozen_default=True)
class Element:
    """Element of a figure, in mechanism coordinates: complex numbers, mm, y up; degrees from +x.

    Each subclass is a frozen dataclass of the fields that it names. All share these methods: compiling some
    for each class would double the time in which a figure's module is loaded.
    """

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __init_subclass__(cls) -> None:
        dataclass(init=False, repr=False, eq=False)(cls)

    def __init__(self, *values: object, **named: object) -> None:
        text = self._fields()
        given = dict(zip((name for name, _, _ in text), values, strict=False)) | named
        unknown = given.keys() - {name for name, _, _ in text}
        if unknown or len(given) < len(values) + len(named):
            requested = ", ".join(name for name, _, _ in text)
            raise TypeError(
                f"{type(self).__name__} takes {requested}, each once; found {len(values)} values and "
                f"{[*named]}"
            )
        for name, kind, default in text:
            value = given.get(name, default)
            if value is MISSING:
                raise TypeError(f"{type(self).__name__}: {name} is missing")
            self.__dict__[name] = self._checked(name, kind, value)

    def _values(self) -> tuple[object, ...]:
        return tuple(self.__dict__[name] for name, _, _ in self._fields())

    def __eq__(self, other: object) -> bool:
        return self._values() == other._values() if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._values())

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({', '.join(f'{n}={self.__dict__[n]!r}' for n, _, _ in self._fields())})"
        )

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> None:
        raise FrozenInstanceError(f"cannot delete field {name!r}")

    @classmethod
    @lru_cache(maxsize=128)
    def _fields(cls) -> tuple[tuple[str, str, object], ...]:
        """Return the name of each field, its type as written, and its default."""
        return tuple((item.name, str(item.type), item.default) for item in fields(cls))

    def _checked(self, name: str, kind: str, value: Any) -> object:
        try:
            value = _READ[kind](value)
        except CourseworkError:  # a label says itself what is wrong with it
            raise
        except (TypeError, ValueError) as error:
            raise WrongValue(
                "{element}: {name} is {value!r}, not {asked}",
                element=type(self).__name__,
                name=name,
                value=value,
                asked=_ASKED[kind],
            ) from error
        numbers = value if isinstance(value, tuple) else (value,)
        if any(isinstance(x, (float, complex)) and not cmath.isfinite(x) for x in numbers):
            raise WrongValue(
                "{element}: {name} is {value!r}, not finite",
                element=type(self).__name__,
                name=name,
                value=value,
            )
        return value

    def settled(self, decimals: int) -> Element:
        """Return the element with its points and numbers rounded to ``decimals`` decimals."""
        entries = {name: self.__dict__[name] for name, _, _ in self._fields()}
        changed = {
            name: new for name, old in entries.items() if repr(new := _rounded(old, decimals)) != repr(old)
        }
        return replace(self, **changed) if changed else self

    def labelled(self, write: Callable[[str], str]) -> Element:
        """Return the element with each label as ``write`` gives it."""
        changed: dict[str, Any] = {}
        for name, kind, _ in self._fields():
            label = self.__dict__[name]
            if label and kind == "str | None":
                changed[name] = write(label)
            elif kind == "tuple[str, str]":
                changed[name] = tuple(map(write, label))
        return replace(self, **changed) if any(self.__dict__[n] != v for n, v in changed.items()) else self

    def reach(self) -> tuple[complex, ...]:
        """Return the points that bound the element."""
        return tuple(z for value in self._values() for z in _points(value))

    def bars(self) -> Bars:
        """Return the segments of links, which labels and pin supports avoid."""
        return ()

    def draw(self, paper: FigurePaper) -> None:
        raise NotImplementedError


def _rounded(value: Any, decimals: int) -> Any:
    if isinstance(value, complex):
        return complex(round(value.real, decimals) + 0.0, round(value.imag, decimals) + 0.0)
    if isinstance(value, float):
        return (round(value, decimals) or value) + 0.0  # what is positive stays so
    return tuple(_rounded(item, decimals) for item in value) if isinstance(value, tuple) else value


def _points(value: object) -> tuple[complex, ...]:
    if isinstance(value, complex):
        return (value,)
    return value if isinstance(value, tuple) and all(isinstance(z, complex) for z in value) else ()


def _label(value: object) -> str:
    if value is None:
        return ""
    if not isinstance(value, str):
        raise TypeError
    if not value:
        return value
    from coursework.figures.text import read

    return value if read(value) else ""


def _positive(value: float) -> float:
    if not float(value) > 0:
        raise ValueError
    return float(value)


def _shade(value: str) -> str:
    if value not in SHADES:
        raise ValueError
    return value


_READ: dict[str, Callable[[Any], object]] = {
    "complex": complex,
    "float": float,
    "Positive": _positive,
    "Positive | None": lambda value: None if value is None else _positive(value),
    "float | None": lambda value: None if value is None else float(value),
    "bool": bool,
    "str | None": _label,
    "Shade": _shade,
    "tuple[str, str]": lambda value: tuple(map(_label, value)),
    "tuple[complex, ...]": lambda value: tuple(map(complex, value)),
}
_ASKED = {
    "complex": Message("a point (a complex number)"),
    "float": Message("a number"),
    "Positive": Message("a positive number"),
    "Positive | None": Message("a positive number"),
    "float | None": Message("a number"),
    "bool": Message("true or false"),
    "str | None": Message("a label"),
    "Shade": Message("one of {names}", names=", ".join(SHADES)),
    "tuple[str, str]": Message("two labels"),
    "tuple[complex, ...]": Message("points (complex numbers)"),
}
Positive = float
Shade = str


def circle_points(center: complex, radius: float) -> tuple[complex, ...]:
    return tuple(center + radius * direction for direction in (1, 1j, -1, -1j))


def arc_points(center: complex, radius: float, start: float, end: float) -> tuple[complex, ...]:
    steps = max(2, math.ceil(abs(end - start) / 15))
    return tuple(center + radius * turn(start + (end - start) * k / steps) for k in range(steps + 1))


def ring(paper: FigurePaper, p: complex) -> None:
    paper.draw(Disc(p, PIN, EDGE, WHITE, layer=PINS))
