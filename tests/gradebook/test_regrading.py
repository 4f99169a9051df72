"""Marking again: old records, corrected exercises, answers accepted by hand, and what changed for whom."""

from __future__ import annotations

import csv
import json
import shutil
import sys
from datetime import date

import pytest
from tables import each_row

import coursework
from coursework.authoring.scaffold import new_course
from coursework.cli import run
from coursework.errors import BadInput
from coursework.gradebook.class_marking import _waiting, marked
from coursework.gradebook.feedback_sheets import feedback_sheet
from coursework.gradebook.placing import placed_sheets
from coursework.gradebook.submissions import read_file
from coursework.issuing.issued import Issued
from coursework.rendering.renderer import renderer_of

SOLUTION = "solutions/crank_pin.py"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Three students of the small course, their sheets and their answers, all right by its first version."""
    tmp_path = tmp_path_factory.mktemp("built")
    small_course = tmp_path / "small"
    new_course(small_course)
    roster = tmp_path / "class.csv"
    roster.write_text("student\nAda\nBo\nCy\n", "utf-8")
    out = tmp_path / "out"
    assert course_run(small_course, "build", "--roster", roster, "--formats", "html", "--out", out) == 0
    rows = []
    course = coursework.open_course(small_course)
    for item in json.loads((out / "issued.json").read_text("utf-8"))["issued"]:
        variant = course["crank_pin"].from_record(item["record"])
        rows += [[item["student"], "crank_pin", variant.seed, p, v] for p, v in variant.solution().items()]
    rows[1][4] = "somewhere"
    with (tmp_path / "answers.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["student", "exercise", "seed", "part", "answer"], *rows])
    return tmp_path


@pytest.fixture
def issued(built, small_course, tmp_path):
    """What was built, for one test alone."""
    for name in ("class.csv", "answers.csv"):
        shutil.copy(built / name, tmp_path / name)
    return shutil.copytree(built / "out", tmp_path / "out")


def course_run(folder, *arguments):
    return run(["--course", str(folder), *map(str, arguments)])


def grade(folder, out, *more):
    answers = out.parent / "answers.csv"
    return course_run(folder, "grade", answers, "--issued", out / "issued.json", "--no-feedback", *more)


def table(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def copy_of(course, tmp_path, name="second"):
    """The course in another folder: what is imported once is not imported again."""
    shutil.copytree(course, tmp_path / name)
    return tmp_path / name


def test_marking_again_gives_the_same_and_says_that_nothing_changed(small_course, issued):
    assert grade(small_course, issued) == 1  # one answer must be looked at
    first = (issued / "marks" / "marks.csv").read_bytes()
    assert not (issued / "marks" / "changes.csv").exists()
    assert grade(small_course, issued) == 1
    assert (issued / "marks" / "marks.csv").read_bytes() == first
    assert table(issued / "marks" / "changes.csv") == []


def test_a_corrected_solution_says_what_changed_and_for_whom(small_course, issued, tmp_path, capsys):
    grade(small_course, issued)
    corrected = copy_of(small_course, tmp_path)
    solution = corrected / SOLUTION
    text = solution.read_text("utf-8")
    solution.write_text(text.replace("return r * omega\n", "return 2 * r * omega\n"), "utf-8")
    capsys.readouterr()
    grade(corrected, issued)
    assert "3 marks changed" in capsys.readouterr().out
    changes = table(issued / "marks" / "changes.csv")
    assert [c["student"] for c in changes] == ["Ada", "Bo", "Cy"]
    assert {c["part"] for c in changes} == {"v"}
    assert {c["verdict_before"] for c in changes} == {"correct"}
    assert {c["points_now"] for c in changes} == {"1"}  # half of them: a factor is missing


def test_a_record_of_an_older_version_keeps_its_data_its_parts_and_their_points(
    small_course, issued, tmp_path
):
    newer = copy_of(small_course, tmp_path)
    path = newer / "exercises" / "crank_pin.py"
    text = path.read_text("utf-8")
    text = text.replace("drawn(50, 200, step=5", "drawn(500, 900, step=5")  # seeds draw something else now
    text = text.replace('Part("v", unit="mm/s", points=2)', 'Part("v", unit="mm/s", points=7)')
    text = text.replace("    figure=figure,\n)", "    figure=figure,\n    version=2,\n)")
    path.write_text(text, "utf-8")
    exercise = coursework.open_course(newer)["crank_pin"]
    assert exercise.version == 2
    record = json.loads((issued / "issued.json").read_text("utf-8"))["issued"][0]["record"]
    old = exercise.from_record(record)
    assert old.given["r"] <= 200 < exercise.variant(record["seed"]).given["r"]
    assert [p.points for p in old.parts] == [1, 1, 2]
    assert old.record["version"] == 1
    grade(newer, issued)
    marks = table(issued / "marks" / "marks.csv")
    assert [m["verdict"] for m in marks if m["student"] != "Ada"] == ["correct"] * 6
    assert sum(float(m["out_of"]) for m in marks) == 3 * 4


def test_a_record_that_the_course_cannot_honour_is_refused(small_course, issued, tmp_path):
    record = json.loads((issued / "issued.json").read_text("utf-8"))["issued"][0]["record"]
    exercise = coursework.open_course(small_course)["crank_pin"]
    with pytest.raises(BadInput, match="of version 5"):
        exercise.from_record({**record, "version": 5})
    newer = copy_of(small_course, tmp_path)
    path = newer / "exercises" / "crank_pin.py"
    text = path.read_text("utf-8").replace('        Part("y", unit="mm"),\n', "")
    path.write_text(text.replace("    figure=figure,\n)", "    figure=figure,\n    version=2,\n)"), "utf-8")
    with pytest.raises(BadInput, match="'y', which the course no longer has"):
        coursework.open_course(newer)["crank_pin"].from_record(record)


def test_a_mark_is_replayed_from_its_record_alone(small_course, issued):
    grade(small_course, issued)
    records = {
        item["student"]: item["record"]
        for item in json.loads((issued / "issued.json").read_text("utf-8"))["issued"]
    }
    course = coursework.open_course(small_course)
    for line in table(issued / "marks" / "marks.csv"):
        variant = course["crank_pin"].from_record(records[line["student"]])
        mark = _waiting(variant.grade({line["part"]: line["answer"]})[line["part"]])
        assert (mark.verdict, f"{mark.points:g}", mark.feedback) == (
            line["verdict"],
            line["points"],
            line["feedback"],
        )


def test_an_answer_accepted_by_hand_stays_accepted(small_course, issued, capsys):
    grade(small_course, issued)
    kept = issued / "marks" / "accepted.csv"
    kept.write_text("student,exercise,part,points,reason\nada,crank_pin,y,0.5,Correct on paper.\n", "utf-8")
    assert grade(small_course, issued) == 0  # nothing is left to be looked at
    (change,) = table(issued / "marks" / "changes.csv")
    assert (change["student"], change["part"]) == ("Ada", "y")
    assert (change["verdict_before"], change["verdict_now"]) == ("unreadable", "accepted")
    line = next(m for m in table(issued / "marks" / "marks.csv") if m["verdict"] == "accepted")
    assert (line["points"], line["answer"]) == ("0.5", "somewhere")
    assert line["feedback"].endswith("Correct on paper.")
    ada = table(issued / "marks" / "summary.csv")[0]
    assert (ada["student"], ada["points"], ada["accepted"]) == ("Ada", "3.5", "1")
    assert grade(small_course, issued) == 0
    assert table(issued / "marks" / "changes.csv") == [change], "the same run once more empties nothing"
    kept.write_text("student,exercise,part,points\nada,crank_pin,y,1\n", "utf-8")
    assert grade(small_course, issued) == 0
    first, second = table(issued / "marks" / "changes.csv")
    assert first == change
    assert date.fromisoformat(second["date"]) >= date.fromisoformat(first["date"])
    assert [(c["points_before"], c["points_now"]) for c in (first, second)] == [("0", "0.5"), ("0.5", "1")]
    assert [(c["mark_before"], c["mark_now"]) for c in (first, second)] == [("15", "17.5"), ("17.5", "20")]


@each_row(
    ("text", "told"),
    [
        ("student,exercise,part,points\nAda,crank_pin,y,half\n", "points are a number"),
        (
            "student,exercise,part,points\nAda,crank_pin,y,nan\n",
            "points are a number, 0 or more; found 'nan'",
        ),
        ("student,exercise,part,points\nAda,crank_pin,y,inf\n", "points are a number"),
        ("student,exercise,part,points\nAda,crank_pin,y,-5\n", "line 2: points are a number, 0 or more"),
        ("student,exercise,part,points\nAda,crank_pin,y,1.5\n", "line 2: 1.5 points for y, which has 1"),
        ("student,exercise,part\nAda,crank_pin,\n", "part missing"),
    ],
)
def test_an_acceptance_that_makes_no_sense_is_told(small_course, issued, tmp_path, capsys, text, told):
    path = tmp_path / "by_hand.csv"
    path.write_text(text, "utf-8")
    assert grade(small_course, issued, "--accepted", path) == 2
    assert told in capsys.readouterr().err
    assert not (issued / "marks" / "marks.csv").exists()


def test_an_acceptance_of_what_nobody_answered_is_a_note(small_course, issued, tmp_path, capsys):
    path = tmp_path / "by_hand.csv"
    path.write_text("student,exercise,part\nDee,crank_pin,y\n", "utf-8")
    grade(small_course, issued, "--accepted", path)
    assert "never answered: Dee, crank_pin, y" in capsys.readouterr().err


def test_a_part_accepted_without_an_answer_has_its_line(small_course, issued, capsys):
    path = issued.parent / "answers.csv"
    lines = path.read_text("utf-8").splitlines(keepends=True)
    path.write_text("".join(line for line in lines if ",y," not in line), "utf-8")
    (issued / "marks").mkdir()
    (issued / "marks" / "accepted.csv").write_text("student,exercise,part\nBo,crank_pin,y\n", "utf-8")
    assert grade(small_course, issued) == 0
    assert "6 rows: 6 marked, 0 rejected" in capsys.readouterr().out
    marks = table(issued / "marks" / "marks.csv")
    (line,) = (m for m in marks if m["verdict"] == "accepted")
    assert (line["student"], line["part"], line["answer"], line["points"]) == ("Bo", "y", "", "1")
    summary = table(issued / "marks" / "summary.csv")
    for one in summary:
        assert float(one["points"]) == sum(
            float(m["points"]) for m in marks if m["student"] == one["student"]
        )


def test_names_that_look_alike_are_one_in_every_file(small_course, tmp_path):
    """Roster, answers, acceptance and earlier marks, with accents and apostrophes as different systems write
    them."""
    names = ["José García", "Bob O'Neil"]
    (tmp_path / "class.csv").write_text("\n".join(["student", *names]), "utf-8")
    out, alike = tmp_path / "out", ["Jose\u0301  GARCI\u0301A", "bob o’neil"]
    assert (
        course_run(
            small_course, "build", "--roster", tmp_path / "class.csv", "--formats", "html", "--out", out
        )
        == 0
    )
    rows = [f"{name},crank_pin,,{part},1" for name in alike for part in ("x", "y")]
    (tmp_path / "answers.csv").write_text("\n".join(["student,exercise,seed,part,answer", *rows]), "utf-8")
    (tmp_path / "by_hand.csv").write_text("student,exercise,part\nBOB O‘NEIL,crank_pin,x\n", "utf-8")
    assert grade(small_course, out, "--accepted", tmp_path / "by_hand.csv") == 0
    marks = out / "marks" / "marks.csv"
    assert [(m["student"], m["verdict"] == "accepted") for m in table(marks)] == [
        (names[0], False),
        (names[0], False),
        (names[1], True),
        (names[1], False),
    ]
    text = marks.read_text("utf-8")
    marks.write_text(text.replace(names[0], alike[0]).replace(names[1], alike[1]), "utf-8")
    assert grade(small_course, out, "--accepted", tmp_path / "by_hand.csv") == 0
    assert table(out / "marks" / "changes.csv") == []


def test_without_a_roster_a_name_is_shown_as_it_came_first(small_course, tmp_path):
    out = tmp_path / "out"
    assert course_run(small_course, "build", "--formats", "html", "--out", out) == 0
    (record,) = (i["record"] for i in json.loads((out / "issued.json").read_text("utf-8"))["issued"])
    rows = [
        f"{name},crank_pin,{record['seed']},{part},1" for name, part in (("Zoé", "x"), ("ZOE\u0301", "y"))
    ]
    (tmp_path / "answers.csv").write_text("\n".join(["student,exercise,seed,part,answer", *rows]), "utf-8")
    assert grade(small_course, out) == 0
    assert [s["student"] for s in table(out / "marks" / "summary.csv")] == ["Zoé"]


@pytest.fixture
def named(small_course, tmp_path):
    """A sheet for each name of a roster; gives the form to fill and the folder of the build."""

    def make(*names):
        (tmp_path / "class.csv").write_text("\n".join(["student", *names]), "utf-8")
        out = tmp_path / "out"
        made = ["--roster", tmp_path / "class.csv", "--formats", "html", "--out", out]
        assert course_run(small_course, "build", *made) == 0
        return out / "answers.csv", out

    return make


def test_tables_saved_by_excel_are_read_again(small_course, named, tmp_path):
    form, out = named("José García", "Zoë")
    (tmp_path / "answers.csv").write_text(form.read_text("utf-8"), "utf-8")
    accepted = out / "marks" / "accepted.csv"
    accepted.parent.mkdir()
    accepted.write_bytes("student;exercise;part;reason\nJosé García;crank_pin;y;très bien\n".encode("cp1252"))
    assert grade(small_course, out) == 0
    marks = out / "marks" / "marks.csv"
    (line,) = (m for m in table(marks) if m["verdict"] == "accepted")
    assert (line["student"], line["feedback"].endswith("très bien")) == ("José García", True)
    marks.write_bytes(marks.read_text("utf-8-sig").encode("cp1252"))
    assert grade(small_course, out) == 0
    assert table(out / "marks" / "changes.csv") == []


def test_a_name_made_inert_is_the_same_student(small_course, named, tmp_path):
    """In the form, in the marks that were there before, and where an answer is accepted."""
    form, out = named("=Evil(1)", "-Bo (2)")
    assert "'=Evil(1)" in form.read_text("utf-8")
    (tmp_path / "answers.csv").write_text(form.read_text("utf-8").replace(",x,", ",x,'=2*(3+4)"), "utf-8")
    (tmp_path / "by_hand.csv").write_text("student,exercise,part\n'=Evil(1),crank_pin,y\n", "utf-8")
    for _ in range(2):
        assert grade(small_course, out, "--accepted", tmp_path / "by_hand.csv") == 0
    assert table(out / "marks" / "rejected.csv") == table(out / "marks" / "changes.csv") == []
    marks = table(out / "marks" / "marks.csv")
    assert [m["student"] for m in marks] == ["'=Evil(1)"] * 3 + ["'-Bo (2)"] * 3
    assert {m["answer"] for m in marks} == {"", "'=2*(3+4)"}
    assert [m["part"] for m in marks if m["verdict"] == "accepted"] == ["y"]


def test_an_interrupted_marking_leaves_the_marks_that_were_there(small_course, issued, monkeypatch):
    grade(small_course, issued)
    before = {p.name: p.read_bytes() for p in (issued / "marks").iterdir()}
    from coursework.gradebook import book as gradebook
    from coursework.gradebook.grading import grade_files

    def breaks(graded):
        raise KeyboardInterrupt

    monkeypatch.setattr(gradebook, "marks_rows", breaks)
    answers = [issued.parent / "answers.csv"]
    course = coursework.open_course(small_course)
    with pytest.raises(KeyboardInterrupt):
        grade_files(course, answers, issued / "issued.json", issued / "marks", feedback=False)
    assert {p.name: p.read_bytes() for p in (issued / "marks").iterdir()} == before


@pytest.mark.parametrize("name", ["marks.csv", "summary.csv", "rejected.csv", "changes.csv"])
@pytest.mark.parametrize("late", [False, True])
def test_a_table_that_cannot_be_replaced_costs_no_other(
    small_course, issued, monkeypatch, capsys, name, late
):
    """Whether it is so from the start, or becomes so while the answers are marked."""
    grade(small_course, issued)
    grade(small_course, issued, "--accepted", _accepting(issued))
    from coursework.gradebook import book as gradebook

    path = issued / "marks" / name
    rows = gradebook.summary_rows

    def obstruct(*given):
        path.unlink()
        path.mkdir()
        return rows(*given) if given else None

    monkeypatch.setattr(gradebook, "summary_rows", obstruct if late else rows)
    if not late:
        obstruct()
    before = {p.name: p.read_bytes() for p in (issued / "marks").iterdir() if p.name != name}
    capsys.readouterr()
    assert grade(small_course, issued) == 2
    assert f"{name} cannot be" in capsys.readouterr().err
    assert {p.name: p.read_bytes() for p in (issued / "marks").iterdir() if p.name != name} == before


def _accepting(issued):
    path = issued.parent / "by_hand.csv"
    path.write_text("student,exercise,part\nAda,crank_pin,y\n", "utf-8")
    return path


def test_answers_to_another_course_are_told_which_option_names_it(small_course, issued, capsys):
    assert run(["grade", str(issued.parent / "answers.csv"), "--issued", str(issued / "issued.json")]) == 2
    said = capsys.readouterr().err
    assert "no exercise 'crank_pin'" in said
    assert "--course FOLDER" in said
    assert "slotted_mechanism" not in said


def test_what_is_left_to_look_at_is_said(small_course, issued, capsys):
    assert grade(small_course, issued) == 1
    assert "1 unreadable answer to look at: verdict unreadable in" in capsys.readouterr().out
    answers = issued.parent / "answers.csv"
    answers.write_text(answers.read_text("utf-8").replace("somewhere", "3"), "utf-8")
    assert grade(small_course, issued) == 0
    assert "unreadable" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("lang", "told"), [("en", "somebody will look at it"), ("fr", "quelqu’un y regardera")]
)
def test_who_wrote_what_cannot_be_read_is_told_that_somebody_will_look(small_course, issued, lang, told):
    content = json.loads((issued / "issued.json").read_text("utf-8"))
    for item in content["issued"]:
        item["record"]["lang"] = lang
    (issued / "issued.json").write_text(json.dumps(content), "utf-8")
    assert grade(small_course, issued) == 1
    said = {m["verdict"]: m["feedback"] for m in table(issued / "marks" / "marks.csv")}
    assert told in said["unreadable"]
    assert told not in said["correct"]
    course, kept = coursework.open_course(small_course), Issued.read(issued / "issued.json")
    sheets = placed_sheets(course, kept, list(read_file(issued.parent / "answers.csv")))
    pages = [
        renderer_of(course.folder).html(feedback_sheet(course, graded))
        for graded in marked(course, kept, sheets)
    ]
    assert [told in page for page in pages] == [True, False, False]


@pytest.mark.parametrize("roster", [True, False])
def test_a_notebook_that_cannot_be_read_was_handed_in(small_course, issued, capsys, roster):
    """And so was one row that is rejected beside others that are marked."""
    content = json.loads((issued / "issued.json").read_text("utf-8"))
    if not roster:
        content["roster"] = False
        content["issued"] = [{**item, "student": ""} for item in content["issued"]]
        (issued / "issued.json").write_text(json.dumps(content), "utf-8")
    answers = issued.parent / "answers.csv"
    lines = [line for line in answers.read_text("utf-8").splitlines() if not line.startswith("Cy")]
    lines[2] += ",1"
    answers.write_text("\n".join(lines), "utf-8")
    about = {"student": "Cy", "exercise": "crank_pin", "seed": content["issued"][2]["record"]["seed"]}
    cell = {"cell_type": "code", "metadata": {"tags": ["answers"]}, "source": 'answers = {"y": "1" "x": "2"}'}
    notebook = json.dumps({"metadata": {"coursework": about}, "cells": [cell]})
    (issued.parent / "cy.ipynb").write_text(notebook, "utf-8")
    where = ["--issued", issued / "issued.json", "--no-feedback"]
    assert course_run(small_course, "grade", answers, issued.parent / "cy.ipynb", *where) == 1
    rows = table(issued / "marks" / "summary.csv")
    asked = len(content["issued"][0]["record"]["parts"])
    assert [(r["student"], int(r["unreadable"]), int(r["missing"])) for r in rows] == [
        ("Ada", 1, 0),
        ("Bo", 0, 0),
        ("Cy", asked, 0),
    ]
    assert {r["out_of"] for r in rows} == {rows[0]["out_of"]}
    capsys.readouterr()
    assert course_run(small_course, "report", issued / "marks", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["students"], told["handed_in_nothing"], told["handed_in_unreadable"]) == (3, 0, 1)
    assert told["asked_without_line"] == 0


def test_marks_mended_by_hand_are_kept_beside_those_that_replace_them(small_course, issued, capsys):
    grade(small_course, issued)
    marks = issued / "marks"
    mended = (marks / "marks.csv").read_text("utf-8").replace(",unreadable,0,", ',correct,"0,5",')
    (marks / "marks.csv").write_text(mended, "utf-8")
    capsys.readouterr()
    for kept in ("marks.before.csv", "marks.before-2.csv"):
        assert grade(small_course, issued) == 1
        said = capsys.readouterr().err
        assert "had been edited" in said
        assert kept in said
        assert "decisions.csv" in said
        assert (marks / kept).read_text("utf-8") == mended
        (marks / "marks.csv").write_text(mended, "utf-8")


@pytest.mark.parametrize(
    "again", ["nothing", "saved by a spreadsheet", "another answer", "mended, then accepted"]
)
def test_marks_that_nobody_edited_are_replaced_without_a_word(small_course, issued, capsys, again):
    grade(small_course, issued)
    marks, answers = issued / "marks", issued.parent / "answers.csv"
    written = (marks / "marks.csv").read_text("utf-8")
    if again == "another answer":
        answers.write_text(answers.read_text("utf-8").replace("somewhere", "3"), "utf-8")
    if again == "saved by a spreadsheet":
        (marks / "marks.csv").write_text(written.replace("\n", "\r\n"), "utf-8-sig")
    if again == "mended, then accepted":
        (marks / "marks.csv").write_text(written.replace(",unreadable,0,", ",accepted,1,"), "utf-8")
        (marks / "accepted.csv").write_text("student,exercise,part\nAda,crank_pin,y\n", "utf-8")
    capsys.readouterr()
    grade(small_course, issued)
    assert "edited" not in capsys.readouterr().err
    assert not list(marks.glob("marks.before*"))


def test_feedback_replaces_its_own_sheets_and_no_other_file(small_course, issued):
    feedback = issued / "marks" / "feedback"
    answers, where = issued.parent / "answers.csv", ["--issued", issued / "issued.json", "--feedback"]
    assert course_run(small_course, "grade", answers, *where) == 1
    assert {p.name for p in feedback.iterdir()} == {"ada.pdf", "bo.pdf", "cy.pdf"}
    (feedback / "notes.md").write_text("mine", "utf-8")
    (feedback / "old").mkdir()
    (feedback / "old" / "ada.pdf").write_bytes(b"mine")
    lines = [line for line in answers.read_text("utf-8").splitlines() if not line.startswith("Cy")]
    answers.write_text("\n".join(lines), "utf-8")
    assert course_run(small_course, "grade", answers, *where) == 1
    found = {p.relative_to(feedback).as_posix() for p in feedback.rglob("*") if p.is_file()}
    assert found == {"ada.pdf", "bo.pdf", "notes.md", "old/ada.pdf"}, "Cy has no marks any more"


@pytest.mark.parametrize(
    "content",
    [
        None,
        {},
        {"a.docx": "x"},
        {"a.ipynb": "{"},
        {"a.csv": ""},
        {"a.csv": "form"},
        {"a.csv": "student,exercise,seed,part,answer\nZoe,crank_pin,1,y,3\n"},
    ],
)
def test_answers_in_which_nothing_can_be_marked_leave_the_marks_that_were_there(
    small_course, issued, capsys, content
):
    grade(small_course, issued)
    marks = issued / "marks"
    (marks / "feedback").mkdir()
    (marks / "feedback" / "ada.pdf").write_bytes(b"before")
    before = {p: p.read_bytes() for p in marks.rglob("*") if p.is_file()}
    capsys.readouterr()
    other = issued.parent / "retuned"
    if content is not None:
        other.mkdir()
        for name, text in content.items():
            (other / name).write_text(
                "student,exercise,seed,part,answer\n" if text == "form" else text, "utf-8"
            )
    assert course_run(small_course, "grade", other, "--issued", issued / "issued.json", "--out", marks) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert ("no such file or folder" if content is None else "nothing is written") in said
    assert {p: p.read_bytes() for p in marks.rglob("*") if p.is_file()} == before


def test_parquet_marks_as_csv_does(small_course, issued, tmp_path):
    import pyarrow
    from pyarrow import parquet

    grade(small_course, issued, "--out", tmp_path / "by_csv")
    with (tmp_path / "answers.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    columns = {c: [r[c] for r in rows] for c in rows[0]}
    columns["seed"] = [int(s) for s in columns["seed"]]
    parquet.write_table(pyarrow.table(columns), tmp_path / "answers.parquet")
    where = ["--issued", str(issued / "issued.json"), "--no-feedback", "--out", str(tmp_path / "by_parquet")]
    assert course_run(small_course, "grade", tmp_path / "answers.parquet", *where) == 1
    assert (tmp_path / "by_parquet" / "marks.csv").read_bytes() == (
        tmp_path / "by_csv" / "marks.csv"
    ).read_bytes()


def test_a_parquet_file_that_is_none_is_rejected_with_its_reason(small_course, issued, tmp_path, capsys):
    (tmp_path / "odd.parquet").write_bytes(b"PAR?")
    where = ["--issued", str(issued / "issued.json"), "--no-feedback", "--out", str(tmp_path / "m")]
    assert course_run(small_course, "grade", tmp_path / "odd.parquet", *where) == 2
    assert "not a Parquet file" in capsys.readouterr().err
    answers = issued.parent / "answers.csv"
    assert course_run(small_course, "grade", answers, tmp_path / "odd.parquet", *where) == 1
    (rejected,) = table(tmp_path / "m" / "rejected.csv")
    assert "not a Parquet file" in rejected["reason"]


@pytest.mark.e2e
def test_many_answers_are_marked_by_processes_as_by_one(small_course, issued, tmp_path, monkeypatch):
    from coursework.gradebook import class_marking

    grade(small_course, issued, "--out", tmp_path / "one")
    monkeypatch.setattr(class_marking, "WORTH_PROCESSES", 0)
    monkeypatch.setattr(class_marking, "CHUNK", 1)
    monkeypatch.setattr(class_marking, "workers", lambda *_: 2)
    grade(small_course, issued, "--out", tmp_path / "many")
    for name in ("marks.csv", "summary.csv", "rejected.csv"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "many" / name).read_bytes()


@pytest.mark.parametrize(
    ("fault", "told"),
    [
        ("AttributeError('_ARRAY_API not found')", "cannot be loaded (AttributeError: _ARRAY_API not found)"),
        (
            "ImportError('numpy.core.multiarray failed to import')",
            "cannot be loaded (ImportError: numpy.core",
        ),
    ],
)
def test_a_pyarrow_that_cannot_be_loaded_is_told_as_such(
    small_course, issued, tmp_path, monkeypatch, capsys, fault, told
):
    (tmp_path / "libraries" / "pyarrow").mkdir(parents=True)
    (tmp_path / "libraries" / "pyarrow" / "__init__.py").write_text(f"raise {fault}\n", "utf-8")
    monkeypatch.syspath_prepend(tmp_path / "libraries")
    for name in [n for n in sys.modules if n.partition(".")[0] == "pyarrow"]:
        monkeypatch.delitem(sys.modules, name)
    (tmp_path / "odd.parquet").write_bytes(b"PAR?")
    where = ["--issued", str(issued / "issued.json"), "--no-feedback"]
    assert course_run(small_course, "grade", tmp_path / "odd.parquet", *where) == 2
    said = capsys.readouterr().err
    assert told in said
    assert "not installed" not in said
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    assert course_run(small_course, "grade", tmp_path / "odd.parquet", *where) == 2
    assert "Parquet needs pyarrow, which is not installed" in capsys.readouterr().err


# ------------------------------------------------------------ typing errors in what is accepted


def seed_of(issued, student):
    items = json.loads((issued / "issued.json").read_text("utf-8"))["issued"]
    return next(i["record"]["seed"] for i in items if i["student"] == student)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("Adda,crank_pin,,y", "no student 'Adda' on the roster; did you mean 'Ada'?"),
        ("Ada,crank_pim,,y", "no exercise 'crank_pim' was issued; did you mean 'crank_pin'?"),
        ("Ada,crank_pin,,yy", "crank_pin has no part 'yy'; did you mean 'y'?"),
        ("Ada,crank_pin,9999,y", "seed 9999 of crank_pin was not issued; Ada has seed {Ada}"),
        ("Ada,crank_pin,{Bo},y", "seed {Bo} of crank_pin is another student's; Ada has seed {Ada}"),
        ("Ada,crank_pin,x,y", "a seed is a whole number; found 'x'"),
    ],
)
def test_an_acceptance_that_names_nobody_is_told_with_the_nearest_name_and_its_line(
    small_course, issued, tmp_path, capsys, line, told
):
    """A blank line and a good one stand before it: the good one counts, and nothing is lost."""
    seeds = {student: seed_of(issued, student) for student in ("Ada", "Bo")}
    path, good = tmp_path / "by_hand.csv", "Ada,crank_pin,,y"
    path.write_text(f"student,exercise,seed,part\n\n{good}\n{line.format(**seeds)}\n", "utf-8")
    assert grade(small_course, issued, "--accepted", path) == 1
    said = capsys.readouterr().err
    assert f"by_hand.csv, line 4: accepted by hand, but never answered: {line.split(',')[0]}" in said
    assert told.format(**seeds) in said
    assert "note:" not in said
    assert [m["verdict"] for m in table(issued / "marks" / "marks.csv")].count("accepted") == 1
    path.write_text(f"student,exercise,seed,part\n{good}\n", "utf-8")
    assert grade(small_course, issued, "--accepted", path) == 0


def test_an_acceptance_of_a_sheet_that_was_issued_and_not_handed_in_is_a_note(
    small_course, issued, tmp_path, capsys
):
    answers = issued.parent / "answers.csv"
    lines = answers.read_text("utf-8").splitlines(keepends=True)
    answers.write_text("".join(li for li in lines if not li.startswith(("Cy", "Ada"))), "utf-8")
    path = tmp_path / "by_hand.csv"
    path.write_text("student,exercise,part\nCy,crank_pin,y\n", "utf-8")
    assert grade(small_course, issued, "--accepted", path) == 0
    assert "note: accepted by hand, but never answered: Cy, crank_pin, y" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("lines", "points", "told"),
    [
        (["Ada,crank_pin,,y,1", "Ada,crank_pin,,y,0.5"], "0.5", "line 3: points 0.5 for Ada, crank_pin, y"),
        (["ADA,crank_pin,{Ada},y,0.25", "Ada,crank_pin,,y,"], "1", "line 3: full points for Ada"),
        (["Ada,crank_pin,,y,", "Ada,crank_pin,{Ada},y,0.25"], "0.25", "but full points in line 2"),
        (["Ada,crank_pin,,y,1", "Ada,crank_pin,{Ada}.0,y,"], "1", ""),
        (["Ada,crank_pin,,y,1", "Bo,crank_pin,,y,0"], "1", ""),
    ],
)
def test_lines_that_contradict_one_another_are_told_and_the_later_one_counts(
    small_course, issued, tmp_path, capsys, lines, points, told
):
    path = tmp_path / "by_hand.csv"
    rows = [line.format(Ada=seed_of(issued, "Ada")) for line in lines]
    path.write_text("\n".join(["student,exercise,seed,part,points", *rows]), "utf-8")
    assert grade(small_course, issued, "--accepted", path) == (1 if told else 0)
    said = capsys.readouterr().err
    assert told in said if told else said == ""
    marks = table(issued / "marks" / "marks.csv")
    assert [m["points"] for m in marks if (m["student"], m["part"]) == ("Ada", "y")] == [points]


def test_a_misspelt_heading_of_what_is_accepted_is_told(small_course, issued, tmp_path, capsys):
    path = tmp_path / "by_hand.csv"
    path.write_text("student,exercise,part,point,note\nAda,crank_pin,y,0.5,oral\n", "utf-8")
    assert grade(small_course, issued, "--accepted", path) == 1
    assert "line 1: the column 'point' is not read; did you mean 'points'?" in capsys.readouterr().err


def test_points_cut_at_their_comma_are_refused(small_course, issued, tmp_path, capsys):
    path = tmp_path / "by_hand.csv"
    path.write_text("student,exercise,part,points\nAda,crank_pin,y,0,5\n", "utf-8")
    assert grade(small_course, issued, "--accepted", path) == 2
    assert "line 2: 1 cell more than there are headings, '5'" in capsys.readouterr().err


def test_without_a_roster_an_acceptance_is_held_against_those_who_answered(small_course, tmp_path, capsys):
    out = tmp_path / "out"
    assert course_run(small_course, "build", "--formats", "html", "--out", out) == 0
    (record,) = (i["record"] for i in json.loads((out / "issued.json").read_text("utf-8"))["issued"])
    row = f"Zoé Lang,crank_pin,{record['seed']},x,1"
    (tmp_path / "answers.csv").write_text(f"student,exercise,seed,part,answer\n{row}\n", "utf-8")
    path = tmp_path / "by_hand.csv"
    path.write_text("student,exercise,part\nZoë Lang,crank_pin,x\nzoé lang,crank_pin,w\n", "utf-8")
    assert grade(small_course, out, "--accepted", path) == 1
    said = capsys.readouterr().err
    assert "no student 'Zoë Lang' among those who answered; did you mean 'Zoé Lang'?" in said
    assert (
        "line 3: accepted by hand, but never answered: zoé lang, crank_pin, w; crank_pin has no part" in said
    )
