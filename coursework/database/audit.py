"""Audit log of actions on the data of others. Entries are added, never changed, and never contain an
answer."""

from __future__ import annotations

from collections.abc import Collection
from datetime import datetime
from typing import Any, NamedTuple

from sqlalchemy import Connection, insert, select

from coursework.database.tables import audit

#: Actions on an account that its holder is informed of.
OF_ACCOUNTS = ("invited", "invitation taken up", "password changed", "role", "data given")


class Actor(NamedTuple):
    """Person or program that acts, with its address."""

    name: str
    person: int = 0  #: id; 0 for a command or a platform
    address: str = ""  #: of the machine that asks


def note(connection: Connection, at: datetime, by: str | Actor, what: str, **about: Any) -> None:
    """Add an entry to the audit log; ``person`` in ``about`` is the id of the person concerned."""
    actor = by if isinstance(by, Actor) else Actor(by)
    subject = about.get("person")
    row = {
        "at": at,
        "by": actor.name,
        "what": what,
        "about": about,
        "actor": actor.person or None,
        "subject": subject if isinstance(subject, int) else None,
        "address": actor.address[:64] or None,
    }
    connection.execute(insert(audit).values(row))


def noted(
    connection: Connection,
    count: int = 200,
    before: int = 0,
    *,
    by: str = "",
    what: Collection[str] = (),
    subject: int | None = None,
) -> list[Any]:
    """Return entries of the audit log, the latest first.

    Parameters
    ----------
    count
        Lines at most.
    before
        Id of a line: only what was written down before it; 0 for all.
    by
        Part of the name of who did it.
    what
        Kinds of line; all where none is named.
    subject
        Id of the person concerned; None for any.
    """
    query = select(audit).order_by(audit.c.id.desc()).limit(count)
    if before:
        query = query.where(audit.c.id < before)
    if by:
        query = query.where(audit.c.by.icontains(by, autoescape=True))
    if what:
        query = query.where(audit.c.what.in_(what))
    if subject is not None:
        query = query.where(audit.c.subject == subject)
    return list(connection.execute(query))


def kinds(connection: Connection) -> list[str]:
    """Return the kinds of entries that exist."""
    return list(connection.execute(select(audit.c.what).distinct().order_by(audit.c.what)).scalars())
