"""Submissions: files, or answers that a person submits on the site. Each is stored as received; a repeated
one is stored once."""

from __future__ import annotations

from base64 import b32encode
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from datetime import datetime
from functools import cache
from hashlib import sha256
from heapq import merge
from operator import itemgetter
from typing import Any, NamedTuple

from sqlalchemy import (
    BindParameter,
    Column,
    ColumnElement,
    CompoundSelect,
    Connection,
    Select,
    bindparam,
    exists,
    func,
    insert,
    literal_column,
    null,
    select,
    update,
)

from coursework.database.assignments import issued_of
from coursework.database.store import insert_unless_there
from coursework.database.tables import (
    answer,
    drawing,
    issue,
    marking,
    rejected,
    seen,
    submission,
    variant,
)
from coursework.gradebook.placing import UnplacedError, student_of
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, RowOrigin
from coursework.issuing.issued import Issued

_CHUNK = 5000  #: rows that are written at once
_PlacedRow = tuple[tuple[Any, ...], AnswerRow | Rejected | PlatformFile]  #: submission and place in it


class Submission(NamedTuple):
    """Submission of several answers together."""

    id: int
    is_new: bool  #: False if an equal one was stored before
    source: str
    number: int  #: attempt of the person; 0 for files
    receipt: str
    late: int  #: seconds
    received_at: datetime


# ---------------------------------------------------------------------- writing


def insert_submission(
    connection: Connection,
    assignment_id: int,
    rows: Iterable[AnswerRow | Rejected | PlatformFile],
    *,
    source: str,
    received_at: datetime,
    person_id: int | None = None,
    number: int = 0,
    late: int = 0,
    replaces: bool = False,
    in_place: bool = False,
) -> Submission:
    """Store the rows of a submission as received; return an equal one from before, if there is one, and store
    nothing.

    ``number`` is the attempt of the person (:func:`next_number`), ``late`` the number of seconds after their
    closing date. A file that ``replaces`` takes the place of earlier submissions from the same source: these
    remain stored, and count no more. Rows of a file about a student who submitted on the site become a later
    attempt, unless the rows state it (``in_place``).
    """
    rows = list(rows)
    digest = _digest(rows, person_id)
    if person_id is None and not in_place:
        rows = _after_attempts_on_site(connection, assignment_id, rows)
    receipt = _receipt(assignment_id, digest)
    values = {
        "source": source,
        "number": number,
        "receipt": receipt,
        "late": late,
        "received_at": received_at,
    }
    row = {"assignment_id": assignment_id, "person_id": person_id, "digest": digest, **values}
    number_added = insert_unless_there(connection, submission, row, ("assignment_id", "digest"))
    if number_added is None:
        earlier = submission_alike(connection, assignment_id, digest)
        if replaces:
            _replace(connection, assignment_id, earlier.id, source, received_at)
        return earlier
    _put_rows(connection, number_added, rows)
    if replaces:
        _replace(connection, assignment_id, number_added, source, received_at)
    return Submission(number_added, True, source, number, receipt, late, received_at)


def _after_attempts_on_site(
    connection: Connection, assignment_id: int, rows: list[AnswerRow | Rejected | PlatformFile]
) -> list[AnswerRow | Rejected | PlatformFile]:
    """Return the rows of a file; those of students who submitted on the site get a later attempt number, so
    that two submissions are never merged."""
    on_site = submission.c.assignment_id == assignment_id, submission.c.number > 0
    query = select(answer.c.student, func.max(submission.c.number)).join(submission).where(*on_site)
    tries = {row[0]: row[1] for row in connection.execute(query.group_by(answer.c.student))}
    if not tries:
        return rows
    issued = issued_of(connection, assignment_id)

    def moved(row: AnswerRow | Rejected | PlatformFile) -> AnswerRow | Rejected | PlatformFile:
        if not isinstance(row, AnswerRow) or not (
            before := tries.get(_student_or_none(issued, row) or "", 0)
        ):
            return row
        origin = row.origin or RowOrigin()
        return row._replace(origin=origin._replace(sitting=before + max(1, origin.sitting)))

    return [moved(row) for row in rows]


def _student_or_none(issued: Issued, row: AnswerRow) -> str | None:
    with suppress(UnplacedError):
        return student_of(issued, row) if row.student else None
    return None


def _replace(connection: Connection, assignment_id: int, number: int, source: str, at: datetime) -> None:
    """Let one file replace all others from its source."""
    files = submission.c.assignment_id == assignment_id, submission.c.person_id.is_(None)
    others = *files, submission.c.source == source, submission.c.id != number, submission.c.replaced.is_(None)
    connection.execute(update(submission).where(*others).values(replaced=at))
    connection.execute(update(submission).where(submission.c.id == number).values(replaced=None))


