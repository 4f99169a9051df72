"""Quantity graph: functions named after quantities, with the quantities that they need as parameters.

A request for some quantities is resolved into exactly the functions it needs, in order, and each is
called once, on scalars or on arrays that broadcast; long arrays go through the whole request piece
by piece. A parameter with a default is an *optional effect*: it is absent (the default holds) unless its
value is given or the request calls for it.

A function may carry a second, *stable* one (:func:`coursework.solution.stable`): the same quantity, by a way
that keeps its digits everywhere but passes over quantities that the first one needs. It is taken unless
one of those is given or mistaken, so that what a request gives always counts.

A name that begins with an underscore is hidden: a function may need it, a request cannot name it.
"""

from __future__ import annotations

import inspect
import re
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, TypeAlias

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
from coursework.messages import Message
from coursework.system.blocks import joined, pieces

Value = Any  #: a float, a complex number, a text, or an array of them
_Step: TypeAlias = tuple[str, Callable[..., Value], tuple[str, ...]]  #: name, function, arguments
_Plan: TypeAlias = tuple[tuple[str, ...], list[_Step], dict[str, Value]]  #: names, steps, constants


def _location(function: Callable[..., Value]) -> str:
    """Return the location of a course function, for messages."""
    code = getattr(function, "__code__", None)
    name = getattr(function, "__name__", "a function")
    return f"{name} ({Path(code.co_filename).name}, line {code.co_firstlineno})" if code else name


def plain_scalar(value: Value) -> Value:
    """Convert a numpy scalar to Python's own type; leave vectors unchanged."""
    zero_dimensional = isinstance(value, np.generic) or (isinstance(value, np.ndarray) and not value.ndim)
    return value.item() if zero_dimensional else value


def _right(name: str) -> str:
    """Return the name under which the right value of a replaced quantity is stored."""
    return f"{name} (right)"


@dataclass(frozen=True)
class QuantityNode:
    """Quantity: its function and the names of its arguments, in call order."""

    function: Callable[..., Value]
    arguments: tuple[str, ...]
    defaults: Mapping[str, Value]
    stable: QuantityNode | None = None  #: the same quantity by a way that keeps its digits everywhere

    @staticmethod
    def of(function: Callable[..., Value]) -> QuantityNode:
        parameters = inspect.signature(function).parameters
        defaults = {p.name: p.default for p in parameters.values() if p.default is not p.empty}
        stable = getattr(function, "__stable__", None)
        return QuantityNode(
            function, tuple(parameters), defaults, None if stable is None else QuantityNode.of(stable)
        )

    @property
    def printed(self) -> tuple[str, ...]:
        """Names in the stated formula, which may differ from the arguments of the function."""
        return tuple(re.findall(r"<(\w+)>", getattr(self.function, "__formula__", "")))

    @property
    def explained_after(self) -> tuple[str, ...]:
        """Names that a worked solution prints before it in addition."""
        return getattr(self.function, "__explained_after__", ())

    @property
    def needs(self) -> frozenset[str]:
        """Names of the arguments of either function."""
        return frozenset(self.arguments) | (self.stable.needs if self.stable else frozenset())

    def renamed(self, names: Mapping[str, str]) -> QuantityNode:
        """Return the node with renamed arguments."""
        return QuantityNode(
            self.function,
            tuple(names.get(a, a) for a in self.arguments),
            {names.get(a, a): v for a, v in self.defaults.items()},
            self.stable and self.stable.renamed(names),
        )


@dataclass(frozen=True)
class Replacement:
    """Quantities computed by another function: a named mistake.

    ``function`` gives the value of ``targets[0]``, or a tuple of values when there are several. A
    parameter of its that bears a target's name stands for the right value of that target.
    """

    targets: tuple[str, ...]
    function: Callable[..., Value]


def _is_hidden(name: str) -> bool:
    return name.startswith("_")


