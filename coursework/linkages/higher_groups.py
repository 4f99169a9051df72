"""Groups of class III and above: their loops, which are closed together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np

from coursework.linkages.entries import GROUND, NearEntry, SlideEntry
from coursework.linkages.expressions import QuantityExpression
from coursework.linkages.groups import HigherGroup, group_joints
from coursework.linkages.loop_chains import LoopWriter, back, closure_latex, vector_code
from coursework.linkages.points import Chain, dotted, local_plane, middle, rotated, value_of
from coursework.linkages.terms import Plane, Sum


class HigherGroupWriter(LoopWriter):
    """Writer of the groups that are not pairs of bodies."""

    def _large(self, group: HigherGroup) -> None:
        linkage = self.linkage
        if linkage.near is None:
            raise linkage.refused(
                ("assembly",) if linkage.assembly else ("bodies", group.bodies[0]),
                "bodies {found} are one group of class {value}: say from where Newton's method "
                'starts: near = {{ {driver}, E = ["120 mm", "80 mm"], … }}',
                found=", ".join(group.bodies),
                value="I" * group.rank if group.rank < 4 else group.rank,
                driver='angle = "60 deg"' if linkage.drive.kind == "turn" else 'length = "60 mm"',
            )
        slides = [s for s in linkage.slides.values() if {s.of, s.on} & {*group.bodies}]
        number = 1 + sum(name.startswith("_chain_") for name in self.quantities)
        loops, closed, placed = self._loops(group)
        self.loops |= {f"loop_{number}_{k}": loop for k, loop in enumerate(loops, start=1)}
        placing = {"0", *(self.turns[b] for b in self.order), linkage.moved}
        turns = {t: b for b in group.bodies if (t := self.turns[b]).startswith("theta") and t not in placing}
        unknowns = [*turns, *(s.distance for s in slides)]
        names = [v[i] for loop in loops for v in loop for i in (0, 1, 3) if v[i].isidentifier()]
        known = tuple(n for n in dict.fromkeys(names) if n not in unknowns)
        near = self._near(turns, slides, linkage.near)
        moving = [n for n in placed if n in self.quantities]
        needed = self.transitive(moving)
        leaves = tuple(dict.fromkeys(n for q in needed for n in q.needs if n not in self.quantities))
        chain, solved = f"_CHAIN_{number}", f"_chain_{number}"
        self.followed[solved] = tuple(q.name for q in needed)
        listed = "".join(f"({', '.join(map(vector_code, loop))},), " for loop in loops)
        self.constants[chain] = (
            f"LargeGroup(({listed}), {tuple(unknowns)!r}, {near!r}, {tuple(closed)!r}, "
            f"{linkage.moved!r}, "
            f"{linkage.near.driver!r}, {self._step!r}, "
            f"lambda: ({''.join(f'{q.name}, ' for q in needed)}))"
        )
        arguments = dict.fromkeys([linkage.moved, *leaves, *(n for n in known if n not in moving)])
        words = {"bodies": ", ".join(group.bodies), "loops": self._loop_text(loops)}
        posed = f"{chain}.pose(dict({', '.join(f'{n}={n}' for n in arguments)}))"
        self.hide(solved, posed, words["bodies"], ", ".join(group_joints(group, linkage)))
        for turn, body in turns.items():
            code, values = f"{solved}.degrees('{turn}')", {**words, "body": body}
            self.write(turn, code, "deg", "turn_large", words=values, silent=True)
        for slide in slides:
            code, values = f"{solved}.values['{slide.distance}']", {**words, "s": slide.distance}
            self.write(
                slide.distance, code, "mm", "slide_large", self.slide_symbol(slide), words=values, silent=True
            )
        self._finish(group, words)
        for order, rates, stem in ((1, "_rates", "omega"), (2, "_gains", "alpha")):
            pairs = []
            for name in moving:
                own = [self._motion(name[1:], kind) for kind in ("v", "a")[:order]]
                codes = ", ".join((v.x if name[0] == "x" else v.y).code for v in own)
                pairs.append(f"{name}=({codes},)")
            if linkage.jack in group.bodies:
                codes = ", ".join((linkage.drive.rates[0], linkage.acceleration or "0.0")[:order])
                pairs.append(f"{linkage.moved}=({codes},)")
            hidden = self.hide(
                f"{rates}_{number}", f"{chain}.rates({solved}, {order}, dict({', '.join(pairs)}))"
            )
            power = "" if order == 1 else "^2"
            for turn, body in turns.items():
                code, values = f"{hidden}['{turn}'][{order - 1}]", {**words, "body": body}
                self.write(
                    turn.replace("theta", stem, 1),
                    code,
                    f"rad/s{power}",
                    f"{stem}_large",
                    words=values,
                    silent=True,
                )
            for slide in slides:
                code, values = f"{hidden}['{slide.distance}'][{order - 1}]", {**words, "s": slide.distance}
                name, symbol = (
                    f"{slide.distance}_{'d' * order}ot",
                    dotted(self.quantities[slide.distance].symbol, order),
                )
                self.write(name, code, f"mm/s{power}", f"{stem}_large", symbol, words=values, silent=True)

    def _loops(self, group: HigherGroup) -> tuple[list[Chain], list[str], list[str]]:
        """Return the independent loops of a group, the joint that closes each, and the names of the
        coordinates of placed points in them."""
        slides = self.linkage.slides
        joints: dict[str, list[str]] = {}
        for point in self.linkage.points:
            on = (slides[point].on,) if point in slides else ()
            joined = dict.fromkeys([*self.linkage.holders(point), *on])
            if len(joined) > 1 and {*joined} & {*group.bodies}:
                joints[point] = [b for b in joined if b in group.bodies]
        placed: list[str] = []
        ways: dict[str, Chain] = {}  #: from the origin to each point
        for point in joints:
            if {*self.linkage.holders(point)} & {*self.order}:
                ways[point] = self._reached(point, placed)
            elif point in slides and slides[point].on in self.order:
                ways[point] = self._slid(slides[point], lambda p: self._reached(p, placed))
        outer = [*ways]
        entries: dict[str, str] = {}  #: of each body, the point from which it is followed
        loops: list[Chain] = []
        closed: list[str] = []  #: joints, by loop
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
                there = [*ways[start], *self._leg(body, start, point)]
                if point in ways:
                    loops.append([*there, *back(ways[point])])
                    closed.append(point)
                else:
                    ways[point] = there
                    waiting.append(point)
        return loops, closed, list(dict.fromkeys(placed))

    def _near(
        self, turns: Mapping[str, str], slides: Sequence[SlideEntry], near: NearEntry
    ) -> dict[str, float]:
        """Return rough angles, radians, and distances, mm, from the rough places of points."""
        linkage = self.linkage
        values = {n: middle(entry) for n, entry in linkage.given.items()} | {linkage.moved: near.driver}
        places = {p: value_of(self.local(p, GROUND), values) for p in linkage.ground}
        places |= {p: value_of(place, values) for p, place in self._driven.items()} | {**near.places}
        results: dict[str, float] = {}
        for turn in turns:
            alike = [b for b in linkage.bodies if self.turns[b] == turn]
            found = next((a for b in alike if (a := self._near_angle(b, places, values)) is not None), None)
            if found is None:
                points = [p for b in alike for p in linkage.bodies[b].points]
                raise linkage.refused(
                    ("assembly", "near"),
                    "near tells the places of two points of body {body}; found {value} of {found}",
                    body=alike[0],
                    value=", ".join(p for p in points if p in places) or "none",
                    found=", ".join(points),
                )
            results[turn] = found
        known = {linkage.moved: float(np.radians(near.driver)), **results}
        for slide in slides:
            if slide.at not in places:
                raise linkage.refused(
                    ("assembly", "near"), "near tells the place of {point}, which slides", point=slide.at
                )
            turn = self.turns[slide.on]
            frame = np.exp(1j * (known[turn] if turn in known else np.radians(float(turn))))
            start = 0j if slide.on == GROUND else places.get(linkage.bodies[slide.on].at, 0j)
            away = places[slide.at] - start
            way = frame * np.exp(1j * np.radians(self._number(slide.along, values)))
            through = value_of(local_plane(slide.through), values) * frame
            results[slide.distance] = float(((away - through) * way.conjugate()).real)
        return results

    def _near_angle(
        self, body: str, places: Mapping[str, complex], values: Mapping[str, float]
    ) -> float | None:
        """Return the angle of a body, radians, from the rough places of two of its points, or of its origin
        and a point that slides on it; None without."""
        linkage = self.linkage
        known = [p for p in linkage.bodies[body].points if p in places]
        if len(known) > 1:
            first, second = known[:2]
            own = value_of(self.local(second, body), values) - value_of(self.local(first, body), values)
            return float(np.angle((places[second] - places[first]) / own)) if own else None
        slide = next((s for s in linkage.slides.values() if s.on == body and s.at in places), None)
        if slide is None or not known:
            return None
        away = places[slide.at] - places[known[0]]
        way = np.exp(1j * np.radians(self._number(slide.along, values)))
        aside = (
            value_of(local_plane(slide.through) - self.local(known[0], body), values) * way.conjugate()
        ).imag
        return float(np.angle(away / (complex(np.sqrt(max(abs(away) ** 2 - aside**2, 0.0)), aside) * way)))

    def _number(self, expression: QuantityExpression, values: Mapping[str, float]) -> float:
        """Return an angle of given quantities, degrees."""
        return float(value_of(Plane(Sum.of(expression.code)), values).real)

    def _finish(self, group: HigherGroup, words: Mapping[str, str]) -> None:
        """Place the bodies of a group by a point of each that a placed body holds, or that slides on one."""
        waiting = list(group.bodies)
        while waiting:
            for body in waiting:
                points = self.linkage.bodies[body].points
                point = next((p for p in points if {*self.linkage.holders(p)} & {*self.order}), None)
                if point is None:
                    slide = next(
                        (s for s in self.linkage.slides.values() if self._slides_on_placed(s, body)), None
                    )
                    if slide is None:
                        continue
                    point = slide.at if slide.of == body else self.linkage.bodies[body].at
                    track = self.track(slide, body, point)
                    self.write_slid(track, point, slide.distance, slide.rates, words)
                self._finish_rod(body, point)
                waiting.remove(body)
                break
            else:
                raise self.linkage.refused(
                    ("bodies", waiting[0]),
                    "body {body} shares no point with a body that stands before it in the file",
                    body=waiting[0],
                )

    def _slides_on_placed(self, slide: SlideEntry, body: str) -> bool:
        return body in (slide.of, slide.on) and ({slide.of, slide.on} - {body}) <= {*self.order}

    @cached_property
    def _driven(self) -> dict[str, Plane]:
        """Coordinates of the points that the driver places, by what is given."""
        linkage = self.linkage
        driver, points = linkage.driver, linkage.bodies[linkage.driver].points
        if linkage.jack:
            return {}
        start = linkage.bodies[driver].at
        base = self.local(start, GROUND) if linkage.drive.kind == "turn" else Plane()
        if linkage.drive.kind == "slide":
            start = self.reference[driver]
            track = self.track(linkage.slides[start], driver, start)
            base = track.moved(track.base, linkage.moved)
        return {
            p: base + rotated(self.local(p, driver) - self.local(start, driver), self.heading(driver))
            for p in points
        }

    @property
    def _step(self) -> float:
        """From one position of the driver to the next: degrees of an angle, or a part of the longest length,
        mm."""
        if self.linkage.drive.kind == "turn":
            return 6.0
        return 0.02 * max(abs(middle(e)) for e in self.linkage.given.values() if e.unit == "mm")

    def _loop_text(self, loops: Sequence[Chain]) -> str:
        """Return the closures in LaTeX."""
        return "\n".join(f"$${closure_latex(loop, self.symbol)}$$" for loop in loops)
