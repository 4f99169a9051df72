"""Joints in space drawn in perspective: their points, their directions, the bodies between them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any, TypeAlias

from coursework.figures import Element, Figure, line, point, vector
from coursework.figures.ink import added

Place: TypeAlias = Sequence[float]  #: x, y and z, mm

#: Where a mm towards the reader, along x, is seen; y goes to the right and z up. Points whose coordinates are
#: multiples of 20 mm up to 40 mm are seen 8 mm apart at least.
_FORWARD = complex(-0.4, -0.21)
_SEEN = {"x": _FORWARD, "y": 1 + 0j, "z": 1j}
_SCALE = 0.75  #: at most
_ARM = 4.5  #: of an axis to each side of its point, mm on paper
_BASE, _CORNER = 9.0, complex(-20, 0)  #: the base, and where it stands from the lower left, mm on paper


def _seen(place: Place) -> complex:
    return added(c * _SEEN[letter] for c, letter in zip(place, "xyz", strict=True))


def _steps(place: Place) -> list[tuple[complex, complex]]:
    """From the origin to a point along y, then x, then z: the lines that are not nothing."""
    x, y, z = place
    corners = [_seen(p) for p in dict.fromkeys([(0, 0, 0), (0, y, 0), (x, y, 0), (x, y, z)])]
    return list(pairwise(corners))


def in_perspective(
    rows: Sequence[Mapping[str, Any]], bodies: Iterable[tuple[int, int, int]] = (), *, tall: float = 36.0
) -> Figure:
    """The joints of a statement's table (see ``table``). ``bodies`` are (number, first joint, second joint) of those
    drawn as a line between two points; ``tall`` is what the points may take of the paper upwards, mm. A point of
    several joints carries all their names."""
    places = [tuple(row["point"]) for row in rows]
    steps = list(dict.fromkeys(step for place in places for step in _steps(place)))
    ends = [end for step in steps for end in step] or [0j]
    left, low, high = min(z.real for z in ends), min(z.imag for z in ends), max(z.imag for z in ends)
    scale = min(_SCALE, tall / (high - low or 1.0))
    corner = complex(left, low) + _CORNER / scale
    elements: list[Element] = [
        vector(corner, _BASE / scale * way, rf"\vec{{{letter}}}") for letter, way in _SEEN.items()
    ]
    elements += [line(p, q, dashed=True) for p, q in steps]
    for number, first, second in bodies:
        p, q = _seen(places[first - 1]), _seen(places[second - 1])
        elements += [line(p, q, label=f"S_{number}")] if p != q else []
    for row, place in zip(rows, places, strict=True):
        if row["joint"] != "spherical":
            way = _SEEN[row["along"]]
            arm = _ARM / scale * way / abs(way) ** 0.3  # seen shorter where it is foreshortened, yet seen
            elements.append(line(_seen(place) - arm, _seen(place) + arm, thin=False))
    for place in dict.fromkeys(places):
        names = [f"A_{k}" for k, other in enumerate(places, start=1) if other == place]
        elements.append(point(_seen(place), "=".join(names)))
    return Figure(*dict.fromkeys(elements), scale=scale)
