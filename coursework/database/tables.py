"""Tables of the database. A row that records an event is added and never changed; the last of its kind is the
current one.

Times are UTC. Texts are as they came. JSON holds what other files define: records (:mod:`coursework.course.records`), what
``issued.json`` states, entries of progress (:mod:`coursework.selfstudy.progress`); it is kept as it was written, keys in
their order.
"""

from __future__ import annotations

import zlib
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
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

#: Somebody who answers, teaches or both. ``who`` is what a roster tells apart by: a number, an e-mail, else the folded name.
person = Table(
    "person",
    METADATA,
    _key(),
    Column("who", SafeText, nullable=False, unique=True),
    Column("name", SafeText, nullable=False),
    Column("lang", SafeText, nullable=False, default=""),
    Column("columns", Json, nullable=False, default=dict),  #: of the rosters that name them
    Column("created", UTCDateTime, nullable=False),
    Column("sessions_from", UTCDateTime),  #: written by earlier versions, and read by none
)

#: How somebody signs in with a password; what a password becomes is argon2's business.
account = Table(
    "account",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("login", SafeText, nullable=False, unique=True),
    Column("secret", SafeText, nullable=False, default=""),  #: none before the invitation is taken up
    Column("invitation", String(64), index=True),  #: digest of what the invitation's address ends with
    Column("invited_until", UTCDateTime),
    Column("joined", UTCDateTime),  #: when an invitation was taken up
    Column("role", String(16), nullable=False),  #: student, assistant, instructor, administrator
    Column("created", UTCDateTime, nullable=False),
    Column("closed", UTCDateTime),
)

#: A browser in which somebody is signed in. No dump holds it: what is restored signs nobody in.
session = Table(
    "session",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("digest", String(64), nullable=False, unique=True),  #: of the token that the browser holds
    Column("browser", SafeText, nullable=False, default=""),  #: "Firefox, Linux"
    Column("created", UTCDateTime, nullable=False),
    Column("seen", UTCDateTime, nullable=False),  #: the last use, to some minutes
    Column("until", UTCDateTime, nullable=False, index=True),  #: when it expires unless it is used
    info={"fleeting": True},
)

#: Assignments and groups in which an assistant works: in every assignment where none is named, in the whole class where no
#: group is.
area = Table(
    "area",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("assignment_id", ForeignKey("assignment.id", ondelete="CASCADE")),
    Column("class_group", SafeText),  #: whatever its case and spaces
)

#: Passwords that did not fit, by a keyed digest of login and network: no login can be read from it.
failure = Table(
    "failure",
    METADATA,
    Column("key", String(64), primary_key=True),
    Column("count", Integer, nullable=False),
    Column("last", UTCDateTime, nullable=False, index=True),
    info={"fleeting": True},
)

#: How a platform knows somebody.
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

#: What was issued under one name: an assignment, or a build of exercises. ``stated`` is what ``issued.json`` says of it.
assignment = Table(
    "assignment",
    METADATA,
    _key(),
    Column("name", SafeText, nullable=False, unique=True),
    Column("course", SafeText, nullable=False, default=""),  #: the course's name
    Column("stated", Json),  #: none for exercises without an assignment
    Column("has_roster", Boolean, nullable=False, default=False),
    Column("is_pool", Boolean, nullable=False, default=False),  #: a platform deals its variants out
    Column("columns", Json, nullable=False, default=dict),  #: of the roster, by student
    Column("asked", Json),  #: what its file says, for who comes late; none of a build of exercises
    #: keys the draws of who comes later; none of what was issued without one
    Column("secret", String(32)),
    Column("published", Json),  #: dates, tries, feedback, late rules; none while it is not published
    Column("created", UTCDateTime, nullable=False),
)

#: A variant that was issued; its record is what answers are marked against.
variant = Table(
    "variant",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),  #: whole, however large
    Column("letter", String(2), nullable=False, default=""),  #: A to Z, of versions that are dealt out
    Column("record", Json, nullable=False),
    UniqueConstraint("assignment_id", "exercise", "seed"),
)

