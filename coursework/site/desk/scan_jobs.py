"""Jobs that read uploaded scans, in a separate process so that no student waits for them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from coursework.course.course import opened
from coursework.course.variant import Variant
from coursework.database.assignments import issued_content
from coursework.database.audit import note
from coursework.database.scans import ScannedPage, put_scanned
from coursework.parsing.scanned import picture_of
from coursework.scanning.page_reading import Papers
from coursework.scanning.scan import read_files
from coursework.scanning.scan_store import REFUSED, PageScan, page_as_json, page_id, stored_page
from coursework.site.frame import jobs
from coursework.site.frame.jobs import Job
from coursework.site.frame.settings import Site


class _ScannedPage(NamedTuple):
    """Scanned page."""

    page: str
    file: str
    number: int
    content: PageScan
    picture: bytes


def begin(site: Site, number: int, sent: Mapping[str, bytes], by: str) -> None:
    """Start to read the uploaded files, given by name, for the person ``by``; return at the end or after a
    short wait."""
    jobs.begin(site, _key(number), "", len(sent), partial(_run, site, number, dict(sent), by))


def job(site: Site, number: int) -> Job | None:
    """Return the state of the job that reads the last upload, whose result is the number of new pages; None
    if nothing was ever uploaded."""
    return jobs.stored_job(site, _key(number))


def _key(number: int) -> str:
    return f"scans {number}"


def _run(site: Site, number: int, sent: Mapping[str, bytes], by: str) -> tuple[int, tuple[str, ...]]:
    with site.store.reading() as connection:
        content = issued_content(connection, number)
    scanned = jobs.apart(_read, str(site.course.folder.root), content, sent)
    return _store(site, number, content, scanned, by), ()


def _read(root: str, content: Mapping[str, Any], sent: Mapping[str, bytes]) -> list[_ScannedPage]:
    course = opened(root, Variant)
    with TemporaryDirectory(prefix="coursework-") as temporary:
        folder = Path(temporary).resolve()
        issued, scans, out = folder / "issued.json", folder / "scans", folder / "read"
        issued.write_text(json.dumps(content), "utf-8")
        scans.mkdir()
        for name, data in sent.items():
            (scans / name).write_bytes(data)
        files, _ = read_files(Papers(course, content), [scans], issued, out)
        return [
            page
            for file in files
            for page in _scanned_pages(out, file.name, file.digest, file.pages, file.fault)
        ]


def _scanned_pages(out: Path, name: str, digest: str, pages: int, fault: str) -> Sequence[_ScannedPage]:
    if fault:
        return [_ScannedPage(page_id(digest, 0), name, 0, PageScan(REFUSED, fault, has_picture=False), b"")]
    scanned = []
    for number in range(1, pages + 1):
        page_name = page_id(digest, number)
        page = stored_page(out, page_name)
        if page is not None:
            scanned.append(_ScannedPage(page_name, name, number, page, _bytes(out / picture_of(page_name))))
    return scanned


def _bytes(path: Path) -> bytes:
    return path.read_bytes() if path.is_file() else b""


def _store(
    site: Site, number: int, content: Mapping[str, Any], scanned: Sequence[_ScannedPage], by: str
) -> int:
    """Store all pages in one transaction; return the number of new ones."""
    papers = Papers(site.course, content).papers
    at = site.clock()
    with site.store.begin() as connection:
        new = 0
        for item in scanned:
            student = papers[item.content.code].student if item.content.code in papers else ""
            page = ScannedPage(item.page, item.file, item.number, student, page_as_json(item.content), at)
            is_new = put_scanned(connection, number, page, item.picture)
            new += is_new and item.number > 0
        note(connection, at, by, "scans", assignment=number, pages=len(scanned), new=new)
    return new
