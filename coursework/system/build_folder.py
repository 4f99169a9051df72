"""Folder that builds write into: a build replaces only the files that builds wrote.

``.built.json`` in the folder lists the files that builds wrote, by the digests of the contents. A file that
is not on the list, or has another content, belongs to the user.
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
from coursework.messages import Message
from coursework.system.json_files import read_json

LIST = ".built.json"
LAST = "issued.json"  #: the last file installed: a build is complete if it exists

Written = dict[str, list[str]]  #: by path below the folder: the digests of the contents that builds wrote


def install(staging: Path, out: Path, *, anew: bool) -> list[str]:
    """Install the files of ``staging / "new"`` below ``out``, all or none; return notes for the user.

    Files that a build wrote are replaced. If the same was issued before, files that somebody changed since
    are left as they are, and other built files stay. With ``anew``, something else was issued: the files of
    earlier builds are removed, and files that somebody changed or added in their place are renamed.

    Raises
    ------
    BadInput
        A file that no build wrote stands in the way, and ``anew`` is not said.
    """
    new = staging / "new"
    new_digests = {p.relative_to(new).as_posix(): _digest(p) for p in sorted(new.rglob("*")) if p.is_file()}
    before, damage = _read(out / LIST)
    same = (out / LAST).is_file() and not anew
    unchanged: dict[str, Message] = {}
    aside: dict[str, None] = {}
    strange: dict[str, None] = {}
    for path, digest in new_digests.items():
        obstacle = _in_the_way(out, path)
        if obstacle is None or _holds(out / obstacle, [digest, *before.get(obstacle, ())]):
            continue
        if anew:
            aside[obstacle] = None
        elif same and obstacle in before and (out / obstacle).is_file():
            unchanged[path] = Message("{file} was changed since it was built; it is kept", file=out / path)
        else:
            strange[obstacle] = None
    if strange:
        first = str(out / next(iter(strange)))
        names = (
            first
            if len(strange) == 1
            else Message("{first} and {count} more", first=first, count=len(strange) - 1)
        )
        raise BadInput(
            (
                "{names} was changed since the last build, and this one would replace it; move it, "
                "choose another "
                "--out, or --overwrite to keep it under another name"
            ),
            names=names,
        )
    notes = [*damage, *unchanged.values()]
    gone = [path for path in before if not same and path not in new_digests and os.path.lexists(out / path)]
    mine = [path for path in gone if not _holds(out / path, before[path])]
    notes += [
        Message("{file} belongs to papers issued before and was changed since; it is kept", file=out / path)
        for path in mine
    ]
    installed = sorted((path for path in new_digests if path not in unchanged), key=lambda path: path == LAST)
    # If this build stops halfway, both contents count as built.
    _write(out / LIST, {**before, **{path: [*before.get(path, ()), new_digests[path]] for path in installed}})
    with ExitStack() as undo:
        for path in aside:
            backup = free_name(out / path)
            _move(out / path, backup, undo)
            notes.append(
                Message(
                    "{file} was changed since the last build; it is now {backup}",
                    file=out / path,
                    backup=backup.name,
                )
            )
        for path in [path for path in gone if path not in mine] + installed:
            if os.path.lexists(out / path):
                _move(out / path, staging / "old" / path, undo)
            if path in new_digests:
                _move(new / path, out / path, undo)
        now = {path: [new_digests[path]] for path in installed}
        _write(out / LIST, {**before, **now} if same else now)
        undo.pop_all()
    for path in gone:
        _remove_empty((out / path).parent, out)
    return notes


def count_as_built(path: Path) -> None:
    """List a file of a build that a command has rewritten as the build's own, so that the next build
    replaces it."""
    before, _ = _read(path.parent / LIST)
    if path.name in before:
        _write(path.parent / LIST, {**before, path.name: [_digest(path)]})


def renew(new: Path, out: Path, record: Path) -> list[str]:
    """Replace the files that an earlier call put into ``out`` by those of ``new``; return notes for the user.

    ``record`` lists the installed files, by the digests of the contents. Files that are no longer made are
    removed; files that somebody changed since are renamed, or stay if nothing replaces them. If the process
    stops at any point, each file is the old or the new one, and the next call goes on.
    """
    out.mkdir(parents=True, exist_ok=True)
    new_digests = {p.name: _digest(p) for p in sorted(new.iterdir()) if p.is_file()}
    before, notes = _read(record)
    _write(
        record, {**before, **{name: [*before.get(name, ()), digest] for name, digest in new_digests.items()}}
    )
    for name, digest in new_digests.items():
        if os.path.lexists(out / name) and not _holds(out / name, [digest, *before.get(name, ())]):
            backup = _back_up(out / name)
            notes.append(
                Message(
                    "{file} was changed since it was written; it is now {backup}",
                    file=out / name,
                    backup=backup.name,
                )
            )
        (new / name).replace(out / name)
    for name in sorted(before.keys() - new_digests.keys()):
        if _holds(out / name, before[name]):
            (out / name).unlink()
        elif os.path.lexists(out / name):
            notes.append(
                Message(
                    "{file} is from an earlier marking and was changed since; it is kept", file=out / name
                )
            )
    _write(record, {name: [digest] for name, digest in new_digests.items()})
    return notes


def write_down(record: Path, file: Path, *contents: Path) -> None:
    """Record that a file with one of these contents is as it was written."""
    _write(record, {file.name: sorted({_digest(path) for path in contents if path.is_file()})})


def is_as_written(record: Path, file: Path) -> bool:
    return _holds(file, _read(record)[0].get(file.name, []))


def _back_up(path: Path) -> Path:
    """Copy a file that is about to be replaced; return the copy, or an identical one that exists already."""
    for there in path.parent.glob(f"{glob.escape(path.stem)}.before*{path.suffix}"):
        if _holds(there, [_digest(path)]):
            return there
    backup = free_name(path)
    part = backup.with_name(backup.name + ".part")
    shutil.copy2(path, part)
    part.replace(backup)
    return backup


def _move(source: Path, target: Path, undo: ExitStack) -> None:
    target.parent.mkdir(parents=True, exist_ok=True)
    source.replace(target)
    undo.callback(target.replace, source)


def _in_the_way(out: Path, path: str) -> str | None:
    """Return the path that blocks a file: the file itself, or a file where a folder above it must be."""
    above = [str(p) for p in reversed(PurePosixPath(path).parents[:-1])]
    wrong = (p for p in above if os.path.lexists(out / p) and not (out / p).is_dir())
    return next(wrong, path if os.path.lexists(out / path) else None)


def _holds(file: Path, digests: list[str]) -> bool:
    return file.is_file() and _digest(file) in digests


def _digest(file: Path) -> str:
    with file.open("rb") as data:
        return hashlib.file_digest(data, "sha256").hexdigest()


def free_name(path: Path) -> Path:
    """Return ``answers.before.csv`` for ``answers.csv``, or the next such name that is free."""
    number = 1
    while True:
        which = ".before" if number == 1 else f".before-{number}"
        candidate = path.with_name(path.stem + which + path.suffix)
        if not os.path.lexists(candidate):
            return candidate
        number += 1


def _remove_empty(folder: Path, out: Path) -> None:
    with suppress(OSError):  # not empty, or gone
        while folder != out:
            folder.rmdir()
            folder = folder.parent


def _read(path: Path) -> tuple[Written, list[str]]:
    """Return the list of written files, with a note if it is damaged; empty if there is no list or it is
    damaged."""
    if not path.exists():
        return {}, []
    try:
        return _written(path), []
    except BadInput as fault:
        return {}, [
            Message("{problem}; so its files count as somebody's own work, and are kept", problem=fault)
        ]


def _written(path: Path) -> Written:
    content = read_json(path)
    files = content.get("files") if isinstance(content, dict) else None
    if not isinstance(files, dict) or not all(_is_written(*entry) for entry in files.items()):
        raise BadInput("{file} is not a list of written files", file=path)
    return files


def _is_written(path: str, digests: object) -> bool:
    """Return whether a path stays below its folder and comes with digests."""
    relative = PurePosixPath(path)
    inside = bool(relative.parts) and not relative.is_absolute() and ".." not in relative.parts
    return inside and isinstance(digests, list) and all(isinstance(digest, str) for digest in digests)


def _write(record: Path, files: Mapping[str, list[str]]) -> None:
    part = record.with_name(f"{record.name}.part")
    part.write_text(
        json.dumps({"files": files}, ensure_ascii=False, indent=1, sort_keys=True) + "\n", "utf-8"
    )
    part.replace(record)
