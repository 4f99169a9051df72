"""Expressions as trees that compute: no text of a student is ever run."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coursework.parsing.spelling import shorten
from coursework.parsing.vocabulary import FUNCTIONS, INVERSE, Unreadable, Value

MAX_EXPONENT = 64


# --- trees ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Operation:
    """One operation: ``number constant variable neg sum product power call degree``.

    ``name`` is the number's text, the name, or one sign for each term of a sum or product.
    ``angle``: the value is an angle in radians because a degree sign says so.
    """

    kind: str
    name: str = ""
    args: tuple[Operation, ...] = ()
    angle: bool = False

    def walk(self) -> Iterable[Operation]:
        yield self
        for arg in self.args:
            yield from arg.walk()

    @property
    def constant(self) -> bool:
        return all(node.kind != "variable" for node in self.walk())

    @property
    def speaks_of_pi(self) -> bool:
        return any((node.kind, node.name) == ("constant", "pi") for node in self.walk())

    @property
    def has_inverse(self) -> bool:
        """Return whether an inverse trigonometric function gives an angle in the operation."""
        return any(node.kind == "call" and node.name in INVERSE for node in self.walk())

    @property
    def powers_of_pi(self) -> frozenset[int]:
        """The powers of pi among its terms as factors stand: 1 of ``2π/3``, -1 of ``1.8*180/π``, 0 of what
        has none."""
        if self.kind == "sum":
            return frozenset().union(*(arg.powers_of_pi for arg in self.args))
        if self.kind in ("neg", "degree"):
            return self.args[0].powers_of_pi
        if (self.kind, self.name) == ("constant", "pi"):
            return frozenset({1})
        if self.kind == "product":
            powers = frozenset({0})
            for sign, arg in zip(self.name, self.args, strict=True):
                arg_powers = arg.powers_of_pi
                powers = frozenset(p + (q if sign == "*" else -q) for p in powers for q in arg_powers)
            return powers
        return frozenset({0})

    @property
    def turns(self) -> bool:
        """Return whether the operation is an angle in radians by itself: ``acos(0.5)``, or a multiple of
        one."""
        if self.kind == "call":
            return self.name in INVERSE
        if self.kind == "neg":
            return self.args[0].turns
        return self.kind == "product" and [
            s for s, arg in zip(self.name, self.args, strict=True) if arg.turns
        ] == ["*"]


def _number(value: object) -> np.ndarray | np.generic:
    array = np.asarray(value)
    return (array if array.dtype.kind == "c" else array.astype(float))[()]


_CONSTANTS = {"pi": _number(math.pi), "e": _number(math.e), "i": _number(1j)}


def _power(base: Value, exponent: Value) -> Value:
    if np.any(np.abs(exponent) > MAX_EXPONENT):
        raise Unreadable(
            f"an exponent beyond {MAX_EXPONENT} is not computed", code="too_complex", piece=f"^{exponent}"
        )
    return base**exponent


def compute(node: Operation, values: Mapping[str, object]) -> Any:
    if node.kind == "number":
        return _number(float(node.name))
    if node.kind == "constant":
        return _CONSTANTS[node.name]
    if node.kind == "variable":
        return _number(values[node.name])
    args = [compute(arg, values) for arg in node.args]
    if node.kind == "neg":
        return -args[0]
    if node.kind == "degree":
        return args[0] * (math.pi / 180)
    if node.kind == "power":
        return _power(*args)
    if node.kind == "call":
        return FUNCTIONS[node.name](*args)
    total = args[0]
    for sign, arg in zip(node.name[1:], args[1:], strict=True):
        if sign == "+":
            total = total + arg
        elif sign == "-":
            total = total - arg
        else:
            total = total * arg if sign == "*" else total / arg
    return total


def without_idle(node: Operation) -> Operation:
    """Return a tree without what does nothing: ``+ 0``, ``· 1``, ``/ 1``, ``^ 1``, signs and bars; what is
    times 0 is 0."""
    args = tuple(map(without_idle, node.args))
    if node.kind in ("neg", "degree") or (node.kind, node.name) == ("call", "abs"):
        return args[0]
    if node.kind == "power" and (_is_number(args[1], 1) or _is_number(args[0], 0) or _is_number(args[0], 1)):
        return args[0]
    if node.kind == "sum":
        terms = [arg for arg in args if not _is_number(arg, 0)] or [args[0]]
        return terms[0] if len(terms) == 1 else replace(node, args=args)
    if node.kind == "product":
        above = [
            arg for sign, arg in zip(node.name, args, strict=True) if sign == "*" and not _is_number(arg, 1)
        ]
        below = [
            arg for sign, arg in zip(node.name, args, strict=True) if sign == "/" and not _is_number(arg, 1)
        ]
        if not any(_is_number(arg, 0) for arg in below):
            nought = [arg for arg in above if _is_number(arg, 0)]
            if nought or (not below and len(above) < 2):
                return (nought or above or list(args))[0]
    return replace(node, args=args)


def _is_number(node: Operation, value: float) -> bool:
    return node.kind == "number" and float(node.name) == value


def numbers_in_degrees(node: Operation) -> Operation:
    """Return a tree in which plain numbers under a sine, a cosine, a tangent or ``e^(i …)`` are degrees,
    alone or added."""
    args = tuple(map(numbers_in_degrees, node.args))
    if node.kind == "call" and node.name in ("sin", "cos", "tan"):
        args = (_angle_in_degrees(args[0]),)
    elif node.kind == "call" and node.name == "exp":
        args = (_exponent_in_degrees(args[0]),)
    elif node.kind == "power" and args[0] == Operation("constant", "e"):
        args = (args[0], _exponent_in_degrees(args[1]))
    return replace(node, args=args) if args != node.args else node


def _angle_in_degrees(node: Operation) -> Operation:
    """Return an angle whose plain numbers are degrees; what is said in terms of pi is in radians."""
    if node.kind in ("sum", "neg"):
        return replace(node, args=tuple(map(_angle_in_degrees, node.args)))
    is_plain = node.constant and not (node.angle or node.speaks_of_pi or node.has_inverse)
    return Operation("degree", args=(node,), angle=True) if is_plain else node


def _exponent_in_degrees(node: Operation) -> Operation:
    """Return an exponent of e in which plain numbers beside the imaginary unit are degrees: ``i*90``,
    ``i(theta2 + 90)``."""
    if node.kind in ("sum", "neg"):
        return replace(node, args=tuple(map(_exponent_in_degrees, node.args)))
    if node.kind != "product" or sum(arg == _IMAGINARY for arg in node.args) != 1:
        return node
    others = [arg for arg in node.args if arg != _IMAGINARY]
    if node.constant and not any(arg.angle or arg.speaks_of_pi or arg.has_inverse for arg in others):
        return Operation("degree", args=(node,))
    if len(others) == 1:
        return replace(node, args=tuple(a if a == _IMAGINARY else _angle_in_degrees(a) for a in node.args))
    return node


_IMAGINARY = Operation("constant", "i")


def bare_angles(node: Operation) -> Iterable[float]:
    """Return the plain numbers that :func:`numbers_in_degrees` takes for degrees."""
    if node.kind == "call" and node.name in ("sin", "cos", "tan"):
        yield from _bare_terms(node.args[0])
    for arg in node.args:
        yield from bare_angles(arg)


def _bare_terms(node: Operation) -> Iterable[float]:
    if node.kind in ("sum", "neg"):
        for arg in node.args:
            yield from _bare_terms(arg)
    elif _angle_in_degrees(node) != node:
        with np.errstate(all="ignore"):
            yield float(compute(node, {}))


_A_RADIAN = math.degrees(1.0)


def _calculated_in_degrees(node: Operation) -> Operation:
    """Return a tree whose trigonometric functions take degrees, and whose inverse ones give them unless
    converted by hand."""
    args = tuple(map(_calculated_in_degrees, node.args))
    if node.kind == "call" and node.name in ("sin", "cos", "tan"):
        return replace(node, args=(Operation("degree", args=args),))
    if node.kind == "call" and node.name in INVERSE:
        return Operation("product", "**", (replace(node, args=args), Operation("number", repr(_A_RADIAN))))
    if node.kind == "product" and node.turns and _is_conversion(node):
        args = tuple(
            new.args[0] if old.kind == "call" and old.turns else new
            for old, new in zip(node.args, args, strict=True)
        )
    return replace(node, args=args)


def _is_conversion(node: Operation) -> bool:
    """Return whether a product of an inverse function converts radians into degrees,
    ``acos(0.5)*180/3.14``."""
    pairs = [(s, arg) for s, arg in zip(node.name, node.args, strict=True) if not arg.turns]
    if not pairs or not all(arg.constant for _, arg in pairs):
        return False
    signs, args = zip(*pairs, strict=True)
    unity = Operation("number", "1")
    with np.errstate(all="ignore"):
        factor = compute(Operation("product", "*" + "".join(signs), (unity, *args)), {})
    return bool(abs(factor / _A_RADIAN - 1) < 0.01)


@dataclass(frozen=True)
class Expression:
    """A formula that has been read.

    ``is_angle``: a degree sign makes it an angle, in radians. ``other`` is the second honest reading of
    ``1/2π``, where the product binds first; ``is_plain_quotient`` where there is nothing else, so that one
    number alone is chosen freely.
    """

    text: str
    root: Operation
    other: Expression | None = None
    is_plain_quotient: bool = False

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of the variables used."""
        return frozenset(node.name for node in self.root.walk() if node.kind == "variable")

    @property
    def is_angle(self) -> bool:
        return self.root.angle

    @property
    def as_calculated_in_degrees(self) -> Expression | None:
        """The formula of who works in degrees, ``180 - atan(1.6)``: its functions take and give them.

        None where no inverse function gives an angle, where pi says that it is in radians, or a degree sign
        has spoken.
        """
        if (
            not self.root.has_inverse
            or self.root.speaks_of_pi
            or any(node.angle for node in self.root.walk())
        ):
            return None
        return Expression(self.text, _calculated_in_degrees(self.root))

    def evaluate(self, values: Mapping[str, object] | None = None) -> Any:
        """Return the value, of the shape to which the values broadcast; angles in radians.

        Raises
        ------
        Unreadable
            A scalar result that is not finite (an array is NaN or infinite there), an exponent beyond 64.
        """
        with np.errstate(all="ignore"):
            result = compute(self.root, values or {})
        if np.ndim(result):
            return result
        if not np.isfinite(result):
            message = f"{shorten(self.text)!r} has no finite value"
            raise Unreadable(message, code="not_finite", piece=self.text)
        return result.item()
