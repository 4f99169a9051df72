"""The units of a part as its sheet prints them."""

from __future__ import annotations

from coursework.errors import NoSolution
from coursework.kinds.kind import Asking
from coursework.language.numbers import unit_text
from coursework.language.words import words
from coursework.model import Part


def units_text(part: Part, lang: str, asking: Asking) -> str:
    """Return the unit of a part as it is printed; the units of its columns, parted by a bar, each with its
    column's letter, in the order of the question, or that of the kind in a course without solutions.
    """
    units = [unit_text(unit, lang) for unit in part.sort.units(part.unit)]
    if len(units) == 1:
        return units[0]
    letters = part.sort.columns or ("",) * len(units)
    colon = words(lang)["sheet"]["colon"]
    try:
        places = part.sort.units_asked(part, asking)
    except NoSolution:
        places = tuple(range(len(units)))
    asked = [(letters[place], units[place]) for place in places]
    return " | ".join(f"{letter}{colon} {unit}" if letter else unit for letter, unit in asked if unit)
