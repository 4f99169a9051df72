"""Right answers as the student wrote them: near the reference, or right in another way."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from coursework.marking.answers import read

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.model import Part


_NEAR = 0.1  #: of the reference; the marks decide what is right, this which choice it belongs to
_NEAR_ANGLE = 10.0  #: degrees


@dataclass(frozen=True)
class OwnAnswer:
    """Right answer with its number, if it has one; ``is_usual`` if it equals the reference up to rounding.

    An answer may be right without that: the other assembly first, another scale of the drawing.
    """

    value: float | None
    is_usual: bool


def right_ones(variant: Variant, answers: Mapping[str, Any], right: Collection[str]) -> dict[str, OwnAnswer]:
    """Return the student's own answers to the right parts, by quantity."""
    return {p.quantity: _own_answer(variant, p, answers.get(p.id)) for p in variant.parts if p.id in right}


def _own_answer(variant: Variant, part: Part, answer: Any) -> OwnAnswer:
    walk = variant.walk
    reading = read(variant, part, answer)
    if not part.sort.is_scalar or reading.status != "read":
        return OwnAnswer(None, True)
    reference = float(walk[part.quantity])
    gaps = {float(v): _gap(part, float(v), reference) for v in reading.values}
    value = min(gaps, key=gaps.__getitem__)
    limit = _NEAR_ANGLE if part.sort.turn else _NEAR * abs(reference) + 1e-9
    return OwnAnswer(value, gaps[value] <= max(limit, variant.key.half_width(part)))


def _gap(part: Part, value: float, reference: float) -> float:
    if turn := part.sort.turn:
        return abs((value - reference + turn / 2) % turn - turn / 2)
    return abs(value - reference)
