"""Reading of the pages of one file, in one of several processes."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from coursework.course.course import Course, opened
from coursework.course.variant import Variant
from coursework.errors import CourseworkError
from coursework.issuing.answer_papers import answer_papers
from coursework.issuing.issued import Issued
from coursework.issuing.questions import PaperQuestions
from coursework.messages import Message, as_message
from coursework.parsing.scanned import crop_of, picture_of
from coursework.scanning.scan_store import (
    ANSWERS,
    BLANK,
    LOST,
    OTHER_NAME,
    REFUSED,
    SCALE,
    STATEMENT,
    PageScan,
    ScannedField,
    look_of,
    page_id,
    put_page,
)
from coursework.sheets.answer_pages import AnswerField, AnswerPage

_BARE = 0.0002  #: share of dark pixels below which a page is blank: less than a code and four marks have
_PAPER = 90  #: of 255: paper of a blank page is lighter
_HIGHEST = 2376  #: pixels of a picture that is kept of a page that is not straight
_QUALITY = 60  #: of a JPEG
_LAID_OUT = 400  #: papers that are kept laid out

OTHER_SHEET = Message("a sheet of something else that was issued")

#: By what :func:`coursework.scanning.pages.read_page` finds: what the page is, and the message about it.
_FOUND = {
    "no code": (LOST, Message("no code of a page was found, or it cannot be read")),
    "no sheet": (REFUSED, Message("its code is not that of a sheet")),
    "two pages": (REFUSED, Message("two sheets on one picture: scan them one by one")),
    "other assignment": (REFUSED, OTHER_SHEET),
    "statement": (STATEMENT, ""),
}


class Desk(NamedTuple):
    """With what pages are read."""

    root: str  #: of the course's folder
    issued: str  #: path of the ``issued.json``
    stamp: str  #: its digest: another file is read anew
    out: str
    least: float


class PageRange(NamedTuple):
    """Some pages of one file."""

    path: str
    digest: str
    first: int
    last: int


class Papers(Mapping[str, Sequence[AnswerPage]]):
    """The answer pages of each paper by its code, laid out when they are asked for."""

    def __init__(self, course: Course[Any], issued: Mapping[str, Any]):
        self.course, self.papers, self._issued = course, answer_papers(issued), issued
        self._laid_out = lru_cache(_LAID_OUT)(self._pages)
        self.variant = lru_cache(8 * _LAID_OUT)(self._variant)

    @cached_property
    def questions(self) -> PaperQuestions:
        """Questions of the papers, with their numbers."""
        return PaperQuestions.of(self.course, Issued(self._issued, "what was issued"))

    @cached_property
    def students(self) -> tuple[str, ...]:
        """Students with a paper."""
        return tuple(sorted({paper.student for paper in self.papers.values() if paper.student}))

    def _pages(self, code: str) -> tuple[AnswerPage, ...]:
        paper = self.papers[code]
        return paper.pages(self.course, str(paper.records[0].get("lang", "en")))

    def __getitem__(self, code: str) -> Sequence[AnswerPage]:
        return self._laid_out(code)

    def __iter__(self) -> Iterator[str]:
        return iter(self.papers)

    def __len__(self) -> int:
        return len(self.papers)

    def _variant(self, code: str, index: int) -> Variant:
        """Return the variant of an exercise of a paper."""
        record = self.papers[code].records[index]
        return self.course[record["exercise"]].from_record(record)


@lru_cache(1)
def _papers(root: str, issued: str, stamp: str) -> Papers:
    return Papers(opened(root, Variant), json.loads(Path(issued).read_bytes()))


def count_pages(path: str) -> tuple[int, str]:
    """Return the number of pages of a file; 0 and the reason if it cannot be read."""
    from coursework.scanning.pictures import page_count

    try:
        return page_count(Path(path)), ""
    except CourseworkError as fault:
        return 0, str(fault)


def read_pages(desk: Desk, pages: PageRange) -> int:
    """Read pages of a file and keep what they say; gives how many."""
    papers = _papers(desk.root, desk.issued, desk.stamp)
    for number in range(pages.first, pages.last + 1):
        name = page_id(pages.digest, number)
        page, pictures = _read(Path(pages.path), number, name, papers, desk.least)
        put_page(Path(desk.out), name, page, pictures)
    return pages.last + 1 - pages.first


def _read(
    path: Path, number: int, name: str, papers: Papers, least: float
) -> tuple[PageScan, dict[str, bytes]]:
    """Return the result of a page, and its pictures by their files."""
    from coursework.scanning.digits import read_digits
    from coursework.scanning.pages import read_page
    from coursework.scanning.pictures import opencv, picture_at

    try:
        picture = picture_at(path, number)
    except CourseworkError as fault:
        return PageScan(REFUSED, as_message(fault), has_picture=False, least=least), {}
    try:
        page_read = read_page(picture, papers, read_digits, least)
    except opencv().error as fault:  # one picture does not stop a pile: a person looks at it
        reason: str = Message("reading it failed: {problem}", problem=str(fault.err or fault)[:100])
        return PageScan(LOST, reason, least=least), {picture_of(name): _jpeg(picture.grey, _HIGHEST)}
    if page_read.found == "no code" and _is_bare(picture.grey):
        return PageScan(BLANK, least=least), {picture_of(name): _jpeg(picture.grey, 600)}
    if page_read.page is None or page_read.found == "statement":
        state, reason = _FOUND.get(page_read.found, (LOST, page_read.found))
        return PageScan(state, reason, _code(page_read.code), least=least), {
            picture_of(name): _jpeg(page_read.grey, _HIGHEST)
        }
    code = _code(page_read.code)
    if not page_read.fields:  # known, but it could not be laid flat
        return typed_page(papers, code, page_read.page.number, least), {
            picture_of(name): _jpeg(page_read.grey, _HIGHEST)
        }
    pictures = {picture_of(name): _jpeg(page_read.grey, round(page_read.page.height * SCALE))}
    if _is_of_another(page_read.grey, page_read.page, papers, code):
        return PageScan(LOST, OTHER_NAME, least=least), pictures
    fields = []
    for index, field in enumerate(page_read.fields):
        crop = ""
        if field.crop is not None:
            crop = crop_of(name, index)
            pictures[crop] = _png(field.crop)
        text = _text(field.field, field.text, field.cases, papers, code)
        scanned = _scanned_field(field.field, text, float(field.confidence), field.waits, crop)
        candidates = tuple((text, round(chance, 6)) for text, chance in field.candidates)
        fields.append(replace(scanned, candidates=candidates))
    look = look_of(page_read.grey)
    return PageScan(
        ANSWERS, "", code, page_read.page.number, tuple(fields), True, least=least, look=look
    ), pictures


def _is_of_another(grey: np.ndarray, page: AnswerPage, papers: Papers, code: str) -> bool:
    """Return True if the name printed on a page is that of another student than the paper's."""
    from coursework.scanning.names import other_name

    paper = papers.papers[code]
    lang = str(paper.records[0].get("lang", "en"))
    folders = papers.course.folder.template_folders
    return bool(other_name(grey, page.name, paper.student, papers.students, lang, folders))


