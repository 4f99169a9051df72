"""Two answers that stand in each other's box: found from what each would be in the other."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from coursework.kinds.nearness import gaps
from coursework.marking.answers import read
from coursework.marking.explaining import nearest_reading
from coursework.model import Part
from coursework.reading.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant


class Exchange(NamedTuple):
    """What an answer is in the other box."""

    part: Part  #: in whose box it would be right
    reading: Reading  #: as that part reads it
    place: int  #: which honest reading of it


def exchanged(variant: Variant, wrong: Mapping[str, Reading], *, is_guessed: bool) -> dict[str, Exchange]:
    """Return by part the other part whose box its answer stands in, of answers that are not right where they stand.

    Counts and cases exchange by chance: of counts a pair is meant where no other count is wrong, of cases never.
    """
    key, asked = variant.key, {p.id: p for p in variant.parts if p.id in wrong}
    parts = [p for p in asked.values() if _may_be(p, wrong[p.id])]
    counts = [p for p in parts if p.sort.is_exact]
    found: dict[str, Exchange] = {}
    for one, other in combinations(parts, 2):
        if one.id in found or other.id in found or one.sort.is_exact != other.sort.is_exact:
            continue
        if one.sort.is_exact and (is_guessed or len(counts) > 2):
            continue
        if not (_is_near(variant, wrong[one.id], other) and _is_near(variant, wrong[other.id], one)):
            continue
        first, second = read(variant, other, wrong[one.id].text), read(variant, one, wrong[other.id].text)
        place, gap = nearest_reading(other, first, key, other)
        its_place, its_gap = nearest_reading(one, second, key, one)
        if max(gap, its_gap) <= 1:
            found[one.id] = Exchange(other, first, place)
            found[other.id] = Exchange(one, second, its_place)
    return found


def _may_be(part: Part, reading: Reading) -> bool:
    sort = part.sort
    if part.judge or sort.is_open or sort.is_text or sort.has_few_values:
        return False
    return reading.status == "read" or (reading.status == "wrong_unit" and sort.is_number)


def _is_near(variant: Variant, reading: Reading, other: Part) -> bool:
    """Whether an answer may be right in another box: cheap, and never wrongly denied to a number without a unit."""
    if reading.status == "wrong_unit":
        return other.sort.is_number
    reference, key = variant.key.reference[other.quantity], variant.key
    if not other.sort.is_scalar:
        return all(
            not isinstance(v, (str, float, int)) and other.sort.distance(other, v, reference) <= 1
            for v in reading.values
        )
    width = key.half_width(other) + 1e-9 * abs(reference)
    return any(
        isinstance(v, (float, int)) and gaps(v, reference, other.sort.turn) <= width for v in reading.values
    )
