"""Where a mechanism is hard to compute: found from its formulas, typed by nobody.

Digits are lost where something that a formula needs vanishes: the determinant of the loops' Jacobian, a number that is
divided by, the distance whose direction is asked, what a root is taken of, what an arcsine lacks to 1. A tape notes all
of these *margins* while the formulas run on arrays (:mod:`coursework.accuracy.followed`); their zeros are sought along
each given quantity, and their double zeros, where two solutions meet and part again, in planes of two.

Sought is over the ranges of the exercise, as a request may mix them: a length may be as long as any other of the
mechanism, an angle is free, and no condition of a good variant holds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from coursework.accuracy.closure import Closure
from coursework.accuracy.followed import Followed, NotFollowed, of_arrays
from coursework.course import draws
from coursework.course.exercise import CourseExercise
from coursework.errors import CourseworkError

DISTANCES = tuple(10.0**-k for k in range(1, 13))  #: from a place, in parts of the scale of what is moved
DETERMINANT, VANISHING, TURNS = "determinant", "vanishing", "turns"
_ANGLE = 100.0  #: degrees: the scale of an angle
_ALONG, _ACROSS = 241, 33  #: points along a line; lines in a plane
_BASES = 2  #: variants from which is sought
_SAME = 1e-7  #: of a scale: two zeros are one
_ZERO = 1e-11  #: of its usual size: a margin has vanished
_NEAR, _FAR = 1e-6, 1e-2  #: distances at which is asked what is lost
_LOST = 1e-13  #: relative: a place where no more is lost is none
_MOST = 8  #: places of an exercise

Margins = dict[tuple[str, str, int], np.ndarray]  #: by quantity, kind, and which of them


@dataclass(frozen=True)
class HardPlace:
    """Where digits are lost, and along what it is approached.

    ``given`` holds the place itself, where there may be no answer; ``moved`` is what comes near, and ``scale`` what its
    distance is counted in. ``kind`` and ``quantity`` say what vanishes there, in the formula of which quantity;
    ``double`` places are those where it vanishes without changing sign as ``moved`` passes: two solutions touch.
    ``lost`` is the largest relative error that a formula, or the last digit of the data, makes a millionth of the
    scale away.
    """

    given: Mapping[str, Any]
    moved: str
    scale: float
    kind: str
    quantity: str
    tuned: str = ""
    lost: float = 0.0
    seen: tuple[tuple[str, str], ...] = field(default=(), compare=False)

    @property
    def double(self) -> bool:
        return bool(self.tuned)

    def at(self, distance: float) -> dict[str, Any]:
        """The given values so far away, in parts of the scale; negative on the other side."""
        return {**self.given, self.moved: self.given[self.moved] + distance * self.scale}

    def approach(self, distances: Sequence[float] = DISTANCES) -> Iterator[dict[str, Any]]:
        """Both sides in turn, from far to near."""
        for distance in distances:
            yield self.at(distance)
            if not (self.kind == VANISHING or self.kind == TURNS):
                yield self.at(-distance)


def hard_places(exercise: CourseExercise, wanted: Sequence[str], most: int = _MOST) -> tuple[HardPlace, ...]:
    """The hard places of some quantities, those that lose most first.

    None where the formulas cannot be followed, beyond vanishing lengths.
    """
    terrain = Terrain(exercise, wanted)
    found = [*_turning_points(terrain), *_crossings(terrain), *_vanishing(terrain)]
    return tuple(_ranked(terrain, _merged(found))[:most])


class Terrain:
    """The margins of an exercise's formulas over what may be given."""

    def __init__(self, exercise: CourseExercise, wanted: Sequence[str]) -> None:
        self.exercise, self.wanted = exercise, tuple(wanted)
        self.graph = exercise.solution.graph.textbook
        self.effects = exercise.spec.effects
        used = self.graph._ancestors(self.wanted) | set(self.effects)
        for effect in self.effects:
            used |= self.graph._ancestors((effect,))
        self.names = tuple(n for n, s in exercise.spec.given.items() if n in used and not s.is_choice)
        loops = exercise.solution.loops
        vectors = [[link.vector for link in loop.links] for loop in loops.values()]
        inside = {n for loop in loops.values() for n in loop.names}
        self.unknowns = tuple(n for n in exercise.solution.graph.quantities if n in inside and n not in exercise.spec.given)
        square = bool(loops) and len(self.unknowns) == 2 * len(loops)
        self.closure = Closure(vectors, self.unknowns) if square else None

    # ------------------------------------------------------------------- ranges

    @cached_property
    def bases(self) -> list[dict[str, Any]]:
        """Whole sets of given values from which is sought: variants, and one with noughts where there may be any."""
        found = [self._whole(v.given) for v in self.exercise.variants(range(_BASES))]
        first = found[0]
        noughts = {n: 0.0 for n in self.names if self._may_be_nought(n) and first[n]}
        if noughts:
            found.append({**first, **noughts})
        return found

    def _whole(self, given: Mapping[str, Any]) -> dict[str, Any]:
        known = {**self.exercise.intake.defaults, **given}
        return {n: v for n, v in known.items() if n in self.exercise.quantity_names}

    def _may_be_nought(self, name: str) -> bool:
        spec = self.exercise.spec.given[name]
        low, high = self._drawn[name]
        return self.unit(name) == "mm" and not spec.nonzero and low < 0 < high

    def unit(self, name: str) -> str:
        return self.exercise.spec.given[name].unit

    @cached_property
    def _drawn(self) -> dict[str, tuple[float, float]]:
        """The least and the largest value that is drawn of each, conditions or not."""
        spec = self.exercise.spec
        words = np.concatenate(
            [draws._words(self.exercise.name, spec.version, s, 0, len(spec.given)) for s in range(32)]
        )
        values = draws.candidates(spec, words)
        return {n: (float(np.nanmin(values[n])), float(np.nanmax(values[n]))) for n in self.names}

    @cached_property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Where each is sought: lengths in the range of all lengths, angles over a turn, the rest as drawn."""
        lengths = [self._drawn[n] for n in self.names if self._is_length(n)]
        low = min((low for low, _ in lengths), default=1.0) / 2
        high = max((high for _, high in lengths), default=1.0) * 2
        found = {}
        for name, (least, largest) in self._drawn.items():
            if self._is_length(name):
                found[name] = (low, high)
            elif self.unit(name) == "mm":
                reach = max(high, abs(least), abs(largest))
                found[name] = (-reach, reach)
            elif self.unit(name) == "deg":
                # Off the quarters of the turn, so that what vanishes there changes sign between two points.
                found[name] = (-183.7, 176.3) if self._turns(name) else (min(least, 0.0), max(largest, 180.0))
            else:
                found[name] = (least, largest)
        return {n: r for n, r in found.items() if r[1] > r[0]}

    def _turns(self, name: str) -> bool:
        least, largest = self._drawn[name]
        driver = self.exercise.spec.driver
        return largest - least >= 180 or least < 0 or (driver is not None and name == driver.angle)

    def _is_length(self, name: str) -> bool:
        return self.unit(name) == "mm" and self._drawn[name][0] > 0

    @property
    def lengths(self) -> tuple[str, ...]:
        return tuple(n for n in self.names if self._is_length(n))

    @property
    def angles(self) -> tuple[str, ...]:
        """The driver's angle first."""
        driver = self.exercise.spec.driver
        names = [n for n in self.names if self.unit(n) == "deg" and n in self.ranges]
        return tuple(sorted(names, key=lambda n: driver is None or n != driver.angle))

    def scale(self, name: str, given: Mapping[str, Any]) -> float:
        """What a distance in one of the given quantities is counted in."""
        if self.unit(name) == "deg":
            return _ANGLE
        if self.unit(name) == "mm":
            return max((abs(given[n]) for n in self.names if self.unit(n) == "mm"), default=1.0)
        return abs(given[name]) or 1.0

    # ------------------------------------------------------------------ margins

    def margins(self, given: Mapping[str, Any]) -> Margins:
        """Every margin at each place of arrays of one shape."""
        notes: list[tuple[str, Any]] = []
        arithmetic = of_arrays(lambda kind, value: notes.append((kind, value)))
        found: Margins = {}
        shape = np.broadcast_shapes(*(np.shape(v) for v in given.values()))

        def observe(name: str, value: Any) -> Any:
            for i, (kind, margin) in enumerate(notes):
                if np.shape(margin) == shape and np.asarray(margin).dtype.kind in "fc":
                    own = np.asarray(margin)
                    found[name, kind, i] = own if own.dtype.kind == "f" else abs(own)
            notes.clear()
            return value

        wrapped = {
            n: Followed(np.broadcast_to(np.asarray(v, dtype=float), shape), arithmetic) if n in self.names else v
            for n, v in given.items()
        }
        values = {}
        for name in self.wanted:
            if name in values:
                continue
            try:
                values |= self._observed(observe).everything((name,), wrapped, self.effects, found=values)
            except (CourseworkError, NotFollowed, TypeError, ValueError):
                notes.clear()
        found |= self._determinant({**wrapped, **values}, shape)
        return found

    def _observed(self, observe: Any) -> Any:
        return self.graph.observed(observe)

    def _determinant(self, values: Mapping[str, Any], shape: tuple[int, ...]) -> Margins:
        """Of the loops' Jacobian, its columns made one long."""
        if self.closure is None:
            return {}
        try:
            plain = {n: _plain_radians(values[n], self._is_angle(n)) for n in self._loop_names}
        except KeyError:
            return {}
        rows = self.closure.jacobian(plain)
        count = len(rows)
        flat = np.broadcast_arrays(*[np.asarray(e, dtype=float) for row in rows for e in row], np.zeros(shape))[:-1]
        matrix = np.stack(flat, axis=-1).reshape(*shape, count, count)
        with np.errstate(all="ignore"):
            sizes = np.linalg.norm(matrix, axis=-2, keepdims=True)
            finite = np.isfinite(matrix).all(axis=(-1, -2)) & (sizes > 0).all(axis=(-1, -2))
            scaled = np.where(finite[..., None, None], matrix / np.where(sizes > 0, sizes, 1.0), np.eye(count))
            found = np.where(finite, np.linalg.det(scaled), np.nan)
        return {("loops", DETERMINANT, 0): found}

    @cached_property
    def _loop_names(self) -> tuple[str, ...]:
        return tuple({n for loop in self.exercise.solution.loops.values() for n in loop.names})

    def _is_angle(self, name: str) -> bool:
        return any(name in loop.angles for loop in self.exercise.solution.loops.values())

    @cached_property
    def usual(self) -> dict[tuple[str, str, int], float]:
        """The usual size of each margin."""
        rng = np.random.default_rng(1)
        count = 400
        found: dict[tuple[str, str, int], float] = {}
        for base in self.bases:
            given = {n: v if isinstance(v, str) else np.full(count, v) for n, v in base.items()}
            given |= {n: rng.uniform(low, high, count) for n, (low, high) in self.ranges.items()}
            for key, values in self.margins(given).items():
                sizes = abs(values[np.isfinite(values)])
                if sizes.size > 8 and np.ptp(sizes) > 0:
                    found[key] = max(found.get(key, 0.0), float(np.median(sizes)))
        return {key: size for key, size in found.items() if size > 0}

    def relative(self, given: Mapping[str, Any]) -> Margins:
        """The margins that vary, in parts of their usual size."""
        margins = self.margins(given)
        return {key: margins[key] / size for key, size in self.usual.items() if key in margins}


