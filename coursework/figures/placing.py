"""Placement of labels: near their element, on no line, on no other label, and nearer to their own element
than to similar ones.

Every label has a list of candidate places, cheapest first; it takes the first free one.
Labels are placed in a fixed order, so the same figure always comes out the same.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from coursework.figures.ink import ANGLES, BAR, NAMES, THIN, Ink, turn
from coursework.figures.text import LabelText, read

_CLEAR = 0.45  #: least white between a label and a line, mm
_AIRY = 0.8  #: the white a label prefers
_APART = 0.5  #: least white between two labels, mm
_LEADER = 4.5  #: a label farther than this from what it names gets a thin line to it, mm
_AT_ARC = 3.0  #: the same for an angle, from the middle of its arc, mm
#: A label is nearer to its own line or point than to any other that has a label, by so much, mm.
_NEARER = 0.2
_ALOOF = 2.0  #: least white between a label with a leader and another line that has a label, mm
_SAME = 0.05  #: points so near each other are one, mm
_BESIDE = 1.5  #: so near a leader of a label passes no other point that has one, mm
_FAR = 9.5  #: largest distance to which a label is moved to be clearer, mm
_STEPS = (0.0, 0.5, 1.0, 1.7, 2.5, 3.5, 5.0, 7.0, 9.5, 12.5, 16.0, 20.0, 26.0, 34.0, 45.0, 60.0)
_FRACTIONS = (0.5, 0.42, 0.58, 0.34, 0.66, 0.25, 0.75)
_ROUND = 32  #: rays round a point
_RAYS = 2 * len(_FRACTIONS) + _ROUND  #: on which places lie, at most
_MORE = 8.0  #: mm round a place in which lines are looked up with it


class LabelPosition(NamedTuple):
    """Candidate position of a label, relative to its element: one list serves every label of a kind."""

    way: complex  #: from the preferred direction, a unit complex number
    step: float  #: beyond where labels begin, mm
    fraction: float | None  #: of the segment beside which it lies; none for a place round the anchor
    clear: float  #: white asked for between it and the lines, mm
    number: int  #: the same for the same place with less white
    ray: int  #: the same for places one behind the other


@lru_cache(maxsize=4)
def _places(is_beside: bool, angle: bool) -> tuple[LabelPosition, ...]:
    """Return all candidate positions for a kind of label, cheapest first; costs are in mm from the best
    position."""
    costed: list[tuple[float, tuple[complex, float, float | None]]] = []
    if is_beside:
        for side in (1, -1):
            for fraction in _FRACTIONS:
                for step in _STEPS[:6]:
                    cost = step + 4 * abs(fraction - 0.5) + 0.4 * (side < 0)
                    costed.append((cost, (complex(side), step, fraction)))
    late, turning = (3.0 if is_beside else 0.0), (1.6 if angle else 0.7)
    for ray in range(_ROUND):
        away = math.tau * min(ray, _ROUND - ray) / _ROUND
        # Beside a line, those round its middle are for labels with a leader.
        for step in _STEPS[5:] if is_beside else _STEPS:
            costed.append((late + step + turning * away, (turn(360 * ray / _ROUND), step, None)))
    rays: dict[tuple[complex, float | None], int] = {}
    for _, (direction, _, along) in costed:
        rays.setdefault((direction, along), len(rays))
    tries = [
        (
            round(cost + more, 6),
            number,
            LabelPosition(*position, clear, number, rays[position[0], position[2]]),
        )
        for number, (cost, position) in enumerate(costed)
        for clear, more in ((_AIRY, 0.0), (_CLEAR, 1.2))
    ]
    return tuple(position for _, _, position in sorted(tries, key=lambda item: item[:2]))


@dataclass(frozen=True)
class Label:
    """Placed label: its box on paper, mm, y up, and its leader line if it has one."""

    label: str
    text: LabelText
    center: complex
    width: float
    height: float
    leader: tuple[complex, complex] | None = None

    @property
    def corners(self) -> tuple[complex, complex]:
        half = complex(self.width, self.height) / 2
        return self.center - half, self.center + half


@dataclass(frozen=True)
class LabelRequest:
    """Request for a label around a point, or beside a segment when ``along`` has its two ends."""

    label: str
    anchor: complex
    toward: complex  #: preferred direction, a unit complex number
    start: float  #: distance from the anchor at which labels begin, mm
    rank: int  #: lower ranks choose first
    along: tuple[complex, complex] | None = None
    inside: bool = False  #: the label belongs inside a hatched area
    area: tuple[complex, ...] = ()  #: outline of the body that it names, where that is drawn as an area

    @property
    def source(self) -> complex:
        """Point that the label must be in sight of: on its arc for an angle."""
        return self.anchor + self.toward * max(0.0, self.start) if self.rank == ANGLES else self.anchor

    def places(self) -> tuple[LabelPosition, ...]:
        """Return the candidate positions of the label, the best first."""
        return _places(self.along is not None, self.rank == ANGLES)

    def hoped(self) -> tuple[complex, complex]:
        """Return the corners of the label's box at its best position, whatever lies there."""
        half = complex(*read(self.label).box) / 2
        center = self.center(self.places()[0], half)
        return center - half, center + half

    def center(self, position: LabelPosition, half: complex) -> complex:
        """Return the centre of a box of these half-sides at a place."""
        direction, foot = self.toward * position.way, self.anchor
        if self.along and position.fraction is not None:
            foot = self.along[0] + (self.along[1] - self.along[0]) * position.fraction
        # The last two are what ``_support`` says, without a call.
        return foot + direction * (
            self.start + position.step + half.real * abs(direction.real) + half.imag * abs(direction.imag)
        )


