"""Processes that share a large job: sheets to print, answers to mark, exercises to check.

The pool is the standard library's. joblib 1.6 is as fast, but its processes outlive a caller that is killed.
"""

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
from coursework.system.ending import done_or_ended, follow_parent, signals_blocked

#: Sends a function of a module and its arguments to a process.
Submit: TypeAlias = Callable[..., Future[Any]]

_LAST = 19  #: niceness of background work
_MOST = 61  #: limit of processes that some systems can wait for
_PATIENCE = 3.0  #: seconds for processes to clean up
_LOOK = 0.3  #: seconds between two checks of a supervised process
_AGAIN, _LONGEST = (0.5, 30.0)  #: seconds before a restart; the wait doubles with each failure
_STEADY = 10.0  #: seconds after which a running process counts as sound


class Lost(CourseworkError, RuntimeError):
    """Error of a worker that is gone before its task was done."""


class TaskPool(Protocol):
    """Workers that run tasks instead of the processes of this machine."""

    @property
    def capacity(self) -> int:
        """Return the number of tasks that run at once."""

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]: ...


_shared_by: ContextVar[TaskPool | None] = ContextVar("shared_by", default=None)


@contextmanager
def shared_by(pool: TaskPool) -> Iterator[None]:
    """Send large jobs of any size to the pool while the context lasts."""
    before = _shared_by.set(pool)
    try:
        yield
    finally:
        _shared_by.reset(before)


def is_shared() -> bool:
    """Return whether a pool takes large jobs now."""
    return _shared_by.get() is not None


def workers(tasks: int, worth: int = 0) -> int:
    """Return the number of processes for a number of tasks: one per processor, or 1 (this process) if there
    are fewer tasks than ``worth`` or if others cannot start.

    A new process imports the main script of this one; a script from standard input is not a file.
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
    """Call of a module's function in another process, with its arguments and a ``name`` for messages."""

    name: str
    function: Callable[..., Any]
    arguments: tuple[Any, ...]


_AHEAD = 3  #: tasks sent per process before the first answer


def in_turn(tasks: Iterable[Task], count: int) -> Iterator[Any]:
    """Yield the results of the tasks in order, computed by ``count`` processes; only a few are computed
    ahead, to bound memory.

    Raises
    ------
    Lost
        Nobody is left to do them; names the first that is missing.
    """
    with processes(count) as submit:
        sent: deque[tuple[str, Future[Any]]] = deque()
        for task in tasks:
            sent.append((task.name, submit(task.function, *task.arguments)))
            if len(sent) >= _AHEAD * _at_once(count):
                yield _given(sent)
        while sent:
            yield _given(sent)


def _at_once(count: int) -> int:
    """Return the number of processes, or of the workers that a pool has now."""
    pool = _shared_by.get()
    return count if pool is None else max(2, pool.capacity)


def _given(sent: deque[tuple[str, Future[Any]]]) -> Any:
    name, task = sent.popleft()
    try:
        return task.result()
    except Lost as fault:
        raise Lost(
            "{problem}: {name} is not done, and later steps may not be", problem=fault, name=name
        ) from None


