"""Clock of a site that ignores leaps of the machine's clock, so that no exam opens because of a wrong time.

The site's time advances by the time elapsed since the machine started, suspended or not, and follows the
machine's clock as long as the two agree. If that clock suddenly moves ahead by more than :data:`LEAP`, the
site follows it only after :data:`STEADY`. If it is set back, the site follows at once; dates that have
passed remain passed. After a stop, the site reads its last time from the database. If the machine has not
restarted since, the site's time continues from there. Otherwise nobody knows how long it was off: the
machine's clock counts at once, and no date is recorded as passed before :data:`STEADY` is over.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path
from threading import Lock, Thread
from typing import Any, NamedTuple

from sqlalchemy import Connection
from sqlalchemy.exc import SQLAlchemyError

from coursework.database.audit import note
from coursework.database.settings import put_value, value_of
from coursework.database.store import Store
from coursework.errors import BadInput

LOG = logging.getLogger("coursework.site")
LEAP = timedelta(minutes=5)  #: larger than the usual corrections of clocks
STEADY = 15 * 60.0  #: seconds after which the site follows a leap
_EVERY = 60.0  #: seconds between two records of the time in the database
_REPORTED = timedelta(days=7)  #: for which the instructor's pages report a leap
_SEEN, _LEAPT = "clock seen", "clock leapt"
_BOOT_ID = Path("/proc/sys/kernel/random/boot_id")
_BY = "clock"


class Leap(NamedTuple):
    """Leap of the machine's clock, as the instructor's pages report it."""

    at: datetime  #: time of the site
    seconds: float  #: ahead; below 0 where it was set back
    held: bool  #: the site does not follow it


class SteadyClock:
    """Clock of a site, in UTC.

    Parameters
    ----------
    store
        Database that records the last time of the site, for its other processes and after a stop.
    wall
        The machine's clock.
    elapsed
        Function that returns the seconds since the machine started.
    boot
        Identifier of this start of the machine; empty if there is none.
    """

    def __init__(
        self,
        store: Store,
        wall: Callable[[], datetime] = lambda: datetime.now(UTC),
        elapsed: Callable[[], float] | None = None,
        boot: str | None = None,
    ):
        self._store, self._wall, self._elapsed = store, wall, elapsed or _elapsed
        self._boot = _boot() if boot is None else boot
        self._lock = Lock()
        self._noted = -_EVERY
        self._noting: Thread | None = None
        now, begun = self._wall(), self._elapsed()
        with store.reading() as connection:
            seen = value_of(connection, _SEEN) or {}
        is_same_boot = bool(self._boot) and seen.get("boot") == self._boot
        # Last time of the site, and the elapsed time then.
        self._last = datetime.fromisoformat(seen["at"]) if is_same_boot else now
        self._at = float(seen["elapsed"]) if is_same_boot else begun
        gap = now - datetime.fromisoformat(seen["at"]) if seen and not is_same_boot else timedelta(0)
        self._steady_from = begun + STEADY if abs(gap) > LEAP else begun
        self._leapt: tuple[float, timedelta] | None = None  #: elapsed time at the leap, and its size

    def __call__(self) -> datetime:
        """Return the time of the site."""
        with self._lock:
            wall, elapsed = self._wall(), self._elapsed()
            expected = self._last + timedelta(seconds=elapsed - self._at)
            leap = self._leap(wall - expected, elapsed)
            if self._leapt is None:
                self._last, self._at = wall, elapsed
            now = expected if self._leapt else wall
            is_due = leap is not None or elapsed - self._noted >= _EVERY
            if is_due:
                self._noted = elapsed
        if is_due:  # in a thread, since the caller may hold a transaction
            args = now, elapsed, leap, self._noting
            self._noting = Thread(target=self._note, args=args, name="clock", daemon=True)
            self._noting.start()
        return now

    def settle(self) -> None:
        """Wait until the record in the database is written."""
        if self._noting is not None:
            self._noting.join()

    def _leap(self, ahead: timedelta, elapsed: float) -> Leap | None:
        """Update the state of a leap from the difference to the machine's clock; return a leap that is
        new."""
        if abs(ahead) <= LEAP or ahead < timedelta(0):
            was, self._leapt = self._leapt, None
            set_back = was is None and ahead < -LEAP
            return Leap(self._wall(), ahead.total_seconds(), held=False) if set_back else None
        if self._leapt is None or abs(self._leapt[1] - ahead) > LEAP:
            self._leapt = elapsed, ahead
            at = self._last + timedelta(seconds=elapsed - self._at)
            return Leap(at, ahead.total_seconds(), held=True)
        if elapsed - self._leapt[0] < STEADY:
            return None
        self._leapt = None
        return Leap(self._wall(), ahead.total_seconds(), held=False)

    @property
    def is_steady(self) -> bool:
        """Return True if a date may be recorded as passed for good."""
        return self._leapt is None and self._elapsed() >= self._steady_from

    def _note(self, now: datetime, elapsed: float, leap: Leap | None, before: Thread | None) -> None:
        """Record the time of the site and a new leap, after the record before; an unavailable database is no
        fault here."""
        if before is not None:  # of two leaps, the later one is to stand in the database
            before.join()
        if leap is not None:
            LOG.error(
                "the clock of this machine leapt by %.0f s; %s",
                leap.seconds,
                "the site does not follow it" if leap.held else "the site follows it",
            )
        try:
            with self._store.begin() as connection:
                if leap is None or not leap.held:
                    value = {"boot": self._boot, "at": now.isoformat(), "elapsed": elapsed}
                    put_value(connection, _SEEN, value)
                if leap is not None:
                    put_value(connection, _LEAPT, [leap.at.isoformat(), leap.seconds, leap.held])
                    note(connection, now, _BY, "clock leapt", seconds=round(leap.seconds), held=leap.held)
        except (BadInput, SQLAlchemyError) as fault:
            LOG.warning("the time is not noted: %s", type(fault).__name__)


def is_steady(clock: Callable[[], datetime]) -> bool:
    """Return True if a date may be recorded as passed for good."""
    return bool(getattr(clock, "is_steady", True))


def last_leap(connection: Connection, now: datetime) -> Leap | None:
    """Return the last leap of the machine's clock, while the instructor's pages report it."""
    stored: list[Any] | None = value_of(connection, _LEAPT)
    if stored is None:
        return None
    leap = Leap(datetime.fromisoformat(stored[0]), float(stored[1]), bool(stored[2]))
    return leap if abs(now - leap.at) < _REPORTED else None


def _elapsed() -> float:
    """Return the seconds since the machine started, including suspended time if the system counts it."""
    return time.clock_gettime(getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC))


@cache
def _boot() -> str:
    try:
        return _BOOT_ID.read_text("ascii").strip()
    except OSError:
        return ""
