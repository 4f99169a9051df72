"""A mechanism left to itself under its drive: its motion in time, with sticking and leaving.

One degree of freedom: I q'' + h q'^2 + g + loads + friction = what the drive gives. The functions of the driver's angle
in it are tabulated over the turn. The motion goes in *phases*, between the places where a rubbing joint or a loaded point
turns back, so that within each the equation is smooth. At rest the mechanism stays while the drive lies between the
efforts that would move it either way, and leaves on the side that the drive exceeds.
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
from coursework.mechanics.rates import Stance
from coursework.mechanics.turn_table import TURN, TurnTable, Untabulated, tabulated
from coursework.mechanics.wrenches import inertia_at_rate, inertia_at_start, weight

MOST_PHASES = 20_000
MOST_STEPS = 2_000_000  #: evaluations of the equation of motion, before a run is called endless
_SEARCH = 2048  #: places of the turn between which a pace may change its sign once

Drive = Callable[[float], float]  #: N m, by the driver's speed in rad/s


class _Instant(NamedTuple):
    """A driver's angle, speed and way, what its drive gives beyond all but inertia and friction, and the inertia."""

    angle: float
    speed: float
    way: int
    lacking: float
    inertia: float


@dataclass(frozen=True)
class Phase:
    """A stretch of a motion: from one instant to another, the way the driver turns (0: at rest), and its state in between:
    angle (radians), speed, work done so far."""

    start: float
    end: float
    way: int
    state: Callable[[np.ndarray], np.ndarray]
    dead: tuple[float, ...] = ()


