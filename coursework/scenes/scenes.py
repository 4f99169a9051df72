"""Scenes: an exercise's mechanism, its data, and the requested effects.

A scene that calls for less runs less: its columns are the quantities of the effects named, and the quantity
graph evaluates what those need and nothing else; forces come from the mechanism that the solution states, the
effort alone by virtual power, what joints bear only where it is asked.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coursework.errors import CourseworkError, Undefined, WrongValue, counted
from coursework.mechanics.running import Running, Trajectory
from coursework.messages import Message
from coursework.scenes.added import Motor
from coursework.scenes.effects import OF_FORCES, check_turns
from coursework.scenes.showing import Showing
from coursework.scenes.staged import FLYWHEEL, FRICTION, INERTIA
from coursework.system.limits import MOST_STEPS

_MOST_ASKED = 500  #: angles at which it is asked why a position does not exist


@dataclass(frozen=True)
class SceneTable:
    """Columns of equal length, with their units."""

    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    evaluated: tuple[str, ...]  #: the quantities that the scene evaluated, in order
    notes: tuple[str, ...] = ()
    balance: float = math.nan  #: largest energy balance error over the energy exchanged; for motions in time

    def rows(self, every: int = 1) -> list[dict[str, Any]]:
        """Return every ``every``-th instant as a row; headers carry units, cells are empty where a value does
        not exist."""
        heads = [f"{name} [{self.units[name]}]" for name in self.columns]
        values = zip(*(c[::every].tolist() for c in self.columns.values()), strict=True)
        return [{h: v if math.isfinite(v) else "" for h, v in zip(heads, row, strict=True)} for row in values]

    def __len__(self) -> int:
        """Return the number of instants."""
        return len(next(iter(self.columns.values())))


@dataclass(frozen=True)
class Scene(Showing):
    """Mechanism with its data and the requested effects.

    Attributes
    ----------
    given
        Values of the exercise's given quantities, numbers in canonical units or texts with a unit.
    effects
        ``position``, ``velocity``, ``acceleration``, ``coriolis``, ``advantage``, ``load``, ``gravity``,
        ``inertia``, ``friction``, ``flywheel``; positions alone without any.
    show
        What else is shown: quantities of the exercise, ``drive_torque``, ``reaction B``, ``velocity B`` …
    added
        Masses, loads, friction, a flywheel.

    Raises
    ------
    UnknownName
        An effect, or a quantity to show, does not exist.
    WrongValue
        An effect of which this mechanism has nothing.
    """

    # ----------------------------------------------------------------------- cycle

    def over_cycle(self, count: int = 360) -> SceneTable:
        """Return the scene over one turn of the driver, or over the travel of a jack: ``count`` equal steps
        and the end.

        Positions are whole multiples of the step, never accumulated.
        """
        if not 1 <= count <= MOST_STEPS:
            raise WrongValue(
                "a cycle has from 1 to {most:g} steps; found {count:g}; take fewer",
                most=MOST_STEPS,
                count=count,
            )
        columns, units = self.columns(self.steps(count))
        angles = self.driver_motion(columns[self.driver.moved], moving=False)[0]
        if len(columns) == 1:
            raise WrongValue(
                "{exercise}: nothing to show for the effects {effects}",
                exercise=self.exercise.name,
                effects=", ".join(self.effects),
            )
        return SceneTable(columns, units, self._evaluated(), tuple(self._cycle_notes(columns, angles)))

    def columns(self, at: np.ndarray) -> tuple[dict[str, np.ndarray], dict[str, str]]:
        """Return what the scene shows, and its units, at positions of the driver, shape ``(n,)``: degrees, or
        mm of a jack."""
        columns = {self.driver.moved: at, **self._exercise_columns(self._at(at), at.shape)}
        units = self._units(columns)
        angles, speed, acceleration = self.driver_motion(at, moving=bool(self.extra))
        for name, (values, unit) in self._extra_columns(angles, speed, acceleration).items():
            columns[name], units[name] = np.broadcast_to(values, at.shape), unit
        return columns, units

    def steps(self, count: int) -> np.ndarray:
        """Return the positions of a cycle: degrees of a turn, or lengths between the limits of the jack,
        mm."""
        if (jack := self.driver.jack) is None:
            return np.arange(count + 1) * 360.0 / count
        for name in jack.limits:
            if name not in self._accepted:
                raise WrongValue(
                    "a cycle runs between {first} and {last}; {name} is not given",
                    first=jack.limits[0],
                    last=jack.limits[1],
                    name=name,
                )
        shortest, longest = (float(self._accepted[name]) for name in jack.limits)
        if not 0 < shortest < longest:
            raise WrongValue(
                "a jack grows from {first}, its shortest, to {last}, its longest; found {shortest:.6g} "
                "mm and {longest:.6g} mm",
                first=jack.limits[0],
                last=jack.limits[1],
                shortest=shortest,
                longest=longest,
            )
        return np.linspace(shortest, longest, count + 1)

    def _cycle_notes(self, columns: Mapping[str, np.ndarray], angles: np.ndarray) -> Iterator[str]:
        yield from self._empty_effects()
        driver, at = self.driver, columns[self.driver.moved]
        name, unit = driver.moved, self._units((driver.moved,))[driver.moved]
        if (jack := driver.jack) is not None:
            yield Message(
                "{name} goes from {shortest:.6g} mm ({first}, the jack is shortest) to {longest:.6g} "
                "mm ({last}, it is longest)",
                name=name,
                shortest=at[0],
                first=jack.limits[0],
                longest=at[-1],
                last=jack.limits[1],
            )
        speed = (jack or driver).speed
        if not self._value(speed) and self._resists:
            yield (
                f"at rest ({speed or 'no speed'} = 0) friction, and loads against the motion, have no "
                "way to go against: "
                "they add nothing"
            )
        gaps = np.logical_or.reduce([np.isnan(column) for column in columns.values()])
        if not gaps.any():
            yield from self._flywheel_notes()
            return
        is_open = self._is_open(columns, angles)
        yield from self._open_notes(columns, at[is_open], len(gaps))
        if not (left := gaps & ~is_open).any():
            return
        listed = ", ".join(f"{value:.6g}" for value in at[left][:6])
        more = f" and {int(left.sum()) - 6} more" if left.sum() > 6 else ""
        if (
            FRICTION in self.effects
            and not np.isfinite(columns.get(self._effort_name, gaps * np.nan)[left]).any()
        ):
            yield (
                f"the mechanism jams at {name} = {listed} {unit}{more}: its friction outgrows what "
                "overcomes it"
            )
        else:
            yield f"not everything exists at {name} = {listed} {unit}{more}: a dead centre"

    def _open_notes(self, columns: Mapping[str, np.ndarray], at: np.ndarray, of: int) -> Iterator[str]:
        """Say why positions do not exist at some angles: loops do not close, or a place is undefined by
        itself."""
        names = tuple(name for name in columns if name in self.exercise.quantity_names)
        undefined: dict[str, list[str]] = {}
        for value in at[:_MOST_ASKED]:
            try:
                self.exercise.solve(**self._at(float(value)), only=names, effects=())
            except Undefined as fault:
                undefined.setdefault(str(fault), []).append(f"{value:.6g}")
            except CourseworkError:
                pass
        for why, where in undefined.items():
            more = f" and {len(where) - 6} more" if len(where) > 6 else ""
            name = self.driver.moved
            yield f"{why}, at {name} = {', '.join(where[:6])} {self._units((name,))[name]}{more}"
        if left := len(at) - sum(map(len, undefined.values())):
            yield (
                f"the mechanism does not close at {left} of {of} "
                f"{'lengths' if self.driver.jack else 'angles'}"
            )

    def _empty_effects(self) -> Iterator[str]:
        """Yield the requested effects for which the scene has no data."""
        if self.exercise.solution.mechanism is None or (self._graph_effects and not self.has_own_data):
            return
        data = self.with_data()
        lacks = {
            "load": "no load",
            "gravity": "no mass",
            INERTIA: "no mass",
            FRICTION: "no friction at a joint",
        }
        for effect, lacking in lacks.items():
            if effect in self.effects and effect not in data:
                yield f"{effect}: the scene has {lacking}, so that it adds nothing; a scene file gives some"

    @property
    def _resists(self) -> bool:
        """True if a force or a moment opposes the motion."""
        if self.exercise.solution.mechanism is None:
            return False
        return bool(self.contacts) or (
            "load" in self.effects and any(m.against for m in self.mechanism.loads)
        )

    def _is_open(self, columns: Mapping[str, np.ndarray], angles: np.ndarray) -> np.ndarray:
        """Return a mask of the instants at which a position of the mechanism does not exist."""
        positions = [columns[n] for n in self._of("position") if n in columns]
        if self.exercise.solution.mechanism is not None:
            positions += list(self.pose(angles).turns)
        elif not positions:
            positions = list(columns.values())
        return np.logical_or.reduce([np.isnan(position) for position in positions])

    def _flywheel_notes(self) -> Iterator[str]:
        """Yield the mean torque, the excess energy and the flywheel of a turn at constant torque."""
        if self.added.flywheel is None or FLYWHEEL not in self.effects or not self._speed:
            return
        yield f"mean torque: {self.evenness.mean_torque:.4g} N*m"
        yield f"excess energy: {self.evenness.excess_energy:.4g} J"
        yield (
            f"flywheel: {self.flywheel:.4g} kg*m^2 keeps an unevenness of "
            f"{self.evenness.unevenness_of(self.flywheel):.3g} at {abs(self._speed):.6g} rad/s, beside "
            "the inertia of the "
            "other bodies as the effects say"
        )

    # ------------------------------------------------------------------------ time

    def running(self, drive: Motor) -> Running:
        """Return the equation of motion under a drive.

        Raises
        ------
        WrongValue
            The scene calls for no inertia, or a jack drives.
        """
        check_turns("a torque in time", self.exercise)
        moves = INERTIA in self.effects and bool(self.linkage.masses)
        if not moves and FLYWHEEL not in self.effects:
            has = (
                Message("no body has a mass; a scene file gives some")
                if INERTIA in self.effects
                else Message("without mass nothing moves in time")
            )
            raise WrongValue("a motion in time needs the effect 'inertia': {has}", has=has)
        output = self._output_pace if self.driver.output and self.driver.speed else None
        return Running(self.forces, drive.at, output)

    def _output_pace(self, angles: np.ndarray) -> np.ndarray:
        """Return the rate of the output per unit of the driver's speed: 0 at a dead centre."""
        output, given = self.driver.output, self._at_unit_speed(np.degrees(angles))
        return np.broadcast_to(self.exercise.solve(**given, only=output, effects=())[output], angles.shape)

    def in_time(
        self, drive: Motor | float, duration: float, *, rtol: float = 1e-9, count: int = 500
    ) -> SceneTable:
        """Return the motion from the given position and speed under its drive, a :class:`Motor` or a constant
        torque in N m.

        One degree of freedom: every position is computed from the driver's angle by the closed form, so that
        nothing drifts apart. Dead centres of the driver's ``output`` are rows of the table, marked in
        ``dead_centre``. With friction, or a load against the motion, the mechanism may come to rest and stay,
        or leave again.

        ``balance`` compares the kinetic energy with the work done, relative to the energy exchanged: the two
        come from different terms of the effort.

        Raises
        ------
        WrongValue
            The scene calls for no inertia, or a duration that is not positive.
        Undefined
            The motion reaches a place where the mechanism does not close or jams, or takes more steps than
            are allowed.
        """
        if not duration > 0 or not math.isfinite(duration):
            raise WrongValue(
                "a duration is a positive number of seconds; found {duration}", duration=duration
            )
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
            raise WrongValue(
                "a motion starts from {angle}; it is not given ({fault})",
                angle=self.driver.angle,
                fault=fault,
            ) from None

    def _motion_table(self, motion: Trajectory, running: Running, motor: Motor, t: np.ndarray) -> SceneTable:
        (angle, speed, work), ways = motion.at(t)
        acceleration = np.array(
            [
                running.acceleration(float(q), float(w), int(direction)) if direction else 0.0
                for q, w, direction in zip(angle, speed, ways, strict=True)
            ]
        )
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
        # What starts from rest goes against friction and loads already: its way, at next to no speed.
        extra = self._extra_columns(angle, np.where(speed == 0, 1e-150 * ways, speed), acceleration)
        extra |= (
            {"drive_torque": (np.array([motor.at(w) for w in speed]), "N*m")}
            if "drive_torque" in extra
            else {}
        )
        for name, (values, unit) in extra.items():
            columns[name], units[name] = np.broadcast_to(values, t.shape), unit
        # At rest friction is whatever holds: what the joints bear is not determined.
        stuck = (ways == 0) & bool(self.contacts)
        borne = {*self._of(OF_FORCES), *(n for n in extra if n.startswith(("R_", "N_", "M_", "Mf_", "T_")))}
        columns |= {n: np.where(stuck, np.nan, columns[n]) for n in borne & set(columns)}
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
        return SceneTable(columns, {n: units[n] for n in columns}, self._evaluated(), notes, balance)
