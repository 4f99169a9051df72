"""Database of the service in one SQLite file: nonces of launches, sessions, papers, attempts, and scores to
send."""

from __future__ import annotations

import hashlib
import json
import os
import secrets
import sqlite3
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from coursework.course.secrecy import Secret
from coursework.errors import BadInput
from coursework.lti.launch import Launch
from coursework.lti.refusal import LTIRefusal
from coursework.lti.roles import Role
from coursework.system.sqlite_files import scrub

FILE = "lti.sqlite"
_WAIT = 10.0  #: seconds for another writer
_TAKEN = 180.0  #: seconds for which a score in transmission is not due for another process

_TABLES = """
CREATE TABLE IF NOT EXISTS used (nonce TEXT PRIMARY KEY, until REAL NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS sessions (id TEXT PRIMARY KEY, token TEXT NOT NULL, until REAL NOT NULL, launch TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS papers (
  place TEXT NOT NULL, person TEXT NOT NULL, name TEXT NOT NULL, asked TEXT NOT NULL, records TEXT NOT NULL,
  PRIMARY KEY (place, person)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS tries (
  place TEXT NOT NULL, person TEXT NOT NULL, number INTEGER NOT NULL, at REAL NOT NULL, answers TEXT NOT NULL,
  points REAL NOT NULL, out_of REAL NOT NULL, waits INTEGER NOT NULL, comment TEXT NOT NULL,
  PRIMARY KEY (place, person, number)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS scores (
  place TEXT NOT NULL, person TEXT NOT NULL, platform TEXT NOT NULL, line TEXT NOT NULL, lines TEXT NOT NULL, title TEXT NOT NULL,
  scopes TEXT NOT NULL, given REAL NOT NULL, maximum REAL NOT NULL, waits INTEGER NOT NULL, comment TEXT NOT NULL, stamp REAL NOT NULL,
  due REAL, failures INTEGER NOT NULL DEFAULT 0, said TEXT NOT NULL DEFAULT '',
  PRIMARY KEY (place, person)) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS scores_due ON scores (due);
CREATE TABLE IF NOT EXISTS opened (
  place TEXT NOT NULL, person TEXT NOT NULL, launch TEXT NOT NULL, PRIMARY KEY (place, person)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS looked (what TEXT PRIMARY KEY, stood TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS secrets (what TEXT PRIMARY KEY, text TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS courses (
  course TEXT PRIMARY KEY, title TEXT NOT NULL, memberships TEXT NOT NULL, seen REAL NOT NULL) WITHOUT ROWID;
"""


@dataclass(frozen=True)
class LTIPaper:
    """Variants issued to a person in a link."""

    person: str
    name: str
    settings: Mapping[str, Any]  #: settings of the link at the time of issue
    records: Sequence[Mapping[str, Any]]


@dataclass(frozen=True)
class LTIAttempt:
    """One submission of a person."""

    person: str
    number: int
    at: float
    answers: Sequence[Mapping[str, str]]  #: by part, for each exercise in order
    points: float
    out_of: float
    waits: bool  #: a person has to mark a part
    comment: str


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

    link_key: str
    person: str
    line: str
    lines: str
    title: str
    scopes: tuple[str, ...]
    score: Score
    stamp: float  #: seconds; no two of one person in one link are alike, and later ones are larger
    due: float | None
    failures: int
    problem: str

    @property
    def link(self) -> str:
        """Return the platform's own identifier of the link."""
        return str(json.loads(self.link_key)[-1])


