"""Moodle: an XML file with a category per exercise and a cloze question per variant, which asks all parts.

The syntax of a cloze is ``{2:NUMERICAL:=238.437:2.39~%50%-238.437:2.39#feedback}``: the weight, the type,
then answers, of which the first match counts. Moodle first decodes the entities of each answer once.
"""

from __future__ import annotations

import base64
import hashlib
import io
import math
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import ROUND_UP, Decimal
from fractions import Fraction
from functools import partial
from pathlib import Path
from xml.dom.minidom import Document, Element

from coursework.language.numbers import plain
from coursework.language.words import words
from coursework.platforms.items import Item, Pool
from coursework.platforms.pieces import Image, PagePieces, with_files
from coursework.platforms.platform import Platform
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Interval, Posed
from coursework.system.writing import File

_SHOWN = 6  #: figures of an answer shown to students
_OFF = 1e-3  #: share of a half-width that rounding an answer may move it by
_PERCENT = 7  #: decimals of a share, as many as Moodle keeps
_FINEST = 1000  #: weights are integers: the finest fraction of a point
_ID = 100  #: characters of an ``idnumber``
#: Inline style in place of our style sheet: figures that fit a telephone; a formula and its comma on one line.
_STYLES = {
    "<img ": '<img style="max-width: 100%; height: auto" ',
    '<span class="kept">': '<span style="white-space: nowrap">',
}
_WIDE = {"wide": 30, "line": 50, "lines": 60}  #: characters that a box of such a question shows
_BOX = "\N{OBJECT REPLACEMENT CHARACTER}"  #: placeholder of a box


class Moodle(Platform):
    name = "moodle"

    def content(self, item: Item, pieces: PagePieces) -> bytes:
        return zlib.compress(_lines(_question(Document(), item, pieces)))

    def files(self, pool: Pool) -> Iterator[File]:
        yield File(Path(f"{pool.name}.{pool.lang}.xml"), partial(quiz, pool))


PLATFORM = Moodle()


def quiz(pool: Pool) -> Iterator[bytes]:
    """Yield the file to import, question by question."""
    yield b'<?xml version="1.0" encoding="utf-8"?>\n<quiz>\n'
    for section in pool.sections:
        yield _lines(
            _category(Document(), (pool.title, f"{section.title} ({section.exercise}, {pool.lang})"))
        )
        for item in section.items:
            yield zlib.decompress(item.content)
    yield b"</quiz>\n"


def _lines(question: Element) -> bytes:
    """Return a question with a line for each element, indented as in the quiz."""
    lines = io.StringIO()
    question.writexml(lines, " ", " ", "\n")
    return lines.getvalue().encode("utf-8", "xmlcharrefreplace")


def _category(page: Document, names: Sequence[str]) -> Element:
    """Return the category of the following questions; a slash in a name is doubled."""
    path = "/".join(("$course$", "top", *(name.replace("/", "//") for name in names)))
    question = _element(page, page, "question", type="category")
    _text(_element(question, page, "category"), page, path)
    return question


def _question(page: Document, item: Item, pieces: PagePieces) -> Element:
    html, images = _page(item, pieces)
    question = _element(page, page, "question", type="cloze")
    _text(_element(question, page, "name"), page, item.label[1:-1])
    text_element = _element(question, page, "questiontext", format="html")
    _text(text_element, page, html)
    for image in images:
        data = base64.b64encode(image.data).decode()
        file = _element(text_element, page, "file", name=image.name, path="/", encoding="base64")
        file.appendChild(page.createTextNode(data))
    _element(question, page, "idnumber").appendChild(page.createTextNode(_idnumber(item.identifier)))
    return question


def _page(item: Item, pieces: PagePieces) -> tuple[str, tuple[Image, ...]]:
    """Return statement and questions with their boxes, and the statement's pictures."""
    questions = (
        f'<div style="margin-top: 1em">{_question_html(posed, pieces)}</div>' for posed in item.questions
    )
    page_html = f'<div lang="{pieces.lang}">{pieces.opening(item)}{"".join(questions)}</div>'
    html, images = with_files(page_html, "@@PLUGINFILE@@/{}")
    for plain_tag, styled in _STYLES.items():
        html = html.replace(plain_tag, styled)
    scale = _scale(posed.points for posed in item.questions)
    boxes = (_box(posed, round(posed.points * scale), pieces) for posed in item.questions)
    return _filled(html, boxes), images


def _filled(html: str, boxes: Iterable[str]) -> str:
    """Return the page with its boxes; braces of the page itself are escaped."""
    first, *rest = html.replace("{", "&#123;").replace("}", "&#125;").split(_BOX)
    return first + "".join(box + text for box, text in zip(boxes, rest, strict=True))


def _question_html(posed: Posed, pieces: PagePieces) -> str:
    """Return a question with a placeholder for its box."""
    if posed.kind in (CHOICE, CHOICES):
        return f"{pieces.prompt(posed)}<div>{_BOX}</div>"
    return pieces.prompt(posed, box=_BOX)


