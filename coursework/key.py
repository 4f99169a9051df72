"""What the answers to a variant are marked by: reference values, accepted widths, and the wrong values that
are known.

Everything is computed when it is first asked for, of one variant alone; or for many variants of an
exercise at once (:func:`keys_of`), which costs a hundredth each.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.errors import CourseworkError
from coursework.graph import plain_scalar
from coursework.model import Part
from coursework.rounding import envelope
from coursework.rules import ILL_DEGREES, ILL_SHARE, Rules

if TYPE_CHECKING:
    from coursework.course import CourseExercise, Variant

#: Factors by which a unit is mistaken for another.
_UNIT_FACTORS = (1e3, 1e-3, 10.0, 0.1)
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

    def followed(self, part: Part, own: Mapping[str, float]) -> Iterator[Any]:
        """What a right method gives from a student's own wrong values: from all of them, then from each.

        Only where it is well-posed: it closes, is finite and not trivially 0.
        """
        own = {q: v for q, v in own.items() if q != part.quantity and v and self._reaches(q, part.quantity)}
        for some in ([own] if own else []) + ([{q: v} for q, v in own.items()] if len(own) > 1 else []):
            with suppress(CourseworkError):
                found = self.solution.graph.evaluate(
                    (part.quantity,), {**self.variant.used, **some}, self.variant.effects
                )
                value = plain_scalar(found[part.quantity])
                if isinstance(value, (int, float)) and math.isfinite(value) and value != 0:
                    yield value

    def _reaches(self, start: str, end: str) -> bool:
        return end in self.solution.depending_on(start)

    def slips(self, part: Part) -> Iterator[tuple[str, Any]]:
        """Wrong values that need nobody to declare them, by kind of slip."""
        reference = self.reference[part.quantity]
        if part.kind not in ("number", "angle"):
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
            for factor in _UNIT_FACTORS:
                yield "unit", reference * factor
        yield from self._other_cases.get(part.quantity, ())

    @cached_property
    def _other_cases(self) -> dict[str, list[tuple[str, Any]]]:
        """By quantity, its values when a given case of two is taken for the other one: the assembly mode, say."""
        found: dict[str, list[tuple[str, Any]]] = {}
        for name, spec in self.variant.exercise.spec.given.items():
            if len(spec.choices) != 2 or name not in self.variant.used:
                continue
            (other,) = (c for c in spec.choices if c != self.variant.used[name])
            given = {**self.variant.used, name: other}
            for quantity in self._quantities:
                with suppress(CourseworkError):
                    value = self.solution.graph.evaluate((quantity,), given, self.variant.effects)[quantity]
                    found.setdefault(quantity, []).append(("other_case", plain_scalar(value)))
        return found


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
    numeric = tuple(q for q in quantities if not parts[q].is_exact and parts[q].kind != "direction")
    directions = {q for q in numeric if parts[q].kind == "angle"}
    found = envelope(exercise.solution.graph, numeric, given, effects, digits, directions)
    return {q: found.get(q, 0.0) for q in quantities}


def keys_of(exercise: CourseExercise, variants: Sequence[Variant], *, wrong: bool = True) -> None:
    """Give many variants of one exercise their keys, computed together.

    A quantity that does not exist for some variant is left to that variant, which says why.
    """
    if not variants:
        return
    rules = exercise.course.rules
    given = {
        n: np.array([v.given[n] for v in variants])
        for n in exercise.spec.given
        if n in exercise.quantity_names
    }
    quantities = tuple(dict.fromkeys(p.quantity for p in exercise.spec.parts))
    along = tuple(dict.fromkeys(p.along for p in exercise.spec.parts if p.along))
    effects = exercise.spec.effects
    try:
        reference = _rows(exercise.solve(**given, only=(*quantities, *along), effects=effects), len(variants))
        widths = _rows(envelopes(exercise, quantities, given, effects, rules.digits), len(variants))
        mistaken = _mistaken_rows(exercise, given, quantities + along, len(variants)) if wrong else None
    except CourseworkError:
        return  # each variant by itself then
    for i, variant in enumerate(variants):
        key = variant.key
        own = {q: reference[q][i] for q in variant.asked_quantities}
        if not all(_exists(value) for value in own.values()):
            continue
        key.reference = own
        key.envelope = {q: key._bounded(q, float(widths[q][i])) for q in key._quantities}
        if mistaken is not None:
            key.wrong = {
                name: {q: rows[q][i] for q in own if q in rows and _exists(rows[q][i])}
                for name, rows in mistaken.items()
            }


def _mistaken_rows(
    exercise: CourseExercise, given: Mapping[str, Any], quantities: Sequence[str], count: int
) -> dict[str, dict[str, list]]:
    """Rows of wrong values by mistake, for the quantities that it reaches."""
    found = {}
    for name in exercise.solution.mistakes:
        reached = tuple(q for q in quantities if q in exercise.solution.reached(name))
        graph = exercise.solution.mistaken(name)
        found[name] = _rows(graph.evaluate(reached, given, exercise.spec.effects), count)
    return found


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


def _exists(value: Any) -> bool:
    return isinstance(value, str) or bool(np.all(np.isfinite(value)))
