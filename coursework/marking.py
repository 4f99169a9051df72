"""Marking: a student's texts against the reference, part by part.

Answers are data: they are read, never run. A part that is not right is looked up among the named
mistakes of the solution; nothing more than that is computed, and only then.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.errors import CourseworkError, WrongValue, unknown
from coursework.expressions import Equation, parse_equation, same_equation
from coursework.graph import plain_scalar
from coursework.language import localise, unit_text, words
from coursework.model import Part
from coursework.reading import (
    Reading,
    read_choice,
    read_equation,
    read_integer,
    read_number,
    read_point,
)

if TYPE_CHECKING:
    from coursework.course import Variant

SLACK = 1e-12  #: relative, so that an answer on the tolerance's edge is inside it
ECHO = 60  #: characters of an answer quoted back in feedback


@dataclass(frozen=True)
class Mark:
    """What became of one answer."""

    part: str
    answer: str  #: the text as it came
    read_as: str  #: what was read in it; empty when nothing was
    verdict: str  #: correct, mistake:NAME, wrong, wrong_unit, unreadable or missing
    points: float
    out_of: float
    says: str  #: Markdown in the sheet's language; never the reference value
    lang: str
    matches: tuple[str, ...] = ()  #: every named mistake that gives this answer

    @cached_property
    def feedback(self) -> str:
        """What is said, as one line of plain text."""
        return _plain(self.says, self.lang)


class Marking(Mapping[str, Mark]):
    """The marks of one student on one variant, by part id."""

    def __init__(self, marks: Mapping[str, Mark]):
        self._marks = dict(marks)

    def __getitem__(self, part: str) -> Mark:
        if part not in self._marks:
            raise unknown("part", part, self._marks)
        return self._marks[part]

    def __iter__(self) -> Iterator[str]:
        return iter(self._marks)

    def __len__(self) -> int:
        return len(self._marks)

    @property
    def points(self) -> float:
        return sum(m.points for m in self._marks.values())

    @property
    def out_of(self) -> float:
        return sum(m.out_of for m in self._marks.values())

    def show(self) -> None:
        """Print the feedback, a line a part, for a notebook or a terminal."""
        for mark in self._marks.values():
            print(f"[{mark.points:g}/{mark.out_of:g}] {mark.feedback}")
        print(f"{self.points:g}/{self.out_of:g}")


class Key:
    """The reference values of one variant, and the values each named mistake would give."""

    def __init__(self, variant: Variant):
        self.variant = variant
        self.solution = variant.exercise.solution
        self.reference: dict[str, Any] = variant.solution()

    @cached_property
    def wrong(self) -> dict[str, dict[str, Any]]:
        """By mistake, the asked quantities it reaches and their wrong values."""
        return {name: self._wrong(name) for name in self.solution.mistakes}

    def _wrong(self, name: str) -> dict[str, Any]:
        reached = tuple(q for q in self.reference if q in self.solution.reached(name))
        try:
            return self._mistaken(name, reached)
        except CourseworkError:
            pass  # the wrong way leads nowhere for some quantity of this variant; the others are tried alone
        values = {}
        for quantity in reached:
            with suppress(CourseworkError):
                values |= self._mistaken(name, (quantity,))
        return values

    def _mistaken(self, name: str, quantities: tuple[str, ...]) -> dict[str, Any]:
        graph = self.solution.mistaken(name)
        found = graph.evaluate(quantities, self.variant.used, self.variant.effects)
        return {quantity: plain_scalar(value) for quantity, value in found.items()}


def read(part: Part, answer: Any, labels: Mapping[str, list[str]], reference: Any) -> Reading:
    """Read an answer as the part's kind asks; a vector has as many coordinates as its reference."""
    match part.kind:
        case "number" | "angle":
            return read_number(answer, part.unit)
        case "integer":
            return read_integer(answer)
        case "choice":
            return read_choice(answer, labels)
        case "equation":
            return read_equation(answer, part.variables)
        case _:
            return read_point(answer, part.unit, len(reference))


def distance(part: Part, value: Any, reference: Any, along: Any = None) -> float:
    """How far a value is from a reference, as a multiple of the accepted half-width: right up to 1.

    0 or infinity for the kinds judged by identity. Angles are compared modulo 360.
    """
    match part.kind:
        case "number":
            return _over(abs(value - reference), part.half_width(reference), reference)
        case "angle":
            gap = abs(math.remainder(value - reference, 360.0))
            return _over(gap, part.half_width(reference), 360.0)
        case "point_on_line":
            return _off_line(part, value, reference, along)
        case "direction":
            return _off_direction(part, value, reference)
        case "equation":
            right = _equation(reference, part.variables)
            return 0.0 if same_equation(value, right, parameters=part.parameters) else math.inf
        case _:
            return 0.0 if value == plain_scalar(reference) else math.inf


