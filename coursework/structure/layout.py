"""Layout of a mechanism's joints on paper: a plane picture in which bodies can be distinguished.

Lengths are free, so any places make a mechanism that closes. Places lie on whole millimetres of paper. They
are found by moving one joint after another to where the picture reads best: bodies long enough, few bars that
cross, no bar over a pin that is not its own. Nothing is left to chance: equal mechanisms have equal pictures.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import combinations
from typing import NamedTuple, TypeAlias

import numpy as np

from coursework.structure.joints import FRAME, JointGraph

BEYOND = 9.0  #: how far a guide goes on behind its block, mm
SUPPORT = 6.0  #: room for the hatched support of a pivot or a rail
_SPACING = 8  #: of the places tried first
_SWEEPS = 3  #: over all sites, at most
_STARTS = 4  #: pictures begun, of which the best is kept
_SHORT, _LONG, _GEAR = 17.0, 36.0, 13.0  #: of a bar between two joints; the last, of a cam or a wheel
_PINS_APART, _CLEAR = 15.0, 7.0  #: between two pins; between a pin and another body's bar


_Once: TypeAlias = list[tuple[np.ndarray, ...]]


@dataclass(frozen=True)
class SlidingPair:
    """A sliding pair: the body that is the guide, and the body that is the block."""

    guide: int
    block: int


def slides(graph: JointGraph, at: Sequence[complex] = ()) -> dict[int, SlidingPair]:
    """Return the sliding pairs of a mechanism. The frame guides; else the body with the most joints, so that
    blocks are small bodies.

    Parameters
    ----------
    graph
        Joint graph of the mechanism.
    at
        Positions of the joints, complex, mm on paper. With them, a body with a pivot where it slides is the
        block.

    Returns
    -------
    The pairs by index of their joint in the graph.
    """

    def rank(body: int, index: int) -> tuple[bool, bool, int, int]:
        pivoted = any(
            body in joint.bodies and k != index and abs(at[k] - at[index]) < 1e-6
            for k, joint in enumerate(graph.joints)
            if at
        )
        return body == FRAME, not pivoted, len(graph.joints_of(body)), body

    results = {}
    for index, joint in enumerate(graph.joints):
        if joint.kind == "prismatic":
            block, guide = sorted(joint.bodies, key=partial(rank, index=index))
            results[index] = SlidingPair(guide, block)
    return results


def sites(graph: JointGraph) -> list[int]:
    """Return the site of each joint. A block with one other pivot sits on that pivot; a pivot takes one
    block.

    Parameters
    ----------
    graph
        Joint graph of the mechanism.

    Returns
    -------
    Numbers from 0 without a gap, in the order of the graph's joints.
    """
    number = list(range(len(graph.joints)))
    occupied: set[int] = set()
    for index, slide in slides(graph).items():
        others = [k for k, j in enumerate(graph.joints) if slide.block in j.bodies and k != index]
        if len(others) != 1 or others[0] in occupied or graph.joints[others[0]].kind != "revolute":
            continue
        if slide.guide not in graph.joints[others[0]].bodies:
            number[index] = others[0]
            occupied.add(others[0])
    order = sorted(set(number))
    return [order.index(site) for site in number]


@lru_cache(maxsize=1024)
def places(graph: JointGraph) -> tuple[complex, ...]:
    """Return the position of each joint.

    Parameters
    ----------
    graph
        Joint graph of the mechanism.

    Returns
    -------
    Complex numbers in the order of the graph's joints, mm on paper, y up.
    """
    picture = _Picture(graph)
    pictures = picture.settled(picture.starts())
    result = pictures[int(np.argmin(picture.cost(pictures)))]
    return tuple(complex(result[site]) for site in picture.site)


class _Terms(NamedTuple):
    """Index arrays and weights of the sums in the cost of a picture."""

    sites: _Once  #: two sites
    apart: _Once  #: two lines that share no site
    near: _Once  #: a site and a line that does not end in it
    loose: _Once  #: a line with a loose end, and another line
    meeting: _Once  #: two lines, the site that they share, and the weight of their angle
    inside: _Once  #: a site, and the corners of a plate
    bars: _Once  #: the ends of a bar, its least and its greatest length, and the weight of what is above
    faced: _Once  #: the site of a contact, and one of each body's


class _Picture:
    """Arrays of the lines and points that are drawn of a mechanism.

    A line goes from a site to a site and ``beyond`` it, or has a fixed direction from its site (supports,
    rails).
    """

    def __init__(self, graph: JointGraph):
        self.graph = graph
        self.site = sites(graph)
        self.count = max(self.site) + 1
        size = min(3, max(0, (self.count - 3) // 3))
        self.box = ((56, 40), (72, 48), (88, 56), (96, 64))[size]
        self._lines: list[tuple[int, int, int, complex, complex, float]] = []
        self._shortest: list[tuple[int, int, float, float]] = []
        self._plates: list[tuple[int, tuple[int, int, int]]] = []
        self._contacts: list[tuple[int, int, int]] = []
        for body in graph.bodies:
            self._add_frame() if body == FRAME else self._add_body(body)
        self._add_contacts()
        self._pair_up()

    def _sites_of(self, body: int) -> list[int]:
        return sorted({self.site[k] for k, j in enumerate(self.graph.joints) if body in j.bodies})

    def _add_frame(self) -> None:
        for index, joint in enumerate(self.graph.joints):
            if FRAME in joint.bodies:
                here = self.site[index]
                if joint.kind == "prismatic":
                    self._lines.append((FRAME, here, here, -9 - 2j, 9 - 2j, 0.0))
                else:
                    self._lines.append((FRAME, here, here, 0j, -1j * SUPPORT, 0.0))

    def _add_body(self, body: int) -> None:
        corners = self._sites_of(body)
        guided = {self.site[k] for k, slide in slides(self.graph).items() if slide.guide == body}
        kinds = [j.kind for j in self.graph.joints_of(body)]
        wheel = sorted(kinds) == ["higher", "revolute"]
        for p, q in combinations(corners, 2):
            if p in guided:
                p, q = q, p
            long = q in guided and len(corners) == 2
            self._lines.append((body, p, q, 0j, 0j, BEYOND if long else 0.0))
            self._shortest.append((p, q, _GEAR, _GEAR) if wheel else (p, q, _SHORT + 4 * long, _LONG))
        self._plates += [(body, three) for three in combinations(corners, 3)]

    def _add_contacts(self) -> None:
        """Add each contact with its two bodies, which must approach it from opposite sides."""
        for index, joint in enumerate(self.graph.joints):
            if joint.kind == "higher" and FRAME not in joint.bodies:
                first, other = (set(self._sites_of(b)) - {self.site[index]} for b in joint.bodies)
                self._contacts += [(self.site[index], p, q) for p in first for q in other if p != q]

    def _pair_up(self) -> None:
        """Collect the pairs of lines and sites whose distance or angle counts, as index arrays."""
        lines = self._lines
        self._owner, self._p, self._q = (np.array([line[k] for line in lines]) for k in range(3))
        self._a, self._b = (np.array([line[k] for line in lines]) for k in (3, 4))
        self._beyond = np.array([line[5] for line in lines])
        ends = [{line[1], line[2]} for line in lines]
        apart, meeting = [], []
        for e, f in combinations(range(len(lines)), 2):
            shared = ends[e] & ends[f]
            if not shared and lines[e][0] != lines[f][0]:
                apart.append((e, f))
            elif len(shared) == 1:
                meeting.append((e, f, shared.pop(), 1.0 if lines[e][0] != lines[f][0] else 0.6))
        self._apart = _columns(apart, 2)
        self._meeting = _columns([m[:3] for m in meeting], 3)
        self._weight = np.array([m[3] for m in meeting])
        self._sites = _columns(list(combinations(range(self.count), 2)), 2)
        loose = [k for k, line in enumerate(lines) if line[5] or line[1] == line[2]]
        self._near = _columns(
            [(s, e) for s in range(self.count) for e in range(len(lines)) if s not in ends[e]], 2
        )
        self._loose = _columns([(k, e) for k in loose for e in range(len(lines)) if not ends[k] & ends[e]], 2)
        inside = [(s, *three) for _, three in self._plates for s in range(self.count) if s not in three]
        self._inside = _columns(inside, 4)
        self._bars = _columns([s[:2] for s in self._shortest], 2)
        least, most = (np.array([s[k] for s in self._shortest]) for k in (2, 3))
        self._lengths = least, most, np.where(most == _GEAR, 0.2, 0.02)
        self._faced = _columns(self._contacts, 3)
        grounded = {self.site[k] for k, j in enumerate(self.graph.joints) if FRAME in j.bodies}
        self._grounded = np.array([s in grounded for s in range(self.count)])
        self._terms: dict[int | None, _Terms] = {}

    # ---------------------------------------------------------------- cost

    def cost(self, z: np.ndarray, moved: int | None = None) -> np.ndarray:
        """Return the cost of each picture (row of sites), low for a clear one; with ``moved``, only the terms
        of that site."""
        of = self._changed(moved)
        start, end = self._ends(z)
        total = 0.12 * np.where(self._grounded, z.imag, 0.25 * abs(z.imag - self.box[1] * 0.6)).sum(axis=1)
        for s, t in of.sites:
            total += (_short(abs(z[:, s] - z[:, t]), _PINS_APART) ** 2 * 0.5).sum(axis=1)
        for e, f in of.apart:
            total += 9.0 * _cross(start[:, e], end[:, e], start[:, f], end[:, f]).sum(axis=1)
        for s, e in of.near:
            gap = _distance(z[:, s], start[:, e], end[:, e])
            total += (0.35 * _short(gap, _CLEAR) ** 2).sum(axis=1)
        for k, e in of.loose:
            gap = _distance(end[:, k], start[:, e], end[:, e])
            total += (0.3 * _short(gap, 5.0) ** 2).sum(axis=1)
        for e, f, s, weight in of.meeting:
            total += (self._angle(start, end, e, f, s) * weight).sum(axis=1)
        for s, p, q, r in of.inside:
            total += 12.0 * _within(z[:, s], z[:, p], z[:, q], z[:, r]).sum(axis=1)
        for p, q, least, most, weight in of.bars:
            length = abs(z[:, p] - z[:, q])
            total += (_short(length, least) ** 2 * 0.15).sum(axis=1)
            total += (_short(most, length) ** 2 * weight + 0.02 * length).sum(axis=1)
        for c, p, q in of.faced:
            cosine = _cosine(z[:, p] - z[:, c], z[:, q] - z[:, c])
            total += 8.0 * _short(cosine, -0.75, below=False).sum(axis=1)
        return np.round(total, 6)

    def _changed(self, moved: int | None) -> _Terms:
        """Return the terms that a moved site changes; all terms for None."""
        if moved not in self._terms:
            sites = np.ones(self.count, bool) if moved is None else np.arange(self.count) == moved
            lines = sites[self._p] | sites[self._q]
            self._terms[moved] = _Terms(
                sites=_those(self._sites, sites, sites),
                apart=_those(self._apart, lines, lines),
                near=_those(self._near, sites, lines),
                loose=_those(self._loose, lines, lines),
                meeting=_those(self._meeting, lines, lines, also=(self._weight,)),
                inside=_those(self._inside, sites, sites, sites, sites),
                bars=_those(self._bars, sites, sites, also=self._lengths),
                faced=_those(self._faced, sites, sites, sites),
            )
        return self._terms[moved]

    def _ends(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        p, q = z[:, self._p], z[:, self._q]
        direction = (q - p) / np.maximum(abs(q - p), 1e-9)
        return p + self._a, q + self._b + self._beyond * direction

    def _angle(
        self, start: np.ndarray, end: np.ndarray, e: np.ndarray, f: np.ndarray, s: np.ndarray
    ) -> np.ndarray:
        """Return the cost of the angles between lines at a common site: too sharp, or in one line."""
        cosine = _cosine(self._leaving(start, end, e, s), self._leaving(start, end, f, s))
        sharp = 14.0 * _short(cosine, 0.85, below=False) + 3.0 * _short(cosine, 0.5, below=False)
        return sharp + 6.0 * _short(-cosine, 0.95, below=False)

    def _leaving(self, start: np.ndarray, end: np.ndarray, line: np.ndarray, site: np.ndarray) -> np.ndarray:
        direction = end[:, line] - start[:, line]
        return np.where(self._p[line] == site, direction, -direction)

    # ---------------------------------------------------------------- search

    def starts(self) -> np.ndarray:
        """Return starting pictures: grounded sites in a row below, the others higher the farther they are
        from the frame."""
        depth = self._depths()
        results = []
        for variant in range(_STARTS):
            z = np.zeros(self.count, complex)
            for level in range(max(depth) + 1):
                row = [s for s in range(self.count) if depth[s] == level]
                row = row[::-1] if variant % 2 else row
                turned = variant // 2 % len(row)
                row = row[turned:] + row[:turned]
                for k, s in enumerate(row):
                    across = self.box[0] * (k + 0.5 + 0.11 * level) / (len(row) + 0.3 * level)
                    z[s] = complex(round(across), round(min(self.box[1], 18.0 * level)))
            results.append(z)
        return np.array(results)

    def _depths(self) -> list[int]:
        depth = [0 if self._grounded[s] else -1 for s in range(self.count)]
        waiting = deque(s for s in range(self.count) if not depth[s])
        while waiting:
            s = waiting.popleft()
            for body in self.graph.moving:
                corners = self._sites_of(body)
                for t in corners if s in corners else ():
                    if depth[t] < 0:
                        depth[t] = depth[s] + 1
                        waiting.append(t)
        return depth

    def settled(self, z: np.ndarray) -> np.ndarray:
        """Move every site of each picture in turn to its best position, over the whole sheet first, then
        nearby; return the pictures."""
        wide, high = self.box
        sheet = np.array(
            [
                complex(x + (_SPACING // 2) * (y // _SPACING % 2), y)
                for y in range(0, high + 1, _SPACING)
                for x in range(0, wide + 1, _SPACING)
            ]
        )
        about = np.array([complex(x, y) for x in (-5, -2, -1, 0, 1, 2, 5) for y in (-5, -2, -1, 0, 1, 2, 5)])
        z = self._swept(z, lambda here: np.hstack([np.broadcast_to(sheet, (len(here), len(sheet))), here]))
        return self._swept(z, lambda here: here + about)

    def _swept(self, z: np.ndarray, tried: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        """Move the sites in turn until none moves; return the pictures. ``tried`` gives the candidates of a
        column of positions."""
        z, moving = z.copy(), np.arange(len(z))
        for _ in range(_SWEEPS):
            before = z[moving]
            for site in range(self.count):
                candidates = tried(z[moving, site, None])
                pictures = np.repeat(z[moving, None, :], candidates.shape[1], axis=1)
                pictures[:, :, site] = candidates
                cost = self.cost(pictures.reshape(-1, self.count), site).reshape(candidates.shape)
                z[moving, site] = np.take_along_axis(candidates, cost.argmin(axis=1)[:, None], axis=1)[:, 0]
            moving = moving[(z[moving] != before).any(axis=1)]
            if not len(moving):
                break
        return z


def _columns(rows: Sequence[Sequence[int]], width: int) -> np.ndarray:
    return np.array(rows, int).reshape(-1, width)


def _those(rows: np.ndarray, *touched: np.ndarray, also: Sequence[np.ndarray] = ()) -> _Once:
    """Return the columns of the rows with a touched entry, and the arrays ``also`` for them; nothing if there
    is none."""
    selection = np.zeros(len(rows), bool)
    for column, mask in enumerate(touched):
        selection |= mask[rows[:, column]]
    return [(*rows[selection].T, *(values[selection] for values in also))] if selection.any() else []


def _short(value: np.ndarray, least: np.ndarray | float, *, below: bool = True) -> np.ndarray:
    """Return the amount by which a value falls short of a bound, or exceeds it."""
    return np.maximum(0.0, least - value if below else value - least)


def _cosine(first: np.ndarray, other: np.ndarray) -> np.ndarray:
    return (first * other.conj()).real / np.maximum(abs(first) * abs(other), 1e-9)


def _side(a: np.ndarray, b: np.ndarray, z: np.ndarray) -> np.ndarray:
    return ((b - a).conj() * (z - a)).imag


def _cross(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    return (_side(a, b, c) * _side(a, b, d) <= 0) & (_side(c, d, a) * _side(c, d, b) <= 0)


def _distance(z: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the distances from points to segments."""
    direction = b - a
    along = ((z - a) * direction.conj()).real / np.maximum(abs(direction) ** 2, 1e-9)
    return abs(z - a - np.clip(along, 0.0, 1.0) * direction)


def _within(z: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    turns = (_side(a, b, z) > 0, _side(b, c, z) > 0, _side(c, a, z) > 0)
    return (turns[0] == turns[1]) & (turns[1] == turns[2])
