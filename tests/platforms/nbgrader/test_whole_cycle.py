"""nbgrader's whole cycle, with nbgrader itself: what its database holds are our points, whatever students
hand in."""

from __future__ import annotations

import copy
import csv
import json
from importlib.util import find_spec

import pytest
from nbgrader_course import (
    answered,
    answers_cells,
    code,
    commands,
    done,
    feedback,
    grade_cells,
    nbgrader,
    points,
    python,
    released,
    submit,
)
from tables import each_row

import coursework
from coursework.cli import run
from coursework.course.answer_keys import answer_keys

pytestmark = [
    pytest.mark.e2e,
    pytest.mark.skipif(not find_spec("nbgrader"), reason="nbgrader needs pip install -e '.[e2e]'"),
]

NAME = "slotted_mechanism"


def keyed(variant, answers):
    """Answers by what a notebook calls them."""
    keys = answer_keys(variant.parts)
    return {keys[part]: value for part, value in answers.items()}


def right_of(variant):
    return {part: str(value) for part, value in variant.solution().items()}


def scores(variant, answers):
    """Our points, by the grade cells of nbgrader."""
    keys = answer_keys(variant.parts)
    name = variant.exercise.name
    return {f"coursework-{name}-{keys[m.part]}": m.points for m in variant.grade(answers).values()}


# ------------------------------------------------------- one variant for a class


def forged(book, marker):
    """Grade cells that are worth more, hold points already, are no grade cells, and run code."""
    book = copy.deepcopy(book)
    for cell in grade_cells(book):
        cell["metadata"]["nbgrader"].update(points=100, solution=True, schema_version=2)
        cell["source"] = f"open({str(marker)!r}, 'w').close()\n9"
        data = {"text/plain": "1.0"}
        cell["outputs"] = [
            {"output_type": "execute_result", "execution_count": 1, "metadata": {}, "data": data}
        ]
    return book


def with_code(book, marker):
    """Cells that write a file and shadow what a marker would call."""
    book = copy.deepcopy(book)
    evil = (
        f"import builtins\nabs = float = max = builtins.abs = lambda *a: 0\nopen({str(marker)!r}, "
        "'w').close()"
    )
    book["cells"].insert(0, code(evil, nbgrader=["no", "table"]))
    book["cells"].append(
        code(evil, nbgrader={"grade": True, "grade_id": "coursework-mine", "points": 50, "schema_version": 3})
    )
    return book


def without_cells(book):
    """Grade cells deleted, all but one; texts and the cell ids, too."""
    book = copy.deepcopy(book)
    kept = grade_cells(book)[3]
    book["cells"] = [cell for cell in book["cells"] if cell is kept or cell in answers_cells(book)]
    return book


def doubled(book):
    """Every cell twice, as one who copies and pastes; the answers too."""
    book = copy.deepcopy(book)
    book["cells"] += copy.deepcopy(book["cells"])
    return book


def of_seed(book, seed):
    book = copy.deepcopy(book)
    book["metadata"]["coursework"]["seed"] = seed
    return book


def of_exercise(book, exercise):
    book = copy.deepcopy(book)
    book["metadata"]["coursework"]["exercise"] = exercise
    return book


def in_answers(book, source):
    book = copy.deepcopy(book)
    answers_cells(book)[0]["source"] = source
    return book


@pytest.fixture(scope="module")
def classroom(tmp_path_factory):
    """A class that handed in, marked by nbgrader: its folder, the variant, what each answered, what nbgrader
    said."""
    out = tmp_path_factory.mktemp("class")
    marker = out / "ran"
    assert run(["build", NAME, "--formats", "nbgrader", "--lang", "en", "--out", str(out)]) == 0
    folder = out / "nbgrader"
    done(folder, "generate_assignment", NAME)
    record = json.loads((out / "issued.json").read_text("utf-8"))["issued"][0]["record"]
    variant = coursework.open_course()[NAME].from_record(record)
    book, right = released(folder, NAME), right_of(variant)
    erring = {**right, "rA": "-" + right["rA"], "theta4": "a quarter", "guide": ""}
    theirs = {
        "ada": (right, answered(book, keyed(variant, right))),
        "ben": (erring, answered(book, keyed(variant, erring))),
        "cleo": ({}, forged(book, marker)),
        "dan": (right, with_code(answered(book, keyed(variant, right)), marker)),
        "eve": (erring, without_cells(answered(book, keyed(variant, erring)))),
        "fay": (right, doubled(answered(book, keyed(variant, right)))),
        "gil": ({}, of_seed(answered(book, keyed(variant, right)), record["seed"] + 1)),
        "hal": ({}, of_exercise(answered(book, keyed(variant, right)), "grashof")),
        "ivy": ({}, in_answers(book, f"open({str(marker)!r}, 'w')\nanswers = dict(rA=abs(-1))")),
        "joy": ({}, "this is not a notebook"),
        "kim": (right, forged(answered(book, keyed(variant, right)), marker)),
    }
    for student, (_, handed) in theirs.items():
        submit(folder, student, NAME, handed)
    told = nbgrader(folder, "autograde", NAME)
    commands(folder, ["generate_feedback", NAME], ["export"])
    return folder, variant, {s: answers for s, (answers, _) in theirs.items()}, told, marker


