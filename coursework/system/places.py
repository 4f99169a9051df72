"""Places for requests: so many of one person are answered at once, and the others wait."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncIterator, Hashable
from concurrent.futures import Future
from contextlib import asynccontextmanager
from threading import Lock

WAITING = 60  #: requests of one person that wait
_PATIENCE = 120.0  #: seconds for which one waits


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
