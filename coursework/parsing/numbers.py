"""From what a student wrote to a value: numbers, points, choices, equations.

A text with two honest readings (``1,234``) gives two values, the likelier first, and the
marking takes the one nearer the reference. A text that cannot be read is never wrong: it
comes back with the reason, and as it was written.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from numbers import Real
from typing import Any

import numpy as np

from coursework.errors import WrongUnit
from coursework.parsing.digits import (
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
from coursework.parsing.expressions import plain_expression
from coursework.parsing.reading import Reading, Stop, bare_value, reading_of, text_of
from coursework.parsing.scales import is_of_paper, restated
from coursework.parsing.spelling import in_brackets, shorten
from coursework.parsing.spoken import number_words, with_signs
from coursework.parsing.trees import Expression, Operation, bare_angles, numbers_in_degrees, without_idle
from coursework.parsing.units import Unit, parse_unit, plain_unit
from coursework.parsing.vocabulary import FUNCTIONS, MAX_LENGTH, Unreadable

_MAX_INTEGER = 10**15
NAME = re.compile(r"(?:[^\W\d_]|[\\|‖])[^=≈≃:]{0,39}?\s*(?:=|≈|≃|:)\s*(?=\S)")
_ABOUT = re.compile(r"(?:≈|≃|~|=|(?:env|circa|ca\.|soit)(?![^\W\d_]))\s*", re.I)
_NOT_FINITE = re.compile(r"[+-]?\s*(?:nan|inf(?:inity|ini)?|∞)(?![^\W\d_])", re.I)
_TWO_VALUES = re.compile(
    r"±|\+/-|\+-|\.\.|…|;|<|>|≤|≥|(?<![^\W\d_])(?:à|to|ou|or|et|and|entre|between)(?![^\W\d_])", re.I
)
_PRINTED = re.compile(r"^(?:(?:np|numpy)\.)?(?:float64|float32|int64|int32|array)\(\[?([^(),\[\]]*)\]?\)")
_RANGE = re.compile(r"([0-9]+(?:[.,][0-9]+)?)\s*-\s*([0-9]+(?:[.,][0-9]+)?)(?![0-9.,]*\s*[*/^(])")
_UNIT_START = re.compile(r"(?<![^\W\d_])[^\W\d_]|[°%]|(?<![0-9.,])1\s*/")
_MAX_PIECES = 8  #: names in the unit behind a formula


def without_name(text: str) -> str:
    """Return the text without ``rA =``, ``≈``, ``environ``, and without the full stop of a sentence."""
    if named := NAME.match(text):
        if says_value(named[0]):
            raise Stop("two_values", text)
        if _ELSEWHERE.search(named[0]) or _is_equation(named[0]):
            raise Stop("not_a_number", text)
        text = text[named.end() :]
    text = _ABOUT.sub("", text, count=1) if _ABOUT.match(text) else text
    return text.rstrip(" .;,!")


_NO_NAME = re.compile(
    r"(?<![^\W\d_])(?:not|no|non|ne|pas|or|ou|nor|ni|rather|plut[oô]t|instead|sinon|else|faux"
    r"|wrong)(?![^\W\d_])"
    r"|(?<![\w_^{(])[+-]?\s*(?:[0-9]+[.,][0-9]|[0-9]{3,}|[.,][0-9]|0(?![0-9]))|(?<![\w\s])\s*[+-]\s*[0-9]",
    re.I,
)  #: what is not a name of a quantity: another number (an index is none), or what is said against one


#: What refers to another place, or speaks of the sheet and not of a quantity: ``see question: 3``,
#: ``page: 2``, ``mark: 0``.
_ELSEWHERE = re.compile(
    r"(?<![^\W\d_])(?:voir|vois|see|cf|idem|ditto|same|m[eê]mes?|pareil|comme|like|page|pages|pp|note"
    r"|mark|marks|grade|score|points?"
    r"|temps restant|time left)(?![^\W\d_])(?!\s+[A-Z]\b)",
    re.I,
)


#: What is set equal to a number without being a name: an equation, a function of x, a sine or a square of a
#: symbol.
_NO_QUANTITY = re.compile(
    r"[eé]q(?:n|uation)?s?\.?\s*\(?[0-9]*\)?\s*[=:]|[fgh]\s*\(\s*[a-z]\s*\)\s*=|y\s*\(\s*x\s*\)\s*="
    r"|\\?(?:sin|cos|tan|exp|ln"
    r"|log)(?![a-z])(?:\^\(?[0-9]\)?)?\s*[({]?\s*(?!pi\b)[^\W\d][^=(){}+*/]*[)}]?\s*="
    r"|\\?(?:sin|cos|tan)\s*\^\(?2\)?+(?!\s*[({]?\s*[0-9])|e\s*\^"
    r"|(?:[Σ∑]|\\sum(?![a-z])|sum\s+(?:of\s+)?|somme\s+(?:des?\s+)?)\s*\\?(?:F|M|R|vec|forces?|moments?"
    r"|torques?|couples?|efforts?|actions?)(?![a-z])"
    r"|[^\W\d_]\w*\s*(?:\^|\*\*)\s*\(?[23]\)?\s*=",
    re.I,
)
_COMPARES = re.compile(r"(?<![-=])>|<(?![-=]*>)|[≤≥≠]|!\s*=|\\(?:leq?|geq?|neq?|lt|gt)(?![a-z])")
_WORKS = re.compile(r"[-+*/^]")  #: what a formula has, and a name seldom


def _is_equation(name: str) -> bool:
    """Return whether the text before an equals sign makes an equation or an inequality: ``f(x) =``, ``ΣF =``,
    ``x >=``."""
    if _NO_QUANTITY.match(name) or _COMPARES.search(name):
        return True
    left = name.rstrip(" =≈≃:")
    if not _WORKS.search(left):
        return False
    symbols = tuple(sorted({*re.findall(r"[^\W\d_]\w*", left)} - {*FUNCTIONS, "pi", "e"}))
    with suppress(Unreadable):
        formula = plain_expression(left, symbols)
        values = [
            formula.evaluate({symbol: 0.3 + k * n for n, symbol in enumerate(symbols, 1)})
            for k in (0.2, 0.31)
        ]
        return bool(formula.variables) and abs(values[0] - values[1]) < 1e-9  # it says nothing of its symbols
    return False


def says_value(name: str) -> bool:
    """Return whether the text before an equals sign or a colon states a value itself: ``not 3 :``, ``x or 2
    =``, ``two =``."""
    stripped = name.rstrip(" =≈≃:").casefold()
    return bool(_NO_NAME.search(stripped)) or stripped in number_words()


def _formula(text: str, target: Unit) -> list[Amount]:
    """Return a formula, with or without a unit behind it; the longest unit that leaves a formula is taken."""
    first: Unreadable | None = None
    for start in [*_unit_starts(text), len(text)]:
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
    """Return the values of a formula: one, but for ``1/2π``, which is (1/2)π or 1/(2π)."""
    if expression.other is None and not (unit or target).is_angle:
        expression = _meant(expression)
    if not expression.is_angle and (unit or target).is_angle:
        if expression.other and not expression.is_plain_quotient:
            raise Stop("two_values", expression.text)
        return [_of_angle(expression, unit, unit_text, target)]
    if expression.other and not expression.is_plain_quotient and not _alike(expression, expression.other):
        raise Stop("two_values", expression.text)
    amounts = []
    for reading in (expression, expression.other):
        if reading is None:
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
        else:
            amounts.append(written_amount(value, digits))
    return amounts


def _alike(first: Expression, other: Expression) -> bool:
    return math.isclose(first.evaluate(), other.evaluate(), rel_tol=1e-9)


# ------------------------------------------------------------------ angles

_FEW_TURNS = 2 * math.tau  #: rad, beyond which a number in a formula of an angle is in degrees
_PART_OF_PI = math.pi / 12


def _meant(expression: Expression) -> Expression:
    """Return a formula with the plain numbers in its sines, cosines and tangents as they are meant: in
    degrees, where they can be nothing else; in radians, where each is a part of pi. Raises Stop: nothing
    tells which, and it matters: ``degrees_or_radians``."""
    root = numbers_in_degrees(expression.root)
    if root == expression.root:
        return expression
    printed = Expression(expression.text, root)
    angles = [abs(angle) for angle in bare_angles(expression.root)]
    if any(angle > math.tau for angle in angles):
        return printed
    if _are_parts_of_pi(angles):
        return expression
    if math.isclose(printed.evaluate(), expression.evaluate(), rel_tol=1e-9, abs_tol=1e-12):
        return expression
    raise Stop("degrees_or_radians", expression.text)


def _are_parts_of_pi(angles: Sequence[float]) -> bool:
    """Return whether angles are fractions of pi in decimals, 1.571."""
    return bool(angles) and all(abs(n - _PART_OF_PI * round(n / _PART_OF_PI)) <= 1e-3 * n for n in angles)


def _of_angle(expression: Expression, unit: Unit | None, unit_text: str, target: Unit) -> Amount:
    """Return the one value of a formula of an angle, in the unit that the student chose: by writing it, or by
    what the formula holds.

    A multiple of pi is in radians, what is divided by pi in degrees. A number that is added to an inverse
    function, or stands in a sine, says which it is by its size: beyond two turns of radians it is in degrees,
    a part of pi is in radians.

    Raises Stop: nothing tells which: ``two_values``."""
    degree = parse_unit("deg")
    root, in_degrees = expression.root, expression.as_calculated_in_degrees
    if unit is not None:
        calculated = in_degrees if in_degrees and unit.ratio == degree.ratio else expression
        value = calculated.evaluate()
        return written_amount(in_unit(value, unit, target), short_number(value), unit_text)
    own_unit = _unit_of(expression, in_degrees)
    if own_unit == "":
        value = _meant(expression).evaluate()
        return written_amount(value, short_number(value), assumed=target.text if root.speaks_of_pi else "")
    value = (in_degrees if in_degrees and own_unit == "deg" else _meant(expression)).evaluate()
    return written_amount(in_unit(value, parse_unit(own_unit), target), short_number(value), assumed=own_unit)


def _unit_of(expression: Expression, in_degrees: Expression | None) -> str:
    """``deg`` or ``rad`` where a formula without a unit says so, nothing where it leaves it to the sheet."""
    root = expression.root
    terms = root.args if root.kind == "sum" else (root,)
    powers = root.powers_of_pi
    if not root.speaks_of_pi and not root.has_inverse:
        return ""
    if 1 in powers or (root.speaks_of_pi and powers == {0} and root.has_inverse):
        numbers = [abs(_value_of(t)) for t in terms if t.powers_of_pi == {0} and not t.has_inverse]
        if powers - {0, 1} or any(number > _FEW_TURNS for number in numbers):
            raise Stop("two_values", expression.text)
        return "rad"
    if root.speaks_of_pi:
        if powers == {0, -1} and any(t.has_inverse and t.powers_of_pi == {0} for t in terms):
            raise Stop("two_values", expression.text)
        return "deg" if -1 in powers else ""
    if in_degrees is None:  # an inverse function of what holds a degree sign
        raise Stop("two_values", expression.text)
    degrees, radians = in_degrees.evaluate(), expression.evaluate()
    if math.isclose(degrees, math.degrees(radians), rel_tol=1e-9, abs_tol=1e-9):
        return "deg"
    angles = [abs(number) for number in _angles_in(root)]
    if abs(radians) > _FEW_TURNS or any(number > _FEW_TURNS for number in angles):
        return "deg"
    if _are_parts_of_pi(angles):
        return "rad"
    raise Stop("two_values", expression.text)


def _angles_in(node: Operation) -> Iterator[float]:
    """Yield the numbers of a formula that are angles: added to an inverse function, or the argument of a
    sine."""
    if node.kind == "sum" and node.has_inverse:
        yield from (_value_of(arg) for arg in node.args if not arg.has_inverse)
    if node.kind == "call" and node.name in ("sin", "cos", "tan") and not node.has_inverse:
        yield _value_of(node.args[0])
    for arg in node.args:
        yield from _angles_in(arg)


def _value_of(node: Operation) -> float:
    return float(Expression("", node).evaluate())


_PLUS_MINUS = re.compile(
    r"\(?\s*(?P<number>[+-]?\s*[0-9]+(?:[.,][0-9]+)?)\s*(?P<unit>[^\W\d_][^±()]*?|[°%])?\s*(?:±|\+/-|\+-)\s*"
    r"(?P<margin>[0-9]+(?:[.,][0-9]+)?)\s*\)?\s*(?P<rest>[^±()]*)"
)
_MARGIN = 0.05  #: the share of a number that what is written behind ± may be, for it to be no other value


def _without_margin(text: str) -> str:
    """Return a number without the margin that is written with it: ``-414,6 ± 0,5 mm``."""
    match = _PLUS_MINUS.fullmatch(text)
    if match is None:
        return text
    number, margin = (float(match[name].replace(",", ".").replace(" ", "")) for name in ("number", "margin"))
    return (
        f"{match['number']} {match['unit'] or match['rest']}" if 0 < margin <= _MARGIN * abs(number) else text
    )


def _refuse_two_values(text: str) -> None:
    """``5 ± 0.1`` and ``3 to 4`` are two values; ``to do`` is none."""
    if (
        not _RANGE.match(text)
        and _TWO_VALUES.search(text)
        and "atan2" not in text.replace("arctan2", "atan2")
    ):
        raise Stop("two_values" if any(map(str.isdigit, text)) else "not_a_number", text)


def _refuse_ranges(text: str) -> None:
    """``3 - 4`` is two values; ``180 - 75.4`` is a difference, and so is ``3 - 4 = -1``."""
    pair = _RANGE.match(text)
    if pair and float(pair[1].replace(",", ".")) < float(pair[2].replace(",", ".")):
        raise Stop("two_values", text)


def _named_unit_unknown(text: str) -> Stop | None:
    """When a number is clear and only words follow, it is the unit that is not understood."""
    match = LITERAL.fullmatch(text)
    if match is None or not WORD.match(match["rest"]):
        return None
    try:
        parse_unit(match["rest"])
    except WrongUnit as error:
        return Stop("unknown_unit", getattr(error, "found", match["rest"]))
    return None


def read_amounts(text: str, target: Unit, thousands: bool = True, measured: bool = True) -> list[Amount]:
    """All honest readings of one number, the likelier first."""
    text = without_name(text)
    text = (
        _PRINTED.sub(r"\1", text)
        if "(" in text
        else _without_margin(text)
        if measured and ("±" in text or "+" in text)
        else text
    )
    if _PAIR.fullmatch(text):
        raise Stop("two_values", text)
    if within := in_brackets(text):
        text = without_name(within)
    if not text:
        raise Stop("not_a_number", text)
    if _NOT_FINITE.match(text):
        raise Stop("not_finite", text)
    is_ratio = measured and target.dimension == RATIO
    if is_ratio and (parts := _PROPORTION.fullmatch(text)):
        text = f"{parts[1]}/{parts[2]}"
    amounts = in_digits(text, target, thousands)
    if amounts is None and any(sign in text for sign in "([{=≈"):
        amounts = _written_twice(text, target, thousands)
    return _worked_out(text, target, per_one=is_ratio) if amounts is None else amounts


_PROPORTION = re.compile(r"([+-]?\s*[0-9]+(?:[.,][0-9]+)?)\s*:\s*([0-9]+(?:[.,][0-9]+)?)")  #: ``1.25:1``
RATIO = parse_unit("1").dimension


#: Dates, times of the day and telephone numbers: ``2026-12-04``, ``04/12/26``, ``12/04``, ``14:30``,
#: ``06 12 34 56 78``.
_CALENDAR = re.compile(
    r"(?:19|20)[0-9]{2}([-/.])(?:0[1-9]|1[0-2])\1(?:0[1-9]|[12][0-9]|3[01])"
    r"|[0-3]?[0-9]([-/.])[0-3]?[0-9]\2(?:19|20)[0-9]{2}"
    r"|[0-3][0-9]/[0-3][0-9]/[0-9]{2}|(?=.*(?<![0-9])0[1-9])[0-3][0-9]([-/])[0-3][0-9](?:\3[0-9]{2})?"
    r"|(?:(?:[01][0-9]|2[0-3]):[0-5][0-9]|[0-9]:0[0-9])(?::[0-5][0-9])?"
    r"|(?:\+[0-9]{2} ?[0-9]|0[1-9])(?:[ .-]?[0-9]{2}){4}"
)
_LETTER = re.compile(r"[+-]?\s*(?:(e)(?:\s+[^\W\d_].*)?|pi|π)", re.I)


def refuse_no_number(text: str, target: Unit) -> None:
    """Stop at a date, a time, a telephone number, and at a letter alone: ``e``, ``e mm``, and ``π`` but where
    an angle or a rate of one is asked."""
    letter = _LETTER.fullmatch(text)
    is_angle = target.is_angle or "rad" in target.text
    if _CALENDAR.fullmatch(text) or (letter and (letter[1] or not is_angle)):
        raise Stop("not_a_number", text)


#: ``(0,0)`` is a point; who writes 0 writes no bracket and comma.
_PAIR = re.compile(r"[(\[{]\s*[+-]?[0-9]+\s*,\s*0+\s*[)\]}]")


def _worked_out(text: str, target: Unit, *, per_one: bool = False) -> list[Amount]:
    """Return the readings of a formula that stands alone; ``per_one`` lets ``3/1`` be a ratio."""
    _refuse_ranges(text)
    if not per_one or not _PER_ONE.fullmatch(text):
        _refuse_several(text)
    return _calculated(text, target)


def _calculated(text: str, target: Unit) -> list[Amount]:
    """Return the readings of a formula."""
    _refuse_two_values(text)
    if (total := _sum_of_amounts(text, target)) is not None:
        return [total]
    amounts = scientific(text, target)
    try:
        return [*amounts, *_formula(text, target), *flattened(text, target)]
    except Unreadable as error:
        if amounts:
            return amounts
        words = error.code in ("unknown_symbol", "not_a_number")
        raise (words and _named_unit_unknown(text)) or error from None


_TERM = re.compile(r"\s*([+-]?)\s*([0-9]+(?:[.,][0-9]+)?)\s*([^\W\d_][^+()=]*?|[°%])\s*(?=[+-]\s*[0-9]|$)")


def _sum_of_amounts(text: str, target: Unit) -> Amount | None:
    """Numbers with a unit each that are added or taken off: ``200 mm + 70 mm``; nothing where a term is
    none."""
    terms = list(_TERM.finditer(text))
    if len(terms) < _SEVERAL or "".join(term[0] for term in terms) != text or re.search(r"\s[+-][0-9]", text):
        return None  # 0 mm -70 mm is two values
    units = [plain_unit(term[3]) for term in terms]
    if None in units or not all(term[1] for term in terms[1:]):
        return None
    values = [
        in_unit((-1 if term[1] == "-" else 1) * Fraction(term[2].replace(",", ".")), unit, target)
        for term, unit in zip(terms, units, strict=True)
        if unit is not None
    ]
    return written_amount(sum(values), short_number(sum(values)), target.text)


_SEVERAL = 2
_LITERAL = r"[+-]?\s*[0-9]+(?:[.,][0-9]+)?(?:[eE][+-]?[0-9]+)?"
_IN_BRACKETS = rf"[(\[{{]\s*{_LITERAL}\s*[)\]}}]"
_SIDE_BY_SIDE = re.compile(
    rf"{_LITERAL}(?:\s*{_IN_BRACKETS})+|{_IN_BRACKETS}\s*(?:{_IN_BRACKETS}\s*)*(?:{_IN_BRACKETS}"
    r"|[0-9][0-9.,]*(?:[eE][+-]?[0-9]+)?)"
)
_PER_ONE = re.compile(r"[^*/]+/\s*1")  #: ``3/1`` is a ratio as ``3:1`` is


_IDLE = re.compile(r"(?<![0-9.,])0*[01](?:[.,]0*)?(?![0-9])")  #: a number that may do nothing
_MEASURED = 3  #: digits of a number that nobody takes for a count, so that 0 beside it is no other answer
_FEW_NUMBERS = 3  #: of a formula; one of more, 3(0) - 2(1), is worked out by a rule


def _refuse_several(text: str) -> None:
    """Numbers side by side, ``(2) (1)``, ``1 [2]``, and those that a formula does nothing with, ``2 * 1``,
    ``2 + 0``, are several; one of them is the value."""
    for start in [*_unit_starts(text), len(text)]:
        unit_text, formula = text[start:], text[:start].rstrip("* ")
        if unit_text and plain_unit(unit_text) is None:
            continue
        if _SIDE_BY_SIDE.fullmatch(formula):
            raise Stop("two_values", text)
        if _IDLE.search(formula) is None:
            continue
        with suppress(Unreadable):
            root = plain_expression(formula).root
            numbers = sum(node.kind == "number" for node in root.walk())
            value = without_idle(root)
            is_measured = (root.kind, root.name) == ("sum", "++") and numbers == 2  # 270 + 0
            is_measured = is_measured and len(value.name.replace(".", "")) >= _MEASURED
            if 1 < numbers <= _FEW_NUMBERS and value.kind == "number" and not is_measured:
                raise Stop("two_values", text)


def _unit_starts(text: str) -> list[int]:
    """Return the indices at which a unit behind a formula may begin."""
    starts = [m.start() for m in _UNIT_START.finditer(text) if m.start() > 0 and len(text) - m.start() <= 60]
    return starts[-_MAX_PIECES:]


_CHECKED = re.compile(r"([^(=≈]*[^\s(=≈+*/^-])\s+(\(.*\))\s*([^()=≈]*)", re.DOTALL)
_ROUND = str.maketrans("[]{}", "()()")
_NOUGHT = re.compile(r"\s*[+-]?0+(?:[.,]0*)?\s*")
_EQUALS = re.compile(r"\s*[=≈]+\s*")


def _written_twice(text: str, target: Unit, thousands: bool) -> list[Amount] | None:
    """Return a number written in ways that agree: ``273.9 (273.92)``, ``180 - 75.4 = 104.6``; ``None`` where
    it is not.

    The number before the brackets is meant, or that behind the equals sign.
    """
    if (checked := _CHECKED.fullmatch(text.translate(_ROUND))) and (inside := in_brackets(checked[2])):
        unit = checked[3] and f" {checked[3]}"
        if unit and plain_unit(checked[3]) is None:
            return None
        return _checked(checked[1] + unit, inside, unit, target, thousands)
    pieces = _EQUALS.split(text)
    if len(pieces) != 2 or not all(pieces):
        return None
    is_idle = pieces[0] == pieces[1] and (pieces[0][0] in "([" or _NOUGHT.fullmatch(pieces[0]))
    if is_idle or any(map(_PAIR.fullmatch, pieces)):  # holds whatever is asked: 0 = 0, (1,2) = (1,2)
        raise Stop("not_a_number", text)
    other, end = (_reading_of(piece, target, thousands) for piece in pieces)
    if not (amounts := _agreeing(end, other, target)):
        raise Stop("two_values", text)
    return amounts


def _checked(number: str, inside: str, unit: str, target: Unit, thousands: bool) -> list[Amount] | None:
    """Return a number that what stands in brackets behind it confirms; ``2 (π/3)`` is a product, and
    ``None``."""
    meant = in_digits(number, target, thousands)
    if meant is None or not any(c in "0123456789π" for c in inside):
        return None
    says_more = bool(WORD.search(inside)) and not match_plain(inside)  # a unit, or what only a formula has
    try:
        other = _reading_of(inside + unit, target, thousands)
    except (Stop, Unreadable):
        other = [], inside
    amounts = _agreeing((meant, number), other, target)
    if not amounts and says_more and not (other[0] and other[0][0].unit and not unit):
        return None
    if not amounts:
        raise Stop("two_values", f"{number} ({inside})")
    return amounts


_ReadingWay = tuple[list[Amount], str]  #: what was read, and in which text


def _reading_of(text: str, target: Unit, thousands: bool) -> _ReadingWay:
    amounts = in_digits(text, target, thousands)
    return (_calculated(text, target) if amounts is None else amounts), text


def _agreeing(first: _ReadingWay, other: _ReadingWay, target: Unit) -> list[Amount]:
    """Return the readings of one way to write a number that the other confirms to the last digit of the
    shorter.

    An angle that does not say its unit may be in radians, where the other says what it is in degrees: then
    that is meant.
    """
    agreeing, radian = [], 1 / target.factor
    for a in first[0]:
        for b in other[0]:
            margins, its = _half_digit(a, first[1], target), _half_digit(b, other[1], target)
            if _is_near(a.value, b.value, max(margins, its)) or (
                target.is_angle
                and not b.unit
                and _is_near(a.value, b.value * radian, max(margins, its * radian))
            ):
                agreeing.append(a)
            elif (
                target.is_angle
                and not a.unit
                and _is_near(a.value * radian, b.value, max(margins * radian, its))
            ):
                agreeing.append(b)
    return agreeing


_ROUNDED = 0.015  #: the share of a number that its last digit may be of, for it to confirm another


def _is_near(first: float, other: float, half: float) -> bool:
    return abs(first - other) <= min(half, _ROUNDED * abs(first)) + 1e-6 * abs(first)


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
    candidates = list(distinct.values())[:2]
    return Reading(
        text,
        "read",
        tuple(a.value for a in candidates),
        tuple(a.echo for a in candidates),
        unit_given=any(a.unit for a in amounts),
    )


def _from_real(answer: Real) -> Reading:
    text = repr(float(answer)) if isinstance(answer, float) else text_of(answer)
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


#: A number on each of two lines, none of them going on.
_LINES = re.compile(r"[0-9][^\n]*\n\s*(?![\s=≈])[^\n]*[0-9]")


def read_number(text: Any, unit: str, *, thousands: bool = True, measured: bool = True) -> Reading:
    """Return a number, with or without its unit, in the canonical ``unit``.

    Without a unit it is in ``unit``; where ``unit`` is ``deg`` and the formula speaks of radians (``π/3``),
    radians are tried first. An int or float is taken as it is. Unless ``thousands``, the comma of ``1,234``
    is decimal and nothing else: a direction has no thousands of degrees, and modulo a turn any number may be
    near. Unless ``measured``, ``2:1`` and ``2/1`` are two numbers, and so are ``80 ± 2``: a count is not a
    ratio and has no margin.

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
    target_unit(unit)
    text = bare_value(text)
    if isinstance(text, Real) and not isinstance(text, bool):
        return _from_real(text)
    return (_read_text if text.__class__ is str else _read)(text, unit, thousands, measured)


