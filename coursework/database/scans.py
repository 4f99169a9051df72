"""Scans of answer pages, and texts typed from them by people."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any, NamedTuple

from sqlalchemy import Connection, Row, insert, select, update

from coursework.database.store import insert_unless_there
from coursework.database.tables import scanned, typed
from coursework.scanning.typed import PAGE, Typed


class ScannedPage(NamedTuple):
    """Page of a scan, or file without a readable page."""

    page: str  #: digest of the file, and number
    file: str
    number: int  #: 0 for a file
    student: str
    reading: Mapping[str, Any]  #: what was read
    received_at: datetime


def put_scanned(connection: Connection, assignment_id: int, page: ScannedPage, picture: bytes) -> bool:
    """Store a page; return True if it is new. An existing page stays as it is."""
    row = {
        **page._asdict(),
        "reading": dict(page.reading),
        "assignment_id": assignment_id,
        "picture": base64.b64encode(picture).decode(),
    }
    return insert_unless_there(connection, scanned, row, ("assignment_id", "page")) is not None


def pages_scanned(connection: Connection, assignment_id: int) -> list[ScannedPage]:
    """Return the scanned pages, in the order of their files."""
    columns = [scanned.c[name] for name in ScannedPage._fields]
    query = select(*columns).where(scanned.c.assignment_id == assignment_id)
    in_order = query.order_by(scanned.c.file, scanned.c.page)
    return [ScannedPage(*row) for row in connection.execute(in_order)]


def picture_scanned(connection: Connection, assignment_id: int, page: str) -> bytes | None:
    """Return the picture of a page; None if there is none."""
    of_page = scanned.c.assignment_id == assignment_id, scanned.c.page == page
    encoded = connection.execute(select(scanned.c.picture).where(*of_page)).scalar()
    return base64.b64decode(encoded) if encoded else None


def name_scanned(connection: Connection, assignment_id: int, page: str, student: str) -> None:
    """Set the student of a page."""
    of_page = scanned.c.assignment_id == assignment_id, scanned.c.page == page
    connection.execute(update(scanned).where(*of_page).values(student=student))


def put_typed(connection: Connection, assignment_id: int, text: Typed, by: str, made: datetime) -> None:
    """Store a text typed by a person."""
    row = {**text._asdict(), "by": by, "made": made, "assignment_id": assignment_id}
    connection.execute(insert(typed).values(row))


def typed_texts(connection: Connection, assignment_id: int) -> list[Typed]:
    """Return the current texts: the last of each place, in the order in which they were typed, without those
    withdrawn."""
    return [Typed(*row[: len(Typed._fields)]) for row in _current(connection, assignment_id)]


def last_typed(connection: Connection, assignment_id: int, by: str) -> list[Typed]:
    """Return the current texts that a person typed last, all in one request."""
    own = [row for row in _current(connection, assignment_id) if row.by == by]
    last = max((row.made for row in own), default=None)
    return [Typed(*row[: len(Typed._fields)]) for row in own if row.made == last]


def withdraw_typed(
    connection: Connection, assignment_id: int, texts: Sequence[Typed], by: str, made: datetime
) -> None:
    """Withdraw texts: their places wait again, and a page that they assigned is nobody's."""
    rows = [
        {**text._asdict(), "answer": None, "by": by, "made": made, "assignment_id": assignment_id}
        for text in texts
    ]
    connection.execute(insert(typed), rows)
    for text in texts:
        if text.exercise == PAGE:
            name_scanned(connection, assignment_id, text.part, "")


def _current(connection: Connection, assignment_id: int) -> list[Row[Any]]:
    """Return the columns of :class:`Typed` with who typed them and when: the last of each place that is not
    withdrawn."""
    columns = [*(typed.c[name] for name in Typed._fields), typed.c.by, typed.c.made]
    in_order = select(*columns).where(typed.c.assignment_id == assignment_id).order_by(typed.c.id)
    last: dict[tuple[str, ...], Row[Any]] = {}
    for row in connection.execute(in_order):
        key = tuple(row[:5])
        last.pop(key, None)
        last[key] = row
    return [row for row in last.values() if row.answer is not None]
