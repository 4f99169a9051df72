"""An assignment: read with care, dealt by student and not by place, issued once and for all."""

from __future__ import annotations

import json
import pickle
import re
from itertools import pairwise
from pathlib import Path

import pytest

import coursework
from coursework.errors import BadInput
from coursework.issuing.assignment import read_assignment
from coursework.issuing.build import files
from coursework.issuing.issued import issued_content
from coursework.issuing.papers import date_text, papers
from coursework.issuing.roster import Student, read_roster
from coursework.issuing.variant_assignment import assign_variants, distributed_points

COURSE = coursework.open_course()
TEXT = """\
title = { fr = "Devoir surveillé 2", en = "Midterm 2" }
course = "Mécanique 2A"
date = 2026-12-04
duration = "1 h 30"
mark = { of = 20, step = 0.5 }
versions = "each"
secret = "0b6c5d1f2a9e47388c1fd2b7a4e3905d"
identity = ["number", "group"]

[[exercises]]
name = "slotted_mechanism"
parts = ["rA", "theta4", "omega4"]
points = { rA = 2, omega4 = 3 }

[[exercises]]
name = "vocabulary"
seed = 12

[[exercises]]
name = "grashof"
points = 6

[marking]
follow_through = 0.5
"""
NAMES = ("Zoé Martin", "Abel Roy", "Li Wei", "Ömer Öz", "Ana Ruiz", "Jo Ito", "Max Roth", "Eve Lund")
CLASS = [
    Student(name, columns={"number": str(100 + k), "group": "AB"[k % 2]}) for k, name in enumerate(NAMES)
]


def stated(tmp_path, text=TEXT):
    path = tmp_path / "week3.toml"
    path.write_text(text, "utf-8")
    return path


@pytest.fixture
def midterm(tmp_path):
    return read_assignment(stated(tmp_path), COURSE)


def dealt(assignment, students, before=None, make_up=(), langs=("fr",)):
    return assign_variants(COURSE, assignment, students, langs, before, make_up)


def by_student(found):
    return {(i.student, i.variant.exercise.name, i.sitting): i.variant.record for i in found.issues}


# ------------------------------------------------------------------------ reading


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ('course = "M', 'corse = "M', r"line 2: no key 'corse'; did you mean 'course'"),
        ("date = 2026-12-04", 'date = "the 4th"', r"line 3: date is a day"),
        ('name = "grashof"', 'name = "grashoff"', r"line 20: no exercise 'grashoff'; did you mean 'grashof'"),
        ('"theta4", "omega4"]', '"theta5", "omega4"]', r"line 12: slotted_mechanism has no part 'theta5'"),
        ("points = 6", 'points = "six"', r"line 21: points are a number above 0; found 'six'"),
        ("{ rA = 2,", "{ rB = 2,", r"line 13: slotted_mechanism has no part 'rB'"),
        ("step = 0.5", "step = 0", r"line 5: mark: step is a number above 0"),
        ('versions = "each"', "versions = 0", r"line 6: versions is \"each\", or a number"),
        ("follow_through = 0.5", "follow = 0.5", r"no rule of marking 'follow'"),
        ("seed = 12", "seed = -1", r"line 17: a seed is a whole number"),
        ('duration = "1 h 30"', 'logo = "logo.svg"', r"line 4: logo: there is no file"),
        ("title = { fr", 'title = { xx = "?", fr', r"line 1: title: no language 'xx'"),
        ('name = "grashof"', 'name = "vocabulary"', r"line 20: vocabulary appears twice"),
        ('[[exercises]]\nname = "grashof"', '[[exercises]]\nnmae = "grashof"', r"line 20: no key 'nmae'"),
        ("date = 2026-12-04", "date = ", r"week3.toml, line 3: "),
    ],
)
def test_what_makes_no_sense_is_told_with_its_line_and_the_nearest_name(tmp_path, before, after, said):
    assert before in TEXT
    with pytest.raises(BadInput, match=said):
        read_assignment(stated(tmp_path, TEXT.replace(before, after)), COURSE)


def test_a_logo_needs_words_for_who_cannot_see_it(tmp_path):
    (tmp_path / "logo.svg").write_text("<svg xmlns='http://www.w3.org/2000/svg'/>", "utf-8")
    with pytest.raises(BadInput, match="line 1: a logo needs a text"):
        read_assignment(stated(tmp_path, 'logo = "logo.svg"\n' + TEXT), COURSE)
    one = read_assignment(stated(tmp_path, 'logo = "logo.svg"\nlogo_alt = "Our school"\n' + TEXT), COURSE)
    assert one.picture("fr").alt == "Our school"