def _read(text: Any, unit: str, thousands: bool, measured: bool) -> Reading:
    if isinstance(text, str) and "\n" in text and _LINES.search(text.replace("\r", "")):
        return Reading(text, "unreadable", code="two_values", found=shorten(" ".join(text.split())))

    def read(plain: str) -> Reading:
        plain, target = with_signs(plain), target_unit(unit)
        refuse_no_number(plain, target)
        texts = restated(plain, unit) if is_of_paper(unit) else (plain,)
        amounts = [a for piece in texts for a in read_amounts(piece, target, thousands, measured)]
        return _from_amounts(text, amounts)

    return reading_of(text, read)


_read_text = lru_cache(maxsize=4096)(_read)  #: a class writes the same, what is not a number above all


def read_numbers(texts: Sequence[object], unit: str) -> tuple[np.ndarray, np.ndarray]:
    """Many answers to one part at once: those that are plain digits are read here and now.

    Returns the values in ``unit`` (floats, NaN where there is none) and a mask (booleans) of the answers that
    :func:`read_number` has still to read: they have a unit, a formula, two readings, or nothing readable.
    What is neither read nor in the mask is missing. A value is the one that :func:`read_number` gives.

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


#: What a whole number may be of.
_COUNTED = re.compile(r"(?<=[0-9])\s*(?:ddl|dof|degrés? de libertés?|degrees? of freedom)[\s.]*$", re.I)


def read_integer(text: Any) -> Reading:
    """Return a whole number, without unit: ``3``, ``3,0``, ``γ = 3``, ``1 ddl``; the values are ints."""
    text = bare_value(text)
    counted = _COUNTED.sub("", text) if isinstance(text, str) and len(text) < MAX_LENGTH else text
    reading = read_number(counted, "1", measured=False)
    if counted is not text:
        reading = replace(reading, text=text)
    if reading.status != "read":
        return reading
    pairs = [p for p in zip(reading.values, reading.read_as, strict=True) if p[0].is_integer()]
    if len(pairs) > 1:  # 2*10+1 with or without its power of ten: which of the two was counted?
        return Reading(reading.text, "unreadable", code="two_values", found=shorten(reading.text))
    if not pairs or abs(pairs[0][0]) > _MAX_INTEGER:
        return Reading(reading.text, "unreadable", code="not_an_integer", found=shorten(reading.text))
    values, echoes = zip(*pairs, strict=True)
    return Reading(reading.text, "read", tuple(map(int, values)), echoes, reading.unit_given)
