"""Equivalence of two equations, judged by value at scattered points."""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache

import numpy as np

from coursework.parsing.equations import Equation, value_or_nan
from coursework.parsing.trees import Expression, Operation


@lru_cache(maxsize=1024)
def _points(name: str, count: int) -> np.ndarray:
    """Return fixed scattered values in (0.3, 3), the same for ever for a name. Not to be changed."""
    words = np.frombuffer(hashlib.shake_128(name.encode()).digest(8 * count), dtype="<u8")
    values = 0.3 + 2.7 * (words / 2.0**64)
    values.flags.writeable = False
    return values


def same_equation(a: Equation, b: Equation, *, parameters: Iterable[str] = (), rng_points: int = 32) -> bool:
    """Return whether two equations differ by a factor only, judged by value at scattered points.

    The factor is a number, or an expression in the ``parameters`` alone (lengths, where angles and rates are
    the unknowns): ``omega = -(R + r)*phi_dot/r`` is ``r*omega + (R + r)*phi_dot = 0``. It may also hold what
    one of the two divides by, a tangent's cosine with it, as long as that does not vanish with the equation:
    ``sin(a)/sin(b) = r2/r1`` is ``r1*sin(a) = r2*sin(b)``. Points outside a domain (a negative square root)
    are left out. An equation that holds everywhere says nothing and equals only another such.
    """
    names = sorted(a.variables | b.variables)
    held = [name for name in names if name in set(parameters)]
    draws = 4 if held else 1

    def drawn(draw: int) -> dict[str, np.ndarray]:
        values = {name: _points(name, rng_points) for name in names}
        return values | {name: np.full(rng_points, _points(name, draws)[draw]) for name in held}

    if all(_proportional(a, b, drawn(draw), rng_points) for draw in range(draws)):
        return True
    divisors = [d for d in _divisors(a) + _divisors(b) if not d.variables <= set(held)]
    if not 0 < len(divisors) <= MAX_DIVISORS:
        return False
    points = [drawn(draw) for draw in range(draws)]
    powers = _powers(a, b, divisors, points[0], rng_points)
    if powers is None:
        return False
    divided = [(d, power) for d, power in zip(divisors, powers, strict=True) if power]
    if not all(_proportional(a, b, values, rng_points, divided) for values in points):
        return False
    lines = _SampleLines(names, held)
    with np.errstate(all="ignore"):
        return _apart([divisor for divisor, _ in divided], (a, b), lines)


