"""Mechanism of the course on stage: the exercise's numbers, the requested effects, the added data, and the
resulting forces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, Self

import numpy as np

from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, WrongValue, nearest
from coursework.mechanics.evenness import Evenness
from coursework.mechanics.forces import Forces
from coursework.mechanics.friction import Contact, contacts
from coursework.mechanics.linkage import MM, Linkage
from coursework.mechanics.loads import AppliedLoad
from coursework.mechanics.rates import Stance
from coursework.mechanics.statement import Load, Mechanism, number, parameters
from coursework.messages import Message
from coursework.model import Driver
from coursework.quantities.loops import usual_rates
from coursework.scenes.added import SceneData
from coursework.scenes.effects import ADVANTAGE, FORCES, KINEMATIC, check_effect, check_turns, of_exercise

INERTIA, FRICTION, FLYWHEEL = "inertia", "friction", "flywheel"
_JUDGED = 3600  #: steps of the cycle over which a flywheel is sized


@dataclass(frozen=True)
class Staged:
    """Mechanism of an exercise with the effects and the data of a scene; see
    :class:`~coursework.scenes.scenes.Scene`."""

    exercise: CourseExercise
    given: Mapping[str, Any]
    effects: tuple[str, ...] = ()
    show: tuple[str, ...] = ()
    added: SceneData = field(default_factory=SceneData)

    def __post_init__(self) -> None:
        for before, effect in enumerate(self.effects):
            check_effect(effect, self.exercise)
            if effect in self.effects[:before]:
                raise WrongValue("the effect {effect!r} is named twice", effect=effect)
        for name, value in self._accepted.items():
            if isinstance(value, np.ndarray):
                raise WrongValue(
                    "a scene takes one value of {name}; found {size}", name=name, size=value.size
                )
        if self._forces_called and not self._graph_effects:
            self.mechanism  # noqa: B018  # is refused here where there is none

    def without(self, effect: str) -> Self:
        """Return the scene without one effect; its shown quantities stay."""
        return replace(self, effects=tuple(e for e in self.effects if e != effect))

    # -------------------------------------------------------------------- driver

    @property
    def driver(self) -> Driver:
        """Driver of the mechanism; a film's angle and speed, where the solution states one.

        Raises
        ------
        BadCourse
            The exercise names none.
        """
        driver, film = self.exercise.spec.driver, self.exercise.film
        if driver is None and film is not None:
            return Driver(film.angle, film.speed)
        if driver is None:
            raise BadCourse(f"{self.exercise.name} names no driver=Driver(…), so it cannot be simulated")
        return driver

    @cached_property
    def _accepted(self) -> dict[str, Any]:
        """Given values in canonical units, with the exercise's defaults."""
        accepted = {n: self.exercise.intake.value(n, v) for n, v in self.given.items()}
        return {**self.exercise.intake.defaults, **accepted}

    @property
    def has_own_data(self) -> bool:
        """True if the scene has data that the exercise's own force formulas do not know."""
        return self.added.is_own or FLYWHEEL in self.effects

    def _driven(self, angle: Any) -> dict[str, Any]:
        """Return the given values with the driver at an angle, degrees."""
        if self.exercise.spec.driver is None:
            return dict(self.given)
        return {**self.given, **self.exercise.posed(self._accepted, angle)}

    def _at(self, values: Any) -> dict[str, Any]:
        """Return the given values with what a cycle steps through, degrees or mm."""
        jack = self.driver.jack
        return {**self.given, jack.length: values} if jack else self._driven(values)

    def driver_motion(
        self, values: np.ndarray, *, moving: bool = True
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the driver's angles (radians), speeds and accelerations where a cycle steps through values.

        Of a jack, the rates are computed only if ``moving``; at rest they are 0.
        """
        driver, jack = self.driver, self.driver.jack
        if jack is None:
            return np.radians(values), *(np.full(values.shape, v) for v in (self._speed, self._acceleration))
        moving &= any(map(self._value, (jack.speed, jack.acceleration)))
        names = (driver.angle, *(self._rates_of(driver.angle) if moving else ()))
        found = self.exercise.solve(**self._at(values), only=names, effects=())
        angle, *rates = (np.broadcast_to(found[n], values.shape) for n in names)
        speed, acceleration = rates or (np.zeros(values.shape),) * 2
        return np.radians(angle), speed, acceleration

    def _at_unit_speed(self, angle: Any) -> dict[str, Any]:
        """Return the given values at an angle with the driver at a constant 1 rad/s, so that rates are
        derivatives by its angle."""
        driver = self.driver
        rest = {driver.acceleration: 0.0} if driver.acceleration else {}
        return {**self._driven(angle), driver.speed: 1.0, **rest}

    def _value(self, name: str) -> float:
        """Return a given value of the driver's; 0 where the exercise has none."""
        return float(self._accepted.get(name, 0.0)) if name else 0.0

    @property
    def _speed(self) -> float:
        return self._value(self.driver.speed)

    @property
    def _acceleration(self) -> float:
        return self._value(self.driver.acceleration)

    # ------------------------------------------------------------------- effects

    @property
    def _graph_effects(self) -> tuple[str, ...]:
        """Requested effects that the exercise's own formulas know."""
        graph_effects = self.exercise.solution.graph.effects()
        return tuple(e for e in self.effects if e in graph_effects)

    @property
    def _forces_called(self) -> bool:
        return any(e in FORCES or e not in (*KINEMATIC, ADVANTAGE) for e in self.effects)

    @cached_property
    def _by_effect(self) -> Mapping[str, tuple[str, ...]]:
        return of_exercise(self.exercise, self.driver)

    def _of(self, effect: str) -> tuple[str, ...]:
        return self._by_effect.get(effect, ())

    @property
    def called(self) -> tuple[str, ...]:
        """Requested effects; positions when none is named."""
        return self.effects or ("position",)

    def with_data(self) -> tuple[str, ...]:
        """Return the force effects for which there are data: masses, loads, friction, a flywheel."""
        if self.exercise.solution.mechanism is None:
            return self.exercise.solution.graph.effects()
        mechanism, result = self.mechanism, []
        if mechanism.loads:
            result.append("load")
        if self.linkage.masses:
            result += [
                e for e in ("gravity", INERTIA) if e == INERTIA or any(m.mass for m in self.linkage.masses)
            ]
        if contacts(self.linkage, mechanism.friction):
            result.append(FRICTION)
        return (*result, *(("flywheel",) if self.added.flywheel else ()))

    # ------------------------------------------------------------------- mechanism

    @cached_property
    def mechanism(self) -> Mechanism:
        """The mechanism with the data of the scene.

        Raises
        ------
        BadCourse
            The solution states none.
        """
        stated = self.exercise.solution.mechanism
        if stated is None:
            raise BadCourse(
                f"{self.exercise.solution.source} states no MECHANISM = Mechanism(…): nothing says "
                "which bodies bear forces"
            )
        return self.added.to(stated)

    @cached_property
    def linkage(self) -> Linkage:
        mechanism = self.mechanism
        self._refuse_moving(mechanism)
        wanted = tuple(n for n in mechanism.named if n not in self.exercise.spec.given)
        for name in wanted:
            if name not in self.exercise.quantity_names:
                known_values = {*self.exercise.quantity_names, *self.exercise.spec.given}
                raise BadCourse(
                    f"{self.exercise.solution.source}: MECHANISM names no quantity by "
                    f"{name!r}{nearest(name, known_values)}"
                )
        values = self.exercise.solve(**self.given, only=wanted, effects=()) if wanted else {}
        values |= {n: self._accepted[n] for n in mechanism.named if n in self._accepted}
        linkage = Linkage(mechanism, values, self.driver.angle)
        linkage.check()
        return linkage

    def _refuse_moving(self, mechanism: Mechanism) -> None:
        """Refuse positions that move within their body. Raises BadCourse: it names the quantity that the
        driver moves."""
        for position in mechanism.unfolded():
            for name in parameters(position):
                if name in self.moved:
                    raise BadCourse(
                        f"{self.exercise.solution.source}: MECHANISM places a point by {name}, which "
                        "moves with "
                        f"{self.driver.angle}: a place does not move within its body; where a body "
                        "slides, state a Slide"
                    )

    def pose(self, angles: np.ndarray, *, by_joints: bool = False) -> Stance:
        """Return the mechanism at driver's angles, radians, shape ``(n,)``.

        Its rates come from the solution's formulas where all exist, otherwise, or with ``by_joints``, from
        the joint equations.
        """
        linkage = self.linkage
        bodies = linkage.mechanism.bodies
        shifting = tuple(n for body in bodies if body.origin is not None for n in parameters(body.origin))
        named = dict.fromkeys((*linkage.mechanism.angles, *shifting))
        wanted = tuple(n for n in named if n != self.driver.angle and n not in self.exercise.spec.given)
        degrees = np.degrees(angles)
        result = self.exercise.solve(**self._driven(degrees), only=wanted, effects=()) if wanted else {}
        turned = {**self._accepted, self.driver.angle: degrees, **result}
        turns = np.repeat(linkage.constant_turns[:, None], len(angles), axis=1)
        for index, body in enumerate(bodies):
            if isinstance(body.angle, str):
                turns[index] = np.radians(turned[body.angle])
        origins = {index: origin for index in linkage.free if (origin := bodies[index].origin) is not None}
        shifts = {
            index: np.broadcast_to(number(at, turned), angles.shape) * MM for index, at in origins.items()
        }
        return Stance(linkage, turns, None if by_joints else partial(self._stated_rates, degrees), shifts)

    def _stated_rates(self, degrees: np.ndarray, order: int) -> np.ndarray | None:
        """Return first or second derivatives of the unknown angles by the driver's, from the solution's own
        rates."""
        names = self._rates_by_name[order - 1]
        if names is None or not self.driver.speed:
            return None
        result = self.exercise.solve(**self._at_unit_speed(degrees), only=names, effects=()) if names else {}
        return np.array([np.broadcast_to(result[n], degrees.shape) for n in names]).reshape(
            len(names), len(degrees)
        )

    @cached_property
    def _rates_by_name(self) -> tuple[tuple[str, ...] | None, tuple[str, ...] | None]:
        """Names of the rates and of the accelerations of the unknown angles; None where one is missing."""
        angles = self.linkage.unknown_angles
        known_names = frozenset(self.exercise.solution.graph.quantities)
        if angles is None:
            return None, None
        pairs = [self._rates_of(n) for n in angles]
        first, second = (tuple(pair[order] for pair in pairs) for order in (0, 1))
        return (first if known_names.issuperset(first) else None), (
            second if known_names.issuperset(second) else None
        )

    def _rates_of(self, angle: str) -> tuple[str, str]:
        """Return the names of the first and second rates of an angle."""
        solution = self.exercise.solution
        of_loops = {n: pair for loop in solution.loops.values() for n, pair in loop.rates.items()}
        return of_loops.get(angle) or usual_rates(angle, frozenset(solution.graph.quantities))

    # ---------------------------------------------------------------------- forces

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Contacts with friction, if that effect is requested."""
        return contacts(self.linkage, self.linkage.mechanism.friction) if FRICTION in self.effects else ()

    @cached_property
    def forces(self) -> Forces:
        """Forces of the requested effects."""
        label, linkage = self.effects, self.linkage
        loads = linkage.mechanism.loads if "load" in label else ()
        return Forces(
            linkage,
            self.pose,
            self.added.gravity if "gravity" in label else 0j,
            INERTIA in label,
            self.flywheel if FLYWHEEL in label else 0.0,
            tuple(self._acting(load) for load in loads),
            self.contacts,
        )

    def _acting(self, load: Load) -> AppliedLoad:
        """Return a load on the mechanism; a quantity of it that the driver moves is followed over the turn.
        Raises WrongValue: it goes by what the driver's speed changes, which is not a place; a function hides
        that it moves; or it acts during the strokes of a crank where a jack drives."""
        if "stroke" in load.during:
            check_turns(f"the {load.during}", self.exercise)
        for position in (load.force, load.moment, load.angle):
            if callable(position) and self.moved.intersection(parameters(position)):
                raise WrongValue(
                    "the load on {place} goes by a function of {parameters}, which the driver moves; "
                    "make it a quantity of the solution, and name that",
                    place=load.on,
                    parameters=", ".join(parameters(position)),
                )
        for name in (load.by, *(n for p in (load.force, load.moment, load.angle) for n in parameters(p))):
            if name in self._sped:
                raise WrongValue(
                    "the load on {place} goes by {name}, which changes with the driver's speed; a load "
                    "goes by an angle, a position, or against the motion",
                    place=load.on,
                    name=name,
                )
        return AppliedLoad(self.linkage, load, self._position)

    @cached_property
    def _sped(self) -> frozenset[str]:
        """Quantities that the driver's speed changes."""
        drives = (self.driver, self.driver.jack) if self.driver.jack else (self.driver,)
        rates = [n for drive in drives for n in (drive.speed, drive.acceleration) if n]
        return self.exercise.solution.graph.descendants(rates) if rates else frozenset()

    @cached_property
    def moved(self) -> frozenset[str]:
        """Quantities that the driver's angle moves."""
        placing = {self.driver.angle}
        if self.exercise.spec.driver is not None and self.exercise.spec.driver.poses is not None:
            placing = set(self.exercise.posed(self._accepted, 0.0))
        return self.exercise.solution.graph.descendants(placing)

    def _position(self, name: str, angles: np.ndarray) -> np.ndarray:
        """Return a quantity of the exercise at driver's angles, radians."""
        degrees = np.degrees(angles)
        return np.asarray(self.exercise.solve(**self._driven(degrees), only=name, effects=())[name])

    # -------------------------------------------------------------------- flywheel

    @cached_property
    def evenness(self) -> Evenness:
        """Evenness of the turn at the given constant speed, without a flywheel."""
        if not self._speed:
            raise WrongValue(
                "a flywheel is sized for a speed: {speed} is 0 or not given",
                speed=self.driver.speed or Message("the speed"),
            )
        angles, speed = np.arange(_JUDGED) * (2 * np.pi / _JUDGED), np.full(_JUDGED, self._speed)
        without = replace(self.without(FLYWHEEL), show=())
        return Evenness(without.forces.over(angles, speed, np.zeros(_JUDGED)).effort, self._speed)

    @cached_property
    def flywheel(self) -> float:
        """Moment of inertia of the flywheel, kg m^2; sized for the unevenness where that is given."""
        wheel = self.added.flywheel
        if wheel is None:
            raise WrongValue(
                "the effect 'flywheel' needs one: [flywheel] inertia = \"2 kg*m^2\", or unevenness = 0.02"
            )
        if wheel.inertia is not None:
            return wheel.inertia
        assert wheel.unevenness is not None  # one of the two is said
        return self.evenness.inertia_for(wheel.unevenness)
