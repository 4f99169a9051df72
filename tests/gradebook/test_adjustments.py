"""What a question counts, what an answer earns and what points are worth may change after an exam, and change
back."""

import json

import pytest
from small_assignment import grade, issue, item, right, table
from tables import each_row

import coursework
from coursework.cli import run
from coursework.errors import BadInput
from coursework.gradebook.decisions import Decision, Decisions, check_steps
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.scale import mark_of, mark_on
from coursework.issuing.issued import Issued
from coursework.marking.mark import Mark

PARTS = [{"id": "a", "points": 2}, {"id": "b", "points": 3}, {"id": "c", "points": 5}]
RECORD = {"exercise": "x", "seed": 1, "version": 1, "parts": PARTS, "given": {}, "lang": "en"}
#: By student: answer, verdict and points of each question.
CLASS = {
    "Ada": (("1", "correct", 2), ("2", "slip:sign", 1.5), ("3", "correct", 5)),
    "Bo": (("1", "correct", 2), ("9", "wrong", 0), ("", "missing", 0)),
    "Cy": (("7", "wrong", 0), ("2", "correct", 3), ("3", "mistake:term", 0)),
}


def issued():
    stated = {"name": "x", "mark": {"of": 20, "step": 0.5}, "exercises": ["x"]}
    items = [{"student": student, "record": RECORD} for student in CLASS]
    return Issued({"format": 1, "roster": True, "assignment": stated, "issued": items}, "test")


def sheets():
    for student, answers in CLASS.items():
        lines = {
            p["id"]: Mark(p["id"], text, text, verdict, float(points), float(p["points"]), "en")
            for p, (text, verdict, points) in zip(PARTS, answers, strict=True)
        }
        yield Graded(student, "x", 1, lines, tuple("abc"), RECORD)


def margins(of, digits):
    return ({"b": 1.7 if digits is None else 0.4 * digits} if graded.student == "Bo" else {} for graded in of)


def marks(*steps):
    """Points, what they are out of, and the mark of each student with some steps: kind, part, value and
    answer."""
    decisions = Decisions(
        Decision("", "x" if part else "", "", part, kind, value, "", answer or None)
        for kind, part, value, answer in steps
    )
    check_steps(decisions.standing_steps, issued())
    adjusted = decisions.adjustments.applied(map(decisions.apply, sheets()), issued(), margins)
    on = decisions.adjustments.on(issued())
    return [(one.points, one.out_of, mark_of(on, one.points, one.out_of)) for one in adjusted]


WEIGHT, SPARED = ("weight", "b", 6, ""), ("neutral_if_hurt", "b", None, "")
STEPS = {
    (): [(8.5, 10, "17"), (2, 10, "4"), (3, 10, "6")],
    (WEIGHT,): [(10, 13, "15.5"), (2, 13, "3"), (6, 13, "9")],
    (WEIGHT, ("weight", "b", 3, "")): [(8.5, 10, "17"), (2, 10, "4"), (3, 10, "6")],
    (WEIGHT, ("withdrawn", "b", None, "")): [(8.5, 10, "17"), (2, 10, "4"), (3, 10, "6")],
    (("neutral", "b", None, ""),): [(7, 7, "20"), (2, 7, "5.5"), (0, 7, "0")],
    (SPARED,): [(7, 7, "20"), (2, 7, "5.5"), (3, 10, "6")],
    (SPARED, ("neutral_if_hurt", "a", None, "")): [(7, 7, "20"), (2, 7, "5.5"), (3, 8, "7.5")],
    (("bonus", "b", None, ""),): [(8.5, 7, "20"), (2, 7, "5.5"), (3, 7, "8.5")],
    (("accepted", "b", None, "9"),): [(8.5, 10, "17"), (5, 10, "10"), (3, 10, "6")],
    (("given", "a", 1, "7"),): [(8.5, 10, "17"), (2, 10, "4"), (4, 10, "8")],
    (("tolerance", "b", 2, ""),): [(8.5, 10, "17"), (5, 10, "10"), (3, 10, "6")],
    (("tolerance", "b", 1.5, ""),): [(8.5, 10, "17"), (2, 10, "4"), (3, 10, "6")],
    (("digits", "", 2, ""),): [(8.5, 10, "17"), (5, 10, "10"), (3, 10, "6")],
    (("digits", "", 3, ""),): [(8.5, 10, "17"), (2, 10, "4"), (3, 10, "6")],
    (("digits", "", 3, ""), ("tolerance", "b", 1.3, "")): [(8.5, 10, "17"), (5, 10, "10"), (3, 10, "6")],
    (("digits", "", 5, ""), ("tolerance", "b", 1.8, "")): [(8.5, 10, "17"), (5, 10, "10"), (3, 10, "6")],
    (("price", "b", 1, "slip"),): [(10, 10, "20"), (2, 10, "4"), (3, 10, "6")],
    (("price", "", 0.5, "mistake:term"),): [(8.5, 10, "17"), (2, 10, "4"), (5.5, 10, "11")],
    (("full", "", 8, ""),): [(8.5, 10, "20"), (2, 10, "5"), (3, 10, "7.5")],
    (("curve", "", None, "2:8 8:20"),): [(8.5, 10, "20"), (2, 10, "8"), (3, 10, "10")],
    (("step", "", 0.25, ""), WEIGHT): [(10, 13, "15.5"), (2, 13, "3"), (6, 13, "9.25")],
    (("full", "", 8, ""), ("neutral", "b", None, "")): [(7, 7, "17.5"), (2, 7, "5"), (0, 7, "0")],
}


