"""A formula turned with holes for its numbers is the formula turned as it stands."""

from __future__ import annotations

import pytest
from tables import each_row

from coursework.errors import BadStatement
from coursework.markup.line import to_line
from coursework.markup.mathml import to_mathml
from coursework.markup.number_holes import once_for_all_numbers
from coursework.markup.spoken import spoken
from coursework.markup.typst import to_typst

WRITERS = (to_typst, spoken, to_line)
NUMBERS = (
    "0",
    "1",
    "2",
    "007",
    "12.5",
    "-0.25",
    "319.8",
    "-228.60",
    "1.2e5",
    "-3E-7",
    "6.02e+23",
    ".5",
    "+4",
)
SHAPES = (
    r"r_A = \num{@} \times \left(\num{@}\right) = \num{@}\ \mathrm{mm}",
    r"\sqrt{\num{@}^{\num{2}} + \num{@}^2}",
    r"\frac{\num{@}}{\num{@} - \cos\left(\num{@}^{\circ}\right)}",
    r"x_{\num{@}} + \left(\num{@}\right)^{\num{@}}",
    r"\begin{aligned} a &= \num{@} \\ &\quad + \num{@} \end{aligned}",
    r"\begin{pmatrix} \num{@} & 0 \\ 1 & \num{@} \end{pmatrix}",
    r"\text{\%}\,\num{@}\,\text{mm} \pm \sqrt[\num{3}]{\num{@}}",
)


def _formulas():
    """Every shape with every number in each of its places."""
    for shape in SHAPES:
        places = shape.count("@")
        for first in range(len(NUMBERS)):
            formula = shape
            for place in range(places):
                formula = formula.replace("@", NUMBERS[(first + 5 * place) % len(NUMBERS)], 1)
            yield formula


@each_row("lang", ["fr", "en"])
@each_row("write", WRITERS)
def test_numbers_put_in_print_as_in_the_formula_turned_as_it_stands(write, lang):
    for formula in _formulas():
        assert write(formula, lang) == write.__wrapped__(formula, lang), formula


def test_a_formula_is_walked_once_for_all_its_numbers():
    walked = []

    def turn(tex: str, lang: str) -> str:
        walked.append(tex)
        return to_line.__wrapped__(tex, lang)

    write = once_for_all_numbers(turn)
    made = [write(rf"r = \num{{{k}.5}}\ \mathrm{{mm}}", "fr") for k in range(50)]
    assert made == [f"r = {k},5 mm" for k in range(50)]
    assert len(walked) == 3, "once with its hole, and with two samples to see that the hole holds"


def test_what_is_made_of_digits_is_made_of_the_formulas_own():
    """A number of two digits and one of three give another text than their digits alone."""
    write = once_for_all_numbers(lambda tex, lang: f"{tex} has {len(tex)} characters")
    for number in ("1", "12", "12.5", "312"):
        assert write(rf"\num{{{number}}}", "en") == rf"\num{{{number}}} has {6 + len(number)} characters"


@each_row("write", [*WRITERS, to_mathml])
def test_a_refused_formula_is_told_as_it_was_written(write):
    with pytest.raises(BadStatement, match=r"\\foo.*") as refused:
        write(r"\num{12.5} + \foo", "en")
    assert r"$\num{12.5} + \foo$" in str(refused.value)
