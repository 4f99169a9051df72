"""Worker of the site: it marks submissions, submits saved answers and prepares pages, from a queue in the
database; when there is nothing to do, it counts the classes that have changed.

One process serves all server processes. It may be killed at any time: another one repeats its unfinished job.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from contextlib import suppress
from datetime import timedelta
from functools import partial

from sqlalchemy import select

from coursework.database.class_summaries import stored_counts, summary_states
from coursework.database.instructor_queries import listed_assignments, stamps, unmarked
from coursework.database.jobs import (
    MARK,
    PREPARE,
    RESCUE,
    WorkerJob,
    drop_job,
    drop_jobs,
    is_any,
    job_of,
    put_back,
    put_job,
    take_job,
    waiting,
)
from coursework.database.marking import mark_submission
from coursework.database.publication import passing, publications_of
from coursework.database.tables import assignment
from coursework.errors import CourseworkError
from coursework.site.desk.class_table import computed_table
from coursework.site.frame.lru_cache import LRUCache
from coursework.site.frame.settings import Site
from coursework.site.papers.opening import prepare, prepare_soon
from coursework.site.papers.submission import close_passed, rescue

LOG = logging.getLogger("coursework.site")
#: Delay after a date before saved answers are submitted, since a timely submission may still wait for the
#: database.
SETTLES = timedelta(seconds=20)
_POLL = 0.3  #: seconds between two checks of an empty queue
_DATES = 1.0  #: seconds between two checks of the dates
_COUNTS = 60.0  #: seconds between two counts of a class that changes all the time
#: Marking waits for a short time without submissions, so as not to slow a rush, but not for long.
_QUIET, _LONGEST = timedelta(seconds=0.5), timedelta(seconds=5)
_VARIANTS = 100  #: items of the cache: students may share a variant
_RECENT = timedelta(days=1)
_AWAY = 2.0  #: seconds before the next try if the database is unavailable


class Worker:
    """Worker of one site."""

    def __init__(self, site: Site, name: str):
        self.site, self.name = site, name
        self._variants = LRUCache(_VARIANTS)
        self._counted: dict[int, str] = {}  #: states of the classes when they were last counted

    def run(self) -> None:
        """Work until the process is asked to terminate."""
        self._log_faults(self.take_over)
        self._log_faults(self.prepare_all)
        dates = counts = 0.0
        while True:
            if time.monotonic() - dates > _DATES:
                self._log_faults(self.close)
                dates = time.monotonic()
            if self._log_faults(self.work_once):
                continue
            if time.monotonic() - counts > _COUNTS:
                self._log_faults(self.count_classes)
                counts = time.monotonic()
            time.sleep(_POLL)

    def _log_faults(self, work: Callable[[], bool | None]) -> bool:
        try:
            return bool(work())
        except CourseworkError as fault:
            LOG.error("the worker: %s", fault)
            time.sleep(_AWAY)
            return False

    def take_over(self) -> None:
        """Queue unmarked submissions without a job, such as those from a server without a worker or from a
        backup."""
        now = self.site.clock()
        with self.site.store.reading() as connection:
            numbers = list(connection.execute(select(assignment.c.id)).scalars())
            left = [
                (number, submission) for number in numbers for submission in unmarked(connection, number, now)
            ]
            left = [
                (number, submission) for number, submission in left if job_of(connection, submission) is None
            ]
        if left:
            with self.site.store.begin() as connection:
                for number, submission in left:
                    put_job(connection, MARK, number, now, submission=submission)

    def prepare_all(self) -> None:
        """Queue the preparation of pages of assignments that open soon or opened within a day, since a new
        version or course may change them. Older pages are made on request."""
        now = self.site.clock()
        with self.site.store.begin() as connection:
            for number, publication in publications_of(connection).items():
                if publication.opens is not None and publication.opens > now - _RECENT:
                    prepare_soon(self.site, connection, number)

    # --------------------------------------------------------------------- jobs

    def work_once(self) -> bool:
        """Do one job; return False if there is none to do now."""
        if not self._is_time():
            return False
        with self.site.store.begin() as connection:
            job = take_job(connection, self.name, self.site.clock())
        if job is None:
            return False
        try:
            self._do(job)
        except Exception as fault:
            self._failed(job, fault)
        return True

    def _is_time(self) -> bool:
        now, course = self.site.clock(), self.site.course
        with self.site.store.reading() as connection:
            self.site.follow(connection)
            count, first, last = waiting(connection)
            has_jobs = is_any(connection)
        if self.site.course is not course:
            self.prepare_all()
        if not count or first is None or last is None:
            return has_jobs
        is_rush = timedelta(0) <= now - last < _QUIET
        return not is_rush or now - first > _LONGEST

    def _do(self, job: WorkerJob) -> None:
        if job.kind == MARK and job.submission is not None:
            mark_submission(self.site.course, self.site.store, job.submission)
        elif job.kind == RESCUE and job.person is not None:
            rescue(self.site, job.assignment, job.person, self.site.clock())
        elif job.kind == PREPARE and job.person is not None:
            prepare(self.site, job.assignment, job.person, self.site.clock(), self._variants)
        with self.site.store.begin() as connection:
            drop_job(connection, job.id)
            if job.kind == MARK and job.submission is not None:
                drop_jobs(connection, job.submission)

    def _failed(self, job: WorkerJob, fault: Exception) -> None:
        name = type(fault).__name__
        with self.site.store.begin() as connection:
            is_over = put_back(connection, job, name)
        subject = {
            MARK: f"submission {job.submission}",
            RESCUE: f"what person {job.person} saved",
            PREPARE: f"the page of person {job.person}",
        }[job.kind]
        LOG.error(
            "%s of assignment %d failed, try %d%s: %s",
            subject,
            job.assignment,
            job.tries,
            " and last" if is_over else "",
            name,
        )

    # -------------------------------------------------------------------- dates

    def close(self) -> None:
        """Record the dates that have passed, and submit saved answers."""
        now = self.site.clock()
        with self.site.store.reading() as connection:
            publications = publications_of(connection)
            times = {
                number: now - SETTLES if one.takes_saved else now for number, one in publications.items()
            }
            passed = passing(connection, publications, times)
        for number in passed:
            close_passed(self.site, number, times[number], partial(self._later, number))

    def _later(self, number: int, person: int, fault: Exception) -> None:
        """Queue another try to submit a person's saved answers; its failure is logged."""
        with self.site.store.begin() as connection:
            put_job(connection, RESCUE, number, self.site.clock(), person=person)

    # ------------------------------------------------------------------- counts

    def count_classes(self) -> None:
        """Compute the tables of the classes that have changed, for the pages of all processes."""
        with self.site.store.reading() as connection:
            abouts = listed_assignments(connection)
            at = stamps(connection, [about.id for about in abouts])
            states = summary_states(connection, self.site.course, abouts, at)
            known = {
                **self._counted,
                **{number: states[number] for number in stored_counts(connection, states)},
            }
        for number, state in states.items():
            if known.get(number) == state:
                continue
            with self.site.store.reading() as connection:
                if is_any(connection):
                    return
            self._counted[number] = state  # once, even if this course cannot mark it
            with suppress(CourseworkError):
                computed_table(self.site, number)


def work(site: Site, name: str) -> None:
    """Work for a site until this process is asked to terminate."""
    Worker(site, name).run()
