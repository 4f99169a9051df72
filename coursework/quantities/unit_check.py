"""Functions of a solution, adapted to numbers with units.

They are the same functions, with other things behind the names that they use: functions of degrees that say
what they take and give, numpy and math that follow units, and everything else looked at from without.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any

import numpy as np

from coursework import degrees
from coursework.errors import CourseworkError
from coursework.quantities.other_names import OtherNames, package_of
from coursework.quantities.sizes import DEGREE, ONE, Sizes, Unprovable
from coursework.quantities.unit_check_by_scaling import opaque
from coursework.quantities.unit_numbers import UnitValue, alike, gathered, leaves, needs, plain, powered

_NUMBERS = (int, float, complex, np.number)


def _takes_degrees(function: Callable[..., Any], gives: Sizes) -> Callable[..., Any]:
    def of_angle(theta: Any) -> Any:
        if not isinstance(theta, UnitValue):
            return function(theta)
        needs(theta, DEGREE, f"{function.__name__} takes")
        return UnitValue(function(theta.value), gives)

    return of_angle


def _gives_degrees(function: Callable[..., Any], takes: Any = None) -> Callable[..., Any]:
    """Return a function that gives an angle in degrees, of a ratio, a vector, or two coordinates of one
    unit."""

    def to_angle(*values: Any) -> Any:
        if takes is None:
            alike(*values)
        else:
            needs(values[0], takes, f"{function.__name__} takes")
        return UnitValue(function(*map(plain, values)), (DEGREE,))

    return to_angle


def _polar(length: Any, theta: Any) -> Any:
    needs(theta, DEGREE, "polar takes")
    return length * degrees.polar(1.0, plain(theta))


_OF_DEGREES: Mapping[str, Callable[..., Any]] = {
    **{n: _takes_degrees(getattr(degrees, n), (ONE,)) for n in ("sin", "cos", "tan")},
    "wrap": _takes_degrees(degrees.wrap, (DEGREE,)),
    **{n: _gives_degrees(getattr(degrees, n), ONE) for n in ("asin", "acos", "atan")},
    "from_radians": lambda theta: theta * (180 / math.pi),
    "atan2": _gives_degrees(degrees.atan2),
    "angle": _gives_degrees(degrees.angle),
    "polar": _polar,
    "sqrt": lambda x: _root(x),
}


def _root(x: Any) -> Any:
    return UnitValue(degrees.sqrt(x.value), powered(x, 0.5)) if isinstance(x, UnitValue) else degrees.sqrt(x)


class _Numpy:
    """Replacement of numpy whose arrays may hold numbers with units."""

    def __getattr__(self, name: str) -> Any:
        return _wrapped if name in ("array", "asarray", "asanyarray") else getattr(np, name)


def _wrapped(values: Any, *args: Any, **options: Any) -> Any:
    result = gathered(values)
    return result if isinstance(result, UnitValue) else np.array(values, *args, **options)


class _Math:
    """Replacement of math or cmath; numpy's functions for numbers with units."""

    def __init__(self, module: ModuleType):
        self._module = module

    def __getattr__(self, name: str) -> Any:
        result = getattr(self._module, name)
        return _following(result) if callable(result) else result


_SPELLED = {
    "asin": "arcsin",
    "acos": "arccos",
    "atan": "arctan",
    "atan2": "arctan2",
    "pow": "power",
    "phase": "angle",
    "dist": "",
    "prod": "",
    "isclose": "isclose",
}


def _following(function: Callable[..., Any]) -> Callable[..., Any]:
    name = function.__name__
    other = getattr(np, _SPELLED.get(name, name), None)

    def call(*values: Any, **options: Any) -> Any:
        if not any(isinstance(v, UnitValue) for v in leaves(list(values))):
            return function(*values, **options)
        if other is None:
            raise Unprovable(f"units are not followed through {function.__module__}.{name}")
        return other(*values, **options)

    return call


#: Modules whose functions only pass values to the functions and operators that they are called with.
_PASSING_ON = ("builtins", "functools", "_functools", "itertools", "operator", "_operator")


class Lens(OtherNames):
    """Functions of a course for numbers with units. ``constants``: the sizes of constants of its modules, by
    name."""

    def __init__(self, constants: Mapping[str, Sizes]):
        super().__init__()
        self._constants = constants

    def foreign(self, value: Any) -> Any:
        return opaque(value)

    def value(self, name: str, value: Any, package: str) -> Any:
        if name.startswith("__"):
            return value
        if isinstance(value, ModuleType):
            return self._module(value)
        if isinstance(value, _NUMBERS) and name in self._constants:
            return UnitValue(value, self._constants[name])
        home = getattr(value, "__module__", None) or ""
        if isinstance(value, type):
            is_foreign = home.startswith("coursework.") and not issubclass(
                value, (CourseworkError, Exception)
            )
            return opaque(value) if is_foreign else value
        if not callable(value):
            return value
        if home == "coursework.degrees":
            return _OF_DEGREES.get(value.__name__, value)
        if home in ("math", "cmath"):
            return _following(value)
        if home.startswith("numpy") or isinstance(value, np.ufunc):
            return getattr(_Numpy(), value.__name__, value)
        if isinstance(value, FunctionType) and package_of(value) == package:
            return self(value)
        return value if home in _PASSING_ON else opaque(value)

    @staticmethod
    def _module(module: ModuleType) -> Any:
        if module is np:
            return _Numpy()
        if module is degrees:
            return SimpleNamespace(**{**vars(degrees), **_OF_DEGREES})
        if module.__name__ in _PASSING_ON:
            return module
        return _Math(module) if module in (math, cmath) else opaque(module)
