"""Check of permissions, before a route does anything."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sqlalchemy import Connection
from starlette.responses import Response

from coursework.database.areas import areas_for_role
from coursework.database.people import person_by_id
from coursework.database.permissions import STAFF, STUDENT, is_of_staff, may
from coursework.site.frame.requests import HTTPException, Person, Request, Route
from coursework.site.frame.responses import Download
from coursework.site.frame.settings import Site

GREATEST = 2**31 - 1  #: greatest id of a database


def person_of(connection: Connection, row: Any) -> Person:
    """Return a signed-in person with role and areas, from the row of the database."""
    role = row.role or STUDENT
    return Person(row.id, row.name, role, row.lang, areas_for_role(connection, row.id, role))


def check_permission(
    site: Site, route: Route, person: Person | None, path: Mapping[str, Any], *, is_post: bool
) -> None:
    """Check that a person may request a page.

    Parameters
    ----------
    person
        Current user; None if nobody is signed in.
    path
        Parameters of the path.
    is_post
        True if a form is sent.

    Raises
    ------
    HTTPException
        Nobody is signed in, or the role lacks the permission, or lacks it for this assignment or person.
    """
    permission = (route.form_permission if is_post else None) or route.permission
    if may(None, permission):
        return
    if person is None:
        raise HTTPException("sign_in", 401)
    if route.staff_permission is not None and _is_staff(site, path):
        permission = route.staff_permission
    if not may(person, permission):
        raise HTTPException("role", 403)
    if not is_of_staff(permission) or (assignment := _assignment(path)) is None:
        return
    if not may(person, permission, assignment, None if route.by_group else ""):
        raise HTTPException("own", 404)


def note_export(route: Route, request: Request, response: Response) -> None:
    """Record the download of a file by staff."""
    if not isinstance(response, Download) or not is_of_staff(route.permission):
        return
    about: dict[str, Any] = {"file": response.filename}
    if (assignment := _assignment(request.path_params)) is not None:
        about["assignment"] = assignment
    if (person := _number(request.path_params.get("person"))) is not None:
        about["person"] = person
    with request.site.store.begin() as connection:
        request.note(connection, route.audit_event, **about)


def _is_staff(site: Site, path: Mapping[str, Any]) -> bool:
    """Return True if the path names a member of staff."""
    number = _number(path.get("person"))
    if number is None:
        return False
    with site.store.reading() as connection:
        row = person_by_id(connection, number)
    return row is not None and row.role in STAFF


def _assignment(path: Mapping[str, Any]) -> int | None:
    return _number(path.get("assignment", path.get("number")))


def _number(value: Any) -> int | None:
    text = str(value)
    return (
        int(text)
        if text.isascii() and text.isdecimal() and len(text) < 11 and int(text) <= GREATEST
        else None
    )
