"""Failed attempts to sign in, counted for all processes of a site. Keys are digests: no login can be read
from them."""

from __future__ import annotations

from collections.abc import Collection
from datetime import datetime, timedelta

from sqlalchemy import Connection, case, delete, select
from sqlalchemy.dialects import postgresql, sqlite

from coursework.database.tables import failure

FORGOTTEN = timedelta(minutes=15)  #: a count is forgotten so long after the last failure


def failures_of(connection: Connection, keys: Collection[str], at: datetime) -> dict[str, int]:
    """Return the number of recent failures of each key; keys without one are omitted."""
    query = select(failure.c.key, failure.c["count"].label("times")).where(
        failure.c.key.in_(keys), failure.c.last > at - FORGOTTEN
    )
    return {row.key: int(row.times) for row in connection.execute(query)}


def add_failure(connection: Connection, keys: Collection[str], at: datetime) -> None:
    """Count a failure for each key. Counts that are forgotten are removed."""
    connection.execute(delete(failure).where(failure.c.last <= at - FORGOTTEN))
    make = postgresql.insert if connection.dialect.name == "postgresql" else sqlite.insert
    added = make(failure).values([{"key": key, "count": 1, "last": at} for key in sorted(keys)])
    most = case((failure.c["count"] < 1_000_000, failure.c["count"] + 1), else_=failure.c["count"])
    connection.execute(added.on_conflict_do_update(index_elements=["key"], set_={"count": most, "last": at}))


def forget_failures(connection: Connection, keys: Collection[str]) -> None:
    """Delete the failures of keys."""
    connection.execute(delete(failure).where(failure.c.key.in_(keys)))
