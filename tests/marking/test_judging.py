"""Parts that are judged together, where many answers are right."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from sweeps import sampled

import coursework
from coursework.authoring import check_answers, checks
from coursework.cli import run
from coursework.errors import BadCourse, UnknownName
from coursework.issuing import issuing

EXERCISE = """
from coursework.model import Exercise, Part, drawn

EXERCISE = Exercise(
    given={"sum": drawn(10, 90, step=1, unit="mm")},
    parts=(
        Part("half", unit="mm"),
        Part("x", unit="mm", points=2, judge="adds_up"),
        Part("y", unit="mm", points=2, judge="adds_up"),
        Part("corner", unit="mm", kind="point", atol=0.5, rtol=0),
    ),
)
"""
SOLUTION = """
import csv

import numpy as np

from coursework.solution import Judged, judge, mistake


def half(sum):
    return sum / 2


def x(half):
    return half


def y(half):
    return half


def corner(sum):
    return np.stack([sum, 2 * sum], axis=-1)


@judge
def adds_up(answers, half):
    if len(answers) < 2:
        return {}
    total = answers["x"] + answers["y"]
    if abs(total - 2 * half) <= 0.1:
        return dict.fromkeys(answers, Judged())
    name = "twice" if abs(total - 4 * half) <= 0.1 else ""
    return dict.fromkeys(answers, Judged(0.5 if total > 0 else 0.0, name, {"sum": total}))


@mistake("x", "y", share=0.25)
def twice(x, y):
    return 2 * x, 2 * y


def residual(sum, half, x, y):
    return abs(x + y - sum), abs(2 * half - sum)


