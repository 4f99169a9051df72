"""Storage of drafts while they are typed: the server's part of ``static/keeping.js``, for any sheet."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping

from sqlalchemy import Connection
from starlette.responses import JSONResponse, Response

from coursework.database.drafts import BLANK, DraftBox, DraftChange, drafts, save
from coursework.database.people import lock_person
from coursework.figures.student_drawing import MOST_CHARACTERS
from coursework.site.frame.requests import FormData, HTTPException, Request

LONGEST = 4000  #: characters of one answer
DRAWING = "drawing"  #: box of the drawing of a sheet; of a paper, behind the prefix of the exercise
_TEXT, _OVER = "text.", "over."


def save_drafts(
    request: Request,
    sheet: str,
    boxes: Collection[str],
    read: Callable[[str, str], str] | None = None,
    is_open: bool = True,
) -> Response:
    """Store the boxes that a page sends; return the boxes that another page has changed, and the reading of
    each text.

    A closed sheet accepts nothing new. Texts that were stored before it closed are acknowledged however often
    they are sent.

    Raises
    ------
    HTTPException
        The request names an unknown box, or a text is too long.
    """
    sent = sent_boxes(request.form, boxes)
    with request.site.store.begin() as connection:
        if not is_open and _is_new(drafts(connection, request.user.id, sheet), sent):
            return JSONResponse({"told": request.words["keeping"]["closed"]}, 409)
        now, others = save(connection, request.user.id, sheet, sent, request.received_at)
    mine = [name for name in sent if name not in others]
    answer = {
        "versions": {name: now[name].version if name in now else 0 for name in mine},
        "others": {name: box._asdict() for name, box in others.items()},
    }
    reads = (
        {"read": {name: read(name, sent[name].text) for name in mine if not is_drawing(name)}} if read else {}
    )
    return JSONResponse({**answer, **reads})


def _is_new(stood: Mapping[str, DraftBox], sent: Mapping[str, DraftChange]) -> bool:
    return not sent or any(box.text != stood.get(name, BLANK).text for name, box in sent.items())


def save_form_drafts(
    connection: Connection,
    request: Request,
    sheet: str,
    texts: Mapping[str, str],
    displayed: Callable[[Mapping[str, DraftBox]], Mapping[str, str]],
    versions: Mapping[str, int],
) -> tuple[dict[str, DraftBox], dict[str, DraftBox]]:
    """Store the drafts of a form without a script: ``texts`` by box, if they differ from those that the
    stored drafts ``displayed`` or a draft exists.

    Return the stored boxes, and those that another page has changed since, which are not overwritten.
    """
    lock_person(connection, request.user.id)
    stored = drafts(connection, request.user.id, sheet)
    before = displayed(stored)
    sent = {
        name: DraftChange(text, versions.get(name, 0))
        for name, text in texts.items()
        if name in stored or text != before.get(name, "")
    }
    return save(connection, request.user.id, sheet, sent, request.received_at, stored)


def sent_boxes(form: FormData, boxes: Collection[str]) -> dict[str, DraftChange]:
    """Return the boxes that a page sends: ``text.NAME``, and ``over.NAME``, the version that the text
    replaces."""
    sent = {}
    for field in form.texts:
        name = field.removeprefix(_TEXT)
        if field.startswith(_TEXT):
            text, over = form.text(field), form.text(_OVER + name, "0")
            if name not in boxes or not over.isdecimal() or len(over) > 9:
                raise HTTPException("bad_request", 400)
            if len(text) > longest(name):
                raise HTTPException("too_large", 413, f"{longest(name)}")
            sent[name] = DraftChange(text, int(over))
    return sent


def is_drawing(box: str) -> bool:
    """Return whether a box contains a drawing."""
    return box.rpartition("-")[2] == DRAWING


def longest(box: str) -> int:
    """Return the number of characters that a box may contain."""
    return MOST_CHARACTERS if is_drawing(box) else LONGEST


def versions_of(text: str) -> dict[str, int]:
    """Return the versions of boxes stated in a form without a script, as JSON (:func:`draft_attributes`).

    Raises
    ------
    HTTPException
        The text is not a table of versions.
    """
    try:
        return {str(name): int(number) for name, number in json.loads(text or "{}").items()}
    except (ValueError, TypeError, AttributeError, OverflowError, RecursionError):
        raise HTTPException("bad_request", 400) from None


def draft_attributes(
    request: Request, address: str, sheet: str, boxes: Mapping[str, DraftBox], prefix: str = "", **texts: str
) -> dict[str, str]:
    """Return the attributes of a form whose boxes are stored as drafts; ``boxes`` are those that the page
    shows.

    ``prefix`` is the prefix of the names of the boxes on the page; ``texts`` adds to the texts of
    ``[keeping]`` or replaces them.
    """
    return {
        "data-keep": address,
        "data-keep-as": f"{request.user.id} {sheet}",
        "data-keep-own": prefix,
        "data-keep-versions": json.dumps({name: box.version for name, box in boxes.items()}),
        "data-keep-words": json.dumps({**request.words["keeping"], **texts}, ensure_ascii=False),
    }


def box_values(text: str) -> list[str]:
    """Return the content of a box for the templates of sheets: the text, and each of several ticks."""
    return [text, *text.split(", ")] if ", " in text else [text]
