"""Usual errors of students in a formula, derived from the formula itself.

Each term of a sum left out, each of its signs reversed; a factor, a square or a root forgotten; a fraction
inverted; sine and cosine exchanged; degrees taken for radians, in one angle or in all; an arctangent that
loses its quadrant; the other angle of the same sine or cosine.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from copy import copy, deepcopy
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from coursework import degrees
from coursework.quantities.formula_code import Formula, added, call, called_name, formula_of

TERM, SIGN, FACTOR, SQUARE, ROOT, INVERSE = "term", "term_sign", "factor", "square", "root", "inverse"
FUNCTION, DEGREES, ALL_DEGREES, QUADRANT, BRANCH = "function", "degrees", "all_degrees", "quadrant", "branch"
ANGLE, ANGLE_SIGN, CONSTANT, ARGUMENTS, COUNT = "angle", "angle_sign", "constant", "arguments", "count"
#: The kinds of errors in a formula, in the order in which one is named that gives the same value as another.
KINDS = (
    TERM,
    COUNT,
    SIGN,
    CONSTANT,
    FACTOR,
    SQUARE,
    ROOT,
    INVERSE,
    FUNCTION,
    ARGUMENTS,
    QUADRANT,
    BRANCH,
    ALL_DEGREES,
    DEGREES,
    ANGLE,
    ANGLE_SIGN,
)

#: What is missing of a term that is left out whole, or is turned in it.
PARTS_OF_TERMS = frozenset((FACTOR, SQUARE, FUNCTION, DEGREES, ANGLE, ANGLE_SIGN))
#: What a teacher looks for first: something of the relation is missing or turned round.
WEIGHTY = frozenset((TERM, COUNT, SIGN, CONSTANT, SQUARE, ROOT, INVERSE, ALL_DEGREES))

_NEIGHBOURS = {name: getattr(degrees, name) for name in ("sin", "cos", "atan")} | {"abs": abs}
_HALF_TURN = 180.0
_FEW = 3  #: things that are forgotten in a count
_RADIAN = 57.29577951308232  #: degrees


@dataclass(frozen=True)
class FormulaError:
    """Error of a formula: its kind, the part of the formula if it is a single one, and the wrong formula."""

    kind: str
    about: ast.expr | None
    formula: Formula


_Change = tuple[str, ast.expr | None, ast.expr]  #: kind, what it is about, the tree with the error


@lru_cache(maxsize=1024)
def formula_errors(function: Callable[..., Any]) -> tuple[FormulaError, ...]:
    """Return the usual errors in the formula of a quantity's function; none where only words describe it."""
    formula = formula_of(function)
    if formula is None:
        return ()
    formula = replace(formula, space={**_NEIGHBOURS, **formula.space})
    changes = list(_Changes(formula).of(formula.tree))
    changes += _whole_formula_errors(formula)
    results: dict[Any, FormulaError] = {}
    met: dict[int, Any] = {}
    for kind, about, tree in sorted(changes, key=lambda change: KINDS.index(change[0])):
        results.setdefault(_shape(tree, met), FormulaError(kind, about, replace(formula, tree=tree)))
    results.pop(_shape(formula.tree, met), None)
    return tuple(results.values())


def _shape(node: Any, met: dict[int, Any]) -> Any:
    """Return what equal trees have in common; ``met`` holds that of trees which several share, by
    identity."""
    if isinstance(node, list):
        return tuple(_shape(item, met) for item in node)
    if not isinstance(node, ast.AST):
        return type(node), node
    if id(node) not in met:
        fields = (_shape(getattr(node, name, None), met) for name in node._fields)
        met[id(node)] = type(node), *fields
    return met[id(node)]


def _whole_formula_errors(formula: Formula) -> Iterator[_Change]:
    """Yield the errors that change the whole formula at once."""
    match formula.tree:
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            yield INVERSE, None, ast.BinOp(right, ast.Div(), left)
    in_radians = _AllInRadians(formula)
    tree = in_radians.visit(deepcopy(formula.tree))
    if in_radians.angles > 1:
        yield ALL_DEGREES, None, tree


