"""Sheets of a class that is too large for memory: on disk until they are marked.

Rows come in the order of their files, and those of a sheet may be far apart. They are divided by sheet, so
that all rows of a sheet are in one small part. Each part is processed, and its sheets are read back in the
order in which they first appeared. So the result is that of
:func:`coursework.gradebook.placing.placed_sheets`.

The data are in temporary files without a name, next to the result: they end with the process, in any case.
"""

from __future__ import annotations

import heapq
import pickle
import tempfile
from array import array
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from itertools import chain, islice
from operator import itemgetter
from pathlib import Path
from typing import IO, Any, NamedTuple

from coursework.course.course import Course
from coursework.gradebook.conflicting_sheets import Doubts
from coursework.gradebook.placing import PlacedRow, SheetKey, Sheets, fill, placed_rows, row_placer
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
from coursework.issuing.issued import Issued
from coursework.system.writing import writing

AT_ONCE = 250_000  #: rows kept in memory, 100 MB; more are stored on disk, which takes a fifth longer
PARTS = 256  #: number of parts, of which one is in memory at a time
_BLOCK = 16  #: sheets of each part that are read at once


@contextmanager
def placed_on_disk(
    course: Course, issued: Issued, rows: Iterable[AnswerRow | Rejected | PlatformFile], out: Path
) -> Iterator[Sheets]:
    """Return a context with the rows by sheet, as :func:`coursework.gradebook.placing.placed_sheets` gives
    them. Many rows are stored on the disk of ``out`` during the context, and :meth:`Sheets.parts` reads them.

    Raises
    ------
    CourseworkError
        As for ``placed``.
    BadInput
        The disk cannot be written.
    """
    sheets_read, doubts = Sheets(), Doubts(issued)
    folder = next(directory for directory in (out, *out.absolute().parents) if directory.is_dir())
    placements = placed_rows(course, issued, rows, sheets_read, doubts)
    first = list(islice(placements, AT_ONCE))
    if len(first) < AT_ONCE:
        fill(course, issued, sheets_read, first, doubts)
        yield sheets_read
        return
    with _Blocks(folder) as stored:
        with _Blocks(folder) as by_part:
            rejected = _split_by_sheet(first, placements, by_part)
            sheets = _SheetsOnDisk(sheets_read, stored)
            for part in range(PARTS):
                rejected += sheets.take(course, issued, by_part.of(part), part, doubts)
        sheets.rejected = [row for _, row in sorted(rejected, key=itemgetter(0))]
        yield sheets


_NumberedRow = tuple[int, Rejected]  #: by the number of the row
#: A plain tuple is written and read in half the time of a row.
_NumberedAnswer = tuple[int, SheetKey, tuple[Any, ...]]


def _split_by_sheet(
    first: list[PlacedRow], others: Iterator[PlacedRow], by_part: _Blocks
) -> list[_NumberedRow]:
    """Add rows to the parts of their sheets; return the rejected rows."""
    rejected: list[_NumberedRow] = []
    numbered = enumerate(chain(first, others))
    while some := list(islice(numbered, AT_ONCE)):
        first.clear()
        parts: dict[int, list[_NumberedAnswer]] = {}
        for number, placed_row in some:
            if isinstance(placed_row, Rejected):
                rejected.append((number, placed_row))
            else:
                key, row = placed_row
                parts.setdefault(hash(key) % PARTS, []).append((number, key, tuple(row)))
        for part, rows in parts.items():
            by_part.add(part, rows)
    return rejected


class _Stored(NamedTuple):
    """Sheet as stored on disk."""

    number: int  #: of the first row received
    key: SheetKey
    rows: dict[str, tuple[Any, ...]]
    lang: str | None
    submitted: str | None
    apart: bool


