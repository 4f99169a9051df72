"""Accuracy of motion in time: cost and error of a tolerance, a fixed step or a table.

One small interface: a *method* is a function of a scene, an effort, a duration and whether time is short,
that yields a :class:`MotionRun` for each of its settings. What stands in :data:`METHODS` is measured, with
friction and without.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from coursework.accuracy.study import Study
from coursework.accuracy.timing import Times, clock, times_of
from coursework.course.exercise import CourseExercise
from coursework.scenes.scenes import Scene
from coursework.scenes.staged import INERTIA

FRICTION = "friction"
FREE, RUBBING = "without friction", "with friction"
_RTOLS = tuple(10.0**-k for k in range(3, 13))
_ROUNDS = 3
_FINE = 800  #: equal steps where a table makes each of them cheap


class MotionRun(NamedTuple):
    """Motion by one method at one setting.

    ``end`` integrates it, each time anew, to where its driver stands at the end, degrees, not reduced, and
    how fast it turns there, rad/s; ``build`` is how many seconds were spent before.
    """

    method: str
    setting: float
    end: Callable[[], tuple[float, float]]
    build: float | None = None


@dataclass(frozen=True)
class MotionRow:
    """Measurement of a motion; ``error`` in radians of the driver at its end."""

    method: str
    setting: float
    place: str
    times: Times
    error: float
    build: float | None = None


Method = Callable[[Scene, float, float, bool], Iterator[MotionRun]]


def by_tolerance(scene: Scene, effort: float, duration: float, quick: bool) -> Iterator[MotionRun]:
    """Yield the scene's own integration at each relative tolerance."""
    driver = scene.driver
    # A quick look takes a few; with friction each digit costs so much that it stops halfway.
    rubs = FRICTION in scene.effects
    for rtol in _RTOLS[: 6 if rubs else 9 : 3] if quick else _RTOLS:

        def end(rtol: float = rtol) -> tuple[float, float]:
            # The state at the end is all that is compared.
            columns = scene.in_time(effort, duration, rtol=rtol, count=1).columns
            return float(columns[driver.angle][-1]), float(columns[driver.speed][-1])

        yield MotionRun("integration", rtol, end)


def by_steps(scene: Scene, effort: float, duration: float, quick: bool) -> Iterator[MotionRun]:
    """Yield the classical Runge-Kutta method at equal steps, with the mechanism computed anew at each of its
    four stages."""
    counts = (50, 100, 200, 400, 800)
    most = len(counts) if not quick else 2 if FRICTION in scene.effects else 3
    rate = _Acceleration(scene, effort)
    for steps in counts[:most]:
        yield MotionRun("steps", steps, partial(_ended, rate, duration, steps))


def by_table(scene: Scene, effort: float, duration: float, quick: bool) -> Iterator[MotionRun]:
    """Yield the Runge-Kutta method at fine steps, with coefficients from a table of the cycle by Fourier
    interpolation."""
    for nodes in (32, 64) if quick else (16, 32, 64, 128):
        start = clock()
        rate = _Tabulated(_Acceleration(scene, effort), nodes)
        build = clock() - start
        yield MotionRun("cycle_table", nodes, partial(_ended, rate, duration, _FINE), build)


def _ended(rate: Any, duration: float, steps: int) -> tuple[float, float]:
    angle, speed = runge_kutta(rate, rate.start, duration, steps)
    return float(np.degrees(angle)), float(speed)


METHODS: tuple[Method, ...] = (by_tolerance, by_steps, by_table)


def motion_rows(exercise: CourseExercise, study: Study, quick: bool) -> Iterator[MotionRow]:
    """Yield every method at each of its settings, in rounds.

    The reference is the energy integral without friction, and the tightest tolerance with it.
    """
    assert study.motion is not None
    motion = study.motion
    given = {**study.given, **motion.given}
    yield from _measured(
        _Exact(Scene(exercise, given, (INERTIA,)), motion.effort, motion.duration), FREE, quick
    )
    if FRICTION in exercise.solution.graph.effects():
        scene = Scene(exercise, given, (INERTIA, FRICTION))
        yield from _measured(_Tightest(scene, motion.effort, motion.duration, quick), RUBBING, quick)


def _measured(right: _Right, point: str, quick: bool) -> Iterator[MotionRow]:
    # What friction takes is not a function of the angle alone, and in no table.
    methods = [m for m in METHODS if point == FREE or m is not by_table]
    runs = [run for method in methods for run in method(right.scene, right.effort, right.duration, quick)]
    samples: list[list[float]] = [[] for _ in runs]
    ends = [(0.0, 0.0)] * len(runs)
    for _ in range(_ROUNDS):
        for i, run in enumerate(runs):
            start = clock()
            ends[i] = run.end()
            samples[i].append(clock() - start)
    for run, spent, end in zip(runs, samples, ends, strict=True):
        yield MotionRow(run.method, run.setting, point, times_of(spent), right.error(*end), run.build)


# --------------------------------------------------------------------------- right


class _Right:
    """Reference for the driver's position at the end of a motion."""

    def __init__(self, scene: Scene, effort: float, duration: float) -> None:
        self.scene, self.effort, self.duration = scene, effort, duration

    def error(self, angle: float, speed: float) -> float:
        raise NotImplementedError


class _Exact(_Right):
    """Reference by the energy integral: the delay at the end of a run, times its speed."""

    def __init__(self, scene: Scene, effort: float, duration: float) -> None:
        super().__init__(scene, effort, duration)
        self.integral = EnergyIntegral(scene, effort)
        self._there: tuple[float, Any] | None = None

    def error(self, angle: float, speed: float) -> float:
        if self._there is None:
            # The whole way is integrated once, to the end of the first run; the others end beside it.
            self._there = angle, self.integral.time(self.integral.start_angle, angle)
        last, spent = self._there
        late = spent + self.integral.time(last, angle) - self.duration
        return abs(speed * float(late))


