"""From which wrong answers a right method may go on: from attempts, and from nothing that is written without
work.

Whoever writes one number in every box, the numbers of the questions, or what is given, follows no method,
though such answers may agree with each other. Nor does who writes numbers far from any that could be meant.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coursework.course.answer_key import Key
from coursework.model import Part
from coursework.parsing.reading import Reading

#: Factor between the size of an attempt and that of the reference, unless a known error explains it.
FARTHEST = 100.0
THINGS = 2  #: different things that a measured number is written for, before it means nothing
FEW = 4  #: least number of answers for a statement about them
DIFFERENT = 3  #: things at least that a copied number is written for
MOST = 0.75  #: of the answers
GUESSED = 3  #: counts and cases at least that are wrong, and more than are right, where they are guessed


@dataclass(frozen=True)
class SheetEvidence:
    """Evidence that the answers of a student give when they are compared with one another."""

    everywhere: frozenset[float] = frozenset()  #: numbers that are written for several different things
    has_work: bool = True  #: most answers copy no one number, no questions' numbers, nothing given
    is_guessed: bool = False  #: most counts and cases that follow from no other are wrong


def sheet_of(
    parts: Mapping[str, Part], readings: Mapping[str, Reading], right_answers: Mapping[str, str], key: Key
) -> SheetEvidence:
    """Return the evidence in the answers of a sheet; ``known`` maps the ids of right parts to their texts."""
    return replace(
        _numbers_of(parts, readings, right_answers, key),
        is_guessed=_is_guessed(parts, readings, right_answers, key),
    )


def _is_guessed(
    parts: Mapping[str, Part], readings: Mapping[str, Reading], right_answers: Mapping[str, str], key: Key
) -> bool:
    """Return whether most counts and cases that follow from no other answer are wrong, and several are: the
    sign of guessing."""
    exact = {i: p for i, p in parts.items() if p.sort.is_exact and p.sort.is_followed and not p.sort.is_open}
    wrong = [
        part
        for i, part in exact.items()
        if i not in right_answers and readings[i].status == "read" and _is_wrong(part, readings[i], key)
    ]
    if len(wrong) < GUESSED:
        return False
    quantities = {part.quantity for part in exact.values()}
    above = {q: key.solution.depending_on(q) for q in quantities}
    first = {q for q in quantities if not any(q in above[other] for other in quantities - {q})}
    lost = sum(part.quantity in first for part in wrong)
    answered = sum(
        p.quantity in first and (i in right_answers or readings[i].status == "read") for i, p in exact.items()
    )
    return lost >= GUESSED and 2 * lost > answered


def _is_wrong(part: Part, reading: Reading, key: Key) -> bool:
    reference = key.reference[part.quantity]
    return all(part.sort.distance(part, value, reference) > 1 for value in reading.values)


def _numbers_of(
    parts: Mapping[str, Part], readings: Mapping[str, Reading], right_answers: Mapping[str, str], key: Key
) -> SheetEvidence:
    """Return the evidence in the numbers of a sheet."""
    answers: list[tuple[int, Part, float]] = []
    for number, (i, part) in enumerate(parts.items(), start=1):
        if not part.sort.is_scalar or part.sort.is_open:
            continue
        if i in right_answers:
            answers.append((number, part, float(part.sort.kept(right_answers[i]))))
        elif readings[i].status == "read":
            answers.append((number, part, float(readings[i].values[0])))
    quantities: dict[float, set[str]] = {}
    for _, part, value in (answer for answer in answers if not answer[1].sort.is_exact):
        quantities.setdefault(value, set()).add(_quantity_key(key, part))
    everywhere = frozenset(value for value, parts_asked in quantities.items() if len(parts_asked) >= THINGS)
    if (
        len({value for *_, value in answers}) == 1
        and len({_quantity_key(key, part) for _, part, _ in answers}) > 1
    ):
        return SheetEvidence(everywhere, has_work=len(answers) < DIFFERENT)
    if len(answers) < FEW:
        return SheetEvidence(everywhere)
    wrong = [(n, p, v) for n, p, v in answers if p.sort.distance(p, v, key.reference[p.quantity]) > 1]
    if len(wrong) < FEW:
        return SheetEvidence(everywhere)
    given = {float(v) for v in key.variant.given.values() if isinstance(v, (int, float))}
    values = [value for *_, value in wrong]
    parts_by_value = {
        value: {_quantity_key(key, part) for _, part, v in wrong if v == value} for value in values
    }
    copies = (
        max(
            (
                values.count(value)
                for value, quantities in parts_by_value.items()
                if len(quantities) >= DIFFERENT
            ),
            default=0,
        ),
        sum(value == number for number, _, value in wrong),
        sum(value in given for value in values),
    )
    return SheetEvidence(everywhere, has_work=max(copies) < max(FEW, MOST * len(wrong)))


def _quantity_key(key: Key, part: Part) -> str:
    """Return a key for the quantity that a part asks for, by its value: two parts may ask for the same."""
    return f"{key.reference[part.quantity]:.6g}"


def is_attempt(part: Part, value: Any, reference: Any, *, is_explained: bool) -> bool:
    """Return whether a wrong answer is of a size that somebody may have computed."""
    if is_explained or part.sort.turn or isinstance(value, (str, tuple)) or isinstance(reference, str):
        return True
    size, expected = (float(np.max(np.abs(np.asarray(v)))) for v in (value, reference))
    if not math.isfinite(size):
        return False
    if part.sort.is_exact:
        return size <= FARTHEST * max(expected, 1.0)
    return not expected or expected / FARTHEST <= size <= FARTHEST * expected
