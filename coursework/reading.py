"""From what a student wrote to a value: numbers, points, choices, equations.

A text with two honest readings (``1,234``) gives two values, the likelier first, and the
marking takes the one nearer the reference. A text that cannot be read is never wrong: it
comes back with the reason, and as it was written.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from numbers import Real

import numpy as np

from coursework.equations import parse_equation
from coursework.errors import WrongUnit
from coursework.expressions import MAX_LENGTH, Expression, Unreadable, parse_expression
from coursework.language import languages, words
from coursework.spelling import primes_as_dots, shorten, spelled_out, tidy, unwrapped, without_latex
from coursework.units import Unit, convert, find_unit, parse_unit, same_dimension

_MAX_INTEGER = 10**15


@dataclass(frozen=True)
class Reading:
    """What was understood of one answer.

    ``status``: ``read``, ``missing``, ``unreadable`` or ``wrong_unit``. ``values``: one or two honest
    readings in the canonical unit (floats; integers; tuples of floats for a point; a key for a choice; an
    :class:`~coursework.equations.Equation`), empty unless read. ``read_as``: one echo a value, with a
    decimal point and the unit as written. When it is not read, ``code`` is a short key for the reason and
    ``found`` the piece that stops the reading.
    """

    text: str
    status: str
    values: tuple = ()
    read_as: tuple[str, ...] = ()
    unit_given: bool = False
    code: str = ""
    found: str = ""


class _Stop(Exception):
    """Why a text is not read."""

    def __init__(self, code: str, found: str, status: str = "unreadable") -> None:
        super().__init__(code)
        self.code, self.found, self.status = code, found, status


@dataclass(frozen=True)
class _Amount:
    """One honest reading of a number: its value in the canonical unit, its echo, its unit if written."""

    value: float
    echo: str
    unit: str = ""


def _amount(value: float, digits: str, unit: str = "", *, assumed: str = "") -> _Amount:
    """``assumed``: a unit that the echo names although nobody wrote it."""
    unit = _POWER.sub(lambda m: m[1].translate(_RAISED), unit.lstrip("*").strip()).replace("*", "·")
    return _Amount(value, f"{digits} {unit or assumed}".strip(), unit)


def _bare(answer: object) -> object:
    """What a cell's value holds: an array, or a list of one, is its number; a number of NumPy is Python's."""
    if answer.__class__ is str:
        return answer
    for _ in range(_MAX_NESTING):
        if isinstance(answer, (np.ndarray, np.generic)) and answer.size <= _MAX_ITEMS:
            answer = answer.tolist()
        if not isinstance(answer, (list, tuple)) or len(answer) != 1:
            break
        (answer,) = answer
    return answer


_MAX_ITEMS, _MAX_NESTING = 100, 4  #: of an array that is looked into


_POWER = re.compile(r"\^\(([+-]?[0-9]+)\)")
_RAISED = str.maketrans("0123456789+-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻")


def _reading(answer: object, read: Callable[[str], Reading]) -> Reading:
    """Common to all kinds: what is missing, what is too long, what stops on the way."""
    answer = _bare(answer)
    if answer is None:
        return Reading("", "missing")
    text = answer if isinstance(answer, str) else str(answer)
    if isinstance(answer, bool) or not isinstance(answer, (str, Real)):
        return Reading(text, "unreadable", code="not_a_number", found=shorten(text))
    if len(text) > MAX_LENGTH and len(text.strip()) > MAX_LENGTH:
        return Reading(text, "unreadable", code="too_long", found=shorten(text))
    try:
        plain = without_latex(tidy(unwrapped(text)))
        return read(plain) if plain else Reading(text, "missing")
    except _Stop as stop:
        return Reading(text, stop.status, code=stop.code, found=shorten(stop.found or plain))
    except Unreadable as error:
        return Reading(text, "unreadable", code=error.code, found=error.found)


# --- numbers ----------------------------------------------------------------------------

#: Digits with one honest reading; three of them after a comma may have two.
_PLAIN = re.compile(r"\s*([+-]?[0-9]+(?:\.[0-9]+|,(?:[0-9]{1,2}|[0-9]{4,}))?(?:[eE][+-]?[0-9]+)?)\s*")
_match_plain = _PLAIN.fullmatch

_GROUPED = r"""
      [0-9]{1,3}(?:[ '][0-9]{3})+(?![0-9])(?:[.,][0-9]*)?     # 1 234,5   1'234.5
    | [0-9]{1,3}(?:,[0-9]{3})+\.[0-9]+                        # 1,234.5
    | [0-9]{1,3}(?:\.[0-9]{3})+,[0-9]+                        # 1.234,5
    | [0-9]{1,3}(?:,[0-9]{3}){2,}(?![0-9,])                   # 1,234,567
    | [0-9]{1,3}(?:\.[0-9]{3}){2,}(?![0-9.])                  # 1.234.567
    | [0-9]+[.,][0-9]{3}(?:[ ][0-9]{3})+(?![0-9])             # 3,141 592
    | [0-9]+(?:[.,][0-9]*)?
    | [.,][0-9]+
"""
_POWER_OF_TEN = r"""
      \s*[eE]\s*(?P<e>[+-]?[0-9]+)
    | (?:\s*[x*.]\s*|\s+)10\s*(?:\^|\*\*)\s*(?:[({]\s*(?P<bracketed>[+-]?[0-9]+)\s*[)}]|(?P<bare>[+-]?[0-9]+))
"""
_LITERAL = re.compile(
    rf"(?P<sign>[+-]?)\s*(?P<number>{_GROUPED})(?:{_POWER_OF_TEN})?\s*(?P<rest>.*)", re.VERBOSE | re.DOTALL
)
_LOST_POWER = re.compile(r"([+-]?\s*[0-9]+(?:[.,][0-9]+)?)\s*(?:\.10\s*\^|[x*]\s*10(?=[+-][0-9]))")
_FLAT_POWER = re.compile(r"([+-]?\s*[1-9](?:[.,][0-9]+)?)\s*[x*]\s*10(?=[1-9][0-9]?(?![0-9.,^]|\s*[*/^(]))")
_TWO_WAYS = re.compile(r"[1-9][0-9]{0,2},[0-9]{3}")
_SEXAGESIMAL = re.compile(
    r"""(?P<sign>[+-]?)\s*(?P<degrees>[0-9]+)\s*°\s*
        (?P<minutes>[0-9]+(?:[.,][0-9]+)?)\s*(?:'(?!')|(?=$))\s*
        (?:(?P<seconds>[0-9]+(?:[.,][0-9]+)?)\s*(?:"|''|$))?""",
    re.VERBOSE,
)
_MIXED = re.compile(
    r"(?P<sign>[+-]?)\s*(?P<whole>[0-9]{1,3}) +(?P<above>[0-9]{1,2})\s*/\s*(?P<below>[0-9]{1,3})(?![0-9.,])"
    r"\s*(?P<rest>.*)",
    re.DOTALL,
)
_NAME = re.compile(r"(?:[^\W\d_]|[\\|‖])[^=≈≃:]{0,39}?\s*(?:=|≈|≃|:)\s*(?=\S)")
_ABOUT = re.compile(
    r"(?:≈|≃|~|=|(?:environ|env\.|env|about|approximately|approx\.?|circa|ca\.|soit)(?![^\W\d_]))\s*", re.I
)
_NOT_FINITE = re.compile(r"[+-]?\s*(?:nan|inf(?:inity|ini)?|∞)(?![^\W\d_])", re.I)
_TWO_VALUES = re.compile(
    r"±|\+/-|\+-|\.\.|…|;|<|>|≤|≥|(?<![^\W\d_])(?:à|to|ou|or|et|and|entre|between)(?![^\W\d_])", re.I
)
_PRINTED = re.compile(r"^(?:(?:np|numpy)\.)?(?:float64|float32|int64|int32|array)\(\[?([^(),\[\]]*)\]?\)")
_RANGE = re.compile(r"([0-9]+(?:[.,][0-9]+)?)\s*-\s*([0-9]+(?:[.,][0-9]+)?)(?![0-9.,]*\s*[*/^(])")
_UNIT_START = re.compile(r"(?<![^\W\d_])[^\W\d_]|[°%]|(?<![0-9.,])1\s*/")
_MAX_PIECES = 8  #: names in the unit behind a formula
_WORD = re.compile(r"[\[(]?(?:[^\W\d_]|[°%])")


def _without_name(text: str) -> str:
    """The text without ``rA =``, ``≈``, ``environ``, and without the full stop of a sentence."""
    text = _NAME.sub("", text, count=1) if _NAME.match(text) else text
    text = _ABOUT.sub("", text, count=1) if _ABOUT.match(text) else text
    return text.rstrip(" .;,!")


def _decimal_texts(number: str) -> tuple[str, ...]:
    """The honest readings of written digits, each with a point: ``1,234`` -> ``1.234``, ``1234``."""
    if _TWO_WAYS.fullmatch(number):
        return number.replace(",", "."), number.replace(",", "")
    number = number.replace(" ", "").replace("'", "")
    last = max(number.rfind(","), number.rfind("."))
    if last < 0 or number.count(number[last]) > 1:  # repeated, it separates thousands
        return (number.replace(",", "").replace(".", ""),)
    whole, fraction = number[:last].replace(",", "").replace(".", ""), number[last + 1 :]
    return ((whole or "0") + ("." + fraction if fraction else ""),)


def _rest_unit(rest: str) -> Unit | None:
    """The unit after a number: ``mm``, ``*m/s``, ``/s``, ``[mm]``."""
    if rest[0] == "*":
        rest = rest[1:]
    return find_unit("1" + rest if rest[0:1] == "/" else rest.strip())


def _in_unit(value: Fraction | float, unit: Unit, target: Unit) -> float:
    """The value converted and rounded once, or the reason why it is not."""
    if not same_dimension(unit, target):
        raise _Stop("other_dimension", unit.text, "wrong_unit")
    try:
        number = float(convert(value, unit, target))
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise _Stop("not_finite", "")
    return number


def _float(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        raise _Stop("not_finite", digits)
    return value


def _literal(text: str, target: Unit, thousands: bool = True) -> list[_Amount] | None:
    """A number written in digits with its unit, or ``None`` when the text is something else."""
    found = _LITERAL.fullmatch(text)
    if found is None:
        return None
    exponent = found["e"] or found["bracketed"] or found["bare"]
    rest = found["rest"]
    unit = _rest_unit(rest) if rest else target
    if unit is None:
        if exponent is None or not _WORD.match(rest):
            return None
        raise _Stop("unknown_unit", rest)
    texts = _decimal_texts(found["number"])
    texts = texts if thousands and exponent is None else texts[:1]
    sign = "-" if found["sign"] == "-" else ""
    amounts = []
    for digits in texts:
        digits = sign + digits + (f"e{int(exponent)}" if exponent else "")
        value = _float(digits)
        if unit is not target and abs(int(exponent or 0)) < 400:
            value = _in_unit(Fraction(digits), unit, target)
        amounts.append(_amount(value, digits, rest))
    return amounts


def _sexagesimal(text: str, target: Unit) -> list[_Amount] | None:
    """Degrees, minutes and seconds; below 60 each of the latter two."""
    found = _SEXAGESIMAL.fullmatch(text)
    if found is None:
        return None
    minutes, seconds = (Fraction((found[part] or "0").replace(",", ".")) for part in ("minutes", "seconds"))
    if minutes >= 60 or seconds >= 60:
        raise _Stop("not_a_number", text)
    degrees = int(found["degrees"]) + minutes / 60 + seconds / 3600
    if found["sign"] == "-":
        degrees = -degrees
    value = _in_unit(degrees, parse_unit("deg"), target)
    return [_amount(value, _short(float(degrees)), "deg")]


def _mixed(text: str, target: Unit) -> list[_Amount] | None:
    """A whole number and a proper fraction, ``1 1/2``; ``1 234/5`` is no such number."""
    found = _MIXED.fullmatch(text)
    if found is None or not 0 < int(found["above"]) < int(found["below"]):
        return None
    unit = _rest_unit(found["rest"]) if found["rest"] else target
    if unit is None:
        return None
    value = int(found["whole"]) + Fraction(int(found["above"]), int(found["below"]))
    value = -value if found["sign"] == "-" else value
    return [_amount(_in_unit(value, unit, target), _short(float(value)), found["rest"])]


def _short(value: float) -> str:
    return f"{value:.7g}"


def _formula(text: str, target: Unit) -> list[_Amount]:
    """A formula, with or without a unit behind it; the longest unit that leaves a formula is taken."""
    first: Unreadable | None = None
    starts = [m.start() for m in _UNIT_START.finditer(text) if m.start() > 0 and len(text) - m.start() <= 60]
    for start in [*starts[-_MAX_PIECES:], len(text)]:
        unit_text = text[start:]
        unit = find_unit(unit_text) if unit_text else None
        if unit_text and unit is None:
            continue
        try:
            expression = parse_expression(text[:start].rstrip("* " if unit else " "))
        except Unreadable as error:
            first = first or error
            continue
        if unit and expression.is_angle:
            continue
        return _evaluated(expression, unit, unit_text, target)
    raise first


def _evaluated(expression: Expression, unit: Unit | None, unit_text: str, target: Unit) -> list[_Amount]:
    """The values of a formula: as written, or in radians where an angle's formula speaks of them."""
    amounts = []
    for reading in (expression, expression.other):
        if reading is None:
            continue
        if (unit or target).is_angle and (in_degrees := reading.as_calculated_in_degrees):
            amounts += _of_inverse(reading, in_degrees, unit, unit_text, target)
            continue
        value = reading.evaluate()
        digits = _short(value)
        if unit:
            amounts.append(_amount(_in_unit(value, unit, target), digits, unit_text))
        elif reading.is_angle:
            degrees = math.degrees(value)
            amounts.append(_amount(_in_unit(degrees, parse_unit("deg"), target), _short(degrees), "deg"))
        elif target.is_angle and reading.speaks_radians and target.factor != 1:
            radians = _in_unit(value, parse_unit("rad"), target)
            amounts.append(_amount(radians, digits, assumed="rad"))
            amounts.append(_amount(value, digits, assumed=target.text))
        else:
            amounts.append(_amount(value, digits))
    return amounts


_TURNS = 2  #: of an angle in radians, beyond which its formula was meant in degrees


def _of_inverse(
    reading: Expression, in_degrees: Expression, unit: Unit | None, unit_text: str, target: Unit
) -> list[_Amount]:
    """The values of an angle's formula with an inverse function, by who works in degrees and who does in radians."""
    degree, amounts = parse_unit("deg"), []
    if unit is None or unit.ratio == degree.ratio:
        degrees = in_degrees.evaluate()
        amounts.append(_amount(_in_unit(degrees, degree, target), _short(degrees), unit_text, assumed="deg"))
    if unit is None or unit.ratio != degree.ratio:
        value = reading.evaluate()
        if unit or abs(value) <= _TURNS * math.tau:
            own = unit or parse_unit("rad")
            amounts.append(_amount(_in_unit(value, own, target), _short(value), unit_text, assumed="rad"))
    return amounts


def _refuse_ranges(text: str) -> None:
    """``5 ± 0.1``, ``3 to 4`` and ``3 - 4`` are two values; ``180 - 75.4`` is a difference."""
    pair = _RANGE.match(text)
    if pair and float(pair[1].replace(",", ".")) < float(pair[2].replace(",", ".")):
        raise _Stop("two_values", text)
    if pair is None and _TWO_VALUES.search(text) and "atan2" not in text.replace("arctan2", "atan2"):
        raise _Stop("two_values", text)


def _named_unit_unknown(text: str) -> _Stop | None:
    """When a number is clear and only words follow, it is the unit that is not understood."""
    found = _LITERAL.fullmatch(text)
    if found is None or not _WORD.match(found["rest"]):
        return None
    try:
        parse_unit(found["rest"])
    except WrongUnit as error:
        return _Stop("unknown_unit", getattr(error, "found", found["rest"]))
    return None


def _amounts(text: str, target: Unit, thousands: bool = True) -> list[_Amount]:
    """All honest readings of one number, the likelier first."""
    text = _without_name(text)
    text = _PRINTED.sub(r"\1", text) if "(" in text else text
    text = _inside(text) or text
    if not text:
        raise _Stop("not_a_number", text)
    if _NOT_FINITE.match(text):
        raise _Stop("not_finite", text)
    if target.dimension == _RATIO and (parts := _PROPORTION.fullmatch(text)):
        text = f"{parts[1]}/{parts[2]}"
    amounts = _in_digits(text, target, thousands)
    if amounts is None and ("(" in text or "=" in text or "≈" in text):
        amounts = _written_twice(text, target, thousands)
    return _worked_out(text, target) if amounts is None else amounts


_PROPORTION = re.compile(r"([+-]?\s*[0-9]+(?:[.,][0-9]+)?)\s*:\s*([0-9]+(?:[.,][0-9]+)?)")  #: ``1.25:1``
_RATIO = parse_unit("1").dimension


def _in_digits(text: str, target: Unit, thousands: bool) -> list[_Amount] | None:
    """A number without a formula, or ``None``."""
    return _sexagesimal(text, target) or _mixed(text, target) or _literal(text, target, thousands)


def _worked_out(text: str, target: Unit) -> list[_Amount]:
    """The readings of a formula."""
    _refuse_ranges(text)
    amounts = _scientific(text, target)
    try:
        return [*amounts, *_formula(text, target), *_flattened(text, target)]
    except Unreadable as error:
        if amounts:
            return amounts
        words = error.code in ("unknown_symbol", "not_a_number")
        raise (words and _named_unit_unknown(text)) or error from None


def _inside(text: str) -> str:
    """What stands between brackets that open at the start and close at the end; else nothing."""
    if text[:1] != "(" or text[-1:] != ")":
        return ""
    level = 0
    for at, char in enumerate(text):
        level += (char == "(") - (char == ")")
        if level == 0:
            return text[1:-1].strip() if at == len(text) - 1 else ""
    return ""


_CHECKED = re.compile(r"([^(=≈]*[^\s(=≈+*/^-])\s+(\(.*\))\s*([^()=≈]*)", re.DOTALL)
_EQUALS = re.compile(r"\s*[=≈]+\s*")


def _written_twice(text: str, target: Unit, thousands: bool) -> list[_Amount] | None:
    """A number written in ways that agree: ``273.9 (273.92)``, ``180 - 75.4 = 104.6``; ``None`` where it is not.

    The number before the brackets is meant, or that behind the equals sign.
    """
    if (checked := _CHECKED.fullmatch(text)) and (inside := _inside(checked[2])):
        unit = checked[3] and f" {checked[3]}"
        if unit and find_unit(checked[3]) is None:
            return None
        return _checked(checked[1] + unit, inside, unit, target, thousands)
    pieces = _EQUALS.split(text)
    if len(pieces) != 2 or not all(pieces):
        return None
    other, end = (_way(piece, target, thousands) for piece in pieces)
    if not (amounts := _agreeing(end, other, target)):
        raise _Stop("two_values", text)
    return amounts


def _checked(number: str, inside: str, unit: str, target: Unit, thousands: bool) -> list[_Amount] | None:
    """A number that what stands in brackets behind it confirms; ``2 (π/3)`` is a product, and ``None``."""
    meant = _in_digits(number, target, thousands)
    if meant is None or not any(c in "0123456789π" for c in inside):
        return None
    says_more = bool(_WORD.search(inside))  # a unit, or what only a formula has
    try:
        other = _way(inside + unit, target, thousands)
    except (_Stop, Unreadable):
        other = [], inside
    amounts = _agreeing((meant, number), other, target)
    if not amounts and says_more and not (other[0] and other[0][0].unit and not unit):
        return None
    if not amounts:
        raise _Stop("two_values", f"{number} ({inside})")
    return amounts


_Way = tuple[list[_Amount], str]  #: what was read, and in which text


def _way(text: str, target: Unit, thousands: bool) -> _Way:
    amounts = _in_digits(text, target, thousands)
    return (_worked_out(text, target) if amounts is None else amounts), text


def _agreeing(one: _Way, other: _Way, target: Unit) -> list[_Amount]:
    """The readings of one way to write a number that the other confirms to the last digit of the shorter.

    An angle that does not say its unit may be in radians; what it is in degrees then counts as well.
    """
    kept, radian = [], 1 / target.factor
    for a in one[0]:
        for b in other[0]:
            own, its = _half_digit(a, one[1], target), _half_digit(b, other[1], target)
            if _is_near(a.value, b.value, max(own, its)) or (
                target.is_angle and not b.unit and _is_near(a.value, b.value * radian, max(own, its * radian))
            ):
                kept.append(a)
            elif (
                target.is_angle and not a.unit and _is_near(a.value * radian, b.value, max(own * radian, its))
            ):
                kept += [a, b]
    return kept


def _is_near(one: float, other: float, half: float) -> bool:
    return abs(one - other) <= half + 1e-6 * abs(one)


def _half_digit(amount: _Amount, text: str, target: Unit) -> float:
    """Half of the last digit that is written of a number, in the canonical unit; nothing of a formula."""
    if _LITERAL.fullmatch(text) is None or _literal(text, target) is None:
        return 0.0
    digits = amount.echo.split()[0]
    scale = abs(amount.value / float(digits)) if float(digits) else 1.0
    return 0.5 * 10.0 ** Decimal(digits).as_tuple().exponent * scale


def _scientific(text: str, target: Unit) -> list[_Amount]:
    """The first reading of ``3.10^2``, 300 on paper and 9.61 on a keyboard, and of ``3x10-2``, 0.03 or 28."""
    repaired, count = _LOST_POWER.subn(r"\1*10^", text, count=1) if _LOST_POWER.match(text) else (text, 0)
    return (_literal(repaired, target) or []) if count else []


def _flattened(text: str, target: Unit) -> list[_Amount]:
    """The second reading of ``2.739x102``, a power of ten whose exponent is raised no more: 273.9."""
    repaired, count = _FLAT_POWER.subn(r"\1*10^", text, count=1) if _FLAT_POWER.match(text) else (text, 0)
    return (_literal(repaired, target) or []) if count else []


def _from_amounts(text: str, amounts: Sequence[_Amount]) -> Reading:
    distinct: dict[float, _Amount] = {}
    for amount in amounts:
        distinct.setdefault(amount.value, amount)
    kept = list(distinct.values())[:2]
    return Reading(
        text,
        "read",
        tuple(a.value for a in kept),
        tuple(a.echo for a in kept),
        unit_given=any(a.unit for a in amounts),
    )


def _plain_reading(text: str, value: float, digits: str) -> Reading:
    """What ``Reading(text, "read", (value,), (digits,))`` is, without the checks of a frozen class."""
    reading = Reading.__new__(Reading)
    reading.__dict__.update(
        text=text, status="read", values=(value,), read_as=(digits,), unit_given=False, code="", found=""
    )
    return reading


def _from_real(answer: Real) -> Reading:
    text = repr(float(answer)) if isinstance(answer, float) else str(answer)
    try:
        value = float(answer)
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        return Reading(text, "unreadable", code="not_finite", found=shorten(text))
    return Reading(text, "read", (value,), (text,))


@lru_cache(maxsize=256)
def _target(unit: str) -> Unit:
    return parse_unit(unit)


def read_number(text: object, unit: str, *, thousands: bool = True) -> Reading:
    """A number, with or without its unit, in the canonical ``unit``.

    Without a unit it is in ``unit``; where ``unit`` is ``deg`` and the formula speaks of radians (``π/3``),
    radians are tried first. An int or float is taken as it is. Unless ``thousands``, the comma of ``1,234`` is
    decimal and nothing else: a direction has no thousands of degrees, and modulo a turn any number may be near.

    Raises
    ------
    WrongUnit
        The canonical unit itself is unknown.
    """
    if text.__class__ is str and len(text) < 40 and (plain := _match_plain(text)):
        digits = plain[1].replace(",", ".")
        value = float(digits)
        if value - value == 0:
            return _plain_reading(text, value, digits)
    target, text = _target(unit), _bare(text)
    if isinstance(text, Real) and not isinstance(text, bool):
        return _from_real(text)
    return _reading(text, lambda plain: _from_amounts(text, _amounts(plain, target, thousands)))


def read_numbers(texts: Sequence[object], unit: str) -> tuple[np.ndarray, np.ndarray]:
    """Many answers to one part at once: those that are plain digits are read here and now.

    Returns the values in ``unit`` (floats, NaN where there is none) and a mask (booleans) of the answers that
    :func:`read_number` has still to read: they have a unit, a formula, two readings, or nothing readable. What
    is neither read nor in the mask is missing. A value is the one that :func:`read_number` gives.

    Raises
    ------
    WrongUnit
        The canonical unit itself is unknown.
    """
    _target(unit)
    values = np.array([_plain_value(text) for text in texts], dtype=float)
    left = np.isinf(values)
    values[left] = math.nan
    return values, left


def _plain_value(text: object) -> float:
    """The value of plain digits; NaN where nothing is written, infinity where more than digits is."""
    if isinstance(text, str):
        if len(text) < 40 and (plain := _match_plain(text)):
            digits = plain[1]
            return float(digits) if "," not in digits else float(digits.replace(",", "."))
        return math.inf if text.strip() else math.nan
    if text is None:
        return math.nan
    if isinstance(text, (int, float)) and not isinstance(text, bool) and abs(text) < 1e300:
        return float(text)
    return math.inf


_COUNTED = re.compile(
    r"(?<=[0-9])\s*(?:ddl|dof|degrés? de libertés?|degrees? of freedom)[\s.]*$", re.I
)  #: what a whole number may be of


def read_integer(text: object) -> Reading:
    """A whole number, without unit: ``3``, ``3,0``, ``γ = 3``, ``1 ddl``; the values are ints."""
    text = _bare(text)
    counted = _COUNTED.sub("", text) if isinstance(text, str) and len(text) < MAX_LENGTH else text
    reading = read_number(counted, "1")
    if counted is not text:
        reading = replace(reading, text=text)
    if reading.status != "read":
        return reading
    pairs = [p for p in zip(reading.values, reading.read_as, strict=True) if p[0].is_integer()]
    if not pairs or abs(pairs[0][0]) > _MAX_INTEGER:
        return Reading(reading.text, "unreadable", code="not_an_integer", found=shorten(reading.text))
    values, echoes = zip(*pairs, strict=True)
    return Reading(reading.text, "read", tuple(map(int, values)), echoes, reading.unit_given)


# --- points -----------------------------------------------------------------------------

_POINT = re.compile(r"(?:[^\W\d_]\w{0,9}\s*)?[(\[{<](?P<inside>.*)[)\]}>]\s*(?P<unit>.*)", re.DOTALL)


def _splits(text: str) -> Iterable[list[str]]:
    """Ways to cut a text into coordinates, the likelier first."""
    if ";" in text or "|" in text:
        yield re.split(r"[;|]", text)
        return
    commas = text.split(",")
    yield re.split(r",\s+|\s+,\s*", text)
    pieces = text.replace(", ", " ").split()
    yield pieces
    yield commas
    if len(commas) % 2 == 0:  # 12,3,4,5: each other comma is decimal
        yield [f"{a},{b}" for a, b in zip(commas[::2], commas[1::2], strict=True)]


def _coordinates(pieces: Sequence[str], unit: str, target: Unit) -> list[tuple[tuple[float, ...], str, bool]]:
    """The readings of coordinates, their echo, whether a unit is written; the last one's serves for all."""
    pieces = [piece.strip() for piece in pieces]
    columns = [_amounts(piece, target) for piece in pieces]
    units = {column[0].unit for column in columns}
    if not unit and len(units) == 2 and "" in units:
        unit = (units - {""}).pop()
        columns = [
            column if column[0].unit else _amounts(f"{_without_name(piece)} {unit}", target)
            for piece, column in zip(pieces, columns, strict=True)
        ]
    readings = []
    for which in (0, -1):
        amounts = [column[which] for column in columns]
        echo = "(" + "; ".join(a.echo for a in amounts) + ")"
        readings.append((tuple(a.value for a in amounts), echo, any(a.unit for a in amounts)))
    return readings


def _bare_point(text: str) -> tuple[str, str]:
    """The coordinates inside brackets, and the unit behind the brackets."""
    if text.count("=") + text.count(":") == 1:  # A = (1 ; 2), but not x = 1 ; y = 2
        text = _NAME.sub("", text, count=1) if _NAME.match(text) else text
    found = _POINT.fullmatch(text.rstrip(" .;,"))
    return (found["inside"], found["unit"].lstrip("*").strip()) if found else (text.rstrip(" .;,"), "")


_AXIS = re.compile(
    r"(?P<sign>[+-]?)\s*(?:(?:l'\s*)?ax(?:e|is)\s+)?(?:\\?(?:vec|overrightarrow)\s*)?\{?\s*(?P<letter>[xyz])\u20d7?\s*\}?(?:[ -]axis)?",
    re.I,
)  #: ``y``, ``-z``, ``\\vec y``, ``y axis``


def _axis(text: str, count: int) -> tuple[float, ...] | None:
    """The direction of an axis of coordinates that is named, or ``None``."""
    found = _AXIS.fullmatch(text)
    place = "xyz".index(found["letter"].lower()) if found else count
    if place >= count:
        return None
    one = -1.0 if found["sign"] == "-" else 1.0
    return tuple(one if k == place else 0.0 for k in range(count))


def _point(text: str, original: str, target: Unit, count: int) -> Reading:
    if target.dimension == _RATIO and (axis := _axis(text.rstrip(" .;,"), count)):
        return Reading(original, "read", (axis,), ("(" + "; ".join(f"{c:g}" for c in axis) + ")",))
    inside, unit = _bare_point(text)
    source = target
    if unit:
        source = find_unit(unit)
        if source is None:
            raise _Stop("unknown_unit", unit)
        _in_unit(0.0, source, target)
    readings: dict[tuple[float, ...], str] = {}
    given = bool(unit)
    stop: Exception | None = None
    for pieces in _splits(inside):
        if len(pieces) != count:
            continue
        try:
            for values, echo, written in _coordinates(pieces, unit, source):
                values = tuple(_in_unit(v, source, target) for v in values)
                readings.setdefault(values, _amount(0.0, echo, unit).echo)
                given = given or written
        except (_Stop, Unreadable) as error:
            stop = stop or error
    if not readings:
        raise stop or _Stop("wrong_count", text)
    kept = list(readings.items())[:2]
    return Reading(original, "read", tuple(v for v, _ in kept), tuple(e for _, e in kept), given)


def read_point(text: object, unit: str, count: int) -> Reading:
    """The ``count`` coordinates of a point or a vector, each value a tuple of floats in ``unit``; an axis is a direction.

    ``(12,3 ; 4,5) mm``, ``12.3, 4.5``, ``[1, 0, 1]``, ``(1 0 1)``, ``x = 1; y = 2``, or a list. A unit
    behind the brackets or behind the last coordinate serves for all.
    """
    target, text = _target(unit), _bare(text)
    if isinstance(text, (list, tuple)):
        text = "[" + " ; ".join(str(item) for item in text[: count + 1]) + "]"
    elif isinstance(text, Real) and not isinstance(text, bool):
        return Reading(str(text), "unreadable", code="wrong_count", found=shorten(str(text)))
    return _reading(text, lambda plain: _point(plain, text, target, count))


# --- choices ----------------------------------------------------------------------------

_SIGN = re.compile(r"(^|[=<>(+])\s*[-‐‑‒–—−]\s*(?=[0-9])")
_PLUS = re.compile(r"(^|[=<>(])\s*\+\s*(?=[0-9])")
_ANY_MINUS = re.compile("[-‐‑‒–—−]")


_LOOSE_COMMA = re.compile(r",(?![0-9])|(?<![0-9]),")


@lru_cache(maxsize=4096)
def _folded(text: str) -> str:
    """A label without case, accents, markup and punctuation; a formula without spaces, its signs kept."""
    text = _PLUS.sub(r"\1", _SIGN.sub(r"\1−", text.strip("$ ")))
    if "=" in text:
        text = re.sub(r"[\s_*·{}\\]", "", _ANY_MINUS.sub("−", text))
    text = re.sub(r"\\(?:mathrm|text|mathit|vec|overrightarrow)(?![A-Za-z])|\\[,;! ]", " ", text)
    text = unicodedata.normalize("NFKD", text).casefold()
    text = "".join(" " if c in "-_‐‑–—'’/" else c for c in text if not unicodedata.combining(c))
    text = _LOOSE_COMMA.sub(" ", re.sub(r"[^\w\s+−<>=%°.,]", " ", text))
    return " ".join(text.split()).strip(" .,")


_AFTER_HEAD = re.compile(r"\s*(?:[(,;]|:\s).*", re.DOTALL)


def head(label: str) -> str:
    """A label as people shorten it: ``isostatic`` of "isostatic, all actions can be computed"."""
    return _AFTER_HEAD.sub("", label.replace("\u202f", " "))


def _by_label(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices that are called so: by their key, else by a whole label, else by the head of one."""
    folded = _folded(text)
    if not folded:
        return []
    keys = [key for key in choices if _folded(key) == folded]
    keys = keys or [key for key, labels in choices.items() if any(_is_called(text, s) for s in labels)]
    return keys or [k for k, labels in choices.items() if any(_is_called(text, head(s)) for s in labels)]


def _is_called(text: str, label: str) -> bool:
    """Whether a text is a label; one that is a formula is told from others by its operators too, not by its spaces."""
    if _IN_WORDS.search(_COMMANDS.sub("", label)):
        return _folded(text) == _folded(label)
    if _squeezed(text) != _squeezed(label):
        return False
    written, offered = _operators(text), _operators(label)
    return written in ("", offered) or "/" not in written + offered


_COMMANDS = re.compile(r"\\[A-Za-z]+")
_IN_WORDS = re.compile(r"[^\W\d_]{3,}")


@lru_cache(maxsize=4096)
def _squeezed(formula: str) -> str:
    """A formula without its spaces and bars, Greek letters and dots spelled."""
    return _folded(primes_as_dots(spelled_out(formula.strip("$ "))).replace("*", " ")).replace(" ", "")


@lru_cache(maxsize=4096)
def _operators(formula: str) -> str:
    """The signs of product and quotient of a formula, in order."""
    formula = re.sub(r"\\(?:cdot|times)(?![A-Za-z])|[×·⋅]", "*", formula)
    return re.sub(r"[^*/]", "", formula)


def _by_value(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices of whose formula this is the right-hand side: ``-1`` where ``w = -1`` is offered."""
    value = _folded(f"= {text.strip('()[] ')}").removeprefix("=").strip()
    found = [key for key, labels in choices.items() for s in labels if "=" in s and _value_of(s) == value]
    return list(dict.fromkeys(found)) if value else []


@lru_cache(maxsize=4096)
def _value_of(label: str) -> str:
    return _folded(label).rpartition("=")[2].strip()


_BEFORE = re.compile(
    r"^\s*(?:(?:c['’]est|il|elle|it is|it|un|une|des|le|la|les|an|a|the)\s+|l['’]\s*)(?=\S)", re.I
)  #: what people put before a label, and no label needs


@lru_cache(maxsize=1)
def _numerals() -> Mapping[str, int]:
    """Numbers as labels have them: digits, Roman numerals, words of any language; folded."""
    roman = ("i", "ii", "iii", "iv", "v", "vi", "vii", "viii", "ix", "x")
    found = {str(n): n for n in range(100)} | {name: n for n, name in enumerate(roman, start=1)}
    for lang in languages():
        for n, names in enumerate(words(lang)["study"]["reads"]["numbers"]):
            found |= {_folded(name): n for name in names.split("|")}
    return found


@lru_cache(maxsize=1)
def _nouns() -> tuple[str, ...]:
    """What labels are called together, ``class``; folded, the longest first."""
    found = {_folded(noun) for lang in languages() for noun in words(lang)["choices"]["nouns"]}
    return tuple(sorted(found, key=len, reverse=True))


@lru_cache(maxsize=4096)
def _without_noun(text: str) -> str:
    """A folded label without what all of its kind are called: ``classe III`` is ``iii``, ``rigid joint`` ``rigid``."""
    folded = _folded(text)
    for noun in _nouns():
        if folded.startswith(f"{noun} "):
            return folded[len(noun) + 1 :]
        if folded.endswith(f" {noun}") and len(folded) - len(noun) > _SMALL_WORD:
            return folded[: -len(noun) - 1]
    return folded


_SMALL_WORD = 4  #: letters of a word and its space that say too little alone: ``no joint`` is not ``no``


def _by_core(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices that are called so but for a noun that all of their kind share: ``pivot``."""
    core = _without_noun(text)
    plain = {key: [head(s) for s in labels if not s.startswith("$")] for key, labels in choices.items()}
    return [key for key, heads in plain.items() if core and any(_without_noun(s) == core for s in heads)]


@lru_cache(maxsize=4096)
def _beginnings(label: str) -> frozenset[str]:
    """What a label begins with, two words or more, folded; ``and`` and ``or`` are not left to follow."""
    pieces = [] if "=" in label or label.startswith("$") else label.split()
    ends = (n for n in range(2, len(pieces)) if _folded(pieces[n]) not in _conjunctions())
    return frozenset(_folded(" ".join(pieces[:n])) for n in ends)


@lru_cache(maxsize=1)
def _conjunctions() -> frozenset[str]:
    return frozenset(
        _folded(words(lang)["marking"][joint]) for lang in languages() for joint in ("and", "or")
    )


def _by_beginning(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices whose label begins so: ``double balancier``, ``cas limite``; a word with a hyphen is one."""
    folded = _folded(text)
    if " " not in folded:
        return []
    return [key for key, labels in choices.items() if any(folded in _beginnings(s) for s in labels)]


_REMARK = re.compile(r"(?P<said>[^()]+?)\s*\((?P<remark>[^()]+)\)\s*")


def _by_remark(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices that stand before a remark in brackets which names no other: ``oscille (r2 < r1)``."""
    found = _REMARK.fullmatch(text)
    keys = _called(found["said"], choices) if found else []
    if len(keys) != 1 or any(key not in keys for key in _called(found["remark"], choices)):
        return []
    remark = f" {_folded(found['remark'])} "
    others = (
        s for key, labels in choices.items() if key not in keys for s in (key, *labels, *map(head, labels))
    )
    return [] if any(f" {_folded(s)} " in remark for s in others if _folded(s)) else keys


@lru_cache(maxsize=4096)
def _numbered(text: str) -> tuple[int | None, str]:
    """The number that a label begins with, and what follows: ``deux paires`` is 2, ``paires``."""
    first, _, rest = _without_noun(text).partition(" ")
    return _numerals().get(first), rest


def _by_number(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choice whose label begins with this number, however it is written, where the numbers tell choices apart."""
    number, rest = _numbered(text.strip("()[] "))
    if number is None:
        return []
    found = {}
    for key, labels in choices.items():
        heads = [_numbered(head(label)) for label in labels]
        if numbers := {n for n, _ in heads if n is not None}:
            found[key] = numbers, {follows for n, follows in heads if n == number}
    every = [n for numbers, _ in found.values() for n in numbers]
    if len(found) < 2 or len(set(every)) < len(every):
        return []
    return [key for key, (ns, follows) in found.items() if number in ns and (not rest or rest in follows)]


_MARKED = re.compile(r"[(\[]?\s*(?P<mark>[a-z]|[0-9]{1,2})\s*(?:[)\]:]|\.(?![0-9]))\s*(?P<label>\S.*)", re.I)
_WHOLE = re.compile(r"^\s*([0-9]+)[.,]0+\s*$")  #: what a table makes of a whole number


def _choice(text: str, choices: Mapping[str, Sequence[str]]) -> Reading:
    text = _WHOLE.sub(r"\1", unwrapped(text))
    keys = _by_label(text, choices)
    if not keys and (marked := _MARKED.fullmatch(text.strip())):  # b) crossed
        keys = list(dict.fromkeys((*_called(marked["label"], choices), *_by_number(marked["mark"], choices))))
    keys = keys or _called(text, choices)
    if len(keys) != 1:
        raise _Stop("two_values" if keys else "not_a_choice", text)
    return Reading(text, "read", (keys[0],), (keys[0],))


def _called(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices that a text may mean, its article left out if need be; the surest way to call one first."""
    said = _BEFORE.sub("", text)
    for words_said in dict.fromkeys((text, said)):
        keys = _by_label(words_said, choices) or _by_core(words_said, choices)
        keys = keys or list(
            dict.fromkeys((*_by_number(words_said, choices), *_by_value(words_said, choices)))
        )
        if keys:
            return keys
    return _by_beginning(said, choices) or _by_remark(text, choices)


def read_choice(text: object, choices: Mapping[str, Sequence[str]]) -> Reading:
    """The key of a choice, given by its key, a label of any language, its head or beginning, or the number there.

    ``choices`` maps each key to its labels. A letter or a number never counts places: no sheet prints any.
    """
    text = _bare(text)
    if isinstance(text, Real) and not isinstance(text, (bool, float)):
        text = str(text)
    if not (text is None or isinstance(text, str)):
        return Reading(str(text), "unreadable", code="not_a_choice", found=shorten(str(text)))
    return _reading(text, lambda _: _choice(text, choices))


# --- equations --------------------------------------------------------------------------


def read_equation(text: object, variables: Iterable[str]) -> Reading:
    """An equation over the given variables; the value is an :class:`~coursework.equations.Equation`."""
    text = _bare(text)
    if isinstance(text, Real) and not isinstance(text, bool):
        text = str(text)

    def read(plain: str) -> Reading:
        plain = plain.rstrip(" .;,")
        return Reading(text, "read", (parse_equation(plain, tuple(variables)),), (plain,))

    return _reading(text, read)
