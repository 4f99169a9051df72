"""Two different sheets of one student in two files: whose each is, a folder's or a file's name tells, or a
person."""

from __future__ import annotations

import csv
import json
import re
import shutil

import pytest

import coursework
from coursework.authoring.scaffold import new_course
from coursework.cli import run

ADA, BO = "Ada Lovelace", "Bo"
ALL = 4.0  #: points of the exercise


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Two students of the small course, and their right answers."""
    tmp_path = tmp_path_factory.mktemp("built")
    small_course = tmp_path / "small"
    new_course(small_course)
    (tmp_path / "class.csv").write_text(
        f"student,email\n{ADA},al1815@school.org\n{BO},bo@school.org\n", "utf-8"
    )
    made = ["--roster", str(tmp_path / "class.csv"), "--formats", "html", "--out", str(tmp_path / "out")]
    assert run(["--course", str(small_course), "build", *made]) == 0
    course = coursework.open_course(small_course)
    content = json.loads((tmp_path / "out" / "issued.json").read_text("utf-8"))["issued"]
    records = {item["student"]: item["record"] for item in content}
    answers = {s: (r["seed"], course["crank_pin"].from_record(r).solution()) for s, r in records.items()}
    return tmp_path / "out", answers


@pytest.fixture
def issued(built, tmp_path):
    """What was built, for one test alone; gives the right answers."""
    shutil.copytree(built[0], tmp_path / "out")
    return built[1]


def notebook(issued, student=ADA, **changed):
    seed, right = issued[student]
    answers = {part: f"{value:.8g}" for part, value in right.items()} | changed
    return {
        "metadata": {"coursework": {"student": student, "exercise": "crank_pin", "seed": seed}},
        "cells": [
            {"cell_type": "code", "metadata": {"tags": ["answers"]}, "source": f"answers = {answers!r}"}
        ],
    }


def sheet(issued, student=ADA, **changed):
    seed, right = issued[student]
    answers = {part: f"{value:.8g}" for part, value in right.items()} | changed
    return {"student": student, "exercise": "crank_pin", "seed": seed, "answers": answers}


@pytest.fixture
def marked(small_course, issued, tmp_path, capsys):
    """Mark files by their names; gives the points by student, the rejected rows, and what was said."""

    def call(**files):
        came = tmp_path / "came"
        shutil.rmtree(came, ignore_errors=True)
        for name, content in files.items():
            path = came / name.replace("__", "/")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(content), "utf-8")
        capsys.readouterr()
        where = ["--issued", str(tmp_path / "out" / "issued.json"), "--no-feedback"]
        run(["--course", str(small_course), "grade", str(came), *where])
        said = capsys.readouterr()
        marks = tmp_path / "out" / "marks"
        points = {row["student"]: float(row["points"]) for row in table(marks / "summary.csv")}
        rows_in = sum(len(issued[ADA][1]) for _ in files)
        blank = sum(map(int, re.findall(r"([0-9]+) blank beside", said.out)))
        assert len(table(marks / "marks.csv")) + len(table(marks / "rejected.csv")) + blank == rows_in
        return points, table(marks / "rejected.csv"), said

    return call


def table(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def named(name, ending):
    return f"{name}.{ending}"


KINDS = pytest.mark.parametrize(
    ("ending", "made"), [("ipynb", notebook), ("json", sheet)], ids=["ipynb", "json"]
)


@KINDS
def test_where_nothing_tells_whose_they_are_both_wait_for_a_person(marked, issued, ending, made):
    files = {named("aaa", ending): made(issued, x="1"), named("work", ending): made(issued)}
    other = {named("bo", ending): made(issued, BO)}
    points, rejected, said = marked(**files, **other)
    assert points[ADA] == 0
    assert points[BO] > 0
    assert len(rejected) == 2 * len(issued[ADA][1])
    assert {row["student"] for row in rejected} == {ADA}
    assert all("a person must decide which one counts" in row["reason"] for row in rejected)
    assert f"different sheets of {ADA}" in said.err


def test_the_summary_counts_what_waits_as_not_read_and_not_as_missing(marked, issued, tmp_path):
    files = {"a.ipynb": notebook(issued, x="1"), "b.ipynb": notebook(issued)}
    marked(**files, **{"bo.ipynb": notebook(issued, BO)})
    (ada,) = (row for row in table(tmp_path / "out" / "marks" / "summary.csv") if row["student"] == ADA)
    assert (int(ada["unreadable"]), int(ada["missing"])) == (len(issued[ADA][1]), 0)


@KINDS
@pytest.mark.parametrize(
    "own",
    ["ada-lovelace", "ada-lovelace.fr", "Ada Lovelace", "Ada Lovelace (1)", "al1815", "Ada Lovelace__sheet"],
)
def test_a_name_of_file_or_folder_tells_whose_sheet_counts(marked, issued, ending, made, own):
    points, rejected, _ = marked(
        **{named("aaa", ending): made(issued, x="1"), named(own, ending): made(issued)}
    )
    assert points[ADA] == ALL
    assert all(f"names {ADA}, who has another sheet in" in row["reason"] for row in rejected)
    assert {row["source"].partition(",")[0].rpartition("/")[2] for row in rejected} == {named("aaa", ending)}


def test_a_sheet_that_is_called_by_another_does_not_count_for_who_it_names(marked, issued):
    points, rejected, _ = marked(
        **{
            "bo.ipynb": notebook(issued, x="1"),
            "work.ipynb": notebook(issued),
            "c.ipynb": notebook(issued, BO),
        }
    )
    assert points[ADA] == 0
    assert len(rejected) == 2 * len(issued[ADA][1])


def test_the_same_twice_and_a_blank_one_beside_it_are_no_doubt(marked, issued):
    blank = notebook(issued, **dict.fromkeys(issued[ADA][1], ""))
    points, rejected, _ = marked(**{"a.ipynb": notebook(issued), "b.ipynb": notebook(issued)})
    assert points[ADA] == ALL
    assert all("repeats" in row["reason"] for row in rejected)
    points, rejected, _ = marked(**{"a.ipynb": blank, "b.ipynb": notebook(issued)})
    assert (points[ADA], rejected) == (ALL, [])


def test_two_of_the_student_s_own_are_read_as_ever(marked, issued):
    """Both are called by her: of two tries the first that is read counts, and the other is told."""
    points, rejected, _ = marked(
        **{"ada-lovelace.ipynb": notebook(issued), "ada-lovelace (1).ipynb": notebook(issued, x="1")}
    )
    assert 0 < points[ADA] <= ALL
    assert all("repeats" in row["reason"] for row in rejected)


def test_a_file_that_the_staff_collected_raises_no_doubt(marked, issued):
    """It holds the sheets of several students."""
    both = [sheet(issued, ADA, x="1"), sheet(issued, BO)]
    _, rejected, _ = marked(**{"a.json": both[1], "b.json": sheet(issued)})
    assert rejected == []
