r"""Marking of vector polygons drawn by a student: the wrong vectors, and the kind of each error.

A drawing comes as points in millimetres on paper, x to the right, y up, from any origin; the pole may stand
anywhere, and the scale may be any. Directions are absolute: a sheet that is turned is another drawing.

What is judged is the construction, as somebody would with ruler and set-square: each vector by what must hold
of it **from the student's own points**. A known vector has its length, its direction and its sense, and hangs
on its point; one in proportion to another is judged by the student's own; a line of known direction passes
through its point; a point found by two lines lies on both. So an error costs the vector that it is made on,
and nothing of what is drawn rightly from there. A point in its true place is right, too, whatever the points
before it are.

Each point may be off by ``tolerance`` mm, so a vector by twice that at its end, and a line by twice that
across. A direction is thus right to :math:`\arcsin(2\,\mathrm{tolerance} / \mathrm{length})`: 1.1 degrees for
100 mm, 6 for 20 mm, and anything for a vector of 2 mm, whose direction no ruler shows.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from coursework.errors import WrongValue, unknown
from coursework.figures.polygons.polygon import Polygon, Side
from coursework.messages import Message

TOLERANCE_MM = 1.0  #: by which each drawn point may be off
LEAST_MM = 20.0  #: of the longest vector, for tolerances of a millimetre; below, directions tell nothing
MOST_MM = 1e9  #: from any pole; no paper is so wide, and what is drawn farther off is as wrong as there

_SAME_SCALE = 0.05  #: by which two scales may differ and be one, drawn inexactly

LENGTH, DIRECTION, SENSE, VECTOR, HUNG, MISSING = KINDS = (
    "length",
    "direction",
    "sense",
    "vector",
    "hung",
    "missing",
)


@dataclass(frozen=True)
class DrawingFault:
    """Error of a drawn point.

    ``length``, ``direction``, ``sense``: of the vector that should end there; ``vector``: nothing of it is
    right; ``hung``: it is right, but starts from another point; ``missing``: the point is not drawn. A point
    found by two lines has a wrong ``direction`` when it is off one of them, a wrong ``sense`` when a vector
    is laid off backwards along its line, and ``vector`` when it is on neither.
    """

    kind: str
    side: Side | None = None  #: the vector at fault; None where the point is missing, or off both its lines
    on: str = ""  #: of ``hung``: the point on which the vector hangs instead
    plainer: DrawingFault | None = None  #: what else explains the point, and says less of it

    @property
    def explanations(self) -> Iterator[DrawingFault]:
        """Yield the fault, then less specific ones that explain the point as well."""
        fault: DrawingFault | None = self
        while fault:
            yield fault
            fault = fault.plainer

    def __str__(self) -> str:
        text = f" on {self.on}" if self.on else ""
        return f"{self.side}: {self.kind}{text}" if self.side else self.kind


@dataclass(frozen=True)
class JudgedDrawing:
    """Judged drawing."""

    polygon: Polygon
    points: Mapping[str, complex]  #: those drawn, mm on paper
    scale: float  #: mm/s or mm/s^2 for a mm, at which it is judged
    faults: Mapping[str, DrawingFault]  #: by point, of those that are wrong or missing
    is_legible: bool  #: large enough to tell directions
    fits_stated_scale: bool  #: False where it is consistent at another scale than the stated one
    tolerance: float = TOLERANCE_MM
    #: Each point from those before it, mm on paper.
    ideal: Mapping[str, complex] = field(default_factory=dict)

    def is_right(self, point: str) -> bool:
        """Return whether the point is drawn and its vectors are right.

        Parameters
        ----------
        point
            Name of an image point.

        Returns
        -------
        True for a point that is drawn rightly, and for one that the polygon does not have.
        """
        return point not in self.faults

    def follows(self, point: str) -> bool:
        """Return whether the point is right only relative to an earlier point that is wrong.

        Parameters
        ----------
        point
            Name of an image point.

        Returns
        -------
        True or False.
        """
        if not any(q in self.faults for q in ancestors(self.polygon, point)) or not self.is_right(point):
            return False
        return not _is_in_place(point, self.points, self.polygon, self.scale, 2 * self.tolerance)

    def length_fault(self, start: str, end: str, measured: float) -> str:
        """Return the fault of a length measured on paper.

        Where both points are drawn, a length is measured between them, to the tolerance; otherwise it is the
        right length at the scale, to twice that.

        Parameters
        ----------
        start, end
            Names of the image points between which it is measured.
        measured
            The length, mm on paper.

        Returns
        -------
        ``""`` for none; ``own``: it is the length in the student's drawing, which is wrong there; ``length``:
        it is neither.
        """
        right = abs(self.polygon.points[end] - self.polygon.points[start]) / self.scale
        if abs(measured - right) <= 2 * self.tolerance:
            return ""
        if start in self.points and end in self.points:
            there = {start, end, *ancestors(self.polygon, start), *ancestors(self.polygon, end)}
            if abs(measured - abs(self.points[end] - self.points[start])) <= self.tolerance:
                return "own" if there & self.faults.keys() else ""
        return "length"


def is_scale(polygon: Polygon, scale: float) -> bool:
    """Return whether the polygon can be drawn at a scale: a positive one at which it fits on paper.

    Parameters
    ----------
    polygon
        The right one.
    scale
        mm/s or mm/s^2 for a mm on paper.

    Returns
    -------
    True or False.
    """
    return 0 < scale < float("inf") and polygon.size <= MOST_MM * scale


def on_paper(x: float, y: float) -> complex:
    """Return a drawn point or arrow, clipped to the largest paper, so that it can be computed with.

    Parameters
    ----------
    x, y
        Coordinates or components, mm on paper.

    Returns
    -------
    A complex number, mm, each part at most :data:`MOST_MM` from 0.
    """
    return complex(*(max(-MOST_MM, min(MOST_MM, float(c))) for c in (x, y)))


def judge_drawing(
    polygon: Polygon,
    points: Mapping[str, complex],
    scale: float | None = None,
    tolerance: float = TOLERANCE_MM,
) -> JudgedDrawing:
    """Judge drawn points against the polygon that they should form.

    Parameters
    ----------
    polygon
        The right one.
    points
        By the polygon's names, mm on paper; the pole is among them, others may be missing.
    scale
        mm/s or mm/s^2 for a mm, as the student states it. Unless stated, and where most of what is drawn
        agrees on another, it is the one at which most of the known vectors are right.
    tolerance
        mm by which each point may be off.

    Returns
    -------
    The judged drawing, with the scale that it was judged at and the fault of each wrong or missing point.

    Raises
    ------
    WrongValue
        The pole is missing, a coordinate is not finite, or the scale is none: see :func:`is_scale`.
    UnknownName
        A point that the polygon does not have.
    """
    for name, z in points.items():
        if name not in polygon.points:
            raise unknown("point", name, polygon.points, Message("the polygon"))
        if not cmath.isfinite(z):
            raise WrongValue("point {name} of a drawing is {z}, not finite", name=name, z=z)
    if polygon.pole not in points:
        raise WrongValue(
            "a drawing is judged from its pole {pole}, which is not among its points", pole=polygon.pole
        )
    if scale is not None and not is_scale(polygon, scale):
        raise WrongValue(
            "a scale of a drawing is positive, and so large that it fits on paper; found {scale}", scale=scale
        )
    points = {name: on_paper(z.real, z.imag) for name, z in points.items()}
    width = 2 * tolerance
    used, fits = _scale(polygon, points, scale, width)
    faults: dict[str, DrawingFault] = {}
    ideal = {polygon.pole: points[polygon.pole]}
    for point, sides in polygon.hangs.items():
        # The points before it, as drawn; one that is missing stands where it follows from those before it.
        here = {q: points.get(q, z) for q, z in ideal.items()}
        if len(sides) == 1:
            ideal[point], fault = _known_vector(point, sides[0], here, points, polygon, used, width)
        else:
            on_drawn = not any(_anchor(side, point) in faults for side in sides) and _is_spread(
                here, points, width
            )
            ideal[point], fault = _crossing(point, sides, here, points, polygon, used, width, on_drawn)
        if fault and not _is_in_place(point, points, polygon, used, width):
            faults[point] = fault
    legible = polygon.size / used >= LEAST_MM * tolerance
    return JudgedDrawing(polygon, points, used, faults, legible, fits, tolerance, ideal)


def _is_in_place(
    point: str, drawn: Mapping[str, complex], polygon: Polygon, scale: float, width: float
) -> bool:
    """Return whether a point is drawn where it belongs from the student's pole."""
    right = drawn[polygon.pole] + (polygon.points[point] - polygon.points[polygon.pole]) / scale
    return point in drawn and abs(drawn[point] - right) <= width


