"""The ways to compute a mechanism's positions and rates that are compared.

Each takes angles of the driver in degrees, an array, and gives an array a quantity, in canonical units; NaN
where it has no answer.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coursework.accuracy.closure import Closure
from coursework.accuracy.study import Study
from coursework.course.exercise import CourseExercise

POSITION, RATE, MOTION = "position", "rate", "motion"
TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12)
STEPS = tuple(10.0**-k for k in range(1, 10))  #: of differences, in radians
NODES = 36  #: positions from which Newton's method and the solvers start
_FIRST_NODE = -175.0

Values = dict[str, Any]


@dataclass(frozen=True)
class Way:
    """One way: ``family`` and ``setting`` name it, ``share`` of the places it is timed on."""

    what: str
    family: str
    compute: Callable[[np.ndarray], Values]
    setting: float | None = None
    one_by_one: bool = False

    @property
    def name(self) -> str:
        return self.family if self.setting is None else f"{self.family}-{self.setting:g}"


def ways(exercise: CourseExercise, study: Study, given: Mapping[str, Any]) -> Iterator[Way]:
    """Every way that the study allows, for a mechanism whose driver is moved: ``given`` is all the rest."""
    bench = _Bench(exercise, study, given)
    if study.positions:
        yield from bench.positions()
    if study.rates:
        yield from bench.rates()


class _Bench:
    """One mechanism, to be computed in many ways."""

    def __init__(self, exercise: CourseExercise, study: Study, given: Mapping[str, Any]) -> None:
        self.exercise, self.study = exercise, study
        driver = exercise.spec.driver
        assert driver is not None  # a study without one is refused
        self.angle, self.speed = driver.angle, driver.speed
        self.given = given
        self.degrees = {n for n, unit in exercise.units.items() if unit == "deg"}
        self.closure = Closure(study.loops, study.unknowns) if study.loops else None

    # --------------------------------------------------------------- positions

    def positions(self) -> Iterator[Way]:
        wanted = self.study.positions
        yield Way(POSITION, "single", self._in_precision(np.float32, wanted))
        for nodes in (64, 512, 4096):
            if self.study.rates:
                yield Way(POSITION, "table", self._table(nodes), nodes)
        yield Way(POSITION, "stable", self._stable(wanted))
        yield Way(POSITION, "textbook", self._textbook(wanted))
        if np.finfo(np.longdouble).eps < np.finfo(float).eps:
            yield Way(POSITION, "extended", self._in_precision(np.longdouble, wanted))
        if self.closure is not None:
            for steps in (1, 2, 3, 4):
                yield Way(POSITION, "newton", self._newton(steps), steps)
            for tolerance in TOLERANCES:
                yield Way(POSITION, "fsolve", self._fsolve(tolerance), tolerance, one_by_one=True)
            for tolerance in TOLERANCES:
                yield Way(POSITION, "lm", self._root(tolerance), tolerance, one_by_one=True)
        yield Way(POSITION, "mpmath", self._many_digits(50, wanted), one_by_one=True)

    def _stable(self, wanted: Sequence[str]) -> Callable[[np.ndarray], Values]:
        return lambda angle: self.exercise.solve(**self.given, **{self.angle: angle}, only=wanted)

    def _textbook(self, wanted: Sequence[str]) -> Callable[[np.ndarray], Values]:
        graph = self.exercise.solution.graph.textbook
        return lambda angle: graph.evaluate(wanted, {**self.given, self.angle: angle})

    def _in_precision(self, kind: type, wanted: Sequence[str]) -> Callable[[np.ndarray], Values]:
        graph = self.exercise.solution.graph.textbook
        given = {n: kind(v) if isinstance(v, float) else v for n, v in self.given.items()}
        return lambda angle: graph.evaluate(wanted, {**given, self.angle: angle.astype(kind)})

    def _table(self, nodes: int) -> Callable[[np.ndarray], Values]:
        """Cubic Hermite interpolation over the turn, from values and slopes at equidistant nodes."""
        from scipy.interpolate import CubicHermiteSpline

        # Half a step off the quarters of the turn, where a rate may not exist, and one more at either end.
        at = -180.0 + (np.arange(nodes + 2) - 0.5) * (360.0 / nodes)
        wanted = (*self.study.positions, *self.study.rates)
        found = self._stable(wanted)(at)
        splines = {}
        for position, rate in zip(self.study.positions, self.study.rates, strict=True):
            value, slope = np.asarray(found[position]), np.asarray(found[rate]) / self.given[self.speed]
            if position in self.degrees:
                value = np.unwrap(value, period=360)
            else:
                slope = np.radians(slope)
            if np.isfinite(value).all() and np.isfinite(slope).all():
                splines[position] = CubicHermiteSpline(at, value, slope)
            else:
                splines[position] = lambda angle: np.full(
                    angle.shape, np.nan
                )  # no table of what does not exist

        def compute(angle: np.ndarray) -> Values:
            reduced = angle - 360 * np.rint(angle / 360)
            return {n: spline(reduced) for n, spline in splines.items()}

        return compute

    def _start(self, angle: np.ndarray) -> list[np.ndarray]:
        """The unknowns at the nearest of the nodes: what somebody knows who moves in steps."""
        nodes, found = self._nodes
        nearest = np.rint((angle - nodes[0]) / (360 / NODES)).astype(int) % NODES
        return [found[name][nearest] for name in self.study.unknowns]

    @property
    def _nodes(self) -> tuple[np.ndarray, Values]:
        if not hasattr(self, "_kept_nodes"):
            nodes = _FIRST_NODE + np.arange(NODES) * (360 / NODES)
            self._kept_nodes = nodes, self._in_radians(self._stable(self.study.unknowns)(nodes))
        return self._kept_nodes

    def _known(self, angle: Any) -> dict[str, Any]:
        known = {n: v for n, v in self.given.items() if isinstance(v, float)}
        return self._in_radians({**known, self.angle: angle})

    def _in_radians(self, values: Mapping[str, Any]) -> dict[str, Any]:
        return {n: v * (math.pi / 180) if n in self.degrees else v for n, v in values.items()}

    def _in_degrees(self, unknowns: Sequence[Any]) -> Values:
        named = zip(self.study.unknowns, unknowns, strict=True)
        return {n: np.asarray(v) * (180 / math.pi) if n in self.degrees else v for n, v in named}

    @property
    def _loops(self) -> Closure:
        """What the ways that need loops close: there are none without."""
        assert self.closure is not None
        return self.closure

    def _newton(self, steps: int) -> Callable[[np.ndarray], Values]:
        closure = self._loops

        def compute(angle: np.ndarray) -> Values:
            with np.errstate(all="ignore"):
                return self._in_degrees(closure.newton(self._known(angle), self._start(angle), steps))

        return compute

    def _one_by_one(self, solve: Callable[..., np.ndarray | None]) -> Callable[[np.ndarray], Values]:
        """A library's solver, which takes one configuration at a time."""
        closure = self._loops

        def compute(angle: np.ndarray) -> Values:
            starts = np.stack(self._start(angle), axis=-1)
            found = np.full(starts.shape, np.nan)
            constants = self._known(0.0)
            turned = np.radians(angle)
            for i in range(len(angle)):
                known = {**constants, self.angle: float(turned[i])}

                def gaps(x: np.ndarray, known: dict = known) -> list[float]:
                    values = {**known, **dict(zip(self.study.unknowns, map(float, x), strict=True))}
                    return closure.gaps(values, math.cos, math.sin)

                solved = solve(gaps, starts[i])
                if solved is not None:
                    found[i] = solved
            return self._in_degrees(list(found.T))

        return compute

    def _fsolve(self, tolerance: float) -> Callable[[np.ndarray], Values]:
        from scipy.optimize import fsolve

        def solve(gaps: Callable, start: np.ndarray) -> np.ndarray | None:
            found, _, status, _ = fsolve(gaps, start, xtol=tolerance, full_output=True)
            return found if status == 1 else None

        return self._one_by_one(solve)

    def _root(self, tolerance: float) -> Callable[[np.ndarray], Values]:
        from scipy.optimize import root

        def solve(gaps: Callable, start: np.ndarray) -> np.ndarray | None:
            found = root(gaps, start, method="lm", options={"xtol": tolerance, "ftol": tolerance})
            return found.x if found.success else None

        return self._one_by_one(solve)

    def _many_digits(self, digits: int, wanted: Sequence[str]) -> Callable[[np.ndarray], Values]:
        return lambda angle: exactly(self.exercise, self.given, self.angle, angle, wanted, digits)

    # ------------------------------------------------------------------- rates

    def rates(self) -> Iterator[Way]:
        wanted = self.study.rates
        yield Way(RATE, "stable", self._stable(wanted))
        yield Way(RATE, "textbook", self._textbook(wanted))
        if self.closure is not None:
            yield Way(RATE, "complex_step", self._complex_step())
        for step in STEPS:
            yield Way(RATE, "differences", self._differences(step), step)

    def _differences(self, step: float) -> Callable[[np.ndarray], Values]:
        """Central differences of the stable positions."""
        solve, speed = self._stable(self.study.positions), self.given[self.speed]
        width = math.degrees(step)

        def compute(angle: np.ndarray) -> Values:
            before, after = solve(angle - width), solve(angle + width)
            found = {}
            for position, rate in zip(self.study.positions, self.study.rates, strict=True):
                moved = after[position] - before[position]
                if position in self.degrees:
                    moved = np.radians(moved - 360 * np.rint(moved / 360))
                found[rate] = moved * (speed / (2 * step))
            return found

        return compute

    def _complex_step(self) -> Callable[[np.ndarray], Values]:
        """The imaginary part of the closed loops at an imaginary step: a derivative without a difference.

        The loops are closed at the angle itself, so that one step of Newton's method gives all of the first order; a
        second one would only bring in the rounding that the first one left.
        """
        rate_of = dict(zip(self.study.positions, self.study.rates, strict=True))
        solve, speed, step = self._stable(self.study.unknowns), self.given[self.speed], 1e-40
        closure = self._loops

        def compute(angle: np.ndarray) -> Values:
            closed = self._in_radians(solve(angle))
            known = self._known(angle)
            known[self.angle] = known[self.angle] + 1j * step
            with np.errstate(all="ignore"):
                start = [closed[n] + 0j for n in self.study.unknowns]
                found = closure.newton(known, start, 1)
            named = zip(self.study.unknowns, found, strict=True)
            return {rate_of[n]: np.imag(x) * (speed / step) for n, x in named}

        return compute


def exactly(
    exercise: CourseExercise,
    given: Mapping[str, Any],
    driver: str,
    angles: np.ndarray,
    wanted: Sequence[str],
    digits: int,
) -> dict[str, list[Any]]:
    """Quantities by the exercise's textbook formulas in ``digits`` decimal digits, one angle after another.

    At so many digits a formula may lose a dozen and be exact still.
    """
    import mpmath

    context = mpmath.MPContext()
    context.dps = digits
    graph = exercise.solution.graph.textbook
    fixed = {n: context.mpf(v) if isinstance(v, float) else v for n, v in given.items()}
    rows = [graph.evaluate(wanted, {**fixed, driver: context.mpf(float(angle))}) for angle in angles]
    return {name: [row[name] for row in rows] for name in wanted}
