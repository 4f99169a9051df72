"""Texts of a mechanism's exercise: sentences of a language, filled with its points, bodies and quantities."""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from coursework.errors import BadCourse
from coursework.linkages.entries import GROUND, Place, SlideEntry
from coursework.linkages.expressions import QuantityExpression
from coursework.linkages.formulas import FormulaWriter
from coursework.linkages.groups import Dyad, HigherGroup, Wheel
from coursework.linkages.points import local_plane, middle_value
from coursework.linkages.questions import LinkageQuestion, QuestionWriter
from coursework.quantities.formula_latex import PrintedName, tree_latex

_FOLDER = Path(__file__).parents[1] / "language" / "linkages"
_PLACEHOLDER = re.compile(r"<(\w+)>")
_BODIES = ("body", "p", "q", "other", "of", "on", "driver", "carrier")  #: words that name bodies
_POINTS = ("B", "P", "Q")


@cache
def sentences(lang: str) -> Mapping[str, Mapping[str, str]]:
    """Return the sentences of a language by table.

    Raises
    ------
    BadCourse
        There are none in this language.
    """
    file = _FOLDER / f"{lang}.toml"
    if not file.exists():
        raise BadCourse(f"mechanisms have no sentences in {lang!r}: {file.name} would hold them")
    return tomllib.loads(file.read_text("utf-8"))


def spoken() -> tuple[str, ...]:
    """Return the languages that have sentences."""
    return tuple(sorted(f.stem for f in _FOLDER.glob("*.toml")))


class SentenceWriter:
    """Writer of sentences about a mechanism in a language."""

    def __init__(self, formulas: FormulaWriter, lang: str) -> None:
        self.formulas, self.linkage, self.lang = formulas, formulas.linkage, lang
        self.tables = sentences(lang)

    def sentence(self, table: str, key: str, words: Mapping[str, str] | None = None) -> str:
        """Return a sentence with its words in place."""
        texts = self.tables[table]
        known = self._words(words or {})

        def word(match: re.Match[str]) -> str:
            return known.get(match[1], match[0])

        return _PLACEHOLDER.sub(word, texts[key])

    def has(self, table: str, key: str) -> bool:
        """Return whether a table has a sentence of this key."""
        return key in self.tables[table]

    def _words(self, words: Mapping[str, str]) -> dict[str, str]:
        result = {}
        for name, value in words.items():
            if name in _BODIES and value in (GROUND, *self.linkage.bodies):
                result[name] = self.body(value)
                result[f"of_{name}"] = self._of(result[name])
            elif name in _POINTS and value:
                result[name] = point_latex(value)
            elif name in ("s", "t") and value:
                result[name] = self.formulas.symbol(value)
            else:
                result[name] = value
        return result

    def _of(self, body: str) -> str:
        text = self.tables["body"]["of"].replace("<body>", body)
        return text.replace("de le ", "du ") if self.lang == "fr" else text

    def body(self, name: str) -> str:
        """Return what a body is called: by its points."""
        if name == GROUND:
            return self.tables["body"]["frame"]
        points = [*self.linkage.bodies[name].points]
        drives = name == self.linkage.driver
        if name == self.linkage.jack:
            return self.tables["body"]["jack"].replace("<points>", "".join(map(point_latex, points)))
        if any(name in (g.first, g.second) for g in self.linkage.gears) and len(points) == 1:
            kind = "wheel"
        elif len(points) == 1:
            kind = "guide" if self.is_guide(name) else "block"
        elif len(points) == 2:
            kind = "crank" if drives and self.linkage.drive.kind == "turn" else "bar"
        else:
            kind = "plate"
        return self.tables["body"][kind].replace("<points>", "".join(map(point_latex, points)))

    def is_ahead(self, place: Place) -> bool:
        """Return whether a place lies on the first axis, on the side to which it points."""
        if place.radius is not None or not place.y.is_zero or place.is_origin:
            return False
        return middle_value(local_plane(place), self.linkage).real > 0

    def is_guide(self, name: str) -> bool:
        """Return whether another body slides on a body."""
        return any(s.on == name for s in self.linkage.slides.values())

    def latex(self, expression: QuantityExpression) -> str:
        """Return an expression in LaTeX; a number alone as it is printed."""
        shown = {
            n: PrintedName(self.formulas.symbol(n), False, "angle" if self._is_angle(n) else "")
            for n in expression.names
        }
        return tree_latex(ast.parse(expression.code, mode="eval").body, shown, {})

    def _is_angle(self, name: str) -> bool:
        entry = self.linkage.given.get(name)
        return entry is not None and entry.unit == "deg"

    def degrees(self, expression: QuantityExpression) -> str:
        """Return a direction in LaTeX."""
        return rf"{self.latex(expression)}^{{\circ}}" if expression.is_number else self.latex(expression)

    def listed(self, texts: Sequence[str]) -> str:
        """Return texts as a list with an *and*."""
        if len(texts) < 2:
            return "".join(texts)
        return ", ".join(texts[:-1]) + self.tables["statement"]["and"] + texts[-1]


