"""A name that is not UTF-8, as archives from Windows leave them, costs no answer: files, folders,
archives."""

from __future__ import annotations

import io
import json
import os
import zipfile
from pathlib import Path

import pytest
from class_of_three import table

from coursework.cli import run
from coursework.errors import BadInput
from coursework.system.unzipping import unpack

ODD = b"pr\xe9nom"


def can_be_named(folder):
    try:
        os.mkdir(os.path.join(os.fsencode(folder), ODD))
    except (OSError, ValueError):
        return False
    return True


@pytest.fixture
def issued(small_course, tmp_path):
    """What was issued, beside a folder of answers whose names are not UTF-8."""
    if not can_be_named(tmp_path):
        pytest.skip("this system has no such names")
    assert (
        run(
            [
                "--course",
                str(small_course),
                *"build crank_pin --formats ipynb --out".split(),
                str(tmp_path / "b"),
            ]
        )
        == 0
    )
    return json.loads((tmp_path / "b" / "issued.json").read_text("utf-8"))["issued"][0]["record"]


def hand_in(tmp_path, record):
    """Files of every kind: a CSV, JSON, a notebook in a folder of Moodle's and one by itself, what is not a
    file of answers."""
    place = os.path.join(os.fsencode(tmp_path), b"in")
    part, seed = record["parts"][0]["id"], record["seed"]
    about = {"exercise": "crank_pin", "seed": seed, "student": ""}
    cell = {
        "cell_type": "code",
        "metadata": {"tags": ["answers"]},
        "source": f"answers = {{{part!r}: '3'}}",
        "outputs": [],
    }
    notebook = {"cells": [cell], "metadata": {"coursework": about}, "nbformat": 4, "nbformat_minor": 5}
    sheet = {"student": "Jo", "exercise": "crank_pin", "seed": seed, "answers": {part: "2"}}
    files = {
        ODD + b".csv": f"student,exercise,seed,part,answer\nAda,crank_pin,{seed},{part},1\n",
        ODD + b".json": json.dumps(sheet),
        ODD + b".ipynb": json.dumps(notebook),
        b"R\xe9mi_41_assignsubmission_file/" + ODD + b".ipynb": json.dumps(notebook),
        ODD + b".pdf": "%PDF",
        ODD + b".p\xe9f": "",
    }
    for name, text in files.items():
        path = os.path.join(place, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(text)


@pytest.mark.parametrize("more", [(), ("--db", "marks.db")], ids=["folder", "database"])
def test_names_that_are_not_utf_8_cost_no_answer(small_course, tmp_path, issued, monkeypatch, more):
    monkeypatch.chdir(tmp_path)
    hand_in(tmp_path, issued)
    words = ["--course", str(small_course), "grade", "in", "--issued", "b/issued.json", "--out", "out", *more]
    assert run([*words, "--formats", "html"]) == 1
    students = {row["student"] for row in table(tmp_path / "out" / "marks.csv")}
    assert students == {"Ada", "Jo", r"pr\xe9nom", r"R\xe9mi"}
    rejected = {row["source"] for row in table(tmp_path / "out" / "rejected.csv")}
    assert rejected == {str(Path("in") / r"pr\xe9nom.pdf"), str(Path("in") / r"pr\xe9nom.p\xe9f")}
    assert len([*(tmp_path / "out" / "feedback").iterdir()]) == 4


def test_a_path_that_is_named_itself_is_told(small_course, tmp_path, issued, capsys):
    hand_in(tmp_path, issued)
    odd = os.fsdecode(os.path.join(os.fsencode(tmp_path), b"in", ODD + b".csv"))
    words = ["--course", str(small_course), "grade", odd, "--issued", str(tmp_path / "b/issued.json")]
    assert run([*words, "--no-feedback"]) == 0
    assert run([*words[:3], odd + "x", *words[4:]]) == 2
    assert "did you mean" in capsys.readouterr().err


def zipped(name, flag):
    """An archive with a file of these bytes for its name, which is said to be UTF-8 or not."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr("x" * len(name), b"some text")
        archive.filelist[0].flag_bits |= flag
    return made.getvalue().replace(b"x" * len(name), name)


def test_an_archive_from_windows_is_unpacked(tmp_path):
    (tmp_path / "a.zip").write_bytes(zipped(b"pr\x82nom.csv", 0))
    (tmp_path / "out").mkdir()
    assert [path.name for path in unpack(tmp_path / "a.zip", tmp_path / "out")] == ["prénom.csv"]


def test_an_archive_that_lies_about_its_names_is_refused_in_a_sentence(tmp_path):
    data = bytearray(zipped(b"pr\xe9nom.csv", 0))
    for mark, place in ((b"PK\1\2", 8), (b"PK\3\4", 6)):
        data[data.index(mark) + place + 1] |= 0x08
    (tmp_path / "a.zip").write_bytes(data)
    with pytest.raises(BadInput, match="cannot be opened"):
        unpack(tmp_path / "a.zip", tmp_path)
