"""One case among a few."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated, Tick
from coursework.kinds.ticks import by_letters, lettered_ticks
from coursework.quantities.graph import plain_scalar

if TYPE_CHECKING:
    from coursework.parsing.reading import Reading


class Choice(Kind):
    name = "choice"
    goes_with = ("choices",)
    is_exact = is_text = is_followed = has_few_values = True
    has_symbol = is_called_by_symbol = False
    prediction = "guess"
    family = "choice"
    field = "ticks"
    wrong = "wrong_case"
    faults = {  # noqa: RUF012
        "unknown_symbol": "not_a_number",
        "not_a_choice": "not_a_choice",
        "two_values": "two_choices",
    }

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        from coursework.parsing.choices import read_choice

        return read_choice(answer, asking.labels(part), asking.letters(part))

    def ticks(self, part: Stated, asking: Asking) -> tuple[Tick, ...]:
        return lettered_ticks(part, asking)

    def from_paper(self, boxes: Sequence[str], part: Stated, asking: Asking, *, unit: bool = False) -> str:
        return by_letters(boxes, part, asking)

    def kept(self, read_as: str) -> Any:
        return read_as

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return 0.0 if value == plain_scalar(reference) else math.inf

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        return tuple(case for case in part.choices if case != value)[:1]

    def words(self, value: Any, label: Callable[[str], str]) -> str:
        return label(str(value))

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return label(str(value))

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        yield AnswerSpelling("exact", str(value))
        yield AnswerSpelling("printed", label(str(value)))
