"""Moving figure: the same elements at many instants, drawn to one scale in one frame.

Every drawn line is a track of its coordinates at every instant. Positions that hold for the whole cycle (a
guide, an axis, the hatched side of a pivot, the side of a link with its label) are decided once for all
instants, so that nothing jumps.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from itertools import pairwise

import numpy as np

from coursework.errors import WrongValue
from coursework.figures.base import Element
from coursework.figures.elements import rail
from coursework.figures.ink import (
    BLACK,
    FILLS,
    LINES,
    MARKS,
    NAMES,
    PINS,
    THIN,
    WHITE,
    Arc,
    Disc,
    Ink,
    Path,
    _paint,
    number,
    pair,
    turn,
)
from coursework.figures.marks import centre_line, dimension, line, rotation_arrow
from coursework.figures.paper import FigurePaper
from coursework.figures.placing import LabelRequest
from coursework.figures.riding import ride
from coursework.figures.text import read
from coursework.figures.writing import accents, as_outlines, baseline
from coursework.language.numbers import rounded

COLOURS = {"position": "#1b7a4b", "velocity": "#0a58a8", "acceleration": "#b3261e", "coriolis": "#7a2f9e"}
ARROW, TIP = 0.5, 2.6  #: width of a vector's shaft and length of its head, mm
_MARGIN = 1.5
_ROW = 6.0  #: height of a line of the legend, mm
_SYMBOLS = complex(26, 24)  #: paper that symbols and labels take round the mechanism, mm
_ARC_SIDES = 20
_STRAIGHT = 0.015  #: how far from its path a point is drawn at most, mm on paper
_RIM = 30  #: white round letters, hundredths of their size


@dataclass(frozen=True)
class MotionTrack:
    """Drawn line or mark over the instants.

    ``numbers`` has a row an instant, mm on paper, y down, from the top left corner: of a ``path`` the
    coordinates of its points in turn, of what is carried about (``mark``) those of its origin.
    """

    numbers: np.ndarray
    paint: str = ""
    closed: bool = False
    mark: str = ""  #: SVG of a thing that is carried about as it is
    layer: int = LINES
    effect: str = ""  #: what must be switched on for it to be seen
    point: str = ""  #: the point that it belongs to
    key: bool = False  #: a part of the legend
    is_label: bool = False

    @property
    def moves(self) -> bool:
        """True if two instants differ in print."""
        return bool(np.ptp(self.numbers, axis=0).max(initial=0.0) >= 0.005)

    def value(self, instant: int) -> str:
        """Return the attribute that changes at an instant: the data of a path, or a translation."""
        row = self.numbers[instant]
        if self.mark:
            return " ".join(map(number, row))
        points = (pair(complex(x, y)) for x, y in row.reshape(-1, 2))
        return "M" + "L".join(points) + ("Z" if self.closed else "")

    def svg(self, instant: int, more: str = "", inside: str = "") -> str:
        """Return the line or mark at an instant as SVG."""
        if self.mark:
            return f'<g transform="translate({self.value(instant)})"{more}>{self.mark}{inside}</g>'
        tail = f">{inside}</path>" if inside else "/>"
        return f'<path d="{self.value(instant)}"{self.paint}{more}{tail}'


@dataclass(frozen=True)
class Arrow:
    """Vector over the instants: ``v`` (complex, one an instant) at ``p``, mm of mechanism; NaN where there is
    none."""

    p: np.ndarray
    v: np.ndarray
    effect: str
    point: str


@dataclass(frozen=True)
class TracedPoint:
    """Point over the instants, and its ``path``, at as many places as it needs; ``closed`` if that returns to
    its start."""

    p: np.ndarray
    point: str
    closed: bool
    path: np.ndarray


@dataclass(frozen=True)
class LegendKey:
    """Line of the legend: an arrow of this many mm of mechanism, and its words."""

    effect: str
    length: float
    words: str


@dataclass(frozen=True)
class MovingDrawing:
    """Tracks in painting order, and the size of the paper in mm."""

    tracks: tuple[MotionTrack, ...]
    size: tuple[float, float]
    scale: float
    corner: complex = 0j  #: top left corner, mm on paper from the origin of the mechanism, y up

    def on_paper(self, p: complex | np.ndarray) -> np.ndarray:
        """Return points of the mechanism (mm, complex, shape ``(...)``) as x, y in the drawing, mm, y down:
        ``(..., 2)``."""
        off = np.asarray(p) * self.scale - self.corner
        return np.stack([off.real, -off.imag], axis=-1)


class _Stage(FigurePaper):
    """Paper for one instant, without rounding; the same marks are drawn whatever their size."""

    def __init__(
        self,
        scale: float,
        bars: Iterable[tuple[complex, complex]],
        middle: complex,
        ground: Callable[[complex], complex],
    ) -> None:
        super().__init__(scale, bars, middle)
        self.ground = ground

    def at(self, z: complex) -> complex:
        return z * self.scale

    def length(self, mm: float) -> float:
        return mm * self.scale

    def degrees(self, angle: float) -> float:
        return angle

    def ground_side(self, p: complex) -> complex:
        return self.ground(p)

    def room(self, p: complex) -> float:
        return min(
            (abs(b - a) for a, b in self._bars if min(abs(p - a), abs(p - b)) < 0.05), default=math.inf
        )

    def arrow(self, p: complex, q: complex, width: float = ARROW, size: float = TIP) -> None:
        size = min(size, 0.7 * abs(q - p))
        direction = (q - p) / (abs(q - p) or 1.0)
        self.draw(Path((p, q - direction * size * 0.8), width, layer=MARKS))
        self.head(q, direction, size)

    def arc_arrow(self, center: complex, radius: float, start: float, end: float, size: float) -> None:
        sign = 1 if end >= start else -1
        size = min(size, radius * math.radians(abs(end - start)) / 1.3)
        spread = math.degrees(size / radius)
        self.draw(Arc(center, radius, start, end - sign * 0.8 * spread, THIN + 0.05, layer=MARKS))
        self.head(center + radius * turn(end), sign * 1j * turn(end - sign * spread / 2), size)


Frames = Sequence[Sequence[Element]]
PAPER_MM = (130.0, 95.0)  #: largest size of what moves, by default


def drawing(
    frames: Frames,
    *,
    arrows: Sequence[Arrow] = (),
    spots: Sequence[TracedPoint] = (),
    keys: Sequence[LegendKey] = (),
    closed: bool = True,
    paper_mm: tuple[float, float] = PAPER_MM,
) -> MovingDrawing:
    """Draw the elements at every instant, with vectors and paths of points, to one scale.

    ``closed``: the last instant is followed by the first.

    Raises
    ------
    WrongValue
        The elements have no extent, or no element in common.
    """
    frames = _settled(matched(frames))
    if not frames[0]:
        raise WrongValue("no element of the figure is there at every instant, so nothing can be moved")
    low, high = extent(frames, arrows, spots)
    size = high - low
    rooms = complex(*paper_mm) - _SYMBOLS
    scale = min(r / s for r, s in ((rooms.real, size.real), (rooms.imag, size.imag)) if s > 0)
    stages = _stages(frames, scale, (low + high) / 2)
    tracks = [*_drawn(stages), *_moving_marks(arrows, spots, scale)]
    named = {wish.label for wish in stages[0].wishes}
    tracks += _labels(stages, arrows, [s for s in spots if s.point not in named], scale, closed)
    return _framed(tracks, keys, scale)


def extent(
    frames: Frames, arrows: Sequence[Arrow] = (), spots: Sequence[TracedPoint] = ()
) -> tuple[complex, complex]:
    """Return the corners of all that is visible at some instant, mm of mechanism."""
    points = [np.array([z for elements in frames for e in elements for z in e.reach()])]
    points += [spot.path for spot in spots] + [arrow.p + arrow.v for arrow in arrows]
    seen = np.concatenate(points)
    seen = seen[np.isfinite(seen)]
    low, high = complex(seen.real.min(), seen.imag.min()), complex(seen.real.max(), seen.imag.max())
    if not abs(high - low) > 0:
        raise WrongValue("the moving figure has no extent, so no scale")
    return low, high


def matched(frames: Frames) -> list[list[Element]]:
    """Return the elements present at every instant, matched by kind, label and rank among equals."""
    keyed = [_by_kind(elements) for elements in frames]
    common = [key for key in keyed[0] if all(key in item for item in keyed)]
    return [[item[key] for key in common] for item in keyed]


def _by_kind(elements: Sequence[Element]) -> Mapping[tuple, Element]:
    results: dict[tuple, Element] = {}
    for element in elements:
        label, rank = getattr(element, "label", ""), 0
        while (type(element), label, rank) in results:
            rank += 1
        results[type(element), label, rank] = element
    return results


def _settled(frames: list[list[Element]]) -> list[list[Element]]:
    """Return the elements with those on the frame at rest: guides and axes at full length, one sense of
    rotation, dimensions between fixed lines where they are out of the way."""
    columns = [_settled_one(column) for column in zip(*frames, strict=True)]
    return [list(row) for row in zip(*columns, strict=True)]


def _settled_one(column: tuple[Element, ...]) -> tuple[Element, ...]:
    first = column[0]
    if isinstance(first, rotation_arrow) and all(
        isinstance(e, rotation_arrow) and abs(e.center - first.center) < 1e-9 for e in column
    ):
        return (first,) * len(column)
    if isinstance(first, rail | centre_line) or (isinstance(first, line) and not first.label):
        return _on_one_line(column)
    if isinstance(first, dimension) and first.offset == 0 and _shift_across(column):
        return _farthest(column)
    return column


def _farthest(column: tuple) -> tuple:
    """Return the dimension that is farthest from the origin, at every instant."""
    return (max(column, key=lambda e: abs(e.p + e.q)),) * len(column)


def _shift_across(column: tuple) -> bool:
    """Return True if a dimension keeps its length and direction and moves across them, as that between two
    fixed lines does."""
    along = column[0].q - column[0].p
    size = max(abs(e.p - column[0].p) for e in column)
    return all(
        abs(e.q - e.p - along) <= 1e-9 * abs(along)
        and abs(((e.p - column[0].p) * along.conjugate()).real) <= 1e-6 * size * abs(along)
        for e in column
    )


def _on_one_line(column: tuple) -> tuple:
    """Return the union of segments of one line, at every instant; rotating segments stay unchanged."""
    p, direction = column[0].p, column[0].q - column[0].p
    if abs(direction) == 0:
        return column
    direction /= abs(direction)
    ends = [((e.p - p) / direction, (e.q - p) / direction) for e in column]
    size = max(abs(z) for end in ends for z in end)
    if any(abs(z.imag) > 1e-6 * size for end in ends for z in end):
        return column
    if any(q.real < p.real for p, q in ends):
        return column
    full = replace(
        column[0],
        p=p + direction * min(a.real for a, _ in ends),
        q=p + direction * max(b.real for _, b in ends),
    )
    return (full,) * len(column)


def _stages(frames: list[list[Element]], scale: float, middle: complex) -> list[_Stage]:
    """Return one sheet for each instant, with its elements drawn."""
    sides: dict[tuple[float, float], complex] = {}

    def ground(p: complex) -> complex:
        key = (rounded(p.real, 3), rounded(p.imag, 3))
        if key not in sides:
            sides[key] = _free_side([stage.directions(p) for stage in stages])
        return sides[key]

    bars = [[bar for element in elements for bar in element.bars()] for elements in frames]
    stages = [_Stage(scale, part, middle, ground) for part in bars]
    for stage, elements in zip(stages, frames, strict=True):
        for element in elements:
            element.draw(stage)
    return stages


def _free_side(occupied: Sequence[Sequence[complex]]) -> complex:
    """Return the side of a pivot where bars are least often, below first."""

    def clashes(direction: complex) -> int:
        return sum(any((t * direction.conjugate()).real > 0.64 for t in ways) for ways in occupied)

    return min((-1j, 1j, -1 + 0j, 1 + 0j), key=clashes)


# ----------------------------------------------------------------------- lines


def _drawn(stages: Sequence[_Stage]) -> list[MotionTrack]:
    """Return a track for each drawn line or mark of the elements."""
    count = min(len(stage.ink) for stage in stages)
    return [_track([stage.ink[i] for stage in stages]) for i in range(count)]


def _track(shapes: Sequence[Ink]) -> MotionTrack:
    first = shapes[0]
    discs = [shape for shape in shapes if isinstance(shape, Disc)]
    if isinstance(first, Disc) and [disc.radius for disc in discs] == [first.radius] * len(shapes):
        mark = f'<circle r="{number(first.radius)}"{_paint(first.width, first.fill, first.dash)}/>'
        return MotionTrack(_flat([[disc.center] for disc in discs]), mark=mark, layer=first.layer)
    closed = isinstance(first, Path) and first.closed
    fill = first.fill if isinstance(first, Path | Disc) else "none"
    sides = max(_sides_of(shape) for shape in shapes)
    points = [_points_of(shape, sides) for shape in shapes]
    most = max(map(len, points))
    # A path with fewer points stands on its last one for the rest.
    points = [[*row, *[row[-1]] * (most - len(row))] for row in points]
    return MotionTrack(_flat(points), _paint(first.width, fill, first.dash), closed, layer=first.layer)


def _sides_of(shape: Ink) -> int:
    """Return the number of sides with which an arc looks like one."""
    if not isinstance(shape, Arc):
        return 0
    turned = math.radians(abs(shape.end - shape.start))
    return max(_ARC_SIDES, math.ceil(turned / math.sqrt(8 * _STRAIGHT / max(shape.radius, _STRAIGHT))))


def _points_of(shape: Ink, sides: int = _ARC_SIDES) -> list[complex]:
    if isinstance(shape, Path):
        return list(shape.points)
    if isinstance(shape, Arc):
        return [shape.at(shape.start + (shape.end - shape.start) * k / sides) for k in range(sides + 1)]
    return list(shape.outline())


def _flat(points: Sequence[Sequence[complex]] | np.ndarray) -> np.ndarray:
    """Return rows of x, y, x, y, …, with y up."""
    grid = np.asarray(points, dtype=complex)
    return np.stack([grid.real, grid.imag], axis=-1).reshape(len(grid), -1)


def _moving_marks(arrows: Sequence[Arrow], spots: Sequence[TracedPoint], scale: float) -> list[MotionTrack]:
    tracks = [track for spot in spots for track in _spot_tracks(spot, scale)]
    return tracks + [track for arrow in arrows for track in _arrow_tracks(arrow, scale)]


def _spot_tracks(spot: TracedPoint, scale: float) -> list[MotionTrack]:
    """Return the path of a point, under the links, and its dot, on them."""
    colour, count = COLOURS["position"], len(spot.p)
    direction = spot.p * scale
    line = spot.path[_corners(spot.path, _STRAIGHT / scale)] * scale
    path = MotionTrack(
        np.repeat(_flat(line[None]), count, axis=0),
        f' stroke="{colour}"{_paint(0.25, "none")}',
        spot.closed,
        layer=FILLS,
        effect="position",
        point=spot.point,
    )
    dot = f'<circle r="0.7" fill="{colour}" stroke="none"/>'
    return [
        path,
        MotionTrack(_flat(direction[:, None]), mark=dot, layer=PINS, effect="position", point=spot.point),
    ]


def _corners(path: np.ndarray, allowed: float) -> np.ndarray:
    """Return the indices of those points that a line needs, in order: no other lies farther from it than
    allowed."""
    needed, spans = {0, len(path) - 1}, [(0, len(path) - 1)]
    while spans:
        start, end = spans.pop()
        if end - start < 2:
            continue
        chord, off = path[end] - path[start], path[start + 1 : end] - path[start]
        along = np.clip((off * chord.conjugate()).real / (abs(chord) ** 2 or 1.0), 0.0, 1.0)
        away = abs(off - along * chord)
        if away.max() > allowed:
            middle = start + 1 + int(away.argmax())
            needed.add(middle)
            spans += [(start, middle), (middle, end)]
    return np.array(sorted(needed))


def _arrow_tracks(arrow: Arrow, scale: float) -> list[MotionTrack]:
    tail = arrow.p * scale
    v = np.where(np.isfinite(arrow.v), arrow.v, 0) * scale
    length = np.abs(v)
    direction = v / np.where(length > 0, length, 1.0)
    size = np.minimum(TIP, 0.7 * length)
    tip, base = tail + v, tail + v - direction * size
    wing = 0.25 * size * 1j * direction
    colour = COLOURS[arrow.effect]
    shaft = f' stroke="{colour}"{_paint(ARROW, "none")}'
    head = f' stroke="none" fill="{colour}"'
    named = partial(MotionTrack, layer=MARKS, effect=arrow.effect, point=arrow.point)
    return [
        named(_flat(np.stack([tail, tip - 0.8 * direction * size], axis=-1)), shaft),
        named(_flat(np.stack([tip, base + wing, base - wing], axis=-1)), head, True),
    ]


# ---------------------------------------------------------------------- labels


def _labels(
    stages: Sequence[_Stage],
    arrows: Sequence[Arrow],
    spots: Sequence[TracedPoint],
    scale: float,
    closed: bool,
) -> list[MotionTrack]:
    """Return the tracks of the labels, which move with their elements."""
    drawn = _segments([stage.ink for stage in stages])
    shafts = [(arrow.p * scale, (arrow.p + np.nan_to_num(arrow.v)) * scale) for arrow in arrows]
    starts, ends = (np.hstack([drawn[k], *(shaft[k][:, None] for shaft in shafts)]) for k in range(2))
    count = min(len(stage.wishes) for stage in stages)
    rows = [[stage.wishes[i] for stage in stages] for i in range(count)]
    rows += [[LabelRequest(s.point, z * scale, 1j, 1.2, NAMES) for z in s.p] for s in spots]
    points = [""] * count + [s.point for s in spots]
    return [
        MotionTrack(
            _flat(centres[:, None]),
            mark=_letters(row[0].label, BLACK),
            layer=MARKS,
            effect="position" if point else "",
            point=point,
            is_label=True,
        )
        for row, centres, point in zip(rows, ride(rows, (starts, ends), closed), points, strict=True)
    ]


@lru_cache(maxsize=512)
def _letters(label: str, colour: str) -> str:
    """Return a label centred on the origin as SVG, on a white rim, so that lines may pass under it."""
    text = read(label)
    at = baseline(text, 0j)
    letters = as_outlines(text, at)
    rim = f'<g fill="{WHITE}" stroke="{WHITE}" stroke-width="{_RIM}">{letters}</g>'
    return f'{rim}<g fill="{colour}" stroke="none">{letters}{accents(text, at)}</g>'


def _segments(inks: Sequence[Sequence[Ink]]) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of every drawn segment that a label should avoid, one row an instant."""
    rows = [[side for shape in ink for side in _sides(shape)] for ink in inks]
    most = max(map(len, rows))
    ends = np.array([[*row, *[row[-1]] * (most - len(row))] for row in rows])
    return ends[..., 0], ends[..., 1]


