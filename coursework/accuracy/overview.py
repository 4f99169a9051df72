"""Overview: for each exercise the digits kept, their cost, and the check of the reference."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import Any

from coursework.accuracy.conditioning import ALLOWED, unavoidable
from coursework.accuracy.hard_places import GROWING, VANISHING, HardPlace
from coursework.accuracy.measuring import checked, compare, needs_mpmath, right_values, usual_sizes
from coursework.accuracy.reference import twinned
from coursework.accuracy.subject import Places, Subject, numbers_of, one_by_one, together
from coursework.accuracy.timing import Times, interleaved
from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, CourseworkError

_TIMED = 10_000
_RIGHT = 2e-15  #: relative: right to the last digits


@dataclass(frozen=True)
class OverviewLine:
    """Results of one exercise; errors are relative as in :class:`~coursework.accuracy.measuring.Measurement`.

    ``lack`` of the equation that vouches for the reference, in parts of its terms; None where none is stated.
    At the hard places two errors: the solver's and the textbook formula's; ``beyond`` is the solver's largest
    error there over eight times what is unavoidable at the same place, so that more than 1 is a digit that
    could be kept; ``losing`` has this number of each quantity where it is more than 1, and ``asked_losing``
    are those of them that the exercise asks for. ``wrong`` tells of formulas that contradict the stated
    equations: nothing is measured then. ``lacking`` are quantities whose formulas cannot be followed in many
    digits.
    """

    exercise: str
    quantities: int
    places: int = 0
    wrong: str = ""
    lacking: tuple[str, ...] = ()
    lack: float | None = None
    in_doubles: bool = False
    vouched: int = 0
    generic: float | None = None
    generic_textbook: float | None = None
    hard: float | None = None
    hard_textbook: float | None = None
    hard_textbook_failed: int = 0
    beyond: float = 0.0
    losing: dict[str, float] = field(default_factory=dict)
    asked_losing: tuple[str, ...] = ()
    place: dict[str, Any] | None = None
    stable_ns: Times | None = None
    textbook_ns: Times | None = None

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


def overview(exercise: CourseExercise, *, quick: bool = False) -> OverviewLine | None:
    """Return the results of an exercise; None where it asks for no number.

    Raises
    ------
    BadInput
        mpmath is not installed.
    """
    needs_mpmath()
    if not numbers_of(exercise):
        return None
    subject = Subject(exercise)
    try:
        closing = checked(subject)
    except BadCourse as fault:
        return OverviewLine(exercise.name, len(subject.numbers), wrong=str(fault))
    if not subject.reference.wanted:
        return OverviewLine(exercise.name, 0, lacking=subject.reference.lacking)
    return _Survey(subject, quick).line(closing)


class _Survey:
    def __init__(self, subject: Subject, quick: bool) -> None:
        self.subject, self.quick = subject, quick
        self.wanted = subject.reference.wanted
        graph = subject.exercise.solution.graph
        self.graphs = {"stable": graph, "textbook": twinned(graph.textbook)}

    def line(self, closing: Any) -> OverviewLine:
        compared = self.subject.generic(40 if self.quick else 200)
        reference = right_values(self.subject, compared, self.wanted)
        scales = usual_sizes(self.subject, self.wanted, reference)
        generic = {
            method: compare(self.subject, self._values(method, compared), reference, scales)[0]
            for method in self.graphs
        }
        times = self._times()
        return OverviewLine(
            self.subject.exercise.name,
            len(self.wanted),
            len(self.subject.hard),
            lacking=self.subject.reference.lacking,
            lack=closing and closing.lack,
            in_doubles=bool(closing and closing.in_doubles),
            vouched=len(closing.held & set(self.wanted)) if closing else 0,
            generic=generic["stable"],
            generic_textbook=generic["textbook"],
            **self._hard(scales),
            stable_ns=times[0],
            textbook_ns=times[1],
        )

    def _hard(self, scales: dict[str, float]) -> dict[str, Any]:
        """Return the largest errors over all hard places, the place where the solver's is largest, and the
        quantities that lose digits."""
        results: dict[str, Any] = {}
        losing: dict[str, float] = {}
        for point in self.subject.hard:
            subset = self._at(
                point, dict.fromkeys(scales, 0.0) if point.kind in (VANISHING, GROWING) else scales
            )
            if subset is None:
                continue
            for name, times in subset.pop("losing").items():
                losing[name] = max(times, losing.get(name, 0.0))
            if subset["beyond"] > results.get("beyond", -1.0):
                results["place"] = _place_text(point)
            for name, value in subset.items():
                if value is not None:
                    results[name] = max(results.get(name, 0), value)
        losing_names = tuple(name for name in self.subject.numbers if name in losing)
        return {**results, "losing": losing, "asked_losing": losing_names}

    def _at(self, point: HardPlace, scales: dict[str, float]) -> dict[str, Any] | None:
        places = together(list(point.approach(point.distances(self.quick))))
        reference = right_values(self.subject, places, self.wanted)
        solver, textbook = (self._values(method, places) for method in self.graphs)
        names = [n for n in self.wanted if self._is_same_case(n, solver, reference)]
        if not names:
            return None
        scales = {n: scales[n] for n in names}
        error, _, _ = compare(self.subject, solver, reference, scales)
        of_formula, failed, _ = compare(self.subject, textbook, reference, scales)
        beyond = self._beyond(places, reference, names, solver)
        return {
            "hard": error,
            "hard_textbook": of_formula,
            "hard_textbook_failed": failed,
            "beyond": max(beyond.values(), default=0.0),
            "losing": {name: times for name, times in beyond.items() if times > 1},
        }

    def _is_same_case(self, name: str, solver: dict[str, Any], reference: dict[str, list[Any]]) -> bool:
        """Return whether the formula computes the same case as the solver: at the farthest place, rounding
        cannot explain a difference."""
        first = {name: reference[name][:1]}
        error, failed, count = compare(
            self.subject,
            {name: _entry(solver.get(name), 0)},
            first,
            {name: abs(float(first[name][0] or 1.0))},
        )
        return bool(count) and not failed and (error or 0.0) < 1e-6

    def _beyond(
        self, places: Places, reference: dict[str, list[Any]], names: Sequence[str], solver: dict[str, Any]
    ) -> dict[str, float]:
        """Return the largest error of each quantity by the solver, relative to eight times the unavoidable
        error at the same place."""
        worst: dict[str, float] = {}
        for i, point in enumerate(one_by_one(places)):
            doubtful = {}
            for name in names:
                single = {name: reference[name][i : i + 1]}
                error, _, _ = compare(self.subject, {name: _entry(solver.get(name), i)}, single, {name: 0.0})
                if error and error > _RIGHT:
                    doubtful[name] = error
            # What is right to the last digits needs no conditioning.
            values = {name: reference[name][i] for name in doubtful}
            least = unavoidable(self.subject.reference, point, values) if doubtful else {}
            for name, error in doubtful.items():
                size = abs(float(values[name])) or 1.0
                times = error * size / (ALLOWED * least[name]) if least[name] else math.inf
                worst[name] = max(times, worst.get(name, 0.0))
        return worst

    def _values(self, method: str, places: Places) -> dict[str, Any]:
        results: dict[str, Any] = {}
        for name in self.wanted:
            try:
                results |= self.graphs[method].evaluate((name,), places, self.subject.effects)
            except CourseworkError:
                continue
        return results

    def _times(self) -> Sequence[Times]:
        timed = self.subject.generic(_TIMED)
        calls = [partial(self._together, method, timed) for method in self.graphs]
        at_least, rounds = (1e-3, 7) if self.quick else (1e-2, 11)
        return [t.per(_TIMED) for t in interleaved(calls, at_least, rounds=rounds)]

    def _together(self, method: str, places: Places) -> Any:
        return self.graphs[method].evaluate(self.wanted, places, self.subject.effects)


def _entry(values: Any, i: int) -> Any:
    """Return one entry of an answer, as an array of length one."""
    import numpy as np

    if values is None:
        return np.array([np.nan])
    return np.asarray(values)[i : i + 1] if np.ndim(values) else np.array([values])


def _place_text(point: HardPlace) -> dict[str, Any]:
    return {
        "moved": point.moved,
        "tuned": point.tuned,
        "kind": point.kind,
        "quantity": point.quantity,
        "given": dict(point.given),
    }
