"""Summary of a database, one line per assignment."""

from __future__ import annotations

from typing import Any, NamedTuple

from sqlalchemy import Connection, Select, distinct, func, select

from coursework.database.assignments import names
from coursework.database.current_marks import answers_waiting
from coursework.database.tables import answer, decision, issue, marking, submission, variant


class Summary(NamedTuple):
    """Progress of an assignment, in counts."""

    assignment: str
    students: int  #: with a variant of their own
    variants: int
    submissions: int
    answers: int
    sheets: int  #: marked
    markings: int  #: of sheets, with those that others took the place of
    decisions: int
    waiting: int  #: answers for a person


def summaries(connection: Connection) -> list[Summary]:
    """Return the summaries of the assignments, in the order in which they were added."""
    return [_summary(connection, name, number) for name, number in names(connection).items()]


def _summary(connection: Connection, name: str, number: int) -> Summary:
    def count(counted: Select[Any]) -> int:
        return int(connection.execute(counted).scalar() or 0)

    issued = variant.c.assignment_id == number
    query = select(func.count(distinct(issue.c.student))).select_from(issue.join(variant))
    answered = (
        select(func.count()).select_from(answer.join(submission)).where(submission.c.assignment_id == number)
    )
    sheet = (marking.c.student, marking.c.exercise, marking.c.seed, marking.c.attempt)
    sheets = select(*sheet).where(marking.c.assignment_id == number).distinct().subquery()
    return Summary(
        name,
        count(query.where(issued, issue.c.student != "")),
        count(select(func.count()).select_from(variant).where(issued)),
        count(select(func.count()).select_from(submission).where(submission.c.assignment_id == number)),
        count(answered),
        count(select(func.count()).select_from(sheets)),
        count(select(func.count()).select_from(marking).where(marking.c.assignment_id == number)),
        count(select(func.count()).select_from(decision).where(decision.c.assignment_id == number)),
        answers_waiting(connection, number),
    )