def test_the_database_holds_our_points_for_each_question_of_each_student(classroom):
    folder, variant, theirs, _, _ = classroom
    found, _ = points(folder)
    ours = {student: scores(variant, answers) for student, answers in theirs.items() if student != "joy"}
    assert {s: own for s, own in found.items() if s != "joy"} == ours
    assert not any(found.get("joy", {}).values())
    assert {sum(own.values()) for own in ours.values()} >= {0.0, 9.0}, "the class is of one kind only"


def test_the_exported_totals_are_our_points(classroom):
    folder, variant, theirs, _, _ = classroom
    with (folder / "grades.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["student_id"]: row for row in csv.DictReader(file)}
    for student, answers in theirs.items():
        assert float(rows[student]["score"]) == pytest.approx(variant.grade(answers).points)
        assert float(rows[student]["max_score"]) == variant.grade({}).out_of


def test_nothing_of_a_student_is_run(classroom):
    *_, marker = classroom
    assert not marker.exists()


def test_a_notebook_that_is_none_stops_nobody_else_and_is_told(classroom):
    folder, _, _, told, _ = classroom
    assert told.returncode != 0
    assert "joy" in told.stderr.splitlines()[-2]
    assert (folder / "autograded/kim" / NAME).is_dir()


@each_row(
    ("student", "said"),
    [
        ("gil", "was not issued"),
        ("hal", "no exercise 'grashof' was issued"),
        ("ivy", "the answers cell must contain one dict and nothing else"),
        ("cleo", "the cell coursework-slotted_mechanism-rA was changed"),
        ("eve", "the cell coursework-slotted_mechanism-rA was missing"),
        ("fay", "a second cell coursework-slotted_mechanism-rA counts as the student's own"),
        ("dan", "a cell that was not in the released notebook counts as the student's own"),
    ],
)
def test_what_is_odd_is_told_to_the_staff(classroom, student, said):
    *_, told, _ = classroom
    assert any(f"{student}" in line and said in line for line in told.stderr.splitlines())


def test_what_nobody_could_read_waits_for_a_person_and_nothing_else_does(classroom):
    folder, variant, _, _, _ = classroom
    _, waiting = points(folder)
    every = set(scores(variant, {}))
    assert waiting["ada"] == waiting["dan"] == waiting["kim"] == waiting["fay"] == set()
    assert waiting["ben"] == waiting["eve"] == {f"coursework-{NAME}-theta4"}
    assert waiting["gil"] == waiting["hal"] == waiting["ivy"] == every


def test_a_student_reads_the_sentence_of_each_answer_and_never_the_right_one(classroom):
    folder, variant, _theirs, _, _ = classroom
    page = feedback(folder, "ben", NAME)
    assert "one slip away" in page
    assert "opposite sign" in page
    assert "not read yet" in page
    assert "<math" in page
    for value in variant.solution().values():
        assert f"{value:.4g}" not in feedback(folder, "cleo", NAME) if isinstance(value, float) else True
    told = feedback(folder, "gil", NAME)
    assert "a person will look at it" in told


def test_names_of_parts_that_would_tell_stand_nowhere_in_what_students_get(classroom):
    folder, variant, _theirs, _, _ = classroom
    hidden = {part for part, key in answer_keys(variant.parts).items() if part != key} - {"guide"}
    assert hidden == {"a_centripetal", "a_coriolis"}
    cells = json.dumps(released(folder, NAME)["cells"]) + feedback(folder, "cleo", NAME)
    assert not [part for part in hidden if part in cells]


def test_marked_again_the_points_are_the_same(classroom):
    folder, *_ = classroom
    before = points(folder)
    done(folder, "autograde", NAME, "--force", "--student", "eve")
    assert points(folder) == before


# -------------------------------------------------------- a variant for a student

PAPER = """title = "Week 3"
mark = { of = 20 }
lang = "fr"
[[exercises]]
name = "slotted_mechanism"
parts = ["rA", "theta4", "omega4"]
points = { rA = 2, omega4 = 2.5 }
[[exercises]]
name = "grashof"
points = 3
[marking]
follow_through = 0.5
"""
ROSTER = (
    "student,e-mail,number\nAda Byron,ada@uni.example,101\nBen Adda,ben@uni.example,102\nCléo "
    "Ney,cleo@uni.example,103\n"
)
ORDINARY = {"ok": ("x = 1", 2.0), "no": ("x = 2", 0.0)}  #: another assignment of the course, and its points


def ordinary():
    """A notebook of nbgrader's own kind, with a solution and a test."""
    said = {"schema_version": 3, "locked": False, "task": False}
    solution = code(
        "### BEGIN SOLUTION\nx = 1\n### END SOLUTION",
        nbgrader=said | {"grade": False, "solution": True, "grade_id": "answer"},
    )
    test = code(
        "assert x == 1",
        nbgrader=said | {"grade": True, "locked": True, "solution": False, "grade_id": "test", "points": 2},
    )
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": [solution, test], "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 4}


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    """A class whose students have notebooks of their own, in a course that has an ordinary assignment
    besides."""
    out = tmp_path_factory.mktemp("own")
    (out / "week3.toml").write_text(PAPER, "utf-8")
    (out / "class.csv").write_text(ROSTER, "utf-8")
    asked = [
        "build",
        out / "week3.toml",
        "--roster",
        out / "class.csv",
        "--formats",
        "nbgrader",
        "--out",
        out,
    ]
    assert run(list(map(str, asked))) == 0
    folder = out / "nbgrader"
    place = folder / "source/plain"
    place.mkdir()
    (place / "plain.ipynb").write_text(json.dumps(ordinary()), "utf-8")
    commands(folder, ["generate_assignment", "week3"], ["generate_assignment", "plain"])
    course = coursework.open_course()
    issued = json.loads((folder / "issued/week3.json").read_text("utf-8"))["issued"]
    variants: dict[str, list] = {}
    for item in issued:
        variants.setdefault(item["student"], []).append(
            course[item["record"]["exercise"]].from_record(item["record"])
        )
    ada, ben, cleo = variants.values()
    books = {s: json.loads((folder / f"own/week3/{s}/week3.ipynb").read_text("utf-8")) for s in STEMS}

    def right(some):
        return [keyed(v, right_of(v)) for v in some]

    submit(folder, "ada", "week3", answered(books["ada-byron"], *right(ada)))
    submit(folder, "102", "week3", answered(books["ada-byron"], *right(ada)))  # Ben hands in Ada's
    submit(folder, "cleo@uni.example", "week3", answered(released(folder, "week3"), *right(cleo)))
    submit(folder, "stranger", "week3", answered(books["ben-adda"], *right(ben)))
    for student, (source, _) in ORDINARY.items():
        book = released(folder, "plain")
        book["cells"][0]["source"] = source
        submit(folder, student, "plain", book)
    told = commands(folder, ["autograde", "week3"], ["autograde", "plain"], ["generate_feedback", "week3"])
    return folder, variants, told


