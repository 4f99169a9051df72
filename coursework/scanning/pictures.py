"""Pictures of pages as a scanner or a telephone gives them: PDF, PNG, JPEG, TIFF of several pages; grey, one
at a time."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coursework.errors import BadInput
from coursework.messages import Message
from coursework.system.extras import library
from coursework.system.limits import LEAST_OF_PAGE, MOST_PAGES, MOST_PAGES_OF_TIFF, beyond
from coursework.system.processes import Exceeded, ResourceLimits, confined

#: A page of so many pixels is A4 at 600 dots an inch, and half as much again.
LARGEST = 52_000_000
#: A page is at least so many pixels wide and high: its code alone has 29.
NARROWEST = 40
#: Dots an inch at which a page of a PDF is drawn.
PDF_DPI = 300
_SMALLEST, _WIDEST = 36.0, 14_400.0  #: points, of a side of a page of a PDF; a PDF has no wider one
_BESIDE = 4  #: pixels beside a streak where there is none
_BLACK, _WHITE = 40, 215  #: of 255: what is between is grey
_STRIPS = 100  #: across the picture, in which a streak is looked for
_STREAK = 5  #: of 255, by how much a streak is darker at least
_FEW = 20  #: pages that a file of any size may have
#: Pictures and words of a page that is drawn here; one of more, or of lines, is drawn apart.
_MOST_PIECES = 5_000
_MOST_PICTURES = 8  #: of a page that is drawn here
_DRAWING = ResourceLimits(30.0, 1_500_000_000)  #: of a process in which a page is drawn
_NEEDS = ("reading scans needs", "scan")
SUFFIXES = (".pdf", ".png", ".jpg", ".jpeg", ".tif", ".tiff")


_UNREADABLE = Message("page {page} of {file} cannot be read: {problem}")


class BadPicture(BadInput):
    """A file that is not a picture of a page, is damaged, or is larger than a page can be; names it."""


@dataclass(frozen=True)
class PageImage:
    """Page of a file: ``grey`` is ``(height, width)``, 0 black to 255 white; ``page`` counts from 1."""

    file: str
    page: int
    grey: np.ndarray


@cache
def opencv() -> Any:
    """Return OpenCV; the limit on the size of a picture is set before it is loaded.

    Raises
    ------
    NotAtHand
        It is not installed.
    """
    os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(LARGEST))
    os.environ.setdefault("OPENCV_LOG_LEVEL", "OFF")  # we report once what is wrong with a file
    return library("cv2", *_NEEDS)


def pictures(path: Path) -> Iterator[PageImage]:
    """Yield the pages of a file, in order, one in memory at a time.

    Raises
    ------
    BadPicture
        The file, or a page of it, cannot be read; pages before it have been given.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise BadPicture(
            "{file} is not a scan that can be read: {endings}", file=path.name, endings=", ".join(SUFFIXES)
        )
    yield from _of_pdf(path) if suffix == ".pdf" else _of_image(path)


def _of_pdf(path: Path) -> Iterator[PageImage]:
    pdfium: Any = library("pypdfium2", *_NEEDS)
    try:
        document = pdfium.PdfDocument(path)
    except pdfium.PdfiumError as fault:
        raise BadPicture(
            "{file} is not a PDF that can be read: {problem}", file=path.name, problem=fault
        ) from fault
    with document:
        for number in range(len(document)):
            yield PageImage(path.name, number + 1, _drawn(pdfium, document, number, path))


