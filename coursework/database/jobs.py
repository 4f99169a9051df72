"""Queue of the jobs of background workers: each job is taken by one worker at a time.

A worker has a lease on the job that it has begun. If the worker is killed, the job is taken again: at once by
a worker of the same name, by any other after the end of the lease. A job that fails too often is given up,
and its fault is stored.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import NamedTuple

from sqlalchemy import Connection, delete, func, insert, or_, select, update

from coursework.database.tables import job

MARK, RESCUE, PREPARE = "mark", "rescue", "prepare"
MOST_TRIES = 3
_LEASE = timedelta(minutes=2)  #: after which another worker takes what one has begun


class WorkerJob(NamedTuple):
    """Job of a background worker."""

    id: int
    #: ``mark``: a submission; ``rescue``: drafts of a person when an assignment has closed; ``prepare``: a
    #: person's page.
    kind: str
    assignment: int
    submission: int | None
    person: int | None
    tries: int  #: how often it was begun, this time included
    fault: str
    added_at: datetime


_HANDED_IN = job.c.kind != PREPARE
_COLUMNS = (
    job.c.id,
    job.c.kind,
    job.c.assignment_id,
    job.c.submission_id,
    job.c.person_id,
    job.c.tries,
    job.c.fault,
    job.c.made,
)


def put_job(
    connection: Connection,
    kind: str,
    assignment: int,
    at: datetime,
    *,
    submission: int | None = None,
    person: int | None = None,
) -> None:
    """Add a job, in the transaction that requires it."""
    row = {
        "kind": kind,
        "assignment_id": assignment,
        "submission_id": submission,
        "person_id": person,
        "made": at,
    }
    connection.execute(insert(job).values(row))


def waiting(connection: Connection) -> tuple[int, datetime | None, datetime | None]:
    """Return the number of submissions that wait for their marks, and the times at which the first and the
    last were added."""
    query = select(func.count(), func.min(job.c.id), func.max(job.c.id)).where(job.c.fault == "", _HANDED_IN)
    count, first, last = connection.execute(query).one()
    ends = {
        row.id: row.made
        for row in connection.execute(select(job.c.id, job.c.made).where(job.c.id.in_((first, last))))
    }
    return int(count), ends.get(first), ends.get(last)


def is_any(connection: Connection) -> bool:
    """Return True if a job is left that is not given up."""
    return connection.execute(select(job.c.id).where(job.c.fault == "").limit(1)).first() is not None


def take_job(connection: Connection, worker: str, at: datetime) -> WorkerJob | None:
    """Take the first free job and count the attempt; return None if there is none. Pages are prepared last.

    A job that was begun :data:`MOST_TRIES` times is given up: it killed its worker.
    """
    while True:
        is_free = or_(job.c.until.is_(None), job.c.until < at, job.c.worker == worker)
        in_order = _HANDED_IN.desc(), job.c.tries, job.c.id
        query = select(*_COLUMNS).where(job.c.fault == "", is_free).order_by(*in_order).limit(1)
        row = connection.execute(query.with_for_update(skip_locked=True)).first()
        if row is None:
            return None
        if row.tries >= MOST_TRIES:
            give_up(connection, row.id, "the worker ended")
            continue
        begun = {"tries": row.tries + 1, "worker": worker, "until": at + _LEASE}
        connection.execute(update(job).where(job.c.id == row.id).values(begun))
        return WorkerJob(*row)._replace(tries=row.tries + 1)


def drop_job(connection: Connection, number: int) -> None:
    """Delete a job that is done."""
    connection.execute(delete(job).where(job.c.id == number))


def drop_jobs(connection: Connection, submission: int) -> None:
    """Delete the jobs that mark a submission, which is marked."""
    connection.execute(delete(job).where(job.c.submission_id == submission))


def put_back(connection: Connection, failed: WorkerJob, fault: str) -> bool:
    """Release a failed job for another attempt, or give it up after :data:`MOST_TRIES`; return True if it is
    given up."""
    if failed.tries >= MOST_TRIES:
        give_up(connection, failed.id, fault)
        return True
    connection.execute(update(job).where(job.c.id == failed.id).values(worker="", until=None))
    return False


def give_up(connection: Connection, number: int, fault: str) -> None:
    """Give up a job; one that prepares a page is deleted, since the page is made on request."""
    connection.execute(delete(job).where(job.c.id == number, ~_HANDED_IN))
    connection.execute(update(job).where(job.c.id == number).values(fault=fault, worker="", until=None))


def job_of(connection: Connection, submission: int) -> WorkerJob | None:
    """Return the job that marks a submission; None if it is marked, or no job was added."""
    row = connection.execute(
        select(*_COLUMNS).where(job.c.submission_id == submission, job.c.kind == MARK)
    ).first()
    return None if row is None else WorkerJob(*row)


def jobs_before(connection: Connection, later: WorkerJob) -> int:
    """Return the number of jobs ahead of one."""
    query = select(func.count()).where(job.c.fault == "", job.c.id < later.id, _HANDED_IN)
    return int(connection.execute(query).scalar_one())