def _code(text: str) -> str:
    """Return the code of the paper from the text of a QR code."""
    pieces = text.split(" ")
    return pieces[1] if len(pieces) == 3 else ""


def _text(field: AnswerField, text: str, cases: Sequence[str], papers: Papers, code: str) -> str:
    """Return a reading in the form in which students write it."""
    if field.what != "ticks" or not cases:
        return text
    variant = papers.variant(code, field.place)
    part = next(p for p in variant.parts if p.id == field.part)
    return part.sort.from_paper(cases, part, variant)


def _scanned_field(field: AnswerField, text: str, confidence: float, waits: str, crop: str) -> ScannedField:
    box = field.whole
    return ScannedField(
        field.exercise,
        field.seed,
        field.part,
        field.coordinate,
        field.coordinates,
        field.what,
        text,
        round(confidence, 4),
        waits,
        crop,
        (box.x, box.y, box.width, box.height),
    )


def typed_page(papers: Papers, code: str, number: int, least: float) -> PageScan:
    """Return a page that a person types as a whole: it is identified, and nothing of it could be read."""
    page = papers[code][number - 1]
    fields = tuple(_scanned_field(field, "", 0.0, "page", "") for field in page.fields if field.part)
    return PageScan(ANSWERS, "not straight", code, number, fields, least=least)


# --------------------------------------------------------------------- pictures


def _is_bare(grey: np.ndarray) -> bool:
    """Return True if a picture shows blank paper; a picture that is dark all over shows no paper."""
    inner = grey[
        grey.shape[0] // 40 : -(grey.shape[0] // 40) or None,
        grey.shape[1] // 40 : -(grey.shape[1] // 40) or None,
    ]
    paper = np.median(inner)
    return bool(paper > _PAPER and (inner < paper - 60).mean() < _BARE)


def _jpeg(grey: np.ndarray, height: int) -> bytes:
    """Return a picture as JPEG, of a limited height in pixels."""
    from coursework.scanning.pictures import opencv

    cv2 = opencv()
    scale = min(1.0, height / max(grey.shape[0], 1))
    size = (max(1, round(grey.shape[1] * scale)), max(1, round(grey.shape[0] * scale)))
    smaller = cv2.resize(grey, size, interpolation=cv2.INTER_AREA) if scale < 1 else grey
    return bytes(cv2.imencode(".jpg", smaller, [cv2.IMWRITE_JPEG_QUALITY, _QUALITY])[1])


def _png(grey: np.ndarray) -> bytes:
    """Return a crop as PNG in 16 levels of grey: enough for pencil, and half the size."""
    from coursework.scanning.pictures import opencv

    cv2 = opencv()
    levels = (np.minimum(grey.astype(np.uint16) + 8, 255) // 17 * 17).astype(np.uint8)
    return bytes(cv2.imencode(".png", levels, [cv2.IMWRITE_PNG_COMPRESSION, 9])[1])


def cut(picture: bytes, field: ScannedField) -> bytes:
    """Return a field cut from the stored picture of its page, which is flattened, with a margin."""
    from coursework.scanning.pictures import opencv

    cv2 = opencv()
    page = cv2.imdecode(np.frombuffer(picture, np.uint8), cv2.IMREAD_GRAYSCALE)
    x, y, width, height = field.box
    top, left = (max(0, round((v - 2.0) * SCALE)) for v in (y, x))
    return _png(page[top : round((y + height + 2.0) * SCALE), left : round((x + width + 2.0) * SCALE)])
