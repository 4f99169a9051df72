"""Classes of a sheet: a handout for the student, an answer sheet for the staff.

A :class:`Handout` has no field for an answer: what a student receives is rendered from
a type that cannot hold one. Texts are Markdown with ``$LaTeX$`` in the sheet's language;
numbers inside formulas are written ``\\num{228.6}``, always with a point, and each back
end prints them as the language does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from coursework.course.lessons import Lesson as Lesson

if TYPE_CHECKING:
    from coursework.figures import Figure, Picture
    from coursework.figures.polygons.construction import Construction
    from coursework.figures.polygons.own_drawing import OwnDrawing
    from coursework.kinds.kind import ComponentBox
    from coursework.sheets.answer_pages import AnswerPage


@dataclass(frozen=True)
class GivenValue:
    """One given quantity, as printed."""

    name: str  #: public name, ``theta2``
    symbol: str  #: LaTeX, ``\theta_2``
    value: str  #: with a decimal point, ``228.6``; a label in the sheet's language for a choice
    unit: str  #: unit as the language prints it, ``mm``, ``°``; empty for a ratio or a choice
    is_number: bool = True


@dataclass(frozen=True)
class Question:
    """One part of the exercise."""

    number: int
    id: str
    symbol: str  #: LaTeX of the quantity asked; empty when a symbol says nothing (a choice)
    prompt: str  #: Markdown
    unit: str  #: printed beside the answer box; empty if none
    kind: str  #: a file of :mod:`coursework.kinds`
    #: (key, label) pairs of a choice, in the order printed; no sheet shows a key.
    choices: tuple[tuple[str, str], ...]
    points: float
    tolerance: str  #: in words a student understands; empty for exact kinds
    is_exact: bool = False  #: judged without a margin
    is_open: bool = False  #: a person marks it: what is written is prose, or a drawing
    box: str = "usual"  #: room for the answer: usual, wide, line, several, lines, blank, millimetre
    hint: str = ""  #: the form of an answer, where the engine's words have none for the kind
    asks_unit: bool = False  #: the answer is to come with its unit, which the sheet does not print
    rule: str = ""  #: how its points are counted, in words, where that is not plain
    #: Lines to write on, or width and height in mm of a box to draw in.
    room: int | tuple[int, int] | None = None
    judge: str = ""  #: of the parts that are judged together with this one
    letters: tuple[str, ...] = ()  #: of the choices; none of a sheet that was issued without
    key: str = ""  #: what a notebook calls its answer; by default its id
    #: Above a telephone's keyboard: what a key shows, and what it types.
    keys: tuple[tuple[str, str], ...] = ()
    types_numbers: bool = False  #: a keyboard of numbers does, with these keys
    cells: tuple[tuple[ComponentBox, ...], ...] = ()  #: boxes for its components on a page, in groups
    cells_form: str = ""  #: the text that they make, ``({} ; {})``


@dataclass(frozen=True)
class Handout:
    """All that a student's sheet shows."""

    lang: str
    course: str  #: title of the course
    exercise: str
    version: int
    seed: int
    student: str  #: empty when the sheet is nobody's
    title: str
    statement: str  #: Markdown
    given: tuple[GivenValue, ...]
    figure: Figure | Picture | None
    figure_alt: str
    questions: tuple[Question, ...]
    record: Mapping[str, object]  #: the variant's JSON record
    more_figures: tuple[tuple[Figure | Picture, str], ...] = ()  #: besides the first, each with what it shows
    drawing_mm: tuple[int, int] | None = None  #: width and height of the box to draw in, where there is one
    #: The same of the drawing surface of a page, where nothing is printed.
    surface_mm: tuple[int, int] | None = None
    #: Behind the statement, or the paper that it is of, where it is answered there.
    answer_pages: tuple[AnswerPage, ...] = ()

    @property
    def points(self) -> float:
        return sum(q.points for q in self.questions)