def _proportional(
    a: Equation,
    b: Equation,
    values: Mapping[str, np.ndarray],
    rng_points: int,
    divided: Iterable[tuple[Expression, int]] = (),
) -> bool:
    """Return whether ``a`` and ``b`` times powers of ``divided`` keep one ratio, finite and not zero."""
    with np.errstate(all="ignore"):
        (da, sa), (db, sb) = (e.gap(values, rng_points) for e in (a, b))
        for divisor, power in divided:
            factor = value_or_nan(divisor, values) ** float(power)
            db, sb = db * factor, sb * np.abs(factor)
        finite = np.isfinite(da) & np.isfinite(db)
    if finite.sum() < max(2, rng_points // 4):
        return False
    da, sa, db, sb = da[finite], sa[finite], db[finite], sb[finite]
    empty_a, empty_b = (bool(np.all(np.abs(d) <= 1e-12 * s)) for d, s in ((da, sa), (db, sb)))
    if empty_a or empty_b:
        return empty_a and empty_b
    best = int(np.argmax(np.abs(db) / np.where(sb > 0, sb, 1.0)))
    factor = da[best] / db[best]
    close = np.abs(da - factor * db) <= 1e-9 * (sa + np.abs(factor) * sb)
    return bool(factor != 0 and np.all(close))


# --- equations that are divided by something ----------------------------------------------

MAX_DIVISORS = 6
_LINES = 10
_STEPS = 96
_ZOOMS = 9  #: each narrows a place eight times, to about 1e-10
_NEGLIGIBLE = 1e-6  #: what counts as zero, beside the usual size
_ENOUGH = 4  #: zeros on the lines, without which nothing is said

_OfValues = Callable[[Mapping[str, np.ndarray], int], np.ndarray]


def _factors(node: Operation) -> Iterable[Operation]:
    """Yield the factors of a product, a power or an opposite, whatever the powers; a tangent counts as a
    quotient."""
    if node.kind == "product":
        for arg in node.args:
            yield from _factors(arg)
    elif node.kind in ("neg", "degree", "power"):
        yield from _factors(node.args[0])
    elif (node.kind, node.name) == ("call", "tan"):
        yield Operation("call", "sin", node.args)
        yield Operation("call", "cos", node.args)
    else:
        yield node


def _divisors(equation: Equation) -> list[Expression]:
    """Return the factors by which an equation divides: each vanishes only where the equation is not
    defined."""
    divisors: dict[Operation, Expression] = {}
    for node in (*equation.left.root.walk(), *equation.right.root.walk()):
        below: list[Operation] = []
        if node.kind == "product":
            below = [arg for sign, arg in zip(node.name, node.args, strict=True) if sign == "/"]
        elif node.kind == "power" and node.args[1].kind == "neg":
            below = [node.args[0]]
        elif node.kind == "call" and node.name == "tan":
            below = [Operation("call", "cos", node.args)]
        elif node.kind == "call" and node.name in ("sin", "cos") and node.args[0].name in ("atan", "atan2"):
            below = [_hypotenuse(*node.args[0].args)]
        for factor in itertools.chain.from_iterable(map(_factors, below)):
            if not factor.constant:
                divisors.setdefault(factor, Expression(equation.text, factor))
    return list(divisors.values())


def _hypotenuse(y: Operation, x: Operation | None = None) -> Operation:
    """Return the hypotenuse of the triangle of sides y and x (1 by default): the divisor in the sine and
    cosine of an arctangent."""
    two, x = Operation("number", "2"), x or Operation("number", "1")
    squares = Operation("sum", "++", (Operation("power", args=(x, two)), Operation("power", args=(y, two))))
    return Operation("call", "sqrt", (squares,))


def _powers(
    a: Equation,
    b: Equation,
    divisors: Sequence[Expression],
    values: Mapping[str, np.ndarray],
    rng_points: int,
) -> list[int] | None:
    """Return the whole powers of the divisors whose product is the ratio of ``a`` to ``b``, if the values
    allow it.

    A divisor proportional to an earlier one gets the power 0.
    """
    with np.errstate(all="ignore"):
        da, db = (e.gap(values, rng_points)[0] for e in (a, b))
        ratio = np.log(np.abs(da / db))
        columns = [np.log(np.abs(np.broadcast_to(value_or_nan(d, values), (rng_points,)))) for d in divisors]
    finite = np.isfinite(ratio) & np.all(np.isfinite(columns), axis=0)
    if finite.sum() < len(divisors) + 4:
        return None
    powers = [0] * len(divisors)
    table = np.array([column[finite] for column in columns]).T
    table, ratio = table - table.mean(axis=0), ratio[finite] - ratio[finite].mean()
    chosen: list[int] = []
    for index, column in enumerate(table.T):
        if all(np.max(np.abs(column - table[:, other])) > 1e-9 for other in chosen):
            chosen.append(index)
    solution = np.linalg.lstsq(table[:, chosen], ratio, rcond=None)[0]
    for index, power in zip(chosen, np.rint(solution), strict=True):
        if abs(power) > 4:
            return None
        powers[index] = int(power)
    return powers


class _SampleLines:
    """Fixed scattered lines through the space of the variables, along which a function's zeros are found.

    Parameters keep their value on a line; the other variables run through both signs and some turns.
    """

    def __init__(self, names: Iterable[str], held: Iterable[str]) -> None:
        fixed = set(held)
        self.start = {n: _points(n, _LINES) if n in fixed else _both_signs(f"start of {n}") for n in names}
        self.slope = {n: np.zeros(_LINES) if n in fixed else 2 * _both_signs(f"slope of {n}") for n in names}

    def along(self, function: _OfValues, line: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Return the size of a function at points of lines, infinite where it has none."""
        values = {name: start[line] + t * self.slope[name][line] for name, start in self.start.items()}
        size = np.abs(function(values, t.size))
        return np.where(np.isnan(size), np.inf, size)

    def zeros(self, function: _OfValues) -> tuple[np.ndarray, np.ndarray, float]:
        """Lines and places of the zeros, also of those where no sign changes; below what a size is zero."""
        grid = np.linspace(-1.0, 1.0, _STEPS)
        line, t = np.repeat(np.arange(_LINES), _STEPS), np.tile(grid, _LINES)
        size = self.along(function, line, t).reshape(_LINES, _STEPS)
        finite = size[np.isfinite(size)]
        inside = size[:, 1:-1]
        smallest = (inside <= size[:, :-2]) & (inside <= size[:, 2:]) & np.isfinite(inside)
        line, indices = np.nonzero(smallest)
        t, width = grid[indices + 1], grid[1] - grid[0]
        for _ in range(_ZOOMS):
            fan = t[:, None] + width * np.linspace(-1.0, 1.0, 17)
            size = self.along(function, np.repeat(line, 17), fan.ravel()).reshape(fan.shape)
            t = fan[np.arange(t.size), size.argmin(axis=1)]
            width /= 8
        zero = _NEGLIGIBLE * float(np.median(finite)) if finite.size else 0.0
        small = self.along(function, line, t) <= zero
        return line[small], t[small], zero


def _both_signs(name: str) -> np.ndarray:
    return (_points(name, _LINES) - 1.65) * 2.2


def _apart(divisors: Sequence[Expression], equations: Sequence[Equation], lines: _SampleLines) -> bool:
    """Return whether divisors and equations have no common root: neither vanishes at the solutions of the
    other.

    An equation without a solution on the lines, or over complex numbers, is not said to be apart.
    """
    gaps = [lambda values, count, e=e: e.gap(values, count)[0] for e in equations]
    sizes = [lambda values, count, d=d: np.broadcast_to(value_or_nan(d, values), (count,)) for d in divisors]
    solved, divided = ([(f, *lines.zeros(f)) for f in functions] for functions in (gaps, sizes))
    if any(t.size < _ENOUGH for _, _, t, _ in solved):
        return False
    return not any(
        np.any(lines.along(f, line, t) <= zero)
        for (gap, gap_line, gap_t, gap_zero), (size, size_line, size_t, size_zero) in itertools.product(
            solved, divided
        )
        for f, line, t, zero in ((size, gap_line, gap_t, size_zero), (gap, size_line, size_t, gap_zero))
    )
