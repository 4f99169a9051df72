"""Jobs that read uploaded scans, in a separate process so that no student waits for them.

The state of a job is in the database, so that every process of the site can show it.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Mapping, Sequence
from contextvars import copy_context
from datetime import datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from coursework.course.course import opened
from coursework.course.variant import Variant
from coursework.database.assignments import issued_content
from coursework.database.audit import note
from coursework.database.scans import ScannedPage, put_scanned
from coursework.database.settings import put_value, value_of
from coursework.errors import CourseworkError
from coursework.scanning.page_reading import Papers
from coursework.scanning.scan import read_files
from coursework.scanning.scan_store import REFUSED, PageScan, page_as_json, page_id, picture_of, stored_page
from coursework.site.frame.settings import Site
from coursework.system.processes import processes, workers

_PATIENCE = 1.5  #: seconds for which the request waits for the job
_GIVEN_UP = timedelta(minutes=60)  #: after which an unfinished job counts as interrupted
RUNNING, DONE, FAILED = "running", "done", "failed"


class ScanJob(NamedTuple):
    """State of the job that reads the last upload."""

    state: str
    files: int
    pages: int = 0  #: number of new pages, at the end
    messages: tuple[str, ...] = ()  #: reasons of a failure


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
    _store_state(site, number, ScanJob(RUNNING, len(sent)))
    # The context has the reader's language, in which faults are stored.
    thread = threading.Thread(
        target=copy_context().run, args=(_run, site, number, dict(sent), by), daemon=True
    )
    thread.start()
    thread.join(_PATIENCE)


def job(site: Site, number: int) -> ScanJob | None:
    """Return the state of the last job; None if nothing was ever uploaded. An interrupted job counts as
    failed."""
    with site.store.reading() as connection:
        stored = value_of(connection, _key(number))
    if stored is None:
        return None
    state, files, pages, messages = stored["job"]
    status = ScanJob(state, files, pages, tuple(messages))
    if state == RUNNING and site.clock() - datetime.fromisoformat(stored["at"]) > _GIVEN_UP:
        return status._replace(state=FAILED)
    return status


def _key(number: int) -> str:
    return f"scans {number}"


def _store_state(site: Site, number: int, now: ScanJob) -> None:
    with site.store.begin() as connection:
        put_value(connection, _key(number), {"job": list(now), "at": site.clock().isoformat()})


def _run(site: Site, number: int, sent: Mapping[str, bytes], by: str) -> None:
    begun = ScanJob(RUNNING, len(sent))
    try:
        with site.store.reading() as connection:
            content = issued_content(connection, number)
        scanned = _read_apart(str(site.course.folder.root), content, sent)
        pages = _store(site, number, content, scanned, by)
        _store_state(site, number, begun._replace(state=DONE, pages=pages))
    except CourseworkError as fault:
        _store_state(site, number, begun._replace(state=FAILED, messages=(str(fault),)))
    except Exception as fault:  # the page reports it, since nobody waits for this thread
        _store_state(site, number, begun._replace(state=FAILED, messages=(type(fault).__name__,)))


def _read_apart(root: str, content: Mapping[str, Any], sent: Mapping[str, bytes]) -> list[_ScannedPage]:
    if workers(2) < 2:
        return _read(root, content, sent)
    with processes(1) as submit:
        scanned: list[_ScannedPage] = submit(_read, root, content, sent).result()
        return scanned


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
