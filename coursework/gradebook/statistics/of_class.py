"""Marks of a class just marked, as its tables would give them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from coursework.gradebook.book import Result
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.presence import AWAY
from coursework.gradebook.statistics.marks import Line, Marks, StudentSummary, marks_of


def marks_of_class(
    graded: Iterable[Graded], results: Mapping[str, Result], rejected: int, presence: Mapping[str, str]
) -> Marks:
    """Return the columns of a class; for a student with several sittings only those of the one that
    counts."""
    text = {s: _summary_of(result, presence.get(s) in AWAY) for s, result in results.items()}
    return marks_of(_lines(graded, results), text, rejected)


def _summary_of(result: Result, is_away: bool) -> StudentSummary:
    is_unread = bool(result.verdicts["unreadable"])
    return StudentSummary(result.out_of, result.verdicts["missing"], is_unread, is_away)


def _lines(graded: Iterable[Graded], results: Mapping[str, Result]) -> Iterator[Line]:
    for item in graded:
        if item.sitting != results[item.student].sitting:
            continue
        for part in (*item.answered, *item.unanswered):
            line = item.lines[part]
            yield item.student, item.exercise, part, line.verdict, line.points, line.out_of
