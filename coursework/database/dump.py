"""Dump of a database as files, one CSV per table, and its restoration into any database."""

from __future__ import annotations

import csv
import json
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any, TypeAlias

from sqlalchemy import JSON, Boolean, Column, Connection, Double, Integer, Table, func, insert, select, text
from sqlalchemy.exc import DBAPIError

from coursework.database.assignments import issued_of
from coursework.database.store import Store, json_of
from coursework.database.submissions import rows_of
from coursework.database.tables import METADATA, UTCDateTime, assignment
from coursework.errors import BadInput, reason_of
from coursework.system.folder_lock import is_bare
from coursework.system.json_files import read_json
from coursework.system.links import check_inside
from coursework.system.tables import as_written, inert
from coursework.system.writing import removed_on_failure, write_whole

_NULL = "\\N"  #: marks a cell without a value; a text that begins with \ gets another before it
CellText: TypeAlias = Callable[[str], str]
_CHUNK = 5000  #: rows that are written at once
FORMAT = "coursework database dump 2"
_BEFORE = "coursework database dump 1"  #: which left cells as they are, whatever a spreadsheet makes of them
_ABOUT = "dump.json"


# --------------------------------------------------------------------------- out


def dump(store: Store, folder: Path) -> dict[str, int]:
    """Write every table, as it is at one moment, to ``TABLE.csv``; return the number of rows of each.

    A text that a spreadsheet would run has an apostrophe before it, which :func:`restore` takes away.

    Raises
    ------
    BadInput
        The folder holds other files, or cannot be written.
    """
    if not is_bare(folder) and not (folder / _ABOUT).exists():
        raise BadInput("{folder} contains other files: name an empty folder, or a new one", folder=folder)
    (folder / _ABOUT).unlink(missing_ok=True)  # what is half written is not a dump
    rows = {}
    with store.reading() as connection:
        for table in _dumped():
            rows[table.name] = _write(connection, table, folder / f"{table.name}.csv")
    about = {"format": FORMAT, "rows": rows}
    write_whole(folder / _ABOUT, (json.dumps(about, indent=1) + "\n").encode())
    return rows


def _dumped() -> list[Table]:
    """Return the tables of a dump: without those computed from others, and without sessions."""
    return [table for table in METADATA.sorted_tables if not table.info.keys() & {"derived", "fleeting"}]


def _write(connection: Connection, table: Table, path: Path) -> int:
    folder, part = path.parent, path.with_name(path.name + ".part")
    folder.mkdir(parents=True, exist_ok=True)
    rows = connection.execution_options(yield_per=_CHUNK).execute(select(table).order_by(*table.primary_key))
    count = 0
    try:
        with removed_on_failure(part), open(part, "w", encoding="utf-8", newline="", opener=_private) as file:
            writer = csv.writer(file)
            writer.writerow(column.name for column in table.c)
            to_text = [json_of if isinstance(column.type, JSON) else _as_text for column in table.c]
            for row in rows:
                writer.writerow(
                    _NULL if value is None else inert(show(value))
                    for show, value in zip(to_text, row, strict=True)
                )
                count += 1
            file.close()
            part.replace(path)
    except OSError as fault:
        raise BadInput("{file} cannot be written: {problem}", file=path, problem=reason_of(fault)) from fault
    return count


def _private(path: str, flags: int) -> int:
    """Open a file that its owner alone may read, since it contains the data of the database."""
    return os.open(path, flags, 0o600)


def _as_text(value: Any) -> str:
    if isinstance(value, str):
        return f"\\{value}" if value.startswith("\\") else value
    return value.isoformat() if isinstance(value, datetime) else repr(value)


# -------------------------------------------------------------------------- back


def restore(folder: Path, store: Store) -> dict[str, int]:
    """Load a dump into an empty database; return the number of rows of each table.

    Raises
    ------
    BadInput
        The folder contains no dump, or one that this version cannot read, or the database is not empty. Then
        nothing is stored.
    """
    counted, cell_text = _about(folder)
    rows = {}
    with _naming_folder(folder), store.begin() as connection:
        for table in METADATA.sorted_tables:
            if connection.execute(select(*table.primary_key).limit(1)).first() is not None:
                raise BadInput(
                    "the database is not empty: there are rows in {table}; name a new one", table=table.name
                )
        for table in _dumped():
            path = folder / f"{table.name}.csv"
            check_inside(path, folder)
            rows[table.name] = _read(connection, table, path, cell_text)
            if rows[table.name] != counted.get(table.name, 0):
                raise BadInput(
                    "{file} has {rows} row{rows:|s}, and the dump had {expected}",
                    file=path,
                    rows=rows[table.name],
                    expected=counted.get(table.name, 0),
                )
            _continue_numbering(connection, table)
        _check_readable(connection)
    return rows


@contextmanager
def _naming_folder(folder: Path) -> Iterator[None]:
    """Turn a fault of the database into a message that names the folder of the dump."""
    try:
        yield
    except (DBAPIError, OverflowError, UnicodeEncodeError) as fault:
        reason = " ".join(str(getattr(fault, "orig", fault)).split())[:120]
        raise BadInput(
            "{folder} is damaged, and nothing was restored: {reason}", folder=folder, reason=reason
        ) from fault


