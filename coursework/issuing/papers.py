"""Files of an assignment: one paper per student in every format, and solutions and the key for the staff."""

from __future__ import annotations

import datetime
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from coursework.issuing.answer_papers import printed_handouts
from coursework.issuing.assignment import Assignment, text_in
from coursework.issuing.booklets import Pages
from coursework.issuing.identity import printed_columns
from coursework.issuing.issuing import Issue
from coursework.issuing.students import folded
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.rendering.renderer import Renderer
from coursework.sheets.paper import Paper, PaperHeading, SolutionPaper

Rendering = Callable[[Any], str | bytes | None]
_DIGITS = 18  #: of a number by which a booklet is sorted; a longer one is sorted as a word


@dataclass(frozen=True)
class IssuedPaper:
    """Paper: the exercises of one student and sitting, in the assignment's order."""

    assignment: Assignment
    issues: tuple[Issue, ...]
    polygons: bool
    scan: str = ""  #: the size of its answer pages; empty if students answer on the paper itself

    @property
    def first(self) -> Issue:
        return self.issues[0]

    @property
    def _columns(self) -> dict[str, str]:
        """Return the student's cells of the roster, by the folded title of the column."""
        return {folded(title): value for title, value in self.first.columns.items()}

    @property
    def sorted_by(self) -> tuple[tuple[int, int, str], ...]:
        """Return the sort key of the paper in a booklet: by words and by numbers, group 10 after group 2."""
        pieces = re.findall(r"\d+|\D+", self._columns.get(folded(self.assignment.sort), ""))
        return tuple(
            (0, int(p), "") if p.isdecimal() and len(p) <= _DIGITS else (1, 0, folded(p)) for p in pieces
        )

    def heading(self, lang: str) -> PaperHeading:
        assignment, first, columns = self.assignment, self.first, self._columns
        mark = assignment.mark
        return PaperHeading(
            lang=lang,
            title=text_in(assignment.title, lang) or assignment.name,
            course=text_in(assignment.course, lang) or first.variant.exercise.folder.title(lang),
            student=first.student,
            identity=printed_columns(assignment.identity, columns, lang),
            date=date_text(assignment.date, lang),
            duration=text_in(assignment.duration, lang),
            instructions=text_in(assignment.instructions, lang),
            version=first.version,
            logo=assignment.picture(lang),
            cover=assignment.cover,
            mark_of="" if mark is None else localise(plain(mark.of), lang),
        )

    def paper(self, lang: str) -> Paper:
        handouts = (i.variant.in_language(lang).handout(i.student) for i in self.issues)
        return Paper(self.heading(lang), tuple(handouts))

    def printed(self, lang: str) -> Paper:
        """Return the paper as printed in the PDF, with its answer pages if it is scanned."""
        handouts = printed_handouts(self.issues, lang, self.scan, self.assignment.name)
        return Paper(self.heading(lang), handouts)

    def solution(self, lang: str) -> SolutionPaper:
        sheets = (
            i.variant.in_language(lang).answer_sheet(i.student, polygons=self.polygons) for i in self.issues
        )
        return SolutionPaper(self.heading(lang), tuple(sheets))

    @property
    def folder(self) -> str:
        """Folder of its files among those of the build."""
        return ""

    @property
    def cells(self) -> dict[str, object]:
        """Cells of its line in the table of a booklet's pages."""
        return {"student": self.first.student, "version": self.first.version}

    @property
    def drawing_numbers(self) -> tuple[str, ...]:
        """Ends of the names of its exercises' drawings, for LaTeX."""
        return tuple(f"-{number}" for number in range(1, len(self.issues) + 1))

    def renders(self, renderer: Renderer) -> tuple[Rendering, Rendering, Rendering]:
        """Return the functions that make PDF, page and notebook of it."""
        return renderer.paper_pdf, renderer.paper_html, renderer.paper_notebook

    def tex(self, renderer: Renderer, figures: Sequence[str], polygons: Sequence[str]) -> Rendering:
        """Return the function that makes its LaTeX source."""
        return partial(renderer.paper_tex, figures=figures, polygons=polygons)

    def binds(self, renderer: Renderer) -> Callable[[list[Any]], tuple[bytes, Pages]]:
        """Return the function that makes one PDF of several papers."""
        return renderer.papers_pdf


class IssuedSheet(IssuedPaper):
    """Paper of one exercise that is handed out alone, without a heading of its own."""

    @property
    def folder(self) -> str:
        return self.first.variant.exercise.name

    @property
    def cells(self) -> dict[str, object]:
        return {"student": self.first.student, "exercise": self.folder, "seed": self.first.variant.seed}

    @property
    def drawing_numbers(self) -> tuple[str, ...]:
        return ("",)

    @property
    def sorted_by(self) -> tuple[tuple[int, int, str], ...]:
        return ()

    def paper(self, lang: str) -> Any:
        return self.first.variant.in_language(lang).handout(self.first.student)

    def printed(self, lang: str) -> Any:
        return printed_handouts(self.issues, lang, self.scan)[0]

    def solution(self, lang: str) -> Any:
        variant = self.first.variant.in_language(lang)
        return variant.answer_sheet(self.first.student, polygons=self.polygons)

    def renders(self, renderer: Renderer) -> tuple[Rendering, Rendering, Rendering]:
        return renderer.pdf, renderer.html, renderer.notebook

    def tex(self, renderer: Renderer, figures: Sequence[str], polygons: Sequence[str]) -> Rendering:
        return partial(renderer.tex, figure=figures[0], polygons=polygons[0])

    def binds(self, renderer: Renderer) -> Callable[[list[Any]], tuple[bytes, Pages]]:
        return renderer.booklet


def papers(
    assignment: Assignment | None, issues: Sequence[Issue], *, polygons: bool, scan: str = ""
) -> list[IssuedPaper]:
    """Return the issued variants grouped by paper, each alone without an assignment; ``scan`` is the size of
    the answer pages."""
    if assignment is None:
        nameless = Assignment("", ())
        return [IssuedSheet(nameless, (issue,), polygons, scan) for issue in issues]
    by_stem: dict[tuple[str, int], list[Issue]] = {}
    for issue in issues:
        by_stem.setdefault((issue.stem, issue.sitting), []).append(issue)
    return [
        IssuedPaper(assignment, tuple(issues_of_paper), polygons, scan)
        for issues_of_paper in by_stem.values()
    ]


def date_text(date: datetime.date | None, lang: str) -> str:
    """Return a date in a language, ``4 décembre 2026``; "" for None."""
    if date is None:
        return ""
    texts = words(lang)["date"]
    return str(texts["form"]).format(day=date.day, month=texts["months"][date.month - 1], year=date.year)
