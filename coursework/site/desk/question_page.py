"""Page of one question for the whole class: its difficulty, its discrimination, and the answers, with the
report's statistics."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace

from starlette.responses import HTMLResponse, Response

from coursework.database.class_state import ClassState
from coursework.database.permissions import Permission
from coursework.gradebook.statistics.captions import Names
from coursework.gradebook.statistics.measures import PartStatistics, Statistics, measure
from coursework.gradebook.statistics.of_class import marks_of_class
from coursework.gradebook.statistics.page import report, sheet_order
from coursework.gradebook.waiting import written
from coursework.marking.mark import Mark
from coursework.rendering.feedback import verdict_word
from coursework.rendering.renderer import renderer_of
from coursework.site.desk.class_cache import class_here, class_page_of
from coursework.site.desk.question_cards import question_card, sign_of
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import Download

_EXAMPLES = 8  #: students named with an answer
_ANSWERS = 60  #: answers listed


def statistics_of(now: ClassState) -> Statistics:
    """Return the current statistics of the class."""
    marks = marks_of_class(now.graded.values(), now.results, len(now.book.rejected), now.presence)
    return measure(marks, sheet_order(now.course, now.issued.exercises))


@dataclass(frozen=True)
class QuestionRow:
    """Question in the list."""

    exercise: str
    part: str
    number: str
    statistics: PartStatistics | None
    words: str = ""


def questions(request: Request) -> Response:
    """Return the page of the questions, in the order of the sheets or the hardest first."""
    now = class_here(request)
    class_statistics = statistics_of(now)
    names = Names(now.course, request.lang)
    by_question = {(item.exercise, item.part): item for item in class_statistics.parts}
    asked_for = [QuestionRow(*item, number, by_question.get(item)) for item, number in now.questions.items()]
    listed = [replace(item, words=names.question_markdown(item)) for item in asked_for]
    if request.query_params.get("sort") == "hard":
        listed.sort(
            key=lambda item: item.statistics.mean if item.statistics and item.statistics.marked else 2.0
        )
    return class_page_of(
        request,
        now,
        "site/instructor/questions",
        "questions",
        listed=listed,
        sort=request.query_params.get("sort", ""),
        class_statistics=class_statistics,
    )


@dataclass(frozen=True)
class DistinctAnswer:
    """Distinct answer to a question, with the students who gave it."""

    text: str
    verdict: str  #: in words
    sign: str
    message: str  #: Markdown
    students: tuple[str, ...]
    matches: tuple[str, ...]


def question(request: Request) -> Response:
    """Return the page of one question: its figures, its mistakes, and the answers, the most frequent
    first."""
    now = class_here(request)
    exercise, part = request.query_params.get("exercise", ""), request.query_params.get("part", "")
    if (exercise, part) not in now.questions:
        raise HTTPException("own", 404)
    class_statistics = statistics_of(now)
    part_statistics = next(
        (item for item in class_statistics.parts if (item.exercise, item.part) == (exercise, part)), None
    )
    names = Names(now.course, request.lang)
    mistakes = [
        (item, names.says(item) or item.name)
        for item in class_statistics.mistakes
        if (item.exercise, item.part) == (exercise, part)
    ]
    sheet = next(
        (item for item in now.machine.values() if item.exercise == exercise and part in item.lines), None
    )
    card = None if sheet is None else question_card(now.course, now.issued, sheet, part, request.lang)
    only = request.query_params.get("verdict", "")
    answers = _answers(request, now, exercise, part)
    return class_page_of(
        request,
        now,
        "site/instructor/question",
        "questions",
        exercise=exercise,
        part=part,
        own=part_statistics,
        mistakes=mistakes,
        shown=card,
        number=now.questions.label(exercise, part),
        only=only,
        answers=[item for item in answers if not only or only in item.matches][:_ANSWERS],
        count=len(answers),
        waiting=sum((item.group.exercise, item.group.part) == (exercise, part) for item in now.open.values()),
        examples=_EXAMPLES,
        verdicts=_verdicts(request, part_statistics),
    )


def _answers(request: Request, now: ClassState, exercise: str, part: str) -> list[DistinctAnswer]:
    by_text: dict[tuple[str, str], list[tuple[str, Mark]]] = {}
    for graded in now.graded.values():
        mark = graded.lines.get(part) if graded.exercise == exercise else None
        if (
            mark is not None
            and mark.verdict != "missing"
            and graded.sitting == now.results[graded.student].sitting
        ):
            by_text.setdefault((mark.verdict, written(mark)), []).append((graded.student, mark))
    listed = [_written(request, marks) for marks in by_text.values()]
    return sorted(listed, key=lambda graded: (-len(graded.students), graded.sign == "full", graded.text))


def _written(request: Request, marks: list[tuple[str, Mark]]) -> DistinctAnswer:
    mark = marks[0][1]
    return DistinctAnswer(
        mark.answer,
        verdict_word(mark.verdict, request.lang),
        sign_of(mark),
        mark.says,
        tuple(dict.fromkeys(student for student, _ in marks)),
        (mark.verdict.partition(":")[0], mark.verdict),
    )


def _verdicts(request: Request, part_statistics: PartStatistics | None) -> list[tuple[str, str, int]]:
    """Return the verdicts that occur among the answers: name, word, count."""
    counts: Mapping[str, int] = Counter() if part_statistics is None else part_statistics.counts
    return [(name, verdict_word(name, request.lang), count) for name, count in counts.items() if count]


def statistics(request: Request) -> Response:
    """Return the report of the statistics as a page, or as a PDF."""
    now = class_here(request)
    document = report(now.course, statistics_of(now), request.lang, now.questions)
    renderer = renderer_of(now.course.folder)
    if request.path.endswith(".pdf"):
        return Download(renderer.report_pdf(document), "application/pdf", "report.pdf")
    return HTMLResponse(renderer.report_html(document))


ROUTES = (
    Route("/desk/{assignment:int}/questions", questions, Permission.MARKS_READ, by_group=True),
    Route("/desk/{assignment:int}/question", question, Permission.MARKS_READ, by_group=True),
    Route("/desk/{assignment:int}/report", statistics, Permission.MARKS_READ, by_group=True),
    Route("/desk/{assignment:int}/report.pdf", statistics, Permission.MARKS_READ, by_group=True),
)
