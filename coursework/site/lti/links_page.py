"""Scores on their way to platforms, for staff, with the reasons for delays."""

from __future__ import annotations

from typing import Any

from sqlalchemy import Connection, select

from coursework.database.permissions import Permission
from coursework.database.tables import identity, person
from coursework.lti.storage import Storage
from coursework.site.frame.requests import Request, Response, Route
from coursework.site.lti.scores import number_text


def waiting(request: Request) -> Response:
    """Return the scores that wait to be sent, and the number of those that arrived."""
    if request.site.lti is None:
        return request.render("site/instructor/lti", is_on=False, rows=[], arrived=0)
    every = list(Storage(request.site.lti).scores().values())
    with request.site.store.reading() as connection:
        names = _names(connection)
    rows: list[dict[str, Any]] = [
        {
            "link": entry.title or entry.link,
            "name": names.get(entry.person, entry.person),
            "points": f"{number_text(entry.score.given, request.lang)} / {number_text(entry.score.maximum, request.lang)}",
            "failures": entry.failures,
            "why": entry.problem,
        }
        for entry in every
        if entry.due is not None
    ]
    return request.render("site/instructor/lti", is_on=True, rows=rows, arrived=len(every) - len(rows))


def _names(connection: Connection) -> dict[str, str]:
    """Return the names of people by their identifiers on platforms; for an identifier on two platforms, the
    first."""
    query = select(identity.c.subject, person.c.name).join(person).order_by(identity.c.id.desc())
    return {row.subject: row.name for row in connection.execute(query)}


ROUTES = (Route("/desk/lti", waiting, Permission.PLATFORMS_READ),)
