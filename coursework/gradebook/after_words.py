"""Words of the evening after an exam: a step, a question and a distribution as lines in the reader's
language."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from coursework.errors import first_few
from coursework.gradebook.adjustments import PRICE
from coursework.gradebook.after import Distribution, Exam, ExamQuestion
from coursework.gradebook.decisions import WITHDRAWN, Decision
from coursework.gradebook.statistics.captions import Names
from coursework.language.numbers import localise
from coursework.language.words import words

_LONGEST = 70  #: characters of an error in words
_MOST_CHANGES, _NUMBERS = (
    6,
    12,
)  #: changes of one batch, and numbers of questions of one change, that are printed


def number(value: float, lang: str, digits: int = 4) -> str:
    """Return a number as it is printed, of at most so many digits."""
    return localise(f"{value:.{digits}g}", lang)


def batch_texts(exam: Exam, steps: Iterable[Decision], lang: str) -> list[tuple[Decision, str]]:
    """Return the first of the decisions that were made together, and what they do, batch by batch in their
    order."""
    batches: dict[str, list[Decision]] = {}
    for one in steps:
        batches.setdefault(one.id, []).append(one)
    return [(made[0], batch_text(exam, made, lang)) for made in batches.values()]


def batch_text(exam: Exam, made: Sequence[Decision], lang: str) -> str:
    """Return what the decisions of one batch do: those that do the same to several questions are described
    together."""
    texts = words(lang)["after"]
    if all(one.student for one in made):
        return str(texts["aside"]).format(len(made))
    alike: dict[tuple[Any, ...], list[Decision]] = {}
    for one in made:
        alike.setdefault((one.kind, one.points, one.answer), []).append(one)
    parts = [_alike_text(exam, some, lang) for some in alike.values()]
    text = str(texts["then"]).join(parts[:_MOST_CHANGES])
    return text if len(parts) <= _MOST_CHANGES else str(texts["several"]).format(text, len(parts))


def _alike_text(exam: Exam, steps: Sequence[Decision], lang: str) -> str:
    texts, step = words(lang)["after"], steps[0]
    place = _place(exam, steps, lang)
    if step.kind == WITHDRAWN:
        return str(texts["undone"]).format(place)
    points = (step.points or 0.0) * (100 if step.kind == PRICE else 1)
    answer = error_text(exam, step.exercise, step.answer or "", lang) if step.kind == PRICE else step.answer
    return str(texts["kinds"][step.kind]).format(
        question=place, points=number(points, lang, 6), answer=answer or ""
    )


class _PricedError(NamedTuple):
    exercise: str
    kind: str
    name: str


def error_text(exam: Exam, exercise: str, verdict: str, lang: str) -> str:
    """Return an error in words: its family, such as a slip, and what was done."""
    family, _, name = verdict.partition(":")
    text = str(words(lang)["after"]["errors"].get(family, family))
    if not name:
        return text
    asked = [exercise] if exercise else exam.issued.exercises
    kind = "slip" if family == "follow_through" else family
    says = (Names(exam.course, lang).mistake(_PricedError(one, kind, name), _LONGEST) for one in asked)
    return f"{text}{words(lang)['sheet']['colon']} {next((other for other in says if other != name), name)}"


def _place(exam: Exam, steps: Sequence[Decision], lang: str) -> str:
    texts, step = words(lang)["after"]["places"], steps[0]
    numbers = [
        exam.questions.label(one.exercise, one.part)
        for one in steps
        if (one.exercise, one.part) in exam.questions
    ]
    if numbers:
        name = "question" if len(numbers) == 1 else "questions"
        return str(texts[name]).format(first_few(numbers, _NUMBERS, with_count=True))
    number = exam.questions.exercise_number(step.exercise)
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
