"""Archives from outside, unpacked within limits: nothing lands outside the folder, and stated sizes are not
trusted."""

from __future__ import annotations

import struct
import zipfile
import zlib
from collections.abc import Iterator
from lzma import LZMAError
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from coursework.errors import BadInput

_CHUNK = 1 << 16
#: Errors of a damaged archive: in its structure, in decompression, or at a file without a name.
_DAMAGED = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    LZMAError,
    RuntimeError,
    EOFError,
    OSError,
    ValueError,
    LookupError,
    OverflowError,
)


class ArchiveLimits(NamedTuple):
    """Limits of an archive."""

    files: int = 5000
    each: int = 50 * 1024 * 1024  #: bytes of a file
    total: int = 200 * 1024 * 1024  #: bytes of all files together
    depth: int = 12  #: folders in one another
    name: int = 200  #: characters of a file's or a folder's name


USUAL = ArchiveLimits()


def is_zip(data: bytes) -> bool:
    """Return whether the bytes begin as an archive does."""
    return data[:4] in (b"PK\x03\x04", b"PK\x05\x06")


def unpack(archive: Path, folder: Path, limits: ArchiveLimits = USUAL) -> list[Path]:
    """Write the files of an archive below a folder; an archive inside it stays packed.

    Raises
    ------
    BadInput
        The file is not an archive, is encrypted, names a path outside the folder, or exceeds the limits;
        unpacking stops there.
    """
    written: list[Path] = []
    left = limits.total
    try:
        with zipfile.ZipFile(archive) as opened:
            members = [info for info in opened.infolist() if not info.is_dir()]
            if len(members) > limits.files:
                raise BadInput(
                    "{archive} contains {count} files; at most {most} are allowed",
                    archive=archive.name,
                    count=len(members),
                    most=limits.files,
                )
            for member in members:
                target = folder / _path_inside(archive, member.filename, limits)
                written.append(target)
                left -= _write(opened, member, target, min(limits.each, left), archive)
    except BadInput:
        raise
    except _DAMAGED as fault:
        raise BadInput(
            "{archive} cannot be opened: {problem}", archive=archive.name, problem=fault
        ) from fault
    return written


def _path_inside(archive: Path, name: str, limits: ArchiveLimits) -> PurePosixPath:
    """Return the path of a file of an archive below the folder."""
    path = PurePosixPath(name.replace("\\", "/"))
    odd = path.is_absolute() or any(
        part in ("", ".", "..") or ":" in part or "\0" in part for part in path.parts
    )
    if odd or not path.parts:
        raise BadInput(
            "{archive} names a place outside its folder, {name!r}: it is not opened",
            archive=archive.name,
            name=name[:60],
        )
    if len(path.parts) > limits.depth or max(map(len, path.parts)) > limits.name:
        raise BadInput(
            "{archive} has folders too deep or names too long, {name!r}: it is not opened",
            archive=archive.name,
            name=name[:60],
        )
    return path


def _write(opened: zipfile.ZipFile, member: zipfile.ZipInfo, path: Path, most: int, archive: Path) -> int:
    """Write one file, and return its real size, whatever the archive states."""
    size = 0
    path.parent.mkdir(parents=True, exist_ok=True)
    with opened.open(member) as source, path.open("wb") as target:
        for chunk in _chunks(source):
            size += len(chunk)
            if size > most:
                raise BadInput(
                    "{archive} unpacks to more than the limit ({filename!r}): it is not read further",
                    archive=archive.name,
                    filename=member.filename[:60],
                )
            target.write(chunk)
    return size


def _chunks(source: object) -> Iterator[bytes]:
    while chunk := source.read(_CHUNK):  # type: ignore[attr-defined]
        yield chunk
