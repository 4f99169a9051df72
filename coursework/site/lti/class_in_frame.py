"""Class page in a platform's frame, for teachers: the rows of the instructor's table, and the state of each
score."""

from __future__ import annotations

from typing import NamedTuple

from sqlalchemy import Connection, select

from coursework.database.class_state import ClassState
from coursework.database.instructor_queries import people_of
from coursework.database.publication import CHARGE, Publication
from coursework.database.tables import identity
from coursework.language.words import words
from coursework.platforms.lti.storage import Waiting
from coursework.rendering.views import points_number
from coursework.site.desk import class_table
from coursework.site.frame.settings import Site
from coursework.site.frame.times import moment_text
from coursework.site.lti.launch_request import LTIRequest
from coursework.site.lti.scores import assignment_state, marked_in


class LaunchClassRow(NamedTuple):
    """Student in the class table of a platform."""

    name: str
    person: str  #: identifier on the platform; empty without a launch
    tries: int
    minutes_late: int
    points: str
    mark: str
    waits: int  #: answers that wait for a person
    gradebook: str


def class_rows(
    connection: Connection, site: Site, now: ClassState, request: LTIRequest, here: set[str]
) -> list[LaunchClassRow]:
    """Return the students of the platform's course, in the order of the desk's table.

    Parameters
    ----------
    here
        Platform identifiers of the people who opened the assignment from this course. Nobody else is shown,
        since an instructor of one course of the platform may not teach the others.
    """
    people, subjects = people_of(connection, now.about.id), _subjects(connection, request.launch.issuer)
    charges = Publication.of(now.about.published or {}).late == CHARGE
    scores, rows = request.scores(), []
    for row in class_table.rows(now):
        person = people.get(row.student, 0)
        subject = subjects.get(person, "")
        if subject not in here:
            continue
        points = row.points
        if (
            charges
            and row.late
            and (state := assignment_state(connection, now.about.id, person, request.lang, site.clock()))
        ):
            marked = marked_in(now, row.student)
            points = marked.given(state) if marked else points
        points_text = (
            f"{points_number(points, request.lang)} / {points_number(row.out_of, request.lang)}"
            if row.handed_in
            else ""
        )
        on_its_way = _score_state(scores.get(subject), subject, request.lang) if row.handed_in else ""
        rows.append(
            LaunchClassRow(
                row.student,
                subject,
                row.tries,
                row.minutes_late,
                points_text,
                row.mark,
                row.waits,
                on_its_way,
            )
        )
    return rows


def _subjects(connection: Connection, issuer: str) -> dict[int, str]:
    query = select(identity.c.person_id, identity.c.subject).where(identity.c.issuer == issuer)
    return {row.person_id: row.subject for row in connection.execute(query)}


def _score_state(waiting: Waiting | None, subject: str, lang: str) -> str:
    """Return the state of a score on its way to the platform."""
    link_texts, site_texts = words(lang)["lti"]["class"], words(lang, "site")["lti"]["class"]
    if waiting is None:
        return str(site_texts["kept_back"] if subject else site_texts["never_came"])
    if waiting.due is None:
        return str(link_texts["waits_person"] if waiting.score.waits else link_texts["arrived"])
    return str(
        link_texts["waits_because"].format(waiting.problem) if waiting.problem else link_texts["on_its_way"]
    )


def rules_rows(request: LTIRequest, counts: str, publication: Publication | None) -> list[tuple[str, str]]:
    """Return the rules with which the assignment is published, each with its label."""
    link, site_texts = words(request.lang)["lti"]["class"], words(request.lang, "site")["lti"]["class"]
    if publication is None:
        return [(site_texts["published"], site_texts["hidden"])]

    def moment(at: object) -> str:
        return moment_text(at, request.lang) if at else site_texts["never"]  # type: ignore[arg-type]

    return [
        (site_texts["opens"], moment(publication.opens) if publication.opens else site_texts["at_once"]),
        (site_texts["closes"], moment(publication.closes)),
        (link["tries"], link["any_number"] if publication.tries is None else str(publication.tries)),
        (link["counts"], link["best" if counts == "best" else "last"]),
        (
            site_texts["feedback"],
            site_texts["feedback_is"][publication.feedback].format(moment(publication.feedback_on)),
        ),
        (link["sends"], link["yes" if request.launch.line or request.launch.lines else "no"]),
    ]
