"""Formulas of the worked solution: each function as formula, numbers, value.

A function whose body is one expression is printed from its own source, so that the formula on
paper is the one that computed the answer. Guards that raise are passed over, and a private helper that is one
expression itself stands in its place. A function that does more says its formula by
:func:`coursework.solution.formula`, or is explained in words alone.
"""

from __future__ import annotations

import ast
import inspect
import itertools
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from coursework import degrees
from coursework.language.numbers import significant
from coursework.quantities.formula_code import (
    NoExpression,
    added,
    call,
    called_name,
    expression,
    put_in,
    returning,
)
from coursework.system import python_code

_FUNCTIONS = {
    "sin": r"\sin",
    "cos": r"\cos",
    "tan": r"\tan",
    "asin": r"\arcsin",
    "acos": r"\arccos",
    "atan": r"\arctan",
    "atan2": r"\operatorname{atan2}",
    "angle": r"\operatorname{arg}",
    "exp": r"\exp",
    "log": r"\ln",
    "sinh": r"\sinh",
    "cosh": r"\cosh",
    "tanh": r"\tanh",
    "sign": r"\operatorname{sgn}",
    "minimum": r"\operatorname{min}",
    "maximum": r"\operatorname{max}",
    "shortest": r"\operatorname{min}",
    "longest": r"\operatorname{max}",
}
_OF_DEGREES = ("sin", "cos", "tan")  #: functions of ``coursework.degrees`` that take an angle
_DIRECTIONS = ("asin", "acos", "atan", "atan2", "angle")  #: functions that give an angle, in degrees
_PRINTED = {*_FUNCTIONS, "sqrt", "hypot", "abs", "absolute", "where", "stack", "broadcast_arrays"}
_SUM, _PRODUCT, _UNARY, _POWER, _ATOM = range(5)


class PrintedName(NamedTuple):
    """Printed form of a name."""

    latex: str
    is_number: bool
    kind: str = ""  #: of its value: ``angle`` in degrees, ``complex``, or neither


#: What stands for each name; a plain pair of LaTeX and whether it is a number will do.
Shown = Mapping[str, tuple]


def kind_of(value: Any, unit: str) -> str:
    """Return the kind of a value, as in :class:`PrintedName`."""
    if isinstance(value, (complex, np.complexfloating)):
        return "complex"
    return "angle" if unit == "deg" else ""


class UnprintableFormula(Exception):
    """Expression that cannot be printed."""


def why_unprinted(function: Callable[..., Any]) -> str:
    """Return what in a function's code no formula can print: a choice, or a function without a name on paper.

    Empty for anything else, such as several steps.
    """
    try:
        body = python_code.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    except (OSError, TypeError, SyntaxError):
        return ""
    statements = returning(body)
    if not all(isinstance(s, (ast.If, ast.Return)) for s in statements):
        return ""
    for node in (node for statement in statements for node in ast.walk(statement)):
        if isinstance(node, (ast.If, ast.IfExp)):
            return f"its code has an if, at line {_line_of(function, node)}"
        if (
            isinstance(node, ast.Call)
            and (name := _of_numbers(node.func))
            and called_name(node) not in _PRINTED
        ):
            return f"{name} is not printed, at line {_line_of(function, node)}"
    return ""


def _of_numbers(label: ast.expr) -> str:
    """Return the name of a called numpy or math function, such as ``np.log2``; empty for any other."""
    match label:
        case ast.Attribute(value=ast.Name(id="np" | "numpy" as home), attr=name):
            return f"{home}.{name}" if isinstance(getattr(np, name, None), np.ufunc) else ""
        case ast.Attribute(value=ast.Name(id="math" | "cmath" as home), attr=name):
            return f"{home}.{name}"
    return ""


def _line_of(function: Callable[..., Any], node: ast.expr | ast.stmt) -> int:
    first: int = inspect.getsourcelines(function)[1]
    return first + node.lineno - 1


class _Degrees(float):
    """Constant that is an angle, in a sum with angles."""


def _square(node: ast.expr) -> ast.expr:
    return ast.BinOp(node, ast.Pow(), ast.Constant(2))


