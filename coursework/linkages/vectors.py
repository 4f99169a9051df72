"""Velocity and acceleration polygons of a mechanism: their sides as code, and the questions about the drawing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from coursework.linkages.entries import GROUND, SlideEntry
from coursework.linkages.formulas import FormulaWriter
from coursework.linkages.groups import Dyad
from coursework.linkages.points import Quantity, UsualMistake, names_in
from coursework.linkages.terms import Heading

PAPER_MM = (160, 90)  #: the box of millimetre paper to draw in
_FUNCTIONS = {"velocity": "polygon_of_velocities", "acceleration": "polygon_of_accelerations"}
_POLES = {"velocity": "p_v", "acceleration": "p_a"}


@dataclass(frozen=True)
class DrawnSide:
    """Side of a polygon: the image points at its ends, its name in LaTeX, whether it is known or a line, the code of its vector and of
    the direction of its line, and the call that states it."""

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
        A group of which no polygon is drawn: a slide on a body that moves, or a group of class III and above.
    """

    def __init__(self, formulas: FormulaWriter, kind: str) -> None:
        self.formulas, self.linkage, self.kind = formulas, formulas.linkage, kind
        self.letter = kind[0]  #: before the names of its parts
        self.scale = f"k{kind[0]}"
        self.pole = _POLES[kind]
        self.pieces = [piece for piece in self._pieces() if piece]
        self.sides = [side for piece in self.pieces for side in piece]

    def code(self, scale: str) -> str:
        """Return the polygon at a scale, as code."""
        pieces = [f"({', '.join(side.call for side in piece)},)" for piece in self.pieces]
        return f"{_FUNCTIONS[self.kind]}({', '.join(pieces)}, scale={scale})"

    # -------------------------------------------------------------------- sides

    def _pieces(self) -> Iterator[list[DrawnSide]]:
        drawn: set[str] = set()
        if self.linkage.drive.kind != "turn":
            raise self.linkage.refused(
                ("ask", "polygon"), "polygons are drawn of mechanisms that a given angle drives"
            )
        yield from self._carried(self.linkage.driver, drawn)
        for group in self.formulas.groups:
            match group:
                case Dyad(kind="RPR", inner=SlideEntry(at=inner) as slide) if inner == group.outer_p:
                    yield self._guided(group, slide)
                case Dyad(kind="RRR" | "RRP", inner=str(inner), outer_q=SlideEntry() as slide):
                    yield self._slider(group, slide)
                case Dyad(kind="RRR" | "RRP", inner=str(inner)):
                    yield self._bars(group, str(group.outer_p), inner, str(group.outer_q))
                case _:
                    raise self.linkage.refused(
                        ("ask", "polygon"),
                        "polygons are drawn of pairs of bars, of sliders on fixed guides, and of guides about a joint",
                    )
            drawn.add(inner)
            for body in group.bodies:
                yield from self._carried(body, drawn)

    def _carried(self, body: str, drawn: set[str]) -> Iterator[list[DrawnSide]]:
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
            yield self._about(body, start, point, "")

    def _about(
        self, body: str, start: str, end: str, primes: str, image: str = "", of: str = ""
    ) -> list[DrawnSide]:
        """Return the sides from the image of a point of a body to that of another; without ``primes`` they are known, since the motion
        of the body is. ``image`` and ``of`` are those of the end, unless a point of the body that lies there has its own."""
        vector, line, of = self._vector(start, end), start + end, of or self._of(start, end)
        begin, image = self._image(start), image or end.lower()
        omega, alpha = self.formulas.omega(body), self.formulas.alpha(body)
        rate, gain = self.formulas.symbol(omega), self.formulas.symbol(alpha) if alpha != "0" else ""
        if self.kind == "velocity":
            length = "" if primes else rf', r"{line} \left|{rate}\right|"'
            call = f"turning({begin!r}, {image!r}, {of!r}, {line!r}, {vector}, {omega}{length})"
            return [
                DrawnSide(
                    begin,
                    image,
                    rf"\vec{{V}}_{{{of}}}",
                    not primes,
                    f"1j * {omega} * ({vector})",
                    f"1j * ({vector})",
                    call,
                )
            ]
        square = rf"{line}\,{rate}^2"
        middle = image if not primes and not gain else image + (primes or "'")
        call = f'normal({begin!r}, "{middle}", {of!r}, {line!r}, {vector}, {omega}, r"{square}")'
        sides = [
            DrawnSide(begin, middle, rf"\vec{{a}}^n_{{{of}}}", True, f"-({omega}**2) * ({vector})", "", call)
        ]
        if primes or gain:
            length = "" if primes else rf', r"{line} \left|{gain}\right|"'
            call = f'tangential("{middle}", {image!r}, {of!r}, {line!r}, {vector}, {alpha}{length})'
            sides.append(
                DrawnSide(
                    middle,
                    image,
                    rf"\vec{{a}}^t_{{{of}}}",
                    not primes,
                    f"1j * {alpha} * ({vector})",
                    f"1j * ({vector})",
                    call,
                )
            )
        return sides

    def _bars(self, group: Dyad, start: str, inner: str, end: str) -> list[DrawnSide]:
        first = self._about(group.p, start, inner, "'")
        second = self._about(group.q, end, inner, "''")
        if self.kind == "velocity":
            return [*first, *second]
        return [first[0], second[0], first[1], second[1]]

    def _guided(self, group: Dyad, slide: SlideEntry) -> list[DrawnSide]:
        """Return the sides of a guide that turns about a joint: to the image of its point under the block, from the joint and from the
        block."""
        P, Q, guide = slide.at, str(group.outer_q), group.q
        under, image = f"{P}_{{{guide}}}", f"{P.lower()}_{guide}"
        first = self._about(guide, Q, P, "'", image, under)
        heading = self.formulas.heading(guide) + Heading.of(slide.along.code)
        way, speed = f"polar(1, {heading.code})", slide.rates[0]
        letter, rate = ("V", speed) if self.kind == "velocity" else ("a", slide.rates[1])
        parallel = rf"\parallel {P}x_{{{guide}}}"
        kind = "" if self.kind == "velocity" else "^r"
        name, value, start = rf"-\vec{{{letter}}}{kind}_{{{P}/{under}}}", f"-{rate} * {way}", self._image(P)
        extra = []
        if self.kind == "acceleration":
            omega = self.formulas.omega(guide)
            coriolis, turn = rf"-\vec{{a}}^c_{{{P}/{under}}}", f"-2j * {omega} * {speed} * {way}"
            size = rf"2 \left|{self.formulas.symbol(omega)}\,{self.formulas.symbol(speed)}\right|"
            across = rf"\perp {P}x_{{{guide}}}"
            call = f'Side({start!r}, "k_{guide}", r"{coriolis}", {turn}, r"{across}", r"{size}")'
            extra = [DrawnSide(start, f"k_{guide}", coriolis, True, turn, "", call)]
            start = f"k_{guide}"
        call = f'Side({start!r}, {image!r}, r"{name}", {value}, r"{parallel}", way={way})'
        last = DrawnSide(start, image, name, False, value, way, call)
        return [*first[:-1], *extra, first[-1], last]

    def _slider(self, group: Dyad, slide: SlideEntry) -> list[DrawnSide]:
        if slide.on != GROUND:
            raise self.linkage.refused(
                ("ask", "polygon"), "polygons are drawn of sliders on fixed guides; this guide moves"
            )
        B = str(group.inner)
        way = f"polar(1, {Heading.of(slide.along.code).code})"
        letter, rate = ("V", slide.rates[0]) if self.kind == "velocity" else ("a", slide.rates[1])
        value = f"{rate} * {way}"
        name = rf"\vec{{{letter}}}_{{{B}}}"
        call = rf'Side("{self.pole}", {B.lower()!r}, r"{name}", {value}, r"\parallel {B}x", way={way})'
        return [
            *self._about(group.p, str(group.outer_p), B, "'"),
            DrawnSide(self.pole, B.lower(), name, False, value, way, call),
        ]

    def _vector(self, start: str, end: str) -> str:
        first, last = self.formulas.at(start), self.formulas.at(end)
        away = last - first
        return f"{away.x.code} + 1j * {away.y.factor}" if not away.y.vanishes else f"{away.x.code} + 0j"

    def _image(self, point: str) -> str:
        return self.pole if point in self.linkage.ground else point.lower()

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
                            f"{key}_{kind}", (own,), (code,), f"drawn_{kind}", words, _kind(kind)
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
            code = f"met({starts[0]}, {ways[0]}, {starts[1]}, {ways[1]})"
            yield UsualMistake(f"{key}_direction", (own,), (code,), "drawn_line_direction", words)
            yield UsualMistake(
                f"{key}_sense", (own,), (f"2 * {starts[line]} - {own}",), "drawn_line_sense", words, "sign"
            )
        code = f"off_both({own}, ({first.way}, {other.way}), {starts[0]})"
        words = {"vector": first.name, "other": other.name, "image": image}
        yield UsualMistake(f"{own}_vector", (own,), (code,), "drawn_off_both", words)

    @property
    def parts(self) -> Mapping[str, str]:
        """Image points by the id of the part that asks each, the pole first."""
        return {self.part(image): image for image in (self.pole, *self.images)}

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
            f"    asked = DrawingParts(scale={self.scale!r}, points={dict(self.parts)!r}, lengths={{}}, reads={{}}, sides={sides!r})\n"
            f"    return verdicts(answers, {self.reference(given)}, asked)"
        )


def _kind(kind: str) -> str:
    return "sign" if kind == "sense" else "mistake"
