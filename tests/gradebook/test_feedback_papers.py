"""Feedback on an assignment: one paper a student, with the total, the mark, and what to look at next."""

from __future__ import annotations

import datetime
import json
import re
import shutil
import subprocess
from collections import Counter
from itertools import count

import pytest
from pdf_text import page_texts
from small_assignment import issue, write

import coursework
from coursework.cli import run
from coursework.course.exercise import ALL
from coursework.course.lessons import lesson_title, taught_by
from coursework.errors import BadCourse, BadInput
from coursework.gradebook.class_marking import marked
from coursework.gradebook.feedback_form import FeedbackForm, shows_solutions
from coursework.gradebook.feedback_sheets import FeedbackOptions, feedback_paper, feedback_sheet
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import placed_sheets
from coursework.gradebook.submissions import read_file
from coursework.issuing.issued import Issued
from coursework.issuing.issuing import distinct_variants
from coursework.issuing.practice import PracticeOf, unissued_seed
from coursework.issuing.protection import valid_variants
from coursework.language.typography import typeset
from coursework.language.words import words
from coursework.marking.marking import mark
from coursework.rendering.renderer import renderer_of
from coursework.sheets.following import follows_from
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Lesson

pytestmark = pytest.mark.e2e

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
    sheets = placed_sheets(COURSE, issued, read_file(write(tmp_path / "answers.csv", rows)))
    return feedback_paper(COURSE, issued, "Ada", list(marked(COURSE, issued, sheets)), lang, **more)


def test_a_paper_has_one_total_and_mark_and_counts_what_was_not_handed_in(tmp_path, issued_file):
    found = paper(tmp_path, issued_file(), answers("Ada", NAMES[0], 5))
    assert [s.handout.exercise for s in found.sheets] == list(NAMES)
    worth = [
        sum(p.points for p in COURSE[n].variant(s, "en", q).parts)
        for n, s, q in ((NAMES[0], 5, PARTS), (NAMES[1], 6, None))
    ]
    assert (found.points, found.out_of) == (worth[0], sum(worth))
    assert float(found.mark) == pytest.approx(20 * worth[0] / sum(worth), abs=0.25)
    assert {line.verdict for line in found.sheets[1].lines} == {"missing"}
    assert found.advice == (f"{found.sheets[1].handout.title} (0 / {worth[1]:g})",)


def test_the_heading_is_the_assignments_in_the_language_of_the_student(tmp_path, issued_file):
    heading = paper(tmp_path, issued_file(), answers("Ada", NAMES[0], 5), "fr").heading
    assert (heading.title, heading.course, heading.date) == ("Devoir 2", "Mechanics 2A", "4 décembre 2026")
    assert (heading.identity, heading.mark_of, heading.duration) == (
        (("Numéro d'étudiant", "117"),),
        "20",
        "1 h 30",
    )


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


def test_the_exercises_after_one_that_is_not_read_yet_keep_their_numbers(tmp_path, issued_file):
    rows = answers("Ada", NAMES[1], 6, s_plus_l="1 mm")
    found = paper(tmp_path, issued_file(), rows, waiting={NAMES[0]})
    assert "question 2.1" in found.advice[0]
    renderer = renderer_of(COURSE.folder)
    for page in (renderer.html(found), renderer.feedback_notebook(found)):
        assert {*re.findall(r"\b([0-9])[.][0-9](?=</strong>|[.]?[*][*])", page)} == {"2"}


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


# ----------------------------------------------------------- what to try next, and solutions


def marked_paper(tmp_path, issued_path, rows, lang="en", **telling):
    issued = Issued.read(issued_path)
    sheets = placed_sheets(COURSE, issued, read_file(write(tmp_path / "answers.csv", rows)))
    graded = list(marked(COURSE, issued, sheets))
    told = FeedbackOptions(PracticeOf(COURSE, issued), **telling)
    return feedback_paper(COURSE, issued, "Ada", graded, lang, telling=told)


