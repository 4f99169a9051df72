"""People: students and staff, and how they sign in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, Select, insert, select, update

from coursework.database.tables import account, person
from coursework.errors import BadInput, bare_letters
from coursework.issuing.exam_columns import cell, extra_time_of
from coursework.issuing.identity import EXTRA_TIME
from coursework.issuing.roster import Student


def people_query() -> Select[Any]:
    """Return a query of people with role and login of their open account, each None where there is none."""
    mine = (account.c.person_id == person.c.id) & account.c.closed.is_(None)
    return select(person, account.c.role, account.c.login).select_from(person.outerjoin(account, mine))


def people(connection: Connection) -> list[Any]:
    """Return all people, sorted by name without regard to accents: Bäcker before Blanc."""
    rows = connection.execute(people_query().order_by(person.c.id))
    return sorted(rows, key=lambda row: (bare_letters(row.name), row.name))


def person_by_id(connection: Connection, number: int) -> Any | None:
    """Return ``id``, ``who``, ``name``, ``lang``, ``columns``, ``role`` and ``login`` of a
    person; None if there is no such person."""
    return connection.execute(people_query().where(person.c.id == number)).first()


def person_by_identifier(connection: Connection, identifier: str) -> Any | None:
    """Return the person with a roster's identifier."""
    return connection.execute(people_query().where(person.c.who == identifier)).first()


def lock_person(connection: Connection, number: int) -> None:
    """Lock a person's row until the transaction ends. SQLite has only one writer and needs no lock."""
    if connection.dialect.name != "sqlite":
        connection.execute(select(person.c.id).where(person.c.id == number).with_for_update(key_share=True))


def put_person(
    connection: Connection, identifier: str, name: str, lang: str, columns: Mapping[str, str]
) -> int:
    """Add or update the person of a roster; return the id. A name, a language and columns replace those
    before, unless they are empty."""
    row_before = person_by_identifier(connection, identifier)
    values: dict[str, Any] = {
        key: value for key, value in (("name", name), ("lang", lang), ("columns", dict(columns))) if value
    }
    if row_before is not None:
        values |= _changed_extra_time(row_before.columns, columns)
    if row_before is None:
        row = {
            "who": identifier,
            "name": name,
            "lang": lang,
            "columns": dict(columns),
            "created": datetime.now(UTC),
            **_stated_extra_time(columns),
        }
        return int(connection.execute(insert(person).values(row).returning(person.c.id)).scalar_one())
    if any(getattr(row_before, key) != value for key, value in values.items()):
        connection.execute(update(person).where(person.c.id == row_before.id).values(values))
    return int(row_before.id)


def _stated_extra_time(columns: Mapping[str, str]) -> dict[str, float | None]:
    """Return the extra time that a roster states, as values of a row; none for an empty cell, which leaves it
    as it was."""
    if not cell(columns, EXTRA_TIME):
        return {}
    try:
        return {"extra_time": float(extra_time_of(columns)) or None}
    except BadInput:  # of a file from elsewhere; a roster is checked when it is read
        return {}


def _changed_extra_time(had: Mapping[str, str], columns: Mapping[str, str]) -> dict[str, float | None]:
    """Return the extra time that a roster states otherwise than the one before; one that was set by hand
    meanwhile stays."""
    stated = _stated_extra_time(columns)
    return stated if stated != _stated_extra_time(had) else {}


def set_extra_time(connection: Connection, numbers: Sequence[int], share: float) -> None:
    """Set the share by which the working times of people are longer; 0 for none."""
    connection.execute(update(person).where(person.c.id.in_(numbers)).values(extra_time=share or None))


def put_people(connection: Connection, students: Sequence[Student]) -> dict[str, int]:
    """Add the new people of a roster, and new columns of known ones; return the ids of all people by the
    roster's identifier."""
    people_before = {
        row.who: row
        for row in connection.execute(
            select(person.c.who, person.c.id, person.c.columns, person.c.extra_time)
        )
    }
    now = datetime.now(UTC)
    new = {student.draw_key: student for student in students if student.draw_key not in people_before}
    rows = [
        {
            "who": identifier,
            "name": student.name,
            "lang": student.lang,
            "columns": dict(student.columns),
            "created": now,
            **{"extra_time": None, **_stated_extra_time(student.columns)},
        }
        for identifier, student in new.items()
    ]
    if rows:
        connection.execute(insert(person), rows)
    for student in students:
        had = people_before.get(student.draw_key)
        if had is None:
            continue
        values = {
            "columns": {**had.columns, **student.columns},
            **_changed_extra_time(had.columns, student.columns),
        }
        if any(getattr(had, key) != value for key, value in values.items()):
            connection.execute(update(person).where(person.c.id == had.id).values(values))
    return {row.who: row.id for row in connection.execute(select(person.c.who, person.c.id))}


def put_account(connection: Connection, number: int, login: str, role: str) -> None:
    """Add an account to a person, unless the login has one already."""
    if connection.execute(select(account.c.id).where(account.c.login == login)).first() is None:
        row = {"person_id": number, "login": login, "role": role, "created": datetime.now(UTC)}
        connection.execute(insert(account).values(row))
