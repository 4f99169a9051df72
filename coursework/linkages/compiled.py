"""Compiler of a mechanism's file: the modules and texts of an exercise and of its solution, as an author
would have written them."""

from __future__ import annotations

import itertools
import linecache
import os
import re
import sys
import weakref
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path
from types import ModuleType

from coursework.errors import BadInput, CourseworkError
from coursework.linkages.drawing import FigureWriter
from coursework.linkages.entries import GROUND, GivenEntry, LinkageFile, Place, SlideEntry
from coursework.linkages.exact_loops import keep_digits
from coursework.linkages.expressions import ExpressionReader, QuantityExpression
from coursework.linkages.formulas import FormulaWriter
from coursework.linkages.groups import Dyad, HigherGroup, group_joints
from coursework.linkages.linkage_file import author_faults, read_linkage
from coursework.linkages.loop_chains import vector_code
from coursework.linkages.points import Quantity, names_in
from coursework.linkages.questions import QuestionWriter
from coursework.linkages.sentences import exercise_text, solution_text, spoken
from coursework.linkages.still_sides import equal_in_all, refuse_still_sides
from coursework.linkages.vectors import PAPER_MM, POLYGONS
from coursework.markup.symbols import symbol_of
from coursework.messages import Message, as_message

_IMPORTS = """\
import numpy as np
from math import pi

from coursework.degrees import acos, angle, asin, atan2, cos, from_radians, polar, sin, sqrt, tan, wrap
from coursework.kinematics import dyads
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.four_bar import FourBar
from coursework.kinematics.slider_crank import SliderCrank
from coursework.linkages.closure import SlideTrack, closure_gaps, length_at, reference_values, turns_round
from coursework.linkages.large import LargeGroup
from coursework.linkages.meeting import meeting
"""
_EXERCISE_IMPORTS = """\
from coursework.figures import (
    Figure, angle_mark, circle, ground_pivot, line, link, pin, point, rail, slider, slot_link,
)
from coursework.messages import Message
from coursework.model import Driver, Exercise, Jack, Part, chosen, detectable, drawn, fixed
"""
_SOLUTION_IMPORTS = """from coursework.figures.polygons import (
    Side, normal, polygon_of_accelerations, polygon_of_velocities, tangential, turning,
)
from coursework.mechanics import Body, Gear, Load, Mechanism, Slide
from coursework.marking.drawn_polygons import (
    DrawingParts, if_long, met, off_both, scale_for, to_paper, turned, verdicts,
)
from coursework.solution import Moving, given, judge, mistake, stable, explained_after
"""


