"""An answer read as its part's kind asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coursework.model import Part
from coursework.reading.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def read(variant: Variant, part: Part, answer: Any) -> Reading:
    """Read an answer as the part's kind asks; a vector has as many coordinates as its reference."""
    return part.sort.read(answer, part, variant)
