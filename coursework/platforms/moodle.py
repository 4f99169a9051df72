"""Moodle: an XML file with a category per exercise and a cloze question per variant, which asks all parts.

The syntax of a cloze is ``{2:NUMERICAL:=238.437:2.39~%50%-238.437:2.39#feedback}``: the weight, the type,
then answers, of which the first match counts. Moodle first decodes the entities of each answer once.
"""

from __future__ import annotations

import base64
import hashlib
import io
import json
import math
import re
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from decimal import ROUND_UP, Decimal
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any
from xml.dom.minidom import Document, Element

from coursework.language.numbers import plain
from coursework.language.words import words
from coursework.platforms.items import SEPARATOR, Item, Pool
from coursework.platforms.pieces import PagePieces, with_files
from coursework.platforms.platform import Platform
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Interval, Posed
from coursework.system.writing import File

_SHOWN = 6  #: figures of an answer shown to students
_OFF = 1e-3  #: share of a half-width that rounding an answer may move it by
_PERCENT = 7  #: decimals of a share, as many as Moodle keeps
_FINEST = 1000  #: weights are integers: the finest fraction of a point
_ID = 100  #: characters of an ``idnumber``
#: Inline style in place of our style sheet: figures that fit a telephone; a formula and its comma on one
#: line.
_STYLES = {
    "<img ": '<img style="max-width: 100%; height: auto" ',
    '<span class="kept">': '<span style="white-space: nowrap">',
}
_WIDE = {"wide": 30, "line": 50, "lines": 60}  #: characters that a box of such a question shows
_BOX = "\N{OBJECT REPLACEMENT CHARACTER}"  #: placeholder of a box


_LARGEST_FILE = 2_000_000  #: bytes of a file to import: a PHP as it is installed takes 2 MiB
_SPAN = re.compile(r"(</?)span\b")


class Moodle(Platform):
    name = "moodle"

    def content(self, item: Item, pieces: PagePieces) -> bytes:
        return zlib.compress(json.dumps(_pieces_of(item, pieces)).encode())

    def files(self, pool: Pool) -> Iterator[File]:
        return self.files_of([pool])

    def files_of(self, pools: Sequence[Pool]) -> Iterator[File]:
        """Yield the files of one quiz: each question carries the languages of all pools, of which Moodle's
        filter ``multilang`` shows the student's own."""
        languages = "-".join(pool.lang for pool in pools)
        batches = list(_batches(pools))
        for number, batch in enumerate(batches, start=1):
            part = f".{number:0{len(str(len(batches)))}}" if len(batches) > 1 else ""
            yield File(Path(f"{pools[0].name}.{languages}{part}.xml"), partial(_quiz, batch))


PLATFORM = Moodle()


def _quiz(batch: Sequence[bytes]) -> Iterator[bytes]:
    """Yield the file to import, question by question."""
    yield b'<?xml version="1.0" encoding="utf-8"?>\n<quiz>\n'
    yield from map(zlib.decompress, batch)
    yield b"</quiz>\n"


def _batches(pools: Sequence[Pool]) -> Iterator[list[bytes]]:
    """Yield the compressed lines of the questions of each file, as many as fit into one, each section's
    behind its category."""
    batch: list[bytes] = []
    size = 0
    for position, section in enumerate(pools[0].sections):
        category = zlib.compress(_lines(_category(Document(), _category_names(pools, position))))
        is_begun = False
        for k in range(len(section.items)):
            lines = _question_lines(pools, position, k)
            if batch and size + len(lines) > _LARGEST_FILE:
                yield batch
                batch, size, is_begun = [], 0, False
            batch += [zlib.compress(lines)] if is_begun else [category, zlib.compress(lines)]
            size += len(lines)
            is_begun = True
    yield batch


def _category_names(pools: Sequence[Pool], position: int) -> tuple[str, str]:
    titles = dict.fromkeys(pool.sections[position].title for pool in pools)
    languages = ", ".join(pool.lang for pool in pools)
    names = " / ".join(dict.fromkeys(pool.title for pool in pools))
    return names, f"{' / '.join(titles)} ({pools[0].sections[position].exercise}, {languages})"


def _question_lines(pools: Sequence[Pool], position: int, k: int) -> bytes:
    """Return a question of a section in the languages of the pools, a line for each element."""
    contents = [pool.sections[position].items[k].content for pool in pools]
    return _lines(_question(Document(), [json.loads(zlib.decompress(content)) for content in contents]))


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


def _question(page: Document, languages: Sequence[Mapping[str, Any]]) -> Element:
    first, codes = languages[0], [pieces["lang"] for pieces in languages]
    question = _element(page, page, "question", type="cloze")
    _text(_element(question, page, "name"), page, SEPARATOR.join((first["code"], *codes)))
    text_element = _element(question, page, "questiontext", format="html")
    _text(text_element, page, _page(languages))
    images = {name: data for pieces in languages for name, data in pieces["images"].items()}
    for name, data in images.items():
        file = _element(text_element, page, "file", name=name, path="/", encoding="base64")
        file.appendChild(page.createTextNode(data))
    identifier = f"{first['identifier'].removesuffix(first['lang'])}{'-'.join(codes)}"
    _element(question, page, "idnumber").appendChild(page.createTextNode(_idnumber(identifier)))
    return question


