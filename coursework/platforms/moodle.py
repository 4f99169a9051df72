"""Moodle: a file of its XML, in it a category an exercise, in each a question a variant: a cloze that asks all parts.

The grammar of a cloze is Moodle's, ``{2:NUMERICAL:=238.437:2.39~%50%-238.437:2.39#what is said}``: the weight, the type, then
answers, of which the first that fits counts. Before that, Moodle decodes the entities of each once.
"""

from __future__ import annotations

import base64
import hashlib
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import ROUND_UP, Decimal
from fractions import Fraction
from functools import partial
from pathlib import Path
from xml.dom.minidom import Document, Element

from coursework.language.numbers import plain
from coursework.language.words import words
from coursework.platforms.items import Item, Pool
from coursework.platforms.pieces import Image, Pieces, with_files
from coursework.platforms.platform import Platform
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Interval, Posed
from coursework.system.writing import File

_SHOWN = 6  #: figures of an answer, which students are shown
_OFF = 1e-3  #: share of a half-width that rounding an answer may move it by
_PERCENT = 7  #: decimals of a share, as many as Moodle keeps
_FINEST = 1000  #: a weight is a whole number: of so many parts of a point at most
_ID = 100  #: characters of an ``idnumber``
#: What a style sheet of ours does elsewhere: a figure as narrow as a telephone; a formula and its comma on one line.
_STYLES = {
    "<img ": '<img style="max-width: 100%; height: auto" ',
    '<span class="kept">': '<span style="white-space: nowrap">',
}
_WIDE = {"wide": 30, "line": 50, "lines": 60}  #: characters that a box of such a question shows
_BOX = "\N{OBJECT REPLACEMENT CHARACTER}"  #: where a box is to stand


class Moodle(Platform):
    name = "moodle"

    def files(self, pool: Pool) -> Iterator[File]:
        yield File(Path(f"{pool.name}.{pool.lang}.xml"), partial(quiz, pool))


PLATFORM = Moodle()


def quiz(pool: Pool) -> bytes:
    """The file that is imported."""
    pieces = Pieces(pool.folders, pool.lang)
    page = Document()
    root = _element(page, page, "quiz")
    for section in pool.sections:
        _category(root, page, (pool.title, f"{section.title} ({section.exercise}, {pool.lang})"))
        for item in section.items:
            _question(root, page, item, pieces)
    return page.toprettyxml(indent=" ", encoding="utf-8")


def _category(root: Element, page: Document, names: Sequence[str]) -> None:
    """The category of what follows; a slash in a name is written twice."""
    path = "/".join(("$course$", "top", *(name.replace("/", "//") for name in names)))
    _text(_element(_element(root, page, "question", type="category"), page, "category"), page, path)


def _question(root: Element, page: Document, item: Item, pieces: Pieces) -> None:
    html, images = _page(item, pieces)
    question = _element(root, page, "question", type="cloze")
    _text(_element(question, page, "name"), page, item.label[1:-1])
    asked = _element(question, page, "questiontext", format="html")
    _text(asked, page, html)
    for image in images:
        data = base64.b64encode(image.data).decode()
        file = _element(asked, page, "file", name=image.name, path="/", encoding="base64")
        file.appendChild(page.createTextNode(data))
    _element(question, page, "idnumber").appendChild(page.createTextNode(_idnumber(item.identifier)))


def _page(item: Item, pieces: Pieces) -> tuple[str, tuple[Image, ...]]:
    """Statement and questions with their boxes, and the pictures that the statement shows."""
    asked = (f'<div style="margin-top: 1em">{_asked(posed, pieces)}</div>' for posed in item.questions)
    told = f'<div lang="{pieces.lang}">{pieces.opening(item)}{"".join(asked)}</div>'
    html, images = with_files(told, "@@PLUGINFILE@@/{}")
    for plain_tag, styled in _STYLES.items():
        html = html.replace(plain_tag, styled)
    scale = _scale(posed.points for posed in item.questions)
    boxes = (_box(posed, round(posed.points * scale), pieces) for posed in item.questions)
    return _filled(html, boxes), images


def _filled(html: str, boxes: Iterable[str]) -> str:
    """The boxes in their places; braces of the page itself open none."""
    first, *rest = html.replace("{", "&#123;").replace("}", "&#125;").split(_BOX)
    return first + "".join(box + text for box, text in zip(boxes, rest, strict=True))


def _asked(posed: Posed, pieces: Pieces) -> str:
    """A question, with a mark where its box is to stand."""
    if posed.kind in (CHOICE, CHOICES):
        return f"{pieces.prompt(posed)}<div>{_BOX}</div>"
    return pieces.prompt(posed, box=_BOX)


