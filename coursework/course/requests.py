"""Intake of a request's values for the solution: in canonical units, with defaults, within their domain."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from coursework.errors import WrongUnit, WrongValue, nearest, unknown
from coursework.language.numbers import plain
from coursework.model import GivenSpec


class Intake:
    """Takes in the values that requests give to one exercise.

    A value is a number, an array that broadcasts, the name of a case, or a text with a unit (``"0.2286 m"``).
    Whatever makes no sense raises ``UnknownName``, ``WrongUnit`` or ``WrongValue``, each with what would do.
    """

    def __init__(
        self,
        name: str,
        given: Mapping[str, GivenSpec],
        units: Mapping[str, str],
        names: frozenset[str],
        structures: frozenset[str],
        directions: frozenset[str] = frozenset(),
    ):
        self.name = name
        self._given = given
        self._units = units
        self._known = names  #: every name that a request may give
        self._structures = structures  #: names of lists and records
        self._directions = directions  #: angles that whole turns do not change

    @cached_property
    def defaults(self) -> Mapping[str, float | str]:
        """The given quantities that a request need not name."""
        return {
            n: float(s.default) if not isinstance(s.default, str) else s.default
            for n, s in self._given.items()
            if s.default is not None
        }

    @cached_property
    def _looked_at(self) -> frozenset[str]:
        """Given quantities that are not any number: their values are looked at one by one."""
        return frozenset(n for n, s in self._given.items() if s.positive or s.nonzero or s.is_choice)

    def values(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """All that a request gives and the solution knows, with defaults for what it leaves out.

        Directions of many turns are taken within one.
        """
        names = self._known
        values = {n: v for n, v in self.defaults.items() if n in names}
        for name, value in given.items():
            if name not in names:
                if name in self._given:
                    continue
                raise unknown("quantity", name, names | self._given.keys(), self.name)
            # The usual case at once: a plain number that nothing forbids.
            plainly = type(value) is float and value - value == 0 and name not in self._looked_at
            values[name] = value if plainly else self.value(name, value)
        for name in self._directions.intersection(values):
            values[name] = _within_a_turn(values[name])
        return values

    def value(self, name: str, value: Any) -> Any:
        """Return a given value as a float, an array or a case's name, in the canonical unit, within its
        domain."""
        if name in self._structures:
            return _structure(name, value)
        spec = self._given.get(name)
        if type(value) is float and value > 0 and value < math.inf and (spec is None or not spec.choices):
            return value
        if spec is not None and spec.is_choice:
            return self._case(name, spec, value)
        if isinstance(value, str):
            value = self._read(name, value)
        elif type(value) is not float:
            value = self._numbers(name, value)
        if isinstance(value, float) and not math.isfinite(value):
            raise WrongValue("{name} must be a finite number; found {value}", name=name, value=value)
        if spec is not None:
            self._check_domain(name, spec, value)
        return value

    def _numbers(self, name: str, value: Any) -> Any:
        """Return a float, a complex number or an array of them from whatever numpy can make one."""
        try:
            array = np.asarray(value)
        except ValueError:
            array = np.asarray(None)
        if array.dtype.kind not in "iufc" or isinstance(value, bool):
            raise WrongValue(
                "{name} must be a number or an array of numbers; found {value!r}",
                name=name,
                value=str(value)[:60],
            )
        if array.dtype.kind == "c" and name in self._given:
            raise WrongValue(
                "{name} must be a real number; found {value!r}", name=name, value=str(value)[:60]
            )
        if array.dtype.kind in "iu":
            array = array.astype(float)
        return array if array.ndim else array.item()

    def _case(self, name: str, spec: GivenSpec, value: Any) -> Any:
        for case in np.unique(np.asarray(value, dtype=str)).tolist():
            if case not in spec.choices:
                raise WrongValue(
                    "{name} must be one of {cases}; found {case!r}{near}",
                    name=name,
                    cases=", ".join(spec.choices),
                    case=case,
                    near=nearest(str(case), spec.choices),
                )
        return value if isinstance(value, str) else np.asarray(value)

    def _read(self, name: str, text: str) -> float:
        from coursework.parsing.numbers import read_number

        unit = self._units.get(name, "1")
        reading = read_number(text, unit)
        if reading.status == "wrong_unit":
            raise WrongUnit(
                "{name} is in {unit}; found {text!r}, which is not a unit of that kind",
                name=name,
                unit=unit,
                text=text,
            )
        if reading.status != "read":
            raise WrongValue(
                "{name} must be a number in {unit}; found {text!r}", name=name, unit=unit, text=text
            )
        if len(reading.values) > 1:
            first, second = (plain(value) for value in reading.values[:2])
            raise WrongValue(
                "{name}: {text!r} can be read as {first} or {second}; write it without a separator",
                name=name,
                text=text,
                first=first,
                second=second,
            )
        return reading.values[0]

    def _check_domain(self, name: str, spec: GivenSpec, value: Any) -> None:
        if isinstance(value, np.ndarray):
            if spec.positive and (value <= 0).any():
                raise _not_positive(name, np.nanmin(value), spec)
            if spec.nonzero and not value.all():
                raise WrongValue("{name} must not be 0", name=name)
        elif isinstance(value, float):
            if spec.positive and value <= 0:
                raise _not_positive(name, value, spec)
            if spec.nonzero and value == 0:
                raise WrongValue("{name} must not be 0", name=name)


def _not_positive(name: str, value: float, spec: GivenSpec) -> WrongValue:
    return WrongValue(
        "{name} must be positive; found {value} {unit}", name=name, value=f"{value:g}", unit=spec.unit
    )


def _within_a_turn(angle: Any) -> Any:
    """Return the same direction, without rounding, where whole turns would take digits from what is added to
    it."""
    if isinstance(angle, float):
        if abs(angle) <= 360:
            return angle
        rest = math.fmod(angle, 360.0)
        return rest - 360.0 * round(rest / 360.0)
    if not np.size(angle) or max(np.max(angle), -np.min(angle)) <= 360:
        return angle
    rest = np.fmod(angle, 360.0)
    return np.where(abs(angle) <= 360, angle, rest - 360.0 * np.rint(rest / 360.0))


def _structure(name: str, value: Any) -> Any:
    """Return a list or a record as it comes, or from its JSON."""
    if not isinstance(value, str):
        return tuple(value) if isinstance(value, list) else value
    try:
        return _structure(name, json.loads(value))
    except ValueError:
        raise WrongValue(
            "{name} is a list of records, or its JSON; found {value!r}", name=name, value=value[:60]
        ) from None
