"""Files of a workbook: one PDF, pages, and notebooks with links to one another."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from coursework.course.course import Course
from coursework.errors import unknown
from coursework.rendering.renderer import renderer_of
from coursework.sheets.book import Book
from coursework.system.writing import File
from coursework.workbook.notebooks import lesson_notebook, notebook_name

FORMATS = ("pdf", "html", "ipynb")
PDF, SOLUTIONS = "workbook.{}.pdf", "solutions.{}.pdf"


def files(
    course: Course[Any],
    book: Book,
    formats: Sequence[str] = FORMATS,
    *,
    paper: str = "a4",
    apart: bool = False,
) -> Iterator[File]:
    """Yield the files of a book; the same course, language and seed give the same bytes.

    Parameters
    ----------
    course, book
        An open course, bound.
    formats
        Of ``pdf``, ``html``, ``ipynb``.
    paper
        ``a4`` or ``letter``.
    apart
        Whether the solutions stand beside the book, for the staff: a PDF, and pages that nothing leads to.

    Raises
    ------
    UnknownName
        No such format.
    """
    for form in formats:
        if form not in FORMATS:
            raise unknown("format", form, FORMATS)
    renderer = renderer_of(course.folder).on(paper)
    if "pdf" in formats:
        yield File(Path(PDF.format(book.lang)), partial(renderer.book_pdf, book))
        if apart:
            yield File(Path(SOLUTIONS.format(book.lang)), partial(renderer.book_pdf, book, apart=True))
    if "html" in formats:
        for file, make in renderer.book_pages(book, solutions=book.solved or apart).items():
            # Solutions that stand apart are not among the pages that are given away.
            folder = "" if apart and file.startswith("solutions/") else "pages/"
            yield File(Path(folder + file), partial(_encoded, make))
    if "ipynb" in formats:
        yield from _notebooks(course, book)


def _encoded(make: Callable[[], str]) -> bytes:
    return make().encode()


def _notebooks(course: Course[Any], book: Book) -> Iterator[File]:
    folder = Path("notebooks")
    there = {*(item.name for item in book.lessons), *(item.handout.exercise for item in book.exercises)}
    for lesson in book.lessons:
        make = partial(lesson_notebook, course, lesson.name, book.lang, there)
        yield File(folder / notebook_name(lesson.name, book.lang), partial(_encoded, make))
    for item in book.exercises:
        make = partial(_study, course, item.handout.exercise, item.handout.seed, book.lang, there)
        yield File(folder / notebook_name(item.handout.exercise, book.lang), partial(_encoded, make))
    wheel = course.folder.wheel
    if wheel is not None:
        yield File(folder / wheel.name, wheel.read_bytes)


def _study(course: Course[Any], exercise: str, seed: int, lang: str, neighbours: Collection[str]) -> str:
    sheet = course[exercise].variant(seed, lang).study_sheet(beside=neighbours)
    return renderer_of(course.folder).study(sheet)