@lru_cache(maxsize=256)
def _equation(text: str, variables: tuple[str, ...]) -> Equation:
    """A reference equation, or a mistaken one, read once."""
    return parse_equation(text, variables)


def _over(gap: float, half_width: float, scale: float) -> float:
    """``gap`` in half-widths, the boundary inclusive up to rounding."""
    if not math.isfinite(gap):
        return math.inf
    if gap <= half_width + SLACK * max(half_width, abs(scale)):
        return min(1.0, gap / half_width) if half_width else 0.0
    return gap / half_width if half_width else math.inf


def _off_line(part: Part, point: Any, reference: Any, along: Any) -> float:
    offset = np.asarray(point, dtype=float) - reference
    if float(np.max(np.abs(offset))) > 1e100:
        return math.inf
    axis = np.asarray(along, dtype=float)
    gap = float(np.linalg.norm(np.cross(offset, axis)) / np.linalg.norm(axis))
    size = float(np.linalg.norm(reference))
    return _over(gap, part.half_width(size), size)


def _off_direction(part: Part, vector: Any, reference: Any) -> float:
    v, d = np.asarray(vector, dtype=float), np.asarray(reference, dtype=float)
    largest = float(np.max(np.abs(v)))
    v = v / largest if largest else v
    size = float(np.linalg.norm(v) * np.linalg.norm(d))
    if size == 0.0:
        return math.inf
    return _over(float(np.linalg.norm(np.cross(v, d))) / size, part.half_width(1.0), 1.0)


def mark(variant: Variant, answers: Mapping[str, Any]) -> Marking:
    """Mark the answers to a variant; a part left out is missing.

    Raises
    ------
    UnknownName
        An answer to a part that the variant does not ask.
    NoSolution
        The course folder has no solutions.
    """
    asked = {p.id: p for p in variant.parts}
    if not isinstance(answers, Mapping):
        raise WrongValue(
            f"answers are given by part: {{'{next(iter(asked))}': '12 mm'}}; found {type(answers).__name__}"
        )
    for part_id in answers:
        if part_id not in asked:
            raise unknown("part", part_id, asked, f"{variant.exercise.name} {variant.seed}")
    key = variant.key
    readings = {
        i: read(p, answers.get(i), variant.labels(p), key.reference[p.quantity]) for i, p in asked.items()
    }
    target = _targets(variant, readings, key)
    marks = {i: _mark_part(variant, key, p, answers.get(i), readings[i], target[i]) for i, p in asked.items()}
    if any(target[i] != i for i in target):
        note = words(variant.lang)["marking"]["either_order"]
        for i in target:
            if target[i] != i and marks[i].verdict == "correct":
                marks[i] = replace(marks[i], says=f"{marks[i].says} {note}")
    return Marking(marks)


def _targets(variant: Variant, readings: Mapping[str, Reading], key: Key) -> dict[str, str]:
    """For each part id, the part whose reference it is judged by.

    Itself, save where the exercise lets whole groups be exchanged and the exchange fits better.
    """
    own = {p.id: p.id for p in variant.parts}
    parts = {p.id: p for p in variant.parts}
    groups = [g for g in variant.exercise.spec.either_order if all(i in parts for i in g)]

    def fitting(target: Mapping[str, str]) -> int:
        members = itertools.chain(*groups)
        return sum(_nearest(parts[i], readings[i], key, parts[target[i]])[1] <= 1 for i in members)

    best, best_score = own, fitting(own) if groups else 0
    for order in itertools.permutations(groups):
        target = {
            **own,
            **{i: j for g, h in zip(groups, order, strict=True) for i, j in zip(g, h, strict=True)},
        }
        score = fitting(target) if groups else 0
        if score > best_score:
            best, best_score = target, score
    return best


def _nearest(part: Part, reading: Reading, key: Key, judged_by: Part) -> tuple[int, float]:
    """Which honest reading is nearest to the reference, and its distance in half-widths."""
    if reading.status != "read":
        return 0, math.inf
    reference = key.reference[judged_by.quantity]
    along = key.reference.get(judged_by.along)
    gaps = [distance(part, v, reference, along) for v in reading.values]
    index = min(range(len(gaps)), key=gaps.__getitem__)
    return index, gaps[index]


