"""Uploads and downloads: answers, rosters and collected files in; tables, feedback and archives out. Uploads
are never run."""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import Any

from starlette.responses import Response

from coursework.database.assignments import issued_content, put_issued
from coursework.database.class_state import ClassState, UnplacedRow
from coursework.database.instructor_queries import decided_since
from coursework.database.marking import mark_submission
from coursework.database.permissions import Permission
from coursework.database.submissions import insert_submission, rows_of, submissions_of
from coursework.errors import BadInput, CourseworkError, first_few
from coursework.gradebook.book import marks_rows, rejected_rows, summary_table
from coursework.gradebook.class_points import SCORES, class_points
from coursework.gradebook.columns import REJECTED_COLUMNS, marks_columns
from coursework.gradebook.feedback_sheets import write_feedback
from coursework.gradebook.filling import Filled
from coursework.gradebook.placing import as_texts
from coursework.gradebook.platform_gradebooks import PLATFORMS, platform_gradebook
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
from coursework.gradebook.scale import is_rescaled
from coursework.issuing.issued import COLUMNS
from coursework.issuing.wide_form import wide_form
from coursework.messages import as_message, localised
from coursework.site.desk import uploads
from coursework.site.desk.class_cache import class_here, class_page_of
from coursework.site.desk.question_cards import moment
from coursework.site.frame.budgets import DESK_FILES, read_apart
from coursework.site.frame.forms import read_upload
from coursework.site.frame.requests import HTTPException, Request, Route, Upload
from coursework.site.frame.responses import Download
from coursework.system.tables import SPREADSHEETS, Spreadsheet, csv_file, json_text
from coursework.system.zips import zipped

_NAME = 120  #: bytes of a file's name; longer names lose their beginning
_named = partial(first_few, most=10, with_count=True)  #: students in a message
_DECISIONS = (
    "made",
    "by",
    "kind",
    "student",
    "exercise",
    "seed",
    "part",
    "points",
    "reason",
    "answer",
    "id",
    "withdraws",
)
_SUBMISSIONS = ("received_at", "source", "number", "late", "receipt")


# --------------------------------------------------------------------------- in


def files_page(
    request: Request, messages: Sequence[str] = (), filled: Filled | None = None, name: str = ""
) -> Response:
    """Return the page of uploads and downloads."""
    now = class_here(request).coded
    with request.site.store.reading() as connection:
        submissions = submissions_of(connection, now.about.id)
    files = [
        (moment(submission.received_at, request.lang), submission)
        for submission in submissions
        if not submission.number
    ]
    return class_page_of(
        request,
        now,
        "site/instructor/files",
        "files",
        messages=list(messages),
        files=files[::-1][:50],
        rejected=now.rejected,
        platforms=PLATFORMS.values(),
        scores=SCORES,
        downloads=list(_tables(request, now)),
        filled=_filled(request, filled, name),
        strangers=_strangers(now),
    )


def _strangers(now: ClassState) -> list[list[UnplacedRow]]:
    """Return the waiting rows of each name that nobody of the class has and that several rows state."""
    by_name: dict[str, list[UnplacedRow]] = {}
    for row in now.rejected:
        if row.waits and row.stranger:
            by_name.setdefault(row.stranger, []).append(row)
    return [rows for rows in by_name.values() if len(rows) > 1]


def answers_in(request: Request) -> Response:
    """Store uploaded answers, and mark the new ones.

    Raises
    ------
    BadInput
        No file was sent, or an archive exceeds the limits.
    """
    number = class_here(request).about.id
    sent = request.form.uploads("answers")
    texts = request.words["files"]
    if not sent:
        raise BadInput(texts["none_sent"])
    rows = _rows(sent, texts["too_many"].format(uploads.MOST_ROWS), request.words["refused"]["too_much"])
    answers = sum(isinstance(item, AnswerRow) for item in rows)
    source = ", ".join(file_name(item) for item in sent)[:500]
    with request.site.store.begin() as connection:
        submission = insert_submission(
            connection, number, rows, source=source, received_at=request.received_at
        )
        request.note(connection, "answers", assignment=number, rows=len(rows), source=source)
    if not submission.is_new:
        return files_page(request, [texts["again"].format(moment(submission.received_at, request.lang))])
    marked = mark_submission(request.site.course, request.site.store, submission.id)
    now = class_here(request)
    sources = {item.source for item in rows if not isinstance(item, PlatformFile)}
    lost = sum(item.row.source in sources for item in now.rejected)
    return files_page(request, [texts["came"].format(answers, marked.marked, lost)])


