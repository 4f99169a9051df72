"""Marking: a student's texts against the reference, part by part.

Answers are data: they are read, never run. What is not right is looked up, in this order, among what
follows rightly from the student's own earlier answers, the named mistakes of the solution, and the slips that
need no naming; nothing of that is computed for an answer that is right.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

from coursework.comparing import distance
from coursework.errors import WrongValue, unknown
from coursework.judging import Verdict, best_judged
from coursework.key import Key
from coursework.language import localise, significant, unit_text, with_unit, words
from coursework.loop_marking import Judged, judged
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
    from coursework.course import CourseExercise, Variant

ECHO = 60  #: characters of an answer quoted back in feedback


@dataclass(eq=False)
class Mark:
    """What became of one answer. Not to be changed."""

    part: str
    answer: str  #: the text as it came
    read_as: str  #: what was read in it; empty when nothing was
    verdict: str  #: correct, follow_through, mistake:NAME, slip:KIND, wrong, wrong_unit, missing_unit, unreadable or missing
    points: float
    out_of: float
    lang: str
    matches: tuple[str, ...] = ()  #: every verdict that explains this answer, the one given first
    in_other_order: bool = False  #: right because the student exchanged two assemblies
    _tell: Callable[[], _Said] = field(default=lambda: _Said("", {}), repr=False)

    @cached_property
    def says(self) -> str:
        """What to tell the student, Markdown in the sheet's language; never the reference value."""
        return f"{self._tell().markdown()} {self._note}".rstrip()

    @cached_property
    def feedback(self) -> str:
        """What is said, as one line of plain text."""
        return f"{self._tell().plain(self.lang)} {self._note}".rstrip()

    @property
    def _note(self) -> str:
        return words(self.lang)["marking"]["either_order"] if self.in_other_order else ""

    @property
    def mistakes(self) -> tuple[str, ...]:
        """The named mistakes that give this answer."""
        return tuple(m.partition(":")[2] for m in self.matches if m.startswith("mistake:"))


class _Said(NamedTuple):
    """A sentence of the engine, and the Markdown that fills it: ``{name}: {read} is right.``"""

    sentence: str
    pieces: Mapping[str, str]

    def markdown(self) -> str:
        return self.sentence.format(**self.pieces)

    def plain(self, lang: str) -> str:
        """One line of plain text. Sentences and most pieces recur: each is made plain once."""
        pieces = {n: text if _is_plain(text) else _plain(text, lang) for n, text in self.pieces.items()}
        return " ".join(_plain_sentence(self.sentence, lang).format(**pieces).split())


_BARE = re.compile(r"[\w\s.,;:()=/°%·²³−…+^?!-]*")
_is_plain = _BARE.fullmatch


@lru_cache(maxsize=1024)
def _plain_sentence(sentence: str, lang: str) -> str:
    """A sentence with its places still open. Braces are no markup, and come through."""
    return _plain(sentence, lang)


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


def read(variant: Variant, part: Part, answer: Any) -> Reading:
    """Read an answer as the part's kind asks; a vector has as many coordinates as its reference."""
    match part.kind:
        case "number" | "angle":
            return read_number(answer, part.unit)
        case "integer":
            return read_integer(answer)
        case "choice":
            return read_choice(answer, variant.labels(part))
        case "equation":
            return read_equation(answer, part.variables)
        case _:
            return read_point(answer, part.unit, len(variant.key.reference[part.quantity]))


