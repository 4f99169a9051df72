"""How platforms know people: a person is tied to what a platform calls them, and never to a name."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Connection, select, update

from coursework.database.accounts import INSTRUCTOR
from coursework.database.people import people, person_by_id
from coursework.database.store import insert_unless_there
from coursework.database.tables import identity, person
from coursework.making.identity import EMAIL, NUMBER, is_called, same_id


def person_known(connection: Connection, issuer: str, subject: str) -> Any | None:
    """The person of a platform's identifier; None where nobody is tied to it."""
    told = identity.c.issuer == issuer, identity.c.subject == subject
    number = connection.execute(select(identity.c.person_id).where(*told)).scalar()
    return None if number is None else person_by_id(connection, number)


def tie(connection: Connection, number: int, issuer: str, subject: str) -> bool:
    """Tie a person to a platform's identifier; whether nobody was tied to it before."""
    row = {"person_id": number, "issuer": issuer, "subject": subject}
    return insert_unless_there(connection, identity, row, ("issuer", "subject")) is not None


def known_as(connection: Connection, number: int) -> list[tuple[str, str]]:
    """What platforms call a person: issuer and identifier."""
    told = select(identity.c.issuer, identity.c.subject).where(identity.c.person_id == number)
    return [(row.issuer, row.subject) for row in connection.execute(told)]


def fitting(connection: Connection, issuer: str, email: str, number: str) -> list[Any]:
    """The people whom an e-mail or a number tells, and whom the platform does not know yet. Nobody of the staff is among them:
    what a platform says of an address makes nobody an instructor."""
    known = set(connection.execute(select(identity.c.person_id).where(identity.c.issuer == issuer)).scalars())
    rows = {row.id: row for row in people(connection)}
    staff = {row.id for row in people(connection) if row.role == INSTRUCTOR}
    return [
        row
        for row in rows.values()
        if row.id not in known | staff and _fits(row, same_id(email), same_id(number))
    ]


def _fits(row: Any, email: str, number: str) -> bool:
    told = {one for one in (email, number) if one}
    if same_id(row.who) in told or (email and same_id(row.login or "") == email):
        return True
    pairs = [(title, same_id(value)) for title, value in row.columns.items() if value]
    return any(
        (value == email and is_called(title, EMAIL)) or (value == number and is_called(title, NUMBER))
        for title, value in pairs
    )


def take_over(connection: Connection, number: int, name: str, lang: str) -> None:
    """The name and the language that a platform tells, in the place of those before."""
    told = {key: value for key, value in (("name", name), ("lang", lang)) if value}
    if told:
        connection.execute(update(person).where(person.c.id == number).values(told))
