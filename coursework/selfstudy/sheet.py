"""What a self-study notebook holds beside the handout: the predictions to make, and what it can run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from coursework.builtin import builtin_root
from coursework.errors import Starved
from coursework.handout import Handout, Question
from coursework.issuing import distinct_variants
from coursework.selfstudy import predictions
from coursework.selfstudy.predictions import Prediction

if TYPE_CHECKING:
    from coursework.exercise import CourseExercise
    from coursework.variant import Variant


@dataclass(frozen=True)
class Ask:
    """A prediction to make: its name, the question (Markdown), and what may be written (plain text)."""

    id: str
    question: str
    options: str


@dataclass(frozen=True)
class StudySheet:
    """All that a self-study notebook shows; like its handout it holds no answer."""

    handout: Handout
    file: str  #: where answers are kept, beside the notebook
    course: str  #: name of the course's folder; empty for the course that the package brings
    before: tuple[Ask, ...]  #: predictions before any computation
    cycle: tuple[Ask, ...]  #: predictions before the curves
    moves: bool  #: whether there are curves over a cycle
    animates: bool  #: whether the mechanism can be shown in motion
    questions: tuple[Question, ...]  #: of the first fresh variant; none where there is no other variant


def study_sheet(variant: Variant, student: str = "") -> StudySheet:
    """The self-study notebook of a variant, before it is printed."""
    exercise = variant.exercise
    own = exercise.course.root != builtin_root().resolve()
    return StudySheet(
        handout=variant.handout(student),
        file=f"{exercise.name}.study.json",
        course=exercise.course.root.name if own else "",
        before=tuple(_ask(variant, p) for p in predictions.before_answers(variant)),
        cycle=tuple(_ask(variant, p) for p in predictions.over_the_cycle(variant)),
        moves=bool(predictions.moving(variant)),
        animates=exercise.is_animated,
        questions=_fresh_questions(variant),
    )


def fresh_variants(exercise: CourseExercise, seed: int, count: int, lang: str) -> list[Variant]:
    """The first variants after that of a seed that are worth issuing, all different from it and each other.

    Raises
    ------
    Starved
        So many do not exist.
    """
    found = distinct_variants(exercise, seed + 1, count + 1, lang)
    base = exercise.variant(seed, lang)
    return [v for v in found if v.given != base.given][:count]


def _fresh_questions(variant: Variant) -> tuple[Question, ...]:
    try:
        return fresh_variants(variant.exercise, variant.seed, 1, variant.lang)[0].handout().questions
    except Starved:
        return ()


def _ask(variant: Variant, prediction: Prediction) -> Ask:
    return Ask(
        prediction.id, predictions.asked(variant, prediction), predictions.options(variant, prediction)
    )
