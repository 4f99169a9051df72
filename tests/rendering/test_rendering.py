"""Promises of the rendering: what a sheet shows, in which form, and what it never holds."""

from __future__ import annotations

import ast
import json
import re
import shutil
import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import reduce
from importlib import resources

import nbformat
import pytest
import typst
from formula_samples import FORMULAS, call
from rendering_samples import ANSWER_DIGITS, answer_sheet, feedback_sheet, handout, many_given

from coursework.course.builtin import builtin_root
from coursework.course.texts import Section
from coursework.errors import BadCourse, BadStatement
from coursework.language import words as language
from coursework.language.typography import typeset
from coursework.language.words import words
from coursework.markup.formula_tree import GRIDS, MACROS
from coursework.markup.formulas import check_formula, number_text
from coursework.markup.latex import to_notebook
from coursework.markup.line import to_line
from coursework.markup.markdown import (
    to_html,
    to_notebook_markdown,
    to_text,
    to_typst_markup,
    typst_text,
    typst_value,
)
from coursework.markup.mathml import to_mathml
from coursework.markup.spoken import spoken
from coursework.markup.typst import to_typst
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.rendering.views import points_text, tolerances, verdict_word
from coursework.sheets.sheet import Given

TEMPLATES = builtin_root() / "templates"
RENDERER = Renderer([TEMPLATES])
SHEETS = {"handout": handout, "many given": many_given, "answers": answer_sheet, "feedback": feedback_sheet}
every_language = pytest.mark.parametrize("lang", ["fr", "en"])
every_sheet = pytest.mark.parametrize("make", SHEETS.values(), ids=SHEETS)


def mathless(tex: str, lang: str) -> str:
    return re.sub(r"<[^>]*>", "", to_mathml(tex, lang))


@every_language
@pytest.mark.parametrize("tex", FORMULAS)
def test_a_formula_of_every_kind_compiles(tex, lang):
    said = json.dumps(spoken(tex, lang), ensure_ascii=False)
    formula = f"#math.equation(alt: {said}, ${to_typst(tex, lang)}$.body)"
    source = f'#set document(title: "x")\n{formula}'
    assert typst.compile(source.encode(), pdf_standards="ua-1").startswith(b"%PDF")


@every_language
@pytest.mark.parametrize("tex", FORMULAS)
def test_a_formula_of_every_kind_is_well_formed_mathml(tex, lang):
    from xml.etree import ElementTree

    root = ElementTree.fromstring(to_mathml(tex, lang))
    assert root.tag == "math"
    assert root.attrib["alttext"].strip()


@pytest.mark.parametrize("macro", sorted(MACROS))
def test_every_macro_of_the_whitelist_reaches_every_back_end(macro):
    tex = call(macro)
    source = f"${to_typst(tex, 'fr')}$"
    assert typst.compile(source.encode()).startswith(b"%PDF")
    for written in (to_mathml(tex, "fr"), spoken(tex, "fr"), to_line(tex, "fr"), to_notebook(tex, "fr")):
        assert written


@pytest.mark.parametrize("kind", GRIDS)
def test_every_grid_compiles(kind):
    tex = rf"\begin{{{kind}}} a & b \\ c & d \\ \end{{{kind}}}"
    assert typst.compile(f"${to_typst(tex, 'en')}$".encode()).startswith(b"%PDF")
    assert to_mathml(tex, "en").count("<mtr>") == 2