class _Printer:
    """Printer from an expression tree to LaTeX; private helpers are those of ``helpers``."""

    def __init__(self, names: Shown, helpers: Mapping[str, Any]):
        self.shown = names
        self.helpers = helpers

    def latex(self, node: ast.expr, within: int = _SUM) -> str:
        text, level = self._print(node)
        return rf"\left({text}\right)" if level < within else text

    def _print(self, node: ast.expr) -> tuple[str, int]:
        match node:
            case ast.Constant(value=bool()) | ast.Constant(value=str()):
                raise UnprintableFormula
            case ast.Constant(value=complex() as value):
                return ("i" if value == 1j else rf"\num{{{value.imag:g}}}\,i"), _ATOM
            case ast.Constant(value=_Degrees() as value):
                return rf"\num{{{value:g}}}^{{\circ}}", _ATOM
            case ast.Constant(value=int() | float() as value):
                return rf"\num{{{value:g}}}", _ATOM
            case ast.Name(id="pi") | ast.Attribute(attr="pi"):
                return r"\pi", _ATOM
            case ast.Name(id=name):
                return self._name(name)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return "-" + self._second(operand, _PRODUCT), _UNARY
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self._print(operand)
            case ast.BinOp(op=ast.Add() | ast.Sub()):
                return self._sum(node), _SUM
            case ast.BinOp(op=ast.Mult()):
                squares = _difference_of_squares(node)
                return (self._sum(squares), _SUM) if squares else (self._product(node), _PRODUCT)
            case ast.BinOp(op=ast.Div()):
                return self._fraction(node)
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._power(left, right)
            case ast.Attribute(value=value, attr="real" | "imag" as part):
                name = r"\operatorname{Re}" if part == "real" else r"\operatorname{Im}"
                return rf"{name}\left({self.latex(value)}\right)", _ATOM
            case ast.Subscript(value=value, slice=ast.Tuple(elts=[])):
                return self._print(value)
            case ast.Call(
                func=ast.Attribute(attr="stack"),
                args=[ast.Call(func=ast.Attribute(attr="broadcast_arrays"), args=coordinates)],
            ):
                return rf"\left({self._listed(coordinates)}\right)", _ATOM
            case ast.Call(func=ast.Name(id=name), args=[theta], keywords=[]) if self._is_of_degrees(name):
                return self._call(name, [self._of_a_turn(theta)])
            case ast.Call(args=arguments, keywords=[]):
                return self._call(called_name(node), arguments)
        raise UnprintableFormula

    def _second(self, node: ast.expr, within: int) -> str:
        """Return an operand after a sign, in brackets if it begins with a sign itself."""
        text = self.latex(node, within)
        return rf"\left({text}\right)" if text.startswith(("-", r"\num{-")) else text

    def _listed(self, nodes: Sequence[ast.expr]) -> str:
        return r";\ ".join(self.latex(node) for node in nodes)

    def _name(self, name: str) -> tuple[str, int]:
        if name not in self.shown:
            return self._constant(name)
        text, is_number, *_ = self.shown[name]
        if not is_number and re.search(r"(?<=[\w}]) [+-] ", text):
            return text, _SUM  # a symbol that is a sum by itself: "s + l"
        negative = text.startswith(r"\num{-") or text.startswith("-")
        return text, (_UNARY if negative else _ATOM) if is_number else _ATOM

    def _constant(self, name: str) -> tuple[str, int]:
        """Return a constant of the module: its name among symbols, its value among numbers."""
        value = self._value_of(name)
        if value is None:
            raise UnprintableFormula
        if not self.shown or any(is_number for _, is_number, *_ in self.shown.values()):
            return rf"\num{{{value:.10g}}}", _UNARY if value < 0 else _ATOM
        stem, *below = (rf"\mathrm{{{part}}}" if len(part) > 1 else part for part in name.split("_") if part)
        return f"{stem}_{{{','.join(below)}}}" if below else stem, _ATOM

    def _value_of(self, name: str) -> float | None:
        """Return the value of a constant of the module; None for any other name."""
        value = None if name in self.shown else self.helpers.get(name)
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return value if is_number else None

    def _kind(self, name: str) -> str:
        return PrintedName(*self.shown[name]).kind if name in self.shown else ""

    # ------------------------------------------------------------- sums, angles

    def _sum(self, node: ast.BinOp) -> str:
        left, right = node.left, node.right
        if self._is_angle(node):
            left, right = self._in_degrees(left), self._in_degrees(right)
        if isinstance(node.op, ast.Add):
            return f"{self.latex(left)} + {self._second(right, _SUM)}"
        return f"{self.latex(left)} - {self._second(right, _PRODUCT)}"

    def _is_angle(self, node: ast.expr) -> bool:
        """Return whether an expression is an angle in degrees."""
        match node:
            case ast.Constant(value=value):
                return isinstance(value, _Degrees)
            case ast.Name(id=name):
                return self._kind(name) == "angle"
            case ast.UnaryOp(operand=operand):
                return self._is_angle(operand)
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return self._is_angle(left) and not self._is_angle(right)
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult(), right=right):
                return self._is_angle(left) or self._is_angle(right)
            case ast.Call(args=arguments):
                name = called_name(node)
                return name in _DIRECTIONS or (name in ("abs", "wrap") and self._is_angle(arguments[0]))
        return False

    def _in_degrees(self, node: ast.expr) -> ast.expr:
        """Return a term of a sum of angles with its constants in degrees, such as ``180`` or the ``90`` of
        ``90 * sense``."""
        match node:
            case ast.Constant(value=int() | float() as value):
                return ast.Constant(_Degrees(value))
            case ast.Name(id=name) if (constant := self._value_of(name)) is not None:
                return ast.Constant(_Degrees(constant))
            case ast.UnaryOp(op=op, operand=operand):
                return ast.UnaryOp(op, self._in_degrees(operand))
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
                return ast.BinOp(self._in_degrees(left), op, self._in_degrees(right))
            case ast.BinOp(left=left, op=ast.Mult() as op, right=right) if not self._is_angle(node):
                return ast.BinOp(self._in_degrees(left), op, right)
        return node

    def _is_of_degrees(self, name: str) -> bool:
        return name in _OF_DEGREES and self.helpers.get(name) is getattr(degrees, name)

    def _of_a_turn(self, node: ast.expr) -> ast.expr:
        """Return the argument of a function of degrees with its constant in degrees, such as the ``180`` of
        ``180 / n``, where nothing else in it is an angle."""
        match node:
            case _ if self._is_angle(node):
                return node
            case ast.BinOp(left=left, op=ast.Div() as op, right=right):
                return ast.BinOp(self._of_a_turn(left), op, right)
            case ast.BinOp(left=left, op=ast.Mult() as op, right=right):
                # Of two factors the second is the angle, as in "2 × 180°", unless the first alone is a
                # number.
                inside = self._of_a_turn(right)
                if inside is right:
                    return ast.BinOp(self._of_a_turn(left), op, right)
                return ast.BinOp(left, op, inside)
            case ast.Constant() | ast.Name() | ast.UnaryOp(operand=ast.Constant() | ast.Name()):
                return self._in_degrees(node)
        return node

    # ------------------------------------------------- products, fractions, powers

    def _factors(self, node: ast.expr) -> list[ast.expr]:
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
            return [*self._factors(node.left), *self._factors(node.right)]
        return [node]

    def _product(self, node: ast.expr) -> str:
        factors = self._factors(node)
        texts = [self.latex(f, _PRODUCT if i == 0 else _POWER) for i, f in enumerate(factors)]
        out = texts[0]
        for pair, text in zip(itertools.pairwise(factors), texts[1:], strict=True):
            before_digit = text.startswith(r"\num") or re.match(r"\\left\(\\num\{-", text)
            apart = before_digit or any(self._is_segment(factor) for factor in pair)
            out += (r" \times " if apart else r"\,") + text
        return out

    def _is_segment(self, factor: ast.expr) -> bool:
        return isinstance(factor, ast.Name) and _is_segment(self._name(factor.id)[0])

    def _fraction(self, node: ast.BinOp) -> tuple[str, int]:
        over, is_negative = _without_sign(node.left)
        text = rf"\frac{{{self.latex(over)}}}{{{self.latex(node.right)}}}"
        return ("-" + text, _UNARY) if is_negative else (text, _ATOM)

    def _power(self, left: ast.expr, right: ast.expr) -> tuple[str, int]:
        if isinstance(right, ast.Constant) and right.value == 0.5:
            return rf"\sqrt{{{self.latex(left)}}}", _ATOM
        if isinstance(left, ast.Call) and isinstance(left.func, ast.Name) and left.func.id in _OF_DEGREES:
            inner = self.latex(self._of_a_turn(left.args[0]))
            exponent = self.latex(right)
            return rf"{_FUNCTIONS[left.func.id]}^{{{exponent}}}\left({inner}\right)", _POWER
        text, level = self._print(left)
        base = (
            text if level == _ATOM and not text.startswith((r"\frac", r"\sqrt")) else rf"\left({text}\right)"
        )
        if text.endswith(r"^{\circ}"):
            base = rf"\left({text}\right)"
        return rf"{base}^{{{self.latex(right)}}}", _POWER

    # ----------------------------------------------------------------- functions

    def _call(self, name: str, arguments: Sequence[ast.expr]) -> tuple[str, int]:
        match name, arguments:
            case "sqrt", [inside]:
                return rf"\sqrt{{{self.latex(inside)}}}", _ATOM
            case "hypot", [one, other]:
                return self._print(call("sqrt", ast.BinOp(_square(one), ast.Add(), _square(other))))
            case "abs" | "absolute", [inside]:
                return rf"\left|{self.latex(inside)}\right|", _ATOM
            case "polar", [length, theta]:
                return self._polar(length, theta), _PRODUCT
            case "wrap", [inside]:
                return self._print(inside)
            case "where", [_, ast.Attribute(attr="nan"), inside]:
                return self._print(inside)  # like a guard, for arrays
            case "angle", [vector] if (parts := self._components(vector)) and parts[1]:
                return self._call("atan2", [added(parts[1]), added(parts[0])])
        if name.startswith("_"):
            return self._helper(name, arguments)
        if name not in _FUNCTIONS:
            raise UnprintableFormula
        return rf"{_FUNCTIONS[name]}\left({self._listed(arguments)}\right)", _POWER

    def _polar(self, length: ast.expr, theta: ast.expr) -> str:
        turn = rf"e^{{i\,{self.latex(theta, _POWER)}}}"
        if isinstance(length, ast.Constant) and length.value == 1:
            return turn
        return rf"{self.latex(length, _PRODUCT)}\,{turn}"

    def _components(self, node: ast.expr) -> tuple[list, list] | None:
        """Return the terms of a sum of polar and Cartesian vectors along x and along y; None where one is
        neither.

        A term is its sign, whether it is subtracted, and its tree.
        """
        match node:
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return _turned(self._components(operand))
            case ast.BinOp(left=left, op=ast.Add() | ast.Sub() as op, right=right):
                first, other = self._components(left), self._components(right)
                other = _turned(other) if isinstance(op, ast.Sub) else other
                return first and other and (first[0] + other[0], first[1] + other[1])
            case ast.BinOp(left=ast.Constant(value=1j), op=ast.Mult(), right=along):
                return [], [(False, along)]
            case ast.Call(args=[length, theta]) if called_name(node) == "polar":
                along, across = _times(length, call("cos", theta)), _times(length, call("sin", theta))
                return [(False, along)], [(False, across)]
            case ast.Name(id=name) if self._kind(name) != "complex":
                return [(False, node)], []
        return None

    def _helper(self, name: str, arguments: Sequence[ast.expr]) -> tuple[str, int]:
        """Return the LaTeX of a private helper's expression, with these arguments in place of its
        parameters."""
        helper = self.helpers.get(name)
        try:
            body = put_in(helper, arguments)
        except NoExpression as fault:
            raise UnprintableFormula from fault
        return _Printer(self.shown, {**self.helpers, **getattr(helper, "__globals__", {})})._print(body)


