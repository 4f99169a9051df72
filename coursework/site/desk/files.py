"""Files in and out: answers, rosters and what platforms collected; tables, feedback and archives. What is sent is read, never run."""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import Any

from coursework.database.assignments import issued_content, put_issued
from coursework.database.audit import note
from coursework.database.deliveries import deliver, deliveries, rows_of
from coursework.database.desk import decisions_of
from coursework.database.marking import mark_delivery
from coursework.database.permissions import Permission
from coursework.errors import BadInput, CourseworkError
from coursework.gradebook.book import marks_rows, rejected_rows, summary_rows
from coursework.gradebook.class_points import SCORES, class_points
from coursework.gradebook.columns import REJECTED_COLUMNS, marks_columns, summary_columns
from coursework.gradebook.feedback_sheets import write_feedback
from coursework.gradebook.filling import Filled, fill
from coursework.gradebook.placing import as_texts
from coursework.gradebook.platform_gradebooks import PLATFORMS, platform_gradebook
from coursework.gradebook.rows import Rejected, Row, Seen
from coursework.gradebook.submissions import find, read_file
from coursework.making.issued import COLUMNS
from coursework.making.roster import roster_and_notes
from coursework.site.desk.class_cache import ClassNow, assignment_of, by_whom, class_now, class_page_of
from coursework.site.desk.question_cards import moment
from coursework.site.frame.budgets import DESK_FILES, read_apart
from coursework.site.frame.requests import HTTPException, Request, Response, Route, Upload
from coursework.system.tables import SPREADSHEETS, Spreadsheet, csv_file, json_text
from coursework.system.unzipping import is_zip, unpack
from coursework.system.zips import zipped

MOST_ROWS = 500_000  #: of what is sent at once
_NAME = 120  #: bytes of a file's name, the last ones
_NAMED = 10  #: students that a sentence names
_DECISIONS = ("made", "by", "kind", "student", "exercise", "seed", "part", "points", "reason", "answer")
_DELIVERIES = ("came", "source", "number", "late", "receipt")


# --------------------------------------------------------------------------- in


def files_page(
    request: Request, told: Sequence[str] = (), filled: Filled | None = None, name: str = ""
) -> Response:
    """Return the page of uploads and downloads."""
    now = class_now(request.site, assignment_of(request))
    with request.site.store.reading() as connection:
        came = deliveries(connection, now.about.id)
    files = [(moment(one.came, request.lang), one) for one in came if not one.number]
    return class_page_of(
        request, now, "site_desk_files", "files", told=list(told), files=files[::-1][:50], rejected=now.rejected,
        platforms=PLATFORMS.values(), scores=SCORES, downloads=list(_TABLES), filled=_filled(request, filled, name),
    )  # fmt: skip


def answers_in(request: Request) -> Response:
    """Store uploaded answers, and mark the new ones.

    Raises
    ------
    BadInput
        Nothing was sent, or an archive holds more than it may.
    """
    number = class_now(request.site, assignment_of(request)).about.id
    sent = [one for one in request.form.files.get("answers", ()) if one.data]
    said = request.words["files"]
    if not sent:
        raise BadInput(said["none_sent"])
    rows = _rows(sent, said["too_many"].format(MOST_ROWS), request.words["refused"]["too_much"])
    answers = sum(isinstance(one, Row) for one in rows)
    source = ", ".join(file_name(one) for one in sent)[:500]
    with request.site.store.begin() as connection:
        came = deliver(connection, number, rows, source=source, came=request.received_at)
        note(
            connection,
            request.received_at,
            by_whom(request),
            "answers",
            assignment=number,
            rows=len(rows),
            source=source,
        )
    if not came.is_new:
        return files_page(request, [said["again"].format(moment(came.came, request.lang))])
    marked = mark_delivery(request.site.course, request.site.store, came.id)
    now = class_now(request.site, number)
    sources = {one.source for one in rows if not isinstance(one, Seen)}
    lost = sum(one.row.source in sources for one in now.rejected)
    return files_page(request, [said["came"].format(answers, marked.marked, lost)])


