"""Expressions in the syntax of Maxima: values, texts, and the formulas of quantities."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from coursework import degrees
from coursework.quantities.formula_code import called_name


class Unprintable(Exception):
    """Error of an expression without counterpart in Maxima."""


def number(value: complex) -> str:
    """Return a number in the syntax of Maxima. Raises Unprintable: it is not finite."""
    if isinstance(value, complex):
        return f"({number(value.real)}+%i*{number(value.imag)})"
    if isinstance(value, bool) or not math.isfinite(value):
        raise Unprintable(str(value))
    text = repr(int(value)) if isinstance(value, int) else repr(float(value))
    return f"({text})" if text.startswith("-") else text


def text(content: str) -> str:
    """Return a quoted text."""
    escaped = content.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


_OPERATORS: Mapping[type, str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "^",
    ast.USub: "-",
    ast.UAdd: "+",
}
_TURN = "%pi/180"
#: By function, how it is written; ``{0}`` is its first argument.
_FUNCTIONS: Mapping[Any, str] = {
    degrees.sin: f"sin({{0}}*{_TURN})",
    degrees.cos: f"cos({{0}}*{_TURN})",
    degrees.tan: f"tan({{0}}*{_TURN})",
    degrees.asin: f"(asin({{0}})/({_TURN}))",
    degrees.acos: f"(acos({{0}})/({_TURN}))",
    degrees.atan: f"(atan({{0}})/({_TURN}))",
    degrees.atan2: f"(atan2({{0}},{{1}})/({_TURN}))",
    degrees.angle: f"(carg({{0}})/({_TURN}))",
    degrees.polar: f"({{0}}*exp(%i*{{1}}*{_TURN}))",
    degrees.sqrt: "sqrt({0})",
    np.sqrt: "sqrt({0})",
    math.sqrt: "sqrt({0})",
    abs: "cabs({0})",
    np.abs: "cabs({0})",
    np.real: "realpart({0})",
    np.imag: "imagpart({0})",
    np.conj: "conjugate({0})",
    np.hypot: "sqrt({0}^2+{1}^2)",
    math.hypot: "sqrt({0}^2+{1}^2)",
    np.exp: "exp({0})",
    np.log: "log({0})",
    np.sign: "signum({0})",
    np.minimum: "min({0},{1})",
    np.maximum: "max({0},{1})",
    min: "min({0},{1})",
    max: "max({0},{1})",
    np.deg2rad: f"({{0}}*{_TURN})",
    math.radians: f"({{0}}*{_TURN})",
    np.radians: f"({{0}}*{_TURN})",
    np.rad2deg: f"({{0}}/({_TURN}))",
    math.degrees: f"({{0}}/({_TURN}))",
    np.degrees: f"({{0}}/({_TURN}))",
    degrees.from_radians: f"({{0}}/({_TURN}))",
    degrees.wrap: "({0}-360*ceiling(({0}-180)/360))",
}
_ATTRIBUTES = {"real": "realpart({0})", "imag": "imagpart({0})"}


def printed(tree: ast.expr, name: Callable[[str], str], space: Mapping[str, Any]) -> str:
    """Return a Python expression in the syntax of Maxima; ``name`` writes a quantity or raises ``KeyError``,
    ``space`` has the values of the other names. Raises Unprintable: something in it has no counterpart."""

    def of(node: ast.expr) -> str:
        match node:
            case ast.Constant(value=complex() | float() | int() as value):
                return number(value)
            case ast.Name(id=found):
                return _named(found)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                return f"({of(left)}{_OPERATORS[type(op)]}{of(right)})"
            case ast.UnaryOp(op=op, operand=operand) if type(op) in _OPERATORS:
                return f"({_OPERATORS[type(op)]}{of(operand)})"
            case ast.Attribute(value=value, attr=attr) if attr in _ATTRIBUTES:
                return _ATTRIBUTES[attr].format(of(value))
            case ast.Call(func=func, args=args, keywords=[]):
                return _function(func, node).format(*map(of, args))
        raise Unprintable(ast.unparse(node))

    def _named(found: str) -> str:
        try:
            return name(found)
        except KeyError:
            value = space.get(found)
        if isinstance(value, (float, int)):
            return number(value)
        raise Unprintable(found)

    def _function(func: ast.expr, node: ast.Call) -> str:
        meaning = _meaning(func, space)
        try:
            pattern = _FUNCTIONS[meaning]
        except (KeyError, TypeError):
            raise Unprintable(called_name(node)) from None
        if pattern.count("{1}") != (len(node.args) == 2) or len(node.args) > 2:
            raise Unprintable(called_name(node))
        return pattern

    return of(tree)


def _meaning(func: ast.expr, space: Mapping[str, Any]) -> Any:
    if isinstance(func, ast.Name):
        return space.get(func.id, {"abs": abs, "min": min, "max": max}.get(func.id))
    if isinstance(func, ast.Attribute):
        return getattr(_meaning(func.value, space), func.attr, None)
    return None
