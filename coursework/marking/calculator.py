"""A calculator that is set to radians throughout: recognised from a whole sheet, and followed from there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from coursework.course.answer_key import Key
from coursework.marking.usual import last_digit
from coursework.model import Part
from coursework.reading.reading import Reading

SEVERAL = 2  #: wrong answers at least that such a calculator gives
_SHARE = 0.01  #: of an angle in radians, that rounding on the way may move it


def is_in_radians(key: Key, wrong: Iterable[tuple[Part, Reading]]) -> bool:
    """Whether several wrong answers of a sheet are what a calculator set to radians gives.

    Angles alone may be right ones told in radians: some answer must show a sine or a cosine.
    """
    numbers = [(p, r) for p, r in wrong if p.sort.is_number and r.status == "read"]
    if len(numbers) < SEVERAL:
        return False
    values = key.in_radians
    shown = [
        p for p, r in numbers if p.quantity in values and fitting(key, p, r, values[p.quantity]) is not None
    ]
    return len(shown) >= SEVERAL and any(not _is_told_in_radians(key, p) for p in shown)


def _is_told_in_radians(key: Key, part: Part) -> bool:
    value = math.radians(key.reference[part.quantity])
    return bool(part.sort.turn) and abs(key.in_radians[part.quantity] - value) <= _SHARE * abs(value)


def values_in_radians(key: Key, quantity: str, own: Mapping[str, Any]) -> Iterable[float]:
    """What such a calculator gives of a quantity: all the way, and from the student's own earlier answers."""
    values = (key.in_radians.get(quantity), key.followed_in_radians(quantity, own))
    return [value for value in values if value is not None]


def fitting(key: Key, part: Part, reading: Reading, value: float) -> int | None:
    """The first of an answer's readings that is this value, if any is. It is no direction: 0.2 radians are not 1 degree."""
    reference = key.reference[part.quantity]
    if part.sort.turn:
        width = _SHARE * abs(value)
    else:
        width = key.half_width(part) * (min(abs(value / reference), 1.0) if reference else 1.0)
    for place, answer in enumerate(reading.values):
        if answer and abs(answer - value) <= max(width, last_digit(part, answer)):
            return place
    return None