def _rows(sent: Sequence[Upload], too_many: str, too_much: str) -> list[Row | Rejected | Seen]:
    """Return the rows of uploaded files, with the files' original names; ``too_many`` and ``too_much`` are
    the messages for too many rows and for reading that takes too long."""
    with TemporaryDirectory(prefix="coursework-") as made:
        folder = Path(made).resolve()
        for number, one in enumerate(sent):
            own = folder / str(number)
            own.mkdir()
            (own / file_name(one)).write_bytes(one.data)
        rows: list[Row | Rejected | Seen] = read_apart(DESK_FILES, too_much, _rows_in, folder)
    if len(rows) > MOST_ROWS:
        raise BadInput(too_many)
    return rows


def _rows_in(folder: Path) -> list[Row | Rejected | Seen]:
    """Return the rows of the files below a folder, archives included; one more than the limit if there are
    too many."""
    for path in sorted(folder.glob("*/*")):
        if path.suffix.lower() == ".zip" and is_zip(path.read_bytes()[:4]):
            inside = path.parent / "zip"
            inside.mkdir()
            unpack(path, inside)
            path.unlink()
    return list(islice(_read(folder), MOST_ROWS + 1))


def file_name(one: Upload) -> str:
    """Return the base name of a file, without the folders that a browser may state."""
    own = PurePath(one.name.replace("\\", "/")).name
    plain = "".join(c for c in own if c.isprintable() and c not in '/:*?"<>|').lstrip(".")
    return plain.encode("utf-8", "ignore")[-_NAME:].decode("utf-8", "ignore") or "answers"


def _read(folder: Path) -> Iterator[Row | Rejected | Seen]:
    for found in find([folder]):
        rows = [found] if isinstance(found, (Rejected, Seen)) else read_file(found, [folder])
        for row in rows:
            yield _with_short_source(row, folder)


def _with_short_source(row: Row | Rejected | Seen, folder: Path) -> Row | Rejected | Seen:
    """Return a row without the temporary folder in its source."""

    def shortened(text: str) -> str:
        for number in range(60):
            text = text.replace(f"{folder}/{number}/zip/", "").replace(f"{folder}/{number}/", "")
        return text.replace(str(folder), "")

    if isinstance(row, Row):
        return row._replace(
            source=shortened(row.source), warning=shortened(row.warning) if row.warning else ""
        )
    if isinstance(row, Rejected):
        return Rejected(shortened(row.source), shortened(row.reason), row.row)
    return row._replace(source=shortened(row.source))


def roster_in(request: Request) -> Response:
    """Store the columns of a roster; report the students on it to whom nothing was issued.

    Raises
    ------
    BadInput
        The file is no roster.
    """
    now = class_now(request.site, assignment_of(request))
    said = request.words["files"]
    sent = next((one for one in request.form.files.get("roster", ()) if one.data), None)
    if sent is None:
        raise BadInput(said["none_sent"])
    told: list[str] = []
    with TemporaryDirectory(prefix="coursework-") as made:
        path = Path(made) / file_name(sent)
        path.write_bytes(sent.data)
        try:
            students, told = read_apart(
                DESK_FILES, request.words["refused"]["too_much"], roster_and_notes, path
            )
        except BadInput as fault:
            raise BadInput(str(fault).replace(f"{made}/", "")) from fault
    known = {one.name: now.issued.student(one.name, tuple(one.columns.items())) for one in students}
    columns = {name: dict(one.columns) for one in students if (name := known[one.name]) and one.columns}
    with request.site.store.begin() as connection:
        content = issued_content(connection, now.about.id)
        content["students"] = {**content.get("students", {}), **_merged(content.get("students", {}), columns)}
        put_issued(connection, content, now.about.name)
        note(
            connection,
            request.received_at,
            by_whom(request),
            "roster",
            assignment=now.about.id,
            students=len(columns),
        )
    strangers = [one.name for one in students if not known[one.name]]
    told = [note.replace(f"{made}/", "") for note in told]
    told.insert(0, said["roster_came"].format(len(students) - len(strangers), len(students)))
    if strangers:
        told.append(said["roster_strangers"].format(_list(strangers)))
    return files_page(request, told)


