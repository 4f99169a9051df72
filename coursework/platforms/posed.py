"""What a platform can judge by itself: a question with its right answers and those that known errors give.

An answer that a platform is to know is marked by the marker first: what it is worth, and what is said of it, are the mark's.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from coursework.course.answer_key import Key
from coursework.course.variant import Variant
from coursework.kinds.choices import cases_of
from coursework.kinds.ticks import cost_of_wrong
from coursework.language.numbers import plain, settled, significant
from coursework.marking.explaining import CLOSE
from coursework.marking.mark import Mark
from coursework.marking.marking import mark
from coursework.marking.usual import NEAR
from coursework.model import Part
from coursework.sheets.sheet import Question

NUMBER, CHOICE, CHOICES, COLLECTED = KINDS = ("number", "choice", "choices", "collected")
_DIGITS = 4  #: of a wrong answer in the sentence about it
_ALL_DIGITS = 9  #: of one that two errors may give, in the same place
_SAME = 1e-9  #: of a value: what two ways to compute it may differ by
_TURNS = (0, 1, -1)  #: whole turns more or fewer that an angle is written with


@dataclass(frozen=True)
class Interval:
    """Numbers that are taken for one answer, in the part's unit; the ends belong to it."""

    low: float
    high: float
    value: float  #: what the answer is, between them
    share: float = 1.0  #: of the points
    says: str = ""  #: Markdown; nothing of a right answer
    verdict: str = "correct"
    turns: int = 0  #: whole turns from the value that the solution gives

    @property
    def is_right(self) -> bool:
        return self.verdict == "correct"

    @property
    def half(self) -> float:
        return (self.high - self.low) / 2

    @property
    def core(self) -> Interval:
        """The answers that are what an error gives; those further out may be of another."""
        return replace(self, low=self.value - CLOSE * self.half, high=self.value + CLOSE * self.half)


@dataclass(frozen=True)
class Option:
    """A case that is offered."""

    case: str
    letter: str  #: as printed before it; empty of a sheet that was issued without
    label: str  #: Markdown
    share: float  #: of the points; of several that may be chosen, what this one adds or takes
    says: str = ""  #: Markdown


@dataclass(frozen=True)
class Posed:
    """A question as a platform poses it. What is ``collected`` is kept as it was typed, and judged by nobody there."""

    question: Question
    kind: str  #: number, choice, choices, collected
    intervals: tuple[
        Interval, ...
    ] = ()  #: the right ones first, then what errors give: the first that holds an answer counts
    options: tuple[Option, ...] = ()  #: in the order printed
    features: frozenset[str] = (
        frozenset()
    )  #: what our marking does with it, by the words of :mod:`~coursework.platforms.losses`

    @property
    def points(self) -> float:
        return self.question.points


def posed(variant: Variant, question: Question, part: Part) -> Posed:
    """A question of a variant's sheet, for a platform."""
    key = variant.key
    features = frozenset(_features(variant, key, part))
    if "collected" in features:
        return Posed(question, COLLECTED, features=features)
    if part.choices:
        return Posed(
            question,
            CHOICES if question.box == "several" else CHOICE,
            options=tuple(_options(variant, key, question, part)),
            features=features,
        )
    return Posed(question, NUMBER, tuple(_intervals(variant, key, part)), features=features)


# ------------------------------------------------------------------------ features


def _features(variant: Variant, key: Key, part: Part) -> Iterator[str]:
    """What our marking does with a part that a platform may not do."""
    if why := _why_collected(variant, key, part):
        yield from ("collected", why)
    elif part.sort.is_scalar:
        yield "unreadable"
        if not part.is_exact:
            yield "comma"
        if part.unit != "1":
            yield from ("unit_written", "unit_refused")
        if part.sort.turn:
            yield "turns"
    if part.sort.share_stands or part.sort.has_rule:
        yield "partial"
    if not part.sort.is_open:
        yield from _from_errors(variant, key, part)


def _why_collected(variant: Variant, key: Key, part: Part) -> str:
    """Why no platform can judge a part by what it knows; nothing where it can."""
    if part.sort.is_open:
        return "open"
    if part.judge:
        return "judged_together"
    if any(part.id in group for group in variant.exercise.spec.either_order):
        return "either_order"
    if part.choices:
        several_of_none = part.sort.box == "several" and not cases_of(key.reference[part.quantity])
        return "none_right" if several_of_none else ""
    if not part.sort.is_scalar:
        return "form"
    if part.asks_unit:
        return "unit_asked"
    return "" if math.isfinite(key.reference[part.quantity]) else "form"


def _from_errors(variant: Variant, key: Key, part: Part) -> Iterator[str]:
    before = variant.parts[: variant.parts.index(part)]
    above = (p.quantity for p in before if p.sort.is_followed)
    if part.sort.follows and any(part.quantity in key.solution.depending_on(q) for q in above):
        yield "follow_through"
    mistakes = {name for name, _ in key.wrong_ways(part.quantity)}
    if mistakes:
        yield "mistakes"
    earlier = (p.quantity for p in before if not p.sort.is_open)
    if any(mistakes & {name for name, _ in key.wrong_ways(q)} for q in earlier):
        yield "counted_once"
    if part.sort.is_scalar and not part.judge:
        yield "usual_errors"


# ------------------------------------------------------------------------- numbers


def _intervals(variant: Variant, key: Key, part: Part) -> Iterator[Interval]:
    """What is taken for an answer, and for an error, without last bits, which would differ from one processor to another:
    the ends are drawn in by more than these."""
    for one in _found_intervals(variant, key, part):
        inward = _INWARD * max(abs(one.low), abs(one.high)) if one.half else 0.0
        low, high = settled(one.low + inward), settled(one.high - inward)
        yield replace(one, low=low, high=high, value=settled(one.value))


