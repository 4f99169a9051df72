"""What strangers call themselves, their files and their answers acts on no terminal, breaks no JSON and is no
formula."""

from __future__ import annotations

import csv
import json
import re
import shutil
import sys
from pathlib import Path

import pytest
from rows_of_strangers import ACTING, FORMULA, computed_cells

import coursework
from coursework.cli import run
from coursework.cli.printing import print_table, progress_bar
from coursework.system.visible import one_line, visible

CLEAR, TURN, CSI = "\x1b[2J\x1b]0;own\x07", "\u202e", "\x9b31m"
EVIL = f"Eve {CLEAR}{TURN}{CSI}"
WORDS = FORMULA + CLEAR + TURN


def say(text):
    return text.encode("unicode_escape").decode()


@pytest.fixture
def hostile(small_course, tmp_path, cli):
    """A class with such names: a roster, answers of all kinds, and files."""
    roster = tmp_path / "class.csv"
    with roster.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["student", "=A1+B1"], [EVIL, FORMULA], ["Bo " + FORMULA, CSI]])
    out = tmp_path / "out"
    built = cli("--course", small_course, "build", "--roster", roster, "--formats", "html", "--out", out)
    assert built[0] == 0, built
    came = tmp_path / "came"
    came.mkdir()
    issued = json.loads((out / "issued.json").read_text("utf-8"))["issued"]
    eve, bo = (str(item["record"]["seed"]) for item in issued)
    with (came / f"a{CLEAR}{TURN}\nb.csv").open("w", encoding="utf-8", newline="") as file:
        rows = [
            [EVIL, "crank_pin", eve, "x", WORDS],
            [EVIL, "crank_pin", eve, WORDS, "1"],
            [EVIL, WORDS, eve, "x", "1"],
            [WORDS, "crank_pin", eve, "x", "1"],
            [EVIL, "crank_pin", WORDS, "x", "1"],
            ["Bo " + FORMULA, "crank_pin", bo, "x", '="a"&"b"'],
        ]
        csv.writer(file).writerows([["student", "exercise", "seed", "part", "answer"], *rows])
    (came / f"c{CLEAR}.doc").write_text("?")
    (came / f"d{CLEAR}.ipynb").write_text(
        json.dumps({"cells": [], "metadata": {"coursework": {"exercise": WORDS, "student": EVIL}}})
    )
    return small_course, out, came


def graded(hostile, cli, *more):
    course, out, came = hostile
    return cli("--course", course, "grade", came, "--issued", out / "issued.json", "--no-feedback", *more)


def test_no_command_hands_on_to_the_terminal_what_acts_on_it(hostile, cli, tmp_path):
    course, out, came = hostile
    own = ["--course", course]
    said = [
        graded(hostile, cli),
        graded(hostile, cli, "--db", tmp_path / "m.db"),
        cli(
            *own,
            "grade",
            "--from",
            out / "marks" / "marks.csv",
            "--issued",
            out / "issued.json",
            "--no-feedback",
        ),
        cli(*own, "report", out / "marks", "--out", out / "report"),
        cli(*own, "database", "list", tmp_path / "m.db"),
        cli(*own, "show", WORDS),
        cli(*own, WORDS),
        cli(*own, f"--{WORDS}"),
        cli(*own, "solve", "crank_pin", "--set", f"{WORDS}=1"),
        cli(*own, "variant", "crank_pin", "--seed", WORDS),
        cli(*own, "build", "crank_pin", "--out", tmp_path / "b", "--formats", WORDS),
        cli(*own, "grade", tmp_path / WORDS.replace("/", ""), "--issued", out / "issued.json"),
        cli(*own, "grade", came, "--issued", came / f"c{CLEAR}.doc"),
        cli("--course", tmp_path / f"no{CLEAR}", "list"),
    ]
    texts = [text for _, *texts in said for text in texts]
    assert not [say(text)[:300] for text in texts if ACTING.search(text)]
    assert sum("\\u001b]0;own" in text for text in texts) > 4


