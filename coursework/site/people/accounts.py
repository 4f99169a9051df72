"""Coming in and going: sign in, invitations, and one's own account."""

from __future__ import annotations

import hashlib
import secrets
from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import Connection

from coursework.database.accounts import (
    INSTRUCTOR,
    account_by_login,
    account_invited,
    account_of,
    end_sessions,
    has_instructor,
    invite,
    set_role,
    set_secret,
    take_up,
)
from coursework.database.audit import note
from coursework.database.people import put_person
from coursework.errors import BadInput
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.visits import Page, Refused, Reply, Visit, Who, local
from coursework.site.people import home, passwords

DAYS = 21  #: that an invitation holds


def as_login(text: str) -> str:
    """A login as it is kept: spaces around it and capitals do not count."""
    return " ".join(text.split()).casefold()[:320]


# ----------------------------------------------------------------------- sign in


def sign_in(visit: Visit) -> Reply:
    """A login and its password; nobody learns which of the two did not fit."""
    if visit.site.entrance is not Entrance.ACCOUNTS:
        return _without_account(visit)
    after = local(visit.form.text("after") or visit.query.get("after", ""))
    if not visit.posted:
        return Reply(goto=after) if visit.person else _sign_in_page(visit, after)
    login, password = as_login(visit.form.text("login")), visit.form.text("password")
    wait = visit.site.limits.barred(login, visit.came_from)
    if wait:
        raise Refused("too_often", 429, wait)
    with visit.site.store.reading() as connection:
        found = account_by_login(connection, login)
    if not passwords.fits(found.secret if found else "", password) or found is None:
        visit.site.limits.missed(login, visit.came_from)
        return _sign_in_page(visit, after, login=visit.form.text("login"), missed=True)
    visit.site.limits.fitted(login, visit.came_from)
    if passwords.is_dated(found.secret):
        with visit.site.store.begin() as connection:
            set_secret(connection, found.id, passwords.kept(password))
    return Reply(goto=after, signed_in=found.person_id)


def _without_account(visit: Visit) -> Reply:
    if visit.site.entrance is Entrance.DEMO:
        return Reply(goto="/who")
    return Reply(goto="/", signed_in=home.owner(visit.site))


def _sign_in_page(visit: Visit, after: str, login: str = "", missed: bool = False) -> Reply:
    return visit.page("site_sign_in", 401 if missed else 200, after=after, login=login, missed=missed)


def sign_out(visit: Visit) -> Reply:
    """By a form alone: no link of another page signs anybody out."""
    return Reply(goto="/", signed_in=0) if visit.posted else Reply(goto="/")


# ------------------------------------------------------------------- invitations


def invited(site: Site, connection: Connection, person: int, login: str, role: str) -> str:
    """Invite a person; gives the address at which they choose a password, which is kept nowhere.

    Raises
    ------
    BadInput
        Another person has this login.
    """
    end = secrets.token_urlsafe(24)
    now = site.clock()
    invite(connection, person, login, role, digest_of(end), now + timedelta(days=DAYS), now)
    return f"{site.url}/invitation/{end}"


def digest_of(end: str) -> str:
    """What is kept of an invitation's address."""
    return hashlib.sha256(end.encode()).hexdigest()


def invitation(visit: Visit) -> Reply:
    """A password is chosen: once, and before the invitation is over."""
    end = digest_of(str(visit.path["token"]))
    with visit.site.store.reading() as connection:
        found = account_invited(connection, end, visit.at)
    if found is None:
        raise Refused("invitation", 410)
    if not visit.posted:
        return _invitation_page(visit, found)
    secret, wrong = _chosen(visit, found)
    if wrong:
        return _invitation_page(visit, found, 422, wrong=wrong)
    with visit.site.store.begin() as connection:
        person = take_up(connection, end, secret, visit.at)
        if person is None:
            raise Refused("invitation", 410)
        end_sessions(connection, person, datetime.now(UTC))
        note(connection, visit.at, f"person {person}", "invitation taken up", person=person)
    return Reply(goto="/", signed_in=person)


