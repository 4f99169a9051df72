"""Functions of a solution as a calculator in radian mode evaluates them.

They are the same functions, with other things behind the names that they use: sine, cosine and tangent take
the number of degrees for radians, and inverse functions give radians, which are written down as they come, or
converted first.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import FunctionType, SimpleNamespace
from typing import Any

from coursework import degrees
from coursework.quantities.graph import Graph
from coursework.quantities.other_names import OtherNames, package_of

_RADIAN = 57.29577951308232  #: degrees


def _taking(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that takes its last argument, an angle, as radians."""
    return lambda *values: function(*values[:-1], values[-1] * _RADIAN)


def _giving(function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *values: function(*values) / _RADIAN


_TAKING: Mapping[str, Callable[..., Any]] = {
    name: _taking(getattr(degrees, name)) for name in ("sin", "cos", "tan", "polar")
}
_AS_THEY_COME: Mapping[str, Callable[..., Any]] = {
    **_TAKING,
    **{name: _giving(getattr(degrees, name)) for name in ("asin", "acos", "atan", "atan2", "angle")},
    "from_radians": lambda theta: theta,
}


def in_radians(graph: Graph) -> tuple[Graph, ...]:
    """Return the textbook graph on a calculator in radian mode: with resulting angles written as shown, and
    with them converted to degrees."""
    return tuple(graph.textbook.mapped(_Calculator(functions)) for functions in (_AS_THEY_COME, _TAKING))


class _Calculator(OtherNames):
    """Functions of a course in radian mode."""

    def __init__(self, functions: Mapping[str, Callable[..., Any]]) -> None:
        super().__init__()
        self._of_degrees = functions

    def value(self, name: str, value: Any, package: str) -> Any:
        if value is degrees:
            return SimpleNamespace(**{**vars(degrees), **self._of_degrees})
        if getattr(value, "__module__", None) == degrees.__name__ and callable(value):
            return self._of_degrees.get(value.__name__, value)
        return self(value) if isinstance(value, FunctionType) and package_of(value) == package else value
