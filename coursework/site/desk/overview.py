"""Instructor's overview: the assignments, their submissions, and the answers that wait for a person."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta
from pathlib import PurePath

from starlette.responses import Response

from coursework.database.assignments import put_issued
from coursework.database.class_summaries import ClassCounts, stored_counts, summary_states
from coursework.database.instructor_queries import AssignmentOverview, stamps
from coursework.database.permissions import Permission, groups_within
from coursework.errors import BadInput, CourseworkError
from coursework.figures.dark import darkened
from coursework.issuing.issued import Issued
from coursework.site.desk.class_cache import assignments_marked, class_here
from coursework.site.desk.class_table import computed_table, table_here
from coursework.site.desk.question_cards import moment, question_card
from coursework.site.frame.budgets import DESK_FILES, read_apart
from coursework.site.frame.clock import Leap, last_leap
from coursework.site.frame.requests import HTTPException, Request, Route, Upload
from coursework.site.frame.responses import redirect
from coursework.site.frame.times import length_text, moment_text
from coursework.site.papers.submission import pass_dates


@dataclass(frozen=True)
class Tile:
    """Assignment on the overview page."""

    id: int
    title: str
    name: str
    students: int
    handed_in: int
    waiting: int
    last: str  #: time of the last submission; empty if there is none
    fault: str = ""  #: reason for which it cannot be shown


def overview(request: Request) -> Response:
    """Return the overview of the assignments, the latest first."""
    assignments, counts, leap = _stored(request)
    if pass_dates(request.site, request.site.clock(), *(about.id for about in assignments)):
        assignments, counts, leap = _stored(request)
    return request.render(
        "site/instructor/desk",
        tiles=[
            _counted(request, about, counts[about.id])
            if about.id in counts and _is_whole(request, about)
            else _tile(request, about)
            for about in assignments
        ],
        clock="" if leap is None else _clock_text(request, leap),
    )


def _stored(request: Request) -> tuple[list[AssignmentOverview], dict[int, ClassCounts], Leap | None]:
    """Return the assignments that the user may see, the stored counts that are true now, and the last leap of
    the clock."""
    with request.site.store.reading() as connection:
        assignments = [about for about, _ in assignments_marked(request, connection)]
        at = stamps(connection, [about.id for about in assignments])
        states = summary_states(connection, request.site.course, assignments, at)
        return assignments, stored_counts(connection, states), last_leap(connection, request.received_at)


def _is_whole(request: Request, about: AssignmentOverview) -> bool:
    """Return True if the user sees the whole class of an assignment."""
    return groups_within(request.user, about.id) is None


def _clock_text(request: Request, leap: Leap) -> str:
    """Return the message about a leap of the server's clock."""
    which = "clock_held" if leap.held else "clock_back" if leap.seconds < 0 else "clock_followed"
    length = length_text(timedelta(seconds=abs(leap.seconds)), request.lang)
    return str(request.words["desk"][which]).format(
        moment_text(leap.at.replace(second=0, microsecond=0), request.lang), length
    )


def _tile(request: Request, about: AssignmentOverview) -> Tile:
    """Return the tile of an assignment that has changed; with the reason if the course of the site cannot
    mark it."""
    try:
        whole = _is_whole(request, about)
        table = computed_table(request.site, about.id) if whole else table_here(request, about.id)
    except CourseworkError as fault:
        if isinstance(fault, HTTPException):
            raise
        return Tile(about.id, about.title(request.lang), about.name, 0, 0, 0, "", str(fault))
    return _counted(request, table.about, table.counts)


def _counted(request: Request, about: AssignmentOverview, counts: ClassCounts) -> Tile:
    last = moment(about.last, request.lang) if about.last else ""
    title = about.title(request.lang)
    return Tile(about.id, title, about.name, *counts, last)


def bring(request: Request) -> Response:
    """Store the variants that a build issued, so that the site can mark their answers.

    Raises
    ------
    BadInput
        The file is not an ``issued.json``, or belongs to another course.
    """
    file = request.form.upload("issued")
    if file is None:
        raise BadInput(request.words["desk"]["bring"])
    issued = read_apart(
        DESK_FILES, request.words["refused"]["too_much"], Issued.of, file.data, PurePath(file.name).name
    )
    for exercise in issued.exercises:
        request.site.course[exercise]
    with request.site.store.begin() as connection:
        number = put_issued(connection, _content(file), request.form.text("name").strip())
        request.note(connection, "issued", assignment=number)
    return redirect(f"/desk/{number}")


def _content(file: Upload) -> dict[str, object]:
    import json

    content = json.loads(file.data.decode("utf-8"))
    assert isinstance(content, dict)  # Issued.of has checked it
    return content


def figure(request: Request) -> Response:
    """Return the figure of somebody's variant."""
    now = class_here(request)
    exercise, seed = request.query_params.get("exercise", ""), request.query_params.get("seed", "")
    sheet = next(
        (
            graded
            for graded in now.machine.values()
            if (graded.exercise, str(graded.seed)) == (exercise, seed)
        ),
        None,
    )
    if sheet is None or not sheet.lines:
        raise HTTPException("own", 404)
    drawn = question_card(now.course, now.issued, sheet, next(iter(sheet.lines)), request.lang).handout.figure
    if drawn is None:
        raise HTTPException("own", 404)
    return Response(
        media_type="image/svg+xml; charset=utf-8", content=darkened(drawn.outlined_svg()).encode()
    )


ROUTES = (
    Route("/desk", overview, Permission.DESK),
    Route("/desk/issued", bring, Permission.FILES_BRING, takes_forms=True, limit="upload", budget=DESK_FILES),
    Route("/desk/{assignment:int}/figure", figure, Permission.MARKS_READ, by_group=True),
)
