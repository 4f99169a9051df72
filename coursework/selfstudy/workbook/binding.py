"""Book of a course: its chapters, each with its lessons and a variant of each exercise."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import zip_longest
from typing import Any

from coursework.course.chapters import Chapter
from coursework.course.chapters import ChapterSection as Placed
from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.course.lessons import PAGES, taught_by
from coursework.course.variant import Variant
from coursework.errors import BadCourse, BadInput
from coursework.issuing.issuing import distinct_variants
from coursework.language.words import words
from coursework.markup.links import links
from coursework.selfstudy.workbook.concordance import (
    SoughtEntry,
    entries_of,
    machine_entries,
    see_entries,
    with_entries,
)
from coursework.selfstudy.workbook.drills import drills_of, judgements_of
from coursework.selfstudy.workbook.lessons import lesson_text
from coursework.selfstudy.workbook.matter import matter_of, title_page
from coursework.selfstudy.workbook.summaries import summary_of
from coursework.sheets.answer_sheet import answer_sheet
from coursework.sheets.book import (
    BlanksPiece,
    Book,
    BookChapter,
    BookExercise,
    BookSection,
    DrillGroup,
    Judgement,
    LessonText,
    ProsePiece,
)
from coursework.sheets.handout import handout

_FAR = 500_000  #: seeds away from those of a class and of self-study: a book prints its solutions
_APART = 1_000  #: seeds between two books
_PAPER = 500  #: seeds between a book's exercises and those of its papers
_PAPER_POINTS, _PAPER_MOST, _PAPER_EXERCISES = 20.0, 32.0, 4  #: a paper is long enough, and not too long
_DRAWN = ("point", "point_on_line", "drawing")  #: kinds of what is drawn


def bound(
    course: Course[Any],
    lang: str,
    seed: int = 0,
    *,
    chapters: Sequence[int] = (),
    solved: bool = True,
    answers: str = "",
    advance: Callable[[], object] = lambda: None,
) -> Book:
    """Return the book of a course.

    Parameters
    ----------
    course
        An open course. What stands in none of its chapters comes in one at the end.
    lang
        Language of the book.
    seed
        Which book: each has variants of its own, and none that a class or self-study is given.
    chapters
        The numbers of those that are wanted; by default all.
    solved
        Whether the solutions stand at its end.
    answers
        Which short answers stand at its end: ``odd``, ``all``, or none.
    advance
        Called after each lesson and exercise.

    Raises
    ------
    BadInput
        No such chapter.
    BadCourse
        An exercise has the name of a page that every book has; a lesson cannot be read, drawn or run.
    """
    course.folder.check_speaks(lang)
    for name in set(course.folder.names) & set(PAGES):
        raise BadCourse(
            f"the exercise {name} has a name that is a page of every book as well; rename its files"
        )
    results = tuple(chapters_of(course, lang))
    numbers = [chapter.number for chapter in results]
    for number in chapters:
        if number not in numbers:
            raise BadInput(
                "no chapter {number}; available: {value}",
                number=number,
                value=", ".join(map(str, numbers)) or "none",
            )
    wanted = [chapter for chapter in results if not chapters or chapter.number in chapters]
    folder = course.folder
    sought = entries_of(folder, lang)
    created = tuple(_chapter(course, chapter, lang, seed, sought, advance) for chapter in wanted)
    front, back = (matter_of(folder, lang, place) for place in ("front", "back"))
    return Book(
        lang,
        folder.title(lang),
        seed,
        created,
        solved,
        title_page(folder, lang),
        front,
        back,
        see_entries(folder, lang),
        machine_entries(folder, lang),
        answers,
    )


def pieces_of(course: Course[Any]) -> int:
    """Count the lessons and exercises of the whole book."""
    return len(course.folder.lessons) + len(course.folder.names)


def chapters_of(course: Course[Any], lang: str) -> Iterator[Chapter]:
    """Yield the chapters of the course, then one with everything outside them."""
    folder = course.folder
    yield from folder.chapters
    lessons = [n for n in folder.lessons if not any(n in c.lessons for c in folder.chapters)]
    exercises = [n for n in folder.names if folder.section_of(n) is None]
    if lessons or exercises:
        title = words(lang)["book"]["others"] if folder.chapters else folder.title(lang)
        sections = (*(Placed(n, {}, (), {}) for n in lessons), Placed("", {}, tuple(exercises), {}))
        yield Chapter(1 + len(folder.chapters), {lang: title}, sections)


def _chapter(
    course: Course[Any],
    chapter: Chapter,
    lang: str,
    seed: int,
    sought: Sequence[SoughtEntry],
    advance: Callable[[], object],
) -> BookChapter:
    sections = []
    count = 0
    for placed in chapter.sections:
        lesson = lesson_text(course, placed.lesson, lang) if placed.lesson else None
        if lesson:
            lesson = with_entries(lesson, sought)
            advance()
        exercises = []
        for name in placed.exercises:
            count += 1
            exercises.append(_practised(course, name, lang, seed, f"{chapter.number}.{count}"))
            advance()
        title = "" if lesson else placed.titles.get(lang, "")
        drills: tuple[DrillGroup, ...] = ()
        judgements: tuple[Judgement, ...] = ()
        if lesson and course.folder.book_place.is_dir():
            drills = drills_of(course, lesson, seed)
            judgements = judgements_of(course.folder, lesson)
        sections.append(BookSection(lesson, tuple(exercises), title, drills, judgements))
    lessons = [section.lesson for section in sections if section.lesson]
    cards = tuple(filter(None, (summary_of(course.folder, lesson) for lesson in lessons)))
    paper = _paper(course, chapter, lessons, lang, seed) if course.folder.book_place.is_dir() else ()
    sort = "appendix" if chapter.appendix else "chapter"
    return BookChapter(
        chapter.number, chapter.title(lang), tuple(sections), cards, paper, chapter.label, sort
    )


def _paper(
    course: Course[Any], chapter: Chapter, lessons: Sequence[LessonText], lang: str, seed: int
) -> tuple[BookExercise, ...]:
    """Return an examination paper on a chapter: the last exercise of each section, then those before, with
    numbers of their own. A chapter that has none poses those that its lessons work out, then those that they
    name; an appendix has no paper of that kind."""
    posed = [section.exercises[::-1] for section in chapter.sections]
    if not chapter.exercises and not chapter.appendix:
        posed = [_named(course, lesson) for lesson in lessons]
    rows = zip_longest(*posed)
    chosen: list[BookExercise] = []
    points = 0.0
    for name in (name for row in rows for name in row if name):
        if name in {one.handout.exercise for one in chosen}:
            continue
        if points >= _PAPER_POINTS or len(chosen) == _PAPER_EXERCISES:
            break
        variant = _variant(course[name], lang, seed, _PAPER)
        sheet = handout(variant)
        # What is drawn to scale needs half an hour for itself.
        drawn = any(question.is_open or question.kind in _DRAWN for question in sheet.questions)
        if drawn or sheet.drawing_mm or sheet.surface_mm or points + sheet.points > _PAPER_MOST:
            continue
        points += sheet.points
        chosen.append(BookExercise(f"{chapter.number}.{len(chosen) + 1}", sheet, answer_sheet(variant)))
    return tuple(chosen)


def _named(course: Course[Any], lesson: LessonText) -> tuple[str, ...]:
    """Return the exercises that a lesson works out, then those to which its text leads."""
    worked = [piece.exercise for piece in lesson.pieces if isinstance(piece, BlanksPiece)]
    linked = [
        link.name
        for piece in lesson.pieces
        if isinstance(piece, ProsePiece)
        for link in links(piece.text)
        if link.kind == "exercise"
    ]
    return tuple(name for name in dict.fromkeys((*worked, *linked)) if name in course.folder.names)


def _variant(exercise: CourseExercise[Variant], lang: str, seed: int, further: int = 0) -> Variant:
    """Return the first valid variant for a book, or a further one for its papers."""
    return distinct_variants(exercise, _FAR + _APART * seed + further, 1, lang)[0]


def _practised(course: Course[Any], name: str, lang: str, seed: int, number: str) -> BookExercise:
    exercise = course[name]
    variant = _variant(exercise, lang, seed)
    taught = tuple((item.name, item.title) for item in taught_by(course.folder, name, lang))
    return BookExercise(number, handout(variant), answer_sheet(variant), taught)
