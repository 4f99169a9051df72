"""Card of one question on a student's variant: the task, the data, the reference, and the answers compared
with it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import cached_property, lru_cache
from typing import Any

from coursework.course.course import Course
from coursework.course.key_batch import keys_of
from coursework.course.marking_rules import Rules
from coursework.course.variant import Variant
from coursework.errors import BadInput, CourseworkError
from coursework.gradebook.class_marking import rules_of
from coursework.gradebook.decisions import ACCEPTED, GIVEN, KEPT, WITHDRAWN, points_of
from coursework.gradebook.graded_sheet import Graded
from coursework.issuing.issued import Issued
from coursework.language.numbers import localise, significant, unit_text
from coursework.language.words import quoted
from coursework.marking.mark import WAITING, Mark
from coursework.model import Part
from coursework.sheets.answer_sheet import answer_text
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Handout, Question
from coursework.site.frame.requests import HTTPException, Request
from coursework.site.frame.times import moment_text

_HALF = 1.0  #: points from which the step is half a point; below, it is half of the part's points
_KINDS = {"accept": ACCEPTED, "keep": KEPT, "withdraw": WITHDRAWN}
_STEPS = 12  #: maximum number of buttons


@dataclass(frozen=True)
class QuestionCard:
    """Question of a student's variant, as staff see it."""

    variant: Variant
    part: Part

    @cached_property
    def handout(self) -> Handout:
        return handout(self.variant)

    @cached_property
    def question(self) -> Question:
        return next(q for q in self.handout.questions if q.id == self.part.id)

    @cached_property
    def reference(self) -> str:
        """Right answer in Markdown; for an open question, the model answer if the solution has one."""
        if self.part.sort.is_open:
            section = self.variant.solution_text.sections.get(self.part.id)
            return section.text if section is not None else ""
        try:
            return answer_text(self.variant, self.part, self.variant.walk)
        except CourseworkError as fault:
            return str(fault)

    @cached_property
    def half_width(self) -> str:
        """Accepted half-width with its unit; empty if there is none."""
        if not self.part.has_margin or not self.part.sort.rounds or self.part.sort.is_open:
            return ""
        lang = self.variant.lang
        width = localise(significant(self.variant.key.half_width(self.part), 2), lang)
        unit = unit_text(self.part.unit, lang)
        return width + (unit if unit == "°" else f" {unit}" if unit else "")

    @property
    def prompt(self) -> str:
        return self.question.prompt

    @property
    def has_figure(self) -> bool:
        return self.handout.figure is not None


def question_card(course: Course, issued: Issued, graded: Graded, part: str, lang: str) -> QuestionCard:
    """Return the question of an answer, in the reader's language if its exercise has it."""
    exercise = course[graded.exercise]
    issued_lang = str(graded.record.get("lang", ""))
    spoken = lang if lang in exercise.languages else issued_lang
    return _question_card(_Hashed(course, rules_of(course, issued), {**graded.record, "lang": spoken}), part)


class _Hashed:
    """Hashable record of a variant, for the caches."""

    def __init__(self, course: Course, rules: Rules | None, record: Mapping[str, Any]):
        self.course, self.rules, self.record = course, rules, record
        self._key = id(course), repr(rules), json.dumps(record, sort_keys=True, default=repr)

    def __hash__(self) -> int:
        return hash(self._key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Hashed) and self._key == other._key


@lru_cache(maxsize=512)
def _variant(of: _Hashed) -> Variant:
    exercise = of.course[of.record["exercise"]]
    variant = exercise.from_record(of.record)
    if not all(part.sort.is_open for part in variant.parts):
        keys_of(exercise, [variant], of.rules)
    return variant


@lru_cache(maxsize=512)
def _question_card(of: _Hashed, part: str) -> QuestionCard:
    variant = _variant(of)
    return QuestionCard(variant, next(p for p in variant.parts if p.id == part))


def steps(out_of: float) -> tuple[float, ...]:
    """Return the points offered as buttons: halves, or whole points if there are many; half the points of a
    part that is worth less."""
    step = 0.5 if out_of >= _HALF else out_of / 2
    while out_of / step > _STEPS:
        step *= 2
    count = int(out_of / step + 1e-9)
    values = [step * k for k in range(count + 1)]
    return tuple(values if abs(values[-1] - out_of) < 1e-9 else [*values, out_of])


def sign_of(mark: Mark) -> str:
    """Return the state of an answer for a table: ``full``, ``part``, ``none``, ``wait`` or ``missing``; empty
    where it does not count."""
    if mark.verdict == "missing":
        return "missing"
    if mark.verdict in WAITING:
        return "wait"
    if not mark.out_of and not mark.points:
        return ""  # it does not count
    if mark.points >= mark.out_of:
        return "full"
    return "part" if mark.points > 0 else "none"


def moment(at: datetime, lang: str) -> str:
    """Return a time to the minute."""
    return moment_text(at.replace(second=0, microsecond=0), lang)


def decided_words(request: Request, decision: Any, at: datetime) -> str:
    """Return a line on a decision: its kind, its author and its time."""
    texts = request.words["queue"]["made"]
    points = localise(f"{decision.points or 0:g}", request.lang)
    line = str(texts[decision.kind]).format(by=decision.by, at=moment(at, request.lang), points=points)
    return f"{line} {quoted(decision.reason, request.lang)}" if decision.reason else line


def requested_decision(request: Request, mark: Mark) -> tuple[str, float | None]:
    """Return the kind of the decision on an answer that a form states, and its points.

    Raises
    ------
    HTTPException
        The form names no decision.
    BadInput
        The points are not a number, or exceed the maximum.
    """
    asked_for, texts = request.form.text("do"), request.words["queue"]
    if asked_for == "refuse":
        return (GIVEN, 0.0) if mark.verdict in WAITING else (KEPT, None)
    if asked_for in _KINDS:
        return _KINDS[asked_for], None
    if asked_for != "points" and not asked_for.startswith("give:"):
        raise HTTPException("bad_request", 400)
    text = request.form.text("points") if asked_for == "points" else asked_for.removeprefix("give:")
    points = points_of(text.strip(), texts["points"])
    if points is None:
        raise BadInput(texts["no_points"])
    if points > mark.out_of:
        most = localise(f"{mark.out_of:g}", request.lang)
        raise BadInput(texts["too_many"].format(localise(text, request.lang), most))
    return GIVEN, points


def raw_texts(marks: Sequence[Mark]) -> tuple[str, ...]:
    """Return the different texts that were typed for the same answer."""
    return tuple(dict.fromkeys(mark.answer for mark in marks))