def next_number(connection: Connection, assignment_id: int, person_id: int, student: str) -> int:
    """Return the number of a person's next attempt: one more than the greatest so far, on the site or
    elsewhere."""
    parameters = {"assignment": assignment_id, "person": person_id, "student": student}
    return 1 + max(
        sitting if is_known else max(1, (origin or {}).get("sitting", 1))
        for is_known, sitting, origin in connection.execute(_sittings_query(), parameters)
    )


@cache
def _sittings_query() -> CompoundSelect[Any]:
    """Return the query of :func:`next_number`, cached: the attempts in files, on the site, and those that are
    marked.

    An attempt under another spelling of the name is known once it is marked.
    """
    of_it: BindParameter[int] = bindparam("assignment")
    student: BindParameter[str] = bindparam("student")
    in_files = (
        select(literal_column("0").label("is_known"), literal_column("0").label("sitting"), answer.c.origin)
        .join(submission)
        .where(
            submission.c.assignment_id == of_it, submission.c.person_id.is_(None), answer.c.student == student
        )
    )
    theirs = submission.c.assignment_id == of_it, submission.c.person_id == bindparam("person")
    named = marking.c.assignment_id == of_it, marking.c.student == student
    return in_files.union_all(
        select(literal_column("1"), func.coalesce(func.max(submission.c.number), 0), null()).where(*theirs),
        select(literal_column("1"), func.coalesce(func.max(marking.c.sitting), 0), null()).where(*named),
    )


def is_current(
    connection: Connection,
    assignment_id: int,
    rows: Sequence[AnswerRow | Rejected | PlatformFile],
    source: str,
) -> bool:
    """Return True if these rows are those of the submission from a source that counts; without rows, if there
    is none."""
    found = select(submission.c.digest).where(
        submission.c.assignment_id == assignment_id,
        submission.c.source == source,
        submission.c.replaced.is_(None),
    )
    digests = {*connection.execute(found).scalars()}
    return digests == {_digest(rows, None)} or not (digests or rows)


def submission_alike(connection: Connection, assignment_id: int, digest: str) -> Submission:
    """Return the submission with the given digest."""
    row = connection.execute(
        select(submission).where(submission.c.assignment_id == assignment_id, submission.c.digest == digest)
    ).one()
    return _submission(row, is_new=False)


def submissions_of_student(connection: Connection, assignment_id: int, student: str) -> list[Submission]:
    """Return the submissions of a student, in order: those on the site, and files that name the student as
    issued."""
    named = select(answer.c.submission_id).where(answer.c.student == student)
    of_student = submission.c.assignment_id == assignment_id, submission.c.id.in_(named)
    rows = connection.execute(select(submission).where(*of_student).order_by(submission.c.id))
    return [_submission(row, is_new=False) for row in rows]


def _submission(row: Any, *, is_new: bool) -> Submission:
    return Submission(row.id, is_new, row.source, row.number, row.receipt, row.late, row.received_at)


def _put_rows(
    connection: Connection, number: int, rows: Sequence[AnswerRow | Rejected | PlatformFile]
) -> None:
    by_table: dict[Any, list[dict[str, Any]]] = {answer: [], rejected: [], seen: []}
    origins: dict[RowOrigin, dict[str, Any]] = {}
    for position, row in enumerate(rows):
        key = {"submission_id": number, "place": position}
        if isinstance(row, AnswerRow):
            columns = {**row._asdict(), "answer": _as_json(row.answer)}
            if row.origin is not None:
                columns["origin"] = origins.setdefault(row.origin, _origin_as_json(row.origin))
            by_table[answer].append({**key, **columns})
        elif isinstance(row, Rejected):
            by_table[rejected].append({**key, "source": row.source, "reason": row.reason, "row": row.row})
        else:
            by_table[seen].append({**key, **row._asdict()})
    for table, lines in by_table.items():
        for start in range(0, len(lines), _CHUNK):
            connection.execute(insert(table), lines[start : start + _CHUNK])


def put_drawings(connection: Connection, stored: Submission, texts: Mapping[str, str]) -> None:
    """Store the drawings of a submission, by exercise."""
    rows = [{"exercise": exercise, "text": text} for exercise, text in texts.items()]
    if rows:
        connection.execute(insert(drawing), [{"submission_id": stored.id, **row} for row in rows])


# ---------------------------------------------------------------------- reading


