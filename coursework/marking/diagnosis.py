"""Why an answer is not right: what explains it among known mistakes, slips, usual errors and what a student
wrote before."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from coursework.course.answer_key import Key
from coursework.course.asked import KeySource
from coursework.course.error_values import TAKEN, UsualError
from coursework.marking.attempts import SheetEvidence, is_attempt
from coursework.marking.calculator import fitting as fitting_in_radians
from coursework.marking.calculator import values_in_radians
from coursework.marking.usual import (
    NEAR,
    NEAR_HERE,
    Fit,
    last_digit,
    nearness,
    own_errors_that_fit,
    usual_errors_that_fit,
)
from coursework.model import Part
from coursework.parsing.reading import Reading
from coursework.quantities.usual_errors import ALL_DEGREES, DEGREES, PARTS_OF_TERMS, TERM

CLOSE = 0.2  #: half-widths within which an answer is what an error gives; up to one it may be another


def nearest_reading(part: Part, reading: Reading, key: Key, judged_by: Part) -> tuple[int, float]:
    """Return the index of the reading that is nearest to the reference, and its distance in half-widths."""
    if reading.status != "read" or part.sort.is_open:
        return 0, math.inf
    reference = key.reference[judged_by.quantity]
    along = key.reference.get(judged_by.along)
    gaps = [part.sort.distance(part, v, reference, along) for v in reading.values]
    index = min(range(len(gaps)), key=gaps.__getitem__)
    if 1 < gaps[index] < math.inf and part.has_margin:
        # Outside the part's own tolerance: rounding on the way may have brought it there.
        width = key.envelope.get(judged_by.quantity, 0.0)
        gaps = [part.sort.distance(part, v, reference, along, width) for v in reading.values]
    return index, gaps[index]


@dataclass
class EarlierAnswers:
    """Earlier answers of a student: numbers and cases by quantity, and which of them are wrong."""

    own: dict[str, Any] = field(default_factory=dict)
    wrong: set[str] = field(default_factory=set)  #: those from which one may go on
    mistaken: set[str] = field(default_factory=set)  #: all that are not right
    sheet: SheetEvidence = field(default_factory=SheetEvidence)
    right: set[str] = field(default_factory=set)  #: quantities, of any kind of answer
    shown: set[str] = field(default_factory=set)  #: verdicts that explain earlier answers
    read: list[tuple[Part, Reading]] = field(default_factory=list)  #: numbers, whole ones too, and choices
    paid: dict[str, str] = field(default_factory=dict)  #: by error, the part whose answer paid for it
    in_radians: bool = False  #: the sheet shows a calculator that is set to radians

    def take_right(self, part: Part, reading: Reading, index: int) -> None:
        """Take in a right answer to a part that stands in another box."""
        self.right.add(part.quantity)
        if part.sort.is_followed:
            self.own[part.quantity] = reading.values[index]

    def take(
        self, key: Key, part: Part, reading: Reading, index: int, verdict: str, matches: Sequence[str]
    ) -> None:
        """Take in one more answer, as it was read and marked."""
        self.shown.update(matches)
        if verdict == "correct":
            self.right.add(part.quantity)
        if reading.status != "read" or not part.sort.is_followed:
            return
        self.read.append((part, reading))
        value = reading.values[index]
        if verdict != "correct":
            self.mistaken.add(part.quantity)
            is_explained = verdict != "wrong"
            reference = key.reference[part.quantity]
            if not (self.sheet.has_work and is_attempt(part, value, reference, is_explained=is_explained)):
                return
            self.wrong.add(part.quantity)
        self.own[part.quantity] = value

    def is_work(self, part: Part, value: Any) -> bool:
        """Return whether an answer shows work: the sheet has some, and the number is not written
        everywhere."""
        return self.sheet.has_work and not self.is_copied(part, value)

    def is_copied(self, part: Part, value: Any) -> bool:
        """Return whether an answer is a measured number that is written for several different quantities."""
        return part.sort.is_scalar and not part.sort.is_exact and value in self.sheet.everywhere

    def state(self, part: Part) -> str:
        """Return the state of the answer to a part: ``right``, ``wrong``, or ``open`` where none was read."""
        if part.quantity in self.right:
            return "right"
        return "wrong" if part.quantity in self.mistaken else "open"

    @property
    def answered(self) -> set[str]:
        """The quantities that were answered, rightly or not."""
        return self.own.keys() | self.right | self.mistaken


class Explanation(NamedTuple):
    """Possible cause of a wrong answer."""

    verdict: str
    reading: int  #: which honest reading it explains
    gap: float  #: from the value that it gives, in half-widths
    is_here: bool = True  #: it is about this very quantity
    is_likely: bool = True
    error: UsualError | None = None
    is_close: bool = False  #: the answer is the value that it gives, as far as its digits tell
    traces: tuple[str, ...] = ()  #: what another answer has in common with it that shows the same error

    @property
    def rank(self) -> tuple[bool, bool, bool, int]:
        """The lowest is named: what is likely, what follows, what is close; what the whole sheet shows; the
        author's before the engine's; a sign before what was made elsewhere; from afar the author's only where
        it is close."""
        kind, far = self.verdict.partition(":")[0], not self.is_here
        if kind == "mistake":
            order = 1 if self.is_here else 3 if self.is_close else 6
        elif self.error is None:
            order = {"slip:all_degrees": 0, "slip:sign": 2}.get(self.verdict, 4)
        else:
            order = 7 if far else 5
        return not self.is_likely, kind != "follow_through", not self.is_close, order


def mistakes_that_fit(key: Key, part: Part, reading: Reading) -> list[str]:
    """Return the named mistakes that give an answer, in the solution's order."""
    ways = key.wrong_ways(part.quantity)
    return [name for name, value in ways if _fits(part, reading, value, None, 0.0)]


