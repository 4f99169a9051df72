"""Cycle of a driver, instant by instant: its angles, and the figure at each of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.course.variant import Variant
from coursework.degrees import wrap
from coursework.errors import BadCourse, CannotAssemble, Undefined, WrongValue
from coursework.figures.figure import Figure
from coursework.figures.moving import extent
from coursework.model import Driver
from coursework.quantities.graph import Graph
from coursework.solution import Film

if TYPE_CHECKING:
    from coursework.figures.base import Element

SECONDS = 6.0  #: how long a turn of the driver, or a swing, lasts on the screen
MOST_TURNS = 20  #: of its driver, in a film
#: How far from a straight line something moves between two instants, over the size of the mechanism.
_BEND = 1e-3
_HALVINGS = 4  #: of a step, where something moves fast


class Reel:
    """Instants of a variant's mechanism: over the cycle of its driver, or over the turns of its film.

    ``count`` is the number of angles in a turn of the driver.

    Raises
    ------
    BadCourse
        The exercise names no driver or no figure, and the solution states no film.
    """

    def __init__(self, variant: Variant, count: int):
        exercise = variant.exercise
        if exercise.film is None and exercise.spec.driver is None:
            raise BadCourse(
                f"{exercise.name} names no driver=Driver(…) and its solution states no FILM, so it "
                "cannot be moved"
            )
        if not exercise.is_animated:
            raise BadCourse(f"{exercise.name} has no figure to move")
        if count < 3:
            raise WrongValue("a cycle has at least three angles; found {count}", count=count)
        self.variant = variant
        self.count = count

    @property
    def film(self) -> Film | None:
        """Film of the solution; None without one."""
        return self.variant.exercise.film

    @property
    def driver(self) -> str:
        """Name of the driving angle."""
        return self._drive.angle

    @property
    def _sign(self) -> int:
        """Sign of the driver's rotation: +1 or -1."""
        return -1 if float(self.variant.given.get(self._drive.speed, 1.0)) < 0 else 1

    @property
    def _drive(self) -> Film | Driver:
        drive = self.film or self.variant.exercise.spec.driver
        assert drive is not None  # what has neither is refused at the start
        return drive

    def _with_driver_at(self, angle: Any) -> dict[str, Any]:
        """Return the given quantities, the driver at an angle, degrees, or at each of an array of angles."""
        given = self.variant.given
        if self.film is not None:
            return {**given, self.film.angle: angle}
        return {**given, **self.variant.exercise.posed(given, angle)}

    def _stated(self, name: str, function: Callable[..., Any], given: Mapping[str, Any]) -> Any:
        """Evaluate a function of the solution's quantities, under a name that none of them has."""
        exercise = self.variant.exercise
        graph = exercise.solution.graph.with_functions({name: function})
        known_values = {n: v for n, v in given.items() if n in exercise.quantity_names | graph.leaves}
        return graph.evaluate((name,), known_values, self.variant.effects)[name]

    # ------------------------------------------------------------------- instants

    def _elements(self, angle: float) -> tuple[Element, ...] | None:
        """Return the figure's elements at an angle of the driver; None where the mechanism does not close."""
        try:
            return self.elements_at(angle)
        except (CannotAssemble, Undefined, WrongValue):
            return None

    def elements_at(self, angle: float) -> tuple[Element, ...]:
        """Return the figure's elements at an angle of the driver, degrees.

        Raises
        ------
        CannotAssemble, Undefined, WrongValue
            There is no figure at that angle.
        """
        if self.film is not None:
            figure = self._stated("figure", self.film.figure, self._with_driver_at(float(angle)))
        else:
            given = self._with_driver_at(wrap(float(angle)))
            values = {n: v for n, v in given.items() if n in self._graph.leaves}
            figure = self._graph.evaluate(("figure",), values)["figure"]
        elements: tuple[Element, ...] = figure.labelled(
            self.variant.exercise.symbols(self.variant.lang)
        ).elements
        return elements

    @cached_property
    def _graph(self) -> Graph:
        spec = self.variant.exercise.spec
        assert spec.figure is not None  # what has none is refused at the start
        return Graph({**{f.__name__: f for f in spec.helpers}, "figure": spec.figure})

    @cached_property
    def _cycle(self) -> tuple[np.ndarray, list[tuple[Element, ...]], int, bool]:
        """Driver's angles in increasing order, the elements at each, the index of the statement's instant,
        and whether the driver turns fully."""
        if self.film is not None:
            return self._reel(self.film)
        start, step = self.variant.exercise.driver_angle(self.variant.given), 360.0 / self.count
        figure = self.variant.figure
        if not isinstance(figure, Figure) or len(self.variant.figures) > 1:
            raise BadCourse(
                f"{self.variant.exercise.name}: what a driver moves is one Figure, and no picture"
            )
        results = {0: figure.elements}
        for k in range(1, self.count):
            if (elements := self._elements(start + k * step)) is None:
                break
            results[k] = elements
        if len(results) == self.count:
            turned = math.floor((start % 360.0) / step + 1e-9)
            displayed = [(k - turned) % self.count for k in range(self.count)]
            angles = (start % 360.0) + (np.arange(self.count) - turned) * step
            nodes = dict(zip(angles.tolist(), (results[k] for k in displayed), strict=True))
            return self._refined(nodes, float(angles[turned]), True)
        closing = {start + k * step: elements for k, elements in results.items()}
        for k in range(-1, -self.count, -1):
            if (elements := self._elements(start + k * step)) is None:
                break
            closing[start + k * step] = elements
        for direction, last in ((1, max(closing)), (-1, min(closing))):
            closing |= self._toward_limit(last, direction * step, min(len(closing) - 1, 2))
        return self._refined(dict(sorted(closing.items())), start, False)

    def _refined(
        self, nodes: dict[float, tuple[Element, ...]], start: float, turns: bool
    ) -> tuple[np.ndarray, list[tuple[Element, ...]], int, bool]:
        """Return the cycle with further instants where something moves fast, so that it goes nearly straight
        from each instant to the next."""
        low, high = extent(list(nodes.values()))
        allowed = _BEND * max((high - low).real, (high - low).imag)
        row = [*nodes.items()]
        if turns:
            row = [*row, (row[0][0] + 360.0, row[0][1]), (row[1][0] + 360.0, row[1][1])]
        # Between two instants a smooth way bends about as much as its second difference says, over 8.
        bends = [_bend(*(elements for _, elements in row[k - 1 : k + 2])) / 4 for k in range(1, len(row) - 1)]
        around = [bends[-1] if turns else bends[0], *bends, bends[-1]]
        for k, ((a, first), (b, second)) in enumerate(pairwise(row[:-1] if turns else row)):
            if max(around[k : k + 2]) > allowed / 2:
                nodes |= self._between(a, first, b, second, allowed, _HALVINGS)
        ordered = sorted(nodes)
        return np.array(ordered), [nodes[a] for a in ordered], ordered.index(start), turns

    def _between(
        self,
        a: float,
        first: tuple[Element, ...],
        b: float,
        second: tuple[Element, ...],
        allowed: float,
        halvings: int,
    ) -> dict[float, tuple[Element, ...]]:
        """Return the instants to add between two; none where the middle one lies nearly on the straight
        lines."""
        middle = (a + b) / 2
        elements = self._elements(middle)
        if elements is None or _bend(first, elements, second) <= allowed:
            return {}
        if halvings > 1:
            before = self._between(a, first, middle, elements, allowed, halvings - 1)
            after = self._between(middle, elements, b, second, allowed, halvings - 1)
            return {middle: elements} | before | after
        return {middle: elements}

    def _reel(self, film: Film) -> tuple[np.ndarray, list[tuple[Element, ...]], int, bool]:
        """Return the cycle of a film: from 0, by equal steps and a last one that may be shorter."""
        location = f"{self.variant.exercise.solution.source}: FILM"
        if film.speed not in self.variant.given:
            given = ", ".join(self.variant.given)
            raise BadCourse(f"{location}: speed={film.speed!r} is not a given quantity; there are {given}")
        turns = self._stated("figure", film.turns, self.variant.given)
        if not isinstance(turns, (int, float)) or not 0 < turns <= MOST_TURNS:
            raise BadCourse(
                f"{location}: turns gives a number above 0, at most {MOST_TURNS}; found {turns!r}"
            )
        if not isinstance(figure := self._stated("figure", film.figure, self._with_driver_at(0.0)), Figure):
            raise BadCourse(f"{location}: figure gives a Figure(…); found {figure!r}")
        steps = math.ceil(self.count * turns - 1e-9)
        angles = self._sign * np.array([*(360.0 / self.count * np.arange(steps)), 360.0 * turns])
        angles = angles[:: self._sign] + 0.0  # no negative zero
        first = 0 if self._sign > 0 else steps
        return angles, [self.elements_at(angle) for angle in angles], first, True

    def _toward_limit(self, last: float, step: float, back: int) -> dict[float, tuple[Element, ...]]:
        """Return the limit beyond the last angle, and further angles before it, where the links turn as the
        square root of the distance."""
        limit, elements = self._limit(last, step)
        if abs(limit - last) < 1e-3 * abs(step):
            return {}
        run = limit - (last - back * step)
        more = {limit - run * (j / 10) ** 2: None for j in range(1, 10)}
        results = {angle: self._elements(angle) for angle in more}
        return {limit: elements} | {angle: item for angle, item in results.items() if item is not None}

    def _limit(self, angle: float, step: float) -> tuple[float, tuple[Element, ...]]:
        """Return the last angle at which the mechanism closes, between one that closes and the next, which
        does not."""
        inside, outside = 0.0, 1.0
        elements = self.elements_at(angle)
        for _ in range(30):
            middle = (inside + outside) / 2
            tried = self._elements(angle + middle * step)
            if tried is None:
                outside = middle
            else:
                inside, elements = middle, tried
        return angle + inside * step, elements

    @property
    def angles(self) -> np.ndarray:
        """The driver's angle at every instant, degrees, increasing."""
        return self._cycle[0]

    @property
    def frames(self) -> list[tuple[Element, ...]]:
        """The figure's elements at every instant, mm of mechanism."""
        return self._cycle[1]

    @property
    def first(self) -> int:
        """Index of the instant on the sheet; in a film 0."""
        return self._cycle[2]

    @property
    def turns(self) -> bool:
        """True if the driver turns fully; otherwise the mechanism swings between its limits."""
        return self._cycle[3]

    @property
    def closed(self) -> bool:
        """True if the first instant follows the last one; False for a swing and for a film."""
        return self.turns and self.film is None

    @property
    def seconds(self) -> float:
        """Duration of a loop on the screen."""
        return SECONDS * (1.0 if self.film is None else round(float(np.ptp(self.angles)) / 360.0, 3))

    @cached_property
    def order(self) -> tuple[int, ...]:
        """Indices of a loop in time, from the sheet's instant back to it; in a film from the first to the
        last."""
        count, first, sign = len(self.angles), self.first, self._sign
        if self.film is not None:
            return tuple(range(count))[::sign]
        if self.turns:
            return tuple((first + sign * k) % count for k in range(count + 1))
        there, back = [*range(first, count), *range(count - 2, -1, -1)], range(1, first + 1)
        loop = (*there, *back) if first else tuple(there)
        return loop if sign > 0 else loop[::-1]

    @cached_property
    def times(self) -> np.ndarray:
        """Time of each instant of a loop, from 0 to 1: a full turn is uniform, a swing like a pendulum's."""
        if self.film is not None:
            gone = np.abs(self.angles - self.angles[self.first])[list(self.order)]
            return gone / gone[-1]
        if self.turns:
            turned = np.unwrap(self.angles[list(self.order)], period=360.0)
            return np.abs(turned - turned[0]) / 360.0
        low, high = self.angles[[0, -1]]
        phase = np.arccos(np.clip((2 * self.angles - low - high) / (low - high), -1.0, 1.0))
        steps = np.abs(np.diff(phase[list(self.order)]))
        return np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])


def _bend(first: Sequence[Element], middle: Sequence[Element], second: Sequence[Element]) -> float:
    """Return the largest distance of a link's end from the middle of where it is before and after, mm of
    mechanism."""
    one, two, three = (_ends(elements) for elements in (first, middle, second))
    if not len(one) == len(two) == len(three):
        return 0.0
    return max((abs(q - (p + r) / 2) for p, q, r in zip(one, two, three, strict=True)), default=0.0)


def _ends(elements: Sequence[Element]) -> list[complex]:
    return [end for element in elements for bar in element.bars() for end in bar]
