"""Points of a mechanism: where they lie, how they move, and the quantities that say so.

Coordinates of points in mm, angles in degrees; ``xB`` and ``yB``, ``v_B_x`` and ``a_B_x`` are quantities,
``_B`` is the point as a complex number.
"""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from coursework.linkages.entries import GROUND, AssemblyEntry, GivenEntry, LinkageFile, Place, SlideEntry
from coursework.linkages.expressions import DEGREES
from coursework.linkages.groups import groups_of
from coursework.linkages.terms import Heading, Plane, Sum
from coursework.markup.symbols import symbol_of
from coursework.messages import Message

Chain: TypeAlias = list[tuple[str, str, str, str]]  #: vectors as code: length, angle, sign, turn

_WORDS = (
    "sin cos tan sqrt abs atan2 acos asin polar angle wrap np dyads dict max complex Figure line link "
    "ground_pivot pin point slot_link "
    "slider rail circle angle_mark Side normal tangential turning polygon_of_velocities "
    "polygon_of_accelerations FourBar SliderCrank "
    "Degrees from_radians scale_for to_paper if_long turned met off_both verdicts DrawingParts Moving"
)
FUNCTIONS = frozenset(_WORDS.split())  #: names in code that are not quantities
_OTHERS = ("pi", "min", "hypot", "result")  #: names that code or an expression uses besides


@dataclass(frozen=True)
class Quantity:
    """Quantity of a solution.

    ``step`` names the sentence that explains it, with its ``words``; a hidden one, whose name begins with an
    underscore, has none. ``stable`` is the code by which it is computed where the formula would lose digits.
    """

    name: str
    code: str
    unit: str = "1"
    symbol: str = ""
    step: str = ""
    words: Mapping[str, str] = field(default_factory=dict)
    stable: str = ""
    silent: bool = False  #: whether its code is not a formula to print
    meeting: str = ""  #: code of what an error of it names: bodies and points

    @property
    def needs(self) -> tuple[str, ...]:
        """Quantities in its formula, in order of appearance."""
        return names_in(self.code)

    @property
    def _first_component(self) -> str:
        """Name of the component along x of which this is the one along y."""
        return f"x{self.name[1:]}" if self.name.startswith("y") else f"{self.name[:-1]}x"

    @property
    def source(self) -> str:
        """The function as Python code."""
        lines = []
        if self.step.endswith("_y"):
            lines.append(f'@explained_after("{self._first_component}")')
        named = f"meeting({self.meeting})" if self.meeting else ""
        if self.stable:
            function = f"lambda {', '.join(names_in(self.stable))}: {self.stable}"
            lines.append(f"@stable({f'{named}({function})' if named else function})")
        elif named:
            lines.append(f"@{named}")
        body = (
            [f"    result = {self.code}", "    return result"] if self.silent else [f"    return {self.code}"]
        )
        lines += [f"def {self.name}({', '.join(self.needs)}):", *body]
        return "\n".join(lines)


def names_in(code: str) -> tuple[str, ...]:
    """Return the quantities in a code, in order of appearance."""
    tree = ast.parse(code, mode="eval")
    names = [(n.lineno, n.col_offset, n.id) for n in ast.walk(tree) if isinstance(n, ast.Name)]
    return tuple(
        dict.fromkeys(n for *_, n in sorted(names) if n not in FUNCTIONS and not n.startswith("_CHAIN_"))
    )


@dataclass(frozen=True)
class UsualMistake:
    """Named mistake: the quantities that it gets wrong, the wrong codes, and the sentence about it with its
    words."""

    name: str
    targets: tuple[str, ...]
    codes: tuple[str, ...]
    key: str
    words: Mapping[str, str]
    kind: str = "mistake"

    @property
    def source(self) -> str:
        """The function as Python code."""
        names = dict.fromkeys(n for code in self.codes for n in names_in(code))
        kind = "" if self.kind == "mistake" else f', kind="{self.kind}"'
        targets = ", ".join(f'"{t}"' for t in self.targets)
        return "\n".join(
            [
                f"@mistake({targets}{kind})",
                f"def {self.name}({', '.join(names)}):",
                f"    return {', '.join(self.codes)}",
            ]
        )


