"""Turns of requests: the limits on their rate and processor time, their slots, and their line in the log; the
same for pages of the site and for pages in frames of platforms."""

from __future__ import annotations

import logging
import time
from collections.abc import AsyncIterator, Hashable, Iterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager, contextmanager
from typing import NamedTuple

from coursework.site.frame.budgets import Budget
from coursework.site.frame.requests import HTTPException
from coursework.site.frame.settings import Site
from coursework.system.processes import processor_time
from coursework.system.request_slots import WAITING, Crowded

LOG = logging.getLogger("coursework.site")
_STAFF_WAITING = 1000  #: waiting requests of a member of staff: a page of many pictures requests all at once
_CROWDED = 2  #: seconds to wait if too many requests wait


class Visitor(NamedTuple):
    """Sender of a request, as limits and the log know them."""

    key: Hashable = 0  #: id of the person, or a key of the person on a platform; 0 for nobody
    is_staff: bool = False
    browser: str = ""  #: known browser of somebody who is not signed in
    label: str = ""  #: in the log: ``person 7``


def check_limits(site: Site, kind: str, visitor: Visitor, address: str, *, is_short: bool) -> None:
    """Count a request, and check the limits on the rate of requests and on processor time.

    Requests that only store, such as a submission, are not refused because of earlier processor time.

    Raises
    ------
    HTTPException
        The visitor has to wait.
    """
    wait = site.limits.wait_for_rate(kind, visitor.key, address, visitor.browser)
    if visitor.key and not visitor.is_staff and not is_short:
        wait = max(wait, site.limits.wait_for_processor(kind, visitor.key))
    if wait:
        raise HTTPException("too_often", 429, wait)


@asynccontextmanager
async def visitor_slot(site: Site, visitor: Visitor, budget: Budget) -> AsyncIterator[None]:
    """Occupy a slot of a visitor while the context lasts; somebody unknown needs none.

    Raises
    ------
    HTTPException
        Too many requests of the visitor wait.
    """
    if not visitor.key:
        yield
        return
    waiting = _STAFF_WAITING if visitor.is_staff else WAITING
    async with _slot(site, (visitor.key, budget.name), budget.at_once, waiting):
        yield


def reading_slot(site: Site, budget: Budget) -> AbstractAsyncContextManager[None]:
    """Occupy a slot for the reading of files while the context lasts."""
    return _slot(site, budget.name, budget.readings, _STAFF_WAITING)


@asynccontextmanager
async def _slot(site: Site, key: Hashable, at_once: int, waiting: int) -> AsyncIterator[None]:
    try:
        async with site.places.slot(key, at_once, waiting):
            yield
    except Crowded:
        raise HTTPException("too_often", 429, _CROWDED) from None


@contextmanager
def counted_time(site: Site, kind: str, visitor: Visitor) -> Iterator[None]:
    """Count the processor time of the context as used by a visitor."""
    begun = processor_time()
    try:
        yield
    finally:
        if visitor.key:
            site.limits.add_processor_time(kind, visitor.key, processor_time() - begun)


def log_request(
    method: str, path: str, status: int, begun: float, label: str, why: str, *, is_error: bool
) -> None:
    """Log a request: the path of its route and who sent it, never its content."""
    level, took = logging.ERROR if is_error else logging.INFO, 1000 * (time.perf_counter() - begun)
    pieces = (str(status), f"{took:.0f} ms", label, why)
    LOG.log(level, "%s %s %s", method, path, " ".join(filter(None, pieces)))
