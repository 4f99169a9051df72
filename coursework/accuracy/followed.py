"""Numbers that pass through a solution's formulas and record each operation.

The functions of a solution are written for floats and arrays. A :class:`Followed` number passes through them,
through ``coursework.degrees`` and through numpy's functions, on one of two sorts of arithmetic: many digits,
one number at a time, by mpmath; or plain arrays. On the way, a *tape* notes what must not vanish: a number
that is divided by, the distance whose direction is asked, what a root is taken of, what an arcsine lacks to
1.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np

QUOTIENT, ROOT, DIRECTION, ARC, LENGTH = "quotient", "root", "direction", "arc", "length"

#: What is noted of each: a kind, and a margin of the arguments that is 0 where digits are lost.
Tape = Callable[[str, Any], None]


class NotFollowed(TypeError):
    """Operation of a formula that cannot be followed."""


class Arithmetic:
    """Arithmetic of followed numbers; ``functions`` by numpy's names."""

    def __init__(self, functions: dict[str, Callable[..., Any]], tape: Tape | None = None) -> None:
        self.functions, self.tape = functions, tape
        self.mp: Any = None  #: the context of mpmath, of many digits

    def __call__(self, name: str, *values: Any) -> Any:
        """Evaluate a function of followed or plain numbers; truth values come out plain, numbers followed."""
        if name not in self.functions:
            raise NotFollowed(f"np.{name} is not followed")
        plain = [v.value if isinstance(v, Followed) else v for v in values]
        if self.tape is not None and name in _MARGINS:
            kind, margin = _MARGINS[name]
            self.tape(kind, margin(self.functions, *plain))
        result = self.functions[name](*plain)
        return result if _is_truth(result) else Followed(result, self)

    def __getattr__(self, name: str) -> Any:
        """Return the function that ``coursework.degrees`` takes from an mpmath context."""
        if name not in _OF_CONTEXT:
            raise AttributeError(name)
        if name == "mpf":
            return lambda value: value
        return lambda *values: self(_OF_CONTEXT[name], *values)


_OF_CONTEXT = {
    "mpf": "",
    "sinpi": "sinpi",
    "degrees": "degrees",
    "arg": "angle",
    "atan2": "arctan2",
    "sqrt": "sqrt",
    "ceil": "ceil",
    "atan": "arctan",
    "asin": "arcsin",
    "acos": "arccos",
}

_MARGINS: dict[str, tuple[str, Callable[..., Any]]] = {
    "true_divide": (QUOTIENT, lambda f, a, b: b),
    "divide": (QUOTIENT, lambda f, a, b: b),
    "reciprocal": (QUOTIENT, lambda f, a: a),
    "sqrt": (ROOT, lambda f, a: a),
    "arctan2": (DIRECTION, lambda f, y, x: f["hypot"](y, x)),
    "angle": (DIRECTION, lambda f, z: abs(z)),
    "hypot": (LENGTH, lambda f, y, x: f["hypot"](y, x)),
    "arcsin": (ARC, lambda f, a: (1 - a) * (1 + a)),
    "arccos": (ARC, lambda f, a: (1 - a) * (1 + a)),
}


def _is_truth(value: Any) -> bool:
    return isinstance(value, (bool, np.bool_)) or (isinstance(value, np.ndarray) and value.dtype.kind == "b")


