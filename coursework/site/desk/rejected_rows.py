"""Rejected rows: assigned by hand, as an answer that records its source, or set aside."""

from __future__ import annotations

from collections.abc import Sequence

from starlette.responses import Response

from coursework.database.class_state import ClassState, UnplacedRow
from coursework.database.instructor_queries import Placing, drop_placing, put_placing
from coursework.database.marking import mark_submission
from coursework.database.permissions import Permission
from coursework.database.submissions import insert_submission
from coursework.errors import BadInput
from coursework.gradebook.rows import AnswerRow, RowOrigin
from coursework.site.desk.class_cache import class_here
from coursework.site.desk.files import files_page
from coursework.site.desk.queue import Filters, card_response
from coursework.site.frame.requests import HTTPException, Request, Route

_LONGEST = 500  #: characters of a reason


def rejected(request: Request) -> Response:
    """Decide on a rejected row; return the page from which the form came."""
    now = class_here(request)
    row = next((candidate for candidate in now.rejected if candidate.id == request.form.text("row")), None)
    if row is None:
        raise HTTPException("own", 404)
    try:
        message = (
            _placed_all(request, now, row)
            if request.form.text("do") == "place all"
            else _decided(request, now, row)
        )
    except BadInput as fault:
        message = str(fault)
    if request.form.text("from") == "queue":
        filters = Filters.of({k: request.form.text(k) for k in ("why", "exercise", "part")})
        return card_response(request, class_here(request), filters, "", message)
    return files_page(request, [message])


def _decided(request: Request, now: ClassState, row: UnplacedRow) -> str:
    """Apply the action of a form to a rejected row; return the message. Raises BadInput: the form names no
    student or question, or the question has an answer already."""
    texts, asked_for = request.words["files"], request.form.text("do")
    if asked_for == "back":
        with request.site.store.begin() as connection:
            drop_placing(connection, now.about.id, row.id)
        return str(texts["is_back"])
    if row.became is not None:
        return str(texts["was_placed" if row.became.submission_id else "was_aside"]).format(row.became.by)
    reason = request.form.text("reason").strip()[:_LONGEST]
    if asked_for == "aside":
        with request.site.store.begin() as connection:
            put_placing(
                connection,
                now.about.id,
                Placing(row.id, None, reason, request.actor.name, request.received_at),
            )
            request.note(connection, "row put aside", assignment=now.about.id, row=row.id)
        return str(texts["aside_done"])
    if asked_for != "place":
        raise HTTPException("bad_request", 400)
    answer = _answer(request, now, row, request.form.text("question"))
    _place(request, now, [(row, answer)], reason)
    return str(texts["placed_done"]).format(
        now.shown(answer.student), now.questions.label(answer.exercise, answer.part)
    )


def _placed_all(request: Request, now: ClassState, first: UnplacedRow) -> str:
    """Place all waiting rows that name the same stranger as this one; return the message. A row without a
    question of the assignment, or to whose question an answer is marked, waits on."""
    texts, left = request.words["files"], 0
    answers: list[tuple[UnplacedRow, AnswerRow]] = []
    if not now.issued.student(request.form.text("student")):
        raise BadInput(texts["place_whose"])
    for row in now.rejected:
        if row.waits and row.stranger and row.stranger == first.stranger:
            try:
                question = f"{row.row.row.get('exercise', '')}/{row.row.row.get('part', '')}"
                answers.append((row, _answer(request, now, row, question)))
            except BadInput:
                left += 1
    if answers:
        _place(request, now, answers, "")
    shown = now.shown(str(now.issued.student(request.form.text("student"))))
    return str(texts["placed_all"]).format(shown, len(answers), left)


def _place(
    request: Request, now: ClassState, answers: Sequence[tuple[UnplacedRow, AnswerRow]], reason: str
) -> None:
    """Store the answers that are made of rejected rows as one submission, and mark it."""
    by_hand = request.words["files"]["by_hand"].format(request.actor.name)
    sources = [f"{row.row.source} ({by_hand})" for row, _ in answers]
    with request.site.store.begin() as connection:
        submission = insert_submission(
            connection,
            now.about.id,
            [answer._replace(source=source) for (_, answer), source in zip(answers, sources, strict=True)],
            source=sources[0],
            received_at=request.received_at,
            in_place=True,
        )
        for row, _ in answers:
            placing = Placing(row.id, submission.id, reason, request.actor.name, request.received_at)
            put_placing(connection, now.about.id, placing)
            request.note(connection, "row placed", assignment=now.about.id, row=row.id)
    mark_submission(request.site.course, request.site.store, submission.id)


def _answer(request: Request, now: ClassState, row: UnplacedRow, question: str) -> AnswerRow:
    """Return the answer that a person assigns to a rejected row."""
    texts, issued = request.words["files"], now.issued
    student = issued.student(request.form.text("student"))
    exercise, _, part = question.partition("/")
    if not student or (exercise, part) not in now.questions:
        raise BadInput(texts["place_whose"])
    text = row.row.row.get("answer", "")
    sheets = [
        (sheet_key, graded)
        for sheet_key, graded in now.machine.items()
        if sheet_key[:2] == (student, exercise)
    ]
    sheet_key, sheet = max(sheets, key=lambda pair: pair[1].sitting) if sheets else (None, None)
    if sheet is not None and part in sheet.lines and sheet.lines[part].verdict != "missing":
        raise BadInput(
            texts["place_taken"].format(
                now.shown(student), now.questions.label(exercise, part), sheet.lines[part].answer[:80]
            )
        )
    seeds = issued.seeds_of(student, exercise)
    seed = (
        str(sheet_key[2])
        if sheet_key is not None
        else str(seeds[-1])
        if seeds
        else row.row.row.get("seed", "")
    )
    attempt = sheet_key[3] if sheet_key is not None else 0
    return AnswerRow(
        student, exercise, seed, part, text, "", origin=RowOrigin(sitting=attempt) if attempt else None
    )


ROUTES = (
    Route(
        "/desk/{assignment:int}/rejected", rejected, Permission.MARKS_DECIDE, takes_forms=True, by_group=True
    ),
)
