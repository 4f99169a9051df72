"""Any question may be asked alone: its words, formulas and drawings find what the others would have found on
the way."""

from __future__ import annotations

import pytest
from sweeps import sampled

import coursework
from coursework.authoring.check_alone import asked_alone, check_alone
from coursework.authoring.check_report import CheckReport
from coursework.authoring.checks import check
from coursework.errors import BadCourse, BadStatement
from coursework.issuing.issuing import distinct_variants

COURSE = coursework.open_course()
VARIANTS = 8
#: A text that counts what others find, a formula stated with an angle, a drawing that takes hidden vectors,
#: parts of one judge.
TELLING = {"closed_chain", "grashof", "slider_crank", "velocity_polygon_slotted"}


@pytest.mark.parametrize("name", sampled(COURSE.names, TELLING))
def test_each_question_may_be_asked_alone(name):
    exercise, report = COURSE[name], CheckReport(name)
    drawn = distinct_variants(exercise, 0, VARIANTS, exercise.languages[0], parts=("all",))
    check_alone(drawn, report)
    assert report.failures == []
    always = [parts for parts in asked_alone(exercise) if parts[0].when is None]
    assert report.counts["asked alone"] >= len(exercise.languages) * max(1, len(always))


def change(course, file, *pairs):
    path = course / file
    text = path.read_text("utf-8")
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, "utf-8")


def words_of_v(variant):
    return next(step.words for step in variant.answer_sheet().steps if step.name == "v")


def test_the_words_of_a_step_may_name_what_another_question_asks(small_course):
    told = r"a circle of radius $r$; $x$ = {{ x }}{% if y is defined %}, $y$ = {{ y }}{% endif %}"
    change(small_course, "solutions/crank_pin.en.md.j2", ("a circle of radius $r$", told))
    exercise = coursework.open_course(small_course)["crank_pin"]
    alone, whole = (exercise.variant(3, "en", parts) for parts in (["v"], ["all"]))
    assert "x" not in alone.walk
    assert words_of_v(alone).partition("circle")[2] == words_of_v(whole).partition("circle")[2]
    assert words_of_v(alone).endswith("$x$ = −149.4, $y$ = −125.3.")


def test_what_exists_in_no_variant_like_this_is_still_refused(small_course):
    change(
        small_course, "solutions/crank_pin.en.md.j2", ("a circle of radius $r$", "a circle, $t$ = {{ t }}")
    )
    change(
        small_course,
        "solutions/crank_pin.py",
        ('@mistake("x"', 'def t(r):\n    return np.nan * r\n\n\n@mistake("x"'),
    )
    with pytest.raises(BadStatement, match="'t' is undefined"):
        coursework.open_course(small_course)["crank_pin"].variant(3, "en", ["v"]).answer_sheet()


def test_a_formula_stated_with_another_quantity_is_told_after_it(small_course):
    stated = '@formula(r"\\sqrt{<r>^2 - <x>^2}")\ndef y(r, theta)'
    change(
        small_course,
        "solutions/crank_pin.py",
        ("def y(r, theta)", stated),
        ("import mistake", "import formula, mistake"),
    )
    variant = coursework.open_course(small_course)["crank_pin"].variant(3, "en", ["y"])
    assert [step.name for step in variant.answer_sheet().steps] == ["x", "y"]
    assert [step.asked for step in variant.answer_sheet().steps] == [False, True]


def test_two_formulas_may_be_stated_with_each_other(small_course):
    stated = [
        f'@formula(r"\\sqrt{{<r>^2 - <{other}>^2}}")\ndef {own}(r, theta)' for own, other in ("xy", "yx")
    ]
    change(
        small_course,
        "solutions/crank_pin.py",
        ("def x(r, theta)", stated[0]),
        ("def y(r, theta)", stated[1]),
        ("import mistake", "import formula, mistake"),
    )
    exercise = coursework.open_course(small_course)["crank_pin"]
    for own in "xy":
        *_, step = exercise.variant(3, "en", [own]).answer_sheet().steps
        assert step.name == own
        assert step.substitution.startswith(r"\sqrt{\num{195}^2 - \left(\num{-1")


def v_told_after(course, *names):
    change(
        course,
        "solutions/crank_pin.py",
        ("def v(r, omega)", f"@explained_after{names}\ndef v(r, omega)"),
        ("import mistake", "import mistake, explained_after"),
    )
    return coursework.open_course(course)["crank_pin"]


def test_a_step_may_be_told_after_others(small_course):
    exercise = v_told_after(small_course, "y", "x")
    assert [step.name for step in exercise.variant(3, "en", ["v"]).answer_sheet().steps] == ["y", "x", "v"]
    assert exercise.plan(["v"]) == ("v",)  # nothing is computed for it that it does not take


def test_a_step_that_is_told_after_what_is_no_quantity_is_refused(small_course):
    exercise = v_told_after(small_course, "yy", "x")
    with pytest.raises(
        BadCourse,
        match=r"crank_pin\.py: v is explained after 'yy', which is not a quantity; did you mean 'y'",
    ):
        exercise.solution  # noqa: B018


TOGETHER = """
@judge
def on_the_circle(answers, r):
    if len(answers) < 2:
        return {}
    far = abs(np.hypot(answers["x"], answers["y"]) - r) > 0.01 * r
    return {i: Judged(0.0 if far else 1.0) for i in answers}


@mistake("x", "y")"""


def judged_together(course, also=""):
    change(
        course,
        "exercises/crank_pin.py",
        ('Part("x", unit="mm")', 'Part("x", unit="mm", judge="on_the_circle")'),
        ('Part("y", unit="mm")', f'Part("y", unit="mm", judge="on_the_circle"{also})'),
    )
    change(
        course,
        "solutions/crank_pin.py",
        ('\n@mistake("x", "y")', TOGETHER),
        ("import mistake", "import Judged, judge, mistake"),
    )
    return coursework.open_course(course)["crank_pin"]


def test_what_is_judged_together_is_asked_together(small_course):
    exercise = judged_together(small_course)
    assert exercise.variant(3, parts=["y"]).part_ids == ("x", "y")
    assert exercise.variant(3, parts=["v"]).part_ids == ("v",)
    assert [[p.id for p in parts] for parts in asked_alone(exercise)] == [["x", "y"], ["v"]]


def test_the_check_tells_a_question_that_cannot_be_marked_alone(small_course):
    exercise = judged_together(small_course, ", by_request=True")
    failures = check(exercise, 5).failures
    assert any(
        "asked alone, x: " in told and "judge 'on_the_circle' says nothing of 'x'" in told
        for told in failures
    )
