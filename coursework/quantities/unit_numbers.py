"""Numbers with units that pass through a formula: addition requires equal units, sines take angles."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from coursework.quantities.sizes import (
    DEGREE,
    ONE,
    RADIAN,
    Size,
    Sizes,
    UnitFault,
    Unprovable,
    distinct,
    meanings,
    size_text,
)


class UnitValue:
    """Scalar or array, with the possible sizes of its unit."""

    __array_priority__ = 1000.0

    def __init__(self, value: Any, sizes: Sizes):
        self.value = value
        self.sizes = sizes

    def __repr__(self) -> str:
        return f"{self.value} {size_text(self.sizes[0])}"

    def __format__(self, how: str) -> str:
        return format(self.value, how)

    def _refuse(self, *_: Any) -> Any:
        raise Unprovable("it makes plain numbers of its values")

    __array__ = _refuse

    def _as_plain(self, kind: Callable[[Any], Any]) -> Any:
        """Convert a plain ratio to a number."""
        if not all(s.is_like(ONE) for s in self.sizes):
            self._refuse()
        return kind(self.value)

    def __int__(self) -> int:
        return self._as_plain(int)

    def __float__(self) -> float:
        return self._as_plain(float)

    def __complex__(self) -> complex:
        return self._as_plain(complex)

    def __index__(self) -> int:
        return self._as_plain(operator.index)

    def __bool__(self) -> bool:
        return bool(self.value)

    def __len__(self) -> int:
        return len(self.value)

    def __getitem__(self, position: Any) -> UnitValue:
        if position == () and not isinstance(self.value, np.ndarray):
            return self
        return UnitValue(np.asarray(self.value)[position], self.sizes)

    def __getattr__(self, name: str) -> Any:
        if name in ("ndim", "shape", "size", "dtype"):
            return getattr(np.asarray(self.value), name)
        if name in ("real", "imag", "T"):
            return UnitValue(getattr(np.asarray(self.value), name)[()], self.sizes)
        if name in ("sum", "min", "max", "mean", "conjugate", "copy", "ravel", "squeeze", "reshape"):
            method = getattr(np.asarray(self.value), name)
            return lambda *args, **options: UnitValue(method(*args, **options), self.sizes)
        if name == "item":
            return lambda: UnitValue(np.asarray(self.value).item(), self.sizes)
        raise AttributeError(name)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        if method == "reduce" and ufunc.__name__ in _ALIKE:
            return UnitValue(ufunc.reduce(self.value, **options), self.sizes)
        if method != "__call__" or options:
            raise Unprovable(f"units are not followed through np.{ufunc.__name__}.{method}")
        return _through(ufunc.__name__, ufunc, inputs)

    def __array_function__(self, function: Any, _types: Any, args: Any, options: Any) -> Any:
        return _array_function(function, args, options)


def _operator(name: str, function: Callable[..., Any], *, turned: bool = False) -> Any:
    def method(self: UnitValue, *others: Any) -> Any:
        if any(isinstance(o, str) for o in others):
            return NotImplemented
        return _through(name, function, (*others, self) if turned else (self, *others))

    return method


_DUNDERS: tuple[tuple[str, str, Callable[..., Any]], ...] = (
    ("add", "add", operator.add),
    ("subtract", "sub", operator.sub),
    ("multiply", "mul", operator.mul),
    ("true_divide", "truediv", operator.truediv),
    ("floor_divide", "floordiv", operator.floordiv),
    ("remainder", "mod", operator.mod),
    ("power", "pow", operator.pow),
    ("negative", "neg", operator.neg),
    ("positive", "pos", operator.pos),
    ("absolute", "abs", abs),
    ("rint", "round", round),
    ("less", "lt", operator.lt),
    ("less_equal", "le", operator.le),
    ("greater", "gt", operator.gt),
    ("greater_equal", "ge", operator.ge),
    ("equal", "eq", operator.eq),
    ("not_equal", "ne", operator.ne),
)
for _name, _dunder, _function in _DUNDERS:
    setattr(UnitValue, f"__{_dunder}__", _operator(_name, _function))
    if _dunder in ("add", "sub", "mul", "truediv", "floordiv", "mod", "pow"):
        setattr(UnitValue, f"__r{_dunder}__", _operator(_name, _function, turned=True))


def plain(value: Any) -> Any:
    """Return a value without its unit."""
    return value.value if isinstance(value, UnitValue) else value


def _sizes(value: Any) -> Sizes:
    return value.sizes if isinstance(value, UnitValue) else (ONE,)


def _is_free(value: Any) -> bool:
    """Return whether a value fits any unit: a number that is zero, infinite or NaN."""
    if isinstance(value, UnitValue):
        return False
    numbers = np.asarray(value)
    return numbers.dtype.kind in "biufc" and not np.any(np.isfinite(numbers) & (numbers != 0))


def alike(*values: Any) -> Sizes:
    """Return the sizes shared by values that are added or compared; a plain number takes those of the others.

    Raises
    ------
    UnitFault
        They share none.
    """
    carrying = [v for v in values if isinstance(v, UnitValue)]
    if not carrying:
        return (ONE,)
    first, *others = carrying
    stored = first.sizes
    for other in others:
        shared = tuple(s for s in stored if any(s.is_like(o) for o in other.sizes))
        if not shared:
            raise UnitFault(f"adds or compares {size_text(stored[0])} and {size_text(other.sizes[0])}")
        stored = _softest(shared, other.sizes)
    if any(not isinstance(v, UnitValue) and not _is_free(v) for v in values):
        sums = tuple(s for s in stored if any(s.hard) or _takes_numbers(s))
        if not sums:
            raise UnitFault(f"adds or compares {size_text(stored[0])} and a plain number")
        stored = sums
    return stored


def _softest(shared: Sizes, others: Sizes) -> Sizes:
    """Return for each shared size the candidate with the lower power of plain degrees."""
    return distinct(
        min((s, *(o for o in others if o.is_like(s))), key=lambda item: item.powers[-1]) for s in shared
    )


def _takes_numbers(ratio: Size) -> bool:
    """Return whether a number may be added to a ratio: to a plain one, an angle in degrees, a percentage."""
    return any(
        ratio.is_like(other) for other in (ONE, DEGREE, Size(0.01), Size(math.pi / 200), Size(2 * math.pi))
    )


def needs(value: Any, wanted: Size, subject: str) -> None:
    """Refuse a value that cannot have a unit; a plain number fits any."""
    if isinstance(value, UnitValue) and not any(s.is_like(wanted) for s in value.sizes):
        raise UnitFault(f"{subject} {size_text(wanted)}, and gets {size_text(value.sizes[0])}")


def product(first: Any, other: Any, power: float = 1) -> Sizes:
    """Return the sizes of ``one * other**power``; a plain number may be a conversion."""
    a = _sizes(first) if isinstance(first, UnitValue) else _of_number(first)
    b = _sizes(other) if isinstance(other, UnitValue) else _of_number(other)
    return distinct(x.times(y, power) for x in a for y in b)


def _of_number(value: Any) -> Sizes:
    numbers = np.unique(np.abs(np.asarray(value, dtype=complex)))
    return meanings(float(numbers[0]))[0] if numbers.size == 1 else (ONE,)


_KEPT = ("negative", "positive", "absolute", "fabs", "conjugate", "floor", "ceil", "rint", "trunc")
_ALIKE = ("add", "subtract", "maximum", "minimum", "fmax", "fmin", "hypot", "remainder", "fmod")
_COMPARED = ("less", "less_equal", "greater", "greater_equal", "equal", "not_equal")
_OF_A_RATIO = (
    "sin",
    "cos",
    "tan",
    "exp",
    "log",
    "log10",
    "log2",
    "sinh",
    "cosh",
    "tanh",
    "expm1",
    "log1p",
    "exp2",
)
_TO_RADIANS = ("arcsin", "arccos", "arctan")
_TOLD = ("isnan", "isfinite", "isinf", "sign", "signbit")


def _through(name: str, function: Callable[..., Any], inputs: Sequence[Any]) -> Any:
    """Return the result of an operation on numbers, with its unit."""
    values = [plain(v) for v in inputs]
    if name in _COMPARED:
        alike(*inputs)
        return function(*values)
    if name in _TOLD or (name == "multiply" and any(map(_is_free, inputs))):
        return function(*values)
    sizes = _sizes_through(name, inputs)
    return UnitValue(function(*values), sizes)


def _sizes_through(name: str, inputs: Sequence[Any]) -> Sizes:
    if name in _KEPT:
        return _sizes(inputs[0])
    if name in _ALIKE:
        return alike(*inputs)
    if name == "multiply":
        return product(inputs[0], inputs[1])
    if name in ("true_divide", "divide"):
        return product(inputs[0], inputs[1], -1)
    if name in ("power", "float_power"):
        return powered(*inputs)
    if name == "floor_divide":
        return alike(*inputs) and (ONE,)
    if name in ("square", "sqrt", "cbrt", "reciprocal"):
        return powered(inputs[0], {"square": 2, "sqrt": 0.5, "cbrt": 1 / 3, "reciprocal": -1}[name])
    if name in _OF_A_RATIO:
        needs(inputs[0], RADIAN if name in ("sin", "cos", "tan") else ONE, f"{name} takes")
        return (ONE,)
    if name in _TO_RADIANS:
        needs(inputs[0], ONE, f"{name} takes")
        return (RADIAN,)
    if name == "arctan2":
        alike(*inputs)
        return (RADIAN,)
    if name in ("deg2rad", "radians"):
        return product(inputs[0], math.pi / 180)
    if name in ("rad2deg", "degrees"):
        return product(inputs[0], 180 / math.pi)
    raise Unprovable(f"units are not followed through np.{name}")


def powered(base: Any, exponent: Any) -> Sizes:
    if isinstance(exponent, UnitValue):
        needs(exponent, ONE, "an exponent is")
        exponent = exponent.value
    exponents = np.unique(np.asarray(exponent, dtype=float))
    if exponents.size == 1:
        return distinct(ONE.times(s, float(exponents[0])) for s in _sizes(base))
    needs(base, ONE, "what is raised to several powers is")
    return (ONE,)


# ------------------------------------------------------------------ functions of numpy

_KEPT_BY = (
    "where",
    "select",
    "stack",
    "concatenate",
    "hstack",
    "vstack",
    "column_stack",
    "broadcast_to",
    "sum",
    "mean",
    "median",
    "amin",
    "amax",
    "min",
    "max",
    "nanmin",
    "nanmax",
    "real",
    "imag",
    "norm",
    "clip",
    "round",
    "around",
    "squeeze",
    "reshape",
    "ravel",
    "nan_to_num",
    "diff",
    "cumsum",
    "full_like",
    "atleast_1d",
    "sort",
    "flip",
    "roll",
    "expand_dims",
    "transpose",
    "array",
    "linspace",
    "interp",
    "ptp",
    "copy",
    "moveaxis",
    "take",
    "real_if_close",
)
_PRODUCTS = ("cross", "dot", "vdot", "inner", "outer", "matmul", "kron")
_PLAIN_OF = (
    "ndim",
    "shape",
    "size",
    "ones_like",
    "zeros_like",
    "isclose",
    "allclose",
    "array_equal",
    "argmax",
    "argmin",
    "iscomplexobj",
)


def _array_function(function: Any, args: Sequence[Any], options: Mapping[str, Any]) -> Any:
    name = function.__name__
    values, named = stripped(args), stripped(options)
    if name in _PLAIN_OF:
        return function(*values, **named)
    if name == "broadcast_arrays":
        result = function(*values, **named)
        return [
            UnitValue(v, a.sizes) if isinstance(a, UnitValue) else v
            for v, a in zip(result, args, strict=True)
        ]
    if name == "angle":
        return UnitValue(function(*values, **named), (RADIAN,))
    if name in _PRODUCTS:
        return UnitValue(function(*values, **named), product(args[0], args[1]))
    if name in _KEPT_BY:
        summed = args[1:] if name in ("where", "select") else args[:1] if name == "norm" else args
        return UnitValue(function(*values, **named), alike(*leaves(summed)))
    raise Unprovable(f"units are not followed through np.{name}")


def stripped(value: Any) -> Any:
    """Return the value with plain numbers, in lists and records too."""
    if isinstance(value, UnitValue):
        return value.value
    if isinstance(value, Mapping):
        return {k: stripped(v) for k, v in value.items()}
    if type(value) in (tuple, list):
        return type(value)(stripped(v) for v in value)
    return value


def leaves(value: Any) -> list[Any]:
    """Return the numbers of nested lists."""
    if type(value) in (tuple, list):
        return [leaf for item in value for leaf in leaves(item)]
    if isinstance(value, np.ndarray) and value.dtype == object:
        return leaves(value.ravel().tolist())
    return [value] if isinstance(value, (UnitValue, float, complex, np.ndarray)) else []


def gathered(value: Any) -> Any:
    """Return a list, or an array of objects, as one array with the common unit of its numbers."""
    if type(value) not in (tuple, list) and not (isinstance(value, np.ndarray) and value.dtype == object):
        return value
    result = leaves(value)
    if not any(isinstance(v, UnitValue) for v in result):
        return value
    inside = value.tolist() if isinstance(value, np.ndarray) else value
    return UnitValue(np.array(stripped(inside)), alike(*result))