def vector_fault(drawn: complex, right: complex, width: float) -> str:
    """Return the fault of one vector.

    Parameters
    ----------
    drawn, right
        Vector as drawn and as it should be, complex, mm on paper.
    width
        mm by which its end may be off.

    Returns
    -------
    ``""`` for none, or a kind of :class:`DrawingFault`: ``length``, ``direction``, ``sense`` or ``vector``.
    """
    size, length = abs(drawn), abs(right)
    if abs(drawn - right) <= width:
        return ""
    if length <= width or size <= width:
        return LENGTH
    if abs(drawn + right) <= width:
        return SENSE
    along, across = _split(drawn, right / length)
    # A vector drawn too long is off its line in proportion.
    if abs(across) <= width * max(1.0, size / length):
        return LENGTH if along > 0 else SENSE
    return DIRECTION if abs(size - length) <= width else VECTOR


def ancestors(polygon: Polygon, point: str) -> frozenset[str]:
    """Return the points, except the pole, from which a point is constructed.

    Parameters
    ----------
    polygon
        The right one.
    point
        Name of an image point.

    Returns
    -------
    Names of the points, in no order; none for the pole.
    """
    results: set[str] = set()
    waiting = [point]
    while waiting:
        here = waiting.pop()
        for side in polygon.hangs.get(here, ()):
            for before in (_anchor(side, here), *(side.image or ())):
                if before != polygon.pole and before not in results:
                    results.add(before)
                    waiting.append(before)
    return frozenset(results)


