"""Proof that formulas give the declared units: the graph, evaluated on numbers with units."""

from __future__ import annotations

import traceback
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from coursework.errors import CourseworkError
from coursework.quantities.graph import Graph, QuantityNode
from coursework.quantities.sizes import Size, UnitFault, Unprovable, fits, size_text, sizes_of
from coursework.quantities.unit_check import Lens
from coursework.quantities.unit_check_by_scaling import Opaque, unmeasured
from coursework.quantities.unit_numbers import UnitValue, gathered, leaves, stripped

_NUMBERS = (int, float, complex, np.number)


class _Unknown:
    """Value with an unknown unit."""


@dataclass
class Findings:
    """Result of the proof by quantity: proved, wrong with the fault, or undecided with the reason."""

    proved: set[str] = field(default_factory=set)
    wrong: dict[str, str] = field(default_factory=dict)
    unproved: dict[str, str] = field(default_factory=dict)

    def merge(self, other: Findings) -> None:
        """Add the findings of another variant: a fault on one is a fault, a proof on one is a proof."""
        self.wrong = {**other.wrong, **self.wrong}
        self.proved = (self.proved | other.proved) - self.wrong.keys()
        doubts = {**other.unproved, **self.unproved}
        self.unproved = {n: w for n, w in doubts.items() if n not in self.proved and n not in self.wrong}


def prove(
    graph: Graph,
    given: Mapping[str, Any],
    units: Mapping[str, str],
    effects: Collection[str] = (),
    wanted: Sequence[str] = (),
) -> Findings:
    """Check that each quantity's functions give its unit in ``units``, from given values in their own units.

    A quantity is proved by its formula and, where it has one, by its stable way; what is given and could be
    computed is proved as well. What is wrong is followed on in the declared unit, so that one fault is
    reported once.
    """
    walk = _Walk(graph, given, units, effects)
    with np.errstate(all="ignore"):
        for name in wanted or graph.quantities:
            walk.value(name)
    return walk.findings


class _Walk:
    def __init__(
        self, graph: Graph, given: Mapping[str, Any], units: Mapping[str, str], effects: Collection[str]
    ):
        self.graph = graph
        self.units = units
        self.given = given
        self.effects = effects
        self.sizes = {name: sizes_of(unit) for name, unit in units.items()}
        self.lens = Lens(self.sizes)
        self.findings = Findings()
        self.values = {name: self._handed_in(name, value) for name, value in given.items()}
        self.waiting: set[str] = set()

    def _handed_in(self, name: str, value: Any) -> Any:
        """Return a value in its declared unit; texts and structures unchanged."""
        is_number = isinstance(value, _NUMBERS) and not isinstance(value, (bool, np.bool_))
        if not is_number and not (isinstance(value, np.ndarray) and value.dtype.kind in "iufc"):
            return value
        return UnitValue(value, self.sizes[name]) if name in self.sizes else value

    def value(self, name: str) -> Any:
        """Return the value of a quantity with its unit, and check its functions on the way."""
        if name in self.waiting:
            return self.values.get(name, _Unknown)
        if name in self.values and (name not in self.given or name not in self.graph.names):
            return self.values[name]
        if name not in self.graph.names:
            return _Unknown
        self.waiting.add(name)
        node = self.graph.node(name)
        result = self._judged(name, node)
        if node.stable is not None:
            self._judged(name, node.stable)
        if name not in self.given:
            self.values[name] = result
        return self.values[name]

    def _judged(self, name: str, node: QuantityNode) -> Any:
        arguments = [self._argument(node, a) for a in node.arguments]
        try:
            if any(a is _Unknown for a in arguments):
                raise Unprovable(f"it needs {_unknown(node, arguments)}, whose unit is not known")
            return self._compared(name, node, self.lens(node.function)(*arguments))
        except UnitFault as fault:
            self.findings.wrong.setdefault(name, f"{name} {fault}: {_line(fault, node)}")
        except Unprovable as fault:
            self._doubt(name, str(fault))
        except (CourseworkError, ArithmeticError):
            return _Unknown  # it does not exist on this variant
        except Exception as fault:
            self._doubt(name, f"{type(fault).__name__}: {fault}")
        return self._plainly(name, node, arguments)

    def _doubt(self, name: str, why: str) -> None:
        """Record why the unit of a quantity is undecided, if it declares one."""
        if name in self.sizes:
            self.findings.unproved.setdefault(name, why)

    def _argument(self, node: QuantityNode, name: str) -> Any:
        if name in node.defaults and name not in self.given and name not in self.effects:
            return node.defaults[name]
        if name in self.values:
            return self.values[name]
        return self.value(name)

    def _compared(self, name: str, node: QuantityNode, result: Any) -> Any:
        """Return a function's result in the declared unit. Raises UnitFault: it is in another."""
        if name not in self.sizes:
            return result
        result = gathered(result)
        if isinstance(result, Opaque):
            raise Unprovable("it is not a number")
        for leaf in leaves(result):
            if isinstance(leaf, UnitValue):
                self._refuse_misfit(name, node, leaf)
        if leaves(result) or isinstance(result, int):
            self.findings.proved.add(name)
        return self._handed_in(name, stripped(result))

    def _refuse_misfit(self, name: str, node: QuantityNode, result: UnitValue) -> None:
        if not any(fits(size, declared) for size in result.sizes for declared in self.sizes[name]):
            given = "a plain number" if _is_bare(result.sizes[0]) else size_text(result.sizes[0])
            raise UnitFault(f"is declared in {self.units[name]}, and its formula gives {given}")

    def _plainly(self, name: str, node: QuantityNode, arguments: Sequence[Any]) -> Any:
        """Return a function's result in the declared unit, where units could not be followed through it."""
        if name not in self.sizes or any(a is _Unknown for a in arguments):
            return _Unknown
        try:
            result = node.function(*[unmeasured(a) for a in arguments])
        except Exception:
            return _Unknown
        return self._handed_in(name, result)


def _is_bare(size: Size) -> bool:
    return bool(size.powers[-1]) and not any(size.hard)


def _unknown(node: QuantityNode, arguments: Sequence[Any]) -> str:
    return ", ".join(n for n, a in zip(node.arguments, arguments, strict=True) if a is _Unknown)


def _line(fault: Exception, node: QuantityNode) -> str:
    """Return the course line at which units disagree, else that of the function."""
    code = getattr(node.function, "__code__", None)
    home = Path(code.co_filename).parent if code else Path()
    frames = [
        f
        for f in traceback.extract_tb(fault.__traceback__)
        if home in (Path(f.filename).parent, *Path(f.filename).parents)
    ]
    if frames:
        return f"{frames[-1].name} ({Path(frames[-1].filename).name}, line {frames[-1].lineno})"
    return f"{code.co_name} ({Path(code.co_filename).name}, line {code.co_firstlineno})" if code else ""
