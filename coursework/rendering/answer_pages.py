"""Answer pages as Typst: what their template places, and where their layout says."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from markupsafe import Markup

from coursework.language.words import words
from coursework.markup import markdown as markup
from coursework.rendering.codes import qr_svg
from coursework.sheets.answer_pages import LEFT, AnswerPage, Box, Field, code_text
from coursework.sheets.sheet import Handout

Writes = Callable[[str, dict[str, Any]], str]  #: renders a template with these names


def names(handouts: Sequence[Handout], called: str, student: str, lang: str, write: Writes) -> dict[str, Any]:
    """What the template of a sheet or a paper sees of its answer pages: the code of its own pages, and theirs, written out."""
    pages = handouts[0].answer_pages if handouts else ()
    if not pages:
        return {"scanned": False}
    told = {
        "lang": lang,
        "words": words(lang),
        "called": called,
        "student": student,
        "left": LEFT,
        "titles": [handout.title for handout in handouts],
    }
    return {
        "scanned": True,
        "statement_code": statement_code(pages),
        "answer_bodies": [Markup(write("_answer_page.typ.j2", told | {"page": page})) for page in pages],
    }


def statement_code(pages: Sequence[AnswerPage]) -> str:
    """What the code on the pages of the statement says: that nothing is to be read there."""
    _, code, _ = pages[0].code_text.split()
    return code_text(code, 0, len(pages))


def filters() -> dict[str, Callable[..., Any]]:
    """What the template asks of a layout."""
    return {"mm": _mm, "qr": lambda text: f"bytes({markup.typst_string(qr_svg(text))})"}


def queries() -> dict[str, Callable[..., Any]]:
    """What the template asks of a layout that is no text."""
    return {"drawn_on": _drawn_on, "span": _span, "cells": _cells, "ticked": _ticked, "captions": _captions}


def _mm(told: float | Box | Sequence[Any]) -> str:
    """A length, a box or a point, or several of them, as Typst's numbers."""
    if isinstance(told, (int, float)):
        return f"{told:.3f}".rstrip("0").rstrip(".")
    if isinstance(told, Box):
        told = (told.x, told.y, told.width, told.height)
    return f"({''.join(f'{_mm(one)}, ' for one in told)})"


def _drawn_on(sheet: Handout) -> int:
    """The answer page that holds the paper which an exercise is drawn on."""
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


def _cells(field: Field) -> tuple[Box, ...]:
    """The boxes of a row that are filled in one by one."""
    signs = (field.sign, *field.digits, *field.decimals, field.power_sign, *field.power)
    return (*(box for box in signs if box), *(box for _, box in field.ticks))


def _ticked(field: Field) -> Iterator[tuple[str, Box]]:
    """What is printed beside each box to tick, and the box."""
    return zip(field.printed, (box for _, box in field.ticks), strict=True)


def _captions(page: AnswerPage) -> Iterator[tuple[str, float, float, float]]:
    """The words above the columns of a page's boxes: name, place and width."""
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
