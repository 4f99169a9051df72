"""From what a student wrote to a value: numbers, points, choices, equations.

A text with two honest readings (``1,234``) gives two values, the likelier first, and the
marking takes the one nearer the reference. A text that cannot be read is never wrong: it
comes back with the reason, and as it was written.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from decimal import Decimal
from functools import lru_cache
from numbers import Real
from typing import Any

import numpy as np

from coursework.errors import WrongUnit
from coursework.reading.digits import (
    LITERAL,
    WORD,
    Amount,
    flattened,
    in_digits,
    in_unit,
    literal,
    match_plain,
    plain_value,
    scientific,
    short_number,
    written_amount,
)
from coursework.reading.expressions import plain_expression
from coursework.reading.reading import Reading, Stop, bare_value, reading_of
from coursework.reading.spelling import shorten
from coursework.reading.trees import Expression
from coursework.reading.units import Unit, parse_unit, plain_unit
from coursework.reading.vocabulary import MAX_LENGTH, Unreadable

_MAX_INTEGER = 10**15
NAME = re.compile(r"(?:[^\W\d_]|[\\|‖])[^=≈≃:]{0,39}?\s*(?:=|≈|≃|:)\s*(?=\S)")
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


def without_name(text: str) -> str:
    """The text without ``rA =``, ``≈``, ``environ``, and without the full stop of a sentence."""
    text = NAME.sub("", text, count=1) if NAME.match(text) else text
    text = _ABOUT.sub("", text, count=1) if _ABOUT.match(text) else text
    return text.rstrip(" .;,!")


def _formula(text: str, target: Unit) -> list[Amount]:
    """A formula, with or without a unit behind it; the longest unit that leaves a formula is taken."""
    first: Unreadable | None = None
    starts = [m.start() for m in _UNIT_START.finditer(text) if m.start() > 0 and len(text) - m.start() <= 60]
    for start in [*starts[-_MAX_PIECES:], len(text)]:
        unit_text = text[start:]
        unit = plain_unit(unit_text) if unit_text else None
        if unit_text and unit is None:
            continue
        try:
            expression = plain_expression(text[:start].rstrip("* " if unit else " "))
        except Unreadable as error:
            first = first or error
            continue
        if unit and expression.is_angle:
            continue
        return _evaluated(expression, unit, unit_text, target)
    assert first is not None  # the last start leaves no unit: the whole text is a formula, or stops
    raise first


def _evaluated(expression: Expression, unit: Unit | None, unit_text: str, target: Unit) -> list[Amount]:
    """The values of a formula: as written, or in radians where an angle's formula speaks of them."""
    amounts = []
    for reading in (expression, expression.other):
        if reading is None:
            continue
        if (unit or target).is_angle and (in_degrees := reading.as_calculated_in_degrees):
            amounts += _of_inverse(reading, in_degrees, unit, unit_text, target)
            continue
        value = reading.evaluate()
        digits = short_number(value)
        if unit:
            amounts.append(written_amount(in_unit(value, unit, target), digits, unit_text))
        elif reading.is_angle:
            degrees = math.degrees(value)
            amounts.append(
                written_amount(in_unit(degrees, parse_unit("deg"), target), short_number(degrees), "deg")
            )
        elif target.is_angle and reading.speaks_radians and target.factor != 1:
            radians = in_unit(value, parse_unit("rad"), target)
            amounts.append(written_amount(radians, digits, assumed="rad"))
            amounts.append(written_amount(value, digits, assumed=target.text))
        else:
            amounts.append(written_amount(value, digits))
    return amounts


_TURNS = 2  #: of an angle in radians, beyond which its formula was meant in degrees


def _of_inverse(
    reading: Expression, in_degrees: Expression, unit: Unit | None, unit_text: str, target: Unit
) -> list[Amount]:
    """The values of an angle's formula with an inverse function, by who works in degrees and who does in radians."""
    degree, amounts = parse_unit("deg"), []
    if unit is None or unit.ratio == degree.ratio:
        degrees = in_degrees.evaluate()
        amounts.append(
            written_amount(in_unit(degrees, degree, target), short_number(degrees), unit_text, assumed="deg")
        )
    if unit is None or unit.ratio != degree.ratio:
        value = reading.evaluate()
        if unit or abs(value) <= _TURNS * math.tau:
            own = unit or parse_unit("rad")
            amounts.append(
                written_amount(in_unit(value, own, target), short_number(value), unit_text, assumed="rad")
            )
    return amounts


def _refuse_ranges(text: str) -> None:
    """``5 ± 0.1``, ``3 to 4`` and ``3 - 4`` are two values; ``180 - 75.4`` is a difference."""
    pair = _RANGE.match(text)
    if pair and float(pair[1].replace(",", ".")) < float(pair[2].replace(",", ".")):
        raise Stop("two_values", text)
    if pair is None and _TWO_VALUES.search(text) and "atan2" not in text.replace("arctan2", "atan2"):
        raise Stop("two_values", text)


def _named_unit_unknown(text: str) -> Stop | None:
    """When a number is clear and only words follow, it is the unit that is not understood."""
    found = LITERAL.fullmatch(text)
    if found is None or not WORD.match(found["rest"]):
        return None
    try:
        parse_unit(found["rest"])
    except WrongUnit as error:
        return Stop("unknown_unit", getattr(error, "found", found["rest"]))
    return None


