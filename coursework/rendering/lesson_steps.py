"""Lesson in steps of a screen each, for a page on a telephone; its drawings are files beside the page."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from typing import NamedTuple
from urllib.parse import unquote_to_bytes

from jinja2 import Environment
from markupsafe import Markup

from coursework.markup.links import TextLink
from coursework.rendering.books import LessonPages
from coursework.sheets.book import (
    BlanksPiece,
    DrawnPiece,
    HeadPiece,
    LaterPiece,
    LessonText,
    Piece,
    PrintedPiece,
    ProsePiece,
)

_FULL = 900  #: letters of a step, about a screen of a telephone
_MORE = 1.5  #: times as much as a step may take, so that a drawing stays with its words
_FIGURE, _FORMULA, _LINE = 420, 120, 45  #: letters whose room a drawing, a formula, and a printed line take

_PARAGRAPHS = re.compile(r"\n[ \t]*\n+")
#: Paragraphs that go on with the one before: formulas, items, rows, quotations, code, words after a formula.
_GOES_ON = re.compile(r"\$\$|[-*+] |\d+[.)] |[ \t]|\||>|[a-zà-ÿ,;:(…]")
_ANNOUNCES = re.compile(r":[*_\s]*\Z")
_UNSEEN = re.compile(r"\]\([^)]*\)|\\[a-zA-Z]+|[][${}*_^\\]")  #: marks of Markdown and formulas
_FENCE = re.compile(r"^```", re.MULTILINE)
_IMAGE = re.compile(r'<img src="data:image/svg\+xml,([^"]*)"')
_SIZE = re.compile(r'<svg[^>]*? viewBox="[-\d.]+ [-\d.]+ ([\d.]+) ([\d.]+)"')
_MOTION = re.compile(rb"<animate[^>]*/>")
_PIXELS = 3.78  #: of a millimetre


class LessonStep(NamedTuple):
    """Step of a lesson."""

    head: HeadPiece | None  #: of the section that begins here
    anchor: str  #: of this heading, or of the step
    html: Markup
    blanks: BlanksPiece | None
    below: Markup  #: what follows the blanks


@dataclass(frozen=True)
class SteppedLesson:
    """Lesson ready for its page: steps, and drawings (SVG) by file name."""

    title: str
    steps: tuple[LessonStep, ...]
    figures: dict[str, bytes]


def stepped(
    env: Environment, lesson: LessonText, address: Callable[[TextLink], str], figures: str
) -> SteppedLesson:
    """Return a lesson in steps.

    Parameters
    ----------
    env
        The environment of HTML templates, in the lesson's language.
    lesson
        Drawn and run.
    address
        Where links lead; empty for nowhere.
    figures
        The address under which the files of drawings are found.
    """
    files: dict[str, bytes] = {}
    pages = LessonPages(env, lesson, address)
    made: list[LessonStep] = []
    for pieces in steps(lesson.pieces):
        cut = next((k for k, piece in enumerate(pieces) if isinstance(piece, BlanksPiece)), len(pieces))
        html, below = (
            Markup(_with_files(pages.html(some), files, figures))
            for some in (pieces[:cut], pieces[cut + 1 :])
        )
        head = next((piece for piece in pieces if isinstance(piece, HeadPiece) and piece.level == 1), None)
        anchor = f"section-{head.number}" if head and head.number else f"step-{len(made) + 1}"
        blanks = next((piece for piece in pieces[cut:] if isinstance(piece, BlanksPiece)), None)
        made.append(LessonStep(head, anchor, html, blanks, below))
    return SteppedLesson(lesson.title, tuple(made), files)


def _with_files(html: str, files: dict[str, bytes], address: str) -> str:
    """Return HTML whose drawings are files, named by their content, which browsers fetch as they come into
    sight."""

    def put(svg: bytes) -> str:
        name = f"{sha256(svg).hexdigest()[:16]}.svg"
        files[name] = svg
        return name

    def write(image: re.Match[str]) -> str:
        svg = unquote_to_bytes(image[1])
        name = put(svg)
        size = _SIZE.search(svg.decode())
        room = "".join(
            f' {side}="{float(length) * _PIXELS:.0f}"'
            for side, length in zip(("width", "height"), size.groups() if size else (), strict=False)
        )
        still = _MOTION.sub(b"", svg)
        if still != svg:  # what moves by itself can be stopped
            room += f' data-still="{address}/{put(still)}"'
        return f'<img src="{address}/{name}" loading="lazy"{room}'

    return _IMAGE.sub(write, html)


def steps(pieces: Sequence[Piece]) -> Iterator[tuple[Piece, ...]]:
    """Yield the pieces of a lesson in steps.

    A step begins at each heading, and ends with the answer to a question, or where a screen is full. What a
    sentence announces stays with it, what poses an example to complete stays together, and its blanks with
    its last lines.
    """
    step: list[Piece] = []
    for piece, stays in _small(pieces):
        if step and not stays and _begins(step, piece):
            yield tuple(step)
            step = []
        step.append(piece)
    if step:
        yield tuple(step)


def _begins(step: Sequence[Piece], piece: Piece) -> bool:
    """Return whether a piece begins another step."""
    last = step[-1]
    if isinstance(piece, BlanksPiece | LaterPiece):
        return False
    if isinstance(piece, HeadPiece):
        return not isinstance(last, HeadPiece)
    if isinstance(last, LaterPiece):
        return True
    if isinstance(last, HeadPiece) or (isinstance(last, ProsePiece) and _ANNOUNCES.search(last.text)):
        return False
    most = _MORE * _FULL if isinstance(piece, DrawnPiece) else _FULL
    return sum(map(_room, step)) + _room(piece) > most


def _room(piece: Piece) -> float:
    """Return the room that a piece takes, in letters."""
    if isinstance(piece, DrawnPiece):
        return _FIGURE + len(_UNSEEN.sub("", piece.caption))
    if isinstance(piece, PrintedPiece):
        return _LINE * (1 + piece.text.count("\n"))
    text = getattr(piece, "text", "")
    return len(_UNSEEN.sub("", text)) + _FORMULA * (text.count("$$") // 2)


def _small(pieces: Sequence[Piece]) -> Iterator[tuple[Piece, bool]]:
    """Yield the pieces with running text cut into paragraphs that may stand apart, and whether each stays
    with the one before."""
    posing: set[int] = set()
    for index, piece in enumerate(pieces):
        if isinstance(piece, BlanksPiece):
            first = index - piece.told - piece.posed
            posing |= set(range(first, first + piece.posed))
    for index, piece in enumerate(pieces):
        small = map(ProsePiece, _paragraphs(piece.text)) if isinstance(piece, ProsePiece) else [piece]
        for number, each in enumerate(small):
            yield each, index in posing and (number > 0 or index - 1 in posing)


def _paragraphs(text: str) -> list[str]:
    if _FENCE.search(text):
        return [text]
    joined: list[str] = []
    for paragraph in _PARAGRAPHS.split(text.strip("\n")):
        if joined and (_GOES_ON.match(paragraph) or _ANNOUNCES.search(joined[-1])):
            joined[-1] += f"\n\n{paragraph}"
        else:
            joined.append(paragraph)
    return joined
