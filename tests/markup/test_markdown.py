"""Texts reach every back end, and nothing in them is obeyed."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
import typst
from rendering_samples import handout
from tables import each_row

from coursework.course.builtin import builtin_root
from coursework.errors import BadStatement
from coursework.markup.markdown import (
    to_html,
    to_notebook_markdown,
    to_text,
    to_typst_markup,
    typst_text,
    typst_value,
)
from coursework.rendering.renderer import Renderer

TEMPLATES = builtin_root() / "templates"
RENDERER = Renderer([TEMPLATES])
every_language = pytest.mark.parametrize("lang", ["fr", "en"])
NASTY = '#let x = 1 `a` *b* _c_ $d <e> @f ~g [h] {i} = j - k + l / m // n \\ o " p -- q ... 1. r & s'


def test_any_text_prints_as_itself_in_typst():
    page = f"#set page(width: 80cm)\n{typst_text(NASTY, 'en')}\n\n{typst_text('- ' + NASTY, 'en')}"
    svg = typst.compile(page.encode(), format="svg")
    shown = f"#set page(width: 80cm)\n#{json.dumps(NASTY)}\n\n#{json.dumps('- ' + NASTY)}"
    assert svg == typst.compile(shown.encode(), format="svg")


@each_row(
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


def test_a_list_that_another_text_interrupts_goes_on_with_its_number():
    text = "2. b\n3. c"
    assert '<ol start="2">' in to_html(text, "en")
    # The list begins a line of its own: Typst nests items by their column.
    assert to_typst_markup(text, "en").split("\n") == ["", "2. b", "+ c"]
    assert to_text(text, "en") == "2. b\n3. c"


@each_row("tex", [r"\num{1.5}\ \mathrm{mm}", " a ", r"\{", "-1"])
def test_a_formula_alone_is_written_as_in_a_text(tex):
    assert to_typst_markup(f"${tex}$", "fr") == to_typst_markup(f"${tex}$ et", "fr").removesuffix(" et")


@each_row(
    ("formula", "kept"),
    [("r = 140", True), (r"\num{0.4}", True), ("r_2", False), ("x^2", False), ("r", False)],
)
def test_a_unit_keeps_to_the_number_that_a_formula_ends_with(formula, kept):
    written = to_typst_markup(f"With ${formula}$ mm of play", "en")
    assert written.endswith(f"{chr(0xA0) if kept else ' '}mm of play")


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
def test_what_follows_a_formula_in_a_text_is_text(lang):
    sheet = replace(handout(lang), statement="$x$(y) $x$.width *a*(b) `c`[d] **e**.f $\\num{1}$[g]")
    assert RENDERER.pdf(sheet).startswith(b"%PDF")


@each_row("after", ["$$x = 1$$", "| a |\n|---|\n| 1 |"])
def test_a_paragraph_keeps_to_the_formula_or_table_behind_it(after):
    assert to_typst_markup(f"so that\n\n{after}", "en").startswith("#lead[so that]")
    assert "#lead[" not in to_typst_markup(f"{after}\n\nso that\n\nand", "en")
