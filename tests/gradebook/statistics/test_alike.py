"""Who hands in another's sheet is told to the staff; who errs is not."""

from __future__ import annotations

import csv

import coursework
from coursework.cli import run
from coursework.gradebook.columns import MARKS_COLUMNS
from coursework.gradebook.statistics.alike import alike
from coursework.issuing.issuing import distinct_variants

COURSE = coursework.open_course()


def marks(folder, sheets):
    """A folder of marks: for each student and variant, the answers handed in."""
    folder.mkdir(exist_ok=True)
    with (folder / "marks.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, MARKS_COLUMNS, restval="")
        table.writeheader()
        for student, variant, answers in sheets:
            for part, mark in variant.grade(answers).items():
                table.writerow(
                    {
                        "student": student,
                        "exercise": variant.exercise.name,
                        "seed": variant.seed,
                        "part": part,
                        "answer": mark.answer,
                        "read_as": mark.read_as,
                        "verdict": mark.verdict,
                        "points": mark.points,
                        "out_of": mark.out_of,
                    }
                )
    return folder


def rounded(variant):
    return {name: f"{value:.4g}" for name, value in variant.solution().items() if isinstance(value, float)}


def test_a_neighbours_sheet_is_told_and_an_honest_error_is_not(tmp_path, capsys):
    ada, bo, cy = distinct_variants(COURSE["four_bar_motion"], 0, 3, "en")
    honest = {**rounded(cy), "omega3": "99.1", "omega4": "12.7", "v_B": "777"}
    folder = marks(
        tmp_path / "marks", [("Ada", ada, rounded(ada)), ("Bo", bo, rounded(ada)), ("Cy", cy, honest)]
    )
    (found,) = alike(folder)
    assert (found.student, found.other, found.owners) == ("Bo", str(ada.seed), ("Ada",))
    assert found.answers > 6
    assert run(["report", str(folder)]) == 0
    assert "right on another student's variant" in capsys.readouterr().err
    (row,) = csv.DictReader((folder / "report" / "alike.csv").read_text("utf-8-sig").splitlines())
    assert (row["student"], row["issued to"]) == ("Bo", "Ada")
    # Marked again without the copy, no table is left behind.
    marks(folder, [("Ada", ada, rounded(ada)), ("Cy", cy, honest)])
    assert run(["report", str(folder)]) == 0
    assert not (folder / "report" / "alike.csv").exists()


def test_one_variant_for_all_makes_nobody_alike(tmp_path):
    (one,) = distinct_variants(COURSE["four_bar_motion"], 0, 1, "en")
    wrong = {**rounded(one), "omega3": "99.1", "omega4": "12.7", "v_B": "777"}
    assert (
        alike(marks(tmp_path / "m", [("Ada", one, rounded(one)), ("Bo", one, wrong), ("Cy", one, wrong)]))
        == []
    )
