"""Marks by codes as long as an exam is anonymous, by names once anonymity is lifted."""

import csv
import json

import pytest
from small_assignment import table

from coursework import open_course
from coursework.cli import run
from coursework.gradebook.after_files import MarkedFolder
from coursework.gradebook.class_points import class_points
from coursework.issuing.issued import Issued

ROSTER = "student,number,group\nAda Lovelace,N9101,A\nBo Diddley,N9102,B\nCy Young,N9103,B\n"
NAMES = ("Ada Lovelace", "Bo Diddley", "Cy Young", "N9101", "N9102", "N9103")


@pytest.fixture
def exam(small_course, tmp_path):
    (tmp_path / "class.csv").write_text(ROSTER)
    (tmp_path / "final.toml").write_text(
        'roster = "class.csv"\nidentity = ["number"]\nformats = "ipynb"\nsolutions = false\nanonymous '
        "= true\nmark = { of = 20 }\n"
        'secret = "0123456789abcdef0123456789abcdef"\n[[exercises]]\nname = "crank_pin"\n'
    )
    out = tmp_path / "out"

    def command(name, *options):
        return run(["--course", str(small_course), name, *map(str, options)])

    assert command("build", tmp_path / "final.toml", "--out", out) == 0
    return command, out


def typed(out, answers):
    """Write answers to x, y and v by student as written."""
    path = out / "typed.csv"
    with path.open("w", newline="") as file:
        rows = (
            [s, "crank_pin", "", p, a]
            for s, three in answers.items()
            for p, a in zip("xyv", three, strict=True)
        )
        csv.writer(file).writerows([["student", "exercise", "seed", "part", "answer"], *rows])
    return path


def test_marks_go_by_codes_until_nothing_waits_and_names_are_asked_for(exam, capsys):
    command, out = exam
    issued = out / "issued.json"
    codes = json.loads(issued.read_text())["codes"]
    key = {(k["student"], k["part"]): k["value"] for k in table(out / "instructor" / "key.csv")}
    ada, bo = codes["Ada Lovelace"], codes["Bo Diddley"]
    right = [key[ada, part] for part in "xyv"]
    # By a code however it is written, and by a name that a platform knows.
    answers = typed(
        out,
        {
            ada.replace("-", " ").lower(): right,
            "Diddley Bo": ["1", "2", "three apples"],
            "bo diddley": ["1", "2", "three apples"],
        },
    )
    assert command("grade", answers, "--issued", issued) == 1
    marks = out / "marks"
    assert {row["student"] for row in table(marks / "marks.csv")} == {ada, bo}
    assert [row["student"] for row in table(marks / "summary.csv")] == sorted(codes.values())
    assert sorted(p.name for p in (marks / "feedback").iterdir()) == sorted(
        f"{c.lower()}.pdf" for c in (ada, bo)
    )
    for path in marks.glob("*.csv"):
        shown = path.read_text("utf-8-sig")
        assert not [name for name in NAMES if name in shown]
    # Names are refused while something waits, and nothing changes.
    capsys.readouterr()
    assert command("grade", answers, "--issued", issued, "--names", "--no-feedback") == 2
    assert "names stay hidden" in capsys.readouterr().err
    assert "lifted" not in json.loads(issued.read_text())
    # A decision by code outlives the lifting.
    (marks / "decisions.csv").write_text(
        f"student,exercise,seed,part,points,reason\n{bo},crank_pin,,v,1,units\n"
    )
    answers = typed(out, {ada: right, bo: ["1", "2", "three apples"]})
    assert command("grade", answers, "--issued", issued, "--names", "--today", "2026-12-10") == 0
    assert json.loads(issued.read_text())["lifted"] == "2026-12-10"
    summary = {row["student"]: (row["number"], row["points"]) for row in table(marks / "summary.csv")}
    assert list(summary) == ["Ada Lovelace", "Bo Diddley", "Cy Young"]
    assert summary["Ada Lovelace"] == ("N9101", "4")
    assert summary["Bo Diddley"] == ("N9102", "1")
    changes = table(marks / "changes.csv")
    assert [(c["student"], c["part"], c["verdict_now"]) for c in changes] == [("Bo Diddley", "v", "accepted")]
    # Lifted for good, also for a build of late students, and no mark changes.
    (out.parent / "class.csv").write_text(ROSTER + "Zoe Late,104,A\n")
    assert command("build", out.parent / "final.toml", "--out", out) == 0
    assert command("grade", answers, "--issued", issued, "--no-feedback") == 0
    assert [row["student"] for row in table(marks / "summary.csv")] == [*summary, "Zoe Late"]
    assert table(marks / "changes.csv") == changes


