"""An export: the platform's files, what was issued, what is lost, how to import it."""

from __future__ import annotations

import csv
import io
import json
from functools import cache

import pytest

import coursework
from coursework.issuing.roster import Student
from coursework.platforms import pools
from coursework.platforms.exporting import export, steps
from coursework.platforms.platform import platform_of, platforms
from coursework.platforms.pools import alike, of_exercises
from coursework.system.blocks import processors

COURSE = coursework.open_course()
#: Gradescope hands nothing out: what was built is exported for it, by tests of its own.
every_platform = pytest.mark.parametrize("platform", [name for name in platforms() if name != "gradescope"])


def made(platform, langs=("en", "fr"), students=(), names=("grashof", "slotted_mechanism"), count=1):
    drawn = of_exercises(COURSE, names, count, 0, langs, None)
    return export(platform_of(platform), drawn, students)


def read(made):
    contents = {file.path.as_posix(): file.make() for file in made.files}
    return {path: data if isinstance(data, bytes) else b"".join(data) for path, data in contents.items()}


once = cache(made)


@every_platform
@pytest.mark.e2e
def test_the_same_export_has_the_same_bytes(platform):
    assert read(once(platform)) == read(made(platform))


@every_platform
def test_beside_the_files_stand_what_was_issued_and_what_is_lost(platform):
    exported = once(platform)
    files = read(exported)
    assert {"issued.json", "lost.csv", "IMPORT.en.txt", "IMPORT.fr.txt"} < set(files)
    issued = json.loads(files["issued.json"])
    assert issued["pool"] is True
    assert [one["student"] for one in issued["issued"]] == [""] * 2
    assert {one["record"]["exercise"] for one in issued["issued"]} == {"grashof", "slotted_mechanism"}
    assert "answers" not in json.dumps(issued)
    rows = list(csv.DictReader(io.StringIO(files["lost.csv"].decode("utf-8-sig"))))
    assert len(rows) == len(exported.lost)
    assert list(rows[0]) == ["exercise", "part", "feature", "instead"]
    assert files["IMPORT.fr.txt"].decode() == steps(platform, "fr")
    assert [line.partition(".")[0] for line in files["IMPORT.en.txt"].decode().splitlines()] == list("123456")


def test_students_are_kept_for_the_way_back():
    student = Student("Zoé", columns={"email": "zoe@example.org"})
    issued = json.loads(read(made("moodle", students=[student]))["issued.json"])
    assert issued["roster"] is True
    assert issued["students"] == {"Zoé": {"email": "zoe@example.org"}}


@pytest.mark.parametrize("name", COURSE.names)
def test_variants_of_a_pool_are_worth_the_same(name):
    """Nobody's paper is longer: where most ask the same, all do; else they are worth the same, in as many
    questions."""
    drawn = of_exercises(COURSE, [name], 4, 0, ["en"], None)
    (variants,) = drawn.variants
    assert len({(sum(p.points for p in v.parts), len(v.parts)) for v in variants}) == 1
    assert len({v.seed for v in variants}) == 4
    fits = alike(COURSE[name], 0, None)
    assert all(fits(variant) for variant in variants)


@pytest.mark.e2e
def test_processes_make_the_same_pool(monkeypatch):
    one = {platform: read(made(platform)) for platform in ("moodle", "qti3")}
    monkeypatch.setattr(pools, "_WORTH_PROCESSES", 2)
    monkeypatch.setattr(pools, "_CHUNK", 2)
    assert pools.workers(2, 2) == min(2, processors())
    assert {platform: read(made(platform)) for platform in one} == one