@dataclass(frozen=True)
class Arm:
    """Vector on a body from one of its points to another: sign, length, and direction."""

    sign: int
    length: Sum
    heading: Heading

    @property
    def vector(self) -> Plane:
        return Plane.polar(self.length, self.heading).times(sign=self.sign)


class SlideLine(NamedTuple):
    """Line along which a point of a body moves: the placed body that carries it, the coordinates of the point
    where the distance is 0, the sign of the distance, and the direction of the slide."""

    placed: str
    base: Plane
    sign: int
    heading: Heading

    def moved(self, start: Plane, distance: str) -> Plane:
        """Return a vector with a distance along the slide, or with a rate of it, added to it."""
        return start + Plane.polar(Sum.of(distance), self.heading).times(sign=self.sign)

    def across(self, value: Sum) -> Plane:
        """Return a value to the left of the slide, as a vector."""
        return Plane.polar(value, self.heading + Heading((), 90.0))


class PointWriter:
    """Writer of the points of a mechanism, from those that the driver places on.

    Parameters
    ----------
    linkage
        The mechanism.
    """

    def __init__(self, linkage: LinkageFile) -> None:
        self.linkage = linkage
        for name in linkage.given:
            if keyword.iskeyword(name) or name in FUNCTIONS or name in _OTHERS:
                raise linkage.refused(
                    ("given", name), "{name} means something else; give the quantity another name", name=name
                )
        self.groups, self.rank = groups_of(linkage)
        self.quantities: dict[str, Quantity] = {}
        self.turns: dict[str, str] = {GROUND: "0"}
        #: A point of each body whose motion is known before the body's other points.
        self.reference: dict[str, str] = {}
        self.modes: dict[str, AssemblyEntry] = {}  #: by point, where a group has two ways to assemble
        self.order = [GROUND]
        self.mistakes: list[UsualMistake] = []
        self.sines: dict[str, str] = {}  #: by inner joint, the code that vanishes at its dead points
        self.loops: dict[str, Chain] = {}  #: of the larger groups
        self.constants: dict[str, str] = {}  #: of the module, by name
        #: By larger group, the quantities that it computes along the driver's way.
        self.followed: dict[str, tuple[str, ...]] = {}
        self._name_turns()
        self._place_driver()

    @property
    def followed_turns(self) -> tuple[str, ...]:
        """Angles that follow from the driver's, each once."""
        turns = dict.fromkeys(self.turns.values())
        return tuple(t for t in turns if t.startswith("theta") and t != self.linkage.moved)

    def _name_turns(self) -> None:
        """Give each body the quantity, or the constant, that turns it; bodies that slide on each other share
        it."""
        linkage = self.linkage
        home = {body: body for body in (GROUND, *linkage.bodies)}

        def root(body: str) -> str:
            while home[body] != body:
                body = home[body]
            return body

        rank = {GROUND: 0, linkage.driver: 1}
        for slide in linkage.slides.values():
            first, second = sorted(
                (root(slide.of), root(slide.on)), key=lambda b: (rank.get(b, 2), b != slide.on)
            )
            home[second] = first
        for name, body in linkage.bodies.items():
            top = root(name)
            if top == GROUND:
                self.turns[name] = "0"
            elif top == linkage.driver and linkage.drive.kind == "turn":
                self.turns[name] = linkage.moved
            else:
                self.turns[name] = f"theta{top}" if top.isdigit() else f"theta_{top}"
            if body.angle is not None and body.angle.is_number:
                if top not in (GROUND, name):
                    raise linkage.refused(
                        ("bodies", name),
                        "body {name} slides on {top}, which turns it; it has no angle of its own",
                        name=name,
                        top=top,
                    )
                self.turns[name] = body.angle.code

    def heading(self, body: str) -> Heading:
        """Return the direction of a body's frame."""
        return Heading.of(self.turns[body])

    def omega(self, body: str) -> str:
        """Return the angular velocity of a body as code."""
        return self._rate(body, "omega")

    def alpha(self, body: str) -> str:
        """Return the angular acceleration of a body as code."""
        linkage = self.linkage
        if self.turns[body] == linkage.moved:
            return linkage.acceleration or "0"
        return self._rate(body, "alpha")

    def _rate(self, body: str, stem: str) -> str:
        turn = self.turns[body]
        return turn.replace("theta", stem, 1) if turn.startswith("theta") else "0"

    def write(
        self, name: str, code: str, unit: str = "1", step: str = "", symbol: str = "", **more: Any
    ) -> str:
        """Add a quantity, and return its name."""
        if name in self.linkage.given:
            raise self.linkage.refused(
                ("given", name),
                "{name} follows from the mechanism; give the given quantity another name",
                name=name,
            )
        words = {k: str(v) for k, v in more.pop("words", {}).items()}
        self.quantities[name] = Quantity(name, code, unit, symbol, step, words, **more)
        return name

    def add(self, quantity: Quantity) -> None:
        """Add a quantity as it is; one whose name is given is refused."""
        self.write(quantity.name, quantity.code, quantity.unit)
        self.quantities[quantity.name] = quantity

    def hide(self, name: str, code: str, *meeting: str) -> str:
        """Add a hidden quantity, and return its name; ``meeting`` are the bodies, the joint and the points
        placed before that an error of it names."""
        if name not in self.quantities:
            self.quantities[name] = Quantity(name, code, meeting=", ".join(map(repr, meeting)))
        return name

    def local(self, point: str, body: str) -> Plane:
        """Return where a point lies in a body's frame."""
        return local_plane(self.linkage.place(point, body))

    def arm(self, body: str, start: str, end: str) -> Arm:
        """Return the vector between two points of a body."""
        first, second = self.linkage.place(start, body), self.linkage.place(end, body)
        frame = self.heading(body)
        for place, other, sign in ((second, first, 1), (first, second, -1)):
            if other.is_origin and place.radius is not None:
                return self._measured(sign, Sum.of(place.radius.code), frame + Heading.of(place.angle.code))
        gap = local_plane(second) - local_plane(first)
        if gap.y.vanishes:
            return self._measured(1, gap.x, frame)
        length, turn = f"d_{start}{end}", f"delta_{start}{end}"
        if length not in self.quantities:
            words = {"P": start, "Q": end, "body": body}
            symbols = f"{start}{end}", rf"\delta_{{{start}{end}}}"
            self.write_polar((length, turn), gap, ("bar_length", "bar_direction"), symbols, words)
        return Arm(1, Sum.of(length), frame + Heading.of(turn))

    def _measured(self, sign: int, length: Sum, heading: Heading) -> Arm:
        """Return a vector of a length that is positive in the middle of what is given: else backwards."""
        if middle_value(Plane(length), self.linkage).real < 0:
            return Arm(-sign, -length, heading)
        return Arm(sign, length, heading)

    def write_polar(
        self,
        names: tuple[str, str],
        gap: Plane,
        steps: tuple[str, str],
        symbols: tuple[str, str],
        words: Mapping[str, str],
    ) -> None:
        """Write the length and the direction of a vector."""
        codes = f"sqrt(({gap.x.code})**2 + ({gap.y.code})**2)", f"atan2({gap.y.code}, {gap.x.code})"
        for name, code, unit, step, symbol in zip(names, codes, ("mm", "deg"), steps, symbols, strict=True):
            self.write(name, code, unit, step, symbol, words=words)

    def at(self, point: str) -> Plane:
        """Return the coordinates of a placed point."""
        if point in self.linkage.ground:
            return self.local(point, GROUND)
        if f"x{point}" not in self.quantities:
            self._write_point(point)
        return Plane(Sum.of(f"x{point}"), Sum.of(f"y{point}"))

    def carrier(self, point: str) -> tuple[str, str]:
        """Return the first placed body that has a point, and the point from which it is reckoned."""
        body = next(b for b in self.order if b != GROUND and point in self.linkage.bodies[b].points)
        return body, self.reference[body]

    def _write_point(self, point: str) -> None:
        body, start = self.carrier(point)
        arm = self.arm(body, start, point)
        place = self.at(start) + arm.vector
        words = {"B": point, "P": start, "body": body}
        self.write(
            f"x{point}", place.x.code, "mm", "point_x", words=words, stable=f"{self.complex(point)}.real"
        )
        self.write(
            f"y{point}", place.y.code, "mm", "point_y", words=words, stable=f"{self.complex(point)}.imag"
        )

    def complex(self, point: str) -> str:
        """Return the hidden quantity that is a placed point as a complex number."""
        name = f"_{point}"
        if name in self.quantities:
            return name
        if point in self.linkage.ground:
            return self.hide(name, self.local(point, GROUND).complex)
        body, start = self.carrier(point)
        arm = self.arm(body, start, point)
        sign = "-" if arm.sign < 0 else "+"
        return self.hide(name, f"{self.complex(start)} {sign} polar({arm.length.code}, {arm.heading.code})")

    def velocity(self, point: str) -> Plane:
        """Return the velocity of a placed point."""
        return self._motion(point, "v")

    def acceleration(self, point: str) -> Plane:
        """Return the acceleration of a placed point."""
        return self._motion(point, "a")

    def _motion(self, point: str, kind: str) -> Plane:
        if point in self.linkage.ground:
            return Plane()
        if f"{kind}_{point}_x" not in self.quantities:
            body, start = self.carrier(point)
            before = self._motion(start, kind)
            arm = self.arm(body, start, point)
            growth = self.growth(body, arm, kind)
            there = before + self._turning(body, arm.vector, kind) + growth
            words = {"B": point, "P": start, "body": body}
            step = ("about" if before.vanishes else "on") if growth.vanishes else "jack"
            self.write_rates(point, there, kind, step, words)
        return Plane(Sum.of(f"{kind}_{point}_x"), Sum.of(f"{kind}_{point}_y"))

    def write_rates(self, point: str, rates: Plane, kind: str, step: str, words: Mapping[str, str]) -> None:
        """Write both components of the velocity, or of the acceleration, of a point."""
        unit, what = ("mm/s", "velocity") if kind == "v" else ("mm/s^2", "acceleration")
        for axis, component in (("x", rates.x), ("y", rates.y)):
            self.write(
                f"{kind}_{point}_{axis}",
                component.code,
                unit,
                f"{what}_{step}_{axis}",
                f"{kind}_{{{point}{axis}}}",
                words=words,
            )

    def _turning(self, body: str, arm: Plane, kind: str) -> Plane:
        """Return the velocity, or the acceleration, that the turning of a body adds over an arm."""
        if kind == "v":
            return arm.turned.times(self.omega(body))
        return arm.turned.times(self.alpha(body)) - arm.times(
            f"{self.omega(body)}**2" if self.omega(body) != "0" else "0"
        )

    def growth(self, body: str, arm: Arm, kind: str, heading: Heading | None = None) -> Plane:
        """Return the velocity, or the acceleration, that the driving jack adds over an arm as it grows, in
        axes turned by a direction; nothing for any other body."""
        linkage = self.linkage
        if body != linkage.jack or arm.length.vanishes:
            return Plane()
        speed, turn = linkage.drive.rates[0], arm.heading - (heading or Heading())
        if kind == "v":
            return Plane.polar(Sum.of(speed), turn).times(sign=arm.sign)
        along = Plane.polar(Sum.of(linkage.acceleration or "0"), turn)
        return (along + Plane.polar(Sum.of(speed), turn).turned.times("2", self.omega(body))).times(
            sign=arm.sign
        )

    def carried(self, body: str, point: Plane, kind: str) -> Plane:
        """Return the velocity, or the acceleration, of the point of a placed body that lies at coordinates
        now."""
        if body == GROUND:
            return Plane()
        start = self.reference[body]
        return self._motion(start, kind) + self._turning(body, point - self.at(start), kind)

    def _place_driver(self) -> None:
        linkage, driver = self.linkage, self.linkage.driver
        if linkage.drive.kind == "turn":
            self._finish_rod(driver, linkage.bodies[driver].at)
        elif linkage.drive.kind == "slide":
            slide = linkage.slides[linkage.slides_driven]
            track, point = self.track(slide, driver, slide.at), slide.at
            self.write_slid(
                track, point, linkage.moved, (linkage.drive.rates[0], linkage.acceleration or "0"), {}
            )
            self._finish_rod(driver, point)

    def write_end(self, point: str, there: Plane, words: Mapping[str, str], hidden: str) -> None:
        """Write both coordinates of a point that a hidden quantity holds as a complex number."""
        for axis, component, half in (("x", there.x, "real"), ("y", there.y, "imag")):
            self.write(
                f"{axis}{point}", component.code, "mm", f"end_{axis}", words=words, stable=f"{hidden}.{half}"
            )

    def write_slid(
        self, track: SlideLine, point: str, distance: str, rates: tuple[str, str], words: Mapping[str, str]
    ) -> None:
        """Write the place of a point that slides on a placed body, its velocity and its acceleration."""
        values, sign = {**words, "B": point}, "-" if track.sign < 0 else ""
        self.hide(f"_{point}", f"{track.base.complex} + {sign}polar({distance}, {track.heading.code})")
        self.write_end(point, track.moved(track.base, distance), values, f"_{point}")
        there = track.moved(self.carried(track.placed, self.at(point), "v"), rates[0])
        self.write_rates(point, there, "v", "slides", values)
        there = track.moved(self.carried(track.placed, self.at(point), "a"), rates[1])
        across = track.across(self.coriolis(track, rates[0]))
        self.write_rates(point, there + across, "a", "slides", values)

    def _finish_rod(self, body: str, start: str) -> None:
        self.reference[body] = start
        self.order.append(body)

    def track(self, slide: SlideEntry, body: str, point: str) -> SlideLine:
        """Return how a point of a body moves that slides on a placed one."""
        slides = body == slide.of
        placed = slide.on if slides else slide.of
        frame = self.heading(placed)
        if not slides:
            start, origin = self.at(slide.at), local_plane(slide.through)
        else:
            start = self.at(slide.through_name) if slide.through_name else self.world(slide.through, placed)
            origin = self.local(slide.at, body)
        base = start + rotated(self.local(point, body) - origin, frame)
        return SlideLine(placed, base, 1 if slides else -1, frame + Heading.of(slide.along.code))

    def coriolis(self, track: SlideLine, speed: str) -> Sum:
        """Return the Coriolis acceleration of what slides, to the left of its line."""
        return Sum.of(speed).times("2", self.omega(track.placed), sign=track.sign)

    def slide_symbol(self, slide: SlideEntry) -> str:
        """Return the symbol of the distance along a slide; none where its name says it."""
        return f"s_{{{slide.at}}}" if slide.distance == f"s_{slide.at}" else ""

    def world(self, place: Place, body: str) -> Plane:
        """Return the coordinates of a place without a name in a placed body's frame."""
        if body == GROUND:
            return local_plane(place)
        origin = self.linkage.bodies[body].at
        return self.at(origin) + rotated(local_plane(place), self.heading(body))

    def _track_place(self, slide: SlideEntry, body: str, place: Place) -> SlideLine:
        """Return how a place of a body moves that slides on a placed one."""
        point = slide.at if body == slide.of else next(iter(self.linkage.bodies[body].points))
        track = self.track(slide, body, point)
        off = rotated(local_plane(place) - self.local(point, body), self.heading(track.placed))
        return track._replace(base=track.base + off)

    def transitive(self, names: Sequence[str]) -> list[Quantity]:
        """Return the quantities that some quantities are computed from, and themselves, by their formulas."""
        results: dict[str, Quantity] = {}
        waiting = [n for n in names if n in self.quantities]
        while waiting:
            quantity = self.quantities[waiting.pop()]
            if quantity.name not in results:
                results[quantity.name] = quantity
                needs = (*quantity.needs, *self.followed.get(quantity.name, ()))
                waiting += [n for n in needs if n in self.quantities]
        return list(results.values())

    def symbol(self, name: str) -> str:
        """Return the LaTeX of a quantity: a length named by two points, such as ``AC``, is written like the
        segment."""
        own = self.quantities.get(name)
        if own is not None and own.symbol:
            return own.symbol
        entry = self.linkage.given.get(name)
        ends = re.fullmatch(r"([A-Z])(\d*)([A-Z])(\d*)", name)
        if entry is not None and entry.unit == "mm" and ends:
            first, number, last, other = ends.groups()
            return (
                f"{first}_{number}" * bool(number)
                + first * (not number)
                + (f" {last}_{other}" if other else last)
            )
        return symbol_of(name)

    @property
    def geometry(self) -> tuple[str, ...]:
        """Given quantities that place the joints."""
        linkage = self.linkage
        joints = {*linkage.pins, *linkage.slides, *(s.through_name for s in linkage.slides.values())}
        names = [n for p, place in linkage.ground.items() if p in joints for n in place.names]
        for body in linkage.bodies.values():
            names += [n for p, place in body.points.items() if p in joints for n in place.names]
        for slide in linkage.slides.values():
            names += [*slide.through.names, *slide.along.names]
        for gear in linkage.gears:
            names += [n for r in gear.radii for n in r.names]
        return tuple(dict.fromkeys(names))


