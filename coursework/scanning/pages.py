"""A picture to what its page says: which page it is, each answer on it, and what waits for a person, and
why."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from coursework.scanning.beside import written_below, written_beside
from coursework.scanning.codes import PageCode, codes_in
from coursework.scanning.numbers import LEAST, FieldText, Reader, numbers
from coursework.scanning.outlines import span_of
from coursework.scanning.pictures import PageImage, is_two_toned, opencv, without_streaks
from coursework.scanning.straightening import NotStraight, Straight, straightened
from coursework.scanning.strokes import is_bare
from coursework.scanning.ticks import TAKEN_BACK, TICKED, UNSURE, tick
from coursework.sheets.answer_pages import AnswerField, AnswerPage

_CODE = re.compile(r"CW1 ([A-Z2-7]+) (\d+)/(\d+)")
#: Times must a box be in black and white, where a gap of a stroke closes and an open 4 looks like a 6.
_SURER = 10

#: What a picture may be found to be.
FOUND = ("answers", "statement", "no code", "no sheet", "other assignment", "two pages", "not straight")
#: Why an answer may wait for a person.
WAITS = (
    *("free", "struck", "joined", "digit", "doubted", "sign", "gap", "comma", "power", "unit"),
    *("tick", "two ticks", "taken back", "written", "drawing", "elsewhere"),
)


@dataclass(frozen=True)
class FieldRead:
    """Reading of one field: its ``text`` (empty for a blank answer) and the least ``confidence`` of its
    boxes. If a person must look, ``waits`` is the key of the reason (of :data:`WAITS`), ``crop`` is the
    picture, grey, 10 pixels per mm, and the text is only the likeliest reading; ``candidates`` are what a
    doubted number may be, with probabilities. ``cases`` are the ticked choices."""

    field: AnswerField
    text: str
    confidence: float
    waits: str = ""
    cases: tuple[str, ...] = ()
    crop: np.ndarray | None = None
    candidates: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class PageRead:
    """Result of a picture: ``found`` is a word of :data:`FOUND`; ``code`` is the text of its code, if one was
    read; ``fields`` are the readings of ``page``; ``grey`` is the page, flattened if possible."""

    file: str
    number: int
    found: str
    grey: np.ndarray
    code: str = ""
    page: AnswerPage | None = None
    fields: tuple[FieldRead, ...] = ()


def read_page(
    picture: PageImage, papers: Mapping[str, Sequence[AnswerPage]], reader: Reader, least: float = LEAST
) -> PageRead:
    """Return the reading of a picture, compared with the answer pages of each paper by its code.

    ``reader`` reads digits; what is read of a box with less confidence than ``least`` waits for a person.
    """
    codes = codes_in(picture.grey)
    ours = [code for code in codes if _CODE.fullmatch(code.text)]
    if len(ours) != 1:
        reason = "two pages" if ours else "no sheet" if codes else "no code"
        texts = " ".join(code.text for code in ours or codes)
        return PageRead(picture.file, picture.page, reason, picture.grey, texts)
    return _of_ours(picture, ours[0], papers, reader, least)


def _of_ours(
    picture: PageImage,
    code: PageCode,
    papers: Mapping[str, Sequence[AnswerPage]],
    reader: Reader,
    least: float,
) -> PageRead:
    paper, page_number, _ = _CODE.fullmatch(code.text).groups()  # type: ignore[union-attr]
    pages = {page.number: page for page in papers.get(paper, ())}

    def page_read(reason: str, page: AnswerPage | None = None) -> PageRead:
        return PageRead(picture.file, picture.page, reason, picture.grey, code.text, page)

    if not pages:
        return page_read("other assignment")
    if int(page_number) == 0:
        return page_read("statement")
    page = pages.get(int(page_number))
    if page is None or page.code_text != code.text:
        return page_read("other assignment")
    try:
        flat = straightened(without_streaks(picture.grey), code, page)
    except NotStraight:
        return page_read("not straight", page)
    if is_two_toned(picture.grey):
        least = 1 - (1 - least) / _SURER
    fields = read_fields(flat, page.fields, reader, least)
    if any(_is_blank(item) for item in fields) and written_below(flat, page):
        fields = tuple(_gone_astray(flat, item) if _is_blank(item) else item for item in fields)
    return PageRead(picture.file, picture.page, "answers", flat.paper, code.text, page, fields)


def _is_blank(field: FieldRead) -> bool:
    return not field.waits and not field.text and not field.cases


def _gone_astray(page: Straight, field: FieldRead) -> FieldRead:
    """Return the reading of a blank field on a page with writing elsewhere, which may be its answer."""
    return replace(field, confidence=0.0, waits="elsewhere", crop=cropped(page, field.field))


def read_fields(
    page: Straight, fields: Sequence[AnswerField], reader: Reader, least: float = LEAST
) -> tuple[FieldRead, ...]:
    """Return the readings of the fields on a flattened page."""
    read = iter(numbers(page, [field for field in fields if field.what == "number"], reader, least))
    return tuple(
        _field_read(page, field, next(read) if field.what == "number" else _mark(page, field))
        for field in fields
    )


def _field_read(page: Straight, field: AnswerField, read: FieldText) -> FieldRead:
    crop = cropped(page, field) if read.waits else None
    return FieldRead(field, read.text, read.confidence, read.waits, read.cases, crop, read.candidates)


def _mark(page: Straight, field: AnswerField) -> FieldText:
    """Return the reading of ticks; for texts and drawings, only whether there is ink."""
    if field.what == "ticks":
        return _ticks(page, field)
    return FieldText("", waits="" if is_bare(page, field.whole, 1.2) else field.what)


def _ticks(page: Straight, field: AnswerField) -> FieldText:
    """Return the reading of tick boxes: one choice, or several if allowed, but none together with others."""
    states = {case: tick(page, box) for case, box in field.ticks}
    cases = tuple(case for case, word in states.items() if word == TICKED)
    waits = (
        ("free", field.free is not None and not is_bare(page, field.free, 0.7)),
        ("free", written_beside(page, field)),
        ("tick", UNSURE in states.values()),
        ("two ticks", len(cases) > 1 and (not field.several or field.none in cases)),
        ("taken back", not cases and TAKEN_BACK in states.values()),
    )
    word = next((word for word, is_so in waits if is_so), "")
    return FieldText(", ".join(cases), 0.0 if word in ("free", "tick") else 1.0, word, cases)


def cropped(page: Straight, field: AnswerField) -> np.ndarray:
    """Return the picture of a field for a person: its place, to scale, with a margin."""
    return page.cut(span_of([field.whole], 2.0), of=page.paper).copy()


def encoded(crop: np.ndarray) -> bytes:
    """Return a picture as PNG."""
    cv2 = opencv()
    return bytes(cv2.imencode(".png", crop)[1])


__all__ = ["FOUND", "WAITS", "FieldRead", "PageRead", "cropped", "encoded", "read_fields", "read_page"]
