"""Hard places of a mechanism, where digits are lost, found from its formulas.

Digits are lost where something that a formula needs vanishes: the determinant of the loops' Jacobian, a
number that is divided by, the distance whose direction is asked, what a root is taken of, what an arcsine
lacks to 1. A tape notes all of these *margins* while the formulas run on arrays
(:mod:`coursework.accuracy.followed`); their zeros are sought along each given quantity, and their double
zeros, where two solutions meet and part again, in planes of two.

Sought is over the ranges of the exercise, as a request may mix them: a length may be as long as any other of
the mechanism, an angle is free, and no condition of a good variant holds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from typing import Any, TypeAlias

import numpy as np

from coursework.accuracy.closure import Closure
from coursework.accuracy.followed import Arithmetic, Followed, NotFollowed, of_arrays
from coursework.accuracy.reference import twinned
from coursework.course.exercise import CourseExercise
from coursework.errors import CourseworkError
from coursework.quantities.graph import Graph

DISTANCES = tuple(10.0**-k for k in range(1, 13))  #: from a place, in parts of the scale of what is moved
DETERMINANT, VANISHING, GROWING, TURNS = "determinant", "vanishing", "growing", "turns"
_ANGLE = 100.0  #: degrees: the scale of an angle
_ALONG = 241  #: points along a line
_ROWS, _COLUMNS = 33, 91  #: of a plane
_HALVINGS = 56
_ZOOMS = 24  #: of a plane about a double zero
_BASES = 2  #: variants from which is sought
_SAME = 1e-7  #: of a scale: two zeros are one
_ZERO = 1e-11  #: of its usual size: a margin has vanished
_NEAR = 1e-6  #: the distance at which is asked what is lost
_LOST = 1e-13  #: relative: a place where no more is lost is none
_OF_A_SORT = 2  #: places at which the same vanishes
_MOST = 8  #: places of an exercise

_SAMPLE = 400  #: random places on which margins are compared
_LOOPS = "loops"
#: Margins of one quantity, beyond which it follows a motion: of each kind the smallest counts.
_MOST_NOTED = 64

_Key: TypeAlias = tuple[str, str, int]  #: quantity, kind, and which of them
Margins = dict[_Key, np.ndarray]
_FAILURES = (CourseworkError, NotFollowed, TypeError, ValueError)


@dataclass(frozen=True)
class HardPlace:
    """Place where digits are lost, and the quantity along which it is approached.

    ``given`` holds the place itself, where there may be no answer; ``moved`` is what comes near, and
    ``scale`` what its distance is counted in. ``kind`` and ``quantity`` say what vanishes there, in the
    formula of which quantity; ``double`` places are those where it vanishes without changing sign as
    ``moved`` passes: two solutions touch. ``lost`` is the largest relative error that a formula, or the last
    digit of the data, makes a millionth of the scale away.
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

    def at(self, distance: float, aside: float = 0.0) -> dict[str, Any]:
        """Return the given values at a distance from the place, in parts of the scale; negative on the other
        side.

        A growing length is as many times the scale as the distance is parts of it. ``aside`` is the offset of
        the tuned quantity, in parts of its own value: there the solutions come near and pass.
        """
        near = (
            self.scale / distance if self.kind == GROWING else self.given[self.moved] + distance * self.scale
        )
        moved = {self.moved: near}
        tuned = {self.tuned: self.given[self.tuned] * (1 + aside)} if self.tuned else {}
        return {**self.given, **tuned, **moved}

    def approach(self, distances: Sequence[float] = DISTANCES) -> Iterator[dict[str, Any]]:
        """Yield the given values on both sides in turn, from far to near."""
        for distance in distances:
            for side in self.sides:
                yield self.at(side * distance)

    @staticmethod
    def distances(quick: bool) -> tuple[float, ...]:
        """Return the distances of the approach; every third one for a quick measurement."""
        return DISTANCES[1::3] if quick else DISTANCES

    @property
    def sides(self) -> tuple[int, ...]:
        """Sides from which the place can be approached: a vanishing quantity has one, and a growing one."""
        if self.kind == GROWING:
            return (1,)
        if self.kind != VANISHING:
            return (1, -1)
        return (1,) if not self.given[self.moved] else (-1,)


