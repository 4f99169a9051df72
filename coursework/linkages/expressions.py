"""Expressions of a mechanism's file: arithmetic in named quantities and numbers with units."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import numpy as np

from coursework.degrees import acos, asin, atan2, cos, sin, sqrt, tan
from coursework.errors import WrongUnit, WrongValue, nearest
from coursework.messages import Message
from coursework.parsing.units import Unit, convert, find_unit, parse_unit

FUNCTIONS = ("sin", "cos", "tan", "sqrt", "abs", "asin", "acos", "atan2", "hypot", "min", "max")
DEGREES = {f.__name__: f for f in (sin, cos, tan, asin, acos, atan2, sqrt)}  #: of code without quantities
_ARGUMENTS = {"atan2": 2, "hypot": 2, "min": 2, "max": 2}  #: of functions that take more than one
_MOST_POWER, _DEEPEST, _LARGEST = 9, 40, 1e12
_IN_CODE = {"min": "np.minimum", "max": "np.maximum", "hypot": "np.hypot"}
_LITERAL = re.compile(
    r"(?<![\w.])(\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)\s*([A-Za-zµ°][A-Za-z°²³]*(?:[*/^][A-Za-z0-9²³]+)*)"
)
_OPERATORS: Mapping[type, str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
_ARITHMETIC: Mapping[type, Callable[[float, float], float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: math.pow,
}  # fmt: skip
_COMPARISONS: Mapping[type, str] = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


@dataclass(frozen=True)
class QuantityExpression:
    """QuantityExpression as Python code over quantities, in their canonical units."""

    code: str
    names: tuple[str, ...] = ()

    @property
    def is_number(self) -> bool:
        """True for a number without quantities."""
        return not self.names

    @property
    def is_zero(self) -> bool:
        """True for the number 0."""
        return self.is_number and _number(self.code) == 0

    @property
    def is_name(self) -> bool:
        """True for the name of one quantity."""
        return self.code.isidentifier()


ZERO = QuantityExpression("0")


def _number(code: str) -> float | None:
    try:
        return float(code)
    except ValueError:
        return None


def _written(value: float) -> str:
    """Return a number as code.

    Raises
    ------
    WrongValue
        It is too large, or no number.
    """
    try:
        if abs(value) < _LARGEST:
            return f"{float(value):.15g}"
    except OverflowError:  # of a whole number
        pass
    raise WrongValue(Message("a number is too large"))


def _value(code: str) -> str:
    """Return the value of code without quantities, which is made of what an expression may hold alone."""
    if _number(code) is not None:
        return code
    known = {"np": np, "abs": abs, **DEGREES}
    try:
        with np.errstate(all="ignore"):
            return _written(float(eval(code, {"__builtins__": {}, **known})))
    except (ArithmeticError, TypeError, ValueError):
        raise WrongValue(Message("{text} has no value", text=code)) from None


def _refuse_comma(text: object) -> None:
    """Refuse a decimal comma, which TOML and expressions do not have; between brackets a comma parts two values."""
    if re.search(r"\d,\d", str(text)) and "(" not in str(text):
        right = re.sub(r"(\d),(\d)", r"\1.\2", str(text))
        raise WrongValue(
            Message(
                "a number has a decimal point, not a comma: {right}; found {text}",
                right=repr(right),
                text=repr(text),
            )
        )


def amount(text: object, unit: str) -> float:
    """Return a number that stands with its unit.

    Parameters
    ----------
    text
        ``"180 mm"``, or a number for the unit ``"1"``.
    unit
        Canonical unit.

    Returns
    -------
    The number in that unit.

    Raises
    ------
    WrongValue
        No number, or a unit that is missing or of another dimension; the message says what would do.
    """
    if isinstance(text, (int, float)) and not isinstance(text, bool):
        if unit == "1":
            return float(_written(text))
        raise WrongValue(Message('a unit is missing: "{text:g} {unit}"', text=text, unit=unit))
    _refuse_comma(text)
    match = re.fullmatch(r"\s*([+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)\s*(.*?)\s*", str(text))
    if match is None:
        raise WrongValue(
            Message('a number with its unit, such as "180 {unit}"; found {text}', unit=unit, text=repr(text))
        )
    if not match[2]:
        if unit == "1":
            return float(_written(float(match[1])))
        raise WrongValue(Message('a unit is missing: "{value} {unit}"', value=match[1], unit=unit))
    value = float(_written(float(match[1])))
    return float(convert(value, parse_unit(match[2]), unit))


def unit_of(text: object) -> str:
    """Return the unit that a number is written with; ``"1"`` for none.

    Raises
    ------
    WrongUnit
        It is no unit.
    """
    _refuse_comma(text)
    match = re.fullmatch(r"\s*[+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?\s*(.*?)\s*", str(text))
    if match is None or not match[1]:
        return "1"
    return canonical(parse_unit(match[1]))


def canonical(unit: Unit) -> str:
    """Return the unit in which the course has quantities of this dimension; the unit itself for any other."""
    for text in ("mm", "deg", "rad/s", "rad/s^2", "mm/s", "mm/s^2", "N*m", "N", "kg", "kg*m^2", "s", "1"):
        if parse_unit(text).dimension == unit.dimension:
            return text
    return unit.text


class ExpressionReader:
    """Reader of expressions in quantities of known units.

    Parameters
    ----------
    units
        Canonical unit by name of the quantities that an expression may use.
    calls
        Functions of the file's own, such as ``is_crank(2)``: from the arguments as text to code.
    """

    def __init__(
        self, units: Mapping[str, str], calls: Mapping[str, Callable[..., QuantityExpression]] | None = None
    ) -> None:
        self.units = units
        self.calls = calls or {}

    def read(self, text: object, unit: str) -> QuantityExpression:
        """Read an expression whose value has a unit.

        Parameters
        ----------
        text
            Text, or a number where the unit is ``"1"``.
        unit
            Canonical unit of the value.

        Returns
        -------
        The expression.

        Raises
        ------
        WrongValue
            It cannot be read, names no quantity, or has another dimension.
        """
        _refuse_comma(text)
        if isinstance(text, (int, float)) and not isinstance(text, bool):
            return QuantityExpression(f"{amount(text, unit):.15g}")
        tree, literals = self._tree(text)
        code, names, found = self._of(tree, literals)
        if found is not None and not _alike(found, unit):
            number = _number(code)
            if number is not None and found == "1":
                if number == 0:
                    return ZERO
                raise WrongValue(Message('a unit is missing: "{number:g} {unit}"', number=number, unit=unit))
            raise WrongValue(
                Message(
                    "{text} is in {found}, where a value in {unit} stands",
                    text=repr(text),
                    found=_shown(found),
                    unit=unit,
                )
            )
        return QuantityExpression(code, names) if names else QuantityExpression(_value(code))

    def condition(self, text: object) -> QuantityExpression:
        """Read a condition: comparisons and calls, joined by ``and`` and ``or``.

        Raises
        ------
        WrongValue
            It cannot be read, or compares what has different units.
        """
        tree, literals = self._tree(text)
        code, names = self._condition(tree, literals, str(text))
        return QuantityExpression(code, names)

    def _tree(self, text: object) -> tuple[ast.expr, dict[str, tuple[float, str]]]:
        if not isinstance(text, str) or not text.strip() or len(text) > 500:
            raise WrongValue(Message("an expression in quotes; found {text}", text=repr(text)))
        literals: dict[str, tuple[float, str]] = {}

        def literal(match: re.Match[str]) -> str:
            unit = find_unit(match[2])
            if unit is None:
                return match[0]
            name = f"_literal{len(literals)}"
            home = canonical(unit)
            literals[name] = float(convert(float(_written(float(match[1]))), unit, home)), home
            return name

        try:
            tree = ast.parse(_LITERAL.sub(literal, text).replace("^", "**").strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError):
            raise WrongValue(Message("{text} is no expression", text=repr(text))) from None
        if _depth(tree) > _DEEPEST:
            raise WrongValue(Message("{text} is nested too deep", text=repr(text)))
        return tree, literals

    def _of(
        self, node: ast.expr, literals: Mapping[str, tuple[float, str]]
    ) -> tuple[str, tuple[str, ...], str | None]:
        """Return the code, the names, and the unit of a tree; None for a unit that is not followed."""
        match node:
            case ast.Constant(value=value) if isinstance(value, (int, float)) and not isinstance(value, bool):
                return _written(value), (), "1"
            case ast.Name(id=name) if name in literals:
                return f"{literals[name][0]:.15g}", (), literals[name][1]
            case ast.Name(id=name):
                if name == "pi":
                    return "np.pi", (), "1"
                if name not in self.units:
                    raise WrongValue(
                        Message("no quantity {name!r}{near}", name=name, near=nearest(name, self.units))
                    )
                return name, (name,), self.units[name]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                code, names, unit = self._of(operand, literals)
                return f"-{_bracketed(code)}", names, unit
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                first, second = self._of(left, literals), self._of(right, literals)
                if isinstance(op, ast.Pow):
                    self._check_power(node, second[0])
                code = f"{_bracketed(first[0])} {_OPERATORS[type(op)]} {_bracketed(second[0])}"
                if (one := _number(first[0])) is not None and (other := _number(second[0])) is not None:
                    code = self._folded(node, op, one, other)
                return code, _joined(first[1], second[1]), self._combined(op, first, second)
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in FUNCTIONS:
                if len(arguments) != _ARGUMENTS.get(name, 1):
                    raise WrongValue(
                        Message("{name} takes {count} values", name=name, count=_ARGUMENTS.get(name, 1))
                    )
                read = [self._of(a, literals) for a in arguments]
                code = f"{_IN_CODE.get(name, name)}({', '.join(r[0] for r in read)})"
                unit = {"atan2": "deg", "asin": "deg", "acos": "deg", "sqrt": None}.get(
                    name, read[0][2] if read and name in ("abs", "hypot", "min", "max") else "1"
                )
                return code, _joined(*(r[1] for r in read)), unit
        raise WrongValue(
            Message(
                "an expression has names, numbers with units, + - * / ** and {functions}; found {found}",
                functions=", ".join(FUNCTIONS),
                found=ast.unparse(node),
            )
        )

    @staticmethod
    def _check_power(node: ast.BinOp, exponent: str) -> None:
        """Refuse powers whose digits could fill the memory: of powers, and with large exponents."""
        value = _number(exponent)
        nested = any(isinstance(n, ast.Pow) for n in ast.walk(node.left))
        if value is None or abs(value) > _MOST_POWER or nested:
            raise WrongValue(
                Message(
                    "the exponent of a power is a number up to {most}, and its base no power; found {found}",
                    most=_MOST_POWER,
                    found=ast.unparse(node),
                )
            )

    @staticmethod
    def _folded(node: ast.BinOp, op: ast.operator, one: float, other: float) -> str:
        """Return the value of an operation on two numbers."""
        try:
            return _written(_ARITHMETIC[type(op)](one, other))
        except (ArithmeticError, ValueError):
            raise WrongValue(Message("{text} has no value", text=ast.unparse(node))) from None

    @staticmethod
    def _combined(op: ast.operator, first: tuple, second: tuple) -> str | None:
        if isinstance(op, (ast.Add, ast.Sub)):
            for one, other in ((first, second), (second, first)):
                if one[2] is not None and other[2] is not None and not _alike(one[2], other[2]):
                    if _number(one[0]) == 0:
                        return other[2]
                    raise WrongValue(
                        Message(
                            "{first} is in {one}, {second} in {other}: they do not add up",
                            first=first[0],
                            one=_shown(first[2]),
                            second=second[0],
                            other=_shown(second[2]),
                        )
                    )
            return first[2]
        if isinstance(op, ast.Mult):
            return first[2] if second[2] == "1" else second[2] if first[2] == "1" else None
        if isinstance(op, ast.Div):
            return first[2] if second[2] == "1" else "1" if first[2] == second[2] and first[2] else None
        return "1" if first[2] == "1" else None

    def _condition(
        self, node: ast.expr, literals: Mapping[str, tuple[float, str]], text: str
    ) -> tuple[str, tuple[str, ...]]:
        match node:
            case ast.BoolOp(op=op, values=values):
                read = [self._condition(v, literals, text) for v in values]
                sign = " & " if isinstance(op, ast.And) else " | "
                return sign.join(f"({code})" for code, _ in read), _joined(*(names for _, names in read))
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                code, names = self._condition(operand, literals, text)
                return f"~({code})", names
            case ast.Compare(left=left, ops=ops, comparators=right) if all(
                type(op) in _COMPARISONS for op in ops
            ):
                sides = [self._side(side, literals) for side in (left, *right)]
                units = [unit for _, _, unit in sides if unit is not None]
                for code, _, unit in sides:
                    if (
                        unit is not None
                        and not _alike(unit, units[0])
                        and _number(code) != 0
                        and _number(sides[0][0]) != 0
                    ):
                        raise WrongValue(
                            Message(
                                "{text} compares {one} with {other}",
                                text=repr(text),
                                one=_shown(units[0]),
                                other=_shown(unit),
                            )
                        )
                pieces = [
                    f"({sides[k][0]} {_COMPARISONS[type(op)]} {sides[k + 1][0]})" for k, op in enumerate(ops)
                ]
                return " & ".join(pieces), _joined(*(names for _, names, _ in sides))
            case ast.Call(func=ast.Name(id=name)) if name in self.calls:
                found = self._called(node)
                return found.code, found.names
        raise WrongValue(
            Message(
                'a condition compares, such as "r2 < r4", or calls {functions}; found {text}',
                functions=", ".join(self.calls),
                text=repr(text),
            )
        )

    def _side(
        self, node: ast.expr, literals: Mapping[str, tuple[float, str]]
    ) -> tuple[str, tuple[str, ...], str | None]:
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in self.calls:
            found = self._called(node)
            return found.code, found.names, "deg"
        return self._of(node, literals)

    def _called(self, node: ast.Call) -> QuantityExpression:
        assert isinstance(node.func, ast.Name)
        return self.calls[node.func.id](*(ast.unparse(a).strip("'\"") for a in node.args))


def _depth(tree: ast.AST) -> int:
    """Return how deep a tree is, counted level by level."""
    level, depth = [tree], 0
    while level:
        level, depth = [child for node in level for child in ast.iter_child_nodes(node)], depth + 1
    return depth


def _bracketed(code: str) -> str:
    return code if re.fullmatch(r"[\w.]+|[\w.]+\([^()]*\)", code) else f"({code})"


def _joined(*several: Collection[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(name for names in several for name in names))


def _alike(first: str, second: str) -> bool:
    return parse_unit(first).dimension == parse_unit(second).dimension


def _shown(unit: str) -> str:
    return "no unit" if unit == "1" else unit


__all__ = [
    "FUNCTIONS",
    "ZERO",
    "ExpressionReader",
    "QuantityExpression",
    "WrongUnit",
    "amount",
    "canonical",
    "unit_of",
]