def drawings_of(connection: Connection, assignment_id: int, student: str) -> dict[tuple[int, str], str]:
    """Return the drawings that a student submitted for an assignment, by attempt and exercise."""
    query = (
        select(submission.c.number, drawing.c.exercise, drawing.c.text)
        .join(drawing, drawing.c.submission_id == submission.c.id)
        .where(submission.c.assignment_id == assignment_id)
        .where(exists().where(answer.c.submission_id == submission.c.id, answer.c.student == student))
    )
    return {(row.number, row.exercise): row.text for row in connection.execute(query)}


def submissions_of(
    connection: Connection, assignment_id: int, person_id: int | None = None
) -> list[Submission]:
    """Return the submissions for an assignment, in order; of one person alone, if given."""
    return submissions_by_assignment(connection, [assignment_id], person_id).get(assignment_id, [])


def submissions_by_assignment(
    connection: Connection, assignment_ids: Sequence[int], person_id: int | None = None
) -> dict[int, list[Submission]]:
    """Return the submissions for each assignment that has some, in order; of one person alone, if given."""
    parameters: dict[str, Any] = {"assignments": assignment_ids}
    if person_id is not None:
        parameters["person"] = person_id
    done: dict[int, list[Submission]] = {}
    for row in connection.execute(_submissions_query(person_id is not None), parameters):
        done.setdefault(row.assignment_id, []).append(_submission(row, is_new=False))
    return done


def _of_assignments(column: Column[int]) -> ColumnElement[bool]:
    """Return the condition that a column is one of the parameter ``assignments``."""
    return column.in_(bindparam("assignments", expanding=True))


@cache
def _submissions_query(is_of_one: bool) -> Select[Any]:
    """Return the query of :func:`submissions_by_assignment`, cached since many requests execute it."""
    query = select(submission).where(_of_assignments(submission.c.assignment_id))
    if is_of_one:
        query = query.where(submission.c.person_id == bindparam("person"))
    return query.order_by(submission.c.id)


def answers_of(connection: Connection, submission_id: int) -> list[list[str]]:
    """Return exercise, seed, part and answer of each question of a submission, in order."""
    rows = connection.execute(_answers_query(), {"submission": submission_id})
    return [[*row[:3], str(_from_json(row.answer) or "")] for row in rows]


@cache
def _answers_query() -> Select[Any]:
    """Return the query of :func:`answers_of`, cached."""
    columns = answer.c.exercise, answer.c.seed, answer.c.part, answer.c.answer
    return select(*columns).where(answer.c.submission_id == bindparam("submission")).order_by(answer.c.place)


@cache
def _papers_query() -> Select[Any]:
    """Return the query of a person's papers, cached."""
    theirs = _of_assignments(variant.c.assignment_id), issue.c.person_id == bindparam("person")
    columns = variant.c.assignment_id, issue.c.sitting, variant.c.exercise, variant.c.seed
    return select(*columns).select_from(issue.join(variant)).where(*theirs)


def attempts_used(
    connection: Connection, person_id: int, done: Mapping[int, Sequence[Submission]]
) -> dict[int, int]:
    """Return the number of attempts that a person has used for the current paper of each assignment; a
    make-up is another paper.

    ``done`` are the person's :func:`submissions_by_assignment`.
    """
    tries = {number: [one.id for one in several if one.number > 0] for number, several in done.items()}
    used = {number: len(ids) for number, ids in tries.items()}
    if not any(tries.values()):
        return used
    papers: dict[int, dict[int, set[tuple[str, str]]]] = {}  #: by assignment and sitting
    parameters = {"assignments": list(done), "person": person_id}
    for number, sitting, *sheet in connection.execute(_papers_query(), parameters):
        papers.setdefault(number, {}).setdefault(sitting, set()).add(tuple(sheet))
    last = {number: sheets[max(sheets)] for number, sheets in papers.items() if max(sheets) > 1}
    if last:
        of_them = answer.c.submission_id.in_([one for number in last for one in tries[number]])
        query = select(answer.c.submission_id, answer.c.exercise, answer.c.seed).where(of_them).distinct()
        sheets_of: dict[int, set[tuple[str, str]]] = {}
        for submitted, *sheet in connection.execute(query):
            sheets_of.setdefault(submitted, set()).add(tuple(sheet))
        for number, sheets in last.items():
            used[number] = sum(not sheets.isdisjoint(sheets_of.get(one, ())) for one in tries[number])
    return used