def local_plane(place: Place) -> Plane:
    """Return a place in its frame as a vector."""
    if place.radius is not None:
        return Plane.polar(Sum.of(place.radius.code), Heading.of(place.angle.code))
    return Plane(Sum.of(place.x.code), Sum.of(place.y.code))


def rotated(vector: Plane, frame: Heading) -> Plane:
    """Return a vector of a frame in the ground's directions."""
    cos, sin = frame.cos, frame.sin
    return Plane(vector.x.times(cos) - vector.y.times(sin), vector.x.times(sin) + vector.y.times(cos))


def over(above: Sum, below: Sum) -> str:
    """Return a quotient as code."""
    if above.vanishes:
        return "0.0"
    if below.code == "1":
        return above.code
    if below.code == "-1":
        return (-above).code
    top = above.code if len(above.products) == 1 else f"({above.code})"
    return f"{top} / {below.code}" if below.code.replace("_", "").isalnum() else f"{top} / ({below.code})"


def middle(entry: GivenEntry) -> float:
    """Return a value in the middle of the range of a given quantity."""
    if entry.value is not None:
        return entry.value
    bounds = [float(b.code) for b in (entry.low, entry.high) if b.is_number]
    return sum(bounds) / len(bounds) if bounds else 100.0


def middle_value(vector: Plane, linkage: LinkageFile) -> complex:
    """Return a vector of given quantities, each in the middle of its range, as a number."""
    try:
        return value_of(vector, {n: middle(entry) for n, entry in linkage.given.items()})
    except (ArithmeticError, ValueError):
        names = ", ".join(names_in(vector.complex))
        stated = Message("a place by {names} has no value in the middle of their ranges", names=names)
        raise linkage.refused(("bodies",), stated) from None


def value_of(vector: Plane, values: Mapping[str, float]) -> complex:
    """Return a vector of given quantities as a number."""
    space = {**values, **DEGREES, "np": np}
    return complex(eval(vector.x.code, space), eval(vector.y.code, space))  # written by ExpressionReader


def dotted(symbol: str, order: int) -> str:
    """Return a symbol with as many dots."""
    if not symbol or not order:
        return symbol
    stem, _, index = symbol.partition("_")
    return rf"\{'d' * order}ot{{{stem}}}" + (f"_{index}" if index else "")
