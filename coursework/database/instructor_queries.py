"""Queries of the instructor's pages: changes since a stamp, decisions made meanwhile, decisions that can be
undone, and the placing of rejected rows."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Collection, Mapping
from datetime import UTC, datetime
from typing import Any, NamedTuple
from zlib import crc32

from sqlalchemy import Column, Connection, Select, Text, cast, delete, func, insert, select

from coursework.database.decisions import stored_decision
from coursework.database.publication import Publication
from coursework.database.tables import (
    answer,
    assignment,
    decision,
    extension,
    issue,
    marking,
    placing,
    progress,
    submission,
    variant,
)
from coursework.gradebook.decisions import WITHDRAWN, Decision
from coursework.issuing.assignment import text_in

_BESIDE = 50  #: numbers before the last that may be seen after it


class Stamp(NamedTuple):
    """State of an assignment in counts and last ids of its append-only tables; it differs as soon as
    something is new."""

    markings: tuple[int, int]
    decisions: tuple[int, int]
    submissions: tuple[int, int]
    placings: tuple[int, int]
    issued: tuple[int, int]
    rules: tuple[int, int]  #: of publication, extensions and what is stated

    def __str__(self) -> str:
        return ".".join(f"{count}-{last}" for count, last in self)

    @staticmethod
    def read(text: str) -> Stamp | None:
        """Return the stamp that a text states; None if it states none."""
        match = re.fullmatch(r"\.".join(["([0-9]{1,15})-([0-9]{1,15})"] * 6), text, re.ASCII)
        if match is None:
            return None
        numbers = [int(digits) for digits in match.groups()]
        return Stamp(*((numbers[k], numbers[k + 1]) for k in range(0, 12, 2)))


def stamp(connection: Connection, assignment_id: int) -> Stamp:
    """Return the stamp of an assignment."""
    return stamps(connection, [assignment_id])[assignment_id]


def stamps(connection: Connection, assignment_ids: Collection[int]) -> dict[int, Stamp]:
    """Return the stamp of each assignment, from a few small queries."""
    counts: dict[int, list[tuple[int, int]]] = {number: [] for number in assignment_ids}
    for table in (marking, decision, submission, placing):
        last_ids = select(table.c.assignment_id, func.count(), func.max(table.c.id))
        _add_counts(connection, counts, last_ids, table.c.assignment_id)
    given = select(variant.c.assignment_id, func.count(), func.max(issue.c.id))
    _add_counts(connection, counts, given.select_from(issue.join(variant)), variant.c.assignment_id)
    stated = select(assignment.c.id, assignment.c.published, assignment.c.stated)
    rules = {
        number: crc32(json.dumps([list(row)], sort_keys=True).encode())
        for number, *row in connection.execute(stated.where(assignment.c.id.in_(counts)))
    }
    more = select(extension.c.assignment_id, func.max(extension.c.id)).group_by(extension.c.assignment_id)
    last = dict(connection.execute(more.where(extension.c.assignment_id.in_(counts))).all())
    return {
        number: Stamp._make([*pairs, (rules.get(number, crc32(b"[]")), last.get(number, 0))])
        for number, pairs in counts.items()
    }


def _add_counts(
    connection: Connection,
    counts: Mapping[int, list[tuple[int, int]]],
    query: Select[Any],
    number: Column[int],
) -> None:
    """Append the number of rows and the last id of each assignment, ``0, 0`` without any."""
    rows = connection.execute(query.where(number.in_(counts)).group_by(number))
    found = {row[0]: (row[1], row[2]) for row in rows}
    for assignment_id, pairs in counts.items():
        pairs.append(found.get(assignment_id, (0, 0)))


class AssignmentOverview(NamedTuple):
    """Assignment in the list of the instructor's pages."""

    id: int
    name: str
    stated: Mapping[str, Any]
    definition: Mapping[str, Any] | None
    published: Mapping[str, Any] | None
    created: datetime
    columns: str  #: of the roster, as JSON
    submissions: int
    last: datetime | None  #: time of the last submission

    @property
    def publication(self) -> Publication | None:
        return None if self.published is None else Publication.of(self.published)

    def title(self, lang: str) -> str:
        """Return the title, or the name if it has none."""
        return text_in(self.stated.get("title") or {}, lang) or self.name