def _plain_radians(value: Any, is_angle: bool) -> Any:
    value = value.value if isinstance(value, Followed) else value
    return np.radians(value) if is_angle else value


# ------------------------------------------------------------------------ crossings


@dataclass(frozen=True)
class _Zero:
    given: Mapping[str, Any]
    moved: str
    key: tuple[str, str, int]
    scale: float
    tuned: str = ""
    others: tuple[tuple[str, str, int], ...] = ()


def _crossings(terrain: Terrain) -> list[_Zero]:
    """Where a margin changes its sign, or touches nought, along one given quantity."""
    found: list[_Zero] = []
    for base in terrain.bases:
        for name, (low, high) in terrain.ranges.items():
            at = np.linspace(low, high, _ALONG)
            margins = terrain.relative({**_arrays(base, _ALONG), name: at})
            brackets = [
                (key, at[i], at[i + 1])
                for key, m in margins.items()
                for i in np.flatnonzero(np.isfinite(m[:-1]) & np.isfinite(m[1:]) & (m[:-1] * m[1:] < 0))
            ]
            for key, zero in _bisected(terrain, base, name, brackets):
                found.append(_Zero({**base, name: zero}, name, key, terrain.scale(name, base)))
    return found


def _arrays(base: Mapping[str, Any], count: int) -> dict[str, Any]:
    return {n: v if isinstance(v, str) else np.full(count, float(v)) for n, v in base.items()}


