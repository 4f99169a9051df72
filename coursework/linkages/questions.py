"""Questions of a mechanism's file: parts of the exercise, the quantities behind them, their usual
mistakes."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from coursework.errors import nearest
from coursework.linkages.entries import GROUND
from coursework.linkages.formulas import FormulaWriter
from coursework.linkages.groups import Group
from coursework.linkages.points import UsualMistake, over
from coursework.linkages.terms import Heading, Plane, Sum
from coursework.linkages.vectors import POLYGONS, PolygonWriter
from coursework.messages import Message

_CENTRE = re.compile(r"I(\d+|[a-z][a-z0-9]*?)_?(\d+|[a-z][a-z0-9]*)\Z")


@dataclass(frozen=True)
class LinkageQuestion:
    """Part of the exercise: its fields as code, and the sentence that asks it with its words."""

    name: str
    fields: Mapping[str, str]
    key: str
    words: Mapping[str, str] = field(default_factory=dict)

    @property
    def source(self) -> str:
        """The part as Python code."""
        listed = "".join(f", {name}={value}" for name, value in self.fields.items())
        return f'Part("{self.name}"{listed})'


class QuestionWriter:
    """Writer of the questions of a mechanism, in the order of its file.

    Parameters
    ----------
    formulas
        The quantities of the mechanism, to which those of the questions are added.
    """

    def __init__(self, formulas: FormulaWriter) -> None:
        self.formulas, self.linkage = formulas, formulas.linkage
        self.questions: list[LinkageQuestion] = []
        self.mistakes: list[UsualMistake] = list(formulas.mistakes)
        self.polygons: list[PolygonWriter] = []
        self.loops: dict[str, str] = {}  #: points that each loop passes, in LaTeX
        writers: dict[str, Callable[[Any], None]] = {
            "mobility": self._mobility,
            "class": self._class,
            "positions": self._positions,
            "equations": self._equations,
            "velocities": self._velocities,
            "accelerations": self._accelerations,
            "polygon": self._polygon,
            "instant_centres": self._centres,
            "advantage": self._advantage,
            "torque": self._torque,
            "thrust": self._thrust,
        }
        for key, value in self.linkage.ask.items():
            if key != "points" and value is not False:
                writers[key](value)
        self._weigh()

    def _weigh(self) -> None:
        known = {q.name for q in self.questions}
        for name, points in self.linkage.ask.get("points", {}).items():
            if name not in known:
                raise self.linkage.refused(
                    ("ask", "points"), "no question {name!r}{found}", name=name, found=nearest(name, known)
                )
            for number, question in enumerate(self.questions):
                if question.name == name:
                    fields = {**question.fields, "points": f"{points:g}"}
                    self.questions[number] = LinkageQuestion(name, fields, question.key, question.words)

    def _ask(self, name: str, key: str, words: Mapping[str, str] | None = None, **fields: str) -> None:
        if any(q.name == name for q in self.questions):
            raise self.linkage.refused(("ask",), "{name} is asked twice", name=name)
        self.questions.append(LinkageQuestion(name, fields, key, words or {}))

    # ----------------------------------------------------------------- structure

    def _mobility(self, _: Any) -> None:
        linkage = self.linkage
        bodies, pairs, higher = linkage.counts
        rest = f" - {higher}" if higher else ""
        words = {"n": str(bodies), "b": str(pairs), "h": str(higher)}
        self.formulas.write(
            "mobility",
            f"3 * {bodies} - 2 * {pairs}{rest}",
            "1",
            "mobility_gears" if higher else "mobility",
            "w",
            words=words,
        )
        self._ask("mobility", "mobility", kind='"integer"')
        self.mistakes.append(
            UsualMistake(
                "frame_counted",
                ("mobility",),
                (f"3 * {bodies + 1} - 2 * {pairs}{rest}",),
                "frame_counted",
                {},
            )
        )
        multiple = sum(len(b) - 2 for b in linkage.pins.values())
        if multiple:
            code = f"3 * {bodies} - 2 * {pairs - multiple}{rest}"
            point = next(p for p, b in linkage.pins.items() if len(b) > 2)
            self.mistakes.append(
                UsualMistake(
                    "multiple_pin_counted_once",
                    ("mobility",),
                    (code,),
                    "multiple_pin_counted_once",
                    {"B": point},
                )
            )

    def _class(self, _: Any) -> None:
        if self.linkage.gears:
            raise self.linkage.refused(
                ("ask", "class"), "Assour groups have pins and slides alone; this mechanism has gears"
            )
        names = ("I", "II", "III", "IV", "V", "VI")
        rank = names[self.formulas.rank - 1]
        self.formulas.write(
            "mechanism_class",
            repr(rank),
            "1",
            "mechanism_class",
            words={"groups": str(len(self.formulas.groups))},
        )
        self._ask("mechanism_class", "mechanism_class", kind='"choice"', choices=repr(names[:4]))

    # ------------------------------------------------------------------- motion

    def _positions(self, names: list[str]) -> None:
        for name in names:
            at = ("ask", "positions")
            if name in self._moving_points:
                self._vector(name, self.formulas.at(name), "mm", "point", name, "point")
            elif name in self.formulas.followed_turns:
                self._ask(name, "angle", self._turn_words(name), unit='"deg"', kind='"angle"')
            elif name in self._slides or re.fullmatch(r"[xy][A-Z]\d*", name):
                self._known(name, at)
                key = "distance" if name in self._slides else "coordinate"
                self._ask(
                    name,
                    key,
                    self._slide_words(name) if name in self._slides else {"B": name[1:], "axis": name[0]},
                    unit='"mm"',
                )
            else:
                self._unknown(name, at, [*self.formulas.followed_turns, *self._moving_points, *self._slides])

    def _velocities(self, names: list[str]) -> None:
        self._needs_speed("velocities")
        self._rates(
            names, "velocities", "omega", "rad/s", "V_", "mm/s", "_dot", self.formulas.velocity, "velocity"
        )

    def _accelerations(self, names: list[str]) -> None:
        self._needs_speed("accelerations")
        self._rates(
            names,
            "accelerations",
            "alpha",
            "rad/s^2",
            "a_",
            "mm/s^2",
            "_ddot",
            self.formulas.acceleration,
            "acceleration",
        )

    def _rates(
        self,
        names: list[str],
        key: str,
        stem: str,
        unit: str,
        prefix: str,
        per: str,
        ending: str,
        of: Callable[[str], Plane],
        what: str,
    ) -> None:
        turns = {turn.replace("theta", stem, 1): turn for turn in self.formulas.followed_turns}
        points = {f"{prefix}{p}": p for p in self._moving_points}
        slides = {s + ending: s for s in self._slides}
        for name in names:
            if name in turns:
                self._ask(name, f"angular_{what}", self._turn_words(turns[name]), unit=f'"{unit}"')
            elif name in points:
                point = points[name]
                mark = "V" if what == "velocity" else "a"
                self._vector(
                    name, of(point), per, "vector", rf"\vec{{{mark}}}_{{{point}}}", what, {"B": point}
                )
            elif name in slides:
                self._ask(name, f"slide_{what}", self._slide_words(slides[name]), unit=f'"{per}"')
            else:
                self._unknown(name, ("ask", key), [*turns, *points, *slides])

    def _vector(
        self,
        name: str,
        vector: Plane,
        unit: str,
        kind: str,
        symbol: str,
        key: str,
        words: Mapping[str, str] | None = None,
    ) -> None:
        words = words or {"B": name}
        self.formulas.write(
            name,
            f"np.stack(np.broadcast_arrays({vector.x.code}, {vector.y.code}), -1)",
            unit,
            f"vector_{key}",
            symbol,
            words=words,
        )
        self._ask(name, key, words, unit=f'"{unit}"', kind=f'"{kind}"', points="2")

    def _needs_speed(self, key: str) -> None:
        linkage = self.linkage
        if not linkage.speed:
            speed = linkage.drive.rates[0]
            example = f'{speed} = "12 rad/s"' if linkage.drive.kind == "turn" else f'{speed} = "12 mm/s"'
            raise linkage.refused(
                ("ask", key),
                "{key} need the speed of the driver: [given], then {example}",
                key=key,
                example=example,
            )
        if linkage.given[linkage.speed].value == 0 and not (key == "accelerations" and linkage.acceleration):
            raise linkage.refused(
                ("ask", key),
                "{key} need a driver that moves; found {speed} = 0",
                key=key,
                speed=linkage.speed,
            )

    @property
    def _moving_points(self) -> tuple[str, ...]:
        return tuple(p for p in self.linkage.points if p not in self.linkage.ground)

    @property
    def _slides(self) -> tuple[str, ...]:
        return tuple(s.distance for s in self.linkage.followed_slides)

    def _turn_words(self, turn: str) -> dict[str, str]:
        turned = [b for b, t in self.formulas.turns.items() if t == turn]
        body = next((b for b in turned if turn in (f"theta{b}", f"theta_{b}")), turned[0])
        return {"body": body, "symbol": self.formulas.symbol(turn)}

    def _slide_words(self, distance: str) -> dict[str, str]:
        slide = next(s for s in self.linkage.slides.values() if s.distance == distance)
        return {"B": slide.at, "s": distance}

    def _known(self, name: str, at: tuple[str, str]) -> None:
        if name[0] in "xy" and name[1:] in self._moving_points:
            self.formulas.at(name[1:])
        if name not in self.formulas.quantities:
            self._unknown(name, at, self.formulas.quantities)

    def _unknown(self, name: str, at: tuple[str, str], able: Any) -> None:
        listed = [n for n in able if not n.startswith("_")]
        point = name.removeprefix("V_").removeprefix("a_")
        if name in self.linkage.given or point in self.linkage.ground:
            why = (
                Message("{name} is given", name=name)
                if name in self.linkage.given
                else Message("{point} is a fixed point", point=point)
            )
            raise self.linkage.refused(
                at, "{why}; what follows can be asked: {able}", why=why, able=", ".join(listed)
            )
        raise self.linkage.refused(at, "no quantity {name!r}{near}", name=name, near=nearest(name, listed))

    # ----------------------------------------------------------------- equations

    def _equations(self, value: Any) -> None:
        forms = ("x", "y", "complex", "x_dot", "y_dot", "complex_dot")
        wanted = ["x", "y"] if value is True else value
        if not isinstance(wanted, list) or not wanted or any(form not in forms for form in wanted):
            raise self.linkage.refused(
                ("ask", "equations"),
                "equations = true, or a list of {forms}; found {value!r}",
                forms=", ".join(forms),
                value=value,
            )
        if any(form.endswith("_dot") for form in wanted):
            self._needs_speed("equations")
        closures = {g: c for g in self.formulas.groups if (c := self.formulas.closure(g)) is not None}
        if not closures:
            raise self.linkage.refused(
                ("ask", "equations"),
                "no loop of this mechanism can be written: its slides go through points without a name",
            )
        names = dict.fromkeys(
            n for loop in closures.values() for v in loop for n in (v[0], v[1], v[3]) if n.isidentifier()
        )
        turns = [n for n in names if n.startswith("theta")]
        lengths = [n for n in names if n not in turns]
        moving = [n for n in lengths if n in (*self._slides, self.linkage.moved)]
        rates = [*(t.replace("theta", "omega", 1) for t in turns), *(f"{s}_dot" for s in moving)]
        for number, (group, loop) in enumerate(closures.items(), start=1):
            name = f"loop_{number}"
            self.formulas.loops[name] = loop
            self.loops[name] = self._around(group)
            for form in wanted:
                variables = [*names, *(rates if form.endswith("_dot") else ())]
                words = {"points": self._around(group), "symbols": ", ".join(map(self._typed, variables))}
                fields = {
                    "kind": '"equation"',
                    "variables": repr(tuple(variables)),
                    "parameters": repr(tuple(n for n in lengths if n not in moving)),
                    "loop": f'"{name}"',
                    "points": "2" if form.startswith("complex") else "1",
                }
                self._ask(f"{name}_{form}", f"equation_{form}", words, **fields)

    def _typed(self, name: str) -> str:
        """Return how a quantity is typed, with its symbol where no reader would know it by its name."""
        symbol = f" (${self.formulas.symbol(name)}$)" if name.startswith(("d_", "delta_", "phi_")) else ""
        return f"`{name}`{symbol}"

    def _around(self, group: Group) -> str:
        return ", ".join(
            f"${p[0]}_{{{p[1:]}}}$" if len(p) > 1 else f"${p}$" for p in self.formulas.around(group)
        )

    # --------------------------------------------------------- centres and forces

    def _centres(self, names: list[str]) -> None:
        self._needs_speed("instant_centres")
        at = ("ask", "instant_centres")
        bodies = {"1": GROUND, **{b: b for b in self.linkage.bodies}}
        for name in names:
            match = _CENTRE.match(name)
            pair = next(
                (
                    (bodies[name[1:k].rstrip("_")], bodies[name[k:].lstrip("_")])
                    for k in range(2, len(name))
                    if name[1:k].rstrip("_") in bodies and name[k:].lstrip("_") in bodies
                ),
                None,
            )
            if match is None or pair is None or pair[0] == pair[1]:
                raise self.linkage.refused(
                    at, "an instant centre is I13: two bodies, 1 the ground; found {name!r}", name=name
                )
            self._centre(name, *pair)

    def _centre(self, name: str, first: str, second: str) -> None:
        formulas = self.formulas
        shared = [p for p, b in self.linkage.pins.items() if first in b and second in b]
        words = {"I": name, "i": "1" if first == GROUND else first, "j": "1" if second == GROUND else second}
        if shared:
            place = formulas.at(shared[0])
            step = "centre_pin"
            words["B"] = shared[0]
        else:
            rates = [formulas.omega(body) for body in (first, second)]
            if rates[0] == rates[1]:
                raise self.linkage.refused(
                    ("ask", "instant_centres"),
                    "{name} is at infinity in every position: bodies {value} and {value_2} are turned alike",
                    name=name,
                    value=words["i"],
                    value_2=words["j"],
                )
            moving = [b for b in (first, second) if b != GROUND]
            if len(moving) == 1:
                start, rate = formulas.reference[moving[0]], formulas.omega(moving[0])
                there, v = formulas.at(start), formulas.velocity(start)
                codes = (
                    (there.x - Sum.of(over(v.y, Sum.of(rate)))).code,
                    (there.y + Sum.of(over(v.x, Sum.of(rate)))).code,
                )
            else:
                # z (w_i - w_j) = w_i P_i - w_j P_j + (V_j - V_i) / i, as a vector
                fields = []
                for body, rate in zip(moving, rates, strict=True):
                    here = formulas.at(formulas.reference[body]).times(rate)
                    v = formulas.velocity(formulas.reference[body])
                    fields.append(Plane(here.x - v.y, here.y + v.x))
                above, below = fields[0] - fields[1], Sum.of(rates[0]) - Sum.of(rates[1])
                codes = over(above.x, below), over(above.y, below)
            for axis, code in zip("xy", codes, strict=True):
                formulas.write(
                    f"{axis}_{name}",
                    code,
                    "mm",
                    f"centre_{axis}",
                    f"{axis}_{{{_centre_index(words)}}}",
                    words=words,
                )
            place = Plane(Sum.of(f"x_{name}"), Sum.of(f"y_{name}"))
            step = "centre"
        formulas.write(
            name,
            f"np.stack(np.broadcast_arrays({place.x.code}, {place.y.code}), -1)",
            "mm",
            step,
            _centre_index(words),
            words=words,
        )
        self._ask(name, "instant_centre", words, unit='"mm"', kind='"point"', points="2")

    def _advantage(self, value: Any) -> None:
        self._needs_speed("advantage")
        formulas, linkage = self.formulas, self.linkage
        turning = [b for b in linkage.bodies if formulas.turns[b].startswith("theta") and b != linkage.driver]
        on_ground = [b for b in turning if any(p in linkage.ground for p in linkage.bodies[b].points)]
        slid = [s.distance for s in linkage.followed_slides if s.on == GROUND]
        able = [*turning, *slid]
        output = (on_ground or slid or turning or [""])[-1] if value is True else str(value)
        if output not in able:
            raise linkage.refused(
                ("ask", "advantage"),
                "the advantage is that of a body that turns, or of a slide on the ground: {found}; "
                "found {value!r}",
                found=", ".join(able),
                value=value,
            )
        drives, slides = linkage.drive.kind == "turn", output in slid
        words = self._slide_words(output) if slides else {"body": output}
        ends = linkage.speed, f"{output}_dot" if slides else formulas.omega(output)
        # A force over a torque is in 1/m, with the sliding speed in mm/s.
        scaled, unit = ("1000 * ", "1/m") if drives and slides else ("", "1" if drives != slides else "mm")
        key = f"advantage{'_slide' * slides}{'' if drives else '_of_length'}"
        step = "advantage" if drives and not slides else "advantage_efforts"
        formulas.write("advantage", f"{scaled}{ends[0]} / {ends[1]}", unit, step, "m_a", words=words)
        self._ask("advantage", key, words, unit=f'"{unit}"')
        name, wrong = "advantage_upside_down", f"{ends[1]} / {_factor(scaled + ends[0])}"
        sentence = step.replace("advantage", name, 1)
        self.mistakes.append(UsualMistake(name, ("advantage",), (wrong,), sentence, words, "inverse"))

    def _drives(self, key: str, *kinds: str) -> None:
        """Refuse a question about another sort of driver."""
        if self.linkage.drive.kind not in kinds:
            of_angle = Message(
                "{key} is asked where a given angle turns a body; of a driven length ask thrust", key=key
            )
            of_length = Message(
                "{key} is asked of a driven length; where a given angle turns a body ask torque", key=key
            )
            raise self.linkage.refused(("ask", key), of_angle if kinds == ("turn",) else of_length)

    def _torque(self, _: Any) -> None:
        self._drives("torque", "turn")
        code = f"-({' + '.join(self._powers('torque'))}) / {self.linkage.speed}"
        words = {"driver": self.linkage.driver}
        self.formulas.write("torque", code, "N*m", "torque", r"\Gamma", words=words)
        self._ask("torque", "torque", words, unit='"N*m"', points="2")

    def _thrust(self, _: Any) -> None:
        self._drives("thrust", "slide", "jack")
        code = f"-({' + '.join(self._powers('thrust'))}) / ({self.linkage.speed} / 1000)"
        self.formulas.write("thrust", code, "N", "thrust", "P")
        self._ask("thrust", f"thrust_{self.linkage.drive.kind}", unit='"N"', points="2")

    def _powers(self, key: str) -> list[str]:
        """Return the powers of the loads, W, as code."""
        self._needs_speed(key)
        formulas, linkage = self.formulas, self.linkage
        terms = []
        for load in linkage.loads:
            if load.moment is not None:
                rate = formulas.omega(load.on)
                terms.append(f"{_factor(load.moment.code)} * {rate}")
            else:
                assert load.force is not None
                v = formulas.velocity(load.on)
                along = v.along(Heading.of(load.angle.code)).times(load.force.code)
                terms.append(f"({along.code}) / 1000")
        return terms

    # ------------------------------------------------------------------ polygons

    def _polygon(self, names: list[str]) -> None:
        for name in names:
            if name not in POLYGONS:
                raise self.linkage.refused(
                    ("ask", "polygon"),
                    "a polygon is of 'velocity' or 'acceleration'; found {name!r}",
                    name=name,
                )
        self._needs_speed("polygon")
        self.polygons = [PolygonWriter(self.formulas, name) for name in dict.fromkeys(names)]
        targets: dict[str, list[str]] = {"too_small": [], "upside_down": [], "other_scale": []}
        wrong: dict[str, list[str]] = {"too_small": [], "upside_down": [], "other_scale": []}
        for polygon in self.polygons:
            for quantity in polygon.quantities():
                self.formulas.add(quantity)
            judge = f'"drawing_{polygon.kind}"'
            words = {"k": f"k_{polygon.letter}", "pole": polygon.pole, "kind": polygon.kind}
            self._ask(
                polygon.scale,
                f"drawn_scale_{polygon.kind}",
                words,
                unit=f'"{self.formulas.quantities[polygon.scale].unit}"',
                judge=judge,
            )
            for part, image in polygon.parts.items():
                key = "drawn_pole" if image == polygon.pole else "drawn_image"
                points = "1" if image == polygon.pole else "2"
                self._ask(
                    part,
                    key,
                    {**words, "image": image},
                    unit='"mm"',
                    kind='"point"',
                    judge=judge,
                    points=points,
                )
            self.mistakes += polygon.mistakes()
            k, parts = polygon.scale, [*polygon.parts]
            for fault, scale, there in (
                ("too_small", f"10 * {k}", [f"{p} / 10" for p in parts]),
                ("upside_down", f"1 / {k}", parts),
                ("other_scale", f"2 * {k}", parts),
            ):
                # One known vector alone agrees with any scale: then it is its length that is wrong.
                if fault != "other_scale" or sum(side.is_known for side in polygon.sides) > 1:
                    targets[fault] += [k, *parts]
                    wrong[fault] += [scale, *there]
        for key, name, kind in (
            ("too_small", "too_small", "mistake"),
            ("upside_down", "scale_upside_down", "inverse"),
            ("other_scale", "scale_not_drawn", "mistake"),
        ):
            if targets[key]:
                self.mistakes.append(
                    UsualMistake(name, tuple(targets[key]), tuple(wrong[key]), f"drawn_{key}", {}, kind)
                )


def _centre_index(words: Mapping[str, str]) -> str:
    return (
        f"I_{{{words['i']}{words['j']}}}"
        if len(words["i"] + words["j"]) == 2
        else f"I_{{{words['i']},{words['j']}}}"
    )


def _factor(code: str) -> str:
    return code if re.fullmatch(r"[\w.]+", code) else f"({code})"
