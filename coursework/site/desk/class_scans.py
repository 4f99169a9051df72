"""Scans of an assignment: the answers on all pages together, the cards that wait for a person, and the
submission."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from coursework.database.assignments import issued_content
from coursework.database.marking import mark_new
from coursework.database.scans import pages_scanned, typed_texts
from coursework.database.submissions import insert_submission, is_current
from coursework.gradebook.rows import AnswerRow
from coursework.messages import Message, localised
from coursework.parsing.scanned import scan_reference
from coursework.scanning.gathering import AnswerCard, Gathered, ScannedAnswer
from coursework.scanning.page_reading import Papers
from coursework.scanning.parts import Joins
from coursework.scanning.queue import ScanQueue
from coursework.scanning.scan import LEAST, as_typed, papers_asked, together
from coursework.scanning.scan_store import (
    REFUSED,
    PageScan,
    Scanned,
    ScannedFile,
    page_of,
    with_copies,
)
from coursework.scanning.typed import Typed
from coursework.site.frame.settings import Site

SOURCE = "scans"  #: source of the submission; the next submission of scans replaces it
_GONE = PageScan(REFUSED, Message("read by another version: send its file again"), has_picture=False)


@dataclass(frozen=True)
class ClassScans:
    """Scanned pages of an assignment, and the answers that people typed."""

    papers: Papers
    pages: tuple[Scanned, ...]
    typed: tuple[Typed, ...]

    @cached_property
    def expected(self) -> Any:
        return papers_asked(self.papers, self.pages)

    @cached_property
    def gathered(self) -> Gathered:
        return together(self.papers, self.expected, self.pages, self.typed)

    @cached_property
    def queue(self) -> ScanQueue:
        return ScanQueue(self.papers, self.expected, self.gathered, Joins(self.papers, self.expected), Path())

    @property
    def cards(self) -> Sequence[AnswerCard]:
        return self.queue.cards

    @property
    def rejected(self) -> list[Scanned]:
        return [page for page in self.pages if page.page.what == REFUSED]

    def reason(self, page: Scanned) -> str:
        """Return the reason of a rejection, in the language of the current messages."""
        return localised(page.page.reason)

    @property
    def counts(self) -> dict[str, int]:
        """Number of pages of each kind."""
        totals: dict[str, int] = {}
        for page in self.pages:
            if page.number and not page.is_copy:
                totals[page.page.what] = totals.get(page.page.what, 0) + 1
        return totals

    @property
    def answers(self) -> list[ScannedAnswer]:
        """Answers on papers whose student is known."""
        return self._of_students(self.gathered.answers)

    @cached_property
    def rows(self) -> list[AnswerRow]:
        """Rows of a submission: the answers, and references to the pictures of those that wait."""
        return [
            AnswerRow(
                answer.student,
                answer.exercise,
                str(answer.seed),
                answer.part,
                "; ".join(scan_reference(s.page, s.index) for s in answer.pictures) or answer.answer,
                self._source(answer),
            )
            for answer in self._of_students(self.gathered.to_mark)
        ]

    def _of_students(self, answers: Iterable[ScannedAnswer]) -> list[ScannedAnswer]:
        return [answer for answer in answers if answer.student not in self.papers.papers]

    def _source(self, answer: ScannedAnswer) -> str:
        there = (self.by_id[name] for name in answer.pages if name in self.by_id)
        return "; ".join(f"{page.file.name} p. {page.number}" for page in there)

    @cached_property
    def by_id(self) -> dict[str, Scanned]:
        return {page.id: page for page in self.pages}


def class_scans(site: Site, number: int) -> ClassScans:
    """Return the scans of an assignment."""
    with site.store.reading() as connection:
        content = issued_content(connection, number)
        rows = pages_scanned(connection, number)
        typed = tuple(typed_texts(connection, number))
    papers = site.cache.get(
        ("papers that are scanned", number, _stamp(content)), lambda: Papers(site.course, content)
    )
    pages = with_copies(
        as_typed(
            Scanned(
                ScannedFile(row.file, row.page.partition("-")[0], 0),
                row.number,
                row.page,
                page_of(row.reading) or _GONE,
            ),
            papers,
            typed,
            LEAST,
        )
        for row in rows
    )
    return ClassScans(papers, tuple(pages), typed)


def _stamp(content: dict[str, Any]) -> int:
    """Return a hash that changes when other records are issued to a student."""
    return hash(
        tuple(
            (str(i.get("student")), i["record"]["exercise"], str(i["record"]["seed"]))
            for i in content["issued"]
        )
    )


def hand_over(site: Site, number: int, now: ClassScans) -> int:
    """Submit and mark the answers read so far, in place of those of earlier scans; return their number.

    Answers that wait are submitted as their pictures: they wait for a person, and marks are provisional.
    """
    if not is_handed_over(site, number, now):
        at = site.clock()
        with site.store.begin() as connection:
            insert_submission(connection, number, now.rows, source=SOURCE, received_at=at, replaces=True)
        mark_new(site.course, site.store, number)
    return len(now.answers)


def is_handed_over(site: Site, number: int, now: ClassScans) -> bool:
    """Return True if what is read so far is what the last submission of scans states."""
    with site.store.reading() as connection:
        return is_current(connection, number, now.rows, SOURCE)
