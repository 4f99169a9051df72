"""Content of a self-study notebook beside the handout: the predictions to make, and the calls that it can
run."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from coursework.course.builtin import builtin_root
from coursework.course.lessons import taught_by
from coursework.errors import Starved
from coursework.issuing.issuing import distinct_variants
from coursework.selfstudy import predictions
from coursework.selfstudy.examples import has_example
from coursework.selfstudy.predictions import Prediction
from coursework.selfstudy.store import FILE
from coursework.selfstudy.theory import theory, without_theory
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Ask, Question, StudySheet
from coursework.system.distribution import DISTRIBUTION

if TYPE_CHECKING:
    from coursework.course.exercise import CourseExercise
    from coursework.course.variant import Variant


def study_sheet(variant: Variant, student: str = "", neighbours: Collection[str] = ()) -> StudySheet:
    """Return the self-study notebook of a variant, before it is printed, with links to the lessons in ``neighbours``, the folder of the notebook."""
    exercise = variant.exercise
    is_other_course = exercise.folder.root != builtin_root().resolve()
    return StudySheet(
        handout=handout(variant, student),
        file=FILE,
        package=DISTRIBUTION,
        install=exercise.folder.install,
        course=exercise.folder.root.name if is_other_course else "",
        before=tuple(_ask(variant, p) for p in predictions.before_answers(variant)),
        cycle=tuple(_ask(variant, p) for p in predictions.over_the_cycle(variant)),
        moves=bool(predictions.moving(variant)),
        animates=exercise.is_animated,
        questions=_fresh_questions(variant),
        theory=theory(exercise),
        has_example=has_example(variant),
        lessons=taught_by(exercise.folder, exercise.name, variant.lang),
        beside=frozenset(neighbours),
    )


def fresh_variants(exercise: CourseExercise, seed: int, count: int, lang: str) -> list[Variant]:
    """Return the first valid variants after that of a seed, all distinct, without theory questions.

    Raises
    ------
    Starved
        So many do not exist.
    """
    result = distinct_variants(exercise, seed + 1, count + 1, lang)
    base = exercise.variant(seed, lang)
    return [without_theory(v) for v in result if v.given != base.given][:count]


def _fresh_questions(variant: Variant) -> tuple[Question, ...]:
    try:
        return handout(fresh_variants(variant.exercise, variant.seed, 1, variant.lang)[0]).questions
    except Starved:
        return ()


def _ask(variant: Variant, prediction: Prediction) -> Ask:
    return Ask(
        predictions.prediction_keys(variant)[prediction.id],
        predictions.question_of(variant, prediction),
        predictions.options(variant, prediction),
    )
