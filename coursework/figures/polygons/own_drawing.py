"""Drawing of a student over the right construction, from the student's own pole and scale, as SVG."""

from __future__ import annotations

from collections.abc import Mapping

from coursework.figures.ink import number
from coursework.figures.plot import RIGHT, WRONG, page, put
from coursework.figures.polygons.hand_drawn import JudgedDrawing, is_scale, judge_drawing
from coursework.figures.polygons.polygon import Polygon, Side
from coursework.figures.text import read

_MOST_MM = 150.0  #: width and height at most
_EDGE_MM = 8.0
_BENEATH = "#8a8f96"  #: colour of the right construction
_HEAD = 2.6  #: length of the head of an arrow, mm


def own_drawing(polygon: Polygon, points: Mapping[str, complex], scale: float | None) -> str:
    """Return the drawn vectors over the right ones; empty unless the pole and another point are drawn.

    Right vectors are drawn solid and green, wrong ones dashed and red, the right construction thin and grey.

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
    SVG of true size, smaller where that is wider than a page; an empty text for no drawing.
    """
    if polygon.pole not in points or len(points) < 2:
        return ""
    judged = judge_drawing(polygon, points, scale if scale and is_scale(polygon, scale) else None)
    pole, images = judged.points[polygon.pole], polygon.points
    right = {name: pole + (images[name] - images[polygon.pole]) / judged.scale for name in images}
    everything = [*right.values(), *judged.points.values()]
    low = complex(min(z.real for z in everything), min(z.imag for z in everything))
    high = complex(max(z.real for z in everything), max(z.imag for z in everything))
    shrink = min(1.0, _MOST_MM / max((high - low).real, (high - low).imag, 1.0))

    def at(z: complex) -> complex:
        return complex(_EDGE_MM + shrink * (z.real - low.real), _EDGE_MM + shrink * (high.imag - z.imag))

    body = [_arrow(at(right[s.start]), at(right[s.end]), _BENEATH, 0.25) for s in polygon.sides]
    for side in polygon.sides:
        if side.start in judged.points and side.end in judged.points:
            ends = at(judged.points[side.start]), at(judged.points[side.end])
            is_right = _is_right(side, judged)
            body.append(_arrow(*ends, RIGHT if is_right else WRONG, 0.6, "" if is_right else "2 1.2"))
    for name, z in judged.points.items():
        body.append(put(read(name), at(z) + complex(1.2, -1.2), "start"))
    size = shrink * (high - low)
    return page((size.real + 2 * _EDGE_MM, size.imag + 2 * _EDGE_MM), body)


def _is_right(side: Side, judged: JudgedDrawing) -> bool:
    """Return whether a drawn vector is right: a fault of an end is of one vector, or of all that end there."""
    faulty = [point for point in (side.start, side.end) if point in judged.faults]
    if side.is_result:
        return not faulty
    faults = [judged.faults[point] for point in faulty if side in judged.polygon.hangs.get(point, ())]
    return all(fault.side is not None and fault.side != side for fault in faults)


def _arrow(start: complex, end: complex, colour: str, width: float, dash: str = "") -> str:
    """Return an arrow; a point where it has no length."""
    if abs(end - start) < 0.05:
        return f'<circle cx="{number(start.real)}" cy="{number(start.imag)}" r="0.7" fill="{colour}"/>'
    back = -_HEAD * (end - start) / abs(end - start)
    corners = " ".join(
        f"{number(z.real)},{number(z.imag)}" for z in (end, end + back * (1 + 0.3j), end + back * (1 - 0.3j))
    )
    line = (
        f'<path d="M{number(start.real)} {number(start.imag)}L{number(end.real)} {number(end.imag)}" '
        f'fill="none" stroke="{colour}" stroke-width="{number(width)}" stroke-dasharray="{dash or "none"}"/>'
    )
    return f'{line}<polygon points="{corners}" fill="{colour}"/>'
