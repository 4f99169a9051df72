"""Feedback on an assignment: one paper a student, with the total, the mark, and what to look at next."""

from __future__ import annotations

import shutil
import subprocess

import pytest
from small_assignment import issue, write

import coursework
from coursework.cli import run
from coursework.gradebook.class_marking import marked
from coursework.gradebook.feedback_sheets import feedback_paper
from coursework.gradebook.placing import placed
from coursework.gradebook.submissions import read_file
from coursework.making.issued import Issued

COURSE = coursework.open_course()
NAMES = ("slotted_mechanism", "grashof")
PARTS = ("rA", "theta4")


def given(student, name, seed, **more):
    variant = COURSE[name].variant(seed, "en", PARTS if name == NAMES[0] else None)
    return {"student": student, **more, "record": variant.record}


def answers(student, name, seed, **changed):
    variant = COURSE[name].variant(seed, "en", PARTS if name == NAMES[0] else None)
    solution = {p.id: variant.solution()[p.quantity] for p in variant.parts} | changed
    return [[student, name, seed, part, value] for part, value in solution.items()]


@pytest.fixture
def issued_file(tmp_path):
    def made(**stated):
        items = [given("Ada", name, seed) for name, seed in zip(NAMES, (5, 6), strict=True)]
        columns = {"Ada": {"Number": "117"}}
        return issue(tmp_path, items, columns, exercises=list(NAMES), **stated)

    return made


def paper(tmp_path, issued_path, rows, lang="en", **more):
    issued = Issued.read(issued_path)
    sheets = placed(COURSE, issued, read_file(write(tmp_path / "answers.csv", rows)))
    return feedback_paper(COURSE, issued, "Ada", list(marked(COURSE, issued, sheets)), lang, **more)


def test_a_paper_has_one_total_and_mark_and_counts_what_was_not_handed_in(tmp_path, issued_file):
    found = paper(tmp_path, issued_file(), answers("Ada", NAMES[0], 5))
    assert [s.handout.exercise for s in found.sheets] == list(NAMES)
    worth = [sum(p.points for p in COURSE[n].variant(s, "en", q).parts) for n, s, q in
             ((NAMES[0], 5, PARTS), (NAMES[1], 6, None))]  # fmt: skip
    assert (found.points, found.out_of) == (worth[0], sum(worth))
    assert float(found.mark) == pytest.approx(20 * worth[0] / sum(worth), abs=0.25)
    assert {line.verdict for line in found.sheets[1].lines} == {"missing"}
    assert found.advice == (f"{found.sheets[1].handout.title} (0 / {worth[1]:g})",)


def test_the_heading_is_the_assignments_in_the_language_of_the_student(tmp_path, issued_file):
    heading = paper(tmp_path, issued_file(), answers("Ada", NAMES[0], 5), "fr").heading
    assert (heading.title, heading.course, heading.date) == ("Devoir 2", "Mechanics 2A", "4 décembre 2026")
    assert (heading.identity, heading.mark_of, heading.duration) == ((("number", "117"),), "20", "1 h 30")


def test_what_to_look_at_next_is_where_most_points_are_lost(tmp_path, issued_file):
    rows = answers("Ada", NAMES[0], 5, rA="1 mm") + answers("Ada", NAMES[1], 6)
    found = paper(tmp_path, issued_file(), rows, "fr")
    title = found.sheets[0].handout.title
    lost = next(line for line in found.sheets[0].lines if line.question.id == "rA")
    assert found.advice[0] == f"{title}, question 1.{lost.question.number}, $r_A$ (0 / {lost.out_of:g})"
    everything = answers("Ada", NAMES[0], 5) + answers("Ada", NAMES[1], 6)
    assert paper(tmp_path, issued_file(), everything).advice == ()


def test_right_answers_are_shown_unless_the_assignment_keeps_them_back(tmp_path, issued_file):
    rows = answers("Ada", NAMES[0], 5)
    shown = paper(tmp_path, issued_file(), rows)
    right = COURSE[NAMES[0]].variant(5).solution()["rA"]
    assert shown.answers
    assert f"{right:.4g}"[:4] in shown.sheets[0].lines[0].right
    kept = paper(tmp_path, issued_file(answers="never"), rows)
    assert not kept.answers
    assert {line.right for sheet in kept.sheets for line in sheet.lines} == {""}


def test_what_was_handed_in_and_not_read_yet_is_not_called_missing(tmp_path, issued_file):
    found = paper(tmp_path, issued_file(), answers("Ada", NAMES[0], 5), waiting={NAMES[1]})
    assert [s.handout.exercise for s in found.sheets] == [NAMES[0]]
    assert found.out_of > found.points
    assert found.advice == ()


def test_grade_prints_a_paper_a_sitting(tmp_path, issued_file):
    path = issued_file()
    items = [given("Ada", NAMES[0], 5), given("Ada", NAMES[0], 7, sitting=2)]
    issue(tmp_path, items, exercises=[NAMES[0]])
    file = write(
        tmp_path / "answers.csv", answers("Ada", NAMES[0], 5) + answers("Ada", NAMES[0], 7, rA="1 mm")
    )
    assert run(["grade", str(file), "--issued", str(path)]) == 0
    feedback = tmp_path / "marks/feedback"
    assert sorted(p.name for p in feedback.iterdir()) == ["ada.pdf", "ada.sitting-2.pdf"]
    if shutil.which("pdftotext"):
        asked = ["pdftotext", "-layout", feedback / "ada.sitting-2.pdf", "-"]
        text = subprocess.run(asked, capture_output=True, check=True, text=True).stdout
        assert "Midterm 2" in text
        assert "What to look at next" in text
