"""Decisions are added and never changed; the last of an answer stands, and says who."""

from __future__ import annotations

import pytest
from sqlalchemy import func, select, update
from stored_class import ANA, BEN, content, put, rows
from tables import each_row

import coursework
from coursework.database.current_marks import adjusted_sheets
from coursework.database.decisions import decide, history, read_decisions, store_new_decisions
from coursework.database.marking import mark_new
from coursework.database.tables import decision
from coursework.errors import BadInput, UnknownName
from coursework.gradebook.decisions import DECISIONS_FILE, Decision, DecisionFiles

PLACE = Decision(BEN, "crank_pin", "1", "x", "accepted")


@pytest.fixture
def course(small_course):
    return coursework.open_course(small_course)


@pytest.fixture
def number(store, course):
    found = put(store, content(course), rows(course, ANA, 0), rows(course, BEN, 1, x="somewhere"))
    mark_new(course, store, found)
    return found


def say(store, number, places, kind, points, reason, by="Prof. Roe"):
    told = {"kind": kind, "points": points, "reason": reason, "by": by}
    with store.begin() as connection:
        decide(connection, number, [place._replace(**told) for place in places])


def line(store, number, student=BEN, part="x"):
    with store.reading() as connection:
        return adjusted_sheets(connection, number, student)[-1][0].lines[part]


def test_an_accepted_answer_has_its_points_and_says_why(store, number):
    assert line(store, number).verdict == "unreadable"
    say(store, number, [PLACE], "accepted", None, "read on the sheet")
    one = line(store, number)
    assert (one.verdict, one.points) == ("accepted", one.out_of)
    assert one.feedback.endswith("read on the sheet")


@pytest.mark.parametrize(("share", "verdict"), [(1, "accepted"), (0.5, "partial"), (0, "wrong")])
def test_what_is_given_says_so(store, number, share, verdict):
    most = line(store, number).out_of
    say(store, number, [PLACE._replace(answer=" somewhere ")], "given", share * most, "by eye")
    one = line(store, number)
    assert (one.verdict, one.points) == (verdict, share * most)


def test_what_is_given_counts_for_the_very_answer_alone(store, number):
    say(store, number, [PLACE._replace(answer="elsewhere")], "given", 0.5, "")
    assert line(store, number).verdict == "unreadable"


@pytest.mark.parametrize(
    ("kinds", "verdict"),
    [
        (["accepted", "withdrawn"], "unreadable"),
        (["accepted", "given"], "partial"),
        (["given", "accepted"], "accepted"),
        (["withdrawn", "accepted"], "accepted"),
        (["accepted", "withdrawn", "given"], "partial"),
    ],
)
def test_the_last_stands(store, number, kinds, verdict):
    for kind in kinds:
        say(store, number, [PLACE], kind, 0.5 if kind == "given" else None, "")
    assert line(store, number).verdict == verdict


def test_a_decision_without_a_seed_is_of_whatever_variant(store, number):
    say(store, number, [PLACE._replace(seed="", student="ben")], "accepted", None, "")
    assert line(store, number).verdict == "accepted"
    say(store, number, [PLACE._replace(seed="77")], "withdrawn", None, "")
    assert line(store, number).verdict == "accepted"


def test_an_answer_that_nobody_gave_is_accepted_too(store, course):
    number = put(store, content(course), rows(course, BEN, 1)[1:])
    mark_new(course, store, number)
    say(store, number, [PLACE], "accepted", None, "handed in on paper")
    with store.reading() as connection:
        (one,) = adjusted_sheets(connection, number, BEN)[-1]
    assert one.unanswered == ("x",)
    assert one.lines["x"].verdict == "accepted"


def test_a_decision_outlives_a_marking(store, number, course):
    say(store, number, [PLACE], "accepted", None, "")
    put(store, content(course, mark={"of": 10, "step": 1}, marking={"slip": 0.2}))
    assert mark_new(course, store, number).marked == 2
    assert line(store, number).verdict == "accepted"


