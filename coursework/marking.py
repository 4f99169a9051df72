"""Marking: a student's texts against the reference, part by part.

Answers are data: they are read, never run. What is not right is looked up, in this order, among what
follows rightly from the student's own earlier answers, the named mistakes of the solution, and the slips that
need no naming; nothing of that is computed for an answer that is right.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

from coursework.comparing import distance
from coursework.equations import Equation, parse_equation
from coursework.equivalence import same_equation
from coursework.errors import CourseworkError, WrongValue, unknown
from coursework.judging import Verdict, best_judged, judged
from coursework.key import FOLLOWED, Key
from coursework.language import words
from coursework.loop_marking import loop_verdicts
from coursework.model import Part
from coursework.reading import (
    Reading,
    read_choice,
    read_equation,
    read_integer,
    read_number,
    read_point,
)
from coursework.telling import (
    Said,
    amount,
    echo,
    either_symbol,
    part_name,
    plain_line,
    questions,
    quoted,
    say,
    say_not_read,
)

if TYPE_CHECKING:
    from coursework.variant import Variant


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
    _tell: Callable[[], Said] = field(default=lambda: Said("", {}), repr=False)

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
            return read_number(answer, part.unit, thousands=part.kind == "number")
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
    together = loop_verdicts(variant, readings)
    before = _Before({}, set(), set(), set(), [])
    marks, no_scale = {}, set()
    waiting: dict[str, dict[str, frozenset[str]]] = {}
    for i, part in asked.items():
        if i in known:
            before.own[part.quantity] = known[i] if part.kind == "choice" else float(known[i])
            before.right.add(part.quantity)
            continue
        judged_by, reading = asked[target[i]], readings[i]
        if part.judge and i not in together:
            together |= best_judged(variant, part.judge, readings, before.own, before.wrong)
        if i in together:
            nearest = together[i].reading, math.inf
            tellers = (p for j, p in asked.items() if j in marks and j not in no_scale)
            told = next((p for p in tellers if _is_told_with(p, part, together)), None)
            missed = partial(_missed, variant, part, readings, waiting)
            marks[i] = _mark_judged(variant, key, part, reading, together[i], told, missed)
            if _is_scale(part) and reading.values[nearest[0]] <= 0:
                no_scale.add(i)
                read_as = echo(marks[i].read_as, variant.lang)
                marks[i] = replace(marks[i], _tell=partial(say, variant, part, "scale", read=read_as))
        else:
            nearest = _nearest(part, reading, key, judged_by)
            marks[i] = _mark_part(variant, key, part, reading, judged_by, nearest, before)
        before.shown.update(marks[i].matches)
        if marks[i].verdict == "correct":
            before.right.add(judged_by.quantity)
        if reading.status == "read" and part.kind in FOLLOWED:
            before.read.append((judged_by, reading))
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


class _Before(NamedTuple):
    """What a student has answered before a part: numbers and cases by quantity, and which of them are wrong."""

    own: dict[str, Any]
    wrong: set[str]
    right: set[str]  #: quantities, of any kind of answer
    shown: set[str]  #: verdicts that explain earlier answers
    read: list[tuple[Part, Reading]]  #: numbers, whole ones too, and choices


def _made(
    variant: Variant, part: Part, reading: Reading, verdict: str, share: float, read_as: str,
    tell: Callable[[], Said], matches: tuple[str, ...] = (),
) -> Mark:  # fmt: skip
    points = float(part.points)
    return Mark(
        part.id, reading.text, read_as, verdict, share * points, points, variant.lang, matches, False, tell
    )


def _is_told_with(earlier: Part, part: Part, together: Mapping[str, Verdict]) -> bool:
    """Whether what is to be said of a judged part has been said of an earlier one of its group."""
    same_group = part.judge and earlier.judge == part.judge and earlier.id in together
    return bool(same_group) and together[earlier.id][1:] == together[part.id][1:]


def _mark_judged(
    variant: Variant,
    key: Key,
    part: Part,
    reading: Reading,
    found: Verdict,
    told_with: Part | None,
    missed: Callable[[], str],
) -> Mark:
    """The mark of a part that is judged together with others; ``told_with`` bears the same remark already."""
    read_as, verdict = reading.read_as[found.reading], found.said
    made = partial(_made, variant, part, reading)
    if verdict is None:

        def alone() -> Said:
            return say(variant, part, "incomplete", read=echo(read_as, variant.lang), missing=missed())

        return made("wrong", 0.0, read_as, alone)
    share = min(1.0, max(0.0, float(verdict.share)))

    def told(sentence: str, **pieces: str) -> Said:
        """A sentence, then what follows from the student's own answers."""
        said = say(variant, part, sentence, read=echo(read_as, variant.lang), **pieces)
        tells = {} if told_with else verdict.found
        own = {f"found{n}": amount(variant, q, v) for n, (q, v) in enumerate(tells.items())}
        if not own:
            return said
        listed = ", ".join("{" + name + "}" for name in own)
        follows = words(variant.lang)["marking"]["found"].format(listed)
        return Said(f"{said.sentence} {follows}", {**said.pieces, **own})

    if share == 1.0:
        is_followed = found.followed or verdict.follows
        kind, share = ("follow_through", key.rules.follow_through) if is_followed else ("correct", 1.0)
        return made(kind, share, read_as, lambda: told(kind))
    shown = [verdict.mistake, *verdict.also] if verdict.mistake else _mistakes_that_fit(key, part, reading)
    matches = tuple(f"mistake:{name}" for name in shown) + ((f"slip:{found.slip}",) if found.slip else ())
    if shown:
        share = share if verdict.mistake and share else key.solution.mistakes[shown[0]].share

        def tell() -> Said:
            if told_with and verdict.mistake:
                return told("told_with", first=part_name(variant, told_with))
            return told("mistake", says=variant.told(shown[0]))

        return made(matches[0], share, read_as, tell, matches)
    if found.slip:
        about = either_symbol(variant, found.about, both=found.slip == "frame_missing")
        return made(
            matches[0], key.rules.slip, read_as, lambda: told(f"slip_{found.slip}", about=about), matches
        )
    return made("wrong", share, read_as, lambda: told(_WRONG.get(part.kind, "wrong")))