#: Whose a variant is, in which sitting, in which language. Its place is that in ``issued.json``.
dealt = Table(
    "dealt",
    METADATA,
    _key(),
    _of("variant", index=True),
    _of("person", null=True, index=True),  #: nobody's where there is no roster
    Column("place", Integer, nullable=False),
    Column("student", SafeText, nullable=False, default=""),  #: the name as it was issued
    Column("sitting", Integer, nullable=False, default=1),
    Column("lang", SafeText, nullable=False, default=""),
)

# ------------------------------------------------------------------------ answers

#: What came in together: files, or what a person hands in on the site.
delivery = Table(
    "delivery",
    METADATA,
    _key(),
    _of("assignment", index=True),
    _of("person", null=True, index=True),  #: who handed in on the site; none for files
    Column("source", SafeText, nullable=False),
    Column("digest", String(64), nullable=False),  #: of what it holds: the same twice is one
    Column("number", Integer, nullable=False, default=0),  #: which try of the person; 0 for files
    Column("receipt", String(40), nullable=False, default=""),  #: what the person is given to show
    Column("late", Integer, nullable=False, default=0),  #: seconds after it closed for them
    Column("came", UTCDateTime, nullable=False),
    Column("replaced", UTCDateTime),  #: when a later file took its place; none while it counts
    UniqueConstraint("assignment_id", "digest"),
    UniqueConstraint("assignment_id", "person_id", "number"),
)

#: An answer as it came. Answers, what was rejected and what was seen of a delivery have their places in one order.
answer = Table(
    "answer",
    METADATA,
    _key(),
    _of("delivery", index=True),
    Column("place", Integer, nullable=False),
    Column("student", SafeText, nullable=False),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),
    Column("part", SafeText, nullable=False),
    Column("answer", Json),  #: a text, a number, or nothing
    Column("source", SafeText, nullable=False),
    Column("warning", SafeText, nullable=False, default=""),
    Column("lang", SafeText, nullable=False, default=""),
    Column("origin", Json),  #: what a platform tells of it (:class:`coursework.gradebook.rows.RowOrigin`)
)

#: What came and could not be placed or read, with its reason.
rejected = Table(
    "rejected",
    METADATA,
    _key(),
    _of("delivery", index=True),
    Column("place", Integer, nullable=False),
    Column("source", SafeText, nullable=False),
    Column("reason", SafeText, nullable=False),
    Column("row", Json, nullable=False, default=dict),
)

#: What a platform wrote of what came (:class:`coursework.gradebook.rows.PlatformFile`).
seen = Table(
    "seen",
    METADATA,
    _key(),
    _of("delivery", index=True),
    Column("place", Integer, nullable=False),
    Column("source", SafeText, nullable=False),
    Column("what", SafeText, nullable=False),
    Column("is_tree", Boolean, nullable=False, default=False),
)

# -------------------------------------------------------------------------- marks

#: A sheet marked: of which answers, by which state of course and engine. The last of a sheet stands; one of no state says
#: that nothing answers to it any more.
marking = Table(
    "marking",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("student", SafeText, nullable=False),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),  #: whole, however large
    Column("attempt", Integer, nullable=False, default=0),  #: where what came tells it, else 0
    Column("sitting", Integer, nullable=False, default=1),
    Column("state", String(64), nullable=False),  #: digest of record, answers, rules, course and engine
    Column("lang", SafeText, nullable=False, default=""),  #: of the sheet that came back
    Column("apart", Boolean, nullable=False, default=False),  #: a platform asked these parts alone
    Column("submitted", SafeText, nullable=False, default=""),  #: when, where a platform tells it
    Column("fault", SafeText, nullable=False, default=""),  #: why it cannot be marked
    Column("made", UTCDateTime, nullable=False),
    Index("ix_marking_sheet", "assignment_id", "student", "exercise", "seed"),
)

