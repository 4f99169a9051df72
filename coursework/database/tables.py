"""Tables of the database. A row that records an event is added and never changed; the last of its kind is the
current one.

Times are UTC. Texts are as received. JSON contains what other files define: records
(:mod:`coursework.course.records`), what ``issued.json`` states, entries of progress
(:mod:`coursework.selfstudy.progress`); it is kept as it was written, keys in their order.
"""

from __future__ import annotations

import zlib
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    JSON,
    Boolean,
    Column,
    DateTime,
    Double,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    TypeDecorator,
    UniqueConstraint,
)

METADATA = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
        "pk": "pk_%(table_name)s",
    }
)


class UTCDateTime(TypeDecorator[datetime]):
    """Time in UTC; a value that is read has its time zone on every database."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Any) -> datetime | None:
        if value is None:
            return None
        if value.tzinfo is None:
            raise ValueError(f"a time without its zone: {value}")
        return value.astimezone(UTC)

    def process_result_value(self, value: Any, dialect: Any) -> datetime | None:
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)


class SafeText(TypeDecorator[str]):
    """Text of any length. Characters that some server cannot store are replaced: NUL by ``␀``, a lone
    surrogate by its code."""

    impl = Text
    cache_ok = True

    def process_bind_param(self, value: str | None, dialect: Any) -> str | None:
        if value is None or (value.isascii() and "\0" not in value):
            return None if value is None else str(value)  # of a message its English text
        return value.replace("\0", "␀").encode("utf-8", "backslashreplace").decode("utf-8")


class CompressedText(TypeDecorator[str]):
    """Long text, stored compressed: a page shrinks to a fifth."""

    impl = LargeBinary
    cache_ok = True

    def process_bind_param(self, value: str | None, dialect: Any) -> bytes | None:
        return None if value is None else zlib.compress(value.encode("utf-8", "backslashreplace"))

    def process_result_value(self, value: Any, dialect: Any) -> str | None:
        return None if value is None else zlib.decompress(value).decode("utf-8")


Json = JSON(none_as_null=True)


def _key() -> Column[int]:
    return Column("id", Integer, primary_key=True)


def _of(table: str, *, null: bool = False, index: bool = False) -> Column[int]:
    return Column(f"{table}_id", ForeignKey(f"{table}.id", ondelete="CASCADE"), nullable=null, index=index)


# ------------------------------------------------------------------------- people

#: Person who answers, teaches or both. ``who`` is the identifier in a roster: a number, an e-mail, else the
#: folded name.
person = Table(
    "person",
    METADATA,
    _key(),
    Column("who", SafeText, nullable=False, unique=True),
    Column("name", SafeText, nullable=False),
    Column("lang", SafeText, nullable=False, default=""),
    Column("columns", Json, nullable=False, default=dict),  #: of the rosters that name them
    Column("extra_time", Double),  #: share by which working times are longer; none for none
    Column("created", UTCDateTime, nullable=False),
)

#: Account with a password, stored as a hash of argon2.
account = Table(
    "account",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("login", SafeText, nullable=False, unique=True),
    Column("secret", SafeText, nullable=False, default=""),  #: empty before the invitation is accepted
    Column("invitation", String(64), index=True),  #: digest of what the invitation's address ends with
    Column("invited_until", UTCDateTime),
    Column("joined", UTCDateTime),  #: time at which an invitation was accepted
    Column("role", String(16), nullable=False),  #: student, assistant, instructor, administrator
    Column("created", UTCDateTime, nullable=False),
    Column("closed", UTCDateTime),
)

#: Session of a signed-in browser. Dumps omit it, so that a restoration signs nobody in.
session = Table(
    "session",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("digest", String(64), nullable=False, unique=True),  #: of the browser's token
    Column("browser", SafeText, nullable=False, default=""),  #: "Firefox, Linux"
    Column("created", UTCDateTime, nullable=False),
    Column("seen", UTCDateTime, nullable=False),  #: the last use, to some minutes
    Column("until", UTCDateTime, nullable=False, index=True),  #: when it expires unless it is used
    info={"fleeting": True},
)

#: Assignment and group in which an assistant works; every assignment, or the whole class, if none is named.
area = Table(
    "area",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("assignment_id", ForeignKey("assignment.id", ondelete="CASCADE")),
    Column("class_group", SafeText),  #: without differences of case and spaces
)

#: Failed attempts to sign in, by a keyed digest of login and network: no login can be read from it.
failure = Table(
    "failure",
    METADATA,
    Column("key", String(64), primary_key=True),
    Column("count", Integer, nullable=False),
    Column("last", UTCDateTime, nullable=False, index=True),
    info={"fleeting": True},
)

#: Identifier of a person on a platform.
identity = Table(
    "identity",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("issuer", SafeText, nullable=False),
    Column("subject", SafeText, nullable=False),
    UniqueConstraint("issuer", "subject"),
)

# -------------------------------------------------------------------- assignments

#: Assignment, or build of exercises, with a name. ``stated`` is its statement in ``issued.json``.
assignment = Table(
    "assignment",
    METADATA,
    _key(),
    Column("name", SafeText, nullable=False, unique=True),
    Column("course", SafeText, nullable=False, default=""),  #: the course's name
    Column("stated", Json),  #: none for exercises without an assignment
    Column("has_roster", Boolean, nullable=False, default=False),
    Column("is_pool", Boolean, nullable=False, default=False),  #: a platform assigns its variants
    Column("columns", Json, nullable=False, default=dict),  #: of the roster, by student
    Column("asked", Json),  #: content of its file, for students added later; none of a build of exercises
    #: key for the draws of students added later; none if it was issued without one
    Column("secret", String(32)),
    Column("published", Json),  #: dates, attempts, feedback, late rules; none while it is not published
    #: digest of the link of a platform that opens an exercise; none of an assignment that staff made
    Column("link", String(64), index=True, unique=True),
    Column("created", UTCDateTime, nullable=False),
)

#: Issued variant; answers are marked against its record.
variant = Table(
    "variant",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),  #: whole, however large
    Column("letter", String(2), nullable=False, default=""),  #: A to Z, of versions
    Column("record", Json, nullable=False),
    UniqueConstraint("assignment_id", "exercise", "seed"),
)

#: Assignment of a variant to a student, with sitting and language. ``place`` is its position in
#: ``issued.json``.
issue = Table(
    "issue",
    METADATA,
    _key(),
    _of("variant", index=True),
    _of("person", null=True, index=True),  #: none if there is no roster
    Column("place", Integer, nullable=False),
    Column("student", SafeText, nullable=False, default=""),  #: the name as it was issued
    Column("sitting", Integer, nullable=False, default=1),
    Column("lang", SafeText, nullable=False, default=""),
)

# ------------------------------------------------------------------------ answers

#: Submission: a file, or the answers that a person submits on the site.
submission = Table(
    "submission",
    METADATA,
    _key(),
    _of("assignment", index=True),
    _of("person", null=True, index=True),  #: who submitted on the site; none for files
    Column("source", SafeText, nullable=False),
    Column("digest", String(64), nullable=False),  #: of its content: the same content is stored once
    Column("number", Integer, nullable=False, default=0),  #: attempt of the person; 0 for files
    Column("receipt", String(40), nullable=False, default=""),  #: code shown to the person
    Column("late", Integer, nullable=False, default=0),  #: seconds after the closing date of the person
    Column("received_at", UTCDateTime, nullable=False),
    Column("replaced", UTCDateTime),  #: time at which a later file replaced it; none while it counts
    UniqueConstraint("assignment_id", "digest"),
    UniqueConstraint("assignment_id", "person_id", "number"),
)

#: Answer as received. ``place`` numbers answers, rejected rows and platform files of a submission in one
#: order.
answer = Table(
    "answer",
    METADATA,
    _key(),
    _of("submission", index=True),
    Column("place", Integer, nullable=False),
    Column("student", SafeText, nullable=False),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),
    Column("part", SafeText, nullable=False),
    Column("answer", Json),  #: text, number, or none
    Column("source", SafeText, nullable=False),
    Column("warning", SafeText, nullable=False, default=""),
    Column("lang", SafeText, nullable=False, default=""),
    #: Statements of a platform about it (:class:`coursework.gradebook.rows.RowOrigin`).
    Column("origin", Json),
)

#: Drawing of an exercise, as it was when the answers were submitted
#: (:mod:`coursework.figures.student_drawing`).
drawing = Table(
    "drawing",
    METADATA,
    _key(),
    _of("submission", index=True),
    Column("exercise", SafeText, nullable=False),
    Column("text", SafeText, nullable=False),
)

#: Row that could not be placed or read, with the reason.
rejected = Table(
    "rejected",
    METADATA,
    _key(),
    _of("submission", index=True),
    Column("place", Integer, nullable=False),
    Column("source", SafeText, nullable=False),
    Column("reason", SafeText, nullable=False),
    Column("row", Json, nullable=False, default=dict),
)

#: File written by a platform (:class:`coursework.gradebook.rows.PlatformFile`).
seen = Table(
    "seen",
    METADATA,
    _key(),
    _of("submission", index=True),
    Column("place", Integer, nullable=False),
    Column("source", SafeText, nullable=False),
    Column("what", SafeText, nullable=False),
    Column("is_tree", Boolean, nullable=False, default=False),
)

# -------------------------------------------------------------------------- marks

#: Marking of a sheet, with the state of its answers, course and engine. The last one of a sheet counts; an
#: empty state means that the sheet has no answers any more.
marking = Table(
    "marking",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("student", SafeText, nullable=False),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),  #: whole, however large
    Column("attempt", Integer, nullable=False, default=0),  #: as stated in the submission, else 0
    Column("sitting", Integer, nullable=False, default=1),
    Column("state", String(64), nullable=False),  #: digest of record, answers, rules, course and engine
    Column("lang", SafeText, nullable=False, default=""),  #: of the returned sheet
    Column("apart", Boolean, nullable=False, default=False),  #: a platform asked these parts alone
    Column("submitted", SafeText, nullable=False, default=""),  #: time, if a platform states it
    Column("fault", SafeText, nullable=False, default=""),  #: reason for which it cannot be marked
    Column("made", UTCDateTime, nullable=False),
    Index("ix_marking_sheet", "assignment_id", "student", "exercise", "seed"),
)

#: Mark of one answer.
mark = Table(
    "mark",
    METADATA,
    _key(),
    _of("marking", index=True),
    Column("place", Integer, nullable=False),  #: on the sheet
    Column("part", SafeText, nullable=False),
    Column("received_place", Integer),  #: position among the answers received; none without an answer
    Column("answer", SafeText, nullable=False),
    Column("read_as", SafeText, nullable=False),
    Column("verdict", SafeText, nullable=False),
    Column("points", Double, nullable=False),
    Column("out_of", Double, nullable=False),
    Column("lang", SafeText, nullable=False),
    Column("matches", Json, nullable=False),  #: all verdicts that explain the answer
    Column("in_other_order", Boolean, nullable=False),
    Column("says", SafeText, nullable=False),  #: Markdown
    Column("feedback", SafeText, nullable=False),
)

#: Decision of a person on an answer; it counts until the next one on the same answer. ``answer`` is the text
#: that they saw.
decision = Table(
    "decision",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("student", SafeText, nullable=False),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),  #: empty for any variant of the student
    Column("part", SafeText, nullable=False),
    Column("kind", String(16), nullable=False),  #: accepted, given, kept, withdrawn
    Column("points", Double),  #: none for full points
    Column("reason", SafeText, nullable=False, default=""),
    Column("answer", SafeText),
    Column("by", SafeText, nullable=False),  #: person, or file that states it
    Column("made", UTCDateTime, nullable=False),
    Column("lasting_id", SafeText),  #: name that files and withdrawals use; none before there were such names
    Column("withdraws", SafeText),  #: of a withdrawal, the name of what it takes back
)

#: Placing of a rejected row by a person: as a submission of its own, or put aside. ``row`` is its digest.
placing = Table(
    "placing",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("row", String(64), nullable=False),
    _of("submission", null=True),
    Column("reason", SafeText, nullable=False, default=""),
    Column("by", SafeText, nullable=False),
    Column("made", UTCDateTime, nullable=False),
)

#: File in which people write decisions, as last read or written: differences from it are new decisions.
worksheet = Table(
    "worksheet",
    METADATA,
    _key(),
    _of("assignment"),
    Column("file", String(64), nullable=False),  #: digest of its path
    Column("lines", Json, nullable=False),
    UniqueConstraint("assignment_id", "file"),
)

#: Page of a scan: its reading (:class:`coursework.scanning.scan_store.PageScan`), and its picture, a JPEG in
#: base64. A file without a readable page has one row without a number.
scanned = Table(
    "scanned",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("page", String(40), nullable=False),  #: digest of the file, and number
    Column("file", SafeText, nullable=False),
    Column("number", Integer, nullable=False),
    Column("student", SafeText, nullable=False, default=""),  #: empty if unknown
    Column("reading", Json, nullable=False),
    Column("picture", SafeText, nullable=False, default=""),
    Column("received_at", UTCDateTime, nullable=False),
    UniqueConstraint("assignment_id", "page"),
)

#: Text typed by a person for an unreadable place of a scan: the last of a place counts. ``seen`` are the
#: pages shown to them.
typed = Table(
    "typed",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("student", SafeText, nullable=False),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),
    Column("part", SafeText, nullable=False),
    Column("coordinate", SafeText, nullable=False, default=""),
    Column("answer", SafeText),  #: none if it was withdrawn
    Column("seen", SafeText, nullable=False, default=""),
    Column("by", SafeText, nullable=False),
    Column("made", UTCDateTime, nullable=False),
)

# --------------------------------------------------------------------------- site

#: Entry of a person's progress in practice.
progress = Table(
    "progress",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("entry", Json, nullable=False),
    Column("digest", String(64), nullable=False),
    UniqueConstraint("person_id", "digest"),
)

#: Draft: typed text that is not submitted yet, one row per box.
draft = Table(
    "draft",
    METADATA,
    _key(),
    _of("person"),
    #: ``practice/EXERCISE/SEED``, ``assignment/ID``, ``lessons`` or ``lessons/NAME``.
    Column("sheet", SafeText, nullable=False),
    Column("box", SafeText, nullable=False),  #: a part; of a paper ``EXERCISE/PART``
    Column("text", SafeText, nullable=False),
    Column("version", Integer, nullable=False),  #: counts the changes
    Column("changed", UTCDateTime, nullable=False),
    UniqueConstraint("person_id", "sheet", "box"),
)

#: Cached page of a paper, made before the assignment opens, without typed text
#: (:mod:`coursework.database.prepared`).
prepared = Table(
    "prepared",
    METADATA,
    _key(),
    _of("assignment"),
    _of("person", index=True),
    Column("lang", SafeText, nullable=False),
    Column("state", String(64), nullable=False),  #: digest of everything on which the page depends
    Column("head", CompressedText, nullable=False),
    Column("body", CompressedText, nullable=False),
    UniqueConstraint("assignment_id", "person_id", "lang"),
    info={"derived": True},
)

#: Cached counts and table of a class (:mod:`coursework.database.class_summaries`).
class_summary = Table(
    "class_summary",
    METADATA,
    _key(),
    Column("assignment_id", ForeignKey("assignment.id", ondelete="CASCADE"), nullable=False, unique=True),
    Column("state", String(64), nullable=False),  #: digest of everything on which the summary depends
    Column("students", Integer, nullable=False),
    Column("handed_in", Integer, nullable=False),
    Column("waiting", Integer, nullable=False),
    Column("content", CompressedText, nullable=False),  #: JSON of the table
    info={"derived": True},
)

#: Extension: other dates or another number of attempts for one person; the last counts.
extension = Table(
    "extension",
    METADATA,
    _key(),
    _of("assignment", index=True),
    _of("person", index=True),
    Column("closes", UTCDateTime),
    Column("tries", Integer),
    Column("minutes", Integer),  #: working time from the start of the paper
    Column("reason", SafeText, nullable=False, default=""),
    Column("by", SafeText, nullable=False),
    Column("made", UTCDateTime, nullable=False),
)

#: Start of a paper with a working time, which counts from then on; a make-up is another paper, and has its
#: own.
paper_start = Table(
    "paper_start",
    METADATA,
    _key(),
    _of("assignment"),
    _of("person", index=True),
    Column("sitting", Integer, nullable=False),
    Column("started", UTCDateTime, nullable=False),
    Column("ended", UTCDateTime, index=True),  #: time at which its end was recorded as passed
    UniqueConstraint("assignment_id", "person_id", "sitting"),
)

#: Job of a background worker: a submission to mark, drafts to submit after the closing date, a page to
#: prepare. The row is deleted when the job is done; one with a ``fault`` is given up and needs a person.
job = Table(
    "job",
    METADATA,
    _key(),
    Column("kind", String(16), nullable=False),  #: mark, rescue, prepare
    _of("assignment", index=True),
    _of("submission", null=True, index=True),
    _of("person", null=True, index=True),
    Column("tries", Integer, nullable=False, default=0),  #: number of attempts
    Column("worker", String(64), nullable=False, default=""),  #: last worker
    Column("until", UTCDateTime),  #: end of the worker's lease; none while no worker has it
    Column("fault", SafeText, nullable=False, default=""),  #: reason for giving it up
    Column("made", UTCDateTime, nullable=False),
)

#: Setting of the site, such as the key that signs its cookies.
setting = Table(
    "setting",
    METADATA,
    Column("name", String(100), primary_key=True),
    Column("value", SafeText, nullable=False),
)

#: Entry of the audit log.
audit = Table(
    "audit",
    METADATA,
    _key(),
    Column("at", UTCDateTime, nullable=False, index=True),
    Column("by", SafeText, nullable=False),  #: who did it
    Column("what", SafeText, nullable=False),
    Column("about", Json, nullable=False, default=dict),  #: never an answer
    Column("actor", Integer),  #: id of the person who did it; none for commands and platforms
    Column("subject", Integer, index=True),  #: id of the person concerned
    Column("address", String(64)),  #: network address of the actor
)

# ------------------------------------------------------------- learning platforms

#: Nonce of a launch, as a digest: a launch counts once.
lti_nonce = Table(
    "lti_nonce",
    METADATA,
    _key(),
    Column("digest", String(64), nullable=False, unique=True),
    Column("until", UTCDateTime, nullable=False, index=True),
    info={"fleeting": True},
)

#: Session of a launch in a frame of a platform. Dumps omit it.
lti_session = Table(
    "lti_session",
    METADATA,
    _key(),
    Column("name", String(16), nullable=False, unique=True),  #: in the addresses of its pages
    Column("digest", String(64), nullable=False),  #: of the browser's token
    Column("issuer", SafeText, nullable=False),
    Column("subject", SafeText, nullable=False),
    Column("launch", Json, nullable=False),
    Column("until", UTCDateTime, nullable=False, index=True),
    info={"fleeting": True},
)

#: Last launch of a student in a link, without e-mail and number, and the score that the platform receives for
#: it.
lti_launch = Table(
    "lti_launch",
    METADATA,
    _key(),
    _of("person", index=True),
    _of("assignment", index=True),
    Column("link", String(64), nullable=False),  #: digest of platform, deployment and link
    Column("launch", Json, nullable=False),
    Column("line", SafeText, nullable=False, default=""),  #: column of the gradebook to which the score goes
    Column("given", Double),  #: points; none before there is a score
    Column("maximum", Double),
    Column("comment", SafeText, nullable=False, default=""),
    Column("waits", Boolean, nullable=False, default=False),  #: some answers wait for a person
    Column("stamp", UTCDateTime),  #: of the score, as sent to the platform; a later one is larger
    Column("due", UTCDateTime, index=True),  #: time of the next attempt; none once the score has arrived
    Column("failures", Integer, nullable=False, default=0),
    Column("problem", SafeText, nullable=False, default=""),  #: of the last attempt
    UniqueConstraint("person_id", "link"),
)

#: Course of a platform, with the address of its roster.
lti_course = Table(
    "lti_course",
    METADATA,
    _key(),
    Column("digest", String(64), nullable=False, unique=True),  #: of platform, deployment and course
    Column("issuer", SafeText, nullable=False),
    Column("client", SafeText, nullable=False),
    Column("title", SafeText, nullable=False),
    Column("memberships", SafeText, nullable=False),
    Column("seen", UTCDateTime, nullable=False),
)

for _table in METADATA.tables.values():  # an id is never used again after its row was erased
    _table.dialect_options["sqlite"]["autoincrement"] = "id" in _table.c
