"""Drawing variants: the same values for ever from (exercise, version, seed), on any platform.

Bits come from SHAKE-128 keyed by exercise, version, seed and a block counter, so no seed and no
exercise disturbs another. For an assignment, what keys them passes through an HMAC of its secret: then the
seed is a code that draws nothing without the secret. Each value is a whole number of steps, drawn with integers alone, then
divided once by a power of ten: it is the double nearest to the decimal that is printed.
"""

from __future__ import annotations

import hashlib
import inspect
import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from coursework.course.secrecy import Secret
from coursework.errors import BadCourse, CourseworkError, MissingQuantity, Starved, nearest
from coursework.model import Bound, Exercise, GivenSpec
from coursework.quantities.graph import Graph

BLOCK = 16  #: candidates a block; part of the stream's definition
MAX_BLOCKS = 256  #: a seed that finds nothing in BLOCK · MAX_BLOCKS candidates starves


def _words(
    name: str, version: int, seed: int, block: int, width: int, secret: Secret | None = None
) -> np.ndarray:
    """Raw bits: uint64 of shape (BLOCK, width)."""
    stream = f"coursework/{name}/{version}/{seed}/{block}"
    key = stream.encode() if secret is None else secret.digest("draw", stream)
    bits = hashlib.shake_128(key).digest(8 * BLOCK * width)
    return np.frombuffer(bits, "<u8").reshape(BLOCK, width)


def _evaluate(bound: Bound | None, drawn: Mapping[str, np.ndarray]) -> Any:
    if not callable(bound):
        return bound
    return bound(*[drawn[n] for n in inspect.signature(bound).parameters])


def _constant(spec: GivenSpec) -> float:
    """Return the one value of a quantity that is fixed."""
    assert spec.default is not None
    return float(spec.default)


@dataclass(frozen=True)
class _Grid:
    """Multiples of a step, as integers over a power of ten."""

    numerator: int
    denominator: int

    @staticmethod
    def of(step: Fraction) -> _Grid:
        power = 1
        while (step * power).denominator != 1:
            power *= 10
            if power > 10**9:
                raise BadCourse(f"a step must be a decimal of at most nine places; found {step}")
        return _Grid(int(step * power), power)

    def first(self, low: Any) -> np.ndarray:
        """Return the first multiple not below ``low``; a bound on the grid, but for rounding, is on it."""
        return self._steps(np.ceil, low, -1e-9, without=1)

    def last(self, high: Any) -> np.ndarray:
        return self._steps(np.floor, high, 1e-9, without=0)

    def _steps(self, to_whole: Callable, bound: Any, slack: float, without: int) -> np.ndarray:
        """Return a bound in whole steps; a bound that is not a number makes the range empty."""
        steps = to_whole(np.asarray(bound, dtype=float) * self.denominator / self.numerator + slack)
        return np.where(np.isfinite(steps), steps, without).astype(np.int64)

    def value(self, k: Any) -> Any:
        return (k * self.numerator) / self.denominator


def _draw_one(spec: GivenSpec, words: np.ndarray, drawn: Mapping[str, np.ndarray]) -> np.ndarray:
    """Values of one given quantity, one a word; NaN where its range is empty."""
    high_half = words >> np.uint64(32)  # 32 bits times a count below 2^31 fit in 64
    if spec.is_choice:
        picked = (high_half * np.uint64(len(spec.choices))) >> np.uint64(32)
        return np.array(spec.choices)[picked.astype(np.intp)]
    if spec.is_fixed:
        return np.full(words.shape, _constant(spec))
    grid = _Grid.of(spec.step)
    low, high = grid.first(_evaluate(spec.low, drawn)), grid.last(_evaluate(spec.high, drawn))
    count = np.maximum(high - low + 1, 0)
    without_zero = (low <= 0) & (high >= 0) if spec.nonzero else np.zeros_like(count, dtype=bool)
    count = np.where(without_zero, count - 1, count)
    if count.max(initial=0) >= 2**31:
        raise BadCourse(f"a range holds {count.max():,} steps of {float(spec.step):g}; make the step coarser")
    k = low + ((high_half * count.astype(np.uint64)) >> np.uint64(32)).astype(np.int64)
    k = np.where(without_zero & (k >= 0), k + 1, k)
    return np.where(count > 0, grid.value(k), np.nan)


def candidates(exercise: Exercise, words: np.ndarray) -> dict[str, np.ndarray]:
    """Given quantities from raw bits of shape (n, number of given quantities)."""
    drawn: dict[str, np.ndarray] = {}
    for column, (name, spec) in enumerate(exercise.given.items()):
        drawn[name] = _draw_one(spec, words[:, column], drawn)
    return drawn


def conditions(exercise: Exercise) -> tuple[Graph, tuple[str, ...]]:
    """Return the conditions of an exercise as a graph, and their names."""
    functions: dict[str, Callable] = {f.__name__: f for f in (*exercise.helpers, *exercise.keep)}
    return Graph(functions), tuple(f.__name__ for f in exercise.keep)