KNOWN = (({"sum": 10}, {"half": 5, "corner": (10, 20)}),)
"""
TEXT = "# Sums\n\nFind two numbers.\n\n## half\nHalf.\n\n## x\nOne.\n\n## y\nOther.\n\n## corner\nA point.\n"
WORDS = "# Sums\n\nMany are right.\n\n## mistake twice\nTwice too much.\n"


@pytest.fixture
def course(tmp_path):
    for folder in ("exercises", "solutions"):
        (tmp_path / folder).mkdir()
    (tmp_path / "exercises" / "sums.py").write_text(EXERCISE, "utf-8")
    (tmp_path / "solutions" / "sums.py").write_text(SOLUTION, "utf-8")
    for lang in ("fr", "en"):
        (tmp_path / "exercises" / f"sums.{lang}.md.j2").write_text(TEXT, "utf-8")
        (tmp_path / "solutions" / f"sums.{lang}.md.j2").write_text(WORDS, "utf-8")
    return tmp_path


@pytest.fixture
def variant(course):
    return coursework.open_course(course)["sums"].variant(3, "en")


def verdicts(variant, **answers):
    return {part: mark.verdict for part, mark in variant.grade(answers).items() if part in answers}


def test_many_answers_are_right_in_any_unit(variant):
    total = variant.given["sum"]
    for x in (0, 1, -300, total):
        answers = {"x": f"{x} mm", "y": f"{(total - x) / 10} cm"}
        assert set(verdicts(variant, **answers).values()) == {"correct"}


def test_a_named_mistake_says_what_follows_from_the_answers(variant):
    total = variant.given["sum"]
    marking = variant.grade({"x": total, "y": total})
    assert marking["x"].verdict == "mistake:twice"
    assert marking["x"].points == 1.0  # the judge's own share of 2 points
    assert "Twice too much." in marking["x"].feedback
    assert f"{2 * total:g} mm" in marking["x"].feedback


def test_what_is_said_of_a_whole_group_is_said_once(variant):
    total = variant.given["sum"]
    marking = variant.grade({"x": total, "y": total})
    assert marking["y"].verdict == "mistake:twice"
    assert "Twice too much." not in marking["y"].feedback
    assert "mm" not in marking["y"].feedback
    assert "remark on question 2" in marking["y"].feedback
    assert "remark on" not in variant.grade({"x": "?", "y": total})["y"].feedback


def test_what_is_not_right_and_has_no_name_is_wrong_and_keeps_its_share(variant):
    marking = variant.grade({"x": 1, "y": 1})
    assert (marking["x"].verdict, marking["x"].points) == ("wrong", 1.0)
    assert variant.grade({"x": -1, "y": -1})["y"].points == 0.0


def test_one_answer_of_a_group_cannot_be_judged_alone(variant):
    mark = variant.grade({"x": 5, "y": "?"})["x"]
    assert (mark.verdict, mark.points) == ("wrong", 0.0)
    assert "without an answer to" in mark.feedback


def test_answers_are_judged_from_the_students_own_earlier_ones(variant):
    total = variant.given["sum"]
    answers = {"half": total, "x": total / 2, "y": 1.5 * total}
    assert verdicts(variant, **answers) == {
        "half": "slip:constant",
        "x": "follow_through",
        "y": "follow_through",
    }
    # What is right needs no earlier error to explain it.
    assert verdicts(variant, half=total, x=0, y=total)["x"] == "correct"


def test_an_answer_that_may_be_read_in_two_ways_is_read_the_way_that_is_right(course):
    variant = next(
        v for v in coursework.open_course(course)["sums"].variants(range(200), "en") if v.given["sum"] == 12
    )
    # "1,234" is 1.234 or 1234.
    assert verdicts(variant, x="1,234", y=10.766) == {"x": "correct", "y": "correct"}
    assert verdicts(variant, x="1,234", y=-1222) == {"x": "correct", "y": "correct"}


def test_a_point_is_right_within_its_distance(variant):
    x, y = variant.given["sum"], 2 * variant.given["sum"]
    right = (f"({x}; {y})", f"{x / 10} ; {y / 10} cm", [x + 0.3, y - 0.39])
    wrong = (f"({x + 0.4}; {y + 0.4})", [y, x], f"({x}; {y}) deg")
    assert [verdicts(variant, corner=a)["corner"] for a in right] == ["correct"] * 3
    assert "correct" not in [verdicts(variant, corner=a)["corner"] for a in wrong]
    assert verdicts(variant, corner=x)["corner"] == "unreadable"


@pytest.mark.parametrize("count", [10, pytest.param(30, marks=pytest.mark.slow)])
def test_the_promises_hold_for_it(course, count):
    report = checks.check(coursework.open_course(course)["sums"], count)
    assert report.failures == []
    assert report.counts["rounded, judged together"] > 0


def test_a_judge_may_say_that_an_answer_follows_and_what_else_explains_one(course):
    path = course / "solutions" / "sums.py"
    source = path.read_text("utf-8")
    source = source.replace(
        "return dict.fromkeys(answers, Judged())", "return dict.fromkeys(answers, Judged(follows=True))"
    )
    source = source.replace('{"sum": total}))', '{"sum": total}, also=("thrice",)))')
    more = '\n\n@mistake("x", "y")\ndef thrice(x, y):\n    return 2 * x, 2 * y\n'
    path.write_text(source + more, "utf-8")
    variant = coursework.open_course(course)["sums"].variant(3, "en")
    words = course / "solutions" / "sums.en.md.j2"
    words.write_text(words.read_text("utf-8") + "\n## mistake thrice\nThree times.\n", "utf-8")
    total = variant.given["sum"]
    mark = variant.grade({"x": 0, "y": total})["x"]
    assert (mark.verdict, mark.points) == ("follow_through", 2.0)
    assert variant.grade({"x": total, "y": total})["x"].mistakes == ("twice", "thrice")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('judge="adds_up"', 'judge="add_up"', "no judge 'add_up'"),
        ("def adds_up(answers, half)", "def adds_up(half, answers)", "first parameter must be 'answers'"),
        ('name = "twice"', 'name = "thrice"', "names a mistake 'thrice'"),
        ("dict.fromkeys(answers, Judged())", '{"x": Judged()}', "says nothing of 'y'"),
    ],
)
def test_a_judge_that_cannot_judge_is_the_authors_fault_and_says_so(course, old, new, message):
    for folder in ("exercises", "solutions"):
        path = course / folder / "sums.py"
        path.write_text(path.read_text("utf-8").replace(old, new), "utf-8")
    opened = coursework.open_course(course)
    with pytest.raises((BadCourse, UnknownName), match=message):
        issuing.issue(opened, ["sums"], first_seed=0, count=2, langs=["en"])
    variant = opened["sums"].variant(3, "en")
    total = variant.given["sum"]
    with pytest.raises((BadCourse, UnknownName), match=message):
        [variant.grade(answers) for answers in ({"x": total, "y": total}, {"x": total, "y": 0})]


def test_the_bulk_marker_gives_the_same_marks(course, tmp_path):
    from coursework.gradebook.class_marking import _mark_chunk, _SheetJob

    opened = coursework.open_course(course)
    variants = opened["sums"].variants(range(20), "en")
    jobs = [
        _SheetJob(v.record, {"half": str(v.given["sum"] / 2), "x": "1", "y": str(v.given["sum"] - 1 - i % 2)})
        for i, v in enumerate(variants)
    ]
    for variant, job, lines in zip(variants, jobs, _mark_chunk(opened, jobs, None, {}), strict=True):
        alone = {p: (m.verdict, m.points) for p, m in variant.grade(job.answers).items()}
        assert {line[0]: (line[3], line[4]) for line in lines} == alone


# ------------------------------------------------------------------------- absurd answers

COURSE = coursework.open_course()
JUDGED = [name for name in COURSE.names if any(part.judge for part in COURSE[name].spec.parts)]
ABSURD = ("0", "1e308", "-1e308", "1e-320")


@pytest.mark.parametrize("name", sampled(JUDGED, JUDGED[9:10]))
def test_a_judge_answers_for_every_absurd_answer(name):
    """Each part of a judge alone, beside right answers, and each left out of an absurd sheet."""
    (variant,) = COURSE[name].variants([3], parts=("all",))
    right = variant.solution()
    size = {p.id: np.size(right[p.quantity]) for p in variant.parts if p.judge}
    shown = {p.id: check_answers._written(right[p.quantity]) for p in variant.parts if p.judge}
    for number in ABSURD:
        absurd = {i: "; ".join([number] * n) for i, n in size.items()}
        assert "correct" not in {variant.grade(absurd)[i].verdict for i in size}
        for i in size:
            for sheet in ({i: absurd[i]}, {**shown, i: absurd[i]}, {j: absurd[j] for j in size if j != i}):
                marking = variant.grade(sheet)
                assert all(marking[j].feedback for j in sheet)


def test_a_scale_that_no_paper_holds_is_none():
    (variant,) = COURSE["velocity_polygon_slider"].variants([0])
    marking = variant.grade({"kv": "1e-320", "p": "10;0", "b": "1;2"})
    assert marking["kv"].verdict != "correct"
    assert marking.points == 0


def test_an_absurd_sheet_breaks_no_promise_but_a_judge_that_fails_on_it_does(course):
    path = course / "solutions" / "sums.py"
    text = path.read_text("utf-8")
    path.write_text(text.replace("    total = ", '    1 / answers["x"]\n    total = '), "utf-8")
    report = checks.check(coursework.open_course(course)["sums"], 2, rendered=0)
    assert any("ZeroDivisionError" in told for told in report.failures)


def test_a_sheet_that_a_judge_cannot_judge_costs_itself_alone(course, tmp_path, capsys):
    """The others are marked, and the instructor is told why."""
    path = course / "solutions" / "sums.py"
    text = path.read_text("utf-8")
    path.write_text(
        text.replace("    total = ", "    if not answers['x']:\n        return {}\n    total = "), "utf-8"
    )
    (tmp_path / "class.csv").write_text("student\nAda\nBo\nCy\n", "utf-8")
    out = tmp_path / "out"
    built = ["build", "sums", "--roster", tmp_path / "class.csv", "--formats", "html", "--out", out]
    assert run(["--course", str(course), *map(str, built)]) == 0
    rows = ["student,exercise,seed,part,answer", "Ada,sums,,x,10", "Ada,sums,,y,10"]
    rows += ["Bo,sums,,half,1", "Bo,sums,,x,0", "Bo,sums,,y,0", "Cy,sums,,x,10", "Cy,sums,,y,1"]
    (tmp_path / "answers.csv").write_text("\n".join(rows), "utf-8")
    graded = ["grade", tmp_path / "answers.csv", "--issued", out / "issued.json", "--no-feedback"]
    assert run(["--course", str(course), *map(str, graded)]) == 1
    said = capsys.readouterr().err
    assert "1 sheet of sums cannot be marked" in said
    assert "says nothing of 'x'" in said
    marks = list(csv.DictReader((out / "marks" / "marks.csv").read_text("utf-8-sig").splitlines()))
    rejected = list(csv.DictReader((out / "marks" / "rejected.csv").read_text("utf-8-sig").splitlines()))
    assert [m["student"] for m in marks] == ["Ada", "Ada", "Cy", "Cy"]
    assert [r["student"] for r in rejected] == ["Bo"] * 3


def test_a_number_without_its_drawing_is_sent_to_the_drawing():
    """In every exercise with a drawing: an unexplained number is told no relation, a scale is called no right
    answer."""
    wrong, scales, tried = [], [], 0
    for name in COURSE.names:
        drawn = {p.judge for p in COURSE[name].spec.parts if p.kind == "point" and p.judge}
        if not drawn:
            continue
        (variant,) = COURSE[name].variants([0], "en", ["all"])
        points = [p.id for p in variant.parts if p.kind == "point" and p.judge]
        dots = {point: f"({3 * n + 5}; {n * n + 7})" for n, point in enumerate(points)}
        for part in (p for p in variant.parts if p.judge in drawn and p.kind == "number"):
            tried += 1
            mark = variant.grade({part.id: "7.654321"})[part.id]
            together = variant.grade(dots | {part.id: "7.654321"})[part.id]
            wrong += [(name, part.id)] if "relation" in mark.feedback + together.feedback else []
            is_scale = mark.verdict == "slip:not_drawn" and part.unit.endswith("/mm")
            scales += [(name, part.id)] if is_scale and "possible scale" not in mark.feedback else []
    assert (wrong, scales) == ([], [])
    assert tried
