"""Ways to compute the quantities of an exercise: functions of places, to be timed and compared.

A way takes the given values of many places as arrays, and gives an array a quantity, in canonical units; NaN
where it has no answer. Some need a mechanism that is fixed but for its driver: a table over the turn, a start
from which Newton's method sets out, a difference of two positions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from coursework.accuracy.closure import Closure
from coursework.accuracy.reference import Reference, twinned
from coursework.accuracy.subject import MOTION, POSITION, RATE, Places, Subject, one_by_one
from coursework.accuracy.timing import clock

__all__ = ["MOTION", "POSITION", "RATE", "ComputingMethod", "Values", "ways"]

TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12)
STEPS = tuple(10.0**-k for k in range(1, 10))  #: of differences, in radians
NODES = 36  #: positions from which Newton's method and the solvers start
_FIRST_NODE = -175.0

Values = dict[str, Any]


@dataclass(frozen=True)
class ComputingMethod:
    """Way to compute: ``family`` and ``setting`` name it. ``build`` is the preparation time in seconds."""

    what: str
    family: str
    compute: Callable[[Places], Values]
    setting: float | None = None
    one_by_one: bool = False
    build: float | None = None

    @property
    def name(self) -> str:
        return self.family if self.setting is None else f"{self.family}-{self.setting:g}"


def ways(subject: Subject, sort: str, fixed: Mapping[str, Any] | None) -> Iterator[ComputingMethod]:
    """Yield every way to the quantities of one kind; some only with a ``fixed`` mechanism, without its
    driver's angle."""
    bench = _Bench(subject, sort)
    if sort == POSITION:
        yield bench.in_precision("single", np.float32)
    if fixed is not None:
        yield from _tables(subject, sort, fixed)
    yield ComputingMethod(sort, "stable", bench.stable)
    yield ComputingMethod(sort, "textbook", bench.textbook)
    if np.finfo(np.longdouble).eps < np.finfo(float).eps:
        yield bench.in_precision("extended", np.longdouble)
    if fixed is not None:
        yield from _moved(subject, sort, fixed)
    yield ComputingMethod(sort, "mpmath", bench.many_digits, one_by_one=True)


class _Bench:
    """Formulas of one kind of quantity, in several precisions."""

    def __init__(self, subject: Subject, sort: str) -> None:
        self.subject, self.what, self.wanted = subject, sort, subject.quantities(sort)
        graph = subject.exercise.solution.graph
        self._stable, self._textbook = graph, twinned(graph.textbook)

    def stable(self, places: Places) -> Values:
        return self._stable.evaluate(self.wanted, places, self.subject.effects)

    def textbook(self, places: Places) -> Values:
        return self._textbook.evaluate(self.wanted, places, self.subject.effects)

    def in_precision(self, family: str, kind: type) -> ComputingMethod:
        def compute(places: Places) -> Values:
            given = {n: _cast(v, kind) for n, v in places.items()}
            return self._textbook.evaluate(self.wanted, given, self.subject.effects)

        return ComputingMethod(self.what, family, compute)

    @cached_property
    def _fifty(self) -> Reference:
        return Reference(self.subject.exercise, self.wanted, 50)

    def many_digits(self, places: Places) -> Values:
        rows = [self._fifty.at(point) for point in one_by_one(places)]
        return {name: [row[name] for row in rows] for name in self.wanted}


def _cast(value: Any, kind: type) -> Any:
    if isinstance(value, float):
        return kind(value)
    return value.astype(kind) if isinstance(value, np.ndarray) and value.dtype.kind == "f" else value


# ----------------------------------------------------------- with a fixed mechanism


def _tables(subject: Subject, sort: str, fixed: Mapping[str, Any]) -> Iterator[ComputingMethod]:
    if sort == POSITION and subject.rate_of and subject.speed:
        _Turning(subject, fixed).table(8)  # what is loaded for the first one is no cost of a table
        for nodes in (64, 512, 4096):
            start = clock()
            table = _Turning(subject, fixed).table(nodes)
            yield ComputingMethod(POSITION, "table", table, nodes, build=clock() - start)