def accepted(exercise: Exercise, drawn: Mapping[str, np.ndarray]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return which candidates are variants, and for each constraint which candidates it refuses.

    Shapes ``(n,)``. A candidate with an empty range is refused as ``range of NAME is empty``, of the first such.
    """
    size = len(next(iter(drawn.values())))
    refused = {}
    empty = np.zeros(size, dtype=bool)
    for name, values in drawn.items():
        if values.dtype.kind == "f" and (here := np.isnan(values) & ~empty).any():
            refused[f"range of {name} is empty"] = here
            empty |= here
    graph, names = conditions(exercise)
    usable = {n: drawn[n] for n in drawn if n in graph.leaves}
    for name, answer in graph.evaluate(names, usable).items():
        refused[name] = ~np.broadcast_to(np.asarray(answer, dtype=bool), (size,))
    good = np.ones(size, dtype=bool)
    for mask in refused.values():
        good &= ~mask
    return good, refused


def draw(
    name: str, exercise: Exercise, seeds: Sequence[int], secret: Secret | None = None
) -> list[dict[str, float | str]]:
    """Return the given values of each seed's variant, in canonical units; with a secret, of each code of an assignment.

    Raises
    ------
    Starved
        Some seed finds no variant in its bounded draws; the message names the condition that refuses most.
    """
    draws: list[dict[str, float | str] | None] = [None] * len(seeds)
    pending = np.arange(len(seeds))
    width = len(exercise.given)
    for block in range(MAX_BLOCKS):
        # A block of candidates for each pending seed; few at a time, so that memory stays flat.
        still = []
        for chunk in _chunks(pending, 4096):
            words = np.concatenate(
                [_words(name, exercise.version, seeds[i], block, width, secret) for i in chunk]
            )
            drawn = candidates(exercise, words)
            good, _ = accepted(exercise, drawn)
            good = good.reshape(len(chunk), BLOCK)
            first = good.argmax(axis=1)
            hit = good.any(axis=1)
            rows = np.flatnonzero(hit) * BLOCK + first[hit]
            columns = {n: values[rows].tolist() for n, values in drawn.items()}
            for position, i in enumerate(chunk[hit]):
                draws[i] = {n: column[position] for n, column in columns.items()}
            still.append(chunk[~hit])
        pending = np.concatenate(still) if still else pending[:0]
        if not len(pending):
            return draws  # type: ignore[return-value]  # none is left out
    raise _starved(name, exercise, seeds[pending[0]], secret)


def _starved(name: str, exercise: Exercise, seed: int, secret: Secret | None = None) -> Starved:
    """Return the error for a seed without a variant: it names the constraints that refuse most of its
    draws."""
    width = len(exercise.given)
    words = np.concatenate(
        [_words(name, exercise.version, seed, b, width, secret) for b in range(MAX_BLOCKS)]
    )
    _, refused = accepted(exercise, candidates(exercise, words))
    refusals = Counter({condition: int(mask.sum()) for condition, mask in refused.items()})
    worst = ", ".join(f"{condition} ({count} times)" for condition, count in refusals.most_common(3) if count)
    return Starved(
        f"{name}: seed {seed} found no variant in {len(words)} draws; refused by {worst}; "
        "widen a range or relax the condition"
    )


def _chunks(indices: np.ndarray, size: int) -> Iterator[np.ndarray]:
    for start in range(0, len(indices), size):
        yield indices[start : start + size]


def acceptance(name: str, exercise: Exercise, count: int = 4096) -> tuple[float, dict[str, float]]:
    """Share of candidates that are variants, and the share that each condition refuses."""
    good, refused = accepted(exercise, first_candidates(name, exercise, count))
    return float(good.mean()), {condition: float(mask.mean()) for condition, mask in refused.items()}


def first_candidates(name: str, exercise: Exercise, count: int) -> dict[str, np.ndarray]:
    """Return the first candidates of the first seeds, at least so many, whether or not they are variants."""
    seeds = range(math.ceil(count / BLOCK))
    words = np.concatenate([_words(name, exercise.version, s, 0, len(exercise.given)) for s in seeds])
    return candidates(exercise, words)


def population(exercise: Exercise, limit: int = 200_000) -> int | None:
    """Return the number of distinct variants, by trying every combination; None beyond ``limit``
    combinations."""
    combinations: list[dict[str, float | str]] = [{}]
    for name, spec in exercise.given.items():
        grown = []
        for partial in combinations:
            grown += [{**partial, name: value} for value in _all_values(spec, partial)]
            if len(grown) > limit:
                return None
        combinations = grown
    if not combinations:
        return 0
    drawn = {n: np.array([c[n] for c in combinations]) for n in exercise.given}
    return int(accepted(exercise, drawn)[0].sum())


def _all_values(spec: GivenSpec, partial: Mapping[str, Any]) -> list[float | str]:
    if spec.is_choice:
        return list(spec.choices)
    if spec.is_fixed:
        return [_constant(spec)]
    grid = _Grid.of(spec.step)
    low = int(grid.first(_evaluate(spec.low, partial)))
    high = int(grid.last(_evaluate(spec.high, partial)))
    return [float(grid.value(np.int64(k))) for k in range(low, high + 1) if k or not spec.nonzero]


def check_conditions(name: str, exercise: Exercise) -> None:
    """Fail early when a condition needs what is not given.

    Raises
    ------
    BadCourse
        Says which condition and what it needs.
    """
    graph, names = conditions(exercise)
    try:
        graph.plan(names, exercise.given)
    except MissingQuantity as fault:
        names_known = {*exercise.given, *graph.quantities} - {*names}
        near = nearest(fault.names[0], names_known)
        raise BadCourse(f"{name}: a condition cannot be evaluated: {fault.needed}{near}") from fault
    except CourseworkError as fault:
        raise BadCourse(f"{name}: a condition cannot be evaluated: {fault}") from fault