#: What became of one answer.
mark = Table(
    "mark",
    METADATA,
    _key(),
    _of("marking", index=True),
    Column("place", Integer, nullable=False),  #: on the sheet
    Column("part", SafeText, nullable=False),
    Column("came", Integer),  #: its place among what came; none where nothing did
    Column("answer", SafeText, nullable=False),
    Column("read_as", SafeText, nullable=False),
    Column("verdict", SafeText, nullable=False),
    Column("points", Double, nullable=False),
    Column("out_of", Double, nullable=False),
    Column("lang", SafeText, nullable=False),
    Column("matches", Json, nullable=False),  #: every verdict that explains the answer
    Column("in_other_order", Boolean, nullable=False),
    Column("says", SafeText, nullable=False),  #: Markdown
    Column("feedback", SafeText, nullable=False),
)

#: What a person decided of an answer, and who: it counts until another one of the same answer. ``answer`` is what they saw.
decision = Table(
    "decision",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("student", SafeText, nullable=False),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),  #: empty for whatever variant they have
    Column("part", SafeText, nullable=False),
    Column("kind", String(16), nullable=False),  #: accepted, given, kept, withdrawn
    Column("points", Double),  #: none for all of them
    Column("reason", SafeText, nullable=False, default=""),
    Column("answer", SafeText),
    Column("by", SafeText, nullable=False),  #: who, or the file that says it
    Column("made", UTCDateTime, nullable=False),
)

#: What became of a rejected row: placed by hand, as a delivery of its own, or put aside. ``row`` is its digest.
placing = Table(
    "placing",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("row", String(64), nullable=False),
    _of("delivery", null=True),
    Column("reason", SafeText, nullable=False, default=""),
    Column("by", SafeText, nullable=False),
    Column("made", UTCDateTime, nullable=False),
)

#: A file in which people write decisions, as it stood when it was last read or written: what is new in it is what differs.
worksheet = Table(
    "worksheet",
    METADATA,
    _key(),
    _of("assignment"),
    Column("file", String(64), nullable=False),  #: digest of where it stands
    Column("lines", Json, nullable=False),
    UniqueConstraint("assignment_id", "file"),
)

#: A page of a scan: what was read of it (:class:`coursework.scanning.kept.PageKept`), and its picture, a JPEG in base64. Of a
#: file of which no page can be read there is one without a number.
scanned = Table(
    "scanned",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("page", String(40), nullable=False),  #: digest of the file, and number
    Column("file", SafeText, nullable=False),
    Column("number", Integer, nullable=False),
    Column("student", SafeText, nullable=False, default=""),  #: whose it is, where that is known
    Column("kept", Json, nullable=False),
    Column("picture", SafeText, nullable=False, default=""),
    Column("came", UTCDateTime, nullable=False),
    UniqueConstraint("assignment_id", "page"),
)

#: What a person typed where a scan could not be read: the last of a place stands. ``seen`` are the pages that they looked at.
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
    Column("answer", SafeText),  #: none where it was withdrawn
    Column("seen", SafeText, nullable=False, default=""),
    Column("by", SafeText, nullable=False),
    Column("made", UTCDateTime, nullable=False),
)

# --------------------------------------------------------------------------- site

#: What somebody did alone: entries of progress.
progress = Table(
    "progress",
    METADATA,
    _key(),
    _of("person", index=True),
    Column("entry", Json, nullable=False),
    Column("digest", String(64), nullable=False),
    UniqueConstraint("person_id", "digest"),
)

#: What somebody has typed and not handed in, a row a box.
draft = Table(
    "draft",
    METADATA,
    _key(),
    _of("person"),
    Column("sheet", SafeText, nullable=False),  #: ``practice/EXERCISE/SEED`` or ``assignment/ID``
    Column("box", SafeText, nullable=False),  #: a part; of a paper ``EXERCISE/PART``
    Column("text", SafeText, nullable=False),
    Column("version", Integer, nullable=False),  #: counts the changes
    Column("changed", UTCDateTime, nullable=False),
    UniqueConstraint("person_id", "sheet", "box"),
)

