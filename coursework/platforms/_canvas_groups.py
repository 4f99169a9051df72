"""Groups of questions, from which Canvas draws: one question per variant, with equal points and in one
unit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from coursework.parsing.units import convert, find_unit
from coursework.platforms.items import PoolSection
from coursework.platforms.pieces import Image
from coursework.platforms.posed import Interval, Posed
from coursework.sheets.sheet import Question

_PLACES = Decimal("0.0001")  #: the page keeps four decimals of a number that is typed
_LEAST = 5e-4  #: half of a margin, below which four decimals say too little
_COARSE = 1e-2  #: below it they widen a margin by a hundredth or more
_STEP = 3  #: decades from a unit to the next smaller
_MOST = 3  #: such steps
_PREFIXES = ("m", "µ", "n")


@dataclass(frozen=True)
class CanvasItem:
    """Variant as the quiz holds it, but for what its groups decide: the unit of the numbers."""

    identifier: str
    labels: tuple[str, ...]  #: of the questions
    opening: str  #: HTML
    images: tuple[Image, ...]  #: of the opening
    questions: tuple[Posed, ...]  #: without the wrong numbers, of which the platform says nothing


@dataclass(frozen=True)
class VariantQuestion:
    """Question of one variant."""

    item: CanvasItem
    posed: Posed
    label: str


@dataclass(frozen=True)
class QuestionGroup:
    """Questions from which Canvas draws one for each student."""

    exercise: str
    number: int
    asked: tuple[VariantQuestion, ...]

    @property
    def question(self) -> Question:
        return self.asked[0].posed.question

    @property
    def part(self) -> str:
        return self.question.id

    @property
    def points(self) -> float:
        return self.question.points

    @property
    def _margin(self) -> float:
        """Return half of the smallest margin; infinite if there is none."""
        right = [
            (interval.high - interval.low) / 2
            for question in self.asked
            for interval in question.posed.intervals
            if interval.is_right and interval.high > interval.low
        ]
        return min(right, default=float("inf"))

    @property
    def decades(self) -> int:
        """Return the powers of ten by which numbers are scaled, so that four decimals are enough."""
        steps = range(_MOST + 1)
        return _STEP * next((step for step in steps if self._margin * 10 ** (_STEP * step) >= _LEAST), _MOST)

    @property
    def is_scaled(self) -> bool:
        return self.decades > 0

    @property
    def is_coarse(self) -> bool:
        """Return whether rounding to the page's decimals widens a margin noticeably."""
        return self._margin * 10**self.decades < _COARSE

    @property
    def unit(self) -> str:
        """Return the unit of the numbers: one with a prefix, else the power of ten and the unit."""
        unit = self.question.unit
        if not self.is_scaled:
            return unit
        prefixed = _PREFIXES[self.decades // _STEP - 1] + unit
        if _is_smaller(prefixed, unit, self.decades):
            return prefixed
        power = "".join("⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".index(sign)] for sign in str(-self.decades))
        return f"10{power} {unit}".rstrip()


def _is_smaller(prefixed: str, unit: str, decades: int) -> bool:
    """Return whether a unit with a prefix is the other unit divided by that power of ten."""
    if not unit or unit.startswith("°") or find_unit(prefixed) is None or find_unit(unit) is None:
        return False
    return Fraction(convert(1.0, prefixed, unit)).limit_denominator(10**12) == Fraction(1, 10**decades)


def groups(section: PoolSection) -> tuple[QuestionGroup, ...]:
    """Return the groups of an exercise. A part is in one group only, so that nobody gets it twice."""
    first = section.items[0].content.questions
    by_group: list[list[VariantQuestion]] = [[] for _ in first]
    for variant_question, index in _placed(section):
        if index is not None:
            by_group[index].append(variant_question)
    return tuple(
        QuestionGroup(section.exercise, number, tuple(some))
        for number, some in enumerate(by_group, start=1)
        if some
    )


def left_out(section: PoolSection) -> dict[str, int]:
    """Return, by part, the number of variants whose question is in no group: other variants ask other parts
    there."""
    return dict(
        Counter(
            variant_question.posed.question.id
            for variant_question, index in _placed(section)
            if index is None
        )
    )


def _placed(section: PoolSection) -> Iterator[tuple[VariantQuestion, int | None]]:
    """Yield each question of each variant with the index of its group; None if it has none."""
    contents: list[CanvasItem] = [item.content for item in section.items]
    points = [posed.points for posed in contents[0].questions]
    places: dict[str, int] = {}
    for item in contents:
        for index, (posed, label) in enumerate(zip(item.questions, item.labels, strict=True)):
            first_index = places.setdefault(posed.question.id, index)
            fits = first_index == index < len(points) and posed.points == points[index]
            yield VariantQuestion(item, posed, label), index if fits else None


def accepted(interval: Interval, decades: int) -> tuple[Decimal, Decimal, Decimal]:
    """Return the middle and the ends of the accepted interval; the ends are those of the margin as the page
    rounds them."""
    low, high = (_typed(end, decades) for end in (interval.low, interval.high))
    return (low + high) / 2, low, high


def _typed(value: float, decades: int) -> Decimal:
    """Return a number as the page stores it."""
    return Decimal(repr(value)).scaleb(decades).quantize(_PLACES).normalize() + 0