def _bisected(
    terrain: Terrain, base: Mapping[str, Any], name: str, brackets: Sequence[tuple]
) -> Iterator[tuple[tuple[str, str, int], float]]:
    """The zeros of many margins at once; none where it has a pole."""
    if not brackets:
        return
    keys = [key for key, _, _ in brackets]
    low, high = (np.array([b[i] for b in brackets]) for i in (1, 2))
    count = len(brackets)
    fixed = _arrays(base, count)

    def values(at: np.ndarray) -> np.ndarray:
        margins = terrain.relative({**fixed, name: at})
        return np.array([margins[key][i] if key in margins else np.nan for i, key in enumerate(keys)])

    sign = np.sign(values(low))
    for _ in range(60):
        middle = (low + high) / 2
        same = np.sign(values(middle)) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    left = np.minimum(abs(values(low)), abs(values(high)))
    for key, zero, size in zip(keys, high, left, strict=True):
        if size < _ZERO:
            yield key, _short(float(zero), 1e-11 * max(terrain.scale(name, base), 1.0))


# ------------------------------------------------------------------ double zeros


def _turning_points(terrain: Terrain) -> list[_Zero]:
    """Where a margin vanishes and is least, or largest, along an angle: two solutions touch."""
    found: list[_Zero] = []
    for base in terrain.bases:
        for moved in terrain.angles[:2]:
            for tuned in terrain.ranges:
                if tuned != moved and terrain.unit(tuned) in ("mm", "deg"):
                    found += _touching(terrain, base, moved, tuned)
    return found


