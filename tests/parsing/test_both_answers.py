"""A box that holds two answers earns neither; a right answer is read however it is written."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from functools import cache
from types import SimpleNamespace

import pytest
from course_of_every_kind import write_course
from hostile_answers import FORMS, both_in_one, holds_two, is_right, parts_to_try, right_spellings
from sweeps import seeds
from tables import each_row

import coursework
from coursework.kinds.kind import kind_of
from coursework.marking.answers import read
from coursework.parsing.choices import read_choice
from coursework.parsing.equations import read_equation
from coursework.parsing.equivalence import same_equation
from coursework.parsing.numbers import read_integer, read_number
from coursework.parsing.points import read_point

COURSE = coursework.open_course()
NAMES = [*COURSE.names, "coil"]
every_exercise = pytest.mark.parametrize("name", NAMES)
every_seed = seeds(1, 3)


@pytest.fixture(scope="module")
def exercise_of(tmp_path_factory):
    own = coursework.open_course(write_course(tmp_path_factory.mktemp("both") / "own"))
    return cache(lambda name: own[name] if name == "coil" else COURSE[name])


# ------------------------------------------------------------------ both in one


@every_exercise
@every_seed
def test_a_right_and_a_wrong_answer_in_one_box_are_not_right(exercise_of, name, seeds):
    most = 60 if len(seeds) == 1 else 150
    tried = 0
    for variant in exercise_of(name).variants(seeds):
        for part in parts_to_try(variant):
            rng = random.Random(f"{name} {variant.seed} {part.id}")
            for both in both_in_one(variant, part, rng, most):
                reading = read(variant, part, both.text)
                assert not (is_right(variant, part, reading) and holds_two(part, both, reading)), both
                tried += 1
    assert tried


@each_row(
    "text",
    [
        "1 [2]",
        "(2) (1)",
        "(2)(1)",
        "2:1",
        "2 : 1",
        "2* 1",
        "2*1",
        "2, 1",
        "2 1",
        "2/1",
        "2 + 0",
        "2 - 0*7",
        "2^1",
        "1 × 2",
        "2;1",
        "m_u = 0 (not m_u = 1)",
        "not 1 : 2",
        "two = 1",
        "un : 2",
        "80 ± 2",
        "x or 1 = 2",
        "2 (1) ddl",
        "((2) 1)",
        "~~1~~ 2",
    ],
)
def test_a_count_is_one_number(text):
    reading = read_integer(text)
    assert reading.status == "unreadable", reading


@each_row(
    ("text", "unit"),
    [
        ("319.8 [250]", "mm"),
        ("(319.8) (250) mm", "mm"),
        ("319.8, 250", "mm"),
        ("0 319.8", "mm"),
        ("0,319.8", "mm"),
        ("319.8 * 1 mm", "mm"),
        ("319.8 (1) mm", "mm"),
        ("319.8 1 mm", "mm"),
        ("not 250 : 319.8", "mm"),
        ("rA 250,5 = 319,8", "mm"),
        ("319.8 (3e2)", "mm"),
        ("700 (1e3)", "mm"),
        ("319.8 (0e9)", "mm"),
        ("3 + 5/2π", "mm"),
        ("8/2(1.8)", "mm"),
        ("8/2 sqrt(3.3)", "mm"),
        ("8/2π^0.52", "mm"),
        ("3 + 5/2π rad", "deg"),
        ("3 + 5/2π", "deg"),
        ("10 + arctan(3.46)", "deg"),
        ("acos(0.5)^2", "deg"),
        ("asin(sin(5))", "deg"),
        ("180 - π/3", "deg"),
        ("5 - 3π + 60/π", "deg"),
        ("40 - acos(0.5)*180/π + atan(2)", "deg"),
    ],
)
def test_two_numbers_and_a_formula_of_two_units_wait_for_a_person(text, unit):
    reading = read_number(text, unit)
    assert (reading.status, reading.code) == ("unreadable", "two_values") or reading.code == "not_a_number"


@each_row(
    ("text", "unit", "value"),
    [
        ("2*3", "mm", 6),
        ("0.2*10+1", "mm", 3),
        ("2 × 3.5", "mm", 7),
        ("3(4 - 1) - 2(4)", "mm", 1),
        ("2(3 + 4)", "mm", 14),
        ("1.25:1", "1", 1.25),
        ("3/1", "1", 3),
        ("1 - 0 = 1", "mm", 1),
        ("4 - 5 = -1", "mm", -1),
        ("3 = 3.0", "mm", 3),
        ("273.9 (273.92)", "mm", 273.9),
        ("omega 2 = 5", "mm", 5),
        ("θ_{2} : 5", "mm", 5),
        ("O2A = 5", "mm", 5),
        ("5 [mm]", "mm", 5),
        ("5 1/s", "rad/s", 5),
        ("5 rad 1/s", "rad/s", 5),
        ("-(5)", "mm", -5),
        ("|-5|", "mm", None),
        ("abs(-5)", "mm", 5),
        ("180 - arctan(1.59)", "deg", 180 - math.degrees(math.atan(1.59))),
        ("π - arctan(1.59)", "deg", 180 - math.degrees(math.atan(1.59))),
        ("π - 1.01", "deg", 180 - math.degrees(1.01)),
        ("2π/3", "deg", 120),
        ("3/2π", "deg", 270),
        ("1.8256*180/π", "deg", 1.8256 * 180 / math.pi),
        ("60*π/180", "deg", 60),
        ("1.8256 rad = 104.6°", "deg", 104.6),
        ("1.8256 = 104.6", "deg", 104.6),
        ("1.826 (104.6)", "deg", 104.6),
        ("104.6 (1.826)", "deg", 104.6),
        ("3.14159 - atan(1.6)", "deg", math.degrees(3.14159 - math.atan(1.6))),
        ("1.571 + asin(0.5)", "deg", math.degrees(1.571 + math.pi / 6)),
        (
            "arctan(80*sin(57)/(120 - 80*cos(57)))",
            "deg",
            math.degrees(math.atan2(80 * math.sin(math.radians(57)), 120 - 80 * math.cos(math.radians(57)))),
        ),
        ("acos(0.5)*180/π", "deg", 60),
        ("2*arctan(0.5)", "deg", math.degrees(2 * math.atan(0.5))),
        ("acos(0.5) + 15.5 deg", "deg", 75.5),
    ],
)
def test_a_formula_and_a_number_that_is_checked_are_one_value(text, unit, value):
    reading = read_number(text, unit, thousands=unit != "deg")
    if value is None:
        assert reading.status == "unreadable"
    else:
        assert reading.values == pytest.approx((value,), rel=1e-12)


def test_coordinates_that_are_cut_in_two_places_wait_for_a_person():
    assert read_point("120,1 234", "mm", 2).code == "two_values"
    assert read_point("12,3 ; 456", "mm", 2).values == ((12.3, 456),)


CLASSES = {"I": ("I", "classe I"), "II": ("II", "classe II"), "none": ("none", "aucune")}
LETTERS = {"I": "a", "II": "b", "none": "c"}


@each_row(
    "text",
    [
        "1) I 2) none",
        "I (not II)",
        "I or II",
        "I [II]",
        "a (not b)",
        "a (b)",
        "~~a~~ b",
        "a b",
        "1) a",
        "2) I",
    ],
)
def test_two_choices_are_none(text):
    assert read_choice(text, CLASSES).status == read_choice(text, CLASSES, LETTERS).status == "unreadable"


@each_row("text", ["a) I (c)", "a) I(b)", "I (b is wrong)", "I (non c)", "a [c]", "a (c'est pas b)"])
def test_a_letter_in_brackets_is_another_choice(text):
    assert read_choice(text, CLASSES, LETTERS).status == "unreadable"


@each_row(
    "text", ["a", "a) I", "I (a)", "a (r2 < b)", "a (il y a un pivot)", "1) I", "classe I (deux dyades)"]
)
def test_a_remark_says_no_other_choice(text):
    assert read_choice(text, CLASSES, LETTERS).values == ("I",)


EQUATION = ("r4", "r5", "theta4", "theta5")


@each_row("form", FORMS)
def test_two_equations_are_none(form):
    right, wrong = "r4*sin(theta4) = r5*sin(theta5)", "r4*cos(theta4) = r5*cos(theta5)"
    (reference,) = read_equation(right, EQUATION).values
    for a, b in ((right, wrong), (wrong, right)):
        for value in read_equation(form.format(a=a, b=b, u=""), EQUATION).values:
            assert not same_equation(value, reference, parameters=("r4", "r5"))


# ------------------------------------------- two freely chosen numbers in a formula

ANGLE = SimpleNamespace(unit="deg", half_width=lambda reference: 1.0)
_DEGREES = math.degrees(1.0)


def hedges(one: float, other: float) -> Iterator[str]:
    """Formulas worth ``one`` in one way to read them and ``other`` in another, both freely chosen; angles in
    degrees."""
    for turn in range(-3, 4):  # added to an inverse function: in degrees or in radians
        added = (other - one + 360 * turn) / (_DEGREES - 1)
        left = math.remainder(one - added, 360)
        if abs(left) < 89:
            yield f"{added:.9f} + arctan({math.tan(math.radians(left)):.9f})"
            yield f"{added:.9f} + arcsin({math.sin(math.radians(left)):.9f})"
    apart = math.pi / 2 - 1 / (2 * math.pi)  # X/2π: (X/2)π or X/(2π)
    for scale, unit in ((1.0, ""), (_DEGREES, " rad"), (_DEGREES, "")):
        factor = (one - other) / scale / apart
        yield f"{one / scale - factor * math.pi / 2:.9f} + {factor:.9f}/2π{unit}".replace("+ -", "- ")
    for turn in range(-60, 60):  # with pi, in degrees or in radians
        value = one + 360 * turn
        if abs(math.remainder(value * _DEGREES - other, 360)) < 1:
            yield from (
                f"{value / math.pi:.9f}π",
                f"{2 * value / math.pi:.9f}*π/2",
                f"{value - math.pi:.9f} + π",
                f"{value:.9f}*π/π",
            )
            yield from (
                f"{value:.9f} + 0π",
                f"{value:.9f} + sin(π)",
                f"{value * math.pi:.9f}/π",
                f"{value:.9f} - atan(1e-9)",
            )
    if one * other > 0:  # X/2(Z): (X/2)Z or X/(2Z)
        root = math.sqrt(one / other)
        first, power = 2 * one / root, math.log(one / other) / (2 * math.log(math.pi))
        yield from (
            f"{first:.9f}/2({root:.9f})",
            f"{first:.9f}/2({root - 1:.9f}+1)",
            f"{first:.9f}/2√{one / other:.9f}",
        )
        yield f"{2 * one / math.pi**power:.9f}/2π^({power:.9f})"
    yield from (
        f"{one:.3f} ({other:.3f})",
        f"{one / _DEGREES:.4f} ({other:.4f})",
        f"{one:.4f} = {other:.4f}",
        f"{one:.4f} 0 + {other:.4f}",
    )


def is_near(text: str, value: float, unit: str) -> bool:
    """Whether a text is right for a value: a direction within 1°, another number within 1 %."""
    if unit == "turning":
        angle = kind_of("angle")
        return any(angle.distance(ANGLE, v, value) <= 1 for v in angle.read(text, ANGLE, None).values)
    return any(abs(v - value) <= 0.01 * abs(value) for v in read_number(text, unit).values)


@pytest.mark.parametrize("pairs", [8, pytest.param(60, marks=pytest.mark.slow)])
@each_row("unit", ["turning", "deg", "mm", "1", "rad/s"])
def test_no_formula_is_worth_two_freely_chosen_numbers(unit, pairs):
    rng, tried = random.Random(17), 0
    for _ in range(pairs):
        one, other = rng.uniform(-170, 170), rng.uniform(-170, 170)
        if abs(one - other) > 5:
            for text in hedges(one, other):
                tried += 1
                assert not (is_near(text, one, unit) and is_near(text, other, unit)), (text, one, other)
    assert tried > 16 * pairs


# ------------------------------------------------------------------ right answers


@every_exercise
@seeds(2, 25)
def test_a_right_answer_is_read_in_every_spelling(exercise_of, name, seeds):
    tried = 0
    for variant in exercise_of(name).variants(seeds):
        for part in parts_to_try(variant):
            rng = random.Random(f"{name} {variant.seed} {part.id}")
            for answer in right_spellings(variant, part, rng):
                reading = read(variant, part, answer)
                assert is_right(variant, part, reading), (part.id, answer, reading)
                tried += 1
    assert tried


@each_row(
    ("text", "code"),
    [
        ("3 à 4", "two_values"),
        ("12 or 13", "two_values"),
        ("à refaire", "not_a_number"),
        ("ou", "not_a_number"),
    ],
)
def test_words_without_a_number_are_not_two_values(text, code):
    assert read_number(text, "mm").code == code
