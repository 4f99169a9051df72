"""Scenes: an exercise's mechanism, its data, and the effects that the scene calls for.

A scene that calls for less runs less: its columns are the quantities of the effects named, and the quantity graph
evaluates what those need and nothing else; forces come from the mechanism that the solution states, the effort alone by
virtual power, what joints bear only where it is asked.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, CourseworkError, WrongValue, counted
from coursework.mechanics.forces import Borne, Forces
from coursework.mechanics.friction import contacts
from coursework.mechanics.linkage import MM, Linkage, SlideJoint
from coursework.mechanics.loads import Acting
from coursework.mechanics.rates import Stance
from coursework.mechanics.running import Motion, Running
from coursework.mechanics.statement import Mechanism, parameters
from coursework.model import Driver
from coursework.motion import shown
from coursework.motion.added import Added, Motor
from coursework.motion.effects import ADVANTAGE, FORCES, KINEMATIC, OF_FORCES, check_effect, of_exercise
from coursework.quantities.loops import usual_rates
from coursework.solution import Moving

INERTIA, FRICTION = "inertia", "friction"
_JUDGED = 720  #: steps of the cycle over which a flywheel is sized


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

    Attributes
    ----------
    given
        Values of the exercise's given quantities, numbers in canonical units or texts with a unit.
    effects
        ``position``, ``velocity``, ``acceleration``, ``coriolis``, ``advantage``, ``load``, ``gravity``, ``inertia``,
        ``friction``, ``flywheel``; positions alone without any.
    show
        What else is shown: quantities of the exercise, ``drive_torque``, ``reaction B``, ``velocity B`` …
    added
        Masses, loads, friction, a flywheel.

    Raises
    ------
    UnknownName
        An effect, or something to show, that there is not.
    WrongValue
        An effect of which this mechanism has nothing.
    """

    exercise: CourseExercise
    given: Mapping[str, Any]
    effects: tuple[str, ...] = ()
    show: tuple[str, ...] = ()
    added: Added = field(default_factory=Added)

    def __post_init__(self) -> None:
        for effect in self.effects:
            check_effect(effect, self.exercise)
        for name in self.show:
            self._check_shown(name)
        if "coriolis" in self.effects and not self._of("coriolis"):
            self._coriolis_points()
        if self._forces_called and not self._graph_effects:
            self.mechanism  # noqa: B018  # is refused here where there is none

    def without(self, effect: str) -> Scene:
        """The same scene, less one effect; what it shows stays."""
        return replace(self, effects=tuple(e for e in self.effects if e != effect))

    # -------------------------------------------------------------------- driver

    @property
    def driver(self) -> Driver:
        """What drives the mechanism; a film's angle and speed, where the solution states one.

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
        """The given values in canonical units, with the exercise's defaults."""
        accepted = {n: self.exercise.intake.value(n, v) for n, v in self.given.items()}
        return {**self.exercise.intake.defaults, **accepted}

    def _driven(self, angle: Any) -> dict[str, Any]:
        """The given values with the driver at an angle, degrees."""
        if self.exercise.spec.driver is None:
            return dict(self.given)
        return {**self.given, **self.exercise.posed(self._accepted, angle)}

    def _value(self, name: str) -> float:
        """A given value of the driver's; 0 where the exercise has none."""
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
        """The effects called that the exercise's own formulas know."""
        own = self.exercise.solution.graph.effects()
        return tuple(e for e in self.effects if e in own)

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
        """The effects, positions where none is named."""
        return self.effects or ("position",)

    @property
    def quantities(self) -> tuple[str, ...]:
        """What the scene shows of the exercise's own quantities."""
        wanted = [n for effect in self.called for n in self._of(effect)]
        if self._graph_effects and not self.added.is_own:
            wanted += self._of(OF_FORCES)
        elif not self.exercise.solution.mechanism:
            wanted += self._of(OF_FORCES) if self._graph_effects else ()
        wanted += [n for n in self.show if n in self.exercise.quantity_names]
        return tuple(
            n for n in dict.fromkeys(wanted) if n != self.driver.angle and n not in self.exercise.spec.given
        )

    def shown_by(self, effect: str) -> tuple[str, ...]:
        """The exercise's quantities that an effect shows."""
        return self._of(OF_FORCES if effect in self._graph_effects else effect)

    def with_data(self) -> tuple[str, ...]:
        """The effects of forces for which there are data: masses, loads, friction, a flywheel."""
        if self.exercise.solution.mechanism is None:
            return self.exercise.solution.graph.effects()
        mechanism, found = self.mechanism, []
        if mechanism.loads:
            found.append("load")
        if self.linkage.masses:
            found += [
                e for e in ("gravity", INERTIA) if e == INERTIA or any(m.mass for m in self.linkage.masses)
            ]
        if contacts(self.linkage, mechanism.friction):
            found.append(FRICTION)
        return (*found, *(("flywheel",) if self.added.flywheel else ()))

    @property
    def constants(self) -> frozenset[str]:
        """Quantities shown that no effect moves: they are computed once."""
        moving = {n for names in self._by_effect.values() for n in names}
        if self.exercise.spec.driver is None or self.exercise.spec.driver.poses is None:
            return frozenset()
        return frozenset(n for n in self.show if n in self.exercise.quantity_names and n not in moving)

    @cached_property
    def extra(self) -> tuple[str, ...]:
        """What is shown besides: of the drive, of points, of joints."""
        named = [n for n in self.show if n not in self.exercise.quantity_names]
        effort = self.driver.effort
        if self._forces_called and self.exercise.solution.mechanism and effort not in self.quantities:
            named.insert(0, "drive_torque")
        if "coriolis" in self.effects and not self._of("coriolis"):
            named += [f"coriolis {point}" for point in self._coriolis_points()]
        if self.exercise.solution.mechanism:
            named += self._of_what_the_solution_leaves_out()
        elif "position" in self.called and not self._of("position"):
            named += [f"position {point}" for point in self._moved_by_solution]
        return tuple(dict.fromkeys(named))

    @cached_property
    def _moved_by_solution(self) -> tuple[str, ...]:
        """The points that the solution's ``motion`` gives."""
        solution = self.exercise.solution
        if solution.motion is None:
            return ()
        graph = solution.graph.with_functions({"motion": solution.motion})
        given = {**self._accepted, **self._driven(0.0), self.driver.angle: 0.0}
        known = {n: v for n, v in given.items() if n in self.exercise.quantity_names | graph.leaves}
        return tuple(graph.evaluate(("motion",), known, self._graph_effects)["motion"])

    def _of_what_the_solution_leaves_out(self) -> list[str]:
        """Velocities and accelerations of moving points, where the effect is called and no quantity tells it."""
        points = [p for p in self.linkage.mechanism.points if p not in self.linkage.mechanism.ground]
        return [
            f"{effect} {point}"
            for effect in ("velocity", "acceleration")
            if effect in self.effects and not self._of(effect)
            for point in points
        ]

    def _coriolis_points(self) -> tuple[str, ...]:
        if self.exercise.solution.mechanism is None:
            raise WrongValue(
                f"{self.exercise.name} has no Coriolis term to show: its solution states no MECHANISM, and no "
                "EFFECTS of coriolis"
            )
        points = tuple(s.name.removesuffix(" slide") for s in shown.turning_slides(self.linkage))
        if not points:
            raise WrongValue(f"{self.exercise.name} has no Coriolis term: no body slides on one that turns")
        return points

    def _check_shown(self, name: str) -> None:
        if name in self.exercise.quantity_names:
            return
        if self.exercise.solution.mechanism is None:
            kind, of = shown.what(name)
            if kind not in ("position", "velocity", "acceleration") or of not in self._moved_by_solution:
                self.mechanism  # noqa: B018  # is refused here
            return
        shown.check(name, self.linkage, self.exercise.solution.graph.quantities)

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
                f"{self.exercise.solution.source} states no MECHANISM = Mechanism(…): nothing says which bodies bear forces"
            )
        return self.added.to(stated)

    @cached_property
    def linkage(self) -> Linkage:
        mechanism = self.mechanism
        places = [n for place in mechanism.unfolded() for n in parameters(place)]
        places += [
            n
            for load in mechanism.loads
            for p in (load.force, load.moment, load.angle)
            for n in parameters(p)
        ]
        for given in mechanism.friction.values():
            places += [
                n for p in (given if isinstance(given, (tuple, list)) else (given,)) for n in parameters(p)
            ]
        wanted = tuple(dict.fromkeys(places))
        values = self.exercise.solve(**self.given, only=wanted) if wanted else {}
        linkage = Linkage(mechanism, values, self.driver.angle)
        linkage.check()
        return linkage

    def pose(self, angles: np.ndarray, *, by_joints: bool = False) -> Stance:
        """The mechanism at driver's angles, radians, shape ``(n,)``; its rates by the solution's own formulas where it
        has all of them, and by the joints where it has not, or where that is asked."""
        linkage = self.linkage
        wanted = tuple(n for n in linkage.mechanism.angles if n != self.driver.angle)
        degrees = np.degrees(angles)
        found = self.exercise.solve(**self._driven(degrees), only=wanted) if wanted else {}
        turned = {self.driver.angle: degrees, **found}
        turns = np.repeat(linkage.constant_turns[:, None], len(angles), axis=1)
        for number, body in enumerate(linkage.mechanism.bodies):
            if isinstance(body.angle, str):
                turns[number] = np.radians(turned[body.angle])
        return Stance(linkage, turns, None if by_joints else partial(self._stated_rates, degrees))

    def _stated_rates(self, degrees: np.ndarray, order: int) -> np.ndarray | None:
        """First or second derivatives of the unknown angles by the driver's, as the solution's own rates give them."""
        names, driver = self._rates_by_name[order - 1], self.driver
        if names is None or not driver.speed:
            return None
        rest = {driver.acceleration: 0.0} if driver.acceleration else {}
        given: dict[str, Any] = {**self._driven(degrees), driver.speed: 1.0, **rest}
        found = self.exercise.solve(**given, only=names) if names else {}
        return np.array([np.broadcast_to(found[n], degrees.shape) for n in names]).reshape(
            len(names), len(degrees)
        )

    @cached_property
    def _rates_by_name(self) -> tuple[tuple[str, ...] | None, tuple[str, ...] | None]:
        """The quantities of the unknown angles' rates, and of their accelerations; None where one is missing."""
        angles, solution = self.linkage.unknown_angles, self.exercise.solution
        known = frozenset(solution.graph.quantities)
        of_loops = {n: pair for loop in solution.loops.values() for n, pair in loop.rates.items()}
        if angles is None:
            return None, None
        pairs = [of_loops.get(n) or usual_rates(n, known) for n in angles]
        first, second = (tuple(pair[order] for pair in pairs) for order in (0, 1))
        return (first if known.issuperset(first) else None), (second if known.issuperset(second) else None)

    @cached_property
    def forces(self) -> Forces:
        """What acts, of the effects called."""
        linkage, called = self.linkage, self.effects
        mechanism = linkage.mechanism
        inertia = INERTIA in called
        return Forces(
            linkage,
            self.pose,
            self.added.gravity if "gravity" in called else 0j,
            inertia,
            self._flywheel if "flywheel" in called else 0.0,
            tuple(Acting(linkage, load) for load in mechanism.loads) if "load" in called else (),
            contacts(linkage, mechanism.friction) if FRICTION in called else (),
            self._position,
        )

    def moving_points(self, angle: np.ndarray) -> dict[str, Moving]:
        """The points of the bodies at driver's angles, degrees: mm, mm/s, mm/s^2; rates where the driver has a speed."""
        stance, linkage = self.pose(np.radians(angle)), self.linkage
        points = [p for p in linkage.mechanism.points if p not in linkage.mechanism.ground]
        sliding = {s.name.removesuffix(" slide"): s for s in shown.turning_slides(linkage)}
        return {point: self._moving(point, stance, sliding.get(point)) for point in points}

    def _moving(self, point: str, stance: Stance, slide: SlideJoint | None) -> Moving:
        held = stance.linkage.owner(point)
        place = stance.place(held) / MM
        if not self.driver.speed:
            return Moving(place)
        speed, acceleration = self._speed, self._acceleration
        with np.errstate(all="ignore"):
            velocity = stance.rate(held) * speed / MM
            bent = (stance.bend(held) * speed**2 + stance.rate(held) * acceleration) / MM
            if slide is None:
                return Moving(place, velocity, bent)
            turning = 2j * stance.rates[slide.on] * speed**2 / MM
            return Moving(place, velocity, bent, turning * stance.sliding(slide) * stance.direction(slide))

    def _position(self, name: str, stance: Stance) -> np.ndarray:
        """A position of the exercise over the instants of a stance."""
        angle = np.degrees(stance.turns[self.linkage.driven])
        return np.asarray(self.exercise.solve(**self._driven(angle), only=name)[name])

    @cached_property
    def _flywheel(self) -> float:
        """Its moment of inertia, kg m^2; sized for the unevenness where that is what is said."""
        wheel = self.added.flywheel
        if wheel is None:
            raise WrongValue(
                "the effect 'flywheel' needs one: [flywheel] inertia = \"2 kg*m^2\", or unevenness = 0.02"
            )
        if wheel.inertia is not None:
            return wheel.inertia
        assert wheel.unevenness is not None  # one of the two is said
        if not self._speed:
            raise WrongValue(f"a flywheel is sized for a speed: {self.driver.speed} is 0 or not given")
        return self.excess_energy / (wheel.unevenness * self._speed**2)

    @cached_property
    def _turn_effort(self) -> np.ndarray:
        """The effort over a turn at the given speed, held constant, at equal steps."""
        angles = np.arange(_JUDGED) * (2 * np.pi / _JUDGED)
        without = self.without("flywheel")
        speed = np.full(_JUDGED, self._speed)
        return without.forces.over(angles, speed, np.zeros(_JUDGED)).effort

    @property
    def mean_torque(self) -> float:
        """Of the drive over a turn, N m."""
        return float(np.mean(self._turn_effort))

    @property
    def excess_energy(self) -> float:
        """The largest that a flywheel stores and gives back over a turn at the mean torque, J."""
        step = 2 * np.pi / _JUDGED
        stored = np.cumsum(self.mean_torque - self._turn_effort) * step
        return float(np.ptp(stored))

    # ----------------------------------------------------------------------- cycle

    def over_cycle(self, count: int = 360) -> Table:
        """The scene over one turn of the driver, ``count`` equal steps and the end.

        Angles are whole multiples of the step, never accumulated.
        """
        if count < 1:
            raise WrongValue(f"a cycle has at least one step; found {count}")
        driver, angle = self.driver.angle, np.arange(count + 1) * 360.0 / count
        columns = {driver: angle, **self._exercise_columns(self._driven(angle), angle.shape)}
        units = self._units(columns)
        speed, acceleration = (np.full(count + 1, v) for v in (self._speed, self._acceleration))
        for name, (values, unit) in self._extra_columns(np.radians(angle), speed, acceleration).items():
            columns[name], units[name] = np.broadcast_to(values, angle.shape), unit
        if len(columns) == 1:
            raise WrongValue(
                f"{self.exercise.name}: nothing to show for the effects {', '.join(self.effects)}"
            )
        return Table(columns, units, self._evaluated(), tuple(self._cycle_notes(columns, np.radians(angle))))

    def _exercise_columns(self, driven: Mapping[str, Any], shape: tuple[int, ...]) -> dict[str, np.ndarray]:
        constants = self.constants
        moving = tuple(n for n in self.quantities if n not in constants)
        found = self.exercise.solve(**driven, only=moving, effects=self._graph_effects) if moving else {}
        if constants:
            found |= self.exercise.solve(**self.given, only=tuple(constants), effects=self._graph_effects)
        if ADVANTAGE in self.effects and not self._of(ADVANTAGE):
            found |= self._advantage(driven)
        return {n: np.broadcast_to(found[n], shape) for n in dict.fromkeys([*self.quantities, *found])}

    def _advantage(self, driven: Mapping[str, Any]) -> dict[str, Any]:
        """Effort that comes out for effort that goes in: the driver's speed over that of its output."""
        output = self.driver.output
        if not output or not self.driver.speed:
            raise WrongValue(f"{self.exercise.name}: its driver names no output, so no advantage is known")
        speed = np.abs(np.asarray(self.exercise.solve(**driven, only=output)[output], dtype=float))
        with np.errstate(divide="ignore"):
            ratio = abs(self._speed) / speed
        return {ADVANTAGE: np.where(speed > 0, ratio * (1000.0 if self._output_slides else 1.0), np.nan)}

    @property
    def _output_slides(self) -> bool:
        return self.exercise.units.get(self.driver.output, "") == "mm/s"

    def _extra_columns(
        self, angles: np.ndarray, speed: np.ndarray, acceleration: np.ndarray
    ) -> shown.Columns:
        """What the mechanism tells, at driver's angles in radians."""
        if not self.extra:
            return {}
        if self.exercise.solution.mechanism is None:
            return self._points_of_solution(np.degrees(angles))
        kinds = [(name, *shown.what(name)) for name in self.extra]
        needs_joints = any(kind == shown.REACTION for _, kind, _ in kinds)
        needs_forces = needs_joints or any(not kind for _, kind, _ in kinds)
        stance = self.pose(angles) if any(kind in shown.OF_POINTS for _, kind, _ in kinds) else None
        borne = self.forces.over(angles, speed, acceleration, joints=needs_joints) if needs_forces else None
        found: shown.Columns = {}
        for name, kind, of in kinds:
            if kind == shown.REACTION and borne is not None:
                found |= shown.of_joint(of, self.linkage, borne)
            elif kind and stance is not None:
                found |= shown.of_point(kind, of, stance, speed, acceleration)
            elif borne is not None:
                found |= self._of_drive(name, borne, angles, speed)
        return found

    def _points_of_solution(self, angle: np.ndarray) -> shown.Columns:
        """The points that the solution itself moves: a mechanism in space states no bodies in a plane."""
        solution = self.exercise.solution
        assert solution.motion is not None  # without, there is nothing to show, and nothing is asked
        graph = solution.graph.with_functions({"motion": solution.motion})
        given = {**self._accepted, **self._driven(angle), self.driver.angle: angle}
        known = {n: v for n, v in given.items() if n in self.exercise.quantity_names | graph.leaves}
        points = graph.evaluate(("motion",), known, self._graph_effects)["motion"]
        found: shown.Columns = {}
        for kind, of in map(shown.what, self.extra):
            found |= shown.of_moving(kind, of, points[of])
        return found

    def _of_drive(self, name: str, borne: Borne, angles: np.ndarray, speed: np.ndarray) -> shown.Columns:
        if name == "drive_torque":
            return {name: (borne.effort, "N*m")}
        if name == "drive_power":
            return {name: (borne.effort * speed, "W")}
        inertia = self._moved().over(angles, 0 * speed, 0 * speed + 1.0).effort
        return {name: (0.5 * inertia * speed**2, "J")}

    def _moved(self) -> Forces:
        """Inertia alone, with the flywheel that is called."""
        return replace(self.forces, downwards=0j, inertia=True, loads=(), contacts=())

    def _cycle_notes(self, columns: Mapping[str, np.ndarray], angles: np.ndarray) -> Iterator[str]:
        yield from self._empty_effects()
        gaps = np.logical_or.reduce([np.isnan(column) for column in columns.values()])
        if not gaps.any():
            yield from self._flywheel_notes()
            return
        is_open = self._is_open(columns, angles)
        if is_open.any():
            yield f"the mechanism does not close at {int(is_open.sum())} of {len(gaps)} angles"
        if not (left := gaps & ~is_open).any():
            return
        listed = ", ".join(f"{angle:.6g}" for angle in np.degrees(angles[left])[:6])
        more = f" and {int(left.sum()) - 6} more" if left.sum() > 6 else ""
        if (
            FRICTION in self.effects
            and not np.isfinite(columns.get("drive_torque", gaps * np.nan)[left]).any()
        ):
            yield f"the mechanism jams at {self.driver.angle} = {listed} deg{more}: its friction outgrows what overcomes it"
        else:
            yield f"not everything exists at {self.driver.angle} = {listed} deg{more}: a dead centre"

    def _empty_effects(self) -> Iterator[str]:
        """Effects that are called and for which the scene has no data."""
        if self.exercise.solution.mechanism is None or (self._graph_effects and not self.added.is_own):
            return
        data = self.with_data()
        lacks = {
            "load": "no load",
            "gravity": "no mass",
            INERTIA: "no mass",
            FRICTION: "no friction at a joint",
        }
        for effect, what in lacks.items():
            if effect in self.effects and effect not in data:
                yield f"{effect}: the scene has {what}, so that it adds nothing; a scene file gives some"

    def _is_open(self, columns: Mapping[str, np.ndarray], angles: np.ndarray) -> np.ndarray:
        """Where a position of the mechanism does not exist."""
        positions = [columns[n] for n in self._of("position") if n in columns]
        if self.exercise.solution.mechanism is not None:
            positions += list(self.pose(angles).turns)
        elif not positions:
            positions = list(columns.values())
        return np.logical_or.reduce([np.isnan(position) for position in positions])

    def _flywheel_notes(self) -> Iterator[str]:
        """What the turn asks of a drive that gives a constant torque."""
        if self.added.flywheel is None or "flywheel" not in self.effects or not self._speed:
            return
        inertia = self._flywheel
        yield f"mean torque: {self.mean_torque:.6g} N*m"
        yield f"excess energy: {self.excess_energy:.6g} J"
        yield (
            f"flywheel: {inertia:.6g} kg*m^2 keeps an unevenness of "
            f"{self.excess_energy / (inertia * self._speed**2):.3g} at {abs(self._speed):.6g} rad/s, the other bodies' "
            "inertia as the effects say"
        )

    # ------------------------------------------------------------------------ time

    def running(self, drive: Motor) -> Running:
        """The equation of motion under a drive.

        Raises
        ------
        WrongValue
            The scene calls for no inertia.
        """
        if INERTIA not in self.effects and not ("flywheel" in self.effects and self.added.flywheel):
            raise WrongValue(
                "a motion in time needs the effect 'inertia': without mass nothing moves in time"
            )
        output = self._output_pace if self.driver.output and self.driver.speed else None
        return Running(self.forces, drive.at, output)

    def _output_pace(self, angles: np.ndarray) -> np.ndarray:
        """Rate of the output per unit of the driver's speed: 0 at a dead centre."""
        driver = self.driver
        rest = {driver.acceleration: 0.0} if driver.acceleration else {}
        given: dict[str, Any] = {**self._driven(np.degrees(angles)), driver.speed: 1.0, **rest}
        return np.broadcast_to(self.exercise.solve(**given, only=driver.output)[driver.output], angles.shape)

    def in_time(
        self, drive: Motor | float, duration: float, *, rtol: float = 1e-9, count: int = 500
    ) -> Table:
        """The motion from the given position and speed under its drive, a :class:`Motor` or a constant torque in N m.

        One degree of freedom: every position is computed from the driver's angle by the closed form, so that nothing
        drifts apart. Dead centres of the driver's ``output`` are rows of the table, marked in ``dead_centre``. With
        friction, or a load against the motion, the mechanism may come to rest and stay, or leave again.

        ``balance`` compares the kinetic energy with the work done, relative to the energy exchanged: the two come from
        different terms of the effort.

        Raises
        ------
        WrongValue
            The scene calls for no inertia, or a duration that is not positive.
        Undefined
            The motion reaches a place where the mechanism does not close or jams, or takes more steps than are allowed.
        """
        if not duration > 0 or not math.isfinite(duration):
            raise WrongValue(f"a duration is a positive number of seconds; found {duration}")
        motor = drive if isinstance(drive, Motor) else Motor(float(drive))
        running = self.running(motor)
        start = math.radians(self._start_angle)
        motion = running.run(start, self._speed, duration, rtol)
        t = np.union1d(np.arange(count + 1) * duration / count, motion.dead_centres)
        return self._motion_table(motion, running, motor, t)

    @property
    def _start_angle(self) -> float:
        try:
            return self.exercise.driver_angle(self._accepted)
        except CourseworkError as fault:
            raise WrongValue(f"a motion starts from {self.driver.angle}; it is not given ({fault})") from None

    def _motion_table(self, motion: Motion, running: Running, motor: Motor, t: np.ndarray) -> Table:
        (angle, speed, work), ways = motion.at(t)
        acceleration = np.array([
            running.acceleration(float(q), float(w), int(way)) if way else 0.0
            for q, w, way in zip(angle, speed, ways, strict=True)
        ])  # fmt: skip
        driver = self.driver
        moved = {driver.angle: np.degrees(angle), driver.speed or "speed": speed}
        moved[driver.acceleration or "acceleration"] = acceleration
        posed = {
            **self._driven(moved[driver.angle]),
            **{n: v for n, v in moved.items() if n in self.exercise.quantity_names},
        }
        effort = driver.effort
        columns = {"t": t, **moved}
        columns |= {n: v for n, v in self._exercise_columns(posed, t.shape).items() if n != effort}
        units = {**self._units(columns), "speed": "rad/s", "acceleration": "rad/s^2"}
        extra = self._extra_columns(angle, speed, acceleration)
        extra |= (
            {"drive_torque": (np.array([motor.at(w) for w in speed]), "N*m")}
            if "drive_torque" in extra
            else {}
        )
        stuck = (ways == 0) & bool(self.forces.contacts)
        for name, (values, unit) in extra.items():
            # At rest friction is whatever holds: what the joints bear is not determined.
            empty = stuck & (name.startswith(("R_", "N_", "M_", "Mf_", "T_")))
            columns[name], units[name] = np.where(empty, np.nan, np.broadcast_to(values, t.shape)), unit
        columns["dead_centre"] = np.isin(t, motion.dead_centres).astype(float)
        units["dead_centre"] = "1"
        inertia = running.table.over(angle)[0] + running.forces.flywheel
        kinetic = 0.5 * inertia * speed**2
        exchanged = max(float(np.ptp(kinetic)), float(np.ptp(work)), 1e-300)
        balance = float(np.max(np.abs(kinetic - kinetic[0] - work))) / exchanged
        notes = (
            *self._empty_effects(),
            f"energy balance: {balance:.1e} of the energy exchanged",
            *(f"the mechanism comes to rest at t = {start:.6g} s and stays" for start, _ in motion.stuck),
            counted(len(motion.dead_centres), "dead centre"),
        )
        return Table(columns, {n: units[n] for n in columns}, self._evaluated(), notes, balance)

    # ------------------------------------------------------------------------ told

    def _evaluated(self) -> tuple[str, ...]:
        wanted = [*self.quantities]
        if self.extra and self.exercise.solution.mechanism:
            wanted += [n for n in self.linkage.mechanism.angles if n in self.exercise.solution.graph.names]
        return self.evaluated(wanted)

    def evaluated(self, wanted: Sequence[str]) -> tuple[str, ...]:
        """The quantities that are evaluated for some, in order."""
        graph = self.exercise.solution.graph
        names = {**self.exercise.intake.defaults, **self._driven(0.0)}
        given = frozenset(names) & self.exercise.quantity_names
        plan = graph.plan(tuple(dict.fromkeys(wanted)), given, self._graph_effects)
        return tuple(name for name in plan if not name.startswith("_"))  # a hidden one is the solution's own

    def _units(self, names: Sequence[str] | Mapping[str, Any]) -> dict[str, str]:
        advantage = "1/m" if self._output_slides else "1"
        known = {"t": "s", ADVANTAGE: advantage, self.driver.angle: "deg", **self.exercise.units}
        return {n: known.get(n, "1") for n in names}
