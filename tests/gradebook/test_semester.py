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
    for name, of in (("midterm", 20), ("final", 10)):
        record(tmp_path / name / "marks", of)
    return tmp_path


def record(marks, of, *, by_codes=False):
    content = {"mark": {"of": of, "step": 0.5}, "by_codes": by_codes, "questions": []}
    (marks / ".exam.json").write_text(json.dumps(content))


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
    record(year / "final" / "marks", 10, by_codes=True)
    refused("students go by codes")
    record(year / "final" / "marks", 8)
    refused("the mark 10 of Cy Ray is above 8")
    (year / "final" / "marks" / ".exam.json").write_text("[]")
    refused("is not as grade wrote it")
    (year / "final" / "marks" / ".exam.json").unlink()
    refused("the maximum of its marks is not known")
    for wrong in (f"{year / 'midterm'}:0", "student=" + str(year / "midterm"), str(year / "nothing")):
        assert run(["semester", wrong]) == 2


def test_an_assignment_may_be_called_as_a_state_is(year, capsys):
    named = f"absent, provisional={year / 'midterm'}"
    assert run(["semester", named, "--out", str(year / "s.csv")]) == 1
    said = capsys.readouterr().err
    assert "absence" not in said
    assert "1 student with a provisional mark" in said


def test_marks_that_stand_far_from_their_exam_mean_the_same(small_course, tmp_path):
    """The maximum, and in a report the numbers of questions, are those of the exam."""
    (tmp_path / "exam.toml").write_text(
        'mark = { of = 10, step = 0.5 }\nformats = "ipynb"\nsolutions = false\n'
        '[[exercises]]\nname = "crank_pin"\n'
    )
    (tmp_path / "class.csv").write_text("student\nAda\n")
    usual, out, far = ["--course", str(small_course)], tmp_path / "exam", tmp_path / "far" / "marks"
    build = ["build", str(tmp_path / "exam.toml"), "--roster", str(tmp_path / "class.csv")]
    assert run([*usual, *build, "--out", str(out)]) == 0
    with (out / "instructor" / "key.csv").open(encoding="utf-8-sig", newline="") as file:
        key = list(csv.DictReader(file))
    columns = ["student", "exercise", "seed", "part", "answer"]
    write(tmp_path / "typed.csv", [columns, *([k[c] for c in columns[:4]] + [k["value"]] for k in key)])
    grade = ["grade", str(tmp_path / "typed.csv"), "--issued", str(out / "issued.json"), "--no-feedback"]
    assert run([*usual, *grade, "--out", str(far)]) == 0
    assert run(["semester", f"Exam={far}", "--out", str(tmp_path / "s.csv")]) == 0
    with (tmp_path / "s.csv").open(encoding="utf-8-sig", newline="") as file:
        [row] = csv.DictReader(file)
    assert row["Exam"] == "20"
    assert run([*usual, "report", str(far), "--lang", "en"]) == 0
    assert "1.1 ·" in (far / "report" / "report.html").read_text("utf-8")
