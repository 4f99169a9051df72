"""Cells of a CSV file with their positions, to rewrite one cell and leave every other byte as it is."""

from __future__ import annotations

import codecs
import re
from typing import NamedTuple

from coursework.system.tables import encoding_of

_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))


class PositionedCell(NamedTuple):
    """Cell with its text and its position in the file's text, quotation marks included."""

    text: str
    start: int
    end: int
    is_quoted: bool


class CellTable:
    """Records of a file, cell by cell; blank lines are skipped."""

    def __init__(self, data: bytes) -> None:
        self._mark, self._encoding = next((mark for mark in _MARKS if data.startswith(mark[0])), (b"", ""))
        self._encoding = self._encoding or _without_mark(data)
        self._text = data[len(self._mark) :].decode(self._encoding)
        self.delimiter = _delimiter(self._text)
        self.records = [
            r for r in _records(self._text, self.delimiter) if any(cell.text.strip() for cell in r)
        ]
        self._changed: list[tuple[PositionedCell, str]] = []

    def write(self, cell: PositionedCell, text: str) -> None:
        """Replace the text of a cell, in quotation marks if it had some or needs them."""
        if text != cell.text:
            needs = cell.is_quoted or any(c in text for c in ('"', self.delimiter, "\n", "\r"))
            self._changed.append((cell, '"' + text.replace('"', '""') + '"' if needs else text))

    def data(self) -> bytes:
        """Return the bytes of the file with the changes."""
        pieces, end = [], 0
        for cell, text in sorted(self._changed, key=lambda change: change[0].start):
            pieces += [self._text[end : cell.start], text]
            end = cell.end
        return self._mark + "".join((*pieces, self._text[end:])).encode(self._encoding)


def _without_mark(data: bytes) -> str:
    """Return the encoding of a file without a byte-order mark; a file in an unknown encoding is read byte by
    byte."""
    encoding = encoding_of(data)
    if encoding == "utf-8-sig":
        return "utf-8"
    try:
        data.decode(encoding)
    except UnicodeDecodeError:
        return "latin-1"
    return encoding


def _delimiter(text: str) -> str:
    """Return the delimiter, counted on the first line outside quotation marks; a quoted title may span
    several lines."""
    outside = re.sub(r'"(?:[^"]|"")*"', "quoted", text[:100_000])
    bare = next(filter(str.strip, outside.splitlines()), "")
    return max((",", ";", "\t"), key=bare.count)


def _records(text: str, delimiter: str) -> list[list[PositionedCell]]:
    records: list[list[PositionedCell]] = []
    row: list[PositionedCell] = []
    cell = re.compile(
        r"[ "
        rf']*"(?P<quoted>(?:[^"]|"")*)"(?P<behind>[^{re.escape(delimiter)}\r\n]*)'
        rf"|(?P<bare>[^{re.escape(delimiter)}\r\n]*)"
    )
    position = 0
    while position <= len(text):
        match = cell.match(text, position)
        assert match is not None, "a bare cell may be empty"
        quoted = match["quoted"]
        content = match["bare"] if quoted is None else quoted.replace('""', '"') + match["behind"]
        row.append(PositionedCell(content, match.start(), match.end(), quoted is not None))
        position = match.end()
        if text[position : position + 1] != delimiter:
            records.append(row)
            row = []
            position += 1 if text[position : position + 2] == "\r\n" else 0
        position += 1
    return records