def is_likely(name: str, key: Key, part: Part, before: EarlierAnswers) -> bool:
    """Return whether a mistake that explains an answer may be reported to the student.

    Not one made elsewhere, where what it is about has been answered rightly before. Among few cases, besides,
    many mistakes lead to the same one: a choice tells nothing of a mistake made elsewhere that an earlier
    answer, which it would have changed, does not show; nor of one that would have changed what is right and
    decides it at once.
    """
    about = key.solution.mistakes[name].targets
    if part.sort.has_few_values and part.quantity not in about:
        decides = before.right.intersection(key.solution.graph.textbook.node(part.quantity).arguments)
        if any(_shows(key, name, q) for q in decides):
            return False
    if f"mistake:{name}" in before.shown or part.quantity in about:
        return True
    if not part.sort.has_few_values:
        return not any(_shows(key, name, quantity) for quantity in before.right.intersection(about))
    return not any(
        name == other and not _fits(earlier, reading, value, None, 0.0)
        for earlier, reading in before.read
        for other, value in key.wrong_ways(earlier.quantity)
    )


def _shows(key: Key, mistake: str, quantity: str) -> bool:
    """Return whether a right answer for an asked quantity proves that the mistake was not made."""
    part = next(p for p in key.variant.parts if p.quantity == quantity)
    value = key.wrong[mistake].get(quantity)
    if value is None or not part.sort.disproves:
        return False
    width = key.envelope.get(quantity, 0.0)
    return bool(
        part.sort.apart(part, value, key.reference[quantity], key.reference.get(part.along), width) > 1
    )


def explained(
    key: Key, part: Part, reading: Reading, judged_by: Part, before: EarlierAnswers
) -> list[Explanation]:
    """Every explanation of a wrong answer, the one to name first."""
    close = [nearness(part, key, judged_by, value, CLOSE) for value in reading.values]
    explanations = [
        e._replace(is_close=e.gap <= close[e.reading])
        for e in _explanations(key, part, reading, judged_by, before)
    ]
    if not any(e.is_likely and e.is_close for e in explanations):  # else none of these would be named
        usual = [
            *_from_own(key, part, reading, judged_by, before),
            *_usual(key, part, reading, judged_by, before),
        ]
        explanations += [e._replace(is_close=e.gap <= close[e.reading]) for e in usual]
    return sorted(explanations, key=lambda e: e.rank)


