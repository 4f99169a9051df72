"""Predictions before computing, derived from the exercise itself.

A few dozen variants of the exercise, never the student's own, show what is worth predicting. A question about
a sign says that signs differ among variants, and nothing about this one.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.course.answer_keys import answer_keys
from coursework.errors import CourseworkError
from coursework.language.numbers import plain, with_unit
from coursework.language.words import words
from coursework.marking.answers import read
from coursework.markup.markdown import to_text
from coursework.model import Part
from coursework.parsing.numbers import read_number
from coursework.selfstudy import wording
from coursework.selfstudy.progress import is_blank

if TYPE_CHECKING:
    from coursework.course.exercise import CourseExercise
    from coursework.course.variant import Variant


MOST = 6  #: predictions before the answers
OVER_THE_CYCLE = 3  #: predictions before the plots
_SAMPLE = range(24)
_FEW = 3  #: variants of the sample that must differ, for a question to be one
_RATES = ("rad/s", "mm/s")
_PER_SECOND = (*_RATES, "rad/s^2", "mm/s^2")
_PEAKS = ("mm", "deg", "N", "N*m")  #: units of what has a largest value worth knowing
_OF_BODIES = (*_PEAKS, *_PER_SECOND)  #: units of what a body or a point has
NEAR = 15.0  #: degrees of the driver, for where a curve is highest
INSTANTS = 721
_UNBOUNDED = 30.0  #: times the median size over a turn


@dataclass(frozen=True)
class Prediction:
    """Prediction about a quantity, made before computing.

    ``kind`` is ``sign``, ``quadrant``, ``compare`` (with the given quantity ``other``), ``guess`` (a case),
    or over the cycle ``zeros`` (how often it changes its sign) or ``highest`` (at which angle of the driver).
    """

    id: str
    quantity: str
    kind: str
    other: str = ""
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class PredictionOutcome:
    """Prediction with its outcome; ``right`` is None where the prediction cannot be read."""

    prediction: Prediction
    said: str
    found: str
    right: bool | None


# ------------------------------------------------------------------------ which


def before_answers(variant: Variant) -> tuple[Prediction, ...]:
    """Return the predictions to make before any computation, one a part, spread evenly over the parts.

    They concern quantities of a body or a point (:func:`is_of_the_mechanism`). A choice that differs among
    variants is a prediction itself: only the last one, which says most about the whole.
    """
    results = [p for part in variant.parts if (p := _of_part(variant.exercise, part)) is not None]
    guesses = [p for p in results if p.kind == "guess"]
    results = [p for p in results if p not in guesses[:-1]]
    if len(results) <= MOST:
        return tuple(results)
    step = (len(results) - 1) / (MOST - 1)
    return tuple(results[round(k * step)] for k in range(MOST))


def _of_part(exercise: CourseExercise, part: Part) -> Prediction | None:
    if part.sort.prediction == "guess":
        differs = part.choices and _differs_among(exercise, part.id, part.quantity)
        return Prediction(part.id, part.quantity, "guess", choices=part.choices) if differs else None
    if part.sort.prediction == "quadrant":
        return Prediction(part.id, part.quantity, "quadrant")
    if not is_of_the_mechanism(exercise, part):
        return None
    values = _sample(exercise)[part.quantity]
    if _differ(values > 0, values):
        return Prediction(part.id, part.quantity, "sign")
    if not is_seen(exercise, part):
        return None
    others = {
        name: _sample(exercise)[name]
        for name, spec in exercise.spec.given.items()
        # A direction is known up to whole turns: neither larger nor smaller than anything.
        if spec.unit == part.unit != "deg" and not spec.is_choice and not spec.is_fixed
    }
    fair = {n: abs(np.mean(values > v) - 0.5) for n, v in others.items() if _differ(values > v, values)}
    return Prediction(part.id, part.quantity, "compare", min(fair, key=fair.__getitem__)) if fair else None


def is_of_the_mechanism(exercise: CourseExercise, part: Part) -> bool:
    """Return whether a part asks for a number that belongs to a body or a point.

    These are lengths, angles, velocities, accelerations and efforts; not ratios, areas, or coefficients,
    which are letters without an index. A length on paper is excluded as well: it depends on velocities,
    through the scale of a drawing.
    """
    if part.sort.prediction != "size" or part.unit not in _OF_BODIES or len(part.quantity) == 1:
        return False
    return not (part.unit == "mm" and _hangs_on(exercise, part, _PER_SECOND))


def is_seen(exercise: CourseExercise, part: Part) -> bool:
    """Return whether the figure or reasoning tells which of two such numbers is larger: a length in the
    figure that moves with the driver, or an effort."""
    driver = exercise.spec.driver
    if part.unit != "mm":
        return part.unit in ("N", "N*m")
    return (
        driver is not None
        and exercise.spec.figure is not None
        and _hangs_on(exercise, part, (), driver.angle)
    )


def _hangs_on(exercise: CourseExercise, part: Part, units: Collection[str], name: str = "") -> bool:
    """Return whether a quantity is computed from a given one of this name, or of these units."""
    graph, given = exercise.solution.graph.textbook, exercise.spec.given
    known_names = [
        n for n, spec in given.items() if (spec.unit in units or n == name) and n in exercise.quantity_names
    ]
    return part.quantity in known_names or part.quantity in graph.descendants(tuple(known_names))


@lru_cache(maxsize=256)
def _differs_among(exercise: CourseExercise, part: str, quantity: str) -> bool:
    """Return whether the case of a choice that every variant asks differs enough among some variants."""
    cases = []
    for variant in exercise.variants(_SAMPLE):
        if part not in variant.part_ids:
            return False
        with suppress(CourseworkError):
            cases.append(str(variant.quantities([quantity])[quantity]))
    return len(cases) - max(map(cases.count, cases), default=0) >= _FEW


def _differ(holds: np.ndarray, values: np.ndarray) -> bool:
    finite = holds[np.isfinite(values)]
    return min(int(finite.sum()), int((~finite).sum())) >= _FEW


@lru_cache(maxsize=64)
def _sample(exercise: CourseExercise) -> Mapping[str, np.ndarray]:
    """Return the given and requested numbers over some variants; NaN where a variant lacks one."""
    requested = [p.quantity for p in exercise.spec.parts if p.sort.prediction == "size"]
    given = [n for n, spec in exercise.spec.given.items() if not spec.is_choice]
    columns: dict[str, list[float]] = {name: [] for name in dict.fromkeys([*given, *requested])}
    for variant in exercise.variants(_SAMPLE):
        values = dict(variant.given)
        wanted = [p.quantity for p in variant.parts if p.sort.prediction == "size"]
        try:
            values |= exercise.solve(**variant.given, only=wanted, effects=variant.effects)
        except CourseworkError:
            continue
        for name, column in columns.items():
            column.append(float(values.get(name, math.nan)))
    return {name: np.array(column) for name, column in columns.items()}


def moving(variant: Variant) -> tuple[Part, ...]:
    """Return the parts whose number depends on the driver's angle; none without a driver."""
    exercise = variant.exercise
    driver = exercise.spec.driver
    if driver is None or driver.angle not in variant.used:
        return ()
    reached = exercise.solution.graph.textbook.descendants((driver.angle,))
    numbers = (p for p in variant.parts if p.sort.is_number)
    return tuple(p for p in numbers if p.quantity in reached)