def _rows(sent: Sequence[Upload], too_many: str, too_much: str) -> list[AnswerRow | Rejected | PlatformFile]:
    """Return the rows of uploaded files, with the files' original names; ``too_many`` and ``too_much`` are
    the messages for too many rows and for reading that takes too long."""
    with TemporaryDirectory(prefix="coursework-") as temporary:
        folder = Path(temporary).resolve()
        for number, upload in enumerate(sent):
            subfolder = folder / str(number)
            subfolder.mkdir()
            (subfolder / file_name(upload)).write_bytes(upload.data)
        rows: list[AnswerRow | Rejected | PlatformFile] = read_apart(
            DESK_FILES, too_much, uploads.rows_in, folder
        )
    if len(rows) > uploads.MOST_ROWS:
        raise BadInput(too_many)
    return rows


def file_name(upload: Upload) -> str:
    """Return the base name of a file, without the folders that a browser may state."""
    base = PurePath(upload.name.replace("\\", "/")).name
    plain = "".join(c for c in base if c.isprintable() and c not in '/:*?"<>|').lstrip(".")
    return plain.encode("utf-8", "ignore")[-_NAME:].decode("utf-8", "ignore") or "answers"


def roster_in(request: Request) -> Response:
    """Store the columns of a roster; report the students on it to whom nothing was issued.

    Raises
    ------
    BadInput
        The file is not a roster.
    """
    now = class_here(request)
    texts = request.words["files"]
    sent = request.form.upload("roster")
    if sent is None:
        raise BadInput(texts["none_sent"])
    students, notes = read_upload(request, DESK_FILES, uploads.roster_in, file_name(sent), sent.data)
    issued_names = {
        entry.name: now.issued.student(entry.name, tuple(entry.columns.items())) for entry in students
    }
    columns = {
        name: dict(entry.columns)
        for entry in students
        if (name := issued_names[entry.name]) and entry.columns
    }
    with request.site.store.begin() as connection:
        content = issued_content(connection, now.about.id)
        content["students"] = {**content.get("students", {}), **_merged(content.get("students", {}), columns)}
        put_issued(connection, content, now.about.name)
        request.note(connection, "roster", assignment=now.about.id, students=len(columns))
    strangers = [entry.name for entry in students if not issued_names[entry.name]]
    messages = [texts["roster_came"].format(len(students) - len(strangers), len(students))]
    messages += [localised(line) for line in notes]
    if strangers:
        messages.append(texts["roster_strangers"].format(_named(strangers)))
    return files_page(request, messages)


def _merged(
    before: Mapping[str, Mapping[str, str]], columns: Mapping[str, Mapping[str, str]]
) -> dict[str, dict[str, str]]:
    return {name: {**before.get(name, {}), **added} for name, added in columns.items()}


# -------------------------------------------------------------------------- out


def spreadsheet_of(request: Request) -> Spreadsheet:
    """Return the spreadsheet format of tables: that of the query, or else that of the language."""
    decimal = request.query_params.get("decimal", "comma" if request.lang == "fr" else "point")
    return SPREADSHEETS.get(decimal, SPREADSHEETS["point"])


def _marks(request: Request, now: ClassState) -> bytes:
    submitted = any(graded.submitted for graded in now.graded.values())
    rows = (row for graded in now.graded.values() for row in marks_rows(graded))
    return csv_file(rows, marks_columns(now.issued, submitted=submitted), spreadsheet_of(request))


def _summary(request: Request, now: ClassState) -> bytes:
    return _summary_table(now, spreadsheet_of(request))


def _summary_table(now: ClassState, spreadsheet: Spreadsheet = SPREADSHEETS["point"]) -> bytes:
    columns, rows = summary_table(now.book)
    return csv_file(rows, columns, spreadsheet)


def _rejected(request: Request, now: ClassState) -> bytes:
    return csv_file(rejected_rows(now.book.rejected), REJECTED_COLUMNS, spreadsheet_of(request))


def _shows(now: ClassState, student: str) -> bool:
    """Return True if tables of a class, or of a part of it, contain a student."""
    return now.is_whole or student in now.issued.students