class Followed:
    """Number, or array, of an arithmetic."""

    __array_priority__ = 1000.0
    __slots__ = ("context", "value")
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, value: Any, context: Arithmetic) -> None:
        self.value, self.context = value, context

    def __repr__(self) -> str:
        return f"Followed({self.value})"

    def _refuse(self, *_: Any, **__: Any) -> Any:
        raise NotFollowed("it makes plain numbers of its values")

    __array__ = __float__ = __int__ = __complex__ = __len__ = __iter__ = _refuse

    def __bool__(self) -> bool:
        return bool(self.value)

    def __getitem__(self, point: Any) -> Followed:
        if point == () or point is Ellipsis:
            return self
        raise NotFollowed("it takes its values apart")

    @property
    def real(self) -> Followed:
        return self.context("real", self)

    @property
    def imag(self) -> Followed:
        return self.context("imag", self)

    @property
    def ndim(self) -> int:
        return np.ndim(self.value)

    @property
    def shape(self) -> tuple[int, ...]:
        return np.shape(self.value)

    @property
    def size(self) -> int:
        return int(np.size(self.value))

    @property
    def dtype(self) -> np.dtype:
        return np.asarray(self.value).dtype

    def conjugate(self) -> Followed:
        return self.context("conjugate", self)

    def item(self) -> Followed:
        return self

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        if method != "__call__" or options:
            raise NotFollowed(f"np.{ufunc.__name__}.{method} is not followed")
        return self.context(ufunc.__name__, *inputs)

    def __array_function__(self, function: Any, _types: Any, args: Any, options: Any) -> Any:
        name = function.__name__
        if name == "select":
            return self._select(*args, **options)
        if name == "where" and len(args) == 3:
            return self.context("where", *args)
        if name in ("real", "imag", "angle", "clip") and not options:
            return self.context(name, *args)
        if name in ("ndim", "shape", "size"):
            return getattr(self, name)
        raise NotFollowed(f"np.{name} is not followed")

    def _select(self, conditions: Any, choices: Any, default: Any = 0) -> Any:
        result = default
        for condition, choice in reversed(list(zip(conditions, choices, strict=True))):
            result = self.context("where", condition, choice, result)
        return result


def _operator(name: str, *, turned: bool = False) -> Any:
    def method(self: Followed, *others: Any) -> Any:
        if any(isinstance(o, str) for o in others):
            return NotImplemented
        return self.context(name, *((*others, self) if turned else (self, *others)))

    return method


_DUNDERS = {
    "add": "add",
    "sub": "subtract",
    "mul": "multiply",
    "truediv": "true_divide",
    "pow": "power",
    "mod": "remainder",
    "neg": "negative",
    "pos": "positive",
    "abs": "absolute",
    "lt": "less",
    "le": "less_equal",
    "gt": "greater",
    "ge": "greater_equal",
    "eq": "equal",
    "ne": "not_equal",
}
for _dunder, _name in _DUNDERS.items():
    setattr(Followed, f"__{_dunder}__", _operator(_name))
    if _dunder in ("add", "sub", "mul", "truediv", "pow", "mod"):
        setattr(Followed, f"__r{_dunder}__", _operator(_name, turned=True))


# --------------------------------------------------------------------------- arrays


def of_arrays(tape: Tape | None = None) -> Arithmetic:
    """Return the arithmetic of plain arrays, with numpy's functions."""
    names = (
        "add subtract multiply true_divide divide power square reciprocal remainder negative positive "
        "absolute fabs sign "
        "sqrt exp log log10 sin cos tan arctan2 arcsin arccos arctan hypot degrees radians deg2rad "
        "rad2deg conjugate floor "
        "ceil rint maximum minimum fmax fmin less less_equal greater greater_equal equal not_equal "
        "isfinite isnan real imag "
        "angle where clip copysign"
    ).split()
    functions = {name: getattr(np, name) for name in names}
    functions["sinpi"] = _sinpi
    return Arithmetic(functions, tape)


def _sinpi(turns: Any) -> Any:
    """Return the sine of a number of half turns, reduced by whole half turns first."""
    full = np.rint(turns)
    sign = 1.0 - 2.0 * np.mod(full, 2.0)
    return sign * np.sin((turns - full) * math.pi)


# --------------------------------------------------------------------- many digits


