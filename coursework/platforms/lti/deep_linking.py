"""Deep linking: an instructor chooses the content of links, and the platform creates the links."""

from __future__ import annotations

import math
import secrets
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import jwt

from coursework.errors import bare_letters
from coursework.platforms.lti.keys import SigningKey
from coursework.platforms.lti.launch import Launch
from coursework.platforms.lti.link_settings import AFTER, BEST, LAST, NEVER, LinkSettings, tries_of
from coursework.platforms.lti.refusal import LTIRefusal

_LTI = "https://purl.imsglobal.org/spec/lti/claim/"
_DEEP = "https://purl.imsglobal.org/spec/lti-dl/claim/"
_MOST_POINTS = 1_000_000.0

Form = Mapping[str, Sequence[str]]  #: values of each field


@dataclass(frozen=True)
class Offer:
    """Exercise or assignment that a link may open."""

    key: str  #: ``exercise:slotted_mechanism``
    title: str
    points: float
    words: str = ""  #: further search text: its title in other languages


@dataclass(frozen=True)
class OfferGroup:
    """Offers that stand together, under a title."""

    title: str
    offers: tuple[Offer, ...]


def matching_offers(offer_groups: Sequence[OfferGroup], sought: str) -> list[OfferGroup]:
    """Return the groups of offers, each reduced to the offers whose title, in any language, or name contains
    every searched word."""
    pieces = bare_letters(sought.replace("_", " ")).split()
    matching = (
        (
            s,
            tuple(
                o
                for o in s.offers
                if all(
                    piece in bare_letters(f"{o.title} {o.words} {s.title}".replace("_", " "))
                    for piece in pieces
                )
            ),
        )
        for s in offer_groups
    )
    return [replace(group, offers=offers) for group, offers in matching if offers]


def content_items(
    launch: Launch, offer_groups: Iterable[OfferGroup], form: Form, url: str
) -> list[dict[str, Any]]:
    """Return the links that a form requests.

    Raises
    ------
    LTIRefusal
        Nothing was ticked, more than the platform takes, what is not offered, or a setting that makes no
        sense.
    """
    picking = launch.picking
    if picking is None or not picking.links:
        raise LTIRefusal("no_links", 400, "the platform takes no link here")
    offers = {offer.key: offer for group in offer_groups for offer in group.offers}
    keys = list(dict.fromkeys(form.get("offer", ())))
    if not keys:
        raise LTIRefusal("no_choice", 400, "nothing was ticked")
    if len(keys) > 1 and not picking.several:
        raise LTIRefusal("too_many", 400, f"{len(keys)} links where one is taken")
    if any(key not in offers for key in keys):
        raise LTIRefusal("unknown_choice", 400, "what is not offered")
    rules = _rules(form)
    return [
        _item(
            offers[key],
            _with_content(rules, key),
            _points(form) or offers[key].points,
            url,
            picking.with_line,
        )
        for key in keys
    ]


def _with_content(rules: LinkSettings, key: str) -> LinkSettings:
    kind, _, name = key.partition(":")
    return replace(rules, assignment=name) if kind == "assignment" else replace(rules, exercise=name)


def _rules(form: Form) -> LinkSettings:
    counts, answers = _field(form, "counts") or BEST, _field(form, "answers") or NEVER
    if counts not in (BEST, LAST) or answers not in (NEVER, AFTER):
        raise LTIRefusal("no_question", 400, "no such rule")
    return LinkSettings(tries=tries_of(_field(form, "tries")), counts=counts, answers=answers)


def _points(form: Form) -> float | None:
    text = _field(form, "points").replace(",", ".")
    if not text:
        return None
    try:
        points = float(text)
    except ValueError:
        points = math.nan
    if not 0 < points <= _MOST_POINTS:
        raise LTIRefusal("no_question", 400, "points are not a number above 0")
    return points


def _field(form: Form, name: str) -> str:
    return next(iter(form.get(name, ())), "").strip()


def _item(offer: Offer, wanted: LinkSettings, points: float, url: str, with_line: bool) -> dict[str, Any]:
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


def response(launch: Launch, items: Sequence[dict[str, Any]], key: SigningKey) -> str:
    """Return the signed response to the platform; it lists no items if nothing was chosen."""
    now, picking = int(time.time()), launch.picking
    claims: dict[str, Any] = {
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
        claims[f"{_DEEP}data"] = picking.data
    return jwt.encode(claims, key.private, "RS256", headers={"kid": key.kid})