def _mark_part(variant: Variant, key: Key, part: Part, answer: Any, reading: Reading, target: str) -> Mark:
    judged_by = variant.exercise.spec.part(target)
    assert judged_by is not None
    text = reading.text
    if reading.status != "read":
        says = _say_not_read(variant, part, reading)
        return _made(variant, part, text, "", reading.status, 0.0, says)
    index, gap = _nearest(part, reading, key, judged_by)
    read_as = reading.read_as[index]
    if part.kind == "choice":
        read_as = _plain(variant.text.label(part.id, str(reading.values[index])), variant.lang)
    if gap <= 1:
        says = _say(variant, part, "correct", read=echo(read_as, variant.lang))
        return _made(variant, part, text, read_as, "correct", part.points, says)
    matches = _mistakes(key, part, reading, judged_by)
    if matches:
        name = matches[0]
        told = variant.solution_text.section(f"mistake {name}").text
        says = _say(variant, part, "mistake", read=echo(read_as, variant.lang), says=told)
        points = part.points * key.solution.mistakes[name].share
        return _made(variant, part, text, read_as, f"mistake:{name}", points, says, matches)
    sentence = {"choice": "wrong_case", "equation": "wrong_equation"}.get(part.kind, "wrong")
    says = _say(variant, part, sentence, read=echo(read_as, variant.lang))
    return _made(variant, part, text, read_as, "wrong", 0.0, says)


def _mistakes(key: Key, part: Part, reading: Reading, judged_by: Part) -> tuple[str, ...]:
    """Every named mistake that gives this answer, in the solution's order."""
    found = []
    for name, values in key.wrong.items():
        if judged_by.quantity not in values:
            continue
        wrong = values[judged_by.quantity]
        along = values.get(judged_by.along, key.reference.get(judged_by.along))
        if any(distance(part, v, wrong, along) <= 1 for v in reading.values):
            found.append(name)
    return tuple(found)


def part_name(variant: Variant, part: Part) -> str:
    """What a part is called in feedback: its symbol, or its number when a symbol says nothing."""
    if part.kind in ("choice", "equation", "direction", "point_on_line"):
        number = 1 + [p.id for p in variant.parts].index(part.id)
        return f"{words(variant.lang)['sheet']['question']['one']} {number}"
    return f"${variant.exercise.symbol(part.quantity)}$"


def echo(text: str, lang: str) -> str:
    """What was read, shortened, as the language writes numbers; safe inside Markdown."""
    shown = text if len(text) <= ECHO else text[: ECHO - 1] + "…"
    if "=" in shown:
        return "`" + "".join(c for c in shown if c.isprintable() and c not in "`$") + "`"
    return _harmless(localised(shown, lang))


def localised(read_as: str, lang: str) -> str:
    """What was read, as the language writes numbers; an equation is left as it is."""
    if "=" in read_as:
        return read_as
    number = re.sub(r"(?<![A-Za-z.])-?\d+(?:\.\d+)?", lambda m: localise(m.group(), lang), read_as)
    return number.replace(" °", "°")


def _say(variant: Variant, part: Part, sentence: str, **pieces: str) -> str:
    text = words(variant.lang)["marking"][sentence]
    name = part_name(variant, part)
    return text.format(name=name[:1].upper() + name[1:], **pieces)


def _say_not_read(variant: Variant, part: Part, reading: Reading) -> str:
    name = part_name(variant, part)
    name = name[:1].upper() + name[1:]
    table = words(variant.lang)["marking"]
    unit = unit_text(part.unit, variant.lang)
    found = (reading.found or reading.text)[:ECHO]
    if reading.status == "unreadable":
        kinds = table["unreadable"]
        in_equation = part.kind == "equation"
        code = "not_a_number" if reading.code == "unknown_symbol" and not in_equation else reading.code
        sentence = kinds.get(code, kinds["otherwise"])
    elif reading.status == "wrong_unit":
        sentence = table["wrong_unit" if unit else "wrong_unit_ratio"]
    else:
        sentence = table["missing"]
    return sentence.format(name=name, found=_harmless(found), unit=unit or "1")


def _harmless(text: str) -> str:
    """A quotation that no Markdown reader takes for markup."""
    return "".join(c for c in text if c.isprintable() and c not in "$`*_\\<>[]#|")


def _plain(markdown: str, lang: str) -> str:
    """Markdown as one line of plain text."""
    from coursework.rendering.markup import to_text

    return " ".join(to_text(markdown, lang).split())


def _made(
    variant: Variant,
    part: Part,
    text: str,
    read_as: str,
    verdict: str,
    points: float,
    says: str,
    matches: tuple[str, ...] = (),
) -> Mark:
    return Mark(
        part.id, text, read_as, verdict, float(points), float(part.points), says, variant.lang, matches
    )