_LISTED = (
    assignment.c.id,
    assignment.c.name,
    assignment.c.stated,
    assignment.c.asked,
    assignment.c.published,
    assignment.c.created,
    cast(assignment.c.columns, Text).label("roster"),
)


def listed_assignments(connection: Connection, assignment_id: int | None = None) -> list[AssignmentOverview]:
    """Return the assignments, the latest first; one alone if given."""
    query = (
        select(*_LISTED, func.count(submission.c.id), func.max(submission.c.id))
        .select_from(assignment.outerjoin(submission))
        .group_by(assignment.c.id)
        .order_by(assignment.c.id.desc())
    )
    if assignment_id is not None:
        query = query.where(assignment.c.id == assignment_id)
    rows = connection.execute(query).all()
    last = select(submission.c.id, submission.c.received_at).where(
        submission.c.id.in_([row[-1] for row in rows if row[-1]])
    )
    received_at = {row.id: row.received_at for row in connection.execute(last)}
    return [
        AssignmentOverview._make((*row[:2], row.stated or {}, *row[3:-1], received_at.get(row[-1])))
        for row in rows
    ]


def people_counts(connection: Connection) -> tuple[Counter[int], Counter[int]]:
    """Return the numbers of people with a paper, and of those who submitted something, by assignment."""
    with_paper = select(variant.c.assignment_id, func.count(issue.c.student.distinct())).join(issue)
    with_paper = with_paper.where(issue.c.person_id.is_not(None)).group_by(variant.c.assignment_id)
    submitted = select(submission.c.assignment_id, func.count(submission.c.person_id.distinct()))
    queries = with_paper, submitted.group_by(submission.c.assignment_id)
    holders, authors = (Counter({row[0]: row[1] for row in connection.execute(q)}) for q in queries)
    return holders, authors


# --------------------------------------------------------------------- decisions


def decided_since(connection: Connection, assignment_id: int, after: int) -> list[Decision]:
    """Return the decisions with an id above a number, in their order."""
    query = select(decision).where(decision.c.assignment_id == assignment_id, decision.c.id > after)
    return [stored_decision(row) for row in connection.execute(query.order_by(decision.c.id))]


def undoable(connection: Connection, assignment_id: int, by: str) -> list[Decision]:
    """Return the latest batch of decisions of a person that can be undone: no later decision replaces
    them."""
    query = select(decision).where(decision.c.assignment_id == assignment_id, decision.c.student != "")
    query = query.order_by(decision.c.id.desc())
    met: set[tuple[str, ...]] = set()
    batch: list[Decision] = []
    for row in connection.execute(query):
        decided = stored_decision(row)
        key = decided.student, decided.exercise, decided.seed, decided.part
        if batch and (decided.made != batch[0].made or decided.by != by):
            break
        if key not in met and decided.by == by and decided.kind != WITHDRAWN:
            batch.append(decided)
        met.add(key)
    return batch[::-1]


# ---------------------------------------------------------------------- rejected


class Placing(NamedTuple):
    """Placing of a rejected row by a person."""

    row: str  #: digest
    submission_id: int | None  #: of the answer that was made of it; none where it was put aside
    reason: str
    by: str
    made: datetime


def placings(connection: Connection, assignment_id: int) -> dict[str, Placing]:
    """Return the placings of rejected rows by digest; the last of each row counts."""
    query = select(placing).where(placing.c.assignment_id == assignment_id).order_by(placing.c.id)
    rows = connection.execute(query)
    return {row.row: Placing(row.row, row.submission_id, row.reason, row.by, row.made) for row in rows}


def put_placing(connection: Connection, assignment_id: int, placed: Placing) -> None:
    """Store the placing of a rejected row."""
    connection.execute(insert(placing).values(assignment_id=assignment_id, **placed._asdict()))