def _drawn(pdfium: Any, document: Any, number: int, path: Path) -> np.ndarray:
    """Return a page of a PDF, rendered at 300 dots per inch, or at fewer if it would exceed the largest
    page."""
    try:
        page = document[number]
        width, height = page.get_width(), page.get_height()
        if not _SMALLEST <= min(width, height) <= max(width, height) <= _WIDEST:
            raise BadPicture(
                "page {page} of {file} is {width} by {height} inches: no paper has this size",
                page=number + 1,
                file=path.name,
                width=f"{width / 72:.3g}",
                height=f"{height / 72:.3g}",
            )
        scale = min(PDF_DPI / 72, (LARGEST / (width * height)) ** 0.5)
        if _is_scanned(pdfium, page):
            return _render(page, scale)
        drawn: np.ndarray = confined(_DRAWING, _render_apart, path, number, scale)
        return drawn
    except Exceeded as fault:
        raise BadPicture(
            "page {page} of {file} takes too much {resource} to be drawn: print it, and scan it",
            page=number + 1,
            file=path.name,
            resource=Message(fault.resource),
        ) from None
    except pdfium.PdfiumError as fault:
        raise BadPicture(
            "page {page} of {file} cannot be drawn: {problem}", page=number + 1, file=path.name, problem=fault
        ) from fault


def _render(page: Any, scale: float) -> np.ndarray:
    drawn = np.array(page.render(scale=scale, grayscale=True, rev_byteorder=False).to_numpy())
    return drawn.reshape(drawn.shape[:2])


def _render_apart(path: Path, number: int, scale: float) -> np.ndarray:
    with _opened(path) as document:
        return _render(document[number], scale)


def _is_scanned(pdfium: Any, page: Any) -> bool:
    """Return whether a page is what scanners write: few pictures, of no more dots than a page has, and the
    words that were found on them. Anything else may take any time to be drawn."""
    pictures = dots = 0
    for count, item in enumerate(page.get_objects(max_depth=1)):
        if item.type == pdfium.raw.FPDF_PAGEOBJ_IMAGE:
            pictures, dots = pictures + 1, dots + int(np.prod(item.get_px_size()))
        if (
            item.type not in (pdfium.raw.FPDF_PAGEOBJ_IMAGE, pdfium.raw.FPDF_PAGEOBJ_TEXT)
            or count >= _MOST_PIECES
        ):
            return False
    return pictures <= _MOST_PICTURES and dots <= 2 * LARGEST


def _of_image(path: Path) -> Iterator[PageImage]:
    cv2 = opencv()
    count = _pages_of_image(cv2, path)
    for number in range(count):
        yield PageImage(path.name, number + 1, _decoded(cv2, path, number))


def _pages_of_image(cv2: Any, path: Path) -> int:
    try:
        count = int(cv2.imcount(str(path)))
    except cv2.error:
        count = 0
    if not count:
        raise BadPicture(
            "{file} is not a picture that can be read, or is larger than {most} pixels",
            file=path.name,
            most=f"{LARGEST:,}",
        )
    return count


def _decoded(cv2: Any, path: Path, number: int) -> np.ndarray:
    """Return a page of an image, rotated by its orientation tag."""
    try:
        if number or path.suffix.lower() in (".tif", ".tiff"):
            _, result = cv2.imreadmulti(str(path), number, 1, flags=cv2.IMREAD_GRAYSCALE)
            grey = result[0] if result else None
        else:
            grey = _single(cv2, path)
    except cv2.error as fault:
        too_large = "MAX_IMAGE_PIXELS" in str(fault.err)
        why = Message("it is larger than {most} pixels", most=f"{LARGEST:,}") if too_large else fault.err
        raise BadPicture(_UNREADABLE, page=number + 1, file=path.name, problem=why) from fault
    if grey is None:
        raise BadPicture(_UNREADABLE, page=number + 1, file=path.name, problem=Message("it is damaged"))
    if min(grey.shape) < NARROWEST:
        high, wide = grey.shape
        raise BadPicture(
            "page {page} of {file} is {width} by {height} pixels: too few to read",
            page=number + 1,
            file=path.name,
            width=wide,
            height=high,
        )
    return np.asarray(grey)


def _single(cv2: Any, path: Path) -> Any:
    """Return a picture of one page; a transparent PNG is laid on white paper."""
    if path.suffix.lower() != ".png" or not _may_be_transparent(path):
        return cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    if image is None or image.ndim != 3 or image.shape[2] != 4:
        return image if image is None else cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    most = float(np.iinfo(image.dtype).max)
    grey, cover = cv2.cvtColor(image, cv2.COLOR_BGRA2GRAY), image[..., 3] / np.float32(most)
    return np.rint((255 / most) * grey * cover + 255 * (1 - cover)).astype(np.uint8)