#: The page of a paper, made before the assignment opens, without what somebody typed (:mod:`coursework.database.prepared`).
prepared = Table(
    "prepared",
    METADATA,
    _key(),
    _of("assignment"),
    _of("person", index=True),
    Column("lang", SafeText, nullable=False),
    Column("state", String(64), nullable=False),  #: digest of all that the page depends on
    Column("head", CompressedText, nullable=False),
    Column("body", CompressedText, nullable=False),
    UniqueConstraint("assignment_id", "person_id", "lang"),
    info={"derived": True},
)

#: Other dates or tries for one person; the last stands.
extension = Table(
    "extension",
    METADATA,
    _key(),
    _of("assignment", index=True),
    _of("person", index=True),
    Column("closes", UTCDateTime),
    Column("tries", Integer),
    Column("reason", SafeText, nullable=False, default=""),
    Column("by", SafeText, nullable=False),
    Column("made", UTCDateTime, nullable=False),
)

#: Work that a worker does beside the requests: hand-ins to mark, what was saved to be handed in once it closed, pages to
#: prepare. A row goes with its work; one with a ``fault`` is given up, and somebody has to look at it.
job = Table(
    "job",
    METADATA,
    _key(),
    Column("kind", String(16), nullable=False),  #: mark, rescue, prepare
    _of("assignment", index=True),
    _of("delivery", null=True, index=True),
    _of("person", null=True, index=True),
    Column("tries", Integer, nullable=False, default=0),  #: how often it was begun
    Column("worker", String(64), nullable=False, default=""),  #: which began it last
    Column("until", UTCDateTime),  #: when another worker may take it; none while nobody works at it
    Column("fault", SafeText, nullable=False, default=""),  #: why it was given up
    Column("made", UTCDateTime, nullable=False),
)

#: Small things of the site itself: the key that signs its cookies.
setting = Table(
    "setting",
    METADATA,
    Column("name", String(100), primary_key=True),
    Column("value", SafeText, nullable=False),
)

#: Who did what that another may ask about.
audit = Table(
    "audit",
    METADATA,
    _key(),
    Column("at", UTCDateTime, nullable=False, index=True),
    Column("by", SafeText, nullable=False),  #: who did it
    Column("what", SafeText, nullable=False),
    Column("about", Json, nullable=False, default=dict),  #: never an answer
    Column("actor", Integer),  #: id of the person who did it; none for commands and platforms
    Column("subject", Integer, index=True),  #: id of the person of whom it tells
    Column("address", String(64)),  #: of the machine from which it was done
)

# --------------------------------------------------------------------- aggregates
# What follows is computed from the tables above (:mod:`coursework.database.aggregates`), so that a page of the desk reads a
# page of rows and not a class. No dump holds it.

_DERIVED = {"derived": True}

#: Aggregates to be computed anew, noted in the transaction that changed what they are made of: those of a student, of
#: ``everybody``, or the ``rows`` that could not be placed.
outdated = Table(
    "outdated",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("kind", String(16), nullable=False),
    Column("student", SafeText, nullable=False, default=""),
    info=_DERIVED,
)

