"""A paper: several exercises handed out, solved or marked as one thing, under one heading."""

from __future__ import annotations

from dataclasses import dataclass

from coursework.language.words import words
from coursework.sheets.answer_pages import AnswerPage
from coursework.sheets.sheet import AnswerSheet, FeedbackSheet, Handout


@dataclass(frozen=True)
class Logo:
    """A picture at the head of a paper."""

    data: bytes
    format: str  #: svg or png
    alt: str


@dataclass(frozen=True)
class PaperHeading:
    """Heading of a paper, in its language."""

    lang: str
    title: str
    course: str
    student: str  #: name or code; empty when the paper is nobody's
    #: What is called so, and what is printed; empty: a box to fill in by hand.
    identity: tuple[tuple[str, str], ...] = ()
    date: str = ""
    duration: str = ""
    instructions: str = ""  #: Markdown
    version: str = ""  #: A to D, where versions are dealt out
    logo: Logo | None = None
    cover: bool = False  #: a page of its own
    mark_of: str = ""  #: what the mark is out of, as printed; empty where only points count
    is_code: bool = False  #: a code stands in place of the name

    @property
    def name_word(self) -> str:
        """The word before the name, or before the code that stands in its place."""
        texts = words(self.lang)
        return str(texts["exam"]["code"] if self.is_code else texts["sheet"]["name"])


@dataclass(frozen=True)
class Paper:
    """All that a student's paper shows."""

    heading: PaperHeading
    handouts: tuple[Handout, ...]
    work_mm: tuple[int, ...] = ()  #: height of the room for the reasoning after each exercise; 0: none

    @property
    def answer_pages(self) -> tuple[AnswerPage, ...]:
        """Return the answer pages, if the paper is not answered between its lines."""
        return self.handouts[0].answer_pages if self.handouts else ()

    @property
    def points(self) -> float:
        return sum(handout.points for handout in self.handouts)


@dataclass(frozen=True)
class SolutionPaper:
    """A paper with its answers and worked solutions."""

    heading: PaperHeading
    sheets: tuple[AnswerSheet, ...]


@dataclass(frozen=True)
class FeedbackPaper:
    """A student's marks on a paper, or on several exercises that were handed out one by one."""

    heading: PaperHeading
    sheets: tuple[FeedbackSheet, ...]
    points: float
    out_of: float
    mark: str = ""  #: as printed, 14.5; empty where only points count
    answers: bool = True  #: whether the right answers are shown
    advice: tuple[str, ...] = ()  #: what to look at next, Markdown
    places: tuple[int, ...] = ()  #: numbers of its exercises on the paper; 1, 2, … where all are shown
    numbered: bool = True  #: questions are 1.1, 1.2 as on a paper; else as on the sheet of each exercise
    open: int = 0  #: answers that wait for a person; until then the mark is provisional
