"""Cost and influence of each effect of a scene: its computing time, and the change of the outputs without
it."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from coursework.errors import CourseworkError, WrongValue
from coursework.scenes.effects import FORCES
from coursework.scenes.scenes import Scene, SceneTable
from coursework.scenes.staged import FLYWHEEL

TOLERANCE = 0.01  #: of an output's largest value: a smaller change is one that a scene could do without
#: Rounds that are timed; fewer where all of them would take more seconds.
_ROUNDS, _FEWEST, _PATIENCE = (7, 3, 10.0)
_ROUNDING = 1e-9  #: of the largest output of a unit, or of an output: what is smaller is rounding

Run = Callable[[Scene], SceneTable]


@dataclass(frozen=True)
class OutputChange:
    """Change of an output: largest and root mean square, in its unit and relative to the output's own largest
    and root mean square."""

    output: str
    unit: str
    largest: float
    rms: float
    largest_part: float
    rms_part: float


@dataclass(frozen=True)
class EffectInfluence:
    """Effect with its cost in seconds, and the changes of the outputs without it.

    ``needed``: the reason why the scene does not run without it; empty where it does.
    """

    effect: str
    seconds: float
    spread: float
    changes: tuple[OutputChange, ...]
    needed: str = ""

    @property
    def is_timed(self) -> bool:
        """True if the cost stands out of the spread of its measurements."""
        return self.seconds > self.spread

    @property
    def most(self) -> OutputChange | None:
        """Output that changes most."""
        return max(self.changes, key=lambda change: change.largest_part, default=None)


@dataclass(frozen=True)
class EffectBudget:
    """Effects of a scene with their cost and influence, the time of all of them, and the effects that it
    lacks."""

    seconds: float
    worths: tuple[EffectInfluence, ...]
    lacking: tuple[EffectInfluence, ...]
    tolerance: float

    def said(self) -> Iterator[str]:
        """Yield the findings as sentences."""
        limit = f"{100 * self.tolerance:g} %"
        for worth in self.worths:
            most = worth.most
            if worth.needed or worth.effect not in FORCES:
                continue
            if worth.effect == FLYWHEEL:
                yield (
                    "flywheel evens out a motion in time; over a cycle at a constant rate it changes nothing"
                )
            elif most is None or most.largest_part == 0:
                yield (
                    f"{worth.effect} changes nothing here: the scene has no data for it, or asks nothing "
                    "that it moves"
                )
            elif most.largest_part <= self.tolerance:
                yield (
                    f"the scene could do without {worth.effect}: nothing shown changes by more than {limit} "
                    f"({most.output} by {100 * most.largest_part:.2g} %)"
                )
        for worth in self.lacking:
            most = worth.most
            if most is not None and most.largest_part > self.tolerance:
                yield (
                    f"the scene lacks {worth.effect}, for which it has data: {most.output} would "
                    "change by up to "
                    f"{most.largest:.3g} {most.unit} ({100 * most.largest_part:.2g} %)"
                )
            elif most is not None:
                yield f"{worth.effect} is left out, rightly at {limit}: it would change nothing shown by more"


def budget(scene: Scene, run: Run, tolerance: float = TOLERANCE) -> EffectBudget:
    """Measure every effect of a scene; ``run`` runs a scene over a cycle or in time.

    Raises
    ------
    WrongValue
        A scene that calls for no effect, or a tolerance that is not above 0.
    """
    if not scene.effects:
        raise WrongValue("a budget is of effects: name some, --effects load,inertia,friction")
    if not tolerance > 0:
        raise WrongValue("a tolerance is above 0, 0.01 for 1 %; found {tolerance:g}", tolerance=tolerance)
    full = run(scene)
    others, needed = _others(scene, run, scene.effects)
    times = _times({"": scene, **others}, run)
    worths = [_worth(e, scene, others.get(e), full, run, times, needed.get(e, "")) for e in scene.effects]
    return EffectBudget(
        statistics.median(times[""]), tuple(worths), tuple(_lacking(scene, run, full)), tolerance
    )


def _others(scene: Scene, run: Run, effects: Sequence[str]) -> tuple[dict[str, Scene], dict[str, str]]:
    """Return the scene without each effect, and the reasons why it does not run without some."""
    result, needed = {}, {}
    for effect in effects:
        try:
            other = scene.without(effect)
            run(other)
        except CourseworkError as fault:
            needed[effect] = str(fault)
        else:
            result[effect] = other
    return result, needed


def _times(scenes: Mapping[str, Scene], run: Run) -> dict[str, list[float]]:
    """Return the seconds of each scene, in rounds that run all of them in turn."""
    results: dict[str, list[float]] = {name: [] for name in scenes}
    started = time.perf_counter()
    for number in range(_ROUNDS):
        if number >= _FEWEST and time.perf_counter() - started > _PATIENCE * number / _ROUNDS:
            break
        for name, scene in scenes.items():
            fresh = replace(scene)  # what a scene remembers of its mechanism is part of its time
            start = time.perf_counter()
            run(fresh)
            results[name].append(time.perf_counter() - start)
    return results


def _worth(
    effect: str,
    scene: Scene,
    other: Scene | None,
    full: SceneTable,
    run: Run,
    times: Mapping[str, Sequence[float]],
    needed: str,
) -> EffectInfluence:
    if other is None:
        return EffectInfluence(effect, float("nan"), float("nan"), (), needed)
    differences = [all_of_it - without for all_of_it, without in zip(times[""], times[effect], strict=True)]
    quartiles = statistics.quantiles(differences, n=4)
    changes = tuple(_changes(full, run(other)))
    return EffectInfluence(effect, statistics.median(differences), quartiles[2] - quartiles[0], changes)


def _changes(full: SceneTable, other: SceneTable) -> Iterator[OutputChange]:
    """Yield the change of every output that both tables contain, at their common instants."""
    stored, there = (~_dead(table) for table in (full, other))
    largest: dict[str, float] = {}
    for name, values in full.columns.items():
        largest[full.units[name]] = max(largest.get(full.units[name], 0.0), _largest(values))
    for name, values in full.columns.items():
        if name in ("t", "dead_centre") or name not in other.columns or name == next(iter(full.columns)):
            continue
        pair, changed = values[stored], other.columns[name][there]
        if pair.shape == changed.shape and _largest(pair) > _ROUNDING * largest[full.units[name]]:
            yield _change(name, full.units[name], pair, changed, "t" not in full.columns)


def _largest(values: np.ndarray) -> float:
    return float(np.nanmax(np.abs(values), initial=0.0))


def _dead(table: SceneTable) -> np.ndarray:
    first = next(iter(table.columns.values()))
    return table.columns.get("dead_centre", np.zeros(len(first))) > 0


def _change(name: str, unit: str, values: np.ndarray, changed: np.ndarray, wraps: bool) -> OutputChange:
    apart = np.abs(changed - values)
    if unit == "deg" and wraps:
        apart = np.abs(apart - 360.0 * np.rint(apart / 360.0))
    size = (_largest(values), _rms(values))
    largest, rms = _largest(apart), _rms(apart)
    if largest <= _ROUNDING * size[0]:
        largest = rms = 0.0
    parts = [
        change / of if of else float(change > 0) for change, of in zip((largest, rms), size, strict=True)
    ]
    return OutputChange(name, unit, largest, rms, *parts)


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(np.square(values)))) if np.isfinite(values).any() else 0.0


def _lacking(scene: Scene, run: Run, full: SceneTable) -> Iterator[EffectInfluence]:
    """Yield the effects for which the scene has data but which it does not request, if it shows forces or
    moves in time."""
    for effect in scene.with_data():
        if effect in scene.effects:
            continue
        try:
            added = run(replace(scene, effects=(*scene.effects, effect)))
        except CourseworkError:
            continue
        yield EffectInfluence(effect, float("nan"), float("nan"), tuple(_changes(full, added)))
