"""Publication of an assignment: its dates, the number of attempts, late submissions, and the release of marks
and answers.

Dates are compared with the server's clock alone. A date that has passed is recorded (:func:`record_passed_date`), so that a clock that is
set back neither reopens an assignment nor withdraws what was released.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from datetime import datetime, timedelta
from enum import Enum
from functools import cache
from types import MappingProxyType
from typing import Any, NamedTuple

from sqlalchemy import BindParameter, Connection, Select, bindparam, func, insert, select, update

from coursework.database.tables import assignment, dealt, delivery, extension, variant

#: Release of marks and feedback, and of right answers and worked solutions.
AT_ONCE, CLOSED, DATE, NEVER = "at_once", "closed", "date", "never"
LAST_TRY = "last_try"  #: to each person after the last attempt
FEEDBACK = (AT_ONCE, CLOSED, DATE, NEVER)
ANSWERS = (NEVER, LAST_TRY, CLOSED, DATE)
#: Treatment of late submissions.
REFUSE, ACCEPT, CHARGE = "refuse", "accept", "charge"
LATE = (REFUSE, ACCEPT, CHARGE)
MOST_TRIES = 1000
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
        if self.takes_saved and self.closes is None:
            yield Fault("takes_saved", "never_closes")

    @property
    def _waits_for_the_end(self) -> bool:
        """True if something happens only after the assignment has closed."""
        return CLOSED in (self.feedback, self.answers) or self.takes_saved

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

    def dates(self, extensions: Sequence[Extension] = ()) -> list[datetime]:
        """Return all its dates, in order."""
        own_dates = [getattr(self, name) for name in _MOMENTS if name != "reached"]
        return sorted(
            date for date in (*own_dates, *(more.closes for more in extensions)) if date is not None
        )

    def passed(self, extensions: Sequence[Extension], clock: datetime) -> datetime | None:
        """Return the last date that has passed; None if there is none, or if it is recorded."""
        last = max((date for date in self.dates(extensions) if date < clock), default=None)
        return last if last is None or self.reached is None or last >= self.reached else None


def last_end(publication: Publication, extensions: Sequence[Extension]) -> datetime | None:
    """Return the time after which nobody can submit any more; None if there is none."""
    ends = [publication.ends, *(publication.extended(more).ends for more in extensions)]
    return None if None in ends else max(end for end in ends if end is not None)


# --------------------------------------------------------------------- database


def published(connection: Connection, number: int) -> Publication | None:
    """Return the publication of an assignment; None if the assignment is not published or does not exist."""
    stored = connection.execute(select(assignment.c.published).where(assignment.c.id == number)).scalar()
    return None if stored is None else Publication.of(stored)


def publish(connection: Connection, number: int, publication: Publication | None) -> None:
    """Publish an assignment; with None, withdraw its publication. Submissions remain."""
    stored = None if publication is None else publication.as_json()
    connection.execute(update(assignment).where(assignment.c.id == number).values(published=stored))


def is_over(connection: Connection, number: int, clock: datetime) -> bool:
    """Return True if nobody can submit any more, or if nobody can yet because the assignment is not
    published."""
    current = published(connection, number)
    if current is None:
        return True
    ends = last_end(current, list(extensions(connection, number).values()))
    return ends is not None and ends < current.now(clock)


def late_penalties(connection: Connection, number: int) -> dict[tuple[str, int], float]:
    """Return the penalties of late submissions as shares of the points, by student and attempt; a submission
    that an extension or a later closing date covers is no longer late."""
    publication = published(connection, number)
    if publication is None or publication.late != CHARGE:
        return {}
    theirs = extensions(connection, number)
    late = select(delivery).where(delivery.c.assignment_id == number, delivery.c.late > 0)
    names = select(dealt.c.person_id, dealt.c.student).join(variant).where(variant.c.assignment_id == number)
    student_names = {row.person_id: row.student for row in connection.execute(names)}
    shares = {}
    for row in connection.execute(late):
        extended = publication.extended(theirs.get(row.person_id))
        if row.person_id in student_names and (
            share := extended.charged(min(row.late, extended.late_seconds(row.came)))
        ):
            shares[student_names[row.person_id], row.number] = share
    return shares


def extend(connection: Connection, number: int, person: int, more: Extension) -> None:
    """Add an extension for a person; the last one counts."""
    row = {"assignment_id": number, "person_id": person, **more._asdict()}
    connection.execute(insert(extension).values(row))


def extensions(connection: Connection, number: int) -> dict[int, Extension]:
    """Return the current extension of each person."""
    return extensions_by_assignment(connection, [number]).get(number, {})


def extensions_by_assignment(
    connection: Connection, numbers: Sequence[int]
) -> dict[int, dict[int, Extension]]:
    """Return the current extension of each person, by assignment."""
    more: dict[int, dict[int, Extension]] = {}
    for row in connection.execute(_extensions_query(), {"numbers": numbers}):
        extended = Extension(row.closes, row.tries, row.reason, row.by, row.made)
        more.setdefault(row.assignment_id, {})[row.person_id] = extended
    return more


@cache
def _extensions_query() -> Select[Any]:
    """Return the query of :func:`extensions_by_assignment`, cached."""
    numbers: BindParameter[Any] = bindparam("numbers", expanding=True)
    return select(extension).where(extension.c.assignment_id.in_(numbers)).order_by(extension.c.id)


def passing(connection: Connection, numbers: Sequence[int], clock: datetime) -> list[int]:
    """Return the assignments with a date that has passed and is not recorded."""
    query = select(assignment.c.id, assignment.c.published).where(assignment.c.id.in_(numbers))
    rows = connection.execute(query.where(assignment.c.published.is_not(None))).all()
    more = extensions_by_assignment(connection, [row.id for row in rows])
    publications = ((row.id, Publication.of(row.published)) for row in rows)
    return [number for number, one in publications if one.passed([*more.get(number, {}).values()], clock)]


def record_passed_date(connection: Connection, number: int, clock: datetime) -> bool:
    """Record the last date that has passed, if there is one; return True if it is new."""
    about = connection.execute(
        select(assignment.c.published).where(assignment.c.id == number).with_for_update(key_share=True)
    ).scalar()
    if about is None:
        return False
    current = Publication.of(about)
    passed = current.passed([*extensions(connection, number).values()], clock)
    if passed is None:
        return False
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

    @property
    def own_publication(self) -> Publication:
        """Publication as it applies to this person."""
        assert self.publication is not None
        return self.publication.extended(self.extension)


def student_assignments(
    connection: Connection, person: int, number: int | None = None
) -> list[StudentAssignment]:
    """Return the assignments issued to a person, the latest first; one alone, if its number is given."""
    parameters = {"person": person} if number is None else {"person": person, "number": number}
    return [
        StudentAssignment(
            row.id, row.name, row.stated or {}, row.student,
            None if row.published is None else Publication.of(row.published),
            None if row.made is None else Extension(row.ext_closes, row.ext_tries, row.reason, row.by, row.made),
            row.asked or {},
        )
        for row in connection.execute(_student_assignments_query(number is not None), parameters)
    ]  # fmt: skip


@cache
def _student_assignments_query(is_of_one: bool) -> Select[Any]:
    """Return the query of :func:`student_assignments`, cached since many requests execute it, with the person's last extension."""
    theirs = select(variant.c.assignment_id, dealt.c.student).join(variant)
    mine = theirs.where(dealt.c.person_id == bindparam("person")).distinct().subquery()
    columns = assignment.c
    more, last = extension.c, func.max(extension.c.id)
    of_person = more.assignment_id == columns.id, more.person_id == bindparam("person")
    given = select(last).where(*of_person).correlate(assignment).scalar_subquery()
    query = select(columns.id, columns.name, columns.stated, columns.published, columns.asked, mine.c.student)
    query = query.add_columns(
        more.closes.label("ext_closes"), more.tries.label("ext_tries"), more.reason, more.by, more.made
    )
    query = query.select_from(
        assignment.join(mine, mine.c.assignment_id == columns.id).outerjoin(extension, more.id == given)
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