def _anchor(side: Side, point: str) -> str:
    return side.start if side.end == point else side.end


def _split(vector: complex, along: complex) -> tuple[float, float]:
    """Return the components of a vector along a unit vector, and 90 degrees ahead."""
    turned = vector * along.conjugate()
    return turned.real, turned.imag


def _known_vector(
    point: str,
    side: Side,
    here: Mapping[str, complex],
    drawn: Mapping[str, complex],
    polygon: Polygon,
    scale: float,
    width: float,
) -> tuple[complex, DrawingFault | None]:
    """Return the end of a vector of known length, laid off from the student's point, and the fault of the one
    drawn."""
    anchor = _anchor(side, point)
    right, direction = side.value / scale, 1 if side.end == point else -1
    ratio = polygon.ratio(side)
    vector = (
        right if ratio is None or side.image is None else ratio * (here[side.image[1]] - here[side.image[0]])
    )
    if abs(vector) <= width < abs(right):  # nothing is in proportion to what is not drawn
        vector = right
    right, ideal = direction * right, here[anchor] + direction * vector
    if point not in drawn:
        return ideal, DrawingFault(MISSING)
    kind = vector_fault(drawn[point] - here[anchor], direction * vector, width)
    if not kind or abs(drawn[point] - here[anchor] - right) <= width:
        return ideal, None
    for other in here:
        if other != anchor and abs(drawn[point] - here[other] - right) <= width:
            return ideal, DrawingFault(HUNG, side, other, DrawingFault(kind, side))
    return ideal, DrawingFault(kind, side)


def _crossing(
    point: str,
    sides: tuple[Side, ...],
    here: Mapping[str, complex],
    drawn: Mapping[str, complex],
    polygon: Polygon,
    scale: float,
    width: float,
    on_drawn: bool,
) -> tuple[complex, DrawingFault | None]:
    """Return the intersection of two lines through the student's points, and the fault of the point drawn.

    ``on_drawn``: both lines start from points that are right, in a drawing of some size.
    """
    anchors = tuple(_anchor(side, point) for side in sides)
    ideal = _meeting(sides, [here[a] for a in anchors])
    if ideal is None:  # as one line: where it should be, from the first
        ideal = here[anchors[0]] + (polygon.points[point] - polygon.points[anchors[0]]) / scale
    if point not in drawn:
        return ideal, DrawingFault(MISSING)
    there = drawn[point]
    good = [_off(side, there, here[a]) <= width for side, a in zip(sides, anchors, strict=True)]
    if all(good):
        # Lines that are drawn from one point meet there, whatever their directions; from two, where they say.
        is_constructed = (
            abs(here[anchors[0]] - here[anchors[1]]) > width / 2 and abs(there - ideal) <= width / 2
        )
        collapsed = not (on_drawn or is_constructed) and all(
            abs(there - here[a]) <= width < abs(s.value) / scale for s, a in zip(sides, anchors, strict=True)
        )
        return ideal, DrawingFault(VECTOR) if collapsed else None
    others = [[q for q in here if q != a] for a in anchors]
    elsewhere = [_through(side, there, some, here, width) for side, some in zip(sides, others, strict=True)]
    if not any(good):
        if all(elsewhere) and elsewhere[0] != elsewhere[1]:
            return ideal, DrawingFault(HUNG, sides[0], elsewhere[0], DrawingFault(VECTOR))
        return ideal, DrawingFault(VECTOR)
    bad = good.index(False)
    right_one, anchor = sides[1 - bad], here[anchors[1 - bad]]
    fault = DrawingFault(DIRECTION, sides[bad])
    # Through the other line's own point both lines would meet there, and nothing would be drawn.
    if elsewhere[bad] and elsewhere[bad] != anchors[1 - bad]:
        fault = DrawingFault(HUNG, sides[bad], elsewhere[bad], fault)
    if abs(there - (2 * anchor - ideal)) <= 2 * width:
        fault = DrawingFault(SENSE, right_one, plainer=fault)
    return ideal, fault


