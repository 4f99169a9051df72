"""Base of the kinds of questions that a person marks: printed with room, collected, and never judged here."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated
from coursework.parsing.reading import Reading, text_of


class OpenKind(Kind):
    """An answer that is kept as it came. No reference is needed, and none is looked at."""

    is_exact = is_text = is_open = True
    field = "written"
    has_symbol = is_called_by_symbol = False
    disproves = False
    family = "text"

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        text = "" if answer is None else text_of(answer)
        return Reading(text, "read" if text.strip() else "missing", (text,), (" ".join(text.split()),))

    def kept(self, read_as: str) -> Any:
        return read_as

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return math.inf

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return str(value)

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        yield from ()
