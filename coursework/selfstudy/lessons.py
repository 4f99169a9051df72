"""Output of lessons and sessions: predictions with their outcomes, and curves."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from coursework.course.variant import Variant
from coursework.figures.plot import AnswerPoint, Axis, Plot
from coursework.language.numbers import significant, unit_text, with_unit
from coursework.language.words import words
from coursework.marking.answers import read
from coursework.markup.markdown import plain_line
from coursework.markup.shown import NotebookDisplay, SvgPicture
from coursework.model import Part
from coursework.selfstudy import predictions
from coursework.selfstudy.attempt import OwnAnswer
from coursework.selfstudy.progress import is_blank
from coursework.selfstudy.wording import folded, numbers, truth, unwrapped, would_do

_NEAR = 0.1
_NEAR_ANGLE = 10.0  #: degrees
_NEAR_ZERO = 0.02  #: where a tenth would be nothing


class PredictionTable(NotebookDisplay):
    """Predictions with their outcomes; ``outcome`` holds the outcomes alone, for readers on paper."""

    outcome = ""


def compare(
    predicted: Mapping[str, Any],
    results: Mapping[str, Any],
    lang: str = "fr",
    angles: Collection[str] = (),
    units: Mapping[str, str] = MappingProxyType({}),
) -> PredictionTable:
    """Return the predictions with their outcomes, for display in a notebook cell.

    Numbers agree within a tenth, angles within 10°, whole turns apart or not; texts and truths when they are
    the same. Numbers may be texts with a comma and a unit, truths yes and no in any language. A prediction
    that is None or blank is shown as not made, and one under a name without a result is reported.

    Parameters
    ----------
    predicted, found
        By the same names.
    lang
        Language of what is said.
    angles
        The names of what is an angle in degrees; a prediction in degrees makes it one.
    units
        The units of other results, by their names.

    >>> print(compare({"a": 2, "b": None}, {"a": 2.1, "b": 5}, "en"))
    - ✓ a: predicted 2, found 2.1
    - · b: no prediction, found 5
    """
    texts = words(lang)["study"]
    lines, outcomes = [], []
    for name, value in results.items():
        guess = unwrapped(predicted.get(name))
        agrees = not is_blank(guess) and _agree(guess, unwrapped(value), name in angles)
        mark = "·" if is_blank(guess) else "✓" if agrees else "✗"
        line = texts["not_predicted"] if is_blank(guess) else texts["predicted"]
        found = _outcome_text(value, lang, "deg" if name in angles else units.get(name, "1"))
        lines.append(f"- {mark} {line.format(name=name, said=_outcome_text(guess, lang), found=found)}")
        outcomes.append(f"- {name}{words(lang)['sheet']['colon']} {found}")
    for name, guess in predicted.items():
        if name not in results and not is_blank(guess):
            line = texts["refused"]["lesson_name"].format(name=name, said=_outcome_text(guess, lang))
            lines.append(f"- ? {line} {would_do(lang, str(name), list(results))}")
    displayed = PredictionTable(lang, "\n".join(lines))
    displayed.outcome = "\n".join(outcomes)
    return displayed


def _agree(guess: Any, value: Any, is_angle: bool) -> bool:
    if isinstance(value, bool):
        return truth(guess) is value
    if isinstance(value, str) or isinstance(guess, bool):
        return folded(guess) == folded(value)
    guesses, in_degrees = numbers(guess)
    if not isinstance(value, (int, float)):
        return folded(guess) == folded(value)
    if is_angle or in_degrees:
        return any(abs((g - value + 180.0) % 360.0 - 180.0) <= _NEAR_ANGLE for g in guesses)
    return any(abs(g - value) <= max(_NEAR * abs(value), _NEAR_ZERO) for g in guesses)


def _outcome_text(value: Any, lang: str, unit: str = "1") -> str:
    texts = words(lang)["study"]
    if isinstance(value, (bool, np.bool_)):
        return texts["yes"] if value else texts["no"]
    if isinstance(value, (int, float, np.number)):
        return with_unit(significant(float(value)), unit, lang)
    return str(value)


def plot(
    over: tuple[str, str, Any],
    curves: Mapping[str, tuple[str, Any]],
    *,
    lang: str = "fr",
    at: float | None = None,
    caption: str = "",
) -> NotebookDisplay:
    r"""Plot curves over one variable, a panel each, for display in a notebook cell.

    Parameters
    ----------
    over
        The variable: LaTeX symbol or words, unit, values: ``(r"\theta_2", "°", np.arange(361))``.
    curves
        By LaTeX symbol or words, the unit and as many values as the variable has; NaN where there is none.
    lang
        Language of the numbers.
    at
        A place on the variable that is marked.
    caption
        A sentence on what is plotted, with its units, in the Markdown of statements: it stands below the
        plot, and tells it to who cannot see it.

    Raises
    ------
    WrongValue
        No curve, or one of another length.
    """
    symbol, unit, values = over
    panels = [Axis(label, of, np.asarray(y, dtype=float)) for label, (of, y) in curves.items()]
    drawn = Plot(Axis(symbol, unit, np.asarray(values, dtype=float)), panels, lang, at)
    said = plain_line(caption, lang) or f"{', '.join(curves)} / {symbol}"
    return NotebookDisplay(lang, SvgPicture(drawn.svg(), said, caption=caption))


PANELS = 6  #: curves of a plot, unless some are named


class Curves(NamedTuple):
    """Plot with its notes."""

    plot: Plot
    driver: str  #: the angle of the driver, degrees, by name
    parts: tuple[Part, ...]  #: a panel each
    beside: tuple[Part, ...]  #: of which the student's own right answer is of another curve
    outside: tuple[Part, ...]  #: of which the student's answer is outside the panel

    @property
    def plain(self) -> str:
        """Description of the plot for readers who cannot see it."""
        return f"{', '.join(a.label for a in self.plot.panels)} / {self.driver}"


def usual_parts(variant: Variant, parts: Sequence[Part]) -> tuple[Part, ...]:
    """Return the parts plotted by default: first those with a prediction."""
    first = [p.quantity for p in predictions.over_the_cycle(variant)]
    wanted = sorted(parts, key=lambda p: p.quantity not in first)[:PANELS]
    return tuple(p for p in parts if p in wanted)


def curves(
    variant: Variant, parts: Sequence[Part], answers: Mapping[str, Any], own_answers: Mapping[str, OwnAnswer]
) -> Curves:
    """Plot the parts over a turn of the driver; ``answers`` by part, ``own_answers`` the student's right
    answers by quantity."""
    exercise, lang = variant.exercise, variant.lang
    assert exercise.spec.driver is not None  # without one no part moves
    driver = exercise.spec.driver.angle
    at = float(variant.given[driver]) % 360.0
    axes, spots = [], []
    for part in parts:
        angles, values = predictions.curve(variant, part.quantity)
        axes.append(Axis(variant.symbol(part.quantity), unit_text(part.unit, lang), values))
        spots.append(_spots(variant, part, answers.get(part.id), own_answers.get(part.quantity), at, values))
    plot = Plot(Axis(variant.symbol(driver), "°", angles), axes, lang, at, spots)
    answered = tuple(p for p in parts if p.quantity in own_answers and not own_answers[p.quantity].is_usual)
    outside = tuple(p for p, far in zip(parts, plot.has_outside, strict=True) if far)
    return Curves(plot, driver, tuple(parts), answered, outside)


def _spots(
    variant: Variant, part: Part, answer: Any, mine: OwnAnswer | None, at: float, values: np.ndarray
) -> tuple[AnswerPoint, ...]:
    """Return the student's answer as a point, if it can be read; nothing for a right answer that does not lie
    on this curve."""
    if mine is not None and not mine.is_usual:
        return ()
    if is_blank(answer):
        return ()
    reading = read(variant, part, answer)
    if reading.status != "read":
        return ()
    value = written = float(reading.values[0]) if mine is None or mine.value is None else mine.value
    if turn := part.sort.turn:
        # Of all turns the one beside the curve, so that a point above it is above.
        middle = (np.nanmin(values) + np.nanmax(values)) / 2
        value = middle + (value - middle + turn / 2) % turn - turn / 2
    return (AnswerPoint(at, value, mine is not None, written),)
