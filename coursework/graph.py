"""The quantity graph: plain functions whose names are quantities and whose parameters are what they need.

A request for some quantities is resolved into exactly the functions it needs, in order, and each is
called once, on scalars or on arrays that broadcast. A parameter with a default is an *optional
effect*: it is absent (the default holds) unless its value is given or the request calls for it.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from coursework.errors import (
    BrokenFunction,
    CourseworkError,
    Cycle,
    MissingQuantity,
    Undefined,
    nearest,
    unknown,
)

Value = Any  #: a float, a complex number, a text, or an array of them


def _place(function: Callable[..., Value]) -> str:
    """Where a function of a course stands, for messages."""
    code = getattr(function, "__code__", None)
    name = getattr(function, "__name__", "a function")
    return f"{name} ({Path(code.co_filename).name}, line {code.co_firstlineno})" if code else name


def plain_scalar(value: Value) -> Value:
    """A numpy scalar as Python's own; vectors are left alone."""
    zero_dimensional = isinstance(value, np.generic) or (isinstance(value, np.ndarray) and not value.ndim)
    return value.item() if zero_dimensional else value


def _right(name: str) -> str:
    """The name under which a replaced quantity keeps its right value."""
    return f"{name} (right)"


@dataclass(frozen=True)
class Node:
    """One quantity: the function that gives it and the names of its arguments, in call order."""

    function: Callable[..., Value]
    arguments: tuple[str, ...]
    defaults: Mapping[str, Value]

    @staticmethod
    def of(function: Callable[..., Value]) -> Node:
        parameters = inspect.signature(function).parameters
        defaults = {p.name: p.default for p in parameters.values() if p.default is not p.empty}
        return Node(function, tuple(parameters), defaults)


@dataclass(frozen=True)
class Replacement:
    """Some quantities computed by another function: what a named mistake is.

    ``function`` gives the value of ``targets[0]``, or a tuple of values when there are several. A
    parameter of its that bears a target's name stands for the right value of that target.
    """

    targets: tuple[str, ...]
    function: Callable[..., Value]