def _support(half: complex, direction: complex) -> float:
    """Return the half-width of a box in a direction."""
    return half.real * abs(direction.real) + half.imag * abs(direction.imag)


#: A line with its half-width, mm: the left, low, right and high sides of the least box round it, its middle
#: (across and up), and from there to its end. A plain tuple, since labels are tried against lines by the
#: thousand.
Line = tuple[float, float, float, float, float, float, float, float, float]

#: Lines drawn together, after the sides of the least box round them all: most things are off at once.
Thing = tuple[float, float, float, float, list[Line]]


def _shape(lines: list[Line]) -> Thing:
    left, low, right, high, *_ = zip(*lines, strict=True)
    return min(left), min(low), max(right), max(high), lines


def _line(a: complex, b: complex, half: float) -> Line:
    ax, ay, bx, by = a.real, a.imag, b.real, b.imag
    left, right = (ax, bx) if ax < bx else (bx, ax)
    low, high = (ay, by) if ay < by else (by, ay)
    return (
        left - half,
        low - half,
        right + half,
        high + half,
        (ax + bx) / 2,
        (ay + by) / 2,
        (bx - ax) / 2,
        (by - ay) / 2,
        half,
    )


def _meets(line: Line, across: float, up: float, wide: float, tall: float) -> bool:
    """Return whether a box, given by its centre and half-sides, meets a line: no axis separates them."""
    left, low, right, high, middle_across, middle_up, half_across, half_up, half = line
    if left > across + wide or right < across - wide or low > up + tall or high < up - tall:
        return False
    turned = (middle_across - across) * half_up - (middle_up - up) * half_across
    return abs(turned) <= (wide + half) * abs(half_up) + (tall + half) * abs(half_across)


def _way_out(line: Line, across: float, up: float, wide: float, tall: float, direction: complex) -> float:
    """Return the distance that a box on a line moves in a direction until some axis separates them."""
    left, low, right, high, middle_across, middle_up, half_across, half_up, half = line
    x, y = direction.real, direction.imag
    out = math.inf
    if x:
        out = (right - across + wide) / x if x > 0 else (left - across - wide) / x
    if y:
        more = (high - up + tall) / y if y > 0 else (low - up - tall) / y
        out = more if more < out else out
    turning = y * half_across - x * half_up
    if turning:
        turned = (middle_across - across) * half_up - (middle_up - up) * half_across
        reach = (wide + half) * abs(half_up) + (tall + half) * abs(half_across)
        more = (reach - turned if turning > 0 else -reach - turned) / turning
        out = more if more < out else out
    return out


