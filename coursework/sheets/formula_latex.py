"""The worked solution: the walk of the quantity graph, each function shown as formula, numbers, value.

A function whose body is one expression is printed from its own source, so that the formula on
paper is the one that computed the answer. A function that does more says its formula by
:func:`coursework.solution.formula`, or is told in words alone.
"""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from coursework.language.numbers import significant

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
    "hypot": r"\operatorname{hypot}",
    "wrap": "",
}
_SUM, _PRODUCT, _UNARY, _POWER, _ATOM = range(5)

#: What stands for a name in print: LaTeX, and whether it is a number.
Shown = Mapping[str, tuple[str, bool]]


class Unprintable(Exception):
    """The function's source is not one expression that we can print."""


@lru_cache(maxsize=1024)
def _expression(function: Callable[..., Any]) -> ast.expr:
    try:
        source = textwrap.dedent(inspect.getsource(function))
    except (OSError, TypeError) as fault:
        raise Unprintable from fault
    body = ast.parse(source).body[0]
    statements = [
        s
        for s in getattr(body, "body", [])
        if not (isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant))
    ]
    if len(statements) != 1 or not isinstance(statements[0], ast.Return) or statements[0].value is None:
        raise Unprintable
    return statements[0].value


class _Printer:
    """An expression tree to LaTeX; names are shown as told."""

    def __init__(self, shown: Shown):
        self.shown = shown

    def latex(self, node: ast.expr, within: int = _SUM) -> str:
        text, level = self._print(node)
        return rf"\left({text}\right)" if level < within else text

    def _print(self, node: ast.expr) -> tuple[str, int]:
        match node:
            case ast.Constant(value=bool()) | ast.Constant(value=str()):
                raise Unprintable
            case ast.Constant(value=complex() as value):
                return ("i" if value == 1j else rf"\num{{{value.imag:g}}}\,i"), _ATOM
            case ast.Constant(value=value):
                return rf"\num{{{value:g}}}", _ATOM
            case ast.Name(id=name):
                return self._name(name)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return "-" + self._second(operand, _PRODUCT), _UNARY
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self._print(operand)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return f"{self.latex(left)} + {self._second(right, _SUM)}", _SUM
            case ast.BinOp(left=left, op=ast.Sub(), right=right):
                return f"{self.latex(left)} - {self._second(right, _PRODUCT)}", _SUM
            case ast.BinOp(op=ast.Mult()):
                return self._product(node), _PRODUCT
            case ast.BinOp(left=left, op=ast.Div(), right=right):
                return rf"\frac{{{self.latex(left)}}}{{{self.latex(right)}}}", _ATOM
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._power(left, right)
            case ast.Attribute(value=value, attr="real" | "imag" as part):
                name = r"\operatorname{Re}" if part == "real" else r"\operatorname{Im}"
                return rf"{name}\left({self.latex(value)}\right)", _ATOM
            case ast.Call(func=function, args=arguments, keywords=[]):
                return self._call(function, arguments)
        raise Unprintable

    def _second(self, node: ast.expr, within: int) -> str:
        """What comes after a sign: no sign follows a sign."""
        text = self.latex(node, within)
        return rf"\left({text}\right)" if text.startswith(("-", r"\num{-")) else text

    def _name(self, name: str) -> tuple[str, int]:
        if name == "pi":
            return r"\pi", _ATOM
        if name not in self.shown:
            raise Unprintable
        text, is_number = self.shown[name]
        if not is_number and re.search(r"(?<=[\w}]) [+-] ", text):
            return text, _SUM  # a symbol that is a sum by itself: "s + l"
        negative = text.startswith(r"\num{-") or text.startswith("-")
        return text, (_UNARY if negative else _ATOM) if is_number else _ATOM

    def _factors(self, node: ast.expr) -> list[ast.expr]:
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
            return [*self._factors(node.left), *self._factors(node.right)]
        return [node]

    def _product(self, node: ast.expr) -> str:
        factors = self._factors(node)
        texts = [self.latex(f, _PRODUCT if i == 0 else _POWER) for i, f in enumerate(factors)]
        out = texts[0]
        for text in texts[1:]:
            before_digit = text.startswith(r"\num") or re.match(r"\\left\(\\num\{-", text)
            out += (r" \times " if before_digit else r"\,") + text
        return out

    def _power(self, left: ast.expr, right: ast.expr) -> tuple[str, int]:
        if isinstance(right, ast.Constant) and right.value == 0.5:
            return rf"\sqrt{{{self.latex(left)}}}", _ATOM
        if (
            isinstance(left, ast.Call)
            and isinstance(left.func, ast.Name)
            and left.func.id in ("sin", "cos", "tan")
        ):
            inner = self.latex(left.args[0])
            exponent = self.latex(right)
            return rf"{_FUNCTIONS[left.func.id]}^{{{exponent}}}\left({inner}\right)", _POWER
        text, level = self._print(left)
        base = (
            text if level == _ATOM and not text.startswith((r"\frac", r"\sqrt")) else rf"\left({text}\right)"
        )
        if text.endswith(r"^{\circ}"):
            base = rf"\left({text}\right)"
        return rf"{base}^{{{self.latex(right)}}}", _POWER

    def _call(self, function: ast.expr, arguments: list[ast.expr]) -> tuple[str, int]:
        name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
        if name == "sqrt":
            return rf"\sqrt{{{self.latex(arguments[0])}}}", _ATOM
        if name in ("abs", "absolute"):
            return rf"\left|{self.latex(arguments[0])}\right|", _ATOM
        if name == "polar":
            length = self.latex(arguments[0], _PRODUCT)
            if isinstance(arguments[0], ast.Constant) and arguments[0].value == 1:
                length = ""
            joint = r"\," if length else ""
            return rf"{length}{joint}e^{{i\,{self.latex(arguments[1], _POWER)}}}", _PRODUCT
        if name == "wrap":
            return self._print(arguments[0])
        if name not in _FUNCTIONS:
            raise Unprintable
        inner = r";\ ".join(self.latex(a) for a in arguments)
        return rf"{_FUNCTIONS[name]}\left({inner}\right)", _POWER


