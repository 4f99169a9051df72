"""A course is a folder: ``exercises/``, ``solutions/``, ``templates/`` side by side.

Nothing is registered: the stem of ``exercises/NAME.py`` is the exercise's name everywhere. Opening a
course imports its Python, as any import does, under a private package name; ``sys.path`` is left alone.
"""

from __future__ import annotations

import importlib
import inspect
import itertools
import json
import math
import sys
import tomllib
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache, cached_property
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework import draws, statement
from coursework.errors import (
    BadCourse,
    BadInput,
    CourseworkError,
    NoSolution,
    Undefined,
    WrongUnit,
    WrongValue,
    nearest,
    unknown,
)
from coursework.graph import Graph, plain_scalar
from coursework.language import languages, localise, plain, significant, with_unit, words
from coursework.model import Exercise, GivenSpec, Part
from coursework.rules import Rules
from coursework.solution import Solution

if TYPE_CHECKING:
    from coursework.constructions import Construction
    from coursework.figures import Figure
    from coursework.handout import AnswerSheet, Handout
    from coursework.key import Key
    from coursework.loop_marking import LoopJudge
    from coursework.marking import Marking
    from coursework.motion import Animation
    from coursework.rendering import Renderer
    from coursework.selfstudy.sheet import StudySheet

_packages = itertools.count()

USUAL, ALL = "usual", "all"  #: what stands for several parts where parts are named


def builtin_root() -> Path:
    """The folder of the course that ships with the package, in a wheel or in a checkout."""
    shipped = Path(__file__).parent / "_course"
    return shipped if shipped.is_dir() else Path(__file__).parent.parent


def open_course(folder: str | Path | None = None) -> Course:
    """Open a course folder; the built-in course unless told.

    Raises
    ------
    BadCourse
        The folder does not exist or has no ``exercises/``.
    """
    root = (builtin_root() if folder is None else Path(folder)).resolve()
    return _open(root)


@cache
def _open(root: Path) -> Course:
    if not root.is_dir():
        raise BadCourse(f"no course at {root}: there is no such folder; 'coursework new DIR' makes one")
    if not (root / "exercises").is_dir():
        raise BadCourse(f"{root} is no course: it has no folder 'exercises'; 'coursework new DIR' makes one")
    return Course(root)


