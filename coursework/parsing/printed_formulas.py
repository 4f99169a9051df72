"""Values of printed formulas, read off the LaTeX as a reader reads them off the paper.

The tree that every sheet is printed from (:mod:`coursework.rendering.formula_tree`) is evaluated, not the
code that printed it: a sign, a bracket or a degree that is lost on the way gives another number. Angles
marked with a degree sign are in degrees, all others in radians. A formula that holds a letter or a word
without a value is none.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coursework.errors import BadStatement, CourseworkError
from coursework.markup.formula_tree import (
    Fence,
    FormulaRow,
    FormulaText,
    Fraction,
    Name,
    Node,
    Num,
    Root,
    Script,
    Space,
    Symbol,
    parse,
)
from coursework.messages import as_message

DEGREE = math.pi / 180
_EXACT = 1e-9  #: of a number: what it may lack of one that is printed in full (``language.significant``)


class NotEvaluable(CourseworkError, ValueError):
    """A formula that gives no number: what in it has none."""


@dataclass(frozen=True)
class FormulaValue:
    """Value of a printed formula, and the amount by which the rounding of its numbers may move it.

    ``values`` holds a number, or a number a coordinate of a vector; complex where the formula is, NaN where
    it does not exist. ``widths`` holds as many bounds: the moves of a value when each number is moved by half
    of its last printed digit, added up; infinite where the value comes into being or ceases to be on the way.
    """

    values: tuple[complex, ...]
    widths: tuple[float, ...]


def read(latex: str, rounded_to: int, *, is_angle: bool = False) -> FormulaValue:
    """Evaluate a formula.

    A number that is printed with fewer than ``rounded_to`` significant digits is exact but for its last bits,
    any other is right to half of its last digit. The values of ``is_angle`` are angles in radians: a whole
    turn moves them by nothing.

    Raises
    ------
    NotEvaluable
        A part of it has no value, or it can be read in several ways.
    """
    try:
        tree = parse(latex)
    except BadStatement as fault:
        raise NotEvaluable(as_message(fault)) from fault
    numbers = _numbers(tree)
    halves = [_half_step(number, rounded_to) for number in numbers]
    columns = _columns(tree, numbers, halves)
    if any(np.isnan(column[0]) for column in columns):
        # Many numbers moved together may bring it into being: each is moved as far as all of them.
        columns = _columns(tree, numbers, [len(halves) * half for half in halves])
    return FormulaValue(
        tuple(column[0].item() for column in columns), tuple(_width(column, is_angle) for column in columns)
    )


def _columns(tree: FormulaRow, numbers: Sequence[Num], halves: Sequence[float]) -> list[np.ndarray]:
    """Return the coordinates that a tree gives: as printed, then with each number moved up, and down."""
    with np.errstate(all="ignore"):
        value = Evaluation(numbers, halves).of(tree)
        coordinates = value if isinstance(value, tuple) else (value,)
        return [np.broadcast_to(np.asarray(c), (1 + 2 * len(halves),)) for c in coordinates]


def _width(column: np.ndarray, is_angle: bool) -> float:
    """Return the larger move of each number's two, added up over the numbers."""
    exists = np.isfinite(column)
    if not exists.all():
        return math.inf if exists.any() else 0.0
    moves = np.abs(column[1:] - column[0])
    if is_angle:
        moves = np.minimum(moves, np.abs(moves - 2 * math.pi))
    return float(np.maximum(moves[::2], moves[1::2]).sum())


def _numbers(node: Any) -> list[Num]:
    """Return the numbers of a tree."""
    if isinstance(node, Num):
        return [node]
    if isinstance(node, tuple):
        return [number for item in node for number in _numbers(item)]
    inner = {
        FormulaRow: ("items",),
        Fraction: ("above", "below"),
        Root: ("body",),
        Fence: ("body",),
        Script: ("base", "above"),
    }.get(type(node), ())
    return [number for name in inner for number in _numbers(getattr(node, name))]


def _half_step(number: Num, rounded_to: int) -> float:
    """Return the greatest difference between a printed number and the one that was rounded to it."""
    exponent = int(number.exponent or 0)
    digits = number.digits.replace(".", "").lstrip("0")
    if len(digits) < rounded_to:
        return _EXACT * float(f"{number.digits}e{exponent}")
    return 0.5 * 10.0 ** (exponent - len(number.digits.partition(".")[2]))


