"""Joints in space with their symbols, directions and bodies, from the viewpoint that separates them best."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

from coursework.figures import Element, Figure, line, point, vector
from coursework.figures.base import Positive
from coursework.figures.ink import BLOCKS, EDGE, TINT, WHITE, Disc, Path, added
from coursework.figures.placing import distance
from coursework.language.numbers import rounded

if TYPE_CHECKING:
    from coursework.figures.paper import FigurePaper

Place: TypeAlias = Sequence[float]  #: x, y and z, mm
See: TypeAlias = Callable[[Place], complex]  #: where a point is seen; a mm across the line of sight is a mm

#: Degrees from which the joints may be seen: about z from x, and above the plane of x and y. The first that
#: shows them well is taken; in all x comes towards the reader, y goes to the right and z up.
_VIEWS = [(about, above) for above in (20, 30, 12, 40) for about in (30, 20, 40, 50, 60, -20, -30, -40)]
_APART = 9.0  #: distance from which on two things are clearly distinguished, mm on paper
_SCALE = 1.0  #: at most
_WIDE = 110.0  #: what the points may take of the paper across, mm
_ARM = 6.0  #: of an axis to each side of its point, mm on paper
#: The base, and where it stands from the middle of the left side, mm on paper.
_BASE, _CORNER = (9.0, complex(-20, -4))
#: Half-length and radius of a tube, radius of a ball, half the side of a plate, mm on paper.
_LONG, _RADIUS, _BALL, _PLATE = (3.0, 1.5, 1.9, 3.2)
_ASIDE = 5.5  #: from a point to the symbol of one of several joints there, along its axis, mm on paper
_FEW, _SMALLER = 2, 0.75  #: more joints than a few have smaller symbols
_UNITS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


class _face(Element):
    """Face of a symbol, or a line in front of it: it hides earlier elements."""

    points: tuple[complex, ...]

    def draw(self, paper: FigurePaper) -> None:
        points = tuple(
            complex(rounded(z.real, 2), rounded(z.imag, 2)) for z in (p * paper.scale for p in self.points)
        )
        paper.draw(Path(points, EDGE, WHITE, closed=len(points) > 2, layer=BLOCKS))


class _ball(Element):
    """Ball of a symbol."""

    center: complex
    radius: Positive

    def draw(self, paper: FigurePaper) -> None:
        paper.draw(Disc(paper.at(self.center), paper.length(self.radius), EDGE, TINT, layer=BLOCKS))


def _looking(about: float, above: float) -> tuple[See, Place]:
    """Return the projection from a viewpoint (azimuth and elevation in degrees), and the unit vector towards
    the reader."""
    phi, eps = math.radians(about), math.radians(above)
    right = (-math.sin(phi), math.cos(phi), 0.0)
    up = (-math.cos(phi) * math.sin(eps), -math.sin(phi) * math.sin(eps), math.cos(eps))
    forward = (math.cos(phi) * math.cos(eps), math.sin(phi) * math.cos(eps), math.sin(eps))
    return lambda position: complex(_dot(position, right), _dot(position, up)), forward


def _dot(u: Place, v: Place) -> float:
    return added(a * b for a, b in zip(u, v, strict=True)).real


def _beyond(p: Place, u: Place, far: float) -> Place:
    return tuple(a + far * b for a, b in zip(p, u, strict=True))


def _steps(position: Place) -> list[tuple[Place, Place]]:
    """Return the lines from the origin to a point along y, then x, then z, without those of length zero."""
    x, y, z = position
    return list(pairwise(dict.fromkeys([(0, 0, 0), (0, y, 0), (x, y, 0), (x, y, z)])))


def in_perspective(
    rows: Sequence[Mapping[str, Any]], bodies: Iterable[tuple[int, int, int]] = (), *, tall: float = 36.0
) -> Figure:
    """Draw the joints of a statement's table (see ``table``).

    ``bodies`` are (number, first joint, second joint) of those drawn as a line between two points; ``tall``
    is the height on paper, mm. A point of several joints carries all their names, and their symbols stand
    beside it along their axes.
    """
    places = [tuple(map(float, row["point"])) for row in rows]
    chain = _Chain(rows, places, [(k, places[p - 1], places[q - 1]) for k, p, q in bodies])
    view = max(_VIEWS, key=lambda view: (round(chain.apart(view, tall), 2), -_VIEWS.index(view)))
    scale = chain.scale(view, tall)
    elements = chain.elements(view, scale)
    # What symbols take is known once they are drawn.
    over = scale * _height(elements) - tall
    if over > 0:
        scale = max(scale / 3, scale - over / chain.size(view).imag)
        elements = chain.elements(view, scale)
    return Figure(*elements, scale=scale)


def _height(elements: Sequence[Element]) -> float:
    heights = [z.imag for element in elements for z in element.reach()]
    return max(heights) - min(heights)


@dataclass(frozen=True)
class _Chain:
    """Joints, their points, and the bodies between them: number and both ends."""

    rows: Sequence[Mapping[str, Any]]
    places: Sequence[Place]
    bodies: Sequence[tuple[int, Place, Place]]

    @cached_property
    def steps(self) -> list[tuple[Place, Place]]:
        return list(dict.fromkeys(step for position in self.places for step in _steps(position)))

    @cached_property
    def corners(self) -> list[Place]:
        return list(dict.fromkeys(end for step in self.steps for end in step)) or list(self.places[:1])

    def size(self, view: tuple[float, float]) -> complex:
        """Return the projected width and height of the points."""
        see, _ = _looking(*view)
        across, up = ([see(c).real for c in self.corners], [see(c).imag for c in self.corners])
        return complex(max(across) - min(across), max(up) - min(up))

    def scale(self, view: tuple[float, float], tall: float) -> float:
        size = self.size(view)
        return min(_SCALE, _WIDE / (size.real or 1.0), tall / (size.imag or 1.0))

    def apart(self, view: tuple[float, float], tall: float) -> float:
        """Return the least distance on paper between two points, or between a point and a body that ends at
        others."""
        see, _ = _looking(*view)
        return min(
            _APART, self.scale(view, tall) * _least(see, list(dict.fromkeys(self.places)), self.bodies)
        )

    def elements(self, view: tuple[float, float], scale: float) -> list[Element]:
        see, forward = _looking(*view)
        mm = (1.0 if len(self.rows) <= _FEW else _SMALLER) / scale
        left, up = min(see(c).real for c in self.corners), [see(c).imag for c in self.corners]
        corner = complex(left, (min(up) + max(up)) / 2) + _CORNER / scale
        results: list[Element] = [
            vector(corner, _BASE / scale * see(u), rf"\vec{{{letter}}}") for letter, u in _UNITS.items()
        ]
        results += [line(see(p), see(q), dashed=True) for p, q in self.steps]
        results += [line(see(p), see(q), thin=False, label=f"S_{k}") for k, p, q in self.bodies if p != q]
        for k, (row, position) in enumerate(zip(self.rows, self.places, strict=True)):
            before, there = self.places[:k].count(position), self.places.count(position)
            aside = 0.0 if there == 1 else _ASIDE * mm * (1 if before % 2 else -1)
            results += _symbol(row, position, aside, see, forward, mm)
        for position in dict.fromkeys(self.places):
            names = [f"A_{k}" for k, other in enumerate(self.places, start=1) if other == position]
            results.append(point(see(position), "=".join(names)))
        return list(dict.fromkeys(results))


def _least(see: See, places: Sequence[Place], bodies: Sequence[tuple[int, Place, Place]]) -> float:
    """Return the least projected distance between two points, or between a point and a body that ends
    elsewhere."""
    gaps = [abs(see(p) - see(q)) for p, q in combinations(places, 2)]
    gaps += [
        distance(see(r), see(p), see(q)) for _, p, q in bodies if p != q for r in places if r not in (p, q)
    ]
    return min(gaps, default=math.inf)


def _symbol(
    row: Mapping[str, Any], position: Place, aside: float, see: See, forward: Place, mm: float
) -> list[Element]:
    """Return a joint's axis and its symbol, which hides what is behind it; ``mm`` is a mm of the symbol."""
    kind = row["joint"]
    shape, depth = _DRAWN[kind]
    if kind == "spherical":
        return shape(position, _UNITS["z"], see, forward, mm)
    u = _unit(row["axis"]) if "axis" in row else _UNITS[row["along"]]
    center = _beyond(position, u, aside) if kind in _ALONG else position
    front = 1 if _dot(u, forward) >= 0 else -1
    arm = _ARM * mm + abs(aside)
    behind = line(see(_beyond(position, u, -front * arm)), see(position), thin=False)
    before = _face((see(_beyond(center, u, front * depth * mm)), see(_beyond(position, u, front * arm))))
    return [behind, *shape(center, u, see, forward, mm), before]