def test_who_lost_points_is_told_another_variant_and_the_lesson_and_who_lost_none_is_not(
    tmp_path, issued_file
):
    rows = answers("Ada", NAMES[0], 5, rA="1 mm") + answers("Ada", NAMES[1], 6)
    lost, whole = marked_paper(tmp_path, issued_file(), rows).sheets
    assert whole.practice is None
    assert lost.practice.seed not in (None, 5)
    assert lost.practice.course == ""
    variant = COURSE[NAMES[0]].variant(lost.practice.seed)
    assert variant.given != COURSE[NAMES[0]].variant(5).given
    lesson = lost.practice.lessons[0]
    assert (lesson.name, lesson.title) == (
        "accelerations",
        "Accelerations: differentiate once more, and Coriolis",
    )
    assert [section.split(".")[0] for section in lesson.sections] == ["6", "7", "9"]
    french = marked_paper(tmp_path, issued_file(), rows, "fr").sheets[0].practice
    assert french.seed == lost.practice.seed
    assert french.lessons[0].title == lesson_title(COURSE.folder, "accelerations", "fr") != lesson.title


def test_what_is_told_to_look_at_is_what_the_quantity_follows_from(tmp_path, issued_file):
    rows = answers("Ada", NAMES[0], 5, rA="1 mm", theta4="")
    sheet = marked_paper(tmp_path, issued_file(), rows).sheets[0]
    lines = {line.question.id: line for line in sheet.lines}
    assert r"$r_1$, $\theta_1$, $r_2$ and $\theta_2$ (given)" in lines["theta4"].hint
    assert lines["rA"].hint == ""  # its message lists them
    assert r"$r_1$, $\theta_1$, $r_2$ and $\theta_2$" in lines["rA"].says
    solution = COURSE[NAMES[0]].variant(5, "en", PARTS).solution()
    assert not any(f"{value:.4g}" in line.hint for value in solution.values() for line in sheet.lines)
    right, blank = marked_paper(tmp_path, issued_file(), answers("Ada", NAMES[0], 5)).sheets
    assert {line.hint for line in right.lines} == {""}
    assert {line.hint for line in blank.lines} == {
        ""
    }  # nothing was tried: the lesson and the variant say more
    assert blank.practice is not None


def test_what_is_told_to_look_at_is_printed_on_the_sheet():
    """No case by its name in the code, and no number by which a mechanism was drawn."""
    for variant in (COURSE[name].variant(3, "en", (ALL,)) for name in COURSE.names):
        sheet = handout(variant)
        seen = {given.symbol for given in sheet.given if given.is_number}
        seen |= {COURSE[sheet.exercise].symbol(part.quantity) for part in variant.parts}
        for part in (part for part in variant.parts if not part.sort.is_open):
            told = follows_from(variant, part.quantity)
            assert {*re.findall(r"\$([^$]+)\$", told)} <= seen, (sheet.exercise, part.id, told)


@pytest.mark.parametrize("name", COURSE.names)
def test_the_variant_to_try_is_worth_issuing_and_was_issued_to_nobody(name):
    exercise = COURSE[name]
    issued = {seed: exercise.variant(seed).record for seed in range(1, 6)}
    found = unissued_seed(exercise, issued)
    assert found is not None
    assert found not in issued
    variant = exercise.variant(found)
    assert variant.record["given"] not in [record["given"] for record in issued.values()]
    assert valid_variants(exercise, [variant], Counter()) == [variant]
    assert unissued_seed(exercise, issued) == found


def test_where_every_variant_is_issued_one_that_is_not_the_students_is_offered(tmp_path, small_course):
    course = coursework.open_course(small_course)
    two = distinct_variants(course["crank_pin"], 1, 3, "en")
    items = [{"student": who, "record": v.record} for who, v in zip(("Ada", "Bo"), two[:2], strict=True)]
    issued = Issued.read(issue(tmp_path, items))
    offered = PracticeOf(course, issued)
    offered._fresh["crank_pin"] = None  # as where no variant is left
    assert offered.after("crank_pin", "Ada", "en").seed == two[1].seed
    assert offered.after("crank_pin", "Bo", "en").seed == two[0].seed
    assert offered.after("crank_pin", "Ada", "en").course == course.folder.root.name


