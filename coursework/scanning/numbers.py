"""Rows of boxes to numbers: sign, digits, decimals, power of ten, unit.

The rules, for a row that is not empty:

- anything in the free box or beside the boxes, a stroke across boxes, a box that is not surely empty or one
  digit: a person reads it;
- the digits before the comma stand together, at the start of their boxes or at its end, none missing between;
- the decimals stand together from the comma on, and only after a digit before it;
- nothing runs through a box from above it to below, as the edge of a shadow does;
- a one between digits does not lean as the bar of a fraction does, unless the number is the right answer;
- a sign is one level stroke, and stands before digits; so does that of the power; a power stands after
  digits;
- the unit is said where its box is ticked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from coursework.scanning.beside import written_beside
from coursework.scanning.digits import CONFIDENT, LIKELY
from coursework.scanning.straightening import SCALE, Straight
from coursework.scanning.strokes import (
    STRONG,
    cells,
    cuts_a_corner,
    has_stroke,
    is_bare,
    pieces,
    runs_through,
)
from coursework.scanning.ticks import EMPTY, TICKED, UNSURE, tick
from coursework.sheets.answer_pages import AnswerField, Box

#: Pictures of boxes of one person ``(n, h, w)``, dark ink on light, to digits, -1 for an empty one, the
#: confidence in each, and if the reader can tell, the probability of each digit from 0 to 9, ``(n, 10)``.
Reader = Callable[[np.ndarray], tuple[np.ndarray, ...]]

LEAST = CONFIDENT  #: the confidence in a box below which a person reads it
_DASH, _UPRIGHT = 1.1, 2.0  #: mm, the least length of a minus sign, and of a stroke of a digit
_THIN, _LEAN = 0.15, 16.0  #: of a fraction's bar: its breadth to its length, and degrees from upright
_LIKE_EDGES = (1, 7)  #: digits for which the edge of a stain may be taken
_CELL = (90, 70)  #: pixels of a box that is handed to the reader
#: Least probability of a digit, and number of texts, that a doubted number may be.
_POSSIBLE, _CANDIDATES = (0.01, 24)


@dataclass(frozen=True)
class FieldText:
    """Reading of a field: its ``text``, the least ``confidence`` of its boxes, the reason for which it waits
    for a person, if any, and the ticked ``cases``.

    The text of what waits is what it looks like, for a person to confirm. If only the confidence is too low,
    ``candidates`` are the texts that it may be, the likeliest first, with their probabilities.
    """

    text: str
    confidence: float = 1.0
    waits: str = ""
    cases: tuple[str, ...] = ()
    candidates: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class _ReadNumber:
    """One box as read: its digit, -1 for an empty one, the confidence in it, and the digits that it may
    be."""

    digit: int = -1
    confidence: float = 1.0
    possible: tuple[tuple[int, float], ...] = ((-1, 1.0),)


@dataclass(frozen=True)
class _Row:
    """The boxes of a field as read: -1 empty, 0 to 9, and what the signs and the unit say."""

    digits: tuple[int, ...]
    decimals: tuple[int, ...]
    power: tuple[int, ...]
    sign: str
    power_sign: str
    unit: str


@dataclass(frozen=True)
class _Ink:
    """Boxes of a field before their digits are read: which are ``bare``, the tick of the unit, a picture of
    each box for a digit, and the reason for which a person reads them, if any."""

    field: AnswerField
    bare: dict[Box, bool]
    unit: str
    pictures: dict[Box, np.ndarray]
    waits: str = ""


def numbers(
    page: Straight, fields: Iterable[AnswerField], reader: Reader, least: float = LEAST
) -> list[FieldText]:
    """Return the readings of the fields for numbers of a page.

    The reader gets the boxes of all fields at once, since one person wrote them; also those of fields that
    wait for a person because something crosses their boxes.
    """
    inks = [_ink(page, field) for field in fields]
    boxes = _digits(inks, reader)
    return [_number(page, ink, boxes, least) for ink in inks]


def _ink(page: Straight, field: AnswerField) -> _Ink:
    """Return what the boxes of a field show; no pictures if there are no digits to read."""
    if field.free is not None and not is_bare(page, field.free, 0.7):
        return _Ink(field, {}, EMPTY, {}, "free")
    rows = ([*field.digits, *field.decimals], list(field.power))
    signs = tuple(box for box in (field.sign, field.power_sign) if box is not None)
    bare = {box: _is_bare(page, box, _DASH if box in signs else _UPRIGHT) for box in (*signs, *chain(*rows))}
    unit = tick(page, field.unit) if field.unit is not None else EMPTY
    if all(bare.values()):
        return _Ink(field, bare, unit, {})
    waits = "digit" if any(runs_through(page, box) for box, empty in bare.items() if not empty) else ""
    pictures: dict[Box, np.ndarray] = {}
    for row in filter(None, rows):
        views, fault = cells(page, row)
        waits = waits or fault
        pictures |= zip(row, views, strict=True)
    return _Ink(field, bare, unit, pictures, waits)


def _is_bare(page: Straight, box: Box, stroke: float) -> bool:
    """Return True if a box is certainly empty, even of short strokes, since the whole of a sign may be
    one."""
    return is_bare(page, box) and not has_stroke(page, box, stroke)


def _digits(inks: Iterable[_Ink], reader: Reader) -> dict[Box, _ReadNumber]:
    """Return each box that is not bare as read; a box without a digit has confidence 0."""
    pictures = {box: picture for ink in inks for box, picture in ink.pictures.items() if not ink.bare[box]}
    if not pictures:
        return {}
    read, sure, *chances = reader(np.stack([framed(picture) for picture in pictures.values()]))
    found = {}
    for place, box in enumerate(pictures):
        digit, confidence = int(read[place]), float(sure[place])
        possible = list(enumerate(chances[0][place].tolist())) if chances else [(digit, confidence)]
        found[box] = _ReadNumber(
            digit,
            confidence if digit >= 0 else 0.0,
            tuple(each for each in possible if each[1] >= _POSSIBLE) if digit >= 0 else (),
        )
    return found


def _number(page: Straight, ink: _Ink, boxes: Mapping[Box, _ReadNumber], least: float) -> FieldText:
    """Return the reading of a field, given the boxes of the page as read."""
    if ink.waits == "free":
        return FieldText("", 0.0, "free")
    if all(ink.bare.values()):
        read = FieldText("", 1.0, "" if ink.unit in (EMPTY, TICKED) else "unit")
    else:
        own = {box: _ReadNumber() if ink.bare[box] else boxes[box] for box in ink.pictures}
        read = _written(page, ink, own, least)
    if read.waits not in ("", "doubted") or not written_beside(page, ink.field):
        return read
    return replace(read, waits="free", candidates=())


def _written(page: Straight, ink: _Ink, boxes: Mapping[Box, _ReadNumber], least: float) -> FieldText:
    """Return the reading of a row that is not empty."""
    field = ink.field
    has_bar = any(
        _has_bar([ink.pictures[box] for box in row], [boxes[box].digit for box in row])
        for row in ((*field.digits, *field.decimals), field.power)
    )
    reason = ink.waits
    if not reason and any(
        one.digit in _LIKE_EDGES and cuts_a_corner(page, box)
        for box, one in boxes.items()
        if not ink.bare[box]
    ):
        reason = "digit"
    signs = (_sign(page, field.sign, ink.bare), _sign(page, field.power_sign, ink.bare))
    row_read = _row([one.digit for one in boxes.values()], field, signs, ink.unit)
    confidence = min((one.confidence for one in boxes.values()), default=1.0)
    reason = reason or _against_rules(row_read)
    if reason or (confidence >= least and not has_bar):
        return FieldText(_text(row_read, field.unit_text), confidence, reason)
    candidates = tuple(
        (_text(_row(digits, field, signs, ink.unit), field.unit_text), chance)
        for digits, chance in _likeliest([one.possible for one in boxes.values()])
    )
    if sum(chance for _, chance in candidates) < LIKELY:
        return FieldText(_text(row_read, field.unit_text), confidence, "digit")
    return FieldText(_text(row_read, field.unit_text), confidence, "doubted", (), candidates)


def _row(digits: Sequence[int], field: AnswerField, signs: tuple[str, str], unit: str) -> _Row:
    """Return a row of which the digits, the decimals and the power are read one after the other."""
    point, end = len(field.digits), len(field.digits) + len(field.decimals)
    return _Row(tuple(digits[:point]), tuple(digits[point:end]), tuple(digits[end:]), *signs, unit)


def _likeliest(
    possible: Iterable[Sequence[tuple[int, float]]],
) -> list[tuple[tuple[int, ...], float]]:
    """Return what boxes may say together, the likeliest first, with its probability."""
    found: list[tuple[tuple[int, ...], float]] = [((), 1.0)]
    for one in possible:
        longer = [((*digits, digit), before * chance) for digits, before in found for digit, chance in one]
        found = sorted(longer, key=lambda each: -each[1])[:_CANDIDATES]
    return found


def _has_bar(pictures: Sequence[np.ndarray], digits: Sequence[int]) -> bool:
    """Return True if a one between two digits leans like the bar of a fraction: ``1/3`` is not 113."""
    between = zip(digits, digits[1:], digits[2:], strict=False)
    return any(
        column == 1 and min(before, after) >= 0 and _leans(pictures[k])
        for k, (before, column, after) in enumerate(between, start=1)
    )


def _leans(picture: np.ndarray) -> bool:
    """Return True if the ink is one straight stroke that leans to the right."""
    y, x = np.nonzero(255 - picture > STRONG)
    if len(x) < SCALE:
        return False
    spread, along = np.linalg.eigh(np.cov(x, y))
    dx, dy = along[:, 1] * (np.sign(along[1, 1]) or 1.0)
    is_straight = spread[0] < (_THIN * spread[1] ** 0.5) ** 2
    return bool(is_straight and np.degrees(np.arctan2(-dx, dy)) > _LEAN)


def framed(picture: np.ndarray) -> np.ndarray:
    """Return a box at the common size, padded with paper."""
    high, wide = _CELL
    cell = np.full(_CELL, 255, np.uint8)
    piece = picture[:high, :wide]
    cell[: piece.shape[0], : piece.shape[1]] = piece
    return cell


def _sign(page: Straight, box: Box | None, bare: dict[Box, bool]) -> str:
    """Return ``-`` for one level stroke in the box of a sign, an empty text for an empty box, ``?``
    otherwise."""
    if box is None or bare[box]:
        return ""
    (picture,), _ = cells(page, [box])
    ink = pieces(255 - picture > STRONG)
    strokes = ink.boxes[1:][ink.areas[1:] > 0.3 * SCALE**2]
    if len(strokes) != 1:
        return "?"
    _, top, width, height = (int(v) for v in strokes[0])
    middle = (top + height / 2) / picture.shape[0]
    level = width > 1.7 * SCALE and height < 0.45 * width and height < 2.2 * SCALE
    return "-" if level and 0.15 < middle < 0.85 else "?"


def _against_rules(row: _Row) -> str:
    """Return the key of the first rule that a row breaks; empty if there is none."""
    broken = (
        ("sign", "?" in (row.sign, row.power_sign)),
        ("unit", row.unit not in (EMPTY, TICKED)),
        ("comma", not _any(row.digits)),
        ("gap", not _stands_together(row.digits) or _gap(row.decimals) or not _stands_together(row.power)),
        ("power", bool(row.power_sign) and not _any(row.power)),
    )
    return next((word for word, is_broken in broken if is_broken), "")


def _any(boxes: Sequence[int]) -> bool:
    return any(digit >= 0 for digit in boxes)


def _gap(boxes: Sequence[int]) -> bool:
    """Return True if an empty box precedes a digit."""
    filled = [digit >= 0 for digit in boxes]
    return filled != sorted(filled, reverse=True)


def _stands_together(boxes: Sequence[int]) -> bool:
    """Return True if the digits fill the first boxes, or the last ones, without a gap."""
    return not _gap(boxes) or not _gap(boxes[::-1])


def _text(row: _Row, unit: str) -> str:
    """Return the number as it is typed."""

    def joined(boxes: Sequence[int]) -> str:
        return "".join(str(digit) for digit in boxes if digit >= 0)

    decimals = f".{joined(row.decimals)}" if _any(row.decimals) else ""
    power = f"e{row.power_sign}{joined(row.power)}" if _any(row.power) else ""
    suffix = f" {unit}" if row.unit == TICKED and unit else ""
    return f"{row.sign}{joined(row.digits)}{decimals}{power}{suffix}".replace("?", "")


__all__ = ["LEAST", "UNSURE", "FieldText", "Reader", "numbers"]
