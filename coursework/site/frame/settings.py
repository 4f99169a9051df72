"""Settings of the site: its course, its database, its address, and the way in which people sign in."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from datetime import datetime
from enum import Enum
from functools import cached_property
from pathlib import Path
from threading import Lock
from typing import Any

from sqlalchemy import Connection

from coursework.api import Variant
from coursework.course.course import Course
from coursework.course.folder import course_folder
from coursework.database.settings import course_reloads, request_reload, secret
from coursework.database.store import Store
from coursework.site.frame.clock import SteadyClock
from coursework.site.frame.cookies import Cookies
from coursework.site.frame.limits import Limits
from coursework.site.frame.lru_cache import LRUCache
from coursework.site.frame.pages import SitePages
from coursework.site.frame.pool import PracticePool
from coursework.site.frame.threads import Lanes
from coursework.system.request_slots import RequestSlots

_VARIANTS = 1200  #: items of the cache: variants with their answer keys, and drawings
_EXPLORED = 100  #: mechanisms with their plots, of about 0.1 MB each

Clock = Callable[[], datetime]


class Entrance(Enum):
    """Way in which people sign in."""

    LOCAL = "local"  #: the user of this machine is the owner
    DEMO = "demo"  #: the visitor chooses a person
    ACCOUNTS = "accounts"  #: with a password, or from a platform


@dataclass
class Site:
    """Site of one course and one database."""

    course: Course[Any]
    store: Store
    entrance: Entrance = Entrance.LOCAL
    url: str = "http://127.0.0.1:8000"
    clock: Clock = None  # type: ignore[assignment]  #: by default a :class:`SteadyClock`
    cache: LRUCache = field(default_factory=lambda: LRUCache(_VARIANTS))
    explored: LRUCache = field(default_factory=lambda: LRUCache(_EXPLORED))
    limits: Limits = field(default_factory=Limits)
    places: RequestSlots = field(default_factory=RequestSlots)
    lti: Path | None = None  #: folder of the learning platforms
    has_worker: bool = False  #: a worker marks submissions; otherwise the submitting request does
    _revision: int = field(init=False)
    _lock: Lock = field(init=False, repr=False, default_factory=Lock)

    def __post_init__(self) -> None:
        if self.clock is None:
            self.clock = SteadyClock(self.store)
        with self.store.reading() as connection:
            self._revision = course_reloads(connection)

    @cached_property
    def pages(self) -> SitePages:
        return SitePages(self.course.folder)

    @cached_property
    def lanes(self) -> Lanes:
        return Lanes(self.store)

    @cached_property
    def pool(self) -> PracticePool:
        return PracticePool(self.course, self.store)

    def ahead(self, key: Hashable, work: Callable[[], Any]) -> Future[Any]:
        """Run work in the background that a request will soon need, once for each key; return its result to
        come."""
        with self._lock:
            submitted: Future[Any] = self.cache.get(("ahead", key), lambda: self._aside.submit(work))
        return submitted

    @cached_property
    def _aside(self) -> ThreadPoolExecutor:
        return ThreadPoolExecutor(1, thread_name_prefix="ahead")

    @cached_property
    def secret(self) -> bytes:
        """Key that signs cookies and CSRF tokens: stored in the database, the same for all workers."""
        with self.store.begin() as connection:
            return secret(connection)

    @cached_property
    def cookies(self) -> Cookies:
        return Cookies(self.secret)

    def take(self, course: Course[Any]) -> None:
        """Switch all processes to the current files of the course; the practice pool stays until the next
        start."""
        with self.store.begin() as connection:
            self._revision = request_reload(connection)
        self._go_on_with(course)

    def follow(self, connection: Connection, revision: int | None = None) -> None:
        """Switch to the revision of the course that another process has taken; the caller may state a known
        ``revision``."""
        revision = course_reloads(connection) if revision is None else revision
        if revision != self._revision:
            self._revision = revision
            self._go_on_with(self.reopened())

    def reopened(self) -> Course[Any]:
        """Return the course, read again from its files."""
        return Course(course_folder(self.course.folder.root), Variant)

    def _go_on_with(self, course: Course[Any]) -> None:
        self.course, self.cache, self.explored = course, LRUCache(_VARIANTS), LRUCache(_EXPLORED)
        self.__dict__.pop("pages", None)

    @property
    def languages(self) -> tuple[str, ...]:
        """Languages of the course, its default first."""
        default = self.course.folder.language
        return (default, *(lang for lang in self.course.folder.languages if lang != default))

    @property
    def is_secure(self) -> bool:
        return self.url.startswith("https:")

    def variant(self, exercise: str, seed: int, lang: str) -> Any:
        """Return a variant with the default parts, from a cache; in the given language if the exercise has
        it.

        Raises
        ------
        UnknownName
            The course has no such exercise.
        """
        loaded = self.course[exercise]
        spoken = lang if lang in loaded.languages else loaded.languages[0]
        return self.cache.get((exercise, seed, spoken), lambda: loaded.variant(seed, spoken))
