"""Loader of a solution module: quantities as functions, named mistakes, known cases, a residual.

``solutions/NAME.py`` is read by these rules:

* a public function defined in it is a quantity, and its parameters are what it needs; so is one that it
  imports
  from a sibling whose name begins with an underscore: ``from ._strokes import *``;
* a function marked :func:`mistake` is a wrong way to get a quantity;
* a function marked :func:`judge` says which answers are right, where many are;
* ``residual`` gives the governing equations, written independently: 0 when right, but for rounding of their
  terms;
* ``KNOWN`` lists pairs (given values, expected values), best written ``given(r1=200).gives(rA=300)``
  (:func:`given`); an expected text such as ``"319.80"`` is right to its last printed digit, a number to 1e-9
  relative; a third item names the case's effects, where they are not those of the exercise's own parts;
* ``motion`` gives points that move, as a dict of :class:`Moving`, for animations;
* ``FILM``, a :class:`Film`, states a picture of its own for the animation, where the statement's figure
  cannot move;
* ``polygons`` gives the velocity and acceleration polygons, each a
  :class:`~coursework.figures.polygons.Polygon`;
* ``overlay`` gives what a student drew over the right construction, where that is not a polygon, as an
  :class:`~coursework.figures.polygons.own_drawing.OwnDrawing`: a function of ``answers``, as those of a
  judge, and of quantities;
* ``LOOPS`` states the closed loops as vectors, by name; their equations are quantities:
  :mod:`coursework.quantities.loops`;
  ``RATES`` gives the names of derivatives that do not follow from a quantity's own;
* ``MECHANISM`` states bodies and joints, a :class:`~coursework.mechanics.Mechanism`: forces and motions
  follow from it;
* ``EFFECTS`` names what a scene shows of each effect, where it is not what ``LOOPS`` say:
  :mod:`coursework.scenes.effects`;
* ``STRUCTURES`` names the quantities whose value is a list or a record, such as a list of joints: a request
  may give them, and they are passed to the functions as they come;
* ``UNITS`` and ``SYMBOLS`` give unit and LaTeX of quantities that no part and no name says;
* a name that begins with an underscore is the module's own; a function of such a name is computed once
  a request when a quantity takes it as a parameter, and is not a quantity that one could ask for.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.errors import BadCourse, CourseworkError, nearest, unknown
from coursework.mechanics.statement import Mechanism
from coursework.messages import Message
from coursework.parsing.units import check_unit
from coursework.quantities.error_kinds import PENALTIES
from coursework.quantities.graph import Graph, QuantityNode, Replacement
from coursework.quantities.in_radians import in_radians
from coursework.quantities.loops import Loop, moving_quantities, quantities, stated

if TYPE_CHECKING:
    from coursework.figures.polygons.own_drawing import OwnDrawing
    from coursework.figures.polygons.polygon import Polygon


@dataclass(frozen=True)
class Mistake:
    """Named mistake: the quantities it replaces, and the share of a part's points that it earns.

    Without a ``share``, the penalty is that of its ``kind``.
    """

    name: str
    replacement: Replacement
    share: float | None
    approximation: bool
    kind: str = "mistake"

    @property
    def targets(self) -> tuple[str, ...]:
        return self.replacement.targets


def mistake(
    *targets: str, kind: str = "mistake", share: float | None = None, approximation: bool = False
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Mark a function as a named mistake about ``targets``.

    The function returns the wrong value, or a tuple of them for several targets. A parameter that
    bears a target's name stands for its right value, so ``def sign(omega5): return -omega5`` reads
    as it sounds.

    Parameters
    ----------
    targets
        Names of the quantities that it gets wrong, given or computed.
    kind
        Kind of error, one of :data:`~coursework.quantities.error_kinds.PENALTIES`: what it leaves of the
        points is the course's price for it.
    share
        Share of the points that it leaves, 0 to 1, as a price of its own; by default that of its kind.
    approximation
        True for a legitimate approximation.

    Returns
    -------
    A decorator, which returns the function itself.

    Raises
    ------
    BadCourse
        No target, no such kind, or a share that is not between 0 and 1.
    """
    if not targets or not all(isinstance(t, str) for t in targets):
        raise BadCourse('@mistake names what it gets wrong: @mistake("theta4")')
    if kind not in PENALTIES:
        raise BadCourse(f"a mistake is of a kind that has a price; found {kind!r}{nearest(kind, PENALTIES)}")
    if share is not None and not 0 <= share <= 1:
        raise BadCourse(f"a mistake leaves a share of the points between 0 and 1; found {share}")

    def mark(function: Callable[..., Any]) -> Callable[..., Any]:
        function.__mistake__ = Mistake(  # type: ignore[attr-defined]  # marks a function
            function.__name__, Replacement(targets, function), share, approximation, kind
        )
        return function

    return mark


