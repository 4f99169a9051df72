"""Two answers that stand in each other's box: found from what each would be in the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coursework.errors import CourseworkError
from coursework.kinds.nearness import gaps
from coursework.marking.answers import read
from coursework.marking.diagnosis import CLOSE, EarlierAnswers, fits_followed, is_likely, nearest_reading
from coursework.marking.judges import Verdict, is_scale, judged, judges_of
from coursework.marking.usual import nearness
from coursework.model import Part
from coursework.parsing.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant

_ROUNDED = 0.005  #: of a value: what rounding to three digits may change
_FEW_JUDGED = 6  #: wrong numbers that judges judge, of which more are not tried in pairs


class Exchange(NamedTuple):
    """Answer of a part that fits another part's box."""

    part: Part  #: in whose box it would be right
    reading: Reading  #: as that part reads it
    place: int  #: which honest reading of it


def exchanged(
    variant: Variant,
    readings: Mapping[str, Reading],
    wrong: Mapping[str, Reading],
    verdicts: Mapping[str, Verdict],
    *,
    is_guessed: bool,
) -> dict[str, Exchange]:
    """Return by part the other part whose box its answer stands in, of answers that are ``wrong`` where they
    stand.

    Counts and cases exchange by chance. Of counts a pair is meant where no other count is wrong and the later
    one does not follow from the earlier; of cases never. Of answers with ``verdicts`` of a judge the judge is
    asked once more.
    """
    boxes = _Boxes(variant, readings, wrong, verdicts)
    counts = [p for p in boxes.parts if p.sort.is_exact]
    exchanges: dict[str, Exchange] = {}
    for pair in combinations(boxes.parts, 2):
        if any(part.id in exchanges for part in pair) or not any(part.id in wrong for part in pair):
            continue
        if all(part.sort.is_exact for part in pair) and (
            is_guessed or len(counts) > 2 or boxes.goes_on(*pair)
        ):
            continue
        exchanges |= boxes.exchange(*pair)
    return exchanges


