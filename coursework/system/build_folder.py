"""A folder that builds write into: a build replaces what builds wrote there, and nothing else.

``.built.json`` in the folder lists what builds wrote, by the digests of the contents. A file that is not on it, or
whose content is another, is somebody's own.
"""

from __future__ import annotations

import glob
import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from contextlib import ExitStack, suppress
from pathlib import Path, PurePosixPath

from coursework.errors import BadInput
from coursework.system.json_files import read_json

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
    before, damage = _read(out / LIST)
    same = (out / LAST).is_file() and not anew
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
    notes = [*damage, *kept.values()]
    gone = [path for path in before if not same and path not in made and os.path.lexists(out / path)]
    mine = [path for path in gone if not _holds(out / path, before[path])]
    notes += [
        f"{out / path} is of what was issued before; it was changed since, and is kept" for path in mine
    ]
    put = sorted((path for path in made if path not in kept), key=lambda path: path == LAST)
    # Both contents are a build's, should this one be stopped halfway.
    _write(out / LIST, {**before, **{path: [*before.get(path, ()), made[path]] for path in put}})
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
        _write(out / LIST, {**before, **now} if same else now)
        undo.pop_all()
    for path in gone:
        _take_away_empty((out / path).parent, out)
    return notes


def renew(new: Path, out: Path, record: Path) -> list[str]:
    """Put the files of ``new`` into ``out`` in place of those that were put there before; gives notes to tell.

    ``record`` lists what is put there, by the digests of the contents. What is no longer made goes; what somebody
    changed since is set aside under another name, or stays where nothing takes its place. Stopped at any point, each
    place holds the file of before or the new one, and the next time goes on.
    """
    out.mkdir(parents=True, exist_ok=True)
    made = {p.name: _digest(p) for p in sorted(new.iterdir()) if p.is_file()}
    before, notes = _read(record)
    _write(record, {**before, **{name: [*before.get(name, ()), digest] for name, digest in made.items()}})
    for name, digest in made.items():
        if os.path.lexists(out / name) and not _holds(out / name, [digest, *before.get(name, ())]):
            beside = _copy_beside(out / name)
            notes.append(f"{out / name} was changed since it was written; it is now {beside.name}")
        (new / name).replace(out / name)
    for name in sorted(before.keys() - made.keys()):
        if _holds(out / name, before[name]):
            (out / name).unlink()
        elif os.path.lexists(out / name):
            notes.append(f"{out / name} is of an earlier marking; it was changed since, and is kept")
    _write(record, {name: [digest] for name, digest in made.items()})
    return notes


def write_down(record: Path, file: Path, *contents: Path) -> None:
    """Say in ``record`` that a file with one of these contents is as it was written."""
    _write(record, {file.name: sorted({_digest(one) for one in contents if one.is_file()})})


def is_as_written(record: Path, file: Path) -> bool:
    return _holds(file, _read(record)[0].get(file.name, []))


def _copy_beside(path: Path) -> Path:
    """A copy of a file that is about to be replaced; the one that is there already, if any."""
    for there in path.parent.glob(f"{glob.escape(path.stem)}.before*{path.suffix}"):
        if _holds(there, [_digest(path)]):
            return there
    beside = free_name(path)
    part = beside.with_name(beside.name + ".part")
    shutil.copy2(path, part)
    part.replace(beside)
    return beside


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


def _read(path: Path) -> tuple[Written, list[str]]:
    """What was written; nothing where there is no list, or one that is damaged, which is told."""
    if not path.exists():
        return {}, []
    try:
        return _written(path), []
    except BadInput as fault:
        return {}, [f"{fault}; so what stands there counts as somebody's own, and is not lost"]


def _written(path: Path) -> Written:
    found = read_json(path)
    files = found.get("files") if isinstance(found, dict) else None
    if not isinstance(files, dict) or not all(_is_written(*one) for one in files.items()):
        raise BadInput(f"{path} is no list of what was written")
    return files


def _is_written(path: str, digests: object) -> bool:
    """Whether a path stays below its folder and comes with digests."""
    place = PurePosixPath(path)
    inside = bool(place.parts) and not place.is_absolute() and ".." not in place.parts
    return inside and isinstance(digests, list) and all(isinstance(one, str) for one in digests)


def _write(record: Path, files: Mapping[str, list[str]]) -> None:
    part = record.with_name(f"{record.name}.part")
    part.write_text(
        json.dumps({"files": files}, ensure_ascii=False, indent=1, sort_keys=True) + "\n", "utf-8"
    )
    part.replace(record)
