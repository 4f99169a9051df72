"""Booklets: the sheets of all students in one PDF to print, and a table of their pages.

A booklet has a limited number of sheets or papers; a larger class gets several, named by the sheets they
hold. The typesetter keeps a whole document in memory, and joining PDFs would lose the accessibility tags.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeVar

from coursework.system.tables import Spreadsheet, csv_file
from coursework.system.writing import File

SHEETS = 50  #: limit of sheets or papers in one booklet

Pages = tuple[tuple[int, int], ...]  #: the first and the last of each sheet
_Sheet = TypeVar("_Sheet")


@dataclass(frozen=True)
class Booklet:
    """File of several sheets, and the file of their solutions."""

    name: str
    print_sheets: Callable[[], tuple[bytes, Pages]]
    print_solutions: Callable[[], bytes]
    cells: Sequence[Mapping[str, object]]  #: of each sheet, its row of the table without pages and file

    def rows(self, pages: Pages) -> Iterator[dict[str, object]]:
        for row, (first, last) in zip(self.cells, pages, strict=True):
            yield {**row, "first page": first, "last page": last, "file": f"{self.name}.pdf"}


def parted(name: str, sheets: Sequence[_Sheet]) -> Iterator[tuple[str, Sequence[_Sheet]]]:
    """Yield each booklet's name and its sheets."""
    digits = len(str(len(sheets)))
    for start in range(0, len(sheets), SHEETS):
        part = sheets[start : start + SHEETS]
        which = f".{start + 1:0{digits}}-{start + len(part):0{digits}}" if len(sheets) > SHEETS else ""
        yield f"{name}{which}", part


def bound(booklets: Iterable[Booklet], columns: Sequence[str], spreadsheet: Spreadsheet) -> Iterator[File]:
    """Yield the files of booklets, and after them the table of the students' pages.

    The files are to be made in this order, by one thread or several.
    """
    wanted = [(booklet, Future[Pages]()) for booklet in booklets]
    for booklet, pages in wanted:
        yield File(Path("handouts") / f"{booklet.name}.pdf", partial(_printed, booklet, pages))
        yield File(Path("instructor") / f"{booklet.name}.solutions.pdf", booklet.print_solutions)

    def table() -> bytes:
        rows = (row for booklet, pages in wanted for row in booklet.rows(pages.result()))
        return csv_file(rows, columns, spreadsheet)

    yield File(Path("handouts") / "pages.csv", table)


def _printed(booklet: Booklet, result: Future[Pages]) -> bytes:
    try:
        pdf, pages = booklet.print_sheets()
    except BaseException as fault:
        result.set_exception(fault)
        raise
    result.set_result(pages)
    return pdf