class _Tightest(_Right):
    """Reference by the scene's own integration at a tolerance beyond the measured ones."""

    def __init__(self, scene: Scene, effort: float, duration: float, quick: bool) -> None:
        super().__init__(scene, effort, duration)
        self.rtol = 1e-9 if quick else 1e-13

    def error(self, angle: float, speed: float) -> float:
        return abs(float(np.radians(angle - self._angle)))

    @cached_property
    def _angle(self) -> float:
        table = self.scene.in_time(self.effort, self.duration, rtol=self.rtol, count=1)
        return float(table.columns[self.scene.driver.angle][-1])


class EnergyIntegral:
    """Time at which a mechanism of one degree of freedom reaches an angle under a constant effort, in many
    digits.

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
        given = _given(scene)
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
        """Return the seconds from one angle to another, in degrees, not reduced."""
        start, end = self._radians(start), self._radians(end)

        def slowness(angle: Any) -> Any:
            energy = self.energy + self.effort * (angle - self.start)
            return self.context.sqrt(self._inertia(angle) / (2 * energy))

        pieces = int(abs(end - start) / (self.context.pi / 4)) + 1
        points = self.context.linspace(start, end, pieces + 1)
        # Smooth: fewer points than tanh-sinh.
        return self.context.quad(slowness, points, method="gauss-legendre")

    def _radians(self, degrees: float) -> Any:
        return self.context.mpf(degrees) * self.context.pi / 180


def _given(scene: Scene) -> dict[str, Any]:
    exercise = scene.exercise
    known_values = {
        **exercise.intake.defaults,
        **{n: exercise.intake.value(n, v) for n, v in scene.given.items()},
    }
    return {n: v for n, v in known_values.items() if n in exercise.quantity_names}


# ------------------------------------------------------------------------- methods


class _Acceleration:
    """Driver's acceleration at an angle and a speed under a constant effort, from the exercise's own
    formulas.

    The effort is linear in the acceleration, so two evaluations suffice.
    """

    def __init__(self, scene: Scene, effort: float) -> None:
        self.driver, self.effects = scene.driver, scene.effects
        self.graph = scene.exercise.solution.graph
        self.effort = effort
        self.given = _given(scene)
        self.start = np.array([np.radians(self.given[self.driver.angle]), self.given[self.driver.speed]])

    def efforts(self, angles: Any, speeds: Any) -> tuple[Any, Any]:
        """Return the drive's effort at zero acceleration, and per unit of acceleration."""
        shape = np.broadcast_shapes(np.shape(angles), np.shape(speeds))
        given = {
            **self.given,
            self.driver.angle: np.broadcast_to(np.degrees(angles), shape)[..., None],
            self.driver.speed: np.broadcast_to(speeds, shape)[..., None],
            self.driver.acceleration: np.array([0.0, 1.0]),
        }
        result = self.graph.evaluate((self.driver.effort,), given, self.effects)[self.driver.effort]
        return result[..., 0], result[..., 1] - result[..., 0]

    def __call__(self, state: np.ndarray) -> np.ndarray:
        held, inertia = self.efforts(state[0], state[1])
        # Where friction acts, the effort bends in the acceleration: a secant or two set it right.
        result = (self.effort - held) / inertia
        return np.array([state[1], self._refined(state, result) if "friction" in self.effects else result])

    def _refined(self, state: np.ndarray, guess: float) -> float:
        for _ in range(4):
            at = np.array([guess, guess + 1e-3])
            given = {
                **self.given,
                self.driver.angle: np.full(2, np.degrees(state[0])),
                self.driver.speed: np.full(2, state[1]),
                self.driver.acceleration: at,
            }
            pull = self.graph.evaluate((self.driver.effort,), given, self.effects)[self.driver.effort]
            guess += (self.effort - pull[0]) / ((pull[1] - pull[0]) / 1e-3)
        return guess


class _Tabulated:
    """Driver's acceleration from tables over the cycle: inertia and the coefficient of the squared speed, as
    Fourier series."""

    def __init__(self, acceleration: _Acceleration, nodes: int) -> None:
        self.effort, self.start = acceleration.effort, acceleration.start
        at = np.arange(nodes) * (2 * np.pi / nodes)
        still, inertia = acceleration.efforts(at, 0.0)
        turning, _ = acceleration.efforts(at, 1.0)
        self.orders = np.fft.rfftfreq(nodes, 1 / nodes)
        rows = np.stack([still, turning - still, inertia])
        self.series = np.fft.rfft(rows, axis=-1) / nodes
        self.series[:, 1:] *= 2
        if nodes % 2 == 0:
            self.series[:, -1] /= 2

    def __call__(self, state: np.ndarray) -> np.ndarray:
        still, square, inertia = (self.series * np.exp(1j * self.orders * state[0])).real.sum(axis=-1)
        return np.array([state[1], (self.effort - still - square * state[1] ** 2) / inertia])


def runge_kutta(
    rate: Callable[[np.ndarray], np.ndarray], start: np.ndarray, duration: float, steps: int
) -> np.ndarray:
    """Integrate by the classical fourth-order method in ``steps`` equal steps; return the final state."""
    state, h = np.array(start, dtype=float), duration / steps
    for _ in range(steps):
        first = rate(state)
        second = rate(state + h / 2 * first)
        third = rate(state + h / 2 * second)
        fourth = rate(state + h * third)
        state = state + h / 6 * (first + 2 * second + 2 * third + fourth)
    return state
