"""Identities of people on platforms: a person is linked to a platform's identifier, never to a name."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Connection, delete, select, update

from coursework.database.people import people, person_by_id
from coursework.database.permissions import STAFF
from coursework.database.store import insert_unless_there
from coursework.database.tables import account, identity, person
from coursework.issuing.identity import EMAIL, NUMBER, is_called, same_id


def person_linked_to(connection: Connection, issuer: str, subject: str) -> Any | None:
    """Return the person with a platform's identifier; None if no person is linked to it."""
    conditions = identity.c.issuer == issuer, identity.c.subject == subject
    number = connection.execute(select(identity.c.person_id).where(*conditions)).scalar()
    return None if number is None else person_by_id(connection, number)


def link_identity(connection: Connection, number: int, issuer: str, subject: str) -> bool:
    """Link a person to a platform's identifier; return True if nobody was linked to it before."""
    row = {"person_id": number, "issuer": issuer, "subject": subject}
    return insert_unless_there(connection, identity, row, ("issuer", "subject")) is not None


def people_matching(connection: Connection, issuer: str, email: str, number: str) -> list[Any]:
    """Return the people with the e-mail or the number of a launch who are not linked to the platform yet.
    Staff are excluded: a platform's statement of an address grants no role."""
    linked = set(
        connection.execute(select(identity.c.person_id).where(identity.c.issuer == issuer)).scalars()
    )
    rows = {row.id: row for row in people(connection)}
    staff = {row.id for row in people(connection) if row.role in STAFF}
    return [
        row
        for row in rows.values()
        if row.id not in linked | staff and _fits(row, same_id(email), same_id(number))
    ]


def _fits(row: Any, email: str, number: str) -> bool:
    identifiers = {identifier for identifier in (email, number) if identifier}
    if same_id(row.who) in identifiers or (email and same_id(row.login or "") == email):
        return True
    pairs = [(title, same_id(value)) for title, value in row.columns.items() if value]
    return any(
        (value == email and is_called(title, EMAIL)) or (value == number and is_called(title, NUMBER))
        for title, value in pairs
    )


def has_password(connection: Connection, number: int) -> bool:
    """Return True if a person has chosen a password; no platform then identifies them."""
    mine = account.c.person_id == number, account.c.secret != ""
    return connection.execute(select(account.c.id).where(*mine)).first() is not None


def links_of(connection: Connection, number: int) -> list[Any]:
    """Return the links of a person to platforms: ``id``, ``issuer`` and ``subject`` of each."""
    query = select(identity.c.id, identity.c.issuer, identity.c.subject)
    return list(connection.execute(query.where(identity.c.person_id == number).order_by(identity.c.id)))


def unlink_identity(connection: Connection, number: int, tie_id: int) -> tuple[str, str] | None:
    """Delete one link of a person; return its issuer and subject, or None if there is none."""
    mine = identity.c.id == tie_id, identity.c.person_id == number
    gone = delete(identity).where(*mine).returning(identity.c.issuer, identity.c.subject)
    row = connection.execute(gone).first()
    return (row.issuer, row.subject) if row is not None else None


def update_from_platform(connection: Connection, number: int, name: str, lang: str) -> None:
    """Replace a person's name and language by those that a platform states."""
    values = {key: value for key, value in (("name", name), ("lang", lang)) if value}
    if values:
        connection.execute(update(person).where(person.c.id == number).values(values))
