"""A point: right within a margin about it, by its distance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from coursework.kinds.kind import Stated
from coursework.kinds.nearness import in_half_widths, offset
from coursework.kinds.vectors import Coordinates


class Point(Coordinates):
    name = "point"
    goes_on_only = True

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        gap = offset(value, reference)
        if gap is None:
            return math.inf
        size = self.size(reference)
        return in_half_widths(float(np.linalg.norm(gap)), max(part.half_width(size), envelope), size)
