"""Aggregates of the desk are what the tables themselves come to, whatever was done in whatever order."""

from __future__ import annotations

import random
from collections import Counter
from datetime import UTC, datetime, timedelta

import pytest
from alembic import command
from alembic.config import Config
from sqlalchemy import inspect
from stored_class import content

import coursework
from coursework.database.aggregates import outstanding, refresh
from coursework.database.assignments import put_issued
from coursework.database.class_state import read_class
from coursework.database.class_tables import (
    PAGE,
    CardQueue,
    Filter,
    Scope,
    TableRequest,
    outline,
    rows_page,
    students_page,
    totals,
)
from coursework.database.decisions import KINDS, DecidedAnswer, decide
from coursework.database.dump import dump, restore
from coursework.database.erasing import erase
from coursework.database.instructor_queries import Placing, listed_assignments, put_placing
from coursework.database.marking import mark_new, mark_submission
from coursework.database.publication import (
    CHARGE,
    Extension,
    Publication,
    extend,
    publish,
    set_counting_attempt,
)
from coursework.database.store import _MIGRATIONS, Store
from coursework.database.submissions import insert_submission
from coursework.database.tables import METADATA
from coursework.gradebook.book import summary_rows
from coursework.gradebook.rows import AnswerRow, Rejected, RowOrigin

AT = datetime(2026, 3, 1, 12, tzinfo=UTC)
DERIVED = [table.name for table in METADATA.tables.values() if table.info.get("derived")]
NAMES = ("Ana", "Ben", "Cléo", "Dan O'Neil", "Eve", "Fay")


def whole(store, course, number):
    with store.reading() as connection:
        return read_class(connection, course, listed_assignments(connection, number)[0])


def differences(store, course, number):
    """What the aggregates say, and what the class comes to when all of it is read."""
    refresh(course, store, number)
    now = whole(store, course, number)
    with store.reading() as connection:
        assert not outstanding(connection, number)
        order = list(outline(connection, number).worth)
        page = students_page(connection, number, TableRequest())
        total = totals(connection, number)[number]
        queue = CardQueue(connection, number, now.questions)
        cards = queue.page(Filter(), 0)
        asked_for = queue.page(Filter(why="just"), 0)
        rows, count = rows_page(connection, number)
        everyone = {
            one.id: sorted(row.student for row in queue.members([one.id], open_only=True)) for one in cards
        }
        done = queue.done()
    told = {row.student: row for row in page.rows}
    summary = {row["student"]: row for row in summary_rows(now.book)}
    has = {
        "questions": set(order),
        "students": list(told),
        "points": {name: f"{row.points:g}" for name, row in told.items()},
        "out_of": {name: f"{row.out_of:g}" for name, row in told.items()},
        "late": {name: f"{row.charged:g}" for name, row in told.items()},
        "mark": {name: row.mark for name, row in told.items()},
        "verdicts": {name: Counter(row.verdicts) for name, row in told.items()},
        "exercises": {name: row.by_exercise for name, row in told.items()},
        "sitting": {name: row.sitting for name, row in told.items()},
        "handed in": {name for name, row in told.items() if row.answered},
        "cards": [(one.id, one.why, one.open) for one in cards + asked_for],
        "members": everyone,
        "waiting": total.waiting + total.rows,
        "of nobody": total.of_nobody,
        "rows": Counter((one.row, one.student, one.near, one.reason) for one in rows),
        "count": (count, total.students, total.answered),
        "done": done,
    }
    opened = [one for one in now.open.values() if one.why != "just"]
    just = [one for one in now.open.values() if one.why == "just"]
    should = {
        "questions": set(now.questions),
        "students": list(now.results),
        "points": {name: row["points"] for name, row in summary.items()},
        "out_of": {name: row["out_of"] for name, row in summary.items()},
        "late": {name: row["late"] for name, row in summary.items()},
        "mark": {name: row["mark"] for name, row in summary.items()},
        "verdicts": {name: +Counter(one.verdicts) for name, one in now.results.items()},
        "exercises": {name: dict(one.by_exercise) for name, one in now.results.items()},
        "sitting": {name: one.sitting for name, one in now.results.items()},
        "handed in": {one.student for one in now.machine.values()},
        "cards": [(one.group.id, one.why, len(one.members)) for one in opened + just],
        "members": {one.group.id: sorted(w.student for w in one.members) for one in opened},
        "waiting": now.waiting,
        "of nobody": now.of_nobody,
        "rows": Counter((one.id, one.student, one.near, one.row.reason) for one in now.rejected),
        "count": (len(now.rejected), len(now.results), len({one.student for one in now.machine.values()})),
        "done": sum(now.is_decided(one) for group in now.groups for one in group.members),
    }
    return {key: (has[key], should[key]) for key in has if has[key] != should[key]}


