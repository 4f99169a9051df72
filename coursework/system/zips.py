"""Archives that are the same bytes whenever and wherever they are made of the same files."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Collection, Mapping

_DATE = (1980, 1, 1, 0, 0, 0)  #: the first that an archive can state: it says nothing of when it was made
_FILE, _PROGRAM = 0o100644 << 16, 0o100755 << 16


def zipped(files: Mapping[str, bytes], programs: Collection[str] = ()) -> bytes:
    """An archive of files by their paths, sorted; of those some are ``programs``, to be run."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for path in sorted(files):
            info = zipfile.ZipInfo(path, _DATE)
            info.compress_type, info.create_system = zipfile.ZIP_DEFLATED, 3
            info.external_attr = _PROGRAM if path in programs else _FILE
            archive.writestr(info, files[path])
    return made.getvalue()
