"""Slots for requests: a limited number of requests per person is answered at once, and the others wait."""

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
    """Error of too many waiting requests of one person, or of one that has waited too long."""


class RequestSlots:
    """Slots for requests: a limited number at once for each key, first come, first served; some more wait.

    Waiting takes no thread, and no event loop owns a slot.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._occupied: dict[Hashable, int] = {}
        self._waiting: dict[Hashable, deque[Future[None]]] = {}

    @asynccontextmanager
    async def slot(self, key: Hashable, at_once: int, waiting: int = WAITING) -> AsyncIterator[None]:
        """Occupy one of ``at_once`` slots of a key while the context lasts.

        Raises
        ------
        Crowded
            As many as may wait wait already, or no place became free.
        """
        turn = self._request(key, at_once, waiting)
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

    def _request(self, key: Hashable, at_once: int, waiting: int) -> Future[None] | None:
        """Occupy a slot and return None, or return a turn in the queue."""
        with self._lock:
            if self._occupied.get(key, 0) < at_once:
                self._occupied[key] = self._occupied.get(key, 0) + 1
                return None
            queue = self._waiting.setdefault(key, deque())
            if len(queue) >= waiting:
                raise Crowded
            queue.append(Future())
            return queue[-1]

    def _free(self, key: Hashable) -> None:
        """Pass a slot to the request that has waited longest, or free it."""
        with self._lock:
            queue = self._waiting.get(key, deque())
            while queue:
                turn = queue.popleft()
                if turn.set_running_or_notify_cancel():
                    turn.set_result(None)
                    return
            self._waiting.pop(key, None)
            self._occupied[key] -= 1
            if not self._occupied[key]:
                del self._occupied[key]
