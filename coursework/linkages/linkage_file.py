"""Reader of a mechanism's file: its tables as bodies, joints, given quantities and questions, each fault with its line."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

from coursework.errors import BadCourse, BadInput, CourseworkError, nearest
from coursework.linkages.expressions import ZERO, ExpressionReader, QuantityExpression, amount, unit_of
from coursework.messages import Message, as_message
from coursework.system.toml_files import TomlReader, source_of, table_of

GROUND = "ground"
KEYS = ("title", "version", "given", "ground", "bodies", "slides", "gears", "assembly", "ask", "known")
ASKED = (
    "mobility", "class", "positions", "equations", "velocities", "accelerations", "polygon", "instant_centres", "advantage", "torque", "points",
)  # fmt: skip
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*\Z")
_POINT = re.compile(r"[A-Z][0-9]*\Z")
_BODY = re.compile(r"(?:[2-9]|[1-9][0-9]|[a-z][a-z0-9]*)\Z")
_UNPRINTED = re.compile(r"[\x00-\x1f\x7f{}]")  #: in a title, which becomes a line of a template
_MOST_CHARACTERS, _MOST_ENTRIES = 60_000, 100  #: of a file, and of each of its tables and lists
_MOST_POINTS = 1000  #: that a question is worth
_SIDE = re.compile(r"\s*(left|right)\s+of\s+([A-Z]\d*)\s*->\s*([A-Z]\d*)\s*\Z")
_AHEAD = re.compile(r"\s*(ahead of|behind)\s+([A-Z]\d*)\s*\Z")


@dataclass(frozen=True)
class Place:
    """Point in a frame: by coordinates, or by distance and direction from the frame's origin."""

    x: QuantityExpression = ZERO
    y: QuantityExpression = ZERO
    radius: QuantityExpression | None = None
    angle: QuantityExpression = ZERO

    @property
    def is_origin(self) -> bool:
        return self.radius is None and self.x.is_zero and self.y.is_zero

    @property
    def names(self) -> tuple[str, ...]:
        """Quantities that place it."""
        several = (self.x, self.y, self.radius or ZERO, self.angle)
        return tuple(dict.fromkeys(name for each in several for name in each.names))


@dataclass(frozen=True)
class GivenEntry:
    """Given quantity: a value, or a range with a step, in the canonical unit."""

    unit: str
    value: float | None = None
    low: QuantityExpression = ZERO
    high: QuantityExpression = ZERO
    step: str = "1"
    nonzero: bool = False
    positive: bool = False


@dataclass(frozen=True)
class BodyEntry:
    """Moving body: its points in its own frame, by name; the quantity or the constant that turns it, if the file states one."""

    name: str
    points: Mapping[str, Place]
    at: str
    angle: QuantityExpression | None = None


@dataclass(frozen=True)
class SlideEntry:
    """Point of a body that slides on a line of another: the line's point and direction in the guide's frame, the name of the
    distance along it."""

    at: str
    of: str
    on: str
    through: Place
    through_name: str
    along: QuantityExpression
    distance: str


@dataclass(frozen=True)
class GearEntry:
    """Two wheels that roll on each other, and the carrier of their centres."""

    first: str
    second: str
    carrier: str
    radii: tuple[QuantityExpression, QuantityExpression]
    inner: bool


@dataclass(frozen=True)
class AssemblyEntry:
    """Ways to assemble a group: ``left`` and ``right`` of a line between two points, or ``ahead`` and ``behind`` on a slide; one, or
    those among which a variant draws."""

    ways: tuple[str, ...]
    start: str = ""
    end: str = ""

    @property
    def is_drawn(self) -> bool:
        return len(self.ways) > 1


@dataclass(frozen=True)
class NearEntry:
    """Start of Newton's method: places of points, mm, with the driver at an angle, degrees."""

    places: Mapping[str, complex]
    angle: float


@dataclass(frozen=True)
class LoadEntry:
    """Load on a body: a moment, or a force at a point in a direction; expressions in N m, N, degrees."""

    on: str
    moment: QuantityExpression | None = None
    force: QuantityExpression | None = None
    angle: QuantityExpression = ZERO