def test_a_day_is_written_as_the_language_does(midterm):
    assert date_text(midterm.date, "fr") == "4 décembre 2026"
    assert date_text(midterm.date, "en") == "4 December 2026"


# ------------------------------------------------------------------------ dealing


def test_a_variant_hangs_on_the_student_and_not_on_the_place_in_the_roster(midterm):
    one, other = dealt(midterm, CLASS), dealt(midterm, CLASS[::-1])
    assert by_student(one) == by_student(other)
    seeds = [i.variant.given["theta2"] for i in one.issues if i.variant.exercise.name == "slotted_mechanism"]
    assert len(set(seeds)) > 1


def test_the_number_counts_where_the_roster_has_one_and_the_name_may_be_mended(midterm):
    mended = [Student("Zoé Martin-Roux", columns=CLASS[0].columns), *CLASS[1:]]
    before, after = by_student(dealt(midterm, CLASS)), by_student(dealt(midterm, mended))
    assert before["Zoé Martin", "grashof", 1] == after["Zoé Martin-Roux", "grashof", 1]


def test_two_students_never_have_the_same_variant_while_variants_last(midterm):
    many = [Student(f"Student {n}") for n in range(60)]
    found = dealt(midterm, many)
    for name in ("slotted_mechanism", "grashof"):
        given = [tuple(i.variant.given.values()) for i in found.issues if i.variant.exercise.name == name]
        assert len(set(given)) == len(given) == 60
    assert {i.variant.seed for i in found.issues if i.variant.exercise.name == "vocabulary"} == {12}


def test_who_is_late_is_added_and_nobody_elses_paper_changes(midterm):
    first = dealt(midterm, CLASS)
    content = json.loads(json.dumps(issued_content(first.issues, midterm)))
    late = [Student("Aaron Abt"), *CLASS]
    again = dealt(midterm, late, content)
    assert by_student(first).items() <= by_student(again).items()
    assert [i.stem for i in again.issues][: len(first.issues)] == [i.stem for i in first.issues]
    assert any("added: Aaron Abt" in note for note in again.notes)
    gone = dealt(midterm, CLASS[1:], content)
    assert by_student(gone) == by_student(first)
    assert any("no longer on the roster: Zoé Martin" in note for note in gone.notes)


def test_what_was_issued_stays_even_where_the_file_says_other_points(midterm, tmp_path):
    content = json.loads(json.dumps(issued_content(dealt(midterm, CLASS).issues, midterm)))
    other = read_assignment(stated(tmp_path, TEXT.replace("rA = 2", "rA = 9")), COURSE)
    again = dealt(other, [*CLASS, Student("Late One")], content)
    points = {
        i.student: i.variant.parts[0].points
        for i in again.issues
        if i.variant.exercise.name == "slotted_mechanism"
    }
    assert points["Zoé Martin"] == 2
    assert points["Late One"] == 9
    fewer = read_assignment(stated(tmp_path, TEXT[: TEXT.index('[[exercises]]\nname = "grashof"')]), COURSE)
    with pytest.raises(BadInput, match="changed since it was issued there"):
        dealt(fewer, CLASS, content)


def test_who_makes_up_has_another_variant_of_each_exercise(midterm):
    content = json.loads(json.dumps(issued_content(dealt(midterm, CLASS).issues, midterm)))
    found = by_student(dealt(midterm, CLASS, content, make_up=["li wei"]))
    for name in midterm.names:
        assert found["Li Wei", name, 1]["given"] != found["Li Wei", name, 2]["given"]
    with pytest.raises(BadInput, match="did you mean 'Li Wei'"):
        dealt(midterm, CLASS, content, make_up=["Li Wie"])


def test_versions_are_dealt_so_that_neighbours_differ(tmp_path):
    four = read_assignment(stated(tmp_path, TEXT.replace('"each"', "4")), COURSE)
    seats = [Student(f"S{n}", columns={"seat": f"{'ABCDE'[n // 8]}{n % 8 + 1}"}) for n in range(40)]
    found = dealt(four, seats)
    version = {i.student: i.version for i in found.issues}
    assert sorted(set(version.values())) == ["A", "B", "C", "D"]
    for n in range(40):
        if n % 8 < 7:
            assert version[f"S{n}"] != version[f"S{n + 1}"]
        if n < 32:
            assert version[f"S{n}"] != version[f"S{n + 8}"]
    of = {i.student: i.variant.seed for i in found.issues if i.variant.exercise.name == "grashof"}
    assert len(set(of.values())) == 4
    assert all((of[a] == of[b]) == (version[a] == version[b]) for a in of for b in of)


