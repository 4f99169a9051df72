"""Answer for a supervisor or a proxy: whether this process serves pages, and whether its database answers."""

from __future__ import annotations

import json
import time
from threading import Lock

from anyio import CapacityLimiter
from anyio.to_thread import run_sync
from sqlalchemy.exc import SQLAlchemyError
from starlette.requests import Request
from starlette.responses import Response

from coursework.database.jobs import waiting
from coursework.errors import CourseworkError
from coursework.site.frame.settings import Site

PATH = "/health"
_KEPT = 2.0  #: seconds for which an answer is repeated: whoever asks often asks the database no more often
_BEHIND = 300  #: seconds that a submission waits for its marks before marking counts as behind


class Health:
    """Endpoint ``/health``: 200 while the database answers, 503 otherwise, for any host and without a
    session.

    It tells nothing else of the site: ``{"database": "ok", "marking": "ok"}``; ``behind`` if submissions have
    waited longer than :data:`_BEHIND` for their marks, which is not a reason to start the site again.
    """

    def __init__(self, site: Site):
        self._site, self._lock = site, Lock()
        self._state: dict[str, str] = {}
        self._until = 0.0
        self._thread = CapacityLimiter(1)  # beside the threads that make pages, which may all be busy

    async def answer(self, request: Request) -> Response:
        """Return the response."""
        is_kept = time.monotonic() < self._until
        state = self._state if is_kept else await run_sync(self._state_now, limiter=self._thread)
        status = 200 if state["database"] == "ok" else 503
        return Response(json.dumps(state) + "\n", status, {"cache-control": "no-store"}, "application/json")

    def _state_now(self) -> dict[str, str]:
        with self._lock:
            if time.monotonic() >= self._until:
                self._state = self._asked()
                self._until = time.monotonic() + _KEPT
            return self._state

    def _asked(self) -> dict[str, str]:
        try:
            with self._site.store.reading() as connection:
                _, first, _ = waiting(connection)
        except (CourseworkError, SQLAlchemyError):
            return {"database": "unreachable"}
        is_behind = first is not None and (self._site.clock() - first).total_seconds() > _BEHIND
        return {"database": "ok", "marking": "behind" if is_behind else "ok"}
