"""Feedback that is printed again: a kill at any moment loses no sheet, what a teacher wrote on one is kept,
and who answered counts."""

from __future__ import annotations

import csv
import json
import os
import shutil
import warnings
from pathlib import Path

import pytest

import coursework
from coursework.cli import run
from coursework.gradebook import grading
from coursework.gradebook.grading import usual_feedback
from coursework.gradebook.placing import Sheets

OLD = {"ada.html", "bo.html", "cy.html"}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Three students of a small course who were marked, and answers that came since: Bo's other, Cy's
    gone."""
    folder = tmp_path_factory.mktemp("stopped")
    assert run(["new", str(folder / "small")]) == 0
    (folder / "class.csv").write_text("student\nAda\nBo\nCy\n", "utf-8")
    made = ["--roster", str(folder / "class.csv"), "--formats", "html", "--out", str(folder / "out")]
    assert run(["--course", str(folder / "small"), "build", *made]) == 0
    course = coursework.open_course(folder / "small")
    rows = []
    for item in json.loads((folder / "out" / "issued.json").read_text("utf-8"))["issued"]:
        variant = course["crank_pin"].from_record(item["record"])
        rows += [[item["student"], "crank_pin", variant.seed, p, v] for p, v in variant.solution().items()]
    later = [[*row[:4], "1"] if row[0] == "Bo" else row for row in rows if row[0] != "Cy"]
    for name, some in (("first.csv", rows), ("later.csv", later)):
        with (folder / name).open("w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerows([["student", "exercise", "seed", "part", "answer"], *some])
    assert grade(folder, "first.csv") == 0
    return folder


def grade(folder, answers, *more):
    where = ["--issued", str(folder / "out" / "issued.json"), "--formats", "html"]
    course = ["--course", str(folder / "small")]
    return run([*course, "grade", str(folder / answers), *where, *more])


@pytest.fixture
def marked(built, tmp_path):
    """A copy to mark again in, with its folder of marks."""
    shutil.copytree(built, tmp_path / "copy")
    return tmp_path / "copy"


def files_of(folder):
    marks = folder / "out" / "marks"
    return {
        p.relative_to(marks).as_posix(): p.read_bytes()
        for p in marks.rglob("*")
        if p.is_file() and p.suffix != ".lock"
    }


def killed_at(folder, moment):
    """Mark in another process that is killed before it moves or takes away the file of that number; whether
    it was."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of threads; none of them prints
        child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9
    left = [moment]

    def dying(does):
        def done(self, *told, **more):
            if not left[0]:
                os._exit(9)
            left[0] -= 1
            return does(self, *told, **more)

        return done

    try:
        for name in ("replace", "unlink"):
            setattr(Path, name, dying(getattr(Path, name)))
        grade(folder, "later.csv")
    finally:
        os._exit(0)


def killed_anywhere(built, folder, moments):
    whole, before = folder / "whole", files_of(built)
    shutil.copytree(built, whole)
    assert grade(whole, "later.csv") == 0
    wanted = files_of(whole)
    assert {row["student"] for row in rows_of(whole)} == {"Bo", "Cy"}
    for moment in moments:
        one = folder / f"killed-{moment}"
        shutil.copytree(built, one)
        if not killed_at(one, moment):
            return moment
        left = files_of(one)
        for name in ("feedback/ada.html", "feedback/bo.html"):
            assert left[name] in (before[name], wanted[name]), (moment, name)
        if left["marks.csv"] == wanted["marks.csv"]:  # all was done
            assert left["changes.csv"] == wanted["changes.csv"]
        else:
            assert grade(one, "later.csv") == 0
            assert files_of(one) == wanted, moment
        shutil.rmtree(one)
    return None


def rows_of(folder):
    with (folder / "out" / "marks" / "changes.csv").open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


forks = pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not copied here")


@pytest.mark.e2e
@forks
def test_a_kill_leaves_every_sheet_and_the_next_time_tells_what_changed(built, tmp_path):
    killed_anywhere(built, tmp_path, (0, 3, 4, 6, 8, 10))


@forks
@pytest.mark.slow
def test_a_kill_at_any_moment_leaves_every_sheet(built, tmp_path):
    assert killed_anywhere(built, tmp_path, range(100)) > 8


def test_a_sheet_that_a_teacher_wrote_on_is_set_aside_and_told(marked, capsys):
    feedback = marked / "out" / "marks" / "feedback"
    for name in ("bo", "cy"):
        (feedback / f"{name}.html").write_text(f"a note to {name}", "utf-8")
    capsys.readouterr()
    assert grade(marked, "later.csv") == 0
    said = capsys.readouterr().err
    assert "bo.html was changed since it was written; it is now bo.before.html" in said
    assert "cy.html is from an earlier marking and was changed since; it is kept" in said
    assert (feedback / "bo.before.html").read_text("utf-8") == "a note to bo"
    assert (feedback / "cy.html").read_text("utf-8") == "a note to cy"
    assert "a note" not in (feedback / "bo.html").read_text("utf-8")
    assert grade(marked, "first.csv") == 0
    said = capsys.readouterr().err
    assert "bo.html" not in said
    assert (feedback / "bo.before.html").read_text("utf-8") == "a note to bo"
    assert (feedback / "cy.before.html").read_text("utf-8") == "a note to cy"


def test_sheets_of_a_later_format_take_the_place_of_those_before(marked):
    assert grade(marked, "first.csv", "--formats", "ipynb") == 0
    assert {p.name for p in (marked / "out" / "marks" / "feedback").iterdir()} == {
        "ada.ipynb",
        "bo.ipynb",
        "cy.ipynb",
    }


def test_nothing_of_before_is_touched_while_sheets_are_printed(marked, monkeypatch):
    before = files_of(marked)
    from coursework.rendering.renderer import Renderer

    def broken(self, sheet):
        assert {k: v for k, v in files_of(marked).items() if not k.endswith(".part")} == before
        raise KeyboardInterrupt

    monkeypatch.setattr(Renderer, "html", broken)
    assert grade(marked, "later.csv") != 0
    assert files_of(marked) == before


# ------------------------------------------------------------------------ limit


def test_who_answered_counts_for_the_limit_of_sheets(marked, monkeypatch, capsys):
    monkeypatch.setattr(grading, "FEEDBACK_STUDENTS", 2)
    assert grade(marked, "later.csv") == 0, "two of three answered"
    assert "no feedback" not in capsys.readouterr().err
    assert (marked / "out" / "marks" / "feedback" / "bo.html").exists()
    assert grade(marked, "first.csv", "--out", str(marked / "all")) == 0
    assert (
        "no feedback sheets are printed for more than 2 students, and 3 answered" in capsys.readouterr().err
    )
    assert not (marked / "all" / "feedback").exists()
    assert grade(marked, "first.csv", "--out", str(marked / "asked"), "--feedback") == 0
    assert {p.name for p in (marked / "asked" / "feedback").iterdir()} == OLD


def test_a_class_without_a_roster_is_counted_by_its_answers():
    sheets = Sheets(sheets={(f"student {n}", "crank_pin", 0, 0): {} for n in range(22_000)})
    assert not usual_feedback(sheets)
    assert "22,000 answered" in sheets.warnings[0]
    several = Sheets(sheets={("Ada", f"exercise {n}", 0, 0): {} for n in range(2_000)})
    assert usual_feedback(several)
    assert several.warnings == []
