"""Stored results of each page, so that a stopped job continues, and another run adds more scans.

A page is known by the digest of its file and its number there, never by a file's name or place; what is kept
of it is written whole or not at all.
"""

from __future__ import annotations

import zlib
from base64 import b64decode, b64encode
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import numpy as np

from coursework.errors import BadInput
from coursework.messages import Message
from coursework.parsing.scanned import picture_of
from coursework.system.json_files import read_json
from coursework.system.limits import MOST_PAGES
from coursework.system.tables import json_text
from coursework.system.writing import write_whole

_Stored = TypeVar("_Stored", "ScannedField", "PageScan", "ScannedFile")

FORMAT = 1  #: of what is kept; another one is read anew
FOLDER, FILES = ".scanned", "files.json"
SCALE = 8  #: pixels to the mm of a picture that is kept

#: What a page is.
ANSWERS, STATEMENT, BLANK, LOST, REFUSED = "answers", "statement", "blank", "lost", "refused"


OTHER_NAME = "other name"  #: why a page is lost whose code is of one student, and its printed name of another


@dataclass(frozen=True)
class ScannedField:
    """Reading of one answer, or of one of its coordinates."""

    exercise: str
    seed: int
    part: str
    coordinate: int
    coordinates: int
    what: str  #: ticks, number, written, drawing
    text: str  #: what was read, or the likeliest of it
    confidence: float
    waits: str  #: why a person must look; empty where none must
    crop: str  #: file of its own picture, below the folder of the job; empty where none was cut
    box: tuple[float, float, float, float]  #: x, y, width, height on the page, mm
    candidates: tuple[tuple[str, float], ...] = ()  #: what a doubted number may be, with probabilities


@dataclass(frozen=True)
class PageScan:
    """Result of one scanned page: answers, a page of a statement, blank, lost (unknown which page it is), or
    refused."""

    what: str
    reason: str = ""  #: why nothing was read of it
    code: str = ""  #: of its paper
    number: int = 0  #: of the page among the answer pages of its paper
    fields: tuple[ScannedField, ...] = ()
    is_straight: bool = False  #: its picture is the page laid flat, at :data:`SCALE`
    has_picture: bool = True
    least: float = 0.0  #: the confidence below which it was left to a person
    look: str = ""  #: how dark the page is, laid flat, by :func:`look_of`; empty where it is not straight


@dataclass(frozen=True)
class ScannedFile:
    """A file that was scanned."""

    name: str
    digest: str
    pages: int
    fault: str = ""


def page_id(digest: str, number: int) -> str:
    """Return the name of a file's page, counted from 1."""
    return f"{digest}-{number:04d}"


def put_page(out: Path, name: str, page: PageScan, pictures: Mapping[str, bytes]) -> None:
    """Store a page: its pictures first, so that a stored page always has them."""
    for file, data in pictures.items():
        write_whole(out / file, data)
    write_whole(out / FOLDER / f"{name}.json", json_text(page_as_json(page)).encode())


def page_of(content: Mapping[str, Any]) -> PageScan | None:
    """Return the page in JSON; None if it is of another format."""
    fields_left = dict(content)
    try:
        if fields_left.pop("format") != FORMAT:
            return None
        fields = tuple(_field(entry) for entry in fields_left.pop("fields"))
        return _checked(PageScan(**fields_left, fields=fields))
    except (ValueError, KeyError, TypeError):
        return None


def _field(entry: Mapping[str, Any]) -> ScannedField:
    given = {"candidates": (), **entry}
    candidates = tuple((str(text), float(chance)) for text, chance in given["candidates"])
    return _checked(ScannedField(**{**given, "box": _box(given["box"]), "candidates": candidates}))


def _box(numbers: Any) -> tuple[float, float, float, float]:
    """Four numbers. Raises TypeError, ValueError: they are others."""
    x, y, width, height = numbers
    if not all(type(number) in _TYPES[float] for number in numbers):
        raise TypeError(numbers)
    return x, y, width, height


_TYPES = {str: (str,), int: (int,), float: (int, float), bool: (bool,)}


def _checked(stored: _Stored) -> _Stored:
    """Check that the fields of a stored object have their declared types; return the object. Raises
    TypeError: one is not."""
    for name, sort in get_type_hints(type(stored)).items():
        if sort in _TYPES and type(getattr(stored, name)) not in _TYPES[sort]:
            raise TypeError(f"{name} is {getattr(stored, name)!r}"[:80])
    return stored


def page_as_json(page: PageScan) -> dict[str, Any]:
    """Return a page as JSON."""
    return {"format": FORMAT, **asdict(page)}