def _tube(
    center: Place, u: Place, see: See, forward: Place, mm: float, long: float = _LONG, radius: float = _RADIUS
) -> list[Element]:
    """Return a cylinder about an axis: its outline, then the visible end."""
    e1, e2 = _across(u)

    def rim(far: float) -> list[complex]:
        turns = [math.tau * k / 24 for k in range(24)]
        return [
            see(
                _beyond(
                    _beyond(_beyond(center, u, far), e1, radius * mm * math.cos(t)),
                    e2,
                    radius * mm * math.sin(t),
                )
            )
            for t in turns
        ]

    front = long * mm if _dot(u, forward) >= 0 else -long * mm
    return [_face(_hull(rim(front) + rim(-front))), _face(tuple(rim(front)))]


def _stopped(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    """Return a cylinder between two collars, which prevent sliding."""
    ends = [_beyond(center, u, far * (_LONG + 0.4) * mm) for far in (-1, 1)]
    back, front = ends if _dot(u, forward) >= 0 else ends[::-1]
    collar = {"long": 0.35, "radius": 1.6 * _RADIUS}
    return [
        *_tube(back, u, see, forward, mm, **collar),
        *_tube(center, u, see, forward, mm),
        *_tube(front, u, see, forward, mm, **collar),
    ]


def _threaded(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    """Return a cylinder with a thread across it."""
    _, e2 = _across(u)
    direction = [
        _beyond(_beyond(center, u, far * 0.7 * _LONG * mm), e2, far * _RADIUS * mm) for far in (-1, 1)
    ]
    return [*_tube(center, u, see, forward, mm), _face(tuple(map(see, direction)))]


def _box(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    """Return a block along an axis: its three visible faces."""
    e1, e2 = _across(u)
    half = ((u, _LONG * mm), (e1, _RADIUS * mm), (e2, _RADIUS * mm))
    faces: list[Element] = []
    for k, (direction, far) in enumerate(half):
        (v, a), (w, b) = half[k - 2], half[k - 1]
        middle = _beyond(center, direction, far if _dot(direction, forward) >= 0 else -far)
        corners = [
            _beyond(_beyond(middle, v, i * a), w, j * b) for i, j in ((1, 1), (1, -1), (-1, -1), (-1, 1))
        ]
        faces.append(_face(tuple(map(see, corners))))
    return faces


def _plate(center: Place, u: Place, see: See, mm: float) -> _face:
    """Return a square across an axis."""
    e1, e2 = _across(u)
    corners = [
        _beyond(_beyond(center, e1, i * _PLATE * mm), e2, j * _PLATE * mm)
        for i, j in ((1, 1), (1, -1), (-1, -1), (-1, 1))
    ]
    return _face(tuple(map(see, corners)))


def _plates(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    """Return two plates that slide on each other, the one behind first."""
    far = 0.9 * mm if _dot(u, forward) >= 0 else -0.9 * mm
    return [_plate(_beyond(center, u, side * far), u, see, mm) for side in (-1, 1)]


def _round(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    return [_ball(see(center), _BALL * mm)]


def _pinned(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    """Return a ball with a pin across its axis, in the direction that shows best."""
    across = max(_across(u), key=lambda e: abs(see(e)))
    pin = _face(tuple(see(_beyond(center, across, far * 1.9 * _BALL * mm)) for far in (-1, 1)))
    return [pin, *_round(center, u, see, forward, mm)]


def _grooved(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    """Return a ball in a groove along its axis."""
    return [
        *_tube(center, u, see, forward, mm, 1.2 * _LONG, 1.2 * _BALL),
        *_round(center, u, see, forward, mm),
    ]


def _on_plate(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    """Return a ball on the visible side of a plate."""
    side = _BALL * mm if _dot(u, forward) >= 0 else -_BALL * mm
    return [_plate(center, u, see, mm), *_round(_beyond(center, u, side), u, see, forward, mm)]


def _on_line(center: Place, u: Place, see: See, forward: Place, mm: float) -> list[Element]:
    """Return a roller along its axis."""
    return _tube(center, u, see, forward, mm, 1.2 * _LONG, 0.6 * _RADIUS)


Shape: TypeAlias = Callable[[Place, Place, See, Place, float], list[Element]]

#: What is drawn of each joint, and how far it comes along its axis towards the reader, mm on paper.
_DRAWN: dict[str, tuple[Shape, float]] = {
    "revolute": (_stopped, _LONG + 0.7),
    "cylindrical": (_tube, _LONG),
    "helical": (_threaded, _LONG),
    "prismatic": (_box, _LONG),
    "spherical": (_round, 0.0),
    "spherical_pin": (_pinned, _BALL),
    "planar": (_plates, 0.9),
    "annular": (_grooved, 1.2 * _LONG),
    "line_contact": (_on_line, 1.2 * _LONG),
    "point_contact": (_on_plate, 2 * _BALL),
}
#: Those whose symbol may stand anywhere on the axis.
_ALONG = ("revolute", "cylindrical", "helical", "prismatic")


def _unit(vector: Place) -> Place:
    size = math.hypot(*vector)
    return tuple(x / size for x in vector)


def _across(u: Place) -> tuple[Place, Place]:
    """Return the two other axes in cyclic order; for any other direction, two unit vectors perpendicular to
    it."""
    units: list[Place] = list(_UNITS.values())
    if u in units:
        k = units.index(u)
        return units[k - 2], units[k - 1]
    level = _unit((-u[1], u[0], 0.0)) if u[0] or u[1] else _UNITS["x"]
    x, y, z = level
    return level, (u[1] * z - u[2] * y, u[2] * x - u[0] * z, u[0] * y - u[1] * x)


def _hull(points: Sequence[complex]) -> tuple[complex, ...]:
    """Return the convex hull, anticlockwise."""
    ordered = sorted(
        {complex(round(z.real, 6), round(z.imag, 6)) for z in points}, key=lambda z: (z.real, z.imag)
    )

    def half(direction: Sequence[complex]) -> list[complex]:
        results: list[complex] = []
        for z in direction:
            while (
                len(results) > 1 and ((results[-1] - results[-2]).conjugate() * (z - results[-2])).imag <= 0
            ):
                results.pop()
            results.append(z)
        return results[:-1]

    return (*half(ordered), *half(ordered[::-1]))
