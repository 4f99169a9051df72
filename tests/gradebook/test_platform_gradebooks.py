"""A platform's own export of its gradebook comes back with one column filled, and every other byte as it
was."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from xml.etree import ElementTree

import pytest
from collected_pools import RECORDED, graded
from hypothesis import given, settings
from hypothesis import strategies as st
from tables import each_row

from coursework.cli import run
from coursework.gradebook.class_points import Scored
from coursework.system.cells import CellTable

HEADER = (
    "student,points,out_of,percent,correct,follow_through,mistake,slip,accepted,partial,wrong,wrong_unit,"
    "missing_unit,unreadable,to_mark,missing,Email address,SIS User ID,ID number\n"
)


def summary(folder: Path, *lines: tuple[str, ...]) -> Path:
    """A summary: name, points, out of, e-mail, SIS id, number; who has no points answered nothing."""
    text = HEADER
    for name, points, out_of, mail, sis, number in lines:
        answered = "0" if points == "" else "1"
        text += f'"{name}",{points or 0},{out_of},0,{answered},{"0," * 10}0,{mail},{sis},{number}\n'
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "summary.csv").write_text(text, "utf-8-sig")
    return folder


ANN = ("Ann Doe", "6.25", "9", "ann@example.org", "s-1", "u-ann")
EMILE = ("D'été Émile", "3", "9", "", "", "")
BOB = ("Bob Ray", "", "9", "bob@example.org", "", "u-bob")
EVE = ("Eve Nemo", "9", "9", "eve@example.org", "", "u-eve")


@pytest.fixture
def fill(tmp_path, capsys):
    """Fill a recorded gradebook; gives status, what is told, and the file's bytes."""

    def call(platform, template, *lines, item="Week 3", options=()):
        out = tmp_path / "filled"
        out.unlink(missing_ok=True)
        marks = summary(tmp_path / "marks", *lines)
        path = template if isinstance(template, Path) else RECORDED / template
        status = run(
            [
                "gradebook",
                platform,
                str(marks),
                "--template",
                str(path),
                "--item",
                item,
                "--out",
                str(out),
                *options,
            ]
        )
        said = capsys.readouterr()
        assert "Traceback" not in said.err
        return status, said.out + said.err, out.read_bytes() if out.exists() else None

    return call


def test_moodles_export_is_filled_and_every_other_byte_stays(fill):
    status, told, data = fill("moodle", "moodle_gradebook_en.csv", ANN, EMILE, BOB)
    before = (RECORDED / "moodle_gradebook_en.csv").read_bytes()
    assert data == before.replace(b"ann@example.org,1.00,", b"ann@example.org,6.25,").replace(
        b"emile@example.org,0.00,", b"emile@example.org,3,"
    )
    assert status == 0
    assert "out of 9: this must be the maximum of the item" in told
    assert "1 student with no marks; left as they were: Bob Ray" in told


def test_who_has_no_mark_may_have_answered_in_rejected_rows(fill, tmp_path):
    (tmp_path / "marks").mkdir()
    (tmp_path / "marks" / "rejected.csv").write_text(
        "student,reason\nBbo Ray,no student\nBbo Ray,no student\n"
    )
    status, told, _ = fill("moodle", "moodle_gradebook_en.csv", ANN, EMILE, BOB)
    assert (status, "2 rows in" in told) == (1, True)


def test_a_stranger_is_told_and_never_written(fill):
    status, told, data = fill("moodle", "moodle_gradebook_en.csv", ANN, EVE)
    assert status == 1
    assert "1 student with marks but no line in the export; not written: Eve Nemo" in told
    assert b"eve" not in data
    assert data.count(b"\n") == (RECORDED / "moodle_gradebook_en.csv").read_bytes().count(b"\n")


def test_two_of_one_name_are_told_apart_by_mail_and_a_name_alone_is_nobodys(fill):
    two = ("Ann Doe (wb-2)", "2", "11", "wb.ann2@example.org", "", "")
    status, _, data = fill("moodle", "moodle_gradebook.csv", two, item="Week 3, marked")
    assert status == 0
    assert [row[6] for row in csv.reader(data.decode().splitlines())][1:3] == ["-", "2"]
    status, told, data = fill(
        "moodle", "moodle_gradebook.csv", ("Ann Doe", "2", "11", "", "", ""), item="Week 3, marked"
    )
    assert (status, data) == (1, (RECORDED / "moodle_gradebook.csv").read_bytes())
    assert "no line, or several, that could be theirs; not written: Ann Doe" in told


def test_one_name_and_another_mail_is_another_person(fill):
    status, told, _ = fill(
        "moodle", "moodle_gradebook_en.csv", ("Ann Doe", "2", "9", "other@example.org", "", "")
    )
    assert status == 1
    assert "no line in the export; not written: Ann Doe" in told


