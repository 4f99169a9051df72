"""Reader of the pieces of a mechanism's file: tables, expressions, given quantities and places."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from coursework.errors import BadInput, CourseworkError
from coursework.linkages.entries import GivenEntry, Place
from coursework.linkages.expressions import ExpressionReader, QuantityExpression, amount
from coursework.system.toml_files import TomlReader

NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*\Z")
POINT = re.compile(r"[A-Z][0-9]*\Z")
_UNPRINTED = re.compile(r"[\x00-\x1f\x7f{}]")  #: in a title, which becomes a line of a template
_NEAR = 1e-9  #: of a step: what rounding takes off a multiple of it
_MOST_ENTRIES = 100  #: of each table and list of a file


class TableReader(TomlReader):
    """Reader of tables whose numbers have units, and of places; numbers that stand in places get names of
    their own."""

    def __init__(self, path: Path, source: str, table: Mapping[str, Any]) -> None:
        super().__init__(path, source)
        self.table = table
        self.units: dict[str, str] = {}
        #: Numbers that stand in places and loads, by the names that they get.
        self.constants: dict[str, GivenEntry] = {}

    # -------------------------------------------------------------------- pieces

    def _table(self, *at: str | int) -> Mapping[str, Any]:
        result: Any = self.table
        for key in at:
            result = result.get(key, {}) if isinstance(result, Mapping) else {}
        if not isinstance(result, Mapping):
            raise self.refused(at, "{value} is a table; found {result!r}", value=at[-1], result=result)
        self._count(at, result)
        for key, value in result.items():
            if isinstance(value, (Mapping, list)):
                self._count((*at, key), value)
        return result

    def _count(self, at: Sequence[str | int], value: Any) -> None:
        """Refuse more entries than any mechanism has: the time to compile them grows with their square."""
        if len(value) > _MOST_ENTRIES:
            raise self.refused(
                at,
                "{value} has {count} entries; there are at most {most}",
                value=at[-1],
                count=len(value),
                most=_MOST_ENTRIES,
            )

    def _whole(self, key: str, otherwise: int) -> int:
        value = self.table.get(key, otherwise)
        if not isinstance(value, int) or isinstance(value, bool) or value < 1:
            raise self.refused(
                (key,), "{key} is a whole number from 1 on; found {value!r}", key=key, value=value
            )
        return value

    def _title(self) -> Mapping[str, str]:
        title = self.table.get("title", {})
        if isinstance(title, str):
            title = {"": title}
        if (
            not isinstance(title, Mapping)
            or not title
            or not all(isinstance(t, str) and t for t in title.values())
        ):
            raise self.refused(
                ("title",), "a title in each language: {example}", example='title = { fr = "…", en = "…" }'
            )
        for text in title.values():
            if _UNPRINTED.search(text) or len(text) > 120:
                raise self.refused(
                    ("title",),
                    "a title is one line of at most 120 characters without braces; found {text!r}",
                    text=text[:60],
                )
        return title

    def _checked(self, at: Sequence[str | int], read: Callable[..., Any], *arguments: Any) -> Any:
        """Call a reader, and add the line to what it refuses."""
        try:
            return read(*arguments)
        except BadInput:
            raise
        except CourseworkError as fault:
            raise self.refused(at, fault.args[0] if fault.args else str(fault)) from fault

    def _expression(
        self, at: Sequence[str | int], text: object, unit: str, name: str = "", always: bool = False
    ) -> QuantityExpression:
        """Read an expression; a number other than 0, or any if ``always``, becomes a given quantity of that
        name, which the sheet lists among its data."""
        found: QuantityExpression = self._checked(at, ExpressionReader(self.units).read, text, unit)
        if (
            not name
            or not found.is_number
            or (not always and (found.is_zero or (unit == "deg" and float(found.code) % 90 == 0)))
        ):
            return found
        while name in self.units:
            name += "_"
        self.units[name] = unit
        self.constants[name] = GivenEntry(unit, value=float(found.code))
        return QuantityExpression(name, (name,))

    # --------------------------------------------------------------------- given

    def _given(self) -> Mapping[str, GivenEntry]:
        results: dict[str, GivenEntry] = {}
        table = self._table("given")
        for name, value in table.items():
            if name == "require":
                continue
            at = ("given", name)
            if name in ("title", "version"):
                raise self.refused(at, "{name} is of the file: write it above [given]", name=name)
            if not NAME.match(name):
                raise self.refused(at, "{name!r} cannot name a quantity: letters, digits, _", name=name)
            results[name] = self._entry(at, name, value)
            self.units[name] = results[name].unit
        return results

    def _entry(self, at: tuple[str, str], name: str, value: Any) -> GivenEntry:
        reader = ExpressionReader(self.units)
        if not value or not isinstance(value, (str, int, float, Mapping)) or isinstance(value, bool):
            raise self._no_entry(at, name)
        if not isinstance(value, Mapping):
            unit = self._checked(at, reader.unit, value)
            self._has_unit(at, name, unit, value)
            found: QuantityExpression = self._checked(at, reader.read, value, unit)
            if not found.is_number:
                raise self.refused(
                    at,
                    "{name} is a number with its unit, or a range; what follows from {others} stands "
                    "where it is used: B = {value}",
                    name=name,
                    others=", ".join(found.names),
                    value=f'"{value}"',
                )
            self._is_length(at, name, unit, float(found.code), value)
            return GivenEntry(unit, value=float(found.code))
        self.only(value, ("from", "to", "step", "nonzero"), at, name)
        if "from" not in value or "to" not in value:
            raise self._no_entry(at, name)
        if not isinstance(value.get("nonzero", False), bool):
            raise self.refused((*at, "nonzero"), "nonzero = true; found {found!r}", found=value["nonzero"])
        step = value.get("step")
        stated = [v for v in (value["from"], value["to"], step) if v is not None]
        for later in re.findall(r"[A-Za-z_]\w*", f"{value['from']} {value['to']}"):
            if later in self._table("given") and later not in self.units:
                raise self.refused(
                    at,
                    "a bound names quantities before it; {later} stands no earlier than {name}",
                    later=later,
                    name=name,
                )
        units = [self._checked(at, reader.unit, v) for v in stated]
        unit = next((u for u in units if u != "1"), "1")
        self._has_unit(at, name, unit, value["from"])
        low, high = (self._expression((*at, key), value[key], unit) for key in ("from", "to"))
        width = self._checked((*at, "step"), amount, step, unit) if step is not None else 1.0
        if not width > 0:
            raise self.refused((*at, "step"), "a step is above 0; found {step}", step=step)
        if low.is_number and high.is_number and float(low.code) > float(high.code):
            raise self.refused(
                at,
                "{name} goes from the smaller value to the greater; found {value}, {value_2}",
                name=name,
                value=value["from"],
                value_2=value["to"],
            )
        if low.is_number and high.is_number:
            self._is_length(at, name, unit, float(low.code), value["from"])
            if math.floor(float(high.code) / width + _NEAR) < math.ceil(float(low.code) / width - _NEAR):
                raise self.refused(
                    (*at, "step"),
                    "no multiple of {step} lies between {low} and {high}: there is no value to draw; "
                    "choose a smaller step",
                    step=step,
                    low=value["from"],
                    high=value["to"],
                )
        exact = f"{float(Fraction(width).limit_denominator(10**6)):.9g}"
        positive = unit == "mm" and (not low.is_number or float(low.code) > 0)
        return GivenEntry(unit, None, low, high, exact, bool(value.get("nonzero", False)), positive)

    def _no_entry(self, at: tuple[str, str], name: str) -> BadInput:
        return self.refused(
            at, '{name} is "180 mm", or {{ from = "40 mm", to = "70 mm", step = "5 mm" }}', name=name
        )

    def _is_length(self, at: tuple[str, str], name: str, unit: str, number: float, value: object) -> None:
        """Refuse a bar or a radius, called r3 or R2, that is not above 0."""
        if unit == "mm" and re.fullmatch(r"[rR][0-9]*", name) and not number > 0:
            raise self.refused(at, "{name} is a length above 0; found {value!r}", name=name, value=value)

    def _has_unit(self, at: Sequence[str | int], name: str, unit: str, value: object) -> None:
        """Refuse a plain number for a quantity whose name says that it has a unit."""
        stem = re.match(r"[A-Za-z]+", name)
        wanted = {"r": "mm", "theta": "deg", "omega": "rad/s", "alpha": "rad/s^2"}.get(
            stem[0] if stem else ""
        )
        if wanted and unit not in (wanted, "1"):
            raise self.refused(
                at, "{name} is a value in {unit}; found {value!r}", name=name, unit=wanted, value=value
            )
        if wanted and unit == "1":
            raise self.refused(
                at, '{name} needs a unit: "{value} {unit}"', name=name, value=value, unit=wanted
            )

    # -------------------------------------------------------------------- points

    def _places(self, at: tuple[str, ...]) -> dict[str, Place]:
        table = self._table(*at)
        results = {}
        for name, value in table.items():
            self._check_point((*at, name), name)
            results[name] = self._place(
                (*at, name), value, (f"x{name}", f"x{name}", f"y{name}", f"gamma_{name}")
            )
        return results

    def _check_point(self, at: Sequence[str | int], point: str) -> None:
        if not POINT.match(point):
            raise self.refused(
                at, "a point is called by a capital letter, such as A or O2; found {point!r}", point=point
            )

    def _place(self, at: Sequence[str | int], value: Any, names: tuple[str, str, str, str]) -> Place:
        """Read a place; ``names`` of its constants: on the axis, x, y, the direction."""
        if isinstance(value, str):
            return Place(self._expression(at, value, "mm", names[0]))
        if isinstance(value, list) and len(value) == 2:
            x, y = (
                self._expression(at, each, "mm", name) for each, name in zip(value, names[1:3], strict=True)
            )
            return Place(x, y)
        if isinstance(value, Mapping) and set(value) == {"r", "angle"}:
            return Place(
                radius=self._expression(at, value["r"], "mm", names[0]),
                angle=self._expression(at, value["angle"], "deg", names[3]),
            )
        raise self.refused(
            at, 'a place is "r2", ["x", "y"] or {{ r = "r5", angle = "beta" }}; found {value!r}', value=value
        )
