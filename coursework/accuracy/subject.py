"""Subject of a measurement: everything that follows from an exercise and its solution.

Which quantities are positions, rates, accelerations follows from the loops and their derivatives, else from
units; the generic mechanism is the exercise's first variant, its driver turned through a whole turn, or where
nothing is driven the first variants one after another. A ``Study`` in the solution adds what does not follow.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from coursework.accuracy.closure import Closure
from coursework.accuracy.hard_places import HardPlace, Terrain, hard_places
from coursework.accuracy.reference import Reference
from coursework.accuracy.study import Study
from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, NoSolution

POSITION, RATE, ACCELERATION, OTHER, MOTION = "position", "rate", "acceleration", "other", "motion"
WHATS = (POSITION, RATE, ACCELERATION, OTHER)
_OF_UNITS = {
    "deg": POSITION,
    "mm": POSITION,
    "rad": POSITION,
    "rad/s": RATE,
    "mm/s": RATE,
    "rad/s^2": ACCELERATION,
    "mm/s^2": ACCELERATION,
}

Places = dict[str, Any]  #: given values: arrays of one shape, texts


def numbers_of(exercise: CourseExercise) -> tuple[str, ...]:
    """Return the requested quantities that are numbers with digits; none without a solution."""
    try:
        known_names = exercise.quantity_names
    except NoSolution:
        return ()
    requested = (p.quantity for p in exercise.spec.parts if p.kind in ("number", "angle"))
    return tuple(n for n in dict.fromkeys(requested) if n in known_names)


def study_of(exercise: CourseExercise) -> Study:
    """Return the solution's ``ACCURACY``; an empty study without one."""
    stated = getattr(exercise.folder.module("solutions", exercise.name), "ACCURACY", None)
    if stated is not None and not isinstance(stated, Study):
        raise BadCourse(f"{exercise.solution.source}: ACCURACY is a Study(…); found {str(stated)[:60]}")
    return stated or Study()


class Subject:
    """Exercise to be computed in many ways."""

    def __init__(self, exercise: CourseExercise) -> None:
        self.exercise = exercise
        self.study = study_of(exercise)
        self.effects = exercise.spec.effects
        self.numbers = numbers_of(exercise)

    # ------------------------------------------------------------------ quantities

    @cached_property
    def reference(self) -> Reference:
        return Reference(self.exercise, self.wanted)

    @cached_property
    def wanted(self) -> tuple[str, ...]:
        """All computed quantities: the requested ones, and the unknowns of the loops with their rates."""
        return tuple(dict.fromkeys((*self.numbers, *self.unknowns, *self.rate_of.values())))

    @cached_property
    def _terrain(self) -> Terrain:
        return Terrain(self.exercise, self.numbers)

    @property
    def unknowns(self) -> tuple[str, ...]:
        """Unknowns of the loops; none where the loops do not determine them."""
        return self._terrain.unknowns if self._terrain.closure is not None and self.driver else ()

    @property
    def closure(self) -> Closure | None:
        return self._terrain.closure if self.unknowns else None

    @cached_property
    def rate_of(self) -> dict[str, str]:
        """Rates of the loops' unknowns, by the unknown."""
        loops = self.exercise.solution.loops.values()
        rates = {n: pair[0] for loop in loops for n, pair in loop.rates.items() if pair[0]}
        return {n: rates[n] for n in self.unknowns} if all(n in rates for n in self.unknowns) else {}

    def quantities(self, sort: str) -> tuple[str, ...]:
        """Return the quantities of one kind that have a reference."""
        if sort == POSITION and self.unknowns:
            chosen = self.unknowns
        elif sort == RATE and self.rate_of:
            chosen = tuple(self.rate_of.values())
        else:
            chosen = tuple(n for n in self.numbers if self._sort(n) == sort)
        return tuple(n for n in chosen if n not in self.reference.lacking)

    def _sort(self, name: str) -> str:
        sort = _OF_UNITS.get(self.exercise.units.get(name, "1"), OTHER)
        used = {POSITION: self.unknowns, RATE: tuple(self.rate_of.values())}.get(sort, ())
        return OTHER if used and name not in used else sort

    # ---------------------------------------------------------------------- places

    @cached_property
    def driver(self) -> str:
        """Given angle that moves the mechanism; empty where there is none."""
        driver = self.exercise.spec.driver
        given = self.exercise.spec.given
        return driver.angle if driver is not None and driver.poses is None and driver.angle in given else ""

    @cached_property
    def speed(self) -> str:
        driver = self.exercise.spec.driver
        return driver.speed if driver is not None and driver.speed in self.base else ""

    @cached_property
    def base(self) -> dict[str, Any]:
        """Given values of the generic mechanism."""
        known_values = {**self.exercise.intake.defaults, **self.exercise.variant(0).given, **self.study.given}
        return {
            n: v if isinstance(v, str) else float(v)
            for n, v in known_values.items()
            if n in self.exercise.quantity_names
        }

    def generic(self, count: int) -> Places:
        """Return ``count`` generic places."""
        if self.driver:
            turned = np.random.default_rng(1).uniform(-180.0, 180.0, count)
            return {**self.base, self.driver: turned}
        variants = [v.given for v in self.exercise.variants(range(min(count, 200)))]
        columns = {n: np.resize(np.array([v[n] for v in variants]), count) for n in variants[0]}
        return {n: v for n, v in columns.items() if n in self.exercise.quantity_names}

    @cached_property
    def hard(self) -> tuple[HardPlace, ...]:
        return hard_places(self.exercise, self.reference.wanted)


def one_by_one(places: Places) -> list[dict[str, Any]]:
    """Split arrays of places into single places."""
    count = max((np.size(v) for v in places.values() if np.ndim(v)), default=1)
    return [{n: (v if np.ndim(v) == 0 else v[i]) for n, v in places.items()} for i in range(count)]


def together(rows: list[dict[str, Any]]) -> Places:
    """Join places into arrays; a text stays single where it is the same in all."""
    results: Places = {}
    for name, first in rows[0].items():
        values = [row[name] for row in rows]
        results[name] = first if isinstance(first, str) and len(set(values)) == 1 else np.array(values)
    return results
