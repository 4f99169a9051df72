"""Closure of a mechanism, asked of the frames of its bodies: how far its joints are from holding, and whether
it turns all round."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from coursework.mechanics.linkage import MM, BodyPoint, GearJoint, Linkage
from coursework.mechanics.statement import Mechanism, Place
from coursework.quantities.graph import Graph

_STEPS = 180  #: positions of a turn


def turns_round(
    functions: Callable[[], Sequence[Callable[..., Any]]],
    names: Sequence[str],
    driver: str,
    values: Mapping[str, Any],
) -> Any:
    """Return whether a mechanism closes in every position of its driver.

    Parameters
    ----------
    functions
        A function that returns those of the angles, and those that they need.
    names
        Angles that follow from the driver's.
    driver
        Name of the driver's angle, degrees.
    values
        Quantities that place the mechanism; scalars, or arrays of shape ``(n,)``.

    Returns
    -------
    True or False, of the broadcast shape of the values: 180 positions of a turn are tried.
    """
    graph = _graph(tuple(functions()))
    shape = np.broadcast_shapes(*(np.shape(v) for v in values.values())) if values else ()
    size = int(np.prod(shape, dtype=int))
    flat = {n: np.repeat(np.ravel(np.broadcast_to(v, shape)), _STEPS) for n, v in values.items()}
    turn = np.tile(np.linspace(-180.0, 180.0, _STEPS, endpoint=False), size)
    with np.errstate(all="ignore"):
        found = graph.evaluate(tuple(names), {**flat, driver: turn})
    good = np.all([np.isfinite(np.broadcast_to(found[n], turn.shape)) for n in names], axis=0)
    return good.reshape(*shape, _STEPS).all(axis=-1)


def length_at(
    functions: Callable[[], Sequence[Callable[..., Any]]],
    name: str,
    length: str,
    driven: Any,
    limits: tuple[Any, Any],
    values: Mapping[str, Any],
) -> Any:
    """Return the driven length at which a body stands at an angle.

    Parameters
    ----------
    functions
        A function that returns that of the angle, and those that it needs.
    name, length
        Names of the angle, degrees, and of the length, mm.
    driven
        The angle; a scalar or an array of shape ``(n,)``.
    limits
        Lengths between which it is sought, mm.
    values
        The other quantities that place the mechanism, scalars.

    Returns
    -------
    The length, the shortest if there are several; NaN where the body does not come to the angle between the
    limits.
    """
    graph = _graph(tuple(functions()))

    def apart(at: np.ndarray) -> np.ndarray:
        with np.errstate(all="ignore"):
            found = np.asarray(graph.evaluate((name,), {**values, length: at})[name])
        return (np.broadcast_to(found, at.shape) - target + 180.0) % 360.0 - 180.0

    wanted = np.atleast_1d(np.asarray(driven, dtype=float))
    least, most = map(float, limits)
    over = 1e-9 * (most - least)  # rounding leaves an end where it is
    tried = np.linspace(least - over, most + over, _STEPS + 1)
    target: Any = wanted[:, None]
    gaps = apart(np.broadcast_to(tried, (len(wanted), len(tried))))
    crossed = (gaps[:, :-1] * gaps[:, 1:] <= 0) & (abs(gaps[:, :-1] - gaps[:, 1:]) < 180.0)
    first = np.argmax(crossed, axis=1)
    low, high = tried[first], tried[first + 1]
    target = wanted
    one, other = apart(low), apart(high)
    for _ in range(60):  # the regula falsi of Illinois; a step that moves nothing ends it
        with np.errstate(all="ignore"):
            middle = np.where(one == other, low, (low * other - high * one) / (other - one))
        gap = apart(middle)
        kept = gap * other < 0
        low, one = np.where(kept, high, low), np.where(kept, other, one / 2)
        if np.array_equal(middle, high):
            break
        high, other = middle, gap
    found = np.where(crossed.any(axis=1), np.clip(high, least, most), np.nan)
    return found if np.ndim(driven) else float(found[0])


def reference_values(
    functions: Callable[[], Sequence[Callable[..., Any]]], names: Sequence[str], given: Mapping[str, Any]
) -> dict[str, Any]:
    """Return quantities from what is given alone.

    Parameters
    ----------
    functions
        A function that returns those of the quantities, and those that they need.
    names
        Quantities, given or computed.
    given
        Values by name.

    Returns
    -------
    Their values by name.
    """
    graph = _graph(tuple(functions()))
    wanted = tuple(n for n in names if n in graph.names)
    found = graph.evaluate(wanted, {n: v for n, v in given.items() if n in graph.leaves}) if wanted else {}
    return {n: found.get(n, given.get(n)) for n in names}


@lru_cache(maxsize=64)
def _graph(functions: tuple[Callable[..., Any], ...]) -> Graph:
    return Graph({f.__name__: f for f in functions}).textbook  # what is listed follows from the formulas


class RelativeGaps(tuple[Any, ...]):
    """Gaps of equations over the sizes of their terms: 1 is a gap as large as what it is made of."""


class SlideTrack(NamedTuple):
    """Slide as the file states it: the sliding point, its body, the guide, a place on the line and its
    direction in the guide's frame (mm, degrees; quantities or functions of them), the quantity that is the
    distance along it."""

    at: str
    of: str
    on: str
    through: Place
    along: Place
    distance: str


def closure_gaps(
    mechanism: Mechanism,
    tracks: Sequence[SlideTrack],
    sides: Sequence[tuple[str, str, str, str]],
    driver: str,
    order: int,
    values: Mapping[str, Any],
) -> RelativeGaps:
    """Return how far joints are from holding, and their velocities and accelerations from agreeing.

    Parameters
    ----------
    mechanism
        Bodies and joints.
    tracks
        Its slides.
    sides
        Of each triangle the inner joint, both outer ones, and the quantity that is +1 where the inner one
        lies on the left of the line between the others.
    driver
        Name of the driver's angle.
    order
        0 for positions, 1 with velocities, 2 with accelerations.
    values
        Lengths in mm, angles in degrees, ``omega…`` and ``alpha…`` of the bodies; scalars or arrays that
        broadcast.

    Returns
    -------
    Gaps over the sizes of their terms, each of the broadcast shape.

    Source
    ------
    Every point that bodies share is placed by the frame of each, with ``i omega`` and ``i alpha - omega^2``
    for its rates; a point that slides stays on its line, and leaves the guide's own point by the sliding
    velocity and the Coriolis term.
    """
    shape = np.broadcast_shapes(*(np.shape(v) for v in values.values()))
    flat = {n: np.ravel(np.broadcast_to(v, shape)) for n, v in values.items()}
    rows = [
        _Frames(mechanism, driver, {n: v[k].item() for n, v in flat.items()}).gaps(tracks, sides, order)
        for k in range(int(np.prod(shape, dtype=int)))
    ]
    return RelativeGaps(np.reshape(column, shape)[()] for column in np.array(rows).T)


class _Frames:
    """Frames of all bodies at an instant, by their angles alone."""

    def __init__(self, mechanism: Mechanism, driver: str, values: Mapping[str, Any]) -> None:
        self.linkage = Linkage(mechanism, values, driver)
        angles = [b.angle for b in mechanism.bodies]
        self.turns, self.rates, self.gains = (
            [*(_of(a, stem, values) for a in angles), 0.0] for stem in ("theta", "omega", "alpha")
        )
        self.units = [np.exp(1j * np.radians(t)) for t in self.turns]
        self.origins: list[tuple[complex, complex, complex]] = []
        self.free = set(self.linkage.free)
        for body, body_point in enumerate(self.linkage.origins):
            start = self.origins[body_point.body] if body_point.body >= 0 else (0j, 0j, 0j)
            place = self.carried(body_point, start)
            if body in self.free:
                origin = mechanism.bodies[body]
                shift = complex(self.linkage.number(origin.origin)) * MM
                place = (place[0] + shift, *self._stated(body, origin.at, values))
            self.origins.append(place)
        self.origins.append((0j, 0j, 0j))

    def _stated(self, body: int, point: str, values: Mapping[str, Any]) -> tuple[complex, complex]:
        """Return the velocity and the acceleration of the origin of a free body, where they are stated: it is
        free no more."""
        if f"v_{point}_x" in values:
            self.free.remove(body)
        v, a = (
            complex(*(float(values.get(f"{kind}_{point}_{axis}", 0.0)) for axis in "xy")) for kind in "va"
        )
        return v * MM, a * MM

    def carried(
        self, body_point: BodyPoint, start: tuple[complex, complex, complex] | None = None
    ) -> tuple[complex, complex, complex]:
        """Return position, velocity and acceleration of a place on a body."""
        begin = self.origins[body_point.body] if start is None else start
        arm = body_point.place * self.units[body_point.body]
        rate, gain = self.rates[body_point.body], self.gains[body_point.body]
        return begin[0] + arm, begin[1] + 1j * rate * arm, begin[2] + (1j * gain - rate**2) * arm

    def gaps(
        self, tracks: Sequence[SlideTrack], sides: Sequence[tuple[str, str, str, str]], order: int
    ) -> list[float]:
        """Return the gaps of pins and slides over the sizes of their terms."""
        linkage = self.linkage
        closing = [pin for pin in linkage.pins if pin.closes]
        ends = [(self.carried(pin.of), self.carried(pin.on)) for pin in closing]
        sizes = self._sizes([place for pair in ends for place in pair], tracks)
        results = [abs(one[k] - other[k]) / sizes[k] for one, other in ends for k in range(order + 1)]
        for gear in linkage.gears:
            results += self._of_gear(gear, order)
        for track in tracks:
            results += self._of_track(track, order, sizes)
        for inner, start, end, side in sides:
            B, P, Q = (self.carried(linkage.owner(point))[0] for point in (inner, start, end))
            area = ((Q - P).conjugate() * (B - P)).imag / max(abs(Q - P) * abs(B - P), 1e-300)
            results.append(max(-area * float(linkage.values[side]), 0.0))
        return results

    def _sizes(
        self, ends: Sequence[tuple[complex, complex, complex]], tracks: Sequence[SlideTrack]
    ) -> tuple[float, float, float]:
        """Return the largest distance, velocity and acceleration: where nothing turns, those of what
        slides."""
        places = [*ends, *self.origins]
        far = max([1e-12, *(abs(place[0]) for place in places)])
        slid = [
            [float(self.linkage.values.get(f"{t.distance}{end}", 0.0)) * MM for t in tracks]
            for end in ("_dot", "_ddot")
        ]
        turned = [abs(r) * far for r in self.rates]
        grown = [(r**2 + abs(g)) * far for r, g in zip(self.rates, self.gains, strict=True)]
        fast, faster = (
            max([1e-12, *own, *(abs(place[k]) for place in places), *map(abs, slid[k - 1])])
            for k, own in ((1, turned), (2, grown))
        )
        return far, fast, faster

    def _of_gear(self, gear: GearJoint, order: int) -> list[float]:
        """Return how far two wheels are from rolling on each other: their arcs, seen from the carrier, and
        the rates of these."""
        first, second = gear.radii
        results = []
        for values in (self.turns, self.rates, self.gains)[: order + 1]:
            one, other, carrier = (values[b] for b in (gear.first, gear.second, gear.carrier))
            arcs = first * (one - carrier), second * (other - carrier)
            results.append(abs(sum(arcs)) / (max(map(abs, arcs)) or 1.0))
        return results

    def _of_track(self, track: SlideTrack, order: int, sizes: tuple[float, float, float]) -> list[float]:
        linkage = self.linkage
        of, on = linkage.index[track.of], linkage.index[track.on]
        if of in self.free or on in self.free:
            order = 0
        way = np.exp(1j * np.radians(linkage.number(track.along))) * self.units[on]
        place = self.carried(linkage.body_point(track.at, track.of))
        line = self.carried(BodyPoint(on, complex(linkage.number(track.through)) * MM))
        apart = (place[0] - line[0]) * np.conj(way)
        stated = float(linkage.values[track.distance]) * MM
        results = [abs(apart.imag) / sizes[0], abs(apart.real - stated) / sizes[0]]
        under = self.carried(BodyPoint(on, (place[0] - self.origins[on][0]) / self.units[on]))
        slid = (place[1] - under[1]) * np.conj(way)
        if order > 0:
            results.append(abs(slid.imag) / sizes[1])
            if (name := f"{track.distance}_dot") in linkage.values:
                results.append(abs(slid.real - float(linkage.values[name]) * MM) / sizes[1])
        if order > 1:
            turned = 2j * self.rates[on] * slid.real * way
            grown = (place[2] - under[2] - turned) * np.conj(way)
            results.append(abs(grown.imag) / sizes[2])
            if (name := f"{track.distance}_ddot") in linkage.values:
                results.append(abs(grown.real - float(linkage.values[name]) * MM) / sizes[2])
        return results


def _of(angle: Any, stem: str, values: Mapping[str, Any]) -> float:
    if isinstance(angle, (int, float)):
        return float(angle) if stem == "theta" else 0.0
    return float(values.get(str(angle).replace("theta", stem, 1), 0.0))
