"""Why an answer is not right: what explains it among known mistakes, slips and what a student wrote before."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from coursework.course.answer_key import Key
from coursework.course.asked import Asked
from coursework.model import Part
from coursework.reading.reading import Reading


def nearest_reading(part: Part, reading: Reading, key: Key, judged_by: Part) -> tuple[int, float]:
    """Which honest reading is nearest to the reference, and its distance in half-widths."""
    if reading.status != "read" or part.sort.is_open:
        return 0, math.inf
    reference = key.reference[judged_by.quantity]
    along = key.reference.get(judged_by.along)
    gaps = [part.sort.distance(part, v, reference, along) for v in reading.values]
    index = min(range(len(gaps)), key=gaps.__getitem__)
    if 1 < gaps[index] < math.inf and part.has_margin:
        # Outside the part's own tolerance: rounding on the way may have brought it there.
        width = key.envelope.get(judged_by.quantity, 0.0)
        gaps = [part.sort.distance(part, v, reference, along, width) for v in reading.values]
    return index, gaps[index]


class Before(NamedTuple):
    """What a student has answered before a part: numbers and cases by quantity, and which of them are wrong."""

    own: dict[str, Any]
    wrong: set[str]
    right: set[str]  #: quantities, of any kind of answer
    shown: set[str]  #: verdicts that explain earlier answers
    read: list[tuple[Part, Reading]]  #: numbers, whole ones too, and choices


def mistakes_that_fit(key: Key, part: Part, reading: Reading) -> list[str]:
    """The named mistakes that give an answer, in the solution's order."""
    ways = key.wrong_ways(part.quantity)
    return [name for name, value in ways if _fits(part, reading, value, None, 0.0)]


def is_likely(match: str, key: Key, part: Part, before: Before) -> bool:
    """Whether a verdict may be told of an answer that it explains.

    Not a mistake made elsewhere, where what it is about has been answered rightly before. Among few cases, besides,
    many mistakes lead to the same one: a choice tells nothing of a mistake made elsewhere that an earlier answer,
    which it would have changed, does not show.
    """
    kind, _, name = match.partition(":")
    if kind != "mistake" or match in before.shown:
        return True
    about = key.solution.mistakes[name].targets
    if part.quantity in about:
        return True
    if not part.sort.has_few_values:
        return not any(_shows(key, name, quantity) for quantity in before.right.intersection(about))
    return not any(
        name == other and not _fits(earlier, reading, value, None, 0.0)
        for earlier, reading in before.read
        for other, value in key.wrong_ways(earlier.quantity)
    )


def _shows(key: Key, mistake: str, quantity: str) -> bool:
    """Whether an answer that is right of an asked quantity shows that a mistake about it was not made."""
    part = next(p for p in key.variant.parts if p.quantity == quantity)
    value = key.wrong[mistake].get(quantity)
    if value is None or not part.sort.disproves:
        return False
    width = key.envelope.get(quantity, 0.0)
    return bool(
        part.sort.apart(part, value, key.reference[quantity], key.reference.get(part.along), width) > 1
    )


def explanations(
    key: Key, part: Part, reading: Reading, judged_by: Part, before: Before
) -> Iterator[tuple[str, int]]:
    """Every verdict that explains a wrong answer, the one to give first; each with the reading that it explains."""
    quantity = judged_by.quantity
    width = key.envelope.get(quantity, 0.0)
    reference = key.reference[quantity]
    if part.sort.is_followed and before.wrong:
        expected = key.followed(judged_by, before.own, before.wrong)
        if expected is not None and (place := _fitting(part, reading, expected, None, width)) is not None:
            yield "follow_through", place
    for name, value in key.wrong_ways(quantity):
        along = key.reference.get(judged_by.along)
        if judged_by.along:
            along = key.wrong[name].get(judged_by.along, along)
        if (place := _fitting(part, reading, value, along, width)) is not None:
            yield f"mistake:{name}", place
    for slip in part.sort.slips(part, reading.values[0], reference, _lengths(key.variant)):
        yield f"slip:{slip}", 0
    seen = set()
    for kind, value in key.slips(judged_by):
        # A slip scales what rounding may have moved.
        own = part.sort.scaled(width, value, reference)
        if kind not in seen and (place := _fitting(part, reading, value, None, own)) is not None:
            seen.add(kind)
            yield f"slip:{kind}", place


def _lengths(variant: Asked) -> dict[str, float]:
    """The given numbers that are no angles."""
    units = variant.exercise.units
    return {n: v for n, v in variant.used.items() if not isinstance(v, str) and units.get(n) != "deg"}


def _fits(part: Part, reading: Reading, value: Any, along: Any, width: float) -> bool:
    return _fitting(part, reading, value, along, width) is not None


def _fitting(part: Part, reading: Reading, value: Any, along: Any, width: float) -> int | None:
    """The first reading that is this value, if any is."""
    places = range(len(reading.values))
    return next(
        (i for i in places if part.sort.distance(part, reading.values[i], value, along, width) <= 1), None
    )
