"""Schedulers and workers as processes of their own, to be stopped, killed and started again."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import coursework

PACKAGE = Path(coursework.__file__).resolve().parents[1]


def free_port():
    with socket.socket() as asked:
        asked.bind(("127.0.0.1", 0))
        return asked.getsockname()[1]


class Machines:
    """A scheduler, which has not the package, and workers, which have; they end with the context."""

    def __init__(self, folder, **settings):
        self.folder, self.port = folder, free_port()
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
        self.environment |= {f"DASK_DISTRIBUTED__{k}": str(v) for k, v in settings.items()}
        self.started = []
        self._nothing = folder / "nothing"  #: where the package is empty, whatever else is installed
        (self._nothing / "coursework").mkdir(parents=True)
        (self._nothing / "coursework" / "__init__.py").touch()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.started:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait(30)

    def _start(self, *arguments, path=""):
        log = (self.folder / f"{len(self.started)}.log").open("wb")
        with log:
            process = subprocess.Popen(
                [sys.executable, "-P", "-m", "dask", *map(str, arguments)],
                stdout=log,
                stderr=subprocess.STDOUT,
                cwd=self.folder,
                start_new_session=True,
                env={**self.environment, "PYTHONPATH": str(path or self._nothing)},
            )
        self.started.append(process)
        return process

    def scheduler(self):
        process = self._start(
            "scheduler",
            "--host",
            "127.0.0.1",
            "--port",
            self.port,
            "--no-dashboard",
            "--no-show",
            "--idle-timeout",
            "300s",
        )
        self.wait_for(lambda: socket.create_connection(("127.0.0.1", self.port), 1).close() is None)
        return process

    def worker(self, *options, path=PACKAGE):
        return self._start(
            "worker",
            self.address,
            "--nthreads",
            1,
            "--no-dashboard",
            "--local-directory",
            self.folder,
            *options,
            path=path,
        )

    def workers(self, count, *options):
        started = [self.worker(*options) for _ in range(count)]
        self.wait_for(lambda: self.count() >= count)
        return started

    def count(self):
        """How many workers the scheduler knows."""
        return int(self.asked("len(s.workers)"))

    def asked(self, what):
        """What the scheduler, ``s``, says in a process of its own."""
        code = (
            "import sys, distributed\n"
            "with distributed.Client(sys.argv[1], timeout=5, set_as_default=False) as client:\n"
            "    print(client.run_on_scheduler(eval('lambda dask_scheduler: (lambda s: ' + sys.argv[2] "
            "+ ')(dask_scheduler)')))\n"
        )
        told = [sys.executable, "-c", code, self.address, what]
        return subprocess.run(
            told, capture_output=True, text=True, check=True, env=self.environment
        ).stdout.strip()

    @staticmethod
    def wait_for(holds, seconds=60):
        end = time.monotonic() + seconds
        while True:
            with suppress(OSError, subprocess.CalledProcessError):
                if holds():
                    return
            assert time.monotonic() < end, "nothing came of it"
            time.sleep(0.1)
