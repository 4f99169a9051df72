"""Entries of a mechanism's file as data: places, bodies, joints, loads, and the whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coursework.errors import BadInput
from coursework.linkages.expressions import ZERO, QuantityExpression
from coursework.system.toml_files import TomlReader

GROUND = "ground"


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
    """Moving body: its points in its own frame, by name; the quantity or the constant that turns it, if the
    file states one."""

    name: str
    points: Mapping[str, Place]
    at: str
    angle: QuantityExpression | None = None


@dataclass(frozen=True)
class SlideEntry:
    """Point of a body that slides on a line of another: the line's point and direction in the guide's frame,
    the name of the distance along it."""

    at: str
    of: str
    on: str
    through: Place
    through_name: str
    along: QuantityExpression
    distance: str

    @property
    def rates(self) -> tuple[str, str]:
        """Names of its speed and of its acceleration."""
        return f"{self.distance}_dot", f"{self.distance}_ddot"


@dataclass(frozen=True)
class GearEntry:
    """Two wheels that roll on each other, and the carrier of their centres."""

    first: str
    second: str
    carrier: str
    radii: tuple[QuantityExpression, QuantityExpression]
    inner: bool


@dataclass(frozen=True)
class DriverEntry:
    """Driver of a mechanism.

    ``kind``: a ``turn`` of the body about a point of the ground, a ``slide`` of it on the ground, or a
    ``jack`` whose cylinder and rod are pinned to other bodies; ``moved`` is the quantity that says how far,
    an angle or a length. The body of a jack holds its two pins, the second at the distance ``moved`` from the
    first; ``rod`` is the name of the half that comes out. ``limits`` are the quantities between which a
    length goes.
    """

    kind: str
    body: str
    moved: str
    rod: str = ""
    limits: tuple[str, str] = ("", "")

    @property
    def rates(self) -> tuple[str, str]:
        """Names of its speed and of its acceleration."""
        if self.kind == "turn":
            return self.moved.replace("theta", "omega", 1), self.moved.replace("theta", "alpha", 1)
        return f"{self.moved}_dot", f"{self.moved}_ddot"


@dataclass(frozen=True)
class AssemblyEntry:
    """Ways to assemble a group: ``left`` and ``right`` of a line between two points, or ``ahead`` and
    ``behind`` on a slide; one, or those among which a variant draws."""

    ways: tuple[str, ...]
    start: str = ""
    end: str = ""

    @property
    def is_drawn(self) -> bool:
        return len(self.ways) > 1


@dataclass(frozen=True)
class NearEntry:
    """Start of Newton's method: places of points, mm, with the driver at an angle, degrees, or at a length,
    mm."""

    places: Mapping[str, complex]
    driver: float


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
    required: tuple[str, ...]  #: conditions on the draws
    drive: DriverEntry
    name: str
    #: Given values, then results as text and unit.
    known: tuple[tuple[Mapping[str, float | str], Mapping[str, tuple[str, str]]], ...] = ()

    def refused(self, at: Sequence[str | int], template: str, /, **values: Any) -> BadInput:
        """Return the error of a key, with file and line."""
        return TomlReader(self.path, self.source).refused(at, template, **values)

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
    def driver(self) -> str:
        """The body that is driven."""
        return self.drive.body

    @property
    def jack(self) -> str:
        """The body that is the driving jack; '' for any other driver."""
        return self.drive.body if self.drive.kind == "jack" else ""

    @property
    def moved(self) -> str:
        """The quantity of the driver: an angle, or a length."""
        return self.drive.moved

    @property
    def speed(self) -> str:
        """The quantity of the driver's speed; '' where the file gives none."""
        return next((n for n in self.drive.rates[:1] if n in self.given), "")

    @property
    def acceleration(self) -> str:
        """The quantity of the driver's acceleration; '' where the file gives none."""
        return next((n for n in self.drive.rates[1:] if n in self.given), "")

    @property
    def counts(self) -> tuple[int, int, int]:
        """Moving bodies, pins and slides, and contacts of teeth; a jack is two bodies and the slide between
        them."""
        pins = sum(len(bodies) - 1 for bodies in self.pins.values())
        jack = int(bool(self.jack))
        return len(self.bodies) + jack, pins + len(self.slides) + jack, len(self.gears)

    @property
    def mobility(self) -> int:
        """Degrees of freedom by the count 3 n - 2 b - h."""
        bodies, pairs, higher = self.counts
        return 3 * bodies - 2 * pairs - higher

    @property
    def slides_driven(self) -> str:
        """The point that slides where a slide drives; '' for any other driver."""
        return next((p for p, s in self.slides.items() if s.distance == self.moved), "")

    @property
    def followed_slides(self) -> tuple[SlideEntry, ...]:
        """Slides whose distance follows from the driver."""
        return tuple(s for s in self.slides.values() if s.distance != self.moved)
