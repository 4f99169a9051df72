"""Reads the question texts of Moodle's XML by the grammar that its documentation states, independently of
what writes them."""

from __future__ import annotations

import html
import re
from typing import NamedTuple

_TYPES = "NUMERICAL|SHORTANSWER|MULTICHOICE|MULTICHOICE_V|MULTICHOICE_H|MULTIRESPONSE|MULTIRESPONSE_H"
_OPENING = re.compile(rf"\{{(\d*):({_TYPES}):")
_NUMBER = re.compile(r"-?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?")


class Answer(NamedTuple):
    share: float
    text: str  #: as students are shown it; of a number as written
    margin: float | None
    says: str


class Box(NamedTuple):
    weight: int
    kind: str
    answers: list[Answer]


def boxes_of(text):
    """The boxes of a question text, and the text around them."""
    boxes, around, place = [], [], 0
    while opening := _OPENING.search(text, place):
        around.append(text[place : opening.start()])
        end = _closing(text, opening.end())
        answers = [_answer(one, opening[2]) for one in _split(text[opening.end() : end], "~")]
        boxes.append(Box(int(opening[1]), opening[2], answers))
        place = end + 1
    return boxes, [*around, text[place:]]


def _closing(text, start):
    """Where a box ends: the first brace that no backslash is before."""
    return next(m.start() for m in re.compile(r"(?<!\\)\}").finditer(text, start))


def _split(text, mark, most=0):
    """PagePieces between marks, of which none follows a backslash; a hash after an ampersand is of an
    entity."""
    return re.split(rf"(?<![\\&]){mark}" if mark == "#" else rf"(?<!\\){mark}", text, maxsplit=most)


def _answer(text, kind):
    worth = re.match(r"=|%(-?\d+(?:[.,]\d*)?)%", text)
    share = 0.0 if worth is None else 1.0 if worth[0] == "=" else float(worth[1].replace(",", ".")) / 100
    answer, *says = _split(text[worth.end() if worth else 0 :], "#", 1)
    told = _decoded(says[0]) if says else ""
    if kind != "NUMERICAL":
        return Answer(share, _decoded(answer), None, told)
    value, _, margin = answer.partition(":")
    assert _NUMBER.fullmatch(value), answer
    assert not margin or _NUMBER.fullmatch(margin), answer
    return Answer(share, value, float(margin or 0), told)


def _decoded(text):
    """Entities once, then the two signs that a backslash keeps."""
    return html.unescape(text).replace(r"\}", "}").replace(r"\#", "#")
