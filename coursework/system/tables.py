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

from coursework.errors import BadInput

MAX_LINES = 20  #: of one quoted cell
_WARNINGS = {
    "utf-8-sig": "",
    "utf-16": "the file is UTF-16, not UTF-8",
    "cp1252": "the file is not UTF-8; it was read as Windows-1252",
}


def delimiter_of(header: str) -> str:
    """What parts the cells of a CSV, by its first line: semicolon, comma or tab."""
    return max((";", ",", "\t"), key=header.count)


def said_twice(header: Iterable[str], columns: Iterable[str]) -> str:
    """What is wrong where a header names one of the columns more than once, since their cells may differ; nothing where it
    does not."""
    titles = [as_written(title.strip()).casefold() for title in header]
    twice = next((column for column in columns if titles.count(column) > 1), "")
    return f"the header names the column {twice} twice; take one of them away" if twice else ""


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
    marks = lines[start].count('"')
    for taken in range(2, min(MAX_LINES, len(lines) - start) + 1):
        added = lines[start + taken - 1]
        if added.count(delimiter) + 1 >= width:
            break
        marks += added.count('"')
        if marks % 2 or '"' not in added:
            continue  # a cell is open still
        cells = _cells("\n".join(lines[start : start + taken]), delimiter)
        if cells is not None and len(cells) == width:
            return cells, taken
        if cells is not None:
            break  # a whole record, and what follows it is none of it
    return [cell.removeprefix('"') for cell in lines[start].split(delimiter)], 1


def _cells(text: str, delimiter: str) -> list[str] | None:
    """The cells of a well-formed record; None where a quotation mark does not close as it should."""
    if '"' not in text:
        return text.split(delimiter)
    try:
        return next(csv.reader([text], delimiter=delimiter, strict=True), [])
    except csv.Error:
        return None


def _check_whole(path: Path, data: bytes) -> None:
    """Refuse a table that holds NUL: no spreadsheet and no editor puts one there."""
    if b"\0" in data and "\0" in (text := data.decode(encoding_of(data), "replace")):
        line = len(re.findall(r"\r\n|\n|\r", text.partition("\0")[0])) + 1
        raise BadInput(f"{path}, line {line}: holds a NUL byte, which no table does; take it out")


@contextmanager
def open_csv(path: Path) -> Iterator[TextIO]:
    """A CSV to be read line by line, in any encoding that :func:`decode` knows; a cell may be of any length.

    Raises
    ------
    BadInput
        It holds NUL.
    """
    data = _marked_once(path.read_bytes())
    _check_whole(path, data)
    before = csv.field_size_limit(min(sys.maxsize, 2**31 - 1))
    try:
        yield io.TextIOWrapper(io.BytesIO(data), encoding_of(data), "replace", newline="")
    finally:
        csv.field_size_limit(before)


#: What parts cells, in this table or in one that is opened with another separator than it was written with.
_PARTS = r"\t\n\v\f\r;,\x85\u2028\u2029"
#: What a spreadsheet may pass over before a formula.
_UNSEEN = (
    r" \"\xa0\u1680\u2000-\u200f\u202a-\u202f\u205f-\u2069\u3000\ufeff\x00-\x08\x0e-\x1f\x7f-\x84\x86-\x9f"
)
_EQUALS, _SIGNS = "=@＝＠﹦﹫", r"+\-＋－﹢﹣"  #: what formulas begin with, in letters of full width too
#: What follows the sign of a number: digits and a unit, or a list of such, and nothing to be computed.
_NUMBERS_ALONE = (
    r"[ \xa0\u202f]?[0-9.](?:[^=@＝＠﹦﹫＋－﹢﹣+\-(|!&\"'$\[{<>#*~]|(?<=[eE^])[+-]"
    r"|(?:(?<=[;,(\[])|(?<=[;,] ))(?:[(\[]|[+-](?=[0-9.])))*"
)
_FORMULA = re.compile(
    rf"(?:\A|(?<=[{_PARTS}]))([{_UNSEEN}]*'*)(?=[{_EQUALS}]|[{_SIGNS}](?!(?:{_NUMBERS_ALONE}|[\s+-]*)\Z))"
)
_MAY_RUN = re.compile(rf"[{_EQUALS}{_SIGNS}]")


def inert(cell: Any) -> Any:
    """The cell, or its text with an apostrophe before what a spreadsheet would compute: where it begins, and behind
    whatever may part cells. :func:`as_written` takes them away again."""
    if not isinstance(cell, str) or cell.isalnum() or not _MAY_RUN.search(cell):
        return cell  # nearly all of them
    return _FORMULA.sub(r"\1'", cell)


def as_written(cell: str) -> str:
    """The text of a cell that may have been made :func:`inert`."""
    return _FORMULA.sub(lambda before: before[1].removesuffix("'"), cell) if "'" in cell else cell


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
    "points out_of percent mark points_before points_now mark_before mark_now value tolerance".split()
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
    writer.writerow(map(inert, columns))  # a title may be a roster's own
    for row in rows:
        writer.writerow(spreadsheet.cells(row, columns))
    return out.getvalue()


def csv_file(
    rows: Iterable[Mapping[str, Any]], columns: Sequence[str], spreadsheet: Spreadsheet = _PLAIN
) -> bytes:
    """:func:`csv_text` as a file with the mark at its head without which Excel damages accents."""
    return csv_text(rows, columns, spreadsheet).encode("utf-8-sig", "backslashreplace")


def json_text(content: Any) -> str:
    """JSON as files hold it."""
    return json.dumps(content, ensure_ascii=False, indent=1, allow_nan=False) + "\n"
