"""Gradescope's autograder as Gradescope runs it: the zip unpacked into its folders, a submission,
``run_autograder`` as a process.

Gradescope itself cannot be had; what it takes is held to its published form of ``results.json``.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
from tables import each_row

import coursework
from coursework.cli import run
from coursework.course.answer_keys import answer_keys
from coursework.platforms.gradescope import REQUIREMENTS
from coursework.system.links import LEADS_OUT

pytestmark = pytest.mark.e2e

PAPER = """title = "Week 3"
lang = "en"
mark = { of = 20 }
answers = "ANSWERS"
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
ROSTER = "student,email\nAda Byron,ada@uni.example\nBen Adda,ben@uni.example\n"


def built(out, answers="shown"):
    """A build and its autograder, unpacked as Gradescope does: the variants by student, and the folder."""
    (out / "week3.toml").write_text(PAPER.replace("ANSWERS", answers), "utf-8")
    (out / "class.csv").write_text(ROSTER, "utf-8")
    asked = [
        "build",
        out / "week3.toml",
        "--roster",
        out / "class.csv",
        "--formats",
        "ipynb",
        "--out",
        out / "w",
    ]
    assert run(list(map(str, asked))) == 0
    assert (
        run(["export", "gradescope", "--issued", str(out / "w/issued.json"), "--out", str(out / "gs")]) == 0
    )
    place = out / "autograder"
    with zipfile.ZipFile(out / "gs/autograder.zip") as file:
        file.extractall(place / "source")
    shutil.copy(place / "source/run_autograder", place / "run_autograder")
    course = coursework.open_course()
    variants: dict[str, list] = {}
    for item in json.loads((out / "w/issued.json").read_text("utf-8"))["issued"]:
        record = item["record"]
        variants.setdefault(item["student"], []).append(course[record["exercise"]].from_record(record))
    return place, variants


@pytest.fixture(scope="module")
def autograder(tmp_path_factory):
    return built(tmp_path_factory.mktemp("gradescope"))


def user(name, email, **more):
    return {"name": name, "email": email, "id": 1, "sid": "", **more}


ADA, BEN = user("Ada B.", "Ada@uni.example"), user("Ben Adda", "ben@uni.example")


def submitted(place, files, *users, python=sys.executable, **about):
    """What the autograder writes of a submission: the results, and the process."""
    for folder in ("submission", "results"):
        shutil.rmtree(place / folder, ignore_errors=True)
        (place / folder).mkdir()
    for name, content in files.items():
        data = content if isinstance(content, bytes) else content.encode("utf-8", "surrogatepass")
        (place / "submission" / name).write_bytes(data)
    told = {"id": 7, "created_at": "2026-12-04T10:00:00.000000-05:00", "users": list(users), **about}
    (place / "submission_metadata.json").write_text(json.dumps(told), "utf-8")
    around = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    around |= {"AUTOGRADER": str(place), "AUTOGRADER_PYTHON": str(python)}
    process = subprocess.run(
        ["bash", str(place / "run_autograder")], env=around, capture_output=True, text=True, timeout=120
    )
    found = json.loads((place / "results/results.json").read_text("utf-8"))
    checked(found)
    assert "Traceback" not in process.stdout + json.dumps(found)
    return found


def checked(found):
    """Results of the form that Gradescope publishes."""
    assert found["score"] >= 0
    assert isinstance(found["output"], str)
    for one in found["tests"]:
        assert one["visibility"] in ("visible", "hidden", "after_due_date", "after_published")
        assert one["name"]
        if "score" in one:
            assert 0 <= one["score"] <= one["max_score"]
            assert one["status"] == ("passed" if one["score"] == one["max_score"] else "failed")
            assert one["output_format"] == "text"
    assert math.isclose(found["score"], sum(one.get("score", 0) for one in found["tests"]))


def keyed(variant, answers):
    keys = answer_keys(variant.parts)
    return {keys[part]: str(value) for part, value in answers.items()}


def notebook(place, stem, *answers):
    """A student's notebook of the build, with answers."""
    book = json.loads((place.parent / f"w/handouts/{stem}.en.ipynb").read_text("utf-8"))
    cells = [cell for cell in book["cells"] if "answers" in cell["metadata"].get("tags", ())]
    for cell, own in zip(cells, answers, strict=True):
        lines = "".join(f"    {json.dumps(k)}: {json.dumps(v)},\n" for k, v in own.items())
        cell["source"] = f"answers = {{\n{lines}}}"
    return json.dumps(book)


