"""Right methods from a student's own earlier answers, if Maxima can compute them in one expression."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from coursework.course.variant import Variant
from coursework.errors import CourseworkError
from coursework.model import Part
from coursework.platforms._maxima import Unprintable, number, printed
from coursework.quantities.formula_code import formula_of

_LONGEST = 600  #: characters of a formula that a teacher may still read
_TRIED = (1.07, 0.9)  #: factors of the wrong earlier answers by which a formula is checked
_SAME = 1e-9


@dataclass(frozen=True)
class Following:
    """Formula of an answer from earlier ones."""

    maxima: str  #: an expression of ``v1``, ``v2``, …, the earlier answers by their number
    earlier: tuple[int, ...]  #: the numbers of these


@lru_cache(maxsize=64)  # of the variant at hand: its trees and its losses ask
def following(variant: Variant, part: Part) -> Following | None:
    """Return the formula of a part's answer from earlier ones; None if Maxima cannot express it."""
    earlier = _earlier(variant, part)
    if not earlier:
        return None
    formulas = _Formulas(variant, {p.quantity: part_number for part_number, p in earlier.items()})
    try:
        maxima = formulas.of(part.quantity, first=True)
    except (Unprintable, CourseworkError):
        return None
    used = tuple(sorted(formulas.used))
    if not used or len(maxima) > _LONGEST:
        return None
    result = Following(maxima, used)
    return result if _is_proved(variant, part, formulas, earlier) else None


def _earlier(variant: Variant, part: Part) -> dict[int, Part]:
    """Return the earlier parts on which this one may depend, by their number."""
    if not part.sort.follows or not part.sort.is_scalar or part.judge:
        return {}
    before = variant.parts[: variant.parts.index(part)]
    depending = variant.key.solution.depending_on
    return {
        part_number: p
        for part_number, p in enumerate(before, start=1)
        if p.sort.is_followed
        and p.sort.is_scalar
        and not p.choices
        and not p.judge
        and p.quantity != part.quantity
        and part.quantity in depending(p.quantity)
    }


class _Formulas:
    """Formulas of a variant, with numbers for quantities that depend on no earlier answer."""

    def __init__(self, variant: Variant, earlier: Mapping[str, int]):
        self._variant, self._earlier = variant, earlier
        self.used: set[int] = set()
        depending = variant.key.solution.depending_on
        self._moving = {q for answered in earlier for q in depending(answered)}

    def of(self, quantity: str, *, first: bool = False) -> str:
        if not first and quantity in self._earlier:
            self.used.add(self._earlier[quantity])
            return f"v{self._earlier[quantity]}"
        if quantity not in self._moving:
            return self._constant(quantity)
        formula = formula_of(self._variant.key.solution.graph.node(quantity).function)
        if formula is None:
            raise Unprintable(quantity)
        names = set(formula.names)

        def name(found: str) -> str:
            if found not in names:
                raise KeyError(found)
            return self.of(found)

        return f"({printed(formula.tree, name, formula.space)})"

    def _constant(self, quantity: str) -> str:
        variant = self._variant
        if quantity in variant.used:
            value = variant.used[quantity]
        else:
            graph = variant.key.solution.graph
            value = graph.evaluate((quantity,), variant.used, variant.effects)[quantity]
        try:
            return number(value.item() if hasattr(value, "item") else value)
        except (TypeError, ValueError) as fault:
            raise Unprintable(quantity) from fault


def _is_proved(variant: Variant, part: Part, formulas: _Formulas, earlier: Mapping[int, Part]) -> bool:
    """Return whether the formula gives the value that our marking accepts for the same earlier answers."""
    for factor in _TRIED:
        answers = {
            part_number: float(variant.key.reference[p.quantity]) * factor
            for part_number, p in earlier.items()
        }
        expected = follows(variant, part, answers)
        value = _evaluated(formulas.of(part.quantity, first=True), answers)
        if (
            expected is None
            or value is None
            or not math.isclose(value, expected, rel_tol=_SAME, abs_tol=_SAME)
        ):
            turn = part.sort.turn
            if not (turn and expected is not None and value is not None):
                return False
            if abs((value - expected + turn / 2) % turn - turn / 2) > _SAME * turn:
                return False
    return True


def follows(variant: Variant, part: Part, answers: Mapping[int, float]) -> float | None:
    """Return the value that our marking accepts after earlier answers, by their number."""
    quantities = {variant.parts[part_number - 1].quantity: value for part_number, value in answers.items()}
    try:
        given = {**variant.used, **quantities}
        value = variant.key.solution.graph.evaluate((part.quantity,), given, variant.effects)[part.quantity]
        return float(value)
    except (CourseworkError, TypeError, ValueError):
        return None


def _evaluated(maxima: str, answers: Mapping[int, float]) -> float | None:
    """Return the value of such an expression."""
    space: dict[str, Any] = {
        "sin": cmath.sin,
        "cos": cmath.cos,
        "tan": cmath.tan,
        "asin": cmath.asin,
        "acos": cmath.acos,
        "atan": cmath.atan,
        "exp": cmath.exp,
        "log": cmath.log,
        "sqrt": cmath.sqrt,
        "atan2": lambda y, x: math.atan2(complex(y).real, complex(x).real),
        "carg": lambda z: cmath.phase(z),
        "cabs": abs,
        "realpart": lambda z: complex(z).real,
        "imagpart": lambda z: complex(z).imag,
        "conjugate": lambda z: complex(z).conjugate(),
        "signum": lambda x: math.copysign(1.0, complex(x).real),
        "min": lambda a, b: min(complex(a).real, complex(b).real),
        "max": lambda a, b: max(complex(a).real, complex(b).real),
        "ceiling": lambda x: math.ceil(complex(x).real),
        "PI": math.pi,
        "I": 1j,
        **{f"v{part_number}": value for part_number, value in answers.items()},
    }
    text = maxima.replace("%pi", "PI").replace("%i", "I").replace("^", "**")
    try:
        # The formula is one that this package printed.
        value = complex(eval(compile(text, "<formula>", "eval"), {"__builtins__": {}}, space))
    except (ArithmeticError, ValueError):
        return None
    return value.real if abs(value.imag) <= _SAME * max(1.0, abs(value)) else None