def _merged(
    before: Mapping[str, Mapping[str, str]], columns: Mapping[str, Mapping[str, str]]
) -> dict[str, dict[str, str]]:
    return {name: {**before.get(name, {}), **own} for name, own in columns.items()}


def _list(names: Sequence[str]) -> str:
    return ", ".join(names[:_NAMED]) + (f", … ({len(names)})" if len(names) > _NAMED else "")


# -------------------------------------------------------------------------- out


def _spreadsheet(request: Request) -> Spreadsheet:
    """Return the spreadsheet format of tables: that of the query, or else that of the language."""
    told = request.query_params.get("decimal", "comma" if request.lang == "fr" else "point")
    return SPREADSHEETS.get(told, SPREADSHEETS["point"])


def _marks(request: Request, now: ClassNow) -> bytes:
    submitted = any(one.submitted for one in now.graded.values())
    rows = (row for one in now.graded.values() for row in marks_rows(one))
    return csv_file(rows, marks_columns(now.issued, submitted=submitted), _spreadsheet(request))


def _summary(request: Request, now: ClassNow) -> bytes:
    return csv_file(
        summary_rows(now.book), summary_columns(now.issued, late=bool(now.charged)), _spreadsheet(request)
    )


def _rejected(request: Request, now: ClassNow) -> bytes:
    return csv_file(rejected_rows(now.book.rejected), REJECTED_COLUMNS, _spreadsheet(request))


def _decided(request: Request, now: ClassNow) -> bytes:
    with request.site.store.reading() as connection:
        made = decisions_of(connection, now.about.id)
    rows = ({**one._asdict(), "made": one.made.isoformat(timespec="seconds")} for one in made)
    return csv_file(
        ({c: "" if row[c] is None else row[c] for c in _DECISIONS} for row in rows),
        _DECISIONS,
        _spreadsheet(request),
    )


def _issued(request: Request, now: ClassNow) -> bytes:
    with request.site.store.reading() as connection:
        # Who only marks needs no secret, and draws no paper that is to come.
        may_draw = request.user.may(Permission.ASSIGNMENTS_PUBLISH, now.about.id, "")
        return json_text(issued_content(connection, now.about.id, secret=may_draw)).encode()


def _answers(request: Request, now: ClassNow) -> bytes:
    with request.site.store.reading() as connection:
        rows = [one for one in rows_of(connection, now.about.id) if isinstance(one, Row)]
    columns = (*COLUMNS, "sitting", "submitted", "source")
    told = ({**as_texts(one), "source": one.source, **_origin(one)} for one in rows)
    return csv_file(told, columns)


def _origin(row: Row) -> dict[str, str]:
    if row.origin is None:
        return {"sitting": "", "submitted": ""}
    return {"sitting": str(row.origin.sitting or ""), "submitted": row.origin.submitted}


def _submissions(request: Request, now: ClassNow) -> bytes:
    with request.site.store.reading() as connection:
        rows = [one._asdict() for one in deliveries(connection, now.about.id)]
    return csv_file(({c: str(row[c]) for c in _DELIVERIES} for row in rows), _DELIVERIES)


#: What can be had, by its file's name.
_TABLES: Mapping[str, Callable[[Request, ClassNow], bytes]] = {
    "marks.csv": _marks,
    "summary.csv": _summary,
    "rejected.csv": _rejected,
    "decisions.csv": _decided,
    "answers.csv": _answers,
    "issued.json": _issued,
}


def table(request: Request) -> Response:
    """Return one table, or all of them in an archive."""
    now = class_now(request.site, assignment_of(request))
    name = str(request.path_params["file"])
    if name == "archive.zip":
        files = {own: make(request, now) for own, make in _TABLES.items()} | {
            "deliveries.csv": _submissions(request, now)
        }
        return Response(
            media_type="application/zip", content=zipped(files), filename=f"{_safe(now.about.name)}.zip"
        )
    if name not in _TABLES:
        raise HTTPException("page", 404)
    kind = "application/json" if name.endswith(".json") else "text/csv; charset=utf-8"
    return Response(media_type=kind, content=_TABLES[name](request, now), filename=name)