# --------------------------------------------------------------------------- cloze


def _box(posed: Posed, weight: int, pieces: PagePieces) -> str:
    """Return a question's box in cloze syntax. A collected answer has weight zero: the quiz counts the points
    that Moodle judges."""
    if posed.kind == NUMBER:
        return _cloze(weight, "NUMERICAL", (_number(option, pieces) for option in posed.intervals))
    if posed.kind == COLLECTED:
        return _cloze(0, "SHORTANSWER", _collected_answer(posed, words(pieces.lang)["platforms"]["moodle"]))
    kind = "MULTICHOICE_V" if posed.kind == CHOICE else "MULTIRESPONSE"
    answers = (
        _answer(
            option.share, escaped(pieces.option(option)), option.message, pieces, is_full=posed.kind == CHOICE
        )
        for option in posed.options
    )
    return _cloze(weight, kind, answers)


def _collected_answer(posed: Posed, texts: Mapping[str, str]) -> tuple[str, str]:
    """Return the right answer and the catch-all of a collected answer; the box is as wide as the longest
    text."""
    later = texts["later"].ljust(_WIDE.get(posed.question.box, 0), "\N{NO-BREAK SPACE}")
    return f"={escaped(later)}", f"%50%*#{escaped(texts['kept'])}"


def _cloze(weight: int, kind: str, answers: Iterable[str]) -> str:
    return f"{{{weight}:{kind}:{'~'.join(answers)}}}"


def _number(interval: Interval, pieces: PagePieces) -> str:
    text, margin = numerical(interval)
    return _answer(interval.share, f"{text}:{margin}", interval.message, pieces)


def _answer(share: float, answer: str, feedback: str, pieces: PagePieces, *, is_full: bool = True) -> str:
    """Return one answer of a box with its share, ``=`` for the full share of a single answer, and its
    feedback."""
    worth = "=" if is_full and share == 1 else f"%{_percent(share)}%"
    return f"{worth}{answer}#{escaped(pieces.inline(feedback))}" if feedback else worth + answer


def _percent(share: float) -> str:
    return plain(round(100 * share, _PERCENT))


_MARKS = str.maketrans({"&": "&amp;", "}": "&#125;", "#": "&#35;", "~": "&#126;"})


def escaped(html: str) -> str:
    """Return HTML escaped for an answer of a cloze; Moodle decodes it once.

    A backslash is written as an entity: Moodle removes one before ``}`` and ``#``.
    """
    return html.replace("\\", "&#92;").translate(_MARKS)


def numerical(interval: Interval) -> tuple[str, str]:
    """Return the answer as students see it, with six figures or as many as its margin needs, and the margin
    around it that covers the interval."""
    half = (interval.high - interval.low) / 2
    if not half:
        return plain(interval.value), "0"
    step = min(
        _step(_OFF * half), max(_step(interval.value) * Decimal(10) ** (1 - _SHOWN), _step(_OFF**2 * half))
    )
    rounded = Decimal(interval.value).quantize(step)
    reach = max(Decimal(interval.high) - rounded, rounded - Decimal(interval.low))
    margin = reach.quantize(_step(float(reach)) * Decimal(10) ** (1 - _SHOWN), ROUND_UP)
    return _decimal(rounded), _decimal(margin)


def _step(value: float) -> Decimal:
    """Return the place value of a number's first figure: 0.01 of 0.0238."""
    return Decimal(1).scaleb(Decimal(value).adjusted()) if value else Decimal(0)


def _decimal(number: Decimal) -> str:
    """Return a decimal without trailing zeros and without exponent."""
    text = f"{number:f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text in ("-0", "") else text


def _scale(points: Iterable[float]) -> int:
    """Return the factor that makes points whole-number weights."""
    parts = [Fraction(value).limit_denominator(_FINEST).denominator for value in points]
    return min(math.lcm(*parts), _FINEST)


# ----------------------------------------------------------------------------- XML


def _element(parent: Element | Document, page: Document, tag: str, **marks: str) -> Element:
    element = page.createElement(tag)
    for name, value in marks.items():
        element.setAttribute(name, value)
    parent.appendChild(element)
    return element


def _text(parent: Element, page: Document, text: str) -> None:
    """Return a text as a single CDATA section: Moodle loses spaces between two entities otherwise."""
    escaped_text = text.replace("]]>", "]]&gt;")
    _element(parent, page, "text").appendChild(page.createCDATASection(escaped_text))


def _idnumber(identifier: str) -> str:
    """Return an identifier of the length that Moodle allows: its end, after a digest of the rest."""
    if len(identifier) <= _ID:
        return identifier
    digest = hashlib.sha256(identifier.encode()).hexdigest()[:12]
    return f"{digest}{identifier[len(digest) - _ID :]}"
