"""What Canvas's own importers read from our packages. Canvas itself is no program that a test can bring up.

``COURSEWORK_CANVAS_QTI`` names a checkout of the gem ``qti`` (github.com/instructure/qti), with which New
Quizzes read a package; Ruby and the packages that ``canvas_reads.rb`` names must be there.
``COURSEWORK_CANVAS_MIGRATE`` names a checkout of ``QTIMigrationTool``
(github.com/instructure/QTIMigrationTool), with which the classic quizzes read one, and needs ``lxml`` in the
Python that ``COURSEWORK_CANVAS_PYTHON`` names (this one unless told).
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from platforms.canvas_reader import quiz_of, unpacked

from coursework.platforms.platform import platform_of
from coursework.platforms.pools import of_exercises

GEM = os.environ.get("COURSEWORK_CANVAS_QTI", "")
TOOL = os.environ.get("COURSEWORK_CANVAS_MIGRATE", "")
PYTHON = os.environ.get("COURSEWORK_CANVAS_PYTHON", sys.executable)
HERE = Path(__file__).parent
A = "{http://www.imsglobal.org/xsd/imsqti_v2p1}"

with_gem = pytest.mark.skipif(not (GEM and shutil.which("ruby")), reason="COURSEWORK_CANVAS_QTI names no gem")
with_tool = pytest.mark.skipif(not TOOL, reason="COURSEWORK_CANVAS_MIGRATE names no tool")


@pytest.fixture(scope="module")
def packages(course, tmp_path_factory):
    """The package of every exercise, both languages in turn, unpacked."""
    folder = tmp_path_factory.mktemp("canvas")
    for place, name in enumerate(course.names):
        canvas, lang = platform_of("canvas"), ("en", "fr")[place % 2]
        (file,) = canvas.files(of_exercises(course, [name], 2, 0, [lang], None).pool(lang, canvas))
        for path, data in unpacked(file.make()).items():
            (folder / name / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / name / path).write_bytes(data)
    return folder


def ours(folder):
    files = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*.*")}
    return quiz_of(files)


@with_gem
def test_new_quizzes_read_every_exercise_as_it_was_written(packages):
    folders = sorted(packages.iterdir())
    run = subprocess.run(
        ["ruby", "-I", f"{GEM}/lib", HERE / "canvas_reads.rb", *folders],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=True,
    )
    read = [json.loads(line) for line in run.stdout.splitlines()]
    assert len(read) == len(folders)
    for folder, found in zip(folders, read, strict=True):
        wanted = ours(folder)
        assert [group["title"] for group in found["groups"]] == list(wanted)
        assert sum(g["pick"] * g["points"] for g in found["groups"]) == found["points"]
        assert not found["shuffled"]
        for group in found["groups"]:
            pick, points, questions = wanted[group["title"]]
            assert (group["pick"], group["points"]) == (pick, points)
            for one, question in zip(group["items"], questions, strict=True):
                same_question(one, question)


SORTS = {
    "numerical_question": "NumericInteraction",
    "multiple_choice_question": "ChoiceInteraction",
    "multiple_answers_question": "ChoiceInteraction",
    "essay_question": "StringInteraction",
}


def same_question(read, question):
    assert (read["identifier"], read["points"]) == (question["ident"], question["points"])
    assert read["sort"] == SORTS[question["sort"]]
    assert question["label"] in read["body"]
    assert read["body"].count("<mi>") == question["text"].count("<mi>")
    assert read["body"].count("<img") == question["text"].count("<img")
    if question["sort"] == "numerical_question":
        for scored, one in zip(read["scored"], question["conditions"], strict=True):
            low, high = float(one["low"][0]), float(one["high"][0])
            value, margin = float(scored["value"]), float(scored.get("margin", 0))
            assert scored["type"] == ("exactResponse" if low == high else "marginOfError")
            assert value - margin == pytest.approx(low, rel=1e-9, abs=1e-9)
            assert value + margin == pytest.approx(high, rel=1e-9, abs=1e-9)
    elif question["sort"] == "multiple_choice_question":
        right = [ident for one in question["conditions"] if one["pays"] for ident in one["equal"]]
        assert [scored["values"] for scored in read["scored"]] == right
        assert list(read["answers"]) == list(question["offered"])
        assert {f"{ident}_fb" for ident in read["words"]} == set(question["said"])


@with_tool
@pytest.mark.parametrize("name", ["slotted_mechanism", "vocabulary", "four_bar_positions", "mobility"])
def test_classic_quizzes_translate_it_with_margins_and_pictures(packages, tmp_path, name):
    run = subprocess.run(
        [
            PYTHON,
            "-W",
            "ignore",
            f"{TOOL}/migrate.py",
            "--ucvars",
            "--nogui",
            "--nocomment",
            "--overwrite",
            f"--cpout={tmp_path}",
            str(packages / name),
        ],
        capture_output=True,
        text=True,
        check=True,
    )
    wanted = {q["ident"]: q for _, _, some in ours(packages / name).values() for q in some}
    items = {
        root.get("identifier"): root
        for root in (ET.parse(path).getroot() for path in (tmp_path / "assessmentItems").glob("*.xml"))
    }
    assert set(items) == set(wanted), run.stdout
    assert {p.name for p in (packages / name).rglob("*.svg")} == {p.name for p in tmp_path.rglob("*.svg")}
    for ident, question in wanted.items():
        fields = {one.get("name"): one.get("value") for one in items[ident].iter(f"{A}instructureField")}
        assert fields["question_type"] == question["sort"]
        assert float(fields["points_possible"]) == question["points"]
        body = "".join(items[ident].find(f"{A}itemBody").itertext())
        assert question["label"] in body
        if question["sort"] == "numerical_question":
            ends = [
                (upper.find(f"{A}baseValue").text, upper.get("class"))
                for upper in items[ident].iter(f"{A}customOperator")
            ]
            assert ends == [
                end
                for one in question["conditions"]
                for end in ((one["low"][0], "vargte"), (one["high"][0], "varlte"))
            ]
    groups = list(
        ET.parse(next((tmp_path / "assessmentTests").glob("*.xml"))).getroot().iter(f"{A}selection")
    )
    assert len(groups) == len(ours(packages / name))
    assert {one.get("select") for one in groups} == {"1"}
