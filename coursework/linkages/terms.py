"""Sums of products as Python code, without the terms that vanish."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TypeAlias

Product: TypeAlias = tuple[int, tuple[str, ...]]  #: sign, factors as code


@dataclass(frozen=True)
class Sum:
    """Sum of signed products of codes; without products it is 0."""

    products: tuple[Product, ...] = ()

    @staticmethod
    def of(code: str) -> Sum:
        """Return the sum of one code; a code of several terms stands in brackets."""
        if is_zero(code):
            return Sum()
        return Sum(((1, (_factor(code),)),)) if code != "1" else Sum(((1, ()),))

    @property
    def vanishes(self) -> bool:
        return not self.products

    def __add__(self, other: Sum) -> Sum:
        return Sum(self.products + other.products)

    def __neg__(self) -> Sum:
        return Sum(tuple((-sign, factors) for sign, factors in self.products))

    def __sub__(self, other: Sum) -> Sum:
        return self + -other

    def times(self, *codes: str, sign: int = 1) -> Sum:
        """Return the sum with each product multiplied by codes; ``0``, ``1`` and ``-1`` are worked out."""
        for code in codes:
            if is_zero(code) or not sign:
                return Sum()
            if code.startswith("-") and _is_atom(code[1:]):
                code, sign = code[1:], -sign
            if code != "1":
                self = Sum(tuple((s, (*factors, _factor(code))) for s, factors in self.products))
        return self if sign > 0 else -self

    @property
    def code(self) -> str:
        """The sum as code."""
        pieces: list[str] = []
        for sign, factors in sorted(self.products, key=lambda p: p[0] < 0) if self.products else ():
            text = " * ".join(sorted(factors, key=lambda f: "(" in f)) or "1"
            pieces.append(
                f"{'-' if sign < 0 else '+'} {text}" if pieces else f"{'-' if sign < 0 else ''}{text}"
            )
        return " ".join(pieces) or "0"

    @property
    def factor(self) -> str:
        """The sum as code that may stand in a product."""
        return _factor(self.code)


def is_zero(code: str) -> bool:
    """Return whether a code is the number 0."""
    try:
        return float(code) == 0
    except ValueError:
        return False


def _is_atom(code: str) -> bool:
    return re.fullmatch(r"[\w.]+(\*\*2)?|[\w.]+\([^()]*\)", code) is not None


def _factor(code: str) -> str:
    return code if _is_atom(code) else f"({code})"


@dataclass(frozen=True)
class Heading:
    """Direction: signed quantities in degrees, and a constant."""

    names: tuple[tuple[int, str], ...] = ()
    constant: float = 0.0

    @staticmethod
    def of(code: str) -> Heading:
        """Return the direction of a code: a number or one expression."""
        try:
            return Heading((), float(code))
        except ValueError:
            return Heading(((1, code if code.isidentifier() else f"({code})"),))

    def __add__(self, other: Heading) -> Heading:
        rest = [*self.names]
        for sign, name in other.names:
            if (-sign, name) in rest:
                rest.remove((-sign, name))
            else:
                rest.append((sign, name))
        return Heading(tuple(rest), self.constant + other.constant)

    def __neg__(self) -> Heading:
        return Heading(tuple((-sign, name) for sign, name in self.names), -self.constant)

    def __sub__(self, other: Heading) -> Heading:
        return self + -other

    @property
    def code(self) -> str:
        """The direction as code."""
        text = ""
        for sign, name in sorted(self.names, key=lambda p: p[0] < 0):
            text += f" {'+' if sign > 0 else '-'} {name}" if text else f"{'' if sign > 0 else '-'}{name}"
        if self.constant or not text:
            size = f"{abs(self.constant):.12g}"
            text += f" {'+' if self.constant > 0 else '-'} {size}" if text else f"{self.constant:.12g}"
        return text

    @property
    def vanishes(self) -> bool:
        """True if this is the direction zero."""
        return not self.names and not self.constant

    def after(self, code: str) -> str:
        """Return the code of an angle with this direction added to it."""
        if self.vanishes:
            return code
        rest = self.code
        return f"{code} - {rest[1:]}" if rest.startswith("-") else f"{code} + {rest}"

    @property
    def cos(self) -> str:
        """Its cosine as code; a number for a constant direction."""
        return self._function(math.cos, "cos")

    @property
    def sin(self) -> str:
        """Its sine as code; a number for a constant direction."""
        return self._function(math.sin, "sin")

    def _function(self, function: object, name: str) -> str:
        if self.names:
            return f"{name}({self.code})"
        value = (math.cos if name == "cos" else math.sin)(math.radians(self.constant))
        quarter = round(value)
        return (
            str(quarter)
            if abs(value - quarter) < 1e-15 and self.constant % 90 == 0
            else f"{name}({self.code})"
        )


@dataclass(frozen=True)
class Plane:
    """Vector by its two components."""

    x: Sum = Sum()
    y: Sum = Sum()

    @staticmethod
    def polar(length: Sum, heading: Heading) -> Plane:
        """Return the vector of a length in a direction."""
        return Plane(length.times(heading.cos), length.times(heading.sin))

    def __add__(self, other: Plane) -> Plane:
        return Plane(self.x + other.x, self.y + other.y)

    def __neg__(self) -> Plane:
        return Plane(-self.x, -self.y)

    def __sub__(self, other: Plane) -> Plane:
        return Plane(self.x - other.x, self.y - other.y)

    @property
    def turned(self) -> Plane:
        """The vector turned by a quarter of a turn, anticlockwise."""
        return Plane(-self.y, self.x)

    def times(self, *codes: str, sign: int = 1) -> Plane:
        """Return the vector multiplied by codes."""
        return Plane(self.x.times(*codes, sign=sign), self.y.times(*codes, sign=sign))

    def along(self, heading: Heading) -> Sum:
        """Return its component in a direction."""
        return self.x.times(heading.cos) + self.y.times(heading.sin)

    def across(self, heading: Heading) -> Sum:
        """Return its component to the left of a direction."""
        return self.y.times(heading.cos) - self.x.times(heading.sin)

    @property
    def vanishes(self) -> bool:
        return self.x.vanishes and self.y.vanishes

    @property
    def complex(self) -> str:
        """The vector as code of a complex number."""
        return f"{self.x.code} + 1j * {self.y.factor}" if not self.vanishes else "0j"