def _turned(parts: tuple[list, list] | None) -> tuple[list, list] | None:
    if parts is None:
        return None
    along, across = ([(not minus, tree) for minus, tree in part] for part in parts)
    return along, across


def _times(length: ast.expr, ratio: ast.expr) -> ast.expr:
    is_one = isinstance(length, ast.Constant) and length.value == 1
    return ratio if is_one else ast.BinOp(length, ast.Mult(), ratio)


def _without_sign(node: ast.expr) -> tuple[ast.expr, bool]:
    """Return a product without its leading sign, and whether it has one: the sign stands before the
    fraction."""
    match node:
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return operand, True
        case ast.BinOp(left=left, op=ast.Mult() as op, right=right):
            left, is_negative = _without_sign(left)
            return ast.BinOp(left, op, right), is_negative
    return node, False


def _difference_of_squares(product: ast.BinOp) -> ast.BinOp | None:
    """Return ``a^2 - b^2`` for ``(a - b) * (a + b)``, the form that keeps digits; None for any other
    product."""
    match product.left, product.right:
        case (ast.BinOp(a, ast.Sub(), b), ast.BinOp(c, ast.Add(), d)) | (
            ast.BinOp(a, ast.Add(), b),
            ast.BinOp(c, ast.Sub(), d),
        ) if ast.dump(a) == ast.dump(c) and ast.dump(b) == ast.dump(d):
            return ast.BinOp(_square(a), ast.Sub(), _square(b))
    return None


