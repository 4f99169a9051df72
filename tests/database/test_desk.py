"""What the desk asks of a database of either kind."""

from datetime import UTC, datetime, timedelta

import pytest

from coursework import open_course
from coursework.database.assignments import put_issued
from coursework.database.decisions import decide
from coursework.database.instructor_queries import (
    Placing,
    Stamp,
    decided_since,
    drop_placing,
    listed_assignments,
    people_of,
    placings,
    practised,
    put_placing,
    site_submissions_of,
    stamp,
    students_since,
    undoable,
)
from coursework.database.marking import mark_new
from coursework.database.progress import PersonProgress
from coursework.database.submissions import insert_submission, submissions_of_student
from coursework.gradebook.decisions import Decision
from coursework.gradebook.rows import AnswerRow, RowOrigin

AT = datetime(2026, 11, 23, 9, tzinfo=UTC)
EXERCISE = "slotted_mechanism"


@pytest.fixture
def number(store):
    """An assignment of two students, of whom Ada handed in twice, the second time late."""
    course = open_course()
    record = course[EXERCISE].variant(42, "en").record
    content = {
        "format": 1,
        "roster": True,
        "assignment": {"name": "week3", "exercises": [EXERCISE]},
        "issued": [{"student": name, "record": record} for name in ("Ada", "Bo")],
    }
    with store.begin() as connection:
        found = put_issued(connection, content)
        person = people_of(connection, found)["Ada"]
        for n in (1, 2):
            rows = [AnswerRow("Ada", EXERCISE, "42", "rA", f"? {n}", "the site", origin=RowOrigin(sitting=n))]
            late = 60 if n == 2 else 0
            at = AT + timedelta(hours=n)
            insert_submission(
                connection, found, rows, source="site", received_at=at, person_id=person, number=n, late=late
            )
    mark_new(course, store, found)
    return found


def decided(store, number, kind, by, points=None):
    with store.begin() as connection:
        decide(connection, number, [Decision("Ada", EXERCISE, "42", "rA", kind, points, "", "? 2", by)])


def test_a_stamp_changes_with_what_is_added_and_says_whose_it_is(store, number):
    with store.reading() as connection:
        before = stamp(connection, number)
        assert Stamp.read(str(before)) == before
        assert before.submissions[0] == 2
    decided(store, number, "accepted", "Emmy")
    with store.reading() as connection:
        assert stamp(connection, number) != before
        assert "Ada" in students_since(connection, number, before)
        assert [one.by for one in decided_since(connection, number, before.decisions[1])] == ["Emmy"]


def test_who_came_when_and_how_late(store, number):
    with store.reading() as connection:
        own = site_submissions_of(connection, number)["Ada"]
        assert (own.attempts, own.late, own.last) == (2, 60, AT + timedelta(hours=2))
        assert [one.number for one in submissions_of_student(connection, number, "Ada")] == [1, 2]
        (about,) = listed_assignments(connection, number)
        assert (about.name, about.submissions, about.last) == ("week3", 2, AT + timedelta(hours=2))
        assert set(site_submissions_of(connection, number)) == {"Ada"}


def test_what_can_be_undone_is_ones_own_and_the_last(store, number):
    decided(store, number, "accepted", "Emmy")
    decided(store, number, "given", "Grace", 0.5)
    with store.reading() as connection:
        assert [one.kind for one in undoable(connection, number, "Grace")] == ["given"]
        assert undoable(connection, number, "Emmy") == []


def test_a_row_that_is_put_aside_may_wait_again(store, number):
    with store.begin() as connection:
        put_placing(connection, number, Placing("digest", None, "empty", "Emmy", AT))
    with store.begin() as connection:
        assert placings(connection, number)["digest"].by == "Emmy"
        drop_placing(connection, number, "digest")
        assert placings(connection, number) == {}


def test_of_practice_the_desk_sees_how_often_and_when(store, number):
    with store.reading() as connection:
        person = people_of(connection, number)["Ada"]
    entry = {
        "exercise": EXERCISE,
        "part": "rA",
        "what": "answer",
        "answer": "12",
        "at": "2026-11-23T08:00:00+00:00",
    }
    PersonProgress(store, person).add([{**entry, "seed": 5}, {**entry, "seed": 6}])
    with store.reading() as connection:
        told = practised(connection, person, [EXERCISE, "grashof"])
    assert told == {EXERCISE: (2, datetime(2026, 11, 23, 8, tzinfo=UTC))}
