"""Functions of a solution as a calculator in radian mode evaluates them.

They are the same functions, with other things behind the names that they use: sine, cosine and tangent take the number of
degrees for radians, and inverse functions give radians, which are written down as they come, or converted first.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import FunctionType, ModuleType, SimpleNamespace
from typing import Any

from coursework import degrees
from coursework.quantities.graph import Graph

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
    return tuple(
        graph.textbook.mapped(_Calculator(functions).function) for functions in (_AS_THEY_COME, _TAKING)
    )


class _Calculator:
    """Cache of a course's functions in radian mode."""

    def __init__(self, functions: Mapping[str, Callable[..., Any]]) -> None:
        self._functions = functions
        self._spaces: dict[int, dict[str, Any]] = {}

    def function(self, function: Any) -> Any:
        if not isinstance(function, FunctionType):
            return function
        space = self._space(function.__globals__, _package(function.__module__))
        created = FunctionType(
            function.__code__, space, function.__name__, function.__defaults__, function.__closure__
        )
        created.__kwdefaults__ = function.__kwdefaults__
        return created

    def _space(self, names: dict[str, Any], package: str) -> dict[str, Any]:
        if id(names) not in self._spaces:
            space = self._spaces[id(names)] = dict(names)
            space |= {name: self._seen(value, package) for name, value in names.items()}
        return self._spaces[id(names)]

    def _seen(self, value: Any, package: str) -> Any:
        if value is degrees:
            return SimpleNamespace(**{**vars(degrees), **self._functions})
        home = getattr(value, "__module__", None) or ""
        if home == degrees.__name__ and callable(value):
            return self._functions.get(value.__name__, value)
        is_own = isinstance(value, FunctionType) and _package(home) == package
        return self.function(value) if is_own and not isinstance(value, ModuleType) else value


def _package(home: str | None) -> str:
    return (home or "").partition(".")[0]
