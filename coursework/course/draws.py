"""Draws variants: the same values for ever from (exercise, version, seed), on any platform.

Bits come from SHAKE-128 keyed by exercise, version, seed and a block counter, so no seed and no exercise
disturbs another. For an assignment, what keys them passes through an HMAC of its secret: then the seed is a
code that draws nothing without the secret. Each value is a whole number of steps, drawn with integers alone,
then divided once by a power of ten: it is the double nearest to the decimal that is printed.
"""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.course.secrecy import Secret
from coursework.errors import BadCourse, CourseworkError, MissingQuantity, Starved, nearest
from coursework.messages import Message, as_message
from coursework.model import Detectable, Exercise, GivenSpec, Part
from coursework.quantities.graph import Graph

if TYPE_CHECKING:
    from coursework.solution import Solution

Stated = Mapping[str, float | str]  #: given values that an instructor states, by name, in canonical units
NONE_STATED: Stated = MappingProxyType({})

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
    low, high = spec.bounds(drawn)
    low, high = grid.first(low), grid.last(high)
    count = np.maximum(high - low + 1, 0)
    without_zero = (low <= 0) & (high >= 0) if spec.nonzero else np.zeros_like(count, dtype=bool)
    count = np.where(without_zero, count - 1, count)
    if count.max(initial=0) >= 2**31:
        raise BadCourse(f"a range holds {count.max():,} steps of {float(spec.step):g}; make the step coarser")
    k = low + ((high_half * count.astype(np.uint64)) >> np.uint64(32)).astype(np.int64)
    k = np.where(without_zero & (k >= 0), k + 1, k)
    return np.where(count > 0, grid.value(k), np.nan)


def _all_values(spec: GivenSpec, partial: Mapping[str, Any]) -> list[float | str]:
    if spec.is_choice:
        return list(spec.choices)
    if spec.is_fixed:
        return [_constant(spec)]
    grid = _Grid.of(spec.step)
    low, high = spec.bounds(partial)
    steps = range(int(grid.first(low)), int(grid.last(high)) + 1)
    return [float(grid.value(np.int64(k))) for k in steps if k or not spec.nonzero]


