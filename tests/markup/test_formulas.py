"""Formulas reach every back end: compiled, well-formed, spoken, on one line."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import pytest
import typst
from formula_samples import FORMULAS, call
from rendering_samples import handout
from tables import each_row

from coursework.course.builtin import builtin_root
from coursework.errors import BadStatement
from coursework.markup.formula_tree import GRIDS, MACROS
from coursework.markup.formulas import check_formula, number_text
from coursework.markup.latex import to_notebook
from coursework.markup.line import to_line
from coursework.markup.markdown import to_html
from coursework.markup.mathml import to_mathml
from coursework.markup.spoken import spoken
from coursework.markup.typst import to_typst
from coursework.rendering.renderer import Renderer

TEMPLATES = builtin_root() / "templates"
RENDERER = Renderer([TEMPLATES])
every_language = pytest.mark.parametrize("lang", ["fr", "en"])


def mathless(tex: str, lang: str) -> str:
    return re.sub(r"<[^>]*>", "", to_mathml(tex, lang))


@every_language
@each_row("tex", FORMULAS)
def test_a_formula_of_every_kind_compiles(tex, lang):
    said = json.dumps(spoken(tex, lang), ensure_ascii=False)
    formula = f"#math.equation(alt: {said}, ${to_typst(tex, lang)}$.body)"
    source = f'#set document(title: "x")\n{formula}'
    assert typst.compile(source.encode(), pdf_standards="ua-1").startswith(b"%PDF")


@every_language
@each_row("tex", FORMULAS)
def test_a_formula_of_every_kind_is_well_formed_mathml(tex, lang):
    from xml.etree import ElementTree

    root = ElementTree.fromstring(to_mathml(tex, lang))
    assert root.tag == "math"
    assert root.attrib["alttext"].strip()


def test_every_macro_of_the_whitelist_is_typeset():
    source = "\n\n".join(f"${to_typst(call(macro), 'fr')}$" for macro in sorted(MACROS))
    assert typst.compile(source.encode()).startswith(b"%PDF")


@each_row("macro", sorted(MACROS))
def test_every_macro_of_the_whitelist_reaches_every_back_end(macro):
    tex = call(macro)
    assert to_typst(tex, "fr")
    for written in (to_mathml(tex, "fr"), spoken(tex, "fr"), to_line(tex, "fr"), to_notebook(tex, "fr")):
        assert written


@each_row("kind", GRIDS)
def test_every_grid_compiles(kind):
    tex = rf"\begin{{{kind}}} a & b \\ c & d \\ \end{{{kind}}}"
    assert typst.compile(f"${to_typst(tex, 'en')}$".encode()).startswith(b"%PDF")
    assert to_mathml(tex, "en").count("<mtr>") == 2


@each_row(
    ("tex", "named"),
    [
        (r"\stackrel{a}{b}", r"\stackrel"),
        (r"\SI{3}{mm}", r"\SI"),
        (r"\thetta", "did you mean 'theta'"),
        (r"\href{x}{y}", r"\href"),
        (r"\begin{align} a \end{align}", "did you mean 'aligned'"),
        (r"x = \begin{aligned} a \end{aligned}", "stands alone"),
        (r"1.5 x", r"\num"),
        (r"\num{1,5}", "1,5"),
        (r"\num{x}", "x"),
        (r"\frac{a}", r"\frac"),
        (r"x^2^3", "two ^"),
        (r"\left( x", r"\right"),
        (r"\left a x \right)", "delimiter"),
        (r"x }", "}"),
        (r"{ x", "}"),
        (r"\text{$x$}", r"\text"),
        ("#x", "#"),
    ],
)
def test_a_formula_outside_the_whitelist_is_refused_by_name(tex, named):
    with pytest.raises(BadStatement) as refused:
        check_formula(tex)
    assert named in str(refused.value)
    assert tex in str(refused.value)


def test_a_number_is_printed_as_its_language_writes_it_in_every_back_end():
    tex = r"\num{-1234.5e-3}"
    assert to_typst(tex, "fr") == '−"1234,5"× attach("10", t: "−3")'
    assert to_typst(tex, "en") == '−"1234.5"× attach("10", t: "−3")'
    assert to_notebook(tex, "fr") == r"-1234{,}5 \times 10^{-3}"
    assert to_notebook(tex, "en") == r"-1234.5 \times 10^{-3}"
    assert mathless(tex, "fr") == "−1234,5×10−3"
    assert mathless(tex, "en") == "−1234.5×10−3"
    assert spoken(tex, "fr") == "moins 1234,5 fois 10 puissance −3"
    assert to_line(tex, "fr") == number_text("-1234.5e-3", "fr") == "−1234,5\u202f×\u202f10⁻³"


def test_no_blank_stands_beside_a_quoted_number_in_typst():
    written = to_typst(r"x = - \num{2.41} \mathrm{mm} - \num{4.21}", "fr")
    assert written == 'x \\= −"2,41""mm"−"4,21"'


@each_row(
    ("tex", "fr", "en"),
    [
        (r"\theta_4", "thêta 4", "theta 4"),
        (r"\frac{a}{b}", "a sur b", "a over b"),
        (r"\ddot{x}^2", "x deux points au carré", "x double dot squared"),
        (
            r"\overrightarrow{OA} \neq \vec 0",
            "vecteur O A différent de vecteur 0",
            "vector O A is not equal to vector 0",
        ),
        (
            r"\sqrt{x + 1}",
            "la racine carrée de x plus 1 fin de racine",
            "the square root of x plus 1 end root",
        ),
        (r"90^\circ", "90 degrés", "90 degrees"),
        (r"\,", "formule", "formula"),
    ],
)
def test_a_formula_is_said_in_the_words_of_its_language(tex, fr, en):
    assert spoken(tex, "fr") == fr
    assert spoken(tex, "en") == en


@each_row(
    ("tex", "line"),
    [
        (r"\theta_{12}^2 = \frac{y}{x + 1}", "θ₁₂² = y/(x + 1)"),
        (r"r_A \le \sqrt{x}", "r_A ≤ √x"),
        (r"90^\circ", "90°"),
        (r"\dot\theta_4", "θ̇₄"),
    ],
)
def test_a_formula_fits_on_one_line_of_a_terminal(tex, line):
    assert to_line(tex, "en") == line


@each_row(
    ("tex", "lang", "body"),
    [
        (r"90^\circ", "en", "<mrow><mn>90</mn><mtext>°</mtext></mrow>"),
        (r"\num{24.3}^{\circ}", "fr", "<mrow><mn>24,3</mn><mtext>°</mtext></mrow>"),
        (r"x^2", "en", "<msup><mi>x</mi><mn>2</mn></msup>"),
    ],
)
def test_degrees_stand_at_the_height_of_their_number(tex, lang, body):
    assert body in to_mathml(tex, lang)


def test_the_dot_of_a_unit_stands_close_in_every_back_end():
    for tex in (r"\mathrm{N\cdot m}", r"\mathrm{N{\cdot}m}"):
        assert to_typst(tex, "fr") == '"N·m"'
        assert mathless(tex, "fr") == to_line(tex, "fr") == "N·m"


@each_row("tex", ["a = -b", "(-b)", r"(0;\ -b)", "-b"])
def test_a_sign_stands_close_to_its_number_and_an_operation_apart(tex):
    leading = '<mo stretchy="false">−</mo>' if tex == "-b" else '<mo stretchy="false" form="prefix">−</mo>'
    assert leading in to_mathml(tex, "en")
    assert '<mo stretchy="false">−</mo>' in to_mathml("a - b", "en")


def test_brackets_grow_only_around_what_is_tall():
    assert 'stretchy="true"' not in to_mathml(r"\left( a + b^2 \right)", "en")
    assert 'stretchy="true"' in to_mathml(r"\left( a + \frac{b}{c} \right)", "en")


def test_a_wide_table_and_a_long_formula_scroll_and_a_keyboard_reaches_them():
    table = to_html("| a | b |\n|---|---|\n| 1 | 2 |", "fr")
    assert '<div class="wide-table" tabindex="0" role="group" aria-label="Tableau">' in table
    assert table.count("<div") == table.count("</div>") == 1
    assert 'class="long" tabindex="0"' in to_mathml("+".join("abcdefghijklmnop"), "fr")
    assert "tabindex" not in to_mathml("a + b", "fr")


def test_a_choice_that_is_a_formula_is_labelled_in_words():
    sheet = handout("en")
    choices = (("one", "$w = 1$"), ("two", "two"))
    question = replace(sheet.questions[0], kind="choice", choices=choices)
    page = RENDERER.html(replace(sheet, questions=(question,)))
    assert page.count('value="w = 1" aria-label="w equals 1"') == 1
    assert 'value="two"> two' in page


def test_a_dot_over_a_letter_leaves_its_subscript_outside():
    assert to_typst(r"\dot\theta_4", "en") == "attach(dot(θ), b: 4)"
