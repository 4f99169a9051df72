"""Questions that a platform can judge: the right answers and those of known errors.

The marker marks each of these answers first; its points and messages are those of the platform.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from coursework.course.answer_key import Key
from coursework.course.variant import Variant
from coursework.kinds.choices import cases_of
from coursework.kinds.ticks import cost_of_wrong
from coursework.language.numbers import plain, settled, significant
from coursework.marking.diagnosis import CLOSE
from coursework.marking.marking import mark_alone
from coursework.marking.usual import NEAR, NEAR_HERE
from coursework.model import Part
from coursework.sheets.sheet import Question

NUMBER, CHOICE, CHOICES, COLLECTED = KINDS = ("number", "choice", "choices", "collected")
_DIGITS = 4  #: of a wrong answer in the sentence about it
_ALL_DIGITS = 9  #: of one that two errors may give, in the same place
_SAME = 1e-9  #: relative difference allowed between two computations of a value
_TURNS = (0, 1, -1)  #: whole turns added to an angle


@dataclass(frozen=True)
class Interval:
    """Closed interval of numbers that count as one answer, in the part's unit."""

    low: float
    high: float
    value: float  #: the exact answer, between the ends
    share: float = 1.0  #: of the points
    message: str = ""  #: Markdown; empty for a right answer
    verdict: str = "correct"
    turns: int = 0  #: whole turns from the solution's value

    @property
    def is_right(self) -> bool:
        return self.verdict == "correct"

    @property
    def half(self) -> float:
        return (self.high - self.low) / 2

    @property
    def core(self) -> Interval:
        """Return the part of the interval that belongs to this error for certain; further out it may belong
        to another."""
        return replace(self, low=self.value - CLOSE * self.half, high=self.value + CLOSE * self.half)


@dataclass(frozen=True)
class Option:
    """Option of a choice."""

    case: str
    letter: str  #: as printed before it; empty of a sheet that was issued without
    label: str  #: Markdown
    share: float  #: of the points; in a multiple choice, the share that this option adds or subtracts
    message: str = ""  #: Markdown


@dataclass(frozen=True)
class Posed:
    """Question as a platform presents it. A ``collected`` answer is stored as typed and not judged there."""

    question: Question
    kind: str  #: number, choice, choices, collected
    #: The right ones first, then those of errors: the first that contains an answer counts.
    intervals: tuple[Interval, ...] = ()
    options: tuple[Option, ...] = ()  #: in the order printed
    #: Features of our marking, by the names of :mod:`~coursework.platforms.losses`.
    features: frozenset[str] = frozenset()

    @property
    def points(self) -> float:
        return self.question.points


def posed(variant: Variant, question: Question, part: Part) -> Posed:
    """Return a question of a variant's sheet for a platform."""
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
    """Yield the features of our marking of a part that a platform may lack."""
    if why := _why_collected(variant, key, part):
        yield from ("collected", why)
        if part.sort.box in ("line", "lines"):
            yield "less_than"
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
    """Return the reason why no platform can judge a part; "" if it can."""
    if part.sort.is_open:
        return "open"
    if part.judge:
        return "judged_together"
    if part.id in variant.exercise.spec.exchangeable:
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
    """Return the intervals of the right answer and of errors, narrowed by more than the last bits, which
    differ between processors."""
    for interval in _found_intervals(variant, key, part):
        inward = _INWARD * max(abs(interval.low), abs(interval.high)) if interval.half else 0.0
        low, high = settled(interval.low + inward), settled(interval.high - inward)
        yield replace(interval, low=low, high=high, value=settled(interval.value))


_INWARD = 1e-9  #: of the larger end


def _found_intervals(variant: Variant, key: Key, part: Part) -> Iterator[Interval]:
    reference, width = float(key.reference[part.quantity]), key.half_width(part)
    yield from _turned(Interval(reference - width, reference + width, reference), part)
    for interval in _wrong_intervals(variant, key, part):
        yield from (
            turned
            for turned in _turned(interval, part)
            if not turned.turns or _is_told(turned, variant, part)
        )


def _is_told(turned: Interval, variant: Variant, part: Part) -> bool:
    """Return whether our marking gives an error the same message a whole turn away, as it does not for
    degrees and radians."""
    marked = _wrong_interval(variant, part, turned.value, turned.half, _ALL_DIGITS)
    return marked is not None and marked.verdict == turned.verdict