def _page(languages: Sequence[Mapping[str, Any]]) -> str:
    """Return statement and questions with their boxes; where languages differ, each between marks of its
    own."""
    codes = [pieces["lang"] for pieces in languages]
    join = partial(_in_languages, codes)
    attribute = f' lang="{codes[0]}"' if len(codes) == 1 else ""
    html = [f"<div{attribute}>", _braced(join([pieces["opening"] for pieces in languages]))]
    for same in zip(*(pieces["questions"] for pieces in languages), strict=True):
        head, left, right = (_braced(join([q[part] for q in same])) for part in ("head", "left", "right"))
        html += [
            _QUESTION,
            head,
            same[0]["open"],
            left,
            _box([q["box"] for q in same], join),
            right,
            same[0]["close"],
        ]
    return "".join((*html, "</div>"))


_QUESTION = '<div style="margin-top: 1em">'


def _in_languages(codes: Sequence[str], texts: Sequence[str]) -> str:
    """Return a text, or the texts of several languages as Moodle's core filter ``multilang`` reads them. That
    filter ends a language at the next ``</span>``: other elements of this name get another."""
    if len(set(texts)) == 1:
        return texts[0]
    texts = [_SPAN.sub(r"\1bdi", text) for text in texts]
    return " ".join(
        f'<span lang="{code}" class="multilang">{text}</span>'
        for code, text in zip(codes, texts, strict=True)
    )


def _braced(html: str) -> str:
    """Return HTML whose braces open no box."""
    return html.replace("{", "&#123;").replace("}", "&#125;")


def _pieces_of(item: Item, pieces: PagePieces) -> dict[str, Any]:
    """Return what a question says in one language: plain data."""
    images: dict[str, str] = {}

    def styled(html: str) -> str:
        html, found = with_files(html, "@@PLUGINFILE@@/{}")
        images.update((image.name, base64.b64encode(image.data).decode()) for image in found)
        for plain_tag, styled_tag in _STYLES.items():
            html = html.replace(plain_tag, styled_tag)
        return html

    scale = _scale(posed.points for posed in item.questions)
    opening = styled(pieces.opening(item))
    return {
        "lang": pieces.lang,
        "code": item.label[1:-1].removesuffix(f"{SEPARATOR}{pieces.lang}"),
        "identifier": item.identifier,
        "opening": opening,
        "questions": [
            {
                **_around_box(posed, pieces, styled),
                "box": _box_content(posed, round(posed.points * scale), pieces),
            }
            for posed in item.questions
        ],
        "images": images,
    }


def _around_box(posed: Posed, pieces: PagePieces, styled: Callable[[str], str]) -> dict[str, str]:
    """Return what stands before a question's box, beside it and behind it; the paragraph of the box is cut
    off, so that each piece is whole."""
    if posed.kind in (CHOICE, CHOICES):
        head, left, right = pieces.prompt(posed), "", ""
        opens, closes = "<div>", "</div></div>"
    else:
        before, right = pieces.prompt(posed, box=_BOX).split(_BOX)
        head, opens, left = before.rpartition("<p>")
        right, closes, rest = right.partition("</p>")
        closes += f"{rest}</div>"
    return {
        "head": styled(head),
        "open": opens,
        "left": styled(left),
        "right": styled(right),
        "close": closes,
    }


# --------------------------------------------------------------------------- cloze


def _box_content(posed: Posed, weight: int, pieces: PagePieces) -> dict[str, Any]:
    """Return a question's box: its weight, its type, and of each answer its share, itself and its feedback. A
    collected answer has weight zero: the quiz counts the points that Moodle judges."""
    if posed.kind == NUMBER:
        answers = [
            (_worth(one.share), ":".join(numerical(one)), pieces.inline(one.message) if one.message else "")
            for one in posed.intervals
        ]
        return {"weight": weight, "type": "NUMERICAL", "answers": answers}
    if posed.kind == COLLECTED:
        texts = words(pieces.lang)["platforms"]["moodle"]
        answers = [("=", str(texts["later"]), ""), ("%50%", "*", str(texts["kept"]))]
        return {
            "weight": 0,
            "type": "SHORTANSWER",
            "answers": answers,
            "wide": _WIDE.get(posed.question.box, 0),
        }
    answers = [
        (
            _worth(one.share, is_full=posed.kind == CHOICE),
            pieces.option(one),
            pieces.inline(one.message) if one.message else "",
        )
        for one in posed.options
    ]
    kind = "MULTICHOICE_V" if posed.kind == CHOICE else "MULTIRESPONSE"
    return {"weight": weight, "type": kind, "answers": answers}


def _box(boxes: Sequence[Mapping[str, Any]], join: Callable[[Sequence[str]], str]) -> str:
    """Return a box in cloze syntax, with the texts of all languages. The right answer of a collected one is
    plain text, as wide as the box is to be."""
    first, answers = boxes[0], []
    for same in zip(*(box["answers"] for box in boxes), strict=True):
        texts = [text for _, text, _ in same]
        if "wide" in first:
            answer = " / ".join(dict.fromkeys(texts)).ljust(
                first["wide"] if texts[0] != "*" else 0, "\N{NO-BREAK SPACE}"
            )
        else:
            answer = texts[0] if first["type"] == "NUMERICAL" else join(texts)
        feedback = join([says for *_, says in same])
        answer = answer if first["type"] == "NUMERICAL" else escaped(answer)
        answers.append(f"{same[0][0]}{answer}#{escaped(feedback)}" if feedback else f"{same[0][0]}{answer}")
    return f"{{{first['weight']}:{first['type']}:{'~'.join(answers)}}}"


def _worth(share: float, *, is_full: bool = True) -> str:
    """Return the share of an answer, ``=`` for the full share of a single one."""
    return "=" if is_full and share == 1 else f"%{plain(round(100 * share, _PERCENT))}%"


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