STEMS = ("ada-byron", "ben-adda", "cleo-ney")


def test_each_is_marked_against_what_was_issued_to_them_by_e_mail_number_or_account(own):
    folder, variants, told = own
    found, waiting = points(folder)
    ada = {**scores(variants["Ada Byron"][0], right_of(variants["Ada Byron"][0]))}
    assert found["ada"].items() >= ada.items()
    assert sum(found["ada"].values()) == sum(found["cleo@uni.example"].values()) == 2 + 1 + 2.5 + 3
    assert sum(found["102"].values()) == sum(found["stranger"].values()) == 0
    assert set(found["102"]) == waiting["102"] == waiting["stranger"]
    assert "Ben Adda has" in told
    assert "no student 'stranger' on the roster" in told


def test_the_released_notebook_holds_nobody_s_numbers(own):
    folder, variants, _ = own
    text = (folder / "release/week3/week3.ipynb").read_text("utf-8")
    book = json.loads(text)
    seeds = {v.seed for some in variants.values() for v in some}
    assert not [seed for seed in seeds if f"{seed}" in text]
    assert "figure" not in text
    assert [c["metadata"]["nbgrader"] for c in grade_cells(book)] == [
        {
            **c["metadata"]["nbgrader"],
            "checksum": own["metadata"]["nbgrader"]["checksum"],
            "cell_type": "code",
        }
        for c, own in zip(
            grade_cells(json.loads((folder / "own/week3/ben-adda/week3.ipynb").read_text("utf-8"))),
            grade_cells(book),
            strict=True,
        )
    ]


