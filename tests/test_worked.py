"""Worked solutions print the formula that computed the answer, with its numbers put in."""

from __future__ import annotations

import pytest

from coursework.degrees import atan2, cos, polar, sin, sqrt
from coursework.solution import formula
from coursework.worked import formula_latex, number_latex


def law_of_cosines(a, b, theta):
    return sqrt(a**2 + b**2 - 2 * a * b * cos(theta))


def quotient(a, b, theta):
    return a * (b + 1) / (b * sin(theta) ** 2)


def sums(a, b):
    return a - (b - a) + -b


def direction(a, b):
    return atan2(-a, b)


def vector(a, theta):
    return polar(a, theta).real


def two_steps(a, b):
    """Told in words."""
    c = a + b
    return c * c


@formula(r"<a> - <b>")
def stated(a, b):
    total = a
    return total - b


SYMBOLS = {"a": ("a", False), "b": ("b", False), "theta": (r"\theta", False)}
NUMBERS = {"a": (r"\num{3}", True), "b": (r"\num{-4}", True), "theta": (r"\num{60}^{\circ}", True)}


@pytest.mark.parametrize(
    ("function", "symbols", "numbers"),
    [
        (
            law_of_cosines,
            r"\sqrt{a^{\num{2}} + b^{\num{2}} - \num{2}\,a\,b\,\cos\left(\theta\right)}",
            r"\sqrt{\num{3}^{\num{2}} + \left(\num{-4}\right)^{\num{2}} - \num{2} \times \num{3} \times "
            r"\left(\num{-4}\right)\,\cos\left(\num{60}^{\circ}\right)}",
        ),
        (
            quotient,
            r"\frac{a\,\left(b + \num{1}\right)}{b\,\sin^{\num{2}}\left(\theta\right)}",
            r"\frac{\num{3} \times \left(\num{-4} + \num{1}\right)}{\num{-4}\,\sin^{\num{2}}\left(\num{60}^{\circ}\right)}",
        ),
        (
            sums,
            r"a - \left(b - a\right) + \left(-b\right)",
            r"\num{3} - \left(\num{-4} - \num{3}\right) + \left(-\left(\num{-4}\right)\right)",
        ),
        (
            direction,
            r"\operatorname{atan2}\left(-a;\ b\right)",
            r"\operatorname{atan2}\left(-\num{3};\ \num{-4}\right)",
        ),
        (
            vector,
            r"\operatorname{Re}\left(a\,e^{i\,\theta}\right)",
            r"\operatorname{Re}\left(\num{3}\,e^{i\,\num{60}^{\circ}}\right)",
        ),
        (two_steps, "", ""),
        (stated, "a - b", r"\num{3} - \left(\num{-4}\right)"),
    ],
)
def test_a_formula_and_its_substitution(function, symbols, numbers):
    assert formula_latex(function, SYMBOLS) == symbols
    assert formula_latex(function, NUMBERS) == numbers


def test_numbers_are_rounded_for_print_alone():
    assert number_latex(319.8037021, "mm") == r"\num{319.8}"
    assert number_latex(-0.0000123456, "mm") == r"\num{-1.2346e-5}"
    assert number_latex(104.63880, "deg") == r"\num{104.64}^{\circ}"
    assert number_latex(1 - 2j, "mm") == r"\left(\num{1} - \num{2}\,i\right)"


def test_every_step_of_a_sheet_is_told_by_formula_or_words_and_each_answer_once(course):
    for name in course.names:
        sheet = course[name].variant(4).answer_sheet()
        assert [a.question.id for a in sheet.answers] == [p.id for p in course[name].variant(4).parts]
        for step in sheet.steps:
            assert step.formula or step.words or step.value, f"{name}: step {step.name} says nothing"
        asked = {s.name for s in sheet.steps if s.asked}
        assert asked == {p.quantity for p in course[name].variant(4).parts}


def difference(whole, sum_of_two):
    return whole - sum_of_two


def test_a_symbol_that_is_a_sum_stands_in_brackets():
    shown = {"whole": ("L", False), "sum_of_two": ("s + l", False)}
    assert formula_latex(difference, shown) == r"L - \left(s + l\right)"
