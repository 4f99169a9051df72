"""Sources of scans: PDFs and pictures, alone, in folders or in archives, each identified by its name and its
content."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from coursework.errors import BadInput, reason_of
from coursework.messages import Message, as_message
from coursework.system.links import LEADS_OUT, LeadsOut, open_inside, walked
from coursework.system.unzipping import ArchiveLimits, is_zip, unpack

ENDINGS = (".pdf", ".png", ".jpg", ".jpeg", ".tif", ".tiff")
MAX_BYTES = 2_000_000_000  #: of one file
_UNZIPPED = ArchiveLimits(files=20_000, each=MAX_BYTES, total=4 * MAX_BYTES)
_KEPT = 16  #: letters of a digest that tell files apart


class Scan(NamedTuple):
    """File that may contain pages."""

    name: str  #: below the folder or archive that was named, or its own
    digest: str  #: of its bytes; of its name where it cannot be read
    path: Path
    fault: str = ""  #: why no page of it can be read


def scans(paths: Iterable[Path], unpacked: Path) -> list[Scan]:
    """Return the files of the given paths, in an order that does not depend on their folders; archives are
    extracted in ``unpacked``.

    Raises
    ------
    BadInput
        One of the paths is not there.
    """
    paths = tuple(paths)
    for path in paths:
        if not path.exists():
            raise BadInput("no such file or folder: {path}", path=path)
    by_key = {(scan.name, scan.digest): scan for path in paths for scan in _of(path, unpacked)}
    return [by_key[key] for key in sorted(by_key)]


def _of(path: Path, unpacked: Path) -> Iterator[Scan]:
    if not path.is_dir():
        yield from _file(path, _text(path.name), unpacked)
        return
    paths = walked(path)
    files = [file for file in paths.files if not _is_hidden(file, path)]
    refused = [link for link in paths.refused if not _is_hidden(link, path)]
    for file in files:
        yield from _file(file, _text(file.relative_to(path).as_posix()), unpacked, path)
    for link in refused:
        yield _refused(_text(link.relative_to(path).as_posix()), link, LEADS_OUT)
    if not files and not refused:
        yield _refused(_text(path.name), path, Message("the folder contains no file"))


def _is_hidden(path: Path, below: Path) -> bool:
    return any(part.startswith((".", "__MACOSX")) for part in path.relative_to(below).parts)


def _text(name: str) -> str:
    """Return a name as valid text, whatever its bytes."""
    return "".join(c if c.isprintable() else "\ufffd" for c in os.fsencode(name).decode("utf-8", "replace"))


def _file(path: Path, name: str, unpacked: Path, folder: Path | None = None) -> Iterator[Scan]:
    try:
        with path.open("rb") if folder is None else open_inside(path, folder) as data:
            size = os.fstat(data.fileno()).st_size
            head = data.read(4)
            data.seek(0)
            digest = hashlib.file_digest(data, "sha256").hexdigest()[:_KEPT] if size <= MAX_BYTES else ""
    except OSError as fault:
        why = (
            LEADS_OUT
            if isinstance(fault, LeadsOut)
            else Message("cannot be read: {problem}", problem=reason_of(fault))
        )
        yield _refused(name, path, why)
        return
    ending = path.suffix.lower()
    if not size:
        yield _refused(name, path, Message("the file is empty"))
    elif not digest:
        yield _refused(
            name,
            path,
            Message(
                "{size} bytes are too many for scans; the limit is {most}",
                size=f"{size:,}",
                most=f"{MAX_BYTES:,}",
            ),
        )
    elif ending == ".zip" and is_zip(head):
        yield from _archive(path, name, digest, unpacked)
    elif ending not in ENDINGS:
        yield _refused(
            name,
            path,
            Message(
                "scans are {endings} or .zip files; found {found}",
                endings=", ".join(ENDINGS),
                found=ending or Message("no file extension"),
            ),
        )
    else:
        yield Scan(name, digest, path)


def _refused(name: str, path: Path, why: str) -> Scan:
    """Return a file of which no page can be read, identified by its name and its fault instead of its
    content."""
    return Scan(name, hashlib.sha256(f"{name}\0{why}".encode()).hexdigest()[:_KEPT], path, why)


def _archive(path: Path, name: str, digest: str, unpacked: Path) -> Iterator[Scan]:
    """Yield the files of an archive; nested archives are not opened."""
    folder = unpacked / digest
    try:
        unpack(path, folder, _UNZIPPED)
    except BadInput as fault:
        yield _refused(name, path, as_message(fault))
        return
    for file in sorted(p for p in folder.rglob("*") if p.is_file() and not _is_hidden(p, folder)):
        inside = f"{name}/{_text(file.relative_to(folder).as_posix())}"
        if file.suffix.lower() == ".zip":
            yield _refused(inside, file, Message("an archive in an archive is not opened"))
        else:
            yield from _file(file, inside, unpacked)
