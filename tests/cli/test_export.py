"""The command line, exporting to a platform: what it tells, what it refuses, what it leaves as it was."""

from __future__ import annotations

import json

import pytest
from class_of_three import ROSTER, tree


def export(cli, out, *arguments, platform="moodle"):
    return cli("export", platform, *arguments, "--lang", "en", "--out", out)


def test_an_export_tells_what_is_lost_and_how_to_import(cli, tmp_path):
    status, said, _ = export(cli, tmp_path / "out", "grashof", "--variants", 2)
    assert status == 0
    *lost, last = said.splitlines()
    assert any(line.startswith("decimal comma (parts: 2, exercises: 1): ") for line in lost)
    assert "IMPORT.en.txt" in last
    assert "with the answers, for the staff" in last
    assert "handouts" not in {file.split("/")[0] for file in tree(tmp_path / "out")}


def test_strict_writes_nothing_where_anything_is_lost(cli, tmp_path):
    status, _, err = export(cli, tmp_path / "out", "grashof", "--variants", 2, "--strict")
    assert status == 2
    assert "--strict" in err
    assert "decimal comma" in err
    assert not (tmp_path / "out").exists()


def test_another_pool_in_the_folder_is_refused_and_stays(cli, tmp_path):
    out = tmp_path / "out"
    export(cli, out, "grashof", "--variants", 2)
    before = tree(out)
    status, _, err = export(cli, out, "slotted_mechanism", "--variants", 2)
    assert status == 2
    assert "--overwrite" in err
    assert tree(out) == before
    assert export(cli, out, "slotted_mechanism", "--variants", 2, "--overwrite")[0] == 0
    assert (
        json.loads((out / "issued.json").read_text("utf-8"))["issued"][0]["record"]["exercise"]
        == "slotted_mechanism"
    )


def test_a_larger_pool_takes_the_place_of_a_smaller_and_the_same_keeps_its_bytes(cli, tmp_path):
    out = tmp_path / "out"
    export(cli, out, "grashof", "--variants", 2)
    before = tree(out)
    assert export(cli, out, "grashof", "--variants", 2)[0] == 0
    assert tree(out) == before
    assert export(cli, out, "grashof", "--variants", 4)[0] == 0
    seeds = [one["record"]["seed"] for one in json.loads((out / "issued.json").read_text("utf-8"))["issued"]]
    assert seeds[:2] == [one["record"]["seed"] for one in json.loads(before["issued.json"])["issued"]]
    assert len(seeds) == 4


@pytest.mark.parametrize(
    ("platform", "exercise", "said"), [("moodel", "grashof", "moodle"), ("moodle", "grasshof", "grashof")]
)
def test_a_name_that_is_none_is_answered_with_the_nearest(cli, tmp_path, platform, exercise, said):
    status, _, err = export(cli, tmp_path / "out", exercise, platform=platform)
    assert status == 2
    assert f"did you mean '{said}'" in err
    assert not (tmp_path / "out").exists()


def test_as_many_variants_as_the_roster_has_students(cli, tmp_path):
    (tmp_path / "class.csv").write_text(ROSTER, "utf-8")
    assert export(cli, tmp_path / "out", "grashof", "--roster", tmp_path / "class.csv")[0] == 0
    issued = json.loads((tmp_path / "out" / "issued.json").read_text("utf-8"))
    assert len(issued["issued"]) == len(issued["students"]) == 3


ASSIGNMENT = """
title = { fr = "Devoir 3", en = "Week 3" }
versions = 3

[[exercises]]
name = "slotted_mechanism"
parts = ["rA", "theta4"]
points = { rA = 2.5 }

[[exercises]]
name = "vocabulary"
seed = 12
"""


def test_an_assignment_says_parts_points_seed_and_how_many(cli, tmp_path):
    path = tmp_path / "week3.toml"
    path.write_text(ASSIGNMENT, "utf-8")
    assert export(cli, tmp_path / "out", path)[0] == 0
    issued = json.loads((tmp_path / "out" / "issued.json").read_text("utf-8"))
    records = [one["record"] for one in issued["issued"]]
    assert [one["exercise"] for one in records] == ["slotted_mechanism"] * 3 + ["vocabulary"]
    assert records[-1]["seed"] == 12
    assert [(part["id"], part["points"]) for part in records[0]["parts"]] == [("rA", 2.5), ("theta4", 1)]
    written = (tmp_path / "out" / "week3.en.xml").read_text("utf-8")
    assert "$course$/top/Week 3/" in written
    assert "{5:NUMERICAL:" in written
    assert "{2:NUMERICAL:" in written


@pytest.mark.parametrize("option", [("--seed", 3), ("--parts", "rA")])
def test_what_the_assignment_says_is_no_option(cli, tmp_path, option):
    path = tmp_path / "week3.toml"
    path.write_text(ASSIGNMENT, "utf-8")
    status, _, err = export(cli, tmp_path / "out", path, *option)
    assert status == 2
    assert f"{option[0]} is for exercises named on the command line" in err
