"""Groups of class III and above: their loops, which are closed together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coursework.linkages.entries import (
    GROUND,
    NearEntry,
)
from coursework.linkages.groups import HigherGroup
from coursework.linkages.loop_chains import LoopWriter, back, closure_latex, vector_code
from coursework.linkages.points import Chain, middle, rotated, value_of
from coursework.linkages.terms import Heading
from coursework.messages import Message


class HigherGroupWriter(LoopWriter):
    """Writer of the groups that are no pairs of bodies."""

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
                    loops.append([*there, *back(ways[point])])
                else:
                    ways[point] = there
                    waiting.append(point)
        return loops, list(dict.fromkeys(placed))

    def _near_angle(self, body: str, near: NearEntry) -> float:
        """Return the angle of a body, radians, from the rough places of two of its points."""
        linkage = self.linkage
        values = {n: middle(entry) for n, entry in linkage.given.items()}
        values[linkage.angle] = near.angle
        places = dict(near.places)
        for point in linkage.bodies[body].points:
            if point not in places and point in linkage.ground:
                places[point] = value_of(self.local(point, GROUND), values)
            elif point not in places and point in linkage.bodies[linkage.driver].points:
                crank = linkage.bodies[linkage.driver]
                turned = value_of(rotated(self.local(point, crank.name), Heading.of(linkage.angle)), values)
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

    def _loop_text(self, loops: Sequence[Chain]) -> str:
        """Return the closures in LaTeX."""
        return "\n".join(f"$${closure_latex(loop, self.symbol)}$$" for loop in loops)
