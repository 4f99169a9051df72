"""Papers with answer pages: their exercises, from the record of issued variants, and the code that identifies
them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from coursework.issuing.issued import codes_shown, items_of_papers
from coursework.sheets.answer_pages import SIZES, AnswerPage, answer_pages, paper_code

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.course.variant import Variant
    from coursework.issuing.issuing import Issue
    from coursework.sheets.sheet import Handout


@dataclass(frozen=True)
class AnswerPaper:
    """Answer pages of one student and sitting, or of one exercise that was handed out alone."""

    assignment: str  #: its name; empty for single exercises
    student: str  #: as it stands on the paper; empty for a paper without a name
    sitting: int
    records: tuple[Mapping[str, Any], ...]
    size: str  #: of the paper, a4 or letter
    owner: str = ""  #: the student, where the paper bears another name

    @property
    def code(self) -> str:
        return paper_code(self.assignment, self.owner or self.student, self.sitting, self.records, self.size)

    def variants(self, course: Course[Any]) -> tuple[Variant, ...]:
        """Return the exercises of the paper, in order.

        Raises
        ------
        BadInput
            A record no longer fits the course.
        """
        return tuple(course[record["exercise"]].from_record(record) for record in self.records)

    def pages(self, course: Course[Any], lang: str = "en") -> tuple[AnswerPage, ...]:
        """Return the pages as printed; ``lang`` is the language of the units on them and does not change the
        layout."""
        return answer_pages(self.variants(course), lang, self.size, self.code, alone=not self.assignment)


def answer_papers(issued: Mapping[str, Any]) -> dict[str, AnswerPaper]:
    """Return the papers of an ``issued.json`` by their codes, for every paper size that they may have been
    printed on."""
    papers = (paper for size in SIZES for paper in _papers(issued, size))
    return {paper.code: paper for paper in papers}


def _papers(issued: Mapping[str, Any], size: str) -> Iterator[AnswerPaper]:
    name, codes = str((issued.get("assignment") or {}).get("name", "")), codes_shown(issued)
    for items in items_of_papers(issued):
        student, sitting = _owner_of(items[0])
        shown, records = codes.get(student, student), tuple(item["record"] for item in items)
        yield AnswerPaper(name, shown, sitting, records, size, student)


def _owner_of(item: Mapping[str, Any]) -> tuple[str, int]:
    return str(item.get("student", "")), int(item.get("sitting", 1))


def printed_handouts(
    issues: Sequence[Issue], lang: str, size: str = "", assignment: str = ""
) -> tuple[Handout, ...]:
    """Return the handouts of one paper as printed; with a ``size``, they have separate answer pages."""
    variants = [issue.variant.in_language(lang) for issue in issues]
    handouts = tuple(variant.handout(issues[0].shown) for variant in variants)
    if not size:
        return handouts
    records = tuple(issue.variant.record for issue in issues)
    code = paper_code(assignment, issues[0].student, issues[0].sitting, records, size)
    pages = answer_pages(variants, lang, size, code, alone=not assignment)
    return tuple(replace(handout, answer_pages=pages) for handout in handouts)
