"""Worked solutions print the formula that computed the answer, with its numbers put in."""

from __future__ import annotations

import numpy as np
from sweeps import at_once
from tables import each_row

import coursework
from coursework.degrees import acos, angle, atan2, cos, polar, sin, sqrt, wrap
from coursework.errors import Undefined
from coursework.quantities.formula_latex import PrintedName, formula_latex, number_latex
from coursework.sheets import answer_sheet as sheets
from coursework.solution import formula


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


def length(a, b):
    return np.hypot(a, b)


def signed_fraction(a, b, theta):
    return -a * cos(theta) / b


def turned_by_halves(theta, a):
    return wrap(theta + 180 - a * theta / 2)


def square_to(theta, a):
    return theta + 90 * a


def period(a):
    """One turn."""
    if a == 0:
        raise Undefined("it stands still")
    return np.where(a == 0, np.nan, 2 * np.pi / abs(a))[()]


def sum_of_vectors(a, b, theta):
    return angle(polar(a, theta) - (b + 1j * a))


def sum_with_a_complex_quantity(a, arm, theta):
    return angle(polar(a, theta) + arm)


def difference_of_squares(a, b):
    return sqrt((a - 2 * b) * (a + 2 * b))


def part_of_a_turn(a, b):
    return b * sin(180 / a) + cos(2 * 60 * a) ** 2


def part_of_radians(a, b):
    return b * np.sin(np.pi / a) + np.cos(2)


def _corner(near, other, opposite):
    """The law of cosines."""
    return acos((near**2 + other**2 - opposite**2) / (2 * near * other))


def corner(a, b):
    return _corner(a + b, b, a)


def extremes(a, b):
    return np.minimum(a, b) * np.sign(b)


def _position(x, y, z):
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def position(a, b):
    return _position(a + b, 0.0, -b)


def two_steps(a, b):
    """Told in words."""
    c = a + b
    return c * c


@formula(r"<a> - <b>")
def stated(a, b):
    total = a
    return total - b


SYMBOLS = {
    "a": ("a", False),
    "b": ("b", False),
    "theta": PrintedName(r"\theta", False, "angle"),
    "arm": PrintedName(r"\vec{r}", False, "complex"),
}
NUMBERS = {
    "a": (r"\num{3}", True),
    "b": (r"\num{-4}", True),
    "theta": PrintedName(r"\num{60}^{\circ}", True, "angle"),
    "arm": PrintedName(r"\left(\num{1} - \num{2}\,i\right)", True, "complex"),
}


