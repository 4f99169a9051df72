"""An exercise of an open course: draws, solves, renders, marks."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework import draws, statement
from coursework.errors import BadCourse, NoSolution, Undefined, WrongValue, unknown
from coursework.graph import Graph, plain_scalar
from coursework.intake import Intake
from coursework.language import languages
from coursework.model import Exercise, Part
from coursework.records import Records
from coursework.solution import Film, Solution
from coursework.variant import Variant

if TYPE_CHECKING:
    from coursework.course import Course
    from coursework.loop_marking import LoopJudge

USUAL, ALL = "usual", "all"  #: what stands for several parts where parts are named


class CourseExercise:
    """An exercise of an open course: draws, solves, renders, marks."""

    def __init__(self, course: Course, name: str):
        self.course = course
        self.name = name
        module = course.module("exercises", name)
        spec = getattr(module, "EXERCISE", None)
        if not isinstance(spec, Exercise):
            raise BadCourse(f"exercises/{name}.py states no EXERCISE = Exercise(…)")
        self.spec: Exercise = spec
        draws.check_conditions(name, spec)

    def __repr__(self) -> str:
        return f"<exercise {self.name}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """In another process it is the exercise of the course that is opened there."""
        return operator.getitem, (self.course, self.name)

    @property
    def version(self) -> int:
        """What records are of; see :class:`~coursework.model.Exercise`."""
        return self.spec.version

    # ------------------------------------------------------------------ solving

    @cached_property
    def solution(self) -> Solution:
        """The reference solution.

        Raises
        ------
        NoSolution
            The course folder has none: it looks like a students' copy.
        """
        folder = self.course.root / "solutions"
        if not (folder / f"{self.name}.py").exists() and not (folder / self.name).is_dir():
            why = "it looks like a students' copy" if not folder.is_dir() else f"it lacks {self.name}.py"
            raise NoSolution(f"no solution of {self.name!r} in {self.course.label}: {why}")
        return Solution.of(self.name, self.course.module("solutions", self.name))

    @cached_property
    def units(self) -> Mapping[str, str]:
        """Canonical units of the quantities that state one."""
        stated = {n: s.unit for n, s in self.spec.given.items()}
        stated |= {p.quantity: p.unit for p in self.spec.parts}
        return MappingProxyType({**self.solution.units, **stated})

    def symbol(self, name: str) -> str:
        """LaTeX of a quantity of the statement."""
        return self.spec.symbol(name)

    def plan(self, only: Sequence[str] | None = None, *, effects: Iterable[str] = ()) -> tuple[str, ...]:
        """The quantities that a request evaluates, in order."""
        return self.solution.graph.plan(
            self._wanted(only), frozenset(self.spec.given) & self.quantity_names, effects
        )

    def _wanted(self, only: Sequence[str] | str | None) -> tuple[str, ...]:
        if only is None:
            return tuple(dict.fromkeys(p.quantity for p in self.spec.parts if not p.by_request))
        return (only,) if isinstance(only, str) else tuple(only)

    @cached_property
    def quantity_names(self) -> frozenset[str]:
        """Every name that a request may give: computed quantities and what they need."""
        graph = self.solution.graph
        return frozenset(graph.quantities) | graph.leaves

    @cached_property
    def intake(self) -> Intake:
        """Takes in what requests give."""
        return Intake(self)

    def solve(
        self,
        *,
        only: Sequence[str] | str | None = None,
        effects: Iterable[str] = (),
        **given: Any,
    ) -> dict[str, Any]:
        """Quantities from given values, in canonical units (degrees for angles).

        Parameters
        ----------
        only
            The quantities wanted, and nothing else is computed; every part's unless told.
        effects
            Optional effects that the request calls for.
        **given
            Scalars, arrays that broadcast, or texts with a unit (``"0.2286 m"``). Any quantity may be
            given, also one that the graph could compute: then it is used as it is. A list of mappings, such
            as joints, is handed on as a tuple.

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
            only = tuple(p.quantity for p in self.usual_parts(values))
        wanted = self._wanted(only)
        if arrays:
            _check_shapes(values)
        found = self.solution.graph.evaluate(wanted, values, effects)
        if not arrays:
            for name, value in found.items():
                if type(value) is not float:
                    found[name] = value = plain_scalar(value)
                if isinstance(value, float) and value != value:
                    told = ", ".join(f"{n} = {values[n]}" for n in given if n in values)
                    raise Undefined(f"{self.name}: {name} does not exist for {told}")
        return found

    @property
    def film(self) -> Film | None:
        """The animation that the solution states in a picture of its own; none where the course has no solutions."""
        return self.solution.film if self.course.has_solutions else None

    @property
    def is_animated(self) -> bool:
        """Whether there is an animation: a film, or a figure that a driver moves."""
        return self.film is not None or (self.spec.driver is not None and self.spec.figure is not None)

    def driver_angle(self, given: Mapping[str, Any]) -> float:
        """Where the driver stands for these given quantities, degrees.

        Raises
        ------
        BadCourse
            Neither a given quantity nor a helper says it.
        """
        name = self.spec.driver.angle
        if name in given:
            return float(given[name])
        helpers = Graph({f.__name__: f for f in self.spec.helpers})
        if self.spec.driver.poses is None or name not in helpers.quantities:
            raise BadCourse(
                f"{self.name}: its driver's angle {name} is no given quantity; where it is an answer, "
                "a helper of that name says it, and Driver(poses=…) moves the mechanism"
            )
        return float(helpers.evaluate((name,), _known_to(helpers, given))[name])

    def posed(self, given: Mapping[str, Any], angle: Any) -> dict[str, Any]:
        """What places the mechanism with its driver at an angle, degrees, or at each of an array of angles."""
        driver = self.spec.driver
        if driver.poses is None:
            return {driver.angle: angle}
        graph = Graph({**{f.__name__: f for f in self.spec.helpers}, "poses": driver.poses})
        values = _known_to(graph, {**given, "driven": angle})
        return dict(graph.evaluate(("poses",), values)["poses"])

    # ----------------------------------------------------------------- variants

    def variant(self, seed: int, lang: str = "fr", parts: Sequence[str] | None = None) -> Variant:
        """The variant of a seed: the same for ever for this exercise and version.

        ``parts`` are the ids of those that it asks; ``usual`` stands for those that are asked unless told, ``all``
        for every one.

        Raises
        ------
        WrongValue
            A seed that is not a whole number from 0 on.
        UnknownName
            A part that the exercise does not have.
        Starved
            The conditions refuse every draw.
        """
        return self.variants([seed], lang, parts)[0]

    def variants(
        self, seeds: Iterable[int], lang: str = "fr", parts: Sequence[str] | None = None
    ) -> list[Variant]:
        """The variants of many seeds, drawn together."""
        chosen = self.chosen_parts(parts)
        seeds = list(seeds)
        for seed in seeds:
            if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
                raise WrongValue(f"a seed is a whole number from 0 on; found {seed!r}")
        seeds = [int(seed) for seed in seeds]
        drawn = draws.draw(self.name, self.spec, seeds)
        return [Variant(self, seed, given, lang, chosen) for seed, given in zip(seeds, drawn, strict=True)]

    def chosen_parts(self, parts: Sequence[str] | None) -> tuple[Part, ...] | None:
        """Parts by id, in the order of the exercise; None for the usual ones.

        Raises
        ------
        UnknownName
            A part that the exercise does not have.
        """
        if parts is None:
            return None
        known = [*(part.id for part in self.spec.parts), USUAL, ALL]
        for part_id in parts:
            if part_id not in known:
                raise unknown("part", part_id, known, self.name)
        return tuple(
            p
            for p in self.spec.parts
            if ALL in parts or p.id in parts or (USUAL in parts and not p.by_request)
        )

    def from_record(self, record: Mapping[str, Any]) -> Variant:
        """The variant that a record issued, with the values that the record holds.

        A record of an older version keeps its data, its parts and their points, and is solved as the
        exercise is solved now: so a corrected solution marks what was issued before.

        Raises
        ------
        BadInput
            The record is of another exercise or a later version, lacks a given quantity, or asks a
            part that is no more.
        """
        return self._records.variant(record)

    @cached_property
    def _records(self) -> Records:
        return Records(self)

    @cached_property
    def loop_judges(self) -> dict[tuple[str, int, tuple[str, ...]], LoopJudge]:
        """Judges of loop equations, made when the first answer about a loop is marked."""
        return {}

    def usual_parts(self, given: Mapping[str, Any]) -> tuple[Part, ...]:
        """The parts that these given values ask unless others are named."""
        return tuple(p for p in self.spec.parts if not p.by_request and p.is_asked(given))

    # -------------------------------------------------------------------- texts

    @cached_property
    def languages(self) -> tuple[str, ...]:
        """The languages that this exercise has a statement in, among those the engine speaks."""
        return tuple(lang for lang in languages() if self.text_file("exercises", lang).exists())

    def text_file(self, kind: str, lang: str) -> Path:
        """``NAME.LANG.md.j2``, beside the module or inside the exercise's own folder."""
        beside = self.course.root / kind / f"{self.name}.{lang}.md.j2"
        within = self.course.root / kind / self.name / f"{self.name}.{lang}.md.j2"
        return within if within.exists() else beside

    @property
    def unspoken(self) -> dict[str, Path]:
        """By language, a text of the exercise in each that the engine does not speak: nothing reads it."""
        return {
            lang: path
            for kind in ("solutions", "exercises")
            for folder in (self.course.root / kind, self.course.root / kind / self.name)
            for path in sorted(folder.glob(f"{self.name}.*.md.j2"))
            if (lang := path.name.removeprefix(f"{self.name}.").removesuffix(".md.j2")) not in languages()
        }

    def text(self, kind: str, lang: str, variables: Mapping[str, object]) -> statement.Text:
        """The texts of the exercise (``exercises``) or of its solution (``solutions``).

        A solution need not have one: then every section is absent.
        """
        path = self.text_file(kind, lang)
        source = path.relative_to(self.course.root).as_posix()
        if not path.exists() and kind == "solutions":
            return statement.Text("", "", {}, source)
        if not path.exists():
            raise BadCourse(f"{self.name} has no text in {lang!r}: {source} is missing")
        return statement.render(path, self.course.template_folders, variables, source)

    def constants(self, kind: str, lang: str) -> statement.Constants:
        """What of a text is the same for every variant; read once."""
        if (kind, lang) not in self._constants:
            self._constants[kind, lang] = statement.constants(self.text_file(kind, lang))
        return self._constants[kind, lang]

    @cached_property
    def _constants(self) -> dict[tuple[str, str], statement.Constants]:
        return {}

    def is_constant(self, quantity: str, case: str) -> bool:
        """Whether a case is called the same in every variant, in all languages."""
        return all((quantity, case) in self.constants("exercises", one).labels for one in self.languages)

    @cached_property
    def constant_labels(self) -> dict[tuple[str, str], dict[str, list[str]]]:
        """Labels of parts that are the same for every variant, by part and first language, as they are met."""
        return {}

    def title(self, lang: str) -> str:
        """The title, taken from the statement of the first variant."""
        return self.variant(0, lang).text.title


def _check_shapes(values: Mapping[str, Any]) -> None:
    shapes = {n: v.shape for n, v in values.items() if isinstance(v, np.ndarray)}
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        told = ", ".join(f"{n} {shape}" for n, shape in shapes.items())
        raise WrongValue(f"the arrays do not broadcast together: {told}") from None


def _known_to(graph: Graph, values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name in graph.leaves}
