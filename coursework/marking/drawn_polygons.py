"""Judging of drawn polygons: points on paper, and the words for the faults of a drawing."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from coursework.figures.polygons.hand_drawn import (
    HUNG,
    DrawingFault,
    JudgedDrawing,
    ancestors,
    is_scale,
    judge_drawing,
)
from coursework.figures.polygons.polygon import Polygon
from coursework.quantities.error_kinds import PENALTIES
from coursework.solution import Judged

Answers: TypeAlias = Mapping[str, Any]  #: by part id, those that were read

_BOX_MM = (130.0, 80.0)  #: in which the reference drawing fits


_LEAST_SIDE_MM = 6.0  #: of a vector whose mistakes are distinguished: a point is right within a millimetre
_NOTHING_MM = 1e-9 * max(_BOX_MM)  #: what rounding leaves of a coordinate that is zero


def to_paper(image: Any, scale: Any) -> np.ndarray:
    """Return an image point as coordinates on paper, mm from the pole, shape (..., 2)."""
    return _coordinates(np.asarray(image / scale, dtype=complex))


def _coordinates(on_paper: np.ndarray) -> np.ndarray:
    """Of complex points on paper, along a last axis."""
    coordinates = np.stack([on_paper.real, on_paper.imag], axis=-1)
    return np.where(abs(coordinates) < _NOTHING_MM, 0.0, coordinates)


def if_long(start: Any, end: Any, wrong: Any) -> np.ndarray:
    """Return the wrong place of a vector's end on paper, NaN where the vector is so short that nobody tells
    how it is wrong."""
    length = np.linalg.norm(np.asarray(end) - start, axis=-1, keepdims=True)
    return np.where(length >= _LEAST_SIDE_MM, wrong, np.nan)


def scale_for(*images: Any) -> Any:
    """Return the least of 1, 2 and 5 times a power of ten at which the pole and these images fit the box."""
    places = np.stack(np.broadcast_arrays(0j, *images))
    least = np.maximum(np.ptp(places.real, axis=0) / _BOX_MM[0], np.ptp(places.imag, axis=0) / _BOX_MM[1])
    decade = 10.0 ** np.ceil(np.log10(least))
    return decade * np.select([5 * least <= decade, 2 * least <= decade], [0.2, 0.5], 1.0)


_MOST = 0.1  #: of a value, by which it may be off where it does not come from a drawing
_WIDEST_MM = 2000.0  #: of a polygon on paper: at a scale that makes it wider nobody draws


class Read(NamedTuple):
    """A value that is read off a drawing: of which vector, and how it follows from it."""

    start: str
    end: str
    value: Callable[[complex], float]  #: function of the vector, in the polygon's unit
    gain: float  #: what a unit of its length is worth
    #: By mistake: the ends of the vector that is taken instead, and its gain.
    wrong: Mapping[str, tuple[str, str, float]] = MappingProxyType({})
    sense: str = "value_sense"  #: the mistake of its sign


class DrawingParts(NamedTuple):
    """Quantities that a drawing is asked for, each by part id."""

    scale: str
    points: Mapping[str, str]  #: to the image points, the pole among them
    lengths: Mapping[str, tuple[str, str]]  #: to the ends of the segment
    reads: Mapping[str, Read]  #: to what is read off
    sides: Mapping[tuple[str, str], str]  #: by ends, what a vector is called in the names of mistakes
    hung: frozenset[str] = frozenset()  #: names of mistakes that tell on what a vector hangs


def verdicts(answers: Answers, polygon: Polygon, requested: DrawingParts) -> dict[str, Judged]:
    """Return a :class:`Judged` for each answer that can be judged."""
    judgements = _verdicts(answers, polygon, requested)
    ends = {**requested.lengths, **{part: (read.start, read.end) for part, read in requested.reads.items()}}
    drawn_ones = {requested.points[i] for i in requested.points if i in answers}
    points = [i for i, point in requested.points.items() if point != polygon.pole]
    undrawn = [i for i, of in ends.items() if not drawn_ones.issuperset(of)]
    return read_off(judgements, points, (requested.scale, *ends), undrawn)


def read_off(
    judgements: Mapping[str, Judged],
    points: Sequence[str],
    read: Collection[str],
    undrawn: Collection[str] = (),
) -> dict[str, Judged]:
    """Return the verdicts, with little for what is ``read`` off a drawing that does not stand.

    A drawing stands where half of its ``points`` at least, the pole aside, are right. What is ``undrawn`` is
    read off nothing, whatever stands.
    """
    is_drawn = 2 * sum(judgements[i].share == 1.0 for i in points if i in judgements) >= len(points)
    nothing = undrawn if is_drawn else read
    return {
        i: Judged(PENALTIES["not_drawn"], slip="not_drawn", follows=verdict.follows)
        if verdict.share == 1.0 and i in nothing
        else verdict
        for i, verdict in judgements.items()
    }


def _verdicts(answers: Answers, polygon: Polygon, requested: DrawingParts) -> dict[str, Judged]:
    scale = _stated(answers, polygon, requested)
    readings = drawn(answers, polygon, requested)
    if readings is None:
        if scale is None:
            return _right_reads(answers, polygon, requested)
        # Lengths alone: nothing is drawn, and they are what they should be or not.
        bare = judge_drawing(polygon, {polygon.pole: 0j}, scale)
        judgements = (
            {requested.scale: Judged()} if bare.is_legible else {requested.scale: Judged(0.0, "too_small")}
        )
        return judgements | _lengths(answers, bare, requested) | _reads(answers, bare, requested)
    drawing, upside_down = readings
    if not drawing.is_legible:
        of_it = (*requested.points, *requested.lengths, requested.scale)
        return {i: Judged(0.0, "too_small") for i in of_it if i in answers} | _reads(
            answers, drawing, requested
        )
    judgements = (
        {requested.scale: _of_scale(scale, upside_down, drawing)} if requested.scale in answers else {}
    )
    for part, point in requested.points.items():
        if part in answers:
            judgements[part] = _of_point(point, drawing, requested)
    return judgements | _lengths(answers, drawing, requested) | _reads(answers, drawing, requested)


def drawn(answers: Answers, polygon: Polygon, requested: DrawingParts) -> tuple[JudgedDrawing, bool] | None:
    """Return the judged drawing of these answers, and whether its scale is stated upside down; None unless
    the pole and another point are drawn."""
    points = {requested.points[i]: complex(*answers[i]) for i in requested.points if i in answers}
    if polygon.pole not in points or len(points) < 2:
        return None
    scale = _stated(answers, polygon, requested)
    drawing = judge_drawing(polygon, points, scale)
    if scale is not None and is_scale(polygon, 1 / scale):
        other = judge_drawing(polygon, points, 1 / scale)
        if _fits(other) and not _fits(drawing):
            return other, True
    return drawing, False


def _stated(answers: Answers, polygon: Polygon, requested: DrawingParts) -> float | None:
    """Return the scale that the answers state, if it is one."""
    scale = float(answers[requested.scale]) if requested.scale in answers else None
    return scale if scale is not None and is_scale(polygon, scale) else None


def _fits(drawing: JudgedDrawing) -> bool:
    """Return whether the drawing has the stated scale, and the first vector from the pole is right at that
    scale."""
    return drawing.fits_stated_scale and drawing.is_right(next(iter(drawing.polygon.hangs)))


def _of_scale(scale: float | None, upside_down: bool, drawing: JudgedDrawing) -> Judged:
    if scale is None:
        return Judged(0.0)
    if upside_down:
        return Judged(0.0, "scale_upside_down")
    if drawing.polygon.size > _WIDEST_MM * scale:
        return Judged(0.0)
    return Judged() if drawing.fits_stated_scale else Judged(0.0, "scale_not_drawn")


def _of_point(point: str, drawing: JudgedDrawing, requested: DrawingParts) -> Judged:
    if point == drawing.polygon.pole:
        # Any pole is right from which something was drawn; what is wrong about that is another point's.
        others = [q for q in drawing.points if q != point]
        return (
            Judged()
            if any(_is_drawn_from(point, q, drawing) for q in others)
            else _of_fault(others[0], drawing, requested)
        )
    if drawing.is_right(point):
        return Judged(follows=drawing.follows(point))
    return _of_fault(point, drawing, requested)


#: Factor between the length of a vector and that of the right one, which was drawn all the same.
_ATTEMPT = 3.0


def _is_drawn_from(pole: str, point: str, drawing: JudgedDrawing) -> bool:
    """Return whether a point is right, or at least about as far from the pole as it should be."""
    images = drawing.polygon.points
    length = abs(drawing.points[point] - drawing.points[pole]) * drawing.scale
    right = abs(images[point] - images[pole])
    return drawing.is_right(point) or right / _ATTEMPT <= length <= _ATTEMPT * right


def _of_fault(point: str, drawing: JudgedDrawing, requested: DrawingParts) -> Judged:
    fault = drawing.faults[point]
    names = [_named(point, f, requested) for f in fault.explanations]
    printed = [name for name in names if name]
    return Judged(0.0, printed[0], also=tuple(printed[1:]))


def _named(point: str, fault: DrawingFault, requested: DrawingParts) -> str:
    """Return the mistake that a fault is; none where a vector hangs on a point of which no mistake tells."""
    parts = {image: i for i, image in requested.points.items()}
    if fault.side is None:
        return f"{parts[point]}_{fault.kind}"
    side = requested.sides[fault.side.start, fault.side.end]
    if fault.kind != HUNG:
        return f"{side}_{fault.kind}"
    name = f"{side}_on_{parts[fault.on]}"
    return name if name in requested.hung else ""


def _lengths(answers: Answers, drawing: JudgedDrawing, requested: DrawingParts) -> dict[str, Judged]:
    judgements: dict[str, Judged] = {}
    for part, (start, end) in requested.lengths.items():
        if part not in answers:
            continue
        length = float(answers[part])
        fault = drawing.length_fault(start, end, length)
        if fault == "length":
            others = [ends for other, ends in requested.lengths.items() if other != part]
            exchanged = any(not drawing.length_fault(*ends, length) for ends in others)
            judgements[part] = Judged(0.0, "lengths_exchanged" if exchanged else "")
        else:
            judgements[part] = Judged(follows=fault == "own")
    return judgements


def _reads(answers: Answers, drawing: JudgedDrawing, requested: DrawingParts) -> dict[str, Judged]:
    """Right to the millimetres that the drawing may be off, a tenth at most; or as read off the student's own
    drawing, or from the student's own length."""
    judgements = {}
    for part, read in requested.reads.items():
        if part in answers:
            judgements[part] = _of_value(float(answers[part]), read, drawing, answers, requested)
    return judgements


