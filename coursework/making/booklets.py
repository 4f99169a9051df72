"""All students' sheets of one exercise in one PDF, to print at once, and a table of where each sheet is.

A booklet holds so many sheets at most; a larger class has several, named with the sheets they hold. The
typesetter keeps a whole document in memory, and a document joined from parts would lose its tags.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from coursework.course.course import Course
from coursework.making.issuing import Issue
from coursework.rendering.renderer import Renderer
from coursework.sheets.sheet import AnswerSheet, Handout
from coursework.system.tables import SPREADSHEETS, Spreadsheet, csv_file
from coursework.system.writing import File

SHEETS = 50  #: in one booklet, at most
PAGE_COLUMNS = ("student", "exercise", "seed", "lang", "first page", "last page", "file")

Pages = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class _Booklet:
    """The sheets of one file, in one language."""

    lang: str
    issues: tuple[Issue, ...]
    name: str
    polygons: bool

    def handouts(self) -> list[Handout]:
        return [i.variant.in_language(self.lang).handout(i.student) for i in self.issues]

    def answer_sheets(self) -> list[AnswerSheet]:
        return [
            i.variant.in_language(self.lang).answer_sheet(i.student, polygons=self.polygons)
            for i in self.issues
        ]

    def rows(self, pages: Pages) -> list[dict[str, object]]:
        return [
            {
                "student": issue.student,
                "exercise": issue.variant.exercise.name,
                "seed": issue.variant.seed,
                "lang": self.lang,
                "first page": first,
                "last page": last,
                "file": f"{self.name}.pdf",
            }
            for issue, (first, last) in zip(self.issues, pages, strict=True)
        ]


def files(
    course: Course,
    renderer: Renderer,
    issues: Sequence[Issue],
    *,
    polygons: bool = True,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
) -> Iterator[File]:
    """The booklets of a build, and after them the table of the students' pages.

    The files are to be made in this order, by one thread or several.
    """
    wanted = list(_booklets(issues, polygons))
    pages: list[Future[Pages]] = [Future() for _ in wanted]
    for booklet, found in zip(wanted, pages, strict=True):
        make = partial(_handouts, renderer, booklet, found)
        yield File(Path("handouts") / f"{booklet.name}.pdf", make)
        if course.folder.has_solutions:
            make = partial(_solutions, renderer, booklet)
            yield File(Path("instructor") / f"{booklet.name}.solutions.pdf", make)
    yield File(Path("handouts") / "pages.csv", lambda: _table(wanted, pages, spreadsheet))


def _booklets(issues: Sequence[Issue], polygons: bool) -> Iterator[_Booklet]:
    groups: dict[tuple[str, str], list[Issue]] = {}
    for issue in issues:
        for lang in issue.langs:
            groups.setdefault((issue.variant.exercise.name, lang), []).append(issue)
    for (exercise, lang), group in groups.items():
        digits = len(str(len(group)))
        for start in range(0, len(group), SHEETS):
            part = tuple(group[start : start + SHEETS])
            which = f".{start + 1:0{digits}}-{start + len(part):0{digits}}" if len(group) > SHEETS else ""
            yield _Booklet(lang, part, f"{exercise}.{lang}{which}", polygons)


def _handouts(renderer: Renderer, booklet: _Booklet, found: Future[Pages]) -> bytes:
    try:
        made, pages = renderer.booklet(booklet.handouts())
    except BaseException as fault:
        found.set_exception(fault)
        raise
    found.set_result(pages)
    return made


def _solutions(renderer: Renderer, booklet: _Booklet) -> bytes:
    return renderer.booklet(booklet.answer_sheets())[0]


def _table(booklets: Sequence[_Booklet], pages: Sequence[Future[Pages]], spreadsheet: Spreadsheet) -> bytes:
    rows = (row for one, found in zip(booklets, pages, strict=True) for row in one.rows(found.result()))
    return csv_file(rows, PAGE_COLUMNS, spreadsheet)
