"""Current marks: the last marking of each sheet, with the decisions of people."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from sqlalchemy import Connection, Select, func, select

from coursework.course.course import Course
from coursework.database.assignments import issued_of
from coursework.database.decisions import read_decisions
from coursework.database.tables import mark, marking
from coursework.gradebook.adjustments import Adjustments, no_margins
from coursework.gradebook.decisions import TO_MARK
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import SheetKey
from coursework.gradebook.waiting import margins_of
from coursework.issuing.issued import Issued
from coursework.marking.mark import Mark

_SHEET = (marking.c.student, marking.c.exercise, marking.c.seed, marking.c.attempt)
_LINE = (
    mark.c.part,
    mark.c.answer,
    mark.c.read_as,
    mark.c.verdict,
    mark.c.points,
    mark.c.out_of,
    mark.c.lang,
    mark.c.matches,
    mark.c.in_other_order,
    mark.c.says,
    mark.c.feedback,
)
_MATCHES = _LINE.index(mark.c.matches)
_CHUNK = 5000  #: sheets that are read at once


class LastMarking(NamedTuple):
    """Last marking of a sheet."""

    id: int
    key: SheetKey
    sitting: int
    state: str
    lang: str
    apart: bool
    submitted: str
    fault: str  #: why it could not be marked


def last_markings(
    connection: Connection, assignment_id: int, student: str | None = None
) -> dict[SheetKey, LastMarking]:
    """Return the last marking of each sheet, in the order of the first marking of each; including sheets
    without any current answer."""
    last = _last(assignment_id, student).subquery()
    query = select(marking).join(last, marking.c.id == last.c.last).order_by(last.c.first)
    rows = connection.execute(query)
    return {sheet.key: sheet for sheet in map(_last_marking, rows)}


def _last(assignment_id: int, student: str | None) -> Select[Any]:
    first, last = func.min(marking.c.id).label("first"), func.max(marking.c.id).label("last")
    query = select(first, last).where(marking.c.assignment_id == assignment_id).group_by(*_SHEET)
    if student is None:
        return query
    return query.where(marking.c.student == student)


def _last_marking(row: Any) -> LastMarking:
    key = row.student, row.exercise, int(row.seed), row.attempt
    return LastMarking(row.id, key, row.sitting, row.state, row.lang, row.apart, row.submitted, row.fault)


class _SheetMarks(NamedTuple):
    """Marks of a sheet, and its answered parts in their order."""

    marks: Mapping[str, Mark]
    answered: tuple[str, ...]


def lines_of(connection: Connection, sheets: Iterable[LastMarking]) -> dict[int, _SheetMarks]:
    """Return the marks of sheets, by the marking's id."""
    ids = [sheet.id for sheet in sheets]
    marks: dict[int, dict[str, Mark]] = {}
    order: dict[int, list[tuple[int, str]]] = {}
    for start in range(0, len(ids), _CHUNK):
        some = mark.c.marking_id.in_(ids[start : start + _CHUNK])
        query = select(mark.c.marking_id, mark.c.received_place, *_LINE).where(some)
        for number, position, *sent in connection.execute(query.order_by(mark.c.marking_id, mark.c.place)):
            line = _line(sent)
            marks.setdefault(number, {})[line.part] = line
            if position is not None:
                order.setdefault(number, []).append((position, line.part))
    return {
        number: _SheetMarks(sheet_marks, tuple(part for _, part in sorted(order.get(number, ()))))
        for number, sheet_marks in marks.items()
    }


def _line(sent: Sequence[Any]) -> Mark:
    """Return a mark from its columns."""
    return Mark(*sent)._replace(matches=tuple(sent[_MATCHES]))


def machine_marks(
    issued: Issued, sheets: Iterable[LastMarking], lines: Mapping[int, _SheetMarks]
) -> Iterator[tuple[SheetKey, Graded | str]]:
    """Yield each sheet as marked by the machine, or the reason for which it cannot be marked; skip sheets
    without any current answer."""
    for sheet in sheets:
        if sheet.fault:
            yield sheet.key, sheet.fault
        elif sheet.state:
            yield sheet.key, _graded(issued, sheet, lines[sheet.id])


def _graded(issued: Issued, sheet: LastMarking, lines: _SheetMarks) -> Graded:
    record = issued.record_of(*sheet.key[:3])
    if sheet.apart:
        record = {**record, "parts": [p for p in record["parts"] if p["id"] in lines.marks]}
    if sheet.lang != str(record.get("lang", "")):
        record = {**record, "lang": sheet.lang}
    graded = Graded(*sheet.key[:3], lines.marks, lines.answered, record, sitting=sheet.sitting)
    return graded._replace(submitted=sheet.submitted, apart=sheet.apart)


def adjusted_sheets(
    connection: Connection, assignment_id: int, student: str | None = None, course: Course | None = None
) -> tuple[Issued, Adjustments, list[Graded]]:
    """Return what was issued to a class, or to a student, the adjustments, and the current sheets with the
    decisions and adjustments applied; wider margins where the ``course`` is given."""
    sheets = last_markings(connection, assignment_id, student)
    decisions = read_decisions(connection, assignment_id, student)
    issued = issued_of(connection, assignment_id, student=student)
    results = machine_marks(issued, sheets.values(), lines_of(connection, sheets.values()))
    sheets_now = [decisions.apply(result) for _, result in results if not isinstance(result, str)]
    margins = no_margins if course is None else margins_of(course, issued)
    return issued, decisions.adjustments, decisions.adjustments.applied(sheets_now, issued, margins)


def answers_waiting(connection: Connection, assignment_id: int) -> int:
    """Return the number of answers that wait for a person: unreadable, or to be marked by hand, and not
    decided."""
    last = _last(assignment_id, None).subquery()
    query = select(marking, *_LINE).join(mark).join(last, marking.c.id == last.c.last)
    decisions = read_decisions(connection, assignment_id)
    rows = connection.execute(query.where(mark.c.verdict.in_((TO_MARK, "unreadable"))))
    lines = ((_last_marking(row), _line(row[len(marking.c) :])) for row in rows)
    return sum(next(decisions.counting(sheet.key[:3], line), None) is None for sheet, line in lines)
