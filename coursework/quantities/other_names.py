"""Functions of a course with other values behind the names that they use: on another calculator, for numbers
with units."""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any

PLAIN = "__plain__"  #: name under which a name space holds the one that it replaces


class OtherNames:
    """Makes functions again, in name spaces of their own; a subclass says what stands behind a name."""

    def __init__(self) -> None:
        self._spaces: dict[int, dict[str, Any]] = {}
        self._functions: dict[FunctionType, Callable[..., Any]] = {}

    def __call__(self, function: Any) -> Callable[..., Any]:
        """Return a function with other values behind its names."""
        if not isinstance(function, FunctionType):
            return self.foreign(function)
        if function not in self._functions:
            created = FunctionType(
                function.__code__,
                self._space(function),
                function.__name__,
                function.__defaults__,
                function.__closure__,
            )
            created.__kwdefaults__ = function.__kwdefaults__
            self._functions[function] = created
        return self._functions[function]

    def foreign(self, value: Any) -> Any:
        """Return what stands for something that is not a function in Python."""
        return value

    def value(self, name: str, value: Any, package: str) -> Any:
        """Return what stands behind a name of a module of a package in place of its value."""
        raise NotImplementedError

    def _space(self, function: FunctionType) -> dict[str, Any]:
        names, package = function.__globals__, package_of(function)
        if id(names) not in self._spaces:
            # The names are held, so that no identity is used twice.
            space = self._spaces[id(names)] = {**names, PLAIN: names}
            space |= {name: self.value(name, value, package) for name, value in names.items()}
        return self._spaces[id(names)]


def package_of(value: Any) -> str:
    """Return the package in which a function or a class is defined; empty for anything else."""
    return (getattr(value, "__module__", None) or "").partition(".")[0]
