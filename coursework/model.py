"""Model of an exercise: given quantities, constraints, parts. Immutable, without answers.

``exercises/NAME.py`` states one :class:`Exercise` under the name ``EXERCISE``::

    EXERCISE = Exercise(
        given={
            "r1": drawn(100, 300, step=5, unit="mm"),
            "theta1": fixed(90, unit="deg"),
            "mode": chosen("open", "crossed"),
        },
        constraints=(crank_turns,),
        parts=(Part("rA", unit="mm"), Part("theta4", unit="deg", kind="angle", points=2)),
        figure=figure,
    )
"""

from __future__ import annotations

import hashlib
import inspect
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache
from numbers import Real
from typing import Any

import numpy as np

from coursework.errors import BadCourse, WrongValue, nearest
from coursework.kinds.kind import Kind, kind_of
from coursework.markup.symbols import symbol_of
from coursework.parsing.units import check_unit

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z")

Bound = float | Callable[..., Any]  #: a number, or a function of quantities drawn before


@dataclass(frozen=True)
class GivenSpec:
    """Specification of a given quantity: its random variation, and the values accepted in a request."""

    unit: str
    low: Bound | None = None
    high: Bound | None = None
    step: Fraction = Fraction(1)
    choices: tuple[str, ...] = ()
    default: float | str | None = None  #: value of a request that does not give it
    positive: bool = False
    nonzero: bool = False
    #: Whether the sheet lists it among the data, or the parts it is listed with.
    shown: bool | tuple[str, ...] = True

    @property
    def is_choice(self) -> bool:
        return bool(self.choices)

    @property
    def is_fixed(self) -> bool:
        return self.low is None and not self.choices

    def bounds(self, drawn: Mapping[str, Any]) -> tuple[Any, Any]:
        """Return the lowest and the highest value.

        Parameters
        ----------
        drawn
            Quantities drawn before it, by name: numbers or arrays.

        Returns
        -------
        low, high
            In the quantity's unit.
        """
        low, high = (
            b(*(drawn[n] for n in _parameters(b))) if callable(b) else b for b in (self.low, self.high)
        )
        return low, high

    def is_listed(self, parts: Collection[str]) -> bool:
        """Return True if a sheet that asks these parts lists the quantity among its data.

        Parameters
        ----------
        parts
            Ids of the parts asked.

        Returns
        -------
        True or False.
        """
        return self.shown if isinstance(self.shown, bool) else not {*self.shown}.isdisjoint(parts)


def _bound(value: Bound | None) -> Bound | None:
    return value if callable(value) or value is None else float(value)


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def drawn(
    low: Bound,
    high: Bound,
    *,
    step: float = 1,
    unit: str = "1",
    default: float | None = None,
    positive: bool | None = None,
    nonzero: bool = False,
    shown: bool | tuple[str, ...] = True,
) -> GivenSpec:
    """Declare a quantity drawn from the multiples of ``step`` in [low, high]; the record keeps it.

    Parameters
    ----------
    low, high
        Bounds, the smaller first, in the quantity's unit: numbers, or functions of quantities declared
        before, which their parameters name.
    step
        Distance of neighbouring values, positive, in the same unit.
    unit
        Unit of the quantity; ``"1"`` for none.
    default
        Value that a request takes which leaves the quantity out.
    positive
        True if a request may only give positive values; by default it follows from a positive ``low``, but
        for degrees.
    nonzero
        True if 0 is refused, both in draws and in requests.
    shown
        False if the sheet does not list it among the data: what it stands for is in the statement or in the
        figure. With ids of parts, as in ``shown=("pv_a", "pv_b")``, a sheet lists it only where it asks one
        of them.

    Returns
    -------
    The specification.

    Raises
    ------
    WrongValue
        A bound is neither number nor function, the bounds are exchanged, or the step is not positive.
    """
    for bound in (low, high):
        if not (callable(bound) or _is_number(bound)):
            raise WrongValue(
                "a bound of drawn(low, high) is a number or a function of quantities declared before; "
                f"found {bound!r}"
            )
    if _is_number(low) and _is_number(high) and low > high:  # type: ignore[operator]
        raise WrongValue(f"drawn(low, high) takes the smaller bound first; found {low}, {high}")
    if positive is None:
        positive = not callable(low) and low > 0 and unit != "deg"
    exact = Fraction(str(step))
    if exact <= 0:
        raise WrongValue(f"a step must be positive; found {step}")
    return GivenSpec(unit, _bound(low), _bound(high), exact, (), default, positive, nonzero, shown)


