"""An assignment marked as one thing: versions, sittings, its own rules, the mark, one line a student."""

from __future__ import annotations

import itertools
import json
from fractions import Fraction
from types import SimpleNamespace

import pytest
from small_assignment import grade, issue, item, right, table, write

import coursework
from coursework.gradebook.book import Result, counting_result
from coursework.gradebook.class_marking import marked
from coursework.gradebook.placing import placed_sheets
from coursework.gradebook.scale import mark_of
from coursework.gradebook.statistics.marks import read
from coursework.gradebook.statistics.measures import measure
from coursework.gradebook.submissions import read_file
from coursework.issuing.issued import Issued


@pytest.fixture
def course(small_course):
    return coursework.open_course(small_course)


# --------------------------------------------------------------------- versions


@pytest.fixture
def versions(course, tmp_path):
    """Two versions for three students, and one who hands in nothing."""
    dealt = {"Ada": ("A", 5), "Bo": ("B", 6), "Cy": ("A", 5), "Di": ("B", 6)}
    items = [item(course, s, seed, version=letter) for s, (letter, seed) in dealt.items()]
    columns = {s: {"Number": f"10{k}", "group": "A", "mark": "x"} for k, s in enumerate(dealt)}
    return issue(tmp_path, items, columns)


def test_students_of_one_version_are_each_marked_on_it(course, versions):
    issued = Issued.read(versions)
    assert issued.owners == {("crank_pin", 5): ("Ada", "Cy"), ("crank_pin", 6): ("Bo", "Di")}
    rows = right(course, "Ada", 5) + right(course, "Bo", 6) + right(course, "Cy", 5, "", v=0)
    status, marks = grade(course, versions, rows)
    assert status == 0
    summary = table(marks / "summary.csv")
    assert [s["student"] for s in summary] == ["Ada", "Bo", "Cy", "Di"]
    assert [s["points"] for s in summary] == ["4", "4", "2", "0"]
    assert [s["mark"] for s in summary] == ["20", "20", "10", "0"]
    assert [s["missing"] for s in summary] == ["0", "0", "0", "3"]


def test_another_version_is_refused_with_what_the_student_has(course, versions):
    status, marks = grade(course, versions, right(course, "Ada", 5) + right(course, "Bo", 5))
    assert status == 1
    reasons = {r["reason"] for r in table(marks / "rejected.csv")}
    assert reasons == {"seed 5 of crank_pin is version A's; Bo has version B, seed 6"}


def test_the_summary_names_who_and_each_exercise_and_loses_no_column(course, versions):
    _, marks = grade(course, versions, right(course, "Ada", 5))
    header = (marks / "summary.csv").read_text("utf-8-sig").splitlines()[0].split(",")
    assert header[:7] == ["student", "number", "crank_pin", "points", "out_of", "mark", "percent"]
    assert header[-2:] == ["group", "mark (roster)"]
    assert "Number" not in header  # it is the identity's column, whatever its case
    ada = table(marks / "summary.csv")[0]
    assert (ada["number"], ada["group"], ada["mark (roster)"], ada["crank_pin"]) == ("100", "A", "x", "4")


def test_a_mark_has_the_decimal_sign_of_the_table(course, versions):
    _, marks = grade(course, versions, right(course, "Ada", 5, v=0, x=0), "--decimal", "comma")
    cells = (marks / "summary.csv").read_text("utf-8-sig").splitlines()[1].split(";")
    assert cells[:6] == ["Ada", "100", "1", "1", "4", "5"]
    accepted = versions.parent / "accepted.csv"
    accepted.write_text("student,exercise,part,points\nAda,crank_pin,v,0.5\n", "utf-8")
    rows = right(course, "Ada", 5, v=0, x=0)
    _, marks = grade(course, versions, rows, "--decimal", "comma", "--accepted", accepted)
    cells = (marks / "summary.csv").read_text("utf-8-sig").splitlines()[1].split(";")
    assert cells[:6] == ["Ada", "100", "1,5", "1,5", "4", "7,5"]