@pytest.mark.parametrize("name", COURSE.names)
def test_the_cells_of_the_notebook_open_and_check_the_variant_to_try(tmp_path, monkeypatch, name):
    """The variant may ask other parts than the student's own."""
    monkeypatch.chdir(tmp_path)
    issued = Issued.read(
        issue(tmp_path, [{"student": "Ada", "record": COURSE[name].variant(9, "en").record}])
    )
    lines = dict(mark(COURSE[name].variant(9, "en"), {}))
    graded = Graded("Ada", name, 9, lines, (), COURSE[name].variant(9, "en").record)
    told = feedback_sheet(COURSE, graded, telling=FeedbackOptions(PracticeOf(COURSE, issued)))
    book = json.loads(renderer_of(COURSE.folder).feedback_notebook(told))
    opens, checks = ("".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code")
    names = {}
    exec(opens, names)
    exec(checks.replace("study.check", "shown = study.check"), names)
    assert str(told.practice.seed) in opens
    assert names["shown"] is not None


def test_a_course_may_offer_no_other_variant_and_says_which_lesson_teaches_what(tmp_path, small_course):
    settings = small_course / "exercises/course.toml"
    stated = settings.read_text("utf-8") if settings.exists() else ""
    lessons = small_course / "exercises/lessons"
    lessons.mkdir()
    (lessons / "rods.en.md").write_text("# Rods\n\n## 1. A rod\n\n## 2. Two rods\n", "utf-8")

    numbers = count()

    def after(text, lang="en"):
        settings.write_text(f"{stated}\n{text}", "utf-8")
        course = coursework.open_course(shutil.copytree(small_course, tmp_path / str(next(numbers))))
        record = course["crank_pin"].variant(1, "en").record
        issued = Issued.read(issue(tmp_path, [{"student": "Ada", "record": record}]))
        return PracticeOf(course, issued).after("crank_pin", "Ada", lang)

    assert after("[feedback]\npractice = false").seed is None
    assert after("").lessons == ()
    assert after('[lessons]\ncrank_pin = "rods"').lessons == (Lesson("rods", "Rods"),)
    of_two = after('[lessons]\ncrank_pin = { lesson = "rods", sections = [2] }').lessons
    assert of_two == (Lesson("rods", "Rods", ("2. Two rods",)),)
    assert after('[lessons]\ncrank_pin = "rods"', "fr").lessons == ()
    for wrong, told in (
        ('[lessons]\ncrank_pim = "rods"', "'crank_pim'; did you mean 'crank_pin'"),
        ('[lessons]\ncrank_pin = "rod"', "no lesson 'rod'; did you mean 'rods'"),
        ('[lessons]\ncrank_pin = { lesson = "rods", sections = [3] }', "no section 3; available: 1, 2"),
        ("[lessons]\ncrank_pin = 3", "found 3"),
        ('[lessons]\ncrank_pin = { lesson = "rods", parts = "x" }', r'write parts = \["x"\]; found \'x\''),
        ('[lessons]\ncrank_pin = { lesson = "rods", parts = ["w"] }', "has no question 'w'.*; available: "),
        ("[feedback]\npractise = false", "did you mean 'practice'"),
        ("[feedback]\npractice = 1", "practice is true or false"),
    ):
        with pytest.raises(BadCourse, match=told):
            after(wrong)


def test_every_lesson_that_the_course_names_is_there_in_every_language():
    stated = COURSE.folder.settings["lessons"]
    for name in stated:
        told = [taught_by(COURSE.folder, name, lang) for lang in ("fr", "en")]
        assert all(told)
        counted = [[len(lesson.sections) for lesson in lessons] for lessons in told]
        assert counted[0] == counted[1]


DAY = datetime.date(2026, 12, 5)


@pytest.mark.parametrize(
    ("stated", "form", "shown"),
    [
        ({}, FeedbackForm(), False),
        ({}, FeedbackForm(solutions=True), True),
        ({"solutions_after": "2026-12-05"}, FeedbackForm(today=DAY - datetime.timedelta(1)), False),
        ({"solutions_after": "2026-12-05"}, FeedbackForm(today=DAY), True),
        ({"solutions_after": "2026-12-05"}, FeedbackForm(solutions=True, today=DAY), True),
        ({"answers": "never"}, FeedbackForm(), False),
    ],
)
def test_solutions_are_shown_from_their_day_on_or_when_wanted(issued_file, stated, form, shown):
    assert shows_solutions(Issued.read(issued_file(**stated)), form) is shown


@pytest.mark.parametrize(
    ("stated", "told"),
    [
        ({"solutions_after": "2026-12-05"}, "before 2026-12-05"),
        ({"answers": "never"}, "never"),
        ({"solutions_after": "soon"}, "is a day such as"),
    ],
)
def test_solutions_are_never_shown_before_their_day(tmp_path, issued_file, stated, told, capsys):
    path = issued_file(**stated)
    with pytest.raises(BadInput, match=told):
        shows_solutions(Issued.read(path), FeedbackForm(solutions=True, today=DAY - datetime.timedelta(1)))
    file = write(tmp_path / "answers.csv", answers("Ada", NAMES[0], 5))
    asked = ["grade", str(file), "--issued", str(path), "--with-solutions", "--today", "2026-12-04"]
    assert run(asked) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "marks").exists()


