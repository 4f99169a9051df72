"""Scrubbing: removal of every byte of an erased person from the database files, even if another process was
using them at the time of erasure."""

from __future__ import annotations

import logging
from threading import Event, Thread

from coursework.database.settings import drop_value, put_value, value_of
from coursework.errors import CourseworkError
from coursework.site.frame.settings import Site

LOG = logging.getLogger("coursework.site")
_LEFT = "bytes left"  #: setting that exists while deleted bytes are left
_AGAIN = 30.0  #: seconds between tries


def scrub(site: Site) -> bool:
    """Rewrite the files without the deleted bytes. Return False if some are left, which the next start tries
    again."""
    done = site.store.scrub()
    with site.store.begin() as connection:
        if done:
            drop_value(connection, _LEFT)
        else:
            put_value(connection, _LEFT, True)
    return done


def is_left(site: Site) -> bool:
    """Return True while deleted bytes are left in a file."""
    with site.store.reading() as connection:
        return bool(value_of(connection, _LEFT))


def scrub_until_done(site: Site, stop: Event | None = None) -> None:
    """Retry in the background until nothing is left."""

    def work() -> None:
        while not (stop or Event()).wait(_AGAIN):
            try:
                if not is_left(site) or scrub(site):
                    return
            except CourseworkError as fault:
                LOG.error("erased bytes are still in the files: %s", type(fault).__name__)

    Thread(target=work, name="scrub", daemon=True).start()
