"""Waiting before a password is checked: guessing stays slow, and nobody can lock out somebody else.

A password that does not fit counts for the login from that network, for the login from anywhere and for the network; from a browser
that signed in as this login before, it counts for that browser alone. The more it counts, the longer the next one waits before it
is checked; none is refused for what others did. Failures are counted in the database, for all processes; requests under way are
counted by each process, so that a hundred at once are no better than one after another.
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

    key: str  #: digest, of which nothing can be read
    free: int  #: failures that cost no waiting
    longest: float  #: seconds that one waits at most
    most: int  #: requests of it that may wait at once in a process

    def seconds(self, failures: int) -> float:
        """Return the seconds to wait after so many failures: 1, 2, 4 … up to the longest."""
        over = failures - self.free
        return min(self.longest, 2.0 ** min(over, 20)) if over >= 0 else 0.0


class Attempt(NamedTuple):
    """A password that is about to be checked: what it is counted by, and the failures of each so far."""

    tracks: Sequence[Track] = ()
    failures: Mapping[str, int] = {}


class TooMany(CourseworkError):
    """As many attempts of the same kind wait as may; ``seconds`` until one may try again."""

    def __init__(self, seconds: int):
        self.seconds = seconds
        super().__init__(f"too many attempts at once; {seconds} s")


class Attempts:
    """Attempts under way in this process. Used in the event loop alone, which needs no lock."""

    def __init__(self) -> None:
        self._under_way: Counter[str] = Counter()

    @asynccontextmanager
    async def waited(self, attempt: Attempt) -> AsyncIterator[None]:
        """Wait as long as the attempt must; it is under way until the block ends.

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
            self._under_way += Counter()  # keys that count nothing are let go
