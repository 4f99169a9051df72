"""Marks changed by hand: one truth in a folder, or a refusal that names the line."""

from __future__ import annotations

import csv

import pytest
from small_assignment import grade, issue, item, right, table

import coursework
from coursework.cli import run
from coursework.gradebook.statistics.marks import read
from coursework.gradebook.statistics.measures import measure


@pytest.fixture
def course(small_course):
    return coursework.open_course(small_course)


@pytest.fixture
def marks(course, tmp_path):
    """Ada is right but for the sign of v, Bo hands in nothing readable, Cy nothing."""
    issued = issue(tmp_path, [item(course, s, k) for k, s in enumerate(("Ada", "Bo", "Cy"), start=5)])
    v = course["crank_pin"].variant(5, "en").solution()["v"]
    rows = right(course, "Ada", 5, v=-v) + right(course, "Bo", 6, 99)
    assert grade(course, issued, rows)[0] == 1
    return tmp_path / "marks"


def again(course, marks, *more):
    asked = [
        "--course",
        course.folder.root,
        "grade",
        "--issued",
        marks.parent / "issued.json",
        "--no-feedback",
    ]
    return run(list(map(str, [*asked, "--from", marks / "marks.csv", *more])))


def change(marks, named, **cells):
    rows = table(marks / "marks.csv")
    next(r for r in rows if r["part"] == named).update(cells)
    with (marks / "marks.csv").open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), delimiter=";")
        writer.writeheader()
        writer.writerows(rows)


def test_marks_that_nobody_changed_give_the_same_tables(course, marks):
    before = {p.name: p.read_bytes() for p in marks.iterdir()}
    assert again(course, marks) == 1  # Bo's rows still wait
    after = {p.name: p.read_bytes() for p in marks.iterdir()}
    assert table(marks / "changes.csv") == []
    assert {n: after[n] for n in before} == before
    assert set(after) - set(before) == {"changes.csv"}


def test_a_mark_changed_by_hand_reaches_summary_changes_and_report(course, marks, capsys):
    change(marks, "v", points="1,5")
    stood = (marks / "marks.csv").read_bytes()
    again(course, marks)
    assert "1 mark was changed by hand" in capsys.readouterr().out
    ada, bo, cy = table(marks / "summary.csv")
    assert (ada["points"], ada["mark"], bo["unreadable"], cy["missing"]) == ("3.5", "17.5", "3", "3")
    changes = table(marks / "changes.csv")
    assert [(c["part"], c["points_before"], c["points_now"]) for c in changes] == [("v", "1", "1.5")]
    assert sorted(measure(read(marks)).percents) == [0, 0, 87.5]
    assert (marks / "marks.csv").read_bytes() == stood


def test_a_verdict_and_words_changed_by_hand_stand(course, marks):
    change(marks, "v", verdict="correct", points="2", feedback="seen *in person*")
    again(course, marks)
    assert table(marks / "summary.csv")[0]["correct"] == "3"


@pytest.mark.parametrize(
    ("cells", "told"),
    [
        ({"points": "two"}, "a number from 0 to 2; found 'two'"),
        ({"points": ""}, "a number from 0 to 2"),
        ({"points": "2.5"}, "a number from 0 to 2; found '2.5'"),
        ({"points": "-1"}, "a number from 0 to 2"),
        ({"points": "nan"}, "a number from 0 to 2"),
        ({"out_of": "3"}, "v is out of 2 points, as issued"),
        ({"verdict": "corect"}, "did you mean 'correct'"),
        ({"student": "Eve"}, "no student 'Eve' on the roster"),
        ({"seed": "6"}, "seed 6 of crank_pin is another student's"),
        ({"part": "x"}, "repeats line 2"),
    ],
)
def test_a_change_that_makes_no_sense_is_told_by_line_and_writes_nothing(course, marks, capsys, cells, told):
    change(marks, "v", **cells)
    before = {p.name: p.read_bytes() for p in marks.iterdir()}
    capsys.readouterr()
    assert again(course, marks) == 2
    said = capsys.readouterr().err
    assert told in said
    assert "marks.csv, line 4" in said
    assert {p.name: p.read_bytes() for p in marks.iterdir()} == before


def test_a_later_marking_keeps_the_marks_that_a_hand_changed(course, marks, capsys):
    change(marks, "v", points="1.5")
    again(course, marks)
    (edited,) = table(marks / "decisions.csv")
    assert (edited["part"], edited["kind"], edited["points"]) == ("v", "edited", "1.5")
    stood = (marks / "marks.csv").read_bytes()
    asked = ["--course", course.folder.root, "grade", marks.parent / "answers.csv", "--no-feedback"]
    capsys.readouterr()
    run(list(map(str, [*asked, "--issued", marks.parent / "issued.json"])))
    assert "marks.before.csv" in capsys.readouterr().err
    assert (marks / "marks.before.csv").read_bytes() == stood
    assert table(marks / "decisions.csv") == []


def test_another_folder_holds_the_marks_too(course, marks, tmp_path):
    again(course, marks, "--out", tmp_path / "final")
    assert (tmp_path / "final/marks.csv").read_bytes() == (marks / "marks.csv").read_bytes()
    assert (tmp_path / "final/summary.csv").read_bytes() == (marks / "summary.csv").read_bytes()


def test_what_is_marked_is_said_once(course, marks, capsys):
    assert again(course, marks, str(marks.parent / "answers.csv")) == 2
    assert "omit SUBMISSIONS" in capsys.readouterr().err
    assert (
        run(["--course", str(course.folder.root), "grade", "--issued", str(marks.parent / "issued.json")])
        == 2
    )
    assert "nothing to mark; name SUBMISSIONS" in capsys.readouterr().err


def test_the_report_says_when_a_mark_was_changed_and_the_summary_was_not_told(course, marks, capsys):
    def said():
        assert run(["--course", str(course.folder.root), "report", str(marks), "--json", "--lang", "en"]) == 0
        return capsys.readouterr().err

    assert said() == ""
    change(marks, "v", points="0.25")
    assert "1 student with other points in" in (told := said())
    assert "Ada" in told
    assert f"--from {marks / 'marks.csv'}" in told
    assert again(course, marks) == 1
    capsys.readouterr()
    assert said() == ""
