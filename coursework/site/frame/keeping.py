"""What is typed is kept as it is typed: the other end of ``static/keeping.js``, for whatever sheet a page shows."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping
from typing import Any

from coursework.database.drafts import Box, Sent, drafts, save
from coursework.database.people import hold
from coursework.site.frame.visits import Form, Refused, Reply, Visit

LONGEST = 4000  #: characters of one answer
_TEXT, _OVER = "text.", "over."
_BLANK = Box("", 0)


def kept(
    visit: Visit,
    sheet: str,
    boxes: Collection[str],
    read: Callable[[str, str], str] | None = None,
    is_open: bool = True,
) -> Reply:
    """Keep what a page sends of its boxes, and say what stands where another page wrote, and how each text is read.

    A sheet that is closed takes nothing new; what was kept before it closed is said to be kept, however often it is sent.

    Raises
    ------
    Refused
        It sends what is no box of the sheet, or more than anybody types.
    """
    sent = sent_boxes(visit.form, boxes)
    with visit.site.store.begin() as connection:
        hold(connection, visit.who.id)
        if not is_open and _is_new(drafts(connection, visit.who.id, sheet), sent):
            return json_reply({"told": visit.said["keeping"]["closed"]}, 409)
        others = save(connection, visit.who.id, sheet, sent, visit.at)
        now = drafts(connection, visit.who.id, sheet)
    mine = [name for name in sent if name not in others]
    told = {
        "versions": {name: now[name].version if name in now else 0 for name in mine},
        "others": {name: box._asdict() for name, box in others.items()},
    }
    reads = {"read": {name: read(name, sent[name].text) for name in mine}} if read else {}
    return json_reply({**told, **reads})


def _is_new(stood: Mapping[str, Box], sent: Mapping[str, Sent]) -> bool:
    return not sent or any(one.text != stood.get(name, _BLANK).text for name, one in sent.items())


def keep_form(
    visit: Visit, sheet: str, texts: Mapping[str, str], shown: Mapping[str, str], versions: str
) -> tuple[dict[str, Box], dict[str, Box]]:
    """Keep what a form without a script brings: ``texts`` by box, where it ``shown`` something else or something is kept.

    ``versions`` is JSON, as :func:`keeper` has it. Gives what is kept now, and the boxes that another page wrote to since:
    these are not overwritten.

    Raises
    ------
    Refused
        The versions cannot be read.
    """
    over = versions_of(versions)
    with visit.site.store.begin() as connection:
        hold(connection, visit.who.id)
        stood = drafts(connection, visit.who.id, sheet)
        sent = {
            name: Sent(text, over.get(name, 0))
            for name, text in texts.items()
            if name in stood or text != shown.get(name, "")
        }
        others = save(connection, visit.who.id, sheet, sent, visit.at)
        return drafts(connection, visit.who.id, sheet), others


def json_reply(told: Mapping[str, Any], status: int = 200) -> Reply:
    return Reply(kind="application/json", data=json.dumps(told, ensure_ascii=False).encode(), status=status)


def sent_boxes(form: Form, boxes: Collection[str]) -> dict[str, Sent]:
    """What a page sends, by box: ``text.NAME``, and ``over.NAME``, the version that it was written over."""
    found = {}
    for field in form.texts:
        name = field.removeprefix(_TEXT)
        if field.startswith(_TEXT):
            text, over = form.text(field), form.text(_OVER + name, "0")
            if name not in boxes or not over.isdecimal() or len(over) > 9:
                raise Refused("bad_request", 400)
            if len(text) > LONGEST:
                raise Refused("too_large", 413, f"{LONGEST}")
            found[name] = Sent(text, int(over))
    return found


def versions_of(text: str) -> dict[str, int]:
    """The versions of boxes that a form of a page without a script holds.

    Raises
    ------
    Refused
        They are none.
    """
    try:
        return {str(name): int(number) for name, number in json.loads(text or "{}").items()}
    except (ValueError, TypeError, AttributeError, OverflowError, RecursionError):
        raise Refused("bad_request", 400) from None


def keeper(
    visit: Visit, address: str, sheet: str, boxes: Mapping[str, Box], own: str = "", **said: str
) -> dict[str, str]:
    """The attributes of a form whose boxes are kept; ``boxes`` as the page shows them.

    ``own`` is what the names of the boxes begin with on the page, and ``said`` sentences beside those of ``[keeping]``, or
    in their places.
    """
    return {
        "data-keep": address,
        "data-keep-as": f"{visit.who.id} {sheet}",
        "data-keep-own": own,
        "data-keep-versions": json.dumps({name: box.version for name, box in boxes.items()}),
        "data-keep-words": json.dumps({**visit.said["keeping"], **said}, ensure_ascii=False),
    }


def held(text: str) -> list[str]:
    """What stands in a box, as templates of sheets ask: the text, and each of several ticks."""
    return [text, *text.split(", ")] if ", " in text else [text]
