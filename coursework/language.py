"""Languages: how numbers are written, and the engine's own words.

The words of a language are one file, ``coursework/words/LANG.toml``; a language exists
when its file does.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import resources
from typing import Any

from coursework.errors import BadCourse, unknown

NARROW_SPACE = "\N{NARROW NO-BREAK SPACE}"
MINUS = "\N{MINUS SIGN}"


@cache
def languages() -> tuple[str, ...]:
    """The languages the engine speaks, in alphabetical order."""
    folder = resources.files("coursework") / "words"
    return tuple(sorted(f.name.removesuffix(".toml") for f in folder.iterdir() if f.name.endswith(".toml")))


@cache
def words(lang: str) -> Mapping[str, object]:
    """The engine's words in one language, as nested tables of texts.

    Raises
    ------
    UnknownName
        No such language.
    BadCourse
        Its file lacks texts that English has.
    """
    if lang not in languages():
        raise unknown("language", lang, languages())
    found = _read(lang)
    if missing := sorted({*names_of(_read("en"))} - {*names_of(found)}):
        raise BadCourse(
            f"coursework/words/{lang}.toml lacks {', '.join(missing[:5])}{', …' if len(missing) > 5 else ''}: "
            "copy from coursework/words/en.toml and translate"
        )
    return found


def _read(lang: str) -> dict[str, Any]:
    return tomllib.loads((resources.files("coursework") / "words" / f"{lang}.toml").read_text("utf-8"))


def names_of(table: Mapping[str, Any], above: str = "") -> Iterator[str]:
    """The names of a table's texts, ``study.refused.near`` for one in a table in a table."""
    for name, text in table.items():
        if isinstance(text, dict):
            yield from names_of(text, f"{above}{name}.")
        else:
            yield above + name


def localise(number: str, lang: str) -> str:
    """A number written with a point (``-1234.5``) as the language prints it."""
    style = words(lang)["numbers"]
    return number.replace("-", MINUS).replace(".", style["decimal"])


def plain(value: float) -> str:
    """The shortest decimal text of a number, with a point and no exponent where that is readable.

    ``228.6`` -> ``"228.6"``, ``90.0`` -> ``"90"``. Reading it back gives the same double.
    """
    if isinstance(value, (int, str)):
        return str(value)
    text = repr(float(value))
    if text.endswith(".0"):
        text = text[:-2]
    return "0" if text == "-0" else text


_EXACT = 1e-9  #: of a number that is printed as it is, and no rounded one


def listed(items: Iterable[str], lang: str, joint: str = "and") -> str:
    """``a, b and c``; ``joint`` is ``and`` or ``or``."""
    *first, last = items
    return f"{', '.join(first)} {words(lang)['marking'][joint]} {last}" if first else last


def is_whole(text: str) -> bool:
    """Whether a text ends with a sentence, or is empty; else something is to follow: ``Here the guide``."""
    end = text.rstrip(' \n*_)»”"')
    return not end or end[-1] in ".!?…"


def significant(value: float, digits: int = 4) -> str:
    """A number rounded to significant digits, as a text with a point; for templates only.

    Zeros at its end say that it is rounded there: ``197.10`` for 197.104, ``138`` for 138.
    """
    text = f"{float(value):.{digits}g}"
    if abs(float(text) - value) > _EXACT * abs(value):
        text = f"{float(value):#.{digits}g}".removesuffix(".")
    if "e" in text:
        mantissa, exponent = text.split("e")
        if -4 <= int(exponent) < 10:
            text = f"{float(value):.{max(0, digits - 1 - int(exponent))}f}"
        else:
            text = f"{mantissa}e{int(exponent)}"
    return "0" if float(text) == 0 else text


def unit_text(unit: str, lang: str) -> str:
    """A canonical unit as printed: ``rad/s^2`` -> ``rad/s²``, ``deg`` -> ``°``, ``1`` -> nothing."""
    table = words(lang)["units"]
    if unit in table:
        return table[unit]
    return unit.replace("^2", "²").replace("^3", "³").replace("*", "·")


def with_unit(number: str, unit: str, lang: str) -> str:
    """A number and its unit as running text: ``228,6 mm``, ``135°``."""
    shown = unit_text(unit, lang)
    space = "" if not shown or shown == "°" else words(lang)["numbers"]["unit_space"]
    return localise(number, lang) + space + shown
