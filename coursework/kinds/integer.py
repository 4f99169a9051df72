"""A whole number, judged exactly: a count."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated
from coursework.language.numbers import significant
from coursework.quantities.graph import plain_scalar

if TYPE_CHECKING:
    from coursework.parsing.reading import Reading

_DIGITS = 9  #: with which a count is written


class Integer(Kind):
    name = "integer"
    is_exact = is_scalar = is_followed = True
    wrong = "wrong_count"
    prediction = "guess"
    has_decimals = False
    family = "integer"
    unitless = "wrong_unit_integer"

    def keys(self, part: Stated) -> tuple[str, ...]:
        return ("-",)

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        from coursework.parsing.numbers import read_integer

        return read_integer(answer)

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return 0.0 if value == plain_scalar(reference) else math.inf

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        return (value + 1,)

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return significant(value, _DIGITS)

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        unit = "" if part.unit == "1" else f" {part.unit}"
        yield AnswerSpelling("exact", value)
        yield AnswerSpelling("printed", self.written(value, _DIGITS, label) + unit)