def _may_be_transparent(path: Path) -> bool:
    """Return True if the header of a PNG states an alpha channel."""
    with path.open("rb") as file:
        head = file.read(26)
    return head[:4] == b"\x89PNG" and head[25:] in (b"\x04", b"\x06")


def is_two_toned(grey: NDArray[np.uint8]) -> bool:
    """Return True if a picture is black and white, including halftones: a grey one has more grey around its
    ink than ink."""
    some = grey[::2, ::2]
    black, white = np.count_nonzero(some <= _BLACK), np.count_nonzero(some >= _WHITE)
    return bool(some.size - black - white < black)


def page_count(path: Path) -> int:
    """Return the number of pages of a file.

    Raises
    ------
    BadPicture
        It cannot be read, or has more than any scan.
    """
    count = _pages(path)
    most = MOST_PAGES_OF_TIFF if path.suffix.lower() in (".tif", ".tiff") else MOST_PAGES
    if count > most:
        raise BadPicture(
            "{place}: {problem}", place=path.name, problem=beyond("a file", count, most, "pages")
        )
    size = path.stat().st_size
    if count > _FEW and size < count * LEAST_OF_PAGE:
        raise BadPicture(
            "{file} has {count} pages in {size} bytes: no scan is so small; scan the sheets, or name "
            "the file that the scanner wrote",
            file=path.name,
            count=f"{count:,}",
            size=f"{size:,}",
        )
    return count


def _pages(path: Path) -> int:
    if path.suffix.lower() != ".pdf":
        return _pages_of_image(opencv(), path)
    with _opened(path) as document:
        return len(document)


def picture_at(path: Path, number: int) -> PageImage:
    """Return one page of a file, counted from 1.

    Raises
    ------
    BadPicture
        It cannot be read.
    """
    if path.suffix.lower() != ".pdf":
        return PageImage(path.name, number, _decoded(opencv(), path, number - 1))
    with _opened(path) as document:
        return PageImage(path.name, number, _drawn(library("pypdfium2", *_NEEDS), document, number - 1, path))


def _opened(path: Path) -> Any:
    pdfium: Any = library("pypdfium2", *_NEEDS)
    try:
        return pdfium.PdfDocument(path)
    except pdfium.PdfiumError as fault:
        raise BadPicture(
            "{file} is not a PDF that can be read: {problem}", file=path.name, problem=fault
        ) from fault


def without_streaks(grey: np.ndarray) -> np.ndarray:
    """Return a picture without the lines that dirt on a scanner's glass draws along a whole page; ink under
    them remains.

    A line is some pixels wide, and as much darker than what is beside it all along the picture.
    """
    for axis in (1, 0):
        lost = _streaks(grey if axis == 1 else grey.T)
        if lost.any():
            light = grey.astype(np.int16) + (lost if axis == 1 else lost[:, None])
            grey = np.clip(light, 0, 255).astype(np.uint8)
    return grey


def _streaks(grey: np.ndarray) -> np.ndarray:
    """For each column, by how much a line that runs down it is darker than the paper beside it."""
    high = max(1, grey.shape[0] // _STRIPS)
    strips = opencv().resize(grey, (grey.shape[1], grey.shape[0] // high), interpolation=opencv().INTER_AREA)
    strips = strips.astype(np.int16)
    neighbours = np.minimum(np.roll(strips, _BESIDE, axis=1), np.roll(strips, -_BESIDE, axis=1))
    low, middle = np.percentile(neighbours - strips, (15, 40), axis=0)
    lost = np.where((low > 0.5 * middle) & (low >= _STREAK), middle, 0).astype(np.int16)
    lost[: 2 * _BESIDE] = lost[-2 * _BESIDE :] = 0
    return lost
