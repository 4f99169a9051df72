"""Curves of a variant over a turn of its driver, with the student's answers marked on them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from coursework.course.variant import Variant
from coursework.figures.plot import AnswerPoint, Axis, Plot
from coursework.language.numbers import unit_text
from coursework.marking.answers import read
from coursework.model import Part
from coursework.selfstudy import predictions
from coursework.selfstudy.right_answers import OwnAnswer
from coursework.selfstudy.store import is_blank

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
    """Plot the parts over a turn of the driver; ``answers`` by part, ``own_answers`` the student's right answers by
    quantity."""
    exercise, lang = variant.exercise, variant.lang
    assert exercise.spec.driver is not None  # without one no part moves
    driver = exercise.spec.driver.angle
    at = float(variant.given[driver]) % 360.0
    axes, spots = [], []
    for part in parts:
        angles, values = predictions.curve(variant, part.quantity)
        axes.append(Axis(exercise.symbol(part.quantity), unit_text(part.unit, lang), values))
        spots.append(_spots(variant, part, answers.get(part.id), own_answers.get(part.quantity), at, values))
    plot = Plot(Axis(exercise.symbol(driver), "°", angles), axes, lang, at, spots)
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
