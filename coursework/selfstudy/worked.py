"""Worked solutions of other variants: complete, with blanks, bare; and the questions that another variant
asks the same."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coursework.course.answer_keys import answer_keys
from coursework.course.exercise import ALL, USUAL
from coursework.errors import BadCourse, CourseworkError, Starved, WrongValue, unknown
from coursework.issuing.issuing import distinct_variants
from coursework.language.words import words
from coursework.marking.marking import mark as grade
from coursework.markup.shown import NotebookDisplay, SvgPicture
from coursework.messages import Message
from coursework.rendering.views import ROOM_ALONE, ROOM_BESIDE, offered
from coursework.selfstudy import hints
from coursework.selfstudy.attempt import sentence_of, sign_of
from coursework.sheets.answer_sheet import answer_sheet, answer_text, question_called
from coursework.sheets.book import BlanksPiece
from coursework.sheets.handout import handout

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.course.exercise import CourseExercise
    from coursework.course.variant import Variant
    from coursework.model import Part
    from coursework.sheets.sheet import Question, Step


_SAMPLE = range(48)  #: what changes in one variant of six is met in all but one sample of five thousand


@lru_cache(maxsize=64)
def theory(exercise: CourseExercise[Any]) -> frozenset[str]:
    """Return the ids of the parts that every variant asks with the same reference.

    None in an exercise with such parts alone. A question that only some variants ask is excluded, since it
    rotates; one that is judged together with others is asked with them.
    """
    requested = exercise.variants(_SAMPLE)
    always = [p for p in requested[0].parts if all(p.id in v.part_ids for v in requested)]
    same = frozenset(p.id for p in always if p.id in unchanging(exercise) and not p.judge)
    return frozenset() if len(same) == len(requested[0].parts) else same


@lru_cache(maxsize=64)
def unchanging(exercise: CourseExercise[Any]) -> frozenset[str]:
    """Return the ids of the parts with the same reference in every variant that asks them."""
    variants = exercise.variants(_SAMPLE)
    judged = (p for p in exercise.spec.parts if not p.sort.is_open)
    return frozenset(
        p.id for p in judged if _is_same([v for v in variants if p.id in v.part_ids], p.quantity)
    )


def _is_same(variants: list[Variant], quantity: str) -> bool:
    values = []
    for variant in variants:
        try:
            values.append(variant.quantities([quantity])[quantity])
        except CourseworkError:
            return False
    return all(_agree(value, values[0]) for value in values)


def _agree(first: Any, other: Any) -> bool:
    """Return whether two references are equal up to the last digits."""
    if isinstance(first, (int, float, complex, np.ndarray, list, tuple)):
        try:
            return bool(np.allclose(first, other, rtol=1e-9, atol=1e-9))
        except (TypeError, ValueError):
            return False
    return bool(first == other)


def without_theory(variant: Variant) -> Variant:
    """Return the variant without the questions that another variant has already asked."""
    theory_steps = theory(variant.exercise)
    return variant.asking([p for p in variant.parts if p.id not in theory_steps]) if theory_steps else variant


_ANNOUNCES = re.compile(r"[^.!?]*:")  # nothing but what comes next

LEVELS = 4
WITH_FORMULA = 2  #: levels up to which a blank still shows its formula
_FAR = 100_000  #: seeds away from those of fresh variants, so that no example is one of them
_APART = 1_000  #: seeds between levels


def example_variant(variant: Variant, base: int, level: int) -> Variant:
    """Return the variant for an example of a level, different from the attempted ones and from those of other
    levels.

    Raises
    ------
    Starved
        The exercise has no other variant.
    """
    first = base + _FAR + _APART * level
    others = distinct_variants(variant.exercise, first, 2, variant.lang)
    other = next((v for v in others if v.given != variant.given), None)
    if other is None:
        raise Starved(variant.exercise.name)
    return other


def has_example(variant: Variant) -> bool:
    """Return whether the solution has something to leave blank."""
    return bool(blanks(variant, 1))


def blanks(variant: Variant, level: int, *, in_lesson: bool = False) -> tuple[Part, ...]:
    """Return the questions left blank at a level: the last one, a third, two thirds, all; in the order of the
    solution.

    A study session excludes a question with the same answer in every variant, since it would give away the
    attempted one, and parts that are judged together. A lesson may leave both blank: parts judged together
    count as one question.
    """
    places = {step.name: k for k, step in enumerate(_steps(variant))}
    may_be = _may_be_blank_in_lesson if in_lesson else _may_be_blank
    requested = _together([p for p in variant.parts if p.quantity in places and may_be(variant, p)], places)
    count = (1, math.ceil(len(requested) / 3), math.ceil(2 * len(requested) / 3), len(requested))[level - 1]
    return tuple(chain.from_iterable(requested[max(0, len(requested) - count) :]))


def _may_be_blank_in_lesson(variant: Variant, part: Part) -> bool:
    return not part.sort.is_open


def _may_be_blank(variant: Variant, part: Part) -> bool:
    if part.sort.is_open or part.judge or part.loop:
        return False
    return part.id not in unchanging(variant.exercise)


def _together(parts: Iterable[Part], places: Mapping[str, int]) -> list[list[Part]]:
    """Group the parts that are judged together, in the order of the solution, at the position of the
    first."""
    groups: dict[tuple[str, str], list[Part]] = {}
    for part in sorted(parts, key=lambda p: places[p.quantity]):
        judge = part.judge or part.loop
        groups.setdefault((judge, "" if judge else part.id), []).append(part)
    return list(groups.values())


def _steps(variant: Variant) -> Sequence[Step]:
    return answer_sheet(variant, polygons=False).steps


def _blank(variant: Variant, part: Part, step: Step, keys: Mapping[str, str], text: Any) -> str:
    """Return the room for an answer, after its symbol, or after the number of its question where no symbol
    names it."""
    form = text["blank" if part.sort.has_symbol else "unnamed"]
    question, key = question_called(variant, part), f"`{keys[part.id]}`"
    return str(form.format(symbol=f"${step.symbol}$", question=question, key=key))


def steps_text(
    variant: Variant,
    level: int,
    left: Sequence[Part],
    keys: Mapping[str, str],
    text: Any,
    *,
    in_lesson: bool = False,
) -> str:
    """Return the steps of the solution as Markdown: complete up to the first blank, without numbers from
    there on.

    A study session leaves out steps with the same answer in every variant, since they are asked.
    """
    by_quantity = {p.quantity: p for p in left}
    shared = () if in_lesson else unchanging(variant.exercise)
    hidden = {p.quantity for p in variant.parts if p.id in shared}
    lines: list[str] = []
    is_whole = True
    for step in _steps(variant):
        if step.name in hidden:
            continue
        part = by_quantity.get(step.name)
        is_whole = is_whole and part is None
        if is_whole:
            pieces = [hints.step_text(step)]
        else:
            formula = hints.formula(variant, step.name) if level <= WITH_FORMULA or part is None else ""
            if not (part or formula) and _ANNOUNCES.fullmatch(step.words.strip()):
                continue
            blank = _blank(variant, part, step, keys, text) if part else ""
            pieces = [hints.words_of(variant, step.name), formula, blank]
        if any(pieces):
            lines.append("\n\n".join(filter(None, pieces)))
    return "\n\n".join(lines)


_ROOM = ROOM_BESIDE[0], ROOM_ALONE[1]  #: of the figure, mm
BARE = LEVELS  #: the level that tells nothing but what is asked


class BlankMark(NamedTuple):
    """Mark of an answer to a blank: its sign, and a sentence of Markdown."""

    sign: str
    sentence: str
    is_right: bool


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
        return f"{named_question(question)}{cases}"

    def _solution_text(self) -> str:
        """Return the part of the solution that is shown."""
        if self.level == BARE:
            return ""
        title = f"**{words(self.lang)['lesson']['solution']}.**"
        wanted = {part.quantity for part in self.parts}
        if not self.level:
            return "\n\n".join([title, *map(hints.step_text, _leading_to(self._asking, wanted))])
        texts = words(self.lang)["lesson"]
        text = steps_text(self._asking, self.level, self.left, self._keys, texts, in_lesson=True)
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
        marks = self.marks({**(answers or {}), **named})
        lines = (f"- {mark.sign} `{name}` — {mark.sentence}" for name, mark in marks.items())
        return NotebookDisplay(self.lang, "\n".join(lines))

    def marks(self, answers: Mapping[str, Any]) -> Mapping[str, BlankMark]:
        """Return the marks of answers to the blanks, by the names of their answers; those of blank ones are
        left out.

        Raises
        ------
        UnknownName
            An answer to a question that is not left.
        """
        by_key = {self._keys[part.id]: part.id for part in self.left}
        for name in answers:
            if name not in by_key and name not in by_key.values():
                raise unknown("question", name, tuple(by_key), self.variant.exercise.name)
        requested = self._asking
        marking = grade(requested, {by_key.get(name, name): answer for name, answer in answers.items()})
        return {
            self._keys[mark.part]: BlankMark(
                sign_of(mark), sentence_of(requested, mark, ""), mark.verdict == "correct"
            )
            for mark in marking.values()
            if mark.verdict != "missing"
        }

    @property
    def blanks_piece(self) -> BlanksPiece | None:
        """Blanks that a page can mark; None where nothing is left."""
        numbers = {part.id: k for k, part in enumerate(self.parts, 1)}
        questions = {q.id: q for q in handout(self._asking).questions if not q.is_open}
        left = [part for part in self.left if part.id in questions]
        if not left:
            return None
        return BlanksPiece(
            self.variant.exercise.name,
            self.variant.seed,
            self.level,
            tuple(part.id for part in self.parts),
            tuple((numbers[part.id], self._keys[part.id], questions[part.id]) for part in left),
            len(self.pieces) - (self.level != BARE),
            int(self.level != BARE),
        )


def named_question(question: Question) -> str:
    """Return a question with its unit, and its symbol where the words lack it."""
    prompt = " ".join(question.prompt.split())
    if not question.symbol:
        return prompt
    unit = f" ({question.unit})" if question.unit else ""
    first, *rest = re.split(r"(?=[.?](?:\s|$))", prompt, maxsplit=1)
    bare, symbol = (re.sub(r"[{}\s]", "", text) for text in (first, question.symbol))
    if f"${symbol}$" in bare or f"${symbol}=" in bare:
        return f"{first}{unit}{''.join(rest)}"
    if prompt.endswith(".") and len(rest) == 1:
        return f"{first}, ${question.symbol}${unit}."
    return f"{prompt} ${question.symbol}${unit}"


def _leading_to(variant: Variant, wanted: set[str]) -> list[Step]:
    """Return the steps of the solution that lead to some quantities."""
    graph = variant.exercise.solution.graph
    met = graph.walk(sorted(wanted & graph.names), variant.used, variant.effects)
    needed = wanted | set(met)
    return [step for step in answer_sheet(variant, polygons=False).steps if step.name in needed]


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
        raise WrongValue(
            "a worked example has a level from 0 (complete) to {most} (no steps); found {level!r}",
            most=BARE,
            level=level,
        )
    opened = course[exercise]
    opened.solution  # noqa: B018  what has none is refused here
    chosen = opened.chosen_parts(parts or None)
    variant = opened.variant(seed, lang, None if chosen is None else (USUAL, *(p.id for p in chosen)))
    by_id = {part.id: part for part in variant.parts}
    for part in parts:
        if part not in {*by_id, USUAL, ALL}:
            raise unknown(
                "part",
                part,
                tuple(by_id),
                Message("{exercise}, variant {seed}", exercise=exercise, seed=seed),
            )
    requested = variant.parts if chosen is None else [part for part in chosen if part.id in by_id]
    return WorkedExample(variant, level, requested)


@lru_cache(maxsize=64)
def _explained(exercise: Any, name: str, lang: str, seed: int) -> str:
    if name not in exercise.solution.mistakes:
        raise unknown(
            "mistake",
            name,
            exercise.solution.mistakes,
            Message("solution {exercise}", exercise=exercise.name),
        )
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
