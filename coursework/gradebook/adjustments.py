"""Adjustments after an exam: what a question counts, what answers and errors earn, and the scale of the mark.

Each is a decision on no single student, a line that lasts; the last on a place counts. They change marked
sheets, never answers or readings, so that taking one back gives the marks of before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import copy
from functools import cached_property
from itertools import groupby, pairwise
from typing import Any, NamedTuple

from coursework.course.marking_rules import DIGITS_KEPT
from coursework.errors import BadInput, nearest
from coursework.gradebook.decision import Decision
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.scale import USUAL_SCALE, exact
from coursework.issuing.issued import Issued
from coursework.issuing.questions import Question as Question
from coursework.language.numbers import typed_number
from coursework.language.words import words
from coursework.marking.mark import Mark
from coursework.messages import Message

WEIGHT, NEUTRAL, SPARED, BONUS = "weight", "neutral", "neutral_if_hurt", "bonus"
TOLERANCE, DIGITS, PRICE = "tolerance", "digits", "price"
FULL, CURVE, STEP = "full", "curve", "step"
#: Kinds of adjustments, in the order in which they are offered.
ADJUSTMENTS = (WEIGHT, NEUTRAL, SPARED, BONUS, TOLERANCE, DIGITS, PRICE, FULL, CURVE, STEP)
ON_SCALE = (FULL, CURVE, STEP)
OF_NO_QUESTION = (DIGITS, *ON_SCALE)
_STATUS = (NEUTRAL, SPARED, BONUS)
_SLOTS = {**dict.fromkeys(_STATUS, "status"), FULL: "best", CURVE: "best"}
#: Families of verdicts whose price may change.
PRICED = ("slip", "mistake", "follow_through", "missing_unit", "wrong_unit", "partial")
FOLLOWS_IN_OTHER_CASE = "follow_through:other_case"  #: priced apart from what follows from an error
MOST_WEIGHT = 1000.0  #: points of a question
WIDEST = 100.0  #: accepted half-widths
#: Verdicts that a wider margin leaves as they are.
_SETTLED = ("correct", "accepted", "missing", "unreadable", "to_mark")

#: Sheets, and the digits that a student keeps unless they are those of the papers, to the distances of the
#: answers from the references in accepted half-widths, by part.
Margins = Callable[[Sequence[Graded], int | None], Iterable[Mapping[str, float]]]


def no_margins(sheets: Sequence[Graded], digits: int | None = None) -> Iterable[Mapping[str, float]]:
    """Return no distances: for sheets on which no margin is changed."""
    return ({} for _ in sheets)


class Adjustments:
    """Adjustments in their order, and what they make of sheets and of what was issued."""

    def __init__(self, steps: Iterable[Decision] = ()) -> None:
        self.steps: tuple[Decision, ...] = tuple(steps)  #: those that stand
        self._last: dict[tuple[str, ...], Decision] = {}
        for decision in self.steps:
            slot = _SLOTS.get(decision.kind, decision.kind)
            verdict = (decision.answer or "") if decision.kind == PRICE else ""
            self._last[slot, decision.exercise, decision.part, verdict] = decision

    def __bool__(self) -> bool:
        return bool(self.steps)

    def _of(self, *kinds: str) -> dict[Question, Decision]:
        return {
            (exercise, part): decision
            for (_, exercise, part, _), decision in self._last.items()
            if decision.kind in kinds and exercise
        }

    @cached_property
    def weights(self) -> dict[Question, float]:
        """Points of the questions whose weight is changed."""
        return {question: float(decision.points or 0.0) for question, decision in self._of(WEIGHT).items()}

    @cached_property
    def statuses(self) -> dict[Question, str]:
        """Kind of the questions that do not count as usual."""
        return {question: decision.kind for question, decision in self._of(*_STATUS).items()}

    @cached_property
    def tolerances(self) -> dict[Question, float]:
        """Accepted half-widths of the questions whose margin is wider."""
        return {question: float(decision.points or 1.0) for question, decision in self._of(TOLERANCE).items()}

    @cached_property
    def digits(self) -> int | None:
        """Digits that a student may keep, where margins are as wide as that costs; None where they are as
        issued."""
        last = self._last.get((DIGITS, "", "", ""))
        return None if last is None or last.points is None else int(last.points)

    @cached_property
    def prices(self) -> dict[tuple[str, str, str], float]:
        """Share of the points that a verdict leaves, by exercise, part (empty for all) and verdict."""
        return {
            (exercise, part, verdict): float(decision.points or 0.0)
            for (slot, exercise, part, verdict), decision in self._last.items()
            if slot == PRICE
        }

    # ------------------------------------------------------------------- issued

    def on(self, issued: Issued) -> Issued:
        """Return what was issued with these weights and this scale."""
        if not self.steps:
            return issued
        adjusted = copy(issued)
        adjusted.records = {key: self._record(key[0], record) for key, record in issued.records.items()}
        if issued.assignment is not None and (self._has_scale or issued.assignment.get("mark")):
            adjusted.assignment = {**issued.assignment, "mark": self.scale(issued)}
        return adjusted

    @cached_property
    def _counted_anew(self) -> frozenset[str]:
        """Exercises of which a question has another weight or does not count as usual."""
        return frozenset(exercise for exercise, _ in (*self.weights, *self.statuses))

    def _record(self, exercise: str, record: Mapping[str, Any]) -> Mapping[str, Any]:
        if exercise not in self._counted_anew:
            return record
        parts = [
            {**part, "points": 0.0 if (exercise, part["id"]) in self.statuses else self.worth(exercise, part)}
            for part in record["parts"]
        ]
        return {**record, "parts": parts}

    def worth(self, exercise: str, part: Mapping[str, Any]) -> float:
        """Return the points of an issued part with its new weight, whether it counts or not."""
        return self.weights.get((exercise, str(part["id"])), float(part["points"]))

    @property
    def _has_scale(self) -> bool:
        return any(decision.kind in ON_SCALE for decision in self._last.values())

    def scale(self, issued: Issued) -> dict[str, Any]:
        """Return the scale of the mark with these adjustments."""
        scale = {**USUAL_SCALE, **((issued.assignment or {}).get("mark") or {})}
        best, step = (self._last.get((slot, "", "", "")) for slot in ("best", STEP))
        if step is not None and step.points:
            scale["step"] = step.points
        if best is not None:
            scale["total"] = self.total(issued)
            scale |= (
                {"full": best.points}
                if best.kind == FULL
                else {"curve": [list(point) for point in curve_of(best.answer or "")]}
            )
        return scale

    def total(self, issued: Issued) -> float:
        """Return the points of a paper on which every question counts that is not neutral or a bonus."""
        first = {exercise: record for (exercise, _), record in reversed(issued.records.items())}
        return sum(
            self.worth(exercise, part)
            for exercise, record in first.items()
            for part in record["parts"]
            if self.statuses.get((exercise, str(part["id"]))) not in (NEUTRAL, BONUS)
        )

    # ------------------------------------------------------------------- sheets

    def applied(
        self, sheets: Iterable[Graded], issued: Issued, margins: Margins = no_margins
    ) -> list[Graded]:
        """Return marked sheets with the adjustments applied, in their order.

        ``sheets`` are all of each student of whom there are some.
        """
        adjusted = [self._priced(graded) for graded in sheets]
        wider = {exercise for exercise, _ in self.tolerances}
        places = [
            k for k, graded in enumerate(adjusted) if self.digits is not None or graded.exercise in wider
        ]
        if places:
            among = [adjusted[k] for k in places]
            as_issued = list(margins(among, None))
            anew = as_issued if self.digits is None else margins(among, self.digits)
            for k, *by_part in zip(places, as_issued, anew, strict=True):
                adjusted[k] = self._widened(adjusted[k], *by_part)
        adjusted = [self._weighted(graded) for graded in adjusted]
        if SPARED in self.statuses.values():
            self._spare(adjusted, self.on(issued))
        return adjusted

    def _priced(self, graded: Graded) -> Graded:
        if not self.prices:
            return graded
        lines = {part: self._price(graded, part, line) for part, line in graded.lines.items()}
        return graded._replace(lines=lines)

    def _price(self, graded: Graded, part: str, line: Mark) -> Mark:
        if part in graded.settled:
            return line
        names = [line.verdict, line.verdict.partition(":")[0]]
        if line.verdict == "follow_through" and "slip:other_case" in line.matches:
            names.insert(0, FOLLOWS_IN_OTHER_CASE)
        for place in ((graded.exercise, part), (graded.exercise, ""), ("", "")):
            for verdict in names:
                if (share := self.prices.get((*place, verdict))) is not None:
                    return line._replace(points=round(share * line.out_of, 9))
        return line

    def _widened(self, graded: Graded, as_issued: Mapping[str, float], anew: Mapping[str, float]) -> Graded:
        lines = dict(graded.lines)
        for part, distance in as_issued.items():
            line, widest = lines[part], self.tolerances.get((graded.exercise, part), 1.0)
            is_open = part not in graded.settled and line.verdict not in _SETTLED
            is_within = min(distance, anew.get(part, distance)) <= widest
            if is_open and is_within and distance > 1.0 and line.points < line.out_of:
                message = words(line.lang)["marking"]["widened"]
                lines[part] = line._replace(
                    verdict="accepted", points=line.out_of, says=message, feedback=message
                )
        return graded._replace(lines=lines)

    def _weighted(self, graded: Graded) -> Graded:
        if graded.exercise not in self._counted_anew:
            return graded
        lines, settled = {}, graded.settled
        for part, line in graded.lines.items():
            question = graded.exercise, part
            if (weight := self.weights.get(question)) is not None and line.out_of:
                points = float(exact(line.points) * exact(weight) / exact(line.out_of))
                line = line._replace(points=round(points, 9), out_of=weight)
            if (status := self.statuses.get(question)) in (NEUTRAL, BONUS):
                line = _counting_as(line, status)
                settled = (*settled, part) if status == NEUTRAL else settled  # nothing waits in it
            lines[part] = line
        return graded._replace(lines=lines, settled=settled)

    def _spare(self, adjusted: list[Graded], issued: Issued) -> None:
        """Leave questions out for those whose mark rises by it, beginning with the one that costs most."""
        order = sorted(range(len(adjusted)), key=lambda k: (adjusted[k].student, adjusted[k].sitting))
        for (student, sitting), places in groupby(
            order, key=lambda k: (adjusted[k].student, adjusted[k].sitting)
        ):
            sheets = {k: adjusted[k] for k in places}
            points, out_of = (
                sum(getattr(graded, name) for graded in sheets.values()) for name in ("points", "out_of")
            )
            handed_in = {graded.exercise for graded in sheets.values()}
            owed = issued.issued_to(student, sitting).items()
            out_of += sum(
                part["points"]
                for key in owed
                if key[0] not in handed_in
                for part in issued.records[key]["parts"]
            )
            spared = [
                (line.points / line.out_of, k, part)
                for k, graded in sheets.items()
                for part, line in graded.lines.items()
                if self.statuses.get((graded.exercise, part)) == SPARED and line.out_of
            ]
            for share, k, part in sorted(spared):
                line = adjusted[k].lines[part]
                rest, rest_out_of = points - line.points, out_of - line.out_of
                if rest_out_of <= 0 or share * rest_out_of >= rest:
                    continue
                points, out_of = rest, rest_out_of
                lines = {**adjusted[k].lines, part: _counting_as(line, NEUTRAL)}
                adjusted[k] = adjusted[k]._replace(lines=lines, settled=(*adjusted[k].settled, part))


def _counting_as(line: Mark, status: str) -> Mark:
    message = words(line.lang)["marking"][status]
    points = 0.0 if status == NEUTRAL else line.points
    return line._replace(points=points, out_of=0.0).saying(message, message)


# ----------------------------------------------------------------------- reading


class CurvePoint(NamedTuple):
    """Point of a curve: the mark that so many points are worth."""

    points: float
    mark: float


def curve_of(text: str) -> tuple[CurvePoint, ...]:
    """Return a curve as it is written: ``0:0 16:10 32:20``, points before marks, both rising.

    Raises
    ------
    BadInput
        The text is no such curve.
    """
    fault = BadInput(
        "a curve is points and their marks, both rising: 0:0 16:10 32:20; found {found!r}", found=text[:60]
    )
    try:
        pairs = [piece.split(":") for piece in text.replace(";", " ").split()]
        points = [CurvePoint(typed_number(a), typed_number(b)) for a, b in pairs]
    except ValueError:
        raise fault from None
    rises = all(b.points > a.points and b.mark >= a.mark for a, b in pairwise(points))
    if not points or not rises or not all(0 <= number < 1e6 for point in points for number in point):
        raise fault
    if points[0].points > 0:
        points.insert(0, CurvePoint(0.0, 0.0))
    if len(points) < 2:
        raise fault
    return tuple(points)


def check_adjustment(decision: Decision, worth: Mapping[str, Mapping[str, float]]) -> None:
    """Refuse an adjustment that makes no sense; ``worth`` are the points of the issued parts, by exercise and
    part.

    Raises
    ------
    BadInput
        Its question was not issued, or its value is impossible.
    """
    if decision.kind in ON_SCALE:
        if decision.kind == CURVE:
            curve_of(decision.answer or "")
        elif not 0 < (decision.points or 0.0) <= 1e6:
            raise _bad_value(decision)
        return
    is_anywhere = decision.kind in (DIGITS, PRICE)
    if decision.exercise not in worth if decision.exercise else not is_anywhere:
        raise BadInput("no exercise {exercise!r} was issued", exercise=decision.exercise)
    if decision.part not in worth[decision.exercise] if decision.part else not is_anywhere:
        raise BadInput(
            "{exercise} has no part {part!r}{nearest}",
            exercise=decision.exercise,
            part=decision.part,
            nearest=nearest(decision.part, worth[decision.exercise]),
        )
    if decision.kind == PRICE and (decision.answer or "").partition(":")[0] not in PRICED:
        raise BadInput(
            "a price is of a verdict: {verdicts}, such as slip:sign; found {found!r}",
            verdicts=", ".join(PRICED),
            found=(decision.answer or "")[:40],
        )
    limits = {WEIGHT: (1e-6, MOST_WEIGHT), TOLERANCE: (1.0, WIDEST), DIGITS: DIGITS_KEPT, PRICE: (0.0, 1.0)}
    low, high = limits.get(decision.kind, (0.0, 0.0))
    if decision.kind in limits and not (decision.points is not None and low <= decision.points <= high):
        raise _bad_value(decision)
    if decision.kind == DIGITS and (decision.exercise or decision.points != int(decision.points or 0)):
        raise _bad_value(decision)


def _bad_value(decision: Decision) -> BadInput:
    wanted = {
        WEIGHT: Message("points above 0"),
        TOLERANCE: Message("a number of accepted margins from 1 to 100: a margin only becomes wider"),
        DIGITS: Message("a whole number of digits from 2 to 12, for all questions"),
        PRICE: Message("a share from 0 to 1"),
        FULL: Message("the points that are worth the best mark"),
        STEP: Message("a step above 0"),
    }[decision.kind]
    return BadInput(
        "{place}{kind}: {wanted}",
        place=Message("{file}: ", file=decision.location) if decision.location else "",
        kind=decision.kind,
        wanted=wanted,
    )