@dataclass(frozen=True)
class CompiledLinkage:
    """Mechanism compiled from its file."""

    linkage: LinkageFile

    @cached_property
    def formulas(self) -> FormulaWriter:
        writer = FormulaWriter(self.linkage)
        keep_digits(writer)
        return writer

    @cached_property
    def questions(self) -> QuestionWriter:
        return QuestionWriter(self.formulas)

    # ------------------------------------------------------------------ exercise

    @cached_property
    def exercise(self) -> str:
        """Source of the exercise's module."""
        figure = FigureWriter(self.formulas)
        _ = self.questions  # which add their quantities
        conditions, constants = self._constraints()
        drawn = names_in(figure.code.replace("\n", " "))
        wanted = [*drawn, *self.formulas.followed_turns]
        helpers = [q for q in self.formulas.transitive(wanted) if q.name not in self.linkage.given]
        chains = [f"{n} = {code}" for n, code in self.formulas.constants.items()]
        pieces = [
            _IMPORTS,
            _EXERCISE_IMPORTS,
            *chains,
            *(_plain(q) for q in helpers),
            constants,
            *(code for _, code in conditions),
            f"def figure({', '.join(drawn)}):\n    return {figure.code}",
            self._poses(),
            self._statement(
                [*(q.name for q in helpers), *(["crank_turns"] if constants else [])],
                [name for name, _ in conditions],
            ),
        ]
        return "\n\n\n".join(p for p in pieces if p)

    def _statement(self, helpers: list[str], conditions: list[str]) -> str:
        linkage = self.linkage
        given = [f"        {n!r}: {_given(entry)}," for n, entry in linkage.given.items()]
        for point, entry in self.formulas.modes.items():
            if entry.is_drawn:
                given.append(f"        'mode_{point}': chosen({', '.join(map(repr, entry.ways))}),")
        parts = [f"        {q.source}," for q in self.questions.questions]
        symbols = {
            n: q.symbol for n, q in self.formulas.quantities.items() if q.symbol and not n.startswith("_")
        }
        symbols |= {
            n: self.formulas.symbol(n) for n in linkage.given if self.formulas.symbol(n) != symbol_of(n)
        }
        symbols |= {
            f"mode_{p}": rf"\mathrm{{mode}}_{{{p}}}" for p, e in self.formulas.modes.items() if e.is_drawn
        }
        drawing = f"\n    drawing_mm={PAPER_MM}," if self.questions.polygons else ""
        return (
            "EXERCISE = Exercise(\n    given={\n" + "\n".join(given) + "\n    },\n"
            f"    helpers=({''.join(f'{n}, ' for n in helpers)}),\n"
            f"    constraints=({''.join(f'{c}, ' for c in conditions)}),\n"
            "    parts=(\n" + "\n".join(parts) + "\n    ),\n"
            f"    figure=figure,\n    version={linkage.version},\n    "
            f"symbols={symbols!r},{self._driver()}{drawing}\n)"
        )

    def _driver(self) -> str:
        """Return the driver as code of a field; nothing where a length drives whose limits nobody knows, or
        that turns nothing."""
        linkage = self.linkage
        if linkage.drive.kind == "turn":
            effort = ", effort='torque'" if "torque" in self.formulas.quantities else ""
            return (
                f"\n    driver=Driver({linkage.moved!r}, {linkage.speed!r}, "
                f"{linkage.acceleration!r}{effort}),"
            )
        if not self._followed:
            return ""
        rates = ", ".join(map(repr, (linkage.moved, *linkage.drive.rates)))
        return (
            f"\n    driver=Driver({self._followed!r}, poses=poses, jack=Jack({rates}, "
            f"limits={linkage.drive.limits!r})),"
        )

    @property
    def _followed(self) -> str:
        """The angle by which a scene counts where a length drives: that of a body on a fixed pivot, or the
        first."""
        linkage, formulas = self.linkage, self.formulas
        if linkage.drive.kind == "turn" or not all(linkage.drive.limits) or not linkage.speed:
            return ""
        turning = [b for b in formulas.order if formulas.turns[b].startswith("theta")]
        pivoted = [
            b for b in turning if {*linkage.bodies[b].points} & {*linkage.ground} and b != linkage.driver
        ]
        return next((formulas.turns[b] for b in (*pivoted, *turning)), "")

    def _poses(self) -> str:
        """Return the code of the driven length at an angle of the body by which a scene counts."""
        if not (angle := self._followed):
            return ""
        moved, limits = self.linkage.moved, self.linkage.drive.limits
        leaves = [n for n in self._leaves((angle,)) if n != moved]
        graph = "".join(f"{q.name}, " for q in self.formulas.transitive((angle,)))
        values = ", ".join(f"{n}={n}" for n in leaves)
        listed = ", ".join(dict.fromkeys(["driven", *leaves, *limits]))
        return (
            f"def poses({listed}):\n"
            f"    return {{{moved!r}: length_at(lambda: ({graph}), {angle!r}, {moved!r}, driven, "
            f"({', '.join(limits)}), dict({values}))}}"
        )

    def _constraints(self) -> tuple[list[tuple[str, str]], str]:
        """Return the constraints, names with code, and what of the module they need."""
        linkage, formulas = self.linkage, self.formulas
        results: list[tuple[str, str]] = []
        helpers = ""
        # Of what the file requires something itself, a rate or a joint, it states the least.
        stated = {word for text in linkage.required for word in re.findall(r"[A-Za-z_]\w*", text)}
        results += self._closing()
        varies = any(entry.value is None for entry in linkage.given.values()) or any(
            e.is_drawn for e in formulas.modes.values()
        )
        if varies and formulas.sines:
            sines = {p: sine for p, sine in formulas.sines.items() if names_in(sine) and p not in stated}
            code = " & ".join(f"(abs({sine}) > 0.15)" for sine in sines.values())
            if code:
                said = "no dead point is near (by 9°; require = {example} states another least)"
                example = f"transmission_angle({next(iter(sines))}) > 4 deg"
                results.append(_condition("no_dead_point_is_near", code, _least(said, example)))
        for polygon in self.questions.polygons if varies else ():
            lines, lengths = ", ".join(polygon.lines), ", ".join(polygon.lengths)
            code = f"np.maximum.reduce([{lengths}]) > 45 * {polygon.scale}"
            results.append(_condition(f"{polygon.kind}_polygon_is_large_enough_to_judge", code))
            code = f"np.minimum.reduce([{lines}]) > {polygon.least} * np.maximum.reduce([{lengths}])"
            results.append(_condition(f"{polygon.kind}_vectors_are_long_enough_to_draw", code))
        asked = [q.name for q in self.questions.questions]
        rates = [
            n
            for n in asked
            if n.startswith(("omega", "alpha"))
            and n in formulas.quantities
            and names_in(formulas.quantities[n].code)
            and n not in stated
        ]
        if linkage.drive.kind != "turn":  # a length's rate is not an angle's
            rates = []
        if varies and linkage.speed and rates:
            slow = [
                f"(abs({n}) > 0.02 * {linkage.speed}**{2 if n.startswith('alpha') else 1})".replace("**1", "")
                for n in rates
            ]
            code = " & ".join(
                s.replace(f"0.02 * {linkage.speed})", f"0.02 * abs({linkage.speed}))") for s in slow
            )
            said = "bodies turn visibly (by 2 % of the driver; require = {example} states another least)"
            example = f"abs({rates[0]}) > 0.1 {formulas.quantities[rates[0]].unit}"
            results.append(_condition("bodies_turn_visibly", code, _least(said, example)))
        if varies and (swings := self._swings({*asked} - stated)):
            said = (
                "slides move visibly (by 2 % of the longest length; require = {example} states another least)"
            )
            example = f"abs({next(iter(swings))}) > 1 mm/s"
            results.append(
                _condition("slides_move_visibly", " & ".join(swings.values()), _least(said, example))
            )
        reader = ExpressionReader(
            {
                **{n: e.unit for n, e in linkage.given.items()},
                **{n: q.unit for n, q in formulas.quantities.items() if not n.startswith("_")},
            },
            {"is_crank": self._is_crank, "transmission_angle": self._transmission_angle},
        )
        for number, text in enumerate(linkage.required):
            try:
                found = reader.condition(text)
            except BadInput:
                raise
            except CourseworkError as fault:
                raise linkage.refused(("given", "require"), fault.args[0]) from fault
            name = f"required_{number + 1}"
            results.append(_condition(name, found.code, repr(text)))
        if any("crank_turns" in code for _, code in results):
            leaves = [n for n in self._leaves(self.formulas.followed_turns) if n != linkage.moved]
            graph = "".join(f"{q.name}, " for q in formulas.transitive(self.formulas.followed_turns))
            helpers = (
                f"def crank_turns({', '.join(leaves)}):\n"
                f"    return turns_round(lambda: ({graph}), {self.formulas.followed_turns!r}, "
                f"{linkage.moved!r}, dict({', '.join(f'{n}={n}' for n in leaves)}))"
            )
        modes = [f"other_assembly_{p}" for p in formulas.modes]
        numbers = [
            q.name
            for q in self.questions.questions
            if q.fields.get("kind") in (None, '"angle"') and q.name != "mobility"
        ]
        if varies and numbers:
            wanted = self._affected(numbers)
            results += [
                (f"detectable({m!r}, {', '.join(map(repr, wanted[m]))})", "") for m in modes if wanted.get(m)
            ]
        return results, helpers

    def _swings(self, asked: Collection[str]) -> dict[str, str]:
        """Return conditions that slides go to and fro by more than a fiftieth of the longest length, as
        code by speed, of each of which a rate is asked.

        Of a motion to and fro, the speed and the acceleration together, over those of the driver, are half
        the travel at every instant: at a dead centre as in the middle.
        """
        linkage = self.linkage
        lengths = [f"abs({n})" for n in self.formulas.geometry if linkage.given[n].unit == "mm"]
        if not linkage.speed or not lengths:
            return {}
        longest = f"np.maximum.reduce(np.broadcast_arrays({', '.join(lengths)}))"
        rate = f"abs({linkage.speed})" + ("" if linkage.drive.kind == "turn" else f" / {longest}")
        return {
            s.rates[0]: f"(np.hypot({s.rates[0]} * {rate}, {s.rates[1]}) > 0.01 * {longest} * ({rate})**2)"
            for s in linkage.followed_slides
            if {*s.rates} & {*asked}
        }

    def _closing(self) -> Iterator[tuple[str, str]]:
        """Yield a constraint for each group: that its bodies meet, wherever the groups before it do."""
        before: list[str] = []
        for number, group in enumerate(self.formulas.groups, 1):
            own = [self.formulas.turns[body] for body in group.bodies]
            turns = [t for t in dict.fromkeys(own) if t in self.formulas.followed_turns and t not in before]
            if not turns:
                continue
            code = _all_finite(turns)
            name = f"group_{number}_closes"
            said = (
                f"Message('bodies {{bodies}} meet at {{joints}}', bodies={', '.join(group.bodies)!r}, "
                f"joints={', '.join(group_joints(group, self.linkage))!r})"
            )
            yield _condition(name, f"{code} | ~({_all_finite(before)})" if before else code, said)
            before += turns

    def _affected(self, numbers: list[str]) -> dict[str, list[str]]:
        """Return the asked numbers that depend on the side of each assembly, by mistake."""
        results: dict[str, list[str]] = {}
        for point in self.formulas.modes:
            side = f"side_{point}"
            results[f"other_assembly_{point}"] = [
                n for n in numbers if any(q.name == side for q in self.formulas.transitive([n]))
            ]
        return results

    def _leaves(self, names: tuple[str, ...]) -> list[str]:
        needed = self.formulas.transitive(names)
        return list(dict.fromkeys(n for q in needed for n in q.needs if n not in self.formulas.quantities))

    def _is_crank(self, *arguments: str) -> QuantityExpression:
        if arguments != (self.linkage.driver,) or self.linkage.drive.kind != "turn":
            raise self.linkage.refused(
                ("given", "require"),
                "is_crank({driver}) says that the driven body turns all round; found is_crank({found})",
                driver=self.linkage.driver,
                found=", ".join(arguments),
            )
        return QuantityExpression("crank_turns", ("crank_turns",))

    def _transmission_angle(self, *arguments: str) -> QuantityExpression:
        sines = self.formulas.sines
        if len(arguments) != 1 or arguments[0] not in sines:
            raise self.linkage.refused(
                ("given", "require"),
                "transmission_angle(B) is that at an inner joint: {value}; found {found}",
                value=", ".join(sines) or "there is none",
                found=", ".join(arguments),
            )
        code = f"np.degrees(np.arcsin(np.minimum(abs({sines[arguments[0]]}), 1)))"
        return QuantityExpression(code, names_in(code))

    # ------------------------------------------------------------------ solution

    @cached_property
    def solution(self) -> str:
        """Source of the solution's module."""
        questions, formulas = self.questions, self.formulas
        motion = self._motion()  # which adds the rates of points that nothing else needs
        quantities = formulas.quantities.values()
        asked = {q.name for q in questions.questions}
        units = {q.name: q.unit for q in quantities if not q.name.startswith("_") and q.name not in asked}
        symbols = {q.name: q.symbol for q in quantities if q.symbol and not q.name.startswith("_")}
        loops = "".join(
            f"    {name!r}: ({', '.join(map(vector_code, loop))},),\n"
            for name, loop in formulas.loops.items()
        )
        pieces = [
            _IMPORTS,
            _SOLUTION_IMPORTS,
            f"UNITS = {units!r}\nSYMBOLS = {symbols!r}",
            f"LOOPS = {{\n{loops}}}" if loops else "",
            f"MECHANISM = {self._mechanism()}",
            f"TRACKS = ({''.join(self._tracks())})\nSIDES = ({''.join(self._sides())})",
            *(f"{n} = {code}" for n, code in formulas.constants.items()),
            *(q.source for q in quantities),
            *(m.source for m in questions.mistakes if all(t in formulas.quantities for t in m.targets)),
            self._polygons(),
            motion,
            self._residual(),
            self._known(),
        ]
        return "\n\n\n".join(p for p in pieces if p)

    def _polygons(self) -> str:
        """Return the code of the polygons that are asked, with their judges; nothing where none is.

        Both take what is given alone: an answer that is wrong elsewhere changes no drawing.
        """
        polygons = self.questions.polygons
        if not polygons:
            return ""
        names = dict.fromkeys(n for p in polygons for n in names_in(p.code("scale")) if n != "scale")
        given = [n for n in self._leaves(tuple(names)) if n != "scale"]
        given += [n for n in names if n in self.linkage.given and n not in given]
        listed = ", ".join(p.reference(given, p.scale) for p in polygons)
        stated = f"def polygons({', '.join([*given, *(p.scale for p in polygons)])}):\n    return ({listed},)"
        return "\n\n\n".join([*(p.function() for p in polygons), *(p.judge(given) for p in polygons), stated])

    def _motion(self) -> str:
        """Return the code of the points that move, with their velocities and accelerations where the driver
        has a speed."""
        formulas, linkage = self.formulas, self.linkage
        pieces = []
        for point in linkage.points:
            if point in linkage.ground:
                continue
            vectors = [formulas.at(point)]
            if linkage.speed:
                vectors += [formulas.velocity(point), formulas.acceleration(point)]
            name = point if len(point) == 1 else f"{point[0]}_{point[1:]}"
            pieces.append(f"{name!r}: Moving({', '.join(v.complex for v in vectors)})")
        code = "{" + ", ".join(pieces) + "}"
        return f"def motion({', '.join(names_in(code))}):\n    return {code}" if pieces else ""

    def _known(self) -> str:
        """Return the code of the results that the file knows."""
        cases = []
        constants = {n: e.value for n, e in self.linkage.given.items() if e.value is not None}
        for given, gives in self.linkage.known:
            for name, (text, unit) in gives.items():
                quantity = self.formulas.quantities.get(name)
                if quantity is None or (unit or "1") != quantity.unit:
                    would = (
                        f"{text} {quantity.unit}"
                        if quantity
                        else ", ".join(n for n in self.formulas.quantities if n[0] != "_")
                    )
                    raise self.linkage.refused(
                        ("known",),
                        "a known result is a quantity in its unit; found {name} = {text} {unit}; "
                        "available: {would}",
                        name=name,
                        text=text,
                        unit=unit,
                        would=would,
                    )
            stated = ", ".join(f"{n}={v!r}" for n, v in {**constants, **given}.items())
            results = ", ".join(f"{n}={text!r}" for n, (text, _) in gives.items())
            cases.append(f"    given({stated}).gives({results}),")
        return "KNOWN = (\n" + "\n".join(cases) + "\n)" if cases else ""

    def _residual(self) -> str:
        """Return the code of the residual: joints and their rates, from the frames of the bodies."""
        linkage, formulas = self.linkage, self.formulas
        names = dict.fromkeys([*formulas.geometry, linkage.moved, *self.formulas.followed_turns])
        slides = [linkage.moved, *(s.distance for s in linkage.slides.values())]
        names |= dict.fromkeys(
            [
                *slides,
                *(f"side_{g.inner}" for g in formulas.groups if isinstance(g, Dyad) and g.kind == "RRR"),
            ]
        )
        free = [formulas.reference[b] for b in linkage.bodies if not self._holder(b)]
        names |= dict.fromkeys(f"{axis}{point}" for point in free for axis in "xy")
        order = 0
        asked = {q.name for q in self.questions.questions}
        needed = {q.name for q in formulas.transitive(sorted(asked))}
        if linkage.speed and any(n.startswith(("omega", "v_")) or n.endswith("_dot") for n in needed | asked):
            order = 1
        if linkage.speed and any(
            n.startswith(("alpha", "a_")) or n.endswith("_ddot") for n in needed | asked
        ):
            order = 2
        stems = ("", "omega", "alpha")[1 : order + 1]
        for stem in stems:
            names |= dict.fromkeys(t.replace("theta", stem, 1) for t in self.formulas.followed_turns)
        names |= dict.fromkeys(n for n in linkage.drive.rates[:order] if n in linkage.given)
        names |= dict.fromkeys(
            f"{s.distance}{end}"
            for s in linkage.slides.values()
            for end in ("_dot", "_ddot")[:order]
            if s.distance != linkage.moved
        )
        names |= dict.fromkeys(
            f"{kind}_{point}_{axis}" for point in free for kind in "va"[:order] for axis in "xy"
        )
        listed = ", ".join(names)
        values = ", ".join(f"{n}={n}" for n in names)
        return (
            f"def residual({listed}):\n    return closure_gaps(MECHANISM, TRACKS, SIDES, "
            f"{linkage.moved!r}, {order}, dict({values}))"
        )

    def _mechanism(self) -> str:
        linkage, formulas = self.linkage, self.formulas
        ground = ", ".join(f"{p!r}: {_place(place)}" for p, place in linkage.ground.items())
        bodies = []
        jack = linkage.jack
        for name, start in self._starts.items():
            body = linkage.bodies[name]
            turn = formulas.turns[name]
            angle = repr(turn) if turn.startswith("theta") else turn
            origin = ""
            if not start:
                start = formulas.reference[name]
                origin = f", origin=lambda x{start}, y{start}: x{start} + 1j * y{start}"
            base = linkage.place(start, name)
            places = ", ".join(
                f"{p!r}: {_shifted(place, base)}" for p, place in body.points.items() if p != start
            )
            bodies.append(f"        Body({name!r}, {angle}, {start!r}, {{{places}}}{origin}),")
        slides = [
            f"        Slide({s.at!r}, {s.of!r}, {s.on!r}, {_code(s.along)})," for s in linkage.slides.values()
        ]
        pushed = ""
        if jack:
            start, end = linkage.bodies[jack].points
            turn = repr(formulas.turns[jack])
            bodies += [
                f"        Body({b!r}, {turn}, {p!r})," for b, p in ((jack, start), (linkage.drive.rod, end))
            ]
            # before any other at the same point, so that it is the one along which the drive pushes
            slides.insert(0, f"        Slide({end!r}, {linkage.drive.rod!r}, {jack!r}),")
        if self._followed:
            pushed = end if jack else formulas.reference[linkage.driver]
        gears = [
            f"        Gear({g.first!r}, {g.second!r}, {g.carrier!r}, ({_code(g.radii[0])}, "
            f"{_code(g.radii[1])}), {g.inner}"
            f"{self._centres(g.first, g.second, g.carrier)}),"
            for g in linkage.gears
        ]
        loads = []
        for load in linkage.loads:
            if load.moment is not None:
                loads.append(f"        Load({load.on!r}, moment={_code(load.moment)}),")
            elif load.force is not None:
                loads.append(
                    f"        Load({load.on!r}, force={_code(load.force)}, angle={_code(load.angle)}),"
                )
        pieces = [f"    ground={{{ground}}},", "    bodies=(", *bodies, "    ),"]
        for name, lines in (("slides", slides), ("gears", gears), ("loads", loads)):
            if lines:
                pieces += [f"    {name}=(", *lines, "    ),"]
        if pushed:
            pieces.append(f"    pushed={pushed!r},")
        return "Mechanism(\n" + "\n".join(pieces) + "\n)"

    @cached_property
    def _starts(self) -> dict[str, str]:
        """Points at which the frames of the bodies begin for the mechanism, each of one placed before; empty
        where slides alone hold it."""
        linkage = self.linkage
        held, starts = set(linkage.ground), {}
        for name in self.formulas.order:
            if name not in (GROUND, linkage.jack):
                body = linkage.bodies[name]
                starts[name] = body.at if body.at in held else next((p for p in body.points if p in held), "")
                held |= set(body.points)
        return starts

    def _through(self, slide: SlideEntry) -> str:
        """Return the place on a slide's line in the frame that the mechanism gives the guide."""
        if slide.on == GROUND or slide.on == self.linkage.jack:
            return _place(slide.through)
        start = self._starts[slide.on] or self.formulas.reference[slide.on]
        return _shifted(slide.through, self.linkage.place(start, slide.on))

    def _holder(self, body: str) -> str:
        """Return the point of a body that the ground or a body placed before it holds; none where slides
        alone hold it."""
        order = self.formulas.order
        # A jack holds nothing: its length varies.
        before = [b for b in order[: order.index(body)] if b != self.linkage.jack]
        points = self.linkage.bodies[body].points
        return next((p for p in points if set(self.linkage.holders(p)) & set(before)), "")

    def _tracks(self) -> list[str]:
        linkage = self.linkage
        tracks = [
            f"SlideTrack({s.at!r}, {s.of!r}, {s.on!r}, {self._through(s)}, {_code(s.along)}, "
            f"{s.distance!r}), "
            for s in linkage.slides.values()
        ]
        if linkage.jack:
            end = [*linkage.bodies[linkage.jack].points][1]
            tracks.append(
                f"SlideTrack({end!r}, {linkage.drive.rod!r}, {linkage.jack!r}, 0.0, 0.0, {linkage.moved!r}), "
            )
        return tracks

    def _sides(self) -> list[str]:
        """Return the triangles of the groups that have a side: inner joint, both outer ones, and the quantity
        of the side."""
        dyads = [g for g in self.formulas.groups if isinstance(g, Dyad) and g.kind == "RRR"]
        return [f"({d.inner!r}, {d.outer_p!r}, {d.outer_q!r}, 'side_{d.inner}'), " for d in dyads]

    def _centres(self, first: str, second: str, carrier: str) -> str:
        points = []
        for body in (first, second):
            shared = [p for p, b in self.linkage.pins.items() if body in b and carrier in b]
            points.append(shared[0] if shared else "")
        return f", {tuple(points)!r}" if any(points) else ""

    # ------------------------------------------------------------------ polygons

    def refuse_still_polygons(self) -> None:
        """Refuse a polygon that is asked and has nothing to draw, with the line of the question."""
        if polygons := self.questions.polygons:
            refuse_still_sides(polygons, *self._modules)

    def equal_in_all(self, pairs: Collection[tuple[str, str]]) -> Collection[tuple[str, str]]:
        """Return the pairs of quantities that are the same in all positions; none of a larger group, whose
        positions take long."""
        if any(isinstance(group, HigherGroup) for group in self.formulas.groups):
            return ()
        return equal_in_all(pairs, *self._modules)

    @cached_property
    def _modules(self) -> tuple[ModuleType, ModuleType]:
        name = self.linkage.path.stem
        return self._executed("exercises", name), self._executed("solutions", name)

    @cached_property
    def undrawn(self) -> Mapping[str, Message]:
        """By kind, why a polygon would be refused if it were asked; nothing for one that can be drawn."""
        reasons = {}
        for kind in POLYGONS if self.linkage.speed else ():
            alone = replace(self.linkage, ask={"polygon": [kind]}, required=(), loads=(), known=())
            try:
                CompiledLinkage(alone).refuse_still_polygons()
            except BadInput as fault:
                problem = as_message(fault).values["problem"]
                reasons[kind] = problem.values.get("why", problem)
        return reasons

    # --------------------------------------------------------------------- texts

    def text(self, kind: str, lang: str) -> str:
        """Return a text as its author would have written it.

        Parameters
        ----------
        kind
            ``exercises`` or ``solutions``.
        lang
            Language.

        Returns
        -------
        Markdown of named sections, a template of Jinja2.
        """
        of = exercise_text if kind == "exercises" else solution_text
        return of(self.formulas, self.questions, lang)

    def module(self, kind: str, name: str) -> ModuleType:
        """Return the module of the exercise or of its solution.

        Parameters
        ----------
        kind
            ``exercises`` or ``solutions``.
        name
            Name of the module in Python.

        Returns
        -------
        The module, which is also in ``sys.modules``.
        """
        module = sys.modules[name] = self._executed(kind, name)
        return module

    def _executed(self, kind: str, name: str) -> ModuleType:
        source = self.exercise if kind == "exercises" else self.solution
        file = f"{next(_numbers)}/{self.linkage.path}:{kind}"
        module = ModuleType(name)
        module.__file__ = file
        module._lines = _SourceLines(file, source)  # type: ignore[attr-defined]
        # Written from names and expressions that were read.
        exec(compile(source, file, "exec"), module.__dict__)
        return module


