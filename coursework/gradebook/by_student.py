"""Marks of one student whom a platform identifies: a sheet for each issued exercise."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from coursework.course.course import Course
from coursework.gradebook.class_marking import marked
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.notebooks import NO_NAME
from coursework.gradebook.placing import placed_sheets
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
from coursework.issuing.issued import Issued
from coursework.marking.marking import mark
from coursework.messages import Message, as_message, joined_notes, separate_notes


class OwnMarks(NamedTuple):
    """Marks of one student: a sheet for each exercise, without answers if nothing was submitted."""

    sheets: tuple[Graded, ...]
    rejected: tuple[Rejected, ...] = ()
    notes: tuple[str, ...] = ()  #: what is to be known and is not an error


def marks_of_student(
    course: Course, issued: Issued, student: str, rows: Iterable[AnswerRow | Rejected | PlatformFile]
) -> OwnMarks:
    """Return the marks of a student whom the platform identifies, whatever name the answers contain.

    The variant is the one that was issued to the student: answers that say they are of another are rejected.
    A stranger to the roster has the sheets of nothing.

    Raises
    ------
    CourseworkError
        The course cannot mark: no solutions, an exercise that the records do not fit.
    """
    notes: list[str] = []
    sheets = placed_sheets(course, issued, as_students(issued, student, rows, notes))
    by_exercise: dict[str, Graded] = {}
    for graded in marked(course, issued, sheets):
        by_exercise.setdefault(graded.exercise, graded)
    all_sheets = [by_exercise.get(e) or _blank(course, issued, student, e) for e in issued.exercises]
    return OwnMarks(tuple(all_sheets), tuple(sheets.rejected), (*notes, *sheets.warnings))


def as_students(
    issued: Issued, student: str, rows: Iterable[AnswerRow | Rejected | PlatformFile], notes: list[str]
) -> Iterator[AnswerRow | Rejected]:
    """Yield the rows under the student's name; add one note if they contain another name."""
    for row in rows:
        if isinstance(row, PlatformFile):
            continue
        if isinstance(row, Rejected):
            yield row
            continue
        named = issued.student(row.student) if issued.has_roster and row.student else None
        if (
            named not in (None, student)
            and (note := Message("the answers bear the name of {name}", name=named)) not in notes
        ):
            notes.append(note)
        warning = joined_notes(note for note in separate_notes(row.warning) if note != NO_NAME)
        yield row._replace(student=student, warning=warning, origin=None)


def _blank(course: Course, issued: Issued, student: str, exercise: str) -> Graded:
    """Return the marks of an empty sheet on the student's variant, or on the first variant if the student has
    none."""
    name = issued.student(student) or student
    seeds = issued.seeds_of(name, exercise) or [s for e, s in issued.records if e == exercise][:1]
    record = issued.record_of(name, exercise, seeds[-1])
    return Graded(name, exercise, seeds[-1], dict(mark(course[exercise].from_record(record), {})), (), record)


def for_student(reason: str) -> Message:
    """Return the reason for a rejection without the names of other parts, which may reveal questions."""
    message = as_message(reason)
    values = {n: for_student(v) if isinstance(v, Message) else v for n, v in message.values.items()}
    if "part" in values and "nearest" in values:
        values["nearest"] = ""
    return Message(message.template, **values)
