"""Page of the evening after an exam: what is left, what a change of a question or of the scale makes of the
marks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from starlette.responses import Response

from coursework.course.course import Course
from coursework.database.class_state import ClassState
from coursework.database.decisions import decide
from coursework.database.permissions import Permission
from coursework.errors import BadInput
from coursework.gradebook import after_words
from coursework.gradebook.adjustments import (
    ADJUSTMENTS,
    CURVE,
    DIGITS,
    FULL,
    OF_NO_QUESTION,
    PRICE,
    PRICED,
    STEP,
    TOLERANCE,
    WEIGHT,
)
from coursework.gradebook.after import Exam, Preview, Restated, restated, steps_on, undoing
from coursework.gradebook.decisions import ACCEPTED, GIVEN, Decision
from coursework.gradebook.statistics.captions import Names
from coursework.issuing.assignment import OPTIONS, assignment_of
from coursework.language.numbers import localise, typed_number
from coursework.language.words import words
from coursework.messages import localised
from coursework.site.desk.class_cache import class_here, class_now, class_page_of
from coursework.site.desk.class_scans import class_scans, is_handed_over
from coursework.site.desk.question_cards import moment
from coursework.site.frame.budgets import DESK_FILE
from coursework.site.frame.requests import Request, Route
from coursework.system.toml_files import source_of, table_of

FILE = "file"  #: kind of a change: what the file of the assignment states now
OFFERED = (*ADJUSTMENTS, ACCEPTED, GIVEN)  #: changes that the form offers
_VALUED = (WEIGHT, TOLERANCE, DIGITS, PRICE, FULL, STEP, GIVEN)  #: changes with a number
_ANSWERED = (PRICE, CURVE, ACCEPTED, GIVEN)  #: changes with a text
_LONGEST = 500  #: characters of a text
_FIELDS = ("kind", "question", "points", "answer", "error", "why", "source")
_MOST_SOURCE = 200_000  #: characters of a file of an assignment
_MOST_ROWS = 400  #: changed marks in the table
_MOST_IDS = 1000  #: decisions undone at once


class ScansLeft(NamedTuple):
    """Work that is left on the scans of a class."""

    cards: int  #: answers that somebody must type
    incomplete: int  #: papers of which a page was not scanned
    is_unmarked: bool  #: True if some that are known are not marked yet


def after_exam(request: Request) -> Response:
    """Return the page; with a change in the address its preview; a form confirms it, puts non-answers away,
    or takes the last step back."""
    now = class_here(request)
    if not request.is_post:
        fields = {name: request.query_params.get(name, "") for name in (*_FIELDS, "undo")}
        return _page(request, now, fields)
    message, fields = "", dict.fromkeys((*_FIELDS, "undo"), "")
    if request.form.text("do") == "compare":
        return _page(request, now, fields | {"kind": FILE, "source": _source_sent(request)})
    try:
        message = _done(request, now, now.exam)
    except BadInput as fault:
        message = localised(fault)
        fields |= {name: request.form.text(name) for name in _FIELDS}
    return _page(request, class_now(request.site, now.about.id), fields, message)


def _source_sent(request: Request) -> str:
    """Return the text of the file that a form sends; empty if it sends none."""
    sent = request.form.upload("file")
    return sent.data.decode("utf-8-sig", "replace")[:_MOST_SOURCE] if sent else ""


def own_file(course: Course, name: str) -> Path:
    """Return where the folder of a course has the file of an assignment, if it has it."""
    return course.folder.root / f"{name}.toml"


def _restated(request: Request, now: ClassState, exam: Exam, source: str) -> Restated:
    """Return how the assignment's file differs from what was issued: the file that was sent, or else that of
    its name in the folder of the course. Without either nothing differs.

    Raises
    ------
    BadInput
        The file states no assignment.
    """
    path = own_file(request.site.course, now.about.name)
    if not source and not path.is_file():
        return Restated((), ())
    table = table_of(source or source_of(path), path.name)
    stated = {key: value for key, value in table.items() if key not in OPTIONS}
    return restated(assignment_of(now.about.name, stated, request.site.course, source), exam)


def _done(request: Request, now: ClassState, exam: Exam) -> str:
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
        kept = _steps(request, now, exam, {name: request.form.text(name) for name in _FIELDS})
        if not kept:
            return str(texts["file_same"])
        exam.preview(kept)  # one that makes no sense stops here
        done = after_words.batch_text(exam, kept, request.lang)
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
    """Return the standing decisions that a page names by their ids.

    Raises
    ------
    BadInput
        One of them does not stand, or none is named.
    """
    found = exam.undoable(asked.replace(",", " ").split()[:_MOST_IDS])
    if not found:
        raise BadInput("nothing is decided that could be undone")
    return found


def _undone_texts(exam: Exam, undone: Sequence[Decision], lang: str, tense: str) -> list[str]:
    """Return a line for each decision that is taken back, the last first; one for all answers of students
    together."""
    texts = words(lang)["after"]
    batches = after_words.batch_texts(exam, (one for one in undone if not one.student), lang)
    lines = [text for _, text in reversed(batches)]
    own = sum(bool(one.student) for one in undone)
    return [
        str(texts[tense]).format(line) for line in [*lines, *([texts["aside"].format(own)] if own else [])]
    ]


def _steps(request: Request, now: ClassState, exam: Exam, fields: Mapping[str, str]) -> list[Decision]:
    """Return the steps that the fields of a form state, one batch.

    Raises
    ------
    BadInput
        They state none.
    """
    kind, by = fields["kind"], request.actor.name
    if kind == FILE:
        changed, why = (
            _restated(request, now, exam, fields["source"]),
            words(request.lang)["after"]["file_why"],
        )
        return [one._replace(by=by, reason=why) for one in changed.steps]
    if kind not in OFFERED:
        raise BadInput("no change is chosen")
    place = "" if kind in OF_NO_QUESTION else fields["question"]
    if not place and kind not in (*OF_NO_QUESTION, PRICE):
        raise BadInput("no question is chosen")
    points = typed_number(fields["points"].strip()) if kind in _VALUED else None
    if points is not None and points != points:
        raise BadInput("this change needs a number: points, margins, a share or a step")
    text = fields["error" if kind == PRICE else "answer"] or fields["answer"]
    answer = text.strip()[:_LONGEST] if kind in _ANSWERED else None
    if kind in _ANSWERED and not answer:
        raise BadInput("this change needs a text: the answer, the verdict or the curve")
    return steps_on(exam, kind, place, points, answer, fields["why"].strip()[:_LONGEST], by)


def _page(request: Request, now: ClassState, fields: Mapping[str, str], message: str = "") -> Response:
    exam, lang = now.exam, request.lang
    preview: Preview | None = None
    texts: list[str] = []
    written_so = None
    if fields["kind"] or fields.get("undo"):
        try:
            if fields["kind"]:
                changes = _steps(request, now, exam, fields)
                texts = [after_words.batch_text(exam, changes, lang)] if changes else []
                message = message or ("" if changes else words(lang)["after"]["file_same"])
                written_so = exam.count_of(changes[0]) if changes[0].kind in (ACCEPTED, GIVEN) else None
            else:
                undone = _undone(exam, fields["undo"])
                changes = undoing(undone, request.actor.name)
                texts = _undone_texts(exam, undone, lang, "to_undo")
            preview = exam.preview(changes) if changes else None
        except BadInput as fault:
            message = message or localised(fault)
    try:
        changed = _restated(request, now, exam, fields.get("source", ""))
    except BadInput as fault:
        changed = Restated((), ())
        message = message or localised(fault)
    names_of = Names(now.course, lang)
    current = exam.distribution()
    batches = after_words.batch_texts(exam, exam.decisions.standing_steps, lang)
    aside = after_words.batch_texts(exam, exam.put_aside, lang)
    sorts = words(lang)["after"]["sorts"]
    names: dict[str, Any] = {
        "exam": exam,
        "fields": fields,
        "message": message,
        "preview": preview,
        "texts": texts,
        "written_so": written_so,
        "current": current,
        "bins": after_words.bins(current, lang),
        "steps": [
            (moment(one.made, lang) if one.made else "", one, text) for one, text in (*batches, *aside)
        ],
        "offered": OFFERED,
        "caption": names_of.question,
        "typeset": names_of.question_markdown,
        "number": lambda value: after_words.number(value, lang),
        "share": lambda value: localise(f"{value:.2f}", lang),
        "points_text": lambda question: after_words.points_text(question, lang),
        "counting_text": lambda question: after_words.counting_text(question, lang),
        "errors": _errors(exam, lang),
        "file_says": [text for _, text in after_words.batch_texts(exam, changed.steps, lang)],
        "file_notes": [localised(note) for note in changed.notes],
        "kind_of_file": FILE,
        "kinds": {
            kind: f"{sorts.get(kind, kind)} ({len(among)})"
            for kind, among in exam.kinds.items()
            if len(among) > 1
        },
        "exercises": {
            name: f"{exam.questions.exercise_number(name)} {now.course[name].title(lang)}".strip()
            for name in dict.fromkeys(exercise for exercise, _ in exam.questions)
        },
        "on_questions": [kind for kind in OFFERED if kind not in OF_NO_QUESTION],
        "ids": [one.id for one, _ in batches],
        "most_rows": _MOST_ROWS,
        "scans": _scans_left(request, now),
        "most": max((*current.counts, *(preview.now.counts if preview else ())), default=0),
    }
    return class_page_of(request, now, "site/instructor/after", "after", **names)


def _scans_left(request: Request, now: ClassState) -> ScansLeft:
    """Return the work that is left on scans, as far as the user may see them."""
    number = now.about.id
    if not request.user.may(Permission.SCANS_READ, number):
        return ScansLeft(0, 0, False)
    scans = class_scans(request.site, number)
    is_unmarked = not is_handed_over(request.site, number, scans)
    return ScansLeft(len(scans.cards), len(scans.gathered.missing), is_unmarked)


def _errors(exam: Exam, lang: str) -> list[tuple[str, str, int]]:
    """Return the errors whose price may change, in words and with the number of answers: families, then those
    of the class."""
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


ROUTES = (
    Route(
        "/desk/{assignment:int}/after",
        after_exam,
        Permission.MARKS_REGRADE,
        takes_forms=True,
        budget=DESK_FILE,
    ),
)
