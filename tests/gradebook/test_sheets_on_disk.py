"""Answers that go by the disk come to the very files, and to the same is said, as those that memory holds."""

from __future__ import annotations

import csv
import json
import tempfile

import pytest
from collected_pools import RECORDED, graded
from small_assignment import issue, item, right, table, write

import coursework
from coursework.errors import BadInput, CourseworkError
from coursework.gradebook import class_marking, sheets_on_disk
from coursework.gradebook.grading import grade_files

CRASHES = "4321"


@pytest.fixture
def course(small_course):
    return coursework.open_course(small_course)


@pytest.fixture
def by_disk(monkeypatch):
    """Where it is called, next to nothing is held."""

    def small(batch=3):
        monkeypatch.setattr(sheets_on_disk, "AT_ONCE", batch)
        monkeypatch.setattr(sheets_on_disk, "PARTS", 3)
        monkeypatch.setattr(sheets_on_disk, "_BLOCK", 1)
        monkeypatch.setattr(class_marking, "CHUNK", 2)

    return small


@pytest.fixture
def crashing(monkeypatch):
    """A sheet with a certain answer cannot be marked."""
    usual = class_marking.mark

    def mark(variant, answers, right):
        if CRASHES in answers.values():
            raise CourseworkError("no mark for this")
        return usual(variant, answers, right)

    monkeypatch.setattr(class_marking, "mark", mark)