def _invitation_page(visit: Visit, mine: Any, status: int = 200, **told: Any) -> Reply:
    return visit.page("site_invitation", status, mine=mine, shortest=passwords.SHORTEST, **told)


def _chosen(visit: Visit, mine: Any) -> tuple[str, str]:
    """What is kept of the password that is chosen, or else why it will not do."""
    password, again = visit.form.text("password"), visit.form.text("again")
    wrong = passwords.weakness(password, mine.login, mine.name) or ("again" if password != again else "")
    return ("", wrong) if wrong else (passwords.kept(password), "")


# ---------------------------------------------------------------------- account


def account(visit: Visit) -> Reply:
    """What one can change of one's own: the password, and where one is signed in."""
    with visit.site.store.reading() as connection:
        mine = account_of(connection, visit.who.id)
    if not visit.posted:
        return _account_page(visit, mine)
    if visit.form.text("do") == "everywhere":
        _end_sessions(visit)
        return Reply(goto="/", signed_in=0)
    return _other_password(visit, mine)


def _account_page(visit: Visit, mine: Any, status: int = 200, **told: Any) -> Reply:
    if visit.query.get("changed") and status == 200:
        told["changed"] = True
    has_password = bool(mine and mine.secret) and visit.site.entrance is Entrance.ACCOUNTS
    return visit.page(
        "site_account", status, mine=mine, has_password=has_password, shortest=passwords.SHORTEST, **told
    )


def _other_password(visit: Visit, mine: Any) -> Reply:
    if mine is None or not mine.secret:
        raise Refused("page", 404)
    if visit.site.limits.barred(mine.login, visit.came_from):
        raise Refused("too_often", 429, visit.site.limits.barred(mine.login, visit.came_from))
    if not passwords.fits(mine.secret, visit.form.text("now")):
        visit.site.limits.missed(mine.login, visit.came_from)
        return _account_page(visit, mine, 422, wrong="now")
    secret, wrong = _chosen(visit, mine)
    if wrong:
        return _account_page(visit, mine, 422, wrong=wrong)
    with visit.site.store.begin() as connection:
        set_secret(connection, mine.id, secret)
    _end_sessions(visit)
    return Reply(goto="/account?changed=1", signed_in=visit.who.id)


def _end_sessions(visit: Visit) -> None:
    with visit.site.store.begin() as connection:
        end_sessions(connection, visit.who.id, datetime.now(UTC))


# ------------------------------------------------------------- the first instructor


def first_instructor(site: Site, login: str) -> str:
    """Invite an instructor from the command line; gives the address at which they choose a password.

    Raises
    ------
    BadInput
        The login is empty.
    """
    told = as_login(login)
    if not told:
        raise BadInput("--instructor needs a login, such as an e-mail: --instructor ada@example.org")
    with site.store.begin() as connection:
        found = account_by_login(connection, told)
        person = found.person_id if found else put_person(connection, told, login.strip(), "", {})
        address = invited(site, connection, person, told, INSTRUCTOR)
        set_role(connection, person, INSTRUCTOR)
        note(connection, site.clock(), "command line", "invited", person=person, role=INSTRUCTOR)
    return address


def check_instructor(site: Site) -> None:
    """See to it that somebody can come in to teach.

    Raises
    ------
    BadInput
        The site needs accounts, and no instructor has one.
    """
    with site.store.reading() as connection:
        if site.entrance is not Entrance.ACCOUNTS or has_instructor(connection, site.clock()):
            return
    raise BadInput(
        "other machines can reach this site, and no instructor has an account: "
        "'coursework serve --instructor LOGIN' with the same --db and --url prints a link by which one chooses a password"
    )


PAGES = (
    Page("/sign-in", sign_in, Who.NOBODY, posts=True, limit="sign_in"),
    Page("/sign-out", sign_out, Who.SOMEBODY, posts=True),
    Page("/invitation/{token}", invitation, Who.NOBODY, posts=True, limit="sign_in"),
    Page("/account", account, Who.SOMEBODY, posts=True, limit="sign_in"),
)
