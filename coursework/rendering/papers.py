"""Papers: several exercises under one heading, through the bodies of their sheets."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from html import escape
from pathlib import Path
from typing import Any, TypeAlias

from jinja2 import Environment
from markupsafe import Markup

from coursework.errors import BadCourse, BadInput
from coursework.figures.picture import Picture
from coursework.language.numbers import localise
from coursework.language.words import words
from coursework.rendering import answer_pages, feedback, html, latex, pdf, views
from coursework.rendering.environment import render
from coursework.rendering.keeping import keeping
from coursework.rendering.surface import kinds_of_surfaces
from coursework.sheets.paper import FeedbackPaper, Logo, Paper, SolutionPaper
from coursework.sheets.sheet import AnswerSheet, FeedbackSheet, Handout

AnyPaper: TypeAlias = Paper | SolutionPaper | FeedbackPaper

#: The template of each type of paper, and that of an exercise in it.
TEMPLATES = {Paper: "paper/paper", SolutionPaper: "paper/solution", FeedbackPaper: "paper/feedback"}
BODIES = {Paper: "sheet/_body", SolutionPaper: "sheet/_solution_body", FeedbackPaper: "feedback/_body"}
_KINDS = {Paper: "sheet", SolutionPaper: "solution", FeedbackPaper: "feedback"}
_START_MM = 55  #: that an exercise to fill in needs to begin: what does not fit below stands on the next page
_LINE = 75  #: characters of a footer that leave room for a student's name

#: Height of an exercise's heading with its first question, of a line of text, and letters in one, roughly.
_HEAD_MM, _LINE_MM, _LETTERS = 40, 5.5, 95

Names: TypeAlias = Mapping[str, object]
Body: TypeAlias = Callable[[str, Names], str]  #: renders a template with these names


def sheets_of(paper: AnyPaper) -> tuple[views.Sheet, ...]:
    """Return the sheets of its exercises, in order; right answers that are kept back are not in them."""
    if isinstance(paper, Paper):
        return paper.handouts
    if isinstance(paper, FeedbackPaper) and not paper.answers:
        return tuple(
            replace(sheet, lines=tuple(replace(line, right="") for line in sheet.lines))
            for sheet in paper.sheets
        )
    return paper.sheets


def places_of(paper: AnyPaper) -> Sequence[int]:
    """Return the numbers of its exercises, in order."""
    stated = paper.places if isinstance(paper, FeedbackPaper) else ()
    return stated or range(1, len(sheets_of(paper)) + 1)


def points_of(paper: AnyPaper) -> float:
    """Return the total points of a paper."""
    if isinstance(paper, FeedbackPaper):
        return paper.out_of
    return sum(views.handout_of(sheet).points for sheet in sheets_of(paper))


def context(paper: AnyPaper, end: str, write: Body, files: Sequence[Names] = ()) -> dict[str, Any]:
    """Return the names that a paper's template sees.

    ``end`` is that of the templates' names, ``typ.j2``; ``files`` are names that each exercise's template
    sees besides.
    """
    heading, kind = paper.heading, _KINDS[type(paper)]
    exercises = exercises_of(paper, end, write, files)
    return {
        "heading": heading,
        "kind": kind,
        "lang": heading.lang,
        "words": words(heading.lang),
        "title": title(paper),
        "when": " · ".join(filter(None, (heading.date, heading.duration))),
        "logo": heading.logo and logo_svg(heading.logo),
        "variants": variants(paper),
        "foot": " · ".join(filter(None, (heading.student, variants(paper)))),
        "exercises": exercises,
        "points": points_of(paper),
        "mark_of": _number(heading.mark_of, heading.lang),
        "mark": _number(getattr(paper, "mark", ""), heading.lang),
        "summary_mm": views.SUMMARY_MM,
        "guide_together": views.GUIDE_TOGETHER,
        **(_of_feedback(paper) if isinstance(paper, FeedbackPaper) else {}),
    }


def _of_feedback(paper: FeedbackPaper) -> dict[str, Any]:
    """Return the further variables for the template of feedback: the summary of all its sheets."""
    met = {sign for sheet in paper.sheets for sign, _ in feedback.tally(sheet)}
    practices = [sheet.practice for sheet in paper.sheets if sheet.practice]
    return {
        "feedback": paper,
        "answer_mm": feedback.ANSWER_MM,
        "legend": feedback.legend(paper.sheets, paper.heading.lang),
        "tallied": [sign for sign in feedback.SIGNS if sign in met],
        "has_next": any(sign.seed is not None or sign.lessons for sign in practices),
    }


def exercises_of(paper: AnyPaper, end: str, write: Body, files: Sequence[Names] = ()) -> list[dict[str, Any]]:
    """Return the variables of each exercise's sheet and its body; of a solution its rows of the marking guide
    too."""
    exercises = []
    for position, (number, sheet) in enumerate(zip(places_of(paper), sheets_of(paper), strict=True)):
        names: dict[str, Any]
        if isinstance(sheet, FeedbackSheet):
            names = feedback.context(sheet, end, write, number, numbered=_numbered(paper))
        else:
            names = views.context(sheet, number)
        names |= dict(files[position] if files else {})
        handout = views.handout_of(sheet)
        names["called"] = _heading_of(paper, number, handout.title)
        names["whose"] = f"{words(paper.heading.lang)['paper']['exercise']} {number}"
        names["start_mm"] = _start_mm(sheet)
        names["work_mm"] = paper.work_mm[position] if isinstance(paper, Paper) and paper.work_mm else 0
        names["body"] = Markup(write(f"{BODIES[type(paper)]}.{end}", names))
        if isinstance(paper, SolutionPaper):
            names["guide"] = Markup(write(f"parts/guide_rows.{end}", names))
        exercises.append(names)
    return exercises


def _numbered(paper: AnyPaper) -> bool:
    return not isinstance(paper, FeedbackPaper) or paper.numbered


def _heading_of(paper: AnyPaper, number: int, title: str) -> str:
    """Return the heading of an exercise of a paper; its title alone where no paper was handed out."""
    return words(paper.heading.lang)["paper"]["numbered"].format(number, title) if _numbered(paper) else title


def _start_mm(sheet: views.Sheet) -> int:
    """Return the room that an exercise takes up to its first question: it begins where a page has so much
    left."""
    if isinstance(sheet, FeedbackSheet):
        return 45
    handout, figure = views.handout_of(sheet), views.figure_of(sheet)
    text = sheet.introduction if isinstance(sheet, AnswerSheet) else handout.statement
    drawn = figure.size_mm[1] if figure else 0.0
    room = _HEAD_MM + _LINE_MM * len(text) / _LETTERS + drawn
    return round(min(room, _START_MM) if isinstance(sheet, Handout) else room)


def title(paper: AnyPaper) -> str:
    """Return the document's title: the paper's, and what it is when it is not the student's to fill in."""
    heading, kind = paper.heading, _KINDS[type(paper)]
    return heading.title if kind == "sheet" else f"{heading.title} – {words(heading.lang)[kind]['title']}"