def fixed(value: float, *, unit: str = "1") -> GivenSpec:
    """Declare a quantity with the same value in every variant; a request may give another.

    Parameters
    ----------
    value
        The value, in the unit.
    unit
        Unit of the quantity; ``"1"`` for none.

    Returns
    -------
    The specification.

    Raises
    ------
    WrongValue
        The value is not a number.
    """
    if not _is_number(value):
        raise WrongValue(f"fixed(…) takes a number; found {value!r}")
    return GivenSpec(unit, default=value)


def chosen(*choices: str, shown: bool | tuple[str, ...] = True) -> GivenSpec:
    """Declare a quantity drawn among named cases, all equally likely.

    Parameters
    ----------
    choices
        Names of the cases.
    shown
        As in :func:`drawn`.

    Returns
    -------
    The specification.

    Raises
    ------
    WrongValue
        The cases are not two names or more, all different.
    """
    if any(not isinstance(case, str) for case in choices):
        raise WrongValue(
            f"the cases of chosen(…) are names in quotes; found {', '.join(map(repr, choices))}: "
            "numbers are drawn(low, high, step=…)"
        )
    if len(set(choices)) < max(2, len(choices)):
        raise WrongValue(
            "chosen(…) takes two cases or more, all different; found "
            f"{', '.join(map(repr, choices)) or 'none'}"
        )
    return GivenSpec("1", choices=tuple(choices), shown=shown)


LETTERS = "abcdefghijklmnopqrstuvwxyz"  #: of the cases of a choice, in the order printed

_OF_ITS_KIND: Any = None  #: stands for a margin until the part has taken that of its kind


