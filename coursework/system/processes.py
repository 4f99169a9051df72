"""Processes that share a large job: sheets to print, answers to mark, exercises to check."""

from __future__ import annotations

import multiprocessing
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

from coursework.errors import CourseworkError
from coursework.system.blocks import processors

#: Hands a function of a module, and what it is told, to a process.
Submit: TypeAlias = Callable[..., Future[Any]]

_MOST = 61  #: processes that some systems can wait for


def workers(tasks: int) -> int:
    """How many processes so many tasks may have: one for each processor, or 1, this one, where others cannot start.

    A new process imports the main script of this one; what comes from standard input is no file.
    """
    main = getattr(sys.modules["__main__"], "__file__", None)
    if main is not None and not Path(main).exists():
        return 1
    return max(1, min(processors(), tasks, _MOST))


@contextmanager
def processes(count: int) -> Iterator[Submit]:
    """So many new processes, which end with the context; a fault in it, or Ctrl-C, ends them at once, whatever they do.

    New ones, not forked ones: the typesetter must not be carried over. They leave Ctrl-C to this process.

    Raises
    ------
    CourseworkError
        One of them has ended by itself.
    """
    try:
        with ProcessPoolExecutor(count, mp_context=multiprocessing.get_context("spawn")) as pool:

            def submit(function: Callable[..., Any], *told: Any) -> Future[Any]:
                with _interrupts_ignored():
                    return pool.submit(function, *told)

            try:
                yield submit
            except BaseException:
                for worker in list((pool._processes or {}).values()):  # public from Python 3.14 on
                    worker.terminate()
                pool.shutdown(cancel_futures=True)
                raise
    except BrokenProcessPool as broken:
        raise CourseworkError(
            "a process that shared the work ended by itself: too little memory, or a script that starts the work "
            "outside of 'if __name__ == \"__main__\":'; close what takes memory, or put that line before it"
        ) from broken


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Processes started meanwhile do not hear of interrupts, nor does this one; only the main thread may say so."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
