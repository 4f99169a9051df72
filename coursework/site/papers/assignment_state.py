"""Assignment as it concerns the current user: access, phase, submissions, and release of marks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from markupsafe import Markup
from sqlalchemy import Connection

from coursework.database.publication import (
    Phase,
    StudentAssignment,
    last_end,
    longer_for,
    student_assignments,
)
from coursework.database.submissions import Submission, attempts_used, submissions_by_assignment
from coursework.issuing.assignment import text_in
from coursework.language.numbers import localise, plain
from coursework.site.frame.requests import HTTPException, Request
from coursework.site.frame.times import exact_text, length_text, moment_text, time_element
from coursework.site.papers.student_paper import StudentPaper, student_paper
from coursework.site.papers.submission import pass_dates


class NotStarted(HTTPException):
    """Refusal of a paper whose working time the person has not started."""

    def __init__(self, assignment: StudentAssignment):
        super().__init__("not_started", 409)
        self.assignment = assignment


@dataclass(frozen=True)
class AssignmentState:
    """State of an assignment for the current user."""

    assignment: StudentAssignment
    lang: str
    now: datetime
    done: Sequence[Submission]
    everybody_ends: datetime | None
    used: int = 0  #: attempts made on the current paper

    @property
    def phase(self) -> Phase:
        return self.assignment.own_publication.phase(self.now)

    @property
    def tries_left(self) -> int | None:
        tries = self.assignment.own_publication.tries
        return None if tries is None else max(0, tries - self.used)

    @property
    def may_hand_in(self) -> bool:
        return self.phase.takes and self.tries_left != 0

    @property
    def title(self) -> str:
        return text_in(self.assignment.stated.get("title") or {}, self.lang) or self.assignment.name

    @property
    def address(self) -> str:
        return f"/assignments/{self.assignment.id}"

    @property
    def closed_for_both(self) -> datetime | None:
        """Time at which the assignment closes for the class and for this person; None if it never closes."""
        assert self.assignment.publication is not None
        ends = self.assignment.own_publication.ends, self.assignment.publication.ends
        return None if ends[0] is None or ends[1] is None else max(ends[0], ends[1])

    @property
    def has_times(self) -> bool:
        """Return True if a time of day is among what the person reads of the assignment."""
        return self.phase is Phase.TO_COME or self.assignment.own_publication.closes is not None

    @property
    def must_start(self) -> bool:
        """Return True if the paper opens only when the person starts its working time."""
        return self.assignment.must_start(self.now)

    @property
    def allowed(self) -> str:
        """Working time of this person as text; empty if there is none."""
        minutes = self.assignment.own_publication.minutes
        return "" if minutes is None else length_text(timedelta(minutes=minutes), self.lang)

    @property
    def has_extra_time(self) -> bool:
        """Return True if the working time is longer than that of the class."""
        assert self.assignment.publication is not None
        return (self.assignment.own_publication.minutes or 0) > (self.assignment.publication.minutes or 0)

    @property
    def seconds_left(self) -> int | None:
        """Remaining seconds of a working time that runs; None without one."""
        rules = self.assignment.own_publication
        if self.assignment.started is None or rules.minutes is None or rules.closes is None:
            return None
        return max(0, int((rules.closes - self.now).total_seconds())) if self.may_hand_in else None

    @property
    def ends_text(self) -> str:
        """End of a working time that runs, with its seconds."""
        closes = self.assignment.own_publication.closes
        return "" if closes is None else exact_text(closes, self.lang)

    @property
    def allowed_now(self) -> timedelta:
        """Time that the person has if the paper is started now: less than the working time near the closing
        date."""
        rules = self.assignment.own_publication
        whole = timedelta(minutes=rules.minutes or 0)
        return whole if rules.closes is None else min(whole, rules.closes - self.now)

    def releases(self, content: str) -> bool:
        """Return True if ``feedback`` or ``answers`` are released now."""
        ends = self.closed_for_both if content == "feedback" else self.everybody_ends
        return self.assignment.own_publication.releases(content, self.now, ends, self.tries_left)

    def moment(self, at: datetime | None) -> Markup:
        """Return a time as an element of a page; empty for none."""
        return Markup("") if at is None else time_element(at, self.lang)

    def percent(self, number: float) -> str:
        return localise(plain(number), self.lang)

    @property
    def left(self) -> str:
        """Remaining time as text; empty if the assignment does not close, or has closed."""
        rules = self.assignment.own_publication
        ends = rules.closes if self.phase is Phase.OPEN else rules.ends if self.phase is Phase.LATE else None
        return "" if ends is None else length_text(ends - self.now, self.lang)


def state_of(
    request: Request, assignment: StudentAssignment, connection: Connection, person: int = 0
) -> AssignmentState:
    """Return the state of an assignment for a person, by default the current user."""
    return _states(request, [assignment], connection, person or request.user.id)[0]


def _states(
    request: Request, assignments: Sequence[StudentAssignment], connection: Connection, person: int
) -> list[AssignmentState]:
    numbers, states = [assignment.id for assignment in assignments], []
    done = submissions_by_assignment(connection, numbers, person)
    publications = {one.id: one.publication for one in assignments if one.publication is not None}
    longer, used = longer_for(connection, publications), attempts_used(connection, person, done)
    for assignment in assignments:
        assert assignment.publication is not None
        number, now = assignment.id, assignment.publication.counted(request.received_at, request.site.clock())
        ends = last_end(assignment.publication, longer[number].values())
        theirs = done.get(number, []), ends, used.get(number, 0)
        states.append(AssignmentState(assignment, request.lang, now, *theirs))
    return states


def published_states(request: Request, connection: Connection) -> list[AssignmentState]:
    """Return the published assignments of the current user."""
    assignments = student_assignments(connection, request.user.id)
    published = [item for item in assignments if item.publication is not None]
    return _states(request, published, connection, request.user.id)


def to_hand_in(request: Request) -> list[AssignmentState]:
    """Return the assignments that a person may submit now and has not submitted yet."""
    with request.site.store.reading() as connection:
        states = published_states(request, connection)
    return [item for item in states if item.may_hand_in and not item.done]


def user_assignment(request: Request, connection: Connection) -> StudentAssignment:
    """Return the requested assignment, if it is published and the person was issued a paper of it.

    Raises
    ------
    HTTPException
        There is no such assignment; the response does not tell the reason.
    """
    matches = student_assignments(connection, request.user.id, int(request.path_params["number"]))
    if len(matches) != 1 or matches[0].publication is None:
        raise HTTPException("own", 404)
    return matches[0]


def state_and_paper(request: Request) -> tuple[AssignmentState, StudentPaper]:
    """Return the state of the assignment and the paper; refuse it before it opens."""
    pass_dates(request.site, request.received_at, int(request.path_params["number"]))
    with request.site.store.reading() as connection:
        assignment, paper = assignment_and_paper(request, connection, heads=True)
        return state_of(request, assignment, connection), paper


def assignment_and_paper(
    request: Request, connection: Connection, *, heads: bool = False
) -> tuple[StudentAssignment, StudentPaper]:
    """Return the assignment and the paper, with the data of its heading if ``heads``; refuse it before it
    opens, and before its working time was started."""
    site, assignment = request.site, user_assignment(request, connection)
    assert assignment.publication is not None
    now = assignment.publication.counted(request.received_at, site.clock())
    if assignment.own_publication.phase(now) is Phase.TO_COME:
        opens = assignment.own_publication.opens
        raise HTTPException("not_yet", 409, moment_text(opens, request.lang) if opens else "")
    if assignment.must_start(now):
        raise NotStarted(assignment)
    return assignment, student_paper(
        connection, site.course, assignment, request.user.id, request.lang, site.cache, heads=heads
    )
