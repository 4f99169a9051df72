"""Reading what comes back: CSV, JSON and notebooks of answers, and what platforms export. Answers are data: nothing is run.

Every row of every file comes out, as a :class:`Row` or as a :class:`Rejected` with its reason.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from operator import itemgetter
from pathlib import Path
from typing import Any

from coursework.errors import BadInput, closest
from coursework.gradebook.notebooks import read_notebook
from coursework.gradebook.platform_files import fault_of, read_records, read_table, reader_of
from coursework.gradebook.qti_results import read_results
from coursework.gradebook.rows import (
    Rejected,
    Row,
    Seen,
    as_answer,
    decoded_text,
    load_json,
    name_in,
    sheet_rows,
    short_fault,
)
from coursework.gradebook.trees import BESIDE, HandedIn, handed_in, latest_first
from coursework.making.issued import COLUMNS
from coursework.system.extras import NotAtHand, library
from coursework.system.tables import as_written, delimiter_of, record

ENDINGS = (".csv", ".json", ".ipynb", ".parquet", ".xml", ".tsv")
MAX_BYTES = 1_000_000_000  #: of one file of answers


def find(paths: Iterable[Path]) -> Iterator[Path | Rejected]:
    """The files to read, folders walked in name order.

    Raises
    ------
    BadInput
        One of the paths is not there.
    """
    paths = tuple(paths)
    for path in paths:
        if not path.exists():
            raise BadInput(f"no such file or folder: {path}{_beside(path)}")
    for path in paths:
        if path.is_dir():
            files = latest_first(p for p in path.rglob("*") if p.is_file() and not _is_hidden(p, path))
            yield from (
                p if p.suffix.lower() in ENDINGS else _odd_file(p) for p in files if p.name not in BESIDE
            )
            if not files:
                yield Rejected(str(path), "the folder holds no file")
        elif path.suffix.lower() not in ENDINGS:
            yield _odd_file(path)
        else:
            yield path


def _beside(path: Path) -> str:
    """The file or folder that may have been meant, if one of nearly that name is there."""
    names = [p.name for p in path.parent.iterdir()] if path.parent.is_dir() else []
    near = closest(path.name, names)
    if near is None:
        return ""
    meant = path.with_name(near)
    return f" (did you mean {meant}{'/' if meant.is_dir() else ''}?)"


def _is_hidden(path: Path, below: Path) -> bool:
    return any(part.startswith(".") for part in path.relative_to(below).parts)


_SPREADSHEETS = (".xlsx", ".xls", ".ods")


def _odd_file(path: Path) -> Rejected:
    if path.suffix.lower() in _SPREADSHEETS:
        return Rejected(
            str(path), "a spreadsheet is not read: download the table as CSV (comma separated values)"
        )
    return Rejected(str(path), f"answers come as {', '.join(ENDINGS)}; found {path.suffix or 'no ending'}")


def read_file(path: Path) -> Iterator[Row | Rejected | Seen]:
    """The rows of one file; a file that cannot be read is one rejected row."""
    place = handed_in(path) if path.suffix.lower() == ".ipynb" else None
    if place is None:
        yield from _read(path, None)
        return
    yield place.seen
    for row in _read(path, place):
        yield row._replace(origin=place.origin) if isinstance(row, Row) else row


def _read(path: Path, place: HandedIn | None) -> Iterator[Row | Rejected | Seen]:
    if path.suffix.lower() == ".parquet":
        yield from _read_parquet(path)
        return
    reader = _READERS[path.suffix.lower()]
    try:
        size = path.stat().st_size
        if size > MAX_BYTES:
            yield Rejected(str(path), f"{size:,} bytes are too many for answers; the limit is {MAX_BYTES:,}")
            return
        data = path.read_bytes()
    except OSError as fault:
        yield Rejected(str(path), f"cannot be read: {fault.strerror}")
        return
    rows = reader(data, str(path)) if place is None else read_notebook(data, str(path), place.name)
    del data  # a reader lets go of it, too
    yield from rows


# ------------------------------------------------------------------------- text


def _read_csv(data: bytes, source: str) -> Iterator[Row | Rejected | Seen]:
    if not data.strip():
        yield Rejected(source, "the file is empty")
        return
    text, warning = decoded_text(data, source)
    if "\0" in text:
        yield Rejected(source, "the file holds NUL bytes: it is not a CSV of answers")
        return
    lines = re.split(r"\r\n|\n|\r", text)
    del text, data
    delimiter = delimiter_of(lines[0])
    header: list[str] = []
    named: Callable[[list[str]], Sequence[str]] = tuple
    number = 0
    while number < len(lines):
        place = f"{source}, line {number + 1}"
        cells, taken = record(lines, number, delimiter, len(header))
        number += taken
        if not any(c.strip() for c in cells):
            continue  # a blank line is no row
        if header:
            yield from _csv_row(header, cells, delimiter, place, warning)
            # Lines that are plain, as nearly all are, without more ado.
            while number < len(lines) and '"' not in lines[number]:
                cells = lines[number].split(delimiter)
                if len(cells) != len(header):
                    break
                lines[number] = ""  # read: a million of them take room
                number += 1
                if any(map(str.strip, cells)):
                    yield _row_of(named(cells), f"{source}, line {number}", warning)
            continue
        header = [c.strip().casefold() for c in cells]
        missing = [c for c in COLUMNS if c not in header]
        if missing and (table := reader_of(cells)):
            yield from read_table(table, "\n".join(lines), delimiter, source, warning)
            return
        if missing:
            found = ", ".join(c for c in header if c) or "nothing"
            wanted = f"the header must name {', '.join(COLUMNS)}; {', '.join(missing)} missing, found {found}"
            yield Rejected(place, fault_of(cells) or wanted)
            return
        named = itemgetter(*(header.index(c) for c in COLUMNS))


def _row_of(cells: Sequence[str], place: str, warning: str) -> Row:
    """The row of the cells of :data:`COLUMNS`, in their order."""
    student, exercise, seed, part, answer = cells
    if "'" in (student[:1], answer[:1]):
        student, answer = as_written(student), as_written(answer)
    # Of a class they are a few texts, over and over: kept once.
    return Row(
        _kept(student.strip()),
        _kept(exercise.strip()),
        _kept(seed.strip()),
        _kept(part.strip()),
        answer,
        place,
        warning,
    )


_kept = sys.intern


def _read_parquet(path: Path) -> Iterator[Row | Rejected]:
    """The rows of a Parquet file with the columns of the CSV; the seed and the answer may be numbers."""
    try:
        pyarrow: Any = library("pyarrow", "Parquet needs", "parquet")
        parquet: Any = library("pyarrow.parquet", "Parquet needs", "parquet")
    except NotAtHand as why:
        yield Rejected(str(path), str(why))
        return
    try:
        file = parquet.ParquetFile(path)
        missing = [c for c in COLUMNS if c not in file.schema_arrow.names]
        if missing:
            wanted = f"a Parquet file has the columns {', '.join(COLUMNS)}; {', '.join(missing)} missing"
            yield Rejected(str(path), wanted)
            return
        number = 0
        for batch in file.iter_batches(columns=list(COLUMNS)):
            for student, exercise, seed, part, answer in zip(
                *(batch.column(c).to_pylist() for c in COLUMNS), strict=True
            ):
                number += 1
                names = (name_in(student), name_in(exercise), name_in(seed), name_in(part))
                yield Row(*names, as_answer(answer), f"{path}, row {number}")
    except (OSError, pyarrow.ArrowException) as fault:
        yield Rejected(str(path), f"not a Parquet file: {short_fault(fault)}")


def _csv_row(
    header: list[str], cells: list[str], delimiter: str, place: str, warning: str
) -> Iterator[Row | Rejected]:
    if len(cells) > len(header) and delimiter == ",":
        joined = _with_commas(header, cells)
        if header[-1] == "answer" and cells[header.index("seed")].strip().isdigit():
            note = (
                f"{place}: an answer with a comma and no quotation marks was read up to the end of its line"
            )
            yield _row_of([joined[c] for c in COLUMNS], place, warning or note)
            return
    row = dict(zip(header, cells, strict=False))
    if len(cells) != len(header):
        kept = {c: row.get(c, "") for c in COLUMNS}
        reason = f"{len(cells)} cells where the header has {len(header)}"
        if delimiter == "," and len(cells) > len(header):
            kept["answer"] = joined["answer"]
            reason += "; put an answer with a comma between quotation marks, or semicolons between all cells"
        yield Rejected(place, reason, kept)
        return
    yield _row_of([row[c] for c in COLUMNS], place, warning)


def _with_commas(header: list[str], cells: list[str]) -> dict[str, str]:
    """A row of too many cells whose answer is all that may belong to it: ``12`` and ``5`` are ``12,5``."""
    place, more = header.index("answer"), len(cells) - len(header)
    answer = ",".join(cells[place : place + more + 1])
    return dict(zip(header, [*cells[:place], answer, *cells[place + more + 1 :]], strict=True))


# ------------------------------------------------------------------------- JSON


def _read_json(data: bytes, source: str) -> Iterator[Row | Rejected | Seen]:
    text, warning = decoded_text(data, source)
    try:
        content = load_json(text)
    except (ValueError, RecursionError) as fault:
        yield Rejected(source, f"not JSON: {short_fault(fault)}")
        return
    if (rows := read_records(content, source, warning)) is not None:
        yield from rows
        return
    sheets = content if isinstance(content, list) else [content]
    if not sheets:
        yield Rejected(source, "the file holds no answers")
    for number, sheet in enumerate(sheets, start=1):
        place = f"{source}, item {number}" if isinstance(content, list) else source
        if not isinstance(sheet, dict) or not isinstance(sheet.get("answers"), dict):
            yield Rejected(place, 'an item is {"student", "exercise", "seed", "answers": {part: text}}')
            continue
        yield from sheet_rows(sheet, sheet["answers"], place, warning)


_READERS: Mapping[str, Callable[[bytes, str], Iterator[Row | Rejected | Seen]]] = {
    ".csv": _read_csv,
    ".tsv": _read_csv,
    ".json": _read_json,
    ".ipynb": read_notebook,
    ".xml": read_results,
}
