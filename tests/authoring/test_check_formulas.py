"""The formula on paper gives the number on paper: what is printed is read back, and a wrong print is
caught."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from sweeps import at_once
from tables import each_row

import coursework
from coursework.authoring.check_formulas import check_formulas, prove
from coursework.authoring.check_report import CheckReport, notes
from coursework.authoring.checks import check
from coursework.course.exercise import ALL
from coursework.parsing.printed_formulas import NotEvaluable, read
from coursework.quantities import formula_latex as worked
from coursework.quantities.formula_latex import formula_in_symbols
from coursework.sheets.sheet import Step

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize("name", COURSE.names)


# ------------------------------------------------------------------- reading


@each_row(
    ("latex", "value"),
    [
        (r"\num{3} - \left(\num{-4} - \num{3}\right) + \left(-\left(\num{-4}\right)\right)", 14),
        (r"-\num{2} \times \left(\num{-3}\right)\,\left(\num{1} + \num{4}\right)", 30),
        (r"\num{-3}^{\num{2}}", -9),
        (r"\left(\num{-3}\right)^{\num{2}} - 2^2", 5),
        (r"-\frac{\num{1}}{\num{4}} \times \num{2}", -0.5),
        (r"\sqrt{\num{3}^{\num{2}} + \num{4}^2}", 5),
        (r"\left|\num{-4} + \num{1}\right|\,\pi", 3 * math.pi),
        (r"\sin \num{30}^{\circ} + \cos\left(\num{60}^{\circ}\right)", 1),
        (
            r"\num{2} \sin\left(\frac{\num{60}^{\circ}}{\num{2}}\right) \cos \left(\num{-60}^{\circ}\right)",
            0.5,
        ),
        (r"\sin^{\num{2}}\left(\num{30}^{\circ}\right)", 0.25),
        (r"\sin\left(\num{2}\right)", math.sin(2)),
        (r"\arcsin \frac{\num{1}}{2}", math.pi / 6),
        (r"\operatorname{atan2}\left(-\num{1};\ \num{-1}\right)", -3 * math.pi / 4),
        (r"\num{30}^{\circ} + \num{90}^{\circ} \times \num{1}", 2 * math.pi / 3),
        (
            r"\operatorname{min}\left(\num{4};\ \num{2};\ \num{7}\right)"
            r"\,\operatorname{sgn}\left(\num{-5}\right)",
            -2,
        ),
        (r"\operatorname{Re}\left(\num{2}\,e^{i\,\num{60}^{\circ}}\right)", 1),
        (r"\operatorname{arg}\left(\num{3}\,i + \left(\num{3} - \num{0}\,i\right)\right)", math.pi / 4),
        (r"\left|\left(\num{3} - \num{4}\,i\right)\right|", 5),
        (r"\num{2} \times (\num{3} + \num{4})^2", 98),
        (r"\num{1.5e3} \cdot \num{2}", 3000),
    ],
)
def test_a_printed_formula_gives_what_a_reader_finds(latex, value):
    (found,) = read(latex, 5).values
    assert found == pytest.approx(value, rel=1e-14)


def test_a_vector_has_its_coordinates():
    found = read(r"\left(\num{2} - \num{3};\ \num{0};\ \frac{\num{1}}{\num{4}}\right)", 5)
    assert found.values == (-1, 0, 0.25)


@each_row(
    ("latex", "told"),
    [
        (r"\num{2}\,r_1", "r has no value"),
        (r"\num{2} \times \omega", "ω has no value"),
        (r"\text{the sum of both}", "the sum of both"),
        (r"\num{2}\,\num{3}", "without a sign"),
        (r"\num{2} + ", "missing"),
        (r"\num{2} = \num{2}", "= has no value"),
        (r"\foo{2}", "foo"),
        (r"\left(\num{2}", "right"),
        (r"(\num{2} + \num{3}", "not closed"),
        (r"(\num{2} + \num{3})'", "prime"),
        (r"(\num{2} + \num{3})'^2", "prime"),
        (r"\sin\left(\num{2};\ \num{3}\right)", "sin of 2"),
        (r"\num{2} \times \left(\num{2};\ \num{3}\right)", "vector"),
        (r"\cos\left(\num{2}\,i\right)", "complex"),
    ],
)
def test_what_gives_no_number_is_refused_by_its_name(latex, told):
    with pytest.raises(NotEvaluable, match=told):
        read(latex, 5)


def test_the_width_is_what_rounding_the_printed_numbers_does():
    width = {
        latex: read(latex, 5).widths[0]
        for latex in (
            r"\num{319.80}",
            r"\num{319.8}",
            r"\num{12346}",
            r"\num{1.2346e-5}",
            r"\num{2} \times \num{319.80}",
            r"\num{319.80} + \num{45.000}",
        )
    }
    assert list(width.values()) == pytest.approx([0.005, 3.198e-7, 0.5, 5e-10, 0.01, 0.0055], rel=1e-4)
    # A direction that jumps by a turn does not move.
    assert (
        read(r"\operatorname{atan2}\left(\num{0};\ \num{-319.80}\right)", 5, is_angle=True).widths[0] < 1e-8
    )


def test_where_rounding_decides_whether_there_is_a_value_the_width_is_infinite():
    inside = read(r"\arccos\left(\frac{\num{100.00}}{\num{100.00}}\right)", 5)
    assert inside.values == (0,)
    assert inside.widths == (math.inf,)
    outside = read(r"\arccos\left(\frac{\num{100.01}}{\num{100.00}}\right)", 5)
    assert math.isnan(outside.values[0])
    assert outside.widths == (math.inf,)
    assert read(r"\arccos\left(\num{2}\right)", 5).widths == (0.0,)


# -------------------------------------------------------------------- proving


def step(substitution, value, formula="f"):
    return Step("x", "x", formula, substitution, value, "", (), False)


@each_row(
    ("substitution", "value"),
    [
        (r"\num{319.81} \times \num{2}", r"\num{639.61}\ \mathrm{mm}"),  # the product of what was rounded
        (r"\num{170}^{\circ} + \num{30}^{\circ}", r"\num{-160}^{\circ}"),
        (r"\left(\num{1} + \num{2};\ \num{0}\right)", r"\left(\num{3};\ \num{0}\right)\ \mathrm{mm}"),
        (r"\num{2}\,i", r"\left(\num{0} + \num{2}\,i\right)\ \mathrm{mm}"),
    ],
)
def test_a_formula_that_gives_its_value_is_proved(substitution, value):
    assert prove(step(substitution, value), {}).holds


@each_row(
    ("substitution", "value", "gives"),
    [
        (r"\num{319.81} \times \num{2}", r"\num{639.64}\ \mathrm{mm}", "639.62"),
        (r"\num{3} - \num{4} - \num{3}", r"\num{2}\ \mathrm{mm}", "-4"),  # a bracket is lost
        (r"\num{100}\,\sin\left(\num{30}\right)", r"\num{50}\ \mathrm{mm}", "-98.80316"),  # a degree sign is
        (r"\num{170}^{\circ} + \num{31}^{\circ}", r"\num{-160}^{\circ}", "201 deg"),
        (r"\num{180} - \num{30}^{\circ}", r"\num{150}^{\circ}", "deg"),
        (r"\left(\num{1};\ \num{2}\right)", r"\left(\num{1};\ \num{3}\right)", "1; 2"),
        (r"\left(\num{1};\ \num{2}\right)", r"\num{1}", "1; 2"),
        (r"\sqrt{\num{9} - \num{25}}", r"\num{4}", "nan"),
    ],
)
def test_a_formula_that_gives_another_value_fails_and_says_which(substitution, value, gives):
    proof = prove(step(substitution, value), {})
    assert not proof.holds
    assert not proof.why_not
    assert gives in proof.gives


@each_row(
    ("tried", "why"),
    [
        (step("", r"\num{4}", formula=""), "explained in words"),
        (step(r"\num{2} \times k", r"\num{4}"), "k has no value"),
        (step(r"\num{10000} - \num{9999.9}", r"\num{0.1}"), "do not tell"),
        (step(r"\arccos\left(\frac{\num{100.01}}{\num{100.00}}\right)", r"\num{0}^{\circ}"), "do not tell"),
    ],
)
def test_what_cannot_be_told_is_not_proved(tried, why):
    proof = prove(tried, {})
    assert not proof.holds
    assert why in proof.why_not


def test_a_quantity_that_is_another_one_has_its_number():
    shown = {r"\theta_3": r"\num{27.5}^{\circ}"}
    assert prove(step("", r"\num{27.5}^{\circ}", formula=r"\theta_3"), shown).holds
    assert not prove(step("", r"\num{28.5}^{\circ}", formula=r"\theta_3"), shown).holds
    assert prove(step("", "x = y", formula=r"\theta_3"), shown) is None  # no number


# ------------------------------------------------------------------ the course


@every_exercise
def test_every_printed_formula_of_the_course_is_proved(name):
    report = CheckReport(name)
    check_formulas(list(COURSE[name].variants(range(5), "en", (ALL,))), report)
    assert report.failures == []
    assert set(report.unproved.values()) <= {"explained in words"}


@at_once(COURSE.names, COURSE.names[::4])
def test_a_sign_turned_in_print_is_caught(names):
    """But where the term that it stands before is nothing, or half a turn."""
    tried = caught = 0
    for name in names:
        for own in COURSE[name].variant(1, "en", (ALL,)).answer_sheet(polygons=False).steps:
            before, sign, after = own.substitution.partition(" - ")
            if sign and not after.startswith((r"\num{0}", r"\num{180}^{\circ}")):
                tried += 1
                caught += not prove(replace(own, substitution=f"{before} + {after}"), {}).holds
    assert tried > 100 * len(names) / len(COURSE.names)
    assert caught >= 0.95 * tried


# ------------------------------------------------------------------- the check


PLANTED = """
from coursework.solution import formula


