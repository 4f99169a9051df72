"""Exports of platforms and wide tables, recognised by their content and not by their name: a table of
readers."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from coursework.errors import counted
from coursework.gradebook import canvas_answers, moodle_responses, wide_answers
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, name_in
from coursework.messages import Message

Rows = Iterator[tuple[str, Sequence[str]]]


class PlatformTable(NamedTuple):
    """A table that a platform writes."""

    is_this: Callable[[Sequence[str]], object]  #: by its header
    read: Callable[[Sequence[str], Rows, str, str], Iterator[AnswerRow | Rejected | PlatformFile]]


TABLES = (
    PlatformTable(moodle_responses.columns_of, moodle_responses.read_responses),
    PlatformTable(canvas_answers.columns_of, canvas_answers.read_answers),
    PlatformTable(wide_answers.columns_of, wide_answers.read_wide),
)
NO_ANSWERS = Message("the file contains no answers")
FAULTS = (moodle_responses.is_another, canvas_answers.is_another)


def reader_of(header: Sequence[str]) -> PlatformTable | None:
    """Return the reader of a table; None if no known platform writes it."""
    return next((table for table in TABLES if table.is_this(header)), None)


def fault_of(header: Sequence[str]) -> str:
    """Return a message about a platform's table without answers; empty if the table is unknown."""
    return next(filter(None, (fault(header) for fault in FAULTS)), "")


def read_table(
    table: PlatformTable, text: str, delimiter: str, source: str, warning: str
) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    """Yield the rows of a platform's CSV; a cell may contain any number of lines."""
    before = csv.field_size_limit(2**31 - 1)
    try:
        reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter)
        records = [
            (Message("{file}, line {line}", file=source, line=reader.line_num), cells)
            for cells in reader
            if any(c.strip() for c in cells)
        ]
    except csv.Error as fault:
        yield Rejected(source, Message("not CSV: {problem}", problem=fault))
        return
    finally:
        csv.field_size_limit(before)
    if not records or not table.is_this(records[0][1]):  # one read by lines, one by quotation marks
        yield Rejected(source, Message("the header is damaged: a quotation mark in it is never closed"))
        return
    is_empty = True
    for row in table.read(records[0][1], iter(records[1:]), source, warning):
        is_empty = False
        yield row
    if is_empty:
        yield Rejected(source, NO_ANSWERS)


def read_records(
    content: Any, source: str, warning: str
) -> Iterator[AnswerRow | Rejected | PlatformFile] | None:
    """Return the rows of a platform's table as JSON, lists of objects; None if it is none."""
    sheets = content if isinstance(content, list) and content and isinstance(content[0], list) else [content]
    items = [item for sheet in sheets if isinstance(sheet, list) for item in sheet]
    if not items or not all(isinstance(item, Mapping) for item in items):
        return None
    header = [*items[0]]
    if (table := reader_of(header)) is None:
        fault = fault_of(header)
        return iter([Rejected(source, fault)]) if fault else None
    rows = (
        (
            Message("{file}, item {item}", file=source, item=number),
            [name_in(item.get(title)) for title in header],
        )
        for number, item in enumerate(items, start=1)
    )
    return table.read(header, rows, source, warning)


def platform_file_lines(seen: Mapping[PlatformFile, int]) -> tuple[str, ...]:
    """Return a line about each file that a platform wrote."""
    return tuple(
        Message(
            "{file} is {content}, {files}", file=file.source, content=file.what, files=counted(count, "file")
        )
        if file.is_tree
        else Message("{file} is {content}", file=file.source, content=file.what)
        for file, count in seen.items()
    )