def test_a_version_speaks_the_language_of_each_student(course, tmp_path):
    french = item(course, "Bo", 5)
    french["record"] = {**french["record"], "lang": "fr"}
    issued = issue(tmp_path, [item(course, "Ada", 5), french])
    _, marks = grade(course, issued, right(course, "Ada", 5) + right(course, "Bo", 5))
    told = {m["student"]: m["feedback"] for m in table(marks / "marks.csv")}
    assert "is right" in told["Ada"]
    assert "est juste" in told["Bo"]


def test_papers_that_are_nobodys_count_out_of_the_whole(course, tmp_path):
    other = json.loads(json.dumps(item(course, "", 5)))
    issued = issue(tmp_path, [other, item(course, "", 6)])
    _, marks = grade(course, issued, right(course, "Eve", 6))
    assert table(marks / "summary.csv")[0]["out_of"] == "4"


# ------------------------------------------------------------------------- mark


@pytest.mark.parametrize(
    ("points", "out_of", "scale", "told"),
    [
        (7, 10, (20, 0.5), "14"),
        (0.1 + 0.2, 0.3, (20, 0.5), "20"),
        (7.125, 10, (20, 0.5), "14.5"),  # 14.25 lies half-way: up
        (7.12, 10, (20, 0.5), "14"),
        (0.7 * 3, 4, (20, 1), "11"),  # 10.5, though 0.7 × 3 is a hair below 2.1
        (1, 3, (20, 0.01), "6.67"),
        (5, 0, (20, 0.5), ""),
        (10, 10, (20, 0.3), "20"),
    ],
)
def test_the_mark_is_the_share_to_the_nearest_step_halves_up(course, tmp_path, points, out_of, scale, told):
    issued = Issued.read(issue(tmp_path, [item(course, "Ada", 5)], mark={"of": scale[0], "step": scale[1]}))
    assert mark_of(issued, points, out_of) == told
    if told and scale[1] != 0.3:
        assert abs(Fraction(told) - Fraction(scale[0]) * Fraction(points) / Fraction(out_of)) <= Fraction(
            scale[1]
        ) / 2 + Fraction(1, 10**9)


def test_an_assignment_without_a_scale_has_no_mark(course, tmp_path):
    issued = issue(tmp_path, [item(course, "Ada", 5)], mark=None)
    _, marks = grade(course, issued, right(course, "Ada", 5))
    assert "mark" not in table(marks / "summary.csv")[0]


def test_an_assignment_that_is_none_is_told(course, tmp_path, capsys):
    issued = issue(tmp_path, [item(course, "Ada", 5)], mark={"of": "twenty", "step": 1})
    assert grade(course, issued, right(course, "Ada", 5))[0] == 2
    assert "the assignment in it is not valid" in capsys.readouterr().err


# --------------------------------------------------------------------- sittings


@pytest.fixture
def two_sittings(course, tmp_path):
    def made(rule="best"):
        items = [item(course, "Ada", 5), item(course, "Bo", 6), item(course, "Ada", 7, sitting=2)]
        return issue(tmp_path, items, sittings=rule)

    return made


@pytest.mark.parametrize(("rule", "sitting", "points"), [("best", "1", "4"), ("last", "2", "2")])
def test_the_sitting_counts_that_the_assignment_says(course, two_sittings, rule, sitting, points):
    rows = right(course, "Ada", 5) + right(course, "Ada", 7, v=0) + right(course, "Bo", 6)
    _, marks = grade(course, two_sittings(rule), rows)
    ada, bo = table(marks / "summary.csv")
    assert (ada["sitting"], ada["points"], ada["out_of"]) == (sitting, points, "4")
    assert (bo["sitting"], bo["points"]) == ("1", "4")
    assert [(m["seed"], m["sitting"]) for m in table(marks / "marks.csv") if m["student"] == "Ada"] == [
        ("5", "1")
    ] * 3 + [("7", "2")] * 3


