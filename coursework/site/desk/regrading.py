"""Regrading after a correction of a solution, a rule or the engine; the changes are shown before they are
made."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

from starlette.responses import Response

from coursework.course.course import Course
from coursework.database.class_state import ClassState
from coursework.database.marking import Change, MarkedNow, mark_new, would_change
from coursework.database.permissions import Permission
from coursework.database.states import exercise_state
from coursework.language.numbers import localise
from coursework.rendering.feedback import verdict_word
from coursework.site.desk.class_cache import class_here, class_now, class_page_of
from coursework.site.frame.requests import Request, Route
from coursework.site.frame.responses import Download
from coursework.site.frame.settings import Site
from coursework.system.tables import SPREADSHEETS, csv_file

_MOST_ROWS = 500  #: changes in the table


class ChangeRow(NamedTuple):
    """Changed mark as text."""

    student: str
    number: str
    answer: str
    before: str
    now: str
    points_before: str
    points_now: str
    is_less: bool


def regrade(request: Request) -> Response:
    """Return the marks that would change; after confirmation, mark again and return the marks that
    changed."""
    now = class_here(request)
    course = _current_course(request.site, now)
    done = request.is_post and request.form.text("do") == "regrade"
    if done:
        result = mark_new(course, request.site.store, now.about.id)
        request.site.take(course)
        with request.site.store.begin() as connection:
            about = {"assignment": now.about.id, "sheets": result.marked, "changes": len(result.changes)}
            request.note(connection, "regrade", **about)
        now = class_now(request.site, now.about.id)
    else:
        result = would_change(course, request.site.store, now.about.id)
    return class_page_of(
        request,
        now,
        "site/instructor/regrade",
        "regrade",
        result=result,
        done=done,
        is_new=course is not request.site.course,
        rows=[_row(request, now, change) for change in result.changes[:_MOST_ROWS]],
        questions=_questions(request, now, result),
        students=len({change.student for change in result.changes}),
    )


def _current_course(site: Site, now: ClassState) -> Course[Any]:
    """Return the course with its current files; the open one if no issued exercise has changed."""
    course, fresh = site.course, site.reopened()
    same = fresh.folder.rules == course.folder.rules and all(
        exercise_state(fresh, name) == exercise_state(course, name) for name in now.issued.exercises
    )
    return course if same else fresh


def _row(request: Request, now: ClassState, change: Change) -> ChangeRow:
    before, after = (
        verdict_word(v, request.lang) if v else "" for v in (change.verdict_before, change.verdict_now)
    )
    points_before, points_now = (localise(p, request.lang) for p in (change.points_before, change.points_now))
    is_less = _number(change.points_now) < _number(change.points_before)
    number = now.questions.label(change.exercise, change.part)
    return ChangeRow(
        now.shown(change.student), number, change.answer, before, after, points_before, points_now, is_less
    )


def _questions(request: Request, now: ClassState, result: MarkedNow) -> list[tuple[str, int, int, str]]:
    """Return for each question its number, the number of marks that rise and fall, and the total change of
    points."""
    gains_by_question: dict[tuple[str, str], list[float]] = {}
    for change in result.changes:
        gain = _number(change.points_now) - _number(change.points_before)
        gains_by_question.setdefault((change.exercise, change.part), []).append(gain)
    return [
        (
            now.questions.label(*question),
            *_signs(gains_by_question[question]),
            localise(f"{sum(gains_by_question[question]):+g}", request.lang),
        )
        for question in now.questions
        if question in gains_by_question
    ]


def _signs(gains: Sequence[float]) -> tuple[int, int]:
    counts = Counter("rise" if gain > 0 else "fall" for gain in gains if gain)
    return counts["rise"], counts["fall"]


def _number(points: str) -> float:
    return float(points or 0)


def changes(request: Request) -> Response:
    """Return the table of changed marks as a file."""
    now = class_here(request)
    result = would_change(_current_course(request.site, now), request.site.store, now.about.id)
    spreadsheet = SPREADSHEETS["comma" if request.lang == "fr" else "point"]
    data = csv_file((change.row() for change in result.changes), Change._fields, spreadsheet)
    return Download(data, "text/csv; charset=utf-8", "changes.csv")


ROUTES = (
    Route("/desk/{assignment:int}/regrade", regrade, Permission.MARKS_REGRADE, takes_forms=True),
    Route("/desk/{assignment:int}/changes.csv", changes, Permission.MARKS_REGRADE),
)