@dataclass
class Motion:
    """A motion in time: phases one after another, and what it took."""

    phases: list[Phase] = field(default_factory=list)
    evaluations: int = 0

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The state at increasing instants, shape ``(3, n)``, and the way the driver turns."""
        found, ways = np.empty((3, len(t))), np.empty(len(t))
        starts = np.array([phase.start for phase in self.phases])
        which = np.clip(np.searchsorted(starts, t, side="right") - 1, 0, len(starts) - 1)
        for number in np.unique(which):
            own = which == number
            found[:, own] = self.phases[number].state(t[own])
            ways[own] = self.phases[number].way
        return found, ways

    @property
    def dead_centres(self) -> np.ndarray:
        return np.array(sorted({t for phase in self.phases for t in phase.dead}))

    @property
    def stuck(self) -> tuple[tuple[float, float], ...]:
        """When the mechanism stood still: start and end."""
        return tuple((p.start, p.end) for p in self.phases if p.way == 0)


class Running:
    """The equation of motion of a mechanism under its forces.

    ``output``: the pace of what has dead centres, over driver's angles in radians; none without.
    """

    def __init__(
        self, forces: Forces, drive: Drive, output: Callable[[np.ndarray], np.ndarray] | None = None
    ) -> None:
        self.forces, self.drive, self.output = forces, drive, output
        self.count_loads, self.count_contacts = len(forces.loads), len(forces.contacts)
        self.evaluations = 0

    # ---------------------------------------------------------------------- table

    @cached_property
    def table(self) -> TurnTable | Untabulated:
        """The functions of the angle that the equation needs."""
        return tabulated(self._functions)

    def _functions(self, angles: np.ndarray) -> np.ndarray:
        """Inertia, its growth, gravity and unit loads: what each asks of the drive, then of the contacts; unit friction the
        same; the paces."""
        stance = self.forces.pose(angles)
        with np.errstate(all="ignore"):
            wrenches = [
                inertia_at_start(stance),
                inertia_at_rate(stance),
                weight(stance, self.forces.downwards),
            ]
            wrenches += [acting.pull(stance) for acting in self.forces.loads]
            wrenches += [contact.rubs(stance) for contact in self.forces.contacts]
            rows = [wrench.effort for wrench in wrenches]
            if self.forces.contacts:
                equations = Equilibrium(stance)
                reading = self.forces.rubbing.reading(equations)
                read = np.einsum("ku,nuw->wkn", reading, equations.under(*wrenches))
                rows += list(read.reshape(-1, len(angles)))
            rows += self._paces(stance)
            if self.output is not None:
                rows.append(self.output(angles))
        return np.array(rows)

    def _paces(self, stance: Stance) -> list[np.ndarray]:
        loads = [acting.pace(stance) for acting in self.forces.loads]
        return loads + [contact.rate(stance) for contact in self.forces.contacts]

    @cached_property
    def _wrenches(self) -> int:
        return 3 + self.count_loads + self.count_contacts

    @cached_property
    def _normals(self) -> int:
        return len(self.forces.rubbing.owner) if self.forces.contacts else 0

    def _parts(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Efforts, normal forces by wrench, and paces: of values of the table."""
        n, k = self._wrenches, self._normals
        paces = values[n * (1 + k) : n * (1 + k) + self.count_loads + self.count_contacts]
        return values[:n], values[n : n * (1 + k)].reshape(n, k), paces

    # --------------------------------------------------------------- at an instant

    def _sizes(self, angle: float, paces: np.ndarray, way: int) -> list[float]:
        """The loads along their lines."""
        found = []
        for acting, when, pace in zip(self.forces.loads, self.forces.strokes, paces, strict=False):
            if acting.load.table:
                where = np.array([angle])
                size = float(acting.sizes(self.forces.pose(where), where, self.forces.by)[0])  # type: ignore[arg-type]
            else:
                size = acting.size
            sign = math.copysign(1.0, pace) if pace else 0.0
            if when.way and sign != when.way:
                size = 0.0
            found.append(-size * sign * way if acting.turns_over else size)
        return found

    def acceleration(self, angle: float, speed: float, way: int, signs: np.ndarray | None = None) -> float:
        """Of the driver, rad/s^2, at an angle (radians) and a speed, turning a way; ``signs`` of the paces in a phase.

        Raises
        ------
        Undefined
            The mechanism does not close, jams, or has no inertia there.
        """
        return self._balance(angle, speed, way, signs)[0]

    def _balance(self, angle: float, speed: float, way: int, signs: np.ndarray | None) -> tuple[float, float]:
        """The acceleration, and what goes of the drive into the kinetic energy: per radian, without the inertia's."""
        self.evaluations += 1
        if self.evaluations > MOST_STEPS:
            raise Undefined(
                f"the motion takes more than {MOST_STEPS} evaluations of its equation, at {math.degrees(angle):.6g} degrees; "
                "give a shorter duration or a looser tolerance"
            )
        values = self.table.at(angle)
        efforts: list[float] = values[: self._wrenches].tolist()
        inertia = efforts[0] + self.forces.flywheel
        lacking = self.drive(speed) - efforts[2]
        if not inertia > 0:
            raise Undefined(
                f"no inertia resists at {math.degrees(angle):.6g} degrees, or the mechanism does not close"
            )
        if not self.count_loads and not self.count_contacts:
            return (lacking - efforts[1] * speed * speed) / inertia, lacking
        paces = self._parts(values)[2] if signs is None else signs
        sizes = self._sizes(angle, paces, way)
        for size, effort in zip(sizes, efforts[3:], strict=False):
            lacking -= size * effort
        if self.count_contacts:
            state = _Instant(angle, speed, way, lacking, inertia)
            rubbed = self._rubbed(state, values, sizes, paces)
            if not math.isfinite(rubbed):
                raise Undefined(
                    f"the mechanism jams at {math.degrees(angle) % 360:.6g} degrees of its driver: its friction grows "
                    "faster than what overcomes it"
                )
            lacking -= rubbed
        return (lacking - efforts[1] * speed * speed) / inertia, lacking

    def _rubbed(self, at: _Instant, values: np.ndarray, sizes: Sequence[float], paces: np.ndarray) -> float:
        """What friction asks of the drive, the acceleration being free; NaN where the mechanism jams."""
        if self._normals == 1:
            return self._rubbed_by_one(at, values.tolist(), sizes, float(paces[self.count_loads]))
        efforts, normals, _ = self._parts(values)
        first = 3 + self.count_loads
        start = (at.lacking - efforts[1] * at.speed**2) / at.inertia
        free = np.array([start, at.speed**2, 1.0, *sizes]) @ normals[:first]
        spread = -normals[first:].T + np.outer(normals[0], efforts[first:]) / at.inertia
        sense = np.sign(paces[self.count_loads :]) * at.way
        return float(efforts[first:] @ self._balanced(free, spread, sense))

    def _rubbed_by_one(
        self, at: _Instant, values: Sequence[float], sizes: Sequence[float], pace: float
    ) -> float:
        """The same where one place rubs on one side or the other: in numbers, as most mechanisms have it."""
        n, first = self._wrenches, 3 + self.count_loads
        efforts, normals = values[:n], values[n : 2 * n]
        start = (at.lacking - efforts[1] * at.speed**2) / at.inertia
        free = start * normals[0] + at.speed**2 * normals[1] + normals[2]
        for size, normal in zip(sizes, normals[3:], strict=False):
            free += size * normal
        strength = (at.way if pace > 0 else -at.way if pace < 0 else 0) * self.forces.contacts[0].size
        spread = -normals[first] + normals[0] * efforts[first] / at.inertia
        slope = 1.0 + spread * math.copysign(strength, strength * free)
        return efforts[first] * strength * abs(free) / slope if slope > 0 else math.nan

    def _balanced(self, free: np.ndarray, spread: np.ndarray, sense: np.ndarray) -> np.ndarray:
        """What the contacts rub with, at one instant."""
        return self.forces.rubbing.balanced(free[None], spread[None], sense[None])[0]

    def holding(self, angle: float) -> tuple[float, float]:
        """The efforts between which the drive does not move the mechanism from rest, N m; infinite where it locks itself."""
        found = []
        for way in (-1, 1):
            efforts, normals, paces = self._parts(self.table.at(angle))
            sizes = self._sizes(angle, paces, way)
            effort = float(efforts[2] + np.dot(sizes, efforts[3 : 3 + self.count_loads]))
            if self.count_contacts:
                first = 3 + self.count_loads
                free = np.array([0.0, 0.0, 1.0, *sizes]) @ normals[:first]
                rubs = self._balanced(free, -normals[first:].T, np.sign(paces[self.count_loads :]) * way)
                rubbed = float(efforts[first:] @ rubs)
                effort = effort + rubbed if math.isfinite(rubbed) else way * math.inf
            found.append(effort)
        return found[0], found[1]

    # ---------------------------------------------------------------------- phases

    @cached_property
    def turning_places(self) -> np.ndarray:
        """Angles of a turn, radians, where what rubs or is loaded turns back, or a load's table has a corner."""
        knots = [np.mod(knot, TURN) for acting in self.forces.loads for knot in acting.knots]
        rows = [
            number
            for number, acting in enumerate(self.forces.loads)
            if acting.turns_over or acting.load.during != "always"
        ]
        rows += range(self.count_loads, self.count_loads + self.count_contacts)
        if not rows:
            return np.array(sorted(knots))
        grid = (np.arange(_SEARCH + 1) + 0.37) * (TURN / _SEARCH)
        paces = np.array([self._parts(v)[2] for v in self.table.over(grid).T]).T
        found = [self._zero(row, grid[k], grid[k + 1]) for row in rows for k in _changes(paces[row])]
        return np.array(sorted({*knots, *(z % TURN for z in found)}))

    def _zero(self, row: int, low: float, high: float) -> float:
        from scipy.optimize import brentq

        return float(
            brentq(lambda q: self._parts(self.table.at(q))[2][row], low, high, xtol=1e-15, rtol=1e-15)
        )

    def _next_place(self, angle: float, way: int) -> float:
        """The next of the turning places, strictly beyond an angle."""
        places = self.turning_places
        if not len(places):
            return way * math.inf
        turn = math.floor(angle / TURN)
        near = np.concatenate([places + (turn + k) * TURN for k in (-1, 0, 1)])
        beyond = near[(near - angle) * way > 1e-9]
        return float(beyond.min() if way > 0 else beyond.max())

    def run(self, angle: float, speed: float, duration: float, rtol: float = 1e-9) -> Motion:
        """The motion from an angle (radians) and a speed (rad/s), for a duration (s).

        Raises
        ------
        Undefined
            The mechanism jams, reaches a place where it does not close, or its motion takes too many steps.
        """
        motion = Motion()
        state, t = np.array([angle, speed, 0.0]), 0.0
        self.evaluations = 0
        scales = (rtol, rtol * max(1.0, abs(speed)), rtol * self._energy(angle, speed, duration))
        while t < duration:
            if len(motion.phases) > MOST_PHASES:
                raise Undefined(f"the motion turns back more than {MOST_PHASES} times, by t = {t:.6g} s")
            way = self._way(state)
            phase, state = (
                self._rest(t, duration, state)
                if way == 0
                else self._stretch(t, duration, state, way, rtol, scales)
            )
            motion.phases.append(phase)
            t = phase.end
        motion.evaluations = self.evaluations
        return motion

    def _energy(self, angle: float, speed: float, duration: float) -> float:
        """An energy to measure errors by: what the motion starts with, and what the drive could do."""
        inertia = abs(float(self.table.at(angle)[0])) + self.forces.flywheel
        return 0.5 * inertia * speed**2 + abs(self.drive(speed) * speed) * duration + 1e-12

    def _way(self, state: np.ndarray) -> int:
        """Which way a state moves on: 0 where it stays."""
        if state[1]:
            return 1 if state[1] > 0 else -1
        low, high = self.holding(float(state[0]))
        drive = self.drive(0.0)
        if not self.forces.resists:
            return 1 if self.acceleration(float(state[0]), 0.0, 1) >= 0 else -1
        return 1 if drive > high else -1 if drive < low else 0

    @staticmethod
    def _rest(t: float, duration: float, state: np.ndarray) -> tuple[Phase, np.ndarray]:
        """Nothing changes at rest under a drive that depends on the speed alone."""
        still = state.copy()
        return Phase(t, duration, 0, lambda at: np.repeat(still[:, None], len(at), axis=1)), still

    def _stretch(
        self, t: float, duration: float, state: np.ndarray, way: int, rtol: float, scales: tuple[float, ...]
    ) -> tuple[Phase, np.ndarray]:
        """On to the next turning place, to rest, or to the end."""
        from scipy.integrate import solve_ivp

        resists = self.forces.resists
        place = (
            self._next_place(float(state[0]), way) if resists or len(self.turning_places) else way * math.inf
        )
        signs = self._signs(float(state[0]), place) if math.isfinite(place) else None

        def derivative(_: float, y: np.ndarray) -> list[float]:
            acceleration, lacking = self._balance(y[0], y[1], way, signs)
            return [y[1], acceleration, lacking * y[1]]

        events, ends = [], []
        if self.output is not None:
            events.append(lambda _, y: float(self.table.at(y[0])[-1]))
        if math.isfinite(place):
            ends.append(_ending(lambda _, y: (y[0] - place) * way, 1.0))
        if resists or math.isfinite(place):
            ends.append(_ending(lambda _, y: y[1] * way, -1.0))
        solved = solve_ivp(
            derivative, (t, duration), state, method="DOP853", rtol=rtol, atol=scales, dense_output=True,
            events=[*events, *ends] or None,
        )  # fmt: skip
        if solved.status < 0:
            raise Undefined(f"the motion stops at t = {solved.t[-1]:.6g} s: {solved.message}")
        end, last = float(solved.t[-1]), solved.y[:, -1].copy()
        if solved.status == 1:
            if math.isfinite(place) and len(solved.t_events[len(events)]):
                last[0] = place
            else:
                last[1] = 0.0
        dead = tuple(map(float, solved.t_events[0])) if events else ()
        return Phase(t, end, way, solved.sol, dead), last

    def _signs(self, angle: float, place: float) -> np.ndarray:
        """Signs of the paces between a place and the next turning place: as halfway between them."""
        return np.sign(self._parts(self.table.at((angle + place) / 2))[2])


def _changes(values: np.ndarray) -> Iterator[int]:
    """Where a sampled function changes its sign before the next sample."""
    with np.errstate(invalid="ignore"):
        return iter(np.flatnonzero(values[:-1] * values[1:] < 0).tolist())


def _ending(function: Callable[[float, Any], float], direction: float) -> Callable[[float, Any], float]:
    function.terminal = True  # type: ignore[attr-defined]  # as the integrator reads it
    function.direction = direction  # type: ignore[attr-defined]
    return function
