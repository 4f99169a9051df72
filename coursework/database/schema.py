"""Tables of a database as this version needs them: made, or completed where an earlier version wrote the
database. While no version is released, :mod:`coursework.database.tables` alone states them."""

from __future__ import annotations

from sqlalchemy import Column, Connection, Inspector, MetaData, String, Table, insert, inspect, select, update
from sqlalchemy.schema import CreateColumn

from coursework.database.tables import METADATA

VERSION = "0010"  #: raised when tables change in another way than by tables and columns that may be empty
_VERSION_TABLE = Table("alembic_version", MetaData(), Column("version_num", String(32), primary_key=True))


def later_version(connection: Connection) -> str | None:
    """Return the version of a database that a later version of this package wrote; None for any other."""
    version = _version_of(connection)
    return version if version is not None and version > VERSION else None


def complete_tables(connection: Connection) -> None:
    """Create the missing tables, columns and indexes."""
    before = _version_of(connection)
    inspector = inspect(connection)
    stored = inspector.get_multi_columns()
    lacking_tables = [table for table in METADATA.sorted_tables if (None, table.name) not in stored]
    METADATA.create_all(connection, lacking_tables, checkfirst=False)
    for table in METADATA.sorted_tables:
        names = {column["name"] for column in stored.get((None, table.name), ())}
        lacking = [column for column in table.c if names and column.name not in names]
        for column in lacking:
            definition = CreateColumn(column).compile(dialect=connection.dialect)
            connection.exec_driver_sql(f"ALTER TABLE {table.name} ADD COLUMN {definition}")
        if lacking:
            _create_indexes(connection, inspector, table)
    if before == VERSION:
        return
    if before is None:
        _VERSION_TABLE.create(connection)
        connection.execute(insert(_VERSION_TABLE).values(version_num=VERSION))
    else:
        connection.execute(update(_VERSION_TABLE).values(version_num=VERSION))


def _version_of(connection: Connection) -> str | None:
    if not inspect(connection).has_table(_VERSION_TABLE.name):
        return None
    return connection.execute(select(_VERSION_TABLE.c.version_num)).scalar()


def _create_indexes(connection: Connection, inspector: Inspector, table: Table) -> None:
    stored = {index["name"] for index in inspector.get_indexes(table.name)}
    for index in table.indexes:
        if index.name not in stored:
            index.create(connection)