class _Changes:
    """Generator of the formulas that differ from one in one place."""

    def __init__(self, formula: Formula):
        self.formula = formula

    def of(self, node: ast.expr) -> Iterator[_Change]:
        match node:
            case ast.BinOp(op=ast.Add() | ast.Sub()):
                yield from self._of_sum(node)
            case ast.BinOp(op=ast.Mult() | ast.Div()):
                yield from self._of_product(node)
            case ast.BinOp(left=left, op=ast.Pow(), right=ast.Constant(value=power)):
                yield (ROOT if power == 0.5 else SQUARE), left, left
                yield from _within(node, "left", self.of(left))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                yield SIGN, operand, operand
                yield from _within(node, "operand", self.of(operand))
            case ast.UnaryOp(operand=operand) if not isinstance(node.op, ast.Not):
                yield from _within(node, "operand", self.of(operand))
            case ast.Attribute(value=value, attr="real" | "imag") | ast.Subscript(value=value):
                yield from _within(node, "value", self.of(value))
            case ast.Call():
                yield from self._of_call(node)
            case ast.Tuple(elts=items) | ast.List(elts=items):
                yield from self._inside(items, lambda changed: _changed(node, "elts", changed))

    def _inside(
        self, items: Sequence[ast.expr], rebuild: Callable[[list[ast.expr]], ast.expr]
    ) -> Iterator[_Change]:
        """Yield the changes of each operand, within the tree that the operands form."""
        for index, item in enumerate(items):
            for kind, about, tree in self.of(item):
                yield kind, about, rebuild([*items[:index], tree, *items[index + 1 :]])

    # ------------------------------------------------------------- sums, products

    def _of_sum(self, node: ast.BinOp) -> Iterator[_Change]:
        terms = _terms(node)
        for index, (minus, term) in enumerate(terms):
            others = terms[:index] + terms[index + 1 :]
            yield (COUNT if _is_small(term) else TERM), term, added(others)
            yield SIGN, term, added([*terms[:index], (not minus, term), *terms[index + 1 :]])
        signs = [minus for minus, _ in terms]
        yield from self._inside(
            [term for _, term in terms], lambda changed: added(list(zip(signs, changed, strict=True)))
        )

    def _of_product(self, node: ast.BinOp) -> Iterator[_Change]:
        above, below = _factors(node)
        for index, factor in enumerate(above):
            if (len(above) > 1 or below) and not _is_sum(factor):
                yield _of_factor(factor), factor, _quotient(above[:index] + above[index + 1 :], below)
        for index, factor in enumerate(below):
            if not _is_sum(factor):
                yield _of_factor(factor), factor, _quotient(above, below[:index] + below[index + 1 :])
        yield from self._inside(
            [*above, *below], lambda changed: _quotient(changed[: len(above)], changed[len(above) :])
        )

    # ----------------------------------------------------------------- functions

    def _of_call(self, node: ast.Call) -> Iterator[_Change]:
        name, arguments = called_name(node), node.args
        takes_degrees = self._is_of_degrees(node)
        match name, arguments:
            case ("sin" | "cos", [angle]):
                yield FUNCTION, node, _called_as(node, "cos" if name == "sin" else "sin", [angle])
            case "sqrt", [inside]:
                yield ROOT, inside, inside
            case "hypot", [one, other]:
                yield TERM, one, call("abs", other)
                yield TERM, other, call("abs", one)
            case "atan2", [y, x] if takes_degrees:
                yield QUADRANT, node, _called_as(node, "atan", [ast.BinOp(y, ast.Div(), x)])
                yield ARGUMENTS, node, _called_as(node, "atan2", [x, y])
            case "asin", [_] if takes_degrees:
                yield BRANCH, node, ast.BinOp(ast.Constant(_HALF_TURN), ast.Sub(), node)
            case "acos", [_] if takes_degrees:
                yield BRANCH, node, ast.UnaryOp(ast.USub(), node)
        if takes_degrees and name in _TAKE_ANGLES:
            angle = arguments[-1]
            yield DEGREES, angle, _called_as(node, name, [*arguments[:-1], _in_radians(angle)])
        inner = slice(1, None) if name == "where" else slice(None)  # a condition is not a part of a formula
        for kind, about, tree in self._inside(
            arguments[inner],
            lambda changed: _changed(node, "args", [*arguments[: inner.start or 0], *changed]),
        ):
            is_angle = name in _OF_ANGLES or (name == "polar" and kind in _OF_TERMS)
            yield _OF_TERMS.get(kind, kind) if is_angle else kind, about, tree

    def _is_of_degrees(self, node: ast.Call) -> bool:
        return _is_of_degrees(self.formula, node)