def _is_scale(part: Part) -> bool:
    """Whether a part asks for the scale of a drawing: so much for a millimetre of paper."""
    return bool(part.judge) and part.kind == "number" and part.unit.endswith("/mm")


def _missed(
    variant: Variant,
    part: Part,
    readings: Mapping[str, Reading],
    waiting: dict[str, dict[str, frozenset[str]]],
) -> str:
    """What an answer waits for to be judged, by questions: any of those that would do alone, else all of its group.

    ``waiting`` remembers by judge what could be judged with each missing answer.
    """
    group = {p.id: p.quantity for p in variant.parts if p.judge == part.judge}
    read = {i: readings[i].values[0] for i in group if readings[i].status == "read"}
    unread = [i for i in group if i not in read]
    if part.judge not in waiting:
        waiting[part.judge] = {}
        for i in unread:
            with suppress(CourseworkError):
                right = variant.key.reference[group[i]]
                waiting[part.judge][i] = frozenset(judged(variant, part.judge, {**read, i: right}))
    enough = [i for i, would_be in waiting[part.judge].items() if part.id in would_be]
    return questions(variant, enough, "or") if enough else questions(variant, unread, "and")


def _mistakes_that_fit(key: Key, part: Part, reading: Reading) -> list[str]:
    """The named mistakes that give an answer, in the solution's order."""
    ways = key.wrong_ways(part.quantity)
    return [name for name, value in ways if _fits(part, reading, value, None, 0.0)]


def _mark_part(
    variant: Variant,
    key: Key,
    part: Part,
    reading: Reading,
    judged_by: Part,
    nearest: tuple[int, float],
    before: _Before,
) -> Mark:
    made = partial(_made, variant, part, reading)
    if reading.status != "read":
        return made(reading.status, 0.0, "", lambda: say_not_read(variant, part, reading))
    index, gap = nearest
    explained = {} if gap <= 1 else dict(_explanations(key, part, reading, judged_by, before))
    matches = tuple(explained)
    likely = {m for m in matches if _is_likely(m, key, judged_by, before)}
    matches = tuple(sorted(matches, key=lambda m: m not in likely))
    verdict = matches[0] if likely else "wrong"
    if gap > 1:
        # What is told is told of the reading that it explains, else of the text as it stands.
        index = explained[verdict] if likely else 0
    read_as = reading.read_as[index]
    if part.kind == "choice":
        read_as = plain_line(variant.label(part.id, str(reading.values[index])), variant.lang)

    def told(sentence: str, **pieces: str) -> Said:
        read = echo(read_as, variant.lang)
        if part.kind == "choice":
            read = quoted(read, variant.lang)
        return say(variant, part, sentence, read=read, **pieces)

    if gap <= 1:
        if part.asks_unit and not reading.unit_given:
            return made("missing_unit", 0.0, read_as, lambda: told("missing_unit"))
        return made("correct", 1.0, read_as, lambda: told("correct"))
    kind, _, name = verdict.partition(":")
    if kind == "mistake":
        share = key.solution.mistakes[name].share
        return made(verdict, share, read_as, lambda: told("mistake", says=variant.told(name)), matches)
    if kind == "slip":
        return made(verdict, key.rules.slip, read_as, lambda: told(f"slip_{name}"), matches)
    if kind == "follow_through":
        return made(verdict, key.rules.follow_through, read_as, lambda: told("follow_through"), matches)
    return made("wrong", 0.0, read_as, lambda: told(_WRONG.get(part.kind, "wrong")), matches)


