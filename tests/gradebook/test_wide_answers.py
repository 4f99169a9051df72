"""Answers typed from paper, a line for each student; and the columns of the roster that come back with the marks."""

import csv

import pytest
from small_assignment import table

from coursework.cli import run
from coursework.gradebook.submissions import read_file

ROSTER = "student,number,group,date de naissance,extra_time\nAda,101,A,2005-01-02,yes\nBo,102,B,2005-03-04,\nCy,103,B,2005-05-06,\n"


@pytest.fixture
def built(small_course, tmp_path):
    (tmp_path / "class.csv").write_text(ROSTER)
    (tmp_path / "exam.toml").write_text(
        'roster = "class.csv"\nidentity = ["number"]\nmark = { of = 20, step = 0.5 }\n'
        f'formats = "ipynb"\nsolutions = false\nsecret = "{"0123456789abcdef" * 2}"\n[[exercises]]\nname = "crank_pin"\n'
    )
    out = tmp_path / "exam"
    assert run(["--course", str(small_course), "build", str(tmp_path / "exam.toml"), "--out", str(out)]) == 0
    return small_course, out


def grade(course, out, typed, *options):
    asked = ["grade", str(typed), "--issued", str(out / "issued.json"), "--no-feedback", *options]
    return run(["--course", str(course), *asked])


def test_the_form_of_a_line_for_each_student_is_filled_and_marked(built):
    course, out = built
    with (out / "answers_wide.csv").open(encoding="utf-8-sig", newline="") as file:
        header, *rows = csv.reader(file)
    assert header == [
        "student",
        "number",
        "1.1 crank_pin x (mm)",
        "1.2 crank_pin y (mm)",
        "1.3 crank_pin v (mm/s)",
    ]
    assert [row[:2] for row in rows] == [["Ada", "101"], ["Bo", "102"], ["Cy", "103"]]
    key = {(k["student"], k["part"]): k["value"] for k in table(out / "instructor" / "key.csv")}
    rows[0][2:] = [key["Ada", part].replace(".", ",") for part in "xyv"]
    rows[1] = ["", "102", "", key["Bo", "y"], "twelve apples"]  # known by the number alone
    typed = out.parent / "typed.csv"
    with typed.open("w", newline="", encoding="cp1252") as file:
        csv.writer(file, delimiter=";").writerows(
            [header, *rows, ["Eve", "999", "1", "", ""], ["Bo", "102", "1", "", "", "9"]]
        )
    assert grade(course, out, typed) == 1
    summary = table(out / "marks" / "summary.csv")
    assert [(s["student"], s["correct"], s["unreadable"], s["missing"]) for s in summary] == [
        ("Ada", "3", "0", "0"), ("Bo", "1", "1", "1"), ("Cy", "0", "0", "3"),
    ]  # fmt: skip
    rejected = [
        (r["student"], r["source"].rpartition("typed.csv, ")[2], r["reason"])
        for r in table(out / "marks" / "rejected.csv")
    ]
    assert rejected == [
        ("Eve", "line 5, 1.1 crank_pin x (mm)", "no student 'Eve' on the roster"),
        ("Bo", "line 6", "6 cells where the header has 5"),
    ]


def test_other_tables_are_not_taken_for_wide_ones(tmp_path):
    path = tmp_path / "t.csv"
    for header in ("student,exercise,seed,part,reply", "student,first page,last page", "name,comment here"):
        path.write_text(f"{header}\na,b,c,d,e\n")
        assert all(hasattr(row, "reason") for row in read_file(path)) or header == "name,comment here"


def test_the_summary_repeats_the_columns_that_are_chosen_and_private_ones_never_unasked(built):
    course, out = built
    typed = out / "answers.csv"

    def carried(*options):
        grade(course, out, typed, *options)
        return (
            (out / "marks" / "summary.csv").read_text("utf-8-sig").splitlines()[0].rpartition(",missing")[2]
        )

    assert carried() == ",group"
    assert carried("--carry", "groupe,tiers temps") == ",group,extra_time"
    issued = out / "issued.json"
    issued.write_text(issued.read_text().replace('"identity"', '"carry": [],\n  "identity"'))
    assert carried() == ""
