"""Clock of a site, which follows no leap of the machine's clock: an hour that is wrong for a moment opens no exam.

The time that counts goes on by what has elapsed since the machine was started, suspended or not. The machine's clock is
followed as long as it agrees. Where it is ahead all at once, by more than :data:`LEAP`, it is believed only after it has
stood so for :data:`STEADY`; where it is set back, it is followed, and dates that have passed stay passed. A site that was
off finds in the database when it was last seen: on the same start of the machine its time goes on from there; after another
start nobody knows how long it was off, so the machine's clock counts at once, and no date is written down as passed before
:data:`STEADY` is over.
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
LEAP = timedelta(minutes=5)  #: by which clocks are corrected every day
STEADY = 15 * 60.0  #: seconds after which a clock that leapt is believed
_EVERY = 60.0  #: seconds between two notes of the time in the database
_REPORTED = timedelta(days=7)  #: for which the desk tells of a leap
_SEEN, _LEAPT = "clock seen", "clock leapt"
_BOOT_ID = Path("/proc/sys/kernel/random/boot_id")
_BY = "clock"


class Leap(NamedTuple):
    """Leap of the machine's clock, as the instructor's pages report it."""

    at: datetime  #: the time that counted
    seconds: float  #: ahead; below 0 where it was set back
    held: bool  #: the time that counts does not follow it


class SteadyClock:
    """Time that counts on a site, in UTC.

    Parameters
    ----------
    store
        Database that notes when the site was last seen, for its other processes and after a stop.
    wall
        The machine's clock.
    elapsed
        Seconds since the machine was started.
    boot
        Name of this start of the machine; empty where it has none.
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
        # The time that counted last, and when it did; what elapsed since is added.
        self._last = datetime.fromisoformat(seen["at"]) if is_same_boot else now
        self._at = float(seen["elapsed"]) if is_same_boot else begun
        gap = now - datetime.fromisoformat(seen["at"]) if seen and not is_same_boot else timedelta(0)
        self._steady_from = begun + STEADY if abs(gap) > LEAP else begun
        self._leapt: tuple[float, timedelta] | None = (
            None  #: since when the machine's clock is ahead, and by how much
        )

    def __call__(self) -> datetime:
        """Return the time that counts."""
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
        if is_due:  # beside: who asks may be writing to the database
            self._noting = Thread(target=self._note, args=(now, elapsed, leap), name="clock", daemon=True)
            self._noting.start()
        return now

    def settle(self) -> None:
        """Wait until what is to be noted is in the database."""
        if self._noting is not None:
            self._noting.join()

    def _leap(self, ahead: timedelta, elapsed: float) -> Leap | None:
        """Look whether the machine's clock has leapt, and whether it is believed; give a leap that is new."""
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

    def _note(self, now: datetime, elapsed: float, leap: Leap | None) -> None:
        """Write down that the site was seen, and a leap; a database that is busy or away stops nobody."""
        if leap is not None:
            LOG.error(
                "the clock of this machine leapt by %.0f s; %s",
                leap.seconds, "the site does not follow it" if leap.held else "the site follows it",
            )  # fmt: skip
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
    """Return the seconds since the machine was started, those asleep as well where the system counts them."""
    return time.clock_gettime(getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC))


@cache
def _boot() -> str:
    try:
        return _BOOT_ID.read_text("ascii").strip()
    except OSError:
        return ""
