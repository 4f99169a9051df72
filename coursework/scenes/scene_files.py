"""Scene files: TOML, every value with its unit.

::

    exercise = "my_shaper"
    seed = 7
    effects = ["load", "inertia", "friction"]
    show = ["drive_torque", "reaction D"]

    [bodies.8]
    mass = "12 kg"

    [[loads]]
    on = "G"
    force = "800 N"
    against = "motion"
    during = "working stroke"

    [friction]
    G = 0.12
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.errors import BadInput, CourseworkError, nearest, unknown
from coursework.mechanics.loads import STROKES
from coursework.mechanics.statement import Load, Place
from coursework.mechanics.wrenches import GRAVITY
from coursework.messages import as_message
from coursework.parsing.numbers import read_number
from coursework.parsing.units import same_dimension
from coursework.scenes.added import BodyMass, Flywheel, Motor, SceneData
from coursework.scenes.effects import REFUSED, check_effect, check_turns, refusal
from coursework.scenes.scenes import Scene
from coursework.system.toml_files import TomlReader, source_of, table_of

_KEYS = (
    "exercise",
    "seed",
    "given",
    "effects",
    "over",
    "steps",
    "drive",
    "duration",
    "show",
    "gravity",
    "bodies",
    "loads",
    "friction",
    "slides",
    "flywheel",
)
_STEPS = 360
_BARE = re.compile(r"\s*[+-]?\d+([.,]\d*)?(e[+-]?\d+)?\s*", re.IGNORECASE)  #: a number that says no unit
_EXAMPLES = {"drive": 'drive = { torque = "5 N*m" }', "gravity": 'gravity = { acceleration = "9.8 m/s^2" }'}

Path_ = tuple[str | int, ...]


@dataclass(frozen=True)
class SceneFile:
    """Scene with its run: over a cycle in a number of steps, or in time under a drive."""

    name: str
    scene: Scene
    steps: int = _STEPS
    drive: Motor | None = None
    duration: float = 1.0


def read_scene(path: Path, course: Course) -> SceneFile:
    """Read a scene file.

    Raises
    ------
    BadInput
        It cannot be read, or says what makes no sense: with the line, and the nearest right name.
    """
    source = source_of(path)
    try:
        table = table_of(source, str(path))
    except BadInput as fault:
        raise BadInput(
            '{problem}; a value with a unit is a text: mass = "3 kg"', problem=as_message(fault)
        ) from fault
    return _SceneReader(path, source, table, course).scene_file()


class _SceneReader(TomlReader):
    """Reader of the tables of a scene."""

    def __init__(self, path: Path, source: str, table: Mapping[str, Any], course: Course) -> None:
        super().__init__(path, source)
        self.table, self.course = table, course

    def scene_file(self) -> SceneFile:
        self._only(self.table, _KEYS, ())
        exercise = self._exercise()
        run: dict[str, Any] = {}
        drive = self._drive(exercise)
        if drive is not None:
            run = {"drive": drive, "duration": self._duration()}
        elif "duration" in self.table:
            raise self.refused(("duration",), 'a duration needs a drive: drive = { torque = "5 N*m" }')
        return SceneFile(self.path.stem, self._scene(exercise), self._steps(), **run)

    def _duration(self) -> float:
        duration = self._amount(("duration",), "s", 1.0)
        if not duration > 0:
            raise self.refused(("duration",), "a duration is above 0; found {found:g} s", found=duration)
        return float(duration)

    def _scene(self, exercise: CourseExercise) -> Scene:
        effects, show = (self._words(key) for key in ("effects", "show"))
        for number, effect in enumerate(effects):
            self._with_line(("effects",), check_effect, effect, exercise)
            if effect in effects[:number]:
                raise self.refused(("effects",), "the effect {effect!r} is named twice", effect=effect)
        given = self._given(exercise)
        added = self._added(exercise)
        self._check_names(exercise)
        self._with_line(("exercise",), Scene, exercise, given, effects, (), added)
        for name in show:
            self._with_line(("show",), Scene, exercise, given, effects, (name,), added)
        for name, value in added.friction.items():
            friction_scene = Scene(exercise, given, ("friction",), (), SceneData(friction={name: value}))
            self._with_line(("friction", name), getattr, friction_scene, "contacts")
        return Scene(exercise, given, effects, show, added)

    def _check_names(self, exercise: CourseExercise) -> None:
        """Check every name that the mechanism must know, whichever effects are requested."""
        mechanism = exercise.solution.mechanism
        if mechanism is None:
            return
        for name in self._table(("bodies",)):
            self._checked_name(("bodies", name), "body", name, mechanism.names)
            if isinstance(centre := self._at(("bodies", name, "centre")), str):
                self._checked_name(
                    ("bodies", name, "centre"), "point", centre, tuple(mechanism.body(name).places)
                )
        known_names = (*mechanism.points, *mechanism.names)
        for number, load in enumerate(self._loads_listed):
            on = str(load.get("on", ""))
            self._checked_name(("loads", number, "on"), "point or body", on, known_names)
            if "body" in load:
                self._checked_name(
                    ("loads", number, "body"), "body", str(load["body"]), mechanism.holders(on)
                )
        slides = [slide.at for slide in mechanism.slides]
        for name in self._table(("slides",)):
            self._checked_name(("slides", name), "slide", name, slides)

    def _with_line(self, at: Path_, function: Any, *arguments: Any) -> Any:
        """Call a function, and add the line to its errors."""
        try:
            return function(*arguments)
        except BadInput:
            raise
        except CourseworkError as fault:
            raise self.refused(at, as_message(fault)) from fault

    def _checked_name(self, at: Path_, kind: str, name: str, names: Sequence[str]) -> None:
        if name not in names:
            raise self.refused(at, as_message(unknown(kind, name, names)))

    # -------------------------------------------------------------------- values

    def _only(self, table: Mapping[str, Any], names: Sequence[str], at: Path_) -> None:
        for key in table:
            if key in REFUSED:
                raise self.refused((*at, key), refusal(key))
        self.only(table, names, at)

    def _at(self, at: Path_) -> Any:
        """Return the value at a path; None where there is none."""
        result: Any = self.table
        for part in at:
            try:
                result = result[part]
            except (KeyError, IndexError, TypeError):
                return None
        return result

    def _table(self, at: Path_) -> Mapping[str, Any]:
        result = self._at(at)
        if result is None:
            return {}
        if not isinstance(result, Mapping):
            example = f": {_EXAMPLES[str(at[-1])]}" if str(at[-1]) in _EXAMPLES else ""
            raise self.refused(
                at, "{key} is a table{example}; found {found!r}", key=at[-1], example=example, found=result
            )
        return result

    def _words(self, key: str) -> tuple[str, ...]:
        result = self.table.get(key, [])
        if not isinstance(result, list) or not all(isinstance(word, str) for word in result):
            raise self.refused(
                (key,), '{key} is a list of words: ["…", "…"]; found {found!r}', key=key, found=result
            )
        return tuple(result)

    def _amount(self, at: Path_, unit: str, otherwise: Any = None) -> Any:
        """Return a number that stands with its unit, in the given unit."""
        result = self._at(at)
        return otherwise if result is None else self._number(at, result, unit)

    def _number(self, at: Path_, result: Any, unit: str) -> float:
        is_bare = isinstance(result, (int, float)) and not isinstance(result, bool) and math.isfinite(result)
        if is_bare and unit == "1":
            return float(result)
        if is_bare or (isinstance(result, str) and unit != "1" and _BARE.fullmatch(result)):
            raise self.refused(
                at,
                '{key} has a unit: {key} = "{found} {unit}"; found {found!r}',
                key=at[-1],
                found=result,
                unit=unit,
            )
        reading = read_number(result, unit) if isinstance(result, str) else None
        if reading is not None and reading.status == "read" and len(reading.values) == 1:
            return reading.values[0]
        if unit == "1":
            raise self.refused(at, "{key} is a number; found {found!r}", key=at[-1], found=result)
        raise self.refused(
            at, "{key} is a number in {unit}; found {found!r}", key=at[-1], unit=unit, found=result
        )

    # -------------------------------------------------------------------- tables

    def _exercise(self) -> CourseExercise:
        name = self.table.get("exercise")
        if not isinstance(name, str):
            raise BadInput(
                '{path} names no exercise; write exercise = "…": {names}, …',
                path=self.path,
                names=", ".join(self.course.names[:4]),
            )
        self._checked_name(("exercise",), "exercise", name, self.course.names)
        return self.course[name]

    def _given(self, exercise: CourseExercise) -> dict[str, Any]:
        """Return the values of a variant, overridden by those of the file."""
        seed = self.table.get("seed", 0)
        results = dict(self._with_line(("seed",), exercise.variant, seed).given)
        for name, value in self._table(("given",)).items():
            if name not in exercise.spec.given:
                raise self.refused(
                    ("given", name),
                    "{owner} has no given quantity {name!r}{nearest}",
                    owner=exercise.name,
                    name=name,
                    nearest=nearest(name, exercise.spec.given),
                )
            unit = exercise.units.get(name, "1")
            if isinstance(value, (int, float)) and not isinstance(value, bool) and unit != "1":
                self._number(("given", name), value, unit)
            results[name] = self._with_line(("given", name), exercise.intake.value, name, value)
        return results

    def _steps(self) -> int:
        steps = self.table.get("steps", _STEPS)
        if isinstance(steps, bool) or not isinstance(steps, int) or steps < 1:
            raise self.refused(("steps",), "steps is a whole number from 1 on; found {found!r}", found=steps)
        if self.table.get("over", "cycle") != "cycle":
            raise self.refused(
                ("over",),
                '{key} is "{only}"; found {found!r}',
                key="over",
                only="cycle",
                found=self.table["over"],
            )
        return steps

    def _drive(self, exercise: CourseExercise) -> Motor | None:
        if "drive" not in self.table:
            return None
        self._with_line(("drive",), check_turns, "a torque in time", exercise)
        for key in ("over", "steps"):
            if key in self.table:
                raise self.refused(
                    (key,),
                    "{key} applies to a cycle, and with a drive the motion runs in time: leave one out",
                    key=key,
                )
        self._only(self._table(("drive",)), ("torque", "no_load_speed"), ("drive",))
        torque = self._amount(("drive", "torque"), "N*m")
        if torque is None:
            raise self.refused(("drive",), 'a drive has a torque: drive = { torque = "5 N*m" }')
        speed = self._amount(("drive", "no_load_speed"), "rad/s")
        return self._with_line(("drive", "no_load_speed"), Motor, torque, speed)

    def _added(self, exercise: CourseExercise) -> SceneData:
        bodies = {name: self._body(name) for name in self._table(("bodies",))}
        loads = tuple(self._load(number, exercise) for number in range(len(self._loads_listed)))
        friction = {name: self._friction(name) for name in self._table(("friction",))}
        lengths = {}
        for name in self._table(("slides",)):
            self._only(self._table(("slides", name)), ("length",), ("slides", name))
            lengths[name] = self._amount(("slides", name, "length"), "mm", 0.0)
        return SceneData(bodies, loads, friction, lengths, self._flywheel(), self._gravity())

    def _body(self, name: str) -> BodyMass:
        at = ("bodies", name)
        self._only(self._table(at), ("mass", "inertia", "centre"), at)
        centre: Any = self._at((*at, "centre"))
        if isinstance(centre, list) and len(centre) == 2:
            x, y = (self._number((*at, "centre"), value, "mm") for value in centre)
            centre = complex(x, y)
        elif centre is not None and not isinstance(centre, str):
            raise self.refused(
                (*at, "centre"),
                'centre is a point, or ["x mm", "y mm"] in the body; found {found!r}',
                found=centre,
            )
        mass, inertia = self._amount((*at, "mass"), "kg"), self._amount((*at, "inertia"), "kg*m^2")
        for key, value in (("mass", mass), ("inertia", inertia)):
            if value is not None and value < 0:
                raise self.refused((*at, key), "{key} is not negative; found {found:g}", key=key, found=value)
        return BodyMass(mass, inertia, centre)

    @property
    def _loads_listed(self) -> list[Mapping[str, Any]]:
        result = self.table.get("loads", [])
        if not isinstance(result, list) or not all(isinstance(load, Mapping) for load in result):
            raise self.refused(
                ("loads",), "loads are a list of tables, each headed by [[loads]], in double brackets"
            )
        return result

    def _load(self, number: int, exercise: CourseExercise) -> Load:
        at: Path_ = ("loads", number)
        listed = self._loads_listed[number]
        self._only(listed, ("on", "body", "force", "moment", "angle", "against", "during", "by", "table"), at)
        if "on" not in listed:
            raise self.refused(at, 'a load acts on something: on = "C"')
        self._refuse_idle(at, listed)
        kind = "moment" if "moment" in listed or self._is_body(exercise, str(listed["on"])) else "force"
        if listed.get("against", "motion") != "motion":
            raise self.refused(
                (*at, "against"),
                '{key} is "{only}"; found {found!r}',
                key="against",
                only="motion",
                found=listed["against"],
            )
        during = str(listed.get("during", "always"))
        if during not in STROKES:
            raise self.refused(
                (*at, "during"),
                "during is one of {names}; found {found!r}{nearest}",
                names=", ".join(STROKES),
                found=during,
                nearest=nearest(during, STROKES),
            )
        if "stroke" in during:
            self._with_line((*at, "during"), check_turns, f"the {during}", exercise)
        values: dict[str, Place] = {kind: self._size(at, kind, exercise)}
        if "angle" in listed:
            values["angle"] = self._amount((*at, "angle"), "deg")
        by = str(listed.get("by", ""))
        body = str(listed.get("body", ""))
        pairs = self._pairs(at, kind, by, exercise)
        if kind == "force" and not {"angle", "against"} & listed.keys():
            raise self.refused(
                at, 'a force has a direction: angle = "180 deg", from the x axis, or against = "motion"'
            )
        return Load(
            str(listed["on"]),
            against="against" in listed,
            during=during,
            by=by,
            table=pairs,
            body=body,
            **values,
        )

    def _refuse_idle(self, at: Path_, values: Mapping[str, Any]) -> None:
        """Refuse a key that has no effect beside another one."""
        for key, other in (
            ("force", "moment"),
            ("table", "force"),
            ("table", "moment"),
            ("angle", "against"),
            ("angle", "moment"),
            ("body", "moment"),
        ):
            if key in values and other in values:
                raise self.refused((*at, key), "a load has {key} or {other}, not both", key=key, other=other)
        if "by" in values and "table" not in values:
            raise self.refused(
                (*at, "by"),
                "by names the variable of a table, and the load has no table: table = [[…, …], […, …]]",
            )

    @staticmethod
    def _is_body(exercise: CourseExercise, name: str) -> bool:
        mechanism = exercise.solution.mechanism
        return mechanism is not None and name in mechanism.names and name not in mechanism.points

    def _size(self, at: Path_, kind: str, exercise: CourseExercise) -> Place:
        """Return a number, or a quantity of the exercise by its name."""
        result, unit = self._at((*at, kind)), {"force": "N", "moment": "N*m"}[kind]
        if result is None:
            if self._at((*at, "table")) is None:
                raise self.refused(
                    at, 'a load says how large it is: force = "800 N", moment = "5 N*m", or table = […]'
                )
            return 0.0
        if isinstance(result, str) and result in exercise.spec.given:
            if not same_dimension(exercise.units.get(result, "1"), unit):
                raise self.refused(
                    (*at, kind),
                    "{name} is in {found}, and {key} in {unit}",
                    name=result,
                    found=exercise.units.get(result, "1"),
                    key=kind,
                    unit=unit,
                )
            return result
        return self._number((*at, kind), result, unit)

    def _pairs(
        self, at: Path_, kind: str, by: str, exercise: CourseExercise
    ) -> tuple[tuple[float, float], ...]:
        listed, unit = self._at((*at, "table")), {"force": "N", "moment": "N*m"}[kind]
        if listed is None:
            return ()
        if by and by not in exercise.quantity_names:
            raise self.refused((*at, "by"), as_message(unknown("quantity", by, exercise.quantity_names)))
        if (
            not isinstance(listed, list)
            or len(listed) < 2
            or not all(isinstance(p, list) and len(p) == 2 for p in listed)
        ):
            raise self.refused(
                (*at, "table"),
                'a table lists pairs: [["0 deg", "0 N"], ["90 deg", "200 N"]]; found {found!r}',
                found=listed,
            )
        position = exercise.units.get(by, "deg") if by else "deg"
        results = [
            (self._number((*at, "table"), x, position), self._number((*at, "table"), y, unit))
            for x, y in listed
        ]
        if any(b[0] <= a[0] for a, b in pairwise(results)):
            raise self.refused(
                (*at, "table"),
                "the first values of a table must increase; one is not larger than the one before",
            )
        if position == "deg" and results[-1][0] - results[0][0] > 360:
            span = results[-1][0] - results[0][0]
            raise self.refused(
                (*at, "table"), "a table by an angle spans a turn at most; found {found:g} deg", found=span
            )
        return tuple(results)

    def _friction(self, name: str) -> Any:
        at: Path_ = ("friction", name)
        result = self._at(at)
        if not isinstance(result, Mapping):
            return self._coefficient(at, result)
        self._only(result, ("coefficient", "radius"), at)
        coefficient = self._coefficient((*at, "coefficient"), result.get("coefficient"))
        radius = self._amount((*at, "radius"), "mm")
        return coefficient if radius is None else (coefficient, radius)

    def _coefficient(self, at: Path_, result: Any) -> float:
        value = self._number(at, result, "1")
        if value < 0:
            raise self.refused(at, "a coefficient of friction is not negative; found {found:g}", found=value)
        return value

    def _flywheel(self) -> Flywheel | None:
        if "flywheel" not in self.table:
            return None
        at: Path_ = ("flywheel",)
        self._only(self._table(at), ("inertia", "unevenness"), at)
        inertia, unevenness = self._amount((*at, "inertia"), "kg*m^2"), self._amount((*at, "unevenness"), "1")
        if (inertia is None) == (unevenness is None):
            raise self.refused(at, 'a flywheel has inertia = "2 kg*m^2", or unevenness = 0.02')
        return self._with_line(
            (*at, "inertia" if unevenness is None else "unevenness"), Flywheel, inertia, unevenness
        )

    def _gravity(self) -> complex:
        at: Path_ = ("gravity",)
        if "gravity" not in self.table:
            return -1j * GRAVITY
        self._only(self._table(at), ("acceleration", "angle"), at)
        size = self._amount((*at, "acceleration"), "m/s^2", GRAVITY)
        return cmath.rect(size, math.radians(self._amount((*at, "angle"), "deg", -90.0)))
