"""The files of an assignment: one paper a student, in every format; solutions and the key for the staff."""

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
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.making import booklets
from coursework.making.answer_papers import printed_handouts
from coursework.making.assignment import Assignment, text_in
from coursework.making.booklets import Booklet
from coursework.making.build import rendered, tables, tex_stem
from coursework.making.identity import printed_columns
from coursework.making.issuing import Issue
from coursework.making.students import folded
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.sheets.paper import Heading, Paper, SolutionPaper
from coursework.sheets.sheet import AnswerSheet, Handout
from coursework.system.tables import SPREADSHEETS, Spreadsheet
from coursework.system.writing import File

_DIGITS = 18  #: of a number by which a booklet is sorted; what is longer is sorted as a word
PAGE_COLUMNS = ("student", "version", "lang", "first page", "last page", "file")


@dataclass(frozen=True)
class IssuedPaper:
    """One paper: the exercises of one student and sitting, in the assignment's order."""

    assignment: Assignment
    issues: tuple[Issue, ...]
    polygons: bool
    scan: str = ""  #: the size of its answer pages; none where it is answered between its lines

    @property
    def first(self) -> Issue:
        return self.issues[0]

    @property
    def _columns(self) -> dict[str, str]:
        """What the roster says of the student, by the folded title of the column."""
        return {folded(title): value for title, value in self.first.columns.items()}

    @property
    def sorted_by(self) -> tuple[tuple[int, int, str], ...]:
        """Where the paper stands in a booklet: by words and by numbers, group 10 after group 2."""
        pieces = re.findall(r"\d+|\D+", self._columns.get(folded(self.assignment.sort), ""))
        return tuple(
            (0, int(p), "") if p.isdecimal() and len(p) <= _DIGITS else (1, 0, folded(p)) for p in pieces
        )

    def heading(self, lang: str) -> Heading:
        assignment, first, own = self.assignment, self.first, self._columns
        mark = assignment.mark
        return Heading(
            lang=lang,
            title=text_in(assignment.title, lang) or assignment.name,
            course=text_in(assignment.course, lang) or first.variant.exercise.folder.title(lang),
            student=first.student,
            identity=printed_columns(assignment.identity, own, lang),
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
        """The paper as a PDF has it, with its answer pages where it is scanned."""
        handouts = printed_handouts(self.issues, lang, self.scan, self.assignment.name)
        return Paper(self.heading(lang), handouts)

    def solution(self, lang: str) -> SolutionPaper:
        sheets = (
            i.variant.in_language(lang).answer_sheet(i.student, polygons=self.polygons) for i in self.issues
        )
        return SolutionPaper(self.heading(lang), tuple(sheets))


def date_text(date: datetime.date | None, lang: str) -> str:
    """A day as a language writes it: ``4 décembre 2026``; nothing for none."""
    if date is None:
        return ""
    said = words(lang)["date"]
    return str(said["form"]).format(day=date.day, month=said["months"][date.month - 1], year=date.year)


def papers(
    assignment: Assignment, issues: Sequence[Issue], *, polygons: bool, scan: str = ""
) -> list[IssuedPaper]:
    """What was dealt, a paper each; ``scan`` is the size of their answer pages."""
    found: dict[tuple[str, int], list[Issue]] = {}
    for issue in issues:
        found.setdefault((issue.stem, issue.sitting), []).append(issue)
    return [IssuedPaper(assignment, tuple(own), polygons, scan) for own in found.values()]


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
    """Every file of an assignment, in order; with ``only``, the papers of these students alone, and no table; with
    ``scan``, answer pages that a scanner reads in the PDFs. A ``secret`` stands in ``issued.json``."""
    renderer = renderer_of(course.folder).on(paper)
    made = papers(assignment, issues, polygons=polygons, scan=paper if scan else "")
    for one in made:
        if only is None or one.first.student in only:
            for lang in one.first.langs:
                yield from _paper(course, renderer, one, lang, formats)
    if only is not None:
        return
    if booklet:
        yield from booklets.bound(course, _booklets(renderer, made), PAGE_COLUMNS, spreadsheet)
    yield from tables(course, issues, assignment, spreadsheet, secret)


def _paper(
    course: Course[Any], renderer: Renderer, one: IssuedPaper, lang: str, formats: Sequence[str]
) -> Iterator[File]:
    for_student = Path("handouts") / f"{one.first.stem}.{lang}"
    for_staff = Path("instructor") / f"{one.first.stem}.{lang}"
    paper, solution = partial(one.paper, lang), partial(one.solution, lang)
    if "pdf" in formats:
        yield rendered(for_student, ".pdf", renderer.paper_pdf, partial(one.printed, lang))
    if "html" in formats:
        yield rendered(for_student, ".html", renderer.paper_html, paper)
    if "ipynb" in formats:
        yield rendered(for_student, ".ipynb", renderer.paper_notebook, paper)
    if "tex" in formats:
        yield from _tex(renderer, one, lang, for_student, solved=False)
    if course.folder.has_solutions and "pdf" in formats:
        yield rendered(for_staff, ".solution.pdf", renderer.paper_pdf, solution)
    if course.folder.has_solutions and "html" in formats:
        yield rendered(for_staff, ".solution.html", renderer.paper_html, solution)
    if course.folder.has_solutions and "tex" in formats:
        yield from _tex(renderer, one, lang, for_staff, solved=True)


def _tex(renderer: Renderer, one: IssuedPaper, lang: str, path: Path, *, solved: bool) -> Iterator[File]:
    """A source, and beside it the drawings of each exercise."""
    stem, places = tex_stem(path), range(1, len(one.issues) + 1)
    figures = [f"{stem}-{'solution-figure' if solved else 'figure'}-{place}.pdf" for place in places]
    polygons = [f"{stem}-polygons-{place}.pdf" for place in places]
    source = partial(renderer.paper_tex, figures=figures, polygons=polygons)
    yield rendered(
        path,
        ".solution.tex" if solved else ".tex",
        source,
        partial(one.solution if solved else one.paper, lang),
    )
    for issue, figure, drawn in zip(one.issues, figures, polygons, strict=True):
        variant = issue.variant.in_language(lang)
        sheet: Callable[[], Handout | AnswerSheet] = (
            partial(variant.answer_sheet, issue.student, polygons=one.polygons)
            if solved
            else partial(variant.handout, issue.student)
        )
        yield rendered(path.with_name(figure), "", renderer.figure_pdf, sheet)
        if solved and one.polygons and variant.exercise.solution.polygons is not None:
            yield rendered(path.with_name(drawn), "", renderer.polygons_pdf, sheet)


# --------------------------------------------------------------------- booklets


def _booklets(renderer: Renderer, made: Sequence[IssuedPaper]) -> Iterator[Booklet]:
    """All papers of a language, sorted as the assignment says."""
    made = sorted(made, key=lambda one: one.sorted_by)
    for lang in dict.fromkeys(lang for one in made for lang in one.first.langs):
        group = [one for one in made if lang in one.first.langs]
        for name, part in booklets.parted(f"class.{lang}", group):
            yield _of_papers(renderer, name, part, lang)


def _of_papers(renderer: Renderer, name: str, papers: Sequence[IssuedPaper], lang: str) -> Booklet:
    return Booklet(
        name,
        lambda: renderer.papers_pdf([one.printed(lang) for one in papers]),
        lambda: renderer.papers_pdf([one.solution(lang) for one in papers])[0],
        [{"student": one.first.student, "version": one.first.version, "lang": lang} for one in papers],
    )
