"""What a build writes for nbgrader: cells of its schema, one notebook for a class, own notebooks, and what it
refuses."""

from __future__ import annotations

import json

import pytest
from nbgrader_course import answers_cells, grade_cells
from tables import each_row

import coursework
from coursework.cli import run
from coursework.course.answer_keys import answer_keys
from coursework.issuing.issued import Issued
from coursework.platforms.nbgrader.marking import marked_notebook

ROSTER = "student,e-mail\nAda Byron,ada@uni.example\nBen Adda,ben@uni.example\n"


def built(out, *asked):
    (out / "class.csv").write_text(ROSTER, "utf-8")
    return run([*map(str, asked), "--formats", "nbgrader", "--lang", "fr", "--out", str(out)])


def book_of(out, name, where="source"):
    return json.loads((out / f"nbgrader/{where}/{name}.ipynb").read_text("utf-8"))


def record_of(out):
    return json.loads((out / "issued.json").read_text("utf-8"))["issued"][0]["record"]


@pytest.mark.parametrize("step", [15, pytest.param(6, marks=pytest.mark.slow)])
def test_every_exercise_has_one_locked_cell_a_part_with_its_points(tmp_path, course, step):
    names = [name for name in course.names if name not in ("parallel_joints", "serial_joints")][::step]
    assert built(tmp_path, "build", *names) == 0
    for name in names:
        book = book_of(tmp_path, f"{name}/{name}")
        issued = json.loads((tmp_path / f"nbgrader/issued/{name}.json").read_text("utf-8"))["issued"]
        keys = answer_keys(course[name].from_record(issued[0]["record"]).parts)
        graded = [cell["metadata"]["nbgrader"] for cell in grade_cells(book)]
        parts = issued[0]["record"]["parts"]
        assert [one["grade_id"] for one in graded] == [f"coursework-{name}-{keys[p['id']]}" for p in parts]
        assert [one["points"] for one in graded] == [p["points"] for p in parts]
        assert all(one["locked"] and not one["solution"] and one["schema_version"] == 3 for one in graded)
        (answers,) = answers_cells(book)
        assert answers["metadata"]["nbgrader"]["solution"]
        assert not answers["metadata"]["nbgrader"]["locked"]
        ids = [c["metadata"]["nbgrader"]["grade_id"] for c in book["cells"] if "nbgrader" in c["metadata"]]
        assert len(set(ids)) == len(ids)
        assert not any("attachments" in cell for cell in book["cells"])


def test_a_notebook_that_is_collected_asks_for_no_name(tmp_path):
    assert built(tmp_path, "build", "grashof") == 0
    (answers,) = answers_cells(book_of(tmp_path, "grashof/grashof"))
    assert "student" not in "".join(answers["source"])