def drop_placing(connection: Connection, assignment_id: int, row: str) -> None:
    """Delete the placing of a row that was put aside, so that it waits again."""
    is_put_aside = (
        placing.c.assignment_id == assignment_id,
        placing.c.row == row,
        placing.c.submission_id.is_(None),
    )
    connection.execute(delete(placing).where(*is_put_aside))


# ------------------------------------------------------------------- submissions


class SiteSubmissions(NamedTuple):
    """Submissions of a student on the site: the number of attempts, and the last of them."""

    attempts: int
    last: datetime
    late: int  #: seconds, of the last one


def site_submissions_of(connection: Connection, assignment_id: int) -> dict[str, SiteSubmissions]:
    """Return the submissions on the site, by the student's name as issued."""
    names = {person: name for name, person in people_of(connection, assignment_id).items()}
    query = (
        select(submission.c.person_id, submission.c.received_at, submission.c.late)
        .where(submission.c.assignment_id == assignment_id, submission.c.person_id.is_not(None))
        .order_by(submission.c.id)
    )
    met: dict[str, SiteSubmissions] = {}
    for person, received_at, late in connection.execute(query):
        if (name := names.get(person)) is not None:
            met[name] = SiteSubmissions(met[name].attempts + 1 if name in met else 1, received_at, late)
    return met


def unmarked(connection: Connection, assignment_id: int, before: datetime) -> list[int]:
    """Return the ids of submissions on the site that were received before a moment and are not marked yet."""
    theirs = select(answer.c.student).where(answer.c.submission_id == submission.c.id)
    marked = select(marking.c.id).where(
        marking.c.assignment_id == assignment_id,
        marking.c.attempt == submission.c.number,
        marking.c.student.in_(theirs),
    )
    query = select(submission.c.id).where(
        submission.c.assignment_id == assignment_id,
        submission.c.number > 0,
        submission.c.received_at < before,
        ~marked.exists(),
    )
    return list(connection.execute(query.order_by(submission.c.id)).scalars())


def students_since(connection: Connection, assignment_id: int, before: Stamp) -> set[str]:
    """Return the students with a sheet marked or decided on since a stamp. Some rows before the last of the
    stamp count too: with concurrent writers, ids do not become visible in order."""
    students: set[str] = set()
    for table, (_, last) in ((marking, before.markings), (decision, before.decisions)):
        query = select(table.c.student).where(
            table.c.assignment_id == assignment_id, table.c.id > last - _BESIDE
        )
        students.update(connection.execute(query.distinct()).scalars())
    return students


def people_of(connection: Connection, assignment_id: int) -> dict[str, int]:
    """Return the person's id of each student of an assignment, by the name as issued."""
    query = (
        select(issue.c.student, issue.c.person_id)
        .join(variant)
        .where(variant.c.assignment_id == assignment_id, issue.c.person_id.is_not(None))
        .distinct()
    )
    return {row.student: row.person_id for row in connection.execute(query)}


def practised(
    connection: Connection, person: int, exercises: Collection[str]
) -> dict[str, tuple[int, datetime | None]]:
    """Return the number of variants of each exercise that a person practised alone, and the time of the last;
    never an answer."""
    named = progress.c.entry["exercise"].as_string()
    query = select(
        named.label("exercise"),
        progress.c.entry["seed"].as_string().label("seed"),
        progress.c.entry["at"].as_string().label("at"),
    ).where(progress.c.person_id == person, named.in_(list(exercises)))
    seeds: dict[str, set[str]] = {}
    last: dict[str, str] = {}
    for row in connection.execute(query):
        seeds.setdefault(row.exercise, set()).add(str(row.seed))
        last[row.exercise] = max(last.get(row.exercise, ""), row.at or "")
    return {name: (len(exercise_seeds), _moment(last[name])) for name, exercise_seeds in seeds.items()}


def _moment(text: str) -> datetime | None:
    try:
        at = datetime.fromisoformat(text)
    except ValueError:
        return None
    return at.replace(tzinfo=UTC) if at.tzinfo is None else at
