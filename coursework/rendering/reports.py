"""Reports as web pages and PDF, in the dress of the sheets."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from markupsafe import Markup

from coursework.language.words import words
from coursework.markup import markdown as markup
from coursework.rendering import html, pdf
from coursework.rendering.environment import render
from coursework.sheets.report import Chart, ReportContent


def page(folders: Sequence[Path], report: ReportContent, paper: str = "a4") -> str:
    """Return a web page that fetches nothing and runs no script."""
    env = html.environment_of(tuple(folders), report.lang)
    return render(env, "report/report.html.j2", _names(report) | {"chart": _image, "paper": paper})


def source(folders: Sequence[Path], report: ReportContent, paper: str = "a4") -> str:
    """Return the Typst source; it stands alone."""
    env = pdf.environment_of(tuple(folders), report.lang)
    body = Markup(render(env, "report/report.typ.j2", _names(report) | {"chart": _drawn}))
    return render(env, "parts/page.typ.j2", _names(report) | {"bodies": [body], "paper": paper})


def _names(report: ReportContent) -> dict[str, object]:
    return {
        "sheet": report,
        "report": report,
        "lang": report.lang,
        "title": report.title,
        "variant": report.source,
        "words": words(report.lang),
    }


def _image(chart: Chart) -> Markup:
    return Markup(html.svg_image(chart.svg, chart.alt))


def _drawn(chart: Chart) -> Markup:
    svg, alt = markup.typst_string(chart.svg), markup.typst_string(chart.alt)
    return Markup(f"bytes({svg}), alt: {alt}")
