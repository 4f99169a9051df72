"""Sheets as one self-contained HTML page: no script, nothing fetched."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from html import escape
from pathlib import Path

from jinja2 import Environment

from coursework.figures import Beginning, Figure, Picture
from coursework.language.words import words
from coursework.markup import markdown as markup
from coursework.markup.mathml import to_mathml
from coursework.polygons.construction import Construction
from coursework.rendering import feedback, views
from coursework.rendering.environment import environment, render
from coursework.sheets.sheet import FeedbackSheet


def page(folders: Sequence[Path], sheet: views.Sheet, paper: str = "a4") -> str:
    """The whole page."""
    env = environment_of(tuple(folders), views.handout_of(sheet).lang)
    names = (
        feedback.context(sheet, "html.j2", partial(render, env))
        if isinstance(sheet, FeedbackSheet)
        else views.context(sheet)
    )
    return render(env, views.TEMPLATES[type(sheet)] + ".html.j2", names | {"paper": paper})


@lru_cache(maxsize=32)
def environment_of(folders: tuple[Path, ...], lang: str) -> Environment:
    filters: dict[str, Callable[..., str]] = {
        "markup": lambda text: markup.to_html(text, lang),
        "inline": lambda text: markup.html_inline(text, lang),
        "math": lambda tex: to_mathml(tex, lang),
        "display": lambda tex: to_mathml(tex, lang, True),
        "formula_words": lambda text: escape(markup.formula_words(text, lang)),
        "drawing": _drawing,
        "typed": escape,
        "css": _css_string,
    }
    return environment(folders, lang, markup.html_text, filters)


def construction(folders: Sequence[Path], drawn: Construction) -> str:
    """A polygon as a piece of a page."""
    names = {"polygons": (drawn,), "words": words(drawn.lang), "level": 2}
    return render(environment_of(tuple(folders), drawn.lang), "_polygons.html.j2", names)


def _drawing(figure: Figure | Picture | Beginning, alt: str) -> str:
    """The figure as an image inside the page, its letters as outlines: it looks the same everywhere."""
    data = base64.b64encode(figure.outlined_svg().encode()).decode()
    return f'<img src="data:image/svg+xml;base64,{data}" alt="{escape(alt)}">'


def _css_string(text: str) -> str:
    """A text in a style sheet, each of its characters by number: none ends the string, or the style sheet."""
    return '"' + "".join(f"\\{ord(char):06x}" for char in text) + '"'