def _atan2(y: Any, x: Any) -> Any:
    return np.arctan2(_real(y), _real(x))


def _single(value: Any) -> Any:
    if isinstance(value, tuple):
        raise NotEvaluable("a vector stands where a number is expected")
    return value


def _real(value: Any) -> Any:
    if np.iscomplexobj(_single(value)):
        raise NotEvaluable("a complex number stands where a real one is expected")
    return value


def _of_reals(function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *values: function(*map(_real, values))


_FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    "sin": _of_reals(np.sin),
    "cos": _of_reals(np.cos),
    "tan": _of_reals(np.tan),
    "arcsin": _of_reals(np.arcsin),
    "arccos": _of_reals(np.arccos),
    "arctan": _of_reals(np.arctan),
    "atan2": _atan2,
    "exp": np.exp,
    "ln": _of_reals(np.log),
    "sinh": _of_reals(np.sinh),
    "cosh": _of_reals(np.cosh),
    "tanh": _of_reals(np.tanh),
    "sgn": _of_reals(np.sign),
    "hypot": _of_reals(np.hypot),
    "min": _of_reals(lambda *values: np.minimum.reduce(np.broadcast_arrays(*values))),
    "max": _of_reals(lambda *values: np.maximum.reduce(np.broadcast_arrays(*values))),
    "arg": np.angle,
    "Re": np.real,
    "Im": np.imag,
}
_SEVERAL = ("atan2", "hypot", "min", "max")
_PLUS, _MINUS = Symbol("+", "binary"), Symbol("−", "binary")
_TIMES = (Symbol("×", "binary"), Symbol("⋅", "binary"))
_SEMICOLON = Symbol(";", "punctuation")
_DEGREE = (Symbol("∘", "ordinary"), Symbol("°", "ordinary"))
DEGREE_SIGNS = (*_DEGREE, *(FormulaRow((sign,)) for sign in _DEGREE))
_LETTERS = {"π": math.pi, "i": 1j}


class Evaluation:
    """One evaluation of a tree. Every value is a column: as printed, then with each number moved up, and
    down."""

    def __init__(self, numbers: Sequence[Num], halves: Sequence[float]):
        self.halves = halves
        # By identity: a number that is printed twice is two, since either may be another quantity.
        self.places = {id(number): index for index, number in enumerate(numbers)}

    def of(self, node: Node) -> Any:
        match node:
            case Num():
                return self._number(node)
            case Symbol(text=text, kind="digits"):
                return float(text)
            case Symbol(text=text) if text in _LETTERS:
                return _LETTERS[text]
            case FormulaRow(items=items):
                return _FormulaLine(self, [item for item in items if not isinstance(item, Space)]).value()
            case Fraction(above=above, below=below):
                return np.true_divide(self.of(above), self.of(below))
            case Root(body=body, index=None):
                return np.sqrt(_real(self.of(body)))
            case Fence(left="(", body=body, right=")"):
                return self.of(body)
            case Fence(left="|", body=body, right="|"):
                return np.abs(self.of(body))
            case Script(base=base, below=None, above=above, primes=0) if above is not None:
                return self._raised(base, above)
        raise NotEvaluable("{piece} has no value", piece=_piece_text(node))

    def _number(self, number: Num) -> Any:
        column = np.full(1 + 2 * len(self.halves), float(f"{number.digits}e{number.exponent or 0}"))
        if number.negative:
            column = -column
        index = self.places[id(number)]
        half = self.halves[index]
        column[1 + 2 * index : 3 + 2 * index] += (half, -half)
        return column

    def _raised(self, base: Node, above: Node) -> Any:
        if above in DEGREE_SIGNS:
            return self.of(base) * DEGREE
        if base == Symbol("e", "letter"):
            return np.exp(self.of(above))
        if isinstance(base, Num) and base.negative:
            return -self.power(np.abs(self.of(base)), above)  # the sign stands before the power
        return self.power(self.of(base), above)

    def called(self, name: str, arguments: Sequence[Any]) -> Any:
        """Return a function of its arguments."""
        return _FUNCTIONS[name](*arguments)

    def power(self, value: Any, exponent: Node) -> Any:
        """Return a power; a whole exponent is exact, since a negative number has no other power."""
        times = np.ravel(self.of(exponent))
        return value ** (times[0] if times[0] == np.rint(times[0]) else times)