def _touching(terrain: Terrain, base: Mapping[str, Any], moved: str, tuned: str) -> Iterator[_Zero]:
    across = np.linspace(*terrain.ranges[tuned], _ACROSS)
    along = np.linspace(*terrain.ranges[moved], 91)
    y, x = (v.ravel() for v in np.meshgrid(across, along, indexing="ij"))
    margins = terrain.relative({**_arrays(base, y.size), tuned: y, moved: x})
    spots = []
    for key, values in margins.items():
        m = values.reshape(_ACROSS, -1)
        for i, j in _near_touch(m):
            spots.append((key, across[i], along[j]))
    steps = across[1] - across[0], along[1] - along[0]
    yield from _zoomed(terrain, base, moved, tuned, spots, steps)


def _near_touch(m: np.ndarray) -> list[tuple[int, int]]:
    """Places of a plane where an extremum along the rows is about to vanish, or vanishes, from row to row."""
    found = []
    with np.errstate(all="ignore"):
        for least in (True, False):
            own = m if least else -m
            filled = np.where(np.isfinite(own), own, np.inf)
            j = filled.argmin(axis=1)
            rows = np.arange(len(m))
            value = filled[rows, j]
            inside = np.isfinite(value) & (j > 0) & (j < m.shape[1] - 1)
            for i in range(len(m) - 1):
                if not (inside[i] and inside[i + 1]):
                    continue
                if value[i] * value[i + 1] < 0:
                    found.append((i, int(j[i])))
                elif i and inside[i - 1] and abs(value[i]) < 0.3 and abs(value[i]) <= min(abs(value[i - 1]), abs(value[i + 1])):
                    found.append((i, int(j[i])))
    return found


