"""Annotations of a mechanism: axes, angles, dimensions, vectors, notes, traces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coursework.figures.base import AWAY, Element, Positive, arc_points, circle_points
from coursework.figures.ink import (
    BAR,
    CHAIN,
    DASHED,
    DOTTED,
    EDGE,
    HEAD,
    MARKS,
    SIDES,
    THIN,
    Arc,
    Disc,
    Path,
    turn,
)

if TYPE_CHECKING:
    from coursework.figures.paper import FigurePaper


class note(Element):
    """Words or a symbol centred on a point if there is room, else near it; nothing is drawn at the point."""

    p: complex
    label: str | None

    def draw(self, paper: FigurePaper) -> None:
        from coursework.figures.text import read

        text = read(self.label) if self.label else None
        if text is not None:
            # A negative start lets the first candidate sit on the point itself.
            paper.toward(self.label, paper.at(self.p), 1j, -text.box[1] / 2, SIDES)


class line(Element):
    """Plain line."""

    p: complex
    q: complex
    dashed: bool = False
    thin: bool = True
    label: str | None = None

    def draw(self, paper: FigurePaper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        paper.draw(Path((p, q), THIN if self.thin else EDGE, dash=DASHED if self.dashed else ""))
        paper.beside(self.label, p, q, AWAY)


class centre_line(Element):
    """Axis of symmetry or of rotation, chain-dotted."""

    p: complex
    q: complex
    label: str | None = None

    def draw(self, paper: FigurePaper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        paper.draw(Path((p, q), THIN, dash=CHAIN))
        paper.toward(self.label, q, q - p, 0.6, SIDES)


class circle(Element):
    """Circle: the path of a pin, a construction, a gear's pitch circle."""

    center: complex
    radius: Positive
    dashed: bool = False
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return circle_points(self.center, self.radius)

    def draw(self, paper: FigurePaper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        paper.draw(Disc(center, radius, THIN, dash=DASHED if self.dashed else ""))
        paper.toward(self.label, center, turn(45), radius + 0.7, SIDES)


class arc(Element):
    """Arc, counter-clockwise when ``to_deg`` is the larger angle."""

    center: complex
    radius: Positive
    from_deg: float
    to_deg: float
    dashed: bool = False

    def reach(self) -> tuple[complex, ...]:
        return arc_points(self.center, self.radius, self.from_deg, self.to_deg)

    def draw(self, paper: FigurePaper) -> None:
        ends = paper.degrees(self.from_deg), paper.degrees(self.to_deg)
        radius = paper.length(self.radius)
        paper.draw(Arc(paper.at(self.center), radius, *ends, THIN, DASHED if self.dashed else ""))


class axes(Element):
    """Two arrows, along +x and +y."""

    origin: complex
    length: Positive
    labels: tuple[str, str] = ("x", "y")

    def reach(self) -> tuple[complex, ...]:
        return self.origin, self.origin + self.length, self.origin + 1j * self.length

    def draw(self, paper: FigurePaper) -> None:
        origin, length = paper.at(self.origin), paper.length(self.length)
        for direction, label in zip((1, 1j), self.labels, strict=True):
            paper.arrow(origin, origin + length * direction, THIN, HEAD * 0.8)
            paper.toward(
                label,
                origin + length * direction,
                direction * turn(-45 if direction == 1 else 45),
                0.6,
                SIDES,
            )


class rotation_arrow(Element):
    """Arc with an arrow head at ``to_deg``: a sense of rotation."""

    center: complex
    radius: Positive
    from_deg: float
    to_deg: float
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return arc_points(self.center, self.radius, self.from_deg, self.to_deg)

    def draw(self, paper: FigurePaper) -> None:
        center, radius = paper.at(self.center), paper.length(self.radius)
        start, end = paper.degrees(self.from_deg), paper.degrees(self.to_deg)
        paper.arc_arrow(center, radius, start, end, HEAD)
        paper.toward(self.label, center, turn((start + end) / 2), radius + AWAY)


class angle_mark(Element):
    """Angle: an arc from a thin reference line at ``from_deg`` to an arrow head at ``to_deg``.

    ``radius`` is in mechanism mm; by default the arc has 9 mm on paper,
    less when a bar that ends there is short.
    """

    center: complex
    from_deg: float
    to_deg: float
    label: str | None = None
    radius: Positive | None = None

    def reach(self) -> tuple[complex, ...]:
        return (self.center, *arc_points(self.center, self.radius or 0.0, self.from_deg, self.to_deg))

    def draw(self, paper: FigurePaper) -> None:
        center = paper.at(self.center)
        radius = paper.length(self.radius) if self.radius else min(9.0, max(4.0, 0.6 * paper.room(center)))
        start, end = paper.degrees(self.from_deg), paper.degrees(self.to_deg)
        paper.draw(Path((center, center + (radius + 3.0) * turn(start)), THIN))
        paper.arc_arrow(center, radius, start, end, 1.7)
        paper.toward(self.label, center, turn((start + end) / 2), radius + AWAY)


class dimension(Element):
    """Dimension line with two arrow heads and its extension lines.

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

    def draw(self, paper: FigurePaper) -> None:
        p, q = paper.at(self.p), paper.at(self.q)
        normal = self._normal(p, q)
        gap = paper.aside(p, q) if self.offset is None else round(self.offset * paper.scale, 1)
        direction = normal if gap >= 0 else -normal
        a, b = p + normal * gap, q + normal * gap
        for foot, end in ((p, a), (q, b)):
            if abs(gap) > 1.5:
                paper.draw(Path((foot + direction, end + direction), THIN))
        _measured(paper, a, b)
        paper.beside(self.label, a, b, 0.7, direction)


def _measured(paper: FigurePaper, a: complex, b: complex) -> None:
    """Draw a line with a head at each end; the heads point inwards from outside when there is no room
    between."""
    if a == b:
        return
    direction = (b - a) / abs(b - a)
    size = 1.9
    if abs(b - a) > 3 * size:
        paper.draw(Path((a + direction * size * 0.8, b - direction * size * 0.8), THIN, layer=MARKS))
        paper.head(a, -direction, size)
        paper.head(b, direction, size)
    else:
        paper.draw(Path((a, b), THIN, layer=MARKS))
        paper.arrow(a - direction * 2.2 * size, a, THIN, size)
        paper.arrow(b + direction * 2.2 * size, b, THIN, size)


class vector(Element):
    """Arrow from ``p`` to ``p + v``; the author scales a velocity or a force to mm of mechanism."""

    p: complex
    v: complex
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return self.p, self.p + self.v

    def draw(self, paper: FigurePaper) -> None:
        p, tip = paper.at(self.p), paper.at(self.p + self.v)
        paper.arrow(p, tip, 0.45, 2.8)
        paper.beside(self.label, p, tip, AWAY)


class scale_bar(Element):
    """Bar from ``p`` to the right with a tick at each end, labelled with the value of its length."""

    p: complex
    length: Positive
    label: str | None = None

    def reach(self) -> tuple[complex, ...]:
        return self.p, self.p + self.length

    def draw(self, paper: FigurePaper) -> None:
        p, q = paper.at(self.p), paper.at(self.p + self.length)
        paper.draw(Path((p, q), BAR), *(Path((z - 1j, z + 1j), EDGE) for z in (p, q)))
        paper.beside(self.label, p, q, AWAY, -1j)


class trace(Element):
    """Thin curve through points, such as the path of one; dotted by default."""

    points: tuple[complex, ...]
    dotted: bool = True

    def draw(self, paper: FigurePaper) -> None:
        paper.draw(Path(tuple(map(paper.at, self.points)), THIN, dash=DOTTED if self.dotted else ""))
