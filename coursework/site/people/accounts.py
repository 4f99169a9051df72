"""Sign-in, invitations, and the page of the current user's account."""

from __future__ import annotations

import secrets
from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import Connection
from starlette.responses import Response

from coursework.database.accounts import (
    accept_invitation,
    account_by_login,
    account_invited,
    account_of,
    has_administrator,
    invite,
    set_role,
    set_secret,
)
from coursework.database.audit import OF_ACCOUNTS, Actor, note, noted
from coursework.database.people import put_person
from coursework.database.permissions import ADMINISTRATOR, Permission
from coursework.database.sessions import (
    LONGEST,
    begin_session,
    digest_of,
    end_session,
    end_sessions,
    sessions_of,
)
from coursework.errors import BadInput
from coursework.platforms.lti.storage import end_launch_sessions
from coursework.site.frame.attempts import Attempt
from coursework.site.frame.budgets import PLAIN
from coursework.site.frame.cookies import ANONYMOUS_SECONDS, COOKIE
from coursework.site.frame.devices import DEVICE, DEVICE_SECONDS, Devices
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import local, redirect, set_cookie
from coursework.site.frame.security_log import SIGNED_IN, SIGNED_OUT
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.times import moment_text
from coursework.site.people import guessing, passwords

DAYS = 21  #: for which an invitation is valid
_HAPPENED = 20  #: audit lines shown on the account page


def as_login(text: str) -> str:
    """Return the normalised form of a login, without surrounding spaces and capitals."""
    return " ".join(text.split()).casefold()[:320]


# ----------------------------------------------------------------------- sign in


def sign_in(request: Request) -> Response:
    """Sign in with a login and a password; the response does not tell which of the two is wrong."""
    if request.site.entrance is not Entrance.ACCOUNTS:
        return _without_account(request)
    after = local(request.form.text("after") or request.query_params.get("after", ""))
    if not request.is_post:
        return redirect(after) if request.person else _sign_in_page(request, after)
    login, password = as_login(request.form.text("login")), request.form.text("password")
    with request.site.store.reading() as connection:
        match = account_by_login(connection, login)
    if not passwords.fits(match.secret if match else "", password) or match is None:
        waits = guessing.missed(request, login)
        return _sign_in_page(request, after, login=request.form.text("login"), missed=True, waits=waits)
    guessing.fitted(request, login)
    if passwords.is_dated(match.secret):
        with request.site.store.begin() as connection:
            set_secret(connection, match.id, passwords.hashed(password))
    device = Devices(request.site.secret).after_sign_in(request.device, login)
    return signed_in(request, after, match.person_id, device)


def sign_in_attempt(request: Request) -> Attempt:
    """Return the attempt counted for a form of the sign-in page."""
    if request.site.entrance is not Entrance.ACCOUNTS:
        return Attempt()
    return guessing.attempt_of(request, as_login(request.form.text("login")))


def signed_in(request: Request, address: str, person: int, device: str = "") -> Response:
    """End the browser's session and begin one of a person, or an anonymous one for person 0; return the
    redirect to an address. ``device`` is the new device cookie."""
    before = request.person.id if request.person else 0
    request.events.append((SIGNED_IN if person else SIGNED_OUT, person or before))
    token, seconds, request.is_new = request.site.cookies.anonymous().token, ANONYMOUS_SECONDS, False
    if person or request.browser.id:
        with request.site.store.begin() as connection:
            if before:
                end_session(connection, request.browser.id, before)
            if person:
                browser = described(request.headers.get("user-agent", ""))
                token = begin_session(connection, person, browser, datetime.now(UTC))
                seconds = int(LONGEST.total_seconds())
    response = redirect(address)
    set_cookie(request, response, COOKIE, token, seconds)
    if device:
        set_cookie(request, response, DEVICE, device, DEVICE_SECONDS)
    return response


def _without_account(request: Request) -> Response:
    if request.site.entrance is Entrance.DEMO:
        return redirect("/who")
    return redirect("/")  # on a local site the user is always signed in


def _sign_in_page(
    request: Request, after: str, login: str = "", missed: bool = False, waits: int = 0
) -> Response:
    names = {"after": after, "login": login, "missed": missed, "waits": waits}
    return request.render("site/sign_in", 401 if missed else 200, **names)


