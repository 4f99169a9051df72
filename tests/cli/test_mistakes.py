"""The command line: one line for each mistake of a user or an author."""

from __future__ import annotations

import json

import pytest


@pytest.mark.e2e
def test_a_new_course_lists_builds_and_checks_as_it_is(cli, tmp_path):
    folder = tmp_path / "mine"
    assert cli("new", folder)[0] == 0
    assert cli("new", folder, "tram_linkage")[0] == 0
    status, out, _ = cli("--course", folder, "list", "--json")
    assert [e["exercise"] for e in json.loads(out)] == ["crank_pin", "tram_linkage"]
    status, out, _ = cli("--course", folder, "check", "--variants", 60)
    assert status == 0, out
    assert (
        cli("--course", folder, "build", "--variants", 1, "--lang", "fr,en", "--out", tmp_path / "o")[0] == 0
    )


def test_new_never_overwrites(cli, small_course):
    assert cli("new", small_course)[0] == 2
    assert cli("new", small_course, "crank_pin")[0] == 2
    assert "small letters" in cli("new", small_course, "Crank-Pin")[2]


def test_check_reports_a_broken_promise_with_status_1(cli, small_course):
    path = small_course / "solutions" / "crank_pin.py"
    path.write_text(
        path.read_text("utf-8").replace("return r * cos(theta)", "return r * sin(theta)"), "utf-8"
    )
    status, out, _ = cli("--course", small_course, "check", "--variants", 5)
    assert status == 1
    assert "known case" in out
    status, out, _ = cli("--course", small_course, "check", "--variants", 5, "--json")
    assert json.loads(out)["failures"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["show", "sloted_mechanism"], "did you mean 'slotted_mechanism'"),
        (["show", "slotted_mechanism", "--lang", "de"], "no language 'de'"),
        (
            ["show", "slotted_mechanism", "--seed", "-1"],
            "--seed': takes a whole number, 0 or more; found '-1'",
        ),
        (
            ["show", "slotted_mechanism", "--seed", "1.5"],
            "--seed': takes a whole number, 0 or more; found '1.5'",
        ),
        (["grade", "none.csv", "--issued", "."], "name the issued.json of the build"),
        (["solve", "slotted_mechanism", "--set", "r1"], "NAME=VALUE"),
        (["solve", "slotted_mechanism", "--set", "r1=3kg", "--only", "rA"], "r1 is in mm"),
        (["solve", "slotted_mechanism", "--set", "r1=-3", "--only", "rA"], "r1 must be positive"),
        (
            ["solve", "slotted_mechanism", "--set", "r1=3", "--only", "rA"],
            "rA needs r2 and theta2, which are not given; add --set r2=… --set theta2=…",
        ),
        (["solve", "slotted_mechanism", "--set", "r9=3", "--only", "rA"], "no quantity 'r9'"),
        (
            ["solve", "slotted_mechanism", "--set", "r1=300", "--set", "r2=100", "--only", "rAA"],
            "did you mean 'rA'",
        ),
        (
            ["solve", "slotted_mechanism", "--set", "r1=100", "--set", "r2=300", "--only", "swing"],
            "swing does not exist",
        ),
        (["build", "slotted_mechanism", "--formats", "docx", "--out", "x"], "no 'docx'"),
        (["build", "slotted_mechanism", "--lang", "de", "--out", "x"], "no language 'de'"),
        (["build", "slotted_mechanism", "--variants", "0", "--out", "x"], "--variants"),
        (["build", "slotted_mechanism"], "--out"),
        (["build", "slotted_mechanism", "--roster", "none.csv", "--out", "x"], "none.csv"),
        (["grade", "none.csv", "--issued", "none.json"], "none.json"),
        (["--course", "nowhere", "list"], "no such folder"),
        (["--course", ".", "list"], "has no folder 'exercises'"),
        (["buld"], "buld"),
        (["variant", "slotted_mechanism", "--sed", "3"], "--sed"),
    ],
)
def test_a_users_mistake_is_one_line_and_status_2(cli, tmp_path, monkeypatch, arguments, told):
    monkeypatch.chdir(tmp_path)
    status, _, err = cli(*arguments)
    assert status == 2
    assert told in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("roster", "told"),
    [
        ("", "--columns name=1"),
        ("nome\nAnn\n", "--columns name=1"),
        ("student\n", "names no student"),
        ("student\nAnn\nann\n", "line 2"),
        ("student\nJosé\nJose\u0301\n", "is already on line 2"),
        ("student\nO'Neil\nO’Neil\n", "is already on line 2"),
        ("student,lang\nAnn,xx\n", "no language 'xx'"),
        ("student,lang\nAnn,fr\n ,en\n", "line 3: no name"),
        ("student,lang\nAnn,fr\nDurand, Paul,en\n", "line 3: 3 cells where the header has 2"),
        ("student\nAnn\nBo\0\n", "not a CSV"),
        ("student\n\nAnn\nann\n", "line 4: ann is already on line 3"),
    ],
)
def test_a_bad_roster_is_told_by_its_line(cli, tmp_path, roster, told):
    (tmp_path / "r.csv").write_text(roster, "utf-8")
    status, _, err = cli(
        "build", "slotted_mechanism", "--roster", tmp_path / "r.csv", "--out", tmp_path / "o"
    )
    assert status == 2
    assert told in err


@pytest.mark.parametrize("content", ["{", "[]", "{}", '{"issued": []}', '{"issued": [{"student": "A"}]}'])
def test_a_damaged_issued_file_is_told(cli, tmp_path, content):
    (tmp_path / "issued.json").write_text(content, "utf-8")
    (tmp_path / "a.csv").write_text("student,exercise,seed,part,answer\n", "utf-8")
    status, _, err = cli("grade", tmp_path / "a.csv", "--issued", tmp_path / "issued.json")
    assert status == 2
    assert "issued.json" in err


def test_a_folder_named_for_the_issued_file_in_it_is_told(cli, tmp_path):
    (tmp_path / "issued.json").write_text("{}", "utf-8")
    status, _, err = cli("grade", tmp_path, "--issued", tmp_path)
    assert status == 2
    assert f"did you mean {tmp_path / 'issued.json'}?" in err


def test_an_author_is_told_the_file_and_line_of_a_slip(cli, small_course):
    path = small_course / "exercises" / "crank_pin.py"
    path.write_text(path.read_text("utf-8").replace('Part("x", unit="mm"),', 'Part("x", unit="mm"'), "utf-8")
    status, _, err = cli("--course", small_course, "show", "crank_pin")
    assert status == 2
    assert "exercises/crank_pin.py" in err
    assert "line" in err


def test_list_names_the_others_where_one_exercise_is_broken(cli, small_course):
    assert cli("new", small_course, "tram_linkage")[0] == 0
    path = small_course / "exercises" / "crank_pin.py"
    path.write_text(path.read_text("utf-8").replace('Part("x", unit="mm"),', 'Part("x", unit="mm"'), "utf-8")
    status, out, err = cli("--course", small_course, "list")
    assert status == 1
    assert "tram_linkage" in out
    assert err.startswith("coursework: crank_pin cannot be listed: exercises/crank_pin.py")
    status, out, err = cli("--course", small_course, "list", "--json")
    assert status == 1
    assert [row["exercise"] for row in json.loads(out)] == ["tram_linkage"]
    assert "crank_pin" in err
