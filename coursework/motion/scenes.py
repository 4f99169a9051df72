"""Scenes: an exercise's mechanism, its data, and the effects that the scene calls for.

A scene that calls for less runs less: its columns are the quantities of the effects named, and
the quantity graph evaluates what those need and nothing else.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, Undefined, WrongValue, counted, unknown
from coursework.model import Driver

#: Kinematic effects, and the units of what each shows.
LEVELS: Mapping[str, tuple[str, ...]] = {
    "position": ("mm", "deg", "mm^2"),
    "velocity": ("mm/s", "rad/s"),
    "acceleration": ("mm/s^2", "rad/s^2"),
    "coriolis": (),
}
CORIOLIS = "a_coriolis"
EFFORTS = ("N", "N*m")
INERTIA, FRICTION = "inertia", "friction"
ROUNDING = 1e-13  #: of a term: some 450 units in its last place
_CORRECTIONS = 60  #: of an acceleration, at most


@dataclass(frozen=True)
class Table:
    """Columns of equal length, with their units."""

    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    evaluated: tuple[str, ...]  #: the quantities that the scene evaluated, in order
    notes: tuple[str, ...] = ()
    balance: float = math.nan  #: largest energy balance error over the energy exchanged; for motions in time

    def rows(self) -> list[dict[str, Any]]:
        """A row an instant, headers with units, empty where the mechanism does not close."""
        heads = [f"{name} [{self.units[name]}]" for name in self.columns]
        values = zip(*(c.tolist() for c in self.columns.values()), strict=True)
        return [{h: "" if v != v else v for h, v in zip(heads, row, strict=True)} for row in values]


@dataclass(frozen=True)
class Scene:
    """One mechanism with its data and the effects called for.

    ``effects`` are kinematic (``position``, ``velocity``, ``acceleration``, ``coriolis``) or the
    exercise's own (``load``, ``gravity``, ``inertia``, ``friction``). Without any, positions alone.
    """

    exercise: CourseExercise
    given: Mapping[str, Any]
    effects: tuple[str, ...] = ()
    _own: tuple[str, ...] = field(init=False, default=())

    def __post_init__(self) -> None:
        own = self.exercise.solution.graph.effects()
        for effect in self.effects:
            if effect not in LEVELS and effect not in own:
                raise unknown("effect", effect, [*LEVELS, *own], self.exercise.name)
        object.__setattr__(self, "_own", tuple(e for e in self.effects if e in own))
        if "coriolis" in self.effects and CORIOLIS not in self.exercise.solution.graph.quantities:
            raise WrongValue(f"{self.exercise.name} has no Coriolis term: no block slides on a turning body")

    @property
    def driver(self) -> Driver:
        """What drives the mechanism.

        Raises
        ------
        BadCourse
            The exercise names none.
        """
        driver = self.exercise.spec.driver
        if driver is None:
            raise BadCourse(f"{self.exercise.name} names no driver=Driver(…), so it cannot be simulated")
        return driver

    @property
    def quantities(self) -> tuple[str, ...]:
        """What the scene shows: the parts' quantities that move with the driver, of the effects called."""
        levels = [e for e in self.effects if e in LEVELS]
        if not self.effects:
            levels = ["position"]
        wanted = [LEVELS[level] for level in levels] + ([EFFORTS] if self._own else [])
        moving = self._moving()
        asked = {p.quantity: p.unit for p in self.exercise.spec.parts if p.sort.is_number}
        shown: list[str] = []
        for units in wanted:
            # An exercise on forces asks no position, yet has them.
            shown += _of_units(asked, units, moving) or _of_units(self.exercise.solution.units, units, moving)
        if "coriolis" in levels:
            shown.append(CORIOLIS)
        if not shown:
            raise WrongValue(
                f"{self.exercise.name}: nothing to show for the effects {', '.join(self.effects)}"
            )
        return tuple(n for n in dict.fromkeys(shown) if n != self.driver.angle)

    @cached_property
    def _accepted(self) -> dict[str, Any]:
        """The given values in canonical units."""
        return {n: self.exercise.intake.value(n, v) for n, v in self.given.items()}

    def _driven(self, angle: Any) -> dict[str, Any]:
        """The given values with the driver at an angle."""
        return {**self.given, **self.exercise.posed(self._accepted, angle)}

    def _moving(self) -> frozenset[str]:
        driver, graph = self.driver, self.exercise.solution.graph
        names = {n for n in (driver.angle, driver.speed, driver.acceleration) if n}
        if driver.poses is not None:
            names = names - {driver.angle} | self.exercise.posed(self._accepted, 0.0).keys()
        return graph.descendants(names)

    def over_cycle(self, count: int = 360) -> Table:
        """The scene over one turn of the driver, ``count`` equal steps and the end.

        Angles are whole multiples of the step, never accumulated.
        """
        if count < 1:
            raise WrongValue(f"a cycle has at least one step; found {count}")
        angle = np.arange(count + 1) * 360.0 / count
        driver = self.driver.angle
        found = self.exercise.solve(**self._driven(angle), only=self.quantities, effects=self._own)
        columns = {driver: angle, **{n: np.broadcast_to(v, angle.shape) for n, v in found.items()}}
        open_somewhere = int(np.logical_or.reduce([np.isnan(column) for column in columns.values()]).sum())
        notes = (
            (f"the mechanism does not close at {open_somewhere} of {count + 1} angles",)
            if open_somewhere
            else ()
        )
        return Table(columns, self._units(columns), self._evaluated(), notes)

    def in_time(self, effort: float, duration: float, *, rtol: float = 1e-9, count: int = 500) -> Table:
        """The motion from the given position and speed under a constant effort of the driver.

        One degree of freedom: the driver's acceleration follows from the effort that the scene asks of
        the drive, M(angle) · acceleration + the rest. Every position is computed from the driver's
        angle by the closed form, so that nothing drifts apart. Dead centres of the driver's
        ``output`` are found in the dense solution and are rows of the table, marked in ``dead_centre``.

        ``balance`` compares the kinetic energy with the work done, relative to the energy exchanged:
        the two come from different terms of the effort.

        Raises
        ------
        WrongValue
            The scene calls for no inertia, or a duration that is not positive.
        Undefined
            The motion reaches a place where the mechanism does not close or jams.
        """
        from scipy.integrate import solve_ivp

        if INERTIA not in self._own:
            raise WrongValue(
                "a motion in time needs the effect 'inertia': without mass nothing moves in time"
            )
        if not duration > 0 or not math.isfinite(duration):
            raise WrongValue(f"a duration is a positive number of seconds; found {duration}")
        motion = _Motion(self, effort)
        start = [math.radians(motion.start_angle), motion.start_speed, 0.0]
        solved = solve_ivp(
            motion.derivative,
            (0.0, duration),
            start,
            method="DOP853",
            rtol=rtol,
            atol=[rtol, rtol * max(1.0, abs(start[1])), rtol * motion.energy_scale(duration)],
            dense_output=True,
            events=[motion.output_rate] if self.driver.output else None,
        )
        if not solved.success:
            raise Undefined(f"the motion stops at t = {solved.t[-1]:.6g} s: {solved.message}")
        dead = solved.t_events[0] if solved.t_events else np.empty(0)
        t = np.union1d(np.arange(count + 1) * duration / count, dead)
        angle, speed, work = solved.sol(t)
        return motion.table(t, angle, speed, work, np.isin(t, dead))

    def _evaluated(self) -> tuple[str, ...]:
        graph = self.exercise.solution.graph
        names = {**self.exercise.intake.defaults, **self._driven(0.0)}
        plan = graph.plan(self.quantities, frozenset(names) & self.exercise.quantity_names, self._own)
        return tuple(name for name in plan if not name.startswith("_"))  # a hidden one is the solution's own

    def _units(self, names: Sequence[str] | Mapping[str, Any]) -> dict[str, str]:
        known = {"t": "s", **self.exercise.units}
        return {n: known.get(n, "1") for n in names}