@pytest.mark.parametrize(
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


@pytest.mark.parametrize(
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


@pytest.mark.parametrize(
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


def test_the_dot_of_a_unit_stands_close_in_every_back_end():
    for tex in (r"\mathrm{N\cdot m}", r"\mathrm{N{\cdot}m}"):
        assert to_typst(tex, "fr") == '"N·m"'
        assert mathless(tex, "fr") == to_line(tex, "fr") == "N·m"


@pytest.mark.parametrize("tex", ["a = -b", "(-b)", r"(0;\ -b)", "-b"])
def test_a_sign_stands_close_to_its_number_and_an_operation_apart(tex):
    leading = '<mo stretchy="false">−</mo>' if tex == "-b" else '<mo stretchy="false" form="prefix">−</mo>'
    assert leading in to_mathml(tex, "en")
    assert '<mo stretchy="false">−</mo>' in to_mathml("a - b", "en")


def test_brackets_grow_only_around_what_is_tall():
    assert 'stretchy="true"' not in to_mathml(r"\left( a + b^2 \right)", "en")
    assert 'stretchy="true"' in to_mathml(r"\left( a + \frac{b}{c} \right)", "en")


def test_a_wide_table_and_a_long_formula_scroll_and_a_keyboard_reaches_them():
    table = to_html("| a | b |\n|---|---|\n| 1 | 2 |", "fr")
    assert '<div class="wide-table" tabindex="0" role="region" aria-label="Tableau">' in table
    assert table.count("<div") == table.count("</div>") == 1
    assert 'class="long" tabindex="0"' in to_mathml("+".join("abcdefghijklmnop"), "fr")
    assert "tabindex" not in to_mathml("a + b", "fr")


def test_a_choice_that_is_a_formula_is_labelled_in_words():
    sheet = handout("en")
    choices = (("one", "$w = 1$"), ("two", "two"))
    question = replace(sheet.questions[0], kind="choice", choices=choices)
    page = RENDERER.html(replace(sheet, questions=(question,)))
    assert page.count('value="one" aria-label="w equals 1"') == 1
    assert 'value="two"> two' in page


def test_a_dot_over_a_letter_leaves_its_subscript_outside():
    assert to_typst(r"\dot\theta_4", "en") == "attach(dot(θ), b: 4)"


def keys(table: dict, path: str = "") -> set[str]:
    return {
        key
        for name, value in table.items()
        for key in (keys(value, f"{path}{name}.") if isinstance(value, dict) else {path + name})
    }


def test_both_languages_have_the_same_words():
    tables = {
        lang: tomllib.loads((resources.files("coursework") / "language" / f"{lang}.toml").read_text("utf-8"))
        for lang in ("fr", "en")
    }
    french, english = (keys({k: v for k, v in t.items() if k != "units"}) for t in tables.values())
    assert french == english
    for name in english:
        texts = [reduce(lambda table, key: table[key], name.split("."), table) for table in tables.values()]
        blanks = [set(re.findall(r"\{\w*\}", text)) for text in texts if isinstance(text, str)]
        assert blanks[1:] == blanks[:-1], f"{name}: {texts}"


def test_a_language_whose_file_lacks_a_text_says_which(monkeypatch):
    whole = language._read("en")
    lacking = {**whole, "study": {k: v for k, v in whole["study"].items() if k != "refused"}}
    monkeypatch.setattr(language, "_read", lambda lang: lacking if lang == "fr" else whole)
    with pytest.raises(BadCourse, match=r"fr\.toml lacks study\.refused\.all_begun, .*en\.toml"):
        words.__wrapped__("fr")


def test_french_puts_narrow_spaces_where_french_does():
    assert typeset("Est-ce juste ? Oui : « voici » ; 3 mm", "fr") == (
        "Est-ce juste\u202f? Oui\u202f: «\u202fvoici\u202f»\u202f; 3\u202fmm"
    )
    assert typeset("l'angle, quoi?", "fr") == "l’angle, quoi\u202f?"
    assert typeset("Is it right? 3 mm", "en") == "Is it right? 3\u00a0mm"
    assert typeset("à 12:30 (a:b)", "fr") == "à 12:30 (a:b)"
    for write in (to_html, to_typst_markup, to_notebook_markdown):
        assert write("$x$ ; **y** : z", "fr").count("\u202f") == 2
        assert write("`x` : `y`", "fr").count("\u202f") == 1


@pytest.mark.parametrize(
    ("points", "fr", "en"),
    [
        (0, "0 point", "0 points"),
        (0.5, "0,5 point", "0.5 points"),
        (1, "1 point", "1 point"),
        (1.5, "1,5 point", "1.5 points"),
        (2, "2 points", "2 points"),
    ],
)
def test_points_take_their_plural_as_the_language_does(points, fr, en):
    assert points_text(points, "fr") == fr
    assert points_text(points, "en") == en


@every_language
def test_a_verdict_is_said_without_the_name_of_the_mistake(lang):
    assert verdict_word("mistake:arctan_without_quadrant", lang) == verdict_word("mistake", lang)
    assert "arctan" not in verdict_word("mistake:arctan_without_quadrant", lang)


def test_margins_are_said_once_each_with_their_questions():
    assert tolerances(handout("en").questions, "en") == (
        ("questions 2, 6–10", "within 1%"),
        ("questions 3, 5", "within 0.5°"),
    )
    alike = [replace(q, tolerance="within 1%") for q in handout("en").questions]
    assert tolerances(alike, "en") == (("", "within 1%"),)


NASTY = '#let x = 1 `a` *b* _c_ $d <e> @f ~g [h] {i} = j - k + l / m // n \\ o " p -- q ... 1. r & s'


def test_any_text_prints_as_itself_in_typst():
    page = f"#set page(width: 80cm)\n{typst_text(NASTY, 'en')}\n\n{typst_text('- ' + NASTY, 'en')}"
    svg = typst.compile(page.encode(), format="svg")
    shown = f"#set page(width: 80cm)\n#{json.dumps(NASTY)}\n\n#{json.dumps('- ' + NASTY)}"
    assert svg == typst.compile(shown.encode(), format="svg")


@pytest.mark.parametrize(
    ("markdown", "text"),
    [
        (r"$\num{-1.5}\ \mathrm{rad/s^{2}}$", "−1,5\u202frad\\/s²"),
        (r"$\num{66.7}^{\circ}$", "66,7°"),
        (r"$\num{7}$", "7"),
    ],
)
def test_a_number_with_its_unit_is_text_in_a_table_and_anything_else_a_formula(markdown, text):
    assert typst_value(markdown, "fr") == text
    for other in (r"$r_2 = \num{7}$", r"$\num{7} + \num{8}$", r"$\num{7}$ fois", "oscille"):
        assert typst_value(other, "fr") == to_typst_markup(other, "fr")


def test_raw_html_is_text():
    assert "<script" not in to_html("a <script>alert(1)</script> b", "en")
    assert "&lt;script" in to_html("a <script>alert(1)</script> b", "en")
    assert "<script" not in to_notebook_markdown("a <script>alert(1)</script> b", "en")


def test_markdown_reaches_every_back_end():
    text = (
        "**Deux** mots, *un* `code` $x$(y)\n\n1. a\n2. b\n\n- c\n\n| n | v |\n|:--|--:|\n| $x$ | 2 |\n\n"
        "$$x = 1$$\n\n> note\n\n## Titre"
    )
    html = to_html(text, "fr")
    for tag in ("<strong>", "<em>", "<code>", "<ol>", "<ul>", "<table>", "<blockquote>", "<h4>", "<math"):
        assert tag in html
    written = to_typst_markup(text, "fr")
    for mark in (
        "#strong[",
        "#emph[",
        "#raw(",
        "+ a",
        "- c",
        "#data-table(",
        "#display-formula(",
        "#remark[",
    ):
        assert mark in written
    plain = to_text(text, "fr")
    for word in ("Deux mots, un code x(y)", "1. a", "2. b", "- c", "x = 1", "| note"):
        assert word in plain


@pytest.mark.parametrize("tex", [r"\num{1.5}\ \mathrm{mm}", " a ", r"\{", "-1"])
def test_a_formula_alone_is_written_as_in_a_text(tex):
    assert to_typst_markup(f"${tex}$", "fr") == to_typst_markup(f"${tex}$ et", "fr").removesuffix(" et")


def test_a_notebook_keeps_formulas_and_code_as_they_are_but_for_numbers():
    assert to_notebook_markdown(r"a $x < \num{1.5}$ `$\num{2.5}$` < b", "fr") == (
        r"a $x \lt  1{,}5$ `$\num{2.5}$` &lt; b"
    )
    table = "| n | v |\n| :-- | --: |\n| a | b |"
    assert to_notebook_markdown(table, "fr") == table


def test_an_image_in_a_text_is_refused():
    for write in (to_html, to_typst_markup, to_text):
        with pytest.raises(BadStatement, match="one figure"):
            write("![x](http://example.org/x.png)", "en")


@every_language
@every_sheet
def test_every_sheet_is_an_accessible_pdf_and_the_same_bytes_twice(make, lang):
    pdf = RENDERER.pdf(make(lang))
    assert pdf.startswith(b"%PDF")
    assert b"pdfuaid:part" in pdf
    assert b"<pdfaid:part>2<" in pdf
    assert b"<pdfaid:conformance>A<" in pdf
    assert RENDERER.pdf(make(lang)) == pdf


def pages_of(sheet) -> int:
    """Typst's SVG of a document is one file, or a list of them, one a page."""
    pages = typst.compile(RENDERER.typst(sheet).encode(), format="svg")
    return len(pages) if isinstance(pages, list) else 1


@every_language
def test_a_dozen_questions_take_two_pages_at_most(lang):
    assert pages_of(handout(lang)) <= 2


def test_each_sheet_of_a_booklet_starts_on_an_odd_page_and_counts_its_own_pages():
    from coursework.rendering.pdf import source

    sheets = [handout("fr"), handout("en"), feedback_sheet("fr")]
    pages = typst.compile(source([TEMPLATES], sheets).encode(), format="svg")
    assert all(pages_of(sheet) == 1 for sheet in sheets), "one page each, so a blank one between two"
    assert len(pages) == 5
    blank = min(map(len, pages))
    assert [len(page) == blank for page in pages] == [False, True, False, True, False]
    assert RENDERER.booklet_pdf(sheets) == RENDERER.booklet_pdf(sheets)


def test_feedback_sheets_follow_one_another_without_a_blank_page():
    from coursework.rendering.pdf import source

    pages = typst.compile(
        source([TEMPLATES], [feedback_sheet("fr"), feedback_sheet("en")]).encode(), format="svg"
    )
    assert len(pages) == 2


def test_a_long_number_stays_in_its_column_of_the_feedback():
    from coursework.rendering.pdf import source

    sheet = feedback_sheet("fr")
    number = "8832.123456789012"
    line = replace(sheet.lines[0], answer=number, read_as=number)
    text = source([TEMPLATES], [replace(sheet, lines=(line,))])
    assert text.count(f"written[{number}]") == 2
    definitions = text.partition("\n//=\n")[0]
    high = "measure(block(width: 25mm, written[{}])).height.pt()"
    asked = f"#context [#metadata(({high.format(number)}, {high.format('8832.1')})) <high>]"
    (found,) = json.loads(typst.query(f"{definitions}\n{asked}".encode(), "<high>", field="value"))
    assert found[0] > 2 * found[1] > 0


def test_words_of_a_margin_are_not_spread_over_their_narrow_column():
    text = RENDERER.typst(answer_sheet("fr"))
    margins = [line for line in text.split("\n") if line.startswith("  [*")]
    assert margins
    assert all("par(justify: false)[" in line for line in margins)


def test_threads_share_a_renderer():
    alone = [RENDERER.pdf(handout(lang)) for lang in ("fr", "en")]
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(lambda lang: RENDERER.pdf(handout(lang)), ["fr", "en"] * 3))
    assert together == alone * 3


@every_language
def test_a_name_with_marks_of_typst_or_html_prints_as_itself(lang):
    sheet = handout(lang, student="#panic() $x$ <b>O'Neil</b>")
    assert RENDERER.pdf(sheet).startswith(b"%PDF")
    assert r"\#panic() \$x\$ \<b\>O’Neil\<\/b\>" in RENDERER.typst(sheet)
    assert "#panic() $x$ &lt;b&gt;O’Neil&lt;/b&gt;" in RENDERER.html(sheet)


@every_language
def test_what_follows_a_formula_in_a_text_is_text(lang):
    sheet = replace(handout(lang), statement="$x$(y) $x$.width *a*(b) `c`[d] **e**.f $\\num{1}$[g]")
    assert RENDERER.pdf(sheet).startswith(b"%PDF")


@every_language
def test_a_long_exercise_and_a_formula_wider_than_the_page_still_compile(lang):
    sheet = answer_sheet(lang)
    wide = " + ".join([r"\frac{r_1\cos\theta_1}{r_2}"] * 14)
    questions = tuple(replace(q, number=k + 1) for k, q in enumerate(sheet.handout.questions * 3))
    long = replace(sheet, steps=(replace(sheet.steps[0], formula=wide, substitution=wide),) * 3)
    assert RENDERER.pdf(long).startswith(b"%PDF")
    assert pages_of(replace(sheet.handout, questions=questions)) in (2, 3)


@every_language
def test_an_answer_box_has_its_unit_or_the_words_that_ask_for_one(lang):
    sheet = handout(lang)
    (question,) = [q for q in sheet.questions if q.id == "rA_dot"]
    asks = replace(sheet, questions=(replace(question, unit="", asks_unit=True),))
    said = {"fr": "avec son unité", "en": "with its unit"}[lang]
    for shown in (RENDERER.typst, RENDERER.html, RENDERER.notebook, RENDERER.terminal):
        # A notebook's help has these words too.
        assert shown(asks).count(said) > shown(sheet).count(said)
        assert "mm/s" in shown(replace(sheet, questions=(question,), given=())).replace("\\/", "/")
    (box,) = re.findall(
        r'<div class="box">.*?</div>', RENDERER.html(replace(sheet, questions=(question,))), re.DOTALL
    )
    assert "<span>mm/s</span>" in box
    assert RENDERER.pdf(asks).startswith(b"%PDF")


@every_language
def test_the_words_of_a_solutions_own_figure_stand_in_place_of_the_sheets(lang):
    own = replace(answer_sheet(lang), figure=handout(lang).figure, figure_alt="Deux cercles")
    for shown in (RENDERER.typst(own), RENDERER.html(own)):
        assert "Deux cercles" in shown
        assert handout(lang).figure_alt not in shown
    assert handout(lang).figure_alt in RENDERER.html(answer_sheet(lang))


@every_language
def test_a_handout_holds_no_answer(lang):
    sheet = handout(lang)
    shown = [RENDERER.typst(sheet), RENDERER.html(sheet), RENDERER.notebook(sheet), RENDERER.terminal(sheet)]
    for text in shown:
        assert not any(digits in re.sub(r"base64,[\w+/=]+", "", text) for digits in ANSWER_DIGITS)
    assert any(digits in RENDERER.html(answer_sheet(lang)) for digits in ANSWER_DIGITS)


@every_language
def test_feedback_holds_no_reference_value(lang):
    sheet = feedback_sheet(lang)
    for text in (RENDERER.typst(sheet), RENDERER.html(sheet)):
        assert not any(digits in re.sub(r"base64,[\w+/=]+", "", text) for digits in ANSWER_DIGITS)


@every_language
def test_every_given_value_is_on_the_sheet_as_the_language_writes_it(lang):
    values = ["228,6", "114,3", "−12,5"] if lang == "fr" else ["228.6", "114.3", "−12.5"]
    page = re.sub(r"<[^>]*>", "", RENDERER.html(handout(lang)))
    source = RENDERER.typst(handout(lang)).replace('−"', '"−')
    for value in values:
        assert value in page
        assert f'"{value}"' in source
        assert value in RENDERER.terminal(handout(lang))


@every_language
@every_sheet
def test_a_page_fetches_nothing_and_runs_nothing(make, lang):
    page = RENDERER.html(make(lang))
    assert "<script" not in page
    assert "http" not in page
    assert re.findall(r"\bon\w+=", page) == []
    for target in re.findall(r"(?:src|href)=\"([^\"]*)\"|url\(\"?([^\")]*)", page):
        assert "".join(target).startswith("data:")
    assert f'<html lang="{lang}">' in page
    assert page.count("<h1>") == 1


@every_language
def test_a_page_has_a_labelled_box_for_every_answer_and_words_for_its_figure(lang):
    sheet = handout(lang)
    page = RENDERER.html(sheet)
    for question in sheet.questions:
        if question.choices:
            assert page.count(f'type="radio" name="{question.id}"') == len(question.choices)
        else:
            assert f'<label for="answer-{question.id}">' in page
            assert f'id="answer-{question.id}"' in page
    assert f'alt="{sheet.figure_alt}"' in page


def cells(book: dict, kind: str) -> list[str]:
    return ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == kind]


@every_language
def test_a_notebook_is_valid_and_the_same_twice(lang):
    text = RENDERER.notebook(handout(lang))
    nbformat.validate(nbformat.reads(text, as_version=4))
    assert text == RENDERER.notebook(handout(lang))
    ids = [cell["id"] for cell in json.loads(text)["cells"]]
    assert len(set(ids)) == len(ids)


@every_language
def test_one_cell_of_a_notebook_holds_the_answers_as_a_literal(lang):
    sheet = handout(lang)
    book = json.loads(RENDERER.notebook(sheet))
    (tagged,) = [cell for cell in book["cells"] if "answers" in cell["metadata"].get("tags", ())]
    (statement,) = ast.parse("".join(tagged["source"])).body
    assert isinstance(statement, ast.Assign)
    nobodys = {} if sheet.student else {"student": ""}
    assert ast.literal_eval(statement.value) == nobodys | {question.id: "" for question in sheet.questions}


@every_language
def test_a_notebook_names_each_choice_as_it_is_to_be_written_and_says_cases_as_words(lang):
    sheet = handout(lang)
    question = replace(sheet.questions[0], kind="choice", choices=(("one", "$w = 1$"), ("two", "l'autre")))
    case = Given("mode", r"\text{mode}", "l'autre", "", is_number=False)
    book = nbformat.reads(RENDERER.notebook(replace(sheet, questions=(question,), given=(case,))), 4)
    words_of = "\n".join(cells(book, "markdown"))
    assert "- `one`" in words_of
    assert "- `two`" in words_of
    assert "| l’autre |" in words_of
    assert "one, two" in "\n".join(cells(book, "code"))


@every_language
def test_a_notebook_sets_the_given_values_as_python_numbers(lang):
    book = json.loads(RENDERER.notebook(handout(lang)))
    names: dict[str, object] = {}
    for statement in ast.parse(cells(book, "code")[0]).body:
        names[statement.targets[0].id] = ast.literal_eval(statement.value)
    assert names == {"r1": 228.6, "theta1": 90, "r2": 114.3, "theta2": 135, "omega2": -12.5, "alpha2": 0}


def test_a_given_named_as_a_word_of_python_still_makes_a_variable():
    sheet = replace(handout("en"), given=(Given("lambda", r"\lambda", "1.2e-3", ""),))
    book = json.loads(RENDERER.notebook(sheet))
    assert "lambda_ = 1.2e-3" in cells(book, "code")[0]


@every_language
def test_a_notebook_to_hand_in_runs_nothing_and_checks_nothing(lang):
    book = json.loads(RENDERER.notebook(handout(lang)))
    code = [ast.parse(source) for source in cells(book, "code")]
    # Literals with names, and nothing that could be called.
    assert all(isinstance(line, ast.Assign) for cell in code for line in cell.body)
    assert not any(isinstance(node, (ast.Call, ast.Import)) for cell in code for node in ast.walk(cell))


@every_language
def test_a_notebook_knows_whose_and_which_variant_it_is(lang):
    sheet = handout(lang, student="Zoé")
    book = json.loads(RENDERER.notebook(sheet))
    assert book["metadata"]["coursework"] == {
        "exercise": "slotted_mechanism",
        "version": 1,
        "seed": 42,
        "student": "Zoé",
        "lang": lang,
        "record": sheet.record,
    }


def test_a_notebook_carries_its_figure():
    book = json.loads(RENDERER.notebook(handout("en")))
    (shown,) = [cell for cell in book["cells"] if "attachments" in cell]
    assert shown["attachments"]["figure.png"]["image/png"].startswith("iVBORw0KGgo")
    assert handout("en").figure_alt in "".join(shown["source"])


def test_a_course_replaces_one_template_and_takes_the_others(tmp_path):
    (tmp_path / "_figure_and_data.html.j2").write_text("<p>{{ sheet.title }} & co</p>", "utf-8")
    page = Renderer([tmp_path, TEMPLATES]).html(handout("en"))
    assert "<p>Slotted mechanism & co</p>" in page
    assert "<img" not in page


def test_a_name_that_a_template_does_not_have_is_an_error(tmp_path):
    (tmp_path / "_figure_and_data.html.j2").write_text("{{ nonsense }}", "utf-8")
    with pytest.raises(BadStatement, match="nonsense"):
        Renderer([tmp_path, TEMPLATES]).html(handout("en"))


def test_a_course_template_may_use_macros(tmp_path):
    (tmp_path / "_figure_and_data.html.j2").write_text(
        "{% macro shown(name) %}<b>{{ name }}</b>{% endmacro %}{{ shown('a < b') }}", "utf-8"
    )
    assert "<b>a &lt; b</b>" in Renderer([tmp_path, TEMPLATES]).html(handout("en"))


def test_a_template_that_typst_refuses_is_an_error_of_the_course(tmp_path):
    (tmp_path / "_figure_and_data.typ.j2").write_text("#nonsense", "utf-8")
    with pytest.raises(BadStatement, match="nonsense"):
        Renderer([tmp_path, TEMPLATES]).pdf(handout("en"))


def test_a_missing_template_is_named(tmp_path):
    shutil.copy(TEMPLATES / "sheet.html.j2", tmp_path)
    with pytest.raises(BadCourse, match="_page"):
        Renderer([tmp_path]).html(handout("en"))


def test_a_solutions_text_says_what_its_own_figure_shows(course, monkeypatch):
    variant = course["four_bar_positions"].variant(0, "en")
    text = variant.solution_text
    said = replace(text, sections={**text.sections, "figure": Section("Two circles\nthat meet.")})
    monkeypatch.setitem(variant.__dict__, "solution_text", said)
    sheet = variant.answer_sheet()
    assert sheet.figure is not None
    assert sheet.figure_alt == "Two circles that meet."
    assert "Two circles that meet." in renderer_of(course.folder).html(sheet)
