"""Keys to many variants of one exercise, computed together: a hundredth of the cost each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np

from coursework.course.answer_key import Key, envelopes, exists, is_real, with_other_cases
from coursework.course.asked import KeySource
from coursework.course.error_values import ErrorValues, UsualError
from coursework.course.exercise import CourseExercise
from coursework.course.marking_rules import Rules
from coursework.errors import CourseworkError
from coursework.quantities.graph import plain_scalar

NO_RANKS: Mapping[str, int] = MappingProxyType({})


class Keyed(KeySource, Protocol):
    """A variant that takes a key."""

    key: Key


def keys_of(exercise: CourseExercise[Any], variants: Sequence[Keyed], rules: Rules | None = None) -> Batch:
    """Give many variants of one exercise keys that are computed together; by default they mark by the
    course's rules.

    A variant that has some quantity that does not exist keeps a key of its own, which says why.
    """
    batch = Batch(exercise, variants, rules)
    for index, variant in enumerate(variants):
        if batch.is_whole(index, variant.asked_quantities):
            variant.key = _KeyOfBatch(variant, batch, index)
        elif rules is not None:
            variant.key = Key(variant, rules)
    return batch


def given_columns(exercise: CourseExercise[Any], variants: Sequence[KeySource]) -> dict[str, np.ndarray]:
    """Return the given quantities that the solution knows, each of shape ``(n,)``: a value a variant."""
    names = (n for n in exercise.spec.given if n in exercise.quantity_names)
    return {n: np.array([v.given[n] for v in variants]) for n in names}


class Batch:
    """Answer keys of many variants of one exercise, a column a quantity.

    A column is computed when the first variant asks for it.
    """

    def __init__(
        self, exercise: CourseExercise[Any], variants: Sequence[Keyed], rules: Rules | None = None
    ) -> None:
        self.exercise = exercise
        self.rules = exercise.folder.rules if rules is None else rules
        self.count = len(variants)
        self.given = given_columns(exercise, variants)
        self.quantities = tuple(dict.fromkeys(p.quantity for p in exercise.judged_parts))
        self.ranks = {p.quantity: p.sort.rank for p in exercise.judged_parts}
        self.along = tuple(dict.fromkeys(p.along for p in exercise.spec.parts if p.along))

    @cached_property
    def reference(self) -> dict[str, list]:
        wanted = (*self.quantities, *self.along)
        return self._rows({name: self._found[name] for name in wanted if name in self._found})

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
        columns: dict[str, list[list]] = {}
        for given in with_other_cases(self.exercise, self.given):
            with suppress(CourseworkError):
                graph, effects = self.exercise.solution.graph, self.exercise.spec.effects
                values = graph.evaluate(self.quantities, given, effects)
                for quantity, column in self._rows(values).items():
                    columns.setdefault(quantity, []).append(column)
        return columns

    @cached_property
    def in_radians(self) -> dict[str, list[list]]:
        """By quantity, columns of what a calculator that is set to radians gives."""
        effects = self.exercise.spec.effects
        by_quantity: dict[str, list[list]] = {q: [] for q in self.quantities}
        for graph in self.exercise.solution.in_radians:
            for quantity, columns in by_quantity.items():
                with suppress(CourseworkError):
                    values = self._rows(graph.evaluate((quantity,), self.given, effects))
                    columns.append(values[quantity])
        return by_quantity

    @cached_property
    def error_values(self) -> ErrorValues:
        """Return the values that usual errors give for the asked quantities."""
        effects = self.exercise.spec.effects
        return ErrorValues(self.exercise, self.quantities, self.given, effects, self.count)

    def _rows(self, columns: Mapping[str, Any]) -> dict[str, list]:
        return _rows(columns, self.count, self.ranks)

    def is_whole(self, index: int, quantities: Sequence[str]) -> bool:
        """Return whether a variant has all these quantities; a complex one it refuses by itself."""
        return all(
            q in self.reference
            and exists(self.reference[q][index])
            and not isinstance(self.reference[q][index], complex)
            for q in quantities
        )

    @cached_property
    def envelope(self) -> dict[str, list]:
        effects, digits = self.exercise.spec.effects, self.rules.digits
        return _rows(envelopes(self.exercise, self.quantities, self.given, effects, digits), self.count)

    @cached_property
    def wrong(self) -> dict[str, dict[str, list]]:
        """Columns by mistake, of the quantities that it reaches."""
        return {name: self._wrong(name) for name in self.exercise.solution.mistakes}

    def _wrong(self, name: str) -> dict[str, list]:
        solution = self.exercise.solution
        reached = tuple(q for q in (*self.quantities, *self.along) if q in solution.reached(name))
        graph = solution.mistaken(name)
        columns: dict[str, list] = {}
        for some in (reached, *((q,) for q in reached)):
            # Where all together lead nowhere, each is tried alone.
            with suppress(CourseworkError):
                values = graph.evaluate(some, self.given, self.exercise.spec.effects, self._found)
                columns |= self._rows(values)
                if len(some) == len(reached):
                    break
        return columns


class _KeyOfBatch(Key):
    """The key of one variant among many."""

    is_of_batch = True

    def __init__(self, variant: KeySource, batch: Batch, index: int) -> None:
        super().__init__(variant, batch.rules)
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
        values = {}
        for name, columns in self._batch.wrong.items():
            row = {q: columns[q][self._index] for q in self.reference if q in columns}
            values[name] = {q: value for q, value in row.items() if exists(value)}
        return values

    @cached_property
    def in_radians(self) -> dict[str, list[float]]:
        columns = self._batch.in_radians
        rows = {q: [column[self._index] for column in columns[q]] for q in self._quantities}
        return {q: [float(v) for v in row if is_real(v)] for q, row in rows.items()}

    def _other_values(self, quantity: str) -> list[Any]:
        columns = self._batch.other_cases.get(quantity, ())
        return [column[self._index] for column in columns if exists(column[self._index])]

    def usual_ways(self, quantity: str) -> tuple[tuple[UsualError, ...], np.ndarray]:
        errors, values = self._batch.error_values.of(quantity)
        return errors, values[:, self._index]

    def usual_value(self, error: UsualError, quantity: str) -> float:
        return float(self._batch.error_values.of_one(error, quantity)[self._index])

    def wrong_ways(self, quantity: str) -> Iterator[tuple[str, Any]]:
        for name, columns in self._batch.wrong.items():
            if quantity in columns and exists(columns[quantity][self._index]):
                yield name, columns[quantity][self._index]


def _rows(columns: Mapping[str, Any], count: int, ranks: Mapping[str, int] = NO_RANKS) -> dict[str, list]:
    """Return a list a quantity, a value a variant; vectors and matrices, whose axes are ``ranks``, as
    arrays."""
    rows = {}
    for name, values in columns.items():
        array = np.asarray(values)
        if array.ndim <= ranks.get(name, 0) or array.shape[0] != count:
            rows[name] = [plain_scalar(values)] * count
        else:
            rows[name] = list(array) if array.ndim > 1 else array.tolist()
    return rows
