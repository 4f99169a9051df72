"""Flaws of variants: a variant is worth issuing if marking can distinguish right work from known mistakes.

A variant is *ill-conditioned* if rounding alone may cost a student an answer, and *murky* if a known mistake
moves an answer too little to be recognised and too much to be accepted. A seed draws the same variant for
everybody; issuing skips such seeds. A seed on which a usual error would go *unseen* is skipped as well, as
long as enough are left (:mod:`coursework.issuing.protection`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from coursework.course.answer_key import Key, exists, ill_limit
from coursework.course.marking_rules import ILL_DEGREES, ILL_SHARE
from coursework.course.variant import Variant
from coursework.errors import CourseworkError
from coursework.marking.judges import judged, judges_of
from coursework.messages import Message
from coursework.model import Part
from coursework.solution import Judged

V = TypeVar("V", bound=Variant)

SHOWN = 2.0  #: half-widths beyond which a mistake must be recognised
HIDDEN = 0.25  #: half-widths within which a mistake cannot be recognised


def visibility(key: Key, mistake: str) -> Iterator[tuple[Part, str]]:
    """Yield each part that a mistake reaches, with ``shown``, ``murky`` or ``hidden``.

    Parts that are judged jointly and whose quantities the mistake does not concern are left out: they follow
    from the errors before them.
    """
    together = dict(_judged_wrong(key, mistake))
    for part, wrong in _reached(key, mistake):
        if not part.judge:
            yield part, _seen(key, part, wrong)
        elif part.id in together:
            yield part, "hidden" if together[part.id].share == 1 else "shown"


def _reached(key: Key, mistake: str) -> Iterator[tuple[Part, Any]]:
    """Yield the parts that a mistake reaches, each with the mistake's value."""
    values = key.wrong[mistake]
    for part in key.variant.parts:
        wrong = values.get(part.quantity)
        if wrong is not None and exists(wrong):
            yield part, wrong


def _seen(key: Key, part: Part, wrong: Any) -> str:
    along, width = key.reference.get(part.along), key.envelope.get(part.quantity, 0.0)
    reference = key.reference[part.quantity]
    gap = part.sort.apart(part, wrong, reference, along, width)
    return "shown" if gap > SHOWN else "hidden" if gap <= HIDDEN else "murky"


def judged_wrong(key: Key, mistake: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the judges of the quantities that a mistake concerns, each with the mistake's answers by part."""
    values, about = key.wrong[mistake], key.solution.mistakes[mistake].targets
    parts = {part.id: part for part in key.variant.parts}
    for name, ids in judges_of(key.variant):
        quantities = {i: parts[i].quantity for i in ids}
        if not set(about).isdisjoint(quantities.values()):
            yield name, {i: values.get(q, key.reference[q]) for i, q in quantities.items()}


def _judged_wrong(key: Key, mistake: str) -> Iterator[tuple[str, Judged]]:
    for name, answers in judged_wrong(key, mistake):
        yield from judged(key.variant, name, answers).items()


def conditioning(key: Key) -> float:
    """Return the widest envelope of a variant's answers, as a share of the allowed width."""
    shares = [
        key.envelope.get(part.quantity, 0.0) / limit
        for part in key.variant.parts
        if part.has_margin and (limit := ill_limit(part, key.reference[part.quantity])) > 0
    ]
    return max(shares, default=0.0)


def flaws(key: Key) -> Iterator[Message]:
    """Yield the flaws of a variant: ``ill-conditioned: …``, ``murky: MISTAKE on PART``."""
    try:
        reference = key.reference
    except CourseworkError as fault:
        yield Message("unsolved: {problem}", problem=fault)
        return
    for part in key.variant.parts:
        if part.has_margin and key.envelope.get(part.quantity, 0.0) > ill_limit(
            part, reference[part.quantity]
        ):
            yield Message(
                "ill-conditioned: rounding on the way may cost {part} more than {most}",
                part=part.id,
                most=f"{ILL_DEGREES:g}°" if part.unit == "deg" else f"{100 * ILL_SHARE:g} %",
            )
    for name, mistake in key.solution.mistakes.items():
        if not mistake.approximation:
            # Jointly judged parts are right or wrong, never murky.
            for part, wrong in _reached(key, name):
                if not part.judge and _seen(key, part, wrong) == "murky":
                    yield Message("murky: {mistake} on {part}", mistake=name, part=part.id)


def try_judges(key: Key) -> None:
    """Run every judge on the right answers, some wrong ones, one missing, and the known mistakes, to find a
    broken judge before sheets are issued.

    Raises
    ------
    BadCourse
        As :func:`coursework.marking.judges.judged`.
    """
    quantity_of = {part.id: part.quantity for part in key.variant.parts}
    for name, ids in judges_of(key.variant):
        right = {i: key.reference[quantity_of[i]] for i in ids}
        off = {i: value if isinstance(value, str) else 0.85 * np.asarray(value) for i, value in right.items()}
        judged(key.variant, name, right)
        for missing in ids:
            for answers in (right, off):
                judged(key.variant, name, {i: value for i, value in answers.items() if i != missing})
    for mistake in key.solution.mistakes:
        dict(_judged_wrong(key, mistake))


def flawless(variants: Sequence[V], refused: Counter[str] | None = None) -> list[V]:
    """Return the variants without a flaw; the variants have their keys."""
    flawless = []
    for variant in variants:
        flaw = next(flaws(variant.key), None)
        if flaw is None:
            flawless.append(variant)
        elif refused is not None:
            refused[flaw] += 1
    return flawless
