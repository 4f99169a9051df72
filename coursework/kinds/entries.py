"""Base of the kinds with many entries: each entry is judged, all within one half-width."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from coursework.kinds.kind import Kind, Stated
from coursework.kinds.nearness import in_half_widths, offset


class Entries(Kind):
    """An array of real entries, of the shape of its reference: right where every entry is.

    The half-width is the same for all entries: the larger of ``atol`` and ``rtol`` times the largest entry of
    the reference, or the envelope where that is wider.
    """

    is_followed = has_cells = True
    of_largest = True
    box = "wide"

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        if np.shape(value) != np.shape(reference):
            return math.inf
        gaps = offset(value, reference)
        if gaps is None:
            return math.inf
        size = self.size(reference)
        return in_half_widths(float(np.max(np.abs(gaps))), max(part.half_width(size), envelope), size)

    def size(self, reference: Any) -> float:
        return float(np.max(np.abs(reference)))

    def is_trivial(self, value: Any) -> bool:
        return not np.any(value)

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        just_off = np.array(value, dtype=float)
        just_off.flat[0] += 1.3 * half_width
        return just_off, 1.13 * np.asarray(value)
