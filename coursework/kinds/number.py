"""A number: right within a margin of its reference."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated
from coursework.kinds.nearness import SLACK, in_half_widths
from coursework.language.numbers import plain, significant

if TYPE_CHECKING:
    from coursework.parsing.reading import Reading


class Number(Kind):
    name = "number"
    is_scalar = is_number = is_followed = True
    prediction = "size"

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        from coursework.parsing.numbers import read_number

        return read_number(answer, part.unit)

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return in_half_widths(abs(value - reference), max(part.half_width(reference), envelope), reference)

    def size(self, reference: Any) -> float:
        return abs(float(reference))

    def accepted(self, values: np.ndarray, references: np.ndarray, half_widths: np.ndarray) -> np.ndarray:
        with np.errstate(invalid="ignore", over="ignore"):
            gap = np.abs(values - references)
            slack = SLACK * np.maximum(half_widths, np.abs(references))
            return np.isfinite(gap) & (gap <= half_widths + slack)

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        much = value + 11.0 if part.unit == "deg" else 1.13 * value
        return value + 1.3 * half_width, much

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return significant(value, digits)

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        unit = "" if part.unit == "1" else f" {part.unit}"
        printed = self.written(value, 4, label) + unit
        yield AnswerSpelling("exact", value)
        yield AnswerSpelling("printed", printed)
        if self.comma(printed) != printed:
            yield AnswerSpelling("comma", self.comma(printed))
        if part.has_margin:
            yield AnswerSpelling("edge", plain(self.on_edge(part, value)))

    def on_edge(self, part: Stated, value: Any) -> float:
        """Return the last value that is right."""
        return float(value + part.half_width(value))
