"""Scores on their way to platforms, for staff, with the reasons for delays."""

from __future__ import annotations

from typing import Any

from starlette.responses import Response

from coursework.database.permissions import Permission
from coursework.platforms.lti.storage import Storage
from coursework.rendering.views import points_number
from coursework.site.frame.requests import Request, Route


def waiting(request: Request) -> Response:
    """Return the scores that wait to be sent, and the number of those that arrived."""
    if request.site.lti is None:
        return request.render("site/instructor/lti", is_on=False, rows=[], arrived=0)
    every = Storage(request.site.store).scores()
    rows: list[dict[str, Any]] = [
        {
            "link": entry.launch.link_title or entry.launch.link,
            "name": entry.name,
            "points": f"{points_number(entry.score.given, request.lang)} / "
            f"{points_number(entry.score.maximum, request.lang)}",
            "failures": entry.failures,
            "why": entry.problem,
        }
        for entry in every
        if entry.due is not None
    ]
    return request.render("site/instructor/lti", is_on=True, rows=rows, arrived=len(every) - len(rows))


ROUTES = (Route("/desk/lti", waiting, Permission.PLATFORMS_READ),)