def test_moodle_is_given_a_point_in_every_language_unless_told(fill):
    marks = ("Ann Doe", "6.25", "11", "", "", "wb-1")
    _, _, data = fill("moodle", "moodle_gradebook_fr.csv", marks, item="Week 3, marked (Real)")
    assert data.splitlines()[1].startswith(b"Ann;Doe;wb-1;;;wb.ann@example.org;6.25;8.00")
    _, _, data = fill(
        "moodle", "moodle_gradebook_fr.csv", marks, item="Week 3, marked", options=("--decimal", "comma")
    )
    assert b";6,25;8.00" in data


def test_points_are_scaled_to_the_maximum_of_the_item(fill):
    _, told, data = fill("moodle", "moodle_gradebook_en.csv", ANN, options=("--out-of", "20"))
    assert b",13.89," in data, "6.25 of 9 is 13.888 of 20"
    assert "out of 20" in told
    _, told, data = fill("canvas", "canvas_gradebook.csv", ANN, EMILE)
    assert b"s-1,ann@example.org,Mechanisms A,7.5,13.89,75.0\r\n" in data
    assert "out of 20" in told


@each_row(("points", "written"), [("1", "0.13"), ("0.5", "0.06"), ("8", "1"), ("3", "0.38")])
def test_scaling_rounds_to_the_hundredth_and_a_half_goes_up(points, written):
    assert Scored("", (), points, "8").of(1) == written


def test_canvas_keeps_what_is_excused_its_line_of_maxima_and_its_invented_student(fill):
    two = ("Ann Doe", "5", "9", "ann2@example.org", "s-2", "")
    status, told, data = fill("canvas", "canvas_gradebook.csv", ANN, two, EMILE, EVE)
    before, now = ((RECORDED / "canvas_gradebook.csv").read_bytes().split(b"\r\n"), data.split(b"\r\n"))
    assert [k for k, (a, b) in enumerate(zip(before, now, strict=True)) if a != b] == [2, 4]
    assert b"EX" in now[3]
    assert "cells that keep the platform's value: Ann Doe (4712): EX" in told
    assert "left as they were: Bob Ray\n" in told, "nobody is called Student, Test or Points Possible"
    assert status == 1, "Eve is a stranger"


def test_blackboards_export_stays_utf_16_with_its_mark_and_its_tabs(fill):
    status, _, data = fill("blackboard", "blackboard_gradebook.txt", ("Ann Doe", "6.25", "10", "", "s-1", ""))
    assert status == 0
    before = (RECORDED / "blackboard_gradebook.txt").read_bytes().decode("utf-16")
    assert data[:2] == b"\xff\xfe"
    assert data.decode("utf-16") == before.replace('"Yes"\t""\t""\r\n', '"Yes"\t""\t"12,5"\r\n', 1), (
        "its comma, out of 20"
    )


def test_sakais_export_is_filled_by_the_maximum_in_its_title(fill):
    status, told, data = fill("sakai", "sakai_gradebook.csv", ANN)
    assert (status, data.splitlines()[1]) == (0, b'adoe,"Doe, Ann",6.25,,"4"')
    assert "out of 9" in told


@pytest.mark.parametrize(
    ("platform", "template", "item", "options", "told"),
    [
        ("moodle", "moodle_gradebook_en.csv", "Week 4", (), "did you mean 'Week 3'?"),
        (
            "moodle",
            "moodle_gradebook_en.csv",
            "Zeugnis",
            (),
            "available: Course total, Last downloaded from this course, Week 3",
        ),
        ("moodl", "moodle_gradebook_en.csv", "Week 3", (), "did you mean 'moodle'?"),
        (
            "canvas",
            "canvas_gradebook.csv",
            "Week 3",
            ("--out-of", "9"),
            "states that Week 3 (102) is out of 20, and --out-of states 9",
        ),
        ("moodle", "moodle_responses_en.csv", "Quiz", ("--score", "mark"), "has no column 'mark'"),
        ("moodle", "README.md", "Week 3", (), "names nobody"),
        ("moodle", "nothing.csv", "Week 3", (), "cannot be read"),
    ],
)
def test_mistakes_are_told_and_nothing_is_written(fill, platform, template, item, options, told):
    status, said, data = fill(platform, template, ANN, item=item, options=options)
    assert (status, data) == (2, None)
    assert told in said


def test_an_item_of_several_columns_is_named_whole(fill, tmp_path):
    text = (
        (RECORDED / "moodle_gradebook_en.csv")
        .read_text("utf-8")
        .replace('"Course total (Real)"', '"Quiz: Week 3 (Percentage)"')
    )
    (tmp_path / "two.csv").write_text(text, "utf-8")
    status, told, data = fill("moodle", tmp_path / "two.csv", ANN)
    assert (status, data) == (2, None)
    assert (
        "several columns 'Week 3': 'Quiz: Week 3 (Real)', 'Quiz: Week 3 (Percentage)'; give the full name"
        in told
    )
    status, _, data = fill(
        "moodle", tmp_path / "two.csv", ANN, item="Quiz: Week 3 (Percentage)", options=("--score", "percent")
    )
    assert status == 0
    assert b"ann@example.org,1.00,0," in data