def variants(paper: AnyPaper) -> str:
    """Return the variants of a paper in a line: names and seeds, or seeds alone in the order of its
    exercises."""
    handouts = [views.handout_of(sheet) for sheet in sheets_of(paper)]
    named = " · ".join(f"{handout.exercise} {handout.seed}" for handout in handouts)
    return named if len(named) <= _LINE else " · ".join(str(handout.seed) for handout in handouts)


def _number(text: str, lang: str) -> str:
    """Return a plain number as the language prints it; anything else as it is."""
    return localise(text, lang) if re.fullmatch(r"-?\d+(\.\d+)?", text) else text


_PNG = b"\x89PNG\r\n\x1a\n"


def logo_svg(logo: Logo) -> str:
    """Return a logo as SVG: its own, or one that holds the pixels.

    Raises
    ------
    BadInput
        It is not of the format that it is said to be, or it runs or fetches something.
    """
    if logo.format == "svg":
        return _harmless(_text(logo.data))
    if logo.data[:8] != _PNG or len(logo.data) < 24:
        raise BadInput("the logo is not a PNG picture; give a PNG or an SVG file")
    wide, high = (int.from_bytes(logo.data[start : start + 4], "big") for start in (16, 20))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" width="{wide}" height="{high}">'
        f'<image width="{wide}" height="{high}" '
        f'href="data:image/png;base64,{base64.b64encode(logo.data).decode()}"/></svg>'
    )


