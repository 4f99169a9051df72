"""Assignment: the exercises that an instructor hands out and marks together, described in a TOML file.

An unknown key, an unknown part, points that are not a number, a date that is none: each error names the file,
its line and the remedy.
"""

from __future__ import annotations

import datetime
import reprlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from coursework.course.exercise import ALL, USUAL, CourseExercise
from coursework.course.marking_rules import Rules
from coursework.course.secrecy import Secret
from coursework.errors import BadCourse, BadInput, CourseworkError, nearest, reason_of
from coursework.language.words import languages
from coursework.messages import Message
from coursework.sheets.paper import Logo
from coursework.system.toml_files import TomlReader, line_of, source_of, table_of

Texts = Mapping[str, str]  #: by language
EACH = "each"  #: a variant a student
MOST_VERSIONS = 26
MOST_WORK_MM = 230  #: what a page holds
SITTINGS = ("best", "last")
ANSWERS = ("shown", "never")
#: Options of ``build`` that the file may contain; the command line takes precedence.
OPTIONS = (
    "roster",
    "columns",
    "formats",
    "lang",
    "paper",
    "practice",
    "booklet",
    "attendance",
    "scan",
    "solutions",
    "polygons",
    "out",
    "decimal",
)
#: Keys that name files near the assignment's own, with their texts.
FILES = ("logo", "logo_alt", "roster", "out")


class Exercises(Protocol):
    """Course of an assignment."""

    @property
    def names(self) -> tuple[str, ...]: ...

    def __getitem__(self, name: str) -> CourseExercise[Any]: ...


@dataclass(frozen=True)
class AskedExercise:
    """Exercise of an assignment."""

    name: str
    parts: tuple[str, ...] | None = None  #: ids; the usual ones by default
    points: float | Mapping[str, float] | None = None  #: by part, or a total; the exercise's own by default
    seed: int | None = None  #: the same variant of the assignment for everybody
    given: Mapping[str, Any] = field(default_factory=dict)  #: values that are not drawn, with their units
    work: int | None = None  #: mm of paper for the reasoning; None: as stated for all

    def fixed_seed(self, exercise: CourseExercise[Any]) -> int | None:
        """Return the seed of the variant that everybody gets; None if each has another one."""
        if self.seed is None and exercise.draws.is_whole(self.given):
            return 0
        return self.seed


@dataclass(frozen=True)
class Scale:
    """Maximum of a mark, and its step."""

    of: float
    step: float


@dataclass(frozen=True)
class Assignment:
    """Assignment: its heading, its exercises, the distribution of variants, and the marking rules."""

    name: str  #: the file's stem; the draws depend on it and on the secret
    exercises: tuple[AskedExercise, ...]
    title: Texts = field(default_factory=dict)
    course: Texts = field(default_factory=dict)
    date: datetime.date | None = None
    duration: Texts = field(default_factory=dict)
    instructions: Texts = field(default_factory=dict)  #: Markdown
    rules: Texts | bool = False  #: on the cover, Markdown; True: the usual ones
    work: int = 0  #: mm of paper after each exercise for the reasoning
    logo: Path | None = None
    logo_alt: Texts = field(default_factory=dict)
    cover: bool = False
    anonymous: bool = False  #: codes in place of names, until they are lifted
    mark: Scale | None = None
    versions: int | None = None  #: number of versions; None: a variant per student
    identity: tuple[str, ...] = ()
    #: Columns of the roster that the summary repeats; None: all but private ones.
    carry: tuple[str, ...] | None = None
    sort: str = ""  #: the column by which a booklet is sorted; empty: as the roster
    sittings: str = "best"
    answers: str = "shown"
    solutions_after: datetime.date | None = None  #: from this day on feedback has the worked solutions
    marking: Mapping[str, Any] = field(default_factory=dict)
    options: Mapping[str, Any] = field(default_factory=dict)
    secret: Secret | None = None  #: keys all draws; None if the file has no line for it

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(exercise.name for exercise in self.exercises)

    def stated(self) -> dict[str, Any]:
        """Return the fields that ``issued.json`` stores for marking."""
        return {
            "name": self.name,
            "title": dict(self.title),
            "course": dict(self.course),
            "date": self.date.isoformat() if self.date else "",
            "duration": dict(self.duration),
            "mark": None if self.mark is None else {"of": self.mark.of, "step": self.mark.step},
            "identity": list(self.identity),
            **({} if self.carry is None else {"carry": list(self.carry)}),
            **({"anonymous": True} if self.anonymous else {}),
            "sittings": self.sittings,
            "answers": self.answers,
            **({"solutions_after": self.solutions_after.isoformat()} if self.solutions_after else {}),
            "marking": dict(self.marking),
            "exercises": list(self.names),
        }

    def picture(self, lang: str) -> Logo | None:
        """Return the logo with its alternative text.

        Raises
        ------
        BadInput
            It cannot be read.
        """
        if self.logo is None:
            return None
        try:
            data = self.logo.read_bytes()
        except OSError as fault:
            raise BadInput(
                "the logo {file} cannot be read: {reason}", file=self.logo, reason=reason_of(fault)
            ) from fault
        return Logo(data, self.logo.suffix[1:].lower(), text_in(self.logo_alt, lang))


