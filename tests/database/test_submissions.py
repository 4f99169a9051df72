"""What came in is given back as it came, in its order; the same twice is one."""

from __future__ import annotations

import math
from datetime import timedelta

import pytest
from sqlalchemy import func, select
from stored_class import ANA, BEN, CAME, content, put, rows

import coursework
from coursework.database.marking import mark_new
from coursework.database.submissions import insert_submission, next_number, rows_of, submissions_of
from coursework.database.tables import answer, person
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, RowOrigin

ODD = RowOrigin((("Email", "a@b.c"), ("ID", "7")), ("ana", "x"), 2, "2026-01-02", "3", True)
CAME_ROWS = [
    Rejected("a.csv, line 2", "no student's name", {"student": "", "answer": "a\0b"}),
    AnswerRow(ANA, "crank_pin", "0", "x", "319,8 mm", "a.csv, line 3", "a.csv: odd encoding", "fr", ODD),
    PlatformFile("tree/", "an nbgrader tree", True),
    AnswerRow(ANA, "crank_pin", "", "y", None, "a.csv, line 4"),
    AnswerRow(ANA, "crank_pin", "0", "z", "l'é\0 " + "x" * 5000, "a.csv, line 5", origin=ODD),
    AnswerRow(ANA, "crank_pin", "0", "t", True, "a.csv, line 6"),
    AnswerRow(ANA, "crank_pin", "0", "u", 10**399, "a.csv, line 7"),
    AnswerRow(ANA, "crank_pin", "0", "v", 1e22, "a.csv, line 8"),
    AnswerRow(ANA, "crank_pin", "0", "w", math.inf, "a.csv, line 9"),
    AnswerRow(ANA, "crank_pin", "0", "w", 3 + 4j, "a.csv, line 10"),
    AnswerRow(ANA, "crank_pin", "0", "w", -0.0, "a.csv, line 11"),
    Rejected("b.xlsx", "a spreadsheet is not read"),
]


@pytest.fixture
def course(small_course):
    return coursework.open_course(small_course)


@pytest.fixture
def number(store, course):
    return put(store, content(course))


def keep(store, number, some, **more):
    with store.begin() as connection:
        return insert_submission(connection, number, some, **{"source": "a.csv", "received_at": CAME, **more})


def came(store, number, *which):
    with store.reading() as connection:
        return list(rows_of(connection, number, *which))


def test_rows_come_back_as_they_came_in_their_order(store, number):
    first = keep(store, number, CAME_ROWS)
    more = [AnswerRow(BEN, "crank_pin", "1", "x", "2", "b.csv, line 2"), CAME_ROWS[-1]]
    second = keep(store, number, more)
    assert came(store, number) == [*CAME_ROWS, *more]
    assert [type(row.answer) for row in came(store, number)[3:11] if isinstance(row, AnswerRow)] == [
        type(row.answer) for row in CAME_ROWS[3:11]
    ]
    assert came(store, number, second.id) == more
    assert came(store, number, first.id) == CAME_ROWS


def test_the_same_content_under_another_name_is_one_delivery(store, number):
    first = keep(store, number, CAME_ROWS)
    moved = [
        row._replace(source=f"other/{row.source}") if not isinstance(row, Rejected) else row
        for row in CAME_ROWS
    ]
    again = keep(store, number, moved, source="copy.csv", received_at=CAME + timedelta(1))
    assert (first.is_new, again.is_new) == (True, False)
    assert again == first._replace(is_new=False)
    assert came(store, number) == CAME_ROWS


def test_a_row_that_comes_again_is_given_once(store, number):
    """An export that grew holds what it held before, at other places."""
    keep(store, number, CAME_ROWS)
    grown = [
        *(row._replace(source="b.csv") if isinstance(row, AnswerRow) else row for row in CAME_ROWS[:6]),
        CAME_ROWS[3]._replace(answer="7", source="b.csv"),
    ]
    second = keep(store, number, grown)
    assert came(store, number) == [*CAME_ROWS, grown[2], grown[-1]]
    assert came(store, number, second.id) == grown


def test_a_row_twice_in_one_file_is_given_twice(store, number):
    twice = [CAME_ROWS[1], CAME_ROWS[1]._replace(source="a.csv, line 4")]
    keep(store, number, twice)
    assert came(store, number) == twice


