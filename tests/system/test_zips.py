"""Archives hold what they were given, by the same bytes whoever has compressed it."""

from __future__ import annotations

import io
import zipfile

from coursework.system.zips import compressed, zipped


def test_a_file_compressed_before_gives_the_archive_of_the_library():
    files = {"b/é.txt": "é" * 3000, "a.txt": "", "run.sh": "#!/bin/sh\n"}
    data = {path: text.encode() for path, text in files.items()}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for path in sorted(data):
            info = zipfile.ZipInfo(path)
            info.compress_type, info.create_system = zipfile.ZIP_DEFLATED, 3
            info.external_attr = (0o100755 if path == "run.sh" else 0o100644) << 16
            archive.writestr(info, data[path])
    made = zipped({path: compressed([content]) for path, content in data.items()}, programs=["run.sh"])
    assert made == zipped(data, programs=["run.sh"]) == buffer.getvalue()
