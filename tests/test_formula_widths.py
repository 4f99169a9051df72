"""Formulas of worked solutions that are set without being measured fit on a printed line."""

from __future__ import annotations

import json

import pytest
import typst

import coursework
from coursework.rendering import views
from coursework.rendering.formulas import to_typst

COURSE = coursework.open_course()
LINE = (210 - 2 * 20) / 25.4 * 72 - 1.2 * 10.5  #: points: A4 less margins, less what a chain is indented by


def widths(formulas, lang):
    """Their widths as printed, points."""
    measured = (
        f"#context [#metadata(measure(math.equation(math.display($ {to_typst(tex, lang)} $.body))).width.pt()) <w>]"
        for tex in formulas
    )
    source = '#set text(font: "Libertinus Serif", size: 10.5pt)\n' + "\n".join(measured)
    compiler = typst.Compiler(input=source.encode(), ignore_system_fonts=True)
    return json.loads(compiler.query("<w>", field="value"))


@pytest.mark.parametrize("lang", ["fr", "en"])
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
