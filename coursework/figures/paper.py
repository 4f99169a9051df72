"""Sheet on which elements draw themselves: it converts mechanism coordinates to paper coordinates."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Sequence

from coursework.figures.ink import (
    ANGLES,
    BLACK,
    EDGE,
    HEAD,
    INSIDE,
    LINES,
    MARKS,
    NAMES,
    SIDES,
    THIN,
    Arc,
    Ink,
    Path,
    turn,
)
from coursework.figures.placing import LabelRequest, distance
from coursework.language.numbers import rounded


class FigurePaper:
    """Paper coordinates in mm, y up, origin at the mechanism's origin.

    Points of the mechanism are rounded to 0.1 mm, and everything is built from the
    rounded points: bars and pins meet exactly, and the file is no finer than a ruler.
    Directions are rounded to a whole degree, as a protractor reads them.
    """

    def __init__(self, scale: float, bars: Iterable[tuple[complex, complex]], middle: complex) -> None:
        self.scale = scale
        self.ink: list[Ink] = []
        self.wishes: list[LabelRequest] = []
        self.middle = self.at(middle)
        self._bars = [(self.at(p), self.at(q)) for p, q in bars]

    def at(self, z: complex) -> complex:
        return complex(rounded(z.real * self.scale, 1), rounded(z.imag * self.scale, 1))

    def length(self, mm: float) -> float:
        return max(0.1, rounded(mm * self.scale, 1))

    def degrees(self, angle: float) -> float:
        return rounded(angle, 0)

    def draw(self, *ink: Ink) -> None:
        self.ink += ink

    def directions(self, p: complex) -> list[complex]:
        """Return the unit vectors of the bars that leave a paper point."""
        results = []
        for a, b in self._bars:
            if a == b:
                continue
            along = (b - a) / abs(b - a)
            across = ((p - a) * along.conjugate()).imag
            run = ((p - a) * along.conjugate()).real
            if abs(across) < 0.6 and -0.6 < run < abs(b - a) - 0.6:
                results.append(along)
            if abs(across) < 0.6 and 0.6 < run < abs(b - a) + 0.6:
                results.append(-along)
        return results

    def ground_side(self, p: complex) -> complex:
        """Return the direction of a pivot's support: below unless a bar leaves that way."""
        occupied = self.directions(p)

        def room(direction: complex) -> float:
            return min((abs(cmath.phase(t / direction)) for t in occupied), default=math.pi)

        ways = (-1j, 1j, -1 + 0j, 1 + 0j)
        return next(
            (direction for direction in ways if room(direction) > math.radians(50)), max(ways, key=room)
        )

    def room(self, p: complex) -> float:
        """Return the length on paper of the shortest bar that ends at a paper point."""
        return min((abs(b - a) for a, b in self._bars if p in (a, b)), default=math.inf)

    def around(
        self,
        label: str | None,
        p: complex,
        start: float,
        occupied: Sequence[complex] = (),
        toward: float | None = None,
        area: tuple[complex, ...] = (),
    ) -> None:
        """Request a label round a point: towards an angle if one is given, else in the widest gap between the
        bars at the point.

        ``area`` is the outline of the body that the label names.
        """
        if label:
            gap = _widest_gap([*self.directions(p), *occupied])
            direction = gap if toward is None else turn(toward)
            self.wishes.append(LabelRequest(label, p, direction, start, NAMES, area=area))

    def toward(
        self,
        label: str | None,
        p: complex,
        direction: complex,
        start: float,
        rank: int = ANGLES,
        area: tuple[complex, ...] = (),
    ) -> None:
        if label:
            self.wishes.append(
                LabelRequest(label, p, direction / (abs(direction) or 1.0), start, rank, area=area)
            )

    def inside(self, label: str, center: complex, height: float) -> None:
        """Request a label centred on a point of a hatched area."""
        # Starting half a height below, the first place tried is the point itself.
        self.wishes.append(LabelRequest(label, center, 1j, -height / 2, INSIDE, inside=True))

    def beside(
        self, label: str | None, p: complex, q: complex, start: float, direction: complex | None = None
    ) -> None:
        """Request a label beside a segment, by default on the outer side of the figure."""
        if not label:
            return
        if p == q:
            self.around(label, p, start)
            return
        normal = 1j * (q - p) / abs(q - p)
        outer = ((p + q) / 2 - self.middle) * normal.conjugate()
        # Above or to the left when the bar passes through the middle of the figure.
        rule = outer.real if abs(outer.real) > 1 else (normal.imag or -normal.real)
        direction = direction or (normal if rule >= 0 else -normal)
        self.wishes.append(LabelRequest(label, (p + q) / 2, direction, start, SIDES, (p, q)))

    def aside(self, p: complex, q: complex) -> float:
        """Return the distance to the left of p→q at which a dimension line meets no bar, outer side first."""
        normal = 1j * (q - p) / (abs(q - p) or 1.0)
        outer = 1 if (((p + q) / 2 - self.middle) * normal.conjugate()).real >= 0 else -1

        def free(gap: float) -> bool:
            feet = [p + (q - p) * k / 12 + normal * gap for k in range(13)]
            return all(distance(z, a, b) > 3.0 for z in feet for a, b in self._bars)

        gaps = [side * outer * mm for mm in (7.0, 9.0, 12.0, 16.0, 21.0, 27.0, 34.0) for side in (1, -1)]
        return next(filter(free, gaps), gaps[0])

    def head(self, tip: complex, direction: complex, size: float = HEAD) -> None:
        base = tip - direction * size
        wing = 0.23 * size * 1j * direction
        self.draw(Path((tip, base + wing, base - wing), 0, BLACK, closed=True, layer=MARKS))

    def arrow(self, p: complex, q: complex, width: float = EDGE, size: float = HEAD) -> None:
        if p == q:
            return
        direction = (q - p) / abs(q - p)
        size = min(size, 0.7 * abs(q - p))
        self.draw(Path((p, q - direction * size * 0.8), width, layer=MARKS))
        self.head(q, direction, size)

    def arc_arrow(self, center: complex, radius: float, start: float, end: float, size: float) -> None:
        """Draw an arc with a head at its end; no head on an arc too short for one."""
        if start == end:
            return
        spread = math.degrees(size / radius)
        sign = 1 if end >= start else -1
        if abs(end - start) < 1.3 * spread:
            self.draw(Arc(center, radius, start, end, THIN + 0.05, layer=MARKS))
            return
        self.draw(Arc(center, radius, start, end - sign * 0.8 * spread, THIN + 0.05, layer=MARKS))
        # The head lies along the chord of the arc it covers.
        self.head(center + radius * turn(end), sign * 1j * turn(end - sign * spread / 2), size)

    def hatch(self, p: complex, q: complex, side: complex, step: float = 1.3, depth: float = 1.3) -> None:
        """Draw ground hatching along a segment, on the side of the unit vector."""
        along = (q - p) / abs(q - p)
        count = max(2, round(abs(q - p) / step))
        for k in range(count):
            foot = p + along * abs(q - p) * (k + 0.75) / count
            self.draw(Path((foot, foot + depth * (side - along) * 0.8), THIN, layer=LINES))


def _widest_gap(ways: Sequence[complex]) -> complex:
    """Return the middle of the widest angle between the given directions; up and right when there are
    none."""
    if not ways:
        return turn(45)
    angles = sorted(math.degrees(cmath.phase(direction)) for direction in ways)
    gaps = [(b - a, a) for a, b in zip(angles, [*angles[1:], angles[0] + 360], strict=True)]
    width, start = max(gaps, key=lambda gap: round(gap[0], 6))
    return turn(start + width / 2)
