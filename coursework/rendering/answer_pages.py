"""Answer pages as Typst: what their template places, and where their layout says."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from markupsafe import Markup

from coursework.language.words import words
from coursework.markup import markdown as markup
from coursework.rendering.codes import qr_svg
from coursework.sheets.answer_pages import LEFT, AnswerField, AnswerPage, Box, code_text
from coursework.sheets.sheet import Handout

Writes = Callable[[str, dict[str, Any]], str]  #: renders a template with these names


def names(handouts: Sequence[Handout], title: str, student: str, lang: str, write: Writes) -> dict[str, Any]:
    """Return the variables for the template of a sheet's or a paper's answer pages: the code of the
    statement's pages, and the answer pages as source text."""
    pages = handouts[0].answer_pages if handouts else ()
    if not pages:
        return {"scanned": False}
    variables = {
        "lang": lang,
        "words": words(lang),
        "called": title,
        "student": student,
        "left": LEFT,
        "titles": [handout.title for handout in handouts],
    }
    return {
        "scanned": True,
        "statement_code": statement_code(pages),
        "answer_bodies": [
            Markup(write("parts/answer_page.typ.j2", variables | {"page": page})) for page in pages
        ],
    }


def statement_code(pages: Sequence[AnswerPage]) -> str:
    """Return the code on the pages of the statement, which says that nothing is to be read there."""
    _, code, _ = pages[0].code_text.split()
    return code_text(code, 0, len(pages))


def filters() -> dict[str, Callable[..., Any]]:
    """Return the filters with which the template asks for the layout."""
    return {"mm": _mm, "qr": lambda text: f"bytes({markup.typst_string(qr_svg(text))})"}


def queries() -> dict[str, Callable[..., Any]]:
    """Return the functions with which the template asks about the layout."""
    return {"drawn_on": _drawn_on, "span": _span, "cells": _cells, "ticked": _ticked, "captions": _captions}


def _mm(length: float | Box | Sequence[Any]) -> str:
    """Return a length, a box or a point, or several of them, as Typst's numbers."""
    if isinstance(length, (int, float)):
        return f"{length:.3f}".rstrip("0").rstrip(".")
    if isinstance(length, Box):
        length = (length.x, length.y, length.width, length.height)
    return f"({''.join(f'{_mm(item)}, ' for item in length)})"


def _drawn_on(sheet: Handout) -> int:
    """Return the answer page that holds the paper which an exercise is drawn on."""
    return next(
        page.number
        for page in sheet.answer_pages
        for field in page.fields
        if field.exercise == sheet.exercise and not field.part
    )


def _span(boxes: Sequence[Box]) -> Box:
    """Of boxes side by side, all of them as one."""
    first = boxes[0]
    return Box(first.x, first.y, boxes[-1].right - first.x, first.height)


def _cells(field: AnswerField) -> tuple[Box, ...]:
    """Return the boxes of a row that are filled in one by one."""
    signs = (field.sign, *field.digits, *field.decimals, field.power_sign, *field.power)
    return (*(box for box in signs if box), *(box for _, box in field.ticks))


def _ticked(field: AnswerField) -> Iterator[tuple[str, Box]]:
    """Yield each box to tick, after the text that is printed beside it."""
    return zip(field.printed, (box for _, box in field.ticks), strict=True)


def _captions(page: AnswerPage) -> Iterator[tuple[str, float, float, float]]:
    """Yield the words above the columns of a page's boxes: name, place and width."""
    rows = [field for field in page.fields if field.what == "number"]
    if page.captions is None:
        return
    widest = max(rows, key=lambda row: len(row.decimals))
    columns = {"sign": widest.sign, "digits": _span(widest.digits), "free": widest.free}
    if widest.decimals:
        columns["decimals"] = _span(widest.decimals)
    if widest.power_sign:
        columns |= {"power_sign": widest.power_sign, "power": _span(widest.power)}
    if unit := next((row.unit for row in rows if row.unit), None):
        columns["unit"] = Box(unit.x - 1.5, unit.y, 8.0, unit.height)
    for name, box in columns.items():
        if box is not None:
            yield name, box.x, page.captions.y, box.width
