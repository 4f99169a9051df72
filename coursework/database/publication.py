"""Publication of an assignment: its dates, the number of attempts, late submissions, and the release of marks
and answers.

Dates are compared with the server's clock alone. A date that has passed is recorded
(:func:`record_passed_date`), so that a clock that is set back neither reopens an assignment nor withdraws
what was released.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from datetime import datetime, timedelta
from enum import Enum
from fractions import Fraction
from functools import cache
from types import MappingProxyType
from typing import Any, NamedTuple

from sqlalchemy import (
    BindParameter,
    ColumnElement,
    Connection,
    Select,
    and_,
    bindparam,
    func,
    insert,
    select,
    update,
)

from coursework.database.tables import (
    assignment,
    extension,
    issue,
    paper_start,
    person,
    submission,
    variant,
)
from coursework.issuing.exam_columns import with_extra

#: Release of marks and feedback, and of right answers and worked solutions.
AT_ONCE, CLOSED, DATE, NEVER = "at_once", "closed", "date", "never"
LAST_TRY = "last_try"  #: to each person after the last attempt
FEEDBACK = (AT_ONCE, CLOSED, DATE, NEVER)
ANSWERS = (NEVER, LAST_TRY, CLOSED, DATE)
#: Treatment of late submissions.
REFUSE, ACCEPT, CHARGE = "refuse", "accept", "charge"
LATE = (REFUSE, ACCEPT, CHARGE)
MOST_TRIES = 1000
MOST_MINUTES = 24 * 60  #: of a working time
_SHARES = 10_000  #: largest denominator of a share of extra time, which is stored as a float
_DAY = 24 * 3600
_MOMENTS = ("opens", "closes", "feedback_on", "answers_on", "late_until", "reached")


class Phase(Enum):
    """Phase of an assignment for one person."""

    TO_COME = "to_come"
    OPEN = "open"
    LATE = "late"  #: it has closed, and submissions are still accepted
    CLOSED = "closed"

    @property
    def takes(self) -> bool:
        return self in (Phase.OPEN, Phase.LATE)


class Fault(NamedTuple):
    """Fault in a publication: the field, and the key of a message."""

    field: str
    sentence: str


class Extension(NamedTuple):
    """Other dates or another number of attempts for one person."""

    closes: datetime | None
    tries: int | None
    reason: str
    by: str
    made: datetime
    minutes: int | None = None  #: working time, in place of that of the class and of the person's extra time


def minutes_with(minutes: int, extra: float) -> int:
    """Return a working time in minutes with a share of extra time, in whole minutes, rounded up."""
    return with_extra(minutes, Fraction(extra).limit_denominator(_SHARES))


@dataclass(frozen=True)
class Publication:
    """Dates, number of attempts and rules of an assignment on the site. Times are UTC."""

    opens: datetime | None = None  #: at once, where there is none
    closes: datetime | None = None  #: never; the moment itself still counts as in time
    tries: int | None = 1  #: as many as anybody likes, where there is none
    late: str = REFUSE
    late_until: datetime | None = None  #: for ever, where what is late is taken at all
    late_percent: float = 0.0  #: of all the points that were earned, for each day begun
    feedback: str = CLOSED
    feedback_on: datetime | None = None
    answers: str = NEVER
    answers_on: datetime | None = None
    takes_saved: bool = False  #: drafts are submitted at the closing date for students without a submission
    reached: datetime | None = None  #: the last of its dates that has passed
    minutes: int | None = None  #: working time from the moment at which a person starts the paper

    # ------------------------------------------------------------------ as JSON

    @staticmethod
    def of(stored: Mapping[str, Any]) -> Publication:
        """Return the publication stored in a row; an unknown key, from a later version, is ignored."""
        names = {field.name for field in fields(Publication)}
        values = {key: value for key, value in stored.items() if key in names}
        moments = {key: datetime.fromisoformat(values[key]) for key in _MOMENTS if values.get(key)}
        return Publication(**{**values, **moments})

    def as_json(self) -> dict[str, Any]:
        usual = Publication()
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        json_values = {
            key: value.isoformat() if isinstance(value, datetime) else value for key, value in values.items()
        }
        return {key: value for key, value in json_values.items() if values[key] != getattr(usual, key)}

    # --------------------------------------------------------------- what it says

    def faults(self) -> Iterator[Fault]:
        """Yield the inconsistencies of the publication."""
        if self.tries is not None and not 1 <= self.tries <= MOST_TRIES:
            yield Fault("tries", "tries")
        if self.minutes is not None and not 1 <= self.minutes <= MOST_MINUTES:
            yield Fault("minutes", "minutes")
        if self.minutes is not None and self.late != REFUSE:
            yield Fault("late", "timed_late")
        if self.opens and self.closes and self.closes <= self.opens:
            yield Fault("closes", "closes_before")
        if self.late != REFUSE and self.closes is None:
            yield Fault("late", "late_never_closes")
        if self.late != REFUSE and self.late_until and self.closes and self.late_until <= self.closes:
            yield Fault("late_until", "late_until_before")
        if self.late != REFUSE and self.closes and not self.late_until and self._waits_for_the_end:
            yield Fault("late_until", "late_never_ends")
        if self.late == CHARGE and not 0 < self.late_percent <= 100:
            yield Fault("late_percent", "late_percent")
        for released in ("feedback", "answers"):
            when, on = getattr(self, released), getattr(self, f"{released}_on")
            if when == DATE and on is None:
                yield Fault(f"{released}_on", "no_date")
            if when == CLOSED and self.closes is None:
                yield Fault(released, "never_closes")
        if self.answers == LAST_TRY and self.tries is None:
            yield Fault("answers", "no_last_try")
        if self.takes_saved and self.closes is None and self.minutes is None:
            yield Fault("takes_saved", "never_closes")

    @property
    def _waits_for_the_end(self) -> bool:
        """True if something happens only after the assignment has closed."""
        return CLOSED in (self.feedback, self.answers) or self.takes_saved

    def personal(
        self, more: Extension | None, extra: float = 0.0, started: datetime | None = None
    ) -> Publication:
        """Return the publication as it applies to a person.

        A working time counts from the start of the paper, up to the closing date; that date is later by the
        person's additional minutes, unless an extension states it.

        Parameters
        ----------
        more
            Extension of the person.
        extra
            Share by which the person's working times are longer.
        started
            Time at which the person started the paper; None before.
        """
        own = self.extended(more)
        if own.minutes is None:
            return own
        allowed = (more.minutes if more else None) or minutes_with(own.minutes, extra)
        closes = own.closes
        if closes is not None and not (more and more.closes):
            closes += timedelta(minutes=max(0, allowed - own.minutes))
        if started is not None:
            end = started + timedelta(minutes=allowed)
            closes = end if closes is None else min(end, closes)
        return replace(own, closes=closes, minutes=allowed)

    def extended(self, more: Extension | None) -> Publication:
        """Return the publication with a person's extension applied, which may be longer or shorter."""
        if more is None:
            return self
        closes = more.closes or self.closes
        until = self.late_until
        if until is not None and closes is not None:
            until = max(until, closes)
        return replace(self, closes=closes, tries=more.tries or self.tries, late_until=until)

    def now(self, clock: datetime) -> datetime:
        """Return the effective time: that of the clock, but never before a date that has already passed."""
        return clock if self.reached is None else max(clock, self.reached)

    def counted(self, arrived: datetime, clock: datetime) -> datetime:
        """Return the effective time of a request received a moment ago, whatever date has been recorded
        since.

        Parameters
        ----------
        arrived, clock
            Time of the clock when the request was received, and now.
        """
        return arrived if self.now(clock) == clock else self.now(clock)

    def phase(self, now: datetime) -> Phase:
        if self.opens is not None and now < self.opens:
            return Phase.TO_COME
        if self.closes is None or now <= self.closes:
            return Phase.OPEN
        return Phase.LATE if self._takes_late(now) else Phase.CLOSED

    def _takes_late(self, now: datetime) -> bool:
        return self.late != REFUSE and (self.late_until is None or now <= self.late_until)

    @property
    def ends(self) -> datetime | None:
        """Last moment at which a submission is accepted; None if there is no limit."""
        return self.closes if self.late == REFUSE or self.closes is None else self.late_until

    def late_seconds(self, received_at: datetime) -> int:
        """Return the seconds by which a submission was late, rounded up; 0 in time."""
        if self.closes is None or received_at <= self.closes:
            return 0
        return math.ceil((received_at - self.closes) / timedelta(seconds=1))

    def charged(self, late: int) -> float:
        """Return the share of the points, 0 to 1, deducted from a submission that was late by the given
        seconds."""
        if self.late != CHARGE or late <= 0:
            return 0.0
        return min(1.0, self.late_percent / 100 * math.ceil(late / _DAY))

    def releases(
        self, what: str, now: datetime, ends: datetime | None, tries_left: int | None = None
    ) -> bool:
        """Return True if ``feedback`` or ``answers`` are released; ``ends`` is the time at which the
        assignment has closed for everybody concerned, ``tries_left`` the number of attempts that the person
        has left."""
        when, on = getattr(self, what), getattr(self, f"{what}_on")
        if when == LAST_TRY:
            return tries_left == 0
        if when == CLOSED:
            return ends is not None and now > ends
        return when == AT_ONCE or (when == DATE and on is not None and now >= on)

    def dates(self, ends: Iterable[datetime | None] = ()) -> list[datetime]:
        """Return all its dates and the ``ends`` of single persons, in order."""
        own_dates = [getattr(self, name) for name in _MOMENTS if name != "reached"]
        return sorted(date for date in (*own_dates, *ends) if date is not None)

    def passed(self, ends: Iterable[datetime | None], clock: datetime) -> datetime | None:
        """Return the last date that has passed; None if there is none, or if it is recorded."""
        last = max((date for date in self.dates(ends) if date < clock), default=None)
        return last if last is None or self.reached is None or last >= self.reached else None