class Storage:
    """Database file, opened for each operation; writers wait for each other."""

    def __init__(self, folder: Path, clock: Callable[[], float] = time.time):
        self.path, self._clock = folder / FILE, clock
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if not self.path.exists():
                os.close(os.open(self.path, os.O_CREAT | os.O_WRONLY, 0o600))
            with self._open() as file:
                file.execute("PRAGMA journal_mode = WAL")
                file.executescript(_TABLES)
        except (OSError, sqlite3.Error) as fault:
            raise BadInput("{file} cannot be used: {problem}", file=self.path, problem=fault) from fault

    @contextmanager
    def _open(self) -> Iterator[sqlite3.Connection]:
        """Open one transaction; its changes are on the disk when it ends."""
        file = sqlite3.connect(self.path, timeout=_WAIT, isolation_level=None)
        try:
            file.row_factory = sqlite3.Row
            file.execute("PRAGMA synchronous = FULL")
            file.execute("PRAGMA secure_delete = ON")
            yield file
        finally:
            file.close()

    @contextmanager
    def _writing(self) -> Iterator[sqlite3.Connection]:
        with self._open() as file:
            file.execute("BEGIN IMMEDIATE")
            try:
                yield file
            except BaseException:
                file.execute("ROLLBACK")
                raise
            file.execute("COMMIT")

    # ---------------------------------------------------------------- sessions

    def use(self, nonce: str, until: float) -> bool:
        """Record the nonce of a launch; return True if it is new."""
        with self._writing() as file:
            file.execute("DELETE FROM used WHERE until < ?", [self._clock() - 120])
            done = file.execute("INSERT OR IGNORE INTO used VALUES (?, ?)", [_digest(nonce), until])
            return done.rowcount == 1

    def begin(self, launch: Launch, seconds: float) -> tuple[str, str]:
        """Begin the session of a launch; return its name, and the token that identifies its browser."""
        name, token = secrets.token_urlsafe(12), secrets.token_urlsafe(32)
        now = self._clock()
        with self._writing() as file:
            file.execute("DELETE FROM sessions WHERE until < ?", [now])
            file.execute(
                "INSERT INTO sessions VALUES (?, ?, ?, ?)",
                [name, _digest(token), now + seconds, launch.as_json()],
            )
            if launch.link and launch.role is Role.STUDENT:
                lasting = replace(launch, email="", number="").as_json()
                file.execute(
                    "INSERT OR REPLACE INTO opened VALUES (?, ?, ?)",
                    [launch.link_key, launch.person, lasting],
                )
            if launch.context and launch.memberships:
                values = [launch.course, launch.context_title, launch.memberships, now]
                file.execute("INSERT OR REPLACE INTO courses VALUES (?, ?, ?, ?)", values)
        return name, token

    def launch(self, name: str, token: str | None) -> Launch:
        """Return the launch of a session.

        Raises
        ------
        LTIRefusal
            The session has ended, or belongs to another browser.
        """
        with self._open() as file:
            row = file.execute("SELECT * FROM sessions WHERE id = ?", [name]).fetchone()
        if row is None or row["until"] < self._clock():
            raise LTIRefusal("session", 403, "no such session")
        if token is None:
            raise LTIRefusal("cookie", 403, "no cookie of a session")
        if not secrets.compare_digest(row["token"], _digest(token)):
            raise LTIRefusal("browser", 403, "the cookie of another session")
        return Launch.from_json(row["launch"])

    def opened(self) -> list[Launch]:
        """Return the last launch of each student in each link."""
        with self._open() as file:
            rows = file.execute("SELECT launch FROM opened ORDER BY place, person")
            return [Launch.from_json(row["launch"]) for row in rows]

    def end(self, name: str) -> None:
        with self._writing() as file:
            file.execute("DELETE FROM sessions WHERE id = ?", [name])

    # --------------------------------------------------------- papers and tries

    def paper(self, link: str, person: str) -> LTIPaper | None:
        with self._open() as file:
            row = file.execute(
                "SELECT * FROM papers WHERE place = ? AND person = ?", [link, person]
            ).fetchone()
        return row and _paper(row)

    def papers(self, link: str) -> list[LTIPaper]:
        with self._open() as file:
            rows = file.execute("SELECT * FROM papers WHERE place = ? ORDER BY name, person", [link])
            return [_paper(row) for row in rows]

    def issue(self, link: str, paper: LTIPaper) -> LTIPaper:
        """Store a paper and return it; an earlier paper of the person stays and is returned instead."""
        values = [link, paper.person, paper.name, _json(paper.settings), _json(paper.records)]
        with self._writing() as file:
            file.execute("INSERT OR IGNORE INTO papers VALUES (?, ?, ?, ?, ?)", values)
            row = file.execute("SELECT * FROM papers WHERE place = ? AND person = ?", values[:2]).fetchone()
            return _paper(row)

    def submit(self, link: str, attempt: LTIAttempt) -> bool:
        """Store an attempt; return whether it is new, since a form may be sent twice."""
        values = [
            link,
            attempt.person,
            attempt.number,
            attempt.at,
            _json(attempt.answers),
            attempt.points,
            attempt.out_of,
            attempt.waits,
            attempt.comment,
        ]
        with self._writing() as file:
            done = file.execute("INSERT OR IGNORE INTO tries VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)", values)
            return done.rowcount == 1

    def tries(self, link: str, person: str = "") -> list[LTIAttempt]:
        """Return the attempts in a link, of one person or of everybody, the earliest first."""
        with self._open() as file:
            rows = file.execute(
                "SELECT * FROM tries WHERE place = ? AND (? = '' OR person = ?) ORDER BY person, number",
                [link, person, person],
            )
            return [_try(row) for row in rows]

    # ------------------------------------------------------------------ scores

    def put_score(self, launch: Launch, score: Score) -> bool:
        """Queue a score for the platform in place of an older one; return whether it differs."""
        link, person = launch.link_key, launch.person
        with self._writing() as file:
            row = file.execute(
                "SELECT * FROM scores WHERE place = ? AND person = ?", [link, person]
            ).fetchone()
            previous = row and _waiting(row)
            if previous and previous.score == score and previous.line == launch.line:
                return False
            stamp = max(self._clock(), previous.stamp + 0.001 if previous else 0.0)
            platform = json.dumps([launch.issuer, launch.client_id])
            values: list[Any] = [
                link,
                person,
                platform,
                launch.line,
                launch.lines,
                launch.link_title,
                _json(launch.scopes),
            ]
            values += [score.given, score.maximum, score.waits, score.comment, stamp, self._clock()]
            marks = ", ".join("?" * len(values))
            file.execute(f"INSERT OR REPLACE INTO scores VALUES ({marks}, 0, '')", values)
        return True

    def due(self, count: int = 50) -> list[tuple[tuple[str, str], Waiting]]:
        """Return the scores to send now, the longest waiting first, each with the issuer and client of its
        platform. Each is postponed for a while, so that another process sends it if no result is recorded
        by then."""
        now = self._clock()
        with self._open() as file:
            if file.execute("SELECT 1 FROM scores WHERE due <= ? LIMIT 1", [now]).fetchone() is None:
                return []
        with self._writing() as file:
            rows = file.execute("SELECT * FROM scores WHERE due <= ? ORDER BY due LIMIT ?", [now, count])
            scores = [(json.loads(row["platform"]), _waiting(row)) for row in rows]
            postponed = [
                [now + _TAKEN, waiting_score.link_key, waiting_score.person] for _, waiting_score in scores
            ]
            file.executemany("UPDATE scores SET due = ? WHERE place = ? AND person = ?", postponed)
        return [((issuer, client_id), waiting) for (issuer, client_id), waiting in scores]

    def arrived(self, sent: Waiting) -> None:
        """Record that a score has arrived; a newer score stays queued."""
        self._settle(sent, None, 0, "")

    def put_off(self, sent: Waiting, seconds: float, message: str) -> None:
        """Note why a score did not arrive, and when to try again."""
        self._settle(sent, self._clock() + seconds, sent.failures + 1, message)

    def _settle(self, sent: Waiting, due: float | None, failures: int, message: str) -> None:
        with self._writing() as file:
            values = [due, failures, message[:300], sent.link_key, sent.person, sent.stamp]
            file.execute(
                "UPDATE scores SET due = ?, failures = ?, said = ? WHERE place = ? AND person = ? AND stamp = ?",
                values,
            )

    def newer_stamp(self, sent: Waiting) -> None:
        """Give a score a newer time stamp, for a platform that claims to have a later one."""
        with self._writing() as file:
            values = [max(self._clock(), sent.stamp + 1.0), sent.link_key, sent.person, sent.stamp]
            file.execute("UPDATE scores SET stamp = ? WHERE place = ? AND person = ? AND stamp = ?", values)

    def scores(self, link: str = "") -> dict[tuple[str, str], Waiting]:
        """Return the scores by link and person."""
        with self._open() as file:
            rows = file.execute(
                "SELECT * FROM scores WHERE ? = '' OR place = ? ORDER BY place, person", [link, link]
            )
            return {(row["place"], row["person"]): _waiting(row) for row in rows}

    def hurry(self) -> int:
        """Make all waiting scores due now; return their number."""
        with self._writing() as file:
            return file.execute("UPDATE scores SET due = ? WHERE due IS NOT NULL", [self._clock()]).rowcount

    # -------------------------------------------------------- secret and checks

    def secret(self) -> Secret:
        """Return the secret that keys the draws of exercises, and of assignments without a secret; create it
        at the first use.

        Raises
        ------
        BadInput
            The stored text is no secret.
        """
        with self._writing() as file:
            file.execute("INSERT OR IGNORE INTO secrets VALUES ('draws', ?)", [Secret.new().text])
            (text,) = file.execute("SELECT text FROM secrets WHERE what = 'draws'").fetchone()
        try:
            return Secret.of(text)
        except ValueError as fault:
            raise BadInput("{file}: {problem}; restore a backup", file=self.path, problem=fault) from None

    def checked_state(self, subject: str) -> str:
        """Return the state of something when it was last checked; empty if it never was."""
        with self._open() as file:
            row = file.execute("SELECT stood FROM looked WHERE what = ?", [subject]).fetchone()
        return str(row["stood"]) if row else ""

    def record_check(self, subject: str, stood: str) -> None:
        """Record the state of a subject at its check."""
        with self._writing() as file:
            file.execute("INSERT OR REPLACE INTO looked VALUES (?, ?)", [subject, stood])

    # ----------------------------------------------------------------- courses

    def courses(self) -> list[tuple[tuple[str, str, str, str], str, str]]:
        """Return the known courses, the latest first: each with its identifier, its title, and the address of
        its roster."""
        with self._open() as file:
            rows = file.execute("SELECT * FROM courses ORDER BY seen DESC")
            return [(tuple(json.loads(row["course"])), row["title"], row["memberships"]) for row in rows]

    def scrub(self) -> bool:
        """Rewrite the file without deleted data; return False if another process still uses it."""
        return scrub(self.path)

    def forget(self, person: str, issuer: str = "") -> int:
        """Delete all data of a person, on one platform if an issuer is given; return the number of deleted
        rows."""
        begins = json.dumps([issuer])[:-1] + "," if issuer else ""  # as places do
        with self._writing() as file:
            gone = sum(
                file.execute(
                    f"DELETE FROM {table} WHERE person = ? AND substr(place, 1, ?) = ?",
                    [person, len(begins), begins],
                ).rowcount
                for table in ("papers", "tries", "scores", "opened")
            )
            return gone + _end_sessions(file, person, issuer)

    def end_sessions(self, person: str, issuer: str) -> int:
        """End the sessions of a person of a platform; return their number."""
        with self._writing() as file:
            return _end_sessions(file, person, issuer)


