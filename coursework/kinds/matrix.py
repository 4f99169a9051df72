"""A matrix of the shape of its reference: right where each entry is within the margin of the largest."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from coursework.kinds.entries import Entries
from coursework.kinds.kind import AnswerSpelling, Asking, ComponentBox, Stated
from coursework.language.numbers import significant
from coursework.parsing.matrices import read_matrix
from coursework.parsing.reading import Reading


class Matrix(Entries):
    name = "matrix"
    family = "matrix"
    box = "line"
    rank = 2

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        rows, columns = np.shape(asking.reference(part.quantity))
        return read_matrix(answer, part.unit, (rows, columns))

    def coordinates(self, part: Stated, asking: Asking) -> tuple[str, ...]:
        rows, columns = np.shape(asking.reference(part.quantity))
        return tuple(rf"({row};\ {column})" for row in range(1, rows + 1) for column in range(1, columns + 1))

    def cells(self, part: Stated, asking: Asking) -> tuple[tuple[ComponentBox, ...], ...]:
        """Return a group for each row."""
        columns, (cells,) = np.shape(asking.reference(part.quantity))[1], super().cells(part, asking)
        return tuple(cells[start : start + columns] for start in range(0, len(cells), columns))

    def joined(self, texts: Sequence[str], part: Stated, asking: Asking) -> str:
        columns = np.shape(asking.reference(part.quantity))[1]
        rows = (texts[start : start + columns] for start in range(0, len(texts), columns))
        return "[" + "; ".join(f"[{' ; '.join(row)}]" for row in rows) + "]"

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        rows = (" ".join(significant(v, digits) for v in row) for row in np.asarray(value).tolist())
        return "[" + "; ".join(rows) + "]"

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        yield from super().spellings(part, value, label)
        yield AnswerSpelling("lists", np.asarray(value).tolist())
        inner = r" \\ ".join(" & ".join(map(repr, row)) for row in np.asarray(value).tolist())
        yield AnswerSpelling("latex", rf"\begin{{pmatrix}} {inner} \end{{pmatrix}}")
