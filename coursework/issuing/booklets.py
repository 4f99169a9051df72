"""Booklets: the sheets of all students in one PDF to print, and a table of their pages.

A booklet has a limited number of exercises; a larger class gets several, named by the sheets they hold. The
typesetter keeps a whole document in memory, two megabytes a page, and joining PDFs would lose the
accessibility tags. For the same reason one is made after the other. Solutions have more pages than sheets,
and nobody hands them out: their booklets have fewer exercises.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar

from coursework.system.tables import Spreadsheet, csv_file
from coursework.system.writing import File

#: Limits of exercises in one booklet, of sheets or in all of its papers: either takes some 400 MB.
EXERCISES, SOLVED = 50, 20

Pages = tuple[tuple[int, int], ...]  #: the first and the last of each sheet
_Sheet = TypeVar("_Sheet")
_Made = TypeVar("_Made")


@dataclass(frozen=True)
class Booklet:
    """File of several sheets."""

    name: str
    print_sheets: Callable[[], tuple[bytes, Pages]]
    cells: Sequence[Mapping[str, object]]  #: of each sheet, its row of the table without pages and file

    def rows(self, pages: Pages) -> Iterator[dict[str, object]]:
        for row, (first, last) in zip(self.cells, pages, strict=True):
            yield {**row, "first page": first, "last page": last, "file": f"{self.name}.pdf"}


def parted(
    name: str, sheets: Sequence[_Sheet], exercises: int = 1, limit: int = 0
) -> Iterator[tuple[str, Sequence[_Sheet]]]:
    """Yield each booklet's name and its sheets, of so many exercises each; at most ``limit`` in a booklet, by
    default :data:`EXERCISES`."""
    digits, most = len(str(len(sheets))), max(1, (limit or EXERCISES) // exercises)
    for start in range(0, len(sheets), most):
        part = sheets[start : start + most]
        which = f".{start + 1:0{digits}}-{start + len(part):0{digits}}" if len(sheets) > most else ""
        yield f"{name}{which}", part


def bound(
    booklets: Iterable[Booklet],
    solutions: Iterable[tuple[str, Callable[[], bytes]]],
    columns: Sequence[str],
    spreadsheet: Spreadsheet,
) -> Iterator[File]:
    """Yield the files of booklets and of named solutions, and after them the table of the students' pages.

    The files are to be made in this order, by one thread or several.
    """
    wanted = [(booklet, Future[Pages]()) for booklet in booklets]
    alone = threading.Lock()
    for booklet, pages in wanted:
        yield File(Path("handouts") / f"{booklet.name}.pdf", partial(_printed, booklet, pages, alone))
    for name, make in solutions:
        yield File(Path("instructor") / f"{name}.solutions.pdf", partial(_alone, make, alone))

    def table() -> bytes:
        rows = (row for booklet, pages in wanted for row in booklet.rows(pages.result()))
        return csv_file(rows, columns, spreadsheet)

    yield File(Path("handouts") / "pages.csv", table)


def _alone(make: Callable[[], _Made], lock: threading.Lock) -> _Made:
    with lock:
        return make()


def _printed(booklet: Booklet, result: Future[Pages], lock: threading.Lock) -> bytes:
    try:
        pdf, pages = _alone(booklet.print_sheets, lock)
    except BaseException as fault:
        result.set_exception(fault)
        raise
    result.set_result(pages)
    return pdf
