"""Time and error of every way, here and now."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from coursework.accuracy.study import Motion, Study
from coursework.accuracy.ways import MOTION, Values, exactly, ways
from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, BadInput
from coursework.motion.scenes import INERTIA, Scene
from coursework.system.distribution import DISTRIBUTION

GENERIC, HARD = "generic", "hard"
_DIGITS = 70  #: of the reference
_RTOLS = tuple(10.0**-k for k in range(3, 13))


@dataclass(frozen=True)
class Row:
    """One way at one kind of place.

    ``max_error`` is the largest, over places and quantities, against the reference: radians for angles, parts of
    the longest length for lengths, parts of the driver's speed (times that length) for rates, of the value itself where it is larger; for motions in
    time, radians of the driver after the whole motion. ``failed`` of the ``n`` places have no answer, and
    do not count; None when none has one.
    """

    exercise: str
    what: str
    method: str
    place: str
    ns_per_configuration: float
    max_error: float | None
    n: int
    failed: int
    family: str
    setting: float | None

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


def study_of(exercise: CourseExercise) -> Study | None:
    """What the exercise's solution states, or None."""
    found = exercise.folder.module("solutions", exercise.name)
    study = getattr(found, "ACCURACY", None) if exercise.solution else None
    if study is not None and exercise.spec.driver is None:
        raise BadCourse(f"{exercise.name} states ACCURACY but no driver=Driver(…) to move it by")
    return study


def measure(exercise: CourseExercise, *, quick: bool = False) -> Iterator[Row]:
    """Rows as they are measured.

    Raises
    ------
    BadInput
        The exercise's solution states no study, or mpmath is not installed.
    """
    try:
        import mpmath  # noqa: F401
    except ImportError:
        raise BadInput(
            "accuracy is measured against mpmath, which is not installed: "
            f"pip install '{DISTRIBUTION}[accuracy]'"
        ) from None
    study = study_of(exercise)
    if study is None:
        raise BadInput(
            f"{exercise.folder.source('solutions', exercise.name)} states no ACCURACY = Study(…): nothing to measure"
        )
    for place in (GENERIC, HARD):
        if study.positions and (place == GENERIC or study.hard):
            yield from _Trial(exercise, study, place, quick).rows()
    if study.motion is not None:
        yield from _motion_rows(exercise, study, study.motion, quick)


class _Trial:
    """One mechanism at one kind of place: the angles to time on, and those that are compared."""

    def __init__(self, exercise: CourseExercise, study: Study, place: str, quick: bool) -> None:
        self.exercise, self.study, self.place, self.quick = exercise, study, place, quick
        driver = exercise.spec.driver
        assert driver is not None  # a study without one is refused
        self.driver, self.speed = driver.angle, driver.speed
        given = {**study.given, **(study.hard if place == HARD else {})}
        count = 10_000
        if place == HARD:
            self.compared = np.asarray(given.pop(self.driver), dtype=float)
            self.timed = np.resize(self.compared, count)
        else:
            self.timed = np.random.default_rng(1).uniform(-180.0, 180.0, count)
            self.compared = self.timed[: 60 if quick else 400]
        given = {**exercise.intake.defaults, **given}
        self.given = {
            n: v if isinstance(v, str) else float(v)
            for n, v in given.items()
            if n in exercise.quantity_names and n != self.driver
        }
        self.size = max(
            v for n, v in self.given.items() if exercise.units.get(n) == "mm" and isinstance(v, float)
        )

    def rows(self) -> Iterator[Row]:
        wanted = (*self.study.positions, *self.study.rates)
        reference = exactly(self.exercise, self.given, self.driver, self.compared, wanted, _DIGITS)
        for way in ways(self.exercise, self.study, self.given):
            compared, timed = self.compared, self.timed
            if way.one_by_one:
                compared = compared[: 20 if self.quick else 200]
                timed = compared[:10] if self.quick else compared[:50]
            found = way.compute(compared)
            error, failed = self._error(found, reference, len(compared))
            seconds = best_time(partial(way.compute, timed), 0.004 if self.quick else 0.1)
            yield Row(
                self.exercise.name, way.what, way.name, self.place, 1e9 * seconds / len(timed), error,
                len(compared), failed, way.family, way.setting,
            )  # fmt: skip

    def _error(
        self, found: Values, reference: Mapping[str, Sequence], count: int
    ) -> tuple[float | None, int]:
        errors = np.zeros(count)
        for name, values in found.items():
            scale = self._scale(self.exercise.units.get(name, "1"))
            whole = 360 if self.exercise.units.get(name) == "deg" else None
            right = reference[name]
            values = values if isinstance(values, list) else np.broadcast_to(values, (count,))
            own = [
                _difference(v, r, whole) / _size(r, scale, whole) for v, r in zip(values, right, strict=False)
            ]
            errors = np.maximum(errors, own)
        answered = np.isfinite(errors)
        largest = float(errors[answered].max()) if answered.any() else None
        return largest, int(count - answered.sum())

    def _scale(self, unit: str) -> float:
        """What an error is counted in."""
        speed = abs(float(self.given.get(self.speed, 1.0)))
        return {
            "deg": math.degrees(1.0),
            "mm": self.size,
            "rad/s": speed,
            "mm/s": speed * self.size,
        }[unit]


