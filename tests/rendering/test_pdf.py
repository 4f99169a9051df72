"""Sheets as PDF: accessible, on few pages, the same bytes twice."""

from __future__ import annotations

import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest
import typst
from pdf_text import page_texts
from rendering_samples import answer_sheet, feedback_sheet, handout, many_given

from coursework import open_course
from coursework.course.builtin import builtin_root
from coursework.course.texts import TextSection
from coursework.rendering import pdf
from coursework.rendering.renderer import Renderer, renderer_of

TEMPLATES = builtin_root() / "templates"
RENDERER = Renderer([TEMPLATES])
SHEETS = {"handout": handout, "many given": many_given, "answers": answer_sheet, "feedback": feedback_sheet}
every_language = pytest.mark.parametrize("lang", ["fr", "en"])
every_sheet = pytest.mark.parametrize("make", SHEETS.values(), ids=SHEETS)


@every_language
@every_sheet
def test_every_sheet_is_an_accessible_pdf_and_the_same_bytes_twice(make, lang):
    pdf = RENDERER.pdf(make(lang))
    assert pdf.startswith(b"%PDF")
    assert b"pdfuaid:part" in pdf
    assert b"<pdfaid:part>2<" in pdf
    assert b"<pdfaid:conformance>A<" in pdf
    assert RENDERER.pdf(make(lang)) == pdf


@every_language
def test_the_paper_to_draw_on_stands_between_no_brackets(lang):
    """What the typesetter reads as content is not printed as it is written."""
    sheet = open_course()["velocity_polygon"].variant(0, lang).handout("Zoé Martin")
    printed = "".join(page_texts(RENDERER.pdf(sheet)))
    assert "160" in printed
    assert not {"[", "]"} & {*printed}


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
    assert RENDERER.pdf(*sheets) == RENDERER.pdf(*sheets)


def test_feedback_sheets_follow_one_another_without_a_blank_page():
    from coursework.rendering.pdf import source

    pages = typst.compile(
        source([TEMPLATES], [feedback_sheet("fr"), feedback_sheet("en")]).encode(), format="svg"
    )
    assert len(pages) == 2


def test_words_of_a_margin_are_not_spread_over_their_narrow_column():
    text = RENDERER.typst(answer_sheet("fr"))
    margins = [line for line in text.split("\n") if line.startswith("  [*")]
    assert margins
    assert all("par(justify: false)[" in line for line in margins)


def test_an_empty_piece_of_a_sheet_leaves_the_next_its_own():
    """A theory question has neither figure nor data."""
    cut = pdf.files("#let a = 1\n//=\n#[\n//(\n//)\n#a\n//(\nwords\n//)\n]")
    assert cut["main.typ"].endswith(b'#[\n#a\n#include "1.typ"\n]')
    assert cut["1.typ"].endswith(b"\nwords")


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


def test_a_solutions_text_says_what_its_own_figure_shows(course, monkeypatch):
    variant = course["four_bar_positions"].variant(0, "en")
    text = variant.solution_text
    said = replace(text, sections={**text.sections, "figure": TextSection("Two circles\nthat meet.")})
    monkeypatch.setitem(variant.__dict__, "solution_text", said)
    sheet = variant.answer_sheet()
    assert sheet.figure is not None
    assert sheet.figure_alt == "Two circles that meet."
    assert "Two circles that meet." in renderer_of(course.folder).html(sheet)