def _decided(request: Request, now: ClassState) -> bytes:
    with request.site.store.reading() as connection:
        decisions = [
            one._replace(student=student)
            for one in decided_since(connection, now.about.id, 0)
            if _shows(now, student := now.shown(one.student))
        ]
    rows = (
        {**one._asdict(), "made": one.made and one.made.isoformat(timespec="seconds")} for one in decisions
    )
    return csv_file(
        ({c: "" if row[c] is None else row[c] for c in _DECISIONS} for row in rows),
        _DECISIONS,
        spreadsheet_of(request),
    )


def _issued(request: Request, now: ClassState) -> bytes:
    with request.site.store.reading() as connection:
        # The secret would reveal future papers, so only a publisher receives it.
        may_draw = request.user.may(Permission.ASSIGNMENTS_PUBLISH, now.about.id, "")
        return json_text(issued_content(connection, now.about.id, secret=may_draw)).encode()


def _answers(request: Request, now: ClassState) -> bytes:
    with request.site.store.reading() as connection:
        rows = [
            row._replace(student=student) if now.codes and student else row
            for row in rows_of(connection, now.about.id)
            if isinstance(row, AnswerRow) and _shows(now, student := now.issued.student(row.student) or "")
        ]
    columns = (*COLUMNS, "sitting", "submitted", "source")
    answers = ({**as_texts(row), "source": row.source, **_origin(row)} for row in rows)
    return csv_file(answers, columns)


def _origin(row: AnswerRow) -> dict[str, str]:
    if row.origin is None:
        return {"sitting": "", "submitted": ""}
    return {"sitting": str(row.origin.sitting or ""), "submitted": row.origin.submitted}


def _submissions(request: Request, now: ClassState) -> bytes:
    with request.site.store.reading() as connection:
        rows = submissions_of(connection, now.about.id)
    return csv_file(({c: str(getattr(row, c)) for c in _SUBMISSIONS} for row in rows), _SUBMISSIONS)


def _wide(request: Request, now: ClassState) -> bytes:
    """Return an empty table for answers on paper: a line for each student, a column for each question."""
    with request.site.store.reading() as connection:
        content = issued_content(connection, now.about.id)
    students = {*now.issued.students}
    own = [item for item in content["issued"] if item["student"] in students]
    columns, rows = wide_form(now.course, {**content, "issued": own}, now.questions, codes=now.codes)
    return csv_file(rows, columns, spreadsheet_of(request))


WIDE = "answers_wide.csv"

#: Makers of the tables, by file name.
_TABLES: Mapping[str, Callable[[Request, ClassState], bytes]] = {
    "marks.csv": _marks,
    "summary.csv": _summary,
    "rejected.csv": _rejected,
    "decisions.csv": _decided,
    "answers.csv": _answers,
    "issued.json": _issued,
}


def _tables(request: Request, now: ClassState) -> Mapping[str, Callable[[Request, ClassState], bytes]]:
    """Return the makers of the tables of a class; of a part of it, those that name nobody else. What tells
    whose a code is goes to a publisher alone."""
    tells_whose = not now.codes or request.user.may(Permission.ASSIGNMENTS_PUBLISH, now.about.id, "")
    has_record = now.is_whole and tells_whose
    return _TABLES if has_record else {name: make for name, make in _TABLES.items() if name != "issued.json"}


def table(request: Request) -> Response:
    """Return one table, or all of them in an archive, which tells of no code whose it is."""
    now = class_here(request).coded
    name, tables = str(request.path_params["file"]), _tables(request, now)
    if name == "archive.zip":
        files = {
            member: make(request, now)
            for member, make in tables.items()
            if not (now.codes and member == "issued.json")
        }
        if now.is_whole and not now.codes:
            files["submissions.csv"] = _submissions(request, now)
        return Download(zipped(files), "application/zip", f"{_safe(now.about.name)}.zip")
    if name == WIDE:
        return Download(_wide(request, now), "text/csv; charset=utf-8", name)
    if name not in tables:
        raise HTTPException("page", 404)
    kind = "application/json" if name.endswith(".json") else "text/csv; charset=utf-8"
    return Download(_TABLES[name](request, now), kind, name)


def _safe(name: str) -> str:
    return "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "-" for c in name) or "assignment"