def rows(student, variants, answers):
    """A CSV of answers."""
    lines = ["student,exercise,seed,part,answer"]
    for variant, own in zip(variants, answers, strict=True):
        lines += [f'{student},{variant.exercise.name},{variant.seed},{p},"{a}"' for p, a in own.items()]
    return "\n".join(lines) + "\n"


def right(some):
    return [{p: str(v) for p, v in variant.solution().items()} for variant in some]


def ours(out, files, tmp_path):
    """The points of a student by ``coursework grade``, part by part: another way to the same."""
    import csv

    for name, content in files.items():
        (tmp_path / name).write_text(content, "utf-8")
    names = [str(tmp_path / name) for name in files]
    run(
        [
            "grade",
            *names,
            "--issued",
            str(out / "w/issued.json"),
            "--no-feedback",
            "--out",
            str(tmp_path / "m"),
        ]
    )
    with (tmp_path / "m/marks.csv").open(encoding="utf-8-sig", newline="") as file:
        return {(row["exercise"], row["part"]): float(row["points"]) for row in csv.DictReader(file)}


# ------------------------------------------------------------------------- marking


def test_points_are_those_of_grade_question_by_question(autograder, tmp_path):
    place, variants = autograder
    slotted, grashof = right(variants["Ada Byron"])
    slotted["rA"] = str(float(slotted["rA"]) * 1.2)
    slotted["theta4"] = "a quarter"
    files = {
        "week3.ipynb": notebook(
            place,
            "ada-byron",
            keyed(variants["Ada Byron"][0], slotted),
            keyed(variants["Ada Byron"][1], grashof),
        )
    }
    found = submitted(place, files, ADA)
    points = ours(place.parent, files, tmp_path)
    scored = [one for one in found["tests"] if "score" in one]
    assert [one["score"] for one in scored] == list(points.values())
    assert 0 < found["score"] < 8.5
    assert found["score"] == pytest.approx(sum(points.values()))
    assert [one["number"] for one in scored][:4] == ["1.1", "1.2", "1.3", "2.1"]
    assert "not read yet" in scored[1]["output"]
    assert f"Mark: {math.floor(40 * found['score'] / 8.5 + 0.5) / 2:g} / 20" in found["output"]


def test_a_table_and_the_file_that_the_page_saves_are_read_as_well(autograder):
    place, variants = autograder
    answers = right(variants["Ada Byron"])
    table = rows("Ada Byron", variants["Ada Byron"], answers)
    sheets = [
        {"student": "", "exercise": v.exercise.name, "seed": v.seed, "answers": own}
        for v, own in zip(variants["Ada Byron"], answers, strict=True)
    ]
    for files in ({"mine.csv": table}, {"answers.json": json.dumps(sheets)}):
        assert submitted(place, files, ADA)["score"] == 8.5


def test_right_answers_are_told_when_grades_are_published_and_only_if_the_assignment_shows_them(
    autograder, tmp_path
):
    for (place, variants), shown in ((autograder, True), (built(tmp_path, "never"), False)):
        found = submitted(place, {"a.ipynb": notebook(place, "ada-byron", {}, {})}, ADA)
        value = f"{variants['Ada Byron'][0].solution()['rA']:.4g}"
        telling = [one for one in found["tests"] if value in one["output"]]
        assert [one["visibility"] for one in telling] == (["after_published"] if shown else [])
        assert value not in found["output"]


# ---------------------------------------------------------------------------- whose


def test_another_student_s_notebook_earns_nothing_and_says_why(autograder):
    place, variants = autograder
    files = {
        "a.ipynb": notebook(
            place,
            "ada-byron",
            *[
                keyed(v, own)
                for v, own in zip(variants["Ada Byron"], right(variants["Ada Byron"]), strict=True)
            ],
        )
    }
    found = submitted(place, files, BEN)
    assert found["score"] == 0
    assert "another student's" in found["output"]
    assert submitted(place, files, ADA)["score"] == 8.5


def test_a_stranger_is_told_and_gets_nothing(autograder):
    place, _ = autograder
    found = submitted(
        place, {"a.ipynb": notebook(place, "ada-byron", {}, {})}, user("Eve", "eve@uni.example")
    )
    assert found["score"] == 0
    assert "Eve" in found["output"]
    assert found["tests"] == []


