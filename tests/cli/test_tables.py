"""Tables open right in a spreadsheet, whatever its decimal sign, and are read back as they were written."""

from __future__ import annotations

import codecs
import csv
import json
import re

import pytest
from tables import each_row

from coursework.cli import run
from coursework.system.tables import SPREADSHEETS, csv_text, decode, open_csv

TABLES = {
    "sheets/answers.csv",
    "sheets/handouts/pages.csv",
    "sheets/instructor/key.csv",
    "marks/marks.csv",
    "marks/summary.csv",
    "marks/rejected.csv",
    "marks/changes.csv",
    "marks/report/parts.csv",
    "marks/report/mistakes.csv",
    "scene/slotted_mechanism-cycle.csv",
}
NUMBERS = {
    "key.csv": {"value", "tolerance"},
    "marks.csv": {"points", "out_of"},
    "summary.csv": {"points", "out_of", "percent"},
    "changes.csv": {"points_before", "points_now"},
}


def command(*arguments):
    return run([*map(str, arguments)])


def answered(out):
    """The form filled: right answers but for a point lost and a row of nobody."""
    key = {
        (k["student"], k["exercise"]): k["answers"]
        for k in json.loads((out / "sheets/instructor/key.json").read_text("utf-8"))
    }
    form = (out / "sheets/answers.csv").read_text("utf-8-sig")
    rows = list(csv.DictReader(form.splitlines(), delimiter=";" if ";" in form.splitlines()[0] else ","))
    for row in rows:
        row["answer"] = str(key[row["student"], row["exercise"]][row["part"]]["value"])
    rows[1]["answer"] = "12.5 mm"
    rows.append({**rows[0], "student": "Personne"})
    return rows


def whole_job(out, *options):
    """Build, two markings, report and scene; the exit status is 1 for the row of nobody."""
    (out / "class.csv").write_text("student\nÉmilie Lefèvre\nZoë\n", "utf-8")
    made = ["slotted_mechanism", "--roster", out / "class.csv", "--formats", "html", "--out", out / "sheets"]
    with_commas = ["--with", "booklet,decimal-comma"] if options else ["--with", "booklet"]
    assert command("build", *made, *with_commas) == 0
    rows = answered(out)
    for last in ("0", "12.5 mm"):
        rows[2]["answer"] = last
        with (out / "answers.csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
        where = ["--issued", out / "sheets/issued.json", "--out", out / "marks", "--no-feedback"]
        assert command("grade", out / "answers.csv", *where, *options) == 1
    assert command("report", out / "marks", *options) == 0
    scene = ["slotted_mechanism", "--steps", "7", "--out", out / "scene"]
    assert command("simulate", *scene, *options) == 0
    return {p.relative_to(out).as_posix(): p for p in out.rglob("*.csv") if p.parent != out}


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    return {
        sign: whole_job(tmp_path_factory.mktemp(sign), *([] if sign == "point" else ["--decimal", sign]))
        for sign in SPREADSHEETS
    }


def rows_of(path, delimiter):
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file, delimiter=delimiter))


@each_row("sign", SPREADSHEETS)
@pytest.mark.e2e
def test_every_table_has_the_mark_without_which_excel_damages_accents(written, sign):
    assert set(written[sign]) == TABLES
    for name, path in written[sign].items():
        data = path.read_bytes()
        assert data.startswith(codecs.BOM_UTF8), name
        assert data.count(codecs.BOM_UTF8) == 1, name


def test_a_decimal_comma_changes_numbers_and_nothing_else(written):
    changed = 0
    for name in TABLES:
        plain, french = rows_of(written["point"][name], ","), rows_of(written["comma"][name], ";")
        own = NUMBERS.get(name.rpartition("/")[2])
        for before, after in zip(plain, french, strict=True):
            assert list(before) == list(after)
            for column, cell in before.items():
                number = re.fullmatch(r"-?[0-9.]+(e[-+]?[0-9]+)?(; -?[0-9.]+)*", cell)
                is_number = number and (
                    column in own if own is not None else column not in ("answer", "seed")
                )
                wanted = cell.replace(".", ",") if is_number else cell
                if column != "source":
                    assert after[column] == wanted, (name, column)
                changed += wanted != cell
    assert changed > 50


def test_what_a_student_wrote_stays_as_it_was_written(written):
    answers = [row["answer"] for row in rows_of(written["comma"]["marks/marks.csv"], ";")]
    assert answers.count("12.5 mm") == 2
    assert not any(re.fullmatch(r"[0-9]+,[0-9]+", answer) for answer in answers)


def test_a_table_of_either_kind_is_read_back_as_the_other(written, tmp_path, capsys):
    """Marked again with the other sign nothing has changed; the report counts the same."""
    told = []
    for sign in SPREADSHEETS:
        out = written[sign]["marks/marks.csv"].parent.parent
        capsys.readouterr()
        assert command("report", out / "marks", "--json") == 0
        told.append(json.loads(capsys.readouterr().out))
        other = next(other for other in SPREADSHEETS if other != sign)
        where = ["--issued", out / "sheets/issued.json", "--out", out / "marks", "--no-feedback"]
        assert command("grade", out / "answers.csv", *where, "--decimal", other) == 1
        said = capsys.readouterr()
        assert "marks changed" not in said.out
        assert "edited" not in said.err
        assert rows_of(out / "marks/changes.csv", SPREADSHEETS[other].delimiter) == []
    assert told[0] == told[1]
    assert told[0]["answers"] > 10


def test_a_form_with_semicolons_is_filled_and_marked(written, tmp_path):
    out = written["comma"]["sheets/answers.csv"].parent.parent
    lines = (out / "sheets/answers.csv").read_text("utf-8-sig").splitlines()
    assert lines[0] == "student;exercise;seed;part;answer"
    filled = [lines[0], *(f"{line}12,5" for line in lines[1:])]
    (tmp_path / "filled.csv").write_text("\n".join(filled), "utf-8-sig")
    where = ["--issued", out / "sheets/issued.json", "--out", tmp_path / "marks", "--no-feedback"]
    command("grade", tmp_path / "filled.csv", *where)
    assert {row["answer"] for row in rows_of(tmp_path / "marks/marks.csv", ",")} == {"12,5"}


def test_an_unknown_sign_is_refused(tmp_path, capsys):
    assert command("simulate", "slotted_mechanism", "--out", tmp_path, "--decimal", "dot") == 2
    assert "point, comma" in capsys.readouterr().err


def test_a_formula_stays_text_where_semicolons_part_the_cells():
    (line,) = csv_text(
        [{"a": "x;=cmd|'/c calc'!A1", "points": "0.5"}], ["a", "points"], SPREADSHEETS["comma"]
    ).splitlines()[1:]
    assert line == "\"x;'=cmd|'/c calc'!A1\";0,5"


def test_a_mark_put_before_a_mark_is_no_part_of_the_first_heading(tmp_path):
    data = 2 * codecs.BOM_UTF8 + b"student,part\n"
    assert decode(data) == ("student,part\n", "")
    (tmp_path / "t.csv").write_bytes(data)
    with open_csv(tmp_path / "t.csv") as file:
        assert file.read() == "student,part\n"
