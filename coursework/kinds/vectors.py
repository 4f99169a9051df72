"""Base of the kinds of coordinates."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from coursework.kinds.kind import Asking, Kind, Spelling, Stated
from coursework.language.numbers import significant

if TYPE_CHECKING:
    from coursework.reading.reading import Reading


def axes(count: int) -> tuple[str, ...]:
    """Return the names of the coordinates: x, y and z, or numbers where there are more."""
    return ("x", "y", "z")[:count] if count <= 3 else tuple(map(str, range(1, count + 1)))


class Coordinates(Kind):
    """Coordinates, as many as those of the reference."""

    family = "point"
    rank = 1

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        from coursework.reading.points import read_point

        return read_point(answer, part.unit, len(asking.reference(part.quantity)))

    def coordinates(self, part: Stated, asking: Asking) -> tuple[str, ...]:
        return axes(len(asking.reference(part.quantity)))

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return "(" + " ; ".join(significant(v, digits) for v in value.tolist()) + ")"

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[Spelling]:
        yield Spelling("exact", "; ".join(repr(v) for v in value.tolist()))
        yield from (spelled for spelled in super().spellings(part, value, label) if spelled.way != "exact")