def test_a_group_is_marked_as_the_one_whose_variant_was_answered(autograder):
    place, variants = autograder
    answers = [
        keyed(v, own) for v, own in zip(variants["Ada Byron"], right(variants["Ada Byron"]), strict=True)
    ]
    files = {"a.ipynb": notebook(place, "ada-byron", *answers)}
    found = submitted(place, files, BEN, ADA, user("Eve", "eve@uni.example"))
    assert found["score"] == 8.5
    assert "variant of Ada Byron" in found["output"]


@each_row(
    ("own", "said"),
    [
        ({}, "Handed in 3 h 30 min after"),
        ({"assignment": {"due_date": "2026-12-05T00:00:00.000000-05:00"}}, ""),
    ],
)
def test_who_is_late_is_told_and_an_extension_counts(autograder, own, said):
    place, _ = autograder
    files = {"a.ipynb": notebook(place, "ada-byron", {}, {})}
    due = {"due_date": "2026-12-04T06:30:00.000000-05:00", "late_due_date": None}
    found = submitted(place, files, {**ADA, **own}, assignment=due)
    assert ("Handed in" in found["output"]) is bool(said)
    assert said in found["output"]


def test_a_resubmission_is_marked_alone(autograder):
    place, variants = autograder
    answers = [
        keyed(v, own) for v, own in zip(variants["Ada Byron"], right(variants["Ada Byron"]), strict=True)
    ]
    before = [{"submission_time": "2026-12-03T10:00:00.0-05:00", "score": 1.0, "results": {"tests": []}}]
    files = {"a.ipynb": notebook(place, "ada-byron", *answers)}
    assert submitted(place, files, ADA, previous_submissions=before)["score"] == 8.5


# -------------------------------------------------------------------------- hostile


@each_row(
    "files",
    [
        {},
        {"week3.ipynb": "this is not a notebook"},
        {"week3.ipynb": "[" * 100_000},
        {"week3.ipynb": b"\xff\xfe\x00"},
        {"answers.csv": ""},
        {"answers.json": '{"student": "Ada Byron", "exercise": "grashof", "answers": {"q1": NaN}}'},
        {"solve.py": "open('ran', 'w')", "photo.jpg": b"\x89"},
        {"\udce9.ipynb".encode("utf-8", "surrogateescape").decode("latin-1"): "{}"},
    ],
)
def test_whatever_is_handed_in_the_results_are_valid_with_a_sentence(autograder, files):
    place, _ = autograder
    found = submitted(place, files, ADA)
    assert found["score"] == 0
    told = [found["output"], *(one["output"] for one in found["tests"])]
    assert any("look at it" in one for one in told)


def test_nothing_of_a_submission_is_run(autograder):
    place, _ = autograder
    marker = place / "ran"
    evil = f"open({str(marker)!r}, 'w').close()"
    book = json.loads(notebook(place, "ada-byron", {}, {}))
    book["cells"].insert(
        0, {"cell_type": "code", "source": evil, "metadata": {"tags": ["answers"]}, "outputs": []}
    )
    modules = ("numpy.py", "json.py", "coursework.py", "sitecustomize.py", "conftest.py")
    found = submitted(place, {"a.ipynb": json.dumps(book), **dict.fromkeys(modules, evil)}, ADA)
    assert found["score"] == 0
    assert not marker.exists()


def test_a_link_out_of_the_submission_is_not_followed(autograder):
    place, _ = autograder
    submitted(place, {}, ADA)
    (place / "submission/mine.json").symlink_to(place / "source/issued.json")
    around = {**os.environ, "AUTOGRADER": str(place), "AUTOGRADER_PYTHON": sys.executable}
    subprocess.run(["bash", str(place / "run_autograder")], env=around, check=True, timeout=120)
    found = json.loads((place / "results/results.json").read_text("utf-8"))
    told = found["output"]
    assert ("mine.json" in told, LEADS_OUT in told, '"students"' in told) == (True, True, False)


def test_without_its_python_and_without_its_data_there_are_results(autograder):
    place, _ = autograder
    found = submitted(place, {}, ADA, python="/no/such/python")
    assert "stopped" in found["output"]
    (place / "source/issued.json").rename(place / "source/away")
    try:
        assert "could not be marked" in submitted(place, {}, ADA)["output"]
    finally:
        (place / "source/away").rename(place / "source/issued.json")


