"""Where labels go: near what they name, on no line, on no other label.

Every label has a list of candidate places, cheapest first; it takes the first free one.
Labels are placed in a fixed order, so the same figure always comes out the same.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from coursework.figures.ink import BAR, THIN, Ink, turn
from coursework.figures.text import Text, read

_CLEAR = 0.45  #: least white between a label and a line, mm
_AIRY = 0.8  #: the white a label prefers
_APART = 0.5  #: least white between two labels, mm
_LEADER = 4.5  #: a label farther than this from what it names gets a thin line to it, mm
_AT_ARC = 3.0  #: the same for an angle, from the middle of its arc, mm
_STEPS = (0.0, 0.5, 1.0, 1.7, 2.5, 3.5, 5.0, 7.0, 9.5, 12.5, 16.0, 20.0, 26.0, 34.0, 45.0, 60.0)
INSIDE, NAMES, ANGLES, SIDES = range(4)  #: ranks of labels: those with least choice first
_FRACTIONS = (0.5, 0.42, 0.58, 0.34, 0.66, 0.25, 0.75)


@dataclass(frozen=True)
class Label:
    """A placed label: its box on paper, mm, y up, and its leader line if it has one."""

    label: str
    text: Text
    center: complex
    width: float
    height: float
    leader: tuple[complex, complex] | None = None

    @property
    def corners(self) -> tuple[complex, complex]:
        half = complex(self.width, self.height) / 2
        return self.center - half, self.center + half


@dataclass(frozen=True)
class Wish:
    """A label to place around a point, or beside a segment when ``along`` has its two ends."""

    label: str
    anchor: complex
    toward: complex  #: preferred direction, a unit complex number
    start: float  #: distance from the anchor at which labels begin, mm
    rank: int  #: lower ranks choose first
    along: tuple[complex, complex] | None = None
    inside: bool = False  #: the label belongs inside a hatched area

    @property
    def source(self) -> complex:
        """The point that the label must be in sight of: on its arc for an angle."""
        return self.anchor + self.toward * max(0.0, self.start) if self.rank == ANGLES else self.anchor

    def candidates(self, half: complex) -> Iterator[tuple[complex, float]]:
        """Pairs (centre of the box, white to its lines), the cheapest first."""
        p, q = self.along or (self.anchor, self.anchor)
        for around, turned, step, clear in _order(self.along is not None, self.rank == ANGLES):
            foot = self.anchor if around else p + (q - p) * step[0]
            way = self.toward * turned
            yield foot + way * (self.start + step[1] + _support(half, way)), clear


@cache
def _order(beside: bool, at_arc: bool) -> tuple[tuple[bool, complex, tuple[float, float], float], ...]:
    """Places for a label, the cheapest first: whether around the anchor, the turn from the preferred direction,
    the fraction of the segment and the distance from it, and the white that is asked.

    The same for all labels of a kind, so it is put in order once.
    """
    places = []
    if beside:
        for side in (1, -1):
            for fraction in _FRACTIONS:
                for step in _STEPS[:6]:
                    cost = step + 4 * abs(fraction - 0.5) + 0.4 * (side < 0)
                    places.append((cost, False, side, (fraction, step)))
    late, turning = (3.0 if beside else 0.0), (1.6 if at_arc else 0.7)
    for sixteenth in range(16):
        turned = turn(22.5 * sixteenth)
        for step in _STEPS:
            cost = late + step + turning * abs(cmath.phase(turned))
            places.append((cost, True, turned, (0.0, step)))
    tries = [
        (round(place[0] + more, 6), number, place[1:], clear)
        for number, place in enumerate(places)
        for clear, more in ((_AIRY, 0.0), (_CLEAR, 1.2))
    ]
    return tuple((*place, clear) for _, _, place, clear in sorted(tries, key=lambda t: t[:2]))


def _support(half: complex, way: complex) -> float:
    """Half-width of a box across a direction."""
    return half.real * abs(way.real) + half.imag * abs(way.imag)


Segment = tuple[complex, complex, float]


class Obstacles:
    """The lines already drawn: segments with half their width, and areas that labels avoid."""

    def __init__(self, ink: Sequence[Ink]) -> None:
        self._bounded: list[tuple[float, float, float, float, Segment]] = []
        segments = [(a, b, item.width / 2) for item in ink for a, b in pairwise(item.outline())]
        self.add(segments)
        self.areas = [item.outline() for item in ink if item.solid]
        self.bars = [(a, b) for a, b, half in segments if half >= BAR / 2]
        self.labels: list[Label] = []
        self._boxes: list[tuple[float, float, float, float]] = []  #: of the labels, centres and half-sides

    def take(self, label: Label) -> None:
        """A label has its place: others keep clear of it, and lines of its leader."""
        self.labels.append(label)
        sides = label.width / 2 + _APART, label.height / 2 + _APART
        self._boxes.append((label.center.real, label.center.imag, *sides))
        if label.leader:
            self.add([(*label.leader, THIN / 2)])

    def add(self, segments: Iterable[Segment]) -> None:
        for a, b, half in segments:
            low = min(a.real, b.real) - half, min(a.imag, b.imag) - half
            high = max(a.real, b.real) + half, max(a.imag, b.imag) + half
            self._bounded.append((*low, *high, (a, b, half)))

    def free(self, center: complex, half: complex, clear: float, inside: bool = False) -> bool:
        middle_x, middle_y, half_x, half_y = center.real, center.imag, half.real, half.imag
        for other_x, other_y, other_half_x, other_half_y in self._boxes:
            if (
                abs(middle_x - other_x) < half_x + other_half_x
                and abs(middle_y - other_y) < half_y + other_half_y
            ):
                return False
        x, y = half_x + clear, half_y + clear
        left, right, bottom, top = middle_x - x, middle_x + x, middle_y - y, middle_y + y
        for x0, y0, x1, y1, segment in self._bounded:
            if x0 <= right and x1 >= left and y0 <= top and y1 >= bottom and _crosses(center, x, y, segment):
                return False
        return inside or not any(within(center, area) for area in self.areas)

    @property
    def right(self) -> float:
        """Abscissa of the rightmost line."""
        return max((bounds[2] for bounds in self._bounded), default=0.0)

    def hides(self, anchor: complex, center: complex) -> bool:
        """Whether a bar passes between an anchor and its label."""
        return any(_meet(anchor, center, a, b) for a, b in self.bars if distance(anchor, a, b) > 1.3)

    def leader_free(self, a: complex, b: complex) -> bool:
        thin = (a, b, 0.3)
        return not any(_crosses(it.center, it.width / 2, it.height / 2, thin) for it in self.labels)


def _crosses(center: complex, hx: float, hy: float, segment: Segment) -> bool:
    """Separating axes of a box, given by its half-sides, and a segment with some half-width."""
    a, b, width = segment
    middle, d = (a + b) / 2 - center, (b - a) / 2
    hx, hy = hx + width, hy + width
    if abs(middle.real) > hx + abs(d.real) or abs(middle.imag) > hy + abs(d.imag):
        return False
    return abs(middle.real * d.imag - middle.imag * d.real) <= hx * abs(d.imag) + hy * abs(d.real)


def within(z: complex, area: Sequence[complex]) -> bool:
    """Even-odd rule."""
    odd = False
    for a, b in pairwise(area):
        if (a.imag > z.imag) != (b.imag > z.imag):
            odd ^= z.real < a.real + (b.real - a.real) * (z.imag - a.imag) / (b.imag - a.imag)
    return odd


def _side(a: complex, b: complex, z: complex) -> float:
    return ((b - a).conjugate() * (z - a)).imag


def _meet(a: complex, b: complex, c: complex, d: complex) -> bool:
    return _side(a, b, c) * _side(a, b, d) < 0 and _side(c, d, a) * _side(c, d, b) < 0


def distance(z: complex, a: complex, b: complex) -> float:
    d = b - a
    t = min(1.0, max(0.0, ((z - a) * d.conjugate()).real / (abs(d) ** 2 or 1.0)))
    return abs(z - a - t * d)


def place(wishes: Sequence[Wish], ink: Sequence[Ink]) -> tuple[tuple[Label, ...], tuple[int, ...]]:
    """Places every label, in order of rank then of writing; with each, the place of its wish among them."""
    obstacles = Obstacles(ink)
    order = sorted(range(len(wishes)), key=lambda k: wishes[k].rank)
    for k in order:
        obstacles.take(_choose(wishes[k], obstacles))
    return tuple(obstacles.labels), tuple(order)


def _choose(wish: Wish, obstacles: Obstacles) -> Label:
    text = read(wish.label)
    width, height = text.box
    half = complex(width, height) / 2
    # A label is in sight of what it names; failing that, a leader may pass over a bar.
    for in_sight in (True, False):
        for center, clear in wish.candidates(half):
            if not obstacles.free(center, half, clear, wish.inside):
                continue
            leader = _leader(wish, center, half)
            if (in_sight or leader is None) and obstacles.hides(wish.source, center):
                continue
            if leader is None or obstacles.leader_free(*leader):
                return Label(wish.label, text, center, width, height, leader)
    return _outside(wish, text, obstacles)


def _leader(wish: Wish, center: complex, half: complex) -> tuple[complex, complex] | None:
    """A thin line from the anchor to the box, when the label is far from what it names."""
    if wish.along and distance(center, *wish.along) <= _support(half, wish.toward) + _LEADER:
        return None
    # An angle is named at its arc: its label may lie on any side of the corner.
    foot, start, near = (
        (wish.source, 0.0, _AT_ARC) if wish.rank == ANGLES else (wish.anchor, wish.start, _LEADER)
    )
    way = (center - foot) / (abs(center - foot) or 1.0)
    if abs(center - foot) - _support(half, way) <= start + near:
        return None
    edge = min(half.real / (abs(way.real) or 1e-9), half.imag / (abs(way.imag) or 1e-9))
    return foot + way * start, center - way * (edge + _APART)


def _outside(wish: Wish, text: Text, obstacles: Obstacles) -> Label:
    """Beyond everything drawn: the place of a label that found no other."""
    right = max([obstacles.right, *(label.corners[1].real for label in obstacles.labels)])
    width, height = text.box
    return Label(wish.label, text, complex(right + 2 + width / 2, wish.anchor.imag), width, height)