def test_the_report_counts_the_sitting_that_the_summary_names(course, two_sittings):
    rows = right(course, "Ada", 5) + right(course, "Ada", 7, v=0) + right(course, "Bo", 6)
    _, marks = grade(course, two_sittings("last"), rows)
    told = measure(read(marks))
    assert told.answers == 6
    assert sorted(told.percents) == [50, 100]


def test_a_sitting_that_was_not_handed_in_counts_for_nobody(course, two_sittings):
    _, marks = grade(course, two_sittings("last"), right(course, "Ada", 5) + right(course, "Bo", 6))
    assert [(s["sitting"], s["points"]) for s in table(marks / "summary.csv")] == [("1", "4"), ("1", "4")]


def test_answers_that_do_not_say_their_sitting_are_of_the_latest_and_told(course, two_sittings, capsys):
    rows = right(course, "Ada", 7, "") + right(course, "Bo", 6, "")
    status, marks = grade(course, two_sittings(), rows)
    assert status == 0
    assert {m["sitting"] for m in table(marks / "marks.csv") if m["student"] == "Ada"} == {"2"}
    told = capsys.readouterr().err
    assert told.count("answers without a seed count for sitting 2, seed 7") == 1


def test_another_seed_is_refused_with_both_of_the_student(course, two_sittings):
    _, marks = grade(course, two_sittings(), right(course, "Bo", 6) + right(course, "Ada", 6))
    reasons = {r["reason"] for r in table(marks / "rejected.csv")}
    assert reasons == {"seed 6 of crank_pin is another student's; Ada has seed 5 and 7"}


# ------------------------------------------------------------------------ rules


def test_the_rules_of_the_assignment_override_those_of_the_course(course, tmp_path, monkeypatch):
    """Here and in other processes: a value ten times too large is worth the share that is stated."""
    value = course["crank_pin"].variant(5, "en").solution()["v"]
    rows = right(course, "Ada", 5, v=-value)
    plain = Issued.read(issue(tmp_path, [item(course, "Ada", 5)]))
    milder = Issued.read(issue(tmp_path, [item(course, "Ada", 5)], marking={"slip": 0.25}))

    def points(issued):
        file = write(tmp_path / "answers.csv", rows)
        graded = next(iter(marked(course, issued, placed_sheets(course, issued, read_file(file)))))
        return graded.lines["v"].points / graded.lines["v"].out_of

    assert (points(plain), points(milder)) == (0.5, 0.25)
    from coursework.gradebook import class_marking

    monkeypatch.setattr(class_marking, "WORTH_PROCESSES", 1)
    monkeypatch.setattr(class_marking, "workers", lambda *_: 2)
    assert (points(plain), points(milder)) == (0.5, 0.25)


def test_a_rule_that_there_is_not_is_told(course, tmp_path, capsys):
    issued = issue(tmp_path, [item(course, "Ada", 5)], marking={"slips": 0.25})
    assert grade(course, issued, right(course, "Ada", 5))[0] == 2
    assert "did you mean 'slip'" in capsys.readouterr().err


def test_the_later_of_two_equal_sittings_counts():
    """Whatever their order; of sittings that differ the best, and without points to earn the later too."""
    sittings = {(of, points): Result(of, points, 9.0, {}, {}) for of in (1, 2, 3) for points in (4.0, 6.0)}
    issued = SimpleNamespace(assignment={"sittings": "best"})
    for order in itertools.permutations([sittings[1, 4.0], sittings[2, 6.0], sittings[3, 6.0]]):
        assert counting_result(issued, order).sitting == 3
    for order in itertools.permutations([sittings[1, 6.0], sittings[2, 6.0], sittings[3, 4.0]]):
        assert counting_result(issued, order).sitting == 2
    assert counting_result(issued, [Result(2, 0.0, 0.0, {}, {}), Result(1, 0.0, 0.0, {}, {})]).sitting == 2