def _size(reference: Any, scale: float, whole: int | None) -> float:
    """What the error of one value is counted in: itself, where it exceeds the usual scale."""
    return scale if whole else max(scale, float(abs(reference)))


def _difference(value: Any, reference: Any, whole: int | None) -> float:
    """|value - reference|, modulo a whole turn where there is one; NaN where there is no value."""
    context = reference.context
    if not hasattr(value, "context"):
        near = float(value)
        if not math.isfinite(near):
            return math.nan
        value = context.mpf(near) + context.mpf(float(value - type(value)(near)))
    apart = context.mpf(value) - reference
    if whole:
        apart -= whole * context.nint(apart / whole)
    return float(abs(apart))


def best_time(call: Callable[[], Any], at_least: float) -> float:
    """Seconds that a call takes: the best of three rounds, each of at least so many seconds; a call that is
    longer than all three is timed once."""
    start = time.perf_counter()
    call()
    once = max(time.perf_counter() - start, 1e-9)
    if once > 3 * at_least:
        return once
    repeats = max(1, math.ceil(at_least / once))
    best = math.inf
    for _ in range(3):
        start = time.perf_counter()
        for _ in range(repeats):
            call()
        best = min(best, (time.perf_counter() - start) / repeats)
    return best


# ---------------------------------------------------------------------- motion


def _motion_rows(exercise: CourseExercise, study: Study, motion: Motion, quick: bool) -> Iterator[Row]:
    """Integration in time at each tolerance, against the energy integral."""
    scene = Scene(exercise, {**study.given, **motion.given}, (INERTIA,))
    driver, runs = scene.driver, []
    for rtol in _RTOLS[:: 3 if quick else 1]:
        start = time.perf_counter()
        # The state at the end is all that is compared.
        table = scene.in_time(motion.effort, motion.duration, rtol=rtol, count=1)
        seconds = time.perf_counter() - start
        runs.append((rtol, seconds, table.columns[driver.angle][-1], table.columns[driver.speed][-1]))
    exact = _EnergyIntegral(scene, motion.effort)
    # The whole way is integrated once, to the end of the last run; the others end beside it.
    last = runs[-1][2]
    there = exact.time(exact.start_angle, last)
    for rtol, seconds, angle, speed in runs:
        late = there + exact.time(last, angle) - motion.duration
        yield Row(
            exercise.name, MOTION, f"integration-{rtol:g}", GENERIC, 1e9 * seconds, abs(speed * float(late)),
            1, 0, "integration", rtol,
        )  # fmt: skip


class _EnergyIntegral:
    """When a mechanism of one degree of freedom reaches an angle under a constant effort: many digits.

    Its kinetic energy grows by the work of the drive, and is half the generalised inertia times the speed
    squared: so t = integral of sqrt(I / (2 E)) over the angle, piece by piece of the turn.
    """

    def __init__(self, scene: Scene, effort: float) -> None:
        import mpmath

        self.context = mpmath.MPContext()
        self.context.dps = 20
        self.driver = scene.driver
        self.graph = scene.exercise.solution.graph.textbook
        mpf = self.context.mpf
        given = {
            **scene.exercise.intake.defaults,
            **{n: scene.exercise.intake.value(n, v) for n, v in scene.given.items()},
        }
        given = {n: v for n, v in given.items() if n in scene.exercise.quantity_names}
        self.start_angle = given.pop(self.driver.angle)
        self.start = self._radians(self.start_angle)
        self.speed, self.effort = mpf(given.pop(self.driver.speed)), mpf(effort)
        given.pop(self.driver.acceleration, None)
        self.fixed = {n: mpf(v) if isinstance(v, float) else v for n, v in given.items()}
        self.energy = self._inertia(self.start) * self.speed**2 / 2

    def _inertia(self, angle: Any) -> Any:
        at = {self.driver.angle: self.context.degrees(angle), self.driver.speed: self.context.mpf(0)}
        pulls = [
            self.graph.evaluate(
                (self.driver.effort,),
                {**self.fixed, **at, self.driver.acceleration: self.context.mpf(a)},
                (INERTIA,),
            )[self.driver.effort]
            for a in (0, 1)
        ]
        return pulls[1] - pulls[0]

    def time(self, start: float, end: float) -> Any:
        """Seconds from one angle to another, in degrees and not reduced."""
        start, end = self._radians(start), self._radians(end)

        def slowness(angle: Any) -> Any:
            energy = self.energy + self.effort * (angle - self.start)
            return self.context.sqrt(self._inertia(angle) / (2 * energy))

        pieces = int(abs(end - start) / (self.context.pi / 4)) + 1
        return self.context.quad(slowness, self.context.linspace(start, end, pieces + 1))

    def _radians(self, degrees: float) -> Any:
        return self.context.mpf(degrees) * self.context.pi / 180
