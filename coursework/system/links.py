"""Files of a folder that others filled: links that lead out of it are not followed."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable
from io import BufferedReader
from pathlib import Path
from typing import NamedTuple

from coursework.errors import BadInput
from coursework.messages import Message

LEADS_OUT = Message("a link that leads out of the folder is not followed")


class LeadsOut(OSError):
    """Error of a path below a folder that leads out of it, or to something that is not a file."""

    def __init__(self) -> None:
        super().__init__(None, LEADS_OUT)


class Walked(NamedTuple):
    """Files below a folder in the order of their names, and links that lead out of it, or nowhere."""

    files: list[Path]
    refused: list[Path]


def walked(folder: Path) -> Walked:
    """Walk a folder. A link to a file in it is a file; one to a folder in it is not walked, since that folder
    is."""
    result = Walked([], [])
    for path in sorted(folder.rglob("*")):
        if path.is_symlink() and leads_out(path, folder):
            result.refused.append(path)
        elif path.is_file():
            result.files.append(path)
    return result


def leads_out(path: Path, folder: Path) -> bool:
    """Return whether a path leads out of a folder: itself, through other links, or by a folder above it; or
    nowhere."""
    try:
        return not path.resolve(strict=True).is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # nothing is there, or links in a ring
        return True


def check_inside(path: Path, folder: Path) -> None:
    """Raise if a file of a folder leads out of it; a missing file is reported by its reader.

    Raises
    ------
    BadInput
        It is a link that does; the path is named, and nothing behind it.
    """
    if path.is_symlink() and leads_out(path, folder):
        raise BadInput("{file}: {problem}", file=path, problem=LEADS_OUT)


def open_inside(path: Path, folder: Path) -> BufferedReader:
    """Open a file below a folder for reading; the file read lies in the folder even if files are moved
    meanwhile.

    Raises
    ------
    LeadsOut
        It leads out of the folder, or is not a file.
    OSError
        It cannot be opened.
    """
    number = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    file = os.fdopen(number, "rb")
    try:
        if not _is_inside(os.fstat(number), path, folder):
            raise LeadsOut
    except BaseException:
        file.close()
        raise
    return file


def _is_inside(opened: os.stat_result, path: Path, folder: Path) -> bool:
    """Return whether the opened file is the one that is in the folder now."""
    try:
        real = path.resolve(strict=True)
        return (
            stat.S_ISREG(opened.st_mode)
            and real.is_relative_to(folder.resolve())
            and os.path.samestat(opened, real.lstat())
        )
    except (OSError, RuntimeError):
        return False


def folder_of(path: Path, given: Iterable[Path]) -> Path | None:
    """Return the folder among the given paths that holds a path; None if the path itself was given."""
    return next(
        (candidate for candidate in given if candidate != path and path.is_relative_to(candidate)), None
    )