#: A student of a class: the sitting that counts, as ``summary.csv`` gives it.
student_total = Table(
    "student_total",
    METADATA,
    _key(),
    _of("assignment"),
    Column("student", SafeText, nullable=False),
    Column("search", SafeText, nullable=False),  #: folded name and identity
    Column("identity", SafeText, nullable=False, default=""),
    Column("place", BigInteger, nullable=False),  #: in the class
    Column("sitting", Integer, nullable=False),
    Column("points", Double, nullable=False),
    Column("out_of", Double, nullable=False),
    Column("charged", Double, nullable=False, default=0.0),  #: points that are taken off for lateness
    Column("mark", SafeText, nullable=False, default=""),
    Column("tries", Integer, nullable=False, default=0),
    Column("late", Integer, nullable=False, default=0),  #: seconds
    Column("waits", Integer, nullable=False, default=0),  #: answers that count and that nobody could mark yet
    Column("handed_in", Boolean, nullable=False, default=False),
    Column("answered", Boolean, nullable=False, default=False),  #: a sheet of theirs is marked
    Column("verdicts", Json, nullable=False, default=dict),
    Column("by_exercise", Json, nullable=False, default=dict),
    UniqueConstraint("assignment_id", "student"),
    Index("ix_student_total_place", "assignment_id", "place"),
    info=_DERIVED,
)

#: An answer of a class as it stands: last marked, and decided on; its texts are those of its row of ``mark``.
answer_now = Table(
    "answer_now",
    METADATA,
    _key(),
    _of("assignment"),
    Column("marking", Integer, nullable=False),
    Column("first", Integer, nullable=False),  #: marking of its sheet: the order in which sheets came
    Column("place", Integer, nullable=False),  #: on its sheet
    Column("student", SafeText, nullable=False),
    Column("exercise", SafeText, nullable=False),
    Column("seed", SafeText, nullable=False),
    Column("sitting", Integer, nullable=False),
    Column("part", SafeText, nullable=False),
    Column("verdict", SafeText, nullable=False),
    Column("points", Double, nullable=False),
    Column("out_of", Double, nullable=False),
    Column("by_hand", Boolean, nullable=False),
    Column("counts", Boolean, nullable=False),  #: its sitting counts
    Column("is_cell", Boolean, nullable=False),  #: it stands in the class table
    Column("is_listed", Boolean, nullable=False),  #: it is a line of ``marks.csv``
    Column("is_shown", Boolean, nullable=False),  #: something was answered, in a sitting that is looked at
    Column("wrote", String(16), nullable=False),  #: digest of the answer in one spelling
    Column("why", String(16)),  #: why a person may look at it (:data:`coursework.gradebook.waiting.WHY`)
    Column("card", String(16)),  #: of the queue: the same for all who wrote the same
    Column("decided", Boolean, nullable=False),
    Index("ix_answer_now_student", "assignment_id", "student"),
    Index("ix_answer_now_question", "assignment_id", "exercise", "part"),
    Index("ix_answer_now_card", "assignment_id", "card"),
    info=_DERIVED,
)

#: A row that could not be placed or marked; what became of it is told by ``placing``.
unplaced = Table(
    "unplaced",
    METADATA,
    _key(),
    _of("assignment", index=True),
    Column("row", String(64), nullable=False),  #: digest, as in ``placing``
    Column("student", SafeText, nullable=False, default=""),  #: as issued; empty for a stranger
    Column("near", SafeText, nullable=False, default=""),  #: whose name is like that of a stranger
    Column("source", SafeText, nullable=False),
    Column("reason", SafeText, nullable=False),
    Column("said", Json, nullable=False, default=dict),
    info=_DERIVED,
)

#: What an assignment comes to.
assignment_total = Table(
    "assignment_total",
    METADATA,
    _key(),
    _of("assignment"),
    Column("students", Integer, nullable=False, default=0),
    Column("handed_in", Integer, nullable=False, default=0),
    Column("answered", Integer, nullable=False, default=0),
    Column("waiting", Integer, nullable=False, default=0),  #: answers and rows that wait for a person
    Column("facts", Json, nullable=False, default=dict),  #: what bears on the points of all
    Column("version", Integer, nullable=False, default=0),  #: counts how often it was computed
    UniqueConstraint("assignment_id"),
    info=_DERIVED,
)

for _table in METADATA.tables.values():  # the number of a row that was erased is never given to another
    _table.dialect_options["sqlite"]["autoincrement"] = "id" in _table.c
