"""How processes end: told to, they clean up behind them; and none outlives the one that began it."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_GRACE = 2.0  #: seconds in which a process that nobody waits for puts away what it has begun
_BY_SIGNAL = 128  #: the status of a process that a signal ended: its number beyond this


class Ended(SystemExit):
    """Somebody has told this process to end; contexts are left as on the way out of a fault."""

    def __init__(self, number: int) -> None:
        super().__init__(_BY_SIGNAL + number)
        self.number = number

    def __str__(self) -> str:
        return f"ended by {signal.Signals(self.number).name}"


def end_cleanly() -> None:
    """From now on SIGTERM, and the end of the terminal, end this process as a fault does: by :class:`Ended`, once.

    What was begun to outlive its terminal does. Of the main thread alone.
    """
    signal.signal(signal.SIGTERM, _end)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        signal.signal(signal.SIGHUP, _end)


_waiting: list[int] = []  #: signals that came while none was heeded
_is_heeded = True


@contextmanager
def whole() -> Iterator[None]:
    """What is begun in this context is done before this process heeds that it is told to end. Of the main thread alone."""
    global _is_heeded
    _is_heeded, before = False, _is_heeded
    try:
        yield
    finally:
        _is_heeded = before
        if _waiting and _is_heeded:
            _end(_waiting.pop(0), None)


def _end(number: int, frame: FrameType | None) -> None:
    if not _is_heeded:
        _waiting.append(number)
        return
    signal.signal(number, signal.SIG_IGN)  # what is being put away is not disturbed
    raise Ended(number)


def follow_parent() -> None:
    """This process ends when the one that began it has, however that ended: cleanly if it can within a moment."""
    end_cleanly()
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    import multiprocessing

    if (parent := multiprocessing.parent_process()) is not None:
        parent.join()
        if os.name == "posix":
            os.kill(os.getpid(), signal.SIGTERM)  # to the main thread
            time.sleep(_GRACE)
        os._exit(1)


def done_or_ended(function: Callable[..., Any], *told: Any) -> Any:
    """What a function gives; a process that is told to end meanwhile does no more than leave it."""
    try:
        return function(*told)
    except Ended as end:
        os._exit(int(str(end.code)))
