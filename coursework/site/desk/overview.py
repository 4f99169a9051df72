"""Instructor's overview: the assignments, their submissions, and the answers that wait for a person."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta
from pathlib import PurePath

from coursework.database.assignments import put_issued
from coursework.database.audit import note
from coursework.database.desk import listed
from coursework.database.permissions import Permission
from coursework.errors import BadInput, CourseworkError
from coursework.making.issued import Issued
from coursework.site.desk.class_at_hand import ClassNow, assignment_of, by_whom, called, class_now
from coursework.site.desk.question_cards import asked, moment
from coursework.site.frame.budgets import DESK_FILES, read_apart
from coursework.site.frame.clock import Leap, last_leap
from coursework.site.frame.moments import length_text, moment_text
from coursework.site.frame.visits import Page, Refused, Reply, Upload, Visit


@dataclass(frozen=True)
class Tile:
    """Assignment on the overview page."""

    id: int
    title: str
    name: str
    students: int
    handed_in: int
    waiting: int
    last: str  #: when something came; empty for never
    is_published: bool
    fault: str = ""  #: why it cannot be shown


def overview(visit: Visit) -> Reply:
    """Return the overview of the assignments, the latest first."""
    with visit.site.store.reading() as connection:
        found = listed(connection)
        leap = last_leap(connection, visit.at)
    return visit.page(
        "site_desk",
        tiles=[_tile(visit, one.id) for one in found if visit.who.may(Permission.MARKS_READ, one.id, "")],
        told=visit.query.get("told", ""),
        clock="" if leap is None else _clock_text(visit, leap),
    )


def _clock_text(visit: Visit, leap: Leap) -> str:
    """Return the message about a leap of the server's clock."""
    which = "clock_held" if leap.held else "clock_back" if leap.seconds < 0 else "clock_followed"
    length = length_text(timedelta(seconds=abs(leap.seconds)), visit.lang)
    return str(visit.said["desk"][which]).format(
        moment_text(leap.at.replace(second=0, microsecond=0), visit.lang), length
    )


def _tile(visit: Visit, number: int) -> Tile:
    """Return the tile of an assignment; with the reason if the course of the site cannot mark it."""
    try:
        return _counted(visit, class_now(visit.site, number))
    except CourseworkError as fault:
        if isinstance(fault, Refused):
            raise
        with visit.site.store.reading() as connection:
            about = listed(connection, number)[0]
        return Tile(number, called(about, visit.lang), about.name, 0, 0, 0, "", False, str(fault))


def _counted(visit: Visit, now: ClassNow) -> Tile:
    about = now.about
    last = moment(about.last, visit.lang) if about.last else ""
    return Tile(
        about.id, called(about, visit.lang), about.name, len(now.issued.students) or len(now.results),
        len({one.student for one in now.machine.values()}), now.waiting, last, about.published is not None,
    )  # fmt: skip


def bring(visit: Visit) -> Reply:
    """Take in what a build issued, so that its answers can be marked here.

    Raises
    ------
    BadInput
        The file is no ``issued.json``, or is of another course.
    """
    file = next(iter(visit.form.files.get("issued", ())), None)
    if file is None:
        raise BadInput(visit.said["desk"]["bring"])
    issued = read_apart(
        DESK_FILES, visit.said["refused"]["too_much"], Issued.of, file.data, PurePath(file.name).name
    )
    for exercise in issued.exercises:
        visit.site.course[exercise]
    with visit.site.store.begin() as connection:
        number = put_issued(connection, _content(file), visit.form.text("name").strip())
        note(connection, visit.at, by_whom(visit), "issued", assignment=number)
    return Reply(goto=f"/desk/{number}")


def _content(file: Upload) -> dict[str, object]:
    import json

    found = json.loads(file.data.decode("utf-8"))
    assert isinstance(found, dict)  # Issued.of has seen it
    return found


def figure(visit: Visit) -> Reply:
    """Return the figure of somebody's variant."""
    now = class_now(visit.site, assignment_of(visit))
    exercise, seed = visit.query.get("exercise", ""), visit.query.get("seed", "")
    sheet = next(
        (one for one in now.machine.values() if (one.exercise, str(one.seed)) == (exercise, seed)), None
    )
    if sheet is None or not sheet.lines:
        raise Refused("own", 404)
    drawn = asked(now.course, now.issued, sheet, next(iter(sheet.lines)), visit.lang).handout.figure
    if drawn is None:
        raise Refused("own", 404)
    return Reply(kind="image/svg+xml; charset=utf-8", data=drawn.outlined_svg().encode())


PAGES = (
    Page("/desk", overview, Permission.DESK),
    Page("/desk/issued", bring, Permission.FILES_BRING, posts=True, limit="upload", budget=DESK_FILES),
    Page("/desk/{assignment:int}/figure", figure, Permission.MARKS_READ),
)