_numbers = itertools.count(1)  #: of modules: files of several courses may have one name


class _SourceLines:
    """Lines of a compiled module, which formulas are printed from, as long as one of its functions lives."""

    def __init__(self, file: str, source: str) -> None:
        linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
        weakref.finalize(self, linecache.cache.pop, file, None)


@lru_cache(maxsize=256)
def _compiled(path: Path, shown: str, changed: int) -> CompiledLinkage:
    made = CompiledLinkage(read_linkage(path, shown))
    made.exercise, made.solution  # noqa: B018  # what makes no sense in the file is found while they are written
    made.refuse_still_polygons()
    return made


def compiled(path: Path, shown: str = "") -> CompiledLinkage:
    """Return the compiled mechanism of a file; again where the file has changed.

    Parameters
    ----------
    path
        The file.
    shown
        Name of the file in messages; by default its path.

    Returns
    -------
    The mechanism.

    Raises
    ------
    BadCourse
        The file states what makes no sense, with the line.
    """
    with author_faults():
        result: CompiledLinkage = _compiled(path, shown or str(path), path.stat().st_mtime_ns)
        return result


@dataclass(frozen=True)
class CompiledText:
    """Text of a mechanism's exercise, read as a file is: the part of a path that readers of texts use."""

    file: Path
    shown: str
    kind: str
    lang: str

    @property
    def parent(self) -> Path:
        return self.file.parent

    @property
    def name(self) -> str:
        return f"{self.file.stem}.{self.lang}.md.j2"

    def relative_to(self, root: Path) -> Path:
        """Return the mechanism's file as seen from a folder."""
        return self.file.relative_to(root)

    def exists(self) -> bool:
        """Return whether there are sentences in the language."""
        return self.lang in spoken()

    def stat(self) -> os.stat_result:
        """Return what the system says of the mechanism's file, which changes the text when it changes."""
        return self.file.stat()

    def read_text(self, encoding: str = "utf-8") -> str:
        """Return the text."""
        del encoding
        return compiled(self.file, self.shown).text(self.kind, self.lang)


