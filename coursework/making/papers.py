"""The files of an assignment: one paper a student, in every format; solutions and the key for the staff."""

from __future__ import annotations

import datetime
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from coursework.course.course import Course
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.making.assignment import Assignment, text_in
from coursework.making.build import key_files
from coursework.making.issued import COLUMNS, form_rows, issued_content
from coursework.making.issuing import Issue
from coursework.making.students import folded
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.sheets.paper import Heading, Paper, SolutionPaper
from coursework.system.tables import SPREADSHEETS, Spreadsheet, csv_file, json_text
from coursework.system.writing import File

PAPERS = 50  #: in one booklet, at most
PAGE_COLUMNS = ("student", "version", "lang", "first page", "last page", "file")

Pages = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class IssuedPaper:
    """One paper: the exercises of one student and sitting, in the assignment's order."""

    assignment: Assignment
    issues: tuple[Issue, ...]
    polygons: bool

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
        return tuple((0, int(p), "") if p.isdecimal() else (1, 0, folded(p)) for p in pieces)

    def heading(self, lang: str) -> Heading:
        assignment, first, own = self.assignment, self.first, self._columns
        mark = assignment.mark
        return Heading(
            lang=lang,
            title=text_in(assignment.title, lang) or assignment.name,
            course=text_in(assignment.course, lang) or first.variant.exercise.folder.title(lang),
            student=first.student,
            identity=tuple((title, own.get(folded(title), "")) for title in assignment.identity),
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


def papers(assignment: Assignment, issues: Sequence[Issue], *, polygons: bool) -> list[IssuedPaper]:
    """What was dealt, a paper each."""
    found: dict[tuple[str, int], list[Issue]] = {}
    for issue in issues:
        found.setdefault((issue.stem, issue.sitting), []).append(issue)
    return [IssuedPaper(assignment, tuple(own), polygons) for own in found.values()]


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
) -> Iterator[File]:
    """Every file of an assignment, in order; with ``only``, the papers of these students alone, and no table."""
    renderer = renderer_of(course.folder).on(paper)
    made = papers(assignment, issues, polygons=polygons)
    for one in made:
        if only is None or one.first.student in only:
            for lang in one.first.langs:
                yield from _paper(course, renderer, one, lang, formats)
    if only is not None:
        return
    if booklet:
        yield from _booklets(course, renderer, made, spreadsheet)
    content = issued_content(issues, assignment)
    yield File(Path("issued.json"), lambda: json_text(content).encode("utf-8"))
    yield File(Path("answers.csv"), lambda: csv_file(form_rows(issues), COLUMNS, spreadsheet))
    if course.folder.has_solutions:
        yield from key_files(issues, spreadsheet)


def _paper(
    course: Course[Any], renderer: Renderer, one: IssuedPaper, lang: str, formats: Sequence[str]
) -> Iterator[File]:
    stem = f"{one.first.stem}.{lang}"
    handouts, staff = Path("handouts"), Path("instructor")

    def file(path: Path, render: Callable[[Any], str | bytes], sheet: Callable[[str], Any]) -> File:
        return File(path, partial(_rendered, render, sheet, lang), anywhere=True)

    if "pdf" in formats:
        yield file(handouts / f"{stem}.pdf", renderer.paper_pdf, one.paper)
    if "html" in formats:
        yield file(handouts / f"{stem}.html", renderer.paper_html, one.paper)
    if "ipynb" in formats:
        yield file(handouts / f"{stem}.ipynb", renderer.paper_notebook, one.paper)
    if course.folder.has_solutions and "pdf" in formats:
        yield file(staff / f"{stem}.solution.pdf", renderer.paper_pdf, one.solution)
    if course.folder.has_solutions and "html" in formats:
        yield file(staff / f"{stem}.solution.html", renderer.paper_html, one.solution)


def _rendered(render: Callable[[Any], str | bytes], sheet: Callable[[str], Any], lang: str) -> bytes:
    made = render(sheet(lang))
    return made.encode("utf-8") if isinstance(made, str) else made


# --------------------------------------------------------------------- booklets


@dataclass(frozen=True)
class _Booklet:
    """The papers of one file, in one language."""

    lang: str
    papers: tuple[IssuedPaper, ...]
    name: str

    def rows(self, pages: Pages) -> Iterator[dict[str, object]]:
        for one, (first, last) in zip(self.papers, pages, strict=True):
            yield {
                "student": one.first.student,
                "version": one.first.version,
                "lang": self.lang,
                "first page": first,
                "last page": last,
                "file": f"{self.name}.pdf",
            }


def _booklets(
    course: Course[Any], renderer: Renderer, made: Sequence[IssuedPaper], spreadsheet: Spreadsheet
) -> Iterator[File]:
    """All papers of a language in one PDF, and where each is; the table is made after them."""
    made = sorted(made, key=lambda one: one.sorted_by)
    wanted = []
    for lang in dict.fromkeys(lang for one in made for lang in one.first.langs):
        group = [one for one in made if lang in one.first.langs]
        digits = len(str(len(group)))
        for start in range(0, len(group), PAPERS):
            part = tuple(group[start : start + PAPERS])
            which = f".{start + 1:0{digits}}-{start + len(part):0{digits}}" if len(group) > PAPERS else ""
            wanted.append(_Booklet(lang, part, f"class.{lang}{which}"))
    pages: list[Future[Pages]] = [Future() for _ in wanted]
    for booklet, found in zip(wanted, pages, strict=True):
        yield File(Path("handouts") / f"{booklet.name}.pdf", partial(_bound, renderer, booklet, found))
        if course.folder.has_solutions:
            make = partial(_bound_solutions, renderer, booklet)
            yield File(Path("instructor") / f"{booklet.name}.solutions.pdf", make)

    def table() -> bytes:
        rows = (row for one, found in zip(wanted, pages, strict=True) for row in one.rows(found.result()))
        return csv_file(rows, PAGE_COLUMNS, spreadsheet)

    yield File(Path("handouts") / "pages.csv", table)


def _bound(renderer: Renderer, booklet: _Booklet, found: Future[Pages]) -> bytes:
    try:
        made, pages = renderer.papers_pdf([one.paper(booklet.lang) for one in booklet.papers])
    except BaseException as fault:
        found.set_exception(fault)
        raise
    found.set_result(pages)
    return made


def _bound_solutions(renderer: Renderer, booklet: _Booklet) -> bytes:
    return renderer.papers_pdf([one.solution(booklet.lang) for one in booklet.papers])[0]
