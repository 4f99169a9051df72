"""Sheets as one self-contained HTML page: nothing fetched; in a handout a script that keeps its answers and
one to draw with, none elsewhere."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from html import escape
from pathlib import Path
from urllib.parse import quote

from jinja2 import Environment
from markupsafe import Markup

from coursework.errors import BadCourse
from coursework.figures.dark import dark_rules, darkened
from coursework.figures.polygons.construction import Construction
from coursework.language.words import words
from coursework.markup import markdown as markup
from coursework.markup.mathml import to_mathml
from coursework.rendering import feedback, views
from coursework.rendering.environment import environment, render
from coursework.rendering.keeping import keeping
from coursework.rendering.surface import kinds_of_surfaces, scripts_of, surface
from coursework.sheets.sheet import FeedbackSheet

#: Lines of a script that are comments, and the indentation of others, which browsers need not fetch.
NOT_FETCHED = r"^[ \t]*(?://.*\n)?"


def page(folders: Sequence[Path], sheet: views.Sheet, paper: str = "a4") -> str:
    """Return the whole page."""
    handout = views.handout_of(sheet)
    env = environment_of(tuple(folders), handout.lang)
    names = (
        feedback.context(sheet, "html.j2", partial(render, env))
        if isinstance(sheet, FeedbackSheet)
        else views.context(sheet)
    )
    if sheet is handout:
        names |= {
            "keeping": keeping([handout], handout.student, handout.lang),
            "draws": kinds_of_surfaces([handout]),
        }
    return render(env, views.TEMPLATES[type(sheet)] + ".html.j2", names | {"paper": paper})


@lru_cache(maxsize=32)
def environment_of(folders: tuple[Path, ...], lang: str, goes_dark: bool = True) -> Environment:
    """Return the environment of HTML templates; its drawings go dark with the page, unless a platform decides
    what that is."""
    image = partial(svg_image, goes_dark=goes_dark)
    filters: dict[str, Callable[..., str]] = {
        "markup": lambda text: markup.to_html(text, lang),
        "inline": lambda text: markup.html_inline(text, lang),
        "math": lambda tex: to_mathml(tex, lang),
        "display": lambda tex: to_mathml(tex, lang, True),
        "formula_words": lambda text: escape(markup.formula_words(text, lang)),
        "drawing": lambda figure, alt: image(figure.outlined_svg(), alt),
        "typed": escape,
        "css": _css_string,
        "said": lambda text: escape(markup.plain_line(text, lang)),
        "said_html": lambda text: markup.html_inline(text, lang),
        "svg_image": image,
    }
    env = environment(folders, lang, markup.html_text, filters)
    env.globals.update(
        script=partial(_script, env),
        digest=partial(script_digest, env),
        surface=surface,
        surface_scripts=scripts_of,
        dark_rules=Markup(dark_rules()),
    )
    return env


def _script(env: Environment, *names: str) -> Markup:
    """Return scripts among the templates, one behind another, without what browsers need not fetch."""
    if env.loader is None:
        raise BadCourse(f"no template {names[0]!r}")
    texts = "".join("\n" + env.loader.get_source(env, name)[0] for name in names)
    return Markup(re.sub(NOT_FETCHED, "", texts, flags=re.MULTILINE))


def script_digest(env: Environment, *names: str) -> str:
    """Return the digest of the one script that a page allows: a browser runs no other."""
    return "sha256-" + base64.b64encode(hashlib.sha256(_script(env, *names).encode()).digest()).decode()


def construction(folders: Sequence[Path], drawn: Construction) -> str:
    """Return a polygon as a piece of a page."""
    names = {"polygons": (drawn,), "words": words(drawn.lang), "level": 2}
    return render(environment_of(tuple(folders), drawn.lang), "parts/polygons.html.j2", names)


def svg_image(svg: str, alt: str, goes_dark: bool = True) -> str:
    """Return a drawing as an image inside the page, which goes dark with it; one of other colours is turned
    dark by the page."""
    shown = darkened(svg) if goes_dark else svg
    turned = ' class="white"' if goes_dark and shown == svg else ""
    return f'<img src="{svg_address(shown)}" alt="{escape(alt)}"{turned}>'


def svg_address(svg: str) -> str:
    """Return the address of a drawing that is in the address itself: a fifth shorter than in base64, and
    letters that can be compressed. No character in it ends an attribute."""
    return "data:image/svg+xml," + quote(svg, safe=" /=,;()'")


def _css_string(text: str) -> str:
    """Return a text in a style sheet, each of its characters by number: none ends the string, or the style
    sheet."""
    return '"' + "".join(f"\\{ord(char):06x}" for char in text) + '"'
