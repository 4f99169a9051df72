"""Places at which a person stopped in lessons, so that another device goes on there."""

from __future__ import annotations

import re

from starlette.responses import Response

from coursework.database.drafts import BLANK, DraftChange, drafts, save
from coursework.site.frame.requests import HTTPException, Request

_SHEET = "lessons"  #: whose boxes are lessons
_PLACE = re.compile(r"[1-9]\d{0,3}/[1-9]\d{0,3}/\d{1,15}")  #: step, of how many, and when, ms of the epoch


def places(request: Request) -> dict[str, str]:
    """Return the places of the person by lesson, as the page's script writes them: step, number of steps, and time."""
    with request.site.store.reading() as connection:
        return {name: box.text for name, box in drafts(connection, request.user.id, _SHEET).items()}


def keep_place(request: Request, lesson: str) -> Response:
    """Store the place that a page sends, unless a later one is stored. Raises HTTPException: it is no place."""
    text = request.form.text("place")
    if not _PLACE.fullmatch(text):
        raise HTTPException("bad_request", 400)
    with request.site.store.begin() as connection:
        stored = drafts(connection, request.user.id, _SHEET).get(lesson, BLANK)
        if not stored.text or _time(stored.text) < _time(text):
            change = DraftChange(text, stored.version)
            save(connection, request.user.id, _SHEET, {lesson: change}, request.received_at)
    return Response(status_code=204)


def _time(place: str) -> int:
    return int(place.rpartition("/")[2])