def _check_readable(connection: Connection) -> None:
    """Check that the restored rows can be read, since cells of JSON may contain anything. Raises BadInput: it
    cannot."""
    for number, name in connection.execute(select(assignment.c.id, assignment.c.name)).all():
        try:
            issued_of(connection, number)
            for _ in rows_of(connection, number):
                pass
        except (KeyError, TypeError, ValueError, AttributeError) as fault:
            reason = fault if isinstance(fault, BadInput) else f"{type(fault).__name__} {str(fault)[:60]}"
            raise BadInput(
                "the part of the dump about {name} cannot be read: {reason}; nothing was restored",
                name=name,
                reason=reason,
            ) from fault


def _about(folder: Path) -> tuple[Mapping[str, int], CellText]:
    """Return the number of rows of each table, and the function that reads the text of a cell."""
    if not (folder / _ABOUT).is_file():
        raise BadInput(
            "{folder} contains no dump, as it has no {file}; 'coursework database dump' makes one",
            folder=folder,
            file=_ABOUT,
        )
    check_inside(folder / _ABOUT, folder)
    about = read_json(folder / _ABOUT)
    if not isinstance(about, dict) or about.get("format") not in (FORMAT, _BEFORE):
        raise BadInput(
            "{folder} is of another version: {file} states {content}",
            folder=folder,
            file=_ABOUT,
            content=str(about)[:60],
        )
    rows = about.get("rows")
    if not isinstance(rows, dict) or not all(isinstance(count, int) for count in rows.values()):
        raise BadInput("{file} does not state the number of rows of each table", file=folder / _ABOUT)
    if strangers := rows.keys() - {table.name for table in _dumped()}:
        raise BadInput(
            "{folder} is of a later version: there is no table {tables}",
            folder=folder,
            tables=", ".join(sorted(strangers)),
        )
    return rows, as_written if about["format"] == FORMAT else str


def _read(connection: Connection, table: Table, path: Path, cell_text: CellText) -> int:
    if not path.exists():
        return 0
    count = 0
    try:
        for rows in _chunks(table, path, cell_text):
            with _naming_folder(path):
                connection.execute(insert(table), rows)
            count += len(rows)
    except UnicodeDecodeError as fault:
        raise BadInput(
            "{file} is not UTF-8, about byte {position}", file=path, position=fault.start
        ) from fault
    except csv.Error as fault:
        raise BadInput("{file} is not CSV: {problem}", file=path, problem=fault) from fault
    return count


def _chunks(table: Table, path: Path, cell_text: CellText) -> Iterator[list[dict[str, Any]]]:
    csv.field_size_limit(2**31 - 1)
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.reader(file)
        names = next(reader, [])
        if not _has_columns(table, names):
            raise BadInput(
                "{file} has the columns {found}; {table} has {columns}",
                file=path,
                found=", ".join(names),
                table=table.name,
                columns=", ".join(table.c.keys()),
            )
        makers = [_maker(table.c[name]) for name in names]
        rows: list[dict[str, Any]] = []
        for cells in reader:
            rows.append(_row(path, reader.line_num, names, makers, [*map(cell_text, cells)]))
            if len(rows) == _CHUNK:
                yield rows
                rows = []
    if rows:
        yield rows


def _has_columns(table: Table, names: Sequence[str]) -> bool:
    """Return True if a dump has the columns of a table, each once; an older one may lack columns that
    may be empty."""
    wanted = {column.name for column in table.c if not column.nullable}
    return len({*names}) == len(names) and wanted <= {*names} <= {*table.c.keys()}


def _row(
    path: Path, line: int, names: Sequence[str], makers: Sequence[Callable[[str], Any]], cells: Sequence[str]
) -> dict[str, Any]:
    if len(cells) != len(names):
        raise BadInput(
            "{file}, line {line}: {cells} cell{cells:|s} where the header has {most}",
            file=path,
            line=line,
            cells=len(cells),
            most=len(names),
        )
    row = {}
    for name, make, cell in zip(names, makers, cells, strict=True):
        try:
            row[name] = None if cell == _NULL else make(cell)
        except (ValueError, RecursionError) as fault:
            raise BadInput(
                "{file}, line {line}: {column} has a value that no dump has: {cell!r}",
                file=path,
                line=line,
                column=name,
                cell=cell[:40],
            ) from fault
    return row


def _maker(column: Column[Any]) -> Callable[[str], Any]:
    """Return the function that makes a value from its cell."""
    for kind, make in _MAKERS:
        if isinstance(column.type, kind):
            return make
    return lambda cell: cell.removeprefix("\\") if cell.startswith("\\") else cell


def _integer(cell: str) -> int:
    if not -(2**63) <= (number := int(cell)) < 2**63:
        raise ValueError(cell)
    return number


def _decimal(cell: str) -> float:
    if not math.isfinite(number := float(cell)):
        raise ValueError(cell)
    return number


_MAKERS: tuple[tuple[type[Any], Callable[[str], Any]], ...] = (
    (JSON, json.loads),
    (UTCDateTime, datetime.fromisoformat),
    (Boolean, lambda cell: ("False", "True").index(cell) == 1),
    (Integer, _integer),
    (Double, _decimal),
)


def _continue_numbering(connection: Connection, table: Table) -> None:
    """Set the sequence of a server to continue after the inserted rows."""
    if connection.dialect.name == "postgresql" and "id" in table.c:
        last = connection.execute(select(func.max(table.c.id))).scalar()
        if last is not None:
            sequence = text("SELECT setval(pg_get_serial_sequence(:name, 'id'), :last)")
            connection.execute(sequence, {"name": table.name, "last": last})
