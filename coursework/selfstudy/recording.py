"""Records of a marking: each answer with its verdict, and the named errors that it disproves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from datetime import timedelta
from typing import TYPE_CHECKING, Any

from coursework.errors import CourseworkError
from coursework.marking.marking import mark
from coursework.selfstudy.mastery import RIGHT
from coursework.selfstudy.progress import ANSWER, Entry, date_of, entry
from coursework.selfstudy.store import ProgressStore, is_blank

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.course.variant import Variant
    from coursework.marking.mark import SheetMarks
    from coursework.model import Part


def marked_answers(
    variant: Variant, answers: Mapping[str, Any], marking: SheetMarks, before: Sequence[Entry]
) -> list[dict[str, Any]]:
    """Return the records of a marking, for answers that are new or marked differently from ``before``."""
    last = {e["part"]: (e.get("answer"), e.get("verdict")) for e in before if e["what"] == ANSWER}
    results = []
    for part in variant.parts:
        answer, mark = answers.get(part.id), marking[part.id]
        if is_blank(answer) or last.get(part.id) == (answer, mark.verdict):
            continue
        entries: dict[str, Any] = {"part": part.id, "what": ANSWER, "answer": answer, "verdict": mark.verdict}
        entries["kind"] = skill_of_kind(part)
        if mark.verdict in RIGHT:
            entries["shown"] = sorted(set(errors_shown(variant, part)))
        results.append(entries)
    return results


def mark_what_came_unmarked(course: Course[Any], file: ProgressStore) -> None:
    """Mark the stored answers without a verdict, with the date of the answer.

    An earlier version stored them.
    """
    last = {(e["exercise"], e["seed"], e["part"]): e for e in file.progress if e["what"] == ANSWER}
    unmarked: dict[tuple[str, int], list[Entry]] = {}
    for (exercise, seed, _), item in last.items():
        if "verdict" not in item and exercise in course:
            unmarked.setdefault((exercise, seed), []).append(item)
    for (exercise, seed), result in unmarked.items():
        variant = course[exercise].variant(seed)
        answers = {e["part"]: e.get("answer") for e in result if e["part"] in variant.part_ids}
        try:
            marking = mark(variant, answers)
        except CourseworkError:
            continue
        at = max(map(date_of, result)) + timedelta(microseconds=1)
        text = marked_answers(variant, answers, marking, ())
        file.add([entry(at, exercise, seed, **each) for each in text])


def skill_of_kind(part: Part) -> str:
    """Return the kind of an answer: its unit if it has one, else its kind."""
    return part.unit if part.unit != "1" else part.kind


def errors_shown(variant: Variant, part: Part) -> Iterator[str]:
    """Yield the named errors that would have given another answer to a part of this variant."""
    key, sort = variant.key, part.sort
    if sort.is_open or not sort.disproves:
        return
    reference, width = key.reference[part.quantity], key.envelope.get(part.quantity, 0.0)
    along = key.reference.get(part.along)
    for name, value in key.wrong_ways(part.quantity):
        if value is not None and sort.apart(part, value, reference, along, width) > 1:
            yield f"mistake:{name}"
    for kind, value in key.slip_values(part):
        if sort.apart(part, value, reference, along, width) > 1:
            yield f"slip:{kind}"