def point_latex(point: str) -> str:
    """Return the name of a point in LaTeX: ``O2`` is ``O_2``."""
    return point if len(point) == 1 else f"{point[0]}_{{{point[1:]}}}"


def _frame_point(writer: SentenceWriter, point: str, place: Place) -> str:
    """Return a point with its place in a frame."""
    if place.radius is not None:
        words = {"B": point, "r": writer.latex(place.radius), "angle": writer.degrees(place.angle)}
        return writer.sentence("statement", "frame_point_polar", words)
    return writer.sentence(
        "statement", "frame_point", {"B": point, "x": writer.latex(place.x), "y": writer.latex(place.y)}
    )


# -------------------------------------------------------------------------- statement


def exercise_text(formulas: FormulaWriter, questions: QuestionWriter, lang: str) -> str:
    """Return the text of the exercise as its author would have written it.

    Parameters
    ----------
    formulas, questions
        What the file states, compiled.
    lang
        Language.

    Returns
    -------
    Markdown of named sections, a template of Jinja2.
    """
    writer = SentenceWriter(formulas, lang)
    linkage = formulas.linkage
    pieces = [f"# {_title(linkage.title, lang, linkage.name)}", _statement(writer, questions.questions)]
    for point, entry in formulas.modes.items():
        if entry.is_drawn:
            key = "mode" if entry.end else "mode_slide"
            words = {"B": point, "P": entry.start, "Q": entry.end}
            pieces.append(f"## mode_{point}\n{writer.sentence('statement', key, words)}")
    for question in questions.questions:
        own = {"own": formulas.symbol(question.name)}
        pieces.append(
            f"## {question.name}\n{writer.sentence('question', question.key, {**question.words, **own})}"
        )
    for name, points in questions.loops.items():
        pieces.append(f"## {name}\n{writer.sentence('statement', 'loop', {'points': points})}")
    joints = [p for p in linkage.points if p in linkage.pins]
    key = "figure" if linkage.drive.kind == "turn" else "figure_length"
    pieces.append(
        "## figure\n"
        f"{writer.sentence('statement', key, {'points': ', '.join(joints), 'name': linkage.moved})}"
    )
    return "\n\n".join(pieces) + "\n"


def _title(titles: Mapping[str, str], lang: str, name: str) -> str:
    return titles.get(lang) or titles.get("") or name


