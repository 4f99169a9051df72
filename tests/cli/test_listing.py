"""What ``list`` keeps is never wrong, and never missed."""

import json
import os
import subprocess
import sys
import time

import pytest
from tables import each_row

from coursework.cli import run
from coursework.course.folder import course_folder
from coursework.course.listing import listing
from coursework.errors import BadCourse
from coursework.system import cache

AN_HOUR_AGO = time.time_ns() - 3_600_000_000_000


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    """A folder of this test's own for what is kept."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "coursework"


@pytest.fixture
def settled(monkeypatch):
    """Files are trusted however lately they were changed: their dates are finer than a test is quick."""
    monkeypatch.setattr(cache, "_SETTLED", -(10**12))


@pytest.fixture
def asked(small_course):
    """List the small course: what is said, and for which exercises it had to be asked."""
    text = small_course / "exercises" / "crank_pin.en.md.j2"

    def call():
        names = []

        def describe(name):
            names.append(name)
            return {"exercise": name, "title": text.read_text("utf-8").splitlines()[0]}

        return listing(course_folder(small_course), describe), names

    return call


def test_what_was_said_is_said_again_unasked(asked, own_cache, settled):
    first, names = asked()
    assert names == ["crank_pin"]
    assert asked() == (first, [])
    assert len(list(own_cache.iterdir())) == 1


@pytest.mark.parametrize(
    "file", ["exercises/crank_pin.py", "exercises/crank_pin.en.md.j2", "exercises/course.toml"]
)
def test_a_changed_file_is_seen(asked, small_course, own_cache, settled, file):
    asked()
    path = small_course / file
    path.write_text(path.read_text("utf-8") + "\n", "utf-8")
    assert asked()[1] == ["crank_pin"]
    assert asked()[1] == []


def test_a_change_that_keeps_size_and_date_is_seen(asked, small_course, own_cache, settled):
    path = small_course / "exercises" / "crank_pin.en.md.j2"
    os.utime(path, ns=(AN_HOUR_AGO, AN_HOUR_AGO))
    before, _ = asked()
    text = path.read_text("utf-8")
    path.write_text(text.replace("# ", "# Z", 1)[: len(text)], "utf-8")
    os.utime(path, ns=(AN_HOUR_AGO, AN_HOUR_AGO))
    after, names = asked()
    assert names == ["crank_pin"]
    assert after.rows[0]["title"] != before.rows[0]["title"]


def test_a_new_and_a_lost_file_are_seen(asked, small_course, own_cache, settled):
    asked()
    (small_course / "exercises" / "crank_pin.de.md.j2").write_text("# Kurbel\n", "utf-8")
    assert asked()[1] == ["crank_pin"]
    (small_course / "exercises" / "crank_pin.de.md.j2").unlink()
    assert asked()[1] == ["crank_pin"]


def test_a_file_that_may_change_within_the_grain_of_its_date_is_not_trusted(asked, own_cache):
    asked()
    assert not own_cache.exists()
    assert asked()[1] == ["crank_pin"]


def test_a_module_from_elsewhere_is_watched_too(small_course, own_cache, settled, tmp_path, monkeypatch):
    elsewhere = tmp_path / "elsewhere" / "versions_of_ours.py"
    elsewhere.parent.mkdir()
    elsewhere.write_text("version = 1\n", "utf-8")
    monkeypatch.syspath_prepend(elsewhere.parent)

    def describe(name):
        sys.modules.pop("versions_of_ours", None)
        import versions_of_ours

        return {"version": versions_of_ours.version}

    folder = course_folder(small_course)
    assert listing(folder, describe).rows == [{"version": 1}]
    elsewhere.write_text("version = 200\n", "utf-8")
    assert listing(folder, describe).rows == [{"version": 200}]


def test_what_is_broken_is_asked_each_time_and_the_rest_is_not(small_course, own_cache, settled):
    (small_course / "exercises" / "torn.py").write_text("", "utf-8")
    names = []

    def describe(name):
        names.append(name)
        if name == "torn":
            raise BadCourse("it is torn")
        return {}

    for _ in range(2):
        assert listing(course_folder(small_course), describe) == ([{}], {"torn": "it is torn"})
    assert names == ["crank_pin", "torn", "torn"]


@pytest.mark.parametrize(
    "content", ["", "{", "[]", "{}", '{"python": [], "files": {}, "loaded": {}, "said": {}}']
)
def test_what_cannot_be_read_is_not_missed(asked, own_cache, settled, content):
    first, _ = asked()
    (file,) = own_cache.iterdir()
    file.write_text(content, "utf-8")
    assert asked() == (first, ["crank_pin"])
    assert json.loads(file.read_text("utf-8"))["said"]


def test_where_nothing_can_be_kept_all_is_said(asked, tmp_path, monkeypatch, settled):
    (tmp_path / "file").write_text("", "utf-8")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert asked()[1] == asked()[1] == ["crank_pin"]


def test_links_that_lead_nowhere_or_in_a_circle_do_no_harm(asked, small_course, own_cache, settled):
    (small_course / "exercises" / ".#crank_pin.py").symlink_to("nobody@nowhere")
    (small_course / "exercises" / "assets" / "old").mkdir(parents=True)
    (small_course / "exercises" / "assets" / "old" / "all").symlink_to(small_course / "exercises")
    asked()
    assert asked()[1] == []


@pytest.mark.e2e
def test_list_sees_an_edited_exercise(small_course, own_cache, settled, capsys):
    """The command itself, in processes of its own: another version, another part, a broken file."""

    def listed():
        done = subprocess.run(
            [sys.executable, "-c", CODE, "--course", str(small_course), "list", "--json"],
            capture_output=True,
            text=True,
        )
        return done.returncode, json.loads(done.stdout), done.stderr

    _, (row,), _ = listed()
    assert listed() == (0, [row], "")
    exercise = small_course / "exercises" / "crank_pin.py"
    right = exercise.read_text("utf-8")
    exercise.write_text(
        right.replace("EXERCISE = Exercise(", "EXERCISE = Exercise(\n    version=7,"), "utf-8"
    )
    assert listed()[1] == [{**row, "version": 7}]
    exercise.write_text("EXERCISE = 1\n", "utf-8")
    status, rows, err = listed()
    assert (status, rows) == (1, [])
    assert "crank_pin cannot be listed" in err
    exercise.write_text(right, "utf-8")
    assert listed() == (0, [row], "")


CODE = """
import sys
from coursework.cli import run
from coursework.system import cache
cache._SETTLED = -(10**12)
sys.exit(run(sys.argv[1:]))
"""


def test_list_of_a_course_that_did_not_change_loads_no_exercise(small_course, own_cache):
    code = CODE.replace("sys.exit(run(sys.argv[1:]))", "run(sys.argv[1:]); print('loaded', *sys.modules)")
    command = [sys.executable, "-c", code, "--course", str(small_course), "list"]
    first, again = (
        subprocess.run(command, capture_output=True, text=True, check=True).stdout.partition("loaded ")
        for _ in range(2)
    )
    assert first[0] == again[0]
    assert "crank_pin" in first[0]
    assert "numpy" in first[2].split()
    assert not {"numpy", "rich", "coursework.model"} & set(again[2].split())


def test_tables_are_the_same_by_hand_and_by_the_library(capsys, monkeypatch):
    from coursework.cli import printing

    rows = [
        {"name": "crank", "título": "Bielle\nand crank", "n": 3, "unit": "rad/s²"},
        {"name": "[b]x[/b]", "título": "", "n": -12.5, "unit": "mm  s"},
    ]
    for title in ("", "a title"):
        printing.print_table(rows, title)
        by_hand = capsys.readouterr().out
        with monkeypatch.context() as patch:
            patch.setattr(printing, "_ruled", lambda *_: [])
            printing.print_table(rows, title)
        assert by_hand == capsys.readouterr().out


@each_row("text", ["θ₄", "日本", "a\tb", " edge", "w" * 300])
def test_a_table_that_is_not_plain_is_left_to_the_library(text):
    from coursework.cli.printing import _ruled

    assert not _ruled([["column"], [text]], [False], "")


def test_list_prints_the_same_from_what_was_kept(capsys, own_cache, settled):
    assert run(["list"]) == 0
    first = capsys.readouterr().out
    assert len(list(own_cache.iterdir())) == 1
    assert run(["list"]) == 0
    assert capsys.readouterr().out == first
