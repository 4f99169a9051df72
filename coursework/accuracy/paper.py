"""Accuracy on paper: the digits that a student keeps, and the margin for them.

The same simulated students as in ``coursework check``: who does everything right and rounds each step; who
makes a named mistake; who hands in the neighbour's variant. Against them stand a plain margin, and one that
is widened to what rounding on the way can do to an answer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from coursework.accuracy.subject import numbers_of
from coursework.course.answer_key import envelopes
from coursework.course.exercise import CourseExercise
from coursework.errors import CourseworkError
from coursework.model import Part
from coursework.quantities.rounding import student_who_rounds

DIGITS = (2, 3, 4, 5, 6)
PLAIN = 0  #: stands for a margin that is not widened
_SEES = 1e-6  #: relative: a mistake that changes an answer by less does not show
_NEIGHBOURS = (1, 2, 3)


@dataclass(frozen=True)
class Share:
    """Part of a number of answers."""

    of: int = 0
    found: int = 0

    def __add__(self, other: Share) -> Share:
        return Share(self.of + other.of, self.found + other.found)

    @property
    def value(self) -> float:
        return self.found / self.of if self.of else 0.0


@dataclass(frozen=True)
class PaperRow:
    """Row of an exercise, or of all, at one number of digits; ``PLAIN`` for the margin without widening.

    For right answers, rounded at each step to this number of digits: how many a plain margin marks wrong, and
    how many the course's own. For wrong answers: how many a margin for this number of digits accepts.
    """

    exercise: str
    digits: int
    wronged: Share
    wronged_ours: Share
    mistakes: Share
    neighbours: Share

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


def on_paper(exercise: CourseExercise, variants: int, digits: Sequence[int] = DIGITS) -> list[PaperRow]:
    """Return the rows of one exercise, the plain margin first; none where it asks for no number."""
    parts = [p for p in exercise.spec.parts if p.kind in ("number", "angle") and p.has_margin]
    parts = [p for p in parts if p.quantity in numbers_of(exercise)]
    if not parts:
        return []
    room = _Room(exercise, parts, variants)
    return [room.row(PLAIN), *(room.row(stored) for stored in digits)]


class _Room:
    """Simulated students of one exercise, each with a variant."""

    def __init__(self, exercise: CourseExercise, parts: Sequence[Part], variants: int) -> None:
        self.exercise, self.parts, self.count = exercise, parts, variants
        self.wanted = tuple(dict.fromkeys(p.quantity for p in parts))
        drawn = exercise.variants(range(variants))
        names = [n for n in exercise.spec.given if n in exercise.quantity_names]
        self.given = {n: np.array([v.given[n] for v in drawn]) for n in names}
        self.asked = {p.id: np.array([p.is_asked(v.given) for v in drawn]) for p in parts}
        self.effects = exercise.spec.effects
        self.right = self._answers(exercise.solution.graph)
        self.wrong = self._mistaken()

    def _answers(self, graph: Any) -> dict[str, np.ndarray]:
        return self._filled(graph.evaluate(self.wanted, self.given, self.effects))

    def _filled(self, results: Mapping[str, Any]) -> dict[str, np.ndarray]:
        return {n: np.broadcast_to(np.asarray(v, dtype=float), (self.count,)) for n, v in results.items()}

    def _mistaken(self) -> list[dict[str, np.ndarray]]:
        """Return the answers of students who make each named mistake and continue correctly."""
        results = []
        for name in self.exercise.solution.mistakes:
            try:
                results.append(self._answers(self.exercise.solution.mistaken(name)))
            except (CourseworkError, TypeError, ValueError):
                continue  # it gives no number
        return results

    def row(self, stored: int) -> PaperRow:
        ours = self.exercise.folder.rules.digits
        wronged = wronged_ours = Share()
        if stored != PLAIN:
            rounded = self._filled(
                student_who_rounds(
                    self.exercise.solution.graph, self.wanted, self.given, self.effects, stored
                )
            )
            wronged, wronged_ours = self._refused(rounded, PLAIN), self._refused(rounded, ours)
        mistakes = sum((self._passed(wrong, stored) for wrong in self.wrong), Share())
        return PaperRow(self.exercise.name, stored, wronged, wronged_ours, mistakes, self._neighbours(stored))

    def _refused(self, answers: Mapping[str, np.ndarray], margin: int) -> Share:
        result = Share()
        for part in self.parts:
            requested = self.asked[part.id] & np.isfinite(self.right[part.quantity])
            refused = requested & ~self._accepted(part, answers[part.quantity], margin)
            result += Share(int(requested.sum()), int(refused.sum()))
        return result

    def _passed(self, answers: Mapping[str, np.ndarray], margin: int) -> Share:
        """Return the share of accepted answers among those that are visibly wrong."""
        result = Share()
        for part in self.parts:
            right, pair = self.right[part.quantity], answers[part.quantity]
            apart = abs(pair - right)
            if part.sort.turn:
                apart = np.minimum(apart % part.sort.turn, -apart % part.sort.turn)
            shows = self.asked[part.id] & np.isfinite(pair) & (apart > _SEES * np.maximum(abs(right), 1e-9))
            passed = shows & self._accepted(part, pair, margin)
            result += Share(int(shows.sum()), int(passed.sum()))
        return result

    def _neighbours(self, margin: int) -> Share:
        shifted = [{n: np.roll(v, k) for n, v in self.right.items()} for k in _NEIGHBOURS]
        return sum((self._passed(value, margin) for value in shifted), Share())

    def _accepted(self, part: Part, answers: np.ndarray, margin: int) -> np.ndarray:
        right = self.right[part.quantity]
        half = np.maximum(part.atol, part.rtol * abs(right))
        if margin != PLAIN:
            half = np.maximum(half, self._widths(margin)[part.quantity])
        return part.sort.accepted(answers, right, half)

    def _widths(self, digits: int) -> dict[str, np.ndarray]:
        """Return the possible effect of rounding to ``digits`` digits at each step."""
        if digits not in self._kept_widths:
            result = envelopes(self.exercise, self.wanted, self.given, self.effects, digits)
            finite = {n: np.where(np.isfinite(v), v, 0.0) for n, v in self._filled(result).items()}
            self._kept_widths[digits] = finite
        return self._kept_widths[digits]

    @property
    def _kept_widths(self) -> dict[int, dict[str, np.ndarray]]:
        return self.__dict__.setdefault("_widths_by_digits", {})


def total(rows: Sequence[PaperRow]) -> list[PaperRow]:
    """Return the sums over all exercises, one row for each number of digits."""
    results = {}
    for digits in dict.fromkeys(row.digits for row in rows):
        selected = [row for row in rows if row.digits == digits]
        columns = [
            sum((getattr(row, name) for row in selected), Share())
            for name in ("wronged", "wronged_ours", "mistakes", "neighbours")
        ]
        results[digits] = PaperRow("", digits, *columns)
    return list(results.values())
