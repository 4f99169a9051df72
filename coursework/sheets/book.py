"""Content of a workbook: chapters, in each lessons and exercises.

As in :mod:`coursework.sheets.sheet`, texts are Markdown with ``$LaTeX$``. Links lead to ``exercise:NAME`` and
``lesson:NAME#SECTION``, and terms of the index to ``#index``: each back end puts its own places in their
stead.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from coursework.language.words import words

if TYPE_CHECKING:
    from coursework.figures import Figure, Picture
    from coursework.sheets.sheet import AnswerSheet, Handout, Question


@dataclass(frozen=True)
class ProsePiece:
    """Running text, Markdown."""

    text: str


@dataclass(frozen=True)
class HeadPiece:
    """A heading inside a lesson: ``level`` 1 for a section, 2 for a part of one; ``number`` of a numbered
    section, else 0."""

    text: str  #: Markdown of a line, without its number
    level: int
    number: int = 0


@dataclass(frozen=True)
class CodePiece:
    """Code that is printed, and may be run where there is a machine."""

    text: str


@dataclass(frozen=True)
class PrintedPiece:
    """Output that code has printed, letter by letter."""

    text: str


@dataclass(frozen=True)
class DrawnPiece:
    """A drawing: a figure, or an SVG; ``stills`` are the instants that stand on paper for one that moves."""

    said: str  #: what it shows, plain text
    caption: str = ""  #: Markdown
    figure: Figure | Picture | None = None
    svg: str = ""
    stills: tuple[str, ...] = ()
    tall: float = 0.0  #: mm that it may take on paper; 0 for the size of any other
    number: str = ""  #: 3.4: the fourth figure of the third lesson; empty in an example and in an answer
    example: str = ""  #: Example 3.2: that which it poses, if it is the first drawing of one
    #: Whether paper shows it too; what moves beside its own picture does not, and has no number.
    on_paper: bool = True


@dataclass(frozen=True)
class TablePiece:
    """Table, Markdown, with its number; one of a page outside the lessons has none."""

    text: str
    number: str

    @property
    def is_long(self) -> bool:
        """True if it is set in two columns of a page."""
        return self.text.count("\n") > _LONG


@dataclass(frozen=True)
class BoxPiece:
    """Definition or rule that stands in a box: its ``sort``, its number, its title, and its text
    (Markdown)."""

    sort: str  #: definition or rule
    number: str
    title: str
    text: str


@dataclass(frozen=True)
class JointRow:
    """Joint in its table: its symbol in perspective and in plan, then cells (Markdown)."""

    perspective: Figure
    plan: Figure
    cells: tuple[str, ...]


@dataclass(frozen=True)
class JointsPiece:
    """Table of joints with their symbols."""

    head: tuple[str, ...]
    rows: tuple[JointRow, ...]


@dataclass(frozen=True)
class LaterPiece:
    """Reference to a later question, by its number."""

    number: int


@dataclass(frozen=True)
class BlanksPiece:
    """Blanks of the worked example above it, for a page that marks what is typed in them; no paper shows it.

    ``exercise``, ``seed``, ``level`` and ``parts`` are those of the example; ``questions`` are the blanks,
    each with its number there and the name of its answer; ``posed`` and ``told`` are the counts of the pieces
    above it that pose the example, and of those that tell a part of its solution.
    """

    exercise: str
    seed: int
    level: int
    parts: tuple[str, ...]
    questions: tuple[tuple[int, str, Question], ...]
    posed: int
    told: int


Piece: TypeAlias = (
    ProsePiece
    | HeadPiece
    | CodePiece
    | PrintedPiece
    | DrawnPiece
    | TablePiece
    | BoxPiece
    | JointsPiece
    | LaterPiece
    | BlanksPiece
)


@dataclass(frozen=True)
class LessonText:
    """A lesson as a book prints it."""

    name: str
    #: Among the lessons of the course; 0 for a page before the first chapter or after the last one.
    number: int
    lang: str
    title: str
    pieces: tuple[Piece, ...]
    answers: tuple[tuple[int, tuple[Piece, ...]], ...]  #: by their numbers, which :class:`LaterPiece` names
    terms: tuple[str, ...] = ()  #: entries of the index
    words: tuple[str, ...] = ()  #: entries that the index has found in it


@dataclass(frozen=True)
class Drill:
    """Question of two minutes: its number, its grade from 1 on, where it was drawn, its text and its answer
    (Markdown)."""

    number: str
    grade: int
    exercise: str
    seed: int
    text: str
    answer: str
    quantity: str
    values: Mapping[str, object]  #: what it gives, by name
    result: float | str  #: what the answer says, with all digits, or a case
    asked: str  #: what it asks, without its numbers

    @property
    def kinds(self) -> tuple[str, str]:
        """Question and formula: drills that differ in their numbers alone share both."""
        return self.asked, f"{self.quantity} {sorted(self.values)}"

    @property
    def is_odd(self) -> bool:
        """True if its number is odd, so that a students' book has its answer."""
        return int(self.number.rpartition(".")[2]) % 2 == 1


