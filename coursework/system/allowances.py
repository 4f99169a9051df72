"""Allowances: an amount for each person or address, such as seconds of processor time, that refills with
time."""

from __future__ import annotations

import ipaddress
import math
import time
from collections.abc import Callable, Hashable
from threading import Lock

_MOST_KEYS = 10_000  #: beyond this, keys with a full allowance are dropped


class Allowances:
    """An amount for each key, counted in memory.

    Parameters
    ----------
    most
        Amount of a key at first, and at most.
    back
        Amount that refills in a second.
    clock
        Returns seconds; by default a clock that never goes back.
    """

    def __init__(self, most: float, back: float, clock: Callable[[], float] = time.monotonic):
        self._most, self._back, self._clock = most, back, clock
        self._lock = Lock()
        self._spent: dict[Hashable, tuple[float, float]] = {}  # amount, and the time of its count

    def spend(self, key: Hashable, amount: float) -> None:
        """Count an amount as spent, even if it exceeds the rest."""
        with self._lock:
            self._spend(key, amount, self._clock())

    def wait(self, key: Hashable) -> int:
        """Return the seconds until a key may spend again; 0 if it may now."""
        with self._lock:
            return self._wait(self._now(key, self._clock()) - self._most)

    def take(self, key: Hashable) -> int:
        """Spend 1 if a key has it, and return 0; else return the seconds until it has, and spend nothing."""
        with self._lock:
            now = self._clock()
            over = self._now(key, now) + 1.0 - self._most
            if over > 0:
                return self._wait(over)
            self._spend(key, 1.0, now)
        return 0

    def _spend(self, key: Hashable, amount: float, now: float) -> None:
        self._spent[key] = self._now(key, now) + amount, now
        if len(self._spent) > _MOST_KEYS:
            self._spent = {
                other_key: (left, now) for other_key in self._spent if (left := self._now(other_key, now)) > 0
            }

    def _wait(self, over: float) -> int:
        return max(1, math.ceil(over / self._back)) if over >= 0 else 0

    def _now(self, key: Hashable, now: float) -> float:
        """Return the amount that is spent and not yet refilled."""
        spent, at = self._spent.get(key, (0.0, now))
        return max(0.0, spent - (now - at) * self._back)


def network(address: str) -> str:
    """Return the key to count requests by: the address, or the /64 network of an IPv6 address, since one
    machine may use all of it."""
    try:
        ip = ipaddress.ip_address(address)
    except ValueError:
        return address
    if isinstance(ip, ipaddress.IPv6Address):
        if ip.ipv4_mapped is not None:
            return str(ip.ipv4_mapped)
        return str(ipaddress.ip_network((ip, 64), strict=False))
    return address
