"""Instructor's page of people: the people of the site, their permissions, and their invitations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from sqlalchemy import Connection
from starlette.responses import Response

from coursework.database.accounts import account_by_login, accounts, is_last_administrator, set_role
from coursework.database.areas import areas_of, groups_known, put_areas
from coursework.database.audit import noted
from coursework.database.identities import links_of, unlink_identity
from coursework.database.instructor_queries import listed_assignments
from coursework.database.people import people, person_by_id, person_by_identifier, put_person
from coursework.database.permissions import ASSISTANT, ROLES, STAFF, STUDENT, Area, Permission, may, to_invite
from coursework.issuing.identity import EMAIL, LOGIN, plain
from coursework.issuing.roster import Student
from coursework.platforms.lti.storage import drop_launches
from coursework.site.frame.budgets import DESK_FILE
from coursework.site.frame.paging import page_of
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import Download, redirect
from coursework.site.people.accounts import DAYS, as_login, invited
from coursework.site.people.extra_time import extra_time_text
from coursework.site.publication.new_assignment import uploaded_roster
from coursework.system.tables import csv_file

_ANY = "*"  #: value of a form for every assignment or the whole class


class PersonRow(NamedTuple):
    """Person in the table."""

    id: int
    name: str
    login: str  #: login of the account, or the one that it would have
    role: str
    state: str  #: joined, invited, over (an expired invitation), none
    has_account: bool = False
    extra_time: str = ""  #: share of extra time, as text


class InvitationLink(NamedTuple):
    """New invitation."""

    name: str
    login: str
    address: str


# ------------------------------------------------------------------------- table


def everybody(request: Request) -> Response:
    """Return the people of the site; forms of the page invite some of them."""
    if request.is_post:
        return _invite(request)
    with request.site.store.reading() as connection:
        lines = _lines(request, connection)
        groups, assignments = groups_known(connection), _titled_assignments(request, connection)
    page = page_of(request, lines, lambda line: f"{line.name} {line.login}")
    may_invite = {role: may(request.user, to_invite(role)) for role in ROLES}
    return request.render(
        "site/instructor/people",
        page=page,
        lines=page.rows,
        added=_count(request.query_params.get("added", "")),
        may_invite=may_invite,
        staff_roles=_staff_roles(request),
        any=_ANY,
        areas=(),
        groups=groups,
        assignments=assignments,
        left=bool(request.query_params.get("left")),
    )


def _staff_roles(request: Request) -> list[str]:
    """Return the roles that new staff can be given."""
    return (
        [role for role in ROLES if role in STAFF] if request.user.may(Permission.PEOPLE_INVITE_STAFF) else []
    )


def _lines(request: Request, connection: Connection) -> list[PersonRow]:
    mine = accounts(connection)
    return [
        _line(request, person, mine.get(person.id))
        for person in {person.id: person for person in people(connection)}.values()
    ]


def _line(request: Request, person: Any, account: Any) -> PersonRow:
    extra_time = extra_time_text(person.extra_time, request.lang)
    if account is None:
        return PersonRow(person.id, person.name, login_of(person), STUDENT, "none", extra_time=extra_time)
    waits = account.invited_until is not None
    state = "joined" if account.secret else "none" if not waits else "invited"
    if state == "invited" and account.invited_until < request.received_at:
        state = "over"
    return PersonRow(person.id, person.name, account.login, account.role, state, True, extra_time)


def login_of(person: Any) -> str:
    """Return the login of a person from a roster: the e-mail address, or else the login, or else the
    identifier."""
    values = {plain(title): str(value) for title, value in (person.columns or {}).items() if value}
    login = next((values[title] for title in (*EMAIL, *LOGIN) if title in values), "")
    return as_login(login or person.who)


def _invite(request: Request) -> Response:
    wanted = set(request.form.texts.get("person", ()))
    with request.site.store.begin() as connection:
        lines = _lines(request, connection)
        if request.form.text("do").startswith("all"):
            wanted = {
                str(row.id)
                for row in lines
                if row.state in ("none", "over") and may(request.user, to_invite(row.role))
            }
        links = [_link(request, connection, row) for row in lines if str(row.id) in wanted]
    if request.form.text("do").endswith("file"):
        return Download(_as_csv(links), "text/csv; charset=utf-8", "invitations.csv")
    return request.render("site/instructor/links", links=links, days=DAYS)


def _link(request: Request, connection: Connection, row: PersonRow) -> InvitationLink:
    """Make an invitation link, if the current user may invite the person; all pages make links here. Raises
    HTTPException: the current user may not, or another person has the login."""
    request.require(to_invite(row.role))
    _check_login(connection, row.login, row.id)
    address = invited(request.site, connection, row.id, row.login, row.role)
    request.note(connection, "invited", person=row.id, role=row.role)
    return InvitationLink(row.name, row.login, address)


def _check_login(connection: Connection, login: str, person: int) -> None:
    other = account_by_login(connection, login)
    if other is not None and other.person_id != person:
        raise HTTPException("login_taken", 409, login)


def _as_csv(links: Sequence[InvitationLink]) -> bytes:
    columns = ("student", "login", "invitation")
    return csv_file((dict(zip(columns, link, strict=True)) for link in links), columns)


# --------------------------------------------------------------------- new people


def add(request: Request) -> Response:
    """Add the people of a roster, or one person by name and login, as students."""
    students = uploaded_roster(request) or [_of_fields(request)]
    with request.site.store.begin() as connection:
        before = {entry.id for entry in people(connection)}
        ids = [_add_student(request, connection, entry) for entry in students]
        new = sorted(set(ids) - before)
        request.note(connection, "people added", people=new)
    return redirect(f"/desk/people?added={len(new)}")


def _add_student(request: Request, connection: Connection, student: Student) -> int:
    """Add a student, or update a known person from a roster; a roster does not change staff. Raises
    HTTPException: it names a member of staff, whom the current user may not change."""
    existing = person_by_identifier(connection, student.draw_key)
    if existing is not None and (existing.role or STUDENT) in STAFF:
        request.require(Permission.PEOPLE_ROLES)
    return put_person(connection, student.draw_key, student.name, student.lang, student.columns)


def _of_fields(request: Request) -> Student:
    name, login = " ".join(request.form.text("name").split())[:200], as_login(request.form.text("login"))
    if not name or not login:
        raise HTTPException("bad_request", 422)
    return Student(name, "", {"email" if "@" in login else "login": login})


def add_staff(request: Request) -> Response:
    """Add a member of staff by name and login; return the invitation link."""
    student, role = _of_fields(request), request.form.text("role")
    if role not in STAFF:
        raise HTTPException("bad_request", 422)
    with request.site.store.begin() as connection:
        person = _add_student(request, connection, student)
        request.note(connection, "people added", people=[person])
        account = accounts(connection).get(person)
        if account is not None:
            raise HTTPException("login_taken", 409, account.login)
        line = PersonRow(person, student.name, login_of(person_by_id(connection, person)), role, "none")
        link = _link(request, connection, line)
        if role == ASSISTANT and (areas := _areas_of_form(request, connection, person)):
            put_areas(connection, person, areas)
            request.note(connection, "role", person=person, before=role, role=role, areas=_areas_text(areas))
    return request.render("site/instructor/links", links=[link], days=DAYS)


# ------------------------------------------------------------------------ a person


def person_page(request: Request) -> Response:
    """Return the page of a person: the account, the role, and the available actions."""
    with request.site.store.reading() as connection:
        person = somebody(request, connection)
        line = _line(request, person, accounts(connection).get(person.id))
        last = is_last_administrator(connection, person.id)
        areas = areas_of(connection, person.id)
        groups = groups_known(connection)
        assignments = _titled_assignments(request, connection)
        ties = _ties(connection, person.id)
    return request.render(
        "site/instructor/person",
        line=line,
        last=last,
        columns=person.columns or {},
        roles=ROLES,
        may_invite=may(request.user, to_invite(line.role)),
        groups={**groups, **_gone(areas, groups)},
        assignments=assignments,
        areas=areas,
        any=_ANY,
        ties=ties,
    )


def _titled_assignments(request: Request, connection: Connection) -> list[tuple[int, str]]:
    return [(about.id, about.title(request.lang)) for about in listed_assignments(connection)]


def _gone(areas: Sequence[Area], groups: Any) -> dict[str, str]:
    """Return the groups of an assistant that no roster contains any more."""
    return {area.group: area.group for area in areas if area.group is not None and area.group not in groups}


def _ties(connection: Connection, person: int) -> list[tuple[Any, str]]:
    """Return the accounts on platforms that sign in as a person, and the way in which each was linked."""
    lines = noted(connection, what=("connected a platform",), subject=person)
    by_password = {str(line.about.get("platform")) for line in lines}
    return [
        (tie, "by_password" if urlsplit(tie.issuer).hostname in by_password else "by_platform")
        for tie in links_of(connection, person)
    ]


def separate_tie(request: Request) -> Response:
    """Separate an account of a platform from a person, and end its sessions."""
    with request.site.store.begin() as connection:
        person = somebody(request, connection)
        gone = unlink_identity(connection, person.id, number(request.form.text("tie")))
        if gone is None:
            raise HTTPException("own", 404)
        drop_launches(connection, person.id, *gone)
        about = {"person": person.id, "platform": urlsplit(gone[0]).hostname or gone[0]}
        request.note(connection, "separated from a platform", **about)
    return redirect(f"/desk/people/{person.id}")


def invite_person(request: Request) -> Response:
    """Make a link by which one person chooses a password."""
    with request.site.store.begin() as connection:
        person = somebody(request, connection)
        link = _link(request, connection, _line(request, person, accounts(connection).get(person.id)))
    return request.render("site/instructor/links", links=[link], days=DAYS)


def change_role(request: Request) -> Response:
    """Give a person another role, and an assistant the groups and assignments that are ticked."""
    role = request.form.text("role")
    with request.site.store.begin() as connection:
        person = somebody(request, connection)
        line = _line(request, person, accounts(connection).get(person.id))
        if role not in ROLES or not line.has_account:
            raise HTTPException("bad_request", 422)
        if role != line.role and is_last_administrator(connection, line.id):
            raise HTTPException("last_administrator", 409)
        needs_link = set_role(connection, line.id, role)
        areas = _areas_of_form(request, connection, line.id) if role == ASSISTANT else []
        put_areas(connection, line.id, areas)
        about = {"areas": _areas_text(areas)} if role == ASSISTANT else {}
        request.note(connection, "role", person=line.id, before=line.role, role=role, **about)
        link = _link(request, connection, line._replace(role=role)) if needs_link else None
    if link is not None:
        return request.render("site/instructor/links", links=[link], days=DAYS, chooses_anew=True)
    return redirect(f"/desk/people/{line.id}")


def _areas_of_form(request: Request, connection: Connection, person: int) -> list[Area]:
    """Return the areas that a form selects: each group in each assignment; none if one of the two lists is
    empty."""
    assignments, groups = (
        {str(item.id): item.id for item in listed_assignments(connection)},
        groups_known(connection),
    )
    numbers = request.form.texts.get("assignment", ())
    named = request.form.texts.get("group", ())
    where = [None] if _ANY in numbers else [assignments[item] for item in numbers if item in assignments]
    before = {area.group for area in areas_of(connection, person)}
    chosen_groups = [None] if _ANY in named else [item for item in named if item in groups or item in before]
    return [Area(assignment, group) for assignment in where for group in chosen_groups]


def _areas_text(areas: Sequence[Area]) -> str:
    """Return areas as the audit records them: the assignment's number and the group, ``*`` for all."""
    texts = (f"{area.assignment or _ANY} / {_ANY if area.group is None else area.group}" for area in areas)
    return "; ".join(texts) or "–"