# --------------------------------------------------------------------------- cloze


def _box(posed: Posed, weight: int, pieces: Pieces) -> str:
    """A question's box, in the grammar of a cloze. What is collected weighs nothing: the quiz is out of what Moodle judges."""
    if posed.kind == NUMBER:
        return _cloze(weight, "NUMERICAL", (_number(one, pieces) for one in posed.intervals))
    if posed.kind == COLLECTED:
        return _cloze(0, "SHORTANSWER", _kept(posed, words(pieces.lang)["platforms"]["moodle"]))
    kind = "MULTICHOICE_V" if posed.kind == CHOICE else "MULTIRESPONSE"
    answers = (
        _answer(one.share, escaped(pieces.option(one)), one.says, pieces, whole=posed.kind == CHOICE)
        for one in posed.options
    )
    return _cloze(weight, kind, answers)


def _kept(posed: Posed, told: Mapping[str, str]) -> tuple[str, str]:
    """What stands for a right answer that Moodle does not know, then whatever is written; the box is as wide as its longest."""
    later = told["later"].ljust(_WIDE.get(posed.question.box, 0), "\N{NO-BREAK SPACE}")
    return f"={escaped(later)}", f"%50%*#{escaped(told['kept'])}"


def _cloze(weight: int, kind: str, answers: Iterable[str]) -> str:
    return f"{{{weight}:{kind}:{'~'.join(answers)}}}"


def _number(interval: Interval, pieces: Pieces) -> str:
    shown, margin = numerical(interval)
    return _answer(interval.share, f"{shown}:{margin}", interval.says, pieces)


def _answer(share: float, answer: str, says: str, pieces: Pieces, *, whole: bool = True) -> str:
    """One answer of a box: what it is worth, ``=`` for all where one answer earns the ``whole``; what is said of it."""
    worth = "=" if whole and share == 1 else f"%{_percent(share)}%"
    return f"{worth}{answer}#{escaped(pieces.inline(says))}" if says else worth + answer


def _percent(share: float) -> str:
    return plain(round(100 * share, _PERCENT))


_MARKS = str.maketrans({"&": "&amp;", "}": "&#125;", "#": "&#35;", "~": "&#126;"})


def escaped(html: str) -> str:
    """HTML as it stands within an answer of a cloze, which ends nowhere in it; Moodle decodes it once.

    A backslash is written as HTML writes it: Moodle takes one away before ``}`` and ``#``.
    """
    return html.replace("\\", "&#92;").translate(_MARKS)


def numerical(interval: Interval) -> tuple[str, str]:
    """The answer as students are shown it, six figures or as many as its margin needs, and the margin that holds the interval."""
    half = (interval.high - interval.low) / 2
    if not half:
        return plain(interval.value), "0"
    step = min(
        _step(_OFF * half), max(_step(interval.value) * Decimal(10) ** (1 - _SHOWN), _step(_OFF**2 * half))
    )
    shown = Decimal(interval.value).quantize(step)
    reach = max(Decimal(interval.high) - shown, shown - Decimal(interval.low))
    margin = reach.quantize(_step(float(reach)) * Decimal(10) ** (1 - _SHOWN), ROUND_UP)
    return _decimal(shown), _decimal(margin)


def _step(value: float) -> Decimal:
    """The place of a number's first figure: 0.01 of 0.0238."""
    return Decimal(1).scaleb(Decimal(value).adjusted()) if value else Decimal(0)


def _decimal(number: Decimal) -> str:
    """A number without zeros at its end, and without exponent."""
    text = f"{number:f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text in ("-0", "") else text


def _scale(points: Iterable[float]) -> int:
    """By how much points are multiplied to be weights, which are whole numbers."""
    parts = [Fraction(one).limit_denominator(_FINEST).denominator for one in points]
    return min(math.lcm(*parts), _FINEST)


# ----------------------------------------------------------------------------- XML


def _element(parent: Element | Document, page: Document, tag: str, **marks: str) -> Element:
    made = page.createElement(tag)
    for name, value in marks.items():
        made.setAttribute(name, value)
    parent.appendChild(made)
    return made


def _text(parent: Element, page: Document, text: str) -> None:
    """A text, in one piece: of one with entities Moodle loses the spaces between two of them."""
    whole = text.replace("]]>", "]]&gt;")
    _element(parent, page, "text").appendChild(page.createCDATASection(whole))


def _idnumber(identifier: str) -> str:
    """An identifier as long as Moodle takes it at most: its end stays, a digest tells what stood before."""
    if len(identifier) <= _ID:
        return identifier
    digest = hashlib.sha256(identifier.encode()).hexdigest()[:12]
    return f"{digest}{identifier[len(digest) - _ID :]}"