def mark(variant: Variant, answers: Mapping[str, Any], known: Mapping[str, str] | None = None) -> Marking:
    """Mark the answers to a variant; a part left out is missing.

    Parts that are ``known`` to be right, with their numbers as read, are not marked again, and are not in
    the marking.

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
    key, known = variant.key, known or {}
    readings = {i: read(variant, p, answers.get(i)) for i, p in asked.items() if i not in known}
    target = _targets(variant, readings, key)
    together: dict[str, Verdict] = {}
    loops = judged(variant, readings)
    before = _Before({}, set(), set(), [])
    marks = {}
    for i, part in asked.items():
        if i in known:
            before.own[part.quantity] = float(known[i])
            continue
        judged_by, reading = asked[target[i]], readings[i]
        if part.judge and i not in together:
            together |= best_judged(variant, part.judge, readings, before.own, before.wrong)
        if i in together:
            nearest = together[i].reading, math.inf
            told = next((asked[j] for j in marks if _is_told_with(asked[j], part, together)), None)
            marks[i] = _mark_judged(variant, key, part, reading, together[i], told)
        else:
            own = loops.get(i)
            if own is None:
                nearest = _nearest(part, reading, key, judged_by)
            else:
                nearest = 0, 0.0 if own.right else math.inf
            marks[i] = _mark_part(variant, key, part, reading, judged_by, nearest, before, own)
        before.shown.update(marks[i].matches)
        if reading.status == "read" and part.kind in ("number", "angle", "integer", "choice"):
            before.read.append((judged_by, reading))
        if reading.status == "read" and part.kind in ("number", "angle"):
            before.own[judged_by.quantity] = reading.values[nearest[0]]
            if marks[i].verdict != "correct":
                before.wrong.add(judged_by.quantity)
    for i in marks:
        if target[i] != i and marks[i].verdict == "correct":
            marks[i] = replace(marks[i], in_other_order=True)
    return Marking(marks)


def _targets(variant: Variant, readings: Mapping[str, Reading], key: Key) -> dict[str, str]:
    """For each part id, the part whose reference it is judged by.

    Itself, save where the exercise lets whole groups be exchanged and the exchange fits better.
    """
    own = {p.id: p.id for p in variant.parts}
    parts = {p.id: p for p in variant.parts}
    groups = [g for g in variant.exercise.spec.either_order if all(i in readings for i in g)]
    if not groups:
        return own

    def fitting(target: Mapping[str, str]) -> int:
        members = itertools.chain(*groups)
        return sum(_nearest(parts[i], readings[i], key, parts[target[i]])[1] <= 1 for i in members)

    answered = sum(readings[i].status == "read" for i in itertools.chain(*groups))
    # An exchange is meant where most of what is answered fits it: one answer may fit by chance.
    best, best_score = own, max(fitting(own), answered / 2)
    for order in itertools.permutations(groups):
        target = {
            **own,
            **{i: j for g, h in zip(groups, order, strict=True) for i, j in zip(g, h, strict=True)},
        }
        score = fitting(target)
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
    if 1 < gaps[index] < math.inf and part.has_margin:
        # Outside the part's own tolerance: rounding on the way may have brought it there.
        width = key.envelope.get(judged_by.quantity, 0.0)
        gaps = [distance(part, v, reference, along, width) for v in reading.values]
    return index, gaps[index]


def right_feedback(variant: Variant, part: Part, read_as: str) -> str:
    """What is said of a right answer, as one line of plain text."""
    sentence = _plain_right(variant.exercise, part, variant.lang)
    return sentence.replace(_READ, echo(read_as, variant.lang))


_READ = "\N{OBJECT REPLACEMENT CHARACTER}"


@lru_cache(maxsize=4096)
def _plain_right(exercise: CourseExercise, part: Part, lang: str) -> str:
    name = f"${exercise.symbol(part.quantity)}$"
    pieces = {"name": name[:1].upper() + name[1:], "read": _READ}
    return _Said(words(lang)["marking"]["correct"], pieces).plain(lang)


class _Before(NamedTuple):
    """What a student has answered before a part: numbers by quantity, and which of them are wrong."""

    own: dict[str, float]
    wrong: set[str]
    shown: set[str]  #: verdicts that explain earlier answers
    read: list[tuple[Part, Reading]]  #: numbers, whole ones too, and choices


def _made(
    variant: Variant, part: Part, reading: Reading, verdict: str, share: float, read_as: str,
    tell: Callable[[], _Said], matches: tuple[str, ...] = (),
) -> Mark:  # fmt: skip
    points = float(part.points)
    return Mark(
        part.id, reading.text, read_as, verdict, share * points, points, variant.lang, matches, False, tell
    )


def _is_told_with(earlier: Part, part: Part, together: Mapping[str, Verdict]) -> bool:
    """Whether what is to be said of a judged part has been said of an earlier one of its group."""
    same_group = earlier.judge == part.judge and earlier.id in together
    return same_group and together[earlier.id][1:] == together[part.id][1:]


def _mark_judged(
    variant: Variant, key: Key, part: Part, reading: Reading, found: Verdict, told_with: Part | None
) -> Mark:
    """The mark of a part that is judged together with others; ``told_with`` bears the same remark already."""
    read_as, verdict = reading.read_as[found.reading], found.said
    if verdict is None:
        alone = partial(_say, variant, part, "incomplete", read=echo(read_as, variant.lang))
        return _made(variant, part, reading, "wrong", 0.0, read_as, alone)
    share = min(1.0, max(0.0, float(verdict.share)))

    def say(sentence: str, **pieces: str) -> _Said:
        said = _say(variant, part, sentence, read=echo(read_as, variant.lang), **pieces)
        return said._replace(sentence=said.sentence + follows, pieces={**said.pieces, **told})

    tells = {} if told_with else verdict.found
    told = {f"found{n}": _quantity(variant, q, v) for n, (q, v) in enumerate(tells.items())}
    listed = ", ".join("{" + name + "}" for name in told)
    follows = f" {words(variant.lang)['marking']['found'].format(listed)}" if listed else ""
    if share == 1.0:
        kind, share = ("follow_through", key.rules.follow_through) if found.followed else ("correct", 1.0)
        return _made(variant, part, reading, kind, share, read_as, lambda: say(kind))
    name = verdict.mistake
    if not name:
        name = next((n for n, v in key.wrong_ways(part.quantity) if _fits(part, reading, v, None, 0.0)), "")
    if name:
        share = share if verdict.mistake and share else key.solution.mistakes[name].share
        kind = f"mistake:{name}"

        def tell() -> _Said:
            if told_with and verdict.mistake:
                return say("told_with", first=part_name(variant, told_with))
            return say("mistake", says=variant.told(name))

        return _made(variant, part, reading, kind, share, read_as, tell, (kind,))
    return _made(variant, part, reading, "wrong", share, read_as, lambda: say("wrong"))


def _quantity(variant: Variant, name: str, value: float) -> str:
    """A quantity and its value as Markdown: ``$r_3$ = 120,4 mm``."""
    exercise = variant.exercise
    symbol = exercise.solution.symbols.get(name) or exercise.symbol(name)
    return f"${symbol}$ = {with_unit(significant(value), exercise.units.get(name, '1'), variant.lang)}"


def _mark_part(
    variant: Variant,
    key: Key,
    part: Part,
    reading: Reading,
    judged_by: Part,
    nearest: tuple[int, float],
    before: _Before,
    closes: Judged | None,
) -> Mark:
    made = partial(_made, variant, part, reading)
    if reading.status != "read":
        return made(reading.status, 0.0, "", lambda: _say_not_read(variant, part, reading))
    index, gap = nearest
    read_as = reading.read_as[index]
    if part.kind == "choice":
        read_as = _plain(variant.label(part.id, str(reading.values[index])), variant.lang)

    def say(sentence: str, **pieces: str) -> _Said:
        return _say(variant, part, sentence, read=echo(read_as, variant.lang), **pieces)

    if gap <= 1:
        if part.asks_unit and not reading.unit_given:
            return made("missing_unit", 0.0, read_as, lambda: say("missing_unit"))
        return made("correct", 1.0, read_as, lambda: say("correct"))
    matches = tuple(_explanations(key, part, reading, judged_by, before))
    likely = {m for m in matches if _is_likely(m, key, judged_by, before)}
    matches = tuple(sorted(matches, key=lambda m: m not in likely))
    if closes is not None and closes.fault:
        likely.add(f"slip:{closes.fault}")
        matches += (f"slip:{closes.fault}",)
    verdict = matches[0] if likely else "wrong"
    kind, _, name = verdict.partition(":")
    if kind == "mistake":
        share = key.solution.mistakes[name].share

        def told() -> _Said:
            return say("mistake", says=variant.told(name))

        return made(verdict, share, read_as, told, matches)
    if kind == "slip":
        about = _symbols(variant, closes)
        return made(verdict, key.rules.slip, read_as, lambda: say(f"slip_{name}", about=about), matches)
    if kind == "follow_through":
        return made(verdict, key.rules.follow_through, read_as, lambda: say("follow_through"), matches)
    sentence = _NOT_RIGHT.get(part.kind, "wrong")
    return made("wrong", 0.0, read_as, lambda: say(sentence), matches)


_NOT_RIGHT = {
    "choice": "wrong_case",
    "equation": "wrong_equation",
    "direction": "wrong_place",
    "point_on_line": "wrong_place",
}


def _is_likely(match: str, key: Key, part: Part, before: _Before) -> bool:
    """Whether a verdict may be told of an answer that it explains.

    Among few cases many mistakes lead to the same one: a choice tells nothing of a mistake made elsewhere that
    an earlier answer, which it would have changed, does not show.
    """
    name = match.partition(":")[2]
    if part.kind != "choice" or part.quantity in key.solution.mistakes[name].targets:
        return True
    return match in before.shown or not any(
        name == other and not _fits(earlier, reading, value, None, 0.0)
        for earlier, reading in before.read
        for other, value in key.wrong_ways(earlier.quantity)
    )


def _symbols(variant: Variant, closes: Judged | None) -> str:
    """The links that a fault is about, as they are printed."""
    if closes is None:
        return ""
    table = words(variant.lang)["marking"]
    joint = table["and" if closes.fault == "frame_missing" else "or"]
    symbols, exercise = variant.exercise.solution.symbols, variant.exercise
    return f" {joint} ".join(f"${symbols.get(name) or exercise.symbol(name)}$" for name in closes.names)


def _explanations(key: Key, part: Part, reading: Reading, judged_by: Part, before: _Before) -> Iterator[str]:
    """Every verdict that explains a wrong answer, the one to give first."""
    quantity = judged_by.quantity
    width = key.envelope.get(quantity, 0.0)
    reference = key.reference[quantity]
    if part.kind in ("number", "angle") and before.wrong:
        expected = key.followed(judged_by, before.own, before.wrong)
        # Where the earlier answers hardly change this one, they explain nothing.
        if (
            expected is not None
            and distance(part, expected, reference, None, width) > 2
            and _fits(part, reading, expected, None, width)
        ):
            yield "follow_through"
    for name, value in key.wrong_ways(quantity):
        along = key.reference.get(judged_by.along)
        if judged_by.along:
            along = key.wrong[name].get(judged_by.along, along)
        if _fits(part, reading, value, along, width):
            yield f"mistake:{name}"
    seen = set()
    for kind, value in key.slips(judged_by):
        # A slip scales what rounding may have moved.
        own = width * abs(value / reference) if reference and part.kind == "number" else width
        if kind not in seen and _fits(part, reading, value, None, own):
            seen.add(kind)
            yield f"slip:{kind}"


def _fits(part: Part, reading: Reading, value: Any, along: Any, width: float) -> bool:
    return any(distance(part, v, value, along, width) <= 1 for v in reading.values)


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


_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def localised(read_as: str, lang: str) -> str:
    """What was read, as the language writes numbers; an equation is left as it is."""
    if "=" in read_as:
        return read_as
    if _NUMBER.fullmatch(read_as):
        return localise(read_as, lang)
    number = re.sub(r"(?<![A-Za-z.])-?\d+(?:\.\d+)?", lambda m: localise(m.group(), lang), read_as)
    return number.replace(" °", "°")


def _say(variant: Variant, part: Part, sentence: str, **pieces: str) -> _Said:
    name = part_name(variant, part)
    return _Said(words(variant.lang)["marking"][sentence], {"name": name[:1].upper() + name[1:], **pieces})


def _say_not_read(variant: Variant, part: Part, reading: Reading) -> _Said:
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
    return _Said(sentence, {"name": name, "found": _harmless(found), "unit": unit or "1"})


def _harmless(text: str) -> str:
    """A quotation that no Markdown reader takes for markup."""
    return "".join(c for c in text if c.isprintable() and c not in "$`*_\\<>[]#|")


@lru_cache(maxsize=8192)
def _plain(markdown: str, lang: str) -> str:
    """Markdown as one line of plain text."""
    from coursework.rendering.markup import to_text

    return " ".join(to_text(markdown, lang).split())
