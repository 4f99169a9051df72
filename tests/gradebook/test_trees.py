"""Trees of submissions: the folder says who, where the notebook names nobody; the time is kept; nothing
beside is an answer."""

from __future__ import annotations

import json

import pytest
from class_of_three import table
from collected_pools import EXERCISE, graded

from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.gradebook.submission_folders import submitted_file
from coursework.gradebook.submissions import find, read_file


def notebook(student="", seed=4, **answers):
    about = {"exercise": EXERCISE, "seed": seed, "student": student}
    cell = {
        "cell_type": "code",
        "metadata": {"tags": ["answers"]},
        "source": f"answers = {answers!r}",
        "outputs": [],
    }
    return json.dumps(
        {"cells": [cell], "metadata": {"coursework": about}, "nbformat": 4, "nbformat_minor": 5}
    )


def write(folder, path, content):
    place = folder / path
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_text(content, "utf-8")
    return place


def rows_of(*paths):
    found = [row for one in find(paths) for row in ([one] if isinstance(one, Rejected) else read_file(one))]
    return [r for r in found if isinstance(r, AnswerRow)], [r for r in found if isinstance(r, Rejected)]


TREES = {
    "nbgrader": "submitted/{}/week3/slotted.ipynb",
    "exchange": "inbound/{}+week3+2026-11-22 19:13:05.123456 UTC+x7f/slotted.ipynb",
    "Moodle": "{}_41253_assignsubmission_file/slotted.ipynb",
}


@pytest.mark.parametrize("tree", TREES)
def test_the_folder_is_the_student_where_the_notebook_names_none(tmp_path, tree):
    for name in ("Ann Doe", "Émile D’Été"):
        write(tmp_path, TREES[tree].format(name), notebook(rA="111.535", theta4="72"))
    rows, rejected = rows_of(tmp_path)
    assert [(r.student, r.part, r.warning) for r in rows] == [
        (name, part, "") for name in ("Ann Doe", "Émile D’Été") for part in ("rA", "theta4")
    ]
    assert rejected == []


def test_files_that_a_tree_keeps_beside_are_no_rows_and_the_time_is_kept(tmp_path):
    write(tmp_path, "submitted/adoe/week3/slotted.ipynb", notebook(rA="111.535"))
    write(tmp_path, "submitted/adoe/week3/timestamp.txt", "2026-11-22 19:13:05.123 UTC\n")
    write(tmp_path, "submitted/adoe/week3/submission_secret.txt", "abc")
    book = graded(tmp_path / "out", tmp_path / "submitted")
    assert (book.rows_in, book.marked, book.rejected) == (1, 1, [])
    assert table(tmp_path / "out/marks/marks.csv")[0]["submitted"] == "2026-11-22 19:13:05.123 UTC"
    assert book.seen == (f"{tmp_path / 'submitted'} is nbgrader's tree of submissions, 1 file",)


@pytest.mark.parametrize("named", ["inbound", "inbound/*", "inbound/*/*"])
def test_of_an_exchange_the_last_submission_alone_counts(tmp_path, named):
    """An earlier one is no rejected row, even if it cannot be read or answers more; of another assignment it
    stays. The same if a shell names the folders or the files."""
    for time, content in (
        ("09:00:00", notebook(rA="1", theta4="72")),
        ("11:00:00.5", notebook(rA="111.535")),
        ("11:00:00", "no notebook"),
    ):
        write(tmp_path, f"inbound/adoe+week3+2026-11-22 {time} UTC+a/slotted.ipynb", content)
    write(tmp_path, "inbound/adoe+week2+2026-11-23 09:00:00 UTC/other.ipynb", notebook(seed=5, rA="2"))
    write(tmp_path, "inbound/adoe+week2+2026-11-23 09:00:00 UTC/timestamp.txt", "2026-11-23 09:00:00 UTC")
    book = graded(tmp_path / "out", *sorted(tmp_path.glob(named)))
    marks = {m["part"]: (m["answer"], m["submitted"]) for m in table(tmp_path / "out/marks/marks.csv")}
    assert marks["rA"] == ("111.535", "2026-11-22 11:00:00.5 UTC")
    assert (book.rows_in, book.rejected, book.review_count) == (2, [], 0)


CLASS = {"Ann Doe": {"ID": "4711", "login": "adoe"}, "Bob Ray": {"ID": "4712", "login": "bray"}}


@pytest.mark.parametrize(
    "name", ["doeann_4711_990_slotted.ipynb", "doeann_LATE_4711_990_slotted.ipynb", "doeann_1_990_a.ipynb"]
)
def test_canvas_tells_the_student_in_the_files_name(tmp_path, name):
    write(tmp_path, f"submissions/{name}", notebook(rA="111.535"))
    book = graded(tmp_path / "out", tmp_path / "submissions", students=CLASS)
    assert book.rejected == []
    assert [row["student"] for row in table(tmp_path / "out/marks/marks.csv")] == ["Ann Doe"]


def test_a_login_and_a_name_that_are_one_student_agree(tmp_path):
    write(tmp_path, "submitted/adoe/week3/a.ipynb", notebook("ann doe", rA="111.535"))
    assert graded(tmp_path / "out", tmp_path / "submitted", students=CLASS).rejected == []


def test_a_notebook_of_another_than_who_handed_it_in_is_nobodys(tmp_path):
    write(tmp_path, "submitted/bray/week3/a.ipynb", notebook("Ann Doe", rA="111.535"))
    write(tmp_path, "submitted/adoe/week3/a.ipynb", notebook("Ann Doe", rA="1"))
    book = graded(tmp_path / "out", tmp_path / "submitted", students=CLASS)
    (rejected,) = book.rejected
    assert "submitted by Bob Ray (bray), but it names Ann Doe" in rejected.reason
    assert [row["answer"] for row in table(tmp_path / "out/marks/marks.csv")] == ["1"]


def test_a_folder_that_is_nobody_on_the_roster_leaves_the_notebooks_name(tmp_path):
    write(tmp_path, "submitted/x81/week3/a.ipynb", notebook("Ann Doe", rA="111.535"))
    assert graded(tmp_path / "out", tmp_path / "submitted", students=CLASS).rejected == []


def test_a_notebook_that_cannot_be_read_is_told_with_its_student(tmp_path):
    write(tmp_path, "submitted/adoe/week3/a.ipynb", "{")
    _, (rejected,) = rows_of(tmp_path)
    assert rejected.row["student"] == "adoe"


@pytest.mark.parametrize(
    "path", ["ann.ipynb", "submitted/ann.ipynb", "submitted/week3/ann.ipynb", "slotted_mechanism_4.ipynb"]
)
def test_another_folder_says_nobody(tmp_path, path):
    assert submitted_file(write(tmp_path, path, "")) is None