def test_a_file_whose_name_has_two_lines_forges_no_line(hostile, cli):
    _, _, errors = graded(hostile, cli)
    assert "\\u000ab.csv" in errors
    assert all(line.startswith("coursework: ") for line in errors.splitlines())


def test_json_that_is_printed_says_the_same(small_course, cli):
    """A label of the course with an acting letter in it, in the JSON and out of it."""
    text = small_course / "exercises" / "crank_pin.en.md.j2"
    for path in small_course.glob("exercises/crank_pin.*.md.j2"):
        path.write_text(
            re.sub(r"\A(.*?# \S+)", lambda title: title[1] + TURN + "\x9b", path.read_text("utf-8"), count=1),
            "utf-8",
        )
    assert text.exists()
    status, output, _ = cli("--course", small_course, "list", "--json")
    (one,) = json.loads(output)
    assert (status, ACTING.search(output)) == (0, None)
    title = coursework.open_course(small_course)["crank_pin"].title("en")
    assert TURN in title
    assert one["title"]["en"] == title


def test_what_is_shown_of_a_table_and_meanwhile_acts_on_nothing(capsys, monkeypatch):
    """On a terminal, where colours are the engine's own and stay."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm-256color")
    print_table([{"name": EVIL, f"n{CSI}": 1}], title=CLEAR)
    said = capsys.readouterr().out
    assert "\x1b[1m" in said
    assert not re.search("\x1b(?!\\[[0-9;]*m)|\x9b|\u202e|\x07", said)
    assert "\\u001b[2J" in said

    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with progress_bar("marking", 2) as advance:
        advance()
        sys.stderr.write(f"a{TURN}b{CSI}\n")
    assert not re.search("\u202e|\x9b", capsys.readouterr().err)


def test_numbers_stand_for_what_acts_and_for_nothing_else():
    assert visible("l'été\t1\r\n\u200d ☃ \\u") == "l'été\t1\r\n\u200d ☃ \\u"
    assert visible("\x00\x1b\r\x7f\x85\u2028\u2066") == r"\u0000\u001b\u000d\u007f\u0085\u2028\u2066"
    assert one_line("a\r\nb\nc") == r"a\u000d\u000ab\u000ac"


# ----------------------------------------------------------------------- tables


def test_no_table_of_a_hostile_class_holds_a_formula_and_all_are_read_back(hostile, cli, tmp_path):
    course, out, _ = hostile
    graded(hostile, cli)
    shutil.copytree(out / "marks", tmp_path / "first")
    _, told, _ = graded(hostile, cli)
    assert "not what" not in told  # its own marks are read as they were written
    assert cli("--course", course, "report", out / "marks", "--out", out / "report")[0] == 0
    _, told, _ = cli(
        "--course",
        course,
        "grade",
        "--from",
        out / "marks" / "marks.csv",
        "--issued",
        out / "issued.json",
        "--no-feedback",
    )
    assert "changed by hand" not in told
    tables = [*out.rglob("*.csv")]
    assert {"marks.csv", "summary.csv", "rejected.csv", "answers.csv", "key.csv"} <= {p.name for p in tables}
    for path in tables:
        assert not computed_cells(path.read_text("utf-8-sig")), path.name
    assert any("'=cmd" in path.read_text("utf-8-sig") for path in tables)


WRITERS = ("system/tables.py", "system/writing.py", "database/dump.py", "cli/demo.py")


def test_every_table_is_written_where_formulas_are_kept_from_running():
    package = Path(coursework.__file__).parent
    found = {
        p.relative_to(package).as_posix()
        for p in package.rglob("*.py")
        if re.search(r"csv\.(Dict)?[wW]riter\(", p.read_text("utf-8"))
    }
    assert found == set(WRITERS)


def test_the_command_line_ends_as_it_began(cli):
    before = sys.stdout, sys.stderr
    assert run(["--version"]) == 0
    assert (sys.stdout, sys.stderr) == before