def last_end(publication: Publication, personal: Iterable[Publication]) -> datetime | None:
    """Return the time after which nobody can submit any more; None if there is none.

    ``personal`` is the publication as it applies to those who may have longer than the class.
    """
    ends = [publication.ends, *(own.ends for own in personal)]
    return None if None in ends else max(end for end in ends if end is not None)


# --------------------------------------------------------------------- database


def published(connection: Connection, number: int) -> Publication | None:
    """Return the publication of an assignment; None if the assignment is not published or does not exist."""
    return publications_of(connection, [number]).get(number)


def publications_of(connection: Connection, numbers: Sequence[int] | None = None) -> dict[int, Publication]:
    """Return the publications of those of some assignments that are published; of all assignments if
    ``numbers`` is None."""
    query = select(assignment.c.id, assignment.c.published).where(assignment.c.published.is_not(None))
    query = query if numbers is None else query.where(assignment.c.id.in_(numbers))
    return {row.id: Publication.of(row.published) for row in connection.execute(query)}


def publish(connection: Connection, number: int, publication: Publication | None) -> None:
    """Publish an assignment; with None, withdraw its publication. Submissions remain."""
    stored = None if publication is None else publication.as_json()
    connection.execute(update(assignment).where(assignment.c.id == number).values(published=stored))


