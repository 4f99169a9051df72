"""Motion of a mechanism in time under its drive, with sticking and release.

One degree of freedom: I q'' + h q'^2 + g + loads + friction = what the drive gives. The functions of the
driver's angle in it are tabulated over the turn. The motion goes in *phases*, between the places where a
rubbing joint or a loaded point turns back, so that within each the equation is smooth. At rest the mechanism
stays while the drive lies between the efforts that would move it either way, and leaves on the side that the
drive exceeds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import Undefined
from coursework.mechanics.equilibrium import Equilibrium
from coursework.mechanics.forces import Forces
from coursework.mechanics.turn_table import TURN, TurnTable, Untabulated, tabulated
from coursework.mechanics.wrenches import BodyWrenches, inertia_at_rate, inertia_at_start, weight

MOST_PHASES = 20_000
#: Evaluations of the equation of motion before a run is called endless: see ``Running.cost``.
MOST_WORK = 2_000_000
_FAR = 1e9  #: radians: beyond, an angle has not the digits to place a mechanism
_SEARCH = 2048  #: places of the turn between which a pace may change its sign once
_BEYOND = 1e-3  #: radians beyond a turning place, where paces have the signs that they keep
_SAME = 1e-9  #: of a run: instants that are one

Drive = Callable[[float], float]  #: N m, by the driver's speed in rad/s


class _Instant(NamedTuple):
    """Driver's angle, speed and direction, the surplus of the drive over all but inertia and friction, and
    the inertia."""

    angle: float
    speed: float
    way: int
    lacking: float
    inertia: float


@dataclass(frozen=True)
class MotionPhase:
    """Interval of a motion: its start and end, the driver's direction (0: at rest), and the state in between:
    angle (radians), speed, work done so far."""

    start: float
    end: float
    way: int
    state: Callable[[np.ndarray], np.ndarray]
    dead: tuple[float, ...] = ()


@dataclass
class Trajectory:
    """Motion in time: consecutive phases, and the number of evaluations."""

    phases: list[MotionPhase] = field(default_factory=list)
    evaluations: int = 0

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the state at some instants.

        Parameters
        ----------
        t
            Instants, s, increasing, shape ``(n,)``.

        Returns
        -------
        The driver's angle, its speed and the work that became kinetic energy since the start: rad, rad/s, J,
        shape ``(3, n)``; and the driver's direction +1, -1 or 0, shape ``(n,)``.
        """
        result, ways = np.empty((3, len(t))), np.empty(len(t))
        starts = np.array([phase.start for phase in self.phases])
        which = np.clip(np.searchsorted(starts, t, side="right") - 1, 0, len(starts) - 1)
        for number in np.unique(which):
            in_phase = which == number
            result[:, in_phase] = self.phases[number].state(t[in_phase])
            ways[in_phase] = self.phases[number].way
        return result, ways

    @property
    def dead_centres(self) -> np.ndarray:
        """Instants at which the output reaches a dead centre, each once."""
        results = sorted(t for phase in self.phases for t in phase.dead)
        apart = _SAME * max(self.phases[-1].end, 1e-300) if self.phases else 0.0
        return np.array([t for k, t in enumerate(results) if not k or t - results[k - 1] > apart])

    @property
    def stuck(self) -> tuple[tuple[float, float], ...]:
        """Intervals of rest: start and end."""
        return tuple((p.start, p.end) for p in self.phases if p.way == 0)


class _Rows:
    """Positions of an equation's functions in its table."""

    def __init__(self, forces: Forces, with_output: bool) -> None:
        self.loads, self.contacts = len(forces.loads), len(forces.contacts)
        self.wrenches = 3 + self.loads + self.contacts
        self.normals = len(forces.rubbing.owner) if forces.contacts else 0
        followed = [number for number, acting in enumerate(forces.loads) if acting.follows]
        self.positions = {load: number for number, load in enumerate(followed)}
        first = self.wrenches * (1 + self.normals)
        self.paces = slice(first, first + self.loads + self.contacts)
        self.first_position = self.paces.stop
        self.output = self.first_position + len(self.positions) if with_output else None

    def borne(self, values: np.ndarray) -> np.ndarray:
        """Return the normal forces under each wrench, shape ``(wrenches, normals)``."""
        return values[self.wrenches : self.paces.start].reshape(self.wrenches, self.normals)


