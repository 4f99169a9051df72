"""Loops of a mechanism as vectors that add up to nothing: along the bars from the ground, and back."""

from __future__ import annotations

import math
from collections.abc import Callable

from coursework.linkages.entries import GROUND, SlideEntry
from coursework.linkages.groups import Dyad, Group
from coursework.linkages.points import Chain, PointWriter, local_plane
from coursework.linkages.terms import Heading, Sum


class LoopWriter(PointWriter):
    """Writer of the points and of the loops of a mechanism."""

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
        return [(length, self._frame(body), str(arm.sign), turn)]

    def _frame(self, body: str) -> str:
        """Return the angle of a body in a vector: its quantity, or radians."""
        turn = self.turns[body]
        return turn if turn.startswith("theta") else repr(math.radians(float(turn)))

    def _named(self, value: Sum, name: str, point: str) -> str:
        """Return the name of a length; one that is an expression becomes a quantity."""
        if value.code.isidentifier():
            return value.code
        if name not in self.quantities:
            symbol = name.removeprefix("d_") if name.startswith("d_") else ""
            self.write(name, value.code, "mm", "length", symbol, words={"B": point})
        return name

    def _way(self, point: str) -> Chain:
        """Return the vectors from the origin to a placed point, along bars."""
        if point in self.linkage.ground:
            return self._reached(point, [])
        body, start = self.carrier(point)
        if start == point:
            slide = self.linkage.slides.get(point)
            driven = slide is not None and slide.distance == self.linkage.moved
            return self._slid(slide) if slide is not None and driven else self._reached(point, [])
        return [*self._way(start), *self._steps(body, start, point)]

    def _along(self, slide: SlideEntry) -> tuple[str, str, str, str]:
        """Return the vector along a slide."""
        frame, along = self._frame(slide.on), Heading.of(slide.along.code)
        turn = slide.along.code if along.names else repr(math.radians(along.constant))
        return (slide.distance, turn, "1", "0.0") if frame == "0.0" else (slide.distance, frame, "1", turn)

    def _slid(self, slide: SlideEntry, way: Callable[[str], Chain] | None = None) -> Chain:
        """Return the vectors from the origin to a point that slides on a placed body; ``way`` returns those
        to a placed point, by default along bars."""
        way = way or self._way
        if slide.through_name:
            return [*way(slide.through_name), self._along(slide)]
        origin = self.linkage.bodies[slide.on].at if slide.on != GROUND else ""
        start = self._start_of(slide, origin) or []
        return [*(way(origin) if origin else []), *start, self._along(slide)]

    def _leg(self, body: str, start: str, end: str) -> Chain:
        """Return the vectors on a body from one of its points to another, either of which may slide on it."""
        slides = [self.linkage.slides.get(p) for p in (start, end)]
        if not any(s is not None and s.on == body for s in slides):
            return self._steps(body, start, end)
        origin = self.linkage.bodies[body].at
        ways: list[Chain] = []
        for point, slide in zip((start, end), slides, strict=True):
            if slide is None or slide.on != body:
                ways.append(self._steps(body, origin, point))
            else:
                ways.append([*(self._start_of(slide, origin) or []), self._along(slide)])
        return [*back(ways[0]), *ways[1]]

    def _start_of(self, slide: SlideEntry, origin: str) -> Chain | None:
        """Return the vectors from a point of the guide, or from the ground's origin, to the start of the
        distance along a slide."""
        if slide.through_name:
            return self._steps(slide.on, origin, slide.through_name) if slide.on != GROUND else []
        place = local_plane(slide.through)
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
        frame = self._frame(slide.on)
        return [
            (self._named(v, f"e_{slide.at}", slide.at), frame, "1", repr(turn))
            for v, turn in turns
            if not v.vanishes
        ]

    def closure(self, group: Group) -> Chain | None:
        """Return the loop that a pair of bodies closes, as vectors that add up to nothing; None for a group
        whose vectors have no names."""
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
                else [*self._way(str(first)), *back([*self._way(last), *start, self._along(inner)])]
            )
        ends: list[Chain] = []
        for outer, body in ((first, group.p), (last, group.q)):
            if isinstance(outer, str):
                ends.append([*self._way(outer), *self._steps(body, outer, inner)])
                continue
            if outer.of != body or outer.at != inner:
                return None
            ends.append(self._slid(outer))
        return [*ends[0], *back(ends[1])]

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
        start = point if point in self.linkage.ground else self.carrier(point)[1]
        return [*([] if start == point else self._points_to(start)), point]


def back(vectors: Chain) -> Chain:
    return [(length, angle, str(-int(sign)), turn) for length, angle, sign, turn in vectors]


def vector_code(vector: tuple[str, str, str, str]) -> str:
    """Return a vector of a loop as code."""
    length, angle, sign, turn = (repr(v) if v.isidentifier() else v for v in vector)
    return f"Vector({length}, {angle}, {sign}, {turn})"


def closure_latex(loop: Chain, symbol: Callable[[str], str]) -> str:
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
        elif degrees := 90.0 if angle == "pi / 2" else math.degrees(float(angle) + float(turn)):
            own = f"i\\,{own}" if degrees == 90 else f"{own}\\,e^{{i\\,{degrees:g}^\\circ}}"
        text += f" {'-' if int(sign) < 0 else '+'} {own}"
    return f"{text.removeprefix(' + ').strip()} = 0"
