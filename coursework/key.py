"""What the answers to a variant are marked by: reference values, accepted widths, and the wrong values that
are known.

Everything is computed when it is first asked for, of one variant alone; or of many variants of an
exercise at once (:class:`Batch`), which costs a hundredth each.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.errors import CourseworkError
from coursework.graph import plain_scalar
from coursework.model import Part
from coursework.rounding import envelope
from coursework.rules import ILL_DEGREES, ILL_SHARE, Rules
from coursework.units import convert

if TYPE_CHECKING:
    from coursework.exercise import CourseExercise
    from coursework.variant import Variant

#: Factors by which a unit is mistaken for another.
_UNIT_FACTORS = (1e3, 1e-3, 10.0, 0.1)
#: Kinds of part that a student goes on from, and that follow from others.
FOLLOWED = ("number", "angle", "integer", "choice")
_LENGTH = re.compile(r"(?<![^\W\d_])m?m(?![^\W\d_])")
_TURN_A_MINUTE = 60 / (2 * math.pi)


class Key:
    """The reference values of one variant, and the values each known wrong way would give."""

    def __init__(self, variant: Variant, rules: Rules | None = None):
        self.variant = variant
        self.solution = variant.exercise.solution
        self.rules = variant.exercise.course.rules if rules is None else rules

    @cached_property
    def reference(self) -> dict[str, Any]:
        """The asked quantities, and those that parts are judged with."""
        return self.variant.solution()

    # ------------------------------------------------------------------ widths

    @cached_property
    def envelope(self) -> dict[str, float]:
        """By quantity, how far a student lands at most who rounds at every step.

        Where that is unbounded, as far as a variant that is issued may let them land.
        """
        variant = self.variant
        found = envelopes(
            variant.exercise, self._quantities, variant.used, variant.effects, self.rules.digits
        )
        return {name: self._bounded(name, float(np.ravel(width)[0])) for name, width in found.items()}

    @property
    def numbers(self) -> dict[str, Any]:
        """What is known without the solution's mistakes, by name of the property."""
        return {"reference": self.reference, "envelope": self.envelope}

    def half_width(self, part: Part) -> float:
        """The largest accepted distance from the reference, in the part's unit; 0 for what is judged exactly."""
        if not part.has_margin:
            return 0.0
        size = 1.0 if part.kind == "direction" else float(np.linalg.norm(self.reference[part.quantity]))
        return max(part.half_width(size), self.envelope.get(part.quantity, 0.0))

    @property
    def _quantities(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(p.quantity for p in self.variant.parts))

    def _bounded(self, name: str, width: float) -> float:
        return width if math.isfinite(width) else ill_limit(self._part_of(name), self.reference[name])

    def _part_of(self, quantity: str) -> Part:
        return next(p for p in self.variant.parts if p.quantity == quantity)

    # -------------------------------------------------------------- wrong ways

    @cached_property
    def wrong(self) -> dict[str, dict[str, Any]]:
        """By named mistake, the asked quantities it reaches and their wrong values."""
        return {name: self._wrong(name) for name in self.solution.mistakes}

    def _wrong(self, name: str) -> dict[str, Any]:
        reached = tuple(q for q in self.reference if q in self.solution.reached(name))
        try:
            return self._mistaken(name, reached)
        except CourseworkError:
            pass  # the wrong way leads nowhere for some quantity of this variant; the others are tried alone
        values = {}
        for quantity in reached:
            with suppress(CourseworkError):
                values |= self._mistaken(name, (quantity,))
        return values

    def _mistaken(self, name: str, quantities: tuple[str, ...]) -> dict[str, Any]:
        graph = self.solution.mistaken(name)
        found = graph.evaluate(quantities, self.variant.used, self.variant.effects)
        return {quantity: plain_scalar(value) for quantity, value in found.items()}

    def wrong_ways(self, quantity: str) -> Iterator[tuple[str, Any]]:
        """The named mistakes that reach a quantity, each with its wrong value, in the solution's order."""
        for name, values in self.wrong.items():
            if quantity in values:
                yield name, values[quantity]

    def followed(self, part: Part, own: Mapping[str, Any], wrong: Collection[str]) -> Any:
        """What a right method gives from a student's own earlier answers, or None.

        ``own`` holds them by quantity, right ones too: a student goes on from what they wrote. None where
        no ``wrong`` one bears on this quantity, and where nothing comes of it: the linkage does not
        close, the value is not finite, or trivially 0. A count of 0 is not trivial.
        """
        quantity = part.quantity
        exact = {p.quantity for p in self.variant.parts if p.kind in ("integer", "choice")}
        before = {q: v for q, v in own.items() if q != quantity and (v or q in exact or q not in wrong)}
        if not any(quantity in self.solution.depending_on(q) for q in wrong if q in before):
            return None
        with suppress(CourseworkError):
            given = {**self.variant.used, **before}
            found = self.solution.graph.evaluate((quantity,), given, self.variant.effects)
            value = plain_scalar(found[quantity])
            if isinstance(value, str) or (math.isfinite(value) and (value or quantity in exact)):
                return value
        return None

    def slips(self, part: Part) -> Iterator[tuple[str, Any]]:
        """Wrong values that need nobody to declare them, by kind of slip."""
        reference = self.reference[part.quantity]
        if part.kind not in ("number", "angle") or part.judge:
            return
        if reference:
            yield "sign", -reference
        if part.unit == "deg":
            yield "radians", math.radians(reference)
            yield "radians", math.degrees(reference)
        elif part.unit != "1":
            if part.unit.startswith("rad/s"):
                yield "radians", math.degrees(reference)
                yield "radians", math.radians(reference)
            if part.unit == "rad/s":
                yield "turns_a_minute", reference * _TURN_A_MINUTE
                yield "turns_a_minute", reference / _TURN_A_MINUTE
            metres = _metres_for_millimetres(part.unit)
            for factor in dict.fromkeys((*_UNIT_FACTORS, metres, 1 / metres)):
                yield "unit", reference * factor
        for value in self._other_values(part.quantity):
            yield "other_case", value

    def _other_values(self, quantity: str) -> list[Any]:
        """Values of a quantity when a given case of two is taken for the other one: the assembly mode, say."""
        return self._other_cases.get(quantity, [])

    @cached_property
    def _other_cases(self) -> dict[str, list[Any]]:
        found: dict[str, list[Any]] = {}
        for given in _with_other_cases(self.variant.exercise, self.variant.used):
            for quantity in self._quantities:
                with suppress(CourseworkError):
                    value = self.solution.graph.evaluate((quantity,), given, self.variant.effects)[quantity]
                    found.setdefault(quantity, []).append(plain_scalar(value))
        return found


