"""Sessions: a row for each browser with a signed-in person. The row of a session is deleted when the session
ends.

The browser holds a random token; the database keeps its SHA-256 alone, so that nobody who reads the database
can use it.
"""

from __future__ import annotations

import hashlib
import secrets
from datetime import datetime, timedelta
from functools import cache
from typing import Any

from sqlalchemy import Connection, Select, bindparam, delete, exists, insert, or_, select, update

from coursework.database.people import people_query
from coursework.database.settings import reloads_query
from coursework.database.tables import account, person, session

IDLE = timedelta(days=30)  #: a session expires when it was not used for so long
LONGEST = timedelta(days=180)  #: and so long after sign-in in any case
TOUCHED = timedelta(minutes=10)  #: the last use is written down at most so often
MOST = 50  #: sessions of one person: a further one ends the one that was used longest ago
TOKEN_LENGTH = 43  #: characters of a token, 256 bits


def begin_session(connection: Connection, number: int, browser: str, at: datetime) -> str:
    """Sign a person in and return the token of the new session. Expired sessions of everybody are removed.

    Parameters
    ----------
    number
        Of the person.
    browser
        A coarse description of the browser, for the person's own list.
    at
        Now, UTC.
    """
    connection.execute(delete(session).where(session.c.until <= at))
    token = secrets.token_urlsafe(32)
    row = {"person_id": number, "digest": digest_of(token), "browser": browser[:80]}
    connection.execute(insert(session).values(**row, created=at, seen=at, until=at + IDLE))
    query = select(session.c.id).where(session.c.person_id == number)
    too_many = query.order_by(session.c.seen.desc(), session.c.id.desc()).offset(MOST)
    old = list(connection.execute(too_many).scalars())
    if old:
        connection.execute(delete(session).where(session.c.id.in_(old)))
    return token


def session_of(connection: Connection, token: str, at: datetime) -> Any | None:
    """Return the session of a token with its person's columns, or None.

    The row has ``session_id``, ``session_created``, ``session_seen`` and ``taken``
    (:func:`coursework.database.settings.reloads_of`) beside those of
    :func:`coursework.database.people.person_by_id`. There is none for a token that is unknown, ended or
    expired, and none of a person whose account is closed.
    """
    if len(token) != TOKEN_LENGTH:
        return None
    return connection.execute(_session_query(), {"digest": digest_of(token), "at": at}).first()


@cache
def _session_query() -> Select[Any]:
    """Return the query of :func:`session_of`, cached: every request executes it, and composing it takes as
    long as its execution."""
    columns = [session.c[name].label(f"session_{name}") for name in ("id", "created", "seen")]
    former = account.alias()
    is_closed = exists().where(former.c.person_id == person.c.id, former.c.closed.is_not(None))
    return (
        people_query()
        .add_columns(*columns, reloads_query().scalar_subquery().label("taken"))
        .join(session, session.c.person_id == person.c.id)
        .where(session.c.digest == bindparam("digest"), session.c.until > bindparam("at"))
        .where(or_(account.c.id.is_not(None), ~is_closed))
    )


def touch_session(connection: Connection, number: int, created: datetime, at: datetime) -> None:
    """Record the last use of a session."""
    until = min(at + IDLE, created + LONGEST)
    connection.execute(update(session).where(session.c.id == number).values(seen=at, until=until))


def sessions_of(connection: Connection, number: int, at: datetime) -> list[Any]:
    """Return the sessions of a person that have not expired, the last used first."""
    query = select(session.c.id, session.c.browser, session.c.created, session.c.seen)
    mine = query.where(session.c.person_id == number, session.c.until > at)
    return list(connection.execute(mine.order_by(session.c.seen.desc(), session.c.id.desc())))


def end_session(connection: Connection, number: int, person_number: int) -> bool:
    """End one session of a person; return True if there was one."""
    mine = session.c.id == number, session.c.person_id == person_number
    return connection.execute(delete(session).where(*mine)).rowcount > 0


def end_sessions(connection: Connection, number: int) -> None:
    """End all sessions of a person."""
    connection.execute(delete(session).where(session.c.person_id == number))


def end_all_sessions(connection: Connection) -> int:
    """End the sessions of everybody; return their number."""
    return connection.execute(delete(session)).rowcount


def digest_of(token: str) -> str:
    """Return the SHA-256 of a token or a key, which the database stores."""
    return hashlib.sha256(token.encode("utf-8", "replace")).hexdigest()
