"""Expressions of a mechanism's file: arithmetic in named quantities and numbers with units."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from coursework.degrees import acos, asin, atan2, cos, sin, sqrt, tan
from coursework.errors import WrongValue, cut_short, nearest
from coursework.messages import Message
from coursework.parsing.units import Unit, convert, find_unit, parse_unit, product, same_dimension

FUNCTIONS = ("sin", "cos", "tan", "sqrt", "abs", "asin", "acos", "atan2", "hypot", "min", "max")
DEGREES = {f.__name__: f for f in (sin, cos, tan, asin, acos, atan2, sqrt)}  #: of code without quantities
_ARGUMENTS = {"atan2": 2, "hypot": 2, "min": 2, "max": 2}  #: of functions that take more than one
_MOST_POWER, _DEEPEST, _LARGEST = 9, 40, 1e12
_IN_CODE = {"min": "np.minimum", "max": "np.maximum", "hypot": "np.hypot"}
_EQUALS = re.compile(r"(?<![<>=!])=(?!=)")  #: alone, which compares nothing
_LITERAL = re.compile(
    r"(?<![\w.])(\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)\s*([A-Za-zµ°][A-Za-z°²³]*(?:[*/^][A-Za-z0-9²³]+)*)(?!\w)"
)
#: The last factor of what may be a unit, or a unit and a quantity.
_SHARE = re.compile(r"[*/^][A-Za-z0-9²³]+\Z")
_OPERATORS: Mapping[type, str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
_ARITHMETIC: Mapping[type, Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: math.pow,
}
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
    """Refuse a decimal comma, which TOML and expressions do not have; between brackets a comma parts two
    values."""
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


CANONICAL = ("mm", "deg", "rad/s", "rad/s^2", "mm/s", "mm/s^2", "N*m", "N", "kg", "kg*m^2", "s", "1")
PLAIN = parse_unit("1")
#: A unit of each dimension, as messages name it.
_BASES = (
    "mm",
    "kg",
    "s",
    "rad",
    "A",
    "Hz",
    "K",
    "mol",
    "cd",
    "dB",
)


def canonical(unit: Unit) -> str:
    """Return the unit in which the course has quantities of this dimension; the unit itself for any other."""
    for text in CANONICAL:
        if parse_unit(text).dimension == unit.dimension:
            return text
    return unit.text


@dataclass(frozen=True)
class _Read:
    """Piece of an expression that was read: code over quantities in their canonical units, and the unit of
    its value."""

    code: str
    names: tuple[str, ...] = ()
    unit: Unit = PLAIN

    @property
    def is_plain(self) -> bool:
        return not any(self.unit.dimension)

    @property
    def text(self) -> str:
        """The piece as messages quote it."""
        code = self.code.replace("np.", "").replace("**", "^")
        return code if self.is_plain or _number(code) is None else f"{code} {_spelled(self.unit)}"

    def in_unit(self, unit: Unit | str) -> str:
        """Return the code of the value in another unit of its dimension."""
        factor = float(convert(1.0, self.unit, unit))
        if factor == 1:
            return self.code
        if (number := _number(self.code)) is not None:
            return _written(float(convert(number, self.unit, unit)))
        return f"{factor:.15g} * {_bracketed(self.code)}"


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
        found = self._of(tree, literals)
        if not same_dimension(found.unit, unit):
            number = _number(found.code)
            if number is not None and found.is_plain:
                if number == 0:
                    return ZERO
                raise WrongValue(Message('a unit is missing: "{number:g} {unit}"', number=number, unit=unit))
            raise WrongValue(
                Message(
                    "{text} is {found}, where a value {unit} stands",
                    text=repr(text),
                    found=_shown(found.unit),
                    unit=_shown(unit),
                )
            )
        code = found.in_unit(unit)
        return QuantityExpression(code, found.names) if found.names else QuantityExpression(_value(code))

    def unit(self, text: object) -> str:
        """Return the canonical unit of an expression; ``"1"`` for a plain number.

        Raises
        ------
        WrongValue
            It cannot be read, or names no quantity.
        """
        if isinstance(text, (int, float)) and not isinstance(text, bool):
            return "1"
        _refuse_comma(text)
        return _spelled(self._of(*self._tree(text)).unit)

    def condition(self, text: object) -> QuantityExpression:
        """Read a condition: comparisons and calls, joined by ``and`` and ``or``.

        Raises
        ------
        WrongValue
            It cannot be read, or compares what has different units.
        """
        if _EQUALS.search(str(text)):
            raise self._no_condition(str(text))
        tree, literals = self._tree(text)
        code, names = self._condition(tree, literals, str(text))
        return QuantityExpression(code, names)

    def _tree(self, text: object) -> tuple[ast.expr, dict[str, tuple[float, str]]]:
        if not isinstance(text, str) or not text.strip() or len(text) > 500:
            raise WrongValue(
                Message("an expression in quotes; found {text}", text=cut_short(repr(text), 100))
            )
        literals: dict[str, tuple[float, str]] = {}

        def literal(match: re.Match[str]) -> str:
            spelled = self._unit_beside(match[2])
            if find_unit(spelled) is None:
                self._refuse_product(match[0])
            unit = parse_unit(spelled)
            name = f"_literal{len(literals)}"
            home = canonical(unit)
            literals[name] = float(convert(float(_written(float(match[1]))), unit, home)), home
            return name + match[2][len(spelled) :]

        plain = _LITERAL.sub(literal, text).replace("^", "**").strip()
        try:
            tree = ast.parse(plain, mode="eval").body
        except (SyntaxError, ValueError, RecursionError):
            self._refuse_product(text)
            raise WrongValue(
                Message(
                    "{text} is not an expression: names, numbers with units, + - * / ^ and functions",
                    text=repr(text),
                )
            ) from None
        if _depth(tree) > _DEEPEST:
            raise WrongValue(Message("{text} is nested too deep", text=repr(text)))
        return tree, literals

    def _refuse_product(self, text: str) -> None:
        """Refuse a number beside a quantity, without the sign of a product."""
        for number, name in re.findall(r"(?<![\w.])(\d+(?:\.\d+)?)\s*([A-Za-z]\w*)", text):
            if name in self.units:
                right = repr(f"{number} * {name}")
                raise WrongValue(
                    Message("a product has its sign: {right}; found {text}", right=right, text=repr(text))
                )

    def _unit_beside(self, text: str) -> str:
        """Return what of a text is the unit of the number before it: ``mm`` of ``mm*k``, where k is a
        quantity."""
        named = any(name in self.units for name in re.findall(r"[A-Za-z]\w*", text)[1:])
        unit = find_unit(text)
        if unit is not None and (not named or canonical(unit) in CANONICAL):
            return text
        shorter = text
        while _SHARE.search(shorter):
            shorter = _SHARE.sub("", shorter)
            if find_unit(shorter) is not None:
                return shorter
        return text

    def _of(self, node: ast.expr, literals: Mapping[str, tuple[float, str]]) -> _Read:
        """Return the code of a tree, with its names and its unit."""
        match node:
            case ast.Constant(value=value) if isinstance(value, (int, float)) and not isinstance(value, bool):
                return _Read(_written(value))
            case ast.Name(id=name) if name in literals:
                return _Read(f"{literals[name][0]:.15g}", (), parse_unit(literals[name][1]))
            case ast.Name(id="pi"):
                return _Read("np.pi")
            case ast.Name(id=name):
                if name not in self.units:
                    if name.isalpha() and find_unit(name) is not None:
                        raise WrongValue(
                            Message('{name!r} is a unit, which stands beside a number: "5 {name}"', name=name)
                        )
                    raise WrongValue(
                        Message("no quantity {name!r}{near}", name=name, near=nearest(name, self.units))
                    )
                return _Read(name, (name,), parse_unit(self.units[name]))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                read = self._of(operand, literals)
                return replace(read, code=f"-{_bracketed(read.code)}")
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                first, second = self._of(left, literals), self._of(right, literals)
                unit = PLAIN
                match op:
                    case ast.Pow():
                        unit = self._power(node, first, second.code)
                    case ast.Add() | ast.Sub():
                        first, second = _alike(
                            (first, second), "{first} is {one}, {second} {other}: they do not add up"
                        )
                        unit = first.unit
                    case _:
                        unit = product(first.unit, second.unit, 1 if isinstance(op, ast.Mult) else -1)
                code = f"{_bracketed(first.code)} {_OPERATORS[type(op)]} {_bracketed(second.code)}"
                if (one := _number(first.code)) is not None and (other := _number(second.code)) is not None:
                    code = self._folded(node, op, one, other)
                return _Read(code, _joined(first.names, second.names), unit)
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in FUNCTIONS:
                if len(arguments) != _ARGUMENTS.get(name, 1):
                    raise WrongValue(
                        Message(
                            "{name} takes {count} value{count:|s}", name=name, count=_ARGUMENTS.get(name, 1)
                        )
                    )
                return _called(name, [self._of(a, literals) for a in arguments])
        raise WrongValue(
            Message(
                "an expression has names, numbers with units, + - * / ** and {functions}; found {found}",
                functions=", ".join(FUNCTIONS),
                found=ast.unparse(node),
            )
        )

    def _power(self, node: ast.BinOp, base: _Read, exponent: str) -> Unit:
        """Return the unit of a power."""
        self._check_power(node, exponent)
        power = float(exponent)
        if power == 0.5:
            return _root(base).unit
        if power != int(power) and not base.is_plain:
            raise WrongValue(
                Message(
                    "the exponent of a value {unit} is a whole number; found {found}",
                    unit=_shown(base.unit),
                    found=exponent,
                )
            )
        return product(PLAIN, base.unit, int(power)) if power == int(power) else PLAIN

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
                sides = _alike(
                    [self._side(side, literals) for side in (left, *right)],
                    "{first} is {one}, {second} {other}: they cannot be compared",
                )
                pieces = [
                    f"({sides[k].code} {_COMPARISONS[type(op)]} {sides[k + 1].code})"
                    for k, op in enumerate(ops)
                ]
                return " & ".join(pieces), _joined(*(side.names for side in sides))
            case ast.Call(func=ast.Name(id=name)) if name in self.calls:
                found = self._called(node)
                return found.code, found.names
        raise self._no_condition(text)

    def _no_condition(self, text: str) -> WrongValue:
        return WrongValue(
            Message(
                'a condition compares, such as "r2 < r4", or calls {functions}; found {text}',
                functions=", ".join(self.calls),
                text=repr(text),
            )
        )

    def _side(self, node: ast.expr, literals: Mapping[str, tuple[float, str]]) -> _Read:
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in self.calls:
            found = self._called(node)
            return _Read(found.code, found.names, parse_unit("deg"))
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


def _alike(several: Sequence[_Read], template: str) -> list[_Read]:
    """Return values in the unit of the first that is no 0; ``template`` refuses others."""
    first = next((read for read in several if _number(read.code) != 0), several[0])
    for read in several:
        if _number(read.code) != 0 and not same_dimension(read.unit, first.unit):
            raise WrongValue(
                Message(
                    template,
                    first=first.text,
                    one=_shown(first.unit),
                    second=read.text,
                    other=_shown(read.unit),
                )
            )
    return [
        replace(
            read, code=read.code if _number(read.code) == 0 else read.in_unit(first.unit), unit=first.unit
        )
        for read in several
    ]


def _root(read: _Read) -> _Read:
    """Return a value whose square root has a unit, and that root's unit."""
    if any(power % 2 for power in read.unit.dimension):
        raise WrongValue(
            Message(
                "the root of {text}, which is {unit}, has no unit",
                text=read.text,
                unit=_shown(read.unit),
            )
        )
    halves = tuple(power // 2 for power in read.unit.dimension)
    ratio = Fraction(math.isqrt(read.unit.ratio.numerator), math.isqrt(read.unit.ratio.denominator))
    if ratio**2 == read.unit.ratio and read.unit.pi % 2 == 0:
        return replace(read, unit=Unit("", ratio, read.unit.pi // 2, halves))
    base = Unit("", Fraction(1), 0, read.unit.dimension)
    return replace(read, code=read.in_unit(base), unit=Unit("", Fraction(1), 0, halves))


def _called(name: str, read: Sequence[_Read]) -> _Read:
    """Return a function of values, with its unit."""
    unit = PLAIN
    if name in ("sin", "cos", "tan", "asin", "acos"):
        wanted, form = (
            ("deg", f"{name}(30 deg)") if name in ("sin", "cos", "tan") else ("1", f"{name}(r2 / r3)")
        )
        if not same_dimension(read[0].unit, wanted) and _number(read[0].code) != 0:
            raise WrongValue(
                Message(
                    "{name} takes a value {wanted}, such as {form}; {text} is {found}",
                    name=name,
                    wanted=_shown(wanted),
                    form=form,
                    text=read[0].text,
                    found=_shown(read[0].unit),
                )
            )
        read = [read[0] if _number(read[0].code) == 0 else replace(read[0], code=read[0].in_unit(wanted))]
        unit = parse_unit("1" if wanted == "deg" else "deg")
    elif name == "sqrt":
        read = [_root(read[0])]
        unit = read[0].unit
    else:
        read = _alike(read, "{first} is {one}, {second} {other}: they cannot be compared")
        unit = parse_unit("deg") if name == "atan2" else read[0].unit
    code = f"{_IN_CODE.get(name, name)}({', '.join(r.code for r in read)})"
    return _Read(code, _joined(*(r.names for r in read)), unit)


def _shown(unit: Unit | str) -> Message:
    """Return what messages say of a unit."""
    unit = parse_unit(unit) if isinstance(unit, str) else unit
    return Message("in {unit}", unit=_spelled(unit)) if any(unit.dimension) else Message("without unit")


def _spelled(unit: Unit) -> str:
    names = [f"{n}^{p}".removesuffix("^1") for n, p in zip(_BASES, unit.dimension, strict=True) if p]
    return canonical(unit) or "*".join(names)


__all__ = [
    "FUNCTIONS",
    "ZERO",
    "ExpressionReader",
    "QuantityExpression",
    "amount",
    "canonical",
]
