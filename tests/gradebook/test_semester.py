"""A semester: marks of several assignments out of 20, weighted, with what is provisional and who was
absent."""

import csv
import json

import pytest

from coursework.cli import run

COLUMNS = (
    "student,number,Groupe,points,out_of,mark,percent,provisional,correct,wrong,unreadable,to_mark,missing"
).split(",")


def write(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8-sig") as file:
        csv.writer(file).writerows(rows)


def line(student, number, group, mark, *, answered=1, waiting="", percent=""):
    return [student, number, group, "", "10", mark, percent, waiting, answered, 0, 0, 0, 0]


@pytest.fixture
def year(tmp_path):
    """A midterm out of 20, a final out of 10, and a test without a scale; Bo is called otherwise in the
    final."""
    write(
        tmp_path / "midterm" / "marks" / "summary.csv",
        [
            COLUMNS,
            line("Ada Byron", "1", "A", "12.5"),
            line("Bo Roux", "2", "B", "8", waiting="1"),
            line("Cy Ray", "3", "B", "0", answered=0),
            line("Di Om", "4", "A", "0", answered=0),
            line("Jean Petit", "5", "A", "10"),
            line("Jean Petit (6)", "6", "A", "14"),
        ],
    )
    write(
        tmp_path / "midterm" / "attendance.csv",
        [
            ["student", "present"],
            ["Cy Ray", "Présent"],
            ["Di Om", "ABJ"],
            ["Ada Byron", ""],
        ],
    )
    write(
        tmp_path / "final" / "marks" / "summary.csv",
        [
            COLUMNS,
            line("Ada Byron", "1", "A", "8"),
            line("Roux Bo", "2", "B", "5"),
            line("Cy Ray", "3", "B", "10"),
            line("Di Om", "4", "A", "9"),
            line("Jean Petit", "6", "A", "6"),
            line("Eve Lau", "7", "A", "0", answered=0),
        ],
    )
    (tmp_path / "final" / "issued.json").write_text(
        json.dumps({"assignment": {"mark": {"of": 10, "step": 0.5}}})
    )
    return tmp_path


def semester(folder, *options):
    status = run(
        [
            "semester",
            f"{folder / 'midterm'}:1",
            f"Exam={folder / 'final' / 'marks'}:2,0",
            "--out",
            str(folder / "s.csv"),
            *options,
        ]
    )
    if status == 2:
        return status, {}
    with (folder / "s.csv").open(encoding="utf-8-sig", newline="") as file:
        header, *rows = csv.reader(file, delimiter=";" if "comma" in options else ",")
    assert header == ["student", "number", "group", "midterm", "Exam", "average", "status"]
    return status, {row[1]: row[3:] for row in rows}


def test_marks_are_weighted_out_of_twenty_and_absences_are_no_zeros(year):
    status, rows = semester(year)
    assert status == 1
    assert rows == {
        "1": ["12.5", "16", "14.83", "final"],
        "2": ["8*", "10", "9.33*", "provisional: midterm"],
        "3": ["0", "20", "13.33", "final"],
        "4": ["excused", "18", "18", "excused: midterm"],
        "5": ["10", "absent", "", "absent: Exam"],
        "6": ["14", "12", "12.67", "final"],
        "7": ["absent", "absent", "", "absent: midterm, Exam"],
    }
    zero, left_out = (semester(year, "--absent", worth)[1] for worth in ("zero", "excused"))
    assert (zero["5"][2], zero["7"][2], zero["4"][2]) == ("3.33", "0", "18")
    assert (left_out["5"][2], left_out["7"][2]) == ("10", "")
    assert semester(year, "--decimal", "comma")[1]["2"][:3] == ["8*", "10", "9,33*"]


def test_what_cannot_be_averaged_is_refused(year, capsys):
    def refused(expected):
        assert semester(year)[0] == 2
        assert expected in capsys.readouterr().err

    attendance = year / "midterm" / "attendance.csv"
    kept = attendance.read_bytes()
    attendance.write_text("student,present\nAda Byron,perhaps\n")
    refused("attendance.csv, line 2: present is present, absent or excused; found 'perhaps'")
    attendance.write_bytes(kept)
    issued = year / "final" / "issued.json"
    stated = json.loads(issued.read_text())
    issued.write_text(json.dumps({**stated, "codes": {"Ada Byron": "K7M-3XP"}}))
    refused("students go by codes")
    issued.write_text(json.dumps({**stated, "codes": {"Ada Byron": "K7M-3XP"}, "lifted": "2026-12-10"}))
    assert semester(year)[0] == 1
    issued.write_text(json.dumps({"assignment": {"mark": {"of": 8, "step": 0.5}}}))
    refused("the mark 10 of Cy Ray is above 8")
    for wrong in (f"{year / 'midterm'}:0", "student=" + str(year / "midterm"), str(year / "nothing")):
        assert run(["semester", wrong]) == 2


def test_an_assignment_may_be_called_as_a_state_is(year, capsys):
    named = f"absent, provisional={year / 'midterm'}"
    assert run(["semester", named, "--out", str(year / "s.csv")]) == 1
    said = capsys.readouterr().err
    assert "absence" not in said
    assert "1 student with a provisional mark" in said