class Course:
    """An open course: a mapping from names to exercises."""

    def __init__(self, root: Path):
        self.root = root
        self._package = f"_coursework_course_{next(_packages)}"
        package = ModuleType(self._package)
        package.__path__ = [str(root)]
        sys.modules[self._package] = package
        self._exercises: dict[str, CourseExercise] = {}

    def __repr__(self) -> str:
        return f"<course {self.root.name}: {len(self.names)} exercises>"

    @property
    def label(self) -> str:
        """What messages call it."""
        return "the built-in course" if self.root == builtin_root().resolve() else f"course {self.root.name}"

    @property
    def names(self) -> tuple[str, ...]:
        """The exercises' names, in alphabetical order, as the folder holds them now."""
        folder = self.root / "exercises"
        files = {p.stem for p in folder.glob("*.py")}
        folders = {p.parent.name for p in folder.glob("*/__init__.py")}
        return tuple(sorted(n for n in files | folders if n.isidentifier() and not n.startswith("_")))

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __len__(self) -> int:
        return len(self.names)

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> CourseExercise:
        if name not in self._exercises:
            if name not in self.names:
                raise unknown("exercise", name, self.names, self.label)
            self._exercises[name] = CourseExercise(self, name)
        return self._exercises[name]

    @cached_property
    def settings(self) -> Mapping[str, Any]:
        """What ``exercises/course.toml`` says, or nothing."""
        path = self.root / "exercises" / "course.toml"
        if not path.exists():
            return {}
        try:
            return tomllib.loads(path.read_text("utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as fault:
            raise BadCourse(f"{path}: {fault}") from fault

    @cached_property
    def rules(self) -> Rules:
        """How the course marks."""
        source = str(self.root / "exercises" / "course.toml")
        return Rules.of(self.settings.get("marking", {}), source)

    def title(self, lang: str) -> str:
        """The course's title in a language; the folder's name when it states none."""
        titles = self.settings.get("title", {})
        if not isinstance(titles, dict):
            raise BadCourse(f'{self.root / "exercises" / "course.toml"}: write [title], then {lang} = "…"')
        return str(titles.get(lang, self.root.name))

    @cached_property
    def template_folders(self) -> tuple[Path, ...]:
        """Where templates are looked up: this course first, then the built-in one."""
        folders = dict.fromkeys([self.root / "templates", builtin_root() / "templates"])
        return tuple(f for f in folders if f.is_dir())

    @cached_property
    def renderer(self) -> Renderer:
        """Renders this course's sheets."""
        from coursework.rendering import Renderer

        return Renderer(self.template_folders)

    @property
    def lessons(self) -> tuple[str, ...]:
        """Names of the lessons, ``exercises/lessons/NAME.LANG.md``, in alphabetical order."""
        return tuple(sorted({p.name.split(".")[0] for p in self._lesson_folder.glob("*.*.md")}))

    @property
    def _lesson_folder(self) -> Path:
        return self.root / "exercises" / "lessons"

    def lesson(self, name: str, lang: str) -> str:
        """A lesson as a notebook (JSON).

        Raises
        ------
        UnknownName
            No such lesson.
        BadCourse
            The lesson is not written in this language.
        """
        if name not in self.lessons:
            raise unknown("lesson", name, self.lessons, self.label)
        path = self._lesson_folder / f"{name}.{lang}.md"
        if not path.exists():
            raise BadCourse(f"the lesson {name} has no text in {lang!r}: {path.name} is missing")
        return self.renderer.lesson(name, path.read_text("utf-8"), lang)

    @property
    def has_solutions(self) -> bool:
        """False for a students' copy."""
        return (self.root / "solutions").is_dir()

    def module(self, kind: str, name: str) -> ModuleType:
        """Import ``KIND/NAME.py`` of this course.

        Raises
        ------
        BadCourse
            The file cannot be imported; the message names the file, the line and the fault.
        """
        try:
            return importlib.import_module(f"{self._package}.{kind}.{name}")
        except CourseworkError as fault:
            raise BadCourse(f"{kind}/{name}.py: {fault}") from fault
        except Exception as fault:
            raise BadCourse(f"{kind}/{name}.py cannot be used: {_where(fault, self.root)}") from fault


def _where(fault: Exception, root: Path) -> str:
    """The fault in one line, with the last line of the course's own code on its way."""
    said = f"{type(fault).__name__}: {fault}"
    if isinstance(fault, SyntaxError):
        return f"line {fault.lineno}: {fault.msg}"
    frames = [f for f in traceback.extract_tb(fault.__traceback__) if f.filename.startswith(str(root))]
    return f"line {frames[-1].lineno}: {said}" if frames else said


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

    @property
    def version(self) -> int:
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
        return self.solution.graph.plan(self._wanted(only), self._used_given(effects), effects)

    def _used_given(self, effects: Iterable[str]) -> frozenset[str]:
        return frozenset(self.spec.given) & self.quantity_names

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
    def _looked_at(self) -> frozenset[str]:
        """Given quantities that are not any number: their values are looked at one by one."""
        specs = self.spec.given.items()
        return frozenset(n for n, s in specs if s.positive or s.nonzero or s.is_choice)

    @cached_property
    def _defaults(self) -> Mapping[str, float | str]:
        return {
            n: float(s.default) if not isinstance(s.default, str) else s.default
            for n, s in self.spec.given.items()
            if s.default is not None
        }

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
        values = self.accepted(given)
        arrays = any(isinstance(v, np.ndarray) for v in values.values())
        if only is None and not arrays:
            only = tuple(p.quantity for p in self._asked_of(values))
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

    def accepted(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """What a request gives, as the solution takes it: in canonical units, with defaults.

        Errors are those of :meth:`solve` for a request that makes no sense.
        """
        names = self.quantity_names
        values = {n: v for n, v in self._defaults.items() if n in names}
        for name, value in given.items():
            if name not in names:
                if name in self.spec.given:
                    continue
                raise unknown("quantity", name, names | self.spec.given.keys(), self.name)
            # The usual case at once: a plain number that nothing forbids.
            plainly = type(value) is float and value - value == 0 and name not in self._looked_at
            values[name] = value if plainly else self._accept(name, value)
        return values

    def _accept(self, name: str, value: Any) -> Any:
        """A given value as a float, an array or a case's name, in the canonical unit, within its domain."""
        if name in self.solution.structures:
            return _structure(name, value)
        spec = self.spec.given.get(name)
        if type(value) is float and value > 0 and value < math.inf and (spec is None or not spec.choices):
            return value
        if spec is not None and spec.is_choice:
            return self._accept_case(name, spec, value)
        if isinstance(value, str):
            value = self._accept_text(name, value)
        elif type(value) is not float:
            value = self._accept_numbers(name, value)
        if isinstance(value, float) and not math.isfinite(value):
            raise WrongValue(f"{name} must be a finite number; found {value}")
        if spec is not None:
            self._check_domain(name, spec, value)
        return value

    def _accept_numbers(self, name: str, value: Any) -> Any:
        """A float, a complex number or an array of them from whatever numpy can make one."""
        try:
            array = np.asarray(value)
        except ValueError:
            array = np.asarray(None)
        if array.dtype.kind not in "iufc" or isinstance(value, bool):
            raise WrongValue(f"{name} must be a number or an array of numbers; found {str(value)[:60]!r}")
        if array.dtype.kind == "c" and name in self.spec.given:
            raise WrongValue(f"{name} must be a real number; found {str(value)[:60]!r}")
        if array.dtype.kind in "iu":
            array = array.astype(float)
        return array if array.ndim else array.item()

    def _accept_case(self, name: str, spec: GivenSpec, value: Any) -> Any:
        for case in np.unique(np.asarray(value, dtype=str)).tolist():
            if case not in spec.choices:
                raise WrongValue(
                    f"{name} must be one of {', '.join(spec.choices)}; found {case!r}"
                    f"{nearest(str(case), spec.choices)}"
                )
        return value if isinstance(value, str) else np.asarray(value)

    def _accept_text(self, name: str, text: str) -> float:
        from coursework.reading import read_number

        unit = self.units.get(name, "1")
        reading = read_number(text, unit)
        if reading.status == "wrong_unit":
            raise WrongUnit(f"{name} is in {unit}; found {text!r}, which is not a unit of that kind")
        if reading.status != "read":
            raise WrongValue(f"{name} must be a number in {unit}; found {text!r}")
        if len(reading.values) > 1:
            shown = " or ".join(plain(v) for v in reading.values)
            raise WrongValue(f"{name}: {text!r} can be read as {shown}; write it without a separator")
        return reading.values[0]

    def _check_domain(self, name: str, spec: GivenSpec, value: Any) -> None:
        if isinstance(value, np.ndarray):
            if spec.positive and value.size and np.nanmin(value) <= 0:
                raise WrongValue(f"{name} must be positive; found {np.nanmin(value):g} {spec.unit}")
            if spec.nonzero and not value.all():
                raise WrongValue(f"{name} must not be 0")
        elif isinstance(value, float):
            if spec.positive and value <= 0:
                raise WrongValue(f"{name} must be positive; found {value:g} {spec.unit}")
            if spec.nonzero and value == 0:
                raise WrongValue(f"{name} must not be 0")

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
        if record.get("exercise") != self.name:
            raise BadInput(f"a record of {record.get('exercise')!r} was given to {self.name!r}")
        version = record.get("version")
        if not isinstance(version, int) or version > self.version:
            raise BadInput(
                f"{self.name}: the record is of version {version}, the course has version {self.version}; "
                "mark it with the course it was issued from"
            )
        try:
            given = {n: record["given"][n]["value"] for n in self.spec.given}
            seed = int(record["seed"])
            asked = {str(part["id"]): float(part["points"]) for part in record["parts"]}
        except (KeyError, TypeError, ValueError) as fault:
            raise BadInput(f"{self.name}: a record lacks {fault}") from fault
        for name, value in given.items():
            self._check_recorded(name, value)
        parts = self._parts_of(tuple(asked.items()), version < self.version)
        variant = Variant(self, seed, given, str(record.get("lang", "fr")), parts)
        if version < self.version:
            variant.__dict__["record"] = dict(record)
        return variant

    def _parts_of(self, asked: tuple[tuple[str, float], ...], older: bool) -> tuple[Part, ...]:
        """The parts that a record asks, by id; those of an older version are worth what they were then."""
        if (asked, older) not in self._recorded_parts:
            points = dict(asked)
            gone = [i for i in points if self.spec.part(i) is None]
            if gone:
                raise BadInput(
                    f"{self.name}: a record of {'an older' if older else 'this'} version asks {gone[0]!r}, which the "
                    f"course {'no longer has' if older else 'does not have'}; mark it with the course it was issued from"
                )
            found = tuple(p for p in self.spec.parts if p.id in points)
            if older:
                found = tuple(replace(p, points=points[p.id]) for p in found)
            self._recorded_parts[asked, older] = found
        return self._recorded_parts[asked, older]

    @cached_property
    def _recorded_parts(self) -> dict[tuple[tuple[tuple[str, float], ...], bool], tuple[Part, ...]]:
        """Remembered, since records of one build ask the same."""
        return {}

    @cached_property
    def loop_judges(self) -> dict[tuple[str, int, tuple[str, ...]], LoopJudge]:
        """Judges of loop equations, made when the first answer about a loop is marked."""
        return {}

    def _check_recorded(self, name: str, value: Any) -> None:
        spec = self.spec.given[name]
        fits = value in spec.choices if spec.is_choice else isinstance(value, (int, float))
        if not fits or isinstance(value, bool):
            raise BadInput(f"{self.name}: a record gives {name} = {value!r}, which is no value of it")

    def _asked_of(self, given: Mapping[str, Any]) -> tuple[Part, ...]:
        return _asked((p for p in self.spec.parts if not p.by_request), given)

    # -------------------------------------------------------------------- texts

    @cached_property
    def languages(self) -> tuple[str, ...]:
        """The languages that this exercise has a statement in, among those the engine speaks."""
        return tuple(lang for lang in languages() if self._text_file("exercises", lang).exists())

    def _text_file(self, kind: str, lang: str) -> Path:
        """``NAME.LANG.md.j2``, beside the module or inside the exercise's own folder."""
        beside = self.course.root / kind / f"{self.name}.{lang}.md.j2"
        within = self.course.root / kind / self.name / f"{self.name}.{lang}.md.j2"
        return within if within.exists() else beside

    def text(self, kind: str, lang: str, variables: Mapping[str, object]) -> statement.Text:
        """The texts of the exercise (``exercises``) or of its solution (``solutions``).

        A solution need not have one: then every section is absent.
        """
        path = self._text_file(kind, lang)
        if not path.exists() and kind == "solutions":
            return statement.Text("", "", {}, path.name)
        if not path.exists():
            raise BadCourse(f"{self.name} has no text in {lang!r}: {kind}/{path.name} is missing")
        return statement.render(path, self.course.template_folders, variables)

    def constants(self, kind: str, lang: str) -> statement.Constants:
        """What of a text is the same for every variant; read once."""
        if (kind, lang) not in self._constants:
            self._constants[kind, lang] = statement.constants(self._text_file(kind, lang))
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


def _structure(name: str, value: Any) -> Any:
    """A list or a record as it comes, or from its JSON."""
    if not isinstance(value, str):
        return tuple(value) if isinstance(value, list) else value
    try:
        return _structure(name, json.loads(value))
    except ValueError:
        raise WrongValue(f"{name} is a list of records, or its JSON; found {value[:60]!r}") from None


def _rounded(value: Any, lang: str) -> Any:
    """A number as running text; a list of records as it is, for the text to go through."""
    if isinstance(value, tuple):
        return value
    return localise(significant(value), lang) if isinstance(value, (int, float)) else str(value)


@cache
def _parameters(function: Callable[..., Any]) -> tuple[str, ...]:
    return tuple(inspect.signature(function).parameters)


def _asked(parts: Iterable[Part], given: Mapping[str, Any]) -> tuple[Part, ...]:
    return tuple(p for p in parts if p.when is None or _holds(p, given))


def _holds(part: Part, given: Mapping[str, Any]) -> bool:
    """Whether a part is asked with these values; so too when they do not tell."""
    names = _parameters(part.when)
    if any(n not in given for n in names):
        return True
    return bool(part.when(*[given[n] for n in names]))


def _known_to(graph: Graph, values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name in graph.leaves}


class Variant:
    """One student's version of an exercise."""

    def __init__(
        self,
        exercise: CourseExercise,
        seed: int,
        given: Mapping[str, Any],
        lang: str,
        parts: Sequence[Part] | None = None,
    ):
        if lang not in languages():
            raise unknown("language", lang, languages())
        self.exercise = exercise
        self.seed = seed
        self.lang = lang
        self.chosen = parts  #: the parts to ask, where they are not the usual ones
        self.given: Mapping[str, Any] = MappingProxyType(dict(given))  #: canonical units, as printed

    def __repr__(self) -> str:
        return f"<variant {self.exercise.name} {self.seed}>"

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The parts that this variant asks."""
        return self.exercise._asked_of(self.given) if self.chosen is None else _asked(self.chosen, self.given)

    @property
    def part_ids(self) -> tuple[str, ...]:
        return tuple(part.id for part in self.parts)

    @cached_property
    def record(self) -> dict[str, Any]:
        """The JSON record: what is issued, stored and marked against; no answer in it."""
        spec = self.exercise.spec
        return {
            "exercise": self.exercise.name,
            "version": spec.version,
            "seed": self.seed,
            "lang": self.lang,
            "given": {n: {"value": v, "unit": spec.given[n].unit} for n, v in self.given.items()},
            "parts": [
                {"id": p.id, "quantity": p.quantity, "unit": p.unit, "kind": p.kind, "points": p.points}
                for p in self.parts
            ],
        }

    def in_language(self, lang: str) -> Variant:
        """The same variant on a sheet in another language."""
        return Variant(self.exercise, self.seed, self.given, lang, self.chosen)

    def solution(self) -> dict[str, Any]:
        """The asked quantities in canonical units and full precision."""
        return self.exercise.solve(**self.given, only=self.asked_quantities, effects=self.effects)

    @property
    def effects(self) -> tuple[str, ...]:
        """The optional effects that the parts call for."""
        return self.exercise.spec.effects

    @property
    def asked_quantities(self) -> tuple[str, ...]:
        """The quantities of the parts, and those that parts are judged with."""
        along = (p.along for p in self.parts if p.along)
        return tuple(dict.fromkeys([*(p.quantity for p in self.parts), *along]))

    @cached_property
    def text(self) -> statement.Text:
        """The statement's sections in this variant's language."""
        return self.exercise.text("exercises", self.lang, self.printed)

    @property
    def printed(self) -> dict[str, Any]:
        """Given values as running text, for the texts: ``228,6 mm``; then what the exercise tells besides."""
        spec = self.exercise.spec
        shown: dict[str, Any] = {
            n: str(v) if spec.given[n].is_choice else with_unit(plain(v), spec.given[n].unit, self.lang)
            for n, v in self.given.items()
        }
        if spec.tells is not None:
            shown |= spec.tells(*[self.given[n] for n in _parameters(spec.tells)])
        return shown

    @cached_property
    def used(self) -> dict[str, Any]:
        """The given quantities that the solution knows."""
        return {n: v for n, v in self.given.items() if n in self.exercise.quantity_names}

    @cached_property
    def found(self) -> dict[str, Any]:
        """Every quantity met on the way to the asked ones, of this variant alone, as the solution gives it;
        hidden ones too.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        graph = self.exercise.solution.graph
        return graph.everything(self.asked_quantities, self.used, self.effects)

    @cached_property
    def walk(self) -> dict[str, Any]:
        """The given quantities, then every one met on the way to the asked ones, in order.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        given = {n: v for n, v in self.given.items() if n in self.exercise.quantity_names}
        found = self.exercise.solution.graph.evaluate_all(self.asked_quantities, given, self.effects)
        return {**given, **{n: plain_scalar(v) for n, v in found.items()}}

    @cached_property
    def solution_text(self) -> statement.Text:
        """The sections of the solution's words; any quantity of the walk may stand in them, rounded."""
        rounded = {n: _rounded(v, self.lang) for n, v in self.walk.items()}
        return self.exercise.text("solutions", self.lang, {**rounded, **self.printed})

    def labels(self, part: Part) -> dict[str, list[str]]:
        """What each case of a choice is called, in every language; nothing for another kind."""
        known = self.exercise.constant_labels
        place = (part.id, self.lang)
        if place not in known:
            found = {case: [*self._called(part.id, case)] for case in part.choices}
            if not all(self.exercise.is_constant(part.id, case) for case in part.choices):
                return found
            known[place] = found
        return known[place]

    def _called(self, part: str, case: str) -> Iterator[str]:
        """The labels of a case, and each without its article."""
        for lang in self._langs:
            yield (label := self.label(part, case, lang))
            for article in words(lang)["choices"]["articles"]:
                start = article if article.endswith("'") else f"{article} "
                if label.replace("’", "'").lower().startswith(start):
                    yield label[len(start) :]

    @property
    def _langs(self) -> tuple[str, ...]:
        """Every language of the exercise, this variant's first."""
        return (self.lang, *(lang for lang in self.exercise.languages if lang != self.lang))

    def label(self, quantity: str, case: str, lang: str = "") -> str:
        """What a case is called, in this variant's language unless told."""
        lang = lang or self.lang
        label = self.exercise.constants("exercises", lang).labels.get((quantity, case))
        if label is not None:
            return label
        return (self.text if lang == self.lang else self.in_language(lang).text).label(quantity, case)

    def told(self, mistake: str) -> str:
        """What to say to who made a named mistake."""
        name = f"mistake {mistake}"
        text = self.exercise.constants("solutions", self.lang).texts.get(name)
        return self.solution_text.section(name).text if text is None else text

    @cached_property
    def key(self) -> Key:
        """What the variant's answers are marked by."""
        from coursework.key import Key

        return Key(self)

    def grade(self, answers: Mapping[str, Any]) -> Marking:
        """Mark a student's answers, by part id.

        Raises
        ------
        UnknownName
            An answer to a part that this variant does not ask.
        """
        from coursework.marking import mark

        return mark(self, answers)

    @cached_property
    def figure(self) -> Figure | None:
        """The figure to scale: laid out once, shown on every sheet of the variant."""
        from coursework.sheets import figure

        return figure(self)

    def animation(self, effects: Sequence[str] = (), count: int = 72) -> Animation:
        """The mechanism over the cycle of its driver; see :class:`~coursework.motion.Animation`."""
        from coursework.motion import Animation

        return Animation(self, effects, count)

    def polygons(self) -> tuple[Construction, ...]:
        """The velocity and acceleration polygons that the solution states, drawn to scale.

        None where it states none, and none in which nothing moves.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        return self._polygons

    @cached_property
    def _polygons(self) -> tuple[Construction, ...]:
        from coursework.sheets import polygons

        return polygons(self)

    def handout(self, student: str = "") -> Handout:
        """What the student's sheet shows."""
        from coursework.sheets import handout

        return handout(self, student)

    def study_sheet(self, student: str = "") -> StudySheet:
        """What the self-study notebook of this variant shows."""
        from coursework.selfstudy.sheet import study_sheet

        return study_sheet(self, student)

    def answer_sheet(self, student: str = "") -> AnswerSheet:
        """The handout with its answers and worked solution."""
        from coursework.sheets import answer_sheet

        return answer_sheet(self, student)
