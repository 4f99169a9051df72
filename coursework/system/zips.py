"""Archives with the same bytes for the same files, on any machine at any time."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Collection, Mapping

_DATE = (1980, 1, 1, 0, 0, 0)  #: the earliest date of the format; the real one would change the bytes
_FILE, _PROGRAM = 0o100644 << 16, 0o100755 << 16


def zipped(files: Mapping[str, bytes], programs: Collection[str] = ()) -> bytes:
    """Return an archive of files by their paths, sorted; those of ``programs`` are executable."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for path in sorted(files):
            info = zipfile.ZipInfo(path, _DATE)
            info.compress_type, info.create_system = zipfile.ZIP_DEFLATED, 3
            info.external_attr = _PROGRAM if path in programs else _FILE
            archive.writestr(info, files[path])
    return buffer.getvalue()