def test_nothing_of_the_staff_s_lies_where_nbgrader_copies_it_to_students(tmp_path):
    assert built(tmp_path, "build", "grashof", "--roster", tmp_path / "class.csv") == 0
    files = [p.name for p in (tmp_path / "nbgrader/source").rglob("*") if p.is_file()]
    assert files == ["grashof.ipynb"]
    assert "Ada" not in (tmp_path / "nbgrader/source/grashof/grashof.ipynb").read_text("utf-8")


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["grashof", "--variants", "3"], "--roster"),
        (["grashof", "--lang", "fr,en"], "--lang fr or --lang en"),
        (["serial_joints", "--roster", "class.csv"], "ask different parts"),
    ],
)
def test_what_one_notebook_cannot_hold_is_refused_with_what_would_do(
    tmp_path, monkeypatch, capsys, asked, said
):
    monkeypatch.chdir(tmp_path)
    students = "".join(f"Student {n},s{n}@uni.example\n" for n in range(12))
    (tmp_path / "class.csv").write_text("student,e-mail\n" + students, "utf-8")
    assert run(["build", *asked, "--formats", "nbgrader", "--out", "out"]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out/nbgrader").exists()


def test_who_makes_up_has_a_notebook_of_their_own_and_the_class_keeps_its(tmp_path):
    (tmp_path / "week3.toml").write_text('versions = 1\n[[exercises]]\nname = "grashof"\n', "utf-8")
    roster = ["--roster", tmp_path / "class.csv"]
    assert built(tmp_path, "build", tmp_path / "week3.toml", *roster) == 0
    before = (tmp_path / "nbgrader/source/week3/week3.ipynb").read_bytes()
    assert built(tmp_path, "build", tmp_path / "week3.toml", *roster, "--make-up", "Ada Byron") == 0
    assert (tmp_path / "nbgrader/source/week3/week3.ipynb").read_bytes() == before
    own = [p.parent.name for p in (tmp_path / "nbgrader/own").rglob("*.ipynb")]
    assert own == ["ada-byron.sitting-2"]


# ------------------------------------------------------------------------- marking


def test_points_of_a_cell_are_never_more_than_nbgrader_has_for_it_and_a_difference_is_told(tmp_path):
    assert built(tmp_path, "build", "grashof") == 0
    variant = coursework.open_course()["grashof"].from_record(record_of(tmp_path))
    book = book_of(tmp_path, "grashof/grashof")
    own = {key: str(variant.solution()[part]) for part, key in answer_keys(variant.parts).items()}
    answers_cells(book)[0]["source"] = "answers = " + json.dumps(own)
    marked = marked_notebook(
        None, tmp_path / "nbgrader/issued/grashof.json", "ada", json.dumps(book).encode()
    )
    name, (points, out_of) = next(iter(marked.points.items()))
    assert points == out_of > 0
    told: list[str] = []
    assert marked.grade_outputs(name, out_of, told.append)[-1]["data"]["text/plain"] == repr(out_of)
    assert not told
    assert marked.grade_outputs(name, out_of / 2, told.append)[-1]["data"]["text/plain"] == repr(out_of / 2)
    assert "generate_assignment" in told[0]
    assert marked.grade_outputs("coursework-none", 3.0)[-1]["data"]["text/plain"] == "0.0"


def test_what_a_student_wrote_is_text_in_the_page_that_staff_see(tmp_path):
    assert built(tmp_path, "build", "slotted_mechanism") == 0
    book = book_of(tmp_path, "slotted_mechanism/slotted_mechanism")
    evil = "<img src=x onerror=alert(1)>"
    answers_cells(book)[0]["source"] = "answers = " + json.dumps({"rA": evil, evil: "1"})
    issued = tmp_path / "nbgrader/issued/slotted_mechanism.json"
    marked = marked_notebook(None, issued, "ada", json.dumps(book).encode())
    shown = [
        out["data"].get("text/html", "")
        for some in (*marked.outputs.values(), *marked.notes.values())
        for out in some
    ]
    assert any("&lt;img" in one for one in shown)
    assert not any("<img" in one for one in shown)


# --------------------------------------------------------------------------- whose


@pytest.fixture(scope="module")
def issued():
    students = {
        "Ada Byron": {"E-mail": "Ada.B@uni.example", "Number": "101", "seat": "7"},
        "Ben Adda": {
            "E-mail": "ben@uni.example",
            "Number": "102",
            "seat": "101",
            "parents' mail": "home@else.example",
        },
        "Ben Other": {
            "E-mail": "ben@else.example",
            "Number": "102",
            "seat": "8",
            "parents' mail": "home@else.example",
        },
    }
    record = coursework.open_course()["grashof"].variant(1, "en").record
    items = [{"student": name, "record": record} for name in students]
    return Issued({"roster": True, "students": students, "issued": items}, "issued.json")


@each_row(
    ("called", "who"),
    [
        ("ada.b@UNI.example", "Ada Byron"),
        ("101", "Ada Byron"),
        ("ada.b", "Ada Byron"),
        ("BEN  ADDA", "Ben Adda"),
        ("ben@else.example", "Ben Other"),
        ("ben", None),
        ("102", None),
        ("home@else.example", None),
        ("7", None),
        ("8", None),
        ("", None),
        ("eve", None),
    ],
)
def test_a_student_is_known_by_what_is_theirs_alone(issued, called, who):
    assert issued.account([called]) == who
