"""Deep linking: an instructor picks what links open, and the platform makes the links."""

from __future__ import annotations

import math
import secrets
import time
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import jwt

from coursework.lti.host import Form, Offer, Shelf
from coursework.lti.keys import Key
from coursework.lti.launch import Launch
from coursework.lti.refusal import Refused
from coursework.lti.wanted import AFTER, BEST, LAST, NEVER, Wanted, tries_of

_LTI = "https://purl.imsglobal.org/spec/lti/claim/"
_DEEP = "https://purl.imsglobal.org/spec/lti-dl/claim/"
_MOST_POINTS = 1_000_000.0


def found(shelves: Sequence[Shelf], sought: str) -> list[Shelf]:
    """Return the groups of offers, each reduced to the offers whose title, in any language, or name contains
    every searched word."""
    pieces = _folded(sought).split()
    kept = (
        (
            s,
            tuple(
                o
                for o in s.offers
                if all(piece in _folded(f"{o.title} {o.words} {s.title}") for piece in pieces)
            ),
        )
        for s in shelves
    )
    return [replace(shelf, offers=offers) for shelf, offers in kept if offers]


def _folded(text: str) -> str:
    """Return a text without capitals and accents."""
    apart = unicodedata.normalize("NFKD", text.casefold().replace("_", " "))
    return "".join(char for char in apart if not unicodedata.combining(char))


def content_items(launch: Launch, shelves: Iterable[Shelf], form: Form, url: str) -> list[dict[str, Any]]:
    """Return the links that a form requests.

    Raises
    ------
    Refused
        Nothing was ticked, more than the platform takes, what is not offered, or a setting that makes no sense.
    """
    picking = launch.picking
    if picking is None or not picking.links:
        raise Refused("no_links", 400, "the platform takes no link here")
    offers = {offer.key: offer for shelf in shelves for offer in shelf.offers}
    keys = list(dict.fromkeys(form.get("offer", ())))
    if not keys:
        raise Refused("no_choice", 400, "nothing was ticked")
    if len(keys) > 1 and not picking.several:
        raise Refused("too_many", 400, f"{len(keys)} links where one is taken")
    if any(key not in offers for key in keys):
        raise Refused("unknown_choice", 400, "what is not offered")
    rules = _rules(form)
    return [
        _item(
            offers[key],
            _opened(rules, key),
            _points(form) or offers[key].points,
            url,
            picking.with_line,
        )
        for key in keys
    ]


def _opened(rules: Wanted, key: str) -> Wanted:
    kind, _, name = key.partition(":")
    return replace(rules, assignment=name) if kind == "assignment" else replace(rules, exercise=name)


def _rules(form: Form) -> Wanted:
    counts, answers = _one(form, "counts") or BEST, _one(form, "answers") or NEVER
    if counts not in (BEST, LAST) or answers not in (NEVER, AFTER):
        raise Refused("no_question", 400, "no such rule")
    return Wanted(tries=tries_of(_one(form, "tries")), counts=counts, answers=answers)


def _points(form: Form) -> float | None:
    text = _one(form, "points").replace(",", ".")
    if not text:
        return None
    try:
        points = float(text)
    except ValueError:
        points = math.nan
    if not 0 < points <= _MOST_POINTS:
        raise Refused("no_question", 400, "points are no number above 0")
    return points


def _one(form: Form, name: str) -> str:
    return next(iter(form.get(name, ())), "").strip()


def _item(offer: Offer, wanted: Wanted, points: float, url: str, with_line: bool) -> dict[str, Any]:
    line = (
        {"lineItem": {"scoreMaximum": points, "label": offer.title, "resourceId": offer.key}}
        if with_line
        else {}
    )
    return {
        "type": "ltiResourceLink",
        "title": offer.title,
        "url": f"{url}/launch",
        "custom": wanted.custom(),
        **line,
    }


def response(launch: Launch, items: Sequence[dict[str, Any]], key: Key) -> str:
    """Return the signed response to the platform; it lists no items if nothing was chosen."""
    now, picking = int(time.time()), launch.picking
    told: dict[str, Any] = {
        "iss": launch.client_id,
        "aud": [launch.issuer],
        "iat": now,
        "exp": now + 300,
        "nonce": secrets.token_urlsafe(24),
        f"{_LTI}deployment_id": launch.deployment,
        f"{_LTI}message_type": "LtiDeepLinkingResponse",
        f"{_LTI}version": "1.3.0",
        f"{_DEEP}content_items": list(items),
    }
    if picking is not None and picking.data is not None:
        told[f"{_DEEP}data"] = picking.data
    return jwt.encode(told, key.private, "RS256", headers={"kid": key.kid})
