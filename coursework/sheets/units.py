"""The units of a part as its sheet prints them."""

from __future__ import annotations

from itertools import zip_longest

from coursework.language.numbers import unit_text
from coursework.language.words import words
from coursework.model import Part


def units_text(part: Part, lang: str) -> str:
    """Return the unit of a part as it is printed; the units of its columns, parted by a bar, each with its column's letter."""
    units = [unit_text(unit, lang) for unit in part.sort.units(part.unit)]
    colon = words(lang)["sheet"]["colon"]
    named = zip_longest(part.sort.columns, units) if part.sort.columns else ((None, unit) for unit in units)
    return " | ".join(f"{letter}{colon} {unit}" if letter else unit for letter, unit in named if unit)