def alternatives(explanations: Sequence[Explanation]) -> list[Explanation]:
    """Return the first explanation, and those that fit as well: nothing tells which of them it was."""
    first = explanations[0]
    if first.is_here and first.error is None:
        return [first]
    alike = (e for e in explanations if e.rank == first.rank and e.reading == first.reading)
    same = list({(e.verdict, e.error): e for e in alike}.values())
    term_sources = {e.error.source for e in same if e.error is not None and e.error.kind == TERM}
    # What is missing of a term that is missing is one thing.
    return [
        e
        for e in same
        if e.error is None or e.error.kind not in PARTS_OF_TERMS or e.error.source not in term_sources
    ]


def _explanations(
    key: Key, part: Part, reading: Reading, judged_by: Part, before: EarlierAnswers
) -> Iterator[Explanation]:
    quantity = judged_by.quantity
    width = key.envelope.get(quantity, 0.0)
    reference = key.reference[quantity]
    if part.sort.follows and before.wrong and not (part.sort.is_exact and before.sheet.is_guessed):
        fit = fits_followed(key, part, reading, judged_by, before.own, before.wrong)
        if fit is not None and not _is_constant(key, judged_by, reading.values[fit[0]], before):
            yield Explanation("follow_through", *fit)
    if part.sort.is_number and (before.in_radians or ALL_DEGREES in before.paid):
        for value in values_in_radians(key, quantity, before.own):
            if (index := fitting_in_radians(key, part, reading, value)) is not None:
                yield Explanation("slip:all_degrees", index, 0.0, traces=(ALL_DEGREES,))
                break
    for name, value in key.wrong_ways(quantity):
        along = key.reference.get(judged_by.along)
        if judged_by.along:
            along = key.wrong[name].get(judged_by.along, along)
        if part.sort.is_number and any(map(part.sort.is_trivial, reading.values)) and value:
            continue  # a nought is near to whatever is small, and shows nothing
        fit = _fitting(part, reading.values, value, along, width)
        is_here = quantity in key.solution.mistakes[name].targets
        usual = NEAR_HERE if is_here else NEAR
        if fit is not None and _is_near(key, part, judged_by, reading.values[fit[0]], fit[1], usual):
            traces = () if part.sort.has_few_values else (f"mistake:{name}",)
            likely = is_likely(name, key, judged_by, before)
            yield Explanation(f"mistake:{name}", *fit, is_here, likely, traces=traces)
    for kind in part.sort.slips(part, reading.values[0], reference, _lengths(key.variant)):
        yield Explanation(f"slip:{kind}", 0, 0.0)
    seen = set()
    for slip in key.slips(judged_by):
        mended = [slip.mended(value) for value in reading.values]
        fits = slip.kind not in seen and not slip.is_turned(reading.values, part.sort.turn, reference)
        fit = _fitting(part, mended, reference, None, width) if fits else None
        if fit is None:
            continue
        usual = 1.0 if slip.is_common else NEAR
        if _is_near(key, part, judged_by, mended[fit[0]], fit[1], usual):
            seen.add(slip.kind)
            yield Explanation(f"slip:{slip.kind}", *fit, traces=tuple(filter(None, (slip.trace(part.unit),))))
    for value in key.other_cases(judged_by):
        if (
            "other_case" not in seen
            and (fit := _fitting(part, reading.values, value, None, width)) is not None
            and _is_near(key, part, judged_by, reading.values[fit[0]], fit[1])
        ):
            seen.add("other_case")
            yield Explanation("slip:other_case", *fit)


