"""CSV as people and spreadsheets keep it: how it is encoded, what parts its cells, and cells that nothing runs."""

from __future__ import annotations

import codecs
import csv
import io
import json
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple, TextIO

MAX_LINES = 20  #: of one quoted cell
_WARNINGS = {
    "utf-8-sig": "",
    "utf-16": "the file is UTF-16, not UTF-8",
    "cp1252": "the file is not UTF-8; it was read as Windows-1252",
}


def delimiter_of(header: str) -> str:
    """What parts the cells of a CSV, by its first line: semicolon, comma or tab."""
    return max((";", ",", "\t"), key=header.count)


def encoding_of(data: bytes) -> str:
    """UTF-8 unless it cannot be, then what Windows and Excel write."""
    for encoding in ("utf-16", "utf-8-sig") if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig",):
        try:
            data.decode(encoding)
            return encoding
        except UnicodeDecodeError:
            pass
    return "cp1252"


def _marked_once(data: bytes) -> bytes:
    """Without the marks that were put before a mark that was there already, as editors and scripts do."""
    mark = codecs.BOM_UTF8
    while data.startswith(2 * mark):
        data = data[len(mark) :]
    return data


def decode(data: bytes) -> tuple[str, str]:
    """The text and a warning."""
    data = _marked_once(data)
    encoding = encoding_of(data)
    return data.decode(encoding, "replace"), _WARNINGS[encoding]


def record(lines: list[str], start: int, delimiter: str, width: int) -> tuple[list[str], int]:
    """The cells of the record at a line, and how many lines it takes.

    A quoted cell may run over a few lines, if the record is then well formed, has as many cells as the
    header, and swallows no line that would be a record by itself. Any other quotation mark is a
    character like another: it costs no row, and is kept.
    """
    whole = _cells(lines[start], delimiter)
    if whole is not None:
        return whole, 1
    for taken in range(2, min(MAX_LINES, len(lines) - start) + 1):
        added = lines[start + taken - 1]
        if len(added.split(delimiter)) >= width:
            break
        cells = _cells("\n".join(lines[start : start + taken]), delimiter)
        if cells is not None and len(cells) == width:
            return cells, taken
    return [cell.removeprefix('"') for cell in lines[start].split(delimiter)], 1


def _cells(text: str, delimiter: str) -> list[str] | None:
    """The cells of a well-formed record; None where a quotation mark does not close as it should."""
    if '"' not in text:
        return text.split(delimiter)
    try:
        return next(csv.reader([text], delimiter=delimiter, strict=True), [])
    except csv.Error:
        return None


@contextmanager
def open_csv(path: Path) -> Iterator[TextIO]:
    """A CSV to be read line by line, in any encoding that :func:`decode` knows; a cell may be of any length."""
    data = _marked_once(path.read_bytes())
    before = csv.field_size_limit(min(sys.maxsize, 2**31 - 1))
    try:
        yield io.TextIOWrapper(io.BytesIO(data), encoding_of(data), "replace", newline="")
    finally:
        csv.field_size_limit(before)


def inert(cell: Any) -> Any:
    """The cell, or its text kept from being run: a formula that calls, pipes or reaches elsewhere."""
    if not isinstance(cell, str) or cell[:1].isalnum():
        return cell  # nearly all of them
    runs = cell.lstrip()[:1] in ("=", "+", "-", "@") and set(cell) & set("(|!")
    return f"'{cell}" if runs else cell


def as_written(cell: str) -> str:
    """The text of a cell that may have been made :func:`inert`."""
    return cell[1:] if cell[:1] == "'" and inert(cell[1:]) == cell else cell


class Spreadsheet(NamedTuple):
    """What parts the cells and the decimals of a table, by the spreadsheet that is to open it."""

    delimiter: str = ","
    decimal: str = "."

    def cells(self, row: Mapping[str, Any], columns: Sequence[str]) -> list[Any]:
        """The cells of a row. A text that a spreadsheet would run gets an apostrophe before it."""
        if self.decimal == ".":
            return [inert(row[c]) for c in columns]
        return [self._number(row[c]) if _is_number(row[c], c) else inert(row[c]) for c in columns]

    def _number(self, value: Any) -> str:
        return str(value).replace(".", self.decimal)


#: By the decimal sign. Spreadsheets that write a decimal comma part cells by semicolons.
SPREADSHEETS = {"point": Spreadsheet(), "comma": Spreadsheet(";", ",")}
_PLAIN = SPREADSHEETS["point"]

#: Columns whose texts are numbers; what a student wrote stays as it was written.
_NUMBERS = frozenset(
    ("points", "out_of", "percent", "mark", "points_before", "points_now", "value", "tolerance")
)
_NUMBER = re.compile(r"-?\d+(\.\d+)?(e[-+]?\d+)?")


def _is_number(value: Any, column: str) -> bool:
    """Whether a cell holds a number, or several."""
    if isinstance(value, str):
        return column in _NUMBERS and all(map(_NUMBER.fullmatch, value.split("; ")))
    return isinstance(value, float)


def csv_text(
    rows: Iterable[Mapping[str, Any]], columns: Sequence[str], spreadsheet: Spreadsheet = _PLAIN
) -> str:
    """Rows as CSV with a header. A text that a spreadsheet would run gets an apostrophe before it."""
    out = io.StringIO()
    writer = csv.writer(
        out, delimiter=spreadsheet.delimiter
    )  # lines end as the format's own description says
    writer.writerow(columns)
    for row in rows:
        writer.writerow(spreadsheet.cells(row, columns))
    return out.getvalue()


def csv_file(
    rows: Iterable[Mapping[str, Any]], columns: Sequence[str], spreadsheet: Spreadsheet = _PLAIN
) -> bytes:
    """:func:`csv_text` as a file with the mark at its head without which Excel damages accents."""
    return csv_text(rows, columns, spreadsheet).encode("utf-8-sig")


def json_text(content: Any) -> str:
    """JSON as files hold it."""
    return json.dumps(content, ensure_ascii=False, indent=1, allow_nan=False) + "\n"
