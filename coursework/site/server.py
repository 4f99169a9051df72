"""The site on the network: an address to listen at, processes that answer, and a clean end."""

from __future__ import annotations

import errno
import logging
import logging.config
import multiprocessing
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coursework.api import open_course
from coursework.database.store import Store
from coursework.errors import BadInput, CourseworkError
from coursework.site.application import application
from coursework.site.frame.settings import Entrance, Site
from coursework.site.people.accounts import check_administrator
from coursework.site.worker import work
from coursework.system.processes import background_process, others_can_start, supervised_process

if TYPE_CHECKING:
    from uvicorn import Config

LOG = logging.getLogger("coursework.site")
_LAST_REQUESTS = 15  #: seconds that requests under way are given when the server ends
_SILENCE = 60  #: seconds after which a process that says nothing is taken for dead
_WAITING = 1024  #: connections that may wait to be answered
_MOST_FILES = 65_536  #: and connections that a process holds, where the machine lets it
_PROTOCOL = "coursework.site.connections:Stamped"
_KEEP_ALIVE = 75  #: seconds that a connection may rest: longer than browsers and proxies rest theirs before they use them again
_NICENESS = 10  #: of the worker: requests go before
_AGAIN = 2.0  #: seconds before a process that could not begin is begun again
Application = Callable[..., Any]


@dataclass(frozen=True)
class ServerSettings:
    """Settings of a process that serves the site."""

    course: str | None  #: its folder; the built-in course where none is told
    db: str
    entrance: Entrance
    url: str
    lti: Path | None = None  #: folder of the platforms
    worker: str = ""  #: name under which a worker marks beside the processes that answer; none where they mark themselves

    def site(self) -> Site:
        """Return the site.

        Raises
        ------
        CourseworkError
            The course or the database cannot be opened.
        """
        course, store = open_course(self.course), Store(self.db)
        return Site(course, store, self.entrance, self.url, lti=self.lti, has_worker=bool(self.worker))

    def check(self) -> str:
        """Try once what every process will do; the database is made, or brought to this version. Gives where it is.

        Raises
        ------
        CourseworkError
            The course or the database cannot be opened, or nobody could come in to teach.
        """
        site = self.site()
        check_administrator(site)
        site.store.close()
        return site.store.shown


def listening(host: str, port: int) -> socket.socket:
    """Return a listening socket; on any free port if 0 is given.

    Raises
    ------
    BadInput
        The port is taken or not ours to take, or the machine has no such address.
    """
    if port > 65535:
        raise BadInput(f"--port {port}: a port is a number from 0 to 65535")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family, backlog=_WAITING)
    except OSError as fault:
        raise BadInput(_refusal(host, port, fault)) from fault


def _refusal(host: str, port: int, fault: OSError) -> str:
    if fault.errno == errno.EADDRINUSE:
        return (
            f"port {port} of {host} is taken, perhaps by another 'coursework serve': end that one, or say another, "
            f"--port {port + 1 if port < 65535 else port - 1}, or --port 0 for any that is free"
        )
    if fault.errno == errno.EACCES:
        return f"port {port} is kept for the system: say one from 1024 on, and let a proxy in front listen at {port}"
    return (
        f"--host {host}: this machine cannot listen there ({fault.strerror or fault}); 127.0.0.1 is this machine alone, "
        "0.0.0.0 every address that it has"
    )


def serve(serving: ServerSettings, at: socket.socket, workers: int, ready: Callable[[], None]) -> None:
    """Answer until a signal says to end (Ctrl-C, SIGTERM, a closed terminal); requests under way are answered first.

    ``ready`` is called once such a signal is heeded.
    """
    is_shared = serving.entrance is Entrance.ACCOUNTS
    run(partial(_application, serving), at, workers, ready=ready, tells_all=is_shared, has_proxy=is_shared)


def run(
    make_application: Callable[[], Application],
    at: socket.socket,
    workers: int = 1,
    *,
    ready: Callable[[], None],
    tells_all: bool = False,
    has_proxy: bool = False,
) -> None:
    """Serve the application that ``make_application`` gives in each process; ``ready`` is called once a signal to end is heeded.

    ``tells_all`` writes a line of the log for each request, not for faults alone; ``has_proxy`` believes a proxy on this
    machine who asks.
    """
    from uvicorn import Config

    config = Config(
        partial(_application_of_process, make_application), factory=True, workers=workers, log_config=_logs(tells_all), access_log=False, server_header=False,
        proxy_headers=has_proxy, forwarded_allow_ips="127.0.0.1",
        timeout_keep_alive=_KEEP_ALIVE, http=_PROTOCOL, timeout_graceful_shutdown=_LAST_REQUESTS, timeout_worker_healthcheck=_SILENCE,
    )  # fmt: skip
    _open_more()
    if workers > 1:
        _run_workers(config, at, ready)
    else:
        _run_single(config, at, ready)