@formula(r"<r> \\times \\left(<omega> + \\num{1}\\right)")
def v(r, omega):"""


def test_a_wrong_formula_fails_the_check(small_course):
    path = small_course / "solutions" / "crank_pin.py"
    text = path.read_text("utf-8")
    assert "\ndef v(r, omega):" in text
    path.write_text(text.replace("\ndef v(r, omega):", PLANTED), "utf-8")
    report = check(coursework.open_course(small_course)["crank_pin"], 5)
    (failure,) = report.failures
    for told in ("printed formula of v,", r"\omega + \num{1}", "gives ", "printed is ", r"\mathrm{mm/s}"):
        assert told in failure


def test_a_formula_in_words_is_listed_and_not_taken_for_proved(small_course):
    path = small_course / "solutions" / "crank_pin.py"
    words = PLANTED.replace(r"<r> \times \left(<omega> + \num{1}\right)", r"\text{radius times rate}")
    path.write_text(path.read_text("utf-8").replace("\ndef v(r, omega):", words), "utf-8")
    report = check(coursework.open_course(small_course)["crank_pin"], 5)
    assert report.failures == []
    assert list(report.unproved) == ["v"]
    assert report.counts["formulas not proved"] == 5
    assert report.counts["formulas proved"] == 10
    assert "10 formulas" in notes([report])[0]
    assert "formulas not proved: v (radius times rate has no value)" in notes([report])[0]


def test_a_printer_that_loses_its_brackets_is_caught(monkeypatch):
    formula_in_symbols.cache_clear()
    monkeypatch.setattr(worked._Printer, "latex", lambda self, node, within=0: self._print(node)[0])
    report = CheckReport("ball_reducer")
    try:
        check_formulas(list(COURSE["ball_reducer"].variants(range(3), "en", (ALL,))), report)
    finally:
        formula_in_symbols.cache_clear()
    assert any("printed formula of v_O3" in failure for failure in report.failures)


CONSTANTS = """
GRAVITY = 9.81
TILT = 30