_OF_ANGLES = ("sin", "cos", "tan")
_OF_TERMS = {TERM: ANGLE, COUNT: ANGLE, SIGN: ANGLE_SIGN}  #: what an error in a sum of angles is called
_TAKE_ANGLES = ("sin", "cos", "tan", "polar")


def _is_of_degrees(formula: Formula, node: ast.Call) -> bool:
    """Return whether the called function takes, or gives, degrees."""
    name = called_name(node)
    if not isinstance(node.func, ast.Name) or not hasattr(degrees, name):
        return False
    return formula.space.get(name) is getattr(degrees, name)


def _in_radians(angle: ast.expr) -> ast.expr:
    """Return the angle with its number of degrees taken for radians."""
    return ast.BinOp(angle, ast.Mult(), ast.Constant(_RADIAN))


class _AllInRadians(ast.NodeTransformer):
    """Substitution of radians for degrees in every angle passed to a function."""

    def __init__(self, formula: Formula):
        self.formula = formula
        self.angles = 0

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        if called_name(node) in _TAKE_ANGLES and _is_of_degrees(self.formula, node):
            self.angles += 1
            node.args[-1] = _in_radians(node.args[-1])
        return node


def _called_as(node: ast.Call, name: str, arguments: list[ast.expr]) -> ast.Call:
    """Return a call of a function's counterpart: ``np.cos`` for ``np.sin``."""
    function = node.func
    other = _changed(function, "attr", name) if isinstance(function, ast.Attribute) else call(name).func
    return ast.Call(other, arguments, [])


# --------------------------------------------------------------------------- trees


def _within(node: ast.expr, field: str, changes: Iterator[_Change]) -> Iterator[_Change]:
    for kind, about, tree in changes:
        yield kind, about, _changed(node, field, tree)


def _changed(node: ast.expr, field: str, value: Any) -> ast.expr:
    other = copy(node)
    setattr(other, field, value)
    return other


def _is_small(node: ast.expr) -> bool:
    """Return whether a term is a small whole number, as in a count."""
    return isinstance(node, ast.Constant) and isinstance(node.value, int) and abs(node.value) <= _FEW


def _of_factor(factor: ast.expr) -> str:
    is_pi = isinstance(factor, ast.Attribute) and factor.attr == "pi"
    return CONSTANT if is_pi or isinstance(factor, ast.Constant) else FACTOR


def _is_sum(node: ast.expr) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.Sub))


def _terms(node: ast.expr) -> list[tuple[bool, ast.expr]]:
    """Return the terms of a sum, each with whether it is subtracted."""
    match node:
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _terms(left) + _terms(right)
        case ast.BinOp(left=left, op=ast.Sub(), right=right):
            return _terms(left) + [(not minus, term) for minus, term in _terms(right)]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return [(not minus, term) for minus, term in _terms(operand)]
        case ast.BinOp(
            left=ast.UnaryOp(op=ast.USub(), operand=left), op=ast.Mult() | ast.Div() as op, right=right
        ):
            return [(True, ast.BinOp(left, op, right))]
        case ast.BinOp(left=ast.BinOp() as left, op=ast.Mult() | ast.Div() as op, right=right):
            ((minus, first), *more) = (
                _terms(left) if isinstance(left.op, (ast.Mult, ast.Div)) else [(False, left)]
            )
            return [(minus, ast.BinOp(first, op, right))] if not more else [(False, node)]
    return [(False, node)]


def _factors(node: ast.expr) -> tuple[list[ast.expr], list[ast.expr]]:
    """Return the factors of a product or a quotient, above and below its line."""
    match node:
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            (above, below), (more, under) = _factors(left), _factors(right)
            return above + more, below + under
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            (above, below), (under, more) = _factors(left), _factors(right)
            return above + more, below + under
    return [node], []


def _quotient(above: Sequence[ast.expr], below: Sequence[ast.expr]) -> ast.expr:
    over = _product(above)
    return ast.BinOp(over, ast.Div(), _product(below)) if below else over


def _product(factors: Sequence[ast.expr]) -> ast.expr:
    if not factors:
        return ast.Constant(1.0)
    result, *others = factors
    for factor in others:
        result = ast.BinOp(result, ast.Mult(), factor)
    return result
