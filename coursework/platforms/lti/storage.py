"""Launches in the database: nonces, sessions in frames, courses with a roster, and scores to send."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, Connection, Table, delete, insert, select, update

from coursework.database.personal_data import launch_sessions
from coursework.database.sessions import digest_of
from coursework.database.store import Store, insert_unless_there
from coursework.database.tables import lti_course, lti_launch, lti_nonce, lti_session, person
from coursework.platforms.lti.launch import Launch
from coursework.platforms.lti.refusal import LTIRefusal

_LEEWAY = timedelta(minutes=2)  #: for which a nonce is kept after it has expired
_TAKEN = timedelta(minutes=3)  #: for which a score in transmission is not due for another process
_STEP = timedelta(milliseconds=1)  #: between two stamps, as platforms read them


@dataclass(frozen=True)
class Score:
    """Score of a person in a link, as reported to the platform."""

    given: float
    maximum: float
    comment: str = ""
    waits: bool = False


@dataclass(frozen=True)
class Waiting:
    """Score with the state of its delivery; ``due`` is None once it has arrived."""

    id: int  #: of the launch in the database
    launch: Launch
    name: str  #: of the person
    line: str
    score: Score
    stamp: datetime  #: no two of one person in one link are alike, and later ones are larger
    due: datetime | None
    failures: int
    problem: str


class Storage:
    """Launches of the learning platforms in the database of a site."""

    def __init__(self, store: Store, clock: Callable[[], float] = time.time):
        self._store, self._clock = store, clock

    @property
    def now(self) -> datetime:
        return datetime.fromtimestamp(self._clock(), UTC)

    # ---------------------------------------------------------------- sessions

    def use(self, nonce: str, until: float) -> bool:
        """Record the nonce of a launch; return True if it is new."""
        row = {"digest": digest_of(nonce), "until": datetime.fromtimestamp(until, UTC)}
        with self._store.begin() as connection:
            connection.execute(delete(lti_nonce).where(lti_nonce.c.until < self.now - _LEEWAY))
            return insert_unless_there(connection, lti_nonce, row, ["digest"]) is not None

    def begin(self, launch: Launch, seconds: float) -> tuple[str, str]:
        """Begin the session of a launch; return its name, and the token that identifies its browser."""
        name, token, now = secrets.token_urlsafe(12), secrets.token_urlsafe(32), self.now
        row = {
            "name": name,
            "digest": digest_of(token),
            "issuer": launch.issuer,
            "subject": launch.person,
            "launch": launch.as_plain(),
            "until": now + timedelta(seconds=seconds),
        }
        with self._store.begin() as connection:
            connection.execute(delete(lti_session).where(lti_session.c.until < now))
            connection.execute(insert(lti_session).values(row))
            if launch.context and launch.memberships:
                values = {
                    "issuer": launch.issuer,
                    "client": launch.client_id,
                    "title": launch.context_title,
                    "memberships": launch.memberships,
                    "seen": now,
                }
                _put(connection, lti_course, {"digest": digest_of(launch.course)}, values)
        return name, token

    def launch(self, name: str, token: str | None) -> Launch:
        """Return the launch of a session.

        Raises
        ------
        LTIRefusal
            The session has ended, or belongs to another browser.
        """
        with self._store.reading() as connection:
            row = connection.execute(select(lti_session).where(lti_session.c.name == name[:16])).first()
        if row is None or row.until < self.now:
            raise LTIRefusal("session", 403, "no such session")
        if token is None:
            raise LTIRefusal("cookie", 403, "no cookie of a session")
        if not secrets.compare_digest(row.digest, digest_of(token)):
            raise LTIRefusal("browser", 403, "the cookie of another session")
        return Launch.of_plain(row.launch)

    # ---------------------------------------------------------------- launches

    def record(self, launch: Launch, person_id: int, assignment_id: int) -> bool:
        """Record the last launch of a student in a link, without e-mail and number; return True if it differs
        from the one before."""
        values = {"assignment_id": assignment_id, "launch": replace(launch, email="", number="").as_plain()}
        with self._store.reading() as connection:
            row = connection.execute(select(lti_launch).where(*_of(launch, person_id))).first()
        if row is not None and all(getattr(row, name) == value for name, value in values.items()):
            return False
        with self._store.begin() as connection:
            key = {"person_id": person_id, "link": digest_of(launch.link_key)}
            _put(connection, lti_launch, key, values)
        return True

    def opened(self, assignment_id: int | None = None) -> list[tuple[int, int, Launch]]:
        """Return the last launch of each student in each link, with the assignment and the person; those of
        one assignment, if given."""
        query = select(lti_launch.c.assignment_id, lti_launch.c.person_id, lti_launch.c.launch)
        if assignment_id is not None:
            query = query.where(lti_launch.c.assignment_id == assignment_id)
        with self._store.reading() as connection:
            rows = connection.execute(query.order_by(lti_launch.c.id)).all()
        return [(row.assignment_id, row.person_id, Launch.of_plain(row.launch)) for row in rows]

    # ------------------------------------------------------------------ scores

    def put_score(self, launch: Launch, person_id: int, score: Score) -> bool:
        """Queue a score for the platform in place of an older one; return whether it differs."""
        with self._store.begin() as connection:
            row = connection.execute(
                select(lti_launch).where(*_of(launch, person_id)).with_for_update()
            ).first()
            if row is None:
                return False
            now = self.now
            if row.stamp is not None:
                if (_score(row), row.line) == (score, launch.line):
                    return False
                now = max(now, row.stamp + _STEP)
            values = {
                "given": score.given,
                "maximum": score.maximum,
                "comment": score.comment,
                "waits": score.waits,
                "line": launch.line,
                "stamp": now,
                "due": self.now,
                "failures": 0,
                "problem": "",
            }
            connection.execute(update(lti_launch).where(lti_launch.c.id == row.id).values(values))
        return True

    def due(self, count: int = 50) -> list[Waiting]:
        """Return the scores to send now, the longest waiting first. Each is postponed for a while, so that
        another process sends it if no result is recorded by then."""
        now = self.now
        with self._store.reading() as connection:
            if connection.execute(_scores().where(lti_launch.c.due <= now).limit(1)).first() is None:
                return []
        query = _scores().where(lti_launch.c.due <= now).order_by(lti_launch.c.due).limit(count)
        with self._store.begin() as connection:
            rows = connection.execute(query.with_for_update(of=lti_launch, skip_locked=True)).all()
            postponed = update(lti_launch).where(lti_launch.c.id.in_([row.id for row in rows]))
            connection.execute(postponed.values(due=now + _TAKEN))
        return [_waiting(row) for row in rows]

    def arrived(self, sent: Waiting) -> None:
        """Record that a score has arrived; a newer score stays queued."""
        self._settle(sent, due=None, failures=0, problem="")

    def put_off(self, sent: Waiting, seconds: float, message: str) -> None:
        """Note why a score did not arrive, and when to try again."""
        due = self.now + timedelta(seconds=seconds)
        self._settle(sent, due=due, failures=sent.failures + 1, problem=str(message)[:300])

    def newer_stamp(self, sent: Waiting) -> None:
        """Give a score a newer time stamp, for a platform that claims to have a later one."""
        self._settle(sent, stamp=max(self.now, sent.stamp + timedelta(seconds=1)))

    def _settle(self, sent: Waiting, **values: Any) -> None:
        mine = lti_launch.c.id == sent.id, lti_launch.c.stamp == sent.stamp
        with self._store.begin() as connection:
            connection.execute(update(lti_launch).where(*mine).values(values))

    def scores(self, launch: Launch | None = None) -> list[Waiting]:
        """Return the scores, of one link if a launch of it is given."""
        query = _scores().where(lti_launch.c.stamp.is_not(None)).order_by(lti_launch.c.id)
        if launch is not None:
            query = query.where(lti_launch.c.link == digest_of(launch.link_key))
        with self._store.reading() as connection:
            return [_waiting(row) for row in connection.execute(query)]

    def hurry(self) -> None:
        """Make all waiting scores due now."""
        with self._store.begin() as connection:
            waiting = update(lti_launch).where(lti_launch.c.due.is_not(None))
            connection.execute(waiting.values(due=self.now))

    # ----------------------------------------------------------------- courses

    def courses(self) -> list[Any]:
        """Return the known courses, the latest first: ``issuer``, ``client``, ``title`` and ``memberships``,
        the address of the roster."""
        with self._store.reading() as connection:
            return list(connection.execute(select(lti_course).order_by(lti_course.c.seen.desc())))


def end_launch_sessions(connection: Connection, person_id: int) -> None:
    """End the sessions of a person in frames of platforms."""
    connection.execute(delete(lti_session).where(launch_sessions(person_id)))


def drop_launches(connection: Connection, person_id: int, issuer: str, subject: str) -> None:
    """Delete the launches of a person from a platform, so that no score is sent there any more, and end the
    sessions."""
    mine = lti_session.c.issuer == issuer, lti_session.c.subject == subject
    connection.execute(delete(lti_session).where(*mine))
    rows = connection.execute(select(lti_launch).where(lti_launch.c.person_id == person_id)).all()
    ids = [row.id for row in rows if (row.launch["issuer"], row.launch["person"]) == (issuer, subject)]
    connection.execute(delete(lti_launch).where(lti_launch.c.id.in_(ids)))


def _put(connection: Connection, table: Table, key: Mapping[str, Any], values: Mapping[str, Any]) -> None:
    """Update the row with a key; add it if there is none."""
    mine = (table.c[name] == value for name, value in key.items())
    if not connection.execute(update(table).where(*mine).values(dict(values))).rowcount:
        insert_unless_there(connection, table, {**key, **values}, list(key))


def _of(launch: Launch, person_id: int) -> tuple[ColumnElement[bool], ...]:
    """Return the conditions of a person's launch in a link."""
    return lti_launch.c.link == digest_of(launch.link_key), lti_launch.c.person_id == person_id


def _scores() -> Any:
    return select(lti_launch, person.c.name).join(person, person.c.id == lti_launch.c.person_id)


def _score(row: Any) -> Score:
    return Score(row.given, row.maximum, row.comment, row.waits)


def _waiting(row: Any) -> Waiting:
    launch = Launch.of_plain(row.launch)
    return Waiting(
        row.id, launch, row.name, row.line, _score(row), row.stamp, row.due, row.failures, row.problem
    )