class Graph:
    """Quantities by name. Immutable; plans are remembered for each shape of request."""

    def __init__(self, functions: Mapping[str, Callable[..., Value]]):
        self._build({name: Node.of(f) for name, f in functions.items()}, frozenset())

    def _build(
        self, nodes: Mapping[str, Node], shadowed: frozenset[str], effects: tuple[str, ...] | None = None
    ) -> None:
        optional = {p for node in nodes.values() for p in node.defaults}
        self._effects = tuple(n for n in nodes if n in optional) if effects is None else effects
        self._nodes = dict(nodes)
        self._shadowed = shadowed
        self._plans: dict[object, tuple[tuple[str, ...], list, dict]] = {}
        leaves = {a for node in nodes.values() for a in node.arguments} - set(nodes)
        self._leaves = frozenset(leaves)
        self._known = frozenset(nodes) | leaves

    @property
    def quantities(self) -> tuple[str, ...]:
        """The names that have a function, in the order they were defined."""
        return tuple(self._nodes)

    @property
    def leaves(self) -> frozenset[str]:
        """The names that functions need and no function gives."""
        return self._leaves

    def node(self, name: str) -> Node:
        if name not in self._nodes:
            raise unknown("quantity", name, self._nodes)
        return self._nodes[name]

    def effects(self) -> tuple[str, ...]:
        """The quantities that a request may call for as optional effects."""
        return self._effects

    def plan(
        self, wanted: Sequence[str], given: Iterable[str] = (), effects: Iterable[str] = ()
    ) -> tuple[str, ...]:
        """The quantities that a request evaluates, in order.

        Raises
        ------
        UnknownName
            A wanted quantity or an effect that the graph does not have.
        MissingQuantity
            A needed quantity that is neither given nor computed.
        Cycle
            Quantities that need each other.
        """
        return self._plan(tuple(wanted), frozenset(given), frozenset(effects))[0]

    def _plan(self, wanted: tuple[str, ...], given: frozenset[str], effects: frozenset[str]):
        key = (wanted, given, effects)
        if key not in self._plans:
            self._plans[key] = self._resolve(wanted, given, effects)
        return self._plans[key]

    def _resolve(self, wanted: tuple[str, ...], given: frozenset[str], effects: frozenset[str]):
        for effect in effects:
            if effect not in self._effects:
                raise unknown("effect", effect, self._effects)
        effects = effects | {_right(effect) for effect in effects}
        order: dict[str, tuple[Callable, tuple[str, ...]]] = {}
        constants: dict[str, Value] = {}
        path: list[str] = []

        def visit(name: str) -> None:
            if name in given or name in order:
                return
            if name not in self._nodes:
                wanting = f"{path[-1]} needs {name}, which is" if path else f"{name} is"
                raise MissingQuantity(f"{wanting} not given; add {name}=… to the request")
            if name in path:
                loop = " -> ".join([*path[path.index(name) :], name])
                raise Cycle(f"quantities need each other: {loop}; give one of them a value")
            path.append(name)
            node = self._nodes[name]
            arguments = []
            for argument in node.arguments:
                if argument in node.defaults and argument not in given and argument not in effects:
                    constant = f"{name}.{argument}"
                    constants[constant] = node.defaults[argument]
                    arguments.append(constant)
                else:
                    visit(argument)
                    arguments.append(argument)
            path.pop()
            order[name] = (node.function, tuple(arguments))

        for name in wanted:
            if name not in self._nodes and name not in given and name not in self._leaves:
                raise unknown("quantity", name, self._nodes)
            visit(name)
        steps = [(name, function, arguments) for name, (function, arguments) in order.items()]
        return tuple(order), steps, constants

    def evaluate(
        self, wanted: Sequence[str], given: Mapping[str, Value], effects: Iterable[str] = ()
    ) -> dict[str, Value]:
        """The wanted quantities, from the given ones.

        A given quantity is used as it is, whether or not a function could compute it. Values are
        scalars or arrays that broadcast; nothing is copied or checked but names.

        Raises
        ------
        UnknownName, MissingQuantity, Cycle
            As :meth:`plan`, and for a given name that nothing uses.
        Undefined
            A function divides by zero or leaves its domain on scalars.
        """
        values = self._values(tuple(wanted), given, effects)
        return {name: values[name] for name in wanted}

    def evaluate_all(
        self, wanted: Sequence[str], given: Mapping[str, Value], effects: Iterable[str] = ()
    ) -> dict[str, Value]:
        """As :meth:`evaluate`, with every quantity met on the way, in the order of the plan."""
        wanted = tuple(wanted)
        values = self._values(wanted, given, effects)
        return {name: values[name] for name in self.plan(wanted, self._renamed(given), effects)}

    def _renamed(self, given: Mapping[str, Value]) -> Mapping[str, Value]:
        if not self._shadowed:
            return given
        return {_right(k) if k in self._shadowed else k: v for k, v in given.items()}

    def _values(
        self, wanted: tuple[str, ...], given: Mapping[str, Value], effects: Iterable[str]
    ) -> dict[str, Value]:
        given = self._renamed(given)
        names = frozenset(given)
        if not names <= self._known:
            odd = min(names - self._known)
            raise unknown("quantity", odd, self._known)
        _, steps, constants = self._plan(wanted, names, frozenset(effects))
        values = {**given, **constants}
        with np.errstate(all="ignore"):
            for name, function, arguments in steps:
                try:
                    values[name] = function(*[values[a] for a in arguments])
                except CourseworkError:
                    raise
                except (ArithmeticError, ValueError) as fault:
                    told = ", ".join(f"{a} = {values[a]}" for a in arguments)[:300]
                    raise Undefined(f"{name} does not exist for {told} ({fault})") from fault
                except Exception as fault:
                    raise BrokenFunction(
                        f"{_place(function)} fails: {type(fault).__name__}: {fault}"
                    ) from fault
        return values

    def replacing(self, replacement: Replacement) -> Graph:
        """The same graph with some quantities computed by another function.

        Raises
        ------
        UnknownName
            A target that the graph neither computes nor needs.
        """
        targets = replacement.targets
        for target in targets:
            if target not in self._known:
                raise unknown("quantity", target, self._known)
        nodes = dict(self._nodes)
        # The right value of a target is that of the right graph, all the way up.
        touched = self.descendants(targets)
        for name in touched & self._nodes.keys():
            node = self._nodes[name]
            arguments = tuple(_right(a) if a in touched else a for a in node.arguments)
            defaults = {_right(a) if a in touched else a: v for a, v in node.defaults.items()}
            nodes[_right(name)] = Node(node.function, arguments, defaults)
        wrong = Node.of(replacement.function)
        arguments = tuple(_right(a) if a in targets else a for a in wrong.arguments)
        wrong = Node(wrong.function, arguments, wrong.defaults)
        if len(targets) == 1:
            nodes[targets[0]] = wrong
        else:
            together = " and ".join(targets) + " (wrong)"
            nodes[together] = wrong
            for index, target in enumerate(targets):
                nodes[target] = Node(lambda values, i=index: values[i], (together,), {})
        graph = Graph.__new__(Graph)
        graph._build(nodes, frozenset(t for t in targets if t not in self._nodes), self._effects)
        return graph

    def descendants(self, names: Iterable[str]) -> frozenset[str]:
        """The names themselves and every quantity that depends on one of them."""
        found = set(names)
        grown = True
        while grown:
            more = {n for n, node in self._nodes.items() if found.intersection(node.arguments)} - found
            found |= more
            grown = bool(more)
        return frozenset(found)

    def with_functions(self, functions: Mapping[str, Callable[..., Value]]) -> Graph:
        """The same graph with more quantities.

        Raises
        ------
        ValueError
            A name that the graph has already.
        """
        twice = set(functions) & set(self._nodes)
        if twice:
            raise ValueError(f"the graph has {min(twice)!r} already{nearest(min(twice), self._nodes)}")
        graph = Graph.__new__(Graph)
        nodes = {**self._nodes, **{name: Node.of(f) for name, f in functions.items()}}
        graph._build(nodes, self._shadowed)
        return graph
