"""Cells of a CSV where they stand, so that one can be written anew and every other byte of the file stays."""

from __future__ import annotations

import codecs
import re
from typing import NamedTuple

from coursework.system.tables import encoding_of

_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)


class StandingCell(NamedTuple):
    """One cell: its text, and where it stands in the file's, quotation marks and all."""

    text: str
    start: int
    end: int
    is_quoted: bool


class CellTable:
    """The records of a file, cell by cell; blank lines are none."""

    def __init__(self, data: bytes) -> None:
        self._mark, self._encoding = next((one for one in _MARKS if data.startswith(one[0])), (b"", ""))
        self._encoding = self._encoding or _without_mark(data)
        self._text = data[len(self._mark) :].decode(self._encoding)
        self.delimiter = _delimiter(self._text)
        self.records = [
            r for r in _records(self._text, self.delimiter) if any(cell.text.strip() for cell in r)
        ]
        self._changed: list[tuple[StandingCell, str]] = []

    def write(self, cell: StandingCell, text: str) -> None:
        """Put a text in the place of a cell's, in quotation marks where it has some or needs them."""
        if text != cell.text:
            needs = cell.is_quoted or any(c in text for c in ('"', self.delimiter, "\n", "\r"))
            self._changed.append((cell, '"' + text.replace('"', '""') + '"' if needs else text))

    def data(self) -> bytes:
        """The file with what was written."""
        pieces, end = [], 0
        for cell, text in sorted(self._changed, key=lambda one: one[0].start):
            pieces += [self._text[end : cell.start], text]
            end = cell.end
        return self._mark + "".join((*pieces, self._text[end:])).encode(self._encoding)


def _without_mark(data: bytes) -> str:
    """How a file without a mark is encoded; one that is neither of the usual two is kept byte by byte."""
    found = encoding_of(data)
    if found == "utf-8-sig":
        return "utf-8"
    try:
        data.decode(found)
    except UnicodeDecodeError:
        return "latin-1"
    return found


def _delimiter(text: str) -> str:
    """What parts the cells, by what stands on the first line outside quotation marks; a quoted title may run over several."""
    outside = re.sub(r'"(?:[^"]|"")*"', "quoted", text[:100_000])
    bare = next(filter(str.strip, outside.splitlines()), "")
    return max((",", ";", "\t"), key=bare.count)


def _records(text: str, delimiter: str) -> list[list[StandingCell]]:
    found: list[list[StandingCell]] = []
    row: list[StandingCell] = []
    cell = re.compile(
        rf'[ ]*"(?P<quoted>(?:[^"]|"")*)"(?P<behind>[^{re.escape(delimiter)}\r\n]*)|(?P<bare>[^{re.escape(delimiter)}\r\n]*)'
    )
    place = 0
    while place <= len(text):
        one = cell.match(text, place)
        assert one is not None, "a bare cell may be empty"
        quoted = one["quoted"]
        said = one["bare"] if quoted is None else quoted.replace('""', '"') + one["behind"]
        row.append(StandingCell(said, one.start(), one.end(), quoted is not None))
        place = one.end()
        if text[place : place + 1] != delimiter:
            found.append(row)
            row = []
            place += 1 if text[place : place + 2] == "\r\n" else 0
        place += 1
    return found