@dataclass(frozen=True)
class LinkageFile:
    """Mechanism as its file states it."""

    path: Path
    source: str
    title: Mapping[str, str]
    version: int
    given: Mapping[str, GivenEntry]
    ground: Mapping[str, Place]
    bodies: Mapping[str, BodyEntry]
    slides: Mapping[str, SlideEntry]
    gears: tuple[GearEntry, ...]
    assembly: Mapping[str, AssemblyEntry]
    near: NearEntry | None
    ask: Mapping[str, Any]
    loads: tuple[LoadEntry, ...]
    driver: str  #: the body that is driven
    angle: str  #: the quantity that turns it
    speed: str = ""  #: '' where the file gives none
    acceleration: str = ""
    name: str = field(default="")
    known: tuple[
        tuple[Mapping[str, float | str], Mapping[str, tuple[str, str]]], ...
    ] = ()  #: given values, then results as text and unit

    def refused(self, at: Sequence[str | int], why: str) -> BadInput:
        """Return the error of a key, with file and line."""
        return TomlReader(self.path, self.source).refused(at, why)

    def holders(self, point: str) -> tuple[str, ...]:
        """Return the bodies that have a point, the ground first."""
        on_ground = (GROUND,) if point in self.ground else ()
        return (*on_ground, *(n for n, b in self.bodies.items() if point in b.points))

    def place(self, point: str, body: str) -> Place:
        """Return where a point lies in a body's frame."""
        return self.ground[point] if body == GROUND else self.bodies[body].points[point]

    @property
    def points(self) -> tuple[str, ...]:
        """Names of all points, each once."""
        return tuple(dict.fromkeys([*self.ground, *(p for b in self.bodies.values() for p in b.points)]))

    @property
    def pins(self) -> dict[str, tuple[str, ...]]:
        """Bodies that share a point, by point; two or more."""
        shared = {p: self.holders(p) for p in self.points}
        return {p: bodies for p, bodies in shared.items() if len(bodies) > 1}

    @property
    def mobility(self) -> int:
        """Degrees of freedom by the count 3 n - 2 b - h."""
        pins = sum(len(bodies) - 1 for bodies in self.pins.values())
        return 3 * len(self.bodies) - 2 * (pins + len(self.slides)) - len(self.gears)


@contextmanager
def author_faults() -> Iterator[None]:
    """Raise what is wrong in a file as an error of the course."""
    try:
        yield
    except BadCourse:
        raise
    except CourseworkError as fault:
        raise BadCourse("{problem}", problem=as_message(fault)) from fault


def read_linkage(path: Path, shown: str = "") -> LinkageFile:
    """Read a mechanism's file.

    Parameters
    ----------
    path
        The file.
    shown
        Its name in messages; its path unless told.

    Returns
    -------
    The mechanism.

    Raises
    ------
    BadCourse
        It cannot be read, or states what makes no sense: with the line, what was found and what would do.
    """
    with author_faults():
        source = source_of(path)
        name = Path(shown or path)
        if len(source) > _MOST_CHARACTERS:
            raise BadInput(
                "{source_name} has {count} characters; such a file has at most {most}",
                source_name=name,
                count=len(source),
                most=_MOST_CHARACTERS,
            )
        return _LinkageReader(name, source, table_of(source, str(name))).linkage()


