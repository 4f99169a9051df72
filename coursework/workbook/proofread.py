"""Checks of a lesson's words for what a book cannot print, reported with file and line."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence, Set
from functools import partial
from urllib.parse import unquote

from coursework.errors import BadCourse
from coursework.markup.markdown import INDEX, tree
from coursework.markup.proofreading import pair_dollars, read_formulas
from coursework.workbook import lesson_source as source

_FORMS = 'exercise:NAME, lesson:NAME, lesson:NAME#3, #index "entry" or https://…'
_LEADS = re.compile(r"(exercise:\w+|lesson:\w+(#\d+)?|(https?://|mailto:).+)")
_PICTURE = re.compile(r"!\[[^\]]*\]\(")
_CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)
_SECTION = re.compile(r"^## +(\d+)\.", re.MULTILINE)


def proofread(results: Sequence[source.Block], file: str) -> None:
    """Refuse words of a lesson that cannot be printed as intended.

    Parameters
    ----------
    found
        The blocks of the whole file.
    file
        What messages call it.

    Raises
    ------
    BadCourse
        It does not begin with its title, or has two; a section stands twice; a formula, a fence, a picture or a link is none.
    """
    _check_title(results, file)
    sections: set[str] = set()
    for words, line in lines_of_words(results):
        location = partial(place_of, words, line, file)
        pair_dollars(words, location)
        read_formulas(words, location)
        _check_pictures(words, location)
        _check_leads(words, location)
        sections |= _sections(words, sections, location)


def lines_of_words(results: Sequence[source.Block]) -> Iterator[tuple[str, int]]:
    """Yield the texts of a lesson, each with its first line number."""
    for block in results:
        if isinstance(block, source.LessonImage):
            yield block.caption, block.line
        elif not isinstance(block, source.CodeCell):
            yield block.text, block.line


def place_of(words: str, line: int, file: str, piece: str) -> str:
    """Return the file and the line of a piece of some words."""
    first = piece.split("\n")[0]
    further = next((k for k, item in enumerate(words.split("\n")) if first in item), 0)
    return f"{file}, line {line + further}"


def _check_title(results: Sequence[source.Block], file: str) -> None:
    """Refuse a lesson without exactly one title at its beginning."""
    first = results[0] if results else None
    if not isinstance(first, source.LessonProse) or not first.text.startswith("# "):
        raise BadCourse(f"{file}, line 1: a lesson begins with its title, # TITLE")
    titles = [
        (line + node.map[0], node.children[0].content)
        for words, line in lines_of_words(results)
        for node in tree(words).walk()
        if node.type == "heading" and node.tag == "h1" and node.map
    ]
    for line, title in titles[1:]:
        raise BadCourse(f"{file}, line {line}: a lesson has one title; write ## before {title!r}")


def _check_pictures(words: str, position: Callable[[str], str]) -> None:
    if picture := _PICTURE.search(_CODE.sub("", words)):
        raise BadCourse(
            f"{position(picture[0])}: a picture stands on a line of its own: ![caption](figure:NAME)"
        )


def _check_leads(words: str, position: Callable[[str], str]) -> None:
    for node in tree(words).walk():
        href = unquote(str(node.attrs["href"])) if node.type == "link" else INDEX
        if href != INDEX and not _LEADS.fullmatch(href):
            raise BadCourse(f"{position(f']({href}')}: the link {href!r} leads nowhere: write {_FORMS}")


def _sections(words: str, before: Set[str], position: Callable[[str], str]) -> set[str]:
    """Return the section numbers that begin in some words; refuse a repeated one."""
    results: set[str] = set()
    for number in _SECTION.findall(words):
        if number in before | results:
            raise BadCourse(
                f"{position(f'## {number}.')}: section {number} stands twice; number one of them anew"
            )
        results.add(number)
    return results
