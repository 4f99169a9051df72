"""The command line, making a build: the tree of the contract, nobody's answer in the wrong place."""

from __future__ import annotations

import json

import click
import pytest
from class_of_three import filled, table, tree

from coursework.cli.make import build


@pytest.mark.e2e
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


@pytest.mark.e2e
def test_the_same_command_gives_the_same_bytes(built, cli, tmp_path):
    again = tmp_path / "again"
    cli(
        "build",
        "slotted_mechanism",
        "four_bar_positions",
        "--roster",
        tmp_path / "class.csv",
        "--out",
        again,
        "--formats",
        "pdf,ipynb",
        "--seed",
        7,
    )
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


@pytest.mark.e2e
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


def test_a_lost_sheet_comes_again_and_who_makes_up_has_another(cli, tmp_path):
    """A build of exercises is a paper as that of an assignment is: papers come again, and have further
    sittings."""
    (tmp_path / "class.csv").write_text("student\nAna\nBen\n", "utf-8")
    out = tmp_path / "out"
    usual = ["build", "slotted_mechanism", "--formats", "html", "--lang", "en", "--out", out]
    assert cli(*usual, "--again", "Ana")[0] == 2
    assert cli(*usual, "--roster", tmp_path / "class.csv")[0] == 0
    handouts = out / "handouts" / "slotted_mechanism"
    page, record = (handouts / "ana.en.html").read_bytes(), (out / "issued.json").read_bytes()
    (handouts / "ana.en.html").unlink()
    assert cli(*usual, "--again", "ana")[0] == 0
    assert (handouts / "ana.en.html").read_bytes() == page
    assert (out / "issued.json").read_bytes() == record
    assert cli(*usual, "--make-up", "Ben")[0] == 0
    items = json.loads((out / "issued.json").read_bytes())["issued"]
    assert items[:2] == json.loads(record)["issued"]
    assert [(item["student"], item["sitting"]) for item in items[2:]] == [("Ben", 2)]
    assert len({str(item["record"]["given"]) for item in items}) == 3
    assert (handouts / "ben.sitting-2.en.html").exists()
    assert (handouts / "ana.en.html").read_bytes() == page


def test_build_has_few_options():
    assert len([p for p in build.params if isinstance(p, click.Option)]) <= 16


def test_options_that_an_assignment_does_not_use_are_named(cli, tmp_path):
    """The file of an assignment states its parts, and its secret draws: an option that changes nothing is not
    ignored silently."""
    file = tmp_path / "quiz.toml"
    file.write_text('exercises = [{ name = "slotted_mechanism" }]\nformats = "html"\nlang = "en"\n', "utf-8")
    status, _, said = cli("build", file, "--seed", 4, "--parts", "1", "--out", tmp_path / "out")
    assert status == 0
    assert [option for option in ("--seed", "--parts", "--out") if option in said] == ["--seed", "--parts"]