@each_row("steps, expected", STEPS.items())
def test_each_step_gives_the_marks_that_a_hand_computes(steps, expected):
    assert marks(*steps) == expected


def test_a_decision_is_called_by_its_id_or_by_letters_that_begin_one_alone():
    step = Decision("", "x", "", "b", "neutral")
    decisions = Decisions(step._replace(id=name) for name in ("bcdfgh", "bcdkkk", "wwwwww"))
    decisions = decisions.with_steps([step._replace(id="zzzzzz", kind="withdrawn", withdraws="wwwwww")])
    assert [one.id for name in ("bcdfgh", "bcdk") for one in decisions.called(name)] == ["bcdfgh", "bcdkkk"]
    for name, said in {
        "bcd": "begins several",
        "wwwwww": "back already",
        "bc": "no decision",
        "": "stand",
    }.items():
        with pytest.raises(BadInput, match=said):
            decisions.called(name)


@each_row(
    "kind, part, value, answer",
    [
        ("weight", "b", 0, ""),
        ("weight", "d", 2, ""),
        ("tolerance", "b", 0.5, ""),
        ("price", "b", 2, "slip"),
        ("price", "b", 1, "correct"),
        ("full", "", 0, ""),
        ("curve", "", None, "5:10 4:20"),
        ("curve", "", None, "x"),
        ("neutral", "", None, ""),
        ("digits", "", 1, ""),
        ("digits", "", 2.5, ""),
        ("digits", "b", 3, ""),
    ],
)
def test_a_step_that_makes_no_sense_is_refused(kind, part, value, answer):
    with pytest.raises(BadInput):
        marks((kind, part, value, answer))


def test_a_mark_on_a_curve_is_never_below_nought_nor_above_the_best():
    curve = {"of": 20, "step": 0.5, "curve": [[0, 0], [5, 10], [10, 25]], "total": 10}
    assert [mark_on(curve, points, 10) for points in (0, 2.5, 5, 10, 12)] == ["0", "5", "10", "20", "20"]


def test_steps_in_a_file_last_and_marks_with_open_answers_are_provisional(small_course, tmp_path, capsys):
    course = coursework.open_course(small_course)
    numbers = {"Ada": {"ID number": "1"}, "Bo": {"ID number": "2"}}
    papers = issue(tmp_path, [item(course, "Ada", 5), item(course, "Bo", 6)], numbers)
    answers = right(course, "Ada", 5, v="hm 3 or 4") + right(course, "Bo", 6)
    assert grade(course, papers, answers)[0] == 1
    summary = tmp_path / "marks" / "summary.csv"
    assert [(s["provisional"], s["mark"]) for s in table(summary)] == [("1", "10"), ("", "20")]
    lines = [
        "student,exercise,seed,part,answer,kind,points,out_of,reason,by,date",
        ",crank_pin,,v,hm 3 or 4,given,1,,read on the draft,Mme Roy,2026-12-04",
        ",crank_pin,,v,,weight,6,,as announced,Mme Roy,2026-12-04",
    ]
    (tmp_path / "marks" / "decisions.csv").write_text("\n".join(lines) + "\n", "utf-8")
    # Graded twice: the file written the first time holds the same steps.
    for _ in range(2):
        assert grade(course, papers, answers)[0] == 0
        assert [(s["points"], s["out_of"], s["mark"]) for s in table(summary)] == [
            ("5", "8", "12.5"),
            ("8", "8", "20"),
        ]
        assert "provisional" not in table(summary)[0]
    assert table(tmp_path / "marks" / "decisions.csv")[-1]["by"] == "Mme Roy"
    assert {row["mark_now"] for row in table(tmp_path / "marks" / "changes.csv")} == {"12.5", "20"}
    # A mark edited by hand is noted beside the steps.
    text = (tmp_path / "marks" / "marks.csv").read_text("utf-8-sig")
    (tmp_path / "marks" / "marks.csv").write_text(text.replace("partial,3,6", "partial,6,6"), "utf-8")
    again = ["--course", course.folder.root, "grade", "--from", tmp_path / "marks" / "marks.csv"]
    assert run(list(map(str, [*again, "--issued", papers, "--no-feedback"]))) == 0
    assert table(summary)[0]["mark"] == "20"
    kinds = [row["kind"] for row in table(tmp_path / "marks" / "decisions.csv")]
    assert kinds == ["given", "weight", "edited"]
    (tmp_path / "marks" / "decisions.csv").unlink()
    grade(course, papers, answers)
    ask = ["gradebook", "moodle", tmp_path / "marks", "--item", "ds2", "--out", tmp_path / "book.xml"]
    capsys.readouterr()
    assert run(list(map(str, ask))) == 1
    assert "1 mark provisional, since answers wait for a person, left out" in capsys.readouterr().err


def test_a_step_on_a_question_that_was_not_issued_stops_the_marking(small_course, tmp_path, capsys):
    course = coursework.open_course(small_course)
    papers = issue(tmp_path, [item(course, "Ada", 5)])
    (tmp_path / "marks").mkdir()
    line = {"exercise": "crank_pin", "part": "w", "kind": "neutral"}
    text = ",".join(line) + "\n" + ",".join(line.values()) + "\n"
    (tmp_path / "marks" / "decisions.csv").write_text(text, "utf-8")
    assert grade(course, papers, right(course, "Ada", 5))[0] == 2
    assert "crank_pin has no part 'w'" in capsys.readouterr().err
    assert json.loads(papers.read_text("utf-8"))["assignment"]["mark"] == {"of": 20, "step": 0.5}
