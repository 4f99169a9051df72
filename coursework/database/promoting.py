"""Administrators in databases that are older than that role."""

from __future__ import annotations

import sqlalchemy as sa
from sqlalchemy import Connection

#: The columns that there have been from the first version on, whatever the tables have now.
_ACCOUNT = sa.table(
    "account",
    sa.column("id", sa.Integer),
    sa.column("login", sa.Text),
    sa.column("secret", sa.Text),
    sa.column("role", sa.String),
    sa.column("closed", sa.DateTime),
)
_OWNER = "owner"  #: login of who opens the site on their own machine


def promote_first(connection: Connection) -> None:
    """Make the first instructor an administrator if there is none, and the owner of a machine in any case.

    Only the first one: instructors of older databases could take over each other's accounts, which is to end.
    The first administrator, or a command on the server's machine, names the others. An instructor with a
    password comes before one who is only invited.
    """
    instructors = sa.select(_ACCOUNT).where(_ACCOUNT.c.role == "instructor", _ACCOUNT.c.closed.is_(None))
    rows = connection.execute(instructors.order_by(_ACCOUNT.c.id)).all()
    chosen = [row.id for row in rows if row.login == _OWNER]
    others = sorted((row for row in rows if row.login != _OWNER), key=lambda row: (not row.secret, row.id))
    there_is_one = (
        sa.select(_ACCOUNT.c.id)
        .where(_ACCOUNT.c.role == "administrator", _ACCOUNT.c.closed.is_(None), _ACCOUNT.c.login != _OWNER)
        .limit(1)
    )
    if connection.execute(there_is_one).first() is None:
        chosen += [row.id for row in others[:1]]
    if chosen:
        connection.execute(_ACCOUNT.update().where(_ACCOUNT.c.id.in_(chosen)).values(role="administrator"))
