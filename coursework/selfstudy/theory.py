"""*Theory* questions: they have the same answer in every variant, so that another variant asks nothing new."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.errors import CourseworkError

if TYPE_CHECKING:
    from coursework.course.exercise import CourseExercise
    from coursework.course.variant import Variant

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