def _empty_ranges(drawn: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return which candidates have an empty range, by ``range of NAME is empty``, of the first such."""
    refused: dict[str, np.ndarray] = {}
    empty = np.zeros(len(next(iter(drawn.values()))), dtype=bool)
    for name, values in drawn.items():
        if values.dtype.kind == "f" and (here := np.isnan(values) & ~empty).any():
            refused[f"range of {name} is empty"] = here
            empty |= here
    return refused


def _none() -> Solution:
    raise BadCourse("a constraint names a mistake of the solution, and there is none")


class Draws:
    """Draws of an exercise: its given quantities, and its constraints joined with what computes the
    quantities that they need.

    A constraint of given quantities and helpers alone is evaluated first; only the candidates that satisfy
    all such are passed to the graph of the reference solution, which computes the quantities that the other
    constraints name, and no others.

    Parameters
    ----------
    name
        The name of the exercise, which keys the stream.
    spec
        The exercise.
    solution
        A function that returns the reference solution; called only where a constraint needs it.
    """

    def __init__(self, name: str, spec: Exercise, solution: Callable[[], Solution] | None = None):
        self.name = name
        self.spec = spec
        self._solution = _none if solution is None else solution
        helpers = {f.__name__: f for f in spec.helpers}
        stated = {f.__name__: f for f in spec.constraints if not isinstance(f, Detectable)}
        own = Graph({**helpers, **stated})
        known = frozenset(spec.given)
        self._direct = tuple(n for n in stated if own.ancestors((n,)) <= known | own.names)
        self._direct_graph = Graph({**helpers, **{n: stated[n] for n in self._direct}})
        self._computed = {n: f for n, f in stated.items() if n not in self._direct}
        self._detectable = tuple(f for f in spec.constraints if isinstance(f, Detectable))
        if solution is None:
            self._check(own, tuple(stated))

    def _check(self, graph: Graph, names: Sequence[str]) -> None:
        """Refuse constraints that need what is neither given nor computed."""
        try:
            graph.plan(names, self.spec.given)
        except MissingQuantity as fault:
            near = nearest(fault.names[0], {*self.spec.given, *graph.quantities} - {*names})
            raise BadCourse(f"{self.name}: a constraint cannot be evaluated: {fault.needed}{near}") from fault
        except CourseworkError as fault:
            raise BadCourse(f"{self.name}: a constraint cannot be evaluated: {fault}") from fault

    # -------------------------------------------------------------- constraints

    @cached_property
    def _graph(self) -> Graph:
        """The reference quantities with the helpers and the constraints that need them. Raises BadCourse:
        says which constraint needs something unknown, and what."""
        graph = self._solution().graph
        twice = graph.names & self._computed.keys()
        if twice:
            raise BadCourse(
                f"{self.name}: {min(twice)} is a constraint and a quantity; rename the constraint"
            )
        # A helper that bears the name of a quantity says it of the figure; these constraints take the
        # reference.
        helpers = {f.__name__: f for f in self.spec.helpers if f.__name__ not in graph.names}
        graph = graph.with_functions({**helpers, **self._computed})
        self._check(graph, tuple(self._computed))
        return graph

    def refused(self, drawn: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Return for each constraint which candidates it refuses, shape ``(n,)``.

        A candidate with an empty range is refused as ``range of NAME is empty``.
        """
        return _empty_ranges(drawn) | self._refused_directly(drawn) | self._refused_by_answers(drawn)

    def accepted(self, drawn: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return which candidates are variants, shape ``(n,)``."""
        size = len(next(iter(drawn.values())))
        good = np.ones(size, dtype=bool)
        for mask in (_empty_ranges(drawn) | self._refused_directly(drawn)).values():
            good &= ~mask
        if (self._computed or self._detectable) and good.any():
            rows = np.flatnonzero(good)
            for mask in self._refused_by_answers({n: values[rows] for n, values in drawn.items()}).values():
                good[rows] &= ~mask
        return good

    def _refused_directly(self, drawn: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        graph = self._direct_graph
        values = graph.evaluate(self._direct, {n: v for n, v in drawn.items() if n in graph.leaves})
        return _refusals(values, drawn)

    def _refused_by_answers(self, drawn: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        if not self._computed and not self._detectable:
            return {}
        graph, solution = self._graph, self._solution()
        effects = self.spec.effects
        known = {n: v for n, v in drawn.items() if n in graph.leaves or n in graph.quantities}
        requested = dict.fromkeys(q for constraint in self._detectable for q in constraint.quantities)
        found = graph.everything((*self._computed, *requested), known, effects)
        answers = {name: found[name] for name in self._computed}
        right = {n: v for n, v in found.items() if n in solution.graph.names}
        for constraint in self._detectable:
            mistaken = solution.mistaken(constraint.mistake)
            # A condition alone may know what the solution has no use for.
            used = {n: v for n, v in known.items() if n in mistaken.leaves or n in mistaken.quantities}
            wrong = mistaken.evaluate(constraint.quantities, used, effects, right)
            with np.errstate(all="ignore"):
                holds = [constraint.holds(self._part_of(n), value, found[n]) for n, value in wrong.items()]
            answers[constraint.__name__] = np.all(np.broadcast_arrays(*holds), axis=0)
        return _refusals(answers, drawn)

    def _part_of(self, quantity: str) -> Part:
        """Return the part that asks a quantity; one with the usual tolerance where none does."""
        part = next((p for p in self.spec.parts if p.quantity == quantity), None)
        return part or Part(quantity, unit=self._solution().units.get(quantity, "1"))

    # -------------------------------------------------------------------- draws

    def candidates(self, words: np.ndarray, stated: Stated = NONE_STATED) -> dict[str, np.ndarray]:
        """Return given quantities from raw bits of shape (n, number of given quantities); those that are
        stated as they are."""
        drawn: dict[str, np.ndarray] = {}
        for column, (name, spec) in enumerate(self.spec.given.items()):
            if name in stated:
                drawn[name] = np.full(len(words), stated[name])
            else:
                drawn[name] = _draw_one(spec, words[:, column], drawn)
        return drawn

    def is_whole(self, stated: Stated) -> bool:
        """Return whether values are stated, and nothing is left to draw beside them."""
        return bool(stated) and all(name in stated or spec.is_fixed for name, spec in self.spec.given.items())

    def refusing(self, given: Mapping[str, float | str]) -> tuple[str, ...]:
        """Return the names of the constraints that given values do not meet."""
        refused = self.refused({name: np.array([value]) for name, value in given.items()})
        return tuple(name for name, mask in refused.items() if mask.any())

    def _block(self, seed: int, block: int, secret: Secret | None = None) -> np.ndarray:
        return _words(self.name, self.spec.version, seed, block, len(self.spec.given), secret)

    def draw(
        self, seeds: Sequence[int], secret: Secret | None = None, stated: Stated = NONE_STATED
    ) -> list[dict[str, float | str]]:
        """Return the given values of each seed's variant, in canonical units; with a secret, of each code of
        an assignment.

        Stated values, in canonical units, are not drawn. Where nothing is left to draw, no constraint refuses
        them; :meth:`refusing` names those that would.

        Raises
        ------
        Starved
            Some seed finds no variant in its bounded draws; the message names the constraint that refuses
            most.
        """
        if self.is_whole(stated):
            specs = self.spec.given.items()
            return [{n: stated[n] if n in stated else _constant(s) for n, s in specs} for _ in seeds]
        draws: list[dict[str, float | str] | None] = [None] * len(seeds)
        pending = np.arange(len(seeds))
        first_block, count = 0, 1
        while first_block < MAX_BLOCKS:
            # The next blocks of candidates for each pending seed, twice as many each time, since what refuses
            # the first ones often refuses all; some thousand blocks at a time, so that memory stays flat.
            blocks = range(first_block, min(first_block + count, MAX_BLOCKS))
            size = max(1, 4096 // len(blocks))
            still = []
            for start in range(0, len(pending), size):
                chunk = pending[start : start + size]
                words = np.concatenate([self._block(seeds[i], b, secret) for i in chunk for b in blocks])
                drawn = self.candidates(words, stated)
                good = self.accepted(drawn).reshape(len(chunk), -1)
                first = good.argmax(axis=1)
                hit = good.any(axis=1)
                rows = np.flatnonzero(hit) * good.shape[1] + first[hit]
                columns = {n: values[rows].tolist() for n, values in drawn.items()}
                for position, i in enumerate(chunk[hit]):
                    draws[i] = {n: column[position] for n, column in columns.items()}
                still.append(chunk[~hit])
            pending = np.concatenate(still) if still else pending[:0]
            if not len(pending):
                return draws  # type: ignore[return-value]  # none is left out
            first_block, count = blocks.stop, 2 * count
        raise self._starved(seeds[pending[0]], secret, stated)

    def _starved(self, seed: int, secret: Secret | None, stated: Stated) -> Starved:
        """Return the error for a seed without a variant: it names the constraints that refuse most of its
        draws."""
        words = np.concatenate([self._block(seed, block, secret) for block in range(MAX_BLOCKS)])
        refused = self.refused(self.candidates(words, stated))
        refusals = Counter({constraint: int(mask.sum()) for constraint, mask in refused.items()})
        if stated:
            return Starved(
                "{exercise}: there is no variant with {values}; refused by {constraints}; change one "
                "of the values",
                exercise=self.name,
                values=", ".join(f"{name} = {value}" for name, value in stated.items()),
                constraints=", ".join(name for name, count in refusals.most_common(3) if count),
            )
        worst = [
            Message("{constraint} ({count} times)", constraint=self._said(name), count=count)
            for name, count in refusals.most_common(3)
            if count
        ]
        return Starved(
            "{exercise}: seed {seed} found no variant in {draws} draws; refused by {worst}; widen a "
            "range or relax the constraint",
            exercise=self.name,
            seed=seed,
            draws=len(words),
            worst=Message(
                ", ".join(f"{{w{k}}}" for k in range(len(worst))), **{f"w{k}": w for k, w in enumerate(worst)}
            ),
        )

    def _said(self, constraint: str) -> str:
        """Return a constraint as messages name it: the condition that a mechanism's file states, or its
        name."""
        stated = next((c for c in self.spec.constraints if getattr(c, "__name__", "") == constraint), None)
        said = getattr(stated, "said", "")
        return as_message(said) if said else constraint

    def acceptance(self, count: int = 4096) -> float:
        """Return the share of candidates that are variants."""
        return float(self.accepted(self.first_candidates(count)).mean())

    def first_candidates(self, count: int) -> dict[str, np.ndarray]:
        """Return the first candidates of the first seeds, at least so many, whether or not they are
        variants."""
        seeds = range(math.ceil(count / BLOCK))
        return self.candidates(np.concatenate([self._block(seed, 0) for seed in seeds]))

    def population(self, limit: int = 200_000) -> int | None:
        """Return the number of distinct variants, by trying every combination; None beyond ``limit``
        combinations."""
        combinations: list[dict[str, float | str]] = [{}]
        for name, spec in self.spec.given.items():
            grown = []
            for partial in combinations:
                grown += [{**partial, name: value} for value in _all_values(spec, partial)]
                if len(grown) > limit:
                    return None
            combinations = grown
        if not combinations:
            return 0
        return int(self.accepted({n: np.array([c[n] for c in combinations]) for n in self.spec.given}).sum())


def _refusals(answers: Mapping[str, Any], drawn: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    size = len(next(iter(drawn.values())))
    return {name: ~np.broadcast_to(np.asarray(a, dtype=bool), (size,)) for name, a in answers.items()}
