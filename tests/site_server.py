"""The site served by processes of its own, as 'coursework serve' does, and what becomes of them."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

COMMAND = "import sys; from coursework.cli import run; sys.exit(run(sys.argv[1:]))"
_PATIENCE = 90  #: seconds; so long that a busy machine is no fault


def until(what, seconds=_PATIENCE):
    """Wait until what ``what`` gives is true; that."""
    end = time.monotonic() + seconds
    while not (found := what()):
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)
    return found


class Served:
    """A command that serves; its address once it says it, its processes, its end."""

    def __init__(self, folder, *arguments):
        self.said, self.log = Path(folder, "said.txt"), Path(folder, "log.txt")
        with self.said.open("w") as said, self.log.open("w") as log:
            self.process = subprocess.Popen(
                [sys.executable, "-c", COMMAND, *map(str, arguments)],
                stdout=said,
                stderr=log,
                stdin=subprocess.DEVNULL,
                cwd=folder,
                start_new_session=True,
            )
        self.url = until(self._address)

    def _address(self):
        assert self.process.poll() is None, self.log.read_text()
        found = re.search(r"(http\S+?)/? ", self.said.read_text())
        return found and found[1]

    @property
    def workers(self):
        """Numbers of the processes that answer."""
        return [one for one in self._begun() if niceness(one) not in (10, 19)]

    @property
    def markers(self):
        """Numbers of the processes that mark what was handed in."""
        return [one for one in self._begun() if niceness(one) == 10]

    @property
    def fillers(self):
        """Numbers of the processes that find variants ahead."""
        return [one for one in self._begun() if niceness(one) == 19]

    def _begun(self):
        tasks = Path(f"/proc/{self.process.pid}/task").glob("*/children")  # each thread has its own
        children = [one for task in tasks for one in task.read_text().split()]
        return [int(one) for one in children if b"spawn_main" in Path(f"/proc/{one}/cmdline").read_bytes()]

    def kill(self):
        """End the first process as a fault of the machine does."""
        self.process.kill()
        self.process.wait()

    def end(self, number=signal.SIGTERM):
        """End it as its keeper does; gives the exit status."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        return self.process.wait(_PATIENCE)

    def __enter__(self):
        return self

    def __exit__(self, *fault):
        self.end()


def lives(pid):
    """Whether a process is there, and no mere entry of a table."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def niceness(pid):
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[16])


def kill(pid):
    os.kill(pid, signal.SIGKILL)