class _LinkageReader(TomlReader):
    """Reader of the tables of a mechanism."""

    def __init__(self, path: Path, source: str, table: Mapping[str, Any]) -> None:
        super().__init__(path, source)
        self.table = table
        self.units: dict[str, str] = {}
        self.constants: dict[
            str, GivenEntry
        ] = {}  #: numbers that stand in places and loads, by the names that they get

    def linkage(self) -> LinkageFile:
        self.only(self.table, KEYS)
        title = self._title()
        given = self._given()
        ground = self._places(("ground",))
        if not ground:
            raise self.refused(
                ("ground",), Message('the ground has points: [ground], then O = ["0 mm", "0 mm"]')
            )
        bodies = self._bodies(ground)
        slides = self._slides(ground, bodies)
        driver, angle = self._driver(bodies, given)
        speed, acceleration = (f"{stem}{angle.removeprefix('theta')}" for stem in ("omega", "alpha"))
        assembly, near = self._assembly()
        gears, loads = self._gears(bodies), self._loads(bodies)
        linkage = LinkageFile(
            self.path, self.source, title, self._whole("version", 1), self._ordered(given, angle), ground, bodies, slides,
            gears, assembly, near, self._ask(), loads, driver, angle,
            speed if speed in given else "", acceleration if acceleration in given else "", self.path.stem,
            self._known(),
        )  # fmt: skip
        for fault in self._faults(linkage):
            raise fault
        return linkage

    def _ordered(self, given: Mapping[str, GivenEntry], angle: str) -> Mapping[str, GivenEntry]:
        """Return all given quantities as the sheet lists them: what places the joints, the driver, what acts on it."""
        driver = {angle.replace("theta", stem, 1) for stem in ("theta", "omega", "alpha")}
        first = {**given, **self.constants}
        ranks = {n: 2 if e.unit in ("N", "N*m") else int(n in driver) for n, e in first.items()}
        return dict(sorted(first.items(), key=lambda item: ranks[item[0]]))

    # -------------------------------------------------------------------- pieces

    def _table(self, *at: str | int) -> Mapping[str, Any]:
        result: Any = self.table
        for key in at:
            result = result.get(key, {}) if isinstance(result, Mapping) else {}
        if not isinstance(result, Mapping):
            raise self.refused(
                at, Message("{value} is a table; found {result!r}", value=at[-1], result=result)
            )
        self._count(at, result)
        for key, value in result.items():
            if isinstance(value, (Mapping, list)):
                self._count((*at, key), value)
        return result

    def _count(self, at: Sequence[str | int], value: Any) -> None:
        """Refuse more entries than any mechanism has: the time to compile them grows with their square."""
        if len(value) > _MOST_ENTRIES:
            raise self.refused(
                at,
                Message(
                    "{value} has {count} entries; there are at most {most}",
                    value=at[-1],
                    count=len(value),
                    most=_MOST_ENTRIES,
                ),
            )

    def _whole(self, key: str, otherwise: int) -> int:
        value = self.table.get(key, otherwise)
        if not isinstance(value, int) or isinstance(value, bool) or value < 1:
            raise self.refused(
                (key,), Message("{key} is a whole number from 1 on; found {value!r}", key=key, value=value)
            )
        return value

    def _title(self) -> Mapping[str, str]:
        title = self.table.get("title", {})
        if isinstance(title, str):
            title = {"": title}
        if (
            not isinstance(title, Mapping)
            or not title
            or not all(isinstance(t, str) and t for t in title.values())
        ):
            raise self.refused(
                ("title",),
                Message("a title in each language: {example}", example='title = { fr = "…", en = "…" }'),
            )
        for text in title.values():
            if _UNPRINTED.search(text) or len(text) > 120:
                raise self.refused(
                    ("title",),
                    Message(
                        "a title is one line of at most 120 characters without braces; found {text!r}",
                        text=text[:60],
                    ),
                )
        return title

    def _checked(self, at: Sequence[str | int], read: Callable[..., Any], *arguments: Any) -> Any:
        """Call a reader, and add the line to what it refuses."""
        try:
            return read(*arguments)
        except BadInput:
            raise
        except CourseworkError as fault:
            raise self.refused(at, fault.args[0] if fault.args else str(fault)) from fault

    def _expression(
        self, at: Sequence[str | int], text: object, unit: str, name: str = ""
    ) -> QuantityExpression:
        """Read an expression; a number other than 0 becomes a given quantity of that name, which the sheet lists among its data."""
        found: QuantityExpression = self._checked(at, ExpressionReader(self.units).read, text, unit)
        if (
            not name
            or not found.is_number
            or found.is_zero
            or (unit == "deg" and float(found.code) % 90 == 0)
        ):
            return found
        while name in self.units:
            name += "_"
        self.units[name] = unit
        self.constants[name] = GivenEntry(unit, value=float(found.code))
        return QuantityExpression(name, (name,))

    # --------------------------------------------------------------------- given

    def _given(self) -> Mapping[str, GivenEntry]:
        results: dict[str, GivenEntry] = {}
        table = self._table("given")
        for name, value in table.items():
            if name == "require":
                continue
            at = ("given", name)
            if not _NAME.match(name):
                raise self.refused(
                    at, Message("{name!r} is no name of a quantity: letters, digits, _", name=name)
                )
            results[name] = self._entry(at, name, value)
            self.units[name] = results[name].unit
        return results

    def _entry(self, at: tuple[str, str], name: str, value: Any) -> GivenEntry:
        if not isinstance(value, Mapping):
            unit = self._checked(at, unit_of, value)
            self._has_unit(at, name, unit, value)
            return GivenEntry(unit, value=self._checked(at, amount, value, unit))
        self.only(value, ("from", "to", "step", "nonzero"), at, name)
        if "from" not in value or "to" not in value:
            raise self.refused(
                at,
                Message(
                    '{name} is "180 mm", or {{ from = "40 mm", to = "70 mm", step = "5 mm" }}', name=name
                ),
            )
        step = value.get("step", value["from"] if False else None)
        units = [self._checked(at, unit_of, v) for v in (value["from"], value["to"], step) if _is_amount(v)]
        unit = next((u for u in units if u != "1"), "1")
        self._has_unit(at, name, unit, value["from"])
        low, high = (self._expression((*at, key), value[key], unit) for key in ("from", "to"))
        width = self._checked((*at, "step"), amount, step, unit) if step is not None else 1.0
        if not width > 0:
            raise self.refused((*at, "step"), Message("a step is above 0; found {step}", step=step))
        if low.is_number and high.is_number and float(low.code) > float(high.code):
            raise self.refused(
                at,
                Message(
                    "{name} goes from the smaller value to the greater; found {value}, {value_2}",
                    name=name,
                    value=value["from"],
                    value_2=value["to"],
                ),
            )
        exact = f"{Fraction(width).limit_denominator(10**6).numerator / Fraction(width).limit_denominator(10**6).denominator:.9g}"
        positive = unit == "mm" and (not low.is_number or float(low.code) > 0)
        return GivenEntry(unit, None, low, high, exact, bool(value.get("nonzero", False)), positive)

    def _has_unit(self, at: Sequence[str | int], name: str, unit: str, value: object) -> None:
        """Refuse a plain number for a quantity whose name says that it has a unit."""
        stem = re.match(r"[A-Za-z]+", name)
        wanted = {"r": "mm", "theta": "deg", "omega": "rad/s", "alpha": "rad/s^2"}.get(
            stem[0] if stem else ""
        )
        if wanted and unit == "1":
            raise self.refused(
                at, Message('{name} needs a unit: "{value} {unit}"', name=name, value=value, unit=wanted)
            )

    # -------------------------------------------------------------------- points

    def _places(self, at: tuple[str, ...]) -> dict[str, Place]:
        table = self._table(*at)
        results = {}
        for name, value in table.items():
            self._check_point((*at, name), name)
            results[name] = self._place(
                (*at, name), value, (f"x{name}", f"x{name}", f"y{name}", f"gamma_{name}")
            )
        return results

    def _check_point(self, at: Sequence[str | int], point: str) -> None:
        if not _POINT.match(point):
            raise self.refused(
                at,
                Message(
                    "a point is called by a capital letter, such as A or O2; found {point!r}", point=point
                ),
            )

    def _place(self, at: Sequence[str | int], value: Any, names: tuple[str, str, str, str]) -> Place:
        """Read a place; ``names`` of its constants: on the axis, x, y, the direction."""
        if isinstance(value, str):
            return Place(self._expression(at, value, "mm", names[0]))
        if isinstance(value, list) and len(value) == 2:
            x, y = (
                self._expression(at, each, "mm", name) for each, name in zip(value, names[1:3], strict=True)
            )
            return Place(x, y)
        if isinstance(value, Mapping) and set(value) == {"r", "angle"}:
            return Place(
                radius=self._expression(at, value["r"], "mm", names[0]),
                angle=self._expression(at, value["angle"], "deg", names[3]),
            )
        raise self.refused(
            at,
            Message(
                'a place is "r2", ["x", "y"] or {{ r = "r5", angle = "beta" }}; found {value!r}', value=value
            ),
        )

    # -------------------------------------------------------------------- bodies

    def _bodies(self, ground: Mapping[str, Place]) -> Mapping[str, BodyEntry]:
        table = self._table("bodies")
        if not table:
            raise self.refused(
                ("bodies",),
                Message(
                    "a mechanism has bodies: [bodies], then {example}",
                    example='2 = { at = "O", angle = "theta2", points = { A = "r2" } }',
                ),
            )
        results = {}
        for name, value in table.items():
            at = ("bodies", name)
            if not _BODY.match(name):
                raise self.refused(
                    at,
                    Message(
                        "a body is called by a number from 2 on, or a small letter; found {name!r} (the ground is 1)",
                        name=name,
                    ),
                )
            if not isinstance(value, Mapping):
                raise self.refused(
                    at,
                    Message(
                        'a body is {{ points = {{ A = "0 mm", B = "r3" }} }}; found {value!r}', value=value
                    ),
                )
            self.only(value, ("at", "angle", "points"), at, name)
            points = self._body_points(name, value)
            origin = value.get("at") or next((p for p, place in points.items() if place.is_origin), "")
            if not origin:
                raise self.refused(
                    at,
                    Message(
                        'body {name} says where its frame begins: at = "A", or a point at "0 mm"', name=name
                    ),
                )
            if "at" in value:
                self._check_point(at, str(origin))
                points = {str(origin): Place(), **points}
            angle = value.get("angle")
            results[name] = BodyEntry(
                name,
                points,
                str(origin),
                None if angle is None else self._expression((*at, "angle"), angle, "deg"),
            )
        return results

    def _body_points(self, name: str, value: Mapping[str, Any]) -> dict[str, Place]:
        points = value.get("points", {})
        if not isinstance(points, Mapping):
            raise self.refused(
                ("bodies", name),
                Message('points = {{ A = "0 mm", B = "r3" }}; found {points!r}', points=points),
            )
        origin = str(
            value.get("at")
            or next((p for p, place in points.items() if re.match(r"\s*0\b(?!\.)", str(place))), "")
        )
        results = {}
        for point, place in points.items():
            self._check_point(("bodies", name), point)
            own = (f"{origin}{point}", f"x_{point}_{name}", f"y_{point}_{name}", f"gamma_{point}")
            results[point] = self._place(("bodies", name), place, own)
        return results

    def _driver(self, bodies: Mapping[str, BodyEntry], given: Mapping[str, GivenEntry]) -> tuple[str, str]:
        driven = [b for b in bodies.values() if b.angle is not None and not b.angle.is_number]
        if not driven:
            raise self.refused(
                ("bodies",),
                Message(
                    "nothing drives: one body is turned by a given angle: {example}",
                    example='2 = { at = "O", angle = "theta2", … }',
                ),
            )
        if len(driven) > 1:
            raise self.refused(
                ("bodies", driven[1].name),
                Message(
                    "two bodies are driven, {name} and {name_2}; one angle drives, those of the others follow",
                    name=driven[0].name,
                    name_2=driven[1].name,
                ),
            )
        angle = driven[0].angle
        assert angle is not None
        if not angle.is_name or not angle.code.startswith("theta"):
            raise self.refused(
                ("bodies", driven[0].name),
                Message(
                    "the driving angle is a given quantity such as theta2; found {code!r}", code=angle.code
                ),
            )
        return driven[0].name, angle.code

    # -------------------------------------------------------------------- joints

    def _slides(
        self, ground: Mapping[str, Place], bodies: Mapping[str, BodyEntry]
    ) -> Mapping[str, SlideEntry]:
        results = {}
        for point, value in self._table("slides").items():
            at = ("slides", point)
            if not isinstance(value, Mapping):
                raise self.refused(
                    at,
                    Message(
                        'a slide is {point} = {{ of = "4", on = "ground", through = "C", along = "0 deg" }}; found {value!r}',
                        point=point,
                        value=value,
                    ),
                )
            self.only(value, ("of", "on", "through", "along", "distance"), at, point)
            names = [*bodies, GROUND]
            of, on = str(value.get("of", "")), str(value.get("on", GROUND))
            on = GROUND if on == "1" else on
            for body in (of, on):
                if body not in names:
                    raise self.refused(
                        at, Message("no body {body!r}{found}", body=body, found=nearest(body, names))
                    )
            if of == GROUND or point not in bodies[of].points:
                raise self.refused(
                    at,
                    Message(
                        "the sliding point {point} is a point of body {value}; it has none of this name",
                        point=point,
                        value=of or "…",
                    ),
                )
            if of == on:
                raise self.refused(at, Message("body {of} does not slide on itself", of=of))
            through, name = self._through(at, value.get("through", ["0 mm", "0 mm"]), on, ground, bodies)
            distance = str(value.get("distance", f"s_{point}"))
            if not _NAME.match(distance) or distance in self.units:
                raise self.refused(
                    at,
                    Message(
                        "distance names the distance along the slide, which follows; found {distance!r}",
                        distance=distance,
                    ),
                )
            along = self._expression(at, value.get("along", "0 deg"), "deg", f"delta_{point}")
            results[point] = SlideEntry(point, of, on, through, name, along, distance)
        return results

    def _through(
        self,
        at: Sequence[str | int],
        value: Any,
        on: str,
        ground: Mapping[str, Place],
        bodies: Mapping[str, BodyEntry],
    ) -> tuple[Place, str]:
        """Return the point through which a slide goes, in the guide's frame, and its name if it has one."""
        points = ground if on == GROUND else bodies[on].points
        if isinstance(value, str) and _POINT.match(value):
            if value not in points:
                raise self.refused(
                    at,
                    Message(
                        "body {on} has no point {value!r}{found}",
                        on=on,
                        value=value,
                        found=nearest(value, points),
                    ),
                )
            return points[value], value
        return self._place(at, value, (f"a_{at[-1]}", f"a_{at[-1]}", f"e_{at[-1]}", f"gamma_{at[-1]}")), ""

    def _gears(self, bodies: Mapping[str, BodyEntry]) -> tuple[GearEntry, ...]:
        results = []
        for name, value in self._table("gears").items():
            at = ("gears", name)
            form = (
                'G = { first = "2", second = "3", carrier = "ground", radii = ["R2", "R3"], inner = false }'
            )
            if (
                not isinstance(value, Mapping)
                or not isinstance(value.get("radii"), list)
                or len(value["radii"]) != 2
            ):
                raise self.refused(at, Message("a gear is {form}; found {value!r}", form=form, value=value))
            self.only(value, ("first", "second", "carrier", "radii", "inner"), at, name)
            names = [*bodies, GROUND]
            pair = [str(value.get(key, GROUND)) for key in ("first", "second", "carrier")]
            for body in pair:
                if body not in names:
                    raise self.refused(
                        at, Message("no body {body!r}{found}", body=body, found=nearest(body, names))
                    )
            first, second = (
                self._expression(at, r, "mm", f"R{body}")
                for r, body in zip(value["radii"], pair, strict=False)
            )
            results.append(
                GearEntry(pair[0], pair[1], pair[2], (first, second), bool(value.get("inner", False)))
            )
        return tuple(results)

    # ------------------------------------------------------------------ assembly

    def _assembly(self) -> tuple[Mapping[str, AssemblyEntry], NearEntry | None]:
        results = {}
        near = None
        for point, value in self._table("assembly").items():
            if point == "near":
                near = self._near(value)
                continue
            at = ("assembly", point)
            texts = value if isinstance(value, list) else [value]
            found = [self._way(at, text) for text in texts]
            ways, ends = tuple(way for way, *_ in found), {tuple(rest) for _, *rest in found}
            if len(ends) > 1 or len(set(ways)) < len(ways) or not ways:
                raise self.refused(
                    at,
                    Message(
                        'the ways to assemble {point} are ["left of A -> C", "right of A -> C"]; found {value!r}',
                        point=point,
                        value=value,
                    ),
                )
            results[point] = AssemblyEntry(ways, *ends.pop())
        return results, near

    def _way(self, at: Sequence[str | int], text: object) -> tuple[str, str, str]:
        if match := _SIDE.match(str(text)):
            return match[1], match[2], match[3]
        if match := _AHEAD.match(str(text)):
            return "ahead" if match[1] == "ahead of" else "behind", match[2], ""
        raise self.refused(
            at,
            Message(
                'a way to assemble is "left of A -> C", "right of A -> C", "ahead of A" or "behind A"; found {text!r}',
                text=text,
            ),
        )

    def _near(self, value: Any) -> NearEntry:
        at = ("assembly", "near")
        form = 'near = { angle = "60 deg", E = ["120 mm", "80 mm"], F = ["150 mm", "20 mm"] }'
        if not isinstance(value, Mapping) or "angle" not in value:
            raise self.refused(
                at,
                Message(
                    "the place from which Newton's method starts is {form}; found {value!r}",
                    form=form,
                    value=value,
                ),
            )
        angle = self._checked(at, amount, value["angle"], "deg")
        places = {}
        for point, place in value.items():
            if point == "angle":
                continue
            self._check_point(at, point)
            if not isinstance(place, list) or len(place) != 2:
                raise self.refused(
                    at,
                    Message(
                        "the place from which Newton's method starts is {form}; found {point} = {place!r}",
                        form=form,
                        point=point,
                        place=place,
                    ),
                )
            x, y = (self._checked(at, amount, each, "mm") for each in place)
            places[point] = complex(x, y)
        return NearEntry(places, angle)

    # ----------------------------------------------------------------------- ask

    def _ask(self) -> Mapping[str, Any]:
        ask = self._table("ask")
        if not ask:
            raise self.refused(
                ("ask",), Message('an exercise asks something: [ask], then positions = ["theta3"], …')
            )
        self.only(ask, ASKED, ("ask",))
        for key in ("positions", "velocities", "accelerations", "polygon", "instant_centres"):
            value = ask.get(key, [])
            if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
                raise self.refused(
                    ("ask", key),
                    Message('{key} is a list of names: ["…", "…"]; found {value!r}', key=key, value=value),
                )
        points = ask.get("points", {})
        if not isinstance(points, Mapping) or not all(
            isinstance(n, (int, float)) and 0 < n <= _MOST_POINTS for n in points.values()
        ):
            raise self.refused(
                ("ask", "points"),
                Message("points = {{ theta3 = 2 }} weighs questions; found {points!r}", points=points),
            )
        return ask

    def _loads(self, bodies: Mapping[str, BodyEntry]) -> tuple[LoadEntry, ...]:
        torque = (
            self.table.get("ask", {}).get("torque") if isinstance(self.table.get("ask"), Mapping) else None
        )
        if torque is None:
            return ()
        at = ("ask", "torque")
        loads = torque.get("load") if isinstance(torque, Mapping) else None
        loads = [loads] if isinstance(loads, Mapping) else loads
        form = 'torque = { load = { on = "4", moment = "20 N*m" } }, or { on = "B", force = "100 N", angle = "180 deg" }'
        if not isinstance(loads, list) or not loads or not all(isinstance(each, Mapping) for each in loads):
            raise self.refused(at, Message("{form}; found {torque!r}", form=form, torque=torque))
        results = []
        for load in loads:
            self.only(load, ("on", "moment", "force", "angle"), at, "load")
            on = str(load.get("on", ""))
            points = [p for b in bodies.values() for p in b.points]
            known = bodies if "moment" in load else points
            if ("moment" in load) == ("force" in load) or on not in known:
                raise self.refused(
                    at,
                    Message(
                        "a moment acts on a body, a force at a point: {form}; found {found!r}",
                        form=form,
                        found=dict(load),
                    ),
                )
            results.append(
                LoadEntry(
                    on,
                    self._expression(at, load["moment"], "N*m", f"M{on}") if "moment" in load else None,
                    self._expression(at, load["force"], "N", f"F{on}") if "force" in load else None,
                    self._expression(at, load.get("angle", "0 deg"), "deg", f"delta_F{on}"),
                )
            )
        return tuple(results)

    def _known(self) -> tuple[tuple[Mapping[str, float | str], Mapping[str, tuple[str, str]]], ...]:
        """Return results that are known, such as those of a textbook."""
        cases = self.table.get("known", [])
        form = '[[known]], then given = { r2 = "50 mm" } and gives = { theta3 = "36.87 deg" }'
        if not isinstance(cases, list) or not all(
            isinstance(c, Mapping)
            and isinstance(c.get("given"), Mapping)
            and isinstance(c.get("gives"), Mapping)
            for c in cases
        ):
            raise self.refused(
                ("known",), Message("known results are {form}; found {cases!r}", form=form, cases=cases)
            )
        results = []
        for number, case in enumerate(cases):
            at = ("known", number)
            self.only(case, ("given", "gives"), at, "known")
            given: dict[str, float | str] = {}
            for name, value in case["given"].items():
                if name.startswith("mode_"):
                    given[name] = str(value)
                elif name not in self.units:
                    near = nearest(name, self.units)
                    raise self.refused(at, Message("no quantity {name!r}{near}", name=name, near=near))
                else:
                    given[name] = self._checked(at, amount, value, self.units[name])
            gives = {}
            for name, value in case["gives"].items():
                match = re.fullmatch(r"\s*([+-]?\d+(?:\.\d+)?)\s*(\S*)\s*", str(value))
                if match is None or not _NAME.match(name):
                    raise self.refused(
                        at, Message("known results are {form}; found {cases!r}", form=form, cases=case)
                    )
                gives[name] = match[1], match[2]
            results.append((given, gives))
        return tuple(results)

    # -------------------------------------------------------------------- faults

    def _faults(self, linkage: LinkageFile) -> Iterator[BadInput]:
        """Yield what bodies and joints do not make: what holds each body, and how many ways all of them move."""
        geared = {body for g in linkage.gears for body in (g.first, g.second)}
        hold = {
            name: [
                *(p for p in body.points if p in linkage.pins),
                *(s.at for s in linkage.slides.values() if name in (s.of, s.on)),
            ]
            for name, body in linkage.bodies.items()
        }
        for name in (n for n, joints in hold.items() if not joints):
            points = ", ".join(linkage.bodies[name].points)
            yield self.refused(
                ("bodies", name),
                Message(
                    "body {name} is in the air: it shares none of its points {points} with another body, and does not slide",
                    name=name,
                    points=points,
                ),
            )
        for name, joints in hold.items():
            if len(joints) < 2 and name != linkage.driver and name not in geared:
                yield self.refused(
                    ("bodies", name),
                    Message(
                        "body {name} hangs on {value} alone; a second point that it shares, or a slide, holds it",
                        name=name,
                        value=joints[0],
                    ),
                )
        crank = linkage.bodies[linkage.driver]
        if crank.at not in linkage.ground:
            yield self.refused(
                ("bodies", crank.name),
                Message(
                    "the driven body {name} turns about a point of the ground; {at} is none",
                    name=crank.name,
                    at=crank.at,
                ),
            )
        if linkage.mobility != 1:
            pins = sum(len(b) - 1 for b in linkage.pins.values())
            count = f"3 × {len(linkage.bodies)} bodies, less 2 × {pins + len(linkage.slides)} pins and slides"
            count += f", less {len(linkage.gears)} gears" if linkage.gears else ""
            does = (
                Message("nothing moves") if linkage.mobility < 1 else Message("one driver does not settle it")
            )
            yield self.refused(
                ("bodies",),
                Message(
                    "the mechanism has {mobility} degrees of freedom ({count}), a driver moves 1: {does}",
                    mobility=linkage.mobility,
                    count=count,
                    does=does,
                ),
            )
        for name, entry in linkage.assembly.items():
            for point in (name, entry.start, entry.end):
                if point and point not in linkage.points:
                    yield self.refused(
                        ("assembly", name),
                        Message(
                            "no point {point!r}{found}", point=point, found=nearest(point, linkage.points)
                        ),
                    )


def _is_amount(value: object) -> bool:
    return re.match(r"\s*[+-]?\d", str(value)) is not None