def _is_spread(here: Mapping[str, complex], drawn: Mapping[str, complex], width: float) -> bool:
    """Return whether the points drawn so far do not all coincide."""
    first, *others = (drawn[q] for q in here if q in drawn)
    return any(abs(z - first) > 2 * width for z in others)


def _off(side: Side, there: complex, through: complex) -> float:
    """Return the distance of a point from a side's line through another."""
    return abs(_split(there - through, side.along)[1])


def _through(side: Side, there: complex, names: list[str], here: Mapping[str, complex], width: float) -> str:
    """Return the name of the point through which a side's line passes near a drawn point; empty for none."""
    nearest = min(names, key=lambda q: _off(side, there, here[q]), default="")
    return nearest if nearest and _off(side, there, here[nearest]) <= width else ""


def _meeting(sides: tuple[Side, ...], through: list[complex]) -> complex | None:
    """Return the intersection of two lines; None for nearly parallel lines."""
    u, v = sides[0].along, sides[1].along
    slope = (u.conjugate() * v).imag
    if abs(slope) < 1e-6:
        return None
    return through[0] + u * ((through[1] - through[0]).conjugate() * v).imag / slope


# ------------------------------------------------------------------------------ scale


def _scale(
    polygon: Polygon, points: Mapping[str, complex], stated: float | None, width: float
) -> tuple[float, bool]:
    """Return the scale to judge at, and whether it is the stated one.

    Each known vector is right for a range of scales. The stated scale is taken unless no vector is right at
    it and several are right at another; without a stated one, the scale at which most vectors are right.
    """
    ranges = list(_ranges(polygon, points, width))
    best, count = _most_covered(ranges)
    if stated is not None:
        # A short one fits many scales.
        telling = [(low, high) for low, high in ranges if high < 2 * low] or ranges
        agrees = any(0 < low <= 1 / stated <= high for low, high in telling)
        is_other = count > 1 and abs(best * stated - 1) > _SAME_SCALE
        return (1 / best, False) if is_other and not agrees else (stated, True)
    if count:
        return 1 / best, True
    return _by_length(polygon, points), True


def _ranges(polygon: Polygon, points: Mapping[str, complex], width: float) -> Iterator[tuple[float, float]]:
    """Yield for each known vector that is drawn the range, in mm of paper for a unit, in which it is
    right."""
    for side in polygon.sides:
        if not (side.is_known and side.start in points and side.end in points and side.value):
            continue
        drawn, size = points[side.end] - points[side.start], abs(side.value)
        along, across = _split(drawn, side.value / size)
        if abs(across) > width:
            continue
        half = (width**2 - across**2) ** 0.5
        if along + half > 0:
            yield max(along - half, 0.0) / size, (along + half) / size


def _most_covered(ranges: list[tuple[float, float]]) -> tuple[float, int]:
    """Return the middle of the interval that most ranges have in common, and their number; of several, the
    first.

    A vector as short as the tolerance is right down to no length at all: it bounds a scale, and tells none.
    """
    best, count = 0.0, 0
    for low, _ in ranges:
        if not low:
            continue
        here = [(a, b) for a, b in ranges if a <= low <= b]
        if len(here) > count:
            best, count = (max(a for a, _ in here) + min(b for _, b in here)) / 2, len(here)
    return best, count


def _by_length(polygon: Polygon, points: Mapping[str, complex]) -> float:
    """Return the scale at which the first known vector has its length, in any direction."""
    for side in polygon.sides:
        if side.is_known and side.value and side.start in points and side.end in points:
            length = abs(points[side.end] - points[side.start])
            if length > 0:
                return abs(side.value) / length
    return max(polygon.size, 1.0)
