"""Formula of a quantity as a Python expression tree: from its code, or from its printed form.

A function whose body is one expression is that expression; guards that raise are passed over. A private
helper that is one expression itself stands in its place. A function that says its formula by
:func:`coursework.solution.formula` is read off that.
"""

from __future__ import annotations

import ast
import builtins
import copy
import inspect
import operator
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from types import MappingProxyType
from typing import Any

import numpy as np

from coursework import degrees
from coursework.errors import BadStatement
from coursework.markup.formula_tree import Fence, Fraction, Node, Num, Root, Script, Symbol, parse
from coursework.parsing.printed_formulas import DEGREE_SIGNS, Evaluation, NotEvaluable
from coursework.system import python_code


class NoExpression(Exception):
    """Function whose source is not one expression."""


@lru_cache(maxsize=1024)
def expression(function: Callable[..., Any]) -> ast.expr:
    """Return the expression that a function returns, if it does nothing else but guard.

    Raises
    ------
    NoExpression
        It does more, or has no source.
    """
    try:
        source = textwrap.dedent(inspect.getsource(function))
        body = python_code.parse(source).body[0]
    except (OSError, TypeError, SyntaxError) as fault:
        raise NoExpression from fault
    statements = returning(body)
    if len(statements) != 1 or not isinstance(statements[0], ast.Return) or statements[0].value is None:
        raise NoExpression
    return statements[0].value


def returning(function: ast.stmt) -> list[ast.stmt]:
    """Return the statements of a function without its docstring and its guards."""
    return [s for s in getattr(function, "body", []) if not (_is_docstring(s) or _is_guard(s))]


def _is_docstring(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)


def _is_guard(statement: ast.stmt) -> bool:
    """Return whether a statement is ``if …: raise …``, which states where the formula does not exist."""
    return (
        isinstance(statement, ast.If)
        and not statement.orelse
        and [type(s) for s in statement.body] == [ast.Raise]
    )


def called_name(node: ast.expr) -> str:
    """Return the name of the called function, without its module; empty where the node is not a call."""
    if not isinstance(node, ast.Call):
        return ""
    function = node.func
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def call(name: str, *arguments: ast.expr) -> ast.Call:
    """Return the syntax tree of a call."""
    return ast.Call(ast.Name(name, ast.Load()), list(arguments), [])


def added(terms: Sequence[tuple[bool, ast.expr]]) -> ast.expr:
    """Return the sum of the signed terms; 0 where there are none."""
    if not terms:
        return ast.Constant(0)
    (minus, total), *others = terms
    total = ast.UnaryOp(ast.USub(), total) if minus else total
    for minus, term in others:
        total = ast.BinOp(total, ast.Sub() if minus else ast.Add(), term)
    return total


def put_in(helper: Any, arguments: Sequence[ast.expr]) -> ast.expr:
    """Return the expression of a helper, with these arguments in place of its parameters.

    Raises
    ------
    NoExpression
        It is none, or takes another number of arguments.
    """
    if not inspect.isfunction(helper):
        raise NoExpression
    parameters = tuple(inspect.signature(helper).parameters)
    if len(parameters) != len(arguments):
        raise NoExpression
    trees = dict(zip(parameters, arguments, strict=True))
    result: ast.expr = _PutIn(trees).visit(copy.deepcopy(expression(helper)))
    return result


class _PutIn(ast.NodeTransformer):
    """Substitution of trees for names."""

    def __init__(self, trees: Mapping[str, ast.expr]):
        self.trees = trees

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return self.trees.get(node.id, node)


# ---------------------------------------------------------------------- formulas