@contextmanager
def processes(count: int) -> Iterator[Submit]:
    """Start ``count`` processes, which end with the context, and with this process; an exception or Ctrl-C
    terminates them at once.

    They are spawned, not forked: the typesetter's state must not be copied. They leave Ctrl-C to this
    process.

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

            def submit(function: Callable[..., Any], *arguments: Any) -> Future[Any]:
                with uninterrupted():
                    return executor.submit(done_or_ended, _call, pickle.dumps((function, arguments)))

            try:
                yield submit
            except BaseException:
                _leave(executor)
                raise
    except BrokenProcessPool as broken:
        raise CourseworkError(
            "a worker process ended by itself: there was too little memory, or a script starts the "
            "work outside "
            "of 'if __name__ == \"__main__\":'; free some memory, or put that line before it"
        ) from broken


def _leave(executor: ProcessPoolExecutor) -> None:
    """Terminate the processes of an executor whatever they do. This uses its private parts."""
    begun = list((executor._processes or {}).values())
    manager: Any = executor._executor_manager_thread
    answers: Any = executor._result_queue
    executor.shutdown(wait=False, cancel_futures=True)  # first: pending tasks are cancelled
    _end(begun)
    if manager is not None:
        answers._writer.close()  # a process terminated while it answered has sent half of its answer
        # A signal may have interrupted this thread as it took a lock for which that thread now waits.
        manager.join(_PATIENCE)


def _end(workers: Sequence[BaseProcess]) -> None:
    """Terminate processes; kill those that do not end in time."""
    for worker in workers:
        worker.terminate()
    last = time.monotonic() + _PATIENCE
    for worker in workers:
        worker.join(max(0.0, last - time.monotonic()))
        worker.kill()


def _call(sent: bytes) -> Any:
    """Run a pickled call in another process. Unpickling here reports a course that cannot be opened as
    such."""
    function, arguments = pickle.loads(sent)
    return function(*arguments)


@contextmanager
def background_process(job: Callable[..., Any], *arguments: Any) -> Iterator[None]:
    """Run a job in a new process of the lowest priority while the context lasts.

    The process ends with the context and with this process. Nothing runs if processes cannot start.
    """
    if not others_can_start():
        yield
        return
    process = _started(_LAST, job, arguments)
    try:
        yield
    finally:
        _end([process])


@contextmanager
def supervised_process(niceness: int, job: Callable[..., Any], *arguments: Any) -> Iterator[None]:
    """Run an endless job in a process while the context lasts, and start it again if it ends.

    The process ends with the context and with this process. Nothing runs if processes cannot start.

    Parameters
    ----------
    niceness
        Priority, from 0 (that of this process) to 19.
    """
    if not others_can_start():
        yield
        return
    is_over = threading.Event()
    begun: list[BaseProcess] = [_started(niceness, job, arguments)]
    watch = threading.Thread(
        target=_follow_worker, args=(begun, is_over, niceness, job, arguments), name="worker", daemon=True
    )
    watch.start()
    try:
        yield
    finally:
        is_over.set()
        watch.join(_PATIENCE)
        _end(begun)


def _started(niceness: int, job: Callable[..., Any], arguments: tuple[Any, ...]) -> BaseProcess:
    process = multiprocessing.get_context("spawn").Process(
        target=_run_background, args=(job, arguments), daemon=True
    )
    with uninterrupted():
        process.start()
    if hasattr(os, "setpriority"):
        with suppress(OSError):  # it may have ended
            os.setpriority(os.PRIO_PROCESS, process.pid or 0, niceness)
    return process


def _follow_worker(
    begun: list[BaseProcess],
    is_over: threading.Event,
    niceness: int,
    job: Callable[..., Any],
    arguments: tuple[Any, ...],
) -> None:
    """Start a process again whenever it ends; wait longer each time if it ends at once."""
    pause = _AGAIN
    while not is_over.wait(_LOOK):
        if begun[0].is_alive():
            continue
        if is_over.wait(pause):
            return
        since = time.monotonic()
        begun[0] = _started(niceness, job, arguments)
        while begun[0].is_alive() and not is_over.wait(_LOOK):
            if time.monotonic() - since > _STEADY:
                break
        pause = _AGAIN if begun[0].is_alive() else min(_LONGEST, 2 * pause)


def _run_background(job: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent handles it
    follow_parent()
    job(*arguments)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Start processes in a critical section: neither they nor this process react to interrupts, and each
    starts completely before a signal ends this process. Other threads than the main thread get no
    protection."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with signals_blocked():
        before = signal.signal(signal.SIGINT, signal.SIG_IGN)
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, before)


# ------------------------------------------------------------------------ confined

_NICE = 10  #: niceness of confined work, behind requests
_PATIENT = 6.0  #: seconds of waiting per processor second on a busy machine
_STARTS = 20.0  #: seconds for a process to start


_waited = threading.local()


def processor_time() -> float:
    """Return the processor seconds of this thread and of the confined processes for which it waited."""
    return time.thread_time() + float(getattr(_waited, "seconds", 0.0))


class ResourceLimits(NamedTuple):
    """Limits of a process: processor seconds, and bytes of memory beyond those at its start."""

    seconds: float
    memory: int
    niceness: int = _NICE  #: 0 where somebody waits for the result
    #: It begins with the function's module loaded: in a tenth of the time, for memory that stays taken.
    is_warm: bool = False


class Exceeded(CourseworkError):
    """Error of work that exceeds its :class:`ResourceLimits`; ``resource`` is ``time`` or ``memory``."""

    def __init__(self, resource: str):
        self.resource = resource
        super().__init__(f"the work took more {resource} than it may")

    def __reduce__(self) -> tuple[Any, ...]:
        return Exceeded, (self.resource,)


def confined(means: ResourceLimits, function: Callable[..., Any], *arguments: Any) -> Any:
    """Return the result of a function, run in a new process of limited time and memory, which frees both at
    its end.

    Parameters
    ----------
    means
        The limits. A system without ``setrlimit`` limits the time alone.
    function, arguments
        A function of a module, and its arguments; these and the result are pickled.

    Raises
    ------
    Exceeded
        The limits did not suffice.
    CourseworkError
        The function raised it.
    """
    if not others_can_start():
        return function(*arguments)
    context = _context(function.__module__ if means.is_warm else "")
    answers, answer = context.Pipe(duplex=False)
    process = context.Process(
        target=_do_confined, args=(answer, means, pickle.dumps((function, arguments))), daemon=True
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


def _context(module: str) -> Any:
    """Return the way in which a process begins: as a copy of one that has loaded a module, where a module is
    named and the system can."""
    if not module or "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([module])
    return context


def _answered(answers: Connection, process: BaseProcess, means: ResourceLimits) -> tuple[bool, Any, float]:
    """Return whether the function returned, its result or exception, and the processor seconds used."""
    if not wait([answers], _STARTS + _PATIENT * means.seconds):
        return False, Exceeded("time"), means.seconds
    try:
        is_done, value, seconds = pickle.loads(answers.recv_bytes(means.memory))
        return is_done, value, seconds
    except EOFError:  # the process died: at its limit of time, or out of memory
        process.join(_PATIENCE)
        by_time = process.exitcode == -getattr(signal, "SIGXCPU", 0)
        return False, Exceeded("time" if by_time else "memory"), means.seconds
    except OSError:  # the answer exceeds the memory limit
        return False, Exceeded("memory"), means.seconds


def _do_confined(answer: Connection, means: ResourceLimits, sent: bytes) -> None:
    follow_parent()
    with suppress(AttributeError, OSError):
        os.nice(means.niceness)
    function, arguments = pickle.loads(sent)  # includes imports, which do not count
    unlimited = _limit(means)
    try:
        given = pickle.dumps((True, function(*arguments), time.process_time()))
    except MemoryError:
        unlimited()
        given = pickle.dumps((False, Exceeded("memory"), time.process_time()))
    except CourseworkError as fault:
        given = pickle.dumps((False, fault, time.process_time()))
    except Exception as fault:  # its message may contain a right answer
        fault = CourseworkError(
            "{error} in {function}", error=type(fault).__name__, function=function.__name__
        )
        given = pickle.dumps((False, fault, time.process_time()))
    unlimited()
    answer.send_bytes(given)


def _limit(means: ResourceLimits) -> Callable[[], None]:
    """Limit this process from now on; return a function that lifts the limit of memory."""
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
