"""Drawing of a student over the right construction, at the student's own place and scale."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from coursework.figures.ink import number
from coursework.figures.plot import RIGHT, WRONG, page, put
from coursework.figures.polygons.hand_drawn import JudgedDrawing, is_scale, judge_drawing
from coursework.figures.polygons.polygon import Polygon, Side
from coursework.figures.text import read

_MOST_MM = 150.0  #: width and height at most
_EDGE_MM = 8.0
BENEATH = "#8a8f96"  #: colour of the right construction
_HEAD = 2.6  #: length of the head of an arrow, mm


@dataclass(frozen=True)
class DrawnStroke:
    """Vector or bar that a student drew, from its start to its end, mm on paper."""

    start: complex
    end: complex
    part: str = ""  #: whose mark tells whether it is right, where ``is_right`` does not
    is_right: bool = False


@dataclass(frozen=True)
class OwnDrawing:
    """Drawing of a student over the right construction: right strokes solid and green, wrong ones dashed and
    red, the right construction thin and grey.

    All is in mm on paper. ``right`` lists the right strokes by their ends, ``circles`` those of the
    construction by centre and radius, ``points`` the student's points by their names, LaTeX. Strokes are
    arrows unless ``bars``.
    """

    right: Sequence[tuple[complex, complex]]
    drawn: Sequence[DrawnStroke]
    points: Mapping[str, complex] = field(default_factory=dict)
    circles: Sequence[tuple[complex, float]] = ()
    bars: bool = False

    @cached_property
    def _corners(self) -> tuple[complex, complex]:
        ends = [z for pair in self.right for z in pair]
        ends += [z for stroke in self.drawn for z in (stroke.start, stroke.end)]
        ends += self.points.values()
        low = complex(min(z.real for z in ends), min(z.imag for z in ends))
        return low, complex(max(z.real for z in ends), max(z.imag for z in ends))

    @property
    def _shrink(self) -> float:
        size = self._corners[1] - self._corners[0]
        return min(1.0, _MOST_MM / max(size.real, size.imag, 1.0))

    @property
    def size_mm(self) -> tuple[float, float]:
        """Width and height: true, smaller where that is wider than a page."""
        size = self._shrink * (self._corners[1] - self._corners[0])
        return round(size.real + 2 * _EDGE_MM, 2), round(size.imag + 2 * _EDGE_MM, 2)

    def outlined_svg(self) -> str:
        """Return the drawing as SVG, its letters as outlines."""
        return page(self.size_mm, list(self._body()))

    bare_svg = outlined_svg

    def letters(self) -> tuple[()]:
        """Return the letters that a typesetter has to add: none."""
        return ()

    def _at(self, z: complex) -> complex:
        low, high = self._corners
        shift = z - complex(low.real, high.imag)
        return complex(_EDGE_MM + self._shrink * shift.real, _EDGE_MM - self._shrink * shift.imag)

    def _body(self) -> Iterator[str]:
        for centre, radius in self.circles:
            c = self._at(centre)
            yield (
                f'<circle cx="{number(c.real)}" cy="{number(c.imag)}" '
                f'r="{number(self._shrink * radius)}" fill="none" '
                f'stroke="{BENEATH}" stroke-width="0.18" stroke-dasharray="1 1"/>'
            )
        for start, end in self.right:
            yield self._stroke(start, end, BENEATH, 0.25)
        for one in self.drawn:
            colour, dash = (RIGHT, "none") if one.is_right else (WRONG, "2 1.2")
            yield self._stroke(one.start, one.end, colour, 0.6, dash)
        for name, z in self.points.items():
            yield put(read(name), self._at(z) + complex(1.2, -1.2), "start")

    def _stroke(self, start: complex, end: complex, colour: str, width: float, dash: str = "none") -> str:
        """Return an arrow, or a bar; a point where it has no length."""
        start, end = self._at(start), self._at(end)
        if abs(end - start) < 0.05:
            return f'<circle cx="{number(start.real)}" cy="{number(start.imag)}" r="0.7" fill="{colour}"/>'
        line = (
            f'<path d="M{number(start.real)} {number(start.imag)}L{number(end.real)} {number(end.imag)}" '
            f'fill="none" stroke="{colour}" stroke-width="{number(width)}" stroke-dasharray="{dash}"/>'
        )
        if self.bars:
            return line
        back = -_HEAD * (end - start) / abs(end - start)
        corners = (end, end + back * (1 + 0.3j), end + back * (1 - 0.3j))
        tip = " ".join(f"{number(z.real)},{number(z.imag)}" for z in corners)
        return f'{line}<polygon points="{tip}" fill="{colour}"/>'


def drawn_polygon(polygon: Polygon, points: Mapping[str, complex], scale: float | None) -> OwnDrawing | None:
    """Return the drawn vectors over the right ones.

    Parameters
    ----------
    polygon
        The right one.
    points
        Drawn points by the polygon's names, mm on paper.
    scale
        As the student states it, mm/s or mm/s^2 for a mm; None if it cannot be read.

    Returns
    -------
    The drawing; None unless the pole and another point are drawn.
    """
    if polygon.pole not in points or len(points) < 2:
        return None
    judged = judge_drawing(polygon, points, scale if scale and is_scale(polygon, scale) else None)
    pole, images = judged.points[polygon.pole], polygon.points
    right = {name: pole + (images[name] - images[polygon.pole]) / judged.scale for name in images}
    return OwnDrawing(
        [(right[side.start], right[side.end]) for side in polygon.sides],
        [
            DrawnStroke(judged.points[side.start], judged.points[side.end], "", _is_right(side, judged))
            for side in polygon.sides
            if side.start in judged.points and side.end in judged.points
        ],
        judged.points,
    )


def _is_right(side: Side, judged: JudgedDrawing) -> bool:
    """Return whether a drawn vector is right: a fault of an end is of one vector, or of all that end
    there."""
    faulty = [point for point in (side.start, side.end) if point in judged.faults]
    if side.is_result:
        return not faulty
    faults = [judged.faults[point] for point in faulty if side in judged.polygon.hangs.get(point, ())]
    return all(fault.side is not None and fault.side != side for fault in faults)
