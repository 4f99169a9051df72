"""CSV as people and spreadsheets write it: encodings, delimiters, and cells that no spreadsheet runs as
formulas."""

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

from coursework.errors import BadInput
from coursework.messages import Message

MAX_LINES = 20  #: of one quoted cell
_WARNINGS = {
    "utf-8-sig": "",
    "utf-16": Message("the file is UTF-16, not UTF-8"),
    "cp1252": Message("the file is not UTF-8; it was read as Windows-1252"),
}


def delimiter_of(header: str) -> str:
    """Return the delimiter of a CSV by its first line: semicolon, comma or tab."""
    return max((";", ",", "\t"), key=header.count)


def duplicate_column(header: Iterable[str], columns: Iterable[str]) -> str:
    """Return a message if a header names one of the columns more than once, since their cells may differ;
    else ""."""
    titles = [as_written(title.strip()).casefold() for title in header]
    duplicate = next((column for column in columns if titles.count(column) > 1), "")
    template = "the header names the column {column} twice; remove one of them"
    return Message(template, column=duplicate) if duplicate else ""


def encoding_of(data: bytes) -> str:
    """Return the encoding of a table: UTF-8 if it decodes, else that of Windows and Excel."""
    for encoding in ("utf-16", "utf-8-sig") if data[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig",):
        try:
            data.decode(encoding)
            return encoding
        except UnicodeDecodeError:
            pass
    return "cp1252"


def _marked_once(data: bytes) -> bytes:
    """Return the data without repeated byte-order marks, which editors and scripts add."""
    mark = codecs.BOM_UTF8
    while data.startswith(2 * mark):
        data = data[len(mark) :]
    return data


def decode(data: bytes) -> tuple[str, str]:
    """Return the text and a warning, "" if there is none."""
    data = _marked_once(data)
    encoding = encoding_of(data)
    return data.decode(encoding, "replace"), _WARNINGS[encoding]


def record(lines: list[str], start: int, delimiter: str, width: int) -> tuple[list[str], int]:
    """Return the cells of the record at a line, and its number of lines.

    A quoted cell may run over a few lines, if the record is then well formed, has as many cells as the
    header, and swallows no line that would be a record by itself. Any other quotation mark is a
    character like another: it costs no row, and is kept.
    """
    cells_of_line = _cells(lines[start], delimiter)
    if cells_of_line is not None:
        return cells_of_line, 1
    marks = lines[start].count('"')
    for line_count in range(2, min(MAX_LINES, len(lines) - start) + 1):
        added = lines[start + line_count - 1]
        if added.count(delimiter) + 1 >= width:
            break
        marks += added.count('"')
        if marks % 2 or '"' not in added:
            continue  # a cell is still open
        cells = _cells("\n".join(lines[start : start + line_count]), delimiter)
        if cells is not None and len(cells) == width:
            return cells, line_count
        if cells is not None:
            break  # a complete record; the next lines do not belong to it
    return [cell.removeprefix('"') for cell in lines[start].split(delimiter)], 1


def _cells(text: str, delimiter: str) -> list[str] | None:
    """Return the cells of a well-formed record; None if a quotation mark does not close."""
    if '"' not in text:
        return text.split(delimiter)
    try:
        return next(csv.reader([text], delimiter=delimiter, strict=True), [])
    except csv.Error:
        return None


def _refuse_nul(path: Path, data: bytes) -> None:
    """Raise if a table holds NUL: no spreadsheet and no editor writes one."""
    if b"\0" in data and "\0" in (text := data.decode(encoding_of(data), "replace")):
        line = len(re.findall(r"\r\n|\n|\r", text.partition("\0")[0])) + 1
        raise BadInput(
            "{file}, line {line}: a NUL byte, which no table contains; remove it", file=path, line=line
        )


@contextmanager
def open_csv(path: Path) -> Iterator[TextIO]:
    """Open a CSV for reading line by line, in any encoding of :func:`decode`; cells may have any length.

    Raises
    ------
    BadInput
        It holds NUL.
    """
    data = _marked_once(path.read_bytes())
    _refuse_nul(path, data)
    before = csv.field_size_limit(min(sys.maxsize, 2**31 - 1))
    try:
        yield io.TextIOWrapper(io.BytesIO(data), encoding_of(data), "replace", newline="")
    finally:
        csv.field_size_limit(before)


#: Separators of cells, in this table or in one that is opened with another separator.
_PARTS = r"\t\n\v\f\r;,\x85\u2028\u2029"
#: Characters that a spreadsheet may skip before a formula.
_UNSEEN = (
    r" \"\xa0\u1680\u2000-\u200f\u202a-\u202f\u205f-\u2069\u3000\ufeff\x00-\x08\x0e-\x1f\x7f-\x84\x86-\x9f"
)
_EQUALS, _SIGNS = "=@＝＠﹦﹫", r"+\-＋－﹢﹣"  #: first characters of formulas, also in full width
#: Text after the sign of a number: digits and a unit, or a list of such, and nothing to compute.
_NUMBERS_ALONE = (
    r"[ \xa0\u202f]?[0-9.](?:[^=@＝＠﹦﹫＋－﹢﹣+\-(|!&\"'$\[{<>#*~]|(?<=[eE^])[+-]"
    r"|(?:(?<=[;,(\[])|(?<=[;,] ))(?:[(\[]|[+-](?=[0-9.])))*"
)
_FORMULA = re.compile(
    rf"(?:\A|(?<=[{_PARTS}]))([{_UNSEEN}]*'*)(?=[{_EQUALS}]|[{_SIGNS}](?!(?:{_NUMBERS_ALONE}|[\s+-]*)\Z))"
)
_MAY_RUN = re.compile(rf"[{_EQUALS}{_SIGNS}]")


def inert(cell: Any) -> Any:
    """Return the cell with an apostrophe before any text that a spreadsheet would compute, at its start and
    after characters that may separate cells. :func:`as_written` removes them."""
    if not isinstance(cell, str) or cell.isalnum() or not _MAY_RUN.search(cell):
        return cell  # nearly all of them
    return _FORMULA.sub(r"\1'", cell)


def as_written(cell: str) -> str:
    """Return the text of a cell without the apostrophes of :func:`inert`."""
    return _FORMULA.sub(lambda before: before[1].removesuffix("'"), cell) if "'" in cell else cell


class Spreadsheet(NamedTuple):
    """Delimiter and decimal sign of a table, by the spreadsheet that opens it."""

    delimiter: str = ","
    decimal: str = "."

    def cells(self, row: Mapping[str, Any], columns: Sequence[str]) -> list[Any]:
        """Return the cells of a row, formulas made inert."""
        if self.decimal == ".":
            return [inert(row[c]) for c in columns]
        return [self._number(row[c]) if _is_number(row[c], c) else inert(row[c]) for c in columns]

    def _number(self, value: Any) -> str:
        return str(value).replace(".", self.decimal)


#: By the decimal sign. Spreadsheets with a decimal comma separate cells by semicolons.
SPREADSHEETS = {"point": Spreadsheet(), "comma": Spreadsheet(";", ",")}
_PLAIN = SPREADSHEETS["point"]

#: Columns whose texts are numbers; a student's text stays as it is.
_NUMBERS = frozenset(
    "points out_of percent mark points_before points_now mark_before mark_now value tolerance".split()
)
_NUMBER = re.compile(r"-?\d+(\.\d+)?(e[-+]?\d+)?")


def _is_number(value: Any, column: str) -> bool:
    """Return whether a cell holds one or more numbers."""
    if isinstance(value, str):
        return column in _NUMBERS and all(map(_NUMBER.fullmatch, value.split("; ")))
    return isinstance(value, float)


def csv_text(
    rows: Iterable[Mapping[str, Any]], columns: Sequence[str], spreadsheet: Spreadsheet = _PLAIN
) -> str:
    """Return rows as CSV with a header, formulas made inert."""
    out = io.StringIO()
    writer = csv.writer(out, delimiter=spreadsheet.delimiter)  # line ends follow the CSV standard
    writer.writerow(map(inert, columns))  # a title may come from a roster
    for row in rows:
        writer.writerow(spreadsheet.cells(row, columns))
    return out.getvalue()


def csv_file(
    rows: Iterable[Mapping[str, Any]], columns: Sequence[str], spreadsheet: Spreadsheet = _PLAIN
) -> bytes:
    """Return :func:`csv_text` as bytes with a byte-order mark, without which Excel damages accents."""
    return csv_text(rows, columns, spreadsheet).encode("utf-8-sig", "backslashreplace")


def json_text(content: Any) -> str:
    """Return content as the text of a JSON file."""
    return json.dumps(content, ensure_ascii=False, indent=1, allow_nan=False) + "\n"
