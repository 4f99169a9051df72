"""Canvas's Student Analysis of a quiz: a line per attempt, a column titled ``12345: its text`` per question,
and its points next to it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from coursework.errors import counted
from coursework.gradebook.item_label import NO_LABEL, label_in
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, RowOrigin
from coursework.messages import Message
from coursework.system.tables import as_written

WHAT = Message("Canvas's Student Analysis")
_QUESTION = re.compile(r"\s*[0-9]+\s*:\s")
_ATTEMPT = re.compile("[0-9]{1,9}")
_IDS = ("sis_id", "id")


class AnalysisColumns(NamedTuple):
    name: int
    ids: tuple[int, ...]
    submitted: int | None
    attempt: int | None
    questions: tuple[int, ...]


def columns_of(header: Sequence[str]) -> AnalysisColumns | None:
    """Return the positions of the columns; None if this is not a Student Analysis."""
    titles = [title.strip().casefold() for title in header]
    questions = tuple(k for k, title in enumerate(header) if _QUESTION.match(title))
    if not questions or not {"name", "id", "attempt"} <= set(titles):
        return None
    indices = {title: k for k, title in reversed([*enumerate(titles)])}
    ids = tuple(indices[title] for title in _IDS if title in indices)
    return AnalysisColumns(indices["name"], ids, indices.get("submitted"), indices.get("attempt"), questions)


def is_another(header: Sequence[str]) -> str:
    """Return a message if this is another report of a Canvas quiz; empty otherwise."""
    titles = {title.strip().casefold() for title in header}
    if {"question id", "question title", "answered student count"} <= titles:
        return Message("this is the Item Analysis of Canvas, without answers: download the Student Analysis")
    return ""


def read_answers(
    header: Sequence[str], rows: Iterable[tuple[str, Sequence[str]]], source: str, warning: str
) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    """Yield the answers of the report, question by question; the text of a question names its variant and its
    part."""
    columns = columns_of(header)
    assert columns is not None, "only a header that has them comes here"
    labels = {k: label_in(header[k]) for k in columns.questions}
    attempts: Counter[str] = Counter()
    for location, cells in rows:
        cells = [*map(as_written, cells), *[""] * (len(header) - len(cells))]
        student, origin = cells[columns.name].strip(), _origin(header, columns, cells)
        attempts[student] += 1
        for k in columns.questions:
            label, answer = labels[k], cells[k].strip()
            where = f"{location}, {header[k].partition(':')[0].strip()}"
            if not answer:
                # A question that a group did not draw for this student is as blank as one that waits.
                continue
            if label is None:
                yield Rejected(where, NO_LABEL, {"student": student, "answer": answer})
            elif not label.part:
                reason = Message("the label of the question names no part, and a question of Canvas asks one")
                yield Rejected(
                    where, reason, {"student": student, "exercise": label.exercise, "answer": answer}
                )
            else:
                names = student, label.exercise, label.seed, label.part
                row_origin = origin._replace(version=label.version, apart=True)
                yield AnswerRow(*names, label.answer(answer), where, warning, label.lang, row_origin)
    yield PlatformFile(
        source,
        Message(
            "{report}, {items} of {students}",
            report=WHAT,
            items=counted(sum(attempts.values()), "attempt"),
            students=counted(len(attempts), "student"),
        ),
    )


def _origin(header: Sequence[str], columns: AnalysisColumns, cells: Sequence[str]) -> RowOrigin:
    attempt = cells[columns.attempt].strip() if columns.attempt is not None else ""
    submitted = cells[columns.submitted].strip() if columns.submitted is not None else ""
    ids = tuple(
        (_TITLES[header[k].strip().casefold()], cells[k].strip()) for k in columns.ids if cells[k].strip()
    )
    return RowOrigin(ids, (), int(attempt) if _ATTEMPT.fullmatch(attempt) else 0, submitted)


_TITLES = {"sis_id": "SIS User ID", "id": "ID"}  #: as Canvas's gradebook calls them
