"""Elements of a figure: each computes its extent and its bars, and draws itself.

Class names are lower-case, since authors write them like functions.
"""

from __future__ import annotations

import cmath
import math
from itertools import pairwise
from typing import TYPE_CHECKING

from coursework.figures.base import (
    AWAY,
    BLOCK,
    NEAR,
    SLOT,
    Bars,
    Element,
    Positive,
    Shade,
    circle_points,
    ring,
)
from coursework.figures.ink import (
    BAR,
    BARS,
    BLACK,
    BLOCKS,
    CHAIN,
    EDGE,
    FILLS,
    GUIDES,
    MARKS,
    NONE,
    SHADES,
    SIDES,
    THIN,
    TINT,
    WHITE,
    Disc,
    Path,
    added,
    turn,
)
from coursework.language.numbers import rounded

if TYPE_CHECKING:
    from coursework.figures.paper import FigurePaper


class ground_pivot(Element):
    """Revolute joint with the frame: a pin on a hatched support."""

    p: complex
    label: str | None = None
    toward: float | None = None

    def draw(self, paper: FigurePaper) -> None:
        p = paper.at(self.p)
        down = paper.ground_side(p)
        aside = 1j * down
        foot = p + 3.2 * down
        sides = (p, foot + 1.9 * aside, foot - 1.9 * aside)
        paper.draw(Path(sides, EDGE, WHITE, closed=True, layer=GUIDES))
        paper.draw(Path((foot - 2.9 * aside, foot + 2.9 * aside), EDGE))
        paper.hatch(foot - 2.9 * aside, foot + 2.9 * aside, down)
        ring(paper, p)
        paper.around(self.label, p, NEAR, (down * turn(35), down * turn(-35)), self.toward)


class pin(Element):
    """Revolute joint between moving bodies."""

    p: complex
    label: str | None = None
    toward: float | None = None

    def draw(self, paper: FigurePaper) -> None:
        ring(paper, paper.at(self.p))
        paper.around(self.label, paper.at(self.p), NEAR, toward=self.toward)


class point(Element):
    """Point marked by a dot."""

    p: complex
    label: str | None = None
    toward: float | None = None

    def draw(self, paper: FigurePaper) -> None:
        p = paper.at(self.p)
        paper.draw(Disc(p, 0.55, 0, BLACK, layer=MARKS))
        paper.around(self.label, p, 0.9, toward=self.toward)


class contact(Element):
    """Point of contact between two bodies: a larger dot."""

    p: complex
    label: str | None = None
    toward: float | None = None

    def draw(self, paper: FigurePaper) -> None:
        p = paper.at(self.p)
        paper.draw(Disc(p, 0.8, 0, BLACK, layer=MARKS))
        paper.around(self.label, p, 1.2, toward=self.toward)


class bar(Element):
    """Link between the pins ``points``: see :func:`link`."""

    points: tuple[complex, ...]
    label: str | None = None
    weld: bool = False

    def bars(self) -> Bars:
        closing = (self.points[-1], self.points[0])
        return (*pairwise(self.points), *((closing,) if len(self.points) > 2 and not self.weld else ()))

    def draw(self, paper: FigurePaper) -> None:
        points = tuple(map(paper.at, self.points))
        plate = len(points) > 2 and not self.weld
        paper.draw(Path(points, BAR, TINT if plate else NONE, closed=plate, layer=FILLS if plate else BARS))
        if self.weld:
            for before, corner, after in zip(points, points[1:], points[2:], strict=False):
                _gusset(paper, before, corner, after)
        if plate:
            from coursework.figures.text import read

            center = added(points) / len(points)
            start = -read(self.label).box[1] / 2 if self.label else 0.0
            paper.toward(self.label, center, 1j, start, SIDES, area=(*points, points[0]))
        else:
            longest = max(pairwise(points), key=lambda pair: abs(pair[1] - pair[0]))
            paper.beside(self.label, *longest, AWAY)


