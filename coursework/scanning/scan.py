"""The job: scans become answers, a queue for people, and a list of what could not be read; every page is in
one of them.

What is written is a function of all scans that were ever named, what was typed, and what was issued: neither
the order of files, nor how often the job was run or stopped, makes a difference.
"""

from __future__ import annotations

import hashlib
import json
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from coursework.course.course import Course
from coursework.errors import BadInput, reason_of
from coursework.issuing.answer_papers import AnswerPaper
from coursework.issuing.issued import COLUMNS, Issued
from coursework.messages import Message, localised
from coursework.parsing.scanned import crop_of, picture_of
from coursework.scanning.digits import CONFIDENT
from coursework.scanning.gathering import (
    FieldPosition,
    Gathered,
    PrintedField,
    PrintedPaper,
    gather,
)
from coursework.scanning.page_reading import (
    OTHER_SHEET,
    Desk,
    PageRange,
    Papers,
    count_pages,
    cut,
    read_pages,
    typed_page,
)
from coursework.scanning.parts import Joins
from coursework.scanning.queue import ScanQueue, write_queue
from coursework.scanning.scan_store import (
    ANSWERS,
    LOST,
    REFUSED,
    PageScan,
    Scanned,
    ScannedField,
    ScannedFile,
    joined,
    page_id,
    put_files,
    put_page,
    scanned,
    stored_files,
    stored_page,
    with_copies,
)
from coursework.scanning.sources import Scan, scans
from coursework.scanning.typed import PAGE, Typed, merged, read_rows, read_typed, typed_file
from coursework.system.processes import processes, workers
from coursework.system.tables import SPREADSHEETS, Spreadsheet
from coursework.system.writing import Progress, TableFile, Tables, write_whole, writing

TYPED = "typed.csv"
_MISSING = "missing.csv"
LEAST = CONFIDENT  #: by default, the confidence below which nothing is guessed
ANSWER_COLUMNS = (*COLUMNS, "source")
PAGE_COLUMNS = (
    "file",
    "page",
    "what",
    "student",
    "paper",
    "number",
    "of",
    "fields",
    "read",
    "waiting",
    "picture",
)
REJECTED_COLUMNS = ("file", "page", "reason", "picture")
_ALL = "all"  #: the missing pages of a paper of which nothing was scanned
MISSING_COLUMNS = ("student", "paper", "pages", "scanned", "missing")
_CHUNK = 4  #: pages that a process is sent at once
_WORTH_PROCESSES = 8  #: pages; fewer are read before a process has started
_WORTH_COUNTING = 60  #: files of which the pages are counted
_AHEAD = 3  #: chunks a process that wait for it


@dataclass
class ScanBook:
    """Counts of a scan job; its results are in the folder."""

    pages: int = 0
    read_now: int = 0
    answers: int = 0
    waiting: int = 0
    rejected: list[tuple[str, str]] = field(default_factory=list)  #: file and page, and why
    statements: int = 0
    blank: int = 0
    copies: int = 0
    missing: list[str] = field(default_factory=list)  #: whose paper lacks pages, and which
    absent: int = 0  #: papers of which no page was scanned
    unused: int = 0  #: lines of typed.csv that fit nothing

    @property
    def needs_a_look(self) -> bool:
        return bool(self.waiting or self.rejected or self.missing)


def scan(
    course: Course[Any],
    sources: Sequence[Path],
    issued: Path,
    out: Path,
    *,
    typed: Sequence[Path] = (),
    least: float = LEAST,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    progress: Progress = lambda done, of: None,
) -> ScanBook:
    """Read scans, add them to those of before, and write what all of them say.

    Parameters
    ----------
    sources
        PDFs, pictures, archives and folders of them; none to go on with what was read before.
    typed
        Files of what people typed, beside the ``typed.csv`` of the folder; the later one counts.
    least
        The confidence below which nothing is guessed.

    Raises
    ------
    BadInput
        A named file does not exist or is not a scan, or the folder cannot be written.
    """
    papers = Papers(course, _read_issued(issued))
    wanted = [text for path in typed for text in read_typed(path)]
    typed_path = out / TYPED
    typed_texts = merged(read_typed(typed_path) if typed_path.exists() else (), wanted)
    files, read_now = read_files(papers, sources, issued, out, least, progress)
    everything = joined(stored_files(out), files)
    if not everything:
        raise BadInput("nothing to read: name the scans; {out} contains none from before", out=out)
    put_files(out, everything)
    if typed_texts:
        write_whole(typed_path, typed_file(typed_texts))
    book = write_read(papers, with_copies(scanned(out, everything)), typed_texts, out, spreadsheet, least)
    book.read_now = read_now
    return book


