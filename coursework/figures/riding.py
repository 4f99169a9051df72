"""Labels of a moving figure: each moves with its element, and avoids lines and other labels.

Every label has a fixed list of positions about its element. At each instant a position costs what it covers;
a change of position costs too. The cheapest path through the whole cycle is found at once.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from coursework.figures.ink import ANGLES, NAMES, turn
from coursework.figures.placing import LabelRequest
from coursework.figures.text import read

_ON_LINE = 6.0  #: what it costs to lie on a line, in mm away from the best place
_ON_LABEL = 12.0  #: the same on another label
_TURN = 0.25  #: what it costs to lie a sixteenth of a turn from the preferred direction, mm
_START, _FARTHER = 0.5, 0.25  #: what it costs to leave a place, and each mm of the way to another
_STEPS = (0.0, 1.0, 2.2, 4.0, 6.0)
_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)
_WHITE = 0.2  #: white asked for round a label, mm
_AT_ONCE = 20_000  #: boxes and segments that are compared at once: more would leave the processor's cache
_LOOKED_AT = 216  #: instants at which places are compared; between them labels go steadily

Segments = tuple[np.ndarray, np.ndarray]


def ride(rows: Sequence[Sequence[LabelRequest]], segments: Segments, closed: bool) -> list[np.ndarray]:
    """Return the centres of the labels at every instant, mm on paper.

    ``rows`` has for each label its wish at every instant; ``segments`` the ends of everything drawn, a row an
    instant. ``closed``: the last instant is followed by the first.
    """
    count = len(segments[0])
    looked_at = np.unique(np.linspace(0, count, min(count, _LOOKED_AT), endpoint=False).astype(int))
    near = tuple(z[looked_at] for z in segments)
    results: dict[int, tuple[np.ndarray, np.ndarray]] = {}
    for index in sorted(range(len(rows)), key=lambda i: rows[i][0].rank):
        box = read(rows[index][0].label).box
        half = np.array(box) / 2
        costs, centres = zip(*_places(rows[index], half), strict=True)
        places = np.array(centres)
        seen = places[:, looked_at]
        price = np.array(costs)[:, None] + _ON_LINE * _on_line(near, seen, half + _WHITE)
        for other, size in results.values():
            gap = seen - other[looked_at]
            wide, tall = half + size + 2 * _WHITE
            price = price + _ON_LABEL * ((abs(gap.real) < wide) & (abs(gap.imag) < tall))
        chosen = _cheapest(price, seen, closed)
        results[index] = _along(places, chosen, looked_at, closed), half
    return [results[index][0] for index in range(len(rows))]


def _places(wishes: Sequence[LabelRequest], half: np.ndarray) -> Iterator[tuple[float, np.ndarray]]:
    """Yield the candidate positions of a label: a cost, and its centre at every instant."""
    anchor = np.array([wish.anchor for wish in wishes])
    start = np.array([wish.start for wish in wishes])

    def beyond(direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return direction, direction * (start + half[0] * abs(direction.real) + half[1] * abs(direction.imag))

    first = wishes[0]
    if first.along:
        p, q = np.array([wish.along for wish in wishes]).T
        length = abs(q - p)
        normal = 1j * (q - p) / np.where(length > 0, length, 1.0)
        for side in (1, -1):
            way, off = beyond(side * normal)
            for share in _SHARES:
                foot = p + share * (q - p) + off
                for step in _STEPS:
                    yield step + 4 * abs(share - 0.5), foot + step * way
        return
    # An angle's label keeps to its bisector; the others keep their direction on the paper.
    aim = np.array([w.toward for w in wishes]) if first.rank == ANGLES else np.full(len(wishes), first.toward)
    late = _TURN if first.rank == NAMES else 2 * _TURN
    for sixteenth in range(16):
        way, off = beyond(aim * turn(22.5 * sixteenth))
        for step in _STEPS:
            yield step + late * min(sixteenth, 16 - sixteenth), anchor + off + step * way


def _on_line(segments: Segments, centres: np.ndarray, half: np.ndarray) -> np.ndarray:
    """Return whether a box of these half-sides meets a segment: one row a position, one column an instant."""
    a, b = segments
    middle, d = (a + b) / 2, (b - a) / 2
    across, up = half[0] + abs(d.real), half[1] + abs(d.imag)
    extent = half[0] * abs(d.imag) + half[1] * abs(d.real)
    met = np.zeros(centres.shape, dtype=bool)
    together = max(1, _AT_ONCE // middle.size)
    for index in range(0, len(centres), together):
        gap = middle - centres[index : index + together, :, None]
        hit = (abs(gap.real) < across) & (abs(gap.imag) < up)
        hit &= abs(gap.real * d.imag - gap.imag * d.real) < extent
        met[index : index + together] = hit.any(axis=-1)
    return met


def _cheapest(price: np.ndarray, centres: np.ndarray, closed: bool) -> np.ndarray:
    """Return the position at each instant on the cheapest path through all instants; a closed path ends where
    it began."""
    count = price.shape[1]
    # A cycle is gone through three times; in the middle one nothing is left of where it began and ends.
    order = np.tile(np.arange(count), 3 if closed else 1)
    # Rounded, so that no machine's last digit decides between two places as good as each other.
    seen = centres.T
    moves = np.round(_START + _FARTHER * abs(seen[:, :, None] - seen[:, None, :]), 6)
    moves[:, range(len(price)), range(len(price))] = 0.0
    price = np.round(price, 6)
    total, origins = price[:, 0], []
    for instant in order[1:]:
        paths = total[None, :] + moves[instant]
        origin = paths.argmin(axis=1)
        origins.append(origin)
        total = np.round(paths[range(len(price)), origin] + price[:, instant], 6)
    direction = [int(total.argmin())]
    for origin in reversed(origins):
        direction.append(int(origin[direction[-1]]))
    result = np.array(direction[::-1])
    return result[count : 2 * count] if closed else result


def _along(places: np.ndarray, chosen: np.ndarray, looked_at: np.ndarray, closed: bool) -> np.ndarray:
    """Return the centres at all instants: at the chosen positions where they were compared, interpolated
    between."""
    count = places.shape[1]
    centres = np.empty(count, dtype=complex)
    stops = [*looked_at, count]
    after = [*chosen[1:], chosen[0] if closed else chosen[-1]]
    for start, end, first, other in zip(stops, stops[1:], chosen, after, strict=False):
        instants = np.arange(start, end)
        share = (instants - start) / (end - start)
        centres[instants] = (1 - share) * places[first, instants] + share * places[other, instants]
    return centres
