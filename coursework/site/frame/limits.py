"""Limits on the rate of requests and on their processor time, counted in the memory of each process.

A whole class may share one address. Requests therefore count by person if somebody is signed in, otherwise
by a known browser, and by address only if neither is known.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import NamedTuple

from coursework.system.allowances import Allowances, network

FREE = "free"  #: kind of page without a limit: the shared static files


class Rate(NamedTuple):
    """Number of requests at once, and the minutes in which as many more are allowed."""

    requests: int
    minutes: int

    @property
    def allowances(self) -> Allowances:
        return Allowances(self.requests, self.requests / (60.0 * self.minutes))


#: Rates of a person who is signed in, and of a known browser, by kind of page.
PERSON = {
    "usual": Rate(600, 1),
    "paper": Rate(600, 1),
    "explore": Rate(400, 1),
    "mechanism": Rate(120, 1),
    "hand_in": Rate(120, 10),
    "upload": Rate(300, 10),
    "sign_in": Rate(60, 10),
}
#: Rates of an address, while nobody is signed in.
ADDRESS = {
    "usual": Rate(6000, 1),
    "paper": Rate(6000, 1),
    "explore": Rate(6000, 1),
    "mechanism": Rate(600, 1),
    "hand_in": Rate(6000, 1),
    "upload": Rate(300, 10),
    "sign_in": Rate(3000, 10),
}
#: Processor time in seconds that a person may use at once for each kind of page, and its regain per second.
AT_ONCE, BACK = 30.0, 0.1


class Limits:
    """Counters of requests and processor time; their methods return the seconds to wait, 0 for none."""

    def __init__(self) -> None:
        self._of_persons = {kind: rate.allowances for kind, rate in PERSON.items()}
        self._of_addresses = {kind: rate.allowances for kind, rate in ADDRESS.items()}
        self._processor = Allowances(AT_ONCE, BACK)

    def wait_for_rate(self, kind: str, person: Hashable, address: str, browser: str = "") -> int:
        """Count a request of a kind of page by a person, on the site or on a platform, or, for person 0, by
        known browser or address; return the seconds to wait."""
        if kind == FREE:
            return 0
        if known := person or browser:
            return self._of_persons[kind].take(known)
        return self._of_addresses[kind].take(network(address))

    def add_processor_time(self, kind: str, person: Hashable, seconds: float) -> None:
        """Count the processor time of a page, in seconds."""
        self._processor.spend((kind, person), seconds)

    def wait_for_processor(self, kind: str, person: Hashable) -> int:
        """Return the seconds to wait because of the processor time of earlier pages."""
        return self._processor.wait((kind, person))
