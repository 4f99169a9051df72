"""The codes on pages: QR symbols at any turn and size, of sharp scans and of photographs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from coursework.scanning.pictures import opencv
from coursework.system.extras import library

_LONG = 2400  #: pixels of the longer side, enough for a symbol of 15 mm on A4


@dataclass(frozen=True)
class PageCode:
    """A symbol that was read: its text and, in pixels of the picture, its corners as printed: top left, top
    right, bottom right, bottom left, shape ``(4, 2)``."""

    text: str
    corners: np.ndarray


def codes_in(grey: np.ndarray) -> tuple[PageCode, ...]:
    """Return the codes in a picture, each text once; a picture that is hard to read is also tried sharpened,
    softened and evenly lit."""
    for scale, tried in _tries(grey):
        by_text = {code.text: code for code in _read(tried, scale)}
        if by_text:
            return tuple(by_text[text] for text in sorted(by_text))
    return ()


def _tries(grey: np.ndarray) -> Iterator[tuple[float, np.ndarray]]:
    """Yield versions of the picture, the fastest to read first, each with its pixels per pixel of the
    original."""
    cv2 = opencv()
    scale = min(1.0, _LONG / max(grey.shape))
    small = grey if scale == 1 else cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    yield scale, small
    yield scale, cv2.GaussianBlur(small, (0, 0), 1.2)
    if scale < 1:
        yield 1.0, grey
        yield 1.0, cv2.GaussianBlur(grey, (0, 0), 2.0)
    even = cv2.createCLAHE(4.0, (8, 8)).apply(small)
    yield scale, even
    twice = cv2.resize(small, None, fx=1.6, fy=1.6, interpolation=cv2.INTER_CUBIC)
    yield scale * 1.6, twice
    yield scale * 1.6, cv2.GaussianBlur(twice, (0, 0), 2.2)
    soft = cv2.GaussianBlur(twice, (0, 0), 6.0)
    yield scale * 1.6, cv2.addWeighted(twice, 2.5, soft, -1.5, 0)


def _read(grey: np.ndarray, scale: float) -> Iterator[PageCode]:
    zxing: Any = library("zxingcpp", "reading scans needs", "scan")
    for barcodes in zxing.read_barcodes(np.ascontiguousarray(grey), formats=zxing.BarcodeFormat.QRCode):
        at = barcodes.position
        corners = [(p.x, p.y) for p in (at.top_left, at.top_right, at.bottom_right, at.bottom_left)]
        yield PageCode(barcodes.text, (np.array(corners, float) + 0.5) / scale - 0.5)
