"""Summaries of classes: counts of an assignment and the table of its class, computed once for all processes
and stored with the state of everything on which they depend. A dump omits them, since they can be computed
again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from sqlalchemy import Connection, select

from coursework.course.course import Course
from coursework.database.instructor_queries import AssignmentOverview, Stamp
from coursework.database.states import page_state
from coursework.database.store import put_rows
from coursework.database.tables import class_summary, variant


class ClassCounts(NamedTuple):
    """Counts of a class."""

    students: int
    handed_in: int  #: students with a marked sheet
    waiting: int  #: answers and rows that wait for a person


def summary_states(
    connection: Connection,
    course: Course[Any],
    abouts: Sequence[AssignmentOverview],
    stamps: Mapping[int, Stamp],
) -> dict[int, str]:
    """Return the state of each assignment: a digest of everything on which its summary depends."""
    exercises: dict[int, list[str]] = {about.id: [] for about in abouts}
    query = select(variant.c.assignment_id, variant.c.exercise).where(variant.c.assignment_id.in_(exercises))
    for number, exercise in connection.execute(query.distinct()):
        exercises[number].append(exercise)
    return {
        about.id: page_state(
            course,
            sorted(exercises[about.id]),
            str(stamps[about.id]),
            about.columns,
            about.stated,
            about.published,
        )
        for about in abouts
    }


def stored_counts(connection: Connection, states: Mapping[int, str]) -> dict[int, ClassCounts]:
    """Return the stored counts of the assignments whose summary is of exactly their state."""
    columns = class_summary.c
    query = select(columns.assignment_id, columns.students, columns.handed_in, columns.waiting)
    current = columns.state.in_(states.values()), columns.assignment_id.in_(states)
    return {row[0]: ClassCounts(*row[1:]) for row in connection.execute(query.where(*current))}


def stored_tables(connection: Connection, states: Mapping[int, str]) -> dict[int, tuple[ClassCounts, str]]:
    """Return the stored counts and tables of the assignments whose summary is of exactly their state."""
    columns = class_summary.c
    query = select(
        columns.assignment_id, columns.students, columns.handed_in, columns.waiting, columns.content
    )
    current = columns.state.in_(states.values()), columns.assignment_id.in_(states)
    rows = connection.execute(query.where(*current))
    return {row.assignment_id: (ClassCounts(*row[1:4]), row.content) for row in rows}


def put_summary(connection: Connection, number: int, state: str, counts: ClassCounts, content: str) -> None:
    """Store the summary of an assignment, in place of that of another state."""
    row = {"assignment_id": number, "state": state, **counts._asdict(), "content": content}
    put_rows(connection, class_summary, [row], ("assignment_id",))
