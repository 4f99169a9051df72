"""The values that usual errors give: of one variant, or of many at once, a column a variant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from coursework.course.exercise import CourseExercise
from coursework.errors import CourseworkError
from coursework.quantities.formula_code import Formula
from coursework.quantities.usual_errors import formula_errors

INPUT, NEIGHBOUR = TAKEN = ("input", "neighbour")  #: values that are taken for what is asked


class UsualError(NamedTuple):
    """An error that nobody need list: its kind, and where it is made."""

    kind: str
    source: str  #: the quantity in whose formula it is made, or the one that was taken for what is asked
    place: int = 0  #: among the errors of that formula


class ErrorValues:
    """Wrong values of the asked quantities that each usual error gives.

    ``given`` holds a scalar a name, or an array ``(n,)`` of so many variants.
    """

    def __init__(
        self,
        exercise: CourseExercise[Any],
        quantities: Sequence[str],
        given: Mapping[str, Any],
        effects: Sequence[str],
        count: int,
    ):
        self.exercise = exercise
        self.quantities = tuple(q for q in quantities if q not in given)
        self.given = given
        self.effects = effects
        self.count = count
        self._by_source: dict[str, tuple[tuple[UsualError, ...], dict[str, np.ndarray]]] = {}
        self._rows: dict[str, tuple[tuple[UsualError, ...], np.ndarray]] = {}

    def of(self, quantity: str) -> tuple[tuple[UsualError, ...], np.ndarray]:
        """Return the errors that reach a quantity, those in its own formula first, and their values: shape
        ``(errors, n)``.

        NaN where an error leads nowhere.
        """
        if quantity not in self._rows:
            pairs = [*self._in_formulas(quantity), *self._taken_for(quantity)]
            errors = tuple(error for error, _ in pairs)
            values = [column for _, column in pairs]
            self._rows[quantity] = errors, np.array(values).reshape(len(pairs), self.count)
        return self._rows[quantity]

    def of_one(self, error: UsualError, quantity: str) -> np.ndarray:
        """Return the values that an error in a formula gives for a quantity, shape ``(n,)``; NaN where it
        does not reach it."""
        source = error.source
        is_met = source == quantity or self._is_above(source, quantity)
        columns = self._errors_of(source)[1] if is_met else {}
        return columns[quantity][error.place] if quantity in columns else np.full(self.count, np.nan)

    def in_own_formula(self, quantity: str) -> tuple[tuple[UsualError, ...], np.ndarray]:
        """Return the errors in a quantity's own formula, and their values: shape ``(errors, n)``."""
        if quantity not in self.exercise.solution.graph.textbook.names or quantity not in self.quantities:
            return (), np.empty((0, self.count))
        errors, columns = self._errors_of(quantity)
        return (errors, columns[quantity]) if quantity in columns else ((), np.empty((0, self.count)))

    @cached_property
    def right(self) -> Mapping[str, Any]:
        """Every quantity met on the textbook way, and what is given."""
        graph = self.exercise.solution.graph.textbook
        with suppress(CourseworkError):
            return {**self.given, **graph.everything(self.quantities, self.given, self.effects)}
        return self.given

    def _in_formulas(self, quantity: str) -> Iterator[tuple[UsualError, np.ndarray]]:
        names = self.exercise.solution.graph.textbook.quantities
        above = [n for n in names if n != quantity and self._is_above(n, quantity)]
        for source in (quantity, *reversed(above)):
            errors, columns = self._errors_of(source)
            if quantity in columns:
                yield from zip(errors, columns[quantity], strict=True)

    def _is_above(self, source: str, quantity: str) -> bool:
        """Return whether a quantity is met on the way to another, so that an error in its formula reaches
        that."""
        is_met = source in self.right and source not in self.given
        return is_met and quantity in self.exercise.solution.depending_on(source)

    def _errors_of(self, source: str) -> tuple[tuple[UsualError, ...], dict[str, np.ndarray]]:
        """Return the errors in a formula, and by quantity that they reach their values, shape
        ``(errors, n)``."""
        if source not in self._by_source:
            node = self.exercise.solution.graph.textbook.node(source)
            found = formula_errors(node.function)
            errors = tuple(UsualError(error.kind, source, index) for index, error in enumerate(found))
            values, known = {**node.defaults, **self.right}, dict[int, Any]()
            wrong = np.full((len(found), self.count), np.nan)
            for row, error in zip(wrong, found, strict=True):
                if (real := self._value(error.formula, values, known)) is not None:
                    row[:] = real
            self._by_source[source] = errors, self._carried_on(source, wrong) if found else {}
        return self._by_source[source]

    def _carried_on(self, source: str, wrong: np.ndarray) -> dict[str, np.ndarray]:
        """Return the values that follow from wrong values of a quantity, shape ``(errors, n)``."""
        reached = [
            q for q in self.quantities if q != source and q in self.exercise.solution.depending_on(source)
        ]
        columns = {source: wrong} if source in self.quantities else {}
        if not reached:
            return columns
        rows = len(wrong)
        given = {n: np.tile(np.broadcast_to(v, (self.count,)), rows) for n, v in self.given.items()}
        given[source] = wrong.ravel()
        graph = self.exercise.solution.graph
        for some in (tuple(reached), *((q,) for q in reached)):
            with suppress(CourseworkError):
                values = graph.evaluate(some, given, self.effects)
                for name, value in values.items():
                    if (real := _real(value, (wrong.size,))) is not None:
                        columns[name] = np.broadcast_to(real, (wrong.size,)).reshape(wrong.shape)
                if len(some) == len(reached):
                    break
        return columns

    def _taken_for(self, quantity: str) -> Iterator[tuple[UsualError, Any]]:
        """Values of the same unit that are taken for what is asked: what it is computed from, what else is
        asked."""
        units = self.exercise.units
        solution = self.exercise.solution
        for name in (*self.given, *solution.graph.quantities):
            column = self._column(self.right.get(name, np.nan))
            alike = name != quantity and units.get(name) == units.get(quantity, "1")
            if not alike or np.isnan(column).all():
                continue
            if quantity in solution.depending_on(name):
                yield UsualError(INPUT, name), column
            elif name in self.quantities:
                yield UsualError(NEIGHBOUR, name), column

    def _value(self, formula: Formula, values: Mapping[str, Any], known: dict[int, Any]) -> np.ndarray | None:
        """Return the real values of a formula; None where it leads nowhere."""
        with suppress(CourseworkError, ArithmeticError, ValueError, TypeError, NameError, KeyError):
            return self._real(formula(values, known))
        return None

    def _real(self, value: Any) -> np.ndarray | None:
        return _real(value, (self.count,) if self._is_batch else ())

    def _column(self, value: Any) -> np.ndarray:
        """Return a number, or one a variant, as a column ``(n,)``; NaN for anything else."""
        real = self._real(value)
        return np.broadcast_to(np.nan if real is None else real, (self.count,))

    @cached_property
    def _is_batch(self) -> bool:
        return any(np.ndim(value) for value in self.given.values())


def _real(value: Any, shape: tuple[int, ...]) -> np.ndarray | None:
    """Return a real number, or an array of this shape; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, (int, float, np.generic, np.ndarray)):
        return None
    array = np.asarray(value)
    return array.astype(float) if array.dtype.kind in "iuf" and array.shape in ((), shape) else None