@dataclass(frozen=True)
class Remark:
    """A known mistake that lurks at a step."""

    words: str  #: Markdown
    #: What it gives in place of the right value, as Markdown; empty where that is not a number and no case.
    wrong: str = ""


@dataclass(frozen=True)
class Step:
    """One quantity of the worked solution: formula, numbers put in, value."""

    name: str
    symbol: str
    formula: str  #: LaTeX of the right-hand side; empty when words say it
    substitution: str  #: the same with this variant's numbers; empty if none
    value: str  #: LaTeX of the value with its unit, ``\num{319.8}\ \mathrm{mm}``
    words: str  #: Markdown from the solution's text, before the formula
    remarks: tuple[Remark, ...]  #: those that are mistakes in this variant
    asked: bool


@dataclass(frozen=True)
class Answer:
    """The reference answer of one question, as the staff reads it."""

    question: Question
    text: str  #: Markdown, rounded for print
    margin: str  #: the accepted half-width with its unit, or empty


@dataclass(frozen=True)
class AnswerSheet:
    """A handout with its answers and its worked solution."""

    handout: Handout
    answers: tuple[Answer, ...]
    steps: tuple[Step, ...]
    introduction: str  #: Markdown, the solution text's opening words
    figure: Figure | None  #: the solution's own figure, if it has one
    figure_alt: str = ""  #: what that figure shows; empty when the handout's words say it
    polygons: tuple[Construction, ...] = ()  #: of velocities and accelerations


@dataclass(frozen=True)
class FeedbackLine:
    """Feedback on one answer."""

    question: Question
    answer: str  #: the student's text as it came
    read_as: str
    verdict: str
    points: float
    out_of: float
    says: str  #: Markdown, a sentence that helps and gives no reference value
    right: str = ""  #: the right answer, Markdown, where it may be shown
    hint: str = ""  #: what to look at, Markdown, where points were lost
    read: str = ""  #: ``read_as`` as Markdown, where what was read has formulas


@dataclass(frozen=True)
class Practice:
    """Variant to try after an exercise in which points were lost."""

    exercise: str
    version: int
    course: str  #: name of the course's folder; empty for the course that the package brings
    #: Of a variant that was issued to nobody; none where there is no other, or none is offered.
    seed: int | None
    lessons: tuple[Lesson, ...] = ()
    questions: tuple[Question, ...] = ()  #: of that variant


@dataclass(frozen=True)
class FeedbackSheet:
    """A student's marks on one exercise."""

    handout: Handout
    lines: tuple[FeedbackLine, ...]
    points: float
    out_of: float
    practice: Practice | None = None
    solution: AnswerSheet | None = None  #: of the student's own variant, once it may be shown
    #: The student's over the right ones, once the solution may be shown.
    drawings: tuple[OwnDrawing, ...] = ()


@dataclass(frozen=True)
class Ask:
    """A prediction to make: what it is written under, the question (Markdown), and what may be written (plain
    text)."""

    id: str
    question: str
    options: str


@dataclass(frozen=True)
class StudySheet:
    """All that a self-study notebook shows; like its handout it holds no answer."""

    handout: Handout
    file: str  #: where answers are kept, beside the notebook
    package: str  #: the distribution that brings the package
    install: str  #: the command that installs it
    course: str  #: name of the course's folder; empty for the course that the package brings
    before: tuple[Ask, ...]  #: predictions before any computation
    cycle: tuple[Ask, ...]  #: predictions before the curves
    moves: bool  #: whether there are curves over a cycle
    animates: bool  #: whether the mechanism can be shown in motion
    questions: tuple[Question, ...]  #: of the first fresh variant; none where there is no other variant
    theory: frozenset[str] = frozenset()  #: ids of questions that no other variant asks anew
    has_example: bool = False  #: whether the solution of another variant can be shown with blanks
    lessons: tuple[Lesson, ...] = ()  #: that teach it
    #: The lessons whose notebooks stand beside it: links lead to these alone.
    beside: frozenset[str] = frozenset()