def _run(steps: Sequence[tuple], values: dict[str, Value]) -> None:
    """Call the functions of a plan in order, and store their results in ``values``."""
    for name, function, arguments in steps:
        try:
            values[name] = function(*[values[a] for a in arguments])
        except CourseworkError:
            raise
        except Exception as fault:
            if advice := next((advice for sign, advice in _FOR_ARRAYS.items() if sign in str(fault)), None):
                raise BrokenFunction(_at_its_line(function, fault, *advice)) from fault
            if not isinstance(fault, ArithmeticError | ValueError):
                raise BrokenFunction(
                    f"{_location(function)} fails: {type(fault).__name__}: {fault}"
                ) from fault
            text = ", ".join(f"{a} = {values[a]}" for a in arguments)[:300]
            raise Undefined(
                "{name} does not exist for {text} ({fault})", name=name, text=text, fault=fault
            ) from fault


#: Signs, in numpy's messages, that a function is written for one number, and for each the fault and what
#: would do.
_FOR_ARRAYS = {
    "truth value of an array": (
        "branches on an array",
        "use np.where(condition, value where it holds, value elsewhere), and & | ~ for and, or, not",
    ),
    "to Python scalars": (
        "makes one number of an array",
        "use the functions of coursework.degrees or of numpy, not those of math, float() or int()",
    ),
}


def _at_its_line(function: Callable[..., Value], fault: Exception, problem: str, advice: str) -> str:
    """Return the message for a function that is written for one number, with the line that fails on an
    array."""
    code = getattr(function, "__code__", None)
    frames = traceback.extract_tb(fault.__traceback__)
    home = Path(code.co_filename).parent if code else Path()
    line = next((f for f in reversed(frames) if Path(f.filename).parent == home), frames[-1])
    return (
        f"{_location(function)} {problem}, at line {line.lineno} of {Path(line.filename).name}: "
        f"{line.line}; {advice}"
    )


def _missing(results: Mapping[str, str]) -> MissingQuantity:
    """Return the error for missing quantities, each with the first one that needs it."""
    names = tuple(results)
    listed: str = names[0]
    if names[1:]:
        listed = Message("{first} and {second}", first=", ".join(names[:-1]), second=names[-1])
    needing = set(results.values())
    subject = needing.pop() if len(needing) == 1 else Message("the request")
    message = {
        (True, True): Message(
            "{subject} needs {listed}, which are not given", subject=subject, listed=listed
        ),
        (True, False): Message(
            "{subject} needs {listed}, which is not given", subject=subject, listed=listed
        ),
        (False, True): Message("{listed} are not given", listed=listed),
        (False, False): Message("{listed} is not given", listed=listed),
    }
    return MissingQuantity(message[bool(subject), len(names) > 1], names)


def _met(nodes: Mapping[str, QuantityNode], names: Iterable[str]) -> frozenset[str]:
    """Return the names and all their ancestors, by the first of each node's functions."""
    results: set[str] = set()
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        if name not in results:
            results.add(name)
            waiting.extend(nodes[name].arguments if name in nodes else ())
    return frozenset(results)


