"""Questions of an assignment, in the order of the sheets, and their numbers on the papers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from coursework.course.course import Course
from coursework.issuing.issued import Issued

Question = tuple[str, str]  #: exercise and part


def questions_of(course: Course, issued: Issued) -> tuple[Question, ...]:
    """Return the exercise and part of every question that was issued, in the order of the sheets."""
    exercises = [str(e) for e in (issued.assignment or {}).get("exercises", ())]
    names = dict.fromkeys((*exercises, *issued.exercises))
    by_exercise: dict[str, dict[str, None]] = {name: {} for name in names}
    for (name, _), record in issued.records.items():
        by_exercise[name].update((str(p["id"]), None) for p in record["parts"])
    return tuple(
        (name, part) for name, parts in by_exercise.items() for part in _in_order(course, name, parts)
    )


def _in_order(course: Course, name: str, parts: Mapping[str, None]) -> list[str]:
    order = [p.id for p in course[name].spec.parts] if name in course else []
    return sorted(parts, key=lambda part: order.index(part) if part in order else len(order))


def numbers_on_papers(questions: Sequence[Question], issued: Issued) -> dict[Question, str]:
    """Return the numbers of questions on the papers that ask them, such as ``2.3``; ``2.3/2.4`` where they
    differ."""
    positions: dict[Question, set[int]] = {question: set() for question in questions}
    for (name, _), record in issued.records.items():
        for position, part in enumerate(record["parts"], start=1):
            positions[name, str(part["id"])].add(position)
    names = list(dict.fromkeys(name for name, _ in questions))
    return {
        question: "/".join(f"{names.index(question[0]) + 1}.{position}" for position in sorted(own))
        for question, own in positions.items()
    }


def drawn_questions(course: Course, issued: Issued) -> frozenset[Question]:
    """Return the questions that are answered by a drawing."""
    return frozenset(
        (name, part.id)
        for name in issued.exercises
        if name in course
        for part in course[name].spec.parts
        if part.sort.box in ("blank", "millimetre")
    )
