"""Plain right answers, a column at a time: most of what comes back, and the cheapest to mark.

An answer of digits alone that lies within its part's own margin is right whatever else the student wrote.
Everything else is left to :mod:`coursework.marking.marking`, whose marks these are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from coursework.course.exercise import CourseExercise
from coursework.course.key_batch import Batch
from coursework.kinds.nearness import SLACK
from coursework.model import Part
from coursework.reading.numbers import read_numbers


def plainly_right(
    exercise: CourseExercise, batch: Batch, answers: Sequence[Mapping[str, Any]]
) -> list[dict[str, str]]:
    """For each variant of the batch, its right answers by part, as they were read: ``12,5`` as ``12.5``."""
    found: list[dict[str, str]] = [{} for _ in answers]
    exchangeable = {i for group in exercise.spec.either_order for i in group}
    for part in exercise.spec.parts:
        column = batch.reference.get(part.quantity)
        by_value = part.sort.is_number and not part.judge
        if not by_value or part.asks_unit or part.id in exchangeable or not column:
            continue
        texts = [sheet.get(part.id) for sheet in answers]
        values, _ = read_numbers(texts, part.unit)
        for i in np.flatnonzero(_within(part, values, np.asarray(column, dtype=float))):
            text = texts[i]
            if isinstance(text, str):
                found[i][part.id] = text.strip().replace(",", ".")
    return found


def _within(part: Part, values: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Which values are accepted, the boundary inclusive up to rounding; never where one is NaN.

    The rule is that of :meth:`coursework.kinds.kind.Kind.distance`, which takes one value at a time; here a
    whole column is compared at once.
    """
    size = np.abs(reference)
    half_width = np.maximum(part.atol, part.rtol * size)
    with np.errstate(invalid="ignore"):
        gap = values - reference
        if turn := part.sort.turn:
            gap, size = gap - turn * np.rint(gap / turn), np.full_like(size, turn)
        return np.abs(gap) <= half_width + SLACK * np.maximum(half_width, size)