def read_files(
    papers: Papers,
    sources: Sequence[Path],
    issued: Path,
    out: Path,
    least: float = LEAST,
    progress: Progress = lambda done, of: None,
) -> tuple[list[ScannedFile], int]:
    """Read the pages of what is named that were not read before, and keep each; gives the files, and how many
    pages were read.

    Raises
    ------
    BadInput
        A source is not there, or the folder cannot be written.
    """
    with writing(out):
        out.mkdir(parents=True, exist_ok=True)
    stamp = hashlib.sha256(issued.read_bytes()).hexdigest()[:16]
    desk = Desk(str(papers.course.folder.root), str(issued.resolve()), stamp, str(out), least)
    with TemporaryDirectory(prefix="coursework-") as unpacked:
        return _read(desk, papers, scans(sources, Path(unpacked)), progress)


def _read_issued(path: Path) -> Mapping[str, Any]:
    try:
        content = json.loads(path.read_bytes())
    except OSError as fault:
        raise BadInput("{path} cannot be read: {strerror}", path=path, strerror=reason_of(fault)) from fault
    except (ValueError, RecursionError) as fault:
        raise BadInput("{path} is not JSON: {fault}", path=path, fault=str(fault)[:100]) from fault
    if not isinstance(content, dict):
        raise BadInput(
            "{path} is not a list of issued records; 'coursework build' writes issued.json", path=path
        )
    Issued(content, str(path))
    return content


# ------------------------------------------------------------------------ reading


def _read(
    desk: Desk, papers: Papers, sources: Sequence[Scan], progress: Progress
) -> tuple[list[ScannedFile], int]:
    """Read the pages of files that were not read before; gives the files and how many pages were read now."""
    count = workers(len(sources)) if len(sources) >= _WORTH_COUNTING else 1
    readable = [scan for scan in sources if not scan.fault]
    paths = {scan.digest: scan.path for scan in readable}
    with _shared(count) as share:
        counted = dict(zip(paths, share(count_pages, [(str(path),) for path in paths.values()]), strict=True))
    files = [
        ScannedFile(
            source.name, source.digest, *((0, source.fault) if source.fault else counted[source.digest])
        )
        for source in sources
    ]
    wanted = [
        piece
        for digest, path in paths.items()
        for piece in _chunks(desk, papers, str(path), digest, counted[digest][0])
    ]
    pages = sum(piece.last + 1 - piece.first for piece in wanted)
    done = 0
    with _shared(workers(len(wanted)) if pages >= _WORTH_PROCESSES else 1) as share:
        for number in share(read_pages, [(desk, piece) for piece in wanted]):
            done += number
            progress(done, pages)
    return files, pages


def _chunks(desk: Desk, papers: Papers, path: str, digest: str, count: int) -> Iterator[PageRange]:
    """Yield the pages of a file that are to be read, a few at a time."""
    first = 0
    for number in range(1, count + 2):
        is_wanted = number <= count and _is_to_be_read(desk, papers, page_id(digest, number))
        if first and (not is_wanted or number - first == _CHUNK):
            yield PageRange(path, digest, first, number - 1)
            first = 0
        first = first or (number if is_wanted else 0)


def _is_to_be_read(desk: Desk, papers: Papers, name: str) -> bool:
    """Return True if there is no stored result of a page, or if it may be different now."""
    page = stored_page(Path(desk.out), name)
    if page is None or page.least != desk.least:
        return True
    return page.what == REFUSED and page.code in papers


