"""Plain right answers, a column at a time: most of what comes back, and the cheapest to mark.

An answer of digits alone, or with the unit as it is printed, that lies within its part's own margin is right whatever else the student wrote.
Everything else is left to :mod:`coursework.marking.marking`, whose marks these are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from coursework.course.exercise import CourseExercise
from coursework.course.key_batch import Batch
from coursework.parsing.numbers import read_numbers

_SHOWN_OTHERWISE = {"*"}  #: what the echo of a unit has another sign for


def plainly_right(
    exercise: CourseExercise, batch: Batch, answers: Sequence[tuple[int, Mapping[str, Any]]]
) -> list[dict[str, str]]:
    """Return the right answers of each sheet by part, as they were read: ``12,5`` as ``12.5``; each sheet comes with the place
    of its variant in the batch."""
    places = [place for place, _ in answers]
    right: list[dict[str, str]] = [{} for _ in answers]
    exchangeable = {i for group in exercise.spec.either_order for i in group}
    for part in exercise.spec.parts:
        column = batch.reference.get(part.quantity)
        by_value = part.sort.marks_columns() and not part.judge
        if not by_value or part.id in exchangeable or not column:
            continue
        has_printed = part.unit != "1" and not _SHOWN_OTHERWISE & {*part.unit}
        unit = f" {part.unit}" if has_printed else ""
        written = [sheet.get(part.id) for _, sheet in answers]
        texts = [t.removesuffix(unit) if unit and isinstance(t, str) else t for t in written]
        values, _ = read_numbers(texts, part.unit)
        reference = np.asarray(column, dtype=float)[places]
        half_width = np.maximum(part.atol, part.rtol * np.abs(reference))
        for i in np.flatnonzero(part.sort.accepted(values, reference, half_width)):
            text = texts[i]
            if isinstance(text, str) and (text is not written[i] or not part.asks_unit):
                unit_written = unit if text is not written[i] else ""
                right[i][part.id] = text.strip().replace(",", ".") + unit_written
    return right
