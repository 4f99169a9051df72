"""Scenes: what each effect costs, what forces cost beside the linear solve, and what a motion in time costs
beside rivals.

python benchmarks/scenes.py [effects] [forces] [motion]

The rivals of a motion in time are left out unless they are there: pip install exudyn sympy
"""

from __future__ import annotations

import math
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np
from rivals import Exudyn, Kane, Quadrature
from timing import machine, median_ratio, print_table, times_in_turn

import coursework
from coursework.mechanics.equilibrium import PIECE, Equilibrium
from coursework.mechanics.statement import Load, Mechanism
from coursework.scenes.added import BodyMass, Motor, SceneData
from coursework.scenes.scenes import Scene

COURSE = coursework.open_course()
CLOCK = time.process_time  #: so that what else runs on the machine does not count

# ------------------------------------------------------------------------ effects

STEPS, ROUNDS = 10_000, 7
FORCES = ("load", "gravity", "inertia")
CASES = {
    "position": ("position",),
    "velocity": ("velocity",),
    "acceleration": ("acceleration",),
    "load": FORCES[:1],
    "+ gravity": FORCES[:2],
    "+ inertia": FORCES,
    "+ reactions": FORCES,
    "+ friction": (*FORCES, "friction"),
}
WITH_REACTIONS = ("+ reactions", "+ friction")


def added_to(mechanism: Mechanism) -> SceneData:
    """A mass and an inertia for every body, a load on the last one, friction in slides, or in pins where
    there are none."""
    last = mechanism.bodies[-1]
    load = (
        Load(last.at, force=500.0, against=True)
        if isinstance(last.angle, (int, float))
        else Load(last.name, moment=5.0, against=True)
    )
    friction: dict[str, Any] = {slide.at: 0.1 for slide in mechanism.slides}
    return SceneData(
        {name: BodyMass(1.0, 0.002, 20 + 5j) for name in mechanism.names},
        (load,),
        friction or {pin.at: (0.1, 5.0) for pin in mechanism.pins},
    )


def driven_mechanisms() -> Iterator[tuple[Any, Mechanism]]:
    """Every exercise of the course with a driver and a stated mechanism."""
    for name in COURSE.names:
        exercise = COURSE[name]
        if exercise.spec.driver is not None and exercise.solution.mechanism is not None:
            yield exercise, exercise.solution.mechanism


def effects() -> None:
    print(
        f"### Effect by effect\n\nA turn in {STEPS:,} steps; time of the processor, {ROUNDS} rounds, "
        "the scenes of "
        "a row in turn.\n"
    )
    times, counts = {}, {}
    for exercise, mechanism in driven_mechanisms():
        reaction = (f"reaction {mechanism.pins[0].at}",)
        given, added = exercise.variant(0).used, added_to(mechanism)
        scenes = {
            case: Scene(exercise, given, called, reaction if case in WITH_REACTIONS else (), added)
            for case, called in CASES.items()
        }
        name = exercise.name if mechanism.slides else f"{exercise.name} (pins)"
        counts[name] = [str(len(s.over_cycle(4).evaluated)) for s in scenes.values()]
        times[name] = times_in_turn(
            {c: partial(s.over_cycle, STEPS) for c, s in scenes.items()}, ROUNDS, CLOCK
        )
    heads = tuple(CASES)
    print_table(
        ("ns a step: least (median)", *heads),
        [(n, *(f"{least(t):.0f} ({middle(t):.0f})" for t in own.values())) for n, own in times.items()],
    )
    print_table(
        ("× positions, median (quantities)", *heads),
        [
            (
                n,
                *(
                    f"{median_ratio(t, own['position']):.1f} ({count})"
                    for t, count in zip(own.values(), counts[n], strict=True)
                ),
            )
            for n, own in times.items()
        ],
    )


def least(times: list[float]) -> float:
    return min(times) / STEPS * 1e9


def middle(times: list[float]) -> float:
    return statistics.median(times) / STEPS * 1e9


# ------------------------------------------------------------------------- forces

ANGLES = 100_000


def forces() -> None:
    exercise = COURSE["three_loop_shaper"]
    mechanism = exercise.solution.mechanism
    given, added = exercise.variant(0).used, added_to(mechanism)
    points = dict.fromkeys([*(p.at for p in mechanism.pins), *(s.at for s in mechanism.slides)])
    effort = Scene(exercise, given, FORCES, (), added)
    joints = replace(effort, show=tuple(f"reaction {p}" for p in points))
    pieces = list(systems(effort))
    size = pieces[0][0].shape[1]
    called = {
        f"np.linalg.solve, {size} × {size}, {PIECE} at a time": partial(solve_all, pieces),
        "the scene with every reaction": partial(joints.over_cycle, ANGLES - 1),
        "the scene, the effort alone": partial(effort.over_cycle, ANGLES - 1),
    }
    print(
        f"### Forces beside the linear solve\n\n`{exercise.name}`, {len(mechanism.bodies)} bodies, "
        f"{', '.join(FORCES)}, "
        f"{ANGLES:,} angles; time of the processor, {ROUNDS} rounds.\n"
    )
    times = times_in_turn(called, ROUNDS, CLOCK)
    bare = next(iter(times.values()))
    print_table(
        ("", "µs an angle, least", "median", "× the bare solve, median of rounds"),
        [
            (
                n,
                *(f"{f(t) / ANGLES * 1e6:.2f}" for f in (min, statistics.median)),
                f"{median_ratio(t, bare):.2f}",
            )
            for n, t in times.items()
        ],
    )


