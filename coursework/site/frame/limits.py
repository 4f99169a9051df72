"""Limits on the rate of requests and on their processor time, counted in the memory of each process.

A whole class may stand behind one address: who is signed in is counted by person, a browser that signed in before by itself, and
an address alone only where nothing else is known.
"""

from __future__ import annotations

import math
import time

from limits import RateLimitItem, parse
from limits.storage import MemoryStorage
from limits.strategies import MovingWindowRateLimiter

from coursework.system.allowances import Allowances, network

FREE = "free"  #: a class without a limit: files that all pages share

#: Of a person who is signed in, and of a browser that signed in before, by the class of a page.
PERSON = {
    "usual": "600/minute",
    "paper": "600/minute",
    "hand_in": "120/10minutes",
    "upload": "300/10minutes",
    "sign_in": "60/10minutes",
}
#: Of an address, while nobody is signed in.
ADDRESS = {
    "usual": "6000/minute",
    "paper": "6000/minute",
    "hand_in": "6000/minute",
    "upload": "300/10minutes",
    "sign_in": "3000/10minutes",
}
#: Seconds of a processor that a person has at once for the pages of each class, and that come back in a second.
AT_ONCE, BACK = 30.0, 0.1


class Limits:
    """Counts what is asked; gives the seconds to wait, 0 where it may be done now."""

    def __init__(self) -> None:
        self._limiter = MovingWindowRateLimiter(MemoryStorage())
        self._processor = Allowances(AT_ONCE, BACK)

    def wait_for_rate(self, kind: str, person: int, address: str, browser: str = "") -> int:
        """Count a request for a page of a class, by a person, or without one (0) by address and known
        browser."""
        if kind == FREE:
            return 0
        if person:
            return self._count(parse(PERSON[kind]), kind, f"person {person}")
        if browser:
            return self._count(parse(PERSON[kind]), kind, f"browser {browser}")
        return self._count(parse(ADDRESS[kind]), kind, f"address {network(address)}")

    def add_processor_time(self, kind: str, person: int, seconds: float) -> None:
        """Count seconds of a processor that a page took."""
        self._processor.spend((kind, person), seconds)

    def wait_for_processor(self, kind: str, person: int) -> int:
        """Return the seconds until somebody may have a page of a class, as far as pages before it took of a processor."""
        return self._processor.wait((kind, person))

    def _count(self, item: RateLimitItem, *names: str) -> int:
        return 0 if self._limiter.hit(item, *names) else self._wait(item, names)

    def _wait(self, item: RateLimitItem, names: tuple[str, ...]) -> int:
        return max(1, math.ceil(self._limiter.get_window_stats(item, *names).reset_time - time.time()))
