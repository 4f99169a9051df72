"""Complex numbers, vectors, matrices, several choices, texts and drawings: asked, built, handed in, marked,
checked."""

from __future__ import annotations

import csv
import json
import re
import subprocess
from shutil import which

import numpy as np
import pytest
from course_of_every_kind import write_course
from tables import each_row

import coursework
from coursework.authoring import checks
from coursework.cli import run
from coursework.cli.demo import HABITS
from coursework.errors import BadCourse
from coursework.model import Part
from coursework.parsing.several import read_choices

GIVEN = {"R": 30.0, "X": 40.0, "U": 100.0}


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return write_course(tmp_path_factory.mktemp("kinds") / "own")


@pytest.fixture(scope="module")
def variant(root):
    return coursework.Variant(coursework.open_course(root)["coil"], 0, GIVEN, "en")


@pytest.fixture(scope="module")
def built(root, tmp_path_factory):
    out = tmp_path_factory.mktemp("built") / "out"
    build = ["build", "--variants", "2", "--formats", "pdf,ipynb,html,tex", "--lang", "fr,en"]
    assert run(["--course", str(root), *build, "--out", str(out)]) == 0
    return out


def table(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def write(path, rows):
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


# ---------------------------------------------------------------------- reading


@each_row(
    ("answer", "verdict"),
    [
        *[
            (right, "correct")
            for right in (
                "30+40i",
                "30 + 40j",
                "30 + j40 Ω",
                "40i + 30",
                "Z = 30+40i ohm",
                "50∠53,13°",
                "50 Ω ∠ 53,13°",
                "50∠53.13° Ω",
                "50 e^{i 53.13°}",
                "50 e^(0.9273 j)",
                "50e^(0.9273i)",
                "50*exp(i*0.9273)",
                "(50 ; 53.13°)",
                "0,03 kΩ + 0,04i kΩ",
                "(0,03+0,04i) kΩ",
                "50∠0.9273 rad",
                r"50 \angle 53.13^\circ",
                30 + 40j,
                "30+40.49i",
            )
        ],
        ("30+40.6i", "wrong"),
        ("30-40i", "mistake:capacitor_for_coil"),
        ("-30-40i", "slip:sign"),
        ("50 e^(53.1301i)", "slip:radians"),
        ("(30 ; 40)", "unreadable"),
        ([30, 40], "unreadable"),
        ("30+40i V", "wrong_unit"),
        ("1e400i", "unreadable"),
        ("", "missing"),
    ],
)
def test_a_complex_number_is_read_as_people_write_it(variant, answer, verdict):
    assert variant.grade({"Z": answer})["Z"].verdict == verdict


def test_a_conjugate_is_told(variant):
    mark = variant.grade({"Z": "30+40i", "I": "1.2 + 1.6i"})["I"]
    assert (mark.verdict, mark.points) == ("slip:conjugate", 0.5 * mark.out_of)


def test_what_follows_from_a_wrong_complex_number_is_right(variant):
    wrong = 20 + 40j
    marking = variant.grade({"Z": wrong, "I": complex(100 / wrong)})
    assert marking["I"].verdict == "follow_through"


@each_row(
    ("answer", "verdict"),
    [
        *[
            (right, "correct")
            for right in (
                "[60, 80, 100]",
                "(60 ; 80 ; 100) V",
                "60; 80; 100",
                "60 80 100",
                "60\n80\n100",
                [60, 80, 100],
                [[60], [80], [100]],
                np.array([60.0, 80.0, 100.0]),
                "0,06 ; 0,08 ; 0,1 kV",
                "array([60., 80., 100.])",
                r"\begin{pmatrix} 60 \\ 80 \\ 100 \end{pmatrix} V",
                "59 ; 80 ; 100",
            )
        ],
        ("58.9 ; 80 ; 100", "wrong"),  # the half-width of each is 1 % of the largest
        ("60 ; 80", "unreadable"),
        ("60 ; 80 ; 100 A", "wrong_unit"),
        ("80 ; 60 ; 100", "wrong"),
    ],
)
def test_a_vector_is_judged_entry_by_entry(variant, answer, verdict):
    assert variant.grade({"drops": answer})["drops"].verdict == verdict


@each_row(
    ("answer", "verdict"),
    [
        *[
            (right, "correct")
            for right in (
                "[[30, -40], [40, 30]]",
                "30 -40; 40 30",
                "30 -40\n40 30",
                "[30 -40; 40 30] ohm",
                [[30, -40], [40, 30]],
                "30,0 -40,0; 40,0 30,4",
                "[30, -40]; [40, 30]",
                "((30 ; -40) ; (40 ; 30))",
                "[[0.03 -0.04]\n [0.04 0.03]] kΩ",
                np.array([[30, -40], [40, 30]]),
                r"$\begin{bmatrix}30&-40\\40&30\end{bmatrix}$",
                "M = np.array([[30, -40], [40, 30]])",
            )
        ],
        ("30 -40; 40 30.5", "wrong"),
        ("[30, 40]; [-40, 30]", "mistake:transposed"),
        ("30; -40; 40; 30", "unreadable"),
        ("1 2 3; 4 5 6", "unreadable"),
        ("[[30, -40], [40, 30]] V", "wrong_unit"),
    ],
)
def test_a_matrix_is_judged_entry_by_entry(variant, answer, verdict):
    assert variant.grade({"M": answer})["M"].verdict == verdict


@each_row(
    ("answer", "verdict", "points"),
    [
        ("lags, heats, stores", "correct", 2),
        ("stores ; heats ; lags", "correct", 2),
        (["lags", "heats", "stores"], "correct", 2),
        ("[x] lags\n[ ] leads\n[x] heats\n[x] stores", "correct", 2),
        ("the current lags, it heats, and wears, and it stores energy", "correct", 2),
        ("le courant est en retard et heats et stores", "correct", 2),
        ("lags and heats", "partial", 4 / 3),
        ("lags, heats, stores, leads", "wrong", 0),
        ("lags", "partial", 2 / 3),
        ("lags, leads", "wrong", 0),
        ("leads", "wrong", 0),
        ("none", "wrong", 0),
        ("aucune", "wrong", 0),
        ("lags, foo", "unreadable", 0),
        *((nothing, "unreadable", 0) for nothing in ("[]", "[ ]", "+", "n.a.", "lags?")),
        *((nothing, "missing", 0) for nothing in (".", ",", "...")),
        ("", "missing", 0),
    ],
)
def test_each_right_choice_gives_its_share_and_all_together_give_nothing(variant, answer, verdict, points):
    mark = variant.grade({"true_of_it": answer})["true_of_it"]
    assert mark.verdict == verdict
    assert mark.points == pytest.approx(points)


def test_where_no_choice_is_right_none_is(root):
    exercise = coursework.open_course(root)["coil"]
    nothing = coursework.Variant(exercise, 0, {**GIVEN, "R": 0.0, "X": 0.0}, "en")
    part = exercise.spec.part("true_of_it")
    assert part.sort.distance(part, frozenset(), nothing.quantities(("true_of_it",))["true_of_it"]) == 0


def test_what_a_person_marks_is_neither_right_nor_wrong(variant):
    marking = variant.grade({"why": "It stores\nenergy."})
    assert (marking["why"].verdict, marking["why"].points, marking["why"].answer) == (
        "to_mark",
        0,
        "It stores\nenergy.",
    )
    assert variant.grade({})["why"].verdict == "missing"
    assert marking["sketch"].verdict == "to_mark"  # it is on paper


# --------------------------------------------------------------------- promises


@pytest.mark.parametrize("count", [10, pytest.param(60, marks=pytest.mark.slow)])
def test_every_promise_is_proved_of_them(root, count):
    report = checks.check(coursework.open_course(root)["coil"], count)
    assert not report.failures
    assert report.by_person == {"why", "sketch"}
    assert report.counts["mistakes recognised"] >= count
    assert report.counts["follow-through"] >= count
    assert report.counts["formulas proved"] >= 20


def test_the_envelope_of_a_matrix_is_that_of_each_variant_alone(root):
    exercise = coursework.open_course(root)["coil"]
    variants = exercise.variants(range(4), "en")
    alone = [variant.key.half_width(exercise.spec.part("M")) for variant in variants]
    from coursework.course.key_batch import keys_of

    keys_of(exercise, variants)
    assert [variant.key.half_width(exercise.spec.part("M")) for variant in variants] == pytest.approx(alone)


@each_row(
    ("stated", "said"),
    [
        ({"kind": "text", "room": 0}, "number of lines"),
        ({"kind": "drawing", "room": 5}, "width and height in mm"),
        ({"kind": "number", "room": 5}, "'room' goes with kinds that leave some"),
        ({"kind": "text", "millimetre": True}, "millimetre paper goes with a drawing"),
        ({"kind": "choices"}, "'choices' goes with"),
    ],
)
def test_room_that_is_none_is_refused(stated, said):
    with pytest.raises(BadCourse, match=said):
        Part("why", **stated)


# --------------------------------------------------------------------- the jobs


def test_sheets_leave_room_and_say_the_rule(built):
    page = next((built / "handouts" / "coil").glob("*.en.html")).read_text("utf-8")
    assert '<textarea id="answer-why" name="why" rows="3"' in page
    assert "autocorrect" not in page.partition("<textarea")[2].partition(">")[0], (
        "prose is helped as it is typed"
    )
    assert page.count('type="checkbox"') == 4 + 1, (
        "one says that none is right: nothing ticked is not an answer"
    )
    assert read_choices(re.search(r'value="(none)"> none of them', page)[1], {"a": ("one",)}).values == (
        frozenset(),
    )
    assert "each wrong one takes at least as much away" in page
    notebook = next((built / "handouts" / "coil").glob("*.fr.ipynb")).read_text("utf-8")
    assert "Chaque juste cochée donne sa part des points" in notebook
    solution = next((built / "instructor" / "coil").glob("*.en.solution.html")).read_text("utf-8")
    assert "gives it back" in solution
    assert "marked by a person" in solution


@pytest.mark.skipif(which("pdflatex") is None, reason="no LaTeX here")
def test_latex_sources_compile(built, tmp_path):
    for source in (*built.glob("handouts/coil/*0.en.tex"), *built.glob("instructor/coil/*0.fr.solution.tex")):
        command = ["pdflatex", "-halt-on-error", "-output-directory", tmp_path, source.name]
        done = subprocess.run(command, cwd=source.parent, capture_output=True, check=False)
        assert done.returncode == 0, done.stdout[-2000:]


def test_the_key_holds_answers_that_are_right_as_they_stand(built, root):
    key = json.loads((built / "instructor" / "key.json").read_text("utf-8"))
    assert complex(key[0]["answers"]["Z"]["value"]).imag > 0
    assert key[0]["answers"]["why"]["value"] is None
    course = coursework.open_course(root)
    for row in table(built / "instructor" / "key.csv"):
        record = next(k for k in key if k["seed"] == int(row["seed"]))
        mark = course["coil"].from_record(record).grade({row["part"]: row["value"]})[row["part"]]
        assert mark.verdict in ("correct", "to_mark") or not row["value"]


@pytest.fixture
def marked(built, root, tmp_path):
    """The form with its right answers, and two texts, marked once."""
    key = {k["seed"]: k["answers"] for k in json.loads((built / "instructor/key.json").read_text("utf-8"))}
    rows = table(built / "answers.csv")
    for row in rows:
        row["student"] = f"s{row['seed']}"
        value = key[int(row["seed"])][row["part"]]["value"]
        row["answer"] = f"Because of {row['seed']},\nit stores." if row["part"] == "why" else str(value or "")
    write(tmp_path / "answers.csv", rows)

    def grade():
        job = ["grade", str(tmp_path / "answers.csv"), "--issued", str(built / "issued.json")]
        return run(["--course", str(root), *job, "--out", str(tmp_path / "marks")])

    return tmp_path, grade


def test_open_answers_wait_until_a_person_marks_them(marked, capsys):
    folder, grade = marked
    assert grade() == 1
    assert "4 answers wait to be marked by a person" in capsys.readouterr().out
    waiting = table(folder / "marks" / "decisions.csv")
    assert {row["part"] for row in waiting} == {"why", "sketch"}
    assert "Because of 0,\nit stores." in [row["answer"] for row in waiting]
    summary = table(folder / "marks" / "summary.csv")
    assert [(s["points"], s["to_mark"], s["correct"]) for s in summary] == [("13", "2", "5")] * 2
    for row, points in zip(waiting, ("4", "1,5", "0", "3"), strict=True):
        row["points"], row["reason"] = points, "seen"
    write(folder / "marks" / "decisions.csv", waiting)
    assert grade() == 0
    marks = {(m["student"], m["part"]): m for m in table(folder / "marks" / "marks.csv")}
    given = [marks[row["student"], row["part"]] for row in waiting]
    assert [m["verdict"] for m in given] == ["accepted", "partial", "wrong", "accepted"]
    assert given[1]["feedback"] == "Noté par une personne. seen"
    assert sum(float(s["points"]) for s in table(folder / "marks" / "summary.csv")) == 26 + 8.5
    assert grade() == 0  # what was given stays
    assert sum(float(s["points"]) for s in table(folder / "marks" / "summary.csv")) == 26 + 8.5


def test_points_for_another_answer_do_not_count_and_are_kept(marked, capsys):
    folder, grade = marked
    grade()
    rows = table(folder / "marks" / "decisions.csv")
    for row in rows:
        row["points"] = "1"
    write(folder / "marks" / "decisions.csv", rows)
    answers = table(folder / "answers.csv")
    for row in answers:
        row["answer"] = "Something else." if row["part"] == "why" else row["answer"]
    write(folder / "answers.csv", answers)
    assert grade() == 1
    assert "answered anew since: s0, coil, 0, why" in capsys.readouterr().err
    assert (folder / "marks" / "decisions.before.csv").exists()
    assert [r["points"] for r in table(folder / "marks" / "decisions.csv")] == ["", "", "1", "1"]


def test_the_files_of_a_folder_of_before_are_read_and_become_one(marked):
    """Points of ``to_mark.csv`` and lines of ``accepted.csv`` count, and ``decisions.csv`` has the former
    from then on."""
    folder, grade = marked
    grade()
    marks = folder / "marks"
    rows = table(marks / "decisions.csv")
    (marks / "decisions.csv").unlink()
    old = [{**row, "points": "1" if row["part"] == "why" else ""} for row in rows]
    write(marks / "to_mark.csv", [{c: v for c, v in row.items() if c != "kind"} for row in old])
    (marks / "by_hand.csv").write_text("student,exercise\n", "utf-8")
    student = rows[0]["student"]
    (marks / "accepted.csv").write_text(f"student,exercise,part\n{student},coil,sketch\n", "utf-8")
    for _ in range(2):
        assert grade() == 1
        verdicts = {
            (row["student"], row["part"]): row["verdict"]
            for row in table(marks / "marks.csv")
            if row["part"] in ("why", "sketch")
        }
        assert sorted(verdicts.values()) == ["accepted", "partial", "partial", "to_mark"]
        assert verdicts[student, "sketch"] == "accepted"
        assert {row["points"] for row in table(marks / "decisions.csv") if row["part"] == "why"} == {"1"}
        assert {path.name for path in marks.glob("*.csv")} & {"to_mark.csv", "by_hand.csv"} == set()


def test_a_line_without_a_kind_accepts_an_answer_that_no_marking_listed(marked):
    folder, grade = marked
    grade()
    rows = table(folder / "marks" / "decisions.csv")
    one = {**dict.fromkeys(rows[0], ""), "student": "s0", "exercise": "coil", "part": "Z", "reason": "seen"}
    write(folder / "marks" / "decisions.csv", [*rows, one])
    for _ in range(2):
        grade()
        marks = {(row["student"], row["part"]): row for row in table(folder / "marks" / "marks.csv")}
        assert marks["s0", "Z"]["verdict"] == "accepted"
    assert [row["kind"] for row in table(folder / "marks" / "decisions.csv")] == [
        *[""] * len(rows),
        "accepted",
    ]


@pytest.mark.parametrize("points", ["4.5", "many", "-1"])
def test_points_that_are_none_are_refused_with_their_line(marked, capsys, points):
    folder, grade = marked
    grade()
    rows = table(folder / "marks" / "decisions.csv")
    rows[0]["points"] = points
    write(folder / "marks" / "decisions.csv", rows)
    assert grade() == 2
    assert "decisions.csv, line 2" in capsys.readouterr().err


def test_statistics_do_not_count_what_waits_as_wrong(marked, root, capsys):
    folder, grade = marked
    grade()
    capsys.readouterr()
    assert run(["--course", str(root), "report", str(folder / "marks"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["percent"]["mean"] == 100
    assert told["verdicts"]["to_mark"] == 4
    assert run(["--course", str(root), "report", str(folder / "marks"), "--lang", "fr"]) == 0
    assert "notées par une personne" in (folder / "marks" / "report" / "report.html").read_text("utf-8")


def test_a_student_alone_is_told_of_each(root, tmp_path):
    session = coursework.study("coil", lang="en", course=root, folder=tmp_path)
    right = {p: v.tolist() if hasattr(v, "tolist") else v for p, v in session.variant.solution().items()}
    said = str(session.check({**right, "why": "It stores."}))
    assert said.count("✓") == 5
    assert "compare it with" in said
    assert "13 out of 13 points" in said
    assert "5 of 5 right" in str(session.progress())
    assert "gives it back" in str(session.reveal("why"))
    assert "marked by a person" in str(session.reveal("sketch"))
    for part in session.variant.part_ids:
        assert str(session.hint(part))
        assert str(session.check({part: "???"}))


def test_a_practice_notebook_is_made(root, tmp_path):
    job = ["build", "--variants", "1", "--formats", "ipynb", "--with", "practice", "--lang", "en"]
    assert run(["--course", str(root), *job, "--out", str(tmp_path / "out")]) == 0


@each_row("habit", HABITS)
def test_the_class_of_the_demonstration_answers_them(variant, habit):
    answers = {p.id: habit(variant, variant.key, p, place) for place, p in enumerate(variant.parts)}
    marking = variant.grade(answers)
    assert len(marking) == len(variant.parts)


def test_a_case_is_solved_on_the_command_line(root, capsys):
    assert run(["--course", str(root), *"solve coil --set R=30 --set X=40 --set U=100 --json".split()]) == 0
    found = json.loads(capsys.readouterr().out)["quantities"]
    assert found["Z"]["value"] == {"re": 30, "im": 40}
    assert found["M"]["value"] == [[30, -40], [40, 30]]
    assert "why" not in found
    assert run(["--course", str(root), "variant", "coil", "--seed", "0", "--solution", "--json"]) == 0
    assert run(["--course", str(root), "show", "coil", "--seed", "0", "--lang", "en"]) == 0
