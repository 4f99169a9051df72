"""Lock of a folder that one command at a time writes: a file in it that names the process, removed at the
command's end.

The file is created in one step (``O_EXCL``), which works on shared folders too. A lock is taken over if its
process is gone: the process number is free, belongs to a process that started at another time, or dates from
before the machine's start. The state of a process on another machine is unknown, so its lock stays.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from coursework.errors import BadInput
from coursework.system.writing import writing

LOCK = ".coursework.lock"
_FILLED = 2.0  #: seconds that a lock may stay empty
_LOOK = 0.05  #: seconds between two reads of it

Owner = dict[str, Any]  #: of a lock: number, start and machine of its process


@contextmanager
def only_writer(folder: Path, command: str = "") -> Iterator[None]:
    """Lock a folder against other commands while the context lasts.

    The folder is created if it is missing; folders that were created and stay empty are removed.

    Raises
    ------
    BadInput
        Another command writes into it, or nobody can.
    """
    created = _missing(folder)
    lock, owner = folder.resolve() / LOCK, _this_process(command)
    with writing(folder):
        _acquire(lock, owner, folder)
    try:
        yield
    finally:
        _release(lock, owner)
        for path in created:
            with suppress(OSError):  # not empty
                path.rmdir()


def is_bare(folder: Path) -> bool:
    """Return whether a folder is missing or empty, apart from its lock."""
    return not folder.exists() or all(path.name == LOCK for path in folder.iterdir())


def _missing(folder: Path) -> list[Path]:
    """Return the folders to create, the innermost first."""
    return [path for path in (folder, *folder.parents) if not path.exists()]


def _acquire(lock: Path, owner: Owner, folder: Path) -> None:
    while not _acquired(lock, owner):
        holder = _owner(lock)
        if holder is None:
            continue  # removed meanwhile
        if not _is_gone(holder):
            raise BadInput(_busy(holder, folder, lock))
        _remove_stale(lock, holder)


def _acquired(lock: Path, owner: Owner) -> bool:
    """Return whether this call created the lock, in a folder that others may create and remove meanwhile."""
    while True:
        lock.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            return _create(lock, owner)


def _create(path: Path, content: Owner) -> bool:
    """Return whether this call created the file; only one process can."""
    try:
        file = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o644)
    except FileExistsError:
        return False
    try:
        os.write(file, json.dumps(content).encode())
    except OSError:  # the disk is full
        path.unlink(missing_ok=True)
        raise
    finally:
        os.close(file)
    return True


def _release(lock: Path, owner: Owner) -> None:
    with suppress(OSError):  # the folder may be gone
        if _content(lock) == owner:
            lock.unlink()


def _remove_stale(lock: Path, holder: Owner) -> None:
    """Remove a lock whose process is gone. Only one process does so, and no newer lock is removed in its
    place."""
    taker = lock.with_name(f"{LOCK}.{holder.get('pid', 0)}-{holder.get('began', '')}".replace("/", "-"))
    if not _create(taker, {}):
        time.sleep(_LOOK)
        with suppress(FileNotFoundError):
            if time.time() - taker.stat().st_mtime > _FILLED:  # the process that removes the lock has stopped
                taker.unlink()
        return
    try:
        if _content(lock) == holder:
            lock.unlink(missing_ok=True)
    finally:
        taker.unlink(missing_ok=True)


# ------------------------------------------------------------------- whose it is


def _owner(lock: Path) -> Owner | None:
    """Return the owner of a lock; empty if the file stays empty for a while, as after a crash of the machine;
    None if the lock is gone."""
    last = time.monotonic() + _FILLED
    while not (content := _content(lock)):
        if not os.path.lexists(lock):
            return None
        if time.monotonic() > last:
            return {}
        time.sleep(_LOOK)
    return content


def _content(lock: Path) -> Owner:
    with suppress(OSError, ValueError, RecursionError):
        content = json.loads(lock.read_bytes())
        return content if isinstance(content, dict) else {}
    return {}


def _this_process(command: str) -> Owner:
    return {**_here(), "pid": os.getpid(), "began": _start_time(os.getpid()), "command": command}


def _here() -> Owner:
    """Return the machine, its boot, and its numbering of processes: a container has its own."""
    return {
        "host": socket.gethostname(),
        "boot": _text("/proc/sys/kernel/random/boot_id"),
        "numbers": _link("/proc/self/ns/pid"),
    }


def _is_gone(owner: Owner) -> bool:
    """Return whether the process of a lock has ended, as far as this machine knows."""
    here = _here()
    if not owner:
        return True
    if owner.get("host") != here["host"]:
        return False
    if owner.get("boot") != here["boot"]:
        return True
    number = owner.get("pid")
    if owner.get("numbers") != here["numbers"] or not isinstance(number, int):
        return False
    began = _start_time(number)
    return began is None or ("" not in (began, owner.get("began")) and began != owner.get("began"))


def _start_time(number: int) -> str | None:
    """Return the start time of a process in the system's own format, "" if unknown; None if no process has
    the number."""
    if sys.platform == "win32":
        output = _output("tasklist", "/FI", f"PID eq {number}", "/FO", "CSV", "/NH")
        return "" if f'"{number}"' in output else None
    try:
        os.kill(number, 0)
    except (ProcessLookupError, OverflowError):
        return None
    except PermissionError:
        pass  # it exists and belongs to another user
    if sys.platform != "linux":
        return _output("ps", "-o", "lstart=", "-p", str(number)).strip()
    stat = _text(f"/proc/{number}/stat").rpartition(")")[2].split()  # the program's name may contain anything
    if stat[:1] in (["Z"], ["X"]):
        return None  # it has ended; its parent has not read the status
    return stat[19] if len(stat) > 19 else ""


def _output(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def _text(path: str) -> str:
    with suppress(OSError):
        return Path(path).read_text("utf-8", "replace").strip()
    return ""


def _link(path: str) -> str:
    with suppress(OSError):
        return os.readlink(path)
    return ""


def _busy(owner: Owner, folder: Path, lock: Path) -> str:
    process = f"process {owner.get('pid')} on {owner.get('host')}"
    command = f" (coursework {owner['command']})" if owner.get("command") else ""
    away = ""
    if owner.get("host") != socket.gethostname() or owner.get("numbers") != _link("/proc/self/ns/pid"):
        away = f"; should it have been stopped there, take {lock} away"
    return f"another command is writing into {folder}: {process}{command}; wait until it has ended, or choose another folder{away}"
