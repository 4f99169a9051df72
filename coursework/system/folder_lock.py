"""A folder that one command at a time writes: the lock is a file in it that names the process, and goes with the command.

Made in one step (``O_EXCL``), which holds on shared folders too. A lock whose process is gone is taken over: one whose number
is no longer given, or is given to a process that began at another time, or was given before the machine was started.
Of a process on another machine nothing can be told, so its lock stands.
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
_FILLED = 2.0  #: seconds that a lock may stand without saying whose it is
_LOOK = 0.05  #: seconds between two looks at it

Owner = dict[str, Any]  #: of a lock: number and start of its process, where it runs


@contextmanager
def only_writer(folder: Path, command: str = "") -> Iterator[None]:
    """While the context lasts no other command writes into a folder, which is made where it is not there; what was made for it
    and stays empty goes.

    Raises
    ------
    BadInput
        Another command writes into it, or nobody can.
    """
    made = _missing(folder)
    lock, own = folder.resolve() / LOCK, _own(command)
    with writing(folder):
        _take(lock, own, folder)
    try:
        yield
    finally:
        _let_go(lock, own)
        for one in made:
            with suppress(OSError):  # something was written
                one.rmdir()


def is_bare(folder: Path) -> bool:
    """Whether nothing stands in a folder, or none is there; who writes it does not count."""
    return not folder.exists() or all(path.name == LOCK for path in folder.iterdir())


def _missing(folder: Path) -> list[Path]:
    """The folders that are to be made, the innermost first."""
    return [one for one in (folder, *folder.parents) if not one.exists()]


def _take(lock: Path, own: Owner, folder: Path) -> None:
    while not _stands(lock, own):
        found = _owner(lock)
        if found is None:
            continue  # it has gone meanwhile
        if not _is_gone(found):
            raise BadInput(_busy(found, folder, lock))
        _take_away(lock, found)


def _stands(lock: Path, own: Owner) -> bool:
    """Whether the lock was made, in a folder that may be made and taken away by others meanwhile."""
    while True:
        lock.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            return _made(lock, own)


def _made(path: Path, content: Owner) -> bool:
    """Whether the file was made, which it is by one process alone."""
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


def _let_go(lock: Path, own: Owner) -> None:
    with suppress(OSError):  # somebody has taken the folder away
        if _said(lock) == own:
            lock.unlink()


def _take_away(lock: Path, found: Owner) -> None:
    """Take a lock away whose process is gone: by one process alone, so that no other lock goes in its place."""
    taker = lock.with_name(f"{LOCK}.{found.get('pid', 0)}-{found.get('began', '')}".replace("/", "-"))
    if not _made(taker, {}):
        time.sleep(_LOOK)
        with suppress(FileNotFoundError):
            if time.time() - taker.stat().st_mtime > _FILLED:  # who took it away was stopped in between
                taker.unlink()
        return
    try:
        if _said(lock) == found:
            lock.unlink(missing_ok=True)
    finally:
        taker.unlink(missing_ok=True)


# ------------------------------------------------------------------- whose it is


def _owner(lock: Path) -> Owner | None:
    """Whose lock it is; of nobody where it says nothing after a while, as one does that a failing machine left; None where
    it has gone."""
    last = time.monotonic() + _FILLED
    while not (found := _said(lock)):
        if not os.path.lexists(lock):
            return None
        if time.monotonic() > last:
            return {}
        time.sleep(_LOOK)
    return found


def _said(lock: Path) -> Owner:
    with suppress(OSError, ValueError, RecursionError):
        found = json.loads(lock.read_bytes())
        return found if isinstance(found, dict) else {}
    return {}


def _own(command: str) -> Owner:
    return {**_here(), "pid": os.getpid(), "began": _began(os.getpid()), "command": command}


def _here() -> Owner:
    """The machine, since when it runs, and which of its numbers of processes are meant: a container has its own."""
    return {
        "host": socket.gethostname(),
        "boot": _text("/proc/sys/kernel/random/boot_id"),
        "numbers": _link("/proc/self/ns/pid"),
    }


def _is_gone(owner: Owner) -> bool:
    """Whether the process of a lock has ended, as far as this machine knows."""
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
    began = _began(number)
    return began is None or ("" not in (began, owner.get("began")) and began != owner.get("began"))


def _began(number: int) -> str | None:
    """When a process began, in the system's own words, nothing where it does not say; None where there is none of the number."""
    if sys.platform == "win32":
        told = _output("tasklist", "/FI", f"PID eq {number}", "/FO", "CSV", "/NH")
        return "" if f'"{number}"' in told else None
    try:
        os.kill(number, 0)
    except (ProcessLookupError, OverflowError):
        return None
    except PermissionError:
        pass  # it is there, and somebody else's
    if sys.platform != "linux":
        return _output("ps", "-o", "lstart=", "-p", str(number)).strip()
    stat = _text(f"/proc/{number}/stat").rpartition(")")[2].split()  # its name may hold anything
    if stat[:1] in (["Z"], ["X"]):
        return None  # it has ended, and nobody has asked how
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
    whose = f"process {owner.get('pid')} on {owner.get('host')}"
    command = f" (coursework {owner['command']})" if owner.get("command") else ""
    away = ""
    if owner.get("host") != socket.gethostname() or owner.get("numbers") != _link("/proc/self/ns/pid"):
        away = f"; should it have been stopped there, take {lock} away"
    return f"another command is writing into {folder}: {whose}{command}; wait until it has ended, or choose another folder{away}"