@each_row(
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
            r"\frac{\num{3} \times \left(\num{-4} + "
            r"\num{1}\right)}{\num{-4}\,\sin^{\num{2}}\left(\num{60}^{\circ}\right)}",
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
        (
            length,
            r"\sqrt{a^{\num{2}} + b^{\num{2}}}",
            r"\sqrt{\num{3}^{\num{2}} + \left(\num{-4}\right)^{\num{2}}}",
        ),
        (
            signed_fraction,
            r"-\frac{a\,\cos\left(\theta\right)}{b}",
            r"-\frac{\num{3}\,\cos\left(\num{60}^{\circ}\right)}{\num{-4}}",
        ),
        (
            turned_by_halves,
            r"\theta + \num{180}^{\circ} - \frac{a\,\theta}{\num{2}}",
            r"\num{60}^{\circ} + \num{180}^{\circ} - \frac{\num{3} \times \num{60}^{\circ}}{\num{2}}",
        ),
        (square_to, r"\theta + \num{90}^{\circ}\,a", r"\num{60}^{\circ} + \num{90}^{\circ} \times \num{3}"),
        (period, r"\frac{\num{2}\,\pi}{\left|a\right|}", r"\frac{\num{2}\,\pi}{\left|\num{3}\right|}"),
        (
            sum_of_vectors,
            r"\operatorname{atan2}\left(a\,\sin\left(\theta\right) - a;\ a\,\cos\left(\theta\right) - "
            r"b\right)",
            r"\operatorname{atan2}\left(\num{3}\,\sin\left(\num{60}^{\circ}\right) - \num{3};\ "
            r"\num{3}\,\cos\left(\num{60}^{\circ}\right) - \left(\num{-4}\right)\right)",
        ),
        (
            sum_with_a_complex_quantity,
            r"\operatorname{arg}\left(a\,e^{i\,\theta} + \vec{r}\right)",
            r"\operatorname{arg}\left(\num{3}\,e^{i\,\num{60}^{\circ}} + "
            r"\left(\num{1} - \num{2}\,i\right)\right)",
        ),
        (
            difference_of_squares,
            r"\sqrt{a^{\num{2}} - \left(\num{2}\,b\right)^{\num{2}}}",
            r"\sqrt{\num{3}^{\num{2}} - \left(\num{2} \times \left(\num{-4}\right)\right)^{\num{2}}}",
        ),
        (
            part_of_a_turn,
            r"b\,\sin\left(\frac{\num{180}^{\circ}}{a}\right) + "
            r"\cos^{\num{2}}\left(\num{2} \times \num{60}^{\circ}\,a\right)",
            r"\num{-4}\,\sin\left(\frac{\num{180}^{\circ}}{\num{3}}\right) + "
            r"\cos^{\num{2}}\left(\num{2} \times \num{60}^{\circ} \times \num{3}\right)",
        ),
        (
            part_of_radians,
            r"b\,\sin\left(\frac{\pi}{a}\right) + \cos\left(\num{2}\right)",
            r"\num{-4}\,\sin\left(\frac{\pi}{\num{3}}\right) + \cos\left(\num{2}\right)",
        ),
        (
            corner,
            r"\arccos\left(\frac{\left(a + b\right)^{\num{2}} + b^{\num{2}} - a^{\num{2}}}"
            r"{\num{2}\,\left(a + b\right)\,b}\right)",
            r"\arccos\left(\frac{\left(\num{3} + \left(\num{-4}\right)\right)^{\num{2}} + "
            r"\left(\num{-4}\right)^{\num{2}} - \num{3}^{\num{2}}}"
            r"{\num{2}\,\left(\num{3} + \left(\num{-4}\right)\right) \times \left(\num{-4}\right)}\right)",
        ),
        (
            extremes,
            r"\operatorname{min}\left(a;\ b\right)\,\operatorname{sgn}\left(b\right)",
            r"\operatorname{min}\left(\num{3};\ \num{-4}\right)\,\operatorname{sgn}\left(\num{-4}\right)",
        ),
        (
            position,
            r"\left(a + b;\ \num{0};\ -b\right)",
            r"\left(\num{3} + \left(\num{-4}\right);\ \num{0};\ -\left(\num{-4}\right)\right)",
        ),
        (two_steps, "", ""),
        (stated, "a - b", r"\num{3} - \left(\num{-4}\right)"),
    ],
)
def test_a_formula_and_its_substitution(function, symbols, numbers):
    assert formula_latex(function, SYMBOLS) == symbols
    assert formula_latex(function, NUMBERS) == numbers


def beside_nothing(a):
    return np.minimum(a, None)


def beside_dots(a):
    return np.maximum(a, ...)


def beside_bytes(a):
    return a + b"1"


@each_row("function", [beside_nothing, beside_dots, beside_bytes])
def test_a_formula_with_what_is_no_number_is_left_to_words(function):
    assert formula_latex(function, SYMBOLS) == ""


def test_numbers_are_rounded_for_print_alone():
    assert number_latex(319.8137021, "mm") == r"\num{319.81}"
    assert number_latex(319.8037021, "mm") == r"\num{319.80}"  # a zero says that it is rounded there
    assert number_latex(319.8, "mm") == r"\num{319.8}"
    assert number_latex(0.1 + 0.2, "mm") == r"\num{0.3}"
    assert number_latex(-0.0000123456, "mm") == r"\num{-1.2346e-5}"
    assert number_latex(104.63880, "deg") == r"\num{104.64}^{\circ}"
    assert number_latex(1 - 2j, "mm") == r"\left(\num{1} - \num{2}\,i\right)"