def stored_page(out: Path, name: str) -> PageScan | None:
    """Return the stored result of a page; None if there is none, or if it is of another format."""
    try:
        content = read_json(out / FOLDER / f"{name}.json")
    except BadInput:
        return None
    page = page_of(content) if isinstance(content, dict) else None
    if page is None:
        return None
    return page if not page.has_picture or (out / picture_of(name)).is_file() else None


def stored_files(out: Path) -> list[ScannedFile]:
    """Return the files that were scanned before.

    Raises
    ------
    BadInput
        The list is there, and is none.
    """
    path = out / FOLDER / FILES
    if not path.exists():
        return []
    try:
        return [_checked_file(ScannedFile(**entry)) for entry in read_json(path)]
    except (ValueError, TypeError) as fault:
        raise BadInput(
            (
                "{path} is not as 'coursework scan' wrote it ({fault}): remove it and name all scans "
                "again, or choose"
                " another --out"
            ),
            path=path,
            fault=str(fault)[:80],
        ) from fault


def _checked_file(file: ScannedFile) -> ScannedFile:
    if not 0 <= _checked(file).pages <= MOST_PAGES:
        raise ValueError(f"{file.name} of {str(file.pages)[:20]} pages")
    return file


def put_files(out: Path, files: Iterable[ScannedFile]) -> None:
    """Keep the list of files."""
    write_whole(out / FOLDER / FILES, json_text([asdict(file) for file in files]).encode())


def joined(before: Iterable[ScannedFile], now: Iterable[ScannedFile]) -> list[ScannedFile]:
    """Return the earlier and the current files, each once, in the order of their names."""
    by_key = {(file.name, file.digest): file for file in (*before, *now)}
    return [by_key[key] for key in sorted(by_key)]


# ------------------------------------------------------------------------- copies

_CELL = 20  #: pixels, of a page of 10 to the mm, that are one of its look: a stroke in them shows
_SAME = 20  #: of 255, by which cells of a copy differ at most


def look_of(paper: np.ndarray) -> str:
    """Return the darkness of a flattened page, cell by cell, as text: nearly the same for a copy of the page
    in any orientation."""
    high, wide = (n // _CELL * _CELL for n in paper.shape)
    cells = paper[:high, :wide].reshape(high // _CELL, _CELL, wide // _CELL, _CELL).mean(axis=(1, 3))
    return b64encode(zlib.compress((cells // 4 * 4).astype(np.uint8).tobytes(), 9)).decode()


def with_copies(pages: Iterable[Scanned]) -> list[Scanned]:
    """Return the pages, with those marked as copies that look like an earlier page of the same sheet."""
    met: dict[tuple[str, int], list[tuple[np.ndarray, PageScan]]] = {}
    result = []
    for scan in pages:
        cells = _cells(scan.page.look)
        if cells is not None and not scan.is_copy:
            others = met.setdefault((scan.page.code, scan.page.number), [])
            if any(_is_alike(cells, o) and _says_the_same(scan.page, page) for o, page in others):
                scan = replace(scan, is_copy=True)
            else:
                others.append((cells, scan.page))
        result.append(scan)
    return result


def _is_alike(cells: np.ndarray, others: np.ndarray) -> bool:
    return cells.shape == others.shape and bool(np.abs(cells - others).max() <= _SAME)


def _says_the_same(page: PageScan, other: PageScan) -> bool:
    """Return True if two pages agree in every field of which both are certain."""
    sure = ((a, b) for a, b in zip(page.fields, other.fields, strict=False) if not (a.waits or b.waits))
    return all(a.text == b.text for a, b in sure)


def _cells(look: str) -> np.ndarray | None:
    try:
        return np.frombuffer(zlib.decompress(b64decode(look)), np.uint8).astype(np.int16) if look else None
    except (ValueError, zlib.error):
        return None


@dataclass(frozen=True)
class Scanned:
    """One page of one file, as it stands in the list of pages."""

    file: ScannedFile
    number: int  #: in the file; 0 for a file of which no page can be read
    id: str
    page: PageScan
    is_copy: bool = False  #: a file of the same content, or a page of the same look, was met before


def scanned(out: Path, files: Iterable[ScannedFile]) -> Iterator[Scanned]:
    """Every page of the files, in order; a file that cannot be read is one."""
    met: set[str] = set()
    for file in files:
        if file.fault:
            yield Scanned(file, 0, "", PageScan(REFUSED, file.fault, has_picture=False))
            continue
        for number in range(1, file.pages + 1):
            name = page_id(file.digest, number)
            page = stored_page(out, name) or PageScan(
                REFUSED, Message("its reading is missing: name its scan again"), has_picture=False
            )
            yield Scanned(file, number, name, page, file.digest in met)
        met.add(file.digest)