@dataclass(frozen=True)
class DrillGroup:
    """Drills of a section that one exercise gives: the heading of the section, empty where the lesson has
    none; the exercise and its title; what a reader must know who has not its sheet (Markdown), where it is
    met first."""

    section: str
    exercise: str
    title: str
    setting: str
    drills: tuple[Drill, ...]


@dataclass(frozen=True)
class Judgement:
    """Sentence to be judged true or false: its number, and the reason of what it is (Markdown)."""

    number: str
    text: str
    is_true: bool
    reason: str
    is_odd: bool  #: whether a students' book has its answer


@dataclass(frozen=True)
class SummaryCard:
    """Summary of a lesson: its formulas, each a number and lines of LaTeX; conditions, sign rules and traps,
    Markdown."""

    lesson: LessonText
    formulas: tuple[tuple[str, tuple[str, ...]], ...]
    conditions: tuple[str, ...]
    signs: tuple[str, ...]
    traps: tuple[str, ...]

    @property
    def height(self) -> float:
        """About how many lines it takes."""
        formulas = sum(1 + 1.2 * len(lines) for _, lines in self.formulas)
        return 2 + formulas + sum(1 + sum(1 + len(one) // 60 for one in told) for _, told in self.rules)

    @property
    def rules(self) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """The conditions, sign rules and traps by their names, without those of which there are none."""
        named = (("conditions", self.conditions), ("signs", self.signs), ("traps", self.traps))
        return tuple(item for item in named if item[1])


@dataclass(frozen=True)
class BookExercise:
    """An exercise of a book: the variant that the book prints, and its solution."""

    number: str  #: 2.3: the third exercise of the second chapter
    handout: Handout
    solution: AnswerSheet
    lessons: tuple[tuple[str, str], ...] = ()  #: names and titles of the lessons that teach it

    @property
    def is_odd(self) -> bool:
        """True if its number is odd, so that a students' book has its answers."""
        return int(self.number.rpartition(".")[2]) % 2 == 1


@dataclass(frozen=True)
class BookSection:
    """A lesson and its exercises; one of the two may be missing."""

    lesson: LessonText | None
    exercises: tuple[BookExercise, ...]
    title: str = ""  #: where there is no lesson
    drill_groups: tuple[DrillGroup, ...] = ()
    judgements: tuple[Judgement, ...] = ()

    @property
    def drills(self) -> tuple[Drill, ...]:
        return tuple(drill for group in self.drill_groups for drill in group.drills)


@dataclass(frozen=True)
class BookChapter:
    number: int
    title: str
    sections: tuple[BookSection, ...]
    summary: tuple[SummaryCard, ...] = ()
    paper: tuple[BookExercise, ...] = ()  #: an examination paper on the chapter
    label: str = ""  #: its number, or the letter of an appendix
    sort: str = "chapter"  #: name of the words that name it: ``chapter`` or ``appendix``

    @property
    def paper_points(self) -> float:
        return sum(one.handout.points for one in self.paper)

    @property
    def paper_minutes(self) -> int:
        """The time of the paper, by half hours."""
        return 30 * math.ceil(self.paper_points * _MINUTES / 30)

    @property
    def summary_columns(self) -> tuple[tuple[SummaryCard, ...], ...]:
        """The cards of the summary in two columns of about one height."""
        heights = [card.height for card in self.summary]
        cut = min(
            range(1, len(heights) + 1), key=lambda k: max(sum(heights[:k]), sum(heights[k:])), default=0
        )
        return self.summary[:cut], self.summary[cut:]

    @property
    def exercises(self) -> tuple[BookExercise, ...]:
        return tuple(exercise for section in self.sections for exercise in section.exercises)

    @property
    def lessons(self) -> tuple[LessonText, ...]:
        return tuple(section.lesson for section in self.sections if section.lesson)


@dataclass(frozen=True)
class SymbolRow:
    """Symbol of quantities that are asked, what it means, and the exercises in which it means this."""

    symbol: str  #: LaTeX
    unit: str
    meaning: str  #: Markdown
    exercises: tuple[BookExercise, ...]


@dataclass(frozen=True)
class TitlePage:
    """Title page: author, edition and licence; empty where nothing is stated."""

    author: str = ""
    edition: str = ""
    licence: str = ""


@dataclass(frozen=True)
class SeeEntry:
    """Entry of the index that has no pages of its own, and the one to look at."""

    entry: str
    to: str


@dataclass(frozen=True)
class MachineEntry:
    """Machine in its index, and the names of the exercises that ask about it."""

    entry: str
    exercises: tuple[str, ...]


@dataclass(frozen=True)
class Book:
    """A course as one book, in a language."""

    lang: str
    title: str
    seed: int
    chapters: tuple[BookChapter, ...]
    solved: bool  #: whether the solutions stand at its end, and its pages lead to them
    title_page: TitlePage = TitlePage()
    front: tuple[LessonText, ...] = ()  #: pages before the first chapter
    back: tuple[LessonText, ...] = ()  #: pages after the last one
    see: tuple[SeeEntry, ...] = ()
    machines: tuple[MachineEntry, ...] = ()
    answers: str = ""  #: which short answers stand at its end: odd, all, or none

    @property
    def exercises(self) -> tuple[BookExercise, ...]:
        return tuple(exercise for chapter in self.chapters for exercise in chapter.exercises)

    @property
    def lessons(self) -> tuple[LessonText, ...]:
        return tuple(lesson for chapter in self.chapters for lesson in chapter.lessons)

    @property
    def sections(self) -> tuple[BookSection, ...]:
        return tuple(section for chapter in self.chapters for section in chapter.sections)

    @property
    def terms(self) -> Mapping[str, tuple[str, ...]]:
        """The names of the lessons that have each entry of the index."""
        terms: dict[str, tuple[str, ...]] = {}
        for lesson in self.lessons:
            for entry in dict.fromkeys((*lesson.terms, *lesson.words)):
                terms[entry] = (*terms.get(entry, ()), lesson.name)
        return terms

    @property
    def symbols(self) -> tuple[SymbolRow, ...]:
        """The symbols that questions define, with their meanings, in alphabetical order.

        A question defines its symbol where its first clause has it; in the meaning it is left out. Lengths
        between points and other expressions are none.
        """
        articles = words(self.lang)["book"]["articles"]
        symbols: dict[tuple[str, str, str], list[BookExercise]] = {}
        for exercise in self.exercises:
            for question in exercise.handout.questions:
                if question.kind not in _MEASURED or _EXPRESSION.search(question.symbol):
                    continue
                if meaning := _meaning(question.prompt, question.symbol, articles):
                    symbols.setdefault((question.symbol, question.unit, meaning), []).append(exercise)
        ordered = sorted(symbols, key=lambda row: (_letters(row[0]).casefold(), row))
        return tuple(SymbolRow(*row, tuple(symbols[row])) for row in ordered)


_MINUTES = 4  #: that a point of a paper takes
_LONG = 60  #: rows of a table that takes two columns
_MEASURED = ("number", "integer", "angle")  #: the kinds of a quantity
_EXPRESSION = re.compile(r"[+/=]|(?<!dot) ")  #: a symbol that is none: a sum, a quotient, two points
_CLAUSE = re.compile(r"^(.*?)(?:[.,;:](?=\s|$)|$)", re.DOTALL)
_FORMULA = re.compile(r"\s*\$([^$]+)\$")


def _letters(symbol: str) -> str:
    """Return a formula without what two spellings of it differ by, and without the mark of a command."""
    return re.sub(r"[\\{}\s]", "", symbol)


def _meaning(prompt: str, symbol: str, articles: Sequence[str]) -> str:
    """Return the first clause without its symbol and its article, or nothing where it has no such symbol."""
    clause = _CLAUSE.match(" ".join(prompt.split()))
    for formula in _FORMULA.finditer(clause[1] if clause else ""):
        if clause and _letters(formula[1]) == _letters(symbol):
            meaning = (clause[1][: formula.start()] + clause[1][formula.end() :]).strip()
            meaning = next(
                (meaning.removeprefix(article) for article in articles if meaning.startswith(article)),
                meaning,
            )
            return meaning[:1].upper() + meaning[1:]
    return ""