_OPERATIONS: Mapping[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


@dataclass(frozen=True)
class Formula:
    """Expression of quantities, and the meaning of its other names."""

    tree: ast.expr
    names: tuple[str, ...]  #: the quantities
    space: Mapping[str, Any]

    def __call__(self, values: Mapping[str, Any], known: dict[int, Any] | None = None) -> Any:
        """Evaluate the formula for scalars or arrays ``(n,)`` by name; NaN where it does not exist.

        ``known`` holds the values of trees that several formulas of the same quantities share, by identity.
        """
        own = {name: values[name] for name in self.names}  # all, also where an error leaves one of them out
        with np.errstate(all="ignore"):
            return self._value(self.tree, own, {} if known is None else known)

    def _value(self, node: ast.expr, values: Mapping[str, Any], known: dict[int, Any]) -> Any:
        """Return the value of a tree: most are evaluated once, which compiling them would not be worth."""
        if id(node) not in known:
            of = partial(self._value, values=values, known=known)
            match node:
                case ast.Name(id=name):
                    value = self._meaning(name, values)
                case ast.Constant(value=value):
                    pass
                case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATIONS:
                    value = _OPERATIONS[type(op)](of(left), of(right))
                case ast.UnaryOp(op=ast.USub(), operand=operand):
                    value = -of(operand)
                case ast.Call(func=function, args=arguments, keywords=[]) if not _has_starred(arguments):
                    value = of(function)(*map(of, arguments))
                case ast.Attribute(value=inner, attr=name):
                    value = getattr(of(inner), name)
                case _:
                    value = self._compiled(node, values)
            known[id(node)] = value
        return known[id(node)]

    def _meaning(self, name: str, values: Mapping[str, Any]) -> Any:
        if name in values:
            return values[name]
        return self.space[name] if name in self.space else getattr(builtins, name)

    def _compiled(self, node: ast.expr, values: Mapping[str, Any]) -> Any:
        code = compile(ast.fix_missing_locations(ast.Expression(node)), "<formula>", "eval")
        return eval(code, {**self.space, **values})  # of the course's own code


def _has_starred(arguments: Sequence[ast.expr]) -> bool:
    return any(isinstance(argument, ast.Starred) for argument in arguments)


@lru_cache(maxsize=1024)
def formula_of(function: Callable[..., Any]) -> Formula | None:
    """Return the formula of a quantity's function; None where only words describe it."""
    template = getattr(function, "__formula__", None)
    try:
        return _of_code(function) if template is None else _of_template(template)
    except (NoExpression, NotEvaluable):
        return None


def _of_code(function: Callable[..., Any]) -> Formula:
    space = dict(getattr(function, "__globals__", {}))
    closure = inspect.getclosurevars(function).nonlocals if inspect.isfunction(function) else {}
    inlined = _Inlined(space | dict(closure))
    tree = inlined.visit(copy.deepcopy(expression(function)))
    names = tuple(inspect.signature(function).parameters)
    return Formula(tree, names, MappingProxyType(inlined.space))


class _Inlined(ast.NodeTransformer):
    """Substitution of private helpers by their single expression."""

    def __init__(self, space: dict[str, Any]):
        self.space = space

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        helper = self.space.get(node.func.id) if isinstance(node.func, ast.Name) else None
        if not called_name(node).startswith("_") or node.keywords or helper is None:
            return node
        try:
            tree = put_in(helper, node.args)
        except NoExpression:
            return node
        for name, meaning in helper.__globals__.items():
            self.space.setdefault(name, meaning)
        result: ast.expr = self.visit(tree)
        return result


# --------------------------------------------------------------- printed formulas

_ANGLES = {
    name: getattr(degrees, name)
    for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "angle", "sqrt")
}
_SPACE: Mapping[str, Any] = {
    **_ANGLES,
    "abs": np.abs,
    "minimum": lambda *values: np.minimum.reduce(np.broadcast_arrays(*values)),
    "maximum": lambda *values: np.maximum.reduce(np.broadcast_arrays(*values)),
    "hypot": np.hypot,
    "exp": np.exp,
    "log": np.log,
    "sign": np.sign,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
    "real": np.real,
    "imag": np.imag,
}
_CALLED = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "ln": "log",
    "sgn": "sign",
    "min": "minimum",
    "max": "maximum",
    "arg": "angle",
    "Re": "real",
    "Im": "imag",
}
_FIRST = 10**9  #: numbers from here on stand for names


def _of_template(template: str) -> Formula:
    """Parse a printed formula, its angles in degrees."""
    names = tuple(dict.fromkeys(re.findall(r"<(\w+)>", template)))
    latex = re.sub(r"<(\w+)>", lambda m: rf"\num{{{_FIRST + names.index(m[1])}}}", template)
    try:
        tree = parse(latex)
    except BadStatement as fault:
        raise NotEvaluable(str(fault)) from fault
    result = _Coding(names).of(tree)
    if not isinstance(result, _Code):
        raise NotEvaluable("it is not an expression of quantities")
    return Formula(result.tree, names, _SPACE)


class _Code:
    """Expression built up by the operations on it."""

    def __init__(self, tree: ast.expr):
        self.tree = tree

    def _with(self, op: ast.operator, other: Any, *, first: bool = True) -> _Code:
        item, two = (self.tree, _code(other)) if first else (_code(other), self.tree)
        return _Code(ast.BinOp(item, op, two))

    def __add__(self, other: Any) -> _Code:
        return self._with(ast.Add(), other)

    def __radd__(self, other: Any) -> _Code:
        return self._with(ast.Add(), other, first=False)

    def __sub__(self, other: Any) -> _Code:
        return self._with(ast.Sub(), other)

    def __rsub__(self, other: Any) -> _Code:
        return self._with(ast.Sub(), other, first=False)

    def __mul__(self, other: Any) -> _Code:
        return self._with(ast.Mult(), other)

    def __rmul__(self, other: Any) -> _Code:
        return self._with(ast.Mult(), other, first=False)

    def __neg__(self) -> _Code:
        return _Code(ast.UnaryOp(ast.USub(), self.tree))


def _code(value: Any) -> ast.expr:
    return value.tree if isinstance(value, _Code) else ast.Constant(value)


class _Coding(Evaluation):
    """Parser of printed formulas that builds code in place of numbers."""

    def __init__(self, names: Sequence[str]):
        super().__init__((), ())
        self.names = names

    def of(self, node: Node) -> Any:
        match node:
            case Num(negative=negative, digits=digits, exponent=exponent):
                value = float(f"{digits}e{exponent or 0}")
                if value >= _FIRST:
                    return _Code(ast.Name(self.names[int(value) - _FIRST], ast.Load()))
                value = -value if negative else value
                return _Code(ast.Constant(int(value) if value.is_integer() else value))
            case Symbol(text=text, kind="digits"):
                return _Code(ast.Constant(float(text) if "." in text else int(text)))
            case Fraction(above=above, below=below):
                return _Code(ast.BinOp(_code(self.of(above)), ast.Div(), _code(self.of(below))))
            case Root(body=body, index=None):
                return self.called("sqrt", [self.of(body)])
            case Fence(left="|", body=body, right="|"):
                return self.called("abs", [self.of(body)])
            case Script(base=Symbol(text="e", kind="letter")):
                raise NotEvaluable("an exponential has no angle in degrees")
            case Script(base=base, below=None, above=above, primes=0) if above in DEGREE_SIGNS:
                return self.of(base)
        return super().of(node)

    def called(self, name: str, arguments: Sequence[Any]) -> Any:
        return _Code(call(_CALLED.get(name, name), *map(_code, arguments)))

    def power(self, value: Any, exponent: Node) -> Any:
        return _Code(ast.BinOp(_code(value), ast.Pow(), _code(self.of(exponent))))