def test_grade_writes_the_solution_into_every_format_from_the_day_on(tmp_path, issued_file):
    path = issued_file(solutions_after="2026-12-05")
    file = write(
        tmp_path / "answers.csv", answers("Ada", NAMES[0], 5, rA="1 mm") + answers("Ada", NAMES[1], 6)
    )
    said = words("en")["feedback"]["solution"]

    def texts(day):
        asked = ["grade", str(file), "--issued", str(path), "--formats", "pdf,html,ipynb", "--today", day]
        assert run(asked) == 0
        folder = tmp_path / "marks/feedback"
        assert sorted(p.name for p in folder.iterdir()) == ["ada.html", "ada.ipynb", "ada.pdf"]
        pdf = "".join(page_texts((folder / "ada.pdf").read_bytes()))
        return [pdf, *((folder / f"ada.{end}").read_text("utf-8") for end in ("html", "ipynb"))]

    assert all(said not in text for text in texts("2026-12-04"))
    assert all(text.count(said) == 1 for text in texts("2026-12-05"))
    # What an earlier marking wrote in other formats makes way.
    assert run(["grade", str(file), "--issued", str(path), "--today", "2026-12-04"]) == 0
    assert [p.name for p in (tmp_path / "marks/feedback").iterdir()] == ["ada.pdf"]


def test_exercises_that_are_no_assignment_stand_under_one_total(tmp_path):
    items = [{"student": "Ada", "record": COURSE[name].variant(5, "en").record} for name in NAMES]
    content = {"format": 1, "roster": True, "issued": items}
    (tmp_path / "issued.json").write_text(json.dumps(content), "utf-8")
    rows = [
        [student, name, seed, part, value]
        for name in NAMES
        for student, seed in [("Ada", 5)]
        for part, value in {p.id: "1" for p in COURSE[name].variant(5, "en").parts}.items()
    ]
    file = write(tmp_path / "answers.csv", rows)
    assert run(["grade", str(file), "--issued", str(tmp_path / "issued.json")]) in (0, 1)
    (made,) = (tmp_path / "marks/feedback").iterdir()
    first, *_ = page_texts(made.read_bytes())
    most = sum(part.points for name in NAMES for part in COURSE[name].variant(5, "en").parts)
    assert f"/ {most:g} points" in first
    titles = [COURSE[name].variant(5, "en").handout().title for name in NAMES]
    assert all(typeset(title, "en") in first for title in titles)
    assert "Exercise 1." not in first
    assert words("en")["feedback"]["right"] not in first