def formula_latex(function: Callable[..., Any], shown: Shown) -> str:
    """LaTeX of a quantity's formula, each name shown as told; empty when words must say it."""
    template = getattr(function, "__formula__", None)
    if template is not None:
        return re.sub(r"<(\w+)>", lambda m: _in_template(shown, m), template)
    try:
        return _Printer(shown).latex(_expression(function))
    except Unprintable:
        return ""


@lru_cache(maxsize=1024)
def formula_in_symbols(function: Callable[..., Any], symbols: tuple[tuple[str, str], ...]) -> str:
    """The same with the symbol of each name: what all students of an exercise read."""
    return formula_latex(function, {name: (symbol, False) for name, symbol in symbols})


def _in_template(shown: Shown, name: re.Match[str]) -> str:
    """A name of a stated formula; a negative number in brackets unless an opening bracket stands before it."""
    text, is_number = shown[name.group(1)]
    if not is_number or not text.startswith((r"\num{-", "-")):
        return text
    before, after = name.string[: name.start()].rstrip(), name.string[name.end() :].lstrip()
    opens = not before or before.endswith(("{", "(", ";", ";\\"))
    return text if opens and not after.startswith("^") else rf"\left({text}\right)"


def number_latex(value: Any, unit: str, digits: int = 5) -> str:
    r"""A value as it stands in a substitution: ``\num{114.3}``, ``\num{135}^{\circ}``, ``\num{1}+\num{2}\,i``."""
    degree = r"^{\circ}" if unit == "deg" else ""
    if isinstance(value, (complex, np.complexfloating)):
        imaginary = significant(value.imag, digits)
        sign, size = ("-", imaginary[1:]) if imaginary.startswith("-") else ("+", imaginary)
        return rf"\left(\num{{{significant(value.real, digits)}}} {sign} \num{{{size}}}\,i\right)"
    return rf"\num{{{significant(value, digits)}}}{degree}"