def of_many_digits(digits: int) -> Arithmetic:
    """Return the arithmetic of single numbers in ``digits`` decimal digits; floats stand for exactly
    themselves."""
    import mpmath

    mp = mpmath.MPContext()
    mp.dps = digits

    def root(x: Any) -> Any:
        return mp.nan if mp.im(x) == 0 and mp.re(x) < 0 else mp.sqrt(x)

    def arc(function: Callable[..., Any]) -> Callable[..., Any]:
        return lambda x: function(x) if abs(x) <= 1 else mp.nan

    def divide(a: Any, b: Any) -> Any:
        return a / b if b else mp.nan

    functions: dict[str, Callable[..., Any]] = {
        "add": operator.add,
        "subtract": operator.sub,
        "multiply": operator.mul,
        "true_divide": divide,
        "divide": divide,
        "power": lambda a, b: _power(mp, a, b),
        "square": lambda a: a * a,
        "reciprocal": lambda a: divide(mp.one, a),
        "remainder": lambda a, b: a - b * mp.floor(a / b),
        "negative": operator.neg,
        "positive": operator.pos,
        "absolute": abs,
        "fabs": abs,
        "sign": mp.sign,
        "sqrt": root,
        "exp": mp.exp,
        "log": mp.log,
        "log10": mp.log10,
        "sin": mp.sin,
        "cos": mp.cos,
        "tan": mp.tan,
        "arctan2": lambda y, x: mp.atan2(y, x) if y or x else mp.nan,
        "arcsin": arc(mp.asin),
        "arccos": arc(mp.acos),
        "arctan": mp.atan,
        "hypot": mp.hypot,
        "degrees": mp.degrees,
        "rad2deg": mp.degrees,
        "radians": mp.radians,
        "deg2rad": mp.radians,
        "conjugate": mp.conj,
        "floor": mp.floor,
        "ceil": mp.ceil,
        "rint": mp.nint,
        "maximum": max,
        "minimum": min,
        "fmax": max,
        "fmin": min,
        "less": operator.lt,
        "less_equal": operator.le,
        "greater": operator.gt,
        "greater_equal": operator.ge,
        "equal": operator.eq,
        "not_equal": operator.ne,
        "isfinite": mp.isfinite,
        "isnan": mp.isnan,
        "real": mp.re,
        "imag": mp.im,
        "angle": lambda z: mp.arg(z) if z else mp.nan,
        "where": lambda c, a, b: a if c else b,
        "clip": lambda a, low, high: min(max(a, low), high),
        "copysign": lambda a, b: abs(a) if b >= 0 else -abs(a),
        "sinpi": mp.sinpi,
    }

    def taking(function: Callable[..., Any]) -> Callable[..., Any]:
        return lambda *values: function(*[_exact(mp, v) for v in values])

    created = Arithmetic({name: taking(function) for name, function in functions.items()})
    created.functions["where"] = lambda c, a, b: _exact(mp, a) if _truth(c) else _exact(mp, b)
    created.mp = mp
    return created


def _truth(value: Any) -> bool:
    return bool(np.all(value))


def _exact(mp: Any, value: Any) -> Any:
    """Return a plain number of a formula in many digits; pi and its simple fractions as exact multiples of
    pi."""
    if hasattr(value, "context") or isinstance(value, (str, bool)):
        return value
    if isinstance(value, np.ndarray):
        if value.ndim:
            raise NotFollowed("it makes arrays of its values")
        value = value.item()
        return _exact(mp, value)
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, complex):
        return mp.mpc(_exact(mp, value.real), _exact(mp, value.imag))
    if isinstance(value, float) and value in _TRANSCENDENT:
        return _TRANSCENDENT[value](mp)
    # A constant of a formula is the decimal that is written there.
    return mp.mpf(repr(value) if isinstance(value, float) and len(repr(value)) <= _WRITTEN else value)


_WRITTEN = 12  #: characters of a number that somebody wrote

#: The floats that stand for parts of pi, and for degrees a radian.
_TRANSCENDENT: dict[float, Callable[[Any], Any]] = {
    math.pi: lambda mp: +mp.pi,
    2 * math.pi: lambda mp: 2 * mp.pi,
    math.pi / 2: lambda mp: mp.pi / 2,
    -math.pi / 2: lambda mp: -mp.pi / 2,
    180.0 / math.pi: lambda mp: 180 / mp.pi,
    math.pi / 180: lambda mp: mp.pi / 180,
}


def _power(mp: Any, base: Any, exponent: Any) -> Any:
    if exponent == mp.mpf(1) / 2:
        return mp.nan if mp.re(base) < 0 else mp.sqrt(base)
    return base ** (int(exponent) if exponent == int(exponent) else exponent)
