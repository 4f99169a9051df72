"""Quantities that a scene shows: those of the exercise for its effects, and those of the mechanism."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from coursework.errors import WrongValue
from coursework.mechanics.forces import ForceResults, Forces
from coursework.mechanics.linkage import MM, SlideJoint
from coursework.mechanics.rates import Stance
from coursework.scenes import shown
from coursework.scenes.effects import ADVANTAGE, OF_FORCES
from coursework.scenes.staged import Staged
from coursework.solution import Moving

_PIECE = 1 << 16  #: instants whose points are computed together


@dataclass(frozen=True)
class Showing(Staged):
    """Staged mechanism with the quantities that it shows."""

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in self.show:
            self._check_shown(name)
        if "coriolis" in self.effects and not self._of("coriolis"):
            self._coriolis_points()

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities of the exercise that the scene shows."""
        wanted = [n for effect in self.called for n in self._of(effect)]
        if self._graph_effects and not (self.has_own_data and self.exercise.solution.mechanism):
            wanted += self._of(OF_FORCES)
        wanted += [n for n in self.show if n in self.exercise.quantity_names]
        return tuple(
            n for n in dict.fromkeys(wanted) if n != self.driver.moved and n not in self.exercise.spec.given
        )

    def shown_by(self, effect: str) -> tuple[str, ...]:
        """Return the exercise's quantities that an effect shows."""
        return self._of(OF_FORCES if effect in self._graph_effects else effect)

    @property
    def accelerations(self) -> tuple[str, ...]:
        """The exercise's quantities that the effect acceleration shows."""
        return self._of("acceleration")

    @property
    def constants(self) -> frozenset[str]:
        """Shown quantities that no effect changes: they are computed once."""
        if self.exercise.spec.driver is None or self.exercise.spec.driver.poses is None:
            return frozenset()
        # By the textbook: a stable formula may read a position only to know the assembly, as a side does.
        placing = [n for n, v in self.exercise.posed(self._accepted, 0.0).items() if not isinstance(v, str)]
        moving = self.exercise.solution.graph.textbook.descendants(placing).union(*self._by_effect.values())
        return frozenset(n for n in self.show if n in self.exercise.quantity_names and n not in moving)

    @cached_property
    def extra(self) -> tuple[str, ...]:
        """Further quantities shown: of the drive, of points, of joints."""
        named = [n for n in self.show if n not in self.exercise.quantity_names]
        if (
            self._forces_called
            and self.exercise.solution.mechanism
            and self.driver.effort not in self.quantities
        ):
            named.insert(0, self._effort_name)
        if "coriolis" in self.effects and not self._of("coriolis"):
            named += [f"coriolis {point}" for point in self._coriolis_points()]
        if self.exercise.solution.mechanism:
            named += self._of_what_the_solution_leaves_out()
        elif "position" in self.called and not self._of("position"):
            named += [f"position {point}" for point in self._moved_by_solution]
        return tuple(dict.fromkeys(named))

    @property
    def _effort_name(self) -> str:
        """Name of the column of what the drive supplies."""
        mechanism = self.exercise.solution.mechanism
        return "drive_thrust" if mechanism and mechanism.pushed else "drive_torque"

    @cached_property
    def _moved_by_solution(self) -> tuple[str, ...]:
        """Points that the solution's ``motion`` gives."""
        return tuple(self._motion_of_solution(0.0))

    def _motion_of_solution(self, angle: Any) -> Mapping[str, Moving]:
        """Return the points of the solution's ``motion`` at driver's angles, degrees; none without one."""
        solution = self.exercise.solution
        if solution.motion is None:
            return {}
        graph = solution.graph.with_functions({"motion": solution.motion})
        given = {**self._accepted, **self._driven(angle), self.driver.angle: angle}
        known_values = {n: v for n, v in given.items() if n in self.exercise.quantity_names | graph.leaves}
        return graph.evaluate(("motion",), known_values, self._graph_effects)["motion"]

    def _of_what_the_solution_leaves_out(self) -> list[str]:
        """Return the velocities and accelerations of moving points, for a requested effect that no quantity
        covers."""
        points = [p for p in self.linkage.mechanism.points if p not in self.linkage.mechanism.ground]
        return [
            f"{effect} {point}"
            for effect in ("velocity", "acceleration")
            if effect in self.effects and not self._of(effect)
            for point in points
        ]

    @cached_property
    def _of_own_forces(self) -> frozenset[str]:
        """Quantities of the exercise that its own effects change."""
        graph = self.exercise.solution.graph
        return graph.descendants(graph.effects()) if graph.effects() else frozenset()

    def _coriolis_points(self) -> tuple[str, ...]:
        if self.exercise.solution.mechanism is None:
            raise WrongValue(
                "{exercise} has no Coriolis term to show: its solution states no MECHANISM, and no "
                "EFFECTS of coriolis",
                exercise=self.exercise.name,
            )
        points = tuple(s.name.removesuffix(" slide") for s in shown.turning_slides(self.linkage))
        if not points:
            raise WrongValue(
                "{exercise} has no Coriolis term: no body slides on one that turns",
                exercise=self.exercise.name,
            )
        return points

    def _check_shown(self, name: str) -> None:
        if "," in name and shown.split_request(name)[1] not in self.exercise.quantity_names:
            raise WrongValue(
                "{name!r} names several things to show; name one at a time: --show A --show B", name=name
            )
        if name in self.exercise.quantity_names:
            if self.has_own_data and name in self._of_own_forces:
                raise WrongValue(
                    "{name} follows from the exercise's own data, and the scene brings others: show "
                    "drive_torque, 'reaction B'",
                    name=name,
                )
            return
        if self.exercise.solution.mechanism is None:
            kind, of = shown.split_request(name)
            if kind not in ("position", "velocity", "acceleration") or of not in self._moved_by_solution:
                self.mechanism  # noqa: B018  # is refused here
            return
        shown.check(name, self.linkage, self.exercise.solution.graph.quantities)

    # --------------------------------------------------------------------- columns

    def _exercise_columns(self, driven: Mapping[str, Any], shape: tuple[int, ...]) -> dict[str, np.ndarray]:
        constants = self.constants
        moving = tuple(n for n in self.quantities if n not in constants)
        result = self.exercise.solve(**driven, only=moving, effects=self._graph_effects) if moving else {}
        if constants:
            result |= self.exercise.solve(**self.given, only=tuple(constants), effects=self._graph_effects)
        if ADVANTAGE in self.effects and not self._of(ADVANTAGE):
            result |= self._advantage(driven)
        return {n: np.broadcast_to(result[n], shape) for n in dict.fromkeys([*self.quantities, *result])}

    def _advantage(self, driven: Mapping[str, Any]) -> dict[str, Any]:
        """Return the mechanical advantage: the driver's speed over that of its output."""
        output = self.driver.output
        if not output or not self.driver.speed:
            raise WrongValue(
                "{exercise}: its driver names no output, so no advantage is known",
                exercise=self.exercise.name,
            )
        speed = np.abs(
            np.asarray(self.exercise.solve(**driven, only=output, effects=())[output], dtype=float)
        )
        with np.errstate(divide="ignore"):
            ratio = abs(self._speed) / speed
        return {ADVANTAGE: np.where(speed > 0, ratio * (1000.0 if self._output_slides else 1.0), np.nan)}

    @property
    def _output_slides(self) -> bool:
        return self.exercise.units.get(self.driver.output, "") == "mm/s"

    def _extra_columns(
        self, angles: np.ndarray, speed: np.ndarray, acceleration: np.ndarray
    ) -> shown.Columns:
        """Return the further quantities at driver's angles in radians."""
        if not self.extra:
            return {}
        if self.exercise.solution.mechanism is None:
            return self._points_of_solution(np.degrees(angles))
        kinds = [(name, *shown.split_request(name)) for name in self.extra]
        needs_joints = any(kind == shown.REACTION for _, kind, _ in kinds)
        needs_forces = needs_joints or any(not kind for _, kind, _ in kinds)
        points = [(kind, of) for _, kind, of in kinds if kind in shown.OF_POINTS]
        moving = self._of_points(points, angles, speed, acceleration)
        borne = self.forces.over(angles, speed, acceleration, joints=needs_joints) if needs_forces else None
        results: shown.Columns = {}
        for name, kind, of in kinds:
            if kind == shown.REACTION and borne is not None:
                results |= shown.of_joint(of, self.linkage, borne)
            elif kind:
                results |= moving[kind, of]
            elif borne is not None:
                results |= self._of_drive(name, borne, angles, speed)
        return results

    def _of_points(
        self,
        points: Sequence[tuple[str, str]],
        angles: np.ndarray,
        speed: np.ndarray,
        acceleration: np.ndarray,
    ) -> dict[tuple[str, str], shown.Columns]:
        """Return the motions of points, in blocks of instants, so that a long cycle needs no more memory than
        its columns."""
        parts: list[dict[tuple[str, str], shown.Columns]] = []
        for start in range(0, len(angles), _PIECE) if points else ():
            piece = slice(start, start + _PIECE)
            stance = self.pose(angles[piece])
            parts.append({p: shown.of_point(*p, stance, speed[piece], acceleration[piece]) for p in points})
        return {
            point: {
                name: (np.concatenate([part[point][name][0] for part in parts]), unit)
                for name, (_, unit) in parts[0][point].items()
            }
            for point in points
        }

    def _points_of_solution(self, angle: np.ndarray) -> shown.Columns:
        """Return the points that the solution itself moves, for a spatial mechanism without plane bodies."""
        points = self._motion_of_solution(angle)
        results: shown.Columns = {}
        for kind, of in map(shown.split_request, self.extra):
            results |= shown.of_moving(kind, of, points[of])
        return results

    def _of_drive(
        self, name: str, borne: ForceResults, angles: np.ndarray, speed: np.ndarray
    ) -> shown.Columns:
        if name == "drive_torque":
            return {name: (borne.effort, "N*m")}
        if name == "drive_thrust" and (slide := self.linkage.pushed) is not None:
            with np.errstate(all="ignore"):
                return {name: (borne.effort / self.pose(angles).sliding(slide), "N")}
        if name == "drive_power":
            return {name: (borne.effort * speed, "W")}
        inertia = self._moved().over(angles, 0 * speed, 0 * speed + 1.0).effort
        return {name: (0.5 * inertia * speed**2, "J")}

    def _moved(self) -> Forces:
        """Return the forces of inertia alone, with the requested flywheel."""
        return replace(self.forces, downwards=0j, inertia=True, loads=(), contacts=())

    def moving_points(self, angle: np.ndarray) -> dict[str, Moving]:
        """Return the points of the bodies at driver's angles, degrees: mm, mm/s, mm/s^2; rates where the
        driver has a speed."""
        stance, linkage = self.pose(np.radians(angle)), self.linkage
        points = [p for p in linkage.mechanism.points if p not in linkage.mechanism.ground]
        sliding = {s.name.removesuffix(" slide"): s for s in shown.turning_slides(linkage)}
        return {point: self._moving(point, stance, sliding.get(point)) for point in points}

    def ground_points(self) -> dict[str, complex]:
        """Return the points of the ground, mm."""
        stance, ground = self.pose(np.zeros(1)), self.linkage.mechanism.ground
        return {point: complex(stance.place(self.linkage.owner(point))[0] / MM) for point in ground}

    def _moving(self, point: str, stance: Stance, slide: SlideJoint | None) -> Moving:
        body_point = stance.linkage.owner(point)
        position = stance.place(body_point) / MM
        if not self.driver.speed:
            return Moving(position)
        speed, acceleration = self._speed, self._acceleration
        with np.errstate(all="ignore"):
            velocity = stance.rate(body_point) * speed / MM
            bent = stance.acceleration(body_point, speed, acceleration) / MM
            if slide is None:
                return Moving(position, velocity, bent)
            return Moving(
                position, velocity, bent, 1j * stance.coriolis(slide, speed) / MM * stance.direction(slide)
            )

    # ------------------------------------------------------------------------ text

    def _evaluated(self) -> tuple[str, ...]:
        wanted = [*self.quantities]
        if self.extra and self.exercise.solution.mechanism:
            wanted += [n for n in self.linkage.mechanism.angles if n in self.exercise.solution.graph.names]
        return self.evaluated(wanted)

    def evaluated(self, wanted: Sequence[str]) -> tuple[str, ...]:
        """Return all quantities evaluated for the requested ones, in order."""
        graph = self.exercise.solution.graph
        names = {**self.exercise.intake.defaults, **self._driven(0.0)}
        given = frozenset(names) & self.exercise.quantity_names
        plan = graph.plan(tuple(dict.fromkeys(wanted)), given, self._graph_effects)
        return tuple(name for name in plan if not name.startswith("_"))  # a hidden one is the solution's own

    def _units(self, names: Sequence[str] | Mapping[str, Any]) -> dict[str, str]:
        advantage = "1/m" if self._output_slides else "1"
        known_values = {"t": "s", ADVANTAGE: advantage, self.driver.angle: "deg", **self.exercise.units}
        return {n: known_values.get(n, "1") for n in names}