#: Parts of the header ``User-Agent``, the most specific first, since many browsers also name others.
_PROGRAMS = (
    ("Edg", "Edge"),
    ("OPR/", "Opera"),
    ("SamsungBrowser", "Samsung Internet"),
    ("FxiOS", "Firefox"),
    ("Firefox/", "Firefox"),
    ("CriOS", "Chrome"),
    ("Chrome/", "Chrome"),
    ("Safari/", "Safari"),
)
_SYSTEMS = (
    ("iPhone", "iPhone"),
    ("iPad", "iPad"),
    ("Android", "Android"),
    ("CrOS", "ChromeOS"),
    ("Windows", "Windows"),
    ("Mac OS X", "macOS"),
    ("Linux", "Linux"),
)


def described(user_agent: str) -> str:
    """Return a description such as ``Firefox, Linux`` from the header of a browser; empty for an unusual
    one."""
    names = (
        next((name for piece, name in table if piece in user_agent[:500]), "")
        for table in (_PROGRAMS, _SYSTEMS)
    )
    return ", ".join(filter(None, names))


def sign_out(request: Request) -> Response:
    """Sign out, by a form only, so that no link of another page signs anybody out."""
    return signed_in(request, "/", 0) if request.is_post else redirect("/")


# ------------------------------------------------------------------- invitations


def invited(site: Site, connection: Connection, person: int, login: str, role: str) -> str:
    """Invite a person; return the address at which they choose a password. The address itself is not stored.

    Raises
    ------
    BadInput
        Another person has this login.
    """
    end = secrets.token_urlsafe(24)
    now = site.clock()
    invite(connection, person, login, role, digest_of(end), now + timedelta(days=DAYS), now)
    return f"{site.url}/invitation/{end}"


def invitation(request: Request) -> Response:
    """Accept an invitation, with the choice of a password: once, and before it expires."""
    end = digest_of(str(request.path_params["token"]))
    with request.site.store.reading() as connection:
        mine = account_invited(connection, end, request.received_at)
    if mine is None:
        raise HTTPException("invitation", 410)
    if not request.is_post:
        return _invitation_page(request, mine)
    secret, wrong = _chosen(request, mine)
    if wrong:
        return _invitation_page(request, mine, 422, wrong=wrong)
    with request.site.store.begin() as connection:
        person = accept_invitation(connection, end, secret, request.received_at)
        if person is None:
            raise HTTPException("invitation", 410)
        end_sessions(connection, person)
        by = Actor(mine.name, person, request.client_address)
        note(connection, request.received_at, by, "invitation taken up", person=person)
    device = Devices(request.site.secret).after_sign_in(request.device, mine.login)
    return signed_in(request, "/", person, device)


def _invitation_page(request: Request, mine: Any, status: int = 200, **names: Any) -> Response:
    return request.render("site/invitation", status, mine=mine, shortest=passwords.SHORTEST, **names)


def _chosen(request: Request, mine: Any) -> tuple[str, str]:
    """Return the hash of the chosen password, or the reason for which it is refused."""
    password, again = request.form.text("password"), request.form.text("again")
    wrong = passwords.weakness(password, mine.login, mine.name) or ("again" if password != again else "")
    return ("", wrong) if wrong else (passwords.hashed(password), "")


# ---------------------------------------------------------------------- account


def account(request: Request) -> Response:
    """Return the account page of the current user: the password, and the sessions, to end one or all."""
    with request.site.store.reading() as connection:
        mine = account_of(connection, request.user.id)
    if not request.is_post:
        return _account_page(request, mine)
    if request.form.text("do") == "everywhere":
        with request.site.store.begin() as connection:
            end_sessions(connection, request.user.id)
            end_launch_sessions(connection, request.user.id)
        return signed_in(request, "/", 0)
    if "session" in request.form.texts:
        return _end_chosen_session(request)
    return _other_password(request, mine)


def account_attempt(request: Request) -> Attempt:
    """Return the attempt counted for a form with the current password."""
    return own_attempt(request) if "now" in request.form.texts else Attempt()


def own_attempt(request: Request) -> Attempt:
    """Return the attempt counted for a person's own password."""
    with request.site.store.reading() as connection:
        mine = account_of(connection, request.user.id)
    return guessing.attempt_of(request, mine.login) if mine is not None else Attempt()


