"""Processes that share a large job: sheets to print, answers to mark, exercises to check."""

from __future__ import annotations

import math
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
from multiprocessing.connection import Connection, wait
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
_LOOK = 0.3  #: seconds between two looks at a process that is kept
_AGAIN, _LONGEST = (
    0.5,
    30.0,
)  #: seconds before one that ended is begun again, the more often it ended the more
_STEADY = 10.0  #: seconds after which one that runs is taken for sound


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
    process = _begun(_LAST, job, told)
    try:
        yield
    finally:
        _end([process])


@contextmanager
def kept_beside(niceness: int, job: Callable[..., Any], *told: Any) -> Iterator[None]:
    """While the context lasts, a process does a job that does not end; where it ends all the same, another one goes on. It ends
    with the context, and with this process however that ends. Nothing is done where others cannot start.

    Parameters
    ----------
    niceness
        Its priority, 0 for that of this process to 19.
    """
    if not others_can_start():
        yield
        return
    is_over = threading.Event()
    begun: list[BaseProcess] = [_begun(niceness, job, told)]
    watch = threading.Thread(
        target=_follow_worker, args=(begun, is_over, niceness, job, told), name="worker", daemon=True
    )
    watch.start()
    try:
        yield
    finally:
        is_over.set()
        watch.join(_PATIENCE)
        _end(begun)


def _begun(niceness: int, job: Callable[..., Any], told: tuple[Any, ...]) -> BaseProcess:
    process = multiprocessing.get_context("spawn").Process(target=_do_beside, args=(job, told), daemon=True)
    with uninterrupted():
        process.start()
    if hasattr(os, "setpriority"):
        with suppress(OSError):  # it has ended by itself
            os.setpriority(os.PRIO_PROCESS, process.pid or 0, niceness)
    return process


def _follow_worker(
    begun: list[BaseProcess],
    is_over: threading.Event,
    niceness: int,
    job: Callable[..., Any],
    told: tuple[Any, ...],
) -> None:
    """Begin a process again whenever it ends; one that ends at once is given more and more time."""
    pause = _AGAIN
    while not is_over.wait(_LOOK):
        if begun[0].is_alive():
            continue
        if is_over.wait(pause):
            return
        since = time.monotonic()
        begun[0] = _begun(niceness, job, told)
        while begun[0].is_alive() and not is_over.wait(_LOOK):
            if time.monotonic() - since > _STEADY:
                break
        pause = _AGAIN if begun[0].is_alive() else min(_LONGEST, 2 * pause)


def _do_beside(job: Callable[..., Any], told: tuple[Any, ...]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # it is for who began this one
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


# ------------------------------------------------------------------------ confined

_NICE = 10  #: niceness of confined work: requests go before it
_PATIENT = 6.0  #: seconds of waiting for each second of a processor, on a machine that is busy
_STARTS = 20.0  #: seconds in which a process has started


_waited = threading.local()


def processor_time() -> float:
    """Return the seconds of a processor that this thread took, with those of the confined processes for which it waited."""
    return time.thread_time() + float(getattr(_waited, "seconds", 0.0))


class Means(NamedTuple):
    """Limits of a process: seconds of a processor, and bytes of memory beyond those with which it starts."""

    seconds: float
    memory: int


class Exceeded(CourseworkError):
    """Work that took more than its :class:`Means`; ``what`` is ``time`` or ``memory``."""

    def __init__(self, what: str):
        self.what = what
        super().__init__(f"the work took more {what} than it may")

    def __reduce__(self) -> tuple[Any, ...]:
        return Exceeded, (self.what,)


def confined(means: Means, function: Callable[..., Any], *told: Any) -> Any:
    """Return what a function gives in a new process of limited time and memory, all of which is freed with the process.

    Parameters
    ----------
    means
        The limits. A system without ``setrlimit`` limits the time alone.
    function, told
        A function of a module, and its arguments; these and the result are pickled.

    Raises
    ------
    Exceeded
        The limits did not suffice.
    CourseworkError
        The function raised it.
    """
    if not others_can_start():
        return function(*told)
    spawn = multiprocessing.get_context("spawn")
    answers, answer = spawn.Pipe(duplex=False)
    process = spawn.Process(
        target=_do_confined, args=(answer, means, pickle.dumps((function, told))), daemon=True
    )
    with answers:
        with uninterrupted():
            process.start()
        answer.close()
        try:
            is_done, value, seconds = _answered(answers, process, means)
            _waited.seconds = getattr(_waited, "seconds", 0.0) + seconds
        finally:
            process.kill()
            process.join()
            process.close()
    if is_done:
        return value
    raise value


def _answered(answers: Connection, process: BaseProcess, means: Means) -> tuple[bool, Any, float]:
    """Return whether the function gave something, what it gave or raised, and the seconds of a processor that this took."""
    if not wait([answers], _STARTS + _PATIENT * means.seconds):
        return False, Exceeded("time"), means.seconds
    try:
        is_done, value, seconds = pickle.loads(answers.recv_bytes(means.memory))
        return is_done, value, seconds
    except EOFError:  # it was ended: by its own limit of time, or for want of memory
        process.join(_PATIENCE)
        by_time = process.exitcode == -getattr(signal, "SIGXCPU", 0)
        return False, Exceeded("time" if by_time else "memory"), means.seconds
    except OSError:  # the answer is larger than all that it may take
        return False, Exceeded("memory"), means.seconds


def _do_confined(answer: Connection, means: Means, sent: bytes) -> None:
    follow_parent()
    with suppress(AttributeError, OSError):
        os.nice(_NICE)
    function, told = pickle.loads(sent)  # with what it imports, which is not counted
    unlimited = _limit(means)
    try:
        given = pickle.dumps((True, function(*told), time.process_time()))
    except MemoryError:
        unlimited()
        given = pickle.dumps((False, Exceeded("memory"), time.process_time()))
    except CourseworkError as fault:
        given = pickle.dumps((False, fault, time.process_time()))
    except Exception as fault:  # its message may hold an answer
        fault = CourseworkError(f"{type(fault).__name__} in {function.__name__}")
        given = pickle.dumps((False, fault, time.process_time()))
    unlimited()
    answer.send_bytes(given)


def _limit(means: Means) -> Callable[[], None]:
    """Limit this process from now on; return what takes the limit of memory away again."""
    try:
        import resource

        held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    except (ImportError, OSError):
        return lambda: None
    used = math.ceil(time.process_time() + means.seconds)
    resource.setrlimit(resource.RLIMIT_CPU, (used, resource.getrlimit(resource.RLIMIT_CPU)[1]))
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (held + means.memory, before[1]))
    return lambda: resource.setrlimit(resource.RLIMIT_AS, before)
