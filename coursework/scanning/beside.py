"""Writing where nothing is printed: beside the boxes of a row, such as a ring or another unit; below all
rows, an answer in the wrong place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from coursework.scanning.straightening import SCALE, Straight
from coursework.scanning.strokes import STRONG, part_of, pieces, row_ink
from coursework.sheets.answer_pages import AnswerField, AnswerPage, Box

_LEAST = 0.6  #: mm2 of one piece of ink where nothing is printed
_ROW = 1.2  #: mm from a row's upper and lower end, as far as ink of its neighbours may reach
_BOX = 0.8  #: mm from the outline of a box
_INSIDE = 0.7  #: mm within an outline, ink that is written in the box
_LABEL, _NONE = 7.0, 19.0  #: mm behind a box to tick, which a letter takes, and the word for none
_WIDE, _SIGN = 2.8, 1.8  #: mm, letters of a unit: m and w, and the others
_NARROW = 2.5  #: mm, a place where nobody writes
_BELOW = {"drawing": 10.0}  #: mm below a field within which something is printed, or two
#: Least and greatest height of writing, and its greatest length, mm.
_SMALL, _TALL, _LONG = (1.8, 15.0, 60.0)
_MARK = 6.0  #: mm from the middle of a black square to where paper is white
_WRITING = 1.5  #: mm2 of it, less than a digit has


def written_beside(page: Straight, field: AnswerField) -> bool:
    """Return True if ink lies beside the boxes of a row and is not part of the writing in them."""
    boxes = boxes_of(field)
    ink, span = row_ink(page, boxes, within=field.whole)
    connected = pieces(255 - ink > STRONG)
    pixel_counts = np.zeros(len(connected.areas), int)
    for bare in _bare(field):
        pixel_counts += connected.inside(part_of(connected.labels, bare, span))
    for box in boxes:
        pixel_counts[connected.inside(part_of(connected.labels, box, span, _INSIDE)) > 0] = 0
    return bool((pixel_counts[1:] > _LEAST * SCALE**2).any())


def written_below(page: Straight, sheet: AnswerPage) -> bool:
    """Return True if there is ink of the size of writing below all rows, where nothing is printed; a stain or
    a fold is larger."""
    top = max(field.whole.bottom + _BELOW.get(field.what, 2.0) for field in sheet.fields)
    corners = [corner for corner in sheet.marks if corner[1] > sheet.height / 2]
    left, right = (end(x for x, _ in corners) for end in (min, max))
    bottom = min(y for _, y in corners) - _MARK
    if bottom - top < _TALL:
        return False
    connected = pieces(255 - page.cut(Box(left, top, right - left, bottom - top)) > STRONG)
    wide, high = connected.boxes[1:, 2] / SCALE, connected.boxes[1:, 3] / SCALE
    is_writing = (high >= _SMALL) & (high <= _TALL) & (wide <= _LONG)
    return float(connected.areas[1:][is_writing].sum()) >= _WRITING * SCALE**2


def boxes_of(field: AnswerField) -> list[Box]:
    """Return the boxes of a row that are filled in, without the one for words."""
    row = (field.sign, *field.digits, *field.decimals, field.power_sign, *field.power, field.unit)
    return [box for box in (*row, *(box for _, box in field.ticks)) if box is not None]


def _bare(field: AnswerField) -> Iterator[Box]:
    """Yield the areas of a row in which nothing is printed."""
    if field.ticks:
        yield from _about_ticks(field, [box for _, box in field.ticks])
    if field.free is not None:
        left = _printed_to(field)
        if field.free.x - _BOX - left > _NARROW:
            yield Box(left, field.free.y + 0.5, field.free.x - _BOX - left, field.free.height - 1.0)


def _printed_to(field: AnswerField) -> float:
    """Return the right end of the print in a row's first line at most, mm from the left of the page."""
    if field.ticks:
        lines = {box.y: box.right for _, box in field.ticks}
        return lines[min(lines)] + (_NONE if field.none else _LABEL)
    if field.unit is not None:
        wide = sum(_WIDE if letter in "mwMW" else _SIGN for letter in field.unit_text)
        return field.unit.right + 1.6 + wide
    if field.asks_unit and field.free is not None:
        return field.free.x
    return max(box.right for box in boxes_of(field)) + 2.0


def _about_ticks(field: AnswerField, boxes: Sequence[Box]) -> Iterator[Box]:
    """Above and below each line of boxes to tick, and of the letters behind them."""
    for line in sorted({box.y for box in boxes}):
        row = [box for box in boxes if box.y == line]
        top, bottom = field.whole.y + _ROW, field.whole.bottom - _ROW
        others = [box for box in boxes if box.y != line]
        top = max([top, *(box.bottom + _BOX for box in others if box.y < line)])
        bottom = min([bottom, *(box.y - _BOX for box in others if box.y > line)])
        for box, after in pairwise([*row, Box(row[-1].right + _LABEL, line, 0.0, 0.0)]):
            yield from _between(top, box.y - _BOX, box.x, box.right)
            yield from _between(box.bottom + _BOX, bottom, box.x, box.right)
            yield from _between(top, box.y + 0.1, box.right + 0.9, after.x - 0.6)
            yield from _between(box.bottom - 0.1, bottom, box.right + 0.9, after.x - 0.6)


def _between(top: float, bottom: float, left: float, right: float) -> Iterator[Box]:
    if bottom > top and right > left:
        yield Box(left, top, right - left, bottom - top)