def _open_more() -> None:
    """Raise the limit on open connections to the system's maximum, since slow clients can fill the usual
    1024."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(
            resource.RLIMIT_NOFILE, (min(most, _MOST_FILES) if most > 0 else _MOST_FILES, most)
        )


def _logs(tells_all: bool) -> dict[str, Any]:
    """Return the configuration of the log on standard error."""
    return {
        "version": 1,
        "disable_existing_loggers": False,
        "formatters": {
            "line": {
                "class": "coursework.system.log_lines.VisibleLines",
                "format": "%(asctime)s %(levelname)s %(message)s",
            }
        },
        "handlers": {"out": {"class": "logging.StreamHandler", "formatter": "line"}},
        "loggers": {
            "coursework": {"handlers": ["out"], "level": "INFO" if tells_all else "WARNING"},
            "uvicorn": {"handlers": ["out"], "level": "WARNING"},
            "python_multipart": {"level": "ERROR"},  # its warnings quote what was sent
        },
    }


def _run_single(config: Config, at: socket.socket, ready: Callable[[], None]) -> None:
    from uvicorn import Server

    server = Server(config)
    for number in (signal.SIGINT, signal.SIGTERM):  # heeded before it listens, and behind its end once more
        signal.signal(number, server.handle_exit)
    _end_with_terminal(lambda: signal.raise_signal(signal.SIGTERM))
    ready()
    server.run(sockets=[at])


def _run_workers(config: Config, at: socket.socket, ready: Callable[[], None]) -> None:
    from uvicorn.supervisors import Multiprocess

    supervisor = Multiprocess(config, sockets=[at])
    _end_with_terminal(lambda: supervisor.signal_queue.append(signal.SIGTERM))
    ready()
    supervisor.run()


def _end_with_terminal(end: Callable[[], None]) -> None:
    """End the server when its terminal is closed, unless it was started to outlive it."""
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        signal.signal(signal.SIGHUP, lambda *_: end())


def _application_of_process(make_application: Callable[[], Application]) -> Application:
    """Return the application of this process, which ends with its parent process."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return make_application()
    threading.Thread(target=_follow, args=(parent.join,), daemon=True).start()
    try:
        return make_application()
    except CourseworkError as fault:  # what stood when the server began, and is out of reach for a while
        LOG.error("%s", fault)
        time.sleep(_AGAIN)
        sys.exit(1)


def _follow(ended: Callable[[], None]) -> None:
    ended()
    os.kill(os.getpid(), signal.SIGTERM)


def worker_name() -> str:
    """Name of the worker of this server, which those that follow it bear too; none where none can start."""
    return f"{socket.gethostname()[:40]} {os.getpid()}" if others_can_start() else ""


def working(serving: ServerSettings) -> AbstractContextManager[None]:
    """Start one process, whatever the number of server processes, that marks submissions and submits saved
    answers; none for a site without a worker."""
    return supervised_process(_NICENESS, _work, serving) if serving.worker else nullcontext()


def _work(serving: ServerSettings) -> None:
    logging.config.dictConfig(_logs(False))
    try:
        work(serving.site(), serving.worker)
    except CourseworkError as fault:  # the database is away: another one is begun in a while
        LOG.error("%s", fault)


def filling(serving: ServerSettings) -> AbstractContextManager[None]:
    """Start one process, whatever the number of server processes, that searches variants for practice; none
    if all were found."""
    site = serving.site()
    try:
        return nullcontext() if site.pool.is_filled() else background_process(_fill, serving)
    finally:
        site.store.close()


def _fill(serving: ServerSettings) -> None:
    try:
        serving.site().pool.fill()
    except (
        CourseworkError
    ) as fault:  # the database is away: the rest is found when it is asked for, or at the next start
        LOG.error("%s", fault)


def _application(serving: ServerSettings) -> Application:
    return application(serving.site())
