"""A calculator that is set to radians throughout: recognised from a whole sheet, and followed from there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from coursework.course.answer_key import Key
from coursework.marking.usual import last_digit
from coursework.model import Part
from coursework.parsing.reading import Reading

SEVERAL = 2  #: wrong answers at least that such a calculator gives
_SHARE = 0.01  #: of an angle in radians, that rounding on the way may move it


def is_in_radians(key: Key, wrong: Iterable[tuple[Part, Reading]]) -> bool:
    """Return whether a calculator set to radians explains several wrong answers of a sheet.

    Angles alone may be right values in radians: some answer must show a sine or a cosine.
    """
    numbers = [(p, r) for p, r in wrong if p.sort.is_number and r.status == "read"]
    if len(numbers) < SEVERAL:
        return False
    explained = {
        p.quantity: value
        for p, r in numbers
        for value in key.in_radians[p.quantity]
        if fitting(key, p, r, value) is not None
    }
    angles = {p.quantity for p, _ in numbers if p.unit == "deg"}
    return len(explained) >= SEVERAL and any(
        q not in angles or not _is_in_radians(key, q, value) for q, value in explained.items()
    )


def _is_in_radians(key: Key, quantity: str, value: float) -> bool:
    right = math.radians(key.reference[quantity])
    return abs(value - right) <= _SHARE * abs(right)


def values_in_radians(key: Key, quantity: str, own_answers: Mapping[str, Any]) -> list[float]:
    """Return the values of a quantity with a calculator set to radians: computed from the data, and from the
    student's own earlier answers."""
    return [*key.in_radians[quantity], *key.followed_in_radians(quantity, own_answers)]


def fitting(key: Key, part: Part, reading: Reading, value: float) -> int | None:
    """Return the first of an answer's readings that is this value, if any is; of a direction the number: 0.2
    radians are not 1°."""
    reference = key.reference[part.quantity]
    width = key.half_width(part) * (abs(value / reference) if reference else 1.0)
    if part.sort.turn and abs(value) <= 2 * math.pi:
        width = _SHARE * abs(value)
    for index, answer in enumerate(reading.values):
        if answer and abs(answer - value) <= max(width, last_digit(part, answer)):
            return index
    return None