class _shared:
    """Work shared by so many processes, or done here by one; results come in the order of what was asked, few
    ahead."""

    def __init__(self, count: int):
        self._count = count
        self._pool = processes(count) if count > 1 else nullcontext(None)

    def __enter__(self) -> Callable[[Callable[..., Any], Sequence[tuple[Any, ...]]], Iterator[Any]]:
        self._submit: Any = self._pool.__enter__()
        return self._each

    def __exit__(self, *fault: Any) -> None:
        self._pool.__exit__(*fault)

    def _each(self, work: Callable[..., Any], calls: Sequence[tuple[Any, ...]]) -> Iterator[Any]:
        if self._submit is None:
            yield from (work(*arguments) for arguments in calls)
            return
        ahead: deque[Future[Any]] = deque()
        for arguments in calls:
            ahead.append(self._submit(work, *arguments))
            if len(ahead) > _AHEAD * self._count:
                yield ahead.popleft().result()
        while ahead:
            yield ahead.popleft().result()


# ------------------------------------------------------------------------ together


def write_read(
    papers: Papers,
    pages: Sequence[Scanned],
    typed: Sequence[Typed],
    out: Path,
    spreadsheet: Spreadsheet,
    least: float,
) -> ScanBook:
    """Write what pages say together: answers, the queue, what was rejected, what is missing, and the list of
    pages."""
    pages = [as_typed(scanned_page, papers, typed, least) for scanned_page in pages]
    printed = papers_asked(papers, pages)
    combined = together(papers, printed, pages, typed)
    book = ScanBook(
        len([scanned_page for scanned_page in pages if scanned_page.number]),
        0,
        len(combined.answers),
        len(combined.cards),
        unused=len(combined.unused),
    )
    with Tables(out, spreadsheet) as tables:
        _write_answers(tables.open("answers.csv", ANSWER_COLUMNS), combined, pages)
        _write_pages(tables, book, combined, printed, pages)
        _write_missing(tables.open(_MISSING, MISSING_COLUMNS), book, combined, papers, printed)
        queue = ScanQueue(papers, printed, combined, Joins(papers, printed), out)
        write_queue(queue, _cut)
        tables.commit()
    return book


def as_typed(scanned_page: Scanned, papers: Papers, typed: Sequence[Typed], least: float) -> Scanned:
    """Return a page in its current state: refused if it is of another issue, or replaced by a person's
    statement."""
    page = scanned_page.page
    if page.what == ANSWERS and page.code not in papers:
        return replace(scanned_page, page=PageScan(REFUSED, OTHER_SHEET, page.code))
    if page.what != LOST:
        return scanned_page
    answer = next((t.answer for t in typed if (t.exercise, t.part) == (PAGE, scanned_page.id)), None)
    if answer is None:
        return scanned_page
    code, _, number = answer.strip().partition(" ")
    if not answer.strip():
        return replace(scanned_page, page=PageScan(REFUSED, Message("set aside by hand: no answer page"), ""))
    if code in papers and number.isdecimal() and len(number) < 7 and 1 <= int(number) <= len(papers[code]):
        return replace(scanned_page, page=typed_page(papers, code, int(number), least))
    return scanned_page


def papers_asked(papers: Papers, pages: Sequence[Scanned]) -> dict[str, PrintedPaper]:
    """Return the papers of which some page was scanned, in the order of issue."""
    met = {scanned_page.page.code for scanned_page in pages if scanned_page.page.what == ANSWERS}
    return {code: _printed_paper(papers, code) for code in papers if code in met}


def _printed_paper(papers: Papers, code: str) -> PrintedPaper:
    laid_out = papers[code]
    fields = tuple(
        PrintedField(
            FieldPosition(f.exercise, f.seed, f.part, f.coordinate), f.coordinates, f.what, page.number
        )
        for page in laid_out
        for f in page.fields
    )
    return PrintedPaper(code, papers.papers[code].student, len(laid_out), fields)


def together(
    papers: Papers, printed: Mapping[str, PrintedPaper], pages: Sequence[Scanned], typed: Sequence[Typed]
) -> Gathered:
    """Combine the content of pages and typed texts."""
    return gather(pages, printed, typed, Joins(papers, printed))


# ------------------------------------------------------------------------- writing


def _write_answers(table: TableFile, combined: Gathered, pages: Sequence[Scanned]) -> None:
    sources = _sources(pages)
    for answer in sorted(combined.to_mark, key=lambda a: (a.student, a.exercise, a.seed)):
        source = "; ".join(sources[name] for name in answer.pages)
        row = dict(
            zip(
                COLUMNS,
                (answer.student, answer.exercise, str(answer.seed), answer.part, answer.text),
                strict=True,
            )
        )
        table.write({**row, "source": f"{source} (by hand)" if answer.by_hand else source})


