"""Answer key of a variant: reference values, accepted widths, and the wrong values that are known.

Everything is computed when it is first asked for, of one variant alone; or of many variants of an
exercise at once (:class:`Batch`), which costs a hundredth each.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from coursework.course.asked import KeySource
from coursework.course.error_values import ErrorValues, UsualError
from coursework.course.exercise import CourseExercise
from coursework.course.marking_rules import ILL_DEGREES, ILL_SHARE, Rules
from coursework.errors import CourseworkError
from coursework.model import Part
from coursework.parsing.units import convert
from coursework.quantities.graph import plain_scalar
from coursework.quantities.rounding import envelope

#: Factors by which a unit is mistaken for another.
_UNIT_FACTORS = (1e3, 1e-3, 10.0, 0.1)
_LENGTH = re.compile(r"(?<![^\W\d_])m?m(?![^\W\d_])")
_TURN_A_MINUTE = 60 / (2 * math.pi)


class Slip(NamedTuple):
    """A slip that multiplies the right value."""

    kind: str
    factor: float

    @property
    def is_common(self) -> bool:
        """Return whether it is made so often, in so few ways, that the whole margin may be read as it."""
        return self.kind in ("sign", "radians") or round(abs(math.log10(self.factor)), 9) % 3 == 0

    def made(self, reference: float) -> float:
        """Return the wrong value that the slip makes of the right one."""
        return reference * self.factor

    def mended(self, answer: float) -> float:
        """Return the answer without it."""
        return answer / self.factor

    def is_turned(self, answers: Iterable[float], turn: float, reference: float = 0.0) -> bool:
        """Return whether directions are more than a ``turn``, and than the right one, when mended: modulo a
        turn, some are near to anything."""
        most = turn if abs(reference) <= turn else turn + abs(reference)
        return (
            bool(turn)
            and self.kind == "radians"
            and all(abs(self.mended(answer)) > most for answer in answers)
        )

    def trace(self, unit: str) -> str:
        """Return the key under which a unit that is mistaken everywhere in the same way is recognised: metres
        for millimetres, say; an empty text for a sign."""
        if self.kind == "sign":
            return ""
        return f"{self.kind}/{self.factor:.6g}/{'mm' if 'mm' in unit else unit}"


class KeyNumbers(NamedTuple):
    """The numbers of a key, by quantity, as another process is handed them."""

    reference: dict[str, Any]
    envelope: dict[str, float]


class Key:
    """The reference values of one variant, and the values each known wrong way would give."""

    is_of_batch = False  #: computed with others, so that every asked quantity exists

    def __init__(self, variant: KeySource, rules: Rules | None = None, numbers: KeyNumbers | None = None):
        self.variant = variant
        self.solution = variant.exercise.solution
        self.rules = variant.exercise.folder.rules if rules is None else rules
        self._known = numbers
        self._half_widths: dict[Part, float] = {}

    @cached_property
    def reference(self) -> dict[str, Any]:
        """The asked quantities, and those that parts are judged with."""
        return self.variant.solution() if self._known is None else self._known.reference

    # ------------------------------------------------------------------ widths

    @cached_property
    def envelope(self) -> dict[str, float]:
        """By quantity, how far a student lands at most who rounds at every step.

        Where that is unbounded, as far as a variant that is issued may let them land.
        """
        if self._known is not None:
            return self._known.envelope
        variant = self.variant
        widths = envelopes(
            variant.exercise, self._quantities, variant.used, variant.effects, self.rules.digits
        )
        return {name: self._bounded(name, float(np.ravel(width)[0])) for name, width in widths.items()}

    @property
    def numbers(self) -> KeyNumbers:
        """Return the part of the key that needs none of the solution's mistakes."""
        return KeyNumbers(self.reference, self.envelope)

    def half_width(self, part: Part) -> float:
        """Return the largest accepted distance from the reference, in the part's unit; 0 for what is judged
        exactly."""
        if not part.has_margin:
            return 0.0
        if part not in self._half_widths:
            size = part.sort.size(self.reference[part.quantity])
            self._half_widths[part] = max(part.half_width(size), self.envelope.get(part.quantity, 0.0))
        return self._half_widths[part]

    @property
    def _quantities(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(p.quantity for p in self.variant.parts if not p.sort.is_open))

    def _bounded(self, name: str, width: float) -> float:
        return width if math.isfinite(width) else ill_limit(self._part_of(name), self.reference[name])

    def _part_of(self, quantity: str) -> Part:
        return next(p for p in self.variant.parts if p.quantity == quantity)

    # -------------------------------------------------------------- wrong ways

    @cached_property
    def wrong(self) -> dict[str, dict[str, Any]]:
        """By named mistake, the asked quantities it reaches and their wrong values."""
        return {name: self._wrong(name) for name in self.solution.mistakes}

    def _wrong(self, name: str) -> dict[str, Any]:
        reached = tuple(q for q in self.reference if q in self.solution.reached(name))
        try:
            return self._mistaken(name, reached)
        except CourseworkError:
            pass  # the wrong way leads nowhere for some quantity of this variant; the others are tried alone
        values: dict[str, Any] = {}
        for quantity in reached:
            with suppress(CourseworkError):
                values |= self._mistaken(name, (quantity,))
        return values

    def _mistaken(self, name: str, quantities: tuple[str, ...]) -> dict[str, Any]:
        graph = self.solution.mistaken(name)
        values = graph.evaluate(quantities, self.variant.used, self.variant.effects)
        return {quantity: plain_scalar(value) for quantity, value in values.items()}

    def wrong_ways(self, quantity: str) -> Iterator[tuple[str, Any]]:
        """Yield the named mistakes that reach a quantity, each with its wrong value, in the solution's
        order."""
        for name, values in self.wrong.items():
            if quantity in values:
                yield name, values[quantity]

    def price(self, name: str) -> float:
        """Return the share of the points that a named mistake leaves."""
        mistake = self.solution.mistakes[name]
        return self.rules.share(mistake.kind) if mistake.share is None else mistake.share

    def usual_ways(self, quantity: str) -> tuple[tuple[UsualError, ...], np.ndarray]:
        """Return the errors that nobody need list, those in a quantity's own formula first, and the values
        that they give.

        Shape ``(errors,)``; NaN where one leads nowhere.
        """
        errors, values = self._error_values.of(quantity)
        return errors, values[:, 0]

    def usual_value(self, error: UsualError, quantity: str) -> float:
        """Return the value that an error in a formula gives for a quantity; NaN where it does not reach
        it."""
        return float(self._error_values.of_one(error, quantity)[0])

    def usual_ways_from(
        self, quantity: str, own_answers: Mapping[str, Any]
    ) -> tuple[tuple[UsualError, ...], np.ndarray]:
        """Return the errors in a quantity's own formula, and what they give from a student's own earlier
        answers."""
        variant = self.variant
        given = {
            **variant.used,
            **{q: v for q, v in own_answers.items() if q != quantity and np.ndim(v) == 0},
        }
        values = ErrorValues(variant.exercise, (quantity,), given, variant.effects, 1)
        errors, columns = values.in_own_formula(quantity)
        return errors, columns[:, 0] if len(errors) else np.array([])

    @cached_property
    def _error_values(self) -> ErrorValues:
        variant = self.variant
        return ErrorValues(variant.exercise, self._quantities, variant.used, variant.effects, 1)

    @cached_property
    def in_radians(self) -> dict[str, list[float]]:
        """By quantity, what comes out of a calculator that is set to radians, where that is a number."""
        return {q: list(self.followed_in_radians(q, {})) for q in self._quantities}

    def followed_in_radians(self, quantity: str, own_answers: Mapping[str, Any]) -> Iterator[float]:
        """Yield the same from a student's own earlier answers."""
        given = {**self.variant.used, **{q: v for q, v in own_answers.items() if q != quantity}}
        for graph in self.solution.in_radians:
            with suppress(CourseworkError):
                value = plain_scalar(graph.evaluate((quantity,), given, self.variant.effects)[quantity])
                if is_real(value):
                    yield float(value)

    def followed(self, part: Part, own_answers: Mapping[str, Any], wrong: Collection[str]) -> Any:
        """Return the value that a right method gives from a student's own earlier answers, or None.

        ``own_answers`` holds them by quantity, right ones too: a student goes on from what they wrote. None
        where no ``wrong`` one bears on this quantity, and where nothing comes of it: the linkage does not
        close, the value is not finite, or within the margin of 0. A count of 0 is not trivial.
        """
        quantity = part.quantity
        sorts = {p.quantity: p.sort for p in self.variant.parts}
        before = {
            q: v
            for q, v in own_answers.items()
            if q != quantity and (q not in wrong or q not in sorts or not sorts[q].is_trivial(v))
        }
        if not any(quantity in self.solution.depending_on(q) for q in wrong if q in before):
            return None
        with suppress(CourseworkError):
            given = {**self.variant.used, **before}
            values = self.solution.graph.evaluate((quantity,), given, self.variant.effects)
            value = plain_scalar(values[quantity])
            if isinstance(value, str) or (exists(value) and not self._is_nothing(part, value)):
                return value
        return None

    def _is_nothing(self, part: Part, value: Any) -> bool:
        """Return whether a value cannot be distinguished from 0, which follows from anything small enough; a
        count of 0 can."""
        if not part.sort.is_scalar:
            return not isinstance(value, str) and not np.any(value)
        if part.sort.is_trivial(value):
            return True
        if not part.has_margin:
            return False
        return bool(part.sort.distance(part, value, 0.0, None, self.half_width(part)) <= 1)

    def slips(self, part: Part) -> Iterator[Slip]:
        """Slips that need nobody to declare them: what each makes of a right value, and how a wrong one is
        mended."""
        if not part.sort.is_number:
            return
        if self.reference[part.quantity] and not part.judge:  # a drawing tells the senses itself
            yield Slip("sign", -1.0)
        if part.unit == "deg" or part.unit.startswith("rad/s"):
            yield Slip("radians", math.radians(1.0))
            yield Slip("radians", math.degrees(1.0))
        if part.unit == "rad/s":
            yield Slip("turns_a_minute", _TURN_A_MINUTE)
            yield Slip("turns_a_minute", 1 / _TURN_A_MINUTE)
        if part.unit not in ("deg", "1"):
            metres = _metres_for_millimetres(part.unit)
            for factor in dict.fromkeys((*_UNIT_FACTORS, metres, 1 / metres)):
                yield Slip("unit", factor)

    def other_cases(self, part: Part) -> list[Any]:
        """Values of a part when a given case of two is taken for the other one: the assembly mode, say."""
        is_alone = part.sort.is_number and not part.judge
        return self._other_values(part.quantity) if is_alone else []

    def slip_values(self, part: Part) -> Iterator[tuple[str, Any]]:
        """Yield the wrong values that slips, and the other case, give of a part, each with its kind; none of
        one that a judge judges, who may accept others than the reference."""
        if part.judge:
            return
        for slip in self.slips(part):
            yield slip.kind, slip.made(self.reference[part.quantity])
        for value in self.other_cases(part):
            yield "other_case", value

    def _other_values(self, quantity: str) -> list[Any]:
        """Values of a quantity when a given case of two is taken for the other one: the assembly mode,
        say."""
        return self._other_cases.get(quantity, [])

    @cached_property
    def _other_cases(self) -> dict[str, list[Any]]:
        cases: dict[str, list[Any]] = {}
        for given in with_other_cases(self.variant.exercise, self.variant.used):
            for quantity in self._quantities:
                with suppress(CourseworkError):
                    value = self.solution.graph.evaluate((quantity,), given, self.variant.effects)[quantity]
                    cases.setdefault(quantity, []).append(plain_scalar(value))
        return cases


