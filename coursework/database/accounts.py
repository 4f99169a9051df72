"""How people sign in with a password: the account of a person, and the invitation by which one is taken up."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Select, insert, select, update

from coursework.database.tables import account, person
from coursework.errors import BadInput

INSTRUCTOR, STUDENT = "instructor", "student"
ROLES = (STUDENT, INSTRUCTOR)
OWNER = "owner"  #: login of who opens the site on their own machine, without a password


def _found() -> Select[Any]:
    return (
        select(account, person.c.name, person.c.lang)
        .join(person, person.c.id == account.c.person_id)
        .where(account.c.closed.is_(None))
    )


def account_by_login(connection: Connection, login: str) -> Any | None:
    """The open account of a login, with the person's name."""
    return connection.execute(_found().where(account.c.login == login)).first()


def account_of(connection: Connection, number: int) -> Any | None:
    """The open account of a person."""
    return connection.execute(_found().where(account.c.person_id == number).order_by(account.c.id)).first()


def account_invited(connection: Connection, invitation: str, at: datetime) -> Any | None:
    """The account that an invitation, told by its digest, is for; none where it was used, renewed or is over."""
    found = connection.execute(_found().where(account.c.invitation == invitation)).first()
    return None if found is None or found.invited_until is None or found.invited_until < at else found


def accounts(connection: Connection) -> dict[int, Any]:
    """The open accounts by person."""
    return {row.person_id: row for row in connection.execute(_found())}


def invite(
    connection: Connection, number: int, login: str, role: str, invitation: str, until: datetime, at: datetime
) -> None:
    """Invite a person: an account where there is none; where there is one, a new invitation in the place of those before.
    Its password holds until the invitation is taken up.

    Raises
    ------
    BadInput
        Another person has this login.
    """
    told = {"invitation": invitation, "invited_until": until}
    mine = account_of(connection, number)
    if mine is not None:
        connection.execute(update(account).where(account.c.id == mine.id).values(told))
        return
    if connection.execute(select(account.c.id).where(account.c.login == login)).first() is not None:
        raise BadInput(f"the login {login} is somebody else's")
    row = {"person_id": number, "login": login, "role": role, "created": at}
    connection.execute(insert(account).values({**row, **told}))


def take_up(connection: Connection, invitation: str, secret: str, at: datetime) -> int | None:
    """Take an invitation up with what became of a password; the person, or none where somebody was faster."""
    done = connection.execute(
        update(account)
        .where(account.c.invitation == invitation, account.c.invited_until >= at, account.c.closed.is_(None))
        .values(secret=secret, invitation=None, invited_until=None, joined=at)
        .returning(account.c.person_id)
    ).scalar()
    return None if done is None else int(done)


def set_secret(connection: Connection, number: int, secret: str) -> None:
    """Another password, or the same kept in another way."""
    connection.execute(update(account).where(account.c.id == number).values(secret=secret))


def end_sessions(connection: Connection, number: int, at: datetime) -> None:
    """All sessions of a person that began before are over."""
    connection.execute(update(person).where(person.c.id == number).values(sessions_from=at))


def set_role(connection: Connection, number: int, role: str) -> None:
    """What a person who has an account may do from now on."""
    mine = account.c.person_id == number, account.c.closed.is_(None)
    connection.execute(update(account).where(*mine).values(role=role))


def is_last_instructor(connection: Connection, number: int) -> bool:
    """Whether nobody would be left to teach without this person."""
    mine = account_of(connection, number)
    return (mine is not None and mine.login == OWNER) or _teaching(connection) == {number}


def has_instructor(connection: Connection, at: datetime) -> bool:
    """Whether somebody can come in to teach, or is invited to."""
    asked = select(account.c.id).where(
        account.c.role == INSTRUCTOR, account.c.closed.is_(None), account.c.invited_until > at
    )
    return bool(_teaching(connection)) or connection.execute(asked).first() is not None


def _teaching(connection: Connection) -> set[int]:
    """Instructors who can come in now; until the transaction ends nobody else changes one."""
    found = (
        select(account.c.person_id)
        .where(account.c.role == INSTRUCTOR, account.c.closed.is_(None), account.c.secret != "")
        .with_for_update()
    )
    return set(connection.execute(found).scalars())