@lru_cache(maxsize=256)
def _metres_for_millimetres(unit: str) -> float:
    """By how much a value in a unit grows when its metres are taken for millimetres: 10⁶ for an area."""
    millimetres, metres = (_LENGTH.sub(length, unit) for length in ("mm", "m"))
    return float(convert(1.0, metres, millimetres))


def ill_limit(part: Part, reference: Any) -> float:
    """The widest envelope of a variant that may be issued, in the part's unit."""
    if part.unit == "deg":
        return ILL_DEGREES
    return ILL_SHARE * float(np.linalg.norm(reference)) if not isinstance(reference, str) else math.inf


def envelopes(
    exercise: CourseExercise,
    quantities: Sequence[str],
    given: Mapping[str, Any],
    effects: Sequence[str],
    digits: int,
) -> dict[str, Any]:
    """Envelopes for given scalars or arrays: shape ``(n,)`` each, 0 for a quantity that has none."""
    parts = {p.quantity: p for p in exercise.spec.parts}
    numeric = tuple(q for q in quantities if parts[q].has_margin and parts[q].kind != "direction")
    directions = {q for q in numeric if parts[q].kind == "angle"}
    found = envelope(exercise.solution.graph, numeric, given, effects, digits, directions)
    return {q: found.get(q, 0.0) for q in quantities}


def keys_of(exercise: CourseExercise, variants: Sequence[Variant]) -> Batch:
    """Give many variants of one exercise keys that are computed together.

    A variant that has some quantity that does not exist keeps a key of its own, which says why.
    """
    batch = Batch(exercise, variants)
    for index, variant in enumerate(variants):
        if batch.is_whole(index, variant.asked_quantities):
            variant.__dict__["key"] = _KeyOfBatch(variant, batch, index)
    return batch


