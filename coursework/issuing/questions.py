"""Questions that the papers of an assignment ask, in which order, and with which numbers.

A question is called by the number of its exercise on the paper and its own among those that the paper asks of
this exercise, ``2.3``; a sheet that is handed out alone has no number before its own, ``3``. Papers may ask
different questions of an exercise. What speaks of one paper gives the number on this paper; what speaks of
the class gives every number of the question, ``2.3/2.4``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property

from coursework.course.course import Course
from coursework.issuing.issued import Issued

Question = tuple[str, str]  #: exercise and part


class PaperQuestions(dict[Question, str]):
    """Numbers on the papers of all questions of a class, in the order in which the papers ask them."""

    @staticmethod
    def of(course: Course, issued: Issued, *, on_papers: bool = False) -> PaperQuestions:
        """Return the questions that were issued: the exercises as the assignment lists them, the questions as
        their exercise does. Exercises of no assignment were handed out alone, unless they are said to stand
        ``on_papers``, as those of a site do."""
        stated = [str(name) for name in (issued.assignment or {}).get("exercises", ())]
        numbered = on_papers or bool(stated)
        positions: dict[str, dict[str, set[int]]] = {name: {} for name in (*stated, *issued.exercises)}
        # Most records of an exercise share one list of parts.
        lists = {(name, id(record["parts"])): record["parts"] for (name, _), record in issued.records.items()}
        for (name, _), parts in lists.items():
            for position, part in enumerate(parts, start=1):
                positions[name].setdefault(str(part["id"]), set()).add(position)
        return PaperQuestions(
            ((name, part), "/".join(f"{place}.{n}" if numbered else str(n) for n in sorted(found[part])))
            for place, (name, found) in enumerate(positions.items(), start=1)
            for part in _in_order(course, name, found)
        )

    def number(self, exercise: str, part: str) -> str:
        """Return all numbers of a question; empty for one that no paper asks."""
        return self.get((exercise, part), "")

    def label(self, exercise: str, part: str) -> str:
        """Return the numbers of a question, with its part if another question has the same, and with its
        exercise if that is one of another exercise."""
        number = self.number(exercise, part)
        among = [name for name, _ in self._by_number.get(number, ())]
        if len(among) < 2:
            return number
        return f"{number} {part}" if {*among} == {exercise} else f"{number} {exercise} {part}"

    @cached_property
    def _by_number(self) -> dict[str, list[Question]]:
        by_number: dict[str, list[Question]] = {}
        for question, number in self.items():
            by_number.setdefault(number, []).append(question)
        return by_number

    def exercise_number(self, exercise: str) -> str:
        """Return the number of an exercise on the papers; empty for one that they do not have, and for one
        that is handed out alone."""
        number = next((number for (name, _), number in self.items() if name == exercise), "")
        return number.rpartition("/")[2].rpartition(".")[0]

    def on_paper(self, exercise: str, parts: Iterable[str]) -> dict[str, str]:
        """Return the number of each of the parts that one paper asks of an exercise, in their order."""
        place = self.exercise_number(exercise)
        return {
            part: f"{place}.{position}" if place else str(position)
            for position, part in enumerate(parts, start=1)
        }

    def called(self, number: str) -> list[Question]:
        """Return the questions with this number: with no other, else on some paper."""
        found = self._by_number.get(number)
        return found or [question for question, numbers in self.items() if number in numbers.split("/")]


def _in_order(course: Course, name: str, parts: Mapping[str, object]) -> list[str]:
    order = [part.id for part in course[name].spec.parts] if name in course else []
    return sorted(parts, key=lambda part: order.index(part) if part in order else len(order))
