"""Papers with answer pages: what belongs on one, told from what was issued, and by which code it is known again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from coursework.sheets.answer_pages import SIZES, AnswerPage, answer_pages, paper_code

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.course.variant import Variant
    from coursework.making.issuing import Issue
    from coursework.sheets.sheet import Handout


@dataclass(frozen=True)
class AnswerPaper:
    """The answer pages of one student and sitting, or of one exercise that was handed out by itself."""

    assignment: str  #: its name; empty for exercises by themselves
    student: str  #: empty where it is nobody's
    sitting: int
    records: tuple[Mapping[str, Any], ...]
    size: str  #: of the paper, a4 or letter

    @property
    def code(self) -> str:
        return paper_code(self.assignment, self.student, self.sitting, self.records, self.size)

    def variants(self, course: Course[Any]) -> tuple[Variant, ...]:
        """The exercises of the paper, in order.

        Raises
        ------
        BadInput
            A record fits the course no more.
        """
        return tuple(course[record["exercise"]].from_record(record) for record in self.records)

    def pages(self, course: Course[Any], lang: str = "en") -> tuple[AnswerPage, ...]:
        """The pages as they were printed; ``lang`` is that of the units on them, and moves nothing."""
        return answer_pages(self.variants(course), lang, self.size, self.code)


def answer_papers(issued: Mapping[str, Any]) -> dict[str, AnswerPaper]:
    """The papers of an ``issued.json`` by their codes, on every size of paper that they may have been printed on."""
    papers = (paper for size in SIZES for paper in _papers(issued, size))
    return {paper.code: paper for paper in papers}


def _papers(issued: Mapping[str, Any], size: str) -> Iterator[AnswerPaper]:
    assignment = issued.get("assignment")
    if assignment is None:
        for item in issued["issued"]:
            yield AnswerPaper("", *_whose(item), (item["record"],), size)
        return
    together: dict[tuple[str, int, int], list[Mapping[str, Any]]] = {}
    for number, item in enumerate(issued["issued"]):
        student, sitting = _whose(item)
        # Papers of nobody stand one after the other, as many exercises each as the assignment has.
        nobody = -1 if student else number // max(1, len(assignment["exercises"]))
        together.setdefault((student, sitting, nobody), []).append(item["record"])
    for (student, sitting, _), records in together.items():
        yield AnswerPaper(str(assignment["name"]), student, sitting, tuple(records), size)


def _whose(item: Mapping[str, Any]) -> tuple[str, int]:
    return str(item.get("student", "")), int(item.get("sitting", 1))


def printed_handouts(
    issues: Sequence[Issue], lang: str, size: str = "", assignment: str = ""
) -> tuple[Handout, ...]:
    """The handouts of one paper as they are printed: to be answered on pages of their own, where these have a ``size``."""
    variants = [issue.variant.in_language(lang) for issue in issues]
    handouts = tuple(variant.handout(issues[0].student) for variant in variants)
    if not size:
        return handouts
    records = tuple(issue.variant.record for issue in issues)
    code = paper_code(assignment, issues[0].student, issues[0].sitting, records, size)
    pages = answer_pages(variants, lang, size, code)
    return tuple(replace(handout, answer_pages=pages) for handout in handouts)


def printed_handout(issue: Issue, lang: str, size: str = "") -> Handout:
    """The same of an exercise that is handed out by itself."""
    return printed_handouts((issue,), lang, size)[0]