class Batch:
    """What the answers to many variants of one exercise are marked by, a column a quantity.

    A column is computed when the first variant asks for it.
    """

    def __init__(self, exercise: CourseExercise, variants: Sequence[Variant]) -> None:
        self.exercise = exercise
        self.count = len(variants)
        names = (n for n in exercise.spec.given if n in exercise.quantity_names)
        self.given = {n: np.array([v.given[n] for v in variants]) for n in names}
        self.quantities = tuple(dict.fromkeys(p.quantity for p in exercise.spec.parts))
        self.along = tuple(dict.fromkeys(p.along for p in exercise.spec.parts if p.along))

    @cached_property
    def reference(self) -> dict[str, list]:
        wanted = (*self.quantities, *self.along)
        return _rows({name: self._found[name] for name in wanted if name in self._found}, self.count)

    @cached_property
    def _found(self) -> dict[str, Any]:
        """Every quantity met on the way to the answers; nothing where they cannot be computed together."""
        if not self.count:
            return {}
        wanted, effects = (*self.quantities, *self.along), self.exercise.spec.effects
        try:
            given = self.exercise.intake.values(self.given)
            return self.exercise.solution.graph.everything(wanted, given, effects)
        except CourseworkError:
            return {}  # each variant by itself then

    @cached_property
    def other_cases(self) -> dict[str, list[list]]:
        """By quantity, columns of its values when a given case of two is taken for the other one."""
        found: dict[str, list[list]] = {}
        for given in _with_other_cases(self.exercise, self.given):
            with suppress(CourseworkError):
                graph, effects = self.exercise.solution.graph, self.exercise.spec.effects
                for quantity, column in _rows(
                    graph.evaluate(self.quantities, given, effects), self.count
                ).items():
                    found.setdefault(quantity, []).append(column)
        return found

    def is_whole(self, index: int, quantities: Sequence[str]) -> bool:
        """Whether a variant has all these quantities."""
        return all(q in self.reference and exists(self.reference[q][index]) for q in quantities)

    @cached_property
    def envelope(self) -> dict[str, list]:
        rules, effects = self.exercise.course.rules, self.exercise.spec.effects
        return _rows(envelopes(self.exercise, self.quantities, self.given, effects, rules.digits), self.count)

    @cached_property
    def wrong(self) -> dict[str, dict[str, list]]:
        """Columns by mistake, of the quantities that it reaches."""
        return {name: self._wrong(name) for name in self.exercise.solution.mistakes}

    def _wrong(self, name: str) -> dict[str, list]:
        solution = self.exercise.solution
        reached = tuple(q for q in (*self.quantities, *self.along) if q in solution.reached(name))
        graph = solution.mistaken(name)
        found: dict[str, list] = {}
        for some in (reached, *((q,) for q in reached)):
            # Where all together lead nowhere, each is tried alone.
            with suppress(CourseworkError):
                values = graph.evaluate(some, self.given, self.exercise.spec.effects, self._found)
                found |= _rows(values, self.count)
                if len(some) == len(reached):
                    break
        return found


def _with_other_cases(exercise: CourseExercise, given: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Given values, of one variant or of many, with one case of two exchanged for the other, case by case."""
    for name, spec in exercise.spec.given.items():
        if len(spec.choices) == 2 and name in given:
            one, other = spec.choices
            exchanged = np.where(np.asarray(given[name]) == one, other, one)
            yield {**given, name: exchanged if exchanged.ndim else str(exchanged)}


class _KeyOfBatch(Key):
    """The key of one variant among many."""

    def __init__(self, variant: Variant, batch: Batch, index: int) -> None:
        super().__init__(variant)
        self._batch, self._index = batch, index

    @cached_property
    def reference(self) -> dict[str, Any]:
        return {q: self._batch.reference[q][self._index] for q in self.variant.asked_quantities}

    @cached_property
    def envelope(self) -> dict[str, float]:
        columns = self._batch.envelope
        return {q: self._bounded(q, float(columns[q][self._index])) for q in self._quantities}

    @cached_property
    def wrong(self) -> dict[str, dict[str, Any]]:
        found = {}
        for name, columns in self._batch.wrong.items():
            own = {q: columns[q][self._index] for q in self.reference if q in columns}
            found[name] = {q: value for q, value in own.items() if exists(value)}
        return found

    def _other_values(self, quantity: str) -> list[Any]:
        columns = self._batch.other_cases.get(quantity, ())
        return [column[self._index] for column in columns if exists(column[self._index])]

    def wrong_ways(self, quantity: str) -> Iterator[tuple[str, Any]]:
        for name, columns in self._batch.wrong.items():
            if quantity in columns and exists(columns[quantity][self._index]):
                yield name, columns[quantity][self._index]


def _rows(columns: Mapping[str, Any], count: int) -> dict[str, list]:
    """A list a quantity, a value a variant; vectors as arrays."""
    found = {}
    for name, values in columns.items():
        array = np.asarray(values)
        if array.ndim == 0 or array.shape[0] != count:
            found[name] = [plain_scalar(values)] * count
        else:
            found[name] = list(array) if array.ndim > 1 else array.tolist()
    return found


def exists(value: Any) -> bool:
    """Whether a value is a case, or finite in all its coordinates."""
    if isinstance(value, (float, int)):
        return math.isfinite(value)
    return isinstance(value, str) or bool(np.all(np.isfinite(value)))
