"""Threads that answer requests; requests that only store data have their own threads and precede pages."""

from __future__ import annotations

import asyncio
import contextvars
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from threading import Lock
from typing import Any, TypeVar

from starlette.concurrency import run_in_threadpool

from coursework.database.store import CONNECTIONS, Store

_SHORT = 3  #: concurrent storing requests of a process; one if the database allows one writer
#: Concurrent pages of a process. No request uses more than two connections to the database, so that none
#: waits for a connection for ever.
PAGES_AT_ONCE = CONNECTIONS // 2 - _SHORT
_PAUSE, _LONGEST = 0.05, 3.0  #: seconds between two checks of a waiting page, and its longest wait

T = TypeVar("T")
Run = Callable[..., Awaitable[Any]]  #: calls a function in a thread


class Lanes:
    """Two groups of threads of a process: for short requests and for pages."""

    def __init__(self, store: Store):
        self._threads = ThreadPoolExecutor(1 if store.has_one_writer else _SHORT, thread_name_prefix="short")
        self._lock, self._count = Lock(), 0

    async def short(self, function: Callable[..., T], *arguments: Any) -> T:
        """Call a function that takes a few milliseconds, in the order of the requests."""
        self._add(1)
        try:
            call = partial(contextvars.copy_context().run, function, *arguments)
            return await asyncio.get_running_loop().run_in_executor(self._threads, call)
        finally:
            self._add(-1)

    async def usual(self, function: Callable[..., T], *arguments: Any) -> T:
        """Call a function that may take long, once no short call waits or after a moment."""
        waited = 0.0
        while self._count and waited < _LONGEST:
            await asyncio.sleep(_PAUSE)
            waited += _PAUSE
        return await run_in_threadpool(function, *arguments)

    def _add(self, more: int) -> None:
        with self._lock:
            self._count += more