def _gusset(paper: FigurePaper, before: complex, corner: complex, after: complex) -> None:
    """Draw a small filled triangle in a corner: the two bars are one body."""
    legs = [corner + 2.6 * (z - corner) / (abs(z - corner) or 1.0) for z in (before, after)]
    paper.draw(Path((corner, *legs), THIN, BLACK, closed=True, layer=BARS))


def link(p: complex, q: complex, *more: complex, label: str | None = None, weld: bool = False) -> bar:
    """Return a bar from pin ``p`` to pin ``q``.

    With more points, a plate (a tinted polygon) whose corners are the points; or, with
    ``weld``, one bent bar through them, its corners made rigid by a small gusset.
    """
    return bar((p, q, *more), label, weld)


class slot_link(Element):
    """Slotted guide from ``p`` to ``q``: a block slides between its two edges."""

    p: complex
    q: complex
    label: str | None = None

    def bars(self) -> Bars:
        return ((self.p, self.q),)

    def draw(self, paper: FigurePaper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        heading = math.degrees(cmath.phase(q - p))
        ends = ((q, heading - 90), (p, heading + 90))
        edge = tuple(z + SLOT * turn(start + 22.5 * k) for z, start in ends for k in range(9))
        paper.draw(Path(edge, EDGE, WHITE, closed=True, layer=GUIDES, solid=True))
        paper.draw(Path((p, q), THIN, dash=CHAIN, layer=GUIDES))
        paper.beside(self.label, p, q, SLOT + AWAY)


class slider(Element):
    """Block centred on ``p``, its length along ``direction`` (degrees). Its pin, if any, is a ``pin``."""

    p: complex
    direction: float = 0.0
    label: str | None = None

    def draw(self, paper: FigurePaper) -> None:
        p, direction = paper.at(self.p), turn(paper.degrees(self.direction))
        half = (BLOCK, BLOCK.conjugate(), -BLOCK, -BLOCK.conjugate())
        paper.draw(Path(tuple(p + direction * z for z in half), EDGE, TINT, closed=True, layer=BLOCKS))
        paper.around(self.label, p, BLOCK.imag + AWAY, (direction, -direction))


class rail(Element):
    """Fixed guide for a slider whose centre moves from ``p`` to ``q``.

    The guide touches the block on the right of p→q, below when p→q goes to the right, and
    is hatched on its far side.
    """

    p: complex
    q: complex

    def draw(self, paper: FigurePaper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        if p == q:
            return
        side = -1j * (q - p) / abs(q - p)
        shift = side * (BLOCK.imag + EDGE / 2)
        paper.draw(Path((p + shift, q + shift), EDGE))
        paper.hatch(p + shift, q + shift, side)


class section(Element):
    """Solid cut by the plane of the figure: a polygon with hatching.

    ``angle`` (degrees) tells neighbouring bodies apart: 45 for one, -45 for the other.
    """

    points: tuple[complex, ...]
    label: str | None = None
    angle: float = 45.0
    spacing: Positive = 2.0

    def draw(self, paper: FigurePaper) -> None:
        points = tuple(map(paper.at, self.points))
        from coursework.figures.text import read

        label = self.label or ""
        hole = _hole(points, read(label).box) if label else ()
        for a, b in _hatching((points, hole), turn(self.angle), self.spacing):
            paper.draw(Path((a, b), THIN, layer=FILLS))
        paper.draw(Path(points, EDGE, closed=True, layer=GUIDES, solid=True))
        if hole:
            paper.inside(label, added(hole) / 4, read(label).box[1])
        else:
            paper.beside(label, *max(_sides(points), key=lambda side: abs(side[1] - side[0])), AWAY)


def _sides(points: tuple[complex, ...]) -> Bars:
    return tuple(pairwise((*points, *points[:1])))


def _hole(points: tuple[complex, ...], box: tuple[float, float]) -> tuple[complex, ...]:
    """Return the corners of a gap in the hatching for a label, where the polygon is widest; nothing if it
    does not fit."""
    from coursework.figures.placing import distance, within

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
    middle = added(grid) / len(grid)
    best = max(fitting, key=lambda z: (rounded(room(z), 1), -rounded(abs(z - middle), 3)), default=None)
    return () if best is None else tuple(best + z for z in corners)


def _hatching(
    outlines: tuple[tuple[complex, ...], ...], direction: complex, spacing: float
) -> list[tuple[complex, complex]]:
    """Return the segments of parallel lines inside a polygon with holes (even-odd rule), in the lines' own
    axes."""
    sides = [
        (a * direction.conjugate(), b * direction.conjugate())
        for points in outlines
        for a, b in _sides(points)
    ]
    low, high = min(a.imag for a, _ in sides), max(a.imag for a, _ in sides)
    segments = []
    for k in range(math.ceil(low / spacing), math.floor(high / spacing) + 1):
        level = k * spacing + 1e-6  # a hair off the corners, which lie on tenths
        cuts = sorted(
            a.real + (b.real - a.real) * (level - a.imag) / (b.imag - a.imag)
            for a, b in sides
            if (a.imag > level) != (b.imag > level)
        )
        segments += [(complex(s, level) * direction, complex(e, level) * direction) for s, e in _by_two(cuts)]
    return segments


def _by_two(cuts: list[float]) -> list[tuple[float, float]]:
    """Return the cuts in pairs: where a line enters and where it leaves."""
    return list(zip(cuts[::2], cuts[1::2], strict=True))


class ball(Element):
    """Ball, or disc, in section: a tinted circle."""

    center: complex
    radius: Positive
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return circle_points(self.center, self.radius)

    def draw(self, paper: FigurePaper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        disc = Disc(center, radius, EDGE, TINT, layer=GUIDES)
        paper.draw(disc)
        paper.around(self.label, center, 0.9, area=disc.outline())


class wheel(Element):
    """Wheel or cam: a tinted disc beneath the bars, the supports and the pins."""

    center: complex
    radius: Positive
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return circle_points(self.center, self.radius)

    def draw(self, paper: FigurePaper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        disc = Disc(center, radius, EDGE, TINT, layer=FILLS)
        paper.draw(disc)
        paper.around(self.label, center, 0.9, area=disc.outline())


class profile(Element):
    """Body of any closed outline, such as a cam: tinted, beneath the bars, the supports and the pins."""

    points: tuple[complex, ...]
    label: str | None = None

    def draw(self, paper: FigurePaper) -> None:
        points = tuple(map(paper.at, self.points))
        paper.draw(Path(points, EDGE, TINT, closed=True, layer=FILLS))
        paper.around(self.label, added(points) / len(points), 0.9, area=(*points, points[0]))


class shape(Element):
    """Part of a drawn machine: an outline filled with a shade (see :data:`SHADES`), or an open line.

    Parts lie on one another in the order in which they are drawn, beneath bars, supports and pins.
    """

    points: tuple[complex, ...]
    shade: Shade = "light"
    closed: bool = True
    thin: bool = False

    def draw(self, paper: FigurePaper) -> None:
        points, width = tuple(map(paper.at, self.points)), THIN if self.thin else EDGE
        paper.draw(Path(points, width, SHADES[self.shade], closed=self.closed, layer=FILLS))


class disc(Element):
    """Round part of a drawn machine, filled with a shade."""

    center: complex
    radius: Positive
    shade: Shade = "light"
    thin: bool = False

    def reach(self) -> tuple[complex, ...]:
        return circle_points(self.center, self.radius)

    def draw(self, paper: FigurePaper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        paper.draw(Disc(center, radius, THIN if self.thin else EDGE, SHADES[self.shade], layer=FILLS))