def publish_anew(connection: Connection, number: int, publication: Publication) -> None:
    """Publish an assignment with other dates and rules, by which the ends of papers are found again."""
    publish(connection, number, publication)
    its_starts = update(paper_start).where(paper_start.c.assignment_id == number)
    connection.execute(its_starts.values(ended=None))


def is_over(connection: Connection, number: int, clock: datetime) -> bool:
    """Return True if nobody can submit any more, or if nobody can yet because the assignment is not
    published."""
    current = published(connection, number)
    if current is None:
        return True
    ends = last_end(current, longer_for(connection, {number: current})[number].values())
    return ends is not None and ends < current.now(clock)


def late_penalties(connection: Connection, number: int) -> dict[tuple[str, int], float]:
    """Return the penalties of late submissions as shares of the points, by student and attempt; a submission
    that an extension or a later closing date covers is no longer late."""
    publication = published(connection, number)
    if publication is None or publication.late != CHARGE:
        return {}
    theirs = extensions(connection, number)
    late = select(submission).where(submission.c.assignment_id == number, submission.c.late > 0)
    names = select(issue.c.person_id, issue.c.student).join(variant).where(variant.c.assignment_id == number)
    student_names = {row.person_id: row.student for row in connection.execute(names)}
    shares = {}
    for row in connection.execute(late):
        extended = publication.extended(theirs.get(row.person_id))
        if row.person_id in student_names and (
            share := extended.charged(min(row.late, extended.late_seconds(row.received_at)))
        ):
            shares[student_names[row.person_id], row.number] = share
    return shares


