"""Answers typed from paper, a line for each student; and the columns of the roster that come back with the
marks."""

import csv
import re

import pytest
from small_assignment import table

import coursework
from coursework.cli import run
from coursework.gradebook.submissions import read_file
from coursework.issuing.assignment import AskedExercise, Assignment
from coursework.issuing.issued import Issued, issued_content
from coursework.issuing.issuing import Issue
from coursework.issuing.questions import PaperQuestions
from coursework.issuing.wide_form import wide_form

ROSTER = (
    "student,number,group,date de naissance,extra_time\nAda,101,A,2005-01-02,yes\nBo,102,B,2005-03-04,\n"
    "Cy,103,B,2005-05-06,\n"
)


@pytest.fixture
def built(small_course, tmp_path):
    (tmp_path / "class.csv").write_text(ROSTER)
    (tmp_path / "exam.toml").write_text(
        'roster = "class.csv"\nidentity = ["number"]\nmark = { of = 20, step = 0.5 }\n'
        f'formats = "ipynb"\nsolutions = false\nsecret = "{"0123456789abcdef" * 2}"\n[[exercises]]\n'
        'name = "crank_pin"\n'
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
        ("Ada", "3", "0", "0"),
        ("Bo", "1", "1", "1"),
        ("Cy", "0", "0", "3"),
    ]
    rejected = [
        (r["student"], r["source"].rpartition("typed.csv, ")[2], r["reason"])
        for r in table(out / "marks" / "rejected.csv")
    ]
    assert rejected == [
        ("Eve", "line 5, 1.1 crank_pin x (mm)", "no student 'Eve' on the roster"),
        ("Bo", "line 6", "6 cells where the header has 5"),
    ]


def test_number_and_group_are_found_under_the_titles_of_a_registry(small_course, tmp_path, capsys):
    """``number`` and ``group`` name columns by what they hold: on the paper, in the form and in the summary.
    No note says that one lacks, nor on an anonymous exam, whose papers print none."""
    titles = "N° étudiant;Nom;Prénom;groupe de TD"
    (tmp_path / "class.csv").write_text(f"{titles}\n101;Roy;Ada;TD 10\n102;Roy;Bo;TD 2\n")
    stated = (
        'roster = "class.csv"\nidentity = ["number", "group"]\nsort = "group"\nmark = { of = 20 }\n'
        'lang = "fr"\nformats = "tex"\nsolutions = false\n'
    )
    said = {}
    for name, more in (("named", ""), ("coded", "anonymous = true\n")):
        file, out = tmp_path / f"{name}.toml", tmp_path / name
        file.write_text(stated + more + '[[exercises]]\nname = "crank_pin"\n')
        asked = ["--course", str(small_course), "build", str(file), "--out", str(out)]
        assert run(asked) == 0
        said[name] = capsys.readouterr().err
    assert not [name for name, text in said.items() if "no column" in text]
    out = tmp_path / "named"
    form = table(out / "answers_wide.csv")
    assert [(row["student"], row["number"], row["group"]) for row in form] == [
        ("Roy Ada", "101", "TD 10"),
        ("Roy Bo", "102", "TD 2"),
    ]
    paper = (out / "handouts" / "roy-ada.fr.tex").read_text("utf-8")
    assert re.search(r"101.{1,80}TD.10", paper, re.DOTALL)
    with (out / "typed.csv").open("w", newline="", encoding="utf-8") as file:
        written = csv.DictWriter(file, list(form[0]))
        written.writeheader()
        written.writerow({**form[1], "student": "", list(form[0])[-1]: "1"})  # known by the number alone
    assert grade(small_course, out, out / "typed.csv") == 0
    summary = table(out / "marks" / "summary.csv")
    assert [(row["number"], row["group"]) for row in summary] == [("101", "TD 10"), ("102", "TD 2")]
    assert not {"N° étudiant", "groupe de TD"} & {*summary[0]}


def test_rows_of_one_misspelt_name_are_one_line_with_their_number(built, capsys, monkeypatch):
    course, out = built
    typed, names = out.parent / "typed.csv", ["Adda", "Bo", "Adda", "Zoe", "Adda"]
    rows = [f"{name},crank_pin,,{part},1" for name in names for part in "xy"]
    typed.write_text("\n".join(["student,exercise,seed,part,answer", *rows]) + "\n", "utf-8")
    monkeypatch.setenv("LC_ALL", "fr_FR.UTF-8")
    grade(course, out, typed)
    said = [line for line in capsys.readouterr().err.splitlines() if "typed.csv, ligne" in line]
    counts = [(re.search("«\\W*(Adda|Zoe)", line)[1], re.findall("et ([0-9]+) autre", line)) for line in said]
    assert counts == [("Adda", ["5"]), ("Zoe", ["1"])]
    assert len(table(out / "marks" / "rejected.csv")) == 8


def test_a_title_has_every_number_of_its_question_and_what_a_paper_does_not_ask_is_dashed(tmp_path):
    """Papers that ask a choice or an angle in the same place, and another number of questions before the last
    ones."""
    course = coursework.open_course()
    exercise = course["slotted_mechanism"]
    variants = {f"S{seed}": exercise.variant(seed, "en") for seed in range(12)}
    asked = {frozenset(variant.part_ids): name for name, variant in variants.items()}
    assert len(asked) > 1, "these seeds ask the same questions"
    variants = {name: variants[name] for name in asked.values()}
    issues = [Issue(name, variant, ("en",), name) for name, variant in variants.items()]
    content = issued_content(issues, Assignment("exam", (AskedExercise("slotted_mechanism"),)))
    columns, rows = wide_form(course, content, PaperQuestions.of(course, Issued(content, "it")))
    titles = [title for title in columns if "slotted_mechanism " in title and not title.endswith("seed")]
    assert len({*columns}) == len(columns)
    for row in rows:
        parts = variants[row["student"]].part_ids
        on_paper = {part: f"1.{number}" for number, part in enumerate(parts, 1)}
        for title in titles:
            numbers, _, part = title.split(" (")[0].split(" ")
            assert (row[title] == "—") == (part not in on_paper)
            assert part not in on_paper or on_paper[part] in numbers.split("/")
    path = tmp_path / "typed.csv"
    filled = [[row[title] or "7" for title in columns] for row in rows]
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([columns, *filled])
    read = {(row.student, row.part) for row in read_file(path)}
    assert read == {(name, part) for name, variant in variants.items() for part in variant.part_ids}


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
