"""Predictions: what one can say before computing, derived from the exercise itself.

What is worth predicting is found by looking at a few dozen variants of the exercise, never at the student's own:
that a sign is asked says that signs differ among variants, and nothing of this one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.errors import CourseworkError
from coursework.language import plain, with_unit, words
from coursework.marking import read
from coursework.model import Part
from coursework.selfstudy.kept import is_blank

if TYPE_CHECKING:
    from coursework.exercise import CourseExercise
    from coursework.variant import Variant

MOST = 6  #: predictions before the answers
OVER_THE_CYCLE = 3  #: predictions before the plots
_SAMPLE = range(24)
_FEW = 3  #: variants of the sample that must differ, for a question to be one
_RATES = ("rad/s", "mm/s")
_PEAKS = ("mm", "deg", "N", "N*m", "1")  #: units of what has a largest value worth knowing
NEAR = 15.0  #: degrees of the driver, for where a curve is highest
INSTANTS = 721


@dataclass(frozen=True)
class Prediction:
    """Something to say beforehand about a quantity.

    ``kind`` is ``sign``, ``quadrant``, ``compare`` (with the given quantity ``other``), ``guess`` (a whole
    number or a case), or over the cycle ``zeros`` (how often it changes its sign) or ``highest`` (at which angle of the driver).
    """

    id: str
    quantity: str
    kind: str
    other: str = ""
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Compared:
    """A prediction beside what came out; ``right`` is None where the prediction cannot be read."""

    prediction: Prediction
    said: str
    found: str
    right: bool | None


# ------------------------------------------------------------------------ which


def before_answers(variant: Variant) -> tuple[Prediction, ...]:
    """What to predict before any computation, a part each, evenly over the parts."""
    found = [p for part in variant.parts if (p := _of_part(variant.exercise, part)) is not None]
    if len(found) <= MOST:
        return tuple(found)
    step = (len(found) - 1) / (MOST - 1)
    return tuple(found[round(k * step)] for k in range(MOST))


def _of_part(exercise: CourseExercise, part: Part) -> Prediction | None:
    if part.kind == "angle":
        return Prediction(part.id, part.quantity, "quadrant")
    if part.kind in ("integer", "choice"):
        return Prediction(part.id, part.quantity, "guess", choices=part.choices)
    if part.kind != "number" or not exercise.course.has_solutions:
        return None
    values = _sample(exercise).get(part.quantity)
    if values is None:
        return None
    if _differ(values > 0, values):
        return Prediction(part.id, part.quantity, "sign")
    others = {
        name: _sample(exercise)[name]
        for name, spec in exercise.spec.given.items()
        if spec.unit == part.unit and not spec.is_choice and not spec.is_fixed
    }
    fair = {n: abs(np.mean(values > v) - 0.5) for n, v in others.items() if _differ(values > v, values)}
    return Prediction(part.id, part.quantity, "compare", min(fair, key=fair.__getitem__)) if fair else None


def _differ(holds: np.ndarray, values: np.ndarray) -> bool:
    known = holds[np.isfinite(values)]
    return min(int(known.sum()), int((~known).sum())) >= _FEW


@lru_cache(maxsize=64)
def _sample(exercise: CourseExercise) -> Mapping[str, np.ndarray]:
    """Numbers given and asked, over some variants; NaN where a variant has none."""
    asked = [p.quantity for p in exercise.spec.parts if p.kind == "number"]
    given = [n for n, spec in exercise.spec.given.items() if not spec.is_choice]
    columns: dict[str, list[float]] = {name: [] for name in dict.fromkeys([*given, *asked])}
    for variant in exercise.variants(_SAMPLE):
        values = dict(variant.given)
        wanted = [p.quantity for p in variant.parts if p.kind == "number"]
        try:
            values |= exercise.solve(**variant.given, only=wanted, effects=variant.effects)
        except CourseworkError:
            continue
        for name, column in columns.items():
            column.append(float(values.get(name, math.nan)))
    return {name: np.array(column) for name, column in columns.items()}


def moving(variant: Variant) -> tuple[Part, ...]:
    """The parts whose number moves with the driver; none without a driver or without solutions."""
    exercise = variant.exercise
    driver = exercise.spec.driver
    if driver is None or driver.angle not in variant.used or not exercise.course.has_solutions:
        return ()
    reached = exercise.solution.graph.textbook.descendants((driver.angle,))
    numbers = (p for p in variant.parts if p.kind in ("number", "angle"))
    return tuple(p for p in numbers if p.quantity in reached)


def over_the_cycle(variant: Variant) -> tuple[Prediction, ...]:
    """What to predict before the plots: how often a rate changes its sign, where a length or an effort is largest."""
    rates, others = [], []
    for part in moving(variant):
        if part.kind == "number" and part.unit in _RATES:
            # The length of a vector never changes its sign: there is nothing to say of it.
            values = _sample(variant.exercise)[part.quantity]
            if not _differ(values > 0, values):
                continue
            rates.append(Prediction(f"zeros_{part.id}", part.quantity, "zeros"))
        elif part.kind == "number" and part.unit in _PEAKS:
            others.append(Prediction(f"highest_{part.id}", part.quantity, "highest"))
    chosen = [*others[:1], *rates]
    return tuple(chosen[:OVER_THE_CYCLE])


# ------------------------------------------------------------------------ asked


def asked(variant: Variant, prediction: Prediction) -> str:
    """The question of a prediction, in one line of Markdown."""
    said = words(variant.lang)["study"]["predict"]
    exercise = variant.exercise
    driver = exercise.spec.driver
    return said[prediction.kind].format(
        symbol=f"${exercise.symbol(prediction.quantity)}$",
        other=f"${exercise.symbol(prediction.other)}$" if prediction.other else "",
        driver=f"${exercise.symbol(driver.angle)}$" if driver else "",
        number=_number_of(variant, prediction),
    )


def _number_of(variant: Variant, prediction: Prediction) -> int:
    numbers = [n for n, p in enumerate(variant.parts, start=1) if p.quantity == prediction.quantity]
    return numbers[0] if numbers else 0


def options(variant: Variant, prediction: Prediction) -> str:
    """What may be written, as plain text."""
    said = words(variant.lang)["study"]["options"]
    return " / ".join(prediction.choices) if prediction.choices else said[prediction.kind]


# --------------------------------------------------------------------- compared


def compared(variant: Variant, prediction: Prediction, text: Any) -> Compared | None:
    """A prediction beside what comes out; None where nothing was predicted.

    Raises
    ------
    NoSolution
        The course folder has no solutions.
    """
    if is_blank(text):
        return None
    found, right = {
        "sign": _sign,
        "quadrant": _quadrant,
        "compare": _compare,
        "guess": _guess,
        "zeros": _zeros,
        "highest": _highest,
    }[prediction.kind](variant, prediction, str(text).strip())
    return Compared(prediction, str(text).strip(), found, right)


Outcome = tuple[str, bool | None]


def _sign(variant: Variant, prediction: Prediction, text: str) -> Outcome:
    found = "+" if variant.walk[prediction.quantity] > 0 else "−"
    said = {"+": "+", "-": "−", "−": "−"}.get(text[:1])
    return found, None if said is None else said == found


def _quadrant(variant: Variant, prediction: Prediction, text: str) -> Outcome:
    found = str(1 + int(variant.walk[prediction.quantity] % 360 // 90))
    return found, text == found if text in ("1", "2", "3", "4") else None


def _compare(variant: Variant, prediction: Prediction, text: str) -> Outcome:
    value, other = variant.walk[prediction.quantity], variant.given[prediction.other]
    found = ">" if value > other else "<" if value < other else "="
    return found, text[:1] == found if text[:1] in ("<", ">", "=") else None


def _guess(variant: Variant, prediction: Prediction, text: str) -> Outcome:
    part = next(p for p in variant.parts if p.id == prediction.id)
    reading = read(variant, part, text)
    value = variant.walk[prediction.quantity]
    found = variant.label(part.id, str(value)) if part.kind == "choice" else plain(int(value))
    return found, value in reading.values if reading.status == "read" else None


def _zeros(variant: Variant, prediction: Prediction, text: str) -> Outcome:
    _, values = curve(variant, prediction.quantity)
    found = zeros(values)
    return str(found), int(text) == found if text.isdigit() else None


def _highest(variant: Variant, prediction: Prediction, text: str) -> Outcome:
    angles, values = curve(variant, prediction.quantity)
    best = float(angles[np.nanargmax(values)])
    shown = with_unit(plain(round(best)), "deg", variant.lang)
    try:
        said = float(text.replace("°", "").replace(",", ".").replace("−", "-"))
    except ValueError:
        return shown, None
    top, low = np.nanmax(values), np.nanmin(values)
    near = angles[values >= top - 0.01 * (top - low)]
    return shown, bool((np.abs((near - said + 180) % 360 - 180) <= NEAR).any())


def zeros(values: np.ndarray) -> int:
    """How often a curve over a full turn changes its sign; its ends are one place."""
    signs = np.sign(values[:-1])
    signs = signs[np.isfinite(signs) & (signs != 0)]
    return int(np.sum(signs != np.roll(signs, 1)))


def curve(variant: Variant, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """The driver's angle over a turn, from 0 to 360 degrees, and the quantity at each; NaN where nothing closes."""
    angles = np.linspace(0.0, 360.0, INSTANTS)
    exercise = variant.exercise
    given = {**variant.used, exercise.spec.driver.angle: angles}
    found = exercise.solve(**given, only=quantity, effects=variant.effects)[quantity]
    return angles, np.broadcast_to(np.asarray(found, dtype=float), angles.shape)
