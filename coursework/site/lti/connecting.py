"""Connecting an account of a platform with an account of the site: who has a password enters it once."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from itsdangerous import BadSignature, URLSafeTimedSerializer

from coursework.database.accounts import account_of
from coursework.database.audit import note
from coursework.database.identities import tie
from coursework.database.permissions import Permission
from coursework.site.frame.attempts import Attempt
from coursework.site.frame.budgets import PLAIN
from coursework.site.frame.settings import Site
from coursework.site.frame.visits import Page, Refused, Reply, Visit
from coursework.site.people import guessing, passwords

if TYPE_CHECKING:
    from coursework.lti.launch import Launch

_SECONDS = 15 * 60  #: for which the address of a launch holds


def _signed(site: Site) -> URLSafeTimedSerializer:
    return URLSafeTimedSerializer(
        site.secret, salt="connect", signer_kwargs={"digest_method": hashlib.sha256}
    )


def address(site: Site, launch: Launch, person: int) -> str:
    """Return where the person whom a launch tells may connect it with their account: no other person can there."""
    told = [launch.issuer, launch.person, launch.name, person]
    return f"{site.url}/connect/{_signed(site).dumps(told)}"


def connect(visit: Visit) -> Reply:
    """Answer the page that ties an account of a platform to who is signed in, once they enter their password again."""
    issuer, subject, name = _told(visit)
    platform = urlsplit(issuer).hostname or issuer
    with visit.site.store.reading() as connection:
        mine = account_of(connection, visit.who.id)
    if mine is None or not mine.secret or visit.who.is_staff:
        raise Refused("role", 403)
    missed = visit.posted and not passwords.fits(mine.secret, visit.form.text("now"))
    if missed:
        guessing.missed(visit, mine.login)
    elif visit.posted:
        guessing.fitted(visit, mine.login)
        _tie(visit, issuer, subject, platform)
        return Reply(goto="/account")
    told = {"platform": platform, "name": name or subject, "login": mine.login, "missed": missed}
    return visit.page("site_connect", 422 if missed else 200, **told)


def _told(visit: Visit) -> tuple[str, str, str]:
    try:
        issuer, subject, name, person = _signed(visit.site).loads(str(visit.path["token"]), max_age=_SECONDS)
    except (BadSignature, ValueError, TypeError):
        raise Refused("connect_over", 410) from None
    if person != visit.who.id:
        raise Refused("connect_other", 403)
    return str(issuer), str(subject), str(name)


def _tie(visit: Visit, issuer: str, subject: str, platform: str) -> None:
    with visit.site.store.begin() as connection:
        if not tie(connection, visit.who.id, issuer, subject):
            raise Refused("connect_over", 410)
        about = {"person": visit.who.id, "platform": platform, "how": "password"}
        note(connection, visit.at, visit.actor, "connected a platform", **about)


def _attempt(visit: Visit) -> Attempt:
    with visit.site.store.reading() as connection:
        mine = account_of(connection, visit.who.id)
    return guessing.attempt_of(visit, mine.login) if mine is not None else Attempt()


PAGES = (
    Page(
        "/connect/{token}",
        connect,
        Permission.OWN,
        posts=True,
        limit="sign_in",
        budget=PLAIN,
        attempt=_attempt,
    ),
)
