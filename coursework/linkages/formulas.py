"""Quantities of a mechanism, group by group: the formula that a worked solution prints, and the closed form that keeps its digits.

Coordinates of points in mm, angles in degrees; ``xB`` and ``yB``, ``v_B_x`` and ``a_B_x`` are quantities, ``_B`` is the point as a
complex number.
"""

from __future__ import annotations

import ast
import keyword
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from coursework.degrees import atan2, cos, sin, sqrt
from coursework.linkages.groups import Dyad, Group, HigherGroup, Wheel, groups_of
from coursework.linkages.linkage_file import (
    GROUND,
    AssemblyEntry,
    GivenEntry,
    LinkageFile,
    NearEntry,
    Place,
    SlideEntry,
)
from coursework.linkages.terms import Heading, Plane, Sum
from coursework.messages import Message
from coursework.model import symbol_of

Chain: TypeAlias = list[tuple[str, str, str, str]]  #: vectors as code: length, angle, sign, turn

FUNCTIONS = frozenset(
    "sin cos tan sqrt abs atan2 acos asin polar angle wrap np dyads dict "
    "Figure line link ground_pivot pin point slot_link slider rail circle angle_mark max complex Side normal tangential turning polygon_of_velocities polygon_of_accelerations FourBar SliderCrank Degrees from_radians scale_for to_paper turned met off_both verdicts DrawingParts Moving".split()
)
_OTHERS = ("pi", "min", "hypot", "result")  #: names that code or an expression uses besides
_MODES = {"left": "right", "right": "left", "ahead": "behind", "behind": "ahead"}


@dataclass(frozen=True)
class Quantity:
    """Quantity of a solution.

    ``step`` names the sentence that explains it, with its ``words``; a hidden one, whose name begins with an underscore, has none.
    ``stable`` is the code by which it is computed where the formula would lose digits.
    """

    name: str
    code: str
    unit: str = "1"
    symbol: str = ""
    step: str = ""
    words: Mapping[str, str] = field(default_factory=dict)
    stable: str = ""
    silent: bool = False  #: whether its code is no formula to print

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
            lines.append(f'@told_after("{self._first_component}")')
        if self.stable:
            lines.append(f"@stable(lambda {', '.join(names_in(self.stable))}: {self.stable})")
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
    """Named mistake: the quantities that it gets wrong, the wrong codes, and the sentence about it with its words."""

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


