"""Exploration of a driven mechanism with freely chosen data: whether it closes, its figure, paths, and
quantities over a turn."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from coursework.course.exercise import CourseExercise
from coursework.course.variant import Variant
from coursework.errors import CannotAssemble, CourseworkError, Undefined, WrongValue
from coursework.figures.base import Element
from coursework.figures.elements import ground_pivot, link, pin
from coursework.figures.marks import arc, note, trace
from coursework.figures.moving import Arrow, MovingDrawing, TracedPoint, drawing
from coursework.language.numbers import settled, typed_number
from coursework.model import GivenSpec
from coursework.quantities.graph import Graph
from coursework.scenes.animation import Animation, turning_arm
from coursework.scenes.effects import KINEMATIC, of_exercise
from coursework.scenes.scenes import Scene
from coursework.structure.grashof import linkage_type

STEPS = 360  #: of a turn
_LEAST, _MOST = 0.25, 2.5  #: bounds of a length or a rate, over its typical value
_PANELS = 3  #: quantities that are plotted of an effect
_GAP = re.compile(r"\(gap (\S+)\)")


@dataclass(frozen=True)
class Parameter:
    """Quantity that may be changed: a number between two bounds, or one of several cases."""

    name: str
    unit: str
    low: float = 0.0
    high: float = 0.0
    step: float = 1.0
    choices: tuple[str, ...] = ()

    def value(self, text: str) -> float | str | None:
        """Return the value that a text states, within the bounds; None for a text that states none."""
        if self.choices:
            return text if text in self.choices else None
        number = typed_number(text[:_LONGEST])
        return min(max(number, self.low), self.high) if math.isfinite(number) else None

    def is_beyond(self, text: str) -> bool:
        """Return True if a text states a number beyond the bounds, of which the nearer is taken."""
        number = typed_number(text[:_LONGEST])
        return not self.choices and math.isfinite(number) and not self.low <= number <= self.high


_LONGEST = 24  #: letters of a number


def parameters(exercise: CourseExercise[Any], typical: Mapping[str, Any]) -> tuple[Parameter, ...]:
    """Return what may be changed of a driven exercise, with bounds round its typical values; the driver's
    angle last.

    A quantity that the driver's position decides is none of them.
    """
    driver = exercise.spec.driver
    assert driver is not None  # an exercise without one is not explored
    placed = () if driver.poses is None else exercise.posed(typical, 0.0)
    lengths = [abs(v) for n, v in typical.items() if exercise.spec.given[n].unit == "mm"]
    left = {*placed, driver.angle, driver.moved, *(driver.jack.limits if driver.jack else ())}
    shown = _used(exercise)
    size = max(lengths, default=1.0)
    found = [
        _parameter(n, spec, typical[n], size)
        for n, spec in exercise.spec.given.items()
        if n in shown and n not in left
    ]
    if driver.jack is not None:
        shortest, longest = (float(typical[name]) for name in driver.jack.limits)
        return (*found, Parameter(driver.moved, "mm", shortest, longest))
    return (*found, Parameter(driver.angle, "deg", 0.0, float(STEPS)))


def _used(exercise: CourseExercise[Any]) -> set[str]:
    """Return the given quantities that the figure, or a quantity over the turn, goes by."""
    spec, graph = exercise.spec, exercise.solution.graph
    assert spec.driver is not None
    assert spec.figure is not None
    effects = of_exercise(exercise, spec.driver)
    shown = {n for names in effects.values() for n in names} | {spec.driver.effort}
    figure = Graph({**{f.__name__: f for f in spec.helpers}, "figure": spec.figure})
    drawn = {n for n, given in spec.given.items() if given.shown and "figure" in figure.descendants((n,))}
    return {n for n in spec.given if n in drawn or shown & graph.descendants((n,))}


def _parameter(name: str, spec: GivenSpec, typical: Any, size: float) -> Parameter:
    if spec.choices:
        return Parameter(name, spec.unit, choices=spec.choices)
    value, step = float(typical), float(spec.step)
    if spec.unit == "deg":
        is_positive = isinstance(spec.low, float) and spec.low > 0
        return Parameter(name, spec.unit, step if is_positive else -180.0, 180.0, step)
    if spec.positive:
        return Parameter(
            name, spec.unit, max(step, _stepped(_LEAST * value, step)), _stepped(_MOST * value, step), step
        )
    reach = _stepped(_MOST * abs(value) or (size if spec.unit == "mm" else 10.0), step)
    return Parameter(name, spec.unit, -reach, reach, step)


def _stepped(value: float, step: float) -> float:
    return settled(max(1, round(value / step)) * step)


@dataclass(frozen=True)
class Curve:
    """Quantity over the steps of a turn; NaN where it does not exist."""

    name: str
    unit: str
    values: np.ndarray


class Exploration:
    """Driven mechanism with chosen data.

    Parameters
    ----------
    exercise
        It names a driver and a figure.
    typical
        Values of all given quantities, in their units, with which the mechanism closes.
    changed
        Values of :func:`parameters`, which replace them.
    lang
        Language of the texts in the figure.

    Raises
    ------
    CannotAssemble
        The data place the driver by another quantity, and the mechanism closes at none of its angles.
    """

    def __init__(
        self, exercise: CourseExercise[Any], typical: Mapping[str, Any], changed: Mapping[str, Any], lang: str
    ):
        driver = exercise.spec.driver
        assert driver is not None  # an exercise without one is not explored
        self.exercise, self.driver = exercise, driver
        values = {**typical, **changed}
        self.at = float(values[driver.moved] if driver.moved in values else exercise.driver_angle(typical))
        given = {n: v for n, v in values.items() if n in exercise.spec.given}
        if driver.poses is not None and driver.jack is None:
            given |= _placed(exercise, typical, given, self.at)
        self._scene = Scene(exercise, given)
        self._animation = Animation(Variant(exercise, 0, given, lang))

    # --------------------------------------------------------------------- over a turn

    @cached_property
    def steps(self) -> np.ndarray:
        """Values of the driver over a turn, degrees, or over the travel of its jack, mm."""
        return self._scene.steps(STEPS)

    @cached_property
    def _angles(self) -> np.ndarray:
        """Angles of the driver at the steps, degrees."""
        return np.degrees(self._scene.driver_motion(self.steps, moving=False)[0])

    @cached_property
    def points(self) -> Mapping[str, np.ndarray]:
        """Moving points of the mechanism over the steps, mm, complex; NaN where they do not exist."""
        return {n: point.position for n, point in self._animation.stated_points(self._angles).items()}

    def curves(self, effect: str) -> tuple[Curve, ...]:
        """Return the first quantities of an effect over the steps: ``position`` … ``acceleration``, or
        ``forces``."""
        return self._curves[effect]

    @cached_property
    def _curves(self) -> Mapping[str, tuple[Curve, ...]]:
        columns, units = Scene(self.exercise, self._scene.given, KINEMATIC[:3]).columns(self.steps)
        result = {}
        for effect in KINEMATIC[:3]:
            names = [n for n in self._scene.shown_by(effect) if n in columns and n != self.driver.moved]
            names.sort(key=lambda name: units[name] == "1")  # a number is shown after angles and lengths
            result[effect] = tuple(Curve(n, units[n], _existing(columns[n])) for n in names[:_PANELS])
        return {**result, "forces": self._of_forces()}

    def _of_forces(self) -> tuple[Curve, ...]:
        """Return what the drive supplies, where the exercise has loads or masses."""
        effects = [e for e in self._scene.with_data() if e != "flywheel"]
        if not effects or self.exercise.solution.mechanism is None:
            return ()
        name = "drive_thrust" if self.exercise.solution.mechanism.pushed else "drive_torque"
        try:
            columns, units = Scene(self.exercise, self._scene.given, tuple(effects), (name,)).columns(
                self.steps
            )
        except WrongValue:  # neither stroke is the working one
            return ()
        return tuple(
            Curve(n, units[n], _existing(columns[n])) for n in (self.driver.effort, name) if n in columns
        )[:1]

    @cached_property
    def closes(self) -> np.ndarray:
        """True at the steps where the mechanism closes."""
        values = [*self.points.values(), *(curve.values for curve in self._curves["position"])]
        return np.logical_and.reduce([np.ones(len(self.steps), bool), *(np.isfinite(v) for v in values)])

    @property
    def ranges(self) -> list[tuple[float, float]]:
        """Ranges of the driver in which the mechanism closes, each from its first step to its last; one that
        passes 0 degrees goes from the larger angle to the smaller."""
        found = [(float(self.steps[a]), float(self.steps[b - 1])) for a, b in _stretches(self.closes)]
        if len(found) > 1 and self.driver.jack is None and self.closes[0]:
            (_, end), *others, (start, _) = found
            return [*others, (start, end)]
        return found

    # ------------------------------------------------------------------------- mobility

    @cached_property
    def type(self) -> str:
        """Type of the four-bar linkage that the driver turns, one of
        :data:`~coursework.structure.grashof.TYPES`; empty if it turns none."""
        chain = self._four_bar()
        if chain is None or not self.closes.any():
            return ""
        moving = self._scene.moving_points(self._angles[self.closes][:1])
        places = {n: point.position[0] for n, point in moving.items()} | self._scene.ground_points()
        O, A, B, C = (places[name] for name in chain)
        lengths = (settled(abs(z)) for z in (C - O, A - O, B - A, C - B))
        return str(linkage_type(*lengths))

    def _four_bar(self) -> tuple[str, str, str, str] | None:
        """Return the pins of crank, coupler and output: fixed, moving, moving, fixed."""
        mechanism = self.exercise.solution.mechanism
        if mechanism is None or self.driver.jack is not None:
            return None
        bodies, ground = mechanism.bodies, mechanism.ground
        cranks = [b for b in bodies if b.angle == self.driver.angle and b.at in ground]
        for crank in cranks:
            for coupler in (b for b in bodies if b.at in crank.points):
                for output in (b for b in bodies if b.at in ground and b is not crank):
                    for shared in coupler.points.keys() & output.points.keys():
                        return crank.at, coupler.at, shared, output.at
        return None

    # ---------------------------------------------------------------------- one instant

    @cached_property
    def _angle(self) -> float:
        """Angle of the driver now, degrees. Raises CannotAssemble: the jack does not reach that length."""
        if self.driver.jack is None:
            return self.at
        found = self.exercise.solve(**self._scene.given, only=self.driver.angle, effects=())
        return float(found[self.driver.angle])

    @cached_property
    def _now(self) -> tuple[tuple[Element, ...], CourseworkError | None]:
        try:
            return self._animation.elements_at(self._angle), None
        except (CannotAssemble, Undefined, WrongValue) as fault:
            return (), fault

    @property
    def is_open(self) -> bool:
        """True if the mechanism does not close with the driver where it is."""
        return self._now[1] is not None

    @property
    def gap(self) -> float | None:
        """Length that lacks for the mechanism to close, mm; None where it closes, or where nothing says
        it."""
        return self.gap_of(self._now[1])

    @staticmethod
    def gap_of(fault: CourseworkError | None) -> float | None:
        """Return the gap that a fault states, mm; None where it states none."""
        found = _GAP.search(str(fault or ""))
        return abs(float(found[1])) if found else None

    @cached_property
    def crank(self) -> tuple[complex, complex] | None:
        """Pivot of the driver, and the named point farthest from it that turns with it, where it is, mm; None
        where there is no such point."""
        turned, arms = np.exp(1j * np.radians(self._angles)), []
        for way in self.points.values():
            exists = np.isfinite(way)
            if exists.sum() > 2:
                arms.append(turning_arm(way[exists], turned[exists]))
        pivot, arm = max(arms, key=lambda one: abs(one[1]), default=(0j, 0j))
        if not arm or self.driver.jack is not None:
            return None
        return pivot, pivot + arm * complex(np.exp(1j * np.radians(self._angle)))

    @cached_property
    def nearest(self) -> float | None:
        """Value of the driver nearest to its own at which the mechanism closes; None if it closes nowhere."""
        if not self.closes.any():
            return None
        away = np.abs(self.steps - self.at)
        if self.driver.jack is None:
            away = np.minimum(away, 360.0 - away)
        return float(self.steps[np.where(self.closes, away, np.inf).argmin()])

    def values_now(self) -> Mapping[str, float]:
        """Return the plotted quantities with the driver where it is, by linear steps of a turn; NaN where
        they do not exist."""
        every = [curve for curves in self._curves.values() for curve in curves]
        place = float(np.interp(self.at, self.steps, np.arange(len(self.steps))))
        k = min(int(place), len(self.steps) - 2)
        share = place - k
        return {
            c.name: float(
                c.values[k] if share == 0 else c.values[k] + share * (c.values[k + 1] - c.values[k])
            )
            for c in every
        }

    def drawing(self) -> MovingDrawing | None:
        """Return the figure with the paths of its points; where it does not close, what is known of it."""
        elements = _without_choices(self._now[0]) or self._pins()
        if not elements:
            return None
        named = {getattr(element, "label", "") for element in elements}
        spots = [
            TracedPoint(run[:1], name, len(run) == len(way) and self.driver.jack is None, run)
            for name, way in self.points.items()
            if name in named
            for run in _runs(way)
        ]
        return drawing([elements], spots=spots, arrows=self._gap_arrows())

    @cached_property
    def _known(self) -> Mapping[str, complex]:
        """Pivots, and those pins whose places are known although the mechanism does not close, mm."""
        if self.exercise.solution.mechanism is None:
            return {}
        fixed = self._scene.ground_points()
        if self.driver.jack is not None:
            return fixed
        points = self._animation.stated_points(np.array([self.at]))
        moving = {name: complex(point.position[0]) for name, point in points.items()}
        return fixed | {name: p for name, p in moving.items() if np.isfinite(p)}

    def _pins(self) -> tuple[Element, ...]:
        """Return what is known of a mechanism that does not close; of a four-bar linkage also the circles on
        which coupler and output end."""
        if not self._known:
            return ()
        fixed = self._scene.ground_points()
        shown: list[Element] = [
            ground_pivot(p, n) if n in fixed else pin(p, n) for n, p in self._known.items()
        ]
        if self._apart is not None:
            O, *circles = self._apart
            shown.append(link(O, circles[0][0]))
            shown += [arc(center, radius, 0, 360, dashed=True) for center, radius in circles]
        return tuple(shown)

    @cached_property
    def _apart(self) -> tuple[complex, tuple[complex, float], tuple[complex, float]] | None:
        """Pivot of the crank, and the circles on which coupler and output end, each by its centre and radius,
        mm; None unless it is these two that do not reach each other."""
        chain = self._four_bar()
        if chain is None or not self.is_open or chain[1] not in self._known:
            return None
        O, A, C = (self._known[name] for name in (chain[0], chain[1], chain[3]))
        bodies, number = self._scene.mechanism.bodies, self._scene.linkage.number
        reach = {b.at: abs(complex(number(b.points[chain[2]]))) for b in bodies if chain[2] in b.points}
        coupler, output = reach[chain[1]], reach[chain[3]]
        meets = abs(coupler - output) <= abs(C - A) <= coupler + output
        return None if meets else (O, (A, coupler), (C, output))

    def _gap_arrows(self) -> list[Arrow]:
        """Return the shortest way between those two circles, an arrow from each side."""
        if self._apart is None:
            return []
        _, (A, coupler), (C, output) = self._apart
        along = (C - A) / (abs(C - A) or 1.0)
        ends = [(A + s * coupler * along, C + t * output * along) for s in (1, -1) for t in (1, -1)]
        a, b = min(ends, key=lambda pair: abs(pair[1] - pair[0]))
        return [Arrow(np.array([p]), np.array([q - p]), "acceleration", "") for p, q in ((a, b), (b, a))]


def _placed(
    exercise: CourseExercise[Any], typical: Mapping[str, Any], given: Mapping[str, Any], at: float
) -> dict[str, Any]:
    """Return the quantities that place the driver, in the assembly of the typical data, at an angle, degrees,
    or at the nearest at which the mechanism closes."""
    helpers = Graph({function.__name__: function for function in exercise.spec.helpers})
    moved = helpers.descendants(tuple(exercise.posed(typical, at))) & set(helpers.quantities)
    assembly = helpers.evaluate(tuple(moved), {n: v for n, v in typical.items() if n in helpers.leaves})
    known = {**given, **assembly}
    angles = at + np.arange(float(STEPS))
    placed = exercise.posed(known, angles)
    exists = np.logical_and.reduce(
        [np.isfinite(v) for v in placed.values() if np.asarray(v).dtype.kind == "f"]
    )
    if not exists.any():
        exercise.posed(known, at)  # says by how much it does not close
    away = np.minimum(angles - at, STEPS + at - angles)
    k = int(np.where(exists, away, np.inf).argmin())
    return {n: np.broadcast_to(v, angles.shape)[k].item() for n, v in placed.items()}


def _without_choices(elements: tuple[Element, ...]) -> tuple[Element, ...]:
    """Return the elements without curves to choose from, which the question of a statement draws beside the
    mechanism."""
    if not any(isinstance(element, trace) for element in elements):
        return elements
    return tuple(element for element in elements if not isinstance(element, (trace, note)))


def _existing(values: np.ndarray) -> np.ndarray:
    """Return the values, NaN for those that are nowhere, such as the place of an instant centre of parallel
    velocities."""
    return np.where(np.isfinite(values), values, np.nan)


def _runs(way: np.ndarray) -> list[np.ndarray]:
    """Return the pieces of a path that exist."""
    return [way[a:b] for a, b in _stretches(np.isfinite(way)) if b - a > 1]


def _stretches(holds: np.ndarray) -> list[tuple[int, int]]:
    """Return where each stretch of True begins, and the place after its end."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(int)))
    return [(a, b) for a, b in edges.reshape(-1, 2).tolist()]
