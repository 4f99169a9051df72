"""Cyclic garbage collection of the process, paused while a great many objects are made that stay: it would
look through all of them again and again, for two fifths of the time."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock

_lock = Lock()
_paused = 0  #: blocks that pause it now


@contextmanager
def paused_collection() -> Iterator[None]:
    """Pause the collection for a block; the last of concurrent blocks resumes it."""
    global _paused
    with _lock:
        _paused += 1
        gc.disable()
    try:
        yield
    finally:
        with _lock:
            _paused -= 1
            if not _paused:
                gc.enable()
