"""Figure of a mechanism: code that draws its bodies, joints and driver to scale."""

from __future__ import annotations

from cmath import phase
from itertools import pairwise

from coursework.linkages.entries import GROUND, SlideEntry
from coursework.linkages.formulas import FormulaWriter
from coursework.linkages.points import middle_value
from coursework.linkages.terms import Heading


class FigureWriter:
    """Writer of the figure.

    Parameters
    ----------
    formulas
        The quantities of the mechanism.
    """

    def __init__(self, formulas: FormulaWriter) -> None:
        self.formulas, self.linkage = formulas, formulas.linkage
        self.elements: list[str] = []
        self._guides = {s.on for s in self.linkage.slides.values()}
        self._blocks = {
            s.of
            for s in self.linkage.slides.values()
            if len(self.linkage.bodies[s.of].points) == 1 and s.of not in self._guides
        }
        self._ground()
        for body in self.linkage.bodies:
            if body == self.linkage.jack:
                self._jack(body)
            else:
                self._body(body)
        for slide in self.linkage.slides.values():
            self._slide(slide)
        self._gears()
        self._joints()
        self._driver()

    @property
    def code(self) -> str:
        """The figure as code of one call."""
        return "Figure(\n        " + ",\n        ".join(self.elements) + ",\n    )"

    def _add(self, element: str) -> None:
        self.elements.append(element)

    def _at(self, point: str) -> str:
        return self.formulas.complex(point)

    def _ground(self) -> None:
        """Draw the frame between two fixed pivots where its length is a quantity."""
        points = [p for p in self.linkage.ground if p in self.linkage.pins]
        for start, end in pairwise(points):
            first, second = self.linkage.ground[start], self.linkage.ground[end]
            if first.is_origin and second.radius is None and second.y.is_zero and second.x.is_name:
                self._add(
                    f"line({self._at(start)}, {self._at(end)}, dashed=True, "
                    f'label=r"{self.formulas.symbol(second.x.code)}")'
                )

    def _body(self, body: str) -> None:
        points = [
            p for p in self.linkage.bodies[body].points if p in self.linkage.pins or self._is_end(p, body)
        ]
        if body in self._guides:
            self._guide(body, points)
        elif body not in self._blocks and len(points) > 1:
            self._plate(body, points)

    def _jack(self, body: str) -> None:
        """Draw the cylinder, and the rod that comes out of it."""
        start, end = map(self._at, self.linkage.bodies[body].points)
        middle = f"{start} + 0.6 * ({end} - {start})"
        self._add(f"slot_link({start}, {middle})")
        self._add(f'link({middle}, {end}, label=r"{self.formulas.symbol(self.linkage.moved)}")')

    def _plate(self, body: str, points: list[str]) -> None:
        formulas = self.formulas
        if len(points) == 2:
            arm = formulas.arm(body, *points)
            label = (
                f', label=r"{formulas.symbol(arm.length.code)}"'
                if arm.length.code in self.linkage.given
                else ""
            )
            self._add(f"link({self._at(points[0])}, {self._at(points[1])}{label})")
            return
        places = {p: middle_value(formulas.local(p, body), self.linkage) for p in points}
        centre = sum(places.values()) / len(places)
        flat = max(
            abs(((z - centre).conjugate() * (w - centre)).imag)
            for z in places.values()
            for w in places.values()
        )
        size = max(abs(z - centre) for z in places.values()) or 1.0
        if flat < 0.02 * size**2:
            way = max((z - centre for z in places.values()), key=abs)
            ordered = sorted(points, key=lambda p: ((places[p] - centre) / way).real)
            for start, end in pairwise(ordered):
                self._add(f"link({self._at(start)}, {self._at(end)})")
            return
        ordered = sorted(points, key=lambda p: phase(places[p] - centre))
        self._add(f"link({', '.join(map(self._at, ordered))})")

    def _is_end(self, point: str, body: str) -> bool:
        """Return whether a point that is not a pin is drawn as the end of its body: a tracer point, or one
        that slides."""
        return (
            body not in self._blocks
            and len(self.linkage.bodies[body].points) > 1
            and point in self.linkage.bodies[body].points
        )

    def _guide(self, body: str, points: list[str]) -> None:
        """Draw a slotted body: its slot as far as the block and its own points go, and bars to points off
        it."""
        slide = next(s for s in self.linkage.slides.values() if s.on == body)
        unit = f"polar(1, {(self.formulas.heading(body) + Heading.of(slide.along.code)).code})"
        start = self._through(slide)
        if len(self.linkage.bodies[body].points) == 1:
            reach = f"1.25 * {self._crank} * {unit}"
            self._add(f"slot_link({start} - {reach}, {start} + {reach})")
            return
        straight = slide.along.is_zero and slide.through.is_origin
        places = {p: self.formulas.local(p, body) for p in points}
        # A bar leads to a point of the line that lies behind the slot's beginning.
        on_line = [
            p
            for p, place in places.items()
            if straight and place.y.vanishes and middle_value(place, self.linkage).real >= 0
        ]
        lengths = [f"1.25 * max(abs({self._at(slide.at)} - {start}), 1.0)"]
        lengths += [f"abs({self._at(p)} - {start})" for p in on_line if p != slide.through_name]
        length = f"max({', '.join(lengths)})" if len(lengths) > 1 else lengths[0]
        self._add(f"slot_link({start}, {start} + {unit} * {length})")
        off = [p for p in points if p not in on_line]
        if off and len(points) > 1:
            self._plate(body, [*dict.fromkeys([on_line[0] if on_line else points[0], *off])])
        if not on_line:
            self._add(f"link({self._at(self.linkage.bodies[body].at)}, {start})")

    @property
    def _crank(self) -> str:
        """Length of the driving body, or where that is a slider of the first bar, as code."""
        linkage, local = self.linkage, self.formulas.local
        for body in (linkage.driver, *linkage.bodies):
            points = linkage.bodies[body].points
            start = linkage.bodies[body].at if linkage.bodies[body].at in points else next(iter(points))
            for end in points:
                if middle_value(local(end, body) - local(start, body), linkage):
                    return f"abs({self._at(end)} - {self._at(start)})"
        return "0.0"

    def _through(self, slide: SlideEntry) -> str:
        if slide.through_name:
            return self._at(slide.through_name)
        return f"({self.formulas.world(slide.through, slide.on).complex})"

    def _slide(self, slide: SlideEntry) -> None:
        heading = self.formulas.heading(slide.on) + Heading.of(slide.along.code)
        place = self._at(slide.at)
        if slide.on == GROUND:
            half = f"0.6 * {self._crank} * polar(1, {heading.code})"
            self._add(f"rail({place} - {half}, {place} + {half})")
        self._add(f"slider({place}, {heading.code})")

    def _joints(self) -> None:
        for point in self.linkage.points:
            if point in self.linkage.pins:
                kind = "ground_pivot" if point in self.linkage.ground else "pin"
                self._add(f'{kind}({self._at(point)}, "{_label(point)}")')
            elif (
                any(self._is_end(point, b) for b in self.linkage.holders(point) if b != GROUND)
                or point in self.linkage.slides
            ):
                self._add(f'point({self._at(point)}, "{_label(point)}")')

    def _gears(self) -> None:
        """Draw the pitch circles."""
        for gear in self.linkage.gears:
            for body, radius in zip((gear.first, gear.second), gear.radii, strict=True):
                shared = [p for p, b in self.linkage.pins.items() if body in b and gear.carrier in b]
                if shared:
                    self._add(f"circle({self._at(shared[0])}, {radius.code}, dashed=True)")

    def _driver(self) -> None:
        if self.linkage.jack:
            return
        if self.linkage.drive.kind == "slide":
            slide = self.linkage.slides[self.linkage.slides_driven]
            label = self.formulas.symbol(slide.distance)
            self._add(f'line({self._through(slide)}, {self._at(slide.at)}, dashed=True, label=r"{label}")')
            return
        start, angle = self._at(self.linkage.bodies[self.linkage.driver].at), self.linkage.moved
        self._add(f"line({start}, {start} + 0.6 * {self._crank}, dashed=True)")
        self._add(f'angle_mark({start}, 0, {angle}, r"{self.formulas.symbol(angle)}")')


def _label(point: str) -> str:
    return point if len(point) == 1 else f"{point[0]}_{point[1:]}"
