"""Delays before a password is checked: guessing stays slow, and nobody can lock out somebody else.

A wrong password counts against the login from that network, the login from anywhere, and the network; from a
browser that signed in with this login before, it counts against that browser alone. The next attempt is
delayed by the number of failures; none is refused because of other people's failures. The database counts
failures for all processes. Each process counts the attempts under way, so that a hundred at once gain
nothing over one after another.
"""

from __future__ import annotations

import math
from asyncio import sleep
from collections import Counter
from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import asynccontextmanager
from typing import NamedTuple

from coursework.errors import CourseworkError


class Track(NamedTuple):
    """Counter of failed attempts, such as logins from one network."""

    key: str  #: digest that reveals nothing
    free: int  #: failures without a delay
    longest: float  #: longest delay in seconds
    most: int  #: requests that may wait at once in a process

    def seconds(self, failures: int) -> float:
        """Return the seconds to wait after so many failures: 1, 2, 4 … up to the longest."""
        over = failures - self.free
        return min(self.longest, 2.0 ** min(over, 20)) if over >= 0 else 0.0


class Attempt(NamedTuple):
    """Attempt to sign in: the counters that it belongs to, and their failures so far."""

    tracks: Sequence[Track] = ()
    failures: Mapping[str, int] = {}


class TooMany(CourseworkError):
    """Too many attempts of the same kind wait; the next one may come after ``seconds``."""

    def __init__(self, seconds: int):
        self.seconds = seconds
        super().__init__(f"too many attempts at once; {seconds} s")


class Attempts:
    """Attempts under way in this process. Only the event loop uses them, so that no lock is needed."""

    def __init__(self) -> None:
        self._under_way: Counter[str] = Counter()

    @asynccontextmanager
    async def waited(self, attempt: Attempt) -> AsyncIterator[None]:
        """Wait for the delay of an attempt; it is under way until the block ends.

        Raises
        ------
        TooMany
            Too many of the same kind wait already.
        """
        counted = {
            track: attempt.failures.get(track.key, 0) + self._under_way[track.key] for track in attempt.tracks
        }
        seconds = max((track.seconds(count) for track, count in counted.items()), default=0.0)
        if seconds and any(self._under_way[track.key] >= track.most for track in attempt.tracks):
            raise TooMany(math.ceil(seconds))
        keys = [track.key for track in attempt.tracks]
        self._under_way.update(keys)
        try:
            if seconds:
                await sleep(seconds)
            yield
        finally:
            self._under_way.subtract(keys)
            self._under_way += Counter()  # drops the keys whose count is 0