def extend(connection: Connection, number: int, person: int, more: Extension) -> None:
    """Add an extension for a person; the last one counts."""
    row = {"assignment_id": number, "person_id": person, **more._asdict()}
    connection.execute(insert(extension).values(row))
    its_start = paper_start.c.assignment_id == number, paper_start.c.person_id == person
    connection.execute(update(paper_start).where(*its_start).values(ended=None))


def extensions(connection: Connection, number: int) -> dict[int, Extension]:
    """Return the current extension of each person."""
    return extensions_by_assignment(connection, [number]).get(number, {})


def extensions_by_assignment(
    connection: Connection, numbers: Sequence[int]
) -> dict[int, dict[int, Extension]]:
    """Return the current extension of each person, by assignment."""
    more: dict[int, dict[int, Extension]] = {}
    for row in connection.execute(_extensions_query(), {"numbers": numbers}):
        extended = Extension(row.closes, row.tries, row.reason, row.by, row.made, row.minutes)
        more.setdefault(row.assignment_id, {})[row.person_id] = extended
    return more


@cache
def _extensions_query() -> Select[Any]:
    """Return the query of :func:`extensions_by_assignment`, cached."""
    numbers: BindParameter[Any] = bindparam("numbers", expanding=True)
    return select(extension).where(extension.c.assignment_id.in_(numbers)).order_by(extension.c.id)


def longer_for(
    connection: Connection, publications: Mapping[int, Publication]
) -> dict[int, dict[int, Publication]]:
    """Return the publications as they apply to those who may have longer than the class, by assignment: to
    people with an extension, or with extra time on a paper with a working time."""
    more = extensions_by_assignment(connection, list(publications))
    timed = [number for number, one in publications.items() if one.minutes is not None]
    times: dict[int, dict[int, Any]] = {}
    for row in connection.execute(_extra_time_query(), {"numbers": timed}) if timed else ():
        times.setdefault(row.assignment_id, {})[row.person_id] = row
    found: dict[int, dict[int, Publication]] = {}
    for number, publication in publications.items():
        extensions_here, times_here = more.get(number, {}), times.get(number, {})
        found[number] = {
            one: publication.personal(extensions_here.get(one), *_times(times_here.get(one)))
            for one in {**extensions_here, **times_here}
        }
    return found


class RunningPaper(NamedTuple):
    """Started paper whose end is not recorded as passed."""

    id: int
    person: int
    end: datetime


def running(connection: Connection, publications: Mapping[int, Publication]) -> dict[int, list[RunningPaper]]:
    """Return the started papers whose ends are not recorded as passed, by assignment."""
    found: dict[int, list[RunningPaper]] = {number: [] for number in publications}
    timed = [number for number, one in publications.items() if one.minutes is not None]
    if not timed:
        return found
    more = extensions_by_assignment(connection, timed)
    for row in connection.execute(_running_query(), {"numbers": timed}):
        extended = more.get(row.assignment_id, {}).get(row.person_id)
        own = publications[row.assignment_id].personal(extended, *_times(row))
        if own.closes is not None:
            found[row.assignment_id].append(RunningPaper(row.id, row.person_id, own.closes))
    return found