class Graph:
    """Immutable graph of quantities by name, with cached plans."""

    def __init__(self, functions: Mapping[str, Callable[..., Value]]):
        self._build({name: QuantityNode.of(f) for name, f in functions.items()}, frozenset())

    def _build(
        self,
        nodes: Mapping[str, QuantityNode],
        shadowed: frozenset[str],
        effects: tuple[str, ...] | None = None,
    ) -> None:
        optional = {p for node in nodes.values() for p in node.defaults}
        self._effects = tuple(n for n in nodes if n in optional) if effects is None else effects
        self._nodes = dict(nodes)
        self._shadowed = shadowed
        self._set_aside: frozenset[str] = frozenset()
        self._plans: dict[object, _Plan] = {}
        leaves = {a for node in nodes.values() for a in node.needs} - set(nodes)
        self._leaves = frozenset(leaves)
        self._all_names = frozenset(n for n in nodes if not _is_hidden(n)) | leaves
        self._passed_over = {
            name: self._ancestors(node.arguments) - self._ancestors(node.stable.arguments)
            for name, node in nodes.items()
            if node.stable is not None
        }

    def _ancestors(self, names: Iterable[str]) -> frozenset[str]:
        """Return the names and all their ancestors, by the first of each node's functions."""
        return _met(self._nodes, names)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names with a function, in order of definition, without hidden ones."""
        return tuple(n for n in self._nodes if not _is_hidden(n))

    @cached_property
    def textbook(self) -> Graph:
        """The same graph, with every quantity by the first of its functions."""
        graph = Graph.__new__(Graph)
        nodes = {name: replace(node, stable=None) for name, node in self._nodes.items()}
        graph._build(nodes, self._shadowed, self._effects)
        return graph

    @cached_property
    def _on_paper(self) -> Graph:
        """Textbook graph with the names of each stated formula and of earlier steps as further arguments, for
        planning alone.

        Not what would itself need the quantity: that one is found first.
        """
        graph = Graph.__new__(Graph)
        nodes = dict(self.textbook._nodes)
        for name, node in nodes.items():
            for before in (*node.printed, *node.explained_after):
                if before in nodes and name not in _met(nodes, (before,)):
                    nodes[name] = replace(nodes[name], arguments=(*nodes[name].arguments, before))
        graph._build(nodes, self._shadowed, self._effects)
        return graph

    @property
    def leaves(self) -> frozenset[str]:
        """Names that functions need and no function gives."""
        return self._leaves

    @property
    def names(self) -> frozenset[str]:
        """Names with a function, hidden ones included."""
        return frozenset(self._nodes)

    def ancestors(self, names: Iterable[str]) -> frozenset[str]:
        """Return the names and all their ancestors, optional effects included, by the first of each node's
        functions."""
        return self._ancestors(names)

    def node(self, name: str) -> QuantityNode:
        if name not in self._nodes:
            raise unknown("quantity", name, self._nodes)
        return self._nodes[name]

    def effects(self) -> tuple[str, ...]:
        """Return the quantities that a request may name as optional effects."""
        return self._effects

    def plan(
        self, wanted: Sequence[str], given: Iterable[str] = (), effects: Iterable[str] = ()
    ) -> tuple[str, ...]:
        """Return the quantities that a request evaluates, in order.

        Raises
        ------
        UnknownName
            A wanted quantity or an effect that the graph does not have.
        MissingQuantity
            A needed quantity that is neither given nor computed.
        Cycle
            Quantities that need each other.
        """
        self._refuse_hidden(wanted)
        return self._plan(tuple(wanted), frozenset(given), frozenset(effects))[0]

    def _refuse_hidden(self, wanted: Iterable[str]) -> None:
        for name in wanted:
            if _is_hidden(name):
                raise unknown("quantity", name, self.quantities)

    def _plan(
        self,
        wanted: tuple[str, ...],
        given: frozenset[str],
        effects: frozenset[str],
        result: frozenset[str] = frozenset(),
    ) -> _Plan:
        key = (wanted, given, effects, result)
        if key not in self._plans:
            self._plans[key] = self._resolve(wanted, given, effects, result)
        return self._plans[key]

    def _resolve(
        self, wanted: tuple[str, ...], given: frozenset[str], effects: frozenset[str], result: frozenset[str]
    ) -> _Plan:
        for effect in effects:
            if effect not in self._effects:
                raise unknown("effect", effect, self._effects)
        effects = effects | {_right(effect) for effect in effects}
        order: dict[str, tuple[Callable, tuple[str, ...]]] = {}
        constants: dict[str, Value] = {}
        path: list[str] = []
        missing: dict[str, str] = {}  # and what needs each first

        def visit(name: str) -> None:
            if name in given or name in order or name in result:
                return
            if name not in self._nodes:
                missing.setdefault(name, next((p for p in reversed(path) if not _is_hidden(p)), ""))
                return
            if name in path:
                loop = " -> ".join([*path[path.index(name) :], name])
                raise Cycle("quantities need each other: {loop}; give one of them a value", loop=loop)
            path.append(name)
            node = self._nodes[name]
            if node.stable is not None and not self._passed_over[name] & given:
                node = node.stable
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
            if name not in self._nodes and name not in self._all_names and name not in given:
                raise unknown("quantity", name, self.quantities)
            visit(name)
        if missing:
            raise _missing(missing)
        steps = [(name, function, arguments) for name, (function, arguments) in order.items()]
        return tuple(order), steps, constants

    def evaluate(
        self,
        wanted: Sequence[str],
        given: Mapping[str, Value],
        effects: Iterable[str] = (),
        results: Mapping[str, Value] | None = None,
    ) -> dict[str, Value]:
        """Compute the requested quantities from the given ones.

        A given quantity is used as it is, whether or not a function could compute it. Values are
        scalars or arrays that broadcast; nothing is copied or checked but names. A function must give at
        each place of an array what it would give for the values there alone.

        ``results`` holds what :meth:`everything` gave for the same given values and effects, from this graph
        or from the one that it was made of by :meth:`replacing` or :meth:`with_functions`: what still holds
        of it is not computed again.

        Raises
        ------
        UnknownName, MissingQuantity, Cycle
            As :meth:`plan`, and for a given name that nothing uses.
        Undefined
            A function divides by zero or leaves its domain on scalars.
        """
        self._refuse_hidden(wanted)
        values = self._values(tuple(wanted), given, effects, results or {})
        return {name: values[name] for name in wanted}

    def everything(
        self,
        wanted: Sequence[str],
        given: Mapping[str, Value],
        effects: Iterable[str] = (),
        found: Mapping[str, Value] | None = None,
    ) -> dict[str, Value]:
        """Compute the requested quantities and return all intermediate ones as well, hidden ones included.

        Long arrays are processed in blocks; then only the requested quantities are returned.
        """
        values = self._values(tuple(wanted), given, effects, found or {})
        return {name: value for name, value in values.items() if name in self._nodes}

    def walk(
        self, wanted: Sequence[str], given: Mapping[str, Value], effects: Iterable[str] = ()
    ) -> tuple[str, ...]:
        """Return the quantities on the textbook way to the requested ones, in order.

        Names in a stated formula, or printed before it, come before it.
        """
        met = self._on_paper.plan(tuple(wanted), self._renamed(given), effects)
        return tuple(name for name in met if not _is_hidden(name))

    def _renamed(self, given: Mapping[str, Value]) -> Mapping[str, Value]:
        if not self._shadowed:
            return given
        return {_right(k) if k in self._shadowed else k: v for k, v in given.items()}

    def _values(
        self,
        wanted: tuple[str, ...],
        given: Mapping[str, Value],
        effects: Iterable[str],
        results: Mapping[str, Value],
    ) -> dict[str, Value]:
        given = self._renamed(given)
        names = frozenset(given)
        if not names <= self._all_names:
            odd = min(names - self._all_names)
            raise unknown("quantity", odd, self._all_names)
        long = pieces(given)
        # What was found of long arrays is whole, and would not fit their pieces.
        results = {} if long else {_right(n) if n in self._set_aside else n: v for n, v in results.items()}
        _, steps, constants = self._plan(wanted, names, frozenset(effects), frozenset(results))
        values = {**results, **given, **constants}
        with np.errstate(all="ignore"):
            if long is None:
                _run(steps, values)
                return values
            cut, places = long
            moving = self._moving(steps, cut)
            _run([step for step in steps if step[0] not in moving], values)
            steps = [step for step in steps if step[0] in moving]
            stored = moving.intersection(wanted)

            def compute(position: slice) -> dict[str, Value]:
                piece = fixed | {name: given[name][position] for name in cut}
                with np.errstate(all="ignore"):
                    _run(steps, piece)
                return {name: piece[name] for name in stored}

            fixed = dict(values)
            values |= joined(compute, places, len(given[cut[0]]))
        return values

    @staticmethod
    def _moving(steps: Sequence[tuple], cut: Iterable[str]) -> set[str]:
        """Return the quantities of a plan that depend on some names, by the functions of the plan."""
        reached = set(cut)
        for name, _, arguments in steps:
            if reached.intersection(arguments):
                reached.add(name)
        return reached.difference(cut)

    def replacing(self, replacement: Replacement) -> Graph:
        """Return the graph with some quantities computed by another function.

        Raises
        ------
        UnknownName
            A target that the graph neither computes nor needs.
        """
        targets = replacement.targets
        for target in targets:
            if target not in self._all_names:
                raise unknown("quantity", target, self._all_names)
        # A way that passes over a target would not see the mistake.
        nodes = {
            name: replace(node, stable=None) if self._passed_over.get(name, set()) & set(targets) else node
            for name, node in self._nodes.items()
        }
        # The right value of a target is that of the right graph, all the way up.
        touched = self.descendants(targets)
        for name in touched & self._nodes.keys():
            nodes[_right(name)] = self._nodes[name].renamed({n: _right(n) for n in touched})
        wrong = QuantityNode.of(replacement.function).renamed({n: _right(n) for n in targets})
        if len(targets) == 1:
            nodes[targets[0]] = wrong
        else:
            together = " and ".join(targets) + " (wrong)"
            nodes[together] = wrong
            for index, target in enumerate(targets):
                nodes[target] = QuantityNode(lambda values, i=index: values[i], (together,), {})
        graph = Graph.__new__(Graph)
        graph._build(nodes, frozenset(t for t in targets if t not in self._nodes), self._effects)
        graph._set_aside = touched & self._nodes.keys()
        return graph

    def observed(self, observe: Callable[[str, Value], Value]) -> Graph:
        """Return the graph with every value passed through ``observe(name, value)``, except hidden ones."""

        def wrapped(name: str, node: QuantityNode) -> QuantityNode:
            def function(*arguments: Value) -> Value:
                return observe(name, node.function(*arguments))

            stable = wrapped(name, node.stable) if node.stable else None
            return replace(node, function=function, stable=stable)

        graph = Graph.__new__(Graph)
        nodes = {n: node if _is_hidden(n) else wrapped(n, node) for n, node in self._nodes.items()}
        graph._build(nodes, self._shadowed, self._effects)
        return graph

    def mapped(self, change: Callable[[Callable[..., Value]], Callable[..., Value]]) -> Graph:
        """Return the graph with ``change`` applied to every function, hidden ones included; arguments
        stay."""

        def changed(node: QuantityNode) -> QuantityNode:
            stable = changed(node.stable) if node.stable else None
            return replace(node, function=change(node.function), stable=stable)

        graph = Graph.__new__(Graph)
        nodes = {name: changed(node) for name, node in self._nodes.items()}
        graph._build(nodes, self._shadowed, self._effects)
        return graph

    def descendants(self, names: Iterable[str]) -> frozenset[str]:
        """Return the names and every quantity that depends on one of them."""
        results = set(names)
        grown = True
        while grown:
            more = {n for n, node in self._nodes.items() if results & node.needs} - results
            results |= more
            grown = bool(more)
        return frozenset(results)

    def with_functions(self, functions: Mapping[str, Callable[..., Value]]) -> Graph:
        """Return the graph with additional quantities.

        Raises
        ------
        ValueError
            A name that the graph has already.
        """
        twice = set(functions) & set(self._nodes)
        if twice:
            raise ValueError(f"the graph has {min(twice)!r} already{nearest(min(twice), self._nodes)}")
        graph = Graph.__new__(Graph)
        nodes = {**self._nodes, **{name: QuantityNode.of(f) for name, f in functions.items()}}
        graph._build(nodes, self._shadowed)
        return graph


def call_on_quantities(function: Any, values: Mapping[str, Any], helpers: tuple = ()) -> Any:
    """Call a function that draws, or states a drawing, with the quantities named by its parameters."""
    name, graph = function.__name__, graph_of(function, helpers)
    return graph.evaluate((name,), {n: v for n, v in values.items() if n in graph.leaves})[name]


@lru_cache(maxsize=256)
def graph_of(function: Any, helpers: tuple = ()) -> Graph:
    """Return the graph of a function and its helpers, cached so that its plans are made once."""
    return Graph({**{f.__name__: f for f in helpers}, function.__name__: function})