class _Boxes:
    """The boxes of a sheet whose answers are not right where they stand."""

    def __init__(
        self,
        variant: Variant,
        readings: Mapping[str, Reading],
        wrong: Mapping[str, Reading],
        verdicts: Mapping[str, Verdict],
    ) -> None:
        self._variant, self._readings, self._verdicts = variant, readings, verdicts
        # What follows from a wrong answer to a judge may do so by chance.
        followed = {i for i, verdict in verdicts.items() if verdict.said and verdict.said.follows}
        may_be = [p for p in variant.parts if p.id in readings and _may_be(p, readings[p.id])]
        drawn = [p for p in may_be if p.judge and p.id in wrong]
        if len(drawn) > _FEW_JUDGED:
            drawn = []
        elif drawn and len(drawn) + len(followed) <= _FEW_JUDGED:
            drawn += [p for p in may_be if p.id in followed and p.id not in wrong]
        self._wrong = wrong
        self.parts = [p for p in may_be if p in drawn or (p.id in wrong and not p.judge)]
        self._before = EarlierAnswers(
            right={
                p.quantity for p in variant.parts if p.id in readings and p.id not in wrong and not p.judge
            }
        )

    def exchange(self, first: Part, other: Part) -> dict[str, Exchange]:
        """Return both exchanges where each answer is right in the box of the other, unless each is explained
        in its own."""
        if not (self._is_near(first, other) and self._is_near(other, first)):
            return {}
        if self._are_explained(first, other):
            return {}
        ways = {
            box.id: Exchange(target, read(self._variant, target, self._readings[box.id].text), 0)
            for box, target in ((first, other), (other, first))
        }
        if any(way.reading.status != "read" for way in ways.values()):
            return {}
        for box, way in ways.items():
            if not way.part.judge:
                place, gap = nearest_reading(way.part, way.reading, self._variant.key, way.part)
                if not self._is_close(way.part, way.reading.values[place], gap):
                    return {}
                ways[box] = way._replace(place=place)
        return ways if self._is_right_to_judges(ways) else {}

    def _is_right_to_judges(self, ways: Mapping[str, Exchange]) -> bool:
        """Return whether the judges of exchanged answers take each for right where it belongs, and name no
        mistake of theirs any more: what other answers show still is not an exchange."""
        shown = {v.said.mistake for i in ways if (v := self._verdicts.get(i)) and v.said} - {""}
        placed = {way.part.id: way.reading.values[way.place] for way in ways.values() if way.part.judge}
        for name, ids in judges_of(self._variant):
            if placed.keys().isdisjoint(ids):
                continue
            stand = {i: self._readings[i].values[v.reading] for i, v in self._verdicts.items() if i in ids}
            try:
                said = judged(self._variant, name, stand | {i: v for i, v in placed.items() if i in ids})
            except CourseworkError:
                return False
            if any(i not in said or said[i].share < 1 for i in placed if i in ids):
                return False
            if any(one.mistake in shown for one in said.values()):
                return False
        return True

    def _is_close(self, part: Part, value: Any, gap: float) -> bool:
        """Return whether an answer fits a box to its last digit: near values may agree by chance."""
        if not part.sort.is_scalar or part.sort.is_exact:
            return gap <= 1
        return gap <= min(1.0, nearness(part, self._variant.key, part, value, CLOSE))

    def _are_explained(self, *pair: Part) -> bool:
        """Return whether each of two answers is explained in its own box, those of a judge by one mistake.

        A mistake that another answer to the judge shows too is one of the whole, which an exchange may make.
        """
        if any(is_scale(part) for part in pair) and len(self._wrong) > len(pair):
            return True  # many scales are right, for other drawings
        shown = [self._mistake(part, pair) for part in pair if part.judge]
        return all(shown) and len(set(shown)) <= 1 and all(self._is_explained(p) for p in pair if not p.judge)

    def _mistake(self, part: Part, pair: Sequence[Part]) -> str:
        """Return the mistake that a judge names of an answer, and of none beyond the pair unless it gives
        just this answer."""
        said = {i: v.said for i, v in self._verdicts.items() if v.said}
        named = said[part.id].mistake if part.id in said else ""
        if self._gives(named, part):
            return named
        others = {*dict(judges_of(self._variant))[part.judge]}.difference(p.id for p in pair)
        return "" if any(said[i].mistake == named for i in others if i in said) else named

    def _gives(self, mistake: str, part: Part) -> bool:
        """Return whether a mistake, itself no exchange, gives an answer to a judge as closely as people
        round."""
        key = self._variant.key
        if not mistake or key.solution.mistakes[mistake].kind == "exchanged":
            return False
        wrong = key.wrong[mistake].get(part.quantity)
        return isinstance(wrong, float | int) and any(
            abs(value - wrong) <= _ROUNDED * abs(wrong) for value in self._readings[part.id].values
        )

    def _is_explained(self, part: Part) -> bool:
        """Return whether the opposite sign or a known mistake gives the answer in its own box as closely."""
        key = self._variant.key
        reading, width = self._readings[part.id], key.envelope.get(part.quantity, 0.0)
        others = [v for name, v in key.wrong_ways(part.quantity) if is_likely(name, key, part, self._before)]
        if part.sort.is_number:
            others.append(-key.reference[part.quantity])
        return any(
            self._is_close(part, value, part.sort.distance(part, value, other, None, width))
            for value in reading.values
            for other in others
        )

    def goes_on(self, first: Part, part: Part) -> bool:
        """Return whether an answer follows from an earlier wrong one and the others, each in its own box."""
        reading, wrong = self._readings[part.id], self._readings[first.id]
        if not first.sort.is_followed or wrong.status != "read" or reading.status != "read":
            return False
        key, parts = self._variant.key, self._variant.parts
        earlier = {
            p.quantity: key.reference[p.quantity]
            for p in parts[: parts.index(part)]
            if p.sort.is_followed and p.quantity in self._before.right
        }
        return any(
            fits_followed(key, part, reading, part, earlier | {first.quantity: value}, {first.quantity})
            is not None
            for value in wrong.values
        )

    def _is_near(self, box: Part, other: Part) -> bool:
        """Return whether an answer may be right in another box: a cheap test that never rejects a number
        without a unit wrongly."""
        reading, key = self._readings[box.id], self._variant.key
        if reading.status != "read":
            return other.sort.is_scalar
        if other.judge:
            return box.sort.is_scalar
        reference = key.reference[other.quantity]
        if not other.sort.is_scalar:
            along = key.reference.get(other.along)
            return all(
                not isinstance(v, (str, float, int)) and other.sort.distance(other, v, reference, along) <= 1
                for v in reading.values
            )
        width = key.half_width(other) + 1e-9 * abs(reference)
        return any(
            isinstance(v, (float, int)) and gaps(np.asarray(v), reference, other.sort.turn) <= width
            for v in reading.values
        )


def _may_be(part: Part, reading: Reading) -> bool:
    sort = part.sort
    if sort.is_open or sort.is_text or sort.has_few_values or (part.judge and not sort.is_number):
        return False
    if reading.status in ("wrong_unit", "unreadable"):
        return sort.is_scalar and reading.code != "two_ways" and not part.judge
    return reading.status == "read"