def _statement(writer: SentenceWriter, questions: Sequence[LinkageQuestion]) -> str:
    formulas, linkage = writer.formulas, writer.linkage
    sentence = writer.sentence
    fixed = [_frame_point(writer, p, place) for p, place in linkage.ground.items()]
    frame = "frame" if len(fixed) > 1 else "frame_of_one"
    bodies = [sentence("statement", frame, {"points": writer.listed(fixed)})]
    bodies += [_body(writer, name) for name in formulas.order if name != GROUND]
    joints = [_slide(writer, slide) for slide in linkage.slides.values()]
    for gear in linkage.gears:
        inner = sentence("statement", "gear_inner") if gear.inner else ""
        words = {"i": _number(gear.first), "j": _number(gear.second), "inner": inner}
        words |= {"r": writer.latex(gear.radii[0]), "R": writer.latex(gear.radii[1])}
        joints.append(sentence("statement", "gear", words))
    assembled = []
    for point, entry in formulas.modes.items():
        if not entry.is_drawn:
            slide = linkage.slides.get(point)
            guide = slide is not None and any(
                isinstance(g, Dyad) and g.kind == "RPR" and g.inner == slide for g in formulas.groups
            )
            key = f"{entry.ways[0]}_guide" if guide else entry.ways[0]
            if point in linkage.assembly or not guide:
                assembled.append(sentence("statement", key, {"B": point, "P": entry.start, "Q": entry.end}))
    if any(isinstance(g, HigherGroup) for g in formulas.groups):
        assembled.append(sentence("statement", "near"))
    directions = _directions(writer)
    motion = []
    if directions:
        motion.append(sentence("statement", "directions", {"list": writer.listed(directions)}))
    if linkage.speed:
        words = {
            "omega": formulas.symbol(linkage.speed),
            "alpha": formulas.symbol(linkage.acceleration) if linkage.acceleration else "",
        }
        key = "varying" if linkage.acceleration else "constant"
        if linkage.drive.kind != "turn":
            key = f"{linkage.drive.kind}_{key}"
            words |= {"s": linkage.moved, "B": linkage.slides_driven}
        motion.append(sentence("statement", key, words))
    for load in linkage.loads:
        if load.moment is not None:
            motion.append(
                sentence(
                    "statement", "moment", {"value": _with_unit(writer, load.moment, "N*m"), "name": load.on}
                )
            )
        elif load.force is not None:
            words = {
                "value": _with_unit(writer, load.force, "N"),
                "B": load.on,
                "angle": writer.degrees(load.angle),
            }
            motion.append(sentence("statement", "force", words))
    if linkage.loads:
        motion.append(sentence("statement", "forces"))
    drawing = [sentence("statement", "drawing")] if any(q.key == "drawn_pole" for q in questions) else []
    if drawing:
        guides = [
            (g.inner.at, g.q)
            for g in formulas.groups
            if isinstance(g, Dyad) and isinstance(g.inner, SlideEntry)
        ]
        drawing += [
            sentence("statement", "drawing_guide", {"B": p, "image": p.lower(), "guide": g})
            for p, g in guides
        ]
    return "\n\n".join(" ".join(part) for part in (bodies, joints, assembled, motion, drawing) if part)


def _with_unit(writer: SentenceWriter, expression: QuantityExpression, unit: str) -> str:
    if not expression.is_number:
        return writer.latex(expression)
    latex = {"N*m": r"\mathrm{N\,m}", "N": r"\mathrm{N}"}[unit]
    return rf"{writer.latex(expression)}\ {latex}"


def _number(body: str) -> str:
    return "1" if body == GROUND else body


def _body(writer: SentenceWriter, name: str) -> str:
    formulas, linkage = writer.formulas, writer.linkage
    points = linkage.bodies[name].points
    start = next((p for p, place in points.items() if place.is_origin), linkage.bodies[name].at)
    others = [p for p in points if p != start]
    if not others:
        kind = "guide" if writer.is_guide(name) else "block"
        return writer.sentence("statement", kind, {"B": start, "name": name})
    words = {"P": start, "name": name, "angle": formulas.symbol(formulas.turns[name])}
    drive = linkage.drive
    if name == linkage.jack:
        limits = [formulas.symbol(n) for n in drive.limits if n]
        travel = (
            writer.sentence("statement", "travel", dict(zip("mM", limits, strict=True))) if limits else ""
        )
        words |= {"B": others[0], "rod": drive.rod, "s": linkage.moved, "travel": travel}
        return writer.sentence("statement", "jack", words)
    turned = name == linkage.driver and drive.kind == "turn"
    far = points[others[0]]
    if len(others) == 1 and writer.is_ahead(far):
        words |= {"B": others[0], "length": writer.latex(far.x)}
        ends = start + others[0]  # what the length is called where the file states a number
        words["long"] = "" if far.x.code == ends else writer.sentence("statement", "long", words)
        return writer.sentence("statement", "crank" if turned else "bar", words)
    places = [_frame_point(writer, p, points[p]) for p in others]
    words |= {"points": "".join(map(point_latex, [start, *others])), "places": writer.listed(places)}
    return writer.sentence("statement", "plate_driven" if turned else "plate", words)


