"""Plain right answers, a column at a time: most of what comes back, and the cheapest to mark.

An answer of digits alone, or with the unit as it is printed, that lies within its part's own margin is right
whatever else the student wrote. Everything else is left to :mod:`coursework.marking.marking`, whose marks
these are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.course.exercise import CourseExercise
from coursework.model import Part
from coursework.parsing.numbers import read_numbers

if TYPE_CHECKING:
    from coursework.course.variant import Variant

_SHOWN_OTHERWISE = {"*"}  #: what the echo of a unit has another sign for


def plainly_right(sheets: Sequence[tuple[Variant, Mapping[str, Any]]]) -> list[dict[str, str]]:
    """Return the right answers of each sheet by part, as they were read: ``12,5`` as ``12.5``. The columns
    are those of sheets of one exercise whose keys were computed together."""
    right: list[dict[str, str]] = [{} for _ in sheets]
    places: dict[CourseExercise, list[int]] = {}
    for place, (variant, _) in enumerate(sheets):
        if variant.key.is_of_batch:
            places.setdefault(variant.exercise, []).append(place)
    for exercise, rows in places.items():
        exchangeable = exercise.spec.exchangeable
        for part in exercise.spec.parts:
            if part.sort.marks_columns() and not part.judge and part.id not in exchangeable:
                for row, text in _right(part, [sheets[row] for row in rows]):
                    right[rows[row]][part.id] = text
    return right


def _right(part: Part, sheets: Sequence[tuple[Variant, Mapping[str, Any]]]) -> Iterator[tuple[int, str]]:
    """Yield the places of the sheets whose answer to a part is right, with what was read."""
    has_printed = part.unit != "1" and not _SHOWN_OTHERWISE & {*part.unit}
    unit = f" {part.unit}" if has_printed else ""
    written = [answers.get(part.id) for _, answers in sheets]
    texts = [t.removesuffix(unit) if unit and isinstance(t, str) else t for t in written]
    values, _ = read_numbers(texts, part.unit)
    reference = np.array([variant.key.reference.get(part.quantity, np.nan) for variant, _ in sheets], float)
    half_width = np.maximum(part.atol, part.rtol * np.abs(reference))
    for i in np.flatnonzero(part.sort.accepted(values, reference, half_width)):
        text = texts[i]
        if isinstance(text, str) and (text is not written[i] or not part.asks_unit):
            unit_written = unit if text is not written[i] else ""
            yield int(i), text.strip().replace(",", ".") + unit_written
