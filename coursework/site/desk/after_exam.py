"""Page of the evening after an exam: what is left, what a change of a question or of the scale makes of the marks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from starlette.responses import Response

from coursework.database.class_state import ClassState
from coursework.database.decisions import decide
from coursework.database.permissions import Permission
from coursework.errors import BadInput
from coursework.gradebook import after_words
from coursework.gradebook.adjustments import (
    ADJUSTMENTS,
    CURVE,
    FULL,
    ON_SCALE,
    PRICE,
    PRICED,
    STEP,
    TOLERANCE,
    WEIGHT,
)
from coursework.gradebook.after import Exam, Preview, step, undoing
from coursework.gradebook.decisions import ACCEPTED, GIVEN, Decision
from coursework.gradebook.statistics.captions import Names
from coursework.language.numbers import localise, typed_number
from coursework.language.words import words
from coursework.messages import localised
from coursework.site.desk.class_cache import class_here, class_now, class_page_of
from coursework.site.desk.question_cards import moment
from coursework.site.desk.question_page import statistics_of
from coursework.site.frame.requests import Request, Route

OFFERED = (*ADJUSTMENTS, ACCEPTED, GIVEN)  #: changes that the form offers
_VALUED = (WEIGHT, TOLERANCE, PRICE, FULL, STEP, GIVEN)  #: changes with a number
_ANSWERED = (PRICE, CURVE, ACCEPTED, GIVEN)  #: changes with a text
_LONGEST = 500  #: characters of a text
_FIELDS = ("kind", "question", "points", "answer", "error", "why")
_MOST_ROWS = 400  #: changed marks in the table
_MOST_IDS = 1000  #: decisions undone at once
PUT_ASIDE = "away"  #: in place of ids: what says nothing and was put away


def exam_of(now: ClassState) -> Exam:
    """Return the exam of a class."""
    rejected = tuple(row.row for row in now.rejected if row.waits)
    machine = tuple(now.machine.values())
    return Exam(
        now.course,
        now.issued,
        machine,
        now.decisions,
        rejected,
        now.charged,
        now.measures,
        now.presence,
        now.shown,
    )


def after_exam(request: Request) -> Response:
    """Return the page; with a change in the address its preview; a form confirms it, puts non-answers away, or takes the
    last step back."""
    now = class_here(request)
    if not request.is_post:
        fields = {name: request.query_params.get(name, "") for name in (*_FIELDS, "undo")}
        return _page(request, now, fields)
    message, fields = "", dict.fromkeys(_FIELDS, "")
    try:
        message = _done(request, exam_of(now))
    except BadInput as fault:
        message = localised(fault)
        fields = {name: request.form.text(name) for name in _FIELDS}
    return _page(request, class_now(request.site, now.about.id), fields, message)


def _done(request: Request, exam: Exam) -> str:
    """Keep what the form asks for; return the message."""
    texts, by = words(request.lang)["after"], request.actor.name
    asked = request.form.text("do")
    if asked == "put_away":
        kept = exam.put_away(by, texts["put_away_why"])
        done = str(texts["aside"]).format(len(kept))
    elif asked == "undo":
        undone = _undone(exam, request.form.text("undo"))
        kept = undoing(undone, by)
        done = "; ".join(_undone_texts(exam, undone, request.lang, "undone"))
    elif asked == "confirm":
        kept = [_step({name: request.form.text(name) for name in _FIELDS}, by)]
        exam.preview(kept)  # one that makes no sense stops here
        done = after_words.step_text(exam, kept[0], request.lang)
    else:
        return ""
    number = request.path_params["assignment"]
    with request.site.store.begin() as connection:
        decide(connection, number, kept)
        about = {"exercise": kept[0].exercise, "part": kept[0].part} if kept and asked != "put_away" else {}
        request.note(
            connection,
            "adjustment",
            assignment=number,
            kind=kept[0].kind if kept else "",
            count=len(kept),
            **about,
        )
    return str(texts["done"]).format(done)


def _undone(exam: Exam, asked: str) -> Sequence[Decision]:
    """Return the standing decisions that a page names by their ids, or what was put away.

    Raises
    ------
    BadInput
        One of them does not stand, or none is named.
    """
    found = (
        exam.put_aside if asked == PUT_ASIDE else exam.undoable(asked.replace(",", " ").split()[:_MOST_IDS])
    )
    if not found:
        raise BadInput("nothing is decided that could be undone")
    return found


def _undone_texts(exam: Exam, undone: Sequence[Decision], lang: str, tense: str) -> list[str]:
    """Return a line for each decision that is taken back, the last first; one for all answers of students together."""
    texts = words(lang)["after"]
    strokes = after_words.stroke_texts(exam, (one for one in undone if not one.student), lang)
    lines = [text for _, text in reversed(strokes)]
    own = sum(bool(one.student) for one in undone)
    return [
        str(texts[tense]).format(line) for line in [*lines, *([texts["aside"].format(own)] if own else [])]
    ]


def _step(fields: Mapping[str, str], by: str) -> Decision:
    """Return the step that the fields of a form state.

    Raises
    ------
    BadInput
        They state none.
    """
    kind = fields["kind"]
    if kind not in OFFERED:
        raise BadInput("no change is chosen")
    exercise, _, part = fields["question"].partition("/") if kind not in ON_SCALE else ("", "", "")
    if not exercise and kind not in (*ON_SCALE, PRICE):
        raise BadInput("no question is chosen")
    points = typed_number(fields["points"].strip()) if kind in _VALUED else None
    if points is not None and points != points:
        raise BadInput("this change needs a number: points, margins, a share or a step")
    text = fields["error" if kind == PRICE else "answer"] or fields["answer"]
    answer = text.strip()[:_LONGEST] if kind in _ANSWERED else None
    if kind in _ANSWERED and not answer:
        raise BadInput("this change needs a text: the answer, the verdict or the curve")
    return step(kind, exercise, part, points, answer, fields["why"].strip()[:_LONGEST], by)


def _page(request: Request, now: ClassState, fields: Mapping[str, str], message: str = "") -> Response:
    exam, lang = exam_of(now), request.lang
    preview: Preview | None = None
    texts: list[str] = []
    written_so = None
    if fields["kind"] or fields.get("undo"):
        try:
            if fields["kind"]:
                changes = [_step(fields, request.actor.name)]
                texts = [after_words.step_text(exam, one, lang) for one in changes]
                written_so = exam.count_of(changes[0]) if changes[0].kind in (ACCEPTED, GIVEN) else None
            else:
                undone = _undone(exam, fields["undo"])
                changes = undoing(undone, request.actor.name)
                texts = _undone_texts(exam, undone, lang, "to_undo")
            preview = exam.preview(changes)
        except BadInput as fault:
            message = message or localised(fault)
    names_of = Names(now.course, statistics_of(now), lang)
    captions = {(one.exercise, one.part): names_of.question(one) for one in exam.table}
    current = exam.distribution()
    strokes = after_words.stroke_texts(exam, exam.decisions.standing_steps, lang)
    names: dict[str, Any] = {
        "exam": exam,
        "fields": fields,
        "told": message,
        "preview": preview,
        "texts": texts,
        "written_so": written_so,
        "current": current,
        "bins": after_words.bins(current, lang),
        "steps": [(moment(one.made, lang) if one.made else "", one, text) for one, text in strokes],
        "offered": OFFERED,
        "caption": lambda question: captions[question.exercise, question.part],
        "number": lambda value: after_words.number(value, lang),
        "share": lambda value: localise(f"{value:.2f}", lang),
        "points_text": lambda question: after_words.points_text(question, lang),
        "counting_text": lambda question: after_words.counting_text(question, lang),
        "errors": _errors(exam, lang),
        "on_questions": [kind for kind in OFFERED if kind not in ON_SCALE],
        "ids": [one.id for one, _ in strokes],
        "put_aside": PUT_ASIDE,
        "most_rows": _MOST_ROWS,
        "most": max((*current.counts, *(preview.now.counts if preview else ())), default=0),
    }
    return class_page_of(request, now, "site/instructor/after", "after", **names)


def _errors(exam: Exam, lang: str) -> list[tuple[str, str, int]]:
    """Return the errors whose price may change, in words and with the number of answers: families, then those of the class."""
    counts: Counter[str] = Counter()
    exercise_of: dict[str, str] = {}
    for graded in exam.machine:
        for line in graded.lines.values():
            for name in {line.verdict, line.verdict.partition(":")[0]}:
                counts[name] += 1
                exercise_of.setdefault(name, graded.exercise)
    priced = [name for name in counts if name.partition(":")[0] in PRICED]
    named = [
        (name, after_words.error_text(exam, exercise_of[name], name, lang), counts[name]) for name in priced
    ]
    return sorted(named, key=lambda one: (":" in one[0], -one[2], one[1]))


ROUTES = (Route("/desk/{assignment:int}/after", after_exam, Permission.MARKS_REGRADE, takes_forms=True),)