def _zoomed(
    terrain: Terrain, base: Mapping[str, Any], moved: str, tuned: str, spots: Sequence[tuple], steps: tuple[float, float]
) -> Iterator[_Zero]:
    """The spots as exactly as doubles tell them: the plane around each, finer and finer."""
    if not spots:
        return
    keys = [s[0] for s in spots]
    y, x = (np.array([s[i] for s in spots]) for i in (1, 2))
    wide, long = np.full(len(spots), 1.5 * steps[0]), np.full(len(spots), 2.0 * steps[1])
    levels, points = np.linspace(-1, 1, 9), np.linspace(-1, 1, 17)
    size = np.full(len(spots), np.inf)
    for _ in range(22):
        Y = (y[:, None, None] + wide[:, None, None] * levels[None, :, None]) + 0 * points
        X = (x[:, None, None] + long[:, None, None] * points[None, None, :]) + 0 * levels[:, None]
        margins = terrain.relative({**_arrays(base, Y.size), tuned: Y.ravel(), moved: X.ravel()})
        for s, key in enumerate(keys):
            if key not in margins:
                continue
            plane = margins[key].reshape(Y.shape)[s]
            row, column, size[s] = _best_extremum(plane)
            y[s] += wide[s] * levels[row]
            x[s] += long[s] * column
        wide, long = wide * 0.3, long * 0.45
    seen = set()
    for s, key in enumerate(keys):
        low, high = terrain.ranges[tuned]
        if not np.isfinite(size[s]) or not low <= y[s] <= high:
            continue
        given = _settled({**base, moved: _short(float(x[s]), 2e-5)}, terrain, key, tuned, float(y[s]))
        if given is not None and (at := (key, round(given[tuned], 5), round(given[moved], 4))) not in seen:
            seen.add(at)
            yield _Zero(given, moved, key, terrain.scale(moved, base), tuned)


def _settled(
    given: Mapping[str, Any], terrain: Terrain, key: tuple[str, str, int], tuned: str, found: float
) -> dict[str, Any] | None:
    """The place with what is tuned as a short decimal where that makes the margin vanish, or as it was found; None
    where it does not vanish."""
    tried = dict.fromkeys((_short(found, 1e-5 * max(abs(found), 1.0)), found))
    at = {**_arrays(given, len(tried)), tuned: np.array(list(tried))}
    left = terrain.relative(at).get(key, np.full(len(tried), np.nan))
    for value, size in zip(tried, left, strict=True):
        if abs(size) < _ZERO:
            return {**given, tuned: value}
    return None


def _short(value: float, apart: float) -> float:
    """A value that is known no better than this: the shortest decimal nearby, of at most six places."""
    for places in range(7):
        if abs(round(value, places) - value) <= apart:
            return round(value, places) + 0.0
    return value


