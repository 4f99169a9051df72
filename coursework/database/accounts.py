"""Accounts with a password, and the invitations by which people choose one."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Select, insert, select, update

from coursework.database.permissions import ADMINISTRATOR, STAFF, STUDENT
from coursework.database.sessions import end_sessions
from coursework.database.tables import account, person
from coursework.errors import BadInput

OWNER = "owner"  #: login of who opens the site on their own machine, without a password


def _open_accounts() -> Select[Any]:
    return (
        select(account, person.c.name, person.c.lang)
        .join(person, person.c.id == account.c.person_id)
        .where(account.c.closed.is_(None))
    )


def account_by_login(connection: Connection, login: str) -> Any | None:
    """Return the open account of a login, with the person's name."""
    return connection.execute(_open_accounts().where(account.c.login == login)).first()


def account_of(connection: Connection, number: int) -> Any | None:
    """Return the open account of a person."""
    return connection.execute(
        _open_accounts().where(account.c.person_id == number).order_by(account.c.id)
    ).first()


def account_invited(connection: Connection, invitation: str, at: datetime) -> Any | None:
    """Return the account of an invitation, given its digest; None if the invitation was used, replaced or has
    expired."""
    row = connection.execute(_open_accounts().where(account.c.invitation == invitation)).first()
    return None if row is None or row.invited_until is None or row.invited_until < at else row


def accounts(connection: Connection) -> dict[int, Any]:
    """Return the open accounts by person."""
    return {row.person_id: row for row in connection.execute(_open_accounts())}


def invite(
    connection: Connection, number: int, login: str, role: str, invitation: str, until: datetime, at: datetime
) -> None:
    """Invite a person: create an account, or replace the invitation of an existing one. The current password
    remains valid until the invitation is accepted.

    Raises
    ------
    BadInput
        Another person has this login.
    """
    invitation_values = {"invitation": invitation, "invited_until": until}
    mine = account_of(connection, number)
    if mine is not None:
        connection.execute(update(account).where(account.c.id == mine.id).values(invitation_values))
        return
    if connection.execute(select(account.c.id).where(account.c.login == login)).first() is not None:
        raise BadInput("the login {login} is somebody else's", login=login)
    row = {"person_id": number, "login": login, "role": role, "created": at}
    connection.execute(insert(account).values({**row, **invitation_values}))


def accept_invitation(connection: Connection, invitation: str, secret: str, at: datetime) -> int | None:
    """Accept an invitation: store the hash of the new password. Return the person, or None if the invitation
    is used or has expired."""
    done = connection.execute(
        update(account)
        .where(account.c.invitation == invitation, account.c.invited_until >= at, account.c.closed.is_(None))
        .values(secret=secret, invitation=None, invited_until=None, joined=at)
        .returning(account.c.person_id)
    ).scalar()
    return None if done is None else int(done)


def set_secret(connection: Connection, number: int, secret: str) -> None:
    """Store another password, or the same one under another hash."""
    connection.execute(update(account).where(account.c.id == number).values(secret=secret))


def set_role(connection: Connection, number: int, role: str) -> bool:
    """Give a person who has an account another role; return True if they need a new invitation to sign in.

    Their sessions end if the role changes. An invitation that was made for a student, and a password chosen
    by one, are known to everybody who may invite students: both end with the student's role.
    """
    mine = account.c.person_id == number, account.c.closed.is_(None)
    before = connection.execute(select(account.c.role).where(*mine)).scalar()
    if before is None or before == role:
        return False
    rises = before == STUDENT and role in STAFF
    ended: dict[str, Any] = {"secret": "", "invitation": None, "invited_until": None} if rises else {}
    connection.execute(update(account).where(*mine).values(role=role, **ended))
    end_sessions(connection, number)
    return rises


def is_last_administrator(connection: Connection, number: int) -> bool:
    """Return True if nobody else who can sign in is an administrator."""
    mine = account_of(connection, number)
    if mine is None or mine.role != ADMINISTRATOR:
        return False
    return mine.login == OWNER or not _administrators(connection) - {number}


def has_administrator(connection: Connection, at: datetime) -> bool:
    """Return True if an administrator can sign in, or is invited to."""
    invited = select(account.c.id).where(
        account.c.role == ADMINISTRATOR, account.c.closed.is_(None), account.c.invited_until > at
    )
    return bool(_administrators(connection)) or connection.execute(invited).first() is not None


def _administrators(connection: Connection) -> set[int]:
    """Return the administrators who can sign in; lock their rows until the transaction ends."""
    query = (
        select(account.c.person_id)
        .where(account.c.role == ADMINISTRATOR, account.c.closed.is_(None), account.c.secret != "")
        .with_for_update()
    )
    return set(connection.execute(query).scalars())
