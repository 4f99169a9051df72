"""Progress of a person's practice in the database: that of :mod:`coursework.selfstudy.progress`, entry by
entry."""

from __future__ import annotations

import json
from collections.abc import Iterable
from datetime import UTC, datetime
from hashlib import sha256

from sqlalchemy import insert, select

from coursework.database.store import Store
from coursework.database.tables import progress as table
from coursework.selfstudy.progress import Entry, Progress
from coursework.selfstudy.store import Clock


def _now() -> datetime:
    return datetime.now(UTC)


class PersonProgress:
    """Progress of one person, or that of one exercise; an entry is stored once, however often it is added."""

    def __init__(self, store: Store, person: int, clock: Clock = _now, exercise: str = ""):
        self._store, self._person, self._exercise = store, person, exercise
        self.clock: Clock = clock
        self.trouble = self.troubled = ""
        self.progress = self._read()

    def _read(self) -> Progress:
        mine = table.c.person_id == self._person
        if self._exercise:
            mine &= table.c.entry["exercise"].as_string() == self._exercise
        with self._store.reading() as connection:
            rows = connection.execute(select(table.c.entry).where(mine).order_by(table.c.id))
            return Progress(row.entry for row in rows)

    def refresh(self) -> None:
        """Read the progress again, with the entries added meanwhile."""
        self.progress = self._read()

    def take_over(self, exercise: str) -> None:
        """Do nothing: no earlier version stored progress in the database."""

    def add(self, entries: Iterable[Entry]) -> None:
        """Store entries, each once.

        Raises
        ------
        BadInput
            The database takes nothing.
        """
        new = {_digest(entry): dict(entry) for entry in entries}
        if not new:
            return
        with self._store.begin() as connection:
            stand = select(table.c.digest).where(table.c.person_id == self._person, table.c.digest.in_(new))
            stored = set(connection.execute(stand).scalars())
            rows = [
                {"person_id": self._person, "entry": entry, "digest": digest}
                for digest, entry in new.items()
                if digest not in stored
            ]
            if rows:
                connection.execute(insert(table), rows)
        self.progress |= Progress(new.values())


def _digest(entry: Entry) -> str:
    return sha256(json.dumps(entry, ensure_ascii=False, sort_keys=True, default=str).encode()).hexdigest()
