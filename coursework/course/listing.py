"""Descriptions of every exercise of a course, cached from one run to the next.

To say it, an exercise is loaded, and with it much that takes a second for a whole course. So what was said is
kept with the state of every file that it came from: those of ``exercises/``, of ``templates/``, of the
engine, and of whatever else was loaded by then. Where one of them was changed, added or taken away,
the listing is made again.
"""

from __future__ import annotations

import sys
import time
import zlib
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from coursework.course.folder import Folder
from coursework.errors import CourseworkError
from coursework.system.cache import State, is_settled, load, state, states, store

_ENGINE = Path(__file__).parent.parent


class Listing(NamedTuple):
    """Descriptions of the exercises of a course, and by name the faults of those that cannot be described."""

    rows: list[dict[str, Any]]
    faults: dict[str, str]


class _CachedListing(NamedTuple):
    """Cached listing: the Python that made it, the states of its source files, and the descriptions by
    name."""

    python: list[str]
    files: dict[str, State]  #: of the course and of the engine
    loaded: dict[str, State]  #: of what else was loaded
    said: dict[str, dict[str, Any]]


def listing(folder: Folder, describe: Callable[[str], dict[str, Any]]) -> Listing:
    """Return the description of each exercise by its name, in the order in which they are learnt; call
    ``describe`` where the cache has none."""
    begun = time.time_ns()
    cached = _cached(folder)
    descriptions, faults = {}, {}
    for name in folder.in_order:
        try:
            descriptions[name] = cached.said[name] if name in cached.said else describe(name)
        except CourseworkError as fault:
            faults[name] = str(fault)
    if descriptions.keys() != cached.said.keys():
        _remember(
            folder,
            cached._replace(loaded={**cached.loaded, **_loaded(cached.files)}, said=descriptions),
            begun,
        )
    return Listing(list(descriptions.values()), faults)


def _cached(folder: Folder) -> _CachedListing:
    """Return the cached listing where every file is unchanged; else the present states of the files, and no
    description."""
    # Which Python loads the exercises, and where it looks for what they import.
    python = [sys.version, *sys.path]
    files = states(folder.root / "exercises", folder.root / "templates", _ENGINE)
    with suppress(TypeError, AttributeError):
        cached = _CachedListing(**load(_name(folder)))
        if (cached.python, cached.files) == (python, files) and all(
            state(path) == was for path, was in cached.loaded.items()
        ):
            return cached
    return _CachedListing(python, files, {}, {})


def _loaded(files: Mapping[str, State]) -> dict[str, State]:
    """Return the files of modules that were loaded, besides some files and those of Python itself."""
    modules = [(name, getattr(module, "__file__", None)) for name, module in list(sys.modules.items())]
    return {
        path: state(path)
        for name, path in modules
        if path and path not in files and name.partition(".")[0] not in sys.stdlib_module_names
    }


def _remember(folder: Folder, content: _CachedListing, begun: int) -> None:
    """Keep it, unless a file was changed just now: it may change again within the grain of its dates."""
    if is_settled((*content.files.values(), *content.loaded.values()), begun):
        store(_name(folder), content._asdict())


def _name(folder: Folder) -> str:
    return f"exercises-{folder.root.name}-{zlib.crc32(str(folder.root).encode()):08x}.json"