class _SheetsOnDisk(Sheets):
    """Sheets that are read from disk on demand."""

    def __init__(self, sheets: Sheets, stored: _Blocks) -> None:
        super().__init__(warnings=sheets.warnings, rows_in=sheets.rows_in, seen=sheets.seen)
        self._stored = stored
        self._count = self._answers = 0
        self._names: set[str] = set()
        self._is_dated = False

    @property
    def count(self) -> int:
        return self._count

    @property
    def students(self) -> int:
        return len(self._names)

    @property
    def answers(self) -> int:
        return self._answers

    @property
    def is_dated(self) -> bool:
        return self._is_dated

    def take(
        self,
        course: Course,
        issued: Issued,
        blocks: Iterable[Sequence[_NumberedAnswer]],
        part: int,
        doubts: Doubts,
    ) -> list[_NumberedRow]:
        """Place the rows of a part on their sheets, and store these on disk; return the rejected rows."""
        sheets_of_part, rejected = Sheets(), []
        put_row = row_placer(course, issued, sheets_of_part, doubts)
        numbers: dict[SheetKey, int] = {}
        for number, key, row in chain.from_iterable(blocks):
            numbers.setdefault(key, number)
            if (refused := put_row(key, AnswerRow(*row))) is not None:
                rejected.append((number, refused))
        self._is_dated = self._is_dated or sheets_of_part.is_dated
        sheets_of_part.drop_empty()
        self.rows_in += sheets_of_part.rows_in
        self.blanks += sheets_of_part.blanks
        self._count += sheets_of_part.count
        self._answers += sheets_of_part.answers
        self._names.update(key[0] for key in sheets_of_part.sheets)
        sheets = (_stored(sheets_of_part, key, numbers[key]) for key in sheets_of_part.sheets)
        while some := list(islice(sheets, _BLOCK)):
            self._stored.add(part, some)
        return rejected

    def parts(self, size: int) -> Iterator[Sheets]:
        streams = (chain.from_iterable(self._stored.of(part)) for part in range(PARTS))
        in_order = heapq.merge(*streams, key=itemgetter(0))
        while some := list(islice(in_order, size)):
            yield _together(some)


def _stored(sheets: Sheets, key: SheetKey, number: int) -> _Stored:
    values = sheets.langs.get(key), sheets.submitted.get(key), key in sheets.apart
    return _Stored(number, key, {part: tuple(row) for part, row in sheets.sheets[key].items()}, *values)


def _together(some: Iterable[_Stored]) -> Sheets:
    sheets = Sheets()
    for stored in some:
        sheets.sheets[stored.key] = {part: AnswerRow(*row) for part, row in stored.rows.items()}
        if stored.lang is not None:
            sheets.langs[stored.key] = stored.lang
        if stored.submitted is not None:
            sheets.submitted[stored.key] = stored.submitted
        if stored.apart:
            sheets.apart.add(stored.key)
    return sheets


class _Blocks:
    """Lists of items by a number, in a temporary file without a name.

    They are pickled, which keeps an answer what it is, a number or a text; nobody else can write the file.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._at: dict[int, array[int]] = {}  #: where blocks begin and how long they are, in turn
        self._end = 0
        self._file: IO[bytes] | None = None

    def __enter__(self) -> _Blocks:
        return self

    def __exit__(self, *_: object) -> None:
        if self._file is not None:
            with suppress(OSError):  # a full disk has been reported already
                self._file.close()

    def add(self, number: int, items: Sequence[Any]) -> None:
        """Add a block, before any is read."""
        data = pickle.dumps(items, 5)
        self._at.setdefault(number, array("Q")).extend((self._end, len(data)))
        with writing(self._folder):
            if self._file is None:
                self._file = tempfile.TemporaryFile(dir=self._folder)  # noqa: SIM115
            self._file.write(data)
        self._end += len(data)

    def of(self, number: int) -> Iterator[Any]:
        """Yield the blocks of a number, in the order in which they were added."""
        at = self._at.get(number, ())
        for start, size in zip(at[::2], at[1::2], strict=True):
            assert self._file is not None
            with writing(self._folder):
                self._file.seek(start)
                data = self._file.read(size)
            yield pickle.loads(data)