@each_row(
    ("places", "kind", "points", "fault", "says"),
    [
        ([PLACE], "acepted", None, UnknownName, "did you mean 'accepted'"),
        ([PLACE], "given", None, BadInput, "say how many"),
        ([PLACE], "given", 99, BadInput, "give at most these"),
        ([PLACE._replace(part="xx")], "accepted", None, UnknownName, "no part 'xx'"),
        ([PLACE._replace(exercise="crank")], "accepted", None, UnknownName, "no exercise 'crank'"),
        ([PLACE, PLACE._replace(part="nn")], "accepted", None, UnknownName, "no part 'nn'"),
    ],
)
def test_what_cannot_be_decided_is_refused_and_nothing_is_kept(
    store, number, places, kind, points, fault, says
):
    with pytest.raises(fault, match=says):
        say(store, number, places, kind, points, "")
    with store.reading() as connection:
        assert connection.execute(select(func.count()).select_from(decision)).scalar() == 0


def test_the_history_of_an_answer_has_every_mark_and_who(store, number):
    say(store, number, [PLACE], "accepted", None, "fine")
    say(store, number, [PLACE], "withdrawn", None, "not fine", by="Dr. Poe")
    with store.reading() as connection:
        found = history(connection, number, BEN, "crank_pin", "x")
    assert [(one.kind, one.by, one.reason) for one in found[1:]] == [
        ("accepted", "Prof. Roe", "fine"),
        ("withdrawn", "Dr. Poe", "not fine"),
    ]
    assert (found[0].kind, found[0].verdict, found[0].answer) == ("marked", "unreadable", "somewhere")
    assert found == sorted(found, key=lambda one: one.made)


def test_steps_come_from_a_file_once_and_go_with_their_line(course, store, number, tmp_path):
    path = tmp_path / DECISIONS_FILE
    header = "student,exercise,seed,part,answer,kind,points,out_of,reason,by,date"
    weight, neutral = ",crank_pin,,y,,weight,7,,,Prof. Roe,2026-12-04", ",crank_pin,,x,,neutral,,,,Prof. Roe,"

    def taken_in(*lines):
        path.write_text("\n".join((header, *lines)) + "\n", "utf-8")
        with store.begin() as connection:
            return store_new_decisions(connection, number, DecisionFiles(tmp_path))

    assert [taken_in(weight, neutral), taken_in(weight, neutral)] == [2, 0]
    assert (line(store, number, part="y").out_of, line(store, number).out_of) == (7, 0)
    assert [taken_in(weight), line(store, number).out_of > 0, line(store, number, part="y").out_of] == [
        1,
        True,
        7,
    ]
    say(store, number, [PLACE._replace(student="", seed="")], "neutral_if_hurt", None, "on the site")
    assert (line(store, number).out_of, line(store, number, ANA).out_of > 0) == (0, True)
    with pytest.raises(BadInput):
        say(store, number, [PLACE._replace(student="", seed="")], "weight", -1, "")
    with pytest.raises(UnknownName):  # of one student there is no weight
        say(store, number, [PLACE], "weight", 2, "")


def test_any_step_is_taken_back_by_its_id_from_a_file_or_written_before_there_were_ids(
    course, store, number, tmp_path
):
    step = PLACE._replace(student="", seed="", part="y")
    for points in (7, 8):
        say(store, number, [step], "weight", points, "")
    with store.begin() as connection:
        connection.execute(update(decision).values(lasting_id=None))
    path = tmp_path / DECISIONS_FILE
    header = "exercise,part,kind,points,by,id,withdraws"

    def taken_in(*lines):
        path.write_text("\n".join((header, *lines)) + "\n", "utf-8")
        with store.begin() as connection:
            store_new_decisions(connection, number, DecisionFiles(tmp_path))
            return read_decisions(connection, number).standing_steps

    first, second, own = taken_in(weight := "crank_pin,y,weight,9,,own,")
    assert (first.points, second.points, own.id, first.id != second.id) == (7, 8, "own", True)
    taken_back = taken_in(weight, "crank_pin,y,withdrawn,,,b,own", f"crank_pin,y,withdrawn,,,a,{first.id}")
    assert taken_back == taken_in(
        weight, "crank_pin,y,withdrawn,,,b,own", f"crank_pin,y,withdrawn,,,a,{first.id}"
    )
    assert [one.points for one in taken_back] == [8]
    assert line(store, number, part="y").out_of == 8
