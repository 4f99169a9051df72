"""Progress of a person's practice in the database: that of :mod:`coursework.selfstudy.progress`, entry by
entry."""

from __future__ import annotations

import json
from collections.abc import Iterable
from contextlib import nullcontext
from datetime import UTC, datetime
from hashlib import sha256

from sqlalchemy import Connection, select

from coursework.database.store import Store, put_rows
from coursework.database.tables import progress as table
from coursework.selfstudy.progress import Clock, Entry, Progress


def _now() -> datetime:
    return datetime.now(UTC)


class PersonProgress:
    """Progress of one person, or that of one exercise; an entry is stored once, however often it is added.

    ``connection`` reads it in a transaction of the caller. While ``waits`` is True, new entries are stored by
    :meth:`save` alone.
    """

    def __init__(
        self,
        store: Store,
        person: int,
        clock: Clock = _now,
        exercise: str = "",
        connection: Connection | None = None,
    ):
        self._store, self._person, self._exercise = store, person, exercise
        self.clock: Clock = clock
        self.trouble = self.troubled = ""
        self.waits = False
        self.unsaved: dict[str, Entry] = {}  #: entries to store, by digest
        with store.reading() if connection is None else nullcontext(connection) as connection:
            self.progress = self._read(connection)

    def _read(self, connection: Connection) -> Progress:
        mine = table.c.person_id == self._person
        if self._exercise:
            mine &= table.c.entry["exercise"].as_string() == self._exercise
        rows = connection.execute(select(table.c.entry).where(mine).order_by(table.c.id))
        return Progress(row.entry for row in rows)

    def refresh(self) -> None:
        """Read the progress again, with the entries added meanwhile."""
        with self._store.reading() as connection:
            self.progress = self._read(connection)

    def add(self, entries: Iterable[Entry]) -> None:
        """Store entries, each once.

        Raises
        ------
        BadInput
            The database takes nothing.
        """
        new = {_digest(entry): dict(entry) for entry in entries}
        self.unsaved |= new
        if new and not self.waits:
            with self._store.begin() as connection:
                self.save(connection)
            self.unsaved = {}
        self.progress |= Progress(new.values())

    def save(self, connection: Connection) -> None:
        """Store the new entries."""
        rows = [
            {"person_id": self._person, "entry": entry, "digest": digest}
            for digest, entry in self.unsaved.items()
        ]
        if rows:
            put_rows(connection, table, rows, ("person_id", "digest"), replaces=False)


def _digest(entry: Entry) -> str:
    return sha256(json.dumps(entry, ensure_ascii=False, sort_keys=True, default=str).encode()).hexdigest()