def test_without_a_roster_papers_are_numbered(midterm):
    found = dealt(midterm, [Student("") for _ in range(12)])
    assert [one.first.stem for one in papers(midterm, found.issues, polygons=True)][:2] == [
        "paper-01",
        "paper-02",
    ]
    assert len({i.variant.seed for i in found.issues if i.variant.exercise.name == "grashof"}) == 12


# ------------------------------------------------------------------------- points


def test_points_of_an_assignment_reach_the_record_and_the_marks(midterm):
    found = dealt(midterm, CLASS[:2])
    for issue in found.issues:
        again = issue.variant.exercise.from_record(json.loads(json.dumps(issue.variant.record)))
        there = pickle.loads(pickle.dumps(issue.variant))
        points = {p.id: p.points for p in issue.variant.parts}
        assert {p.id: p.points for p in again.parts} == {p.id: p.points for p in there.parts} == points
    slotted = found.issues[0].variant
    assert {p.id: p.points for p in slotted.parts} == {"rA": 2, "theta4": 1, "omega4": 3}
    assert slotted.grade({"omega4": str(slotted.solution()["omega4"])}).points == 3
    assert sum(p.points for p in found.issues[2].variant.parts) == 6


@pytest.mark.parametrize("total", [1, 2.5, 6, 7, 10, 0.3])
@pytest.mark.parametrize("name", ["grashof", "slider_extras", "four_bar_positions"])
def test_points_that_are_shared_out_sum_to_the_total(total, name):
    parts = COURSE[name].variant(1).parts
    found = distributed_points(total, parts)
    assert sum(found.values()) == pytest.approx(total, abs=1e-12)
    assert min(found.values()) > 0
    ordered = sorted(parts, key=lambda p: p.points)
    assert all(found[a.id] <= found[b.id] + 0.25 for a, b in pairwise(ordered))


# ------------------------------------------------------------------------- roster


def test_every_column_of_the_roster_is_carried_through(tmp_path):
    path = tmp_path / "class.csv"
    path.write_text("Nom;Prénom;N° étudiant;Groupe;lang\nMartin;Zoé;123;B;fr\nRoy;Abel;;A;\n", "utf-8")
    zoe, abel = read_roster(Path(path))
    assert zoe.columns == {"N° étudiant": "123", "Groupe": "B"}
    assert abel.columns == {"N° étudiant": "", "Groupe": "A"}


def test_issued_json_keeps_the_assignment_and_the_columns_and_no_answer(midterm):
    content = issued_content(dealt(midterm, CLASS).issues, midterm)
    assert content["assignment"]["mark"] == {"of": 20.0, "step": 0.5}
    assert content["students"]["Abel Roy"] == {"number": "101", "group": "B"}
    assert "answers" not in {key for item in content["issued"] for key in item["record"]}


def test_a_booklet_is_sorted_by_the_column_that_the_file_names_and_else_as_the_roster(tmp_path):
    groups = ("10", "2", "A", "2", "", "10", "B", "a")
    students = [Student(name, columns={"Group": g}) for name, g in zip(NAMES, groups, strict=True)]

    def order(text):
        assignment = read_assignment(stated(tmp_path, text), COURSE)
        made = papers(
            assignment, assign_variants(COURSE, assignment, students, ("fr",), None).issues, polygons=False
        )
        return [one.first.student for one in sorted(made, key=lambda one: one.sorted_by)]

    assert order(TEXT) == list(NAMES)
    sorted_names = order('sort = "groupe de TD"\n' + TEXT)
    assert sorted_names == order('sort = "group"\n' + TEXT)
    assert [dict(zip(NAMES, groups, strict=True))[n] for n in sorted_names] == [
        "",
        "2",
        "2",
        "10",
        "10",
        "A",
        "a",
        "B",
    ]
    assert sorted_names.index("Abel Roy") < sorted_names.index("Ömer Öz")  # of one group: as the roster


def test_latex_of_a_paper_stands_beside_the_drawings_that_it_names(midterm):
    issues = dealt(midterm, CLASS[:1]).issues
    written = {f.path.as_posix(): f.make() for f in files(COURSE, issues, ["tex"], midterm)}
    sources = {name: made.decode() for name, made in written.items() if name.endswith(".tex")}
    assert len(sources) == 2 * len(issues[0].langs)
    for name, source in sources.items():
        named = re.findall(r"\\includegraphics\[[^\]]*\]\{([^}]+)\}", source)
        folder = name.rpartition("/")[0]
        assert named
        assert all(written[f"{folder}/{figure}"].startswith(b"%PDF") for figure in named)