@lru_cache(maxsize=8)
def _harmless(svg: str) -> str:
    """Return the same picture, as an exercise may bring it."""
    try:
        Picture(svg.encode()).size_mm  # noqa: B018  what cannot be shown is refused here
    except BadCourse as fault:
        raise BadInput("the logo: {fault}", fault=fault) from fault
    return svg


def _text(data: bytes) -> str:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = ""
    if "<svg" not in text:
        raise BadInput("the logo is not an SVG picture; give an SVG or a PNG file")
    return text


def page(folders: Sequence[Path], paper: AnyPaper, size: str = "a4") -> str:
    """Return a paper as one web page that fetches nothing; that of a student to fill in runs a script that
    keeps answers, and one to draw with where there is something to draw."""
    env = html.environment_of(tuple(folders), paper.heading.lang)
    return render(env, f"{TEMPLATES[type(paper)]}.html.j2", page_names(env, paper) | {"paper": size})


def page_names(env: Environment, paper: AnyPaper) -> dict[str, Any]:
    """Return the names for the template of a paper's page."""
    if not isinstance(paper, Paper):
        return context(paper, "html.j2", partial(render, env)) | {"image": image}
    heading = paper.heading
    kept = keeping(paper.handouts, heading.student, heading.lang, numbered=True)
    return drawing_context(paper, env) | {"keeping": kept, "image": image}


def drawing_context(paper: Paper, env: Environment) -> dict[str, Any]:
    """Return the names for the template of a page with drawing surfaces, whose script the page brings."""
    draws = kinds_of_surfaces(paper.handouts)

    def write(template: str, names: Names) -> str:
        return render(env, template, {**names, "draws": draws})

    return context(paper, "html.j2", write) | {"draws": draws}


def image(logo: Logo) -> Markup:
    return Markup(f'<img class="logo" src="{html.svg_address(logo_svg(logo))}" alt="{escape(logo.alt)}">')


def tex(
    folders: Sequence[Path],
    paper: Paper | SolutionPaper,
    size: str,
    figures: Sequence[str],
    polygons: Sequence[str],
) -> str:
    """Return the LaTeX source of a paper; beside it are the PDF of each exercise's figure and that of its
    polygons."""
    env, lang = latex.environment_of(tuple(folders), paper.heading.lang), paper.heading.lang
    files = [
        {"figure_file": drawing, "polygons_file": two} for drawing, two in zip(figures, polygons, strict=True)
    ]
    names = context(paper, "tex.j2", partial(render, env), files) | {
        "paper": size,
        "figure_file": ", ".join(figures),
        "babel": latex.BABEL.get(lang, lang),
    }
    return latex.without_gaps(render(env, f"{TEMPLATES[type(paper)]}.tex.j2", names))


def typst_source(folders: Sequence[Path], papers: Sequence[AnyPaper], size: str = "a4") -> str:
    """Return the Typst source of one document that holds these papers, each from an odd page on."""
    contexts = []
    for paper in papers:
        env = pdf.environment_of(tuple(folders), paper.heading.lang)
        names = context(paper, "typ.j2", partial(render, env))
        if isinstance(paper, Paper):
            head = paper.heading
            names |= answer_pages.names(
                paper.handouts, head.title, head.student, head.lang, partial(render, env)
            )
        body = Markup(render(env, f"{TEMPLATES[type(paper)]}.typ.j2", names))
        contexts.append(names | {"document": body})
    first = contexts[0]
    page = first | {
        "bodies": [names["document"] for names in contexts],
        "paper": size,
        "printed": not isinstance(papers[0], FeedbackPaper),
    }
    return render(pdf.environment_of(tuple(folders), papers[0].heading.lang), "parts/page.typ.j2", page)