class FormulaWriter:
    """Writer of the quantities of a mechanism.

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
                    ("given", name),
                    Message("{name} means something else; call the quantity otherwise", name=name),
                )
        self.groups, self.rank = groups_of(linkage)
        self.quantities: dict[str, Quantity] = {}
        self.turns: dict[str, str] = {GROUND: "0"}
        self.reference: dict[
            str, str
        ] = {}  #: a point of each body whose motion is known before the body's other points
        self.modes: dict[str, AssemblyEntry] = {}  #: by point, where a group has two ways to assemble
        self.order = [GROUND]
        self.mistakes: list[UsualMistake] = []
        self.sines: dict[str, str] = {}  #: by inner joint, the code that vanishes at its dead points
        self.loops: dict[str, Chain] = {}  #: of the larger groups
        self.constants: dict[str, str] = {}  #: of the module, by name
        self.followed: dict[
            str, tuple[str, ...]
        ] = {}  #: by larger group, the quantities that it computes along the driver's way
        self._name_turns()
        self._place_driver()
        for group in self.groups:
            self._place(group)
        for point in linkage.points:  # a length that places one is a quantity, whatever is asked
            self.at(point)

    # --------------------------------------------------------------------- turns

    def _name_turns(self) -> None:
        """Give each body the quantity, or the constant, that turns it; bodies that slide on each other share it."""
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
            elif top == linkage.driver:
                self.turns[name] = linkage.angle
            else:
                self.turns[name] = f"theta{top}" if top.isdigit() else f"theta_{top}"
            if body.angle is not None and body.angle.is_number:
                if top not in (GROUND, name):
                    raise linkage.refused(
                        ("bodies", name),
                        Message(
                            "body {name} slides on {top}, which turns it; it has no angle of its own",
                            name=name,
                            top=top,
                        ),
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
        if self.turns[body] == linkage.angle:
            return linkage.acceleration or "0"
        return self._rate(body, "alpha")

    def _rate(self, body: str, stem: str) -> str:
        turn = self.turns[body]
        return turn.replace("theta", stem, 1) if turn.startswith("theta") else "0"

    # ------------------------------------------------------------------ writing

    def write(
        self, name: str, code: str, unit: str = "1", step: str = "", symbol: str = "", **more: Any
    ) -> str:
        """Add a quantity, and return its name."""
        if name in self.linkage.given:
            raise self.linkage.refused(
                ("given", name),
                Message("{name} follows from the mechanism; call the given quantity otherwise", name=name),
            )
        words = {k: str(v) for k, v in more.pop("words", {}).items()}
        self.quantities[name] = Quantity(name, code, unit, symbol, step, words, **more)
        return name

    def add(self, quantity: Quantity) -> None:
        """Add a quantity as it is; one whose name is given is refused."""
        self.write(quantity.name, quantity.code, quantity.unit)
        self.quantities[quantity.name] = quantity

    def hide(self, name: str, code: str) -> str:
        """Add a hidden quantity, and return its name."""
        if name not in self.quantities:
            self.quantities[name] = Quantity(name, code)
        return name

    # -------------------------------------------------------------------- places

    def local(self, point: str, body: str) -> Plane:
        """Return where a point lies in a body's frame."""
        return _local(self.linkage.place(point, body))

    def arm(self, body: str, start: str, end: str) -> Arm:
        """Return the vector between two points of a body."""
        first, second = self.linkage.place(start, body), self.linkage.place(end, body)
        frame = self.heading(body)
        if first.is_origin and second.radius is not None:
            return Arm(1, Sum.of(second.radius.code), frame + Heading.of(second.angle.code))
        if second.is_origin and first.radius is not None:
            return Arm(-1, Sum.of(first.radius.code), frame + Heading.of(first.angle.code))
        gap = _local(second) - _local(first)
        if gap.y.vanishes:
            if len(gap.x.products) == 1 and gap.x.products[0][0] < 0:
                return Arm(-1, -gap.x, frame)
            return Arm(1, gap.x, frame)
        length, turn = f"d_{start}{end}", f"delta_{start}{end}"
        if length not in self.quantities:
            words = {"P": start, "Q": end, "body": body}
            self.write(
                length,
                f"sqrt(({gap.x.code})**2 + ({gap.y.code})**2)",
                "mm",
                "bar_length",
                f"{start}{end}",
                words=words,
            )
            self.write(
                turn,
                f"atan2({gap.y.code}, {gap.x.code})",
                "deg",
                "bar_direction",
                rf"\delta_{{{start}{end}}}",
                words=words,
            )
        return Arm(1, Sum.of(length), frame + Heading.of(turn))

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

    # --------------------------------------------------------------------- rates

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
            there = before + self._turning(body, self.arm(body, start, point).vector, kind)
            words = {"B": point, "P": start, "body": body}
            step = ("velocity" if kind == "v" else "acceleration") + ("_about" if before.vanishes else "_on")
            unit = "mm/s" if kind == "v" else "mm/s^2"
            for axis, component in (("x", there.x), ("y", there.y)):
                self.write(
                    f"{kind}_{point}_{axis}",
                    component.code,
                    unit,
                    f"{step}_{axis}",
                    f"{kind}_{{{point}{axis}}}",
                    words=words,
                )
        return Plane(Sum.of(f"{kind}_{point}_x"), Sum.of(f"{kind}_{point}_y"))

    def _turning(self, body: str, arm: Plane, kind: str) -> Plane:
        """Return the velocity, or the acceleration, that the turning of a body adds over an arm."""
        if kind == "v":
            return arm.turned.times(self.omega(body))
        return arm.turned.times(self.alpha(body)) - arm.times(
            f"{self.omega(body)}**2" if self.omega(body) != "0" else "0"
        )

    def carried(self, body: str, point: Plane, kind: str) -> Plane:
        """Return the velocity, or the acceleration, of the point of a placed body that lies at coordinates now."""
        if body == GROUND:
            return Plane()
        start = self.reference[body]
        return self._motion(start, kind) + self._turning(body, point - self.at(start), kind)

    # -------------------------------------------------------------------- driver

    def _place_driver(self) -> None:
        driver = self.linkage.driver
        self.reference[driver] = self.linkage.bodies[driver].at
        self.order.append(driver)

    def _place(self, group: Group) -> None:
        match group:
            case Dyad(kind="RRR"):
                self._rrr(group)
            case Dyad(kind="RRP"):
                self._rrp(group)
            case Dyad(kind="RPR"):
                self._rpr(group)
            case Dyad():
                self._two_slides(group)
            case Wheel():
                self._wheel(group)
            case HigherGroup():
                self._large(group)

    def _mode(self, point: str, default: str, ends: tuple[str, str] | None) -> str:
        """Return the quantity that is +1 or -1 by the way in which a group is assembled; ``ends`` of the line whose left is +1."""
        linkage = self.linkage
        entry = linkage.assembly.get(point)
        if entry is None:
            if not default:
                assert ends is not None
                first, last = ends
                raise linkage.refused(
                    ("assembly",),
                    Message(
                        '{point} can be assembled in two ways: [assembly], then {point} = "left of {first} -> {last}"',
                        point=point,
                        first=first,
                        last=last,
                    ),
                )
            entry = AssemblyEntry((default,), ends[0] if ends else "")
        wanted = {"left", "right"} if ends and ends[1] else {"ahead", "behind"}
        if not set(entry.ways) <= wanted:
            raise linkage.refused(
                ("assembly", point),
                Message(
                    "{point} is assembled {found}; found {value}",
                    point=point,
                    found=" or ".join(sorted(wanted)),
                    value=entry.ways[0],
                ),
            )
        sign = 1
        if ends and ends[1]:
            if {entry.start, entry.end} != set(ends):
                raise linkage.refused(
                    ("assembly", point),
                    Message(
                        "{point} lies left or right of {value} -> {value_2}; found {start} -> {end}",
                        point=point,
                        value=ends[0],
                        value_2=ends[1],
                        start=entry.start,
                        end=entry.end,
                    ),
                )
            sign = 1 if (entry.start, entry.end) == ends else -1
        self.modes[point] = entry
        first = entry.ways[0]
        words = {"B": point, "P": entry.start, "Q": entry.end, "way": first}
        name, symbol = f"side_{point}", rf"\varepsilon_{{{point}}}"
        self.mistakes.append(
            UsualMistake(f"other_assembly_{point}", (name,), (f"-{name}",), "other_assembly", words)
        )
        kind = "side" if ends and ends[1] else "ahead"
        if not entry.is_drawn:
            value = sign if first in ("left", "ahead") else -sign
            return self.write(name, str(value), "1", f"{kind}_fixed_{first}", symbol, words=words)
        code = f"{'-' if sign < 0 else ''}np.where(np.isin(mode_{point}, ('left', 'ahead')), 1, -1)"
        return self.write(name, code, "1", f"{kind}_drawn", symbol, words=words)

    # ----------------------------------------------------------------------- RRR

    def _line(self, start: str, end: str, group_words: Mapping[str, str]) -> tuple[str, str]:
        """Write the distance and the direction between two placed points."""
        gap = self.at(end) - self.at(start)
        length, turn = f"d_{start}{end}", f"phi_{start}{end}"
        if turn not in self.quantities:
            words = {"P": start, "Q": end}
            self.write(
                length,
                f"sqrt(({gap.x.code})**2 + ({gap.y.code})**2)",
                "mm",
                "distance",
                f"{start}{end}",
                words=words,
            )
            self.write(
                turn,
                f"atan2({gap.y.code}, {gap.x.code})",
                "deg",
                "direction",
                rf"\varphi_{{{start}{end}}}",
                words=words,
            )
        return length, turn

    def _rrr(self, group: Dyad) -> None:
        P, B, Q = group.outer_p, group.inner, group.outer_q
        assert isinstance(P, str)
        assert isinstance(B, str)
        assert isinstance(Q, str)
        p, q = group.p, group.q
        to_p, to_q = self.arm(p, P, B), self.arm(q, Q, B)
        words = {"P": P, "B": B, "Q": Q, "p": p, "q": q}
        distance, line = self._line(P, Q, words)
        side = self._mode(B, "", (P, Q))
        first, second = to_p.length, to_q.length
        point = self.hide(
            f"_{B}", f"dyads.rrr({self.complex(P)}, {self.complex(Q)}, {first.code}, {second.code}, {side})"
        )
        corner = self.write(
            f"psi_{B}",
            f"acos(({distance}**2 + {first.factor}**2 - {second.factor}**2) / (2 * {distance} * {first.factor}))",
            "deg", "corner", rf"\psi_{{{B}}}", words=words,
            stable=f"abs(wrap(angle({point} - {self.complex(P)}) - angle({self.complex(Q)} - {self.complex(P)})))",
        )  # fmt: skip
        offset = to_p.heading - self.heading(p)
        self._write_turn(p, f"{line} + {side} * {corner}", to_p, offset, P, point, "turn_by_corner", words)
        self._finish_rod(p, P)
        there = self.at(B)
        away = there - self.at(Q)
        self._write_turn(
            q, f"atan2({away.y.code}, {away.x.code})", to_q, to_q.heading - self.heading(q), Q, point, "turn_by_ends", words,
            wrapped=True,
        )  # fmt: skip
        self._finish_rod(q, Q)
        self._rates_rrr(group, to_p, to_q, words)

    def _write_turn(
        self, body: str, code: str, arm: Arm, offset: Heading, start: str, end: str, step: str, words: Mapping[str, str],
        wrapped: bool = False,
    ) -> None:  # fmt: skip
        """Write the angle of a body from the direction of an arm on it, which ends at a hidden point."""
        back = Heading((), 180.0 if arm.sign < 0 else 0.0) + -offset
        rest = back.code if back.names or back.constant else ""
        shifted = (
            f"{code} + {rest}"
            if rest and not rest.startswith("-")
            else f"{code} - {rest[1:]}"
            if rest
            else code
        )
        whole = shifted if wrapped and not rest else f"wrap({shifted})"
        vector = f"{end} - {self.complex(start)}" if arm.sign > 0 else f"{self.complex(start)} - {end}"
        stable = (
            f"angle({vector})"
            if not offset.names and not offset.constant
            else f"wrap(angle({vector}) - ({offset.code}))"
        )
        turned = step if not rest else f"{step}_offset"
        self.write(self.turns[body], whole, "deg", turned, words={**words, "body": body}, stable=stable)

    def _finish_rod(self, body: str, start: str) -> None:
        self.reference[body] = start
        self.order.append(body)

    def _rates_rrr(self, group: Dyad, to_p: Arm, to_q: Arm, words: Mapping[str, str]) -> None:
        P, B, Q, p, q = words["P"], words["B"], words["Q"], group.p, group.q
        between = to_q.heading - to_p.heading
        lever_p, lever_q = to_p.length.times(sign=to_p.sign), to_q.length.times(sign=to_q.sign)
        below_p = lever_p.times(between.sin)
        below_q = lever_q.times((-between).sin)
        arms = f"{self.complex(B)} - {self.complex(P)}, {self.complex(B)} - {self.complex(Q)}"
        v_P, v_Q = self.velocity(P), self.velocity(Q)
        rates = f"_rates_{B}"
        self.hide(rates, f"dyads.rrr_rates({arms}, ({_complex(v_P)},), ({_complex(v_Q)},))")
        turning = {**words}
        for body, own, heading, below, start, index in (
            (p, v_Q - v_P, to_q.heading, below_p, words["q"], 0),
            (q, v_P - v_Q, to_p.heading, below_q, words["p"], 1),
        ):
            self.write(
                self.omega(body), f"{over(own.along(heading), below)}", "rad/s", "omega_rrr",
                words={**turning, "body": body, "other": start}, stable=f"{rates}[{index}][0]",
            )  # fmt: skip
        a_P, a_Q = self.acceleration(P), self.acceleration(Q)
        gains = f"_gains_{B}"
        self.hide(
            gains,
            f"dyads.rrr_rates({arms}, ({_complex(v_P)}, {_complex(a_P)}), ({_complex(v_Q)}, {_complex(a_Q)}))",
        )
        w_p, w_q = f"{self.omega(p)}**2", f"{self.omega(q)}**2"
        above_p = (a_Q - a_P).along(to_q.heading) + lever_p.times(w_p, between.cos) - lever_q.times(w_q)
        above_q = (a_P - a_Q).along(to_p.heading) - lever_p.times(w_p) + lever_q.times(w_q, between.cos)
        self.sines[B] = between.sin
        self.mistakes.append(
            UsualMistake(
                f"normal_terms_forgotten_{B}", (self.alpha(p), self.alpha(q)),
                (over((a_Q - a_P).along(to_q.heading), below_p), over((a_P - a_Q).along(to_p.heading), below_q)),
                "normal_terms_forgotten", words,
            )
        )  # fmt: skip
        for body, above, below, other, index in ((p, above_p, below_p, q, 0), (q, above_q, below_q, p, 1)):
            self.write(
                self.alpha(body), over(above, below), "rad/s^2", "alpha_rrr",
                words={**turning, "body": body, "other": other}, stable=f"{gains}[{index}][1]",
            )  # fmt: skip

    # ----------------------------------------------------------------------- RRP

    def track(self, slide: SlideEntry, body: str, point: str) -> tuple[str, Plane, int, Heading]:
        """Return how a point of a body moves that slides on a placed one: the placed body, the coordinates of the point where the distance
        is 0, the sign of the distance, and the direction of the slide."""
        slides = body == slide.of
        placed = slide.on if slides else slide.of
        frame = self.heading(placed)
        heading = frame + Heading.of(slide.along.code)
        if slides:
            start = self.at(slide.through_name) if slide.through_name else self.world(slide.through, placed)
            return (
                placed,
                start + _rotated(self.local(point, body) - self.local(slide.at, body), frame),
                1,
                heading,
            )
        start = self.at(slide.at)
        return placed, start + _rotated(self.local(point, body) - _local(slide.through), frame), -1, heading

    def world(self, place: Place, body: str) -> Plane:
        """Return the coordinates of a place without a name in a placed body's frame."""
        if body == GROUND:
            return _local(place)
        origin = self.linkage.bodies[body].at
        return self.at(origin) + _rotated(_local(place), self.heading(body))

    def _rrp(self, group: Dyad) -> None:
        P, B, slide = group.outer_p, group.inner, group.outer_q
        assert isinstance(P, str)
        assert isinstance(B, str)
        assert isinstance(slide, SlideEntry)
        p, q = group.p, group.q
        arm = self.arm(p, P, B)
        placed, base, sign, heading = self.track(slide, q, B)
        words = {"P": P, "B": B, "p": p, "q": q, "guide": placed, "s": slide.distance}
        rise = self.at(P) - base
        height = self.write(f"h_{B}", rise.across(heading).code, "mm", "height", f"h_{{{B}}}", words=words)
        side = self._mode(B, "ahead", (P, ""))
        length = arm.length
        unit = f"polar(1, {heading.code})"
        start = self.hide(f"_line_{B}", self._hidden(base))
        point = self.hide(
            f"_{B}", f"dyads.rrp({self.complex(P)}, {length.code}, {start} + 0j, {side}, {unit})"
        )
        reach = f"sqrt({length.factor}**2 - {height}**2)"
        ahead = rise.along(heading)
        run = f"{ahead.code} + {side} * {reach}" if not ahead.vanishes else f"{side} * {reach}"
        distance = self.write(
            slide.distance, run if sign > 0 else f"-({run})", "mm", "slide_rrp", self._slide_symbol(slide), words=words,
            stable=f"{'' if sign > 0 else '-'}(({point} - {start}) * np.conj({unit})).real",
        )  # fmt: skip
        there = base + Plane.polar(Sum.of(distance), heading).times(sign=sign)
        self._write_end(B, there, words, point)
        away = self.at(B) - self.at(P)
        self._write_turn(
            p, f"atan2({away.y.code}, {away.x.code})", arm, arm.heading - self.heading(p), P, point, "turn_by_ends",
            {**words, "Q": P}, wrapped=True,
        )  # fmt: skip
        self._finish_rod(p, P)
        self._finish_rod(q, B)
        self._rates_rrp(words, arm, sign, heading, placed, distance)

    def _write_end(self, point: str, there: Plane, words: Mapping[str, str], hidden: str) -> None:
        for axis, component, half in (("x", there.x, "real"), ("y", there.y, "imag")):
            self.write(
                f"{axis}{point}", component.code, "mm", f"end_{axis}", words=words, stable=f"{hidden}.{half}"
            )

    def _hidden(self, vector: Plane) -> str:
        return vector.complex

    def _slide_symbol(self, slide: SlideEntry) -> str:
        return f"s_{{{slide.at}}}" if slide.distance == f"s_{slide.at}" else ""

    def slide_rates(self, slide: SlideEntry) -> tuple[str, str]:
        """Return the names of the speed along a slide, and of its rate."""
        return f"{slide.distance}_dot", f"{slide.distance}_ddot"

    def _rates_rrp(
        self, words: Mapping[str, str], arm: Arm, sign: int, heading: Heading, placed: str, distance: str
    ) -> None:
        P, B, p = words["P"], words["B"], words["p"]
        speed, gain = f"{distance}_dot", f"{distance}_ddot"
        symbol = self.quantities[distance].symbol
        lever = arm.length.times(sign=arm.sign)
        between = arm.heading - heading
        below = lever.times(between.cos)
        v_P, v_c = self.velocity(P), self.carried(placed, self.at(B), "v")
        moved = "" if v_c.vanishes else "_moved"
        self.write(
            self.omega(p),
            over((v_c - v_P).across(heading), below),
            "rad/s",
            f"omega_rrp{moved}",
            words={**words, "body": p},
        )
        along = (v_P - v_c).along(heading) - lever.times(self.omega(p), between.sin)
        self.write(
            speed,
            along.times(sign=sign).code,
            "mm/s",
            f"slide_rate_rrp{moved}",
            _dotted(symbol, 1),
            words=words,
        )
        rate = self.omega(placed)
        self._write_motion(B, v_c, heading, sign, speed, "v", words, Plane())
        a_P, a_c = self.acceleration(P), self.carried(placed, self.at(B), "a")
        coriolis = Sum.of(speed).times("2", rate, sign=sign)
        square = f"{self.omega(p)}**2"
        above = (a_c - a_P).across(heading) + coriolis + lever.times(square, between.sin)
        self.write(
            self.alpha(p), over(above, below), "rad/s^2", f"alpha_rrp{moved}", words={**words, "body": p}
        )
        along = (
            (a_P - a_c).along(heading)
            - lever.times(self.alpha(p), between.sin)
            - lever.times(square, between.cos)
        )
        self.write(
            gain,
            along.times(sign=sign).code,
            "mm/s^2",
            f"slide_gain_rrp{moved}",
            _dotted(symbol, 2),
            words=words,
        )
        turned = Plane.polar(coriolis, heading + Heading((), 90.0))
        self._write_motion(B, a_c, heading, sign, gain, "a", words, turned)
        self.sines[B] = between.cos
        bare = (a_P - a_c).along(heading) - lever.times(self.alpha(p), between.sin)
        self.mistakes.append(
            UsualMistake(
                f"normal_terms_forgotten_{B}", (self.alpha(p), gain),
                (over((a_c - a_P).across(heading) + coriolis, below), bare.times(sign=sign).code),
                "normal_terms_forgotten", words,
            )
        )  # fmt: skip
        if not coriolis.vanishes:
            wrong = over((a_c - a_P).across(heading) + lever.times(square, between.sin), below)
            self.mistakes.append(
                UsualMistake(
                    f"coriolis_forgotten_{B}", (self.alpha(p),), (wrong,), "coriolis_forgotten", words
                )
            )

    def _write_motion(
        self, point: str, carried: Plane, heading: Heading, sign: int, rate: str, kind: str, words: Mapping[str, str], turned: Plane
    ) -> None:  # fmt: skip
        """Write the velocity, or the acceleration, of a point that slides: that of the guide, along the slide, and the Coriolis term."""
        there = carried + Plane.polar(Sum.of(rate), heading).times(sign=sign) + turned
        unit, what = ("mm/s", "velocity") if kind == "v" else ("mm/s^2", "acceleration")
        for axis, component in (("x", there.x), ("y", there.y)):
            self.write(
                f"{kind}_{point}_{axis}",
                component.code,
                unit,
                f"{what}_slides_{axis}",
                f"{kind}_{{{point}{axis}}}",
                words=words,
            )

    # ----------------------------------------------------------------------- RPR

    def _rpr(self, group: Dyad) -> None:
        P, slide, Q = group.outer_p, group.inner, group.outer_q
        assert isinstance(P, str)
        assert isinstance(slide, SlideEntry)
        assert isinstance(Q, str)
        p, q = group.p, group.q
        direction = Heading.of(slide.along.code)
        constant = _local(slide.through) - self.local(Q, q) + self.local(P, p) - self.local(slide.at, p)
        ahead, aside = constant.along(direction), constant.across(direction)
        words = {"P": P, "Q": Q, "p": p, "q": q, "s": slide.distance, "B": slide.at, "guide": q}
        length, line = self._line(Q, P, words)
        offset = ""
        if not aside.vanishes:
            offset = (
                aside.code
                if aside.code.isidentifier()
                else self.write(f"e_{slide.at}", aside.code, "mm", "offset", f"e_{{{slide.at}}}", words=words)
            )
        side = self._mode(slide.at, "ahead", (Q, ""))
        pair = self.hide(
            f"_guide_{slide.at}",
            f"dyads.rpr({self.complex(P)}, {self.complex(Q)}, {offset or '0.0'}, {side})",
        )
        reach = length if not offset else f"sqrt({length}**2 - {offset}**2)"
        run = f"{side} * {reach}"
        rest = "" if ahead.vanishes else f" - {ahead.factor}"
        distance = self.write(
            slide.distance, run + rest, "mm", "slide_rpr_offset" if offset else "slide_rpr", self._slide_symbol(slide), words=words,
            stable=f"{pair}[1]{rest}",
        )  # fmt: skip
        whole = Sum.of(distance) + ahead
        turn = f"{line} - atan2({offset}, {whole.code})" if offset else f"{line} + 90 * (1 - {side})"
        back = (-direction).code if direction.names or direction.constant else ""
        turn += f" {'- ' + back[1:] if back.startswith('-') else '+ ' + back}" if back else ""
        self.write(
            self.turns[q], f"wrap({turn})", "deg", "turn_rpr_offset" if offset else "turn_rpr", words={**words, "body": q},
            stable=f"wrap(angle({pair}[0]){' ' + ('- ' + back[1:] if back.startswith('-') else '+ ' + back) if back else ''})",
        )  # fmt: skip
        self._finish_rod(q, Q)
        self._finish_rod(p, P)
        heading = self.heading(q) + direction
        speed, gain = self.slide_rates(slide)
        symbol = self.quantities[distance].symbol
        rate, growth = self.omega(q), self.alpha(q)
        v, shift = self.velocity(P) - self.velocity(Q), Sum.of(offset or "0")
        moved = "" if self.velocity(Q).vanishes else "_moved"
        self.write(
            rate, over(v.across(heading), whole), "rad/s", f"omega_rpr{moved}", words={**words, "body": q}
        )
        self.write(
            speed,
            (v.along(heading) + shift.times(rate)).code,
            "mm/s",
            f"slide_rate_rpr{moved}",
            _dotted(symbol, 1),
            words=words,
        )
        a = self.acceleration(P) - self.acceleration(Q)
        above = a.across(heading) + shift.times(f"{rate}**2") - Sum.of(speed).times("2", rate)
        self.write(growth, over(above, whole), "rad/s^2", f"alpha_rpr{moved}", words={**words, "body": q})
        wrong = over(a.across(heading) + shift.times(f"{rate}**2"), whole)
        self.mistakes.append(
            UsualMistake(f"coriolis_forgotten_{slide.at}", (growth,), (wrong,), "coriolis_forgotten", words)
        )
        along = a.along(heading) + shift.times(growth) + whole.times(f"{rate}**2")
        self.write(gain, along.code, "mm/s^2", f"slide_gain_rpr{moved}", _dotted(symbol, 2), words=words)

    # ------------------------------------------------------------------ PRP, RPP

    def _two_slides(self, group: Dyad) -> None:
        """Write a point that is on two lines: the pin of two blocks, or a placed pin that two slides reach."""
        if group.kind == "PRP":
            B = group.inner
            one, other = group.outer_p, group.outer_q
            assert isinstance(B, str)
            assert isinstance(one, SlideEntry)
            assert isinstance(other, SlideEntry)
            guide_1, base_1, sign_1, way_1 = self.track(one, group.p, B)
            guide_2, base_2, sign_2, way_2 = self.track(other, group.q, B)
            gap = base_2 - base_1
            name = B
        else:
            P, inner, outer = group.outer_p, group.inner, group.outer_q
            assert isinstance(P, str)
            assert isinstance(inner, SlideEntry)
            assert isinstance(outer, SlideEntry)
            p, q = group.p, group.q
            frame = self.heading(outer.on if outer.of == q else outer.of)
            if inner.of == p:
                guide_1, base_1, sign_1, way_1 = self._track_place(outer, q, inner.through)
                sign_2 = 1
                base_1 = base_1 + _rotated(self.local(P, p) - self.local(inner.at, p), frame)
            else:
                guide_1, base_1, sign_1, way_1 = self.track(outer, q, inner.at)
                sign_2 = -1
                base_1 = base_1 + _rotated(self.local(P, p) - _local(inner.through), frame)
            one, other = outer, inner
            way_2 = frame + Heading.of(inner.along.code)
            guide_2 = guide_1
            gap = self.at(P) - base_1
            name = P
        between = way_2 - way_1
        below = (
            Sum.of(between.sin)
            if between.sin not in ("1", "-1")
            else Sum.of("1").times(sign=int(between.sin))
        )
        if below.vanishes:
            raise self.linkage.refused(
                ("slides", other.at),
                Message(
                    "the slides at {at} and {at_2} are parallel: they hold nothing", at=one.at, at_2=other.at
                ),
            )
        words = {
            "B": name,
            "p": group.p,
            "q": group.q,
            "s": one.distance,
            "t": other.distance,
            "guide": guide_1,
        }
        sign_of_second = -sign_2 if group.kind == "PRP" else sign_2

        def split(vector: Plane) -> tuple[str, str]:
            """Return the two components of a vector along both slides."""
            along_1 = (vector.x.times(way_2.sin) - vector.y.times(way_2.cos)).times(sign=sign_1)
            along_2 = (vector.y.times(way_1.cos) - vector.x.times(way_1.sin)).times(sign=sign_of_second)
            return over(along_1, below), over(along_2, below)

        def write(vector: Plane, ending: str, unit: str, step: str, order: int) -> None:
            for slide, code in zip((one, other), split(vector), strict=True):
                symbol = _dotted(self._slide_symbol(slide) or "", order)
                self.write(
                    slide.distance + ending, code, unit, step, symbol, words={**words, "s": slide.distance}
                )

        kind = "prp" if group.kind == "PRP" else "rpp"
        write(gap, "", "mm", f"slides_{kind}", 0)
        if group.kind == "PRP":
            there = base_1 + Plane.polar(Sum.of(one.distance), way_1).times(sign=sign_1)
            start_1, start_2 = (
                self.hide(f"_line_{s.at}_{name}", b.complex) for s, b in ((one, base_1), (other, base_2))
            )
            units = [f"polar(1, {way.code})" for way in (way_1, way_2)]
            hidden = self.hide(
                f"_{name}", f"dyads.prp({start_1} + 0j, {units[0]}, {start_2} + 0j, {units[1]})"
            )
            self._write_end(name, there, words, hidden)
            self._finish_rod(group.p, name)
            self._finish_rod(group.q, name)
            carried = [(self.carried(g, self.at(name), "v")) for g in (guide_1, guide_2)]
            write(carried[1] - carried[0], "_dot", "mm/s", f"slides_{kind}_rate", 1)
            self._write_motion(name, carried[0], way_1, sign_1, f"{one.distance}_dot", "v", words, Plane())
            turned = [
                Plane.polar(
                    Sum.of(f"{s.distance}_dot").times("2", self.omega(g), sign=sign), way + Heading((), 90.0)
                )
                for s, g, sign, way in ((one, guide_1, sign_1, way_1), (other, guide_2, sign_2, way_2))
            ]
            there_a = [(self.carried(g, self.at(name), "a")) for g in (guide_1, guide_2)]
            write(
                there_a[1] + turned[1] - there_a[0] - turned[0], "_ddot", "mm/s^2", f"slides_{kind}_gain", 2
            )
            self._write_motion(name, there_a[0], way_1, sign_1, f"{one.distance}_ddot", "a", words, turned[0])
            return
        # The body of the first slide is known by the point of it that the slide moves.
        self._finish_rod(group.p, name)
        moved = one.at if one.of == group.q else next(iter(self.linkage.bodies[group.q].points))
        placed, base, sign, way = self.track(one, group.q, moved)
        hidden = f"_{moved}"
        self.hide(f"_line_{moved}", base.complex)
        self.hide(hidden, f"_line_{moved} + {'-' if sign < 0 else ''}polar({one.distance}, {way.code})")
        self._write_end(moved, base + Plane.polar(Sum.of(one.distance), way).times(sign=sign), words, hidden)
        self._finish_rod(group.q, moved)
        v = self.velocity(name) - self.carried(placed, self.at(name), "v")
        write(v, "_dot", "mm/s", f"slides_{kind}_rate", 1)
        self._write_motion(
            moved,
            self.carried(placed, self.at(moved), "v"),
            way,
            sign,
            f"{one.distance}_dot",
            "v",
            words,
            Plane(),
        )
        rate = self.omega(placed)
        turned = [
            Plane.polar(Sum.of(f"{s.distance}_dot").times("2", rate, sign=n), w + Heading((), 90.0))
            for s, n, w in ((one, sign_1, way_1), (other, sign_2, way_2))
        ]
        a = self.acceleration(name) - self.carried(placed, self.at(name), "a") - turned[0] - turned[1]
        write(a, "_ddot", "mm/s^2", f"slides_{kind}_gain", 2)
        own = Plane.polar(Sum.of(f"{one.distance}_dot").times("2", rate, sign=sign), way + Heading((), 90.0))
        self._write_motion(
            moved,
            self.carried(placed, self.at(moved), "a"),
            way,
            sign,
            f"{one.distance}_ddot",
            "a",
            words,
            own,
        )

    def _track_place(self, slide: SlideEntry, body: str, place: Place) -> tuple[str, Plane, int, Heading]:
        """Return how a place of a body moves that slides on a placed one; as :meth:`_track`."""
        point = slide.at if body == slide.of else next(iter(self.linkage.bodies[body].points))
        placed, base, sign, heading = self.track(slide, body, point)
        return (
            placed,
            base + _rotated(_local(place) - self.local(point, body), self.heading(placed)),
            sign,
            heading,
        )

    # --------------------------------------------------------------------- gears

    def _wheel(self, wheel: Wheel) -> None:
        gear, body = wheel.gear, wheel.body
        first, second = (f"({r.code})" if not r.code.isidentifier() else r.code for r in gear.radii)
        other = gear.first if body == gear.second else gear.second
        own, far = (second, first) if body == gear.second else (first, second)
        sign = "-" if gear.inner else "+"
        words = {"body": body, "other": other, "carrier": gear.carrier}

        def rolled(value: Any) -> str:
            mate, carrier = value(other), value(gear.carrier)
            ratio = f"{far} / {own}"
            about = (
                f"({mate} - {carrier})"
                if carrier != "0" and mate != "0"
                else mate
                if carrier == "0"
                else f"-{carrier}"
            )
            turned = f"{'' if gear.inner else '-'}{ratio} * {about}" if about != "0" else "0"
            turned = turned.replace("--", "").replace("* -", "* -")
            return turned if carrier == "0" else f"{carrier} {'+' if gear.inner else '-'} {ratio} * {about}"

        del sign
        self.write(self.turns[body], rolled(lambda b: self.turns[b]), "deg", "turn_gear", words=words)
        self._finish_rod(body, wheel.at)
        self.write(self.omega(body), rolled(self.omega), "rad/s", "omega_gear", words=words)
        self.write(self.alpha(body), rolled(self.alpha), "rad/s^2", "alpha_gear", words=words)

    # -------------------------------------------------------------- larger groups

    def _large(self, group: HigherGroup) -> None:
        linkage = self.linkage
        if linkage.near is None:
            raise linkage.refused(
                ("assembly",),
                Message(
                    'bodies {found} are one group of class {value}: say from where Newton\'s method starts: near = {{ angle = "60 deg", E = ["120 mm", "80 mm"], … }}',
                    found=", ".join(group.bodies),
                    value="I" * group.rank if group.rank < 4 else group.rank,
                ),
            )
        slides = [s for s in linkage.slides.values() if {s.of, s.on} & {*group.bodies}]
        if slides:
            raise linkage.refused(
                ("slides", slides[0].at),
                Message("a group of class III or higher is solved if all its joints are pins"),
            )
        number = 1 + sum(name.startswith("_chain_") for name in self.quantities)
        loops, placed = self._loops(group)
        self.loops |= {f"loop_{number}_{k}": loop for k, loop in enumerate(loops, start=1)}
        unknowns = [self.turns[body] for body in group.bodies]
        names = [v[i] for loop in loops for v in loop for i in (0, 1, 3) if v[i].isidentifier()]
        known = tuple(n for n in dict.fromkeys(names) if n not in unknowns)
        near = {self.turns[body]: self._near_angle(body, linkage.near) for body in group.bodies}
        moving = [n for n in placed if n in self.quantities]
        needed = self.transitive(moving)
        leaves = tuple(dict.fromkeys(n for q in needed for n in q.needs if n not in self.quantities))
        chain, solved = f"_CHAIN_{number}", f"_chain_{number}"
        self.followed[solved] = tuple(q.name for q in needed)
        listed = "".join(f"({', '.join(map(vector_code, loop))},), " for loop in loops)
        self.constants[chain] = (
            f"LargeGroup(({listed}), {tuple(unknowns)!r}, {near!r}, {linkage.angle!r}, {linkage.near.angle!r}, "
            f"lambda: ({''.join(f'{q.name}, ' for q in needed)}))"
        )
        arguments = dict.fromkeys([linkage.angle, *leaves, *(n for n in known if n not in moving)])
        words = {"bodies": ", ".join(group.bodies), "loops": self._loop_text(loops)}
        self.hide(solved, f"{chain}.pose(dict({', '.join(f'{n}={n}' for n in arguments)}))")
        for body in group.bodies:
            turn = self.turns[body]
            self.write(
                turn,
                f"{solved}.degrees('{turn}')",
                "deg",
                "turn_large",
                words={**words, "body": body},
                silent=True,
            )
        for body in group.bodies:
            self._finish_rod(body, self._reachable(body))
        for order, rates, stem in ((1, "_rates", "omega"), (2, "_gains", "alpha")):
            pairs = []
            for name in moving:
                own = [self._motion(name[1:], kind) for kind in ("v", "a")[:order]]
                codes = ", ".join((v.x if name[0] == "x" else v.y).code for v in own)
                pairs.append(f"{name}=({codes},)")
            hidden = self.hide(
                f"{rates}_{number}", f"{chain}.rates({solved}, {order}, dict({', '.join(pairs)}))"
            )
            for body in group.bodies:
                name, unit = (self.omega(body), "rad/s") if order == 1 else (self.alpha(body), "rad/s^2")
                code = f"{hidden}['{self.turns[body]}'][{order - 1}]"
                self.write(name, code, unit, f"{stem}_large", words={**words, "body": body}, silent=True)

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

    def _loops(self, group: HigherGroup) -> tuple[list[Chain], list[str]]:
        """Return the independent loops of a group, and the names of the coordinates of placed points in them."""
        joints = {
            point: [b for b in bodies if b in group.bodies]
            for point, bodies in self.linkage.pins.items()
            if set(bodies) & set(group.bodies)
        }
        outer = [p for p in joints if set(self.linkage.holders(p)) & set(self.order)]
        placed: list[str] = []
        ways = {point: self._reached(point, placed) for point in outer}  #: from the origin to each point
        entries: dict[str, str] = {}  #: of each body, the point from which it is followed
        loops: list[Chain] = []
        waiting, done = list(outer), set()
        while waiting:  # points and bodies in turn; what is reached twice closes a loop
            item = waiting.pop(0)
            ends = (
                [(b, item) for b in joints[item]]
                if item in joints
                else [(item, p) for p in joints if item in joints[p]]
            )
            for body, point in ends:
                if (body, point) in done:
                    continue
                done.add((body, point))
                if body not in entries:
                    entries[body] = point
                    waiting.append(body)
                    continue
                start = entries[body]
                there = [*ways[start], *self._steps(body, start, point)]
                if point in ways:
                    loops.append([*there, *_back(ways[point])])
                else:
                    ways[point] = there
                    waiting.append(point)
        return loops, list(dict.fromkeys(placed))

    def _reached(self, point: str, placed: list[str]) -> Chain:
        """Return the vectors from the origin to a placed point."""
        vectors: Chain = []
        place = self.at(point)
        for axis, turn, component in (("x", "0.0", place.x), ("y", "pi / 2", place.y)):
            if not component.vanishes:
                name = self._named(component, f"{axis}{point}", point)
                placed.append(name)
                vectors.append((name, turn, "1", "0.0"))
        return vectors

    def _steps(self, body: str, start: str, end: str) -> Chain:
        """Return the vector on a body between two of its points, none where they are one."""
        if start == end:
            return []
        arm = self.arm(body, start, end)
        length = self._named(arm.length, f"d_{start}{end}", end)
        offset = arm.heading - self.heading(body)
        if not offset.names:
            turn = repr(math.radians(offset.constant))
        elif offset.code.isidentifier():
            turn = offset.code
        else:
            turn = f"delta_{start}{end}"
            if turn not in self.quantities:
                words = {"P": start, "Q": end, "body": body}
                self.write(
                    turn, offset.code, "deg", "bar_direction", rf"\delta_{{{start}{end}}}", words=words
                )
        return [(length, self.turns[body], str(arm.sign), turn)]

    def _named(self, value: Sum, name: str, point: str) -> str:
        """Return the name of a length; one that is an expression becomes a quantity."""
        if value.code.isidentifier():
            return value.code
        if name not in self.quantities:
            self.write(name, value.code, "mm", "length", words={"B": point})
        return name

    def _near_angle(self, body: str, near: NearEntry) -> float:
        """Return the angle of a body, radians, from the rough places of two of its points."""
        linkage = self.linkage
        values = {n: _middle(entry) for n, entry in linkage.given.items()}
        values[linkage.angle] = near.angle
        places = dict(near.places)
        for point in linkage.bodies[body].points:
            if point not in places and point in linkage.ground:
                places[point] = value_of(self.local(point, GROUND), values)
            elif point not in places and point in linkage.bodies[linkage.driver].points:
                crank = linkage.bodies[linkage.driver]
                turned = value_of(_rotated(self.local(point, crank.name), Heading.of(linkage.angle)), values)
                places[point] = value_of(self.local(crank.at, GROUND), values) + turned
        points = [p for p in linkage.bodies[body].points if p in places]
        if len(points) < 2:
            raise linkage.refused(
                ("assembly", "near"),
                Message(
                    "near tells the places of two points of body {body}; found {value} of {found}",
                    body=body,
                    value=", ".join(points) or "none",
                    found=", ".join(linkage.bodies[body].points),
                ),
            )
        first, second = points[:2]
        own = value_of(self.local(second, body), values) - value_of(self.local(first, body), values)
        return float(np.angle((places[second] - places[first]) / own))

    def closure(self, group: Group) -> Chain | None:
        """Return the loop that a pair of bodies closes, as vectors that add up to nothing; None for a group whose vectors have no names."""
        if not isinstance(group, Dyad):
            return None
        inner, first, last = group.inner, group.outer_p, group.outer_q
        if isinstance(inner, SlideEntry):
            if not isinstance(last, str) or inner.at != first:
                return None
            start = self._start_of(inner, last)
            return (
                None
                if start is None
                else [*self._way(str(first)), *_back([*self._way(last), *start, self._along(inner)])]
            )
        ends: list[Chain] = []
        for outer, body in ((first, group.p), (last, group.q)):
            if isinstance(outer, str):
                ends.append([*self._way(outer), *self._steps(body, outer, inner)])
                continue
            origin = outer.through_name or (self.linkage.bodies[outer.on].at if outer.on != GROUND else "")
            start = self._start_of(outer, origin)
            if outer.of != body or outer.at != inner or start is None:
                return None
            ends.append([*(self._way(origin) if origin else []), *start, self._along(outer)])
        return [*ends[0], *_back(ends[1])]

    def around(self, group: Group) -> tuple[str, ...]:
        """Return the points that the loop of a pair of bodies passes, in order."""
        if not isinstance(group, Dyad):
            return ()
        inner = group.inner.at if isinstance(group.inner, SlideEntry) else group.inner
        ends = [
            self._points_to(o) if isinstance(o, str) else self._points_to(o.through_name)
            for o in (group.outer_p, group.outer_q)
        ]
        return tuple(dict.fromkeys([*ends[0], inner, *reversed(ends[1])]))

    def _points_to(self, point: str) -> list[str]:
        if not point:
            return []
        if point in self.linkage.ground:
            return [point]
        return [*self._points_to(self.carrier(point)[1]), point]

    def _start_of(self, slide: SlideEntry, origin: str) -> Chain | None:
        """Return the vectors from a point of the guide, or from the ground's origin, to the start of the distance along a slide."""
        if slide.through_name:
            return self._steps(slide.on, origin, slide.through_name) if slide.on != GROUND else []
        place = _local(slide.through)
        if slide.on == GROUND:
            axes = (("x", "0.0", place.x), ("y", "pi / 2", place.y))
            return [
                (self._named(v, f"{a}_{slide.at}", slide.at), turn, "1", "0.0")
                for a, turn, v in axes
                if not v.vanishes
            ]
        if origin != self.linkage.bodies[slide.on].at:
            return None
        turns = ((place.x, 0.0), (place.y, math.pi / 2))
        frame = self.turns[slide.on]
        return [
            (self._named(v, f"e_{slide.at}", slide.at), frame, "1", repr(turn))
            for v, turn in turns
            if not v.vanishes
        ]

    def _way(self, point: str) -> Chain:
        """Return the vectors from the origin to a placed point, along bars."""
        if point in self.linkage.ground:
            return self._reached(point, [])
        body, start = self.carrier(point)
        return [*self._way(start), *self._steps(body, start, point)]

    def _along(self, slide: SlideEntry) -> tuple[str, str, str, str]:
        """Return the vector along a slide."""
        frame, along = self.turns[slide.on], Heading.of(slide.along.code)
        if frame.startswith("theta"):
            turn = slide.along.code if along.names else repr(math.radians(along.constant))
            return slide.distance, frame, "1", turn
        return (
            slide.distance,
            slide.along.code if along.names else repr(math.radians(along.constant)),
            "1",
            "0.0",
        )

    def _loop_text(self, loops: Sequence[Chain]) -> str:
        """Return the closures in LaTeX."""
        return "\n".join(f"$${_closure(loop, self.symbol)}$$" for loop in loops)

    def symbol(self, name: str) -> str:
        """Return the LaTeX of a quantity: a length named by two points, such as ``AC``, is written like the segment."""
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

    def _reachable(self, body: str) -> str:
        """Return a point of a body that lies on a body placed before it."""
        points = self.linkage.bodies[body].points
        for point in points:
            if any(h in self.order for h in self.linkage.holders(point)):
                return point
        raise self.linkage.refused(
            ("bodies", body),
            Message("body {body} shares no point with a body that stands before it in the file", body=body),
        )

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