def text_in(texts: Texts, lang: str) -> str:
    """Return a text in a language, else in its first language; "" if there is none."""
    return texts.get(lang) or next(iter(texts.values()), "")


def read_assignment(path: Path, course: Exercises) -> Assignment:
    """Read an assignment's file.

    Raises
    ------
    BadInput
        The file cannot be read, or a key or value is wrong; the message has the line and the nearest name.
    """
    source = source_of(path)
    return _AssignmentReader(path, source, course).assignment(table_of(source, str(path)))


_MOST_QUOTED = 100  #: characters of a refused value in a message


def _short(value: Any) -> str:
    """Return a value as quoted in messages."""
    text = repr(value)
    return text if len(text) <= _MOST_QUOTED else f"{text[:_MOST_QUOTED]}…"


def assignment_of(name: str, table: Mapping[str, Any], course: Exercises, source: str = "") -> Assignment:
    """Return the assignment of a table that comes from outside; keys that name files are dropped.

    ``source`` is the text of the table, if any, for the line numbers in messages.

    Raises
    ------
    BadInput
        A key or a value is wrong.
    """
    fields = {key: value for key, value in table.items() if key not in FILES}
    return _AssignmentReader(Path(f"{name}.toml"), source, course).assignment(fields)


class _AssignmentReader(TomlReader):
    """Reader of the table of an assignment."""

    def __init__(self, path: Path, source: str, course: Exercises):
        super().__init__(path, source)
        self.course = course

    def refused_key(self, key: str, template: str, /, exercise: int = -1, **values: Any) -> BadInput:
        """Return the error of a key, at the top level or in a table of exercises."""
        return self.refused(["exercises", exercise, key] if exercise >= 0 else [key], template, **values)

    def assignment(self, table: Mapping[str, Any]) -> Assignment:
        readers: dict[str, Callable[[Any], Any]] = {
            "title": self._texts("title"),
            "course": self._texts("course"),
            "date": self._date("date"),
            "duration": self._texts("duration"),
            "instructions": self._texts("instructions"),
            "rules": self._rules,
            "work": self._work,
            "logo": self._logo,
            "logo_alt": self._texts("logo_alt"),
            "cover": self._truth("cover"),
            "anonymous": self._truth("anonymous"),
            "mark": self._mark,
            "versions": self._versions,
            "identity": self._columns("identity"),
            "carry": self._columns("carry"),
            "sort": self._sort,
            "sittings": self._word("sittings", SITTINGS),
            "answers": self._word("answers", ANSWERS),
            "solutions_after": self._date("solutions_after"),
            "marking": self._marking,
            "exercises": self._exercises,
            "secret": self._secret,
        }
        values: dict[str, Any] = {}
        options = {}
        for key, value in table.items():
            if key in OPTIONS:
                options[key] = value
            elif key in readers:
                values[key] = readers[key](value)
            else:
                raise self.refused_key(
                    key, "no key {key}{near}", key=_short(key), near=nearest(key, [*readers, *OPTIONS])
                )
        if "exercises" not in values:
            names = ", ".join(self.course.names[:4])
            raise BadInput(
                "{file} names no exercise; write [[exercises]] and name = …: {names}, …",
                file=self.path,
                names=names,
            )
        if "solutions_after" in values and values.get("answers") == "never":
            raise self.refused_key(
                "solutions_after", 'answers = "never" never shows the solutions; omit one of the two'
            )
        if "logo" in values and not values.get("logo_alt"):
            raise self.refused_key("logo", 'a logo needs a text for those who cannot see it: logo_alt = "…"')
        return Assignment(self.path.stem, options=options, **values)

    # ------------------------------------------------------------------ values

    def _texts(self, key: str) -> Callable[[Any], Texts]:
        def read(value: Any) -> Texts:
            if isinstance(value, str):
                return {"": value}
            if not isinstance(value, Mapping) or not all(isinstance(v, str) for v in value.values()):
                raise self.refused_key(
                    key,
                    '{key} is a text, or one for each language: {{ fr = "…", en = "…" }}; found {found}',
                    key=key,
                    found=reprlib.repr(value),
                )
            for lang in value:
                if lang not in languages():
                    raise self.refused_key(
                        key,
                        "{key}: no language {lang!r}{near}",
                        key=key,
                        lang=lang,
                        near=nearest(lang, languages()),
                    )
            return dict(value)

        return read

    def _rules(self, value: Any) -> Texts | bool:
        return value if isinstance(value, bool) else self._texts("rules")(value)

    def _work(self, value: Any, number: int = -1) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= MOST_WORK_MM:
            raise self.refused_key(
                "work",
                "work is a height in mm from 0 to {most}; found {found}",
                most=MOST_WORK_MM,
                found=reprlib.repr(value),
                exercise=number,
            )
        return value

    def _truth(self, key: str) -> Callable[[Any], bool]:
        def read(value: Any) -> bool:
            if not isinstance(value, bool):
                raise self.refused_key(
                    key, "{key} is true or false; found {found}", key=key, found=reprlib.repr(value)
                )
            return value

        return read

    def _word(self, key: str, allowed: Sequence[str]) -> Callable[[Any], str]:
        def read(value: Any) -> str:
            if value not in allowed:
                raise self.refused_key(
                    key,
                    "{key} is {allowed}; found {found}{near}",
                    key=key,
                    allowed=" or ".join(allowed),
                    found=reprlib.repr(value),
                    near=nearest(str(value), allowed),
                )
            return str(value)

        return read

    def _date(self, key: str) -> Callable[[Any], datetime.date]:
        def read(value: Any) -> datetime.date:
            if isinstance(value, datetime.datetime):
                return value.date()
            if isinstance(value, datetime.date):
                return value
            try:
                return datetime.date.fromisoformat(str(value))
            except ValueError:
                raise self.refused_key(
                    key,
                    "{key} is a day such as 2026-12-04; found {found}",
                    key=key,
                    found=reprlib.repr(value),
                ) from None

        return read

    def _logo(self, value: Any) -> Path:
        path = self.path.parent / str(value)
        if path.suffix.lower() not in (".svg", ".png"):
            raise self.refused_key(
                "logo", "logo is an SVG or a PNG file; found {found}", found=reprlib.repr(value)
            )
        if not path.is_file():
            raise self.refused_key("logo", "logo: there is no file {file}", file=path)
        return path

    def _mark(self, value: Any) -> Scale:
        if not isinstance(value, Mapping):
            raise self.refused_key(
                "mark", "mark is {{ of = 20, step = 0.5 }}; found {found}", found=reprlib.repr(value)
            )
        for key, number in value.items():
            if key not in ("of", "step"):
                raise self.refused_key(
                    "mark", "mark has no {key!r}{near}", key=key, near=nearest(key, ("of", "step"))
                )
            if isinstance(number, bool) or not isinstance(number, (int, float)) or not number > 0:
                raise self.refused_key(
                    "mark", "mark: {key} is a number above 0; found {number!r}", key=key, number=number
                )
        return Scale(float(value.get("of", 20)), float(value.get("step", 0.5)))

    def _versions(self, value: Any) -> int | None:
        if value == EACH:
            return None
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= MOST_VERSIONS:
            raise self.refused_key(
                "versions",
                'versions is "{each}", or a number from 1 to {most}; found {found}',
                each=EACH,
                most=MOST_VERSIONS,
                found=reprlib.repr(value),
            )
        return value

    def _columns(self, key: str) -> Callable[[Any], tuple[str, ...]]:
        def read(value: Any) -> tuple[str, ...]:
            if not isinstance(value, list) or not all(
                isinstance(column, str) and column.strip() for column in value
            ):
                raise self.refused_key(
                    key,
                    '{key} lists columns of the roster: ["number", "group"]; found {found}',
                    key=key,
                    found=reprlib.repr(value),
                )
            return tuple(value)

        return read

    def _sort(self, value: Any) -> str:
        if not isinstance(value, str) or not value.strip():
            raise self.refused_key(
                "sort", 'sort is a column of the roster: "group"; found {found}', found=reprlib.repr(value)
            )
        return value

    def _marking(self, value: Any) -> Mapping[str, Any]:
        try:
            Rules.of(value, f"{self.path}, line {line_of(self.source, ['marking'])}")
        except BadCourse as fault:
            raise BadInput(str(fault)) from fault
        return dict(value)

    def _secret(self, value: Any) -> Secret:
        try:
            return Secret.of(value)
        except ValueError as fault:
            raise self.refused_key(
                "secret", "{problem}; delete the line, and 'coursework build' creates one", problem=fault
            ) from None

    # --------------------------------------------------------------- exercises

    def _exercises(self, value: Any) -> tuple[AskedExercise, ...]:
        if (
            not isinstance(value, list)
            or not value
            or not all(isinstance(exercise, Mapping) for exercise in value)
        ):
            raise self.refused_key("exercises", "exercises are tables: [[exercises]], then name = …")
        exercises = tuple(self._exercise(number, exercise) for number, exercise in enumerate(value))
        names = [exercise.name for exercise in exercises]
        for number, name in enumerate(names):
            if name in names[:number]:
                raise self.refused_key(
                    "name",
                    "{name} appears twice; an assignment has each exercise once",
                    name=name,
                    exercise=number,
                )
        return exercises

    def _exercise(self, number: int, table: Mapping[str, Any]) -> AskedExercise:
        keys = ("name", "parts", "points", "seed", "given", "work")
        for key in table:
            if key not in keys:
                raise self.refused_key(
                    key,
                    "no key {key} in [[exercises]]{near}",
                    key=_short(key),
                    near=nearest(key, keys),
                    exercise=number,
                )
        name = table.get("name")
        if name not in self.course.names:
            near = nearest(str(name), self.course.names)
            lacks = Message("[[exercises]] without name = …")
            if "name" in table:
                lacks = Message("no exercise {name}", name=_short(name))
            raise self.refused_key(
                "name" if "name" in table else "exercises",
                "{lacks}{near}",
                lacks=lacks,
                near=near,
                exercise=number,
            )
        parts = self._parts(number, str(name), table.get("parts"))
        points = self._points(number, str(name), table.get("points"))
        seed = table.get("seed")
        if seed is not None and (isinstance(seed, bool) or not isinstance(seed, int) or seed < 0):
            raise self.refused_key(
                "seed",
                "a seed is a whole number from 0 on; found {found}",
                found=_short(seed),
                exercise=number,
            )
        work = self._work(table["work"], number) if "work" in table else None
        given = self._given(number, str(name), table.get("given"))
        return AskedExercise(str(name), parts, points, seed, given, work)

    def _given(self, number: int, name: str, value: Any) -> Mapping[str, Any]:
        """Return the stated values of given quantities, in canonical units."""
        if value is None:
            return {}
        if not isinstance(value, Mapping):
            raise self.refused_key(
                "given",
                'given is a table of values with their units: {{ r1 = "228.6 mm" }}; found {found}',
                found=_short(value),
                exercise=number,
            )
        try:
            return self.course[name].stated(value)
        except CourseworkError as fault:
            raise self.refused_key("given", "given: {problem}", problem=fault, exercise=number) from fault

    def _parts(self, number: int, name: str, value: Any) -> tuple[str, ...] | None:
        if value is None:
            return None
        parts = [value] if isinstance(value, str) else value
        if not isinstance(parts, list) or not parts or not all(isinstance(part_id, str) for part_id in parts):
            raise self.refused_key(
                "parts",
                'parts is a list of ids: ["rA", "theta4"]; found {found}',
                found=reprlib.repr(value),
                exercise=number,
            )
        ids = [*(part.id for part in self.course[name].spec.parts), USUAL, ALL]
        for part_id in parts:
            if part_id not in ids:
                raise self._unknown_part("parts", number, name, part_id, ids)
        return tuple(parts)

    def _unknown_part(self, key: str, number: int, name: str, part: Any, ids: Sequence[str]) -> BadInput:
        message = Message(
            "{name} has no part {part}{near}", name=name, part=_short(part), near=nearest(part, ids)
        )
        return self.refused_key(key, message, number)

    def _points(self, number: int, name: str, value: Any) -> float | Mapping[str, float] | None:
        if value is None:
            return None
        if not isinstance(value, Mapping):
            return self._number(number, value)
        ids = [part.id for part in self.course[name].spec.parts]
        for part in value:
            if part not in ids:
                raise self._unknown_part("points", number, name, part, ids)
        return {str(part): self._number(number, points) for part, points in value.items()}

    def _number(self, number: int, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 < value < float("inf"):
            raise self.refused_key(
                "points",
                "points are a number above 0; found {found}",
                found=reprlib.repr(value),
                exercise=number,
            )
        return float(value)
