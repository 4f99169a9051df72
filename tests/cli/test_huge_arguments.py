"""Arguments beyond all measure, and names that name nothing: one line, and nothing is begun."""

from __future__ import annotations

import pytest

from coursework.cli import run

MANY = "1" + "0" * 30
LONG = "9" * 5000


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["build", "slotted_mechanism", "--variants", "1", "--out", ""], "--out': names no file or folder"),
        (["build", "slotted_mechanism", "--variants", "1", "--out", "  "], "--out': names no file or folder"),
        (["simulate", "slider_crank", "--out", ""], "--out': names no file or folder"),
        (["animate", "slider_crank", "--out", ""], "--out': names no file or folder"),
        (["grade", "", "--issued", "issued.json"], "names no file or folder"),
        (["grade", "a.csv", "--issued", ""], "names no file or folder"),
        (["report", ""], "names no file or folder"),
        (["new", ""], "names no file or folder"),
        (["--course", "", "list"], "names no file or folder"),
        (["--course", "a\0b", "list"], "NUL"),
        (["build", "slotted_mechanism", "--variants", MANY], "at most 1,000,000; found '1000"),
        (["build", "slotted_mechanism", "--variants", "nan"], "1 or more; found 'nan'"),
        (["variant", "slotted_mechanism", "--count", MANY], "at most 1,000,000"),
        (["variant", "slotted_mechanism", "--seed", LONG], "0 or more; found '9999"),
        (["variant", "slotted_mechanism", "--seed", MANY], "at most 999,999,999,999,999,999"),
        (["check", "slotted_mechanism", "--variants", MANY], "at most 1,000,000"),
        (["simulate", "slider_crank", "--steps", "100000000"], "at most 1,000,000"),
        (["simulate", "slider_crank", "--steps", "1e8"], "1 or more; found '1e8'"),
        (["simulate", "slider_crank", "--drive", "torque=nan"], "found 'nan'"),
        (["serve", "--workers", MANY], "at most 256"),
        (["serve", "--port", "-1"], "0 or more; found '-1'"),
    ],
)
def test_it_is_told_in_a_line(arguments, told, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    said = capsys.readouterr().err
    assert told in said
    assert said.count("\n") == 1
    assert len(said) < 300
    assert not [*tmp_path.iterdir()]