def _of_units(quantities: Mapping[str, str], units: Sequence[str], moving: frozenset[str]) -> list[str]:
    return [name for name, unit in quantities.items() if name in moving and unit in units]


class _Motion:
    """The equation of motion of a scene: effort(angle, speed, acceleration) = the drive's."""

    def __init__(self, scene: Scene, drive: float):
        self.scene = scene
        self.drive = drive
        driver = scene.driver
        if not driver.effort:
            raise BadCourse(
                f"{scene.exercise.name} names no effort of its driver, so nothing can drive it in time"
            )
        self.driver = driver
        self.graph = scene.exercise.solution.graph
        accepted = {n: scene.exercise.intake.value(n, v) for n, v in scene.given.items()}
        values = {**scene.exercise.intake.defaults, **accepted}
        self.fixed = {n: v for n, v in values.items() if n in scene.exercise.quantity_names}
        try:
            self.start_angle, self.start_speed = float(values[driver.angle]), float(values[driver.speed])
        except KeyError as fault:
            raise WrongValue(
                f"a motion starts from {driver.angle} and {driver.speed}; {fault} is not given"
            ) from None
        self.frictionless = tuple(e for e in scene._own if e != FRICTION)

    def _at(self, angle: float, speed: float, acceleration: float) -> dict[str, Any]:
        motion = {self.driver.angle: math.degrees(angle), self.driver.speed: speed}
        return {**self.fixed, **motion, self.driver.acceleration: acceleration}

    def effort(self, angle: float, speed: float, acceleration: float, effects: tuple[str, ...]) -> float:
        """What the drive must supply."""
        name = self.driver.effort
        return float(self.graph.evaluate((name,), self._at(angle, speed, acceleration), effects)[name])

    def inertia(self, angle: float) -> float:
        """Generalised inertia: effort per acceleration, at rest."""
        return self.effort(angle, 0.0, 1.0, (INERTIA,)) - self.effort(angle, 0.0, 0.0, (INERTIA,))

    def acceleration(self, angle: float, speed: float) -> float:
        """The acceleration at which the effort asked is the drive's.

        Without friction the effort is affine in it; with little friction nearly so, and a few corrections by the
        frictionless inertia do. Where they lead away, friction being strong, the effort's own slope corrects: the
        effort is affine on either side of the acceleration at which the guide's other side bears.

        Raises
        ------
        Undefined
            What is lacking stays: no acceleration balances the drive.
        """
        inertia = self.inertia(angle)
        for slope in (lambda value: inertia, lambda value: self._slope(angle, speed, value)):
            value = self._balanced(angle, speed, inertia, slope)
            if value is not None:
                return value
        raise Undefined(
            f"no acceleration balances the drive at {math.degrees(angle):.4g} degrees: the guide jams"
        )

    def _balanced(
        self, angle: float, speed: float, inertia: float, slope: Callable[[float], float]
    ) -> float | None:
        """The acceleration to which corrections by a slope lead, if they lead to one.

        They end where what is lacking is nothing beside the drive and the inertia, or, where these are small beside
        terms of the effort that cancel, where it no longer shrinks and is within the rounding of those terms.
        """
        value, least = 0.0, math.inf
        for _ in range(_CORRECTIONS):
            lacking, per = self.drive - self.effort(angle, speed, value, self.scene._own), slope(value)
            if not per:
                return None
            value += lacking / per
            if abs(lacking) <= ROUNDING * (abs(self.drive) + abs(value) * inertia):
                return value
            if abs(lacking) >= least and abs(lacking) <= self.rounding(angle, speed, value):
                return value
            least = min(least, abs(lacking))
        return None

    def _slope(self, angle: float, speed: float, acceleration: float) -> float:
        """Effort per acceleration, by a step that leaves half of the digits."""
        step = 1e-8 * max(1.0, abs(acceleration))
        near, far = (self.effort(angle, speed, acceleration + by, self.scene._own) for by in (0.0, step))
        return (far - near) / step

    def rounding(self, angle: float, speed: float, acceleration: float) -> float:
        """How far rounding may put the effort off, by the size of the terms that it is made of.

        A quantity x has a part |x d(effort)/dx| in them, whether or not the parts cancel: the effort changes by
        that much, times ``ROUNDING``, when x does by ``ROUNDING`` of itself.
        """
        name, own = self.driver.effort, self.scene._own
        at = self._at(angle, speed, acceleration)
        effort = self.effort(angle, speed, acceleration, own)
        changed = ({**at, n: v * (1 + ROUNDING)} for n, v in at.items() if isinstance(v, float))
        return sum(abs(float(self.graph.evaluate((name,), one, own)[name]) - effort) for one in changed)

    def derivative(self, t: float, state: Sequence[float]) -> list[float]:
        """Speed, acceleration, and the power that goes into kinetic energy."""
        angle, speed, _ = state
        acceleration = self.acceleration(angle, speed)
        static = self.effort(angle, 0.0, 0.0, self.frictionless)
        rubbing = 0.0
        if FRICTION in self.scene._own:
            rubbing = self.effort(angle, speed, acceleration, self.scene._own) - self.effort(
                angle, speed, acceleration, self.frictionless
            )
        return [speed, acceleration, (self.drive - static - rubbing) * speed]

    def output_rate(self, t: float, state: Sequence[float]) -> float:
        """Rate of the output per unit of the driver's speed: 0 at a dead centre."""
        name = self.driver.output
        return float(self.graph.evaluate((name,), self._at(state[0], 1.0, 0.0))[name])

    def energy_scale(self, duration: float) -> float:
        """An energy to measure errors by: what the scene starts with and what the drive could do."""
        kinetic = 0.5 * self.inertia(math.radians(self.start_angle)) * self.start_speed**2
        return kinetic + abs(self.drive * self.start_speed) * duration + 1e-12

    def table(
        self, t: np.ndarray, angle: np.ndarray, speed: np.ndarray, work: np.ndarray, dead: np.ndarray
    ) -> Table:
        driver, scene = self.driver, self.scene
        accelerations = np.array([self.acceleration(a, w) for a, w in zip(angle, speed, strict=True)])
        motion = {driver.angle: np.degrees(angle), driver.speed: speed, driver.acceleration: accelerations}
        shown = tuple(n for n in scene.quantities if n != driver.effort)
        found = scene.exercise.solve(**{**scene.given, **motion}, only=shown, effects=scene._own)
        columns = {"t": t, **motion, **{n: np.broadcast_to(v, t.shape) for n, v in found.items()}}
        columns["dead_centre"] = dead.astype(float)
        kinetic = np.array([0.5 * self.inertia(a) * w**2 for a, w in zip(angle, speed, strict=True)])
        exchanged = max(float(np.ptp(kinetic)), float(np.ptp(work)), 1e-300)
        balance = float(np.max(np.abs(kinetic - kinetic[0] - work))) / exchanged
        notes = (
            f"energy balance: {balance:.1e} of the energy exchanged",
            counted(int(dead.sum()), "dead centre"),
        )
        return Table(columns, scene._units(columns), scene._evaluated(), notes, balance)