@dataclass(frozen=True)
class Part:
    """Question: its quantity, unit, points and marking.

    ``kind``, a file of :mod:`coursework.kinds`, is ``number``, ``angle`` (compared modulo 360), ``integer``,
    ``choice`` (of ``choices``), ``point`` (by its distance to the reference), ``point_on_line`` (a point of
    the line through the reference along the quantity ``along``), ``direction`` (any non-zero multiple of the
    reference vector) or ``equation`` (in the exercise's symbols ``variables``, up to a factor, which may hold
    those of them that are ``parameters``: lengths), ``complex`` (by its distance to the reference),
    ``vector`` and ``matrix`` (entry by entry), ``twist`` and ``wrench`` (two columns, component by
    component), ``twist_pattern`` and ``wrench_pattern`` (which components may differ from zero), ``choices``
    (several right ones of ``choices``), ``text`` or ``drawing``, which a person marks: their ``room`` is a
    number of lines, or the width and height in mm of a box, of ``millimetre`` paper where the author states
    it. An equation that closes a ``loop`` of the solution is right in any form: :func:`loop_equations`. A
    numeric answer is right within max(``atol``, ``rtol`` · |reference|), by default 1 %, or 1° for what is
    measured in degrees. ``when``, a function of given quantities, says whether a variant asks the part. With
    ``asks_unit`` the sheet prints no unit beside the box, and an answer without one lacks something. Parts
    that name the same ``judge``, a function of the solution, are judged together by it: where many answers
    are right, and the quantity is only one of them. Their ``atol`` and ``rtol`` are the judge's. A part
    ``by_request`` is asked only where a build names it. Choices are printed in an order that is the
    variant's; with ``ordered`` in that which is stated. Numbers, Roman classes, yes and no keep their order
    without it, and ``none`` stands last; with ``shuffled`` they do not: where one case is right in every
    variant, its place must tell nothing.
    """

    quantity: str
    unit: str = "1"
    points: float = 1
    kind: str = "number"
    id: str = ""
    rtol: float = _OF_ITS_KIND
    atol: float = _OF_ITS_KIND
    choices: tuple[str, ...] = ()
    along: str = ""
    variables: tuple[str, ...] = ()
    parameters: tuple[str, ...] = ()
    when: Callable[..., Any] | None = None
    asks_unit: bool = False
    judge: str = ""
    loop: str = ""
    by_request: bool = False
    room: Any = None
    millimetre: bool = False
    ordered: bool = False
    shuffled: bool = False
    takes_turns: bool = False  #: asked of some variants alone, unless it is named: :func:`in_turn`
    sort: Kind = field(init=False, repr=False, compare=False)  #: what its kind says of it

    def __hash__(self) -> int:
        return hash(self.id)  # not of every field: parts of an exercise differ in their ids

    def __post_init__(self) -> None:
        try:
            sort = kind_of(self.kind)
        except BadCourse as fault:
            raise BadCourse(f"part {self.quantity!r}: {fault}") from None
        object.__setattr__(self, "sort", sort)
        for name in ("choices", "along", "variables"):
            if bool(getattr(self, name)) != (name in sort.goes_with):
                have = f"{self.kind!r} comes with it" if name in sort.goes_with else f"{self.kind!r} has none"
                raise BadCourse(f"part {self.quantity!r}: {name!r} goes with some kinds, and must: {have}")
        self._check_room(sort)
        if self.loop and (not self.variables or _loop_form(self) is None):
            raise BadCourse(
                f"part {self.quantity!r}: an equation of the loop {self.loop!r} is called "
                f"{self.loop}_x, {self.loop}_y or "
                f"{self.loop}_complex, and its derivatives {self.loop}_x_dot, {self.loop}_x_ddot"
            )
        if len(self.choices) > len(LETTERS):
            raise BadCourse(
                f"part {self.quantity!r}: {len(self.choices)} choices; there are letters for {len(LETTERS)}"
            )
        if self.ordered and not self.choices:
            raise BadCourse(f"part {self.quantity!r}: 'ordered' is said of choices, and it has none")
        if self.shuffled and (self.ordered or not self.choices):
            raise BadCourse(
                f"part {self.quantity!r}: 'shuffled' is said of choices that are not 'ordered'; found "
                f"ordered={self.ordered}, "
                f"{len(self.choices)} choices"
            )
        if self.asks_unit and (self.is_exact or self.unit == "1"):
            raise BadCourse(f"part {self.quantity!r}: it can ask for a unit only where its answer has one")
        if not self.points > 0:
            raise BadCourse(f"part {self.quantity!r}: points must be positive; found {self.points}")
        if self.unit == "1":
            object.__setattr__(self, "unit", sort.unit)
        in_degrees = bool(sort.turn) or self.unit == "deg"
        if self.atol is None:
            object.__setattr__(self, "atol", 1.0 if in_degrees and not self.judge else 0.0)
        if self.rtol is None:
            object.__setattr__(self, "rtol", 0.0 if in_degrees or self.judge else 0.01)
        if not self.id:
            object.__setattr__(self, "id", self.quantity)

    def _check_room(self, sort: Kind) -> None:
        """Set the default answer space of the kind; refuse space for a kind that has none."""
        if sort.room is None and self.room is not None:
            raise BadCourse(
                f"part {self.quantity!r}: 'room' goes with kinds that leave some; {self.kind!r} has none"
            )
        if self.millimetre and sort.box != "blank":
            raise BadCourse(
                f"part {self.quantity!r}: millimetre paper goes with a drawing, not {self.kind!r}"
            )
        try:
            room = (
                None
                if sort.room is None
                else sort.checked_room(sort.room if self.room is None else self.room)
            )
        except WrongValue as fault:
            raise BadCourse(f"part {self.quantity!r}: {fault}") from None
        object.__setattr__(self, "room", room)

    @property
    def is_exact(self) -> bool:
        """True if answers are compared exactly, without a tolerance."""
        return self.sort.is_exact

    @property
    def has_margin(self) -> bool:
        """True if answers are right within a margin about the reference."""
        return not self.is_exact and not self.judge

    @property
    def loop_form(self) -> tuple[str, int]:
        """Form of a loop equation, ``x``, ``y`` or ``complex``, and its order of differentiation."""
        result = _loop_form(self)
        if result is None:
            raise BadCourse(f"part {self.quantity!r} closes no loop")
        return result

    def half_width(self, reference: float) -> float:
        """Return the largest accepted distance from a reference.

        Parameters
        ----------
        reference
            The right value, in the part's unit.

        Returns
        -------
        The distance in that unit.

        Source
        ------
        ``max(atol, rtol |reference|)``.
        """
        return max(self.atol, self.rtol * abs(reference))

    def is_asked(self, given: Mapping[str, Any]) -> bool:
        """Return whether a variant with these given values asks the part; True where they do not decide.

        Parameters
        ----------
        given
            Values of given quantities by name.

        Returns
        -------
        True or False.
        """
        if self.when is None:
            return True
        names = _parameters(self.when)
        return any(n not in given for n in names) or bool(self.when(*[given[n] for n in names]))


