"""Cluster that shares a large job: the workers of a Dask scheduler instead of processes of this machine.

Dask distributes the tasks and sends a task again if its worker ends. This module sends a task again if the
scheduler is lost, and ends the run if no worker is left: joblib 1.6 above Dask ends it as soon as the
scheduler is lost.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
import pickle
import re
import threading
import time
import uuid
import warnings
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager, suppress
from typing import Any, Protocol

from coursework.errors import BadInput, CourseworkError
from coursework.messages import Message
from coursework.system.extras import library
from coursework.system.processes import Lost, others_can_start, shared_by, uninterrupted

CONNECT = 10.0  #: seconds to wait for a scheduler that has not answered yet
PATIENCE = 60.0  #: seconds without a worker, or without the scheduler, after which a run is ended
STALL = 30  #: seconds of silence after which a worker of this machine counts as lost
_BEAT = 0.5  #: seconds from one look at the cluster to the next
_ATTEMPTS = 20  #: to compute a task while schedulers stop and start
_CLOSING = 10.0  #: seconds to wait for a client or cluster to close

#: Settings of Dask's workers: checks that would run a hundred times a second run seldom.
SELDOM = {
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.worker.profile.enabled": False,
}

_FORM = re.compile(r"local:(?P<count>[1-9][0-9]{0,2})|(tcp|tls)://[^\s/]+:[0-9]{1,5}/?")


class Payload(Protocol):
    """Translation of tasks into bytes that a worker can run, and the content that all of them need there."""

    content: bytes  #: sent to a worker once, before its first task
    key: str  #: name of the content: the same content has the same key

    def packed(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> bytes:
        """Return a self-contained pickle of a call, with the content as its only buffer."""

    def unpacked(self, result: bytes) -> Any:
        """Return the result of a task; raise the exception that it raised."""


@contextmanager
def cluster(address: str, load: Payload) -> Iterator[None]:
    """Share large jobs, while the context lasts, among the workers of a scheduler at an address, or among new
    workers on this machine (``local:4``), which end with it. Unfinished tasks are cancelled at the end.

    Raises
    ------
    BadInput
        The address is none, nothing answers there within :data:`CONNECT` seconds, or Dask is not installed.
    """
    match = _FORM.fullmatch(address)
    if match is None:
        raise BadInput(
            "--cluster takes the address of a scheduler, tcp://HOST:8786 or tls://HOST:8786, or "
            "local:N for N workers of this machine; found {address!r}",
            address=address,
        )
    if match["count"] and not others_can_start():
        raise BadInput(
            "--cluster local:N starts processes, which a script from standard input cannot; write it "
            "to a file"
        )
    library("distributed", "--cluster needs", "cluster")
    with ExitStack() as stack:
        stack.enter_context(_quiet())
        pool = _Cluster(address, int(match["count"] or 0), load)
        stack.callback(pool.close)
        pool.open()
        stack.enter_context(shared_by(pool))
        yield


@contextmanager
def _quiet() -> Iterator[None]:
    """Silence the log and the warnings of Dask; this module reports what matters in one line."""
    import dask
    from distributed.versions import VersionMismatchWarning

    handlers = logging.getLogger("distributed").handlers
    levels = [handler.level for handler in handlers]
    settings = {
        "distributed.admin.large-graph-warning-threshold": "1 GiB",
        "distributed.scheduler.worker-ttl": f"{STALL}s",
        **SELDOM,
    }
    with warnings.catch_warnings(), dask.config.set(settings):
        warnings.simplefilter("ignore", VersionMismatchWarning)
        for handler in handlers:
            handler.setLevel(logging.CRITICAL + 1)
        try:
            yield
        finally:
            for handler, level in zip(handlers, levels, strict=True):
                handler.setLevel(level)


class _Cluster:
    """Workers of a scheduler, and the thread that talks to it."""

    def __init__(self, address: str, count: int, load: Payload):
        self._address, self._count, self._load = address, count, load
        self._loop = asyncio.new_event_loop()
        self._loop.set_exception_handler(lambda *_: None)  # of tasks that Dask leaves when it is stopped
        self._thread = threading.Thread(target=self._loop.run_forever, name="cluster", daemon=True)
        self._tasks: set[asyncio.Task[Any]] = set()
        self._lost: Lost | None = None
        self._numbers = itertools.count()
        self._run = uuid.uuid4().hex
        self._client: Any = None
        self._local_cluster: Any = None  #: the cluster that was started here
        self._watching: asyncio.Task[None] | None = None
        self._at_hand = asyncio.Event()  #: whether the scheduler answers
        self.capacity = 0  #: tasks that can be done at once

    # ------------------------------------------------------------ from any thread

    def open(self) -> None:
        self._thread.start()
        with uninterrupted():
            self._do(self._open())

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        sent = self._load.packed(function, arguments)
        return asyncio.run_coroutine_threadsafe(self._result(sent), self._loop)

    def close(self) -> None:
        """Cancel unfinished tasks and disconnect; workers that were started here end."""
        with uninterrupted():
            if self._thread.is_alive():
                with suppress(Exception):  # the scheduler may be gone
                    self._do(self._close())
                self._loop.call_soon_threadsafe(self._loop.stop)
                self._thread.join()
            self._loop.close()

    def _do(self, job: Coroutine[Any, Any, None]) -> None:
        asyncio.run_coroutine_threadsafe(job, self._loop).result()

    # --------------------------------------------------------------- in its thread

    async def _open(self) -> None:
        import distributed

        target: Any = self._address
        if self._count:
            self._local_cluster = target = await distributed.LocalCluster(
                self._count,
                threads_per_worker=1,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                scheduler_kwargs={"dashboard": False},
                asynchronous=True,
                silence_logs=logging.CRITICAL,
            )
        self._target = target
        try:
            self._client = await self._connected()
        except Exception as fault:
            raise BadInput(
                "no scheduler answers at {address} (waited {seconds:g} s: {problem}); start one there, "
                "'dask scheduler', or name another",
                address=self._address,
                seconds=CONNECT,
                problem=_line(fault),
            ) from None
        self._watching = asyncio.ensure_future(self._watch())

    async def _connected(self) -> Any:
        import distributed

        client = distributed.Client(
            self._target, asynchronous=True, timeout=CONNECT, set_as_default=False, name="coursework"
        )
        try:
            # Dask limits the wait for a connection, but not for an answer on it.
            return await asyncio.wait_for(client, CONNECT + _BEAT)
        except BaseException:
            await _left(client)
            raise

    async def _close(self) -> None:
        for task in (*self._tasks, *([self._watching] if self._watching else ())):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for left in (self._client, self._local_cluster):
            if left is not None:
                await _left(left)

    async def _result(self, sent: bytes) -> Any:
        """Return the result of a task; raise its exception, or :class:`Lost`."""
        if self._lost is not None:
            raise self._lost
        task = asyncio.current_task()
        assert task is not None
        self._tasks.add(task)
        try:
            result = await self._computed(sent, f"coursework-{self._run}-{next(self._numbers)}")
        except asyncio.CancelledError:
            if self._lost is None:
                raise
            raise self._lost from None
        finally:
            self._tasks.discard(task)
        return self._load.unpacked(result)

    async def _computed(self, sent: bytes, key: str) -> bytes:
        """Return the bytes that a worker computes for a task; send the task again if its scheduler is
        gone."""
        from distributed import KilledWorker

        for attempt in range(_ATTEMPTS):
            left: tuple[Any, ...] = ()
            try:
                left = self._sent(sent, f"{key}-{attempt}")
                result: bytes = await left[0]
                return result
            except KilledWorker:
                raise Lost(
                    "a task ended every worker at {address} that took it: too little memory?",
                    address=self._address,
                ) from None
            except (ImportError, AttributeError, pickle.UnpicklingError) as fault:
                raise _without_package(self._address, fault) from None
            except Exception as fault:  # many errors mean a lost scheduler; a task's own errors come as bytes
                message = _line(fault)
            finally:
                for future in left:
                    future.release()
            self._at_hand.clear()
            await self._at_hand.wait()
        raise Lost(
            "the connection to the scheduler at {address} is unstable ({message})",
            address=self._address,
            message=message,
        )

    def _sent(self, task: bytes, key: str) -> tuple[Any, ...]:
        """Send a task; return the futures of its result and of the content it needs. The scheduler and the
        workers decode it with the standard library alone."""
        submit = self._client.submit
        content = submit(bytes, self._load.content, key=f"course-{self._load.key}", pure=False)
        return submit(pickle.loads, task, buffers=[content], key=key, pure=False), content

    async def _watch(self) -> None:
        """Count the workers, and end the run if there has been none for long."""
        seen = time.monotonic()
        while True:
            silent = await self._look()
            now = time.monotonic()
            if silent is None:
                seen = now
                self._at_hand.set()
            elif now - seen > PATIENCE:
                self._lost = Lost("{silent} (waited {seconds:g} s)", silent=silent, seconds=PATIENCE)
                for task in self._tasks:
                    task.cancel()
                return
            await asyncio.sleep(_BEAT)

    async def _look(self) -> str | None:
        """Return the problem of the cluster, if any."""
        try:
            if self._client.status == "closed":
                self._client = await self._connected()
            threads = await asyncio.wait_for(self._client.nthreads(), CONNECT)
        except Exception:  # a network has many ways to fail
            self._at_hand.clear()
            return Message("the scheduler at {address} no longer answers", address=self._address)
        self.capacity = sum(threads.values())
        return None if threads else Message("no worker is left at {address}", address=self._address)


async def _left(resource: Any) -> None:
    """Close a client or a cluster; give up if it does not answer."""
    with suppress(asyncio.TimeoutError, OSError):
        await asyncio.wait_for(resource.close(), _CLOSING)


def _without_package(address: str, fault: Exception) -> CourseworkError:
    return CourseworkError(
        (
            "a worker at {address} does not have this package, or has another version ({problem}): "
            "install the "
            "same version there"
        ),
        address=address,
        problem=_line(fault),
    )


def _line(fault: Exception) -> str:
    return (" ".join(str(fault).split()) or type(fault).__name__)[:160]
