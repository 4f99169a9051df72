"""Pieces of pages for platforms: HTML that needs no style, script or network; formulas as MathML, figures as
SVG."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Sequence
from functools import lru_cache
from itertools import chain
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote_to_bytes

from jinja2 import Environment

from coursework.language.words import words
from coursework.markup.markdown import plain_line
from coursework.platforms.items import Item
from coursework.platforms.posed import COLLECTED, Option, Posed
from coursework.rendering import views
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of
from coursework.sheets.sheet import Question

_INLINE = re.compile(r'src="data:image/(svg\+xml|png|jpeg)(;base64)?,([^"]+)"')
_ENDINGS = {"svg+xml": "svg", "png": "png", "jpeg": "jpg"}


_BLANK = "\N{MATHEMATICAL MONOSPACE DIGIT ZERO}"  #: a digit to every rule of typography, and in no text
_DIGIT = re.compile("[0-9]")
#: What gives a digit outside a formula a meaning to Markdown: code, an entity, a link, a mark, a list.
_MEANING = re.compile(rf"[`&\[<\\{_BLANK}]|^\s*[0-9]", re.MULTILINE)


def blanked(line: str) -> tuple[str, str]:
    """Return a line of Markdown with blanks for its digits outside formulas, and these digits.

    Variants differ by digits: lines that are the same with blanks are rendered once, and :func:`filled`.
    """
    pieces = line.split("$")
    if "$$" in line or len(pieces) % 2 == 0 or any(map(_MEANING.search, pieces[::2])):
        return line, ""
    digits = "".join(_DIGIT.findall("".join(pieces[::2])))
    pieces[::2] = [_DIGIT.sub(_BLANK, piece) for piece in pieces[::2]]
    return "$".join(pieces), digits


def filled(text: str, digits: str) -> str:
    """Return a text with its blanks replaced by digits, in order."""
    if not digits:
        return text
    first, *rest = text.split(_BLANK)
    return first + "".join(chain.from_iterable(zip(digits, rest, strict=True)))


@lru_cache(maxsize=4096)
def _inline(env: Environment, line: str) -> str:
    return render(env, "platform/_line.html.j2", {"line": line})


class Image(NamedTuple):
    """Picture of a piece."""

    name: str  #: of the file; it depends on its content
    data: bytes


class PagePieces:
    """Renderer of the pieces of a language, with the templates of these folders."""

    def __init__(self, folders: Sequence[Path], lang: str):
        self.folders, self.lang = tuple(folders), lang
        self._env = environment_of(self.folders, lang, goes_dark=False)

    def opening(self, item: Item, *, named: bool = True) -> str:
        """Return the part of an item before its questions: statement, figure, data, margins, and, if
        ``named``, its label."""
        names = views.context(item.handout)
        names |= {"label": item.label if named else "", "level": 4}
        return render(self._env, "platform/_opening.html.j2", names)

    def prompt(self, posed: Posed, *, box: str = "", numbered: bool = True) -> str:
        """Return a question with its ``box`` (HTML), the symbol before it and the unit after it. A collected
        question explains the form of its answer and lists the options of a choice."""
        names = {"question": posed.question, "box": box, "numbered": numbered, "words": words(self.lang)}
        names["listed"] = posed.kind == COLLECTED
        names["form"] = self._form(posed.question) if names["listed"] else ""
        return render(self._env, "platform/_question.html.j2", names)

    def _form(self, question: Question) -> str:
        """Return the form of an answer in words."""
        return str(words(self.lang)["hints"].get(question.kind, question.hint))

    def option(self, option: Option) -> str:
        """Return an option with its letter, by which reports name it."""
        return render(self._env, "platform/_option.html.j2", {"option": option, "words": words(self.lang)})

    def style(self) -> str:
        """Return the style sheet of these pieces, for platforms that accept one."""
        return render(self._env, "platform/_style.css.j2", {})

    def inline(self, markdown: str) -> str:
        """Return a line of Markdown as HTML."""
        return filled(*self.blank_inline(markdown))

    def blank_inline(self, markdown: str) -> tuple[str, str]:
        """Return a line of Markdown as HTML with blanks for some of its digits, and these digits."""
        line, digits = blanked(markdown)
        html = _inline(self._env, line)
        return (html, digits) if html.count(_BLANK) == len(digits) else (_inline(self._env, markdown), "")

    def plain(self, markdown: str) -> str:
        """Return a line of Markdown as plain text."""
        return plain_line(markdown, self.lang)


def with_files(html: str, address: str = "{}") -> tuple[str, tuple[Image, ...]]:
    """Return the page with its pictures as files: ``address`` replaces each, with ``{}`` for the file's
    name."""
    images: dict[str, Image] = {}

    def out(match: re.Match[str]) -> str:
        data = base64.b64decode(match[3]) if match[2] else unquote_to_bytes(match[3])
        image = Image(f"{hashlib.sha256(data).hexdigest()[:16]}.{_ENDINGS[match[1]]}", data)
        images[image.name] = image
        return f'src="{address.format(image.name)}"'

    return _INLINE.sub(out, html), tuple(images.values())