_INWARD = 1e-9  #: of the larger end


def _found_intervals(variant: Variant, key: Key, part: Part) -> Iterator[Interval]:
    reference, width = float(key.reference[part.quantity]), key.half_width(part)
    yield from _turned(Interval(reference - width, reference + width, reference), part)
    for interval in _wrong_intervals(variant, key, part):
        yield from (one for one in _turned(interval, part) if not one.turns or _is_told(one, variant, part))


def _is_told(turned: Interval, variant: Variant, part: Part) -> bool:
    """Whether our marking takes an error whole turns away for the same: not degrees for radians."""
    made = _wrong_interval(variant, part, turned.value, turned.half, _ALL_DIGITS)
    return made is not None and made.verdict == turned.verdict


def _wrong_intervals(variant: Variant, key: Key, part: Part) -> Iterator[Interval]:
    """What known errors give. Where two take the same answers, what is close to one is of that one, then as marking ranks them."""
    found: list[Interval] = []
    for value, half in _wrong_values(key, part):
        one = _wrong_interval(variant, part, value, half)
        if one is not None and not any(_same(one, other) for other in found):
            found.append(one)
    shared = [one for one in found if any(_meet(one, other, part) for other in found if other is not one)]
    told = {one: _exactly(one, variant, part) for one in shared}
    yield from (one.core for one in told.values() if one is not None)
    kept = [one for one in (told.get(one, one) for one in found) if one is not None]
    yield from sorted(kept, key=lambda one: _rank(one, key, part))


def _exactly(interval: Interval, variant: Variant, part: Part) -> Interval | None:
    """An error as its value in many digits is marked; the sentence has few where it is the same."""
    made = _wrong_interval(variant, part, interval.value, interval.half, _ALL_DIGITS)
    return interval if made is not None and made.verdict == interval.verdict else made


def _meet(one: Interval, other: Interval, part: Part) -> bool:
    """Whether two take an answer in common, of an angle whole turns apart."""
    apart = other.value - one.value
    turn = part.sort.turn
    return abs(math.remainder(apart, turn) if turn else apart) <= one.half + other.half


def _rank(interval: Interval, key: Key, part: Part) -> int:
    """Of answers that are close to nothing: first mistakes about this very quantity, then slips, then mistakes made elsewhere."""
    kind, _, name = interval.verdict.partition(":")
    if kind != "mistake":
        return 1
    return 0 if part.quantity in key.solution.mistakes[name].targets else 2


def _turned(interval: Interval, part: Part) -> Iterator[Interval]:
    """The same, and for an angle whole turns more and fewer."""
    for turns in _TURNS if part.sort.turn else (0,):
        by = turns * part.sort.turn
        yield replace(
            interval,
            low=interval.low + by,
            high=interval.high + by,
            value=interval.value + by,
            turns=turns,
        )


def _wrong_values(key: Key, part: Part) -> Iterator[tuple[float, float]]:
    """Yield the values that named mistakes give, then those of slips, each with the half-width in which marking names them."""
    width = key.envelope.get(part.quantity, 0.0)
    for _, value in key.wrong_ways(part.quantity):
        if isinstance(value, (int, float)) and math.isfinite(value):
            yield float(value), 0.0 if part.is_exact else NEAR * max(part.half_width(value), width)
    reference = float(key.reference[part.quantity])
    for slip in key.slips(part):
        yield slip.made(reference), NEAR * abs(slip.made(1.0)) * key.half_width(part)
    for value in key.other_cases(part):
        if isinstance(value, (int, float)) and math.isfinite(value):
            yield float(value), 0.0 if part.is_exact else NEAR * max(part.half_width(value), width)


def _wrong_interval(
    variant: Variant, part: Part, value: float, half: float, digits: int = _DIGITS
) -> Interval | None:
    """What is taken for a wrong value; None where our marking does not take it for one that it knows."""
    text = significant(value, digits) if not part.is_exact else plain(value)
    if len(text.partition(".")[2]) == 3:
        text += "0"  # three decimals could be thousands
    made = marked_alone(variant, part, text)
    if made.verdict == "correct" or not made.verdict.startswith(("mistake:", "slip:")):
        return None
    if value and abs(value) <= half and marked_alone(variant, part, "0").verdict != made.verdict:
        return None  # a nought earns nothing, and an interval has no hole
    return Interval(value - half, value + half, value, made.points / made.out_of, made.says, made.verdict)


def _same(one: Interval, other: Interval) -> bool:
    """Whether one is told already: it adds nothing where another of the same verdict holds all of it, but for last bits."""
    slack = _SAME * max(abs(one.low), abs(one.high))
    return one.verdict == other.verdict and other.low - slack <= one.low and one.high <= other.high + slack


def marked_alone(variant: Variant, part: Part, answer: Any) -> Mark:
    """The mark of an answer on a sheet that is blank but for it."""
    return mark(variant, {part.id: answer})[part.id]


# ------------------------------------------------------------------------- choices


def _options(variant: Variant, key: Key, question: Question, part: Part) -> Iterator[Option]:
    letters = variant.letters(part)
    right = cases_of(key.reference[part.quantity]) if question.box == "several" else frozenset()
    for case, label in question.choices:
        letter = letters.get(case, "")
        if right:
            share = 1 / len(right) if case in right else -cost_of_wrong(len(right), len(question.choices))
            yield Option(case, letter, label, share)
            continue
        made = marked_alone(variant, part, case)
        says = "" if made.verdict == "correct" else made.says
        yield Option(case, letter, label, made.points / made.out_of, says)
