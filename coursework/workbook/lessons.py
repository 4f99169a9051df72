"""A lesson read, drawn and run: as a book prints it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from coursework.course.chapters import Chapter
from coursework.course.course import Course
from coursework.course.folder import Folder
from coursework.course.lessons import lesson_file, lesson_sections, lesson_title, read_text, taught_by
from coursework.errors import BadCourse, CourseworkError, counted, nearest
from coursework.markup.links import TERM, Link, links
from coursework.sheets.book import Code, Head, Later, LessonText, Piece, Prose
from coursework.workbook import lesson_source as source
from coursework.workbook.pictures import drawn
from coursework.workbook.proofread import lines_of_words, place_of, proofread
from coursework.workbook.running import Session, Shows

_TITLE = re.compile(r"\A# +[^\n]*\n*")
_CELL = re.compile(r"(?<!\\)\|")
_HEAD = re.compile(r"^(##+) +(?:(\d+)\. +)?(.*?) *$", re.MULTILINE)


def lesson_text(course: Course[Any], name: str, lang: str) -> LessonText:
    """A lesson with its pictures drawn and its cells run.

    Raises
    ------
    UnknownName
        No such lesson.
    BadCourse
        It is not written in this language, a cell raises, or a picture or a link leads nowhere.
    """
    path = lesson_file(course.folder, name, lang)
    check_words(course, name, lang)
    file = course.folder.relative(path)
    with Session(file, course.folder.root) as session:
        made = _Lesson(course, name, lang, session)
        for block in source.blocks(_untitled(read_text(path)), file):
            made.add(block)
    number = 1 + course.folder.lessons.index(name)
    title = lesson_title(course.folder, name, lang)
    return LessonText(name, number, lang, title, tuple(made.pieces), tuple(made.answers))


def _untitled(text: str) -> str:
    """A text without its title, each line in its place."""
    return _TITLE.sub(lambda found: "\n" * found[0].count("\n"), text)


class _Lesson:
    """The pieces of a lesson as they come."""

    def __init__(self, course: Course[Any], name: str, lang: str, session: Session):
        self._course, self._name, self._lang, self._session = course, name, lang, session
        self.pieces: list[Piece] = []
        self.answers: list[tuple[int, tuple[Piece, ...]]] = []

    def add(self, block: source.Block) -> None:
        match block:
            case source.Prose():
                self.pieces += _parted(block.text)
            case source.Image():
                self.pieces.append(drawn(self._course, self._name, block, self._lang))
            case source.Answer():
                self._later((Prose(block.text),))
            case source.Cell():
                self._cell(block)

    def _cell(self, cell: source.Cell) -> None:
        if source.NOTEBOOK in cell.tags:
            return
        if source.SHOWN in cell.tags or source.STILL in cell.tags:
            self.pieces.append(Code(cell.code))
        shown = Shows() if source.STILL in cell.tags else self._session.run(cell)
        self.pieces += shown.now
        if shown.later:
            self._later(shown.later)

    def _later(self, pieces: tuple[Piece, ...]) -> None:
        number = 1 + len(self.answers)
        self.pieces.append(Later(number))
        self.answers.append((number, pieces))


def _parted(text: str) -> Iterator[Piece]:
    """Running text, its headings apart."""
    end = 0
    for head in _HEAD.finditer(text):
        if before := text[end : head.start()].strip():
            yield Prose(before)
        yield Head(head[3], len(head[1]) - 1, int(head[2] or 0))
        end = head.end()
    if after := text[end:].strip():
        yield Prose(after)


def check_words(course: Course[Any], name: str, lang: str) -> None:
    """Stop at words of a lesson that no book could print, and at a link that leads nowhere.

    Raises
    ------
    BadCourse
        A formula, a fence or a picture is none; a link names an exercise, a lesson or a section that there is not.
    """
    path = lesson_file(course.folder, name, lang)
    text, file = read_text(path), course.folder.relative(path)
    proofread(text, file)
    for words, line in lines_of_words(source.blocks(text, file)):
        for link in links(words):
            if link.kind != TERM:
                _check_link(
                    course.folder, link, lang, place_of(words, line, file, f"{link.kind}:{link.name}")
                )


def _check_link(folder: Folder, link: Link, lang: str, place: str) -> None:
    known = folder.names if link.kind == "exercise" else folder.lessons
    if link.name not in known:
        raise BadCourse(
            f"{place}: a link to the {link.kind} {link.name!r}, which there is not{nearest(link.name, known)}"
        )
    if link.section and link.section not in (there := lesson_sections(folder, link.name, lang)):
        numbers = ", ".join(map(str, there)) or "none"
        raise BadCourse(
            f"{place}: a link to section {link.section} of {link.name}, which it has not; there is {numbers}"
        )


def faults(course: Course[Any], name: str) -> tuple[str, ...]:
    """What is wrong with a lesson, in a sentence each: a language in which it cannot be read, drawn or run, and languages of which
    one has other cells, pictures or answers than another."""
    found, shapes = [], {}
    for lang in course.folder.languages:
        try:
            text = read_text(lesson_file(course.folder, name, lang))
            lesson_text(course, name, lang)
        except CourseworkError as fault:
            found.append(f"{name}, {lang}: {fault}")
            continue
        found += _cut_formulas(text, name, lang)
        blocks = source.blocks(text, name)
        shapes[lang] = [type(b).__name__ for b in blocks if not isinstance(b, source.Prose)]
    if len({tuple(shape) for shape in shapes.values()}) > 1:
        told = "; ".join(f"{lang}: {_counted(shape)}" for lang, shape in shapes.items())
        found.append(f"{name} is not the same in every language: {told}")
    return tuple(found)


def order_faults(course: Course[Any]) -> tuple[str, ...]:
    """What is wrong with the order of a course, in a sentence each: titles that a language lacks, and what ``[lessons]`` names
    that there is not."""
    folder = course.folder
    found = [
        f"exercises/course.toml: chapter {chapter.number}{where} has no title in {lang!r}"
        for chapter in folder.chapters
        for where, titles in _titles(chapter)
        for lang in folder.languages
        if lang not in titles
    ]
    for lang in folder.languages:
        try:
            for name in folder.names:
                taught_by(folder, name, lang)
        except CourseworkError as fault:
            return (*found, str(fault))
    return tuple(found)


def _titles(chapter: Chapter) -> Iterator[tuple[str, Mapping[str, str]]]:
    """The titles of a chapter, and those of its sections that have one."""
    yield "", chapter.titles
    for number, section in enumerate(chapter.sections, 1):
        if section.titles:
            yield f", section {number}", section.titles


def _cut_formulas(text: str, name: str, lang: str) -> list[str]:
    """Rows of tables in which a bar of a formula ends a cell."""
    return [
        f"{name}, {lang}, line {k}: a bar inside a formula ends the cell of a table; write \\lvert, \\rvert or \\mid: {line.strip()}"
        for k, line in enumerate(text.splitlines(), 1)
        if line.lstrip().startswith("|") and any(cell.count("$") % 2 for cell in _CELL.split(line))
    ]


def _counted(shape: Sequence[str]) -> str:
    return ", ".join(counted(n, kind.lower()) for kind, n in sorted(Counter(shape).items())) or "none"


def terms(course: Course[Any], name: str, lang: str) -> tuple[str, ...]:
    """The entries of the index that a lesson's text has, each once."""
    text = read_text(lesson_file(course.folder, name, lang))
    return tuple(dict.fromkeys(link.name for link in links(text) if link.kind == TERM))