def _sources(pages: Sequence[Scanned]) -> dict[str, str]:
    """Return the place of each page: the first file that contains it."""
    sources: dict[str, str] = {}
    for scanned_page in pages:
        sources.setdefault(scanned_page.id, f"{scanned_page.file.name} p. {scanned_page.number}")
    return sources


def _write_pages(
    tables: Tables,
    book: ScanBook,
    combined: Gathered,
    printed: Mapping[str, PrintedPaper],
    pages: Sequence[Scanned],
) -> None:
    table, rejected = tables.open("pages.csv", PAGE_COLUMNS), tables.open("rejected.csv", REJECTED_COLUMNS)
    for scanned_page in pages:
        state, page = "copy" if scanned_page.is_copy else scanned_page.page.what, scanned_page.page
        picture = picture_of(scanned_page.id) if scanned_page.id and page.has_picture else ""
        source = {"file": scanned_page.file.name, "page": scanned_page.number or ""}
        paper = printed.get(page.code)
        owner = {
            "student": combined.whose.get(page.code, ""),
            "paper": page.code,
            "number": page.number or "",
        }
        asking = [f for f in page.fields if f.part]
        read = {
            "of": paper.pages if paper else "",
            "fields": len(asking) if paper else "",
            "read": sum(not f.waits for f in asking) + combined.confirmed.get(scanned_page.id, 0)
            if paper
            else "",
            "waiting": combined.waits.get(scanned_page.id, 0) if paper or page.what == LOST else "",
        }
        table.write({**source, "what": state, **owner, **read, "picture": picture})
        book.copies += scanned_page.is_copy
        if scanned_page.is_copy:
            continue
        book.statements += page.what == "statement"
        book.blank += page.what == "blank"
        if page.what == REFUSED:
            rejected.write({**source, "reason": localised(page.reason), "picture": picture})
            book.rejected.append(
                (
                    f"{scanned_page.file.name} p. {scanned_page.number}"
                    if scanned_page.number
                    else scanned_page.file.name,
                    page.reason,
                )
            )


def _write_missing(
    table: TableFile, book: ScanBook, combined: Gathered, papers: Papers, printed: Mapping[str, PrintedPaper]
) -> None:
    for paper, missing in combined.missing:
        owner, numbers = combined.whose[paper.code], ", ".join(map(str, missing))
        row = {
            "student": owner,
            "paper": paper.code,
            "pages": paper.pages,
            "scanned": paper.pages - len(missing),
            "missing": numbers,
        }
        table.write(row)
        book.missing.append(f"{owner}: page {numbers} of {paper.pages}")
    met = {_sheet(papers.papers[code]) for code in printed}
    absent = {
        _sheet(paper): code for code, paper in reversed(papers.papers.items()) if _sheet(paper) not in met
    }
    for (student, *_), code in reversed(absent.items()):
        if student:
            table.write({"student": student, "paper": code, "pages": "", "scanned": 0, "missing": _ALL})
            book.absent += 1


def incomplete_papers(out: Path) -> list[str]:
    """Return the students of papers that were scanned without one of their pages, as the folder of a scan
    states them.

    Raises
    ------
    BadInput
        The file cannot be read, or is not as ``scan`` wrote it.
    """
    path = out / _MISSING
    rows = read_rows(path, MISSING_COLUMNS, MISSING_COLUMNS) if path.exists() else ()
    return [row["student"] for row in rows if row["missing"] != _ALL]


def _sheet(paper: AnswerPaper) -> tuple[str, int, tuple[tuple[str, int], ...]]:
    """Return the identity of a paper, whatever its printed size."""
    return paper.student, paper.sitting, tuple((str(r["exercise"]), int(r["seed"])) for r in paper.records)


def _cut(out: Path, name: str, field_: ScannedField, index: int) -> str:
    """Return the file of a field's picture; cut it now if it does not exist. For a page that is not flat, the
    picture of the whole page."""
    if field_.crop:
        return field_.crop
    page = stored_page(out, name)
    if page is None or not page.is_straight:
        return picture_of(name)
    file = crop_of(name, index)
    if not (out / file).is_file():
        write_whole(out / file, cut((out / picture_of(name)).read_bytes(), field_))
    return file


__all__ = ["ANSWER_COLUMNS", "ScanBook", "put_page", "scan", "write_read"]
