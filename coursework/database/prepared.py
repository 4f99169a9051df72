"""Cache of the pages of papers, made before an assignment opens and shared by all processes. A dump omits it,
since the pages can be made again."""

from __future__ import annotations

from datetime import datetime
from typing import NamedTuple

from sqlalchemy import ColumnElement, Connection, delete, insert, literal, select

from coursework.database.jobs import PREPARE
from coursework.database.store import put_rows
from coursework.database.tables import UTCDateTime, issue, job, person, prepared, variant


class PreparedPieces(NamedTuple):
    """Parts of a page that contain a paper, as HTML, with empty boxes."""

    head: str
    body: str


def prepared_state(connection: Connection, number: int, person_id: int, lang: str) -> str:
    """Return the state of a cached page; empty if there is none."""
    query = select(prepared.c.state).where(*_key(number, person_id, lang))
    return str(connection.execute(query).scalar() or "")


def prepared_pieces(
    connection: Connection, number: int, person_id: int, lang: str, state: str
) -> PreparedPieces | None:
    """Return the cached page of exactly this state; None if there is none."""
    query = select(prepared.c.head, prepared.c.body).where(
        *_key(number, person_id, lang), prepared.c.state == state
    )
    row = connection.execute(query).first()
    return None if row is None else PreparedPieces(row.head, row.body)


def put_prepared(
    connection: Connection, number: int, person_id: int, lang: str, state: str, pieces: PreparedPieces
) -> None:
    """Store a page, in place of that of another state."""
    row = {"assignment_id": number, "person_id": person_id, "lang": lang, "state": state, **pieces._asdict()}
    put_rows(connection, prepared, [row], ("assignment_id", "person_id", "lang"))


def drop_prepared(connection: Connection, number: int) -> None:
    """Delete the pages of an assignment that nobody fills in any more, and the jobs that prepare them."""
    connection.execute(delete(prepared).where(prepared.c.assignment_id == number))
    connection.execute(delete(job).where(job.c.assignment_id == number, job.c.kind == PREPARE))


def prepare_later(connection: Connection, number: int, at: datetime, person_id: int | None = None) -> None:
    """Add a job for each person with a paper of an assignment, or for one person, unless such a job waits
    already."""
    theirs = select(issue.c.person_id).join(variant).where(variant.c.assignment_id == number)
    waits = select(job.c.person_id).where(
        job.c.assignment_id == number, job.c.kind == PREPARE, job.c.until.is_(None)
    )
    wanted = select(literal(PREPARE), literal(number), person.c.id, literal(at, UTCDateTime)).where(
        person.c.id.in_(theirs), person.c.id.not_in(waits)
    )
    if person_id is not None:
        wanted = wanted.where(person.c.id == person_id)
    columns = [job.c.kind, job.c.assignment_id, job.c.person_id, job.c.made]
    connection.execute(insert(job).from_select(columns, wanted.order_by(person.c.id)))


def _key(number: int, person_id: int, lang: str) -> tuple[ColumnElement[bool], ...]:
    return prepared.c.assignment_id == number, prepared.c.person_id == person_id, prepared.c.lang == lang
