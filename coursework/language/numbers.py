"""Numbers and units as a language prints them."""

from __future__ import annotations

import math
import re

from coursework.language.words import words

NARROW_SPACE = "\N{NARROW NO-BREAK SPACE}"
MINUS = "\N{MINUS SIGN}"


def localise(number: str, lang: str) -> str:
    """Return a number written with a point (``-1234.5``) as the language prints it."""
    style = words(lang)["numbers"]
    return number.replace("-", MINUS).replace(".", style["decimal"])


#: A hyphen before a number, and one between spaces before a number; what stands between dollar signs sets its
#: own.
_HYPHEN = re.compile(r"\$+[^$]*\$+|(?<![\w.)\]-])-(?=\.?\d)|(?<=\S )-(?= \.?\d)")


def with_minus_signs(text: str) -> str:
    """Return a text that a program printed with minus signs for the hyphens before its numbers."""
    return _HYPHEN.sub(lambda found: MINUS if found[0] == "-" else found[0], text)


def typed_number(text: str) -> float:
    """Return a number that somebody typed, with a decimal point or comma; NaN if it is none."""
    try:
        return float(text.replace(",", ".").replace(MINUS, "-"))
    except ValueError:
        return math.nan


def plain(value: float) -> str:
    """Return the shortest decimal text of a number, with a point and no exponent where that is readable.

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
    """Return a computed number to ten digits, its last bits set aside, which differ from one processor to
    another.

    Halfway between two printed numbers, as 46.75 is to a tenth, they would choose between the two.
    """
    return float(f"{value:.10g}")


def rounded(value: float, decimals: int) -> float:
    """Return a computed number as it is printed or drawn, to so many decimals: whatever its last bits, and
    never ``-0.0``."""
    return round(settled(value), decimals) + 0.0


def significant(value: float, digits: int = 4) -> str:
    """Return a number rounded to significant digits, as a text with a point; for templates only.

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
    """Return a canonical unit as printed: ``cm^4`` -> ``cm⁴``, ``ohm`` -> ``Ω``, ``deg`` -> ``°``, ``1`` ->
    nothing."""
    table = words(lang)["units"]
    if unit in table:
        return table[unit]
    raised = _POWER.sub(lambda power: power[1].translate(_RAISED), _signs(unit))
    return raised.replace("*", "·")


_POWER = re.compile(r"\^\(?([+-]?\d+)\)?")
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "+")
_NAMES = (
    (re.compile(r"(?<![^\W\d_])delta_"), ""),
    (re.compile(r"(?<![^\W\d_])deg([CF])(?![^\W\d_])"), r"°\1"),
    (re.compile(r"(?<![^\W\d_])([kMGmµu]?)ohm(?![^\W\d_])"), r"\1Ω"),
)


def _signs(unit: str) -> str:
    """Return a unit with the signs of its names: ``kohm`` -> ``kΩ``, ``delta_degC`` -> ``°C``."""
    for name, sign in _NAMES:
        unit = name.sub(sign, unit)
    return unit


def unit_latex(unit: str) -> str:
    r"""Return a unit as LaTeX after a number: ``\ \mathrm{cm^{4}}``, ``^{\circ}``; nothing for a ratio."""
    if unit in ("1", "deg"):
        return r"^{\circ}" if unit == "deg" else ""
    text = _POWER.sub(lambda power: f"^{{{power[1].lstrip('+')}}}", _signs(unit))
    for sign, latex in (
        ("*", r"{\cdot}"),
        ("Ω", r"\Omega "),
        ("°", r"{}^{\circ}"),
        ("%", r"\%"),
        ("µ", r"\mu "),
    ):
        text = text.replace(sign, latex)
    return rf"\ \mathrm{{{text.strip()}}}"


def with_unit(number: str, unit: str, lang: str) -> str:
    """Return a number and its unit as running text: ``228,6 mm``, ``135°``."""
    unit_shown = unit_text(unit, lang)
    space = "" if not unit_shown or unit_shown == "°" else words(lang)["numbers"]["unit_space"]
    return localise(number, lang) + space + unit_shown