class Life:
    """A class to which anything happens."""

    def __init__(self, store, course, seed):
        self.store, self.course, self.random = store, course, random.Random(seed)
        self.people, self.tries = {}, Counter()
        issued = content(course, students=NAMES)
        with store.begin() as connection:
            self.number = put_issued(connection, issued, "week")
            self.content = issued
        now = whole(store, course, self.number)
        self.questions = now.questions
        with store.reading() as connection:
            from coursework.database.instructor_queries import people_of

            self.people = people_of(connection, self.number)
        self.records = now.issued

    def text(self, exercise, seed, part):
        value = self.random.choice(["", "12", "777", "?", "??", "n'importe quoi", "3 mm", None])
        return value

    def rows(self, student, origin=None):
        for exercise, seed in self.records.issued_to(student).items():
            for part in self.records.records[exercise, seed]["parts"]:
                if self.random.random() < 0.8:
                    yield AnswerRow(
                        student, exercise, str(seed), part["id"], self.text(exercise, seed, part["id"]), "f.csv", origin=origin
                    )  # fmt: skip

    def hand_in(self):
        student = self.random.choice(NAMES)
        if student not in self.people:
            return
        self.tries[student] += 1
        number = self.tries[student]
        with self.store.begin() as connection:
            came = insert_submission(
                connection, self.number, list(self.rows(student, RowOrigin(sitting=number))), source="site", received_at=AT,
                person_id=self.people[student], number=number, late=self.random.choice([0, 0, 90000]),
            )  # fmt: skip
        mark_submission(self.course, self.store, came.id)

    def file(self):
        rows = [row for name in self.random.sample(NAMES, 3) for row in self.rows(name)]
        rows += [Rejected("f.csv", "no row", {"student": self.random.choice(NAMES), "answer": "4"})]
        rows += [
            AnswerRow(
                self.random.choice(["Anna", "ana", "Zoé"]), rows[0].exercise, "", rows[0].part, "5", "g.csv"
            )
        ]
        source = self.random.choice(["a.csv", "b.csv"])
        with self.store.begin() as connection:
            insert_submission(
                connection,
                self.number,
                rows,
                source=source,
                received_at=AT,
                replaces=self.random.random() < 0.5,
            )
        mark_new(self.course, self.store, self.number)

    def decide(self):
        now = whole(self.store, self.course, self.number)
        if not now.machine:
            return
        one = self.random.choice(list(now.machine.values()))
        part = self.random.choice(list(one.lines))
        name = self.random.choice([one.student, one.student.upper(), f" {one.student}"])
        kind = self.random.choice(KINDS)
        place = DecidedAnswer(
            name, one.exercise, self.random.choice(["", str(one.seed)]), part, one.lines[part].answer
        )
        with self.store.begin() as connection:
            decide(connection, self.number, [place], kind, 0.5 if kind == "given" else None, "", "Roe")

    def rule(self):
        with self.store.begin() as connection:
            said = Publication(
                closes=AT - timedelta(days=2), late=CHARGE, late_percent=self.random.choice([10, 30])
            )
            publish(connection, self.number, self.random.choice([said, None]))
            set_counting_attempt(connection, self.number, self.random.choice(["best", "last"]))

    def more_time(self):
        if self.people:
            person = self.random.choice(list(self.people.values()))
            with self.store.begin() as connection:
                extend(connection, self.number, person, Extension(AT, None, "ill", "Roe", AT))

    def put_aside(self):
        with self.store.reading() as connection:
            rows, _ = rows_page(connection, self.number)
        if rows:
            one = self.random.choice(rows)
            with self.store.begin() as connection:
                put_placing(connection, self.number, Placing(one.row, None, "", "Roe", AT))

    def erase(self):
        if len(self.people) > 3:
            name = self.random.choice(list(self.people))
            with self.store.begin() as connection:
                erase(connection, self.people.pop(name))

    def again(self):
        mark_new(self.course, self.store, self.number)


