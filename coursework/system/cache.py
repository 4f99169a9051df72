"""Cache between runs, in the user's cache folder. The package works without it."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

_SETTLED = 2_000_000_000  #: ns after which a further change of a file alters its dates, on any file system


def load(name: str) -> Any:
    """Return the content stored under a name; None if there is none or it cannot be read."""
    with suppress(OSError, ValueError, RuntimeError):
        return json.loads((_folder() / name).read_text("utf-8"))
    return None


def store(name: str, content: Any) -> None:
    """Store JSON content under a name, atomically; do nothing if the folder cannot be written."""
    with suppress(OSError, RuntimeError):
        folder = _folder()
        folder.mkdir(parents=True, exist_ok=True)
        begun = folder / f"{name}.{os.getpid()}"
        try:
            begun.write_text(json.dumps(content), "utf-8")
            begun.replace(folder / name)
        finally:
            begun.unlink(missing_ok=True)


def _folder() -> Path:
    """Return the cache folder: ``XDG_CACHE_HOME`` if set, else that of the system; RuntimeError if there is
    no home folder."""
    configured = os.environ.get("XDG_CACHE_HOME", "")
    if os.path.isabs(configured):
        return Path(configured) / "coursework"
    if sys.platform == "win32":
        return (
            Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "coursework" / "Cache"
        )
    return Path.home() / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "coursework"


def cached_result(files: Sequence[Path], name: str, make: Callable[[], Any]) -> Any:
    """Return the result of ``make``, which depends on ``files``; an earlier run's result if no file has
    changed since.

    The result consists of dictionaries, lists, texts, numbers and truth values.
    """
    begun, now = time.time_ns(), {str(file): state(str(file)) for file in files}
    match load(name):
        case [was, content] if was == now:
            return content
    content = make()
    if is_settled(now.values(), begun):
        store(name, [now, content])
    return content


def is_settled(states_now: Iterable[State], begun: int) -> bool:
    """Return whether no file changed just before a time; otherwise it might change again within the
    resolution of its dates."""
    return (
        max((date for file_state in states_now for date in file_state[1:]), default=begun) < begun - _SETTLED
    )


#: Of a file: size, last change of its content and of its entry, ns; nothing where there is none.
State = list[int]


def states(*folders: Path) -> dict[str, State]:
    """Return the state of all files below some folders, without files that Python compiled."""
    return {path: state(path) for folder in folders for path in _files(str(folder), set())}


def state(path: str) -> State:
    """Return the state of a file now."""
    try:
        status = os.stat(path)
    except OSError:
        return []
    return [status.st_size, status.st_mtime_ns, status.st_ctime_ns]


def _files(folder: str, met: set[tuple[int, int]]) -> Iterator[str]:
    try:
        entries = list(os.scandir(folder))
    except OSError:  # an unreadable folder has no files
        return
    for entry in entries:
        if not entry.is_dir():
            yield entry.path
        elif entry.name != "__pycache__":
            there = os.stat(entry.path)
            if (inode := (there.st_dev, there.st_ino)) not in met:  # links may form a loop
                met.add(inode)
                yield from _files(entry.path, met)
