"""Lock of a folder that one command at a time writes: of the operating system, on a file in it that names the process.

The system releases the lock when the process ends, however that ends; the file goes at the command's end.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from coursework.errors import BadInput
from coursework.system.writing import writing

if TYPE_CHECKING:
    from filelock import FileLock

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
    from filelock import FileLock

    created = _missing(folder)
    path = folder.resolve() / LOCK
    lock = FileLock(path, timeout=_RELEASING, poll_interval=_POLL, mode=0o644)
    with writing(folder):
        _acquire(lock, folder)
    try:
        with writing(folder):
            path.write_text(f"coursework {command}, PID {os.getpid()}, {socket.gethostname()}", "utf-8")
        yield
    finally:
        with suppress(OSError):  # the folder may be gone
            path.unlink()  # before its release: who waits for the lock makes another file
        lock.release()
        for made in created:
            with suppress(OSError):  # not empty
                made.rmdir()


def _acquire(lock: FileLock, folder: Path) -> None:
    from filelock import Timeout

    while not lock.is_locked:
        folder.mkdir(parents=True, exist_ok=True)
        try:
            lock.acquire()
        except FileNotFoundError:
            continue  # another command made the folder and has removed it
        except Timeout:
            raise BadInput(
                "another command is writing into {folder}: {owner}; wait until it has ended, or choose another folder",
                folder=folder,
                owner=_owner(Path(lock.lock_file)),
            ) from None


def _owner(path: Path) -> str:
    with suppress(OSError):  # the lock has been released meanwhile
        return " ".join(path.read_text("utf-8", "replace").split())[:200]
    return "?"


@contextmanager
def file_lock(path: Path, seconds: float) -> Iterator[bool]:
    """Lock a file, which is made and removed, while the context lasts; yield whether it was free within some seconds."""
    from filelock import FileLock, Timeout

    lock = FileLock(path, timeout=seconds, poll_interval=_POLL)
    with suppress(Timeout):
        lock.acquire()
    try:
        yield lock.is_locked
    finally:
        if lock.is_locked:
            with suppress(OSError):
                path.unlink()
            lock.release()


def is_bare(folder: Path) -> bool:
    """Return whether a folder is missing or empty, apart from its lock."""
    return not folder.exists() or all(path.name == LOCK for path in folder.iterdir())


def _missing(folder: Path) -> list[Path]:
    """Return the folders to create, the innermost first."""
    return [path for path in (folder, *folder.parents) if not path.exists()]
