"""Archives with the same bytes for the same files, on any machine at any time."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Collection, Iterable, Mapping
from typing import NamedTuple

_DATE = (1980, 1, 1, 0, 0, 0)  #: the earliest date of the format; the real one would change the bytes
_FILE, _PROGRAM = 0o100644 << 16, 0o100755 << 16
_LEVEL = 6  #: of compression


class PackedFile(NamedTuple):
    """File of an archive, compressed before the archive is written."""

    data: bytes
    size: int
    crc: int


def compressed(pieces: Iterable[bytes]) -> PackedFile:
    """Return a file, given in pieces, as an archive holds it."""
    packing, packed, size, crc = zlib.compressobj(_LEVEL, zlib.DEFLATED, -zlib.MAX_WBITS), [], 0, 0
    for piece in pieces:
        packed.append(packing.compress(piece))
        size, crc = size + len(piece), zlib.crc32(piece, crc)
    return PackedFile(b"".join((*packed, packing.flush())), size, crc)


def zipped(files: Mapping[str, bytes | PackedFile], programs: Collection[str] = ()) -> bytes:
    """Return an archive of files by their paths, sorted; those of ``programs`` are executable."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for path in sorted(files):
            content = files[path]
            member = content if isinstance(content, PackedFile) else compressed([content])
            info = zipfile.ZipInfo(path, _DATE)
            info.compress_type, info.create_system = zipfile.ZIP_DEFLATED, 3
            info.external_attr = _PROGRAM if path in programs else _FILE
            info.compress_size, info.file_size, info.CRC = len(member.data), member.size, member.crc
            # As the library does for what it compresses itself; it has no call for what is compressed
            # already.
            info.header_offset = buffer.tell()
            buffer.write(info.FileHeader(zip64=False) + member.data)
            archive.filelist.append(info)
            archive.start_dir = buffer.tell()
    return buffer.getvalue()
