"""An exercise of an open course: draws, solves, reads its texts."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import numpy as np

from coursework.course.draws import Draws, Stated
from coursework.course.folder import Folder
from coursework.course.lettering import printed_order
from coursework.course.records import Records
from coursework.course.requests import Intake
from coursework.course.secrecy import Secret
from coursework.course.texts import ExerciseTexts, RenderedText
from coursework.errors import BadCourse, NoSolution, Undefined, WrongValue, unknown
from coursework.model import Driver, Exercise, Part
from coursework.quantities.graph import Graph, plain_scalar

if TYPE_CHECKING:
    from coursework.course.symbols import Symbols
    from coursework.solution import Film, Solution

USUAL, ALL = "usual", "all"  #: what stands for several parts where parts are named


class _Worded(Protocol):
    """A variant, as far as an exercise asks it something."""

    @property
    def text(self) -> RenderedText: ...


V = TypeVar("V", bound=_Worded)


class _Exercises(Protocol):
    """The course that an exercise is of."""

    def __getitem__(self, name: str) -> Any: ...


class CourseExercise(Generic[V]):
    """An exercise of an open course: draws, solves, reads its texts.

    Its variants are of the class that it is handed, made of the exercise, a seed, the given values, a
    language, the parts that are asked where they are not the usual ones, the record that issued it, of an
    older version, and the orders of its choices, where they were recorded.
    """

    def __init__(self, name: str, folder: Folder, course: _Exercises, variant: Callable[..., V]):
        self.name = name
        self.folder = folder
        self.course = course
        self._variant = variant
        spec = getattr(folder.module("exercises", name), "EXERCISE", None)
        if not isinstance(spec, Exercise):
            raise BadCourse(f"{folder.source('exercises', name)} states no EXERCISE = Exercise(…)")
        self.spec: Exercise = spec
        self.texts = ExerciseTexts(folder, name)

    def __repr__(self) -> str:
        return f"<exercise {self.name}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """In another process it is the exercise of the course that is opened there."""
        return operator.getitem, (self.course, self.name)

    @property
    def version(self) -> int:
        """Return the version that records refer to; see :class:`~coursework.model.Exercise`."""
        return self.spec.version

    # ------------------------------------------------------------------ solving

    @cached_property
    def solution(self) -> Solution:
        """The reference solution.

        Raises
        ------
        NoSolution
            The course has none of this exercise.
        """
        from coursework.solution import Solution

        if self.folder.home("solutions", self.name) is None:
            raise NoSolution(
                "no solution of {name!r} in {folder}: write solutions/{name}.py",
                name=self.name,
                folder=self.folder.label,
            )
        source = self.folder.source("solutions", self.name)
        return Solution.of(self.name, self.folder.module("solutions", self.name), source)

    @cached_property
    def units(self) -> Mapping[str, str]:
        """Canonical units of the quantities that state one."""
        stated = {n: s.unit for n, s in self.spec.given.items()}
        stated |= {p.quantity: p.unit for p in self.spec.parts}
        return MappingProxyType({**self.solution.units, **stated})

    def symbol(self, name: str, lang: str) -> str:
        """Return LaTeX of a quantity of the statement in a language."""
        return self.symbols(lang)(self.spec.symbol(name))

    def solution_symbol(self, name: str, lang: str) -> str:
        """Return LaTeX of a quantity of the solution, or else of the statement, in a language."""
        stated = self.solution.symbols.get(name)
        return self.symbols(lang)(stated) if stated else self.symbol(name, lang)

    def symbols(self, lang: str) -> Symbols:
        """Return what a language writes otherwise than the exercise's Python."""
        return self.folder.symbols(lang, is_mechanism=self._is_mechanism)

    @cached_property
    def _is_mechanism(self) -> bool:
        return self.folder.mechanism("exercises", self.name) is not None

    def plan(
        self, only: Sequence[str] | None = None, *, effects: Iterable[str] | None = None
    ) -> tuple[str, ...]:
        """Return the quantities that a request evaluates, in order; ``effects`` as for :meth:`solve`."""
        effects = self.spec.effects if effects is None else effects
        return self.solution.graph.plan(
            self._wanted(only), frozenset(self.spec.given) & self.quantity_names, effects
        )

    def _wanted(self, only: Sequence[str] | str | None) -> tuple[str, ...]:
        if only is None:
            return tuple(dict.fromkeys(p.quantity for p in self.judged_parts if not p.by_request))
        return (only,) if isinstance(only, str) else tuple(only)

    @cached_property
    def quantity_names(self) -> frozenset[str]:
        """Every name that a request may give: computed quantities and what they need."""
        graph = self.solution.graph
        return frozenset(graph.quantities) | graph.leaves

    @cached_property
    def intake(self) -> Intake:
        """Takes in what requests give."""
        structures = self.solution.structures
        return Intake(
            self.name, self.spec.given, self.units, self.quantity_names, structures, self._directions
        )

    @property
    def _directions(self) -> frozenset[str]:
        """The angles of the loops and the driver's, which whole turns do not change."""
        driver_angles = {self.spec.driver.angle} if self.spec.driver else set()
        return frozenset(driver_angles.union(*(loop.angles for loop in self.solution.loops.values())))

    def solve(
        self, *, only: Sequence[str] | str | None = None, effects: Iterable[str] | None = None, **given: Any
    ) -> dict[str, Any]:
        """Quantities from given values, in canonical units (degrees for angles).

        Parameters
        ----------
        only
            The quantities wanted, and nothing else is computed; by default every part's.
        effects
            Optional effects that the request calls for; by default those of the exercise's own questions.
            None with ``()``.
        **given
            Scalars, arrays that broadcast, or texts with a unit (``"0.2286 m"``). The driver's angle and
            those of the loops count modulo whole turns, which cost no digit. Any quantity may be given, also
            one that the graph could compute: then it is used as it is. A list of mappings, such as joints, is
            handed on as a tuple.

        Returns
        -------
        A dict of floats, or of arrays of the shape that each quantity's own arguments broadcast to: what
        does not vary stays a scalar, and a vector has one axis more.

        Raises
        ------
        CannotAssemble
            A scalar configuration that does not close. In arrays it is NaN there and only there.
        Undefined
            A scalar quantity that does not exist for these values.
        UnknownName, MissingQuantity, WrongUnit, WrongValue
            A request that makes no sense, each with what would do.
        """
        values = self.intake.values(given)
        arrays = any(isinstance(v, np.ndarray) for v in values.values())
        if only is None and not arrays:
            only = tuple(p.quantity for p in self.usual_parts(values) if not p.sort.is_open)
        wanted = self._wanted(only)
        if arrays:
            _check_shapes(values)
        effect_names = self.spec.effects if effects is None else effects
        result = self.solution.graph.evaluate(wanted, values, effect_names)
        if not arrays:
            stated = {n: values[n] for n in given if n in values}
            result = {name: self.existing(name, value, stated) for name, value in result.items()}
        return result

    def existing(self, name: str, value: Any, given: Mapping[str, Any]) -> Any:
        """Return a quantity of scalars as plain Python holds it.

        Raises
        ------
        Undefined
            It is not a number: it does not exist for the given values.
        """
        if type(value) is not float:
            value = plain_scalar(value)
        if isinstance(value, float) and value != value:
            data = ", ".join(f"{n} = {v}" for n, v in given.items())
            raise Undefined(
                "{exercise}: {name} does not exist for {data}", exercise=self.name, name=name, data=data
            )
        return value

    @property
    def film(self) -> Film | None:
        """The animation that the solution states in a picture of its own."""
        return self.solution.film

    @property
    def is_animated(self) -> bool:
        """Return whether there is an animation: a film, or a figure that a driver moves."""
        return self.film is not None or (self.spec.driver is not None and self.spec.figure is not None)

    @property
    def _driver(self) -> Driver:
        assert self.spec.driver is not None, f"{self.name} names no driver"
        return self.spec.driver

    def driver_angle(self, given: Mapping[str, Any]) -> float:
        """Return the angle of the driver for these given quantities, degrees.

        Raises
        ------
        BadCourse
            Neither a given quantity nor a helper says it.
        """
        driver = self._driver
        name = driver.angle
        if name in given:
            return float(given[name])
        helpers = Graph({f.__name__: f for f in self.spec.helpers})
        if driver.poses is None or name not in helpers.quantities:
            raise BadCourse(
                f"{self.name}: its driver's angle {name} is not a given quantity; where it is an answer, "
                "a helper of that name says it, and Driver(poses=…) moves the mechanism"
            )
        return float(helpers.evaluate((name,), _known_to(helpers, given))[name])

    def posed(self, given: Mapping[str, Any], angle: Any) -> dict[str, Any]:
        """Return the quantities that place the mechanism with its driver at an angle, degrees, or at each of
        an array of angles."""
        driver = self._driver
        if driver.poses is None:
            return {driver.angle: angle}
        graph = Graph({**{f.__name__: f for f in self.spec.helpers}, "poses": driver.poses})
        values = _known_to(graph, {**given, "driven": angle})
        return dict(graph.evaluate(("poses",), values)["poses"])

    # ----------------------------------------------------------------- variants

    def variant(
        self,
        seed: int,
        lang: str | None = None,
        parts: Sequence[str] | None = None,
        secret: Secret | None = None,
        given: Mapping[str, Any] | None = None,
    ) -> V:
        """Return the variant of a seed: the same for ever for this exercise and version; by default in the
        course's language.

        ``parts`` are the ids of those that it asks; ``usual`` stands for those that are asked by default,
        ``all`` for every one. With the ``secret`` of an assignment, the seed is one of its codes. Values that
        are ``given``, numbers or texts with a unit, are not drawn.

        Raises
        ------
        WrongValue
            A seed that is not a whole number from 0 on.
        UnknownName
            A part that the exercise does not have.
        Starved
            The constraints refuse every draw.
        """
        return self.variants([seed], lang, parts, secret, given)[0]

    def variants(
        self,
        seeds: Iterable[int],
        lang: str | None = None,
        parts: Sequence[str] | None = None,
        secret: Secret | None = None,
        given: Mapping[str, Any] | None = None,
    ) -> list[V]:
        """Return the variants of many seeds, drawn together; with a ``secret``, of many codes of its
        assignment."""
        lang = self.folder.language if lang is None else lang
        chosen = self.chosen_parts(parts)
        seeds = list(seeds)
        for seed in seeds:
            if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
                raise WrongValue("a seed is a whole number from 0 on; found {seed!r}", seed=seed)
        seeds = [int(seed) for seed in seeds]
        drawn = self.draws.draw(seeds, secret, self.stated(given or {}))
        return [
            self._variant(self, seed, given, lang, chosen, None, self._orders(seed, secret))
            for seed, given in zip(seeds, drawn, strict=True)
        ]

    def stated(self, given: Mapping[str, Any]) -> Stated:
        """Return values of given quantities in canonical units, from numbers or texts with a unit.

        Raises
        ------
        UnknownName, WrongUnit, WrongValue
            It is not a given quantity of the exercise, or no value of it; with what would do.
        """
        for name in given:
            if name not in self.spec.given:
                raise unknown("quantity", name, self.spec.given, self.name)
        return {name: self.intake.value(name, value) for name, value in given.items()}

    def _orders(self, code: int, secret: Secret | None) -> dict[str, tuple[str, ...]] | None:
        """Return the orders of choices by part that a code of an assignment draws; None where they are the
        seed's."""
        if secret is None:
            return None
        return {p.id: printed_order(self.name, code, p, secret) for p in self.spec.parts if p.choices}

    @cached_property
    def draws(self) -> Draws:
        """The draws of the exercise's variants."""
        return Draws(self.name, self.spec, lambda: self.solution)

    def chosen_parts(self, parts: Sequence[str] | None) -> tuple[Part, ...] | None:
        """Parts by id, in the order of the exercise; None for the usual ones.

        Those that are judged together are asked together: one that is named brings the others, less those by
        request.

        Raises
        ------
        UnknownName
            A part that the exercise does not have.
        """
        if parts is None:
            return None
        ids = [*(part.id for part in self.spec.parts), USUAL, ALL]
        for part_id in parts:
            if part_id not in ids:
                raise unknown("part", part_id, ids, self.name)
        judges = {p.judge for p in self.spec.parts if p.judge and p.id in parts}
        return tuple(
            # One that is named is asked of every variant, whose turn it would be or not.
            replace(p, when=None) if p.takes_turns and (ALL in parts or p.id in parts) else p
            for p in self.spec.parts
            if ALL in parts or p.id in parts or (not p.by_request and (USUAL in parts or p.judge in judges))
        )

    def parts_worth(self, points: Mapping[str, float]) -> tuple[Part, ...]:
        """Parts by id, each worth so many points."""
        parts = {part.id: part for part in self.spec.parts}
        return tuple(
            replace(parts[i], points=n) if parts[i].points != n else parts[i] for i, n in points.items()
        )

    def from_record(self, record: Mapping[str, Any]) -> V:
        """Return the variant that a record issued, with the values that the record holds.

        A record of an older version keeps its data, its parts and their points, and is solved as the
        exercise is solved now: so a corrected solution marks what was issued before.

        Raises
        ------
        BadInput
            The record is of another exercise or a later version, lacks a given quantity, or asks a
            part that is no more.
        """
        return self._variant(self, *self._records.read(record))

    @cached_property
    def _records(self) -> Records:
        return Records(self.name, self.spec)

    @property
    def judged_parts(self) -> tuple[Part, ...]:
        """The parts that have a right answer: not those that a person marks."""
        return tuple(p for p in self.spec.parts if not p.sort.is_open)

    def usual_parts(self, given: Mapping[str, Any]) -> tuple[Part, ...]:
        """Return the parts that these given values ask unless others are named."""
        return tuple(p for p in self.spec.parts if not p.by_request and p.is_asked(given))

    # -------------------------------------------------------------------- texts

    @property
    def languages(self) -> tuple[str, ...]:
        """The languages that this exercise has a statement in, among those that its course speaks."""
        return self.texts.languages

    def title(self, lang: str) -> str:
        """Return the title; where it is not the same for every variant, that of the first."""
        return self.texts.title(lang) or self.variant(0, lang).text.title


def refuse_complex(exercise: CourseExercise[Any], parts: Iterable[Part], values: Mapping[str, Any]) -> None:
    """Refuse a complex reference of a part that asks for one real number.

    Raises
    ------
    BadCourse
        It says which part, and what would do.
    """
    for part in parts:
        value = values.get(part.quantity)
        if part.sort.is_scalar and isinstance(value, (complex, np.complexfloating)):
            raise BadCourse(
                f"{exercise.solution.source}: {part.quantity} is a complex number, and part {part.id!r} asks "
                "for a real one; return its .real, its .imag, abs(…) or angle(…) of it"
            )


def _check_shapes(values: Mapping[str, Any]) -> None:
    shapes = {n: v.shape for n, v in values.items() if isinstance(v, np.ndarray)}
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{n} {shape}" for n, shape in shapes.items())
        raise WrongValue("the arrays do not broadcast together: {listed}", listed=listed) from None


def _known_to(graph: Graph, values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name in graph.leaves}
