"""Amounts written in digits: decimals in either school, powers of ten, degrees and minutes, mixed numbers."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction

from coursework.parsing.reading import Stop
from coursework.parsing.units import Unit, convert, meant_otherwise, parse_unit, plain_unit, same_dimension


@dataclass(frozen=True)
class Amount:
    """One honest reading of a number: its value in the canonical unit, its echo, its unit if written."""

    value: float
    echo: str
    unit: str = ""


def written_amount(value: float, digits: str, unit: str = "", *, assumed: str = "") -> Amount:
    """``assumed``: a unit that the echo names although nobody wrote it."""
    unit = _POWER.sub(lambda m: m[1].translate(_RAISED), unit.lstrip("*").strip())
    unit = _STAR.sub("·", unit)
    return Amount(value, f"{digits} {unit or assumed}".strip(), unit)


_STAR = re.compile(r"(?<!\*)\*(?!\*)")  #: a factor's, where two are a power
_POWER = re.compile(r"\^\(([+-]?[0-9]+)\)")
_RAISED = str.maketrans("0123456789+-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻")


# --- numbers ----------------------------------------------------------------------------

#: Digits with one honest reading; three of them after a comma may have two. Those of a telephone number have
#: none.
_PLAIN = re.compile(
    r"\s*(?!0[1-9][0-9]{7}|\+[0-9]{10})([+-]?[0-9]+(?:\.[0-9]+|,(?:[0-9]{1,2}|[0-9]{4,"
    r"}))?(?:[eE][+-]?[0-9]+)?)\s*"
)
match_plain = _PLAIN.fullmatch

_GROUPED = r"""
      [1-9][0-9]{0,2}(?:[ '][0-9]{3})+(?![0-9])(?:\.[0-9]*|,[0-9]+)?     # 1 234,5   1'234.5
    | [1-9][0-9]{0,2}(?:,[0-9]{3})+\.[0-9]+                   # 1,234.5
    | [1-9][0-9]{0,2}(?:\.[0-9]{3})+,[0-9]+                   # 1.234,5
    | [1-9][0-9]{0,2}(?:,[0-9]{3}){2,}(?![0-9,])              # 1,234,567
    | [1-9][0-9]{0,2}(?:\.[0-9]{3}){2,}(?![0-9.])             # 1.234.567
    | [0-9]+[.,][0-9]{3}(?:[ ][0-9]{3})+(?![0-9])             # 3,141 592
    | [0-9]+(?:\.[0-9]*|,[0-9]+)?
    | [.,][0-9]+
"""
_POWER_OF_TEN = r"""
      \s*[eE]\s*(?P<e>[+-]?[0-9]+)
    | (?:\s*[x*.]\s*|\s+)10\s*(?:\^|\*\*)\s*(?:[({]\s*(?P<bracketed>[+-]?[0-9]+)\s*[)}]|(?P<bare>[+-]?[0-9]+))
"""
LITERAL = re.compile(
    rf"(?P<sign>[+-]?)\s*(?P<number>{_GROUPED})(?:{_POWER_OF_TEN})?\s*(?P<rest>.*)", re.VERBOSE | re.DOTALL
)
_LOST_POWER = re.compile(r"([+-]?\s*[0-9]+(?:[.,][0-9]+)?)\s*(?:\.10\s*\^|[x*]\s*10(?=-[0-9]))")
_FLAT_POWER = re.compile(r"([+-]?\s*[1-9](?:[.,][0-9]+)?)\s*[x*]\s*10(?=[1-9][0-9]?(?![0-9.,^]|\s*[*/^(]))")
_TWO_WAYS = re.compile(r"[1-9][0-9]{0,2},[0-9]{3}")
_SEXAGESIMAL = re.compile(
    r"""(?P<sign>[+-]?)\s*(?P<degrees>[0-9]+)\s*(?:°|deg(?:r[ée]s?|rees?)?\.?(?![^\W\d_]))\s*
        (?P<minutes>[0-9]+(?:[.,][0-9]+)?)\s*(?:'(?!')|min(?:utes?)?\.?(?![^\W\d_])|(?=$))\s*
        (?:(?P<seconds>[0-9]+(?:[.,][0-9]+)?)\s*(?:"|''|s(?:ec(?:ondes?|onds?)?)?\.?$|$))?""",
    re.VERBOSE | re.IGNORECASE,
)
_MIXED = re.compile(
    r"(?P<sign>[+-]?)\s*(?P<whole>[0-9]{1,3}) +(?P<above>[0-9]{1,2})\s*/\s*(?P<below>[0-9]{1,3})(?![0-9.,])"
    r"\s*(?P<rest>.*)",
    re.DOTALL,
)
_SAYS_UNIT = re.compile(r"[^\W\d_]|[°%]")
WORD = re.compile(r"[\[(]?(?:[^\W\d_]|[°%])")


def _decimal_texts(number: str) -> tuple[str, ...]:
    """Return the honest readings of written digits, each with a point: ``1,234`` -> ``1.234``, ``1234``."""
    if _TWO_WAYS.fullmatch(number):
        return number.replace(",", "."), number.replace(",", "")
    number = number.replace(" ", "").replace("'", "")
    last = max(number.rfind(","), number.rfind("."))
    if last < 0 or number.count(number[last]) > 1:  # repeated, it separates thousands
        return (number.replace(",", "").replace(".", ""),)
    integer_part, fraction = number[:last].replace(",", "").replace(".", ""), number[last + 1 :]
    return ((integer_part or "0") + ("." + fraction if fraction else ""),)


_ALONE = re.compile(r"(?:^|(?<=[\s*/.\[])|(?<=(?<!\^)\())1(?![0-9.,])(?!\s*/\s*[^\W\d_°%(\[])")


def _rest_unit(rest: str) -> Unit | None:
    """Return the unit after a number: ``mm``, ``*m/s``, ``/s``, ``[mm]``. A 1 is another number, but in
    ``1/s``."""
    if _ALONE.search(rest) or not _SAYS_UNIT.search(rest):
        return None
    if rest[0] == "*":
        rest = rest[1:]
    return plain_unit("1" + rest if rest[0:1] == "/" else rest.strip())


def in_unit(value: Fraction | float, unit: Unit, target: Unit) -> float:
    """Return the value converted and rounded once, or the reason why it is not."""
    if not same_dimension(unit, target):
        if meant_otherwise(unit, target):
            raise Stop("unknown_unit", unit.text)  # somebody looks: it is not a unit of another kind
        raise Stop("other_dimension", unit.text, "wrong_unit")
    try:
        number = float(convert(value, unit, target))
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise Stop("not_finite", "")
    return number


def _float(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        raise Stop("not_finite", digits)
    return value


def literal(text: str, target: Unit, thousands: bool = True) -> list[Amount] | None:
    """Return a number written in digits with its unit, or ``None`` when the text is something else."""
    match = LITERAL.fullmatch(text)
    if match is None:
        return None
    exponent = match["e"] or match["bracketed"] or match["bare"]
    rest = match["rest"]
    unit = _rest_unit(rest) if rest else target
    if unit is None:
        if exponent is None or not WORD.match(rest):
            return None
        raise Stop("unknown_unit", rest)
    texts = _decimal_texts(match["number"])
    texts = texts if thousands and exponent is None else texts[:1]
    sign = "-" if match["sign"] == "-" else ""
    amounts = []
    for digits in texts:
        digits = sign + digits + (f"e{int(exponent)}" if exponent else "")
        value = _float(digits)
        if unit is not target and abs(int(exponent or 0)) < 400:
            value = in_unit(Fraction(digits), unit, target)
        amounts.append(written_amount(value, digits, rest))
    return amounts


def _sexagesimal(text: str, target: Unit) -> list[Amount] | None:
    """Degrees, minutes and seconds; below 60 each of the latter two."""
    match = _SEXAGESIMAL.fullmatch(text)
    if match is None:
        return None
    minutes, seconds = (Fraction((match[part] or "0").replace(",", ".")) for part in ("minutes", "seconds"))
    if minutes >= 60 or seconds >= 60:
        raise Stop("not_a_number", text)
    degrees = int(match["degrees"]) + minutes / 60 + seconds / 3600
    if match["sign"] == "-":
        degrees = -degrees
    value = in_unit(degrees, parse_unit("deg"), target)
    return [written_amount(value, short_number(float(degrees)), "deg")]


def _mixed(text: str, target: Unit) -> list[Amount] | None:
    """Return a whole number and a proper fraction, ``1 1/2``; ``1 234/5`` is no such number."""
    match = _MIXED.fullmatch(text)
    if match is None or not 0 < int(match["above"]) < int(match["below"]):
        return None
    unit = _rest_unit(match["rest"]) if match["rest"] else target
    if unit is None:
        return None
    value = int(match["whole"]) + Fraction(int(match["above"]), int(match["below"]))
    value = -value if match["sign"] == "-" else value
    return [written_amount(in_unit(value, unit, target), short_number(float(value)), match["rest"])]


def short_number(value: float) -> str:
    return f"{value:.7g}"


def in_digits(text: str, target: Unit, thousands: bool) -> list[Amount] | None:
    """Return a number without a formula, or ``None``."""
    return _sexagesimal(text, target) or _mixed(text, target) or literal(text, target, thousands)


def scientific(text: str, target: Unit) -> list[Amount]:
    """Return the first reading of ``3.10^2``, 300 on paper and 9.61 on a keyboard, and of ``3x10-2``, 0.03 or
    28."""
    repaired, count = _LOST_POWER.subn(r"\1*10^", text, count=1) if _LOST_POWER.match(text) else (text, 0)
    return (literal(repaired, target) or []) if count else []


def flattened(text: str, target: Unit) -> list[Amount]:
    """Return the second reading of ``2.739x102``, a power of ten whose exponent is raised no more: 273.9."""
    repaired, count = _FLAT_POWER.subn(r"\1*10^", text, count=1) if _FLAT_POWER.match(text) else (text, 0)
    return (literal(repaired, target) or []) if count else []


def plain_value(text: object) -> float:
    """Return the value of plain digits; NaN where nothing is written, infinity where more than digits is."""
    if isinstance(text, str):
        if len(text) < 40 and (plain := match_plain(text)):
            digits = plain[1]
            return float(digits) if "," not in digits else float(digits.replace(",", "."))
        return math.inf if text.strip() else math.nan
    if text is None:
        return math.nan
    if isinstance(text, (int, float)) and not isinstance(text, bool) and abs(text) < 1e300:
        return float(text)
    return math.inf
