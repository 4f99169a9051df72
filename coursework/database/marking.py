"""Marking of changed sheets: those whose answers, record, rules, course or engine differ from those of their
last marking."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import nullcontext
from datetime import UTC, datetime
from typing import Any, NamedTuple

from sqlalchemy import Connection, insert, select

from coursework.course.course import Course
from coursework.database.assignments import issued_of
from coursework.database.current_marks import LastMarking, last_markings, lines_of, machine_marks
from coursework.database.decisions import read_decisions
from coursework.database.states import exercise_state, sheet_state
from coursework.database.store import Store
from coursework.database.submissions import rows_of
from coursework.database.tables import assignment, mark, marking, submission
from coursework.errors import BadInput
from coursework.gradebook.book import marks_rows
from coursework.gradebook.class_marking import judged, record_of, rules_of
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import SheetKey, Sheets, placed_sheets
from coursework.issuing.issued import Issued

_CHUNK = 5000  #: rows that are written at once

Judged = tuple[SheetKey, Graded | str]


class Change(NamedTuple):
    """Change of a mark."""

    student: str
    exercise: str
    seed: int
    sitting: int
    part: str
    answer: str
    verdict_before: str  #: empty where there was none
    verdict_now: str
    points_before: str  #: as tables print them
    points_now: str

    def row(self) -> dict[str, Any]:
        """Return a line of ``changes.csv``."""
        return self._asdict()


class MarkedNow(NamedTuple):
    """Result of a marking run."""

    sheets: int  #: how many are answered
    marked: int  #: how many of them were marked now
    new: int  #: how many of these for the first time
    changes: tuple[Change, ...]  #: marks that are not what they were, of sheets that were marked before


class Work:
    """Sheets of an assignment, or of one submission, with their last markings."""

    def __init__(
        self,
        course: Course,
        store: Store,
        assignment_id: int,
        submission_id: int | None = None,
        within: Connection | None = None,
    ):
        self.course, self.store, self.assignment_id = course, store, assignment_id
        self.now: dict[SheetKey, Graded | str] = {}
        with nullcontext(within) if within is not None else store.reading() as connection:
            self._read(connection, submission_id)

    def _read(self, connection: Connection, submission_id: int | None) -> None:
        course, assignment_id = self.course, self.assignment_id
        person_id = None if submission_id is None else _person_of(connection, submission_id)
        self.issued: Issued = issued_of(connection, assignment_id, person_id)
        for exercise in self.issued.exercises:
            exercise_state(course, exercise)  # before it is loaded
        only = submission_id if person_id is not None else None
        rows = list(rows_of(connection, assignment_id, only))
        self.sheets: Sheets = placed_sheets(course, self.issued, rows)
        self.places: Collection[SheetKey] = self.sheets.sheets
        if submission_id is not None and person_id is None:
            own_sheets = placed_sheets(
                course,
                issued_of(connection, assignment_id),
                rows_of(connection, assignment_id, submission_id),
            )
            self.places = [sheet for sheet in self.sheets.sheets if sheet in own_sheets.sheets]
        students = {sheet[0] for sheet in self.places}
        student = self._student = students.pop() if len(students) == 1 and submission_id is not None else None
        self.last: dict[SheetKey, LastMarking] = last_markings(connection, assignment_id, student)
        self.decisions = read_decisions(connection, assignment_id, student)
        self.is_whole = submission_id is None
        rules = rules_of(course, self.issued)
        self.states = {sheet: self._state(sheet, rules) for sheet in self.places}

    def _state(self, sheet: SheetKey, rules: Any) -> str:
        sheets = self.sheets
        record = record_of(self.issued, sheets, sheet)
        answers = {part: row.answer for part, row in sheets.sheets[sheet].items()}
        return sheet_state(
            self.course, rules, record, answers, sheet in sheets.apart, sheets.submitted.get(sheet, "")
        )

    @property
    def changed(self) -> list[SheetKey]:
        """Sheets whose state differs from that of their last marking."""
        return [p for p in self.places if p not in self.last or self.last[p].state != self.states[p]]

    @property
    def gone(self) -> list[LastMarking]:
        """Last markings of sheets that have no answer any more."""
        if not self.is_whole:
            return []
        return [last for sheet, last in self.last.items() if last.state and sheet not in self.sheets.sheets]

    def mark(self) -> None:
        """Mark the changed sheets."""
        places = self.changed
        self.now = dict(judged(self.course, self.issued, _only(self.sheets, places))) if places else {}

    def results(self) -> Iterator[Judged]:
        """Yield each sheet with its current marks."""
        places = self.sheets.sheets
        before = self._before(self.last[p] for p in places if p not in self.now and p in self.last)
        for sheet in self.sheets.sheets:
            if sheet in self.now or sheet in before:
                yield sheet, self.now[sheet] if sheet in self.now else before[sheet]

    def changes(self) -> Iterator[Change]:
        """Yield the changed marks of sheets that were marked before, with the decisions applied on both
        sides."""
        marked = [self.last[sheet] for sheet in self.now if sheet in self.last]
        for sheet, was in self._before([*marked, *self.gone]).items():
            yield from _changes(self._rows(was), self._rows(self.now.get(sheet, "")))

    def _before(self, sheets: Iterable[LastMarking]) -> dict[SheetKey, Graded | str]:
        """Return the sheets as they were marked before."""
        sheets = list(sheets)
        with self.store.reading() as connection:
            lines = lines_of(connection, sheets)
        return dict(machine_marks(self.issued, sheets, lines))

    def _rows(self, result: Graded | str) -> dict[str, Mapping[str, Any]]:
        """Return the lines of a sheet in a table of marks, by part."""
        if isinstance(result, str):
            return {}
        return {row["part"]: row for row in marks_rows(self.decisions.apply(result))}

    def summary(self) -> MarkedNow:
        new = sum(sheet not in self.last for sheet in self.now)
        return MarkedNow(len(self.places), len(self.now), new, tuple(self.changes()))

    def write(self, connection: Connection) -> None:
        """Store the new marks, except for sheets that another process has marked meanwhile."""
        now = last_markings(connection, self.assignment_id, self._student)
        met = {sheet: last.id for sheet, last in now.items()}
        free = [p for p in self.now if met.get(p) == (self.last[p].id if p in self.last else None)]
        gone = [last for last in self.gone if met.get(last.key) == last.id]
        marked_at = datetime.now(UTC)
        rows = [_marking(self, sheet, marked_at) for sheet in free]
        rows += [
            {
                **_sheet_columns(self.assignment_id, last.key),
                "sitting": last.sitting,
                "state": "",
                "made": marked_at,
                **_EMPTY_COLUMNS,
            }
            for last in gone
        ]
        for start in range(0, len(rows), _CHUNK):
            adding = insert(marking).returning(marking.c.id, sort_by_parameter_order=True)
            ids = connection.execute(adding, rows[start : start + _CHUNK]).scalars().all()
            places = free[start : start + _CHUNK]
            lines = [
                line
                for number, sheet in zip(ids, places, strict=False)
                for line in _marks(number, self.now[sheet])
            ]
            for first in range(0, len(lines), _CHUNK):
                connection.execute(insert(mark), lines[first : first + _CHUNK])


# ---------------------------------------------------------------------- marking


def mark_new(course: Course, store: Store, assignment_id: int) -> MarkedNow:
    """Mark every sheet whose state changed: its record, its answers, the rules, the files of its exercise,
    the engine.

    Raises
    ------
    CourseworkError
        The course cannot mark what was issued.
    """
    return mark_changed(course, store, assignment_id).summary()


def mark_submission(course: Course, store: Store, submission_id: int) -> MarkedNow:
    """Mark the changed sheets of one submission.

    Raises
    ------
    BadInput
        There is no such submission.
    CourseworkError
        The course cannot mark the issued exercises.
    """
    with store.reading() as connection:
        query = select(submission.c.assignment_id).where(submission.c.id == submission_id)
        assignment_id = connection.execute(query).scalar()
    if assignment_id is None:
        raise BadInput("no submission number {number} in the database", number=submission_id)
    return mark_changed(course, store, assignment_id, submission_id).summary()


def would_change(course: Course, store: Store, assignment_id: int) -> MarkedNow:
    """Return the result that :func:`mark_new` would have; write nothing."""
    work = Work(course, store, assignment_id)
    work.mark()
    return work.summary()


def mark_changed(course: Course, store: Store, assignment_id: int, submission_id: int | None = None) -> Work:
    """Mark the changed sheets of an assignment, or of a submission; store their marks, and return the work
    with all sheets."""
    return mark_and_store(Work(course, store, assignment_id, submission_id))


def mark_and_store(work: Work) -> Work:
    """Mark the changed sheets of a work, and store their marks; return it."""
    work.mark()
    if work.now or work.gone:
        with work.store.begin() as connection:
            row = select(assignment.c.id).where(assignment.c.id == work.assignment_id)
            connection.execute(row.with_for_update(key_share=True))
            work.write(connection)
    return work


def _person_of(connection: Connection, submission_id: int) -> int | None:
    return connection.execute(select(submission.c.person_id).where(submission.c.id == submission_id)).scalar()


def _only(sheets: Sheets, places: Iterable[SheetKey]) -> Sheets:
    """Return some of the sheets alone."""
    selected = {sheet: sheets.sheets[sheet] for sheet in places}
    return Sheets(selected, langs=sheets.langs, submitted=sheets.submitted, apart=sheets.apart)


# ---------------------------------------------------------------------- changes


def _changes(
    before: Mapping[str, Mapping[str, Any]], now: Mapping[str, Mapping[str, Any]]
) -> Iterator[Change]:
    for part in dict.fromkeys((*before, *now)):
        row = now.get(part) or before[part]
        was, is_now = (_verdict(rows.get(part)) for rows in (before, now))
        if was != is_now:
            key = row["student"], row["exercise"], row["seed"], row["sitting"], part, row["answer"]
            yield Change(*key, was[0], is_now[0], was[1], is_now[1])


def _verdict(row: Mapping[str, Any] | None) -> tuple[str, str]:
    return ("", "") if row is None else (row["verdict"], row["points"])


# ------------------------------------------------------------------------- rows

_EMPTY_COLUMNS = {"lang": "", "apart": False, "submitted": "", "fault": ""}


def _sheet_columns(assignment_id: int, sheet: SheetKey) -> dict[str, Any]:
    student, exercise, seed, attempt = sheet
    named = {"student": student, "exercise": exercise, "seed": str(seed), "attempt": attempt}
    return {"assignment_id": assignment_id, **named}


def _marking(work: Work, sheet: SheetKey, marked_at: datetime) -> dict[str, Any]:
    result = work.now[sheet]
    columns = {
        "sitting": sheet[3] or work.issued.sitting_of(*sheet[:3]),
        "lang": str(record_of(work.issued, work.sheets, sheet).get("lang", "")),
        "apart": sheet in work.sheets.apart,
        "submitted": work.sheets.submitted.get(sheet, ""),
        "fault": result if isinstance(result, str) else "",
    }
    return {
        **_sheet_columns(work.assignment_id, sheet),
        "state": work.states[sheet],
        "made": marked_at,
        **columns,
    }


def _marks(number: int, result: Graded | str) -> Iterator[dict[str, Any]]:
    if isinstance(result, str):
        return
    order: dict[str, int] = {part: position for position, part in enumerate(result.answered)}
    for position, line in enumerate(result.lines.values()):
        yield {
            "marking_id": number,
            "place": position,
            "received_place": order.get(line.part),
            **line._asdict(),
            "matches": list(line.matches),
        }
