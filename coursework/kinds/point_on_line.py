"""Any point of the line through the reference along another quantity."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from coursework.kinds.kind import Stated
from coursework.kinds.nearness import in_half_widths, is_fine, offset
from coursework.kinds.vectors import Coordinates


class PointOnLine(Coordinates):
    name = "point_on_line"
    goes_with = ("along",)
    is_called_by_symbol = False
    box = "wide"
    wrong = "wrong_place"

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        gap, axis = offset(value, reference), np.asarray(along, dtype=float)
        if gap is None:
            return math.inf
        size = self.size(reference)
        half_width = max(part.half_width(size), envelope)
        if not is_fine(float(np.max(np.abs(value))), half_width):
            return math.inf  # so far out that the line itself is lost
        off = float(np.linalg.norm(np.cross(gap, axis)) / np.linalg.norm(axis))
        return in_half_widths(off, half_width, size)