def written(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def told(book):
    return (
        book.rows_in,
        book.blanks,
        book.marked,
        book.rejected,
        book.warnings,
        book.faults,
        book.waiting,
        book.changes,
        book.seen,
        list(book.students.items()),
        list(book.exercises.items()),
        book.unread(),
    )


def notebook(student, seed, **answers):
    about = {"exercise": "crank_pin", "seed": seed, "student": student}
    cell = {"cell_type": "code", "metadata": {"tags": ["answers"]}, "source": f"answers = {answers!r}"}
    return json.dumps(
        {"cells": [cell], "metadata": {"coursework": about}, "nbformat": 4, "nbformat_minor": 5}
    )


def files_of(course, folder):
    """A class as it comes: rows of a sheet far apart, in several files and kinds; twice, empty, forged,
    unreadable, of strangers."""
    students = {"Ada": 5, "Bo": 6, "Cy": 8, "Di": 9, "Eve": 10, "Flo": 11, "Gil": 12}
    items = [item(course, s, seed) for s, seed in students.items()] + [item(course, "Ada", 7, sitting=2)]
    issued = issue(folder, items)
    sheets = [row for s, seed in students.items() for row in right(course, s, seed)]
    first = sorted(sheets[:12], key=lambda row: row[3]) + right(course, "Ada", 7, v="0")
    odd = [
        ("Nobody", "crank_pin", "5", "v", "1"),
        ("Bo", "crank_pin", "5", "v", "1"),  # another's
        ("Ada", "crank_pin", "", "x", "3"),  # of which sitting?
        ("Cy", "crank_pin", "8", "speed", "2"),  # no such part
        *(("Eve", "crank_pin", "10", row[3], "who knows") for row in sheets[:3] if row[3] not in "vx"),
        ("Eve", "crank_pin", "10", "v", ""),
        ("Eve", "crank_pin", "10", "x", "  "),
        ("Gil", "crank_pin", "12", "nothing", "2"),  # nothing of hers can be placed
        ("Flo", "crank_pin", "11", "v", CRASHES),
    ]
    folder.joinpath("in").mkdir()
    write(folder / "in" / "a.csv", first + odd)
    write(folder / "in" / "b.csv", first[:5] + sheets[12:15] + [("Eve", "crank_pin", "10", "v", "12,5")])
    again = {"student": "Di", "exercise": "crank_pin", "seed": 9, "answers": {"v": 1.5, "x": [1, 2], "y": {}}}
    (folder / "in" / "c.json").write_text(json.dumps([again, {**again, "student": "Cy"}, 7]), "utf-8")
    (folder / "in" / "d.ipynb").write_text(notebook("Bo", 6, v="3", x="1"), "utf-8")
    (folder / "in" / "e.ipynb").write_text(notebook("bo", 6, v="3", x="1"), "utf-8")
    (folder / "in" / "f.csv").write_text("student;answer\nAda;3\n", "utf-8")
    (folder / "in" / "g.xlsx").write_bytes(b"PK")
    return issued


def both(by_disk, make, tmp_path, batch=3):
    """What two ways come to, in turn, of a folder of the same name."""
    found = []
    for way in ("memory", "disk"):
        if way == "disk":
            by_disk(batch)
        found.append((make(tmp_path / "here"), written(tmp_path / "here")))
        (tmp_path / "here").rename(tmp_path / way)
    return found


@pytest.mark.parametrize("batch", [3, *(pytest.param(n, marks=pytest.mark.slow) for n in (1, 7))])
def test_a_mixed_class_twice_over(course, tmp_path, by_disk, crashing, batch):
    issued = files_of(course, tmp_path)
    accepted = "student,exercise,part,points,reason\nCy,crank_pin,v,1,well argued\nGil,crank_pin,v,,spoken\n"

    def twice(out):
        said = [told(grade_files(course, [tmp_path / "in"], issued, out, feedback=True))]
        (out / "accepted.csv").write_text(accepted, "utf-8")
        said.append(told(grade_files(course, [tmp_path / "in" / "a.csv"], issued, out, feedback=False)))
        return said

    memory, disk = both(by_disk, twice, tmp_path, batch)
    assert memory == disk
    marks, rejected = (table(tmp_path / "disk" / f"{name}.csv") for name in ("marks", "rejected"))
    assert {m["verdict"] for m in marks} >= {"correct", "unreadable", "accepted", "missing"}
    assert any("no mark for this" in r["reason"] for r in rejected)
    assert len({r["reason"].split()[0] for r in rejected}) >= 4
    assert table(tmp_path / "disk" / "changes.csv")
    assert {"feedback/ada.pdf", "feedback/ada.sitting-2.pdf"} <= disk[1].keys()


@pytest.mark.parametrize("feedback", [True, False])
@pytest.mark.parametrize("roster", [None, {"Ann Doe": {"Email address": "ann@example.org"}}])
def test_attempts_of_a_platform(tmp_path, by_disk, roster, feedback):
    names = ("moodle_responses.csv", "moodle_responses_fr.csv", "moodle_responses.json")

    def make(folder):
        return told(graded(folder, *(RECORDED / n for n in names), students=roster, feedback=feedback))

    memory, disk = both(by_disk, make, tmp_path)
    assert memory == disk
    assert "sitting" in table(tmp_path / "disk/marks/marks.csv")[0]


def test_the_disk_is_taken_where_rows_are_many_and_for_no_fewer(course, tmp_path, monkeypatch):
    issued = files_of(course, tmp_path)
    made = []
    usual = tempfile.TemporaryFile
    monkeypatch.setattr(tempfile, "TemporaryFile", lambda dir: made.append(dir) or usual(dir=dir))
    out = tmp_path / "new" / "out"
    for most, times in ((10_000, 0), (10, 2)):
        monkeypatch.setattr(sheets_on_disk, "AT_ONCE", most)
        grade_files(course, [tmp_path / "in"], issued, out, feedback=False)
        assert len(made) == times
    assert made == [out] * 2
    tables = {"marks.csv", "summary.csv", "rejected.csv", "changes.csv"}
    assert {p.name for p in out.iterdir() if not p.name.startswith(".")} == tables


def test_nothing_is_left_where_nothing_can_be_marked(course, tmp_path, by_disk):
    by_disk()
    issued = issue(tmp_path, [item(course, "Ada", 5)])
    file = write(tmp_path / "a.csv", [("Nobody", "crank_pin", "5", "v", "1")] * 9)
    with pytest.raises(BadInput, match="9 rows rejected; the first one"):
        grade_files(course, [file], issued, tmp_path / "out", feedback=False)
    assert not (tmp_path / "out").exists()


def test_what_is_held_at_once_is_bounded(course, tmp_path, monkeypatch):
    """However many rows come: no batch, part or group of sheets on the way is larger than is said."""
    monkeypatch.setattr(sheets_on_disk, "AT_ONCE", 50)
    monkeypatch.setattr(class_marking, "CHUNK", 4)
    issued = issue(tmp_path, [item(course, "", seed) for seed in (5, 6)])
    path = tmp_path / "answers.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(("student", "exercise", "seed", "part", "answer"))
        rows.writerows((f"s{n % 200}", "crank_pin", 5, part, n) for part in "vx" for n in range(200))
    sizes = []
    usual = sheets_on_disk._Blocks.add

    def add(self, number, things):
        sizes.append(len(things))
        usual(self, number, things)

    monkeypatch.setattr(sheets_on_disk._Blocks, "add", add)
    together = sheets_on_disk._together
    monkeypatch.setattr(sheets_on_disk, "_together", lambda some: sizes.append(len(some)) or together(some))
    book = grade_files(course, [path], issued, tmp_path / "out", feedback=False)
    assert (book.rows_in, book.marked) == (400, 400)
    assert max(sizes) <= 50
    assert [m["student"] for m in table(tmp_path / "out/marks.csv")] == [
        f"s{n}" for n in range(200) for _ in "vx"
    ]
