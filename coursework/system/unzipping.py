"""An archive that somebody sent, opened within limits: nothing of it lands outside a folder, and none of it is trusted for its size."""

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
#: What a damaged archive may end in: its parts, what unpacks them, and a file without a name.
_DAMAGED = (
    zipfile.BadZipFile, zlib.error, struct.error, LZMAError, RuntimeError, EOFError, OSError, ValueError, LookupError, OverflowError,
)  # fmt: skip


class Limits(NamedTuple):
    """What an archive may hold."""

    files: int = 5000
    each: int = 50 * 1024 * 1024  #: bytes of a file
    whole: int = 200 * 1024 * 1024  #: bytes of all files together
    depth: int = 12  #: folders in one another
    name: int = 200  #: characters of a file's or a folder's name


USUAL = Limits()


def is_zip(data: bytes) -> bool:
    """Whether the bytes begin as an archive does."""
    return data[:4] in (b"PK\x03\x04", b"PK\x05\x06")


def unpack(archive: Path, folder: Path, limits: Limits = USUAL) -> list[Path]:
    """Write the files of an archive below a folder; an archive in an archive is a file like another, and stays closed.

    Raises
    ------
    BadInput
        It is no archive, is encrypted, names a place outside the folder, or holds more than it may: then it is not gone
        on with.
    """
    written: list[Path] = []
    left = limits.whole
    try:
        with zipfile.ZipFile(archive) as opened:
            members = [one for one in opened.infolist() if not one.is_dir()]
            if len(members) > limits.files:
                raise BadInput(f"{archive.name} holds {len(members)} files; {limits.files} is the most")
            for member in members:
                place = folder / _place(archive, member.filename, limits)
                written.append(place)
                left -= _write(opened, member, place, min(limits.each, left), archive)
    except BadInput:
        raise
    except _DAMAGED as fault:
        raise BadInput(f"{archive.name} cannot be opened: {fault}") from fault
    return written


def _place(archive: Path, name: str, limits: Limits) -> PurePosixPath:
    """Where a file of an archive goes."""
    path = PurePosixPath(name.replace("\\", "/"))
    odd = path.is_absolute() or any(
        part in ("", ".", "..") or ":" in part or "\0" in part for part in path.parts
    )
    if odd or not path.parts:
        raise BadInput(f"{archive.name} names a place outside its folder, {name[:60]!r}: it is not opened")
    if len(path.parts) > limits.depth or max(map(len, path.parts)) > limits.name:
        raise BadInput(
            f"{archive.name} has folders too deep or names too long, {name[:60]!r}: it is not opened"
        )
    return path


def _write(opened: zipfile.ZipFile, member: zipfile.ZipInfo, place: Path, most: int, archive: Path) -> int:
    """Write one file; its size is what comes out, whatever it is said to be."""
    size = 0
    place.parent.mkdir(parents=True, exist_ok=True)
    with opened.open(member) as source, place.open("wb") as target:
        for chunk in _chunks(source):
            size += len(chunk)
            if size > most:
                raise BadInput(
                    f"{archive.name} unpacks to more than it may ({member.filename[:60]!r}): it is not gone on with"
                )
            target.write(chunk)
    return size


def _chunks(source: object) -> Iterator[bytes]:
    while chunk := source.read(_CHUNK):  # type: ignore[attr-defined]
        yield chunk