class _FormulaLine:
    """Items side by side: sums of products, and what functions are of."""

    def __init__(self, evaluation: Evaluation, items: Sequence[Node]):
        self.evaluation = evaluation
        self.items = items
        self.at = 0

    def value(self) -> Any:
        """Return a number, or a tuple where semicolons part several."""
        values = [self._sum()]
        while self._taken(_SEMICOLON):
            values.append(self._sum())
        if self.at < len(self.items):
            raise NotEvaluable("{piece} has no value", piece=_piece_text(self.items[self.at]))
        return values[0] if len(values) == 1 else tuple(values)

    def _next(self) -> Node | None:
        return self.items[self.at] if self.at < len(self.items) else None

    def _taken(self, *symbols: Symbol) -> bool:
        is_next = self._next() in symbols
        self.at += is_next
        return is_next

    def _sum(self) -> Any:
        total = -_single(self._product()) if self._taken(_MINUS) else self._product()
        while self._next() in (_PLUS, _MINUS):
            minus = self._taken(_MINUS) or not self._taken(_PLUS)
            term = _single(self._product())
            total = _single(total) - term if minus else _single(total) + term
        return total

    def _product(self) -> Any:
        value = self._factor()
        while (item := self._next()) is not None:
            before = self.items[self.at - 1]
            if not self._taken(*_TIMES):
                if _is_digits(item) and _is_digits(before):
                    raise NotEvaluable(
                        "{piece} follows a number without a sign between them", piece=_piece_text(item)
                    )
                if not _is_factor(item):
                    break
            value = _single(value) * _single(self._factor())
        return value

    def _factor(self) -> Any:
        item = self._next()
        if item is None:
            raise NotEvaluable("an operand is missing")
        self.at += 1
        if isinstance(item, Symbol) and item.text == "(":
            return self._bracketed()
        if isinstance(item, Name):
            return self._function(item.text)
        if (
            isinstance(item, Script)
            and isinstance(item.base, Name)
            and item.below is None
            and item.above is not None
            and not item.primes
        ):
            return self.evaluation.power(self._function(item.base.text), item.above)
        return self.evaluation.of(item)

    def _bracketed(self) -> Any:
        """Return the value inside brackets of one size, which hand-written formulas may have."""
        value = self._sum()
        item = self._next()
        self.at += 1
        if isinstance(item, Script) and item.base == Symbol(")", "closing") and item.below is None:
            if item.primes or item.above is None:
                raise NotEvaluable("a bracket with a prime has no value")
            return self.evaluation.power(value, item.above)
        if item != Symbol(")", "closing"):
            raise NotEvaluable("a bracket is not closed")
        return value

    def _function(self, name: str) -> Any:
        """Return a function of what stands in the brackets after it, or of the one factor that follows."""
        if name not in _FUNCTIONS:
            raise NotEvaluable("{name} has no value", name=name)
        argument = self._factor()
        arguments = argument if isinstance(argument, tuple) else (argument,)
        if (len(arguments) > 1) != (name in _SEVERAL):
            raise NotEvaluable("{name} of {count} values is not known", name=name, count=len(arguments))
        return self.evaluation.called(name, arguments)


def _is_digits(item: Node) -> bool:
    base = item.base if isinstance(item, Script) else item
    return isinstance(base, Num) or (isinstance(base, Symbol) and base.kind == "digits")


def _is_factor(item: Node) -> bool:
    """Return whether an item may follow another one as a factor, without a sign."""
    if isinstance(item, Script):
        return _is_factor(item.base)
    if isinstance(item, Symbol):
        return item.kind == "letter" or item.text == "("
    return _is_digits(item) or isinstance(item, (Name, Fraction, Root, Fence))


def _piece_text(node: Node) -> str:
    """Return a piece of a formula as a reader names it."""
    match node:
        case Symbol(text=text) | Name(text=text) | FormulaText(text=text):
            return text
        case Num(negative=negative, digits=digits):
            return "-" * negative + digits
        case Script(base=base):
            return _piece_text(base)
        case FormulaRow(items=items):
            return "".join(map(_piece_text, items))
    return type(node).__name__.lower()
