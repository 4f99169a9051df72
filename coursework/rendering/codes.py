"""QR codes as drawings."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from coursework.system.extras import library

CORRECTION = "Q"  #: a quarter of a code may be lost


@lru_cache(maxsize=256)
def qr_svg(text: str) -> str:
    """Return a text as a QR code without its rim, an SVG of one unit a module.

    Raises
    ------
    NotAtHand
        The library that makes codes is not installed.
    """
    dark = qr_modules(text)
    high, wide = dark.shape
    path = "".join(f"M{start} {row}h{length}v1h-{length}z" for row, start, length in _runs(dark))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" width="{wide}" '
        f'height="{high}"><path d="{path}"/></svg>'
    )


def qr_modules(text: str) -> np.ndarray:
    """Return the dark modules of the code, shape ``(n, n)``."""
    zxing = library("zxingcpp", "pages that a scanner reads need", "scan")
    code = zxing.create_barcode(text, zxing.BarcodeFormat.QRCode, ec_level=CORRECTION)
    return np.asarray(code.to_image(scale=1, add_quiet_zones=False)) < 128


def _runs(dark: np.ndarray) -> Iterator[tuple[int, int, int]]:
    """Dark modules side by side: row, first column, how many."""
    for row, line in enumerate(dark):
        edges = np.flatnonzero(np.diff(np.concatenate(([0], line.astype(int), [0]))))
        for start, end in edges.reshape(-1, 2).tolist():
            yield row, start, end - start
