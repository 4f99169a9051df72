"""People of launches: the person with the platform's identifier, and the paper assigned to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from sqlalchemy import Connection, select, update
from sqlalchemy.exc import IntegrityError

from coursework.database.assignments import issued_content, put_issued
from coursework.database.audit import note
from coursework.database.identities import (
    has_password,
    link_identity,
    people_matching,
    person_linked_to,
    update_from_platform,
)
from coursework.database.instructor_queries import stamp
from coursework.database.people import person_by_identifier, put_person
from coursework.database.sessions import digest_of
from coursework.database.tables import assignment
from coursework.issuing.assignment import Assignment, assignment_of
from coursework.issuing.issued import issued_content as content_of
from coursework.issuing.roster import Student
from coursework.issuing.students import folded
from coursework.issuing.variant_assignment import assign_variants
from coursework.site.frame.requests import HTTPException
from coursework.site.frame.settings import Site
from coursework.site.lti import connecting
from coursework.site.lti.linked_assignment import LinkedAssignment, number_of
from coursework.site.publication.assigning import holders

if TYPE_CHECKING:
    from coursework.platforms.lti.launch import Launch

_ROUNDS = 20  #: tries to assign a paper while others are assigned
_AGAIN = 5  #: seconds after which to try again


def launch_person(site: Site, launch: Launch, lang: str) -> Any:
    """Return the person of a launch, with its name and language; add a new one."""
    with site.store.reading() as connection:
        person = person_linked_to(connection, launch.issuer, launch.person)
    if person is not None and _is_current(person, launch, lang):
        return person
    with site.store.begin() as connection:
        person = person_linked_to(connection, launch.issuer, launch.person)
        if person is None:
            _add_person(site, connection, launch, lang)
        elif not person.login:
            update_from_platform(connection, person.id, launch.name, lang)
        return person_linked_to(connection, launch.issuer, launch.person)


def _is_current(person: Any, launch: Launch, lang: str) -> bool:
    """Return True if nothing is to be updated from the launch; a person with an account keeps the account's
    name."""
    return bool(person.login) or (launch.name in ("", person.name) and lang == person.lang)


def _add_person(site: Site, connection: Connection, launch: Launch, lang: str) -> None:
    """Connect the only person of the rosters with the platform's e-mail address or number, or else a new
    person. Raises HTTPException: the person has a password, which must be entered once."""
    matches = people_matching(connection, launch.issuer, launch.email, launch.number)
    if len(matches) == 1 and has_password(connection, matches[0].id):
        raise HTTPException("connect", 403, connecting.address(site, launch, matches[0].id))
    if len(matches) == 1:
        number, how = matches[0].id, "roster"
    else:
        student = _new(connection, launch)
        number, how = put_person(connection, student.draw_key, launch.name, lang, student.columns), "new"
    link_identity(connection, number, launch.issuer, launch.person)
    about = {"person": number, "platform": launch.platform, "how": how}
    note(connection, site.clock(), launch.platform, "came from a platform", **about)


def _new(connection: Connection, launch: Launch) -> Student:
    """Return a new student as a roster would list them: identified by number or e-mail, unless another has
    it; never by the name. Platforms may tell people apart by capitals, which rosters do not."""
    candidates = [
        {"number": launch.number.strip()},
        {"email": launch.email.strip()},
        {"number": f"{launch.person} {launch.platform}"},
        {"number": f"{launch.person} {digest_of(f'{launch.issuer} {launch.person}')[:12]}"},
    ]
    for columns in candidates:
        student = Student(launch.name, columns=columns)
        if all(columns.values()) and person_by_identifier(connection, student.draw_key) is None:
            return student
    raise HTTPException("own", 404)


# ----------------------------------------------------------------------- assigning


def assign_paper(site: Site, linked: LinkedAssignment, person: Any, launch: Launch, lang: str) -> int:
    """Assign a paper to somebody who joins late; all other papers remain as they are. The first paper of a
    link of an exercise adds the assignment of the link. Return the assignment's id.

    Raises
    ------
    HTTPException
        The assignment has no file that states its exercises, or concurrent assignments never end.
    """
    for _ in range(_ROUNDS):
        name, before, stood = linked.name, None, None
        table: Mapping[str, Any] | None = linked.table
        if linked.number is not None:
            with site.store.reading() as connection:
                before = issued_content(connection, linked.number, secret=True)
                stood = stamp(connection, linked.number).issued
                mine = assignment.c.id == linked.number
                table = connection.execute(select(assignment.c.asked).where(mine)).scalar()
        if table is None:
            raise HTTPException("not_dealt", 409)
        definition = assignment_of(name, table, site.course)
        everybody = holders(before) if before else []
        names = {folded(other.name) for other in everybody}
        student = _student(person, launch, _spoken(site, definition, lang), names)
        assigned = assign_variants(
            site.course, definition, [*everybody, student], [site.languages[0]], before
        )
        content = content_of(assigned.issues, definition, assigned.secret)
        try:
            with site.store.begin() as connection:
                if _stands(connection, linked, stood):
                    number = _put(connection, linked, content)
                    details = {"assignment": name, "students": 1, "person": person.id}
                    note(connection, site.clock(), launch.platform, "late ones added", **details)
                    return number
                linked = linked._replace(number=linked.number or number_of(connection, linked.link))
        except IntegrityError:  # another process added the assignment of the link at the same moment
            continue
    raise HTTPException("busy", 503, _AGAIN)


def _stands(connection: Connection, linked: LinkedAssignment, stood: Any) -> bool:
    """Return True if nothing was issued since it was read."""
    if linked.number is None:
        return number_of(connection, linked.link) is None
    mine = assignment.c.id == linked.number
    connection.execute(select(assignment.c.id).where(mine).with_for_update(key_share=True))
    return bool(stamp(connection, linked.number).issued == stood)


def _put(connection: Connection, linked: LinkedAssignment, content: Mapping[str, Any]) -> int:
    number = put_issued(connection, content, linked.name)
    if linked.number is None:
        own = {"asked": linked.table, "link": linked.link, "published": linked.publication.as_json()}
        connection.execute(update(assignment).where(assignment.c.id == number).values(own))
    return number


def _spoken(site: Site, definition: Assignment, lang: str) -> str:
    """Return the language if all the exercises have it; otherwise an empty text."""
    return lang if all(lang in site.course[name].languages for name in definition.names) else ""


def _student(person: Any, launch: Launch, lang: str, names: set[str]) -> Student:
    """Return the student of a launch as a roster would list them; two students of one name are
    distinguished."""
    plain = launch.name or person.name or launch.person
    apart = launch.number or launch.email or launch.person
    called = (plain, f"{plain} ({apart})", f"{plain} ({person.who})")
    name = next((name for name in called if folded(name) not in names), f"{plain} ({person.id})")
    student = Student(name, lang, {title: str(text) for title, text in person.columns.items()})
    return student if student.draw_key == person.who else Student(name, lang, {"number": person.who})
