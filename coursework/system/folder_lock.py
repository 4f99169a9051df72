"""Lock of a folder that one command at a time writes: of the operating system, on a file in it that names the
process.

The system releases the lock when the process ends, however that ends; the file goes at the command's end.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from coursework.errors import BadInput

LOCK = ".coursework.lock"
_RELEASING = 0.2  #: seconds in which another command may release the lock that it has
_POLL = 0.01  #: seconds between two attempts meanwhile


@contextmanager
def only_writer(folder: Path, command: str = "") -> Iterator[None]:
    """Lock a folder against other commands while the context lasts.

    The folder is created if it is missing; folders that were created and stay empty are removed.

    Raises
    ------
    BadInput
        Another command writes into it, or nobody can.
    """
    from coursework.system.writing import writing  # processes with it, which a notebook's lock does without

    created = _missing(folder)
    path = folder.resolve() / LOCK
    try:
        with ExitStack() as locked:
            with writing(folder):
                if not locked.enter_context(file_lock(path, _RELEASING)):
                    raise BadInput(
                        "another command is writing into {folder}: {owner}; wait until it has ended, "
                        "or choose another folder",
                        folder=folder,
                        owner=_owner(path),
                    )
                path.write_text(f"coursework {command}, PID {os.getpid()}, {socket.gethostname()}", "utf-8")
            yield
    finally:
        for made in created:
            with suppress(OSError):  # not empty
                made.rmdir()


def _owner(path: Path) -> str:
    with suppress(OSError):  # the lock has been released meanwhile
        return " ".join(path.read_text("utf-8", "replace").split())[:200]
    return "?"


@contextmanager
def file_lock(path: Path, seconds: float) -> Iterator[bool]:
    """Lock a file, which is made and removed, while the context lasts; yield whether it was free within some
    seconds."""
    from filelock import FileLock, Timeout

    lock = FileLock(path, timeout=seconds, poll_interval=_POLL, mode=0o644)
    with suppress(Timeout):
        while not lock.is_locked:
            path.parent.mkdir(parents=True, exist_ok=True)
            with suppress(FileNotFoundError):  # another process made the folder and has removed it
                lock.acquire()
    try:
        yield lock.is_locked
    finally:
        if lock.is_locked:
            with suppress(OSError):  # the folder may be gone
                path.unlink()  # before its release: who waits for the lock makes another file
            lock.release()


def is_bare(folder: Path) -> bool:
    """Return whether a folder is missing or empty, apart from its lock."""
    return not folder.exists() or all(path.name == LOCK for path in folder.iterdir())


def _missing(folder: Path) -> list[Path]:
    """Return the folders to create, the innermost first."""
    return [path for path in (folder, *folder.parents) if not path.exists()]
