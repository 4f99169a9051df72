"""The units of a part as its sheet prints them."""

from __future__ import annotations

from coursework.language.numbers import unit_text
from coursework.model import Part


def units_text(part: Part, lang: str) -> str:
    """The unit of a part as it is printed; the units of its columns, parted by a bar."""
    return " | ".join(filter(None, (unit_text(unit, lang) for unit in part.sort.units(part.unit))))
