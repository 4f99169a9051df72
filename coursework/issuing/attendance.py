"""Lists of an exam, from what was issued: attendance by room, rooms and seats, and a table to fill in."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from coursework.errors import counted, first_few
from coursework.issuing.exam_columns import cell, extra_time_of, group_of, room_of, seat_of
from coursework.issuing.identity import NUMBER
from coursework.issuing.papers import IssuedPaper, natural
from coursework.issuing.roster import Student
from coursework.issuing.students import folded
from coursework.messages import Message
from coursework.rendering.renderer import Renderer
from coursework.sheets.attendance import ExamLists, ListedStudent, RoomList
from coursework.system.tables import Spreadsheet, csv_file
from coursework.system.writing import File

_LISTED = 5  #: names that a note lists


def exam_lists(issued_papers: Sequence[IssuedPaper], lang: str) -> ExamLists:
    """Return the lists of an exam: rooms in their order, and in each the students by seat, else as on the
    roster."""
    rooms: dict[str, list[ListedStudent]] = {}
    for issued_paper in _by_student(issued_papers):
        student = _listed(issued_paper, lang)
        rooms.setdefault(student.room, []).append(student)
    return ExamLists(
        issued_papers[0].heading(lang),
        tuple(
            RoomList(room, tuple(sorted(rooms[room], key=lambda student: natural(student.seat))))
            for room in sorted(rooms, key=natural)
        ),
    )


def _by_student(issued_papers: Sequence[IssuedPaper]) -> list[IssuedPaper]:
    """Return the latest paper of each student; papers without a name are on no list."""
    return list({paper.first.student: paper for paper in issued_papers if paper.first.student}.values())


def _listed(issued_paper: IssuedPaper, lang: str) -> ListedStudent:
    issue, columns = issued_paper.first, issued_paper.first.columns
    return ListedStudent(
        name=issue.student,
        room=room_of(columns),
        seat=seat_of(columns),
        number=cell(columns, NUMBER),
        group=group_of(columns),
        code=issue.code,
        version=issue.version,
        time=_extra(issued_paper, lang),
    )


def _extra(issued_paper: IssuedPaper, lang: str) -> str:
    """Return the time of a student who has extra time, as printed; "" for any other."""
    share = extra_time_of(issued_paper.first.columns)
    if not share:
        return ""
    duration = issued_paper.duration(lang)
    return duration if duration != issued_paper.usual_duration(lang) else f"+ {share}"


def list_files(
    renderer: Renderer, issued_papers: Sequence[IssuedPaper], langs: Sequence[str], spreadsheet: Spreadsheet
) -> Iterator[File]:
    """Yield the lists of an exam for the staff, and the table of attendance to fill in; nothing without a
    roster."""
    if not _by_student(issued_papers):
        return
    folder = Path("instructor")
    for lang in langs:
        for name, public in (("attendance", False), ("seats", True)):
            make: Callable[[], bytes] = partial(_printed, renderer, issued_papers, lang, public=public)
            yield File(folder / f"{name}.{lang}.pdf", make)
    rows = [*table_rows(issued_papers, langs[0])]
    columns = [name for name in rows[0] if name in ("student", "present") or any(row[name] for row in rows)]
    yield File(Path("attendance.csv"), lambda: csv_file(rows, columns, spreadsheet))


def _printed(renderer: Renderer, issued_papers: Sequence[IssuedPaper], lang: str, *, public: bool) -> bytes:
    return renderer.attendance_pdf(exam_lists(issued_papers, lang), public=public)


def seating_faults(students: Sequence[Student]) -> Iterator[Message]:
    """Yield a note on each seat that two students have, and on students without a room where others have
    one."""
    seats: dict[tuple[str, str], list[str]] = {}
    for student in students:
        if seat := seat_of(student.columns):
            seats.setdefault((room_of(student.columns), folded(seat)), []).append(student.name)
    for (room, seat), names in seats.items():
        if len(names) > 1:
            yield Message(
                "the roster gives the seat {seat} to {count}: {names}",
                seat=" ".join(filter(None, (room, seat.upper()))),
                count=counted(len(names), "student"),
                names=first_few(names, _LISTED),
            )
    without = [student.name for student in students if not room_of(student.columns)]
    if without and len(without) < len(students):
        yield Message(
            "{count} without a room: {names}",
            count=counted(len(without), "student"),
            names=first_few(without, _LISTED),
        )


def table_rows(issued_papers: Sequence[IssuedPaper], lang: str) -> Iterator[Mapping[str, Any]]:
    """Yield the rows of ``attendance.csv``, in the order of the lists; ``present`` is to be filled in."""
    for room in exam_lists(issued_papers, lang).rooms:
        for student in room.students:
            yield {
                "student": student.name,
                "code": student.code,
                "number": student.number,
                "group": student.group,
                "room": student.room,
                "seat": student.seat,
                "present": "",
            }
