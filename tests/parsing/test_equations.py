"""Equations are told from what is none."""

import re

from tables import each_row

import coursework
from coursework.language.words import words
from coursework.parsing.choices import read_choice
from coursework.parsing.equations import parse_equation, read_equation
from coursework.parsing.equivalence import same_equation

COURSE = coursework.open_course()
NAMES = ("r1", "r2", "r3", "r4", "theta2", "theta3", "theta4")


def test_an_equation_is_read_as_written():
    reading = read_equation("$r_2\\cos\\theta_2 + r_3\\cos\\theta_3 = r_1 + r_4\\cos\\theta_4$.", NAMES)
    reference = parse_equation("r2*cos(theta2) + r3*cos(theta3) = r1 + r4*cos(theta4)", NAMES)
    assert reading.status == "read"
    assert same_equation(reading.values[0], reference)


@each_row(
    ("text", "code"),
    [
        ("r1 + r2", "no_equals_sign"),
        ("r1 === r2", "two_equals_signs"),
        ("r1 = = r2", "two_equals_signs"),
        ("r1 = r2 = r3", "two_equals_signs"),
        ("r1 = r9", "unknown_symbol"),
        ("r1 = ", "not_a_number"),
        (5, "no_equals_sign"),
        (True, "not_a_number"),
        ("r1 = 9^9^9", "too_complex"),
    ],
)
def test_what_is_no_equation_says_why(text, code):
    reading = read_equation(text, NAMES)
    assert (reading.status, reading.code, reading.text) == ("unreadable", code, str(text))


def test_operators_and_places_tell_formulas_apart():
    ratios = {"speeds": ("$V_e / V_s$",), "inverse": ("$V_s / V_e$",)}
    assert read_choice("V_e / V_s", ratios).values == ("speeds",)
    assert read_choice("V_s/V_e", ratios).values == ("inverse",)
    assert read_choice("V_e*V_s", ratios).status == "unreadable"
    values = {"clamp": ("$m_u = 1$",), "none": ("$m_u = 0$",), "two": ("$m_u = 2$",)}
    for text in ("2", "2)", "(2)", "[2]"):
        assert read_choice(text, values).values == ("two",), text
    assert read_choice("m_u = +1", values).values == ("clamp",)
    counts = {"zero": ("0",), "three": ("3",), "one": ("1",)}
    assert read_choice("1.0", counts).values == ("one",)


def _as_people_write(equation, names):
    """An equation of the course in the ways people write it, those that it has letters for."""
    yield (
        "dots of a product",
        re.sub(r"(?<=[a-zA-Z)])\*(?=[a-zA-Z(])", ".", re.sub(r"([a-z]+[0-9])\*", r"\1 ", equation)),
    )
    yield "a title", f"sur y0 : {equation}"
    yield "a unit", f"{equation} mm/s"
    yield "accents", equation.replace("theta", "thêta").replace("omega", "oméga")
    yield "misspelled", equation.replace("theta", "teta").replace("omega", "w")
    for form in (
        r"d\1/dt",
        r"d(\1)/dt",
        r"d \1 / d t",
        r"\\frac{d\1}{dt}",
        r"\\frac{\\mathrm{d} \1}{\\mathrm{d} t}",
        r"\1_point",
    ):
        rates = re.sub(r"\b(phi|psi|theta)_dot\b", form, equation)
        if any(re.fullmatch(r"theta\d", name) for name in names):
            rates = re.sub(r"\bomega(\d)\b", form.replace(r"\1", r"theta\1"), rates)
        yield form, rates


def test_equations_of_the_course_are_right_however_people_write_them():
    wrong = []
    for variant in (COURSE[name].variant(0, lang="fr") for name in COURSE.names):
        for part in (p for p in variant.parts if p.kind == "equation"):
            right = str(variant.reference(part.quantity))
            for way, text in _as_people_write(right, part.variables):
                mark = variant.grade({part.id: text})[part.id]
                wrong += [(variant.exercise.name, part.id, way, text, mark.feedback)] * (
                    mark.verdict != "correct"
                )
    assert not wrong, wrong


def test_a_symbol_that_an_equation_must_not_contain_is_told_to_be_eliminated():
    told = 0
    for lang in ("en", "fr"):
        sentence = (
            words(lang)["marking"]["unreadable"]["to_eliminate"]
            .partition("{found}")[2]
            .partition("{symbols}")[0]
        )
        for variant in (COURSE[name].variant(0, lang=lang) for name in COURSE.names):
            parts = [p for p in variant.parts if p.kind == "equation"]
            stated = {name for p in parts for name in p.variables} | {
                n for n, v in variant.given.items() if not isinstance(v, str)
            }
            for part in parts:
                for name in stated.difference(part.variables, "e"):  # Euler's number
                    says = variant.grade({part.id: f"3*{name} = {part.variables[0]}"})[part.id].feedback
                    assert sentence.replace("'", "’").strip() in says, (
                        variant.exercise.name,
                        part.id,
                        name,
                        says,
                    )
                    told += 1
    assert told > 20
