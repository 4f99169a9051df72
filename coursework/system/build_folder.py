"""A folder that builds write into: a build replaces what builds wrote there, and nothing else.

``.built.json`` in the folder lists what builds wrote, by the digests of the contents. A file that is not on it, or
whose content is another, is somebody's own.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from contextlib import ExitStack, suppress
from pathlib import Path, PurePosixPath

from coursework.errors import BadInput

LIST = ".built.json"
LAST = "issued.json"  #: of the files put in place: a build is there when this is

Written = dict[str, list[str]]  #: by path below the folder: the digests of what builds wrote there


def place(staging: Path, out: Path, *, anew: bool) -> list[str]:
    """Put the files of ``staging / "new"`` in their places below ``out``, all or none; gives notes to tell.

    What a build wrote is replaced. Where the same was issued before, what somebody changed since is kept, and what
    else was built stays. ``anew`` says that something else was issued: what builds wrote before goes, and what
    somebody changed or put in a file's place is set aside under another name.

    Raises
    ------
    BadInput
        A file that no build wrote stands in the way, and ``anew`` is not said.
    """
    new = staging / "new"
    made = {p.relative_to(new).as_posix(): _digest(p) for p in sorted(new.rglob("*")) if p.is_file()}
    before, same = _read(out), (out / LAST).is_file() and not anew
    kept: dict[str, str] = {}
    aside: dict[str, None] = {}
    strange: dict[str, None] = {}
    for path, digest in made.items():
        found = _in_the_way(out, path)
        if found is None or _holds(out / found, [digest, *before.get(found, ())]):
            continue
        if anew:
            aside[found] = None
        elif same and found in before and (out / found).is_file():
            kept[path] = f"{out / path} was changed since it was built, and is kept as it is"
        else:
            strange[found] = None
    if strange:
        first = str(out / next(iter(strange)))
        told = first if len(strange) == 1 else f"{first} and {len(strange) - 1} more"
        raise BadInput(
            f"not as a build wrote it, and in the way of this one: {told}; move it, choose another --out, "
            "or --overwrite to set it aside under another name"
        )
    notes = list(kept.values())
    gone = [path for path in before if not same and path not in made and os.path.lexists(out / path)]
    mine = [path for path in gone if not _holds(out / path, before[path])]
    notes += [
        f"{out / path} is of what was issued before; it was changed since, and is kept" for path in mine
    ]
    put = sorted((path for path in made if path not in kept), key=lambda path: path == LAST)
    # Both contents are a build's, should this one be stopped halfway.
    _write(out, {**before, **{path: [*before.get(path, ()), made[path]] for path in put}})
    with ExitStack() as undo:
        for path in aside:
            beside = free_name(out / path)
            _move(out / path, beside, undo)
            notes.append(f"{out / path} was not as a build leaves it; it is now {beside.name}")
        for path in [path for path in gone if path not in mine] + put:
            if os.path.lexists(out / path):
                _move(out / path, staging / "old" / path, undo)
            if path in made:
                _move(new / path, out / path, undo)
        now = {path: [made[path]] for path in put}
        _write(out, {**before, **now} if same else now)
        undo.pop_all()
    for path in gone:
        _take_away_empty((out / path).parent, out)
    return notes


def _move(source: Path, target: Path, undo: ExitStack) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    source.replace(target)
    undo.callback(target.replace, source)


def _in_the_way(out: Path, path: str) -> str | None:
    """What stands in the place of a file: itself, or a file where a folder above it is to be."""
    above = [str(p) for p in reversed(PurePosixPath(path).parents[:-1])]
    wrong = (p for p in above if os.path.lexists(out / p) and not (out / p).is_dir())
    return next(wrong, path if os.path.lexists(out / path) else None)


def _holds(file: Path, digests: list[str]) -> bool:
    return file.is_file() and _digest(file) in digests


def _digest(file: Path) -> str:
    with file.open("rb") as data:
        return hashlib.file_digest(data, "sha256").hexdigest()


def free_name(path: Path) -> Path:
    """``answers.before.csv`` for ``answers.csv``, or the next such name that is free."""
    number = 1
    while True:
        which = ".before" if number == 1 else f".before-{number}"
        beside = path.with_name(path.stem + which + path.suffix)
        if not os.path.lexists(beside):
            return beside
        number += 1


def _take_away_empty(folder: Path, out: Path) -> None:
    with suppress(OSError):  # not empty, or gone
        while folder != out:
            folder.rmdir()
            folder = folder.parent


def _read(out: Path) -> Written:
    """What builds wrote; nothing where the list is not there or is none."""
    try:
        files = json.loads((out / LIST).read_text("utf-8"))["files"]
        return {
            path: [str(digest) for digest in digests]
            for path, digests in files.items()
            if not PurePosixPath(path).is_absolute() and ".." not in PurePosixPath(path).parts
        }
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _write(out: Path, files: Mapping[str, list[str]]) -> None:
    part = out / f"{LIST}.part"
    part.write_text(
        json.dumps({"files": files}, ensure_ascii=False, indent=1, sort_keys=True) + "\n", "utf-8"
    )
    part.replace(out / LIST)
