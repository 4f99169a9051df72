"""Assignment that a link opens: a published one of the site, or one that is made for a link of an
exercise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from sqlalchemy import Connection, select

from coursework.course.course import Course
from coursework.database.audit import note
from coursework.database.publication import (
    AT_ONCE,
    LAST_TRY,
    NEVER,
    Publication,
    publish,
    set_counting_attempt,
)
from coursework.database.sessions import digest_of
from coursework.database.tables import assignment
from coursework.errors import BadInput
from coursework.issuing.assignment import Assignment, assignment_of
from coursework.platforms.lti.launch import Launch
from coursework.platforms.lti.link_settings import LinkSettings
from coursework.platforms.lti.refusal import LTIRefusal
from coursework.site.frame.settings import Site


class LinkedAssignment(NamedTuple):
    """Assignment that a link opens."""

    number: int | None  #: id; None for a link of an exercise that no student has opened yet
    name: str
    link: str = ""  #: digest of a link of an exercise, with its content; empty for an assignment of the site
    table: Mapping[str, Any] = {}  #: content of the file of an assignment, for a link of an exercise
    publication: Publication = Publication()  #: what a link of an exercise states

    def definition(self, course: Course[Any]) -> Assignment:
        return assignment_of(self.name, self.table, course)


def linked_assignment(site: Site, launch: Launch) -> LinkedAssignment:
    """Return the assignment that a launch opens.

    Raises
    ------
    LTIRefusal
        The link names no content, or content that does not exist.
    """
    wanted = LinkSettings.of(launch.custom)
    if wanted.assignment:
        with site.store.reading() as connection:
            mine = assignment.c.name == wanted.assignment
            number = connection.execute(select(assignment.c.id).where(mine)).scalar()
        if number is None:
            raise LTIRefusal("unknown_choice", 404, f"no assignment {wanted.assignment[:60]!r}")
        return LinkedAssignment(number, wanted.assignment)
    link = digest_of(f"{launch.link_key} {wanted.key}")
    linked = LinkedAssignment(
        None, f"{wanted.exercise}-{link[:10]}", link, _table(site, wanted, launch), _publication(wanted)
    )
    try:
        linked.definition(site.course)
    except BadInput:
        raise LTIRefusal(
            "unknown_choice", 404, f"no exercise {wanted.exercise[:60]!r} with such parts"
        ) from None
    with site.store.reading() as connection:
        return linked._replace(number=number_of(connection, link))


def number_of(connection: Connection, link: str) -> int | None:
    """Return the id of the assignment that was made for a link of an exercise; None if there is none."""
    return connection.execute(select(assignment.c.id).where(assignment.c.link == link)).scalar()


def _table(site: Site, wanted: LinkSettings, launch: Launch) -> dict[str, Any]:
    """Return an assignment of one exercise as its file would state it."""
    course = {"course": launch.context_title} if launch.context_title else {}
    parts = {"parts": list(wanted.parts)} if wanted.parts else {}
    titles = {}
    if wanted.exercise in site.course:
        exercise = site.course[wanted.exercise]
        titles = {lang: exercise.title(lang) for lang in exercise.languages}
    asked_exercise = {"name": wanted.exercise, **parts}
    return {"title": titles, **course, "sittings": wanted.counts, "exercises": [asked_exercise]}


def _publication(wanted: LinkSettings) -> Publication:
    answers = LAST_TRY if wanted.shows_answers else NEVER
    return Publication(tries=wanted.tries, feedback=AT_ONCE, answers=answers)


def follow_link(site: Site, linked: LinkedAssignment, current: Publication, launch: Launch) -> None:
    """Take over the rules that a link of an exercise states now; what staff set beside them stays."""
    if linked.number is None or not linked.link:
        return
    counts = linked.table["sittings"]
    with site.store.reading() as connection:
        mine = assignment.c.id == linked.number
        stated = connection.execute(select(assignment.c.stated).where(mine)).scalar_one()
    stating = replace(current, tries=linked.publication.tries, answers=linked.publication.answers)
    if stating == current and stated.get("sittings") == counts:
        return
    with site.store.begin() as connection:
        publish(connection, linked.number, stating)
        set_counting_attempt(connection, linked.number, counts)
        details = {"assignment": linked.name, **stating.as_json(), "sittings": counts}
        note(connection, site.clock(), launch.platform, "assignment published", **details)