def _slide(writer: SentenceWriter, slide: SlideEntry) -> str:
    if slide.through_name:
        through = f"${point_latex(slide.through_name)}$"
    else:
        words = {"x": writer.latex(slide.through.x), "y": writer.latex(slide.through.y)}
        through = writer.sentence("statement", "through_place", words)
    words = {
        "B": slide.at,
        "name": slide.of,
        "through": through,
        "s": slide.distance,
        "along": writer.degrees(slide.along),
    }
    if slide.on == GROUND:
        return writer.sentence("statement", "slide_ground", words)
    turned = (
        ""
        if slide.along.is_zero
        else writer.sentence("statement", "slide_turned", {"along": writer.degrees(slide.along)})
    )
    return writer.sentence("statement", "slide_body", {**words, "guide": slide.on, "turned": turned})


def _directions(writer: SentenceWriter) -> list[str]:
    formulas, linkage = writer.formulas, writer.linkage
    results = {}
    for name in formulas.order:
        turn = formulas.turns[name] if name != GROUND else ""
        if not turn.startswith("theta") or turn in results:
            continue
        points = linkage.bodies[name].points
        start = next((p for p, place in points.items() if place.is_origin), None)
        ahead = [p for p, place in points.items() if writer.is_ahead(place)]
        words = {"symbol": formulas.symbol(turn), "name": name}
        if start and ahead:
            results[turn] = writer.sentence("statement", "direction", {**words, "P": start, "B": ahead[0]})
        else:
            results[turn] = writer.sentence("statement", "direction_axis", words)
    return list(results.values())


# --------------------------------------------------------------------------- solution


def solution_text(formulas: FormulaWriter, questions: QuestionWriter, lang: str) -> str:
    """Return the text of the solution as its author would have written it.

    Parameters
    ----------
    formulas, questions
        What the file states, compiled.
    lang
        Language.

    Returns
    -------
    Markdown of named sections.
    """
    writer = SentenceWriter(formulas, lang)
    groups = [_group(writer, group) for group in formulas.groups]
    title = _title(formulas.linkage.title, lang, formulas.linkage.name)
    pieces = [
        f"# {writer.sentence('solution', 'title', {'title': title})}",
        writer.sentence("solution", "opening", {"groups": writer.listed(groups), "first": _first(writer)})
        if groups
        else "",
    ]
    for quantity in formulas.quantities.values():
        if quantity.step:
            pieces.append(f"## {quantity.name}\n{_step(writer, quantity.step, quantity.words)}")
    for question in questions.questions:
        if question.key.startswith("equation_"):
            pieces.append(f"## {question.name}\n{writer.sentence('step', 'equation', question.words)}")
    for mistake in questions.mistakes:
        if all(t in formulas.quantities for t in mistake.targets):
            pieces.append(
                f"## mistake {mistake.name}\n{writer.sentence('mistake', mistake.key, mistake.words)}"
            )
    return "\n\n".join(p for p in pieces if p) + "\n"


def _first(writer: SentenceWriter) -> str:
    """Return what stands before the groups: the driver, or for a jack that groups hold nothing but its
    length."""
    return writer.sentence("solution", f"first_{writer.linkage.drive.kind}")


def _step(writer: SentenceWriter, step: str, words: Mapping[str, str]) -> str:
    """Return the sentence of a step: its own, else the one without what a moving guide adds; a second
    component is likewise."""
    for key in (step, step.removesuffix("_moved"), step.removesuffix("_jack")):
        if writer.has("step", key):
            return writer.sentence("step", key, words)
    if step.endswith("_y") and writer.has("step", f"{step[:-2]}_x"):
        return writer.sentence("step", "likewise", words)
    raise KeyError(step)


def _group(writer: SentenceWriter, group: Any) -> str:
    if isinstance(group, Dyad):
        return (
            writer.sentence("solution", "dyad", {"kind": group.kind})
            .replace("<p>", group.p)
            .replace("<q>", group.q)
        )
    if isinstance(group, Wheel):
        return writer.tables["solution"]["wheel"].replace("<body>", group.body)
    return writer.sentence("solution", "large", {"bodies": ", ".join(group.bodies)})
