"""Ways in which a secret may be written, and all the bytes of a file in which it may stand."""

import base64
import io
import json
import re
import zipfile
import zlib


def spelled(secret):
    """The ways in which a secret of hexadecimal digits may be written."""
    bits = bytes.fromhex(secret)
    ways = {bits, bits[::-1], secret.encode(), secret.upper().encode(), secret.encode("utf-16-le")}
    for code in (base64.b64encode, base64.urlsafe_b64encode, base64.b32encode, base64.b85encode):
        for told in (bits, secret.encode()):
            ways |= {code(told).rstrip(b"="), code(told).rstrip(b"=").lower()}
    return ways | {
        json.dumps(list(bits)).encode(),
        str(int(secret, 16)).encode(),
        zlib.compress(secret.encode()),
    }


def holds(data, ways):
    """Whether a file holds one of the ways: in its members, streams, and what is packed within, too."""
    return any(way in part for part in parts_of(data) for way in ways)


def parts_of(data):
    """A file, its members and streams, and what is packed within them."""
    yield data
    if data[:2] == b"PK":
        with zipfile.ZipFile(io.BytesIO(data)) as file:
            for name in file.namelist():
                yield from parts_of(file.read(name))
    for start in re.finditer(rb"stream\r?\n", data) if data[:4] == b"%PDF" else ():
        try:
            yield zlib.decompressobj().decompress(data[start.end() :])
        except zlib.error:
            continue
    for packed in re.findall(rb"base64,([A-Za-z0-9+/=]{40,})", data):
        yield base64.b64decode(packed + b"==")