#: the sentence about a wrong answer, by kind of part
_WRONG = {
    "choice": "wrong_case",
    "equation": "wrong_equation",
    "direction": "wrong_place",
    "point_on_line": "wrong_place",
}


def _is_likely(match: str, key: Key, part: Part, before: _Before) -> bool:
    """Whether a verdict may be told of an answer that it explains.

    Not a mistake made elsewhere, where what it is about has been answered rightly before. Among few cases, besides,
    many mistakes lead to the same one: a choice tells nothing of a mistake made elsewhere that an earlier answer,
    which it would have changed, does not show.
    """
    kind, _, name = match.partition(":")
    if kind != "mistake" or match in before.shown:
        return True
    about = key.solution.mistakes[name].targets
    if part.quantity in about:
        return True
    if part.kind != "choice":
        return not any(_shows(key, name, quantity) for quantity in before.right.intersection(about))
    return not any(
        name == other and not _fits(earlier, reading, value, None, 0.0)
        for earlier, reading in before.read
        for other, value in key.wrong_ways(earlier.quantity)
    )


def _shows(key: Key, mistake: str, quantity: str) -> bool:
    """Whether an answer that is right of an asked quantity shows that a mistake about it was not made."""
    part = next(p for p in key.variant.parts if p.quantity == quantity)
    value = key.wrong[mistake].get(quantity)
    if value is None or part.kind == "equation":
        return False
    width = key.envelope.get(quantity, 0.0)
    return bool(distance(part, value, key.reference[quantity], key.reference.get(part.along), width) > 1)


def _explanations(
    key: Key, part: Part, reading: Reading, judged_by: Part, before: _Before
) -> Iterator[tuple[str, int]]:
    """Every verdict that explains a wrong answer, the one to give first; each with the reading that it explains."""
    quantity = judged_by.quantity
    width = key.envelope.get(quantity, 0.0)
    reference = key.reference[quantity]
    if part.kind in FOLLOWED and before.wrong:
        expected = key.followed(judged_by, before.own, before.wrong)
        if expected is not None and (place := _fitting(part, reading, expected, None, width)) is not None:
            yield "follow_through", place
    for name, value in key.wrong_ways(quantity):
        along = key.reference.get(judged_by.along)
        if judged_by.along:
            along = key.wrong[name].get(judged_by.along, along)
        if (place := _fitting(part, reading, value, along, width)) is not None:
            yield f"mistake:{name}", place
    if part.kind == "equation" and _holds_with_numbers(key.variant, part, reading.values[0], reference):
        yield "slip:numbers", 0
    seen = set()
    for kind, value in key.slips(judged_by):
        # A slip scales what rounding may have moved.
        own = width * abs(value / reference) if reference and part.kind == "number" else width
        if kind not in seen and (place := _fitting(part, reading, value, None, own)) is not None:
            seen.add(kind)
            yield f"slip:{kind}", place


def _holds_with_numbers(variant: Variant, part: Part, equation: Equation, reference: str) -> bool:
    """Whether an equation is the reference with this variant's numbers in place of some symbols."""
    numbers = {
        n: v
        for n, v in variant.used.items()
        if not isinstance(v, str) and variant.exercise.units.get(n) != "deg"
    }
    asked = parse_equation(reference, part.variables)
    put_in = {n: float(numbers[n]) for n in asked.variables - equation.variables if n in numbers}
    return bool(put_in) and same_equation(equation, asked.with_numbers(put_in), parameters=part.parameters)


def _fits(part: Part, reading: Reading, value: Any, along: Any, width: float) -> bool:
    return _fitting(part, reading, value, along, width) is not None


def _fitting(part: Part, reading: Reading, value: Any, along: Any, width: float) -> int | None:
    """The first reading that is this value, if any is."""
    places = range(len(reading.values))
    return next((i for i in places if distance(part, reading.values[i], value, along, width) <= 1), None)