def test_a_file_that_replaces_counts_instead_and_can_come_back(store, number):
    keep(store, number, CAME_ROWS[:2])
    keep(store, number, CAME_ROWS[3:5], source="b.csv")
    keep(store, number, CAME_ROWS[5:7], replaces=True)
    assert came(store, number) == [*CAME_ROWS[3:5], *CAME_ROWS[5:7]]
    assert not keep(store, number, CAME_ROWS[:2], replaces=True).is_new
    assert came(store, number) == [*CAME_ROWS[:2], *CAME_ROWS[3:5]]


@pytest.mark.parametrize(
    "changed",
    [
        CAME_ROWS[:-1],
        CAME_ROWS[::-1],
        [*CAME_ROWS[:1], CAME_ROWS[1]._replace(answer="319,9 mm"), *CAME_ROWS[2:]],
        [*CAME_ROWS[:1], CAME_ROWS[1]._replace(origin=ODD._replace(sitting=3)), *CAME_ROWS[2:]],
    ],
)
def test_other_content_is_another_delivery(store, number, changed):
    keep(store, number, CAME_ROWS)
    assert keep(store, number, changed).is_new


def test_two_files_that_name_nobody_are_two(store, number):
    nobody = [AnswerRow("", "crank_pin", "", "x", "1", "one.ipynb")]
    assert keep(store, number, nobody).is_new
    assert keep(store, number, [nobody[0]._replace(source="two.ipynb")]).is_new
    assert not keep(store, number, [nobody[0]._replace(source="folder/two.ipynb")]).is_new


def test_a_receipt_is_of_what_was_handed_in(store, number):
    one, two = keep(store, number, CAME_ROWS), keep(store, number, CAME_ROWS[:3])
    assert one.receipt != two.receipt
    assert all(len(part) == 4 for part in one.receipt.split("-"))


def test_tries_are_counted_on_the_site_and_elsewhere(store, number, course):
    with store.begin() as connection:
        who = connection.execute(select(person.c.id).where(person.c.name == ANA)).scalar()
        assert next_number(connection, number, who, ANA) == 1
        first = insert_submission(
            connection,
            number,
            rows(course, ANA, 0, 1),
            source="site",
            received_at=CAME,
            person_id=who,
            number=1,
            late=40,
        )
        assert next_number(connection, number, who, ANA) == 2
        assert submissions_of(connection, number, who) == [first._replace(is_new=False)]
        assert first.late == 40
        insert_submission(connection, number, rows(course, ANA, 0), source="paper.csv", received_at=CAME)
        assert next_number(connection, number, who, ANA) == 3
        insert_submission(connection, number, rows(course, ANA, 0, 4), source="moodle.csv", received_at=CAME)
        assert next_number(connection, number, who, ANA) == 6
        insert_submission(connection, number, rows(course, BEN, 0), source="paper.csv", received_at=CAME)
        found = {
            (row.student, row.origin.sitting if row.origin else 0) for row in rows_of(connection, number)
        }
    assert found == {
        (ANA, 1),
        (ANA, 2),
        (ANA, 5),
        (BEN, 0),
    }  # paper after a try on the site is a sitting of its own


def test_whose_a_file_is_hangs_on_no_spelling_where_tries_are_counted(store, number, course):
    with store.begin() as connection:
        who = connection.execute(select(person.c.id).where(person.c.name == ANA)).scalar()
        insert_submission(connection, number, rows(course, " ana", 0), source="paper.csv", received_at=CAME)
    mark_new(course, store, number)
    with store.begin() as connection:
        assert next_number(connection, number, who, ANA) == 2
        own = rows(course, ANA, 0, 2)
        insert_submission(connection, number, own, source="site", received_at=CAME, person_id=who, number=2)
        by_number = RowOrigin((("number", "100"),))
        late = [row._replace(student="A. N. A.", origin=by_number) for row in rows(course, ANA, 0)]
        insert_submission(connection, number, late, source="moodle.csv", received_at=CAME)
    assert {row.origin.sitting for row in came(store, number) if row.student == "A. N. A."} == {3}


def test_many_rows_are_kept(store, number):
    many = [AnswerRow(BEN, "crank_pin", "1", f"p{n}", n, f"a.csv, line {n}") for n in range(12_000)]
    keep(store, number, many)
    assert came(store, number) == many
    with store.reading() as connection:
        assert connection.execute(select(func.count()).select_from(answer)).scalar() == 12_000
