"""Coming in and going: sign in, invitations, and one's own account."""

from __future__ import annotations

import hashlib
import secrets
from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import Connection

from coursework.database.accounts import (
    account_by_login,
    account_invited,
    account_of,
    has_administrator,
    invite,
    set_role,
    set_secret,
    take_up,
)
from coursework.database.audit import OF_ACCOUNTS, Actor, note, noted
from coursework.database.identities import known_as
from coursework.database.people import put_person
from coursework.database.permissions import ADMINISTRATOR, Permission
from coursework.database.sessions import end_session, end_sessions, sessions_of
from coursework.errors import BadInput
from coursework.lti.storage import Storage
from coursework.site.frame.attempts import Attempt
from coursework.site.frame.budgets import PLAIN
from coursework.site.frame.devices import Devices
from coursework.site.frame.moments import moment_text
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.visits import Page, Refused, Reply, Visit, local
from coursework.site.people import guessing, passwords

DAYS = 21  #: that an invitation holds
_HAPPENED = 20  #: lines on what was done with an account


def as_login(text: str) -> str:
    """Return the normalised form of a login, without surrounding spaces and capitals."""
    return " ".join(text.split()).casefold()[:320]


# ----------------------------------------------------------------------- sign in


def sign_in(visit: Visit) -> Reply:
    """Sign in with a login and a password; the response does not tell which of the two is wrong."""
    if visit.site.entrance is not Entrance.ACCOUNTS:
        return _without_account(visit)
    after = local(visit.form.text("after") or visit.query.get("after", ""))
    if not visit.posted:
        return Reply(goto=after) if visit.person else _sign_in_page(visit, after)
    login, password = as_login(visit.form.text("login")), visit.form.text("password")
    with visit.site.store.reading() as connection:
        found = account_by_login(connection, login)
    if not passwords.fits(found.secret if found else "", password) or found is None:
        waits = guessing.missed(visit, login)
        return _sign_in_page(visit, after, login=visit.form.text("login"), missed=True, waits=waits)
    guessing.fitted(visit, login)
    if passwords.is_dated(found.secret):
        with visit.site.store.begin() as connection:
            set_secret(connection, found.id, passwords.kept(password))
    device = Devices(visit.site.secret).after_sign_in(visit.device, login)
    return Reply(goto=after, signed_in=found.person_id, device=device)


def sign_in_attempt(visit: Visit) -> Attempt:
    """Return what a form of the sign-in page is counted by."""
    if visit.site.entrance is not Entrance.ACCOUNTS:
        return Attempt()
    return guessing.attempt_of(visit, as_login(visit.form.text("login")))


def _without_account(visit: Visit) -> Reply:
    if visit.site.entrance is Entrance.DEMO:
        return Reply(goto="/who")
    return Reply(goto="/")  # on one's own machine everybody is signed in


def _sign_in_page(visit: Visit, after: str, login: str = "", missed: bool = False, waits: int = 0) -> Reply:
    told = {"after": after, "login": login, "missed": missed, "waits": waits}
    return visit.page("site_sign_in", 401 if missed else 200, **told)


def sign_out(visit: Visit) -> Reply:
    """By a form alone: no link of another page signs anybody out."""
    return Reply(goto="/", signed_in=0) if visit.posted else Reply(goto="/")


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


def digest_of(end: str) -> str:
    """Return the stored digest of an invitation's address."""
    return hashlib.sha256(end.encode()).hexdigest()


def invitation(visit: Visit) -> Reply:
    """Accept an invitation, with the choice of a password: once, and before it expires."""
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
        end_sessions(connection, person)
        by = Actor(found.name, person, visit.came_from)
        note(connection, visit.at, by, "invitation taken up", person=person)
    device = Devices(visit.site.secret).after_sign_in(visit.device, found.login)
    return Reply(goto="/", signed_in=person, device=device)


def _invitation_page(visit: Visit, mine: Any, status: int = 200, **told: Any) -> Reply:
    return visit.page("site_invitation", status, mine=mine, shortest=passwords.SHORTEST, **told)


def _chosen(visit: Visit, mine: Any) -> tuple[str, str]:
    """Return the hash of the chosen password, or the reason for which it is refused."""
    password, again = visit.form.text("password"), visit.form.text("again")
    wrong = passwords.weakness(password, mine.login, mine.name) or ("again" if password != again else "")
    return ("", wrong) if wrong else (passwords.kept(password), "")


# ---------------------------------------------------------------------- account


def account(visit: Visit) -> Reply:
    """Answer the page of one's own account: the password, and the sessions, which can be ended each and all."""
    with visit.site.store.reading() as connection:
        mine = account_of(connection, visit.who.id)
    if not visit.posted:
        return _account_page(visit, mine)
    if visit.form.text("do") == "everywhere":
        with visit.site.store.begin() as connection:
            end_sessions(connection, visit.who.id)
            called = known_as(connection, visit.who.id)
        if visit.site.lti is not None:
            for issuer, subject in called:
                Storage(visit.site.lti).end_sessions(subject, issuer)
        return Reply(goto="/", signed_in=0)
    if "session" in visit.form.texts:
        return _end_one(visit)
    return _other_password(visit, mine)