def formula(latex: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    r"""State the printed formula of a quantity whose code does not read as one.

    ``@formula(r"\operatorname{arg}(<arm>)")``

    Parameters
    ----------
    latex
        The formula: ``<name>`` stands for the quantity of that name, its symbol in the formula, its number in
        the substitution.

    Returns
    -------
    A decorator, which returns the function itself.
    """

    def mark(function: Callable[..., Any]) -> Callable[..., Any]:
        function.__formula__ = latex  # type: ignore[attr-defined]  # marks a function
        return function

    return mark


def explained_after(*names: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """State which quantities the worked solution prints before this one, beyond those that its code takes.

        @explained_after("transmitted")
        def rs(_combined): ...

    So the table of what is transmitted stands before the rank that is counted in it, whichever questions are
    asked.

    Parameters
    ----------
    names
        Names of the quantities printed before.

    Returns
    -------
    A decorator, which returns the function itself.
    """

    def mark(function: Callable[..., Any]) -> Callable[..., Any]:
        function.__explained_after__ = names  # type: ignore[attr-defined]  # marks a function
        return function

    return mark


def stable(function: Callable[..., Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """State how a quantity is computed where its textbook formula would lose digits.

    The decorated function is the formula of the course: it is what the worked solution prints, and what
    computes when one of its own arguments is given or mistaken. ``function`` gives the same
    quantity from other quantities, or from hidden ones of the module, whose names begin with an underscore:

        def _linkage(r1, r2, r3, r4, theta2, mode): ...

        @stable(lambda _linkage: _linkage.rocker_angle)
        def theta4(phi, psi): return phi - psi

    Parameters
    ----------
    function
        The computation, a function of other quantities.

    Returns
    -------
    A decorator of the textbook formula, which it returns.
    """

    def mark(formula: Callable[..., Any]) -> Callable[..., Any]:
        formula.__stable__ = function  # type: ignore[attr-defined]  # marks a function
        return formula

    return mark


@dataclass(frozen=True)
class Case:
    """Given values of a known case, and its effects; None for those of the exercise."""

    values: Mapping[str, Any]
    effects: tuple[str, ...] | None = None

    def under(self, *effects: str) -> Case:
        """Return the case under these effects, or under none.

        Parameters
        ----------
        effects
            Names of the effects.

        Returns
        -------
        A case with the same values.
        """
        return Case(self.values, effects)

    def gives(self, **expected: Any) -> tuple[Any, ...]:
        """Return the entry of ``KNOWN``, with the expected values.

        Parameters
        ----------
        expected
            Values by quantity; a text is right to its last printed digit, a number to 1e-9 relative.

        Returns
        -------
        A pair (given values, expected values), with the effects as a third item where they are stated.
        """
        case = (self.values, expected)
        return case if self.effects is None else (*case, self.effects)


def given(**values: Any) -> Case:
    """Return a known case by its given values; ``KNOWN`` then reads as a list of sentences::

    KNOWN = (
        given(r1=200, r2=100, theta2=90).gives(rA=300, theta4=90),
        given(r2=40, F=-400).under("load").gives(torque=-12),
    )

    Parameters
    ----------
    values
        Values by given quantity, in their units.

    Returns
    -------
    The case, without effects of its own.
    """
    return Case(values)


@dataclass(frozen=True)
class Judged:
    """Judgement of one answer.

    ``share``, 0 to 1, is the part of the points that it earns; ``mistake`` the named mistake that it shows,
    if any; ``found`` what follows from the student's own answers, by quantity, in canonical units: the
    message names it. ``also``: other named mistakes that explain the same answer. ``follows``: the answer is
    not the expected one, but right from an earlier answer of the student that is wrong. ``slip``: what is
    missed that the engine tells, such as ``not_drawn``; its price is that of the course.
    """

    share: float = 1.0
    mistake: str = ""
    found: Mapping[str, float] = field(default_factory=dict)
    follows: bool = False
    also: tuple[str, ...] = ()
    slip: str = ""


def judge(function: Callable[..., Any]) -> Callable[..., Any]:
    """Mark a function as the judge of the parts that name it, which are judged together.

    Its first parameter is ``answers``: by part id, what was read, in the part's unit; a float, or an array of
    coordinates. An answer that is missing or unreadable is not among them. The others are quantities of the
    exercise. It returns a :class:`Judged` for each answer, by part id, and none for one that cannot be judged
    because others are missing::

        @judge
        def meets_the_demands(answers, stroke):
            if "r2" not in answers:
                return {}
            return {"r2": Judged(abs(2 * answers["r2"] - stroke) <= 0.01 * stroke, found={"stroke": ...})}

    Parameters
    ----------
    function
        The judge, a function of ``answers`` and of quantities.

    Returns
    -------
    The function itself.
    """
    function.__judge__ = True  # type: ignore[attr-defined]  # marks a function
    return function


@dataclass(frozen=True)
class Moving:
    """Point in motion: complex numbers, in mm, mm/s and mm/s^2; None for one that is not shown.

    ``coriolis`` is the Coriolis term of the point's acceleration, seen from the body it slides on. Each is a
    scalar or an array over the driver's angles.
    """

    position: Any
    velocity: Any = None
    acceleration: Any = None
    coriolis: Any = None

    def over(self, count: int) -> Moving:
        """Return the motion as arrays of ``count`` instants.

        Parameters
        ----------
        count
            Number of instants.

        Returns
        -------
        The motion, each of its vectors of shape ``(count,)``, complex; None for one that is not shown.
        """
        values = (self.position, self.velocity, self.acceleration, self.coriolis)
        return Moving(*(v if v is None else np.broadcast_to(v, (count,)).astype(complex) for v in values))


@dataclass(frozen=True)
class Film:
    """Animation with a picture of its own, for a statement whose figure cannot move.

    ``angle`` names the driving angle, degrees: 0 in the first picture, so no given quantity. ``speed`` names
    its rate, whose sign says which way it turns. ``figure`` is a function of that angle and of any quantities
    of the solution to a :class:`~coursework.figures.Figure`, ``turns`` one of quantities alone to how many
    turns of the driver are shown, whole or not; then the film starts over. Its words are the section
    ``motion`` of the solution's texts, and the points of ``motion`` may take the angle as well.
    """

    figure: Callable[..., Any]
    angle: str
    speed: str
    turns: Callable[..., Any]


@dataclass(frozen=True)
class Solution:
    """Loaded solution."""

    name: str
    source: str  #: its file, for messages
    graph: Graph
    mistakes: Mapping[str, Mistake]
    known: Sequence[tuple[Any, ...]]
    residual: Callable[..., Any] | None
    figure: Callable[..., Any] | None
    motion: Callable[..., Mapping[str, Moving]] | None
    units: Mapping[str, str]
    symbols: Mapping[str, str]
    structures: frozenset[str] = frozenset()  #: quantities that are not numbers: passed on as they come
    judges: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    polygons: Callable[..., Sequence[Polygon]] | None = None
    overlay: Callable[..., OwnDrawing | None] | None = None
    loops: Mapping[str, Loop] = field(default_factory=dict)
    film: Film | None = None
    mechanism: Mechanism | None = None
    effects: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @staticmethod
    def of(name: str, module: ModuleType, source: str) -> Solution:
        """Read a solution module.

        Parameters
        ----------
        name
            Name of the exercise.
        module
            The module, loaded.
        source
            Name of its file in messages.

        Returns
        -------
        The solution.

        Raises
        ------
        BadCourse
            It defines no quantity, a mistake about something that it does not have, or a ``FILM`` that is
            none.
        """
        selected = {
            key: value
            for key, value in vars(module).items()
            if not key.startswith("_")
            and callable(value)
            and not isinstance(value, type)
            and _belongs(value, module)
        }
        mistakes = {k: f.__mistake__ for k, f in selected.items() if hasattr(f, "__mistake__")}
        judges = {k: f for k, f in selected.items() if hasattr(f, "__judge__")}
        special = {"residual", "figure", "motion", "polygons", "overlay"}
        functions = {k: f for k, f in selected.items() if k not in {*special, *mistakes, *judges}}
        if not functions:
            raise BadCourse(f"{source} defines no quantity; a quantity is a function of its name")
        functions |= _hidden(functions, module)
        needs = {k: QuantityNode.of(f).needs for k, f in functions.items()}
        needed, rates = frozenset().union(*needs.values()), getattr(module, "RATES", {})
        given = needed - functions.keys()
        moving = moving_quantities(needs, given, rates)
        loops = stated(source, getattr(module, "LOOPS", {}), rates, moving, {*given, *functions} - moving)
        functions |= quantities(loops)
        graph = Graph(functions)
        _check_explained_after(source, graph)
        for wrong in mistakes.values():
            try:
                graph.replacing(wrong.replacement)
            except CourseworkError as fault:
                raise BadCourse(f"{source}: mistake {wrong.name!r}: {fault}") from fault
        units = dict(getattr(module, "UNITS", {}))
        for quantity, unit in units.items():
            check_unit(f"{source}: UNITS of {quantity}", unit)
        return Solution(
            name,
            source,
            graph,
            mistakes,
            tuple(getattr(module, "KNOWN", ())),
            selected.get("residual"),
            selected.get("figure"),
            selected.get("motion"),
            units,
            dict(getattr(module, "SYMBOLS", {})),
            frozenset(getattr(module, "STRUCTURES", ())),
            judges,
            selected.get("polygons"),
            selected.get("overlay"),
            loops,
            _film(source, module),
            _mechanism(source, module, graph),
            _effects(source, module, graph),
        )

    def judge(self, name: str) -> Callable[..., Any]:
        """Return the judge that parts name.

        Parameters
        ----------
        name
            Name of the judge.

        Returns
        -------
        The function marked :func:`judge`.

        Raises
        ------
        UnknownName
            The solution has no such judge.
        """
        if name not in self.judges:
            raise unknown("judge", name, self.judges, Message("solution {exercise}", exercise=self.name))
        return self.judges[name]

    def mistaken(self, name: str) -> Graph:
        """Return the graph with one named mistake in it.

        Parameters
        ----------
        name
            Name of the mistake.

        Returns
        -------
        The graph in which the mistake replaces its targets.

        Raises
        ------
        UnknownName
            The solution has no such mistake.
        """
        if name not in self.mistakes:
            raise unknown("mistake", name, self.mistakes, Message("solution {exercise}", exercise=self.name))
        return self._mistaken_graphs[name]

    def reached(self, name: str) -> frozenset[str]:
        """Return the quantities that a named mistake can change.

        Parameters
        ----------
        name
            Name of a mistake of the solution.

        Returns
        -------
        The names of its targets and of what depends on them.
        """
        return self._reached[name]

    def depending_on(self, quantity: str) -> frozenset[str]:
        """Return the quantities that depend on one.

        Parameters
        ----------
        quantity
            Name of a quantity.

        Returns
        -------
        Its name and theirs, by the textbook formulas.
        """
        if quantity not in self._dependants:
            self._dependants[quantity] = self.graph.textbook.descendants((quantity,))
        return self._dependants[quantity]

    @cached_property
    def _dependants(self) -> dict[str, frozenset[str]]:
        return {}

    @cached_property
    def _reached(self) -> dict[str, frozenset[str]]:
        return {n: self.graph.descendants(m.targets) for n, m in self.mistakes.items()}

    @cached_property
    def _mistaken_graphs(self) -> dict[str, Graph]:
        return {n: self.graph.replacing(m.replacement) for n, m in self.mistakes.items()}

    @cached_property
    def in_radians(self) -> tuple[Graph, ...]:
        """Graphs of a calculator in radian mode: :func:`~coursework.quantities.in_radians.in_radians`."""
        return in_radians(self.graph)

    @cached_property
    def residual_graph(self) -> Graph:
        """The graph with the residual as one more quantity.

        Raises
        ------
        BadCourse
            The solution states no residual.
        """
        if self.residual is None:
            raise BadCourse(f"{self.source} states no residual; write the governing equations")
        return self.graph.with_functions({"residual": self.residual})


def _check_explained_after(source: str, graph: Graph) -> None:
    for name in graph.names:
        for before in graph.node(name).explained_after:
            if before not in graph.quantities:
                raise BadCourse(
                    f"{source}: {name} is explained after {before!r}, which is not a "
                    f"quantity{nearest(before, graph.quantities)}"
                )


def _film(source: str, module: ModuleType) -> Film | None:
    film = getattr(module, "FILM", None)
    if film is not None and not isinstance(film, Film):
        raise BadCourse(f"{source}: FILM is a Film(…); found {str(film)[:60]}")
    return film


def _mechanism(source: str, module: ModuleType, graph: Graph) -> Mechanism | None:
    mechanism = getattr(module, "MECHANISM", None)
    if mechanism is None:
        return None
    if not isinstance(mechanism, Mechanism):
        raise BadCourse(f"{source}: MECHANISM is a Mechanism(…); found {str(mechanism)[:60]}")
    known_names = graph.names | graph.leaves
    for name in mechanism.angles:  # what places are given by may be data that no formula takes
        if name not in known_names:
            raise BadCourse(f"{source}: MECHANISM names no quantity by {name!r}{nearest(name, known_names)}")
    return mechanism


def _effects(source: str, module: ModuleType, graph: Graph) -> Mapping[str, tuple[str, ...]]:
    effects = {effect: tuple(names) for effect, names in getattr(module, "EFFECTS", {}).items()}
    for name in (n for names in effects.values() for n in names):
        if name not in graph.names:
            raise BadCourse(f"{source}: EFFECTS names no quantity by {name!r}{nearest(name, graph.names)}")
    return effects


def _belongs(function: Any, module: ModuleType) -> bool:
    """Return whether a function is the module's own, or from a module that solutions share, such as
    ``_strokes``."""
    home = getattr(function, "__module__", None) or ""
    if home == module.__name__:
        return True
    shared, _, last = home.rpartition(".")
    solutions = module.__name__.split(".")[:2]  # the course's package and its folder; topics lie within
    return last.startswith("_") and shared.split(".")[:2] == solutions


def _hidden(functions: Mapping[str, Callable[..., Any]], module: ModuleType) -> dict[str, Callable[..., Any]]:
    """Return the hidden functions that quantities take as parameters: the module's, or those of a shared
    module."""
    results: dict[str, Callable[..., Any]] = {}
    waiting = list(functions.values())
    while waiting:
        function = waiting.pop()
        for name in QuantityNode.of(function).needs:
            hidden = getattr(module, name, function.__globals__.get(name)) if name.startswith("_") else None
            if callable(hidden) and name not in results:
                results[name] = hidden
                waiting.append(hidden)
    return results