def over_the_cycle(variant: Variant) -> tuple[Prediction, ...]:
    """Return the predictions to make before the plots: the sign changes of a rate, the position of the
    largest length or effort."""
    rates, others = [], []
    for part in moving(variant):
        if not is_of_the_mechanism(variant.exercise, part):
            continue
        if part.unit in _RATES:
            # The length of a vector never changes its sign: there is nothing to say of it.
            values = _sample(variant.exercise)[part.quantity]
            if not _differ(values > 0, values):
                continue
            rates.append(Prediction(f"zeros_{part.id}", part.quantity, "zeros"))
        elif part.unit in _PEAKS and _is_bounded(variant.exercise, part.quantity):
            others.append(Prediction(f"highest_{part.id}", part.quantity, "highest"))
    chosen = [*others[:1], *rates]
    return tuple(chosen[:OVER_THE_CYCLE])


def prediction_keys(variant: Variant) -> dict[str, str]:
    """Return the key of each prediction by its id: that of the same question's answer, or ``p1``, ``p2``…
    over the cycle."""
    keys = answer_keys(variant.parts)
    before = {p.id: keys[p.id] for p in before_answers(variant)}
    return before | {p.id: f"p{k}" for k, p in enumerate(over_the_cycle(variant), start=1)}


@lru_cache(maxsize=256)
def _is_bounded(exercise: CourseExercise, quantity: str) -> bool:
    """Return whether a quantity stays finite over the turn, in a few variants; an unbounded one has no
    largest value."""
    for variant in exercise.variants(range(_FEW)):
        try:
            sizes = np.abs(curve(variant, quantity)[1])
        except CourseworkError:
            return False
        sizes = sizes[np.isfinite(sizes)]
        if not sizes.size or sizes.max() > _UNBOUNDED * np.median(sizes):
            return False
    return True


# ------------------------------------------------------------------------ asked


def question_of(variant: Variant, prediction: Prediction) -> str:
    """Return the question of a prediction, in one line of Markdown."""
    texts = words(variant.lang)["study"]["predict"]
    driver = variant.exercise.spec.driver
    return texts[prediction.kind].format(
        symbol=f"${variant.symbol(prediction.quantity)}$",
        other=f"${variant.symbol(prediction.other)}$" if prediction.other else "",
        driver=f"${variant.symbol(driver.angle)}$" if driver else "",
        number=_number_of(variant, prediction),
    )


def _number_of(variant: Variant, prediction: Prediction) -> int:
    numbers = [n for n, p in enumerate(variant.parts, start=1) if p.quantity == prediction.quantity]
    return numbers[0] if numbers else 0


