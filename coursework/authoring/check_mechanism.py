"""The promises about a stated mechanism: one degree of freedom, loops that close, rates that are those of the
solution."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from coursework.authoring.check_report import CheckReport
from coursework.course.variant import Variant
from coursework.errors import CourseworkError
from coursework.mechanics.linkage import MM
from coursework.mechanics.rates import Stance
from coursework.mechanics.statement import GROUND, Mechanism
from coursework.scenes.scenes import Scene
from coursework.structure.joints import FRAME, Counts, JointGraph

TRIED = 20  #: variants
_CLOSES = 1e-9  #: of the largest distance
_AGREES = 1e-7  #: of the largest rate
_STEP = 1e-4  #: radians, of differences


#: A step apart, central if possible.
_SLOPES = np.array([[0, -1, 0, 1, 0], [0, 0, -3, 4, -1], [1, -4, 3, 0, 0]]) / 2


def check_mechanism(drawn: Sequence[Variant], report: CheckReport) -> None:
    """Joints hold together what they should in every variant, and their rates are the solution's own."""
    exercise = drawn[0].exercise
    mechanism = exercise.solution.mechanism
    if mechanism is None:
        return
    counted = counts(mechanism)
    if not counted.w == mechanism.mobility == 1:
        report.fail(
            f"MECHANISM: {counted.n} bodies, {counted.b} pins and slides and {counted.h} gears leave "
            f"{counted.w} degrees of "
            "freedom; a driver moves 1"
        )
        return
    if bool(mechanism.pushed) != bool(exercise.spec.driver and exercise.spec.driver.jack):
        report.fail(
            "MECHANISM: the slide of a jack and its length are stated together, Mechanism(pushed=…) "
            "and Driver(jack=…); "
            "found one alone"
        )
        return
    for variant in drawn[:TRIED]:
        report.counts["mechanisms closed"] += 1
        for why in faults(variant):
            report.fail(f"seed {variant.seed}: MECHANISM: {why}")


def counts(mechanism: Mechanism) -> Counts:
    """Return the counts of the joint graph: bodies, pairs, degrees of freedom."""
    number = {GROUND: FRAME, **{name: k for k, name in enumerate(mechanism.names, start=FRAME + 1)}}
    joints: list[dict[str, Any]] = []
    for pin in mechanism.pins:
        joints.append({"between": [number[pin.on], number[pin.of]], "kind": "revolute"})
    for slide in mechanism.slides:
        joints.append({"between": [number[slide.on], number[slide.of]], "kind": "prismatic"})
    for gear in mechanism.gears:
        joints.append({"between": [number[gear.first], number[gear.second]], "kind": "higher"})
    return JointGraph.of(joints).counts


def faults(variant: Variant) -> Iterator[str]:
    """Yield the contradictions in a variant: a pin that is not met, a rate that differs from the
    solution's."""
    exercise = variant.exercise
    scene = Scene(exercise, variant.used)
    try:
        angle = np.radians([exercise.driver_angle(variant.used)])
        stance = scene.pose(angle, by_joints=True)
    except CourseworkError as fault:
        yield str(fault)
        return
    size = float(np.max(np.abs(stance.origins)))
    if not stance.gap[0] <= _CLOSES * size:
        yield f"the pins of a loop miss each other by {1000 * stance.gap[0]:.3g} mm"
        return
    yield from _other_rates(variant, scene, stance)
    yield from _other_shifts(scene, stance, float(angle[0]), size)


def _other_shifts(scene: Scene, stance: Stance, angle: float, size: float) -> Iterator[str]:
    """Free bodies that go otherwise than their joints let them: their rates beside differences of their
    places."""
    if not scene.linkage.free:
        return
    near = scene.pose(angle + _STEP * np.arange(-2, 3), by_joints=True)
    for body in scene.linkage.free:
        places = near.origins[body]
        # At an end of what drives there are places on one side alone.
        slopes = [places[w != 0] @ w[w != 0] for w in _SLOPES if np.isfinite(places[w != 0]).all()]
        slope = slopes[0] / _STEP if slopes else np.nan
        if not abs(slope - stance.origin_rates[body, 0]) <= 1e-6 * size:
            name = scene.mechanism.names[body]
            yield (
                f"body {name} goes otherwise than its slides let it: its origin by {slope * 1000:.4g} "
                "mm a radian of the "
                f"driver, its joints by {stance.origin_rates[body, 0] * 1000:.4g}"
            )


def _speed(variant: Variant, scene: Scene) -> float:
    """Return the speed of the driving angle, rad/s; 0 where nothing gives one."""
    driver, jack = scene.driver, scene.driver.jack
    if jack is not None:
        return float(scene.driver_motion(np.array([float(variant.used[jack.length])]))[1][0])
    return float(variant.used.get(driver.speed, 0.0)) if driver.speed else 0.0


def _other_rates(variant: Variant, scene: Scene, stance: Stance) -> Iterator[str]:
    exercise = variant.exercise
    speed = _speed(variant, scene)
    if not speed:
        return
    jack, slide = scene.driver.jack, scene.linkage.pushed
    if jack is not None and slide is not None:
        grown, asked = float(stance.sliding(slide)[0]) * speed / MM, float(variant.used[jack.speed])
        if not abs(grown - asked) <= _AGREES * abs(asked):
            yield f"the jack grows by {grown:.6g} mm/s by its joints, and {jack.speed} = {asked:.6g}"
    named = {
        angle: pair[0] for loop in exercise.solution.loops.values() for angle, pair in loop.rates.items()
    }
    largest = abs(speed) * max(1.0, float(np.nanmax(np.abs(stance.rates))))
    for number, body in enumerate(scene.mechanism.bodies):
        rate = named.get(body.angle) if isinstance(body.angle, str) else None
        if rate is None or rate in variant.used:
            continue
        stated = exercise.solve(**variant.used, only=rate, effects=variant.effects)[rate]
        speed_found = float(stance.rates[number, 0]) * speed
        if not abs(speed_found - stated) <= _AGREES * largest:
            yield (
                f"body {body.name} turns at {speed_found:.6g} rad/s by its joints, and {rate} = {stated:.6g}"
            )
