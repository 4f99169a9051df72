"""The promise that one error has one price: a named mistake that is a usual error costs what that error costs
anywhere."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress

import numpy as np

from coursework.authoring.check_report import CheckReport
from coursework.course.error_values import TAKEN, ErrorValues
from coursework.course.exercise import CourseExercise
from coursework.course.key_batch import given_columns
from coursework.course.variant import Variant
from coursework.errors import CourseworkError
from coursework.kinds.nearness import gaps
from coursework.quantities.error_kinds import PENALTIES

_SAME = 1e-6  #: of a value, by which two ways to compute it may differ


def check_prices(drawn: Sequence[Variant], report: CheckReport) -> None:
    """Check that a named mistake is of the kind of the usual error that it is, unless it states a penalty of
    its own."""
    exercise = drawn[0].exercise
    for name, mistake in exercise.solution.mistakes.items():
        kinds = set(usual_kinds(exercise, name, drawn))
        if kinds and mistake.share is None:
            report.counts["prices"] += 1
            prices = {PENALTIES[kind] for kind in kinds}
            if PENALTIES[mistake.kind] not in prices:
                kind = min(kinds, key=list(PENALTIES).index)
                report.fail(
                    f"mistake {name} is an error of the kind {kind!r}, which leaves "
                    f"{PENALTIES[kind]:g} of the points, "
                    f"and is said to be of the kind {mistake.kind!r}, which leaves "
                    f"{PENALTIES[mistake.kind]:g}: "
                    f"@mistake(…, kind={kind!r}), or share=… where it is to differ"
                )


def usual_kinds(exercise: CourseExercise, mistake: str, drawn: Sequence[Variant]) -> Iterator[str]:
    """Yield the kinds of usual errors that give what a named mistake gives, of the first quantity that it is
    about."""
    solution = exercise.solution
    target = solution.mistakes[mistake].targets[0]
    given = given_columns(exercise, drawn)
    effects = exercise.spec.effects
    with suppress(CourseworkError, ValueError):
        right = np.asarray(solution.graph.evaluate((target,), given, effects)[target])
        wrong = np.asarray(solution.mistaken(mistake).evaluate((target,), given, effects)[target])
        if right.dtype.kind not in "if" or wrong.dtype.kind not in "if" or right.ndim > 1 or wrong.ndim > 1:
            return
        right, wrong = (np.broadcast_to(a.astype(float), (len(drawn),)) for a in (right, wrong))
        turn = 360.0 if exercise.units.get(target) == "deg" else 0.0
        if _same(wrong, right, right, turn):
            return
        if np.all(np.abs(right) == 1):
            return  # a sense, or a side: there is but one other
        if _same(wrong, -right, right, turn):
            yield "sign"
        if _same(wrong * right, np.ones_like(right), right, 0.0):
            yield "inverse"
        if target in given:
            return
        errors, values = ErrorValues(exercise, (target,), given, effects, len(drawn)).of(target)
        for error, column in zip(errors, values, strict=True):
            is_here = error.source == target and error.kind not in TAKEN
            if is_here and _same(wrong, column, right, turn):
                yield error.kind


def _same(first: np.ndarray, other: np.ndarray, right: np.ndarray, turn: float) -> bool:
    """Return whether two columns agree where both are finite, and are not right everywhere there."""
    there = np.isfinite(first) & np.isfinite(other)
    gap = gaps(first, other, turn)
    moves = np.abs(first - right) > _SAME * np.maximum(np.abs(right), 1e-300)
    return bool(
        there.any()
        and moves[there].any()
        and np.all(gap[there] <= _SAME * np.maximum(np.abs(first[there]), turn / 360))
    )