class Running:
    """Equation of motion of a mechanism under its forces.

    ``output``: the pace of what has dead centres, over driver's angles in radians; none without.
    """

    def __init__(
        self, forces: Forces, drive: Drive, output: Callable[[np.ndarray], np.ndarray] | None = None
    ) -> None:
        self.forces, self.drive, self.output = forces, drive, output
        self.rows = _Rows(forces, output is not None)
        self.work = 0
        self._near: np.ndarray | None = None  # the normal forces of an instant ago

    # ---------------------------------------------------------------------- table

    @cached_property
    def table(self) -> TurnTable | Untabulated:
        """Functions of the angle in the equation."""
        return tabulated(self._functions)

    @cached_property
    def cost(self) -> int:
        """Relative cost of an evaluation: several contacts require an iteration; without a table every body
        is posed anew."""
        return (10 if self.rows.normals > 1 else 1) * (1 if self.table.steps else 50)

    def _functions(self, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the tabulated functions at some angles, and the sizes of their terms.

        In order: the parts of inertia, its growth, gravity and unit loads in the drive's effort, then in the
        normal forces; the same of unit friction; the paces; the positions that loads follow.
        """
        forces = self.forces
        stance = forces.pose(angles)
        with np.errstate(all="ignore"):
            still = BodyWrenches.none(stance)
            wrenches = (
                [inertia_at_start(stance), inertia_at_rate(stance)] if forces.inertia else [still, still]
            )
            wrenches.append(weight(stance, forces.downwards))
            wrenches += [acting.pull(stance) for acting in forces.loads]
            wrenches += [contact.rubs(stance) for contact in forces.contacts]
            rows = [wrench.effort for wrench in wrenches]
            sizes = [wrench.size for wrench in wrenches]
            if forces.contacts:
                equations = Equilibrium(stance)
                under = equations.under(*wrenches)
                read = np.einsum("ku,nuw->wkn", forces.rubbing.reading(equations), under)
                rows += list(read.reshape(-1, len(angles)))
                largest = np.nanmax(np.abs(under), axis=(0, 1), initial=0.0)
                sizes += list(np.repeat(largest, self.rows.normals))
            rows += [acting.pace(stance) for acting in forces.loads]
            rows += [contact.rate(stance) for contact in forces.contacts]
            rows += [forces.loads[number].followed(angles) for number in self.rows.positions]
            if self.output is not None:
                rows.append(self.output(angles))
        result = np.array(rows)
        sizes += [max(stance.size, 1.0)] * (len(result) - len(sizes))
        return result, np.array(sizes)

    # --------------------------------------------------------------- at an instant

    def _sizes(self, angle: float, values: np.ndarray, signs: np.ndarray, direction: int) -> list[float]:
        """Return the loads along their lines, for the signs of their paces."""
        results = []
        together = zip(self.forces.loads, self.forces.strokes, signs.tolist(), strict=False)
        for number, (acting, when, sign) in enumerate(together):
            size = acting.constant
            if size is None:
                here = (
                    values[self.rows.first_position + self.rows.positions[number]] if acting.follows else None
                )
                size = float(acting.sizes(np.array(angle), here))
            results.append(float(when.along(size, sign, direction, against=acting.turns_over)))
        return results

    def acceleration(
        self, angle: float, speed: float, direction: int, signs: np.ndarray | None = None
    ) -> float:
        """Return the driver's acceleration.

        Parameters
        ----------
        angle, speed
            Those of the driver, rad and rad/s.
        direction
            Direction in which it moves, +1 or -1.
        signs
            Signs of the paces in a phase (:meth:`signs`); those at the angle if None.

        Returns
        -------
        The acceleration, rad/s^2.

        Raises
        ------
        Undefined
            The mechanism does not close, jams, or has no inertia there; or the run takes too many
            evaluations.
        """
        return self._balance(angle, speed, direction, signs)[0]

    def _balance(
        self, angle: float, speed: float, direction: int, signs: np.ndarray | None
    ) -> tuple[float, float]:
        """Return the acceleration, and the part of the drive that becomes kinetic energy, per radian."""
        self._count(angle)
        values = self.table.at(angle)
        efforts: list[float] = values[: self.rows.wrenches].tolist()
        inertia = efforts[0] + self.forces.flywheel
        lacking = self.drive(speed) - efforts[2]
        if not inertia > 0:
            raise Undefined(
                "the mechanism does not close at {angle:.6g} degrees, or a guide lies on its own pivot there"
                if inertia != inertia
                else "no inertia resists at {angle:.6g} degrees",
                angle=math.degrees(angle),
            )
        if self.rows.wrenches == 3:
            return (lacking - efforts[1] * speed * speed) / inertia, lacking
        if signs is None:
            signs = self.signs(angle, direction)
        sizes = self._sizes(angle, values, signs, direction)
        for size, effort in zip(sizes, efforts[3:], strict=False):
            lacking -= size * effort
        if self.rows.contacts:
            state = _Instant(angle, speed, direction, lacking, inertia)
            rubbed = self._rubbed(state, values, sizes, signs)
            if not math.isfinite(rubbed):
                raise Undefined(
                    "the mechanism jams at {angle:.6g} degrees of its driver: its friction grows "
                    "faster than what overcomes it",
                    angle=math.degrees(angle) % 360,
                )
            lacking -= rubbed
        return (lacking - efforts[1] * speed * speed) / inertia, lacking

    def _count(self, angle: float) -> None:
        if not abs(angle) < _FAR:
            raise Undefined(
                "the driver's angle passes {most:g} radians: it has no digits left to place the mechanism",
                most=_FAR,
            )
        self.work += self.cost
        if self.work > MOST_WORK:
            raise Undefined(
                "the motion takes more than {most} evaluations of its equation, by {angle:.6g} "
                "degrees; give a shorter duration",
                most=MOST_WORK // self.cost,
                angle=math.degrees(angle),
            )

    def _rubbed(self, at: _Instant, values: np.ndarray, sizes: Sequence[float], signs: np.ndarray) -> float:
        """Return the friction's part of the drive's effort, with the acceleration free; NaN where the
        mechanism jams."""
        if self.rows.normals == 1:
            return self._rubbed_by_one(at, values.tolist(), sizes, float(signs[self.rows.loads]))
        efforts, normals = values[: self.rows.wrenches], self.rows.borne(values)
        first = 3 + self.rows.loads
        start = (at.lacking - efforts[1] * at.speed**2) / at.inertia
        free = np.array([start, at.speed**2, 1.0, *sizes]) @ normals[:first]
        spread = -normals[first:].T + np.outer(normals[0], efforts[first:]) / at.inertia
        strength = signs[self.rows.loads :] * at.way * self.forces.rubbing.sizes
        rubs, self._near = self.forces.rubbing.one(free, spread, strength, self._near)
        if not np.isfinite(self._near).all():
            self._near = None
        return float(efforts[first:] @ rubs)

    def _rubbed_by_one(
        self, at: _Instant, values: Sequence[float], sizes: Sequence[float], sign: float
    ) -> float:
        """Return the friction's part for a single contact, in plain numbers, as most mechanisms have it."""
        n, first = self.rows.wrenches, 3 + self.rows.loads
        efforts, normals = values[:n], values[n : 2 * n]
        start = (at.lacking - efforts[1] * at.speed**2) / at.inertia
        free = start * normals[0] + at.speed**2 * normals[1] + normals[2]
        for size, normal in zip(sizes, normals[3:], strict=False):
            free += size * normal
        strength = sign * at.way * self.forces.contacts[0].size
        spread = -normals[first] + normals[0] * efforts[first] / at.inertia
        slope = 1.0 + spread * math.copysign(strength, strength * free)
        return efforts[first] * strength * abs(free) / slope if slope > 0 else math.nan

    def holding(self, angle: float) -> tuple[float, float]:
        """Return the range of drive efforts that do not move the mechanism from rest.

        Parameters
        ----------
        angle
            Angle of the driver, rad.

        Returns
        -------
        The least and the greatest effort, N m; infinite where the mechanism is self-locking.
        """
        low, high = (self._holding(angle, direction) for direction in (-1, 1))
        return low, high

    def _holding(self, angle: float, direction: int) -> float:
        values, signs = self.table.at(angle), self.signs(angle, direction)
        efforts, first = values[: self.rows.wrenches], 3 + self.rows.loads
        sizes = self._sizes(angle, values, signs, direction)
        effort = float(efforts[2] + np.dot(sizes, efforts[3:first]))
        if not self.rows.contacts:
            return effort
        self._near = None
        # At rest nothing accelerates, whatever is lacking: as with an inertia without end.
        rubbed = self._rubbed(_Instant(angle, 0.0, direction, 0.0, math.inf), values, sizes, signs)
        return effort + rubbed if math.isfinite(rubbed) else direction * math.inf

    # ---------------------------------------------------------------------- places

    @cached_property
    def turning_places(self) -> np.ndarray:
        """Angles of a turn, radians, at which a contact or a loaded point turns back, or a load's table has a
        corner."""
        knots = [float(np.mod(knot, TURN)) for acting in self.forces.loads for knot in acting.knots]
        rows = [
            self.rows.paces.start + number
            for number, acting in enumerate(self.forces.loads)
            if acting.turns_over or acting.load.during != "always"
        ]
        rows += range(self.rows.paces.start + self.rows.loads, self.rows.paces.stop)
        return np.array(sorted({*knots, *(zero for row in rows for zero in self._zeros(row))}))

    @cached_property
    def dead_places(self) -> np.ndarray:
        """Angles of a turn, radians, at which the output stands still."""
        return np.array(self._zeros(self.rows.output) if self.rows.output is not None else [])

    @cached_property
    def _sampled(self) -> tuple[np.ndarray, np.ndarray]:
        grid = (np.arange(_SEARCH + 1) + 0.37) * (TURN / _SEARCH)
        return grid, self.table.over(grid)

    def _zeros(self, row: int) -> list[float]:
        """Return the angles at which a function of the table changes sign."""
        from scipy.optimize import brentq

        grid, sampled = self._sampled
        results = [
            brentq(lambda q: float(self.table.at(q)[row]), grid[k], grid[k + 1], xtol=1e-15, rtol=1e-15)
            for k in _changes(sampled[row])
        ]
        return sorted(float(np.mod(zero, TURN)) for zero in results)

    @staticmethod
    def _unrolled(places: np.ndarray, low: float, high: float) -> np.ndarray:
        """Return the angles of every turn strictly between two bounds."""
        if not len(places):
            return places
        turns = np.arange(math.floor(low / TURN) - 1, math.floor(high / TURN) + 2)
        result = np.sort((places[None, :] + TURN * turns[:, None]).ravel())
        return result[(result > low + 1e-9) & (result < high - 1e-9)]

    def next_place(self, angle: float, direction: int) -> float:
        """Return the next turning place beyond an angle.

        Parameters
        ----------
        angle
            Angle of the driver, rad.
        direction
            Direction in which it moves, +1 or -1.

        Returns
        -------
        The angle, rad; infinite where there is none.
        """
        ahead = (angle, angle + 1.01 * TURN) if direction > 0 else (angle - 1.01 * TURN, angle)
        beyond = self._unrolled(self.turning_places, *ahead)
        return float(beyond[0] if direction > 0 else beyond[-1]) if len(beyond) else direction * math.inf

    def signs(self, angle: float, direction: int) -> np.ndarray:
        """Return the signs of the paces just beyond an angle; they hold up to the next turning place.

        Parameters
        ----------
        angle
            Angle of the driver, rad.
        direction
            Direction in which it moves, +1 or -1.

        Returns
        -------
        -1, 0 or 1 for each load and then each contact, of a driver that turns forward; empty without both.
        """
        if not self.forces.loads and not self.forces.contacts:
            return np.empty(0)
        room = min(abs(self.next_place(angle, direction) - angle) / 2, _BEYOND)
        return np.sign(self.table.at(angle + direction * room)[self.rows.paces])

    # ---------------------------------------------------------------------- phases

    def run(self, angle: float, speed: float, duration: float, rtol: float = 1e-9) -> Trajectory:
        """Return the motion from a state of the driver.

        Parameters
        ----------
        angle, speed
            The state, rad and rad/s.
        duration
            Time of the motion, s.
        rtol
            Relative tolerance of each step of the integration.

        Returns
        -------
        Phases up to the duration.

        Raises
        ------
        Undefined
            The mechanism jams, reaches a place where it does not close, or its motion takes too many steps.

        Source
        ------
        The Runge-Kutta method of order 8 of Dormand and Prince, as scipy has it (DOP853).
        """
        motion = Trajectory()
        state, t = np.array([angle, speed, 0.0]), 0.0
        self.work, self._near = 0, None
        self._count(angle)
        scales = (rtol, rtol * max(1.0, abs(speed)), rtol * self._energy(angle, speed, duration))
        while t < duration:
            if len(motion.phases) > MOST_PHASES:
                raise Undefined(
                    "the motion turns back more than {most} times, by t = {t:.6g} s", most=MOST_PHASES, t=t
                )
            direction = self._direction(state)
            phase, after = (
                self._stretch(t, duration, state, direction, rtol, scales)
                if direction
                else _rest(t, duration, state)
            )
            if direction and phase.end - t <= 1e-14 * duration and not state[1] and not after[1]:
                phase, after = _rest(t, duration, state)  # it would go, and comes to nothing
            motion.phases.append(phase)
            t, state = phase.end, after
        motion.evaluations = self.work // self.cost
        return motion

    def _energy(self, angle: float, speed: float, duration: float) -> float:
        """Return an energy as the scale of errors: the initial kinetic energy plus the work that the drive
        could do."""
        inertia = abs(float(self.table.at(angle)[0])) + self.forces.flywheel
        return 0.5 * inertia * speed**2 + abs(self.drive(speed) * speed) * duration + 1e-12

    def _direction(self, state: np.ndarray) -> int:
        """Return the direction in which a state moves on: 0 where it stays."""
        if state[1]:
            return 1 if state[1] > 0 else -1
        angle, drive = float(state[0]), self.drive(0.0)
        if not self.forces.resists:
            start = self.acceleration(angle, 0.0, 1)
            return 1 if start > 0 else -1 if start < 0 else 0
        low, high = self.holding(angle)
        return 1 if drive > high else -1 if drive < low else 0

    def _stretch(
        self,
        t: float,
        duration: float,
        state: np.ndarray,
        direction: int,
        rtol: float,
        scales: tuple[float, ...],
    ) -> tuple[MotionPhase, np.ndarray]:
        """Integrate to the next turning place, to rest, or to the end."""
        from scipy.integrate import solve_ivp

        angle = float(state[0])
        position, signs = self.next_place(angle, direction), self.signs(angle, direction)

        def derivative(_: float, y: np.ndarray) -> list[float]:
            acceleration, lacking = self._balance(y[0], y[1], direction, signs)
            return [y[1], acceleration, lacking * y[1]]

        ends = [_ending(lambda _, y: y[1] * direction, -1.0)]
        if math.isfinite(position):
            ends.append(_ending(lambda _, y: (y[0] - position) * direction, 1.0))
        solved = solve_ivp(
            derivative,
            (t, duration),
            state,
            method="DOP853",
            rtol=rtol,
            atol=scales,
            dense_output=True,
            events=ends,
        )
        if solved.status < 0:
            raise Undefined(
                "the motion stops at t = {t:.6g} s, at {angle:.6g} degrees: the acceleration grows "
                "without bound, since hardly any inertia resists there; give the crank one",
                t=solved.t[-1],
                angle=math.degrees(solved.y[0, -1]),
            )
        end, last = float(solved.t[-1]), solved.y[:, -1].copy()
        if solved.status == 1:
            at_rest = bool(len(solved.t_events[0]))
            last[1 if at_rest else 0] = 0.0 if at_rest else position
        return MotionPhase(
            t, end, direction, solved.sol, self._dead(solved.sol, t, end, angle, float(last[0]))
        ), last

    def _dead(
        self, state: Callable[[float], np.ndarray], start: float, end: float, angle: float, last: float
    ) -> tuple[float, ...]:
        """Return the instants at which the output stands still, in a phase in which the driver never turns
        back."""
        from scipy.optimize import brentq

        low, high = min(angle, last), max(angle, last)
        places = self._unrolled(self.dead_places, low - 2e-9, high + 2e-9)
        results = []
        for position in places:
            before, after = (float(state(t)[0]) - position for t in (start, end))
            if before * after < 0:
                results.append(
                    float(
                        brentq(
                            lambda t, p=position: float(state(t)[0]) - p,
                            start,
                            end,
                            xtol=1e-15 * max(end, 1e-9),
                        )
                    )
                )
            elif abs(after) <= 1e-9 and abs(before) > 1e-9:
                results.append(end)
        return tuple(results)


def _rest(t: float, duration: float, state: np.ndarray) -> tuple[MotionPhase, np.ndarray]:
    """Return a phase of rest to the end: under a drive that depends on the speed alone nothing changes."""
    still = np.array([state[0], 0.0, state[2]])
    return MotionPhase(t, duration, 0, lambda at: np.repeat(still[:, None], len(at), axis=1)), still


def _changes(values: np.ndarray) -> Iterator[int]:
    """Return the indices at which a sampled function changes sign before the next sample."""
    with np.errstate(invalid="ignore"):
        return iter(np.flatnonzero(values[:-1] * values[1:] < 0).tolist())


def _ending(function: Callable[[float, Any], float], direction: float) -> Callable[[float, Any], float]:
    function.terminal = True  # type: ignore[attr-defined]  # as the integrator reads it
    function.direction = direction  # type: ignore[attr-defined]
    return function
