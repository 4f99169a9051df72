"""Approach to every hard place of an exercise, with the errors of the solver on it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coursework.accuracy.conditioning import ALLOWED, difference, unavoidable
from coursework.accuracy.hard_places import DISTANCES, TURNS, HardPlace, Terrain, hard_places
from coursework.accuracy.reference import Reference
from coursework.course.exercise import CourseExercise
from coursework.errors import CannotAssemble, CourseworkError, Undefined

_FAR = 1e-2  #: in parts of the scale
_LAST_BITS = 1e-9  #: in parts of the scale
WHOLE_TURNS = (0.0, 1e3, 1e6, 1e9)
ASIDE = (0.0, 1e-7, 1e-9)  #: off what is tuned, in parts of its value


@dataclass(frozen=True)
class Miss:
    """Answer with an error beyond eight times that of the data's last digits, or a missing answer."""

    quantity: str
    given: Mapping[str, Any]
    place: HardPlace
    distance: float
    aside: float
    error: float | None  #: in the quantity's unit; None where the solver has no answer
    relative: float | None  #: in parts of the right value
    times: float | None  #: as many times what is unavoidable

    def told(self) -> str:
        moved, tuned = self.place.moved, self.place.tuned
        where = ", ".join(f"{n} = {self.given[n]!r}" for n in filter(None, (moved, tuned)))
        rest = ", ".join(f"{n}={v}" for n, v in self.given.items() if n not in (moved, tuned))
        if self.error is None:
            return f"{self.quantity}: no answer at {where} ({rest})"
        return (
            f"{self.quantity}: off by {self.relative:.1e} relative, {self.times:.1e} x conditioning, at "
            f"{where} ({rest})"
        )


def misses(
    exercise: CourseExercise, wanted: Sequence[str], *, distances: Sequence[float] = DISTANCES, most: int = 8
) -> Iterator[Miss]:
    """Yield the answers of the solver that are worse than their conditioning, on the approach to each hard
    place."""
    reference = Reference(exercise, wanted)
    for point in hard_places(exercise, reference.wanted, most):
        for aside in ASIDE if point.tuned else ASIDE[:1]:
            yield from misses_near(reference, point, distances, aside)
    yield from _after_turns(reference)


def _after_turns(reference: Reference) -> Iterator[Miss]:
    """Yield the answers that change after whole turns of an angle."""
    terrain = Terrain(reference.exercise, reference.wanted)
    base = terrain.bases[0]
    for name in terrain.angles:
        if terrain.turns(name):
            point = HardPlace(base, name, 360.0, TURNS, name)
            yield from _along(reference, point, 0.0, [(n, point.at(n)) for n in WHOLE_TURNS])


def misses_near(
    reference: Reference, point: HardPlace, distances: Sequence[float], aside: float = 0.0
) -> Iterator[Miss]:
    """Yield the misses on the approach to one hard place."""
    for side in point.sides:
        path = [(d, point.at(side * d, aside)) for d in distances]
        path = [(d, given) for d, given in path if _has_lengths(reference, given)]
        if path:
            yield from _along(reference, point, aside, path)


def _along(
    reference: Reference, point: HardPlace, aside: float, path: Sequence[tuple[float, Mapping[str, Any]]]
) -> Iterator[Miss]:
    """Yield the misses from far to near on one side; a quantity that has an answer somewhere must have one
    everywhere."""
    result = solved(reference, [given for _, given in path])
    answers = {n for n, values in result.items() if np.isfinite(values).any()}
    other: set[str] = set()
    for i, (distance, given) in enumerate(path):
        right = {n: v for n, v in reference.at(given).items() if v is not None and n in answers - other}
        off = {n: _off(reference, n, result[n][i], v) for n, v in right.items()}
        if distance >= _FAR:
            # So far from the place no rounding explains this: the formula is of another case of the
            # mechanism.
            other |= {n for n, error in off.items() if error > 1e-6 * _largest(right[n])}
        # What is right to the last digits needs no conditioning.
        doubtful = {
            n: right[n]
            for n, error in off.items()
            if n not in other and not error <= 1e-15 * abs(float(right[n]))
        }
        allowed = unavoidable(reference, given, doubtful) if doubtful else {}
        for name in doubtful:
            error = off[name]
            if error != error:
                if not _is_judged(reference, name, given, distance):
                    yield Miss(name, given, point, distance, aside, None, None, None)
            elif error > ALLOWED * allowed[name]:
                size = abs(float(right[name])) or 1.0
                yield Miss(name, given, point, distance, aside, error, error / size, error / allowed[name])


def _is_judged(reference: Reference, name: str, given: Mapping[str, Any], distance: float) -> bool:
    """Return whether the solver rejects the quantity there with a message, or a last bit decides.

    Near the place, an answer that exists when requested alone may be just out of reach when requested with
    others.
    """
    known_values = reference.exercise.intake.values(given)
    try:
        alone = reference.exercise.solution.graph.evaluate((name,), known_values, reference.effects)[name]
    except (CannotAssemble, Undefined):
        return True
    return distance < _LAST_BITS and bool(np.isfinite(alone))


def _largest(right: Any) -> float:
    return max(abs(float(right)), 1e-9)


def _has_lengths(reference: Reference, given: Mapping[str, Any]) -> bool:
    """Return whether all given quantities that must be positive are."""
    specs = reference.exercise.spec.given
    return all(given[n] > 0 for n, s in specs.items() if s.positive and n in given)


def _off(reference: Reference, name: str, value: float, right: Any) -> float:
    if not np.isfinite(value):
        return float("nan")
    return float(abs(difference(reference, name, reference.mp.mpf(float(value)), right)))


def solved(reference: Reference, places: Sequence[Mapping[str, Any]]) -> dict[str, np.ndarray]:
    """Return the solver's own answers, all places in one call."""
    exercise = reference.exercise
    known_values = [{**exercise.intake.defaults, **given} for given in places]
    given = {
        n: v if isinstance(v, str) else np.array([float(k[n]) for k in known_values])
        for n, v in known_values[0].items()
        if n in exercise.quantity_names
    }
    used = exercise.intake.values(given)  # as every request is: angles reduced to one turn
    results = {}
    for name in reference.wanted:
        try:
            value = exercise.solution.graph.evaluate((name,), used, reference.effects)[name]
            results[name] = np.broadcast_to(np.asarray(value, dtype=float), (len(places),))
        except CourseworkError:
            results[name] = np.full(len(places), np.nan)
    return results
