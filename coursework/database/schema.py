"""Tables of a database as this version needs them: made, or completed where an earlier version wrote the
database. While no version is released, :mod:`coursework.database.tables` alone states them."""

from __future__ import annotations

from sqlalchemy import Column, Connection, Inspector, MetaData, String, Table, insert, inspect, select, update
from sqlalchemy.schema import CreateColumn

from coursework.database.tables import METADATA

VERSION = "0011"  #: raised when tables change in another way than by tables and columns that may be empty
_VERSION_TABLE = Table("alembic_version", MetaData(), Column("version_num", String(32), primary_key=True))

#: Earlier names of tables, and of columns by the present name of their table.
_RENAMED_TABLES = {"dealt": "issue", "delivery": "submission"}
_OF_SUBMISSION = ("answer", "drawing", "rejected", "seen", "placing", "job")
_RENAMED_COLUMNS = {
    "submission": {"came": "received_at"},
    "mark": {"came": "received_place"},
    "scanned": {"came": "received_at", "kept": "reading"},
    **{table: {"delivery_id": "submission_id"} for table in _OF_SUBMISSION},
}


def later_version(connection: Connection) -> str | None:
    """Return the version of a database that a later version of this package wrote; None for any other."""
    version = _version_of(connection)
    return version if version is not None and version > VERSION else None


def complete_tables(connection: Connection) -> None:
    """Create the missing tables, columns and indexes."""
    before = _version_of(connection)
    if is_renamed := before is not None and before < "0011":
        _rename(connection)
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
        if lacking or is_renamed:
            _create_indexes(connection, inspector, table)
    if before == VERSION:
        return
    if before is None:
        _VERSION_TABLE.create(connection)
        connection.execute(insert(_VERSION_TABLE).values(version_num=VERSION))
    else:
        connection.execute(update(_VERSION_TABLE).values(version_num=VERSION))


def _rename(connection: Connection) -> None:
    """Give the tables and columns of an earlier version their present names, and drop the indexes of its own
    that bear the earlier ones."""
    for old, new in _RENAMED_TABLES.items():
        if inspect(connection).has_table(old):
            connection.exec_driver_sql(f"ALTER TABLE {old} RENAME TO {new}")
    inspector = inspect(connection)
    stored = set(inspector.get_table_names())
    for table in stored.intersection((*_RENAMED_TABLES.values(), *_RENAMED_COLUMNS)):
        renamed = _RENAMED_COLUMNS.get(table, {})
        for column in inspector.get_columns(table):
            if name := renamed.get(column["name"]):
                connection.exec_driver_sql(f"ALTER TABLE {table} RENAME COLUMN {column['name']} TO {name}")
        for index in inspector.get_indexes(table):
            is_named_so = _RENAMED_TABLES.keys() & set(str(index["name"]).split("_"))
            if is_named_so and "duplicates_constraint" not in index:
                connection.exec_driver_sql(f"DROP INDEX {index['name']}")


def _version_of(connection: Connection) -> str | None:
    if not inspect(connection).has_table(_VERSION_TABLE.name):
        return None
    return connection.execute(select(_VERSION_TABLE.c.version_num)).scalar()


def _create_indexes(connection: Connection, inspector: Inspector, table: Table) -> None:
    stored = {index["name"] for index in inspector.get_indexes(table.name)}
    for index in table.indexes:
        if index.name not in stored:
            index.create(connection)
