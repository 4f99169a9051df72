"""Drafts of answers, not yet submitted: stored box by box, so that two open pages do not overwrite one
another."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import NamedTuple

from sqlalchemy import Connection, delete, func, select

from coursework.database.people import lock_person
from coursework.database.store import put_rows
from coursework.database.tables import draft


class DraftBox(NamedTuple):
    """Stored text of a box."""

    text: str
    version: int  #: counts its changes; 0 where nothing was ever written


BLANK = DraftBox("", 0)


class DraftChange(NamedTuple):
    """Text received from a page, and the version that it replaces."""

    text: str
    over: int


def drafts(connection: Connection, person: int, sheet: str) -> dict[str, DraftBox]:
    """Return the drafts of a sheet by box."""
    rows = connection.execute(
        select(draft.c.box, draft.c.text, draft.c.version).where(
            draft.c.person_id == person, draft.c.sheet == sheet
        )
    )
    return {row.box: DraftBox(row.text, row.version) for row in rows}


def save(
    connection: Connection,
    person: int,
    sheet: str,
    sent: Mapping[str, DraftChange],
    at: datetime,
    stored: Mapping[str, DraftBox] | None = None,
) -> tuple[dict[str, DraftBox], dict[str, DraftBox]]:
    """Store drafts; return all drafts of the sheet, and the boxes that another page has changed meanwhile.
    These are not overwritten.

    An unchanged text is not a change, so that a request sent twice is stored once. ``stored`` are the drafts
    of the sheet if the caller has read them since it locked the person.
    """
    if stored is None:
        lock_person(connection, person)
        stored = drafts(connection, person, sheet)
    changed = {box: new for box, new in sent.items() if stored.get(box, BLANK).text != new.text}
    others = {box: stored[box] for box, new in changed.items() if new.over < stored.get(box, BLANK).version}
    written = {
        box: DraftBox(new.text, stored.get(box, BLANK).version + 1)
        for box, new in changed.items()
        if box not in others
    }
    if written:
        key = {"person_id": person, "sheet": sheet, "changed": at}
        put_rows(
            connection,
            draft,
            [{**key, "box": box, **new._asdict()} for box, new in written.items()],
            ("person_id", "sheet", "box"),
        )
    return {**stored, **written}, others


def sheets(connection: Connection, person: int, beginning: str) -> dict[str, datetime]:
    """Return a person's sheets whose names have a prefix, with the time of the last change of each, the last
    changed first."""
    last = func.max(draft.c.changed)
    rows = connection.execute(
        select(draft.c.sheet, last)
        .where(draft.c.person_id == person, draft.c.sheet.startswith(beginning, autoescape=True))
        .group_by(draft.c.sheet)
        .order_by(last.desc())
    )
    return {row[0]: row[1] for row in rows}


def drop(connection: Connection, person: int, sheet: str) -> None:
    """Delete the drafts of a sheet."""
    connection.execute(delete(draft).where(draft.c.person_id == person, draft.c.sheet == sheet))
