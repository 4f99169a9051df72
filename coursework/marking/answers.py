"""An answer read as its part's kind asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coursework.model import Part
from coursework.reading.choices import read_choice
from coursework.reading.equations import read_equation
from coursework.reading.numbers import read_integer, read_number
from coursework.reading.points import read_point
from coursework.reading.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def read(variant: Variant, part: Part, answer: Any) -> Reading:
    """Read an answer as the part's kind asks; a vector has as many coordinates as its reference."""
    match part.kind:
        case "number" | "angle":
            return read_number(answer, part.unit, thousands=part.kind == "number")
        case "integer":
            return read_integer(answer)
        case "choice":
            return read_choice(answer, variant.labels(part))
        case "equation":
            return read_equation(answer, part.variables)
        case _:
            return read_point(answer, part.unit, len(variant.key.reference[part.quantity]))