def _best_extremum(plane: np.ndarray) -> tuple[int, float, float]:
    """The row whose extremum along it is nearest to nought, where that is, and its size."""
    best = (plane.shape[0] // 2, 0.0, np.inf)
    for row, values in enumerate(plane):
        if not np.isfinite(values).all():
            continue
        for own in (values, -values):
            j = int(own.argmin())
            if 0 < j < len(own) - 1:
                a, b, c = own[j - 1], own[j], own[j + 1]
                bend = a - 2 * b + c
                shift = 0.5 * (a - c) / bend if bend > 0 else 0.0
                low = b - 0.125 * (a - c) ** 2 / bend if bend > 0 else b
                if abs(low) < best[2]:
                    best = (row, (j + shift) * 2 / (len(own) - 1) - 1, abs(low))
    return best


# ---------------------------------------------------------------------- other places


def _vanishing(terrain: Terrain) -> list[_Zero]:
    """A length as small as one likes beside the others."""
    base = terrain.bases[0]
    return [
        _Zero({**base, name: 0.0}, name, (name, VANISHING, 0), float(base[name])) for name in terrain.lengths
    ]


def _merged(found: Sequence[_Zero]) -> list[HardPlace]:
    """One place for all that vanishes there; for one sort of place, what is found first."""
    by_place: dict[Any, list[_Zero]] = {}
    for zero in found:
        where = tuple(v if isinstance(v, str) else round(v / _SAME / max(abs(v), 1.0)) for v in zero.given.values())
        by_place.setdefault((zero.moved, where), []).append(zero)
    places, sorts = [], set()
    for (moved, _), zeros in by_place.items():
        first = zeros[0]
        seen = tuple(dict.fromkeys(z.key[:2] for z in zeros))
        sort = (moved, next((z.tuned for z in zeros if z.tuned), ""), frozenset(z.key for z in zeros))
        if sort in sorts:
            continue
        sorts.add(sort)
        kind, quantity = first.key[1], first.key[0]
        places.append(HardPlace(first.given, moved, first.scale, kind, quantity, sort[1], seen=seen))
    return places


def _ranked(terrain: Terrain, places: Sequence[HardPlace]) -> list[HardPlace]:
    """With what each loses, most first."""
    from dataclasses import replace

    weighed = [replace(p, lost=_lost(terrain, p)) for p in places]
    return sorted((p for p in weighed if p.lost > _LOST), key=lambda p: -p.lost)


def _lost(terrain: Terrain, place: HardPlace) -> float:
    """What the textbook formula, or the last digit of a datum, changes beside a place, relative."""
    sides = [_NEAR] if place.kind == VANISHING else [_NEAR, -_NEAR]
    worst = 0.0
    graph, textbook = terrain.exercise.solution.graph, terrain.graph
    eps = np.finfo(float).eps
    for side in sides:
        given = place.at(side)
        names = [n for n in terrain.names if given[n]]
        count = 1 + len(names)
        spread = _arrays(given, count)
        step = 1e-3 * _NEAR
        for i, name in enumerate(names):
            spread[name][i + 1] += step * terrain.scale(name, given)
        for wanted in terrain.wanted:
            try:
                stable = np.broadcast_to(graph.evaluate((wanted,), spread, terrain.effects)[wanted], (count,))
                formula = np.broadcast_to(textbook.evaluate((wanted,), spread, terrain.effects)[wanted], (count,))
            except (CourseworkError, TypeError, ValueError):
                continue
            if np.asarray(stable).dtype.kind not in "f" or not np.isfinite(stable[0]):
                continue
            size = abs(stable[0]) or 1.0
            whole = terrain.exercise.units.get(wanted) == "deg"
            apart = abs(formula[0] - stable[0])
            moves = abs(stable[1:] - stable[0])
            if whole:
                size = 57.3
                apart, moves = min(apart, abs(360 - apart)), np.minimum(moves, abs(360 - moves))
            moves = moves[np.isfinite(moves)]
            condition = float(moves.max(initial=0.0)) / step / size * eps
            worst = max(worst, condition, float(apart / size) if np.isfinite(apart) else 1.0)
    return worst

