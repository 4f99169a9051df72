"""An angle that is a direction: in degrees, the same after a full turn."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from coursework.kinds.kind import Asking, Stated
from coursework.kinds.nearness import in_half_widths
from coursework.kinds.number import Number

if TYPE_CHECKING:
    from coursework.reading.reading import Reading


class Angle(Number):
    name = "angle"
    unit = "deg"
    turn = 360.0
    prediction = "quadrant"

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        # Modulo a turn any number may be near: a thousand of degrees is no honest reading of 1,234.
        from coursework.reading.numbers import read_number

        return read_number(answer, part.unit, thousands=False)

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        gap = abs(math.remainder(value - reference, self.turn))
        return in_half_widths(gap, max(part.half_width(reference), envelope), self.turn)

    def on_edge(self, part: Stated, value: Any) -> float:
        return float(value + self.turn - part.half_width(value))
