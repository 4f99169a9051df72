"""Files of a workbook: one PDF, pages, and notebooks with pictures, collapsed answers, and links to one
another."""

from __future__ import annotations

import base64
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import quote

from coursework.course.course import Course
from coursework.course.lessons import lesson_sections, practised
from coursework.errors import unknown
from coursework.language.words import words
from coursework.markup.links import TERM, TextLink, relinked
from coursework.markup.markdown import to_notebook_markdown
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.workbook import lesson_source as source
from coursework.selfstudy.workbook.lessons import opened
from coursework.selfstudy.workbook.running import drawn
from coursework.sheets.book import Book, DrawnPiece
from coursework.system.writing import File

_PPI = 150


def notebook_name(name: str, lang: str) -> str:
    """Return the file name of a lesson's or an exercise's notebook."""
    return f"{name}.{lang}.ipynb"


def lesson_notebook(
    course: Course[Any], name: str, lang: str, neighbours: Collection[str] | None = None
) -> str:
    """Return a lesson as a notebook (JSON, nbformat 4.5).

    Parameters
    ----------
    course, name, lang
        An open course, a lesson of it, a language.
    beside
        The lessons and exercises whose notebooks stand beside it: links lead to these alone. All of the
        course by default.

    Raises
    ------
    UnknownName
        No such lesson.
    BadCourse
        It is not written in this language, or a picture or a link leads nowhere.
    """
    folder = course.folder
    there = {*folder.lessons, *folder.names} if neighbours is None else neighbours
    pieces: list[str] = []
    pictures: dict[str, Mapping[str, str]] = {}
    for block in opened(course, name, lang).blocks:
        if isinstance(block, source.LessonImage):
            displayed = drawn(course, name, block, lang)
            file = f"picture-{len(pictures) + 1}.{'svg' if displayed.svg else 'png'}"
            pictures[file] = _attached(displayed)
            pieces.append(_picture(file, displayed, lang))
        else:
            pieces.append(_written(course, block, lang, there))
    text = "\n\n".join([*pieces, *_practise(course, name, lang, there)]) + "\n"
    return renderer_of(folder).lesson(name, text, lang, folder.install, pictures)


def _written(
    course: Course[Any],
    block: source.LessonProse | source.CodeCell | source.LessonAnswer,
    lang: str,
    there: Collection[str],
) -> str:
    if isinstance(block, source.CodeCell):
        return f"```python\n{block.code}\n```"
    text = to_notebook_markdown(_linked(course, block.text, lang, there), lang)
    if isinstance(block, source.LessonAnswer):
        return f"<details><summary>{words(lang)['lesson']['answer']}</summary>\n\n{text}\n\n</details>"
    return text


def _linked(course: Course[Any], text: str, lang: str, there: Collection[str]) -> str:
    """Return the text with links to the notebooks beside this one, and with terms in italics."""

    def write(link: TextLink) -> str:
        if link.kind == TERM:
            return f"*{link.said}*"
        if link.name not in there:
            return link.said
        position = ""
        if link.section:
            position = "#" + quote(
                lesson_sections(course.folder, link.name, lang)[link.section].replace(" ", "-")
            )
        return f"[{link.said}]({notebook_name(link.name, lang)}{position})"

    return relinked(source.with_figures(text, lambda said, _: said), write)


def _attached(displayed: DrawnPiece) -> Mapping[str, str]:
    """Return a picture by MIME type; a moving one is SVG, which moves in a notebook too."""
    if displayed.svg:
        return {"image/svg+xml": base64.b64encode(displayed.svg.encode()).decode()}
    assert displayed.figure is not None  # a picture is one or the other
    return {"image/png": base64.b64encode(displayed.figure.png(ppi=_PPI)).decode()}


def _picture(file: str, displayed: DrawnPiece, lang: str) -> str:
    text = displayed.said.replace("[", "(").replace("]", ")").replace("\n", " ")
    caption = to_notebook_markdown(displayed.caption, lang)
    return f"![{text}](attachment:{file})" + (f"\n\n*{caption}*" if caption else "")


def _practise(course: Course[Any], name: str, lang: str, there: Collection[str]) -> list[str]:
    """Return the exercises of the lesson, each as a link to its notebook."""
    exercises = [item for item in practised(course.folder, name, lang) if item in there]
    if not exercises:
        return []
    lines = [f"- [{course[item].title(lang)}]({notebook_name(item, lang)})" for item in exercises]
    command = f"coursework notebook {' '.join(exercises)} --lang {lang}"
    return [f"## {words(lang)['lesson']['practise']}", "\n".join(lines), f"`{command}`"]


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
