"""Readers of submissions: CSV, JSON and notebooks of answers, and exports of platforms. Answers are data:
nothing is executed.

Each row of each file becomes an :class:`AnswerRow`, or a :class:`Rejected` with its reason.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from itertools import islice
from operator import itemgetter
from pathlib import Path
from typing import Any, BinaryIO

from coursework.errors import BadInput, closest, reason_of
from coursework.gradebook.notebooks import read_notebook
from coursework.gradebook.platform_files import NO_ANSWERS, fault_of, read_records, read_table, reader_of
from coursework.gradebook.qti_results import read_results
from coursework.gradebook.rows import (
    TITLES,
    AnswerRow,
    PlatformFile,
    Rejected,
    as_answer,
    decoded_text,
    load_json,
    name_in,
    path_text,
    sheet_rows,
    short_fault,
)
from coursework.gradebook.submission_folders import SIDE_FILES, SubmittedFile, submitted_file, superseded
from coursework.issuing.identity import plain
from coursework.issuing.issued import COLUMNS
from coursework.language.words import languages
from coursework.messages import Message, joined_notes, localised
from coursework.system.extras import NotAtHand, library
from coursework.system.limits import MOST_BYTES as MAX_BYTES
from coursework.system.limits import (
    MOST_CELL,
    MOST_COLUMNS,
    MOST_NOTEBOOK_BYTES,
    MOST_ROWS,
    MOST_UNPACKED,
    beyond,
)
from coursework.system.links import LEADS_OUT, LeadsOut, folder_of, open_inside, walked
from coursework.system.tables import as_written, delimiter_of, duplicate_column, record

ENDINGS = (".csv", ".json", ".ipynb", ".parquet", ".xml", ".tsv")


def find(paths: Iterable[Path]) -> Iterator[Path | Rejected]:
    """Yield the files to read; the files of a folder in the order of their names; without earlier submissions
    to nbgrader's exchange.

    Raises
    ------
    BadInput
        One of the paths is not there.
    """
    paths = tuple(paths)
    for path in paths:
        if not path.exists():
            raise BadInput("no such file or folder: {file}{hint}", file=path, hint=_similar_file(path))
    found = [one for path in paths for one in (_files_below(path) if path.is_dir() else (path,))]
    earlier = superseded([one for one in found if isinstance(one, Path)])
    for one in found:
        if isinstance(one, Rejected):
            yield one
        elif one.name not in SIDE_FILES and one not in earlier:
            yield one if one.suffix.lower() in ENDINGS else _odd_file(one)


def _files_below(folder: Path) -> Iterator[Path | Rejected]:
    walked_files = walked(folder)
    files = [p for p in walked_files.files if not _is_hidden(p, folder)]
    refused = [p for p in walked_files.refused if not _is_hidden(p, folder)]
    yield from (Rejected(path_text(p), LEADS_OUT) for p in refused)
    yield from files
    if not files and not refused:
        yield Rejected(path_text(folder), Message("the folder contains no file"))


def _similar_file(path: Path) -> str:
    """Return a hint with the file or folder of a similar name; empty if there is none."""
    names = [p.name for p in path.parent.iterdir()] if path.parent.is_dir() else []
    near = closest(path.name, names)
    if near is None:
        return ""
    meant = path.with_name(near)
    return Message(" (did you mean {file}?)", file=f"{meant}{'/' if meant.is_dir() else ''}")


def _is_hidden(path: Path, below: Path) -> bool:
    return any(part.startswith(".") for part in path.relative_to(below).parts)


_SPREADSHEETS = (".xlsx", ".xls", ".ods")


def _odd_file(path: Path) -> Rejected:
    if path.suffix.lower() in _SPREADSHEETS:
        return Rejected(
            path_text(path),
            Message("a spreadsheet is not read: download the table as CSV (comma separated values)"),
        )
    ending = Path(path_text(path)).suffix or "no file extension"
    return Rejected(
        path_text(path),
        Message("answers come as {endings}; found {found}", endings=", ".join(ENDINGS), found=ending),
    )


def read_file(path: Path, given: Iterable[Path] = ()) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    """Yield the rows of one file; a file that cannot be read is one rejected row.

    ``given`` is what somebody named, a folder of which may hold the file: nothing outside of that folder is
    read.
    """
    folder = folder_of(path, given)
    handed = submitted_file(path) if path.suffix.lower() == ".ipynb" else None
    if handed is None:
        yield from _read(path, None, folder)
        return
    yield handed.seen
    for row in _read(path, handed, folder):
        yield row._replace(origin=handed.origin) if isinstance(row, AnswerRow) else row


def read_rows(path: Path, most: int) -> list[AnswerRow | Rejected | PlatformFile] | None:
    """Return the rows of one file; None where it has more than ``most``."""
    rows = list(islice(read_file(path), most + 1))
    return rows if len(rows) <= most else None


def _read(
    path: Path, handed: SubmittedFile | None, folder: Path | None
) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    try:
        file = path.open("rb") if folder is None else open_inside(path, folder)
    except OSError as fault:
        refused = (
            LEADS_OUT
            if isinstance(fault, LeadsOut)
            else Message("cannot be read: {problem}", problem=reason_of(fault))
        )
        yield Rejected(path_text(path), refused)
        return
    with file:
        if path.suffix.lower() == ".parquet":
            yield from _read_parquet(path, file)
        else:
            yield from _read_whole(path, file, handed)


def _read_whole(
    path: Path, file: BinaryIO, handed: SubmittedFile | None
) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    reader = _READERS[path.suffix.lower()]
    try:
        size = os.fstat(file.fileno()).st_size
        most = MOST_NOTEBOOK_BYTES if path.suffix.lower() == ".ipynb" else MAX_BYTES
        if size > most:
            yield Rejected(path_text(path), beyond("a file", size, most, "bytes"))
            return
        data = file.read()
    except OSError as fault:
        yield Rejected(path_text(path), Message("cannot be read: {problem}", problem=reason_of(fault)))
        return
    rows = (
        reader(data, path_text(path)) if handed is None else read_notebook(data, path_text(path), handed.name)
    )
    del data  # a reader lets go of it, too
    yield from rows


# ------------------------------------------------------------------------- text


def _read_csv(data: bytes, source: str) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    if not data.strip():
        yield Rejected(source, Message("the file is empty"))
        return
    text, warning = decoded_text(data, source)
    if "\0" in text:
        yield Rejected(source, Message("the file contains NUL bytes: it is not a CSV of answers"))
        return
    lines = re.split(r"\r\n|\n|\r", text)
    del text, data
    first = next((line for line in lines if line.strip()), "")
    delimiter = delimiter_of(first)
    if len(lines) > MOST_ROWS + 1:
        yield Rejected(source, beyond("a file", len(lines) - 1, MOST_ROWS, "rows"))
        return
    if (columns := first.count(delimiter) + 1) > MOST_COLUMNS:
        yield Rejected(source, beyond("a table", columns, MOST_COLUMNS, "columns"))
        return
    header: list[str] = []
    named: Callable[[list[str]], Sequence[str]] = tuple
    number, has_rows = 0, False
    while number < len(lines):
        location = f"{source}, line {number + 1}"
        cells, row_record = record(lines, number, delimiter, len(header))
        number += row_record
        if not any(c.strip() for c in cells):
            continue  # a blank line is not a row
        if header:
            has_rows = True
            yield from _csv_row(header, cells, delimiter, location, warning)
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
        header = _columns_called(cells)
        missing = [c for c in COLUMNS if c not in header]
        if missing and (table := reader_of(cells)):
            yield from read_table(table, "\n".join(lines), delimiter, source, warning)
            return
        if missing:
            titles = ", ".join(c for c in header if c) or "nothing"
            wanted = Message(
                "the header must name {columns}; {missing} missing, found {found}",
                columns=joined_notes(TITLES.values(), ", "),
                missing=joined_notes((TITLES[c] for c in missing), ", "),
                found=titles,
            )
            yield Rejected(location, fault_of(cells) or wanted)
            return
        if twice := duplicate_column(header, COLUMNS):
            yield Rejected(location, twice)
            return
        named = itemgetter(*(header.index(c) for c in COLUMNS))
    if not has_rows:
        yield Rejected(source, NO_ANSWERS)


@cache
def _columns_by_title() -> dict[str, str]:
    """Return the columns of answers by their titles in all languages."""
    return {plain(localised(title, lang)): column for column, title in TITLES.items() for lang in languages()}


def _columns_called(cells: Sequence[str]) -> list[str]:
    """Return the names of columns by their titles; those of answers alone may be in another language."""
    header = [c.strip().casefold() for c in cells]
    known = [_columns_by_title().get(plain(title), title) for title in header]
    return known if set(COLUMNS) <= set(known) else header


def _row_of(cells: Sequence[str], location: str, warning: str) -> AnswerRow:
    """Return the row of the cells of :data:`COLUMNS`, in their order."""
    student, exercise, seed, part, answer = cells
    if "'" in student or "'" in answer:
        student, answer = as_written(student), as_written(answer)
    # A class has a few texts that repeat: each is stored once.
    return AnswerRow(
        _kept(student.strip()),
        _kept(exercise.strip()),
        _kept(seed.strip()),
        _kept(part.strip()),
        answer,
        location,
        warning,
    )


_kept = sys.intern


def _read_parquet(path: Path, opened: BinaryIO) -> Iterator[AnswerRow | Rejected]:
    """Yield the rows of a Parquet file with the columns of the CSV; the seed and the answer may be
    numbers."""
    try:
        pyarrow: Any = library("pyarrow", "Parquet needs", "parquet")
        parquet: Any = library("pyarrow.parquet", "Parquet needs", "parquet")
    except NotAtHand as why:
        yield Rejected(path_text(path), str(why))
        return
    try:
        file = parquet.ParquetFile(opened)
        missing = [c for c in COLUMNS if c not in file.schema_arrow.names]
        if missing:
            wanted = Message(
                "a Parquet file has the columns {columns}; {missing} missing",
                columns=", ".join(COLUMNS),
                missing=", ".join(missing),
            )
            yield Rejected(path_text(path), wanted)
            return
        if refused := _beyond(file.metadata) or _odd_columns(pyarrow.types, file.schema_arrow):
            yield Rejected(path_text(path), refused)
            return
        plain = {file.schema.column(k).path for k in range(len(file.schema))}  # one of lists is not
        file = parquet.ParquetFile(opened, read_dictionary=[c for c in COLUMNS if c in plain])
        number, source = 0, path_text(path)
        for batch in file.iter_batches(columns=list(COLUMNS)):
            for cells in zip(*(_cells_of(batch.column(c), c) for c in COLUMNS), strict=True):
                student, exercise, seed, part, answer = cells
                number += 1
                location = f"{source}, row {number}"
                if isinstance(answer, str) and len(answer) > MOST_CELL:
                    row = {**dict(zip(COLUMNS, cells, strict=True)), "answer": answer[:200]}
                    yield Rejected(location, beyond("an answer", len(answer), MOST_CELL, "characters"), row)
                    continue
                yield AnswerRow(student, exercise, seed, part, answer, location)
        if not number:
            yield Rejected(source, NO_ANSWERS)
    # What is damaged, pyarrow tells in one of many ways: by a column that is not there, too.
    except (OSError, ValueError, LookupError, OverflowError, pyarrow.ArrowException) as fault:
        yield Rejected(path_text(path), Message("not a Parquet file: {problem}", problem=short_fault(fault)))


def _beyond(about: Any) -> str:
    """Return the reason for which a Parquet file is too large to read, from its metadata; empty if it is
    not."""
    if about.num_rows > MOST_ROWS:
        return beyond("a file", about.num_rows, MOST_ROWS, "rows")
    size = sum(about.row_group(k).total_byte_size for k in range(about.num_row_groups))
    return beyond("a file", size, MOST_UNPACKED, "bytes unpacked") if size > MOST_UNPACKED else ""


def _cells_of(column: Any, name: str) -> list[Any]:
    """Return the cells of a column of Parquet, each different one stored once: a small file may repeat one
    text a million times."""
    read = as_answer if name == "answer" else name_in
    if not hasattr(column, "dictionary"):
        return [read(cell) for cell in column.to_pylist()]
    texts = [read(text) for text in column.dictionary.to_pylist()]
    return [read(None) if k is None else texts[k] for k in column.indices.to_pylist()]


def _odd_columns(types: Any, schema: Any) -> str:
    """Return a message about the columns of a Parquet file if one occurs twice, or contains neither texts nor
    numbers."""

    def is_read(kind: Any) -> bool:
        if types.is_dictionary(kind) or types.is_list(kind) or types.is_large_list(kind):
            return is_read(kind.value_type)
        tests = ("string", "large_string", "integer", "floating", "decimal", "boolean", "null")
        return any(getattr(types, f"is_{test}")(kind) for test in tests)

    for column in COLUMNS:
        if len(schema.get_all_field_indices(column)) > 1:
            return Message("the file has the column {column} twice", column=column)
        if not is_read(kind := schema.field(column).type):
            kind = getattr(kind, "value_type", kind)
            return Message(
                "the column {column} contains {kind}: an answer is a text or a number, a name is a text",
                column=column,
                kind=str(kind)[:40],
            )
    return ""


def _csv_row(
    header: list[str], cells: list[str], delimiter: str, location: str, warning: str
) -> Iterator[AnswerRow | Rejected]:
    if len(cells) > len(header) and delimiter == ",":
        joined = _with_commas(header, cells)
        if header[-1] == "answer" and cells[header.index("seed")].strip().isdigit():
            note = Message(
                "{place}: an answer with a comma and no quotation marks was read up to the end of its line",
                place=location,
            )
            yield _row_of([joined[c] for c in COLUMNS], location, warning or note)
            return
    row = dict(zip(header, cells, strict=False))
    if len(cells) != len(header):
        cells_read = {c: row.get(c, "") for c in COLUMNS}
        reason = Message(
            "{cells} cell{cells:|s} where the header has {most}", cells=len(cells), most=len(header)
        )
        if delimiter == "," and len(cells) > len(header):
            cells_read["answer"] = joined["answer"]
            reason = Message(
                "{problem}; put an answer with a comma between quotation marks, or semicolons between "
                "all cells",
                problem=reason,
            )
        yield Rejected(location, reason, cells_read)
        return
    yield _row_of([row[c] for c in COLUMNS], location, warning)


def _with_commas(header: list[str], cells: list[str]) -> dict[str, str]:
    """Return a row with too many cells, whose surplus cells are joined to the answer: ``12`` and ``5`` are
    ``12,5``."""
    index, more = header.index("answer"), len(cells) - len(header)
    answer = ",".join(cells[index : index + more + 1])
    return dict(zip(header, [*cells[:index], answer, *cells[index + more + 1 :]], strict=True))


# ------------------------------------------------------------------------- JSON


def _read_json(data: bytes, source: str) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    text, warning = decoded_text(data, source)
    try:
        content = load_json(text)
    except (ValueError, RecursionError) as fault:
        yield Rejected(source, Message("not JSON: {problem}", problem=short_fault(fault)))
        return
    if (rows := read_records(content, source, warning)) is not None:
        yield from rows
        return
    sheets = content if isinstance(content, list) else [content]
    if not sheets:
        yield Rejected(source, NO_ANSWERS)
    for number, sheet in enumerate(sheets, start=1):
        location = f"{source}, item {number}" if isinstance(content, list) else source
        if not isinstance(sheet, dict) or not isinstance(sheet.get("answers"), dict):
            yield Rejected(
                location, Message('an item is {"student", "exercise", "seed", "answers": {part: text}}')
            )
            continue
        yield from sheet_rows(sheet, sheet["answers"], location, warning)


_READERS: Mapping[str, Callable[[bytes, str], Iterator[AnswerRow | Rejected | PlatformFile]]] = {
    ".csv": _read_csv,
    ".tsv": _read_csv,
    ".json": _read_json,
    ".ipynb": read_notebook,
    ".xml": read_results,
}
