"""A vector of any length: right where each entry is within the margin of the largest."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from coursework.kinds.entries import Entries
from coursework.kinds.kind import AnswerSpelling, Asking, Stated
from coursework.language.numbers import significant
from coursework.parsing.matrices import read_vector
from coursework.parsing.reading import Reading


class VectorKind(Entries):
    name = "vector"
    family = "vector"
    rank = 1

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        return read_vector(answer, part.unit, len(asking.reference(part.quantity)))

    def coordinates(self, part: Stated, asking: Asking) -> tuple[str, ...]:
        return tuple(str(index) for index in range(1, len(asking.reference(part.quantity)) + 1))

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return "(" + " ; ".join(significant(v, digits) for v in value.tolist()) + ")"

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        yield AnswerSpelling("exact", value)
        yield from (spelled for spelled in super().spellings(part, value, label) if spelled.way != "exact")
        yield AnswerSpelling("column", [[v] for v in value.tolist()])
