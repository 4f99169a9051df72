"""The command line, marking: every row out once, one damage costs one row."""

from __future__ import annotations

import json

from class_of_three import filled, table, write_rows


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
        {**first, "exercise": "slotted_mecanism"},
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
    for told in (
        "no student 'Zoé'",
        f"seed 999 of slotted_mechanism was not issued; Émilie Lefèvre has seed {first['seed']}",
        "no exercise 'zz' was issued; issued: slotted_mechanism, four_bar_positions",
        "'seven'",
        "did you mean 'rA'",
        "did you mean 'slotted_mechanism'",
        "no student's name",
        "repeats",
        "1 cell ",
        "not a notebook",
    ):
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
    assert "name of its file is taken" in err
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


def test_a_blank_row_displaces_no_answer(built, cli, tmp_path):
    """The form filled for one student, another's answers in a file of their own; then the files in the other
    order."""
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
