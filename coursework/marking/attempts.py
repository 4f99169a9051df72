"""From which wrong answers a right method may go on: from attempts, and from no number that is written everywhere.

Whoever writes one number in every box, or numbers far from any that could be meant, follows no method, though such
answers may agree with each other.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from coursework.course.answer_key import Key
from coursework.model import Part
from coursework.reading.reading import Reading

FARTHEST = 100.0  #: factor between the size of an attempt and that of the reference, unless a known error explains it
EVERYWHERE = 3  #: different things that one number is written for


def is_attempt(part: Part, value: Any, reference: Any, *, is_explained: bool) -> bool:
    """Whether a wrong answer is of a size that somebody may have computed."""
    if isinstance(value, str) or isinstance(reference, str) or is_explained or part.sort.turn:
        return True
    if isinstance(value, tuple):
        return True
    size, expected = (float(np.max(np.abs(np.asarray(v)))) for v in (value, reference))
    if not math.isfinite(size):
        return False
    if part.sort.is_exact:
        return size <= FARTHEST * max(expected, 1.0)
    if not expected:
        return True
    return expected / FARTHEST <= size <= FARTHEST * expected


def written_everywhere(parts: Mapping[str, Part], readings: Mapping[str, Reading], key: Key) -> set[float]:
    """The numbers that a student wrote for so many different things, or for all there were."""
    asked: dict[float, set[str]] = {}
    answered = 0
    for i, reading in readings.items():
        part = parts[i]
        if reading.status == "read" and part.sort.is_scalar and not part.sort.is_open:
            reference = key.reference.get(part.quantity)
            answered += 1
            asked.setdefault(float(reading.values[0]), set()).add(f"{reference:.6g}")
    return {
        number
        for number, things in asked.items()
        if len(things) >= EVERYWHERE or (len(asked) == 1 and answered > 1 and len(things) > 1)
    }
