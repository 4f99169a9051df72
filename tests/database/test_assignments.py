"""What was issued comes back from the database as it went in, and stays issued."""

from __future__ import annotations

import json

import pytest
from small_assignment import item
from sqlalchemy import func, select
from stored_class import ANA, BEN, CLEO, STUDENTS, content

import coursework
from coursework.cli import run
from coursework.database.assignments import assignment_called, issued_content, issued_of, names, put_issued
from coursework.database.tables import issue, person, variant
from coursework.errors import BadInput
from coursework.system.tables import json_text


@pytest.fixture
def course(small_course):
    return coursework.open_course(small_course)


def put(store, told, **more):
    with store.begin() as connection:
        return put_issued(connection, told, **more)


def stored(store, number, *whose, **more):
    with store.reading() as connection:
        return issued_content(connection, number, *whose, **more)


def counted(store, table):
    with store.reading() as connection:
        return connection.execute(select(func.count()).select_from(table)).scalar()


def test_what_was_issued_comes_back_to_the_byte(store, course):
    told = content(course)
    assert json_text(stored(store, put(store, told))) == json_text(told)


@pytest.mark.parametrize(
    "arguments",
    [
        ["slotted_mechanism", "vocabulary", "--variants", "3"],
        ["four_bar_motion", "slotted_mechanism", "--roster", "class.csv", "--lang", "fr,en"],
    ],
)
def test_what_a_build_issues_comes_back_to_the_byte(store, tmp_path, arguments):
    (tmp_path / "class.csv").write_text("student,lang,Group\nZoé,en,B\nAda,,A\n", "utf-8")
    told = [str(tmp_path / "class.csv") if a == "class.csv" else a for a in arguments]
    assert run(["build", *told, "--formats", "html", "--out", str(tmp_path / "out")]) == 0
    text = (tmp_path / "out/issued.json").read_text("utf-8")
    assert json_text(stored(store, put(store, json.loads(text), name="out"))) == text


def test_papers_that_are_nobodys_and_alike_are_as_many_as_they_were(store, course):
    told = {**content(course, ()), "roster": False, "issued": [item(course, "", 7)] * 3}
    del told["students"]
    number = put(store, told)
    assert stored(store, number) == told
    assert put(store, told) == number
    assert stored(store, number) == told


def test_versions_and_sittings_come_back(store, course):
    told = content(course, (ANA, BEN))
    told["issued"] = [
        {"student": ANA, "version": "A", "record": item(course, ANA, 3)["record"]},
        {"student": BEN, "version": "A", "record": {**item(course, BEN, 3)["record"], "lang": "fr"}},
        item(course, BEN, 9, sitting=2),
    ]
    assert stored(store, put(store, told)) == told


def test_the_same_again_adds_nothing(store, course):
    first = put(store, content(course))
    before = counted(store, issue), counted(store, variant), counted(store, person)
    assert put(store, content(course)) == first
    assert (counted(store, issue), counted(store, variant), counted(store, person)) == before == (3, 3, 3)


def test_who_comes_late_is_added_and_takes_the_place_that_is_told(store, course):
    number = put(store, content(course, (ANA, BEN)))
    told = content(course, (ANA, BEN))
    told["issued"].insert(1, item(course, CLEO, 5))
    told["students"][CLEO] = {"number": "7"}
    assert put(store, told) == number
    assert stored(store, number) == told


def test_who_is_no_more_in_it_is_kept(store, course):
    number = put(store, content(course))
    put(store, {**content(course), "issued": content(course)["issued"][1:]})
    assert [one["student"] for one in stored(store, number)["issued"]] == [BEN, CLEO, ANA]


def test_another_variant_of_who_was_issued_one_is_refused_and_nothing_is_kept(store, course):
    number = put(store, content(course))
    other = content(course, (ANA, BEN, CLEO, "Dan"))
    other["issued"][0] = item(course, ANA, 77)
    with pytest.raises(BadInput, match=r"Ana was issued crank_pin 0.*choose another name"):
        put(store, other)
    assert stored(store, number) == content(course)


def test_another_record_of_a_seed_is_refused(store, course):
    put(store, content(course))
    other = content(course)
    other["issued"][0]["record"] = {**other["issued"][0]["record"], "version": 9}
    with pytest.raises(BadInput, match="other data before"):
        put(store, other)


def test_a_build_of_exercises_needs_a_name(store, course):
    told = {key: value for key, value in content(course).items() if key != "assignment"}
    with pytest.raises(BadInput, match="name them"):
        put(store, told)
    put(store, told, name="tutorial")
    with store.reading() as connection:
        assert list(names(connection)) == ["tutorial"]
        assert assignment_called(connection) == assignment_called(connection, "tutorial")
        with pytest.raises(BadInput, match="did you mean 'tutorial'"):
            assignment_called(connection, "tutorail")


def test_one_persons_part_is_theirs_alone(store, course):
    number = put(store, content(course))
    with store.reading() as connection:
        ben = connection.execute(select(person.c.id).where(person.c.who == "101")).scalar()
        own = issued_of(connection, number, ben)
        assert own.students == (BEN,)
        assert own.issued_to(BEN) == {"crank_pin": 1}
        assert issued_of(connection, number, student=CLEO).students == (CLEO,)
        assert issued_of(connection, number).students == STUDENTS


def test_one_person_of_two_assignments_is_one(store, course):
    put(store, content(course))
    put(store, content(course, name="week4"))
    assert counted(store, person) == 3
    assert counted(store, issue) == 6