def _right_reads(answers: Answers, polygon: Polygon, requested: DrawingParts) -> dict[str, Judged]:
    """Without scale and drawing, the values that are right all the same; nothing can be said of the
    others."""
    usual = float(scale_for(*(np.asarray(image, dtype=complex) for image in polygon.points.values())))
    judgements = _reads(answers, judge_drawing(polygon, {polygon.pole: 0j}, usual), requested)
    return {part: verdict for part, verdict in judgements.items() if verdict.share == 1.0}


def _of_value(
    number: float, read: Read, drawing: JudgedDrawing, answers: Answers, requested: DrawingParts
) -> Judged:
    ends, scale, images = (read.start, read.end), drawing.scale, drawing.polygon.points
    right = read.value(images[read.end] - images[read.start])
    millimetre = scale * read.gain
    if abs(number - right) <= min(2 * drawing.tolerance * millimetre, _MOST * abs(right)):
        return Judged()
    alternatives = []
    if drawing.is_legible and all(q in drawing.points for q in ends):
        alternatives.append(read.value((drawing.points[read.end] - drawing.points[read.start]) * scale))
    sense = np.sign(alternatives[0] if alternatives else right)
    alternatives += [
        sense * float(answers[i]) * millimetre
        for i, segment in requested.lengths.items()
        if segment == ends and i in answers and drawing.is_legible
    ]
    if any(
        abs(number - value) <= drawing.tolerance * millimetre + 0.01 * abs(value) for value in alternatives
    ):
        at_fault = {*ends, *ancestors(drawing.polygon, read.end)} & drawing.faults.keys()
        wrong_length = any(
            segment == ends and i in answers and drawing.length_fault(*ends, float(answers[i]))
            for i, segment in requested.lengths.items()
        )
        return Judged(follows=bool(at_fault) or wrong_length)
    names = list(_wrong_ways(number, read, [right, *alternatives], drawing))
    first = names[0] if names else ""
    return Judged(0.0, first, also=tuple(names[1:]))