def _is_near(key: Key, part: Part, judged_by: Part, answer: Any, gap: float, usual: float = NEAR) -> bool:
    """Return whether an answer is as near to a mistake's value as rounding brings it; whole margins hold too
    many numbers."""
    if not part.sort.is_number or not part.has_margin:
        return True
    return gap <= nearness(part, key, judged_by, answer, usual)


def fits_followed(
    key: Key,
    part: Part,
    reading: Reading,
    judged_by: Part,
    own_answers: Mapping[str, Any],
    wrong: Collection[str],
) -> tuple[int, float] | None:
    """Return the reading of an answer that a right method gives from earlier answers, ``wrong`` ones among
    them, and its distance in half-widths."""
    expected = key.followed(judged_by, own_answers, wrong)
    room = key.envelope.get(judged_by.quantity, 0.0)
    if part.sort.is_number:  # rounding on the way, and that of the answer itself
        room = max(room, key.half_width(judged_by)) + max(last_digit(part, v) for v in reading.values)
    return None if expected is None else _fitting(part, reading.values, expected, None, room)


_FEW_WRONG = 2  #: earlier answers that are wrong, from which one more error is looked for


def _from_own(
    key: Key, part: Part, reading: Reading, judged_by: Part, before: EarlierAnswers
) -> Iterator[Explanation]:
    """Yield the usual errors in a quantity's formula that give an answer from what the student had wrong
    before."""
    if len(before.wrong) > _FEW_WRONG and ALL_DEGREES not in before.paid:
        return  # of so many errors nobody can tell
    if any(judged_by.quantity in key.solution.depending_on(q) for q in before.wrong):
        # What is right was computed with more digits than were written.
        own_wrong = {q: before.own[q] for q in before.wrong}
        yield from map(_of_usual, own_errors_that_fit(key, part, reading, judged_by, own_wrong))


def _usual(
    key: Key, part: Part, reading: Reading, judged_by: Part, before: EarlierAnswers
) -> Iterator[Explanation]:
    fits = usual_errors_that_fit(key, part, reading, judged_by, before.right, before.answered)
    yield from map(_of_usual, fits)


def _of_usual(fit: Fit) -> Explanation:
    traces = tuple(filter(None, map(_trace, fit.alike)))
    return Explanation(
        f"slip:{fit.error.kind}", fit.reading, fit.gap, fit.is_here, error=fit.error, traces=traces
    )


def _trace(error: UsualError) -> str:
    """Return the key under which an error in a formula is recognised in every answer that it reaches; an
    empty text for a value taken for another."""
    if error.kind in TAKEN:
        return ""
    # The calculator is set to radians for all formulas.
    return ALL_DEGREES if error.kind in (DEGREES, ALL_DEGREES) else "/".join(map(str, error))


def _is_constant(key: Key, part: Part, value: Any, before: EarlierAnswers) -> bool:
    """Return whether an answer only repeats a number that is written everywhere, as do those that it would
    follow from."""
    if not before.is_copied(part, value):
        return False
    above = [q for q in before.wrong if part.quantity in key.solution.depending_on(q)]
    return all(before.own[q] == value for q in above)


def _lengths(variant: KeySource) -> dict[str, float]:
    """Return the given numbers that are not angles."""
    units = variant.exercise.units
    return {n: v for n, v in variant.used.items() if not isinstance(v, str) and units.get(n) != "deg"}


def _fits(part: Part, reading: Reading, value: Any, along: Any, width: float) -> bool:
    return _fitting(part, reading.values, value, along, width) is not None


def _fitting(
    part: Part, answers: Sequence[Any], value: Any, along: Any, width: float
) -> tuple[int, float] | None:
    """Return the first of an answer's readings that is this value, if any is, and how far from it in
    half-widths."""
    for index, read in enumerate(answers):
        gap = part.sort.distance(part, read, value, along, width)
        if gap <= 1:
            return index, gap
    return None