def systems(scene: Scene) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The equations of the bodies over a turn, with right sides."""
    angles = np.arange(ANGLES) * (2 * np.pi / ANGLES)
    for start in range(0, ANGLES, PIECE):
        matrix = Equilibrium(scene.pose(angles[start : start + PIECE])).matrix
        yield matrix, matrix.sum(axis=2, keepdims=True)


def solve_all(pieces: list[tuple[np.ndarray, np.ndarray]]) -> None:
    for matrix, right in pieces:
        np.linalg.solve(matrix, right)


# ------------------------------------------------------------------------- motion

DURATION, START, SPEED, TORQUE = 2.0, 30.0, 10.0, 0.5  #: s, degrees, rad/s, N m
TOLERANCES = (1e-6, 1e-9, 1e-12)
STEP_COUNTS = (2_000, 20_000, 100_000)
MOTION_ROUNDS = 5


@dataclass(frozen=True)
class Case:
    """A mechanism left to itself under a constant torque and its weights."""

    exercise: str
    shape: str
    given: dict[str, Any]
    bodies: dict[str, BodyMass]

    def scene(self) -> Scene:
        exercise = COURSE[self.exercise]
        given = {**exercise.variant(0).used, **self.given, "theta2": START, "omega2": SPEED, "alpha2": 0.0}
        return Scene(exercise, given, ("gravity", "inertia"), (), SceneData(self.bodies))


MOTIONS = (
    Case(
        "four_bar_motion",
        "four_bar",
        {"r1": 235.0, "r2": 60.0, "r3": 255.0, "r4": 170.0, "mode": "open"},
        {
            "2": BodyMass(1.0, 0.01, 20 + 5j),
            "3": BodyMass(0.8, 0.004, 100 + 5j),
            "4": BodyMass(1.2, 0.006, 60 + 5j),
        },
    ),
    Case(
        "slider_crank",
        "slider_crank",
        {"r2": 45.0, "r3": 155.0, "e": 5.0},
        {
            "2": BodyMass(1.0, 0.01, 20 + 5j),
            "3": BodyMass(0.8, 0.004, 100 + 5j),
            "4": BodyMass(1.2, 0.001),
        },
    ),
)


def motion() -> None:
    print(
        f"### A motion in time\n\n{DURATION:g} s from {SPEED:g} rad/s under {TORQUE:g} N m and the "
        "weights. Seconds of "
        f"processor, {MOTION_ROUNDS} rounds, all in turn; "
        "the error is that of the driver's angle at the end, in degrees.\n"
    )
    for missing in (name for name in ("exudyn", "sympy") if not find_spec(name)):
        print(f"{missing} is not installed, so its rows are left out: pip install {missing}\n")
    for case in MOTIONS:
        of_case(case)


def of_case(case: Case) -> None:
    scene = case.scene()
    near = ended(scene, 1e-12)
    stated = (math.radians(START), SPEED, TORQUE)
    reference = Quadrature(scene.linkage, case.shape, scene.given, *stated).end(DURATION, math.radians(near))
    ways = {**own_ways(scene), **rival_ways(scene, stated)}
    errors = {name: abs(way() - math.degrees(reference)) for name, way in ways.items()}
    times = times_in_turn(ways, MOTION_ROUNDS, CLOCK)
    rows = [(n, f"{min(t):.3f}", f"{statistics.median(t):.3f}", f"{errors[n]:.1e}") for n, t in times.items()]
    turns = math.degrees(reference) / 360
    print_table((f"{case.exercise}: {turns:.1f} turns", "s, least", "median", "error, degrees"), rows)
    for name in apart(errors):
        print(f"{name} does not come to the same angle: finer steps bring it no nearer.\n")


def apart(errors: dict[str, float]) -> Iterator[str]:
    """The ways whose errors do not fall, from coarse to fine."""
    by_way: dict[str, list[float]] = {}
    for name, error in errors.items():
        by_way.setdefault(name.rpartition(",")[0], []).append(error)
    return (way for way, own in by_way.items() if own[-1] > own[0] / 10)


def ended(scene: Scene, rtol: float) -> float:
    """The driver's angle at the end, degrees; nothing is remembered from one call to another."""
    table = replace(scene).in_time(Motor(TORQUE), DURATION, rtol=rtol)
    return float(table.columns[scene.driver.angle][-1])


def own_ways(scene: Scene) -> dict[str, Callable[[], float]]:
    return {
        f"in_time with its table of 500 rows, {rtol:g}": partial(ended, scene, rtol) for rtol in TOLERANCES
    }


def rival_ways(scene: Scene, stated: tuple[float, float, float]) -> dict[str, Callable[[], float]]:
    found: dict[str, Callable[[], float]] = {}
    if find_spec("sympy"):
        began = CLOCK()
        kane = Kane(scene, *stated)
        print(f"sympy derives and writes its functions once: {CLOCK() - began:.2f} s\n")
        for rtol in TOLERANCES:
            found[f"sympy, KanesMethod, solve_ivp DOP853, {rtol:g}"] = in_degrees(kane.end, DURATION, rtol)
    if find_spec("exudyn"):
        model = Exudyn(scene, *stated)
        for solver in ("GeneralizedAlpha", "TrapezoidalIndex2"):
            for steps in STEP_COUNTS:
                name = f"exudyn, {solver}, {1e6 * DURATION / steps:g} µs a step"
                found[name] = in_degrees(model.end, DURATION, steps, solver)
    return found


def in_degrees(end: Callable[..., float], *told: Any) -> Callable[[], float]:
    return lambda: math.degrees(end(*told))


def main() -> None:
    parts = {"effects": effects, "forces": forces, "motion": motion}
    wanted = sys.argv[1:] or list(parts)
    if unknown := [name for name in wanted if name not in parts]:
        sys.exit(f"no part {', '.join(unknown)}; there are {', '.join(parts)}")
    print(f"{machine()}\n")
    for name in wanted:
        parts[name]()


if __name__ == "__main__":
    main()
