"""Drafts of answers, not yet submitted: stored box by box, so that two open pages do not overwrite one
another."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from typing import NamedTuple

from sqlalchemy import Connection, delete, func, insert, select, update
from sqlalchemy.exc import IntegrityError

from coursework.database.tables import draft


class DraftBox(NamedTuple):
    """Stored text of a box."""

    text: str
    version: int  #: counts its changes; 0 where nothing was ever written


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
    connection: Connection, person: int, sheet: str, sent: Mapping[str, DraftChange], at: datetime
) -> dict[str, DraftBox]:
    """Store drafts; return the boxes that another page has changed meanwhile, with their current text. These
    are not overwritten.

    An unchanged text is not a change, so that a request sent twice is stored once.
    """
    stored, others = drafts(connection, person, sheet), {}
    for box, draft_sent in sent.items():
        now = stored.get(box, DraftBox("", 0))
        if now.text == draft_sent.text:
            continue
        if draft_sent.over < now.version or not _is_written(
            connection, (person, sheet, box), draft_sent.text, now, at
        ):
            others[box] = drafts(connection, person, sheet)[box]
    return others


def _is_written(
    connection: Connection, key: tuple[int, str, str], text: str, now: DraftBox, at: datetime
) -> bool:
    """Replace the draft of a box; return False if another page was faster."""
    person, sheet, box = key
    written = {"text": text, "version": now.version + 1, "changed": at}
    if now.version:
        same = (draft.c.person_id == person, draft.c.sheet == sheet, draft.c.box == box)
        over = update(draft).where(*same, draft.c.version == now.version).values(written)
        return connection.execute(over).rowcount == 1
    try:
        with connection.begin_nested():
            connection.execute(insert(draft).values(person_id=person, sheet=sheet, box=box, **written))
    except IntegrityError:
        return False
    return True


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
