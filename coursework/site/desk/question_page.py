"""A question over the class: how hard it is, whether it tells good students from others, and what was answered; statistics as a
report makes them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

from coursework.database.permissions import Permission
from coursework.gradebook.waiting import written
from coursework.marking.mark import Mark
from coursework.rendering.feedback import verdict_word
from coursework.rendering.renderer import renderer_of
from coursework.site.desk.class_cache import ClassNow, assignment_of, class_now, class_page_of
from coursework.site.desk.question_cards import question_card, sign_of
from coursework.site.frame.requests import HTTPException, Request, Response, Route
from coursework.statistics.captions import Names
from coursework.statistics.measures import PartStatistics, Statistics, measure
from coursework.statistics.of_class import marks_of_class
from coursework.statistics.page import report, sheet_order

_EXAMPLES = 8  #: students named beside what they wrote
_ANSWERS = 60  #: ways of answering that are listed


def statistics_of(now: ClassNow) -> Statistics:
    """Return the current statistics of the class."""
    marks = marks_of_class(now.graded.values(), now.results, len(now.book.rejected))
    return measure(marks, sheet_order(now.course, now.issued.exercises))


@dataclass(frozen=True)
class QuestionRow:
    """A question in the list."""

    exercise: str
    part: str
    number: str
    statistics: PartStatistics | None
    words: str = ""


def questions(request: Request) -> Response:
    """Return the page of the questions, in the order of the sheets or the hardest first."""
    now = class_now(request.site, assignment_of(request))
    told = statistics_of(now)
    names = Names(now.course, told, request.lang)
    known = {(one.exercise, one.part): one for one in told.parts}
    asked_for = [QuestionRow(*one, now.number(*one), known.get(one)) for one in now.questions]
    listed = [replace(one, words=names.question(one)) for one in asked_for]
    if request.query_params.get("sort") == "hard":
        listed.sort(key=lambda one: one.statistics.mean if one.statistics and one.statistics.marked else 2.0)
    return class_page_of(
        request,
        now,
        "site_desk_questions",
        "questions",
        listed=listed,
        sort=request.query_params.get("sort", ""),
        told=told,
    )


@dataclass(frozen=True)
class DistinctAnswer:
    """One way of answering a question."""

    text: str
    verdict: str  #: in words
    sign: str
    message: str  #: Markdown
    students: tuple[str, ...]
    matches: tuple[str, ...]


def question(request: Request) -> Response:
    """Return the page of one question: its figures, its mistakes, and the answers, the most frequent first."""
    now = class_now(request.site, assignment_of(request))
    exercise, part = request.query_params.get("exercise", ""), request.query_params.get("part", "")
    if (exercise, part) not in now.questions:
        raise HTTPException("own", 404)
    told = statistics_of(now)
    own = next((one for one in told.parts if (one.exercise, one.part) == (exercise, part)), None)
    names = Names(now.course, told, request.lang)
    mistakes = [
        (one, names.says(one) or one.name)
        for one in told.mistakes
        if (one.exercise, one.part) == (exercise, part)
    ]
    sheet = next(
        (one for one in now.machine.values() if one.exercise == exercise and part in one.lines), None
    )
    shown = None if sheet is None else question_card(now.course, now.issued, sheet, part, request.lang)
    only = request.query_params.get("verdict", "")
    answers = _answers(request, now, exercise, part)
    return class_page_of(
        request, now, "site_desk_question", "questions", exercise=exercise, part=part, own=own, mistakes=mistakes,
        shown=shown, number=now.number(exercise, part), only=only,
        answers=[one for one in answers if not only or only in one.matches][:_ANSWERS], count=len(answers),
        waiting=sum((one.group.exercise, one.group.part) == (exercise, part) for one in now.open.values()),
        examples=_EXAMPLES, verdicts=_verdicts(request, own),
    )  # fmt: skip


def _answers(request: Request, now: ClassNow, exercise: str, part: str) -> list[DistinctAnswer]:
    found: dict[tuple[str, str], list[tuple[str, Mark]]] = {}
    for one in now.graded.values():
        mark = one.lines.get(part) if one.exercise == exercise else None
        if mark is not None and mark.verdict != "missing" and one.sitting == now.results[one.student].sitting:
            found.setdefault((mark.verdict, written(mark)), []).append((one.student, mark))
    listed = [_written(request, own) for own in found.values()]
    return sorted(listed, key=lambda one: (-len(one.students), one.sign == "full", one.text))


def _written(request: Request, own: list[tuple[str, Mark]]) -> DistinctAnswer:
    mark = own[0][1]
    return DistinctAnswer(
        mark.answer, verdict_word(mark.verdict, request.lang), sign_of(mark), mark.says,
        tuple(dict.fromkeys(student for student, _ in own)), (mark.verdict.partition(":")[0], mark.verdict),
    )  # fmt: skip


def _verdicts(request: Request, own: PartStatistics | None) -> list[tuple[str, str, int]]:
    """Return the verdicts that occur among the answers: name, word, count."""
    counts: Mapping[str, int] = Counter() if own is None else own.counts
    return [(name, verdict_word(name, request.lang), count) for name, count in counts.items() if count]


def statistics(request: Request) -> Response:
    """Return the report of the statistics as a page, or as a PDF."""
    now = class_now(request.site, assignment_of(request))
    told = report(now.course, statistics_of(now), request.lang)
    renderer = renderer_of(now.course.folder)
    if request.path.endswith(".pdf"):
        return Response(
            media_type="application/pdf", content=renderer.report_pdf(told), filename="report.pdf"
        )
    return Response(renderer.report_html(told))


ROUTES = (
    Route("/desk/{assignment:int}/questions", questions, Permission.MARKS_READ),
    Route("/desk/{assignment:int}/question", question, Permission.MARKS_READ),
    Route("/desk/{assignment:int}/report", statistics, Permission.MARKS_READ),
    Route("/desk/{assignment:int}/report.pdf", statistics, Permission.MARKS_READ),
)
