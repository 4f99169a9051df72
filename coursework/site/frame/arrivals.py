"""Arrival times of requests, taken before any queue of threads or locks, since they are the times that count.

A request counts as received with its last byte, less at most :data:`GRACE` since its first. A slow line thus
costs nobody time, and a body sent slowly on purpose gains no more than that.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, MutableMapping
from contextvars import ContextVar
from datetime import datetime, timedelta
from typing import Any

GRACE = timedelta(seconds=5)  #: within which the body may follow its first bytes
#: Key of a request's state under which the server puts the time of the connection's last bytes.
RECEIVED = "coursework.received"
_AHEAD = 64 * 1024  #: bytes of a body that are read in advance

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Clock = Callable[[], datetime]


class Arrival:
    """Arrival of one request: its first bytes, and the last ones so far."""

    def __init__(self, clock: Clock, state: MutableMapping[str, Any]):
        self._clock, self._received = clock, state.get(RECEIVED)
        self.first = self.last = self._now()

    def more(self) -> None:
        """Record the arrival of more bytes."""
        self.last = self._now()

    @property
    def counts(self) -> datetime:
        """Effective time of the request."""
        return max(self.first, self.last - GRACE)

    def _now(self) -> datetime:
        waited = 0.0 if self._received is None else max(0.0, time.monotonic() - self._received[0])
        return self._clock() - timedelta(seconds=waited)


_arrival: ContextVar[Arrival | None] = ContextVar("arrival", default=None)


def arrived(clock: Clock) -> datetime:
    """Return the effective time of the current request: its arrival if it sends data, otherwise the current
    time."""
    arrival = _arrival.get()
    return clock() if arrival is None else arrival.counts


class Arrivals:
    """ASGI middleware that records arrival times, and reads small bodies while the request waits for its
    turn."""

    def __init__(self, app: Callable[..., Awaitable[None]], clock: Clock):
        self._app, self._clock = app, clock

    async def __call__(self, scope: MutableMapping[str, Any], receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or scope["method"] != "POST":
            await self._app(scope, receive, send)
            return
        arrival = Arrival(self._clock, scope.get("state") or {})
        token = _arrival.set(arrival)
        body = _Body(receive, arrival)
        ahead = asyncio.ensure_future(body.read_ahead()) if _is_small(scope) else None
        try:
            await self._app(scope, body.receive, send)
        finally:
            if ahead is not None:
                ahead.cancel()
            _arrival.reset(token)


def _is_small(scope: MutableMapping[str, Any]) -> bool:
    headers = {name: value for name, value in scope["headers"] if name in (b"content-length", b"expect")}
    length = headers.get(b"content-length", b"")
    return b"expect" not in headers and length.isdigit() and len(length) < 9 and int(length) <= _AHEAD


class _Body:
    """Body of a request."""

    def __init__(self, receive: Receive, arrival: Arrival):
        self._receive, self._arrival = receive, arrival
        self._read: asyncio.Queue[Message | Exception] = asyncio.Queue()
        self._is_ahead = False

    async def read_ahead(self) -> None:
        """Read the body until it is complete or exceeds a limit."""
        self._is_ahead, size, is_more = True, 0, True
        while is_more and size <= _AHEAD:
            try:
                message = await self._stamped()
            except Exception as fault:  # raised for the reader of the body
                self._is_ahead = False
                self._read.put_nowait(fault)
                return
            size += len(message.get("body", b""))
            is_more = message["type"] == "http.request" and bool(message.get("more_body"))
            self._is_ahead = is_more and size <= _AHEAD
            self._read.put_nowait(message)

    async def receive(self) -> Message:
        """Return the next message."""
        if self._read.empty() and not self._is_ahead:
            return await self._stamped()
        message = await self._read.get()
        if isinstance(message, Exception):
            raise message
        return message

    async def _stamped(self) -> Message:
        message = await self._receive()
        if message["type"] == "http.request" and message.get("body"):
            self._arrival.more()
        return message