def _wrong_ways(number: float, read: Read, values: Sequence[float], drawing: JudgedDrawing) -> Iterator[str]:
    """Yield the mistakes that explain a value, from the right drawing or the student's own."""
    near = 2 * drawing.tolerance * drawing.scale * read.gain
    if any(abs(number + value) <= min(near, _MOST * abs(value)) for value in values):
        yield read.sense
    if any(abs(number * drawing.scale - value) <= min(near, _MOST * abs(value)) for value in values):
        yield "scale_forgotten"
    for name, (start, end, gain) in read.wrong.items():
        images = drawing.polygon.points
        lengths = [abs(images[end] - images[start])]
        if start in drawing.points and end in drawing.points:
            lengths.append(abs(drawing.points[end] - drawing.points[start]) * drawing.scale)
        off = 2 * drawing.tolerance * drawing.scale * gain
        if any(abs(abs(number) - n * gain) <= min(off, _MOST * n * gain) for n in lengths):
            yield name


def turned(p: np.ndarray, a: np.ndarray, degrees: Any) -> np.ndarray:
    """Return a point turned about another, coordinates on paper."""
    turn = np.exp(1j * np.radians(degrees))
    vector = (a[..., 0] - p[..., 0] + 1j * (a[..., 1] - p[..., 1])) * turn
    return p + np.stack([vector.real, vector.imag], axis=-1)


def met(through: np.ndarray, along: Any, other: np.ndarray, other_along: Any) -> np.ndarray:
    """Return the intersection of two lines on paper; directions are complex numbers."""
    z, w = (q[..., 0] + 1j * q[..., 1] for q in (through, other))
    slope = (np.conj(along) * other_along).imag
    return _coordinates(z + along * (np.conj(w - z) * other_along).imag / slope)


def off_both(b: np.ndarray, lines: Sequence[Any], end: np.ndarray) -> np.ndarray:
    """Return a point off both the lines that cross at b by as much, nearly half as far as b is from
    ``end``."""
    first, second = (line / abs(line) for line in lines)
    between = np.where(abs(first + second) < abs(first - second), first + second, first - second)
    step = 0.4 * np.hypot(*np.moveaxis(b - end, -1, 0)) * between / abs(between)
    return b + np.stack([step.real, step.imag], axis=-1)