@pytest.mark.parametrize("points", ["9.5", "-1"])
def test_more_than_the_maximum_or_less_than_nothing_is_refused_whole(fill, points):
    status, told, data = fill("moodle", "moodle_gradebook_en.csv", (*ANN[:1], points, *ANN[2:]), EMILE)
    assert (status, data) == (2, None)
    assert f"Ann Doe has {points}" in told


def test_totals_that_differ_need_the_items_maximum(fill):
    lines = (ANN, ("Bob Ray", "5", "10", "bob@example.org", "", ""))
    status, told, _ = fill("moodle", "moodle_gradebook_en.csv", *lines)
    assert status == 2
    assert "out of 10 and 9" in told
    assert fill("moodle", "moodle_gradebook_en.csv", *lines, options=("--out-of", "9"))[0] == 0


def test_who_answered_nothing_has_a_nought_where_it_is_asked_for(fill):
    _, _, data = fill("moodle", "moodle_gradebook_en.csv", BOB, options=("--zeros",))
    assert b"bob@example.org,0,0.00" in data


def test_xml_names_item_and_students_by_their_numbers(tmp_path, capsys):
    marks = summary(tmp_path / "marks", ANN, EMILE, BOB, EVE)
    out = tmp_path / "marks.xml"
    assert run(["gradebook", "moodle", str(marks), "--item", "week3", "--out", str(out)]) == 1
    assert "1 student without an ID number, not written: D'été Émile" in capsys.readouterr().err
    results = [[child.text for child in result] for result in ElementTree.parse(out).getroot()]
    assert results == [["new", "week3", "u-ann", "6.25"], ["new", "week3", "u-eve", "9"]]
    assert run(["gradebook", "canvas", str(marks), "--item", "week3", "--out", str(out)]) == 2
    assert "--template takes the gradebook as Canvas exports it" in capsys.readouterr().err


def test_the_template_is_never_overwritten(tmp_path, capsys):
    template = tmp_path / "a.csv"
    template.write_bytes((RECORDED / "moodle_gradebook_en.csv").read_bytes())
    marks = summary(tmp_path / "marks", ANN)
    given = ["--template", str(template), "--item", "Week 3", "--out", str(template)]
    assert run(["gradebook", "moodle", str(marks), *given]) == 2
    assert "keep the platform's export" in capsys.readouterr().err


def test_from_a_report_to_the_gradebook_with_nothing_between(tmp_path):
    """What Moodle collected is marked, and Moodle's own export filled: five students, two of one name."""
    graded(tmp_path, RECORDED / "moodle_responses.csv")
    out = tmp_path / "filled.csv"
    asked = [
        "--template",
        str(RECORDED / "moodle_gradebook.csv"),
        "--item",
        "Week 3, marked",
        "--out",
        str(out),
    ]
    # An answer of the second could not be read: their mark is provisional.
    for more, written in (([], "-"), (["--provisional"], "4")):
        assert run(["gradebook", "moodle", str(tmp_path / "marks"), *asked, *more]) == 1
        rows = list(csv.DictReader(io.StringIO(out.read_text("utf-8"))))
        assert [row["Week 3, marked (Real)"] for row in rows] == ["11", written, "-", "-", "-"]


# ------------------------------------------------------------------------ bytes

CELLS = st.text(st.sampled_from('ab é",;\t\n 1'), max_size=5)


@given(
    rows=st.lists(st.lists(CELLS, min_size=2, max_size=4), min_size=1, max_size=4),
    delimiter=st.sampled_from(",;\t"),
    end=st.sampled_from(["\r\n", "\n"]),
    mark=st.sampled_from([("", "utf-8"), ("\ufeff", "utf-8"), ("\ufeff", "utf-16-le")]),
    new=CELLS,
)
@settings(max_examples=200, deadline=None)
def test_one_cell_is_written_and_the_rest_of_the_file_is_read_as_before(rows, delimiter, end, mark, new):
    out = io.StringIO()
    csv.writer(out, delimiter=delimiter, lineterminator=end).writerows([["first", *["x"] * 5], *rows])
    data = (mark[0] + out.getvalue()).encode(mark[1])
    table = CellTable(data)
    assert table.data() == data
    cells = [[cell.text for cell in record] for record in table.records]
    assert cells == [r for r in [["first", *["x"] * 5], *rows] if any(c.strip() for c in r)]
    table.write(table.records[-1][1], new)
    cells[-1][1] = new
    again = CellTable(table.data())
    assert [[cell.text for cell in record] for record in again.records] == [
        r for r in cells if any(c.strip() for c in r)
    ]
