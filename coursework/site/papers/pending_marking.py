"""Submissions that wait for their marks, as the pages report them."""

from __future__ import annotations

from datetime import timedelta
from typing import NamedTuple

from coursework.database.jobs import job_of, jobs_before
from coursework.site.frame.requests import Request
from coursework.site.frame.times import length_text

_SOON, _EACH, _LONGEST = (
    3.0,
    0.2,
    60.0,
)  #: seconds until a page reloads: minimum, addition for each earlier submission, maximum


class PendingMarking(NamedTuple):
    """Submission without marks."""

    message: str
    seconds: int  #: until the page reloads; 0 if reloading is useless


def pending_marking(request: Request, delivery: int) -> PendingMarking | None:
    """Return the message for a submission that waits for its marks; None if it is marked."""
    messages = request.words["assignments"]
    with request.site.store.reading() as connection:
        job = job_of(connection, delivery)
        if job is None or not request.site.has_worker:
            return None
        if job.fault:
            return PendingMarking(str(messages["not_marked"]), 0)
        seconds = round(min(_LONGEST, _SOON + _EACH * jobs_before(connection, job)))
    return PendingMarking(
        str(messages["being_marked"]).format(length_text(timedelta(seconds=seconds), request.lang)), seconds
    )