def _is_segment(symbol: str) -> bool:
    r"""Return whether a symbol has several letters, as ``OB`` or ``\angle DOB``, which side by side would
    read as a product."""
    if "(" in symbol or symbol.startswith((r"\frac", r"\num")):
        return False
    base = re.sub(r"\\mathrm\{\w*\}", "x", symbol)
    while (less := re.sub(r"[_^](\{[^{}]*\}|\w)", "", base)) != base:
        base = less
    return len(re.findall(r"\\[a-zA-Z]+|[a-zA-Z]", re.sub(r"\\d*dot|\\vec", "", base))) > 1


def formula_latex(function: Callable[..., Any], displayed: Shown) -> str:
    """Return LaTeX of a quantity's formula; empty when only words describe it."""
    template = getattr(function, "__formula__", None)
    if template is not None:
        return re.sub(r"<(\w+)>", lambda m: _in_template(displayed, m), template)
    try:
        return _Printer(displayed, getattr(function, "__globals__", {})).latex(expression(function))
    except (NoExpression, UnprintableFormula):
        return ""


def tree_latex(tree: ast.expr, displayed: Shown, space: Mapping[str, Any]) -> str:
    """Return LaTeX of a part of a formula; ``space`` holds the meaning of other names. Empty when only words
    describe it."""
    try:
        return _Printer(displayed, space).latex(tree)
    except (NoExpression, UnprintableFormula):
        return ""


