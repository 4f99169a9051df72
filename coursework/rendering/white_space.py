"""White space of printed pages, from small pictures of them."""

from __future__ import annotations

import struct
import zlib

import numpy as np

PPI = 24  #: of the pictures; a line of text is three rows high
_INK = 250  #: the lightest grey that counts as ink


def white_share(png: bytes) -> float:
    """Return the largest share of a page's height that is white between two marks of ink, the footer among
    them."""
    samples = pixels(png)
    rows = np.flatnonzero((samples[..., :3] < _INK).any(axis=(1, 2)))
    return float(np.diff(rows).max()) / len(samples) if len(rows) > 1 else 1.0


def pixels(png: bytes) -> np.ndarray:
    """Return the samples of a PNG of 8 bits without interlacing: rows, columns, channels."""
    width, height, depth, colour = struct.unpack(">IIBB", png[16:26])
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    if depth != 8 or png[28]:
        raise ValueError("a PNG of 8 bits, not interlaced")
    data, place = b"", 8
    while place < len(png):
        size, kind = struct.unpack(">I4s", png[place : place + 8])
        if kind == b"IDAT":
            data += png[place + 8 : place + 8 + size]
        place += size + 12
    raw = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + width * channels)
    above = np.zeros(width * channels, np.uint8)
    lines = []
    for line in raw:
        above = _unfiltered(int(line[0]), line[1:], above, channels)
        lines.append(above)
    return np.stack(lines).reshape(height, width, channels)


def _unfiltered(kind: int, line: np.ndarray, above: np.ndarray, channels: int) -> np.ndarray:
    """Return a row of samples from its differences to its neighbours, as the five filters of PNG take
    them."""
    if kind == 0:
        return line
    if kind == 1:
        return np.cumsum(line.reshape(-1, channels), axis=0, dtype=np.uint8).ravel()
    if kind == 2:
        return line + above
    done, over = [0] * channels, [0] * channels + above.tolist()
    for k, difference in enumerate(line.tolist()):
        left, up, corner = done[k], over[k + channels], over[k]
        if kind == 3:
            near = (left + up) // 2
        else:
            guess = left + up - corner
            near = min((left, up, corner), key=lambda sample: abs(guess - sample))
        done.append((difference + near) % 256)
    return np.array(done[channels:], np.uint8)
