"""Open database: its tables completed for this version, its faults reported in one line."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, Table, create_engine, event, make_url
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.exc import ArgumentError, DatabaseError, DBAPIError, NoSuchModuleError, OperationalError
from sqlalchemy.exc import TimeoutError as NoConnection

from coursework.database.schema import complete_tables, later_version
from coursework.errors import BadInput
from coursework.messages import Message
from coursework.system.sqlite_files import scrub

_READS = "coursework_reads"  #: said of a connection that writes nothing
#: Of one process at most: four of them leave a PostgreSQL of the usual settings, 100, some for others.
CONNECTIONS = 20
_PATIENCE = 30  #: seconds for which a write waits for another


class Store:
    """Database with the tables of :mod:`coursework.database.tables`.

    ``url`` is SQLAlchemy's: ``sqlite:///marks.db``, ``postgresql+psycopg://user@host/name``; a path alone is
    a file of SQLite.

    Raises
    ------
    BadInput
        There is no such database, it cannot be reached, or a later version wrote it.
    """

    def __init__(self, url: str):
        self.url = _url(url)
        try:
            self.engine: Engine = create_engine(self.url, **_options(self.url))
        except (ArgumentError, NoSuchModuleError) as fault:
            raise BadInput(
                "no database {database!r}: {problem}; a file is sqlite:///marks.db, a server "
                "postgresql+psycopg://user@host/name",
                database=_without_password(url),
                problem=fault,
            ) from fault
        except ModuleNotFoundError as missing:
            raise BadInput(
                "{database} needs the package {package}: pip install it",
                database=_without_password(url),
                package=missing.name,
            ) from missing
        _make_private(self.url)
        self._reads: dict[str, Any] = {_READS: True}
        if self.engine.dialect.name == "postgresql":
            self._reads["isolation_level"] = "REPEATABLE READ"  # as every transaction of SQLite is
        if self.engine.dialect.name == "sqlite":
            event.listen(self.engine, "connect", _sqlite_settings)
            event.listen(self.engine, "begin", _begin_writing)
        try:
            self._complete_tables()
        except BadInput:
            self.close()
            raise

    @contextmanager
    def reading(self) -> Iterator[Connection]:
        """Open a read-only transaction, which sees the database as it is at one moment and waits for no
        writer.

        Raises
        ------
        BadInput
            The database is gone or damaged, or too many ask for it.
        """
        try:
            with self.engine.connect().execution_options(**self._reads) as connection:
                yield connection
        except (DatabaseError, NoConnection) as fault:
            if _is_ours(fault):
                raise
            raise BadInput(
                "{database}: {cause}", database=_without_password(self.url), cause=_cause(fault)
            ) from fault

    @contextmanager
    def begin(self) -> Iterator[Connection]:
        """Open a transaction: all of it is committed, or nothing.

        Raises
        ------
        BadInput
            The database is gone, damaged, full or busy.
        """
        try:
            with self.engine.begin() as connection:
                yield connection
        except (DatabaseError, NoConnection) as fault:
            if _is_ours(fault):
                raise
            raise BadInput(
                "{database}: {cause}; nothing was stored",
                database=_without_password(self.url),
                cause=_cause(fault),
            ) from fault

    @property
    def has_one_writer(self) -> bool:
        """Return True if only one transaction may write at a time."""
        return self.engine.dialect.name == "sqlite"

    @property
    def display_name(self) -> str:
        """File of the database, or its address without a password."""
        url = make_url(self.url)
        return (
            str(Path(url.database or "").resolve())
            if url.drivername.startswith("sqlite")
            else _without_password(self.url)
        )

    def scrub(self, patience: float = 5.0) -> bool:
        """Rewrite the SQLite file without deleted data; servers do so by themselves, later.

        Returns
        -------
        bool
            False where another process kept some of it for ``patience`` seconds.
        """
        path = file_of(self.url)
        return path is None or scrub(path, patience)

    def close(self) -> None:
        """Close all connections."""
        self.engine.dispose()

    def _complete_tables(self) -> None:
        """Make the tables those of this version."""
        try:
            with self.engine.begin() as connection:
                _one_at_a_time(connection)
                if version := later_version(connection):
                    raise BadInput(
                        "{database} was written by a later version of coursework ({problem}): update "
                        "the package",
                        database=_without_password(self.url),
                        problem=version,
                    )
                complete_tables(connection)
        except DBAPIError as fault:
            raise BadInput(
                "{database} cannot be opened: {cause}",
                database=_without_password(self.url),
                cause=_cause(fault),
            ) from fault
        except UnicodeDecodeError as fault:  # SQLite quotes what is damaged
            raise BadInput(
                "{database} cannot be opened: its tables are damaged; keep a copy of the file and "
                "restore a backup, or see what 'sqlite3 FILE .recover' finds",
                database=_without_password(self.url),
            ) from fault


def insert_unless_there(
    connection: Connection, table: Table, row: Mapping[str, Any], unique: Sequence[str]
) -> int | None:
    """Add a row and return its id; return None if there is one with the same ``unique`` columns, even if it
    was added concurrently."""
    make = postgresql.insert if connection.dialect.name == "postgresql" else sqlite.insert
    added = make(table).values(dict(row)).on_conflict_do_nothing(index_elements=list(unique))
    number = connection.execute(added.returning(table.c.id)).scalar()
    return None if number is None else int(number)


def put_rows(
    connection: Connection,
    table: Table,
    rows: Sequence[Mapping[str, Any]],
    unique: Sequence[str],
    *,
    replaces: bool = True,
) -> None:
    """Add rows in one statement; a row with the same ``unique`` columns is replaced, or else stays."""
    make = postgresql.insert if connection.dialect.name == "postgresql" else sqlite.insert
    added = make(table)
    if replaces:
        new = {name: added.excluded[name] for name in rows[0] if name not in unique}
        added = added.on_conflict_do_update(index_elements=list(unique), set_=new)
    else:
        added = added.on_conflict_do_nothing(index_elements=list(unique))
    connection.execute(added, [dict(row) for row in rows])


def json_of(value: Any) -> str:
    """Return readable JSON in characters that every database can store."""
    text = json.dumps(value, ensure_ascii=False)
    return text if _is_whole(text) else json.dumps(value)


def _is_whole(text: str) -> bool:
    """Return True if a text contains no lone surrogate."""
    try:
        return text.isascii() or bool(text.encode("utf-8"))
    except UnicodeEncodeError:
        return False


def _url(address: str) -> str:
    return address if "://" in address else f"sqlite:///{address}"


def file_of(url: str) -> Path | None:
    """Return the file of an SQLite database; None for another database."""
    try:
        parsed = make_url(_url(url))
    except ArgumentError:
        return None
    in_file = parsed.get_backend_name() == "sqlite" and parsed.database not in (None, "", ":memory:")
    return Path(str(parsed.database)) if in_file else None


def _make_private(url: str) -> None:
    """Create the file of a new SQLite database for its owner alone, since it contains passwords, keys and
    answers. SQLite's auxiliary files take the same permissions. A fault is reported when the file is
    opened."""
    file = file_of(url)
    if file is not None and not str(file).startswith("file:"):
        with suppress(OSError):
            os.close(os.open(file, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))


def is_shared(file: Path | None) -> bool:
    """Return True for a file that other users of this machine can read."""
    return file is not None and os.name == "posix" and file.exists() and bool(file.stat().st_mode & 0o077)


def _without_password(url: str) -> str:
    """Return the address without its password."""
    try:
        return make_url(url).render_as_string(hide_password=True)
    except ArgumentError:
        return url


def _options(url: str) -> dict[str, Any]:
    if url.startswith("sqlite"):
        in_memory = file_of(url) is None  # one connection a thread, as the library has it
        size = {} if in_memory else {"pool_size": CONNECTIONS // 2, "max_overflow": CONNECTIONS // 2}
        return {"json_serializer": json_of, "connect_args": {"timeout": _PATIENCE}, **size}
    size = {"pool_size": CONNECTIONS // 2, "max_overflow": CONNECTIONS // 2}
    return {"json_serializer": json_of, "pool_pre_ping": True, **size}


def _sqlite_settings(connection: Any, record: Any) -> None:
    """Configure SQLite: concurrent readers, durable commits, foreign keys, and overwriting of deleted
    data."""
    connection.isolation_level = None  # transactions are begun by :func:`_begin_writing`
    cursor = connection.cursor()
    for setting in (
        "journal_mode = WAL",
        "synchronous = FULL",
        "foreign_keys = ON",
        "secure_delete = ON",
        f"busy_timeout = {1000 * _PATIENCE}",
    ):
        cursor.execute(f"PRAGMA {setting}")
    cursor.close()


def _begin_writing(connection: Connection) -> None:
    """Acquire SQLite's write lock at the beginning of a transaction, so that none is refused half-way."""
    reads = connection.get_execution_options().get(_READS)
    connection.exec_driver_sql("BEGIN" if reads else "BEGIN IMMEDIATE")


def _one_at_a_time(connection: Connection) -> None:
    if connection.dialect.name == "postgresql":
        connection.exec_driver_sql("SELECT pg_advisory_xact_lock(7203455)")


def _is_ours(fault: DatabaseError | NoConnection) -> bool:
    """Return True if the statement is at fault and not the database: a duplicate row, or a mistake of this
    package."""
    return isinstance(fault, DatabaseError) and type(fault) not in (DatabaseError, OperationalError)


def _cause(fault: DBAPIError | NoConnection) -> Message:
    reason = " ".join(str(fault.orig if isinstance(fault, DBAPIError) else fault).split())
    if type(fault) is not DatabaseError:
        return Message("{problem}", problem=reason)
    return Message(
        "{problem}; keep a copy of the file and restore a backup, or see what 'sqlite3 FILE .recover' finds",
        problem=reason,
    )