@lru_cache(maxsize=1024)
def formula_in_symbols(function: Callable[..., Any], symbols: tuple[tuple[str, str, str], ...]) -> str:
    """Return LaTeX of a formula from the symbol and kind of each name, the same for all students."""
    return formula_latex(function, {name: PrintedName(symbol, False, kind) for name, symbol, kind in symbols})


def _in_template(displayed: Shown, name: re.Match[str]) -> str:
    """Return a name of a stated formula; a negative number in brackets unless an opening bracket precedes
    it."""
    text, is_number, *_ = displayed[name.group(1)]
    if not is_number or not text.startswith((r"\num{-", "-")):
        return text
    before, after = name.string[: name.start()].rstrip(), name.string[name.end() :].lstrip()
    opens = not before or before.endswith(("{", "(", ";", ";\\"))
    return text if opens and not after.startswith("^") else rf"\left({text}\right)"


def number_latex(value: Any, unit: str, digits: int = 5) -> str:
    r"""Return LaTeX of a value in a substitution: ``\num{114.3}``, ``\num{135}^{\circ}``,
    ``\num{1}+\num{2}\,i``."""
    degree = r"^{\circ}" if unit == "deg" else ""
    if isinstance(value, (complex, np.complexfloating)):
        imaginary = significant(float(value.imag), digits)
        sign, size = ("-", imaginary[1:]) if imaginary.startswith("-") else ("+", imaginary)
        return rf"\left(\num{{{significant(float(value.real), digits)}}} {sign} \num{{{size}}}\,i\right)"
    return rf"\num{{{significant(value, digits)}}}{degree}"