@at_once(coursework.open_course().names)
def test_every_step_of_a_sheet_is_told_by_formula_or_words_and_each_answer_once(course, names):
    for name in names:
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


def times(k, OB):
    return k * OB * 2


@each_row("segment", ["OB", "OB_1", r"\angle DOB_{+}", "p_a b", "b'' b"])
def test_a_symbol_of_several_letters_is_told_from_a_product(segment):
    shown = {"k": ("k_a", False), "OB": (segment, False)}
    assert formula_latex(times, shown) == rf"k_a \times {segment} \times \num{{2}}"


@each_row("letter", ["r_{A,x}", r"\ddot{r}_1", r"V_{1/4}(A_1)", r"\mathrm{MA}", r"\theta_{4+}", r"\ell_3"])
def test_a_symbol_of_one_letter_stands_beside_its_factor(letter):
    shown = {"k": ("k_a", False), "OB": (letter, False)}
    assert formula_latex(times, shown).startswith(rf"k_a\,{letter} ")


@at_once(coursework.open_course().names)
def test_each_asked_step_says_which_question_it_answers(course, names):
    for name in names:
        for lang in ("fr", "en"):
            variant = course[name].variant(2, lang)
            first = {part.quantity: number for number, part in reversed([*enumerate(variant.parts, start=1)])}
            for step in variant.answer_sheet(polygons=False).steps:
                said = f"*Question {first[step.name]}.*" if step.asked else ""
                assert step.words.startswith(said), f"{name}: {step.name}: {step.words[:40]}"
                assert bool(said) == ("*Question " in step.words), f"{name}: {step.name}"


@each_row(
    ("reason", "lang", "said"),
    [
        ("", "en", "*Question 3.* Answer: **oscillates**."),
        ("It cannot turn.", "en", "*Question 3.* It cannot turn. Answer: **oscillates**."),
        ("It cannot *turn.*", "en", "*Question 3.* It cannot *turn.* Answer: **oscillates**."),
        ("Here the guide", "en", "*Question 3.* Here the guide **oscillates**."),
        (
            "Il ne peut tourner.",
            "fr",
            "*Question 3.* Il ne peut tourner. Réponse\N{NARROW NO-BREAK SPACE}: **oscille**.",
        ),
        ("Ici, le guide", "fr", "*Question 3.* Ici, le guide **oscille**."),
    ],
)
def test_a_case_ends_its_reason_or_follows_it(course, reason, lang, said):
    variant = course["slotted_mechanism"].variant(1, lang)
    assert variant.walk["guide"] == "oscillates"
    assert sheets._words_of(variant, "guide", "oscillates", reason) == said


@at_once(coursework.open_course().names)
def test_a_remark_bears_the_wrong_value_and_stands_where_it_is_one(course, names):
    for name in names:
        variant = course[name].variant(3, "en")
        texts = variant.solution_text
        solution = variant.exercise.solution
        texts_of = {m: texts.section(f"mistake {m}").text for m in solution.mistakes}
        for step in variant.answer_sheet(polygons=False).steps:
            for remark in step.remarks:
                graphs = [solution.mistaken(m) for m, text in texts_of.items() if text == remark.words]
                found = [g.evaluate((step.name,), variant.used, variant.effects)[step.name] for g in graphs]
                assert any(not np.array_equal(wrong, variant.walk[step.name]) for wrong in found), (
                    f"{name}: {remark}"
                )
                assert step.value not in remark.wrong or not step.value, f"{name}: {remark}"


def test_what_is_no_mistake_in_a_variant_is_not_told(course):
    """The arctangent of a quotient is right in two quadrants of four."""
    exercise = course["slotted_mechanism"]
    told = set()
    for seed in range(1, 13):
        variant = exercise.variant(seed, "en")
        text = variant.solution_text.section("mistake arctan_no_quadrant").text
        (step,) = (s for s in variant.answer_sheet(polygons=False).steps if s.name == "theta4")
        is_told = text in [remark.words for remark in step.remarks]
        assert is_told == (abs(variant.walk["theta4"]) > 90), seed
        told.add(is_told)
    assert told == {True, False}
