"""What is kept from one run to the next, in the user's folder for that: never needed, and not missed where it cannot be."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

_SETTLED = 2_000_000_000  #: ns after which another change of a file shows in its dates, on any file system


def kept(name: str) -> Any:
    """What was kept under a name; None where nothing was, or where it cannot be read."""
    with suppress(OSError, ValueError, RuntimeError):
        return json.loads((_folder() / name).read_text("utf-8"))
    return None


def keep(name: str, content: Any) -> None:
    """Keep what JSON holds under a name. It takes its place whole; where nothing can be written, nothing is."""
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
    """``XDG_CACHE_HOME`` where it is set, else where the system has such files; RuntimeError where there is no home."""
    told = os.environ.get("XDG_CACHE_HOME", "")
    if os.path.isabs(told):
        return Path(told) / "coursework"
    if sys.platform == "win32":
        return (
            Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "coursework" / "Cache"
        )
    return Path.home() / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "coursework"


def made_of(files: Sequence[Path], name: str, make: Callable[[], Any]) -> Any:
    """Return what ``make`` makes of some files, or what an earlier run kept of it under a name while none has changed since.

    What is made holds tables, lists, texts, numbers and truth values, no more.
    """
    begun, now = time.time_ns(), {str(file): state(str(file)) for file in files}
    match kept(name):
        case [was, content] if was == now:
            return content
    content = make()
    if is_settled(now.values(), begun):
        keep(name, [now, content])
    return content


def is_settled(found: Iterable[State], begun: int) -> bool:
    """Whether no file was changed just before a time: it might change again within the grain of its dates."""
    return max((date for one in found for date in one[1:]), default=begun) < begun - _SETTLED


State = list[
    int
]  #: of a file: size, last change of its content and of its entry, ns; nothing where there is none


def states(*folders: Path) -> dict[str, State]:
    """The files in some folders, at any depth, as they are now; what Python compiled is left out."""
    return {path: state(path) for folder in folders for path in _files(str(folder), set())}


def state(path: str) -> State:
    """A file as it is now."""
    try:
        found = os.stat(path)
    except OSError:
        return []
    return [found.st_size, found.st_mtime_ns, found.st_ctime_ns]


def _files(folder: str, met: set[tuple[int, int]]) -> Iterator[str]:
    try:
        entries = list(os.scandir(folder))
    except OSError:  # a folder that nobody may read gives nothing to anybody
        return
    for entry in entries:
        if not entry.is_dir():
            yield entry.path
        elif entry.name != "__pycache__":
            there = os.stat(entry.path)
            if (place := (there.st_dev, there.st_ino)) not in met:  # a link may lead in a circle
                met.add(place)
                yield from _files(entry.path, met)