def account_attempt(visit: Visit) -> Attempt:
    """Return what a form with the present password is counted by."""
    if "now" not in visit.form.texts:
        return Attempt()
    with visit.site.store.reading() as connection:
        mine = account_of(connection, visit.who.id)
    return guessing.attempt_of(visit, mine.login) if mine is not None else Attempt()


def _end_one(visit: Visit) -> Reply:
    """End one of one's own sessions; the present one is signed out."""
    number = visit.form.text("session")
    if not (number.isascii() and number.isdecimal() and len(number) < 10):
        raise Refused("bad_request", 422)
    if int(number) == visit.session:
        return Reply(goto="/", signed_in=0)
    with visit.site.store.begin() as connection:
        end_session(
            connection, int(number), visit.who.id
        )  # one that ended meanwhile is as the person wants it
    return Reply(goto="/account")


def _account_page(visit: Visit, mine: Any, status: int = 200, **told: Any) -> Reply:
    if visit.query.get("changed") and status == 200:
        told["changed"] = True
    has_password = bool(mine and mine.secret) and visit.site.entrance is Entrance.ACCOUNTS
    with visit.site.store.reading() as connection:
        sessions = sessions_of(connection, visit.who.id, datetime.now(UTC))
        happened = noted(connection, _HAPPENED, what=OF_ACCOUNTS, subject=visit.who.id)
    shown = [
        (one, moment_text(one.seen, visit.lang), moment_text(one.created, visit.lang)) for one in sessions
    ]
    return visit.page(
        "site_account", status, mine=mine, has_password=has_password, sessions=shown, shortest=passwords.SHORTEST,
        happened=happened, **told,
    )  # fmt: skip


def _other_password(visit: Visit, mine: Any) -> Reply:
    if mine is None or not mine.secret:
        raise Refused("page", 404)
    if not passwords.fits(mine.secret, visit.form.text("now")):
        guessing.missed(visit, mine.login)
        return _account_page(visit, mine, 422, wrong="now")
    secret, wrong = _chosen(visit, mine)
    if wrong:
        return _account_page(visit, mine, 422, wrong=wrong)
    with visit.site.store.begin() as connection:
        set_secret(connection, mine.id, secret)
        end_sessions(connection, visit.who.id)
        note(connection, visit.at, visit.actor, "password changed", person=visit.who.id)
    return Reply(goto="/account?changed=1", signed_in=visit.who.id)


# ----------------------------------------------------------------- by command


def invited_by_command(site: Site, login: str, role: str) -> str:
    """Invite somebody to the staff from the command line.

    Parameters
    ----------
    login
        What they sign in with; of somebody who has an account, or somebody new.
    role
        ``administrator`` or ``instructor``. The first instructor of a site is its administrator, and nobody's role is lowered.

    Returns
    -------
    str
        The address at which they choose a password.

    Raises
    ------
    BadInput
        The login is empty.
    """
    told = as_login(login)
    if not told:
        raise BadInput(f"--{role} needs a login, such as an e-mail: --{role} ada@example.org")
    with site.store.begin() as connection:
        found = account_by_login(connection, told)
        person = found.person_id if found else put_person(connection, told, login.strip(), "", {})
        given = _raised(
            found.role if found else "", role, is_first=not has_administrator(connection, site.clock())
        )
        if found:
            set_role(connection, person, given)
        address = invited(site, connection, person, told, given)
        note(connection, site.clock(), "command line", "invited", person=person, role=given)
    return address


def _raised(before: str, role: str, *, is_first: bool) -> str:
    """Return the role that somebody has from now on."""
    return ADMINISTRATOR if is_first or ADMINISTRATOR in (before, role) else role


def check_administrator(site: Site) -> None:
    """See to it that somebody can come in to administer.

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
        "'coursework serve --administrator LOGIN' with the same --db and --url prints a link by which one chooses a password"
    )


PAGES = (
    Page(
        "/sign-in",
        sign_in,
        Permission.PUBLIC,
        posts=True,
        limit="sign_in",
        budget=PLAIN,
        attempt=sign_in_attempt,
    ),
    Page("/sign-out", sign_out, Permission.OWN, posts=True, budget=PLAIN),
    Page("/invitation/{token}", invitation, Permission.PUBLIC, posts=True, limit="sign_in", budget=PLAIN),
    Page(
        "/account",
        account,
        Permission.OWN,
        posts=True,
        limit="sign_in",
        budget=PLAIN,
        attempt=account_attempt,
    ),
)
