"""Files of an assignment: one paper per student in every format, and solutions and the key for the staff."""

from __future__ import annotations

import datetime
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from coursework.course.course import Course
from coursework.course.secrecy import Secret
from coursework.issuing import booklets
from coursework.issuing.answer_papers import printed_handouts
from coursework.issuing.assignment import Assignment, text_in
from coursework.issuing.booklets import Booklet
from coursework.issuing.build import rendered, tables, tex_stem
from coursework.issuing.identity import printed_columns
from coursework.issuing.issuing import Issue
from coursework.issuing.students import folded
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.sheets.paper import Paper, PaperHeading, SolutionPaper
from coursework.sheets.sheet import AnswerSheet, Handout
from coursework.system.tables import SPREADSHEETS, Spreadsheet
from coursework.system.writing import File

_DIGITS = 18  #: of a number by which a booklet is sorted; a longer one is sorted as a word
PAGE_COLUMNS = ("student", "version", "lang", "first page", "last page", "file")


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


def date_text(date: datetime.date | None, lang: str) -> str:
    """Return a date in a language, ``4 décembre 2026``; "" for None."""
    if date is None:
        return ""
    texts = words(lang)["date"]
    return str(texts["form"]).format(day=date.day, month=texts["months"][date.month - 1], year=date.year)


def papers(
    assignment: Assignment, issues: Sequence[Issue], *, polygons: bool, scan: str = ""
) -> list[IssuedPaper]:
    """Return the issued variants grouped by paper; ``scan`` is the size of the answer pages."""
    by_stem: dict[tuple[str, int], list[Issue]] = {}
    for issue in issues:
        by_stem.setdefault((issue.stem, issue.sitting), []).append(issue)
    return [
        IssuedPaper(assignment, tuple(issues_of_paper), polygons, scan)
        for issues_of_paper in by_stem.values()
    ]


def files(
    course: Course[Any],
    assignment: Assignment,
    issues: Sequence[Issue],
    formats: Sequence[str],
    *,
    paper: str = "a4",
    booklet: bool = False,
    polygons: bool = True,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    only: Collection[str] | None = None,
    scan: bool = False,
    secret: Secret | None = None,
) -> Iterator[File]:
    """Yield every file of an assignment, in order.

    Parameters
    ----------
    course, assignment, issues
        The issued variants, with their course and assignment.
    formats
        Formats of the papers.
    paper
        ``a4`` or ``letter``.
    booklet
        Add a PDF of all papers.
    polygons
        Draw the velocity and acceleration polygons in the worked solutions.
    spreadsheet
        Spreadsheet that opens the tables.
    only
        Students whose papers alone are written, without tables.
    scan
        Add answer pages for a scanner to the PDFs.
    secret
        Secret to store in ``issued.json``.
    """
    renderer = renderer_of(course.folder).on(paper)
    issued_papers = papers(assignment, issues, polygons=polygons, scan=paper if scan else "")
    for issued_paper in issued_papers:
        if only is None or issued_paper.first.student in only:
            for lang in issued_paper.first.langs:
                yield from _paper(course, renderer, issued_paper, lang, formats)
    if only is not None:
        return
    if booklet:
        yield from booklets.bound(course, _booklets(renderer, issued_papers), PAGE_COLUMNS, spreadsheet)
    yield from tables(course, issues, assignment, spreadsheet, secret)


def _paper(
    course: Course[Any], renderer: Renderer, issued_paper: IssuedPaper, lang: str, formats: Sequence[str]
) -> Iterator[File]:
    for_student = Path("handouts") / f"{issued_paper.first.stem}.{lang}"
    for_staff = Path("instructor") / f"{issued_paper.first.stem}.{lang}"
    paper, solution = partial(issued_paper.paper, lang), partial(issued_paper.solution, lang)
    if "pdf" in formats:
        yield rendered(for_student, ".pdf", renderer.paper_pdf, partial(issued_paper.printed, lang))
    if "html" in formats:
        yield rendered(for_student, ".html", renderer.paper_html, paper)
    if "ipynb" in formats:
        yield rendered(for_student, ".ipynb", renderer.paper_notebook, paper)
    if "tex" in formats:
        yield from _tex(renderer, issued_paper, lang, for_student, solved=False)
    if "pdf" in formats:
        yield rendered(for_staff, ".solution.pdf", renderer.paper_pdf, solution)
    if "html" in formats:
        yield rendered(for_staff, ".solution.html", renderer.paper_html, solution)
    if "tex" in formats:
        yield from _tex(renderer, issued_paper, lang, for_staff, solved=True)


def _tex(
    renderer: Renderer, issued_paper: IssuedPaper, lang: str, path: Path, *, solved: bool
) -> Iterator[File]:
    """Yield a LaTeX source and the drawings of each exercise."""
    stem, places = tex_stem(path), range(1, len(issued_paper.issues) + 1)
    figures = [f"{stem}-{'solution-figure' if solved else 'figure'}-{number}.pdf" for number in places]
    polygons = [f"{stem}-polygons-{number}.pdf" for number in places]
    source = partial(renderer.paper_tex, figures=figures, polygons=polygons)
    yield rendered(
        path,
        ".solution.tex" if solved else ".tex",
        source,
        partial(issued_paper.solution if solved else issued_paper.paper, lang),
    )
    for issue, figure, drawn in zip(issued_paper.issues, figures, polygons, strict=True):
        variant = issue.variant.in_language(lang)
        sheet: Callable[[], Handout | AnswerSheet] = (
            partial(variant.answer_sheet, issue.student, polygons=issued_paper.polygons)
            if solved
            else partial(variant.handout, issue.student)
        )
        yield rendered(path.with_name(figure), "", renderer.figure_pdf, sheet)
        if solved and issued_paper.polygons and variant.exercise.solution.polygons is not None:
            yield rendered(path.with_name(drawn), "", renderer.polygons_pdf, sheet)


# --------------------------------------------------------------------- booklets


def _booklets(renderer: Renderer, issued_papers: Sequence[IssuedPaper]) -> Iterator[Booklet]:
    """Yield the booklets of all papers of a language, sorted as the assignment says."""
    issued_papers = sorted(issued_papers, key=lambda issued_paper: issued_paper.sorted_by)
    for lang in dict.fromkeys(lang for issued_paper in issued_papers for lang in issued_paper.first.langs):
        group = [issued_paper for issued_paper in issued_papers if lang in issued_paper.first.langs]
        for name, part in booklets.parted(f"class.{lang}", group):
            yield _of_papers(renderer, name, part, lang)


def _of_papers(renderer: Renderer, name: str, papers: Sequence[IssuedPaper], lang: str) -> Booklet:
    return Booklet(
        name,
        lambda: renderer.papers_pdf([issued_paper.printed(lang) for issued_paper in papers]),
        lambda: renderer.papers_pdf([issued_paper.solution(lang) for issued_paper in papers])[0],
        [
            {"student": issued_paper.first.student, "version": issued_paper.first.version, "lang": lang}
            for issued_paper in papers
        ],
    )
