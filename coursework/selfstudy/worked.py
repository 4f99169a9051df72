"""Worked examples of a lesson: a variant with its complete solution, then with blanks, then bare; and the
mistakes to expect."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from coursework.course.answer_keys import answer_keys
from coursework.course.exercise import ALL, USUAL
from coursework.errors import BadCourse, WrongValue, unknown
from coursework.language.words import words
from coursework.marking.marking import mark as grade
from coursework.markup.shown import NotebookDisplay, SvgPicture
from coursework.rendering.views import ROOM_ALONE, ROOM_BESIDE, chain_on_lines, offered
from coursework.selfstudy import hints
from coursework.selfstudy.answers import sentence_of, sign_of
from coursework.selfstudy.examples import LEVELS, blanks, told_steps
from coursework.sheets.answer_sheet import answer_sheet, answer_text
from coursework.sheets.handout import handout

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.course.variant import Variant
    from coursework.model import Part
    from coursework.sheets.sheet import Question, Step

_ROOM = ROOM_BESIDE[0], ROOM_ALONE[1]  #: of the figure, mm
BARE = LEVELS  #: the level that tells nothing but what is asked


class WorkedExample(NotebookDisplay):
    """Worked example, for display in a cell; :meth:`check` marks the answers in its blanks."""

    def __init__(self, variant: Variant, level: int, parts: Sequence[Part]):
        self.variant, self.level, self.parts, self.lang = variant, level, tuple(parts), variant.lang
        self.left = self._left
        super().__init__(variant.lang, *self._posed(), self._solution_text())

    @property
    def _left(self) -> tuple[Part, ...]:
        """Questions left to the reader."""
        if self.level == BARE:
            return self.parts
        return blanks(self._asking, self.level, in_lesson=True) if self.level else ()

    @property
    def _keys(self) -> Mapping[str, str]:
        return answer_keys(self.parts)  # questions are numbered as they stand here

    def _posed(self) -> list[str | SvgPicture]:
        """Return the statement, the figure, the data, and the questions."""
        sheet, text = handout(self._asking), words(self.lang)["sheet"]
        texts = words(self.lang)["lesson"]["levels"]
        head = texts["whole" if not self.level else "bare" if self.level == BARE else "part"]
        pieces: list[str | SvgPicture] = [f"**{head}{text['colon']} {sheet.title}.** {sheet.statement}"]
        if sheet.figure is not None:
            pieces.append(SvgPicture(sheet.figure.fitted(*_ROOM).outlined_svg(), sheet.figure_alt))
        pieces += [SvgPicture(figure.outlined_svg(), alt) for figure, alt in sheet.more_figures]
        given = ", ".join(hints._given(self.variant, g.name) for g in sheet.given)
        if given:
            pieces.append(f"**{text['data']}{text['colon']}** {given}.")
        wanted = {part.id for part in self.parts}
        requested = [self._asked(q) for q in sheet.questions if q.id in wanted]
        numbered = [f"{k}. {item}" for k, item in enumerate(requested, 1)]
        return [*pieces, "\n".join(numbered)]

    def _asked(self, question: Question) -> str:
        # A letter is the mark of its line: a bullet before it would be a second one.
        cases = "".join(
            f"\\\n   {letter}) {label}" if letter else f"\n   - {label}"
            for letter, label in offered(question)
        )
        return f"{_named(question)}{cases}"

    def _solution_text(self) -> str:
        """Return the part of the solution that is shown."""
        if self.level == BARE:
            return ""
        title = f"**{words(self.lang)['lesson']['solution']}.**"
        wanted = {part.quantity for part in self.parts}
        if not self.level:
            return "\n\n".join([title, *map(_step, _leading_to(self._asking, wanted))])
        texts = words(self.lang)["lesson"]
        text = told_steps(self._asking, self.level, self.left, self._keys, texts, in_lesson=True)
        return f"{title}\n\n{text}"

    @property
    def _asking(self) -> Variant:
        return self.variant.asking(self.parts)

    @property
    def right(self) -> tuple[str, ...]:
        """Right answers to the blanks, one line of Markdown each."""
        questions = {q.id: q for q in handout(self.variant).questions}
        values = self.variant.walk
        return tuple(
            self._right(questions[part.id], answer_text(self.variant, part, values)) for part in self.left
        )

    def _right(self, question: Question, text: str) -> str:
        if question.symbol:
            return f"${question.symbol}$ = {text}"
        return f"{' '.join(question.prompt.split())} **{text}**"

    def check(self, answers: Mapping[str, Any] | None = None, /, **named: Any) -> NotebookDisplay:
        """Mark answers to the blanks, by the name of the question; blank ones are ignored.

        Raises
        ------
        UnknownName
            An answer to a question that is not left.
        """
        given = {**(answers or {}), **named}
        by_key = {self._keys[part.id]: part.id for part in self.left}
        for name in given:
            if name not in by_key and name not in by_key.values():
                raise unknown("question", name, tuple(by_key), self.variant.exercise.name)
        requested = self._asking
        marking = grade(requested, {by_key.get(name, name): answer for name, answer in given.items()})
        lines = (
            f"- {sign_of(mark)} `{self._keys[mark.part]}` — {sentence_of(requested, mark, '')}"
            for mark in marking.values()
            if mark.verdict != "missing"
        )
        return NotebookDisplay(self.lang, "\n".join(lines))


def _named(question: Question) -> str:
    """Return a question with its unit, and its symbol where the words lack it."""
    prompt = " ".join(question.prompt.split())
    if not question.symbol:
        return prompt
    unit = f" ({question.unit})" if question.unit else ""
    first, *rest = re.split(r"(?=[.?](?:\s|$))", prompt, maxsplit=1)
    bare, symbol = (re.sub(r"[{}\s]", "", text) for text in (first, question.symbol))
    if f"${symbol}$" in bare or f"${symbol}=" in bare:
        return f"{first}{unit}{''.join(rest)}"
    return f"{prompt} ${question.symbol}${unit}"


def _leading_to(variant: Variant, wanted: set[str]) -> list[Step]:
    """Return the steps of the solution that lead to some quantities."""
    graph = variant.exercise.solution.graph
    met = graph.walk(sorted(wanted & graph.names), variant.used, variant.effects)
    needed = wanted | set(met)
    return [step for step in answer_sheet(variant, polygons=False).steps if step.name in needed]


def _step(step: Step) -> str:
    return "\n\n".join(filter(None, [step.words, f"$${chain_on_lines(step)}$$" if step.value else ""]))


def worked(
    course: Course[Any], exercise: str, seed: int, lang: str, level: int, parts: Sequence[str]
) -> WorkedExample:
    """Return a variant as a worked example.

    Raises
    ------
    UnknownName
        No such exercise, or a part that the variant does not ask.
    WrongValue
        No such level.
    NoSolution
        The course folder has no solutions.
    """
    if level not in range(BARE + 1):
        raise WrongValue(f"a worked example has a level from 0, the whole, to {BARE}, bare; found {level!r}")
    opened = course[exercise]
    opened.solution  # noqa: B018  what has none is refused here
    chosen = opened.chosen_parts(parts or None)
    variant = opened.variant(seed, lang, None if chosen is None else (USUAL, *(p.id for p in chosen)))
    by_id = {part.id: part for part in variant.parts}
    for part in parts:
        if part not in {*by_id, USUAL, ALL}:
            raise unknown("part", part, tuple(by_id), f"{exercise}, variant {seed}")
    requested = variant.parts if chosen is None else [part for part in chosen if part.id in by_id]
    return WorkedExample(variant, level, requested)


@lru_cache(maxsize=64)
def _explained(exercise: Any, name: str, lang: str, seed: int) -> str:
    if name not in exercise.solution.mistakes:
        raise unknown("mistake", name, exercise.solution.mistakes, f"solution {exercise.name}")
    section = exercise.variant(seed, lang).solution_text.sections.get(f"mistake {name}")
    if section is None:
        raise BadCourse(f"{exercise.name}: the solution's text has no section 'mistake {name}'")
    return " ".join(section.text.split())


def mistakes(
    course: Course[Any], exercise: str, names: Sequence[str], lang: str, seed: int
) -> NotebookDisplay:
    """Return the messages for an exercise's named mistakes, one line each.

    Raises
    ------
    UnknownName
        No such exercise, or no such mistake of it.
    """
    return NotebookDisplay(
        lang, "\n".join(f"- {_explained(course[exercise], name, lang, seed)}" for name in names)
    )