def _local(place: Place) -> Plane:
    if place.radius is not None:
        return Plane.polar(Sum.of(place.radius.code), Heading.of(place.angle.code))
    return Plane(Sum.of(place.x.code), Sum.of(place.y.code))


def _rotated(vector: Plane, frame: Heading) -> Plane:
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


def _complex(vector: Plane) -> str:
    return vector.complex


def _dotted(symbol: str, order: int) -> str:
    if not symbol or not order:
        return symbol
    stem, _, index = symbol.partition("_")
    return rf"\{'d' * order}ot{{{stem}}}" + (f"_{index}" if index else "")


def _back(vectors: Chain) -> Chain:
    return [(length, angle, str(-int(sign)), turn) for length, angle, sign, turn in vectors]


def vector_code(vector: tuple[str, str, str, str]) -> str:
    """Return a vector of a loop as code."""
    length, angle, sign, turn = (repr(v) if v.isidentifier() else v for v in vector)
    return f"Vector({length}, {angle}, {sign}, {turn})"


def _closure(loop: Chain, symbol: Callable[[str], str]) -> str:
    """Return a loop in LaTeX: vectors that add up to nothing."""
    text = ""
    for length, angle, sign, turn in loop:
        own = symbol(length)
        if angle.isidentifier():
            constant = 0.0 if turn.isidentifier() else math.degrees(float(turn))
            more = (
                f" + {symbol(turn)}" if turn.isidentifier() else f" + {constant:g}^\\circ" if constant else ""
            )
            own += f"\\,e^{{i({symbol(angle)}{more})}}" if more else f"\\,e^{{i{symbol(angle)}}}"
        elif angle != "0.0":
            own = f"i\\,{own}"
        text += f" {'-' if int(sign) < 0 else '+'} {own}"
    return f"{text.removeprefix(' + ').strip()} = 0"


def _middle(entry: GivenEntry) -> float:
    """Return a value in the middle of the range of a given quantity."""
    if entry.value is not None:
        return entry.value
    bounds = [float(b.code) for b in (entry.low, entry.high) if b.is_number]
    return sum(bounds) / len(bounds) if bounds else 100.0


def middle_value(vector: Plane, linkage: LinkageFile) -> complex:
    """Return a vector of given quantities, each in the middle of its range, as a number."""
    return value_of(vector, {n: _middle(entry) for n, entry in linkage.given.items()})


def value_of(vector: Plane, values: Mapping[str, float]) -> complex:
    """Return a vector of given quantities as a number."""
    space = {**values, "sin": sin, "cos": cos, "sqrt": sqrt, "atan2": atan2, "np": np}
    return complex(eval(vector.x.code, space), eval(vector.y.code, space))  # written by ExpressionReader


def other_way(way: str) -> str:
    """Return the other way to assemble a group."""
    return _MODES[way]