def test_own_numbers_survive_the_cells_that_nbgrader_writes_anew(own):
    folder, variants, _ = own
    text = (folder / "autograded/ada/week3/week3.ipynb").read_text("utf-8")
    assert f"{variants['Ada Byron'][0].seed}" in text


def test_other_assignments_of_the_course_are_run_and_marked_as_ever(own):
    folder, *_ = own
    found, _ = points(folder)
    assert {student: found[student]["test"] for student in ORDINARY} == {
        s: p for s, (_, p) in ORDINARY.items()
    }
    assert "x = 1" not in released(folder, "plain")["cells"][0]["source"]


def test_feedback_is_in_the_language_of_the_notebook(own):
    folder, *_ = own
    assert "Votre réponse" in feedback(folder, "ada", "week3")


# ---------------------------------------------------------------------- exchange


@pytest.mark.slow
def test_through_the_exchange_from_release_to_the_points(tmp_path):
    assert run(["build", NAME, "--formats", "nbgrader", "--lang", "en", "--out", str(tmp_path)]) == 0
    folder, exchange, desk = tmp_path / "nbgrader", tmp_path / "exchange", tmp_path / "desk"
    exchange.mkdir(mode=0o777)
    exchange.chmod(0o777)
    desk.mkdir()
    around = ["--course", "mech", f"--Exchange.root={exchange}", f"--Exchange.cache={tmp_path / 'cache'}"]
    done(folder, "generate_assignment", NAME)
    done(folder, "release_assignment", NAME, *around)
    done(folder, "fetch_assignment", NAME, *around, cwd=desk)
    place = desk / NAME / f"{NAME}.ipynb"
    record = json.loads((tmp_path / "issued.json").read_text("utf-8"))["issued"][0]["record"]
    variant = coursework.open_course()[NAME].from_record(record)
    right = keyed(variant, right_of(variant))
    place.write_text(json.dumps(answered(json.loads(place.read_text("utf-8")), right)), "utf-8")
    done(folder, "submit", NAME, *around, cwd=desk)
    done(folder, "collect", NAME, *around)
    done(folder, "autograde", NAME)
    found, _ = points(folder)
    assert [sum(own.values()) for own in found.values()] == [9.0]


# ----------------------------------------------------------------- configuration


def configured(lines, folder):
    """The steps of a course whose configuration says these lines before ours."""
    code = (
        "import json\nfrom traitlets.config import Config\nfrom coursework.nbgrader import configure\n"
        "c = Config()\n"
        "from nbgrader.preprocessors import *\n"
        f"{lines}\n"
        f"for _ in range(2): configure(c, {str(folder)!r}, course='../mine')\n"
        "steps = {n: [one.__name__ for one in c.Autograde[n]] for n in ('sanitize_preprocessors', "
        "'autograde_preprocessors')}\n"
        "steps['preprocessors'] = [one.__name__ for one in c.GenerateAssignment.preprocessors]\n"
        "print(json.dumps([steps, c.MarkAnswers.folder, c.MarkAnswers.course]))\n"
    )
    return json.loads(python(folder, code).splitlines()[-1])


def test_our_steps_stand_in_the_places_of_nbgrader_s_and_the_teacher_s_stay(tmp_path):
    steps, folder, course = configured("", tmp_path)
    assert folder == str(tmp_path.resolve())
    assert course == str(tmp_path.resolve().parent / "mine")
    assert steps["sanitize_preprocessors"][:2] == ["RestoreCells", "ClearOutput"]
    assert steps["autograde_preprocessors"][0] == "MarkAnswers"
    assert "SaveMarks" in steps["autograde_preprocessors"]
    assert not {"Execute", "SaveAutoGrades"} & set(steps["autograde_preprocessors"])
    assert "KeepAnswers" in steps["preprocessors"]
    assert "ClearSolutions" not in steps["preprocessors"]
    own = (
        "c.Autograde.autograde_preprocessors = [LimitOutput, Execute, SaveAutoGrades]\n"
        "c.GenerateAssignment.preprocessors.append(LimitOutput)"
    )
    steps, *_ = configured(own, tmp_path)
    assert steps["autograde_preprocessors"] == ["LimitOutput", "MarkAnswers", "SaveMarks"]
    assert steps["preprocessors"][-1] == "LimitOutput"
    assert "KeepAnswers" in steps["preprocessors"]
