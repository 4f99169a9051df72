"""Budgets of requests: the size of a body, the requests of one person that are answered at once, the means of who reads a file."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncIterator, Callable, Hashable, Mapping
from concurrent.futures import Future
from contextlib import asynccontextmanager
from threading import Lock
from types import MappingProxyType
from typing import Any, NamedTuple

from coursework.errors import BadInput
from coursework.system.processes import Exceeded, Means, confined

KILOBYTE, MEGABYTE = 1024, 1024 * 1024


class Budget(NamedTuple):
    """Limits of the requests to a page."""

    name: str
    largest: int  #: bytes of a body, refused by what its head says
    fields: int  #: of a form
    at_once: int  #: requests of one person that are answered at once; the others wait
    files: int = 0
    by_ending: Mapping[str, int] = MappingProxyType(
        {}
    )  #: bytes of a file, where those of an ending have fewer
    reading: Means | None = None  #: limits of the process in which files are read
    readings: int = 1  #: of this budget, how many at once in a process of the site


#: Pages without answers: a choice, a name, a password.
PLAIN = Budget("plain", 16 * KILOBYTE, 60, 2)
#: Answers in boxes: as many as a paper has, each of 4000 characters at most.
BOXES = Budget("boxes", 256 * KILOBYTE, 1000, 2)
#: Handing in: in a queue of its own, which nothing else of the same person fills.
HAND_IN = Budget("hand_in", 256 * KILOBYTE, 1000, 1)
#: A file of answers. A notebook brings its figures with it.
ANSWER_FILE = Budget(
    "answer_file", 2 * MEGABYTE + 4 * KILOBYTE, 20, 1, 1, MappingProxyType({".csv": 256 * KILOBYTE, ".json": 256 * KILOBYTE}),
    Means(4.0, 192 * MEGABYTE), 2,
)  # fmt: skip
#: The file of one's own practice.
PROGRESS_FILE = Budget(
    "progress_file", MEGABYTE + 4 * KILOBYTE, 20, 1, 1, reading=Means(4.0, 192 * MEGABYTE), readings=2
)
#: Forms of the staff.
DESK = Budget("desk", 256 * KILOBYTE, 2000, 4)
#: Files of the staff: a class's answers, scans, rosters.
DESK_FILES = Budget(
    "desk_files", 60 * MEGABYTE, 2000, 1, 50, reading=Means(60.0, 1024 * MEGABYTE), readings=1
)
DESK_FILE = DESK_FILES._replace(name="desk_file", largest=4 * MEGABYTE, reading=Means(20.0, 512 * MEGABYTE))

MOST_ROWS = 800  #: of a student's file of answers
WAITING = 60  #: requests of one person that wait
_PATIENCE = 120.0  #: seconds for which one waits


def read_apart(budget: Budget, too_much: str, function: Callable[..., Any], *told: Any) -> Any:
    """Return what a function reads from a file, in a process with the means of the budget.

    Raises
    ------
    BadInput
        The function raised it, or took more than it may: then with the sentence ``too_much``.
    """
    assert budget.reading is not None, f"{budget.name} reads no files"
    try:
        return confined(budget.reading, function, *told)
    except Exceeded:
        raise BadInput(too_much) from None


class Crowded(Exception):
    """Too many requests of one person wait already, or one has waited too long."""


class Places:
    """Places for requests: so many at once for each key, first come, first served; some more wait.

    Waiting takes no thread, and no event loop owns a place.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._taken: dict[Hashable, int] = {}
        self._waiting: dict[Hashable, deque[Future[None]]] = {}

    @asynccontextmanager
    async def one(self, key: Hashable, at_once: int, waiting: int = WAITING) -> AsyncIterator[None]:
        """Hold one of ``at_once`` places of a key.

        Raises
        ------
        Crowded
            As many as may wait wait already, or no place became free.
        """
        turn = self._asked(key, at_once, waiting)
        if turn is not None:
            try:
                await asyncio.wait_for(asyncio.wrap_future(turn), _PATIENCE)
            except BaseException as fault:
                if not turn.cancel():
                    self._free(key)  # it was given at this very moment
                if isinstance(fault, TimeoutError):
                    raise Crowded from fault
                raise
        try:
            yield
        finally:
            self._free(key)

    def _asked(self, key: Hashable, at_once: int, waiting: int) -> Future[None] | None:
        """Take a place, or a turn in the queue."""
        with self._lock:
            if self._taken.get(key, 0) < at_once:
                self._taken[key] = self._taken.get(key, 0) + 1
                return None
            queue = self._waiting.setdefault(key, deque())
            if len(queue) >= waiting:
                raise Crowded
            queue.append(Future())
            return queue[-1]

    def _free(self, key: Hashable) -> None:
        """Give a place to who waits longest, or put it back."""
        with self._lock:
            queue = self._waiting.get(key, deque())
            while queue:
                turn = queue.popleft()
                if turn.set_running_or_notify_cancel():
                    turn.set_result(None)
                    return
            self._waiting.pop(key, None)
            self._taken[key] -= 1
            if not self._taken[key]:
                del self._taken[key]