def _wrong_intervals(variant: Variant, key: Key, part: Part) -> Iterator[Interval]:
    """Return the intervals of known errors. Where two overlap, answers close to one belong to it; then the
    order of marking decides."""
    intervals: list[Interval] = []
    for value, half in _wrong_values(key, part):
        interval = _wrong_interval(variant, part, value, half)
        if interval is not None and not any(_same(interval, other) for other in intervals):
            intervals.append(interval)
    shared = [
        interval
        for interval in intervals
        if any(_meet(interval, other, part) for other in intervals if other is not interval)
    ]
    exact_of = {interval: _exactly(interval, variant, part) for interval in shared}
    yield from (interval.core for interval in exact_of.values() if interval is not None)
    remaining = [
        interval
        for interval in (exact_of.get(interval, interval) for interval in intervals)
        if interval is not None
    ]
    yield from sorted(remaining, key=lambda interval: _rank(interval, key, part))


def _exactly(interval: Interval, variant: Variant, part: Part) -> Interval | None:
    """Return an error marked with many digits, with the message for few digits if the mark is the same."""
    exact = _wrong_interval(variant, part, interval.value, interval.half, _ALL_DIGITS)
    return interval if exact is not None and exact.verdict == interval.verdict else exact


def _meet(first: Interval, other: Interval, part: Part) -> bool:
    """Return whether two intervals overlap, whole turns apart included for an angle."""
    apart = other.value - first.value
    turn = part.sort.turn
    return abs(math.remainder(apart, turn) if turn else apart) <= first.half + other.half


def _rank(interval: Interval, key: Key, part: Part) -> int:
    """Return the rank of overlapping errors: mistakes about this quantity first, then slips, then mistakes
    made elsewhere."""
    kind, _, name = interval.verdict.partition(":")
    if kind != "mistake":
        return 1
    return 0 if part.quantity in key.solution.mistakes[name].targets else 2


def _turned(interval: Interval, part: Part) -> Iterator[Interval]:
    """Return the interval, and for an angle those whole turns away."""
    for turns in _TURNS if part.sort.turn else (0,):
        by = turns * part.sort.turn
        yield replace(
            interval, low=interval.low + by, high=interval.high + by, value=interval.value + by, turns=turns
        )


def _wrong_values(key: Key, part: Part) -> Iterator[tuple[float, float]]:
    """Yield the values that named mistakes give, then those of slips, each with the half-width in which
    marking names them."""
    width = key.envelope.get(part.quantity, 0.0)
    for name, value in key.wrong_ways(part.quantity):
        near = NEAR_HERE if part.quantity in key.solution.mistakes[name].targets else NEAR
        if isinstance(value, (int, float)) and math.isfinite(value):
            yield float(value), 0.0 if part.is_exact else near * max(part.half_width(value), width)
    reference = float(key.reference[part.quantity])
    for slip in key.slips(part):
        yield slip.made(reference), NEAR * abs(slip.made(1.0)) * key.half_width(part)
    for value in key.other_cases(part):
        if isinstance(value, (int, float)) and math.isfinite(value):
            yield float(value), 0.0 if part.is_exact else NEAR * max(part.half_width(value), width)


def _wrong_interval(
    variant: Variant, part: Part, value: float, half: float, digits: int = _DIGITS
) -> Interval | None:
    """Return the interval of a wrong value; None if our marking does not recognise it."""
    text = significant(value, digits) if not part.is_exact else plain(value)
    if len(text.partition(".")[2]) == 3:
        text += "0"  # three decimals could be thousands
    marked = mark_alone(variant, part, text)
    if marked.verdict == "correct" or not marked.verdict.startswith(("mistake:", "slip:")):
        return None
    if value and abs(value) <= half and mark_alone(variant, part, "0").verdict != marked.verdict:
        return None  # a nought earns nothing, and an interval has no hole
    return Interval(
        value - half, value + half, value, marked.points / marked.out_of, marked.says, marked.verdict
    )


def _same(interval: Interval, other: Interval) -> bool:
    """Return whether an interval is redundant: another of the same verdict contains it, apart from the last
    bits."""
    slack = _SAME * max(abs(interval.low), abs(interval.high))
    return (
        interval.verdict == other.verdict
        and other.low - slack <= interval.low
        and interval.high <= other.high + slack
    )


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
        marked = mark_alone(variant, part, case)
        message = "" if marked.verdict == "correct" else marked.says
        yield Option(case, letter, label, marked.points / marked.out_of, message)
