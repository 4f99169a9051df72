"""The command line, as an instructor meets it: the whole job, and one line for each mistake."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path

import pytest

from coursework.cli import run

ROSTER = "student,lang\nÉmilie Lefèvre,fr\nDavid O'Neil,en\nemilie lefevre 2,\n"


@pytest.fixture
def cli(capsys):
    """Run a command; gives its status, output and errors."""

    def call(*arguments):
        status = run([str(a) for a in arguments])
        said = capsys.readouterr()
        assert "Traceback" not in said.err + said.out
        return status, said.out, said.err

    return call


def table(path):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def tree(folder):
    return {
        p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()
    }


# ------------------------------------------------------------------- look and solve


def test_list_names_every_exercise(cli, course):
    status, out, _ = cli("list", "--json")
    assert status == 0
    assert [e["exercise"] for e in json.loads(out)] == list(course.names)
    status, out, _ = cli("list")
    assert all(name in out for name in course.names)


def test_show_prints_a_statement_in_either_language(cli):
    assert "manivelle" in cli("show", "slotted_mechanism", "--seed", 3)[1]
    assert "crank" in cli("show", "slotted_mechanism", "--seed", 3, "--lang", "en")[1]


def test_variant_prints_one_record_a_line(cli, course):
    status, out, _ = cli("variant", "slotted_mechanism", "--seed", 5, "--count", 3, "--json")
    records = [json.loads(line) for line in out.splitlines()]
    assert status == 0
    assert [r["seed"] for r in records] == [5, 6, 7]
    assert all("answers" not in r for r in records)
    assert records[0] == course["slotted_mechanism"].variant(5).record
    assert set(records[0]) == {"exercise", "version", "seed", "lang", "given", "parts"}


@pytest.mark.parametrize("name", ["slotted_mechanism", "ball_reducer", "slider_extras"])
def test_variant_with_its_solution_is_json_for_every_kind_of_part(cli, name):
    status, out, _ = cli("variant", name, "--seed", 1, "--solution", "--json")
    record = json.loads(out)
    assert status == 0
    assert set(record["answers"]) == {p["id"] for p in record["parts"]}
    assert all(set(a) == {"value", "unit", "tolerance"} for a in record["answers"].values())
    assert cli("variant", name, "--solution")[0] == 0


def test_solve_on_ones_own_numbers_in_any_unit(cli):
    arguments = [
        "--set",
        "r1=228.6mm",
        "--set",
        "r2=0.1143 m",
        "--set",
        "theta2=135deg",
        "--only",
        "rA,theta4",
    ]
    status, out, _ = cli("solve", "slotted_mechanism", *arguments, "--json")
    found = json.loads(out)
    assert status == 0
    assert found["exercise"] == "slotted_mechanism"
    assert found["given"]["r2"] == {"value": 114.3, "unit": "mm"}
    assert found["quantities"]["rA"]["value"] == pytest.approx(319.80, abs=0.005)
    assert found["quantities"]["theta4"] == {"value": pytest.approx(104.64, abs=0.005), "unit": "deg"}
    assert "319.804" in cli("solve", "slotted_mechanism", *arguments)[1]


# --------------------------------------------------------------------- the main job


@pytest.fixture
def built(cli, tmp_path):
    (tmp_path / "class.csv").write_text(ROSTER, "utf-8")
    out = tmp_path / "out"
    status, said, _ = cli(
        "build", "slotted_mechanism", "four_bar_positions", "--roster", tmp_path / "class.csv", "--out", out,
        "--formats", "pdf,ipynb", "--seed", 7,
    )  # fmt: skip
    assert status == 0
    assert str(out) in said
    return out


def test_build_writes_the_tree_of_the_contract(built):
    files = tree(built)
    assert {"issued.json", "answers.csv", "instructor/key.json", "instructor/key.csv"} <= set(files)
    handouts = {f for f in files if f.startswith("handouts/slotted_mechanism/")}
    assert handouts == {
        f"handouts/slotted_mechanism/{stem}.{ending}"
        for stem in ("emilie-lefevre.fr", "david-o-neil.en", "emilie-lefevre-2.fr")
        for ending in ("pdf", "ipynb")
    }
    assert "instructor/slotted_mechanism/david-o-neil.en.solution.pdf" in files
    assert all(data for data in files.values())


def test_the_same_command_gives_the_same_bytes(built, cli, tmp_path):
    again = tmp_path / "again"
    cli(
        "build", "slotted_mechanism", "four_bar_positions", "--roster", tmp_path / "class.csv", "--out", again,
        "--formats", "pdf,ipynb", "--seed", 7,
    )  # fmt: skip
    assert tree(again) == tree(built)


def test_issued_and_form_hold_no_answer_and_the_key_holds_them_all(built):
    issued = json.loads((built / "issued.json").read_text("utf-8"))
    assert [i["student"] for i in issued["issued"][:3]] == [
        "Émilie Lefèvre",
        "David O'Neil",
        "emilie lefevre 2",
    ]
    assert "answers" not in (built / "issued.json").read_text("utf-8")
    assert all(row["answer"] == "" for row in table(built / "answers.csv"))
    # A spreadsheet shows the accents of names by the mark at the head.
    assert (built / "answers.csv").read_bytes().startswith(b"\xef\xbb\xbfstudent,")
    assert (built / "instructor" / "key.csv").read_bytes().startswith(b"\xef\xbb\xbfstudent,")
    key = json.loads((built / "instructor" / "key.json").read_text("utf-8"))
    assert [k["seed"] for k in key] == [i["record"]["seed"] for i in issued["issued"]]
    assert all(set(k["answers"]) == {p["id"] for p in k["parts"]} for k in key)
    assert len(table(built / "instructor" / "key.csv")) == sum(len(k["answers"]) for k in key)


def test_each_student_has_a_variant_of_their_own_and_their_language(built):
    records = [i["record"] for i in json.loads((built / "issued.json").read_text("utf-8"))["issued"]]
    given = [json.dumps(r["given"]) for r in records if r["exercise"] == "slotted_mechanism"]
    assert len(set(given)) == 3
    assert [r["lang"] for r in records[:3]] == ["fr", "en", "fr"]


def test_build_does_not_replace_other_variants_unasked(built, cli, tmp_path):
    status, _, err = cli("build", "slotted_mechanism", "--variants", 2, "--formats", "ipynb", "--out", built)
    assert status == 2
    assert "--overwrite" in err
    assert (built / "handouts" / "four_bar_positions").exists()
    status, *_ = cli(
        "build", "slotted_mechanism", "--variants", 2, "--formats", "ipynb", "--out", built, "--overwrite"
    )
    assert status == 0
    assert not (built / "handouts" / "four_bar_positions").exists()


def filled(built, change=lambda row: row):
    """The empty form with the right answers put in, each row then changed."""
    right = {
        (k["exercise"], k["seed"]): k["answers"]
        for k in json.loads((built / "instructor/key.json").read_text("utf-8"))
    }
    rows = table(built / "answers.csv")
    for row in rows:
        row["answer"] = str(right[row["exercise"], int(row["seed"])][row["part"]]["value"])
    return [change(row) for row in rows]


def write_rows(path, rows):
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, ["student", "exercise", "seed", "part", "answer"])
        writer.writeheader()
        writer.writerows(rows)
    return path


def test_the_form_filled_with_the_key_has_full_marks(built, cli, tmp_path):
    rows = filled(built)
    path = write_rows(tmp_path / "answers.csv", rows)
    status, out, _ = cli("grade", path, "--issued", built / "issued.json", "--out", tmp_path / "marks")
    assert status == 0
    marks = table(tmp_path / "marks" / "marks.csv")
    assert [m["verdict"] for m in marks] == ["correct"] * len(rows)
    assert [(m["student"], m["part"], m["answer"]) for m in marks] == [
        (r["student"], r["part"], r["answer"]) for r in rows
    ]
    summary = table(tmp_path / "marks" / "summary.csv")
    assert [s["percent"] for s in summary] == ["100.0"] * 3
    assert len(list((tmp_path / "marks" / "feedback").glob("*.pdf"))) == 3
    assert f"{len(rows)} rows" in out


def test_every_damaged_row_is_reported_and_nothing_else_is_lost(built, cli, tmp_path):
    rows = filled(built)
    good = len(rows)
    first = rows[0]
    rows += [
        {**first, "student": "Zoé"},
        {**first, "seed": "999"},
        {**first, "seed": "seven"},
        {**first, "part": "rB"},
        {**first, "exercise": "slotted"},
        {**first, "exercise": "zz"},
        {**first, "student": ""},
        first,
        {**first, "seed": rows[-1]["seed"], "student": rows[-1]["student"].upper()},
    ]
    path = write_rows(tmp_path / "answers.csv", rows)
    with path.open("a", encoding="utf-8") as file:
        file.write("half a row\n")
    (tmp_path / "bad.ipynb").write_text("{", "utf-8")
    status, _, err = cli(
        "grade",
        path,
        tmp_path / "bad.ipynb",
        "--issued",
        built / "issued.json",
        "--out",
        tmp_path / "m",
        "--no-feedback",
    )
    assert status == 1
    marks, rejected = table(tmp_path / "m" / "marks.csv"), table(tmp_path / "m" / "rejected.csv")
    assert len(marks) == good
    assert len(marks) + len(rejected) == len(rows) + 1 + 1
    reasons = " | ".join(r["reason"] for r in rejected)
    for told in ("no student 'Zoé'", "seed 999 of slotted_mechanism was not issued; Émilie Lefèvre has seed 7",
                 "no exercise 'zz' was issued; issued: slotted_mechanism, four_bar_positions", "'seven'", "did you mean 'rA'", "did you mean 'slotted_mechanism'",
                 "no student's name", "repeats", "1 cells", "not a notebook"):  # fmt: skip
        assert told in reasons
    assert [s["percent"] for s in table(tmp_path / "m" / "summary.csv")] == ["100.0"] * 3
    assert "rejected.csv" in err or "Zoé" in err


def test_a_sheet_that_nothing_foresaw_costs_itself_alone(built, cli, tmp_path, monkeypatch):
    import coursework.marking.marking

    read = coursework.marking.marking.read

    def breaks(variant, part, answer):
        if answer == "surprise":
            raise RuntimeError("unforeseen")
        return read(variant, part, answer)

    monkeypatch.setattr(coursework.marking.marking, "read", breaks)
    rows = filled(built)
    rows[0]["answer"] = "surprise"
    path = write_rows(tmp_path / "a.csv", rows)
    assert (
        cli("grade", path, "--issued", built / "issued.json", "--out", tmp_path / "m", "--no-feedback")[0]
        == 1
    )
    marks, rejected = table(tmp_path / "m" / "marks.csv"), table(tmp_path / "m" / "rejected.csv")
    assert len(marks) + len(rejected) == len(rows)
    assert {r["student"] for r in rejected} == {rows[0]["student"]}
    assert "unforeseen" in rejected[0]["reason"]


def test_a_name_is_known_whatever_its_case_and_spaces(built, cli, tmp_path):
    rows = filled(built, lambda r: {**r, "student": f"  {r['student'].upper()} "})
    path = write_rows(tmp_path / "a.csv", rows)
    assert cli("grade", path, "--issued", built / "issued.json", "--no-feedback")[0] == 0
    assert {m["student"] for m in table(built / "marks" / "marks.csv")} == {
        "Émilie Lefèvre",
        "David O'Neil",
        "emilie lefevre 2",
    }


def test_a_seed_may_be_left_out_when_the_roster_tells_it(built, cli, tmp_path):
    path = write_rows(tmp_path / "a.csv", filled(built, lambda r: {**r, "seed": ""}))
    assert cli("grade", path, "--issued", built / "issued.json", "--no-feedback")[0] == 0


def test_notebooks_come_back_filled(built, cli, tmp_path):
    path = built / "handouts" / "slotted_mechanism" / "david-o-neil.en.ipynb"
    notebook = json.loads(path.read_text("utf-8"))
    key = json.loads((built / "instructor" / "key.json").read_text("utf-8"))
    right = next(k for k in key if k["student"] == "David O'Neil")
    cell = next(c for c in notebook["cells"] if "answers" in c["metadata"].get("tags", []))
    cell["source"] = "answers = " + repr({p: str(a["value"]) for p, a in right["answers"].items()})
    back = tmp_path / "back.ipynb"
    back.write_text(json.dumps(notebook), "utf-8")
    assert (
        cli("grade", back, "--issued", built / "issued.json", "--out", tmp_path / "m", "--no-feedback")[0]
        == 0
    )
    summary = {s["student"]: s for s in table(tmp_path / "m" / "summary.csv")}
    assert float(summary["David O'Neil"]["points"]) == sum(p["points"] for p in right["parts"])
    assert float(summary["Émilie Lefèvre"]["points"]) == 0
    assert int(summary["Émilie Lefèvre"]["missing"]) > 0


def test_what_no_font_draws_and_what_no_file_name_holds_costs_nothing(cli, tmp_path):
    out = tmp_path / "out"
    (tmp_path / "class.csv").write_text("student\nZoe\nZoë\nZoe 2\n王小明\n" + "x" * 300 + "\ncon\n", "utf-8")
    options = ["--roster", tmp_path / "class.csv", "--out", out]
    assert cli("build", "slotted_mechanism", *options)[0] == 0
    stems = {p.name.partition(".")[0] for p in (out / "handouts" / "slotted_mechanism").iterdir()}
    assert len(stems) == 6
    assert "con" not in stems
    assert max(map(len, stems)) <= 60
    rows = filled(out)
    answers = ["\N{GRINNING FACE}", "a\x01b", '=HYPERLINK("http://x")', "1\r2", "漢字", "**$x$**"]
    for row, answer in zip(rows, answers, strict=False):
        row["answer"] = answer
    sheets = [
        {**{c: r[c] for c in ("student", "exercise", "seed")}, "answers": {r["part"]: r["answer"]}}
        for r in rows
    ]
    (tmp_path / "a.json").write_text(json.dumps(sheets), "utf-8")
    assert cli("grade", tmp_path / "a.json", "--issued", out / "issued.json", "--out", tmp_path / "m")[0] == 1
    marks = table(tmp_path / "m" / "marks.csv")
    assert len(marks) == len(rows)
    assert [m["answer"] for m in marks[:6]] == [*answers[:2], "'" + answers[2], *answers[3:]]
    # Each feedback sheet is called as its student's handout is.
    assert {p.stem for p in (tmp_path / "m" / "feedback").iterdir()} == stems


def test_a_build_that_fails_leaves_what_was_there(built, cli, monkeypatch):
    before = tree(built)
    from coursework.errors import BadStatement
    from coursework.rendering.renderer import Renderer

    def fails(self, handout, practice=False):
        raise BadStatement("no")

    monkeypatch.setattr(Renderer, "notebook", fails)
    assert cli("build", "slotted_mechanism", "--variants", 2, "--out", built, "--overwrite")[0] == 2
    assert tree(built) == before


def test_a_notebook_that_was_nobodys_is_marked_by_the_name_in_it_or_its_files(cli, tmp_path):
    out = tmp_path / "out"
    assert (
        cli(
            "build", "slotted_mechanism", "--variants", 2, "--formats", "ipynb", "--lang", "en", "--out", out
        )[0]
        == 0
    )
    back = tmp_path / "back"
    back.mkdir()
    for number, path in enumerate(sorted((out / "handouts" / "slotted_mechanism").iterdir())):
        text = path.read_text("utf-8")
        if number == 0:
            text = text.replace('\\"student\\": \\"\\"', '\\"student\\": \\"Ann\\"')
        (back / f"returned-{number}.ipynb").write_text(text, "utf-8")
    status, _, err = cli(
        "grade", back, "--issued", out / "issued.json", "--out", tmp_path / "m", "--no-feedback"
    )
    assert status == 0
    assert "file's name stands for it" in err
    assert [s["student"] for s in table(tmp_path / "m" / "summary.csv")] == ["Ann", "returned-1"]


def test_who_returns_a_notebook_is_told_in_its_language(cli, tmp_path):
    out, back = tmp_path / "out", tmp_path / "back"
    options = ("--variants", 1, "--formats", "ipynb", "--lang", "fr,en", "--out", out)
    assert cli("build", "slotted_mechanism", *options)[0] == 0
    back.mkdir()
    said = {}
    for lang in ("fr", "en"):
        (path,) = (out / "handouts" / "slotted_mechanism").glob(f"*.{lang}.ipynb")
        text = path.read_text("utf-8").replace('\\"rA\\": \\"\\"', '\\"rA\\": \\"beaucoup\\"')
        (back / f"{lang}.ipynb").write_text(text, "utf-8")
    # What cannot be read waits for somebody to look at it.
    assert cli("grade", back, "--issued", out / "issued.json", "--out", tmp_path / "m")[0] == 1
    for mark in table(tmp_path / "m" / "marks.csv"):
        if mark["part"] == "rA":
            said[mark["student"]] = mark["feedback"]
    assert "ne se lit pas" in said["fr"]
    assert "cannot be read" in said["en"]


def test_without_a_roster_any_name_is_accepted(cli, tmp_path):
    out = tmp_path / "out"
    assert (
        cli("build", "slotted_mechanism", "--variants", 2, "--formats", "html", "--lang", "en", "--out", out)[
            0
        ]
        == 0
    )
    rows = filled(out, lambda r: {**r, "student": "Anybody"})
    path = write_rows(tmp_path / "a.csv", rows)
    assert cli("grade", path, "--issued", out / "issued.json", "--no-feedback")[0] == 0
    assert cli("grade", path, "--issued", out / "issued.json", "--no-feedback")[0] == 0


# ------------------------------------------------------------------------- new, check


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


# ------------------------------------------------------------------- users' mistakes


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["show", "sloted_mechanism"], "did you mean 'slotted_mechanism'"),
        (["show", "slotted_mechanism", "--lang", "de"], "no language 'de'"),
        (["show", "slotted_mechanism", "--seed", "-1"], "--seed': takes a whole number, 0 or more; found '-1'"),
        (["show", "slotted_mechanism", "--seed", "1.5"], "--seed': takes a whole number, 0 or more; found '1.5'"),
        (["grade", "none.csv", "--issued", "."], "name the issued.json that build wrote"),
        (["solve", "slotted_mechanism", "--set", "r1"], "NAME=VALUE"),
        (["solve", "slotted_mechanism", "--set", "r1=3kg", "--only", "rA"], "r1 is in mm"),
        (["solve", "slotted_mechanism", "--set", "r1=-3", "--only", "rA"], "r1 must be positive"),
        (["solve", "slotted_mechanism", "--set", "r1=3", "--only", "rA"], "rA needs r2 and theta2, which are not given; add --set r2=… --set theta2=…"),
        (["solve", "slotted_mechanism", "--set", "r9=3", "--only", "rA"], "no quantity 'r9'"),
        (["solve", "slotted_mechanism", "--set", "r1=300", "--set", "r2=100", "--only", "rAA"], "did you mean 'rA'"),
        (["solve", "slotted_mechanism", "--set", "r1=100", "--set", "r2=300", "--only", "swing"], "swing does not exist"),
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
)  # fmt: skip
def test_a_users_mistake_is_one_line_and_status_2(cli, tmp_path, monkeypatch, arguments, told):
    monkeypatch.chdir(tmp_path)
    status, _, err = cli(*arguments)
    assert status == 2
    assert told in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("roster", "told"),
    [
        ("", "column named student"),
        ("nome\nAnn\n", "column named student"),
        ("student\n", "names no student"),
        ("student\nAnn\nann\n", "line 2"),
        ("student\nJosé\nJose\u0301\n", "stands on line 2 already"),
        ("student\nO'Neil\nO’Neil\n", "stands on line 2 already"),
        ("student,lang\nAnn,xx\n", "no language 'xx'"),
        ("student,lang\nAnn,fr\n ,en\n", "line 3: no name"),
        ("student,lang\nAnn,fr\nDurand, Paul,en\n", "line 3: 3 cells where the header has 2"),
        ("student\nAnn\nBo\0\n", "no CSV"),
        ("student\n\nAnn\nann\n", "line 4: ann stands on line 3"),
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


def test_solve_asks_for_all_that_is_missing_as_it_is_written(cli):
    status, _, err = cli("solve", "slotted_mechanism", "--set", "theta2=30")
    assert status == 2
    assert "r1, r2 and omega2, which are not given; add --set r1=… --set r2=… --set omega2=…" in err
    assert "_arm" not in err


def test_help_answers_without_loading_the_heavy_libraries():
    code = (
        "import sys; from coursework.cli import run; run(['--help']);"
        "heavy = {'numpy', 'scipy', 'typst', 'nbformat', 'jinja2', 'rich'} & set(sys.modules);"
        "sys.exit(', '.join(heavy) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "build" in done.stdout


def test_the_demo_does_the_whole_job(cli, tmp_path):
    status, out, _ = cli("demo", "--out", tmp_path / "demo")
    assert status == 0
    marks = table(tmp_path / "demo" / "marks" / "marks.csv")
    rejected = table(tmp_path / "demo" / "marks" / "rejected.csv")
    verdicts = {m["verdict"].partition(":")[0] for m in marks}
    assert {"correct", "mistake", "wrong", "wrong_unit", "unreadable", "missing"} <= verdicts
    assert len(rejected) == 3
    assert len(table(tmp_path / "demo" / "marks" / "summary.csv")) == 12
    assert "rejected" in out
    full = {s["student"]: s["percent"] for s in table(tmp_path / "demo" / "marks" / "summary.csv")}
    # Those who answered right, in whatever spelling, have all their points.
    for honest in (
        "Amel Benali",
        "Bastien Roux",
        "Chloé Marchand",
        "David O'Neil",
        "Émilie Lefèvre",
        "Léa Petit",
    ):
        assert full[honest] == "100.0", honest
    assert Path(tmp_path / "demo" / "issued.json").exists()


def test_a_blank_row_displaces_no_answer(built, cli, tmp_path):
    """The form filled for one student, another's answers in a file of their own; then the files in the other order."""
    rows = filled(built)
    david = [r for r in rows if r["student"] == "David O'Neil"]
    form = [r if r not in david else {**r, "answer": " "} for r in rows]
    for number, (form_is, own) in enumerate((("a.csv", "b.csv"), ("b.csv", "a.csv"))):
        folder = tmp_path / f"returned{number}"
        folder.mkdir()
        write_rows(folder / form_is, form), write_rows(folder / own, david)
        marks = tmp_path / f"marks{number}"
        status, said, err = cli(
            "grade", folder, "--issued", built / "issued.json", "--out", marks, "--no-feedback"
        )
        assert (status, err) == (0, "")
        assert f"{len(rows)} marked, 0 rejected, {len(david)} blank beside another" in said
        assert {m["verdict"] for m in table(marks / "marks.csv")} == {"correct"}
        assert [s["percent"] for s in table(marks / "summary.csv")] == ["100.0"] * 3
