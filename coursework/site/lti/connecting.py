"""Connection of an account of a platform with an account of the site, confirmed once by the password."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from itsdangerous import BadSignature, URLSafeTimedSerializer
from starlette.responses import Response

from coursework.database.accounts import account_of
from coursework.database.identities import link_identity
from coursework.database.permissions import Permission
from coursework.site.frame.budgets import PLAIN
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import redirect
from coursework.site.frame.settings import Site
from coursework.site.people import guessing, passwords
from coursework.site.people.accounts import own_attempt

if TYPE_CHECKING:
    from coursework.platforms.lti.launch import Launch

_SECONDS = 15 * 60  #: lifetime of the address in seconds


def _signed(site: Site) -> URLSafeTimedSerializer:
    return URLSafeTimedSerializer(
        site.secret, salt="connect", signer_kwargs={"digest_method": hashlib.sha256}
    )


def address(site: Site, launch: Launch, person: int) -> str:
    """Return the address at which the person of a launch, and nobody else, may connect it with their
    account."""
    content = [launch.issuer, launch.person, launch.name, person]
    return f"{site.url}/connect/{_signed(site).dumps(content)}"


def connect(request: Request) -> Response:
    """Return the page that connects an account of a platform with the current user, who enters the password
    again."""
    issuer, subject, name = _read_token(request)
    platform = urlsplit(issuer).hostname or issuer
    with request.site.store.reading() as connection:
        mine = account_of(connection, request.user.id)
    if mine is None or not mine.secret or request.user.is_staff:
        raise HTTPException("role", 403)
    missed = request.is_post and not passwords.fits(mine.secret, request.form.text("now"))
    if missed:
        guessing.missed(request, mine.login)
    elif request.is_post:
        guessing.fitted(request, mine.login)
        _tie(request, issuer, subject, platform)
        return redirect("/account")
    names = {"platform": platform, "name": name or subject, "login": mine.login, "missed": missed}
    return request.render("site/connect", 422 if missed else 200, **names)


def _read_token(request: Request) -> tuple[str, str, str]:
    try:
        issuer, subject, name, person = _signed(request.site).loads(
            str(request.path_params["token"]), max_age=_SECONDS
        )
    except (BadSignature, ValueError, TypeError):
        raise HTTPException("connect_over", 410) from None
    if person != request.user.id:
        raise HTTPException("connect_other", 403)
    return str(issuer), str(subject), str(name)


def _tie(request: Request, issuer: str, subject: str, platform: str) -> None:
    with request.site.store.begin() as connection:
        if not link_identity(connection, request.user.id, issuer, subject):
            raise HTTPException("connect_over", 410)
        about = {"person": request.user.id, "platform": platform, "how": "password"}
        request.note(connection, "connected a platform", **about)


ROUTES = (
    Route(
        "/connect/{token}",
        connect,
        Permission.OWN,
        takes_forms=True,
        limit="sign_in",
        budget=PLAIN,
        attempt=own_attempt,
    ),
)
