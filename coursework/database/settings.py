"""Settings of a site, stored by name."""

from __future__ import annotations

import json
import secrets
from typing import Any

from sqlalchemy import Connection, Select, delete, select

from coursework.database.store import put_rows
from coursework.database.tables import setting
from coursework.errors import BadInput

_KEY = "secret"
_COURSE = "course"


def secret(connection: Connection) -> bytes:
    """Return the key that signs tokens and cookies of the site; create it at the first use.

    Raises
    ------
    BadInput
        The stored value is not a key.
    """
    stored = connection.execute(select(setting.c.value).where(setting.c.name == _KEY)).scalar()
    if stored is None:
        row = {"name": _KEY, "value": secrets.token_hex(32)}
        put_rows(connection, setting, [row], ["name"], replaces=False)  # unless another process was first
        stored = connection.execute(select(setting.c.value).where(setting.c.name == _KEY)).scalar_one()
    try:
        return bytes.fromhex(stored)
    except ValueError:
        raise BadInput(
            "the key that signs cookies is damaged in the database: restore a backup, or delete the "
            "row 'secret' of the table "
            "'setting', which signs everybody out"
        ) from None


def renew_secret(connection: Connection) -> None:
    """Delete the signing key; the next process that needs it draws another."""
    connection.execute(delete(setting).where(setting.c.name == _KEY))


def value_of(connection: Connection, name: str) -> Any:
    """Return the value stored under a name; None if there is none."""
    stored = connection.execute(select(setting.c.value).where(setting.c.name == name)).scalar()
    return None if stored is None else json.loads(stored)


def put_value(connection: Connection, name: str, value: Any) -> None:
    """Store a value under a name, in place of the earlier one."""
    row = {"name": name, "value": json.dumps(value, ensure_ascii=False)}
    put_rows(connection, setting, [row], ["name"])


def drop_value(connection: Connection, name: str) -> None:
    """Delete the value stored under a name."""
    connection.execute(delete(setting).where(setting.c.name == name))


def course_reloads(connection: Connection) -> int:
    """Return the number of times that a course was reloaded after a correction of its files; every process of
    a site continues with the last."""
    return reloads_of(connection.execute(reloads_query()).scalar())


def reloads_query() -> Select[Any]:
    """Return the query of the value that :func:`reloads_of` reads, for use in a larger query."""
    return select(setting.c.value).where(setting.c.name == _COURSE)


def reloads_of(value: str | None) -> int:
    """Return the number of reloads of a stored value."""
    return 0 if value is None else int(json.loads(value) or 0)


def request_reload(connection: Connection) -> int:
    """Request a reload of the course's files by every process; return the number of reloads so far."""
    now = course_reloads(connection) + 1
    put_value(connection, _COURSE, now)
    return now
