"""Lesson with its pictures drawn and its cells run, as a book prints it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from coursework.course.chapters import Chapter
from coursework.course.course import Course
from coursework.course.folder import Folder
from coursework.course.lessons import (
    check_parts,
    lesson_file,
    lesson_sections,
    lesson_title,
    read_text,
    taught_by,
)
from coursework.errors import BadCourse, CourseworkError, counted, nearest
from coursework.language.words import words
from coursework.markup.links import TERM, TextLink, links
from coursework.selfstudy.workbook import lesson_source as source
from coursework.selfstudy.workbook.lesson_source import lines_of_words, place_of, proofread
from coursework.selfstudy.workbook.numbering import LessonNumbers, boxes_of
from coursework.selfstudy.workbook.running import CellOutput, CellSession, drawn
from coursework.sheets.book import (
    BoxPiece,
    CodePiece,
    DrawnPiece,
    HeadPiece,
    LaterPiece,
    LessonText,
    Piece,
    ProsePiece,
    TablePiece,
)

_TITLE = re.compile(r"\A# +[^\n]*\n*")
#: A paragraph, with the formulas and the words that go on after a colon or a formula.
_EXPLAINED = re.compile(r".*?(?:(?<!:)\n\n(?!\$\$|[a-zà-ÿ])|\Z)", re.DOTALL)
_CELL = re.compile(r"(?<!\\)\|")
_VALUE = re.compile(r"\{=(\w+)\}")
_HEAD = re.compile(r"^(##+) +(?:(\d+)\. +)?(.*?) *$", re.MULTILINE)


class LessonFile(NamedTuple):
    """Lesson file: its name in messages, its text, and its proofread blocks."""

    file: str
    text: str
    blocks: tuple[source.Block, ...]

    @property
    def terms(self) -> tuple[str, ...]:
        """Index entries of the lesson, each once."""
        return tuple(dict.fromkeys(link.name for link in links(self.text) if link.kind == TERM))


def opened(course: Course[Any], name: str, lang: str) -> LessonFile:
    """Read and proofread a lesson's file.

    Raises
    ------
    UnknownName
        No such lesson.
    BadCourse
        It is not written in this language; a formula, a fence or a picture is none; a link names an exercise,
        a lesson or a section that does not exist.
    """
    path = lesson_file(course.folder, name, lang)
    file = course.folder.relative(path)
    text = _with_values(course.folder, name, read_text(path), file)
    blocks = source.blocks(text, file)
    proofread(blocks, file)
    for said, line in lines_of_words(blocks):
        for link in links(said):
            if link.kind != TERM:
                location = place_of(said, line, file, f"{link.kind}:{link.name}")
                _check_link(course.folder, link, lang, location)
    return LessonFile(file, text, blocks)


def _with_values(folder: Folder, name: str, text: str, file: str) -> str:
    r"""Return a lesson's text with ``{=NAME}`` replaced by ``\num{…}`` of what ``values()`` of its module
    computes.

    Raises
    ------
    BadCourse
        The module computes no such value, or fails.
    """
    if not _VALUE.search(text):
        return text
    try:
        values: Mapping[str, str] = getattr(folder.lesson_module(name), "values", dict)()
    except Exception as fault:
        raise BadCourse(f"{file}: values() of {name}.py fails: {type(fault).__name__}: {fault}") from fault

    def write(found: re.Match[str]) -> str:
        if found[1] not in values:
            line = 1 + text.count("\n", 0, found.start())
            raise BadCourse(
                f"{file}, line {line}: values() of {name}.py has no {found[1]!r}{nearest(found[1], values)}"
            )
        return rf"\num{{{values[found[1]]}}}"

    return _VALUE.sub(write, text)


def lesson_text(course: Course[Any], name: str, lang: str) -> LessonText:
    """Return a lesson with its pictures drawn and its cells run.

    Raises
    ------
    UnknownName
        No such lesson.
    BadCourse
        It is not written in this language, a cell raises, or a picture or a link leads nowhere.
    """
    return _drawn_and_run(course, name, lang, opened(course, name, lang))


def _drawn_and_run(course: Course[Any], name: str, lang: str, lesson: LessonFile) -> LessonText:
    with CellSession(lesson.file, course.folder.root) as session:
        number = 1 + course.folder.lessons.index(name)
        created = _Lesson(
            course, name, lang, session, LessonNumbers(number, lang, boxes_of(course.folder, name, lang))
        )
        blocks = list(_untitled(lesson.blocks))
        for place, block in enumerate(blocks):
            created.add(
                block, next((b for b in blocks[place + 1 :] if isinstance(b, source.LessonProse)), None)
            )
    title = lesson_title(course.folder, name, lang)
    pieces, *told = created.citing(created.pieces, *(told for _, told in created.answers))
    answers = tuple(zip((k for k, _ in created.answers), told, strict=True))
    return LessonText(name, number, lang, title, pieces, answers, lesson.terms)


def _untitled(blocks: Sequence[source.Block]) -> Iterator[source.Block]:
    """Yield the blocks without the title at the start of the first one."""
    first, *others = blocks
    assert isinstance(first, source.LessonProse)  # proofread
    yield replace(first, text=_TITLE.sub("", first.text))
    yield from others


class _Lesson:
    """Pieces of a lesson, in order."""

    def __init__(
        self, course: Course[Any], name: str, lang: str, session: CellSession, numbers: LessonNumbers
    ):
        self._course, self._name, self._lang, self._session = course, name, lang, session
        self._numbers = numbers
        self.pieces: list[Piece] = []
        self.answers: list[tuple[int, tuple[Piece, ...]]] = []
        self._asks_there = False  #: what explains the last prediction ends with a question
        self._figures: dict[str, str] = {}  #: the numbers of the lesson's own figures, by name

    def add(self, block: source.Block, next_prose: source.LessonProse | None = None) -> None:
        """Add a block; ``next_prose`` is the running text that follows it."""
        match block:
            case source.LessonProse():
                self._prose(block.text)
            case source.LessonImage():
                picture = self._numbers.figure(drawn(self._course, self._name, block, self._lang))
                if block.kind == "figure":
                    self._figures[block.name] = picture.number
                self.pieces.append(picture)
            case source.LessonAnswer() if self._asks_there:
                self._tell((ProsePiece(block.text),))
            case source.LessonAnswer():
                self._later((ProsePiece(block.text),))
            case source.CodeCell():
                self._cell(block, next_prose is not None and self._explains(next_prose.text))

    def citing(self, *parts: Sequence[Piece]) -> Iterator[tuple[Piece, ...]]:
        """Yield some pieces at a time, with the numbers of the figures that their texts cite."""
        form = words(self._lang)["lesson"]["figure"]

        def write(said: str, name: str) -> str:
            if name not in self._figures:
                raise BadCourse(
                    f"{self._name}: the lesson shows no figure {name!r}{nearest(name, self._figures)}"
                )
            number = form.format(self._figures[name])
            cited = number if said[:1].isupper() else number[:1].lower() + number[1:]
            return f"[{cited}](figure:{self._name}#{self._figures[name]})"

        for pieces in parts:
            yield tuple(
                replace(one, text=source.with_figures(one.text, write))
                if isinstance(one, ProsePiece | BoxPiece | TablePiece)
                else one
                for one in pieces
            )

    def _explains(self, text: str) -> bool:
        """Return True if a text explains the last prediction: only drawings stand between."""
        asked = next((piece for piece in reversed(self.pieces) if not isinstance(piece, DrawnPiece)), None)
        return isinstance(asked, LaterPiece) and text.startswith(words(self._lang)["lesson"]["explains"])

    def _prose(self, text: str) -> None:
        """Add running text; what explains a prediction stands with the answer that it would give away."""
        self._asks_there = False
        if self._explains(text):
            explained = _EXPLAINED.match(text)
            assert explained  # what is not empty has a paragraph
            self._tell(self._numbers.prose(explained[0].strip()))
            text = text[explained.end() :].strip()
            self._asks_there = not text
        for piece in parted(text):
            self.pieces += self._numbers.prose(piece.text) if isinstance(piece, ProsePiece) else [piece]

    def _cell(self, cell: source.CodeCell, explained: bool) -> None:
        """Add what a cell shows; what is ``explained`` with an answer is shown there."""
        if source.NOTEBOOK in cell.tags:
            return
        if source.SHOWN in cell.tags or source.STILL in cell.tags:
            self.pieces.append(CodePiece(cell.code))
        displayed = CellOutput() if source.STILL in cell.tags else self._session.run(cell)
        if explained and not displayed.later:
            self._tell(displayed.now)
        elif displayed.is_example:
            self.pieces += self._numbers.example(displayed.now)
        else:
            self.pieces += (
                self._numbers.figure(piece) if isinstance(piece, DrawnPiece) else piece
                for piece in displayed.now
            )
        if displayed.later:
            self._later(displayed.later)

    def _tell(self, pieces: Iterable[Piece]) -> None:
        """Add pieces to the last answer."""
        number, told = self.answers[-1]
        self.answers[-1] = number, (*told, *pieces)

    def _later(self, pieces: tuple[Piece, ...]) -> None:
        number = 1 + len(self.answers)
        self.pieces.append(LaterPiece(number))
        self.answers.append((number, pieces))


def parted(text: str) -> Iterator[Piece]:
    """Yield the running text, with its headings as separate pieces."""
    end = 0
    for head in _HEAD.finditer(text):
        if before := text[end : head.start()].strip():
            yield ProsePiece(before)
        yield HeadPiece(head[3], len(head[1]) - 1, int(head[2] or 0))
        end = head.end()
    if after := text[end:].strip():
        yield ProsePiece(after)


def _check_link(folder: Folder, link: TextLink, lang: str, position: str) -> None:
    known_names = folder.names if link.kind == "exercise" else folder.lessons
    if link.name not in known_names:
        raise BadCourse(
            f"{position}: a link to the {link.kind} {link.name!r}, which does not exist"
            f"{nearest(link.name, known_names)}"
        )
    if link.section and link.section not in (there := lesson_sections(folder, link.name, lang)):
        numbers = ", ".join(map(str, there)) or "none"
        raise BadCourse(
            f"{position}: a link to section {link.section} of {link.name}, which does not exist; available: "
            f"{numbers}"
        )


def explained_mistakes(course: Course[Any], lang: str) -> Mapping[tuple[str, str], tuple[str, int]]:
    """Return the first lesson and section whose cells explain a named mistake, by exercise and mistake;
    nothing is run.

    A lesson that is not written in the language is left out.
    """
    places: dict[tuple[str, str], tuple[str, int]] = {}
    for name in course.folder.lessons:
        path = course.folder.lesson_place / f"{name}.{lang}.md"
        section = 0
        for block in source.blocks(read_text(path), path.name) if path.exists() else ():
            if isinstance(block, source.LessonProse):
                numbers = [int(head[2]) for head in _HEAD.finditer(block.text) if head[2]]
                section = numbers[-1] if numbers else section
            elif isinstance(block, source.CodeCell):
                for mistake in source.mistakes_shown(block):
                    places.setdefault(mistake, (name, section))
    return places


def faults(course: Course[Any], name: str) -> tuple[str, ...]:
    """Return the faults of a lesson, a sentence each.

    A language may fail to be read, drawn or run, or have other cells, pictures or answers than another.
    """
    result, shapes = [], {}
    for lang in course.folder.languages:
        try:
            lesson = opened(course, name, lang)
            _drawn_and_run(course, name, lang, lesson)
        except CourseworkError as fault:
            result.append(f"{name}, {lang}: {fault}")
            continue
        result += _cut_formulas(lesson.text, name, lang)
        shapes[lang] = [type(b).__name__ for b in lesson.blocks if not isinstance(b, source.LessonProse)]
    if len({tuple(shape) for shape in shapes.values()}) > 1:
        text = "; ".join(f"{lang}: {_counted(shape)}" for lang, shape in shapes.items())
        result.append(f"{name} is not the same in every language: {text}")
    return tuple(result)


def order_faults(course: Course[Any]) -> tuple[str, ...]:
    """Return the faults in the order of a course, a sentence each: missing titles, and unknown names or
    questions in ``[lessons]``."""
    folder = course.folder
    results = [
        f"exercises/course.toml: chapter {chapter.number}{where} has no title in {lang!r}"
        for chapter in folder.chapters
        for where, titles in _titles(chapter)
        for lang in folder.languages
        if lang not in titles
    ]
    for lang in folder.languages:
        try:
            for name in folder.names:
                taught = taught_by(folder, name, lang)
                if any(lesson.parts for lesson in taught):
                    check_parts(course[name], taught)
        except CourseworkError as fault:
            return (*results, str(fault))
    return tuple(results)


def _titles(chapter: Chapter) -> Iterator[tuple[str, Mapping[str, str]]]:
    """Yield the titles of a chapter, and those of its sections with one."""
    yield "", chapter.titles
    for number, section in enumerate(chapter.sections, 1):
        if section.titles:
            yield f", section {number}", section.titles


def _cut_formulas(text: str, name: str, lang: str) -> list[str]:
    """Return the table rows in which a bar inside a formula ends the cell."""
    return [
        f"{name}, {lang}, line {k}: a bar inside a formula ends the cell of a table; write \\lvert, "
        f"\\rvert or \\mid: {line.strip()}"
        for k, line in enumerate(text.splitlines(), 1)
        if line.lstrip().startswith("|") and any(cell.count("$") % 2 for cell in _CELL.split(line))
    ]


def _counted(shape: Sequence[str]) -> str:
    return ", ".join(counted(n, kind.lower()) for kind, n in sorted(Counter(shape).items())) or "none"
