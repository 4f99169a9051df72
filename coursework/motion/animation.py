"""An exercise in motion: its figure over the cycle of its driver, paths of points, and vectors.

The figure is the statement's own, asked again at every angle, unless the solution states a :class:`~coursework.solution.Film`
with one that can move. Which points leave a trace, and which vectors they carry, a solution states in a function ``motion``
of its quantities, called once with arrays over the cycle::

    def motion(r2, theta2, omega2):
        A = polar(r2, theta2)
        return {"A": Moving(A, 1j * omega2 * A, -(omega2**2) * A)}
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.course.variant import Variant
from coursework.degrees import wrap
from coursework.errors import BadCourse, CannotAssemble, CourseworkError, Undefined, WrongValue, unknown
from coursework.figures.figure import Figure
from coursework.figures.moving import Arrow, Drawing, Key, Spot, drawing, extent
from coursework.language.numbers import localise, significant, unit_text
from coursework.language.words import words
from coursework.markup.shown import Picture
from coursework.model import Driver
from coursework.motion.scenes import LEVELS, Scene
from coursework.quantities.graph import Graph
from coursework.solution import Film, Moving

if TYPE_CHECKING:
    from coursework.figures.base import Element


EFFECTS = tuple(LEVELS)
UNIT = {"velocity": "mm/s", "acceleration": "mm/s^2", "coriolis": "mm/s^2"}
SECONDS = 6.0  #: how long a turn of the driver, or a swing, lasts on the screen
MOST_TURNS = 20  #: of its driver, in a film
_LONGEST = 0.3  #: of the longest vector, over the size of the mechanism


@dataclass(frozen=True)
class Reading:
    """A quantity over the instants, as printed; empty where it does not exist."""

    symbol: str
    unit: str
    effects: tuple[str, ...]
    point: str  #: the point whose vector it measures, if any
    values: tuple[str, ...]


class Animation:
    """A variant's mechanism over the cycle of its driver, or over the turns that its film shows.

    Parameters
    ----------
    variant
        Of an exercise that names a driver and a figure, or whose solution states a film.
    effects
        What is seen from the start: ``position`` (paths of points), ``velocity``, ``acceleration``,
        ``coriolis``; paths alone unless told.
    count
        Angles in a turn of the driver.

    Raises
    ------
    BadCourse
        The exercise names no driver or no figure, and no solution at hand states a film.
    UnknownName
        An effect that is none of the four.
    WrongValue
        An effect of which the solution states nothing.
    """

    def __init__(self, variant: Variant, effects: Sequence[str] = (), count: int = 72):
        exercise = variant.exercise
        if exercise.film is None and exercise.spec.driver is None:
            raise BadCourse(
                f"{exercise.name} names no driver=Driver(…) and no solution at hand states a FILM, so it cannot be moved"
            )
        if not exercise.is_animated:
            raise BadCourse(f"{exercise.name} has no figure to move")
        if count < 3:
            raise WrongValue(f"a cycle has at least three angles; found {count}")
        self.variant = variant
        self.count = count
        for effect in effects:
            if effect not in EFFECTS:
                raise unknown("effect", effect, EFFECTS, variant.exercise.name)
            if effect != "position" and effect not in self.available:
                raise WrongValue(
                    f"{variant.exercise.name}: no {effect} to show; "
                    f"{variant.exercise.folder.source('solutions', variant.exercise.name)} states none in motion(…)"
                )
        self.effects = tuple(e for e in EFFECTS if e in effects) or ("position",)

    @property
    def film(self) -> Film | None:
        """The film that the solution states, if it is one."""
        return self.variant.exercise.film

    @property
    def driver(self) -> str:
        """The name of the driving angle."""
        return self._drive.angle

    @property
    def _sign(self) -> int:
        """Which way the driver turns."""
        return -1 if float(self.variant.given.get(self._drive.speed, 1.0)) < 0 else 1

    @property
    def _drive(self) -> Film | Driver:
        drive = self.film or self.variant.exercise.spec.driver
        assert drive is not None  # what has neither is refused at the start
        return drive

    def _with_driver_at(self, angle: Any) -> dict[str, Any]:
        """The given quantities, the driver at an angle, degrees, or at each of an array of angles."""
        given = self.variant.given
        if self.film is not None:
            return {**given, self.film.angle: angle}
        return {**given, **self.variant.exercise.posed(given, angle)}

    def _stated(self, name: str, function: Callable[..., Any], given: Mapping[str, Any]) -> Any:
        """What a function of the solution's quantities gives, called by a name that is none of theirs."""
        exercise = self.variant.exercise
        graph = exercise.solution.graph.with_functions({name: function})
        known = {n: v for n, v in given.items() if n in exercise.quantity_names | graph.leaves}
        return graph.evaluate((name,), known, self.variant.effects)[name]

    # ------------------------------------------------------------------- instants

    def _elements(self, angle: float) -> tuple[Element, ...] | None:
        """The figure's elements at an angle of the driver; None where the mechanism does not close."""
        try:
            return self._elements_or_fault(angle)
        except (CannotAssemble, Undefined, WrongValue):
            return None

    def _elements_or_fault(self, angle: float) -> tuple[Element, ...]:
        if self.film is not None:
            return self._stated("figure", self.film.figure, self._with_driver_at(float(angle))).elements
        given = self._with_driver_at(wrap(float(angle)))
        values = {n: v for n, v in given.items() if n in self._graph.leaves}
        return self._graph.evaluate(("figure",), values)["figure"].elements

    @cached_property
    def _graph(self) -> Graph:
        spec = self.variant.exercise.spec
        assert spec.figure is not None  # what has none is refused at the start
        return Graph({**{f.__name__: f for f in spec.helpers}, "figure": spec.figure})

    @cached_property
    def _cycle(self) -> tuple[np.ndarray, list[tuple[Element, ...]], int, bool]:
        """Angles of the driver, increasing; elements at each; the first shown; whether it turns fully."""
        if self.film is not None:
            return self._reel(self.film)
        start, step = self.variant.exercise.driver_angle(self.variant.given), 360.0 / self.count
        figure = self.variant.figure
        assert figure is not None  # what has none is refused at the start
        found = {0: figure.elements}
        for k in range(1, self.count):
            if (elements := self._elements(start + k * step)) is None:
                break
            found[k] = elements
        if len(found) == self.count:
            turned = math.floor((start % 360.0) / step + 1e-9)
            shown = [(k - turned) % self.count for k in range(self.count)]
            angles = (start % 360.0) + (np.arange(self.count) - turned) * step
            return angles, [found[k] for k in shown], turned, True
        closing = {start + k * step: elements for k, elements in found.items()}
        for k in range(-1, -self.count, -1):
            if (elements := self._elements(start + k * step)) is None:
                break
            closing[start + k * step] = elements
        for way, last in ((1, max(closing)), (-1, min(closing))):
            closing |= self._toward_limit(last, way * step, min(len(closing) - 1, 2))
        ordered = sorted(closing)
        return np.array(ordered), [closing[a] for a in ordered], ordered.index(start), False

    def _reel(self, film: Film) -> tuple[np.ndarray, list[tuple[Element, ...]], int, bool]:
        """The same for a film: from 0, by equal steps and a last one that may be shorter."""
        place = f"{self.variant.exercise.solution.source}: FILM"
        if film.speed not in self.variant.given:
            given = ", ".join(self.variant.given)
            raise BadCourse(f"{place}: speed={film.speed!r} is no given quantity; there are {given}")
        turns = self._stated("figure", film.turns, self.variant.given)
        if not isinstance(turns, (int, float)) or not 0 < turns <= MOST_TURNS:
            raise BadCourse(f"{place}: turns gives a number above 0, at most {MOST_TURNS}; found {turns!r}")
        if not isinstance(figure := self._stated("figure", film.figure, self._with_driver_at(0.0)), Figure):
            raise BadCourse(f"{place}: figure gives a Figure(…); found {figure!r}")
        steps = math.ceil(self.count * turns - 1e-9)
        angles = self._sign * np.array([*(360.0 / self.count * np.arange(steps)), 360.0 * turns])
        angles = angles[:: self._sign] + 0.0  # no negative zero
        first = 0 if self._sign > 0 else steps
        return angles, [self._elements_or_fault(angle) for angle in angles], first, True

    def _toward_limit(self, last: float, step: float, back: int) -> dict[float, tuple[Element, ...]]:
        """The limit beyond the last angle, and more angles before it, where the links turn as its square root."""
        limit, elements = self._limit(last, step)
        if abs(limit - last) < 1e-3 * abs(step):
            return {}
        run = limit - (last - back * step)
        more = {limit - run * (j / 10) ** 2: None for j in range(1, 10)}
        found = {angle: self._elements(angle) for angle in more}
        return {limit: elements} | {angle: one for angle, one in found.items() if one is not None}

    def _limit(self, angle: float, step: float) -> tuple[float, tuple[Element, ...]]:
        """The last angle that closes between one that does and the next, which does not."""
        inside, outside = 0.0, 1.0
        elements = self._elements_or_fault(angle)
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
        """The instant that the sheet shows; of a film the first one."""
        return self._cycle[2]

    @property
    def turns(self) -> bool:
        """Whether the driver turns fully; otherwise the mechanism swings between its limits."""
        return self._cycle[3]

    @property
    def closed(self) -> bool:
        """Whether the last instant is followed by the first as any by the next; neither in a swing nor in a film."""
        return self.turns and self.film is None

    @property
    def seconds(self) -> float:
        """How long a loop lasts on the screen."""
        return SECONDS * (1.0 if self.film is None else round(float(np.ptp(self.angles)) / 360.0, 3))

    @cached_property
    def order(self) -> tuple[int, ...]:
        """The instants of a loop, in time, from the sheet's own back to it; a film's from its first to its last."""
        count, first, sign = len(self.angles), self.first, self._sign
        if self.film is not None:
            return tuple(range(count))[::sign]
        if self.turns:
            return tuple((first + sign * k) % count for k in range(count + 1))
        there, back = [*range(first, count), *range(count - 2, -1, -1)], range(1, first + 1)
        loop = (*there, *back) if first else tuple(there)
        return loop if sign > 0 else loop[::-1]

    # --------------------------------------------------------------------- points

    @cached_property
    def points(self) -> Mapping[str, Moving]:
        """The points that the solution states, over the instants."""
        exercise = self.variant.exercise
        if not exercise.folder.has_solutions or exercise.solution.motion is None:
            return {}
        found = self._stated("motion", exercise.solution.motion, self._with_driver_at(self.angles))
        return {name: point.over(len(self.angles)) for name, point in found.items()}

    @cached_property
    def available(self) -> tuple[str, ...]:
        """The effects of which there is something to show: a path, a vector or a number."""
        drawn = {effect for _, effect, _ in self._vectors} | ({"position"} if self.points else set())
        return tuple(e for e in EFFECTS if e in drawn or any(e in r.effects for r in self.readings))

    @property
    def _vectors(self) -> list[tuple[str, str, np.ndarray]]:
        return [
            (name, effect, getattr(point, effect))
            for effect in EFFECTS[1:]
            for name, point in self.points.items()
            if getattr(point, effect) is not None
        ]

    @cached_property
    def scales(self) -> Mapping[str, float]:
        """Of vectors, for each effect: units for one mm of mechanism, one scale for the whole cycle.

        Coriolis terms are accelerations and have their scale.
        """
        low, high = extent(self.frames)
        size = max((high - low).real, (high - low).imag)
        found: dict[str, float] = {}
        for kind in (("velocity",), ("acceleration", "coriolis")):
            lengths = [np.abs(v[self._inside]) for _, effect, v in self._vectors if effect in kind]
            longest = max((float(np.nanmax(one)) for one in lengths), default=0.0)
            if longest > 0:
                found |= dict.fromkeys(kind, longest / (_LONGEST * size))
        return found

    @property
    def _inside(self) -> slice:
        """The instants that are no limits: at a limit the velocities do not exist."""
        return slice(None) if self.turns else slice(1, -1)

    # -------------------------------------------------------------------- picture

    def drawing(self, effects: Sequence[str]) -> Drawing:
        """Everything at every instant, with what these effects show."""
        arrows, spots = [], []
        for name, effect, v in self._vectors:
            if effect in effects and effect in self.scales:
                shown = np.full(v.shape, complex(np.nan, np.nan))
                shown[self._inside] = v[self._inside] / self.scales[effect]
                arrows.append(Arrow(self.points[name].position, shown, effect, name))
        if "position" in effects:
            spots = [Spot(point.position, name, self.closed) for name, point in self.points.items()]
        keys = self._keys({a.effect for a in arrows})
        return drawing(self.frames, arrows=arrows, spots=spots, keys=keys, closed=self.closed)

    def _keys(self, effects: set[str]) -> list[Key]:
        """The legend: for each effect an arrow of a round value."""
        low, high = extent(self.frames)
        said = words(self.variant.lang)["motion"]
        size, keys = max((high - low).real, (high - low).imag), []
        for effect in EFFECTS:
            if effect in effects:
                value = _round_below(0.25 * size * self.scales[effect])
                unit = unit_text(UNIT[effect], self.variant.lang)
                told = f"{said[effect]}{said['colon']} {self._number(value)} {unit}"
                keys.append(Key(effect, value / self.scales[effect], told))
        return keys

    def _number(self, value: float) -> str:
        return localise(significant(value), self.variant.lang) if math.isfinite(value) else ""

    @cached_property
    def title(self) -> str:
        return self.variant.text.title

    @cached_property
    def words(self) -> str:
        """What the picture shows, for those who cannot see it: the statement's own words, or the film's."""
        from coursework.language.typography import typeset

        section = (
            self.variant.text.section("figure")
            if self.film is None
            else self.variant.solution_text.section("motion")
        )
        said = " ".join(section.text.split())
        return typeset(said, self.variant.lang) or self.title

    def svg(self) -> str:
        """The moving figure as SVG with no script; it stands still for who wants no motion."""
        shown = self.drawing(self.effects)
        width, height = (f"{x:.6g}" for x in shown.size)
        times = self._key_times()
        lines = []
        for track in shown.tracks:
            if not track.moves:
                lines.append(track.svg(self.first))
                continue
            lines.append(track.svg(self.first, ' class="coursework-still"'))
            lines.append(
                track.svg(
                    self.first,
                    ' class="coursework-moving"',
                    _animate(track, self.order, times, self.seconds),
                )
            )
        return "\n".join([
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}" role="img" lang="{self.variant.lang}">',
            f"<title>{escape(self.title)}</title>",
            f"<desc>{escape(self.words)}</desc>",
            "<style>.coursework-still{display:none}@media (prefers-reduced-motion:reduce)"
            "{.coursework-still{display:inline}.coursework-moving{display:none}}</style>",
            f'<rect width="{width}" height="{height}" fill="#fff"/>',
            '<g fill="none" stroke="#000" stroke-linecap="round" stroke-linejoin="round">', *lines, "</g>",
            "</svg>\n",
        ])  # fmt: skip

    @cached_property
    def times(self) -> np.ndarray:
        """When each instant of a loop is reached, from 0 to 1: a turn goes steadily, a swing like a pendulum's."""
        if self.film is not None:
            gone = np.abs(self.angles - self.angles[self.first])[list(self.order)]
            return gone / gone[-1]
        if self.turns:
            return np.linspace(0.0, 1.0, len(self.order))
        low, high = self.angles[[0, -1]]
        phase = np.arccos(np.clip((2 * self.angles - low - high) / (low - high), -1.0, 1.0))
        steps = np.abs(np.diff(phase[list(self.order)]))
        return np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])

    def _key_times(self) -> str:
        """The same for SVG; nothing when they are evenly spread."""
        if np.ptp(np.diff(self.times)) < 1e-9:
            return ""
        return ";".join([*(f"{t:.5f}" for t in self.times[:-1]), "1"])

    def _repr_html_(self) -> str:
        return Picture(self.svg(), self.words).html

    # -------------------------------------------------------------------- numbers

    @cached_property
    def readings(self) -> tuple[Reading, ...]:
        """The numbers of what the effects show, over the instants; none in a course without solutions."""
        exercise = self.variant.exercise
        if not exercise.folder.has_solutions:
            return ()
        effects_of: dict[str, list[str]] = {}
        for effect in EFFECTS:
            for name in self._measured(effect):
                effects_of.setdefault(name, []).append(effect)
        found = {}
        if effects_of:
            posed = {} if self.film is not None else exercise.posed(self.variant.given, self.angles)
            given = {**self.variant.used, **posed}
            found = exercise.solve(**given, only=tuple(effects_of))
        told = [
            self._reading(
                exercise.solution.symbols.get(name) or exercise.symbol(name),
                exercise.units.get(name, "1"),
                effects_of[name],
                value,
            )
            for name, value in found.items()
        ]
        known = {reading.symbol for reading in told}
        if any("coriolis" in reading.effects for reading in told):
            known |= {_symbol("coriolis", name) for name in self.points}
        return (*told, *(r for r in self._norms() if r.symbol not in known))

    def _measured(self, effect: str) -> Sequence[str]:
        """The quantities of an effect: those of the scene; of a film, those asked, which keep their values."""
        exercise = self.variant.exercise
        if self.film is not None:
            parts = [p for p in exercise.spec.parts if p.sort.is_number]
            return [p.quantity for p in parts if p.unit in LEVELS[effect]]
        try:
            return Scene(exercise, self.variant.used, (effect,)).quantities
        except CourseworkError:
            return ()

    def _norms(self) -> list[Reading]:
        """The length of every vector, under the name that it has in the course."""
        return [
            self._reading(_symbol(effect, name), UNIT[effect], (effect,), np.abs(v), name)
            for name, effect, v in self._vectors
        ]

    def _reading(
        self, symbol: str, unit: str, effects: Sequence[str], value: Any, point: str = ""
    ) -> Reading:
        values = np.broadcast_to(value, self.angles.shape).astype(float)
        unit = unit_text(unit, self.variant.lang)
        # Rounding noise where a quantity vanishes is not worth its digits.
        noise = 1e-12 * float(np.nanmax(np.abs(values), initial=0.0))
        return Reading(
            symbol,
            unit,
            tuple(effects),
            point,
            tuple(self._number(0.0 if abs(v) < noise else v) for v in values),
        )


def _animate(track: Any, order: Sequence[int], times: str, seconds: float) -> str:
    values = ";".join(track.value(k) for k in order)
    timing = f' keyTimes="{times}"' if times else ""
    loop = f'dur="{seconds:g}s" repeatCount="indefinite"{timing} values="{values}"'
    if track.mark:
        return f'<animateTransform attributeName="transform" type="translate" {loop}/>'
    return f'<animate attributeName="d" {loop}/>'


def _symbol(effect: str, point: str) -> str:
    """LaTeX of a vector's length, as the course writes it: ``v_B``, ``a_{A,c}``."""
    index = f"{point},c" if effect == "coriolis" else point
    letter = "v" if effect == "velocity" else "a"
    return f"{letter}_" + (index if len(index) == 1 else f"{{{index}}}")


def _round_below(value: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not above a value."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-12)
    return max(m * power for m in (1, 2, 5) if m * power <= value * (1 + 1e-12))
