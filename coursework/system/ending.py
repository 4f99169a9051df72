"""How processes end: told to, they clean up behind them; and none outlives the one that began it."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from types import FrameType
from typing import Any

_GRACE = 2.0  #: seconds in which a process that nobody waits for puts away what it has begun
_BY_SIGNAL = 128  #: the status of a process that a signal ended: its number beyond this
_AGAIN = 0.2  #: seconds until a process that goes on as if it had not been told to end is told again


class Ended(SystemExit):
    """Somebody has told this process to end; contexts are left as on the way out of a fault."""

    def __init__(self, number: int) -> None:
        super().__init__(_BY_SIGNAL + number)
        self.number = number

    def __str__(self) -> str:
        return f"ended by {signal.Signals(self.number).name}"


def end_cleanly() -> None:
    """From now on SIGTERM, and the end of the terminal, end this process as a fault does: by :class:`Ended`.

    Whoever does not hear it is told again: a main thread that waits while another thread is handed the signal, and what drops
    an exception on its way, as some of the interpreter's own C does. What is being put away meanwhile is not disturbed.
    What was begun to outlive its terminal does. Of the main thread alone.
    """
    signal.signal(signal.SIGTERM, _end)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        signal.signal(signal.SIGHUP, _end)
    _tell_again()


def has_ended() -> None:
    """The process is on its last lines; nobody tells it to end any more. Of the main thread alone."""
    for number in signal.Signals:
        if signal.getsignal(number) is _end:
            signal.signal(number, signal.SIG_IGN)


_waiting: list[int] = []  #: a signal that came while none was heeded
_is_heeded = True
_is_at_work = True  #: False in a process that waits for a task, and has nothing to put away
_told = 0  #: where each signal is written, once somebody reads it


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
            _end(_waiting.pop(), None)


def _end(number: int, frame: FrameType | None) -> None:
    if not _is_at_work:
        os._exit(_BY_SIGNAL + number)
    if not _is_heeded:
        _waiting[:] = [number]
    elif not _is_ending():
        raise Ended(number)


def _is_ending() -> bool:
    """Whether the main thread puts something away because it has been told to end."""
    fault = sys.exc_info()[1]
    while fault is not None and not isinstance(fault, Ended):
        fault = fault.__context__
    return fault is not None


def _tell_again() -> None:
    """Begin a thread, once, that hears of each signal, whichever thread is handed it."""
    global _told
    if _told or os.name != "posix":
        return
    hears, _told = os.pipe()
    os.set_blocking(_told, False)
    signal.set_wakeup_fd(_told, warn_on_full_buffer=False)
    sys.unraisablehook = partial(_say_dropped, sys.unraisablehook)
    threading.Thread(target=_repeat, args=(hears,), daemon=True).start()


def _repeat(hears: int) -> None:
    main = threading.main_thread().ident or 0
    while told := os.read(hears, 1):
        while signal.getsignal(told[0]) is _end:
            time.sleep(_AGAIN)
            if signal.getsignal(told[0]) is _end:
                signal.pthread_kill(main, told[0])


def _say_dropped(say: Callable[[Any], Any], dropped: Any) -> None:
    if not isinstance(dropped.exc_value, Ended):
        say(dropped)


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
    """What a function gives; a process that is told to end meanwhile, or later, does no more than leave it."""
    global _is_at_work
    _is_at_work = True
    try:
        return function(*told)
    except Ended as end:
        os._exit(int(str(end.code)))
    finally:
        _is_at_work = False
