"""Pool of practice variants, drawn in advance, since some exercises reject fifty draws for one valid
variant."""

from __future__ import annotations

import logging
from collections.abc import Collection
from contextlib import suppress
from hashlib import sha256
from threading import Lock
from typing import Any

from sqlalchemy.exc import IntegrityError

from coursework.course.course import Course
from coursework.database.pool import Pooled, issued_given, issued_seeds, pooled, pools, put_pooled
from coursework.database.store import Store
from coursework.errors import CourseworkError, Starved
from coursework.issuing.issuing import distinct_variants

LOG = logging.getLogger("coursework.site")
FIRST_SEED = 3_000_000  #: far from the seeds of classes, self-study and books
COUNTS = (8, 60)  #: variants of each exercise to find in advance, in two passes


class PracticePool:
    """Pool of seeds for practice, by exercise: shared by everybody, and stored in the database."""

    def __init__(self, course: Course[Any], store: Store):
        self._course, self._store = course, store
        self._pools: dict[str, Pooled] = {}
        self._locks: dict[str, Lock] = {}
        self._lock = Lock()

    def seeds(self, exercise: str) -> tuple[int, ...]:
        """Return the seeds found so far; search for the first of them if there are none."""
        pool = self._pools.get(exercise)
        if pool is None or not _is_complete(pool):  # another process may have found more
            pool = self._extended(exercise, COUNTS[0])
        return pool.seeds

    def holds(self, exercise: str, seed: int) -> bool:
        """Return True if the pool contains a seed."""
        pool = self._pools.get(exercise, Pooled())
        return seed in pool.seeds or seed in self.seeds(exercise)

    def choose_seed(self, exercise: str, person: int, begun: Collection[int]) -> int:
        """Return a seed for a person who has begun the given ones: it depends on the person and the exercise,
        and was issued to no class while another remains.

        Raises
        ------
        Starved
            The exercise has no valid variant.
        """
        left = self._left(exercise, begun)
        in_order = sorted(left, key=lambda seed: _draw(exercise, person, seed))
        return next((s for s in in_order if not self._is_issued(exercise, s)), in_order[0])

    def _left(self, exercise: str, begun: Collection[int]) -> list[int]:
        """Return the seeds not begun; all of them if every one was begun."""
        seeds: tuple[int, ...] = self.seeds(exercise)
        left = [seed for seed in seeds if seed not in begun]
        if not left:
            seeds = self._extended(exercise, 2 * len(seeds)).seeds
            left = [seed for seed in seeds if seed not in begun]
        if not seeds:
            raise Starved("{exercise}: no variant that is worth issuing was found", exercise=exercise)
        return left or list(seeds)

    def _is_issued(self, exercise: str, seed: int) -> bool:
        with self._store.reading() as connection:
            if not (seeds := issued_seeds(connection, exercise)):
                return False
            if str(seed) in seeds:
                return True
            data = self._course[exercise].variant(seed).record["given"]
            return any(given == data for given in issued_given(connection, exercise))

    def _extended(self, exercise: str, count: int) -> Pooled:
        """Return a pool of at least so many seeds, or of all that exist."""
        loaded = self._course[exercise]
        with self._lock:
            lock = self._locks.setdefault(exercise, Lock())
        with lock:
            with self._store.reading() as connection:
                pool = pooled(connection, exercise, loaded.version)
            if len(pool.seeds) < count and not pool.are_all:
                pool = self._stored(exercise, loaded.version, _drawn(loaded, count))
            self._pools[exercise] = pool
        return pool

    def _stored(self, exercise: str, version: int, new: Pooled) -> Pooled:
        """Store the seeds found; return those of another process if it has stored more meanwhile, so that no
        begun variant is lost."""
        with (
            suppress(IntegrityError),
            self._store.begin() as connection,
        ):  # another process stored the same at the same time
            stored = pooled(connection, exercise, version)
            if len(stored.seeds) > len(new.seeds):
                return stored
            put_pooled(connection, exercise, version, new)
        return new

    # ---------------------------------------------------------------------- ahead

    def is_filled(self) -> bool:
        """Return True if the pool contains all the seeds wanted in advance; one query of the database."""
        versions = {name: self._course[name].version for name in self._course.folder.study_order}
        with self._store.reading() as connection:
            by_exercise = pools(connection, versions)
        return all(_is_complete(by_exercise.get(name, Pooled())) for name in versions)

    def fill(self) -> None:
        """Find all the seeds wanted in advance, exercise by exercise in the order of study."""
        for count in COUNTS:
            for exercise in self._course.folder.study_order:
                try:
                    self._extended(exercise, count)
                except CourseworkError as fault:
                    LOG.error("no variants of %s were drawn ahead: %s", exercise, type(fault).__name__)


def _is_complete(pool: Pooled) -> bool:
    return pool.are_all or len(pool.seeds) >= COUNTS[-1]


def _drawn(exercise: Any, count: int) -> Pooled:
    """Return so many seeds of an exercise, or as many as can be found."""
    wanted = count
    while wanted:
        with suppress(Starved):
            variants = distinct_variants(exercise, FIRST_SEED, wanted, exercise.languages[0])
            return Pooled(tuple(variant.seed for variant in variants), wanted < count)
        wanted = wanted * 3 // 4
    return Pooled((), True)


def _draw(exercise: str, person: int, seed: int) -> bytes:
    return sha256(f"coursework/practice/{exercise}/{person}/{seed}".encode()).digest()
