"""Sending of scores in the background, repeated at growing intervals until the platform accepts them."""

from __future__ import annotations

import logging
import threading

from coursework.errors import CourseworkError
from coursework.messages import Message, as_message
from coursework.platforms.lti.services import NotServed, Services
from coursework.platforms.lti.settings import Settings
from coursework.platforms.lti.storage import Storage, Waiting

LOG = logging.getLogger("coursework.site")
_FIRST, _LONGEST = 5.0, 3600.0  #: seconds to the next attempt after one failure, and after many
_PAUSE = 5.0  #: seconds between two checks
_CONFLICT = 409
#: Responses that another attempt will hardly change; it is made at long intervals, in case an administrator
#: fixes the cause.
_HARD = (400, 403, 404, 405, 410, 415, 422)


class Sender:
    """Background thread that sends due scores."""

    def __init__(self, settings: Settings, storage: Storage, services: Services):
        self._settings, self._storage, self._services = settings, storage, services
        self._wake, self._over = threading.Event(), threading.Event()
        self._thread: threading.Thread | None = None

    def send_due(self) -> tuple[int, int]:
        """Send the scores that are due; return how many arrived and how many did not."""
        arrived = failed = 0
        for waiting in self._storage.due():
            issuer = waiting.launch.issuer
            platform = self._settings.platform(issuer, waiting.launch.client_id)
            try:
                if platform is None:
                    raise NotServed(Message("{issuer} is no longer in the settings", issuer=issuer), 404)
                self._services.send(platform, waiting)
            except CourseworkError as fault:
                failed += 1
                self._failed(waiting, fault)
            else:
                arrived += 1
                self._storage.arrived(waiting)
        return arrived, failed

    def _failed(self, waiting: Waiting, fault: CourseworkError) -> None:
        status = getattr(fault, "status", 0)
        if status == _CONFLICT:
            self._storage.put_off(waiting, _FIRST, as_message(fault))
            self._storage.newer_stamp(waiting)
        else:
            self._storage.put_off(waiting, wait_after(waiting.failures, status), as_message(fault))
        LOG.warning("a score waits: %s", fault)

    def start(self) -> None:
        self._over.clear()
        self._thread = threading.Thread(target=self._run, name="lti-scores", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._over.set()
        self._wake.set()
        if self._thread is not None:
            self._thread.join(timeout=15)

    def wake(self) -> None:
        self._wake.set()

    def _run(self) -> None:
        while not self._over.is_set():
            try:
                self.send_due()
            except Exception as fault:
                LOG.error("scores could not be sent: %s", type(fault).__name__)
            self._wake.wait(_PAUSE)
            self._wake.clear()


def wait_after(failures: int, status: int = 0) -> float:
    """Return the seconds to wait after a number of failures: the wait doubles with each."""
    least = 900.0 if status in _HARD else _FIRST
    return float(min(_LONGEST, least * 2 ** min(failures, 20)))
