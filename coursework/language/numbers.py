"""Numbers and units as a language prints them."""

from __future__ import annotations

from coursework.language.words import words

NARROW_SPACE = "\N{NARROW NO-BREAK SPACE}"
MINUS = "\N{MINUS SIGN}"


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


def settled(value: float) -> float:
    """A computed number to twelve digits, its last bits set aside, which differ from one processor to another.

    Halfway between two printed numbers, as 46.75 is to a tenth, they would choose between the two.
    """
    return float(f"{value:.12g}")


def significant(value: float, digits: int = 4) -> str:
    """A number rounded to significant digits, as a text with a point; for templates only.

    Zeros at its end say that it is rounded there: ``197.10`` for 197.104, ``138`` for 138.
    """
    value = settled(value)
    text = f"{value:.{digits}g}"
    if abs(float(text) - value) > _EXACT * abs(value):
        text = f"{value:#.{digits}g}".removesuffix(".")
    if "e" in text:
        mantissa, exponent = text.split("e")
        if -4 <= int(exponent) < 10:
            text = f"{value:.{max(0, digits - 1 - int(exponent))}f}"
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