def _times(row: Any) -> tuple[float, datetime | None]:
    """Return the extra time and the start of the paper in a row."""
    return (0.0, None) if row is None else (row.extra_time or 0.0, row.started)


def _times_query(*conditions: ColumnElement[bool]) -> Select[Any]:
    """Return a query of people's current papers of assignments, with extra time and start."""
    numbers: BindParameter[Any] = bindparam("numbers", expanding=True)
    papers = (
        select(
            variant.c.assignment_id,
            issue.c.person_id,
            func.max(issue.c.sitting).label("sitting"),
            person.c.extra_time,
        )
        .select_from(person.join(issue, issue.c.person_id == person.c.id).join(variant))
        .where(variant.c.assignment_id.in_(numbers), *conditions)
        .group_by(variant.c.assignment_id, issue.c.person_id, person.c.extra_time)
        .subquery()
    )
    mine, begun = papers.c, paper_start.c
    of_paper = (
        begun.assignment_id == mine.assignment_id,
        begun.person_id == mine.person_id,
        begun.sitting == mine.sitting,
    )
    query = select(mine.assignment_id, mine.person_id, mine.extra_time, begun.started)
    return query.select_from(papers.outerjoin(paper_start, and_(*of_paper)))


@cache
def _extra_time_query() -> Select[Any]:
    """Return the query of the papers of people with extra time, cached."""
    return _times_query(person.c.extra_time > 0)


@cache
def _running_query() -> Select[Any]:
    """Return the query of :func:`running`, cached."""
    numbers: BindParameter[Any] = bindparam("numbers", expanding=True)
    query = select(paper_start, person.c.extra_time).join(person)
    return query.where(paper_start.c.ended.is_(None), paper_start.c.assignment_id.in_(numbers))


def start(connection: Connection, number: int, person_id: int, sitting: int, at: datetime) -> None:
    """Record the start of a paper, in a transaction that has locked the person; a second one changes
    nothing."""
    row = {"assignment_id": number, "person_id": person_id, "sitting": sitting}
    known = connection.execute(select(paper_start.c.id).filter_by(**row)).first()
    if known is None:
        connection.execute(insert(paper_start).values(**row, started=at))


def starts(connection: Connection, number: int) -> dict[int, tuple[float, datetime | None]]:
    """Return the extra time and the start of the current paper of each person with a paper."""
    rows = connection.execute(_times_query(), {"numbers": [number]})
    return {row.person_id: _times(row) for row in rows}


def passing(
    connection: Connection, publications: Mapping[int, Publication], times: Mapping[int, datetime]
) -> list[int]:
    """Return the assignments with a date that has passed at their time and is not recorded."""
    longer, begun = longer_for(connection, publications), running(connection, publications)
    return [
        number
        for number, one in publications.items()
        if one.passed([own.closes for own in longer[number].values()], times[number])
        or any(paper.end < times[number] for paper in begun[number])
    ]


def record_passed_date(connection: Connection, number: int, clock: datetime) -> bool:
    """Record the last date that has passed, if there is one; return True if it is new."""
    about = connection.execute(
        select(assignment.c.published).where(assignment.c.id == number).with_for_update(key_share=True)
    ).scalar()
    if about is None:
        return False
    current = Publication.of(about)
    longer = longer_for(connection, {number: current})[number].values()
    over = [paper for paper in running(connection, {number: current})[number] if paper.end < clock]
    if over:
        ended = update(paper_start).where(paper_start.c.id.in_([paper.id for paper in over]))
        connection.execute(ended.values(ended=clock))
    passed = current.passed([*(own.closes for own in longer), *(paper.end for paper in over)], clock)
    if passed is None:
        return bool(over)
    publish(connection, number, replace(current, reached=passed + timedelta(microseconds=1)))
    return True


