"""Answers typed from paper: a line for each student, a column for each question, titled
``1.2 slotted_mechanism rA (mm)``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, RowOrigin
from coursework.issuing.identity import NUMBER, WHOLE, is_called
from coursework.issuing.issued import COLUMNS, NOT_ASKED
from coursework.messages import Message
from coursework.system.tables import as_written

_QUESTION = re.compile(
    r"(?:[0-9][0-9./]*\s+)?(?P<exercise>[^\W\d]\w*)[\s.:]+(?P<part>[^\W\d]\w*)(?:\s*[(\[].*)?"
)
_SEED = re.compile(r"(?P<exercise>[^\W\d]\w*) seed")


class WideColumns(NamedTuple):
    """Positions of the columns of a wide table."""

    student: int | None
    ids: tuple[int, ...]
    seeds: dict[str, int]  #: by exercise
    questions: dict[int, tuple[str, str]]  #: exercise and part


def columns_of(header: Sequence[str]) -> WideColumns | None:
    """Return the positions of the columns; None if this is not a table with a column for each question."""
    titles = [title.strip() for title in header]
    named = [k for k, title in enumerate(titles) if is_called(title, WHOLE)]
    ids = tuple(k for k, title in enumerate(titles) if is_called(title, NUMBER))
    seeds = {m["exercise"]: k for k, title in enumerate(titles) if (m := _SEED.fullmatch(title))}
    about = {*named, *ids, *seeds.values()}
    questions = {
        k: (m["exercise"], m["part"])
        for k, title in enumerate(titles)
        if k not in about and (m := _QUESTION.fullmatch(title)) and title.casefold() not in COLUMNS
    }
    if not questions or not (named or ids) or {"part", "answer"} & {*map(str.casefold, titles)}:
        return None
    return WideColumns(named[0] if named else None, ids, seeds, questions)


def read_wide(
    header: Sequence[str], rows: Iterable[tuple[str, Sequence[str]]], source: str, warning: str
) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    """Yield the answers of a wide table, question by question; an empty cell is not an answer."""
    columns = columns_of(header)
    assert columns is not None, "only a header that has them comes here"
    for location, cells in rows:
        cells = [as_written(cell).strip() for cell in cells]
        if any(cells[len(header) :]):
            reason = Message(
                "{cells} cell{cells:|s} where the header has {most}", cells=len(cells), most=len(header)
            )
            yield Rejected(location, reason, {"student": cells[columns.student or 0]})
            continue
        cells += [""] * (len(header) - len(cells))
        ids = tuple((header[k].strip(), cells[k]) for k in columns.ids if cells[k])
        student = cells[columns.student] if columns.student is not None else ""
        student = student or (ids[0][1] if ids else "")
        for k, (exercise, part) in columns.questions.items():
            if cells[k] not in ("", NOT_ASKED):
                seed = cells[columns.seeds[exercise]] if exercise in columns.seeds else ""
                where = f"{location}, {header[k].strip()}"
                origin = RowOrigin(ids) if ids else None
                yield AnswerRow(student, exercise, seed, part, cells[k], where, warning, "", origin)