def rows_of(
    connection: Connection, assignment_id: int, submission_id: int | None = None
) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    """Yield the rows that count, in the order in which they were received; if a submission is given, all of
    its rows and no others.

    A row that is equal to one of an earlier submission is yielded only once.
    """

    def of(table: Any) -> Select[Any]:
        columns = [c for c in table.c if c.name not in ("id", "submission_id", "place")]
        query = select(table.c.submission_id, table.c.place, *columns)
        if submission_id is not None:
            return query.where(table.c.submission_id == submission_id).order_by(table.c.place)
        query = query.join(submission).where(
            submission.c.assignment_id == assignment_id, submission.c.replaced.is_(None)
        )
        return query.order_by(table.c.submission_id, table.c.place)

    met: dict[str, RowOrigin] = {}
    refused: list[_PlacedRow] = [
        (tuple(row[:2]), Rejected(*row[2:])) for row in connection.execute(of(rejected))
    ]
    seen_rows: list[_PlacedRow] = [
        (tuple(row[:2]), PlatformFile(*row[2:])) for row in connection.execute(of(seen))
    ]
    answers: Iterator[_PlacedRow] = (
        (tuple(row[:2]), _as_row(row, met)) for row in connection.execute(of(answer))
    )
    first: dict[Any, int] = {}
    for (number, _), row in merge(answers, refused, seen_rows, key=itemgetter(0)):
        content = _content(row)
        if content is None or first.setdefault(content, number) == number:
            yield row


def _content(row: AnswerRow | Rejected | PlatformFile) -> tuple[Any, ...] | None:
    """Return the content of a row without its place in the file; None if it states no answer."""
    if isinstance(row, AnswerRow):
        return (*row[:4], type(row.answer), row.answer, row.lang, row.origin)
    if isinstance(row, Rejected) and row.row:
        return row.reason, *row.row.items()
    return None


def _as_row(row: Sequence[Any], met: dict[str, RowOrigin]) -> AnswerRow:
    student, exercise, seed, part, value, source, warning, lang, origin = row[2:]
    return AnswerRow(
        student,
        exercise,
        seed,
        part,
        _from_json(value),
        source,
        warning,
        lang,
        _origin_from_json(origin, met),
    )


# ----------------------------------------------------------------------- values


_NUMBERS: Mapping[str, Callable[[str], Any]] = {"int": int, "float": float, "complex": complex}


def _as_json(value: Any) -> Any:
    """Return an answer in a form that every database can store: a number as its digits, ``{"float": "3.0"}``,
    since some databases change it."""
    if value is None or isinstance(value, (str, bool)):
        return value
    kind = next((name for name, number_type in _NUMBERS.items() if type(value) is number_type), None)
    return str(value) if kind is None else {kind: str(value)}


def _from_json(value: Any) -> Any:
    if not isinstance(value, Mapping):
        return value
    ((kind, digits),) = value.items()
    return _NUMBERS[kind](digits)


def _origin_as_json(origin: RowOrigin) -> dict[str, Any]:
    """Return the fields that differ from their defaults."""
    usual = RowOrigin._field_defaults
    return {name: value for name, value in origin._asdict().items() if value != usual[name]}


def _origin_from_json(stored: Mapping[str, Any] | None, met: dict[str, RowOrigin]) -> RowOrigin | None:
    if stored is None:
        return None
    key = repr(stored)
    if key not in met:
        ids = tuple((str(title), str(value)) for title, value in stored.get("ids", ()))
        met[key] = RowOrigin(**{**stored, "ids": ids, "by": tuple(stored.get("by", ()))})
    return met[key]


# ---------------------------------------------------------------------- digests


def _digest(rows: Sequence[AnswerRow | Rejected | PlatformFile], person_id: int | None) -> str:
    """Return the digest of the content of rows without their places in the file; with the places for rows
    without a name."""
    digest = sha256(b"" if person_id is None else str(person_id).encode())
    for row in rows:
        digest.update(repr(_digest_content(row)).encode("utf-8", "backslashreplace"))
    return digest.hexdigest()


def _digest_content(row: AnswerRow | Rejected | PlatformFile) -> tuple[Any, ...]:
    if isinstance(row, AnswerRow):
        content = (*row[:5], row.lang, row.origin)
        return content if row.student else (*content, _name(row.source))
    if isinstance(row, Rejected):
        return row.reason, row.row, _name(row.source)
    return row.what, row.is_tree


def _name(source: str) -> str:
    """Return a file's name and the place in it, without the folder."""
    return source.replace("\\", "/").rpartition("/")[2]


def _receipt(assignment_id: int, digest: str) -> str:
    """Return the code of a receipt: letters that are not mistaken for others, from a digest of the assignment
    and the content."""
    short = b32encode(sha256(f"{assignment_id}/{digest}".encode()).digest()).decode()[:12]
    return "-".join((short[:4], short[4:8], short[8:12]))
