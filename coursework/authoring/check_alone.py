"""The promise that any question may be asked alone, with those that it is judged together with.

An assignment, `--parts` and a lesson's worked example ask some of an exercise's questions. Handout, worked
solution, blanks and marks must then do without what the others would have found on the way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice

from coursework.authoring.check_answers import spellings
from coursework.authoring.check_report import CheckReport
from coursework.course.answer_keys import answer_keys
from coursework.course.exercise import CourseExercise
from coursework.course.variant import Variant
from coursework.errors import CourseworkError
from coursework.language.words import words
from coursework.marking.marking import mark as grade
from coursework.model import Part
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.worked import LEVELS, blanks, steps_text
from coursework.sheets.answer_sheet import answer_sheet
from coursework.sheets.handout import handout


def asked_alone(exercise: CourseExercise) -> tuple[tuple[Part, ...], ...]:
    """Return the least that may be asked of an exercise: each question, with those that it is judged together
    with."""
    return tuple(dict.fromkeys(exercise.chosen_parts([part.id]) or () for part in exercise.spec.parts))


def check_alone(drawn: Sequence[Variant], report: CheckReport) -> None:
    """Each question alone has its sheets in every language, its blanks, and its right answer is right.

    ``drawn`` ask every part; each language is tried on another of those that ask the question.
    """
    exercise = drawn[0].exercise
    for parts in asked_alone(exercise):
        asking = [variant for variant in drawn if not {p.id for p in parts}.isdisjoint(variant.part_ids)]
        for index, lang in enumerate(exercise.languages if asking else ()):
            variant = asking[index % len(asking)].in_language(lang).asking(parts)
            report.counts["asked alone"] += 1
            for fault in faults_alone(variant):
                report.fail(f"seed {variant.seed}, asked alone, {', '.join(variant.part_ids)}: {fault}")


def faults_alone(variant: Variant) -> Iterator[str]:
    """Yield the faults of a variant by itself, a sentence each."""
    try:
        renderer = renderer_of(variant.exercise.folder)
        sheet = answer_sheet(variant)
        renderer.typst(handout(variant))
        renderer.typst(answer_sheet(variant, polygons=False))
        steps = {step.name for step in sheet.steps}
        for part in variant.parts:
            if not part.sort.is_open and part.quantity not in steps:
                yield f"the worked solution has no step {part.quantity}"
        _leave_blanks(variant)
        yield from _unfair(variant)
    except CourseworkError as fault:
        yield str(fault)


def _leave_blanks(variant: Variant) -> None:
    texts, keys = words(variant.lang)["lesson"], answer_keys(variant.parts)
    for level in range(1, LEVELS):
        left = blanks(variant, level, in_lesson=True)
        steps_text(variant, level, left, keys, texts, in_lesson=True)


def _unfair(variant: Variant) -> Iterator[str]:
    for right in islice(spellings(variant, variant.key), 1):
        marking = grade(variant, right)
        for part, answer in right.items():
            if marking[part].verdict != "correct":
                yield f"{part} = {answer!r} is right but marks {marking[part].verdict}"