def test_a_record_read_by_name_shows_names_and_codes_lead_to_them(exam):
    _, out = exam
    content = json.loads((out / "issued.json").read_text())
    code = content["codes"]["Bo Diddley"]
    hidden, named = Issued(content, "it"), Issued(content, "it", by_name=True)
    assert (hidden.student("Bo Diddley"), hidden.student(code.lower()), hidden.student("Eve")) == (
        code,
        code,
        None,
    )
    assert (named.student("Bo Diddley"), named.student(code)) == ("Bo Diddley", "Bo Diddley")
    assert hidden.columns[code] == {"group": "B"}
    assert hidden.seeds_of(code, "crank_pin") == named.seeds_of("Bo Diddley", "crank_pin") != ()
    assert hidden.account(["N9102"]) == code


def test_names_are_refused_where_papers_bear_them(exam, capsys):
    command, out = exam
    content = json.loads((out / "issued.json").read_text())
    del content["codes"]
    (out / "issued.json").write_text(json.dumps(content))
    answers = typed(out, {"Bo Diddley": ["1", "2", "3"]})
    assert command("grade", answers, "--issued", out / "issued.json", "--names") == 2
    assert "no anonymity to lift" in capsys.readouterr().err


def test_a_database_writes_codes_until_nothing_waits(exam, tmp_path):
    """A decision by code in the files that it wrote is one on the student."""
    command, out = exam
    codes = json.loads((out / "issued.json").read_text())["codes"]
    key = {(k["student"], k["part"]): k["value"] for k in table(out / "instructor" / "key.csv")}
    ada = codes["Ada Lovelace"]
    url, marks = f"sqlite:///{tmp_path}/marks.db", tmp_path / "marks"
    answers = typed(out, {ada: [key[ada, "x"], key[ada, "y"], "three apples"]})
    with_db = ("grade", "--db", url, "--out", marks, "--issued", out / "issued.json")
    assert command(*with_db, answers) == 1
    for path in (*marks.glob("*.csv"), *marks.rglob("*.pdf")):
        shown = path.name + (path.read_text("utf-8-sig") if path.suffix == ".csv" else "")
        assert not [name for name in NAMES if name.lower() in shown.lower()], path
    assert {row["student"] for row in table(marks / "marks.csv")} == {ada}
    (marks / "decisions.csv").write_text(
        f"student,exercise,seed,part,points,reason\n{ada},crank_pin,,v,1,units\n"
    )
    assert command(*with_db, "--no-feedback") == 0
    (row,) = (row for row in table(marks / "marks.csv") if row["part"] == "v")
    assert (row["student"], row["points"], row["verdict"]) == ("Ada Lovelace", "1", "accepted")


@pytest.mark.parametrize("typed_for", [(), NAMES[1:3]], ids=["no lines", "blank lines"])
def test_who_is_absent_has_no_zero(exam, small_course, capsys, typed_for):
    """Presence by name in the attendance list goes by code, and decides what a blank paper is worth, as it
    does of blank lines in the form of the class."""
    command, out = exam
    issued, marks = out / "issued.json", out / "marks"
    codes = json.loads(issued.read_text())["codes"]
    key = {(k["student"], k["part"]): k["value"] for k in table(out / "instructor" / "key.csv")}
    ada = codes[NAMES[0]]
    right = {ada: [key[ada, part] for part in "xyv"]}
    answers = typed(out, right | {codes[name]: ["", "", ""] for name in typed_for})
    (out / "attendance.csv").write_text(
        "student,present\nAda Lovelace,x\nBo Diddley,présente\nCy Young,absence\n"
    )
    assert command("grade", answers, "--issued", issued, "--no-feedback") == 2
    (out / "attendance.csv").write_text(
        "student,present\nAda Lovelace,x\nBo Diddley,présente\nCy Young,ABJ\n"
    )
    for graded in ((answers, "--names"), ("--from", marks / "marks.csv")):
        assert command("grade", *graded, "--issued", issued, "--formats", "html") == 0
        asked = ("student", "presence", "percent", "mark")
        assert [tuple(row[name] for name in asked) for row in table(marks / "summary.csv")] == [
            ("Ada Lovelace", "present", "100.0", "20"),
            ("Bo Diddley", "present", "0.0", "0"),
            ("Cy Young", "excused", "", ""),
        ]
        sheets = ["ada-lovelace.html", *(["bo-diddley.html"] if typed_for else [])]
        assert sorted(path.name for path in (marks / "feedback").iterdir()) == sheets
    scored = {one.name: one for one in class_points(marks, "points")}
    assert [scored[name].is_marked for name in NAMES[:3]] == [True, True, False]
    found = MarkedFolder(open_course(small_course), issued, marks).exam
    assert (found.missing, sorted(found.distribution().marks)) == ((0, 1), ["Ada Lovelace", "Bo Diddley"])
    capsys.readouterr()
    assert command("report", marks, "--json") == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["students"], said["percent"]["mean"]) == (2, 50)
    assert said["handed_in_nothing"] == (0 if typed_for else 1)