def _end_sessions(file: sqlite3.Connection, person: str, issuer: str) -> int:
    gone = 0
    for row in file.execute("SELECT id, launch FROM sessions").fetchall():
        launch = json.loads(row["launch"])
        if launch["person"] == person and issuer in ("", launch["issuer"]):
            gone += file.execute("DELETE FROM sessions WHERE id = ?", [row["id"]]).rowcount
    return gone


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _json(data: Any) -> str:
    return json.dumps(data, ensure_ascii=False)


def _paper(row: sqlite3.Row) -> LTIPaper:
    return LTIPaper(row["person"], row["name"], json.loads(row["asked"]), json.loads(row["records"]))


def _try(row: sqlite3.Row) -> LTIAttempt:
    return LTIAttempt(
        row["person"],
        row["number"],
        row["at"],
        json.loads(row["answers"]),
        row["points"],
        row["out_of"],
        bool(row["waits"]),
        row["comment"],
    )


def _waiting(row: sqlite3.Row) -> Waiting:
    return Waiting(
        row["place"], row["person"], row["line"], row["lines"], row["title"], tuple(json.loads(row["scopes"])),
        Score(row["given"], row["maximum"], row["comment"], bool(row["waits"])),
        row["stamp"], row["due"], row["failures"], row["said"],
    )  # fmt: skip
