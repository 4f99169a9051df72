"""A workbook as one PDF, and as pages that lead to one another."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from jinja2 import Environment
from markupsafe import Markup

from coursework.errors import bare_letters
from coursework.language.typography import typeset
from coursework.language.words import words
from coursework.markup.links import MACHINE, TERM, WORD, TextLink, relinked
from coursework.markup.markdown import INDEX, anchor
from coursework.rendering import html, papers, pdf, views
from coursework.rendering.environment import render
from coursework.rendering.keeping import keeping
from coursework.rendering.surface import kinds_of_surfaces
from coursework.sheets.book import (
    BlanksPiece,
    Book,
    BookChapter,
    BookExercise,
    DrawnPiece,
    HeadPiece,
    LessonText,
    Piece,
    ProsePiece,
)
from coursework.sheets.paper import Paper, PaperHeading, SolutionPaper

_MARKS = {TERM: INDEX, WORD: f"#{WORD}", MACHINE: f"#{MACHINE}"}  #: where the marks of the index lead to
_TALL = 78  #: mm that a drawing of a lesson takes at most
#: A paragraph that stands above what it names.
_RUN_IN = re.compile(r"\*\*[^*\n]+\*\*|(?![-*>|\d ])(?s:.){,400}:")

# -------------------------------------------------------------------------- PDF


def typst_source(folders: Sequence[Path], book: Book, paper: str = "a4", *, apart: bool = False) -> str:
    """Return the Typst source of a book; ``apart``: of its solutions alone."""
    env = pdf.environment_of(tuple(folders), book.lang)
    names = _of_book(book) | {"paper": paper, "apart": apart, "tall": _TALL}
    called = words(book.lang)["book"]["exercise"]
    names["exercises"] = {
        exercise.handout.exercise: _exercise(env, exercise, called.format(exercise.number), "typ.j2")
        for exercise in book.exercises
    }
    names["papers"] = {
        exercise.number: _exercise(env, exercise, exercise.handout.title, "typ.j2")
        for chapter in book.chapters
        for exercise in chapter.paper
    }
    names["exercise_numbers"] = _cited_exercises(book)
    names["ladder"] = any(section.drills or section.judgements for section in book.sections)
    names["machines"] = _machines(book)
    names["index_entries"] = {*book.terms, *(entry for part in book.front for entry in part.terms)}
    names["pieces"] = partial(_typst_pieces, env, book)
    names["exercises_of"] = partial(_own_exercises, book)
    body = Markup(render(env, "book/book.typ.j2", names))
    # The parts of a paper are those of an exercise in a book.
    return render(
        env, "parts/page.typ.j2", names | {"bodies": [body], "printed": True, "heading": {"lang": book.lang}}
    )


def _cited_exercises(book: Book) -> dict[str, str]:
    """Return how paper names the exercises of the book, by their names."""
    form = words(book.lang)["book"]["cited_exercise"]
    return {
        one.handout.exercise: str(form.format(one.number)).replace(" ", "\u00a0") for one in book.exercises
    }


def _machines(book: Book) -> list[tuple[str, list[BookExercise]]]:
    """Return the machines about which exercises of the book ask, with these."""
    by_name = {exercise.handout.exercise: exercise for exercise in book.exercises}
    listed = (
        (one.entry, [by_name[name] for name in one.exercises if name in by_name]) for one in book.machines
    )
    return [(entry, exercises) for entry, exercises in listed if exercises]


def _of_book(book: Book) -> dict[str, Any]:
    book_words = words(book.lang)
    names = {lesson.name for lesson in book.lessons}
    return {"book": book, "lang": book.lang, "words": book_words, "title": book.title, "lesson_names": names}


def _exercise(env: Environment, exercise: BookExercise, whose: str, end: str) -> dict[str, Any]:
    """Return the variables for the template of an exercise: its body, and that of its solution. ``whose``
    stands above what was moved to the next page, where a question may stand alone as the text goes on after
    it: figures, and polygons of solutions."""
    names = views.context(exercise.handout, 1, numbered=False) | {"whose": whose, "together": 1}
    names["body"] = Markup(render(env, f"sheet/_body.{end}", names))
    solved = views.context(exercise.solution, 1, numbered=False) | {"moving": whose}
    names["solution_body"] = Markup(render(env, f"sheet/_solution_body.{end}", solved))
    return names


def _typst_pieces(
    env: Environment, book: Book, lesson: LessonText, pieces: Sequence[Piece], *, floats: bool = True
) -> Markup:
    numbers = {
        "exercise": {one.handout.exercise: one.number for one in book.exercises},
        "lesson": {one.name: str(one.number) for one in book.lessons},
    }

    def write(link: TextLink) -> str:
        if link.kind in _MARKS:
            return f'[{link.said}]({_MARKS[link.kind]} "{typeset(link.name, book.lang)}")'
        if link.kind == "figure":
            return f"[{link.said}](#figure-{link.number})"
        if link.name not in numbers[link.kind]:
            return link.said
        section = f"-{link.section}" if link.section else ""
        named = _cited(book, lesson, link, numbers[link.kind][link.name]).replace('"', "")
        return f'[{link.said}](#{link.kind}-{link.name}{section} "{typeset(named, book.lang)}")'

    names = _of_book(book) | {
        "lesson": lesson,
        "pieces": list(map(_with_kind, _text_first(filter(_is_printed, pieces)))),
        "tall": _TALL,
        "floats": floats,
    }
    names["relinked"] = lambda text: relinked(text, write)
    names["led"] = _led
    return Markup(render(env, "book/_pieces.typ.j2", names))


def _led(text: str, *, last: bool) -> Iterator[tuple[str, bool]]:
    """Yield running text in parts, each with whether it keeps to what follows it: a paragraph in bold alone,
    as a heading is; a short one that ends with a colon; and the ``last`` one where it leads to the next
    piece, as one that ends with a colon does."""
    *paragraphs, end = text.strip("\n").split("\n\n")
    plain: list[str] = []
    for paragraph in paragraphs:
        if _RUN_IN.fullmatch(paragraph):
            yield "\n\n".join(plain), False
            yield paragraph, True
            plain = []
        else:
            plain.append(paragraph)
    if last or end.rstrip().endswith(":") or _RUN_IN.fullmatch(end):
        yield "\n\n".join(plain), False
        yield end, True
    else:
        yield "\n\n".join([*plain, end]), False


def _is_printed(piece: Piece) -> bool:
    """Return whether paper shows a piece."""
    return piece.on_paper if isinstance(piece, DrawnPiece) else not isinstance(piece, BlanksPiece)


def _text_first(pieces: Iterable[Piece]) -> Iterator[Piece]:
    """Yield the pieces, and where a drawing follows a heading at once, the first paragraph between the two:
    the drawing may go to the next page, and would take the heading with it."""
    head: Piece | None = None
    drawn: list[Piece] = []
    for piece in pieces:
        if isinstance(piece, DrawnPiece) and isinstance(head, HeadPiece):
            drawn.append(piece)
            continue
        if drawn and isinstance(piece, ProsePiece):
            first, _, rest = piece.text.strip("\n").partition("\n\n")
            if not first.endswith(":"):
                yield ProsePiece(first)
                piece = ProsePiece(rest)
        yield from drawn
        head, drawn = piece, []
        if getattr(piece, "text", None) != "":
            yield piece
    yield from drawn


def _cited(book: Book, lesson: LessonText, link: TextLink, number: str) -> str:
    """Return how paper names the place of a link: exercise 2.3, lesson 4 §5, or §5 in the same lesson."""
    book_words = words(book.lang)["book"]
    if link.kind == "exercise":
        return str(book_words["cited_exercise"].format(number))
    if link.name == lesson.name and link.section:
        return str(book_words["cited_here"].format(link.section))
    key = "cited_section" if link.section else "cited_lesson"
    return str(book_words[key].format(number, link.section))


def _with_kind(piece: Piece) -> dict[str, Any]:
    """Return a piece with the word by which the templates tell it."""
    return {"kind": type(piece).__name__.removesuffix("Piece").lower(), "piece": piece}


# ------------------------------------------------------------------------ pages


@dataclass(frozen=True)
class BookPage:
    """A page of a book: its file, what it is called, and what stands on it."""

    file: str
    title: str
    of: LessonText | BookExercise | BookChapter | Paper | None = None


def pages(
    folders: Sequence[Path], book: Book, paper: str = "a4", *, solutions: bool = True
) -> dict[str, Callable[[], str]]:
    """Return the pages of a book by their files, each a function that makes it: contents, lessons, exercises,
    the index, and solutions where they are wanted. Each stands alone; those of exercises run the one script
    that keeps answers."""
    env = html.environment_of(tuple(folders), book.lang)
    book_pages = list(_pages(book))
    shared = _of_book(book) | {"paper": paper, "sheet": {"course": book.title}, "variant": ""}
    shared |= {"files": {page.file for page in book_pages}, "before": None, "after": None}
    writers: dict[str, Callable[[], str]] = {"terms.html": partial(_terms, env, book, shared)}
    more = {"title": words(book.lang)["book"]["symbols"]}
    writers["symbols.html"] = partial(render, env, "book/symbols.html.j2", shared | more)
    for index, page in enumerate(book_pages):
        around = {
            "before": book_pages[index - 1] if index else None,
            "after": book_pages[index + 1] if index + 1 < len(book_pages) else None,
        }
        writers[page.file] = partial(_page, env, book, page, shared | around)
    if solutions:
        for exercise in book.exercises:
            writers[f"solutions/{exercise.handout.exercise}.html"] = partial(_solution, env, exercise, shared)
        for chapter in book.chapters:
            if chapter.paper:
                sheets = tuple(one.solution for one in chapter.paper)
                solved = SolutionPaper(_paper_heading(book, chapter), sheets)
                file = _paper_file(chapter)
                writers[f"solutions/{file}"] = partial(
                    _paper, env, solved, shared | {"exam_file": file}, "book/paper_solution.html.j2"
                )
    return writers


def _terms(env: Environment, book: Book, names: Mapping[str, Any]) -> str:
    terms, titles = book.terms, {lesson.name: lesson.title for lesson in book.lessons}
    machines: dict[str, list[BookExercise]] = {one.entry: [] for one in book.machines} | dict(_machines(book))
    see: dict[str, list[str]] = {}
    for one in book.see:
        if one.to in terms:
            see.setdefault(one.entry, []).append(one.to)

    def listed(entries: Iterable[str]) -> list[dict[str, Any]]:
        return [
            {
                "entry": typeset(entry, book.lang),
                "anchor": anchor(entry),
                "places": [(f"{name}.html#{anchor(entry)}", titles[name]) for name in terms.get(entry, ())],
                "see": [(f"#{anchor(to)}", typeset(to, book.lang)) for to in see.get(entry, ())],
                "exercises": machines.get(entry, ()),
            }
            for entry in sorted(entries, key=bare_letters)
        ]

    more = {
        "terms": listed({*terms, *see} - machines.keys()),
        "machines": listed(entry for entry, exercises in machines.items() if exercises or entry in terms),
        "title": words(book.lang)["book"]["index"],
    }
    return render(env, "book/terms.html.j2", {**names, **more})


def _solution(env: Environment, exercise: BookExercise, names: Mapping[str, Any]) -> str:
    variables = views.context(exercise.solution) | {"one": exercise, "title": views.title(exercise.solution)}
    return render(env, "book/solution.html.j2", {**names, **variables})


def _pages(book: Book) -> Iterator[BookPage]:
    book_words = words(book.lang)["book"]
    yield BookPage("index.html", book_words["contents"])
    for part in book.front:
        yield BookPage(f"book-{part.name}.html", part.title, part)
    for chapter in book.chapters:
        for section in chapter.sections:
            if section.lesson:
                yield BookPage(f"{section.lesson.name}.html", section.lesson.title, section.lesson)
            for exercise in section.exercises:
                yield BookPage(
                    f"{exercise.handout.exercise}.html",
                    f"{exercise.number} {exercise.handout.title}",
                    exercise,
                )
        if chapter.paper:
            heading = _paper_heading(book, chapter)
            yield BookPage(
                _paper_file(chapter),
                heading.title,
                Paper(heading, tuple(one.handout for one in chapter.paper)),
            )
        if chapter.summary:
            title = book_words["summary"][chapter.sort].format(chapter.label)
            yield BookPage(f"summary-{chapter.number}.html", title, chapter)
    for part in book.back:
        yield BookPage(f"book-{part.name}.html", part.title, part)


def _paper_file(chapter: BookChapter) -> str:
    return f"paper-{chapter.number}.html"


def _paper_heading(book: Book, chapter: BookChapter) -> PaperHeading:
    book_words = words(book.lang)["book"]
    told = book_words["paper_time"].format(chapter.paper_minutes)
    return PaperHeading(
        book.lang, book_words["paper"].format(chapter.number), book.title, student="", duration=told
    )


def _paper(env: Environment, paper: Paper | SolutionPaper, names: Mapping[str, Any], template: str) -> str:
    return render(env, template, {**names, **papers.page_names(env, paper)})


def _page(env: Environment, book: Book, page: BookPage, names: Mapping[str, Any]) -> str:
    names = {**names, "page": page, "title": page.title}
    if isinstance(page.of, LessonText):
        pieces = _html_pieces(env, book, page.of, names)
        more = {"lesson": page.of, "shown": pieces, "own": _own_exercises(book, page.of)}
        more["section"] = next((one for one in book.sections if one.lesson is page.of), None)
        more["exercise_numbers"] = _cited_exercises(book)
        return render(env, "book/lesson.html.j2", {**names, **more})
    if isinstance(page.of, BookExercise):
        sheet = page.of.handout
        more = views.context(sheet) | {"one": page.of, "keeping": keeping([sheet], sheet.student, sheet.lang)}
        more["draws"] = kinds_of_surfaces([sheet])
        return render(env, "book/exercise.html.j2", {**names, **more})
    if isinstance(page.of, Paper):
        return _paper(env, page.of, names, "book/paper.html.j2")
    if isinstance(page.of, BookChapter):
        return render(env, "book/summary.html.j2", {**names, "chapter": page.of})
    return render(env, "book/contents.html.j2", names)


def _own_exercises(book: Book, lesson: LessonText) -> tuple[BookExercise, ...]:
    return tuple(
        exercise for exercise in book.exercises if lesson.name in {name for name, _ in exercise.lessons}
    )


def _html_pieces(env: Environment, book: Book, lesson: LessonText, names: Mapping[str, Any]) -> Markup:
    def address(link: TextLink) -> str:
        file = f"{link.name}.html"
        return f"{file}{link.anchor and '#'}{link.anchor}" if file in names["files"] else ""

    return LessonPages(env, lesson, address).html(lesson.pieces)


class LessonPages:
    """Lesson in a page, in one piece or step by step; ``address`` leads to an exercise, a lesson or a
    section, and is empty where a link has no place to lead to."""

    def __init__(self, env: Environment, lesson: LessonText, address: Callable[[TextLink], str]):
        self._env, self._address = env, address
        self._met: set[str] = set()
        self._names = {
            "words": words(lesson.lang),
            "answers": {number: [_with_kind(piece) for piece in told] for number, told in lesson.answers},
            "relinked": lambda text: relinked(text, self._written),
        }

    def html(self, pieces: Sequence[Piece]) -> Markup:
        """Return some of the lesson's pieces; each term is marked where it is first met."""
        shown = [_with_kind(piece) for piece in pieces]
        return Markup(render(self._env, "book/_pieces.html.j2", {**self._names, "pieces": shown}))

    def _written(self, link: TextLink) -> str:
        if link.kind in _MARKS:
            if link.name in self._met:
                return f"*{link.said}*" if link.kind == TERM else link.said
            self._met.add(link.name)
            return f'[{link.said}]({_MARKS[link.kind]} "{link.name}")'
        address = self._address(link)
        return f"[{link.said}]({address})" if address else link.said