def v(r, omega, theta):"""


def printed_of(small_course, formula):
    """The step of v of the small course, its code another, and what the check says of it."""
    path = small_course / "solutions" / "crank_pin.py"
    text = path.read_text("utf-8").replace("\ndef v(r, omega):", CONSTANTS)
    path.write_text(text.replace("    return r * omega\n", f"    {formula}\n"), "utf-8")
    variant = coursework.open_course(small_course)["crank_pin"].variant(3, "en")
    report = CheckReport("crank_pin")
    check_formulas([variant], report)
    return next(s for s in variant.answer_sheet(polygons=False).steps if s.name == "v"), report


def test_a_constant_is_printed_by_its_name_then_by_its_value(small_course):
    step, report = printed_of(small_course, "return r * omega + GRAVITY * sin(TILT + theta)")
    assert r"\mathrm{GRAVITY}" in step.formula
    assert r"\num{9.81}" in step.substitution
    assert r"\num{30}^{\circ}" in step.substitution
    assert report.failures == []
    assert (report.unproved, report.counts["formulas proved"]) == ({}, 3)


def test_pi_and_logarithms_are_printed(small_course):
    step, report = printed_of(small_course, "return 2 * np.pi * r * np.log(r)")
    assert r"\pi" in step.formula
    assert r"\ln" in step.formula
    assert report.failures == []
    assert (report.unproved, report.counts["formulas proved"]) == ({}, 3)


@pytest.mark.parametrize(
    ("formula", "why"),
    [
        ("return r * omega if omega > 0 else -r * omega", "its code has an if, at line 25"),
        ("if omega > 0:\n        return r * omega\n    return -r * omega", "its code has an if, at line 25"),
        ("return r * np.log2(omega)", "np.log2 is not printed, at line 25"),
    ],
)
def test_what_no_formula_says_is_named(small_course, formula, why):
    step, report = printed_of(small_course, formula)
    assert step.formula == ""
    assert report.unproved == {"v": f"explained in words, since {why}; @formula may say it"}