class StudentAssignment(NamedTuple):
    """Assignment issued to a person, with its publication."""

    id: int
    name: str
    stated: Mapping[str, Any]
    student: str  #: the person's name as issued
    publication: Publication | None
    extension: Extension | None
    file_statement: Mapping[str, Any] = MappingProxyType({})  #: what its file says, where it is of one
    extra: float = 0.0  #: share of the person's extra time
    started: datetime | None = None  #: start of the current paper, where a working time counts from it
    sitting: int = 1  #: number of the current paper

    @property
    def own_publication(self) -> Publication:
        """Publication as it applies to this person."""
        assert self.publication is not None
        return self.publication.personal(self.extension, self.extra, self.started)

    def must_start(self, now: datetime) -> bool:
        """Return True if the paper opens only when the person starts its working time."""
        own = self.own_publication
        return own.minutes is not None and self.started is None and own.phase(now) is Phase.OPEN


def student_assignments(
    connection: Connection, person: int, number: int | None = None
) -> list[StudentAssignment]:
    """Return the assignments issued to a person, the latest first; one alone, if its number is given."""
    parameters = {"person": person} if number is None else {"person": person, "number": number}
    return [
        StudentAssignment(
            row.id,
            row.name,
            row.stated or {},
            row.student,
            None if row.published is None else Publication.of(row.published),
            None
            if row.made is None
            else Extension(row.ext_closes, row.ext_tries, row.reason, row.by, row.made, row.ext_minutes),
            row.asked or {},
            row.extra_time or 0.0,
            row.started,
            row.sitting,
        )
        for row in connection.execute(_student_assignments_query(number is not None), parameters)
    ]


@cache
def _student_assignments_query(is_of_one: bool) -> Select[Any]:
    """Return the query of :func:`student_assignments`, cached since many requests execute it, with the
    person's last extension and the start of the current paper."""
    columns = assignment.c
    last_sitting = func.max(issue.c.sitting).label("sitting")
    theirs = select(variant.c.assignment_id, issue.c.student, last_sitting).join(variant)
    theirs = theirs.where(issue.c.person_id == bindparam("person"))
    mine = theirs.group_by(variant.c.assignment_id, issue.c.student).subquery()
    begun = paper_start.c
    of_paper = (
        begun.assignment_id == columns.id,
        begun.person_id == bindparam("person"),
        begun.sitting == mine.c.sitting,
    )
    more, last = extension.c, func.max(extension.c.id)
    of_person = more.assignment_id == columns.id, more.person_id == bindparam("person")
    given = select(last).where(*of_person).correlate(assignment).scalar_subquery()
    query = select(
        columns.id,
        columns.name,
        columns.stated,
        columns.published,
        columns.asked,
        mine.c.student,
        mine.c.sitting,
        more.closes.label("ext_closes"),
        more.tries.label("ext_tries"),
        more.minutes.label("ext_minutes"),
        more.reason,
        more.by,
        more.made,
        person.c.extra_time,
        begun.started,
    )
    query = query.select_from(
        assignment.join(mine, mine.c.assignment_id == columns.id)
        .join(person, person.c.id == bindparam("person"))
        .outerjoin(extension, more.id == given)
        .outerjoin(paper_start, and_(*of_paper))
    )
    query = query.order_by(columns.id.desc())
    return query.where(columns.id == bindparam("number")) if is_of_one else query


def set_counting_attempt(connection: Connection, number: int, counts: str) -> None:
    """Set the attempt that counts, ``best`` or ``last``."""
    row = connection.execute(select(assignment).where(assignment.c.id == number)).one()
    values = {
        key: {**value, "sittings": counts}
        for key, value in (("stated", row.stated), ("asked", row.asked))
        if value is not None
    }
    if values:
        connection.execute(update(assignment).where(assignment.c.id == number).values(values))
