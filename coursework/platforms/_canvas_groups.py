"""Groups of questions, as Canvas draws from them: a question of each variant, of the same points, in one unit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from coursework.platforms.items import Item, Section
from coursework.platforms.posed import Interval, Posed
from coursework.reading.units import convert, find_unit
from coursework.sheets.sheet import Question

_PLACES = Decimal("0.0001")  #: the page keeps four decimals of a number that is typed
_LEAST = 5e-4  #: half of a margin, below which four decimals say too little
_COARSE = 1e-2  #: below it they widen a margin by a hundredth or more
_STEP = 3  #: decades from a unit to the next smaller
_MOST = 3  #: such steps
_PREFIXES = ("m", "µ", "n")


@dataclass(frozen=True)
class Asked:
    """A question of one variant."""

    item: Item
    posed: Posed


@dataclass(frozen=True)
class Group:
    """What one question of a student is drawn from."""

    exercise: str
    number: int
    asked: tuple[Asked, ...]

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
        """Half of the smallest margin; infinite where nothing has one."""
        right = [
            (interval.high - interval.low) / 2
            for one in self.asked
            for interval in one.posed.intervals
            if interval.is_right and interval.high > interval.low
        ]
        return min(right, default=float("inf"))

    @property
    def decades(self) -> int:
        """By how many powers of ten numbers are asked larger, so that four decimals say them."""
        steps = range(_MOST + 1)
        return _STEP * next((step for step in steps if self._margin * 10 ** (_STEP * step) >= _LEAST), _MOST)

    @property
    def is_scaled(self) -> bool:
        return self.decades > 0

    @property
    def is_coarse(self) -> bool:
        """Whether the page's decimals widen a margin noticeably."""
        return self._margin * 10**self.decades < _COARSE

    @property
    def unit(self) -> str:
        """The unit in which numbers are asked: one with a prefix, else the power of ten and the unit."""
        unit = self.question.unit
        if not self.is_scaled:
            return unit
        prefixed = _PREFIXES[self.decades // _STEP - 1] + unit
        if _is_smaller(prefixed, unit, self.decades):
            return prefixed
        power = "".join("⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".index(sign)] for sign in str(-self.decades))
        return f"10{power} {unit}".rstrip()


def _is_smaller(prefixed: str, unit: str, decades: int) -> bool:
    """Whether a unit with a prefix is another by that many powers of ten."""
    if not unit or unit.startswith("°") or find_unit(prefixed) is None or find_unit(unit) is None:
        return False
    return Fraction(convert(1.0, prefixed, unit)).limit_denominator(10**12) == Fraction(1, 10**decades)


def groups(section: Section) -> tuple[Group, ...]:
    """The groups of an exercise. A part stands in one group alone, so that nobody is asked it twice."""
    first = section.items[0].questions
    found: list[list[Asked]] = [[] for _ in first]
    for asked, place in _placed(section):
        if place is not None:
            found[place].append(asked)
    return tuple(
        Group(section.exercise, number, tuple(some)) for number, some in enumerate(found, start=1) if some
    )


def left_out(section: Section) -> dict[str, int]:
    """Of how many variants a part is asked by no group: other variants ask others in its place."""
    return dict(Counter(asked.posed.question.id for asked, place in _placed(section) if place is None))


def _placed(section: Section) -> Iterator[tuple[Asked, int | None]]:
    """Each question of each variant, and the place of its group; None where it has none."""
    points = [posed.points for posed in section.items[0].questions]
    places: dict[str, int] = {}
    for item in section.items:
        for place, posed in enumerate(item.questions):
            kept = places.setdefault(posed.question.id, place)
            fits = kept == place < len(points) and posed.points == points[place]
            yield Asked(item, posed), place if fits else None


def accepted(interval: Interval, decades: int) -> tuple[Decimal, Decimal, Decimal]:
    """The middle of what is accepted and its ends, which lie where the page rounds the margin's own ends to."""
    low, high = (_typed(end, decades) for end in (interval.low, interval.high))
    return (low + high) / 2, low, high


def _typed(value: float, decades: int) -> Decimal:
    """A number as the page keeps it."""
    return Decimal(repr(value)).scaleb(decades).quantize(_PLACES).normalize() + 0