def _plain(quantity: Quantity) -> str:
    """Return a quantity as code without its stable way."""
    return f"def {quantity.name}({', '.join(quantity.needs)}):\n    return {quantity.code}"


def _all_finite(names: Sequence[str]) -> str:
    return " & ".join(f"np.isfinite({name})" for name in names)


def _condition(name: str, code: str, said: str = "") -> tuple[str, str]:
    """Return a constraint as code; ``said`` is what messages call it, as code, else the words of its name."""
    function = f"def {name}({', '.join(names_in(code))}):\n    return {code}"
    return name, f"{function}\n\n\n{name}.said = {said or repr(name.replace('_', ' '))}"


def _least(said: str, example: str) -> str:
    """Return what messages call a constraint of which a file may state the least itself, as code."""
    return f"Message({said!r}, example={f'{chr(34)}{example}{chr(34)}'!r})"


def _given(entry: GivenEntry) -> str:
    if entry.value is not None:
        return f"fixed({entry.value:.15g}, unit={entry.unit!r})"
    low, high = (
        b.code if b.is_number else f"lambda {', '.join(b.names)}: {b.code}" for b in (entry.low, entry.high)
    )
    more = ", nonzero=True" if entry.nonzero else ""
    more += f", positive={entry.positive}"
    return f"drawn({low}, {high}, step={entry.step}, unit={entry.unit!r}{more})"


def _code(expression: QuantityExpression) -> str:
    """Return an expression as a place of a mechanism: a name, a number or a function."""
    if expression.is_name:
        return repr(expression.code)
    return (
        expression.code
        if expression.is_number
        else f"lambda {', '.join(expression.names)}: {expression.code}"
    )


def _complex(place: Place) -> str:
    if place.radius is not None:
        return f"polar({place.radius.code}, {place.angle.code})"
    return f"{place.x.code} + 1j * ({place.y.code})" if not place.y.is_zero else place.x.code


def _place(place: Place) -> str:
    if place.radius is None and place.y.is_zero:
        return _code(place.x)
    code = _complex(place)
    return f"lambda {', '.join(place.names)}: {code}" if place.names else code


def _shifted(place: Place, base: Place) -> str:
    """Return a place seen from another of the same frame."""
    if base.is_origin:
        return _place(place)
    names = dict.fromkeys([*place.names, *base.names])
    code = f"({_complex(place)}) - ({_complex(base)})"
    return f"lambda {', '.join(names)}: {code}" if names else code
