"""Pictures of pages are read as they were written, through every filter of PNG."""

import struct
import zlib

import numpy as np

from coursework.rendering.white_space import pixels, white_share


def png(rows, kinds, channels=4):
    """Return a PNG of these samples, row by row through a filter of this number."""
    height, width, _ = rows.shape
    before, data = np.zeros((width + 1, channels), int), b""
    for line, kind in zip(rows.astype(int), kinds, strict=True):
        here = np.vstack([np.zeros((1, channels), int), line])
        left, up, corner = here[:-1], before[1:], before[:-1]
        guess = left + up - corner
        distances = np.abs(np.stack([guess - left, guess - up, guess - corner]))
        paeth = np.choose(distances.argmin(axis=0), [left, up, corner])
        near = [0, left, up, (left + up) // 2, paeth][kind]
        data += bytes([kind]) + ((line - near) % 256).astype(np.uint8).tobytes()
        before = here
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    chunks = (b"IHDR", head), (b"IDAT", zlib.compress(data)), (b"IEND", b"")
    body = b"".join(
        struct.pack(">I", len(c)) + k + c + struct.pack(">I", zlib.crc32(k + c)) for k, c in chunks
    )
    return b"\x89PNG\r\n\x1a\n" + body


def test_every_filter_is_undone():
    rows = np.random.default_rng(3).integers(0, 256, (25, 7, 4), dtype=np.uint8)
    assert (pixels(png(rows, [k % 5 for k in range(25)])) == rows).all()


def test_the_largest_white_band_is_told_as_a_share_of_the_height():
    rows = np.full((20, 5, 4), 255, np.uint8)
    assert white_share(png(rows, [0] * 20)) == 1.0
    rows[[2, 4, 14], 3, 1] = 0
    assert white_share(png(rows, [2] * 20)) == 0.5
