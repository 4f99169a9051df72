"""A cluster that shares a large job: the workers of a Dask scheduler in place of the processes of this machine.

Dask does the sharing: it sends tasks to workers, and to others where one ends. Here a task is sent again where the
scheduler itself was lost, and the run is ended where nobody is left to do it.
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
from coursework.system.extras import library
from coursework.system.processes import Lost, others_can_start, shared_by, uninterrupted

CONNECT = 10.0  #: seconds to wait for a scheduler that has not answered yet
PATIENCE = 60.0  #: seconds without a worker, or without the scheduler, after which a run is ended
STALL = 30  #: seconds without a word after which a worker of this machine is given up
_BEAT = 0.5  #: seconds from one look at the cluster to the next
_ATTEMPTS = 20  #: to have a task done where schedulers come and go
_CLOSING = 10.0  #: seconds that an end may take

#: Dask's settings of workers: what one would ask itself a hundred times a second, while it works, it asks seldom.
SELDOM = {
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.worker.profile.enabled": False,
}

_FORM = re.compile(r"local:(?P<count>[1-9][0-9]{0,2})|(tcp|tls)://[^\s/]+:[0-9]{1,5}/?")


class Load(Protocol):
    """How tasks become bytes that a worker can do, and what all of them need there."""

    content: bytes  #: sent to a worker once, before its first task
    key: str  #: what the content is called: the same content, the same key

    def packed(self, function: Callable[..., Any], told: tuple[Any, ...]) -> bytes:
        """A pickle that is its own work, with the content as its one buffer."""

    def unpacked(self, made: bytes) -> Any:
        """What the task gave; raises what it raised."""


@contextmanager
def cluster(address: str, load: Load) -> Iterator[None]:
    """While the context lasts, large jobs are shared by the workers of a scheduler at an address, or of so many new ones on
    this machine (``local:4``), which end with it. What is not done when it ends is called off.

    Raises
    ------
    BadInput
        The address is none, nothing answers there within :data:`CONNECT` seconds, or Dask is not installed.
    """
    told = _FORM.fullmatch(address)
    if told is None:
        raise BadInput(
            f"--cluster takes the address of a scheduler, tcp://HOST:8786 or tls://HOST:8786, or local:N for N workers "
            f"of this machine; found {address!r}"
        )
    if told["count"] and not others_can_start():
        raise BadInput(
            "--cluster local:N starts processes, which a script from standard input cannot; write it to a file"
        )
    library("distributed", "--cluster needs", "cluster")
    with ExitStack() as stack:
        stack.enter_context(_quiet())
        pool = _Cluster(address, int(told["count"] or 0), load)
        stack.callback(pool.close)
        pool.open()
        stack.enter_context(shared_by(pool))
        yield


@contextmanager
def _quiet() -> Iterator[None]:
    """What Dask logs and warns of is told here, in a line, where it matters."""
    import dask
    from distributed.versions import VersionMismatchWarning

    shown = logging.getLogger("distributed").handlers
    levels = [handler.level for handler in shown]
    settings = {
        "distributed.admin.large-graph-warning-threshold": "1 GiB",
        "distributed.scheduler.worker-ttl": f"{STALL}s",
        **SELDOM,
    }
    with warnings.catch_warnings(), dask.config.set(settings):
        warnings.simplefilter("ignore", VersionMismatchWarning)
        for handler in shown:
            handler.setLevel(logging.CRITICAL + 1)
        try:
            yield
        finally:
            for handler, level in zip(shown, levels, strict=True):
                handler.setLevel(level)


class _Cluster:
    """The workers of a scheduler, spoken to by a thread of its own."""

    def __init__(self, address: str, count: int, load: Load):
        self._address, self._count, self._load = address, count, load
        self._loop = asyncio.new_event_loop()
        self._loop.set_exception_handler(lambda *_: None)  # of what Dask leaves when it is cut short
        self._thread = threading.Thread(target=self._loop.run_forever, name="cluster", daemon=True)
        self._tasks: set[asyncio.Task[Any]] = set()
        self._lost: Lost | None = None
        self._numbers = itertools.count()
        self._run = uuid.uuid4().hex
        self._client: Any = None
        self._own: Any = None  #: the cluster that was started here
        self._watching: asyncio.Task[None] | None = None
        self._at_hand = asyncio.Event()  #: whether the scheduler answers
        self.places = 0  #: tasks that can be done at once

    # ------------------------------------------------------------ from any thread

    def open(self) -> None:
        self._thread.start()
        with uninterrupted():
            self._do(self._open())

    def submit(self, function: Callable[..., Any], *told: Any) -> Future[Any]:
        sent = self._load.packed(function, told)
        return asyncio.run_coroutine_threadsafe(self._result(sent), self._loop)

    def close(self) -> None:
        """Call off what is not done, and leave; workers that were started here end."""
        with uninterrupted():
            if self._thread.is_alive():
                with suppress(Exception):  # of a scheduler that is gone
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
            self._own = target = await distributed.LocalCluster(
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
                f"no scheduler answers at {self._address} (waited {CONNECT:g} s: {_line(fault)}); start one there, "
                "'dask scheduler', or name another"
            ) from None
        self._watching = asyncio.ensure_future(self._watch())

    async def _connected(self) -> Any:
        import distributed

        client = distributed.Client(
            self._target, asynchronous=True, timeout=CONNECT, set_as_default=False, name="coursework"
        )
        try:
            # Dask waits no longer for a connection; of one that is made and says nothing it would wait for ever.
            return await asyncio.wait_for(client, CONNECT + _BEAT)
        except BaseException:
            await _left(client)
            raise

    async def _close(self) -> None:
        for task in (*self._tasks, *([self._watching] if self._watching else ())):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for left in (self._client, self._own):
            if left is not None:
                await _left(left)

    async def _result(self, sent: bytes) -> Any:
        """What a task gave; raises what it raised, or :class:`Lost`."""
        if self._lost is not None:
            raise self._lost
        task = asyncio.current_task()
        assert task is not None
        self._tasks.add(task)
        try:
            made = await self._made(sent, f"coursework-{self._run}-{next(self._numbers)}")
        except asyncio.CancelledError:
            if self._lost is None:
                raise
            raise self._lost from None
        finally:
            self._tasks.discard(task)
        return self._load.unpacked(made)

    async def _made(self, sent: bytes, key: str) -> bytes:
        """The bytes that a worker makes of a task, which is sent again where the scheduler that knew of it is gone."""
        from distributed import KilledWorker

        for attempt in range(_ATTEMPTS):
            left: tuple[Any, ...] = ()
            try:
                left = self._sent(sent, f"{key}-{attempt}")
                made: bytes = await left[0]
                return made
            except KilledWorker:
                raise Lost(
                    f"a task ended every worker at {self._address} that took it: too little memory?"
                ) from None
            except (ImportError, AttributeError, pickle.UnpicklingError) as fault:
                raise _without_package(self._address, fault) from None
            except Exception as fault:  # the scheduler is gone, which is told in many ways; a task's own faults come as bytes
                said = _line(fault)
            finally:
                for future in left:
                    future.release()
            self._at_hand.clear()
            await self._at_hand.wait()
        raise Lost(f"the scheduler at {self._address} comes and goes ({said})")

    def _sent(self, task: bytes, key: str) -> tuple[Any, ...]:
        """What a task will give, and what it needs; the scheduler and the workers read it by what every Python has."""
        submit = self._client.submit
        content = submit(bytes, self._load.content, key=f"course-{self._load.key}", pure=False)
        return submit(pickle.loads, task, buffers=[content], key=key, pure=False), content

    async def _watch(self) -> None:
        """Know how many workers there are, and end the run where for long there is none."""
        seen = time.monotonic()
        while True:
            silent = await self._look()
            now = time.monotonic()
            if silent is None:
                seen = now
                self._at_hand.set()
            elif now - seen > PATIENCE:
                self._lost = Lost(f"{silent} (waited {PATIENCE:g} s)")
                for task in self._tasks:
                    task.cancel()
                return
            await asyncio.sleep(_BEAT)

    async def _look(self) -> str | None:
        """What is wrong with the cluster, if anything."""
        try:
            if self._client.status == "closed":
                self._client = await self._connected()
            threads = await asyncio.wait_for(self._client.nthreads(), CONNECT)
        except Exception:  # a network has many ways to fail
            self._at_hand.clear()
            return f"the scheduler at {self._address} answers no more"
        self.places = sum(threads.values())
        return None if threads else f"no worker is left at {self._address}"


async def _left(one: Any) -> None:
    """Leave a client or a cluster; who does not answer is left without."""
    with suppress(asyncio.TimeoutError, OSError):
        await asyncio.wait_for(one.close(), _CLOSING)


def _without_package(address: str, fault: Exception) -> CourseworkError:
    return CourseworkError(
        f"a worker at {address} has not this package, or another version of it ({_line(fault)}): "
        "install there what is installed here"
    )


def _line(fault: Exception) -> str:
    return (" ".join(str(fault).split()) or type(fault).__name__)[:160]
