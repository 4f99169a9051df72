"""Allowances: so much for each person or address, such as seconds of a processor; what is spent comes back as time passes."""

from __future__ import annotations

import ipaddress
import math
import time
from collections.abc import Callable, Hashable
from threading import Lock

_KEPT = 10_000  #: keys, from which on those that have spent nothing are let go


class Allowances:
    """So much for each key, counted in memory.

    Parameters
    ----------
    most
        What a key has at first, and at most.
    back
        What comes back in a second.
    clock
        Tells seconds; one that never goes back unless told.
    """

    def __init__(self, most: float, back: float, clock: Callable[[], float] = time.monotonic):
        self._most, self._back, self._clock = most, back, clock
        self._lock = Lock()
        self._spent: dict[Hashable, tuple[float, float]] = {}  # how much, and when that was so

    def spend(self, key: Hashable, amount: float) -> None:
        """Count what was spent; it may be more than was left."""
        with self._lock:
            now = self._clock()
            self._spent[key] = self._now(key, now) + amount, now
            if len(self._spent) > _KEPT:
                self._spent = {one: (left, now) for one in self._spent if (left := self._now(one, now)) > 0}

    def wait(self, key: Hashable) -> int:
        """Return the seconds until a key may spend something; 0 where it may now."""
        with self._lock:
            over = self._now(key, self._clock()) - self._most
        return max(1, math.ceil(over / self._back)) if over >= 0 else 0

    def _now(self, key: Hashable, now: float) -> float:
        """Return what is spent and has not come back."""
        spent, at = self._spent.get(key, (0.0, now))
        return max(0.0, spent - (now - at) * self._back)


def network(address: str) -> str:
    """Return what is counted as one: an address, or the 64 bits of an IPv6 network, of which a machine has all."""
    try:
        found = ipaddress.ip_address(address)
    except ValueError:
        return address
    if isinstance(found, ipaddress.IPv6Address):
        if found.ipv4_mapped is not None:
            return str(found.ipv4_mapped)
        return str(ipaddress.ip_network((found, 64), strict=False))
    return address