def options(variant: Variant, prediction: Prediction) -> str:
    """Return the possible answers to a prediction, as plain text."""
    part = next((p for p in variant.parts if p.id == prediction.id), None)
    if part is not None and prediction.choices:
        return choices(variant, part)
    return words(variant.lang)["study"]["options"][prediction.kind]


def choices(variant: Variant, part: Part) -> str:
    """Return the cases of a choice, each as its letter and its label."""
    letters = variant.letters(part)
    labels = {c: to_text(variant.label(part.id, c), variant.lang, sys.maxsize) for c in variant.cases(part)}
    return " / ".join(f"{letters[c]} ({label})" if c in letters else label for c, label in labels.items())


def is_understood(variant: Variant, prediction: Prediction, text: Any) -> bool:
    """Return whether a prediction can be read; nothing is computed."""
    return _READ[prediction.kind](variant, prediction, text) is not None


# --------------------------------------------------------------------- compared


def compared(
    variant: Variant, prediction: Prediction, text: Any, own_answer: float | None = None
) -> PredictionOutcome | None:
    """Return a prediction with its outcome; None where nothing was predicted.

    ``own_answer`` is the student's own right value, where it is not the reference's: the prediction was of
    that.

    Raises
    ------
    NoSolution
        The course folder has no solutions.
    """
    if is_blank(text):
        return None
    reading = _READ[prediction.kind](variant, prediction, text)
    value = variant.walk[prediction.quantity] if own_answer is None else own_answer
    result, right = _FOUND[prediction.kind](variant, prediction, value, reading)
    return PredictionOutcome(prediction, str(text).strip(), result, None if reading is None else right)


def _read_guess(variant: Variant, prediction: Prediction, text: Any) -> tuple[Any, ...] | None:
    part = next(p for p in variant.parts if p.id == prediction.id)
    reading = read(variant, part, text)
    return reading.values if reading.status == "read" else None


def _read_angle(variant: Variant, prediction: Prediction, text: Any) -> tuple[float, ...] | None:
    reading = read_number(wording.without_about(text), "deg")
    return reading.values if reading.status == "read" else None


_READ: Mapping[str, Callable[[Variant, Prediction, Any], Any]] = {
    "sign": lambda variant, prediction, text: wording.sign(text) or None,
    "quadrant": lambda variant, prediction, text: wording.quadrant(text),
    "compare": lambda variant, prediction, text: wording.comparison(text) or None,
    "guess": _read_guess,
    "zeros": lambda variant, prediction, text: wording.count(text),
    "highest": _read_angle,
}

Outcome = tuple[str, bool]


def _sign(variant: Variant, prediction: Prediction, value: Any, text: Any) -> Outcome:
    return ("+" if value > 0 else "−"), text == ("+" if value > 0 else "-")


def _quadrant(variant: Variant, prediction: Prediction, value: Any, text: Any) -> Outcome:
    result = 1 + int(value % 360 // 90)
    return str(result), text == result


def _compare(variant: Variant, prediction: Prediction, value: Any, text: Any) -> Outcome:
    other = variant.given[prediction.other]
    result = ">" if value > other else "<" if value < other else "="
    return result, text == result


def _guess(variant: Variant, prediction: Prediction, value: Any, text: Any) -> Outcome:
    part = next(p for p in variant.parts if p.id == prediction.id)
    return variant.called(part, str(value)), value in (text or ())


def _zeros(variant: Variant, prediction: Prediction, value: Any, text: Any) -> Outcome:
    _, values = curve(variant, prediction.quantity)
    result = zeros(values)
    return str(result), text == result


def _highest(variant: Variant, prediction: Prediction, value: Any, text: Any) -> Outcome:
    angles, values = curve(variant, prediction.quantity)
    best = float(angles[np.nanargmax(values)])
    top, low = np.nanmax(values), np.nanmin(values)
    near = angles[values >= top - 0.01 * (top - low)]
    right = any((np.abs((near - angle + 180) % 360 - 180) <= NEAR).any() for angle in text or ())
    return with_unit(plain(round(best)), "deg", variant.lang), right


_FOUND: Mapping[str, Callable[[Variant, Prediction, Any, Any], Outcome]] = {
    "sign": _sign,
    "quadrant": _quadrant,
    "compare": _compare,
    "guess": _guess,
    "zeros": _zeros,
    "highest": _highest,
}


def zeros(values: np.ndarray) -> int:
    """Count the sign changes of a curve over a full turn; its ends are one point."""
    signs = np.sign(values[:-1])
    signs = signs[np.isfinite(signs) & (signs != 0)]
    return int(np.sum(signs != np.roll(signs, 1)))


def curve(variant: Variant, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the driver's angle over a turn, from 0 to 360 degrees, and the quantity at each; NaN where the
    mechanism does not close."""
    angles = np.linspace(0.0, 360.0, INSTANTS)
    exercise = variant.exercise
    driver = exercise.spec.driver
    assert driver is not None  # only what moves has a curve
    given = {**variant.used, driver.angle: angles}
    result = exercise.solve(**given, only=quantity, effects=variant.effects)[quantity]
    return angles, np.broadcast_to(np.asarray(result, dtype=float), angles.shape)
