"""Two answers that stand in each other's box: found from what each would be in the other."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from coursework.kinds.nearness import gaps
from coursework.marking.answers import read
from coursework.marking.diagnosis import CLOSE, fits_followed, nearest_reading
from coursework.marking.usual import nearness
from coursework.model import Part
from coursework.parsing.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant


class Exchange(NamedTuple):
    """Answer of a part that fits another part's box."""

    part: Part  #: in whose box it would be right
    reading: Reading  #: as that part reads it
    place: int  #: which honest reading of it


def exchanged(variant: Variant, wrong: Mapping[str, Reading], *, is_guessed: bool) -> dict[str, Exchange]:
    """Return by part the other part whose box its answer stands in, of answers that are not right where they stand.

    Counts and cases exchange by chance. Of counts a pair is meant where no other count is wrong and the later one does
    not follow from the earlier; of cases never.
    """
    key, targets = variant.key, {p.id: p for p in variant.parts if p.id in wrong}
    parts = [p for p in targets.values() if _may_be(p, wrong[p.id])]
    counts = [p for p in parts if p.sort.is_exact]
    exchanges: dict[str, Exchange] = {}
    for first_part, other in combinations(parts, 2):
        if (
            first_part.id in exchanges
            or other.id in exchanges
            or first_part.sort.is_exact != other.sort.is_exact
        ):
            continue
        if first_part.sort.is_exact and (is_guessed or len(counts) > 2):
            continue
        if first_part.sort.is_exact and _goes_on(
            variant, first_part, wrong[first_part.id], other, wrong[other.id]
        ):
            continue
        if not (
            _is_near(variant, wrong[first_part.id], other) and _is_near(variant, wrong[other.id], first_part)
        ):
            continue
        if any(_is_explained(variant, p, wrong[p.id]) for p in (first_part, other)):
            continue
        first, second = (
            read(variant, other, wrong[first_part.id].text),
            read(variant, first_part, wrong[other.id].text),
        )
        nearest, gap = nearest_reading(other, first, key, other)
        its_place, its_gap = nearest_reading(first_part, second, key, first_part)
        if gap > 1 or its_gap > 1:
            continue
        if _is_close(variant, other, first.values[nearest], gap) and _is_close(
            variant, first_part, second.values[its_place], its_gap
        ):
            exchanges[first_part.id] = Exchange(other, first, nearest)
            exchanges[other.id] = Exchange(first_part, second, its_place)
    return exchanges


def _is_close(variant: Variant, part: Part, value: object, gap: float) -> bool:
    """Return whether an answer fits the other box to its last digit: near values may agree by chance."""
    if not part.sort.is_scalar or part.sort.is_exact:
        return gap <= 1
    return gap <= nearness(part, variant.key, part, value, CLOSE)


def _is_explained(variant: Variant, part: Part, reading: Reading) -> bool:
    """Return whether the opposite sign or a known mistake gives the answer in its own box: that is likelier
    than an exchange."""
    reference = variant.key.reference[part.quantity]
    width = variant.key.envelope.get(part.quantity, 0.0)
    others = [value for _, value in variant.key.wrong_ways(part.quantity)]
    if part.sort.is_number:
        others.append(-reference)
    return any(
        part.sort.distance(part, value, other, None, width) <= 1
        for value in reading.values
        for other in others
    )


def _goes_on(variant: Variant, first: Part, wrong: Reading, part: Part, reading: Reading) -> bool:
    """Return whether an answer follows from an earlier wrong one, each in its own box."""
    if not first.sort.is_followed or wrong.status != "read" or reading.status != "read":
        return False
    return any(
        fits_followed(variant.key, part, reading, part, {first.quantity: value}, {first.quantity}) is not None
        for value in wrong.values
    )


def _may_be(part: Part, reading: Reading) -> bool:
    sort = part.sort
    if part.judge or sort.is_open or sort.is_text or sort.has_few_values:
        return False
    return reading.status == "read" or (reading.status == "wrong_unit" and sort.is_number)


def _is_near(variant: Variant, reading: Reading, other: Part) -> bool:
    """Return whether an answer may be right in another box: a cheap test that never rejects a number without
    a unit wrongly."""
    if reading.status == "wrong_unit":
        return other.sort.is_number
    reference, key = variant.key.reference[other.quantity], variant.key
    if not other.sort.is_scalar:
        along = key.reference.get(other.along)
        return all(
            not isinstance(v, (str, float, int)) and other.sort.distance(other, v, reference, along) <= 1
            for v in reading.values
        )
    width = key.half_width(other) + 1e-9 * abs(reference)
    return any(
        isinstance(v, (float, int)) and gaps(np.asarray(v), reference, other.sort.turn) <= width
        for v in reading.values
    )