def somebody(request: Request, connection: Connection) -> Any:
    """Return the person whom the address names.

    Raises
    ------
    HTTPException
        There is none.
    """
    person = person_by_id(connection, number(str(request.path_params["person"])))
    if person is None:
        raise HTTPException("own", 404)
    return person


def number(text: str) -> int:
    """Return a number in an address; 0, which is nobody's id, for anything else."""
    return int(text) if text.isascii() and text.isdecimal() and len(text) < 10 else 0


def _count(text: str) -> int | None:
    return number(text) if text else None


ROUTES = (
    Route(
        "/desk/people",
        everybody,
        Permission.PEOPLE_READ,
        takes_forms=True,
        form_permission=Permission.PEOPLE_INVITE_STUDENTS,
        audit_event="links taken",
    ),
    Route("/desk/people/add", add, Permission.PEOPLE_ADD, takes_forms=True, limit="upload", budget=DESK_FILE),
    Route(
        "/desk/people/add-staff", add_staff, Permission.PEOPLE_INVITE_STAFF, takes_forms=True, has_page=False
    ),
    Route("/desk/people/{person}", person_page, Permission.PEOPLE_READ),
    Route(
        "/desk/people/{person}/invitation",
        invite_person,
        Permission.PEOPLE_INVITE_STUDENTS,
        takes_forms=True,
        has_page=False,
        staff_permission=Permission.PEOPLE_INVITE_STAFF,
    ),
    Route(
        "/desk/people/{person}/separate",
        separate_tie,
        Permission.PEOPLE_INVITE_STUDENTS,
        takes_forms=True,
        has_page=False,
        staff_permission=Permission.PEOPLE_INVITE_STAFF,
    ),
    Route(
        "/desk/people/{person}/role", change_role, Permission.PEOPLE_ROLES, takes_forms=True, has_page=False
    ),
)
