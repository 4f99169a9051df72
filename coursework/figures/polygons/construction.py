"""Construction of a polygon on paper, to scale and step by step, with known and measured values.

Every number comes from the polygon itself.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

from coursework.figures import Beginning, Element, Figure, line, point, scale_bar, vector
from coursework.figures.polygons.polygon import Polygon, Side, Stage
from coursework.language.numbers import localise, rounded, significant, unit_text
from coursework.language.words import languages, listed, no_language, words

BOX_MM = (110.0, 90.0)  #: width and height of a whole drawing on paper
SCALES = {"velocity": "k_v", "acceleration": "k_a", "position": "k_l"}
_SYMBOLS_MM = (24.0, 26.0)  #: of the box: what labels, ends of lines and the bar of the scale take
_SMALL_MM = (38.0, 30.0)  #: the points of a drawing of a step
_BEYOND = (3.0, 5.0)  #: mm by which a line passes its ends, on the drawing of a step and on the whole
_BAR_MM = 20.0
_NAMES = 10  #: of vectors that a drawing bears; where there are more, the points tell them
_SAME = 0.25  #: mm on paper under which two points are one


@dataclass(frozen=True)
class SideRow:
    """Table row of a side: its data before the drawing, its measured length and direction after."""

    name: str  #: LaTeX of the vector
    direction: str  #: LaTeX; empty when it is not known
    length: str  #: LaTeX; empty when it is not known
    segment: str  #: LaTeX of the side on paper, ``p_v\\,a``
    paper: str  #: mm on paper, as the language prints it
    value: str  #: mm/s or mm/s^2, as the language prints it


@dataclass(frozen=True)
class ConstructionStep:
    """Step of the construction: its text and its drawing."""

    number: int
    text: str  #: Markdown
    figure: Beginning  #: all that is drawn up to here, small


class Construction:
    """Drawing of a polygon in a language: a figure at true scale, steps, a table.

    As the last line of a notebook's cell it shows all of them.

    Parameters
    ----------
    polygon
        What is drawn; something moves in it.
    lang
        Language of the words and the numbers.
    """

    def __init__(self, polygon: Polygon, lang: str = "fr"):
        if lang not in languages():
            raise no_language(lang)
        self.polygon = polygon
        self.lang = lang

    def __repr__(self) -> str:
        return f"<{self.polygon.kind} polygon, {self.scale:g} {self.polygon.unit} for 1 mm>"

    @property
    def _texts(self) -> dict[str, str]:
        return words(self.lang)["polygons"]

    @property
    def title(self) -> str:
        """Title of the polygon: ``Velocity polygon``."""
        return self._texts[self.polygon.kind]

    @cached_property
    def scale(self) -> float:
        """Scale in mm/s or mm/s^2 for a mm on paper: the exercise's own, or 1, 2 or 5 times a power of
        ten."""
        room = (full - used for full, used in zip(BOX_MM, _SYMBOLS_MM, strict=True))
        return self.polygon.scale or self.polygon.scale_in(*room)

    @property
    def opening(self) -> str:
        """Introduction of the table, Markdown."""
        return self._texts["opening"]

    @property
    def equations(self) -> tuple[str, ...]:
        """LaTeX of the equations that the drawing solves."""
        return self.polygon.equations

    @property
    def scale_text(self) -> str:
        r"""Markdown of the scale: ``$k_v = 20$ mm/s for 1 mm``."""
        value = rf"${SCALES[self.polygon.kind]} = \num{{{significant(self.scale)}}}$"
        return self._texts["scale"].format(value, self.unit)

    @property
    def unit(self) -> str:
        return unit_text(self.polygon.unit, self.lang)

    # ------------------------------------------------------------------------ table

    @property
    def rows(self) -> tuple[SideRow, ...]:
        """The sides, in the order of the construction."""
        return tuple(
            SideRow(
                side.name,
                side.direction,
                side.length,
                f"{side.start}\\,{side.end}",
                self._number(f"{rounded(abs(side.value) / self.scale, 1):.1f}"),
                self._number(significant(abs(side.value), 4)),
            )
            for side in self.polygon.sides
        )

    def _number(self, text: str) -> str:
        return localise(text, self.lang)

    # ---------------------------------------------------------------------- figures

    @cached_property
    def figure(self) -> Figure:
        """The whole polygon at :attr:`scale`: a mm of it is a mm on paper.

        Its vectors bear their names where they are few.
        """
        corner = self.polygon.extent()[0] / self.scale
        value = _BAR_MM * self.scale
        text = f"{self._number(significant(value))} {self.unit}"
        bar = scale_bar(corner - 10j, _BAR_MM, text)
        named = len(self.polygon.sides) <= _NAMES
        drawn = _Drawing(self.polygon, self.scale, _BEYOND[1], named=named)
        return Figure(*drawn.elements, bar, paper_mm=BOX_MM, scale=1)

    @cached_property
    def steps(self) -> tuple[ConstructionStep, ...]:
        """Steps of the construction, each with a small drawing of its state."""
        low, high = self.polygon.extent()
        size = high - low
        scale = max(size.real / _SMALL_MM[0], size.imag / _SMALL_MM[1])
        drawn = _Drawing(self.polygon, scale, _BEYOND[0], named=False)
        full = Figure(*drawn.elements, scale=1)
        steps: list[ConstructionStep] = []
        for stage, count in zip(self.polygon.stages, drawn.counts, strict=True):
            text = self._stage_text(stage)
            if stage.kind == "result" and steps:
                # Vectors that join points already found are not a step of their own.
                text = f"{steps.pop().text} {text}"
            steps.append(ConstructionStep(len(steps) + 1, text, full.beginning(count)))
        return tuple(steps)

    def _stage_text(self, stage: Stage) -> str:
        """Return the text of a stage."""
        text = " ".join(self._sentences(stage))
        if stage is not self.polygon.stages[0]:
            return text
        return f"{self._texts['pole'].format(f'${self.polygon.pole}$')} {text}"

    def _sentences(self, stage: Stage) -> Iterator[str]:
        texts = self._texts
        if stage.kind == "known":
            # A vector between two points of which its end is found first is laid off backwards.
            results = list(zip(stage.sides, stage.points, strict=True))
            for backwards, run in groupby(results, lambda item: item[1] == item[0].start):
                sides, points = zip(*run, strict=True)
                if not backwards:
                    yield texts["known"].format(
                        vectors=self._listed(s.name for s in sides), points=self._listed(points)
                    )
                for side in sides if backwards else ():
                    yield texts["ending"].format(
                        vector=f"${side.name}$", end=f"${side.end}$", point=f"${side.start}$"
                    )
        elif stage.kind == "result":
            for side in stage.sides:
                yield texts["result"].format(
                    start=f"${side.start}$", end=f"${side.end}$", vector=f"${side.name}$"
                )
        else:
            first, last = stage.sides[0], stage.sides[-1]
            yield texts[stage.kind].format(
                points=self._listed(stage.points) if stage.points else "",
                through=f"${stage.through}$",
                direction=f"${last.direction}$",
                vector=f"${last.name}$",
                first=f"${first.name}$",
            )

    def _listed(self, names: Iterable[str]) -> str:
        return listed((f"${name}$" for name in names), self.lang)

    def svg(self) -> str:
        """Return the whole polygon as SVG, at true size."""
        return self.figure.svg()

    def _repr_svg_(self) -> str:
        return self.figure.outlined_svg()


class _Drawing:
    """Elements of a polygon at a scale, in the order of drawing."""

    def __init__(self, polygon: Polygon, scale: float, beyond: float, *, named: bool):
        self.at = {name: z / scale for name, z in polygon.points.items()}
        self.polygon = polygon
        self.beyond = beyond
        self.named = named
        self.shown: set[str] = set()
        self.elements: list[Element] = [*self._points((polygon.pole,))]
        self.counts: list[int] = []  #: of elements that each stage has come to
        for stage in polygon.stages:
            self.elements += self._stage(stage)
            self.counts.append(len(self.elements))

    def _stage(self, stage: Stage) -> Iterator[Element]:
        if stage.kind in ("line", "crossing"):
            yield self._line(stage.sides[-1])
        if stage.kind != "line":
            for side in stage.sides:
                yield from self._arrow(side)
        yield from self._points(stage.points)

    def _line(self, side: Side) -> Element:
        """Return the line of a side, which passes both its ends."""
        p, q = self.at[side.start], self.at[side.end]
        ahead = self.beyond * side.along * (1 if (side.value * side.along.conjugate()).real >= 0 else -1)
        return line(p - ahead, q + ahead, dashed=True)

    def _arrow(self, side: Side) -> Iterator[Element]:
        p, q = self.at[side.start], self.at[side.end]
        if abs(q - p) > _SAME:
            yield vector(p, q - p, side.name if self.named else None)

    def _points(self, names: Iterable[str]) -> Iterator[Element]:
        """Yield the dots; points that coincide on paper share one dot with all their names."""
        for name in names:
            if name in self.shown:
                continue
            there = [other for other in self.at if abs(self.at[other] - self.at[name]) <= _SAME]
            self.shown |= {*there}
            yield point(self.at[name], r",\ ".join(there), self._outward(name))

    def _outward(self, name: str) -> float | None:
        """Return the direction away from the sides that meet at a point, degrees."""
        ways = 0j
        for side in self.polygon.sides:
            if name in (side.start, side.end):
                ways += side.along if side.start == name else -side.along
        return None if abs(ways) < 1e-6 else math.degrees(cmath.phase(-ways))
