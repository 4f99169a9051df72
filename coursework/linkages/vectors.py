"""Velocity and acceleration polygons of a mechanism: their sides as code, and the questions about the
drawing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from coursework.linkages.entries import GROUND, SlideEntry
from coursework.linkages.formulas import FormulaWriter
from coursework.linkages.groups import Dyad, Wheel
from coursework.linkages.points import Quantity, UsualMistake, names_in
from coursework.linkages.terms import Heading, is_zero

PAPER_MM = (160, 90)  #: the box of millimetre paper to draw in
POLYGONS = {
    "velocity": "polygon_of_velocities",
    "acceleration": "polygon_of_accelerations",
}  #: each by what draws it
_POLES = {"velocity": "p_v", "acceleration": "p_a"}


@dataclass(frozen=True)
class DrawnSide:
    """Side of a polygon: the image points at its ends, its name in LaTeX, whether it is known or a line, the
    code of its vector and of the direction of its line, and the call that states it."""

    start: str
    end: str
    name: str
    is_known: bool
    value: str
    way: str
    call: str


class PolygonWriter:
    """Writer of a polygon.

    Parameters
    ----------
    formulas
        The quantities of the mechanism.
    kind
        ``velocity`` or ``acceleration``.

    Raises
    ------
    BadInput
        A group of which no polygon is drawn: one of class III and above.
    """

    def __init__(self, formulas: FormulaWriter, kind: str) -> None:
        self.formulas, self.linkage, self.kind = formulas, formulas.linkage, kind
        self.letter = kind[0]  #: before the names of its parts
        self.scale = f"k{kind[0]}"
        self.pole = _POLES[kind]
        self._turned: set[str] = set()  #: ends of the Coriolis accelerations
        self._alias: dict[str, str] = {}  #: images of points that move as another does
        self.pieces = [piece for piece in self._pieces() if piece]
        self.sides = [side for piece in self.pieces for side in piece]

    def code(self, scale: str) -> str:
        """Return the polygon at a scale, as code."""
        pieces = [f"({', '.join(side.call for side in piece)},)" for piece in self.pieces]
        return f"{POLYGONS[self.kind]}({', '.join(pieces)}, scale={scale})"

    # -------------------------------------------------------------------- sides

    def _pieces(self) -> Iterator[list[DrawnSide]]:
        drawn: set[str] = set()
        yield from self._driven(drawn)
        for group in self.formulas.groups:
            match group:
                case Dyad(kind="RPR", outer_p=str(found), inner=SlideEntry() as slide):
                    yield self._guided(group, slide)
                case Dyad(kind="RRR", inner=str(found)):
                    yield self._met(*self._ends(group, found))
                case Dyad(kind="RRP", inner=str(found), outer_q=SlideEntry() as slide):
                    known, relative = self._sliding(slide, group.q, found)
                    yield known
                    yield self._met(self._about(group.p, str(group.outer_p), found, "'"), relative)
                case Dyad(
                    kind="PRP", inner=str(found), outer_p=SlideEntry() as one, outer_q=SlideEntry() as other
                ):
                    ends = [self._sliding(s, b, found) for s, b in ((one, group.p), (other, group.q))]
                    yield from (known for known, _ in ends)
                    yield self._met(*(relative for _, relative in ends))
                case Dyad(
                    kind="RPP", outer_p=str(found), inner=SlideEntry() as inner, outer_q=SlideEntry() as outer
                ):
                    yield from self._crossed(group, inner, outer)
                case Wheel(at=found):
                    pass
                case _:
                    raise self.linkage.refused(
                        ("ask", "polygon"),
                        "polygons are drawn body after body; {bodies} are one group of class III or "
                        "above, which moves as a whole; ask velocities in their place",
                        bodies=", ".join(group.bodies),
                    )
            drawn.add(found)
            for body in group.bodies:
                yield from self._carried(body, drawn)

    def _driven(self, drawn: set[str]) -> Iterator[list[DrawnSide]]:
        """Yield the sides of what drives: a crank, or a slider; a jack is a bar of its group."""
        linkage = self.linkage
        if linkage.drive.kind == "slide":
            slide = linkage.slides[linkage.slides_driven]
            rate = linkage.drive.rates[0] if self.kind == "velocity" else linkage.acceleration
            drawn.add(slide.at)
            if rate:
                _, (line,) = self._sliding(slide, linkage.driver, slide.at)
                size = rf"\left|{self.formulas.symbol(rate)}\right|"
                yield self._in_turn(
                    self.pole, [(line.end, line.name, line.value, rf"\parallel {slide.at}x", size)]
                )[0]
            else:
                self._alias[slide.at] = self.pole
        if linkage.drive.kind != "jack":
            yield from self._carried(linkage.driver, drawn)

    def _carried(self, body: str, drawn: set[str]) -> Iterator[list[DrawnSide]]:
        """Yield the sides of the joints that a body carries beside those that are drawn; a body that does not
        turn adds none."""
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
            if self.formulas.omega(body) == "0":
                self._alias[point] = self._image(start)
            else:
                yield self._about(body, start, point, "")

    def _about(
        self, body: str, start: str, end: str, primes: str, image: str = "", of: str = "", begin: str = ""
    ) -> list[DrawnSide]:
        """Return the sides from the image of a point of a body to that of another; without ``primes`` they
        are known, since the motion of the body is. ``image`` and ``of`` are those of the end, unless a point
        of the body that lies there has its own: a vector from another image than the pole is named by the
        point it begins at as well."""
        vector, line = self._vector(start, end), start + end
        # A jack's vectors are named by both its pins, or those about two fixed pivots would have the same
        # name.
        of = f"{end}/{start}" if body == self.linkage.jack else self._of(start, of or end)
        begin, image = begin or self._image(start), image or end.lower()
        omega, alpha = self.formulas.omega(body), self.formulas.alpha(body)
        if alpha in self.formulas.quantities and is_zero(self.formulas.quantities[alpha].code):
            alpha = "0"  # of a wheel on a crank at constant speed
        rate, gain = self.formulas.symbol(omega), self.formulas.symbol(alpha) if alpha != "0" else ""
        grown = self._grown(body, start, end, line, of)
        if self.kind == "velocity":
            length = "" if primes else rf', r"{line} \left|{rate}\right|"'
            sides, begin = self._in_turn(begin, grown)
            call = f"turning({begin!r}, {image!r}, {of!r}, {line!r}, {vector}, {omega}{length})"
            name, across = rf"\vec{{V}}_{{{of}}}", f"1j * ({vector})"
            value = f"1j * {omega} * ({vector})"
            if grown:
                name = rf"\vec{{V}}^t_{{{of}}}"
                call = rf'Side({begin!r}, {image!r}, r"{name}", {value}, r"\perp {line}", way={across})'
            return [*sides, DrawnSide(begin, image, name, not primes, value, across, call)]
        square = rf"{line}\,{rate}^2"
        middle = image if not primes and not gain else image + (primes or "'")
        call = f'normal({begin!r}, "{middle}", {of!r}, {line!r}, {vector}, {omega}, r"{square}")'
        sides = [
            DrawnSide(begin, middle, rf"\vec{{a}}^n_{{{of}}}", True, f"-({omega}**2) * ({vector})", "", call)
        ]
        if primes or gain:
            more, middle = self._in_turn(middle, grown)
            length = "" if primes else rf', r"{line} \left|{gain}\right|"'
            call = f'tangential("{middle}", {image!r}, {of!r}, {line!r}, {vector}, {alpha}{length})'
            name, across = rf"\vec{{a}}^t_{{{of}}}", f"1j * ({vector})"
            value = f"1j * {alpha} * ({vector})"
            sides += [*more, DrawnSide(middle, image, name, not primes, value, across, call)]
        return sides

    def _grown(
        self, body: str, start: str, end: str, line: str, of: str
    ) -> list[tuple[str, str, str, str, str]]:
        """Return what a driving jack adds as it grows: of each vector the image of its end, its name, its
        value, its direction and its size; nothing for any other body."""
        linkage, formulas = self.linkage, self.formulas
        if body != linkage.jack:
            return []
        arm, (speed, _) = formulas.arm(body, start, end), linkage.drive.rates
        way = f"{'' if arm.sign > 0 else '-'}polar(1, {arm.heading.code})"
        sizes = {
            n: formulas.symbol(n) for n in (speed, linkage.acceleration or "", formulas.omega(body)) if n
        }
        if self.kind == "velocity":
            return [
                (
                    f"l_{body}",
                    rf"\vec{{V}}^r_{{{of}}}",
                    f"{speed} * {way}",
                    rf"\parallel {line}",
                    rf"\left|{sizes[speed]}\right|",
                )
            ]
        omega = formulas.omega(body)
        size = rf"2 \left|{sizes[omega]}\,{sizes[speed]}\right|"
        results = [
            (f"k_{body}", rf"\vec{{a}}^c_{{{of}}}", f"2j * {omega} * {speed} * {way}", rf"\perp {line}", size)
        ]
        if gain := linkage.acceleration:
            name, size = rf"\vec{{a}}^r_{{{of}}}", rf"\left|{sizes[gain]}\right|"
            results.append((f"l_{body}", name, f"{gain} * {way}", rf"\parallel {line}", size))
        return results

    def _in_turn(
        self, start: str, vectors: Sequence[tuple[str, str, str, str, str]]
    ) -> tuple[list[DrawnSide], str]:
        """Return known vectors as sides one after the other, and the image at which the last ends."""
        sides = []
        for image, name, value, way, size in vectors:
            call = f'Side({start!r}, {image!r}, r"{name}", {value}, r"{way}", r"{size}")'
            sides.append(DrawnSide(start, image, name, True, value, "", call))
            start = image
        return sides, start

    def _ends(self, group: Dyad, inner: str) -> Iterator[list[DrawnSide]]:
        yield self._about(group.p, str(group.outer_p), inner, "'")
        yield self._about(group.q, str(group.outer_q), inner, "''")

    @staticmethod
    def _met(first: list[DrawnSide], other: list[DrawnSide]) -> list[DrawnSide]:
        """Return the sides of two ways to an image: what is known of both, then the two lines that cross
        there."""
        return [*first[:-1], *other[:-1], first[-1], other[-1]]

    def _sliding(
        self, slide: SlideEntry, body: str, point: str, image: str = "", under: str = ""
    ) -> tuple[list[DrawnSide], list[DrawnSide]]:
        """Return the sides that lead to the image of a point of a body that slides on a placed one: those of
        the point of the guide under it, all known, and those of the motion on the guide, the last of them a
        line."""
        formulas, slides = self.formulas, body == slide.of
        guide = slide.on if slides else slide.of
        known: list[DrawnSide] = []
        start, of, line = self.pole, under or point, f"{point}x"
        if guide != GROUND:
            reference, coincident = formulas.reference[guide], f"{point}_{{{guide}}}"
            start, of, line = self._image(reference), f"{of}/{coincident}", f"{point}x_{{{guide}}}"
            if formulas.omega(guide) != "0":
                known = self._about(guide, reference, point, "", f"{point.lower()}_{guide}", coincident)
                start = known[-1].end
        way = f"polar(1, {(formulas.heading(guide) + Heading.of(slide.along.code)).code})"
        relative = self._relative(
            slide, guide, (start, image or point.lower()), of, ("" if slides else "-") + way, line
        )
        return known, relative

    def _relative(
        self,
        slide: SlideEntry,
        guide: str,
        ends: tuple[str, str],
        of: str,
        way: str,
        line: str,
        back: str = "",
    ) -> list[DrawnSide]:
        """Return the sides of a motion along a guide, ``back`` where it is laid off from the block to the
        guide: the Coriolis acceleration where the guide turns, and a line."""
        (speed, gain), (start, image), symbol = slide.rates, ends, self.formulas.symbol
        sign, way = ("-", way[1:]) if way.startswith("-") else ("", way)
        omega = self.formulas.omega(guide) if guide != GROUND else "0"
        sides: list[DrawnSide] = []
        letter, rate = ("V", speed) if self.kind == "velocity" else ("a", gain)
        if self.kind == "acceleration" and omega != "0":
            end, size = f"k_{guide}", rf"2 \left|{symbol(omega)}\,{symbol(speed)}\right|"
            if end in self._turned:
                end = f"k_{slide.at.lower()}{guide}"
            self._turned.add(end)
            name, turn = rf"{back}\vec{{a}}^c_{{{of}}}", f"{sign}2j * {omega} * {speed} * {way}"
            sides, start = self._in_turn(start, [(end, name, turn, rf"\perp {line}", size)])
        kind = "^r" if letter == "a" and (back or omega != "0") else ""
        name, value = rf"{back}\vec{{{letter}}}{kind}_{{{of}}}", f"{sign}{rate} * {way}"
        call = rf'Side({start!r}, {image!r}, r"{name}", {value}, r"\parallel {line}", way={way})'
        return [*sides, DrawnSide(start, image, name, False, value, way, call)]

    def _guided(self, group: Dyad, slide: SlideEntry) -> list[DrawnSide]:
        """Return the sides of a guide that turns about a joint: to the image of its point under the block,
        from the joint and from the block."""
        P, guide = str(group.outer_p), group.q
        under, image = f"{P}_{{{guide}}}", f"{P.lower()}_{guide}"
        first = self._about(guide, str(group.outer_q), P, "'", image, under)
        way = f"-polar(1, {(self.formulas.heading(guide) + Heading.of(slide.along.code)).code})"
        ends = self._image(P), image
        return self._met(
            first, self._relative(slide, guide, ends, f"{P}/{under}", way, f"{P}x_{{{guide}}}", "-")
        )

    def _crossed(self, group: Dyad, inner: SlideEntry, outer: SlideEntry) -> Iterator[list[DrawnSide]]:
        """Yield the sides of a body that slides on a placed one and carries a block: to the image of its
        point under the block."""
        P, yoke = str(group.outer_p), group.q
        under, image = f"{P}_{{{yoke}}}", f"{P.lower()}_{yoke}"
        known, along = self._sliding(outer, yoke, P, image, under)
        yield known
        heading = self.formulas.heading(yoke) + Heading.of(inner.along.code)
        way = f"{'-' if inner.of == group.p else ''}polar(1, {heading.code})"
        ends = self._image(P), image
        yield self._met(
            along, self._relative(inner, yoke, ends, f"{P}/{under}", way, f"{P}x_{{{yoke}}}", "-")
        )
        start = self.formulas.reference[yoke]
        if self.formulas.omega(yoke) == "0":
            self._alias[start] = image
        else:
            yield self._about(yoke, P, start, "", begin=image)

    def _vector(self, start: str, end: str) -> str:
        first, last = self.formulas.at(start), self.formulas.at(end)
        away = last - first
        return f"{away.x.code} + 1j * {away.y.factor}" if not away.y.vanishes else f"{away.x.code} + 0j"

    def _image(self, point: str) -> str:
        return self.pole if point in self.linkage.ground else self._alias.get(point, point.lower())

    def _of(self, start: str, end: str) -> str:
        return end if start in self.linkage.ground else f"{end}/{start}"

    # ---------------------------------------------------------------- questions

    def part(self, image: str) -> str:
        """Return the id of the part that asks an image point: ``b''`` of accelerations is ``a_b2``."""
        if image == self.pole:
            return f"p{self.letter}"
        primes = image.count("'")
        return f"{self.letter}_{image.rstrip(chr(39))}{primes or ''}"

    @property
    def images(self) -> dict[str, list[DrawnSide]]:
        """Sides that find each image point: one that is known, or two lines."""
        found: dict[str, list[DrawnSide]] = {}
        for side in self.sides:
            found.setdefault(side.end, []).append(side)
        return found

    def side_key(self, side: DrawnSide) -> str:
        """Return how a side is called in the names of mistakes."""
        return f"{self.part(side.start)}_{self.part(side.end).removeprefix(f'{self.letter}_')}"

    def quantities(self) -> Iterator[Quantity]:
        """Yield the scale, and the image points on paper."""
        codes: dict[str, str] = {self.pole: "0j"}
        hidden = []
        for image, sides in self.images.items():
            name = f"_{self.part(image)}"
            codes[image] = name
            start = codes[sides[0].start]
            value = sides[0].value if start == "0j" else f"{start} + {sides[0].value}"
            hidden.append(name)
            yield Quantity(name, value)
        unit = "mm/s/mm" if self.kind == "velocity" else "mm/s^2/mm"
        yield Quantity(
            self.scale,
            f"scale_for({', '.join(hidden)})",
            unit,
            f"k_{self.letter}",
            "drawn_scale",
            silent=True,
        )
        yield Quantity(
            self.part(self.pole),
            f"to_paper(0 * {hidden[0]}, 1.0)",
            "mm",
            self.pole,
            "drawn_pole",
            silent=True,
        )
        for image, sides in self.images.items():
            step = "drawn_known" if sides[0].is_known else "drawn_crossing"
            words = {
                "image": image,
                "vector": sides[0].name,
                "other": sides[-1].name,
                "start": sides[0].start,
            }
            code = f"to_paper({codes[image]}, {self.scale})"
            yield Quantity(self.part(image), code, "mm", image, step, words, silent=True)

    def mistakes(self) -> Iterator[UsualMistake]:
        """Yield the mistakes of each vector."""
        for image, sides in self.images.items():
            own = self.part(image)
            for side in sides:
                start, key = self.part(side.start), self.side_key(side)
                words = {"vector": side.name, "start": side.start, "image": image}
                if side.is_known:
                    for kind, code in (
                        ("length", f"{start} + 1.35 * ({own} - {start})"),
                        ("direction", f"turned({start}, {own}, 90)"),
                        ("sense", f"2 * {start} - {own}"),
                        ("vector", f"{start} + 0.6 * (turned({start}, {own}, 75) - {start})"),
                    ):
                        yield UsualMistake(
                            f"{key}_{kind}",
                            (own,),
                            (f"if_long({start}, {own}, {code})",),
                            f"drawn_{kind}",
                            words,
                            "sign" if kind == "sense" else "mistake",
                        )
            if not sides[0].is_known:
                yield from self._of_crossing(own, image, sides)

    def _of_crossing(self, own: str, image: str, sides: list[DrawnSide]) -> Iterator[UsualMistake]:
        (first, other) = sides
        starts = [self.part(side.start) for side in sides]
        for side, line in ((first, 0), (other, 1)):
            ways = [f"({s.way})" + (" * np.exp(-0.35j)" if k == line else "") for k, s in enumerate(sides)]
            words = {"vector": side.name, "start": side.start, "image": image}
            key = self.side_key(side)
            long = f"if_long({starts[line]}, {own}, "
            code = f"{long}met({starts[0]}, {ways[0]}, {starts[1]}, {ways[1]}))"
            yield UsualMistake(f"{key}_direction", (own,), (code,), "drawn_line_direction", words)
            yield UsualMistake(
                f"{key}_sense",
                (own,),
                (f"{long}2 * {starts[line]} - {own})",),
                "drawn_line_sense",
                words,
                "sign",
            )
        code = f"if_long({starts[0]}, {own}, off_both({own}, ({first.way}, {other.way}), {starts[0]}))"
        words = {"vector": first.name, "other": other.name, "image": image}
        yield UsualMistake(f"{own}_vector", (own,), (code,), "drawn_off_both", words)

    @property
    def parts(self) -> Mapping[str, str]:
        """Image points by the id of the part that asks each, the pole first."""
        return {self.part(image): image for image in (self.pole, *self.images)}

    @property
    def lines(self) -> tuple[str, ...]:
        """Lengths of the vectors that must be long enough to draw, as code: all velocities; of accelerations
        those that are found on lines, since a normal acceleration may be next to nothing in all positions."""
        return (
            tuple(f"abs({s.value})" for s in self.sides if self.kind == "velocity" or not s.is_known)
            or self.lengths
        )

    @property
    def least(self) -> float:
        """Share of the longest vector that those must have."""
        return 0.12 if self.kind == "velocity" else 0.06

    @property
    def lengths(self) -> tuple[str, ...]:
        """Lengths of all vectors, as code."""
        return tuple(f"abs({side.value})" for side in self.sides)

    def function(self) -> str:
        """Return the polygon as a function of its quantities, as code."""
        code = self.code("scale")
        names = [n for n in names_in(code) if n != "scale"]
        return f"def _{self.kind}_polygon({', '.join(names)}, scale=None):\n    return {code}"

    def reference(self, given: Sequence[str], scale: str = "") -> str:
        """Return the call of the polygon with the reference values of its quantities, as code."""
        names = [n for n in names_in(self.code("scale")) if n != "scale"]
        functions = "".join(f"{q.name}, " for q in self.formulas.transitive(names))
        listed = ", ".join(f"{n}={n}" for n in given)
        values = f"reference_values(lambda: ({functions}), {tuple(names)!r}, dict({listed}))"
        return f"_{self.kind}_polygon(**{values}{f', scale={scale}' if scale else ''})"

    def judge(self, given: Sequence[str]) -> str:
        """Return the function that judges the drawing, of what is given, as code."""
        sides = {(side.start, side.end): self.side_key(side) for side in self.sides}
        return (
            f"@judge\ndef drawing_{self.kind}(answers, {', '.join(given)}):\n"
            f"    asked = DrawingParts(scale={self.scale!r}, points={dict(self.parts)!r}, "
            f"lengths={{}}, reads={{}}, sides={sides!r})\n"
            f"    return verdicts(answers, {self.reference(given)}, asked)"
        )
