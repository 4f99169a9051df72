"""Where labels go: near what they name, on no line, on no other label.

Every label has a list of candidate places, cheapest first; it takes the first free one.
Labels are placed in a fixed order, so the same figure always comes out the same.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

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
_MORE = 8.0  #: mm round a place in which lines are looked up with it


class Place(NamedTuple):
    """A place for a label, told from what it names: the same list serves every label of a kind."""

    way: complex  #: from the preferred direction, a unit complex number
    step: float  #: beyond where labels begin, mm
    fraction: float | None  #: of the segment beside which it lies; none for a place round the anchor
    clear: float  #: white asked for between it and the lines, mm
    number: int  #: the same for the same place with less white


@lru_cache(maxsize=4)
def _places(beside: bool, angle: bool) -> tuple[Place, ...]:
    """All places of a kind of label, cheapest first; the costs are in mm away from the best place."""
    costed = []
    if beside:
        for side in (1, -1):
            for fraction in _FRACTIONS:
                for step in _STEPS[:6]:
                    cost = step + 4 * abs(fraction - 0.5) + 0.4 * (side < 0)
                    costed.append((cost, (complex(side), step, fraction)))
    late, turning = (3.0 if beside else 0.0), (1.6 if angle else 0.7)
    for sixteenth in range(16):
        away = math.radians(22.5 * min(sixteenth, 16 - sixteenth))
        for step in _STEPS:
            costed.append((late + step + turning * away, (turn(22.5 * sixteenth), step, None)))
    tries = [
        (round(cost + more, 6), number, Place(*place, clear, number))
        for number, (cost, place) in enumerate(costed)
        for clear, more in ((_AIRY, 0.0), (_CLEAR, 1.2))
    ]
    return tuple(place for _, _, place in sorted(tries, key=lambda one: one[:2]))


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

    def places(self) -> tuple[Place, ...]:
        """Where the label may go, the best place first."""
        return _places(self.along is not None, self.rank == ANGLES)

    def hoped(self) -> tuple[complex, complex]:
        """Corners of its box at the best place, whatever lies there."""
        half = complex(*read(self.label).box) / 2
        center = self.center(self.places()[0], half)
        return center - half, center + half

    def center(self, place: Place, half: complex) -> complex:
        """Centre of a box of these half-sides at a place."""
        way, foot = self.toward * place.way, self.anchor
        if self.along and place.fraction is not None:
            foot = self.along[0] + (self.along[1] - self.along[0]) * place.fraction
        return foot + way * (self.start + place.step + _support(half, way))


def _support(half: complex, way: complex) -> float:
    """Half-width of a box across a direction."""
    return half.real * abs(way.real) + half.imag * abs(way.imag)


#: A line with its half-width, mm: the left, low, right and high sides of the least box round it, its middle (across
#: and up), and from there to its end. A plain tuple, since labels are tried against lines by the thousand.
Line = tuple[float, float, float, float, float, float, float, float, float]


def _line(a: complex, b: complex, half: float) -> Line:
    ax, ay, bx, by = a.real, a.imag, b.real, b.imag
    left, right = (ax, bx) if ax < bx else (bx, ax)
    low, high = (ay, by) if ay < by else (by, ay)
    return (
        left - half, low - half, right + half, high + half,
        (ax + bx) / 2, (ay + by) / 2, (bx - ax) / 2, (by - ay) / 2, half,
    )  # fmt: skip


def _meets(line: Line, across: float, up: float, wide: float, tall: float) -> bool:
    """Whether a box, told by its middle and its half-sides, meets a line: no axis separates them."""
    left, low, right, high, middle_across, middle_up, half_across, half_up, half = line
    if left > across + wide or right < across - wide or low > up + tall or high < up - tall:
        return False
    turned = (middle_across - across) * half_up - (middle_up - up) * half_across
    return abs(turned) <= (wide + half) * abs(half_up) + (tall + half) * abs(half_across)


class Obstacles:
    """The lines already drawn, with areas that labels avoid, and the labels already placed."""

    def __init__(self, ink: Sequence[Ink]) -> None:
        self._lines: list[Line] = []
        self.areas: list[tuple[complex, ...]] = []
        self.bars: list[tuple[complex, complex]] = []
        for item in ink:
            outline = item.outline()
            sides = list(pairwise(outline))
            self._lines += [_line(a, b, item.width / 2) for a, b in sides]
            self.areas += [outline] if item.solid else []
            self.bars += sides if item.width >= BAR else []
        self.labels: list[Label] = []
        self._boxes: list[tuple[float, float, float, float]] = []  #: of the labels, with the white round them
        self._start()

    def _start(self) -> None:
        """Nothing is known yet of the label to place."""
        self._window = (math.inf, math.inf, -math.inf, -math.inf)  #: of the paper where it was tried
        self._near: list[Line] = []  #: the lines that come into the window
        self._blocking: list[Line] = []  #: those that it has met, the last one first

    def put(self, label: Label) -> None:
        """A label that is placed, with its leader."""
        self.labels.append(label)
        reach = complex(label.width, label.height) / 2 + complex(_APART, _APART)
        self._boxes.append((label.center.real, label.center.imag, reach.real, reach.imag))
        if label.leader:
            self._lines.append(_line(*label.leader, THIN / 2))
        self._start()

    def _look(self, left: float, low: float, right: float, high: float) -> None:
        """Widens the window so that it holds a box, and some more for the next ones."""
        a, b, c, d = self._window
        if left < a or low < b or right > c or high > d:
            a, b, c, d = (
                min(a, left - _MORE),
                min(b, low - _MORE),
                max(c, right + _MORE),
                max(d, high + _MORE),
            )
            self._window = a, b, c, d
            self._near = [it for it in self._lines if it[0] <= c and it[2] >= a and it[1] <= d and it[3] >= b]

    def white(self, center: complex, half: complex, inside: bool = False) -> float:
        """The white that a box has: the one that labels prefer, the least there may be, or 0 for too little."""
        cx, cy, wide, tall = center.real, center.imag, half.real, half.imag
        # What was in the way of the last places is most often in the way of this one.
        for k, line in enumerate(self._blocking):
            if _meets(line, cx, cy, wide + _CLEAR, tall + _CLEAR):
                self._blocking.insert(0, self._blocking.pop(k))
                return 0.0
        for across, up, width, height in self._boxes:
            if abs(cx - across) < wide + width and abs(cy - up) < tall + height:
                return 0.0
        found, x, y = _AIRY, wide + _AIRY, tall + _AIRY
        left, low, right, high = cx - x, cy - y, cx + x, cy + y
        self._look(left, low, right, high)
        for line in self._near:
            # The first thing that ``_meets`` asks, without a call: most lines are off.
            if line[0] > right or line[2] < left or line[1] > high or line[3] < low:
                continue
            if _meets(line, cx, cy, x, y):
                if found == _CLEAR or _meets(line, cx, cy, wide + _CLEAR, tall + _CLEAR):
                    self._blocking.insert(0, line)
                    return 0.0
                found, x, y = _CLEAR, wide + _CLEAR, tall + _CLEAR
                left, low, right, high = cx - x, cy - y, cx + x, cy + y
        return 0.0 if not inside and any(within(center, area) for area in self.areas) else found

    @property
    def right(self) -> float:
        """Abscissa of the rightmost line."""
        return max((line[2] for line in self._lines), default=0.0)

    def hides(self, anchor: complex, center: complex) -> bool:
        """Whether a bar passes between an anchor and its label."""
        return any(_meet(anchor, center, a, b) for a, b in self.bars if distance(anchor, a, b) > 1.3)

    def leader_free(self, a: complex, b: complex) -> bool:
        thin = _line(a, b, 0.3)
        return not any(
            _meets(thin, it.center.real, it.center.imag, it.width / 2, it.height / 2) for it in self.labels
        )


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
        obstacles.put(_choose(wishes[k], obstacles))
    return tuple(obstacles.labels), tuple(order)


def _choose(wish: Wish, obstacles: Obstacles) -> Label:
    text = read(wish.label)
    width, height = text.box
    half = complex(width, height) / 2
    # A label is in sight of what it names; failing that, a leader may pass over a bar.
    tried: dict[int, tuple[complex, float]] = {}  #: the centre of each place, and its white
    for in_sight in (True, False):
        for place in wish.places():
            if place.number not in tried:
                center = wish.center(place, half)
                tried[place.number] = center, obstacles.white(center, half, wish.inside)
            center, white = tried[place.number]
            if white < place.clear:
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
