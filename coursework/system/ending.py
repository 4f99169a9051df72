"""End of processes: on a signal they clean up; and no process outlives its parent."""

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
from typing import Any, NoReturn

_GRACE = 2.0  #: seconds for an orphaned process to clean up
_BY_SIGNAL = 128  #: exit status of a process that a signal ended: this plus the signal's number
_AGAIN = 0.2  #: seconds until a signal without effect is repeated


class Ended(SystemExit):
    """Exception of a signal that ends this process; contexts are left as on any other exception."""

    def __init__(self, number: int) -> None:
        super().__init__(_BY_SIGNAL + number)
        self.number = number

    def __str__(self) -> str:
        return f"ended by {signal.Signals(self.number).name}"


def end_cleanly() -> None:
    """Let SIGTERM, and the end of the terminal, raise :class:`Ended` in this process. Call it in the main
    thread.

    The signal is repeated if it has no effect: the main thread may wait while another thread receives the
    signal, and some C code of the interpreter drops exceptions. Cleaning up is not interrupted. A process
    that was started to outlive its terminal does.
    """
    signal.signal(signal.SIGTERM, _end)
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        signal.signal(signal.SIGHUP, _end)
    _repeat_signals()


def has_ended() -> None:
    """Ignore further signals: the process runs its last lines. Call it in the main thread."""
    global _is_ended
    _is_ended = True
    for number in signal.Signals:
        if signal.getsignal(number) is _end:
            signal.signal(number, signal.SIG_IGN)


def leave(status: int) -> NoReturn:
    """End this process, after a signal also if a thread does not end: it may wait for a lock that the signal
    left taken."""
    if _is_ended:
        last = time.monotonic() + _GRACE
        for thread in threading.enumerate():
            if thread is not threading.main_thread() and not thread.daemon:
                thread.join(max(0.0, last - time.monotonic()))
                if thread.is_alive():
                    sys.stdout.flush()
                    sys.stderr.flush()
                    os._exit(status)
    sys.exit(status)


_is_ended = False
_waiting: list[int] = []  #: a signal that arrived while signals were blocked
_are_signals_handled = True
_is_at_work = True  #: False in a process that waits for a task and has nothing to clean up
_wakeup_fd = 0  #: file descriptor that receives each signal's number; 0 before a thread reads it


@contextmanager
def signals_blocked() -> Iterator[None]:
    """Run a critical section: a signal that ends this process takes effect after the context. Use it in the
    main thread."""
    global _are_signals_handled
    _are_signals_handled, before = False, _are_signals_handled
    try:
        yield
    finally:
        _are_signals_handled = before
        if _waiting and _are_signals_handled:
            _end(_waiting.pop(), None)


def _end(number: int, frame: FrameType | None) -> None:
    if not _is_at_work:
        os._exit(_BY_SIGNAL + number)
    if not _are_signals_handled:
        _waiting[:] = [number]
    elif not _is_ending():
        raise Ended(number)


def _is_ending() -> bool:
    """Return whether the main thread cleans up after a signal."""
    fault = sys.exc_info()[1]
    while fault is not None and not isinstance(fault, Ended):
        fault = fault.__context__
    return fault is not None


def _repeat_signals() -> None:
    """Start a thread, once, that learns of each signal in whichever thread it arrives."""
    global _wakeup_fd
    if _wakeup_fd or os.name != "posix":
        return
    read_end, _wakeup_fd = os.pipe()
    os.set_blocking(_wakeup_fd, False)
    signal.set_wakeup_fd(_wakeup_fd, warn_on_full_buffer=False)
    sys.unraisablehook = partial(_report_dropped, sys.unraisablehook)
    threading.Thread(target=_repeat, args=(read_end,), daemon=True).start()


def _repeat(read_end: int) -> None:
    main = threading.main_thread().ident or 0
    while data := os.read(read_end, 1):
        while signal.getsignal(data[0]) is _end:
            time.sleep(_AGAIN)
            if signal.getsignal(data[0]) is _end:
                signal.pthread_kill(main, data[0])


def _report_dropped(say: Callable[[Any], Any], dropped: Any) -> None:
    if not isinstance(dropped.exc_value, Ended):
        say(dropped)


def follow_parent() -> None:
    """End this process when its parent has ended, in whatever way: cleanly if it can within a moment."""
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


def done_or_ended(function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function and return its result; on a signal, meanwhile or later, the process leaves the function
    and exits."""
    global _is_at_work
    _is_at_work = True
    try:
        return function(*arguments)
    except Ended as end:
        os._exit(int(str(end.code)))
    finally:
        _is_at_work = False
