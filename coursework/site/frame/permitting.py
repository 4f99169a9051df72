"""The check of permissions: whether who asks may have a page of the table, before anything of it is done."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sqlalchemy import Connection

from coursework.database.areas import held_by
from coursework.database.audit import note
from coursework.database.people import person_by_id
from coursework.database.permissions import STAFF, STUDENT, is_of_staff, may
from coursework.site.frame.settings import Site
from coursework.site.frame.visits import Page, Person, Refused, Reply, Visit

_GREATEST = 2**31 - 1  #: that ids of a database reach


def person_of(connection: Connection, row: Any) -> Person:
    """Return somebody who signed in, with what they may, of their row in the database."""
    role = row.role or STUDENT
    return Person(row.id, row.name, role, row.lang, held_by(connection, row.id, role))


def check_permission(
    site: Site, page: Page, person: Person | None, path: Mapping[str, Any], *, posted: bool
) -> None:
    """Check that a person may request a page.

    Parameters
    ----------
    person
        Who asks; None where nobody is signed in.
    path
        What the places of the page's path hold.
    posted
        Whether a form is sent.

    Raises
    ------
    Refused
        They may not: nobody is signed in, their role has not the permission, or not for this assignment or person.
    """
    needs = (page.posting if posted else None) or page.needs
    if may(None, needs):
        return
    if person is None:
        raise Refused("sign_in", 401)
    if page.of_staff is not None and _is_staff(site, path):
        needs = page.of_staff
    if not may(person, needs):
        raise Refused("role", 403)
    if not is_of_staff(needs) or (assignment := _assignment(path)) is None:
        return
    if not may(person, needs, assignment, None if page.by_group else ""):
        raise Refused("own", 404)


def note_export(page: Page, visit: Visit, reply: Reply) -> None:
    """Record that somebody of the staff took a file."""
    if not reply.file or not is_of_staff(page.needs):
        return
    about: dict[str, Any] = {"file": reply.file}
    if (assignment := _assignment(visit.path)) is not None:
        about["assignment"] = assignment
    if (person := _number(visit.path.get("person"))) is not None:
        about["person"] = person
    with visit.site.store.begin() as connection:
        note(connection, visit.at, visit.actor, page.noted, **about)


def _is_staff(site: Site, path: Mapping[str, Any]) -> bool:
    """Return whether a path names somebody of the staff."""
    number = _number(path.get("person"))
    if number is None:
        return False
    with site.store.reading() as connection:
        row = person_by_id(connection, number)
    return row is not None and row.role in STAFF


def _assignment(path: Mapping[str, Any]) -> int | None:
    return _number(path.get("assignment", path.get("number")))


def _number(told: Any) -> int | None:
    text = str(told)
    return (
        int(text)
        if text.isascii() and text.isdecimal() and len(text) < 11 and int(text) <= _GREATEST
        else None
    )
