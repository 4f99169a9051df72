"""Time and error of every way to compute, measured at run time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from coursework.accuracy.conditioning import unavoidable
from coursework.accuracy.hard_places import GROWING, VANISHING, HardPlace
from coursework.accuracy.motion import motion_rows
from coursework.accuracy.reference import ClosureResidual
from coursework.accuracy.subject import MOTION, WHATS, Places, Subject, numbers_of, one_by_one, together
from coursework.accuracy.timing import Times, interleaved
from coursework.accuracy.ways import ComputingMethod, Values, ways
from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, BadInput, CourseworkError
from coursework.system.extras import libraries

GENERIC, HARD = "generic", "hard"
DATA = "data"  #: the family of what the last digits of the data do by themselves
_PLACES_OF_A_SORT = 3  #: hard places that all ways are put to
_TIMED = 10_000


@dataclass(frozen=True)
class Measurement:
    """Measurement of one way at one kind of place.

    ``max_error`` is the largest, over places and quantities, against the reference: radians for angles; for
    the rest parts of the value, or of its usual size where that is larger; beside a vanishing length parts of
    the value itself. For motions in time, radians of the driver after the whole motion. ``failed`` of the
    ``n`` places have no answer though there is one, and do not count; the error is None when none has one.
    Times are medians, with the quartiles beside; ``build_ns`` is what a table costs before its first use.
    """

    exercise: str
    what: str
    method: str
    place: str
    ns_per_configuration: float
    max_error: float | None
    n: int
    failed: int
    family: str
    setting: float | None
    ns_low: float = 0.0
    ns_high: float = 0.0
    rounds: int = 1
    build_ns: float | None = None

    def as_json(self) -> dict[str, Any]:
        return asdict(self)

    @property
    def median(self) -> float:
        return self.ns_per_configuration

    @property
    def low(self) -> float:
        return self.ns_low or self.ns_per_configuration

    @property
    def high(self) -> float:
        return self.ns_high or self.ns_per_configuration


def needs_mpmath() -> None:
    """Refuse to measure without mpmath."""
    libraries(("mpmath",), "accuracy is measured against", "accuracy")


def subject_of(exercise: CourseExercise) -> Subject:
    """Return the measured subject of an exercise.

    Raises
    ------
    BadInput
        It asks for no number, or has no solution; or mpmath is not installed.
    """
    needs_mpmath()
    if not numbers_of(exercise):
        raise BadInput(
            (
                "{name} asks for no number that could lose digits, so there is nothing to measure: "
                "counts, choices "
                "and equations are exact"
            ),
            name=exercise.name,
        )
    return Subject(exercise)


def measure(exercise: CourseExercise, *, quick: bool = False) -> Iterator[Measurement]:
    """Yield the rows of an exercise as they are measured.

    Raises
    ------
    BadInput
        As :func:`subject_of`.
    BadCourse
        The reference does not close the equations that the solution states besides: its formulas are wrong.
    """
    subject = subject_of(exercise)
    checked(subject)
    if not subject.reference.wanted:
        raise BadInput(
            (
                "{name}: no reference for {lacking}: its formula cannot be evaluated with many digits; "
                "formulas with "
                "coursework.degrees and numpy's elementary functions can"
            ),
            name=exercise.name,
            lacking=", ".join(subject.reference.lacking),
        )
    for sort in WHATS:
        if subject.quantities(sort):
            yield from _Trial(subject, sort, quick).rows()
    if subject.study.motion is not None:
        for m in motion_rows(exercise, subject.study, quick):
            yield Measurement(
                exercise.name,
                MOTION,
                f"{m.method}-{m.setting:g}",
                m.place,
                1e9 * m.times.median,
                m.error,
                1,
                0,
                m.method,
                m.setting,
                1e9 * m.times.low,
                1e9 * m.times.high,
                m.times.rounds,
                m.build and 1e9 * m.build,
            )


def checked(subject: Subject, seeds: Sequence[int] = (0, 1)) -> ClosureResidual | None:
    """Check the reference by the stated equations; None where the solution states none.

    Raises
    ------
    BadCourse
        The values do not close the equations.
    """
    closing = subject.reference.closing(v.given for v in subject.exercise.variants(seeds))
    if closing is not None and not closing.is_closed:
        raise BadCourse(
            f"{subject.exercise.solution.source}: its formulas and its equations contradict each other: "
            f"{closing.equation} lacks {closing.lack:.1e} of its terms to close; with a wrong formula "
            "nothing can be "
            "called exact, so nothing is measured"
        )
    return closing


class _Trial:
    """Ways to one kind of quantity: timed at generic places, compared there and at hard ones."""

    def __init__(self, subject: Subject, sort: str, quick: bool) -> None:
        self.subject, self.what, self.quick = subject, sort, quick
        self.wanted = subject.quantities(sort)
        self.timed = subject.generic(_TIMED)
        self.compared = _first(self.timed, 60 if quick else 400)

    def rows(self) -> Iterator[Measurement]:
        subject = self.subject
        fixed = subject.base if subject.driver else None
        methods = list(ways(subject, self.what, fixed))
        reference = self._reference(self.compared)
        scales = usual_sizes(subject, self.wanted, reference)
        times = self._times(methods)
        for method, spent in zip(methods, times, strict=True):
            compared = _first(self.compared, self._few) if method.one_by_one else self.compared
            error, failed, count = compare(subject, _computed(method, compared), reference, scales)
            yield self._row(method, GENERIC, spent, error, count, failed)
        yield from self._hard_rows(methods, times, scales)

    @property
    def _few(self) -> int:
        return 20 if self.quick else 200

    def _times(self, methods: Sequence[ComputingMethod]) -> list[Times]:
        """Return the times of every way at generic places, measured in rounds."""
        counts = [10 if method.one_by_one else _TIMED for method in methods]
        calls = [
            partial(_computed, method, _first(self.timed, count))
            for method, count in zip(methods, counts, strict=True)
        ]
        at_least, budget = (1e-3, 0.05) if self.quick else (5e-3, 0.5)
        result = interleaved(calls, at_least, budget, 15 if self.quick else 25)
        return [spent.per(count) for spent, count in zip(result, counts, strict=True)]

    def _hard_rows(
        self, methods: Sequence[ComputingMethod], times: Sequence[Times], scales: Mapping[str, float]
    ) -> Iterator[Measurement]:
        """Yield the rows at the places with the largest loss.

        A way that needs a fixed mechanism takes part only where the driver moves.
        """
        worst: dict[str, tuple[float | None, int, int]] = {}
        least = 0.0
        for point in self._places:
            places = together(list(point.approach(point.distances(self.quick))))
            reference = self._reference(places)
            fixed = point.given if point.moved == self.subject.driver else None
            sizes = dict.fromkeys(scales, 0.0) if point.kind in (VANISHING, GROWING) else scales
            least = max(least, unavoidable_of(self.subject, places, reference, sizes))
            for method in ways(self.subject, self.what, fixed):
                result = compare(self.subject, _computed(method, places), reference, sizes)
                worst[method.name] = _worse(worst.get(method.name), result)
        for method, spent in zip(methods, times, strict=True):
            if method.name in worst and worst[method.name][2]:
                error, failed, count = worst[method.name]
                yield self._row(method, HARD, spent, error, count, failed)
        if worst:
            count = max(n for _, _, n in worst.values())
            yield Measurement(
                self.subject.exercise.name, self.what, DATA, HARD, 0.0, least, count, 0, DATA, None
            )

    @property
    def _places(self) -> list[HardPlace]:
        """Hardest places along the driver if there are any, since every way applies there; otherwise the
        hardest of all."""
        driven = [p for p in self.subject.hard if p.moved == self.subject.driver]
        return (driven or list(self.subject.hard))[:_PLACES_OF_A_SORT]

    def _row(
        self, method: ComputingMethod, point: str, spent: Times, error: float | None, count: int, failed: int
    ) -> Measurement:
        return Measurement(
            self.subject.exercise.name,
            self.what,
            method.name,
            point,
            1e9 * spent.median,
            error,
            count,
            failed,
            method.family,
            method.setting,
            1e9 * spent.low,
            1e9 * spent.high,
            spent.rounds,
            method.build and 1e9 * method.build,
        )

    def _reference(self, places: Places) -> dict[str, list[Any]]:
        return right_values(self.subject, places, self.wanted)


def right_values(subject: Subject, places: Places, wanted: Sequence[str]) -> dict[str, list[Any]]:
    """Return the reference at each place; None where there is no value."""
    rows = [subject.reference.at(point) for point in one_by_one(places)]
    return {name: [row[name] for row in rows] for name in wanted}


def _first(places: Places, count: int) -> Places:
    return {n: v if np.ndim(v) == 0 else v[:count] for n, v in places.items()}


def _computed(method: ComputingMethod, places: Places) -> Values:
    """Return the values of a way; nothing where it stops with an error."""
    try:
        return method.compute(places)
    except CourseworkError:
        return {}


def usual_sizes(
    subject: Subject, wanted: Sequence[str], reference: Mapping[str, Sequence[Any]]
) -> dict[str, float]:
    """Return the typical size of each quantity; of an angle a radian."""
    sizes = {}
    for name in wanted:
        values = [abs(float(v)) for v in reference[name] if v is not None]
        usual = float(np.median(values)) if values else 1.0
        sizes[name] = math.degrees(1.0) if subject.exercise.units.get(name) == "deg" else usual
    return sizes


def compare(
    subject: Subject,
    results: Mapping[str, Any],
    reference: Mapping[str, Sequence[Any]],
    scales: Mapping[str, float],
) -> tuple[float | None, int, int]:
    """Return the largest error, the number of places with a missing answer, and the number of places with a
    right answer."""
    count = _count(results, reference)
    errors = np.zeros(count)
    exists = np.zeros(count, dtype=bool)
    for name, scale in scales.items():
        full = subject.exercise.units.get(name) == "deg"
        values = results.get(name)
        values = [math.nan] * count if values is None else values
        values = values if isinstance(values, list) else np.broadcast_to(values, (count,))
        for i in range(count):
            right = reference[name][i]
            if right is not None:
                exists[i] = True
                size = scale if full and scale else max(scale, abs(float(right))) or 1.0
                errors[i] = np.maximum(errors[i], _difference(values[i], right, full) / size)
    answered = exists & np.isfinite(errors)
    largest = float(errors[answered].max()) if answered.any() else None
    return largest, int((exists & ~answered).sum()), int(exists.sum())


def unavoidable_of(
    subject: Subject, places: Places, reference: Mapping[str, Sequence[Any]], scales: Mapping[str, float]
) -> float:
    """Return the largest error due to the last digits of the data, measured like all other errors."""
    largest = 0.0
    for i, point in enumerate(one_by_one(places)):
        values = {name: reference[name][i] for name in scales if reference[name][i] is not None}
        for name, moves in unavoidable(subject.reference, point, values).items():
            full = subject.exercise.units.get(name) == "deg"
            size = (
                scales[name] if full and scales[name] else max(scales[name], abs(float(values[name]))) or 1.0
            )
            largest = max(largest, moves / size)
    return largest


def _count(results: Mapping[str, Any], reference: Mapping[str, Sequence[Any]]) -> int:
    """Return the number of places that a way computed; single solves take fewer."""
    full = len(next(iter(reference.values())))
    sizes = [len(v) for v in results.values() if np.ndim(v)]
    return min([full, *sizes])


def _difference(value: Any, right: Any, is_turn: bool) -> float:
    """Return |value - right|, modulo a turn for an angle; NaN where there is no value."""
    context = right.context
    if value is None:
        return math.nan
    if not hasattr(value, "context"):
        near = float(value)
        if not math.isfinite(near):
            return math.nan
        value = context.mpf(near) + context.mpf(float(value - type(value)(near)))
    apart = context.mpf(value) - right
    if is_turn:
        apart -= 360 * context.nint(apart / 360)
    return float(abs(apart))


def _worse(
    first: tuple[float | None, int, int] | None, other: tuple[float | None, int, int]
) -> tuple[float | None, int, int]:
    if first is None:
        return other
    errors = [e for e in (first[0], other[0]) if e is not None]
    return max(errors, default=None), first[1] + other[1], first[2] + other[2]