def hard_places(exercise: CourseExercise, wanted: Sequence[str], most: int = _MOST) -> tuple[HardPlace, ...]:
    """Return the hard places of some quantities, those with the largest loss first.

    None where the formulas cannot be followed, beyond vanishing and growing lengths.
    """
    terrain = Terrain(exercise, wanted)
    results = [*_turning_points(terrain), *_crossings(terrain), *_vanishing(terrain), *_growing(terrain)]
    return tuple(_ranked(terrain, _merged(terrain, results))[:most])


def growing_places(exercise: CourseExercise, wanted: Sequence[str]) -> tuple[HardPlace, ...]:
    """Return the places where a length outgrows the others."""
    terrain = Terrain(exercise, wanted)
    return tuple(_merged(terrain, _growing(terrain)))


class Terrain:
    """Margins of an exercise's formulas over the range of the given quantities."""

    def __init__(self, exercise: CourseExercise, wanted: Sequence[str]) -> None:
        self.exercise, self.wanted = exercise, tuple(wanted)
        self.graph = twinned(exercise.solution.graph.textbook)
        self.effects = exercise.spec.effects
        used = self.graph.ancestors((*self.wanted, *self.effects))
        self.names = tuple(n for n, s in exercise.spec.given.items() if n in used and not s.is_choice)
        loops = exercise.solution.loops
        vectors = [[link.vector for link in loop.links] for loop in loops.values()]
        inside = {n for loop in loops.values() for n in loop.names}
        self.unknowns = tuple(
            n for n in exercise.solution.graph.quantities if n in inside and n not in exercise.spec.given
        )
        square = bool(loops) and len(self.unknowns) == 2 * len(loops)
        self.closure = Closure(vectors, self.unknowns) if square else None

    # ------------------------------------------------------------------- ranges

    @cached_property
    def bases(self) -> list[dict[str, Any]]:
        """Complete sets of given values from which the search starts: variants, and one with zeros where they
        are allowed."""
        results = [self._complete(v.given) for v in self.exercise.variants(range(_BASES))]
        first = results[0]
        noughts = {n: 0.0 for n in self.names if self._may_be_nought(n) and first[n]}
        if noughts:
            results.append({**first, **noughts})
        return results

    def _complete(self, given: Mapping[str, Any]) -> dict[str, Any]:
        known_values = {**self.exercise.intake.defaults, **given}
        return {n: v for n, v in known_values.items() if n in self.exercise.quantity_names}

    def _may_be_nought(self, name: str) -> bool:
        spec = self.exercise.spec.given[name]
        low, high = self._drawn[name]
        return self.unit(name) != "deg" and not spec.nonzero and low < 0 < high

    def unit(self, name: str) -> str:
        return self.exercise.spec.given[name].unit

    @cached_property
    def _drawn(self) -> dict[str, tuple[float, float]]:
        """Least and largest drawn value of each quantity, without regard to constraints."""
        values = self.exercise.draws.first_candidates(512)
        return {n: (float(np.nanmin(values[n])), float(np.nanmax(values[n]))) for n in self.names}

    @cached_property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Search range of each quantity: for a size, that of all sizes of its unit; for an angle, a turn."""
        results = {}
        for name, (least, largest) in self._drawn.items():
            low, high = self._of_unit(self.unit(name))
            if self.unit(name) == "deg":
                # Off the quarters of the turn, so that what vanishes there changes sign between two points.
                results[name] = (
                    (-183.7, 176.3) if self.turns(name) else (min(least, 0.0), max(largest, 180.0))
                )
            elif self._is_size(name):
                results[name] = (low, high)
            else:
                reach = max(high, abs(least), abs(largest))
                results[name] = (-reach, reach) if least < 0 else (least, reach)
        return {n: r for n, r in results.items() if r[1] > r[0]}

    def _of_unit(self, unit: str) -> tuple[float, float]:
        """Return half the least and twice the largest of the sizes of a unit; (0, 0) where it has none."""
        sizes = [self._drawn[n] for n in self.names if self.unit(n) == unit and self._is_size(n)]
        return min((low for low, _ in sizes), default=0.0) / 2, max(
            (high for _, high in sizes), default=0.0
        ) * 2

    def turns(self, name: str) -> bool:
        """Return whether an angle may have any value, unlike an angle of a triangle."""
        least, largest = self._drawn[name]
        driver = self.exercise.spec.driver
        return largest - least >= 180 or least < 0 or (driver is not None and name == driver.angle)

    def _is_size(self, name: str) -> bool:
        """Return whether a quantity is always positive and no angle: a length, a mass."""
        return self.unit(name) != "deg" and self._drawn[name][0] > 0

    @property
    def sizes(self) -> tuple[str, ...]:
        """Quantities that may be far smaller, or far larger, than others of their unit."""
        selected = [n for n in self.names if self._is_size(n)]
        units = [self.unit(n) for n in selected]
        return tuple(n for n in selected if units.count(self.unit(n)) > 1)

    @property
    def angles(self) -> tuple[str, ...]:
        """Angles, the driver's first."""
        driver = self.exercise.spec.driver
        names = [n for n in self.names if self.unit(n) == "deg" and n in self.ranges]
        return tuple(sorted(names, key=lambda n: driver is None or n != driver.angle))

    def scale(self, name: str, given: Mapping[str, Any]) -> float:
        """Return the unit of distance along a given quantity."""
        if self.unit(name) == "deg":
            return _ANGLE
        return max(abs(given[n]) for n in self.names if self.unit(n) == self.unit(name)) or 1.0

    # ------------------------------------------------------------------ margins

    def margins(self, given: Mapping[str, Any], wanted: Sequence[str]) -> Margins:
        """Return every margin of the formulas of some quantities, at each place of arrays of one shape."""
        shape = np.broadcast_shapes(*(np.shape(v) for v in given.values()))
        self._notes.clear()
        results: Margins = {}
        self._margins = results
        wrapped = {n: self._followed(v, shape) if n in self.names else v for n, v in given.items()}
        try:
            values = self._watched.everything(tuple(wanted), wrapped, self.effects)
        except _FAILURES:
            values = self._one_by_one(wanted, wrapped)
        results = {key: m for key, m in results.items() if np.shape(m) == shape}
        results |= self._determinant({**wrapped, **values}, shape)
        return results

    def _followed(self, value: Any, shape: tuple[int, ...]) -> Followed:
        return Followed(np.broadcast_to(np.asarray(value, dtype=float), shape), self._arithmetic)

    def _one_by_one(self, wanted: Sequence[str], given: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values of those quantities whose formulas can be followed."""
        values: dict[str, Any] = {}
        for name in wanted:
            try:
                values |= self._watched.everything((name,), given, self.effects, found=values)
            except _FAILURES:
                self._notes.clear()
        return values

    @cached_property
    def _notes(self) -> list[tuple[str, Any]]:
        """Margins noted on the tape since the last complete quantity."""
        return []

    @cached_property
    def _arithmetic(self) -> Arithmetic:
        return of_arrays(lambda kind, value: self._notes.append((kind, value)))

    @cached_property
    def _watched(self) -> Graph:
        """Graph of formulas that record their margins."""

        def observe(name: str, value: Any) -> Any:
            noted = [(kind, np.asarray(margin)) for kind, margin in self._notes]
            noted = [(kind, values) for kind, values in noted if values.dtype.kind in "fc"]
            if len(noted) > _MOST_NOTED:
                kinds = dict.fromkeys(kind for kind, _ in noted)
                noted = [(k, reduce(np.fmin, (abs(v) for kind, v in noted if kind == k))) for k in kinds]
            for i, (kind, values) in enumerate(noted):
                self._margins[name, kind, i] = values if values.dtype.kind == "f" else abs(values)
            self._notes.clear()
            return value

        return self.graph.observed(observe)

    def _determinant(self, values: Mapping[str, Any], shape: tuple[int, ...]) -> Margins:
        """Return the determinant of the loops' Jacobian, with its columns normalised."""
        if self.closure is None:
            return {}
        try:
            plain = {n: _plain_radians(values[n], angle) for n, angle in self._loop_names.items()}
        except KeyError:
            return {}
        rows = self.closure.jacobian(plain)
        count = len(rows)
        flat = np.broadcast_arrays(
            *[np.asarray(e, dtype=float) for row in rows for e in row], np.zeros(shape)
        )[:-1]
        matrix = np.stack(flat, axis=-1).reshape(*shape, count, count)
        with np.errstate(all="ignore"):
            sizes = np.linalg.norm(matrix, axis=-2, keepdims=True)
            finite = np.isfinite(matrix).all(axis=(-1, -2)) & (sizes > 0).all(axis=(-1, -2))
            scaled = np.where(
                finite[..., None, None], matrix / np.where(sizes > 0, sizes, 1.0), np.eye(count)
            )
            result = np.where(finite, np.linalg.det(scaled), np.nan)
        return {(_LOOPS, DETERMINANT, 0): result}

    @cached_property
    def _loop_names(self) -> dict[str, bool]:
        """Names in the loops, each with True if it is an angle."""
        loops = self.exercise.solution.loops.values()
        return {n: n in loop.angles for loop in loops for n in loop.names}

    @cached_property
    def _sampled(self) -> Margins:
        """Margins at random places, anywhere and along single lines from the bases."""
        rng = np.random.default_rng(1)
        rows = []
        for base in self.bases:
            anywhere = {**_arrays(base, _SAMPLE)}
            anywhere |= {n: rng.uniform(low, high, _SAMPLE) for n, (low, high) in self.ranges.items()}
            rows.append(anywhere)
            for name, (low, high) in self.ranges.items():
                rows.append({**_arrays(base, _SAMPLE // 4), name: rng.uniform(low, high, _SAMPLE // 4)})
        choices = {n for n, v in self.bases[0].items() if isinstance(v, str)}
        given = {n: np.concatenate([row[n] for row in rows]) for n in self.bases[0] if n not in choices}
        return self.margins({**given, **{n: self.bases[0][n] for n in choices}}, self.wanted)

    @cached_property
    def usual(self) -> dict[_Key, float]:
        """Typical size of each margin that varies."""
        results = {}
        for key, values in self._sampled.items():
            sizes = abs(values[np.isfinite(values)])
            if (
                sizes.size > 8
                and np.ptp(sizes) > 1e-9 * sizes.max()
                and (size := float(np.median(sizes))) > 0
            ):
                results[key] = size
        return results

    def relative(self, given: Mapping[str, Any], only: str = "") -> Margins:
        """Return the varying margins in parts of their typical size, of one quantity ``only`` if it is named;
        of those that vanish together the first."""
        keys = [key for key in self.distinct if only in ("", key[0])]
        # The determinant of the loops takes the values of all.
        names = [name for name, _, _ in (self.distinct if only == _LOOPS else keys) if name != _LOOPS]
        margins = self.margins(given, tuple(dict.fromkeys(names)))
        return {key: margins[key] / self.usual[key] for key in keys if key in margins}

    @cached_property
    def distinct(self) -> tuple[_Key, ...]:
        """Margins whose zeros differ."""
        usual = {key: values for key, values in self._sampled.items() if key in self.usual}
        retained: dict[_Key, np.ndarray] = {}
        for key, values in usual.items():
            if not any(_vanish_together(values, other) for other in retained.values()):
                retained[key] = values
        return tuple(retained)


def _vanish_together(a: np.ndarray, b: np.ndarray) -> bool:
    """Return whether two margins have the same zeros, judged by random places."""
    both = np.isfinite(a) & np.isfinite(b)
    if both.sum() < 0.9 * max(np.isfinite(a).sum(), np.isfinite(b).sum()):
        return False
    a, b = a[both], b[both]
    crosses = (a < 0).any() and (a > 0).any()
    if crosses or ((b < 0).any() and (b > 0).any()):
        same = a * b > 0
        return bool(crosses and (same.all() or not same.any()))
    with np.errstate(all="ignore"):
        logs = np.log(abs(a)), np.log(abs(b))
    return bool(np.isfinite(logs).all() and np.corrcoef(*logs)[0, 1] > 0.9999)


def _plain_radians(value: Any, is_angle: bool) -> Any:
    value = value.value if isinstance(value, Followed) else value
    return np.radians(value) if is_angle else value


# ------------------------------------------------------------------------- spots


@dataclass(frozen=True)
class _Spot:
    """Zero of a margin, sought or found, as one given quantity moves and another is tuned."""

    given: Mapping[str, Any]
    moved: str
    key: _Key
    tuned: str = ""

    def put(self, **values: float) -> _Spot:
        return replace(self, given={**self.given, **{n: float(v) for n, v in values.items()}})


def _arrays(base: Mapping[str, Any], count: int) -> dict[str, Any]:
    return {n: v if isinstance(v, str) else np.full(count, float(v)) for n, v in base.items()}


def _alike(spots: Sequence[_Spot]) -> list[list[_Spot]]:
    """Group the spots that one call can compute: those of one quantity's margins with the same choices."""
    groups: dict[Any, list[_Spot]] = {}
    for spot in spots:
        choices = tuple(v for v in spot.given.values() if isinstance(v, str))
        groups.setdefault((spot.key[0], choices), []).append(spot)
    return list(groups.values())


def _together(spots: Sequence[_Spot], shape: tuple[int, ...] = ()) -> dict[str, Any]:
    """Return the given values of many spots as arrays, one row a spot."""
    results: dict[str, Any] = {}
    for name, value in spots[0].given.items():
        if isinstance(value, str):
            results[name] = value
        else:
            column = np.array([float(s.given[name]) for s in spots]).reshape(-1, *[1] * len(shape))
            results[name] = np.array(np.broadcast_to(column, (len(spots), *shape)))
    return results


def _own_margins(
    terrain: Terrain, spots: Sequence[_Spot], given: Mapping[str, Any], shape: tuple[int, ...]
) -> np.ndarray:
    """Return the margin of each spot, all of one quantity, at its own row of places."""
    flat = {n: v if isinstance(v, str) else v.ravel() for n, v in given.items()}
    margins = terrain.relative(flat, spots[0].key[0])
    none = np.full(shape, np.nan)
    full = {key: m.reshape(len(spots), *shape) for key, m in margins.items()}
    return np.stack([full[s.key][i] if s.key in full else none for i, s in enumerate(spots)])


# ------------------------------------------------------------------------ crossings


def _crossings(terrain: Terrain) -> list[_Spot]:
    """Return the spots where a margin changes sign along one given quantity."""
    brackets: list[tuple[_Spot, float, float]] = []
    for base in terrain.bases:
        for name, (low, high) in terrain.ranges.items():
            at = np.linspace(low, high, _ALONG)
            for key, m in terrain.relative({**_arrays(base, _ALONG), name: at}).items():
                turns = np.flatnonzero(np.isfinite(m[:-1]) & np.isfinite(m[1:]) & (m[:-1] * m[1:] < 0))
                brackets += [(_Spot(base, name, key), at[i], at[i + 1]) for i in turns[:4]]
    results: list[_Spot] = []
    for group in _alike([spot for spot, _, _ in brackets]):
        ends = {id(s): (low, high) for s, low, high in brackets}
        results += _bisected(terrain, group, *np.array([ends[id(s)] for s in group]).T)
    return results


def _bisected(terrain: Terrain, spots: Sequence[_Spot], low: np.ndarray, high: np.ndarray) -> Iterator[_Spot]:
    """Yield the spots at their zeros, without poles of a margin."""
    given = _together(spots)

    def values(at: np.ndarray) -> np.ndarray:
        for i, spot in enumerate(spots):
            given[spot.moved][i] = at[i]
        return _own_margins(terrain, spots, given, ())

    sign = np.sign(values(low))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        same = np.sign(values(middle)) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    left = np.minimum(abs(values(low)), abs(values(high)))
    for spot, zero, size in zip(spots, high, left, strict=True):
        if size < _ZERO:
            scale = terrain.scale(spot.moved, spot.given)
            yield spot.put(**{spot.moved: _short(float(zero), 1e-11 * max(scale, 1.0))})


# ------------------------------------------------------------------ double zeros


def _turning_points(terrain: Terrain) -> list[_Spot]:
    """Return the spots where a margin touches zero at an extremum along an angle: two solutions meet."""
    spots: list[_Spot] = []
    for base in terrain.bases:
        for moved in terrain.angles[:2]:
            for tuned in terrain.ranges:
                if tuned != moved:
                    spots += _touching(terrain, base, moved, tuned)
    return [zero for group in _alike(spots) for zero in _zoomed(terrain, group)]


def _touching(terrain: Terrain, base: Mapping[str, Any], moved: str, tuned: str) -> Iterator[_Spot]:
    """Yield the spots where a margin nearly touches zero, in a plane of two given quantities."""
    across = np.linspace(*terrain.ranges[tuned], _ROWS)
    along = np.linspace(*terrain.ranges[moved], _COLUMNS)
    y, x = (v.ravel() for v in np.meshgrid(across, along, indexing="ij"))
    margins = terrain.relative({**_arrays(base, y.size), tuned: y, moved: x})
    for key, values in margins.items():
        for i, j in _near_touch(values.reshape(_ROWS, -1)):
            yield _Spot(base, moved, key, tuned).put(**{tuned: across[i], moved: along[j]})


def _near_touch(m: np.ndarray) -> list[tuple[int, int]]:
    """Return the cells of a plane where an extremum along the rows vanishes, or is about to, from row to
    row."""
    results = []
    with np.errstate(all="ignore"):
        for least in (True, False):
            signed = m if least else -m
            filled = np.where(np.isfinite(signed), signed, np.inf)
            j = filled.argmin(axis=1)
            rows = np.arange(len(m))
            value = filled[rows, j]
            inside = np.isfinite(value) & (j > 0) & (j < m.shape[1] - 1)
            for i in range(len(m) - 1):
                if not (inside[i] and inside[i + 1]):
                    continue
                crosses = value[i] * value[i + 1] < 0
                touches = i and inside[i - 1] and abs(value[i]) <= min(0.3, *abs(value[[i - 1, i + 1]]))
                if crosses or touches:
                    results.append((i, int(j[i])))
    return results


def _zoomed(terrain: Terrain, spots: Sequence[_Spot]) -> Iterator[_Spot]:
    """Yield the spots to double precision, from finer and finer planes around each."""
    levels, points = np.linspace(-1, 1, 5), np.linspace(-1, 1, 9)
    shape = len(levels), len(points)
    y, x = (np.array([s.given[name] for s, name in pairs]) for pairs in _pairs(spots))
    wide = np.array([1.5 * np.ptp(terrain.ranges[s.tuned]) / (_ROWS - 1) for s in spots])
    long = np.array([2.0 * np.ptp(terrain.ranges[s.moved]) / (_COLUMNS - 1) for s in spots])
    given = _together(spots, shape)
    for _ in range(_ZOOMS):
        for i, spot in enumerate(spots):
            given[spot.tuned][i] = (y[i] + wide[i] * levels)[:, None]
            given[spot.moved][i] = x[i] + long[i] * points
        for i, plane in enumerate(_own_margins(terrain, spots, given, shape)):
            row, column = _best_extremum(plane)
            y[i] += wide[i] * levels[row]
            x[i] += long[i] * column
        wide, long = wide * 0.4, long * 0.5
    near = [s.put(**{s.moved: _short(x[i], 2e-5), s.tuned: y[i]}) for i, s in enumerate(spots)]
    yield from _settled(terrain, near)


def _pairs(spots: Sequence[_Spot]) -> tuple[list[tuple[_Spot, str]], list[tuple[_Spot, str]]]:
    return [(s, s.tuned) for s in spots], [(s, s.moved) for s in spots]


def _settled(terrain: Terrain, spots: Sequence[_Spot]) -> Iterator[_Spot]:
    """Yield the spots with the tuned quantity as a short decimal where the margin vanishes there, else as
    found.

    Spots whose margin does not vanish, or outside the range, are left out.
    """
    short = [s.put(**{s.tuned: _short(v := s.given[s.tuned], 1e-5 * max(abs(v), 1.0))}) for s in spots]
    left = [abs(_own_margins(terrain, value, _together(value), ())) for value in (short, spots)]
    for value in zip(short, spots, *left, strict=True):
        chosen = value[0] if value[2] < _ZERO else value[1] if value[3] < _ZERO else None
        if chosen is not None and _is_inside(chosen.given[chosen.tuned], terrain.ranges[chosen.tuned]):
            yield chosen


def _is_inside(value: float, limits: tuple[float, float]) -> bool:
    return limits[0] <= value <= limits[1]


def _short(value: float, apart: float) -> float:
    """Return the shortest decimal, of at most six places, within ``apart`` of a value."""
    for places in range(7):
        if abs(round(value, places) - value) <= apart:
            return round(value, places) + 0.0
    return value


def _best_extremum(plane: np.ndarray) -> tuple[int, float]:
    """Return the row whose extremum is nearest to zero, and its position on the row, from -1 to 1."""
    best, point = np.inf, (plane.shape[0] // 2, 0.0)
    last = plane.shape[1] - 1
    for row, values in enumerate(plane):
        if not np.isfinite(values).all():
            continue
        for candidate in (values, -values):
            j = int(candidate.argmin())
            if 0 < j < last:
                a, b, c = candidate[j - 1], candidate[j], candidate[j + 1]
                bend = a - 2 * b + c
                shift = 0.5 * (a - c) / bend if bend > 0 else 0.0
                low = abs(b - 0.125 * (a - c) ** 2 / bend if bend > 0 else b)
                if low < best:
                    best, point = low, (row, (j + shift) * 2 / last - 1)
    return point


# ---------------------------------------------------------------------- other places


def _vanishing(terrain: Terrain) -> list[_Spot]:
    """Return the spots of a vanishing length beside others, and of the angle of a flat triangle."""
    base = terrain.bases[0]
    flat = [n for n in terrain.angles if not terrain.turns(n)]
    ends = [(n, 0.0) for n in (*terrain.sizes, *flat)] + [(n, 180.0) for n in flat]
    return [_Spot({**base, name: end}, name, (name, VANISHING, 0)) for name, end in ends]


def _growing(terrain: Terrain) -> list[_Spot]:
    """Return the spots of a length that outgrows the others."""
    return [_Spot(terrain.bases[0], name, (name, GROWING, 0)) for name in terrain.sizes]


def _merged(terrain: Terrain, results: Sequence[_Spot]) -> list[HardPlace]:
    """Merge the zeros at one place; of one kind of place, keep the first."""
    by_place: dict[Any, list[_Spot]] = {}
    for zero in results:
        where = tuple(
            v if isinstance(v, str) else round(v / _SAME / max(abs(v), 1.0)) for v in zero.given.values()
        )
        by_place.setdefault((zero.moved, zero.key[1] == GROWING, where), []).append(zero)
    places, sorts = [], set()
    for (moved, _, _), zeros in by_place.items():
        first = zeros[0]
        seen = tuple(dict.fromkeys(z.key[:2] for z in zeros))
        sort = (moved, next((z.tuned for z in zeros if z.tuned), ""), frozenset(z.key for z in zeros))
        if sort in sorts:
            continue
        sorts.add(sort)
        kind, quantity = first.key[1], first.key[0]
        scale = terrain.scale(moved, terrain.bases[0] if kind == VANISHING else first.given)
        places.append(HardPlace(first.given, moved, scale, kind, quantity, sort[1], seen=seen))
    return places


def _ranked(terrain: Terrain, places: Sequence[HardPlace]) -> list[HardPlace]:
    """Return the places with their loss of digits, the largest first."""
    weighed = sorted((replace(p, lost=_lost(terrain, p)) for p in places), key=lambda p: -p.lost)
    retained: dict[Any, list[HardPlace]] = {}
    for point in weighed:
        group = retained.setdefault((point.kind, point.quantity, point.double and point.moved), [])
        if point.lost > _LOST and len(group) < _OF_A_SORT:
            group.append(point)
    return sorted((p for group in retained.values() for p in group), key=lambda p: -p.lost)


def _lost(terrain: Terrain, point: HardPlace) -> float:
    """Return the relative change near a place due to the textbook formula, or to the last digit of a
    datum."""
    worst = 0.0
    graph, textbook = terrain.exercise.solution.graph, terrain.graph
    eps = np.finfo(float).eps
    for side in point.sides:
        given = point.at(side * _NEAR)
        names = [n for n in terrain.names if given[n]]
        count = 1 + len(names)
        spread = _arrays(given, count)
        step = 1e-3 * _NEAR
        for i, name in enumerate(names):
            # Beside a far larger length a step in parts of it would be more than the others are.
            spread[name][i + 1] += step * (
                abs(given[name]) if point.kind == GROWING else terrain.scale(name, given)
            )
        for wanted in terrain.wanted:
            try:
                stable = np.broadcast_to(graph.evaluate((wanted,), spread, terrain.effects)[wanted], (count,))
                formula = np.broadcast_to(
                    textbook.evaluate((wanted,), spread, terrain.effects)[wanted], (count,)
                )
            except (CourseworkError, TypeError, ValueError):
                continue
            if np.asarray(stable).dtype.kind not in "f" or not np.isfinite(stable[0]):
                continue
            size = abs(stable[0]) or 1.0
            full = terrain.exercise.units.get(wanted) == "deg"
            apart = abs(formula[0] - stable[0])
            moves = abs(stable[1:] - stable[0])
            if full:
                size = 57.3
                apart, moves = min(apart, abs(360 - apart)), np.minimum(moves, abs(360 - moves))
            moves = moves[np.isfinite(moves)]
            condition = float(moves.max(initial=0.0)) / step / size * eps
            worst = max(worst, condition, float(apart / size) if np.isfinite(apart) else 1.0)
    return worst
