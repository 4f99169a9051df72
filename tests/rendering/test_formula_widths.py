"""What worked solutions set without measuring it fits: formulas on a printed line, cells in their rows."""

from __future__ import annotations

import json

import pytest
import typst
from sweeps import at_once, sampled, whole_course
from tables import each_row

import coursework
from coursework.markup.markdown import to_typst_markup
from coursework.markup.typst import to_typst
from coursework.rendering import views

COURSE = coursework.open_course()
LINE = (210 - 2 * 20) / 25.4 * 72 - 1.2 * 10.5  #: points: A4 less margins, less what a chain is indented by


MM = 72 / 25.4  #: points


def sizes(pieces):
    """Width and height of pieces of Typst as printed, points."""
    measured = (
        f"#context {{ let of = measure({piece}); [#metadata((of.width.pt(), of.height.pt())) <w>] }}"
        for piece in pieces
    )
    opening = (
        '#set text(font: "Libertinus Serif", size: 10.5pt)\n#let formula(words, eq, whole: false) = eq\n'
    )
    compiler = typst.Compiler(input=(opening + "\n".join(measured)).encode(), ignore_system_fonts=True)
    return json.loads(compiler.query("<w>", field="value"))


def widths(formulas, lang):
    """Their widths as printed, points."""
    drawn = [f"math.equation(math.display($ {to_typst(tex, lang)} $.body))" for tex in formulas]
    return [width for width, _ in sizes(drawn)]


@whole_course
@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
def test_formulas_that_are_taken_to_fit_do(lang):
    sure = {}
    for name in COURSE.names:
        for variant in COURSE[name].variants(range(3), lang):
            for step in variant.answer_sheet().steps:
                if not views.chain(step):
                    continue
                if views.is_short(step, lang):
                    sure[views.chain_on_one_line(step)] = (name, step.name)
                elif views.fits_on_lines(step, lang):
                    sure[views.chain_on_lines(step)] = (name, step.name)
    assert len(sure) > 500
    too_wide = [sure[tex] for tex, width in zip(sure, widths(sure, lang), strict=True) if width > LINE]
    assert too_wide == []
    assert any(r"\begin{aligned}" in tex for tex in sure)


@whole_course
@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
def test_rows_whose_height_is_told_hold_their_cells_on_one_line(lang):
    told, count = {}, 0
    columns = [views.SUMMARY_MM[name] for name in ("quantity", "answer", "margin")]

    def note(row, height, *cells):
        for markdown, wide in cells if height != "auto" else ():
            told[f"[{to_typst_markup(markdown, lang)}]"] = (row, wide - 4.5, float(height.removesuffix("mm")))

    for name in COURSE.names:
        for variant in COURSE[name].variants(range(3), lang):
            sheet = variant.answer_sheet()
            for answer in sheet.answers:
                asked = answer.question
                named = f"${asked.symbol}$" if asked.symbol else views.quantity_words(asked, lang)
                margin = views.margin_words(answer, lang)
                height = views.summary_row(answer, lang)
                note((name, asked.id), height, *zip((named, answer.text, margin), columns, strict=True))
                count += 1
            for row in (row for polygon in sheet.polygons for row in polygon.rows):
                cells = ((getattr(row, name), wide) for name, wide in views.POLYGON_MM.items())
                cells = [(f"${tex}$", wide) for tex, wide in list(cells)[:4] if tex]
                note((name, row.name), views.polygon_row(row, lang), *cells)
                count += 1
    assert count > 1500
    assert len(told) > 0.5 * count
    # Of the ink, which reaches beyond the edges that lines are set by.
    drawn = [f'text(top-edge: "bounds", bottom-edge: "bounds"){cell}' for cell in told]
    faults = [
        row
        for (row, room, tall), (width, height) in zip(told.values(), sizes(drawn), strict=True)
        if width > room * MM or height > (tall - 1.2) * MM
    ]
    assert faults == []


@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
@at_once(COURSE.names, COURSE.names[::4])
@pytest.mark.e2e
def test_data_stand_beside_the_widest_figure(lang, names):
    """A line of data that is not to be broken leaves the figure its room."""
    lines = {}
    for name in names:
        for variant in COURSE[name].variants(range(3), lang):
            sheet = variant.handout()
            context = views.context(sheet)
            if not context["beside"]:
                continue
            for given in sheet.given:
                told = (
                    f"${views.given_formula(given)}$" if given.is_number else views.given_words(given, lang)
                )
                if given.is_number or context["data_width"] == "auto":
                    lines[f"[{to_typst_markup(told, lang)}]"] = (name, given.symbol)
    assert len(lines) > 100 * len(names) / len(COURSE.names)
    room = (views.ROOM_DATA - 0.9 * 3.7) * MM
    assert [line for line, (wide, _) in zip(lines.values(), sizes(lines), strict=True) if wide > room] == []


@each_row(
    "tall",
    [
        r"$\dfrac{a}{b}$",
        r"$\tfrac{a}{b}$",
        r"$\frac{a}{b}$",
        r"$\sqrt{a}$",
        r"$\prod_i a_i$",
        "$$x$$",
        "a\n\nb",
        "- a\n- b",
        "a\\\nb",
        "# a",
        "- a",
        "1. a",
        "> a",
        r"$\begin{matrix} a \\ b \end{matrix}$",
    ],
)
def test_a_cell_that_may_be_taller_than_a_line_makes_its_row_as_high_as_it_needs(tall):
    assert views._row("en", ("$r_A$", 24), ("12 mm", 84)) != "auto"
    assert views._row("en", ("$r_A$", 24), (tall, 84)) == "auto"
