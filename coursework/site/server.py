"""Server of the site: its socket, its processes, and their termination."""

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
from coursework.errors import BadInput, CourseworkError, reason_of
from coursework.messages import Message
from coursework.site.application import application
from coursework.site.frame.settings import Entrance, Site
from coursework.site.people.accounts import check_administrator
from coursework.site.worker import work
from coursework.system.processes import background_process, others_can_start, supervised_process

if TYPE_CHECKING:
    from uvicorn import Config

LOG = logging.getLogger("coursework.site")
_LAST_REQUESTS = 15  #: seconds that requests under way have when the server terminates
_SILENCE = 60  #: seconds after which a silent process counts as dead
_WAITING = 1024  #: connections that may wait
_MOST_FILES = 65_536  #: files and connections of a process, if the system allows it
_PROTOCOL = "coursework.site.connections:Stamped"
_KEEP_ALIVE = 75  #: idle seconds of a connection: longer than browsers and proxies reuse theirs
_NICENESS = 10  #: of the worker, so that requests take precedence
_AGAIN = 2.0  #: seconds before the restart of a process that could not start
Application = Callable[..., Any]


@dataclass(frozen=True)
class ServerSettings:
    """Settings of a process that serves the site."""

    course: str | None  #: its folder; None for the built-in course
    db: str
    entrance: Entrance
    url: str
    lti: Path | None = None  #: folder of the platforms
    worker: str = ""  #: name of the worker; empty if the server processes mark submissions themselves

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
        """Open the site once, as every process will; the database is created or upgraded. Return its
        location.

        Raises
        ------
        CourseworkError
            The course or the database cannot be opened, or no administrator has an account.
        """
        site = self.site()
        check_administrator(site)
        site.store.close()
        return site.store.display_name


def listening(host: str, port: int) -> socket.socket:
    """Return a listening socket; on any free port if 0 is given.

    Raises
    ------
    BadInput
        The port is in use or reserved, or the machine has no such address.
    """
    if port > 65535:
        raise BadInput("--port {port}: a port is a number from 0 to 65535", port=port)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family, backlog=_WAITING)
    except OSError as fault:
        raise BadInput(_refusal(host, port, fault)) from fault


def _refusal(host: str, port: int, fault: OSError) -> Message:
    if fault.errno == errno.EADDRINUSE:
        return Message(
            (
                "port {port} of {host} is in use, perhaps by another 'coursework serve': stop that "
                "one, or choose "
                "another, --port {other}, or --port 0 for any free one"
            ),
            port=port,
            host=host,
            other=port + 1 if port < 65535 else port - 1,
        )
    if fault.errno == errno.EACCES:
        return Message(
            (
                "port {port} is reserved for the system: choose one from 1024 on, and let a proxy "
                "listen at {port}"
            ),
            port=port,
        )
    return Message(
        (
            "--host {host}: this machine cannot listen there ({problem}); 127.0.0.1 is for this "
            "machine only, "
            "0.0.0.0 for every address of it"
        ),
        host=host,
        problem=reason_of(fault),
    )


def serve(serving: ServerSettings, at: socket.socket, workers: int, ready: Callable[[], None]) -> None:
    """Serve until a signal to terminate (Ctrl-C, SIGTERM, a closed terminal); requests under way are
    answered first.

    ``ready`` is called once the signals are handled.
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
    """Serve the application that ``make_application`` gives in each process; ``ready`` is called once the
    signals are handled.

    ``tells_all`` logs every request instead of faults alone; ``has_proxy`` trusts the client's address from
    a proxy on this machine.
    """
    from uvicorn import Config

    config = Config(
        partial(_application_of_process, make_application),
        factory=True,
        workers=workers,
        log_config=_logs(tells_all),
        access_log=False,
        server_header=False,
        proxy_headers=has_proxy,
        forwarded_allow_ips="127.0.0.1",
        timeout_keep_alive=_KEEP_ALIVE,
        http=_PROTOCOL,
        timeout_graceful_shutdown=_LAST_REQUESTS,
        timeout_worker_healthcheck=_SILENCE,
    )
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
    for number in (signal.SIGINT, signal.SIGTERM):  # handled before it listens and after its end
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
    except CourseworkError as fault:  # it was available at the start and is not for now
        LOG.error("%s", fault)
        time.sleep(_AGAIN)
        sys.exit(1)


def _follow(ended: Callable[[], None]) -> None:
    ended()
    os.kill(os.getpid(), signal.SIGTERM)


def worker_name() -> str:
    """Return the name of this server's worker, also used by its successors; empty if no process can be
    started."""
    return f"{socket.gethostname()[:40]} {os.getpid()}" if others_can_start() else ""


def working(serving: ServerSettings) -> AbstractContextManager[None]:
    """Start one process, whatever the number of server processes, that marks submissions and submits saved
    answers; none for a site without a worker."""
    return supervised_process(_NICENESS, _work, serving) if serving.worker else nullcontext()


def _work(serving: ServerSettings) -> None:
    logging.config.dictConfig(_logs(False))
    try:
        work(serving.site(), serving.worker)
    except CourseworkError as fault:  # the database is unavailable: another worker starts later
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
    ) as fault:  # the database is unavailable: the rest is found on request or at the next start
        LOG.error("%s", fault)


def _application(serving: ServerSettings) -> Application:
    return application(serving.site())
