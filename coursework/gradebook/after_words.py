"""Words of the evening after an exam: a step, a question and a distribution as lines in the reader's language."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from coursework.gradebook.adjustments import PRICE
from coursework.gradebook.after import Distribution, Exam, ExamQuestion
from coursework.gradebook.decisions import WITHDRAWN, Decision
from coursework.gradebook.statistics.captions import Names
from coursework.language.numbers import localise
from coursework.language.words import words

_LONGEST = 70  #: characters of an error in words


def number(value: float, lang: str, digits: int = 4) -> str:
    """Return a number as it is printed, of at most so many digits."""
    return localise(f"{value:.{digits}g}", lang)


def step_text(exam: Exam, step: Decision, lang: str) -> str:
    """Return what a step does."""
    texts = words(lang)["after"]
    if step.kind == WITHDRAWN:
        return str(texts["undone"]).format(_place(exam, step, lang))
    points = (step.points or 0.0) * (100 if step.kind == PRICE else 1)
    answer = error_text(exam, step.exercise, step.answer or "", lang) if step.kind == PRICE else step.answer
    return str(texts["kinds"][step.kind]).format(
        question=_place(exam, step, lang), points=number(points, lang, 6), answer=answer or ""
    )


def stroke_texts(exam: Exam, steps: Iterable[Decision], lang: str) -> list[tuple[Decision, str]]:
    """Return the first of the steps that were made at one stroke, and what they do, stroke by stroke in their order."""
    strokes: dict[str, list[Decision]] = {}
    for one in steps:
        strokes.setdefault(one.id, []).append(one)
    several = str(words(lang)["after"]["several"])
    texts = ((made[0], step_text(exam, made[0], lang), len(made)) for made in strokes.values())
    return [(first, text if count == 1 else several.format(text, count)) for first, text, count in texts]


class _PricedError(NamedTuple):
    exercise: str
    kind: str
    name: str


def error_text(exam: Exam, exercise: str, verdict: str, lang: str) -> str:
    """Return an error in words: its family, such as a slip, and what was done."""
    family, _, name = verdict.partition(":")
    told = str(words(lang)["after"]["errors"].get(family, family))
    if not name:
        return told
    asked = [exercise] if exercise else exam.issued.exercises
    says = (
        Names(exam.course, None, lang).mistake(_PricedError(one, family, name), _LONGEST) for one in asked
    )
    return f"{told}{words(lang)['sheet']['colon']} {next((text for text in says if text != name), name)}"


def _place(exam: Exam, step: Decision, lang: str) -> str:
    if (step.exercise, step.part) in exam.questions:
        return exam.number(step.exercise, step.part)
    texts, number = words(lang)["after"]["kinds"], exam.exercise_number(step.exercise)
    return str(texts["exercise"]).format(number) if number else str(step.exercise or texts["everywhere"])


def counting_text(question: ExamQuestion, lang: str) -> str:
    """Return how a question counts: as issued, or what is changed."""
    texts = words(lang)["after"]
    pieces = [str(texts["statuses"][question.status])] if question.status else []
    if question.tolerance != 1:
        pieces.append(str(texts["wider"]).format(number(question.tolerance, lang)))
    return ", ".join(pieces)


def points_text(question: ExamQuestion, lang: str) -> str:
    """Return the points of a question, with those announced where they differ."""
    now, before = number(question.weight, lang), number(question.issued, lang)
    return now if now == before else str(words(lang)["after"]["was"]).format(now, before)


def bins(distribution: Distribution, lang: str) -> list[str]:
    """Return the names of the tenths of a scale: ``0–2``."""
    width = distribution.of / len(distribution.counts)
    return [
        f"{number(k * width, lang)}–{number((k + 1) * width, lang)}" for k in range(len(distribution.counts))
    ]