@cache
def _parameters(function: Callable[..., Any]) -> tuple[str, ...]:
    return tuple(inspect.signature(function).parameters)


def _loop_form(part: Part) -> tuple[str, int] | None:
    match = re.fullmatch(rf"{re.escape(part.loop)}_(x|y|complex)(?:_(d?dot))?", part.quantity)
    return (match[1], {None: 0, "dot": 1, "ddot": 2}[match[2]]) if part.loop and match else None


def in_turn(count: int, by: Sequence[str], *groups: Part | Sequence[Part]) -> tuple[Part, ...]:
    """Return parts of which a variant asks some.

    Questions that have one answer in every variant are asked in turn, so that no sheet tells another.

    Parameters
    ----------
    count
        Number of groups that a variant asks.
    by
        Names of the given quantities whose values decide which.
    groups
        A part each, or several that are asked together.

    Returns
    -------
    All parts of the groups, in their order.

    Raises
    ------
    BadCourse
        The groups are not worth the same, so that variants would be out of different points.
    """
    parts = [(group,) if isinstance(group, Part) else tuple(group) for group in groups]
    worth = {sum(part.points for part in group) for group in parts}
    if len(worth) > 1:
        text = ", ".join(f"{group[0].id} {sum(p.points for p in group):g}" for group in parts)
        raise BadCourse(f"groups that are asked in turn are worth the same; found {text} points")
    names = [group[0].id for group in parts]
    return tuple(
        replace(part, takes_turns=True, when=_turn_of(group[0].id, names, count, tuple(by)))
        for group in parts
        for part in group
    )


def _turn_of(name: str, names: Sequence[str], count: int, by: Sequence[str]) -> Callable[..., bool]:
    """Return the function of given quantities that says whether it is a group's turn."""

    def is_asked(*values: Any) -> bool:
        text = "/".join(v if isinstance(v, str) else f"{float(v):.9g}" for v in values)
        order = sorted(
            names, key=lambda item: hashlib.shake_128(f"coursework/turn/{item}/{text}".encode()).digest(8)
        )
        return name in order[:count]

    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    is_asked.__signature__ = inspect.Signature([inspect.Parameter(n, kind) for n in by])  # type: ignore[attr-defined]
    return is_asked


def loop_equations(
    loop: str,
    symbols: Sequence[str],
    *,
    rates: Sequence[str] = (),
    second_rates: Sequence[str] = (),
    parameters: Sequence[str] = (),
    usual: Sequence[str] = (),
    points: float = 1,
) -> tuple[Part, ...]:
    """Return the equations that close a loop of the solution, as parts: projections on x and y, and the
    complex form.

    With ``rates`` and ``second_rates`` the derivatives of the closure are parts as well: ``loop_1_x_dot``,
    ``loop_1_x_ddot``. All are asked by request, but the forms that are usual.

    Parameters
    ----------
    loop
        Name of the loop in the solution.
    symbols
        Names of the quantities that a student may write.
    rates, second_rates
        Names that may be written besides, in the first and in the second derivative.
    parameters
        Names up to a factor of which a named mistake of the solution is known.
    usual
        Forms that are asked without a request: ``("x", "y")``.
    points
        Points of a projection; the complex form is worth twice that.

    Returns
    -------
    The parts, the closure first, then its derivatives.
    """
    parts = []
    known_names = tuple(symbols)
    for ending, more in (("", ()), ("_dot", rates), ("_ddot", second_rates)):
        if ending and not more:
            continue
        known_names += tuple(more)
        for form in ("x", "y", "complex"):
            parts.append(
                Part(
                    f"{loop}_{form}{ending}",
                    kind="equation",
                    variables=known_names,
                    parameters=tuple(parameters),
                    loop=loop,
                    points=2 * points if form == "complex" else points,
                    by_request=f"{form}{ending}" not in usual,
                )
            )
    return tuple(parts)


@dataclass(frozen=True)
class Jack:
    """Jack that drives a mechanism, by names of given quantities: its length (mm), the first and second rates
    of it, and the two lengths between which it travels.
    """

    length: str
    speed: str
    acceleration: str
    limits: tuple[str, str]