def _moved(subject: Subject, sort: str, fixed: Mapping[str, Any]) -> Iterator[ComputingMethod]:
    turning = _Turning(subject, fixed)
    if sort == POSITION and subject.closure is not None:
        yield from turning.solvers()
    if sort == RATE and subject.rate_of and subject.speed:
        yield ComputingMethod(RATE, "complex_step", turning.complex_step())
        for step in STEPS:
            yield ComputingMethod(RATE, "differences", turning.differences(step), step)


class _Turning:
    """Mechanism that is fixed but for its driver's angle."""

    def __init__(self, subject: Subject, fixed: Mapping[str, Any]) -> None:
        self.subject = subject
        self.fixed = {n: v for n, v in fixed.items() if n != subject.driver}
        self.angle = subject.driver
        self.degrees = {n for n, unit in subject.exercise.units.items() if unit == "deg"}

    def _solve(self, wanted: Sequence[str], angle: np.ndarray) -> Values:
        given = {**self.fixed, self.angle: angle}
        return self.subject.exercise.solution.graph.evaluate(wanted, given, self.subject.effects)

    @property
    def _speed(self) -> float:
        return float(self.fixed[self.subject.speed])

    def table(self, nodes: int) -> Callable[[Places], Values]:
        """Return the cubic Hermite interpolation over the turn, from values and slopes at equidistant
        nodes."""
        from scipy.interpolate import CubicHermiteSpline

        # Half a step off the quarters of the turn, where a rate may not exist, and one more at either end.
        at = -180.0 + (np.arange(nodes + 2) - 0.5) * (360.0 / nodes)
        rates = self.subject.rate_of
        result = self._solve((*rates, *rates.values()), at)
        splines: dict[str, Callable[[np.ndarray], np.ndarray]] = {}
        for position, rate in rates.items():
            value = np.broadcast_to(result[position], at.shape)
            slope = np.broadcast_to(result[rate], at.shape) / self._speed
            if position in self.degrees:
                value = np.unwrap(value, period=360)
            else:
                slope = np.radians(slope)
            full = np.isfinite(value).all() and np.isfinite(slope).all()
            splines[position] = CubicHermiteSpline(at, value, slope) if full else _nothing

        def compute(places: Places) -> Values:
            angle = places[self.angle]
            reduced = angle - 360 * np.rint(angle / 360)
            return {n: spline(reduced) for n, spline in splines.items()}

        return compute

    # ------------------------------------------------------------------ solvers

    def solvers(self) -> Iterator[ComputingMethod]:
        for steps in (1, 2, 3, 4):
            yield ComputingMethod(POSITION, "newton", self._newton(steps), steps)
        for tolerance in TOLERANCES:
            yield ComputingMethod(POSITION, "fsolve", self._fsolve(tolerance), tolerance, one_by_one=True)
        for tolerance in TOLERANCES:
            yield ComputingMethod(POSITION, "lm", self._root(tolerance), tolerance, one_by_one=True)

    @property
    def _loops(self) -> Closure:
        """Closure of the loops, which this way requires."""
        assert self.subject.closure is not None
        return self.subject.closure

    def _start(self, angle: np.ndarray) -> list[np.ndarray]:
        """Return the unknowns at the nearest node, as in a stepwise motion."""
        nodes, result = self._nodes
        nearest = np.rint((angle - nodes[0]) / (360 / NODES)).astype(int) % NODES
        return [np.broadcast_to(result[name], nodes.shape)[nearest] for name in self.subject.unknowns]

    @cached_property
    def _nodes(self) -> tuple[np.ndarray, Values]:
        nodes = _FIRST_NODE + np.arange(NODES) * (360 / NODES)
        return nodes, self._in_radians(self._solve(self.subject.unknowns, nodes))

    def _known_values(self, angle: Any) -> dict[str, Any]:
        """Return the known values of the loops, computed constants of the mechanism included."""
        names = {n for loop in self.subject.exercise.solution.loops.values() for n in loop.names}
        computed = names - set(self.subject.unknowns) - set(self.fixed) - {self.angle}
        known_values = {n: v for n, v in self.fixed.items() if isinstance(v, float)}
        if computed:
            known_values |= self._solve(tuple(computed), np.zeros(()))
        return self._in_radians({**known_values, self.angle: angle})

    def _in_radians(self, values: Mapping[str, Any]) -> dict[str, Any]:
        return {n: v * (math.pi / 180) if n in self.degrees else v for n, v in values.items()}

    def _in_degrees(self, unknowns: Sequence[Any]) -> Values:
        named = zip(self.subject.unknowns, unknowns, strict=True)
        return {n: np.asarray(v) * (180 / math.pi) if n in self.degrees else v for n, v in named}

    def _newton(self, steps: int) -> Callable[[Places], Values]:
        closure = self._loops

        def compute(places: Places) -> Values:
            angle = places[self.angle]
            with np.errstate(all="ignore"):
                return self._in_degrees(closure.newton(self._known_values(angle), self._start(angle), steps))

        return compute

    def _one_by_one(self, solve: Callable[..., np.ndarray | None]) -> Callable[[Places], Values]:
        """Return a way by a library's solver, which takes one configuration at a time."""
        closure = self._loops

        def compute(places: Places) -> Values:
            angle = places[self.angle]
            starts = np.stack(self._start(angle), axis=-1)
            result = np.full(starts.shape, np.nan)
            constants = self._known_values(0.0)
            turned = np.radians(angle)
            for i in range(len(angle)):
                given = {**constants, self.angle: float(turned[i])}

                def gaps(x: np.ndarray, given: dict = given) -> list[float]:
                    values = {**given, **dict(zip(self.subject.unknowns, map(float, x), strict=True))}
                    return closure.gaps(values, math.cos, math.sin)

                if np.isfinite(starts[i]).all() and (solved := solve(gaps, starts[i])) is not None:
                    result[i] = solved
            return self._in_degrees(list(result.T))

        return compute

    def _fsolve(self, tolerance: float) -> Callable[[Places], Values]:
        from scipy.optimize import fsolve

        def solve(gaps: Callable, start: np.ndarray) -> np.ndarray | None:
            result, _, status, _ = fsolve(gaps, start, xtol=tolerance, full_output=True)
            return result if status == 1 else None

        return self._one_by_one(solve)

    def _root(self, tolerance: float) -> Callable[[Places], Values]:
        from scipy.optimize import root

        def solve(gaps: Callable, start: np.ndarray) -> np.ndarray | None:
            result = root(gaps, start, method="lm", options={"xtol": tolerance, "ftol": tolerance})
            return result.x if result.success else None

        return self._one_by_one(solve)

    # -------------------------------------------------------------------- rates

    def differences(self, step: float) -> Callable[[Places], Values]:
        """Return the way by central differences of the stable positions."""
        width, rates = math.degrees(step), self.subject.rate_of

        def compute(places: Places) -> Values:
            angle = places[self.angle]
            before, after = (self._solve(tuple(rates), angle + side * width) for side in (-1, 1))
            results = {}
            for position, rate in rates.items():
                moved = after[position] - before[position]
                if position in self.degrees:
                    moved = np.radians(moved - 360 * np.rint(moved / 360))
                results[rate] = moved * (self._speed / (2 * step))
            return results

        return compute

    def complex_step(self) -> Callable[[Places], Values]:
        """Return the way by the complex step: the imaginary part of the closed loops at an imaginary step.

        The loops are closed at the angle itself, so that one step of Newton's method gives all of the first
        order; a second one would only bring in the rounding that the first one left.
        """
        rates, step, closure = self.subject.rate_of, 1e-40, self._loops

        def compute(places: Places) -> Values:
            angle = places[self.angle]
            closed = self._in_radians(self._solve(self.subject.unknowns, angle))
            values = self._known_values(angle)
            values[self.angle] = values[self.angle] + 1j * step
            with np.errstate(all="ignore"):
                start = [closed[n] + 0j for n in self.subject.unknowns]
                result = closure.newton(values, start, 1)
            named = zip(self.subject.unknowns, result, strict=True)
            return {rates[n]: np.imag(x) * (self._speed / step) for n, x in named}

        return compute


def _nothing(angle: np.ndarray) -> np.ndarray:
    """Return NaN: there is no table of a quantity that does not exist all turn."""
    return np.full(np.shape(angle), np.nan)
