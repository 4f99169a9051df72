"""Limits on the rate of requests and on their processor time, counted in the memory of each process.

A whole class may share one address. Requests therefore count by person if somebody is signed in, otherwise
by a known browser, and by address only if neither is known.
"""

from __future__ import annotations

import math
import time
from collections.abc import Hashable

from limits import RateLimitItem, parse
from limits.storage import MemoryStorage
from limits.strategies import MovingWindowRateLimiter

from coursework.system.allowances import Allowances, network

FREE = "free"  #: kind of page without a limit: the shared static files

#: Rates of a person who is signed in, and of a known browser, by kind of page.
PERSON = {
    "usual": "600/minute",
    "paper": "600/minute",
    "hand_in": "120/10minutes",
    "upload": "300/10minutes",
    "sign_in": "60/10minutes",
}
#: Rates of an address, while nobody is signed in.
ADDRESS = {
    "usual": "6000/minute",
    "paper": "6000/minute",
    "hand_in": "6000/minute",
    "upload": "300/10minutes",
    "sign_in": "3000/10minutes",
}
#: Processor time in seconds that a person may use at once for each kind of page, and its regain per second.
AT_ONCE, BACK = 30.0, 0.1


class Limits:
    """Counters of requests and processor time; their methods return the seconds to wait, 0 for none."""

    def __init__(self) -> None:
        self._limiter = MovingWindowRateLimiter(MemoryStorage())
        self._processor = Allowances(AT_ONCE, BACK)

    def wait_for_rate(self, kind: str, person: int, address: str, browser: str = "") -> int:
        """Count a request of a kind of page by a person or, for person 0, by known browser, or person on a
        platform, or address;
        return the seconds to wait."""
        if kind == FREE:
            return 0
        if person:
            return self._count(parse(PERSON[kind]), kind, f"person {person}")
        if browser:
            return self._count(parse(PERSON[kind]), kind, f"browser {browser}")
        return self._count(parse(ADDRESS[kind]), kind, f"address {network(address)}")

    def add_processor_time(self, kind: str, person: Hashable, seconds: float) -> None:
        """Count the processor time of a page, in seconds."""
        self._processor.spend((kind, person), seconds)

    def wait_for_processor(self, kind: str, person: Hashable) -> int:
        """Return the seconds to wait because of the processor time of earlier pages."""
        return self._processor.wait((kind, person))

    def _count(self, item: RateLimitItem, *names: str) -> int:
        return 0 if self._limiter.hit(item, *names) else self._wait(item, names)

    def _wait(self, item: RateLimitItem, names: tuple[str, ...]) -> int:
        return max(1, math.ceil(self._limiter.get_window_stats(item, *names).reset_time - time.time()))
