"""An answer read as its part's kind asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coursework.model import Part
from coursework.reading.plain_values import plain_answer
from coursework.reading.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def read(variant: Variant, part: Part, answer: Any) -> Reading:
    """Read an answer as the part's kind asks; a vector has as many coordinates as its reference. Whatever
    it is, it is read or unreadable."""
    return part.sort.read(plain_answer(answer), part, variant)
