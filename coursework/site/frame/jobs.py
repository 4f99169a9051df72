"""Jobs of the site, in a thread of their own so that no student waits for them.

The state of a job is in the database, so that every process of the site can show it.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextvars import copy_context
from datetime import datetime, timedelta
from typing import Any, NamedTuple, TypeVar

from coursework.database.settings import put_value, value_of
from coursework.errors import CourseworkError
from coursework.site.frame.settings import Site
from coursework.system.processes import processes, workers

_PATIENCE = 1.5  #: seconds for which the request waits for the job
_GIVEN_UP = timedelta(minutes=60)  #: after which an unfinished job counts as interrupted
RUNNING, DONE, FAILED = "running", "done", "failed"

Result = TypeVar("Result")


class Job(NamedTuple):
    """State of a job."""

    state: str
    name: str  #: of what it works on
    size: int  #: number of papers or files
    result: int = 0  #: its result, at the end
    messages: tuple[str, ...] = ()  #: notes, or reasons of a failure

    @property
    def is_over(self) -> bool:
        return self.state != RUNNING


def begin(
    site: Site, key: str, name: str, size: int, work: Callable[[], tuple[int, tuple[str, ...]]]
) -> None:
    """Start a job, which returns its result and notes; return at its end or after a short wait."""
    begun = Job(RUNNING, name, size)
    store(site, key, begun)

    def run() -> None:
        try:
            result, notes = work()
            over = begun._replace(state=DONE, result=result, messages=notes)
        except CourseworkError as fault:
            over = begun._replace(state=FAILED, messages=(str(fault),))
        except Exception as fault:  # the page reports it, since nobody waits for this thread
            over = begun._replace(state=FAILED, messages=(type(fault).__name__,))
        store(site, key, over)

    # The context has the reader's language, in which faults are stored.
    thread = threading.Thread(target=copy_context().run, args=(run,), daemon=True)
    thread.start()
    thread.join(_PATIENCE)


def stored_job(site: Site, key: str) -> Job | None:
    """Return the state of the last job of a key; None if there was none. An interrupted job counts as failed:
    nothing of it was stored."""
    with site.store.reading() as connection:
        stored = value_of(connection, key)
    if stored is None:
        return None
    state, name, size, result, messages = stored["job"]
    job = Job(state, name, size, result, tuple(messages))
    if not job.is_over and site.clock() - datetime.fromisoformat(stored["at"]) > _GIVEN_UP:
        return job._replace(state=FAILED)
    return job


def store(site: Site, key: str, now: Job) -> None:
    """Store the state of a job."""
    with site.store.begin() as connection:
        put_value(connection, key, {"job": list(now), "at": site.clock().isoformat()})


def apart(function: Callable[..., Result], *arguments: Any) -> Result:
    """Return the result of a function, called in a process of its own where there is a second processor."""
    if workers(2) < 2:
        return function(*arguments)
    with processes(1) as submit:
        result: Result = submit(function, *arguments).result()
        return result
