"""A class of the small course in a database: what was issued, rows of answers, and what plain marking gives
of them."""

from __future__ import annotations

from datetime import UTC, datetime

from small_assignment import STATED, item

from coursework.database.assignments import put_issued
from coursework.database.submissions import insert_submission
from coursework.gradebook.rows import AnswerRow, RowOrigin

CAME = datetime(2026, 11, 23, 9, tzinfo=UTC)
ANA, BEN, CLEO = STUDENTS = ("Ana", "Ben", "Cléo")


def content(course, students=STUDENTS, **stated):
    """What ``issued.json`` says: a variant of ``crank_pin`` for each."""
    return {
        "format": 1,
        "roster": True,
        "assignment": {**STATED, **stated},
        "students": {name: {"number": str(100 + n)} for n, name in enumerate(students)},
        "issued": [item(course, name, n) for n, name in enumerate(students)],
    }


def rows(course, student, seed, sitting=0, written=True, **changed):
    """Answers to a variant, right but those that are changed."""
    solution = {**course["crank_pin"].variant(seed, "en").solution(), **changed}
    origin = RowOrigin(sitting=sitting, submitted=f"2026-11-23T09:0{sitting}:00") if sitting else None
    shown = str(seed) if written else ""
    return [
        AnswerRow(
            student,
            "crank_pin",
            shown,
            part,
            value if isinstance(value, str) else f"{value:.8g}",
            f"{student}.csv, line {n}",
            origin=origin,
        )
        for n, (part, value) in enumerate(solution.items(), start=2)
    ]


def put(store, content_, *submissions, source="answers.csv"):
    """An assignment with submissions; its id."""
    with store.begin() as connection:
        number = put_issued(connection, content_)
        for some in submissions:
            insert_submission(connection, number, some, source=source, received_at=CAME)
    return number
