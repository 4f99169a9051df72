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
        self._by_source: dict[str, dict[str, np.ndarray]] = {}
        self._rows: dict[str, tuple[tuple[UsualError, ...], np.ndarray]] = {}

    def of(self, quantity: str) -> tuple[tuple[UsualError, ...], np.ndarray]:
        """Return the errors that reach a quantity, those in its own formula first, and their values: shape ``(errors, n)``.

        NaN where an error leads nowhere.
        """
        if quantity not in self._rows:
            pairs = [*self._in_formulas(quantity), *self._taken_for(quantity)]
            errors = tuple(error for error, _ in pairs)
            values = [column for _, column in pairs]
            self._rows[quantity] = errors, np.array(values).reshape(len(pairs), self.count)
        return self._rows[quantity]

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
        textbook = self.exercise.solution.graph.textbook
        above = [n for n in textbook.quantities if n in self.right and n not in (quantity, *self.given)]
        reach = [n for n in above if quantity in self.exercise.solution.depending_on(n)]
        for source in (quantity, *reversed(reach)):
            errors, columns = self._errors_of(source)
            if quantity in columns:
                yield from zip(errors, columns[quantity], strict=True)

    def _errors_of(self, source: str) -> tuple[tuple[UsualError, ...], dict[str, np.ndarray]]:
        """Return the errors in a formula, and by quantity that they reach their values, shape ``(errors, n)``."""
        node = self.exercise.solution.graph.textbook.node(source)
        errors_found = formula_errors(node.function)
        errors = tuple(UsualError(error.kind, source, index) for index, error in enumerate(errors_found))
        if source not in self._by_source:
            values = {**node.defaults, **self.right}
            values_of_errors = [self._value(error.formula, values) for error in errors_found]
            self._by_source[source] = (
                self._carried_on(source, np.array(values_of_errors)) if values_of_errors else {}
            )
        return errors, self._by_source[source]

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
        """Values of the same unit that are taken for what is asked: what it is computed from, what else is asked."""
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

    def _value(self, formula: Formula, values: Mapping[str, Any]) -> np.ndarray:
        try:
            return self._column(formula(values))
        except (CourseworkError, ArithmeticError, ValueError, TypeError, NameError, KeyError):
            return np.full(self.count, np.nan)  # the error leads nowhere

    def _column(self, value: Any) -> np.ndarray:
        """Return a number, or one a variant, as a column ``(n,)``; NaN for whatever else."""
        real = _real(value, (self.count,) if self._is_batch else ())
        return np.broadcast_to(np.nan if real is None else real, (self.count,))

    @property
    def _is_batch(self) -> bool:
        return any(np.ndim(value) for value in self.given.values())


def _real(value: Any, shape: tuple[int, ...]) -> np.ndarray | None:
    """Return a real number, or an array of this shape; None for whatever else."""
    if isinstance(value, bool) or not isinstance(value, (int, float, np.generic, np.ndarray)):
        return None
    array = np.asarray(value)
    return array.astype(float) if array.dtype.kind in "iuf" and array.shape in ((), shape) else None
