"""Instructor's page of a student: every attempt and its time, each answer with its reading, verdict and
history; answers are decided here too.

Of a student's practice the page shows the number of variants and the last date, for the exercises of this
assignment; never an answer, a mark or a mistake, since practice is private.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from itertools import groupby
from typing import Any

from starlette.responses import Response

from coursework.database.class_state import ClassState
from coursework.database.decisions import (
    HistoryEvent,
    decide,
    history,
)
from coursework.database.instructor_queries import people_of, practised
from coursework.database.permissions import Permission
from coursework.database.submissions import drawings_of, submissions_of_student
from coursework.errors import BadInput
from coursework.figures import Figure
from coursework.gradebook.columns import own_columns
from coursework.gradebook.decisions import Decision
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.scale import mark_of
from coursework.issuing.students import folded
from coursework.language.numbers import localise
from coursework.marking.mark import Mark
from coursework.rendering.surface import drawn_figure
from coursework.site.desk.class_cache import class_here, class_page_of
from coursework.site.desk.question_cards import (
    QuestionCard,
    decided_words,
    moment,
    question_card,
    requested_decision,
    sign_of,
    steps,
)
from coursework.site.frame.requests import HTTPException, Request, Route

_LONGEST = 2000  #: characters of a comment


@dataclass(frozen=True)
class AnswerLine:
    """Answer with its mark and its history."""

    question_card: QuestionCard
    number: str  #: on the student's paper
    machine: Mark
    mark: Mark
    sign: str
    history: tuple[str, ...]
    is_decided: bool
    steps: tuple[float, ...]


@dataclass(frozen=True)
class StudentSheet:
    """One exercise of one attempt."""

    graded: Graded
    title: str
    lines: tuple[AnswerLine, ...]
    counts: bool
    drawing: Figure | None  #: what the student drew


@dataclass(frozen=True)
class PracticeSummary:
    """Practice of a student, as far as the instructor may see it."""

    title: str
    variants: int
    last: str


def student_page(request: Request) -> Response:
    """Return the page of a student; a form decides on one of the answers."""
    now = class_here(request)
    student = _student(request, now)
    message = ""
    if request.is_post:
        try:
            message = _decided(request, now, student)
        except BadInput as fault:
            message = str(fault)
        now = class_here(request)
    result = now.results[student]
    with request.site.store.reading() as connection:
        happened = history(connection, now.about.id, student)
        tries = submissions_of_student(connection, now.about.id, student)
        person = people_of(connection, now.about.id).get(student)
        alone = practised(connection, person, now.issued.exercises) if person else {}
        drawn = drawings_of(connection, now.about.id, student)
    by_place: dict[tuple[str, str], list[HistoryEvent]] = {}
    for event in happened:
        by_place.setdefault((event.exercise, event.part), []).append(event)
    sheets = [_sheet(request, now, sheet, by_place, drawn) for sheet in now.machine if sheet[0] == student]
    sheets.sort(key=lambda entry: (-entry.graded.sitting, now.issued.exercises.index(entry.graded.exercise)))
    return class_page_of(
        request,
        now,
        "site/instructor/student",
        "class",
        student=now.shown(student),
        result=result,
        message=message,
        mark=localise(mark_of(now.adjusted, result.counts, result.out_of), request.lang),
        columns=[] if now.codes else _columns(now, student),
        tries=[(moment(entry.received_at, request.lang), entry) for entry in tries],
        known=0 if now.codes else person or 0,
        sittings=[(n, list(group)) for n, group in groupby(sheets, key=lambda entry: entry.graded.sitting)],
        practised=[_practised(request, name, *alone[name]) for name in now.issued.exercises if name in alone],
        rejected=[entry for entry in now.coded.rejected if entry.student == now.shown(student)],
    )


def _student(request: Request, now: ClassState) -> str:
    query = request.form.text("name") if request.is_post else request.query_params.get("name", "")
    if query in now.results and not now.codes:
        return query
    student = {folded(now.shown(name)): name for name in now.results}.get(folded(query))
    if student is None:
        raise HTTPException("own", 404)
    return student


def _columns(now: ClassState, student: str) -> list[tuple[str, str]]:
    columns = own_columns(now.issued, student)
    titles = {folded(title): title for title in now.issued.columns.get(student, {})}
    return [(titles.get(key, key), value) for key, value in columns.items() if value]


def _sheet(
    request: Request,
    now: ClassState,
    sheet_key: Any,
    happened: dict[tuple[str, str], list[HistoryEvent]],
    drawn: Mapping[tuple[int, str], str],
) -> StudentSheet:
    machine, graded = now.machine[sheet_key], now.graded[sheet_key]
    lines = [
        _line(request, now, machine, graded, part, number, happened.get((machine.exercise, part), []))
        for part, number in now.questions.on_paper(machine.exercise, machine.lines).items()
    ]
    title = lines[0].question_card.handout.title if lines else machine.exercise
    figure = drawn_figure(drawn, machine.sitting, lines[0].question_card.handout) if lines else None
    counts = graded.sitting == now.results[graded.student].sitting
    return StudentSheet(graded, title, tuple(lines), counts, figure)


def _line(
    request: Request,
    now: ClassState,
    machine: Graded,
    graded: Graded,
    part: str,
    number: str,
    happened: list[HistoryEvent],
) -> AnswerLine:
    events = [event for event in happened if event.seed in ("", str(machine.seed))]
    events = [event for event in events if event.sitting in (0, machine.sitting)]
    lines = tuple(_history_line(request, event) for event in events)
    mark = graded.lines[part]
    return AnswerLine(
        question_card(now.course, now.issued, machine, part, request.lang),
        number,
        machine.lines[part],
        mark,
        sign_of(mark),
        lines,
        now.decisions.standing(machine, machine.lines[part]) is not None,
        steps(machine.lines[part].out_of),
    )


def _history_line(request: Request, event: HistoryEvent) -> str:
    """Return a line of the history."""
    if event.kind == "marked":
        from coursework.rendering.feedback import verdict_word

        text = request.words["class"]["marked"]
        at = moment(event.made, request.lang)
        return str(text).format(verdict_word(event.verdict, request.lang), f"{event.points or 0:g}", at)
    return decided_words(request, event, event.made)


def _practised(request: Request, name: str, variants: int, last: datetime | None) -> PracticeSummary:
    exercise = request.site.course[name]
    lang = request.lang if request.lang in exercise.languages else exercise.languages[0]
    return PracticeSummary(exercise.title(lang), variants, moment(last, request.lang) if last else "")


def _decided(request: Request, now: ClassState, student: str) -> str:
    """Decide on one answer, or withdraw the decision. Raises BadInput: the points are not a number, or exceed
    the maximum."""
    form, texts = request.form, request.words["queue"]
    exercise, seed, part = form.text("exercise"), form.text("seed"), form.text("part")
    sheet = next(
        (
            graded
            for graded in now.machine.values()
            if (graded.student, graded.exercise, str(graded.seed)) == (student, exercise, seed)
            and str(graded.sitting) == form.text("sitting")
        ),
        None,
    )
    if sheet is None or part not in sheet.lines:
        raise HTTPException("own", 404)
    kind, points = requested_decision(request, sheet.lines[part])
    comment, answer = form.text("comment").strip()[:_LONGEST], sheet.lines[part].answer
    decision = Decision(student, exercise, seed, part, kind, points, comment, answer, request.actor.name)
    with request.site.store.begin() as connection:
        decide(connection, now.about.id, [decision])
        request.note(
            connection,
            "decision",
            assignment=now.about.id,
            exercise=exercise,
            part=part,
            kind=kind,
            points=points,
            count=1,
        )
    return str(texts["decided"][kind]).format(1, localise(f"{points or 0:g}", request.lang))


ROUTES = (
    Route(
        "/desk/{assignment:int}/student",
        student_page,
        Permission.MARKS_READ,
        takes_forms=True,
        form_permission=Permission.MARKS_DECIDE,
        by_group=True,
    ),
)