@lru_cache(maxsize=256)
def _metres_for_millimetres(unit: str) -> float:
    """By how much a value in a unit grows when its metres are taken for millimetres: 10⁶ for an area."""
    millimetres, metres = (_LENGTH.sub(length, unit) for length in ("mm", "m"))
    return float(convert(1.0, metres, millimetres))


def ill_limit(part: Part, reference: Any) -> float:
    """Return the widest envelope of a variant that may be issued, in the part's unit."""
    if part.unit == "deg":
        return ILL_DEGREES
    return ILL_SHARE * float(np.linalg.norm(reference)) if not isinstance(reference, str) else math.inf


def envelopes(
    exercise: CourseExercise[Any],
    quantities: Sequence[str],
    given: Mapping[str, Any],
    effects: Sequence[str],
    digits: int,
) -> dict[str, Any]:
    """Envelopes for given scalars or arrays: shape ``(n,)`` each, 0 for a quantity that has none."""
    parts = {p.quantity: p for p in exercise.spec.parts}
    numeric = tuple(q for q in quantities if parts[q].has_margin and parts[q].sort.rounds)
    directions = {q for q in numeric if parts[q].sort.turn}
    widths = envelope(exercise.solution.graph, numeric, given, effects, digits, directions)
    return {q: widths.get(q, 0.0) for q in quantities}


def with_other_cases(exercise: CourseExercise[Any], given: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Given values, of one variant or of many, with one case of two exchanged for the other, case by case."""
    for name, spec in exercise.spec.given.items():
        if len(spec.choices) == 2 and name in given:
            cases, other = spec.choices
            exchanged = np.where(np.asarray(given[name]) == cases, other, cases)
            yield {**given, name: exchanged if exchanged.ndim else str(exchanged)}


def is_real(value: Any) -> bool:
    """Return whether a value is a finite real number."""
    return isinstance(value, (int, float)) and math.isfinite(value)


def exists(value: Any) -> bool:
    """Return whether a value is a case, or finite in all its coordinates."""
    if isinstance(value, (float, int)):
        return math.isfinite(value)
    return isinstance(value, str) or bool(np.all(np.isfinite(value)))
