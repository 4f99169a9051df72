"""Reference values in many digits, checked against independent equations.

The textbook formulas of a solution are computed in a hundred digits, of which they may lose some and be exact
still. That a formula is *right* no number of digits says. So what comes out is put into the equations that
the solution states besides: the loops and their two derivatives in time, and ``residual``. All must close to
forty digits.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from coursework.accuracy.followed import Followed, NotFollowed, of_many_digits
from coursework.accuracy.twins import Twinned
from coursework.course.exercise import CourseExercise
from coursework.errors import CourseworkError
from coursework.quantities.graph import Graph
from coursework.quantities.loops import Loop

DIGITS = 100
CLOSED = 1e-40  #: what equations may lack, in parts of their terms
CLOSED_IN_DOUBLES = 1e-11  #: the same for an equation that takes plain floats alone
_ROUNDED = 1e-15  #: what constants make that are rounded to doubles

_DOUBLES = " (doubles)"
_FAILURES = (CourseworkError, NotFollowed, TypeError, ValueError, ArithmeticError)


@dataclass(frozen=True)
class ClosureResidual:
    """Largest residual of values in independently stated equations, with the name of the equation; the first
    of those that do not close."""

    lack: float
    equation: str
    held: frozenset[str]  #: quantities that some equation holds
    in_doubles: bool = False  #: whether the equations could be followed in plain floats only

    @property
    def is_closed(self) -> bool:
        return self.lack <= (CLOSED_IN_DOUBLES if self.in_doubles else CLOSED)


class Reference:
    """Quantities of an exercise in many digits, one place at a time.

    ``lacking`` are those of the wanted whose formulas cannot be followed.
    """

    def __init__(self, exercise: CourseExercise, wanted: Sequence[str], digits: int = DIGITS) -> None:
        self.exercise = exercise
        self.arithmetic = of_many_digits(digits)
        self.mp = self.arithmetic.mp
        self.effects = exercise.spec.effects
        self.graph = twinned(exercise.solution.graph.textbook)
        self.asked = tuple(wanted)
        self.pinned: tuple[str, ...] = ()
        self.lacking: tuple[str, ...] = ()
        self._find_out()

    @cached_property
    def wanted(self) -> tuple[str, ...]:
        return tuple(n for n in self.asked if n not in self.lacking)

    # ------------------------------------------------------------------- values

    def at(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return the quantities as mpmath numbers; None for one that does not exist there."""
        try:
            values = self.numbers(given, self.wanted)
        except _FAILURES:  # of what is pinned
            values = {}
        return {n: self._number(values.get(n)) for n in self.wanted}

    def numbers(self, given: Mapping[str, Any], names: Sequence[str]) -> dict[str, Any]:
        """Return the quantities by name as followed numbers; those that do not exist are left out."""
        start = self._start(given)
        try:
            return self.graph.evaluate(names, start, self.effects)
        except _FAILURES:
            return self._one_by_one(start, names)

    def _one_by_one(self, start: Mapping[str, Any], names: Sequence[str]) -> dict[str, Any]:
        results: dict[str, Any] = {}
        for name in names:
            try:
                results |= self.graph.evaluate((name,), start, self.effects)
            except _FAILURES:
                continue
        return results

    def _start(self, given: Mapping[str, Any]) -> dict[str, Any]:
        known_values = {**self.exercise.intake.defaults, **given}
        known_values = {n: v for n, v in known_values.items() if n in self.exercise.quantity_names}
        if self.pinned:
            plain = {n: v if isinstance(v, str) else float(v) for n, v in known_values.items()}
            known_values |= self.exercise.solution.graph.evaluate(self.pinned, plain, self.effects)
        return {n: self._followed(v) for n, v in known_values.items()}

    def _followed(self, value: Any) -> Any:
        if hasattr(value, "context"):  # many digits already
            return Followed(value, self.arithmetic)
        if isinstance(value, (float, int, np.floating)) and not isinstance(value, bool):
            return Followed(self.mp.mpf(float(value)), self.arithmetic)
        return value

    def _number(self, value: Any) -> Any:
        value = value.value if isinstance(value, Followed) else value
        if isinstance(value, (int, float, np.floating)):
            value = self.mp.mpf(float(value))
        return value if hasattr(value, "context") and self.mp.isfinite(value) else None

    # ---------------------------------------------------------------- what lacks

    def _find_out(self) -> None:
        """Find the quantities pinned to their float values, being step functions, and those that cannot be
        followed."""
        given = {**self.exercise.intake.defaults, **self.exercise.variant(0).given}
        known_values = {n: v for n, v in given.items() if n in self.exercise.quantity_names}
        values: dict[str, Any] = {n: self._followed(v) for n, v in known_values.items()}
        lacking: set[str] = set()
        pinned = []
        for name in self.graph.plan(self.asked, known_values, self.effects):
            node = self.graph.node(name)
            if lacking & set(node.arguments):
                lacking.add(name)
                continue
            if name.startswith("_"):  # it shows in what takes it
                continue
            try:
                values |= self.graph.evaluate((name,), values, self.effects)
            except _FAILURES:
                if self._is_step(name, known_values):
                    pinned.append(name)
                    values[name] = self._followed(
                        self.exercise.solution.graph.evaluate((name,), known_values, self.effects)[name]
                    )
                else:
                    lacking.add(name)
        self.pinned = tuple(pinned)
        self.lacking = tuple(n for n in self.asked if n in lacking)

    def _is_step(self, name: str, values: Mapping[str, Any]) -> bool:
        """Return whether no small change of a datum changes a quantity."""
        graph = self.exercise.solution.graph
        try:
            value = graph.evaluate((name,), values, self.effects)[name]
            changed = [
                graph.evaluate((name,), {**values, n: v * (1 + 1e-9)}, self.effects)[name]
                for n, v in values.items()
                if isinstance(v, float)
            ]
        except _FAILURES:
            return False
        return all(np.array_equal(value, other) for other in changed)

    # ------------------------------------------------------------------ closing

    def closing(self, places: Iterable[Mapping[str, Any]]) -> ClosureResidual | None:
        """Return the residual of the values in the loops, their derivatives and ``residual`` at some places;
        None where the solution states no equation that can be followed."""
        lacks: dict[str, float] = {}
        for given in places:
            for name, lack in self.lacks(given).items():
                lacks[name] = max(lack, lacks.get(name, 0.0))
        if not lacks:
            return None
        in_doubles = any(name.endswith(_DOUBLES) or CLOSED < lack <= _ROUNDED for name, lack in lacks.items())
        open_ones = [name for name, lack in lacks.items() if not lack <= CLOSED_IN_DOUBLES]
        open_ones = open_ones or [n for n, lack in lacks.items() if lack > _ROUNDED and _DOUBLES not in n]
        # Of what does not close the first: what comes after may only follow from it.
        equation = open_ones[0] if open_ones else max(lacks, key=lambda name: lacks[name])
        worst = lacks[equation]
        in_doubles = in_doubles and not (worst > _ROUNDED and _DOUBLES not in equation)
        return ClosureResidual(worst, equation.removesuffix(_DOUBLES), self.held, in_doubles)

    def lacks(self, given: Mapping[str, Any]) -> dict[str, float]:
        """Return the residual of each stated equation, relative to its terms."""
        results = {}
        for name, loop in self.exercise.solution.loops.items():
            for order in range(loop.known + 1):
                if loop.moves(order) and (lack := self._of_loop(loop, order, given)) is not None:
                    results[name + ("", "_dot", "_ddot")[order]] = lack
        return results | self._of_residual(given)

    def _of_loop(self, loop: Loop, order: int, given: Mapping[str, Any]) -> float | None:
        rates = [r for pair in loop.rates.values() for r in pair[:order] if r]
        names = tuple(dict.fromkeys((*loop.names, *rates)))
        values = {n: self._number(v) for n, v in self.numbers(given, self._usable(names, given)).items()}
        start = self._start(given)
        values |= {n: self._number(start[n]) for n in names if n in start}
        if any(values.get(n) is None for n in names):
            return None
        terms = [t for link in loop.links for t in self._terms(link.vector, loop.rates, values, order)]
        size = sum(abs(t) for t in terms)
        return float(abs(sum(terms)) / size) if size else 0.0

    def _usable(self, names: Sequence[str], given: Mapping[str, Any]) -> tuple[str, ...]:
        return tuple(n for n in names if n in self.graph.names and n not in given)

    def _terms(
        self, v: Any, rates: Mapping[str, tuple[str, str]], values: Mapping[str, Any], order: int
    ) -> list[Any]:
        """Return the parts of a vector's derivative, complex."""
        mp = self.mp

        def rate(name: Any, k: int) -> Any:
            rate_name = rates.get(name, ("", ""))[k] if isinstance(name, str) else ""
            return values[rate_name] if rate_name else mp.zero

        def degrees(angle: Any) -> Any:
            return values[angle] if isinstance(angle, str) else mp.mpf(round(np.degrees(angle), 10))

        length = values[v.length] if isinstance(v.length, str) else mp.mpf(v.length)
        unit = v.sign * mp.expjpi((degrees(v.angle) + degrees(v.turn)) / 180)
        if order == 0:
            return [length * unit]
        slide, turn = rate(v.length, 0), rate(v.angle, 0)
        if order == 1:
            return [slide * unit, 1j * length * turn * unit]
        slide2, turn2 = rate(v.length, 1), rate(v.angle, 1)
        return [slide2 * unit, -length * turn**2 * unit, 2j * slide * turn * unit, 1j * length * turn2 * unit]

    def _of_residual(self, given: Mapping[str, Any]) -> dict[str, float]:
        if self._residual_graph is None:
            return {}
        ending = ""
        try:
            result = self._residual_graph.evaluate(("residual",), self._start(given), self.effects)[
                "residual"
            ]
        except _FAILURES:
            result, ending = self._residual_in_doubles(given), _DOUBLES
        parts = result if isinstance(result, tuple) else (result,)
        lacks = {}
        for i, part in enumerate(parts, 1):
            if (number := self._number(abs(part))) is not None:
                lacks[f"residual {i}{ending}"] = float(number)
        return lacks

    def _residual_in_doubles(self, given: Mapping[str, Any]) -> Any:
        """Return ``residual`` of the values rounded to doubles, for equations that require plain arrays."""
        known_values = {**self.exercise.intake.defaults, **given}
        known_values = {n: v for n, v in known_values.items() if n in self.exercise.quantity_names}
        rounded = {n: float(v) for n, v in self.at(given).items() if v is not None}
        try:
            graph = self.exercise.solution.residual_graph
            return graph.evaluate(("residual",), {**known_values, **rounded}, self.effects)["residual"]
        except _FAILURES:
            return ()

    @cached_property
    def _residual_graph(self) -> Graph | None:
        residual = self.exercise.solution.residual
        return None if residual is None else self.graph.with_functions({"residual": Twinned()(residual)})

    @cached_property
    def held(self) -> frozenset[str]:
        """Quantities that occur in some stated equation."""
        names = {n for loop in self.exercise.solution.loops.values() for n in loop.names}
        names |= {
            r for loop in self.exercise.solution.loops.values() for pair in loop.rates.values() for r in pair
        }
        if self._residual_graph is not None:
            names |= set(self._residual_graph.node("residual").arguments)
        return frozenset(names)


def twinned(graph: Graph) -> Graph:
    """Return the graph with the core's functions replaced by their twins."""
    return graph.mapped(Twinned())
