"""What is kept from one run to the next, in the user's folder for that: never needed, and not missed where it cannot be."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any


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
