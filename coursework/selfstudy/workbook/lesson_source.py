"""Lesson's file: prose, cells, answers to questions and pictures in order, proofread for what a book cannot
print.

A lesson is Markdown. A ```` ```python ```` fence is a cell, with ``{tags=…}`` after the word; a
```` ```answer ```` fence is the answer to the question above it; a picture stands on a line of its own,
``![caption](figure:NAME)`` or ``![caption](exercise:NAME?seed=3)``. Links lead to ``exercise:NAME``,
``lesson:NAME`` and ``lesson:NAME#3``, ``[the figure](figure:NAME)`` cites a figure of the lesson by its
number, and ``[a term](#index "entry")`` is a term of the book's index.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Sequence, Set
from dataclasses import dataclass, field
from functools import partial
from typing import TypeAlias
from urllib.parse import unquote

from coursework.errors import BadCourse, closest, nearest
from coursework.markup.markdown import INDEX, tree
from coursework.markup.proofreading import pair_dollars, read_formulas

SHOWN, NOTEBOOK, STILL = "shown", "notebook", "still"
#: What a cell's tags say: its code is printed; it stands in the notebook alone; its code is printed and not
#: run for the book.
TAGS = (SHOWN, NOTEBOOK, STILL)


@dataclass(frozen=True)
class LessonProse:
    """Running text; ``line`` is that of its first line in the file."""

    text: str
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class CodeCell:
    """Code cell; ``line`` is that of its first line in the file."""

    code: str
    tags: tuple[str, ...]
    line: int


@dataclass(frozen=True)
class LessonAnswer:
    """Answer to the question above it, Markdown; ``line`` is that of its first line in the file."""

    text: str
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class LessonImage:
    """Picture on a line of its own: its ``kind`` and name, its options, and its caption."""

    caption: str
    kind: str  #: figure or exercise
    name: str
    asked: dict[str, str] = field(default_factory=dict)
    line: int = 0


Block: TypeAlias = LessonProse | CodeCell | LessonAnswer | LessonImage

_FENCE = re.compile(
    r"^(```+)(\w*)[ \t]*(?:\{tags=([\w,-]+)\})?[ \t]*\n(.*?)^\1[ \t]*$", re.DOTALL | re.MULTILINE
)
_CITED = re.compile(r"\[([^\[\]]+)\]\(figure:(\w+)\)")
_MARK = re.compile(r"^(```+)(.*?)[ \t]*$")
_OPENED = re.compile(r"(\w*)[ \t]*(?:\{tags=[\w,-]+\})?")
_WORDS = ("python", "answer")  #: of fences that are more than text in a fixed pitch
_IMAGE = re.compile(r"^!\[(?P<caption>.*)\]\((?P<target>[^()\s]+)\)[ \t]*$", re.MULTILINE)
_TARGET = re.compile(r"(figure|exercise):(\w+)(?:\?(\S*))?")


def blocks(text: str, file: str) -> tuple[Block, ...]:
    """Parse a lesson's text into blocks; ``file`` is its name in messages.

    Raises
    ------
    BadCourse
        A fence, a tag or a picture that is none.
    """
    _check_fences(text, file)
    results: list[Block] = []
    end = 0
    for fence in _FENCE.finditer(text):
        if fence[2] not in _WORDS:
            continue
        results += _prose(text, end, fence.start(), file)
        if fence[2] == "answer":
            results.append(LessonAnswer(fence[4].strip(), _line(text, fence.start(4), fence[4])))
        else:
            results.append(_cell(fence, text, file))
        end = fence.end()
    return (*results, *_prose(text, end, len(text), file))


def _cell(fence: re.Match[str], text: str, file: str) -> CodeCell:
    line = 2 + text.count("\n", 0, fence.start())
    tags = tuple(fence[3].split(",")) if fence[3] else ()
    for tag in tags:
        if tag not in TAGS:
            raise BadCourse(f"{file}, line {line - 1}: no tag {tag!r}{nearest(tag, TAGS)}")
    return CodeCell(fence[4].rstrip("\n"), tags, line)


def _prose(text: str, start: int, stop: int, file: str) -> Iterator[Block]:
    end = start
    for image in _IMAGE.finditer(text, start, stop):
        yield from _words(text, end, image.start())
        yield _image(image, file, 1 + text.count("\n", 0, image.start()))
        end = image.end()
    yield from _words(text, end, stop)


def _words(text: str, start: int, stop: int) -> Iterator[LessonProse]:
    if words := text[start:stop].strip():
        yield LessonProse(words, _line(text, start, text[start:stop]))


def _line(text: str, start: int, piece: str) -> int:
    """Return the line of the first letter of a piece of the text."""
    before = len(piece) - len(piece.lstrip())
    return 1 + text.count("\n", 0, start + before)


def _check_fences(text: str, file: str) -> None:
    """Refuse a fence that is never closed, or whose word nearly matches a known one."""
    opened, at = "", 0
    for number, line in enumerate(text.split("\n"), 1):
        mark = _MARK.match(line)
        if mark is None or (opened and mark[1] != opened):
            continue
        if opened and mark[2]:
            raise BadCourse(
                f"{file}, line {at}: the fence that opens here is not closed before line {number}"
            )
        if not opened:
            _check_opening(mark[2].strip(), f"{file}, line {number}")
        opened, at = ("" if opened else mark[1]), number
    if opened:
        raise BadCourse(f"{file}, line {at}: the fence that opens here is never closed")


def _check_opening(text: str, position: str) -> None:
    """Refuse a malformed opening of a fence."""
    match = _OPENED.fullmatch(text)
    if match is None:
        raise BadCourse(
            f"{position}: a fence opens with a word, and tags if wanted: python {{tags=shown}}; found "
            f"{text!r}"
        )
    word = match[1]
    if word not in _WORDS and (near := closest(word.lower(), _WORDS)):
        raise BadCourse(f"{position}: no fence {word!r}; did you mean {near!r}?")


def _image(image: re.Match[str], file: str, line: int) -> LessonImage:
    target = _TARGET.fullmatch(image["target"])
    if target is None:
        raise BadCourse(
            f"{file}, line {line}: the picture {image['target']!r}: write figure:NAME, or "
            "exercise:NAME?seed=3"
        )
    pairs = (item.partition("=") for item in filter(None, (target[3] or "").split("&")))
    return LessonImage(
        image["caption"], target[1], target[2], {name: value for name, _, value in pairs}, line
    )


def with_figures(text: str, write: Callable[[str, str], str]) -> str:
    """Replace each ``[words](figure:NAME)`` of a text by what ``write`` makes of the words and the name."""
    return _CITED.sub(lambda found: write(found[1], found[2]), text)


def mistakes_shown(cell: CodeCell) -> Iterator[tuple[str, str]]:
    """Yield the exercise and the name of each mistake that a cell shows by
    ``coursework.mistakes("EXERCISE", "NAME")``."""
    for call in ast.walk(ast.parse(cell.code)):
        if (
            isinstance(call, ast.Call)
            and isinstance(call.func, ast.Attribute)
            and call.func.attr == "mistakes"
        ):
            named = [each.value for each in call.args if isinstance(each, ast.Constant)]
            for mistake in named[1:]:
                yield str(named[0]), str(mistake)


_FORMS = 'exercise:NAME, figure:NAME, lesson:NAME, lesson:NAME#3, #index "entry" or https://…'
_LEADS = re.compile(r"(exercise:\w+|figure:\w+|lesson:\w+(#\d+)?|(https?://|mailto:).+)")
_PICTURE = re.compile(r"!\[[^\]]*\]\(")
_CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)
_SECTION = re.compile(r"^## +(\d+)\.", re.MULTILINE)


def proofread(results: Sequence[Block], file: str) -> None:
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
        It does not begin with its title, or has two; a section stands twice; a formula, a fence, a picture or
        a link is none.
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


def lines_of_words(results: Sequence[Block]) -> Iterator[tuple[str, int]]:
    """Yield the texts of a lesson, each with its first line number."""
    for block in results:
        if isinstance(block, LessonImage):
            yield block.caption, block.line
        elif not isinstance(block, CodeCell):
            yield block.text, block.line


def place_of(words: str, line: int, file: str, piece: str) -> str:
    """Return the file and the line of a piece of some words."""
    first = piece.split("\n")[0]
    further = next((k for k, item in enumerate(words.split("\n")) if first in item), 0)
    return f"{file}, line {line + further}"


def _check_title(results: Sequence[Block], file: str) -> None:
    """Refuse a lesson without exactly one title at its beginning."""
    first = results[0] if results else None
    if not isinstance(first, LessonProse) or not first.text.startswith("# "):
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
