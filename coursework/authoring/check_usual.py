"""The promises about usual errors: one that shows is never right and is explained; what nothing protects is
listed.

Errors are made as the engine makes them, in the formula of each asked number, and handed in as students write
them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from coursework.authoring.check_report import CheckReport
from coursework.course.answer_key import Key
from coursework.course.error_values import TAKEN, UsualError
from coursework.course.variant import Variant
from coursework.issuing.flaws import SHOWN
from coursework.issuing.protection import protection
from coursework.language.numbers import significant
from coursework.marking.marking import mark as grade
from coursework.model import Part
from coursework.quantities.formula_code import formula_of
from coursework.quantities.usual_errors import WEIGHTY

TRIED = 40  #: variants whose usual errors are handed in
DIGITS = 5  #: significant digits of an answer


def check_usual_errors(drawn: Sequence[Variant], report: CheckReport) -> None:
    """Each error that shows is explained by its kind, or as one of several; some on each variant, all over
    many."""
    for number, variant in enumerate(drawn[:TRIED]):
        spellings = {part.id: list(_own_errors(part, variant.key)) for part in variant.parts}
        parts = {part.id: part for part in variant.parts}
        most = max(map(len, spellings.values()), default=0)
        for index in range(number % 7, most, 7):
            sheet = {i: errors[index] for i, errors in spellings.items() if index < len(errors)}
            answers = {i: significant(value, DIGITS) for i, (_, value) in sheet.items()}
            marking = grade(variant, answers)
            for i, (error, _) in sheet.items():
                _count_verdict(variant, parts[i], error, marking[i], report)
    _list_unprotected(drawn[0], report)


def _own_errors(part: Part, key: Key) -> Iterator[tuple[UsualError, float]]:
    """Yield the errors in a part's own formula that move its answer."""
    if not part.sort.is_scalar or part.judge:
        return
    errors, values = key.usual_ways(part.quantity)
    reference, width = key.reference[part.quantity], key.envelope.get(part.quantity, 0.0)
    for error, value in zip(errors, values, strict=True):
        is_own = error.source == part.quantity and error.kind not in TAKEN
        if is_own and np.isfinite(value) and not part.sort.is_trivial(float(value)):
            written: Any = float(significant(float(value), DIGITS))
            if part.sort.distance(part, written, reference, None, width) > SHOWN:
                yield error, written


def _count_verdict(variant: Variant, part: Part, error: UsualError, mark: Any, report: CheckReport) -> None:
    if mark.verdict == "correct" and not mark.in_other_order:
        report.fail(f"seed {variant.seed}: {part.id} with an error of the kind {error.kind!r} marks correct")
    elif f"slip:{error.kind}" == mark.verdict:
        report.counts["usual errors explained"] += 1
    elif mark.verdict != "wrong":
        report.counts["usual errors explained otherwise"] += 1  # it gives what something else gives as well
    elif mark.matches:
        report.counts["usual errors among many"] += 1
    elif mark.read_as:
        report.fail(
            f"seed {variant.seed}: {part.id} with an error of the kind {error.kind!r} is not recognised"
        )


def _list_unprotected(variant: Variant, report: CheckReport) -> None:
    """Add the asked numbers that a weighty error may leave right on some variants, and those of which none is
    made."""
    exercise = variant.exercise
    for demand, share in protection(exercise, None).unprotected.items():
        if demand.error.kind in WEIGHTY:
            about = report.unprotected.setdefault(demand.error.source, {})
            about[demand.error.kind] = max(share, about.get(demand.error.kind, 0.0))
    graph = exercise.solution.graph.textbook
    for part in exercise.spec.parts:
        is_number = part.sort.is_number and not part.judge and part.quantity in graph.names
        if is_number and formula_of(graph.node(part.quantity).function) is None:
            report.unmade.add(part.quantity)
