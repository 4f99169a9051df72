"""A direction: any multiple of the reference vector but zero."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from coursework.kinds.kind import Stated
from coursework.kinds.nearness import TRUSTED, in_half_widths
from coursework.kinds.vectors import Coordinates


class Direction(Coordinates):
    name = "direction"
    is_called_by_symbol = False
    rounds = False  # its margin is the sine of an angle
    box = "wide"
    wrong = "wrong_place"
    goes_on_only = True

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        v, d = np.asarray(value, dtype=float), np.asarray(reference, dtype=float)
        largest = float(np.max(np.abs(v)))
        half_width = part.half_width(1.0)
        if largest and half_width and math.ulp(largest) / largest > TRUSTED * half_width:
            return math.inf  # so small that its coordinates have few digits
        v = v / largest if largest else v
        size = float(np.linalg.norm(v) * np.linalg.norm(d))
        if size == 0.0:
            return math.inf
        return in_half_widths(float(np.linalg.norm(np.cross(v, d))) / size, half_width, 1.0)

    def size(self, reference: Any) -> float:
        return 1.0
