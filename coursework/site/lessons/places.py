"""Places at which a person stopped in lessons, and what they filled in there, so that another device goes on
there."""

from __future__ import annotations

import re
from collections.abc import Mapping

from starlette.responses import Response

from coursework.database.drafts import BLANK, DraftChange, drafts, save
from coursework.sheets.book import BlanksPiece
from coursework.site.frame.requests import HTTPException, Request

_SHEET = "lessons"  #: whose boxes are lessons; behind it a lesson, the boxes of its examples
_PLACE = re.compile(r"[1-9]\d{0,3}/[1-9]\d{0,3}/\d{1,15}")  #: step, of how many, and when, ms of the epoch


def places(request: Request) -> dict[str, str]:
    """Return the places of the person by lesson, as the page's script writes them: step, number of steps, and
    time."""
    with request.site.store.reading() as connection:
        return {name: box.text for name, box in drafts(connection, request.user.id, _SHEET).items()}


def keep_place(request: Request, lesson: str) -> Response:
    """Store the place that a page sends, unless a later one is stored. Raises HTTPException: it is no
    place."""
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


def boxes_of(blanks: BlanksPiece) -> dict[str, str]:
    """Return the names of the boxes of an example by the names of its answers; other numbers make another
    example."""
    example = f"{blanks.exercise}/{blanks.seed}/{blanks.level}"
    return {key: f"{example}/{key}" for _, key, _ in blanks.questions}


def kept_blanks(request: Request, lesson: str) -> dict[str, str]:
    """Return what the person filled in in a lesson, by box."""
    with request.site.store.reading() as connection:
        found = drafts(connection, request.user.id, f"{_SHEET}/{lesson}")
    return {name: box.text for name, box in found.items()}


def keep_blanks(request: Request, lesson: str, blanks: BlanksPiece, texts: Mapping[str, str]) -> None:
    """Store what the person fills in in an example; the last text counts."""
    sheet, boxes = f"{_SHEET}/{lesson}", boxes_of(blanks)
    with request.site.store.begin() as connection:
        stored = drafts(connection, request.user.id, sheet)
        sent = {
            boxes[key]: DraftChange(text, stored.get(boxes[key], BLANK).version)
            for key, text in texts.items()
        }
        save(connection, request.user.id, sheet, sent, request.received_at)
