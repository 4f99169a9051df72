"""Memory of this process: given back to the system where a library would keep it."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

_ARENAS = -8  #: ``M_ARENA_MAX`` of glibc's ``malloc.h``


@contextmanager
def little_memory() -> Iterator[None]:
    """Let threads that start within the context share one heap, and give back at its end what is free.

    Otherwise each thread has a heap of its own, and what one frees no other can use. Other systems than
    glibc's are left as they are.
    """
    _heap_function("mallopt")(_ARENAS, 1)
    try:
        yield
    finally:
        _heap_function("malloc_trim")(0)


@cache
def _heap_function(name: str) -> Callable[..., Any]:
    try:
        return getattr(ctypes.CDLL(None), name)
    except (OSError, TypeError, AttributeError):
        return lambda *_: None
