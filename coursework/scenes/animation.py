"""Animation of an exercise: its figure over the cycle of its driver, paths of points, and vectors.

The figure is the statement's own, asked again at every angle, unless the solution states a
:class:`~coursework.solution.Film` with one that can move. The points that leave a trace and carry vectors are
those of the solution's ``MECHANISM``, or of its function ``motion`` of quantities, called once with arrays
over the cycle::

    def motion(r2, theta2, omega2):
        A = polar(r2, theta2)
        return {"A": Moving(A, 1j * omega2 * A, -(omega2**2) * A)}
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from coursework.course.variant import Variant
from coursework.errors import WrongValue, unknown
from coursework.figures.base import Element
from coursework.figures.elements import bar
from coursework.figures.marks import angle_mark, dimension, line
from coursework.figures.moving import (
    PAPER_MM,
    Arrow,
    LegendKey,
    MovingDrawing,
    TracedPoint,
    drawing,
    extent,
    matched,
)
from coursework.figures.moving_svg import moving_svg, still_svgs
from coursework.language.numbers import unit_text
from coursework.language.words import words
from coursework.markup.shown import SvgPicture
from coursework.scenes.gauges import EFFECTS, UNIT, Gauge, gauges, number
from coursework.scenes.reel import Reel
from coursework.scenes.scenes import Scene
from coursework.solution import Moving

_FINER = 8  #: steps of a path for one of the instants
_LONGEST = 0.3  #: of the longest vector, over the size of the mechanism


def shown_by_motion(variant: Variant) -> tuple[str, ...]:
    """Return the ids of the parts whose answer one sees at a glance when the mechanism moves.

    Those are choices that hold for the whole cycle, such as whether a guide rotates; where a film of the
    solution moves in place of the figure, all parts. What is read from a figure to scale with a ruler is not
    among them.
    """
    exercise = variant.exercise
    if exercise.film is not None:
        return tuple(part.id for part in variant.parts if not part.sort.is_open)
    if exercise.spec.driver is None:
        return ()
    graph, given = exercise.solution.graph, exercise.spec.given
    sizes = [name for name in given if name != exercise.spec.driver.moved]
    of_cycle = graph.descendants(sizes) - graph.descendants((exercise.spec.driver.moved,))
    return tuple(p.id for p in variant.parts if p.choices and p.quantity in of_cycle)


class Animation(Reel):
    """Animation of a variant's mechanism over the cycle of its driver, or over the turns of its film.

    Parameters
    ----------
    variant
        Of an exercise that names a driver and a figure, or whose solution states a film.
    effects
        What is seen from the start: ``position`` (paths of points), ``velocity``, ``acceleration``,
        ``coriolis``; by default paths alone.
    count
        Angles in a turn of the driver.

    Raises
    ------
    BadCourse
        The exercise names no driver or no figure, and the solution states no film.
    UnknownName
        An effect that is none of the four.
    WrongValue
        An effect of which the solution states nothing.
    """

    def __init__(self, variant: Variant, effects: Sequence[str] = (), count: int = 72):
        super().__init__(variant, count)
        for effect in effects:
            if effect not in EFFECTS:
                raise unknown("effect", effect, EFFECTS, variant.exercise.name)
            if effect != "position" and effect not in self.available:
                raise WrongValue(
                    "{exercise}: no {effect} to show; {source} states none in motion(…)",
                    exercise=variant.exercise.name,
                    effect=effect,
                    source=variant.exercise.folder.source("solutions", variant.exercise.name),
                )
        self.effects = tuple(e for e in EFFECTS if e in effects) or ("position",)

    # --------------------------------------------------------------------- points

    @cached_property
    def points(self) -> Mapping[str, Moving]:
        """Points over the instants: of those that the solution states, the ones that the figure names; in a
        film, whose words name them, all."""
        return self._points_at(self.angles)

    def _points_at(self, angles: np.ndarray) -> Mapping[str, Moving]:
        named = {getattr(element, "label", "") for element in self.frames[self.first]}
        moving = self.stated_points(angles)
        return {n: point for n, point in moving.items() if self.film is not None or n in named}

    def stated_points(self, angles: np.ndarray) -> Mapping[str, Moving]:
        """Return all points that the solution moves, at angles of the driver, degrees, shape ``(n,)``."""
        solution = self.variant.exercise.solution
        if solution.motion is not None:
            stated = self._stated("motion", solution.motion, self._with_driver_at(angles))
            return {name: point.over(len(angles)) for name, point in stated.items()}
        if solution.mechanism is not None:
            return Scene(self.variant.exercise, self.variant.given).moving_points(angles)
        return {}

    @cached_property
    def _paths(self) -> Mapping[str, np.ndarray]:
        """Ways of the points, at finer steps than the instants."""
        stops = np.append(self.angles, self.angles[0] + 360.0) if self.closed else self.angles
        fine = np.interp(np.arange((len(stops) - 1) * _FINER + 1) / _FINER, np.arange(len(stops)), stops)
        return {name: point.position for name, point in self._points_at(fine).items()}

    @cached_property
    def crank(self) -> tuple[complex, np.ndarray] | None:
        """Pivot of the driver, and a point that turns with it at every instant, mm; None where the figure
        draws none.

        A named point comes before another, and one farther from the pivot before a nearer.
        """
        named = [point.position for point in self.points.values()]
        turned = np.exp(1j * np.radians(self.angles))
        for ways in (named, self._drawn_points()):
            arms = [
                (abs(arm), pivot, way) for way in ways for pivot, arm in [turning_arm(way, turned)] if arm
            ]
            if arms:
                _, pivot, way = max(arms, key=lambda item: item[0])
                return pivot, way
        return None

    def _drawn_points(self) -> list[np.ndarray]:
        """Return the points of what is drawn at every instant, each over the instants, mm, shape ``(n,)``."""
        columns = zip(*matched(self.frames), strict=True)
        reaches = ([element.reach() for element in column] for column in columns)
        return [
            np.array(way)
            for reach in reaches
            if len({*map(len, reach)}) == 1
            for way in zip(*reach, strict=True)
        ]

    @cached_property
    def readings(self) -> tuple[Gauge, ...]:
        """Values of the effects' quantities over the instants; none in a course without solutions."""
        return gauges(self, self._vectors)

    @cached_property
    def available(self) -> tuple[str, ...]:
        """Effects with something to show: a path, a vector or a number."""
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
        """Scale of the vectors of each effect: units for one mm of mechanism, the same for the whole cycle.

        Coriolis terms are accelerations and have their scale.
        """
        low, high = extent(self.frames)
        size = max((high - low).real, (high - low).imag)
        results: dict[str, float] = {}
        for kind in (("velocity",), ("acceleration", "coriolis")):
            lengths = [np.abs(v[self._inside]) for _, effect, v in self._vectors if effect in kind]
            longest = max((float(np.nanmax(item)) for item in lengths), default=0.0)
            if longest > 0:
                results |= dict.fromkeys(kind, longest / (_LONGEST * size))
        return results

    @property
    def _inside(self) -> slice:
        """Instants that are not limits: at a limit the velocities do not exist."""
        return slice(None) if self.turns else slice(1, -1)

    # -------------------------------------------------------------------- picture

    def drawing(
        self,
        effects: Sequence[str],
        paper_mm: tuple[float, float] = PAPER_MM,
        instants: Sequence[int] = (),
    ) -> MovingDrawing:
        """Return the drawing with the vectors and paths of these effects, in a box of this size: over all
        instants, or at a few, without the letters of lengths and angles, since the box has no room for them.
        """
        at: slice | list[int] = list(instants) or slice(None)
        frames = [_without_sizes(self.frames[k]) for k in instants] or self.frames
        arrows, spots = [], []
        for name, effect, v in self._vectors:
            if effect in effects and effect in self.scales:
                displayed = np.full(v.shape, complex(np.nan, np.nan))
                displayed[self._inside] = v[self._inside] / self.scales[effect]
                arrows.append(Arrow(self.points[name].position[at], displayed[at], effect, name))
        if "position" in effects:
            spots = [
                TracedPoint(point.position[at], name, self.closed, self._paths[name])
                for name, point in self.points.items()
            ]
        keys = self._keys({a.effect for a in arrows})
        return drawing(
            frames,
            arrows=arrows,
            spots=spots,
            keys=keys,
            closed=self.closed and not instants,
            paper_mm=paper_mm,
        )

    def _keys(self, effects: set[str]) -> list[LegendKey]:
        """Return the legend: an arrow of a round value for each effect."""
        low, high = extent(self.frames)
        texts = words(self.variant.lang)["motion"]
        size, keys = max((high - low).real, (high - low).imag), []
        for effect in EFFECTS:
            if effect in effects:
                value = _round_below(0.25 * size * self.scales[effect])
                unit = unit_text(UNIT[effect], self.variant.lang)
                text = f"{texts[effect]}{texts['colon']} {number(value, self.variant.lang)} {unit}"
                keys.append(LegendKey(effect, value / self.scales[effect], text))
        return keys

    @cached_property
    def title(self) -> str:
        return self.variant.text.title

    @cached_property
    def words(self) -> str:
        """Description of the picture for readers who cannot see it: the statement's own words, or the
        film's."""
        from coursework.language.typography import typeset

        section = (
            self.variant.text.section("figure")
            if self.film is None
            else self.variant.solution_text.section("motion")
        )
        text = " ".join(section.text.split())
        return typeset(text, self.variant.lang) or self.title

    def svg(self, effects: Sequence[str] | None = None) -> str:
        """Return the moving figure as SVG without scripts, with its effects or with others; it stands still
        for readers who prefer reduced motion."""
        return moving_svg(
            self.drawing(self.effects if effects is None else effects),
            order=self.order,
            first=self.first,
            seconds=self.seconds,
            times=self._key_times(),
            title=self.title,
            words=self.words,
            lang=self.variant.lang,
        )

    def stills(self, count: int, paper_mm: tuple[float, float]) -> tuple[str, ...]:
        """Return ``count`` instants of the cycle as SVG, evenly spread, the statement's first, each in a box
        of this size."""
        instants = [self._instant_after(k / count) for k in range(count)]
        displayed = self.drawing(self.effects, paper_mm, instants)
        return still_svgs(displayed, title=self.title, words=self.words, lang=self.variant.lang)

    def _instant_after(self, share: float) -> int:
        """Return the instant nearest to a share of the cycle after the first."""
        count = len(self.angles)
        if not self.closed:
            return (self.first + round(share * count)) % count
        away = (self.angles - self.angles[self.first] - 360.0 * share + 180.0) % 360.0 - 180.0
        return int(np.abs(away).argmin())

    def _key_times(self) -> str:
        """Return the times as SVG key times; empty when they are evenly spread."""
        if np.ptp(np.diff(self.times)) < 1e-9:
            return ""
        return ";".join([*(f"{t:.5f}" for t in self.times[:-1]), "1"])

    def _repr_html_(self) -> str:
        return SvgPicture(self.svg(), self.words).html


def _without_sizes(frame: Sequence[Element]) -> tuple[Element, ...]:
    """Return a figure without its angles and the letters of its lengths; points keep their names, bodies
    their numbers."""
    stored = (item for item in frame if not isinstance(item, (angle_mark, dimension)))
    return tuple(
        replace(item, label=None)
        if isinstance(item, (bar, line)) and item.label and not item.label.isdigit()
        else item
        for item in stored
    )


def turning_arm(way: np.ndarray, turned: np.ndarray) -> tuple[complex, complex]:
    """Return centre and arm of a point that turns with a body, by least squares; an arm of 0 where it does
    not.

    ``turned`` are the body's directions over the instants, unit complex numbers, shape ``(n,)`` as ``way``,
    mm.
    """
    around = np.stack([np.ones_like(turned), turned], axis=-1)
    pivot, arm = np.linalg.lstsq(around, way, rcond=None)[0]
    size = abs(way - way.mean()).max()
    turns = abs(around @ np.array([pivot, arm]) - way).max() < 1e-6 * size
    return complex(pivot), complex(arm) if turns else 0j


def _round_below(value: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that does not exceed a value."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-12)
    return max(m * power for m in (1, 2, 5) if m * power <= value * (1 + 1e-12))
