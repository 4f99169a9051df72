"""Processes that share a large job: sheets to print, answers to mark, exercises to check."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, NamedTuple, Protocol, TypeAlias

from coursework.errors import CourseworkError
from coursework.system.blocks import processors
from coursework.system.ending import done_or_ended, follow_parent, whole

#: Hands a function of a module, and what it is told, to a process.
Submit: TypeAlias = Callable[..., Future[Any]]

_LAST = 19  #: the niceness of what others go before
_MOST = 61  #: processes that some systems can wait for
_PATIENCE = 3.0  #: seconds for processes to put away what they have begun


class Lost(CourseworkError, RuntimeError):
    """What was to do a task is not there any more."""


class Pool(Protocol):
    """What does tasks in place of the processes of this machine."""

    @property
    def places(self) -> int:
        """How many are done at once."""

    def submit(self, function: Callable[..., Any], *told: Any) -> Future[Any]: ...


_shared_by: ContextVar[Pool | None] = ContextVar("shared_by", default=None)


@contextmanager
def shared_by(pool: Pool) -> Iterator[None]:
    """While the context lasts, large jobs go to the pool, whatever their size."""
    before = _shared_by.set(pool)
    try:
        yield
    finally:
        _shared_by.reset(before)


def is_shared() -> bool:
    """Whether large jobs go to a pool now."""
    return _shared_by.get() is not None


def workers(tasks: int, worth: int = 0) -> int:
    """How many processes so many tasks may have: one for each processor, or 1, this one, where there are fewer than is
    ``worth`` the start of others, or where others cannot start.

    A new process imports the main script of this one; what comes from standard input is no file.
    """
    if is_shared():
        return _at_once(2)
    if tasks < worth or not others_can_start():
        return 1
    return max(1, min(processors(), tasks, _MOST))


def others_can_start() -> bool:
    main = getattr(sys.modules["__main__"], "__file__", None)
    return main is None or Path(main).exists()


class Task(NamedTuple):
    """A function of a module to be called elsewhere, with what it is told; ``name`` is what it is about."""

    name: str
    function: Callable[..., Any]
    told: tuple[Any, ...]


_AHEAD = 3  #: tasks that are sent for each process before the first has answered


def in_turn(tasks: Iterable[Task], count: int) -> Iterator[Any]:
    """What each task gives, in their order, done by so many processes; few are made ahead, so that neither they nor what they
    give piles up.

    Raises
    ------
    Lost
        Nobody is left to do them; names the first that is missing.
    """
    with processes(count) as submit:
        sent: deque[tuple[str, Future[Any]]] = deque()
        for task in tasks:
            sent.append((task.name, submit(task.function, *task.told)))
            if len(sent) >= _AHEAD * _at_once(count):
                yield _given(sent)
        while sent:
            yield _given(sent)


def _at_once(count: int) -> int:
    """Of so many processes, or as many workers as a pool has now."""
    pool = _shared_by.get()
    return count if pool is None else max(2, pool.places)


def _given(sent: deque[tuple[str, Future[Any]]]) -> Any:
    name, task = sent.popleft()
    try:
        return task.result()
    except Lost as fault:
        raise Lost(f"{fault}: {name} is not done, and what comes after it may not be") from None


@contextmanager
def processes(count: int) -> Iterator[Submit]:
    """So many new processes, which end with the context, and with this process however that ends; a fault in it, or Ctrl-C, ends
    them at once, whatever they do.

    New ones, not forked ones: the typesetter must not be carried over. They leave Ctrl-C to this process.

    Raises
    ------
    CourseworkError
        One of them has ended by itself.
    """
    if (pool := _shared_by.get()) is not None:
        yield pool.submit
        return
    try:
        spawn = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(count, spawn, done_or_ended, (follow_parent,)) as executor:

            def submit(function: Callable[..., Any], *told: Any) -> Future[Any]:
                with uninterrupted():
                    return executor.submit(done_or_ended, _call, pickle.dumps((function, told)))

            try:
                yield submit
            except BaseException:
                _leave(executor)
                raise
    except BrokenProcessPool as broken:
        raise CourseworkError(
            "a process that shared the work ended by itself: too little memory, or a script that starts the work "
            "outside of 'if __name__ == \"__main__\":'; close what takes memory, or put that line before it"
        ) from broken


def _leave(executor: ProcessPoolExecutor) -> None:
    """End its processes, whatever they do; nothing of it is left. What it is made of is not public."""
    begun = list((executor._processes or {}).values())
    manager: Any = executor._executor_manager_thread
    answers: Any = executor._result_queue
    executor.shutdown(wait=False, cancel_futures=True)  # first: nobody waits for what has not begun
    _end(begun)
    if manager is not None:
        answers._writer.close()  # who was ended while it answered has sent half of it
        manager.join()


def _end(workers: Sequence[BaseProcess]) -> None:
    """Processes that work are told to end, and ended where they do not."""
    for worker in workers:
        worker.terminate()
    last = time.monotonic() + _PATIENCE
    for worker in workers:
        worker.join(max(0.0, last - time.monotonic()))
        worker.kill()


def _call(sent: bytes) -> Any:
    """In another process. What it is told comes as bytes, so that a course that cannot be opened there is told as such."""
    function, told = pickle.loads(sent)
    return function(*told)


@contextmanager
def beside(job: Callable[..., Any], *told: Any) -> Iterator[None]:
    """While the context lasts, a new process does a job in the time that nobody else wants; it ends with the context, and with this
    process however that ends. Nothing is done where others cannot start.
    """
    if not others_can_start():
        yield
        return
    process = multiprocessing.get_context("spawn").Process(target=_do_beside, args=(job, told), daemon=True)
    with uninterrupted():
        process.start()
    if hasattr(os, "setpriority"):
        with suppress(OSError):  # it has ended by itself
            os.setpriority(os.PRIO_PROCESS, process.pid or 0, _LAST)
    try:
        yield
    finally:
        _end([process])


def _do_beside(job: Callable[..., Any], told: tuple[Any, ...]) -> None:
    follow_parent()
    job(*told)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Processes started meanwhile do not hear of interrupts, nor does this one, and each is whole before this one heeds that it is
    told to end: one that is half begun complains. Only the main thread may say so.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with whole():
        before = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, before)