def _sides(shape: Ink) -> list[tuple[complex, complex]]:
    points = _points_of(shape)
    return list(pairwise([*points, points[0]] if isinstance(shape, Path) and shape.closed else points))


# ----------------------------------------------------------------------- frame


def _framed(tracks: Sequence[MotionTrack], keys: Sequence[LegendKey], scale: float) -> MovingDrawing:
    """Return the drawing of all tracks in the coordinates of its frame, with the legend below."""
    xs = np.concatenate([t.numbers[:, 0::2].ravel() for t in tracks])
    ys = np.concatenate([t.numbers[:, 1::2].ravel() for t in tracks])
    around = 4.0  # symbols and letters reach this far from their origin
    left, top = rounded(xs.min() - around - _MARGIN, 1), rounded(ys.max() + around + _MARGIN, 1)
    bottom = ys.min() - around - _MARGIN
    width = rounded(xs.max() + around + _MARGIN - left, 1)
    indent = 2.0 + max((key.length * scale for key in keys), default=0.0)
    widest = max((read(key.words).box[0] for key in keys), default=-indent)
    width = max(width, rounded(indent + widest + 4 * _MARGIN, 1))
    legend, count = [], len(tracks[0].numbers)
    for row, key in enumerate(keys):
        corner = complex(left + 2 * _MARGIN, bottom - _ROW * (row + 0.4))
        legend += _key_tracks(key, count, corner, indent, scale)
    height = rounded(top - bottom + _ROW * len(keys), 1)
    flip = [replace(t, numbers=_downwards(t.numbers, left, top)) for t in [*tracks, *legend]]
    tracks = sorted(flip, key=lambda t: t.layer)
    return MovingDrawing(tuple(tracks), (width, height), scale, complex(left, top))


def _downwards(numbers: np.ndarray, left: float, top: float) -> np.ndarray:
    moved = numbers.copy()
    moved[:, 0::2] -= left
    moved[:, 1::2] = top - moved[:, 1::2]
    return moved


def _key_tracks(
    key: LegendKey, count: int, corner: complex, indent: float, scale: float
) -> list[MotionTrack]:
    """Return an arrow of a round length and its words, for the legend."""
    start = corner / scale
    arrow = Arrow(np.full(count, start), np.full(count, key.length + 0j), key.effect, "")
    centre = start * scale + indent + read(key.words).box[0] / 2
    mark = _letters(key.words, COLOURS[key.effect])
    words = MotionTrack(_flat([[centre]] * count), mark=mark, layer=MARKS, effect=key.effect)
    return [replace(track, key=True) for track in (*_arrow_tracks(arrow, scale), words)]