def _gap(line: Line, across: float, up: float, wide: float, tall: float) -> float:
    """Return the distance between a box and a thin line that does not meet it."""
    x, y, dx, dy = line[4] - across, line[5] - up, line[6], line[7]
    square = dx * dx + dy * dy
    result = math.inf
    # What is nearest is an end of the line, or a corner of the box.
    for end in (-1, 1):
        a, b = max(abs(x + end * dx) - wide, 0.0), max(abs(y + end * dy) - tall, 0.0)
        result = min(result, a * a + b * b)
    for a, b in ((x - wide, y - tall), (x - wide, y + tall), (x + wide, y - tall), (x + wide, y + tall)):
        if abs(a * dx + b * dy) < square:
            result = min(result, (a * dy - b * dx) ** 2 / square)
    return math.sqrt(result)


class Obstacles:
    """Lines already drawn, with areas that labels avoid, and the labels already placed."""

    def __init__(self, ink: Sequence[Ink]) -> None:
        self._shapes: list[Thing] = []
        self.areas: list[tuple[complex, ...]] = []
        self.bars: list[tuple[complex, complex]] = []
        for item in ink:
            outline = item.outline()
            sides = list(pairwise(outline))
            self._shapes.append(_shape([_line(a, b, item.width / 2) for a, b in sides]))
            self.areas += [outline] if item.solid else []
            self.bars += sides if item.width >= BAR else []
        self.labels: list[Label] = []
        self._boxes: list[tuple[float, float, float, float]] = []  #: of the labels, with the white round them
        self._start()

    def _start(self) -> None:
        """Reset the cache for the next label to place."""
        self._window = (math.inf, math.inf, -math.inf, -math.inf)  #: of the paper where it was tried
        self._near: list[Thing] = []  #: what comes into the window
        self._blocking: list[Line] = []  #: the lines that it has met, the last one first

    def put(self, label: Label) -> None:
        """Add a placed label, with its leader."""
        self.labels.append(label)
        reach = complex(label.width, label.height) / 2 + complex(_APART, _APART)
        self._boxes.append((label.center.real, label.center.imag, reach.real, reach.imag))
        if label.leader:
            self._shapes.append(_shape([_line(*label.leader, THIN / 2)]))
        self._start()

    def _look(self, left: float, low: float, right: float, high: float) -> None:
        """Widen the window so that it holds a box, with a margin for the next ones."""
        a, b, c, d = self._window
        if left < a or low < b or right > c or high > d:
            a, b, c, d = (
                min(a, left - _MORE),
                min(b, low - _MORE),
                max(c, right + _MORE),
                max(d, high + _MORE),
            )
            self._window = a, b, c, d
            self._near = [
                it for it in self._shapes if it[0] <= c and it[2] >= a and it[1] <= d and it[3] >= b
            ]

    def white(self, center: complex, half: complex, direction: complex, inside: bool = False) -> float:
        """Return the white space round a box: the preferred one, or the least one allowed.

        Where there is less, return minus the distance to go in direction ``direction``, at least, until there
        may be more.
        """
        cx, cy, wide, tall = center.real, center.imag, half.real, half.imag
        x, y = wide + _CLEAR, tall + _CLEAR
        left, low, right, high = cx - x, cy - y, cx + x, cy + y
        # What was in the way of the last places is most often in the way of this one.
        for k, line in enumerate(self._blocking):
            # The first thing that ``_meets`` asks, without a call: most lines are off.
            if line[0] > right or line[2] < left or line[1] > high or line[3] < low:
                continue
            if _meets(line, cx, cy, x, y):
                if k:
                    self._blocking.insert(0, self._blocking.pop(k))
                return -_way_out(line, cx, cy, x, y, direction)
        for across, up, width, height in self._boxes:
            x, y = wide + width, tall + height
            if abs(cx - across) < x and abs(cy - up) < y:
                return -_way_out((across, up, across, up, across, up, 0.0, 0.0, 0.0), cx, cy, x, y, direction)
        result, x, y = _AIRY, wide + _AIRY, tall + _AIRY
        left, low, right, high = cx - x, cy - y, cx + x, cy + y
        self._look(left, low, right, high)
        for shape in self._near:
            if shape[0] > right or shape[2] < left or shape[1] > high or shape[3] < low:
                continue
            for line in shape[4]:
                if line[0] > right or line[2] < left or line[1] > high or line[3] < low:
                    continue
                if _meets(line, cx, cy, x, y):
                    less_x, less_y = wide + _CLEAR, tall + _CLEAR
                    if result == _CLEAR or _meets(line, cx, cy, less_x, less_y):
                        self._blocking.insert(0, line)
                        return -_way_out(line, cx, cy, less_x, less_y, direction)
                    result, x, y = _CLEAR, less_x, less_y
                    left, low, right, high = cx - x, cy - y, cx + x, cy + y
        return 0.0 if not inside and any(within(center, area) for area in self.areas) else result

    @property
    def right(self) -> float:
        """Abscissa of the rightmost line."""
        return max((it[2] for it in self._shapes), default=0.0)

    def hides(self, anchor: complex, center: complex) -> bool:
        """Return whether a bar passes between an anchor and its label."""
        return any(_meet(anchor, center, a, b) for a, b in self.bars if distance(anchor, a, b) > 1.3)

    def leader_free(self, a: complex, b: complex) -> bool:
        thin = _line(a, b, 0.3)
        return not any(
            _meets(thin, it.center.real, it.center.imag, it.width / 2, it.height / 2) for it in self.labels
        )


