"""Start of a paper with a working time: the page before it, and the record of the start, from which the time
counts."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

from coursework.database.people import lock_person
from coursework.database.publication import StudentAssignment, start
from coursework.site.frame.requests import Request
from coursework.site.frame.times import length_text
from coursework.site.papers.assignment_state import NotStarted, assignment_and_paper, state_of
from coursework.site.papers.submission import pass_dates


def start_names(request: Request, assignment: StudentAssignment) -> dict[str, Any]:
    """Return the names of the page that starts a paper: its state, and the time that is left if that is less
    than the working time."""
    with request.site.store.reading() as connection:
        state = state_of(request, assignment, connection)
    whole = timedelta(minutes=state.assignment.own_publication.minutes or 0)
    is_shorter = state.allowed_now < whole
    return {"state": state, "shorter": length_text(state.allowed_now, request.lang) if is_shorter else ""}


def record_start(request: Request) -> None:
    """Start the working time of the paper that the address names, once; a repeated request changes
    nothing."""
    number = int(request.path_params["number"])
    pass_dates(request.site, request.received_at, number)
    with request.site.store.begin() as connection:
        lock_person(connection, request.user.id)
        try:
            assignment_and_paper(request, connection, heads=False)
        except NotStarted as why:
            sitting = why.assignment.sitting
            start(connection, number, request.user.id, sitting, request.received_at)
            request.note(connection, "paper started", assignment=number, person=request.user.id)