DEEDS = (
    "hand_in",
    "hand_in",
    "hand_in",
    "file",
    "decide",
    "decide",
    "rule",
    "more_time",
    "put_aside",
    "again",
)


@pytest.mark.parametrize("seed", range(3))
def test_aggregates_are_what_the_tables_come_to(store, small_course, seed):
    course = coursework.open_course(small_course)
    life = Life(store, course, seed)
    assert not differences(store, course, life.number)
    for step in range(14):
        deed = "erase" if step == 11 else life.random.choice(DEEDS)
        getattr(life, deed)()
        if life.random.random() < 0.6:
            assert not differences(store, course, life.number), (step, deed)
    assert not differences(store, course, life.number)


@pytest.fixture
def lived(store, small_course):
    """A database in which a class lived for a while, and its course."""
    course = coursework.open_course(small_course)
    life = Life(store, course, 7)
    for deed in ("hand_in", "file", "hand_in", "decide", "decide", "rule", "put_aside", "hand_in"):
        getattr(life, deed)()
    return life


def test_what_was_dumped_is_computed_anew(lived, tmp_path):
    refresh(lived.course, lived.store, lived.number)
    dump(lived.store, tmp_path / "dump")
    assert not [path.name for path in (tmp_path / "dump").iterdir() if path.stem in DERIVED]
    other = Store(f"sqlite:///{tmp_path}/other.db")
    restore(tmp_path / "dump", other)
    with other.reading() as connection:
        assert outstanding(connection)[lived.number] >= len(NAMES)
    assert not differences(other, lived.course, lived.number)
    other.close()


def test_an_old_database_is_computed_when_it_is_opened(lived):
    url = lived.store.url
    with lived.store.engine.begin() as connection:
        config = Config()
        config.set_main_option("script_location", str(_MIGRATIONS))
        config.attributes["connection"] = connection
        command.downgrade(config, "0002")
        assert not {*DERIVED} & {*inspect(connection).get_table_names()}
    opened = Store(url)
    with opened.reading() as connection:
        assert outstanding(connection)[lived.number] >= len(NAMES)
    assert not differences(opened, lived.course, lived.number)
    opened.close()


def test_who_finds_that_another_computed_it_throws_theirs_away(lived, monkeypatch):
    """Two compute the same students, the slower one from what was before a decision: the later figures stay."""
    from coursework.database import aggregates

    refresh(lived.course, lived.store, lived.number)
    now = whole(lived.store, lived.course, lived.number)
    one = next(sheet for sheet in now.machine.values())
    part = next(iter(one.lines))
    most = one.lines[part].out_of

    def give(points):
        with lived.store.begin() as connection:
            decide(
                connection,
                lived.number,
                [DecidedAnswer(one.student, one.exercise, "", part)],
                "given",
                points,
                "",
                "Roe",
            )

    computed, raced = aggregates._computed, []

    def slowly(*told):
        made = computed(*told)
        if not raced:
            raced.append(True)
            give(most)
            refresh(lived.course, lived.store, lived.number)
        return made

    give(0.0)
    monkeypatch.setattr(aggregates, "_computed", slowly)
    refresh(lived.course, lived.store, lived.number)
    monkeypatch.undo()
    assert raced
    assert not differences(lived.store, lived.course, lived.number)


def test_a_page_ends_and_goes_on_and_a_search_finds_on_every_page(store, small_course):
    course = coursework.open_course(small_course)
    names = [f"Student {k:03}" for k in range(230)]
    with store.begin() as connection:
        number = put_issued(connection, content(course, students=names), "large")
    assert not refresh(course, store, number, most=1), "some is left where there is more than was asked for"
    refresh(course, store, number)
    with store.reading() as connection:
        pages = [students_page(connection, number, TableRequest(page=k)) for k in (1, 2, 3, 99)]
        found = students_page(connection, number, TableRequest(find="student 22", page=1))
        some = students_page(connection, number, TableRequest(), Scope(students=names[5:8]))
        nobody = students_page(connection, number, TableRequest(), Scope(students=()))
    assert [row.student for page in pages[:3] for row in page.rows] == names
    assert [len(page.rows) for page in pages] == [PAGE, PAGE, 30, 30]
    assert {page.matches for page in pages} == {230}
    assert [row.student for row in found.rows] == names[220:230]
    assert ([row.student for row in some.rows], some.matches) == (names[5:8], 3)
    assert (list(nobody.rows), nobody.matches) == ([], 0)