@dataclass(frozen=True)
class Driver:
    """Driver of the mechanism in a simulation, by names of quantities.

    ``angle`` in degrees, ``speed`` in rad/s and ``acceleration`` in rad/s^2 of the driving crank; a name
    is empty where the exercise has no such quantity. ``effort`` (N*m, along ``angle``) is what the drive
    must supply, ``output`` a velocity that vanishes at the dead centres.

    Where the angle is an answer, so not among what is given, a helper of its name says it of the figure, and
    ``poses`` moves the mechanism: a function of given quantities, of helpers, and of the angle as ``driven``,
    to the given quantities that place the mechanism there, on arrays.

    Where a ``jack`` turns the body of that angle, a cycle is its travel from limit to limit.
    """

    angle: str
    speed: str = ""
    acceleration: str = ""
    effort: str = ""
    output: str = ""
    poses: Callable[..., Mapping[str, Any]] | None = None
    jack: Jack | None = None

    @property
    def moved(self) -> str:
        """Quantity that a cycle steps through: the length of the jack, or the angle."""
        return self.jack.length if self.jack else self.angle


def clearly_apart(value: Any, right: Any, tolerance: Any, least: float = 2.0, most: float = 0.25) -> Any:
    """Return where it is clear whether a value is right: it lies ``least`` tolerances and more from the right
    one, or ``most`` and less.

    Parameters
    ----------
    value, right
        Values in one unit; scalars or arrays that broadcast.
    tolerance
        Distance in the same unit up to which a value is right, positive.
    least, most
        Numbers of tolerances.

    Returns
    -------
    True or False, of the broadcast shape; True for a value that does not exist (NaN): it is clearly wrong.
    """
    return _is_clear(abs(value - right) / tolerance, least, most)


def _is_clear(gap: Any, least: float, most: float) -> Any:
    return ~((gap > most) & (gap < least))


@dataclass(frozen=True)
class Detectable:
    """Constraint: a named mistake of the solution makes of each of some quantities what is
    :func:`clearly_apart`."""

    mistake: str
    quantities: tuple[str, ...]
    least: float
    most: float

    @property
    def __name__(self) -> str:
        return f"{self.mistake}_is_detectable"

    def holds(self, part: Part, wrong: Any, right: Any) -> Any:
        """Return where the mistake shows clearly in the answers to a part.

        Parameters
        ----------
        part
            The question.
        wrong, right
            Values with and without the mistake, in the part's unit; scalars or arrays that broadcast.

        Returns
        -------
        True or False, of the broadcast shape; True as well where the mistake does not show at all.
        """
        gap = abs(wrong - right)
        if turn := part.sort.turn:
            gap = np.minimum(gap % turn, -gap % turn)
        return _is_clear(gap / np.maximum(part.atol, part.rtol * abs(right)), self.least, self.most)


def detectable(mistake: str, *quantities: str, least: float = 2.0, most: float = 0.25) -> Detectable:
    """Return the constraint that a mistake of the solution shows clearly in some quantities, or not at all.

    The tolerance of a quantity is that of the part that asks it.

    Parameters
    ----------
    mistake
        Name of the mistake in the solution.
    quantities
        Names of the quantities in which it shows.
    least, most
        Numbers of tolerances, as in :func:`clearly_apart`.

    Returns
    -------
    The constraint.
    """
    return Detectable(mistake, quantities, least, most)