def within(z: complex, area: Sequence[complex]) -> bool:
    """Return whether a point lies inside an area, by the even-odd rule."""
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


def place(wishes: Sequence[LabelRequest], ink: Sequence[Ink]) -> tuple[tuple[Label, ...], tuple[int, ...]]:
    """Place every label, in order of rank, then of appearance; return the labels and the index of each one's
    request."""
    obstacles = Obstacles(ink)
    order = sorted(range(len(wishes)), key=lambda k: wishes[k].rank)
    sides = {wish.along: _line(*wish.along, 0.0) for wish in wishes if wish.along}
    for k in order:
        obstacles.put(_choose(wishes[k], obstacles, _Rivals(wishes[k], wishes, sides)))
    return tuple(obstacles.labels), tuple(order)


class _Rivals:
    """Other labelled elements of the same kind, for which a reader may take a label: lines, points, angles or
    areas."""

    def __init__(
        self,
        wish: LabelRequest,
        wishes: Sequence[LabelRequest],
        sides: Mapping[tuple[complex, complex], Line],
    ) -> None:
        same = (wish.along, wish.along[::-1]) if wish.along else () if wish.area else sides
        self.own = sides[wish.along] if wish.along else None
        self.lines = [line for ends, line in sides.items() if ends not in same]
        is_body = bool(wish.along or wish.area)
        self.areas = [it.area for it in wishes if it.area and it is not wish] if is_body else []
        self.source = None if is_body or wish.rank not in (NAMES, ANGLES) else wish.source
        others = {it.source: None for it in wishes if it.rank == wish.rank and not it.area}
        self.points = [z for z in others if self.source is not None and abs(z - self.source) > _SAME]

    def mistaken(self, center: complex, half: complex, leader: tuple[complex, complex] | None) -> int:
        """Return how easily a label here is taken for that of another element.

        0: not at all; 1: another is near, but a leader points to its own; 2: its leader crosses another; 3:
        no leader.
        """
        if self.source is not None:
            return self._of_a_point(self.source, center, half, leader) if self.points else 0
        if leader is None and any(within(center, area) for area in self.areas):
            return 3
        if not self.lines:
            return 0
        if leader is None:
            own_gap = (
                0.0 if self.own is None else _gap(self.own, center.real, center.imag, half.real, half.imag)
            )
            return 3 if self._within(own_gap + _NEARER, center, half) else 0
        if any(_crosses(line, *leader) for line in self.lines):
            return 2
        return int(self._within(_ALOOF, center, half))

    def _of_a_point(
        self, source: complex, center: complex, half: complex, leader: tuple[complex, complex] | None
    ) -> int:
        far = (
            min(_from_box(z, center, half) for z in self.points) >= _from_box(source, center, half) + _NEARER
        )
        if leader is None:
            return 0 if far else 3
        if any(distance(z, *leader) < _BESIDE for z in self.points):
            return 2
        return 0 if far else 1

    def _within(self, gap: float, center: complex, half: complex) -> bool:
        """Return whether one of the lines is nearer to a box than ``gap``."""
        cx, cy, x, y = center.real, center.imag, half.real + gap, half.imag + gap
        left, low, right, high = cx - x, cy - y, cx + x, cy + y
        for line in self.lines:
            if line[0] > right or line[2] < left or line[1] > high or line[3] < low:
                continue
            if _meets(line, cx, cy, x, y) and _gap(line, cx, cy, half.real, half.imag) < gap:
                return True
        return False


