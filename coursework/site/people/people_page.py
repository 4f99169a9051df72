"""The desk's page of people: who is on the site, who may teach, and the invitations by which they come in."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from sqlalchemy import Connection

from coursework.database.accounts import (
    INSTRUCTOR,
    ROLES,
    STUDENT,
    account_by_login,
    accounts,
    is_last_instructor,
    set_role,
)
from coursework.database.audit import note
from coursework.database.people import people, person_by_id, put_person
from coursework.making.identity import EMAIL, LOGIN, plain
from coursework.making.roster import Student, read_roster
from coursework.site.frame.visits import Page, Refused, Reply, Upload, Visit, Who
from coursework.site.people.accounts import DAYS, as_login, invited
from coursework.system.tables import csv_file

_FILES = 4 * 1024 * 1024


class Line(NamedTuple):
    """A person of the table."""

    id: int
    name: str
    login: str  #: of the account; what it would be where there is none
    role: str
    state: str  #: joined, invited, over (an invitation that nobody took up), none
    has_account: bool = False


class Link(NamedTuple):
    """An invitation that was made just now."""

    name: str
    login: str
    address: str


# ------------------------------------------------------------------------- table


def everybody(visit: Visit) -> Reply:
    """Who is on the site; forms of the page invite some of them."""
    if visit.posted:
        return _invite(visit)
    with visit.site.store.reading() as connection:
        lines = _lines(visit, connection)
    return visit.page("site_people", lines=lines, added=_count(visit.query.get("added", "")))


def _lines(visit: Visit, connection: Connection) -> list[Line]:
    mine = accounts(connection)
    return [
        _line(visit, one, mine.get(one.id)) for one in {one.id: one for one in people(connection)}.values()
    ]


def _line(visit: Visit, one: Any, account: Any) -> Line:
    if account is None:
        return Line(one.id, one.name, login_of(one), STUDENT, "none")
    waits = account.invited_until is not None
    state = "joined" if account.secret else "none" if not waits else "invited"
    if state == "invited" and account.invited_until < visit.at:
        state = "over"
    return Line(one.id, one.name, account.login, account.role, state, True)


def login_of(person: Any) -> str:
    """What somebody of a roster signs in with: their e-mail, else their login, else what tells them apart."""
    told = {plain(title): str(value) for title, value in (person.columns or {}).items() if value}
    found = next((told[title] for title in (*EMAIL, *LOGIN) if title in told), "")
    return as_login(found or person.who)


def _invite(visit: Visit) -> Reply:
    wanted = set(visit.form.texts.get("person", ()))
    with visit.site.store.begin() as connection:
        lines = _lines(visit, connection)
        if visit.form.text("do").startswith("all"):
            wanted = {str(one.id) for one in lines if one.state in ("none", "over")}
        links = [_link(visit, connection, one) for one in lines if str(one.id) in wanted]
        note(
            connection,
            visit.at,
            visit.who.name,
            "invited",
            people=[o.id for o in lines if str(o.id) in wanted],
        )
    if visit.form.text("do").endswith("file"):
        return Reply(kind="text/csv; charset=utf-8", data=_as_csv(links), file="invitations.csv")
    return visit.page("site_links", links=links, days=DAYS)


def _link(visit: Visit, connection: Connection, one: Line) -> Link:
    _check_login(connection, one.login, one.id)
    return Link(one.name, one.login, invited(visit.site, connection, one.id, one.login, one.role))


def _check_login(connection: Connection, login: str, person: int) -> None:
    taken = account_by_login(connection, login)
    if taken is not None and taken.person_id != person:
        raise Refused("login_taken", 409, login)


def _as_csv(links: Sequence[Link]) -> bytes:
    columns = ("student", "login", "invitation")
    return csv_file((dict(zip(columns, link, strict=True)) for link in links), columns)


# --------------------------------------------------------------------- new people


def add(visit: Visit) -> Reply:
    """The people of a roster, or one person by name and login."""
    uploads = visit.form.files.get("roster", ())
    students = _of_roster(uploads[0]) if uploads else _of_fields(visit)
    role = INSTRUCTOR if visit.form.text("role") == INSTRUCTOR and not uploads else STUDENT
    with visit.site.store.begin() as connection:
        before = {one.id for one in people(connection)}
        ids = [put_person(connection, s.who, s.name, s.lang, s.columns) for s in students]
        note(connection, visit.at, visit.who.name, "people added", people=sorted(set(ids) - before))
        if role == INSTRUCTOR:
            return _first_link(visit, connection, ids[0])
    return Reply(goto=f"/desk/people?added={len(set(ids) - before)}")


def _of_roster(upload: Upload) -> list[Student]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "roster.csv"
        path.write_bytes(upload.data)
        return read_roster(path)


def _of_fields(visit: Visit) -> list[Student]:
    name, login = " ".join(visit.form.text("name").split())[:200], as_login(visit.form.text("login"))
    if not name or not login:
        raise Refused("bad_request", 422)
    return [Student(name, "", {"email" if "@" in login else "login": login})]


def _first_link(visit: Visit, connection: Connection, person: int) -> Reply:
    """The invitation of a new instructor, at once."""
    one = person_by_id(connection, person)
    line = Line(person, one.name, login_of(one), INSTRUCTOR, "none") if one else None
    if line is None:
        raise Refused("own", 404)
    link = _link(visit, connection, line)
    set_role(connection, person, INSTRUCTOR)
    return visit.page("site_links", links=[link], days=DAYS)


# ------------------------------------------------------------------------ a person


def one_person(visit: Visit) -> Reply:
    """What the staff may do for somebody: invite them again, say what they may, give and erase what is kept of them."""
    with visit.site.store.reading() as connection:
        one = somebody(visit, connection)
        line = _line(visit, one, accounts(connection).get(one.id))
        last = is_last_instructor(connection, one.id)
    if not visit.posted:
        return visit.page("site_person", line=line, last=last, columns=one.columns or {}, roles=ROLES)
    with visit.site.store.begin() as connection:
        if visit.form.text("do") == "invite":
            link = _link(visit, connection, line)
            note(connection, visit.at, visit.who.name, "invited", people=[line.id])
            return visit.page("site_links", links=[link], days=DAYS)
        _other_role(visit, connection, line)
    return Reply(goto=f"/desk/people/{line.id}")


def _other_role(visit: Visit, connection: Connection, line: Line) -> None:
    role = visit.form.text("role")
    if role not in ROLES or not line.has_account:
        raise Refused("bad_request", 422)
    if role != INSTRUCTOR and is_last_instructor(connection, line.id):
        raise Refused("last_instructor", 409)
    set_role(connection, line.id, role)
    note(connection, visit.at, visit.who.name, "role", person=line.id, role=role)


def somebody(visit: Visit, connection: Connection) -> Any:
    """The person whom the address names.

    Raises
    ------
    Refused
        There is none.
    """
    found = person_by_id(connection, number(str(visit.path["person"])))
    if found is None:
        raise Refused("own", 404)
    return found


def number(text: str) -> int:
    """A number of an address; 0, which is nobody's, for anything else."""
    return int(text) if text.isascii() and text.isdecimal() and len(text) < 10 else 0


def _count(text: str) -> int | None:
    return number(text) if text else None


PAGES = (
    Page("/desk/people", everybody, Who.STAFF, posts=True),
    Page("/desk/people/add", add, Who.STAFF, posts=True, limit="upload", largest=_FILES),
    Page("/desk/people/{person}", one_person, Who.STAFF, posts=True),
)
