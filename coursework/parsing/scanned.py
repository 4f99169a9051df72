"""Answers that stand on scanned pages, stated by the places of their pictures."""

from __future__ import annotations

import re

_PICTURES, _CROPS = "pictures", "crops"  #: folders of pages, and of fields
_PAGE = r"[0-9a-f]{16}-\d{4,6}"
_OF_SITE = re.compile(rf"scan ({_PAGE})/(\d{{1,4}})")
_OF_FOLDER = re.compile(rf"{_PICTURES}/{_PAGE}\.jpg|{_CROPS}/{_PAGE}-\d+\.png")
_STARTS = ("scan ", f"{_PICTURES}/", f"{_CROPS}/")


def picture_of(page: str) -> str:
    """Return the file of a page's picture, relative to the folder of the job."""
    return f"{_PICTURES}/{page}.jpg"


def crop_of(page: str, index: int) -> str:
    """Return the file of a field's picture, relative to the folder of the job."""
    return f"{_CROPS}/{page}-{index:02d}.png"


def scan_reference(page: str, index: int) -> str:
    """Return what stands for an answer on the site: the id of its page, and the field there."""
    return f"scan {page}/{index}"


def scan_references(text: str) -> tuple[tuple[str, str], ...]:
    """Return the page and the field of each picture that a text of the site names."""
    return tuple((found[1], found[2]) for piece in text.split("; ") if (found := _OF_SITE.fullmatch(piece)))


def names_pictures(text: str) -> bool:
    """Return True if a text is not an answer and names the pictures of one: a person has to look at them."""
    return text.startswith(_STARTS) and all(
        _OF_SITE.fullmatch(piece) or _OF_FOLDER.fullmatch(piece) for piece in text.split("; ")
    )
