"""How often something may be asked, counted in memory by each process.

A whole class may stand behind one address: who is signed in is counted by person, and an address alone only where nobody is
known yet.
"""

from __future__ import annotations

import ipaddress
import math
import time

from limits import RateLimitItem, parse
from limits.storage import MemoryStorage
from limits.strategies import MovingWindowRateLimiter

FREE = "free"  #: a class without a limit: files that all pages share

#: Of a person who is signed in, by the class of a page.
_PERSON = {
    "usual": "600/minute",
    "check": "120/minute",
    "upload": "300/10minutes",
    "sign_in": "60/10minutes",
}
#: Of an address, while nobody is signed in.
_ADDRESS = {
    "usual": "6000/minute",
    "check": "600/minute",
    "upload": "300/10minutes",
    "sign_in": "3000/10minutes",
}


class Limits:
    """Counts what is asked; gives the seconds to wait, 0 where it may be done now."""

    def __init__(self) -> None:
        self._limiter = MovingWindowRateLimiter(MemoryStorage())

    def asked(self, kind: str, person: int, address: str) -> int:
        """A page of a class is asked for by somebody, or by nobody (0) from an address."""
        if kind == FREE:
            return 0
        if person:
            return self._count(parse(_PERSON[kind]), kind, f"person {person}")
        return self._count(parse(_ADDRESS[kind]), kind, f"address {network(address)}")

    def _count(self, item: RateLimitItem, *names: str) -> int:
        return 0 if self._limiter.hit(item, *names) else self._wait(item, names)

    def _wait(self, item: RateLimitItem, names: tuple[str, ...]) -> int:
        return max(1, math.ceil(self._limiter.get_window_stats(item, *names).reset_time - time.time()))


def network(address: str) -> str:
    """What is counted as one: an address, or the 64 bits of a network of the newer kind, of which a machine has all."""
    try:
        found = ipaddress.ip_address(address)
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv6Address):
        if found.ipv4_mapped is not None:
            return str(found.ipv4_mapped)
        return str(ipaddress.ip_network((found, 64), strict=False))
    return address