def read_amounts(text: str, target: Unit, thousands: bool = True) -> list[Amount]:
    """All honest readings of one number, the likelier first."""
    text = without_name(text)
    text = _PRINTED.sub(r"\1", text) if "(" in text else text
    text = _inside(text) or text
    if not text:
        raise Stop("not_a_number", text)
    if _NOT_FINITE.match(text):
        raise Stop("not_finite", text)
    if target.dimension == RATIO and (parts := _PROPORTION.fullmatch(text)):
        text = f"{parts[1]}/{parts[2]}"
    amounts = in_digits(text, target, thousands)
    if amounts is None and ("(" in text or "=" in text or "≈" in text):
        amounts = _written_twice(text, target, thousands)
    return _worked_out(text, target) if amounts is None else amounts


_PROPORTION = re.compile(r"([+-]?\s*[0-9]+(?:[.,][0-9]+)?)\s*:\s*([0-9]+(?:[.,][0-9]+)?)")  #: ``1.25:1``
RATIO = parse_unit("1").dimension


def _worked_out(text: str, target: Unit) -> list[Amount]:
    """The readings of a formula."""
    _refuse_ranges(text)
    amounts = scientific(text, target)
    try:
        return [*amounts, *_formula(text, target), *flattened(text, target)]
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


def _written_twice(text: str, target: Unit, thousands: bool) -> list[Amount] | None:
    """A number written in ways that agree: ``273.9 (273.92)``, ``180 - 75.4 = 104.6``; ``None`` where it is not.

    The number before the brackets is meant, or that behind the equals sign.
    """
    if (checked := _CHECKED.fullmatch(text)) and (inside := _inside(checked[2])):
        unit = checked[3] and f" {checked[3]}"
        if unit and plain_unit(checked[3]) is None:
            return None
        return _checked(checked[1] + unit, inside, unit, target, thousands)
    pieces = _EQUALS.split(text)
    if len(pieces) != 2 or not all(pieces):
        return None
    other, end = (_way(piece, target, thousands) for piece in pieces)
    if not (amounts := _agreeing(end, other, target)):
        raise Stop("two_values", text)
    return amounts


def _checked(number: str, inside: str, unit: str, target: Unit, thousands: bool) -> list[Amount] | None:
    """A number that what stands in brackets behind it confirms; ``2 (π/3)`` is a product, and ``None``."""
    meant = in_digits(number, target, thousands)
    if meant is None or not any(c in "0123456789π" for c in inside):
        return None
    says_more = bool(WORD.search(inside))  # a unit, or what only a formula has
    try:
        other = _way(inside + unit, target, thousands)
    except (Stop, Unreadable):
        other = [], inside
    amounts = _agreeing((meant, number), other, target)
    if not amounts and says_more and not (other[0] and other[0][0].unit and not unit):
        return None
    if not amounts:
        raise Stop("two_values", f"{number} ({inside})")
    return amounts


_Way = tuple[list[Amount], str]  #: what was read, and in which text


def _way(text: str, target: Unit, thousands: bool) -> _Way:
    amounts = in_digits(text, target, thousands)
    return (_worked_out(text, target) if amounts is None else amounts), text


def _agreeing(one: _Way, other: _Way, target: Unit) -> list[Amount]:
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


def _half_digit(amount: Amount, text: str, target: Unit) -> float:
    """Half of the last digit that is written of a number, in the canonical unit; nothing of a formula."""
    if LITERAL.fullmatch(text) is None or literal(text, target) is None:
        return 0.0
    digits = amount.echo.split()[0]
    scale = abs(amount.value / float(digits)) if float(digits) else 1.0
    return 0.5 * 10.0 ** int(Decimal(digits).as_tuple().exponent) * scale


def _from_amounts(text: str, amounts: Sequence[Amount]) -> Reading:
    distinct: dict[float, Amount] = {}
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
def target_unit(unit: str) -> Unit:
    return parse_unit(unit)


def read_number(text: Any, unit: str, *, thousands: bool = True) -> Reading:
    """A number, with or without its unit, in the canonical ``unit``.

    Without a unit it is in ``unit``; where ``unit`` is ``deg`` and the formula speaks of radians (``π/3``),
    radians are tried first. An int or float is taken as it is. Unless ``thousands``, the comma of ``1,234`` is
    decimal and nothing else: a direction has no thousands of degrees, and modulo a turn any number may be near.

    Raises
    ------
    WrongUnit
        The canonical unit itself is unknown.
    """
    if text.__class__ is str and len(text) < 40 and (plain := match_plain(text)):
        digits = plain[1].replace(",", ".")
        value = float(digits)
        if value - value == 0:
            return Reading.plain(text, value, digits)
    target, text = target_unit(unit), bare_value(text)
    if isinstance(text, Real) and not isinstance(text, bool):
        return _from_real(text)
    return reading_of(text, lambda plain: _from_amounts(text, read_amounts(plain, target, thousands)))


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
    target_unit(unit)
    values = np.array([plain_value(text) for text in texts], dtype=float)
    left = np.isinf(values)
    values[left] = math.nan
    return values, left


_COUNTED = re.compile(
    r"(?<=[0-9])\s*(?:ddl|dof|degrés? de libertés?|degrees? of freedom)[\s.]*$", re.I
)  #: what a whole number may be of


def read_integer(text: Any) -> Reading:
    """A whole number, without unit: ``3``, ``3,0``, ``γ = 3``, ``1 ddl``; the values are ints."""
    text = bare_value(text)
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