def _end_chosen_session(request: Request) -> Response:
    """End one session of the current user; if it is the current one, sign out."""
    number = request.form.text("session")
    if not (number.isascii() and number.isdecimal() and len(number) < 10):
        raise HTTPException("bad_request", 422)
    if int(number) == request.browser.id:
        return signed_in(request, "/", 0)
    with request.site.store.begin() as connection:
        end_session(connection, int(number), request.user.id)  # it may have ended meanwhile
    return redirect("/account")


def _account_page(request: Request, mine: Any, status: int = 200, **names: Any) -> Response:
    if request.query_params.get("changed") and status == 200:
        names["changed"] = True
    has_password = bool(mine and mine.secret) and request.site.entrance is Entrance.ACCOUNTS
    with request.site.store.reading() as connection:
        sessions = sessions_of(connection, request.user.id, datetime.now(UTC))
        happened = noted(connection, _HAPPENED, what=OF_ACCOUNTS, subject=request.user.id)
    rows = [
        (session, moment_text(session.seen, request.lang), moment_text(session.created, request.lang))
        for session in sessions
    ]
    return request.render(
        "site/account",
        status,
        mine=mine,
        has_password=has_password,
        sessions=rows,
        shortest=passwords.SHORTEST,
        happened=happened,
        **names,
    )


def _other_password(request: Request, mine: Any) -> Response:
    if mine is None or not mine.secret:
        raise HTTPException("page", 404)
    if not passwords.fits(mine.secret, request.form.text("now")):
        guessing.missed(request, mine.login)
        return _account_page(request, mine, 422, wrong="now")
    secret, wrong = _chosen(request, mine)
    if wrong:
        return _account_page(request, mine, 422, wrong=wrong)
    with request.site.store.begin() as connection:
        set_secret(connection, mine.id, secret)
        end_sessions(connection, request.user.id)
        request.note(connection, "password changed", person=request.user.id)
    return signed_in(request, "/account?changed=1", request.user.id)


# ----------------------------------------------------------------- by command


def invited_by_command(site: Site, login: str, role: str) -> str:
    """Invite a member of staff from the command line.

    Parameters
    ----------
    login
        Login of an existing account, or of a new person.
    role
        ``administrator`` or ``instructor``. The first instructor of a site is its administrator, and nobody's
        role is lowered.

    Returns
    -------
    str
        The address at which they choose a password.

    Raises
    ------
    BadInput
        The login is empty.
    """
    normalised = as_login(login)
    if not normalised:
        raise BadInput("--{role} needs a login, such as an e-mail: --{role} ada@example.org", role=role)
    with site.store.begin() as connection:
        existing = account_by_login(connection, normalised)
        person = existing.person_id if existing else put_person(connection, normalised, login.strip(), "", {})
        given = _raised(
            existing.role if existing else "", role, is_first=not has_administrator(connection, site.clock())
        )
        if existing:
            set_role(connection, person, given)
        address = invited(site, connection, person, normalised, given)
        note(connection, site.clock(), "command line", "invited", person=person, role=given)
    return address


def _raised(before: str, role: str, *, is_first: bool) -> str:
    """Return the new role of a person, never below the present one."""
    return ADMINISTRATOR if is_first or ADMINISTRATOR in (before, role) else role


def check_administrator(site: Site) -> None:
    """Check that an administrator can sign in.

    Raises
    ------
    BadInput
        The site needs accounts, and no administrator has one.
    """
    with site.store.reading() as connection:
        if site.entrance is not Entrance.ACCOUNTS or has_administrator(connection, site.clock()):
            return
    raise BadInput(
        "other machines can reach this site, and no administrator has an account: "
        "'coursework serve --administrator LOGIN' with the same --db and --url prints a link by which "
        "one chooses a password"
    )


ROUTES = (
    Route(
        "/sign-in",
        sign_in,
        Permission.PUBLIC,
        takes_forms=True,
        limit="sign_in",
        budget=PLAIN,
        attempt=sign_in_attempt,
    ),
    Route("/sign-out", sign_out, Permission.OWN, takes_forms=True, budget=PLAIN),
    Route(
        "/invitation/{token}", invitation, Permission.PUBLIC, takes_forms=True, limit="sign_in", budget=PLAIN
    ),
    Route(
        "/account",
        account,
        Permission.OWN,
        takes_forms=True,
        limit="sign_in",
        budget=PLAIN,
        attempt=account_attempt,
    ),
)
