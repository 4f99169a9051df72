"""Base of the kinds of coordinates."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated
from coursework.language.numbers import significant

if TYPE_CHECKING:
    from coursework.parsing.reading import Reading


def axes(count: int) -> tuple[str, ...]:
    """Return the names of the coordinates: x, y and z, or numbers where there are more."""
    return ("x", "y", "z")[:count] if count <= 3 else tuple(map(str, range(1, count + 1)))


class Coordinates(Kind):
    """Coordinates, as many as those of the reference."""

    family = "point"
    has_cells = True
    rank = 1
    faults: ClassVar[Mapping[str, str]] = {
        "unknown_symbol": "not_coordinates",
        "not_a_number": "not_coordinates",
    }

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        from coursework.parsing.points import read_point, worked_out
        from coursework.parsing.reading import Reading

        count = len(asking.reference(part.quantity))
        reading = read_point(answer, part.unit, count)
        if reading.status != "unreadable":
            return reading
        values = worked_out(answer, part.unit, count, asking.stated)
        read_as = "(" + "; ".join(f"{value:.6g}" for value in values) + ")"
        return Reading(reading.text, "read", (values,), (read_as,), unit_given=True) if values else reading

    def coordinates(self, part: Stated, asking: Asking) -> tuple[str, ...]:
        return axes(len(asking.reference(part.quantity)))

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return "(" + " ; ".join(significant(v, digits) for v in value.tolist()) + ")"

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        yield AnswerSpelling("exact", "; ".join(repr(v) for v in value.tolist()))
        yield from (spelled for spelled in super().spellings(part, value, label) if spelled.way != "exact")
