"""The parts a figure is made of: each knows its extent, its bars, and how to draw itself.

Their names are lower-case since an instructor writes them as one writes a function.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, fields
from functools import lru_cache
from itertools import pairwise

from coursework.errors import CourseworkError, WrongValue
from coursework.figures.ink import (
    BAR,
    BARS,
    BLACK,
    BLOCKS,
    CHAIN,
    DASHED,
    DOTTED,
    EDGE,
    FILLS,
    GUIDES,
    MARKS,
    NONE,
    PINS,
    THIN,
    TINT,
    WHITE,
    Arc,
    Disc,
    Path,
    turn,
)
from coursework.figures.paper import HEAD, Paper
from coursework.figures.placing import SIDES, distance, within
from coursework.figures.text import read

PIN = 1.1  #: radius of a pin, mm on paper
BLOCK = complex(3.2, 1.7)  #: half-length and half-height of a slider's block
SLOT = 2.2  #: half-width of a slotted guide
_NEAR = 1.4  #: where a label starts, from the centre of a pin
_AWAY = 1.15  #: where a label starts, from a line

Bars = tuple[tuple[complex, complex], ...]


class Element:
    """A part of a figure, in mechanism coordinates: complex numbers, mm, y up; degrees from +x."""

    def __post_init__(self) -> None:
        for name, kind in _fields(type(self)):
            object.__setattr__(self, name, self._checked(name, kind))

    def _checked(self, name: str, kind: str) -> object:
        value = getattr(self, name)
        try:
            value = _READ[kind](value)
        except CourseworkError:  # a label says itself what is wrong with it
            raise
        except (TypeError, ValueError) as error:
            raise WrongValue(f"{type(self).__name__}: {name} is {value!r}, not {_ASKED[kind]}") from error
        numbers = value if isinstance(value, tuple) else (value,)
        if any(isinstance(x, (float, complex)) and not cmath.isfinite(x) for x in numbers):
            raise WrongValue(f"{type(self).__name__}: {name} is {value!r}, not finite")
        return value

    def reach(self) -> tuple[complex, ...]:
        """Points that bound the element."""
        return tuple(z for name, _ in _fields(type(self)) for z in _points(getattr(self, name)))

    def bars(self) -> Bars:
        """Segments of the links, which labels and supports of pins keep away from."""
        return ()

    def draw(self, paper: Paper) -> None:
        raise NotImplementedError


@lru_cache(maxsize=128)
def _fields(element: type[Element]) -> tuple[tuple[str, str], ...]:
    """What a kind of element is told: the name of each value and its type, as written."""
    return tuple((item.name, str(item.type)) for item in fields(element))


def _points(value: object) -> tuple[complex, ...]:
    if isinstance(value, complex):
        return (value,)
    return value if isinstance(value, tuple) and all(isinstance(z, complex) for z in value) else ()


def _label(value: object) -> str:
    if value is None:
        return ""
    if not isinstance(value, str):
        raise TypeError
    return value if not value or read(value) else ""


def _positive(value: float) -> float:
    if not float(value) > 0:
        raise ValueError
    return float(value)


_READ = {
    "complex": complex,
    "float": float,
    "Positive": _positive,
    "Positive | None": lambda value: None if value is None else _positive(value),
    "float | None": lambda value: None if value is None else float(value),
    "bool": bool,
    "str | None": _label,
    "tuple[str, str]": lambda value: tuple(map(_label, value)),
    "tuple[complex, ...]": lambda value: tuple(map(complex, value)),
}
_ASKED = {
    "complex": "a point (a complex number)",
    "float": "a number",
    "Positive": "a positive number",
    "Positive | None": "a positive number",
    "float | None": "a number",
    "bool": "true or false",
    "str | None": "a label",
    "tuple[str, str]": "two labels",
    "tuple[complex, ...]": "points (complex numbers)",
}
Positive = float


def _round(center: complex, radius: float) -> tuple[complex, ...]:
    return tuple(center + radius * way for way in (1, 1j, -1, -1j))


def _swept(center: complex, radius: float, start: float, end: float) -> tuple[complex, ...]:
    steps = max(2, math.ceil(abs(end - start) / 15))
    return tuple(center + radius * turn(start + (end - start) * k / steps) for k in range(steps + 1))


def _ring(paper: Paper, p: complex) -> None:
    paper.draw(Disc(p, PIN, EDGE, WHITE, layer=PINS))


@dataclass(frozen=True)
class ground_pivot(Element):
    """A revolute joint with the frame: a pin on a hatched support."""

    p: complex
    label: str | None = None
    toward: float | None = None

    def draw(self, paper: Paper) -> None:
        p = paper.at(self.p)
        down = paper.ground_side(p)
        aside = 1j * down
        foot = p + 3.2 * down
        sides = (p, foot + 1.9 * aside, foot - 1.9 * aside)
        paper.draw(Path(sides, EDGE, WHITE, closed=True, layer=GUIDES))
        paper.draw(Path((foot - 2.9 * aside, foot + 2.9 * aside), EDGE))
        paper.hatch(foot - 2.9 * aside, foot + 2.9 * aside, down)
        _ring(paper, p)
        paper.around(self.label, p, _NEAR, (down * turn(35), down * turn(-35)), self.toward)


@dataclass(frozen=True)
class pin(Element):
    """A revolute joint between moving bodies."""

    p: complex
    label: str | None = None
    toward: float | None = None

    def draw(self, paper: Paper) -> None:
        _ring(paper, paper.at(self.p))
        paper.around(self.label, paper.at(self.p), _NEAR, toward=self.toward)


@dataclass(frozen=True)
class point(Element):
    """A point marked by a dot."""

    p: complex
    label: str | None = None
    toward: float | None = None

    def draw(self, paper: Paper) -> None:
        p = paper.at(self.p)
        paper.draw(Disc(p, 0.55, 0, BLACK, layer=MARKS))
        paper.around(self.label, p, 0.9, toward=self.toward)


@dataclass(frozen=True)
class contact(Element):
    """A point of contact between two bodies: a larger dot."""

    p: complex
    label: str | None = None
    toward: float | None = None

    def draw(self, paper: Paper) -> None:
        p = paper.at(self.p)
        paper.draw(Disc(p, 0.8, 0, BLACK, layer=MARKS))
        paper.around(self.label, p, 1.2, toward=self.toward)


@dataclass(frozen=True)
class note(Element):
    """Words or a symbol centred on a point if there is room, else near it; nothing is drawn there."""

    p: complex
    label: str | None

    def draw(self, paper: Paper) -> None:
        text = read(self.label) if self.label else None
        if text is not None:
            # A negative start lets the first candidate sit on the point itself.
            paper.toward(self.label, paper.at(self.p), 1j, -text.box[1] / 2, SIDES)


@dataclass(frozen=True)
class bar(Element):
    """A link between the pins ``points``: see :func:`link`."""

    points: tuple[complex, ...]
    label: str | None = None
    weld: bool = False

    def bars(self) -> Bars:
        closing = (self.points[-1], self.points[0])
        return (*pairwise(self.points), *((closing,) if len(self.points) > 2 and not self.weld else ()))

    def draw(self, paper: Paper) -> None:
        points = tuple(map(paper.at, self.points))
        plate = len(points) > 2 and not self.weld
        paper.draw(Path(points, BAR, TINT if plate else NONE, closed=plate, layer=FILLS if plate else BARS))
        if self.weld:
            for before, corner, after in zip(points, points[1:], points[2:], strict=False):
                _gusset(paper, before, corner, after)
        if plate:
            center = sum(points) / len(points)
            paper.toward(self.label, center, 1j, -read(self.label).box[1] / 2 if self.label else 0.0, SIDES)
        else:
            longest = max(pairwise(points), key=lambda pair: abs(pair[1] - pair[0]))
            paper.beside(self.label, *longest, _AWAY)


def _gusset(paper: Paper, before: complex, corner: complex, after: complex) -> None:
    """A small filled triangle: the two bars are one body."""
    legs = [corner + 2.6 * (z - corner) / (abs(z - corner) or 1.0) for z in (before, after)]
    paper.draw(Path((corner, *legs), THIN, BLACK, closed=True, layer=BARS))


def link(p: complex, q: complex, *more: complex, label: str | None = None, weld: bool = False) -> bar:
    """A bar from pin ``p`` to pin ``q``.

    With more points, a plate (a tinted polygon) whose corners are the points; or, with
    ``weld``, one bent bar through them, its corners made rigid by a small gusset.
    """
    return bar((p, q, *more), label, weld)


@dataclass(frozen=True)
class slot_link(Element):
    """A slotted guide from ``p`` to ``q``: a block slides between its two edges."""

    p: complex
    q: complex
    label: str | None = None

    def bars(self) -> Bars:
        return ((self.p, self.q),)

    def draw(self, paper: Paper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        heading = math.degrees(cmath.phase(q - p))
        ends = ((q, heading - 90), (p, heading + 90))
        edge = tuple(z + SLOT * turn(start + 22.5 * k) for z, start in ends for k in range(9))
        paper.draw(Path(edge, EDGE, WHITE, closed=True, layer=GUIDES, solid=True))
        paper.draw(Path((p, q), THIN, dash=CHAIN, layer=GUIDES))
        paper.beside(self.label, p, q, SLOT + _AWAY)


@dataclass(frozen=True)
class slider(Element):
    """A block centred on ``p``, its length along ``direction`` (degrees). Its pin, if any, is a ``pin``."""

    p: complex
    direction: float = 0.0
    label: str | None = None

    def draw(self, paper: Paper) -> None:
        p, way = paper.at(self.p), turn(paper.degrees(self.direction))
        half = (BLOCK, BLOCK.conjugate(), -BLOCK, -BLOCK.conjugate())
        paper.draw(Path(tuple(p + way * z for z in half), EDGE, TINT, closed=True, layer=BLOCKS))
        paper.around(self.label, p, BLOCK.imag + _AWAY, (way, -way))


@dataclass(frozen=True)
class rail(Element):
    """A fixed guide for a slider whose centre moves from ``p`` to ``q``.

    The guide touches the block on the right of p→q, below when p→q goes to the right, and
    is hatched on its far side.
    """

    p: complex
    q: complex

    def draw(self, paper: Paper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        if p == q:
            return
        side = -1j * (q - p) / abs(q - p)
        shift = side * (BLOCK.imag + EDGE / 2)
        paper.draw(Path((p + shift, q + shift), EDGE))
        paper.hatch(p + shift, q + shift, side)


@dataclass(frozen=True)
class line(Element):
    """A plain line."""

    p: complex
    q: complex
    dashed: bool = False
    thin: bool = True
    label: str | None = None

    def draw(self, paper: Paper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        paper.draw(Path((p, q), THIN if self.thin else EDGE, dash=DASHED if self.dashed else ""))
        paper.beside(self.label, p, q, _AWAY)


@dataclass(frozen=True)
class centre_line(Element):
    """An axis of symmetry or of rotation, chain-dotted."""

    p: complex
    q: complex
    label: str | None = None

    def draw(self, paper: Paper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        paper.draw(Path((p, q), THIN, dash=CHAIN))
        paper.toward(self.label, q, q - p, 0.6, SIDES)


@dataclass(frozen=True)
class circle(Element):
    """A circle: the path of a pin, a construction, a gear's pitch circle."""

    center: complex
    radius: Positive
    dashed: bool = False
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return _round(self.center, self.radius)

    def draw(self, paper: Paper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        paper.draw(Disc(center, radius, THIN, dash=DASHED if self.dashed else ""))
        paper.toward(self.label, center, turn(45), radius + 0.7, SIDES)


@dataclass(frozen=True)
class arc(Element):
    """An arc, counter-clockwise when ``to_deg`` is the larger angle."""

    center: complex
    radius: Positive
    from_deg: float
    to_deg: float
    dashed: bool = False

    def reach(self) -> tuple[complex, ...]:
        return _swept(self.center, self.radius, self.from_deg, self.to_deg)

    def draw(self, paper: Paper) -> None:
        ends = paper.degrees(self.from_deg), paper.degrees(self.to_deg)
        radius = paper.length(self.radius)
        paper.draw(Arc(paper.at(self.center), radius, *ends, THIN, DASHED if self.dashed else ""))


@dataclass(frozen=True)
class axes(Element):
    """Two arrows, along +x and +y."""

    origin: complex
    length: Positive
    labels: tuple[str, str] = ("x", "y")

    def reach(self) -> tuple[complex, ...]:
        return self.origin, self.origin + self.length, self.origin + 1j * self.length

    def draw(self, paper: Paper) -> None:
        origin, length = paper.at(self.origin), paper.length(self.length)
        for way, label in zip((1, 1j), self.labels, strict=True):
            paper.arrow(origin, origin + length * way, THIN, HEAD * 0.8)
            paper.toward(label, origin + length * way, way * turn(-45 if way == 1 else 45), 0.6, SIDES)


@dataclass(frozen=True)
class rotation_arrow(Element):
    """An arc with an arrow head at ``to_deg``: a sense of rotation."""

    center: complex
    radius: Positive
    from_deg: float
    to_deg: float
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return _swept(self.center, self.radius, self.from_deg, self.to_deg)

    def draw(self, paper: Paper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        start, end = paper.degrees(self.from_deg), paper.degrees(self.to_deg)
        paper.arc_arrow(center, radius, start, end, HEAD)
        paper.toward(self.label, center, turn((start + end) / 2), radius + _AWAY)


@dataclass(frozen=True)
class angle_mark(Element):
    """An angle: an arc from a thin reference line at ``from_deg`` to an arrow head at ``to_deg``.

    ``radius`` is in mechanism mm; by default the arc has 9 mm on paper,
    less when a bar that ends there is short.
    """

    center: complex
    from_deg: float
    to_deg: float
    label: str | None = None
    radius: Positive | None = None

    def reach(self) -> tuple[complex, ...]:
        return (self.center, *_swept(self.center, self.radius or 0.0, self.from_deg, self.to_deg))

    def draw(self, paper: Paper) -> None:
        center = paper.at(self.center)
        radius = paper.length(self.radius) if self.radius else min(9.0, max(4.0, 0.6 * paper.room(center)))
        start, end = paper.degrees(self.from_deg), paper.degrees(self.to_deg)
        paper.draw(Path((center, center + (radius + 3.0) * turn(start)), THIN))
        paper.arc_arrow(center, radius, start, end, 1.7)
        paper.toward(self.label, center, turn((start + end) / 2), radius + _AWAY)


@dataclass(frozen=True)
class dimension(Element):
    """A dimension line with two arrow heads and its extension lines.

    ``offset`` is in mechanism mm, positive to the left of p→q; by default the line stands
    7 mm away on paper, or as far as it must to miss the links. ``offset=0`` measures on p–q itself.
    """

    p: complex
    q: complex
    label: str | None = None
    offset: float | None = None

    def reach(self) -> tuple[complex, ...]:
        shift = self._normal(self.p, self.q) * (self.offset or 0.0)
        return self.p, self.q, self.p + shift, self.q + shift

    @staticmethod
    def _normal(p: complex, q: complex) -> complex:
        return 1j * (q - p) / (abs(q - p) or 1.0)

    def draw(self, paper: Paper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        normal = self._normal(p, q)
        gap = paper.aside(p, q) if self.offset is None else round(self.offset * paper.scale, 1)
        way = normal if gap >= 0 else -normal
        a, b = p + normal * gap, q + normal * gap
        for foot, end in ((p, a), (q, b)):
            if abs(gap) > 1.5:
                paper.draw(Path((foot + way, end + way), THIN))
        _measured(paper, a, b)
        paper.beside(self.label, a, b, 0.7, way)


def _measured(paper: Paper, a: complex, b: complex) -> None:
    """A line with a head at each end; the heads come from outside when there is no room between."""
    if a == b:
        return
    way = (b - a) / abs(b - a)
    size = 1.9
    if abs(b - a) > 3 * size:
        paper.draw(Path((a + way * size * 0.8, b - way * size * 0.8), THIN, layer=MARKS))
        paper.head(a, -way, size)
        paper.head(b, way, size)
    else:
        paper.draw(Path((a, b), THIN, layer=MARKS))
        paper.arrow(a - way * 2.2 * size, a, THIN, size)
        paper.arrow(b + way * 2.2 * size, b, THIN, size)


@dataclass(frozen=True)
class vector(Element):
    """An arrow from ``p`` to ``p + v``; the author scales a velocity or a force to mm of mechanism."""

    p: complex
    v: complex
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return self.p, self.p + self.v

    def draw(self, paper: Paper) -> None:
        p, tip = paper.at(self.p), paper.at(self.p + self.v)
        paper.arrow(p, tip, 0.45, 2.8)
        paper.beside(self.label, p, tip, _AWAY)


@dataclass(frozen=True)
class scale_bar(Element):
    """A bar from ``p`` to the right with a tick at each end: what so long a line stands for."""

    p: complex
    length: Positive
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return self.p, self.p + self.length

    def draw(self, paper: Paper) -> None:
        p, q = paper.at(self.p), paper.at(self.p + self.length)
        paper.draw(Path((p, q), BAR), *(Path((z - 1j, z + 1j), EDGE) for z in (p, q)))
        paper.beside(self.label, p, q, _AWAY, -1j)


@dataclass(frozen=True)
class trace(Element):
    """A thin curve through points: the path of one, dotted unless told."""

    points: tuple[complex, ...]
    dotted: bool = True

    def draw(self, paper: Paper) -> None:
        paper.draw(Path(tuple(map(paper.at, self.points)), THIN, dash=DOTTED if self.dotted else ""))


@dataclass(frozen=True)
class section(Element):
    """A solid cut by the plane of the figure: a polygon with hatching.

    ``angle`` (degrees) tells neighbouring bodies apart: 45 for one, -45 for the other.
    """

    points: tuple[complex, ...]
    label: str | None = None
    angle: float = 45.0
    spacing: Positive = 2.0

    def draw(self, paper: Paper) -> None:
        points = tuple(map(paper.at, self.points))
        hole = _hole(points, read(self.label).box) if self.label else ()
        for a, b in _hatching((points, hole), turn(self.angle), self.spacing):
            paper.draw(Path((a, b), THIN, layer=FILLS))
        paper.draw(Path(points, EDGE, closed=True, layer=GUIDES, solid=True))
        if hole:
            paper.inside(self.label, sum(hole) / 4, read(self.label).box[1])
        else:
            paper.beside(self.label, *max(_sides(points), key=lambda side: abs(side[1] - side[0])), _AWAY)


def _sides(points: tuple[complex, ...]) -> Bars:
    return tuple(pairwise((*points, *points[:1])))


def _hole(points: tuple[complex, ...], box: tuple[float, float]) -> tuple[complex, ...]:
    """Corners of a gap in the hatching for a label, where the polygon is widest; none if it fits nowhere."""
    half = complex(box[0] / 2 + 1, box[1] / 2 + 1)
    corners = (half, -half.conjugate(), -half, half.conjugate())
    rim = (*corners, half.real, -half.real, 1j * half.imag, -1j * half.imag)
    xs, ys = [z.real for z in points], [z.imag for z in points]
    grid = [
        complex(min(xs) + (max(xs) - min(xs)) * j / 12, min(ys) + (max(ys) - min(ys)) * k / 12)
        for j in range(1, 12)
        for k in range(1, 12)
    ]
    closed = (*points, points[0])

    def room(center: complex) -> float:
        return min(distance(center + z, a, b) for z in rim for a, b in pairwise(closed))

    fitting = [center for center in grid if all(within(center + z, closed) for z in rim)]
    middle = sum(grid) / len(grid)
    best = max(fitting, key=lambda z: (round(room(z), 1), -round(abs(z - middle), 3)), default=None)
    return () if best is None else tuple(best + z for z in corners)


def _hatching(
    outlines: tuple[tuple[complex, ...], ...], way: complex, spacing: float
) -> list[tuple[complex, complex]]:
    """Segments of parallel lines inside a polygon with holes, by the even-odd rule in the lines' own axes."""
    sides = [(a * way.conjugate(), b * way.conjugate()) for points in outlines for a, b in _sides(points)]
    low, high = min(a.imag for a, _ in sides), max(a.imag for a, _ in sides)
    segments = []
    for k in range(math.ceil(low / spacing), math.floor(high / spacing) + 1):
        level = k * spacing + 1e-6  # a hair off the corners, which lie on tenths
        cuts = sorted(
            a.real + (b.real - a.real) * (level - a.imag) / (b.imag - a.imag)
            for a, b in sides
            if (a.imag > level) != (b.imag > level)
        )
        segments += [(complex(s, level) * way, complex(e, level) * way) for s, e in _by_two(cuts)]
    return segments


def _by_two(cuts: list[float]) -> list[tuple[float, float]]:
    """A line enters and leaves: cuts go by two."""
    return list(zip(cuts[::2], cuts[1::2], strict=True))


@dataclass(frozen=True)
class ball(Element):
    """A ball, or a disc, in section: a tinted circle."""

    center: complex
    radius: Positive
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return _round(self.center, self.radius)

    def draw(self, paper: Paper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        paper.draw(Disc(center, radius, EDGE, TINT, layer=GUIDES))
        paper.around(self.label, center, 0.9)


@dataclass(frozen=True)
class wheel(Element):
    """A wheel or a cam: a tinted disc beneath the bars, the supports and the pins."""

    center: complex
    radius: Positive
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return _round(self.center, self.radius)

    def draw(self, paper: Paper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        paper.draw(Disc(center, radius, EDGE, TINT, layer=FILLS))
        paper.around(self.label, center, 0.9)
