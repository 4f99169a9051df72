"""Equations as people write them: two formulas with an equals sign between them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from numbers import Real
from typing import Any

import numpy as np

from coursework.parsing.expressions import plain_expression
from coursework.parsing.reading import Reading, Stop, bare_value, reading_of, text_of
from coursework.parsing.spelling import plain_spelling, shorten
from coursework.parsing.trees import Expression, Operation, numbers_in_degrees
from coursework.parsing.units import plain_unit
from coursework.parsing.vocabulary import INVERSE, MAX_LENGTH, Unreadable, Value


@dataclass(frozen=True)
class Equation:
    """Two formulas with an equals sign between them."""

    text: str
    left: Expression
    right: Expression

    @property
    def variables(self) -> frozenset[str]:
        return self.left.variables | self.right.variables

    def difference(self, values: Mapping[str, object]) -> Value:
        """Left side minus right side."""
        return self.left.evaluate(values) - self.right.evaluate(values)

    def gap(self, values: Mapping[str, np.ndarray], count: int) -> tuple[np.ndarray, np.ndarray]:
        """Left side minus right side at points, of shape ``(count,)``, and the sum of their sizes.

        NaN where there is no value.
        """
        with np.errstate(all="ignore"):
            left = np.broadcast_to(value_or_nan(self.left, values), (count,))
            right = np.broadcast_to(value_or_nan(self.right, values), (count,))
            return left - right, np.abs(left) + np.abs(right)

    def with_numbers(self, values: Mapping[str, float]) -> Equation:
        """Return the equation with numbers in place of some of its symbols."""
        left, right = (Expression(self.text, _with_numbers(s.root, values)) for s in (self.left, self.right))
        return Equation(self.text, left, right)

    def in_degrees(self) -> Equation | None:
        """Return the equation with numbers that stand for angles taken as degrees: ``sin(theta2 + 90)``,
        ``cos(90)``.

        None where no such number is.
        """
        sides = [numbers_in_degrees(side.root) for side in (self.left, self.right)]
        if sides == [self.left.root, self.right.root]:
            return None
        return Equation(self.text, *(Expression(self.text, root) for root in sides))

    def without_inverse(self) -> Equation | None:
        """Return an angle that stands alone beside an inverse function, undone: ``x = atan(f)`` as
        ``tan(x) = f``.

        None where neither side is an inverse function, or no symbol stands beside it: ``atan(f) = 0``. Angles
        that differ by what the function cannot tell satisfy it too.
        """
        for side, other in ((self.left.root, self.right.root), (self.right.root, self.left.root)):
            if side.kind == "neg":
                side, other = side.args[0], Operation("neg", args=(other,))
            if side.kind == "call" and side.name in INVERSE and not other.constant:
                function = Operation("call", _UNDOES[side.name], (other,))
                argument = side.args[0] if len(side.args) == 1 else Operation("product", "*/", side.args)
                return Equation(self.text, Expression(self.text, function), Expression(self.text, argument))
        return None


_UNDOES = {"asin": "sin", "acos": "cos", "atan": "tan", "atan2": "tan"}


def _with_numbers(node: Operation, values: Mapping[str, float]) -> Operation:
    if node.kind == "variable" and node.name in values:
        return Operation("number", repr(values[node.name]))
    return replace(node, args=tuple(_with_numbers(arg, values) for arg in node.args))


def parse_equation(text: str, variables: Iterable[str]) -> Equation:
    """Read an equation over the given variables; there must be exactly one equals sign, which may be ``==``.

    Raises
    ------
    Unreadable
        As :func:`parse_expression`, and ``no_equals_sign``, ``two_equals_signs``.
    """
    if len(text) > MAX_LENGTH:
        message = f"an equation of {len(text)} characters is not read; at most {MAX_LENGTH} are"
        raise Unreadable(message, code="too_long", piece=text)
    return plain_equation(plain_spelling(text), variables, text)


def plain_equation(plain: str, variables: Iterable[str], text: str = "") -> Equation:
    """:func:`parse_equation` of a text whose spelling is plain; ``text`` is how it was written."""
    text = text or plain
    sides = re.split("==?", plain.strip("$ "))
    if len(sides) != 2:
        code = "no_equals_sign" if len(sides) == 1 else "two_equals_signs"
        raise Unreadable(
            f"an equation has one equals sign, {shorten(text)!r} has {len(sides) - 1}", code=code, piece=text
        )
    variables = tuple(variables)
    left, right = (plain_expression(side.strip(), variables) for side in sides)
    return Equation(text, left, right)


def value_or_nan(expression: Expression, values: Mapping[str, np.ndarray]) -> Value:
    """Return the value, NaN where there is none."""
    try:
        return expression.evaluate(values)
    except Unreadable:
        return math.nan


#: Of a class many write the same: each is parsed once.
_parsed_once = lru_cache(maxsize=1024)(plain_equation)


_TITLE = re.compile(r"[^=:]{1,40}:\s*(?!=)")
_BEHIND = re.compile(r"(?<=\S)\s+\(?(\S+?)\)?$")


def _read(plain: str, variables: tuple[str, ...]) -> Equation:
    """Return an equation, or what is left of it without a title before it, ``on y: …``, and without a unit
    behind it."""
    try:
        return _parsed_once(plain, variables)
    except Unreadable:
        if title := _TITLE.match(plain):
            return _read(plain[title.end() :], variables)
        behind = _BEHIND.search(plain)
        if behind is None or plain_unit(behind[1]) is None or plain[: behind.start()].endswith("="):
            raise
    return _parsed_once(plain[: behind.start()], variables)


# --- equations --------------------------------------------------------------------------


def read_equation(text: Any, variables: Iterable[str]) -> Reading:
    """Return an equation over the given variables; the value is an
    :class:`~coursework.parsing.equations.Equation`."""
    text = bare_value(text)
    if isinstance(text, Real) and not isinstance(text, bool):
        text = text_of(text)

    def read(plain: str) -> Reading:
        plain = plain.rstrip(" .;,")
        equation = _read(plain, tuple(variables))
        if not equation.variables:  # 0 = 0: nothing is said of the statement's symbols
            raise Stop("not_a_number", plain)
        return Reading(text, "read", (equation,), (plain,))

    return reading_of(text, read)
