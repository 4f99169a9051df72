"""Distance of an answer from the reference, counted in accepted half-widths."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from coursework.marking.answers import read
from coursework.marking.diagnosis import nearest_reading
from coursework.model import Part

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def half_widths_off(variant: Variant, part: Part, answer: Any) -> float | None:
    """Return the distance of an answer from the reference in accepted half-widths: right up to 1.

    None of what has no such distance: an answer that is not read, or a part that is judged exactly, with
    others or by a person.
    """
    if not part.has_margin or part.sort.is_open or part.judge:
        return None
    _, gap = nearest_reading(part, read(variant, part, answer), variant.key, part)
    return gap if math.isfinite(gap) else None