# ------------------------------------------------------------------------------ zip


def test_the_zip_needs_no_more_than_its_setup_installs(autograder):
    """What prints sheets cannot be imported there, and a notebook is marked all the same."""
    place, _ = autograder
    book = notebook(place, "ada-byron", {"rA": "1"}, {})
    submitted(place, {"a.ipynb": book}, ADA)
    others = "click rich typst nbformat pyarrow nbgrader tex2typst pytest".split()
    code = (
        "import sys\n"
        f"for name in {others!r}: sys.modules[name] = None\n"
        "from coursework.platforms._autograder import main\n"
        "main()\n"
    )
    (place / "results/results.json").unlink()
    around = {**os.environ, "AUTOGRADER": str(place), "PYTHONPATH": str(place / "source")}
    subprocess.run([sys.executable, "-P", "-c", code], env=around, check=True, timeout=120, cwd=place)
    assert len(json.loads((place / "results/results.json").read_text("utf-8"))["tests"]) > 4
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))["project"]
    stated = set(project["dependencies"])
    assert set(REQUIREMENTS) <= stated


def test_the_scripts_are_scripts_and_no_answer_is_in_the_zip(autograder):
    place, variants = autograder
    with zipfile.ZipFile(place.parent / "gs/autograder.zip") as file:
        for name in ("setup.sh", "run_autograder"):
            assert file.getinfo(name).external_attr >> 16 & 0o111
            assert subprocess.run(["bash", "-n"], input=file.read(name), check=False).returncode == 0
        names = file.namelist()
        told = file.read("issued.json").decode() + file.read("autograder.json").decode()
    assert not [
        name for name in names if {"key.json", "key.csv", "__pycache__", "instructor"} & set(name.split("/"))
    ]
    assert repr(variants["Ada Byron"][0].solution()["rA"]) not in told


def test_an_export_without_what_was_issued_says_what_would_do(tmp_path, capsys):
    assert run(["export", "gradescope", "--out", str(tmp_path / "gs")]) == 2
    assert "--issued" in capsys.readouterr().err


def test_an_export_of_exercises_is_of_what_a_build_of_the_same_issues(tmp_path):
    secret = 'secret = "0b6c5d1f2a9e47388c1fd2b7a4e3905d"\n'
    (tmp_path / "week3.toml").write_text(secret + PAPER.replace("ANSWERS", "shown"), "utf-8")
    (tmp_path / "class.csv").write_text(ROSTER, "utf-8")
    for name, asked in (("paper", str(tmp_path / "week3.toml")), ("alone", "grashof")):
        of = [asked, "--roster", str(tmp_path / "class.csv")]
        built, exported = tmp_path / name, tmp_path / f"{name}-gs"
        assert run(["build", *of, "--formats", "html", "--out", str(built)]) == 0
        assert run(["export", "gradescope", *of, "--out", str(exported)]) == 0
        issued = (built / "issued.json").read_bytes()
        assert (exported / "issued.json").read_bytes() == issued
        with zipfile.ZipFile(exported / "autograder.zip") as file:
            assert file.read("issued.json") == issued


def test_a_course_of_one_s_own_goes_along(small_course, tmp_path):
    asked = ["--course", str(small_course)]
    assert (
        run(
            [*asked, "build", "crank_pin", "--formats", "ipynb", "--lang", "en", "--out", str(tmp_path / "w")]
        )
        == 0
    )
    assert (
        run(
            [
                *asked,
                "export",
                "gradescope",
                "--issued",
                str(tmp_path / "w/issued.json"),
                "--out",
                str(tmp_path / "gs"),
            ]
        )
        == 0
    )
    place = tmp_path / "autograder"
    with zipfile.ZipFile(tmp_path / "gs/autograder.zip") as file:
        file.extractall(place / "source")
    shutil.copy(place / "source/run_autograder", place / "run_autograder")
    record = json.loads((tmp_path / "w/issued.json").read_text("utf-8"))["issued"][0]["record"]
    variant = coursework.open_course(small_course)["crank_pin"].from_record(record)
    table = rows("Ada", [variant], right([variant]))
    assert submitted(place, {"a.csv": table}, ADA)["score"] == variant.grade({}).out_of