def _safe(name: str) -> str:
    return "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "-" for c in name) or "assignment"


def feedback(request: Request) -> Response:
    """Return the feedback of a student, or of all students in an archive."""
    now = class_now(request.site, assignment_of(request))
    only = request.query_params.get("student", "")
    shown = [one for one in now.graded.values() if not only or one.student == only]
    if not shown:
        raise BadInput(request.words["class"]["nothing"])
    with TemporaryDirectory(prefix="coursework-") as made:
        folder = Path(made) / "feedback"
        book = now.book if not only else _book_of_student(now, only)
        write_feedback(now.course, book, shown, folder, lambda done, of: None)
        files = {path.name: path.read_bytes() for path in sorted(folder.glob("*.pdf"))}
    if only and files:
        name, data = next(iter(files.items()))
        if len(files) == 1:
            return Response(
                media_type="application/pdf",
                content=data,
                filename=f"feedback-{_safe(name.removesuffix('.pdf'))}.pdf",
            )
    return Response(
        media_type="application/zip", content=zipped(files), filename=f"feedback-{_safe(now.about.name)}.zip"
    )


def _book_of_student(now: ClassNow, student: str) -> Any:
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
        Nothing was sent, or it cannot be filled; nothing is written then.
    """
    now = class_now(request.site, assignment_of(request))
    said, form = request.words["files"], request.form
    sent = next((one for one in form.files.get("template", ()) if one.data), None)
    if sent is None:
        raise BadInput(said["none_sent"])
    score = form.text("score", "points")
    platform = platform_gradebook(form.text("platform"))
    with TemporaryDirectory(prefix="coursework-") as made:
        folder = Path(made)
        (folder / "summary.csv").write_bytes(
            csv_file(summary_rows(now.book), summary_columns(now.issued, late=bool(now.charged)))
        )
        path = folder / "sent" / file_name(sent)
        path.parent.mkdir()
        path.write_bytes(sent.data)
        try:
            scored = class_points(folder / "summary.csv", score if score in SCORES else "points")
            most = form.text("most").strip().replace(",", ".")
            filled = read_apart(
                DESK_FILES, request.words["refused"]["too_much"], _filled_in, platform.name, path, form.text("item").strip(), scored,
                float(most) if most else None, bool(form.text("zeros")),
            )  # fmt: skip
        except ValueError as fault:
            if isinstance(fault, CourseworkError):
                raise BadInput(str(fault).replace(f"{made}/sent/", "").replace(f"{made}/", "")) from fault
            raise BadInput(said["no_number"]) from None
    told = [said["filled"].format(filled.written, filled.column)]
    for what in ("strangers", "unclear", "absent", "kept"):
        if names := getattr(filled, what):
            told.append(said[what].format(len(names), _list(names)))
    return files_page(request, told, filled, file_name(sent))


def _filled_in(
    platform: str, path: Path, item: str, scored: Sequence[Any], most: float | None, zeros: bool
) -> Filled:
    return fill(platform_gradebook(platform), path, item, scored, most=most, zeros=zeros)


def _filled(request: Request, filled: Filled | None, name: str) -> Mapping[str, str] | None:
    """Return a filled gradebook as a data URL."""
    if filled is None:
        return None
    return {"name": name, "data": f"data:text/csv;base64,{base64.b64encode(filled.data).decode()}"}


ROUTES = (
    Route("/desk/{assignment:int}/files", files_page, Permission.MARKS_EXPORT),
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
        limit="upload",
        budget=DESK_FILES,
    ),
    Route("/desk/{assignment:int}/feedback", feedback, Permission.MARKS_EXPORT),
    Route("/desk/{assignment:int}/files/{file}", table, Permission.MARKS_EXPORT),
)