def _from_box(z: complex, center: complex, half: complex) -> float:
    """Return the distance of a point from a box."""
    away = z - center
    return math.hypot(max(abs(away.real) - half.real, 0.0), max(abs(away.imag) - half.imag, 0.0))


def _crosses(line: Line, a: complex, b: complex) -> bool:
    middle, direction = complex(line[4], line[5]), complex(line[6], line[7])
    return _meet(a, b, middle - direction, middle + direction)


def _choose(wish: LabelRequest, obstacles: Obstacles, rivals: _Rivals) -> Label:
    text = read(wish.label)
    width, height = text.box
    half = complex(width, height) / 2
    rays: dict[int, tuple[complex, complex]] = {}  #: where each starts, and its way
    beyond = [0.0] * _RAYS  #: where a label may lie on each ray again, beyond what is in its way
    tried: dict[int, tuple[complex, float]] = {}  #: the centre of each place, and its white
    # A label is in sight of what it names; failing that, a leader may pass over a bar.
    for in_sight in (True, False):
        results: dict[int, Label] = {}  #: the best places where it may be mistaken, by how
        for position in wish.places():
            if position.step > _FAR and (1 in results or 2 in results):
                break
            if position.step < beyond[position.ray]:
                continue
            if position.number not in tried:
                if position.ray not in rays:
                    direction = wish.toward * position.way
                    rays[position.ray] = wish.center(position, half) - direction * position.step, direction
                center, direction = rays[position.ray]
                center += direction * position.step
                white = obstacles.white(center, half, direction, wish.inside)
                tried[position.number] = center, white
                if white <= 0:
                    beyond[position.ray] = position.step - white
                    continue
            center, white = tried[position.number]
            if white != position.clear:
                continue
            leader = _leader(wish, center, half)
            if (in_sight or leader is None) and obstacles.hides(wish.source, center):
                continue
            if leader is None or obstacles.leader_free(*leader):
                mistaken = rivals.mistaken(center, half, leader)
                if mistaken not in results:
                    results[mistaken] = Label(wish.label, text, center, width, height, leader)
                if not mistaken:
                    break
                # Farther on it is no better: a leader crosses the same line, and without one it leaves its
                # own first.
                if mistaken >= 2:
                    beyond[position.ray] = _LEADER - wish.start if leader is None else math.inf
        if results:
            return results[min(results)]
    return _outside(wish, text, obstacles)


def _leader(wish: LabelRequest, center: complex, half: complex) -> tuple[complex, complex] | None:
    """Return a thin line from the anchor to the box, when the label is far from its element."""
    if wish.along and distance(center, *wish.along) <= _support(half, wish.toward) + _LEADER:
        return None
    # An angle is named at its arc: its label may lie on any side of the corner.
    foot, start, near = (
        (wish.source, 0.0, _AT_ARC) if wish.rank == ANGLES else (wish.anchor, wish.start, _LEADER)
    )
    direction = (center - foot) / (abs(center - foot) or 1.0)
    if abs(center - foot) - _support(half, direction) <= start + near:
        return None
    edge = min(half.real / (abs(direction.real) or 1e-9), half.imag / (abs(direction.imag) or 1e-9))
    return foot + direction * start, center - direction * (edge + _APART)


def _outside(wish: LabelRequest, text: LabelText, obstacles: Obstacles) -> Label:
    """Return the label at a position beyond everything drawn, for want of a free one."""
    right = max([obstacles.right, *(label.corners[1].real for label in obstacles.labels)])
    width, height = text.box
    return Label(wish.label, text, complex(right + 2 + width / 2, wish.anchor.imag), width, height)
