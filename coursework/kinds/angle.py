"""An angle that is a direction: in degrees, the same after a full turn."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.kinds.kind import Asking, Stated
from coursework.kinds.nearness import SLACK, TRUSTED, in_half_widths, is_fine
from coursework.kinds.number import Number
from coursework.parsing.reading import MOST_TURNS, Reading
from coursework.parsing.spelling import shorten

if TYPE_CHECKING:
    from collections.abc import Sequence

_FEW_TURNS = 2  #: within which a text with two readings is meant


class Angle(Number):
    name = "angle"
    unit = "deg"
    turn = 360.0
    prediction = "quadrant"

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        # Modulo a turn any number may be near: a thousand of degrees is no honest reading of 1,234.
        from coursework.parsing.numbers import read_number

        reading = read_number(answer, part.unit, thousands=False)
        return self._of_few_turns(reading) if reading.status == "read" else reading

    def _of_few_turns(self, reading: Reading) -> Reading:
        """Return a reading without the values of too many turns."""
        turns = [abs(value) / self.turn for value in reading.values]
        if len(turns) == 1 and turns[0] <= MOST_TURNS:
            return reading
        places = _places(turns, _FEW_TURNS) or _places(turns, MOST_TURNS)[:1]
        if not places:
            return Reading(reading.text, "unreadable", code="too_many_turns", found=shorten(reading.text))
        return replace(
            reading,
            values=tuple(reading.values[i] for i in places),
            read_as=tuple(reading.read_as[i] for i in places),
        )

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        half_width = max(part.half_width(reference), envelope)
        if not (abs(value) <= MOST_TURNS * self.turn and is_fine(value, half_width)):
            return math.inf
        gap = abs(math.remainder(value - reference, self.turn))
        return in_half_widths(gap, half_width, self.turn)

    def accepted(self, values: np.ndarray, references: np.ndarray, half_widths: np.ndarray) -> np.ndarray:
        with np.errstate(invalid="ignore"):
            few = np.abs(values) <= MOST_TURNS * self.turn
            size = np.where(few, np.abs(values), 0.0)
            fine = (np.spacing(size) <= TRUSTED * half_widths) | (half_widths == 0)
            gap = np.where(few, values, 0.0) - references
            gap -= self.turn * np.rint(gap / self.turn)
        return few & fine & (np.abs(gap) <= half_widths + SLACK * np.maximum(half_widths, self.turn))

    def on_edge(self, part: Stated, value: Any) -> float:
        return float(value + self.turn - part.half_width(value))


def _places(turns: Sequence[float], most: float) -> list[int]:
    return [i for i, count in enumerate(turns) if count <= most]
