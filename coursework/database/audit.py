"""Who did what that another may ask about: never an answer."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import Connection, insert, select

from coursework.database.tables import audit


def note(connection: Connection, at: datetime, by: str, what: str, **about: Any) -> None:
    """Write down that somebody did something."""
    connection.execute(insert(audit).values(at=at, by=by, what=what, about=about))


def noted(connection: Connection, count: int = 200, before: int = 0) -> list[Any]:
    """What was done, the latest first; of what was written down before a line, where one is told."""
    found = select(audit).order_by(audit.c.id.desc()).limit(count)
    return list(connection.execute(found.where(audit.c.id < before) if before else found))