@dataclass(frozen=True)
class Exercise:
    r"""Exercise without its answers.

    Parameters
    ----------
    given
        The given quantities, in the order they are drawn and printed.
    parts
        The questions, in order.
    constraints
        What a variant must satisfy: functions of quantities to booleans, on arrays; a name says what it
        wants, since refusals are counted by it. A quantity is given, or computed by a helper or by the
        solution. That a named mistake shows in the answers is :func:`detectable`.
    helpers
        Functions that the figure and the constraints share; their names are quantities to them.
    figure
        A function of given quantities (and of ``helpers``) to a :class:`~coursework.figures.Figure`, a
        :class:`~coursework.figures.Picture` of a file beside the exercise, or a tuple of them.
    tells
        A function of given quantities to what the statement's text may use besides them: lists, records.
    version
        Raised when a change alters what a seed draws, or what is asked; records keep theirs.
    symbols
        LaTeX of quantities whose name does not say it (``rA_dot`` does: ``\dot{r}_A``).
    either_order
        Groups of part ids that a student may exchange as wholes: two assembly modes.
    driver
        What drives it when it is simulated; none for an exercise that does not move.
    effects
        The optional effects that the exercise's own parts call for, and a request that names none.
    drawing_mm
        Width and height of the box of millimetre paper that a printed sheet offers to draw in, whole
        centimetres; by default none.
    surface_mm
        Width and height of the paper of the drawing surface on pages, where no printed box has these sizes.
    """

    given: Mapping[str, GivenSpec]
    parts: Sequence[Part]
    constraints: Sequence[Callable[..., Any] | Detectable] = ()
    helpers: Sequence[Callable[..., Any]] = ()
    figure: Callable[..., Any] | None = None
    tells: Callable[..., Mapping[str, Any]] | None = None
    version: int = 1
    symbols: Mapping[str, str] = field(default_factory=dict)
    either_order: tuple[tuple[str, ...], ...] = ()
    driver: Driver | None = None
    effects: tuple[str, ...] = ()
    drawing_mm: tuple[int, int] | None = None
    surface_mm: tuple[int, int] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", tuple(self.parts))
        if self.drawing_mm is not None and not _fits_a_page(self.drawing_mm):
            raise BadCourse(
                "a box to draw in is 10 to 160 mm wide and 10 to 200 mm high, by tens; found "
                f"{self.drawing_mm}"
            )
        if not self.given or not self.parts:
            raise BadCourse("an exercise needs given quantities and parts; one of them is empty")
        for name, spec in self.given.items():
            if not _NAME.match(name):
                raise BadCourse(f"{name!r} is not a name for a quantity; use letters, digits and underscores")
            if not isinstance(spec, GivenSpec):
                raise BadCourse(f"{name} is given as drawn(…), chosen(…) or fixed(…); found {spec!r}")
            check_unit(f"the unit of {name}", spec.unit)
        for part in self.parts:
            check_unit(f"the unit of part {part.id!r}", part.unit)
        ids = [part.id for part in self.parts]
        twice = sorted({i for i in ids if ids.count(i) > 1})
        if twice:
            raise BadCourse(f"two parts are called {twice[0]!r}; give one of them another id")
        earlier: list[str] = []
        for name, spec in self.given.items():
            for part_id in spec.shown if isinstance(spec.shown, tuple) else ():
                if part_id not in ids:
                    raise BadCourse(
                        f"{name} is shown with part {part_id!r}, which does not exist{nearest(part_id, ids)}"
                    )
            for bound in (spec.low, spec.high):
                needs = _parameters(bound) if callable(bound) else ()
                for need in needs:
                    if need not in earlier:
                        raise BadCourse(
                            f"the range of {name} needs {need}, which is not drawn before it"
                            f"{nearest(need, earlier)}"
                        )
            earlier.append(name)
        for group in self.either_order:
            for i in group:
                if i not in ids:
                    raise BadCourse(f"either_order names no part {i!r}{nearest(i, ids)}")

    def statement_values(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the values that the statement may use beside the given ones.

        Parameters
        ----------
        given
            Values of all given quantities by name.

        Returns
        -------
        The values by name; none where the exercise states no ``tells``.
        """
        return {} if self.tells is None else self.tells(*[given[n] for n in _parameters(self.tells)])

    @property
    def exchangeable(self) -> frozenset[str]:
        """Ids of the parts whose answers are judged in either order."""
        return frozenset(part_id for group in self.either_order for part_id in group)

    def part(self, part_id: str) -> Part | None:
        """Return the part of this id, or None.

        Parameters
        ----------
        part_id
            Id of the part.

        Returns
        -------
        The part; None where the exercise has none of this id.
        """
        return next((p for p in self.parts if p.id == part_id), None)

    def symbol(self, name: str) -> str:
        """Return the LaTeX symbol of a quantity.

        Parameters
        ----------
        name
            Name of the quantity.

        Returns
        -------
        LaTeX: the exercise's own symbol, or that of :func:`symbol_of`.
        """
        return self.symbols.get(name) or symbol_of(name)


def _fits_a_page(box: tuple[int, int]) -> bool:
    return all(side in range(10, most, 10) for side, most in zip(box, (170, 210), strict=True))
