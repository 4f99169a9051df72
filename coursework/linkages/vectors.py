"""Velocity and acceleration polygons of a mechanism: code that states their sides, group by group."""

from __future__ import annotations

from collections.abc import Iterator

from coursework.linkages.formulas import FormulaWriter
from coursework.linkages.groups import Dyad
from coursework.linkages.linkage_file import GROUND, SlideEntry
from coursework.linkages.terms import Heading
from coursework.messages import Message


class PolygonWriter:
    """Writer of the polygons.

    Parameters
    ----------
    formulas
        The quantities of the mechanism.

    Raises
    ------
    BadInput
        A group of which no polygon is drawn: a slide on a body that moves, or a group of class III and above.
    """

    def __init__(self, formulas: FormulaWriter) -> None:
        self.formulas, self.linkage = formulas, formulas.linkage

    def code(self, kind: str) -> str:
        """Return a polygon, ``velocity`` or ``acceleration``, as code."""
        name = {"velocity": "polygon_of_velocities", "acceleration": "polygon_of_accelerations"}[kind]
        pieces = [f"({', '.join(sides)},)" for sides in self._pieces(kind) if sides]
        return f"{name}({', '.join(pieces)})"

    def _pieces(self, kind: str) -> Iterator[list[str]]:
        drawn: set[str] = set()
        driver = self.linkage.driver
        yield from self._carried(driver, kind, drawn)
        for group in self.formulas.groups:
            if not isinstance(group, Dyad) or group.kind not in ("RRR", "RRP"):
                raise self.linkage.refused(
                    ("ask", "polygon"),
                    Message("polygons are drawn of pairs of bars, and of sliders on fixed guides"),
                )
            inner, start = str(group.inner), str(group.outer_p)
            if isinstance(group.outer_q, SlideEntry):
                yield self._slider(group, group.outer_q, kind)
            else:
                yield self._bars(group, start, inner, str(group.outer_q), kind)
            drawn.add(inner)
            for body in group.bodies:
                yield from self._carried(body, kind, drawn)

    def _carried(self, body: str, kind: str, drawn: set[str]) -> Iterator[list[str]]:
        """Yield the sides of the joints that a body carries beside those that are drawn."""
        start = self.formulas.reference[body]
        for point in self.linkage.bodies[body].points:
            if (
                point in drawn
                or point == start
                or point in self.linkage.ground
                or point not in self.linkage.pins
            ):
                continue
            drawn.add(point)
            yield self._about(body, start, point, kind, "")

    def _about(self, body: str, start: str, end: str, kind: str, primes: str) -> list[str]:
        """Return the sides from the image of a point of a body to that of another; without ``primes`` they are known, since the motion
        of the body is."""
        vector, line, of = self._vector(start, end), start + end, self._of(start, end)
        begin, image = self._image(start, kind), end.lower()
        omega, alpha = self.formulas.omega(body), self.formulas.alpha(body)
        rate, gain = self.formulas.symbol(omega), self.formulas.symbol(alpha) if alpha != "0" else ""
        if kind == "velocity":
            length = "" if primes else rf', r"{line} \left|{rate}\right|"'
            return [f"turning({begin!r}, {image!r}, {of!r}, {line!r}, {vector}, {omega}{length})"]
        square = rf"{line}\,{rate}^2"
        if not primes and not gain:
            return [f'normal({begin!r}, {image!r}, {of!r}, {line!r}, {vector}, {omega}, r"{square}")']
        middle = image + (primes or "'")
        length = "" if primes else rf', r"{line} \left|{gain}\right|"'
        return [
            f'normal({begin!r}, "{middle}", {of!r}, {line!r}, {vector}, {omega}, r"{square}")',
            f'tangential("{middle}", {image!r}, {of!r}, {line!r}, {vector}, {alpha}{length})',
        ]

    def _bars(self, group: Dyad, start: str, inner: str, end: str, kind: str) -> list[str]:
        first = self._about(group.p, start, inner, kind, "'")
        second = self._about(group.q, end, inner, kind, "''")
        if kind == "velocity":
            return [*first, *second]
        return [first[0], second[0], first[1], second[1]]

    def _slider(self, group: Dyad, slide: SlideEntry, kind: str) -> list[str]:
        if slide.on != GROUND:
            raise self.linkage.refused(
                ("ask", "polygon"), Message("polygons are drawn of sliders on fixed guides; this guide moves")
            )
        B = str(group.inner)
        way = f"polar(1, {Heading.of(slide.along.code).code})"
        letter, ending, pole = ("V", "_dot", "p_v") if kind == "velocity" else ("a", "_ddot", "p_a")
        value = f"{slide.distance}{ending} * {way}"
        line = rf'Side("{pole}", {B.lower()!r}, r"\vec{{{letter}}}_{{{B}}}", {value}, r"\parallel {B}x", way={way})'
        return [*self._about(group.p, str(group.outer_p), B, kind, "'"), line]

    def _vector(self, start: str, end: str) -> str:
        ends = [(self.formulas.at(p).x.code, self.formulas.at(p).y.code) for p in (start, end)]
        return f"complex({ends[1][0]}, {ends[1][1]}) - complex({ends[0][0]}, {ends[0][1]})"

    def _image(self, point: str, kind: str) -> str:
        if point in self.linkage.ground:
            return "p_v" if kind == "velocity" else "p_a"
        return point.lower()

    def _of(self, start: str, end: str) -> str:
        return end if start in self.linkage.ground else f"{end}/{start}"
