"""Notes of outdated aggregates, written in the transaction that changes their sources."""

from __future__ import annotations

from collections.abc import Iterable

from sqlalchemy import Connection, insert, select

from coursework.database.tables import assignment, dealt, outdated, variant

STUDENT, EVERYBODY, ROWS = "student", "everybody", "rows"


def outdate(connection: Connection, assignment_id: int, students: Iterable[str]) -> None:
    """Note that the marks, decisions or submissions of some students have changed."""
    noted = [
        {"assignment_id": assignment_id, "kind": STUDENT, "student": student}
        for student in dict.fromkeys(students)
    ]
    if noted:
        connection.execute(insert(outdated), noted)


def outdate_person(connection: Connection, assignment_id: int, person_id: int) -> None:
    """Note that the submissions or dates of one person have changed."""
    names = select(dealt.c.student).join(variant).where(variant.c.assignment_id == assignment_id)
    outdate(
        connection, assignment_id, connection.execute(names.where(dealt.c.person_id == person_id)).scalars()
    )


def outdate_all(connection: Connection, assignment_id: int) -> None:
    """Note a change that affects everybody: of papers, rules or roster."""
    connection.execute(insert(outdated).values(assignment_id=assignment_id, kind=EVERYBODY))
    outdate_rows(connection, assignment_id)


def outdate_rows(connection: Connection, assignment_id: int) -> None:
    """Note that the rows without a sheet may have changed."""
    connection.execute(insert(outdated).values(assignment_id=assignment_id, kind=ROWS))


def outdate_everything(connection: Connection) -> None:
    """Note every assignment, after a restoration without aggregates."""
    for number in connection.execute(select(assignment.c.id)).scalars().all():
        outdate_all(connection, number)