def feedback(request: Request) -> Response:
    """Return the feedback of a student, or of all students in an archive."""
    now = class_here(request).coded
    only = request.query_params.get("student", "")
    selected = [graded for graded in now.graded.values() if not only or graded.student == only]
    if not selected:
        raise BadInput(request.words["class"]["nothing"])
    with TemporaryDirectory(prefix="coursework-") as temporary:
        folder = Path(temporary) / "feedback"
        book = now.book if not only else _book_of_student(now, only)
        write_feedback(now.course, book, selected, folder, lambda done, of: None)
        files = {path.name: path.read_bytes() for path in sorted(folder.glob("*.pdf"))}
    if only and files:
        name, data = next(iter(files.items()))
        if len(files) == 1:
            return Download(data, "application/pdf", f"feedback-{_safe(name.removesuffix('.pdf'))}.pdf")
    return Download(zipped(files), "application/zip", f"feedback-{_safe(now.about.name)}.zip")


def _book_of_student(now: ClassState, student: str) -> Any:
    """Return the current gradebook, set to write the feedback of one student alone."""
    from copy import copy

    book, issued = copy(now.book), copy(now.issued)
    issued.students = (student,)
    book.issued = issued
    return book


# -------------------------------------------------------------------- gradebooks


def gradebook(request: Request) -> Response:
    """Return a platform's exported gradebook with the marks filled in.

    Raises
    ------
    BadInput
        No file was sent, or it cannot be filled in.
    """
    now = class_here(request)
    texts, form = request.words["files"], request.form
    if now.codes:
        raise BadInput(texts["by_codes"].format(now.waiting))
    sent = form.upload("template")
    if sent is None:
        raise BadInput(texts["none_sent"])
    score = form.text("score", "points")
    platform = platform_gradebook(form.text("platform"))
    with TemporaryDirectory(prefix="coursework-") as temporary:
        folder = Path(temporary)
        (folder / "summary.csv").write_bytes(_summary_table(now))
        path = folder / "sent" / file_name(sent)
        path.parent.mkdir()
        path.write_bytes(sent.data)
        try:
            scored = class_points(folder / "summary.csv", score if score in SCORES else "points")
            waiting = [now.shown(entry.name) for entry in scored if entry.open]
            if not form.text("provisional"):
                scored = [entry for entry in scored if not entry.open]
            most = form.text("most").strip().replace(",", ".")
            filled = read_apart(
                DESK_FILES,
                request.words["refused"]["too_much"],
                uploads.filled_in,
                platform.name,
                path,
                form.text("item").strip(),
                scored,
                float(most) if most else None,
                bool(form.text("zeros")),
            )
        except ValueError as fault:
            if isinstance(fault, CourseworkError):
                raise BadInput(
                    as_message(fault).replacing(f"{temporary}/sent/", "").replacing(f"{temporary}/", "")
                ) from fault
            raise BadInput(texts["no_number"]) from None
    messages = [texts["filled"].format(filled.written, filled.column)]
    if score != "mark" and is_rescaled((now.adjusted.assignment or {}).get("mark")):
        messages.append(texts["rescaled"])
    outcomes = {
        "strangers": filled.strangers,
        "unclear": filled.unclear,
        "absent": filled.absent,
        "kept": filled.unchanged,
    }
    outcomes["provisional" if form.text("provisional") else "left_out"] = tuple(waiting)
    messages += [texts[key].format(len(names), _named(names)) for key, names in outcomes.items() if names]
    return files_page(request, messages, filled, file_name(sent))


def _filled(request: Request, filled: Filled | None, name: str) -> Mapping[str, str] | None:
    """Return a filled gradebook as a data URL."""
    if filled is None:
        return None
    return {"name": name, "data": f"data:text/csv;base64,{base64.b64encode(filled.data).decode()}"}


ROUTES = (
    Route("/desk/{assignment:int}/files", files_page, Permission.MARKS_EXPORT, by_group=True),
    Route(
        "/desk/{assignment:int}/answers",
        answers_in,
        Permission.FILES_BRING,
        takes_forms=True,
        limit="upload",
        budget=DESK_FILES,
    ),
    Route(
        "/desk/{assignment:int}/roster",
        roster_in,
        Permission.FILES_BRING,
        takes_forms=True,
        limit="upload",
        budget=DESK_FILES,
    ),
    Route(
        "/desk/{assignment:int}/gradebook",
        gradebook,
        Permission.MARKS_EXPORT,
        takes_forms=True,
        by_group=True,
        limit="upload",
        budget=DESK_FILES,
    ),
    Route("/desk/{assignment:int}/feedback", feedback, Permission.MARKS_EXPORT, by_group=True),
    Route("/desk/{assignment:int}/files/{file}", table, Permission.MARKS_EXPORT, by_group=True),
)
